"""A test that stands still fails and says where, instead of keeping everybody waiting for ever.

After ten minutes (an hour if it is marked `long`) the stacks of all threads are printed and the test fails. What does not
even listen to signals, such as a call that never returns to Python, ends the whole run a minute later, with the stacks of
all threads. These are limits to waiting, not to work: no test comes near them, also on a machine that is busy elsewhere.
"""

import faulthandler
import os
import signal
import sys
import threading
import traceback

import pytest

#: Seconds of a test, of one that is marked `long`, and until the run ends if the test does not.
MOST, LONG, GRACE = (float(x) for x in os.environ.get("SPINCYL_STILL", "600 3600 60").split())
_said = {}


class StandsStill(BaseException):
    """Raised in a test that takes too long; no `except Exception` of the test catches it."""


def pytest_configure(config):
    _said["file"] = os.fdopen(os.dup(sys.__stderr__.fileno()), "w")  # before the output of tests is captured


def pytest_unconfigure(config):
    # a thread that a test has left would keep the process
    faulthandler.dump_traceback_later(MOST, exit=True, file=_said["file"])


def _watched(item, phase):
    """Fail a phase of a test (its fixtures, the test, or their end) that stands still."""
    most = LONG if item.get_closest_marker("long") else MOST
    listens = hasattr(signal, "setitimer") and threading.current_thread() is threading.main_thread()

    def late(number, frame):
        names = {thread.ident: thread.name for thread in threading.enumerate()}
        told = [f"{item.nodeid} ({phase}) has stood still for {most:g} s, here:"]
        for ident, at in sys._current_frames().items():
            at = frame if ident == threading.get_ident() else at
            told.append(f"thread {names.get(ident, ident)}:\n" + "".join(traceback.format_stack(at)))
        print(*told, sep="\n", file=_said["file"], flush=True)
        raise StandsStill(f"{told[0][:-7]}, in line {frame.f_lineno} of {frame.f_code.co_filename}")

    faulthandler.dump_traceback_later(most + GRACE, exit=True, file=_said["file"])
    if listens:
        before = signal.signal(signal.SIGALRM, late)
        signal.setitimer(signal.ITIMER_REAL, most)
    try:
        return (yield)
    finally:
        if listens:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)
        faulthandler.cancel_dump_traceback_later()


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_setup(item):
    return (yield from _watched(item, "its fixtures"))


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_call(item):
    return (yield from _watched(item, "the test"))


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_teardown(item):
    return (yield from _watched(item, "the end of its fixtures"))
