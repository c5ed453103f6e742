"""The photograph from above of a spinning tube: the still symbols."""

import numpy as np
import pytest
from letters import letters
from scipy.spatial.transform import Rotation

import spincyl as sc
from spincyl.studio import exposure
from spincyl.studio.shape import marks, parts, rotations

PIPE = sc.Body.tube(6.0, bore=0.8)  # the paper's PVC tube


def turning(body, theta, turns=1.0):
    """A steady motion over a number of turns about the vertical."""
    state = body.steady(theta)
    return sc.roll(body, state, turns * 2 * np.pi / state.precession)


def test_the_papers_tube_shows_six_os_and_no_x():
    assert letters(sc.exposure(turning(PIPE, np.radians(89.5)))) == (6, 0)


def test_pressed_on_its_other_end_it_shows_six_xs_and_no_o():
    assert letters(sc.exposure(turning(PIPE, np.radians(89.5)), upper="X")) == (0, 6)


@pytest.mark.parametrize("ell", [2.0, 3.0, 4.0, 5.0])
def test_on_its_side_a_tube_shows_as_many_letters_as_its_length_has_diameters(ell):
    # |ell sin - cos| still symbols per turn
    assert letters(sc.exposure(turning(sc.Body.tube(ell, 0.8), np.radians(89.9)))) == (ell, 0)


def test_the_letters_stay_where_they_are_over_many_turns_if_their_number_is_whole():
    assert letters(sc.exposure(turning(PIPE, np.pi / 2 - 1e-6, turns=9), samples=2e7)) == (6, 0)


def test_hurricane_balls_show_one_o_and_no_x_however_they_lean():
    # |g|/A = 1 still symbol per turn: psi' = phi' exactly
    balls = sc.Body.balls()
    for theta in (72, 80, 88):
        assert letters(sc.exposure(turning(balls, np.radians(theta)))) == (1, 0)


def test_a_fillet_shifts_the_number_of_letters_as_the_ratio_of_spin_to_precession():
    # at 89.9 degrees |g|/A is 3.5 with H = 4 and a fillet of 0.5: no still symbols; with H = 3.5 it is 3
    for half, whole in ((3.5, True), (4.0, False)):
        can = sc.Body.solid(half, fillet=0.5)
        light = sc.exposure(turning(can, np.radians(89.99), turns=2), samples=1e7)
        assert (letters(light) == (3, 0)) is whole


def test_the_upper_ball_hides_the_letter_that_lies_below_it():
    # half a turn about the axis after the start, the letters are on the lower side of the balls
    balls, spin = sc.Body.balls(), 1000.0
    t = np.pi / spin
    now = sc.roll(balls, sc.State(0.3, 0.0, 0.0, spin), [t, t * (1 + 1e-9)], t0=0.0, want="pose")
    light = sc.exposure(now, size=200, width=8.0, samples=1e6)
    seen = []
    for part in parts(balls)[-2:]:
        corners = Rotation.from_quat(now.orientation[0]).apply(part.vertices)[part.triangles]
        seen.append(np.maximum(np.cross(*(corners[:, k] - corners[:, 0] for k in (1, 2)))[:, 2], 0).sum() / 2)
    upper, lower = seen
    assert lower > 0.2 * upper > 0, "part of the lower one faces up"
    assert light.sum() * (8.0 / 200) ** 2 == pytest.approx(upper, rel=0.02)


def test_far_away_is_up_and_x_runs_to_the_right():
    # a coin at a moment when its mark has turned towards +y
    coin = sc.Body.solid(0.0)
    now = sc.roll(coin, coin.circular(0.3, 1.0), [1.0, 1.0 + 1e-9], t0=0.0, want="pose")
    x, y, _ = Rotation.from_quat(now.orientation[0]).apply([1 - 0.56 * 0.6, 0.0, 0.0])
    assert abs(y) > 0.3
    light = sc.exposure(now, size=200, width=4.0)
    rows, columns = np.nonzero(light > 0.3 * light.max())
    seen = (columns.mean() - 99.5) * 0.02, (99.5 - rows.mean()) * 0.02
    assert seen == pytest.approx((x, y), abs=0.03)


def test_thousands_of_turns_do_not_keep_step_with_the_samples():
    once = sc.exposure(turning(PIPE, np.pi / 2 - 1e-6), samples=4e6)
    for turns in (500, 2000, 16000 / 6):
        many = sc.exposure(turning(PIPE, np.pi / 2 - 1e-6, turns), samples=4e6)
        assert many.sum() == pytest.approx(once.sum(), rel=0.02)
        assert letters(many)[0] == 6


def test_where_the_number_is_not_whole_many_turns_blur_the_letters_into_a_ring():
    def contrast(turns):
        light = sc.exposure(turning(PIPE, np.radians(84), turns), samples=1e7)
        y, x = np.mgrid[:400, :400] - 199.5
        ring = np.abs(np.hypot(x, y) / 400 * 2.08 * np.hypot(1, 6) - 5.4) < 0.4
        angle = np.digitize(np.arctan2(y, x)[ring], np.linspace(-np.pi, np.pi, 73))
        along = np.bincount(angle, light[ring])[1:] / np.bincount(angle)[1:]
        return along.std() / along.mean()

    assert contrast(80) < 0.15 < 1.0 < contrast(1)


def test_light_is_conserved():
    # on the wall of a lying tube, a normal makes full turns: a place shows 1/pi of its area on average
    ink = sum(
        np.linalg.norm(np.cross(c[:, 1] - c[:, 0], c[:, 2] - c[:, 0]), axis=1).sum() / 2
        for c in (part.vertices[part.triangles] for part in parts(PIPE)[-2:])
    )
    light = sc.exposure(turning(PIPE, np.pi / 2 - 1e-6), size=300, width=14.0)
    assert light.sum() * (14.0 / 300) ** 2 == pytest.approx(
        ink / np.pi, rel=4e-3
    )  # the letters are made of flat pieces
    assert light.min() >= 0 and light.max() <= 1  # nothing stands still here, so that noise stays below 1


def test_the_upper_letter_of_a_disk_is_seen_from_above_and_the_lower_is_not():
    coin = sc.Body.solid(0.1)
    still = sc.roll(coin, sc.State(0.3, 0.0, 0.0, 0.0), 1e-9)
    assert letters(sc.exposure(still)) == (1, 0) and letters(sc.exposure(still, upper="X")) == (0, 1)


def test_a_picture_of_a_resting_coin_is_the_letter_where_it_is():
    coin = sc.Body.solid(0.0)
    still = sc.roll(coin, sc.State(1e-3, 0.0, 0.0, 0.0), 1e-9)
    light = sc.exposure(still, width=2.0, size=100)
    y, x = np.mgrid[1:-1:100j, -1:1:100j][0], np.mgrid[1:-1:100j, -1:1:100j][1]
    # the mark is on the side of the top of the rim, +x, and shows all the time
    assert (light * x).sum() / light.sum() == pytest.approx(1 - 0.56 * 0.6, abs=0.01)
    assert (light * y).sum() / light.sum() == pytest.approx(0.0, abs=0.01)
    assert np.median(light[light > 0.5]) == pytest.approx(1.0, abs=0.1)


def test_quaternions_become_the_matrices_that_scipy_makes_of_them():
    turned = Rotation.random(50, rng=np.random.default_rng(3))
    assert np.allclose(rotations(turned.as_quat()), turned.as_matrix(), atol=1e-15)
    assert rotations(turned[0].as_quat()).shape == (3, 3)


def test_the_shutter_is_open_for_seconds_of_a_scale():
    scale = sc.Scale(radius=7.9375e-3)
    m = turning(PIPE, np.radians(85), 2)
    half = sc.exposure(m, float(scale.seconds(m.t[-1])) / 2, scale=scale)
    assert np.allclose(half, sc.exposure(turning(PIPE, np.radians(85), 1)), atol=2e-3)


def test_a_picture_is_the_same_each_time_and_smoother_with_more_samples():
    m = turning(PIPE, np.radians(85))
    coarse, fine, finest = (sc.exposure(m, samples=n) for n in (1e5, 1e6, 3e7))
    assert np.array_equal(fine, sc.exposure(m, samples=1e6))
    assert np.abs(fine - finest).mean() < 0.6 * np.abs(coarse - finest).mean()


def test_backward_in_time_it_is_the_mirrored_picture_and_a_motion_that_ended_is_shown_to_its_end():
    state = PIPE.steady(np.radians(85))
    turn = 2 * np.pi / state.precession
    back = sc.exposure(sc.roll(PIPE, state, -turn))
    mirrored = sc.exposure(sc.roll(PIPE, state, turn))[::-1]
    assert np.corrcoef(back.ravel(), mirrored.ravel())[0, 1] > 0.97
    can = sc.Body.solid(1.0)
    fallen = sc.roll(can, sc.State(0.3, 0.0, 0.0, 0.0), 5.0)
    assert fallen.event and sc.exposure(fallen).max() > 0.02


def test_what_makes_no_picture_is_refused_by_name():
    m = turning(PIPE, np.radians(85))
    for how, said in (
        ({"seconds": 0.1}, "needs scale="),
        ({"seconds": 99.0, "scale": sc.Scale(0.008)}, "at most"),
        ({"seconds": np.nan, "scale": sc.Scale(0.008)}, "seconds"),
        ({"size": 0}, "size"),
        ({"size": 2.5}, "size"),
        ({"samples": np.inf}, "samples"),
        ({"width": -1.0}, "width"),
        ({"upper": "Y"}, "upper"),
    ):
        with pytest.raises(ValueError, match=said):
            sc.exposure(m, **how)
    for wrong in (None, np.zeros((3, 3)), PIPE):
        with pytest.raises(TypeError, match="expected a Motion"):
            sc.exposure(wrong)


def test_the_photograph_is_drawn_in_units_of_the_radius():
    import matplotlib.pyplot as plt

    ax = sc.plot.exposure(turning(PIPE, np.radians(89.5)), width=14.0)
    assert ax.get_images()[0].get_extent() == [-7.0, 7.0, -7.0, 7.0]
    plt.close("all")


def test_an_open_shutter_needs_only_the_light_by_which_it_differs_from_before(monkeypatch):
    m, asked = turning(PIPE, np.radians(89.5), turns=3.0), []
    seen = exposure.seen
    monkeypatch.setattr(
        exposure, "seen", lambda m, t, *names: (asked.append(np.size(t)), seen(m, t, *names))[1]
    )
    ink, turn = [[part] for part in marks(PIPE)], m._asked.times[-1] / 3
    how = ink, 0.06, (220, 220), 4e5, np.zeros(2)
    shutter = exposure.Shutter(m, *how)
    for t in np.linspace(0.02, 2.5, 125):
        light = shutter.light(max(t - 1.0, 0.0) * turn, t * turn)
    fresh = exposure.Shutter(m, *how)
    one = fresh.light(1.5 * turn, 2.5 * turn)
    assert light.min() > -1e-12 * light.max(), "what was added is taken away"
    # less than nine whole pictures for 125: one while the shutter opens, and as long as it opens twice, ...
    assert sum(asked[:-1]) < 9 * asked[-1] and len(asked) == 126
    for sliding, whole in zip(light, one, strict=True):
        assert sliding.sum() == pytest.approx(whole.sum(), rel=5e-3)
        blocks = [x.reshape(22, 10, 22, 10).sum((1, 3)) for x in (sliding, whole)]
        assert np.abs(np.subtract(*blocks)).max() < 0.05 * blocks[1].max()
    # to an earlier time, to one far away, and back
    for first, last in ((1.2, 2.2), (0.0, 0.1), (1.5, 2.5)):
        light = shutter.light(first * turn, last * turn)
        whole = exposure.Shutter(m, *how).light(first * turn, last * turn)
        assert light.sum() == pytest.approx(whole.sum(), rel=5e-3)
