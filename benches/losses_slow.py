"""Full motions with small losses against the drift of rolling, and the powers by which a whirr ends.

    python benches/losses_slow.py        half a minute

1. The largest difference of theta between the full motion and the drift (b) of rolling without nutation, over
   the same part of the drift, as the coefficient is halved. It is proportional to the coefficient: power 1.
2. The exponent of theta as a power of the time left, thin disk, from 0.05 to 0.005 rad: fitted to the full
   motion together with the time of its end. For linear air, which does not end, the fitted rate over that of
   the closed solution. Drilling is left out: without slip it only turns the disk until w_z = 0, and then
   takes no energy.
3. The decay of a small nutation: its amplitude goes as theta^q, thin disk, from 0.05 to 0.005 rad.
4. The fastest precession phi' of a thin disk over a power of the coefficient; the motion starts at a hundred
   times the inclination at which the end begins.

The numbers beside these are those of the theory.
"""

import math

import numpy as np
from scipy.optimize import curve_fit

import spincyl as sc

LAWS = {
    "dry": sc.loss.DryContour,
    "viscous": sc.loss.ViscousContour,
    "rolling": sc.loss.RollingResistance,
    "drilling": sc.loss.Drilling,
    "air": sc.loss.AirLinear,
    "air2": sc.loss.AirQuadratic,
    "film": sc.loss.AirFilm,
    "layer": sc.loss.BoundaryLayer,
}
THIN = sc.Body.solid(0.0)
I1 = 0.25
NOD = math.sqrt(3 * I1 / (I1 + 1))  # rate of the nutation over that of the precession, thin disk near flat


# 1. The drift of rolling.


def linear():
    print("full motion less drift (b) | law | coefficient | differences as it is halved | power")
    cases = [
        ("solid cylinder, ell 2.5, from 0.30", sc.Body.solid(2.5), 0.30, 2e-3, 16.0),
        ("paper's tube, from 1.35", sc.Body.tube(6.0, bore=0.8), 1.35, 2e-3, 10.0),
        ("Euler's disk, from 0.30", sc.Body.solid(0.0128 / 0.0751), 0.30, 2e-3, 10.0),
    ]
    worst = 0.0
    for named, body, theta, coefficient, until in cases:
        for name, law in LAWS.items():
            first = coefficient * {"film": 0.05, "layer": 0.2}.get(name, 1.0)
            apart = []
            for k in range(5):
                t = np.linspace(0, until * 2**k, 401)
                m = sc.roll(body, body.steady(theta), t, losses=law(first / 2**k))
                if m.t.size != t.size:
                    raise ArithmeticError(f"{named}, {name}: {m.message}")
                apart.append(
                    np.abs(
                        m.theta - sc.drift(body, theta, law(first / 2**k), centre="rolling").theta(t)
                    ).max()
                )
            power = math.log2(apart[-2] / apart[-1])
            worst = max(worst, abs(power - 1))
            told = " ".join(f"{x:.2e}" for x in apart)
            print(f"{named} | {name} | {first:g} | {told} | {power:.3f}", flush=True)
    print(f"farthest from 1: {worst:.3f}\n")


# 2. and 3. A thin disk from 0.05 rad on.

HIGH, LOW = 0.05, 0.005
SMALL = {"dry": 1e-6, "viscous": 1e-6, "rolling": 1e-4, "film": 1e-9, "layer": 1e-7, "air": 1e-5}
POWERS = {"dry": 2 / 3, "viscous": 1 / 2, "rolling": 2.0, "film": 1 / 3, "layer": 4 / 9}
DAMPING = {"dry": 1.45, "viscous": 1.25, "film": 1.75, "layer": 1.75, "rolling": 1.10}


def time_to(name, coefficient, theta):
    """The time from HIGH to theta of a thin disk, near flat."""
    k, root = coefficient, math.sqrt(I1)
    whole = {
        "dry": lambda x: root * x**1.5 / k,
        "viscous": lambda x: 3 * I1 * x**2 / (4 * k),
        "rolling": lambda x: 3 * math.sqrt(I1 * x) / k,
        "film": lambda x: 2 * I1 * x**3 / (math.pi * k),
        "layer": lambda x: 2 * I1**1.25 * x**2.25 / (3 * k),
        "air": lambda x: 1.5 * I1 / k * math.log(math.sin(x)),
    }[name]
    return whole(HIGH) - whole(theta)


def followed(name, kick, times):
    """The motion from HIGH on at these times, with the state moved by a kick of w2."""
    start = THIN.steady(HIGH)
    start = start.kicked(kick) if kick else start
    m = sc.roll(THIN, start, np.r_[0.0, times], t0=0.0, losses=LAWS[name](SMALL[name]))
    if m.t.size != len(times) + 1:
        raise ArithmeticError(f"{name}: {m.message}")
    return m


def powers():
    print("law | coefficient | power of theta in the time left | theory | off")
    for name in SMALL:
        t = np.linspace(0, time_to(name, SMALL[name], LOW), 400)[1:]
        theta = followed(name, 0.0, t).theta[1:]
        if name in POWERS:
            stops = time_to(name, SMALL[name], 1e-12)

            def shape(t, scale, power, late, stops=stops):
                return scale + power * np.log(stops * (1 + late) - t)

            found = curve_fit(shape, t, np.log(theta), p0=(0.0, POWERS[name], 1e-3))[0]
            power, theory = found[1], POWERS[name]
        else:
            power = np.polyfit(t, -np.log(np.sin(theta)), 1)[0] / (SMALL[name] / (1.5 * I1))
            theory = 1.0
        print(
            f"{name} | {SMALL[name]:g} | {power:.4f} | {theory:.4f} | {100 * (power / theory - 1):+.2f} %",
            flush=True,
        )
    print()


def damping():
    print("law | coefficient | power of the amplitude in theta | theory | off")
    for name, theory in DAMPING.items():
        levels = np.geomspace(0.8 * HIGH, LOW, 9)
        windows = []
        for level in levels:
            omega = NOD / math.sqrt(I1 * level)
            windows.append(time_to(name, SMALL[name], level) + np.linspace(0, 6 * math.pi / omega, 61))
        m = followed(name, 0.02 * HIGH * NOD / math.sqrt(I1 * HIGH), np.concatenate(windows))
        sizes, where = [], []
        for k in range(len(levels)):
            part = slice(1 + 61 * k, 62 + 61 * k)
            t, rocking, theta = m.t[part] - m.t[part][0], m.w[part, 1], m.theta[part].mean()

            def wave(t, a, b, c, d, omega):
                return a + b * t + c * np.cos(omega * t) + d * np.sin(omega * t)

            omega = NOD / math.sqrt(I1 * theta)
            size = np.ptp(rocking) / 2
            found = curve_fit(wave, t, rocking / size, p0=(0, 0, 0.7, 0.7, omega))[0]
            sizes.append(size * math.hypot(found[2], found[3]) / abs(found[4]))
            where.append(theta)
        power = np.polyfit(np.log(where), np.log(sizes), 1)[0]
        print(
            f"{name} | {SMALL[name]:g} | {power:.3f} | {theory:.2f} | {100 * (power / theory - 1):+.1f} %",
            flush=True,
        )
    print()


# 4. The fastest turn.

FASTEST = {  # the factor and the power of phi', and the inclination at which the end begins
    "dry": (1.81, -1 / 2, lambda k: k, (1e-3, 1e-4, 1e-5)),
    "viscous": (1.10, -1 / 3, lambda k: k ** (2 / 3), (1e-5, 1e-6, 1e-7)),
    "film": (1.29, -1 / 5, lambda k: k ** (2 / 5), (1e-8, 1e-9, 1e-10)),
    "layer": (1.06, -2 / 7, lambda k: k ** (4 / 7), (1e-5, 1e-6, 1e-7)),
}


def fastest():
    print("law | coefficients | fastest turn over the power | theory")
    for name, (factor, power, begins, coefficients) in FASTEST.items():
        found = []
        for k in coefficients:
            start = THIN.steady(min(100 * begins(k), 0.2))
            how = {"t0": 0.0, "losses": LAWS[name](k)}
            m = sc.roll(THIN, start, [1e9], **how)
            last, best = m.event.time, 0.0
            for width in (1.0, 0.1, 0.01):  # closer to the end, where the turn is fastest
                t = last - last * width * np.geomspace(1, 1e-6, 4001)[:-1]
                m = sc.roll(THIN, start, t, **how)
                best = max(best, np.abs(m.w[:, 0] / np.sin(m.theta)).max())
            found.append(best / k**power)
        told = ", ".join(f"{x:.4f}" for x in found)
        print(f"{name} | {', '.join(f'{k:g}' for k in coefficients)} | {told} | {factor}", flush=True)


def main():
    for part in (linear, powers, damping, fastest):
        part()


if __name__ == "__main__":
    main()
