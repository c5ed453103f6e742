"""Random starts with friction: the phases of an independent model in plain doubles, and the starts it calls undefined.

benches/slip_starts.py has the model, and asks the same of ten thousand starts.
"""

import pathlib
import sys

import numpy as np
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "benches"))
import slip_starts

pytestmark = pytest.mark.filterwarnings("ignore")  # of SciPy, where a phase begins at rest


def test_bodies_go_through_the_phases_that_the_independent_model_foresees():
    rng = np.random.default_rng(1310)
    phases, left_out = 0, 0
    for _ in range(100):
        start = slip_starts.drawn(rng)
        try:
            prediction = slip_starts.predicted(*start)
        except slip_starts.Doubtful:
            left_out += 1
            continue
        answer = slip_starts.asked(*start)
        word, _ = slip_starts.verdict(prediction, answer)
        if word == "wrong" and slip_starts.sensitive(prediction, start):
            left_out += 1
            continue
        assert word in ("agreed", "refused"), (start, prediction, answer)
        phases += len(prediction[0])
    assert left_out < 8
    assert phases > 100


def test_starts_without_exactly_one_contact_force_are_refused_by_name():
    rng = np.random.default_rng(1311)
    reasons = []
    for _ in range(40):
        why, body, mu, start = slip_starts.undefined(rng)
        found, message, _ = slip_starts.asked(body, mu, mu, start)
        assert found is None, (why, body, mu, start)
        assert "no unique contact force (Painleve): mu = " in message
        assert "theta = " in message and "mu_P" in message
        reasons.append(why)
    assert set(reasons) == {"a slip", "u = 0"}
