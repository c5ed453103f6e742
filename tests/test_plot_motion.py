"""Figures of motions: content, times, ends, and sizes of text."""

import warnings
from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest
from nutating_cylinder import body as CYLINDER
from nutating_cylinder import start as START

import spincyl as sc

mpl.use("agg")
import matplotlib.pyplot as plt


@pytest.fixture(autouse=True)
def closed_figures():
    yield
    plt.close("all")


def test_the_first_figure_of_a_notebook_leaves_it_interactive_and_the_sizes_as_they_were(monkeypatch):
    make, before = plt.subplots, mpl.rcParams["font.size"]

    def first(*args, **kwargs):
        plt.ion()  # as the backend of a notebook does at its first figure
        return make(*args, **kwargs)

    monkeypatch.setattr(plt, "subplots", first)
    plt.ioff()
    try:
        sc.plot.motion(sc.roll(CYLINDER, START, 2.0))
        assert plt.isinteractive() and mpl.rcParams["font.size"] == before
    finally:
        plt.ioff()


def curve(ax, k=0):
    return ax.lines[k].get_xydata().T


@pytest.mark.parametrize("t", [20.0, [0.0, 20.0], np.linspace(0, 20, 7), [0.0, -20.0]])
def test_an_exact_motion_is_drawn_whatever_times_were_asked_for(t):
    m = sc.roll(CYLINDER, START, t)
    tilt, path, force = sc.plot.motion(m)
    last = np.ravel(t)[-1]
    for ax, want, names in ((tilt, (), ("theta",)), (force, "force", ("normal", "friction"))):
        for k, name in enumerate(names):
            time, drawn = curve(ax, k)
            assert (time[0], time[-1]) == (0.0, last)
            there = getattr(m.at(time).wanting(*[want] if want else []), name)
            assert np.allclose(drawn, np.degrees(there) if name == "theta" else there, atol=1e-9)
    # the times are close enough for the nutation: lines between points agree with the motion
    time, drawn = curve(tilt)
    between = np.degrees(m.at((time[1:] + time[:-1]) / 2).theta)
    assert np.abs(between - (drawn[1:] + drawn[:-1]) / 2).max() < 2e-3 * np.ptp(drawn)
    x, y = curve(path)
    assert np.hypot(np.diff(x), np.diff(y)).max() < 0.25


def test_the_picture_of_the_landing_page_shows_a_circle_and_a_weight():
    pipe = sc.Body.tube(6.0, bore=0.8)
    tilt, path, force = sc.plot.motion(sc.roll(pipe, pipe.steady(np.radians(85)), 20.0))
    assert np.allclose(curve(tilt)[1], 85)
    x, y = curve(path)
    assert np.allclose(
        np.hypot(x - np.mean([x.min(), x.max()]), y - np.mean([y.min(), y.max()])), 5.89, atol=0.01
    )
    assert np.allclose(curve(force)[1], 1)


def test_the_moment_in_which_a_rocking_can_is_nearly_flat_is_not_missed():
    can = sc.Body.solid(1.0)
    m = sc.roll(can, sc.State(0.3, 1e-3, 0.0, 0.0), 3.0)
    drawn = curve(sc.plot.motion(m)[2])[1]
    half = 0.5 * sc.swing(can, m.start).period
    peak = m.at(np.linspace(half - 1e-3, half + 1e-3, 20001)).wanting("force").normal.max()
    assert peak > 300
    assert drawn.max() == pytest.approx(peak, rel=0.01)


def test_one_too_long_for_curves_is_drawn_as_dots_that_show_all_of_it():
    period = sc.swing(CYLINDER, START).period
    tilt = sc.plot.motion(sc.roll(CYLINDER, START, 1e5 * period))[0]
    assert tilt.lines[0].get_linestyle() == "None"
    found = sc.swing(CYLINDER, START)
    drawn = curve(tilt)[1]
    assert drawn.min() == pytest.approx(np.degrees(found.theta_min), abs=1e-3)
    assert drawn.max() == pytest.approx(np.degrees(found.theta_max), abs=1e-3)


def test_one_found_by_steps_is_drawn_at_its_own_times_or_refused():
    t = np.linspace(0, 20, 101)
    m = sc.roll(CYLINDER, START, t, step=1e-2)
    time, drawn = curve(sc.plot.motion(m)[0])
    assert np.array_equal(time, t)
    assert np.array_equal(drawn, np.degrees(m.theta))
    with pytest.raises(
        ValueError, match=r"^m: expected at least two times, not 1 time; give roll more times"
    ):
        sc.plot.motion(sc.roll(CYLINDER, START, 20.0, step=1e-2))
    with pytest.raises(ValueError, match="has no duration from t = 20 on"):
        sc.plot.motion(sc.roll(CYLINDER, START, [20.0], t0=20.0))
    with pytest.raises(TypeError, match="m: expected a Motion, not State"):
        sc.plot.motion(START)


@pytest.mark.parametrize("how", [{}, {"step": 1e-3}])
def test_where_a_motion_has_ended_is_grey_and_says_how(how):
    disk = sc.Body.solid(0.375)
    standing = disk.steady(np.radians(80)).kicked(-0.01)
    m = sc.roll(disk, standing, np.linspace(0, 20, 201), contact="smooth", **how)
    tilt, path, force = sc.plot.motion(m)
    for ax in (tilt, force):
        assert ax.get_title().endswith("\nended: it stands on its edge, $t = 12.46$")
        (grey,) = ax.patches
        assert grey.get_extents().transformed(ax.transData.inverted()).x0 == pytest.approx(m.event.time)
        assert grey.get_extents().transformed(ax.transData.inverted()).x1 == pytest.approx(20)
        assert curve(ax)[0].max() <= m.event.time
    assert not path.patches
    for body, start, said in (
        (sc.Body.solid(1.0), sc.State(0.3, 0, 0, 0), "it lies flat, $t = 1.47$"),
        (sc.Body.solid(2.5), sc.State(1.5, 0, -0.5, 0), "it lies on its side"),
    ):
        assert f"ended: {said}" in sc.plot.motion(sc.roll(body, start, 5.0))[0].get_title()
    assert all("ended" not in ax.get_title() for ax in sc.plot.motion(sc.roll(CYLINDER, START, 20.0)))


DRAWN = {
    "branches": lambda ax: sc.plot.branches([0.375, 2.5], ax=ax),
    "portrait": lambda ax: sc.plot.portrait(ax=ax),
    "energy": lambda ax: sc.plot.energy(ax=ax),
    "motion": lambda ax: sc.plot.motion(sc.roll(CYLINDER, START, 5.0), None if ax is None else [ax] * 3)[0],
    "exposure": lambda ax: sc.plot.exposure(sc.roll(CYLINDER, START, 5.0), size=50, samples=1000, ax=ax),
    "comparison": lambda ax: sc.data.compare(CYLINDER, [0.1, 0.2, 1.3], CYLINDER.rate([0.1, 0.2, 1.3])).plot(
        ax
    ),
}


@pytest.mark.parametrize("name", DRAWN)
def test_words_have_the_size_of_the_axes_they_are_drawn_on(name):
    def sizes(ax):
        ax.figure.canvas.draw()
        words = [ax.xaxis.label, ax.yaxis.label, *ax.get_xticklabels(), *ax.get_yticklabels(), *ax.texts]
        return {text.get_fontsize() for text in words}

    with (
        mpl.rc_context({"font.size": 21, "axes.labelsize": 21, "xtick.labelsize": 21, "ytick.labelsize": 21}),
        warnings.catch_warnings(),
    ):
        warnings.simplefilter("ignore")  # such long labels leave a small figure little room
        _, ax = plt.subplots()
        DRAWN[name](ax)
        assert sizes(ax) == {21.0}, "a lecturer's own"
        assert sizes(DRAWN[name](None)) <= {12.0, 13.0}
    assert mpl.rcParams["font.size"] != 13


def slipping(**how):
    pipe = sc.Body.tube(6.0, bore=0.8)
    start = pipe.with_centre_velocity(sc.State(np.pi / 2, 3.0, 0.0, 3.17), 0.0, -6.2)
    return sc.roll(pipe, start, 60.0, contact=sc.Coulomb(0.3), **how)


@pytest.mark.parametrize("how", [{}, {"tol": 1e-9}])
def test_where_a_body_slips_its_path_is_red_and_the_time_tinted(how):
    m = slipping(**how)
    sticks = m.phases[1].time
    tilt, path, force = sc.plot.motion(m)
    assert tilt.get_title() == r"$\mu = 0.3$, $\ell = 6$"
    labels = [line.get_label() for line in path.lines[:3]]
    assert labels == ["contact slips", "contact rolls", "centre, from above"]
    slips, rolls = (np.isfinite(curve(path, k)[0]) for k in (0, 1))
    assert (slips | rolls).all() and (slips & rolls).sum() == 1, (
        "no piece is left out, and none is in two colours"
    )
    for ax in (tilt, force):
        (band,) = ax.patches
        assert (band.get_x(), band.get_x() + band.get_width()) == pytest.approx((0, sticks), abs=1e-7)
    time, drawn = curve(force, 1)
    assert np.allclose(drawn, m.at(time).wanting("force").friction, atol=1e-9)
    assert force.lines[1].get_label() == "friction"


def test_a_wet_table_has_its_law_in_the_title():
    hoop = sc.Body.tube(0.0, bore=1.0)
    m = sc.roll(hoop, sc.State(np.pi / 2, 0.0, 0.0, -3.0, slip=(0.0, 5.0)), 5.0, contact=sc.Viscous(0.25))
    assert sc.plot.motion(m)[0].get_title().startswith(r"viscous, $c = 0.25$")


def test_laws_of_loss_have_the_digits_in_a_title_that_it_has_room_for():
    law = sc.loss.RollingResistance(1e-4 / 7.9375e-3) + sc.loss.AirFilm(1e-7)
    m = sc.roll(CYLINDER, START, 5.0, losses=law)
    title = sc.plot.motion(m)[0].get_title()
    assert title.startswith("rolling, RollingResistance(0.0126) + AirFilm(1e-07), ")


# Stones, and objects that draw themselves.


@pytest.mark.parametrize("contact", ["rolling", sc.Coulomb(0.3)])
@pytest.mark.parametrize("measured", [True, False])
def test_the_motion_of_a_stone_shows_its_spin_beside_its_tilt(measured, contact):
    stone = sc.Ellipsoid.rattleback((0.20, 0.03, 0.02), twist=np.radians(3)).in_metres(mass=0.3)
    end = 3.0
    if not measured:
        stone, end = stone.natural, end / stone.scale.seconds(1.0)
    m = sc.roll(stone, stone.spinning(-1.0, pitch=0.01), [0.0, end], contact=contact)
    tilt, path, force = m.plot()
    (right,) = (ax for ax in tilt.figure.axes if ax not in (tilt, path, force))
    t, spin = right.lines[0].get_data()
    fine = m.at(t[::100])
    assert np.allclose(spin[::100], fine.spin, atol=1e-6 * np.abs(spin).max()) and spin[0] < 0 < spin.max()
    assert np.allclose(tilt.lines[0].get_ydata()[::100], np.degrees(fine.theta), atol=1e-4)
    unit = "rad/s" if measured else r"$\sqrt{g/R}$"
    assert right.get_ylabel() == f"spin about the vertical ({unit})"
    assert force.get_ylabel() == ("force (N)" if measured else "force ($Mg$)")
    plt.close(tilt.figure)


def test_a_rattleback_rocks_between_the_envelopes_that_its_eigenvalue_foretells():
    stone = sc.Ellipsoid.rattleback((0.07, 0.014, 0.012), twist=np.radians(2)).in_metres()
    second, push = stone.scale.seconds(1.0), np.radians(0.02)
    m = sc.roll(stone, stone.spinning(5 * second, pitch=push, roll=push), 6.0)
    tilt, *_ = m.plot()
    assert [text.get_text() for text in tilt.get_legend().get_texts()] == [
        "rocking end to end",
        "rocking side to side",
    ]
    ends, sides = (line.get_data() for line in tilt.lines[1:])
    # spun counterclockwise, the slow rocking from side to side grows
    growth = stone.rocking(5 * second).growth[0] / second
    grown = (sides[0] > 2) & (sides[0] < 5)
    assert np.polyfit(sides[0][grown], np.log(sides[1][grown]), 1)[0] == pytest.approx(growth, rel=0.02)
    for (t, most), axis in ((ends, 0), (sides, 1)):
        fine = sc.roll(stone, m.start, np.linspace(1, 5.5, 20_001), t0=0.0)
        rocked = np.abs(90 - np.degrees(fine.inclinations[:, axis]))
        above = np.interp(fine.t, t, most)
        assert (rocked < 1.01 * above + 2e-3).all()
        # in every half second it comes up to it
        assert (rocked > 0.99 * above)[:-1].reshape(10, -1).any(axis=1).all()
    # an egg that lies does not rock about the upright
    egg = sc.Ellipsoid.egg(0.7, 1.0)
    lying = sc.EllipsoidState([np.sqrt(1 - 0.02**2), 0.0, 0.02], [6.0, 0.0, 0.0])
    m = sc.roll(egg, lying, 5.0, contact=sc.Coulomb(0.1))
    assert len(m.plot()[0].lines) == 1 and m.plot()[0].get_legend() is None
    plt.close("all")


def test_the_distance_of_a_straight_roll_is_the_radius_times_the_angle():
    ball = sc.Body.ball(0.0, 0.4, 0.4, diameter="57mm", mass="170g")
    state = sc.State(np.pi / 2, 0.0, 0.0, -1.5)
    m = ball.roll(state, 2.0, want="pose")
    tilt, path, _ = m.plot()
    t, distance = tilt.lines[0].get_data()
    psi = m.at(t).psi
    assert tilt.get_ylabel() == "distance of the centre (mm)" and path.get_xlabel() == "$x$ (mm)"
    assert np.allclose(distance, 28.5 * np.abs(psi - psi[0]), rtol=1e-9, atol=1e-9) and distance[-1] > 100
    # a hoop with backspin comes back; its closed form: v = v0 - mu g t until the rim is at rest
    hoop = replace(sc.Body.tube(0.0, bore=0.97), scale=sc.Scale(radius=0.45, mass=0.3))
    m = hoop.roll(sc.thrown(hoop, 3.0, "14rad/s"), 1.0, contact=sc.Coulomb(0.4))
    t, distance = (tilt := m.plot()[0]).lines[0].get_data()
    assert np.allclose(distance, 3 * t - 0.4 * sc.Scale.gravity * t**2 / 2, atol=1e-6)
    assert tilt.get_ylabel() == "distance of the centre (m)"
    # a body that stands still, or leans over, has an inclination
    for state in (sc.State(np.pi / 2, 0.0, 0.0, 0.0), sc.State(1.0, 0.3, 0.0, -1.5)):
        assert "inclination" in ball.roll(state, 1.0).plot()[0].get_ylabel()
    plt.close("all")


def test_a_drift_draws_inclination_and_precession_up_to_its_end():
    disk = sc.measured(outer_diameter="75mm", length="12.8mm")
    law = sc.loss.RollingResistance.from_si("0.02mm", scale=disk)
    for found in (sc.drift(disk, 0.3, law), sc.drift(disk.natural, 0.3, law, centre="rolling")):
        ax = found.plot()
        fast = next(other for other in ax.figure.axes if other is not ax)
        t, tilt = ax.lines[0].get_data()
        assert t[-1] == found.stops_at and tilt[-1] == pytest.approx(np.degrees(found.ends_at_theta))
        assert np.allclose(np.radians(tilt[1:300:50]), found.theta(t[1:300:50]))
        unit = 2 * np.pi if found.body.scale else 1.0
        assert np.allclose(fast.lines[0].get_ydata()[1:300:50] * unit, found.precession(t[1:300:50]))
        assert ax.get_xlabel().startswith("time") and "face lands" in ax.get_title()
        plt.close(ax.figure)
    with pytest.raises(ValueError, match="^found: expected a single drift"):
        sc.plot.drift(sc.drift(disk, [0.2, 0.3], law))


def test_what_draws_itself_takes_axes_and_gives_them_back():
    body = sc.Body.solid(2.5)
    m = sc.roll(body, body.steady(1.3).kicked(0.05), 5.0)
    _, axes = plt.subplots(1, 3)
    assert m.plot(axes) == list(axes)
    _, ax = plt.subplots()
    assert sc.drift(sc.Body.solid(0.1), 0.3, sc.loss.ViscousContour(1e-3)).plot(ax) is ax
    plt.close("all")


def test_a_map_of_flicks_has_each_outcome_where_it_is():
    tube = sc.measured(outer_diameter="15.875mm", inner_diameter="12.7mm", length="95.25mm")
    rates, numbers = [8.0, 17.0, 25.0], [1.3, 1.8, 2.9]
    found = sc.sweep.flicks(tube, 5.7, hertz=rates, launch=numbers, contact=sc.Coulomb(0.3))
    ax = sc.plot.flicks(found)
    assert ax.get_xlabel().startswith("turns per second") and ax.get_ylabel().startswith("launch number")
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["lies down", "lifts off"]
    bar = next(other for other in ax.figure.axes if other is not ax)
    assert bar.get_ylabel() == "settles, and rolls after (s)"
    outcome, ends = found["outcome"].values.T, sc.sweep.Outcome
    # each outcome without a time is a colour and its hatching over it
    hatched = [mesh for mesh in ax.collections if mesh.get_hatch()]
    assert len(hatched) == 2
    for mesh, kind in zip(hatched, (ends.LIES_DOWN, ends.LIFTS_OFF), strict=True):
        assert len(mesh.get_paths()) == np.count_nonzero(outcome == kind)
    drawn = [mesh.get_array().reshape(3, 3) for mesh in ax.collections if mesh not in hatched]
    for mesh, kind in zip(drawn, (ends.LIES_DOWN, ends.LIFTS_OFF, ends.SETTLES), strict=True):
        there = ~np.ma.getmaskarray(np.ma.masked_invalid(mesh))
        assert np.array_equal(there, outcome == kind)
    settles = outcome == ends.SETTLES
    assert np.array_equal(drawn[2][settles], found["rolling_time"].values.T[settles])
    plt.close(ax.figure)
    # in any order, with further variables, without any that settles, and with all still slipping at the end
    for other, words in (
        (found.isel(hertz=[2, 0, 1], launch=[1, 2, 0]), ["lies down", "lifts off"]),
        (found.assign(end=found["end"].expand_dims(more=3)), ["lies down", "lifts off"]),
        (found.isel(launch=[2, 2]).assign_coords(launch=[2.9, 3.0]), ["lifts off"]),
        (
            sc.sweep.flicks(tube, "0.01s", hertz=rates, launch=[1.3, 1.8], contact=sc.Coulomb(0.3)),
            ["slips up to the end"],
        ),
        (found.assign(outcome=0 * found["outcome"]), ["none of these"]),
    ):
        ax = sc.plot.flicks(other)
        assert [text.get_text() for text in ax.get_legend().get_texts()] == words
        if set(words) == {"lies down", "lifts off"}:
            again = [mesh.get_array().reshape(3, 3) for mesh in ax.collections if not mesh.get_hatch()]
            assert all(
                map(np.ma.allclose, map(np.ma.masked_invalid, again), map(np.ma.masked_invalid, drawn))
            )
        plt.close(ax.figure)
    for wrong, words in (
        (found.isel(hertz=0), "two dimensions"),
        (found.isel(hertz=[0]), "two dimensions"),
        (found.drop_vars("rolling_time"), "rolling_time"),
    ):
        with pytest.raises(ValueError, match=f"^found: .*{words}"):
            sc.plot.flicks(wrong)


def test_a_whirr_is_computed_a_few_times_for_its_curves_and_not_once_for_each_halving(monkeypatch):
    at, calls = type(sc.roll(CYLINDER, START, 1.0)).at, []
    monkeypatch.setattr(sc.Motion, "at", lambda self, t: calls.append(np.size(t)) or at(self, t))
    coin = sc.Body.solid(0.09)
    whirr = sc.roll(coin, coin.steady(0.3), [0.0, 200.0], losses=sc.loss.RollingResistance(0.02))
    assert whirr.event.ending == sc.Ending.FACE
    tilt, _, _ = sc.plot.motion(whirr)
    assert len(calls) <= 4
    theta = curve(tilt)[1]
    assert np.abs(np.diff(theta)).max() < 2.0, "degrees between two points of the curve"
