"""Motions and drifts with losses: the references of tests/reference/losses.py and drifts.py, and the library.

The first half does not use the library: the tables, from three-dimensional models in two formulations, obey
the balance of energy and work, the closed solutions of the thin disk, and the equations of steady rolling.
The second half compares `sc.roll(..., losses=)` and `sc.drift` with them.
"""

import json
import math
import operator
import pathlib
import sys
import types
from functools import reduce

import numpy as np
import pytest
from mpmath import mp, mpf
from scenes import LAWS

import spincyl as sc

REFERENCE = pathlib.Path(__file__).with_name("reference")
sys.path.insert(0, str(REFERENCE))
import newton_euler as ne  # noqa: E402

# a coin at 0.001 rad is below eps, which warns
pytestmark = pytest.mark.filterwarnings("ignore::spincyl.DriftWarning")

STATE = ("theta", "w1", "w2", "w3")
POSE = ("phi", "psi", "x", "y")
ON_THE_WAY = ("sample", "end")
CONTOUR = ("dry", "viscous", "film", "layer", "rolling")


def table(name):
    """The cases of a table, with rows of exact numbers."""
    with (REFERENCE / f"{name}.json").open() as file, mp.workdps(40):
        data = json.load(file)
        columns = data["columns"]
        cases = []
        for case in data[{"losses": "motions"}.get(name, name)]:
            rows = [dict(zip(columns, row, strict=True)) for row in case["rows"]]
            rows = [{k: v if k == "kind" else mpf(v) for k, v in row.items()} for row in rows]
            named = {k: v for k, v in zip(data["laws"], case["losses"], strict=True) if v}
            cases.append(
                types.SimpleNamespace(
                    **{**case, "rows": [types.SimpleNamespace(**r) for r in rows]}, laws=named
                )
            )
        return cases


MOTIONS, DRIFTS = table("losses"), table("drifts")
# the library refuses AirFilm and BoundaryLayer for a ball, which has no face
FACELESS = [d for d in DRIFTS if d.body[3] == 1.0 and {"film", "layer"} & set(d.laws)]
DRIFTS = [d for d in DRIFTS if d not in FACELESS]
RESTING = [d for d in DRIFTS if d.centre == "rest"]
ROLLING = [d for d in DRIFTS if d.centre == "rolling"]


def each(cases):
    return pytest.mark.parametrize("case", cases, ids=[case.name for case in cases])


# The tables.


def test_the_motions_are_of_all_kinds_and_both_formulations_agree():
    kinds = {row.kind for case in MOTIONS for row in case.rows}
    assert kinds == {
        "sample", "end", "rolls", "slips", "side", "face", "stops", "crosses", "holds", "goes on",
    }  # fmt: skip
    alone = {next(iter(case.laws)) for case in MOTIONS if len(case.laws) == 1}
    assert alone == {"dry", "viscous", "rolling", "drilling", "air", "air2", "film", "layer"}
    assert {case.contact for case in MOTIONS} == {"rolling", "smooth", "coulomb"}
    assert len(MOTIONS) >= 20
    assert max(case.agreement for case in MOTIONS) < 1e-25


@each(MOTIONS)
def test_energy_and_work_lost_together_are_constant(case):
    with mp.workdps(40):
        body = [mpf(x) for x in case.body]

        def total(x):
            return ne.energy(body, x) + x.work + x.heat

        start = dict(zip((*STATE, "u_h", "u_2"), map(mpf, case.start), strict=True))
        begin = total(types.SimpleNamespace(**start, work=mpf(0), heat=mpf(0)))
        assert max(abs(total(row) - begin) for row in case.rows) < 1e-23 * max(1, abs(begin))
        assert case.rows[-1].work > 1e-4


def test_the_contact_point_is_at_rest_where_it_stops_and_crosses():
    found = 0
    for case in MOTIONS:
        with mp.workdps(40):
            for row in case.rows:
                if row.kind in ("stops", "crosses"):
                    found += 1
                    assert abs(row.w3 - row.w1 * mp.cot(row.theta)) < 1e-20 * abs(row.w1 / row.theta)
    assert found >= 7


def test_the_drifts_are_of_all_kinds():
    ended = {(case.centre, case.ended) for case in DRIFTS}
    assert ended >= {
        ("rest", "face lands"),
        ("rest", "lies down"),
        ("rest", "lowest state"),
        ("rest", "balanced"),
        ("rest", "stands upright"),
        ("rolling", "face lands"),
        ("rolling", "lies down"),
        ("rolling", "stability lost"),
        ("rolling", "drilling stops"),
    }
    assert max(case.agreement for case in RESTING) < 1e-24
    assert max(case.agreement for case in ROLLING) < 1e-16


# a quantity that grows at a constant rate, and its rate: a factor, and the power of sqrt(I1), over k
THIN = {
    "viscous": (lambda x: mp.log(mp.cos(x)), 3 / mpf(2), 2),
    "drilling": (lambda x: 1 / mp.sqrt(mp.sin(x)), mpf(3), 1),
    "air": (lambda x: -mp.log(mp.sin(x)), 3 / mpf(2), 2),
}


@pytest.mark.parametrize("law", THIN)
def test_a_thin_disk_takes_the_closed_times(law):
    (case,) = (case for case in RESTING if case.name == f"coin, {law}")
    shape, factor, power = THIN[law]
    with mp.workdps(30):
        unit = factor * mp.sqrt(mpf(case.body[1])) ** power / mpf(case.laws[law])
        for row in case.rows:
            assert abs(unit * (shape(row.theta) - shape(mpf(case.theta))) / row.t - 1) < 1e-23


@each(DRIFTS)
def test_every_state_of_a_drift_is_steady(case):
    with mp.workdps(40):
        body = [mpf(x) for x in case.body]
        for row in case.rows:
            rate = ne.derivative(body, [row.theta, row.w1, mpf(0), row.w3], "rolling")[2]
            assert abs(rate) < 1e-20 * max(1, abs(row.w1 / mp.sin(row.theta)) ** 2)


def test_contour_laws_and_rolling_resistance_share_one_path_of_rolling():
    paths = [
        d.rows for d in ROLLING if d.name.startswith("Euler's disk rolls") and next(iter(d.laws)) in CONTOUR
    ]
    assert len(paths) == len(CONTOUR)
    for rows in paths[1:]:
        for row, other in zip(rows, paths[0], strict=True):
            assert row.theta == other.theta
            assert abs(row.w1 / other.w1 - 1) < 1e-18
            assert abs(row.w3 - other.w3) < 1e-18


# The library.


def body_of(case):
    ell, i1, i3, fillet = case.body
    return sc.Body(ell, i1, i3, fillet=fillet)


def losses_of(case):
    return reduce(operator.add, (law(k) for law, k in zip(LAWS, case.losses, strict=False) if k))


def rolled(case, at=None):
    """The motion at the times of the table, and beyond them to its end; or at the times `at`."""
    theta, w1, w2, w3, *slip = case.start
    slips = case.contact == "coulomb"
    start = sc.State(theta, w1, w2, w3, slip=tuple(slip) if slips else None)
    contact = sc.Coulomb(case.mu) if slips else case.contact
    friction = {"mu": case.mu} if case.contact == "rolling" and case.mu else {}
    times = [float(row.t) for row in case.rows if row.kind in ON_THE_WAY]
    if case.rows[-1].kind != "end":
        times.append(float(case.rows[-1].t) + 1)
    times = times if at is None else at
    how = {"contact": contact, "losses": losses_of(case), "beyond": case.beyond, **friction}
    return sc.roll(body_of(case), start, times, t0=0.0, want="pose", **how)


def off(found, rows, names):
    """The errors, and the errors relative to the largest number of the row or 1."""
    true = np.array([[float(getattr(row, name)) for name in names] for row in rows])
    error = np.abs(np.asarray(found) - true)
    return error, error / np.maximum(1, np.abs(true).max(axis=1, keepdims=True))


@each(MOTIONS)
def test_states_and_work_are_those_of_the_reference(case):
    m = rolled(case)
    samples = [row for row in case.rows if row.kind in ON_THE_WAY]
    assert m.t.tolist() == [float(row.t) for row in samples]
    if not samples:
        return
    states, scaled = off(np.column_stack([m.theta, m.w]), samples, STATE)
    assert scaled.max() <= 1e-10
    assert states.max() <= 10 * m.error + 1e-14
    assert off(m.work_lost[:, None], samples, ["work"])[1].max() <= 1e-10
    poses, scaled = off(np.column_stack([m.phi, m.psi, m.contact_point]), samples, POSE)
    if case.contact != "smooth":  # on a smooth table the centre may have any constant velocity
        assert scaled.max() <= 1e-10
        assert poses.max() <= 10 * m.pose_error + 1e-14
    assert off(np.column_stack([m.phi, m.psi]), samples, POSE[:2])[1].max() <= 1e-10


ENDINGS = {"slips": sc.Ending.SLIP, "side": sc.Ending.SIDE, "face": sc.Ending.FACE}


@each([case for case in MOTIONS if any(row.kind in ENDINGS for row in case.rows)])
def test_motions_end_where_those_of_the_reference_do(case):
    m = rolled(case)
    last = next(row for row in case.rows if row.kind in ENDINGS)
    assert m.status == m.event.ending == ENDINGS[last.kind]
    late = abs(m.event.time - float(last.t))
    assert late <= 1e-10 * max(1, last.t)
    there = m.event.state
    errors, scaled = off([[there.theta, there.w1, there.w2, there.w3]], [last], STATE)
    assert scaled.max() <= 1e-10
    assert max(errors.max(), late) <= 10 * m.error + 1e-14


@each([case for case in MOTIONS if any(row.kind == "stops" for row in case.rows)])
def test_dry_friction_stops_the_contact_when_and_where_that_of_the_reference_stops(case):
    stop = next(row for row in case.rows if row.kind == "stops")
    m = rolled(case, [float(stop.t), float(stop.t) + 1e-7])
    errors, scaled = off([[m.theta[0], *m.w[0]]], [stop], STATE)
    assert scaled.max() <= 1e-10 and errors.max() <= 10 * m.error + 1e-14
    # held from there on, until its face lands or it moves again
    assert m.t.size == 1 or abs(m.states.spin[1]) <= 1e-12 * (1 + abs(m.states.precession[1]))


@each([case for case in MOTIONS if case.contact == "coulomb"])
def test_slip_with_losses_ends_where_that_of_the_reference_does(case):
    m = rolled(case)
    assert [phase.kind for phase in m.phases] == ["slipping", "rolling"]
    (stop,) = (row for row in case.rows if row.kind == "rolls")
    assert abs(m.phases[1].time - float(stop.t)) <= 1e-10
    there = m.phases[1].state
    assert off([[there.theta, there.w1, there.w2, there.w3]], [stop], STATE)[1].max() <= 1e-10
    samples = [row for row in case.rows if row.kind in ON_THE_WAY]
    assert off(m.dissipated[:, None], samples, ["heat"])[1].max() <= 1e-10
    assert off(m.slip, samples, ["u_h", "u_2"])[1].max() <= 1e-10


@each([case for case in MOTIONS if case.rows[-1].kind == "end"])
def test_motions_that_do_not_end_are_followed_to_the_last_time(case):
    m = rolled(case)
    assert m.status == sc.Ending.DONE
    assert m.t[-1] == float(case.rows[-1].t)


def drifted(case):
    return sc.drift(body_of(case), case.theta, losses_of(case), centre=case.centre)


@each(FACELESS)
def test_a_ball_presses_out_no_air(case):
    with pytest.raises(ValueError, match="flat face"):
        drifted(case)


@each(DRIFTS)
def test_drifts_take_the_times_of_the_reference(case):
    bound = 1e-12 if case.centre == "rest" else 1e-10
    d = drifted(case)
    theta, t = (np.array([float(getattr(row, name)) for row in case.rows]) for name in ("theta", "t"))
    assert np.abs(d.time(theta) / t - 1).max() <= bound
    rate = np.array([float(row.w1 / mp.sin(row.theta)) for row in case.rows])
    for found, true in ((d.theta(t), theta), (d.precession(t), rate)):
        steep = np.abs(np.gradient(np.log(true), np.log(t)))  # amplification of a relative error of the time
        assert (np.abs(found / true - 1) <= bound * (1 + 4 * steep)).all()


@each(DRIFTS)
def test_drifts_pass_the_states_of_the_reference(case):
    bound = 1e-11 if case.centre == "rest" else 1e-10
    d = drifted(case)
    there = d.state(np.array([float(row.t) for row in case.rows]))
    found = np.column_stack([there.theta, there.w1, there.w3])
    assert off(found, case.rows, ("theta", "w1", "w3"))[1].max() <= bound


@each(DRIFTS)
def test_drifts_end_as_those_of_the_reference_do(case):
    bound = 1e-12 if case.centre == "rest" else 1e-10
    d = drifted(case)
    stops = float(mpf(case.stops))
    assert d.ended == case.ended
    assert abs(d.ends_at_theta - float(mpf(case.ends))) <= bound
    if math.isinf(stops):
        assert d.stops_at == math.inf
    else:
        assert abs(d.stops_at / stops - 1) <= bound
    if case.centre == "rest":
        stable = float(mpf(case.stable or "inf"))
        assert d.stable_until == stable or abs(d.stable_until / stable - 1) <= 1e-10
