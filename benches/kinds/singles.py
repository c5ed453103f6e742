"""CPU times and claims of single motions: random scenes to t = 50, by `sc.roll`, as accurately as doubles
allow.

5,000 motions take four minutes on one core. The scenes are those of tests/scenes.py, with one last time.
Prints the slowest of them, how many were refused with which message, and those that claim more than 1e-6.
"""

import re
import time

import numpy as np
import scenes
from judge import blocks
from limit import Late, limit

import spincyl as sc

DEFAULTS, FEW = {"count": 1000, "show": 20, "slowest": 20}, "--count 1000"
FAMILY, SPAN, VAGUE = 20, 50.0, 1e-6


def options(add):
    add("--longest", type=float, default=60.0, help="seconds of the processor for one motion")
    add("--calls", action="store_true", help="the calls of the slowest and the vaguest")


def judge(given, tally):
    for family, count in blocks(given, FAMILY):
        rng = np.random.default_rng([given.seed, family])
        scene = scenes.draw(rng, FAMILY)._replace(times=np.array([SPAN]))
        integrated = scene.losses or scene.contact in ("coulomb", "viscous")
        kind = "with friction or losses" if integrated else "without"
        for i in range(count):
            line = f"family {family}, motion {i}" + (f"\n    {scene.call(i)}" if given.calls else "")
            tally.count("motions", kind)
            said, since = "answered", time.process_time()
            try:
                body, state, how = scene.asked(i)
                with limit(given.longest):
                    m = sc.roll(body, state, SPAN, **how)
                if not m.error <= VAGUE:
                    tally.count(f"claims above {VAGUE:g}", kind, f"{m.error:.1e}, {line}")
            except Late:
                said = "hangs"
            except ValueError as e:
                words = str(e).split(": ", maxsplit=1)[-1]
                said = re.sub(r"-?\d[\d.e+-]*", "#", words).split(",")[0]
                tally.count("refused", said)
            tally.took(time.process_time() - since, f"{said}: {line}")
