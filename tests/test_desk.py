"""What docs/desk.md says one sees and hears is what its own code computes: one test for each thing on the desk."""

import contextlib
import functools
import io
import pathlib
import re

import blocks
import numpy as np
import pytest

import spincyl as sc

PAGE = (pathlib.Path(__file__).parents[1] / "docs/desk.md").read_text("utf-8")
THINGS = dict(re.findall(r"^## (?:An? )?([^\n]+)\n(.*?)(?=^## |\Z)", PAGE, re.M | re.S))


@functools.cache
def names_of(thing):
    (code,) = (block.text for block in blocks.of_kind(THINGS[thing], "python"))
    names = {}
    with contextlib.redirect_stdout(io.StringIO()):
        exec(compile(code, thing, "exec"), names)
    return names


def on_desk(thing, *names):
    """The values that the code for a thing leaves under these names."""
    room = names_of(thing)
    return [room[name] for name in names]


def said(thing):
    """The sentence about what one sees or hears, in one line."""
    found = re.search(r"\*You will (?:see|hear):\*(.*)", THINGS[thing], re.S)[1]
    return " ".join(found.split())


def test_every_thing_on_the_desk_has_a_test_here():
    assert len(THINGS) == 11 and all(said(thing) for thing in THINGS)
    tests = [name for name in globals() if name.startswith("test_the_")]
    assert len(tests) == len(THINGS)


def speed_of_top_point(m, upper):
    """Speed of the highest point of one end of a tube, over its speed if it were on a wheel that rolls."""
    dt = 1e-6
    at = m.at([1.0, 1.0 + dt])
    spin = np.linalg.norm(m.w[0])
    from scipy.spatial.transform import Rotation

    turned = Rotation.from_quat(at.orientation)
    axis = turned[0].apply([0.0, 0.0, 1.0])
    radius, half = m.body.scale.radius, m.body.ell * m.body.scale.radius
    over = np.array([0.0, 0.0, 1.0]) - axis[2] * axis
    end = axis * half * (1 if (axis[2] > 0) == upper else -1)
    point = end + radius * over / np.linalg.norm(over)
    body = turned[0].inv().apply(point)
    moved = (at.centre[1] + turned[1].apply(body)) - (at.centre[0] + turned[0].apply(body))
    return np.linalg.norm(moved) / dt / (2 * spin * radius)


def test_the_tube_shows_about_as_many_still_symbols_as_it_is_widths_long_and_none_of_the_other():
    tube, start, m = on_desk("tube", "tube", "start", "m")
    assert "still symbols, whose number is about the length of the tube over its width" in said("tube")
    assert abs(float(start.contact_radius) - float(tube.ell)) < 0.5  # symbols, and widths in its length
    assert m.status == sc.Ending.DONE and np.ptp(m.theta) < 1e-9
    m = m.wanting("pose")
    # a symbol is seen where it stands still as it passes the top: at the upper end, not at the lower
    assert speed_of_top_point(m, upper=True) < 0.02 and speed_of_top_point(m, upper=False) > 0.9


def test_the_coin_whirrs_higher_and_higher_until_it_stops_at_once():
    coin, law, seconds, found = on_desk("coin", "coin", "law", "seconds", "found")
    assert "a whirr whose pitch rises until it suddenly stops" in said("coin")
    assert "of a loss law" in said("coin") and all(fit.law.__class__ is law for fit in found.fits)
    for fit in found.fits:
        drift = sc.drift(coin, np.radians(20), fit.law, fit.centre)
        stops = float(drift.stops_at)
        assert stops == pytest.approx(np.mean(seconds), rel=1e-6)
        pitch = drift.precession(np.linspace(0, 0.999 * stops, 200))
        assert (np.diff(pitch) > 0).all() and pitch[-1] > 5 * pitch[0]
        # at the half of its time it has hardly changed: the rise is at the end
        assert pitch[100] < 1.5 * pitch[0]


def test_the_disk_turns_as_one_over_the_root_of_the_inclination_and_for_minutes_a_coin_for_seconds():
    disk, turns = on_desk("Euler's disk", "disk", "turns")
    coin = on_desk("coin", "coin")[0]
    assert "in proportion to one over the square root of the angle between" in said("Euler's disk")
    level = np.array(turns) * np.sqrt([10, 3, 1])
    assert np.ptp(level) < 0.03 * level.mean() and (np.diff(turns) > 0).all()
    assert "for a minute or two, a coin for seconds" in said("Euler's disk")
    # with the coefficients that others have found, in the middle of their range
    lasts = {}
    for body, lean, pair in ((disk, 40, "Euler's disk that it stops"), (coin, 20, "coin that it stops")):
        (row,) = (x for x in sc.loss.typical if x.of == "DryContour eps" and x.pair == pair)
        law = sc.loss.DryContour.from_si(1e-3 * np.sqrt(row.low * row.high), scale=body)
        lasts[pair] = float(sc.drift(body, np.radians(lean), law).stops_at)
    assert 40 < lasts["Euler's disk that it stops"] < 150 and lasts["coin that it stops"] < 10


def test_the_top_turns_over_and_hops_if_it_spins_half_as_fast_again():
    top, dry, least, m = on_desk("tippe top", "top", "dry", "least", "m")
    words = said("tippe top")
    assert "points at the table after two or three seconds, while the top goes on spinning" in words
    assert m.status == sc.Ending.DONE
    upside = np.degrees(m.theta) > 170
    assert 1.0 < m.t[np.argmax(upside)] < 3.0 and upside[-1], np.degrees(m.theta.max())
    assert abs(m.w[-1, 2]) > 0.25 * abs(m.w[0, 2]) and m.theta[0] < 0.2
    assert "is spun one and a half times as fast, it hops while it turns over" in words
    fast = top.with_centre_velocity(sc.State(0.1, 0.0, 0.0, 1.5 * least), 0.0, 0.0)
    assert sc.roll(top, fast, np.linspace(0, 3, 31), contact=dry).status == sc.Ending.LIFT_OFF
    hops = sc.roll(top, fast, np.linspace(0, 3, 301), contact=dry, restitution=0.3)
    assert hops.height.max() > 1e-4 and np.degrees(hops.theta.max()) > 170
    slow = top.with_centre_velocity(sc.State(0.1, 0.0, 0.0, 0.9 * least), 0.0, 0.0)
    assert np.degrees(sc.roll(top, slow, np.linspace(0, 3, 301), contact=dry).theta.max()) < 170
    told = re.search(r"faster than (\d+) turns", THINGS["tippe top"])[1]
    assert float(told) == pytest.approx(least / top.scale.seconds(2 * np.pi), abs=0.5)


def test_the_spoon_spins_on_in_one_direction_and_turns_back_in_the_other():
    spoon, m = on_desk("spoon", "spoon", "m")
    assert "rattles, stops, and turns back; in the other direction it spins five times as long" in said(
        "spoon"
    )
    t = np.linspace(0, 4, 4001)
    soon, late = (sc.roll(spoon, spoon.spinning(hertz=x, pitch=0.02), t) for x in (-0.8, 0.8))
    assert np.abs(soon.at(m.t).spin - m.spin).max() < 1e-9
    first, other = (t[np.argmax(x.spin * x.spin[0] < 0)] for x in (soon, late))
    assert 4.5 < other / first < 5.5 and first < 0.6
    # it stands still while it rocks, and then spins as fast the other way
    assert soon.spin.max() > 0.9 * abs(soon.spin[0])
    rocks = [np.ptp(x.inclinations[t < first, 0]) for x in (soon, late)]
    assert rocks[0] > 2 * rocks[1]


def test_the_egg_rises_if_it_spins_fast_and_stays_down_if_it_spins_slowly():
    egg, m, wet, up = on_desk("egg", "egg", "m", "wet", "up")
    assert "the egg rises and spins upright on its end" in said("egg")
    assert np.degrees(m.theta[0]) > 80 and np.degrees(m.theta[-200:]).max() < 10
    assert abs(m.spin[-1]) > 0.5 * abs(m.spin[0])
    slow = sc.EllipsoidState.from_si(up, 2 * np.pi * 5 * up, scale=egg)
    slow = egg.with_centre_velocity(slow, 0.0, 0.0)
    assert np.degrees(sc.roll(egg, slow, m.t, contact=wet).theta.min()) > 45


def test_the_hoop_rolls_back_if_the_backspin_times_the_radius_is_more_than_the_speed():
    hoop, m, table = on_desk("hoop", "hoop", "m", "table")
    assert "if its angular velocity times its radius is more than the speed of the throw" in said("hoop")
    away = m.wanting("pose").centre[:, 1] - m.wanting("pose").centre[0, 1]
    assert away.max() > 0.5 and np.argmax(away) < len(away) - 1 and away[-1] < away.max() - 0.1
    assert m.phases[-1].kind == "rolling on its side"
    radius = hoop.scale.radius
    for share in (0.85, 1.15):  # the walls of a hoop are not quite at its radius
        backspin = 2.0
        thrown = sc.thrown(hoop, backspin * radius / share, backspin)
        last = sc.roll(hoop, thrown, np.linspace(0, 3, 31), **table).wanting("pose").centre[-2:, 1]
        assert (last[1] < last[0]) == (share > 1)


def test_the_wheel_rolls_round_a_small_circle_and_a_large_one_at_one_rate_about_its_axle():
    wheel = on_desk("wheel", "wheel")[0]
    assert "two circles at each inclination, slowly round the one circle and fast round the other" in said(
        "wheel"
    )
    for degrees in (60, 75, 80):
        both = wheel.circular(np.radians(degrees), w3=-5.0)
        slow, fast = np.abs(both.precession)
        assert fast > 100 * slow
        for k in (0, 1):
            state = sc.State(float(both.theta[k]), float(both.w1[k]), 0.0, -5.0)
            m = sc.roll(wheel.natural, state, [0.0, 1.0 / abs(both.precession[k])], beyond=True)
            assert abs(m.theta[1] - m.theta[0]) < 1e-6  # steady while it goes through a radian of the circle


def test_the_cup_turns_faster_the_less_it_leans_and_falls_over_beyond_its_balance():
    cup, m = on_desk("cup", "cup", "m")
    assert (
        "faster at a smaller inclination, and falls over at an inclination larger than that at which it balances"
        in said("cup")
    )
    assert m.status == sc.Ending.DONE and np.ptp(m.theta) < 1e-6
    balance = float(cup.theta_balance)
    lean = np.linspace(0.05, 0.98, 20) * balance
    assert (np.diff(cup.hertz(lean)) < 0).all()
    for theta, falls_over in ((0.9 * balance, False), (1.1 * balance, True)):
        let_go = sc.roll(cup, sc.State(theta, 0.0, 0.0, 0.0), np.linspace(0, 0.1, 11))
        assert (let_go.theta[-1] > theta) == falls_over


def test_the_ball_keeps_five_sevenths_of_its_speed_and_tells_the_friction():
    ball, struck, m, cloth = on_desk("ball", "ball", "struck", "m", "cloth")
    assert "the ball rolls with 5/7 of its initial speed in the end" in said("ball")
    size, speed = ball.scale.radius, 3.0
    for mu in (0.1, cloth.mu, 0.5):
        m = sc.roll(ball, struck, np.linspace(0, 2, 401), contact=sc.Coulomb(mu))
        assert abs(m.w[-1, 2]) * size == pytest.approx(5 / 7 * speed, rel=1e-12)
        assert 2 * speed / (7 * ball.scale.gravity * m.phases[-1].time) == pytest.approx(mu, rel=1e-12)


def test_the_disk_with_a_nut_swings_as_often_as_it_says_and_not_as_a_simple_pendulum():
    swings, m = on_desk("unbalanced disk", "swings", "m")
    words = said("unbalanced disk")
    assert (
        "depends on the distance of the nut from the centre, but not as the period of a simple pendulum"
        in words
    )
    side = np.sign(m.vertical[:, 0] - m.vertical[:, 0].mean())
    turns = np.count_nonzero(np.diff(side[side != 0]))
    assert turns / 2 / m.t[-1] == pytest.approx(swings, rel=0.2)
    plain = sc.Ellipsoid.uniform(("40mm", "2mm", "40mm")).in_metres(mass=0.03)
    rates = []
    for depth in ("8mm", "16mm", "32mm"):
        nut = plain.with_weights([("10g", (0.0, 0.0, f"-{depth}"))])
        rates.append(float(nut.rocking(0.0).frequency.max() / nut.scale.seconds(1.0)))
    # a simple pendulum is slower the longer it is; this one is faster
    assert rates[0] < rates[1] < rates[2]
