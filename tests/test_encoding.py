"""The encoding of a table: names and units are read as written, or refused as undecodable."""

import zipfile

import pytest

import spincyl as sc

TABLE = "t\tx\ty\n0.0\t1.0\t2.0\n0.1\t1.1\t2.1\n"
NAMES = {
    "gbk": ("质量_A", "质点 A", "角度"),
    "big5": ("質點 A", "克", "A克"),
    "shift_jis": ("質点 A", "角度", "ｱ"),
    "euc_kr": ("질점 A", "가", "시간"),
    "euc_jp": ("質点 A", "角度"),
    "cp1251": ("масса A", "т", "vу", "и", "xЯ"),
    "koi8_r": ("масса A", "и"),
    "cp1250": ("těleso A", "długość", "hmota č", "kąt", "sł"),
    "cp1252": ("modèle", "velocità", "Ø", "posição", "å"),
    "cp1253": ("θ", "sinφ", "Δtheta", "dφdt", "σmax", "μάζα"),
    "cp1254": ("ağırlık",),
    "cp1257": ("masė", "įtampa"),
    "mac_roman": ("Länge", "masse é", "L’axe"),
    "cp850": ("Länge", "masse é"),
}


def written(tmp_path, text, encoding):
    path = tmp_path / "export.txt"
    path.write_bytes(text.encode(encoding))
    return path


@pytest.mark.parametrize("encoding", NAMES)
def test_a_name_that_is_not_utf_8_is_refused_and_read_when_its_encoding_is_given(tmp_path, encoding):
    for name in NAMES[encoding]:
        path = written(tmp_path, f"{name}\n{TABLE}", encoding)
        with pytest.raises(ValueError, match=r"export.txt: unknown encoding: .*not UTF-8; give encoding="):
            sc.data.read_tracker(path)
        assert list(sc.data.read_tracker(path, encoding=encoding)) == [name]
        # as a column and as a unit
        for column in (f"{name} (m)", f"x ({name})"):
            path = written(tmp_path, f"t (s)\t{column}\n0\t1\n1\t2\n", encoding)
            with pytest.raises(ValueError, match=r"export.txt: unknown encoding"):
                sc.data.read_table(path)
            found = sc.data.read_table(path, encoding=encoding)
            assert found[column].tolist() == [1.0, 2.0]


@pytest.mark.parametrize(
    "name",
    [
        "masse é", "Fréquence (Hz)", "Länge (m)", "Größe", "Winkel (°)", "t (µs)", "a (m/s²)", "M (N·m)", "x – y",
        "质量_A", "質点", "θ", "Δt", "масса", "t (сек)", "Öl", "où", "x̄", "½ t", "kąt", "čas", "Ø", "R²",
    ],
)  # fmt: skip
def test_utf_8_and_utf_16_are_read_with_a_mark_and_utf_8_also_without(tmp_path, name):
    for encoding in ("utf-8", "utf-8-sig", "utf-16"):
        path = written(tmp_path, f"{name}\n{TABLE}", encoding)
        assert list(sc.data.read_tracker(path)) == [name]


def test_western_windows_is_not_guessed_but_read_when_it_is_named(tmp_path):
    path = written(tmp_path, f"Länge\n{TABLE}", "cp1252")
    with pytest.raises(ValueError, match="'L\ufffdnge' is not UTF-8; .*encoding='cp1252'"):
        sc.data.read_tracker(path)
    assert list(sc.data.read_tracker(path, encoding="cp1252")) == ["Länge"]


def test_a_comment_of_an_unknown_encoding_does_no_harm(tmp_path):
    path = written(tmp_path, f"# опыт № 1: масса\n{TABLE}", "cp1251")
    assert list(sc.data.read_table(path)) == ["t", "x", "y"]


def test_an_encoding_that_is_given_is_used_or_refused_by_name(tmp_path):
    path = written(tmp_path, f"质量\n{TABLE}", "gbk")
    with pytest.raises(
        ValueError, match=r"export.txt: cannot be decoded with encoding = 'utf-8': byte 0 of \d+"
    ):
        sc.data.read_tracker(path, encoding="utf-8")
    for wrong in ("klingon", "hex", "a\0b", ""):
        with pytest.raises(
            ValueError, match=r"encoding = .*: expected the name of an encoding, such as 'gbk'"
        ):
            sc.data.read_table(path, encoding=wrong)
    with pytest.raises(TypeError, match="encoding: expected a name such as 'gbk', not int"):
        sc.data.read_table(path, encoding=936)
    assert list(
        sc.data.read_tracker(written(tmp_path, f"质量\n{TABLE}", "utf-16-le"), encoding="utf-16-le")
    ) == ["质量"]


def test_phyphox_and_films_take_an_encoding_too(tmp_path):
    table = "时间 (s),幅度\n0,1\n1,2\n".encode("gbk")
    path = tmp_path / "export.zip"
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("Raw Data.csv", table)
    with pytest.raises(ValueError, match="export.zip: Raw Data.csv: unknown encoding"):
        sc.data.read_phyphox(path)
    assert list(sc.data.read_phyphox(path, encoding="gbk")["Raw Data"]) == ["时间", "幅度"]
    tracks = sc.data.example("tube_from_above").read_text().replace("O", "质量", 1)
    tube = sc.measured(outer_diameter=15.875e-3, inner_diameter=12.7e-3, length=95.25e-3)
    path = written(tmp_path, tracks, "gbk")
    with pytest.raises(ValueError, match="unknown encoding"):
        sc.data.from_above(path, tube)
    assert sc.data.from_above(path, tube, encoding="gbk").hertz > 7


PROJECT = """<?xml version="1.0" encoding="UTF-8"?>
<object class="org.opensourcephysics.cabrillo.tracker.TrackerPanel">
    <property name="width" type="double">640.0</property>
</object>
"""


@pytest.mark.parametrize("read", [sc.data.read_tracker, sc.data.read_table, sc.data.read_phyphox])
def test_a_project_of_trackers_and_an_experiment_of_phyphoxs_are_said_to_be_such(tmp_path, read):
    plain, packed, other = (tmp_path / name for name in ("a.trk", "a.trz", "a.phyphox"))
    plain.write_text(PROJECT, encoding="utf-8")
    with zipfile.ZipFile(packed, "w") as file:
        file.writestr("a.trk", PROJECT)
    other.write_text('<phyphox version="1.7"><title>Audio</title></phyphox>')
    for path in (plain, packed):
        with pytest.raises(
            ValueError, match=rf"{path.name}: (.*: )?a Tracker project, (not a table|but no point)"
        ):
            read(path)
    with pytest.raises(ValueError, match=r"a.phyphox: a phyphox experiment without its data"):
        read(other)
