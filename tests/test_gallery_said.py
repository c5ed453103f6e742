"""What docs/gallery.md says of its scenes is what their motions do: one test for each scene, with numbers of its own."""

import pathlib
import re
from itertools import groupby, pairwise

import billiard
import blocks
import dropped_coin
import dropped_egg
import eulers_disk_stops
import falling_pencil
import flicked_tube
import gallery
import hopping_top
import hopping_tube
import hula_hoop
import hurricane_balls
import near_steady_tube
import numpy as np
import pushed_can
import pytest
import race_downhill
import rattleback
import rising_egg
import rocking_can
import rolled_cup
import sliding_puck
import tippe_top_turns
import tipped_bottle
import turntable
from scipy.signal import find_peaks

import spincyl as sc

PAGE = (pathlib.Path(__file__).parents[1] / "docs/gallery.md").read_text("utf-8")
PROSE = {
    pathlib.Path(scene.path).stem: " ".join(re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", scene.prose).split())
    for scene in blocks.scenes(PAGE)
}


def says(scene, *phrases):
    """Fail if the page no longer says what a test shows."""
    for phrase in phrases:
        assert phrase in PROSE[scene.__name__], (phrase, PROSE[scene.__name__])


def test_every_scene_of_the_gallery_has_a_test_here():
    text = pathlib.Path(__file__).read_text("utf-8")
    assert set(re.findall(r"^    says\(\s*(\w+),", text, re.M)) == set(gallery.SCENES)


def test_a_tube_almost_on_its_side_shows_six_still_symbols_also_after_a_push():
    says(near_steady_tube, "shows about six still symbols, even after a small push")
    for start in (near_steady_tube.body.steady(np.radians(85)), near_steady_tube.start):
        m = sc.roll(near_steady_tube.body, start, near_steady_tube.t, want="pose")
        assert m.status == sc.Ending.DONE and abs(m.psi[-1] / m.phi[-1]) == pytest.approx(6, abs=0.15)
    assert np.ptp(np.degrees(m.theta)) > 5, "the push is seen"


def test_a_flicked_tube_slips_for_a_second_until_its_centre_is_almost_at_rest_and_shows_six_symbols():
    says(
        flicked_tube,
        "slips for a second while its centre comes nearly to rest",
        "rolls on, showing six still",
    )
    m = sc.roll(flicked_tube.body, flicked_tube.start, flicked_tube.t, contact=flicked_tube.table)
    assert [phase.kind for phase in m.phases] == ["slipping", "rolling"]
    late = m.t >= m.phases[-1].time
    assert 0.5 < flicked_tube.scale.seconds(m.phases[-1].time) < 1.5
    speed = flicked_tube.centre_speed(m)
    assert speed[late].max() < 0.05 * speed[0]
    assert np.abs(flicked_tube.still_symbols(m)[late] - 6).max() < 0.1


def test_a_tube_pressed_twice_as_hard_hops_twenty_times_and_settles_as_soon():
    says(
        hopping_tube,
        "pressed twice as hard",
        "hops twenty times",
        "as soon as it would without hops",
        "and little more",
    )
    assert 1.9 < hopping_tube.IMPULSE / flicked_tube.IMPULSE < 2.3
    ends, heat = [], []
    for bounces in (0.0, 0.5, 0.9):
        m = sc.roll(
            hopping_tube.body,
            hopping_tube.start,
            hopping_tube.t,
            contact=hopping_tube.table,
            restitution=bounces,
        )
        # a hop with its bounces is a row of flights
        hops = sum(kind == "flying" for kind, _ in groupby(phase.kind for phase in m.phases))
        assert bounces > 0.5 or 15 < hops < 30, (bounces, hops)  # with high bounces they run together
        assert m.phases[-1].kind == "rolling"
        ends.append(m.phases[-1].time)
        heat.append((m.dissipated[-1], m.lost_in_impacts[-1]))
    assert np.ptp(ends) < 0.01 * ends[0]
    # what it loses in impacts it does not lose to slip
    heat = np.array(heat)
    assert heat[2, 1] > 5 * heat[0, 1] and np.ptp(heat.sum(axis=1)) < 0.01 * heat.sum(axis=1)[0]


def test_a_dropped_coin_whirrs_to_rest_within_four_seconds_and_stays_on_its_edge_if_it_does_not_bounce():
    says(
        dropped_coin,
        "whirrs to rest, all within 4 seconds",
        "If the coin does not bounce at all, it stays on its edge",
    )
    for bounces in (0.0, 0.3, 0.5, 0.7):
        m = dropped_coin.rest(bounces)
        lean = np.degrees(min(m.event.state.theta, np.pi - m.event.state.theta))
        assert dropped_coin.scale.seconds(m.event.time) < 4 and m.impacts
        assert (lean > 89) == (bounces == 0) and (bounces == 0 or lean < 1)
    first = dropped_coin.scale.metres(m.height[0])
    assert first == pytest.approx(0.05, abs=1e-9)


def test_a_dropped_egg_tumbles_bounces_unevenly_and_rocks_to_rest_and_impacts_take_most_of_its_energy():
    says(
        dropped_egg, "falls from 10 cm, leaning by 35 degrees", "makes it tumble", "higher and lower by turns",
        "After half a second the egg rolls away end over end, slips as it rocks to rest", "almost two metres",
        "take most of its energy at any coefficient of restitution",
    )  # fmt: skip
    for bounces in (0.0, 0.3, dropped_egg.RESTITUTION):
        m = dropped_egg.fallen(bounces)
        assert m.status == sc.Ending.STOPS and m.height[0] == pytest.approx(0.10)
        assert np.degrees(m.theta[0]) == pytest.approx(35)
        assert (
            0.5 < m.lost_in_impacts[-1] / (m.energy[0] - m.energy[-1]) < 0.8 and 1.5 < m.centre[-1, 0] < 2.0
        )
        whole = m.energy + m.dissipated + m.work_lost + m.lost_in_impacts
        assert np.ptp(whole) < 1e-9 * whole[0]
    assert dropped_egg.stays(m) == pytest.approx(0.5, abs=0.05)
    # the highest points of its centre in the first flights do not just fall
    hits = [x.time for x in m.impacts]
    tops = [m.centre[(m.t > a) & (m.t < b), 2].max() for a, b in pairwise(hits[:3])]
    assert tops[1] > tops[0]
    # then it goes round, end over end, and the slip comes late
    assert np.linalg.norm(m.impacts[0].after.w) > 1.0 > np.linalg.norm(m.impacts[0].before.w)
    late = m.t[np.argmax(m.dissipated > 0.2 * m.dissipated[-1])]
    assert late > 0.6 * m.event.time


def test_a_tippe_top_that_hops_near_the_top_of_every_nod_turns_over_later():
    says(
        hopping_top, "near the top of every nod it is thrown up, by less than half a millimetre",
        "bounces once or twice, and slips on", "still turns over, but later", "every top above the least spin",
    )  # fmt: skip
    scene, late = hopping_top, []
    for turns in (28.0, 37.0, scene.TURNS, 49.0):
        m = scene.turned(turns)
        assert m.status == sc.Ending.DONE and m.theta[-1] > 3.0
        assert scene.scale.metres(m.height.max()) < 0.5e-3
        late.append(scene.over(m))
        if turns == scene.TURNS:
            row = [(kind, next(of).time) for kind, of in groupby(m.phases, lambda phase: phase.kind)]
            starts = np.array([time for kind, time in row if kind == "flying"])
            near = (m.t > starts[0] - 0.5) & (m.t < starts[-1] + 0.5)
            found, _ = find_peaks(np.degrees(m.theta[near]), prominence=2)
            tops = m.t[near][found]
            apart = starts[:, None] - tops
            apart = np.take_along_axis(apart, np.abs(apart).argmin(axis=1)[:, None], axis=1)
            assert scene.hops(m) == tops.size > 30, "one hop in each nod"
            assert np.abs(apart).max() < 0.2 * np.diff(tops).mean(), "near its top"
    assert scene.hops(scene.turned(28.0)) == 0 and late == sorted(late)


def test_eulers_disk_stops_at_one_time_under_three_laws_and_the_whirr_tells_them_apart():
    says(
        eulers_disk_stops,
        "from 17 degrees",
        "three loss laws that stop it at the same time",
        "shows which of the laws acts",
    )
    body, start = eulers_disk_stops.body, eulers_disk_stops.start
    assert np.degrees(start.theta) == pytest.approx(17, abs=0.5)
    drifts = [
        sc.drift(body, start.theta, eulers_disk_stops.lasting(law, 1500.0)) for law in eulers_disk_stops.LAWS
    ]
    assert len(drifts) == 3 and np.ptp([x.stops_at for x in drifts]) < 1e-8 * 1500
    halfway = np.sort([float(x.theta(750.0)) for x in drifts])
    late = np.sort([float(x.precession(1490.0)) for x in drifts])
    assert (np.diff(np.degrees(halfway)) > 0.3).all() and (late[1:] > 1.05 * late[:-1]).all()


def test_a_can_rises_again_turned_by_an_angle_that_hardly_depends_on_its_spin():
    says(rocking_can, "rises again and leans another way", "by an angle that hardly depends on its spin")
    for w1 in (1e-4, 1e-3, 1e-2):
        swing = sc.swing(rocking_can.body, sc.State(0.3, w1, 0.0, 0.0))
        turned = np.degrees(swing.precession_per_period)
        assert np.degrees(swing.theta_min) < 0.5 and 229 < turned < 235
    m = sc.roll(rocking_can.body, rocking_can.start, rocking_can.t)
    low = int(m.theta.argmin())
    assert 0 < low < len(m.t) - 1 and m.theta[low] < 0.01 and m.theta[low:].max() > 0.25


def test_hurricane_balls_nod_about_a_state_and_no_state_is_steeper_than_66_degrees():
    says(hurricane_balls, "nod about a steady state that is no steeper than 66 degrees")
    body = hurricane_balls.body
    assert np.degrees(body.theta_limit) == pytest.approx(66, abs=0.5)
    for steep, there in ((0.98, False), (1.02, True)):
        try:
            body.steady(steep * float(body.theta_limit))
        except ValueError:
            assert not there
        else:
            assert there
    m = sc.roll(body, hurricane_balls.start, hurricane_balls.t)
    assert m.theta.min() < hurricane_balls.start.theta < m.theta.max() and m.status == sc.Ending.DONE
    assert m.theta.min() > body.theta_limit


def test_a_hoop_slides_until_its_contact_rests_and_rolls_back_to_the_thrower():
    says(
        hula_hoop,
        "slides until its contact point is at rest, and then it rolls back to the thrower",
        "Friction is constant",
    )
    m = sc.roll(hula_hoop.body, hula_hoop.start, hula_hoop.t, contact=hula_hoop.table, want=("pose", "force"))
    assert [phase.kind for phase in m.phases] == ["slipping", "rolling"]
    slips = m.t < m.phases[-1].time
    assert np.ptp(m.friction[slips]) < 1e-12 and np.hypot(*m.slip[~slips].T).max() < 1e-12
    away = m.centre[:, 1] - m.centre[0, 1]
    assert away.max() > 2 and abs(away[-1]) < 0.1 * away.max() and away.argmax() < slips.sum()


def test_a_tippe_top_turns_over_on_a_wet_table_and_faster_on_a_patch_and_stays_down_on_a_point():
    says(
        tippe_top_turns, "turns over on a wet table", "soon rolls and stays down", "and faster than on the wet table",
        "keeps Jellett's number constant, and the couple of the patch reduces it a little",
    )  # fmt: skip
    scene, over, number = tippe_top_turns, {}, {}
    for table in (scene.wet, scene.patch, scene.dry):
        m = sc.roll(scene.body, scene.start, scene.t, contact=table)
        over[table] = m.t[np.argmax(m.theta > 3.0)] if m.theta.max() > 3.0 else np.inf
        j = scene.jellett(m)
        number[table] = np.abs(j / j[0] - 1)[m.t <= min(over[table], scene.t[-1])].max()
    assert over[scene.patch] < 0.9 * over[scene.wet] < np.inf == over[scene.dry]
    assert number[scene.wet] < 1e-9 and number[scene.dry] < 1e-9 and 0.02 < number[scene.patch] < 0.15
    m = sc.roll(scene.body, scene.start, scene.t, contact=scene.dry)
    assert m.phases[-1].kind == "rolling" and scene.scale.seconds(m.phases[-1].time) < 0.1
    assert np.degrees(m.theta.max()) < 10


def test_the_spin_of_a_billiard_ball_outlasts_its_way_on_a_small_patch_and_not_on_a_wide_one():
    says(
        billiard, "slides for 0.3 s, and its spin hardly falls", "Then the ball rolls with a small creep",
        "stops before the spin has ended, on a wide patch long after",
    )  # fmt: skip
    for patch in (billiard.SMALL, billiard.WIDE):
        found = billiard.shot(patch)
        assert found.slides == pytest.approx(0.3, abs=0.02)
        sliding = found.motion.t < found.slides
        assert found.motion.drilling[sliding].min() > 0.99 * billiard.SIDE
        middle = (found.motion.t > found.slides + 1) & (found.motion.t < 0.3 * found.ends)
        assert 0.01 < found.motion.creep[middle].mean() < 0.1
        assert (found.ends > found.stands) == (patch == billiard.SMALL)
    assert found.stands > 2 * found.ends


def test_a_pencil_slips_backwards_below_a_coefficient_and_forwards_above():
    says(
        falling_pencil,
        "backwards on a slippery table and forwards on a rough one",
        "0.3706 separates the two",
    )
    scene = falling_pencil
    for mu, way in ((0.1, "backwards"), (0.3704, "backwards"), (0.3708, "forwards"), (1.0, "forwards")):
        assert scene.way(sc.roll(scene.body, scene.start, scene.t, contact=sc.Coulomb(mu))) == way, mu
    m = sc.roll(scene.body, scene.start, scene.t, want="force")
    lean = m.theta - float(scene.body.theta_balance)
    early = np.cos(lean) > 0.68  # the closed form of a thin rod, before the normal force comes near 0
    normal, friction = scene.law(lean[early], lean[0])
    assert (
        np.abs(m.friction[early] - np.abs(friction)).max() < 2e-3
        and np.abs(m.normal[early] - normal).max() < 2e-3
    )


def test_a_cup_rolls_round_its_apex_to_rest_as_a_closed_form_says_and_too_fast_it_slides_outwards():
    says(
        rolled_cup, "goes round its apex in a circle", "at a time and place that a closed form gives",
        "pushed too fast for the friction first slides outwards, and its bottom may rise",
    )  # fmt: skip
    scene = rolled_cup
    for speed, slides, rises in (
        (0.5, False, False),
        (1.1, False, False),
        (1.25, True, False),
        (1.4, True, True),
    ):
        rate = scene.rate_of(speed)
        how = {"contact": scene.table, "restitution": 0.0, "losses": scene.LOSS, "want": "pose"}
        m = sc.roll(scene.body, scene.pushed(rate), scene.t, **how)
        assert (m.phases[0].kind == "lying") == slides and (m.theta.max() > scene.lies + 0.1) == rises
        assert m.status == sc.Ending.STOPS and m.phases[-1].kind == "rolling round its apex"
        far = [np.hypot(*way.T) for way in scene.contacts(m)]
        if slides:
            assert far[1].max() > 1.05 * far[1][0]
            continue
        time, rounds = scene.law(rate)
        assert m.event.time == pytest.approx(time, rel=1e-12)
        assert m.phi[-1] / (2 * np.pi) == pytest.approx(rounds, rel=1e-4)  # the last output is before the end
        r, wide = scene.body.circles[:, 0]
        for way, radius in zip(far, (r, wide), strict=True):
            known = 100 * scene.scale.metres(radius * scene.body.spans[0] / (wide - r))
            assert way == pytest.approx(known, rel=1e-9)


def test_a_bottle_tips_rocks_infinitely_often_and_rolls_round_less_far_the_better_it_bounces():
    says(
        tipped_bottle, "infinitely often in a quarter of a second", "rolls round its apex until it rests",
        "bounces better loses more energy in its impacts, and rolls less far",
    )  # fmt: skip
    lost, far = [], []
    for bounces in (0.0, tipped_bottle.RESTITUTION, 0.8):
        m = tipped_bottle.tipped(bounces)
        last = m.phases[-1]
        assert m.status == sc.Ending.STOPS and last.kind == "rolling round its apex"
        if bounces == tipped_bottle.RESTITUTION:
            rocks = tipped_bottle.scale.seconds(last.time - m.impacts[0].time)
            assert rocks == pytest.approx(0.25, abs=0.02)
            assert len(m.impacts) > 100 and any(impact.stays for impact in m.impacts)
            assert {impact.rim for impact in m.impacts} >= {"first", "other"}
        lost.append(m.lost_in_impacts[-1])
        far.append(np.ptp(m.phi[m.t > last.time]))
    assert (np.diff(lost) > 0).all() and (np.diff(far) < 0).all()


def test_a_puck_slides_farther_with_a_spin_and_its_whole_face_ends_both_in_one_ratio():
    says(
        sliding_puck, "A puck that spins faster slides farther", "ratio 0.655, for any push",
        "If only its rim presses, the spin fades first",
    )  # fmt: skip
    rim, whole = sliding_puck.TABLES.values()
    for table in (rim, whole):
        far = [sliding_puck.cm(sliding_puck.pushed(turns, table))[-1, 0] for turns in sliding_puck.SPINS]
        assert (np.diff(far) > 0).all()
        assert far[0] == pytest.approx(100 / (2 * 0.2 * 9.80665), rel=1e-6)  # v^2/(2 mu g), in cm
    for turns in sliding_puck.SPINS[1:]:
        for table, least, most in ((whole, 0.65, 0.66), (rim, 3.0, np.inf)):
            m = sliding_puck.pushed(turns, table)
            slide = np.hypot(*sliding_puck.body.centre_velocity(m.states))[-1]
            assert least < slide / m.w[-1, 2] < most


def test_a_can_topples_only_with_enough_friction_and_speed_and_a_fast_spin_keeps_it_down():
    says(
        pushed_can, "topples if the friction is strong enough", "only tips, and rocks to rest",
        "A fast spin keeps the can on its face",
    )  # fmt: skip
    for mu, speed, turns, low, high in (
        (0.49, 3.0, 0.0, 0.0, 0.0), (0.55, 0.6, 0.0, 1.0, 10.0), (0.55, 1.0, 0.0, 89.0, 91.0), (0.55, 1.0, 5.0, 0.0, 0.0),
    ):  # fmt: skip
        m = pushed_can.pushed(speed, turns, sc.Coulomb(mu))
        assert low <= np.degrees(m.theta.max()) <= high, (mu, speed, turns)


def test_the_shape_wins_a_race_and_where_all_slip_they_arrive_at_the_same_time():
    says(
        race_downhill, "a solid ball is first, then a disk, a hollow ball, and last a hoop",
        "If all four bodies slip, they arrive at the same time",
    )  # fmt: skip
    times = [race_downhill.arrival(race_downhill.race(name, 10.0, 0.3)) for name in race_downhill.runners]
    assert (np.diff(times) > 0.03).all()
    steep = [race_downhill.arrival(race_downhill.race(name, 60.0, 0.3)) for name in race_downhill.runners]
    assert np.ptp(steep) < 1e-6
    # v^2 = 2 g s (sin - mu cos)
    pull = 9.80665 * (np.sin(np.pi / 3) - 0.3 * np.cos(np.pi / 3))
    assert steep[0] == pytest.approx(np.sqrt(2 / pull), abs=1e-4)


def test_a_ball_on_a_turntable_goes_round_at_two_sevenths_of_its_rate_and_a_hollow_one_at_two_fifths():
    says(
        turntable, "at two sevenths of the rate of the table, and a hollow ball at two fifths",
        "The circle drifts across",
    )  # fmt: skip
    turn = 2 * np.pi * turntable.second / turntable.rate
    for body, share in ((turntable.body, 2 / 7), (turntable.hollow, 2 / 5)):
        for speed in (0.0, 0.5):
            once = turntable.once_round(turntable.rolled(body, speed))
            assert turn / once == pytest.approx(share, abs=1e-4)
    m = turntable.rolled(turntable.body, 0.2, np.radians(0.5))
    down, across, _ = (m.centre[-1] - m.centre[1500]) * turntable.metre
    assert abs(down) < 1e-3 * across


def test_a_rattleback_turns_back_and_the_other_way_takes_more_than_four_times_as_long():
    says(
        rattleback,
        "spun clockwise soon rocks from end to end and turns back",
        "spins on more than four times as long",
    )
    times = []
    for way, spin, _ in rattleback.WAYS:
        m = sc.roll(rattleback.body, rattleback.spun(spin), rattleback.t)
        assert (spin < 0) == (way == "clockwise")
        times.append(m.t[np.argmax(m.spin * spin < 0)])
        assert rattleback.grows(m, rattleback.law(spin).axis) == pytest.approx(
            rattleback.law(spin).growth, rel=0.01
        )
    assert times[1] > 4 * times[0] > 0


def test_an_egg_spun_fast_rises_and_one_spun_slowly_rolls_at_once_and_stays_on_its_side():
    says(
        rising_egg,
        "slips and rises until it rolls on its end",
        "more slowly rolls at once and stays on its side",
    )
    for turns, rises in ((10.0, False), (13.0, False), (18.0, True), (22.0, True)):
        m = sc.roll(rising_egg.body, rising_egg.lying(turns), rising_egg.t, contact=rising_egg.table)
        assert m.phases[-1].kind == "rolling" and (m.phases[-1].time < 0.1) != rises
        last = np.degrees(m.theta[m.t > 2.5])
        assert last.max() < 10 if rises else last.min() > 80
