"""Tilted and turning tables: the references of tests/reference/slope.py keep their laws, and the library agrees.

The first half does not use the library: the table, on which two formulations agree to 26 digits or more, obeys
the balance of energy with gravity along the slope, the closed solutions of balls and of what lies, and the
numbers of a third model in doubles. The second half compares `sc.roll` with it.
"""

import json
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
from reference_rows import named, off, sampled, whole
from test_lying_reference import phases_of, posed
from test_stone_reference import contact as stone_contact
from test_stone_reference import off as stone_off
from test_stone_reference import rows as stone_rows
from test_stone_reference import stone

import spincyl as sc

# a stone whose masses may be outside the ellipsoid
pytestmark = pytest.mark.filterwarnings("ignore:inertia")
REFERENCE = pathlib.Path(__file__).with_name("reference")
sys.path.insert(0, str(REFERENCE))
from vectors import add, cross, dot, scaled  # noqa: E402

STATE = ("theta", "w1", "w2", "w3", "u_h", "u_2")
POSE = ("phi", "psi", "x", "y")
TIGHT = mpf("1e-22")
LOSSES = {"rolling": sc.loss.RollingResistance, "viscous": sc.loss.ViscousContour}
#: the phases of the library that begin at a row
RIM = {"slides": "slipping", "rolls": "rolling", "slips": "slipping", "passes": "slipping"}
RIM |= {"lift-off": "flying"}


def table():
    """The motions, with rows of exact numbers; those of stones stay as they are."""
    data = json.loads((REFERENCE / "slope.json").read_text("utf-8"))
    cases = []
    for case in data["motions"]:
        if case["kind"] != "stone":
            with mp.workdps(40):
                rows = [dict(zip(data["columns"][case["kind"]], row, strict=True)) for row in case["rows"]]
                rows = [
                    {k: v if k == "kind" else mpf("nan" if v is None else v) for k, v in row.items()}
                    for row in rows
                ]
            case |= {"rows": [types.SimpleNamespace(**row) for row in rows]}
        cases.append(types.SimpleNamespace(**case))
    return cases


MOTIONS = table()


def of_kind(*kinds, known=lambda case: True):
    found = [case for case in MOTIONS if case.kind in kinds and known(case)]
    return pytest.mark.parametrize("case", found, ids=[case.name for case in found])


def in_library(case):
    """A body whose other rim is not there is not one of the library."""
    return not getattr(case, "beyond", False)


each_body, each_lying, each_stone = of_kind("rim", "lying"), of_kind("lying"), of_kind("stone")
each_motion = of_kind("rim", "lying", known=in_library)


def of(name):
    return named(MOTIONS, name)


def start_of(case):
    """The first row, which the table leaves out."""
    start = dict(zip(STATE, map(mpf, case.start), strict=True))
    if case.kind == "lying" and case.start[0] == math.pi / 2:
        start["theta"] = mp.pi / 2
    height, lift = getattr(case, "aloft", None) or (0, 0)
    pose = dict(zip(POSE, map(mpf, (case.phi, 0, *case.place)), strict=True))
    rest = {name: mpf(0) for name in ("t", "heat", "lost", "work")}
    return types.SimpleNamespace(**start, **pose, **rest, height=mpf(height), u_n=mpf(lift))


class Placed:
    """A row in space: the centre, its velocity and the energy."""

    def __init__(self, case, row):
        ell, i1, i3, fillet = map(mpf, case.body)
        s, c, rim, om = mp.sin(row.theta), mp.cos(row.theta), 1 - fillet, mpf(case.turning)
        h, e2, z = [mp.cos(row.phi), mp.sin(row.phi), 0], [-mp.sin(row.phi), mp.cos(row.phi), 0], [0, 0, 1]
        e1, e3 = add(scaled(c, h), scaled(s, z)), add(scaled(-s, h), scaled(c, z))
        self.axes, self.gravity = (h, e2, z), [mp.sin(mpf(case.slope)), 0, -mp.cos(mpf(case.slope))]
        self.arm = add(scaled(-rim, e1), scaled(-ell, e3), scaled(-fillet, z))
        w = add(scaled(row.w1, e1), scaled(row.w2, e2), scaled(row.w3, e3))
        lowest = [row.x, row.y, getattr(row, "height", 0)]
        slip = add(scaled(row.u_h, h), scaled(row.u_2, e2), scaled(getattr(row, "u_n", 0), z))
        self.velocity = add(slip, cross([0, 0, om], lowest), scaled(-1, cross(w, self.arm)))
        self.centre = add(lowest, scaled(-1, self.arm))
        self.momentum = add(scaled(i1 * row.w1, e1), scaled(i1 * row.w2, e2), scaled(i3 * row.w3, e3))
        self.moving = (dot(self.velocity, self.velocity) + dot(w, self.momentum)) / 2
        self.energy = self.moving - dot(self.gravity, self.centre)
        self.vertical = dot(z, self.momentum) + dot(z, cross(self.centre, self.velocity))
        self.w_z = dot(w, z)


# The table.


def test_the_motions_are_of_all_kinds_and_both_formulations_agree():
    assert len(MOTIONS) >= 20
    kinds = {row.kind for case in MOTIONS if case.kind != "stone" for row in case.rows}
    assert kinds >= {"rolls", "slips", "lift-off", "lands", "impact", "pivots", "straight", "end"}
    assert {case.law for case in MOTIONS} == {"coulomb", "viscous", "rolling"}
    assert max(case.agreement for case in MOTIONS) < 1e-26


@each_body
def test_energy_with_gravity_along_the_slope_is_kept(case):
    with mp.workdps(40):
        totals = []
        for x in (start_of(case), *case.rows):
            placed, om = Placed(case, x), mpf(case.turning)
            lost = getattr(x, "lost", getattr(x, "work", 0))
            totals.append(placed.energy - om * placed.vertical + x.heat + lost)
        if case.turning and case.slope:
            return  # its rate is not that of a single number of the table
        assert max(abs(total - totals[0]) for total in totals) < TIGHT * max(1, abs(totals[0]))
        assert all(b.heat >= a.heat - TIGHT for a, b in pairwise(case.rows))


def test_the_numbers_of_a_third_model_in_doubles_are_met():
    def met(row, **known):
        assert {name: round(float(getattr(row, name)), 9) for name in known} == {
            name: round(x, 9) for name, x in known.items()
        }

    _, rows = of("disk rolls")
    met(rows["end"], theta=1.2054716031, w1=0.5931890343, w2=-0.2909816491, w3=1.7795284100)
    met(rows["end"], phi=-1.5133265363)
    _, rows = of("ball thrown across")
    met(rows["rolls"], t=1.3671567666)
    _, rows = of("disk past its side on a turntable")
    met(rows["end"], theta=1.6960250772, phi=-0.5186454092, x=2.8278893543, y=-1.8785024486)
    _, rows = of("tube hops")
    met(rows["lift-off"], t=2.1023832726)
    met(rows["lands"], t=4.3449936699)
    _, rows = of("both rims stop at once")
    met(rows["straight"], t=7.7799437502, w3=1.5875262072, phi=-0.5545180920)
    _, rows = of("cylinder pivots")
    met(rows["pivots"], t=2.5423189882, w1=0.0572288376)
    met(rows["straight"], t=2.9371625598, phi=1.2193597459, w3=-0.9756217739)


def test_a_homogeneous_ball_slips_as_a_block_and_rolls_with_five_sevenths():
    case, rows = of("ball thrown across")
    with mp.workdps(40):
        slope, i, mu = mpf(case.slope), mpf(case.body[1]), mpf(case.mu)
        sigma, share = mp.sin(slope), i / (1 + i)
        friction = mu * (1 + 1 / i) / mp.tan(slope)

        def block(row):
            chi = mp.atan2(row.u_2, row.u_h) + row.phi
            return mp.hypot(row.u_h, row.u_2) * mp.sin(chi) * mp.tan(chi / 2) ** -friction

        for row in case.rows:
            if row.t < rows["rolls"].t:
                assert abs(block(row) / block(start_of(case)) - 1) < TIGHT
        there = Placed(case, rows["rolls"])
        met = rows["rolls"].t * sigma * (1 - share), 1 - share
        assert max(abs(x - y) for x, y in zip(there.velocity[:2], met, strict=True)) < TIGHT
        assert abs(share - mpf(2) / 7) < 1e-15
        for row in case.rows:
            if row.t >= rows["rolls"].t:
                gone = (row.t - rows["rolls"].t) * sigma * (1 - share)
                placed = Placed(case, row)
                assert abs(placed.velocity[0] - there.velocity[0] - gone) < TIGHT
                assert abs(placed.velocity[1] - there.velocity[1]) < TIGHT
                assert abs(placed.w_z - there.w_z) < TIGHT


def test_jelletts_number_of_a_ball_with_a_low_centre_stays_on_a_slope():
    case, _ = of("ball with a low centre")
    ell, i1, i3, rho = map(mpf, case.body)
    with mp.workdps(40):
        numbers = [
            i1 * rho * x.w1 * mp.sin(x.theta) + i3 * x.w3 * (ell + rho * mp.cos(x.theta))
            for x in (start_of(case), *case.rows)
        ]
        assert max(abs(x - numbers[0]) for x in numbers) < TIGHT


def test_on_a_smooth_slope_the_centre_falls_downhill_and_w3_stays():
    case, _ = of("top on a smooth table")
    with mp.workdps(40):
        begun, sigma = Placed(case, start_of(case)), mp.sin(mpf(case.slope))
        for row in case.rows:
            placed = Placed(case, row)
            assert abs(placed.velocity[0] - begun.velocity[0] - sigma * row.t) < TIGHT
            assert abs(placed.velocity[1] - begun.velocity[1]) < TIGHT
            gone = begun.velocity[0] * row.t + sigma * row.t**2 / 2
            assert abs(placed.centre[0] - begun.centre[0] - gone) < TIGHT
            assert abs(row.w3 - mpf(case.start[3])) < TIGHT


def test_a_ball_on_a_turntable_turns_at_two_sevenths_and_drifts_across_the_slope():
    case, _ = of("ball on a tilted turntable")
    with mp.workdps(40):
        i, om, sigma = mpf(case.body[1]), mpf(case.turning), mp.sin(mpf(case.slope))
        rate, drift = i / (1 + i) * om, sigma / (i * om)
        begun = Placed(case, start_of(case)).velocity
        turned = mp.mpc(begun[0], begun[1] - drift)
        for row in case.rows:
            there = Placed(case, row).velocity
            assert abs(turned * mp.expj(rate * row.t) + 1j * drift - mp.mpc(there[0], there[1])) < TIGHT


@each_lying
def test_what_rolls_straight_is_held_along_its_axis_and_accelerates_uniformly(case):
    with mp.workdps(40):
        ell, _, i3, _ = map(mpf, case.body)
        sigma, gamma = mp.sin(mpf(case.slope)), mp.cos(mpf(case.slope))
        begun = next(row for row in case.rows if row.kind in ("straight", "rocked"))
        pull_h, pull_2 = sigma * mp.cos(begun.phi), -sigma * mp.sin(begun.phi)
        push = i3 * pull_2 / (1 + i3) / 2
        left = [
            mp.sqrt((mpf(case.static) * (gamma + way * pull_h / ell) / 2) ** 2 - push**2) for way in (1, -1)
        ]
        assert sum(left) > abs(pull_h)
        for row in case.rows:
            if row.t >= begun.t:
                assert abs(row.w3 - begun.w3 - pull_2 / (1 + i3) * (row.t - begun.t)) < TIGHT
                assert abs(row.w1) < TIGHT and abs(row.phi - begun.phi) < TIGHT


# The library.


def law_of(case):
    if case.law == "viscous":
        return sc.Viscous(case.mu)
    if case.law == "rolling":
        return "rolling"
    return sc.Coulomb(case.mu, static=case.static)


def rolled(case):
    """The motion at the times of the table."""
    theta, w1, w2, w3, *slip = case.start
    aloft = dict(zip(("height", "lift"), getattr(case, "aloft", None) or (), strict=False))
    ell, i1, i3, fillet = case.body
    start = sc.State(theta, w1, w2, w3, slip=tuple(slip), **aloft)
    table = sc.Table(case.slope, turning=case.turning, phi0=case.phi, place=tuple(case.place))
    how = {"contact": law_of(case), "table": table}
    if case.losses:
        how["losses"] = reduce(operator.add, (LOSSES[name](x) for name, x in case.losses.items()))
    if case.kind == "lying" or flies(case):
        how["restitution"] = getattr(case, "restitution", 0.0)
    times = [float(row.t) for row in sampled(case)]
    return sc.roll(sc.Body(ell, i1, i3, fillet=fillet), start, times, t0=0.0, want=("pose",), **how)


def flies(case):
    return case.kind == "rim" and any(row.kind in ("lift-off", "lands") for row in case.rows)


def told(case, m):
    """The states and the poses; what only rolls tells no slip."""
    if case.law != "rolling":
        return posed(case, m)
    nothing = np.zeros_like(m.theta)
    return np.column_stack([m.theta, m.w, nothing, nothing]), np.column_stack([m.phi, m.psi, m.contact_point])


@each_motion
def test_states_and_poses_are_those_of_the_reference(case):
    m, rows = rolled(case), sampled(case)
    assert m.t.tolist() == [float(row.t) for row in rows]
    most = max(1e-11, m.error)
    states, poses = told(case, m)
    assert off(states, rows, STATE).max() <= most
    assert off(whole(poses, rows), rows, POSE).max() <= max(1e-11, m.pose_error)
    if flies(case):
        assert off(np.column_stack([m.lift, m.states.height]), rows, ("u_n", "height")).max() <= most


@each_motion
def test_energy_and_what_is_lost_are_those_of_the_reference(case):
    m, rows = rolled(case), sampled(case)
    most = max(1e-11, m.error)
    if not case.turning:
        with mp.workdps(40):
            true = np.array([float(Placed(case, row).energy) for row in rows])
        assert np.abs(m.energy - true).max() <= 10 * most * max(1, np.abs(true).max())
    lost = sum((getattr(m, name) for name in spent(case)), np.zeros_like(m.theta))
    true = [float(row.heat + getattr(row, "lost", getattr(row, "work", 0))) for row in rows]
    assert np.abs(lost - true).max() <= most


def spent(case):
    """The names of what has become heat or been lost."""
    if case.law != "rolling":
        yield "dissipated"
    if case.losses:
        yield "work_lost"
    if case.kind == "lying" or flies(case):
        yield "lost_in_impacts"


@of_kind("rim", "lying", known=lambda case: case.law != "rolling")
def test_phases_begin_where_those_of_the_reference_do(case):
    m = rolled(case)
    most, found = max(1e-11, m.error), [phase for phase in m.phases if phase.time > 0]
    if case.kind == "lying":
        true = phases_of(case)
        if any(row.kind == "rocked" for row in case.rows):  # only its first landings have rows
            near = [[abs(phase.time - float(row.t)) for phase in found] for row, _ in true]
            found = [found[int(np.argmin(distances))] for distances in near]
    else:
        true = [(row, RIM[row.kind]) for row in case.rows if row.kind in RIM and row.t <= m.t[-1]]
        # in the table a flight has no row of its own after an impact
        hits = {x.time for x in m.impacts} if flies(case) else set()
        found = [phase for phase in found if phase.kind != "flying" or phase.time not in hits]
    assert [phase.kind for phase in found] == [kind for _, kind in true]
    for phase, (row, _) in zip(found, true, strict=True):
        assert abs(phase.time - float(row.t)) <= most
        if row.kind != "rocked":
            there = phase.state
            numbers = [there.theta, there.w1, there.w2, there.w3, *there.slip]
            assert off([numbers], [row], STATE).max() <= most


@of_kind("rim", known=flies)
def test_impacts_are_those_of_the_reference(case):
    m = rolled(case)
    most = max(1e-11, m.error)
    times = np.array([float(t) for t, *_ in case.impacts])
    met = set()
    for found in m.impacts:
        k = int(np.abs(times - found.time).argmin())
        assert abs(times[k] - found.time) <= most
        assert [found.rim, found.kind] == case.impacts[k][1:]
        met.add(k)
    # what is left out comes within a moment of an impact after which the body stays
    stays = [found.time for found in m.impacts if found.stays]
    for k, t in enumerate(times):
        assert k in met or any(0 < t - other < 1e-5 for other in stays)


@each_stone
def test_a_stone_is_that_of_the_other_model_within_its_claims(case):
    given = {**vars(case), "theta_end": None, "g": 1.0}
    del given["losses"]
    told = stone_rows(given)
    rows = [row for row in told if row["kind"] in ("sample", "end")]
    slip = None if case.law == "rolling" else case.u
    start = sc.EllipsoidState(np.array(case.n) / np.linalg.norm(case.n), case.w, slip)
    how = {"contact": stone_contact(given), "want": ("pose", "force"), "table": sc.Table(slope=case.slope)}

    def at(times):
        return sc.roll(stone(given), start, times, t0=0.0, **how)

    m, centre = at([row["t"] for row in rows]), at([0.0]).centre[0, :2]
    assert len(m.t) == len(rows)
    for i, row in enumerate(rows):
        state, slip, pose, force = stone_off(m, i, row, centre)
        assert max(state, slip) <= max(1e-11, m.error) and pose <= max(1e-11, m.pose_error)
        assert force <= max(1e-11, m.force_error)
    if case.law == "rolling":
        return
    changes = [(row["kind"], row["t"]) for row in told if row["kind"] in ("slips", "rolls")]
    ours = [
        (f"{phase.kind[:-3] if phase.kind == 'rolling' else 'slip'}s", phase.time) for phase in m.phases[1:]
    ]
    assert [kind for kind, _ in ours] == [kind for kind, _ in changes]
    for (_, a), (_, b) in zip(ours, changes, strict=True):
        assert abs(a - b) <= max(m.error, 1e-11)
