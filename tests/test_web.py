"""The core of the live page is that of the package: built from these sources, with the same results.

Region codes are equal. Motions differ by less than both claimed errors, although sine and cosine come from
another library. Besides the committed core, one newly built by `make core` is compared if it exists.
"""

import importlib.util
import json
from pathlib import Path

import browser
import core
import numpy as np
import pytest

import spincyl as sc

HOME = Path(__file__).parents[1]
COMMITTED = HOME / "python/spincyl/studio/pages/cores"
ANEW = HOME / "target/cores"
ENDLESS, NONE = np.inf, np.nan
HALF = np.pi / 2

pytestmark = pytest.mark.skipif(not core.runs() and not browser.checking(), reason=browser.MISSING)


def sources():
    known = importlib.util.spec_from_file_location("build", HOME / "web/build.py")
    build = importlib.util.module_from_spec(known)
    known.loader.exec_module(build)
    return build.sources()


def test_the_committed_core_was_built_from_these_sources():
    made = json.loads((COMMITTED / "core.json").read_text())
    assert made["sources"] == sources(), "core.lzma is older than src: run `make web`"


@pytest.fixture(
    scope="module", params=[COMMITTED, ANEW] if ANEW.exists() else [COMMITTED], ids=lambda of: of.name
)
def ask(request):
    path = request.param / "core.friction.lzma"
    return lambda *questions: core.ask(path.read_bytes(), questions)


def test_the_lean_core_gives_the_same_answers_but_knows_no_friction():
    state, map_asked = (1.3, *STEADY[1:]), ("map", (60, 50, 0.3, 3.0, 0.0, HALF, 0.5, 0.0))
    asked = [map_asked, ("tube", (2.5, 0.0, 0.0)), ("start", (*state, 0.0, 0.0, 0.0, ENDLESS, 0.0, 20.0, 9, NONE)),
             ("follow", (9, 0.0, 20.0)), ("start", (*state, 0.0, 0.0, 2.0, 0.3, 0.0, 20.0, 9, NONE))]  # fmt: skip
    lean, full = (
        core.ask((COMMITTED / name).read_bytes(), asked) for name in ("core.lzma", "core.friction.lzma")
    )
    assert [x.code for x in lean] == [0, 0, 0, 0, 12] and full[-1].code == 0
    for one, other in zip(lean[:-1], full[:-1], strict=True):
        np.testing.assert_array_equal(one.out, other.out)
        np.testing.assert_array_equal(one.codes, other.codes)


@pytest.mark.parametrize(("bore", "fillet"), [(0.0, 0.0), (0.8, 0.0), (0.0, 0.3)])
def test_all_region_codes_of_a_map_are_those_of_the_package(ask, bore, fillet):
    w, h, low, high = 400, 300, 0.31, 3.0
    theta, ell = (np.arange(h) + 0.5) / h * HALF, low + (high - low) * (np.arange(w) + 0.5) / w
    theta = 0.0 + (HALF - 0.0) * (np.arange(h) + 0.5) / h
    (answer,) = ask(("map", (w, h, low, high, 0.0, HALF, bore, fillet)))
    native = sc.sweep.portrait(theta=theta, ell=ell, bore=bore, fillet=fillet, want="region").region
    assert answer.code == 0
    assert len(np.unique(answer.codes)) >= 4
    np.testing.assert_array_equal(answer.codes.reshape(h, w), native)


BODIES = {
    "cylinder": (("tube", (2.5, 0.0, 0.0)), sc.Body.solid(2.5)),
    "pipe": (("tube", (6.0, 0.8, 0.0)), sc.Body.tube(6.0, bore=0.8)),
    "disk": (("tube", (0.0852, 0.0, 0.0)), sc.Body.solid(0.0852)),
    "rounded": (("tube", (1.5, 0.0, 0.3)), sc.Body.solid(1.5, fillet=0.3)),
    "balls": (("body", (1.0, 1.4, 0.4, 1.0, HALF)), sc.Body.balls()),
}


@pytest.mark.parametrize("which", BODIES)
def test_steady_states_are_those_of_the_package(ask, which):
    given, body = BODIES[which]
    theta = 0.2 if which == "disk" else 1.45
    first, rest, rates, circle = ask(
        given, ("at_rest", (theta,)), ("by_rate", (1.3,)), ("circular", (theta, 1.7))
    )
    assert [x.code for x in (first, rest, rates, circle)] == [0, 0, 0, 0]
    np.testing.assert_allclose(first.out[:4], [body.ell, body.i1, body.i3, body.fillet], rtol=1e-15)
    state = body.steady(theta)
    np.testing.assert_allclose(rest.out[5:8], [state.w1, state.w2, state.w3], rtol=1e-13)
    assert rest.out[0] == body.region(theta)
    np.testing.assert_allclose(rest.out[1], body.rate(theta), rtol=1e-13)
    found = np.asarray(body.inclinations(1.3))
    np.testing.assert_allclose(rates.out, found[~np.isnan(found)], rtol=1e-13)
    turning = body.circular(theta, precession=1.7)
    np.testing.assert_allclose(circle.out[5:8], [turning.w1, turning.w2, turning.w3], rtol=1e-13)


WIDE = 18  # numbers in a row


def compared(ask, given, start, table, mu, native, losses=(0, 0.0), bounce=NONE, patch=0.0, slope=(0.0, 0.0)):
    """Compare both motions at the same times, within both claimed errors."""
    t = native.t
    end = 20.0
    answers = ask(
        given,
        ("losses", losses),
        ("slope", slope),
        ("start", (*start, table, mu, patch, end, 301, bounce)),
        ("follow", (301, 0.0, end)),
        ("follow", (7, 0.123, 0.9 * end)),
        ("poses", (0.0, end, 301)),
    )
    assert [x.code for x in answers] == [0] * 7
    told, rows, few, poses = answers[3].out, answers[4].out.reshape(-1, WIDE), answers[5].out, answers[6].out
    assert told[1] == native.status
    np.testing.assert_array_equal(rows[:, 0], t)
    off = np.abs(np.column_stack([rows[:, 1] - native.theta, rows[:, 2:5] - native.w])).max()
    # an estimate from two runs may be a little short
    assert off <= 1.5 * (told[8] + native.error)
    away = [rows[:, 5] - native.phi, rows[:, 6] - native.psi, *(rows[:, 7:9] - native.contact_point).T]
    assert np.abs(away).max() <= told[9] + native.pose_error
    np.testing.assert_allclose(rows[:, 9], native.normal, atol=1e3 * (told[8] + native.error))
    poses = poses.reshape(-1, 6)
    np.testing.assert_array_equal(poses[:, 0], t)
    turned = (poses[:, 2:4] - rows[:, 5:7] + np.pi) % (2 * np.pi) - np.pi
    assert np.abs(turned).max() < 1e-12
    return told, rows, few.reshape(-1, WIDE)


TIMES = 20.0 * (np.arange(301) / 300.0)
WANT = ("pose", "force")


@pytest.mark.parametrize("which", BODIES)
@pytest.mark.parametrize("contact", ["rolling", "smooth"])
def test_exact_motions_agree_within_the_error_that_they_state(ask, which, contact):
    given, body = BODIES[which]
    state = body.steady(0.2 if which == "disk" else 1.45).kicked(0.02)
    native = sc.roll(body, state, TIMES, contact=contact, want=WANT)
    start = (state.theta, state.w1, state.w2, state.w3, 0.0, 0.0)
    told, _, few = compared(ask, given, start, int(contact == "smooth"), ENDLESS, native)
    assert told[0] == 0.0
    there = sc.roll(body, state, few[:, 0], t0=0.0, contact=contact)
    assert np.abs(few[:, 1] - there.theta).max() <= told[8] + there.error


LOSSES = {
    "ice": ("smooth", 1, ENDLESS, sc.loss.AirLinear(1e-2), (4, 1e-2)),
    "rubber": ("rolling", 0, ENDLESS, sc.loss.RollingResistance(2e-3), (2, 2e-3)),
    "table": (sc.Coulomb(0.2), 2, 0.2, None, (0, 0.0)),
    "wet": (sc.Viscous(0.4), 3, 0.4, None, (0, 0.0)),
    "wet and worn": (sc.Viscous(0.4), 3, 0.4, sc.loss.DryContour(1e-3), (0, 1e-3)),
    "worn": (sc.Coulomb(0.2), 2, 0.2, sc.loss.DryContour(1e-3), (0, 1e-3)),
    "a wide patch": (sc.Coulomb(0.2, patch=0.1), 2, 0.2, None, (0, 0.0)),
    "a patch": (sc.Coulomb(0.2, patch=0.01), 2, 0.2, None, (0, 0.0)),
    "a small patch, worn": (sc.Coulomb(0.2, patch=1e-4), 2, 0.2, sc.loss.DryContour(1e-3), (0, 1e-3)),
}


@pytest.mark.parametrize("which", ["cylinder", "disk", "rounded"])
@pytest.mark.parametrize("table", LOSSES)
def test_motions_that_slip_or_lose_energy_agree_within_the_error_that_they_state(ask, which, table):
    given, body = BODIES[which]
    contact, code, mu, loss, losses = LOSSES[table]
    state = body.steady(0.2 if which == "disk" else 1.35).kicked(0.05)
    slip = (0.3, -0.1) if code >= 2 else (0.0, 0.0)
    state = sc.State(state.theta, state.w1, state.w2, state.w3, slip=slip)
    native = sc.roll(body, state, TIMES, contact=contact, losses=loss, want=WANT)
    start = (state.theta, state.w1, state.w2, state.w3, *slip)
    patch = getattr(contact, "patch", 0.0)
    told, rows, few = compared(ask, given, start, code, mu, native, losses, patch=patch)
    assert told[0] == 1.0
    # a time between two rows is computed from the row before it
    there = sc.roll(body, state, few[:, 0], t0=0.0, contact=contact, losses=loss, want=WANT)
    assert np.abs(few[:, 1] - there.theta).max() <= 2 * told[8] + there.error
    assert np.abs(few[:, 7:9] - there.contact_point).max() <= 2 * told[9] + there.pose_error
    # energy plus losses is constant
    whole = rows[:, 13] + rows[:, 15]
    assert np.ptp(whole) < 1e-8 * np.abs(whole).max()


TUBE = sc.Body.tube(6.0, bore=0.8)
FALLS = sc.State(0.6, 0.5, 0.3, 0.2, slip=(0.3, -0.1))
ALOFT = {
    "hops": ("pipe", sc.flicked(TUBE, w1=3.0, launch=3.0), sc.Coulomb(0.3), 2, 0.3, {1, 2}),
    "lies": ("pipe", sc.flicked(TUBE, w1=3.0, launch=0.9), sc.Coulomb(0.3), 2, 0.3, {3}),
    "lies and rises": ("pipe", sc.flicked(TUBE, w1=3.0, launch=1.02), sc.Coulomb(0.3), 2, 0.3, {1}),
    "falls on its other rim": ("cylinder", FALLS, sc.Coulomb(0.2), 2, 0.2, {0, 1, 2}),
    "falls on a wet table": ("cylinder", FALLS, sc.Viscous(0.4), 3, 0.4, {1, 2}),
    "rounded": ("rounded", FALLS, sc.Coulomb(0.2), 2, 0.2, {1, 2}),
    "rolls on its side": ("cylinder", sc.State(HALF, 0.4, 0.0, 1.0, slip=(0.0, 0.3)), sc.Coulomb(0.3), 2, 0.3, {3, 5}),
}  # fmt: skip


@pytest.mark.parametrize("which", ALOFT)
def test_flights_impacts_and_lying_agree_within_the_error_that_they_state(ask, which):
    name, state, contact, code, mu, kinds = ALOFT[which]
    given, body = BODIES[name]
    how = {"contact": contact, "restitution": 0.5, "want": WANT}
    native = sc.roll(body, state, TIMES, **how)
    start = (state.theta, state.w1, state.w2, state.w3, *state.slip)
    told, rows, few = compared(ask, given, start, code, mu, native, bounce=0.5)
    assert {*rows[:, 14]} >= kinds
    np.testing.assert_array_equal(rows[:, 14], native.phase)
    assert np.abs(rows[:, 16] - native.height).max() <= told[8] + native.error
    # the rim that is down is the one about which the body's axes are turned
    axes = (
        native.orientation[:, 1] * native.orientation[:, 3]
        + native.orientation[:, 0] * native.orientation[:, 2]
    )
    across = -np.sin(native.theta) * np.cos(native.phi) * np.where(rows[:, 17], -1, 1)
    assert np.abs(2 * axes - across).max() < 1e-6
    # bounces that hardly change anything are summed a little earlier on the page
    assert (told[16] > 0) == (len(native.impacts) > 0) and told[16] <= len(native.impacts)
    np.testing.assert_allclose(told[17], native.lost_in_impacts[-1], rtol=1e-5, atol=1e-9)
    # a time between two rows is computed from a row before it, be it in the air or on both rims
    there = sc.roll(body, state, few[:, 0], t0=0.0, **how)
    assert (
        np.abs(few[:, [1, 16]] - np.column_stack([there.theta, there.height])).max()
        <= 2 * told[8] + there.error
    )
    turned = (few[:, 5:7] - np.column_stack([there.phi, there.psi]) + np.pi) % (2 * np.pi) - np.pi
    off = np.column_stack([turned, few[:, 7:9] - there.contact_point])
    assert np.abs(off).max() <= 2 * told[9] + there.pose_error
    np.testing.assert_array_equal(few[:, 14], there.phase)
    whole = rows[:, 13] + rows[:, 15]
    assert np.ptp(whole) < 1e-8 * np.abs(whole).max()


ROLLS_DOWN = sc.State(HALF, 0.1, 0.0, 0.4)
SLOPES = {
    "rolls": ("disk", sc.State(1.2, 0.5, 0.0, 1.5), "rolling", 0, ENDLESS, None, (0, 0.0), NONE),
    "slides on ice": ("cylinder", sc.State(1.35, 1.0, 0.1, 2.0), "smooth", 1, ENDLESS, None, (0, 0.0), NONE),
    "slips": ("cylinder", sc.State(1.35, 1.0, 0.1, 2.0, slip=(0.3, -0.1)), sc.Coulomb(0.5), 2, 0.5, None, (0, 0.0), 0.5),
    "is wet": ("rounded", sc.State(1.2, 0.4, 0.0, 1.0, slip=(0.2, 0.1)), sc.Viscous(0.4), 3, 0.4, None, (0, 0.0), 0.5),
    "loses": ("disk", sc.State(1.2, 0.5, 0.0, 1.5), "rolling", 0, ENDLESS, sc.loss.RollingResistance(2e-3), (2, 2e-3), NONE),
    "hops": ("pipe", sc.flicked(TUBE, w1=3.0, launch=3.0), sc.Coulomb(0.3), 2, 0.3, None, (0, 0.0), 0.5),
    "lies": ("cylinder", ROLLS_DOWN, sc.Coulomb(0.6), 2, 0.6, None, (0, 0.0), 0.5),
}  # fmt: skip


@pytest.mark.parametrize("which", SLOPES)
def test_motions_on_a_slope_agree_within_the_error_that_they_state(ask, which):
    name, state, contact, code, mu, loss, losses, bounce = SLOPES[which]
    given, body = BODIES[name]
    slope = 0.1, -1.2
    how = {"contact": contact, "losses": loss, "table": sc.Table(slope[0], phi0=slope[1]), "want": WANT}
    how |= {} if np.isnan(bounce) else {"restitution": bounce}
    native = sc.roll(body, state, TIMES, **how)
    slip = (0.0, 0.0) if state.slip is None else state.slip
    start = (state.theta, state.w1, state.w2, state.w3, *slip)
    told, rows, few = compared(ask, given, start, code, mu, native, losses=losses, bounce=bounce, slope=slope)
    assert told[0] == 1.0 and np.ptp(native.contact_point, axis=0).max() > 1.0
    # a time between two rows is computed from the row before it, with its heading and from its place
    there = sc.roll(body, state, few[:, 0], t0=0.0, **how)
    assert np.abs(few[:, 1] - there.theta).max() <= 2 * told[8] + there.error
    turned = (few[:, 5:7] - np.column_stack([there.phi, there.psi]) + np.pi) % (2 * np.pi) - np.pi
    off = np.column_stack([turned, few[:, 7:9] - there.contact_point])
    assert np.abs(off).max() <= 2 * told[9] + there.pose_error
    np.testing.assert_allclose(rows[:, 13], native.energy, rtol=0, atol=1e3 * (told[8] + native.error))
    whole = rows[:, 13] + rows[:, 15]
    assert np.ptp(whole) < 1e-8 * max(1.0, np.abs(whole).max())


def test_a_slope_needs_friction_in_the_core_and_stays_until_it_is_set_again(ask):
    given, start = BODIES["cylinder"][0], (1.3, *STEADY[1:], 0.0, 0.0, 0.0, ENDLESS, 0.0, 9.0, 9, NONE)
    patch = (*start[:6], 2.0, 0.3, 0.1, 9.0, 9, NONE)
    asked = [given, ("slope", (0.1, 0.5)), ("start", start), ("start", patch), ("slope", (2.0, 0.0)), ("start", start),
             ("slope", (0.0, 0.0)), ("start", start)]  # fmt: skip
    _, _, tilted, on_patch, _, upright, _, level = ask(*asked)
    assert [x.code for x in (tilted, on_patch, upright, level)] == [0, 0, 1, 0]
    assert upright.words[0] == "slope"
    assert tilted.out[0] == 1.0 and level.out[0] == 0.0
    *_, refused = core.ask((COMMITTED / "core.lzma").read_bytes(), asked[:3])
    assert refused.code == 12


CUP = sc.Body.frustum(0.7, 1.0, 2.0)
LIES = float(CUP.borders[0])


@pytest.mark.parametrize(
    ("state", "kinds"),
    [
        (sc.State(LIES, 0.3 * np.sin(LIES), 0.0, -0.3 * np.sin(LIES) * np.tan(LIES)), {6}),
        (sc.State(LIES, 0.5 * np.sin(LIES), 0.0, 0.5 * np.cos(LIES)), {3, 6}),
        (sc.State(1.0, 0.1, 0.0, 0.3), {2, 6}),
        (sc.State(1.8, 0.4, 0.0, -0.8), {1}),
    ],
)
def test_a_cup_tips_lies_and_rolls_round_its_apex_within_the_error_that_it_states(ask, state, kinds):
    how = {"contact": sc.Coulomb(0.6), "restitution": 0.5, "want": WANT}
    native = sc.roll(CUP, state, TIMES, **how)
    start = (state.theta, state.w1, state.w2, state.w3, 0.0, 0.0)
    given = ("frustum", (0.7, 1.0, 2.0))
    told, rows, few = compared(ask, given, start, 2, 0.6, native, bounce=0.5)
    assert {*rows[:, 14]} >= kinds
    np.testing.assert_array_equal(rows[:, 14], native.phase)
    np.testing.assert_array_equal(rows[:, 17], native.rim)
    there = sc.roll(CUP, state, few[:, 0], t0=0.0, **how)
    assert np.abs(few[:, 1] - there.theta).max() <= 2 * told[8] + there.error
    assert np.abs(few[:, 7:9] - there.contact_point).max() <= 2 * told[9] + there.pose_error
    whole = rows[:, 13] + rows[:, 15]
    assert np.ptp(whole) < 1e-8 * np.abs(whole).max()


def test_without_a_restitution_a_motion_ends_where_it_leaves_the_table_or_lands(ask):
    start = (FALLS.theta, FALLS.w1, FALLS.w2, FALLS.w3, *FALLS.slip, 2.0, 0.2, 0.0, 20.0, 301)
    _, ends, rolls = ask(BODIES["cylinder"][0], ("start", (*start, NONE)), ("start", (*start, 0.0)))
    native = sc.roll(BODIES["cylinder"][1], FALLS, TIMES, contact=sc.Coulomb(0.2))
    assert ends.out[1] == native.status == sc.Ending.SIDE and rolls.out[1] == 0
    assert 0 <= ends.out[2] - native.t[-1] < TIMES[1]
    assert ends.out[16] == 0 < rolls.out[16]


ROW, HEADER = 17, 18  # numbers in a row of a stone, and before the first row


@pytest.mark.parametrize(("twist", "spin"), [(2.0, -5.0), (2.0, 5.0), (0.0, -5.0), (-4.5, 5.0)])
def test_a_rattleback_rolls_and_rocks_as_the_package_says_within_the_error_that_it_states(ask, twist, spin):
    stone = sc.Ellipsoid.rattleback((0.07, 0.014, 0.012), twist=np.radians(twist))
    spin, push, end = spin * (0.07 / 9.80665) ** 0.5, np.radians(0.02), 230.0
    (answer,) = ask(("rattleback", (0.07, 0.014, 0.012, np.radians(twist), spin, push, end, 2401)))
    assert answer.code == 0
    head, rows = answer.out[:HEADER], answer.out[HEADER:].reshape(-1, ROW)
    np.testing.assert_allclose(head[:3], stone.semi_axes, rtol=1e-15)
    i = np.asarray(stone.inertia)
    np.testing.assert_allclose(head[3:9], i[[0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]], atol=1e-16)
    rocking = stone.rocking(spin)
    np.testing.assert_allclose(head[13:15], rocking.growth, atol=1e-9)
    np.testing.assert_allclose(head[15:17], rocking.frequency, atol=1e-9)
    native = sc.roll(stone, stone.spinning(spin, pitch=push, roll=push), rows[:, 0], want=("pose", "force"))
    assert native.t.size == len(rows) == 2401 and head[17] < 0.05
    most = head[17] + native.error + native.pose_error
    q = native.orientation * np.sign(np.sum(native.orientation * rows[:, [1, 2, 3, 6]], axis=1))[:, None]
    assert np.abs(q - rows[:, [1, 2, 3, 6]]).max() < most
    assert np.abs(native.centre[:, :2] - rows[:, 4:6]).max() < most
    assert np.abs(native.spin - rows[:, 13]).max() < 2 * most
    up = np.cos(native.inclinations[:, :2])
    assert np.abs(up - rows[:, 14:16]).max() < 2 * most
    assert np.abs(native.normal - rows[:, 16]).max() < 50 * most
    # a cubic interpolates between rows
    h = np.diff(rows[:, 0])[:, None]
    a, b, ra, rb = rows[:-1, 1:7], rows[1:, 1:7], rows[:-1, 7:13], rows[1:, 7:13]
    between = (a + b) / 2 + h * (ra - rb) / 8
    there = sc.roll(
        stone,
        stone.spinning(spin, pitch=push, roll=push),
        rows[:-1, 0] + h[:, 0] / 2,
        t0=0.0,
        want="pose",
    )
    q = there.orientation * np.sign(np.sum(there.orientation * between[:, [0, 1, 2, 5]], axis=1))[:, None]
    assert np.abs(q - between[:, [0, 1, 2, 5]]).max() < most + 1e-3


def test_a_flicked_tube_leaves_the_hand_as_the_package_says_and_rises(ask):
    body = sc.Body.tube(6.0, bore=0.8)
    given, flick, losses = ("tube", (6.0, 0.8, 0.0)), (9.0, 0.8, 0.6, 0.0), ("losses", (0, 0.0))
    state = sc.pressed(body, 9.0, 0.8, finger=0.6, table=0.0)
    _, thrown = ask(given, ("flick", flick))
    np.testing.assert_allclose(
        thrown.out[:6], [state.theta, state.w1, state.w2, state.w3, *state.slip], rtol=1e-14, atol=1e-15
    )
    assert thrown.out[6] > 1.0
    *_, start, rows = ask(
        given, losses, ("start", (*thrown.out[:6], 2.0, 0.2, 0.0, 5.0, 50, NONE)), ("follow", (50, 0.0, 5.0))
    )
    assert start.code == rows.code == 0
    assert rows.out.reshape(-1, WIDE)[:, 1].min() < HALF - 0.05


def test_the_lines_of_the_map_are_those_of_the_package(ask):
    (lines,) = ask(("curves", (5, 0.5, 2.5, 0.4, 0.0)))
    for row in lines.out.reshape(5, 23):
        body = sc.Body.tube(row[0], bore=0.4)
        np.testing.assert_allclose(row[1:3], [body.theta_balance, body.theta_limit], rtol=1e-14)
        folds = np.asarray(body.folds())
        np.testing.assert_allclose(row[3:8][~np.isnan(row[3:8])], folds[~np.isnan(folds)], rtol=1e-12)


_at = sc.Body.solid(2.5).steady(1.45)
STEADY = (_at.theta, _at.w1, _at.w2, _at.w3)
REFUSED = {
    "bore": (1, [("tube", (1.0, 2.0, 0.0))]),
    "no body": (2, [("body", (1.0, 0.1, 1.0, 0.0, NONE))]),
    "forbidden": (3, [("tube", (2.5, 0.0, 0.0)), ("at_rest", (1.0,))]),
    "nothing yet": (9, [("at_rest", (1.0,))]),
    "stone": (1, [("rattleback", (1.0, -0.2, 0.2, 0.0, 1.0, 0.0, 1.0, 9))]),
    "too fast": (1, [("rattleback", (1.0, 0.2, 0.2, 0.0, 1e7, 0.0, 1.0, 9))]),
    "too long": (10, [("rattleback", (1.0, 0.2, 0.2, 0.0, 1.0, 0.0, 1e6, 2))]),
    "no motion": (9, [("tube", (2.5, 0.0, 0.0)), ("follow", (3, 0.0, 1.0))]),
    "bounces": (1, [("tube", (2.5, 0.0, 0.0)), ("start", (*STEADY, 0.0, 0.0, 2.0, 0.3, 0.0, 9.0, 9, 1.5))]),
    "wide": (1, [("tube", (2.5, 0.0, 0.0)), ("start", (*STEADY, 0.0, 0.0, 2.0, 0.3, 1.0, 9.0, 9, NONE))]),
    "bounces on a patch": (1, [("tube", (2.5, 0.0, 0.0)), ("start", (*STEADY, 0.0, 0.0, 2.0, 0.3, 0.1, 9.0, 9, 0.5))]),
    "too much": (10, [("tube", (2.5, 0.0, 0.0)), ("losses", (4, 1e-9)),
                      ("start", (*STEADY, 0.0, 0.0, 0.0, ENDLESS, 0.0, 1e7, 2, NONE))]),
}  # fmt: skip


@pytest.mark.parametrize("why", REFUSED)
def test_a_refusal_is_a_code_with_a_meaning(ask, why):
    code, questions = REFUSED[why]
    *before, last = ask(*questions)
    assert [x.code for x in before] == [0] * len(before)
    assert last.code == code
    if why == "bore":
        assert last.words == ["bore", "0 <= bore <= 1"]
        assert last.out[0] == 2.0


CALLS = {
    "tube": 3, "body": 5, "frustum": 3, "critical": 2, "map": 8, "curves": 5, "at_rest": 1, "by_rate": 1, "circular": 2,
    "losses": 2, "slope": 2, "start": 12, "follow": 3, "poses": 3, "phases": 0, "flick": 4, "thrown": 2, "rattleback": 8,
}  # fmt: skip


def test_no_call_traps_whatever_the_numbers(ask):
    chance = np.random.default_rng(16)
    odd = [
        0.0,
        -0.0,
        1.0,
        2.0,
        0.5,
        1.3,
        HALF,
        np.pi,
        -1.0,
        1e-9,
        3.0,
        30.0,
        1e6,
        1e300,
        5e-324,
        ENDLESS,
        -ENDLESS,
        NONE,
    ]
    questions = []
    for _ in range(4000):
        name = chance.choice(list(CALLS))
        numbers = [
            chance.choice(odd) if chance.random() < 0.5 else chance.uniform(0, 3) for _ in range(CALLS[name])
        ]
        questions.append((str(name), numbers))
    answers = ask(*questions)  # a trap of the core would raise here
    assert {x.code for x in answers} >= {0, 1, 9}
    assert {x.code for x in answers} <= set(range(13))
