"""Sweeps of bodies and sweeps of stones share their features."""

import dataclasses
import re

import numpy as np
import pytest

import spincyl as sc
from spincyl import _core

xarray = pytest.importorskip("xarray")
da = pytest.importorskip("dask.array")

COUNT = 23


def bodies(x):
    """A family of bodies and their starts; `x` from 0 to 1 is an array of any type."""
    body = sc.Body.solid(0.9 + x)
    return body, body.steady(1.3).kicked(0.05 + 0.01 * x)


def stones(x):
    stone = sc.Ellipsoid.rattleback((1.0, 0.15, 0.1), twist=0.02 + 0.05 * x)
    return stone, stone.spinning(-0.6 - 0.2 * x, pitch=0.02)


def eggs(x):
    """A family of slipping stones given by all of their numbers."""
    axes = np.array([0.75, 0.75, 1.0])
    inertia = np.diag((0.2, 0.2, 0.2)) * (0.6 + 0.1 * x[..., None, None])
    stone = sc.Ellipsoid(axes, inertia, theta_end=1.5 + 0.0 * x)
    return stone, stone.with_centre_velocity(stone.spinning(1.0 + x, pitch=0.3), 0.1, x)


FAMILIES = {
    "bodies": (bodies, {"contact": "rolling", "want": ("final", "end")}),
    "bodies that slip": (bodies, {"contact": sc.Coulomb(0.3), "want": ("final", "end", "dissipated")}),
    "stones": (stones, {"contact": "rolling", "want": ("final", "end", "reversals")}),
    "stones that slip": (stones, {"contact": sc.Coulomb(0.3), "want": ("final", "spin", "dissipated")}),
    "eggs": (eggs, {"contact": sc.Viscous(0.1)}),
    "eggs on a patch": (eggs, {"contact": sc.Coulomb(0.3, patch=0.02), "want": ("final", "dissipated")}),
    "bodies on a patch": (bodies, {"contact": sc.Coulomb(0.3, patch=0.02), "want": ("final", "end")}),
}


@pytest.fixture(params=FAMILIES)
def family(request):
    return FAMILIES[request.param]


def same_bits(one, other):
    assert set(one.data_vars) == set(other.data_vars)
    for name, array in one.data_vars.items():
        assert array.dims == other[name].dims and array.dtype == other[name].dtype, name
        assert array.values.tobytes() == other[name].values.tobytes(), name
        assert array.attrs == other[name].attrs


def test_lazily_the_bits_are_those_at_once(family):
    make, how = family
    x = np.linspace(0.0, 1.0, COUNT)
    at_once = sc.sweep.roll(*make(x), 3.0, **how)
    lazy = sc.sweep.roll(*make(da.from_array(x, chunks=5)), 3.0, **how)
    assert all(array.chunks == ((5, 5, 5, 5, 3),) for array in lazy.data_vars.values())
    same_bits(at_once, lazy.compute(scheduler="threads"))
    told = lazy.attrs.pop("spincyl_sweep")
    assert told["job"] == "roll" and lazy.attrs == at_once.attrs


def test_a_lazy_state_or_coefficient_is_enough(family):
    make, how = family
    x = np.linspace(0.0, 1.0, COUNT)
    body, state = make(x)
    at_once = sc.sweep.roll(body, state, 2.0, **how)
    same_bits(at_once, sc.sweep.roll(body, make(da.from_array(x, chunks=8))[1], 2.0, **how).compute())
    mu = 0.2 + 0.1 * x
    kind = {"contact": sc.Coulomb(mu)}, {"contact": sc.Coulomb(da.from_array(mu, chunks=8))}
    want = {"want": "dissipated"}
    found = [sc.sweep.roll(body, state, 2.0, **contact, **want) for contact in kind]
    same_bits(found[0], found[1].compute())


def test_coefficients_broadcast_by_name(family):
    make, _ = family
    mu = xarray.DataArray([0.1, 0.2, 0.3], dims="mu", coords={"mu": [0.1, 0.2, 0.3]})
    body, state = make(np.linspace(0.0, 1.0, 4))
    found = sc.sweep.roll(body, state, 1.0, contact=sc.Coulomb(mu), want="dissipated")
    assert dict(found.sizes) == {"motion": 4, "mu": 3} and "mu" in found.coords
    for i in range(3):
        one = sc.sweep.roll(body, state, 1.0, contact=sc.Coulomb(float(mu[i])), want="dissipated")
        assert (found["dissipated"][dict(mu=i)].values == one["dissipated"].values).all()


def test_shapes_have_the_same_dimensions(family):
    make, how = family
    for shape, dims in (
        ((), ()),
        ((4,), ("motion",)),
        ((2, 3), ("motion_0", "motion_1")),
        ((0,), ("motion",)),
    ):
        found = sc.sweep.roll(*make(np.linspace(0.0, 1.0, int(np.prod(shape))).reshape(shape)), 1.0, **how)
        assert found["status"].dims == dims and found["status"].shape == shape
        assert found["status"].dtype == np.uint8 and found["error"].dtype == np.float64
        assert all(
            "units" in array.attrs and "long_name" in array.attrs for array in found.data_vars.values()
        )


def test_threads_and_progress_are_those_of_any_sweep(family):
    make, how = family
    told = []
    x = np.linspace(0.0, 1.0, COUNT)
    one = sc.sweep.roll(*make(x), 2.0, threads=1, **how)
    same_bits(one, sc.sweep.roll(*make(x), 2.0, threads=2, progress=told.append, **how))
    assert told[-1] == 1.0


@pytest.mark.parametrize(
    ("wrong", "error", "word"),
    [
        ({"tol": 1.0}, ValueError, "tol = 1.0: expected"),
        ({"tol": "fine"}, TypeError, "tol: "),
        ({"mu": [1.0, 2.0]}, TypeError, "mu: expected a number"),
        ({"t": np.inf}, ValueError, "t = inf: expected"),
        ({"want": "colour"}, ValueError, "want = 'colour': expected some of"),
        ({"contact": "sticky"}, ValueError, "contact = 'sticky': expected"),
        ({"threads": 0}, ValueError, "threads = 0: expected"),
        ({"progress": 1}, TypeError, "progress: expected"),
        ({"states": None}, TypeError, "states: expected"),
    ],
)
@pytest.mark.parametrize("lazy", [False, True])
def test_what_makes_no_sense_is_refused_by_name_before_any_work(family, wrong, error, word, lazy):
    make, how = family

    def never(x):
        raise AssertionError("it was computed")

    x = np.linspace(0.0, 1.0, 4)
    x = da.from_array(x, chunks=2).map_blocks(never, dtype=float, meta=np.empty(0)) if lazy else x
    body, state = make(x)
    given = {"bodies": body, "states": state, "t": 1.0, **how, **wrong}
    with pytest.raises(error, match=f"^{re.escape(word)}"):
        sc.sweep.roll(**given)


def test_shapes_that_do_not_fit_are_named(family):
    make, how = family
    body, state = make(np.linspace(0.0, 1.0, 3))[0], make(np.linspace(0.0, 1.0, 4))[1]
    with pytest.raises(ValueError, match="^bodies, states: shapes do not fit: .*(3,).*(4,)"):
        sc.sweep.roll(body, state, 1.0, **how)


def test_a_slip_on_a_table_without_a_law_for_it_is_refused_also_where_it_is_not_known():
    for x in (np.ones(3), da.ones(3, chunks=2)):
        with pytest.raises(ValueError, match="^states: the stones slip, and contact='rolling' has no law"):
            sc.sweep.roll(*eggs(x), 1.0)


def test_a_stone_that_is_none_is_marked_in_its_block():
    twist = np.array([0.02, np.nan, 0.03, 0.04])
    for x in (twist, da.from_array(twist, chunks=2)):
        stone = sc.Ellipsoid.rattleback((1.0, 0.15, 0.1), twist=x)
        found = sc.sweep.roll(stone, stone.spinning(0.3), 1.0, want="spin").compute()
        assert (found["status"] == sc.sweep.Status.INVALID).values.tolist() == [False, True, False, False]
        assert np.isnan(found["spin"].values).tolist() == [False, True, False, False]


def test_a_lazy_sweep_of_stones_can_be_saved_and_read(tmp_path):
    x = np.linspace(0.0, 1.0, COUNT)
    lazy = sc.sweep.roll(*stones(da.from_array(x, chunks=5)), 2.0)
    sc.sweep.save(lazy, tmp_path / "stones.zarr")
    found = xarray.open_zarr(tmp_path / "stones.zarr")
    for name, array in sc.sweep.roll(*stones(x), 2.0).data_vars.items():
        # codes are stored as floats, NaN where nothing has been written yet
        assert np.array_equal(array.values, found[name].values, equal_nan=True), name
    with pytest.raises(ValueError, match=r"holds another sweep \(t is \[2.0\] there, \[3.0\] here\)"):
        sc.sweep.save(sc.sweep.roll(*stones(da.from_array(x, chunks=5)), 3.0), tmp_path / "stones.zarr")
    assert sc.sweep.block_size(lambda x: sc.sweep.roll(*stones(x), 2.0), x, seconds=0.1) >= 1


def test_a_measured_family_is_told_in_seconds(family):
    make, how = family
    x = np.linspace(0.0, 1.0, 3)
    body, state = make(x)
    scale = sc.Scale(0.02, 0.05)
    how = {**how, "contact": "smooth", "want": "end"}
    if make is eggs:
        state = dataclasses.replace(state, slip=None)
    measured = dataclasses.replace(body, scale=scale)
    found = sc.sweep.roll(measured, state, 0.1, **how)
    natural = sc.sweep.roll(body, state, 0.1 / scale.seconds(1.0), **how)
    assert found.attrs["t"] == 0.1 and found["end"].attrs["units"] == "s"
    assert np.allclose(found["end"], natural["end"] * scale.seconds(1.0), rtol=1e-15)


def test_a_lazy_family_is_that_in_memory():
    x = np.linspace(0.0, 1.0, 7)
    for make in (stones, eggs):
        (stone, state), (lazy, later) = make(x), make(da.from_array(x, chunks=3))
        assert lazy.shape == stone.shape and repr(lazy) == repr(stone)
        assert lazy == stone and later == state
        assert (later.spin.compute() == state.spin).all()
        assert (later.inclinations == state.inclinations).all()
        assert (lazy.moments == stone.moments).all()
        assert lazy.in_metres().scale == stone.in_metres().scale


def test_every_number_of_a_stone_s_motion_has_a_label_and_is_filled():
    names = [name for name, _, _ in _core.stone_columns()]
    want = ("final", *(name for name in names if not re.fullmatch(r"[nw]\d|error|known_until", name)))
    found = sc.sweep.roll(*stones(np.array([0.5])), 2.0, contact=sc.Coulomb(0.3), restitution=0.5, want=want)
    assert {*found.data_vars} == {*names, "status"}
    assert all(np.isfinite(found[name]).all() for name in names if name != "first_reversal")
