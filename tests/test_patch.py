"""Friction of a round patch in Python: one and many, measured bodies, what it tells, and what is refused."""

import json

import numpy as np
import pytest
import scipy.interpolate
import scipy.optimize

import spincyl as sc
from spincyl import cli

TOP = sc.Body.ball(-0.2, 0.4, 0.42)
PATCH = sc.Coulomb(0.3, patch=0.02)


def spun(w3):
    """The top, spun with its centre at rest."""
    return sc.State(0.1, 0.0, 0.0, w3, slip=(0.0, -w3 * np.sin(0.1)))


def test_many_tops_are_those_that_are_followed_one_by_one_with_patches_of_their_own():
    w3, patch = np.linspace(3, 8, 7), np.geomspace(0.005, 0.1, 7)
    law = sc.Coulomb(0.3, patch=patch)
    found = sc.sweep.roll(TOP, spun(w3), 30.0, contact=law, tol=1e-10, want=("final",))
    for i in range(7):
        m = sc.roll(TOP, spun(w3[i]), 30.0, contact=sc.Coulomb(0.3, patch=patch[i]), tol=1e-10)
        assert m.success and abs(m.theta[-1] - float(found.theta[i])) < 1e-9 + m.error


def test_a_motion_tells_its_drilling_creep_and_couple_and_the_couple_makes_heat():
    t = np.linspace(0, 20, 401)
    m = sc.roll(TOP, spun(7.0), t, contact=PATCH, want="force")
    whole = m.energy + m.dissipated
    assert np.ptp(whole) < 1e-12
    drilling = np.sin(m.theta) * m.w[:, 0] + np.cos(m.theta) * m.w[:, 2]
    assert np.allclose(m.drilling, drilling, atol=1e-14)
    assert np.allclose(m.creep, np.hypot(*m.slip.T) / (0.02 * np.abs(drilling)), rtol=1e-12)
    assert (m.couple * m.drilling < 0).all() and (np.abs(m.couple) < 0.3 * 0.02 * 0.6 * m.normal).all()
    with pytest.raises(AttributeError, match="patch=eps"):
        _ = sc.roll(TOP, spun(7.0), t, contact=sc.Coulomb(0.3)).creep


def test_the_patch_of_a_measured_body_has_a_unit():
    coin = sc.measured(outer_diameter="25.75mm", length="2.2mm")
    law = sc.Coulomb.from_si(0.3, patch="0.2mm", scale=coin)
    assert law.patch == pytest.approx(0.2 / 12.875, rel=1e-14) and law.static == 0.3
    m = sc.roll(coin, coin.steady(1.2), [0.0, 0.2], contact=law, losses=None)
    assert m.success
    with pytest.raises(ValueError, match="expected SI for a measured body"):
        sc.roll(coin, coin.steady(1.2), [0.0, 0.2], contact=PATCH)


@pytest.mark.parametrize("patch", [-0.1, 1.0, np.nan, np.inf])
def test_a_patch_is_smaller_than_the_rim(patch):
    with pytest.raises(ValueError, match="^patch = "):
        sc.Coulomb(0.3, patch=patch)


def test_what_a_patch_does_not_go_with_is_refused_by_name():
    with pytest.raises(ValueError, match="^patch = 0.02: expected 0 together with drilling friction"):
        sc.roll(TOP, spun(3.0), 1.0, contact=PATCH, losses=sc.loss.Drilling(1e-3))


def test_a_top_needs_more_spin_on_a_patch_than_jelletts_number_says():
    top = sc.Body.ball(-0.2, 0.40, 0.42)
    estimate = sc.turning_spin(top)
    assert abs(estimate - 2.496) < 1e-3
    needs = sc.turning_spin(top, sc.Coulomb(0.3, patch=0.02))
    assert 1.6 < needs / estimate < 1.7
    over = [turned(top, spin) for spin in (0.99 * needs, 1.01 * needs)]
    assert over == [False, True]
    family = sc.turning_spin(sc.Body(np.array([-0.2, 0.2]), 0.40, 0.42, fillet=1.0))
    assert family[0] == estimate and np.isnan(family[1])
    assert sc.turning_spin(top, sc.Coulomb(0.3)) == np.inf
    with pytest.raises(ValueError, match="ell"):
        sc.turning_spin(sc.Body.ball(0.2, 0.40, 0.42))
    with pytest.raises(ValueError, match="family"):
        sc.turning_spin(sc.Body(np.array([-0.2, -0.1]), 0.40, 0.42, fillet=1.0), sc.Viscous(0.3))


EGG = sc.Ellipsoid.egg(22e-3, 30.8e-3)  # metres, a = 30.8 mm
EGG_SECOND = np.sqrt(30.8e-3 / 9.80665)


def test_an_egg_rises_beyond_the_spin_at_which_jelletts_number_makes_it_stand():
    estimate = sc.rising_spin(EGG)
    assert abs(estimate / EGG_SECOND - 73.98) < 0.01
    # by an independent model: at 84 rad/s it comes to 0.28 rad, at 106 it stands
    needs = sc.rising_spin(EGG, sc.Coulomb(0.3, patch=0.2 / 30.8)) / EGG_SECOND
    assert 84 < needs < 88
    slippery = sc.rising_spin(EGG, sc.Coulomb(0.1, patch=0.2 / 30.8)) / EGG_SECOND
    assert 74 < slippery < 78, "less friction takes less of Jellett's number"
    # on a point it soon rolls, unless it is spun fast
    assert sc.rising_spin(EGG, sc.Coulomb(0.1)) / EGG_SECOND > 100
    assert 70 < sc.rising_spin(EGG, sc.Viscous(0.1)) / EGG_SECOND < 76


@pytest.mark.parametrize("offset", [0.0, 0.05, -0.05, 0.2])
def test_the_spin_of_an_egg_is_where_the_energy_of_jelletts_number_has_a_minimum_on_its_upper_end(offset):
    egg = sc.Ellipsoid.egg(1.0, 1.4, offset)
    a, b, d = 1.0, 1.0 / 1.4, offset / 1.4
    i1, i3 = (np.asarray(egg.inertia)[k, k] for k in (0, 2))

    def height(theta):
        return np.hypot(a * np.cos(theta), b * np.sin(theta)) + d * np.cos(theta)

    def energy(theta, number):
        """The least energy with this Jellett's number, for the contact point (x1, x3) below the centre."""
        s, c = np.sin(theta), np.cos(theta)
        far = np.hypot(a * c, b * s)
        x1, x3 = b * b * s / far, a * a * c / far + d
        return number**2 / (2 * (i1 * x1**2 + i3 * x3**2)) + height(theta)

    low = scipy.optimize.minimize_scalar(
        height, bounds=(1.0, 2.2), method="bounded", options={"xatol": 1e-12}
    )
    for share, stands in ((0.999, False), (1.001, True)):
        spin = share * sc.rising_spin(egg)
        number = spin * (i1 * np.sin(low.x) ** 2 + i3 * np.cos(low.x) ** 2) * low.fun
        # from its side an egg cannot come to the end that is nearer to its centre of mass
        end = 0.0 if offset >= 0 else np.pi
        assert (energy(np.abs(end - 0.003), number) > energy(end, number)) == stands


def test_what_is_no_egg_is_refused_by_name():
    for stone, name in (
        (sc.Ellipsoid.egg(1.0, 0.8), "axes"),
        (sc.Ellipsoid.uniform((1.0, 0.9, 1.4)), "axes"),
        (sc.Ellipsoid.egg(1.0, 1.4, -0.75), "offset"),
        (sc.Ellipsoid((1.0, 1.0, 1.4), (0.3, 0.35, 0.2)), "inertia"),
        (sc.Ellipsoid.egg([1.0, 1.1], 1.4), "family"),
    ):
        with pytest.raises(ValueError, match=name):
            sc.rising_spin(stone)
    with pytest.raises(ValueError, match="lean"):
        sc.rising_spin(EGG, sc.Viscous(0.1), lean=2.0)
    with pytest.raises(TypeError, match="expected an Ellipsoid, not Body"):
        sc.rising_spin(TOP)
    with pytest.raises(TypeError, match="expected Coulomb or Viscous"):
        sc.rising_spin(EGG, "rolling")


def turned(top, spin):
    start = top.with_centre_velocity(sc.State(0.1, 0.0, 0.0, spin), 0.0, 0.0)
    m = sc.roll(top, start, np.linspace(0.0, 400.0, 401), contact=sc.Coulomb(0.3, patch=0.02))
    return bool(m.theta.max() > np.pi - 0.14)


def test_the_command_line_takes_a_patch(capsys):
    m = sc.roll(TOP, spun(7.0), np.linspace(0, 20, 2001), contact=PATCH)
    top = ["roll", *"--ball -0.2 --i1 0.4 --i3 0.42 --theta 0.1 --w3 7 --t 20 --json".split()]
    top += ["--slip", "0", str(-7 * np.sin(0.1))]
    dry = ["--contact", "coulomb", "--mu", "0.3"]
    for patch in (["--patch", "0.02"], ["--radius", "15mm", "--patch", "0.3mm"]):
        assert cli.main([*top, *dry, *patch]) == 0
        told = json.loads(capsys.readouterr().out)
        assert told["contact"].startswith("Coulomb(0.3, patch=0.0")
        assert abs(told["dissipated"] - m.dissipated[-1]) < 1e-9
    for wrong, why in (
        ([*dry, "--patch", "0.3mm"], "needs --radius"),
        (["--patch", "0.02"], "needs --contact coulomb"),
    ):
        assert cli.main([*top, *wrong]) != 0
        assert why in capsys.readouterr().err


def as_a_stone(top):
    """A ball as a stone, and its state: written and followed by other equations."""
    return sc.Ellipsoid((1.0, 1.0, 1.0), np.diag([top.i1, top.i1, top.i3]), offset=(0.0, 0.0, top.ell))


def test_a_top_that_is_given_as_a_stone_turns_over_as_the_ball_does():
    for patch, mu in ((0.02, 0.3), (0.1, 0.15), (0.3, 0.6)):
        t, table = np.linspace(0.0, 30.0, 61), sc.Coulomb(mu, patch=patch)
        top = sc.roll(TOP, spun(7.0), t, contact=table, tol=1e-12)
        stone, theta = as_a_stone(TOP), 0.1
        up = np.array([-np.sin(theta), 0.0, np.cos(theta)])
        start = stone.with_centre_velocity(sc.EllipsoidState(up, np.array([0.0, 0.0, 7.0])), 0.0, 0.0)
        m = sc.roll(stone, start, t, contact=table, tol=1e-12)
        assert np.abs(np.arccos(m.vertical[:, 2]) - top.theta).max() < 1e-9 + m.error + top.error
        assert np.abs(m.dissipated - top.dissipated).max() < 1e-9 + m.error + top.error
        assert np.abs(m.spin - top.drilling).max() < 1e-9 + m.error + top.error


def test_an_egg_rises_on_a_patch_if_it_spins_fast():
    # A spheroid of 22 and 30.8 mm on a patch of 1 mm, from 1.47 rad: by an independent model it is upright after 0.8 s
    # at 106 rad/s, and comes to 1.15 rad at 63.
    axes = np.array([22 / 30.8, 22 / 30.8, 1.0])
    b = axes[0]
    egg = sc.Ellipsoid(tuple(axes), np.diag([b * b + 1, b * b + 1, 2 * b * b]) / 5)
    second = np.sqrt(9.81 / 0.0308)
    up = np.array([-np.sin(1.47), 0.0, np.cos(1.47)])
    leans = []
    for spin in (106.0, 63.0):
        start = egg.with_centre_velocity(sc.EllipsoidState(up, spin / second * up), 0.0, 0.0)
        t = np.linspace(0.0, 2.0, 401)
        m = sc.roll(egg, start, t * second, contact=sc.Coulomb(0.3, patch=1 / 30.8))
        assert np.ptp(m.energy + m.dissipated) < 1e-9
        leans.append(m.theta)
    assert abs(t[np.argmax(leans[0] < 0.2)] - 0.8) < 0.05
    assert 1.1 < leans[1].min() < 1.2


def test_the_drilling_of_a_patch_takes_the_reversals_of_a_rattleback():
    stone = sc.Ellipsoid.rattleback((1.0, 0.15, 0.1), twist=np.radians(2.0))
    start, t = stone.spinning(-0.6, pitch=0.02), np.linspace(0.0, 60.0, 121)
    found = [sc.roll(stone, start, t, contact=sc.Coulomb(0.3, patch=patch)) for patch in (0.0, 1e-3, 0.05)]
    left = [np.abs(m.spin[t > 30]).max() for m in found]
    assert left[0] > 0.2 and 0.1 < left[1] < left[0] and left[2] < 0.05, left
    for m in found:
        assert np.ptp(m.energy + m.dissipated) < 1e-9
    # Many at once are those one by one.
    many = sc.sweep.roll(
        stone, start, 60.0, contact=sc.Coulomb(0.3, patch=np.array([0.0, 1e-3, 0.05])), want="spin"
    )
    assert np.abs(many["spin"].values - [m.spin[-1] for m in found]).max() < 1e-6


STILL = np.zeros(3)


@pytest.mark.parametrize("patch", [0.0, 1e-300, 1e-9, 0.02, 0.5, 0.99])
def test_a_motion_from_rest_has_its_start_among_its_outputs(patch):
    table = sc.Coulomb(0.1, patch=patch)
    times = [0.0, 1e-9, 1e-3, 0.5]
    lies = sc.roll(TOP, sc.State(np.pi / 2, 0.0, 0.0, 0.0), times, contact=table, want=("pose", "force"))
    up = np.array([1.0, 0.0, 0.0])
    stone = sc.roll(as_a_stone(TOP), sc.EllipsoidState(up, STILL, slip=(0.0, 0.0)), times, contact=table)
    for m in (lies, stone):
        assert m.t.tolist() == times and len(m.w) == len(times)
        assert np.abs(m.w[0]).max() == 0.0 and np.abs(m.w[1]).max() < 1e-8
        assert np.abs(m.w[3]).max() > 1e-3, "it falls"
    assert np.abs(np.abs(stone.w[-1]).max() - np.abs(lies.w[-1]).max()) < 1e-7
    assert sc.roll(TOP, lies.start, 0.0, contact=table).t.tolist() == [0.0]


def test_stones_on_patches_of_all_sizes_keep_energy_and_heat_from_any_start():
    rng = np.random.default_rng(52)
    ends = {}
    for _ in range(60):
        a = np.sort(rng.uniform(0.3, 1.0, 3))[::-1] / 1.0
        a = a / a[0]
        stone = sc.Ellipsoid(tuple(a), np.diag((a**2).sum() - a**2) / 5)
        up = np.eye(3)[rng.integers(3)] if rng.random() < 0.3 else rng.normal(size=3)
        up = up / np.linalg.norm(up)
        w = rng.normal(size=3) * rng.choice([0.0, 0.1, 1.0, 4.0])
        kind = rng.random()
        w = w - up * (w @ up) if kind < 0.2 else up * rng.choice([1e-300, 3e-9, -3.0]) if kind < 0.4 else w
        slip = tuple(rng.normal(size=2) * rng.choice([0.0, 1e-300, 0.1, 1.0]))
        mu, patch = float(rng.choice([0.1, 0.5, 1.0])), float(rng.choice([1e-17, 1e-6, 0.01, 0.1, 0.5]))
        table = sc.Coulomb(mu, static=mu * rng.choice([1.0, 1.3, np.inf]), patch=patch)
        start = sc.EllipsoidState(up, w, slip=slip)
        m = sc.roll(stone, start, [0.0, 1.0, 3.0], t0=0.0, contact=table)
        assert m.t.size > 0 or m.event is not None
        if m.t.size:
            kept = m.energy + m.dissipated
            assert np.isfinite(m.w).all() and np.ptp(kept) <= 1e-8 * max(1.0, kept[0]), (stone, start, table)
        ends[m.status.name] = ends.get(m.status.name, 0) + 1
    assert ends["DONE"] > 20 and set(ends) <= {"DONE", "LIFT_OFF", "FACE", "PAINLEVE"}, ends


def test_an_arm_of_rolling_resistance_beyond_the_patch_is_warned_of():
    losses = sc.loss.RollingResistance(0.05)
    with pytest.warns(UserWarning, match="outside the patch"):
        sc.roll(TOP, spun(3.0), 1.0, contact=PATCH, losses=losses)
    with pytest.warns(UserWarning, match="outside the patch"):
        sc.sweep.roll(TOP, spun(np.array([3.0, 4.0])), 1.0, contact=PATCH, losses=losses)
    sc.roll(TOP, spun(3.0), 1.0, contact=PATCH, losses=sc.loss.RollingResistance(0.01))
    with pytest.raises(AttributeError, match='want="force"'):
        _ = sc.roll(TOP, spun(3.0), 1.0, contact=PATCH).couple


@pytest.mark.parametrize("radius", [0.2, 2.0])
def test_the_heat_of_an_egg_is_the_work_of_its_friction_and_of_its_couple(radius):
    lying = EGG.spinning(5.5, pitch=np.radians(85))
    start, table = EGG.with_centre_velocity(lying, 0.0, 0.0), sc.Coulomb(0.3, patch=radius / 30.8)
    m = sc.roll(EGG, start, np.linspace(0.0, 20.0, 20001), contact=table, want="force")
    slip = np.hypot(*m.slip.T)
    np.testing.assert_allclose(m.drilling, m.spin, rtol=1e-15)
    np.testing.assert_allclose(m.creep, slip / (table.patch * np.abs(m.drilling)), rtol=1e-14)
    assert (m.couple * m.drilling < 0).all() and m.creep.min() < 1 < m.creep.max()
    power = scipy.interpolate.CubicSpline(m.t, m.friction * slip - m.couple * m.drilling)
    np.testing.assert_allclose(power.integrate(0.0, 20.0), m.dissipated[-1], rtol=1e-6)
    with pytest.raises(AttributeError, match="creep: needs a patch of contact, not contact = 'rolling'"):
        _ = sc.roll(EGG, EGG.spinning(5.5), 1.0).creep


def test_a_loss_without_a_derivative_at_rest_does_not_stop_a_stiff_slip():
    """Boundary layer friction grows with the power 3/2 of psi', which is zero all along a planar motion."""
    law = sc.loss.BoundaryLayer(6.4e-4) + sc.loss.ViscousContour(6.5e-6)
    start = sc.State(4.36e-5, 0.0, 0.0, 0.0, slip=(-6.1, 0.0))
    for patch in (4.9e-5, 0.0):
        m = sc.roll(sc.Body(1.1, 1.69, 1.43), start, 0.2, contact=sc.Coulomb(0.17, patch=patch), losses=law)
        assert m.status == sc.Ending.FACE and m.error < 1e-11
        assert abs(m.event.time - 0.016378) < 1e-5


def test_the_error_of_a_uniform_ball_covers_the_little_slip_that_its_rougher_run_would_drop():
    ball, table = sc.Body.ball(0.0, i1=0.4, i3=0.4), sc.Coulomb(0.19, patch=0.0046)
    for slip, k in [(1e-9, k) for k in range(6)] + [(1e-6, 0), (1e-6, 3), (1e-8, 5)]:
        start = sc.State(0.3 + 0.4 * k, 3.9, -4.1, -5.4, slip=(-slip, 0.07 * slip))
        fine, found = (sc.roll(ball, start, [0.0, 300.0], contact=table, tol=tol) for tol in (1e-14, 1e-10))
        off = max(abs(fine.theta[1] - found.theta[1]), *abs(fine.w[1] - found.w[1]))
        assert off <= fine.error + found.error


@pytest.mark.parametrize("e", [0.0, 0.4])
def test_many_tops_that_hop_on_patches_are_those_that_are_followed_one_by_one(e):
    rng, count = np.random.default_rng(70), 16
    body, (w1, w2) = sc.Body.ball(-0.2, 0.40, 0.42), rng.uniform(-1, 1, (2, count))
    theta, w3, mu = rng.uniform(0.1, 3.0, count), rng.uniform(-12, 12, count), rng.uniform(0.1, 0.8, count)
    patch, height = 10 ** rng.uniform(-4, -1, count), rng.choice([0.0, 1e-300, 0.1], count)
    w1[:4], w2[:4], w3[:2], lift = 0.0, 0.0, 1e-300, rng.choice([0.0, 1e-12, -0.1], count)
    state = sc.State(theta, w1, w2, w3, slip=(w2, w1), height=height, lift=lift)
    how = {"restitution": e, "tol": 1e-11}
    found = sc.sweep.roll(body, state, 3.0, contact=sc.Coulomb(mu, patch=patch), want=("final", "end"), **how)
    for i in range(count):
        start = sc.State(theta[i], w1[i], w2[i], w3[i], slip=(w2[i], w1[i]), height=height[i], lift=lift[i])
        m = sc.roll(body, start, 3.0, contact=sc.Coulomb(mu[i], patch=patch[i]), **how)
        assert int(found.status[i]) == m.status == sc.Ending.DONE
        last = [float(found[name][i]) for name in ("theta", "w1", "w2", "w3")]
        apart = np.abs(np.array(last) - [np.ravel(x)[0] for x in (m.theta, *m.w.T)]).max()
        assert apart < 1e-10 + 4 * (m.error + float(found.error[i])), i
