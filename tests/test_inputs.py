"""A row of a sweep, or of its store, is traced to the body, the start and the laws that it was rolled with."""

import dataclasses
import warnings

import dask.array as da
import numpy as np
import pytest
import xarray as xr

import spincyl as sc
from spincyl import loss
from spincyl._contact import CODES
from spincyl._loss import LAWS
from spincyl.sweep import _inputs, _save

RNG = np.random.default_rng(7)
TUBE = sc.measured(outer_diameter="15.875mm", inner_diameter="12.7mm", length="95.25mm", mass="20g")
MANY = 60


def evenly(low, high, count=MANY):
    return low + (high - low) * RNG.random(count)


def lazy(array):
    return da.from_array(array, chunks=(-(-len(array) // 3), *array.shape[1:]))


def any_start(wrap=lazy, **more):
    """States that roll, most of them to an end."""
    w = (wrap(evenly(-2, 2)) for _ in range(3))
    return sc.State(wrap(evenly(0.2, 1.4)), *w, **more)


def rolling():
    body = sc.Body.tube(lazy(evenly(0.4, 3)), lazy(evenly(0, 0.9)), fillet=0.05)
    return sc.sweep.roll(body, any_start(), 4.0, want=("final", "end", "normal_min"), mu=0.4, tol=1e-9)


def by_steps():
    general = sc.Body(lazy(evenly(0.4, 1)), 0.9, 0.7, theta_end=1.5)
    return sc.sweep.roll(general, any_start(), 2.0, step=0.01, beyond=True, contact="smooth")


def slipping():
    body = sc.Body.solid(lazy(evenly(0.4, 3)))
    start = any_start(slip=(lazy(evenly(-1, 1)), 0.2))
    table = sc.Coulomb(lazy(evenly(0.1, 0.4)), static=0.5, patch=lazy(evenly(0, 0.05)))
    law = loss.AirLinear(lazy(evenly(0, 1e-3) + 1e-9)) + loss.DryContour(1e-3)
    return sc.sweep.roll(body, start, 4.0, contact=table, losses=law, want=("final", "end", "work_lost"))


def measured_on_a_wet_table():
    tube = dataclasses.replace(sc.Body.tube(lazy(evenly(3, 6)), 0.8), scale=TUBE.scale)
    wet = sc.Viscous.from_si(lazy(evenly(0.5, 2)), scale=TUBE)
    law = loss.Drilling.from_si(lazy(evenly(1e-5, 1e-4)), scale=TUBE)
    return sc.sweep.roll(tube, any_start(), 0.1, contact=wet, losses=law, want=("final", "dissipated"))


def measured_by_steps():
    tube = dataclasses.replace(sc.Body.tube(lazy(evenly(3, 6)), 0.8), scale=TUBE.scale)
    return sc.sweep.roll(tube, tube.steady(1.4).kicked(0.05), "70ms", step="0.3ms")


def hopping():
    body = sc.Body.solid(lazy(evenly(0.4, 3)))
    start = any_start(slip=(0.1, 0.2), height=lazy(evenly(0, 0.3)), lift=-0.1)
    how = {"contact": sc.Coulomb(0.3), "restitution": 0.5, "stop_at": "rolling"}
    return sc.sweep.roll(body, start, 4.0, want=("final", "impacts"), **how)


def at_times():
    body = sc.Body.balls()
    return sc.sweep.roll(body, any_start(), np.linspace(0, 3, 5))


def stones():
    rattleback = sc.Ellipsoid.rattleback((0.2, 0.03, 0.02), twist=lazy(evenly(0.01, 0.1, 9))).in_metres(0.3)
    start = rattleback.spinning(-1.0, pitch=lazy(evenly(0.005, 0.02, 9)))
    return sc.sweep.roll(rattleback, start, 0.3, want=("final", "spin"))


def slipping_stones():
    eggs = sc.Ellipsoid.egg(0.022, evenly(0.025, 0.03, 9))
    start = eggs.with_centre_velocity(eggs.spinning(3.0, pitch=1.4), 0.0, 0.0)
    start = sc.EllipsoidState(start.vertical, lazy(start.w), start.slip)
    return sc.sweep.roll(eggs, start, 3.0, want="final", contact=sc.Coulomb(0.3, patch=0.01))


JOBS = (
    rolling, by_steps, slipping, measured_on_a_wet_table, measured_by_steps, hopping, at_times, stones, slipping_stones,
)  # fmt: skip


def quietly(run, *given, **named):
    """Call without warnings of motions that were given up."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return run(*given, **named)


def wants(found):
    """What `roll` is to be asked for, so that it answers with these variables."""
    own = {"error", "method", "status", "known_until"}
    final = {"theta", "w1", "w2", "w3", "slip_along", "slip_across", "rim", "n1", "n2", "n3"} & {*found}
    states = {"states"} if "t" in found.dims else {"final"}
    return tuple((states if final else set()) | ({*found} - own - final))


def same(found, expected):
    return all(np.array_equal(found[name], expected[name], equal_nan=True) for name in expected.data_vars)


@pytest.mark.parametrize("job", JOBS, ids=lambda job: job.__name__)
def test_a_row_of_a_store_is_rolled_again_with_the_same_bits(tmp_path, job):
    sweep = job()
    quietly(sc.sweep.save, sweep, tmp_path / "a.zarr")
    stored = xr.open_zarr(tmp_path / "a.zarr").load()
    assert not {*_inputs._UNITS} & {*stored.data_vars} and "start_w3" in stored.coords
    for one in RNG.choice(stored.sizes["motion"], 3, replace=False):
        row = stored.isel(motion=int(one))
        try:
            given = sc.sweep.inputs(row)
        except ValueError:  # a single state that is none
            assert row["status"] == sc.sweep.Status.INVALID
            continue
        assert same(quietly(sc.sweep.roll, **given, want=wants(stored)), row), f"row {one}"
    some = stored.isel(motion=RNG.choice(stored.sizes["motion"], 7, replace=False))
    assert same(quietly(sc.sweep.roll, **sc.sweep.inputs(some), want=wants(stored)), some)
    assert np.isfinite(some["error"]).any(), "some of them are motions"


def test_coordinates_lie_along_the_dimensions_of_what_varies_and_numbers_along_none(tmp_path):
    ell = xr.DataArray(da.from_array(evenly(0.5, 3, 8), chunks=4), dims="shape")
    theta = xr.DataArray(da.from_array(evenly(0.3, 1.2, 6), chunks=2), dims="lean")
    mu = xr.DataArray(np.array([0.1, 0.2, 0.3]), dims="table")
    law = loss.RollingResistance(1e-3)
    sweep = sc.sweep.roll(
        sc.Body.solid(ell), sc.State(theta, 0.5, 0.1, 2.0), 1.0, contact=sc.Coulomb(mu), losses=law
    )
    assert sweep["theta"].sizes == {"shape": 8, "lean": 6, "table": 3}
    stored = sc.sweep.save(sweep, tmp_path / "a.zarr")
    dims = {name: stored[name].dims for name in _inputs._UNITS if name in stored.coords}
    assert dims == {
        "body_ell": ("shape",), "body_bore": (), "body_fillet": (), "start_theta": ("lean",), "start_w1": (), "start_w2": (),
        "start_w3": (), "contact_mu": ("table",), "contact_patch": (), "loss_delta": (),
    }  # fmt: skip
    assert np.array_equal(stored["body_ell"], ell) and np.array_equal(stored["contact_mu"], mu)
    told = {
        name: stored[name].attrs["units"] for name in ("body_ell", "start_theta", "start_w1", "contact_mu")
    }
    assert told == {"body_ell": "R", "start_theta": "rad", "start_w1": "sqrt(g/R)", "contact_mu": "1"}
    # a chunk of a coordinate is written once, by the first block that has it
    marks = {p.name: p.read_text() for p in (tmp_path / "a.zarr.sweep").glob("shape-*")}
    assert len(marks) == 6 and {name for name, text in marks.items() if "body_ell" in text} == {
        "shape-0_lean-0_table-0", "shape-4_lean-0_table-0",
    }  # fmt: skip
    again = sc.sweep.roll(**sc.sweep.inputs(stored.load())).transpose(*stored["theta"].dims)
    assert same(again, stored)


def test_a_chunk_of_a_coordinate_that_is_lost_is_written_again(tmp_path):
    sweep, store = slipping(), tmp_path / "a.zarr"
    whole = quietly(sc.sweep.save, sweep, store).load()
    for damage in ("gone", "torn"):
        chunk = store / "start_w1" / "c" / "1"
        chunk.unlink() if damage == "gone" else chunk.write_bytes(chunk.read_bytes()[:9])
        with pytest.warns(UserWarning, match="1 of 3 blocks are missing or damaged"):
            again = sc.sweep.save(sweep, store)
        assert again.load().identical(whole)


def test_the_coordinates_of_a_thousand_million_starts_are_left_to_the_blocks():
    ell = da.linspace(0.5, 3, 10**9, chunks=10**7)
    sweep = sc.sweep.roll(sc.Body.solid(ell), sc.State(1.3, 0.5, ell, 2.0), 1.0, want="end")
    files = _save._layout(sweep, _save._record(sweep))
    assert not [name for name in files if name.startswith(("body_ell/c", "start_w2/c"))]
    assert sum(map(len, files.values())) < 30_000


def test_starts_in_blocks_of_other_sizes_are_saved_in_those_of_the_sweep(tmp_path):
    ell, theta = evenly(0.5, 3, 40), evenly(0.3, 1.2, 40)
    body, state = (
        sc.Body.solid(da.from_array(ell, chunks=20)),
        sc.State(da.from_array(theta, chunks=10), 0.5, 0.1, 2.0),
    )
    stored = sc.sweep.save(sc.sweep.roll(body, state, 1.0, want="end"), tmp_path / "a.zarr")
    assert np.array_equal(stored["body_ell"], ell) and np.array_equal(stored["start_theta"], theta)


def test_a_coordinate_that_nobody_wants_is_dropped_before():
    sweep = rolling()
    assert sweep.nbytes > sweep.reset_coords(drop=True).nbytes
    assert not sweep.reset_coords(drop=True).coords


def test_inputs_of_one_value_are_numbers_and_broadcast_ones_vary_along_their_own_axis():
    ell, theta = np.meshgrid(evenly(0.5, 3, 4), evenly(0.3, 1.2, 3), indexing="ij")
    found = sc.sweep.roll(
        sc.Body.solid(ell), sc.State(theta, np.full((4, 3), 0.5), 0.1, 2.0), 1.0, want="end"
    )
    dims = {name: found[name].dims for name in ("body_ell", "start_theta", "start_w1")}
    assert dims == {"body_ell": ("motion_0",), "start_theta": ("motion_1",), "start_w1": ()}
    assert found["start_w1"] == 0.5
    zeros = sc.sweep.roll(sc.Body.solid(1.0), sc.State(1.3, 0.5, [0.0, -0.0], 2.0), 1.0, want="end")
    assert zeros["start_w2"].dims == ("motion",), "two zeros, of different bits"


@pytest.mark.parametrize("wrap", [np.asarray, lazy])
def test_the_axes_of_a_result_stand_as_numpy_broadcasts_them(wrap):
    body = sc.Body.solid(2.5)
    state = body.steady(wrap(np.array([1.2, 1.3, 1.4]))).kicked(0.05)
    found = sc.sweep.roll(body, state, [0.5, 1.0], contact=sc.Coulomb(wrap(np.array([0.1, 0.2])[:, None])))
    assert found["theta"].dims == ("motion_0", "motion_1", "t") and found["error"].shape == (2, 3)
    for i, mu in enumerate((0.1, 0.2)):
        row = sc.sweep.roll(
            body, body.steady(np.array([1.2, 1.3, 1.4])).kicked(0.05), [0.5, 1.0], contact=sc.Coulomb(mu)
        )
        assert np.array_equal(found["w3"][i], row["w3"])


def test_a_sweep_from_where_another_ended_has_its_own_starts():
    body = sc.Body.solid(xr.DataArray([1.0, 2.0], dims="shape"))
    first = sc.sweep.roll(body, body.steady(1.3).kicked(0.05), 1.0, losses=loss.AirLinear(1e-3))
    on = sc.State(*(first[name] for name in ("theta", "w1", "w2", "w3")))
    then = sc.sweep.roll(body, on, 1.0)
    assert np.array_equal(then["start_theta"], first["theta"]) and "loss_b" not in then.coords


def test_inputs_named_like_a_result_are_refused_before_any_work():
    body, theta = sc.Body.solid(2.5), xr.DataArray([1.2, 1.3], dims="theta", coords={"theta": [1.2, 1.3]})
    for lean in (theta, theta.drop_vars("theta")):
        with pytest.raises(ValueError, match=r"'theta' is a coordinate .*rename\(theta='theta_start'\)"):
            sc.sweep.roll(body, body.steady(lean), 1.0)
        assert sc.sweep.roll(body, body.steady(lean), 1.0, want="end")["end"].dims == ("theta",)
    renamed = theta.rename(theta="theta_start")
    assert sc.sweep.roll(body, body.steady(renamed), 1.0)["theta"].dims == ("theta_start",)


def test_what_is_no_sweep_has_no_inputs():
    with pytest.raises(TypeError, match="^rows: expected a Dataset, not dict"):
        sc.sweep.inputs({})
    found = sc.sweep.roll(sc.Body.solid(2.5), sc.State(1.3, 1, 0, 1), 1.0)
    for lacks in (found.drop_vars("start_w3"), found.drop_vars("body_ell"), found.drop_attrs()):
        with pytest.raises(ValueError, match="^rows: expected a result of sweep.roll, but '"):
            sc.sweep.inputs(lacks)


@pytest.mark.parametrize("name", CODES["Law"])
def test_the_unit_of_a_coefficient_is_what_from_si_divides_by(name):
    scale, kind = sc.Scale(0.03, 0.2, 9.0), getattr(loss, name)
    text = LAWS[dataclasses.fields(kind)[0].name].natural.replace("^", "**").replace(" ", "*")
    unit = eval(text, {"M": 0.2, "R": 0.03, "g": 9.0, "sqrt": np.sqrt})
    # of a boundary layer `from_si` takes a number C, and the power is C sqrt(density viscosity) R^4 |psi'|^(5/2)
    si, given = (
        (np.sqrt(1.2 * 1.8e-5) * 0.03**4, 1.0) if name == "BoundaryLayer" else (1e-5 * unit, 1e-5 * unit)
    )
    assert kind.from_si(given, scale=scale).coefficient * unit == pytest.approx(si, rel=1e-12)
