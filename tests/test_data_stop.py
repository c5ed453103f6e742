"""A stopwatch: the time in which a coin stops gives the coefficient of a loss, with an error that holds."""

import json
import math
import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import spincyl as sc
from spincyl.lab._times import timed

COIN = sc.measured(outer_diameter="25.75mm", length="2.2mm", mass="8.5g")
STOPS = ("DryContour", "ViscousContour", "RollingResistance", "AirFilm", "BoundaryLayer")
START, HAND, EYE = math.radians(20), 0.2, math.radians(2)
# air does not stop a coin in eight seconds, and no film of it fills the gap at 20 degrees
film = pytest.mark.filterwarnings("ignore:the film of AirFilm fills", "ignore:.*is far from the")
named = pytest.mark.parametrize("name", STOPS)


def lasts(law, theta=START, centre="rest", body=COIN):
    """Seconds to the end of a drift."""
    with warnings.catch_warnings(action="ignore"):  # a film of air does not fill so wide a gap
        return float(sc.drift(body, theta, law, centre).stops_at)


def typical(name):
    """A law that stops the coin after eight seconds."""
    kind, scale = getattr(sc.loss, name), COIN.scale
    one = sc.drift(COIN.natural, START, kind(1e-9)).stops_at * 1e-9
    return kind.from_si(float(kind(one / (8 / scale.seconds(1.0))).in_si(COIN)), scale=COIN)


@named
@film
@pytest.mark.parametrize("centre", ["rest", "rolling"])
def test_the_exact_time_of_a_drift_gives_back_its_coefficient(name, centre):
    true = typical(name)
    found = sc.data.fit_stop(COIN, type(true), START, lasts(true, centre=centre), error=0.01, centre=centre)
    (fit,) = found.fits
    assert fit.coefficient == pytest.approx(float(true.coefficient), rel=1e-9)
    assert fit.coefficient_si == pytest.approx(float(true.in_si(COIN)), rel=1e-9)
    assert fit.coefficient_err_si / fit.coefficient_si == pytest.approx(0.01 / found.stops_at)
    assert lasts(fit.law, centre=centre) == pytest.approx(found.stops_at, rel=1e-9)
    assert fit.centre == centre and fit.drift.centre == centre


@named
@film
def test_both_drifts_are_fitted_unless_one_is_named(name):
    found = sc.data.fit_stop(COIN, getattr(sc.loss, name), "20deg", [7.0, 7.4])
    assert (
        [fit.centre for fit in found.fits]
        == ["rest", "rolling"]
        == [found.of(c).centre for c in ("rest", "rolling")]
    )
    ratio = found.of("rolling").coefficient / found.of("rest").coefficient
    assert ratio == pytest.approx(lasts(typical(name), centre="rolling") / 8, rel=1e-6)


@pytest.mark.parametrize(("many", "error"), [(5, None), (2, None), (1, HAND), (5, HAND)])
@pytest.mark.parametrize("centre", ["rest", "rolling"])
def test_the_coefficient_of_a_rough_measurement_is_within_its_error_two_times_of_three(many, error, centre):
    true, law = typical("DryContour"), sc.loss.DryContour
    pulls = []
    for seed in range(150):
        rng = np.random.default_rng(seed)
        # the mark on the wall is off in all tries; the hand is late or early in each
        time = lasts(true, START + EYE * rng.normal(), centre) + HAND * rng.normal(size=many)
        fit = sc.data.fit_stop(COIN, law, START, time, error=error, from_err=EYE, centre=centre).fits[0]
        pulls.append((fit.coefficient - float(true.coefficient)) / fit.coefficient_err)
        assert fit.coefficient_err == pytest.approx(math.hypot(fit.by_times, fit.by_angle))
    assert 0.58 < np.mean(np.abs(pulls) < 1) < 0.8  # 0.68 +- 0.04 of 150
    assert abs(np.mean(pulls)) < 0.3


def test_the_scatter_of_few_times_tells_their_error_two_times_of_three():
    for many in (2, 3, 6):
        within = 0
        for seed in range(300):
            time = 8 + HAND * np.random.default_rng(seed).normal(size=many)
            found = sc.data.fit_stop(COIN, sc.loss.DryContour, START, time, centre="rest")
            within += abs(found.stops_at - 8) < found.stops_at_err
        assert 0.6 < within / 300 < 0.76, many  # 0.683 +- 0.027


@pytest.mark.parametrize("name", ["DryContour", "ViscousContour", "RollingResistance"])
def test_a_coin_that_rolls_to_its_end_is_timed_to_the_first_order_of_its_loss(name):
    """The motion itself, not the drift, keeps the time."""
    true = typical(name)
    m = sc.roll(COIN, COIN.steady(START), [0.0, 20.0], losses=true)
    fit = sc.data.fit_stop(
        COIN, type(true), START, m.event.time + HAND * np.array([-1.0, 0.3, 1.1, -0.4, 0.2]), from_err=EYE
    )
    one = fit.of("rolling")
    assert abs(one.coefficient - float(true.coefficient)) < one.coefficient_err
    exact = sc.data.fit_stop(COIN, type(true), START, m.event.time, error=0.01).of("rolling")
    assert exact.coefficient == pytest.approx(float(true.coefficient), rel=3e-3)


def test_what_is_printed_can_be_given_back():
    for name in STOPS:
        with warnings.catch_warnings(action="ignore"):
            fit = sc.data.fit_stop(COIN, getattr(sc.loss, name), START, [7.0, 7.2], centre="rest").fits[0]
        (said,) = str(fit.law).split("(")[1:]
        number, unit = said.rstrip(")").split(" ", 1)
        assert f": {number} +- " in repr(fit) and repr(fit).endswith(f" {unit}>")
        back = getattr(sc.loss, name).from_si(said.rstrip(")"), scale=COIN)
        assert float(back.coefficient) == pytest.approx(fit.coefficient, rel=1e-3)


def test_a_body_of_unknown_mass_has_a_length_in_millimetres_and_no_couple_in_si():
    coin = sc.measured(outer_diameter="25.75mm", length="2.2mm")
    dry, viscous = (
        sc.data.fit_stop(coin, law, START, [7.0, 7.2], centre="rest").fits[0]
        for law in (sc.loss.DryContour, sc.loss.ViscousContour)
    )
    assert repr(dry).endswith(" mm>") and "N m s" not in repr(viscous)
    with pytest.raises(ValueError, match="needs the mass"):
        viscous.coefficient_si


def test_the_report_says_where_the_error_comes_from():
    found = sc.data.fit_stop(COIN, sc.loss.DryContour, "20deg", [6.9, 7.3, 7.0, 7.4, 7.1], from_err="2deg")
    said = found.report()
    for told in (
        "DryContour",
        "20 +/- 2 degrees",
        "7.14 +/- 0.11 s",
        "in mm",
        "times 1.5%, angle 15%",
        "by rolling",
    ):
        assert told in said
    assert max(map(len, said.splitlines())) <= 88
    assert (
        "by rolling" in found._repr_html_()
        and " mm<" in found._repr_html_()
        and "<svg" in found._repr_html_()
    )


@pytest.mark.parametrize("name", ["AirLinear", "AirQuadratic"])
def test_a_law_under_which_the_coin_never_stops_is_refused_by_name(name):
    assert getattr(sc.loss, name)(1e-3).exponent is None
    with pytest.raises(ValueError, match=f"^law: with {name}, starting at 20 degrees, this body never stops"):
        sc.data.fit_stop(COIN, getattr(sc.loss, name), "20deg", [7.0, 7.2])


def test_drilling_stops_no_thin_disk_and_a_coin_only_while_its_centre_rests():
    thin = sc.measured(outer_diameter="25mm", length="1e-9mm")
    with warnings.catch_warnings(action="ignore"), pytest.raises(ValueError, match="^law: "):
        sc.data.fit_stop(thin, sc.loss.Drilling, "20deg", [7.0, 7.2], centre="rolling")
    found = sc.data.fit_stop(COIN, sc.loss.Drilling, "20deg", [7.0, 7.2])
    assert [fit.centre for fit in found.fits] == ["rest"]
    assert found.refused[0].centre == "rolling" and "drilling stops" in found.refused[0].why
    assert "not fitted" in found.report() and "not fitted" in found._repr_html_()
    with pytest.raises(KeyError, match="rolling.*drilling stops"):
        found.of("rolling")


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (
            {"seconds": 7.1},
            "^seconds: a single time has no scatter; give the standard error of a time in seconds, such as error=0.2",
        ),
        ({"seconds": [7.1]}, "^seconds: a single time"),
        ({"seconds": [7.1, math.nan]}, "^seconds: a single time"),
        ({"seconds": [7.1, 7.1]}, "^seconds: equal times have no scatter"),
        ({"seconds": []}, "^seconds: expected at least one time"),
        ({"seconds": [math.nan]}, "^seconds: expected at least one"),
        ({"seconds": [7.0, -1.0]}, "^seconds\\[1\\] = -1.0: expected more than 0"),
        ({"seconds": [7.0, 0.0]}, "^seconds\\[1\\] = 0.0: expected more than 0"),
        ({"seconds": [7.0, math.inf]}, "^seconds\\[1\\] = inf: expected"),
        ({"seconds": [1e300, 2e300]}, "^seconds\\[0\\] = 1e\\+300: expected"),
        ({"seconds": [1e-300, 2e-300]}, "^seconds = 1.5e-300: the body would stop within .* of a turn"),
        ({"seconds": np.ones((2, 2, 2))}, "^from_, seconds: expected .* a list or a table of times"),
        ({"seconds": [[7.0, 7.2], [7.1]]}, "^seconds: expected rows of equal length, .*from_={'20deg'"),
        ({"seconds": [7.0, 7.1, 7.2], "names": ["Anna"]}, "^names: expected 3 names, .* not 1"),
        ({"from_": ["20deg", "30deg"], "seconds": [7.0, 7.1, 7.2]}, "^seconds: expected a column for each"),
        ({"from_": [0.3, 0.6], "from_err": [0.1, 0.1, 0.1]}, "^from_err: expected a number or shape"),
        ({"from_": {"twenty": [7.0, 7.2]}, "seconds": None}, "^from_: the column 'twenty' is not called"),
        ({"from_": {"20": [7.0, 7.2]}, "seconds": None}, "^from_: the column '20' is not called"),
        ({"from_": {}, "seconds": None}, "^from_: expected at least one column"),
        ({"law": [sc.loss.DryContour] * 2}, "^law: expected .* each law only once"),
        ({"law": []}, "^law: expected at least one law"),
        ({"error": 0.0}, "^error = 0.0: expected a positive time"),
        (
            {"error": 9.0},
            "^error = 9.0: expected a positive time, less than the median of 7.1 s of the times from 20 degrees",
        ),
        ({"error": math.nan}, "^error = nan: expected a positive time"),
        ({"from_": 20}, "^from_ = 20.0: expected .* degrees"),
        ({"from_": 0.0}, "^from_ = 0.0: expected a positive angle"),
        ({"from_": "100deg"}, "^from_: theta = "),
        ({"from_": math.nan}, "^from_ = nan"),
        ({"from_err": -0.1}, "^from_err = -0.1: expected at least 0, less than from_"),
        ({"from_err": "25deg"}, "^from_err = .*: expected at least 0, less than from_"),
        ({"centre": "moving"}, "^centre = 'moving': expected 'rest' or 'rolling'"),
        ({"body": COIN.natural}, "^body: the size of the body is unknown"),
        ({"body": sc.measured(outer_diameter=0.02, length=0.05), "from_": "40deg"}, "^from_: .* forbidden"),
    ],
)
def test_what_makes_no_sense_is_refused_by_its_name(given, told):
    good = {"body": COIN, "law": sc.loss.DryContour, "from_": "20deg", "seconds": [7.0, 7.2]}
    with pytest.raises(ValueError, match=told):
        sc.data.fit_stop(**good | given)


@pytest.mark.parametrize(
    "law", [sc.loss.DryContour(1e-3), [sc.loss.DryContour(1e-3)], sc.loss.Law, "DryContour", ["DryContour"]]
)
def test_a_law_is_a_class(law):
    with pytest.raises(TypeError, match="^law: expected a class of sc.loss such as sc.loss.DryContour"):
        sc.data.fit_stop(COIN, law, "20deg", [7.0, 7.2])


def test_a_time_may_have_its_unit_and_a_missed_one_is_left_out():
    one = sc.data.fit_stop(COIN, sc.loss.DryContour, START, "0.12 min", error="200ms", from_err="2deg")
    assert one.stops_at == pytest.approx(7.2) and one.stops_at_err == pytest.approx(0.2)
    assert sc.data.fit_stop(COIN, sc.loss.DryContour, START, [7.0, math.nan, 7.2]).seconds.size == 2


def test_minutes_that_were_typed_for_seconds_are_warned_of():
    with pytest.warns(UserWarning, match="the body turns only 1.8 times before it stops.* in seconds"):
        sc.data.fit_stop(COIN, sc.loss.DryContour, START, [0.117, 0.121])
    with pytest.warns(UserWarning, match="the times range from 0.12 to 7.1 s: are all in seconds"):
        sc.data.fit_stop(COIN, sc.loss.DryContour, START, [0.12, 7.1], error=0.2)


def test_a_film_of_air_that_cannot_fill_the_gap_is_warned_of_once():
    with (
        pytest.warns(sc.DriftWarning, match="fills the gap below theta") as said,
        pytest.warns(UserWarning, match=r"viscosity = 0.000\d+ Pa s is far from the typical 1.8e-05 Pa s"),
    ):
        sc.data.fit_stop(COIN, sc.loss.AirFilm, START, [7.0, 7.2])
    kinds = [one for one in said if one.category is sc.DriftWarning]
    assert len(kinds) == 1 and kinds[0].filename == __file__


def test_the_orders_of_magnitude_in_the_table_are_those_of_the_times_that_they_come_from():
    rows = {
        (row.of.split()[0], row.pair): (row.low, row.high) for row in sc.loss.typical if row.sure == "order"
    }
    euler = sc.measured(outer_diameter="75.1mm", length="12.8mm", mass="0.44kg")
    quarter = sc.measured(outer_diameter="24.26mm", length="1.75mm", mass="5.67g")
    bodies = {
        "coin that it stops": (quarter, (3, 5), (30, 60)),
        "Euler's disk that it stops": (euler, (100,), (20, 60)),
    }
    for name in ("DryContour", "ViscousContour", "RollingResistance"):
        for pair, (body, seconds, degrees) in bodies.items():
            found = [
                fit.coefficient_si * (1 if name == "ViscousContour" else 1e3)
                for second in seconds
                for degree in degrees
                for fit in sc.data.fit_stop(
                    body, getattr(sc.loss, name), f"{degree}deg", second, error=0.2
                ).fits
            ]
            low, high = rows[name, pair]
            assert low / 1.3 < min(found) < 1.5 * low and high / 1.5 < max(found) < 1.3 * high, (
                name,
                pair,
                found,
            )


def test_every_row_of_the_table_has_a_source_and_a_range_that_from_si_takes():
    scale = sc.measured(outer_diameter="20mm", length="5mm", mass="10g")
    table = sc.loss.typical
    assert len(table) >= 25 and "typical" in dir(sc.loss)
    for row in table:
        assert 0 < row.low <= row.high and len(row.source) > 20 and row.pair
        kind = getattr(sc.loss, row.of.split()[0], None)
        if kind is not None:
            assert row.of.split()[1] in (*kind.__dataclass_fields__, "C")
            with warnings.catch_warnings(action="ignore"):
                assert kind.from_si(f"{row.high:g} {row.unit}", scale=scale).coefficient > 0
    assert {row.of for row in table.of(sc.Coulomb)} == {"Coulomb mu", "Coulomb static"}
    assert {row.of for row in table.of("restitution")} == {"restitution"}
    assert max(map(len, repr(table).splitlines())) <= 88 and "Moffatt, Nature 404" in repr(table)
    with pytest.raises(ValueError, match="not in the table; expected one of Coulomb"):
        table.of(sc.loss.AirLinear)
    with pytest.raises(AttributeError, match="no attribute 'atypical'"):
        sc.loss.atypical


def test_an_outlier_is_named_by_its_index_and_value_and_ten_good_times_pass():
    truth = sc.loss.DryContour.from_si("0.05mm", scale=COIN)
    t = lasts(truth)
    good = t * (1 + 0.05 * np.random.default_rng(5).normal(size=10))
    how = {"from_err": "0.2deg", "centre": "rest"}
    alone = sc.data.fit_stop(COIN, sc.loss.DryContour, "20deg", good, **how)
    assert not alone.wild
    for times, name in (
        ([*good, 2.1 * t], rf"seconds\[10\] = {2.1 * t:.4g} .*: \d+ standard deviations of the other times"),
        ([np.nan, 0.3 * t, *good], rf"seconds\[1\] = {0.3 * t:.4g} .*: "),
        ([2 * t, *good, 60 * t], rf"seconds\[11\] = {60 * t:.4g} .*: \d+, seconds\[0\] = .*: \d+ standard"),
    ):
        with pytest.warns(UserWarning, match=f"^{name}.* left out"):
            found = sc.data.fit_stop(COIN, sc.loss.DryContour, "20deg", times, **how)
        assert found.best == alone.best and f"left out    = {found.wild[0].where}" in found.report()
        wild = [x for x in times if abs(x - t) > 0.3 * t]
        assert [one.seconds for one in found.wild] == sorted(wild, key=lambda x: -abs(x - t))


def test_normal_times_seldom_have_an_outlier():
    """Also times that a hand watch rounds to tenths of a second."""
    rng, warned = np.random.default_rng(3), 0
    for k in range(300):
        times = rng.normal(7.0, rng.choice([0.02, 0.2, 0.7]), rng.integers(5, 20))
        warned += bool(timed(0.3, np.round(times, 1 + k % 2), 0.1, 0.0, None).wild)
    assert warned <= 3


def test_the_coin_of_the_lab_page_has_a_coefficient_that_is_typical_of_coins():
    page = (Path(__file__).parents[1] / "docs" / "lab.md").read_text("utf-8")
    times, angle = re.search(
        r"^times = (\[.*\])\n.*fit_stop\(coin, sc.loss.DryContour, \"(\w+)\"", page, re.M
    ).groups()
    (coin,) = (row for row in sc.loss.typical.of(sc.loss.DryContour) if row.pair.startswith("coin"))
    for fit in sc.data.fit_stop(COIN, sc.loss.DryContour, angle, json.loads(times)).fits:
        assert coin.unit == "mm" and coin.low < 1e3 * fit.coefficient_si < coin.high


NAMES = ("Anna", "Ben", "Cem", "Dora", "Elif", "Finn", "Gül", "Hana", "Ida", "Jan", "Kim", "Lea")
ANGLES = (20, 35, 50)


def class_table(law, seed, wild=True, scatter=0.06, centre="rest"):
    """A table of a class in a German spreadsheet: a row for each student, gaps, and a stopwatch left running."""
    rng = np.random.default_rng(seed)
    lasts_ = [lasts(law, math.radians(angle + 1.5 * rng.normal()), centre) for angle in ANGLES]
    rows = [[f"{t * (1 + scatter * rng.normal()):.1f}" for t in lasts_] for _ in NAMES]
    for student, column in ((1, 0), (4, 2), (9, 0), (9, 1)):
        rows[student][column] = "" if student < 9 else "-"
    if wild:
        rows[3][1] = f"{6.5 * lasts_[1]:.1f}"
    lines = [";".join([name, *row]).replace(".", ",") for name, row in zip(NAMES, rows, strict=True)]
    return "\n".join(["Klasse 9b, Münzen", "Name;" + ";".join(f"{a}°" for a in ANGLES), *lines, ""])


def read_class(tmp_path, *args, **more):
    (tmp_path / "9b.csv").write_text(class_table(*args, **more), "utf-8")
    return sc.data.read_table(tmp_path / "9b.csv")


def test_a_column_of_times_is_called_by_its_inclination_however_a_class_writes_it(tmp_path):
    good = [7.0, 7.3, 7.1, 7.4]
    alone = sc.data.fit_stop(COIN, sc.loss.DryContour, "20deg", good)
    (tmp_path / "9a.csv").write_text("Name;Zeit bei 20 Grad (s)\nAnna;7\nBen;8", "utf-8")
    assert list(sc.data.read_table(tmp_path / "9a.csv")) == ["Zeit bei 20 Grad"]
    headers = "20° (s)", "20 Grad", "20 deg (s)", "20 degrés", "Zeit bei 20° [s]", "t20deg / s", "20 (deg)"
    for header in headers:
        lines = [f"Name;{header}", *(f"{name};{t:.1f}" for name, t in zip(NAMES, good, strict=False))]
        (tmp_path / "9c.csv").write_text("\n".join(lines).replace(".", ","), "utf-8")
        found = sc.data.fit_stop(COIN, sc.loss.DryContour, sc.data.read_table(tmp_path / "9c.csv"))
        assert found.best.coefficient == alone.best.coefficient, header
    in_ms = sc.data.Columns([("20,0° (ms)", 1e3 * np.array(good))])
    assert sc.data.fit_stop(COIN, sc.loss.DryContour, in_ms).best.coefficient == pytest.approx(
        alone.best.coefficient, rel=1e-12
    )
    for header, why in {
        "von 20° bis 5°": "is called by two inclinations",
        "20°C": "is not called by an",
        "t20 (s)": "t20' is not called by an inclination with its unit",
        "-20°": "positive",
    }.items():
        with pytest.raises(
            ValueError, match=f"^from_: the column '.*{why}" if why != "positive" else "^from_: "
        ):
            sc.data.fit_stop(COIN, sc.loss.DryContour, sc.data.Columns([(header, np.array(good))]))


def test_a_class_finds_the_law_that_stops_its_coin_and_names_the_watch_that_ran_on(tmp_path):
    true = sc.loss.DryContour.from_si("0.02mm", scale=COIN)
    table = read_class(tmp_path, true, 1)
    assert table.texts == {"Name": NAMES} and list(table) == ["20°", "35°", "50°"]
    with pytest.warns(
        UserWarning, match=r"from_\['35°'\]\[3\] = \d+.* \(Dora, from 35 degrees\): \d+ standard"
    ):
        found = sc.data.fit_stop(COIN, None, table, from_err="1.5deg")
    assert [(one.name, round(math.degrees(one.theta))) for one in found.wild] == [("Dora", 35)]
    assert type(found.best.law) is sc.loss.DryContour and found.seconds.size == 3 * 12 - 4
    assert abs(found.best.coefficient - true.coefficient) < 2 * found.best.coefficient_err
    # air, and rolling resistance, which takes more at steep inclinations, miss by many errors
    told = {(type(fit.law).__name__, fit.centre): fit.daic for fit in found.fits}
    assert told["RollingResistance", "rest"] > 30 and told["BoundaryLayer", "rest"] > 6
    assert {no.name for no in found.refused} >= {"AirLinear", "AirQuadratic"}
    said = found.report()
    assert (
        "mean times from 20°, 35°, 50° minus those of the law" in said
        and "left out = " in said
        and "(Dora, " in said
    )
    assert max(map(len, (row for row in said.splitlines() if "not fitted" in row))) <= 88


@pytest.mark.parametrize("centre", ["rest", "rolling"])
def test_the_coefficient_of_a_class_is_within_its_error_two_times_of_three(tmp_path, centre):
    true, inside = sc.loss.DryContour.from_si("0.02mm", scale=COIN), []
    for seed in range(100):
        table = read_class(tmp_path, true, seed, centre=centre)
        with warnings.catch_warnings(action="ignore"):
            fit = sc.data.fit_stop(COIN, sc.loss.DryContour, table, from_err="1.5deg", centre=centre).best
        inside.append(abs(fit.coefficient - float(true.coefficient)) < fit.coefficient_err)
    assert 0.58 < np.mean(inside) < 0.8  # 0.68 +- 0.05 of 100


def test_one_wild_time_of_twelve_changes_nothing_by_more_than_an_error():
    """However wild it is: near the others it is clipped, far from them left out."""
    law, how = sc.loss.DryContour, {"from_err": 0.0, "centre": "rest"}
    for seed in range(40):
        good = 8 + 0.4 * np.random.default_rng(seed).normal(size=11)
        plain = sc.data.fit_stop(COIN, law, START, good, **how).best
        for wild in (0.2, 5.5, 6.8, 9.3, 10.0, 10.8, 12.0, 16.0, 60.0):
            with warnings.catch_warnings(action="ignore"):
                fit = sc.data.fit_stop(COIN, law, START, [*good, wild], **how).best
            assert abs(fit.coefficient - plain.coefficient) < plain.coefficient_err, (seed, wild)
            assert fit.coefficient_err < 2 * plain.coefficient_err


STOPPED = np.array([0.83, 3.69, 11.2])
SCATTER = {"of the hand": 0.2 + 0 * STOPPED, "of the release": 0.06 * STOPPED}


@pytest.mark.parametrize("error", [None, 0.2])
@pytest.mark.parametrize("kind", SCATTER)
def test_hardly_a_class_of_24_honest_times_loses_one_and_a_wild_one_is_found(kind, error):
    """A tenth of 0.83 s is only four deviations of the hand away, so it is not asked for there."""
    lost = missed = 0
    for seed in range(150):
        rng = np.random.default_rng(seed)
        times = np.maximum(STOPPED + SCATTER[kind] * rng.normal(size=(8, 3)), 0.05)
        lost += bool(timed(np.radians([20, 40, 60]), times, error, 0.0, None).wild)
        row, column = rng.integers(8), rng.integers(1, 3)
        for wild in (10 * times[row, column], 0.1 * times[row, column], times[row, column] + 30):
            with_wild = times.copy()
            with_wild[row, column] = wild
            found = timed(np.radians([20, 40, 60]), with_wild, error, 0.0, None).wild
            missed += wild not in [one.seconds for one in found]
    assert lost <= 4 and missed == 0  # below 3 % of classes


@pytest.mark.parametrize("kind", SCATTER)
def test_the_error_of_the_mean_of_a_class_holds_for_both_kinds_of_scatter(kind):
    pulls = []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        times = np.maximum(STOPPED + SCATTER[kind] * rng.normal(size=(8, 3)), 0.05)
        data = timed(np.radians([20, 40, 60]), times, None, 0.0, None)
        by = data.mean_err / STOPPED  # of the coefficient, as `fit_stop` weights the angles
        off = (data.mean / STOPPED - 1) @ by**-2 / (by**-2).sum()
        pulls.append(off * math.sqrt((by**-2).sum()))
    assert 0.75 < np.std(pulls) < 1.3 and abs(np.mean(pulls)) < 0.4  # 1 +- 0.09


def test_a_stated_error_is_that_of_each_time_and_a_bad_time_has_its_row_and_name():
    times = {"60deg": 11.2 + 0.2 * np.random.default_rng(1).normal(size=7)}
    found = sc.data.fit_stop(COIN, sc.loss.DryContour, times, error=0.2)
    assert found.stops_at_err == pytest.approx(0.2 / math.sqrt(7))
    with pytest.raises(ValueError, match=r"^from_\['60deg'\]\[1\] = -0.0 \(Ben\): expected more than 0"):
        sc.data.fit_stop(COIN, sc.loss.DryContour, {"60deg": [11.0, -0.0]}, names=["Anna", "Ben"])


def test_all_laws_that_are_not_told_apart_are_printed_first():
    times = np.array([[1.0, 3.5], [1.4, 3.9], [0.7, 3.6]])
    found = sc.data.fit_stop(COIN, sc.loss.DryContour, ["20deg", "40deg"], times, from_err="2deg")
    assert not found.told_apart and {fit.centre for fit in found.fits} == {"rest", "rolling"}
    for said in (repr(found), found.report().split("[[Laws]]")[0]):
        assert "with the centre at rest" in said and "by rolling" in said


def test_times_of_several_angles_may_come_in_a_table_in_columns_or_one_by_one():
    rows = np.array([[2.0, 5.1, 9.0], [2.1, np.nan, 9.2], [1.9, 4.9, np.nan], [2.0, 5.0, 9.1]])
    angles, law = ["20deg", "35deg", "50deg"], [sc.loss.DryContour, sc.loss.ViscousContour]
    of_rows = sc.data.fit_stop(COIN, law, angles, rows, from_err=0.02)
    columns = {name: column for name, column in zip(angles, rows.T, strict=True)}
    of_columns = sc.data.fit_stop(COIN, law, columns, from_err=[0.02] * 3)
    ragged = {name: column[np.isfinite(column)].tolist() for name, column in columns.items()}
    lists = [[None if np.isnan(x) else x for x in row] for row in rows.tolist()]
    one_by_one = (np.tile(np.radians([20, 35, 50]), 4), rows.reshape(-1))
    for other in (
        of_columns,
        sc.data.fit_stop(COIN, law, ragged, from_err=0.02),
        sc.data.fit_stop(COIN, law, angles, lists, from_err=0.02),
        sc.data.fit_stop(COIN, law, *one_by_one, from_err=0.02),
    ):
        np.testing.assert_allclose(other.stops_at, of_rows.stops_at, rtol=1e-12)
        for one, two in zip(other.fits, of_rows.fits, strict=True):
            assert one.coefficient == pytest.approx(two.coefficient, rel=1e-9) and type(one.law) is type(
                two.law
            )
            assert one.coefficient_err == pytest.approx(two.coefficient_err, rel=1e-9)
    assert of_rows.of("rolling", sc.loss.ViscousContour).centre == "rolling"
    with pytest.raises(KeyError, match="'rest' was not fitted with AirFilm"):
        of_rows.of("rest", sc.loss.AirFilm)
    with pytest.raises(TypeError, match="^seconds: leave it out if from_ is a table"):
        sc.data.fit_stop(COIN, law, columns, rows)
    with pytest.raises(TypeError, match="^seconds: expected the measured times"):
        sc.data.fit_stop(COIN, law, angles)


def test_what_a_law_misses_by_are_the_times_minus_those_of_its_drifts():
    angles = np.radians([20.0, 35.0, 50.0])
    times = [lasts(sc.loss.DryContour.from_si("0.02mm", scale=COIN), theta) for theta in angles]
    found = sc.data.fit_stop(
        COIN, [sc.loss.DryContour, sc.loss.ViscousContour], angles, times, error=0.1, centre="rest"
    )
    dry, viscous = found.fits
    np.testing.assert_allclose(dry.misses, 0, atol=1e-9)
    shown = [lasts(viscous.law, theta) for theta in angles]
    np.testing.assert_allclose(viscous.misses, np.array(times) - shown, rtol=1e-6)
    assert viscous.chi2 > 100 and found.told_apart and not found.fits[0].chi2 > 1e-12


def test_laws_from_one_inclination_are_listed_and_not_told_apart():
    with warnings.catch_warnings(action="ignore"):
        found = sc.data.fit_stop(COIN, None, "20deg", [2.0, 2.1, 1.9, 2.2])
    assert not found.told_apart and "one inclination cannot show which law holds" in found.table()
    assert {fit.daic for fit in found.fits} == {0.0}
