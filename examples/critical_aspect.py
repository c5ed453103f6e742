"""A cylinder with equal moments balances at one inclination at any rate, and above a least rate this is stable for rolling."""

from typing import Literal

import numpy as np

import spincyl as sc

LEAST: dict[Literal["rolling", "smooth"], float] = {
    "rolling": (7 / 81) ** 0.25,
    "smooth": (7 / 4) ** 0.25,
}


def turning(rate: float) -> sc.State:
    """Steady state in which the cylinder is balanced at theta0 and turns at a reduced rate."""
    w1 = float(body.angular_rate(rate)) * np.sin(float(body.theta_balance))
    return sc.State(float(body.theta_balance), w1, 0.0, float(body.ell) * w1)


body = sc.Body.solid(float(sc.Body.critical_aspect()))
start = turning(0.6).kicked(0.01)
t = np.linspace(0.0, 20.0, 2001)

if __name__ == "__main__":
    for contact, least in LEAST.items():
        signs = [
            body.stability(turning(factor * least), contact) > 0
            for factor in (0.999, 1.001)
        ]
        print(
            f"{contact}: stable just below rate {least:.4f}: {signs[0]}, just above: {signs[1]}"
        )
    motion = sc.roll(body, start, t)
    print(f"Pushed, it nods by {np.degrees(np.ptp(motion.theta)):.2f} degrees.")
