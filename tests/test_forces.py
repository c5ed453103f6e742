"""Contact forces and their claimed errors: against 40 digits of the 3-d model, and between tolerances."""

import csv
import pathlib
import sys

import flicked_coin
import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.spatial.transform import Rotation

import spincyl as sc
from spincyl import loss

REFERENCE = pathlib.Path(__file__).with_name("reference")
sys.path.insert(0, str(REFERENCE))
import newton_euler  # noqa: E402


def components(m):
    """N, and friction over sqrt(2), so that its error is that of its components at most."""
    return np.array([m.normal, m.friction / np.sqrt(2)])


def random_starts(seed, count):
    """Random bodies and states, some of them nearly flat."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        ell, i3 = rng.uniform(0, 2), rng.uniform(0.4, 1)
        theta = rng.choice([10 ** rng.uniform(-8, -1), rng.uniform(0.1, 1.5)])
        fillet = rng.choice([0.0, rng.uniform(0, 0.9)])
        w1 = theta * rng.normal() * rng.choice([1, 1 / np.sqrt(theta)])
        yield sc.Body(ell, rng.uniform(0.51, 2), i3, fillet=fillet), (theta, w1, *rng.normal(size=2))


@pytest.mark.parametrize("contact", ["rolling", "smooth"])
def test_a_force_is_that_of_forty_digits_within_its_claim_also_all_but_flat(contact):
    for body, y in random_starts(11, 150):
        m = sc.roll(body, sc.State(*y), 0.0, contact=contact, want=("pose", "force"))
        if m.t.size == 0:
            continue
        with mp.workdps(40):
            numbers = [mpf(float(x)) for x in (body.ell, body.i1, body.i3, body.fillet)]
            normal, along, across = newton_euler.force(numbers, [mpf(x) for x in y], contact)
            off = [mpf(float(m.normal[0])) - normal, mpf(float(m.friction[0])) - mp.hypot(along, across)]
        assert max(abs(float(off[0])), abs(float(off[1])) / np.sqrt(2)) <= m.force_error, (body, y)
        # at the start e2 is along y, and the body leans toward x
        there = np.array([float(across), float(along), float(normal)])
        assert np.abs(m.contact_force[0] - there).max() <= 2 * m.force_error, (body, y)


def test_forces_on_the_way_are_those_of_the_model_within_their_claims():
    checked = []
    with (REFERENCE / "motion.csv").open() as file:
        rows = [row for row in csv.reader(file) if row[0] == "state"]
    for _, name, contact, *numbers in rows:
        ell, i1, i3, *start, t = (float.fromhex(x) for x in numbers[:8])
        normal, friction = (float.fromhex(x) for x in numbers[-2:])
        for how in ({}, {"tol": 1e-8})[: 2 if t <= 100 else 1]:
            m = sc.roll(
                sc.Body(ell, i1, i3), sc.State(*start), t, contact=contact, want="force", beyond=True, **how
            )
            if m.error > 1e-3:
                continue  # the claimed error of forces is linear in that of the state
            off = np.abs(components(m)[:, 0] - [normal, friction / np.sqrt(2)]).max()
            assert off <= m.force_error, (name, how)
            checked.append(m.force_error)
    assert len(checked) > 60 and np.median(checked) < 1e-6


LAWS = loss.DryContour(3e-3) + loss.AirLinear(1e-2) + loss.RollingResistance(1e-3)


@pytest.mark.parametrize(
    ("contact", "losses", "slip"),
    [
        ("rolling", LAWS, None),
        ("smooth", LAWS, None),
        (sc.Coulomb(0.3), None, (1.0, 0.5)),
        (sc.Coulomb(0.3), LAWS, (1.0, 0.5)),
        (sc.Viscous(0.5), LAWS, (0.5, 0.0)),
    ],
)
@pytest.mark.parametrize("tol", [1e-6, 1e-8, 1e-10])
def test_forces_of_two_tolerances_agree_within_both_claims(contact, losses, slip, tol):
    body, times = sc.Body.tube(0.7, bore=0.4), np.linspace(0.05, 3.0, 40)
    for theta, w in [(1.1, (0.4, 0.1, 0.9)), (0.3, (0.3, 0.0, 0.6)), (1e-3, (0.03, 1e-3, 0.1))]:
        rough, fine = (
            sc.roll(
                body,
                sc.State(theta, *w, slip=slip),
                times,
                contact=contact,
                losses=losses,
                tol=t,
                want="force",
            )
            for t in (tol, 1e-13)
        )
        n = min(rough.t.size, fine.t.size)
        assert n > 0
        off = np.abs(components(rough)[:, :n] - components(fine)[:, :n]).max()
        assert off <= rough.force_error + fine.force_error, (theta, off)
        assert rough.force_error > 0 and np.isfinite(rough.force_error)


def test_a_claim_of_forces_is_told_where_they_are_wanted_and_only_there():
    body, start = sc.Body.solid(2.5), sc.Body.solid(2.5).steady(1.3)
    bare, pressed = sc.roll(body, start, 5.0), sc.roll(body, start, 5.0, want="force")
    assert np.isnan(bare.force_error) and "forces" not in bare.message
    assert 0 < pressed.force_error < 1e-12
    assert f"of the forces {pressed.force_error:.1e}" in pressed.message


def test_a_measured_body_tells_the_claim_in_the_unit_of_its_forces():
    tube = sc.measured(outer_diameter=0.025, inner_diameter=0.0, length=0.05, mass=0.066)
    start = tube.steady(1.3)
    m = sc.roll(tube, start, 0.1, want="force")
    assert m.force_error == pytest.approx(m.natural.force_error * 0.066 * 9.80665, rel=1e-3)


EGG = sc.Ellipsoid.egg(0.7, 1.0)
CAN, COIN = sc.Body.tube(0.7, bore=0.4), flicked_coin.body
MOVING = {
    "rolls": (CAN, CAN.steady(1.1).kicked(0.1), {}),
    "on ice": (CAN, sc.State(1.1, 0.4, 0.1, 0.9), {"contact": "smooth"}),
    "slips": (CAN, sc.State(1.1, 0.4, 0.1, 0.9, slip=(1.0, 0.5)), {"contact": sc.Coulomb(0.3)}),
    "loses": (CAN, CAN.steady(1.1), {"losses": sc.loss.ViscousContour(0.02)}),
    "has landed": (COIN, flicked_coin.flicked(10.0), {"contact": flicked_coin.table, "restitution": 0.0}),
    "stone": (EGG, EGG.spinning(2.0, pitch=0.1), {}),
    "stone that slips": (EGG, EGG.spinning(6.0, pitch=0.1), {"contact": sc.Coulomb(0.1)}),
}


@pytest.mark.parametrize("name", MOVING)
def test_the_contact_force_and_the_weight_move_the_centre_and_turn_the_body(name):
    # Newton's law in the laboratory, and without losses Euler's about the centre, by finite differences
    body, start, how = MOVING[name]
    h, middle = 5e-3, np.linspace(0.1, 0.5, 9) + (4.6 if body is COIN else 0.0)
    times = np.ravel(middle[:, None] + h * np.arange(-2, 3))
    m = sc.roll(body, start, times, t0=0.0, want=("pose", "force"), tol=1e-13, **how)
    assert m.t.size == times.size
    second, first = np.array([-1, 16, -30, 16, -1]) / (12 * h * h), np.array([1, -8, 0, 8, -1]) / (12 * h)
    pushed = np.einsum("k,nkj->nj", second, m.centre.reshape(9, 5, 3))
    force = m.contact_force.reshape(9, 5, 3)[:, 2]
    assert np.abs(force[:, :2]).max() > 1e-3 or name == "on ice"
    assert np.abs(pushed - force + [0, 0, 1]).max() < 1e-6 + 4 * m.pose_error / h**2 < 1e-4
    assert np.allclose(np.hypot(*m.contact_force[:, :2].T), m.friction, rtol=0, atol=1e-13)
    assert np.array_equal(m.contact_force[:, 2], m.normal)
    if name in ("loses", "has landed"):
        return
    if body is CAN:
        # w has components along axes that follow the tilt, but not the spin
        tilt = Rotation.from_euler("ZY", np.column_stack([m.phi, -m.theta])).as_matrix()
        momentum = np.einsum("nij,j,nj->ni", tilt, [body.i1, body.i1, body.i3], m.w)
    else:
        turned = Rotation.from_quat(m.orientation).as_matrix()
        momentum = np.einsum("nij,jk,nk->ni", turned, body.inertia, m.w)
    arm = np.pad(m.contact_point, ((0, 0), (0, 1))) - m.centre
    torque = np.cross(arm, m.contact_force).reshape(9, 5, 3)[:, 2]
    changes = np.einsum("k,nkj->nj", first, momentum.reshape(9, 5, 3))
    assert np.abs(changes - torque).max() < 1e-6
