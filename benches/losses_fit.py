"""Fitted losses and their standard errors, and how often the true law is identified.

Simulated spin-downs of Euler's disk from 0.3 rad with the centre at rest, 200 inclinations with 1 % noise
until a twentieth of the time is left (0.03 rad for laws that never stop). `fit_losses` gets no errors of the
data and fits all eight laws. Prints for each true law, over all its spin-downs: mean and spread of (fitted -
true) / error of the coefficient and of the stopping time, which should be 0 and 1; the percentage of
spin-downs in which AIC selects the true law, and in which it also rules out all others; the least dAIC of the
others; and the exponent of the log-log line with free stopping time, its spread, its estimated error and its
difference from the true one.

usage: python benches/losses_fit.py [--count 200] [--centre rest] [--precession] [--law DryContour]
"""

import argparse
import math
import time
import warnings

import numpy as np

import spincyl as sc

DISK = sc.Body.from_metres(outer_diameter=0.0751, length=0.0128)  # Euler's disk
START, END, POINTS, NOISE = 0.3, 0.03, 200, 0.01
# theta goes as this power of the time left, near the end; the precession goes as theta^(-1/2)
EXPONENTS = {
    sc.loss.DryContour: 2 / 3,
    sc.loss.ViscousContour: 1 / 2,
    sc.loss.RollingResistance: 2,
    sc.loss.Drilling: 2,
    sc.loss.AirLinear: math.nan,
    sc.loss.AirQuadratic: math.nan,
    sc.loss.AirFilm: 1 / 3,
    sc.loss.BoundaryLayer: 4 / 9,
}
TRUE = 1e-4


def spin_downs(law, count, centre, rng):
    """Times, the simulated inclinations and precessions, and the true stopping time."""
    drift = sc.drift(DISK, START, law(TRUE), centre=centre)
    last = 0.95 * drift.stops_at if np.isfinite(drift.stops_at) else float(drift.time(END))
    t = np.linspace(0, last, POINTS)
    for _ in range(count):
        theta, precession = (
            f(t) * (1 + NOISE * rng.normal(size=POINTS)) for f in (drift.theta, drift.precession)
        )
        yield t, theta, precession, float(drift.stops_at)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--centre", choices=("rest", "rolling"), default="rest")
    parser.add_argument(
        "--precession", action="store_true", help="the precession was measured, no inclinations"
    )
    parser.add_argument("--law", choices=[law.__name__ for law in EXPONENTS], help="test only this law")
    options = parser.parse_args()
    true_laws = {law: x for law, x in EXPONENTS.items() if options.law in (None, law.__name__)}
    rng, begun = np.random.default_rng(1), time.perf_counter()
    print(
        "law                coefficient    stop           named  apart  least    exponent of the log-log line"
    )
    print(
        "                   mean   spread  mean   spread  %      %      dAIC   true   found  spread  claimed  off"
    )
    for law, true in true_laws.items():
        pulls, stops, named, apart, least, lines = [], [], [], [], [], []
        for t, theta, precession, stop in spin_downs(law, options.count, options.centre, rng):
            seen = {"precession": precession} if options.precession else {"theta": theta}
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                found = sc.data.fit_losses(t, **seen, body=DISK, centre=options.centre)
            own = found.of(law)
            pulls.append((own.coefficient - TRUE) / own.coefficient_err)
            stops.append((own.stops_at - stop) / own.stops_at_err if np.isfinite(stop) else math.nan)
            named.append(found.best is own)
            apart.append(found.best is own and found.told_apart)
            least.append(min(f.daic if f is not own else math.inf for f in found.fits))
            if found.line is not None:
                lines.append(found.line[:2])
        exponent, claimed = np.array(lines or [(math.nan, math.nan)]).T
        true *= -0.5 if options.precession else 1
        print(
            f"{law.__name__:18} {np.mean(pulls):+.2f}  {np.std(pulls):.2f}    {np.mean(stops):+.2f}  "
            f"{np.std(stops):.2f}    {100 * np.mean(named):<5.3g}  {100 * np.mean(apart):<5.3g}  {min(least):<6.0f} "
            f"{true:+.3f} {exponent.mean():+.3f} {exponent.std():.4f}  {claimed.mean():.4f}   "
            f"{exponent.mean() - true:+.3f}",
            flush=True,
        )
    many = options.count * len(true_laws)
    print(f"{many} spin-downs, eight laws each: {time.perf_counter() - begun:.0f} s")


if __name__ == "__main__":
    main()
