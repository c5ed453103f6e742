"""The live page shows a body that was put together from parts as these parts, while it has that body."""

import json

import numpy as np
import pytest
from pages import near, picture
from playing import address, ask, settled, state

import spincyl as sc
from spincyl import parts as p
from spincyl.studio.shape import BLUE, marks, profiles

TOP = sc.assembled(
    [
        p.ball(diameter="8mm", density=7800),
        p.cylinder(outer_diameter="4mm", length="30mm", at="4mm", density=1200),
        p.cylinder(outer_diameter="40mm", inner_diameter="4mm", length="4mm", fillet="1mm", at="12mm", density=1200),
        p.ring(diameter="44mm", mass="1g", at="14mm"),
    ]
)  # fmt: skip
BALLS = sc.assembled([p.ball(diameter=x, density=7800) for x in ("18mm", "14mm")])
CUP = sc.assembled(
    [
        p.disk(outer_diameter="50mm", density=2.0),
        p.wall(lower_diameter="50mm", upper_diameter="70mm", length="90mm", at=0, density=2.0),
        p.point(mass="3g", at="5mm"),
    ]
)
LOOK = "window.spincyl.look({ ...window.spincyl.body(), bore: NaN, parts: window.spincyl.state().parts })"


@pytest.mark.parametrize("body", [TOP, BALLS, CUP], ids=["top", "balls", "cup"])
def test_parts_look_as_they_do_everywhere_else(opened, body):
    page = opened(page=sc.play(body, 0.3))
    seen, expected = page.evaluate(LOOK), profiles(body)
    assert len(seen["turned"]) == len(expected)
    for mine, theirs in zip(seen["turned"], expected, strict=True):
        assert np.allclose([c[:2] for c in mine["corners"]], theirs.corners, atol=1e-6)
        assert {len(c) for c in mine["corners"]} == {2 if theirs.normals is None else 4}
        assert theirs.normals is None or np.allclose(
            [c[2:] for c in mine["corners"]], theirs.normals, atol=1e-6
        )
        assert mine["colour"] == pytest.approx(theirs.colour)
    for mine, theirs in zip(seen["marks"], marks(body), strict=True):
        at, normals, which = (np.reshape(mine[k], (-1, 3)) for k in ("places", "normals", "triangles"))
        assert np.allclose(at, theirs.vertices, atol=1e-4) and mine["colour"] == pytest.approx(theirs.colour)
        assert np.allclose(np.linalg.norm(normals, axis=1), 1.0)
        outward = np.cross(at[which[:, 1]] - at[which[:, 0]], at[which[:, 2]] - at[which[:, 0]])
        assert ((outward * normals[which[:, 0]]).sum(axis=1) > -1e-9).all() and len(which) >= len(
            theirs.triangles
        )


def test_the_stripe_is_in_the_picture_of_the_parts_and_not_in_that_of_the_address_alone(opened):
    play, blue = sc.play(BALLS, 1.5), []
    for page in (opened(page=play), opened(play.address)):
        blue.append(near(picture(page, "#canvas"), BLUE, 0.12))
        assert page.complaints == []
    assert blue[0] > 3e-3, blue
    assert abs(blue[0] / blue[1] - 1) > 0.2, blue


def test_the_address_of_the_same_body_keeps_the_parts_and_another_body_has_none(opened):
    play = sc.play(BALLS, 1.3)
    assert "parts" not in play.address and play.body._parts == BALLS._parts and play.body == BALLS
    page = opened(page=play)
    assert "parts" not in page.evaluate("location.hash")
    page.evaluate("window.spincyl.set({ theta: 1.4, contact: 'smooth' })")
    settled(page)
    assert len(state(page)["parts"]) == 2
    address(page, play.address.replace("theta=1.3", "theta=1.35"))
    assert len(state(page)["parts"]) == 2 and state(page)["theta"] == 1.35
    address(page, play.address.replace("ell=0.5", "ell=0.6"))
    assert state(page)["parts"] is None
    address(page, play.address)
    page.select_option("#preset", "Hurricane balls")
    settled(page)
    assert (
        state(page)["parts"] is None
        and len(ask(page, "look({ ...window.spincyl.body(), bore: NaN })")["turned"]) == 2
    )


def test_a_page_of_another_body_is_told_no_parts():
    play = sc.play(BALLS, 1.3)
    told = json.loads(play.html.split('id="given">')[1].split("</script>")[0])
    assert told["parts"][0][:2] == [0, 1], "the first ball is ivory, and has stripes"
    assert len(json.dumps(told["parts"])) < 20_000
    play.body = sc.Body.solid(2.5)
    assert "parts" not in play._told and play.body == sc.Body.solid(2.5)
    play.body = BALLS
    assert play.body._parts == BALLS._parts
    moon = sc.play(BALLS.in_metres(gravity=1.62))
    assert moon._told["parts"] == play._told["parts"] == sc.play(BALLS.natural)._told["parts"]
