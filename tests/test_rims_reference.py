"""Bodies that touch with several circles: the references of tests/reference/rims.py keep their laws.

The table, on which two formulations agree to 24 digits or more, obeys the balance of energy, heat and what
losses take, and the closed solutions of cups and cones that roll, rise, rock and rest.
"""

import types
from itertools import pairwise

import pytest
from mpmath import mp, mpf
from reference_rows import table

STATE = ("theta", "w1", "w2", "w3", "u_h", "u_2")
TIGHT = mpf("1e-22")


MOTIONS = table("rims.json")
each_motion = pytest.mark.parametrize("case", MOTIONS, ids=[case.name for case in MOTIONS])


def of(name, cases=MOTIONS):
    """The rows of a motion, and the first of each kind."""
    (case,) = (case for case in cases if case.name == name)
    return case, {row.kind: row for row in reversed(case.rows)}


def circle(case, k, theta):
    """A, L, g and the height of the centre on a circle."""
    a, depth, rho = map(mpf, case.circles[int(k)])
    s, c = mp.sin(theta), mp.cos(theta)
    return a + rho * s, depth + rho * c, depth * s - a * c, depth * c + a * s + rho


def border(case, k, o):
    """theta where two circles are down, as where their heights agree."""
    theta = mp.atan2(case.circles[k][0] - case.circles[o][0], case.circles[k][1] - case.circles[o][1])
    guess = theta + mp.acos(
        (case.circles[o][2] - case.circles[k][2])
        / mp.hypot(case.circles[k][0] - case.circles[o][0], case.circles[k][1] - case.circles[o][1])
    )
    return mp.findroot(lambda x: circle(case, k, x)[3] - circle(case, o, x)[3], guess)


def start_of(case):
    """The first row, which the table leaves out; exact at a border."""
    start = dict(zip(STATE, map(mpf, case.start), strict=True))
    k, o = case.down
    if o >= 0:
        start["theta"] = border(case, min(k, o), max(k, o))
        if case.apex is not None:
            start["w1"] = mp.cos(start["theta"]) * mpf(case.apex)
            start["w3"] = -mp.sin(start["theta"]) * mpf(case.apex)
    return types.SimpleNamespace(**start, t=mpf(0), heat=mpf(0), work=mpf(0), circle=k, other=o, kind="start")


def energy(case, x):
    radius, depth, g, height = circle(case, x.circle, x.theta)
    i1, i3 = map(mpf, case.moments)
    v_h, v_2, v_z = x.u_h + height * x.w2, x.u_2 - depth * x.w1 + radius * x.w3, g * x.w2
    return height + (v_h**2 + v_2**2 + v_z**2 + i1 * (x.w1**2 + x.w2**2) + i3 * x.w3**2) / 2


def rolling(case, k, theta):
    """The inertia with which a body rolls round its apex: that about the line of its contacts."""
    i1, i3 = map(mpf, case.moments)
    return i1 * mp.cos(theta) ** 2 + i3 * mp.sin(theta) ** 2 + circle(case, k, theta)[3] ** 2


def leaned(x):
    """The rate along the lean, w.h."""
    return mp.cos(x.theta) * x.w1 - mp.sin(x.theta) * x.w3


def turned(x):
    """The rate about the vertical, w.z."""
    return mp.sin(x.theta) * x.w1 + mp.cos(x.theta) * x.w3


def test_the_motions_are_of_all_kinds_and_both_formulations_agree():
    kinds = {row.kind for case in MOTIONS for row in case.rows}
    assert kinds >= {"sample", "end", "pivots", "round", "lies", "rocks", "rises", "rests"}
    assert {law for case in MOTIONS for law in case.losses} >= {
        "viscous", "rolling", "drilling", "air", "air2",
    }  # fmt: skip
    assert {case.law for case in MOTIONS} == {"coulomb", "viscous"}
    assert min(case.mu for case in MOTIONS) == 0
    assert any(case.static > case.mu for case in MOTIONS)
    assert {len(case.circles) for case in MOTIONS} >= {2, 3}
    assert len(MOTIONS) >= 12
    assert max(case.agreement for case in MOTIONS) < 1e-23


@each_motion
def test_energy_heat_and_what_losses_take_are_constant_together(case):
    with mp.workdps(40):
        totals = [energy(case, x) + x.heat + x.work for x in (start_of(case), *case.rows)]
        assert max(abs(total - totals[0]) for total in totals) < TIGHT * max(1, abs(totals[0]))
        assert all(b.heat >= a.heat - TIGHT and b.work >= a.work - TIGHT for a, b in pairwise(case.rows))


@each_motion
def test_two_circles_that_are_down_slip_as_one_body_moves(case):
    with mp.workdps(40):
        for row in case.rows:
            if row.other >= 0:
                k, o = int(row.circle), int(row.other)
                apart = circle(case, k, row.theta)[2] - circle(case, o, row.theta)[2]
                assert abs(row.theta - border(case, min(k, o), max(k, o))) < TIGHT and abs(row.w2) < TIGHT
                assert abs(row.other_h - row.u_h) < TIGHT
                assert abs(row.other_2 - row.u_2 + apart * turned(row)) < TIGHT
            else:
                assert mp.isnan(row.other_h) and mp.isnan(row.other_2)


@each_motion
def test_no_circle_reaches_below_the_table(case):
    with mp.workdps(40):
        for row in case.rows:
            for j, (_, _, rho) in enumerate(case.circles):
                if rho == 0:  # of a cap only the part within its borders is there
                    heights = [circle(case, k, row.theta)[3] for k in (row.circle, j)]
                    assert heights[1] < heights[0] + TIGHT


@each_motion
def test_what_sticks_has_no_slip(case):
    with mp.workdps(40):
        for row in case.rows:
            slips = [mp.hypot(row.u_h, row.u_2), mp.hypot(row.other_h, row.other_2)]
            if row.kind in ("round", "rests"):
                assert max(slips) == 0 and abs(turned(row)) < TIGHT
            if row.kind == "pivots":
                assert min(slips) == 0 < max(slips)
            if row.kind in ("rolls", "slips"):
                assert slips[0] == 0
            if row.kind in ("holds spin", "rests"):
                assert abs(leaned(row)) < TIGHT
            if row.kind == "holds turn":
                assert abs(turned(row)) < TIGHT


def test_a_cup_rolls_on_a_circle_round_its_apex():
    case, _ = of("cup rolls round its apex")
    with mp.workdps(40):
        begin = start_of(case)
        s, c, w = mp.sin(begin.theta), mp.cos(begin.theta), mpf(case.apex)
        radius = circle(case, 0, begin.theta)[0]
        # by the slant of its side: the circle of the contact is as much larger as the cone that it is cut from
        (r, low, _), (r1, high, _) = (map(mpf, row) for row in case.circles)
        assert abs(radius / c - r * mp.hypot(r1 - r, low - high) / (r1 - r)) < TIGHT
        for row in case.rows:
            phi = c / s * w * row.t
            assert abs(row.phi - phi) < TIGHT and abs(row.psi + w / s * row.t) < TIGHT * abs(row.psi)
            assert abs(row.x - radius / c * (1 - mp.cos(phi))) < TIGHT * 10
            assert abs(row.y + radius / c * mp.sin(phi)) < TIGHT * 10
            assert row.heat == 0 and abs(leaned(row) - w) < TIGHT


def test_a_cone_that_rolls_has_the_energy_of_the_textbook():
    # Landau and Lifshitz, Mechanics, section 32; the moments are rounded to doubles
    case, _ = of("cone slides off its circle")
    with mp.workdps(40):
        begin = start_of(case)
        rate, height, half = begin.w1 / mp.sin(begin.theta), 2, mp.atan(mpf(1) / 2)
        told = mpf(3) / 40 * height**2 * rate**2 * (1 + 5 * mp.cos(half) ** 2)
        assert abs(energy(case, begin) - circle(case, 0, begin.theta)[3] - told) < 1e-15


def test_a_cone_slides_off_its_circle_outward():
    # the apex of its circle is its tip, which is where the lean does not point to
    case, _ = of("cone slides off its circle")
    with mp.workdps(40):
        begin = start_of(case)
        push = circle(case, 0, begin.theta)[3] * begin.w1 / mp.sin(begin.theta) * leaned(begin)
        assert push > case.static
        assert case.rows[0].u_h < 0


def test_an_end_rises_where_its_normal_force_vanishes():
    case, rows = of("cup whose narrow end rises")
    with mp.workdps(40):
        row, (i1, i3) = rows["rises"], map(mpf, case.moments)
        assert row.circle == 1 and row.other == -1
        couple = i3 * row.w1 * row.w3 - i1 * mp.cot(row.theta) * row.w1**2
        _, _, g, height = circle(case, 1, row.theta)
        friction = mpf(case.mu) * height * row.u_h / mp.hypot(row.u_h, row.u_2)
        assert abs(couple - g + friction) < TIGHT


def test_a_cup_that_rolls_too_fast_stands_up_on_its_wide_end():
    case, _ = of("cup that rolls too fast")
    with mp.workdps(40):
        begin = start_of(case)
        limit = abs(circle(case, 1, begin.theta)[2]) * mp.tan(begin.theta) / rolling(case, 1, begin.theta)
        assert mpf(case.apex) > mp.sqrt(limit)
        assert all(row.circle == 1 and row.theta > begin.theta for row in case.rows)


def test_told_from_its_other_end_a_cup_makes_the_same_motion():
    (case, _), (other, _) = of("cup flicked on its side"), of("cup told from its other end")
    with mp.workdps(40):
        assert len(case.rows) == len(other.rows)
        for a, b in zip(case.rows, other.rows, strict=True):
            told = [mp.pi - b.theta, b.w1, -b.w2, -b.w3, -b.u_h, -b.u_2, -b.other_h, -b.other_2]
            told += [b.t, b.heat, b.phi, -b.psi, -b.x, -b.y, 1 - b.circle, 1 - b.other]
            own = [*(getattr(a, name) for name in STATE), a.other_h, a.other_2]
            own += [a.t, a.heat, a.phi, a.psi, a.x, a.y, a.circle, a.other]
            assert a.kind == b.kind
            assert all(abs(x - y) < TIGHT * max(1, abs(x)) for x, y in zip(own, told, strict=True))


def test_two_equal_rims_make_the_motion_of_a_body_that_lies_on_its_side():
    case, _ = of("cylinder falls and lies")
    known, _ = of("cylinder falls and lies", table("lying.json"))
    with mp.workdps(40):
        kinds = [row.kind.replace("round", "straight") for row in case.rows]
        assert kinds == [row.kind for row in known.rows]
        for a, b in zip(case.rows, known.rows, strict=True):
            assert a.circle == 0  # else that table tells the state from the other end
            for name in (*STATE, "t", "heat", "phi", "psi", "x", "y"):
                x, y = getattr(a, name), getattr(b, name)
                assert abs(x - y) < TIGHT * max(1, abs(y))


def test_a_short_frustum_rocks_to_rest_at_the_known_time():
    case, rows = of("short frustum rocks to rest")
    with mp.workdps(40):
        rest, (i1, _) = rows["rocked"], map(mpf, case.moments)
        # the number of a model in doubles, which sums the last landings as a geometric series
        assert abs(float(rest.t) - 6.70143758) < 1e-8
        # all that the centre comes down by is heat
        heights = [circle(case, 0, theta)[3] for theta in (start_of(case).theta, rest.theta)]
        assert abs(rest.heat - (heights[0] - heights[1])) < TIGHT
        # the ratio of two landings, as both circles stick, after a hop that loses nothing
        (_, _, g, height), (_, _, g1, _) = (circle(case, k, rest.theta) for k in (0, 1))
        inertia = i1 + height**2
        ratios = [(inertia + g * g1) / (inertia + x * x) for x in (g, g1)]
        rocks = [row for row in case.rows if row.kind == "rocks"]
        assert len(rocks) >= 2
        for one, other in pairwise(rocks):
            assert abs(other.w2 / one.w2 + ratios[int(other.circle)]) < TIGHT


def test_what_rolls_round_its_apex_rests_when_its_closed_solution_says():
    with mp.workdps(40):
        case, rows = of("cup rests by rolling resistance in air")
        begin, stop = start_of(case), rows["rests"]
        inertia = rolling(case, 0, begin.theta)
        air, resistance = (mpf(case.losses[name]) for name in ("air", "rolling"))
        assert abs(stop.t - inertia / air * mp.log(1 + air * mpf(case.apex) / resistance)) < TIGHT * stop.t
        case, rows = of("rolling resistance and drilling stop a cup")
        begin, stop = rows["round"], rows["rests"]
        took = rolling(case, 0, begin.theta) * abs(leaned(begin)) / mpf(case.losses["rolling"])
        assert abs(stop.t - begin.t - took) < TIGHT * stop.t


def test_viscous_contour_slows_a_cup_by_the_mean_of_both_circles_over_their_loads():
    case, _ = of("cup rolls round under viscous contour and quadratic air")
    with mp.workdps(40):
        theta, c = start_of(case).theta, mp.cos(start_of(case).theta)
        (a, _, g, _), (a1, _, g1, _) = (circle(case, k, theta) for k in (0, 1))
        inertia, s = rolling(case, 0, theta), mp.sin(theta)
        contour, air = mpf(case.losses["viscous"]), mpf(case.losses["air2"])

        def pace(w):
            load = (-g1 - c / s * inertia * w * w) / (g - g1)
            mean = load * a**2 + (1 - load) * a1**2
            return inertia / (contour * mean * w / s**2 + air * w * w)

        for row in case.rows:
            assert abs(mp.quad(pace, [leaned(row), mpf(case.apex)]) - row.t) < TIGHT * row.t


def test_on_a_smooth_table_the_centre_moves_uniformly_and_what_lies_turns_at_constant_rates():
    case, rows = of("frustum falls on a smooth table")
    landed = rows["lies"]
    with mp.workdps(40):
        moves = []
        for row in (start_of(case), *case.rows):
            radius, depth, _, height = circle(case, row.circle, row.theta)
            along, across = row.u_h + height * row.w2, row.u_2 - depth * row.w1 + radius * row.w3
            moves.append((along + 1j * across) * mp.expj(getattr(row, "phi", 0)))
        assert max(abs(move - moves[0]) for move in moves) < TIGHT
        for row in case.rows:
            if row.t > landed.t:
                assert abs(row.w1 - landed.w1) < TIGHT and abs(row.w3 - landed.w3) < TIGHT


def test_a_cap_passes_on_to_its_edge_at_the_joint_and_back():
    case, _ = of("hemisphere passes to its edge and back")
    joints = [row for row in case.rows if row.kind == "joint"]
    with mp.workdps(40):
        assert [int(row.circle) for row in joints] == [1, 0, 1]
        assert all(abs(row.theta - mp.pi / 2) < TIGHT for row in joints)
