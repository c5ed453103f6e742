"""Friction of your own under stones: in SI, as a C function, in sweeps, and what goes wrong on the way."""

import ctypes

import numpy as np
import pytest

import spincyl as sc

T = np.linspace(0.0, 4.0, 9)
EGG = sc.Ellipsoid.egg(1.0, 1.5)
START = EGG.with_centre_velocity(EGG.spinning(4.0, pitch=0.4), 0.6, -0.3)


def falling(speed):
    return 0.15 + 0.15 / (1.0 + speed * speed)


FALLING = sc.custom.Friction(falling)


def test_an_egg_under_friction_of_your_own_keeps_energy_and_heat_and_tells_all_that_it_tells_under_coulombs():
    m = sc.roll(EGG, START, T, contact=FALLING, want=("pose", "force"))
    assert np.ptp(m.energy + m.dissipated) < 1e-8 and m.dissipated[-1] > 0.05
    slips = np.hypot(*m.slip.T) > 1e-9
    assert slips.sum() > 3
    np.testing.assert_allclose(m.friction_coefficient[slips], falling(np.hypot(*m.slip.T))[slips], rtol=1e-9)


def test_a_constant_of_your_own_is_coulombs_and_one_that_grows_is_a_film():
    for own, law in (
        (sc.custom.Friction(lambda speed: 0.2, 0.25), sc.Coulomb(0.2, static=0.25)),
        (sc.custom.Friction(lambda speed: 0.2 * speed), sc.Viscous(0.2)),
    ):
        a, b = (sc.roll(EGG, START, T, contact=contact, tol=1e-12) for contact in (own, law))
        np.testing.assert_allclose(a.w, b.w, atol=1e-8)
        np.testing.assert_allclose(a.dissipated, b.dissipated, atol=1e-8)
        assert [phase[1] for phase in a.phases] == [phase[1] for phase in b.phases]


def test_a_sweep_of_stones_and_a_c_function_give_the_motions_of_a_python_function():
    kind = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)
    pointed = sc.custom.Friction(kind(falling))
    spins = np.array([3.0, 4.0, 5.0])
    starts = EGG.with_centre_velocity(EGG.spinning(spins, pitch=0.4), 0.6, -0.3)
    found = [
        sc.sweep.roll(EGG, starts, 4.0, contact=of, tol=1e-10, want="final") for of in (FALLING, pointed)
    ]
    for k, spin in enumerate(spins):
        start = EGG.with_centre_velocity(EGG.spinning(spin, pitch=0.4), 0.6, -0.3)
        alone = [sc.roll(EGG, start, 4.0, contact=of, tol=1e-10).w[-1] for of in (FALLING, pointed)]
        for w, swept in zip(alone, found, strict=True):
            assert [float(swept[name][k]) for name in ("w1", "w2", "w3")] == w.tolist()
        np.testing.assert_array_equal(*alone)


def test_the_law_of_a_measured_stone_gets_metres_a_second():
    egg = sc.Ellipsoid.egg("22mm", "30.8mm")
    speed = egg.scale._units[0] / egg.scale._units[1]
    start = EGG.spinning(4.0, pitch=0.4)
    seen = []

    def law(u):
        seen.append(u)
        return falling(u / speed)

    natural = egg.natural
    begins = natural.with_centre_velocity(start, 0.6, -0.3)
    m = sc.roll(egg, begins, T * egg.scale.seconds(1.0), contact=sc.custom.Friction(law))
    bare = sc.roll(natural, begins, T, contact=FALLING)
    np.testing.assert_allclose(m.natural.w, bare.w, atol=1e-9)
    swept = sc.sweep.roll(
        egg, begins, float(T[-1] * egg.scale.seconds(1.0)), contact=sc.custom.Friction(law), want="spin"
    )
    assert float(swept["spin"]) * egg.scale.seconds(1.0) == pytest.approx(bare.spin[-1], abs=1e-8)
    assert max(seen) >= 1.0


def test_an_error_in_the_law_or_a_wrong_value_ends_the_motion_and_the_sweep_with_it():
    calls = [0]

    def fails(speed):
        calls[0] += 1
        if calls[0] > 1100:
            raise RuntimeError("the law is over")
        return 0.3

    def negative(speed):
        calls[0] += 1
        return 0.3 if calls[0] < 1100 else -0.1

    for run in (sc.roll, sc.sweep.roll):
        calls[0] = 0
        with pytest.raises(RuntimeError, match="the law is over"):
            run(EGG, START, 4.0, contact=sc.custom.Friction(fails))
        calls[0] = 0
        with pytest.raises(ValueError, match="mu = -0.1"):
            run(EGG, START, 4.0, contact=sc.custom.Friction(negative))
    with pytest.raises(ValueError, match="^static = 0.2: "):
        sc.roll(EGG, START, 4.0, contact=sc.custom.Friction(falling, 0.2))
