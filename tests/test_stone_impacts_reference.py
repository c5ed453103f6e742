"""Single impacts of stones, at a point and on a patch: the references of tests/reference obey their laws.

stone_impacts.csv and patch_impacts.csv have them to 25 digits, each by two ways. Here they are followed by steps along
the normal impulse, and compared with closed formulas and with each other.
"""

import csv
import math
import pathlib
import types

import numpy as np
import pytest
from mpmath import mp, mpf

REFERENCE = pathlib.Path(__file__).with_name("reference")
TIGHT = 1e-22


def table(name, told):
    """The rows: matrix and inputs are exact, results to 25 digits."""
    rows = []
    with (REFERENCE / name).open() as file, mp.workdps(40):
        for row in csv.DictReader(file):
            made = {k: row[k] for k in ("name", "kind", "law") if k in row}
            made |= {k: mpf(v) for k, v in row.items() if k in told}
            given = {k: float.fromhex(v) for k, v in row.items() if k not in {*made, "times"}}
            size = 4 if "w" in given else 3
            matrix = mp.matrix(size)
            for i in range(size):
                for j in range(size):
                    matrix[i, j] = mpf(given[f"m{min(i, j) + 1}{max(i, j) + 1}"])
            vectors = {
                "u": mp.matrix([given[x] for x in ("u1", "u2", "u3", "w")[:size]]),
                "p": mp.matrix([made[x] for x in ("p1", "p2", "p3", "c")[:size]]),
                "v": mp.matrix([made[x] for x in ("v1", "v2", "v3", "x")[:size]]),
            }
            rest = {k: given[k] for k in ("e", "mu", "static", "patch") if k in given}
            more = {"matrix": matrix, "times": int(row["times"]), "lost": made["lost"]}
            apart = {"agreement": float(row["agreement"])}
            named = {k: row[k] for k in ("name", "kind", "law") if k in row}
            rows.append(types.SimpleNamespace(**named, **rest, **more, **vectors, **apart))
    return rows


RESULTS = {"p1", "p2", "p3", "c", "v1", "v2", "v3", "x", "lost", "agreement"}
POINT, PATCH = table("stone_impacts.csv", RESULTS), table("patch_impacts.csv", RESULTS)
each = pytest.mark.parametrize("row", [*POINT, *PATCH], ids=lambda row: row.name)


def of(rows, name):
    (row,) = (row for row in rows if row.name == name)
    return row


def holds(row):
    """The horizontal push that a point without slip takes, per unit of the normal impulse."""
    level, couples = row.matrix[:2, :2], row.matrix[:2, 2]
    return -mp.lu_solve(level, couples)


def test_the_impacts_are_of_all_kinds_and_both_ways_agree():
    assert {row.kind for row in POINT} == {"slips", "sticks", "slips on", "smooth"}
    assert {row.kind for row in PATCH} == {"slips", "creeps", "sticks", "slips on", "smooth"}
    assert {row.law for row in POINT} == {"coulomb", "viscous", "smooth", "rolling"}
    assert sum(row.times == 2 for row in POINT) >= 3
    assert len(POINT) >= 15 and len(PATCH) >= 12
    assert max(row.agreement for row in [*POINT, *PATCH]) < 1e-30


@each
def test_velocities_answer_the_impulse_and_the_energy_that_is_lost_is_told(row):
    with mp.workdps(40):
        assert mp.norm(row.u + row.matrix * row.p - row.v, mp.inf) < TIGHT * 100
        assert abs(row.lost + ((row.u + row.v).T * row.p)[0] / 2) < TIGHT * 100
        assert row.lost > -TIGHT and row.u[2] < 0 < row.p[2]
        assert row.v[2] > 0 if row.e else row.v[2] == 0
        assert min(mp.eigsy(row.matrix, eigvals_only=True)) > 0


@each
def test_friction_is_at_most_what_its_coefficient_allows(row):
    law = getattr(row, "law", "coulomb")
    with mp.workdps(40):
        push = mp.hypot(row.p[0], row.p[1])
        if law in ("coulomb", "smooth"):
            most = max(row.mu, getattr(row, "static", 0))
            assert push <= most * row.p[2] * (1 + mpf(TIGHT))
        if row.kind == "sticks":
            assert row.v[0] == row.v[1] == 0
        if row.kind == "smooth":
            assert push == 0 and abs(row.v[2] + row.e * row.u[2]) < TIGHT
        if hasattr(row, "patch"):
            # less couple, the more the patch slips
            assert abs(row.p[3]) <= 3 * mp.pi / 16 * mpf(row.mu) * mpf(row.patch) * row.p[2] * (
                1 + mpf(TIGHT)
            )
            assert row.kind not in ("slips", "creeps") or (row.kind == "slips") == (
                mp.hypot(row.v[0], row.v[1]) > mpf(row.patch) * abs(row.v[3])
            )


def test_a_slip_that_has_stopped_is_held_or_goes_on_along_the_one_way_out():
    checked = set()
    with mp.workdps(40):
        for row in POINT:
            if row.law != "coulomb" or row.kind not in ("sticks", "slips on"):
                continue
            needs = mp.norm(holds(row), 2)
            assert (needs <= row.static) == (row.kind == "sticks")
            checked.add((row.kind, row.static > row.mu))
            if row.kind == "slips on":
                slip = row.v[:2]
                way = slip / mp.norm(slip, 2)
                rate = row.matrix[:2, 2] - mpf(row.mu) * (row.matrix[:2, :2] * way)
                grows = (way.T * rate)[0]
                assert grows > 0 and mp.norm(rate - grows * way, 2) < TIGHT
    assert checked == {("sticks", False), ("sticks", True), ("slips on", False)}


def doubles(v):
    return [float(x) for x in v]


PLACES, WEIGHTS = np.polynomial.legendre.leggauss(60)
PLACES, WEIGHTS = (PLACES + 1) / 2, WEIGHTS / 2


def friction(row, u, v, drilling, soft=0.0):
    """The push and the couple per unit of the normal impulse, in doubles; a slip below `soft` is rubbed less."""
    mu = row.mu
    if getattr(row, "law", "") == "viscous":
        return -mu * u, -mu * v, 0.0
    size = math.hypot(u, v)
    if not hasattr(row, "patch"):
        pull = -mu / math.hypot(size, soft) if mu else 0.0
        return pull * u, pull * v, 0.0
    wide = math.hypot(row.patch * drilling, soft)
    if size <= wide:
        x = (size / wide) ** 2
        f, g = 3 * math.pi / 32 * (4 - x) / wide, 3 * math.pi / 128 * (8 - x * (8 - 3 * x))
    else:
        # Gauss's rule over the distances of the chords from the centre of the patch
        chords, across = 1 - PLACES**2, np.sqrt(1 - (wide / size * PLACES) ** 2)
        f = WEIGHTS @ (chords * across) * 1.5 / size
        g = WEIGHTS @ (chords**2 / across) * 3 / 8 * (wide / size)
    return -mu * f * u, -mu * f * v, -mu * row.patch * g * (row.patch * drilling / wide if wide else 0.0)


def stepped(row, steps, soft):
    """Velocities and drilling after the normal impulse, the lowest work at u_n = 0 and the last work: by RK4."""
    size = len(row.u)
    matrix, h = [doubles(line) for line in row.matrix.tolist()], float(row.p[2]) / steps
    y = [*doubles(row.u), 0.0]

    def rates(y):
        x, z, couple = friction(row, y[0], y[1], y[3] if size == 4 else 0.0, soft)
        push = (x, z, 1.0, couple)[:size]
        return [*(sum(a * b for a, b in zip(line, push, strict=True)) for line in matrix), y[2]]

    def moved(y, h, rate):
        return [a + h * b for a, b in zip(y, rate, strict=True)]

    lowest = 0.0
    for _ in range(steps):
        a = rates(y)
        b = rates(moved(y, h / 2, a))
        c = rates(moved(y, h / 2, b))
        d = rates(moved(y, h, c))
        before, y = (
            y,
            [x + h / 6 * (p + 2 * q + 2 * r + s) for x, p, q, r, s in zip(y, a, b, c, d, strict=True)],
        )
        if before[2] < 0 <= y[2]:
            lowest = min(lowest, before[-1] + before[2] ** 2 * h / (before[2] - y[2]) / 2)
    return y[:-1], lowest or y[-1], y[-1]


@each
def test_an_impact_is_the_motion_along_the_normal_impulse_up_to_the_work_that_is_restored(row):
    law = getattr(row, "law", "coulomb")
    if law == "rolling" or getattr(row, "static", row.mu) != row.mu:
        # such steps know neither the rolling table nor static friction
        assert row.kind in ("sticks", "slips")
        return
    smooth = (
        law == "viscous"
        or row.kind == "smooth"
        or (hasattr(row, "patch") and row.kind in ("slips", "creeps"))
    )
    smooth &= float(mp.norm(row.u[:2], 2)) > 0 or row.kind == "creeps"
    after, lowest, work = stepped(row, 1000 if smooth else 6000, 0.0 if smooth else -float(row.u[2]) / 500)
    near = (1e-5 if smooth else 1e-2) * max(1.0, float(mp.norm(row.u, mp.inf)))
    assert max(abs(a - b) for a, b in zip(after, doubles(row.v), strict=True)) < near
    assert abs(work - (1 - row.e**2) * lowest) < near


def test_the_numbers_of_an_independent_sketch_of_the_skew_stone():
    for name, push, lift in (
        ("skew stone slips", (-0.0766894409, 0.2006982782, 1.1325901481), 0.5841196368),
        ("skew stone sticks", (0.0103712775, 0.5174944953, 1.3424836979), 0.6046220909),
    ):
        row = of(POINT, name)
        assert max(abs(row.p[i] - push[i]) for i in range(3)) < 2e-10 and abs(row.v[2] - lift) < 1e-10
    row = of(PATCH, "skew stone slips")
    told = (-0.0763430747, 0.1992179466, 1.1318113199, -0.0005783491)
    assert max(abs(row.p[i] - told[i]) for i in range(4)) < 1e-10
    assert abs(row.v[2] - 0.5841577062) < 1e-10 and abs(row.v[3] - 2.8592443958) < 1e-10


def test_a_point_without_slip_that_is_held_returns_the_velocity_times_the_restitution():
    row = of(POINT, "skew stone lands without slip and sticks")
    with mp.workdps(40):
        assert abs(row.v[2] + mpf(row.e) * row.u[2]) < TIGHT
        push = holds(row) * row.p[2]
        assert mp.norm(push - row.p[:2], mp.inf) < TIGHT


def test_a_rolling_table_stops_the_slip_before_the_normal_impulse_begins():
    rows = [row for row in POINT if row.law == "rolling"]
    assert len(rows) >= 3
    with mp.workdps(40):
        for row in rows:
            hold = holds(row)
            bare = row.u[2] + (hold.T * row.u[:2])[0]
            assert bare < 0 and abs(row.v[2] + mpf(row.e) * bare) < TIGHT
            rate = row.matrix[2, 2] + (hold.T * row.matrix[:2, 2])[0]
            assert abs(row.p[2] + (1 + mpf(row.e)) * bare / rate) < TIGHT


def test_a_ball_grips_or_slips_by_the_known_rule():
    with mp.workdps(40):
        for name in ("ball slips", "ball grips"):
            row = of(POINT, name)
            light, normal = row.matrix[0, 0], -(1 + mpf(row.e)) * row.u[2]
            assert abs(row.p[2] - normal) < 1e-15  # a_n of the doubles is 1 to rounding
            slip = mp.norm(row.u[:2], 2)
            push = min(mpf(row.mu) * normal, slip / light)
            assert mp.norm(row.p[:2] + row.u[:2] * push / slip, mp.inf) < 1e-15
            assert (row.kind == "sticks") == (push == slip / light)


def test_a_ball_with_pure_spin_loses_as_much_as_by_drilling_under_its_weight_for_the_same_impulse():
    with mp.workdps(40):
        row, near = of(PATCH, "ball with pure spin"), of(PATCH, "ball near pure spin")
        couple = 3 * mp.pi / 16 * mpf(row.mu) * mpf(row.patch) * (1 + mpf(row.e))
        assert abs(row.p[3] + couple) < TIGHT
        assert abs(row.v[3] - (row.u[3] - row.matrix[3, 3] * couple)) < TIGHT
        assert mp.norm(near.p - row.p, mp.inf) < 1e-8
        # a slip in the patch dies as an exponential of the impulse over the drilling, which hardly changes
        fades = 3 * mp.pi / 8 * mpf(row.mu) * row.matrix[0, 0] / mpf(row.patch) / row.matrix[3, 3]
        most = 3 * mp.pi / 16 * mpf(row.mu) * mpf(row.patch) * row.matrix[3, 3]
        left = (row.v[3] / row.u[3]) ** (fades * row.matrix[3, 3] / most)
        for i in (0, 1):
            assert abs(near.v[i] / near.u[i] / left - 1) < 1e-12


def test_a_patch_that_vanishes_is_a_point():
    point = of(POINT, "skew stone slips")
    with mp.workdps(40):
        far = mp.norm(of(PATCH, "skew stone slips").p[:3] - point.p, mp.inf)
        near = mp.norm(of(PATCH, "skew stone slips on a small patch").p[:3] - point.p, mp.inf)
        # of second order where the slip never stops
        assert far < 2e-3 and near < far / 50**2 * 1.5


def test_slip_and_drilling_that_have_stopped_are_held_inside_the_curve_of_force_and_couple():
    rows = [row for row in PATCH if row.kind == "sticks" and "skew" in row.name]
    rows += [row for row in PATCH if row.kind == "slips on"]
    assert {row.kind for row in rows} == {"sticks", "slips on"}
    own = [0, 1, 3]
    for row in rows:
        level = np.array([[float(row.matrix[i, j]) for j in own] for i in own])
        wanted = np.array([float(row.matrix[i, 2]) for i in own])
        needs = np.linalg.solve(level, wanted)
        # friction spends more than it is given along every way of slip and drilling, or not
        excess = -math.inf
        for angle in np.linspace(0, 2 * math.pi, 73):
            for turn in np.tan(np.linspace(-1.5, 1.5, 61)) / row.patch:
                u, v = math.cos(angle), math.sin(angle)
                x, y, couple = friction(row, u, v, turn)
                excess = max(excess, (needs[0] + x) * u + (needs[1] + y) * v + (needs[2] + couple) * turn)
        assert (excess < 0) == (row.kind == "sticks")
        if row.kind == "slips on":
            rate = wanted + level @ friction(row, *doubles([row.v[0], row.v[1], row.v[3]]))
            ends = np.array([float(row.v[i]) for i in own])
            assert np.abs(rate * float(row.p[2]) - ends).max() < 1e-12
