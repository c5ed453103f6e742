"""Sweeps, maps and drifts of measured bodies: in SI, with the numbers of single bodies."""

import dataclasses

import numpy as np
import pytest
import xarray as xr

import spincyl as sc

TUBE = sc.measured(outer_diameter="15.875mm", inner_diameter="12.7mm", length="95.25mm", mass="20g")
FAMILY = dataclasses.replace(sc.Body.tube(np.linspace(1.0, 6.0, 4), 0.8), scale=TUBE.scale)
START = FAMILY.steady(1.5).kicked(0.01)


def test_many_measured_bodies_move_in_seconds_as_each_does_by_itself():
    times = np.array([0.1, 0.2])
    found = sc.sweep.roll(FAMILY, START, times, want=("states", "period", "normal_min"))
    assert np.array_equal(found["t"], times) and found["t"].attrs["units"] == "s"
    units = {name: found[name].attrs["units"] for name in ("theta", "w3", "period", "normal_min")}
    assert units == {"theta": "rad", "w3": "rad/s", "period": "s", "normal_min": "N"}
    assert found.attrs["t"] == 0.2 and found.attrs["mass"] == 0.02
    for k, ell in enumerate(FAMILY.ell):
        body = dataclasses.replace(sc.Body.tube(ell, 0.8), scale=TUBE.scale)
        start = sc.State(*(float(np.broadcast_to(x, 4)[k]) for x in (1.5, START.w1, START.w2, START.w3)))
        one = sc.roll(body, start, times, t0=0.0, want="force")
        assert found["w3"][k].values == pytest.approx(one.w[:, 2], rel=1e-9)
        assert found["period"][k].item() == pytest.approx(sc.swing(body, start).period, rel=1e-9)
    assert 0 < found["normal_min"].max() < 1.01 * TUBE.scale.newtons(1.0)


def test_heat_of_many_is_joules_and_the_attributes_keep_all_coefficients():
    law = sc.loss.DryContour.from_si("10um", scale=TUBE) + sc.loss.AirLinear.from_si(1e-9, scale=TUBE)
    slips = FAMILY.with_centre_velocity(START, 0.0, 1.0)
    table = sc.Coulomb(0.3, static=0.4)
    found = sc.sweep.roll(
        FAMILY, slips, 0.3, contact=table, want=("dissipated", "end", "work_lost"), losses=law
    )
    plain = sc.sweep.roll(
        FAMILY.natural, slips, 0.3 / TUBE.scale.seconds(1.0), contact=table,
        want=("dissipated", "end", "work_lost"), losses=law,
    )  # fmt: skip
    for name in ("dissipated", "work_lost"):
        assert found[name].values == pytest.approx(TUBE.scale.joules(plain[name].values))
        assert found[name].attrs["units"] == "J" and plain[name].attrs["units"] == "M g R"
    assert found["end"].values == pytest.approx(TUBE.scale.seconds(plain["end"].values))
    assert found.attrs["contact"] == repr(table) and found.attrs["losses"] == repr(law)


def test_without_a_mass_heat_stays_natural_and_times_are_seconds():
    family = dataclasses.replace(FAMILY, scale=sc.Scale(TUBE.scale.radius, np.nan))
    found = sc.sweep.roll(family, START, 0.1, want=("normal_min", "end"))
    assert found["normal_min"].attrs["units"] == "M g" and found["end"].attrs["units"] == "s"


def test_a_lazy_sweep_of_measured_bodies_is_saved_and_gone_on_with(tmp_path):
    array = pytest.importorskip("dask.array")
    ell = array.from_array(np.linspace(1.0, 6.0, 6), chunks=3)
    bodies = dataclasses.replace(sc.Body.tube(ell, 0.8), scale=TUBE.scale)
    lazy = sc.sweep.roll(bodies, bodies.steady(1.5).kicked(0.01), 0.1)
    saved = sc.sweep.save(lazy, tmp_path / "a.zarr")
    whole = dataclasses.replace(sc.Body.tube(np.linspace(1.0, 6.0, 6), 0.8), scale=TUBE.scale)
    plain = sc.sweep.roll(whole, whole.steady(1.5).kicked(0.01), 0.1)
    assert np.array_equal(saved["w3"], plain["w3"]) and saved["w3"].attrs["units"] == "rad/s"
    heavier = dataclasses.replace(bodies, scale=sc.Scale(TUBE.scale.radius, 1.0))
    with pytest.raises(ValueError, match="scale is"):
        sc.sweep.save(sc.sweep.roll(heavier, bodies.steady(1.5).kicked(0.01), 0.1), tmp_path / "a.zarr")


def test_stones_are_swept_in_seconds():
    stone = sc.Ellipsoid.rattleback((0.20, 0.03, 0.02), twist=np.radians(3)).in_metres(mass=0.3)
    start = stone.spinning(np.array([-1.0, -1.2]), pitch=0.01)
    found = sc.sweep.roll(stone, start, 2.0, want=("spin", "end", "final"))
    second = stone.scale.seconds(1.0)
    plain = sc.sweep.roll(stone.natural, start, 2.0 / second, want=("spin", "end", "final"))
    assert found["spin"].values == pytest.approx(plain["spin"].values / second)
    assert found["w3"].attrs["units"] == "rad/s" and found["end"].values == pytest.approx(
        plain["end"].values * second
    )


@pytest.mark.parametrize("bodies", [TUBE, FAMILY], ids=["one", "several"])
def test_a_map_of_measured_tubes_is_in_hertz_and_joules(bodies):
    theta = np.array([0.1, 0.5, 1.4, 1.5])
    want = ("rate", "energy", "kappa_rolling", "region")
    found = sc.sweep.portrait(theta, bodies, want=want)
    each = xr.DataArray(theta, dims="theta")
    ell = xr.DataArray(bodies.ell, dims="ell" if np.ndim(bodies.ell) else ())
    body = dataclasses.replace(sc.Body.tube(ell, 0.8), scale=TUBE.scale)
    assert found["hertz"].dims == each.dims + ell.dims and found["hertz"].attrs["units"] == "Hz"
    assert np.allclose(found["hertz"], body.hertz(each), equal_nan=True)
    assert np.allclose(found["energy"], TUBE.scale.joules(body.energy(body.steady(each))), equal_nan=True)
    unit = TUBE.scale.seconds(1.0) ** -2
    assert np.allclose(found["kappa_rolling"], unit * body.stability(each), equal_nan=True)
    assert np.allclose(found["ell"], TUBE.scale.metres(bodies.ell)) and found["ell"].attrs["units"] == "m"
    assert np.array_equal(found["rate"], sc.sweep.portrait(theta, bodies.natural)["rate"], equal_nan=True)


def test_a_map_takes_tubes_and_no_other_body():
    with pytest.raises(ValueError, match="^ell: expected a tube"):
        sc.sweep.portrait([0.1], sc.Body.balls())
    with pytest.raises(ValueError, match="^ell: expected tubes that differ in only one"):
        sc.sweep.portrait([0.1], sc.Body.tube([1.0, 2.0], [0.1, 0.2]))
    with pytest.raises(TypeError, match="^bore, fillet: leave them out if ell is a Body"):
        sc.sweep.portrait([0.1], TUBE, 0.5)


def test_states_and_coefficients_have_a_way_to_si_and_back():
    state = TUBE.with_centre_velocity(TUBE.steady(1.4), 0.1, 0.2)
    told = state.in_si(TUBE)
    assert told["w1"] == pytest.approx(2 * np.pi * TUBE.scale.turns(state.w1))
    again = sc.State.from_si(**told, scale=TUBE)
    assert again.w3 == pytest.approx(state.w3) and again.slip == pytest.approx(state.slip)
    assert "slip" not in TUBE.steady(1.4).in_si(TUBE.scale)
    for kind, value in (
        (sc.loss.RollingResistance, 1e-4),
        (sc.loss.AirFilm, 1.8e-5),
        (sc.loss.AirQuadratic, 1e-9),
    ):
        law = kind.from_si(value, scale=TUBE)
        assert law.in_si(TUBE) == pytest.approx(value, rel=1e-14)
    assert sc.loss.BoundaryLayer.from_si([0.1, 0.2], scale=TUBE).in_si(TUBE) == pytest.approx([0.1, 0.2])
