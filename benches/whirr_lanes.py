"""Whirrs in SIMD lanes under each loss law and three mixtures: time, end and error, one table.

    python benches/whirr_lanes.py [--count 512] [--tol 1e-8]

Euler's disk (half its thickness is 0.17 of its radius, a sharp rim) starts at 0.25 to 0.35 rad, every other
one with a nutation, and is followed to its end, or to t = 60 where it has none by then. The coefficients are
such that drift alone would need 20 to 30 units of time from 0.3 rad to 0.03 rad, so that all laws take about
equally long. Times are least CPU times of one thread. The true error is the largest difference of the end and of the
last state from the same sweep at the tolerance 1e-12, divided by the number if it is above 1; the estimated error
must be larger. The table has the medians of both.
"""

import argparse
import time
import warnings

import numpy as np

import spincyl as sc

ELL = 0.0128 / 0.0751
DISK = sc.Body.solid(ELL)
UNTIL = 60.0
#: how a whirr ends, in words
ENDS = {
    sc.Ending.STOPS: "friction stops the disk",
    sc.Ending.FACE: "the face lands",
    sc.Ending.DONE: "last requested time",
}
LAWS = {
    "dry friction along the rim": {sc.loss.DryContour: 1.0},
    "viscous friction along the rim": {sc.loss.ViscousContour: 1.0},
    "rolling resistance": {sc.loss.RollingResistance: 1.0},
    "drilling friction": {sc.loss.Drilling: 1.0},
    "air resistance, linear in the speed": {sc.loss.AirLinear: 1.0},
    "air resistance, quadratic in the speed": {sc.loss.AirQuadratic: 1.0},
    "viscous film of air below the face": {sc.loss.AirFilm: 1.0},
    "boundary layer of the air": {sc.loss.BoundaryLayer: 1.0},
    "dry friction along the rim and film of air": {sc.loss.DryContour: 0.5, sc.loss.AirFilm: 0.5},
    "rolling resistance and quadratic air resistance": {
        sc.loss.RollingResistance: 0.5,
        sc.loss.AirQuadratic: 0.5,
    },
    "viscous friction along the rim, drilling friction and boundary layer": {
        sc.loss.ViscousContour: 0.4,
        sc.loss.Drilling: 0.3,
        sc.loss.BoundaryLayer: 0.3,
    },
}


def coefficient(law, seconds=25.0):
    """The coefficient with which a drift takes this time from 0.3 rad to 0.03 rad; the time is inversely
    proportional to it."""
    trial = sc.drift(DISK, 0.3, law(1e-4))
    least = trial.time(0.03)
    return 1e-4 * float(least) / seconds if np.isfinite(least) else 5e-3


def starts(count):
    """States of `count` disks, and factors of their coefficients."""
    i = np.arange(count)
    theta = 0.25 + 0.1 * (i + 0.5) / count
    kick = 0.1 * (((i * 37_345) % 65_536) + 0.5) / 65_536
    share = 0.8 + 0.4 * (((i * 49_473) % 65_536) + 0.5) / 65_536
    steady = DISK.steady(theta)
    return sc.State(theta, steady.w1, np.where(i % 2, kick, 0.0), steady.w3), share


def main():
    asked = argparse.ArgumentParser()
    asked.add_argument("--count", type=int, default=512)
    asked.add_argument("--tol", type=float, default=1e-8)
    asked.add_argument("--rounds", type=int, default=3)
    asked = asked.parse_args()
    state, share = starts(asked.count)
    body = sc.Body.solid(np.full(asked.count, ELL))
    print(
        f"Each row is a loss law, with the CPU time and the errors of {asked.count} whirrs of Euler's disk, computed by `spincyl` with the tolerance"
        f" {asked.tol:g} (`benches/whirr_lanes.py`). A whirr ends when friction\nstops the disk, when its face"
        " lands, or at the last requested time:\n"
    )
    print(
        "| loss law | time per whirr (µs) | time over that of the fastest law |"
        " how the whirrs end, and how many | median estimated error | median true error |\n"
        + "| --- " * 6
        + "|"
    )
    rows = []
    for name, mixture in LAWS.items():
        first, *more = [law(part * coefficient(law) * share) for law, part in mixture.items()]
        losses = sum(more, first)

        def run(tol, losses=losses):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", sc.ErrorWarning)
                return sc.sweep.roll(
                    body, state, UNTIL, losses=losses, threads=1, tol=tol, want=("final", "end")
                )

        least = np.inf
        for _ in range(asked.rounds):
            began = time.process_time()
            found = run(asked.tol)
            least = min(least, time.process_time() - began)
        true = run(1e-12)
        off = np.zeros(asked.count)
        for kind in ("theta", "w1", "w2", "w3", "end"):
            a, b = found[kind].values, true[kind].values
            apart = np.abs(a - b) / np.maximum(1, np.abs(b))
            off = np.maximum(off, np.where(np.isnan(a) & np.isnan(b), 0, apart))
        kinds, counts = np.unique(found["status"].values, return_counts=True)
        ends = ", ".join(
            f"{ENDS.get(sc.Ending(int(k)), sc.Ending(int(k)).name)}: {n}"
            for k, n in zip(kinds, counts, strict=True)
        )
        rows.append((name, least / asked.count * 1e6, ends, np.median(found["error"].values), np.median(off)))
    best = min(us for _, us, *_ in rows)
    for name, us, ends, claim, off in rows:
        print(f"| {name} | {us:.1f} | {us / best:.1f} | {ends} | {claim:.1e} | {off:.1e} |")


if __name__ == "__main__":
    main()
