"""A limit to the processor time of one job of a bench: what hangs is counted, and the next job begins."""

import contextlib
import signal


class Late(Exception):
    """A job that takes too long."""


@contextlib.contextmanager
def limit(seconds):
    """Raises Late in what runs under it for more than so many seconds of the processor."""

    def late(*_):
        raise Late(f"more than {seconds:g} s")

    before = signal.signal(signal.SIGVTALRM, late)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)
