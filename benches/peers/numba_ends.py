"""numba's part of job C: RK4 over one motion at a time, sine and cosine as state; ends are located within a
step."""

import math

import numba as nb


@nb.njit(inline="always", fastmath=True, error_model="numpy")
def rate(s, c, w1, w2, w3, k):
    ct = c / s
    d2 = w1 * (ct * (k[4] * w3 - k[3] * w1) + (k[5] * w3 - k[4] * w1)) + (k[6] * c - k[4] * s)
    d1 = w2 * (ct * w1 + (k[0] * w1 - k[1] * w3))
    normal = 1 + (k[7] * s - c) * d2 - (k[7] * c + s) * w2 * w2
    return -c * w2, s * w2, d1, d2, -w2 * (k[2] * w1 + k[0] * w3), normal


@nb.njit(inline="always", fastmath=True, error_model="numpy")
def stepped(y, p, h, k):
    q = h / 2
    s, c, u, v, w = y
    a = rate(s + q * p[0], c + q * p[1], u + q * p[2], v + q * p[3], w + q * p[4], k)
    b = rate(s + q * a[0], c + q * a[1], u + q * a[2], v + q * a[3], w + q * a[4], k)
    d = rate(s + h * b[0], c + h * b[1], u + h * b[2], v + h * b[3], w + h * b[4], k)
    return (
        s + h / 6 * (p[0] + 2 * (a[0] + b[0]) + d[0]),
        c + h / 6 * (p[1] + 2 * (a[1] + b[1]) + d[1]),
        u + h / 6 * (p[2] + 2 * (a[2] + b[2]) + d[2]),
        v + h / 6 * (p[3] + 2 * (a[3] + b[3]) + d[3]),
        w + h / 6 * (p[4] + 2 * (a[4] + b[4]) + d[4]),
    )


@nb.njit(inline="always", fastmath=True, error_model="numpy")
def ended(y, p):
    """0 while it rolls; 3 lift-off, 2 the other rim, 1 the face."""
    return 3 if p[5] < 0 else 2 if y[1] <= 0 else 1 if y[0] < 1e-8 else 0


@nb.njit(fastmath=True, error_model="numpy")
def run(of, start, h, until, found):
    steps = round(until / h)
    for i in range(start.shape[0]):
        k, x = of[i], start[i]
        y = (math.sin(x[0]), math.cos(x[0]), x[1], x[2], x[3])
        p = rate(y[0], y[1], y[2], y[3], y[4], k)
        kind, t = ended(y, p), 0.0
        for n in range(steps):
            if kind:
                break
            z = stepped(y, p, h, k)
            r = rate(z[0], z[1], z[2], z[3], z[4], k)
            kind = ended(z, r)
            t = (n + 1) * h
            if kind:
                # bisection of the last step, for the first end in it
                low, high = 0.0, h
                for _ in range(45):
                    middle = (low + high) / 2
                    z = stepped(y, p, middle, k)
                    r = rate(z[0], z[1], z[2], z[3], z[4], k)
                    now = ended(z, r)
                    if now:
                        high, kind = middle, now
                    else:
                        low = middle
                t = n * h + high
            y, p = z, r
        found[i, 0], found[i, 1] = kind, t
        found[i, 2], found[i, 3], found[i, 4], found[i, 5] = math.atan2(y[0], y[1]), y[2], y[3], y[4]
