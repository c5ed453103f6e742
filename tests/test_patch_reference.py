"""Friction of a round patch: the references of tests/reference/patches.py keep their laws, and the library agrees.

The first half does not use the library: the table, on which two formulations agree to 30 digits or more,
obeys the balance of energy and heat, the law of friction piece by piece, and the closed solutions of balls.
The second half compares `sc.roll` with it, and one motion of `sc.sweep.roll`.
"""

import json
import pathlib
import sys
import types

import numpy as np
import pytest
from mpmath import mp, mpf
from reference_rows import off, sampled

import spincyl as sc

REFERENCE = pathlib.Path(__file__).with_name("reference")
sys.path.insert(0, str(REFERENCE))
import newton_euler as ne  # noqa: E402

STATE = ("theta", "w1", "w2", "w3", "u_h", "u_2")
POSE = ("phi", "psi", "x", "y")
TIGHT = 1e-22


def table():
    """The motions, with rows of exact numbers."""
    with (REFERENCE / "patches.json").open() as file, mp.workdps(40):
        data = json.load(file)
        cases, level = [], {"turning": 0.0, "place": [0.0, 0.0]}
        for case in data["motions"]:
            rows = [dict(zip(data["columns"], row, strict=True)) for row in case["rows"]]
            rows = [{k: v if k == "kind" else mpf(v) for k, v in row.items()} for row in rows]
            cases.append(
                types.SimpleNamespace(**{**level, **case, "rows": [types.SimpleNamespace(**r) for r in rows]})
            )
        return cases


MOTIONS = table()
each_motion = pytest.mark.parametrize("case", MOTIONS, ids=[case.name for case in MOTIONS])


def of(name):
    """The motion of a name."""
    (case,) = (case for case in MOTIONS if case.name == name)
    return case


def start_of(case):
    """The first row, which the table leaves out."""
    start = dict(zip(STATE, map(mpf, case.start), strict=True))
    x, y = map(mpf, case.place)
    return types.SimpleNamespace(**start, kind="start", t=mpf(0), heat=mpf(0), phi=mpf(0), x=x, y=y)


def drilling(case, x):
    """Over the table."""
    return mp.sin(x.theta) * x.w1 + mp.cos(x.theta) * x.w3 - mpf(case.turning)


def creep(case, x):
    """The slip over the radius of the patch times the drilling."""
    return mp.hypot(x.u_h, x.u_2) / (mpf(case.patch) * abs(drilling(case, x)))


def driven(case, x):
    """What the energy has beside that over the table, less the rate of the table times the angular momentum."""
    ell, i1, i3, fillet = map(mpf, case.body)
    s, c, om = mp.sin(x.theta), mp.cos(x.theta), mpf(case.turning)
    lever = ell * s - (1 - fillet) * c
    out, across = x.x * mp.cos(x.phi) + x.y * mp.sin(x.phi), x.y * mp.cos(x.phi) - x.x * mp.sin(x.phi)
    v_h = x.u_h + (ell * c + (1 - fillet) * s + fillet) * x.w2
    v_2 = x.u_2 - (ell + fillet * c) * x.w1 + (1 - fillet + fillet * s) * x.w3
    u_h, u_2 = v_h - om * across, v_2 + om * out
    spins = i1 * x.w1 * s + i3 * x.w3 * c + (out - lever) * u_2 - across * u_h
    return (u_h**2 + u_2**2 - v_h**2 - v_2**2) / 2 - om * spins


# The table.


def test_the_motions_are_of_all_kinds_and_both_formulations_agree():
    kinds = {row.kind for case in MOTIONS for row in case.rows}
    assert kinds == {"sample", "end", "slides", "creeps", "turns"}
    assert {case.body[3] for case in MOTIONS} == {0, 0.05, 1}
    assert len(MOTIONS) >= 10
    assert max(case.agreement for case in MOTIONS) < 1e-30


@each_motion
def test_energy_and_heat_together_are_constant(case):
    with mp.workdps(40):
        body = [mpf(x) for x in case.body]
        totals = [ne.energy(body, x) + x.heat + driven(case, x) for x in (start_of(case), *case.rows)]
        assert max(abs(total - totals[0]) for total in totals) < TIGHT * max(1, abs(totals[0]))


@each_motion
def test_force_and_couple_are_integrals_over_chords_through_the_instantaneous_centre(case):
    with mp.workdps(30):
        for row in case.rows:
            if row.kind == "turns":
                continue
            k, turn = creep(case, row), drilling(case, row)
            widest = mp.asin(1 / k) if k > 1 else mp.pi / 2

            def chord(b, k=k):
                return 1 - (k * mp.sin(b)) ** 2

            # per |u| = 1, so that a ball that drills without slip is no exception
            f = mp.quad(lambda b: mp.cos(b) ** 2 * chord(b), [-widest, 0, widest]) * 3 / 4
            g = mp.quad(lambda b: chord(b) ** 2, [-widest, 0, widest]) * 3 / 16
            per_slip = -mpf(case.mu) * row.normal * f / (mpf(case.patch) * abs(turn))
            assert abs(row.along - per_slip * row.u_h) < TIGHT
            assert abs(row.across - per_slip * row.u_2) < TIGHT
            assert abs(row.couple + mpf(case.mu) * row.normal * mpf(case.patch) * g * mp.sign(turn)) < TIGHT


def rubbed(u, turn, patch):
    """Force and couple over mu N: the pieces of the patch, on lines through the instantaneous centre.

    Along a line the pressure is that of Chebyshev's second rule.
    """
    centre = np.array([-u[1], u[0]]) / (patch * turn)
    far = np.hypot(*centre)
    if far < 1:
        angles, parts = np.arange(16) * np.pi / 16, np.full(16, np.pi / 16)
    else:
        x, parts = np.polynomial.legendre.leggauss(40)
        widest = np.arcsin(1 / far)
        angles, parts = np.arctan2(centre[1], centre[0]) + widest * x, widest * parts
    places = np.arange(1, 8) * np.pi / 8
    force, couple = np.zeros(2), 0.0
    for angle, part in zip(angles, parts, strict=True):
        along = np.array([np.cos(angle), np.sin(angle)])
        middle = -centre @ along
        half = np.sqrt(max(0.0, 1 - (centre[0] * along[1] - centre[1] * along[0]) ** 2))
        for place in places:
            reach = middle + half * np.cos(place)
            at = centre + reach * along
            pressed = part * np.pi / 8 * np.sin(place) ** 2 * half**2 * 1.5 / np.pi * abs(reach)
            slip = u + turn * patch * np.array([-at[1], at[0]])
            pull = -pressed * slip / max(np.hypot(*slip), 1e-300)
            force += pull
            couple += patch * (at[0] * pull[1] - at[1] * pull[0])
    return force, couple


@each_motion
def test_every_piece_of_the_patch_rubs_against_its_own_slip(case):
    for row in case.rows:
        press = case.mu * float(row.normal)
        u, turn = np.array([float(row.u_h), float(row.u_2)]), float(drilling(case, row))
        force, couple = (-u / np.hypot(*u), 0.0) if row.kind == "turns" else rubbed(u, turn, case.patch)
        assert np.abs(press * force - [float(row.along), float(row.across)]).max() < 1e-12
        assert abs(press * couple - float(row.couple)) < 1e-12


@each_motion
def test_the_body_slips_or_drills_all_the_time(case):
    with mp.workdps(40):
        for row in (start_of(case), *case.rows):
            assert mp.hypot(row.u_h, row.u_2) + mpf(case.patch) * abs(drilling(case, row)) > 1e-3
            if row.kind == "turns":
                assert abs(drilling(case, row)) < TIGHT and abs(row.couple) < TIGHT
            if row.kind in ("slides", "creeps"):
                assert abs(creep(case, row) - 1) < TIGHT
            if row.kind != "start":
                assert row.normal > 0


def test_a_drilling_ball_slows_down_evenly():
    case = of("ball drills")
    with mp.workdps(40):
        for row in case.rows:
            # the start is a double, and so its axis is not quite upright
            slower = 3 * mp.pi / 16 * mpf(case.mu) * mpf(case.patch) * row.t / mpf(case.body[1])
            assert abs(drilling(case, row) - (drilling(case, start_of(case)) - slower)) < 1e-15
            assert mp.hypot(row.u_h, row.u_2) < 1e-14


def test_the_slip_of_a_homogeneous_ball_keeps_its_direction_and_takes_two_sevenths_of_its_speed():
    case = of("billiard ball with side spin")
    with mp.workdps(40):
        seen = []
        for x in (start_of(case), *case.rows):
            velocity = x.u_h + x.w2, x.u_2 - mp.cos(x.theta) * x.w1 + mp.sin(x.theta) * x.w3
            turned = mp.expj(x.phi)
            slip = mp.mpc(x.u_h, x.u_2) * turned
            seen.append((slip, mp.mpc(*velocity) * turned - 2 * slip / 7))
        for slip, rest in seen:
            assert abs(rest - seen[0][1]) < 1e-16  # I = 2/5 is a double
            assert abs((slip / seen[0][0]).imag) < TIGHT
    assert abs(seen[-1][0]) < 1e-6 < abs(drilling(case, case.rows[-1]))


# The library.


def rolled(case):
    """The motion at the times of the table."""
    ell, i1, i3, fillet = case.body
    theta, w1, w2, w3, *slip = case.start
    times = [float(row.t) for row in sampled(case)]
    return sc.roll(
        sc.Body(ell, i1, i3, fillet=fillet),
        sc.State(theta, w1, w2, w3, slip=tuple(slip)),
        times,
        t0=0.0,
        contact=sc.Coulomb(case.mu, patch=case.patch),
        table=sc.Table(turning=case.turning, place=tuple(case.place)),
        tol=1e-12,
        want=("pose", "force"),
    )


@each_motion
def test_states_and_slips_are_those_of_the_reference(case):
    m, rows = rolled(case), sampled(case)
    assert m.t.tolist() == [float(row.t) for row in rows]
    assert off(np.column_stack([m.theta, m.w, m.slip]), rows, STATE).max() <= max(1e-11, m.error)


@each_motion
def test_heat_of_force_and_couple_is_that_of_the_reference(case):
    m = rolled(case)
    assert off(m.dissipated[:, None], sampled(case), ["heat"]).max() <= max(1e-11, m.error)


@each_motion
def test_poses_are_those_of_the_reference(case):
    m = rolled(case)
    poses = np.column_stack([m.phi, m.psi, m.contact_point])
    assert off(poses, sampled(case), POSE).max() <= max(1e-11, m.pose_error)


@each_motion
def test_normal_force_and_couple_are_those_of_the_reference(case):
    m, rows = rolled(case), sampled(case)
    found = np.column_stack([m.normal, m.couple])
    assert off(found, rows, ("normal", "couple")).max() <= max(1e-11, m.force_error)


@each_motion
def test_the_force_in_space_is_that_of_the_reference(case):
    m, rows = rolled(case), sampled(case)
    pushes = [complex(mp.mpc(x.along, x.across) * mp.expj(x.phi)) for x in rows]
    apart = m.contact_force[:, :2] - [(push.real, push.imag) for push in pushes]
    assert np.abs(apart).max() <= max(1e-11, m.force_error + m.pose_error)


@each_motion
def test_drilling_and_creep_are_those_of_the_reference(case):
    m, rows = rolled(case), sampled(case)
    most = max(1e-11, m.error)
    true = [float(drilling(case, row)) for row in rows]
    assert np.abs(m.drilling - true).max() <= 2 * most
    slip = m.creep * case.patch * np.abs(m.drilling)
    assert np.abs(slip - [float(mp.hypot(row.u_h, row.u_2)) for row in rows]).max() <= 2 * most


@each_motion
def test_a_motion_on_a_patch_is_one_phase_of_slip(case):
    m = rolled(case)
    assert m.status == sc.Ending.DONE
    assert [(phase.time, phase.kind) for phase in m.phases] == [(0, "slipping")]


def test_one_of_many_motions_is_that_of_the_reference():
    case = of("can whose drilling turns round")
    rows = sampled(case)
    ell, i1, i3, fillet = case.body
    theta, w1, w2, w3, *slip = case.start
    # beside others, with patches of their own
    found = sc.sweep.roll(
        sc.Body(ell, i1, i3, fillet=fillet),
        sc.State(theta, w1, w2, w3, slip=tuple(slip)),
        [float(row.t) for row in rows],
        contact=sc.Coulomb(case.mu, patch=np.array([0.01, case.patch, 0.2])),
        tol=1e-12,
        want=("states", "dissipated"),
    )
    names = ("theta", "w1", "w2", "w3", "slip_along", "slip_across")
    states = np.column_stack([found[name][1] for name in names])
    most = max(1e-11, float(found.error[1]))
    assert off(states, rows, STATE).max() <= most
    assert abs(float(found.dissipated[1]) - float(rows[-1].heat)) <= most
