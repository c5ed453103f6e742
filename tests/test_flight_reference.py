"""Flight and impact: the references of tests/reference/flights.py keep their laws, and the library agrees.

The first half does not use the library: the table, on which two formulations agree to 25 digits or more,
obeys the balance of energy, heat and what impacts lose; the centre flies on a parabola and the angular
momentum stays; an impact keeps the angular momentum about the contact and obeys friction and restitution.
The second half compares `sc.roll` with it.
"""

import json
import pathlib
import sys
import types
from itertools import pairwise

import numpy as np
import pytest
from mpmath import mp, mpf
from reference_rows import off, sampled, whole

import spincyl as sc

REFERENCE = pathlib.Path(__file__).with_name("reference")
sys.path.insert(0, str(REFERENCE))
from vectors import add, cross, dot, scaled  # noqa: E402

STATE = ("theta", "w1", "w2", "w3", "u_h", "u_2")
POSE = ("phi", "psi", "x", "y")
PHASES = {"rests": None, "slides": "slipping", "rolls": "rolling", "slips": "slipping", "passes": "slipping"}
PHASES["lift-off"] = "flying"
TIGHT = 1e-22


def table():
    """The motions, with rows and impacts of exact numbers."""
    with (REFERENCE / "flights.json").open() as file, mp.workdps(40):
        data = json.load(file)
        cases = []
        for case in data["motions"]:
            rows = [dict(zip(data["columns"], row, strict=True)) for row in case["rows"]]
            rows = [{k: v if k == "kind" else mpf(v) for k, v in row.items()} for row in rows]
            impacts = [dict(zip(data["told"], row, strict=False)) for row in case["impacts"]]
            impacts = [{k: v if k in ("kind", "rim") else mpf(v) for k, v in row.items()} for row in impacts]
            made = {
                name: [types.SimpleNamespace(**x) for x in part]
                for name, part in (("rows", rows), ("impacts", impacts))
            }
            cases.append(types.SimpleNamespace(**{**case, **made}))
        return cases


MOTIONS = table()
each_motion = pytest.mark.parametrize("case", MOTIONS, ids=[case.name for case in MOTIONS])


def start_of(case):
    """The first row, which the table leaves out."""
    height, lift = case.aloft or (0.0, 0.0)
    start = dict(zip(STATE, map(mpf, case.start), strict=True))
    rest = dict.fromkeys(("t", "heat", "lost", *POSE), mpf(0))
    return types.SimpleNamespace(**start, **rest, kind="start", height=mpf(height), u_n=mpf(lift))


class Placed:
    """A row in space: the centre, its velocity, the angular momentum about it, the arm to the contact."""

    def __init__(self, case, row):
        ell, i1, i3, fillet = map(mpf, case.body)
        self.moments = i1, i3
        s, c, rim = mp.sin(row.theta), mp.cos(row.theta), 1 - fillet
        h, e2, z = [mp.cos(row.phi), mp.sin(row.phi), 0], [-mp.sin(row.phi), mp.cos(row.phi), 0], [0, 0, 1]
        e1, e3 = add(scaled(c, h), scaled(s, z)), add(scaled(-s, h), scaled(c, z))
        self.axes = h, e2, z
        self.arm = add(scaled(-rim, e1), scaled(-ell, e3), scaled(-fillet, z))
        self.w = add(scaled(row.w1, e1), scaled(row.w2, e2), scaled(row.w3, e3))
        lowest = add(scaled(row.u_h, h), scaled(row.u_2, e2), scaled(row.u_n, z))
        self.velocity = add(lowest, scaled(-1, cross(self.w, self.arm)))
        self.centre = add([row.x, row.y, row.height], scaled(-1, self.arm))
        self.momentum = add(scaled(i1 * row.w1, e1), scaled(i1 * row.w2, e2), scaled(i3 * row.w3, e3))
        self.energy = self.centre[2] + (dot(self.velocity, self.velocity) + dot(self.w, self.momentum)) / 2


def in_the_air(case):
    """Pairs of rows with nothing but flight between them."""
    rows = [start_of(case), *case.rows]
    for one, other in pairwise(rows):
        lands = other.kind == "lands" or other.height > 0
        # nothing without a row between them
        if lands and not any(one.t < x.t < other.t for x in case.impacts) and one.t < other.t:
            yield one, other


def struck(case):
    """The impacts that have rows, with the rows before and after."""
    for one, other in pairwise(case.rows):
        if one.kind == "lands":
            (hit,) = (x for x in case.impacts if abs(x.t - one.t) < 1e-20)
            yield hit, one, other


# The table.


def test_the_motions_are_of_all_kinds_and_both_formulations_agree():
    kinds = {row.kind for case in MOTIONS for row in case.rows}
    assert kinds == {*PHASES, "sample", "end", "lands", "impact"} - {"passes", "slips"}
    assert {case.law for case in MOTIONS} == {"coulomb", "viscous", "rolling"}
    assert {case.restitution for case in MOTIONS} == {0, 0.3, 0.5, 0.8, 1}
    assert {x.kind for case in MOTIONS for x in case.impacts} == {"slips", "sticks", "slips on", "smooth"}
    assert {x.rim for case in MOTIONS for x in case.impacts} == {"first", "other"}
    assert len(MOTIONS) >= 12
    assert max(case.agreement for case in MOTIONS) < 1e-25


@each_motion
def test_energy_heat_and_what_impacts_lose_are_constant_together(case):
    with mp.workdps(40):
        totals = [Placed(case, x).energy + x.heat + x.lost for x in (start_of(case), *case.rows)]
        assert max(abs(total - totals[0]) for total in totals) < TIGHT * max(1, abs(totals[0]))
        lost = [x.lost for x in case.rows]
        assert all(b >= a for a, b in pairwise(lost))


@each_motion
def test_the_centre_flies_on_a_parabola_and_the_angular_momentum_stays(case):
    pairs = list(in_the_air(case))
    assert pairs
    with mp.workdps(40):
        for one, other in pairs:
            a, b, t = Placed(case, one), Placed(case, other), other.t - one.t
            fallen = add(a.centre, scaled(t, a.velocity), [0, 0, -t * t / 2])
            slower = add(a.velocity, [0, 0, -t])
            for found, true in ((b.centre, fallen), (b.velocity, slower), (b.momentum, a.momentum)):
                assert max(abs(x - y) for x, y in zip(found, true, strict=True)) < TIGHT
            assert abs(abs(other.w3) - abs(one.w3)) < TIGHT


@each_motion
def test_an_impact_keeps_the_angular_momentum_about_the_contact(case):
    found = list(struck(case))
    assert found
    with mp.workdps(40):
        for hit, before, after in found:
            a, b = Placed(case, before), Placed(case, after)
            h, e2, z = a.axes
            impulse = add(scaled(hit.along, h), scaled(hit.across, e2), scaled(hit.up, z))
            changed = add(b.velocity, scaled(-1, a.velocity))
            assert max(abs(x - y) for x, y in zip(impulse, changed, strict=True)) < TIGHT
            about = [add(x.momentum, scaled(-1, cross(x.arm, x.velocity))) for x in (a, b)]
            assert max(abs(x - y) for x, y in zip(*about, strict=True)) < TIGHT
            assert abs(a.energy - b.energy - hit.lost) < TIGHT
            assert before.height == after.height == 0


@each_motion
def test_an_impact_obeys_the_laws_of_friction_and_restitution(case):
    e = mpf(case.restitution)
    with mp.workdps(40):
        mu, static = mpf(case.mu), mpf(case.static or 0)
        for hit, before, after in struck(case):
            assert before.u_n < 0 < hit.up and hit.lost > -TIGHT
            assert after.u_n > 0 if e else after.u_n == 0
            if case.law == "rolling":
                assert after.u_h == after.u_2 == 0
                continue
            cone = mp.hypot(hit.along, hit.across) / hit.up
            if case.law == "coulomb":
                assert cone <= static * (1 + mpf(TIGHT))
                if hit.kind == "slips":
                    assert cone <= mu * (1 + mpf(TIGHT))
            if hit.kind == "sticks":
                assert after.u_h == after.u_2 == 0
            if hit.kind == "slips on":
                assert after.u_2 == 0 != after.u_h
            if hit.kind == "smooth":
                a = Placed(case, before)
                lever = dot(a.arm, a.axes[0])
                lightness = 1 + lever**2 / a.moments[0]
                assert abs(hit.lost - (1 - e * e) * before.u_n**2 / (2 * lightness)) < TIGHT
                assert abs(after.u_n + e * before.u_n) < TIGHT


def test_a_dropped_hoop_obeys_the_law_of_grip_and_slip():
    (case,) = (case for case in MOTIONS if case.name == "hoop dropped upright spinning")
    e, i3 = mpf(case.restitution), mpf(case.body[2])
    with mp.workdps(40):
        fall = mp.sqrt(2 * mpf(case.aloft[0]))
        slip, t = mpf(case.start[5]), fall
        for k, hit in enumerate(case.impacts[:20]):
            # to 1e-14, since pi/2 as a double is off by 6e-17
            assert abs(hit.t - t) < 1e-14
            stop = slip / (1 + 1 / i3)
            most = mpf(case.mu) * (1 + e) * fall
            change = min(most, stop)
            assert hit.kind == ("sticks" if stop <= most else "slips")
            slip -= (1 + 1 / i3) * change
            if k < 2:
                assert abs(hit.across + change) < 1e-14
            fall *= e
            t += 2 * fall


# The library.


def rolled(case, **options):
    """The motion at the times of the table."""
    ell, i1, i3, fillet = case.body
    theta, w1, w2, w3, *slip = case.start
    aloft = dict(zip(("height", "lift"), case.aloft, strict=True)) if case.aloft else {}
    start = sc.State(theta, w1, w2, w3, slip=tuple(slip), **aloft)
    contact = case.law
    if case.law == "coulomb":
        contact = sc.Coulomb(case.mu, static=case.static) if case.mu else "smooth"
    elif case.law == "viscous":
        contact = sc.Viscous(case.mu)
    times = [float(row.t) for row in sampled(case)]
    how = {"contact": contact, "restitution": case.restitution, "want": "pose", **options}
    return sc.roll(sc.Body(ell, i1, i3, fillet=fillet), start, times, t0=0.0, **how)


@each_motion
def test_states_and_poses_are_those_of_the_reference(case):
    m, rows = rolled(case), sampled(case)
    assert m.t.tolist() == [float(row.t) for row in rows]
    states = np.column_stack([m.theta, m.w, m.slip, m.lift, m.states.height])
    assert off(states, rows, (*STATE, "u_n", "height")).max() <= max(1e-11, m.error)
    poses = np.column_stack([m.phi, m.psi, m.contact_point])
    assert off(whole(poses, rows), rows, POSE).max() <= max(1e-11, m.pose_error)
    spent = (m.dissipated + m.lost_in_impacts) - [float(row.heat + row.lost) for row in rows]
    assert np.abs(spent).max() <= max(1e-11, m.error)


def due(case):
    """The larger of 1e-11 and the error that the library claims, of a motion."""
    m = rolled(case)
    return m, max(1e-11, m.error)


@each_motion
def test_impacts_are_those_of_the_reference(case):
    m, most = due(case)
    true = {float(x.t): x for x in case.impacts}
    times = np.array(list(true))
    met = set()
    for found in m.impacts:
        nearest = times[np.abs(times - found.time).argmin()]
        assert abs(nearest - found.time) <= most
        met.add(nearest)
        x = true[nearest]
        # a slip that turns round at 1e-16 has stopped as far as doubles know
        nearly = case.name == "cylinder whose slip nearly stops" and found.kind == "slips on"
        assert (found.rim, "slips" if nearly else found.kind) == (x.rim, x.kind)
        if hasattr(x, "lost"):
            told = [*found.impulse, found.lost]
            assert off([told], [x], ("along", "across", "up", "lost")).max() <= most
    # what is left out comes within a moment of an impact after which the body stays
    stays = [found.time for found in m.impacts if found.stays]
    for t in true.keys() - met:
        assert any(0 < t - other < 1e-5 for other in stays)


@each_motion
def test_impacts_begin_and_end_in_the_states_of_the_reference(case):
    m, most = due(case)
    for hit, before, after in struck(case):
        found = min(m.impacts, key=lambda x: abs(x.time - float(hit.t)))
        for state, row in ((found.before, before), (found.after, after)):
            told = [state.theta, state.w1, state.w2, state.w3, *state.slip, state.lift]
            assert off([told], [row], (*STATE, "u_n")).max() <= most
            assert state.height == 0


@each_motion
def test_phases_begin_where_those_of_the_reference_do(case):
    m, most = due(case)
    true = [row for row in case.rows if row.kind in PHASES]
    found = [phase for phase in m.phases if phase.time > 0 or phase.kind != "flying"]
    # in the table a flight has no row of its own after an impact
    hits = {x.time for x in m.impacts}
    found = [phase for phase in found if phase.kind != "flying" or phase.time not in hits]
    if case.aloft is None:
        assert found.pop(0).time == 0
    assert len(found) == len(true)
    stays = [x.time for x in m.impacts if x.stays]
    for phase, row in zip(found, true, strict=True):
        if row.kind == "rests":
            # infinitely many bounces are over within a moment of the last one that the library tells
            assert phase.time in stays and 0 < float(row.t) - phase.time < 1e-5
            assert phase.kind in ("rolling", "slipping")
            continue
        assert phase.kind == PHASES[row.kind]
        assert abs(phase.time - float(row.t)) <= most
        there = phase.state
        told = [there.theta, there.w1, there.w2, there.w3, *there.slip]
        assert off([told], [row], STATE).max() <= most


@each_motion
def test_heat_and_what_impacts_lose_are_told_apart(case):
    m, rows = rolled(case), sampled(case)
    # the friction of the last bounces of a sequence, which the library takes as one, is lost in impacts
    for found, name in ((m.dissipated, "heat"), (m.lost_in_impacts, "lost")):
        assert np.abs(found - [float(getattr(row, name)) for row in rows]).max() <= max(1e-11, 10 * m.error)


@pytest.mark.parametrize("tol", [1e-6, 1e-8, 1e-10])
@each_motion
def test_at_every_tolerance_the_estimated_error_covers_the_true_one(case, tol):
    m, rows = rolled(case, tol=tol), sampled(case)
    states = np.column_stack([m.theta, m.w, m.slip])
    assert off(states, rows, STATE).max() <= m.error
    poses = np.column_stack([m.phi, m.psi, m.contact_point])
    assert off(whole(poses, rows), rows, POSE).max() <= m.pose_error


def test_the_samples_know_what_flies():
    checked = 0
    for case in MOTIONS:
        m = rolled(case)
        flies = [row.height > 0 for row in sampled(case)]
        assert [code == 2 for code in m.phase] == flies
        checked += sum(flies)
    assert checked > 40
