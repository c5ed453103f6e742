"""Bodies with a rounded rim: the references of tests/reference/rounded.py keep their laws, and the library agrees.

The first half does not use the library: the tables, computed with vectors to 40 digits or more, obey the
integrals of the motion and the closed formulas. The second half compares the library with them.
"""

import csv
import pathlib
import sys

import numpy as np
import pytest
from mpmath import mp, mpf

import spincyl as sc

REFERENCE = pathlib.Path(__file__).with_name("reference")
sys.path.insert(0, str(REFERENCE))
import newton_euler as ne  # noqa: E402

ULP = 2.0**-53
CONTACTS = ("rolling", "smooth")


def exact(word):
    """A hexadecimal double or a decimal number, with all its digits."""
    return mpf(float.fromhex(word)) if "x" in word else mpf(word)


def table(name):
    with (REFERENCE / f"rounded_{name}.csv").open() as file, mp.workdps(50):
        head, *lines = csv.reader(file)
        words = sum(word in ("kind", "scene", "contact") for word in head)
        return [(line[:words], [exact(word) for word in line[words:]]) for line in lines]


@pytest.fixture(scope="module")
def moments():
    return [numbers for _, numbers in table("moments")]


@pytest.fixture(scope="module")
def steady():
    return [(kind, numbers[:4], *numbers[4:]) for (kind,), numbers in table("steady")]


@pytest.fixture(scope="module")
def motions():
    """Kind, scene and contact; body; start; time; values."""
    return [(*words, x[:4], x[4:8], x[8], x[9:]) for words, x in table("motion")]


def states(motions, contact=None):
    found = [m for m in motions if m[0] != "period" and contact in (None, m[2])]
    assert len(found) > 10
    return found


# The tables.


def test_the_moments_are_those_of_a_torus_between_two_cylinders(moments):
    with mp.workdps(50):
        for h, q, rho, i1, i3, excess in moments:
            a, ell = 1 - rho, h - rho
            p2 = a**2 * rho + a * mp.pi * rho**2 / 2 + 2 * rho**3 / 3
            p4 = (
                a**4 * rho
                + a**3 * mp.pi * rho**2
                + 4 * a**2 * rho**3
                + a * 3 * mp.pi * rho**4 / 4
                + 8 * rho**5 / 15
            )
            q1 = a**2 * rho**2 / 2 + 2 * a * rho**3 / 3 + rho**4 / 4
            q2 = a**2 * rho**3 / 3 + a * mp.pi * rho**4 / 8 + 2 * rho**5 / 15
            mass = 2 * (ell + p2 - q**2 * h)
            axial = (ell + p4 - q**4 * h) / mass
            square = 2 * (ell**3 / 3 + ell**2 * p2 + 2 * ell * q1 + q2 - q**2 * h**3 / 3) / mass
            assert abs(i3 / axial - 1) < 1e-24
            assert abs(i1 / (axial / 2 + square) - 1) < 1e-24
            assert abs(excess - (i1 / i3 - 1)) < 1e-24 * i1 / i3
    assert len(moments) > 50


def test_a_ball_a_capsule_and_a_sharp_cylinder_are_among_the_rounded_bodies(moments):
    with mp.workdps(50):
        rows = {(h, rho): (i1, i3) for h, q, rho, i1, i3, _ in moments if q == 0}
        assert all(abs(x - mpf(2) / 5) < 1e-24 for x in rows[1, 1])
        # a cylinder of mass 2 ell, and two half balls of mass 2/3 with their centres 3/8 beyond its ends
        i1, i3 = rows[2, 1]
        mass = 2 + mpf(4) / 3
        assert abs(i3 - (1 + mpf(8) / 15) / mass) < 1e-24
        halves = mpf(4) / 3 * (mpf(83) / 320 + (1 + mpf(3) / 8) ** 2)
        assert abs(i1 - (2 * (mpf(1) / 4 + mpf(1) / 3) + halves) / mass) < 1e-24
        assert abs(rows[1, 0][0] - mpf(7) / 12) < 1e-24


def geometry(body, theta):
    """Sine and cosine; radius A of the circle of contact; height L of the centre above it; height h above the table."""
    ell, _, _, rho = body
    s, c = mp.sin(theta), mp.cos(theta)
    return s, c, 1 - rho + rho * s, ell + rho * c, rho + ell * c + (1 - rho) * s


def test_the_rate_is_that_of_the_closed_formula_and_there_is_none_where_its_square_is_negative(steady):
    counts = {True: 0, False: 0}
    with mp.workdps(60):
        for kind, body, theta, rate, *_ in steady:
            ell, i1, i3, rho = body
            s, c, radius, _, _ = geometry(body, theta)
            n, d = (1 - rho) * c - ell * s, i1 / i3 - 1
            square = n * radius / (s * (n + d * c * radius))
            counts[square > 0] += 1
            assert mp.isnan(rate) == (square <= 0), kind
            assert mp.isnan(rate) or abs(rate / mp.sqrt(square) - 1) < 1e-23, kind
    assert counts[True] > 300 and counts[False] > 50


def test_kappa_is_that_of_the_closed_formulas(steady):
    checked = 0
    with mp.workdps(60):
        for kind, body, theta, rate, _, rolling, smooth in steady:
            if mp.isnan(rate):
                continue
            ell, i1, i3, rho = body
            a = 1 - rho
            s, c, radius, height, h = geometry(body, theta)
            w1 = rate / mp.sqrt(i3) * s
            w3, cot, g, slope = w1 * height / radius, c / s, ell * s - a * c, h - rho
            square = i1 * (w1 / s) ** 2
            inertia = i1 + g**2
            kappa = (
                square + (2 * cot * i1 * w1 - i3 * w3) * (cot * i1 * w1 - i3 * w3) / i1 - slope
            ) / inertia
            assert abs(smooth - kappa) < 1e-23 * max(abs(kappa), (square + abs(slope)) / inertia), kind
            inertia = i1 + radius**2 + height**2
            d = i1 * i3 + i1 * radius**2 + i3 * height**2
            w1_t = -(cot + i3 * a * height / d) * w1 + i3 / d * (i3 + radius**2 + rho * c * height) * w3
            w3_t = radius / d * (i1 * a * w1 + (i3 * height - i1 * rho * c) * w3)
            v_t = rho * (c * w3 + s * w1) + radius * w3_t - height * w1_t
            kappa = (
                square - 2 * i1 * cot * w1 * w1_t + i3 * (w1_t * w3 + w1 * w3_t) + h / s * w1 * v_t - slope
            )
            kappa /= inertia
            assert abs(rolling - kappa) < 1e-23 * max(abs(kappa), (square + abs(slope)) / inertia), kind
            checked += 1
    assert checked > 300


def energy(body, y, contact):
    """Energy with the velocity r x w of the centre; on a smooth table only its vertical component."""
    ell, i1, i3, rho = body
    theta, w1, w2, w3 = y
    s, c = mp.sin(theta), mp.cos(theta)
    r, w = [-(1 - rho) - rho * s, mpf(0), -ell - rho * c], [w1, w2, w3]  # along e1, e2, e3
    v = ne.cross(r, w)
    fast = ne.dot(v, v) if contact == "rolling" else (s * v[0] + c * v[2]) ** 2
    return (i1 * (w1**2 + w2**2) + i3 * w3**2 + fast) / 2 - s * r[0] - c * r[2]


def test_a_rolling_and_a_sliding_body_keep_their_energy(motions):
    with mp.workdps(40):
        for _, scene, contact, body, start, t, values in states(motions):
            now, then = (energy(body, y, contact) for y in (values[:4], start))
            assert abs(now - then) < 1e-25 * (1 + abs(then)), (scene, contact, t)


def test_a_rolling_ball_keeps_what_routh_and_jellett_found(motions):
    checked = 0
    with mp.workdps(40):
        for _, scene, _, body, start, t, values in states(motions, "rolling"):
            _, i1, i3, rho = body
            if rho < 1:
                continue
            routh, jellett = [], []
            for theta, w1, _, w3 in (start, values[:4]):
                _, _, radius, height, _ = geometry(body, theta)
                routh.append(w3 * mp.sqrt(i1 * i3 + i1 * radius**2 + i3 * height**2))
                jellett.append(i1 * radius * w1 + i3 * height * w3)
            assert abs(routh[1] - routh[0]) < 1e-25 * (1 + abs(routh[0])), (scene, t)
            assert abs(jellett[1] - jellett[0]) < 1e-25 * (1 + abs(jellett[0])), (scene, t)
            checked += 1
    assert checked > 12


def test_a_sliding_body_keeps_its_spin_and_its_turning_about_the_vertical(motions):
    with mp.workdps(40):
        for _, scene, _, body, start, t, values in states(motions, "smooth"):
            _, i1, i3, _ = body
            turning = [i1 * w1 * mp.sin(x) + i3 * w3 * mp.cos(x) for x, w1, _, w3 in (start, values[:4])]
            assert abs(turning[1] - turning[0]) < 1e-25 * (1 + abs(turning[0])), (scene, t)
            assert abs(values[3] - start[3]) < 1e-25
            assert values[9] == 0


def test_the_normal_force_is_the_weight_and_what_lifts_the_centre(motions):
    with mp.workdps(40):
        for _, scene, contact, body, _, t, values in states(motions):
            theta, _, w2, _ = values[:4]
            ell, rim = body[0], 1 - body[3]
            s, c = mp.sin(theta), mp.cos(theta)
            # the height is rho + ell cos + a sin, theta' = -w2
            tilting = -ne.derivative(body, values[:4], contact)[2]
            normal = 1 + (rim * c - ell * s) * tilting - (ell * c + rim * s) * w2**2
            assert abs(normal - values[8]) < 1e-23 * (1 + abs(normal) + abs(tilting)), (scene, contact, t)


def test_a_nutation_turns_where_the_energy_leaves_no_tilting(motions):
    """For balls, where the integrals of Routh and Jellett give w1 and w3 at any inclination."""
    checked = 0
    with mp.workdps(40):
        for kind, scene, contact, body, start, _, values in motions:
            if kind != "period" or contact != "rolling" or body[3] < 1:
                continue
            _, i1, i3, _ = body
            theta, w1, _, w3 = start
            _, _, radius, height, _ = geometry(body, theta)
            routh = w3 * mp.sqrt(i1 * i3 + i1 * radius**2 + i3 * height**2)
            jellett = i1 * radius * w1 + i3 * height * w3
            for turning in values[:2]:
                _, _, radius, height, _ = geometry(body, turning)
                w3 = routh / mp.sqrt(i1 * i3 + i1 * radius**2 + i3 * height**2)
                w1 = (jellett - i3 * height * w3) / (i1 * radius)
                there, here = (energy(body, y, contact) for y in ([turning, w1, mpf(0), w3], start))
                assert abs(there - here) < 1e-22 * (1 + abs(here) + w1**2 / turning), scene
                checked += 1
    assert checked >= 8


# The library.


def test_the_rate_of_a_flat_body_near_its_side_is_right_where_its_moments_nearly_cancel():
    """rate^2 = n A/(s m), m = n + d A cos; with ell = 0, a + d A may nearly vanish where A is stationary, at pi/2."""
    random = np.random.default_rng(1)
    count = 1000
    fillet, off = random.uniform(0.001, 0.999, count), 10.0 ** random.uniform(-9, 0, count)
    i3, flat = random.uniform(0.1, 1, count), random.random(count) < 0.5
    ell = np.where(flat, 0.0, 10.0 ** random.uniform(-12, -1, count))
    nearly = fillet + (1 - fillet) * random.choice([-1, 1], count) * 10.0 ** random.uniform(-8, 0, count)
    body = sc.Body(ell, i3 * np.maximum(nearly, 0.51), i3, fillet=fillet)
    theta = np.pi / 2 + np.where(flat, random.choice([-1, 1], count), -1) * off
    given, near = body.rate(theta), 0
    for *numbers, inclination, rate in zip(body.ell, body.i1, body.i3, fillet, theta, given, strict=True):
        with mp.workdps(50):
            ell, i1, i3, rho, theta = map(mpf, (*map(float, numbers), float(inclination)))
            s, c, a, d = mp.sin(theta), mp.cos(theta), 1 - rho, (i1 - i3) / i3
            radius = a + rho * s
            n = a * c - ell * s
            m = n + d * radius * c
            square = n * radius / (s * m)
            if square <= 0 or not 0 < inclination <= np.pi:
                assert np.isnan(rate)
                continue
            slopes = (-a * s - ell * c) / n, rho * c / radius, -c / s
            turning = -a * s - ell * c + d * (rho * c * c - radius * s)
            condition = abs(theta * (sum(slopes) - turning / m)) / 2
            near += condition < 1
            if np.isnan(rate):  # within rounding of a change of sign of m
                assert condition > 1e12
                continue
            assert abs(rate / mp.sqrt(square) - 1) <= 2 * (1 + condition) * ULP, numbers
    assert near > 100


@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize("spin", [0.0, 0.5, 30.0])
def test_a_ball_near_its_pole_swings_in_a_time_that_is_right_within_what_it_says(contact, spin):
    top = sc.Body.ball(-0.15, 0.39, 0.40)
    wide, *small = (sc.swing(top, sc.State(x, 0.0, 0.0, spin), contact) for x in (1e-4, 1e-5, 1e-6, 1e-7))
    assert wide.error < 1e-6 * wide.period
    for found in small:
        # linear regime: the period changes with the square of the inclination
        assert abs(found.period - wide.period) <= found.error + wide.error + 1e-7 * wide.period
