"""Fields keep their values: later changes of the caller's arrays change no body, state, law or motion."""

import numpy as np
import pytest

import spincyl as sc

ONE = {"ell": 2.0, "i1": 1.5, "i3": 0.5}
STONE = {"semi_axes": (1, 0.5, 0.4), "inertia": np.diag([0.1, 0.2, 0.21])}
UP = {"vertical": (0, 0, 1.0), "w": (0, 0.01, 0.5)}


def law(kind, name):
    return name, lambda x: kind(x), np.array([1e-3, 2e-3])


FIELDS = [
    *((name, lambda x, n=name: sc.Body(**ONE | {n: x}), np.full(2, value)) for name, value in ONE.items()),
    ("bore", lambda x: sc.Body(2.0, np.nan, np.nan, x), np.array([0.2, 0.3])),
    ("fillet", lambda x: sc.Body(**ONE, fillet=x), np.array([0.2, 0.3])),
    ("theta_end", lambda x: sc.Body(**ONE, theta_end=x), np.array([1.2, 1.3])),
    *(
        (
            name,
            lambda x, n=name: sc.State(**dict.fromkeys(("theta", "w1", "w2", "w3"), 0.5) | {n: x}),
            np.array([1.0, 2]),
        )
        for name in ("theta", "w1", "w2", "w3")
    ),
    ("slip", lambda x: sc.State(1.0, 0, 0, 0, slip=(x, 0.0)), np.array([1.0, 2.0])),
    ("slip", lambda x: sc.State(1.0, 0, 0, 0, slip=x), np.array([1.0, 2.0])),
    ("mu", sc.Coulomb, np.array([0.1, 0.2])),
    ("static", lambda x: sc.Coulomb(0.1, static=x), np.array([0.1, 0.2])),
    ("c", sc.Viscous, np.array([0.1, 0.2])),
    ("coefficient", sc.loss.DryContour, np.array([1e-3, 2e-3])),
    ("coefficient", sc.loss.AirFilm, np.array([1e-7, 2e-7])),
    (
        "semi_axes",
        lambda x: sc.Ellipsoid(**STONE | {"semi_axes": x}),
        np.array([[1, 0.5, 0.4], [1, 0.6, 0.4]]),
    ),
    ("inertia", lambda x: sc.Ellipsoid(**STONE | {"inertia": x}), np.array([np.diag([0.1, 0.2, 0.21])] * 2)),
    ("inertia", lambda x: sc.Ellipsoid(**STONE | {"inertia": x}), np.diag([0.1, 0.2, 0.21])),
    ("offset", lambda x: sc.Ellipsoid(**STONE, offset=x), np.array([[0, 0, -0.1], [0, 0, 0.1]])),
    ("theta_end", lambda x: sc.Ellipsoid(**STONE, theta_end=x), np.array([1.5, 1.2])),
    ("vertical", lambda x: sc.EllipsoidState(**UP | {"vertical": x}), np.array([0, 0, 1.0])),
    ("w", lambda x: sc.EllipsoidState(**UP | {"w": x}), np.array([0, 0, 1.0])),
    ("slip", lambda x: sc.EllipsoidState(**UP, slip=x), np.array([0.1, 0.2])),
]


@pytest.mark.parametrize(
    ("name", "make", "given"), FIELDS, ids=[f"{i} {name}" for i, (name, *_) in enumerate(FIELDS)]
)
def test_a_field_is_a_copy_that_nobody_changes(name, make, given):
    array = given.copy()
    noun, same = make(array), make(array)
    array[...] = 0.07
    assert noun == same == make(given) and hash(noun) == hash(same)
    found = getattr(noun, name)
    for field in found if isinstance(found, tuple) else (found,):
        if isinstance(field, np.ndarray):
            with pytest.raises(ValueError, match="read-only"):
                field[...] = 0.05


def test_labelled_arrays_are_copied_too():
    xarray = pytest.importorskip("xarray")
    theta = xarray.DataArray([1.0, 1.2], dims="x")
    state = sc.State(theta, 0.0, 0.0, 0.5)
    theta[0] = 0.3
    assert state.theta.values.tolist() == [1.0, 1.2]
    with pytest.raises(ValueError, match="read-only"):
        state.theta[0] = 0.3


@pytest.mark.parametrize("body", [sc.Body.solid(2.5), sc.measured(outer_diameter=0.05, length=0.12)])
def test_the_times_of_a_motion_are_its_own(body):
    t = np.linspace(0, 1, 11)
    m = sc.roll(body, body.steady(1.3).kicked(0.05), t)
    before = m.t.copy()
    t[:] = 5.0
    assert np.array_equal(m.t, before)
    m.t[0] = 7.0
    assert np.array_equal(m.wanting("pose").t, before)
