"""A table of true over claimed errors, one row for each claim, and the first motions that break a claim.

`claims.py`, `slip_claims.py`, `losses_claims.py` and `slip_starts.py` fill it. A ratio of one is honest, a
hundredth is vague; a claim of 0 beside a true error counts as infinite. Rows with "aside" in their names are
of numbers that the claim does not cover, and break none.
"""

import collections
import math

import numpy as np

#: greatest honest ratio: a claim is an estimate, and not a bound
HONEST = 10.0


class Tally:
    """Ratios by row, and counts of other events."""

    def __init__(self, show, honest=HONEST, nothing=0.0):
        self.rows, self.counts = collections.defaultdict(list), collections.Counter()
        self.shown, self.show = collections.Counter(), show
        self.honest, self.nothing = honest, nothing

    def add(self, name, true, claimed, line):
        """Adds a true error and the claimed one of the motion with the call `line`; a true error of NaN is
        left out."""
        if math.isnan(true):
            return
        ratio = 0.0 if true <= self.nothing else true / claimed if claimed > 0 else math.inf
        self.rows[name].append((ratio, true, claimed))
        if not ratio <= self.honest and "aside" not in name:
            self.tell(f"{name} above {self.honest:g}", f"{true:.3g} of {claimed:.3g} claimed: {line}")

    def count(self, name, text=None):
        """Counts an event, and prints its text the first few times."""
        self.counts[name] += 1
        if text:
            self.tell(name, text)

    def tell(self, name, text):
        self.shown[name] += 1
        if self.shown[name] <= self.show:
            print(f"! {name}: {text}", flush=True)

    def print(self):
        over = f"above {self.honest:g}"
        heads = ("n", "median", "99 %", "worst", over, "median true", "median claim", "largest", "infinite")
        if self.rows:
            print(f"{'true over claimed':55} " + " ".join(f"{head:>12}" for head in heads))
        for name, rows in sorted(self.rows.items()):
            ratio, true, claim = np.array(rows).T
            finite = claim[np.isfinite(claim)]
            numbers = [np.median(ratio), np.quantile(ratio, 0.99, method="higher"), ratio.max()]
            told = [ratio.size, *(f"{x:.2g}" for x in numbers), (~(ratio <= self.honest)).sum()]
            told += [f"{x:.2g}" for x in (np.median(true), np.median(claim), finite.max(initial=-math.inf))]
            print(f"{name:55} " + " ".join(f"{x:>12}" for x in (*told, np.isinf(claim).sum())))
        for name, n in sorted(self.counts.items()):
            print(f"{name}: {n}")
