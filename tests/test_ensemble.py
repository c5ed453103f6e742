"""Many motions at once, from Python."""

import multiprocessing
import os
import subprocess
import sys
import threading

import dask.array as da
import numpy as np
import pytest
import xarray as xr

import spincyl as sc

ELL = np.linspace(0.9, 3, 500)
BODY = sc.Body.solid(ELL)
START = BODY.steady(1.3).kicked(0.05)


def same(a, b):
    return all(np.array_equal(a[k], b[k], equal_nan=True) for k in b) and set(a) == set(b)


def test_a_sweep_has_the_states_of_single_motions():
    found = sc.sweep.roll(BODY, START, [1.0, 20.0])
    assert found["theta"].dims == ("motion", "t") and found["w1"].attrs["units"] == "sqrt(g/R)"
    for i in range(0, ELL.size, 50):
        alone = sc.roll(sc.Body.solid(ELL[i]), sc.Body.solid(ELL[i]).steady(1.3).kicked(0.05), [0, 1.0, 20.0])
        both = float(found["error"][i]) + alone.error
        got = np.stack([found[k][i] for k in ("theta", "w1", "w2", "w3")])
        assert np.abs(got - alone.y[:, 1:]).max() <= both < 1e-9
    last = sc.sweep.roll(BODY, START, 20.0)
    assert np.array_equal(last["theta"], found["theta"][:, 1]) and last["theta"].dims == ("motion",)


def test_summaries_are_kept_when_asked_for():
    want = (
        *"theta_min theta_max normal_min friction_coefficient_max period precession_per_period end".split(),
    )
    found = sc.sweep.roll(BODY, START, 20.0, want=want)
    assert set(found) == {*want, "error", "method", "status"}
    body = sc.Body.solid(ELL[7])
    start = body.steady(1.3).kicked(0.05)
    swing = sc.swing(body, start)
    for name in ("theta_min", "theta_max", "period", "precession_per_period"):
        assert abs(float(found[name][7]) - getattr(swing, name)) < 1e-9
    m = sc.roll(body, start, np.linspace(0, 20, 4001), want="force")
    assert abs(float(found["normal_min"][7]) - m.normal.min()) < 1e-5
    assert abs(float(found["friction_coefficient_max"][7]) - m.friction_coefficient.max()) < 1e-5


def test_shapes_broadcast_by_rule_and_by_name():
    grid = sc.sweep.roll(sc.Body.solid(ELL[:4, None]), sc.State(1.3, np.linspace(0.5, 1, 5), 0.0, 1.0), 1.0)
    assert grid["theta"].shape == (4, 5) and grid["theta"].dims == ("motion_0", "motion_1")
    named = sc.sweep.roll(
        sc.Body.solid(xr.DataArray(ELL[:4], dims="ell", coords={"ell": ELL[:4]})),
        sc.State(1.3, xr.DataArray(np.linspace(0.5, 1, 5), dims="w1"), 0.0, 1.0),
        1.0,
    )
    assert named["theta"].dims == ("ell", "w1") and "ell" in named.coords
    assert np.array_equal(named["theta"], grid["theta"])
    one = sc.sweep.roll(sc.Body.solid(1.0), sc.Body.solid(1.0).steady(1.3), 20.0)
    assert one["theta"].dims == () and one["status"] == sc.sweep.Status.DONE
    empty = sc.sweep.roll(sc.Body.solid(np.empty(0)), sc.State(1.3, 1.0, 0.0, 1.0), 1.0)
    assert empty["theta"].shape == (0,)
    with pytest.raises(ValueError, match="shapes do not fit: ell .3,."):
        sc.sweep.roll(sc.Body(np.ones(3), 1.0, 0.5), sc.State(1.3, np.ones(4), 0.0, 1.0), 1.0)


def test_mistakes_are_refused_before_any_work():
    for kw, text in [
        ({"t": []}, r"t: expected a number .* final state.* or a one-dimensional array .* shape \(0,\)"),
        ({"t": [[1.0, 2.0]]}, r"t: expected a number .* shape \(1, 2\)"),
        ({"t": [2.0, 1.0]}, "t: expected times that are all >= 0 and ascending"),
        ({"t": [1.0, np.nan]}, "t: expected times that are all >= 0 and ascending"),
        ({"t": np.nan}, "t = nan"),
        ({"t": 1.0, "want": "speed"}, "want = 'speed': expected some of"),
        ({"t": 1.0, "want": "states"}, "want: "),
        ({"t": 1.0, "tol": 0.0}, "tol = 0.0"),
        ({"t": 1.0, "mu": -1.0}, "mu = -1.0"),
        ({"t": 1.0, "step": 0.0}, "step = 0.0"),
        ({"t": 1.0, "threads": 0}, "threads = 0"),
        ({"t": 1.0, "contact": "sticky"}, "contact = 'sticky'"),
    ]:
        with pytest.raises(ValueError, match=text):
            sc.sweep.roll(BODY, START, **kw)
    for kw, text in [
        ({"t": "1"}, "t: expected real"),
        ({"t": 1.0, "progress": 3}, "progress: expected a function"),
        ({"t": 1.0, "beyond": 1}, "beyond: expected True or False"),
        ({"t": 1.0, "threads": 1.5}, "threads: expected a whole number"),
    ]:
        with pytest.raises(TypeError, match=text):
            sc.sweep.roll(BODY, START, **kw)
    with pytest.raises(TypeError, match="bodies: expected a Body, not float"):
        sc.sweep.roll(1.0, START, 1.0)
    with pytest.raises(TypeError, match="states: expected a State"):
        sc.sweep.roll(BODY, 1.3, 1.0)


def test_what_has_no_motion_is_nan_with_a_status():
    found = sc.sweep.roll(BODY, sc.State(np.where(ELL < 1, np.nan, 1.3), START.w1, START.w2, START.w3), 1.0)
    invalid = found["status"] == sc.sweep.Status.INVALID
    assert np.array_equal(invalid, ELL < 1) and np.array_equal(np.isnan(found["theta"]), invalid)
    assert np.array_equal(found["method"] == sc.sweep.Answer.NONE, invalid)


def test_ends_are_told_apart():
    mu = sc.sweep.roll(BODY, START, 20.0, mu=0.05, want=("final", "end"))
    slips = mu["status"] == sc.sweep.Status.SLIP
    assert slips.any() and (mu["end"].values[slips] < 20).all()
    fall = sc.sweep.roll(sc.Body.solid([0.5, 1.0]), sc.State(0.3, 0.0, 0.0, 0.0), 20.0)
    assert (fall["status"] == sc.sweep.Status.FACE).all() and (fall["theta"] == 0).all()


def test_rk4_in_lanes_is_judged_by_the_first_integrals():
    found = sc.sweep.roll(BODY, START, 20.0, step=0.01)
    assert (found["method"] == sc.sweep.Answer.STEP).all() and (found["error"] > 0).all()
    exact = sc.sweep.roll(BODY, START, 20.0)
    off = np.abs(found["theta"] - exact["theta"])
    assert (off <= found["error"]).all() and float(off.max()) > 1e-12
    with pytest.warns(RuntimeWarning, match="are invalid .*: step = 5.0"):
        coarse = sc.sweep.roll(BODY, START.kicked(1.0), 20.0, step=5.0)
    assert (coarse["status"] == sc.sweep.Status.INVALID).all()


def test_progress_is_told_and_what_it_raises_stops_the_sweep():
    told = []
    sc.sweep.roll(BODY, START, 20.0, progress=told.append)
    assert told[-1] == 1.0 and all(0 <= x <= 1 for x in told)

    def angry(share):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        sc.sweep.roll(
            sc.Body.solid(np.resize(ELL, 10**6)), sc.State(1.3, 0.8, 0.05, 1.0), 20.0, progress=angry
        )


def test_c2_a_long_ensemble_obeys_ctrl_c_in_the_middle():
    code = (
        "import os, signal, threading, numpy as np, spincyl as sc\n"
        "body = sc.Body.solid(np.linspace(0.9, 3, 3 * 10**5)); start = body.steady(1.3).kicked(0.05)\n"
        "sc.sweep.roll(body, start, 1.0)\n"
        "for kw in ({}, {'step': 1e-3}, {'want': ('normal_min',)}):\n"
        "    shares, begun = [], threading.Event()\n"
        "    def told(share):\n"
        "        shares.append(share)\n"
        "        if 0 < share < 0.5: begun.set()\n"
        "    def later():\n"
        "        begun.wait(); os.kill(os.getpid(), signal.SIGINT)\n"
        "    breaker = threading.Thread(target=later)\n"
        "    try:\n"
        "        breaker.start()\n"
        "        while True:\n"
        "            shares.clear()\n"
        "            sc.sweep.roll(body, start, 20.0, progress=told, **kw)\n"
        "    except KeyboardInterrupt: print(shares[-1])\n"
        "    breaker.join()\n"
        "assert threading.active_count() <= 2"
    )
    words = [sys.executable, "-c", code]
    found = subprocess.run(words, capture_output=True, text=True, check=True, timeout=500).stdout.split()
    assert len(found) == 3 and all(float(share) < 1 for share in found), found


def _child(queue=None):
    found = sc.sweep.roll(BODY, START, 20.0, threads=2)["theta"].values
    if queue is not None:
        queue.put(found)
    return found


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
def test_c3_a_child_computes_whether_forked_or_spawned():
    expected = _child()
    longest = 500  # seconds: a limit to waiting
    stop = threading.Event()

    def busy():
        while not stop.is_set():
            _child()

    worker = threading.Thread(target=busy)
    worker.start()
    try:
        for kind in ("fork", "spawn"):
            context = multiprocessing.get_context(kind)
            queue = context.Queue()
            process = context.Process(target=_child, args=(queue,))
            process.start()
            assert np.array_equal(queue.get(timeout=longest), expected)
            process.join(longest)
            assert process.exitcode == 0
    finally:
        stop.set()
        worker.join()


def test_c6_many_threads_may_sweep_at_once():
    expected, found = _child(), []
    threads = [threading.Thread(target=lambda: found.append(_child())) for _ in range(16)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 16 and all(np.array_equal(x, expected) for x in found)


def lazy(chunk=50):
    """The same motions as dask arrays."""
    spread = [np.broadcast_to(x, ELL.shape).copy() for x in (START.theta, START.w1, START.w2, START.w3)]
    return sc.Body.solid(da.from_array(ELL, chunks=chunk)), sc.State(
        *(da.from_array(x, chunks=chunk) for x in spread)
    )


def test_dask_backed_motions_stay_lazy_and_have_the_same_bits():
    found = sc.sweep.roll(*lazy(), 20.0, want=("final", "period"))
    assert found.chunksizes == {"motion": (50,) * 10}
    assert same(
        found.compute(scheduler="threads"), sc.sweep.roll(BODY, START, 20.0, want=("final", "period"))
    )
    several = sc.sweep.roll(*lazy(), [1.0, 2.0])
    assert same(several.compute(), sc.sweep.roll(BODY, START, [1.0, 2.0]))


def test_maps_of_any_kind_agree():
    theta, ell, bore = np.linspace(0.01, 1.57, 37), np.linspace(0, 3, 29), np.linspace(0, 1, 5)
    want = ("rate", "kappa_rolling", "kappa_smooth", "energy", "region")
    grid = sc.sweep.portrait(theta, ell, bore, want=want)
    assert grid["energy"].dims == ("theta", "ell", "bore")
    points = sc.sweep.points(theta[:, None, None], ell[:, None], bore, want=want)
    assert all(np.array_equal(points[k], grid[k], equal_nan=True) for k in want)
    part = sc.sweep.portrait(da.from_array(theta, chunks=10), da.from_array(ell, chunks=7), bore, want=want)
    assert part.chunks and same(part.compute(), grid)
    alone = sc.sweep.portrait(da.from_array(theta, chunks=10), 2.5, want="rate")
    assert same(alone.compute(), sc.sweep.portrait(theta, 2.5, want="rate"))
    single = sc.sweep.portrait(theta, ell, bore, want=want, dtype="float32")
    assert single["rate"].dtype == np.float32
    assert all(np.array_equal(single[k], grid[k].astype(single[k].dtype), equal_nan=True) for k in want[1:])
    alone = sc.sweep.portrait(theta, ell, bore, want="rate", dtype="float32")
    assert np.array_equal(single["rate"], alone["rate"], equal_nan=True)
    assert np.allclose(single["rate"], grid["rate"], rtol=1.51 * 2**-24, atol=0, equal_nan=True)
    body, at = sc.Body.tube(ell[:, None], bore), theta[:, None, None]
    state = body.steady(at)
    assert np.allclose(grid["energy"], body.energy(state), rtol=1e-11, equal_nan=True)
    filled = {"rate": np.empty((37, 29, 5))}
    assert sc.sweep.points(at, ell[:, None], bore, out=filled)["rate"].base is not None
    assert np.array_equal(filled["rate"], grid["rate"], equal_nan=True)
    with pytest.raises(ValueError, match=r"shapes do not fit: theta \(2,\), ell \(3,\)"):
        sc.sweep.points([1.0, 1.1], [1.0, 2.0, 3.0])
    with pytest.raises(ValueError, match="dtype = 'int8'"):
        sc.sweep.portrait(theta, ell, dtype="int8")


def test_a_survey_says_what_the_map_would_show():
    theta, ell = np.linspace(0.01, 1.57, 200), np.linspace(0.1, 3, 150)
    grid = sc.sweep.portrait(theta, ell, want=("region", "rate", "energy", "kappa_smooth"))
    told = sc.sweep.survey(theta, ell, want=("region", "rate", "energy", "kappa_smooth"))
    assert all(told["count"][r] == int((grid["region"] == r).sum()) for r in sc.Region)
    assert abs(sum(told["area"].values()) - 1) < 1e-12
    for name in ("rate", "energy", "kappa_smooth"):
        for end, ufunc in (("min", np.nanmin), ("max", np.nanmax)):
            value, where = told[name][end]
            assert value == ufunc(grid[name])
            assert float(grid[name].sel(theta=where["theta"], ell=where["ell"])) == value
    assert sc.sweep.survey(0.5, 3.0, want="rate")["rate"] is None
    with pytest.raises(ValueError, match="theta: expected ascending"):
        sc.sweep.survey(theta[::-1], ell)


def test_boundaries_part_the_regions():
    curves = sc.sweep.boundaries([0.4, 2.5])
    assert curves["rolling"].dims == ("ell", "root") and curves["theta_balance"].attrs["units"] == "rad"
    assert np.allclose(curves["theta_limit"], sc.Body.solid(np.array([0.4, 2.5])).theta_limit)


def test_a7_more_motions_than_memory_would_hold_are_lazy():
    many = da.linspace(0.9, 3, 10**9, chunks=10**6)
    found = sc.sweep.roll(sc.Body.solid(many), sc.State(1.3, 0.8, 0.05, 1.0), 20.0)
    assert found["theta"].size == 10**9
    assert found["theta"][-3:].compute().shape == (3,)
