"""Projects of Tracker's are read as it reads them itself, and refused with what is inside."""

import io
import re
import zipfile

import numpy as np
import pytest

import spincyl as sc

HOME = "org.opensourcephysics."
with zipfile.ZipFile(sc.data.example("tube_project")) as _packed:
    (_NAME,) = _packed.namelist()
    TEXT = _packed.read(_NAME).decode()
BOMB = "".join(f'<!ENTITY l{i} "{f"&l{i - 1};" * 10}">' for i in range(1, 10))


def read(tmp_path, text, name="film.trk", **how):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return sc.data.read_tracker(path, **how)


def put(**values):
    """The project with other values of some properties, all of that name."""
    text = TEXT
    for name, value in values.items():
        text, many = re.subn(rf'(<property name="{name}"[^>]*>)[^<]*', rf"\g<1>{value}", text)
        assert many
    return text


def marks(text=TEXT):
    """By track and frame the pixels that are marked, read by other means."""
    found = {}
    for track in re.split(r"(?=<object class=\"[\w.]*PointMass\">)", text)[1:]:
        name = re.search(r'name="name" type="string">([^<]*)', track)[1]
        frame = r'name="\[(\d+)\]".*?name="x" type="double">([^<]*).*?name="y" type="double">([^<]*)'
        found[name] = {int(n): (float(x), float(y)) for n, x, y in re.findall(frame, track, re.S)}
    return found


def test_a_project_says_what_the_table_says_that_was_exported_from_it():
    project = sc.data.read_tracker(sc.data.example("tube_project"))
    table = sc.data.read_tracker(sc.data.example("tube_from_above"))
    assert list(project) == list(table) == ["O", "X"]
    for name, track in project.items():
        assert list(track) == ["t", "x", "y"] and track.units == {"t": "s", "x": "m", "y": "m"}
        for column in track:
            # a thousandth of a pixel, of which a metre has 6000; the table has seven digits
            np.testing.assert_allclose(track[column], table[name][column], atol=1.5e-7)
    assert np.isnan(project["X"]["x"]).sum() == 2 and np.isnan(project["O"]["x"]).sum() == 0


def test_a_project_unpacked_is_the_same(tmp_path):
    assert read(tmp_path, TEXT) == sc.data.read_tracker(sc.data.example("tube_project"))


def test_from_above_takes_a_project(tmp_path):
    inch = 25.4e-3
    tube = sc.measured(outer_diameter=0.625 * inch, inner_diameter=0.5 * inch, length=3.75 * inch)
    one, two = (
        sc.data.from_above(sc.data.example(name), tube) for name in ("tube_project", "tube_from_above")
    )
    assert one.hertz == pytest.approx(two.hertz, rel=1e-5) and one.unseen == two.unseen == 2


@pytest.mark.parametrize("seed", range(4))
def test_any_axes_take_a_place_in_the_world_to_the_pixel_that_tracker_draws(tmp_path, seed):
    """To the picture: turn about the origin of the axes, scale, turn upside down, shift."""
    rng = np.random.default_rng(seed)
    angle, across, up = rng.uniform(-180, 180), *rng.uniform(10, 1e4, 2)
    x, y = rng.uniform(-500, 2000, 2)
    text = put(xorigin=x, yorigin=y, angle=angle, xscale=across, yscale=up)
    sin, cos = np.sin(np.radians(angle)), np.cos(np.radians(angle))
    for name, track in read(tmp_path, text).items():
        for n, (right, down) in marks()[name].items():
            east, north = track["x"][n], track["y"][n]
            assert right == pytest.approx(x + across * (cos * east - sin * north), abs=1e-8 * across)
            assert down == pytest.approx(y - up * (sin * east + cos * north), abs=1e-8 * up)


def test_axes_stay_where_they_were_moved_to(tmp_path):
    one = re.search(
        r'<property name="\[0\]" type="object">\s*<object class="[\w.]*ImageCoordSystem.*?</object>\s*</property>',
        TEXT,
        re.S,
    )[0]
    later = one.replace("[0]", "[10]").replace(">918.0<", ">1018.0<").replace(">6000.0<", ">3000.0<")
    text = TEXT.replace(one, one + later).replace(
        'name="fixedorigin" type="boolean">true', 'name="fixedorigin" type="boolean">false'
    )
    moved, plain = read(tmp_path, text), read(tmp_path, TEXT)
    for name in "OX":
        np.testing.assert_array_equal(moved[name]["x"][:10], plain[name]["x"][:10])
        back = (moved[name]["x"] + 1j * moved[name]["y"]) / 2 + 100 / 6000 * np.exp(-1j * np.radians(5))
        np.testing.assert_allclose(back[10:].real, plain[name]["x"][10:], atol=1e-12)


def test_times_are_those_of_the_clip(tmp_path):
    text = put(startframe=4, stepsize=3, stepcount=8, starttime=250.0)
    track = read(tmp_path, text)["O"]
    np.testing.assert_allclose(track["t"], 0.25 + 3 * np.arange(8) / 240, rtol=1e-12)
    np.testing.assert_array_equal(track["x"], read(tmp_path, TEXT)["O"]["x"][4:26:3])


def test_a_film_in_slow_motion_has_the_time_that_was_set_for_it(tmp_path):
    video = '<property name="video" type="object"><object class="v"><property name="delta_t" type="double">33.3</property></object></property>'
    text = TEXT.replace('<property name="video_framecount"', f'{video}<property name="video_framecount"')
    assert read(tmp_path, text)["O"]["t"][1] == pytest.approx(1 / 240)
    bare = re.sub(r'<property name="clipcontrol".*?</object>\s*</property>', "", text, flags=re.S)
    assert read(tmp_path, bare)["O"]["t"][1] == pytest.approx(0.0333)


@pytest.mark.parametrize(("unit", "told"), [("cm", "cm"), ("", ""), ("mm", "mm"), ("Meter", "Meter")])
def test_the_unit_is_that_of_the_scale_of_length(tmp_path, unit, told):
    assert read(tmp_path, put(length_unit=unit))["O"].units["x"] == told


def test_a_film_without_a_scale_of_length_is_in_pixels_and_no_film_of_a_tube(tmp_path):
    text = put(xscale=1.0, yscale=1.0)
    assert read(tmp_path, text)["O"].units == {"t": "s", "x": "px", "y": "px"}
    with pytest.raises(ValueError, match="unit 'px' of the column x"):
        sc.data.from_above(tmp_path / "film.trk", sc.measured(outer_diameter=0.01, length=0.1))


def test_tracks_keep_names_in_any_alphabet(tmp_path):
    names = ("masse é", "質量 A")
    text = TEXT.replace('string">O<', f'string">{names[0]}<').replace('string">X<', f'string">{names[1]}<')
    assert tuple(read(tmp_path, text)) == names
    assert tuple(read(tmp_path, "\ufeff" + text)) == names
    assert tuple(read(tmp_path, text.encode("utf-16"))) == names
    declared = text.replace("UTF-8", "GB18030")
    assert tuple(read(tmp_path, declared.encode("gb18030"))) == names
    wrong = text.replace(names[1], "massa ç")
    assert tuple(read(tmp_path, wrong.encode("cp1252"), encoding="cp1252")) == (names[0], "massa ç")
    with pytest.raises(ValueError, match="unknown encoding: 'mass.*' is not UTF-8; give encoding="):
        read(tmp_path, wrong.encode("cp1252"))
    noted = TEXT.replace(
        "</object>\n", '<property name="author" type="string">\udce7\udcf8</property></object>\n', 1
    )
    assert list(read(tmp_path, noted.encode("utf-8", "surrogateescape"))) == ["O", "X"]


def packed(files, **how):
    raw = io.BytesIO()
    with zipfile.ZipFile(raw, "w", **how) as file:
        for name, text in files.items():
            file.writestr(name, text)
    return raw.getvalue()


def test_a_packed_project_has_its_film_beside_it(tmp_path):
    raw = packed({"tube/videos/tube.mp4": b"\0" * 100, "__MACOSX/._tube.trk": b"x", "tube/tube.TRK": TEXT})
    assert list(read(tmp_path, raw, "film.trz")) == ["O", "X"]
    with pytest.raises(
        ValueError, match="film.zip: expected one Tracker project, not 2 \\(a.trk, b.trk\\); unpack it"
    ):
        read(tmp_path, packed({"a.trk": TEXT, "b.trk": TEXT}), "film.zip")
    with pytest.raises(ValueError, match="not a workbook or zip file"):
        read(tmp_path, packed({"tube.mp4": b"\0"}), "film.trz")
    with pytest.raises(ValueError, match="film.trz: the zip file is damaged"):
        read(tmp_path, raw[:-60], "film.trz")


def test_a_packed_project_is_not_unpacked_beyond_the_limit(tmp_path, monkeypatch):
    monkeypatch.setattr("spincyl.lab._contents.MOST_BYTES", 1_000_000)
    raw = packed({"a.trk": b" " * 1_000_001}, compression=zipfile.ZIP_DEFLATED)
    assert len(raw) < 10_000
    with pytest.raises(ValueError, match="more than 1"):
        read(tmp_path, raw, "film.trz")


@pytest.mark.parametrize(
    "document",
    [
        '<!DOCTYPE object [<!ENTITY x SYSTEM "file:///etc/hostname">]>',
        f'<!DOCTYPE object [<!ENTITY l0 "ha">{BOMB}]>',
        '<!DOCTYPE object SYSTEM "http://localhost/a.dtd">',
        "<!DOCTYPE object>",
    ],
)
def test_a_document_type_and_its_entities_are_refused_unread(tmp_path, document):
    head, rest = TEXT.split("\n", 1)
    text = head + document + rest.replace(">axes<", ">&l9;<" if "l9" in document else ">&x;<")
    with pytest.raises(ValueError, match="film.trk: a Tracker project, but the file contains <!DOCTYPE"):
        read(tmp_path, text)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (TEXT[: len(TEXT) // 2], "line \\d+ is damaged"),
        (TEXT.replace("</object>", "</objekt>", 1), "line \\d+ is damaged: mismatched tag"),
        (TEXT.replace(">axes<", ">&axes;<"), "line \\d+ is damaged: undefined entity"),
        (TEXT.replace("tracker.TrackerPanel", "tracker.TFrame"), "of the kind 'TFrame'"),
        (
            TEXT.replace('tracker.PointMass"', 'tracker.LineProfile"'),
            "it has CoordAxes 'axes', LineProfile 'O', LineProfile 'X'",
        ),
        (TEXT.replace(">X<", ">O<"), "two tracks are called 'O'"),
        (put(startframe=100), "66 marks are outside its clip"),
        (put(stepcount=0), "marks are outside its clip"),
        (put(delta_t=0.0), "delta_t = 0.0: expected a positive duration"),
        (put(delta_t="NaN"), "delta_t = 'NaN' is not a number"),
        (re.sub(r'<property name="delta_t".*', "", TEXT), "it has no number 'delta_t'"),
        (put(xscale=0.0), "its scale of length is 0"),
        (put(xscale="1,5"), "xscale = '1,5' is not a number"),
        (put(xscale="1e999"), "xscale = '1e999' is not a number"),
        (
            re.sub(
                r'<property name="coords".*?</object>\s*</property>\s*</property>\s*</object>',
                "<object>",
                TEXT,
                flags=re.S,
            ),
            "damaged|no axes",
        ),
        (TEXT.replace('name="coords"', 'name="coordinates"'), "it has no axes and no scale of length"),
        (
            TEXT.replace('name="x" type="double">', 'name="x" type="double">Infinity', 1),
            "x = 'Infinity.*' is not a number",
        ),
        (
            TEXT.replace('name="[33]"', 'name="[999999999]"').replace(">34<", ">1000000000<"),
            "tracks over 1000000000 frames are too many",
        ),
        (
            TEXT.replace(
                '<property name="length_unit"',
                '<property name="referenceframe" type="string">O</property><property name="length_unit"',
            ),
            "its axes move with 'O'",
        ),
        (f'<?xml version="1.0"?><object class="{HOME}cabrillo.tracker.TrackerPanel"/>', "it has no track"),
        (f'<object class="{HOME}cabrillo.tracker.TrackerPanel"', "line 1 is damaged"),
    ],
)
def test_what_is_no_project_with_marks_is_refused_with_what_is_inside(tmp_path, text, told):
    with pytest.raises(ValueError, match=f"film.trk: a Tracker project, but .*({told})"):
        read(tmp_path, text)


def test_elements_in_elements_do_no_harm_however_deep(tmp_path):
    deep = 100_000
    assert list(read(tmp_path, TEXT.replace(">axes<", ">" + "<a>" * deep + "</a>" * deep + "<"))) == [
        "O",
        "X",
    ]


def test_a_project_with_very_many_elements_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("spincyl.lab._project._MOST", 200)
    with pytest.raises(ValueError, match="more than 200 elements"):
        read(tmp_path, TEXT)


def test_other_readers_say_who_reads_a_project(tmp_path):
    path = tmp_path / "film.trk"
    path.write_text(TEXT)
    for reader in (sc.data.read_table, sc.data.read_phyphox):
        for one in (path, sc.data.example("tube_project")):
            with pytest.raises(
                ValueError, match="a Tracker project, not a table; read it with data.read_tracker"
            ):
                reader(one)


def test_a_byte_that_is_changed_anywhere_is_read_or_refused(tmp_path):
    rng, raw = np.random.default_rng(3), TEXT.encode()
    for _ in range(200):
        torn = bytearray(raw)
        for at in rng.integers(len(raw), size=rng.integers(1, 4)):
            torn[at] = rng.integers(256)
        try:
            found = read(tmp_path, bytes(torn[: rng.integers(len(raw) // 2, 2 * len(raw))]))
        except ValueError as e:
            assert "film.trk" in str(e)
        else:
            assert all(len(x) == len(track["t"]) for track in found.values() for x in track.values())
