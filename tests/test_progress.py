"""How far long work is: a bar that somebody can see, after two seconds, and a function otherwise."""

import io
import sys
import threading
import warnings
from types import SimpleNamespace

import numpy as np
import pytest
from page_scenes import CYLINDER

import spincyl as sc
from spincyl._input import progress
from spincyl.cli import _output

BODIES, START = sc.Body.solid(np.linspace(0.5, 2.0, 20)), sc.State(1.3, 0.8, 0.05, 1.0)


class Stream(io.StringIO):
    def __init__(self, terminal):
        super().__init__()
        self.isatty = lambda: terminal


def err(monkeypatch, terminal=True):
    """What is written to standard error from now on."""
    stream = Stream(terminal)
    monkeypatch.setattr(sys, "stderr", stream)
    return stream


@pytest.fixture
def bars(monkeypatch):
    """The bars of all work, each with the shares that it is told."""
    made = []

    class Bar:
        def __init__(self, what, patience):
            assert patience == 2.0
            self.what, self.shares, self.closed = what, [], False
            made.append(self)

        def __call__(self, share):
            assert not self.closed
            self.shares.append(share)

        def close(self):
            self.closed = True

    monkeypatch.setattr(progress, "_Bar", Bar)
    return made


def told(*given, after=3.0, monkeypatch, **how):
    """What is written while half of the work is done, after some seconds."""
    clock = iter([0.0])
    with monkeypatch.context() as patch:
        patch.setattr(progress, "time", SimpleNamespace(monotonic=lambda: next(clock, after)))
        with progress.reporting_progress(*given, "work", **how) as tells:
            if tells:
                tells(0.5)
            said = sys.stderr.getvalue()
    return said


def test_after_two_seconds_a_bar_is_on_a_terminal_and_goes_when_the_work_is_done(monkeypatch):
    terminal = err(monkeypatch)
    said = told(None, monkeypatch=monkeypatch)
    assert "spincyl work:  50%" in said and "00:03<00:03" in said
    after = terminal.getvalue()[len(said) :]
    assert "%" not in after and after.endswith("\r") and len(after) > 20, "it is cleared"


def test_short_work_pipes_other_threads_and_the_silenced_see_no_bar(monkeypatch):
    err(monkeypatch)
    assert told(None, after=1.9, monkeypatch=monkeypatch) == ""
    assert told(False, monkeypatch=monkeypatch) == ""
    assert told(None, by_default=False, monkeypatch=monkeypatch) == ""
    seen = []
    thread = threading.Thread(target=lambda: seen.append(told(None, monkeypatch=monkeypatch)))
    thread.start()
    thread.join()
    assert seen == [""]
    err(monkeypatch, terminal=False)
    assert told(None, monkeypatch=monkeypatch) == ""
    assert "50%" in told(True, after=0.1, monkeypatch=monkeypatch), "asked for, at once"
    monkeypatch.setattr(sys, "stderr", None)
    with progress.reporting_progress(None, "work") as tells:
        assert tells is None


def test_a_notebook_is_told_without_a_terminal(monkeypatch):
    err(monkeypatch, terminal=False)
    for shell, seen in ((SimpleNamespace(kernel=object()), True), (SimpleNamespace(), False), (None, False)):
        monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda shell=shell: shell))
        with progress.reporting_progress(None, "work") as tells:
            assert (tells is not None) is seen


def test_work_within_work_has_no_bar_of_its_own(monkeypatch):
    err(monkeypatch)
    with progress.reporting_progress(None, "outer") as outer:
        with progress.reporting_progress(None, "inner") as inner:
            assert outer is not None and inner is None
        with _output.Working("roll"), progress.reporting_progress(None, "inner") as inner:
            assert inner is None
    with _output.Working("roll"), progress.reporting_progress(None, "inner") as inner:
        assert inner is None
    with progress.reporting_progress(None, "again") as again:
        assert again is not None


def test_without_tqdm_there_is_no_bar(monkeypatch):
    err(monkeypatch)
    monkeypatch.setitem(sys.modules, "tqdm", None)
    with progress.reporting_progress(None, "work") as tells:
        assert tells is None


def fit():
    disk, t, laws = sc.Body.solid(0.05), np.linspace(0.0, 20.0, 12), [sc.loss.DryContour, sc.loss.AirLinear]
    theta = sc.drift(disk, 0.3, sc.loss.DryContour(1e-3)).theta(t)
    return sc.data.fit_losses(t, theta, body=disk, laws=laws)


def film(folder):
    view = sc.view(sc.roll(CYLINDER, CYLINDER.steady(1.3), 0.2), slow=1)
    return view.save(folder / "film.gif", size=(64, 64))


LONG = {
    "film": film,
    "page": lambda _: sc.view(*[sc.roll(CYLINDER, CYLINDER.steady(x), 1.0) for x in (1.2, 1.3)]),
    "sweep": lambda _: sc.sweep.roll(BODIES, START, 2.0),
    "map": lambda _: sc.sweep.portrait(np.linspace(0.1, 1.5, 50), [1.0]),
    "survey": lambda _: sc.sweep.survey(np.linspace(0.1, 1.5, 50), [1.0], want="rate"),
    "fit": lambda _: fit(),
    "save": lambda folder: sc.sweep.save(
        sc.sweep.roll(sc.Body.solid(lazy([0.5, 1.0])), START, 2.0), folder / "store"
    ),
}


def lazy(values):
    return pytest.importorskip("dask.array").from_array(np.array(values), chunks=1)


@pytest.mark.parametrize("name", LONG)
def test_whatever_takes_long_tells_how_far_it_is(tmp_path, monkeypatch, bars, name):
    err(monkeypatch)
    LONG[name](tmp_path)
    assert all(bar.closed for bar in bars)
    assert [bar.what for bar in bars if bar.what != "page" or name == "page"] == [name]
    shares = bars[-1].shares
    assert shares == sorted(shares) and shares[-1] == 1.0


@pytest.mark.parametrize("name", LONG)
def test_in_a_pipe_there_is_no_bar(tmp_path, monkeypatch, bars, name):
    err(monkeypatch, terminal=False)
    LONG[name](tmp_path)
    assert not bars


def test_what_is_neither_a_function_nor_true_or_false_is_refused_by_name(tmp_path):
    with pytest.raises(TypeError, match="^progress: expected a function, True or False, not int"):
        sc.sweep.roll(BODIES, START, 2.0, progress=3)


def test_a_warning_in_long_work_is_still_one(monkeypatch):
    err(monkeypatch)

    def work():
        with progress.reporting_progress(True, "work") as tells:
            tells(0.5)
            warnings.warn("still heard", UserWarning, stacklevel=1)

    with pytest.warns(UserWarning, match="still heard"):
        work()
