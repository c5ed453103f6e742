"""The recorded page in a browser: it draws the motion, requests nothing, and text stays text."""

import json
import re
import warnings

import near_steady_tube
import numpy as np
import nutating_cylinder
import pytest
from page_scenes import BODIES, CAN, COIN, CYLINDER, DISK, PIPE, ROUNDED, live_page, motion_of, page_of
from pages import SMALL, arrow, between, near, picture

import spincyl as sc
from spincyl.studio.poses import knots, seen
from spincyl.studio.shape import BLUE, IVORY, ORANGE, lathe, profiles

FALLING = sc.State(1.3, 0.0, 0.0, 0.0)
UNFIT = ["\0", "\x01", "\x0b", "\x1b", "\x7f", "\x85", "\ud800", "\udc00", "\ufdd0", "\uffff", "\U0010fffe"]
HOSTILE = "</script><img src=x onerror=alert(1)><b>{data}&amp;\u2028"


def test_it_draws_a_body_with_its_marks_and_asks_for_nothing(shown):
    page = shown(page_of("nutating"), "#t=3", keep=True)
    image = picture(page)
    assert near(image, BLUE, 0.2) > 0.001 and near(image, ORANGE, 0.2) > 0.001, "O and X are seen"
    assert near(image, IVORY, 0.05) > 0.03
    assert len(np.unique((image * 255).astype(int).reshape(-1, 3), axis=0)) > 200
    assert len(page.requests) == 1 and page.requests[0].startswith("file:")
    assert page.complaints == []


def test_the_drawn_pose_is_that_of_the_motion(shown):
    motions = {kind: motion_of(kind) for kind in BODIES}
    page = shown(page_of(*BODIES), "#t=0", viewport=SMALL, keep=True)
    for i, (kind, m) in enumerate(motions.items()):
        t = np.linspace(0.0, float(m.t[-1]), 2001)
        # as a single text, which playwright need not inspect
        told = "([i, t]) => JSON.stringify(t.map(t => window.spincyl.pose(i, t)))"
        shapes = json.loads(page.evaluate(told, [i, t.tolist()]))
        m = m.wanting("pose", t=t)
        matrix = np.array([pose["matrix"] for pose in shapes]).reshape(-1, 4, 4).transpose(0, 2, 1)
        # 0.003 rad in each of three angles, at the farthest point of the body
        off = 0.008 * np.hypot(1, m.body.ell)
        assert np.abs(matrix[:, :3, 3] - m.centre).max() < off, kind
        contact = np.array([pose["contact"] for pose in shapes])[:, :2]
        assert np.abs(contact - m.contact_point).max() < off, kind
        assert np.abs(matrix[:, :3, :3] - rotations(m.orientation)).max() < 6e-3, kind
        # the drawn angular velocity is that of the motion, along axes that follow the tilt
        frame = frames(m)
        size = np.linalg.norm(m.w, axis=1).max()
        w = np.einsum("nij,nj->ni", frame, m.w)
        assert np.abs(np.array([pose["omega"] for pose in shapes]) - w).max() < 0.03 * size, kind
        momentum = np.einsum("nij,nj->ni", frame, m.w * [m.body.i1, m.body.i1, m.body.i3])
        missed = np.abs(np.array([pose["momentum"] for pose in shapes]) - momentum).max()
        assert missed < 0.03 * size * max(m.body.i1, m.body.i3), kind


def test_a_body_with_a_fillet_stands_on_the_table_and_on_its_path(shown):
    # of the drawn pose, with the drawn geometry: the lowest place of the surface lies on the table at the contact
    kinds = ("rounded", "capsule", "Hurricane balls", "tippe top")
    page = shown(page_of(*BODIES), "#t=0", viewport=SMALL, keep=True)
    for kind in kinds:
        i, m = list(BODIES).index(kind), motion_of(kind)
        places = np.concatenate([part.vertices for part in map(lathe, profiles(m.body))])
        times = np.linspace(0, float(m.t[-1]), 40).tolist()
        for pose in page.evaluate("([i, t]) => t.map(t => window.spincyl.pose(i, t))", [i, times]):
            matrix = np.array(pose["matrix"]).reshape(4, 4).T
            there = places @ matrix[:3, :3].T + matrix[:3, 3]
            # the middle of a facet is 3e-4 R lower than its corners; such a height corresponds to 0.025 R
            # sideways
            assert there[:, 2].min() == pytest.approx(0.0, abs=7e-4)
            lowest = there[there[:, 2].argmin()]
            assert np.hypot(*(lowest[:2] - pose["contact"][:2])) < 0.06 and pose["contact"][2] == 0


def test_a_page_of_sharp_bodies_knows_nothing_of_fillets():
    rounded = sc.roll(ROUNDED, ROUNDED.steady(1.3), 5.0)
    alone, both = page_of("steady").html, sc.view(motion_of("steady"), rounded).html
    assert "fillet" not in alone and "onSharpRim" not in alone
    assert '"fillet":0.3' in both and both.count("onSharpRim=pose") == 1
    # the data of a sharp body are the same beside those of a rounded one
    data = alone.split('<script type="application/json" id="data">')[1].split("</script>")[0]
    (shape,) = json.loads(data)["shapes"]
    assert json.dumps(shape, separators=(",", ":")) in both
    assert [len(corner) for piece in shape["turned"] for corner in piece["corners"]] == [2] * 6
    # its script is that of the other page without one part, to the last letter
    script, longer = (page.split('<script>\n"use strict"')[1] for page in (alone, both))
    before, after = longer.split("for(const m of motions)if(m.fillet)")
    assert script.startswith(before) and after.endswith(script[len(before) :])


def test_a_sharp_body_looks_the_same_beside_a_rounded_one(shown):
    ball = sc.Body.solid(1.0, fillet=1.0)
    rolling = sc.roll(ball, sc.State(1.0, 0.1, 0.0, 0.1), 5.0)
    page = shown(sc.view(motion_of("steady"), rolling), "#t=2")
    alone = shown(page_of("steady", "steady"), "#t=2")
    half = [picture(x)[:, :400] for x in (page, alone)]
    assert np.array_equal(*half) and page.complaints == []


def test_the_page_of_a_ball_does_not_slow_down_for_its_pole():
    (phi,) = seen(motion_of("close to the pole"), np.linspace(0.0, 10.0, 9001), "phi")
    fastest = np.abs(np.gradient(phi, 10 / 9000)).max()
    assert fastest > 15 and page_of("close to the pole").slow == 1, (
        "phi runs at more than two turns in a unit of time"
    )


def rotations(q):
    from scipy.spatial.transform import Rotation

    return Rotation.from_quat(q).as_matrix()


def frames(m):
    """Columns e1, e2, e3: z = sin(theta) e1 + cos(theta) e3, e2 horizontal."""
    e2 = np.column_stack([-np.sin(m.phi), np.cos(m.phi), 0 * m.phi])
    e3 = rotations(m.orientation)[:, :, 2]
    return np.stack([np.cross(e2, e3), e2, e3], axis=-1)


@pytest.mark.parametrize(
    ("body", "state", "until"),
    [
        (CYLINDER, CYLINDER.steady(1.3), 20.0),
        (CYLINDER, CYLINDER.steady(1.3).kicked(0.2), 20.0),
        (sc.Body.solid(1.0), sc.State(0.3, 1e-3, 0.0, 0.0), 5.0),
        (sc.Body.solid(1.0), sc.State(0.3, 0.0, 0.0, 0.0), 5.0),
        (sc.Body.solid(0.0852), sc.Body.solid(0.0852).circular(1.2, 0.3).kicked(0.05), 60.0),
        (CYLINDER, nutating_cylinder.start, -20.0),
    ],
    ids=["steady", "kicked", "rocking", "falls flat", "rolls round", "backward"],
)
def test_between_few_knots_a_cubic_meets_the_motion(body, state, until):
    m = sc.roll(body, state, until)
    found = knots(m)
    t = np.linspace(found[0, 0], found[-1, 0], 3001)[1:-1]
    there = m.wanting("pose", t=np.r_[0.0, t if until > 0 else t[::-1]])
    true = np.column_stack([there.theta, there.phi, there.psi, there.centre[:, :2]])[1:]
    true = true if until > 0 else true[::-1]
    assert np.abs(between(found, t) - true).max() < 2.5e-3
    assert len(found) < 120


def test_random_motions_are_met_between_their_knots():
    rng = np.random.default_rng(11)
    met = []
    for k in range(60):
        body = sc.Body.solid(10 ** rng.uniform(-1.5, 0.7))
        start = sc.State(rng.uniform(0.05, 1.5), *rng.normal(0, 10 ** rng.uniform(-3, 0.3), 3))
        how = {"tol": 1e-9} if k % 3 == 0 else {}
        m = sc.roll(body, start, 10.0, **how)
        if m.t.size == 0 and (m.event is None or m.event.time < 1e-3):
            continue
        found = knots(m)
        t = np.sort(rng.uniform(*found[[0, -1], 0], 1000))
        theta, phi, psi, centre = seen(m, t, "theta", "phi", "psi", "centre")
        true = np.column_stack([theta, phi, psi, centre[:, :2]])
        met.append(np.abs(between(found, t) - true).max())
    assert len(met) > 40 and max(met) < 3e-3, max(met)


@pytest.mark.parametrize("how", [{"tol": 1e-9}, {"step": 1e-2}, {}], ids=["tol", "step", "exact"])
def test_a_motion_that_ends_early_is_shown_to_its_end(shown, tmp_path, how):
    falling = sc.roll(DISK, DISK.steady(np.radians(80)).kicked(0.01), 30.0, contact="smooth", **how)
    landing = sc.roll(CAN, sc.State(0.3, 0.0, 0.0, 0.0), 5.0, **how)
    slipping = sc.roll(CYLINDER, nutating_cylinder.start, 20.0, mu=0.06, **how)
    view = sc.view(falling, landing, slipping)
    page = shown(view, "#t=40")
    said = " ".join(page.locator(".panel").all_inner_texts())
    assert "stands on its edge" in said and "face landed" in said and "slips" in said
    assert view.save(tmp_path / "all.glb").stat().st_size > 10_000
    assert sc.exposure(falling).max() > 0


def test_the_page_starts_as_slowly_as_the_fastest_turn_asks_for():
    assert motion_of("side").t.size == 0  # so that its states say nothing
    assert page_of("side", scale=sc.Scale(5e-4)).slow >= 20
    assert page_of("side").slow == 1 and page_of("side", slow=20).slow == 20


def test_looking_at_a_motion_does_not_switch_warnings_off():
    from concurrent.futures import ThreadPoolExecutor

    m = motion_of("nutating")
    before = warnings.filters.copy()
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda k: m.wanting("pose", t=np.linspace(0, 20, 50 + k)), range(200)))
    assert warnings.filters == before


def test_a_page_of_twenty_seconds_takes_less_than_seventy_kilobytes():
    euler = sc.Body.from_metres(outer_diameter=0.0751, length=0.0128)
    for body, state, scale in (
        (PIPE, near_steady_tube.start, sc.Scale(radius=7.9375e-3)),
        (euler, euler.steady(0.1).kicked(0.05), sc.Scale(radius=0.0751 / 2)),
    ):
        for scaled in (None, scale):
            m = sc.roll(body, state, 20.0 if scaled is None else 20.0 / scale.seconds(1.0))
            assert len(sc.view(m, scale=scaled).html.encode()) <= 49_000
    # also if no period repeats exactly
    m = sc.roll(PIPE, near_steady_tube.start, 700.0, step=2e-2)
    assert (
        len(sc.view(m).html.encode()) <= 69_000
    )  # with the velocity, the line P-C-O and the instantaneous axis


def test_two_pictures_of_one_time_are_equal(shown):
    view = sc.view(motion_of("nutating"), sc.roll(DISK, DISK.steady(1.4), 20.0))
    first, second = (picture(shown(view, "#t=4.25")) for _ in range(2))
    assert np.array_equal(first, second)
    assert not np.array_equal(first, picture(shown(view, "#t=4.3")))


def test_hostile_labels_stay_text(shown):
    page = shown(page_of("nutating", labels=(HOSTILE,), title=HOSTILE), "#t=1")
    assert re.sub(r"\s", " ", page.title()) == re.sub(r"\s", " ", HOSTILE)
    assert page.locator(".panel b").inner_text() == HOSTILE
    assert page.locator("img").count() == 0 and page.complaints == [] and len(page.requests) == 1


@pytest.mark.parametrize("character", UNFIT, ids=ascii)
def test_text_that_cannot_stand_in_html_is_refused_by_name(character):
    text, m = f"a {character} tube", sc.roll(CYLINDER, CYLINDER.steady(1.3), 1.0)
    said = rf" = {re.escape(repr(text))}: expected text without U\+0*{ord(character):X}, which HTML excludes"
    for name, wrong in (
        ("title", lambda: sc.view(m, title=text)),
        (r"labels\[1\]", lambda: sc.view(m, m, labels=["fine", text])),
        ("title", lambda: sc.play(title=text)),
    ):
        with pytest.raises(ValueError, match=name + said):
            wrong()


FIT = "a\ttube\r\nof \u2028 PVC\N{GRINNING FACE}"


def test_white_space_in_text_is_a_space_and_the_rest_stays(shown, tmp_path):
    view = page_of("nutating", labels=(FIT,), title=FIT)
    page = shown(view)
    seen = "a tube of \u2028 PVC\N{GRINNING FACE}"
    assert (
        page.title() == page.locator("h1").text_content() == page.locator(".panel b").text_content() == seen
    )
    assert page.complaints == []
    raw = view.save(tmp_path / "spin.glb").read_bytes()
    tree = json.loads(raw[20 : 20 + int.from_bytes(raw[12:16], "little")])
    assert [x["name"] for x in tree["nodes"]] == ["table", seen] and tree["meshes"][0]["name"] == seen


#: Outcomes of submitting a form and of changing the base of links.
LEAVING = """async () => {
  const said = [];
  addEventListener("securitypolicyviolation", e => said.push(e.effectiveDirective));
  document.head.append(Object.assign(document.createElement("base"), { href: "file:///nowhere/" }));
  const form = Object.assign(document.createElement("form"), { action: location.pathname + "?sent", method: "get" });
  document.body.append(form);
  form.submit();
  for (let i = 0; i < 600 && said.length < 2; i++) await new Promise(done => setTimeout(done, 100));
  await new Promise(done => setTimeout(done, 300));
  return [said.sort(), document.baseURI.startsWith('file:///nowhere/')];
}"""


@pytest.mark.parametrize("make", [lambda: page_of("nutating"), live_page], ids=["recorded", "live"])
def test_nothing_on_a_page_can_send_a_form_or_turn_its_links_elsewhere(shown, make):
    page = shown(make())
    assert page.evaluate(LEAVING) == [["base-uri", "form-action"], False]
    assert len(page.requests) == 1 and "?sent" not in page.url


def test_arrows_point_along_angular_velocity_and_momentum_seen_from_above(shown):
    # for a coin that leans and spins as a whole, both horizontal components are known
    m = sc.roll(COIN, COIN.circular(1.2, 0.5), 3.0)
    page = shown(sc.view(m), "#t=1")
    page.check("#above")
    state = m.wanting("pose", t=[0.0, 1.0])
    frame = frames(state)[1]
    for name, v in (("omega", state.w[1]), ("momentum", state.w[1] * [COIN.i1, COIN.i1, COIN.i3])):
        flat = (frame @ v)[:2]
        seen = arrow(page, name)
        assert seen @ flat > 0.99 * np.hypot(*seen) * np.hypot(*flat), name


def test_without_webgl_it_says_so(shown):
    page = shown(page_of("nutating"), script="HTMLCanvasElement.prototype.getContext = () => null;")
    assert "WebGL 2" in page.get_by_role("alert").inner_text()
    page.locator("#controls").wait_for(state="hidden")
    assert page.complaints == []


def test_in_a_notebook_it_shows_itself_in_a_frame_that_can_do_nothing_else(chromium):
    page = chromium.new_page()
    page.set_default_timeout(chromium.patience)
    frame = page_of("nutating")._repr_html_()
    assert 'sandbox="allow-scripts"' in frame
    page.set_content(f"<p>above</p>{frame}")
    page.frame_locator("iframe").locator("html[data-drawn]").wait_for()
    page.close()


def test_what_cannot_be_shown_is_refused_by_name(tmp_path):
    m = motion_of("nutating")
    for wrong, said in (
        (lambda: sc.view(), "at least one"),
        (lambda: sc.view(m, labels=["a", "b"]), "labels"),
        (lambda: sc.view(m, slow=3), "slow"),
        (lambda: sc.view(m, upper="Y"), "upper"),
        (lambda: sc.view(m).save(tmp_path / "spin.webp"), "spin.webp"),
        (lambda: sc.view(sc.roll(CYLINDER, CYLINDER.steady(1.3), 0.0)), "no duration"),
        (lambda: sc.view(sc.roll(CYLINDER, CYLINDER.steady(1.3), 1e9)), "at most 3000 nutations"),
        (lambda: sc.view(sc.roll(CYLINDER, FALLING, [50.0, 60.0], t0=0.0)), "landed"),
        (lambda: sc.exposure(sc.roll(CYLINDER, FALLING, [50.0, 60.0], t0=0.0)), "landed"),
        (lambda: sc.view(m, scale=sc.Scale(1e-9)), "scale"),
    ):
        with pytest.raises(ValueError, match=said):
            wrong()
    for wrong in (
        lambda: sc.view(CYLINDER),
        lambda: sc.view(m, labels=[1]),
        lambda: sc.view(m, labels="ab"),
        lambda: sc.view(m, labels=5),
        lambda: sc.view(m, scale=1.0),
    ):
        with pytest.raises(TypeError):
            wrong()
    with pytest.raises(OSError, match="nowhere"):
        sc.view(m).save(tmp_path / "nowhere" / "spin.html")
