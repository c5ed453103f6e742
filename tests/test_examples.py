"""The scenes of examples/: each has a body, a start, times and a sentence about its physics, which holds."""

import ast
import importlib
import pathlib
import runpy

import critical_aspect
import eulers_disk
import eulers_disk_stops
import hurricane_balls
import near_steady_tube
import numpy as np
import nutating_cylinder
import pytest
import rattleback
import rising_egg
import rocking_can
import slow_saddle
import tippe_top

import spincyl as sc

FOLDER = pathlib.Path(__file__).parents[1] / "examples"
SCENES = [p.stem for p in sorted(FOLDER.glob("*.py")) if "\nstart = " in p.read_text("utf-8")]


def rolled(scene, **how):
    return sc.roll(scene.body, scene.start, scene.t, **how)


def test_there_are_twenty_five_scenes():
    assert len(SCENES) == 25


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_opens_with_one_sentence_and_prints_only_if_it_is_run(name, capsys):
    scene = importlib.import_module(name)
    assert isinstance(scene.body, sc.Body | sc.Ellipsoid)
    assert isinstance(scene.start, sc.State | sc.EllipsoidState)
    assert scene.t[0] == 0 and (np.diff(scene.t) > 0).all()
    said = ast.get_docstring(ast.parse((FOLDER / f"{name}.py").read_text("utf-8")))
    assert said.endswith(".") and said.count(". ") == 0 and len(said) > 60
    capsys.readouterr()
    runpy.run_path(str(FOLDER / f"{name}.py"), run_name="scene")
    assert capsys.readouterr().out == ""
    runpy.run_path(str(FOLDER / f"{name}.py"), run_name="__main__")
    assert len(capsys.readouterr().out.splitlines()) >= 2


def test_a_pushed_cylinder_returns_after_every_period():
    period = sc.swing(nutating_cylinder.body, nutating_cylinder.start).period
    later = sc.roll(nutating_cylinder.body, nutating_cylinder.start, 4 * period)
    assert later.theta[-1] == pytest.approx(nutating_cylinder.start.theta, abs=1e-12)


def test_a_pushed_tube_still_shows_about_six_letters():
    m = rolled(near_steady_tube, want="pose")
    assert m.status == sc.Ending.DONE and abs(m.psi[-1] / m.phi[-1]) == pytest.approx(6, abs=0.2)


def test_the_contact_of_eulers_disk_runs_round_faster_than_its_face_turns():
    m = rolled(eulers_disk, want="pose")
    assert eulers_disk.body.fillet > 0 and m.phi[-1] > 10 * abs(m.phi[-1] + m.psi[-1])


def test_a_rocking_can_goes_on_by_nearly_the_angle_of_no_turning():
    body = rocking_can.body
    limit = np.pi * np.sqrt((body.i1 + body.ell**2 + 1) / (body.i1 + body.ell**2))
    assert sc.swing(body, rocking_can.start).precession_per_period == pytest.approx(limit, rel=4e-3)


def test_a_critical_cylinder_lasts_above_a_rate_that_depends_on_the_table():
    for contact, least in critical_aspect.LEAST.items():
        below, above = (critical_aspect.turning(x * least) for x in (1 - 1e-9, 1 + 1e-9))
        assert not critical_aspect.body.stable(below, contact) and critical_aspect.body.stable(above, contact)
    assert np.ptp(rolled(critical_aspect).theta) < 0.1


def test_a_thousandth_of_the_push_delays_the_departure_by_the_growth_rate():
    (late, down), (early, up) = slow_saddle.departure(-1e-9), slow_saddle.departure(1e-6)
    assert up and not down
    growth = slow_saddle.body.growth_rate(np.radians(20))
    assert late - slow_saddle.departure(-1e-6)[0] == pytest.approx(np.log(1000) / growth, abs=0.15)
    assert early < late


def test_two_balls_spin_once_a_turn():
    m = rolled(hurricane_balls, want="pose")
    assert (
        m.psi[-1] == pytest.approx(m.phi[-1], rel=1e-3) and m.theta.min() > hurricane_balls.body.theta_limit
    )


def test_a_tippe_top_that_rolls_does_not_turn_over():
    m = rolled(tippe_top)
    assert m.status == sc.Ending.DONE and np.ptp(m.theta) < 1e-3


@pytest.mark.parametrize("law", eulers_disk_stops.LAWS)
def test_eulers_disk_stops_when_it_is_to_and_later_if_it_never_slips(law):
    losses = eulers_disk_stops.lasting(law, 300.0)
    slow = sc.drift(eulers_disk_stops.body, eulers_disk_stops.start.theta, losses)
    assert slow.stops_at == pytest.approx(300.0, rel=1e-11)
    m = rolled(eulers_disk_stops, losses=losses)
    never_slips = sc.drift(eulers_disk_stops.body, eulers_disk_stops.start.theta, losses, centre="rolling")
    assert m.event.ending in (sc.Ending.STOPS, sc.Ending.FACE) and m.event.time > 1.03 * slow.stops_at
    assert m.event.time == pytest.approx(never_slips.stops_at, rel=2e-3)
    assert np.ptp(m.energy + m.work_lost) < 1e-12 and m.work_lost[-1] > 0.3


def test_one_second_before_the_end_a_dry_whirr_is_the_fastest():
    rates = []
    for law in eulers_disk_stops.LAWS:
        losses = eulers_disk_stops.lasting(law, 1500.0)
        slow = sc.drift(eulers_disk_stops.body, eulers_disk_stops.start.theta, losses)
        rates.append(float(slow.precession(slow.stops_at - 16.0)))
    assert rates[0] > 1.1 * rates[1] > 1.1 * 1.05 * rates[2]


@pytest.mark.parametrize("spin", [-5.0, 5.0])
def test_a_rattleback_turns_back_because_the_rocking_grows_that_the_eigenvalue_says(spin):
    m, law = sc.roll(rattleback.body, rattleback.spun(spin), rattleback.t), rattleback.law(spin)
    # the nutation also takes a little of the spin
    assert rattleback.grows(m, law.axis) == pytest.approx(law.growth, rel=0.01)
    assert m.spin[0] * m.spin[np.argmax(np.abs(m.spin[1000:])) + 1000] < 0
    times = rattleback.swings(m, law.axis)[0]
    assert np.pi / np.median(np.diff(times[:20])) == pytest.approx(2 * np.pi * law.hertz, rel=0.02)


def test_a_rattleback_turned_the_other_way_in_a_mirror_turns_back_the_other_way():
    given = [
        np.asarray(x) for x in (rattleback.body.semi_axes, rattleback.body.moments, rattleback.body.offset)
    ]
    mirrored = sc.Ellipsoid.rattleback(given[0], twist=np.radians(-2), moments=given[1], offset=given[2])
    spins = np.array([-0.4, 0.4])
    there, here = mirrored.growth_rates(spins), rattleback.body.growth_rates(-spins)
    np.testing.assert_allclose(there, here, rtol=1e-9)


def test_an_egg_rises_where_it_slips_and_jelletts_number_says_how_fast_it_then_spins():
    m = rolled(rising_egg, contact=rising_egg.table)
    assert [phase.kind for phase in m.phases] == ["slipping", "rolling"]
    assert np.degrees(m.theta[0]) > 84 and np.degrees(m.theta[-1]) < 9
    assert np.abs(rising_egg.jellett(m) - 1).max() < 0.01
    assert m.spin[-1] / m.spin[0] == pytest.approx(rising_egg.standing(), rel=0.01)
    assert np.ptp(m.energy + m.dissipated) < 1e-9 * m.energy[0] and m.dissipated[-1] > 0.1 * m.energy[0]


def test_an_egg_starts_with_its_centre_of_mass_at_rest():
    m = sc.roll(rising_egg.body, rising_egg.start, [0.0, 1e-6], contact=rising_egg.table, want="pose")
    # in a microsecond friction accelerates the egg to mu g t at most
    assert np.abs(np.diff(m.centre, axis=0)).max() < 1e-11


def test_a_ball_keeps_jelletts_number_exactly():
    ball = sc.Ellipsoid((1.0, 1.0, 1.0), (0.3, 0.3, 0.35), offset=(0.0, 0.0, -0.1))
    state = sc.EllipsoidState((0.6, 0.0, 0.8), (1.0, 2.0, 5.0), slip=(1.0, 0.5))
    m = sc.roll(ball, state, np.linspace(0, 5, 101), contact=sc.Coulomb(0.2))
    towards = m.vertical + np.asarray(ball.offset)
    number = ((m.w @ np.asarray(ball.inertia)) * towards).sum(axis=1)
    assert np.ptp(number) < 1e-11
