"""Tests that stand still fail and say where they wait, and the others run."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
HEAD = "import signal, threading, time\nimport pytest\n"
WAITS = """
def test_that_waits_for_a_thread_that_never_ends():
    never = threading.Event()
    threading.Thread(target=never.wait, name="the one that never ends", daemon=True).start()
    never.wait()  # waits here

def test_that_follows():
    pass
"""
FIXTURE = """
@pytest.fixture
def slow():
    threading.Event().wait()  # a fixture waits here
    yield

def test_with_a_fixture(slow):
    pass

def test_that_follows():
    pass
"""
DEAF = """
def test_that_hears_no_signal():
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGALRM})
    threading.Event().wait()  # deaf here
"""
LONG = """
@pytest.mark.long
def test_that_may_take_longer():
    time.sleep(2)
"""
LEFT = """
def test_that_leaves_a_thread():
    threading.Thread(target=threading.Event().wait, name="left").start()
"""


def run(tmp_path, text, limits="1 30 1"):
    """The outcome of a run of pytest on these tests, with these limits."""
    (tmp_path / "test_of_these.py").write_text(HEAD + text)
    environment = os.environ | {"SPINCYL_STILL": limits, "PYTHONPATH": str(HERE)}
    words = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-p",
        "still",
        "-p",
        "no:cacheprovider",
        "-c",
        os.devnull,
        ".",
    ]
    return subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300)


@pytest.mark.parametrize(("text", "where"), [(WAITS, "waits here"), (FIXTURE, "a fixture waits here")])
def test_a_test_that_waits_for_ever_fails_says_where_and_the_next_one_runs(tmp_path, text, where):
    found = run(tmp_path, text)
    assert found.returncode == 1, found.stdout
    assert "has stood still for 1 s, here:" in found.stderr and where in found.stderr
    assert "1 passed" in found.stdout and ("1 failed" in found.stdout or "1 error" in found.stdout)
    assert "StandsStill" in found.stdout
    assert text != WAITS or "thread the one that never ends" in found.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.parametrize("text", [DEAF, LEFT])
def test_what_hears_no_signal_or_leaves_a_thread_ends_the_run_and_says_where(tmp_path, text):
    found = run(tmp_path, text)
    assert found.returncode == 1, found.stdout
    assert "Timeout" in found.stderr and "Thread 0x" in found.stderr
    assert text != DEAF or (
        "test_of_these.py" in found.stderr and "in test_that_hears_no_signal" in found.stderr
    )


def test_a_long_test_may_take_longer(tmp_path):
    assert "1 passed" in run(tmp_path, LONG).stdout


AWAKE = [sys.executable, str(HERE / "awake.py")]


def test_a_command_that_says_nothing_for_long_is_ended_with_its_last_words():
    waits = "import sys, time; print('the test of the tide is running', flush=True); time.sleep(1000)"
    found = subprocess.run(
        [*AWAKE, "2", sys.executable, "-c", waits], capture_output=True, text=True, timeout=300
    )
    assert found.returncode == 124 and "no word for 2 s" in found.stdout
    assert found.stdout.count("the test of the tide is running") == 3, "said, asked for, and repeated"


def test_a_command_that_ends_gives_its_status_and_its_words():
    for status in (0, 3):
        ends = f"print('said'); raise SystemExit({status})"
        found = subprocess.run(
            [*AWAKE, "200", sys.executable, "-c", ends], capture_output=True, text=True, timeout=300
        )
        assert (found.returncode, found.stdout) == (status, "said\n")
