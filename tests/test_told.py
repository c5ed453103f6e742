"""What a motion of a body of several circles tells, held to the geometry of the body, whichever circle carries it."""

import json
import re
import shutil
import subprocess
from dataclasses import replace
from importlib.resources import files

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import spincyl as sc
from spincyl.studio import aloft, poses, shape, sound

CUP, CONE, BALLS = sc.Body.frustum(0.7, 1.0, 2.0), sc.Body.cone(2.0), sc.Body.balls(radii=(1, 0.8))
BOTTLE = sc.Body.lathe([(1, 0), (1, 3), (0.35, 4.2), (0.35, 5)])
ROUNDED = sc.Body.profile([(0.5, 0, 0.2), (0.8, 1.5, 0.1)], 0.6, 0.4, 0.7)
BOWL = replace(sc.assembled([sc.parts.cap(diameter=2, height=1, density=1.0)]), scale=None)
GRIP = {"contact": sc.Coulomb(0.3), "restitution": 0.3}
#: Bodies and initial states from which several circles carry, one after the other.
STARTS = {
    "cup": (CUP, sc.State(2.2, 0.3, 0.4, 0.5)),
    "cone": (CONE, sc.State(2.0, 0.3, 0.6, 0.4)),
    "bottle": (BOTTLE, sc.State(2.8, 0.3, 0.6, 0.4)),
    "balls": (BALLS, sc.State(2.5, 0.3, 0.6, 0.4)),
    "rounded": (ROUNDED, sc.State(1.9, 0.4, 0.5, -0.6)),
    "bowl": (BOWL, sc.State(1.9, 0.5, 0.3, 0.3)),
}
TABLES = [
    GRIP,
    GRIP | {"restitution": 0.0, "losses": sc.loss.DryContour(0.02)},
    {"contact": "smooth", "restitution": 0.5},
    {"contact": sc.Coulomb(0.3)},
    {},
]


def of(name, how=GRIP, end=4.0, points=161):
    body, start = STARTS[name]
    return sc.roll(body, start, np.linspace(0, end, points), want=("pose", "force"), **how)


def axes(m):
    return Rotation.from_quat(m.orientation).as_matrix()


def round_the_apex(body, rate):
    """The state in which a body rolls on its first two circles round its apex, with this precession."""
    s, c = np.sin(body.theta_end), np.cos(body.theta_end)
    return sc.State(body.theta_end, s * rate, 0.0, -s * s / c * rate)


@pytest.mark.parametrize("how", TABLES)
@pytest.mark.parametrize("name", STARTS)
def test_the_drawn_body_stands_on_the_table_at_every_time(name, how):
    m = of(name, how)
    height = m.height if "restitution" in how else 0.0 * m.t
    points = np.concatenate([part.vertices for part in shape.parts(m.body) if part.name not in ("O", "X")])
    lowest = (m.centre[:, 2:] + axes(m)[:, 2] @ points.T).min(axis=1)
    # the drawn surface has facets, which lie at most so far inside the true one
    assert (np.abs(lowest - height) < 2e-3).all()
    assert m.t.size > 20 or m.event.time < 0.5


@pytest.mark.parametrize("how", TABLES)
@pytest.mark.parametrize("name", STARTS)
def test_centre_and_orientation_agree_with_the_circle_that_carries_and_its_contact_point(name, how):
    m = of(name, how)
    axis = axes(m)[:, :, 2]
    assert np.cos(m.theta) == pytest.approx(axis[:, 2], abs=1e-14)
    assert m.axis_up == pytest.approx(axis[:, 2], abs=1e-14)
    radius, above, fillet = m.body.circles[m.rim].T
    down = axis * axis[:, 2:] - [0.0, 0.0, 1.0]
    out = down / np.linalg.norm(down, axis=1, keepdims=True)
    lowest = m.centre + above[:, None] * axis + radius[:, None] * out - fillet[:, None] * [0, 0, 1]
    assert lowest[:, :2] == pytest.approx(m.contact_point, abs=1e-12)
    # in the air another circle may be lower than the one that is told
    height = m.height if "restitution" in how else 0.0 * m.t
    down = m.phase != aloft.FLIES if "restitution" in how else m.t >= 0
    assert lowest[down, 2] == pytest.approx(height[down], abs=1e-12)
    assert (lowest[:, 2] > height - 1e-12).all()
    assert abs(m.phi[0]) < 1e-15 and m.psi[0] == 0
    # a body that has turned over tells the same theta: no orientation jumps
    turned = (
        Rotation.from_quat(m.orientation[:-1]).inv() * Rotation.from_quat(m.orientation[1:])
    ).magnitude()
    assert turned.max(initial=0.0) < 0.2


def test_each_circle_carries_in_these_motions():
    carried = {name: {*of(name).rim.tolist()} for name in STARTS}
    assert carried["bottle"] == {0, 1, 2} and carried["bowl"] == carried["cup"] == {0, 1}
    # without restitution= too, and on a single circle that is not the lowest one
    assert {*of("bowl", {}).rim.tolist()} == {0, 1} and {*of("cup", {}).rim.tolist()} == {1}


@pytest.mark.parametrize("body", [CUP, CONE, sc.Body.cone(0.5), BALLS])
def test_a_body_rolls_round_its_apex_in_the_circle_that_geometry_gives(body):
    apex = body.apex()
    rate = 0.9 * apex.rate
    t = np.linspace(0, 2 * np.pi / rate, 73)
    m = sc.roll(
        body,
        round_the_apex(body, rate),
        t,
        contact=sc.Coulomb(1.5),
        restitution=0.0,
        want=("pose", "force"),
    )
    assert [phase.kind for phase in m.phases] == ["rolling round its apex"]
    assert set(m.phase.tolist()) == {6} and "rolling round its apex" in m.message
    # the axis meets the table in one point, about which the centre and the contact point move in circles
    axis = axes(m)[:, :, 2]
    meets = m.centre - axis * (m.centre[:, 2:] / axis[:, 2:])
    assert np.ptp(meets, axis=0).max() < 1e-11
    away = np.linalg.norm(m.centre[:, :2] - meets[0, :2], axis=1)
    assert away == pytest.approx(apex.radius, rel=1e-11)
    radius, _, fillet = body.circles[0]
    of_contact = (radius + fillet * np.sin(body.theta_end)) / abs(np.cos(body.theta_end))
    assert np.linalg.norm(m.contact_point - meets[0, :2], axis=1) == pytest.approx(of_contact, rel=1e-11)
    assert m.phi[-1] == pytest.approx(2 * np.pi, rel=1e-12)
    # the whole force holds the centre on its circle
    inward = np.column_stack([(meets[0, :2] - m.centre[:, :2]) * rate**2, np.ones(t.size)])
    assert m.contact_force == pytest.approx(inward, abs=1e-11)
    assert m.normal + m.normal_other == pytest.approx(1.0, rel=1e-12)
    assert m.friction + m.friction_other == pytest.approx(rate**2 * apex.radius, rel=1e-11)
    assert m.friction_coefficient == pytest.approx(0.81 * apex.friction, rel=1e-11)


def test_two_circles_of_one_radius_roll_on_their_side():
    m = sc.roll(
        BOTTLE, sc.thrown(BOTTLE, 1.0, 2.0), 20.0, want="pose", contact=sc.Coulomb(0.3), restitution=0.0
    )
    assert m.phases[-1].kind == "rolling on its side"
    # friction takes the backspin v + w of a solid of revolution at the rate mu g (1 + 1/I3)
    assert m.phases[-1].time == pytest.approx(3.0 / (0.3 * (1 + 1 / BOTTLE.i3)), rel=1e-12)
    assert m.start.slip == (0.0, 3.0) and m.start.w3 == -2.0
    with pytest.raises(ValueError, match="^theta_end"):
        sc.thrown(CUP, 1.0, 2.0)


def test_a_body_of_several_circles_rests_on_a_face_or_on_two_circles():
    resting = {"contact": sc.Coulomb(0.4), "restitution": 0.3}
    resting["losses"] = sc.loss.RollingResistance(0.02) + sc.loss.Drilling(0.02)
    # a bottle on its neck balances up to 6.4 degrees from the vertical
    for body, last in ((CUP, 2.9), (BOTTLE, 3.1)):
        leans = np.array([0.2, 1.5, last])
        found = sc.sweep.roll(
            body, sc.dropped(body, 0.1, leans), 400.0, want=("final", "rests_on", "axis_up"), **resting
        )
        expected = [sc.RestsOn.FACE, sc.RestsOn.SIDE, sc.RestsOn.OTHER_FACE]
        assert found["rests_on"].values.tolist() == expected
        assert found["axis_up"].values == pytest.approx([1, np.cos(body.theta_end), -1], abs=1e-8)
        singles = [sc.roll(body, sc.dropped(body, 0.1, x), 400.0, **resting).rests_on for x in leans]
        assert singles == expected


def single(state, k):
    """One of the states of a motion."""
    four = (float(getattr(state, name)[k]) for name in ("theta", "w1", "w2", "w3"))
    slip = tuple(float(x[k]) for x in state.slip)
    return sc.State(*four, slip=slip, height=float(state.height[k]), lift=float(state.lift[k]))


@pytest.mark.parametrize("name", STARTS)
def test_a_motion_continues_from_each_of_its_states(name):
    m = of(name)
    kinds = set()
    for k in range(3, 150, 7):
        start = single(m.states, k)
        if m.phase[k] != aloft.FLIES:
            start = replace(start, height=None, lift=None)
        again = sc.roll(m.body, start, m.t[k : k + 8], **GRIP)
        rows = slice(k, k + again.t.size)
        assert again.theta == pytest.approx(m.theta[rows], abs=1e-9)
        assert again.energy == pytest.approx(m.energy[rows], abs=1e-9)
        assert again.height == pytest.approx(m.height[rows], abs=1e-9)
        kinds |= {int(m.phase[k])}
    assert kinds


def test_a_state_in_the_air_is_told_of_the_lowest_circle():
    m = of("bottle")
    lowest = (m.body.borders < m.theta[:, np.newaxis]).sum(axis=1)
    other = (m.phase == aloft.FLIES) & (m.rim != lowest)
    assert other.sum() > 10
    assert m.states.height[other] == pytest.approx(m.height[other], abs=1e-14)
    for k in np.flatnonzero(other):
        moves = np.array(m.body.centre_velocity(single(m.states, k)))
        step = np.array([-1e-4, 1e-4])
        near = m.at([*(m.t[k] + step)])
        centre = near.centre[:, :2] @ [1, 1j]
        v = (centre[1] - centre[0]) / 2e-4 * np.exp(-1j * m.phi[k])
        if not any(abs(x.time - m.t[k]) < 2e-4 for x in m.impacts):
            assert moves == pytest.approx([v.real, v.imag], abs=1e-6)
    flights = [phase for phase in m.phases if phase.kind == "flying"]
    for phase in flights:
        assert phase.rim == ("first", "other", "third")[int((m.body.borders < phase.state.theta).sum())]


@pytest.mark.parametrize("name", ["cup", "bottle", "balls", "rounded"])
def test_a_measured_body_has_the_same_motion_in_si(name):
    body, start = STARTS[name]
    sized = body.in_metres("20g", radius="30mm")
    second = sized.scale.seconds(1.0)
    t = np.linspace(0, 3, 31)
    plain = sc.roll(body, start, t, want=("pose", "force"), **GRIP)
    m = sc.roll(sized, start, t * second, want=("pose", "force"), **GRIP)
    assert m.centre == pytest.approx(0.03 * plain.centre, abs=1e-9)
    assert m.height == pytest.approx(0.03 * plain.height, abs=1e-10)
    assert np.array_equal(m.rim, plain.rim) and m.rests_on == plain.rests_on
    assert m.energy == pytest.approx(sized.scale.joules(plain.energy), rel=1e-8)
    table = m.to_dataframe()
    assert table["centre_z"].to_numpy() == pytest.approx(m.centre[:, 2], abs=0) and "rim" in table
    assert m.to_xarray()["phase"].attrs["flag_meanings"].endswith("rolling_round_its_apex on_its_face")


@pytest.mark.parametrize("name", STARTS)
def test_films_and_gltf_tell_theta_from_the_same_end_all_the_time(name):
    m = of(name)
    first, last = poses.span(m)
    if aloft.goes_up(m):
        up = aloft.aloft(m, first, last)
        t = np.linspace(first, last, 500)
        assert not up.on_other(t).any()
        there = m.wanting("pose", t=t)
        theta, phi, _ = up.from_first(there.t, there.theta, there.phi, there.psi).T
        assert theta == pytest.approx(there.theta, abs=1e-12) and phi == pytest.approx(there.phi, abs=1e-9)
    drawn = poses.knots(m)
    there = m.wanting("pose", t=drawn[1:-1, 0])
    assert np.abs(drawn[1:-1, 4:6] - there.centre[:, :2]).max() < 1e-8


def test_the_contact_of_a_rolling_body_is_as_fast_along_its_circle_as_along_the_table():
    # the listener hears this speed
    for body in (CUP, BALLS):
        m = sc.roll(body, body.steady(2.3), np.linspace(0, 3, 3001), want="pose")
        assert {*m.rim.tolist()} == {1}
        _, speed = sound._contact(m, m.t)
        along = np.linalg.norm(np.gradient(m.contact_point, m.t, axis=0), axis=1)
        assert speed[1:-1] == pytest.approx(along[1:-1], rel=1e-4)


@pytest.mark.parametrize(("body", "theta"), [(BALLS, 2.0), (CONE, 2.3), (BALLS, 1.45)])
def test_a_body_of_several_circles_nutates_on_the_circle_that_carries_it(body, theta):
    start = replace(body.steady(theta), w2=0.02)
    turns = sc.swing(body, start)
    t = np.linspace(0, 3 * turns.period, 3001)
    m = sc.roll(body, start, t, want="pose")
    assert m.success and {*m.rim.tolist()} == {int(theta > body.theta_end)}
    assert m.theta.min() == pytest.approx(turns.theta_min, abs=1e-6)
    assert m.theta.max() == pytest.approx(turns.theta_max, abs=1e-6)
    assert m.phi[1000] == pytest.approx(turns.precession_per_period, abs=1e-9)
    assert m.psi[1000] == pytest.approx(turns.spin_per_period, abs=1e-9)


@pytest.mark.parametrize("name", STARTS)
def test_the_card_of_a_body_of_several_circles_names_each_of_them(name):
    body, _ = STARTS[name]
    text = body._repr_html_()
    assert all(f"circle {k}<" in text for k in range(len(body.circles)))
    assert "<svg" in text and "<svg" in of(name, end=1.0, points=5)._repr_html_()
    lands = re.findall(r"lands at</td><td[^>]*>([0-9.]+)", text)
    expected = np.degrees(body.borders[body.spans > 0])
    assert [float(x) for x in lands] == pytest.approx(expected, abs=0.006)


#: What the scripts of a page find in a browser, and in place of those that draw.
IN_A_BROWSER = """
const any = () => new Proxy(function () {}, {
  get: (of, name) => name === Symbol.toPrimitive ? () => 0 : name === "length" ? 0
    : ["forEach", "map", "flatMap"].includes(name) ? () => [] : any(),
  set: () => true, apply: any, construct: any, has: () => true,
});
globalThis.document = any();
let lathe, arrowOf, trace;
"""
POSES = (
    "ts => ts.map(t => { const p = pose(motions[0], t); return [p.kind ?? 0, ...p.centre, ...p.contact]; })"
)


@pytest.mark.skipif(not shutil.which("node"), reason="needs node")
@pytest.mark.parametrize(("name", "how"), [("cup", GRIP), ("bottle", TABLES[1]), ("bowl", {}), ("balls", {})])
def test_a_recorded_page_draws_the_body_on_the_circle_that_carries_it(name, how):
    m = of(name, how)
    view = sc.view(m)
    scripts = ["pose", "poses", "rounded", *(["forces", "slip", "aloft"] if how else []), "circles"]
    folder = files("spincyl") / "studio" / "pages" / "js"
    text = "\n".join((folder / f"page.{script}.js").read_text(encoding="utf-8") for script in scripts)
    text = text.replace('JSON.parse($("data").textContent)', json.dumps(view._data()))
    t = np.sort(np.random.default_rng(1).uniform(0, m.t[-1], 60))
    asked = f"{IN_A_BROWSER}{text}\nconsole.log(JSON.stringify(({POSES})({t.tolist()})));"
    run = subprocess.run(["node", "-"], input=asked, capture_output=True, text=True, timeout=120, check=True)
    there = m.wanting("pose", t=t)
    drawn = np.array(json.loads(run.stdout))[: there.t.size]
    # the cubics of the page are within 2e-3 of the motion
    assert np.abs(drawn[:, 1:4] - there.centre).max() < 4e-3
    down = drawn[:, 0] != aloft.FLIES
    assert np.abs(drawn[down, 4:6] - there.contact_point[down]).max() < 4e-3
