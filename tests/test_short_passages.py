"""Short passages beyond an end, and motions that hardly move: results of sweeps at any tolerance."""

import numpy as np
import pytest

import spincyl as sc
from spincyl import loss
from spincyl.sweep import Status

COUNT = 80
TABLES = {
    "air": ("rolling", loss.AirLinear(1e-3)),
    "dry": ("rolling", loss.DryContour(1e-3)),
    "rolling resistance": ("rolling", loss.RollingResistance(1e-3)),
    "smooth": ("smooth", loss.AirLinear(1e-3)),
    "Coulomb": (sc.Coulomb(0.3), None),
    "viscous": (sc.Viscous(0.5), None),
}


def peaks(bodies, state, how):
    """Times and heights of the maxima of motions without ends, from parabolas through dense points."""
    free = sc.Body(*bodies, theta_end=3.0)
    t = np.linspace(0, 0.4, 401)[1:]
    theta = sc.sweep.roll(free, state, t, want="states", tol=1e-13, **how)["theta"].to_numpy()
    most = np.nanargmax(theta, axis=1)
    k = np.clip(most, 1, t.size - 2)
    below, here, above = (theta[np.arange(len(theta)), k + j] for j in (-1, 0, 1))
    bend = below - 2 * here + above
    # a maximum at an end of the interval does not count
    top = np.where(k == most, t[k] + 0.5 * t[0] * (below - above) / bend, np.nan)
    return top, here - (below - above) ** 2 / (8 * bend)


@pytest.mark.parametrize("name", TABLES)
def test_a_sweep_sees_a_short_passage_over_the_side_wherever_it_lies(name):
    contact, law = TABLES[name]
    how = {"contact": contact} | ({"losses": law} if law else {})
    rng = np.random.default_rng(9)
    i3 = rng.uniform(0.5, 2.0, COUNT)
    ell, i1 = rng.uniform(0.1, 1.0, COUNT), i3 * rng.uniform(0.8, 1.7, COUNT)
    slip = None if isinstance(contact, str) else tuple(rng.normal(size=(2, COUNT)) * 0.1)
    # these turn back soon after theta = pi/2, since I3 w1 w3 > ell
    w1 = rng.uniform(0.2, 0.8, COUNT)
    w3 = ell / (i3 * w1) * rng.uniform(1.05, 1.5, COUNT)
    over, rise = 10 ** rng.uniform(-9, -6, COUNT), 10 ** rng.uniform(-4, -2, COUNT)
    theta = np.full(COUNT, np.pi / 2 - 1e-5)
    for _ in range(4):
        state = sc.State(theta, w1, -rise, w3, slip=slip)
        top, high = peaks((ell, i1, i3), state, how)
        theta = theta - (high - np.pi / 2 - over)
    some = (
        (top > 0.003) & (top < 0.3) & (state.theta < np.pi / 2) & (abs(high - np.pi / 2 - over) < 0.1 * over)
    )
    assert some.sum() > COUNT / 4
    for tol in (1e-10, 1e-13):
        for t in (0.35, 1.0, 15.0):
            found = sc.sweep.roll(sc.Body(ell, i1, i3), state, t, tol=tol, want="end", **how)
            ends, first = found["status"].to_numpy()[some], found["end"].to_numpy()[some]
            assert (ends == Status.SIDE).all(), (tol, t, np.flatnonzero(ends != Status.SIDE))
            assert (first < top[some]).all()


def test_a_passage_near_the_start_does_not_depend_on_the_last_time():
    body = sc.Body(np.array([0.18087413046504128]), 3.62732403691832, 2.0876587238087057)
    state = sc.State(1.5707905836630245, 0.18560696054511233, -0.0005089253734687524, 0.4987611126465189)
    for t in (0.03, 0.1, 15.0):
        for tol in (1e-6, 1e-10, 1e-14):
            found = sc.sweep.roll(body, state, t, losses=loss.AirLinear(1e-3), tol=tol, want="end")
            # theta exceeds pi/2 by up to 3.7e-7 from 0.0181 to 0.0183
            assert found["status"][0] == Status.SIDE and abs(found["end"][0] - 0.018117) < 2e-4


def test_what_slips_until_its_face_lands_slips_all_the_time():
    for shape, y, slip, mu in (
        (
            (5.1, 0.5186552538199316, 0.2790395259051783),
            (0.00037020918359048643, 0.007452019172703003, 6.198977002714435e-06, 2.78913543436887),
            (-0.8320081308474209, 0.0),
            0.1,
        ),
        ((0.0, 0.25, 0.5), (3.354195617136525e-08, 0.0, 0.0, 0.0), (-0.0451, -0.0368), 0.5),
    ):
        how = {"contact": sc.Coulomb(mu), "tol": 1e-12, "want": ("end", "slip_time", "phases")}
        found = sc.sweep.roll(sc.Body(np.array(shape[:1]), *shape[1:]), sc.State(*y, slip=slip), 13.0, **how)
        assert found["status"][0] == Status.FACE and found["phases"][0] == 1
        assert found["slip_time"][0] == found["end"][0]


#: ell, i1, i3, fillet; state; slip; contact; law; time
STIFF = {
    "a boundary layer under Coulomb friction": (
        (0.0, 0.28, 0.43, 0.5),
        (0.5, 1.0, 0.0, 0.3),
        (0.0, 0.0),
        sc.Coulomb(0.8),
        loss.BoundaryLayer(0.06),
        10.0,
    ),
    "drilling and a boundary layer on a smooth table": (
        (1.8805274882890681, 2.4531376234328803, 0.4738528884486792, 0.9986528113849098),
        (0.00013078115035629039, -1e-16, 1e-300, 1e-300),
        None,
        "smooth",
        loss.Drilling(0.0008071277292680389) + loss.BoundaryLayer(0.007049878394562237),
        1.9,
    ),
    "a film of air in a slip": (
        (1.5120324102690683, 0.657635974737848, 0.8999913293699442, 0.9754967414675626),
        (3.633801943725222e-05, 0.0011652248757929619, 2.655429913267695e-10, 0.11812076921093528),
        (0.12443509456869431, 0.1796485550060943),
        sc.Coulomb(0.3, static=0.6),
        loss.AirFilm(0.0028098878274330965),
        4.4,
    ),
    "a rod that hardly leans": (
        (7.286122438929484, 18.10586006502391, 0.82, 0.0),
        (5.657249034782852e-06, -1e-16, 0.0, 0.0),
        (0.0, -0.09314067817015219),
        sc.Coulomb(0.09204842716646532),
        None,
        60.0,
    ),
}


@pytest.mark.filterwarnings("ignore::spincyl.ErrorWarning")  # where no claim is required
@pytest.mark.parametrize("name", STIFF)
def test_what_a_fine_tolerance_follows_to_its_end_a_coarse_one_does(name):
    (ell, i1, i3, fillet), y, slip, contact, law, t = STIFF[name]
    state, how = sc.State(*y, slip=slip), {"contact": contact, "losses": law}
    finest = sc.roll(sc.Body(ell, i1, i3, fillet=fillet), state, t, **how)
    for tol in (1e-13, 1e-12, 1e-11, 1e-10, 1e-8, 1e-6):
        found = sc.sweep.roll(
            sc.Body(np.array([ell]), i1, i3, fillet=fillet), state, t, tol=tol, want="end", **how
        )
        assert found["status"][0] == finest.event.ending == sc.Ending.FACE, tol
        both = float(found["error"][0]) + finest.error
        if 30 * tol > y[0]:
            continue  # an inclination of the order of the tolerance: no claim is required
        assert abs(found["end"][0] - finest.event.time) <= 1.5 * both < 1e-2, tol
