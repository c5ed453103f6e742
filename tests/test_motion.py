"""Motion from Python: shapes, errors, endings, files; tests in Rust cover the physics."""

import copy
import csv
import math
import os
import pathlib
import pickle
import re
import signal
import subprocess
import sys
import threading
import time
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from nutating_cylinder import body as CYLINDER
from nutating_cylinder import start as START

import spincyl as sc
from spincyl import cli

sys.path.append(str(pathlib.Path(__file__).parents[1] / "benches"))
import report

T = np.linspace(0, 20, 101)
REFERENCE = pathlib.Path(__file__).parent / "reference"


def rows(table, *kinds):
    """Kind, scene, contact and numbers of the table's rows of these kinds."""
    with (REFERENCE / table).open() as file:
        for row in csv.reader(file):
            if row[0] in kinds:
                yield *row[:3], [float.fromhex(x) if "x" in x else float(x) for x in row[3:]]


def test_motions_are_those_of_the_three_dimensional_model():
    checked = {"sharp": 0, "rounded": 0, "pole": 0}
    known = [("sharp", row) for row in rows("motion.csv", "state")]
    known += [("rounded", row) for row in rows("rounded_motion.csv", "state", "pole")]
    for rim, (kind, name, contact, x) in known:
        fillet = x.pop(3) if rim == "rounded" else 0.0
        (*moments, theta, w1, w2, w3, t), known = x[:8], np.array(x[8:])
        if t > (100 if rim == "sharp" else 1000):
            continue
        body, start = sc.Body(*moments, fillet=fillet), sc.State(theta, w1, w2, w3)
        m = sc.roll(body, start, t, contact=contact, want=("pose", "force"), beyond=True)
        told, growth = (name, contact, t), max(1.0, t / 20)
        assert m.method == "exact" and m.error < 1e-10, told
        share = 10 if rim == "sharp" else 1
        assert np.abs(m.y[:, 0] - known[:4]).max() <= min(share * m.error, 1e-12 * growth), told
        off = np.abs([m.phi[0], m.psi[0], *m.contact_point[0]] - known[4:8])
        allowed = 1e-12 * growth * (1 + np.abs(known[4:8]))
        if kind == "pole":
            # both angles jump by pi at a pole, in either sense
            turns = np.array([m.phi[0] - known[4], m.phi[0] + m.psi[0] - known[4] - known[5]]) / (2 * np.pi)
            off[:2] = np.abs(turns - np.round(turns)) * 2 * np.pi
            allowed = np.full(4, 1e-12 * (1 + t / 4))  # larger for some passages
        there = ~np.isnan(off)
        assert (off[there] <= np.minimum(share * m.pose_error, allowed[there])).all(), told
        assert m.normal[0] == pytest.approx(known[8], abs=1e-11 * growth), told
        assert m.friction[0] == pytest.approx(known[9], abs=1e-11 * growth), told
        checked["pole" if kind == "pole" else rim] += 1
    assert checked["sharp"] > 20 and checked["rounded"] > 40 and checked["pole"] >= 6


def test_a_motion_has_the_shape_of_scipys():
    m = sc.roll(CYLINDER, START, T, want=("pose", "force"))
    n = T.size
    assert (m.t.shape, m.y.shape, m.theta.shape, m.w.shape, m.energy.shape) == (
        (n,),
        (4, n),
        (n,),
        (n, 3),
        (n,),
    )
    assert (m.status, m.success, m.nfev, m.event) == (0, True, 0, None)
    errors = f"error about {m.error:.1e}, of the pose {m.pose_error:.1e}, of the forces {m.force_error:.1e}"
    assert m.message == f"the last time was reached; found by first integrals, {errors}"
    assert (m.phi.shape, m.psi.shape, m.contact_point.shape, m.centre.shape) == ((n,), (n,), (n, 2), (n, 3))
    assert (m.orientation.shape, m.normal.shape, m.friction.shape) == ((n, 4), (n,), (n,))
    assert np.array_equal(m.t, T)
    assert m.theta[0] == START.theta
    assert np.abs(m.energy / m.energy[0] - 1).max() < 1e-14
    assert "2001" not in repr(m)
    assert "101 times" in repr(m)


def test_what_is_not_asked_for_is_not_there_and_says_how_to_get_it():
    m = sc.roll(CYLINDER, START, T)
    with pytest.raises(AttributeError, match=r'phi: not computed; give want="pose" to roll'):
        _ = m.phi
    with pytest.raises(AttributeError, match='want="force"'):
        _ = m.normal
    with pytest.raises(ValueError, match="want = 'colour': expected 'pose' or 'force'"):
        sc.roll(CYLINDER, START, T, want="colour")
    more = m.wanting("pose")
    assert np.abs(more.theta - m.theta).max() <= more.error + m.error < 1e-11  # computed by another method
    assert more.wanting("pose") is more
    assert more.phi.size == T.size


def test_the_orientation_carries_the_symmetry_axis_and_the_contact():
    from scipy.spatial.transform import Rotation

    m = sc.roll(CYLINDER, START, T, want="pose")
    turn = Rotation.from_quat(m.orientation)
    axis = turn.apply([0, 0, 1])
    assert np.allclose(np.arccos(axis[:, 2]), m.theta, atol=1e-12)
    assert np.allclose(axis[:, 0], -np.sin(m.theta) * np.cos(m.phi), atol=1e-10)
    # the lowest point of the lower rim is the contact point
    up = turn.inv().apply(np.tile([0.0, 0.0, 1.0], (T.size, 1)))
    rim = -up[:, :2] / np.linalg.norm(up[:, :2], axis=1)[:, None]
    low = m.centre + turn.apply(np.column_stack([rim, np.full(T.size, -CYLINDER.ell)]))
    assert np.allclose(low[:, 2], 0, atol=1e-12)
    assert np.allclose(low[:, :2], m.contact_point, atol=1e-10)


@pytest.mark.parametrize("how", [{}, {"method": "exact"}, {"step": 1e-3}, {"tol": 1e-10}])
def test_methods_agree_and_say_their_error(how):
    exact = sc.roll(CYLINDER, START, T)
    m = sc.roll(CYLINDER, START, T, **how)
    assert np.abs(m.y - exact.y).max() <= m.error + exact.error
    assert m.error < 1e-8
    assert m.method == ("rk4" if "step" in how else "dop853" if "tol" in how else "exact")
    assert (m.nfev > 0) == ("step" in how or "tol" in how)


def test_time_may_fall_or_be_a_number_or_start_elsewhere():
    there, start = sc.roll(CYLINDER, START, 20), [START.theta, START.w1, START.w2, START.w3]
    assert there.t.tolist() == [20.0]
    for how in ({}, {"step": 1e-3}, {"step": -1e-3}, {"tol": 1e-12}):
        back = sc.roll(CYLINDER, sc.State(*there.y[:, 0]), [20, 10, 0], **how)
        assert np.allclose(back.y[:, -1], start, atol=1e-9)
    later = sc.roll(CYLINDER, START, [3.0, 4.0], t0=1.0)
    assert np.allclose(later.y, sc.roll(CYLINDER, START, [2.0, 3.0], t0=0.0).y, atol=1e-13)
    assert np.array_equal(sc.roll(CYLINDER, START, [0.0]).y[:, 0], start)
    assert np.array_equal(sc.roll(CYLINDER, START, [5.0], t0=5.0).y[:, 0], start)
    with pytest.raises(ValueError, match=r"^t: an array of one time needs t0="):
        sc.roll(CYLINDER, START, [5.0])


def test_a_smooth_table_lets_fall_what_friction_holds():
    disk = sc.Body.solid(0.375)
    start = disk.steady(np.radians(80)).kicked(-0.01)
    rolling, smooth = (
        sc.roll(disk, start, np.linspace(0, 20, 201), contact=c) for c in ("rolling", "smooth")
    )
    assert rolling.success
    assert np.ptp(rolling.theta) < np.radians(2)
    assert smooth.status is sc.Ending.SIDE
    assert smooth.theta[:51].min() < np.radians(20), "fallen within five units of time"
    assert smooth.event.time == pytest.approx(12.46, abs=0.01)
    assert np.abs(smooth.energy / smooth.energy[0] - 1).max() < 1e-13


def test_endings_are_events_with_time_and_state():
    can = sc.Body.solid(1.0)
    m = sc.roll(can, sc.State(0.3, 0, 0, 0), T, want=("pose", "force"))
    assert m.status is sc.Ending.FACE and str(m.status) == "FACE" and not m.success
    assert m.event.time == pytest.approx(1.469954311913754, abs=1e-12)
    assert m.event.state.theta == 0
    assert m.t.max() < m.event.time < m.t.max() + 0.2
    assert m.normal.size == m.phi.size == m.t.size
    assert m.message.startswith("the face landed on the table: the body lies flat at t = 1.4699543119")
    slip = sc.roll(can, sc.State(0.5, 0.2, 0.0, 0.1), T, mu=0.3)
    assert slip.status is sc.Ending.SLIP
    beyond = sc.roll(can, sc.State(0.5, 0.2, 0.0, 0.1), T, mu=0.3, beyond=True)
    assert beyond.status is sc.Ending.SLIP
    assert beyond.t.size == T.size


def test_a_body_that_is_wider_than_high_stands_on_its_edge_and_a_longer_one_lies_on_its_side():
    for ell, said in ((0.375, "stands on its edge"), (1.0, "lies on its side"), (2.5, "lies on its side")):
        body = sc.Body.solid(ell)
        m = sc.roll(body, sc.State(1.5, 0.0, -0.5, 0.0), 5.0)
        assert m.status is sc.Ending.SIDE
        assert f"the other rim landed: the body {said} at t = {m.event.time:.12g}; found" in m.message


@pytest.mark.parametrize("how", [{}, {"step": 1e-3}, {"tol": 1e-10}, {"contact": "smooth"}])
def test_a_motion_at_other_times_is_the_same_motion(how):
    m = sc.roll(CYLINDER, START, 20.0, want="pose", **how)
    other = m.at([0.0, 5.0, 20.0])
    assert other.t.tolist() == [0.0, 5.0, 20.0]
    assert other.theta[0] == START.theta
    assert np.abs(other.y[:, -1] - m.y[:, 0]).max() <= m.error + other.error
    assert np.abs(other.phi[-1] - m.phi[0]) <= m.pose_error + other.pose_error
    assert (other.method, other.contact) == (m.method, m.contact)
    with pytest.raises(AttributeError):
        _ = other.normal
    later = sc.roll(CYLINDER, START, [3.0, 4.0], t0=1.0)
    assert np.allclose(later.at(5.0).y, sc.roll(CYLINDER, START, 4.0).y, atol=1e-12)
    # warnings of a step are not repeated, and an end stays an end
    can = sc.roll(sc.Body.solid(1.0), sc.State(0.3, 0, 0, 0), 1.0)
    assert can.success
    assert can.at(2.0).status is sc.Ending.FACE


@pytest.mark.parametrize(
    ("t", "error"),
    [
        (None, TypeError),
        ("soon", TypeError),
        ([], ValueError),
        ([[1.0]], ValueError),
        ([2.0, 1.0, 3.0], ValueError),
        (np.nan, ValueError),
    ],
)
def test_times_that_are_none_are_refused_by_name(t, error):
    with pytest.raises(error, match=r"^t\b"):
        sc.roll(CYLINDER, START, 20.0).at(t)


def test_a_step_that_would_lie_is_refused_and_a_doubtful_one_warned_of():
    can = sc.Body.solid(1.0)
    nearly_flat = sc.State(0.3, 1.3e-5, 0, 0)
    with pytest.raises(ValueError, match=r"step = 0.01 is too large at t = 1.46.*use a step of .*, or tol="):
        sc.roll(can, nearly_flat, 2.9, step=0.01)
    with pytest.warns(sc.StepWarning, match="give step=.*, or tol="):
        m = sc.roll(CYLINDER, START, 20, step=0.4)
    assert m.error > 1e-6
    # the proposed step causes no warning
    with pytest.raises(ValueError, match="use a step of") as refused:
        sc.roll(can, sc.State(0.3, 1.3e-3, 0, 0), 2.9, step=0.01)
    advice = float(re.search(r"use a step of (\S+), or tol=", str(refused.value))[1])
    assert sc.roll(can, sc.State(0.3, 1.3e-3, 0, 0), 2.9, step=advice).error < 1e-4
    # the passage with a tolerance: to the angle of the reference
    name = "rocking can 1e-5"
    ell, i1, i3, *start, period, _, _, phi, _ = next(
        x for _, n, _, x in rows("motion.csv", "period") if n == name
    )
    for how, allowed in (({}, 1e-12), ({"tol": 1e-9}, 1e-6), ({"tol": 1e-12}, 1e-9)):
        m = sc.roll(sc.Body(ell, i1, i3), sc.State(*start), [0.0, period], want="pose", **how)
        assert m.phi[-1] == pytest.approx(phi, abs=allowed)


@pytest.mark.parametrize(
    ("change", "error", "match"),
    [
        ({"body": 1.0}, TypeError, "body: expected a Body, not float"),
        ({"state": (1, 2, 3, 4)}, TypeError, "state: expected a State, not tuple"),
        ({"body": sc.Body.solid(np.array([1.0, 2.0]))}, ValueError, "body: expected a single body"),
        ({"state": sc.State(np.array([1.0]), 1.0, 0.0, 1.0)}, ValueError, "state: expected a single state"),
        ({"state": sc.State(0.0, 1.0, 0.0, 1.0)}, ValueError, "w1 = 1.0: expected 0 at theta = 0 or pi"),
        ({"state": sc.State(1.0, 1e308, 0.0, 1.0)}, ValueError, "w1 = 1e308: expected -1e6 to 1e6"),
        ({"body": sc.Body.solid(1e7)}, ValueError, "ell = 10000000.0: expected -1 < ell <= 1e6"),
        ({"t": []}, ValueError, "t: expected at least one time"),
        ({"t": [np.nan, 1.0]}, ValueError, "t = NaN: expected one or more times"),
        ({"want": 5}, TypeError, "want: expected 'pose', 'force' or both, not int"),
        ({"want": None}, TypeError, "want: expected"),
        ({"beyond": "no"}, TypeError, "beyond: expected True or False, not str"),
        ({"t": [0, 2, 1]}, ValueError, "t = 1.0: expected one or more times, ascending"),
        ({"t": [[0, 1]]}, ValueError, r"t: expected a number or a one-dimensional array, not shape \(1, 2\)"),
        ({"t": "now"}, TypeError, "t: expected real numbers"),
        ({"t": 1j}, TypeError, "t: expected real numbers"),
        ({"t": [0, np.nan]}, ValueError, "t = NaN"),
        ({"t0": "now"}, TypeError, "t0: expected real numbers"),
        ({"step": 0.0}, ValueError, "step = 0.0: expected a step with the sign of time"),
        ({"step": 5e-324}, ValueError, "step = 5e-324: expected"),
        ({"step": -1e-3}, ValueError, "step = -0.001: expected a step with the sign of time"),
        ({"step": np.nan}, ValueError, "step = NaN"),
        ({"step": [1e-3, 1e-4]}, TypeError, "step: expected a number"),
        ({"step": 1e-12, "t": 1e15}, ValueError, "step = 1e-12"),
        ({"tol": 0.0}, ValueError, "tol = 0.0: expected 1e-14 <= tol <= 0.1"),
        ({"step": 1e-3, "tol": 1e-6}, ValueError, "give only one of them"),
        ({"method": "rk4"}, ValueError, "method = 'rk4': give the step"),
        ({"method": "exact", "step": 1e-3}, ValueError, "leave out step= and tol="),
        ({"method": "euler"}, ValueError, "method = 'euler': expected 'exact' or 'rk4'"),
        ({"contact": "ice"}, ValueError, "contact = 'ice': expected 'rolling', 'smooth', sc.Coulomb"),
        ({"mu": -1.0}, ValueError, "mu = -1.0: expected 0 <= mu"),
        ({"mu": None}, TypeError, "mu: expected real numbers"),
    ],
)
def test_what_makes_no_sense_is_refused_by_name(change, error, match):
    asked = {"body": CYLINDER, "state": START, "t": 1.0} | change
    with pytest.raises(error, match=match):
        sc.roll(asked.pop("body"), asked.pop("state"), asked.pop("t"), **asked)


@settings(max_examples=200)
@given(
    st.floats(allow_nan=True, allow_infinity=True),
    st.floats(allow_nan=True, allow_infinity=True),
    st.floats(allow_nan=True, allow_infinity=True),
    st.floats(allow_nan=True, allow_infinity=True),
    st.floats(0, 10),
    st.sampled_from(["rolling", "smooth"]),
)
def test_any_numbers_give_a_motion_or_an_error_that_names_one(theta, w1, w2, w3, ell, contact):
    body = sc.Body.solid(ell)
    try:
        m = sc.roll(body, sc.State(theta, w1, w2, w3), [0.0, 0.1], contact=contact)
    except ValueError as e:
        assert any(str(e).startswith(name) for name in ("theta", "w1", "w2", "w3"))
    else:
        assert np.isfinite(m.y).all()


def test_swing_is_the_nutation_of_the_motion():
    found = sc.swing(CYLINDER, START)
    m = sc.roll(CYLINDER, START, [0.0, found.period], want="pose")
    assert np.allclose(m.y[:, 1], m.y[:, 0], atol=1e-13)
    assert m.phi[1] == pytest.approx(found.precession_per_period, abs=1e-12)
    assert m.psi[1] == pytest.approx(found.spin_per_period, abs=1e-12)
    assert np.hypot(*m.contact_point[1]) == pytest.approx(found.drift, abs=1e-12)
    assert found.theta_min < START.theta < found.theta_max
    assert found.nutation == pytest.approx(CYLINDER.nutation(1.3), rel=1e-2)
    assert sc.swing(sc.Body.solid(1.0), sc.State(0.3, 0, 0, 0)).period == np.inf


def test_a_motion_is_labelled_pickled_and_copied():
    m = sc.roll(CYLINDER, START, T, want=("pose", "force"), step=1e-2)
    data = m.to_xarray()
    assert data["w"].dims == ("t", "axis")
    assert data["orientation"].sizes["quaternion"] == 4
    assert data["theta"].attrs["units"] == "rad"
    assert data.attrs["status"] == "done"
    for other in (pickle.loads(pickle.dumps(m)), copy.deepcopy(m)):
        assert np.array_equal(other.y, m.y)
        assert np.array_equal(other.phi, m.phi)
        assert other.message == m.message


@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_roll_lets_other_threads_go_on():
    ticks = []

    def tick():
        while len(ticks) < 20:
            ticks.append(threading.current_thread().name)
            time.sleep(1e-3)
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=tick, name="ticks")
    # a motion of hours, which nothing ends but the other thread
    with pytest.raises(KeyboardInterrupt):
        thread.start()
        sc.roll(CYLINDER, START, 5e7, step=1e-3)
    thread.join()
    assert ticks == ["ticks"] * 20


@pytest.mark.skipif(os.name == "nt", reason="signals")
@pytest.mark.parametrize("how", ["step=1e-6", "tol=1e-14"])
def test_ctrl_c_is_honoured_at_once(how):
    # the motion takes hours; test_interrupt.py has one of many times
    code = f"""
import os, signal, spincyl as sc, threading, time
body = sc.Body.solid(2.5)
start = body.steady(1.3).kicked(0.05)
def later():
    time.sleep(0.5)
    os.kill(os.getpid(), signal.SIGINT)
try:
    threading.Thread(target=later).start()
    sc.roll(body, start, 1e6, {how})
except KeyboardInterrupt:
    sc.roll(body, start, 1.0)
    print("alive")
"""
    words = [sys.executable, "-c", code]
    child = subprocess.run(words, capture_output=True, text=True, check=True, timeout=500)
    assert child.stdout.split() == ["alive"]


def test_the_command_line_writes_what_it_says(tmp_path, capsys):
    base = ["roll", "--ell", "2.5", "--theta", "1.3", "--kick", "0.05", "--t", "20", "--points", "11"]
    for suffix in ("csv", "npz", "nc", "png", "html", "glb"):
        path = tmp_path / f"roll.{suffix}"
        assert cli.main([*base, "-o", str(path)]) == 0
        assert path.stat().st_size > 0
        what = "the motion" if suffix in ("html", "glb") else "11 times"
        assert f"{what} in {path}" in capsys.readouterr().out
    exact = sc.roll(CYLINDER, START, np.linspace(0, 20, 11), want="pose")
    table = np.genfromtxt(tmp_path / "roll.csv", delimiter=",", names=True)
    assert np.array_equal(table["theta"], exact.theta)
    assert np.array_equal(table["phi"], exact.phi)
    with np.load(tmp_path / "roll.npz") as loaded:
        assert np.array_equal(loaded["w1"], exact.w[:, 0])
    import xarray

    with xarray.open_dataset(tmp_path / "roll.nc", engine="scipy") as data:
        assert np.array_equal(data["theta"], exact.theta)
    assert cli.main([*base, "--radius", "0.01", "--step", "0.4", "-o", str(tmp_path / "a.csv")]) == 0
    said = capsys.readouterr()
    assert ", or tol=" in said.err
    assert "seconds" in (tmp_path / "a.csv").read_text().splitlines()[0]
    assert cli.main([*base, "-o", "roll.txt"]) == 2
    assert "expected a name that ends in .csv, .npz, .nc" in capsys.readouterr().err
    start = ["--theta", "0.3", "--w1", "0", "--t", "5"]
    assert cli.main(["roll", "--ell", "1", *start]) == 0
    assert "t = 1.4699543119" in capsys.readouterr().out


# the last scenes take as long as many others
@pytest.mark.parametrize("count", [3, pytest.param(7, marks=pytest.mark.long)])
def test_the_report_measures_errors_that_fall_with_the_step(tmp_path, monkeypatch, count):
    scenes = report.scenes()[:count]
    monkeypatch.setattr(report, "scenes", lambda: scenes)
    # processor time, since other load on the machine delays the clock
    monkeypatch.setattr(report, "time", SimpleNamespace(perf_counter=time.process_time))
    table = report.measure(0.3 * count, reference=str(REFERENCE / "motion.csv"))
    assert len(table) == count and "near-steady tube" in report.table(table)
    assert report.figure(table, tmp_path / "report.png")
    for row in table[:3]:
        assert row.true is not None and row.true <= 10 * row.claimed
        points = row.curves["RK4, fixed step"]
        assert len(points) >= 8
        good = [p for p in points if 1e-11 < p.error < 1e-3]
        orders = [math.log2(a.error / b.error) for a, b in pairwise(good)]
        assert np.median(orders) == pytest.approx(4, abs=0.5)
        assert {"steps within tol", "SciPy DOP853"} <= set(row.curves)


def test_a_machine_that_is_busy_elsewhere_for_a_moment_ends_no_curve(monkeypatch):
    seen, clock = set(), [0.0]
    monkeypatch.setattr(report, "time", SimpleNamespace(perf_counter=lambda: clock[0]))

    def run(setting):
        clock[0] += 1e-3
        if setting in (1.0, 2.0**-5) and setting not in seen:
            clock[0] += 0.5
        seen.add(setting)
        return setting

    points = report._curve((2.0**-k for k in range(14)), run, float, budget=0.2)
    assert [p.error for p in points] == [2.0**-k for k in range(14)]
    assert max(p.seconds for p in points) < 0.4


@pytest.mark.parametrize("contact", ["rolling", "smooth"])
def test_acceleration_is_how_the_tilting_changes_along_a_motion(contact):
    h = 1e-4
    t = np.linspace(0.0, 5.0, 11)
    m = sc.roll(CYLINDER, START, np.unique(np.r_[t, t + h, t + 2 * h]), contact=contact)
    tilting = -m.w[:, 1].reshape(-1, 3)
    rate = (tilting[:, 2] - tilting[:, 0]) / (2 * h)
    middle = sc.State(m.theta[1::3], *(m.w[1::3, i] for i in range(3)))
    assert np.allclose(CYLINDER.acceleration(middle, contact), rate, atol=1e-7)
    assert abs(CYLINDER.acceleration(CYLINDER.steady(1.3), contact)) < 1e-14
