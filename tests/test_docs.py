"""The README and every page of the documentation: the Python code runs and prints the output shown."""

import contextlib
import doctest
import enum
import functools
import importlib
import inspect
import io
import pathlib
import pkgutil
import re
import shlex
import types
import warnings

import blocks
import matplotlib as mpl
import pytest

mpl.use("agg")
import matplotlib.pyplot as plt

import spincyl as sc
from spincyl import cli

ROOT = pathlib.Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def examples(page):
    """Code that runs, with the text below it that shows its output."""
    parts = blocks.printed(blocks.blocks(page.read_text("utf-8")))
    return [(block.kind, block.text, said) for block, said in parts if block.kind in blocks.RUNS]


RUNNING = [page for page in PAGES if examples(page)]


def clipped(figure):
    """Whether any part of a figure is cut off when it is saved."""
    figure.savefig(io.BytesIO(), format="png")
    (left, low), (right, high) = figure.bbox.get_points()
    boxes = [ax.get_tightbbox().get_points() for ax in figure.axes]
    return any((box < [left - 1, low - 1]).any() or (box > [right + 1, high + 1]).any() for box in boxes)


@pytest.mark.parametrize("page", RUNNING, ids=lambda page: page.name)
def test_the_examples_of_a_page_run_and_print_what_it_says(page, monkeypatch):
    monkeypatch.chdir(ROOT)
    names = {}
    for kind, code, said in examples(page):
        if kind == "python":
            out = io.StringIO()
            with contextlib.redirect_stdout(out), warnings.catch_warnings():
                exec(compile(code, str(page), "exec"), names)
            assert out.getvalue() == (said or ""), code
            plt.close("all")


@pytest.mark.long  # `make docs` makes the figures, too, with warnings as errors
@pytest.mark.parametrize("page", RUNNING, ids=lambda page: page.name)
def test_nothing_of_a_figure_lies_outside_of_it(page, monkeypatch):
    monkeypatch.chdir(ROOT)
    for kind, code, _ in examples(page):
        if kind != "python":
            with warnings.catch_warnings(), mpl.rc_context(blocks.STYLE):
                exec(compile(code, str(page), "exec"), {})
            assert plt.get_fignums(), "a figure was made"
            assert not clipped(plt.gcf()), code
            plt.close("all")


def test_the_pages_have_their_examples():
    counts = {page.name: len(examples(page)) for page in RUNNING}
    assert counts["README.md"] >= 1 and counts["tour.md"] >= 10 and sum(counts.values()) >= 38, counts


def test_the_commands_of_the_pages_run_and_write_what_they_name(monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    texts = [(ROOT / f"docs/{page}.md").read_text("utf-8") for page in ("command-line", "install")]
    commands = "".join(block.text for text in texts for block in blocks.of_kind(text, "sh"))
    lines = commands.replace("\\\n", "").splitlines()  # join lines that end with a backslash
    lines = [shlex.split(line) for line in lines if line.startswith("spincyl ")]
    assert {words[1] for words in lines} >= {*"steady portrait roll flick drift figures".split()}
    for words in lines:
        if words[1] == "figures":
            cli.parser().parse_args(words[1:])  # running these takes minutes
            continue
        assert cli.main(words[1:]) == 0, words
        assert "-o" not in words or (tmp_path / words[words.index("-o") + 1]).stat().st_size > 1000


def named(thing, name):
    """The public names of a class or module, which the table of the page can list."""
    if inspect.ismodule(thing):
        found = {f"{name}.{x}" for x in thing.__all__}
        return found if name in ("custom", "data", "loss", "plot", "sweep") else set()
    if not inspect.isclass(thing) or issubclass(thing, (tuple, enum.Enum, Warning)):
        return {name}
    own = {x: inspect.getattr_static(thing, x) for x in dir(thing) if not x.startswith("_")}
    for base in thing.__mro__[1:]:  # names inherited from another public class are listed there
        if base.__name__ in sc.__all__:
            own = {x: what for x, what in own.items() if inspect.getattr_static(base, x, None) is not what}
    methods = (property, functools.cached_property, classmethod, staticmethod, types.FunctionType)
    return {name} | {f"{name}.{x}" for x, what in own.items() if isinstance(what, methods)}


def test_a_table_lists_every_public_name():
    text = (ROOT / "docs/api.md").read_text("utf-8")
    tables = re.findall(r"^\.\. autosummary::\n   :nosignatures:\n\n((?:   \S+\n)+)", text, re.M)
    listed = "".join(tables).split()
    assert len(listed) == len(set(listed)), "each in one group"
    public = set().union(*(named(getattr(sc, name), name) for name in sc.__all__))
    assert len(public) > 120
    missing, unknown = public - set(listed), set(listed) - public
    assert not missing, f"add them to a table of docs/api.md: {sorted(missing)}"
    assert not unknown, f"a table of docs/api.md has what is no public name: {sorted(unknown)}"


def test_every_public_name_says_what_it_is():
    for name in sc.__all__:
        thing = getattr(sc, name)
        for x in [] if not inspect.isclass(thing) else (x for x in dir(thing) if not x.startswith("_")):
            what = inspect.getattr_static(thing, x)
            if isinstance(what, property | functools.cached_property | types.FunctionType):
                assert what.__doc__ and what.__doc__ != type(what).__doc__, f"{name}.{x}"


def test_the_equations_are_numbered_in_order_and_every_number_that_is_named_exists():
    text = (ROOT / "docs/physics.md").read_text("utf-8")
    numbers = [tuple(map(int, found)) for found in re.findall(r"\\tag\{(\d+)\.(\d+)\}", text)]
    section, expected = 0, []
    for here, _ in numbers:
        last = expected[-1][1] if here == section else 0
        section = here
        expected.append((here, last + 1))
    assert numbers == expected and len(numbers) > 20
    assert [here for here, k in numbers if k == 1] == list(range(1, 12))
    named = {tuple(map(int, found)) for found in re.findall(r"\((\d+)\.(\d+)\)", text)}
    assert named and named <= set(numbers), named - set(numbers)
    assert len(blocks.of_kind(text, "math")) == len(numbers)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_no_code_is_indented_into_the_prose_above_it(page):
    assert not re.findall(r"^ {4,}\S.*", blocks.prose(page.read_text("utf-8")), flags=re.M)


def test_the_examples_of_the_docstrings_give_what_they_say():
    finder, runner = doctest.DocTestFinder(), doctest.DocTestRunner()
    for found in pkgutil.walk_packages(sc.__path__, "spincyl."):
        if found.name not in ("spincyl.__main__", "spincyl._core"):
            for example in finder.find(importlib.import_module(found.name), found.name):
                runner.run(example)
    plt.close("all")
    tried, failed = runner.tries, runner.failures
    assert failed == 0 and tried >= 25, (failed, tried)
