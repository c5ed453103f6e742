"""Odd calls: every public function with one invalid argument, and what is unclear in the response.

A clear response is a result, an OSError about a path, or a TypeError or ValueError that names the argument.
"""

import re
import warnings
from decimal import Decimal
from fractions import Fraction
from functools import cache, partial

import numpy as np

import spincyl as sc

BODY = sc.Body.solid(2.5)
CUP = sc.Body.frustum(0.7, 1.0, 2.0)
FAMILY = sc.Body.solid(np.array([0.9, 1.5]))
TUBE = sc.measured(outer_diameter=15.875e-3, inner_diameter=12.7e-3, length=95.25e-3, mass=20e-3)
STATE = BODY.steady(1.3).kicked(0.01)
DISK = sc.Body.solid(0.1)


class Hostile:
    """An object whose attributes all raise."""

    def __getattr__(self, name):
        raise AttributeError(name)


#: Callbacks, which may themselves refuse their arguments.
CALLED = ("progress", "(job", "function")


def values():
    """Odd values, by name."""
    endless = []
    endless.append(endless)
    return {
        "None": None, "text": "x", "no text": "", "bytes": b"x", "object": object(), "hostile": Hostile(), "dict": {},
        "dict of one": {"a": 1}, "empty list": [], "list of one": [1], "list of None": [None], "list of text": ["x"],
        "ragged": [[1.0], [1.0, 2.0]], "endless list": endless, "tuple": (), "pair": (1, 2), "set": {1}, "range": range(3),
        "complex": 1j, "nan": float("nan"), "inf": float("inf"), "-inf": float("-inf"), "-1": -1, "0": 0, "1.5": 1.5,
        "2**70": 2**70, "10**400": 10**400, "1e300": 1e300, "True": True, "empty array": np.array([]), "matrix": np.ones((2, 2)),
        "cube": np.ones((2, 1, 3)), "vector": np.ones(3), "no number": np.array([np.nan]), "texts": np.array(["a"]),
        "objects": np.array([object()]), "None array": np.array(None), "long double": np.ones(2, np.longdouble),
        "date": np.datetime64("2020-01-01"), "Decimal": Decimal(1), "Fraction": Fraction(1, 2),
        "masked": np.ma.masked_array([1.0, 2.0], [True, False]), "masked number": np.ma.masked, "generator": (x for x in (1, 2)),
        "class": sc.Body, "class of laws": sc.loss.DryContour, "Body": BODY, "family": FAMILY, "measured": TUBE, "State": STATE,
        "states": FAMILY.steady(1.3), "Motion": motion(), "Scale": sc.Scale(0.01), "Coulomb": sc.Coulomb(0.3),
        "Coulombs": sc.Coulomb([0.1, 0.2]), "loss": sc.loss.DryContour(1e-3), "losses": sc.loss.DryContour([1e-3, 2e-3]),
        "Drift": drift(), "function": len, "module": sc, "exception": ValueError("x"), "type": int,
    }  # fmt: skip


@cache
def motion():
    return sc.roll(BODY, STATE, np.linspace(0.0, 2.0, 5), want=("pose", "force"))


@cache
def measured_motion():
    return sc.roll(TUBE, TUBE.steady(1.4), 0.05)


@cache
def drift():
    return sc.drift(DISK, 0.3, sc.loss.ViscousContour(1e-3))


@cache
def lossfit():
    t = np.linspace(0.0, 0.9 * drift().stops_at, 12)
    return sc.data.fit_losses(
        t, drift().theta(t), body=DISK, laws=[sc.loss.ViscousContour, sc.loss.DryContour]
    )


@cache
def comparison():
    theta = np.radians([5.0, 10.0, 15.0, 70.0, 80.0])
    return sc.data.compare(BODY, theta, BODY.rate(theta))


@cache
def filmed():
    inch = 25.4e-3
    tube = sc.Body.from_metres(outer_diameter=0.625 * inch, inner_diameter=0.5 * inch, length=3.75 * inch)
    return tube, sc.data.read_tracker(sc.data.example("tube_from_above"))


@cache
def tube_motion():
    """The motion of that film."""
    tube, _ = filmed()
    return sc.roll(tube, tube.steady(1.456), np.arange(34) / 240)


@cache
def heard():
    t, sound = sc.data.read_sound(sc.data.example("whirr"))
    return t[t.size // 2 :], sound[t.size // 2 :]


def subjects(folder):
    """By name: a function, and valid arguments; an argument whose name begins with a bracket is positional.

    Functions that write files are left out, except the figures, which get an invalid format.
    """
    return {**nouns(), **stones(), **motions(), **laws(), **sweeps(), **measurements(), **pictures(folder)}


def stones():
    """Stones, their states and their motions."""
    axes, inertia, vertical = (
        (1.0, 0.3, 0.2),
        [[0.02, -0.012, 0.0], [-0.012, 0.2, 0.0], [0.0, 0.0, 0.21]],
        (0.0, 0.0, 1.0),
    )
    stone = sc.Ellipsoid(axes, inertia, (0.0, 0.0, -0.07))
    start = stone.spinning(-0.6, pitch=0.02)
    given = {
        "body": stone,
        "state": start,
        "t": [0.0, 1.0],
        "t0": 0.0,
        "tol": 1e-10,
        "mu": 0.5,
        "want": "pose",
        "beyond": False,
    }
    swept = {
        "bodies": stone,
        "states": start,
        "t": 1.0,
        "want": "spin",
        "tol": 1e-8,
        "mu": 0.5,
        "threads": 1,
        "progress": None,
    }
    hops = {
        "body": stone,
        "state": stone.dropped(start, 0.1),
        "t": [0.0, 1.0],
        "contact": sc.Coulomb(0.3),
        "restitution": 0.4,
    }
    spinning = {"spin": 0.5, "pitch": 0.01, "roll": 0.0}
    return {
        "Ellipsoid": (
            sc.Ellipsoid, {"semi_axes": axes, "inertia": inertia, "offset": (0, 0, 0), "theta_end": 1.5, "scale": None},
        ),
        "Ellipsoid.uniform": (sc.Ellipsoid.uniform, {"semi_axes": axes, "mass": None}),
        "Ellipsoid.rattleback": (
            sc.Ellipsoid.rattleback, {"semi_axes": axes, "twist": 0.1, "moments": (0.02, 0.2, 0.21), "offset": (0, 0, 0)},
        ),
        "Ellipsoid.with_weights": (stone.with_weights, {"weights": [(0.1, (0.5, 0.0, 0.0))]}),
        "Ellipsoid.egg": (sc.Ellipsoid.egg, {"radius": 0.7, "half_length": 1.0, "offset": 0.0, "mass": None}),
        "Ellipsoid.in_metres": (stone.in_metres, {"mass": 200.0, "radius": 1.0, "gravity": 9.8}),
        "Ellipsoid.hertz": (stone.in_metres().hertz, {"state": start}),
        "Ellipsoid.spinning": (stone.spinning, spinning),
        "Ellipsoid.with_centre_velocity": (stone.with_centre_velocity, {"state": start, "x": 0.0, "y": 0.1}),
        "Ellipsoid.dropped": (stone.dropped, {"state": start, "height": 0.5, "velocity": (0.1, 0.0, 0.2)}),
        "Ellipsoid.rocking": (stone.rocking, {"spin": 0.5}),
        "Ellipsoid.growth_rates": (stone.growth_rates, {"spin": 0.5}),
        "Ellipsoid.stable": (stone.stable, {"spin": 0.5}),
        "Ellipsoid.energy": (stone.energy, {"state": start, "contact": "rolling"}),
        "EllipsoidState": (
            sc.EllipsoidState, {"vertical": vertical, "w": (0, 0, 1), "slip": (0, 0), "height": 0.5, "lift": 0.1},
        ),
        "EllipsoidState.from_si": (
            sc.EllipsoidState.from_si,
            {"vertical": vertical, "w": (0, 0, 1), "slip": (0, 0), "height": 0.5, "lift": 0.1, "scale": sc.Scale(0.01)},
        ),
        "EllipsoidState.in_si": (start.in_si, {"scale": sc.Scale(0.01)}),
        "roll of a stone": (sc.roll, given),
        "roll of a stone that hops": (sc.roll, hops),
        "EllipsoidMotion.at": (sc.roll(stone, start, 1.0).at, {"t": [0.5, 1.0]}),
        "sweep.roll of stones": (sc.sweep.roll, swept),
    }  # fmt: skip


def nouns():
    """Bodies, states, contacts and scales."""
    body, state = BODY, STATE
    found = {
        "Body": (sc.Body, {"ell": 1.2, "i1": 0.7, "i3": 0.5, "bore": np.nan, "fillet": 0.0, "theta_end": np.nan, "scale": None}),
        "Body.solid": (sc.Body.solid, {"ell": 2.0, "fillet": 0.0}),
        "Body.tube": (sc.Body.tube, {"ell": 2.0, "bore": 0.5, "fillet": 0.0}),
        "Body.balls": (sc.Body.balls, {"separation": 1.0}),
        "Body.balls of two radii": (sc.Body.balls, {"separation": 1.0, "radii": (1.0, 0.8)}),
        "Body.frustum": (sc.Body.frustum, {"bottom": 0.7, "top": 1.0, "height": 2.0, "wall": 0.1}),
        "Body.cone": (sc.Body.cone, {"height": 2.0}),
        "Body.lathe": (sc.Body.lathe, {"points": [(0.7, 0.0), (1.0, 2.0)]}),
        "Body.profile": (
            sc.Body.profile, {"circles": [(0.7, 0.0), (1.0, 2.0)], "i1": 0.5, "i3": 0.4, "centre": 1.1},
        ),
        "Body.apex": (CUP.apex, {"k": 0}),
        "Body.ball": (sc.Body.ball, {"offset": -0.2, "i1": 0.39, "i3": 0.4}),
        "Body.from_metres": (
            sc.Body.from_metres, {"outer_diameter": 1e-2, "length": 1e-2, "inner_diameter": 0.0, "fillet": 0.0},
        ),
        "Body.critical_aspect": (sc.Body.critical_aspect, {"bore": 0.0, "fillet": 0.0}),
        "measured": (
            sc.measured,
            {"outer_diameter": 1e-2, "length": 1e-2, "inner_diameter": 0.0, "mass": None, "fillet": 0.0, "density": None, "gravity": 9.8},
        ),
        "Body.hertz": (TUBE.hertz, {"at": 1.3}),
        "Body.roll": (body.roll, {"state": state, "t": 1.0}),
        "Body.rate": (body.rate, {"theta": 1.3, "out": None, "where": True}),
        "Body.region": (body.region, {"theta": 1.3, "out": None, "where": True}),
        "Body.inclinations": (body.inclinations, {"rate": 1.5}),
        "Body.inclinations of hertz": (TUBE.inclinations, {"hertz": 7.0}),
        "Body.states": (body.states, {"rate": 1.5}),
        "Body.count": (body.count, {"rate": 1.5}),
        "Body.angular_rate": (body.angular_rate, {"rate": 1.5}),
        "Body.steady": (body.steady, {"theta": 1.3}),
        "Body.circular": (body.circular, {"theta": 1.3, "precession": 1.0}),
        "Body.circular of a radius": (body.circular, {"theta": 1.3, "radius": -1.0}),
        "Body.circular of a spin": (body.circular, {"theta": 1.3, "w3": 2.0}),
        "Body.stability": (body.stability, {"at": 1.3, "contact": "rolling", "out": None, "where": True}),
        "Body.stable": (body.stable, {"at": 1.3, "contact": "rolling"}),
        "Body.nutation": (body.nutation, {"at": 1.3, "contact": "rolling"}),
        "Body.growth_rate": (body.growth_rate, {"at": 1.3, "contact": "rolling"}),
        "Body.standing_spin": (body.standing_spin, {"contact": "rolling"}),
        "Body.painleve": (body.painleve, {"theta": 1.3}),
        "Body.topples": (body.topples, {"mu": 0.3, "theta": 0.0}),
        "Body.slip_slope": (body.slip_slope, {"mu": 0.3, "posture": "lying", "phi": 0.1, "theta": None}),
        "Body.tip_slope": (body.tip_slope, {"posture": "lying", "phi": 0.1, "theta": None}),
        "Body.boundaries": (body.boundaries, {"contact": "rolling"}),
        "Body.energy": (body.energy, {"state": state, "contact": "rolling"}),
        "Body.centre_velocity": (body.centre_velocity, {"state": state}),
        "Body.with_centre_velocity": (body.with_centre_velocity, {"state": state, "along": 0.0, "across": 0.0}),
        "Body.acceleration": (body.acceleration, {"state": state, "contact": "rolling"}),
        **{
            f"Body.{name}": (getattr(body, name), {"state": state})
            for name in ("angular_momentum", "beta", "speed_o", "speed_x", "centre_radius")
        },
        "State": (sc.State, {"theta": 1.0, "w1": 1.0, "w2": 0.0, "w3": 1.0, "slip": None}),
        "State.from_si": (
            sc.State.from_si, {"theta": 1.0, "w1": 1.0, "w2": 0.0, "w3": 1.0, "slip": None, "scale": sc.Scale(0.01)},
        ),
        "State.kicked": (state.kicked, {"thetadot": 0.1}),
        "Table": (sc.Table, {"slope": 0.1, "turning": 0.0, "phi0": 0.2}),
        "Newton": (sc.Newton, {"e": 0.5}),
        "Poisson": (sc.Poisson, {"e": 0.5}),
        "Walton": (sc.Walton, {"e": 0.5, "tangential": 0.5}),
        "Coulomb": (sc.Coulomb, {"mu": 0.3, "static": None, "face": "ring"}),
        "Viscous": (sc.Viscous, {"c": 0.3}),
        "Scale": (sc.Scale, {"radius": 0.01, "mass": 1.0, "gravity": 9.8}),
        "Scale.metres": (sc.Scale(0.01).metres, {"length": 1.0}),
        "Scale.seconds": (sc.Scale(0.01).seconds, {"time": 1.0}),
        "Scale.metres_per_second": (sc.Scale(0.01).metres_per_second, {"speed": 1.0}),
        "Scale.joules": (sc.Scale(0.01).joules, {"energy": 1.0}),
        "Scale.newtons": (sc.Scale(0.01).newtons, {"force": 1.0}),
        "Scale.hertz": (sc.Scale(0.01).hertz, {"body": body, "rate": 1.0}),
        "Scale.turns": (sc.Scale(0.01).turns, {"angular_velocity": 1.0}),
        "assembled": (sc.assembled, {"parts": [sc.parts.ball(diameter=1.0, mass=1.0)], "gravity": 9.8}),
        "parts.assembled": (sc.parts.assembled, {"parts": [sc.parts.ball(diameter=1.0, mass=1.0)], "gravity": 9.8}),
        **{
            f"parts.{name}": (getattr(sc.parts, name), given)
            for name, given in {
                "cylinder": {"outer_diameter": 1.0, "length": 1.0, "inner_diameter": 0.0, "fillet": 0.0, "at": 0.0, "mass": 1.0},
                "cone": {"lower_diameter": 1.0, "upper_diameter": 0.5, "length": 1.0, "mass": 1.0},
                "ball": {"diameter": 1.0, "inner_diameter": 0.0, "mass": 1.0},
                "cap": {"diameter": 1.0, "height": 0.5, "mass": 1.0},
                "wall": {"lower_diameter": 1.0, "upper_diameter": 0.5, "length": 1.0, "mass": 1.0},
                "disk": {"outer_diameter": 1.0, "inner_diameter": 0.0, "mass": 1.0},
                "shell": {"diameter": 1.0, "height": 0.5, "mass": 1.0},
                "ring": {"diameter": 1.0, "mass": 1.0},
                "point": {"mass": 1.0, "at": 0.0},
            }.items()
        },
        "thrown": (sc.thrown, {"body": sc.Body.tube(0.0, 1.0), "velocity": 1.0, "backspin": 2.0, "scale": None}),
        "pressed": (
            sc.pressed, {"body": body, "impulse": 5.0, "angle": 0.8, "finger": 0.6, "table": 0.0, "scale": None},
        ),
        "dropped": (
            sc.dropped, {"body": TUBE, "height": 0.05, "theta": 1.2, "w1": 1.0, "w2": 0.5, "w3": 2.0, "velocity": (0.1, 0.0, 0.2), "scale": None},
        ),
        "spun": (sc.spun, {"body": TUBE, "w": 2.0, "velocity": (0.1, 0.2), "theta": 0.0, "scale": None}),
        "tripped": (sc.tripped, {"body": TUBE, "velocity": 0.1, "scale": None}),
        "flicked": (
            sc.flicked, {"body": TUBE, "hertz": 17.0, "w1": None, "launch": 1.3, "spin_hertz": None, "centre": None, "scale": None},
        ),
        "Body.in_metres": (TUBE.in_metres, {"mass": 0.02, "radius": 8e-3, "gravity": 9.8}),
        "State.in_si": (state.in_si, {"scale": TUBE}),
        "slope_drift": (sc.slope_drift, {"body": body, "state": body.steady(1.3)}),
        "launch_number": (sc.launch_number, {"body": body, "state": sc.State(np.pi / 2, 1, 0.0, 2)}),
        "turning_spin": (sc.turning_spin, {"top": sc.Body.ball(-0.2, 0.40, 0.42), "contact": sc.Viscous(1.0), "lean": 0.1, "t": 300.0}),
        "rising_spin": (sc.rising_spin, {"egg": sc.Ellipsoid.egg(1.0, 1.4), "contact": sc.Viscous(1.0), "lean": 0.1, "t": 300.0}),
        "swing": (sc.swing, {"body": body, "state": state, "contact": "rolling"}),
    }  # fmt: skip
    return found


def motions():
    """Motions, drifts and views."""
    body, state = BODY, STATE
    found = {
        "roll": (
            sc.roll,
            {
                "body": body, "state": state, "t": 1.0, "t0": None, "step": None, "tol": None, "method": None, "contact": "rolling",
                "mu": np.inf, "want": (), "beyond": False, "restitution": None, "losses": None, "max_nfev": 1000,
            },
        ),
        "roll of a measured body": (sc.roll, {"body": TUBE, "state": TUBE.steady(1.4), "t": 0.1, "t0": None, "step": None}),
        "roll with friction": (
            sc.roll, {"body": body, "state": state, "t": 0.1, "contact": sc.Coulomb(0.3), "tol": None, "restitution": None, "losses": None},
        ),
        "roll with losses": (
            sc.roll,
            {"body": DISK, "state": DISK.steady(0.3), "t": 0.1, "contact": "rolling", "losses": sc.loss.DryContour(1e-3), "tol": None},
        ),
        "Motion.at": (motion().at, {"t": 1.0}),
        "Motion.wanting": (motion().wanting, {"(want": "pose", "t": None}),
        "Motion.at of a measured body": (measured_motion().at, {"t": 0.01}),
        "drift": (
            sc.drift, {"body": DISK, "theta": 0.3, "losses": sc.loss.DryContour(1e-3), "centre": "rest", "threads": None},
        ),
        "drift that rolls": (
            sc.drift, {"body": DISK, "theta": DISK.steady(0.3), "losses": sc.loss.ViscousContour(1e-3), "centre": "rolling"},
        ),
        "Drift.time": (drift().time, {"theta": 0.2}),
        "Drift.theta": (drift().theta, {"t": 0.2}),
        "Drift.precession": (drift().precession, {"t": 0.2}),
        "Drift.state": (drift().state, {"t": 0.2}),
        "Drift.friction_coefficient": (drift().friction_coefficient, {"t": 0.2}),
        "exposure": (
            sc.exposure,
            {"motion": motion(), "seconds": None, "scale": None, "upper": "O", "size": 4, "samples": 1e3, "width": None},
        ),
        "scene": (
            sc.scene, {"motion": motion(), "scale": None},
        ),
        "Scene.compare": (
            sc.scene(motion()).compare,
            {"time": [0.1, 0.2], "position": np.zeros((2, 3)), "orientation": np.eye(4)[[3, 3]], "scalar_first": False},
        ),
        "Scene.couple": (
            sc.scene(motion()).couple,
            {"orientation": [0.6, 0.0, 0.0, 0.8], "angular_velocity": [0.1, 0.2, 0.3], "normal_force": 1.0, "scalar_first": False},
        ),
        "view": (
            sc.view, {"(motions": motion(), "labels": None, "title": "x", "scale": None, "slow": None, "upper": "O"},
        ),
        "play": (
            sc.play,
            {
                "body": body, "theta": 1.3, "state": None, "kick": 0.0, "contact": "rolling", "restitution": 0.5, "losses": None,
                "table": sc.Table(0.1), "t": None, "slow": 20.0, "friction": True, "title": "x",
                "language": "de",
            },
        ),
        **{
            f"Play.{name}": (partial(setting, name), {name: good})
            for name, good in (
                ("body", body), ("theta", 1.3), ("kick", 0.1), ("state", state), ("contact", "rolling"),
                ("restitution", 0.5), ("losses", None), ("table", sc.Table(0.1)),
            )
        },
    }  # fmt: skip
    return found


def laws():
    """Loss laws."""
    body, state = BODY, STATE
    found = {}
    laws = {name: getattr(sc.loss, name) for name in sc.loss.__all__ if name not in ("Law", "Loss", "Sum")}
    weighed = sc.Scale(0.01, 0.02)
    for name, law in laws.items():
        own, *_ = law.__dataclass_fields__
        found[f"loss.{name}"] = law, {own: 1e-3}
        first = {"AirFilm": "viscosity", "BoundaryLayer": "C"}.get(name, own)
        found[f"loss.{name}.from_si"] = law.from_si, {first: 1e-3, "scale": weighed}
    found["loss.BoundaryLayer.from_si"][1].update(density=1.2, viscosity=1.8e-5)
    dry = sc.loss.DryContour(1e-3)
    found |= {
        "custom.Couple": (sc.custom.Couple, {"function": lambda theta, w, normal: -0.01 * w}),
        "custom.Drive": (sc.custom.Drive, {"function": lambda now: ((0.0, 0.1), (0.0, 0.0, 0.0))}),
        "custom.Friction": (sc.custom.Friction, {"function": lambda speed: 0.3, "static": 0.4}),
        "loss.Law": (sc.loss.Law, {"coefficient": 1e-3}),
        "loss.Sum": (sc.loss.Sum, {"laws": [dry]}),
        "Loss.power": (dry.power, {"body": body, "state": state, "normal": 1.0}),
        "Loss.couple": (dry.couple, {"body": body, "state": state, "normal": 1.0}),
    }
    return found


def sweeps():
    """Maps and many motions."""
    dry = sc.loss.DryContour(1e-3)
    axes = {"theta": [0.1, 1.3], "ell": [1.0, 2.0], "bore": 0.0, "fillet": 0.0}
    how = {"threads": 1, "progress": None}
    rolls = {
        "bodies": FAMILY, "states": FAMILY.steady(1.3), "t": 1.0, "want": None, "contact": "rolling", "tol": 1e-10, "mu": np.inf,
        "beyond": False, "restitution": None, "stop_at": None, "losses": None, "max_nfev": None, "errors": True, "threads": 1,
        "progress": None,
    }  # fmt: skip
    found = {
        "sweep.portrait": (sc.sweep.portrait, {**axes, "want": "rate", "out": None, "dtype": "float64", **how}),
        "sweep.points": (sc.sweep.points, {**axes, "want": "rate", "out": None, "dtype": "float64", **how}),
        "sweep.survey": (sc.sweep.survey, {**axes, "want": "region", **how}),
        "sweep.boundaries": (sc.sweep.boundaries, {"ell": [1.0, 2.0], "bore": 0.0, "fillet": 0.0}),
        "sweep.flicks": (
            sc.sweep.flicks,
            {"body": TUBE, "t": 0.1, "hertz": [10.0, 17.0], "w1": None, "launch": 1.3, "centre": None, "contact": sc.Coulomb(0.3)},
        ),
        "sweep.inputs": (sc.sweep.inputs, {"rows": sc.sweep.roll(FAMILY, FAMILY.steady(1.3), 0.1)}),
        "sweep.roll": (sc.sweep.roll, {**rolls, "step": None}),
        "sweep.roll at times": (sc.sweep.roll, {"bodies": FAMILY, "states": FAMILY.steady(1.3), "t": [0.1, 0.2], "threads": 1}),
        "sweep.roll with friction": (sc.sweep.roll, rolls | {"contact": sc.Coulomb(0.3), "losses": dry, "t": 0.1}),
        "sweep.block_size": (
            partial(sc.sweep.block_size, lambda ell: sc.sweep.portrait([0.1, 0.2], ell)), {"(sample": [1.0, 2.0], "seconds": 1e-3},
        ),
        "sweep.block_size of a job": (sc.sweep.block_size, {"(job": len}),
    }  # fmt: skip
    return found


def measurements():
    """Functions that read, fit and compare data."""
    body = BODY
    theta = np.radians([5.0, 10.0, 15.0, 70.0, 80.0])
    t, sound = heard()
    tube, tracks = filmed()
    time = np.linspace(0.0, 0.9 * drift().stops_at, 12)
    sized = sc.measured(outer_diameter=0.02, length=0.002)  # the disk of that drift
    fits = {
        "t": time, "theta": drift().theta(time), "precession": None, "body": DISK, "laws": [sc.loss.ViscousContour], "centre": "rest",
        "t_err": None, "theta_err": None, "precession_err": None, "start": None, "progress": None,
    }  # fmt: skip
    found = {
        "data.compare": (
            sc.data.compare,
            {"body": body, "theta": theta, "rate": body.rate(theta), "theta_err": None, "rate_err": None, "common": 0.0},
        ),
        "data.compare in hertz": (
            sc.data.compare, {"body": TUBE, "theta": theta, "hertz": TUBE.hertz(theta), "theta_err": 0.01, "hertz_err": 0.1},
        ),
        "data.compare with errors": (
            sc.data.compare, {"body": body, "theta": theta, "rate": body.rate(theta), "theta_err": 0.01, "rate_err": 0.01},
        ),
        "data.fit_losses": (sc.data.fit_losses, fits),
        "data.fit_losses in hertz": (
            sc.data.fit_losses,
            fits | {"theta": None, "hertz": sized.scale.turns(drift().precession(time)), "body": sized, "hertz_err": 0.1}
            | {"t": sized.scale.seconds(time)},
        ),
        "data.fit_losses of the precession": (sc.data.fit_losses, fits | {"precession": drift().precession(time), "theta": None}),
        "data.from_above": (
            sc.data.from_above, {"tracks": tracks, "tube": tube, "scale": None, "ends": None, "ruler": 0.0, "mark_err": None, "window": 5},
        ),
        "data.compare of a film": (sc.data.compare, {"body": tube_motion(), "theta": sc.data.from_above(tracks, tube)}),
        "data.wobble": (sc.data.wobble, {"t": t, "sound": sound, "between": (2.0, 200.0)}),
        "data.example": (sc.data.example, {"name": "flicks"}),
        "data.Columns": (sc.data.Columns, {"columns": [("t", np.ones(2))]}),
        "data.fit_stop": (
            sc.data.fit_stop,
            {"body": TUBE, "law": sc.loss.DryContour, "from_": 1.4, "seconds": [2.0, 2.2], "error": None, "from_err": 0.01, "centre": "rest", "names": None},
        ),
        "data.fit_stop of a class": (
            sc.data.fit_stop,
            {"body": TUBE, "law": None, "from_": [1.35, 1.4], "seconds": [[2.0, 2.2], [2.1, 2.1]], "centre": "rest", "names": ["a", "b"]},
        ),
        "data.fit_motion": (
            sc.data.fit_motion,
            {"guess": motion(), "measured": {"t": motion().t[:9], "theta": motion().theta[:9]}, "free": ["w1"], "errors": {"theta": 0.01}, "loss": "linear"},
        ),
        "data.fit_bounces": (
            sc.data.fit_bounces, {"t": [0.0, 1.0, 1.9, 2.71, 3.439], "sound": None, "error": None, "released": -0.55, "gravity": 9.81},
        ),
        "data.LossFit.of": (lossfit().of, {"law": sc.loss.DryContour}),
        **{
            f"data.{name}": (getattr(sc.data, name), {"path": sc.data.example(file)})
            for name, file in (("read_table", "flicks"), ("read_tracker", "tube_from_above"), ("read_sound", "whirr"), ("read_phyphox", "flicks"))
        },
    }  # fmt: skip
    return found


def pictures(folder):
    """Functions that draw."""
    body, ends = BODY, sc.sweep.flicks(TUBE, 1.0, hertz=[9, 20], launch=[1.2, 3], contact=sc.Coulomb(0.3))
    found = {
        "plot.landmarks": (sc.plot.landmarks, {"body": body, "contact": "smooth"}),
        "plot.frame": (sc.plot.frame, {"ax": None}),
        "plot.branches": (
            sc.plot.branches, {"ells": [2.5], "bore": 0.0, "contact": "smooth", "ax": None, "rate_max": 3.0, "marks": None},
        ),
        "plot.branches in hertz": (sc.plot.branches, {"ells": TUBE, "hertz": True, "rate_max": 20.0}),
        "plot.portrait": (sc.plot.portrait, {"data": None, "bore": 0.0, "fillet": 0.0, "contact": None, "ax": None, "ell_max": 3.0}),
        "plot.energy": (sc.plot.energy, {"bore": 0.0, "ax": None, "ell_max": 3.0}),
        "plot.motion": (sc.plot.motion, {"m": motion(), "axes": None}),
        "plot.drift": (sc.plot.drift, {"found": drift(), "ax": None}),
        "plot.flicks": (sc.plot.flicks, {"found": ends, "ax": None}),
        "plot.losses": (sc.plot.losses, {"found": lossfit(), "axes": None}),
        "plot.film": (sc.plot.film, {"found": sc.data.from_above(*filmed()[::-1]), "axes": None}),
        "data.Filmed.over": (
            sc.data.from_above(*filmed()[::-1]).over,
            {"motion": tube_motion(), "frames": None, "t": 0.05, "first": 0, "fps": 240.0, "camera": (918.0, 336.0, 6000.0, 5.0), "ax": None},
        ),
        "data.Filmed.plot": (sc.data.from_above(*filmed()[::-1]).plot, {"axes": None}),
        "plot.comparison": (sc.plot.comparison, {"found": comparison(), "ax": None}),
        "plot.exposure": (
            sc.plot.exposure,
            {
                "m": motion(), "seconds": None, "ax": None, "gamma": 0.8, "scale": None, "upper": "O", "size": 4, "samples": 1e3,
                "width": None,
            },
        ),
        "plot.figures": (sc.plot.figures, {"folder": folder, "suffix": "x", "slides": False, "progress": None}),
        "data.LossFit.plot": (lossfit().plot, {"axes": None}),
        "data.Comparison.plot": (comparison().plot, {"ax": None}),
    }  # fmt: skip
    return found


def setting(name, **given):
    """Set an attribute of a live page."""
    page = sc.play(BODY)
    setattr(page, name, given[name])


def asked(call, good, argument, value):
    """Call with one argument replaced."""
    given = {**good, argument: value}
    plain = [given.pop(name) for name in list(given) if name.startswith("(")]
    return call(*plain, **given)


#: Phrases of Python and NumPy that speak of code and not of an argument.
_WITHIN = re.compile(
    r"truth value|has no attribute|not subscriptable|not iterable|not callable|operands|ufunc|broadcast together|"
    r"unhashable|cannot be interpreted|positional argument|unexpected keyword|could not convert|unsupported operand|"
    r"inhomogeneous|must be real number|setting an array element|no len\(\)"
)


def offence(call, good, argument, value):
    """What is unclear in the response to an odd call, or None."""
    name = argument.strip("(")
    # an odd body can make another argument unsuitable, and errors about states and bodies name their fields
    others = "|".join(
        {re.escape(x.strip("(")) for x in good} | {"theta", "w1", "w2", "w3", "slip", "ell", "job"}
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", UserWarning)
        warnings.filterwarnings("ignore", r".*\(Status.INVALID\) and are NaN; motion \d+")
        try:
            asked(call, good, argument, value)
        except (TypeError, ValueError) as e:
            bare = type(e) in (TypeError, ValueError)
            if bare and re.match(rf"({others})\b", str(e)):
                return None
            if bare and re.search(rf"\b{re.escape(name)}\b", str(e)) and not _WITHIN.search(str(e)):
                return None
            return f"{type(e).__name__}: {str(e)[:100]}"
        except Exception as e:
            written = isinstance(e, OSError) and name in ("path", "tracks", "frames")
            return None if written else f"{type(e).__name__}: {str(e)[:100]}"
    return None
