"""A body on its face on a tilted table: the references of tests/reference/slope_face.py, and the library beside them.

The first half does not use the library: the table obeys the balance of energy with gravity along the slope, the bounds
of friction and pressure, and the closed solutions of blocks, of viscous friction and of what tips. The second half
compares `sc.roll` with it.
"""

import types
from itertools import pairwise

import numpy as np
import pytest
from mpmath import mp, mpf
from reference_rows import named, off, sampled, stood, table, whole
from test_slope_reference import POSE, STATE, TIGHT, Placed

import spincyl as sc

MOTIONS = table("slope_face.json")
each_motion = pytest.mark.parametrize("case", MOTIONS, ids=[case.name for case in MOTIONS])
#: two formulations of which one adds with 64 bits differ by less
MET = mpf("1e-17")


def of(name):
    return named(MOTIONS, name)


def start(case):
    numbers = dict(zip(STATE, map(mpf, case.start), strict=True))
    pose = dict(zip(POSE, map(mpf, (case.phi, 0, *case.place)), strict=True))
    return types.SimpleNamespace(**numbers, **pose, t=mpf(0), heat=mpf(0), work=mpf(0), kind="start")


def placed(case, row):
    case.turning = 0.0
    return Placed(case, row)


def gravity(case):
    return mp.sin(mpf(case.slope)), mp.cos(mpf(case.slope))


def velocity(case, row):
    """Of the centre, along the table."""
    return mp.mpc(*placed(case, row).velocity[:2])


# The table.


def test_the_motions_are_of_all_kinds_and_both_formulations_agree():
    kinds = {row.kind for case in MOTIONS for row in case.rows}
    assert kinds >= {"sample", "end", "rests", "topples", "tips"}
    assert {case.face for case in MOTIONS} == {"ring", "disc"}
    assert {case.law for case in MOTIONS} == {"coulomb", "viscous", "smooth"}
    assert any("air" in case.losses for case in MOTIONS)
    assert any(case.body[3] > 0 for case in MOTIONS)
    assert any(0 < case.mu < mp.tan(case.slope) for case in MOTIONS)
    assert len(MOTIONS) >= 15
    assert all(case.agreement < (1e-17 if case.digits < 25 else 1e-28) for case in MOTIONS)


@each_motion
def test_energy_heat_and_what_losses_take_are_constant_together(case):
    with mp.workdps(40):
        known = placed(case, start(case)).energy
        for row in case.rows:
            most = MET if case.digits < 25 else TIGHT
            assert abs(placed(case, row).energy + row.heat + row.work - known) < most * max(1, known), (
                row.kind
            )
        assert all(b.heat >= a.heat - TIGHT and b.work >= a.work - TIGHT for a, b in pairwise(case.rows))


@each_motion
def test_the_centre_of_the_pressure_is_in_the_face_and_friction_is_at_most_that_of_a_slide(case):
    a, z, *_ = stood(case)
    with mp.workdps(40):
        level = gravity(case)[1]
        for row in case.rows:
            if not mp.isnan(row.f_h):
                force = mp.hypot(row.f_h, row.f_2)
                assert z * force <= a * level * (1 + TIGHT)
                assert case.law == "viscous" or force <= mpf(case.mu) * level * (1 + TIGHT)


@each_motion
def test_friction_turns_a_body_that_spins_counterclockwise_to_its_right(case):
    with mp.workdps(40):
        for row in case.rows:
            moves = velocity(case, row)
            if mp.isnan(row.f_h) or not moves or not row.w3 or not case.mu:
                continue
            force = (row.f_h + 1j * row.f_2) * mp.expj(row.phi)
            assert (force / moves).real < 0 and (force / moves).imag * row.w3 < 0


def test_a_coin_spun_in_place_drifts_downhill_and_to_one_side_until_it_rests():
    for name in ("coin spun in place", "disc spun in place"):
        case, rows = of(name)
        _, z, _, i3 = stood(case)
        rest = rows["rests"]
        with mp.workdps(40):
            out = mp.mpc(rest.x, rest.y)
            assert out.real > 0 and out.imag < 0 and mp.tan(mpf(case.slope)) < case.mu
            # it turns longer than a level one, which rests after I3 w/(mu a), or 3/2 of that
            level = i3 * mpf(case.start[3]) / case.mu * (1 if case.face == "ring" else mpf(3) / 2)
            assert level < rest.t and z * case.mu < 1


def test_what_does_not_spin_slides_as_a_block():
    for name in ("block thrown across", "block thrown uphill slides for good"):
        case, _ = of(name)
        with mp.workdps(40):
            share = mpf(case.mu) / mp.tan(mpf(case.slope))

            def kept(row, case=case, share=share):
                v = velocity(case, row)
                return abs(v) * mp.sin(mp.arg(v)) * mp.tan(mp.arg(v) / 2) ** -share

            moving = [row for row in case.rows if row.kind != "rests"]
            assert len(moving) >= 3
            assert all(abs(kept(row) / kept(start(case)) - 1) < TIGHT for row in moving)


def test_viscous_friction_of_a_face_is_that_of_a_complex_velocity_and_carries_the_weight_in_the_end():
    case, rows = of("viscous")
    with mp.workdps(40):
        (downhill, level), c, (_, z, *_) = gravity(case), mpf(case.mu), stood(case)
        for row in case.rows:
            force = (row.f_h + 1j * row.f_2) * mp.expj(row.phi)
            assert abs(force + c * level * velocity(case, row) / (1 - 1j * c * z * row.w3)) < TIGHT
        end = rows["end"]
        late = [abs((x.f_h + 1j * x.f_2) * mp.expj(x.phi) + downhill) for x in case.rows]
        assert all(b < a for a, b in pairwise(late)) and end is case.rows[-1]


def test_a_film_lets_a_body_go_when_its_drag_is_as_far_ahead_as_the_rim():
    case, rows = of("viscous, topples")
    with mp.workdps(40):
        (downhill, level), c, (a, z, *_) = gravity(case), mpf(case.mu), stood(case)
        begin, first = rows["topples"], mpf(case.start[4])
        last = downhill / (c * level)
        # v tends to its last value as exp(-c level t), and z c v = a where it topples
        met = a / (z * c)
        assert abs(begin.t - mp.log((last - first) / (last - met)) / (c * level)) < TIGHT
        assert abs(begin.u_h + met) < TIGHT and abs(begin.phi - mp.pi) < TIGHT


def test_on_a_smooth_slope_the_centre_falls_downhill():
    case, _ = of("smooth")
    with mp.workdps(40):
        begun, downhill = start(case), gravity(case)[0]
        for row in case.rows:
            assert abs(velocity(case, row) - velocity(case, begun) - downhill * row.t) < TIGHT
            gone = velocity(case, begun) * row.t + downhill * row.t**2 / 2
            assert abs(mp.mpc(row.x - begun.x, row.y - begun.y) - gone) < TIGHT
            assert row.w3 == begun.w3 and abs(row.psi - row.w3 * row.t) < TIGHT


def test_what_is_let_go_where_friction_cannot_hold_it_slides_straight_down():
    case, _ = of("let go on a steep slope")
    with mp.workdps(40):
        begun, (downhill, level) = start(case), gravity(case)
        for row in case.rows:
            faster = downhill - case.mu * level
            assert abs(velocity(case, row) - faster * row.t) < TIGHT
            assert abs(mp.mpc(row.x - begun.x, row.y - begun.y) - faster * row.t**2 / 2) < TIGHT


def test_what_tips_from_rest_turns_about_the_lowest_point_as_its_energy_says():
    case, rows = of("tips over from rest")
    a, z, i1, _ = stood(case)
    with mp.workdps(40):
        downhill, level = gravity(case)
        begin = rows["tips"]
        far = a * mp.expj(mpf(case.phi)) + a
        assert abs(mp.mpc(begin.x, begin.y) - mp.mpc(*map(mpf, case.place)) - far) < TIGHT
        for row in case.rows:
            s, c = mp.sin(row.theta), mp.cos(row.theta)
            fallen = level * (z - a * s - z * c) + downhill * (a - a * c + z * s)
            assert abs((i1 + a * a + z * z) * row.w2**2 / 2 - fallen) < TIGHT
            assert abs(row.phi - mp.pi) < TIGHT and abs(row.x - begin.x) < TIGHT
            assert row.u_h == row.w1 == row.heat == 0


def test_what_topples_as_it_slides_leans_first_as_on_a_level_table_and_turns_with_the_slip():
    for name in ("topples as it slides down", "topples as it slides across with spin"):
        case, rows = of(name)
        a, z, i1, i3 = stood(case)
        begin = rows["topples"]
        first = next(row for row in case.rows if row.kind == "sample")
        with mp.workdps(40):
            downhill, level = gravity(case)
            lam, w = mpf(case.mu) * z / a, mpf(case.start[3])
            bend = (lam - 1) * a / (i1 - (lam - 1) * a * a) * level
            assert abs(first.theta / (bend * first.t**2 / 2) - 1) < 0.1
            out = -mp.expj(begin.phi)
            slip = velocity(case, begin) + 1j * a * begin.w3 * out
            assert abs(slip / out - abs(slip)) < TIGHT and abs(begin.u_h + abs(slip)) < TIGHT
            # the pull across the slip turns it, and with it the point over which the body topples
            turns = -out.imag * downhill / abs(slip)
            rate = (i3 / i1 * w * (lam - 1) + lam * turns) / (3 * lam - 2)
            assert abs((first.phi - begin.phi) / first.t - rate) < 0.002


# The library.


def rolled(case):
    """The motion at the times of the table."""
    ell, i1, i3, fillet = case.body
    theta, w1, w2, w3, *slip = case.start
    times, last = [float(row.t) for row in sampled(case)], case.rows[-1]
    if last.kind != "end":
        times.append(float(last.t) + (1 if last.kind == "rests" else 1e-3))
    viscous = case.law == "viscous"
    contact = sc.Viscous(case.mu) if viscous else sc.Coulomb(case.mu, static=case.mu, face=case.face)
    how = {"losses": sc.loss.AirLinear(case.losses["air"])} if case.losses else {}
    return sc.roll(
        sc.Body(ell, i1, i3, fillet=fillet),
        sc.State(theta, w1, w2, w3, slip=tuple(slip)),
        times,
        t0=0.0,
        contact=contact,
        restitution=0.0,
        table=sc.Table(case.slope, phi0=case.phi, place=tuple(case.place)),
        want=("pose", "force"),
        **how,
    )


@each_motion
def test_states_places_and_forces_are_those_of_the_reference(case):
    m, rows = rolled(case), sampled(case)
    n = len(rows)
    assert m.t[:n].tolist() == [float(row.t) for row in rows]
    most = max(1e-11, m.error, case.agreement)
    assert off(np.column_stack([m.theta, m.w, m.slip])[:n], rows, STATE).max() <= most
    poses = np.column_stack([m.phi, m.psi, m.contact_point])[:n]
    assert off(whole(poses, rows), rows, POSE).max() <= max(1e-11, m.pose_error)
    for i, row in enumerate(rows):
        if not mp.isnan(row.f_h):
            force = mp.mpc(row.f_h, row.f_2) * mp.expj(row.phi)
            known = [float(force.real), float(force.imag), float(mp.cos(mpf(case.slope)))]
            assert np.abs(m.contact_force[i] - known).max() <= max(1e-11, m.force_error)


@each_motion
def test_energy_and_what_is_lost_are_those_of_the_reference(case):
    m, rows = rolled(case), sampled(case)
    n, most = len(rows), max(1e-11, m.error)
    with mp.workdps(40):
        true = np.array([float(placed(case, row).energy) for row in rows])
    assert np.abs(m.energy[:n] - true).max() <= 10 * most * max(1, np.abs(true).max())
    assert np.abs(m.dissipated[:n] - [float(row.heat) for row in rows]).max() <= 10 * most
    if case.losses:
        assert np.abs(m.work_lost[:n] - [float(row.work) for row in rows]).max() <= most


@each_motion
def test_a_motion_rests_or_leaves_the_face_when_that_of_the_reference_does(case):
    m, last = rolled(case), case.rows[-1]
    most = max(1e-11, m.error)
    if last.kind == "rests":
        assert m.event.time == pytest.approx(float(last.t), abs=most * max(1, float(last.t)))
    left = [row for row in case.rows if row.kind in ("topples", "tips")]
    found = [phase for phase in m.phases if phase.kind != "on its face"]
    if case.rows[-1].kind != "rests" or left:
        assert [phase.kind for phase in found] == [
            "slipping" if row.kind == "topples" else "rolling" for row in left
        ]
        for phase, row in zip(found, left, strict=True):
            there = phase.state
            assert abs(phase.time - float(row.t)) <= most
            numbers = [there.theta, there.w1, there.w2, there.w3, *(there.slip or (0.0, 0.0))]
            assert off([numbers], [row], STATE).max() <= most
