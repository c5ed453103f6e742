"""Bodies that a force and a couple of the user drive, beside a model in Cartesian coordinates."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import spincyl as sc

UP = np.array([0.0, 0.0, 1.0])


def axes_at(theta, phi):
    """Columns e1, e2, e3."""
    h = np.array([np.cos(phi), np.sin(phi), 0.0])
    e1, e3 = np.cos(theta) * h + np.sin(theta) * UP, np.cos(theta) * UP - np.sin(theta) * h
    return np.stack([e1, np.cross(UP, h), e3], axis=1)


def accelerations(body, y, push, mu, slope=0.0):
    """Rates of (axis, w, centre velocity, centre) along the axes of the table, by Newton and Euler.

    Without `mu` the contact point is at rest, else it slips against friction.
    """
    axis, w, v = y[:3], y[3:6], y[6:9]
    force, couple = push
    turns = np.cross(w, axis)
    inertia = body.i1 * np.eye(3) + (body.i3 - body.i1) * np.outer(axis, axis)
    gyration = (body.i3 - body.i1) * (w @ axis) * turns  # the change of I w that turns with the axis
    low = (UP @ axis) * axis - UP
    down = low / np.linalg.norm(low)
    low_rate = (UP @ turns) * axis + (UP @ axis) * turns
    down_rate = (low_rate - (low_rate @ down) * down) / np.linalg.norm(low)
    arm, arm_rate = down - body.ell * axis, down_rate - body.ell * turns
    skew = np.array([[0, -arm[2], arm[1]], [arm[2], 0, -arm[0]], [-arm[1], arm[0], 0]])
    per = np.linalg.inv(inertia)
    free_turn = per @ (couple - gyration)
    free_move = np.array([*force, 0.0]) + np.array([np.sin(slope), 0.0, -np.cos(slope)])
    # The velocity v + w x r of the contact point changes by (1 - r x I^-1 r x) f and by what is free.
    gives = np.eye(3) - skew @ per @ skew
    off = free_move + np.cross(free_turn, arm) + np.cross(w, arm_rate)
    if mu is None:
        f = np.linalg.solve(gives, -off)
    else:
        u = v + np.cross(w, arm)
        way = UP - mu * u / np.linalg.norm(u)
        f = -(UP @ off) / (UP @ gives @ way) * way
    turn = free_turn + per @ np.cross(arm, f)
    return np.concatenate([turns, turn, free_move + f, v]), arm


def drive(time, velocity, axes):
    """A wind that turns, and a motor whose couple has a direction of the table."""
    force = np.array([0.2 * np.cos(0.7 * time), 0.1]) - 0.1 * velocity
    return force, axes.T @ np.array([0.06 * np.sin(time), 0.02, 0.05])


def cartesian(body, state, slip, t, mu, slope):
    """Axis, w and contact point at the times `t`."""
    axes = axes_at(state.theta, 0.0)
    w, s, c = axes @ np.array([state.w1, state.w2, state.w3]), np.sin(state.theta), np.cos(state.theta)
    low = -axes[:, 0]
    h = c * axes[:, 0] - s * axes[:, 2]
    arm = low - body.ell * axes[:, 2]
    v = -np.cross(w, arm) + slip[0] * h + slip[1] * axes[:, 1]

    def rates(time, y):
        axis = y[:3] / np.linalg.norm(y[:3])
        level = np.array([*-axis[:2], 0.0]) / np.hypot(*axis[:2])
        frame = axes_at(np.arccos(axis[2]), np.arctan2(level[1], level[0]))
        force, couple = drive(time, y[6:8], frame)
        return accelerations(body, y, (force, frame @ couple), mu, slope)[0]

    start = np.concatenate([axes[:, 2], w, v, -arm])
    found = solve_ivp(rates, (0, t[-1]), start, method="DOP853", t_eval=t, rtol=1e-12, atol=1e-13)
    points = [y[9:] + accelerations(body, y, (np.zeros(2), np.zeros(3)), mu)[1] for y in found.y.T]
    return found.y[:3].T, found.y[3:6].T, np.array(points)


@pytest.mark.parametrize("slope", [0.0, 0.25], ids=["level", "slope"])
@pytest.mark.parametrize(
    ("slip", "mu"), [((0.0, 0.0), None), ((0.4, -0.5), 0.1)], ids=["rolling", "slipping"]
)
def test_a_driven_tube_moves_as_newtons_and_eulers_equations_say(slip, mu, slope):
    body, t = sc.Body.tube(0.2, bore=0.5), np.linspace(0.0, 3.0, 13)
    steady = body.steady(1.0)
    state = sc.State(1.0, 1.1 * steady.w1, 0.1, 1.1 * steady.w3, slip=slip)
    pushes = sc.custom.Drive(lambda now: drive(now.time, now.velocity, now.axes))
    contact = sc.Coulomb(5.0 if mu is None else mu)
    table = sc.Table(slope=slope)
    m = sc.roll(body, state, t, losses=pushes, contact=contact, want="pose", table=table)
    assert m.t.size == t.size
    axis, w, points = cartesian(body, state, slip, t, mu, slope)
    assert np.all(np.abs(np.cos(m.theta) - axis[:, 2]) < 1e-8)
    np.testing.assert_allclose(m.contact_point, points[:, :2], atol=3e-8)
    along = np.array([axes_at(th, ph) @ y for th, ph, y in zip(m.theta, m.phi, m.w, strict=True)])
    np.testing.assert_allclose(along, w, atol=3e-8)


def test_a_measured_body_is_driven_in_newtons_and_seconds():
    seen = []

    def motor(now):
        seen.append(now)
        return (0.0, 0.0), (0.0, 0.0, 1e-4 * now.time)

    ball = sc.Body.ball(0.0, i1=0.4, i3=0.4).in_metres(radius="30mm", mass="50g")
    start = sc.State(np.pi / 2, 0.0, 0.0, 0.0)
    t = np.array([0.0, 1.0])
    m = sc.roll(ball, start, t, losses=sc.custom.Drive(motor), contact=sc.Coulomb(0.5))
    mass, radius = 0.05, 0.03
    gained = 1e-4 / 2 / (1.4 * mass * radius**2)  # the ball rolls with 7/5 M R^2
    assert m.w[-1, 2] == pytest.approx(gained, rel=1e-9)
    assert all(-1e-3 < now.time < 1.5 for now in seen)  # steps may end beyond the last time
    assert seen[-1].velocity @ seen[-1].velocity == pytest.approx((radius * seen[-1].w[2]) ** 2, rel=1e-9)


def test_a_push_that_ends_leaves_a_ball_rolling():
    pushes = sc.custom.Drive(lambda now: ((0.1 if now.time < 2.0 else 0.0, 0.0), (0.0, 0.0, 0.0)))
    ball = sc.Body.ball(0.0, i1=0.4, i3=0.4)
    start = sc.State(np.pi / 2, 0.0, 0.0, 0.0)
    m = sc.roll(ball, start, [0.0, 1.0, 6.0], losses=pushes, contact=sc.Coulomb(0.5), want="pose")
    a = 0.1 * 5 / 7
    np.testing.assert_allclose(m.contact_point[:, 0], [0.0, 0.5 * a, 2 * a + 2 * a * 4], atol=1e-7)


def test_a_wind_carries_a_ball_that_bounces():
    wind = sc.custom.Drive(lambda now: ((0.2 if now.height > 0 else 0.0, 0.0), (0.0, 0.0, 0.0)))
    ball = sc.Body.ball(0.0, i1=0.4, i3=0.4)
    dropped = sc.State(np.pi / 2, 0.0, 0.0, 0.0, height=0.5)
    options = {"losses": wind, "contact": sc.Coulomb(0.5), "restitution": 0.8, "want": "pose"}
    m = sc.roll(ball, dropped, [0.0, 0.5, 1.0], **options)
    np.testing.assert_allclose(m.contact_point[:, 0], [0.0, 0.025, 0.1], atol=1e-9)
    hit = m.impacts[0]
    assert hit.time == pytest.approx(1.0, abs=1e-12)
    # Friction turns the ball until it rolls, with 5/7 of the velocity of 0.2 that it has fallen with.
    assert abs(hit.after.w2) == pytest.approx(0.2 * 5 / 7, abs=1e-9)


def test_the_work_of_a_drive_alone_is_what_a_ball_gains():
    pushes = sc.custom.Drive(lambda now: ((0.1, 0.0), (0.0, 0.0, 0.0)))
    ball = sc.Body.ball(0.0, i1=0.4, i3=0.4)
    start = sc.State(np.pi / 2, 0.0, 0.0, 0.0)
    m = sc.roll(ball, start, [0.0, 2.0], losses=pushes, contact=sc.Coulomb(0.5), want="pose")
    assert m.work_lost[-1] == pytest.approx(-0.1 * m.contact_point[-1, 0], abs=1e-9)


def test_the_work_of_a_drive_is_what_a_body_gains():
    pushes = sc.custom.Drive(lambda now: ((0.1, 0.0), (0.0, 0.0, 0.02))) + sc.loss.AirLinear(0.01)
    coin = sc.Body.solid(0.1)
    m = sc.roll(coin, coin.steady(0.8), np.linspace(0, 3, 7), losses=pushes)
    assert np.ptp(coin.energy(m.states) + m.work_lost) < 1e-8
    assert repr(pushes) == "custom.Drive(<lambda>) + AirLinear(0.01)"


def test_a_sweep_of_driven_bodies_has_the_motions_of_roll_one_by_one():
    pushes = sc.custom.Drive(lambda now: ((0.1 * np.cos(now.time), 0.1), now.axes.T @ [0.0, 0.05, 0.03]))
    coin, theta = sc.Body.solid(0.1), np.linspace(0.4, 1.3, 6)
    losses = pushes + sc.loss.AirLinear(0.01)
    options = {"losses": losses, "contact": sc.Coulomb(0.3), "restitution": 0.4, "tol": 1e-10}
    y = coin.steady(theta).kicked(0.1)
    starts = sc.State(y.theta, y.w1, y.w2, y.w3, height=0.2)
    many = sc.sweep.roll(coin, starts, 3.0, **options)
    for i in range(theta.size):
        one = sc.roll(
            coin, sc.State(*(x[i] for x in (y.theta, y.w1, y.w2, y.w3)), height=0.2), 3.0, **options
        )
        for name in ("theta", "w1", "w2", "w3"):
            assert float(many[name][i].squeeze()) == pytest.approx(getattr(one.states, name)[-1], abs=1e-12)


def zero(now):
    return (0.0, 0.0), (0.0, 0.0, 0.0)


COIN = sc.Body.solid(0.1)


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"contact": "smooth"}, "contact"),
        ({"contact": sc.Coulomb(0.3), "table": sc.Table(turning=0.1)}, "turning"),
        ({"contact": sc.Coulomb(0.3, patch=0.01)}, "patch"),
    ],
)
def test_what_a_drive_does_not_know_is_named(options, named):
    with pytest.raises(ValueError, match=named):
        sc.roll(COIN, COIN.steady(0.8), 1.0, losses=sc.custom.Drive(zero), **options)


def test_wrong_drives_say_what_is_expected():
    start = COIN.steady(0.8)
    with pytest.raises(TypeError, match="function of a Moment"):
        sc.custom.Drive(3.0)
    with pytest.raises(TypeError, match="a force along x and y, and a couple"):
        sc.roll(COIN, start, 1.0, losses=sc.custom.Drive(lambda now: 0.0))
    with pytest.raises(ValueError, match="drive"):
        sc.roll(COIN, start, 1.0, losses=sc.custom.Drive(lambda now: ((np.nan, 0.0), (0, 0, 0))))
    with pytest.raises(ZeroDivisionError):
        sc.roll(COIN, start, 1.0, losses=sc.custom.Drive(lambda now: 1 / 0))
    with pytest.raises(ValueError, match="losses"):
        both = sc.custom.Drive(zero) + sc.loss.RollingResistance(0.01)
        sc.roll(COIN, start, 1.0, losses=both)
    with pytest.raises(TypeError, match="stone"):
        stone = sc.Ellipsoid.egg(1.0, 1.4, 0.0)
        sc.roll(stone, stone.spinning(5.0), 1.0, losses=sc.custom.Drive(zero))
