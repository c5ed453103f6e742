"""Extrapolation, of numbers of any kind: Gragg's midpoint rule to steps of no length, and polynomials to 0."""


def steps(rates, y, h, counts):
    """One step of y' = rates(part of the step, y), extrapolated from one more number of midpoint steps at a time.

    Of each it tells the best result, and that of one column less.
    """
    table, first = [], rates(0, y)
    for j, n in enumerate(counts):
        step = h / n
        older, old = y, [a + step * b for a, b in zip(y, first, strict=True)]
        for k in range(1, n):
            ahead = zip(older, rates(k * step, old), strict=True)
            older, old = old, [a + 2 * step * b for a, b in ahead]
        last = [a + step * b for a, b in zip(older, rates(h, old), strict=True)]
        row = [[(a + b) / 2 for a, b in zip(old, last, strict=True)]]
        for k in range(1, j + 1):
            m = counts[j - k]
            pairs = zip(row[k - 1], table[k - 1], strict=True)
            row.append([p + (p - q) * (m * m) / (n * n - m * m) for p, q in pairs])
        if table:
            yield row[-1], row[-2]
        table = row


def to_zero(places, values):
    """The value at 0 of the polynomial through these, by Neville's scheme."""
    for step in range(1, len(places)):
        values = [
            (places[j] * values[j + 1] - places[j + step] * values[j]) / (places[j] - places[j + step])
            for j in range(len(places) - step)
        ]
    return values[0]
