"""Stones: tests/reference/stones.py, from equations in the laboratory, against the library."""

import csv
import json
import pathlib

import numpy as np
import pytest

import spincyl as sc

# some of these stones have masses outside the ellipsoid
pytestmark = pytest.mark.filterwarnings("ignore:inertia")
REFERENCE = pathlib.Path(__file__).with_name("reference")
TABLE = json.loads((REFERENCE / "stones.json").read_text("utf-8"))
COLUMNS = TABLE["columns"]
MOTIONS = {motion["name"]: motion for motion in TABLE["motions"]}
LOSING_TABLE = json.loads((REFERENCE / "stones_losing.json").read_text("utf-8"))
LOSING = {motion["name"]: motion for motion in LOSING_TABLE["motions"]}
LAWS = {
    "air": sc.loss.AirLinear,
    "air2": sc.loss.AirQuadratic,
    "rolling": sc.loss.RollingResistance,
    "drilling": sc.loss.Drilling,
}
STEADY = list(csv.DictReader((REFERENCE / "stones_steady.csv").read_text("utf-8").splitlines()))
ENDS = {"lift-off": sc.Ending.LIFT_OFF, "face": sc.Ending.FACE}
#: motions whose contact point always rests or always slides freely, without violent rotation
GENTLE = [
    "small stone pushed at 0.6",
    "small stone rocks from rest",
    "Kane and Levinson's stone goes on",
    "nearly round stone",
    "ball with a low centre",
    "odd stone rolls",
    "small stone on a smooth table",
]


def stone(case):
    end = np.nan if case["theta_end"] is None else case["theta_end"]
    return sc.Ellipsoid(case["axes"], case["inertia"], case["offset"], end)


def contact(case):
    if case["law"] == "smooth":
        # without a slip the library keeps the centre at rest, the reference the contact point
        return sc.Coulomb(0.0)
    if case["law"] == "coulomb":
        return sc.Coulomb(case["mu"], static=case["static"])
    return sc.Viscous(case["mu"]) if case["law"] == "viscous" else case["law"]


def units(case):
    """The natural units of length and time in the units of the case."""
    length = max(case["axes"])
    return length, np.sqrt(length / case["g"])


def rolled(case, times):
    metre, second = units(case)
    n = np.array(case["n"]) / np.linalg.norm(case["n"])
    slip = None if case["law"] == "rolling" else np.array(case["u"]) * (second / metre)
    start = sc.EllipsoidState(n, np.array(case["w"]) * second, slip)
    times = np.array(times) / second
    losses = sum(LAWS[law](x) for law, x in case["losses"].items()) if "losses" in case else None
    how = {"contact": contact(case), "losses": losses, "want": ("pose", "force")}
    return sc.roll(stone(case), start, times, t0=0.0, **how)


def rows(case):
    """The rows of a case, in natural units."""
    metre, second = units(case)
    of = {"t": second, "heat": case["g"] * metre, "fx": case["g"], "fy": case["g"], "normal": case["g"]}
    of |= dict.fromkeys(("w1", "w2", "w3"), 1 / second) | dict.fromkeys(("x", "y"), metre)
    of |= dict.fromkeys(("ux", "uy"), metre / second)
    columns = LOSING_TABLE["columns"] if "losses" in case else COLUMNS
    named = [dict(zip(columns, row, strict=True)) for row in case["rows"]]
    return [{k: v if k == "kind" else float(v) / of.get(k, 1.0) for k, v in row.items()} for row in named]


def numbers(row, *names):
    return np.array([row[name] for name in names])


def rotation(q):
    """Rotation matrix from the axes of the body to the laboratory; the quaternion has its scalar first."""
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def smallest_turn(n):
    """The rotation by the smallest angle from upright to this vertical."""
    q = np.array([1 + n[2], n[1], -n[0], 0.0]) if n[2] > -1 else np.array([0.0, 1.0, 0.0, 0.0])
    return rotation(q / np.linalg.norm(q))


def off(m, i, row, centre):
    """The errors of state, slip, pose and force at time number i of a motion."""
    q = numbers(row, "q0", "q1", "q2", "q3")
    ours = np.roll(m.orientation[i], 1)
    n = numbers(row, "n1", "n2", "n3")
    state = np.abs(np.concatenate([m.vertical[i] - n, m.w[i] - numbers(row, "w1", "w2", "w3")])).max()
    slip = 0.0
    if "slip" in m._extra:
        u = np.append(numbers(row, "ux", "uy"), 0.0)
        slip = np.abs(m.slip[i] - (smallest_turn(n) @ rotation(q).T @ u)[:2]).max()
    place = np.abs(m.contact_point[i] - centre - numbers(row, "x", "y")).max()
    pose = max(place, min(np.abs(q - ours).max(), np.abs(q + ours).max()))
    fx, fy, normal = numbers(row, "fx", "fy", "normal")
    force = max(abs(m.normal[i] - normal), abs(m.friction[i] - np.hypot(fx, fy)))
    return state, slip, pose, force


@pytest.mark.parametrize("name", MOTIONS)
def test_a_motion_is_that_of_the_other_model_within_its_claims(name):
    case = MOTIONS[name]
    told = rows(case)
    samples = [row for row in told if row["kind"] in ("sample", "end")]
    times = np.array([row["t"] for row in samples]) * units(case)[1]
    ending = ENDS.get(told[-1]["kind"])
    m = rolled(case, times if ending is None else [*times, told[-1]["t"] * units(case)[1] * 1.5])
    centre = rolled(case, [0.0]).centre[0, :2]
    assert len(m.t) == len(times)
    size = 1 + np.abs(m.w).max()
    gentle = name in GENTLE
    for i, row in enumerate(samples):
        state, slip, pose, force = off(m, i, row, centre)
        assert max(state, slip) <= m.error and pose <= m.pose_error + 1e-13 and force <= m.force_error
        if gentle:
            assert max(state, pose, force) <= 1e-12 * size * size, (state, pose, force)
    if ending is None:
        assert m.status == sc.Ending.DONE
    else:
        assert m.status == ending
        assert abs(m.event.time - told[-1]["t"]) <= min(m.error, 1e-11)
        assert np.abs(m.event.state.vertical - numbers(told[-1], "n1", "n2", "n3")).max() <= m.error
    changes = [(row["kind"], row["t"]) for row in told if row["kind"] in ("slips", "rolls")]
    if changes:
        ours = [
            (f"{phase.kind[:-3] if phase.kind == 'rolling' else 'slip'}s", phase.time) for phase in m.phases
        ]
        ours = [x for x in ours if x[1] > 0 or x in changes]
        assert [kind for kind, _ in ours] == [kind for kind, _ in changes]
        for (_, a), (_, b) in zip(ours, changes, strict=True):
            assert abs(a - b) <= max(m.error, 1e-11)


@pytest.mark.parametrize("row", STEADY, ids=lambda row: f"{row['name']} {float.fromhex(row['spin']):.3g}")
def test_the_eigenvalues_of_an_upright_spin_have_thirteen_digits(row):
    x = {k: float.fromhex(v) for k, v in row.items() if k in _EXACT}
    flip = x["up"]  # a stone on its upper end equals one turned over by half a turn about axis 1
    inertia = np.array(
        [
            [x["i11"], flip * x["i12"], flip * x["i13"]],
            [flip * x["i12"], x["i22"], x["i23"]],
            [flip * x["i13"], x["i23"], x["i33"]],
        ]
    )
    axes = np.array([x["a1"], x["a2"], x["a3"]])
    body = sc.Ellipsoid(axes, inertia, (x["d1"], flip * x["d2"], flip * x["d3"]))
    second = np.sqrt(axes.max() / x["g"])
    found = body.rocking(x["spin"] * second).eigenvalues / second
    there = np.array([complex(float(row[f"real{i}"]), float(row[f"imag{i}"])) for i in (1, 2, 3, 4)])
    # each eigenvalue is close to a different one of the reference
    left, largest = list(there), np.abs(there).max()
    for value in found:
        next_to = min(left, key=lambda other: abs(other - value))
        assert abs(next_to - value) <= 1e-13 * largest, (found, there)
        left.remove(next_to)
    grows = body.growth_rates(x["spin"] * second)
    assert grows.max() == pytest.approx(there.real.max() * second, abs=1e-13 * largest * second)
    assert body.stable(x["spin"] * second) == (there.real.max() <= 0)


_EXACT = ("a1", "a2", "a3", "i11", "i12", "i13", "i22", "i23", "i33", "d1", "d2", "d3", "g", "up", "spin")


@pytest.mark.parametrize("name", LOSING)
def test_a_motion_with_losses_is_that_of_the_other_model_within_its_estimated_error(name):
    case = LOSING[name]
    samples = [row for row in rows(case) if row["kind"] in ("sample", "end")]
    m = rolled(case, [row["t"] for row in samples])
    centre = rolled(case, [0.0]).centre[0, :2]
    assert m.status == sc.Ending.DONE
    assert len(m.t) == len(samples) >= 4
    for i, row in enumerate(samples):
        state, slip, pose, force = off(m, i, row, centre)
        assert max(state, slip) <= max(m.error, 1e-12)
        assert pose <= m.pose_error + 1e-12
        assert force <= max(m.force_error, 1e-11)
        assert abs(m.work_lost[i] - row["lost"]) <= max(10 * m.error, 1e-11)
    assert m.error < 1e-8


def test_a_ball_that_is_a_stone_loses_its_energy_as_a_body_does():
    ball, same = sc.Body.ball(0.0, i1=0.4, i3=0.4), sc.Ellipsoid.uniform((1.0, 1.0, 1.0))
    t = np.linspace(0, 4, 9)
    w1, w2, w3 = 0.7, -0.4, 1.1
    theta = 1.0
    start = sc.EllipsoidState((np.sin(theta), 0.0, np.cos(theta)), (w1, w2, w3))
    for law in (
        sc.loss.AirLinear(0.05),
        sc.loss.AirQuadratic(0.05),
        sc.loss.RollingResistance(0.02),
        sc.loss.Drilling(0.05),
    ):
        body = sc.roll(ball, sc.State(theta, w1, w2, w3), t, losses=law)
        stone = sc.roll(same, start, t, losses=law)
        assert abs(body.work_lost - stone.work_lost).max() < 1e-10 + 10 * (body.error + stone.error), law
        assert abs(np.linalg.norm(body.w, axis=1) - np.linalg.norm(stone.w, axis=1)).max() < 1e-9, law


def test_losses_along_a_rim_are_refused_for_a_stone():
    egg = sc.Ellipsoid.egg(0.8, 1.0)
    for law in (sc.loss.DryContour, sc.loss.ViscousContour, sc.loss.AirFilm, sc.loss.BoundaryLayer):
        with pytest.raises(ValueError, match="rim"):
            sc.roll(egg, egg.spinning(1.0), 1.0, losses=law(1e-3))


def test_a_rattleback_with_losses_spins_on_the_spot_and_its_energy_only_falls():
    stone = sc.Ellipsoid.rattleback((1.0, 0.2, 0.17), twist=0.05)
    losses = sc.loss.RollingResistance(2e-3) + sc.loss.AirLinear(1e-3)
    m = sc.roll(stone, stone.spinning(-0.8, pitch=0.02), np.linspace(0, 100, 401), losses=losses)
    # Rolling resistance stops the rocking, and the air never quite stops the spin about the vertical.
    assert m.status == sc.Ending.DONE and abs(m.spin[-1]) > 1e-6
    assert np.abs(m.w[-1] - m.spin[-1] * m.vertical[-1]).max() < 1e-12
    assert (np.diff(m.work_lost) >= 0).all()
    whole = stone.energy(m.states) + m.work_lost
    assert np.ptp(whole) < 1e-9
