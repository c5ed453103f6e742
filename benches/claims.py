"""Estimated errors and ends of motions, by kind, against truths that share no code with the library.

    python benches/claims.py --of KIND [--count 1000] [--seed 1]
    python benches/claims.py --of KIND --help        describe the motions, the comparison, and all options
    python benches/claims.py --of all                every kind with a moderate count; half an hour on one core

motions   states, events and poses, rolling and smooth          slips     slipping motions, alone and swept
starts    initial states at or near rest                            phases    phases of random starts with friction
saddles   motions that linger at an unstable steady state       launches  10,000 launches of the paper's tube
periods   periods and precessions                               losses    motions with losses
ends      ends of a million random starts and of hard ones      stones    random stones from random starts
many      many motions at once against each alone               singles   times and errors of single motions
hops      motions with flights, impacts and lying bodies

A ratio is the true error over the estimated error: one is honest, a hundredth is vague.
"""

import argparse
import importlib
import math
import subprocess
import sys
import time
import warnings

import numpy as np
from judge import Tally

KINDS = (
    "motions", "starts", "saddles", "periods", "slips", "phases", "launches", "losses", "stones", "many", "singles", "ends", "hops",
)  # fmt: skip


def whole(text):
    """A whole number, which may be written as 1e6."""
    return int(float(text))


def asked():
    """The module of a kind, and its options; None and None for all."""
    first = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    first.add_argument("--of", choices=(*KINDS, "all"))
    of = first.parse_known_args()[0].of
    kind = importlib.import_module(f"kinds.{of}") if of in KINDS else None
    shape = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(
        description=(kind or sys.modules[__name__]).__doc__, formatter_class=shape, parents=[first]
    )
    if kind:
        parser.add_argument("--few", action="store_true", help="a moderate count")
        parser.add_argument("--count", type=whole, help="number of motions")
        parser.add_argument("--seed", type=int, help="seed (default of many: a new one each time)")
        parser.add_argument("--show", type=int, default=5, help="number of faults of each kind to show")
        parser.add_argument("--slowest", type=int, default=5, help="number of slowest motions to show")
        parser.add_argument("--seconds", type=float, default=math.inf, help="stop after this time")
        getattr(kind, "options", lambda _: None)(parser.add_argument)
        parser.set_defaults(**kind.DEFAULTS)
    few = kind.FEW.split() if kind and "--few" in sys.argv else []
    given = parser.parse_args([*few, *sys.argv[1:]])
    if of is None:
        parser.error("--of says which kind")
    if kind and given.seed is None:
        given.seed = int(np.random.SeedSequence().entropy % 2**32)
    return kind, given


def main():
    kind, given = asked()
    if kind is None:
        for of in KINDS:
            subprocess.run([sys.executable, __file__, "--of", of, "--few"], check=False)
        return
    warnings.simplefilter("ignore")  # some cases give warnings, as they should
    print(f"python benches/claims.py {' '.join(sys.argv[1:])}  # seed {given.seed}", flush=True)
    tally = Tally(given.show, given.slowest, getattr(kind, "HONEST", 10.0), getattr(kind, "NOTHING", 0.0))
    clock = time.perf_counter()
    try:
        kind.judge(given, tally)
    except KeyboardInterrupt:
        print("! interrupted: what follows is of the motions before")
    print(f"{time.perf_counter() - clock:.0f} s")
    tally.print()


if __name__ == "__main__":
    main()
