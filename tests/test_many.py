"""Many motions at once against each of them alone: ends, times and states, for random unusual scenes.

`benches/claims.py --of many` draws them by the hundred thousand.
"""

from functools import cache

import numpy as np
import pytest
import scenes

import spincyl as sc

SEED, FAMILY = 24, 20
#: times the sum of both claims, which are estimates: one of 2,000 motions in a hundred families exceeds it by
#: 6 %
HONEST = 1.1


@cache
def family(number):
    """A family of motions, and the differences of each at once and alone."""
    scene = scenes.draw(np.random.default_rng([SEED, number]), FAMILY)
    return scene, list(scenes.compare(scene))


@pytest.mark.parametrize("part", range(6))
def test_together_every_motion_is_what_it_is_alone(part):
    wrong = []
    for number in range(10 * part, 10 * part + 10):
        for i, apart in enumerate(family(number)[1]):
            if apart.kind or not apart.ratio <= HONEST:
                told = f"family {number}, motion {i}: {apart.status}, {apart.ratio:.3g} of {apart.claims}"
                wrong.append(f"{told}\n    {apart.call}")
    assert not wrong, "\n".join(wrong)


def test_on_patches_every_motion_is_what_it_is_alone():
    wrong = []
    for number in range(20):
        scene = scenes.draw(np.random.default_rng([SEED, 52, number]), FAMILY, "patch")
        wrong += [apart for apart in scenes.compare(scene) if apart.kind or not apart.ratio <= HONEST]
    assert not wrong, "\n".join(f"{apart.status}, {apart.ratio:.3g}: {apart.call}" for apart in wrong)


def test_the_scenes_hold_every_kind_of_start_and_end():
    ends, contacts, laws = set(), set(), set()
    for number in range(40):
        scene, found = family(number)
        contacts.add(scene.contact)
        laws.update(scene.losses)
        ends.update(apart.status[0] for apart in found)
    assert contacts == set(scenes.CONTACTS) and laws == set(range(len(scenes.LAWS)))
    # done, face, side, lift-off, slip, Painleve
    assert ends >= {0, 1, 2, 3, 4, 6}


def test_disks_that_spin_on_their_edge_stop_together_as_each_stops_alone():
    # no random start ends so: a body stops only once nothing of it moves, and what leans falls over
    laws = [scenes.LAWS.index(law) for law in (sc.loss.RollingResistance, sc.loss.Drilling)]
    scene = scenes.draw(np.random.default_rng([SEED, 7]), FAMILY, "coulomb", laws)
    starts = np.zeros_like(scene.starts)
    starts[:, :2] = np.pi / 2, 0.5
    losses = {k: np.linspace(0.01, 0.1, FAMILY) for k in sorted(laws)}
    bodies = np.tile([0.0, 0.25, 0.5, 0.0], (FAMILY, 1))
    found = list(
        scenes.compare(
            scene._replace(bodies=bodies, starts=starts, losses=losses, times=np.array([200.0]), how={})
        )
    )
    assert not [apart.call for apart in found if apart.kind or not apart.ratio <= HONEST]
    assert [apart.status for apart in found].count((7, 7)) > FAMILY // 4
