"""Measured data: exports of Tracker are read, and the inertia ratio is fitted with its uncertainty."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import spincyl as sc
from spincyl.lab import _cells, _tracker

CYLINDER = sc.Body.solid(2.5)

ONE = "mass_A\nt\tx\ty\n0.000000000E0\t1.245986911E1\t-1.328191643E1\n3.2E-2\t\t-1.26E1\n6.4E-2\t1.0E1\t\n"
MANY = "#multi:\n\tend O\t\tend X\t\t\t\t\nt\tx\ty\tx\tv_{x}\t\n0.032\t30.47\t23.79\t-26.66\t\n0.065\t\t\t1\t2\t\n"


def read(tmp_path, text, encoding="utf-8"):
    path = tmp_path / "export.txt"
    path.write_bytes(text.encode(encoding))
    return sc.data.read_tracker(path)


def test_one_track_is_read_with_its_name_and_its_empty_cells(tmp_path):
    found = read(tmp_path, ONE)
    assert list(found) == ["mass_A"] and list(found["mass_A"]) == ["t", "x", "y"]
    assert np.array_equal(found["mass_A"]["t"], [0.0, 0.032, 0.064])
    assert np.array_equal(found["mass_A"]["x"], [12.45986911, np.nan, 10.0], equal_nan=True)
    assert np.array_equal(found["mass_A"]["y"], [-13.28191643, -12.6, np.nan], equal_nan=True)


def test_several_tracks_share_the_time_and_keep_their_own_columns(tmp_path):
    found = read(tmp_path, MANY)
    assert list(found) == ["end O", "end X"]
    assert list(found["end O"]) == ["t", "x", "y"] and list(found["end X"]) == ["t", "x", "v_{x}"]
    assert np.array_equal(found["end X"]["x"], [-26.66, 1.0])
    assert np.array_equal(found["end O"]["y"], [23.79, np.nan], equal_nan=True)
    assert np.array_equal(found["end O"]["t"], found["end X"]["t"])


@pytest.mark.parametrize(
    ("delimiter", "comma"),
    [("\t", False), ("\t", True), (";", False), (";", True), (",", False), ("  ", False), ("  ", True)],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_delimiter_decimal_sign_and_encoding_are_found_out(tmp_path, delimiter, comma, encoding):
    rows = ["masse_é", "t{0}x{0}θ".replace("θ", "y"), "0.5{0}-1.25E1{0}3", "1.5{0}2{0}4.75"]
    text = "\r\n".join(row.replace(".", ",") if comma else row for row in rows).format(delimiter)
    track = read(tmp_path, text, encoding)["masse_é"]
    assert [track[name].tolist() for name in "txy"] == [[0.5, 1.5], [-12.5, 2.0], [3.0, 4.75]]


def test_a_table_without_a_name_and_blank_lines_is_read(tmp_path):
    found = read(tmp_path, "\n\nt,x\n\n0,1\n1,NaN\n")
    assert list(found) == ["track"] and np.isnan(found["track"]["x"][1])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "no line of column names"),
        ("t\tx\n", "no line of column names"),
        ("0\t1\n1\t2\n", "no line of column names"),
        ("t\tx\n0\t1\n1\tmuch\n", "line 3"),
        ("t,x,y\n0,5,1,5,2,5\n", "line 2 has 6 cells under 3"),
        ("#multi:\n\ta\ta\nt\tx\tx\n0\t1\t2\n", "two tracks"),
        ("a\nt\tx\tx\n0\t1\t2\n", "two columns"),
        ("t\tx\n0\t1_000\n", "has the text .1_000. in the column"),
        ("<html>\n<p>1 2</p>\n", "not a table"),
    ],
)
def test_what_is_no_table_is_refused_with_file_and_line(tmp_path, text, said):
    with pytest.raises(ValueError, match=said) as caught:
        read(tmp_path, text)
    assert "export.txt" in str(caught.value)


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
def test_torn_utf_16_names_the_file_and_the_byte(tmp_path, encoding):
    path = tmp_path / "export.txt"
    mark = "\ufeff".encode(encoding)
    for torn in (
        ONE.encode(encoding)[:-1],
        ONE.encode(encoding) + "\ud800".encode(encoding, "surrogatepass"),
    ):
        path.write_bytes(mark + torn)
        with pytest.raises(ValueError, match=r"export.txt: invalid UTF-16 at byte \d+ of \d+$"):
            sc.data.read_tracker(path)


@pytest.mark.parametrize("quote", ["", '"'])
def test_a_cell_of_any_length_is_read_or_refused_with_its_line(tmp_path, quote):
    name, zeros = 200_000 * "x", 150_000 * "0"
    assert list(read(tmp_path, f"a\nt\t{name}\n0\t1\n")["a"]) == ["t", name]
    with pytest.raises(ValueError, match="export.txt: .*line 4 has a cell that is not a number") as caught:
        read(tmp_path, f"a\nt\tx\n0\t1\n1\t{quote}{name}{quote}\n")
    assert len(str(caught.value)) < 1000
    if not quote:
        assert read(tmp_path, f"a\nt\tx\n0\t1{zeros}e-150000\n")["a"]["x"].tolist() == [1.0]


NUMBERS = st.floats(allow_infinity=False).map(repr) | st.sampled_from(
    ["", " ", " 1.5 ", "-2E3", "1e400", "1_0", "x"]
)


@given(st.lists(st.lists(NUMBERS, min_size=1, max_size=4), min_size=1, max_size=6), st.booleans())
def test_the_quick_reader_gives_what_the_careful_one_does_or_nothing(rows, comma):
    for delimiter in ("\t", ";", None):
        lines = [(delimiter or " ").join(row).replace(".", "," if comma else ".") for row in rows]
        lines = [line for line in lines if line.strip()]
        if not lines:
            continue
        careful = [_cells.numbers_in(line, delimiter, comma) for line in lines]
        quick = _tracker._table_by_numpy(lines, delimiter, comma, 4)
        if quick is not None:
            assert np.array_equal(quick, [x + [np.nan] * (4 - len(x)) for x in careful], equal_nan=True)
        elif delimiter == "\t":
            odd = any(x is None or len(x) > 4 for x in careful) or any(
                cell.isspace() for row in rows for cell in row
            )
            assert odd


def test_the_lines_of_a_long_table_are_read_together_and_not_one_by_one(tmp_path, monkeypatch):
    rng = np.random.default_rng(10)
    numbers = [[f"{x:.9E}" for x in row] for row in rng.normal(size=(60_000, 3))]
    plain = "t\tx\ty\n" + "\n".join("\t".join(row) for row in numbers)
    gaps = "t;x;y;\n" + "\n".join(";".join(row[: 1 + k % 3]) + ";" for k, row in enumerate(numbers)).replace(
        ".", ","
    )
    one_by_one, calls = _tracker.numbers_in, []
    monkeypatch.setattr(_tracker, "numbers_in", lambda *given: calls.append(given) or one_by_one(*given))
    for text in (plain, gaps):
        path = tmp_path / "long.txt"
        path.write_text(text)
        (found,) = sc.data.read_tracker(path).values()
        assert len(found["t"]) == 60_000
        assert 0 < len(calls) < 100, "some lines tell the format"
        calls.clear()


def test_quoted_cells_keep_their_commas(tmp_path):
    assert read(tmp_path, 'a\n"t","x"\n"0.5","1"\n"1.5","2"\n')["a"]["t"].tolist() == [0.5, 1.5]


def test_a_missing_file_is_an_os_error(tmp_path):
    with pytest.raises(OSError, match="nowhere"):
        sc.data.read_tracker(tmp_path / "nowhere.txt")


def test_a_film_of_both_ends_gives_inclination_and_rate(tmp_path):
    # a steady tube as tracked by a camera at the side and one above
    pipe, scale = sc.Body.tube(6.0, bore=0.8), sc.Scale(radius=7.9375e-3)
    state = pipe.steady(np.radians(80))
    seconds = np.arange(40) / 240
    m = sc.roll(pipe, state, np.r_[0.0, seconds[1:] / scale.seconds(1.0)], want="pose")
    axis = np.column_stack([-np.sin(m.theta) * np.cos(m.phi), -np.sin(m.theta) * np.sin(m.phi)])
    ends = [m.centre[:, :2] + sign * 6 * axis for sign in (1, -1)]
    lines = ["multi:", "\tO\t\tX\t", "t\tx\ty\tx\ty"]
    for row in zip(seconds, *ends[0].T, *ends[1].T, strict=True):
        lines.append("\t".join(f"{x:.9E}".replace(".", ",") for x in row))
    tracks = read(tmp_path, "\n".join(lines))
    x, y = (tracks["O"][k] - tracks["X"][k] for k in "xy")
    hertz = np.polyfit(tracks["O"]["t"], np.unwrap(np.arctan2(y, x)), 1)[0] / (2 * np.pi)
    assert hertz / scale.hertz(pipe, 1.0) == pytest.approx(pipe.rate(np.radians(80)), rel=1e-6)
    assert np.arcsin(np.hypot(x, y) / 12) == pytest.approx(np.radians(80), rel=1e-6)


# compare


def measured(body, rng, noise=0.01):
    """Points of both branches with errors of theta and rate, and the standard errors."""
    edges = sorted([float(body.theta_balance), float(body.theta_limit)])
    theta = np.r_[rng.uniform(0.08, 0.8 * edges[0], 6), rng.uniform(edges[1] + 0.1, 1.5, 10)]
    rate = body.rate(theta)
    rate_err = 2 * noise * rate
    found = rng.normal(theta, noise).clip(1e-3, np.pi / 2), rng.normal(rate, rate_err)
    return *found, noise, rate_err


def test_exact_points_give_the_bodys_own_inertia_ratio():
    rng = np.random.default_rng(1)
    for body in (CYLINDER, sc.Body.solid(0.375), sc.Body.tube(6.0, 0.8), sc.Body(1.2, 0.7, 0.5)):
        theta, rate, *_ = measured(body, rng, noise=1e-14)
        found = sc.data.compare(body, theta, rate)
        assert found.ratio == pytest.approx(body.i1 / body.i3, rel=1e-9) == found.expected
        assert np.abs(found.residual).max() < 1e-9


def test_another_ratio_is_found_from_a_wrong_belief():
    true = sc.Body(2.5, 1.1 * CYLINDER.i1, CYLINDER.i3)
    theta, rate, theta_err, rate_err = measured(true, np.random.default_rng(2), 1e-3)
    found = sc.data.compare(CYLINDER, theta, rate, theta_err=theta_err, rate_err=rate_err)
    assert found.ratio == pytest.approx(1.1 * found.expected, abs=5 * found.ratio_err)
    assert found.ratio_err < 0.005 * found.ratio
    assert found.fitted.i1 / found.fitted.i3 == pytest.approx(found.ratio)


@pytest.mark.parametrize(
    "known",
    [
        pytest.param(True, marks=pytest.mark.long, id="errors known"),
        pytest.param(False, id="from the scatter"),
    ],
)
def test_the_uncertainty_is_that_of_many_repetitions(known):
    rng = np.random.default_rng(3)
    pulls, chi2 = [], []
    for _ in range(120):
        theta, rate, theta_err, rate_err = measured(CYLINDER, rng, np.radians(1.0))
        errors = {"theta_err": theta_err, "rate_err": rate_err} if known else {}
        found = sc.data.compare(CYLINDER, theta, rate, **errors)
        pulls.append((found.ratio - found.expected) / found.ratio_err)
        chi2.append(found.chi2)
    # 120 standard normal numbers: standard errors are 0.065 for the spread and 0.09 for the mean
    assert 0.8 < np.std(pulls) < 1.25 and abs(np.mean(pulls)) < 0.35
    if known:
        assert 0.85 < np.mean(chi2) < 1.15


def test_a_coins_ratio_of_one_half_is_found_on_either_side():
    coin, rng = sc.Body.solid(0.0), np.random.default_rng(9)
    theta = np.radians([5.0, 10.0, 20.0, 30.0, 45.0])
    found = []
    for _ in range(20):
        measured_rate = coin.rate(theta) * rng.normal(1, 0.01, 5)
        errors = {"theta_err": 1e-4, "rate_err": 0.01 * measured_rate}
        found.append(sc.data.compare(coin, theta, measured_rate, **errors))
        assert found[-1].fitted.i1 >= 0.25
    ratios = np.array([f.ratio for f in found])
    assert ratios.min() < 0.5 < ratios.max() and abs(ratios.mean() - 0.5) < 4 * found[0].ratio_err / np.sqrt(
        20
    )


def test_points_inside_the_forbidden_band_have_no_residual_but_count():
    theta, rate, theta_err, rate_err = measured(CYLINDER, np.random.default_rng(4))
    inside = (CYLINDER.theta_limit - 0.005, 3.0)
    found = sc.data.compare(
        CYLINDER,
        np.r_[theta, inside[0]],
        np.r_[rate, inside[1]],
        theta_err=theta_err,
        rate_err=np.r_[rate_err, 0.1],
    )
    assert np.isnan(found.residual[-1]) and np.isfinite(found.ratio) and len(found.theta) == 17


def test_a_residual_is_what_was_measured_less_what_the_body_does():
    theta = np.radians([5.0, 10.0, 70.0, 80.0])
    found = sc.data.compare(CYLINDER, theta, CYLINDER.rate(theta) + 0.01)
    assert np.allclose(found.residual, 0.01)


def test_without_known_errors_the_scatter_of_the_points_decides():
    rng = np.random.default_rng(8)
    theta, rate, *_ = measured(CYLINDER, rng, 1e-4)
    given = sc.data.compare(CYLINDER, theta, rate, theta_err=np.radians(1.0), rate_err=0.02 * rate)
    found = sc.data.compare(CYLINDER, theta, rate)
    # the points scatter a hundred times less than their assumed errors
    assert found.ratio_err == pytest.approx(given.ratio_err * np.sqrt(given.chi2), rel=1e-3)
    assert found.ratio_err < 0.03 * given.ratio_err


def test_what_says_nothing_of_the_ratio_is_refused_and_what_fits_badly_is_warned_of():
    theta, rate, *_ = measured(CYLINDER, np.random.default_rng(7))
    upright = np.full(5, np.pi / 2)
    for wrong, said in (
        ((upright, [1.0, 1.01, 0.99, 1.02, 0.98]), "do not determine"),
        (([0.2] * 5, [1.0] * 5), "three different"),
        ((theta, -rate), "rate"),
        ((theta, 0 * rate), "rate"),
        ((theta, 1e200 * rate), "rate"),
    ):
        with pytest.raises(ValueError, match=said):
            sc.data.compare(CYLINDER, *wrong)
    with pytest.raises(TypeError, match="theta"):
        sc.data.compare(CYLINDER, None, rate)
    forbidden = np.radians([30, 35, 40, 50, 55]), np.full(5, 0.5)
    for points in ((theta, 6.2 * rate), forbidden):
        with pytest.warns(UserWarning, match="chi2"):
            sc.data.compare(CYLINDER, *points)
    with pytest.raises(ValueError, match="no real body has"):
        sc.data.compare(CYLINDER, *forbidden, theta_err=1e-3, rate_err=1e-3)
    assert repr(sc.data.compare(CYLINDER, theta, rate)).startswith("<Comparison: I1/I3 = 4.")


def test_a_name_keeps_its_spaces_and_commas(tmp_path):
    for text in ("mass A\nt x y\n0 1 2\n1 2 3\n", "mass A\nt,x,y\n0,1,2\n1,2,3\n"):
        assert list(read(tmp_path, text)) == ["mass A"]
    assert list(read(tmp_path, "ball, red\nt,x,y\n0,1,2\n")) == ["ball, red"]


def test_empty_cells_are_left_out_and_what_makes_no_sense_is_refused():
    theta, rate, *_ = measured(CYLINDER, np.random.default_rng(5))
    theta[3], rate[7] = np.nan, np.nan
    assert len(sc.data.compare(CYLINDER, theta, rate).theta) == 14
    for wrong, said in (
        ((CYLINDER, theta[:2], rate[:2]), "three different points"),
        ((CYLINDER, theta, rate[:5]), "equal shapes"),
        ((CYLINDER, np.degrees(theta), rate), "radians"),
        ((sc.Body.solid([1.0, 2.0]), theta, rate), "single"),
    ):
        with pytest.raises(ValueError, match=said):
            sc.data.compare(*wrong)
    for name, wrong in (
        ("theta_err", 0.0),
        ("rate_err", np.nan),
        ("rate_err", [1.0, 2.0]),
        ("rate_err", None),
    ):
        with pytest.raises(ValueError, match=name):
            sc.data.compare(CYLINDER, theta, rate, **{"theta_err": 0.01, "rate_err": 0.01} | {name: wrong})
    with pytest.raises(TypeError, match="body"):
        sc.data.compare(2.5, theta, rate)
    with pytest.raises(TypeError, match="rate"):
        sc.data.compare(CYLINDER, theta, "fast")


def test_the_plot_has_error_bars_and_both_curves():
    import matplotlib.pyplot as plt

    theta, rate, theta_err, rate_err = measured(CYLINDER, np.random.default_rng(6))
    ax = sc.data.compare(CYLINDER, theta, rate, theta_err=theta_err, rate_err=rate_err).plot()
    assert len(ax.containers) == 1 and ax.containers[0].has_xerr and ax.containers[0].has_yerr
    assert [t.get_text() for t in ax.get_legend().get_texts()][2] == "measured"
    plt.close("all")


def test_a_number_has_the_decimals_that_its_error_leaves():
    from spincyl.lab._report import with_error

    for value, error, said in (
        (4.71434, 0.0172, "4.714 +- 0.017"),
        (0.1 + 0.2, 0.3, "0.30 +- 0.30"),
        (82.983, 12.4, "83 +- 12"),
        (6.2, 1e-15, "6.2 +- 1.0e-15"),
        (1.5, math.nan, "1.5 +- nan"),
        (1.5e-9, 1e-11, "1.5e-09 +- 1.0e-11"),
    ):
        assert with_error(value, error) == said
