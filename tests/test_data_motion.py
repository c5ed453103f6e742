"""Friction, restitution, losses and start of a motion, found again from rough films of motions."""

import math
import re
import sys
import warnings

import numpy as np
import pytest

import spincyl as sc

BALL = sc.Body.ball(0.0, 0.4, 0.4).in_metres(0.046, radius=0.02)
FRAMES = np.arange(42) / 30
G = BALL.scale.gravity
TRUTH = {"mu": 0.05, "restitution": 0.8, "w3": -25.0, "slip_2": 1.5, "height": 0.4}


def tossed(mu, e, spin, speed, height, t=FRAMES, t0=0.0):
    """A ball with backspin that is dropped with a horizontal velocity."""
    start = sc.dropped(BALL, height, math.pi / 2, w3=spin, velocity=(0, speed, 0))
    return sc.roll(BALL, start, t, t0=t0, contact=sc.Coulomb(mu), restitution=e, want="pose")


def bounces(t, mu, e, spin, speed, height):
    """Height and place of the centre and angle of the ball by elementary mechanics, without the library.

    Impacts with Newton's restitution; the impulse of friction is mu times that of the normal force, or less if
    the slip ends: m dv = -J, (2/5) m r dw = J, which takes slip at 3.5 J/m (v and w such that v + r w slips).
    """
    r, out = 0.02, []
    y, z, vy, vz, w, angle, clock = 0.0, height, speed, 0.0, spin, 0.0, 0.0
    for now in t:
        while True:
            hits = clock + (vz + math.sqrt(vz**2 + 2 * G * max(z, 0.0))) / G
            if hits > now:
                break
            step = hits - clock
            y, angle, vz, z, clock = y + vy * step, angle + w * step, vz - G * step, 0.0, hits
            slip = vy - r * w
            pull = min(mu * (1 + e) * -vz, abs(slip) / 3.5) * math.copysign(1.0, slip)
            vy, w, vz = vy - pull, w + 2.5 * pull / r, -e * vz
        step = now - clock
        out.append((y + vy * step, z + vz * step - G * step**2 / 2 + r, angle + w * step))
    return np.array(out).T


def film(seed, t=FRAMES, **more):
    """A track of 30 frames a second with noise and frames in which the mark was lost; angles have no turns."""
    rng = np.random.default_rng(seed)
    y, z, psi = bounces(
        t, *({"mu": 0.05, "e": 0.8, "spin": -25.0, "speed": 1.0, "height": 0.4} | more).values()
    )
    table = {
        "t": t,
        "y": y + 0.002 * rng.normal(size=t.size),
        "z": z + 0.002 * rng.normal(size=t.size),
        "psi": (psi + 0.1 * rng.normal(size=t.size)) % (2 * np.pi),
    }
    table["y"][17:20] = table["z"][17:20] = np.nan
    return table


def test_the_elementary_bounces_are_those_of_the_library():
    m = tossed(0.05, 0.8, -25.0, 1.0, 0.4)
    y, z, psi = bounces(FRAMES, 0.05, 0.8, -25.0, 1.0, 0.4)
    np.testing.assert_allclose(m.centre[:, 1:], np.column_stack([y, z]), atol=1e-9)
    np.testing.assert_allclose(m.psi, psi, atol=1e-8)


@pytest.mark.parametrize(
    "films", [range(50), pytest.param(range(2000, 2300), marks=pytest.mark.long)], ids=len
)
def test_fitted_numbers_are_within_their_errors_two_times_of_three(films):
    guess, off = tossed(0.06, 0.75, -23.0, 1.1, 0.42), []
    for seed in films:
        found = sc.data.fit_motion(guess, film(seed), free=list(TRUTH))
        off.append([(found.values[name] - true) / found.errors[name] for name, true in TRUTH.items()])
        assert found.chi2 < 2 and all(math.isfinite(error) for error in found.errors.values())
    # of 50 films 0.68 +- 0.07 each, and hardly less for the mean of five that are correlated by up to 0.99
    share, wide = np.mean(np.abs(off) < 1, axis=0), 2.7 * 0.466 / math.sqrt(len(films))
    assert abs(share.mean() - 0.68) < 0.6 * wide and (np.abs(share - 0.68) < wide).all(), share
    spread = np.std(off, axis=0)  # of 50 films 1 +- 0.1
    assert (np.abs(spread - 1) < 2.5 / math.sqrt(2 * len(films))).all(), spread


def test_the_errors_are_those_of_the_scatter_of_many_films():
    guess = tossed(0.05, 0.8, -25.0, 1.0, 0.4)
    errors = {"y": 0.002, "z": 0.002, "psi": 0.1}
    found = [
        sc.data.fit_motion(guess, film(seed), free=["mu", "restitution"], errors=errors) for seed in range(25)
    ]
    for name in ("mu", "restitution"):
        spread = np.std([one.values[name] for one in found], ddof=1)
        assert spread == pytest.approx(found[0].errors[name], rel=0.4)
    correlation = np.corrcoef(*([one.values[name] for one in found] for name in ("mu", "restitution")))[0, 1]
    assert found[0].correlation("mu", "restitution") == pytest.approx(correlation, abs=0.5)


def test_wrong_marks_do_little_harm_with_a_soft_loss():
    guess, table = tossed(0.06, 0.75, -23.0, 1.1, 0.42), film(3)
    clean = sc.data.fit_motion(guess, table, free=list(TRUTH))
    for row, off in ((5, 0.3), (22, -0.2), (33, 0.25)):
        table["z"][row] += off
    with warnings.catch_warnings(action="ignore"):
        soft = sc.data.fit_motion(guess, table, free=list(TRUTH), loss="soft_l1")
    with pytest.warns(UserWarning, match="chi2 = .* are there wrong marks, or is the guess too far"):
        sc.data.fit_motion(guess, table, free=list(TRUTH))
    for name in TRUTH:
        assert abs(soft.values[name] - clean.values[name]) < 2 * clean.errors[name], name


def test_rows_may_be_in_any_order_and_a_table_has_its_units(tmp_path):
    table = film(1)
    guess = tossed(0.05, 0.8, -25.0, 1.0, 0.4)
    lines = ["frame name;t (ms);y (cm);z (mm);psi (°)"]
    rows = list(zip(*table.values(), strict=True))
    for k in np.random.default_rng(0).permutation(len(rows)):
        t, y, z, psi = rows[k]
        cells = [
            f"{x:.6f}".replace(".", ",").replace("nan", "")
            for x in (1e3 * t, 100 * y, 1e3 * z, math.degrees(psi))
        ]
        lines.append(";".join([f"frame {k}", *cells]))
    (tmp_path / "track.csv").write_text("\n".join(lines), "utf-8")
    read = sc.data.read_table(tmp_path / "track.csv")
    assert read.texts["frame name"][0].startswith("frame ")
    one, two = (sc.data.fit_motion(guess, x, free=["mu", "height"]) for x in (table, read))
    assert one.values == pytest.approx(two.values, rel=1e-4) and one.errors == pytest.approx(
        two.errors, rel=1e-2
    )
    order = np.argsort(read["t"])
    np.testing.assert_allclose(two.residual["z"][order], one.residual["z"], atol=1e-4)


def test_the_loss_and_the_start_of_a_disk_come_from_its_inclination_and_its_turns():
    disk = sc.measured(outer_diameter="75.1mm", length="12.8mm", mass="0.44kg")
    law, t = sc.loss.ViscousContour.from_si("4e-6Nms", scale=disk), np.arange(90) / 30
    true = sc.roll(disk, disk.steady(0.35).kicked(0.02), t, losses=law)
    guess = sc.roll(disk, disk.steady(0.33), t, losses=sc.loss.ViscousContour.from_si("3e-6Nms", scale=disk))
    start, within = true.start.in_si(disk), []
    for seed in range(12):
        rng = np.random.default_rng(seed)
        hertz = true.natural.states.precession / disk.scale.seconds(1.0) / (2 * np.pi)
        table = {
            "t": t,
            "theta": true.theta + 0.01 * rng.normal(size=90),
            "hertz": hertz * rng.normal(1, 0.01, 90),
        }
        table["theta"][30:40] = np.nan
        found = sc.data.fit_motion(guess, table, free=["ViscousContour", "theta", "w1", "w2", "w3"])
        truth = {"ViscousContour": 4e-6} | {name: start[name] for name in ("theta", "w1", "w2", "w3")}
        within.append([abs(found.values[name] - x) < 3 * found.errors[name] for name, x in truth.items()])
        assert found.units["ViscousContour"] == "N m s" and found.units["w1"] == "rad/s"
        again = sc.loss.ViscousContour.from_si(found.values["ViscousContour"], scale=disk)
        assert found.motion.losses is not None and float(again.coefficient) == pytest.approx(
            float(found.motion.natural.losses.laws[0].coefficient)
        )
    assert np.mean(within) > 0.9


def test_the_time_of_the_start_and_the_place_of_the_table_are_found():
    t = FRAMES[:28]
    y, z, _ = bounces(t, 0.05, 0.8, -25.0, 1.0, 0.4)
    x, turn = np.zeros(t.size), 0.3
    table = {
        "t": 10 + 0.037 + t,
        "x": 0.5 + np.cos(turn) * x - np.sin(turn) * y,
        "y": -0.2 + np.sin(turn) * x + np.cos(turn) * y,
        "z": z,
    }
    guess = tossed(0.05, 0.8, -25.0, 1.0, 0.4, t=11.0, t0=10.0)
    found = sc.data.fit_motion(
        guess, table, free=["t0", "x", "y", "phi0"], errors=dict.fromkeys("xyz", 0.001)
    )
    expected = {"t0": 10.037, "x": 0.5, "y": -0.2, "phi0": turn}
    assert found.values == pytest.approx(expected, abs=1e-5)


def test_what_the_points_do_not_determine_is_said():
    t = FRAMES[:8]  # before the first impact
    guess = tossed(0.05, 0.8, -25.0, 1.0, 0.4)
    track = {name: x for name, x in film(0, t).items() if name != "psi"}
    with pytest.warns(UserWarning, match="^mu: not determined, the points do not depend on it"):
        found = sc.data.fit_motion(guess, track, free=["mu", "height"])
    assert math.isinf(found.errors["mu"]) and math.isfinite(found.errors["height"])
    assert "mu: not determined" in found.undetermined[0] and "not determined" in found.report()
    # of a ball that flies only the velocity of the centre is seen, not its slip and spin
    with pytest.warns(UserWarning, match="^w3, slip_2: (the points do not determine them|.*correlation)"):
        sc.data.fit_motion(guess, track, free=["w3", "slip_2", "height"])
    with pytest.warns(UserWarning, match="^restitution: at its bound 0.7"):
        sc.data.fit_motion(
            tossed(0.05, 0.6, -25.0, 1.0, 0.4), film(0), free={"restitution": (0.5, 0.7), "mu": None}
        )


def test_a_bound_holds_and_a_number_that_is_not_free_stays():
    found = sc.data.fit_motion(
        tossed(0.05, 0.8, -25.0, 1.0, 0.4), film(2), free={"height": (0.3, 0.5), "w3": None}
    )
    assert 0.3 < found.values["height"] < 0.5 and set(found.values) == {"height", "w3"}
    assert found.motion._asked.restitution == 0.8 and found.motion.contact.mu == 0.05
    said = found.report()
    assert ("height" in said and "C(height, w3)" in said) or "[[Correlations]]" not in said
    assert max(map(len, said.splitlines())) <= 88


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (
            {"free": ["friction"]},
            "^free: 'friction' cannot be varied in this motion; expected some of theta, w1",
        ),
        ({"free": []}, "^free: expected at least one name"),
        (
            {"free": {"mu": (0.2, 0.3)}},
            "^free\\['mu'\\] = .*: expected bounds on both sides of the guess, 0.05",
        ),
        ({"measured": {"z": [1.0]}}, "^measured: expected a column 't'"),
        ({"measured": {"t": [0.0, 0.1, 0.2]}}, "^measured: expected a column besides 't'"),
        ({"measured": {"t": [0.0, 0.1, 0.2], "q": [1, 2, 3]}}, "^measured: 'q' is not an output of a motion"),
        (
            {"measured": {"t": [0.0, 0.1, 0.2], "z": [1.0, 2.0]}},
            "^measured: 'z' has shape \\(2,\\); expected 3 rows",
        ),
        (
            {"measured": {"t": [0.0, np.nan], "z": [1.0, 2.0]}},
            "^measured: 't' has to be a list of finite times",
        ),
        (
            {"measured": {"t": [0.0, 0.1], "z": [1.0, np.nan]}},
            "^measured: 1 values cannot determine 2 numbers",
        ),
        ({"errors": {"x": 0.1}}, "^errors: 'x' is not among the measured outputs"),
        ({"errors": {"z": -0.1}}, "^errors\\['z'\\]: expected positive numbers"),
        ({"loss": "square"}, "^loss = 'square': expected"),
    ],
)
def test_what_makes_no_sense_is_refused_by_its_name(change, told):
    good = {"guess": tossed(0.05, 0.8, -25.0, 1.0, 0.4), "measured": film(0), "free": ["mu", "height"]}
    with pytest.raises(ValueError, match=told):
        sc.data.fit_motion(**good | change)


def test_what_has_a_wrong_type_is_refused_by_its_name():
    good = {"guess": tossed(0.05, 0.8, -25.0, 1.0, 0.4), "measured": film(0), "free": ["mu"]}
    for change, told in (
        ({"guess": None}, "^guess: expected a Motion"),
        ({"measured": [1, 2]}, "^measured: expected a table"),
        ({"free": "mu"}, "^free: expected a list of names"),
        ({"free": {"mu": 0.3}}, "^free\\['mu'\\]: expected None or a pair"),
    ):
        with pytest.raises(TypeError, match=told):
            sc.data.fit_motion(**good | change)


def test_without_scipy_the_message_says_how_to_install_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "scipy.optimize", None)
    with pytest.raises(ImportError, match=re.escape("'spincyl[lab]'")):
        sc.data.fit_motion(tossed(0.05, 0.8, -25.0, 1.0, 0.4), film(0), free=["mu"])
