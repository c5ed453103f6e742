"""Sweeps without estimated errors have the same results as sweeps with them."""

import warnings

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


@pytest.mark.parametrize(
    ("contact", "how", "said"),
    [
        (
            sc.Coulomb(0.3, patch=[0.02, 0.01]),
            {"losses": sc.loss.Drilling(1e-3)},
            "^2 of 2 motions are invalid .*; motion 0, .*: patch = 0.02: expected 0 together with drilling",
        ),
        (
            sc.Coulomb(0.3, patch=[0.0, 0.01]),
            {"losses": sc.loss.Drilling(1e-3)},
            "^1 of 2 motions are invalid .*; motion 1, .*: patch = 0.01: expected 0 together with drilling",
        ),
    ],
)
def test_a_sweep_gives_the_reason_for_which_laws_do_not_go_together(contact, how, said):
    with pytest.warns(RuntimeWarning, match=said):
        found = sc.sweep.roll(sc.Body.solid(1.5), sc.State(1.2, 0.1, 0.0, 0.3), 1.0, contact=contact, **how)
    invalid = found.status == sc.sweep.Status.INVALID
    assert invalid.sum() == int(said[1]) and np.isnan(found.theta.where(invalid)).all()


def test_a_sweep_warns_of_large_errors_as_a_single_motion_does():
    body, start, how = (
        sc.Body.ball(0.3, 0.4, 0.35),
        sc.State(0.5, 1.0, 0.4, 0.8),
        {"losses": LAWS["losses"]["losses"]},
    )
    with pytest.warns(sc.ErrorWarning, match="estimated error of the motion"):
        alone = sc.roll(body, start, 400.0, tol=0.01, **how)
    starts = sc.State(0.5, 1.0, 0.4, np.array([0.8, np.nan]))
    with pytest.warns(sc.ErrorWarning, match="^1 of 2 motions have estimated errors above 0.1"):
        found = sc.sweep.roll(body, starts, 400.0, tol=0.01, **how)
    assert alone.error > 0.1 and found.error[0] > 0.1


COIN = sc.measured(outer_diameter="24mm", length="2mm", mass="8g")
HOPS = {"contact": sc.Coulomb(0.3), "restitution": 0.3}


def test_a_sweep_of_bodies_that_hop_warns_once_of_those_that_are_no_longer_known():
    starts = sc.flicked(COIN, hertz=8, launch=np.array([0.2, 1.3, 0.3, 1.3]))
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        found = sc.sweep.roll(COIN, starts, 10.0, **HOPS)
    natural = sc.roll(
        COIN.natural, sc.flicked(COIN, hertz=8, launch=1.3), 10.0 / COIN.scale.seconds(1.0), **HOPS
    )
    (one,) = said
    assert one.category is sc.ErrorWarning
    worst = f"up to {natural.error:.2g}: motions 1, 3; `error` of the result has all errors. Impacts multiply"
    assert f"2 of 4 motions have estimated errors above 0.1, in natural units, {worst}" in str(one.message)
    assert (np.flatnonzero(found.error > found.error[0] * 1e3) == [1, 3]).all()


def test_of_many_motions_that_are_not_known_the_first_five_are_told():
    starts = sc.flicked(COIN, hertz=8, launch=np.full(7, 1.3))
    with pytest.warns(sc.ErrorWarning, match="^7 of 7 .*: motions 0, 1, 2, 3, 4, [.]{3}; `error`"):
        sc.sweep.roll(COIN, starts, 10.0, **HOPS)


def test_a_sweep_of_bodies_that_hop_and_are_known_does_not_warn():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = sc.sweep.roll(COIN, sc.flicked(COIN, hertz=8, launch=np.array([0.2, 1.3])), 0.05, **HOPS)
    assert (found.error < 0.1 / COIN.scale.seconds(1.0)).all()  # in rad/s
