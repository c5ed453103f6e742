"""What the tests know of the loss laws, a row for each law, written independently of the library."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from spincyl import loss


class Rates(NamedTuple):
    """The rates in a state of a sharp rim, its weight and its radius, all in natural units or all in SI."""

    weight: float  # the normal force
    spin: float
    rolling: float  # with the rocking
    drilling: float
    whole: float  # |w|
    sine: float  # of theta
    radius: float


def rates(y, weight=1.0, second=1.0, radius=1.0):
    s, c = np.sin(y.theta), np.cos(y.theta)
    spin, drilling = y.w3 - c / s * y.w1, s * y.w1 + c * y.w3
    whole = np.sqrt(y.w1**2 + y.w2**2 + y.w3**2)
    found = (np.abs(spin), np.hypot(s * spin, y.w2), np.abs(drilling), whole)
    return Rates(weight, *(x / second for x in found), s, radius)


class LossRow(NamedTuple):
    """A law: its coefficient, the exponent of its end, a usual coefficient, one as it is printed, its power."""

    coefficient: str
    exponent: float | None
    usual: float
    printed: str
    power: Callable[[Rates], float]  # for a coefficient of 1


ROWS = {
    loss.DryContour: LossRow("eps", 2 / 3, 5e-3, "0.01 mm", lambda at: at.weight * at.spin),
    loss.ViscousContour: LossRow("c", 1 / 2, 1e-3, "1e-08 N m s", lambda at: at.spin**2),
    loss.RollingResistance: LossRow("delta", 2, 5e-3, "0.05 mm", lambda at: at.weight * at.rolling),
    loss.Drilling: LossRow("length", None, 5e-3, "0.02 mm", lambda at: at.weight * at.drilling),
    loss.AirLinear: LossRow("b", None, 1e-2, "1e-09 N m s", lambda at: at.whole**2),
    loss.AirQuadratic: LossRow("b2", None, 1e-2, "1e-09 N m s²", lambda at: at.whole**3),
    loss.AirFilm: LossRow(
        "viscosity", 1 / 3, 1e-5, "1.8e-05 Pa s", lambda at: np.pi / 4 * at.radius**3 * at.spin**2 / at.sine
    ),
    loss.BoundaryLayer: LossRow("k", 4 / 9, 1e-3, "0.1 C", lambda at: at.spin**2.5),
}
#: Each law with its usual coefficient, by its name.
USUAL = {law.__name__: law(row.usual) for law, row in ROWS.items()}
