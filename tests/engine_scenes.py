"""Scenes for contact engines, one of every kind of motion that the library has. Each is computed once."""

from functools import cache

import eulers_disk
import numpy as np
import nutating_cylinder
from page_scenes import BALLS, CAPSULE, CYLINDER, PIPE, ROUNDED, TIPPE

import spincyl as sc
from spincyl import parts

APART = sc.Body.balls(1.5)
EULER = sc.Body.from_metres(outer_diameter=0.0751, length=0.0128)
COIN, DISK, TORUS = sc.Body.solid(0.0854), sc.Body.solid(0.0), sc.Body(0.0, 0.6, 0.8, fillet=0.4)
EURO = sc.Scale(0.012875, mass=0.0085)
TUBE = sc.measured(outer_diameter=15.875e-3, inner_diameter=12.7e-3, length=95.25e-3, mass=20e-3)
RATTLE = sc.Ellipsoid.rattleback((0.08, 0.016, 0.014), twist=0.05).in_metres(0.05)
PEBBLE = sc.Ellipsoid((1.0, 0.6, 0.5), [[0.06, -0.012, 0], [-0.012, 0.2, 0], [0, 0, 0.23]], (0, 0, -0.07))
EGG = sc.Ellipsoid.egg(0.022, 0.0285).in_metres(0.06)
GLASS = sc.assembled(
    [
        parts.cylinder(outer_diameter="60mm", length="5mm", density=2500),
        parts.wall(lower_diameter="60mm", upper_diameter="80mm", length="90mm", density=5.0),
    ]
)
SPOOL = sc.assembled(
    [
        parts.cylinder(outer_diameter="60mm", length="5mm", density=2500),
        parts.cylinder(outer_diameter="10mm", length="50mm", density=2500),
        parts.cylinder(outer_diameter="60mm", length="5mm", density=2500),
    ]
)
TOP = sc.assembled(
    [
        parts.ball(diameter="10mm", density=7800),
        parts.cylinder(outer_diameter="40mm", length="10mm", density=2700, at="8mm"),
    ]
)
CUP, BOTTLE = sc.Body.frustum(0.7, 1.0, 2.0), sc.Body.lathe([(1, 0), (1, 3), (0.35, 4.2), (0.35, 5)])
ROUND_CUP = sc.Body.profile([(0.5, 0, 0.2), (0.8, 1.5, 0.1)], 0.6, 0.4, 0.7)
UNEQUAL = sc.Body.balls(radii=(1, 0.8))
LOSSES = {
    "dry contour": sc.loss.DryContour(2e-3),
    "viscous contour": sc.loss.ViscousContour(2e-3),
    "rolling resistance": sc.loss.RollingResistance(2e-3),
    "drilling": sc.loss.Drilling(2e-3),
    "linear air": sc.loss.AirLinear(2e-3),
    "quadratic air": sc.loss.AirQuadratic(2e-3),
    "air film": sc.loss.AirFilm(1e-4),
    "boundary layer": sc.loss.BoundaryLayer(1e-3),
}


def rolled(body, start, seconds=0.6, points=13, scale=None, **how):
    """A scene of a body in natural units, or of a measured one, in seconds."""
    unit = 1.0 if body.scale is not None else (scale or sc.Scale(1.0)).seconds(1.0)
    return sc.scene(sc.roll(body, start, np.linspace(0, seconds / unit, points), **how), scale=scale)


def slid(body, state, x, y):
    """The state whose centre has this velocity."""
    return body.with_centre_velocity(state, x, y)


SMOOTH = {"contact": "smooth"}
PRESSED = {x: sc.pressed(PIPE, x, np.radians(60), finger=0.3) for x in (5.0, 12.0)}
THROWN = slid(COIN, sc.State(1.2, 0.4, 0.1, -1.0), 0.5, 2.0)
ROLLING = {
    "cylinder": lambda: rolled(CYLINDER, nutating_cylinder.start),
    "tube": lambda: rolled(TUBE, TUBE.steady(1.4).kicked(0.02), 0.04),
    "Euler's disk": lambda: rolled(
        EULER, EULER.steady(0.3).kicked(0.1), 0.2, scale=sc.Scale(0.03755, mass=0.44)
    ),
    "rolling coin": lambda: rolled(EULER, EULER.circular(1.2, 0.3)),
    "NumPy's numbers": lambda: rolled(
        sc.Body.tube(np.float64(2.0), np.float64(0.5)),
        sc.Body.tube(2.0, 0.5).steady(np.float64(1.3)),
        np.float64(0.5),
        scale=sc.Scale(np.float64(0.5)),
        mu=np.float32(0.5),
    ),
    "rounded can": lambda: rolled(ROUNDED, ROUNDED.steady(1.3).kicked(0.05)),
    "rounded coin": lambda: rolled(
        eulers_disk.body, eulers_disk.start, 0.2, scale=sc.Scale(0.03755, mass=0.44)
    ),
    "capsule": lambda: rolled(CAPSULE, CAPSULE.steady(1.35).kicked(0.05)),
    "Hurricane balls": lambda: rolled(BALLS, BALLS.steady(1.36), 0.2, scale=sc.Scale(0.008, mass=0.033)),
    "balls on a rod": lambda: rolled(APART, APART.steady(np.radians(85)).kicked(0.02)),
    "tippe top": lambda: rolled(TIPPE, sc.State(0.6, 1.0, 0.0, 2.0)),
    "disk": lambda: rolled(DISK, DISK.steady(0.4).kicked(0.05)),
    "torus": lambda: rolled(TORUS, TORUS.circular(1.0, 0.8)),
    "glass": lambda: rolled(GLASS, GLASS.steady(0.6).kicked(0.05), 0.2),
    "spool": lambda: rolled(SPOOL, SPOOL.steady(1.2).kicked(0.05), 0.2),
    "top": lambda: rolled(TOP, sc.State(0.2, 0.02, 0.0, 0.8), 0.1),
    "rattleback": lambda: rolled(RATTLE, RATTLE.spinning(hertz=-1.0, pitch=0.02), 0.15),
    "cup on its upper rim": lambda: rolled(CUP, sc.State(2.2, 0.3, 0.4, 0.5), 0.3),
    "ball on its smaller one": lambda: rolled(UNEQUAL, sc.State(2.5, 0.3, 0.6, 0.4), 0.3),
}
ON_ICE = {
    "round on ice": lambda: rolled(ROUNDED, ROUNDED.steady(1.3).kicked(0.05), **SMOOTH),
    "on ice": lambda: rolled(CYLINDER, nutating_cylinder.start, **SMOOTH),
    "stone on ice": lambda: rolled(PEBBLE, PEBBLE.spinning(-0.6, pitch=0.2, roll=0.1), **SMOOTH),
}
RUBBED = {
    "slipping coin": lambda: rolled(COIN, THROWN, contact=sc.Coulomb(0.3)),
    "from slip to roll": lambda: rolled(
        COIN, slid(COIN, COIN.steady(0.9), 0.0, 0.3), 0.2, contact=sc.Coulomb(0.5, static=0.6), scale=EURO
    ),
    "viscous": lambda: rolled(COIN, THROWN, contact=sc.Viscous(0.3)),
    "viscous film": lambda: rolled(
        TUBE, slid(TUBE, TUBE.steady(1.4), 0.1, 0.2), 0.05, contact=sc.Viscous.from_si(1.0, scale=TUBE)
    ),
    "patch": lambda: rolled(
        TIPPE,
        slid(TIPPE, sc.State(0.3, 0.2, 0.0, 6.0), 0.3, 0.0),
        0.3,
        5,
        contact=sc.Coulomb(0.3, patch=0.05),
    ),
    "rattleback slips": lambda: rolled(
        RATTLE, slid(RATTLE, RATTLE.spinning(hertz=-1.0, pitch=0.02), 0.1, 0.1), 0.3, contact=sc.Coulomb(0.3)
    ),
    "egg": lambda: rolled(
        EGG, slid(EGG, EGG.spinning(hertz=18, pitch=1.48), 0.0, 0.0), 0.1, contact=sc.Coulomb(0.1)
    ),
    "rounded cup slips": lambda: rolled(
        ROUND_CUP, sc.State(2.4, 0.3, -0.4, 0.5, slip=(0.3, 0.2)), 0.2, contact=sc.Coulomb(0.2)
    ),
    "egg in a film": lambda: rolled(
        EGG,
        slid(EGG, sc.EllipsoidState((0.2, 0.1, -np.sqrt(0.95)), (0.3, 0.2, -4.0)), 0.1, 0.0),
        0.1,
        contact=sc.Viscous.from_si(1, scale=EGG),
    ),
}
LOST = {
    name: lambda law=law: rolled(COIN, COIN.steady(0.4).kicked(0.05), 0.2, scale=EURO, losses=law)
    for name, law in LOSSES.items()
}
LOST |= {
    "slip and losses": lambda: rolled(
        ROUNDED,
        slid(ROUNDED, sc.State(1.0, 0.5, 0.1, -1.0), 0.2, 0.2),
        scale=sc.Scale(0.02, mass=0.1),
        contact=sc.Coulomb(0.3),
        losses=sc.loss.DryContour(5e-3) + sc.loss.RollingResistance(2e-3) + sc.loss.AirLinear(1e-2),
    ),
    "ice and losses": lambda: rolled(COIN, COIN.steady(0.4), losses=sc.loss.AirFilm(1e-3), **SMOOTH),
}
ALOFT = {
    "hops": lambda: rolled(PIPE, PRESSED[12.0], 2.0, 81, contact=sc.Coulomb(0.3), restitution=0.5),
    "hops in air": lambda: rolled(
        PIPE, PRESSED[12.0], 2.0, 81, contact=sc.Coulomb(0.3), restitution=0.5, losses=LOSSES["linear air"]
    ),
    "dropped coin": lambda: rolled(
        COIN,
        sc.dropped(COIN, 2.0, 1.2, w1=1.0, w2=-0.4, w3=0.5, velocity=(0.3, 0.2, 0.1)),
        0.3,
        81,
        scale=EURO,
        contact=sc.Coulomb(0.3),
        restitution=0.3,
    ),
    "dropped on ice": lambda: rolled(
        COIN, sc.dropped(COIN, 1.0, 1.2, velocity=(0.3, 0.2, 0.1)), 1.5, 101, restitution=0.8, **SMOOTH
    ),
    "dropped on rubber": lambda: rolled(COIN, sc.dropped(COIN, 1.0, 1.2, w3=2.0), 1.5, 101, restitution=0.5),
    "dropped bottle": lambda: rolled(
        BOTTLE,
        sc.dropped(BOTTLE, 0.5, 2.4, w1=1.0, w2=0.5),
        3.0,
        121,
        contact=sc.Coulomb(0.3),
        restitution=0.5,
    ),
    "lies": lambda: rolled(PIPE, PRESSED[5.0], 10.0, 201, contact=sc.Coulomb(0.3), restitution=0.0),
}
SCENES = ROLLING | ON_ICE | RUBBED | LOST | ALOFT


@cache
def scene_of(name):
    return SCENES[name]()
