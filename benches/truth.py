"""The truth with which results are compared: Newton's and Euler's equations in Taylor series, by heyoka.

The equations are those of tests/reference/axes.py, which solves a 3 x 3 system for the accelerations and
shares nothing with the library. heyoka integrates them with 64, 113 or more bits, and finds where N, mu^2 N^2
- F_h^2, pi/2 - theta or theta - 1e-10 vanish as zeros of the Taylor polynomials of a step. Inputs are the
exact doubles.

Units: lengths R, times sqrt(R/g), moments M R^2, forces M g.
"""

import functools
import math
import pathlib
import sys
from typing import NamedTuple

import heyoka as hy
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tests" / "reference"))
from axes import horizontal, rates_and_force, vertical

DONE, FACE, SIDE, LIFT_OFF, SLIP = range(5)
#: inclination below which a face has landed, as in the library
FLAT = 1e-10
#: significant bits: NumPy's or heyoka's type, and the tolerance of a step
TYPES = {64: (np.longdouble, "1e-19"), 113: (hy.real128, "1e-33")}


class Path(NamedTuple):
    """The true motion: the kind, time and state of its end, and the rows at the times before that."""

    kind: int
    time: float  # of the end; the last time if it is done
    end: np.ndarray  # theta, w1, w2, w3 (phi, psi, x, y) at the end
    rows: np.ndarray  # (times reached, 4 or 8)


@functools.cache
def quarter_turn(number):
    """pi/2 to the digits of a type."""
    from mpmath import mp

    with mp.workdps(90):
        text = mp.nstr(mp.pi / 2, 85)
    return number(text, 280) if number is hy.real else number(text)


def system(contact, pose):
    """heyoka's equations, and the expressions that vanish at the ends, in the order of _ENDS."""
    theta, w1, w2, w3, phi, psi, x, y = hy.make_vars("theta", "w1", "w2", "w3", "phi", "psi", "x", "y")
    s, c = hy.sin(theta), hy.cos(theta)
    rates, force = rates_and_force(
        contact, [hy.par[0], hy.par[1], hy.par[2]], s, c, [w1, w2, w3], hy.expression
    )
    equations = [(theta, -w2), (w1, rates[0]), (w2, rates[1]), (w3, rates[2])]
    if pose:
        turn = w1 / s
        spin = w3 - c * turn
        equations += [(phi, turn), (psi, spin)]
        if contact == "rolling":
            # the contact point runs along e2 at the speed of the spin
            equations += [(x, -spin * hy.sin(phi)), (y, spin * hy.cos(phi))]
        else:
            # the centre is at rest: contact = centre - (c - ell s) along the lean
            out, out_rate = c - hy.par[0] * s, (s + hy.par[0] * c) * w2
            equations += [
                (x, -out_rate * hy.cos(phi) + out * turn * hy.sin(phi)),
                (y, -out_rate * hy.sin(phi) - out * turn * hy.cos(phi)),
            ]
    normal, (lean, along) = vertical(force, s, c), horizontal(force, s, c)
    margin = hy.par[3] * hy.par[3] * normal * normal - lean * lean - along * along
    return equations, (
        theta - hy.par[5],
        2 * hy.par[4] - hy.par[5] - theta,
        hy.par[6] - theta,
        normal,
        margin,
    )


_ENDS = (FACE, FACE, SIDE, LIFT_OFF, SLIP)


class Integrator:
    """One compiled system; `watched`: it stops where the model ends, else only where the face lands."""

    def __init__(self, contact, bits, pose, watched, slips):
        self.number = functools.partial(hy.real, prec=bits) if bits > 113 else TYPES[bits][0]
        self.kind = hy.real if bits > 113 else self.number
        equations, margins = system(contact, pose)
        use = [0, 1] + ([2, 3] if watched else []) + ([4] if watched and slips else [])
        self.ends = [_ENDS[i] for i in use]
        falling = hy.event_direction.negative
        events = [hy.t_event(margins[i], direction=falling, fp_type=self.kind) for i in use]
        zeros = np.array([self.number(0.0)] * len(equations), dtype=self.kind)
        zeros[0] = self.number(1.0)
        more = {"prec": bits} if bits > 113 else {}
        tol = self.number(2.0) ** -(bits - 1) if bits > 113 else self.number(TYPES[bits][1])
        self.ta = hy.taylor_adaptive(
            equations,
            zeros,
            pars=np.array([self.number(1.0)] * (7 if watched else 6), dtype=self.kind),
            t_events=events,
            fp_type=self.kind,
            tol=tol,
            **more,
        )

    def begin(self, start):
        ta, number = self.ta, self.number
        ta.reset_cooldowns()
        ta.time = number(0.0)
        state = [number(x) for x in start[3:7]] + [number(0.0)] * (len(ta.state) - 4)
        for i, x in enumerate(state):
            ta.state[i] = x
        # only a body that falls in a plane reaches theta = 0; any other one turns before
        flat = 0.0 if start.w1 == 0 and start.w3 == 0 else FLAT
        right = quarter_turn(self.kind)
        side = right if start.ell > 0 else 10.0
        mu = start.mu if math.isfinite(float(start.mu)) else 0.0
        for i, x in enumerate([*start[:3], mu, right, flat, side][: len(ta.pars)]):
            ta.pars[i] = number(x)

    def until(self, t, steps):
        """None if the motion comes to `t`, else the kind of its end."""
        outcome = self.ta.propagate_until(self.number(t), max_steps=steps)[0]
        if outcome == hy.taylor_outcome.time_limit:
            return None
        index = -int(outcome) - 1
        if 0 <= index < len(self.ends):
            return self.ends[index]
        raise ArithmeticError(f"heyoka stopped: {outcome}")


@functools.cache
def integrator(contact, bits, pose, watched, slips):
    return Integrator(contact, bits, pose, watched, slips)


def force(start):
    """w2', N and the horizontal force at the start, to 113 bits."""
    ell, i1, i3, theta, *w = (hy.real128(x) for x in start.numbers)
    s, c = np.sin(theta), np.cos(theta)
    rates, f = rates_and_force(start.contact, [ell, i1, i3], s, c, w, hy.real128)
    lean, along = horizontal(f, s, c)
    return rates[1], vertical(f, s, c), np.sqrt(lean * lean + along * along)


def at_start(start):
    """The kind of end of a motion that is over at its start, as the library documents it; else None."""
    right = np.pi / 2
    rate, normal, friction = force(start)
    if start.ell > 0:
        falls = start.w2 < 0 or (start.w2 == 0 and rate <= 0)
        if start.theta > right or (start.theta == right and falls):
            return SIDE
    if normal <= 0:
        return LIFT_OFF
    if math.isfinite(start.mu) and friction > hy.real128(start.mu) * normal:
        return SLIP
    return None


def path(start, times, *, bits=113, pose=False, beyond=False, steps=20_000):
    """The true motion at `times`, in order and of one sign, and its first end; `beyond`: rows past it, to the face.

    Backward in time is forward with all velocities reversed. More than `steps` Taylor steps between two times are
    an ArithmeticError.
    """
    if times[-1] < 0:
        back = reversed_(start)
        found = path(back, [-t for t in times], bits=bits, pose=pose, beyond=beyond, steps=steps)
        for y in (found.end, *found.rows):
            y[1:4] = -y[1:4]
        return found._replace(time=-found.time)
    slips = math.isfinite(float(start.mu)) and start.contact == "rolling"
    ended = at_start(start)
    rows, event = [], None
    if ended is not None:
        width = 8 if pose else 4
        event = (ended, start.theta * 0, np.array([*start[3:7], *[0.0] * (width - 4)], dtype=object))
    else:
        follow = integrator(start.contact, bits, pose, True, slips)
        follow.begin(start)
        for t in times:
            kind = follow.until(t, steps)
            if kind is not None:
                event = (kind, *landed(kind, follow.ta))
                break
            rows.append(follow.ta.state.copy())
    if event is None:
        return Path(DONE, times[-1], rows[-1].copy(), np.array(rows))
    if beyond and event[0] != FACE:
        rows = []
        follow = integrator(start.contact, bits, pose, False, False)
        follow.begin(start)
        for t in times:
            if follow.until(t, steps) is not None:
                break
            rows.append(follow.ta.state.copy())
    return Path(*event, np.array(rows))


def paths(starts, times, **how):
    """As `path`, for each start; None where it takes too many steps."""
    found = []
    for start in starts:
        try:
            found.append(path(start, times, **how))
        except ArithmeticError:
            found.append(None)
    return found


def reversed_(start):
    return start._replace(w1=-start.w1, w2=-start.w2, w3=-start.w3)


def landed(kind, ta):
    """Time and state of an end; below FLAT a face falls on at constant speed."""
    time, state = ta.time, ta.state.copy()
    if kind == FACE:
        at = 0 * state[0] if state[0] < 1 else 2 * quarter_turn(type(time))
        time = time + abs(at - state[0]) / abs(state[2])
        state[0] = at
    return time, state
