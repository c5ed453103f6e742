"""Physics of spinning and rolling bodies, compiled. Private: use the functions of `spincyl`."""

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "acceleration",
    "acceleration_smooth",
    "angular_momentum",
    "angular_velocity",
    "areas",
    "assembled",
    "axis_up",
    "beta",
    "body_circles",
    "body_i1",
    "body_i3",
    "boundary_rolling",
    "boundary_smooth",
    "bounds",
    "capsule_end",
    "centre_across",
    "centre_along",
    "centre_radius",
    "centre_up",
    "check_ball",
    "check_balls",
    "check_body",
    "check_profile",
    "check_stone",
    "check_stones",
    "check_tube",
    "circle_height",
    "circular_state",
    "circular_w1",
    "circular_w3",
    "codes",
    "columns",
    "contact_radius",
    "count",
    "critical_aspect",
    "drift_ask",
    "drift_check",
    "drift_stops",
    "egg",
    "energy",
    "energy_slip",
    "energy_smooth",
    "ensemble",
    "excess",
    "extrema",
    "fold",
    "from_metres",
    "frustum",
    "gamma",
    "growth_rate",
    "inclination",
    "inertia",
    "jellett_spin",
    "kappa_rolling",
    "kappa_smooth",
    "lathe",
    "launch_number",
    "launch_spin",
    "loss_couple",
    "loss_laws",
    "loss_power",
    "lower_rim",
    "motion_options",
    "nutation",
    "painleve",
    "portrait",
    "precession",
    "precession_of_radius",
    "precession_of_spin",
    "pressed",
    "pressed_slip",
    "pressed_w1",
    "pressed_w3",
    "rate",
    "rate_of_one",
    "rattleback",
    "recoil",
    "region",
    "rests",
    "ridge",
    "rising_spin",
    "rocking",
    "roll",
    "shares_on_slope",
    "slip_slope",
    "slope_drift",
    "slope_resonance",
    "slopes_of_circles",
    "speed_o",
    "speed_x",
    "spin",
    "spin_limits",
    "standing_rolling",
    "standing_smooth",
    "state_kappa_rolling",
    "state_kappa_smooth",
    "states_w1",
    "states_w3",
    "steady_state",
    "steady_w1",
    "steady_w3",
    "stone_columns",
    "stone_energies",
    "stone_inclinations",
    "stone_lever",
    "stone_losses",
    "stone_moments",
    "stone_names",
    "stone_slip",
    "stone_spin",
    "stone_tilted",
    "stones",
    "summaries",
    "swing",
    "theta_balance",
    "theta_limit",
    "thrown",
    "thrown_slip",
    "thrown_w3",
    "tip_slope",
    "topples",
    "tripped_w2",
    "turning_spin",
    "two_rims",
    "unequal_balls",
    "uniform_stone",
    "units",
]

rate: np.ufunc
recoil: np.ufunc
axis_up: np.ufunc
kappa_rolling: np.ufunc
kappa_smooth: np.ufunc
region: np.ufunc
steady_w1: np.ufunc
steady_w3: np.ufunc
circular_w1: np.ufunc
precession_of_radius: np.ufunc
precession_of_spin: np.ufunc
circular_w3: np.ufunc
inclination: np.ufunc
states_w1: np.ufunc
states_w3: np.ufunc
count: np.ufunc
fold: np.ufunc
ridge: np.ufunc
boundary_rolling: np.ufunc
boundary_smooth: np.ufunc
theta_balance: np.ufunc
theta_limit: np.ufunc
excess: np.ufunc
critical_aspect: np.ufunc
jellett_spin: np.ufunc
body_i1: np.ufunc
body_i3: np.ufunc
standing_rolling: np.ufunc
standing_smooth: np.ufunc
inertia: np.ufunc
acceleration: np.ufunc
acceleration_smooth: np.ufunc
energy: np.ufunc
energy_slip: np.ufunc
energy_smooth: np.ufunc
state_kappa_rolling: np.ufunc
state_kappa_smooth: np.ufunc
angular_momentum: np.ufunc
beta: np.ufunc
speed_o: np.ufunc
speed_x: np.ufunc
centre_radius: np.ufunc
precession: np.ufunc
spin: np.ufunc
angular_velocity: np.ufunc
gamma: np.ufunc
contact_radius: np.ufunc
thrown_w3: np.ufunc
thrown_slip: np.ufunc
pressed_w1: np.ufunc
pressed_w3: np.ufunc
pressed_slip: np.ufunc
launch_number: np.ufunc
launch_spin: np.ufunc
slip_slope: np.ufunc
tip_slope: np.ufunc
slope_drift: np.ufunc
slope_resonance: np.ufunc
topples: np.ufunc
tripped_w2: np.ufunc
loss_power: np.ufunc
loss_couple: np.ufunc
nutation: np.ufunc
painleve: np.ufunc
growth_rate: np.ufunc
centre_along: np.ufunc
centre_up: np.ufunc
centre_across: np.ufunc
rests: np.ufunc
lower_rim: np.ufunc
two_rims: np.ufunc
capsule_end: np.ufunc
circle_height: np.ufunc
stone_tilted: np.ufunc
stone_inclinations: np.ufunc
stone_spin: np.ufunc
stone_lever: np.ufunc
stone_slip: np.ufunc

_Body: TypeAlias = tuple[float, float, float, float, float, float] | list[float]

def rate_of_one(
    theta: float, ell: float, i1: float, i3: float, bore: float, fillet: float, theta_end: float
) -> float: ...
def check_body(body: _Body) -> tuple[float, float]: ...
def check_tube(half_length: float, bore: float, fillet: float) -> tuple[float, float, float, float]: ...

_NumbersOfBody: TypeAlias = tuple[list[float], list[list[float]]]

def assembled(
    given: Sequence[tuple[int, list[float], float, bool]],
) -> tuple[_NumbersOfBody, list[float]]: ...
def check_profile(rows: Sequence[Sequence[float]], i1: float, i3: float) -> tuple[_NumbersOfBody, bool]: ...
def body_circles(
    body: Sequence[float], rows: Sequence[Sequence[float]]
) -> tuple[list[list[float]], list[list[float]]]: ...
def slopes_of_circles(
    body: tuple[list[float], list[list[float]]], theta: float, mu: float, posture: int, phi: float
) -> list[float]: ...
def shares_on_slope(
    body: tuple[list[float], list[list[float]]],
    theta: float,
    contact: tuple[int, tuple[float, float, float]],
    losses: Sequence[float] | None,
    posture: int,
    slope_and_phi: tuple[float, float],
) -> list[float]: ...
def frustum(bottom: float, top: float, height: float, wall: float | None) -> _NumbersOfBody: ...
def lathe(points: Sequence[Sequence[float]]) -> _NumbersOfBody: ...
def unequal_balls(radii: Sequence[float], separation: float) -> _NumbersOfBody: ...
def check_balls(separation: float) -> tuple[float, float]: ...
def check_ball(offset: float, i1: float, i3: float) -> None: ...
def steady_state(theta: float, body: _Body) -> list[float]: ...
def circular_state(theta: float, precession: float, body: _Body) -> list[float]: ...
def thrown(velocity: float, backspin: float, body: _Body) -> tuple[list[float], list[float]]: ...
def pressed(
    impulse: float, angle: float, finger: float, table: float, body: _Body
) -> tuple[list[float], list[float]]: ...
def turning_spin(
    table: int, coefficients: tuple[float, float, float], lean: float, time: float | None, body: _Body
) -> float: ...
def rising_spin(
    table: int | None,
    coefficients: tuple[float, float, float],
    lean: float,
    time: float | None,
    stone: Sequence[float],
) -> float: ...
def from_metres(
    outer_diameter: float, inner_diameter: float, length: float, fillet: float
) -> tuple[float, float, float]: ...
def loss_laws() -> list[dict[str, Any]]: ...
def units(radius: float, mass: float, gravity: float) -> tuple[float, float, float, float]: ...
def portrait(
    given: dict[str, NDArray[np.float64]],
    out: dict[str, NDArray[Any]],
    scattered: bool,
    threads: int,
    progress: Callable[[float], object] | None,
) -> None: ...
def areas(given: dict[str, NDArray[np.float64]], threads: int) -> NDArray[np.float64]: ...
def extrema(
    given: dict[str, NDArray[np.float64]],
    wanted: Sequence[bool],
    threads: int,
    progress: Callable[[float], object] | None,
) -> list[list[tuple[float, int, int]] | None]: ...
def ensemble(
    given: dict[str, NDArray[np.float64]],
    times: NDArray[np.float64],
    asked: dict[str, Any],
    out: dict[str, NDArray[Any]],
    threads: tuple[int, bool],
    progress: Callable[[float], object] | None,
) -> None: ...
def bounds(
    errors: tuple[float, float, float], size: tuple[float, float], most: tuple[float, float, float]
) -> dict[str, float]: ...
def codes() -> list[tuple[str, list[tuple[str, int]]]]: ...
def columns() -> list[list[str]]: ...
def motion_options() -> list[str]: ...
def summaries(table: int, loses: bool, flies: bool) -> list[str]: ...
def check_stone(numbers: Sequence[float]) -> tuple[list[float], float, float]: ...
def check_stones(given: NDArray[np.float64]) -> NDArray[np.float64]: ...
def uniform_stone(axes: Sequence[float]) -> tuple[list[float], float]: ...
def rattleback(
    axes: Sequence[float], moments: Sequence[float] | None, twist: float, offset: Sequence[float] | None
) -> tuple[list[float], float]: ...
def egg(radius: float, half_length: float, offset: float) -> tuple[list[float], float]: ...
def stone_columns() -> list[list[str]]: ...
def stone_losses() -> list[str]: ...
def stone_names() -> list[str]: ...
def stone_moments(stone: Sequence[float]) -> list[float]: ...
def rocking(stone: Sequence[float], spin: float) -> list[float]: ...
def spin_limits(stone: Sequence[float]) -> list[float]: ...
def stone_energies(
    stone: Sequence[float], states: Sequence[Sequence[float]], smooth: bool
) -> list[float]: ...
def stones(
    given: dict[str, NDArray[np.float64]],
    times: NDArray[np.float64],
    asked: dict[str, Any],
    out: dict[str, NDArray[Any]],
    threads: int,
    progress: Callable[[float], object] | None,
) -> None: ...
def roll(
    body: _Body | Sequence[float],
    state: tuple[float, float, float, float] | Sequence[float],
    times: NDArray[np.float64],
    asked: dict[str, Any],
) -> dict[str, Any]: ...
def swing(body: _Body, state: tuple[float, float, float, float], contact: int) -> list[float]: ...
def drift_ask(
    given: dict[str, NDArray[np.float64]],
    centre: str,
    question: int,
    of: NDArray[np.uint64],
    x: NDArray[np.float64],
    threads: int,
) -> NDArray[np.float64]: ...
def drift_check(
    body: _Body,
    state: tuple[float, float, float, float] | list[float],
    losses: list[float],
    centre: str,
) -> None: ...
def drift_stops(
    given: dict[str, NDArray[np.float64]],
    centre: str,
    out: dict[str, NDArray[Any]],
    threads: int,
) -> None: ...
