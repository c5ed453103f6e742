"""Figures and the command line."""

import subprocess
import sys
from itertools import combinations

import matplotlib as mpl
import numpy as np
import PIL.Image
import pytest

import spincyl as sc
from spincyl.cli import main
from spincyl.studio.plot import _style

mpl.use("agg")
import matplotlib.pyplot as plt


@pytest.fixture(autouse=True)
def closed_figures():
    yield
    plt.close("all")


def test_branches_are_solid_where_stable_and_dashed_where_not():
    _, ax = plt.subplots()
    assert sc.plot.branches([2.5], contact="smooth", ax=ax) is ax
    body, seen = sc.Body.solid(2.5), set()
    for line in ax.get_lines():
        rate, theta = line.get_xdata(), np.radians(line.get_ydata())
        if len(rate) < 5:
            continue
        inside = slice(1, -1)
        assert np.allclose(body.rate(theta)[inside], rate[inside], rtol=1e-9)
        stable = body.stable(theta[inside], "smooth")
        assert stable.all() if line.get_linestyle() == "-" else not stable.any()
        seen.add(line.get_linestyle())
    assert seen == {"-", "--"}
    assert {t.get_text() for t in ax.texts} >= {*"A B C D F G forbidden stable unstable".split()}


def test_branches_of_bodies_are_their_own():
    tube = sc.Body.tube(6.0, bore=0.8)
    by_name, by_body = sc.plot.branches([6.0], bore=0.8), sc.plot.branches([tube])
    for a, b in zip(by_name.get_lines(), by_body.get_lines(), strict=True):
        assert np.array_equal(a.get_xydata(), b.get_xydata(), equal_nan=True)
    assert by_name.get_title() == by_body.get_title()
    both = sc.plot.branches([6.0, tube])
    assert [t.get_text() for t in both.get_legend().get_texts()] == [
        r"$\ell = 6$, bore 0",
        r"$\ell = 6$, bore 0.8",
    ]
    with pytest.raises(ValueError, match="^ells: expected single bodies"):
        sc.plot.branches([sc.Body.solid([1.0, 2.0])])


def test_the_landmarks_are_where_the_body_says():
    body = sc.Body.solid(0.25)
    points = {p.letter: p for p in sc.plot.landmarks(body, "rolling")}
    assert points["A"].theta == body.theta_balance and points["E"].theta == body.folds()[0]
    assert points["E"].rate == body.rate(points["E"].theta)
    critical = sc.Body.solid(sc.Body.critical_aspect())
    assert {p.letter for p in sc.plot.landmarks(critical, "rolling")} == {"A", "B", "C", "D", "G"}


def test_the_critical_body_is_steady_at_every_rate():
    ax = sc.plot.branches([sc.Body.critical_aspect()], contact="rolling")
    flat = [line for line in ax.get_lines() if len(line.get_xdata()) > 5 and np.ptp(line.get_ydata()) == 0]
    assert sorted(line.get_linestyle() for line in flat) == ["-", "--"]
    threshold = next(line for line in flat if line.get_linestyle() == "-").get_xdata()[0]
    assert threshold == pytest.approx((7 / 81) ** 0.25, abs=2e-3)


def test_the_map_is_coloured_by_region_also_from_a_sweep():
    ell = np.linspace(0, 2, 50)
    data = sc.sweep.portrait(np.linspace(0.01, 1.57, 40), ell, want=["region"])
    ax = sc.plot.portrait(data)
    assert np.array_equal(ax.get_images()[0].get_array(), data["region"].values)
    assert "stable only when rolling" in [t.get_text() for t in ax.get_legend().get_texts()]
    one = sc.plot.portrait(contact="rolling")
    assert [t.get_text() for t in one.get_legend().get_texts()][:3] == ["forbidden", "unstable", "stable"]


def test_the_curves_of_a_map_of_rounded_tubes_are_theirs():
    ax = sc.plot.portrait(fillet=0.2, ell_max=2.0)
    assert ax.get_xlim() == (0.2, 2.0) and "fillet 0.2" in ax.get_title()
    balanced = next(line for line in ax.lines if "balanced" in line.get_label())
    ell, theta = balanced.get_data()
    assert np.allclose(theta, np.degrees(np.arctan2(0.8, ell - 0.2)), rtol=1e-12)
    (image,) = ax.images  # the image of the regions changes at the curve
    region, column = np.asarray(image.get_array()), 350
    row = np.argmax(region[:, column] == sc.Region.FORBIDDEN)
    half = np.linspace(0.2, 2.0, 701)[column]
    edge = np.degrees(np.linspace(0, np.pi / 2, 701)[1:][row])
    expected = sc.Body.solid(half, fillet=0.2)
    assert edge == pytest.approx(np.degrees(min(expected.theta_balance, expected.theta_limit)), abs=0.13)


def grey(colour):
    """Luma of a colour, as a printer without colours shows it."""
    return float(np.dot(colour[:3], (0.299, 0.587, 0.114)))


def lightness(colour):
    """L* of a colour: CIE 1976, from the luminance of sRGB (IEC 61966-2-1)."""
    signal = np.array(mpl.colors.to_rgb(colour))
    linear = np.where(signal <= 0.04045, signal / 12.92, ((signal + 0.055) / 1.055) ** 2.4)
    luminance = linear @ (0.2126, 0.7152, 0.0722)
    if luminance <= (6 / 29) ** 3:
        return (29 / 3) ** 3 * luminance
    return 116 * luminance ** (1 / 3) - 16


def test_the_regions_of_a_map_differ_in_lightness_by_six_and_from_the_ink_of_its_lines_by_thirty():
    assert lightness("white") == pytest.approx(100) and lightness("black") == 0
    assert lightness("#777777") == pytest.approx(50.03, abs=0.01)  # the middle grey of tables of sRGB
    regions = sorted(map(lightness, _style.HATCHES))
    assert len(regions) == 5 and np.diff(regions).min() > 6
    # Words and lines of the figures, and the hatching, are darker than the darkest region.
    assert lightness(_style.BLACK) < regions[0] - 30 and lightness(_style.HATCH) < regions[0] - 15
    # what a printer without colours prints has the same steps
    data = np.arange(5.0)[np.newaxis]
    drawn = plt.figure(figsize=(5, 1), dpi=50)
    ax = drawn.add_axes((0, 0, 1, 1))
    ax.axis("off")
    ax.imshow(data, aspect="auto", cmap=mpl.colors.ListedColormap(list(_style.HATCHES)))
    drawn.canvas.draw()
    printed = PIL.Image.fromarray(np.asarray(drawn.canvas.buffer_rgba())).convert("L")
    greys = [lightness((x / 255,) * 3) for x in sorted(np.asarray(printed)[25, 25::50].tolist())]
    assert len(greys) == 5 and np.diff(greys).min() > 6


def test_a_map_of_energy_gets_lighter_with_the_energy_and_what_is_forbidden_is_hatched():
    ax = sc.plot.energy()
    bands = next(drawn for drawn in ax.collections if drawn.get_array() is not None)
    shown = [lightness(colour[:3]) for colour in bands.get_facecolor()]
    assert len(shown) > 10 and (np.diff(shown) > 1).all()
    assert ax.patch.get_hatch() == _style.HATCHES[_style.FORBIDDEN]


def test_every_region_has_a_look_also_without_colours_and_the_legend_names_those_that_are_there():
    import xarray

    codes = np.array([[1, 4, 5], [6, 7, 7]])
    data = xarray.Dataset(
        {"region": (("theta", "ell"), codes)},
        {"theta": [0.5, 1.0], "ell": [0.5, 1.0, 1.5], "bore": 0.0},
    )
    for contact, name in (
        (None, "stable only on a smooth table"),
        ("smooth", "stable"),
        ("rolling", "unstable"),
    ):
        ax = sc.plot.portrait(data, contact=contact)
        colour = ax.get_images()[0].cmap(6)
        legend = ax.get_legend()
        shown = dict(zip([t.get_text() for t in legend.get_texts()], legend.get_patches(), strict=False))
        assert shown[name].get_facecolor() == colour != (1, 1, 1, 1)
    for ax in (sc.plot.portrait(data), sc.plot.portrait()):
        looks = [(grey(x.get_facecolor()), x.get_hatch()) for x in ax.get_legend().get_patches()]
        assert all(abs(a[0] - b[0]) > 0.15 or a[1] != b[1] for a, b in combinations(looks, 2))
        hatched = {h for drawn in ax.collections for h in getattr(drawn, "hatches", [])}
        assert hatched == {hatch for _, hatch in looks if hatch}
    whole = [t.get_text() for t in sc.plot.portrait().get_legend().get_texts()]
    assert "stable only on a smooth table" not in whole and "stable only when rolling" in whole


def test_the_drawing_of_the_symbols_names_every_angle_axis_and_point():
    ax = sc.plot.frame()
    words = " ".join(text.get_text() for text in ax.texts)
    for symbol in (
        r"\theta",
        r"\varphi",
        r"\psi$",
        r"{e}_1",
        r"{e}_2",
        r"{e}_3",
        "$O$",
        "$X$",
        "contact point $P$",
    ):
        assert symbol in words
    assert sum(line.get_marker() == "o" for line in ax.lines) == 4 and ax.get_aspect() == 1


@pytest.mark.long
def test_figures_are_written(tmp_path):
    told = []
    paths = sc.plot.figures(tmp_path / "new" / "folder", slides=True, progress=told.append)
    assert len(paths) == 19 and all(p.stat().st_size > 20_000 for p in paths)
    assert {plt.imread(p).shape[:2] for p in paths} == {(1080, 1920)}
    assert not plt.get_fignums() and len(told) == 19 and told[-1] == 1.0


@pytest.mark.parametrize(("suffix", "start"), [(".svg", b"<?xml"), (".pdf", b"%PDF"), (".png", b"\x89PNG")])
def test_a_picture_is_what_its_suffix_says_and_a_slide_is_16_to_9(tmp_path, suffix, start):
    picture = tmp_path / f"portrait{suffix}"
    assert main(["portrait", "-o", str(picture), "--points", "50", "--slides"]) == 0
    assert picture.read_bytes().startswith(start)
    if suffix == ".png":
        assert plt.imread(picture).shape[:2] == (1080, 1920)
    with pytest.raises(ValueError, match="suffix = '.gif': expected '.png', '.pdf' or '.svg'"):
        sc.plot.figures(tmp_path, suffix=".gif")


def test_steady_prints_natural_and_si_numbers(capsys):
    assert (
        main(
            "steady --ell 6 --bore 0.8 --radius 7.9375e-3 --mass 0.02 --theta 85deg 1.4 --rate 2 --hertz 20".split()
        )
        == 0
    )
    out = capsys.readouterr().out
    assert "Body.tube(6.0, bore=0.8)" in out and "6.17777 Hz" in out and "5.89 a turn" in out
    assert out.count("rolling  ") == 6 and "J" in out and "20 turns/s" in out
    assert main(["steady", "--outer", "0.0751", "--length", "0.0128", "--rate", "1.1", "0.8"]) == 0
    out = capsys.readouterr().out
    assert "0 steady inclinations" in out and "1 steady inclination\n" in out and "unstable, growth" in out
    assert main(["steady", "--ell", "1.2", "--i1", "0.7", "--i3", "0.5", "--theta", "1.2rad"]) == 0
    assert "Body(ell=1.2, i1=0.7, i3=0.5)" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--theta 1", "no body"),
        ("--ell -1", "0 <= ell"),
        ("--ell 2.5 --theta 40deg", "forbidden"),
        ("--ell 1 --i1 2", "both --i1 and --i3"),
        ("--ell 1 --i1 2 --i3 1 --bore 0.5", "not both"),
        ("--outer 1", "--outer and --length"),
        ("--ell 1 --outer 1 --length 1", "leave out --ell"),
        ("--ell 1 --hertz 3", "--hertz needs --radius"),
        ("--ell 1 --rate -1", "expected 0 <= rate"),
        ("--ell 1 --radius 0", "radius"),
        ("--ell 1 --mass 2", "need --radius"),
    ],
)
def test_a_wrong_question_is_answered_on_stderr_with_status_2(capsys, words, said):
    assert main(["steady", *words.split()]) == 2
    captured = capsys.readouterr()
    assert said in captured.err and captured.err.startswith("spincyl steady: ")


def test_the_command_runs_and_teaches(tmp_path, capsys):
    words = [sys.executable, "-m", "spincyl", "steady", "--help"]
    taught = " ".join(subprocess.run(words, capture_output=True, text=True, check=True).stdout.split())
    assert "85deg" in taught and "stands on its face" in taught

    def run(*words):
        try:
            status = main(words)
        except SystemExit as ended:
            status = ended.code
        return status, *capsys.readouterr()

    status, told, _ = run("--version")
    assert status == 0 and told.startswith("spincyl ")
    status, _, told = run("steady", "--ell", "2.5", "--theta", "steep")
    assert status == 2 and "argument --theta: 'steep': expected a number" in told
    picture = tmp_path / "portrait.png"
    assert run("portrait", "-o", str(picture), "--points", "200")[0] == 0
    assert picture.stat().st_size > 20_000
    status, _, told = run("portrait", "-o", str(tmp_path / "no" / "folder.png"), "--points", "20")
    assert status == 1 and "folder.png" in told
    assert run("portrait", "-o", "x.png", "--points", "1")[0] == 2
    assert "bore = 2.0" in run("portrait", "-o", "x.png", "--bore", "2")[2]
    assert "--ell-max -1.0" in run("portrait", "-o", "x.png", "--ell-max", "-1")[2]
    assert run("figures", str(picture))[0] == 1
