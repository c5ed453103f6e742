"""The options of a motion in one table: each place that takes them knows all of them, or there is a reason."""

import argparse
import inspect
import re
from pathlib import Path
from typing import NamedTuple, get_overloads

import pytest

import spincyl as sc
from spincyl import _asked, _core, _roll
from spincyl.cli import _options
from spincyl.studio.pages.joined import text

ROOT = Path(__file__).parents[1]


class Row(NamedTuple):
    """How an option is called in a place, in words with spaces between; or after "none:" why it is not there."""

    roll: str
    stone: str
    sweep: str
    core: str
    rust: str
    command: str
    page: str


_STONE = "none: a stone has no first integrals and no fixed step"
_ALL = "none: a sweep begins at time 0"
_START = "none: it belongs to the start of a motion"
_PAGE = "none: the page computes in one way"
OPTIONS = {
    "t0": Row("t0", "t0", _ALL, "t0", _START, "none: the command begins at time 0", "none: a page begins at 0"),
    "step": Row("step", _STONE, "step", "step", "method", "--step", _PAGE),
    "tol": Row("tol", "tol", "tol", "tol", "method tol", "--tol", _PAGE),
    "method": Row("method", _STONE, "none: step= says it", "none: step and tol say it", "method", "none: --step", _PAGE),
    "contact": Row(
        "contact", "contact", "contact", "table coefficients friction face", "table face",
        "--contact --static --patch --face --viscosity", "contact: contact mu patch c",
    ),
    "mu": Row("mu", "mu", "mu", "coefficients", "table", "--mu", "none: a page shows the friction that rolling needs"),
    "want": Row(
        "want", "want", "want", "pose force spread", "pose force", "none: -o writes all of them",
        "none: a page computes what it shows",
    ),
    "beyond": Row("beyond", "beyond", "beyond", "beyond", "beyond", "--beyond", "none: a page ends with the model"),
    "restitution": Row(
        "restitution", "restitution", "restitution", "restitution impact_law", "restitution impact_law",
        "none: `spincyl flick` has it, whose motions need it", "restitution: restitution",
    ),
    "losses": Row("losses", "losses", "losses", "losses couple drive", "losses", "--loss", "losses: law loss"),
    "table": Row(
        "table", "table", "table", "slope turning heading place", "slope turning",
        "none: the command has level tables", "table: slope phi0",
    ),
    "max_nfev": Row(
        "max_nfev", "max_nfev", "max_nfev", "max_nfev", "max_evaluations", "none: Ctrl-C ends a command",
        "none: a page computes as long as it is shown",
    ),
    "stop_at": Row(
        "none: `Motion.phases` tells the time", "none: `Motion.phases` tells the time", "stop_at", "stop_at_rolling",
        "stop_at_rolling", "none: the command prints the phases", "none: a page goes on",
    ),
    "errors": Row(
        "none: one motion always tells its error", "none: one motion always tells its error", "errors", "errors",
        "errors", "none: one motion always tells its error", "none: a page shows no errors of states",
    ),
    "slip": Row("none: of the state", "none: of the state", "none: of the states", "slip", _START, "none: of the state",
                "none: of the state"),
    "aloft": Row("none: of the state", "none: of the state", "none: of the states", "aloft", _START,
                 "none: of the state", "none: of the state"),
}  # fmt: skip
#: What the same places take besides: bodies, states, times, and how the work is done.
BESIDES = {
    "roll": {"body", "state", "t"},
    "stone": {"body", "state", "t"},
    "sweep": {"bodies", "states", "t", "threads", "progress"},
    "core": {"circles", "while_slipping"},  # of the body and of a law
    "rust": {"times", "resistance"},
    "command": {"--t", "--points"},
    "page": {"body", "theta", "state", "kick", "t", "slow", "friction", "title", "language"},
}


def parameters(function):
    return {*inspect.signature(function).parameters}


def flags():
    """The options of `spincyl roll` in its group of the motion."""
    parser = argparse.ArgumentParser()
    _options._roll_options(parser)
    (group,) = (x for x in parser._action_groups if x.title == "the motion")
    return {max(action.option_strings, key=len) for action in group._group_actions}


def fields(file, name):
    """The public fields of a struct of Rust."""
    (body,) = re.findall(
        rf"pub struct {name}(?:<[^>]*>)? \{{(.*?)\n\}}", (ROOT / file).read_text("utf-8"), re.S
    )
    return {*re.findall(r"^    pub (\w+):", body, re.M)}


def known(place):
    """The names of a place, from its code."""
    if place == "roll":
        return parameters(sc.roll)
    if place == "stone":
        stone, body = get_overloads(_roll.roll)
        assert parameters(body) == parameters(sc.roll), "the overload of bodies"
        return parameters(stone)
    if place == "sweep":
        return parameters(sc.sweep.roll)
    if place == "core":
        return {*_core.motion_options()}
    if place == "rust":
        return fields("src/motions/ask/mod.rs", "Ask") | fields("src/many/motions/mod.rs", "Job") - {"ask"}
    return flags() if place == "command" else parameters(sc.play)


@pytest.mark.parametrize("place", Row._fields)
def test_a_place_knows_every_option_or_there_is_a_reason(place):
    words = {name: getattr(row, place) for name, row in OPTIONS.items()}
    taken = [
        name
        for word in words.values()
        if not word.startswith("none: ")
        for name in word.split(":")[0].split()
    ]
    assert {*taken} | BESIDES[place] == known(place)
    assert all(
        len(word) > 12 for word in words.values() if word.startswith("none: ") and word != "none: --step"
    )


def test_the_page_has_the_words_of_its_options():
    (blank,) = re.findall(r"^const BLANK = \{(.*)\};$", text("play.state.js"), re.M)
    words = {*re.findall(r"(\w+): ", blank)}
    pages = [row.page for row in OPTIONS.values() if not row.page.startswith("none: ")]
    told = {word for page in pages for word in page.split(": ")[1].split()}
    assert told <= words
    assert words - told == {
        *(
            "ell",
            "bore",
            "fillet",
            "i1",
            "i3",
            "end",
            "parts",
            "stone",
            "twist",
            "bottom",
            "top",
            "height",
        ),  # the body
        *("theta", "kick", "precession", "w", "spin"),  # its state
        *("until", "slow", "radius", "mass", "gravity"),  # times and size
    }


def test_the_arguments_are_kept_and_checked_under_these_names():
    kept, checked = {*_asked.Asked._fields}, parameters(_asked.ask)
    of_roll = {name for name, row in OPTIONS.items() if not row.roll.startswith("none: ")}
    assert checked - {"state", "t"} == of_roll
    assert kept - {"times", "spread", "while_slipping"} == of_roll | {"stop_at", "errors"}


def test_the_arguments_are_kept_in_the_order_of_their_names():
    (call,) = re.findall(r" = Asked\((.*)\)$", inspect.getsource(_asked.ask), re.M)
    assert tuple(call.split(", ")) == _asked.Asked._fields[:11]


@pytest.mark.parametrize("function", [_asked.ask, sc.roll, sc.sweep.roll])
def test_options_are_given_by_name(function):
    kinds = [x.kind for x in inspect.signature(function).parameters.values()]
    assert kinds.count(inspect.Parameter.POSITIONAL_OR_KEYWORD) <= 3


def test_the_range_of_restitution_stands_once():
    # The page has a slider, whose ends are those of the core.
    found = [
        path.relative_to(ROOT).as_posix()
        for folder, kind in (("src", "*.rs"), ("python/spincyl", "*.py"))
        for path in sorted((ROOT / folder).rglob(kind))
        for line in path.read_text("utf-8").splitlines()
        if re.search(r"""["']restitution["'].*(\b0\.0, 1\.0\b|\b0, 1\b|<= 1\b)""", line)
    ]
    assert found == ["src/motions/ask/mod.rs", "python/spincyl/studio/pages/words.py"]


@pytest.mark.parametrize("run", [sc.roll, sc.sweep.roll])
@pytest.mark.parametrize("wrong", [-0.1, 1.5, float("nan")])
def test_a_restitution_out_of_range_is_refused_by_the_core(run, wrong):
    with pytest.raises(ValueError, match=r"^restitution = \S+: expected None, or 0 <= restitution <= 1"):
        run(sc.Body.solid(1.0), sc.State(1.0, 1.0, 0.0, 0.0), 1.0, restitution=wrong)
