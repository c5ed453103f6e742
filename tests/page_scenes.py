"""The scenes that tests of pages, films and pictures show: each motion is computed once, and each page built once.

A test names the scene that it shows: `page_of("nutating")` is its page, `motion_of("nutating")` what is seen there. What
belongs to one test alone stands there.
"""

from functools import cache

import hurricane_balls
import numpy as np
from nutating_cylinder import start as START

import spincyl as sc
from spincyl import parts

CYLINDER, PIPE, DISK = sc.Body.solid(2.5), sc.Body.tube(6.0, bore=0.8), sc.Body.solid(0.375)
CAN, COIN, RING = sc.Body.solid(1.0), sc.Body.solid(0.0852), sc.Body.tube(0.0, bore=1.0)
ROUNDED, CAPSULE, BALLS = sc.Body.solid(1.5, fillet=0.3), sc.Body.solid(2.5, fillet=1.0), sc.Body.balls()
TIPPE = sc.Body.ball(-0.3, 0.45, 0.42)
# the small stone of docs/stones.md; a toy of 40 cm that is cut; an egg that rises; one whose second axis is the long one
TWISTED = [[0.02, -0.012, 0.0], [-0.012, 0.2, 0.0], [0.0, 0.0, 0.21]]
SMALL = sc.Ellipsoid((1.0, 0.3, 0.2), TWISTED, offset=(0.0, 0.0, -0.07))
TOY = sc.Ellipsoid.rattleback((0.20, 0.03, 0.02), twist=np.radians(3)).in_metres(mass=0.3)
EGG = sc.Ellipsoid.egg(0.7, 1.0)
ACROSS = sc.Ellipsoid((0.4, 1.0, 0.3), (0.25, 0.06, 0.28), (0.05, -0.1, -0.1), 1.2)

PAPER = {"density": 0.3}
CUP = sc.assembled(
    [
        parts.disk(outer_diameter="50mm", **PAPER),
        parts.wall(lower_diameter="50mm", upper_diameter="80mm", length="95mm", at=0, **PAPER),
    ]
)
# a foot, a stem with a collar round it, and a bowl
GOBLET = sc.assembled(
    [
        parts.cylinder(outer_diameter="60mm", length="4mm", mass="30g"),
        parts.cylinder(outer_diameter="24mm", length="50mm", mass="10g"),
        parts.shell(diameter="70mm", height="45mm", mass="20g"),
        parts.cylinder(outer_diameter="52mm", inner_diameter="24mm", length="16mm", at="22mm", mass="5g"),
    ]
)

STANDING = DISK.steady(np.radians(80)).kicked(0.01)
DROPPED = sc.State(0.3, 0.0, 0.0, 0.0)
ACROSS_START = sc.EllipsoidState([0.1, 0.2, np.sqrt(0.95)], [0.3, 0.1, 0.8])


def lying(z):
    return sc.EllipsoidState([np.sqrt(1 - z * z), 0.0, z], [6.0, 0.0, 0.0])


def flicked():
    start = sc.State(np.pi / 2, 3.0, 0.0, 1.3 * PIPE.ell / (PIPE.i3 * 3.0))
    return PIPE.with_centre_velocity(start, 0.0, -PIPE.i1 * 3.0 / PIPE.ell)


def hoop(law):
    start = RING.with_centre_velocity(sc.State(np.pi / 2, 0.0, 0.0, -3.0), 0.0, 2.0)
    return sc.roll(RING, start, 14.0, contact=law)


BODIES = {
    "nutating": lambda: sc.roll(CYLINDER, START, 20.0),
    "for long": lambda: sc.roll(CYLINDER, CYLINDER.steady(1.3).kicked(0.2), 3000.0),
    "stepped": lambda: sc.roll(CYLINDER, START, 20.0, step=1e-2),
    "sliding": lambda: sc.roll(CYLINDER, START, 20.0, contact="smooth"),
    "rocking": lambda: sc.roll(CAN, sc.State(0.3, 1e-3, 0.0, 0.0), 5.0),
    "hardly not landing": lambda: sc.roll(CAN, sc.State(0.3, 1e-5, 0.0, 0.0), 5.0),
    "whirring": lambda: sc.roll(COIN, COIN.steady(0.1).kicked(0.1), 8.0),
    "long": lambda: sc.roll(PIPE, PIPE.steady(1.5), 2.5e4),
    "circling": lambda: sc.roll(COIN, COIN.circular(1.2, 0.3).kicked(0.05), 60.0),
    "backward": lambda: sc.roll(CYLINDER, START, -20.0),
    "rounded": lambda: sc.roll(ROUNDED, ROUNDED.steady(1.3).kicked(0.05), 20.0),
    "rounded and sliding": lambda: sc.roll(ROUNDED, ROUNDED.steady(1.3).kicked(0.05), 9.0, contact="smooth"),
    "capsule": lambda: sc.roll(CAPSULE, CAPSULE.steady(1.35).kicked(0.05), 20.0),
    "Hurricane balls": lambda: sc.roll(BALLS, hurricane_balls.start, 20.0),
    "tippe top": lambda: sc.roll(TIPPE, sc.State(0.6, 1.0, 0.0, 6.0), 10.0),
    "close to the pole": lambda: sc.roll(TIPPE, sc.State(0.1, 1e-3, -0.3, 1.0), 10.0),
}
ENDS = {
    "face": lambda: sc.roll(CAN, DROPPED, 5.0),
    "side": lambda: sc.roll(DISK, STANDING, 30.0, contact="smooth"),
    "slip": lambda: sc.roll(CYLINDER, CYLINDER.steady(1.3).kicked(0.05), 20.0, mu=0.06),
    "face, backward": lambda: sc.roll(CAN, DROPPED, -5.0),
    "face, by steps": lambda: sc.roll(CAN, DROPPED, 5.0, step=1e-3),
}
STONES = {
    "turns back": lambda: sc.roll(SMALL, SMALL.spinning(-0.6, pitch=0.02), 60.0),
    "measured": lambda: sc.roll(TOY, TOY.spinning(-5 * TOY.scale.seconds(1.0), pitch=0.01), 6.0),
    "rises": lambda: sc.roll(EGG, lying(0.02), 50.0, contact=sc.Coulomb(0.1)),
    "lands": lambda: sc.roll(ACROSS, ACROSS_START, 12.0),
    "smooth": lambda: sc.roll(EGG, lying(0.1), 8.0, contact="smooth"),
    "tumbles": lambda: sc.roll(EGG, sc.EllipsoidState([0.8, 0.0, 0.6], [0.0, 1.7, 0.2]), 12.0),
}
SCENES = {
    **BODIES,
    **ENDS,
    **STONES,
    "steady": lambda: sc.roll(CYLINDER, CYLINDER.steady(1.3), 5.0),
    "tippe top, at first": lambda: sc.roll(TIPPE, sc.State(0.6, 1.0, 0.0, 6.0), 2.0),
    "cup": lambda: CUP.roll(CUP.steady(1.2), 1.0).natural,
    "goblet": lambda: GOBLET.roll(GOBLET.natural.steady(0.5), 0.3).natural,
    "tube": lambda: sc.roll(PIPE, PIPE.steady(1.2), 20.0),
    "still symbols": lambda: sc.roll(PIPE, PIPE.steady(np.radians(89.5)), 30.0),
    "flick": lambda: sc.roll(PIPE, flicked(), 60.0, contact=sc.Coulomb(0.3)),
    "hoop": lambda: hoop(sc.Coulomb(0.25)),
    "wet hoop": lambda: hoop(sc.Viscous(0.3)),
    "whirr": lambda: sc.roll(COIN, COIN.steady(0.3), 100.0, losses=sc.loss.DryContour(5e-3)),
}


@cache
def motion_of(name):
    return SCENES[name]()


@cache
def page_of(*names, **how):
    """The page of these scenes, side by side."""
    return sc.view(*map(motion_of, names), **how)


@cache
def live_page(friction=True):
    """The page to play with, as it opens where nothing is set; a test that sets something makes its own."""
    return sc.play(friction=friction)
