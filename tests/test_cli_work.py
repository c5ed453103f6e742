"""The command line at work: refusals before the work begins, help texts, progress."""

import os
import pty
import re
import shlex
import sys
import threading
from types import SimpleNamespace

import pytest
from test_cli import ROLL, said, shell

import spincyl as sc
from spincyl._input.units import join_units
from spincyl.cli import _commands, _output
from spincyl.cli._options import parser

COMMANDS = ["steady", "portrait", "roll", "figures"]


@pytest.fixture
def no_work(monkeypatch):
    def never(*_, **__):
        raise AssertionError("it began to work")

    monkeypatch.setattr(_commands, "roll", never)
    for place in (sc.sweep, sc.plot):
        for name in ("portrait", "figures"):
            if hasattr(place, name):
                monkeypatch.setattr(place, name, never)


@pytest.mark.parametrize(
    ("words", "status", "reason"),
    [
        ([*ROLL, "--t", "5", "-o", "{}/no/where.csv"], 1, "where.csv: No such file or directory"),
        ([*ROLL, "--t", "5", "-o", "{}/taken.png"], 1, "taken.png: Is a directory"),
        ([*ROLL, "--t", "5", "-o", "{}/link.csv"], 1, "link.csv: No such file or directory"),
        ([*ROLL, "--t", "5", "-o", "/proc/a.html"], 1, "/proc/a.html: "),
        ([*ROLL, "--t", "5", "-o", "{}/a.txt"], 2, "expected a name that ends in .csv"),
        (["portrait", "-o", "{}/no/where.png"], 1, "where.png: No such file or directory"),
        (["portrait", "-o", "{}/a.csv"], 2, "expected a name that ends in .png, .pdf, .svg, .nc, or -"),
        (["figures", "{}/file"], 1, "file: File exists"),
        (["figures", "/proc"], 1, "/proc: "),
        (["figures", "{}/file/folder"], 1, "folder: Not a directory"),
    ],
)  # fmt: skip
def test_what_cannot_be_written_is_refused_before_the_work(capsys, tmp_path, no_work, words, status, reason):
    (tmp_path / "file").write_text("kept")
    (tmp_path / "taken.png").mkdir()
    (tmp_path / "link.csv").symlink_to(tmp_path / "no" / "where.csv")
    found = said(capsys, *(word.format(tmp_path) for word in words), status=status)
    assert reason in found.err and found.err.startswith(f"spincyl {words[0]}: ") and found.out == ""
    assert (
        sorted(p.name for p in tmp_path.iterdir()) == ["file", "link.csv", "taken.png"]
        and (tmp_path / "file").read_text() == "kept"
    )


@pytest.mark.parametrize(
    ("words", "missing", "remedy"),
    [
        ([*ROLL, "--t", "5", "-o", "a.png"], ["matplotlib"], "pip install 'spincyl[plot]'"),
        ([*ROLL, "--t", "5", "-o", "a.nc"], ["xarray"], "pip install 'spincyl[sweep]'"),
        ([*ROLL, "--t", "5", "-o", "a.nc"], ["scipy", "netCDF4", "h5netcdf"], "pip install scipy"),
        (["portrait", "-o", "a.svg"], ["matplotlib"], "pip install 'spincyl[plot]'"),
        (["portrait", "-o", "a.nc"], ["scipy", "netCDF4", "h5netcdf"], "pip install scipy"),
        (["figures", "folder"], ["matplotlib"], "pip install 'spincyl[plot]'"),
    ],
)  # fmt: skip
def test_a_missing_extra_is_named_before_the_work(
    capsys, tmp_path, monkeypatch, no_work, words, missing, remedy
):
    monkeypatch.chdir(tmp_path)
    for name in missing:
        monkeypatch.setitem(sys.modules, name, None)
    assert remedy in said(capsys, *words, status=1).err and not list(tmp_path.iterdir())


def test_a_file_that_is_there_is_kept_until_its_successor_is_made(capsys, tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("kept")
    said(capsys, "roll", "--ell", "2.5", "--theta", "40deg", "--t", "5", "-o", path, status=2)
    assert path.read_text() == "kept"
    said(capsys, *ROLL, "--t", "5", "-o", path)
    assert path.read_text().startswith("t,theta")


def test_ctrl_c_leaves_quietly(capsys, monkeypatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(_commands, "roll", interrupted)
    assert said(capsys, *ROLL, "--t", "5", status=130).err == "spincyl roll: interrupted\n"


# help texts and progress


def help_of(command):
    words = [] if command is None else [command]
    with pytest.raises(SystemExit):
        parser().parse_args([*words, "--help"])


@pytest.mark.parametrize("command", [None, *COMMANDS])
def test_every_help_has_examples_and_they_run(capsys, tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    help_of(command)
    text = capsys.readouterr().out
    assert text.isascii()
    examples = [line.strip() for line in text.split("examples:\n")[1].splitlines()]
    assert examples and all(line.startswith("spincyl ") for line in examples)
    for line in examples:
        words = shlex.split(line)[1:]
        if command == "figures":
            parser().parse_args(join_units(words))
        elif not {"|", ">", "--help"} & set(words):  # like a separate process, but without its imports
            said(capsys, *words)
        else:
            ended = shell(line, cwd=tmp_path)
            assert ended.returncode == 0, (line, ended.stderr)


def on_a_terminal(run):
    """The output of a run to a terminal."""
    mine, theirs = pty.openpty()
    written = []

    def read():
        while True:
            try:
                got = os.read(mine, 65536)
            except OSError:
                return
            if not got:
                return
            written.append(got)

    reader = threading.Thread(target=read)
    reader.start()
    with os.fdopen(theirs, "w") as terminal:
        run(terminal)
    reader.join()
    os.close(mine)
    return b"".join(written).decode()


def test_long_work_says_on_a_terminal_how_far_it_is(monkeypatch):
    shown, clock = threading.Event(), iter([0.0])
    monkeypatch.setattr(_output, "time", SimpleNamespace(monotonic=lambda: next(clock, 1.2)))
    said = lambda *words, **how: (print(*words, **how), shown.set())  # noqa: E731
    monkeypatch.setattr(_output, "print", said, raising=False)

    def work(terminal):
        monkeypatch.setattr(sys, "stderr", terminal)
        with _output.Working("portrait") as working:
            working(0.42)
            assert shown.wait(500), "a line within a limit"

    there = on_a_terminal(work)
    assert re.match(r"\rspincyl portrait: 42%, 1 s\r", there) and re.search(r"\r +\r$", there)
    assert on_a_terminal(lambda terminal: None) == ""


def test_short_work_and_pipes_see_no_progress(capsys, monkeypatch):
    def work(terminal):
        monkeypatch.setattr(sys, "stderr", terminal)
        with _output.Working("roll"):
            pass

    assert on_a_terminal(work) == ""
    monkeypatch.undo()
    with _output.Working("roll"):
        threading.Event().wait(1.2)
    assert capsys.readouterr().err == ""
