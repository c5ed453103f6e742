"""Motions on a slope: what is asked and answered; tests/laws/slope.rs has the laws of the motion."""

import pickle

import numpy as np
import pytest
import xarray

import spincyl as sc

DISK, START = sc.Body.solid(0.1), sc.State(1.2, 0.5, 0.0, 1.5)
TABLE = sc.Table(0.2, phi0=0.4, place=(1.0, -2.0))


def test_a_table_is_what_was_given():
    assert sc.Table("5 deg").slope == np.radians(5) and sc.Table("0.1 rad", phi0="-90deg").phi0 == -np.pi / 2
    assert repr(TABLE) == "Table(slope=0.2, phi0=0.4, place=(1.0, -2.0))" and repr(sc.Table()) == "Table()"
    assert eval(repr(TABLE), {"Table": sc.Table}) == TABLE and sc.Table(0.2) != TABLE
    assert pickle.loads(pickle.dumps(TABLE)) == TABLE


@pytest.mark.parametrize(
    ("make", "error", "word"),
    [
        (lambda: sc.Table("steep"), (ValueError, TypeError), "slope"),
        (lambda: sc.Table(5.0), ValueError, "slope = 5.0: expected"),
        (lambda: sc.Table(1j), TypeError, "slope"),
        (lambda: sc.Table(0.1, place=1.0), TypeError, "place: expected a pair"),
        (lambda: sc.roll(DISK, START, 1.0, table=0.1), TypeError, "table: expected a Table"),
        (lambda: sc.roll(DISK, START, 1.0, table=sc.Table(np.pi / 2)), ValueError, "slope = 1.57"),
        (
            lambda: sc.roll(DISK, START, 1.0, table=sc.Table([0.1, 0.2])),
            TypeError,
            "slope: expected a number",
        ),
        (lambda: sc.roll(DISK, START, 1.0, table=TABLE, step=0.01), ValueError, "step = 0.01 cannot be"),
        (
            lambda: sc.roll(DISK, START, 1.0, table=TABLE, method="exact"),
            ValueError,
            "method = 'exact' cannot",
        ),
        (lambda: sc.roll(DISK, START, -1.0, table=TABLE), ValueError, "t"),
        (
            lambda: sc.roll(
                DISK, START, 1.0, table=TABLE, losses=sc.loss.DryContour(0.01) + sc.loss.Drilling(0.01)
            ),
            ValueError,
            "slope = 0.2: expected 0 with dry friction along",
        ),
        (
            lambda: sc.roll(DISK, START, 1.0, table=TABLE, losses=sc.loss.Drilling(0.01), restitution=0.0),
            ValueError,
            "slope = 0.2: expected 0, since the body can lie on two circles and has drilling",
        ),
        (
            lambda: sc.roll(
                DISK, sc.spun(DISK, 1.0), 1.0, table=sc.Table(turning=0.2), contact=sc.Coulomb(0.3)
            ),
            ValueError,
            "turning = 0.2: expected 0 for a body on its face",
        ),
        (lambda: sc.sweep.roll(DISK, START, 1.0, table=0.2), TypeError, "table: expected a Table"),
        (lambda: sc.sweep.roll(DISK, START, 1.0, table=TABLE, step=0.01), ValueError, "step, beyond"),
    ],
)
def test_what_makes_no_sense_is_refused_by_name(make, error, word):
    with pytest.raises(error, match=word):
        make()


STONE = sc.Ellipsoid((1.0, 0.7, 0.5), np.diag((0.2, 0.3, 0.4)))


@pytest.mark.parametrize(
    ("table", "how", "word"),
    [
        (sc.Table(0.1, turning=0.3), {}, "turning = 0.3: expected 0 for a stone"),
    ],
)
def test_what_is_not_computed_for_a_stone_on_a_slope_is_refused_by_name(table, how, word):
    with pytest.raises(ValueError, match=word):
        sc.roll(STONE, STONE.spinning(1.0, pitch=0.1), 1.0, table=table, **how)


@pytest.mark.parametrize(
    "how",
    [
        {},
        {"contact": "smooth"},
        {"contact": sc.Viscous(0.3)},
        {"contact": sc.Coulomb(0.2), "losses": sc.loss.RollingResistance(0.01) + sc.loss.AirLinear(0.02)},
        {"contact": sc.Coulomb(0.2), "losses": sc.loss.Drilling(0.05)},
        {"contact": sc.Coulomb(0.2, patch=0.05)},
        {"contact": sc.custom.Friction(lambda u: 0.2 + 0.1 * np.exp(-u))},
    ],
)
def test_the_energy_of_a_stone_on_a_slope_includes_the_height_above_its_foot(how):
    start, table = STONE.spinning(1.0, pitch=0.3, roll=0.2), sc.Table(0.2, phi0=0.5, place=(1.0, 2.0))
    m = sc.roll(STONE, start, np.linspace(0, 2, 21), table=table, **how)
    assert m.contact_point[0].tolist() == [1.0, 2.0]
    whole = m.energy.copy()
    for name in ("dissipated", "work_lost"):
        try:
            whole = whole + getattr(m, name)
        except AttributeError:
            continue
    assert np.ptp(whole) < 1e-10 and np.ptp(m.centre[:, 0]) > 0.05


def test_a_stone_turned_by_phi0_goes_the_same_way_turned_on_a_level_table():
    start, times = sc.EllipsoidState((0.6, 0.0, 0.8), (0.1, 0.5, 1.0), slip=(0.3, 0.2)), np.linspace(0, 2, 5)
    how = {"contact": sc.Coulomb(0.2), "want": "pose"}
    m, turned = (sc.roll(STONE, start, times, table=sc.Table(phi0=x), **how) for x in (0.0, np.pi / 2))
    assert np.allclose(m.contact_point @ np.array([[0, 1], [-1, 0]]), turned.contact_point, atol=1e-11)


@pytest.mark.parametrize(
    "how",
    [
        {},
        {"contact": "smooth"},
        {"contact": sc.Coulomb(0.2), "restitution": 0.5},
        {"contact": sc.Viscous(0.3)},
        {"contact": sc.Coulomb(0.2), "losses": sc.loss.RollingResistance(0.01) + sc.loss.AirLinear(0.02)},
    ],
)
def test_the_energy_of_a_motion_on_a_slope_includes_the_height_above_its_foot(how):
    m = sc.roll(DISK, START, np.linspace(0, 4, 41), table=TABLE, **how)
    whole = m.energy.copy()
    for name in ("dissipated", "work_lost", "lost_in_impacts"):
        try:
            whole = whole + getattr(m, name)
        except AttributeError:
            continue
    assert m.t.size > 10 and np.abs(whole - whole[0]).max() < 1e-11 + 20 * m.error
    assert m.phi[0] == 0.4 and tuple(m.contact_point[0]) == (1.0, -2.0)
    assert "in steps" in m.message


def test_a_measured_body_moves_in_si():
    coin = sc.measured(outer_diameter="22mm", length="2mm", mass="5g")
    table = sc.Table("10 deg", phi0=0.4)
    second = float(np.sqrt(coin.scale.radius / coin.scale.gravity))
    times = np.array([0.0, 1.0, 2.0])
    m = sc.roll(coin, START, times * second, table=table)
    n = sc.roll(coin.natural, START, times, table=table)
    assert np.allclose(m.w * second, n.w, rtol=1e-12) and np.allclose(m.phi, n.phi, rtol=1e-12)
    assert np.allclose(m.energy, n.energy * 5e-3 * coin.scale.gravity * coin.scale.radius, rtol=1e-12)


def test_other_times_and_outputs_are_those_of_the_same_slope():
    m = sc.roll(DISK, START, np.linspace(0, 4, 5), table=TABLE)
    later = m.at([1.0, 4.0])
    assert np.array_equal(later.theta[-1], m.theta[-1]) and later.phi.size == 2
    force = m.wanting("force")
    assert force.normal.min() > 0 and force.friction.min() > 0


def test_a_sweep_over_slopes_has_the_motions_that_roll_has():
    slopes = np.array([-0.3, 0.0, 0.1, 0.5])
    for how in ({}, {"contact": sc.Coulomb(0.3)}, {"contact": sc.Coulomb(0.2), "restitution": 0.3}):
        want = ("final", "end")
        found = sc.sweep.roll(DISK, START, 3.0, table=sc.Table(slopes, phi0=0.4), want=want, tol=1e-12, **how)
        for i, slope in enumerate(slopes):
            m = sc.roll(DISK, START, 3.0, table=sc.Table(slope, phi0=0.4), tol=1e-12, **how)
            last = m.event.state if m.event else m.states
            apart = [
                float(found[name][i]) - float(np.ravel(getattr(last, name))[0]) for name in ("theta", "w3")
            ]
            assert max(map(abs, apart)) <= 1e-9 + 10 * m.error, (how, slope)
            assert found["status"].values[i] == m.status
        again = sc.sweep.roll(**sc.sweep.inputs(found), want=want)
        assert all(np.array_equal(again[name], found[name], equal_nan=True) for name in again.data_vars)
        level = sc.sweep.roll(DISK, START, 3.0, want="final", tol=1e-12, **how)
        assert all(float(level[name]) == found[name][1] for name in ("theta", "w1", "w2", "w3")), how


SCENES = {
    "slips": {"contact": sc.Coulomb(0.3)},
    "slides on": {"contact": sc.Coulomb(0.05)},
    "rolls": {},
    "film": {"contact": sc.Viscous(0.3)},
    "patch": {"contact": sc.Coulomb(0.4, patch=0.1)},
    "losses": {
        "contact": sc.Coulomb(0.6),
        "losses": sc.loss.RollingResistance(0.01) + sc.loss.AirLinear(0.01),
    },
    "hops": {"contact": sc.Coulomb(0.3), "restitution": 0.4},
}


#: Rows that nobody would choose: at rest, lying, a slope of less than a digit, hardly any slip, straight down and up.
ODD = (
    {"slope": 0.0},
    {"w1": 0.0, "w2": 0.0, "w3": 0.0, "slip": 0.0},
    {"theta": np.pi / 2, "w1": 0.0, "w2": 0.0, "w3": 0.0, "slip": 0.0},
    {"slope": 1e-300},
    {"slip": 1e-300, "w3": 0.0},
    {"w1": 0.0, "w3": 0.0, "slip": 0.0, "phi0": 0.0},
    {"w1": 0.0, "w3": 0.0, "slip": 0.0, "phi0": np.pi},
    {"theta": 1.5, "w3": 0.1},
)


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.filterwarnings("ignore")
def test_random_bodies_in_a_sweep_move_down_a_slope_as_each_alone(scene):
    how, count, until, known = {"tol": 1e-12} | SCENES[scene], 24, 6.0, []
    rng = np.random.default_rng(list(SCENES).index(scene))
    bodies = [sc.Body.solid(0.1), sc.Body.solid(0.8), sc.Body.tube(2.0, 0.8), sc.Body.solid(0.5, fillet=0.1)]
    for body in bodies:
        low, high = [0.3, -1, -0.5, -3, -1, -1, -0.5, -3], [1.5, 1, 0.5, 3, 1, 1, 0.5, 3]
        names = ("theta", "w1", "w2", "w3", "slip", "slip_2", "slope", "phi0")
        given = dict(zip(names, rng.uniform(low, high, (count, 8)).T, strict=True))
        for row, odd in enumerate(ODD):
            odd = odd | ({"slip_2": 0.0} if "slip" in odd else {})
            for name, x in odd.items():
                given[name][row] = x
        if "contact" in how:
            # A third of the others slides on its face.
            given["theta"][len(ODD) :: 3] = 0.0
            given["w1"][len(ODD) :: 3] = given["w2"][len(ODD) :: 3] = 0.0
        else:
            given["slip"][:] = given["slip_2"][:] = 0.0
        theta, w1, w2, w3, *slip, slope, phi0 = given.values()
        rows = [xarray.DataArray(x, dims="row") for x in given.values()]
        start, table = sc.State(*rows[:4], slip=tuple(rows[4:6])), sc.Table(rows[6], phi0=rows[7])
        taken = ("dissipated",) if "contact" in how else ()
        found = sc.sweep.roll(body, start, until, table=table, want=("final", "end", *taken), **how)
        for i in range(count):
            own = sc.State(theta[i], w1[i], w2[i], w3[i], slip=(slip[0][i], slip[1][i]))
            try:
                m = sc.roll(body, own, until, table=sc.Table(slope[i], phi0=phi0[i]), **how)
            except ValueError:
                # A body whose other rim is down cannot roll as if it were on one.
                assert found["status"].values[i] in (sc.sweep.Status.INVALID, sc.sweep.Status.PAINLEVE), (
                    scene,
                    i,
                )
                continue
            assert found["status"].values[i] == m.status, (scene, body, i)
            last = m.event.state if m.event else m.states
            claim = 1e-12 + m.error + float(found["error"][i])
            apart = [float(found[name][i]) - float(np.ravel(getattr(last, name))[0]) for name in names[:4]]
            if taken and m.event is None:
                apart.append(0.1 * (float(found["dissipated"][i]) - float(np.ravel(m.dissipated)[-1])))
            given_up = m.status == sc.Ending.BOUNDED
            assert given_up or np.abs(apart).max() <= claim, (scene, body, i, apart, claim)
            known.append(claim < 1e-6)
    assert np.mean(known) > 0.8


@pytest.mark.parametrize("phi0", [np.nan, np.inf, 2e6])
@pytest.mark.filterwarnings("ignore:phi0")
def test_a_sweep_marks_the_directions_that_roll_refuses(phi0):
    for slope in (0.0, 0.1):
        found = sc.sweep.roll(DISK, START, 1.0, table=sc.Table([slope, slope], phi0=[phi0, 1e-300]))
        assert list(found["status"].values) == [sc.sweep.Status.INVALID, sc.sweep.Status.DONE], slope
        assert list(np.isnan(found["theta"].values)) == [True, False], slope
        with pytest.raises(ValueError, match="phi0"):
            sc.roll(DISK, START, 1.0, table=sc.Table(slope, phi0=phi0))


@pytest.mark.parametrize(
    "how", [{}, {"contact": sc.Coulomb(0.3)}, {"contact": sc.Coulomb(0.2), "restitution": 0.3}]
)
def test_a_slope_of_less_than_a_digit_moves_as_a_level_table(how):
    level = sc.roll(DISK, START, 1.0, **how)
    for slope in (1e-300, 1e-16, -1e-16):
        found = sc.roll(DISK, START, 1.0, table=sc.Table(slope), **how)
        apart = np.abs(found.states.theta - level.states.theta).max()
        assert apart <= found.error + level.error, slope


def test_slopes_broadcast_by_name():
    slope = xarray.DataArray([0.1, 0.2], dims="slope", coords={"slope": [0.1, 0.2]})
    phi0 = xarray.DataArray([0.0, 1.0, 2.0], dims="phi0")
    found = sc.sweep.roll(DISK, START, 1.0, table=sc.Table(slope, phi0=phi0))
    assert dict(found.sizes) == {"slope": 2, "phi0": 3} and np.isfinite(found["theta"]).all()


def test_what_stands_on_its_face_stays_if_friction_holds_it_and_its_weight_is_above_the_face():
    tall, flat = sc.Body.solid(6.0), sc.Body.solid(0.2)
    still = sc.State(0.0, 0.0, 0.0, 0.0)
    for body, slope, mu in ((flat, 0.2, 0.3), (tall, 0.1, 0.3)):
        m = sc.roll(body, still, 5.0, table=sc.Table(slope), contact=sc.Coulomb(mu))
        assert m.status == sc.Ending.STOPS and m.event.time == 0
    slides = sc.roll(flat, still, [0.0, 2.0], table=sc.Table(0.4), contact=sc.Coulomb(0.3), want="pose")
    goes = 2 * (np.sin(0.4) - 0.3 * np.cos(0.4))
    assert (
        abs(slides.centre[-1, 0] - slides.centre[0, 0] - goes) < 1e-12
        and slides.phases[0].kind == "on its face"
    )
    tips = sc.roll(tall, still, [0.0, 2.0], table=sc.Table(0.2), contact=sc.Coulomb(0.3))
    assert tips.theta[-1] > 0.005


def test_friction_holds_what_stands_on_a_slope_and_a_slide_has_friction_and_a_centre_of_pressure():
    body, beta = sc.Body.solid(0.5), 0.2
    spins = sc.roll(
        body,
        sc.spun(body, 2.0),
        np.linspace(0, 1.2, 481),
        table=sc.Table(beta),
        contact=sc.Coulomb(0.4),
        want=("force", "pose"),
    )
    assert np.abs(spins.contact_force[:, 2] - np.cos(beta)).max() < 1e-14
    v = np.gradient(spins.centre[:, 0], spins.t)
    friction = np.gradient(v, spins.t)[2:-2] - np.sin(beta)
    assert np.abs(friction - spins.contact_force[2:-2, 0]).max() < 1e-5
    assert np.abs(spins.energy + spins.dissipated - spins.energy[0]).max() < 1e-12


def test_a_table_that_turns_takes_a_ball_round_and_does_work():
    ball, start = sc.Body.ball(0.0, 0.4, 0.4), sc.State(1.0, 0.6, 0.2, -0.5)
    rate = 0.8
    once = 2 * np.pi / (2 / 7 * rate)
    table = sc.Table(turning=rate, place=(1.0, 0.5))
    m = sc.roll(ball, start, np.linspace(0, once, 9), table=table)
    assert np.abs(m.centre[-1] - m.centre[0]).max() < 1e-10 and np.abs(m.work_table).max() > 0.1
    assert abs(m.work_table[-1]) < 1e-10
    slips = sc.roll(ball, start, np.linspace(0, 5, 6), table=table, contact=sc.Coulomb(0.02))
    assert slips.dissipated[-1] > 0 and slips.work_table[-1] != slips.work_table[0]
    patch = sc.Coulomb(0.3, patch=0.02)
    along, drags = sc.loss.ViscousContour(0.01), sc.loss.Drilling(0.01)
    for bad in ({"contact": "smooth"}, {"losses": along + drags}, {"losses": along, "contact": patch}):
        with pytest.raises(ValueError, match="turning = 0.8: expected 0 (on|with)"):
            sc.roll(ball, start, 1.0, table=table, **bad)
    tilted, both = sc.Table(0.1, turning=rate), drags + sc.loss.RollingResistance(0.01)
    with pytest.raises(ValueError, match="turning = 0.8: expected 0 with drilling friction"):
        sc.roll(ball, start, 1.0, table=tilted, losses=both)
    with pytest.raises(ValueError, match="only sc.roll takes a table that turns"):
        sc.sweep.roll(ball, start, 1.0, table=table)
    with pytest.raises(ValueError, match="does not turn"):
        sc.scene(m, scale=sc.Scale(0.01, 0.01)).data


@pytest.mark.parametrize(
    "law",
    [
        {"contact": sc.Coulomb(0.3, patch=0.05)},
        {"contact": sc.Coulomb(0.3), "losses": sc.loss.Drilling(0.02)},
        {"contact": sc.Coulomb(0.3), "restitution": 0.6},
    ],
    ids=["patch", "drilling", "impacts"],
)
def test_the_work_of_a_table_is_its_rate_times_the_angular_momentum_it_gives(law):
    body, rate = sc.Body.ball(0.1, 0.38, 0.4), 0.7
    aloft = {"height": 0.3, "lift": 0.1} if "restitution" in law else {}
    start = sc.State(1.0, 0.6, 0.2, -0.5, slip=(0.2, -0.3), **aloft)
    table = sc.Table(turning=rate, place=(1.0, 0.5))
    m = sc.roll(body, start, np.linspace(0, 6, 61), table=table, want="pose", **law)
    e3 = np.column_stack(
        [-np.sin(m.theta) * np.cos(m.phi), -np.sin(m.theta) * np.sin(m.phi), np.cos(m.theta)]
    )
    spins = 0.38 * m.w[:, 0] * np.sin(m.theta) + 0.4 * m.w[:, 2] * np.cos(m.theta)
    x, y = m.centre[:, :2].T
    slip, (sin, cos) = m.slip, (np.sin(m.phi), np.cos(m.phi))
    along, across = slip[:, 0] * cos - slip[:, 1] * sin, slip[:, 0] * sin + slip[:, 1] * cos
    # the velocity of the centre, from that of the lowest point of the ball, which the table carries
    w = m.w[:, :1] * np.column_stack([e3[:, 2] * cos, e3[:, 2] * sin, np.sin(m.theta)])
    w += m.w[:, 1:2] * np.column_stack([-sin, cos, 0 * sin]) + m.w[:, 2:] * e3
    arm = m.centre - np.column_stack([m.contact_point, getattr(m, "height", 0 * x)])
    swung = np.cross(w, arm)
    v_x = along - rate * m.contact_point[:, 1] + swung[:, 0]
    v_y = across + rate * m.contact_point[:, 0] + swung[:, 1]
    whole = spins + x * v_y - y * v_x
    assert np.abs(m.work_table - rate * (whole - whole[0])).max() < 1e-10 < np.abs(m.work_table).max()


def test_a_marble_is_carried_round_where_rolling_resistance_holds_it():
    ball, rate, delta = sc.Body.ball(0.0, 0.4, 0.4), 0.5, 0.1
    how = {"contact": sc.Coulomb(0.3, patch=0.15), "losses": sc.loss.RollingResistance(delta)}
    for r, held in ((0.3, True), (0.39, True), (0.41, False)):
        spins = sc.State(1.0, rate * np.sin(1.0), 0.0, rate * np.cos(1.0))
        m = sc.roll(ball, spins, 1.0, table=sc.Table(turning=rate, place=(r, 0.0)), **how)
        assert (m.status == sc.Ending.STOPS) == held
        assert m.held is None


def test_the_gravity_of_a_scene_is_turned():
    scene = sc.scene(sc.roll(DISK, START, [0.0, 1.0], table=sc.Table(0.2)), scale=sc.Scale(0.01, 0.01))
    assert np.allclose(scene.data["gravity"], [9.80665 * np.sin(0.2), 0, -9.80665 * np.cos(0.2)])


CAN = sc.Body.solid(1.5)
ACROSS = -np.pi / 2


def test_a_body_slips_and_tips_where_friction_and_its_weight_say():
    mu = np.array([0.1, 0.4])
    assert np.allclose(np.tan(CAN.slip_slope(mu)), 3 * mu, rtol=1e-14)
    assert np.allclose(np.tan(sc.Body.tube([0.0, 2.0], bore=1.0).slip_slope(0.3)), 0.6, rtol=1e-14)
    assert np.allclose(np.tan(sc.Body.ball(0.0, 0.4, 0.4).slip_slope(0.3, phi=1.0)), 0.3 * 3.5, rtol=1e-14)
    assert np.allclose(np.tan(CAN.slip_slope(mu, "standing")), mu) and CAN.topples(0.7)
    assert np.isclose(np.tan(CAN.tip_slope()), 1 / 1.5) and CAN.tip_slope() < CAN.slip_slope(0.7, "standing")
    assert np.allclose(np.tan(CAN.slip_slope(mu, "lying", phi=0.0)), mu, rtol=1e-14)
    askew = CAN.slip_slope(0.4, "lying", phi=[0.0, -0.8, ACROSS])
    assert askew[1] < min(askew[0], askew[2]) and CAN.tip_slope("lying", phi=ACROSS) == pytest.approx(
        np.pi / 2
    )
    # any body of several circles: a barrel rolls on two, a cup stands on either end and tips over
    axle = sc.Body.profile([[0.5, -1.5, 0.0], [0.8, -1.0, 0.0], [0.8, 1.0, 0.0], [0.5, 1.5, 0.0]], 0.9, 0.3)
    side = axle.borders[1]
    assert np.tan(axle.slip_slope(0.2, theta=side)) == pytest.approx(0.2 * (0.3 + 0.64) / 0.3)
    assert np.tan(axle.tip_slope("lying", theta=side)) == pytest.approx(1.0 / 0.8)
    cup = sc.Body.frustum(0.7, 1.0, 2.0)
    low, high = cup.circles[0, :2], cup.circles[-1, :2]
    assert np.tan(cup.tip_slope(theta=[0.0, np.pi])) == pytest.approx([low[0] / -low[1], high[0] / high[1]])
    lies = cup.slip_slope(0.3, "lying", phi=[0.0, np.pi])
    assert np.tan(lies) == pytest.approx(0.3) and lies.shape == (2,)


def test_slopes_of_arrays_have_their_shape_and_impossible_ones_are_nan():
    found = sc.Body.solid([[0.5], [1.5]]).slip_slope([0.1, -0.1, 0.3], "lying", phi=0.3)
    assert found.shape == (2, 3) and np.isnan(found[:, 1]).all() and np.isfinite(found[:, [0, 2]]).all()
    assert found[1, 2] == CAN.slip_slope(0.3, "lying", phi=0.3)
    mu = xarray.DataArray([0.1, 0.2], dims="mu")
    assert CAN.slip_slope(mu).dims == ("mu",)


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: CAN.slip_slope(-0.1), "mu = -0.1"),
        (lambda: CAN.slip_slope(0.1, "sitting"), "posture = 'sitting'"),
        (lambda: CAN.slip_slope(0.1, phi=90.0), "phi = 90.0"),
        (lambda: CAN.slip_slope(0.1, "standing", theta=90.0), "theta = 90.0"),
        (lambda: sc.Body.ball(0.0, 0.4, 0.4).tip_slope(), "posture = 'standing'"),
        (lambda: sc.Body.solid(0.0).slip_slope(0.1, phi=0.0), "posture = 'rolling'"),
        (lambda: sc.slope_drift(CAN, START), "state"),
        (lambda: sc.slope_drift(CAN, sc.State(1.0, 0.1, 0.0, 0.2)), "state"),
        (lambda: sc.slope_drift(CAN, sc.spun(CAN, 1.0)), "state"),
    ],
)
def test_a_slope_that_no_body_has_is_refused_by_name(call, word):
    with pytest.raises((ValueError, TypeError), match=word):
        call()


def test_a_spinning_body_goes_across_the_slope_as_fast_as_known():
    tube = sc.Body.tube(6.0, bore=0.8)
    drift, resonance = sc.slope_drift(tube, tube.steady([1.45, 1.5]))
    assert drift[0] == pytest.approx(0.3975972353, abs=1e-10) and drift.shape == resonance.shape == (2,)
    assert resonance[0] == pytest.approx(0.4848096432 / 1.3171047454**2, abs=1e-9)
    ball = sc.Body.ball(0.0, 0.4, 0.4)
    assert sc.slope_drift(ball, ball.circular(1.0, 2.0))[1] == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("body", "start", "how", "lets_go", "share"),
    [
        (DISK, sc.State(0.0, 0.0, 0.0, 0.0), {"contact": sc.Coulomb(0.3)}, "slips", np.tan(0.1) / 0.3),
        (sc.Body.solid(6.0), sc.State(0.0, 0.0, 0.0, 0.0), {}, "tips", 6 * np.tan(0.1)),
        (
            sc.Body.ball(0.0, 0.4, 0.4),
            sc.State(1.0, 0.0, 0.0, 0.0),
            {"contact": sc.Coulomb(0.3), "losses": sc.loss.RollingResistance(0.15)},
            "rolls",
            np.tan(0.1) / 0.15,
        ),
        (
            CAN,
            sc.State(np.pi / 2, 0.0, 0.0, 0.0),
            {"contact": sc.Coulomb(0.11), "losses": sc.loss.RollingResistance(0.15), "restitution": 0.0},
            "slips",
            np.tan(0.1) / np.tan(CAN.slip_slope(0.11, "lying", phi=-1.4)),
        ),
    ],
)
def test_a_body_at_rest_says_how_near_to_its_limit_it_is(body, start, how, lets_go, share):
    m = sc.roll(body, start, 5.0, table=sc.Table(0.1, phi0=-1.4), **how)
    assert m.status == sc.Ending.STOPS
    assert m.held == sc.Held(pytest.approx(share, rel=1e-12), lets_go)


@pytest.mark.filterwarnings("ignore:the estimated error")
def test_a_ball_that_comes_to_rest_is_held_and_one_that_rolls_on_is_not():
    ball, arm = sc.Body.ball(0.0, 0.4, 0.4), sc.loss.RollingResistance(0.3)
    rolls = sc.State(np.pi / 2, 0.0, 0.0, 1.0)
    for slope, share in ((0.0, 0.0), (0.2, np.tan(0.2) / 0.3)):
        how = {"contact": sc.Coulomb(0.8), "losses": arm, "table": sc.Table(slope, phi0=0.3)}
        m = sc.roll(ball, rolls, 50.0, **how)
        assert m.held.share == pytest.approx(share) and m.event.time > 0
    assert sc.roll(ball, rolls, 1.0).held is None
    coin = sc.measured(outer_diameter="22mm", length="2mm", mass="5g")
    table, contact = sc.Table("10 deg"), sc.Coulomb(0.3)
    m = sc.roll(coin, sc.State(0.0, 0.0, 0.0, 0.0), 1.0, table=table, contact=contact)
    assert m.held == sc.Held(pytest.approx(np.tan(np.radians(10)) / 0.3), "slips")
    assert sc.roll(STONE, STONE.spinning(1.0, pitch=0.1), 0.1, table=table).held is None


def test_a_sweep_of_stones_over_slopes_has_the_motions_that_roll_has():
    stone = sc.Ellipsoid.rattleback((1.0, 0.35, 0.25), twist=0.3)
    start = stone.spinning(-1.0, pitch=0.02, roll=0.02)
    slopes, phi0 = np.array([0.0, 0.002, -0.001, 0.1]), np.array([1.0, 0.4, -2.0, 0.4])
    want = ("final", "end", "first_reversal")
    for how in ({"contact": "rolling"}, {"contact": sc.Coulomb(0.5)}):
        table = sc.Table(slopes, phi0=phi0)
        found = sc.sweep.roll(stone, start, 12.0, table=table, want=want, tol=1e-13, **how)
        for i, slope in enumerate(slopes):
            m = sc.roll(stone, start, 12.0, table=sc.Table(slope, phi0=phi0[i]), **how)
            last = m.event.state if m.event else m.states
            apart = np.abs([float(found[f"w{k + 1}"][i]) - np.ravel(last.w)[k] for k in range(3)]).max()
            assert not apart > 1e-12 + 10 * m.error and found["status"].values[i] == m.status, (how, slope)
            # The spin changes its sign where the reversal is said to be.
            turned = float(found["first_reversal"][i])
            near = turned * np.array([0.0, 0.999, 1.001])
            spin = sc.roll(stone, start, near, table=sc.Table(slope, phi0=phi0[i]), **how).states.spin
            assert spin[1] * spin[2] < 0 < -spin[0], (how, slope)
        again = sc.sweep.roll(**sc.sweep.inputs(found), want=want)
        assert all(np.array_equal(again[name], found[name], equal_nan=True) for name in again.data_vars)


@pytest.mark.parametrize("table", [TABLE, sc.Table(turning=0.5, place=(1.5, 0.0))])
def test_rolling_up_to_a_limit_ends_where_coulomb_friction_lets_it_slip(table):
    state, until = sc.State(1.0, 0.4, 0.1, 1.2), 0.3
    needs = sc.roll(DISK, state, np.linspace(0, until, 301), table=table, want="force").friction_coefficient
    limit = 0.5 * (needs[0] + needs.max())
    ends = sc.roll(DISK, state, until, table=table, mu=limit)
    slips = sc.roll(DISK, state, until, table=table, contact=sc.Coulomb(limit))
    assert ends.status == sc.Ending.SLIP and slips.phases[1].kind == "slipping"
    assert abs(ends.event.time - slips.phases[1].time) <= 1e-10 + ends.error + slips.error
    beyond = sc.roll(DISK, state, until, table=table, mu=limit, beyond=True)
    rolls = sc.roll(DISK, state, until, table=table)
    assert beyond.event.time == ends.event.time
    assert abs(beyond.theta - rolls.theta) <= 1e-11 + beyond.error + rolls.error
