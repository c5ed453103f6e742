"""`Body` in Python: arrays, types and mistakes (rows A of docs/hard-cases.md)."""

import copy
import dataclasses
import pickle
import subprocess
import sys
import threading
from datetime import datetime
from decimal import Decimal

import dask
import dask.array as da
import numpy as np
import pandas as pd
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

import spincyl as sc
from spincyl import Region

ELEMENTWISE = ["rate", "region", "stability", "stable", "count", "nutation", "growth_rate"]
ANY_FLOAT = st.floats(allow_nan=True, allow_infinity=True, allow_subnormal=True)


@pytest.fixture
def body():
    return sc.Body.solid(2.5)


def same(a, b):
    return np.array_equal(np.asarray(a), np.asarray(b), equal_nan=True)


@given(theta=ANY_FLOAT, ell=ANY_FLOAT, bore=ANY_FLOAT)
def test_a1_whatever_the_numbers_an_array_is_answered_or_flagged(theta, ell, bore):
    family = sc.Body.tube(np.array([ell]), np.array([bore]))
    if np.pi < abs(theta) < np.inf:
        with pytest.raises(ValueError, match=r"theta = .*\(radians\)"):
            family.rate(theta)
        return
    rate, region = family.rate(theta), family.region(theta)
    assert np.isnan(rate[0]) == (region[0] < Region.UNSTABLE)
    assert not np.isinf(rate[0])
    if not (0 <= ell <= 1e150 and 0 <= bore <= 1 and 0 < theta <= np.pi / 2):
        assert region[0] == Region.INVALID


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, -1.0, -5e-324, 1e160])
def test_a1_a_single_number_that_makes_no_body_is_refused_by_name_and_range(bad):
    for make in (sc.Body.solid, lambda x: sc.Body.tube(x, 0.5), lambda x: sc.Body(x, 1.0, 1.0)):
        with pytest.raises(ValueError, match="ell = .*0 <= ell <= 1e150"):
            make(bad)
    with pytest.raises(ValueError, match="bore = .*0 <= bore <= 1"):
        sc.Body.tube(1.0, bad)
    with pytest.raises(ValueError, match="theta = .*0 < theta <= pi/2"):
        sc.Body.solid(1.0).steady(bad)
    with pytest.raises(ValueError, match="radius = "):
        sc.Scale(bad)
    assert sc.Body.solid(-0.0).ell == 0 and sc.Body.solid(5e-324).rate(1.0) > 0


def test_a1_moments_of_no_body_name_the_inequality():
    with pytest.raises(ValueError, match=r"i3 = 0.5, i1 = 0.2: expected i3 <= 2 i1, as for every real body"):
        sc.Body(ell=1.0, i1=0.2, i3=0.5)
    with pytest.raises(ValueError, match="expected .* for a tube of this bore"):
        sc.Body(ell=1.0, i1=0.7, i3=0.5, bore=0.5)
    with pytest.raises(ValueError, match="inner_diameter"):
        sc.Body.from_metres(outer_diameter=1.0, inner_diameter=2.0, length=1.0)
    family = sc.Body(ell=np.array([1.0, 1.0]), i1=np.array([0.2, 0.5]), i3=0.5)
    assert same(family.region(1.0), [Region.INVALID, family.region(1.0)[1]])
    assert same(np.isnan(family.i1), [True, False])


def test_a1_a_bore_or_moments_that_contradict_are_refused_also_in_a_family():
    with pytest.raises(ValueError, match="bore = -1.0"):
        sc.Body.critical_aspect(-1.0)
    assert same(np.isnan(sc.Body.critical_aspect([-1.0, 0.0])), [True, False])
    with pytest.raises(ValueError, match="i1 = .*: expected .* for a tube of this bore"):
        sc.Body(ell=np.array([1.0, 2.0]), i1=np.array([0.5, 5.0]), i3=0.5, bore=0.0)
    with pytest.raises(TypeError, match=r"radius: expected a number, not an array of shape \(2,\)"):
        sc.Scale([1.0, 2.0])


def test_a1_forbidden_inclinations_say_so(body):
    with pytest.raises(ValueError, match="forbidden: no steady state between theta_balance = 0.38"):
        body.steady(0.8)
    assert same(np.isnan(body.steady(np.array([0.2, 0.8])).w1), [False, True])
    with pytest.raises(ValueError, match="precession"):
        body.circular(1.0, 0.0)
    with pytest.raises(ValueError, match="expected 'rolling' or 'smooth'"):
        body.stability(1.0, "sticky")
    with pytest.raises(ValueError, match="expected 'rolling' or 'smooth'"):
        body.boundaries("sticky")


@pytest.mark.parametrize(
    "bad",
    ["1.0", b"1", None, 1j, np.array([1 + 0j]), Decimal(1), datetime(2019, 2, 1), [1.0, "a"], [[1.0], [1.0, 2.0]],
     np.array([1.0], object), np.array(["2019"], "datetime64[Y]"), {"a": 1}, pd.Series(["a"]), 10**400,
     np.longdouble(1)],
)  # fmt: skip
def test_a2_what_is_no_real_number_is_a_type_error_naming_the_argument(body, bad):
    for name in ELEMENTWISE:
        with pytest.raises(
            TypeError, match=r"^(theta|rate|at)(: expected real numbers|, hertz: give exactly one)"
        ):
            getattr(body, name)(bad)
    for name, call in {
        "ell": sc.Body.solid,
        "bore": lambda x: sc.Body.tube(1.0, x),
        "i1": lambda x: sc.Body(1.0, x, 1.0),
        "theta": body.steady,
        "precession": lambda x: body.circular(1.0, x),
        "rate": body.inclinations,
        "w2": lambda x: sc.State(1.0, 1.0, x, 1.0),
        "thetadot": lambda x: body.steady(1.3).kicked(x),
        "length": lambda x: sc.Scale(1.0).metres(x),
        "radius": sc.Scale,
        "mass": lambda x: sc.Scale(1.0, x),
        "outer_diameter": lambda x: sc.Body.from_metres(outer_diameter=x, length=1.0),
    }.items():
        with pytest.raises(TypeError, match=rf"^{name}\b"):
            call(bad)
    with pytest.raises(TypeError, match="^theta: "):
        sc.sweep.portrait(bad, 1.0)


@pytest.mark.parametrize("name", [*ELEMENTWISE, "inclinations"])
def test_a3_every_layout_gives_the_bits_of_a_contiguous_copy(body, name):
    law = getattr(body, name)
    theta = np.linspace(0.05, 1.5, 24)
    expected = law(theta)
    packed = np.zeros(24, [("pad", "u1"), ("x", "f8")])
    packed["x"] = theta
    read_only = theta.copy()
    read_only.flags.writeable = False
    for other in (
        theta[::-1][::-1],
        theta.astype(">f8"),
        packed["x"],
        read_only,
        list(theta),
        np.repeat(theta, 2)[::2],
    ):
        assert same(law(other), expected)
    assert same(law(theta[::-1]), expected[::-1])
    square = theta.reshape(4, 6)
    assert same(law(np.asfortranarray(square)), expected.reshape((4, 6, *expected.shape[1:])))
    assert same(law(np.broadcast_to(1.3, (3, 2))), np.broadcast_to(law(1.3), (3, 2, *np.shape(law(1.3)))))
    single = theta.astype(np.float32)
    assert same(law(single), law(single.astype(float)))
    assert law(np.empty((0, 3))).shape[:2] == (0, 3)
    assert same(law(1), law(1.0))
    assert same(law(np.array(1)), law(1.0)) and np.ndim(law(np.array(1.3))) == np.ndim(law(1.3))


def test_a3_a_family_and_its_members_have_the_same_bits():
    ell, theta = np.linspace(0, 3, 41), np.linspace(0.01, 1.57, 37)
    family = sc.Body.tube(ell, 0.3)
    for name in ELEMENTWISE:
        table = getattr(family, name)(theta[:, None])
        assert table.shape == (37, 41)
        for j in (0, 7, 40):
            assert same(table[:, j], getattr(sc.Body.tube(ell[j], 0.3), name)(theta))
    for name in ("folds", "ridge", "boundaries"):
        table = getattr(family, name)()
        assert table.shape == (41, 3)
        assert all(same(table[j], getattr(sc.Body.tube(ell[j], 0.3), name)()) for j in (0, 7, 40))
    state = family.states(1.2)
    assert state.theta.shape == (41, 3) and same(state.theta, family.inclinations(1.2))
    assert np.nanmax(np.abs(sc.Body.tube(ell[:, None], 0.3).energy(state))) < 100


def test_a3_a_family_of_balls_has_the_bits_of_its_members_and_nan_where_no_ball_is():
    offset, i1, theta = np.linspace(-0.4, 0.3, 15), np.array([0.39, 0.4, 0.43])[:, None], 1.2
    family = sc.Body.ball(offset, i1, 0.4)
    spin, rate = family.standing_spin(), family.rate(theta)
    assert spin.shape == rate.shape == (3, 15)
    for i, j in ((0, 0), (1, 7), (2, 14)):
        one = sc.Body.ball(float(offset[j]), float(i1[i, 0]), 0.4)
        assert same(spin[i, j], one.standing_spin()) and same(rate[i, j], one.rate(theta))
    assert same(sc.Body.ball([-1.0, 0.0], 0.4, 0.4).region(theta) == Region.INVALID, [True, False])
    assert sc.Body.ball(offset, 0.4, 0.4, diameter="57.2mm").scale.radius == 28.6e-3
    with pytest.raises(ValueError, match=r"offset \(2,\), i1 \(3,\)"):
        sc.Body.ball(np.zeros(2), np.full(3, 0.4), 0.4)


def test_a4_shapes_that_do_not_fit_are_named(body):
    with pytest.raises(ValueError, match=r"\(2,\).*\(3,\)"):
        sc.Body.solid(np.ones(3)).rate(np.ones(2))


def test_a5_out_is_filled_or_refused_untouched(body):
    theta = np.linspace(0.05, 1.5, 10)
    out = np.full(10, -1.0)
    assert body.rate(theta, out=out) is out and same(out, body.rate(theta))
    masked = np.full(10, -1.0)
    body.rate(theta, out=masked, where=theta > 0.7)
    assert same(masked, np.where(theta > 0.7, body.rate(theta), -1.0))
    single = np.full(10, -1.0, np.float32)
    assert same(
        body.rate(theta, out=single), body.rate(theta).astype(np.float32)
    )  # NumPy's rule: "same kind"
    for bad, error in ((np.full(9, -1.0), ValueError), (np.full(10, -1, int), TypeError)):
        with pytest.raises(error):
            body.rate(theta, out=bad)
        assert (bad == -1).all()
    out.flags.writeable = False
    with pytest.raises(ValueError, match="read-only"):
        body.rate(theta, out=out)
    shared = np.linspace(0.05, 1.5, 11)
    expected = body.rate(shared[:-1])
    body.rate(shared[:-1], out=shared[1:])
    assert same(shared[1:], expected)


def test_a6_pandas_and_masked_arrays_keep_index_and_mask(body):
    series = pd.Series([0.1, 1.3], index=["a", "b"])
    assert isinstance(body.rate(series), pd.Series) and list(body.rate(series).index) == ["a", "b"]
    masked = np.ma.masked_array([0.1, 1.3, 1.2], mask=[False, True, False])
    rate = body.rate(masked)
    assert same(np.ma.getmaskarray(rate), [False, True, False])
    assert same(rate.compressed(), body.rate(np.array([0.1, 1.2])))
    assert same(body.inclinations(pd.Series([0.5, 1.5])), body.inclinations([0.5, 1.5]))


def test_a6_xarray_keeps_its_names_and_dask_stays_lazy(body):
    theta = xr.DataArray(np.linspace(0.1, 1.5, 6), dims="theta")
    ell = xr.DataArray([0.5, 2.5], dims="ell")
    rate = sc.Body.solid(ell).rate(theta)
    assert set(rate.dims) == {"theta", "ell"}
    assert same(rate.sel(ell=1), body.rate(theta.values))
    thetas = body.inclinations(xr.DataArray([0.5, 1.5], dims="rate"))
    assert thetas.dims == ("rate", "root") and same(thetas, body.inclinations([0.5, 1.5]))
    family = sc.Body.solid(ell)
    assert family.folds().dims == ("ell", "root")
    assert same(family.inclinations(1.5)[1], body.inclinations(1.5))
    assert family.states(theta).w1.dims == ("theta", "ell", "root")
    lazy = body.rate(da.from_array(theta.values, chunks=3))
    assert isinstance(lazy, da.Array) and same(lazy.compute(), body.rate(theta.values))
    assert same(
        body.inclinations(da.from_array([0.5, 1.5], chunks=1)).compute(), body.inclinations([0.5, 1.5])
    )
    with dask.config.set(scheduler="processes"):
        assert same(lazy.compute(), body.rate(theta.values))
    both = body.rate(theta.chunk(theta=2))
    assert both.chunks is not None and same(both.compute(), body.rate(theta.values))


def test_a6_memmap_is_an_array(body, tmp_path):
    file = np.memmap(tmp_path / "theta", np.float64, "w+", shape=5)
    file[:] = np.linspace(0.1, 1.5, 5)
    assert same(body.rate(file), body.rate(np.array(file)))


@pytest.mark.long
def test_a7_two_to_the_31_elements_are_counted(body):
    # input of stride 0: the 2 GiB of codes are the only large array
    codes = body.region(np.broadcast_to(1.3, 2**31 + 9))
    assert codes.size == 2**31 + 9
    assert codes[0] == codes[2**31 - 1] == codes[2**31] == codes[-1] == Region.STABLE


def test_a8_too_little_memory_is_a_memory_error(body):
    with pytest.raises(MemoryError):
        body.rate(np.broadcast_to(1.3, 2**59))
    with pytest.raises(MemoryError):
        sc.sweep.portrait(np.broadcast_to(1.3, 2**20), np.linspace(0, 3, 2**20), np.linspace(0, 1, 2**17))
    assert body.rate(1.3) > 1


@pytest.mark.parametrize(
    "value",
    [
        sc.Body.solid(2.5),
        sc.Body.tube(6.0, 0.8),
        sc.Body(1.2, 0.7, 0.5),
        sc.Body.solid(0.1).steady(0.3),
        sc.Scale(0.1),
    ],
)
def test_a9_pickle_copy_and_repr_give_the_same_back(value):
    assert pickle.loads(pickle.dumps(value)) == value == copy.deepcopy(value)
    names = {"Body": sc.Body, "State": sc.State, "Scale": sc.Scale, "np": np}
    assert eval(repr(value), names) == value


def test_a9_families_compare_hash_and_pickle():
    one, two = sc.Body.solid(np.array([1.0, np.nan])), sc.Body.solid(np.array([1.0, np.nan]))
    assert one == two and hash(one) == hash(two) and one != sc.Body.solid(1.0) and one != "a body"
    assert pickle.loads(pickle.dumps(one)) == one
    for a, b in (([1, 2], [1.0, 2.0]), (-0.0, 0.0), ([-0.0, 1.0], [0.0, 1.0])):
        assert sc.Body.solid(a) == sc.Body.solid(b)
        assert hash(sc.Body.solid(a)) == hash(sc.Body.solid(b))
    assert pickle.loads(pickle.dumps(sc._core.rate)) is sc._core.rate


def test_a9_a_hundred_thousand_calls_leave_no_memory_behind():
    import resource

    def peak():
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    body, theta = sc.Body.solid(2.5), np.linspace(0.1, 1.5, 50)
    for _ in range(1000):
        body.rate(theta), body.steady(1.3)
    before = peak()
    for _ in range(100_000):
        body.rate(theta)
    for _ in range(20_000):
        body.steady(1.3), body.inclinations(1.2), sc.Body.solid(1.0)
    assert peak() - before < 8 * 1024 * (1 if sys.platform != "darwin" else 1024)


def test_nan_is_an_answer_and_raises_no_warning(body):
    with np.errstate(all="raise"):
        assert np.isnan(body.rate([0.8, 3.0, -1.0])).all()
        assert (
            np.isnan(body.stability([0.8])).all() and np.isnan(body.steady(np.array([0.8])).precession).all()
        )
        body.inclinations([0.1, np.nan, np.inf])
        body.folds(), body.region([0.8])


ANGLES = {
    "rate": lambda body, x: body.rate(x),
    "region": lambda body, x: body.region(x),
    "stability": lambda body, x: body.stability(x),
    "stable": lambda body, x: body.stable(x),
    "nutation": lambda body, x: body.nutation(x),
    "growth": lambda body, x: body.growth_rate(x),
    "painleve": lambda body, x: body.painleve(x),
    "steady": lambda body, x: body.steady(x).w1,
    "circular": lambda body, x: body.circular(x, 1.0).w1,
    "State": lambda body, x: body.energy(sc.State(x, 1.0, 0.0, 1.0)),
    "hertz": lambda body, x: dataclasses.replace(body, scale=sc.Scale(0.01)).hertz(x),
    "pressed": lambda body, x: sc.pressed(body, 9.0, x).w1,
    "drift": lambda body, x: sc.drift(body, x, sc.loss.DryContour(1e-4)).stops_at,
    "points": lambda body, x: sc.sweep.points(x, body.ell)["rate"],
    "portrait": lambda body, x: sc.sweep.portrait(x, body.ell)["rate"].values,
}


AS_DEGREES = r"-?[0-9]+ degrees are np.radians\(-?[0-9]+\) or '-?[0-9]+deg'$"


@pytest.mark.parametrize("ask", ANGLES.values(), ids=ANGLES)
@pytest.mark.parametrize("degrees", [85, 85.0, np.float64(-85.0), np.array(200)])
def test_a_number_that_looks_like_degrees_is_refused_everywhere_in_the_same_words(ask, degrees):
    body = sc.Body.solid(2.5)
    with pytest.raises(
        ValueError, match=rf"^(theta|at|angle) = -?[0-9]+\.0: expected .*pi.* \(radians\); {AS_DEGREES}"
    ):
        ask(body, degrees)


@pytest.mark.parametrize("ask", ANGLES.values(), ids=ANGLES)
def test_arrays_in_degrees_are_nan_with_one_warning_at_the_line_that_asks(ask):
    body = sc.Body.solid(2.5)
    right = ask(body, np.array([1.3, 1.4]))
    with pytest.warns(UserWarning, match="= 85 rad is 4870 degrees: are these degrees") as told:
        found = ask(body, np.array([85.0, 1.4]))
    assert len(told) == 1 and told[0].filename == __file__
    nothing = 0 if found.dtype in (bool, np.uint8) else np.nan
    assert np.array_equal(found, [nothing, right[1]], equal_nan=True)


def test_a_right_angle_too_much_is_no_number_in_degrees():
    # beyond the body's range but not by a large factor: there is no steady state, and no suspicion of degrees
    assert np.isnan(sc.Body.solid(2.5).rate(2.0)) and sc.Body.solid(2.5).region(2.0) == Region.INVALID
    assert sc.Body.ball(-0.2, 0.4, 0.4).energy(sc.State(np.pi, 0.0, 0.0, 1.0)) > 0


def test_only_a_steady_state_has_a_kappa(body):
    circle = body.circular(1.2, 1.5)
    assert body.stable(circle, "rolling")
    assert np.isnan(body.stability(circle, "smooth"))
    assert not body.stable(circle, "smooth")
    assert np.isnan(body.stability(sc.State(1.3, 0.2, 0.5, 0.1)))


def test_laws_hold_across_the_bindings(body):
    state = body.steady(1.3)
    assert state.gamma == pytest.approx(body.theta_balance, rel=1e-15)
    assert body.beta(state) == pytest.approx(body.theta_limit, rel=1e-15)
    assert body.speed_o(state) == pytest.approx(0, abs=1e-15)
    assert body.speed_x(state) == pytest.approx(2 * 2.5 * state.w1, rel=1e-15)
    assert body.centre_radius(state) == pytest.approx(0, abs=1e-15)
    assert body.stability(state) == pytest.approx(body.stability(1.3), rel=1e-13)
    assert body.stability(state, "smooth") == pytest.approx(body.stability(1.3, "smooth"), rel=1e-13)
    assert body.angular_momentum(state) == pytest.approx(np.hypot(body.i1 * state.w1, body.i3 * state.w3))
    assert state.angular_velocity == pytest.approx(np.hypot(state.w1, state.w3))
    assert state.spin == pytest.approx((2.5 * np.sin(1.3) - np.cos(1.3)) * state.precession)
    assert state.contact_radius == pytest.approx(2.5 * np.sin(1.3) - np.cos(1.3))
    assert state.kicked(0.05).w2 == -0.05
    circle = body.circular(1.3, 1.5 * state.precession)
    assert body.centre_radius(circle) > 0.01
    assert circle.precession == pytest.approx(1.5 * state.precession)
    both = body.circular(np.array([1.3, 1.3]), np.array([1.0, 1.5]) * state.precession)
    assert body.centre_radius(both)[1] == body.centre_radius(circle)
    assert body.angular_rate(1.5) == pytest.approx(1.5 / np.sqrt(body.i3))
    assert sc.Body.critical_aspect([0.0, 1.0]) == pytest.approx(np.sqrt([0.75, 1.5]))
    hoop = sc.Body.tube(sc.Body.critical_aspect(1.0), 1.0)
    assert hoop.theta_balance == pytest.approx(hoop.theta_limit) and hoop.excess == pytest.approx(
        0, abs=1e-15
    )


def test_a_scale_speaks_metres_seconds_and_hertz():
    scale, pipe = sc.Scale(7.9375e-3, mass=0.02, gravity=9.81), sc.Body.tube(6.0, 0.8)
    unit = np.sqrt(7.9375e-3 / 9.81)
    assert scale.seconds(2.0) == pytest.approx(2 * unit)
    assert scale.hertz(pipe, 1.0) == pytest.approx(1 / np.sqrt(0.82) / unit / (2 * np.pi))
    assert scale.turns(2 * np.pi) == pytest.approx(1 / unit)
    assert scale.joules(1.0) == pytest.approx(0.02 * 9.81 * 7.9375e-3)
    assert scale.metres([1.0, 2.0])[1] == pytest.approx(15.875e-3)
    pvc = sc.Body.from_metres(outer_diameter=15.875e-3, inner_diameter=12.7e-3, length=95.25e-3)
    assert (pvc.ell, pvc.bore) == (pytest.approx(6.0), pytest.approx(0.8))


def test_threads_share_the_functions_and_get_the_same_bits(body):
    theta = np.linspace(0.01, 1.57, 20_001)
    expected, results = body.rate(theta), [None] * 16

    def work(k):
        results[k] = body.rate(theta)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(16)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert all(same(r, expected) for r in results)


def test_i2_the_import_is_light_and_a_missing_extra_is_named():
    code = "import sys, spincyl; print(sorted({'matplotlib', 'xarray', 'dask', 'pandas'} & set(sys.modules)))"
    assert subprocess.check_output([sys.executable, "-c", code], text=True).strip() == "[]"
    code = (
        "import sys; sys.modules['xarray'] = sys.modules['matplotlib'] = None\n"
        "import spincyl as sc\n"
        "for f in (lambda: sc.sweep.portrait([1.0], 1.0), lambda: sc.plot.branches([1.0])):\n"
        "    try: f()\n"
        "    except ImportError as e: print(e)\n"
    )
    said = subprocess.check_output([sys.executable, "-c", code], text=True)
    assert "pip install 'spincyl[sweep]'" in said and "pip install 'spincyl[plot]'" in said
