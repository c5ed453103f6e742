"""The jobs that all contestants do: the axes and points of the map, the ensembles, the launches; and a
timer."""

import time

import numpy as np

T = 20.0


def best(run, rounds=9, seconds=2.5):
    """Least wall time of a call, after one that warms up."""
    run()
    times, until = [], time.perf_counter() + seconds
    while len(times) < rounds and (not times or time.perf_counter() < until):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return min(times)


def axes(side=4000):
    """Inclinations and aspect ratios of the map."""
    return np.linspace(1e-3, np.pi / 2 - 1e-3, side), np.linspace(0.05, 3.0, side)


def points(count=16_000_000):
    """Inclinations and aspect ratios of scattered points."""
    random = np.random.default_rng(12345)
    return random.uniform(1e-3, np.pi / 2 - 1e-3, count), random.uniform(0.05, 3.0, count)


def ensemble(kick, count=65_536, one_body=False):
    """ell (n,) and theta, w1, w2, w3 (n, 4) of solid cylinders, with w2 = `kick` added to a steady state.

    A lattice that any language can build. With `one_body` they all have ell = 1.5. Each of the four columns
    is contiguous, as a State holds it; a contestant that needs rows copies them before its time is taken.
    """
    i = np.arange(count, dtype=np.int64)
    ell = np.full(count, 1.5) if one_body else 0.5 + 2.5 * (i + 0.5) / count
    share = 0.1 + 0.8 * (((i * 40_503) % 65_536) + 0.5) / 65_536
    a = 0.5 * (1 + 4 * ell * ell / 3)
    low = np.maximum(np.arctan(a / ell), np.arctan(1 / ell))
    theta = low + (np.pi / 2 - low) * share
    s, t = np.sin(theta), np.tan(theta)
    w1 = np.sqrt(2 * (1 - ell * t) / ((a - ell * t) * s)) * s
    return ell, np.stack([theta, w1, np.full(count, kick), ell * w1]).T


def coefficients(ell):
    """p, q, r and al/J, k/J, b/J, 1/J of docs/physics.md, section 6, for a solid cylinder; (7, n)."""
    i1, i3 = 0.25 + ell * ell / 3, 0.5
    d, j = i1 * i3 + i1 + i3 * ell * ell, i1 + 1 + ell * ell
    rows = [i3 * ell / d, i3 * (i3 + 1) / d, i1 / d, (i1 + ell * ell) / j, ell / j, (i3 + 1) / j, 1 / j]
    return np.stack([np.broadcast_to(x, ell.shape) for x in rows])


def errors(y, reference):
    """Largest and 99th percentile, over motions, of the worst component's error."""
    worst = np.abs(np.asarray(y) - reference).max(axis=1)
    return float(worst.max()), float(np.quantile(worst, 0.99))


TUBE = {"ell": 6.0, "i1": 12.41, "i3": 0.82}
SLOW = 3.0  # the variable of the slipping motions is sigma, dt = |u|/(|u| + SLOW) dsigma


def launches(count=10_000):
    """theta, w1, w2, w3 (n, 4), slip u_h, u_2 (n, 2), mu (n,) of the paper's tube shot from under a finger.

    A lattice that any language can build: w1 from 3 to 4, launch numbers I3 w1 w3/ell from 1.05 to 1.6, mu
    from 0.15 to 0.3. The impulses act at the end that stays on the table, so v_2 = -(I1/ell) w1.
    """
    i = np.arange(count, dtype=np.int64)
    w1 = 3 + (i + 0.5) / count
    x = 1.05 + 0.55 * (((i * 49_473) % 65_536) + 0.5) / 65_536
    mu = 0.15 + 0.15 * (((i * 37_345) % 65_536) + 0.5) / 65_536
    return launched(w1, x, mu)


def launched(w1, x, mu):
    """As `launches`, for given w1, launch numbers x and mu."""
    ell, i1, i3 = TUBE.values()
    w1, x, mu = (np.atleast_1d(np.asarray(k, dtype=float)) for k in (w1, x, mu))
    w3, zero = x * ell / (i3 * w1), np.zeros(w1.size)
    state = np.stack([zero + np.pi / 2, w1, zero, w3], axis=1)
    return state, np.stack([zero, (ell - i1 / ell) * w1 - w3], axis=1), mu
