"""heyoka's part: Taylor's method compiled for the machine, eight motions at a time, on one thread; and the reference
of all errors, in extended precision at a tolerance of 1e-19."""

import numpy as np
from scene import T, coefficients


def system(hy, polynomial):
    """The rolling equations; `polynomial`: with sine, cosine and cotangent as state."""
    theta, w1, w2, w3 = hy.make_vars("theta", "w1", "w2", "w3")
    p = [hy.par[i] for i in range(7)]
    if polynomial:
        s, c, ct = hy.make_vars("s", "c", "ct")
    else:
        s, c = hy.sin(theta), hy.cos(theta)
        ct = c / s
    equations = [
        (theta, -w2),
        (w1, w2 * (ct * w1 + p[0] * w1 - p[1] * w3)),
        (w2, w1 * (ct * (p[4] * w3 - p[3] * w1) + p[5] * w3 - p[4] * w1) + p[6] * c - p[4] * s),
        (w3, -w2 * (p[2] * w1 + p[0] * w3)),
    ]
    return equations + ([(s, -c * w2), (c, s * w2), (ct, w2 * (1 + ct * ct))] if polynomial else [])


def first_states(start):
    """States (n, 7), with sine, cosine and cotangent."""
    s, c = np.sin(start[:, 0]), np.cos(start[:, 0])
    return np.concatenate([start, np.stack([s, c, c / s], axis=1)], axis=1)


def reference(ell, start):
    """Final states, from 80-bit arithmetic."""
    import heyoka as hy

    wide = np.longdouble
    zero = np.zeros(4, dtype=wide)
    ta = hy.taylor_adaptive(
        system(hy, False), zero, pars=np.zeros(7, dtype=wide), fp_type=wide, tol=wide("1e-19")
    )
    found, of = np.empty((ell.size, 4)), coefficients(ell.astype(wide))
    for i in range(ell.size):
        ta.time, ta.state[:], ta.pars[:] = wide(0), start[i].astype(wide), of[:, i]
        ta.propagate_until(wide(T))
        found[i] = ta.state.astype(float)
    return found


def eight(ell, start, tol, lanes=8):
    """A job that computes the final states at t = 20, eight motions at a time."""
    import heyoka as hy

    first, of, found = first_states(start), coefficients(ell), np.empty((ell.size, 4))
    ta = hy.taylor_adaptive_batch(system(hy, True), np.ones((7, lanes)), pars=np.ones((7, lanes)), tol=tol)

    def run():
        for i in range(0, ell.size, lanes):
            ta.set_time(0.0)
            ta.state[:], ta.pars[:] = first[i : i + lanes].T, of[:, i : i + lanes]
            ta.propagate_until(T)
            found[i : i + lanes] = ta.state[:4].T
        return found

    return run


def alone(ell, start, tol):
    """As `eight`, for the first motion alone."""
    import heyoka as hy

    first, of = first_states(start), coefficients(ell)
    ta = hy.taylor_adaptive(system(hy, True), np.ones(7), pars=np.ones(7), tol=tol)

    def run():
        ta.time, ta.state[:], ta.pars[:] = 0.0, first[0], of[:, 0]
        ta.propagate_until(T)
        return ta.state[:4].copy()[None]

    return run


def refilled(ta, lanes, first, pars, until, ended):
    """Motions eight at a time to their ends, by a batch integrator with events; a lane that is done takes the
    next one.

    `ended(code, time)` says whether an outcome is an end. Each end is yielded as (motion, code, time, lane,
    rounds of steps so far) while its state is still in the lane.
    """
    n, steps = len(first), 0
    lane, todo, left = [k if k < n else -1 for k in range(lanes)], lanes, min(n, lanes)
    state, given, last = ta.state, ta.pars, np.full(lanes, until)
    state[:], given[:] = first[np.arange(lanes) % n].T, pars[:, np.arange(lanes) % n]
    ta.set_time(0.0)
    ta.reset_cooldowns()
    while left:
        ta.propagate_until(last)
        told, at = ta.propagate_res, ta.time.copy()
        steps += max(x[3] for x in told)
        for k in range(lanes):
            code = int(told[k][0])
            if lane[k] < 0 or not ended(code, at[k]):
                continue
            yield lane[k], code, at[k], k, steps
            at[k] = 0.0
            ta.reset_cooldowns(k)
            if todo < n:
                lane[k], state[:, k], given[:, k] = todo, first[todo], pars[:, todo]
                todo += 1
            else:
                lane[k], last[k], left = -1, 0.0, left - 1
        ta.set_time(at)
