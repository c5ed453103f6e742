"""Time of a map of rattlebacks with friction: 41 x 41 stones over twist and spin, with the reversals of each.

    python benches/stone_map.py [--side 41]        three minutes

A stone with the semi-axes 7, 1.4 and 1.2 cm, twists up to 5 degrees and spins up to 8 rad/s both ways. For each
contact: six and twenty seconds of motion, with sweep.roll's outputs `reversals` and `end` at tol = 1e-10. Prints wall
time, processor time, the share of stones that are known to the end, and the median of their estimated errors.
"""

import argparse
import time
import warnings

import numpy as np

import spincyl as sc


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--side", type=int, default=41)
    side = parser.parse_args().side
    warnings.simplefilter("ignore", sc.ErrorWarning)  # the table says how many are not known to the end
    twist, spin = np.radians(np.linspace(-5, 5, side))[:, None], np.linspace(-8, 8, side)
    stones = sc.Ellipsoid.rattleback((0.07, 0.014, 0.012), twist=twist)
    second = sc.Scale(0.07).seconds(1.0)
    start = stones.spinning(spin * second, pitch=1e-3, roll=1e-3)
    print("| contact | motion | wall | processor | known to the end | turn back | median error |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for contact in ("rolling", sc.Coulomb(0.3), sc.Coulomb(0.1)):
        for seconds in (6.0, 20.0):
            began, spent = time.perf_counter(), time.process_time()
            found = sc.sweep.roll(
                stones, start, seconds / second, contact=contact, tol=1e-10, want=("reversals", "end")
            )
            wall, cpu = time.perf_counter() - began, time.process_time() - spent
            known = float((found["known_until"] >= seconds / second).mean())
            turned, error = float((found["reversals"] > 0).mean()), float(np.nanmedian(found["error"]))
            name = contact if isinstance(contact, str) else f"mu = {contact.mu}"
            print(
                f"| {name} | {seconds:.0f} s | {wall:.1f} s | {cpu:.1f} s | {known:.1%} | {turned:.0%} | {error:.0e} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
