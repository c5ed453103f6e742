"""The least time of a job, of several rounds."""

import time


def best(job, rounds=5, clock=time.process_time, per=1.0):
    """The result of a job and its least time, in units of 1/`per` seconds."""
    least = float("inf")
    for _ in range(rounds):
        began = clock()
        found = job()
        least = min(least, clock() - began)
    return found, per * least
