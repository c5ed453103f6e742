"""A cylinder near an unstable steady state stays there longer if it is pushed less, and the push decides where it goes."""

import numpy as np

import spincyl as sc

body = sc.Body.solid(2.5)
start = body.steady(np.radians(20)).kicked(-1e-9)
t = np.linspace(0.0, 250.0, 2501)


def departure(kick: float) -> tuple[float, bool]:
    """Time at which the inclination differs by a degree from its first value, and whether it grows."""
    motion = sc.roll(body, body.steady(np.radians(20)).kicked(kick), t)
    off = np.degrees(motion.theta) - 20
    first = int(np.argmax(np.abs(off) > 1))
    return float(motion.t[first]), bool(off[first] > 0)


if __name__ == "__main__":
    for kick in (1e-6, -1e-6, 1e-9, -1e-9, 1e-12, -1e-12):
        when, up = departure(kick)
        print(
            f"kicked by {kick:g}: gone by a degree {'up' if up else 'down'} after {when:.1f} sqrt(R/g)"
        )
    growth = float(body.growth_rate(np.radians(20)))
    print(
        f"A thousandth of the push costs {np.log(1000) / growth:.1f}: the growth rate is {growth:.4f}."
    )
