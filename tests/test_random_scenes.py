"""The checks of benches/random_scenes.py find what is planted in a motion, and nothing in the motion itself."""

import copy
import sys
from pathlib import Path

import numpy as np
import pytest

import spincyl as sc

sys.path.append(str(Path(__file__).parents[1] / "benches"))
from drawn_answers import ANSWERS
from drawn_kinds import KINDS, at_once, drawn
from drawn_motions import MOTIONS
from invariants import Found, balance, beside, endings, judged, lowest, mirrored
from random_scenes import NAMED, generator, one, word_of

BODY = sc.Body.solid(0.8)
HOW = {"contact": sc.Coulomb(0.3), "restitution": 0.0}
START = sc.dropped(BODY, 0.4, 0.9, w1=0.5, w2=0.3)
TIMES = np.linspace(0.0, 4.0, 81)


@pytest.fixture
def motion():
    return copy.copy(sc.roll(BODY, START, TIMES, want=("pose", "force"), **HOW))


def planted(m, **values):
    for name, value in values.items():
        where = m._extra if name in m._extra else m.__dict__
        where[name] = value
    return m


def faults(m, check=balance):
    found = Found()
    check(BODY, m, found)
    return set(found.faults)


def test_a_right_motion_passes_every_check(motion):
    found = Found()
    judged(BODY, START, TIMES, HOW, found)
    assert found.faults == {} and faults(motion) == set()
    s, c = np.sin(motion.theta), np.abs(np.cos(motion.theta))
    np.testing.assert_allclose(
        lowest(BODY, motion.theta, motion.centre[:, 2]), motion.centre[:, 2] - s - 0.8 * c, atol=1e-15
    )


def test_energy_that_appears_is_found(motion):
    w = motion.w.copy()
    w[40] *= 1 + 1e-8
    assert faults(planted(motion, w=w)) == {"energy"}


def test_heat_that_goes_back_is_found(motion):
    heat = motion.dissipated.copy()
    heat[-1] -= 0.01
    assert faults(planted(motion, dissipated=heat)) == {"energy", "gains"}


def test_a_body_below_the_table_and_a_table_that_pulls_are_found(motion):
    centre, normal = motion.centre.copy(), motion.normal.copy()
    centre[5, 2] -= 2.0
    normal[60] = -1e-6
    assert faults(planted(motion, centre=centre, normal=normal)) == {"below", "pulls"}
    normal[61] = np.nan
    assert faults(planted(motion, theta=motion.theta * np.nan)) == {"not finite"}


def test_an_ending_without_a_reason_is_found(motion):
    ended = planted(motion, status=sc.Ending.BOUNDED, event=None)
    assert faults(ended, endings) == {"ends"}
    event = sc.Event(sc.Ending.STOPS, 1.0, sc.State(0.3, 0.0, 1e-3, 0.0, slip=(0.0, 0.0)))
    assert faults(planted(motion, status=sc.Ending.STOPS, event=event), endings) == {"stops"}


def test_another_motion_is_found(motion):
    other = planted(copy.copy(motion), theta=motion.theta + 1e-9)
    found = Found()
    beside(BODY, motion, other, 4.0, found)
    assert set(found.faults) == {"tol"}
    # a start in the mirror must move as in the mirror
    image = sc.roll(BODY, mirrored(START), TIMES, **HOW)
    found = Found()
    beside(BODY, motion, image, 4.0, found, "mirror", np.array([1.0, -1.0, 1.0, -1.0]))
    assert found.faults == {}
    beside(BODY, motion, image, 4.0, found, "mirror")
    assert set(found.faults) == {"mirror"}


def test_a_scene_depends_on_its_number_only():
    for kind, draw in MOTIONS.items():
        twice = [draw(generator(64, kind, 3), 3).call() for _ in range(2)]
        assert twice[0] == twice[1] != draw(generator(64, kind, 4), 4).call(), kind
    assert len(MOTIONS) + len(ANSWERS) == 21


def test_refusals_are_told_without_their_numbers():
    assert word_of(ValueError("mu = 2.5: no force at theta = 0.1")) == "mu = #: no force at theta = #"
    assert NAMED.match("theta = 0.1: why") and NAMED.match("t: why") and not NAMED.match("high - low < 0")
    assert one(64, "hops, AirFilm", 0)[0] == 0


@pytest.mark.parametrize("kind", KINDS)
def test_the_motions_of_a_kind_are_the_same_alone_and_at_once(kind):
    scenes = [drawn(kind, k, 3, turn=1)[0] for k in range(4)]
    body, state, how = at_once(scenes)
    names = ("n1", "n2", "n3") if kind == "stones" else ("theta",)
    names += ("w1", "w2", "w3")
    many = sc.sweep.roll(body, state, 0.5, want="final", tol=1e-8, **how)
    for k, scene in enumerate(scenes):
        one = sc.roll(scene.body, scene.state, 0.5, tol=1e-8, **scene.how)
        assert one.status == int(many["status"][k])
        if one.event is None:
            first = one.vertical[-1] if kind == "stones" else one.theta[-1:]
            theirs = [float(many[name][k]) for name in names]
            apart = np.abs(np.concatenate([first, one.w[-1]]) - theirs).max()
            assert apart <= one.error + float(many["error"][k])
