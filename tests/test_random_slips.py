"""Random starts with friction: phases agree with an independent model in doubles, as do undefined starts.

benches/slip_model.py is the model, and `benches/claims.py --of phases` asks the same of ten thousand starts.
"""

import pathlib
import sys

import numpy as np
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "benches"))
import judge
from kinds import phases

pytestmark = pytest.mark.filterwarnings("ignore")  # from SciPy, if a phase begins at rest


def test_bodies_go_through_the_phases_that_the_independent_model_foresees():
    rng, tally = np.random.default_rng(1310), judge.Tally(show=5)
    words = [phases.judged(phases.drawn(rng), tally)[0] for _ in range(100)]
    assert set(words) <= {"agreed", "refused", "left out"}  # what else there is has been printed
    assert words.count("left out") < 8
    assert sum((len(name.split()) - 1) * n for name, n in tally.counts["phases"].items()) > 100


def test_starts_without_exactly_one_contact_force_are_refused_by_name():
    rng, tally = np.random.default_rng(1311), judge.Tally(show=5)
    built = [phases.undefined(rng) for _ in range(40)]
    assert all([phases.refused(start, tally) for start in built])
    assert {why for why, *_ in built} == {"a slip", "u = 0"}
