"""Motions on both rims: the references of tests/reference/lying.py keep their laws, and the library agrees.

The first half does not use the library: the table, on which two formulations agree to 24 digits or more,
obeys the balance of energy, heat and what losses take, and the closed solutions. The second half compares
`sc.roll` with it.
"""

import math
import operator
import pathlib
import sys
import types
from functools import reduce
from itertools import pairwise

import numpy as np
import pytest
from mpmath import mp, mpf
from reference_rows import off, sampled, table, whole
from scenes import LAWS

import spincyl as sc

REFERENCE = pathlib.Path(__file__).with_name("reference")
sys.path.insert(0, str(REFERENCE))

STATE = ("theta", "w1", "w2", "w3", "u_h", "u_2")
POSE = ("phi", "psi", "x", "y")
TIGHT = mpf("1e-22")


MOTIONS = table("lying.json")
each_motion = pytest.mark.parametrize("case", MOTIONS, ids=[case.name for case in MOTIONS])


def of(name):
    """The rows of a motion."""
    (case,) = (case for case in MOTIONS if case.name == name)
    return case, {row.kind: row for row in case.rows}


def start_of(case):
    """The first row, which the table leaves out."""
    start = dict(zip(STATE, map(mpf, case.start), strict=True))
    if case.start[0] == math.pi / 2 and case.start[2] == 0:
        start["theta"] = mp.pi / 2
    return types.SimpleNamespace(**start, heat=mpf(0), work=mpf(0))


def energy(case, x):
    ell, i1, i3, _ = map(mpf, case.body)
    s, c = mp.sin(x.theta), mp.cos(x.theta)
    lever, height = ell * s - c, ell * c + s
    v_h, v_2, v_z = x.u_h + height * x.w2, x.u_2 - ell * x.w1 + x.w3, lever * x.w2
    return height + (v_h**2 + v_2**2 + v_z**2 + i1 * (x.w1**2 + x.w2**2) + i3 * x.w3**2) / 2


# The table.


def test_the_motions_are_of_all_kinds_and_both_formulations_agree():
    kinds = {row.kind for case in MOTIONS for row in case.rows}
    assert kinds == {
        "sample", "end", "slides", "pivots", "straight", "lies", "rocks", "rises", "rocked",
        "rolls", "slips", "passes", "holds w1", "holds w3", "crosses", "goes on", "rests",
    }  # fmt: skip
    assert {law for case in MOTIONS for law in case.losses} == {
        "dry", "viscous", "rolling", "drilling", "air", "air2",
    }  # fmt: skip
    assert {case.law for case in MOTIONS} == {"coulomb", "viscous"}
    assert min(case.mu for case in MOTIONS) == 0
    assert any(case.static > case.mu for case in MOTIONS)
    assert len(MOTIONS) >= 12
    assert max(case.agreement for case in MOTIONS) < 1e-24


@each_motion
def test_energy_heat_and_what_losses_take_are_constant_together(case):
    with mp.workdps(40):
        totals = [energy(case, x) + x.heat + x.work for x in (start_of(case), *case.rows)]
        assert max(abs(total - totals[0]) for total in totals) < TIGHT * max(1, abs(totals[0]))
        assert all(b.heat >= a.heat - TIGHT for a, b in pairwise(case.rows))


@each_motion
def test_both_rims_slip_as_one_body_moves(case):
    with mp.workdps(40):
        for row in case.rows:
            if not mp.isnan(row.other_h):
                assert abs(row.theta - mp.pi / 2) < TIGHT and abs(row.w2) < TIGHT
                assert abs(row.other_h - row.u_h) < TIGHT
                assert abs(row.other_2 - row.u_2 + 2 * mpf(case.body[0]) * row.w1) < TIGHT


@each_motion
def test_what_sticks_has_no_slip(case):
    for row in case.rows:
        slips = [mp.hypot(row.u_h, row.u_2), mp.hypot(row.other_h, row.other_2)]
        if row.kind in ("straight", "rests"):
            assert max(slips) == row.w1 == 0
        if row.kind == "pivots":
            assert min(slips) == 0 < max(slips)
        if row.kind in ("rolls", "slips"):
            assert slips[0] == 0
        if row.kind == "holds w1":
            assert row.w1 == 0
        if row.kind in ("holds w3", "rests"):
            assert row.w3 == 0


def test_a_body_thrown_sideways_takes_the_time_of_its_closed_solution():
    case, rows = of("cylinder thrown sideways")
    with mp.workdps(40):
        mu, i3, w3, slip = mpf(case.mu), mpf(case.body[2]), mpf(case.start[3]), mpf(case.start[5])
        stop = rows["straight"]
        assert abs(stop.t - slip / (mu * (1 + 1 / i3))) < TIGHT
        assert abs(stop.w3 - (slip + w3 + i3 * w3) / (1 + i3)) < TIGHT
        assert abs(stop.heat - i3 * slip**2 / (2 * (1 + i3))) < TIGHT
        assert stop.w1 == stop.u_h == stop.u_2 == 0


def test_the_tube_pivots_and_rises_when_it_is_known_to():
    known = {
        "tube flicked at 0.5": {"straight": 16.70},
        "tube pivots and lets go": {"pivots": 15.992, "slides": 19.828, "straight": 33.104},
        "tube pivots, static friction": {"slides": 20.4615},
        "tube flicked at 0.9 rises": {"rises": 1.139},
        "tube flicked fast at 0.5": {"straight": 42.0},
    }
    for name, times in known.items():
        _, rows = of(name)
        for kind, t in times.items():
            assert abs(float(rows[kind].t) - t) < 4e-3
    assert abs(float(of("tube flicked at 0.5")[1]["straight"].w3) - 2.092) < 1e-3


def test_a_block_that_rocks_comes_to_rest_at_the_known_time():
    case, rows = of("cylinder rocks to rest")
    first = next(row for row in case.rows if row.kind == "rocks")
    assert abs(float(first.t) - 1.7551351280) < 1e-10
    assert abs(float(rows["rocked"].t) - 17.22487776086715433) < 1e-14
    # Housner's ratio of two landings, as both rims stick
    with mp.workdps(40):
        ell, i1, _, _ = map(mpf, case.body)
        inertia = i1 + 1 + ell**2
        rocks = [row for row in case.rows if row.kind == "rocks"]
        for one, other in pairwise(rocks):
            # nothing is lost between landings
            assert abs(other.w2 / one.w2 - (inertia - 2 * ell**2) / inertia) < TIGHT


def test_rolling_straight_slows_as_the_closed_solution_says():
    case, rows = of("rolling resistance and drilling")
    with mp.workdps(40):
        begin, stop = rows["straight"], rows["rests"]
        inertia = 1 + mpf(case.body[2])
        assert abs(stop.t - begin.t - inertia * abs(begin.w3) / mpf(case.losses["rolling"])) < TIGHT


# The library.


def rolled(case):
    """The motion at the times of the table."""
    ell, i1, i3, fillet = case.body
    theta, w1, w2, w3, *slip = case.start
    start = sc.State(theta, w1, w2, w3, slip=tuple(slip))
    contact = sc.Viscous(case.mu) if case.law == "viscous" else sc.Coulomb(case.mu, static=case.static)
    names = ("dry", "viscous", "rolling", "drilling", "air", "air2")
    taken = [law(case.losses[name]) for law, name in zip(LAWS, names, strict=False) if name in case.losses]
    losses = {"losses": reduce(operator.add, taken)} if taken else {}
    times = [float(row.t) for row in sampled(case)]
    if case.rows[-1].kind != "end":
        times.append(float(case.rows[-1].t) + 1)
    how = {"contact": contact, "restitution": 0.0, "want": ("pose", "force"), **losses}
    return sc.roll(sc.Body(ell, i1, i3, fillet=fillet), start, times, t0=0.0, **how)


def spent(m):
    """The heat of the slip and the landings."""
    return m.dissipated + m.lost_in_impacts


def posed(case, m):
    """The poses, told from the rim of the reference.

    After infinitely many landings that may be either rim, and phi has turned by pi any number of times.
    """
    poses = np.column_stack([m.phi, m.psi, m.contact_point])
    states = np.column_stack([m.theta, m.w, m.slip])
    for i, row in enumerate(sampled(case)):
        if any(x.kind == "rocked" and x.t <= row.t for x in case.rows):
            phi, psi, x, y = poses[i]
            halves = round((float(row.phi) - phi) / math.pi)
            if halves % 2:
                apart = 2 * case.body[0]
                poses[i] = phi, -psi, x - apart * math.cos(phi), y - apart * math.sin(phi)
                states[i] = [math.pi, 0, 0, 0, 0, 0] + states[i] * [-1, 1, -1, -1, -1, -1]
                states[i, 5] += apart * m.w[i, 0]
            poses[i, 0] += halves * math.pi
    return states, poses


@each_motion
def test_states_and_poses_are_those_of_the_reference(case):
    m, rows = rolled(case), sampled(case)
    assert m.t.tolist() == [float(row.t) for row in rows]
    states, poses = posed(case, m)
    assert off(states, rows, STATE).max() <= max(1e-11, m.error)
    assert off(whole(poses, rows), rows, POSE).max() <= max(1e-11, m.pose_error)
    assert off(spent(m)[:, None], rows, ["heat"]).max() <= max(1e-11, m.error)
    if case.losses:
        assert off(m.work_lost[:, None], rows, ["work"]).max() <= max(1e-11, m.error)


@each_motion
def test_the_other_rim_slips_as_in_the_reference(case):
    m, rows = rolled(case), sampled(case)
    for found, row in zip(m.slip_other, rows, strict=True):
        if mp.isnan(row.other_h):
            assert np.isnan(found).all()
        else:
            told = [float(row.other_h), float(row.other_2)]
            assert np.abs(found - told).max() <= max(1e-11, m.error) * max(1, *map(abs, told))


def phases_of(case):
    """Where the table says that a phase begins, and its kind as the library has it."""
    named = {"slides": "lying", "lies": "lying", "rocked": "lying", "pivots": "pivoting"}
    named |= {"straight": "rolling on its side", "slips": "slipping", "passes": "slipping"}
    found = []
    for row in case.rows:
        kind = named.get(row.kind)
        if row.kind in ("rises", "rocks", "rolls"):
            kind = "rolling" if row.u_h == row.u_2 == 0 else "slipping"
        if kind:
            # of several at one time the last one is a phase
            if found and found[-1][0].t == row.t:
                found.pop()
            found.append((row, kind))
    return found


@each_motion
def test_phases_begin_where_those_of_the_reference_do(case):
    m, true = rolled(case), phases_of(case)
    if case.rows[-1].kind == "rests" and true and true[-1][0].t == case.rows[-1].t:
        true.pop()
    most, found = max(1e-11, m.error), list(m.phases[1:])
    if any(row.kind == "rocked" for row in case.rows):
        # only the first landings of a rocking have rows
        near = [[abs(phase.time - float(row.t)) for phase in found] for row, _ in true]
        found = [found[int(np.argmin(distances))] for distances in near]
    assert [phase.kind for phase in found] == [kind for _, kind in true]
    for phase, (row, _) in zip(found, true, strict=True):
        assert abs(phase.time - float(row.t)) <= most
        if row.kind != "rocked":
            there = phase.state
            told = [there.theta, there.w1, there.w2, there.w3, *there.slip]
            assert off([told], [row], STATE).max() <= most


@each_motion
def test_motions_end_where_those_of_the_reference_do(case):
    m, last = rolled(case), case.rows[-1]
    if last.kind == "end":
        assert m.status == sc.Ending.DONE
        return
    assert m.status == sc.Ending.STOPS
    assert abs(m.event.time - float(last.t)) <= max(1e-11, m.error)
