"""The least time of a job, of several rounds."""

import time


def best(job, rounds=5, clock=time.process_time, per=1.0):
    """What a job returns, and its least time, in seconds or so many parts of one."""
    least = float("inf")
    for _ in range(rounds):
        began = clock()
        found = job()
        least = min(least, clock() - began)
    return found, per * least
