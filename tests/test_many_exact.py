"""Exact motions, many at once and one at a time: the same ends, times and states within both claims.

No bit of a motion depends on its neighbours. The starts are of all kinds that a user may choose: nearly flat
on either face, on or beyond the edge of the other rim, at rest or almost, lifting off at once, with one
decimal, with high spin, and before a nearly flat passage.
"""

import numpy as np
import pytest

import spincyl as sc

#: Some of the starts have errors that grow to more than 0.1, of which a sweep warns.
pytestmark = pytest.mark.filterwarnings("ignore::spincyl.ErrorWarning")

NAMES = ("theta", "w1", "w2", "w3")
SCENES = {
    "rolling": {},
    "smooth": {"contact": "smooth"},
    "friction": {"mu": 0.3},
    "hardly any friction": {"mu": 1e-6},
    "no friction": {"mu": 0.0},
    "beyond, rolling": {"beyond": True},
    "beyond, smooth": {"beyond": True, "contact": "smooth"},
}
EVERYTHING = (
    "final",
    "end",
    "theta_min",
    "theta_max",
    "normal_min",
    "friction_coefficient_max",
    "period",
    "precession_per_period",
)


def bodies(rng, n):
    """ell, I1, I3, fillet: sharp tubes, bodies of any moments, rounded bodies, balls."""
    ell = np.where(rng.random(n) < 0.15, 0.0, rng.uniform(0.05, 3, n))
    ell = np.where(rng.random(n) < 0.3, np.round(ell, 1), ell)
    i3 = (1 + np.where(rng.random(n) < 0.6, 0, rng.uniform(0, 1, n)) ** 2) / 2
    i1 = i3 / 2 + ell**2 / 3
    kind, ball = rng.random(n), rng.random(n) < 0.1
    any_moments = (kind < 0.35) | ball
    i1 = np.where(any_moments, rng.uniform(0.2, 3, n), i1)
    i3 = np.where(any_moments, i1 * rng.uniform(0.1, 1.9, n), i3)
    fillet = np.where(kind > 0.75, rng.uniform(0.01, 0.95, n), 0.0)
    return np.where(ball, rng.uniform(-0.9, 0.9, n), ell), i1, i3, np.where(ball, 1.0, fillet)


def states(rng, ell, fillet):
    """theta, w1, w2, w3 of all kinds."""
    n = ell.size
    theta, kind = rng.uniform(0.05, 1.55, n), rng.random(n)

    def where(low, high, other):
        return np.where((low <= kind) & (kind < high), other, theta)

    theta = where(0.00, 0.25, 10 ** rng.uniform(-8, -1, n))
    theta = where(0.25, 0.28, np.pi / 2)
    theta = where(0.28, 0.31, np.pi / 2 - 10 ** rng.uniform(-12, -2, n))
    theta = where(0.31, 0.33, np.pi / 2 + 10 ** rng.uniform(-8, 0, n))
    theta = where(0.40, 0.50, np.round(theta, 1))
    goes_round = (ell == 0) | (fillet == 1)
    theta = np.where(goes_round, where(0.80, 1.00, np.pi - 10 ** rng.uniform(-8, 0, n)), theta)
    theta = np.clip(theta, 1e-8, np.pi - 1e-8)
    w = rng.normal(size=(n, 3)) * rng.choice([0.1, 0.3, 1.0, 3.0], (n, 1))
    w = np.where(rng.random((n, 1)) < 0.25, np.round(w, 1), w)
    kind = rng.random(n)
    w[kind < 0.2, 1] = 0
    hardly = (kind > 0.2) & (kind < 0.28)
    w[hardly, 1] = 10 ** rng.uniform(-300, -1, hardly.sum())
    kind = rng.random(n)
    w[kind < 0.08, 0], w[(kind > 0.04) & (kind < 0.12), 2] = 0, 0
    fast, passing = (kind > 0.15) & (kind < 0.25), (kind > 0.25) & (kind < 0.4)
    w[fast, 2] *= 10 ** rng.uniform(0, 2.5, fast.sum())
    w[passing, 0] = w[passing, 2] * np.sin(theta[passing]) * 10 ** rng.uniform(-2, 1, passing.sum())
    w[(kind > 0.4) & (kind < 0.46)] = 0
    flat = (kind > 0.46) & (kind < 0.52)
    w[flat, 0] *= 10 ** rng.uniform(-12, -3, flat.sum())
    w[flat, 2] *= 10 ** rng.uniform(-12, 0, flat.sum())
    return np.column_stack([theta, w])


def drawn(seed, n):
    rng = np.random.default_rng(seed)
    body = bodies(rng, n)
    return body, states(rng, body[0], body[3])


def swept(body, y, some, **how):
    ell, i1, i3, fillet = (x[some] for x in body)
    return sc.sweep.roll(sc.Body(ell, i1, i3, fillet=fillet), sc.State(*y[some].T), **how)


def alone(body, y, i, times, **how):
    """Kind and time of the end, states at the times before it and at the end, claim; None if invalid."""
    ell, i1, i3, fillet = (x[i] for x in body)
    try:
        motion = sc.roll(sc.Body(ell, i1, i3, fillet=fillet), sc.State(*y[i]), [0.0, *times], **how)
    except ValueError:
        return None
    event = motion.event
    if how.get("beyond") and event is not None and event.ending != sc.Ending.FACE:
        # the face may land later, which shows in the number of times
        event = None if motion.t.size > len(times) else sc.Ending.FACE
    if event is None or event == sc.Ending.FACE:
        kind, last, end = sc.Ending.DONE if event is None else event, motion.y[:, -1], np.nan
    else:
        s = event.state
        kind, last, end = event.ending, np.array([s.theta, s.w1, s.w2, s.w3]), event.time
    return int(kind), end, last, motion.y[:, 1:], motion.error


def differences(body, y, t, how):
    """Motions computed in lanes: where ends differ, and other differences in units of both claims."""
    times = [t / 3, t]
    everyone = np.arange(len(y))
    many = swept(body, y, everyone, t=times, want=("states", "end"), **how)
    last = swept(body, y, everyone, t=t, **how)
    kinds, ratios, lanes = [], [], np.flatnonzero(many["method"] == sc.sweep.Answer.LANES)
    for i in lanes:
        one = alone(body, y, i, times, **how)
        assert one is not None, (how, [x[i] for x in body], y[i])
        kind, end, state, rows, claim = one
        if kind != many["status"][i]:
            kinds.append((how, t, int(many["status"][i]), kind, [x[i] for x in body], y[i]))
            continue
        off = 0.0 if np.isnan(end) else abs(float(many["end"][i]) - end)
        found = np.array([many[name][i] for name in NAMES])[:, : rows.shape[1]]
        both = ~np.isnan(found[0])
        off = max(off, np.abs(found - rows)[:, both].max(initial=0.0))
        if kind == sc.Ending.DONE or not np.isnan(end):
            off = max(off, np.abs(np.array([last[name][i] for name in NAMES]) - state).max())
        claims = claim + float(max(many["error"][i], last["error"][i]))
        ratios.append(off / (claims + 4e-16 * (1 + np.abs(y[i]).max())))
    return kinds, np.array(ratios), lanes.size / len(y)


@pytest.mark.parametrize(("name", "t"), [(name, x) for name in SCENES for x in (2.0, -20.0)])
def test_a_sweep_tells_of_a_motion_what_roll_tells_within_both_claims(name, t):
    body, y = drawn(int(abs(t)), 100)
    kinds, ratios, share = differences(body, y, t, SCENES[name])
    assert not kinds, kinds[:3]
    assert ratios.max() <= 2, ratios.max()
    assert share > 0.6, share


@pytest.mark.parametrize("contact", ["rolling", "smooth"])
@pytest.mark.parametrize("pole", [0.0, np.pi])
def test_starts_that_lie_nearly_flat_keep_their_digits_in_lanes(contact, pole):
    rng = np.random.default_rng(3)
    theta, n = np.tile(10 ** -np.linspace(1, 8, 29), 4), 116
    y = np.column_stack([np.abs(pole - theta), rng.normal(size=(n, 3)) * 0.6])
    y[:, 2] = np.where(pole > 0, 1, -1) * np.abs(y[:, 2])
    body = (np.zeros(n), rng.uniform(0.3, 1, n), np.full(n, 0.5), np.zeros(n))
    kinds, ratios, share = differences(body, y, 1.0, {"contact": contact, "beyond": True})
    assert not kinds and ratios.max() <= 2 and share > 0.8, (kinds[:2], ratios.max(), share)


def test_a_slip_that_comes_just_before_a_lift_off_is_seen():
    # friction demand exceeds mu N for 0.001 units of time before N vanishes; later mu^2 N^2 hides this
    body = sc.Body.tube(0.0, bore=0.8)
    y = (1.1, -0.06473832860126874, 0.3265813037067141, 42.24805863769208)
    found = sc.sweep.roll(body, sc.State(*([x] for x in y)), 5.0, mu=0.3, want=("final", "end"))
    assert found["status"] == sc.sweep.Status.SLIP
    # from the three-dimensional model in 80 bits
    assert abs(float(found["end"][0]) - 0.0442887787426644167) < 1e-11
    rng = np.random.default_rng(5)
    spins = np.column_stack(
        [
            rng.uniform(0.3, 1.3, 3000),
            0.1 * rng.normal(size=3000),
            0.3 * rng.normal(size=3000),
            rng.uniform(20, 60, 3000),
        ]
    )
    for mu in (0.1, 0.3, 1.0):
        kinds = sc.sweep.roll(body, sc.State(*spins.T), 5.0, mu=mu)["status"].to_numpy()
        press = sc.sweep.roll(body, sc.State(*spins.T), 0.0, mu=mu)["status"].to_numpy()
        lifted = (kinds == sc.sweep.Status.LIFT_OFF) & (press == sc.sweep.Status.DONE)
        assert (kinds == sc.sweep.Status.SLIP).sum() > 100 and not lifted.any(), mu


@pytest.mark.parametrize("contact", ["rolling", "smooth"])
def test_a_rounded_body_lands_on_its_face_with_the_energy_that_it_had(contact):
    for ell, rho, theta in [
        (0.0, 0.9, 6e-4),
        (0.3, 0.5, 1e-3),
        (0.2, 0.3, 0.2),
        (0.1, 0.99, 2e-3),
        (0.5, 0.0, 0.3),
    ]:
        body, a = sc.Body(ell, 0.4, 0.6, fillet=rho), 1 - rho
        # I1 + L^2 + A^2 of the landing face, or I1 + g^2; and the fall of the centre
        inertia = 0.4 + a**2 + ((ell + rho) ** 2 if contact == "rolling" else 0.0)
        sunk = a * np.sin(theta) - 2 * ell * np.sin(theta / 2) ** 2
        landed = np.sqrt(2 * sunk / inertia)
        one = sc.roll(body, sc.State(theta, 0.0, 0.0, 0.0), 20.0, contact=contact).event
        many = sc.sweep.roll(body, sc.State([theta], 0.0, 0.0, 0.0), 20.0, contact=contact)
        assert one.ending == sc.Ending.FACE and many["status"] == sc.sweep.Status.FACE
        assert abs(one.state.w2 - landed) < 1e-13
        assert abs(float(many["w2"][0]) - landed) <= float(many["error"][0]) < 1e-10


@pytest.mark.parametrize("name", SCENES)
def test_no_bit_hangs_on_order_chunks_neighbours_or_threads(name):
    body, y = drawn(9, 500)
    how = {**SCENES[name], "t": 7.0, "want": EVERYTHING}
    whole = swept(body, y, np.arange(500), threads=1, **how)
    order = np.random.default_rng(1).permutation(500)

    def same(some, **more):
        other = swept(body, y, some, **{"threads": 1, **how, **more})
        for key in whole:
            a, b = whole[key].to_numpy()[some], other[key].to_numpy()
            assert np.array_equal(a.view(f"u{a.itemsize}"), b.view(f"u{b.itemsize}")), key

    same(order)
    same(np.arange(500), threads=3)
    for first, past in ((1, 500), (3, 450), (200, 208), (404, 405)):
        same(np.arange(first, past))
