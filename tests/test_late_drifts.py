"""Drifts of rolling up to their ends: tests/reference/late.py against single and many drifts."""

import json
from pathlib import Path

import numpy as np
import pytest
from scenes import LAWS

import spincyl as sc

CASES = json.loads((Path(__file__).parent / "reference" / "late.json").read_text())
ENDS = {
    "lands": ("face lands", "stands upright"),
    "lies down": ("lies down",),
    "stability lost": ("stability lost",),
}
BOUND = 1e-10


def drifted(case, repeat=0):
    """The drift of a case, or `repeat` copies of it."""
    ell, i1, i3, fillet = (np.full(repeat, x) if repeat else x for x in case["body"])
    body = sc.Body(ell, i1, i3, fillet=fillet)
    theta, w1, w3 = case["state"]
    state = sc.State(theta, w1, 0.0, w3)
    some = [law(k) for law, k in zip(LAWS, case["losses"], strict=False) if k]
    return sc.drift(body, state, sum(some[1:], start=some[0]), centre="rolling")


def rows(case):
    """t, theta, w1 and w3."""
    return np.array([[float(x) for x in row] for row in case["rows"]]).T


each = pytest.mark.parametrize("case", CASES, ids=[case["name"] for case in CASES])


def test_the_late_drifts_are_of_all_kinds_and_their_references_agree():
    assert len(CASES) >= 13 and max(case["agreement"] for case in CASES) < 1e-14
    assert {case["ended"] for case in CASES} >= {"lands", "lies down"}
    assert sum(case["body"][3] == 1.0 for case in CASES) >= 3
    small = [case for case in CASES if rows(case)[1].min() < 1e-18]
    assert small, "none comes so near to its face that only the sine's own digits tell"


@each
def test_a_drift_of_rolling_has_its_digits_until_99_percent_of_its_time(case):
    d = drifted(case)
    assert d.ended in ENDS[case["ended"]]
    assert abs(d.stops_at / float(case["stops"]) - 1) <= BOUND
    t, theta, w1, w3 = rows(case)
    y, rate = d.state(t), w1 / np.sin(theta)
    assert np.abs(y.theta / theta - 1).max() <= BOUND
    assert np.abs(y.w1 / w1 - 1).max() <= BOUND
    assert (np.abs(y.w3 - w3) <= BOUND * np.hypot(w1, w3)).all()
    # theta next to pi has lost the digits of its sine
    known = np.pi - theta > 1e-3
    assert np.abs(d.precession(t) / rate - 1)[known].max(initial=0.0) <= BOUND
    assert np.abs(d.time(theta) / t - 1)[known].max(initial=0.0) <= BOUND


@each
def test_many_drifts_of_rolling_are_the_one_that_the_reference_has(case):
    many = drifted(case, repeat=9)
    assert (many.ended == many.ended[0]).all() and many.ended[0] in ENDS[case["ended"]]
    assert np.abs(many.stops_at / float(case["stops"]) - 1).max() <= BOUND
    t, theta, w1, _ = rows(case)
    y = many.state(t[:, None])
    assert np.abs(y.theta / theta[:, None] - 1).max() <= BOUND
    assert np.abs(y.w1 / w1[:, None] - 1).max() <= BOUND


def test_nothing_tilts_however_small_the_inclination_has_become():
    case = CASES[0]
    d = drifted(case)
    y = d.state(rows(case)[0])
    # theta'' is a difference of terms of this size
    size = y.w1**2 / np.tan(y.theta) + np.abs(y.w1 * y.w3 / np.tan(y.theta)) + 1
    assert (np.abs(d.body.acceleration(y)) <= 1e-10 * size).all()


@pytest.mark.parametrize("share", [1.0, 0.5, 1e-3])
def test_a_face_that_comes_down_over_a_hundred_thousand_e_folds_lands_when_its_spin_has_fallen_to_zero(share):
    # a thin disk whose centre runs on a circle: rolling resistance reduces its spin at a constant rate
    body = sc.Body(0.001710650545067889, 0.2500009754417625, 0.5)
    start = sc.State(0.2333783408782825, 1.0329662274017193, 0.0, 0.09733219824894633)
    d = sc.drift(body, start, sc.loss.RollingResistance(share * 0.004001044732879072), centre="rolling")
    t = d.time(np.array([1e-100, 1e-139]))
    w3 = d.state(t).w3
    lands = t[1] + w3[1] * (t[1] - t[0]) / (w3[0] - w3[1])
    assert d.ended == "face lands" and d.stops_at > 5 * t[1]
    assert abs(d.stops_at / lands - 1) < BOUND


def test_disks_on_circles_land_when_their_spin_has_fallen_to_zero():
    rng = np.random.default_rng(7)
    ell, heavy = rng.choice([1e-3, 1e-2, 0.1], 400) * rng.uniform(0.5, 1.5, 400), rng.uniform(1, 2, 400)
    body = sc.Body(ell, 0.25 * heavy + ell**2 / 3, 0.5)
    start = body.circular(rng.uniform(0.02, 1.5, 400), np.exp(rng.normal(0.7, 0.8, 400)))
    d = sc.drift(body, start, sc.loss.RollingResistance(10 ** rng.uniform(-5, -1, 400)), centre="rolling")
    t = d.time(np.array([[1e-100], [1e-139]]))
    # the last part, which has no steps, takes considerable time
    late = (d.stops_at > 1.1 * t[1]) & np.isfinite(d.stops_at)
    t, w3 = t[:, late], d.state(t).w3[:, late]
    lands = t[1] + w3[1] * (t[1] - t[0]) / (w3[0] - w3[1])
    assert late.sum() > 40
    assert np.abs(d.stops_at[late] / lands - 1).max() < BOUND


FADING = json.loads((Path(__file__).parent / "reference" / "fading.json").read_text())


@pytest.mark.parametrize("repeat", [0, 9])
@pytest.mark.parametrize("case", FADING, ids=[case["name"] for case in FADING])
def test_the_spin_of_what_is_nearly_a_ball_outlasts_its_inclination(case, repeat):
    assert case["agreement"] < 1e-14 and len(case["rows"]) >= 3
    d = drifted(case, repeat)
    assert np.abs(d.stops_at / float(case["stops"]) - 1).max() <= BOUND
    t, w3 = np.array([[float(x) for x in row] for row in case["rows"]]).T
    y = d.state(t[:, None] if repeat else t)
    known = w3[:, None] if repeat else w3
    assert (np.abs(y.w3 - known) <= BOUND * np.hypot(y.w1, known)).all()
    # a flat body keeps w1/w3, whatever its remaining inclination
    ell, i1, _, fillet = case["body"]
    depth = ell + fillet
    flat = y.theta < 1e-15
    ratio = (1 - fillet) * depth / (i1 + depth**2)
    assert flat.any() and np.abs(y.w1 / y.w3 / ratio - 1)[flat].max() <= BOUND
