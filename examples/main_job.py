"""The main job on real input: the paper's bodies in numbers and in motion, and the theta-ell map of 16 million points.

python examples/main_job.py [FOLDER]       writes FOLDER/portrait.png (default: demo)
"""

import os
import sys
import time
from pathlib import Path
from typing import Literal

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import spincyl as sc

INCH = 0.0254
PVC = {"outer_diameter": 5 / 8 * INCH, "length": 3.75 * INCH}
#: (name, body, rim radius in metres). The paper's tube is 5/8 inch by 3 3/4 inches; its cylinders are
#: given by their aspect ratio, here at the tube's radius. Euler's disk: R = 37.55 mm, height 12.8 mm.
BODIES = [
    (
        "PVC tube, thin-walled",
        sc.Body.from_metres(**PVC, inner_diameter=PVC["outer_diameter"]),
        PVC["outer_diameter"] / 2,
    ),
    (
        "PVC tube, wall 1.6 mm",
        sc.Body.from_metres(**PVC, inner_diameter=PVC["outer_diameter"] - 3.2e-3),
        PVC["outer_diameter"] / 2,
    ),
    *(
        (f"solid cylinder {ell:.6g}", sc.Body.solid(ell), PVC["outer_diameter"] / 2)
        for ell in (2.5, 1.5, 1.0, 0.75**0.5, 0.75, 0.375)
    ),
    (
        "Euler's disk",
        sc.Body.from_metres(outer_diameter=75.1e-3, length=12.8e-3),
        37.55e-3,
    ),
]


def verdict(body: sc.Body, state: sc.State) -> str:
    """Text: stable or not on a smooth table and rolling, with the nutation frequency or growth rate."""
    answers = []
    contacts: tuple[Literal["rolling", "smooth"], ...] = ("rolling", "smooth")
    for contact in contacts:
        if body.stable(state, contact):
            answers.append(f"{contact} stable ({body.nutation(state, contact):.3f})")
        else:
            answers.append(
                f"{contact} UNSTABLE ({body.growth_rate(state, contact):.3f})"
            )
    return ", ".join(answers)


def numbers() -> None:
    """Print the main numbers of each body."""
    print(
        "Of each body: the steady states at four rates. theta is the inclination of its axis from the vertical. Then\n"
        "what a kick does: N is the normal force in weights, mu the friction that rolling needs, and the number in\n"
        "brackets bounds the error of all of it."
    )
    for name, body, radius in BODIES:
        scale = sc.Scale(radius)
        critical = scale.hertz(body, 1.0)
        print(
            f"\n{name}: {body!r}\n"
            f"  aspect ratio {body.ell:.6g}, theta0 {np.degrees(body.theta_balance):.4f} deg, "
            f"thetaInf {np.degrees(body.theta_limit):.4f} deg, critical rate {critical:.3f} Hz"
        )
        for rate in (0.8, 1.1, 2.0, 3.0):
            states = body.states(rate)
            count = int(body.count(rate))
            print(
                f"  {rate * critical:7.3f} Hz (rate {rate}):"
                + ("" if count else " no steady state")
            )
            for k in range(count):
                state = sc.State(states.theta[k], states.w1[k], 0.0, states.w3[k])
                print(
                    f"      theta {np.degrees(state.theta):8.4f} deg, {state.contact_radius:6.3f} still symbols a turn, "
                    f"{verdict(body, state)}"
                )
                motion(body, state.kicked(0.02), scale)


def motion(body: sc.Body, start: sc.State, scale: sc.Scale) -> None:
    """Print the effect of a small kick in 20 time units."""
    m = sc.roll(body, start, np.linspace(0, 20, 501), want="force")
    low, high = np.degrees([m.theta.min(), m.theta.max()])
    how = (
        ""
        if m.event is None
        else f", {m.event.ending.name.lower()} after {scale.seconds(m.event.time):.3f} s"
    )
    print(
        f"        kicked by 0.02: theta {low:.2f} to {high:.2f} deg, N {m.normal.min():.3f} to {m.normal.max():.3f}, "
        f"mu {m.friction_coefficient.max():.3f}{how} (error {m.error:.0e})"
    )


def swept(
    theta: np.ndarray, ell: np.ndarray, want: list[str], out: xr.Dataset | None
) -> tuple[xr.Dataset, float]:
    """A map of the steady states, and the seconds that it took."""
    start = time.perf_counter()
    data = sc.sweep.portrait(theta, ell, want=want, out=out)
    return data, time.perf_counter() - start


def portrait(folder: Path) -> None:
    """Sweep 16 million points of the map and draw them."""
    theta, ell = np.linspace(0, np.pi / 2, 4001)[1:], np.linspace(0, 3, 4000)
    print("\nthe theta-ell map of solid cylinders, 4000 x 4000 points:")
    wanted: tuple[list[str], ...] = (
        ["rate"],
        ["rate", "kappa_rolling", "kappa_smooth", "region"],
    )
    for want in wanted:
        # The first access to new memory is slow: this time is not that of the library.
        data, first = swept(theta, ell, want, None)
        data, again = swept(theta, ell, want, data)
        speed = theta.size * ell.size / again / 1e6
        print(
            f"  {', '.join(want):<42} {again:6.3f} s, {speed:7.1f} million points/s, into arrays that are there"
            f" ({first:.3f} s with new memory from the system)"
        )
    region = data["region"].values
    steady = np.count_nonzero(region >= sc.Region.UNSTABLE)
    only = np.count_nonzero(region == sc.Region.STABLE_ROLLING)
    print(
        f"  {steady / region.size:.2%} of the map is steady; of that {only / steady:.2%} is stable only when rolling"
    )
    figure, ax = plt.subplots(figsize=(9, 6.4), layout="constrained")
    sc.plot.portrait(data, ax=ax)
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "portrait.png", dpi=150)
    print(f"  drawn in {folder / 'portrait.png'}")
    play = f"{os.path.relpath(sys.executable)} -m spincyl play -o play.html"
    print(
        f"Open {folder / 'portrait.png'} next, then docs/tour.md; a page to play with: {play}"
    )


if __name__ == "__main__":
    numbers()
    portrait(Path(sys.argv[1] if len(sys.argv) > 1 else "demo"))
