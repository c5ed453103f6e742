"""The lab: a film from above, measured rates with a common factor, and reports."""

import warnings

import numpy as np
import pytest

import spincyl as sc

INCH = 25.4e-3
TUBE = sc.Body.from_metres(outer_diameter=0.625 * INCH, inner_diameter=0.5 * INCH, length=3.75 * INCH)
SCALE = sc.Scale(radius=0.3125 * INCH)
CYLINDER = sc.Body.solid(2.5)
STEEP = float(np.radians(80.0))
TURNS = float(SCALE.hertz(TUBE, TUBE.rate(STEEP)))


def test_the_examples_are_in_the_package_and_a_wrong_name_is_told_which_there_are():
    assert list(sc.data.read_tracker(sc.data.example("tube_from_above"))) == ["O", "X"]
    assert list(sc.data.read_table(sc.data.example("flicks"))) == ["degrees", "hertz"]
    assert next(iter(sc.data.read_table(sc.data.example("spin_down")))) == "seconds"
    assert sc.data.read_sound(sc.data.example("whirr"))[1].size > 60_000
    assert sc.data.read_sound(sc.data.example("bounces"))[1].size > 40_000
    assert list(sc.data.read_table(sc.data.example("class"))) == ["25°", "40°", "60°"]
    for name in ("tube_from_above", "flicks", "spin_down", "whirr"):
        with pytest.raises(ValueError, match=f"expected one of .*'{name}'"):
            sc.data.example("tube")
    with pytest.raises(TypeError, match="name"):
        sc.data.example(None)


# a film from above


def filmed(theta=STEEP, frames=40, noise=0.0, seed=1, hertz=240.0):
    """Tracks of the ends of TUBE in a steady state, in metres and seconds."""
    rng = np.random.default_rng(seed)
    seconds = np.arange(frames) / hertz
    m = sc.roll(TUBE, TUBE.steady(theta), seconds / SCALE.seconds(1.0), want="pose")
    axis = -np.sin(m.theta)[:, None] * np.column_stack([np.cos(m.phi), np.sin(m.phi)])
    places = [SCALE.metres(m.centre[:, :2] + sign * TUBE.ell * axis) for sign in (1, -1)]
    places = [place + rng.normal(0, noise, place.shape) for place in places]
    return {
        name: {"t": seconds, "x": x, "y": y} for name, (x, y) in zip("OX", (p.T for p in places), strict=True)
    }


def changed(tracks, row):
    return {name: {k: row(v) for k, v in columns.items()} for name, columns in tracks.items()}


@pytest.mark.parametrize("degrees", [5.0, 30.0, 80.0, 88.0])
def test_one_call_finds_the_rate_and_the_inclination_of_an_exact_film(degrees):
    if np.isnan(TUBE.rate(np.radians(degrees))):
        degrees = 75.0
    found = sc.data.from_above(filmed(np.radians(degrees)), TUBE)
    assert found.rate == pytest.approx(float(TUBE.rate(np.radians(degrees))), rel=1e-9)
    assert found.theta == pytest.approx(np.radians(degrees), rel=1e-7) == found.predicted
    assert found.hertz == pytest.approx(float(SCALE.hertz(TUBE, found.rate)))


def test_the_example_is_found_within_its_errors():
    found = sc.data.from_above(sc.data.example("tube_from_above"), TUBE)
    assert abs(np.degrees(found.theta) - 83.4) < 2 * np.degrees(found.theta_err) < 1
    assert abs(found.rate - TUBE.rate(np.radians(83.4))) < 3 * found.rate_err
    assert found.unseen == 2 and found.t.size == 32
    report = found.report()
    assert report.startswith("[[Film from above]]") and "+/-" in report and "(steady: 83.40)" in report


def test_the_errors_of_a_film_are_those_of_many_films():
    pulls = []
    for seed in range(60):
        found = sc.data.from_above(filmed(noise=3e-4, seed=seed), TUBE)
        pulls.append(
            [
                (found.rate - TUBE.rate(np.radians(80.0))) / found.rate_err,
                (found.theta - np.radians(80.0)) / found.theta_err,
            ]
        )
    # 60 standard normal numbers: standard errors are 0.09 for the spread and 0.13 for the mean
    assert (np.abs(np.mean(pulls, axis=0)) < 0.45).all()
    assert ((np.std(pulls, axis=0) > 0.6) & (np.std(pulls, axis=0) < 1.4)).all()


def test_rows_in_any_order_rows_that_stand_twice_and_gaps_change_nothing():
    tracks = filmed()
    plain = sc.data.from_above(tracks, TUBE)
    order = np.random.default_rng(2).permutation(np.r_[np.arange(40), 3, 7])
    shuffled = sc.data.from_above(changed(tracks, lambda v: v[order]), TUBE)
    assert shuffled.rate == pytest.approx(plain.rate, rel=1e-12) and shuffled.t.size == 40
    # with a gap of more than half a turn
    cut = np.r_[0:8, 33:40]
    gap = sc.data.from_above(changed(filmed(np.radians(75.0)), lambda v: v[cut]), TUBE)
    assert gap.rate == pytest.approx(float(TUBE.rate(np.radians(75.0))), rel=1e-9)


def test_a_body_of_any_unit_and_tracks_of_any_unit_give_the_same():
    tracks = filmed()
    plain = sc.data.from_above(tracks, TUBE)
    centimetres = {
        name: {"t (ms)": 1e3 * c["t"], "x (cm)": 100 * c["x"], "y [cm]": 100 * c["y"]}
        for name, c in tracks.items()
    }
    general = sc.Body(TUBE.ell, TUBE.i1, TUBE.i3)
    for found in (
        sc.data.from_above(centimetres, TUBE),
        sc.data.from_above(tracks, general, scale=SCALE),
        sc.data.from_above({"left": tracks["O"], "right": tracks["X"]}, TUBE),
        sc.data.from_above(tracks | {"other": tracks["O"]}, TUBE, ends=("X", "O")),
    ):
        assert (found.rate, found.theta) == pytest.approx((plain.rate, plain.theta), rel=1e-9)


def test_a_rounded_tube_is_as_long_as_it_was_measured():
    rounded = sc.Body.from_metres(
        outer_diameter=0.625 * INCH, inner_diameter=0.5 * INCH, length=3.75 * INCH, fillet=1e-3
    )
    assert sc.data.from_above(filmed(), rounded, ruler=0.01).theta == pytest.approx(
        np.radians(80.0), rel=1e-7
    )


def test_frames_too_few_are_counted_in_words():
    tracks = filmed()
    with pytest.raises(ValueError, match="expected at least three frames with both ends, not two"):
        sc.data.from_above(changed(tracks, lambda v: v[:2]), TUBE)
    seen = np.arange(40) < 1
    empty = {
        name: {k: v if k == "t" else np.where(seen, v, np.nan) for k, v in c.items()}
        for name, c in tracks.items()
    }
    with pytest.raises(
        ValueError, match="expected at least three frames with both ends, not one; in 39 rows"
    ):
        sc.data.from_above(empty, TUBE)


def test_what_is_no_film_of_both_ends_is_refused_with_what_would_be_right():
    tracks = filmed()
    twice = {k: {n: np.r_[v, v[:3] + (n != "t") * 0.01] for n, v in c.items()} for k, c in tracks.items()}
    for wrong, said in (
        (({"O": tracks["O"]}, TUBE), r"expected two tracks, not one \('O'\)"),
        (({}, TUBE), "expected two tracks, not none"),
        (({"a": 1, "b": 2, "c": 3}, TUBE), "'a', 'b', 'c'.*ends="),
        (
            ({"O": {"t": [0, 1]}, "X": tracks["X"]}, TUBE),
            r"expected a column 'x' \(or 'X'\); the table has 't'",
        ),
        (
            ({n: {"t": c["t"], "x (px)": c["x"], "y": c["y"]} for n, c in tracks.items()}, TUBE),
            "unit 'px' of the column x",
        ),
        ((changed(tracks, lambda v: 100 * v), TUBE), "times as long as the tube; are x and y in cm"),
        ((changed(tracks, lambda v: v / 0.3048), TUBE), "are x and y in ft"),
        (
            (changed(tracks, lambda v: 1.1 * v), TUBE),
            "times as long as the tube; is the scale of length right",
        ),
        ((changed(tracks, lambda v: 5e4 * v), TUBE), "in pixels"),
        ((changed(tracks, lambda v: 1e-3 * v), TUBE), "is the size of the tube in metres"),
        ((twice, TUBE), "two positions at t = 0"),
        (({"O": tracks["O"], "X": tracks["O"]}, TUBE), "the same place"),
        ((filmed(hertz=TURNS * 2.01, noise=1e-3), TUBE), "film with more frames per second"),
        ((tracks, CYLINDER), "give scale="),
    ):
        with pytest.raises(ValueError, match=said):
            sc.data.from_above(*wrong)
    with pytest.raises(ValueError, match="ends: no track is called 'Z'; expected two of 'O', 'X'"):
        sc.data.from_above(tracks, TUBE, ends=("O", "Z"))
    with pytest.raises(ValueError, match="ruler"):
        sc.data.from_above(tracks, TUBE, ruler=1.0)
    for wrong in ((3, TUBE), (tracks, 2.5), ({"O": 1, "X": 2}, TUBE)):
        with pytest.raises(TypeError):
            sc.data.from_above(*wrong)


def test_a_line_longer_than_the_tube_says_that_the_inclination_is_not_known():
    tracks = changed(filmed(np.radians(88.0)), lambda v: v)
    longer = {n: c | {"x": 1.01 * c["x"], "y": 1.01 * c["y"]} for n, c in tracks.items()}
    with pytest.warns(UserWarning, match="film from the side"):
        found = sc.data.from_above(longer, TUBE)
    assert np.isnan(found.theta) and found.predicted == pytest.approx(np.radians(88.0), rel=1e-6)
    assert "nan" in repr(found) and found.report()


def test_an_uneven_turning_is_warned_of():
    tracks = filmed()
    swapped = {
        name: {k: np.where((np.arange(40) > 20) & (k != "t"), tracks[other][k], c[k]) for k in c}
        for name, other, c in (("O", "X", tracks["O"]), ("X", "O", tracks["X"]))
    }
    with pytest.warns(UserWarning, match="marks were exchanged"):
        sc.data.from_above(swapped, TUBE)


def test_a_film_whose_clock_counts_frames_is_warned_of():
    counting = {n: c | {"t": 240 * c["t"]} for n, c in filmed().items()}
    with pytest.warns(UserWarning, match=r"seen at 80 degrees, .* is t in seconds"):
        sc.data.from_above(counting, TUBE)


FAST = sc.measured(outer_diameter="22mm", length="66mm", wall="1.5mm")


def from_a_phone(turns, fps, noise=2e-4, jitter=0.0, digits=9, frames=60, ruler=1.0, dropped=(), seed=0):
    """Tracks of FAST in its lower steady state, with errors of the positions, of the times and of the scale."""
    rng = np.random.default_rng(seed)
    t = np.delete(np.arange(frames) / fps, list(dropped))
    t = t + rng.uniform(-jitter, jitter, t.size) / fps
    arm = 0.033 * ruler * np.sin(FAST.inclinations(hertz=turns)[1])
    ends = arm * np.exp(2j * np.pi * turns * t) * np.array([[1], [-1]])
    ends = ends + noise * (rng.normal(size=ends.shape) + 1j * rng.normal(size=ends.shape))
    return {
        name: {"t": t.round(digits), "x": z.real, "y": z.imag} for name, z in zip("OX", ends, strict=True)
    }


@pytest.mark.parametrize("turns", [16.0, 18.0, 20.0, 22.0, 24.0, 33.0, 37.0])
@pytest.mark.parametrize("fps", [30.0, 29.97])
def test_a_tube_too_fast_for_the_film_is_told_by_its_inclination(turns, fps):
    """All of them look like 0 to 15 turns a second, whose steady inclinations are at least 56 degrees."""
    with pytest.warns(UserWarning, match=f"{turns:.2g}.* turns a second look the same .* rate is taken"):
        found = sc.data.from_above(from_a_phone(turns, fps, noise=5e-5, frames=150), FAST)
    assert abs(found.hertz - turns) < 4 * found.hertz_err < 0.01
    assert abs(found.theta - found.predicted) < 4 * found.theta_err and not found.aliases.size
    assert np.ptp(found.direction) == pytest.approx(2 * np.pi * turns * np.ptp(found.t), abs=0.1)


@pytest.mark.parametrize("turns", [6.0, 8.0, 13.0])
@pytest.mark.parametrize("dropped", [(), (7, 20, 21, 40)])
def test_a_tube_slow_enough_for_the_film_is_read_as_it_is_whatever_the_clock_writes(turns, dropped):
    for digits in (9, 3):
        found = sc.data.from_above(from_a_phone(turns, 29.97, dropped=dropped, digits=digits), FAST)
        assert abs(found.hertz - turns) < 5 * found.hertz_err + 1e-3 and not found.aliases.size


def test_a_fast_tube_is_told_also_if_frames_are_lost_and_times_are_rounded():
    for digits, dropped in ((9, (7, 20, 21, 40)), (3, ()), (3, (7, 20, 21, 40))):
        with pytest.warns(UserWarning, match="rate is taken"):
            found = sc.data.from_above(from_a_phone(20.0, 29.97, dropped=dropped, digits=digits), FAST)
        assert abs(found.hertz - 20.0) < 5 * found.hertz_err + 1e-3


def test_rates_that_the_inclination_cannot_tell_apart_are_all_named():
    with pytest.warns(
        UserWarning, match=r"also 21\S* or 39\S* or 51\S* turns a second look the same at 30 frames"
    ):
        found = sc.data.from_above(from_a_phone(9.0, 30.0, noise=0.0), FAST, ruler=0.1)
    assert found.hertz == pytest.approx(9.0) and found.aliases[:2] == pytest.approx([21.0, 39.0], rel=1e-6)
    with pytest.warns(
        UserWarning, match=r"steady at .*errors away; 22\S* or 38\S* or 52\S* turns .*more frames per second"
    ):
        found = sc.data.from_above(from_a_phone(22.0, 30.0, noise=0.0), FAST, ruler=0.01)
    assert found.aliases[:2] == pytest.approx([22.0, 38.0], rel=1e-6)


def test_uneven_times_of_the_frames_exclude_the_rates_that_only_look_the_same_in_even_frames():
    tracks = from_a_phone(9.0, 30.0, noise=0.0, jitter=0.2)
    found = sc.data.from_above(tracks, FAST, ruler=0.1)
    assert found.hertz == pytest.approx(9.0) and not found.aliases.size


def test_an_inclination_many_errors_from_every_steady_one_is_warned_of():
    """Three per cent of the scale of length: five degrees, which a flat limit of ten would let pass."""
    tracks = from_a_phone(8.0, 240.0, ruler=0.97)
    with pytest.warns(UserWarning, match=r"steady at 64\.\d degrees, \d+ standard .* does ruler= lack"):
        sc.data.from_above(tracks, FAST)
    assert sc.data.from_above(tracks, FAST, ruler=0.03).hertz == pytest.approx(8.0, rel=1e-3)


# rates with a common factor


def steady(body, rng, noise=0.01):
    edges = sorted([float(body.theta_balance), float(body.theta_limit)])
    theta = np.r_[rng.uniform(0.08, 0.8 * edges[0], 6), rng.uniform(edges[1] + 0.1, 1.5, 10)]
    rate = body.rate(theta)
    return rng.normal(theta, noise), rng.normal(rate, 2 * noise * rate), noise, 2 * noise * rate


def test_a_factor_in_common_is_fitted_and_the_error_of_the_ratio_includes_it():
    pulls = []
    for seed in range(40):
        theta, rate, theta_err, rate_err = steady(CYLINDER, np.random.default_rng(seed))
        errors = {"theta_err": theta_err, "rate_err": rate_err}
        found = sc.data.compare(CYLINDER, theta, 1.03 * rate, **errors, common=np.inf)
        pulls.append(
            [(found.ratio - found.expected) / found.ratio_err, (found.factor - 1.03) / found.factor_err]
        )
    # 40 standard normal numbers: standard errors are 0.11 for the spread and 0.16 for the mean
    assert (np.abs(np.mean(pulls, axis=0)) < 0.55).all()
    assert ((np.std(pulls, axis=0) > 0.65) & (np.std(pulls, axis=0) < 1.4)).all()


def test_three_per_cent_in_all_rates_are_warned_of_and_allowed_for():
    tab = sc.data.read_table(sc.data.example("flicks"))
    theta, hertz = np.radians(tab["degrees"]), tab["hertz"]
    rate = hertz / SCALE.hertz(TUBE, 1.0)
    errors = {"theta_err": np.radians(0.5), "rate_err": 0.02 * rate}
    plain = sc.data.compare(TUBE, theta, rate, **errors)
    assert abs(plain.ratio - plain.expected) < plain.ratio_err
    # for points close to each other, another ratio and a factor have the same effect
    theta = np.random.default_rng(1).normal(np.radians(np.linspace(70.0, 76.0, 12)), 0.005)
    rate = 1.03 * TUBE.rate(np.radians(np.linspace(70.0, 76.0, 12)))
    errors = {"theta_err": 0.005, "rate_err": 0.01 * rate}
    with pytest.warns(UserWarning, match=r"errors from .*, as built, .* too large in all points .* as well"):
        off = sc.data.compare(TUBE, theta, rate, **errors)
    assert abs(off.ratio - off.expected) > 3 * off.ratio_err and off.chi2 < 1.5
    assert abs(off.alone - 1.03) < 2 * off.alone_err
    allowed = sc.data.compare(TUBE, theta, rate, **errors, common=0.03)
    assert abs(allowed.ratio - allowed.expected) < 2 * allowed.ratio_err
    assert allowed.ratio_err > 1.5 * off.ratio_err


def test_a_factor_that_points_of_both_branches_tell_is_warned_of():
    theta = np.r_[np.radians([3.0, 5.0, 7.0]), np.radians([65.0, 72.0, 79.0])]
    rate = 1.05 * CYLINDER.rate(theta)
    with pytest.warns(UserWarning, match=r"5\.0% too large \(1\.05.* common=inf fits"):
        sc.data.compare(CYLINDER, theta, rate, theta_err=2e-3, rate_err=0.02 * rate)


def test_what_is_known_of_the_factor_holds_it():
    theta, rate, theta_err, rate_err = steady(CYLINDER, np.random.default_rng(3))
    for errors in ({"theta_err": theta_err, "rate_err": rate_err}, {}):
        found = [
            sc.data.compare(CYLINDER, theta, rate, **errors, common=c) for c in (0.0, 1e-5, 0.01, 1e3, np.inf)
        ]
        assert found[1].ratio == pytest.approx(found[0].ratio, rel=1e-4)
        assert found[1].factor_err == pytest.approx(1e-5, rel=0.01) and found[0].factor_err == 0
        assert found[2].ratio_err < found[3].ratio_err
        assert found[3].ratio == pytest.approx(found[4].ratio, rel=1e-3)
        assert found[3].factor_err == pytest.approx(found[4].factor_err, rel=0.05)  # one degree of freedom


def test_points_that_cannot_tell_the_factor_from_the_ratio_say_so():
    disk = sc.Body.solid(0.0)
    theta = np.radians([1.0, 1.5, 2.0, 2.5])
    for given in (theta, theta[0] + np.array([0.0, 1e-6, 2e-6])):
        rate = disk.rate(given)
        errors = {"theta_err": 1e-5, "rate_err": 1e-3 * rate}
        with pytest.raises(ValueError, match="cannot separate a factor"):
            sc.data.compare(disk, given, rate, **errors, common=np.inf)
        held = sc.data.compare(disk, given, rate, **errors, common=0.02)
        assert held.ratio == pytest.approx(0.5, abs=1e-3) and held.ratio_err > 0.005
    for wrong in (-1.0, 1e-9, np.nan):
        with pytest.raises(ValueError, match="common"):
            sc.data.compare(disk, theta, disk.rate(theta), common=wrong)


def test_rates_in_radians_a_second_are_told_by_their_factor():
    theta, rate, *_ = steady(CYLINDER, np.random.default_rng(7))
    with pytest.warns(UserWarning, match=r"rates 6\.\d+ times those of the body as built"):
        sc.data.compare(CYLINDER, theta, 2 * np.pi * rate)


def test_one_film_is_compared_with_the_body_as_built_in_its_own_errors():
    """Normal errors of both quantities: the distances are those of a normal deviate."""
    rng, away = np.random.default_rng(11), []
    for _ in range(300):
        theta, rate = STEEP + 0.01 * rng.normal(), float(TUBE.rate(STEEP)) * (1 + 0.01 * rng.normal())
        errors = {"theta_err": 0.01, "rate_err": 0.01 * float(TUBE.rate(STEEP))}
        away.append(float(sc.data.compare(TUBE, theta, rate, **errors).away[0]))
    assert 0.9 < np.sqrt(np.mean(np.square(away))) < 1.1
    film = sc.data.from_above(sc.data.example("tube_from_above"), TUBE)
    errors = {"theta_err": film.theta_err, "rate_err": film.rate_err}
    for shape in (float, np.atleast_1d):
        found = sc.data.compare(TUBE, shape(film.theta), shape(film.rate), **errors)
        assert found.away == pytest.approx([abs(film.theta - film.predicted) / film.theta_err], rel=0.1)
        assert "one point, 1.4 errors from a steady state: agrees with" in repr(found)
        assert np.isnan(found.ratio) and found.fitted == TUBE and "steady at 83.4" in found.report()
        assert "agrees with" in found._repr_html_()
    off = sc.data.compare(TUBE, film.theta - 0.1, film.rate, **errors)
    assert "disagrees with the body as built" in off.report() and off.away[0] > 15
    with pytest.raises(ValueError, match="common = 0.03: expected 0 for fewer than three points"):
        sc.data.compare(TUBE, film.theta, film.rate, **errors, common=0.03)


def test_two_points_are_told_that_three_are_needed():
    theta = np.array([0.1, 1.4])
    for given, said in (
        (
            (theta, CYLINDER.rate(theta)),
            "at least three different points, not two; one or two need theta_err",
        ),
        ((theta[:1], CYLINDER.rate(theta[:1])), "different points, not one; one or two need theta_err"),
        (([], []), "at least three different points, not none$"),
        (([0.1] * 5, [0.5] * 5), r"not five \(one different\); one or two need"),
        (([0.1, 1.4, np.nan], [0.5, 1.0, 1.0]), "not two, and one with NaN; one or two need"),
    ):
        with pytest.raises(ValueError, match=said):
            sc.data.compare(CYLINDER, *given)
    with pytest.raises(ValueError, match="expected at least 5 points at different times, not 2$"):
        sc.data.fit_losses([0.0, 1.0], theta[::-1], body=CYLINDER)


def test_degrees_are_told_from_radians():
    theta = np.array([5.0, 10.0, 70.0, 80.0])
    with pytest.raises(ValueError, match=r"give np.radians\(theta\)"):
        sc.data.compare(CYLINDER, theta, CYLINDER.rate(np.radians(theta)))
    with pytest.raises(ValueError, match=r"give np.radians\(theta\)"):
        sc.data.fit_losses(np.arange(6.0), np.linspace(20.0, 10.0, 6), body=sc.Body.solid(0.2))
    with pytest.raises(ValueError, match=r"they fall to 1: sort the points with np.argsort\(t\)"):
        sc.data.fit_losses([0.0, 2.0, 1.0, 3.0, 4.0], np.linspace(0.3, 0.1, 5), body=sc.Body.solid(0.2))


# reports


def test_a_report_says_what_the_fit_holds_as_lmfit_does():
    theta, rate, theta_err, rate_err = steady(CYLINDER, np.random.default_rng(4))
    errors = {"theta_err": theta_err, "rate_err": rate_err}
    fixed = sc.data.compare(CYLINDER, theta, rate, **errors)
    free = sc.data.compare(CYLINDER, theta, rate, **errors, common=np.inf)
    for found, sections in ((fixed, 3), (free, 4)):
        report = found.report()
        assert report.count("[[") == sections and report.startswith("[[Comparison]]")
        assert f"+/- {found.ratio_err:.2g}" in report and "# data points      = 16" in report
    assert "(fixed)" in fixed.report() and "C(I1/I3, factor)" not in fixed.report()
    assert f"C(I1/I3, factor) = {free.correlation:+.4f}" in free.report()


def test_a_report_of_a_spin_down_has_the_best_law_and_the_table():
    disk = sc.Body.solid(0.17)
    rng = np.random.default_rng(5)
    true = sc.drift(disk, 0.3, sc.loss.DryContour(1e-3))
    t = np.linspace(0.0, 0.9 * true.stops_at, 40)
    laws = [sc.loss.DryContour, sc.loss.ViscousContour]
    found = sc.data.fit_losses(t, true.theta(t) * rng.normal(1, 0.01, 40), body=disk, laws=laws)
    report = found.report()
    assert report.startswith("[[Spin-down]]") and "law                = DryContour" in report
    assert f"+/- {found.best.coefficient_err:.2g}" in report
    assert all(line in report for line in found.table().splitlines())


def test_the_plot_of_a_fit_with_a_factor_takes_it_out_of_the_points():
    import matplotlib.pyplot as plt

    theta, rate, *_ = steady(CYLINDER, np.random.default_rng(6), 1e-3)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = sc.data.compare(CYLINDER, theta, 1.05 * rate, common=np.inf)
    ax = found.plot()
    drawn = ax.containers[0].lines[0].get_xdata()
    assert np.allclose(drawn, 1.05 * rate / found.factor) and "measured over 1.0" in ax.get_xlabel()
    plt.close("all")
