"""Random starts at rest or nearly so, by every method, against an independent integrator.

`benches/claims.py --of starts` asks the same of a hundred thousand motions, of long times and of the last digits.
"""

import math
import pathlib
import sys

import numpy as np
import pytest
from mpmath import mp, mpf

import spincyl as sc

HERE = pathlib.Path(__file__).parent
sys.path[:0] = [str(HERE / "reference"), str(HERE.parent / "benches")]
import axes  # noqa: E402
import draws  # noqa: E402
import newton_euler  # noqa: E402

COUNT, T, STEPS = 400, 2.0, 1000
DONE, FACE, SIDE, LIFT_OFF = (int(sc.Ending[name]) for name in ("DONE", "FACE", "SIDE", "LIFT_OFF"))


@pytest.mark.parametrize("contact", ["rolling", "smooth"])
def test_the_axes_that_follow_and_the_laboratory_know_the_same_accelerations(contact):
    rng = np.random.default_rng(1)
    for _ in range(20):
        x = [*np.exp(rng.normal(size=3)), rng.uniform(0.01, 3.1), *rng.normal(size=3)]
        ell, i1, i3, theta, *w = (mpf(float(v)) for v in x)
        s, c = mp.sin(theta), mp.cos(theta)
        rates, force = axes.rates_and_force(contact, [ell, i1, i3], s, c, w, mpf)
        known = newton_euler.derivative((ell, i1, i3), (theta, *w), contact)
        assert max(abs(a - b) for a, b in zip(rates, known[1:], strict=True)) < 1e-12 * max(map(abs, known))
        if contact == "smooth":
            assert max(map(abs, axes.horizontal(force, s, c))) < 1e-12


def starts(contact):
    """Starts at rest or nearly so, but not so flat that a fixed step would fail."""
    rng, found = np.random.default_rng(20), []
    scene = {"contact": contact, "mu": math.inf, "beyond": False}
    while len(found) < COUNT:
        start = draws.at_rest(rng, scene)
        if 0.05 < start.theta < 3.1 and start.ell < 10:
            found.append(start)
    return found


def integrated(contact, columns, steps):
    """All motions at once by fourth-order Runge-Kutta: the states at T, and (theta, N) at every step."""
    body, y, h = columns[:3], columns[3:].copy(), T / steps
    told = []

    def rate(y):
        s, c = np.sin(y[0]), np.cos(y[0])
        rates, force = axes.rates_and_force(contact, body, s, c, y[1:], float)
        return np.array([-y[2], *rates]), axes.vertical(force, s, c)

    with np.errstate(all="ignore"):  # motions continue beyond the table with meaningless numbers
        for _ in range(steps):
            k1, normal = rate(y)
            told.append((y[0], normal))
            k2, _ = rate(y + h / 2 * k1)
            k3, _ = rate(y + h / 2 * k2)
            k4, _ = rate(y + h * k3)
            y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        told.append((y[0], rate(y)[1]))
    return y, np.array(told)


def first_end(start, told):
    """The first end and its time to within a step; None if the steps do not decide it."""
    theta, normal = told
    flat = np.minimum(theta, np.pi - theta)
    margins = {LIFT_OFF: normal}
    if start.ell > 0:
        margins[SIDE] = np.pi / 2 - theta
    if start.w1 == 0 and start.w3 == 0:  # only planar motions reach theta = 0
        margins[FACE] = flat
    first = {k: i[0] for k, m in margins.items() if (i := np.flatnonzero(~(m > 0))).size}
    kind = min(first, key=first.get, default=DONE)
    last = first.get(kind, theta.size - 1)
    # passes close to the table within a few steps
    if FACE not in margins and not flat[: last + 1].min() > 0.02:
        return None
    others = [m for k, m in margins.items() if k != kind]
    if any(m[: last + 1].min() < 1e-3 for m in others):
        return None
    if kind == DONE:
        return DONE, T
    m = margins[kind]
    if kind != FACE and not (last + 1 < m.size and m[last + 1] < -1e-4):  # grazes the limit
        return None
    return kind, max(last - 1, 0) * T / (theta.size - 1)


def routes(start, swept, i):
    """(name, status, time of the end, state at T, claimed error) by every method."""
    body, state = sc.Body(*start[:3]), sc.State(*start[3:7])
    for want in ((), ("pose", "force")):
        m = sc.roll(body, state, [T / 2, T], t0=0.0, contact=start.contact, want=want)
        yield f"roll, want={want}", int(m.status), m.event.time if m.event else T, m.y[:, -1:], m.error
    final = np.array([[swept[name].values[i]] for name in ("theta", "w1", "w2", "w3")])
    yield (
        "sweep.roll",
        int(swept["status"].values[i]),
        float(swept["end"].values[i]),
        final,
        float(swept["error"].values[i]),
    )


@pytest.mark.parametrize("contact", ["rolling", "smooth"])
def test_every_start_at_rest_or_almost_goes_where_newton_and_euler_send_it(contact):
    drawn = starts(contact)
    columns = np.array([s.numbers for s in drawn]).T
    rough, _ = integrated(contact, columns, STEPS)
    exact, told = integrated(contact, columns, 2 * STEPS)
    swept = sc.sweep.roll(
        sc.Body(*columns[:3]), sc.State(*columns[3:]), T, contact=contact, want=("final", "end")
    )
    compared, ends, wrong = 0, set(), []
    for i, start in enumerate(drawn):
        end = first_end(start, told[:, :, i].T)
        # the difference of two steps is sixteen times the error of the finer one
        doubt = np.abs(exact[:, i] - rough[:, i]).max() / 15
        if end is None or (end[0] == DONE and not doubt < 1e-10):
            continue
        compared += 1
        ends.add(end[0])
        for name, status, time, state, claimed in routes(start, swept, i):
            ok = status == end[0] and abs(time - end[1]) < 3 * T / STEPS
            if ok and status == DONE:
                ok = np.abs(state[:, 0] - exact[:, i]).max() <= 10 * claimed + 1e-9
            if not ok:
                wrong.append(f"{name}: {start.line(T)}  # {sc.Ending(end[0]).name} at {end[1]:.6g}")
    assert not wrong, f"{len(wrong)} of {3 * compared} wrong:\n" + "\n".join(wrong[:5])
    assert compared > COUNT / 2
    assert {DONE, SIDE, LIFT_OFF} <= ends
