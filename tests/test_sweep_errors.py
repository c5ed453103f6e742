"""Sweeps without estimated errors have the same results as sweeps with them."""

import numpy as np
import pytest

import spincyl as sc

COUNT = 40
ELL = np.linspace(0.6, 2.5, COUNT)
BODY = sc.Body.solid(ELL)
START = sc.State(1.2, np.linspace(-1, 1, COUNT), 0.2, np.linspace(0.5, -0.8, COUNT))
LAWS = {
    "friction": {"contact": sc.Coulomb(0.3)},
    "hops": {"contact": sc.Coulomb(0.4), "restitution": 0.5},
    "losses": {"losses": sc.loss.AirQuadratic(0.01)},
    "rolling": {},
}


@pytest.mark.parametrize("name", LAWS)
def test_without_errors_a_sweep_has_the_same_results(name):
    how = {"want": ("final", "end"), "tol": 1e-8, **LAWS[name]}
    known, bare = (sc.sweep.roll(BODY, START, 6.0, errors=errors, **how) for errors in (True, False))
    for column in known.drop_vars("error"):
        assert np.array_equal(known[column], bare[column], equal_nan=True), column
    integrated = (bare.method == sc.sweep.Answer.FLOW).values
    assert integrated.any() == (name != "rolling")
    assert np.isnan(bare.error.values[integrated]).all()
    assert np.array_equal(bare.error.values[~integrated], known.error.values[~integrated], equal_nan=True)
    assert np.isfinite(known.error.values[known.method.values > 0]).any()


def test_the_inputs_of_a_sweep_without_errors_repeat_it():
    found = sc.sweep.roll(BODY, START, 6.0, errors=False, **LAWS["friction"])
    given = sc.sweep.inputs(found)
    assert given["errors"] is False
    assert np.array_equal(sc.sweep.roll(**given).w3, found.w3, equal_nan=True)
    assert "errors" not in sc.sweep.inputs(sc.sweep.roll(BODY, START, 6.0, **LAWS["friction"]))


def test_errors_are_a_flag_and_stones_have_them_always():
    with pytest.raises(TypeError, match="^errors"):
        sc.sweep.roll(BODY, START, 1.0, errors=0)
    stone = sc.Ellipsoid.rattleback((1.0, 0.15, 0.1), twist=0.1)
    with pytest.raises(ValueError, match="errors.*only for bodies"):
        sc.sweep.roll(stone, stone.spinning([-0.6, 0.5], pitch=0.02), 1.0, errors=False)
