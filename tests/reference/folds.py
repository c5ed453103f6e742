"""Writes folds.csv: rates beside the folds of rounded and of sharp rims, and where else m of `steady::rounded` cancels.

    python tests/reference/folds.py

It needs mpmath, and a second. The rate of a steady state with the centre at rest is that of the moment of momentum, in
three dimensions: w lies along the line from the contact to the centre, and phi'^2 (z x I w/phi').e2 = (r x z).e2. In 50
digits; kappa_c is a central difference over 1e-15, right to 25. Inputs and rates are hexadecimal, a rate as the double
next to it and the double next to the rest; `lost` is by how much n exceeds m = n + d A cos.
"""

import csv
import pathlib

from mpmath import mp

HERE = pathlib.Path(__file__).parent

# ell, I1, I3, fillet, and a fold to six digits: twenty where n exceeds m more than fortyfold, six others, nine sharp rims.
FOLDS = (
    (0.037, 1.2081, 1.629, 0.8312, 2.159384),
    (0.2174, 0.9339, 1.4773, 0.9235, 2.600318),
    (0.2816, 1.0752, 1.6297, 0.9782, 2.789186),
    (0.0666, 1.0246, 1.6235, 0.7763, 2.232729),
    (0.113, 1.1691, 1.715, 0.8726, 2.401896),
    (0.1242, 0.9673, 1.2514, 0.9498, 2.546801),
    (0.2976, 0.9517, 1.5136, 0.9714, 2.770557),
    (0.0467, 1.0939, 1.6001, 0.7958, 2.177645),
    (0.1713, 0.9085, 1.4311, 0.8922, 2.507886),
    (0.0951, 1.414, 1.7306, 0.9571, 2.520344),
    (0.1063, 1.0533, 1.6887, 0.8184, 2.34688),
    (0.1538, 1.2712, 1.7273, 0.9465, 2.578137),
    (0.0335, 1.1043, 1.6725, 0.7463, 2.102928),
    (0.0629, 1.1388, 1.6709, 0.8149, 2.242476),
    (0.2052, 1.075, 1.5223, 0.963, 2.677271),
    (0.0062, 1.173, 1.7417, 0.6959, 1.875235),
    (0.048, 1.16, 1.4855, 0.8821, 2.249076),
    (0.2461, 1.2338, 1.7265, 0.9886, 2.831704),
    (0.2259, 0.9621, 1.5674, 0.9199, 2.601746),
    (0.0753, 0.9655, 1.1579, 0.9516, 2.46052),
    (0.0568, 1.3304, 1.3392, 0.711, 1.181511),
    (0.3689, 1.9519, 1.1416, 0.8178, 2.383556),
    (0.1464, 0.9016, 1.7274, 0.6462, 0.183579),
    (0.1464, 0.9016, 1.7274, 0.6462, 2.48836),
    (0.1464, 0.9016, 1.7274, 0.6462, 2.719664),
    (0.4459, 1.5437, 1.3006, 0.8789, 2.333034),
    (1.2019, 0.5842, 0.9243, 0.0, 0.307605),
    (0.7186, 0.8198, 0.9508, 0.0, 0.668839),
    (0.5614, 1.1484, 1.2527, 0.0, 0.833586),
    (0.7689, 0.5027, 0.7061, 0.0, 0.508574),
    (0.6236, 0.3771, 0.6966, 0.0, 0.448016),
    (1.3144, 1.3397, 2.6291, 0.0, 0.220439),
    (1.321, 1.1291, 1.3904, 0.0, 0.392361),
    (1.321, 1.1291, 1.3904, 0.0, 1.00228),
    (1.321, 1.1291, 1.3904, 0.0, 1.375309),
)


def square(body, theta):
    """The square of the reduced rate."""
    ell, i1, i3, rho = map(mp.mpf, body)
    s, c, a = mp.sin(theta), mp.cos(theta), 1 - rho
    radius, depth = a + rho * s, ell + rho * c
    # the moment of momentum along e1 and e3 for phi' = 1; of a ball over the sine
    along = (i1 * s, i3 * s * depth / radius) if a else (i1, i3 * depth)
    horizontal = c * along[0] - s * along[1] if a else c * along[0] - along[1]
    return -i3 * (ell * s - a * c if a else ell) / horizontal


def slope(body, theta):
    """dlog rate/dlog theta."""
    h = mp.mpf("1e-15")
    ends = [mp.log(square(body, theta * (1 + way * h))) for way in (1, -1)]
    return (ends[0] - ends[1]) / (4 * h)


def lost(body, theta):
    """n over m."""
    ell, i1, i3, rho = map(mp.mpf, body)
    s, c, a = mp.sin(theta), mp.cos(theta), 1 - rho
    n = a * c - ell * s if a else -ell
    return abs(n / (n + (i1 / i3 - 1) * (c * (a + rho * s) if a else rho * c)))


def rows():
    """Bodies, inclinations."""
    for *body, place in FOLDS:
        ends = (place - 1e-6, place + 1e-6)
        fold = mp.findroot(lambda theta, body=body: slope(body, theta), ends, solver="anderson", tol=1e-30)
        for shift in (0, 1e-9, -1e-7, 1e-4):
            yield body, float(fold * (1 + shift))
    # a body whose rate was 185 ulp off
    found = (0.12913720003876844, 1.0717490295297616, 1.50487749204878, 0.9136143744371308)
    yield found, 2.4789021542360583
    # balls whose rate has its pole at the top, or next to that; a flat ring next to its side
    for ell in (1.0, 1.0 + 2.0**-40):
        for theta in (1e-9, 1e-5, 0.1):
            yield (ell, 2.0, 1.0, 1.0), theta
    for off in (1e-12, 1e-7, -1e-4):
        yield (0.0, 0.5, 1.0, 0.5), float(mp.pi / 2 - off)


def main():
    mp.dps = 50
    with (HERE / "folds.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(("ell", "i1", "i3", "fillet", "theta", "rate", "rest", "kappa_c", "lost"))
        for body, theta in rows():
            exact = mp.mpf(theta)
            rate = mp.sqrt(square(body, exact))
            near = float(rate)
            words = [float(x).hex() for x in (*body, theta, near, rate - near)]
            kappa = abs(slope(body, exact))
            table.writerow((*words, f"{float(kappa):.6e}", f"{float(lost(body, exact)):.3e}"))


if __name__ == "__main__":
    main()
