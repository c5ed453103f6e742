"""Figures at the size of a slide: words are large and apart, and the numbers are those of the tables."""

import pathlib
import sys
from itertools import combinations

import matplotlib as mpl
import numpy as np
import pytest

mpl.use("agg")
import matplotlib.pyplot as plt

sys.path.append(str(pathlib.Path(__file__).parents[1] / "benches"))
sys.path.append(str(pathlib.Path(__file__).parents[1] / "benches/peers"))
import benchmarks
import figure as peers
import report

from spincyl.studio.plot import _figures

ROOT = pathlib.Path(__file__).parents[1]
PAGE = (ROOT / "docs/benchmarks.md").read_text("utf-8")


def tippe_top(path):
    drawn, ax = plt.subplots(figsize=(12.8, 7.2), layout="constrained")
    _figures._tippe_top(ax)
    _figures.saved(drawn, path)


SLIDES = {
    "peers": lambda path: peers.draw(PAGE, path),
    "speed_against_error": lambda path: report.figure(report.read(PAGE), path),
    "long_run": lambda path: benchmarks.draw(benchmarks.long_run(1e5), path),
    "tippe_top": tippe_top,
}


@pytest.fixture
def kept(monkeypatch):
    """Keeps figures open after they are drawn."""
    close = plt.close
    monkeypatch.setattr(plt, "close", lambda *_: None)
    yield
    close("all")


def words_of(drawn):
    """The words of a figure that are seen, with their boxes in pixels."""
    drawn.canvas.draw()
    renderer, unseen = drawn.canvas.get_renderer(), set()
    for axis in (axis for ax in drawn.axes for axis in (ax.xaxis, ax.yaxis)):
        low, high = sorted(axis.get_view_interval())
        for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks()):
            if not low * (1 - 1e-9) <= tick.get_loc() <= high * (1 + 1e-9):
                unseen |= {tick.label1, tick.label2}
    texts = [text for text in drawn.findobj(mpl.text.Text) if text.get_text().strip() and text.get_visible()]
    return [(text, text.get_window_extent(renderer)) for text in texts if text not in unseen]


@pytest.mark.parametrize("name", SLIDES)
def test_a_figure_fills_a_slide_with_a_sentence_few_curves_and_large_words_that_do_not_overlap(
    name, tmp_path, kept
):
    SLIDES[name](tmp_path / "slide.png")
    drawn = plt.gcf()
    assert drawn.get_size_inches() == pytest.approx((12.8, 7.2))
    written = plt.imread(tmp_path / "slide.png")
    assert written.shape[:2] == (1080, 1920)
    words = words_of(drawn)
    assert len(words) > 8
    assert min(text.get_fontsize() for text, _ in words) >= 14
    for text, box in words:
        inside = box.x0 >= -1 and box.y0 >= -1 and box.x1 <= 1281 and box.y1 <= 721
        assert inside, f"{text.get_text()} is cut off"
    for (one, a), (other, b) in combinations(words, 2):
        apart = a.x1 <= b.x0 + 1 or b.x1 <= a.x0 + 1 or a.y1 <= b.y0 + 1 or b.y1 <= a.y0 + 1
        assert apart, (one.get_text(), other.get_text())
    titles = [ax.get_title() for ax in drawn.axes if ax.get_title()]
    head = drawn.get_suptitle() or titles[0]
    assert len(head.split()) >= 6 and max(text.get_fontsize() for text, _ in words) >= 22
    assert drawn.axes[0].get_legend() is None
    curves = [line for line in drawn.axes[0].lines if np.size(line.get_xdata()) > 2]
    assert 2 <= len(curves) <= 4


@pytest.mark.parametrize("name", SLIDES)
def test_the_figure_of_the_page_is_as_large_as_a_slide(name):
    assert plt.imread(ROOT / f"docs/figures/{name}.png").shape[:2] == (1080, 1920)


def test_the_rows_that_are_read_from_the_page_are_those_that_were_written(monkeypatch):
    monkeypatch.setattr(report, "costs", lambda: [])
    rows = report.read(PAGE)
    assert [(row.scene.name, row.scene.t) for row in rows] == [(x.name, x.t) for x in report.scenes()]
    for line in report.table(rows).split("Time that RK4")[0].splitlines():
        assert line in PAGE
    points = rows[0].curves["RK4, fixed step"]
    assert (points[0].setting, points[0].error) == (0.04, 3.5e-9) and len(points) == 14
    assert points[0].seconds == pytest.approx(59.9e-6)


def test_the_figure_of_other_programs_has_the_smallest_error_of_each_job_in_the_page():
    found = peers.ratios(PAGE)
    assert len(found) == len(peers.JOBS), "a job of the figure is not in the table"
    assert found["rolling, it hardly nods"] == 20.9 and found["slipping until it rolls"] == 0.826
    curves = peers.curves(PAGE)
    assert set(curves) == set(peers.PROGRAMS)
    for points in curves.values():
        assert len(points) >= 3 and (np.diff([error for error, _ in points]) <= 0).all()
    assert curves["spincyl"][-1] == (2.3e-14, 0.599)
