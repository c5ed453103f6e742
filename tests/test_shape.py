"""The drawn shape of a body with a fillet: its volume, moments and contact are those of the body."""

import numpy as np
import pytest

import spincyl as sc
from spincyl.studio import shape
from spincyl.studio import surface as surfaces
from spincyl.studio.shape import kind, landing, marks, parts, profiles, reach

COIN, CAN, TUBE = (
    sc.Body.solid(0.2, fillet=0.05),
    sc.Body.solid(1.5, fillet=0.3),
    sc.Body.tube(3.0, 0.7, fillet=0.15),
)
FAT, CAPSULE, BALL = (
    sc.Body.solid(0.5, fillet=0.5),
    sc.Body.solid(2.5, fillet=1.0),
    sc.Body.solid(1.0, fillet=1.0),
)
BALLS, APART = sc.Body.balls(), sc.Body.balls(1.5)
TIPPE = sc.Body.ball(-0.3, 0.45, 0.42)
STEM, HAT, SHOULDER = (sc.Body(-0.2, 0.45, 0.42, fillet=1.0, theta_end=np.radians(x)) for x in (120, 100, 75))
GENERAL, TUMBLER = sc.Body(0.8, 0.9, 0.5, fillet=0.3), sc.Body(0.8, 0.9, 0.5, fillet=0.3, theta_end=2.0)
LENS = sc.Body(0.0, 0.5, 0.7, fillet=0.4)
UNIFORM = {
    "coin": COIN,
    "can": CAN,
    "tube": TUBE,
    "fat disk": FAT,
    "capsule": CAPSULE,
    "ball": BALL,
    "two balls": BALLS,
}
ALL = UNIFORM | {
    "balls on a rod": APART,
    "tippe top": TIPPE,
    "with a stem": STEM,
    "with a hat": HAT,
    "with a wide hat": SHOULDER,
    "general": GENERAL,
    "beyond pi/2": TUMBLER,
    "lens": LENS,
}
#: Largest depth of the drawn surface below the true one: the sagitta of 1/128 turn, along and round the
#: profile.
SAGITTA = 1 - np.cos(np.pi / 128)


def surface(body):
    """Corners of the triangles of the surface without marks, (n, 3, 3)."""
    return np.concatenate([part.vertices[part.triangles] for part in map(shape.lathe, profiles(body))])


def moments(body):
    """Volume, height of its centroid, and I1, I3 per volume about the centre, by the divergence theorem."""
    corners = surface(body)
    six = np.linalg.det(corners)
    total = corners.sum(axis=1)
    second = np.einsum("nki,nkj->nij", corners, corners) + total[:, :, None] * total[:, None, :]
    second = np.einsum("n,nij->ij", six, second) / 120
    volume = six.sum() / 6
    middle = (six @ total)[2] / 24 / volume
    x2, y2, z2 = np.diag(second) / volume
    return volume, middle, (y2 + z2, x2 + z2, x2 + y2)


@pytest.mark.parametrize("name", ALL)
def test_the_surface_is_closed(name):
    corners = np.round(surface(ALL[name]), 9)
    places, index = np.unique(corners.reshape(-1, 3) + 0.0, axis=0, return_inverse=True)
    a, b, c = index.reshape(-1, 3).T
    edges = np.concatenate([np.stack([a, b], 1), np.stack([b, c], 1), np.stack([c, a], 1)])
    edges = edges[edges[:, 0] != edges[:, 1]]
    there, back = (np.sort(pairs @ [len(places), 1]) for pairs in (edges, edges[:, ::-1]))
    assert np.array_equal(there, back), "each edge is run along as often in one sense as in the other"


@pytest.mark.parametrize("name", UNIFORM)
def test_its_moments_of_inertia_by_the_divergence_theorem_are_those_of_the_body(name):
    body = UNIFORM[name]
    _, middle, (i1, same, i3) = moments(body)
    assert middle == pytest.approx(0.0, abs=1e-12)
    # a radius of gyration is too small by the sagitta of both circles at most; less for a thin wall
    assert i1 == pytest.approx(same, rel=1e-12)
    for mine, true in ((i1, float(body.i1)), (i3, float(body.i3))):
        assert -4 * SAGITTA * true < mine - true < SAGITTA * true


@pytest.mark.parametrize("name", UNIFORM)
def test_twice_as_many_facets_have_a_quarter_of_the_error(name, monkeypatch):
    body, errors = UNIFORM[name], []
    for quarter in (8, 16, 32):
        monkeypatch.setattr(shape, "_QUARTER", quarter)
        monkeypatch.setattr(surfaces, "_AROUND", 4 * quarter)
        _, _, (i1, _, i3) = moments(body)
        errors.append([float(body.i1) - i1, float(body.i3) - i3])
    errors = np.array(errors)
    assert np.allclose(errors[:-1] / errors[1:], 4.0, rtol=0.03)


def test_the_volumes_of_ball_capsule_and_two_balls_are_those_of_archimedes():
    ball = 4 / 3 * np.pi
    for body, volume, middle in (
        (BALL, ball, 0.0),
        (TIPPE, ball, 0.3),
        (BALLS, 2 * ball, 0.0),
        (CAPSULE, ball + 3.0 * np.pi, 0.0),
    ):
        mine, where, _ = moments(body)
        assert -4 * SAGITTA * volume < mine - volume < 0
        assert where == pytest.approx(middle, abs=1e-12), (
            "the centre of a ball is -ell above the centre of mass"
        )


@pytest.mark.parametrize("name", ALL)
def test_the_lowest_point_of_what_is_drawn_is_the_contact_at_every_inclination(name):
    body = ALL[name]
    places = np.concatenate([part.vertices for part in map(shape.lathe, profiles(body))])
    theta = np.linspace(1e-3, landing(body) - 1e-3, 200)
    s, c, rho = np.sin(theta), np.cos(theta), float(body.fillet)
    # z = sin(theta) e1 + cos(theta) e3; a point of the body has its x along e1 when psi = 0
    depth = -(places[:, :1] * s + places[:, 2:] * c).min(axis=0)
    h = rho + float(body.ell) * c + (1 - rho) * s
    assert np.all(depth < h + 1e-12) and np.all(depth > h - SAGITTA * rho - 1e-12)


@pytest.mark.parametrize("body", [COIN, CAN, TUBE, CAPSULE, BALLS, APART, STEM, HAT, SHOULDER, GENERAL])
def test_at_the_inclination_where_it_lands_a_second_place_touches_the_table(body):
    *_, other = (x for x in map(shape.lathe, profiles(body)) if x.name in ("wall", "upper ball", "stem"))
    s, c, rho = np.sin(landing(body)), np.cos(landing(body)), float(body.fillet)
    high = other.vertices[other.vertices[:, 2] > 0]
    depth = -(high[:, 0] * s + high[:, 2] * c).min()
    assert depth == pytest.approx(rho + float(body.ell) * c + (1 - rho) * s, abs=2 * SAGITTA)


@pytest.mark.parametrize("name", ALL)
def test_normals_point_out_and_are_those_of_the_round_body_not_of_its_facets(name):
    for profile in profiles(ALL[name]):
        part = shape.lathe(profile)
        corners, normals = part.vertices[part.triangles], part.normals[part.triangles]
        assert np.allclose(np.linalg.norm(part.normals, axis=1), 1.0)
        flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        flat /= np.linalg.norm(flat, axis=1)[:, None]
        # normals at the corners differ from the facet's by half the angle between facets
        assert np.einsum("ni,nki->nk", flat, normals).min() > np.cos(1.5 * np.pi / 128)
        if profile.normals is not None:
            for (r0, z0, out0, up0), (r1, z1, out1, up1) in zip(
                *(
                    np.column_stack([profile.corners, profile.normals])[x]
                    for x in (slice(-1), slice(1, None))
                ),
                strict=True,
            ):
                # symmetric about the facet, whose direction is perpendicular to the sum of the normals
                assert (r1 - r0) * (out0 + out1) + (z1 - z0) * (up0 + up1) == pytest.approx(0.0, abs=1e-12)


def height(body, places):
    """Height of points above the round surface of a body (without bore, stem and rod)."""
    middle, wall, fillet, rim, _ = shape.skin(body)
    r, z = np.hypot(places[..., 0], places[..., 1]), places[..., 2] - middle
    if kind(body) == "balls":
        return np.hypot(r, np.abs(z) - wall) - fillet
    across, along = r - rim, np.abs(z) - wall
    inside = np.minimum(np.maximum(across, along), 0.0)
    return np.hypot(np.maximum(across, 0.0), np.maximum(along, 0.0)) + inside - fillet


@pytest.mark.parametrize("name", ALL)
def test_the_letters_lie_on_the_curved_surface(name):
    body = ALL[name]
    for part in marks(body):
        assert np.allclose(height(body, part.vertices), 0.006, atol=1e-9)
        # the normal is the shortest way to the surface
        assert np.allclose(height(body, part.vertices + 0.1 * part.normals), 0.106, atol=1e-9)
        corners = part.vertices[part.triangles]
        # the surface, which is lower between its corners, is hidden everywhere below the marks
        for share in ([1, 1, 1], [1, 1, 0], [0, 1, 1], [1, 0, 1]):
            spots = np.einsum("k,nki->ni", np.array(share) / sum(share), corners)
            assert height(body, spots).min() > 1e-3
        flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert (np.einsum("ni,nki->nk", flat, part.normals[part.triangles]) > 0).all(), "they face outward"


def test_the_o_of_hurricane_balls_is_opposite_to_the_contact_and_rests_with_the_centre():
    theta = np.radians(82)
    state = BALLS.steady(theta)
    assert BALLS.speed_o(state) == pytest.approx(0.0, abs=1e-12)
    s, c = np.sin(theta), np.cos(theta)
    o, x = marks(BALLS)
    # O is at A e1 + L e3, X at A e1 - L e3, on the equator of the lower ball
    for part, z in ((o, 1 + c), (x, -1 - c)):
        middle = (part.vertices.min(axis=0) + part.vertices.max(axis=0)) / 2
        assert np.hypot(middle[0] - s, middle[2] - z) < 0.2 and abs(middle[1]) < 1e-9
    away = np.linalg.norm(o.vertices - [s, 0.0, 1 + c], axis=1)
    assert away.min() > 0.1, "it is inside the ring of the letter"
    assert np.ptp(o.vertices[:, 1]) == pytest.approx(np.ptp(o.vertices[:, 2]), rel=1e-9), "which is round"


def test_a_vanishing_fillet_is_drawn_as_a_sharp_rim():
    for ell, bore in ((2.5, 0.0), (0.375, 0.5), (0.1, 0.0)):
        sharp, rounded = sc.Body.tube(ell, bore), sc.Body.tube(ell, bore, fillet=1e-9)
        assert reach(rounded) == pytest.approx(reach(sharp), abs=1e-8)
        for a, b in zip(parts(sharp), parts(rounded), strict=True):
            assert (a.name, a.colour) == (b.name, b.colour)
            for of in (np.min, np.max):
                assert np.allclose(of(a.vertices, axis=0), of(b.vertices, axis=0), atol=1e-8)


def test_a_sharp_body_has_the_flat_pieces_it_always_had():
    wall, faces, lower, bore = profiles(PIPE := sc.Body.tube(6.0, bore=0.8))
    assert wall.corners == [(1.0, -6.0), (1.0, 6.0)] and faces.corners == [(1.0, 6.0), (0.8, 6.0)]
    assert lower.corners == [(0.8, -6.0), (1.0, -6.0)] and bore.corners == [(0.8, 6.0), (0.8, -6.0)]
    assert all(p.normals is None for p in (wall, faces, lower, bore))
    assert reach(PIPE) == np.hypot(1.0, 6.0)
    sizes = [(len(part.vertices), len(part.triangles)) for part in parts(PIPE)]
    assert sizes == [(258, 256)] * 4 + [(98, 96), (78, 72)]
    o, _ = marks(PIPE)
    assert np.hypot(*o.vertices[:, :2].T) == pytest.approx(1.006, abs=1e-15)
    assert (o.vertices[:, 2].min(), o.vertices[:, 2].max()) == pytest.approx((4.94, 5.94), abs=1e-12)


@pytest.mark.parametrize(
    "body",
    [
        sc.Body.solid(1.0, fillet=1 - 1e-9),
        sc.Body.solid(1.0, fillet=1e-12),
        sc.Body.tube(1.0, 0.999, fillet=0.001),
        sc.Body.tube(1.0, 0.5, fillet=0.5),
        sc.Body.balls(1000.0),
        sc.Body(0.5, 0.6, 0.4, fillet=1.0, theta_end=np.pi / 2),
        sc.Body.ball(1.2, 2.0, 0.4),
    ],
    ids=["almost a ball", "almost sharp", "thin wall", "no face", "far apart", "cut balls", "centre outside"],
)
def test_at_the_ends_of_the_range_there_is_something_to_draw_of_every_part(body, tmp_path):
    for part in parts(body):
        assert len(part.triangles) and np.isfinite(part.vertices).all() and np.isfinite(part.normals).all()
    m = sc.roll(body, sc.State(1.0, 0.01, 0.0, 0.0), 0.1)
    assert sc.view(m).save(tmp_path / "body.glb").stat().st_size > 100_000
    assert len(sc.view(m).html) < 66_000 and "<svg" in body._repr_html_()


def test_what_is_drawn_follows_from_what_is_known():
    kinds = {name: kind(body) for name, body in ALL.items()}
    assert (
        kinds.pop("capsule") == "capsule" and kinds.pop("two balls") == kinds.pop("balls on a rod") == "balls"
    )
    balls = {name for name, what in kinds.items() if what == "ball"}
    assert balls == {"ball", "tippe top", "with a stem", "with a hat", "with a wide hat"}
    assert {what for name, what in kinds.items() if name not in balls} == {"cylinder"}
    assert [p.name for p in profiles(APART)] == ["lower ball", "rod", "upper ball"]
    assert [len(profiles(x)) for x in (TIPPE, STEM, BALLS, CAPSULE, TUBE)] == [1, 2, 2, 1, 4]
    # largest distance from the centre of mass
    assert [reach(x) for x in (CAPSULE, BALLS, APART, TIPPE)] == pytest.approx([2.5, 2.0, 2.5, 1.3])
    assert landing(sc.Body.solid(0.5, fillet=0.5)) == landing(TIPPE) == np.pi
