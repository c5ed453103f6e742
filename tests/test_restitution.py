"""Laws of restitution by name: what they have in common, what they tell of gained energy, and where they end."""

import warnings

import numpy as np
import pytest

import spincyl as sc

STICK = sc.Body.solid(4.0)
LEANS = sc.State(1.0, 0.0, 0.9, 0.0, slip=(0.3, 0.0), height=0.0, lift=-1.0)
BALL = sc.Body.ball(0.0, 0.4, 0.4)
THROWN = sc.State(np.pi / 2, 0.0, 0.0, 0.0, slip=(0.0, 0.5), height=2.0, lift=0.0)
ROUGH = sc.Coulomb(0.3)


def hit_under(law):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sc.GainWarning)
        return sc.roll(STICK, LEANS, 0.01, contact=ROUGH, restitution=law).impacts[0]


def turning(state):
    return state.w if isinstance(state, sc.EllipsoidState) else (state.w1, state.w2, state.w3)


def test_newtons_law_has_the_ratio_of_velocities_and_poissons_that_of_impulses():
    compressed = hit_under(0.0)
    for e in (0.2, 0.7, 1.0):
        newton, poisson = hit_under(sc.Newton(e)), hit_under(sc.Poisson(e))
        assert newton.after.lift == pytest.approx(e, abs=1e-13)
        assert poisson.impulse[2] == pytest.approx((1 + e) * compressed.impulse[2], abs=1e-13)


def test_without_restitution_the_three_laws_are_one():
    known = hit_under(0.0)
    for law in (sc.Newton(0.0), sc.Poisson(0.0)):
        assert hit_under(law) == known


def test_energy_that_newtons_law_gives_is_told_once_and_counted():
    # The slip of its edge stops, so that the table pushes harder in restitution than in compression.
    drum, contact = sc.Body.solid(1.0), sc.Coulomb(0.6)
    state = sc.State(1.4, 0.0, 0.0, 0.0, slip=(-0.8, 0.0), height=0.0, lift=-1.0)
    with pytest.warns(sc.GainWarning, match=r"Newton\(1.0\): impacts have added"):
        m = sc.roll(drum, state, [0.0, 0.01], contact=contact, restitution=sc.Newton(1.0))
    hit = m.impacts[0]
    assert hit.gained == -hit.lost > 0.01
    assert m.energy[1] + m.dissipated[1] + m.lost_in_impacts[1] == pytest.approx(m.energy[0], abs=1e-13)
    assert sc.roll(drum, state, 0.01, contact=contact, restitution=1.0).impacts[0].gained == 0


def test_a_superball_goes_to_and_fro():
    law = sc.Walton(0.9, tangential=0.7)
    m = sc.roll(BALL, THROWN, 6.0, contact=sc.Coulomb(0.5), restitution=law)
    slips = [(hit.before.slip[1], hit.after.slip[1]) for hit in m.impacts[:3]]
    assert all(hit.kind == "turns back" for hit in m.impacts[:3])
    assert np.allclose([after / before for before, after in slips], -0.7, atol=1e-12)
    # Garwin 1969: of a slip u the ball keeps the spin and the velocity of (1 + e_t) u I/(1 + I)
    push = m.impacts[0].impulse
    assert np.hypot(push[0], push[1]) == pytest.approx(1.7 * 0.5 * 0.4 / 1.4, abs=1e-13)


def test_a_law_ends_where_a_second_circle_lands():
    tube = sc.Body.tube(1.0, bore=0.8)
    start = sc.dropped(tube, 1.0, 1.5)
    m = sc.roll(tube, start, 60.0, contact=ROUGH, restitution=sc.Poisson(0.5))
    assert m.status == sc.Ending.SIDE


def test_laws_are_numbers_of_a_sweep_and_come_back_from_its_result():
    pytest.importorskip("xarray")
    for law in (sc.Newton(0.5), sc.Poisson(0.25), sc.Walton(0.5, tangential=0.5), 0.5):
        heights = sc.State(1.0, 0.0, 0.0, 0.0, slip=(0.3, 0.1), height=np.array([0.5, 1.0]), lift=0.0)
        found = sc.sweep.roll(BALL, heights, 3.0, contact=ROUGH, restitution=law)
        given = sc.sweep.inputs(found)
        assert given["restitution"] == law
        high = sc.State(1.0, 0.0, 0.0, 0.0, slip=(0.3, 0.1), height=1.0, lift=0.0)
        one = sc.roll(BALL, high, 3.0, contact=ROUGH, restitution=law)
        assert found["w3"][1] == pytest.approx(one.w[-1, 2], abs=1e-8)


def test_a_sweep_has_the_motions_that_roll_has_under_every_law_from_any_start():
    pytest.importorskip("xarray")
    random = np.random.default_rng(712)
    odd = np.array([0.0, 1e-300, -1e-16, 1e-8, -0.1, 0.3, 1.0])
    for body, laws in (
        (BALL, (sc.Newton(0.6), sc.Walton(0.6, tangential=0.4), sc.Walton(0.0, tangential=1.0))),
        (sc.Body.solid(0.8), (sc.Newton(0.3), sc.Poisson(0.7))),
        (sc.Ellipsoid.egg(1.0, 1.4), (sc.Newton(0.3), sc.Poisson(0.7))),
    ):
        for law in laws:
            w, slip, (height, lift) = (random.choice(odd, (n, 12)) for n in (3, 2, 2))
            if isinstance(body, sc.Body):
                theta = random.uniform(0.2, 1.4, 12)
                states = [
                    sc.State(theta[i], *w[:, i], slip=slip[:, i], height=abs(height[i]), lift=lift[i])
                    for i in range(12)
                ]
                many = sc.State(theta, *w, slip=tuple(slip), height=abs(height), lift=lift)
            else:
                up = random.normal(size=(3, 12))
                up /= np.linalg.norm(up, axis=0)
                states = [
                    sc.EllipsoidState(up[:, i], w[:, i], slip=slip[:, i], height=abs(height[i]), lift=lift[i])
                    for i in range(12)
                ]
                many = sc.EllipsoidState(up.T, w.T, slip=slip.T, height=abs(height), lift=lift)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                found = sc.sweep.roll(
                    body, many, 2.0, contact=ROUGH, restitution=law, want=("final", "lost_in_impacts")
                )
                for i, state in enumerate(states):
                    one = sc.roll(body, state, 2.0, contact=ROUGH, restitution=law)
                    assert found["status"][i] == one.status, (law, state)
                    lost = sum(hit.lost for hit in one.impacts)
                    near = max(1e-8, 10 * one.error, 10 * float(found["error"][i]))
                    assert abs(found["lost_in_impacts"][i] - lost) < near, (law, state)
                    for k, name in enumerate(("w1", "w2", "w3")):
                        end = one.w[-1, k] if one.event is None else turning(one.event.state)[k]
                        assert abs(float(found[name][i]) - end) < near, (law, state, name, end)


@pytest.mark.parametrize("law", [sc.Newton(0.5), sc.Poisson(0.25), sc.Walton(0.5, tangential=0.5)])
def test_a_law_can_be_written_and_read(law):
    assert eval(repr(law), {"Newton": sc.Newton, "Poisson": sc.Poisson, "Walton": sc.Walton}) == law
    assert len({law, eval(repr(law), vars(sc))}) == 1


@pytest.mark.parametrize(
    ("make", "error", "match"),
    [
        (lambda: sc.Newton(1.1), ValueError, "^e = 1.1: expected 0 to 1"),
        (lambda: sc.Poisson(np.nan), ValueError, "^e = nan"),
        (lambda: sc.Walton(0.5, tangential="x"), (TypeError, ValueError), "^tangential"),
        (lambda: sc.roll(STICK, LEANS, 1.0, contact=ROUGH, restitution="newton"), TypeError, "^restitution"),
        (
            lambda: sc.roll(STICK, LEANS, 1.0, contact=ROUGH, restitution=sc.Walton(0.5, tangential=0.5)),
            ValueError,
            "^tangential",
        ),
        (
            lambda: sc.roll(
                BALL, THROWN, 1.0, contact=sc.Viscous(0.5), restitution=sc.Walton(0.5, tangential=0.5)
            ),
            ValueError,
            "^tangential",
        ),
    ],
)
def test_what_is_no_law_names_its_argument(make, error, match):
    with pytest.raises(error, match=match):
        make()


def test_a_scene_says_which_law_its_impacts_have_and_is_computed_again_from_its_file(tmp_path):
    times = np.linspace(0, 2.5, 9)
    for law, words in (
        (sc.Newton(0.5), "Newton"),
        (sc.Walton(0.5, tangential=0.25), "Walton"),
        (0.5, "Stronge"),
    ):
        m = sc.roll(BALL, THROWN, times, contact=ROUGH, restitution=law)
        scene = sc.scene(m)
        table = scene.data["table"]
        assert table["restitution"] == 0.5 and words in table["restitution_is"]
        assert words != "Walton" or "0.25 times" in table["restitution_is"]
        (path,) = scene.save(tmp_path / f"{words}.json")
        again = sc.Scene.read(path)
        assert again.motion._asked.restitution == law
        assert again.motion.w[-1, 2] == pytest.approx(m.w[-1, 2], abs=1e-12)
