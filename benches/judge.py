"""Parts that all kinds of claims.py share: blocks of motions until there are enough, and a table of true over
estimated errors with one row for each estimate, counts of other events, and times.

A ratio of one is honest, a hundredth is vague; if an estimate is 0 and the true error is not, the ratio is infinite.
The first motions whose error exceeds the estimate are printed. Rows with "aside" in their names have numbers that the
estimate does not cover, and are not counted.
"""

import collections
import itertools
import math
import time

import numpy as np

HEADS = ("n", "median", "99 %", "worst", "> 1", "> 2", "> 10", *("true: 50 %", "99 %", "worst"))
HEADS += ("claim: 50 %", "99 %", "largest", "infinite")


def blocks(given, size=1):
    """Number and size of each block of motions, until `--count` or `--seconds` are reached."""
    clock, done = time.perf_counter(), 0
    for index in itertools.count():
        if done >= given.count or time.perf_counter() - clock > given.seconds:
            return
        yield index, min(size, given.count - done)
        done += size


class Tally:
    """Ratios by row, counts of other events by row and word, and times."""

    def __init__(self, show, slowest=5, honest=10.0, nothing=0.0):
        self.rows, self.counts = collections.defaultdict(list), collections.defaultdict(collections.Counter)
        self.shown, self.show, self.slowest = collections.Counter(), show, slowest
        self.honest, self.nothing, self.times, self.notes = honest, nothing, [], []

    def add(self, name, true, claimed, line=""):
        """Adds the true and the estimated error of the motion with the call `line`; a true error of NaN is
        left out."""
        if math.isnan(true):
            return
        ratio = 0.0 if true <= self.nothing else true / claimed if claimed > 0 else math.inf
        self.rows[name].append((ratio, true, claimed))
        if not ratio <= self.honest and "aside" not in name:
            self.tell(f"{name} above {self.honest:g}", f"{true:.3g} of {claimed:.3g} claimed: {line}")

    def count(self, row, word, text=None, n=1):
        """Counts an event, and prints its text the first few times."""
        self.counts[row][word] += n
        if text:
            self.tell(f"{row}, {word}", text)

    def tell(self, name, text):
        self.shown[name] += 1
        if self.shown[name] <= self.show:
            print(f"! {name}: {text}", flush=True)

    def took(self, seconds, line):
        self.times.append((seconds, line))

    def note(self, text):
        self.notes.append(text)

    def print(self):
        width = max(map(len, self.rows), default=0)
        if self.rows:
            print(f"{'true over claimed':{width}} " + " ".join(f"{head:>11}" for head in HEADS))
        for name, rows in sorted(self.rows.items()):
            ratio, true, claim = np.array(rows).T
            with np.errstate(invalid="ignore"):
                numbers = [np.median(ratio), np.quantile(ratio, 0.99, method="higher"), ratio.max()]
                errors = [np.median(true), np.quantile(true, 0.99), true.max()]
                errors += [np.median(claim), np.quantile(claim, 0.99)]
            errors.append(claim[np.isfinite(claim)].max(initial=-math.inf))
            cells = [ratio.size, *(f"{x:.2g}" for x in numbers), *((~(ratio <= x)).sum() for x in (1, 2, 10))]
            cells += [*(f"{x:.2g}" for x in errors), np.isinf(claim).sum()]
            print(f"{name:{width}} " + " ".join(f"{x:>11}" for x in cells))
        for row, counts in sorted(self.counts.items()):
            said = "; ".join(f"{n} {word}" for word, n in sorted(counts.items()) if n)
            if said:
                print(f"{row}: {said}")
        if self.times:
            median = np.median([seconds for seconds, _ in self.times])
            print(f"time: median {1e3 * median:.3g} ms; the slowest:")
            for seconds, line in sorted(self.times, reverse=True)[: self.slowest]:
                print(f"  {seconds:.3g} s: {line}")
        print("".join(f"{text}\n" for text in self.notes), end="")
