"""A limit to the CPU time of one job of a bench: a job that hangs is counted, and the next job begins."""

import contextlib
import signal


class Late(Exception):
    """A job that takes too long."""


@contextlib.contextmanager
def limit(seconds):
    """Raises Late if the statements under it take more than this CPU time."""

    def late(*_):
        raise Late(f"more than {seconds:g} s")

    before = signal.signal(signal.SIGVTALRM, late)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)
