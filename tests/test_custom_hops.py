"""Laws of a user's own where a body strikes the table, flies and lies on both rims."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import spincyl as sc

BALL = sc.Body.ball(0.0, i1=0.4, i3=0.4)
CAN = sc.Body.solid(0.8)
STRIBECK = sc.custom.Friction(lambda u: 0.1 + 0.2 * np.exp(-((u / 0.5) ** 2)))
#: Bodies whose motions have all kinds of phases.
BODIES = (
    CAN,
    sc.Body.solid(0.1),
    sc.Body.solid(0.6, fillet=0.2),
    sc.Body.solid(2.0, fillet=1.0),
    sc.Body.tube(1.2, bore=0.7),
    sc.Body.ball(-0.2, 0.4, 0.42),
)


def drawn(seed, count):
    """Bodies that fall, or stand and lie near their other rim, with the coefficients of friction and the restitution."""
    r = np.random.default_rng(seed)
    for i in range(count):
        body, falls = BODIES[i % len(BODIES)], r.random() < 0.7
        theta, w = r.uniform(0.2, 1.4), r.normal(size=3) * 10 ** r.uniform(-1, 0.5)
        if i % len(BODIES) in (0, 4) and r.random() < 0.5:
            theta, w[1] = np.pi / 2 - 10 ** r.uniform(-6, -1), 0.1 * w[1]
        height = {"height": r.uniform(0.0, 0.4), "lift": 0.3 * r.normal()} if falls else {}
        state = sc.State(theta, *w, slip=tuple(0.5 * r.normal(size=2)), **height)
        mu, e = r.uniform(0.05, 0.7), r.choice([0.0, 0.5, 1.0, r.uniform()])
        yield body, state, (mu, mu * r.choice([1.0, 1.3])), e, r.uniform(1.0, 4.0)


def sums(m):
    """What energy, heat, impacts and losses sum up to."""
    return m.energy + m.dissipated + m.lost_in_impacts + (0.0 if m.losses is None else m.work_lost)


def agree(own, built_in, body):
    assert own.status == built_in.status
    claimed = own.error + built_in.error
    off = np.array([*(own.w - built_in.w).T, own.theta - built_in.theta])
    assert abs(off).max(initial=0.0) <= max(claimed, 1e-11), (body, claimed)
    assert np.ptp(sums(own)) <= 1e-9 + 10 * own.error * (1.0 + abs(own.w).max())


def test_a_constant_coefficient_of_your_own_hops_rattles_rocks_and_lies_as_coulombs_friction():
    kinds, hits, claimed = set(), set(), []
    for body, state, (mu, static), e, until in drawn(6601, 60):
        t = np.linspace(0.0, until, 9)
        how = {"restitution": e, "losses": None}
        built_in = sc.roll(body, state, t, contact=sc.Coulomb(mu, static=static), **how)
        own = sc.roll(body, state, t, contact=sc.custom.Friction(lambda u, mu=mu: mu, static), **how)
        if not np.isfinite(own.error + built_in.error):
            continue
        agree(own, built_in, body)
        claimed.append(own.error)
        kinds |= {phase.kind for phase in own.phases}
        hits |= {hit.kind for hit in own.impacts}
    assert len(claimed) > 50 and np.median(claimed) < 1e-8
    assert kinds >= {"slipping", "rolling", "flying", "lying", "pivoting", "rolling on its side"}
    assert hits >= {"slips", "sticks", "both rims"}


@pytest.mark.parametrize(
    "contact", ["rolling", "smooth", sc.Coulomb(0.3), sc.Coulomb(0.3, static=0.4), sc.Viscous(0.5)]
)
def test_a_couple_of_your_own_acts_in_impacts_in_the_air_and_on_both_rims_as_the_librarys_does(contact):
    kinds = set()
    for body, state, (b, _), e, until in drawn(6602, 18):
        if isinstance(contact, str) and not state.height:
            state = sc.State(state.theta, state.w1, state.w2, state.w3)
        t = np.linspace(0.0, until, 9)
        how = {"restitution": e, "contact": contact}
        for built_in, law in (
            (None, lambda theta, w, normal: (0.0, 0.0, 0.0)),
            (sc.loss.AirLinear(0.05 * b), lambda theta, w, normal, b=b: -0.05 * b * w),
        ):
            expected = sc.roll(body, state, t, losses=built_in, **how)
            own = sc.roll(body, state, t, losses=sc.custom.Couple(law), **how)
            if np.isfinite(own.error + expected.error):
                agree(own, expected, body)
                kinds |= {phase.kind for phase in own.phases}
    assert "flying" in kinds


def test_a_ball_that_bounces_loses_its_slip_as_the_integral_of_the_inverse_coefficient():
    for height, e, slip in ((0.5, 0.5, 1.0), (0.02, 0.9, 0.6), (2.0, 0.0, 3.0)):
        fast = (2.0 * height) ** 0.5
        state = sc.State(1.1, 0.4, -0.2, 0.7, slip=(0.6 * slip, -0.8 * slip), height=height)
        hit = sc.roll(BALL, state, 1.01 * fast, contact=STRIBECK, restitution=e).impacts[0]
        before, after = (np.hypot(*y.slip) for y in (hit.before, hit.after))
        u = np.linspace(after, before, 20_001)
        slowed = np.trapezoid(1.0 / (3.5 * (0.1 + 0.2 * np.exp(-((u / 0.5) ** 2)))), u)
        assert hit.kind == "slips" and slowed == pytest.approx((1.0 + e) * fast, abs=1e-9)
        assert hit.impulse[2] == pytest.approx((1.0 + e) * fast, abs=1e-12)


def impulses(body, state, law, e, static):
    """The impulses of an impact and the slip after it, from Newton's and Euler's equations along the normal impulse."""
    s, c = np.sin(state.theta), np.cos(state.theta)
    ell, i1, i3 = body.ell, body.i1, body.i3
    n = np.array((-s, 0.0, c))  # the axis, along e_h, e2 and the vertical
    arm = -ell * n - np.array((c, 0.0, s))  # from the centre to the lowest point of a sharp rim
    axes = np.array(((c, 0.0, s), (0.0, 1.0, 0.0), n)).T
    give = axes @ np.diag((1 / i1, 1 / i1, 1 / i3)) @ axes.T
    cross = np.array(((0, -arm[2], arm[1]), (arm[2], 0, -arm[0]), (-arm[1], arm[0], 0)))
    m = np.eye(3) - cross @ give @ cross
    start = np.array((*state.slip, state.lift))

    def pushed(p, way):
        """The rate of all impulses by the normal one; `way` is that of a slip which begins."""
        u = (start + m @ p[:3])[:2]
        size = np.hypot(*u)
        along = way if way is not None and size < 1e-9 else u / size
        mu = law(size)
        return np.array((*(-mu * along), 1.0, (start + m @ p[:3])[2]))

    def until(p, rate, margins):
        """Follows the impulses to the first margin that vanishes."""
        events = []
        for margin in margins:
            event = lambda _, p, margin=margin: margin(p)  # noqa: E731
            event.terminal, event.direction = True, -1.0
            events.append(event)
        found = solve_ivp(lambda _, p: rate(p), (0, 100), p, "DOP853", events=events, rtol=1e-12, atol=1e-14)
        return found.y[:, -1], next(i for i, t in enumerate(found.t_events) if len(t))

    slip = lambda p: (start + m @ p[:3])[:2]  # noqa: E731
    rises = lambda p: (start + m @ p[:3])[2]  # noqa: E731
    p, rate, compressed = np.zeros(4), lambda p: pushed(p, None), None
    stopped = False
    for _ in range(4):
        ends = (
            (lambda p: -rises(p)) if compressed is None else (lambda p, c=compressed: (1 - e * e) * c - p[3])
        )
        margins = [ends] if stopped else [ends, lambda p: np.hypot(*slip(p)) - 1e-9]
        p, which = until(p, rate, margins)
        if which == 0 and compressed is None:
            compressed = p[3]
            if e == 0:
                break
        elif which == 0:
            break
        else:
            stopped = True
            held = np.linalg.solve(m[:2, :2], -m[:2, 2])
            if np.hypot(*held) <= static:
                rate = lambda p, held=held: np.array((*held, 1.0, rises(p)))  # noqa: E731
            else:
                way = np.array((np.sign(m[0, 2]), 0.0))
                rate = lambda p, way=way: pushed(p, way)  # noqa: E731
    return p[:3], slip(p)


def test_an_impact_under_a_coefficient_that_varies_is_that_of_newtons_and_eulers_equations():
    r, kinds = np.random.default_rng(6603), set()
    laws = (
        lambda u: 0.1 + 0.2 * np.exp(-((u / 0.5) ** 2)),
        lambda u: 0.05 + 0.3 * u * u / (0.1 + u * u),
        lambda u: 0.4 / (1.0 + u),
    )
    for i in range(60):
        body, e, of = sc.Body.solid(r.uniform(0.1, 2.0)), (0.0, 0.5, 1.0)[i % 3], laws[i % len(laws)]
        share = 0.2 if i % 4 == 0 else 1.0
        law = lambda u, of=of, share=share: share * of(u)  # noqa: E731
        friction = sc.custom.Friction(law, law(0.0) * (1.0, 1.3)[i % 2])
        # A slip along the lean may stop and begin again in the other direction.
        slip = tuple(r.normal(size=2) * 10 ** r.uniform(-1.5, 0.5) * (1.0, float(i % 4 != 0)))
        lift = -(10 ** r.uniform(-1.0, 0.5))
        w = r.normal(size=3)
        state = sc.State(r.uniform(0.2, 1.3), *w, slip=slip, height=0.0, lift=lift)
        hits = sc.roll(body, state, 1e-9, contact=friction, restitution=e).impacts
        assert hits and hits[0].time == 0.0
        pushed, left = impulses(body, state, law, e, friction.static)
        scale = np.abs(pushed).max()
        assert np.array(hits[0].impulse) == pytest.approx(pushed, abs=1e-7 * scale), (i, hits[0].kind)
        assert np.array(hits[0].after.slip) == pytest.approx(left, abs=2e-7 * (1 + scale)), (i, hits[0].kind)
        assert hits[0].lost >= -1e-12
        kinds.add(hits[0].kind)
    assert kinds >= {"slips", "sticks", "slips on"}


def test_an_impact_of_both_rims_opposes_each_slip_by_the_coefficient_at_its_speed():
    law = lambda u: 0.1 + 0.3 * u / (1.0 + u)  # noqa: E731
    friction, seen = sc.custom.Friction(law, static=0.5), 0
    for slip in ((0.5, 1.5), (-0.3, 2.0), (2.0, -1.0)):
        state = sc.State(np.pi / 2, 0.4, -1.0, 0.7, slip=slip)
        hit = sc.roll(CAN, state, 1e-9, contact=friction, restitution=0.0).impacts[0]
        y, (u, v) = hit.after, hit.after.slip
        low, up = np.array((u, v)), np.array((u, v - 2.0 * CAN.ell * y.w1))
        if hit.kind != "both rims" or min(np.hypot(*low), np.hypot(*up)) < 1e-3:
            continue
        # P of both rims from the impulse and from the turning about e1.
        drags = [law(np.hypot(*x)) * x / np.hypot(*x) for x in (low, up)]
        normal = np.linalg.solve(
            np.array((np.ones(2), [d[0] for d in drags])), (hit.impulse[2], -hit.impulse[0])
        )
        assert -normal @ [d[1] for d in drags] == pytest.approx(hit.impulse[1], abs=1e-9)
        seen += 1
    assert seen


def test_energy_heat_and_all_that_is_lost_keep_their_sum_under_both_laws():
    law = sc.custom.Couple(lambda theta, w, normal: -0.01 * (1.0 + normal) * (1.0 + theta) * w)
    kinds = set()
    for body, state, _, e, until in drawn(6604, 18):
        m = sc.roll(body, state, np.linspace(0.0, until, 9), contact=STRIBECK, losses=law, restitution=e)
        if np.isfinite(m.error):
            assert np.ptp(sums(m)) <= 1e-9 + 10 * m.error * (1.0 + abs(m.w).max())
            kinds |= {phase.kind for phase in m.phases}
    assert kinds >= {"slipping", "flying", "lying"}


def test_in_the_air_a_couple_is_called_without_a_normal_force_and_from_the_lower_rim():
    called = []

    def law(theta, w, normal):
        called.append((theta, normal))
        return -0.01 * w

    state = sc.State(1.0, 0.3, -4.0, 0.5, height=3.0)  # turns over in the air
    m = sc.roll(CAN, state, 0.4, contact="smooth", losses=sc.custom.Couple(law), restitution=0.5)
    assert not m.impacts and np.cos(m.theta[-1]) < -0.5
    assert all(theta <= np.pi / 2 for theta, _ in called)
    assert all(normal == 0.0 for _, normal in called[-100:])


def test_what_a_law_does_wrong_in_an_impact_is_the_error_of_the_motion():
    falls = sc.State(1.0, 0.0, 0.0, 0.0, slip=(1.0, 0.5), height=0.5)

    def motion(law, state=falls, static=0.3):
        friction = sc.custom.Friction(law, static=static)
        return sc.roll(CAN, state, 3.0, contact=friction, restitution=0.5)

    calls = []

    def raises(u):
        calls.append(u)
        if 0.9 < u < 1.0:
            raise RuntimeError("there")
        return 0.3

    def checked(value):
        """A law that has this value only in an impact, after the check."""
        count = [0]

        def law(u):
            count[0] += 1
            return value if count[0] > 1100 else 0.3

        return law

    with pytest.raises(RuntimeError, match="there") as caught:
        motion(raises)
    assert caught.traceback[-1].name == "raises"
    assert 0.9 < calls[-1] < 1.0  # no call follows
    for value in (np.nan, -0.1):
        with pytest.raises(ValueError, match=r"^mu: .* at u = |mu = .* at "):
            motion(checked(value))


def test_a_sweep_under_laws_of_your_own_hops_as_single_motions_do():
    drag = sc.custom.Couple(lambda theta, w, normal: -0.02 * w)
    state = sc.State(1.0, 0.3, 0.1, np.array([0.5, 1.5, 3.0]), slip=(0.4, 0.2), height=0.1)
    how = {"contact": STRIBECK, "losses": drag, "restitution": 0.5, "tol": 1e-9}
    found = sc.sweep.roll(CAN, state, 2.0, want=("final", "lost_in_impacts"), **how)
    for i, w3 in enumerate((0.5, 1.5, 3.0)):
        m = sc.roll(CAN, sc.State(1.0, 0.3, 0.1, w3, slip=(0.4, 0.2), height=0.1), 2.0, **how)
        assert found["w1"].values[i] == m.w[-1, 0] and found["w3"].values[i] == m.w[-1, 2]
        assert found["lost_in_impacts"].values[i] == m.lost_in_impacts[-1]


@pytest.mark.parametrize(
    "losses",
    [
        sc.loss.DryContour(2e-2),
        sc.loss.RollingResistance(2e-2),
        sc.loss.Drilling(2e-2),
        sc.loss.RollingResistance(1e-2) + sc.loss.Drilling(1e-2) + sc.loss.AirLinear(1e-2),
        sc.loss.DryContour(1e-2) + sc.loss.BoundaryLayer(1e-3),
    ],
    ids=str,
)
def test_a_constant_coefficient_beside_losses_that_press_is_coulombs_friction(losses):
    kinds, compared = set(), 0
    for i, (body, state, (mu, static), e, until) in enumerate(drawn(6605, 24)):
        if body.fillet == 1.0 and any(isinstance(law, sc.loss.BoundaryLayer) for law in losses.laws):
            continue  # a ball has no face
        how = {"losses": losses, "restitution": e}
        if i % 2:  # on the table, without impacts
            slip = state.slip if i % 4 == 1 else (0.0, 0.0)
            state, how = sc.State(state.theta, state.w1, state.w2, state.w3, slip=slip), {"losses": losses}
        t = np.linspace(0.0, until, 9)
        try:
            built_in = sc.roll(body, state, t, contact=sc.Coulomb(mu, static=static), **how)
        except ValueError:
            continue  # no unique contact force
        own = sc.roll(body, state, t, contact=sc.custom.Friction(lambda u, mu=mu: mu, static), **how)
        if not np.isfinite(own.error + built_in.error):
            continue
        assert own.status == built_in.status
        off = np.array([*(own.w - built_in.w).T, own.theta - built_in.theta])
        assert abs(off).max(initial=0.0) <= max(own.error + built_in.error, 1e-11), (i, body)
        total = (
            own.energy
            + own.dissipated
            + own.work_lost
            + (own.lost_in_impacts if "restitution" in how else 0.0)
        )
        assert np.ptp(total) <= 1e-9 + 10 * own.error * (1.0 + abs(own.w).max())
        kinds |= {phase.kind for phase in own.phases}
        compared += 1
    assert compared > 12 and kinds >= {"slipping", "rolling", "flying"}


def test_a_coefficient_that_varies_beside_rolling_resistance_keeps_the_balance_of_energy():
    losses = sc.loss.RollingResistance(1e-2) + sc.loss.Drilling(1e-2)
    for body, state, _, e, until in drawn(6606, 12):
        m = sc.roll(body, state, np.linspace(0.0, until, 9), contact=STRIBECK, losses=losses, restitution=e)
        if np.isfinite(m.error):
            assert np.ptp(sums(m)) <= 1e-9 + 10 * m.error * (1.0 + abs(m.w).max())


PRESSING = [sc.loss.RollingResistance(2e-2), sc.loss.DryContour(2e-2), sc.loss.Drilling(2e-2)]


@pytest.mark.filterwarnings("ignore:the estimated error")
@pytest.mark.parametrize("beside", PRESSING, ids=str)
def test_a_couple_of_your_own_beside_losses_that_press_acts_as_the_librarys_does(beside):
    kinds, compared = set(), 0
    for i, (body, state, (mu, static), e, until) in enumerate(drawn(6611, 24)):
        b = 10.0 ** (-1.0 - i % 3)
        how = {"contact": sc.Coulomb(mu, static=static), "restitution": e}
        if i % 2:  # on the table, without impacts
            state = sc.State(state.theta, state.w1, state.w2, state.w3, slip=state.slip)
            how = {"contact": how["contact"] if i % 4 == 1 else "rolling"}
            state = state if i % 4 == 1 else sc.State(state.theta, state.w1, state.w2, state.w3)
        t = np.linspace(0.0, until, 9)
        own = sc.custom.Couple(lambda theta, w, normal, b=b: -b * w)
        try:
            built_in = sc.roll(body, state, t, losses=beside + sc.loss.AirLinear(b), **how)
        except ValueError:
            continue  # no unique contact force
        found = sc.roll(body, state, t, losses=beside + own, **how)
        if not np.isfinite(found.error + built_in.error):
            continue
        assert found.status == built_in.status
        off = np.array([*(found.w - built_in.w).T, found.theta - built_in.theta])
        assert abs(off).max(initial=0.0) <= max(found.error + built_in.error, 1e-11), (i, body)
        total = found.energy + found.work_lost
        total = total + (0.0 if how["contact"] == "rolling" else found.dissipated)
        total = total + (found.lost_in_impacts if "restitution" in how else 0.0)
        assert np.ptp(total) <= 1e-9 + 10 * found.error * (1.0 + abs(found.w).max())
        if how["contact"] != "rolling":
            kinds |= {phase.kind for phase in found.phases}
        compared += 1
    assert compared > 12 and kinds >= {"slipping", "rolling", "flying"}


def test_a_couple_in_proportion_to_the_normal_force_adds_to_the_losses_beside_it():
    compared = 0
    for i, (body, state, (mu, _), _, until) in enumerate(drawn(6612, 16)):
        state = sc.State(state.theta, state.w1, state.w2, state.w3, slip=state.slip)
        t, how = np.linspace(0.0, until, 9), {"contact": sc.Coulomb(mu)}
        all_own = sc.custom.Couple(lambda theta, w, normal: -(0.02 + 0.05 * normal) * w)
        part = sc.custom.Couple(lambda theta, w, normal: -0.05 * normal * w)
        try:
            alone = sc.roll(body, state, t, losses=all_own, **how)
            both = sc.roll(body, state, t, losses=sc.loss.AirLinear(0.02) + part, **how)
        except ValueError:
            continue  # no unique contact force
        if np.isfinite(alone.error + both.error):
            assert abs(alone.w - both.w).max(initial=0.0) <= max(alone.error + both.error, 1e-11), i
            sums = both.energy + both.dissipated + both.work_lost
            assert np.ptp(sums) <= 1e-9 + 10 * both.error * (1.0 + abs(both.w).max())
            compared += 1
    assert compared > 8


def test_on_a_patch_a_couple_of_your_own_acts_as_the_librarys_does():
    kinds, compared = set(), 0
    for i, (body, state, (mu, _), _, until) in enumerate(drawn(6613, 30)):
        b, patch = 10.0 ** (-1.0 - i % 3), (0.01, 0.05, 0.2)[i // 3 % 3]
        state = sc.State(state.theta, state.w1, state.w2, state.w3, slip=state.slip)
        t, contact = np.linspace(0.0, 4.0 * until, 9), sc.Coulomb(mu, patch=patch)
        own = sc.custom.Couple(lambda theta, w, normal, b=b: -b * w)
        try:
            built_in = sc.roll(body, state, t, contact=contact, losses=sc.loss.AirLinear(b))
        except ValueError:
            continue
        found = sc.roll(body, state, t, contact=contact, losses=own)
        if not np.isfinite(found.error + built_in.error):
            continue
        assert found.status == built_in.status
        off = np.array([*(found.w - built_in.w).T, found.theta - built_in.theta])
        assert abs(off).max(initial=0.0) <= max(found.error + built_in.error, 1e-11), (i, body)
        total = found.energy + found.dissipated + found.work_lost
        assert np.ptp(total) <= 1e-9 + 10 * found.error * (1.0 + abs(found.w).max())
        kinds |= {phase.kind for phase in found.phases}
        compared += 1
    assert compared > 15 and "slipping" in kinds


def test_a_sum_with_a_couple_of_your_own_adds_couples_and_powers():
    own, other = sc.custom.Couple(lambda theta, w, normal: -0.1 * w), sc.loss.Drilling(1e-2)
    body, state = sc.Body.solid(1.5), sc.State(0.7, 0.3, 0.2, 1.1)
    for both in (own + other, other + own):
        assert repr(both).endswith("+ Drilling(0.01)") and both == own + other
        for name in ("couple", "power"):
            parts = [getattr(law, name)(body, state, 1.3) for law in (own, other)]
            assert np.allclose(getattr(both, name)(body, state, 1.3), sum(parts), rtol=1e-15)
    three = own + other + sc.loss.AirLinear(1e-3)
    assert repr(three).endswith("+ Drilling(0.01) + AirLinear(0.001)")
