"""Steady states whose centre runs on a circle, from the radius of the circle or from the spin."""

import numpy as np
import pytest

import spincyl as sc


def test_a_coin_rolls_round_a_circle_of_the_radius_or_with_the_spin_that_is_asked_for():
    coin = sc.Body.solid(0.05)
    wide = coin.circular(1.4, radius=5.0)
    np.testing.assert_allclose([coin.centre_radius(wide), wide.precession > 0], [5.0, True], rtol=1e-13)
    assert abs(coin.acceleration(wide)) < 1e-13, "theta stays"
    slow, fast = (
        sc.State(*(float(x[k]) for x in (s.theta, s.w1, s.w2, s.w3)))
        for s in [coin.circular(1.4, w3=wide.w3)]
        for k in (0, 1)
    )
    assert abs(slow.precession - wide.precession) < 1e-13 and abs(fast.precession) > slow.precession
    many = coin.circular(np.array([1.2, 1.4])[:, None], radius=np.array([2.0, 5.0, 1e3]))
    assert many.w1.shape == (2, 3) and np.isfinite(many.w3).all() and abs(many.w3[1, 1] - wide.w3) < 1e-13
    pairs = sc.Body.solid(np.array([0.05, 2.0])).circular(1.4, w3=1.0)
    assert pairs.theta.shape == (2, 2)
    named = pytest.importorskip("xarray").DataArray([wide.w3, 1.0, 2.0], dims="spin")
    spins = coin.circular(1.4, w3=named)
    assert spins.w1.dims == ("spin", "root") and abs(spins.precession[0, 0] - wide.precession) < 1e-13
    for wrong in ({}, {"radius": 1.0, "w3": 1.0}, {"precession": 1.0, "radius": 2.0}):
        with pytest.raises(TypeError, match="precession, radius, w3: give exactly one of them"):
            coin.circular(1.4, **wrong)
    with pytest.raises(ValueError, match="radius = -0.1: no steady state at theta"):
        sc.Body.solid(5.0).circular(1.0, radius=-0.1)
    assert np.isnan(sc.Body.solid(5.0).circular(np.array([1.0]), radius=-0.1).w1).all()
