"""The motion on the frames of its film: computed ends and outline in pixels, beside the marks of Tracker."""

import subprocess

import numpy as np
import pytest

import spincyl as sc

plt = pytest.importorskip("matplotlib.pyplot")
TUBE = sc.measured(outer_diameter="0.625in", inner_diameter="0.5in", length="3.75in")


@pytest.fixture(autouse=True)
def without_a_screen():
    plt.switch_backend("Agg")
    yield
    plt.close("all")


def film(example="tube_project"):
    return sc.data.from_above(sc.data.example(example), TUBE)


def motion(degrees=83.4):
    return sc.roll(TUBE, TUBE.steady(np.radians(degrees)), 0.15)


def drawn(ax):
    """Points of the lines by the shape of their marks; the outline has none."""
    found = {}
    for line in ax.get_lines():
        found.setdefault(line.get_marker(), []).append(line.get_xydata())
    return found


def test_the_computed_ends_are_beside_the_marks_in_pixels_as_tracker_stores_them():
    ax = film().over(motion(), t=0.05)
    shown = drawn(ax)
    (crosses,), (marks, here) = shown["x"], shown["o"]
    # the project stores the marks of the frame at 13/240 s; two before it, and four after one turn, are not shown
    raw = sc.data.read_tracker(sc.data.example("tube_project"))
    assert ax.get_title() == "$t$ = 0.05417 s" and raw["O"]["t"][13] == pytest.approx(0.054167, abs=1e-6)
    for name, at in zip("OX", here, strict=True):
        x, y = raw[name]["x"][13], raw[name]["y"][13]
        c, s = np.cos(np.radians(5)), np.sin(np.radians(5))
        assert at == pytest.approx((918 + 6000 * (c * x - s * y), 336 - 6000 * (s * x + c * y)), abs=1e-6)
    # the marks have errors of 1.2 pixels; the crosses may be in the other order
    apart = np.abs(crosses[:, None] - here[None]).max(axis=2).min(axis=1)
    assert (apart < 4).all() and len(marks) == 2 * (30 - 2)
    low, high = ax.get_ylim()
    assert low > high, "y is downward"


def test_the_marks_of_the_example_and_the_computed_tube_lie_inside_its_picture_of_1280_by_720_pixels():
    for t in np.arange(34) / 240:
        for at in (at for lines in drawn(film().over(motion(), t=t)).values() for at in lines):
            seen = at[np.isfinite(at).all(axis=1)]
            assert (seen > 0).all() and (seen < (1280, 720)).all()
        plt.close("all")


def test_the_outline_is_as_wide_and_as_long_as_the_tube():
    lines = drawn(film().over(motion(), t=0.1))["None"]
    sides = [line for line in lines if len(line) == 2]
    rims = [line for line in lines if len(line) == 73]
    assert len(sides) == len(rims) == 2
    length = 6000 * 3.75 * 0.0254 * np.sin(np.radians(83.4))
    for side in sides:
        assert np.hypot(*(side[1] - side[0])) == pytest.approx(length, rel=1e-9)
    across = np.hypot(*(sides[0][0] - sides[1][0]))
    assert across == pytest.approx(6000 * 0.625 * 0.0254, rel=1e-9)
    for rim in rims:
        distance = np.hypot(*(rim - rim[:-1].mean(axis=0)).T)
        assert 2 * distance.max() == pytest.approx(across, rel=1e-3)
        assert 2 * distance.min() == pytest.approx(across * np.cos(np.radians(83.4)), rel=1e-3)


def test_a_wrong_motion_is_seen_beside_the_marks():
    right, wrong = (film().over(motion(d), t=0.13) for d in (83.4, 75.0))
    apart = []
    for ax in (right, wrong):
        shown = drawn(ax)
        apart.append(np.abs(shown["x"][0][:, None] - shown["o"][1][None]).max(axis=2).min(axis=1).max())
    assert apart[0] < 6 < 30 < apart[1]


def test_a_table_without_a_camera_needs_one_and_then_gives_the_same_picture():
    table = film("tube_from_above")
    assert table.camera is None and film().camera == (918.0, 336.0, 6000.0, 5.0)
    with pytest.raises(ValueError, match="camera: expected"):
        table.over(motion())
    one = drawn(table.over(motion(), camera=(918, 336, 6000, 5)))["o"][1]
    assert one == pytest.approx(drawn(film().over(motion()))["o"][1], abs=0.01)
    with pytest.raises(ValueError, match="camera = .*expected"):
        table.over(motion(), camera=(918, 336, -6000, 5))


def test_axes_that_move_or_are_unequal_have_no_camera(tmp_path):
    import zipfile

    with zipfile.ZipFile(sc.data.example("tube_project")) as packed:
        text = packed.read("tube.trk").decode()
    (tmp_path / "tube.trk").write_text(text, "utf-8")
    assert sc.data.read_tracker(tmp_path / "tube.trk")["O"].camera == (918.0, 336.0, 6000.0, 5.0)
    scale = '<property name="yscale" type="double">6000.0</property>'
    assert scale in text
    (tmp_path / "tube.trk").write_text(text.replace(scale, scale.replace("6000", "6001")), "utf-8")
    assert sc.data.read_tracker(tmp_path / "tube.trk")["O"].camera is None
    (tmp_path / "tube.trk").write_text(text.replace('"string">m<', '"string">cm<'), "utf-8")
    tube = sc.measured(outer_diameter="0.00625in", inner_diameter="0.005in", length="0.0375in")
    with pytest.warns(UserWarning, match="seen at 82.98 degrees"):  # a small tube turns faster
        small = sc.data.from_above(tmp_path / "tube.trk", tube)
    assert small.camera.scale == pytest.approx(6e5)


def test_pictures_are_drawn_from_their_upper_left_corner(tmp_path):
    picture = np.zeros((72, 128, 3), np.uint8)
    picture[:10, :20] = 255
    plt.imsave(tmp_path / "frame.png", picture)
    for frames in (picture, tmp_path / "frame.png", str(tmp_path / "frame.png"), picture[:, :, 0]):
        (image,) = film().over(motion(), frames).get_images()
        assert list(image.get_extent()) == [0, 128, 72, 0]
        seen = np.asarray(image.get_array(), float)
        assert seen[:10, :20].min() > 0.9 and seen[20:].reshape(52, 128, -1)[:, :, :3].max() == 0
    for wrong, kind in ((np.zeros((3, 4, 5)), ValueError), ("x" * 3, OSError), (object(), TypeError)):
        with pytest.raises(kind, match="frames"):
            film().over(motion(), wrong)
    (tmp_path / "bad.png").write_bytes(b"no picture")
    with pytest.raises((ValueError, OSError), match=r"frames|identify"):
        film().over(motion(), tmp_path / "bad.png")


def test_the_frame_of_a_film_is_found_by_its_number_also_in_slow_motion(tmp_path):
    program = pytest.importorskip("imageio_ffmpeg").get_ffmpeg_exe()
    path = tmp_path / "tube.mp4"
    # 40 frames, each brighter than the one before, in a file that plays at 30 frames a second
    grey = np.repeat(5 * np.arange(40, dtype=np.uint8) + 20, 64 * 48 * 3).tobytes()
    words = [program, "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", "64x48", "-r", "30"]
    subprocess.run([*words, "-i", "-", "-c:v", "libx264", "-crf", "1", str(path)], input=grey, check=True)

    def seen(**more):
        ax = film().over(motion(), path, **more)
        (image,) = ax.get_images()
        value = float(np.asarray(image.get_array(), float)[:, :, :3].mean())
        return (255 * value if value <= 1 else value) / 5 - 4

    assert seen() == pytest.approx(0, abs=0.4)
    assert seen(t=0.1) == pytest.approx(24, abs=0.4)  # filmed at 240 frames a second
    assert seen(t=0.1, first=3) == pytest.approx(27, abs=0.4)
    assert seen(t=0.1, first=3, fps=120) == pytest.approx(15, abs=0.4)
    with pytest.raises(ValueError, match="has no frame 124"):
        seen(t=0.1, first=100)
    with pytest.raises(ValueError, match="first: .* number -5"):
        seen(first=-5)
    with pytest.raises(ValueError, match=r"t = 0.2: expected a time of the film, from 0 to 0.1375"):
        seen(t=0.2)
    (tmp_path / "text.mp4").write_text("no film")
    with pytest.raises(OSError, match="frames: .*ffmpeg"):
        film().over(motion(), tmp_path / "text.mp4")
    with pytest.raises(OSError, match="no file"):
        film().over(motion(), tmp_path / "none.mp4")


def test_a_tube_that_turns_clockwise_is_drawn_where_its_marks_are():
    tracks = sc.data.read_tracker(sc.data.example("tube_from_above"))
    turned = {name: {"t": x["t"], "x": x["x"], "y": -x["y"]} for name, x in tracks.items()}
    other = sc.data.from_above(turned, TUBE)
    for t in (0.02, 0.1):
        shown = drawn(other.over(motion(), t=t, camera=(918, 336, 6000, 5)))
        assert np.abs(shown["x"][0][:, None] - shown["o"][1][None]).max(axis=2).min(axis=1).max() < 6
