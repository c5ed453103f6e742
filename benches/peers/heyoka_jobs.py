"""heyoka's part: Taylor's method compiled for the machine, eight motions at a time, on one thread; and the reference
of all errors, in extended precision at a tolerance of 1e-19."""

from scene import T, best, coefficients


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


def reference(np, ell, start):
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


def curve(np, ell, start, tolerances, lanes=8):
    """(tolerance, microseconds a motion, final states) for each tolerance."""
    import heyoka as hy

    s, c = np.sin(start[:, 0]), np.cos(start[:, 0])
    first, of = np.concatenate([start, np.stack([s, c, c / s], axis=1)], axis=1), coefficients(ell)
    for tol in tolerances:
        ta = hy.taylor_adaptive_batch(
            system(hy, True), np.ones((7, lanes)), pars=np.ones((7, lanes)), tol=tol
        )
        found = np.empty((ell.size, 4))

        def run(ta=ta, found=found):
            for i in range(0, ell.size, lanes):
                ta.set_time(0.0)
                ta.state[:], ta.pars[:] = first[i : i + lanes].T, of[:, i : i + lanes]
                ta.propagate_until(T)
                found[i : i + lanes] = ta.state[:4].T

        seconds = best(run, rounds=4)
        yield tol, seconds / ell.size * 1e6, found
