"""Stones that drop and bounce: the references of tests/reference/stone_hops.py keep their laws, and the library agrees.

The first half does not use the library: the table, on which two formulations agree to 25 digits or more, obeys the
balance of energy, heat and what impacts lose; the centre flies on a parabola, the angular momentum stays in the air,
and what the body sees of it follows Jacobi's functions; an impact keeps the angular momentum about the contact and
obeys friction and restitution. The second half compares `sc.roll` with it.
"""

import json
import pathlib
import sys
import types
from itertools import pairwise

import numpy as np
import pytest
from mpmath import mp, mpf
from reference_rows import off, sampled

import spincyl as sc

REFERENCE = pathlib.Path(__file__).with_name("reference")
sys.path.insert(0, str(REFERENCE))
from vectors import add, cross, dot, scaled  # noqa: E402

# some of these stones have masses outside the ellipsoid
pytestmark = pytest.mark.filterwarnings("ignore:inertia")
VERTICAL, W, U, Q, PLACE = (
    ("n1", "n2", "n3"),
    ("w1", "w2", "w3"),
    ("ux", "uy", "uz"),
    ("q0", "q1", "q2", "q3"),
    ("x", "y"),
)
IMPULSE = ("px", "py", "pz")
PHASES = {"rests": None, "slides": "slipping", "rolls": "rolling", "slips": "slipping", "passes": "slipping"}
PHASES["lift-off"] = "flying"
TIGHT = 1e-22


def table():
    """The motions, with rows and impacts of exact numbers."""
    with (REFERENCE / "stone_hops.json").open() as file, mp.workdps(40):
        data = json.load(file)
        cases = []
        for case in data["motions"]:
            rows = [dict(zip(data["columns"], row, strict=True)) for row in case["rows"]]
            impacts = [dict(zip(data["told"], row, strict=False)) for row in case["impacts"]]
            made = {
                name: [
                    types.SimpleNamespace(**{k: v if k == "kind" else mpf(v) for k, v in x.items()})
                    for x in part
                ]
                for name, part in (("rows", rows), ("impacts", impacts))
            }
            cases.append(types.SimpleNamespace(**{**case, **made}))
        return cases


MOTIONS = table()
each_motion = pytest.mark.parametrize("case", MOTIONS, ids=[case.name for case in MOTIONS])


def of(name):
    """The motion of a name."""
    (case,) = (case for case in MOTIONS if case.name == name)
    return case


def numbers(row, names):
    return [getattr(row, name) for name in names]


def along(matrix, v):
    return [dot(row, v) for row in matrix]


def back(matrix, v):
    return along(list(zip(*matrix, strict=True)), v)


def rotation(q):
    """From the axes of the body to the laboratory; the quaternion has its scalar first."""
    w, x, y, z = q
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]


def smallest_turn(n):
    """The quaternion of the rotation by the smallest angle from upright to this vertical."""
    q = [1 + n[2], n[1], -n[0], 0 * n[0]] if n[2] > -1 else [0, 1, 0, 0]
    size = mp.sqrt(sum(x * x for x in q))
    return [x / size for x in q]


def lowest(case, n):
    """From the centre of mass to the lowest point, along the axes of the body."""
    dn = [mpf(a) ** 2 * x for a, x in zip(case.axes, n, strict=True)]
    size = mp.sqrt(dot(n, dn))
    return [-x / size - mpf(d) for x, d in zip(dn, case.offset, strict=True)]


@mp.workdps(40)
def start_of(case):
    """The first row, which the table leaves out: the centre of mass is above the origin."""
    height, lift = case.aloft or (0.0, 0.0)
    n, w = [mpf(x) for x in case.n], [mpf(x) for x in case.w]
    n = scaled(1 / mp.sqrt(dot(n, n)), n)
    q = smallest_turn(n)
    place = along(rotation(q), lowest(case, n))[:2]
    named = zip((*VERTICAL, *W, *U, *Q, *PLACE), (*n, *w, *case.u, lift, *q, *place), strict=True)
    rest = dict.fromkeys(("t", "heat", "lost"), mpf(0))
    return types.SimpleNamespace(**{k: mpf(v) for k, v in named}, **rest, kind="start", height=mpf(height))


class Placed:
    """A row in space: the centre, its velocity, the angular momentum about it, the arm to the lowest point."""

    def __init__(self, case, row):
        inertia = [[mpf(x) for x in line] for line in case.inertia]
        n, w, matrix = numbers(row, VERTICAL), numbers(row, W), rotation(numbers(row, Q))
        self.n, self.matrix = n, matrix
        self.arm = along(matrix, lowest(case, n))
        self.own = along(inertia, w)  # along the axes of the body
        self.momentum = along(matrix, self.own)
        self.velocity = add(numbers(row, U), scaled(-1, cross(along(matrix, w), self.arm)))
        self.centre = add([row.x, row.y, row.height], scaled(-1, self.arm))
        self.turning = dot(w, self.own)
        self.energy = self.centre[2] + (dot(self.velocity, self.velocity) + self.turning) / 2


def answers(case, row):
    """What a unit impulse along each axis of the laboratory gives the lowest point: A, b and a_n, of doubles."""
    placed = Placed(case, row)
    arm = np.array(placed.arm, float)
    frame = np.array(placed.matrix, float)
    free = frame @ np.linalg.inv(np.array(case.inertia, float)) @ frame.T
    turns = np.cross(arm, np.eye(3))
    whole = np.eye(3) + turns @ free @ turns.T
    return whole[:2, :2], whole[:2, 2], whole[2, 2]


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
    assert kinds == {*PHASES, "sample", "end", "lands", "impact"} - {"passes"}
    assert {case.law for case in MOTIONS} == {"coulomb", "viscous", "rolling", "smooth"}
    assert {case.restitution for case in MOTIONS} >= {0, 0.3, 0.6, 1}
    assert {x.kind for case in MOTIONS for x in case.impacts} == {"slips", "sticks", "slips on", "smooth"}
    assert len(MOTIONS) >= 12
    assert max(case.agreement for case in MOTIONS) < 1e-25
    assert max(case.strayed for case in MOTIONS) < 1e-25


@each_motion
def test_the_vertical_is_that_of_the_orientation(case):
    with mp.workdps(40):
        for row in case.rows:
            q = numbers(row, Q)
            assert abs(sum(x * x for x in q) - 1) < TIGHT
            apart = add(rotation(q)[2], scaled(-1, numbers(row, VERTICAL)))
            assert max(abs(x) for x in apart) < TIGHT


@each_motion
def test_energy_heat_and_what_impacts_lose_are_constant_together(case):
    with mp.workdps(40):
        totals = [Placed(case, x).energy + x.heat + x.lost for x in (start_of(case), *case.rows)]
        assert max(abs(total - totals[0]) for total in totals) < TIGHT * max(1, abs(totals[0]))
        for name in ("lost", "heat"):
            spent = [getattr(x, name) for x in case.rows]
            assert all(b >= a - mpf(TIGHT) for a, b in pairwise(spent))


@each_motion
def test_the_centre_flies_on_a_parabola_and_the_angular_momentum_stays(case):
    pairs = list(in_the_air(case))
    assert pairs or case.aloft is None
    with mp.workdps(40):
        for one, other in pairs:
            a, b, t = Placed(case, one), Placed(case, other), other.t - one.t
            fallen = add(a.centre, scaled(t, a.velocity), [0, 0, -t * t / 2])
            slower = add(a.velocity, [0, 0, -t])
            for found, true in ((b.centre, fallen), (b.velocity, slower), (b.momentum, a.momentum)):
                assert max(abs(x - y) for x, y in zip(found, true, strict=True)) < TIGHT
            assert abs(b.turning - a.turning) < TIGHT


def jacobi(inertia, own, t):
    """The angular momentum along the axes of a free body, a time later: Jacobi's functions along the principal axes.

    Axis 3 is the one about which it circles, 2 the middle one; an independent closed form of Euler's equations.
    """
    moments, axes = mp.eigsy(mp.matrix(inertia))
    m = axes.T * mp.matrix(own)
    square, twice = sum(x * x for x in m), sum(x * x / i for x, i in zip(m, moments, strict=True))
    order = [0, 1, 2] if square > twice * moments[1] else [2, 1, 0]
    sign = mp.det(axes) * (1 if order == [0, 1, 2] else -1)
    v1, v2, v3 = (1 / moments[i] for i in order)
    m1, m2, m3 = (m[i] for i in order)
    a = mp.sqrt(m1**2 + m2**2 * (v2 - v3) / (v1 - v3))
    c = mp.sign(m3) * mp.sqrt(m3**2 + m2**2 * (v1 - v2) / (v1 - v3))
    rate = abs(c) * mp.sqrt((v2 - v3) * (v1 - v3))
    b = sign * a * c * (v1 - v3) / rate
    k = (a / c) ** 2 * (v1 - v2) / (v2 - v3)
    u = mp.ellipf(mp.atan2(m2 / b, m1 / a), k) + rate * t
    found = mp.matrix(3, 1)
    turned = a * mp.ellipfun("cn", u, m=k), b * mp.ellipfun("sn", u, m=k), c * mp.ellipfun("dn", u, m=k)
    for i, x in zip(order, turned, strict=True):
        found[i] = x
    return list(axes * found)


def test_what_a_stone_in_the_air_sees_of_its_angular_momentum_follows_jacobis_functions():
    checked = 0
    with mp.workdps(30):
        for case in MOTIONS:
            inertia = [[mpf(x) for x in line] for line in case.inertia]
            moments = sorted(mp.eigsy(mp.matrix(inertia), eigvals_only=True))
            if min(b - a for a, b in pairwise(moments)) < 1e-6:
                continue  # two equal moments
            for one, other in in_the_air(case):
                own = Placed(case, one).own
                if max(map(abs, own)) == 0:
                    continue
                found = jacobi(inertia, own, other.t - one.t)
                apart = add(found, scaled(-1, Placed(case, other).own))
                assert max(abs(x) for x in apart) < mpf(TIGHT) * 10
                checked += 1
    assert checked > 20


@each_motion
def test_an_impact_keeps_the_angular_momentum_about_the_contact(case):
    found = list(struck(case))
    assert found
    with mp.workdps(40):
        for hit, before, after in found:
            a, b = Placed(case, before), Placed(case, after)
            changed = add(b.velocity, scaled(-1, a.velocity))
            assert max(abs(x - y) for x, y in zip(numbers(hit, IMPULSE), changed, strict=True)) < TIGHT
            about = [add(x.momentum, scaled(-1, cross(x.arm, x.velocity))) for x in (a, b)]
            assert max(abs(x - y) for x, y in zip(*about, strict=True)) < TIGHT
            assert abs(a.energy - b.energy - hit.lost) < TIGHT
            assert before.height == after.height == 0
            assert numbers(before, (*Q, *PLACE)) == numbers(after, (*Q, *PLACE))


@each_motion
def test_an_impact_obeys_the_laws_of_friction_and_restitution(case):
    e = mpf(case.restitution)
    with mp.workdps(40):
        mu, static = mpf(case.mu), mpf(case.static or 0)
        for hit, before, after in struck(case):
            assert before.uz < 0 < hit.pz and hit.lost > -TIGHT
            assert after.uz > 0 if e else after.uz == 0
            level, couples, normal = answers(case, before)
            holds = np.linalg.solve(level, couples)
            if hit.kind == "smooth":
                assert hit.px == hit.py == 0
                assert abs(hit.lost - (1 - e * e) * before.uz**2 / (2 * mpf(normal))) < 1e-14
                assert abs(after.uz + e * before.uz) < TIGHT
                continue
            if hit.kind in ("sticks", "slips on"):
                assert (np.hypot(*holds) <= case.static if case.static else True) == (hit.kind == "sticks")
            if hit.kind == "sticks":
                assert after.ux == after.uy == 0
            elif hit.kind == "slips on":
                # along the one direction that a slip from rest keeps
                speed = mp.hypot(after.ux, after.uy)
                way = np.array([float(after.ux / speed), float(after.uy / speed)])
                rate = couples - case.mu * level @ way
                assert abs(way[0] * rate[1] - way[1] * rate[0]) < 1e-13 < way @ rate
            if case.law == "coulomb":
                cone = mp.hypot(hit.px, hit.py) / hit.pz
                most = mu if hit.kind != "sticks" else max(mu, static)
                assert cone <= most * (1 + mpf(TIGHT))


def test_a_dropped_rattleback_cannot_be_held_and_slips_on():
    case = of("rattleback dropped")
    (hit, before, after), *_ = struck(case)
    assert hit.kind == "slips on" and numbers(before, U[:2]) == [0, 0]
    with mp.workdps(40):
        slip, push = [after.ux, after.uy], [hit.px, hit.py]
        assert slip[0] * push[0] + slip[1] * push[1] < 0
        assert abs(slip[0] * push[1] - slip[1] * push[0]) < TIGHT
        assert abs(mp.hypot(*push) / hit.pz - mpf(case.mu)) < TIGHT
        assert abs(after.uz + mpf(case.restitution) * before.uz) < TIGHT


def test_a_smooth_table_keeps_the_horizontal_velocity_and_the_momentum_about_the_vertical():
    case = of("odd stone bounces on a smooth table")
    with mp.workdps(40):
        first = Placed(case, start_of(case))
        for row in case.rows:
            there = Placed(case, row)
            moved = add(there.velocity, scaled(-1, first.velocity))
            assert max(map(abs, moved[:2])) < TIGHT
            assert abs(there.momentum[2] - first.momentum[2]) < TIGHT


def test_a_ball_obeys_the_law_of_grip_and_slip():
    case = of("ball with spin")
    e, inertia = mpf(case.restitution), mpf(case.inertia[0][0])
    with mp.workdps(40):
        height, lift = map(mpf, case.aloft)
        fall = mp.sqrt(2 * height + lift**2)
        slip, t = [mpf(x) for x in case.u], lift + fall
        for k, hit in enumerate(case.impacts[:20]):
            assert abs(hit.t - t) < TIGHT
            size = mp.hypot(*slip)
            stop, most = size / (1 + 1 / inertia), mpf(case.mu) * (1 + e) * fall
            change = min(most, stop)
            assert hit.kind == ("sticks" if stop <= most else "slips")
            if k < 2:
                assert abs(hit.px + change * slip[0] / size) < TIGHT
                assert abs(hit.py + change * slip[1] / size) < TIGHT
                assert abs(hit.pz - (1 + e) * fall) < TIGHT
            less = 1 - (1 + 1 / inertia) * change / size if size else mpf(0)
            slip = [less * x if hit.kind == "slips" else mpf(0) for x in slip]
            fall *= e
            t += 2 * fall
        (rests,) = (row for row in case.rows if row.kind == "rests")
        whole = lift + mp.sqrt(2 * height + lift**2) * (1 + 2 * e / (1 - e))
        assert abs(rests.t - whole) < TIGHT


def test_a_lift_off_from_slip_leaves_as_the_third_power_of_time():
    case = of("odd stone leaps as it slips")
    (leaves,) = (row for row in case.rows if row.kind == "lift-off")
    following = next(row for row in case.rows if row.t > leaves.t)
    with mp.workdps(40):
        assert mp.hypot(leaves.ux, leaves.uy) > 0.01
        there = Placed(case, leaves)
        inertia = [[mpf(x) for x in line] for line in case.inertia]
        solve = mp.lu_solve

        def swung(w):
            torque = cross(along(inertia, w), w)
            return list(solve(mp.matrix(inertia), mp.matrix(torque)))

        def height(t):
            """By many terms of the series of free turning, at a time close by."""
            n, w, z = numbers(leaves, VERTICAL), numbers(leaves, W), mpf(0)
            for _ in range(8):  # midpoint steps, extrapolated below
                h = t / 8
                middle_w = add(w, scaled(h / 2, swung(w)))
                middle_n = add(n, scaled(h / 2, cross(n, w)))
                n, w = add(n, scaled(h, cross(middle_n, middle_w))), add(w, scaled(h, swung(middle_w)))
            z = there.centre[2] + there.velocity[2] * t - t * t / 2
            return z + dot(n, lowest(case, n))

        small, double = height(mpf("0.004")), height(mpf("0.008"))
        assert small > 0 and 7.5 < double / small < 8.5
        assert following.height > 0


# The library.


def start(case):
    """The initial state of the library."""
    n = np.array(case.n) / np.linalg.norm(case.n)
    aloft = dict(zip(("height", "lift"), case.aloft, strict=True)) if case.aloft else {}
    slip = None if case.law == "rolling" and not aloft else tuple(case.u)
    return sc.EllipsoidState(n, case.w, slip, **aloft)


def rolled(case, **options):
    """The motion at the times of the table."""
    stone = sc.Ellipsoid(case.axes, case.inertia, case.offset)
    contact = case.law
    if case.law == "coulomb":
        contact = sc.Coulomb(case.mu, static=case.static)
    elif case.law == "viscous":
        contact = sc.Viscous(case.mu)
    elif case.law == "smooth":
        contact = sc.Coulomb(0.0)
    times = [float(row.t) for row in sampled(case)]
    how = {"contact": contact, "restitution": case.restitution, "want": "pose", **options}
    return sc.roll(stone, start(case), times, t0=0.0, **how)


def leaning(row, pair):
    """Two numbers along x and y of the laboratory in the axes of a state, which does not know how far it turned."""
    here, there = rotation(smallest_turn(numbers(row, VERTICAL))), rotation(numbers(row, Q))
    return along(here, back(there, [*pair, mpf(0)]))[:2]


def told(state):
    """Vertical, angular velocity and slip of a state of the library."""
    return [*state.vertical, *state.w, *(np.zeros(2) if state.slip is None else state.slip)]


def apart(found, row):
    """The largest error of vertical, angular velocity and slip, over the size of the number if that is above 1."""
    true = [float(x) for x in (*numbers(row, (*VERTICAL, *W)), *leaning(row, numbers(row, U[:2])))]
    return (np.abs(np.asarray(found) - true) / np.maximum(1, np.abs(true))).max()


def states_apart(m, case):
    """The largest error of the states at the times of the table."""
    rows, found = sampled(case), np.column_stack([m.vertical, m.w, m.slip])
    up = off(np.column_stack([m.lift, m.height]), rows, ("uz", "height"))
    return max(up.max(), *(apart(state, row) for state, row in zip(found, rows, strict=True)))


def poses_apart(m, case):
    """The largest error of orientation and place; the library counts places from the first one below the stone."""
    first, worst = start_of(case), 0.0
    for turned, place, row in zip(m.orientation, m.contact_point, sampled(case), strict=True):
        q, ours = np.array(numbers(row, Q), float), np.roll(turned, 1)
        moved = [float(getattr(row, name) - getattr(first, name)) for name in PLACE]
        worst = max(worst, min(np.abs(q - ours).max(), np.abs(q + ours).max()), np.abs(place - moved).max())
    return worst


@each_motion
def test_states_and_poses_are_those_of_the_reference(case):
    m, rows = rolled(case), sampled(case)
    assert m.t.tolist() == [float(row.t) for row in rows]
    assert states_apart(m, case) <= max(1e-11, m.error)
    assert poses_apart(m, case) <= max(1e-11, m.pose_error)
    spent = (m.dissipated + m.lost_in_impacts) - [float(row.heat + row.lost) for row in rows]
    assert np.abs(spent).max() <= max(1e-11, m.error)


def due(case):
    """A motion, and the larger of 1e-11 and the error that the library claims for it."""
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
        assert found.kind == x.kind
        if hasattr(x, "lost"):
            assert off([[*found.impulse, found.lost]], [x], (*IMPULSE, "lost")).max() <= most
    # what is left out comes within a moment of an impact after which the stone stays
    stays = [found.time for found in m.impacts if found.stays]
    for t in true.keys() - met:
        assert any(0 < t - other < 1e-5 for other in stays)


@each_motion
def test_impacts_begin_and_end_in_the_states_of_the_reference(case):
    m, most = due(case)
    for hit, before, after in struck(case):
        found = min(m.impacts, key=lambda x: abs(x.time - float(hit.t)))
        for state, row in ((found.before, before), (found.after, after)):
            assert apart(told(state), row) <= most
            assert abs(state.lift - float(row.uz)) <= most
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
        assert apart(told(phase.state), row) <= most


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
    found = np.column_stack([m.vertical, m.w, m.slip])
    assert max(apart(state, row) for state, row in zip(found, rows, strict=True)) <= m.error
    assert poses_apart(m, case) <= m.pose_error


def test_the_samples_know_what_flies():
    checked = 0
    for case in MOTIONS:
        m = rolled(case)
        flies = [row.height > 0 for row in sampled(case)]
        assert [code == 2 for code in m.phase] == flies
        checked += sum(flies)
    assert checked > 20
