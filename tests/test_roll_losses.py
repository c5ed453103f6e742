"""Motions with losses from Python: refusals, balance of energy, ends, and display."""

import copy
import math
import pickle

import numpy as np
import pytest
from loss_rows import USUAL

import spincyl as sc
from spincyl import loss

COIN, DISK, PIPE = sc.Body.solid(0.0), sc.Body.solid(0.1704), sc.Body.tube(6.0, bore=0.8)
ROUNDED, SPHERE = sc.Body.solid(1.5, fillet=0.3), sc.Body.ball(0.0, 0.4, 0.4)
DRY = USUAL["DryContour"]
LAWS = dict(USUAL)
LAWS["all"] = sum(LAWS.values())
CONTACTS = {
    "rolling": "rolling",
    "smooth": "smooth",
    "Coulomb": sc.Coulomb(0.2),
    "static": sc.Coulomb(0.2, static=0.4),
    "Viscous": sc.Viscous(0.3),
}
STARTS = {
    "disk": (DISK, DISK.steady(0.3).kicked(0.05)),
    "tube": (PIPE, PIPE.steady(1.4).kicked(0.02)),
    "rounded": (ROUNDED, ROUNDED.steady(1.2).kicked(0.03)),
}
SLIDES = sc.Body.solid(0.375).with_centre_velocity(sc.Body.solid(0.375).steady(0.9), 0.4, -0.9)
T = np.linspace(0, 20, 201)


def rolled(start="disk", losses=DRY, t=T, **how):
    return sc.roll(*STARTS[start], t, losses=losses, **how)


# Refusals.


@pytest.mark.parametrize(
    ("how", "error", "match"),
    [
        (
            {"losses": 5e-3},
            TypeError,
            r"^losses: expected a loss from sc.loss, such as sc.loss.DryContour\(1e-3\), .*, not float",
        ),
        ({"losses": [DRY, DRY]}, TypeError, ", not list$"),
        ({"losses": loss.DryContour}, TypeError, "^losses: expected a loss from sc.loss, .* not type"),
        ({"losses": loss.DryContour([1e-3, 2e-3])}, ValueError, "expected single coefficients, not arrays"),
        ({"losses": loss.DryContour([1e-3])}, ValueError, r"^losses = DryContour\(\[0.001\]\): expected"),
        (
            {"step": 1e-3},
            ValueError,
            r"^step = 0.001 cannot be combined with losses=DryContour\(0.005\): .* tol=",
        ),
        (
            {"method": "exact"},
            ValueError,
            "^method = 'exact' cannot be combined with losses=.*no first integrals",
        ),
        ({"method": "rk4", "tol": 1e-9}, ValueError, "^method = 'rk4': give step="),
        ({"t": [0.0, -1.0]}, ValueError, "^t = -1.0: expected at least t0 = 0.0"),
        ({"t": [5.0, 6.0], "t0": 7.0}, ValueError, "^t = 5.0: expected at least t0 = 7.0"),
        ({"t": [0.0, 2.0, 1.0]}, ValueError, "t"),
        ({"t": [0.0, math.nan]}, ValueError, "t"),
        ({"tol": 0.5}, ValueError, "tol"),
        ({"mu": -1.0}, ValueError, "mu"),
        ({"mu": math.nan}, ValueError, "mu"),
        ({"restitution": -0.1}, ValueError, "^restitution = -0.1: expected None, or 0 <= restitution <= 1"),
        ({"contact": sc.Coulomb(0.3), "mu": 0.3}, ValueError, "^mu = 0.3 cannot be combined with contact"),
        ({"contact": sc.Coulomb(0.3), "beyond": True}, ValueError, "^beyond = True cannot be combined with"),
        ({"contact": "sticky"}, ValueError, "^contact = 'sticky'"),
        ({"want": "energy"}, ValueError, "^want = 'energy'"),
    ],
)
def test_what_does_not_go_with_losses_is_refused(how, error, match):
    with pytest.raises(error, match=match):
        rolled(**how)


@pytest.mark.parametrize("contact", ["rolling", "smooth"])
def test_a_slip_is_refused_where_there_is_no_law_for_it(contact):
    with pytest.raises(ValueError, match="^state: the body slips"):
        sc.roll(sc.Body.solid(0.375), SLIDES, 1.0, losses=DRY, contact=contact)


def test_a_family_or_many_states_are_refused():
    with pytest.raises(ValueError, match="^body: expected a single body"):
        sc.roll(sc.Body.solid([0.1, 0.2]), DISK.steady(0.3), 1.0, losses=DRY)
    with pytest.raises(ValueError, match="^state: expected a single state"):
        sc.roll(DISK, DISK.steady([0.3, 0.4]), 1.0, losses=DRY)


@pytest.mark.parametrize("law", ["AirFilm", "BoundaryLayer"])
def test_a_ball_has_no_face_for_air_to_be_pressed_out_of(law):
    with pytest.raises(ValueError, match=r"^fillet = 1\.0: expected"):
        sc.roll(SPHERE, sc.State(1.2, 1.0, 0.3, 0.7), 1.0, losses=LAWS[law])


# Balance of energy.


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize("start", STARTS)
def test_energy_heat_and_work_lost_are_constant(start, contact, law):
    m = rolled(start, LAWS[law], contact=CONTACTS[contact])
    heat = m.dissipated if contact in ("Coulomb", "static", "Viscous") else 0.0
    whole = m.energy + m.work_lost + heat
    assert m.t.size > 1 and np.ptp(whole) <= 1e-13 * abs(whole[0]) + 10 * m.error
    assert np.ptp(whole) <= 2e-13 * abs(whole[0])
    assert m.work_lost[0] == 0 and np.all(np.diff(m.work_lost) >= 0) and m.work_lost[-1] > 0


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("contact", ["rolling", "smooth", "Coulomb"])
def test_work_lost_is_the_power_of_the_laws_over_time(law, contact):
    m = rolled(losses=LAWS[law], t=np.linspace(0, 2, 4001), contact=CONTACTS[contact], want="force")
    power = LAWS[law].power(m.body, m.states, m.normal)
    h = m.t[1] - m.t[0]
    simpson = h / 3 * (power[0] + 4 * power[1:-1:2].sum() + 2 * power[2:-1:2].sum() + power[-1])
    assert m.work_lost[-1] == pytest.approx(simpson, rel=1e-7)


@pytest.mark.parametrize("b", [0.01, 0.3])
def test_air_slows_a_sphere_as_an_exponential(b):
    start = sc.State(1.2, 1.0, 0.3, 0.7)
    m = sc.roll(SPHERE, start, np.linspace(0, 10, 101), losses=loss.AirLinear(b), contact="smooth")
    size = start.angular_velocity * np.exp(-b * m.t / 0.4)
    assert np.allclose(m.states.angular_velocity, size, rtol=1e-11)
    # in rolling, the moment is 0.4 for rotation about the vertical and 0.4 + 1 otherwise
    m = sc.roll(SPHERE, start, np.linspace(0, 10, 101), losses=loss.AirLinear(b))
    vertical = m.w[:, 0] * np.sin(m.theta) + m.w[:, 2] * np.cos(m.theta)
    level = np.sqrt((m.w**2).sum(axis=1) - vertical**2)
    assert np.allclose(vertical, vertical[0] * np.exp(-b * m.t / 0.4), rtol=1e-11)
    assert np.allclose(level, level[0] * np.exp(-b * m.t / 1.4), rtol=1e-11)


def test_the_claimed_error_holds_for_a_loose_tolerance():
    fine, rough = rolled(), rolled(tol=1e-6)
    off = np.abs(fine.y - rough.y).max()
    assert 1e-13 < off <= rough.error and fine.error < 1e-9
    assert rough.nfev < fine.nfev


# Ends.


@pytest.mark.parametrize("tol", [1e-10, 1e-12, 1e-14])
def test_the_claimed_error_holds_for_a_ball_that_slips_past_its_pole_under_dry_contour(tol):
    # It passes at 1e-11 rad, where the couple along the rim turns around; with max_step = T/40 and T/400 the DOP853 solution of
    # Newton's and Euler's equations in the laboratory differs by 8e-16.
    ball, slip = sc.Body.ball(0.3, i1=0.41, i3=0.29), (1.0191144642353, -0.8022225522535057)
    w = 0.006774199454874067, -0.6064994781183143, -0.0002939698336618509
    start = sc.State(3.081228146965839, *w, slip=slip)
    m = sc.roll(ball, start, [0.0, 0.25], contact=sc.Coulomb(0.06), losses=loss.DryContour(0.024), tol=tol)
    theta, w = 3.0528562933795835, (0.0005009171730152344, 0.5814024642075429, -0.0006528895369972301)
    slip = -0.9792736396089864, 0.7939617815526692
    off = max(abs(m.theta[1] - theta), *abs(m.w[1] - w), *abs(m.slip[1] - slip))
    assert off <= m.error < 1e-8


def test_a_whirr_whose_contact_stops_falls_flat_and_says_so():
    m = sc.roll(DISK, DISK.steady(0.3), np.linspace(0, 400, 2001), losses=DRY, want="force")
    assert m.status is sc.Ending.FACE == 1 and not m.success
    assert m.message.startswith("the face landed on the table: the body lies flat at t = ")
    assert "; found in steps with tolerance 1e-14; error about" in m.message
    y = m.event.state
    assert m.event.ending is sc.Ending.FACE and y.slip is None and y.theta == 0
    last = sc.roll(DISK, DISK.steady(0.3), m.event.time - np.geomspace(0.05, 1e-4, 40), t0=0.0, losses=DRY)
    held = abs(last.states.spin) <= 1e-12 * (1 + abs(last.states.precession))
    assert held[-1] and not held[0] and 0 < last.theta[-1] < last.theta[np.argmax(held)] < 5e-3
    assert m.t[-1] <= m.event.time < m.t[-1] + 0.2 + 1e-9 and m.t.size < 2001
    assert m.method == "dop853" and m.nfev > 100 and m.rk4 is None


def test_rolling_that_needs_more_than_mu_slips():
    m = sc.roll(DISK, DISK.steady(0.3), np.linspace(0, 100, 1001), losses=DRY, mu=0.2, want="force")
    assert m.status is sc.Ending.SLIP and m.friction_coefficient.max() <= 0.2
    on = sc.roll(DISK, DISK.steady(0.3), np.linspace(0, 100, 1001), losses=DRY, mu=0.2, beyond=True)
    assert on.event.time == pytest.approx(m.event.time) and on.t[-1] > m.event.time
    assert np.array_equal(on.y[:, : m.t.size], m.y)


def test_what_would_slip_slips_on_with_coulomb():
    m = sc.roll(DISK, DISK.steady(0.3), np.linspace(0, 40, 401), losses=DRY, contact=sc.Coulomb(0.2))
    kinds = [phase.kind for phase in m.phases]
    assert kinds[:2] == ["rolling", "slipping"] and m.dissipated[-1] > 0
    end = sc.roll(DISK, DISK.steady(0.3), np.linspace(0, 100, 1001), losses=DRY, mu=0.2).event
    assert m.phases[1].time == pytest.approx(end.time, abs=1e-9)
    assert "rolling from t = 0, slipping from t = " in m.message and "first integrals" not in m.message


def test_a_motion_that_loses_nothing_says_so():
    m = sc.roll(DISK, DISK.steady(0.3), 1.0)
    assert m.losses is None
    with pytest.raises(AttributeError, match=r"^work_lost: needs losses=; give losses="):
        m.work_lost
    slips = sc.roll(sc.Body.solid(0.375), SLIDES, 1.0, contact=sc.Coulomb(0.3))
    with pytest.raises(AttributeError, match="^work_lost: needs losses="):
        slips.work_lost


@pytest.mark.parametrize("contact", ["rolling", "smooth"])
def test_without_friction_there_are_no_phases_and_no_slip(contact):
    m = rolled(contact=contact)
    for name in ("phases", "phase", "slip", "dissipated"):
        with pytest.raises(
            AttributeError, match=f"^{name}: needs a law of friction, not contact = '{contact}'"
        ):
            getattr(m, name)
    assert m.states.slip is None


# Display.


def test_a_motion_keeps_its_losses_at_other_times_and_with_more_of_it():
    m = rolled(t0=0.0, t=[3.0, 7.0])
    assert m.losses == DRY and m.t.tolist() == [3.0, 7.0] and m.work_lost[0] > 0
    there = m.at([0.0, 3.0, 5.0, 7.0])
    assert there.losses == DRY and np.allclose(there.y[:, [1, 3]], m.y, atol=10 * m.error)
    assert np.allclose(there.work_lost[[1, 3]], m.work_lost, rtol=1e-12)
    more = m.wanting("pose", "force")
    assert np.allclose(more.y, m.y, rtol=1e-12) and more.phi[-1] > 1 and more.normal.shape == (2,)


def test_a_motion_with_losses_survives_pickling():
    m = rolled(t=[0.0, 1.0], want="pose")
    for again in (pickle.loads(pickle.dumps(m)), copy.deepcopy(m)):
        assert np.array_equal(again.work_lost, m.work_lost) and again.losses == m.losses
        assert repr(again) == repr(m) and np.array_equal(again.at(0.5).y, m.at(0.5).y)


def test_a_motion_with_losses_shows_them():
    m = rolled(t=2.0)
    assert ", theta, w, work_lost; the last time was reached; found in steps with tolerance 1e-14" in repr(m)
    assert "losses" in m._repr_html_() and "DryContour(0.005)" in m._repr_html_()
    table = rolled(want="pose").to_xarray()
    assert table.work_lost.units == "M g R" and table.attrs["losses"] == "DryContour(0.005)"
    assert table.attrs["contact"] == "rolling" and "slip" not in table
    rubbed = rolled(contact=sc.Coulomb(0.2)).to_xarray()
    assert {"work_lost", "dissipated", "slip", "phase"} <= {*rubbed.data_vars}


def test_files_have_the_work_lost(tmp_path):
    from spincyl.cli._files import columns, writer_of

    m = rolled(want=("pose", "force"))
    assert np.array_equal(columns(m, None)["work_lost"], m.work_lost)
    assert "work_lost" not in columns(sc.roll(DISK, DISK.steady(0.3), T, want=("pose", "force")), None)
    for suffix in (".csv", ".npz", ".nc", ".png"):
        writer_of(tmp_path / f"m{suffix}")(m, None, tmp_path / f"m{suffix}")
    with np.load(tmp_path / "m.npz") as found:
        assert np.array_equal(found["work_lost"], m.work_lost) and found["losses"] == "DryContour(0.005)"
    table = np.genfromtxt(tmp_path / "m.csv", delimiter=",", names=True)
    assert np.array_equal(table["work_lost"], m.work_lost)
