"""Gauss collocation with many digits, for face.py: steps, and the places where something happens.

A state is a list of numbers. Equations get and give lists of arrays, one entry for each node of a step.
"""

import functools

import gmpy2
import numpy as np
from gmpy2 import mpfr

TOLERANCE = mpfr("3e-17")  # of the polynomial of the rates; the end of a step errs by about its square
CLOSE = mpfr("1e-33")  # of the states at the nodes
ROOT = mpfr("1e-38")


@functools.cache
def legendre(n):
    """Nodes and weights of Gauss on 0 to 1."""
    nodes, weights = [], []
    for k in range(n):
        x = gmpy2.cos(gmpy2.const_pi() * (k + mpfr("0.75")) / (n + mpfr("0.5")))
        for _ in range(12):
            p, before = x, mpfr(1)
            for j in range(1, n):
                p, before = ((2 * j + 1) * x * p - j * before) / (j + 1), p
            slope = n * (x * p - before) / (x * x - 1)
            x -= p / slope
        nodes.append((1 - x) / 2)
        weights.append(1 / ((1 - x * x) * slope**2))
    return np.array(nodes), np.array(weights)


class Collocation:
    """Steps by so many nodes."""

    def __init__(self, count):
        self.count = count
        self.nodes, self.weights = legendre(count)
        # Legendre's polynomials at the nodes, and their integrals from 0: the rates are a series of them
        x = 2 * self.nodes - 1
        p = [np.array([mpfr(1)] * count), x]
        for k in range(1, count):
            p.append(((2 * k + 1) * x * p[k] - k * p[k - 1]) / (k + 1))
        self.series = np.array([(2 * k + 1) * self.weights * p[k] for k in range(count)])
        integral = [self.nodes] + [(p[k + 1] - p[k - 1]) / (2 * (2 * k + 1)) for k in range(1, count)]
        self.matrix = sum(np.outer(integral[k], self.series[k]) for k in range(count))

    def step(self, rates, y, h, guess=None):
        """The state after h, the states at the nodes, and the size of the last terms of the rates; None if it fails."""
        start = np.array(y)[:, None]
        values = guess if guess is not None else np.repeat(start, self.count, axis=1)
        before = None
        for _ in range(80):
            f = np.array(rates(list(values)))
            new = start + h * f.dot(self.matrix.T)
            change = max(abs(x) for x in (new - values).ravel())
            values = new
            if not change < 1e6:
                return None
            if change < CLOSE or (before is not None and change < 1e-31 and change >= before):
                break
            before = change
        else:
            return None
        f = np.array(rates(list(values)))
        last = f.dot(self.series[-3:].T)
        error = abs(h) * max(abs(x) for x in last.ravel())
        return list(start[:, 0] + h * f.dot(self.weights)), values, error

    def implicit(self, rates, y, h, guess):
        """A step by Newton's method, for a start at which the rates are singular."""
        n, dim = self.count, len(y)
        start, values = np.array(y)[:, None], guess
        for _ in range(40):
            f = np.array(rates(list(values)))
            residual = values - start - h * f.dot(self.matrix.T)
            slopes = []
            for k in range(dim):
                moved = values.copy()
                d = mpfr("1e-24") * np.array([abs(x) + mpfr("1e-12") for x in values[k]])
                moved[k] = moved[k] + d
                slopes.append((np.array(rates(list(moved))) - f) / d)
            whole = np.full((n * dim, n * dim), mpfr(0), dtype=object)
            for i in range(n):
                for j in range(n):
                    for k in range(dim):
                        for q in range(dim):
                            one = mpfr(1) if i == j and k == q else mpfr(0)
                            whole[i * dim + k, j * dim + q] = one - h * self.matrix[i, j] * slopes[q][k, j]
            change = solved(whole, residual.T.ravel()).reshape(n, dim).T
            values = values - change
            if max(abs(x) for x in change.ravel()) < 1e-40:
                f = np.array(rates(list(values)))
                return list(start[:, 0] + h * f.dot(self.weights))
        raise ArithmeticError("the first step does not converge")

    def follow(self, rates, y, h, events, longest=None, scale=None):
        """Goes on until the first of the events, (name, function of a state), becomes negative.

        The name and the state there, and the number of steps.
        """
        taken, most = 0, mpfr(3)
        while taken < 100000:
            allowed = TOLERANCE * gmpy2.sqrt(scale(y)) if scale else TOLERANCE
            if longest is not None:
                h = min(h, longest(y))
            found = self.step(rates, y, h)
            if found is None or not found[2] < allowed:
                h, most = h / 2, mpfr("1.2")
                if h < 1e-60:
                    raise ArithmeticError("the steps vanish")
                continue
            end, values, error = found
            places = [list(values[:, i]) for i in range(self.count)] + [end]
            hits = []
            for name, g in events:
                at = [g(place) for place in places]
                first = next((i for i, x in enumerate(at) if x < 0), None)
                if first is None:
                    continue
                low = self.nodes[first - 1] * h if first else mpfr(0)
                low_g = at[first - 1] if first else g(y)
                high = (self.nodes[first] if first < self.count else mpfr(1)) * h
                hits.append((low, high, name, g, low_g, at[first]))
            taken += 1
            if hits:
                best = None
                for low, high, name, g, low_g, high_g in hits:
                    if best is None or low < best[0]:
                        place = self.place(rates, y, g, low, high, low_g, high_g)
                        if best is None or place[0] < best[0]:
                            best = (*place, name)
                return best[2], best[1], taken
            y = end
            most = min(mpfr(3), most + mpfr("0.2"))
            h *= min(
                most,
                max(mpfr("0.5"), mpfr("0.9") * (allowed / (error + mpfr("1e-60"))) ** (mpfr(1) / self.count)),
            )
        raise ArithmeticError("too many steps")

    def place(self, rates, y, g, low, high, low_g, high_g):
        """Where g vanishes between two places of a step, and the state there."""
        state, side = None, 0
        if low_g <= 0:
            return low, list(y)
        for _ in range(100):
            x = (low * high_g - high * low_g) / (high_g - low_g)
            state = self.step(rates, y, x)[0]
            value = g(state)
            if abs(value) < ROOT or abs(high - low) < ROOT * abs(high):
                return x, state
            if value > 0:
                if abs(x - low) < ROOT * x:
                    return x, state
                low, low_g = x, value
                if side == 1:
                    high_g /= 2
                side = 1
            else:
                if abs(x - high) < ROOT * x:
                    return x, state
                high, high_g = x, value
                if side == -1:
                    low_g /= 2
                side = -1
        return x, state


def solved(matrix, right):
    """The solution of linear equations, by elimination."""
    a, b = matrix.copy(), np.array(right).copy()
    n = len(b)
    for i in range(n):
        k = max(range(i, n), key=lambda r: abs(a[r, i]))
        if k != i:
            a[[i, k]], b[[i, k]] = a[[k, i]], b[[k, i]]
        rows = a[i + 1 :, i] / a[i, i]
        a[i + 1 :, i:] -= np.outer(rows, a[i, i:])
        b[i + 1 :] -= rows * b[i]
    for i in reversed(range(n)):
        b[i] = (b[i] - (a[i, i + 1 :].dot(b[i + 1 :]) if i + 1 < n else 0)) / a[i, i]
    return b
