"""Many motions with losses at once: each as alone, to the bit whatever its neighbours, and complete."""

import numpy as np
import pytest
from loss_rows import USUAL

import spincyl as sc
from spincyl import loss

DISK, ROUNDED, PIPE = sc.Body.solid(0.1704), sc.Body.solid(0.8, fillet=0.2), sc.Body.tube(2.0, bore=0.8)
COUNT = 24
THETA = np.linspace(0.1, 1.2, COUNT)
LAWS = USUAL | {
    "DryContour": loss.DryContour(np.geomspace(2e-3, 2e-2, COUNT)),
    "AirLinear": loss.AirLinear(np.geomspace(1e-3, 1e-2, COUNT)),
}
LAWS["some"] = LAWS["DryContour"] + LAWS["AirLinear"] + LAWS["Drilling"]
CONTACTS = {"rolling": "rolling", "smooth": "smooth", "Coulomb": sc.Coulomb(0.2)}


def starts(body):
    """States that turn, nod and fall, one of them at rest."""
    i = np.arange(COUNT)
    w1, w3 = np.sin(7.0 * i) * 1.5, np.cos(5.0 * i) * 2.0
    w2 = np.where(i % 3, 0.2 * np.sin(3.0 * i), 0.0)
    w1[5] = w2[5] = w3[5] = 0.0
    return sc.State(np.minimum(THETA, float(body.theta_end) - 0.1), w1, w2, w3)


def one(x, i):
    """Number i of an array or a number."""
    return float(np.broadcast_to(np.asarray(x, np.float64), (COUNT,))[i])


def law_of(losses, i):
    """The losses of motion i."""
    return sum(type(law)(one(law.coefficient, i)) for law in losses.laws)


@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize("name", LAWS)
def test_together_a_motion_with_losses_is_what_it_is_alone(name, contact):
    body = (DISK, ROUNDED, PIPE)[len(name) % 3]
    losses, state, table = LAWS[name], starts(body), CONTACTS[contact]
    kept = ("final", "end", "work_lost")
    found = sc.sweep.roll(body, state, 15.0, contact=table, losses=losses, want=kept, tol=1e-11)
    for i in range(COUNT):
        start = sc.State(*(one(x, i) for x in state._numbers))
        try:
            alone = sc.roll(body, start, [15.0], t0=0.0, contact=table, losses=law_of(losses, i), tol=1e-11)
        except ValueError:
            assert found["status"][i] in (sc.sweep.Status.INVALID, sc.sweep.Status.PAINLEVE)
            continue
        claim = float(found["error"][i]) + alone.error
        if not np.isfinite(claim):
            continue
        assert int(found["status"][i]) == int(alone.status), i
        y = alone.event.state if alone.event else None
        numbers = (alone.theta[-1], *alone.w[-1]) if y is None else (y.theta, y.w1, y.w2, y.w3)
        for key, x in zip(("theta", "w1", "w2", "w3"), numbers, strict=True):
            assert abs(float(found[key][i]) - float(x)) <= claim, (i, key)
        end = alone.event.time if alone.event else 15.0
        assert abs(float(found["end"][i]) - end) <= claim, i


def energy(body, states):
    """Energy of a rolling body, in M g R."""
    s, c = np.sin(states.theta), np.cos(states.theta)
    w1, w2, w3 = states.w1, states.w2, states.w3
    i1, ell = body.i1 + body.ell**2, body.ell
    turning = i1 * w1**2 + (body.i1 + 1 + ell**2) * w2**2 + (body.i3 + 1) * w3**2 - 2 * ell * w1 * w3
    return turning / 2 + s + ell * c


def test_what_is_missing_of_the_energy_has_been_lost():
    start = DISK.steady(np.linspace(0.1, 0.4, 50)).kicked(0.05)
    losses = loss.AirLinear(1e-2) + loss.DryContour(2e-3)
    found = sc.sweep.roll(DISK, start, 5.0, losses=losses, want=("final", "work_lost"))
    final = sc.State(*(found[x].to_numpy() for x in ("theta", "w1", "w2", "w3")))
    missing = energy(DISK, start) - energy(DISK, final)
    assert np.abs(missing - found["work_lost"].to_numpy()).max() < 1e-12
    assert (found["work_lost"] > 1e-3).all()
    # the integral of the power along a single motion
    alone = sc.roll(DISK, DISK.steady(0.1).kicked(0.05), [5.0], t0=0.0, losses=losses, tol=1e-12)
    assert abs(alone.work_lost[-1] - float(found["work_lost"][0])) < 1e-9


def test_no_bit_depends_on_threads_neighbours_or_order():
    theta, eps = np.linspace(0.15, 0.4, 300), np.geomspace(3e-3, 3e-2, 300)
    state, kept = DISK.steady(theta).kicked(0.05), ("final", "end", "work_lost")

    def ran(of, threads):
        start = sc.State(*(np.broadcast_to(x, theta.shape)[of] for x in state._numbers))
        found = sc.sweep.roll(DISK, start, 100.0, losses=loss.DryContour(eps[of]), want=kept, threads=threads)
        return np.stack([found[x].to_numpy().astype(float) for x in found.data_vars])

    order = np.arange(300)
    all_of_them = ran(order, 1)
    assert np.array_equal(ran(order, 2), all_of_them) and np.array_equal(ran(order, 3), all_of_them)
    mixed = (order * 77) % 300
    assert np.array_equal(ran(mixed, 2), all_of_them[:, mixed])
    assert np.array_equal(ran(mixed[:7], 1), all_of_them[:, mixed[:7]])
    assert np.array_equal(ran(mixed[:1], 1), all_of_them[:, mixed[:1]])


def test_a_whirr_whose_contact_stops_falls_flat():
    found = sc.sweep.roll(
        DISK,
        DISK.steady(np.linspace(0.2, 0.3, 9)),
        500.0,
        losses=loss.DryContour(5e-3),
        want=("final", "end"),
    )
    assert (found["status"] == sc.sweep.Status.FACE).all() and (np.diff(found["end"]) > 0).all()
    # held by dry friction at the end: w1 = s w_z vanishes with theta, where that of a whirr grows
    assert float(np.abs(found["w1"]).max()) < 1e-6 and float(np.abs(found["w3"]).max()) > 1e-3
    assert found.attrs["losses"] == "DryContour(0.005)" and (found["error"] < 1e-7).all()


def test_states_at_several_times_are_those_of_one_time_each():
    start, times = DISK.steady(np.linspace(0.2, 0.4, 6)).kicked(0.1), [0.0, 0.5, 4.0, 12.0]
    losses = loss.DryContour(2e-3)
    found = sc.sweep.roll(DISK, start, times, losses=losses)
    assert np.array_equal(found["theta"][:, 0], np.linspace(0.2, 0.4, 6))
    for j, t in enumerate(times[1:], 1):
        last = sc.sweep.roll(DISK, start, t, losses=losses)
        claim = found["error"] + last["error"]
        assert (np.abs(found["theta"][:, j] - last["theta"]) <= claim).all(), t


def test_coefficients_broadcast_with_bodies_and_states_by_name():
    xr = pytest.importorskip("xarray")
    eps = xr.DataArray([2e-3, 5e-3], dims="eps")
    theta = xr.DataArray([0.2, 0.3, 0.4], dims="theta")
    found = sc.sweep.roll(DISK, DISK.steady(theta), 5.0, losses=loss.DryContour(eps), want="work_lost")
    assert set(found["work_lost"].dims) == {"eps", "theta"} and (found["work_lost"] > 0).all()


def test_odd_starts_have_an_end_or_a_status():
    theta = np.array([0.3, 0.3, np.pi / 2, 1e-300, 1e-9, np.nan, 0.3, 0.3])
    w1 = np.array([0.0, 1e-300, 0.0, 0.0, 0.0, 1.0, 1e5, 0.5])
    w2 = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -40.0])
    for losses in LAWS.values():
        coefficients = sum(type(law)(one(law.coefficient, 0)) for law in losses.laws)
        start = sc.State(theta, w1, w2, 0.0)
        with pytest.warns(
            RuntimeWarning, match="^2 of 8 motions are invalid .* motion 3, .*: theta = 1e-300"
        ):
            found = sc.sweep.roll(DISK, start, 3.0, losses=coefficients, want=("final", "end"))
        status = found["status"].to_numpy()
        assert status[5] == sc.sweep.Status.INVALID and np.isnan(found["theta"][5])
        assert status[2] == sc.sweep.Status.SIDE and status[0] == sc.sweep.Status.FACE
        assert not np.isnan(found["theta"].to_numpy()[status != sc.sweep.Status.INVALID]).any()
    empty = sc.sweep.roll(DISK, sc.State(np.empty(0), 0.0, 0.0, 0.0), 1.0, losses=loss.DryContour(1e-3))
    assert empty["theta"].shape == (0,)


def test_what_makes_no_sense_with_losses_is_refused_before_any_work():
    state, dry = DISK.steady(0.3), loss.DryContour(1e-3)
    for kw, kind, text in [
        ({"losses": 1e-3}, TypeError, "^losses: expected a loss from sc.loss"),
        ({"losses": loss.DryContour}, TypeError, "^losses: expected a loss from sc.loss"),
        ({"losses": dry, "step": 1e-3}, ValueError, "^step, mu, beyond: cannot be combined with"),
        ({"losses": dry, "beyond": True}, ValueError, "^step, mu, beyond: cannot be combined with"),
        (
            {"losses": dry, "restitution": 1.1},
            ValueError,
            "^restitution = 1.1: expected None, or 0 <= restitution <= 1",
        ),
        ({"losses": dry, "stop_at": "rolling"}, ValueError, "^stop_at: needs contact"),
        ({"losses": dry, "contact": "sticky"}, ValueError, "^contact = 'sticky'"),
        ({"losses": dry, "want": "theta_max"}, ValueError, "^want = 'theta_max': expected some of"),
        ({"losses": dry, "want": "dissipated"}, ValueError, "^want = 'dissipated': expected some of"),
        ({"losses": dry, "mu": -1.0}, ValueError, "^mu = -1.0: expected 0 <= mu"),
        ({"losses": dry, "tol": 0.0}, ValueError, "^tol = 0"),
    ]:
        with pytest.raises(kind, match=text):
            sc.sweep.roll(DISK, state, 1.0, **kw)
    with pytest.raises(ValueError, match="eps = -0.001"):
        sc.sweep.roll(DISK, state, 1.0, losses=loss.DryContour([-1e-3]))
    with pytest.raises(ValueError, match="backward|from 0 on|t = -1"):
        sc.sweep.roll(DISK, state, -1.0, losses=dry)
    with pytest.raises(ValueError, match="shapes do not fit"):
        sc.sweep.roll(DISK, DISK.steady([0.2, 0.3]), 1.0, losses=loss.DryContour([1e-3, 2e-3, 3e-3]))
