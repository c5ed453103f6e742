"""The kinds of motions that claims.py judges; each has a file with how it is drawn and how the truth is found.

A kind has `judge(given, tally)`, which draws motions and adds them to the tally, the defaults of the common
options, and FEW, what `--few` and `--of all` give it. HONEST is the greatest honest ratio of true to claimed error, NOTHING a
true error that counts as none, `options` its own arguments.
"""

import pathlib
import sys

sys.path += [
    str(pathlib.Path(__file__).parents[2] / folder) for folder in ("tests/reference", "tests", "benches")
]
