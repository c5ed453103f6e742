"""Random starts with friction: phases agree with an independent model in doubles, as do undefined starts.

benches/slip_starts.py has the model, and tests ten thousand starts.
"""

import pathlib
import sys

import numpy as np
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "benches"))
import judge
import slip_starts

pytestmark = pytest.mark.filterwarnings("ignore")  # from SciPy, if a phase begins at rest


def test_bodies_go_through_the_phases_that_the_independent_model_foresees():
    rng, tally = np.random.default_rng(1310), judge.Tally(show=5)
    words = [slip_starts.judged(slip_starts.drawn(rng), tally)[0] for _ in range(100)]
    assert set(words) <= {"agreed", "refused", "left out"}  # any other verdict has been printed
    assert words.count("left out") < 8
    phases = {name: n for name, n in tally.counts.items() if name.startswith("phases: ")}
    assert sum((len(name.split()) - 2) * n for name, n in phases.items()) > 100


def test_starts_without_exactly_one_contact_force_are_refused_by_name():
    rng, tally = np.random.default_rng(1311), judge.Tally(show=5)
    built = [slip_starts.undefined(rng) for _ in range(40)]
    assert all([slip_starts.refused(start, tally) for start in built])
    assert {why for why, *_ in built} == {"a slip", "u = 0"}
