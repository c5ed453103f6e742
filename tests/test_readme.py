"""The README's Python blocks run, and print what it says they print."""

import contextlib
import io
import pathlib
import re

import pytest

README = pathlib.Path(__file__).parents[1] / "README.md"


def test_the_readme_prints_what_it_says(monkeypatch):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    blocks = re.findall(r"^```(python|text)\n(.*?)^```", README.read_text(), re.M | re.S)
    names, printed, checked = {}, "", 0
    for kind, text in blocks:
        if kind == "python":
            out = io.StringIO()
            with contextlib.redirect_stdout(out):
                exec(compile(text, str(README), "exec"), names)
            printed += out.getvalue()
        else:
            assert printed == text
            printed, checked = "", checked + 1
    assert checked == 5
    matplotlib.pyplot.close("all")
