"""A falling pencil slips backwards on a slippery table and forwards on a rough one."""

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import spincyl as sc

Floats = NDArray[np.float64]


def law(lean: Floats, first: float = 0.0) -> tuple[Floats, Floats]:
    """Normal force and friction of a thin rod that pivots, let go at the lean `first`.

    Per weight, with k = 1/3: (1 + k) N = 1 + k - sin^2 - 2 cos (cos(first) - cos) and
    (1 + k) F = sin (3 cos - 2 cos(first)). F > 0 points to where the pencil falls.
    """
    sin, cos, last = np.sin(lean), np.cos(lean), np.cos(first)
    return (4 / 3 - sin**2 - 2 * cos * (last - cos)) * 3 / 4, sin * (
        3 * cos - 2 * last
    ) * 3 / 4


def let_go(first: float) -> sc.State:
    """Initial state: at rest, at the angle `first` from the balance on the edge."""
    return sc.State(float(body.theta_balance) + first, 0.0, 0.0, 0.0)


def way(motion: sc.Motion) -> str:
    """First direction of the foot: against the fall of the pencil, or with it."""
    first = next(phase for phase in motion.phases if phase.kind == "slipping")
    slipping = motion.slip[motion.t > first.time, 0][0]
    return "backwards" if slipping > 0 else "forwards"


# about its edge its moment is that of a thin rod: I1 = k (1 + ell^2) with k = 1/3
ELL = 25.0
body = sc.Body(ELL, (1 + ELL**2) / 3, 0.5)
table = sc.Coulomb(0.3)
start = let_go(0.01)
t = np.linspace(0.0, 40.0, 8001)


def picture() -> None:
    """Draw the friction that pivoting needs, and the limits of three tables."""
    lean = np.linspace(0.0, np.radians(66), 500)
    normal, friction = law(lean)
    plt.plot(np.degrees(lean), friction / normal, "k", label="what it needs")
    for mu in (0.3, 0.371, 0.5):
        motion = sc.roll(body, start, t, contact=sc.Coulomb(mu))
        first = next(phase for phase in motion.phases if phase.kind == "slipping")
        at = np.degrees(float(first.state.theta) - float(body.theta_balance))
        needed = np.interp(np.radians(at), lean, friction / normal)
        (point,) = plt.plot(
            at, needed, "o", label=rf"$\mu = {mu:g}$: it slips {way(motion)}", ms=9
        )
        plt.hlines(
            [-mu, mu], 0, 66, colors=point.get_color(), linestyles="dashed", lw=1
        )
    plt.axhline(0, color="0.5", lw=0.8)
    plt.xlabel("lean (degrees)")
    plt.ylabel("friction over normal force")
    plt.xlim(0, 66)
    plt.ylim(-1, 0.6)
    plt.title("which way the foot of a falling pencil slips")
    plt.legend(loc="lower left")


if __name__ == "__main__":
    pivots = sc.roll(body, start, t, want="force")
    lean = pivots.theta - float(body.theta_balance)
    most = int(
        np.argmax(np.where(np.cos(lean) > 2 / 3, pivots.friction_coefficient, 0.0))
    )
    needs, at = pivots.friction_coefficient[most], np.degrees(lean[most])
    print(f"Pivoting needs a coefficient of friction of {needs:.5f}", end=" ")
    print(f"at {at:.2f} degrees.")
    for mu in (0.2, 0.3, 0.37, 0.371, 0.5, 1.0):
        motion = sc.roll(body, start, t, contact=sc.Coulomb(mu))
        first = next(phase for phase in motion.phases if phase.kind == "slipping")
        at = np.degrees(float(first.state.theta) - float(body.theta_balance))
        print(f"mu = {mu:g}: slips at {at:.2f} degrees, {way(motion)},", end=" ")
        print(f"and lands after {len(motion.phases)} phases")
