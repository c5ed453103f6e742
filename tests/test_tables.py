"""Tables as people write them: names, units, separators, commas, encodings."""

import numpy as np
import pytest

import spincyl as sc
from spincyl.lab._columns import cleaned


def written(tmp_path, text, encoding="utf-8"):
    path = tmp_path / "table.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode(encoding))
    return path


@pytest.mark.parametrize(
    ("written", "name", "unit"),
    [
        ("t (s)", "t", "s"),
        ("t [s]", "t", "s"),
        ("# degrees", "degrees", ""),
        ("\ufeffdegrees", "degrees", ""),
        ('"x (cm)"', "x", "cm"),
        ("Acceleration x (m/s^2)", "Acceleration x", "m/s^2"),
        ("θ (°)", "θ", "°"),
        ("v_{x}", "v_{x}", ""),
        ("run (2)", "run (2)", ""),
        ("x (left) (cm)", "x (left)", "cm"),
        ("t / s", "t", "s"),
        ("turns / second", "turns / second", ""),
        ("(s)", "(s)", ""),
        ("#", "#", ""),
    ],
)
def test_a_name_is_told_from_its_unit_and_from_marks_of_a_comment(written, name, unit):
    assert cleaned(written) == (name, unit)


def test_a_column_is_found_by_its_name_and_by_what_the_file_calls_it(tmp_path):
    found = sc.data.read_table(written(tmp_path, "# t (s);x [cm]\n0,5;1\n1,5;2\n"))
    assert list(found) == ["t", "x"] and found.units == {"t": "s", "x": "cm"}
    assert found["x"] is found["x [cm]"] is found.get("x") and "x [cm]" in found and "y" not in found
    assert found.get("y") is None
    with pytest.raises(KeyError, match="'y': no such column; expected one of 't', 'x'"):
        found["y"]


def test_columns_that_differ_in_their_units_only_keep_them_in_their_names(tmp_path):
    found = sc.data.read_table(written(tmp_path, "t (s),x (cm),x (m)\n0,100,1\n"))
    assert list(found) == ["t", "x (cm)", "x (m)"] and found.units["x (cm)"] == "cm"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
@pytest.mark.parametrize("top", ["", "sep=;\r\n", "Gruppe Müller, Freitag\r\n\r\n"])
def test_a_table_of_a_german_spreadsheet_is_read(tmp_path, encoding, top):
    text = top + "Winkel (°);Umläufe pro s\r\n4,79;4,16\r\n\r\n5,83;\r\nNA;2,65\r\n;\r\n-;-\r\n"
    path = written(tmp_path, text, encoding)
    if encoding == "cp1252":
        with pytest.raises(ValueError, match="unknown encoding: .* give encoding="):
            sc.data.read_table(path)
        found = sc.data.read_table(path, encoding=encoding)
    else:
        found = sc.data.read_table(path)
    assert list(found) == ["Winkel", "Umläufe pro s"] and found.units["Winkel"] == "°"
    angles, rates = found.values()
    assert np.array_equal(angles[:3], [4.79, 5.83, np.nan], equal_nan=True)
    assert np.array_equal(rates[:3], [4.16, np.nan, 2.65], equal_nan=True)
    assert np.isnan(angles[3:]).all() and np.isnan(rates[3:]).all()


def test_a_header_that_numpy_wrote_keeps_its_columns_in_place(tmp_path):
    path = tmp_path / "table.txt"
    np.savetxt(path, [[0.0, 1.0, 2.0], [0.5, 3.0, 4.0]], header="t (s) x y")
    found = sc.data.read_table(path)
    assert list(found) == ["t", "x", "y"] and found["y"].tolist() == [2.0, 4.0]


@pytest.mark.parametrize(
    ("text", "columns", "units"),
    [
        ('"t (s)","x (m)"\n"0,5","1,25"\n"1,0","2,5"\n', {"t": [0.5, 1.0], "x": [1.25, 2.5]}, ["s", "m"]),
        ("t;x\ns;cm\n0;1\n1;2\n", {"t": [0.0, 1.0], "x": [1.0, 2.0]}, ["s", "cm"]),
        ("t,x\r0,1\r1,\u22122\r", {"t": [0.0, 1.0], "x": [1.0, -2.0]}, ["", ""]),
        ("# mine\nt x\n0 1\n# a pause\n1 2\n", {"t": [0.0, 1.0], "x": [1.0, 2.0]}, ["", ""]),
        (",t\n0,0.5\n1,1.5\n", {"": [0.0, 1.0], "t": [0.5, 1.5]}, ["", ""]),
    ],
    ids=["decimal commas in quotes", "a line of units", "old line ends", "comments", "an index"],
)
def test_what_other_programs_write_is_read(tmp_path, text, columns, units):
    found = sc.data.read_table(written(tmp_path, text))
    assert {name: values.tolist() for name, values in found.items()} == columns
    assert list(found.units.values()) == units


def test_one_column_is_a_table_and_no_track(tmp_path):
    for text in ("degrees\n4.5\n5\n", "degrees\n4,5\n5\n", "degrees;\n4,5;\n5;\n"):
        path = written(tmp_path, text)
        assert sc.data.read_table(path)["degrees"].tolist() == [4.5, 5.0]
        with pytest.raises(ValueError, match="of at least 2 columns"):
            sc.data.read_tracker(path)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "it is empty"),
        ("\n \n", "it is empty"),
        ("1;2\n3;4\n", "no line of column names"),
        ("a;b\n1;2\n3;4 deg\n", "line 3 has a cell that is not a number: '3;4 deg'"),
        ("t (s),theta\n1,abc\n2,3\n", "line 2 has a cell that is not a number: '1,abc'"),
        ("t theta\n1 abc\n2 3\n", "line 2 has a cell that is not a number: '1 abc'"),
        ("a;b;c\n1;Anna;2\n2;Ben;x\n", "line 3 has the text 'x' in the column 'c'"),
        ("a b c\n1 2\n3 4\n", "line 2 has 2 numbers under 3 column names"),
        (
            "#multi:\n\tO\t\tX\t\nt\tx\ty\tx\ty\n0\t1\t2\t3\t4\n",
            "expected one table, not 2 tracks \\(O, X\\); use read_tracker",
        ),
        (b"PK\x03\x04\x14\0\x06\0", "not a workbook or zip file"),
        (b"\xd0\xcf\x11\xe0\0\0\0", "expected text; export it as CSV"),
    ],
)
def test_what_is_no_table_is_refused_with_its_reason(tmp_path, text, said):
    path = written(tmp_path, text)
    with pytest.raises(ValueError, match=said) as caught:
        sc.data.read_table(path)
    assert "table.csv" in str(caught.value)
