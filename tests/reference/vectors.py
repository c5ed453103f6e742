"""Vectors of three numbers of any kind: floats, those of mpmath or gmpy2, series of a tape, expressions."""


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def add(*vectors):
    return [sum(x[1:], x[0]) for x in zip(*vectors, strict=True)]


def scaled(k, a):
    return [k * x for x in a]


def solver(columns):
    """The solution of the 3 x 3 linear system with these columns, of what is known, by Cramer's rule."""
    minors = [cross(columns[(i + 1) % 3], columns[(i + 2) % 3]) for i in range(3)]
    volume = dot(columns[0], minors[0])
    return lambda known: [dot(known, minor) / volume for minor in minors]
