"""Stones with weights: moments by sums over points, an unbalanced disk, units, and what is refused."""

import numpy as np
import pytest

import spincyl as sc

PEBBLE = sc.Ellipsoid.uniform((1.0, 0.4, 0.3))


def test_a_stone_with_weights_has_the_moments_of_all_of_its_points():
    rng = np.random.default_rng(53)
    for _ in range(20):
        stone = sc.Ellipsoid.rattleback((1.0, 0.4, 0.3), twist=0.2)
        weights = [
            (m, p / 4) for m, p in zip(rng.uniform(0.01, 1, 3), rng.uniform(-1, 1, (3, 3)), strict=True)
        ]
        found = stone.with_weights([(m, tuple(p)) for m, p in weights])
        # six points have any mass, centre and moments that a body has
        principal, axes = np.linalg.eigh(stone.inertia)
        arms = np.sqrt(principal.sum() / 2 - principal)
        points = [
            stone.offset + side * np.sqrt(3) * arm * e
            for arm, e in zip(arms, axes.T, strict=True)
            for side in (1, -1)
        ]
        masses = np.array([1 / 6] * 6 + [m for m, _ in weights])
        points = np.array(points + [p for _, p in weights])
        centre = masses @ points / masses.sum()
        r = points - centre
        outer = np.einsum("k,ki,kj->ij", masses, r, r) / masses.sum()
        assert np.allclose(found.offset, centre, atol=1e-15)
        assert np.allclose(found.inertia, np.trace(outer) * np.eye(3) - outer, atol=1e-15)


def test_one_weight_after_the_other_is_both_at_once():
    both = PEBBLE.with_weights([(0.1, (0.5, 0, 0)), (0.2, (0, 0.2, 0.1))])
    after = PEBBLE.with_weights([(0.1, (0.5, 0, 0))]).with_weights([(0.2 / 1.1, (0, 0.2, 0.1))])
    assert np.allclose(both.inertia, after.inertia, atol=1e-16)
    assert np.allclose(both.offset, after.offset, atol=1e-16)
    assert PEBBLE.with_weights([]) == PEBBLE


def test_an_unbalanced_disk_on_its_edge_swings_as_a_pendulum_that_rolls():
    # w^2 = d/(I + (1 - d)^2) for a disk whose centre of mass is d below its axis
    disk = sc.Ellipsoid.uniform((1.0, 0.02, 1.0)).with_weights([(0.25, (0.0, 0.0, -0.8))])
    d = 0.25 * 0.8 / 1.25
    assert disk.offset[2] == pytest.approx(-d, rel=1e-15)
    pendulum = np.sqrt(d / (disk.inertia[1, 1] + (1 - d) ** 2))
    assert np.abs(disk.rocking(0.0).frequency - pendulum).min() < 1e-12


def test_a_measured_stone_takes_grams_and_millimetres():
    stone = sc.Ellipsoid.rattleback(("8cm", "16mm", "14mm"), twist=0.05, mass="40g")
    found = stone.with_weights([("5g", ("70mm", "5mm", "0mm")), (0.005, (-0.07, -0.005, 0.0))])
    assert found.scale.mass == pytest.approx(0.05)
    ends = stone.natural.with_weights([(0.125, (0.875, 0.0625, 0)), (0.125, (-0.875, -0.0625, 0))])
    assert np.allclose(found.inertia, ends.inertia, atol=1e-15)


@pytest.mark.parametrize(
    ("weights", "error", "words"),
    [
        (3, TypeError, "list of"),
        ([3], TypeError, r"weights\[0\]: expected \(mass"),
        ([(1, 2)], TypeError, "a position"),
        ([(1, (1, 2))], TypeError, "a position"),
        ([(-1, (0, 0, 0))], ValueError, "positive"),
        ([(np.nan, (0, 0, 0))], ValueError, "mass"),
        ([(1, (0, 0, np.inf))], ValueError, "finite"),
        ([("a", (0, 0, 0))], TypeError, "mass"),
        ([(1e300, (0, 0, 2))], ValueError, "offset"),
    ],
)
@pytest.mark.filterwarnings("ignore:weights")
def test_what_is_no_weight_is_refused_by_name(weights, error, words):
    with pytest.raises(error, match=words):
        PEBBLE.with_weights(weights)


def test_a_weight_outside_a_family_and_an_unknown_mass_are_told():
    with pytest.warns(UserWarning, match="outside"):
        PEBBLE.with_weights([(0.1, (0.0, 0.0, 0.4))])
    with pytest.raises(ValueError, match="single stone"):
        sc.Ellipsoid.uniform([(1.0, 0.4, 0.3)] * 2).with_weights([])
    with pytest.raises(ValueError, match="unknown"):
        PEBBLE.in_metres().with_weights([])
