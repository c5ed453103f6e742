"""How often the law of a spin-down is identified from its sound: simulated recordings, as of a phone.

A coin, a disk or a tube, sharp or rounded, is let go and comes to rest by one law, its centre at rest or
rolling. It rings at a few frequencies, loudest once a turn. Before and after it there is silence for a random
time; in some recordings the body is handled before it is let go, the mains hum, and the table is knocked.
`wobble` finds the turns, and `fit_losses` fits every law with both kinds of centre. Verdicts:

right      only the true law and centre remain, and the coefficient is within four errors
undecided  the true law and centre remain, and so do others
wrong      the true law and centre are ruled out, or remain alone with a coefficient beyond four errors
doubted    wrong, but with the warning that no law explains the points
refused    no turns are found, or no law fits

usage: python benches/recordings.py [--count 200] [--first 0] [--verbose]
"""

import argparse
import collections
import math
import time
import warnings

import numpy as np

import spincyl as sc

HERTZ = 11_025
LAWS = (
    "DryContour",
    "ViscousContour",
    "RollingResistance",
    "Drilling",
    "AirLinear",
    "AirFilm",
    "BoundaryLayer",
)
SURE = 4.0  # errors within which a coefficient is right


def spin_down(rng):
    """A body, a law whose coefficient stops it within some seconds, the centre, the drift, and the length of
    the recording in seconds."""
    while True:
        wide = rng.uniform(0.02, 0.09)
        tall = wide * rng.uniform(0.04, 0.25)
        sizes = {"outer_diameter": wide, "length": tall}
        if rng.random() < 0.5:
            sizes["fillet"] = tall * rng.uniform(0.02, 0.4)
        elif rng.random() < 0.5:
            sizes["inner_diameter"] = wide * rng.uniform(0.2, 0.8)
        body = sc.measured(**sizes)
        kind = getattr(sc.loss, str(rng.choice(LAWS)))
        centre = str(rng.choice(["rest", "rolling"]))
        start, lasts = math.radians(rng.uniform(12, 25)), rng.uniform(4.0, 9.0)
        # the time is inversely proportional to the coefficient
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                one = sc.drift(body.natural, start, kind(1e-9), centre=centre)
                end = (
                    one.stops_at if np.isfinite(one.stops_at) and kind(1.0).exponent else one.time(start / 4)
                )
                law = kind(1e-9 * body.scale.seconds(float(end)) / lasts)
                drift = sc.drift(body.natural, start, law, centre=centre)
            except ValueError:  # no film under a tube, or no such drift
                continue
        if np.isfinite(drift.stops_at):
            lasts = body.scale.seconds(float(drift.stops_at)) * 0.985
        return body, law, centre, drift, min(lasts, 12.0)


def recording(seed):
    """Times and sound, the body, and its true law and centre."""
    rng = np.random.default_rng(seed)
    body, law, centre, drift, lasts = spin_down(rng)
    second = body.scale.seconds(1.0)
    t = np.arange(int(lasts * HERTZ)) / HERTZ
    coarse = np.linspace(0.0, lasts, 20_000)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        rate = drift.precession(coarse / second) / second
    turned = np.concatenate([[0.0], np.cumsum((rate[1:] + rate[:-1]) / 2 * np.diff(coarse))])
    phi = np.interp(t, coarse, turned) + rng.uniform(0, 2 * np.pi)
    tones = rng.uniform(1200, 4500, 3)
    ring = sum(
        size * np.sin(2 * np.pi * f * t + rng.uniform(0, 2 * np.pi))
        for f, size in zip(tones, (1, 0.6, 0.3), strict=True)
    )
    ring += 0.3 * rng.standard_normal(t.size)
    ring *= np.exp(rng.uniform(0.5, 2.0) * (np.cos(phi) - 1))
    ring /= ring.std()
    lead, tail = (int(rng.uniform(0.0, 2.0) * HERTZ) * (rng.random() < 0.8) for _ in range(2))
    sound = np.concatenate([np.zeros(lead), ring, np.zeros(tail)])
    clock = np.arange(sound.size) / HERTZ
    sound += rng.choice([0.02, 0.1, 0.3]) * rng.standard_normal(sound.size)
    if rng.random() < 0.6:  # the mains, with overtones
        mains, loud = rng.choice([50.0, 60.0]), rng.uniform(0.05, 0.7)
        for k in range(1, 13):
            sound += loud / k * np.sin(2 * np.pi * k * mains * clock + rng.uniform(0, 2 * np.pi))
    click = np.arange(int(0.05 * HERTZ)) / HERTZ
    if lead and rng.random() < 0.6:  # by hand: scratches and taps until the body is let go
        hand = int(min(lead, rng.uniform(0.2, 1.0) * HERTZ))
        loud = np.abs(np.interp(np.arange(hand), np.linspace(0, hand, 12), rng.standard_normal(12)))
        sound[lead - hand : lead] += loud * rng.standard_normal(hand)
        for at in rng.integers(lead - hand, lead, 4):
            _knock(sound, at, rng.uniform(1, 4), click, rng)
    for _ in range(rng.integers(0, 4)):
        _knock(sound, rng.integers(0, sound.size), rng.uniform(1, 6), click, rng)
    return clock, sound, body, law, centre


def _knock(sound, at, loud, click, rng):
    made = (
        loud * np.exp(-click / rng.uniform(0.003, 0.015)) * np.sin(2 * np.pi * rng.uniform(300, 3000) * click)
    )
    some = sound[at : at + made.size]
    some += made[: some.size]


def verdict(seed, rivals=None):
    """The verdict on a recording, and a line with what is true and what was fitted; `rivals` are the names of
    the other laws to fit, by default all."""
    clock, sound, body, law, centre = recording(seed)
    true = f"{type(law).__name__} {centre} {float(law.coefficient):.4g}"
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        try:
            heard = sc.data.wobble(clock, sound)
            rates = {"precession": 2 * np.pi * heard.turns, "precession_err": 2 * np.pi * heard.turns_err}
            names = rivals and dict.fromkeys((type(law).__name__, *rivals))
            laws = names and [getattr(sc.loss, name) for name in names]
            found = sc.data.fit_losses(heard.t, body=body, laws=laws, **rates)
        except ValueError as why:
            return "refused", f"{true}: {why}"
    best = found.best
    doubted = any("no law explains" in str(w.message) for w in told)
    said = f"{true}: {len(heard.t)} times, {found!r}"
    own = next((f for f in found.fits if (f.name, f.centre) == (type(law).__name__, centre)), None)
    if own is None or own.daic > 6:
        return "doubted" if doubted else "wrong", said
    if abs(own.coefficient - float(law.coefficient)) > SURE * own.coefficient_err:
        return (
            "doubted" if doubted else "wrong" if own is best and found.told_apart else "undecided",
            said + " coefficient",
        )
    return "right" if found.told_apart else "undecided", said


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument(
        "--verbose", action="store_true", help="a line for every recording, not the bad ones only"
    )
    options = parser.parse_args()
    counts, begun = collections.Counter(), time.perf_counter()
    for seed in range(options.first, options.first + options.count):
        kind, said = verdict(seed)
        counts[kind] += 1
        if options.verbose or kind in ("wrong", "doubted", "refused"):
            print(f"{seed:4} {kind:9} {said}", flush=True)
    told = ", ".join(
        f"{counts[kind]} {kind}" for kind in ("right", "undecided", "wrong", "doubted", "refused")
    )
    print(f"{options.count} recordings in {time.perf_counter() - begun:.0f} s: {told}")


if __name__ == "__main__":
    main()
