"""A film from above frame by frame: inclination, precession and centre with errors, beside a motion."""

import pickle
import warnings

import numpy as np
import pytest

import spincyl as sc

TUBE = sc.measured(outer_diameter="60mm", inner_diameter="54mm", length="360mm")
NAMES = ("theta", "precession", "x", "y")
PIXEL = 0.5e-3  # metres


def nodding(seconds, rolls="0.5mm", start=1.25, kick=0.0):
    """A tube that rolls on a circle while its inclination changes slowly."""
    t = np.asarray(seconds)
    state = TUBE.steady(start).kicked(kick)
    losses = None if rolls is None else sc.loss.DryContour.from_si(rolls, scale=TUBE)
    return sc.roll(TUBE, state, t, losses=losses, want="pose")


def marked(m, noise=PIXEL, seed=1, gap=True, turned=0.7, at=(0.12, -0.05), mirrored=False, height=np.inf):
    """Marks at both ends, as a camera at a height sees them; positions straight from the orientation."""
    rng = np.random.default_rng(seed)
    half = TUBE.scale.metres(TUBE.ell)
    ends = {}
    for name, side in (("O", 1), ("X", -1)):
        x, y, z, w = m.orientation.T  # the axis of the tube is the image of (0, 0, 1)
        axis = np.column_stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x**2 + y**2)])
        place = m.centre + side * half * axis
        seen = (place[:, 0] + 1j * place[:, 1]) * np.exp(1j * turned) + complex(*at)
        seen = seen / (1 - place[:, 2] / height)
        seen = seen.conj() if mirrored else seen
        x, y = (part + rng.normal(0, noise, m.t.size) for part in (seen.real, seen.imag))
        if gap:
            x[9:12] = y[9:12] = np.nan
        ends[name] = {"t": m.t, "x": x, "y": y}
    return ends


def read(m, **how):
    """The film of a motion; the tube slows down, so it is never quite in one steady state."""
    more = {k: how.pop(k) for k in ("mark_err", "window", "ruler") if k in how}
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="the tube was seen|also .* look the same")
        return sc.data.from_above(marked(m, **how), TUBE, **more)


FRAMES = np.arange(60) / 30


def test_the_errors_of_single_frames_are_those_of_many_films():
    m, given, guessed = nodding(FRAMES), [], []
    for seed in range(40):
        given.append([*sc.data.compare(m, read(m, seed=seed, mark_err=PIXEL)).chi2.values()])
        guessed.append([*sc.data.compare(m, read(m, seed=seed)).chi2.values()])
    # chi2 of one film has a standard deviation of about 0.2, 0.3 and 0.15
    assert np.abs(np.mean(given, axis=0) - 1) == pytest.approx(0, abs=0.12)
    # an error estimated from about fifty differences that share frames is uncertain by a fifth
    assert np.abs(np.mean(guessed, axis=0) - 1) == pytest.approx(0, abs=0.25)


def test_a_film_without_noise_gives_the_motion_itself():
    m = nodding(np.arange(240) / 240)
    film = read(m, noise=1e-9, gap=False, turned=0.0, at=(0.0, 0.0))
    units = {"t": "s", "theta": "rad", "precession": "rad/s", "x": "m", "y": "m"}
    assert film.frames.units == units and film.t == pytest.approx(m.t)
    assert film.frames["theta"] == pytest.approx(m.theta, abs=1e-6)
    assert film.frames["x"] == pytest.approx(m.centre[:, 0], abs=1e-8)
    assert film.frames["y"] == pytest.approx(m.centre[:, 1], abs=1e-8)
    # the nutation lasts 62 frames, and the slope over five of them follows it
    rate = film.frames["precession"]
    assert rate[2:-2] == pytest.approx(m.states.precession[2:-2] / TUBE.scale.seconds(1.0), rel=1e-3)


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_path_is_brought_into_the_film_however_the_camera_is_turned(mirrored):
    m = nodding(FRAMES)
    c = sc.data.compare(m, read(m, mirrored=mirrored))
    assert c.mirrored is mirrored
    sign = -1 if mirrored else 1
    assert c.phi0 == pytest.approx(sign * 0.7, abs=2e-3)
    assert c.place == pytest.approx((0.12, sign * -0.05), abs=5e-4)
    # with the ends exchanged the direction is opposite, and the path of the centre is the same
    ends = marked(m, mirrored=mirrored)
    with warnings.catch_warnings(action="ignore"):
        other = sc.data.from_above({"O": ends["X"], "X": ends["O"]}, TUBE)
    again = sc.data.compare(m, other)
    assert again.phi0 == pytest.approx(c.phi0, abs=1e-9) and again.place == pytest.approx(c.place)


def test_another_motion_is_many_errors_away_and_says_in_what():
    true = nodding(FRAMES)
    film = read(true)
    assert all(x < 2 for x in sc.data.compare(true, film).chi2.values())
    steady = sc.data.compare(nodding(FRAMES, rolls=None), film)
    assert steady.chi2["precession"] > 100 and steady.chi2["theta"] > 2
    steeper = sc.data.compare(nodding(FRAMES, start=1.27), film)
    assert steeper.chi2["theta"] > 5 and np.nanmean(steeper.residual["theta"]) < -0.01
    wide = sc.data.compare(nodding(FRAMES, kick=0.1), film)
    assert wide.chi2["centre"] > 5
    report = steady.report()
    assert "57 of 57" in report and "precession" in report and "errors" in report
    assert repr(steady).startswith("<FilmComparison: 57 frames; chi2 of theta")


def test_frames_give_the_friction_of_a_film_by_fit_motion():
    true = nodding(FRAMES, rolls="0.5mm")
    film = read(true, mark_err=PIXEL, turned=0.0)
    guess = nodding(FRAMES, rolls="0.3mm")
    found = sc.data.fit_motion(guess, film.frames, free=["DryContour", "x", "y"], errors=film.errors)
    off = abs(found.values["DryContour"] - 0.5)
    assert off < 3 * found.errors["DryContour"] < 0.05
    assert found.values["x"] == pytest.approx(0.12, abs=1e-3)
    # a precession without an error, as beside a gap, has to be missing
    gap = marked(true, turned=0.0)
    gap["O"]["x"][20:27] = np.nan
    with warnings.catch_warnings(action="ignore"):
        lost = sc.data.from_above(gap, TUBE, mark_err=PIXEL)
    assert np.isnan(lost.errors["precession"]).any()
    again = sc.data.fit_motion(guess, lost.frames, free=["DryContour", "x", "y"], errors=lost.errors)
    assert abs(again.values["DryContour"] - 0.5) < 3 * again.errors["DryContour"]
    seen = lost.frames | {"precession": np.nan_to_num(lost.frames["precession"])}
    with pytest.raises(ValueError, match=r"errors\['precession'\]: expected positive"):
        sc.data.fit_motion(guess, dict(seen), free=["DryContour"], errors=lost.errors)


def test_the_precession_of_a_tube_that_nods_is_fitted_as_a_slope_over_the_same_frames():
    # a nod lasts nine frames, and the slope over five of them is far from the value of the moment
    true = {"w2": TUBE.steady(1.25).kicked(0.05).in_si(TUBE)["w2"], "DryContour": 0.5}
    seen = nodding(FRAMES, kick=0.05)
    free = ["theta", "w1", "w2", "DryContour"]
    for seed in range(4):
        film = read(seen, seed=seed, mark_err=PIXEL, gap=seed < 2)
        # a dict of some columns, of some rows, in any order
        rows = np.random.default_rng(seed).permutation(film.t.size)[: None if seed % 2 else 45]
        table = {name: film.frames[name][rows] for name in ("t", "theta", "precession")}
        errors = {name: film.errors[name][rows] for name in ("theta", "precession")}
        found = sc.data.fit_motion(seen, table, free=free, errors=errors)
        assert 0.6 < found.chi2 < 1.6
        for name, value in true.items():
            assert abs(found.values[name] - value) < 3 * found.errors[name] < 0.2 * abs(value), (seed, name)
    # the same numbers taken for values of the moment
    plain = table | {"precession": np.asarray(table["precession"])}
    wrong = sc.data.fit_motion(seen, plain, free=free, errors=errors)
    assert abs(wrong.values["w2"] - true["w2"]) > 8 * wrong.errors["w2"]


def test_errors_of_slopes_that_share_frames_are_those_of_many_films():
    seen, pulls = nodding(FRAMES, rolls=None, kick=0.05), []
    w2 = seen.start.in_si(TUBE)["w2"]
    for seed in range(30):
        film = read(seen, seed=seed, mark_err=PIXEL, gap=False)
        table = {name: film.frames[name] for name in ("t", "precession")}
        found = sc.data.fit_motion(seen, table, free=["w2"], errors={"precession": film.errors["precession"]})
        pulls.append((found.values["w2"] - w2) / found.errors["w2"])
    # the error of the root of the mean square of 30 numbers is 0.13; without the correlation it is 0.46
    assert np.sqrt(np.mean(np.square(pulls))) == pytest.approx(1, abs=0.35)


def test_slopes_know_their_frames_and_refuse_other_times():
    film = read(nodding(FRAMES), mark_err=PIXEL)
    table = {name: film.frames[name] for name in ("t", "precession")}
    guess, free = nodding(FRAMES, rolls="0.3mm"), ["DryContour"]
    errors = {"precession": film.errors["precession"]}
    found = sc.data.fit_motion(guess, table, free=free, errors=errors)
    kept = table | {"precession": pickle.loads(pickle.dumps(table["precession"]))}
    assert sc.data.fit_motion(guess, kept, free=free, errors=errors).values == found.values
    late = nodding(FRAMES + 0.25, rolls="0.3mm")  # the same film by another clock
    moved = sc.data.fit_motion(late, table | {"t": table["t"] + 0.25}, free=free, errors=errors)
    assert moved.values["DryContour"] == pytest.approx(found.values["DryContour"], rel=1e-6)
    with pytest.raises(ValueError, match="measured: 'precession' is a slope over several frames"):
        sc.data.fit_motion(guess, table | {"t": table["t"] ** 1.1}, free=free, errors=errors)


def test_a_long_gap_has_no_precession_and_a_wild_mark_does_not_change_the_errors():
    m = nodding(FRAMES)
    ends = marked(m, gap=False)
    for axis in "xy":
        ends["O"][axis][20:27] = np.nan
    with warnings.catch_warnings(action="ignore"):
        film = sc.data.from_above(ends, TUBE)
        plain = sc.data.from_above(marked(m, gap=False), TUBE)
        ends["O"]["x"][40] += 0.02
        wild = sc.data.from_above(ends, TUBE)
    lost = film.t[np.isnan(film.frames["precession"])]
    assert lost.size and (np.abs(lost - 23 / 30) <= 5.1 / 30).all()
    assert film.errors["x"][0] == pytest.approx(plain.errors["x"][0], rel=0.3)
    assert wild.errors["x"][0] == pytest.approx(plain.errors["x"][0], rel=0.3)
    # the wild mark itself is many errors away, and those around it are not
    far = np.abs(sc.data.compare(m, wild).away["x"])
    assert wild.t[far.argmax()] == pytest.approx(40 / 30) and far.max() > 10 > 4 > np.sort(far)[-2]


def test_a_window_of_more_frames_has_a_smaller_error_of_the_precession_and_a_ruler_adds_to_theta():
    m = nodding(FRAMES)
    few, many = (read(m, window=k, mark_err=PIXEL).errors["precession"][30] for k in (5, 9))
    assert few / many == pytest.approx(np.sqrt(60 / 10), rel=0.02)  # sums of the squares of the steps
    plain, ruled = (read(m, ruler=k, mark_err=PIXEL).errors["theta"][30] for k in (0.0, 0.01))
    assert ruled > 3 * plain and ruled == pytest.approx(0.01 * np.tan(1.255), rel=0.15)


def test_a_near_camera_makes_the_line_longer_by_the_height_of_the_centre_over_its_distance():
    m = nodding(FRAMES)
    far, near = (read(m, noise=1e-9, gap=False, at=(0, 0), height=h) for h in (np.inf, 10.0))
    share = float(np.mean(near.line / far.line)) - 1
    assert share == pytest.approx(float(m.centre[:, 2].mean()) / 10.0, rel=0.1)


def test_what_cannot_be_compared_is_refused_by_its_name():
    m = nodding(FRAMES)
    film = read(m)
    for call, said in (
        (lambda: sc.data.compare(TUBE, film), "body: expected a Motion"),
        (lambda: sc.data.compare(m, 1.2), "theta: expected a film"),
        (lambda: sc.data.compare(m, film, rate=1.0), "rate: leave it out"),
        (lambda: sc.data.compare(m, film, common=0.1), "common: leave it out"),
    ):
        with pytest.raises(TypeError, match=said):
            call()
    late = sc.roll(TUBE, TUBE.steady(1.25), np.array([5.0, 6.0]))
    with pytest.raises(ValueError, match="theta: the film ends at 1.967 s, before"):
        sc.data.compare(late, film)
    short = read(nodding(FRAMES[:5]), gap=False)
    with pytest.raises(ValueError, match="theta: the errors of the marks cannot be estimated from 5 frames"):
        sc.data.compare(m, short)
    with pytest.raises(ValueError, match="mark_err = -1"):
        sc.data.from_above(marked(m), TUBE, mark_err=-1)
    with pytest.raises(ValueError, match="window = 2: expected a whole number from 3"):
        sc.data.from_above(marked(m), TUBE, window=2)


def test_frames_before_and_after_the_motion_are_left_out():
    film = read(nodding(FRAMES))
    late = sc.roll(TUBE, TUBE.steady(1.25), np.array([0.5, 2.0]), t0=0.5)
    c = sc.data.compare(late, film)
    seen = np.isfinite(c.computed["theta"])
    assert np.array_equal(seen, film.t >= 0.5 - 1e-9) and np.isnan(c.away["x"][~seen]).all()


def test_the_plot_has_the_measured_values_with_their_bars_and_the_motion_as_lines():
    plt = pytest.importorskip("matplotlib.pyplot")
    m = nodding(FRAMES)
    film = read(m)
    axes = film.plot()
    assert [len(ax.containers) for ax in axes] == [1, 1, 2]
    assert not axes[0].get_title() and "rad/s" in axes[1].get_ylabel()
    c = sc.data.compare(m, film)
    drawn = c.plot(axes)
    lines = {line.get_label(): line for ax in drawn for line in ax.get_lines()}
    assert lines["y, computed"].get_ydata() == pytest.approx(1e3 * c.computed["y"], nan_ok=True)
    bars = drawn[1].containers[0].lines[2][0].get_segments()
    whole = np.flatnonzero(np.isfinite(film.errors["precession"]))
    assert np.ptp(bars[whole[5]][:, 1]) == pytest.approx(2 * film.errors["precession"][whole[5]])
    assert f"{c.chi2['theta']:.3g}" in drawn[0].get_title()
    with pytest.raises(TypeError, match="found: expected a Filmed"):
        sc.plot.film(m)
    plt.close("all")
