"""Dense maps from Python."""

import _thread
import threading
import time

import numpy as np
import nutating_cylinder
import pytest

import spincyl as sc
from spincyl._input.threads import thread_count

THETA, ELL = np.linspace(-0.1, 1.7, 61), np.linspace(-0.1, 3, 43)


def same(a, b):
    return np.array_equal(np.asarray(a), np.asarray(b), equal_nan=True)


@pytest.mark.parametrize("fillet", [0.0, 0.3])
def test_a_map_has_the_values_of_the_methods_bit_by_bit(fillet):
    data = sc.sweep.portrait(THETA, ELL, 0.4, fillet)
    family = sc.Body.tube(ELL, 0.4, fillet=fillet)
    assert same(data["rate"], family.rate(THETA[:, None]))
    assert same(data["kappa_rolling"], family.stability(THETA[:, None]))
    assert same(data["kappa_smooth"], family.stability(THETA[:, None], "smooth"))
    assert same(data["region"], family.region(THETA[:, None]))
    assert data["region"].dtype == np.uint8 and data["region"].values[0, 0] == sc.Region.INVALID
    assert data["rate"].dims == ("theta", "ell") and data["theta"].attrs["units"] == "rad"


def test_a_rate_in_single_precision_is_that_of_doubles_to_one_and_a_half_ulp():
    theta, ell = np.linspace(0.001, 1.57, 1301), np.linspace(0.0, 3, 1203)
    single = sc.sweep.portrait(theta, ell, 0.4, want="rate", dtype="float32")["rate"]
    double = sc.sweep.portrait(theta, ell, 0.4, want="rate")["rate"]
    assert single.dtype == np.float32 and same(np.isnan(single), np.isnan(double))
    off = np.nanmax(np.abs(single.astype(float) / double - 1)) * 2**24
    assert 1.2 < off < 1.51
    points = sc.sweep.points(theta[:, None], ell, 0.4, dtype="float32", threads=2)["rate"]
    assert same(single, points)


def test_one_length_of_many_bores_is_a_family_of_rates():
    many = sc.Body.tube(2.5, np.array([0.0, 0.5]))
    assert same(many.rate(1.3), [sc.Body.tube(2.5, bore).rate(1.3) for bore in (0.0, 0.5)])


def test_numbers_make_no_dimension_and_bores_make_one():
    data = sc.sweep.portrait(THETA, 2.5, [0.0, 0.5, 1.0], want=["rate"])
    assert data["rate"].dims == ("theta", "bore") and list(data) == ["rate"]
    assert same(data["rate"].sel(bore=0.5), sc.Body.tube(2.5, 0.5).rate(THETA))
    one = sc.sweep.portrait(1.3, 2.5)
    assert one["rate"].dims == () and float(one["rate"]) == sc.Body.solid(2.5).rate(1.3)
    assert sc.sweep.portrait([], ELL)["rate"].shape == (0, 43)


@pytest.mark.parametrize("threads", [1, 2, 3, 7])
def test_c4_the_bits_do_not_depend_on_the_threads(threads):
    theta = np.linspace(0.001, 1.57, 500)
    expected = sc.sweep.portrait(theta, ELL, threads=1)
    assert sc.sweep.portrait(theta, ELL, threads=threads).identical(expected)


def test_an_earlier_result_is_filled_again():
    first = sc.sweep.portrait(THETA, ELL)
    kept = first["rate"].to_numpy()
    expected = sc.sweep.portrait(THETA, ELL + 0.1)
    again = sc.sweep.portrait(THETA, ELL + 0.1, out=first)
    assert again["rate"].to_numpy().base is kept.base and same(again["rate"], expected["rate"])
    with pytest.raises(ValueError, match=r"out\['rate'\]: expected"):
        sc.sweep.portrait(THETA[1:], ELL, out=first)


def unaligned(values):
    """The same numbers at an odd address, as from a file or a network."""
    return np.frombuffer(b"!" + np.asarray(values, np.float64).tobytes(), offset=1)


def test_a3_arrays_at_any_address_have_the_bits_of_a_copy():
    theta, ell, times = np.linspace(0.01, 1.57, 61), np.linspace(0.1, 3, 43), np.linspace(0, 5, 9)
    odd = unaligned(theta)
    assert not odd.flags.aligned and same(odd, theta)
    assert sc.sweep.portrait(odd, unaligned(ell)).identical(sc.sweep.portrait(theta, ell))
    assert same(sc.sweep.points(odd, 2.5)["rate"], sc.sweep.points(theta, 2.5)["rate"])
    assert sc.sweep.survey(odd, unaligned(ell)) == sc.sweep.survey(theta, ell)
    assert sc.sweep.boundaries(unaligned(ell)).identical(sc.sweep.boundaries(ell))
    body, state = nutating_cylinder.body, nutating_cylinder.start
    assert same(sc.roll(body, state, unaligned(times)).y, sc.roll(body, state, times).y)
    many, spread = sc.Body.solid(unaligned(ell)), sc.State(1.3, unaligned(0.1 * ell), 0.05, 1.0)
    found = sc.sweep.roll(many, spread, unaligned(times))
    assert found.identical(sc.sweep.roll(sc.Body.solid(ell), sc.State(1.3, 0.1 * ell, 0.05, 1.0), times))
    out = {"rate": np.frombuffer(bytearray(8 * 61 + 1), offset=1)}
    with pytest.raises(ValueError, match=r"out\['rate'\]: .* not contiguous and aligned"):
        sc.sweep.points(theta, 2.5, out=out)


def test_a6_what_is_masked_is_nan_on_an_axis_and_no_time():
    theta = np.ma.masked_greater(np.linspace(0.1, 1.5, 5), 1.0)
    found = sc.sweep.portrait(theta, 2.5, want="region")["region"]
    assert same(found == sc.Region.INVALID, theta.mask)
    body = sc.Body.solid(2.5)
    with pytest.raises(ValueError, match="t = NaN"):
        sc.roll(body, body.steady(1.3), theta)


def test_mistakes_are_named():
    with pytest.raises(ValueError, match=r"want = 'speed': expected some of"):
        sc.sweep.portrait(THETA, ELL, want=["speed"])
    with pytest.raises(ValueError, match="theta: expected a number or a one-dimensional array"):
        sc.sweep.portrait(np.ones((2, 2)), ELL)
    for threads in (0, -1, 10**6):
        with pytest.raises(ValueError, match="threads"):
            sc.sweep.portrait(THETA, ELL, threads=threads)


def test_the_environment_sets_the_threads(monkeypatch):
    monkeypatch.setenv("RAYON_NUM_THREADS", "3")
    assert thread_count(None) == 3
    monkeypatch.setenv("RAYON_NUM_THREADS", "many")
    with pytest.raises(ValueError, match="many"):
        thread_count(None)


def test_c1_c2_a_long_map_lets_other_threads_run_and_obeys_ctrl_c():
    theta, ell = np.linspace(0.01, 1.57, 8000), np.linspace(0, 3, 4000)
    sc.sweep.portrait(THETA, ELL)  # import everything before the interrupt
    begun, shares, ticks = threading.Event(), [], []

    def told(share):
        shares.append(share)
        if 0 < share < 0.5:
            begun.set()

    def interrupt():
        begun.wait()
        while len(ticks) < 4:  # it runs while the map is made
            ticks.append(len(shares))
            time.sleep(0.001)
        _thread.interrupt_main()

    breaker = threading.Thread(target=interrupt)
    with pytest.raises(KeyboardInterrupt):
        breaker.start()
        while True:  # a busy machine may let a map pass before the thread runs
            shares.clear()
            sc.sweep.portrait(theta, ell, progress=told)
    breaker.join()
    assert shares[-1] < 1.0, "the map was not finished first"
    assert sc.sweep.portrait(THETA, ELL)["rate"].shape == (61, 43)
