"""Damaged, odd and hostile files are read correctly or refused with their name, in bounded time."""

import contextlib
import io
import random
import struct
import time
import warnings
import zipfile

import numpy as np
import pytest

import spincyl as sc
from spincyl.lab import _contents, _tracker

INCH = 25.4e-3
TUBE = sc.Body.from_metres(outer_diameter=0.625 * INCH, inner_diameter=0.5 * INCH, length=3.75 * INCH)


def filmed(path):
    return sc.data.from_above(path, TUBE)


READERS = (sc.data.read_table, sc.data.read_tracker, sc.data.read_phyphox, sc.data.read_sound, filmed)


def written(tmp_path, raw, name="file.csv"):
    path = tmp_path / name
    path.write_bytes(raw.encode() if isinstance(raw, str) else raw)
    return path


# files that were once read wrongly


@pytest.mark.parametrize("read", [sc.data.read_table, sc.data.read_phyphox])
@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('t,x\n"1,2\n3,4\n', "line 2 has a quote that is not closed: '\"1,2'"),
        ('t,x\n1,2\n"3,4\n', "line 3 has a quote that is not closed"),
        ('"t,x\n1,2\n3,4\n', "line 1 has a quote that is not closed"),
        ('t;x\n"1;2\n3;4\n', "line 2 has a quote that is not closed"),
        ('a,b,c\n1,"2,5"3,4\n1,2,3\n', "line 2 has a quote that is not closed"),
        (",\n1,2\n2,3\n", "line 1 has no names separated in the same way as the numbers"),
        ("t,\n1,2\n2,3\n", "line 2 has 2 cells under 1 column names"),
        ("t,x\n1\n2\n", "line 2 has 1 number under 2 column names"),
        ("t\tx\n1,2\n3,4\n", "line 2 has 1 number under 2 column names"),
        ("t,x,y\n1,2\n3,4\n", "line 2 has 2 numbers under 3 column names"),
        ("t;x\n1,5;2\n1.234;2,5\n", "line 3 has a decimal point among decimal commas"),
        ("t;x\n1.234;2,5\n1,5;2\n", "line 2 has numbers in another format than line 3"),
        ('t\n1"\n2\n', "line 2 has numbers in another format than line 3"),
        ('t,x\n1,"1,234"\n2,"5,678"\n', "line 2: '1,234' may mean 1.234 or 1234"),
        ("t,x\n1,inf\n2,1e999\n", "line 2 has the text 'inf' in the column 'x': expected only numbers"),
        ("t,x\n1,2\n2,inf\n3,4\n", "line 3 has a cell that is not a number: '2,inf'"),
        ("t,x\n1,2\n2,-1e999\n", "line 3 has a cell that is not a number: '2,-1e999'"),
        ("t,t\n1,2\n", "line 1: two columns"),
    ],
)
def test_a_table_that_can_be_read_in_two_ways_is_refused_with_file_and_line(tmp_path, read, text, said):
    with pytest.raises(ValueError) as caught:
        read(written(tmp_path, text))
    assert said in str(caught.value) and "file.csv" in str(caught.value)


@pytest.mark.parametrize(
    ("text", "columns"),
    [
        ('t,x\n"1,2",3\n"0,5","4,25"\n', {"t": [1.2, 0.5], "x": [3.0, 4.25]}),
        ('t,x\n1,"1,234"\n2,"0,678"\n', {"t": [1.0, 2.0], "x": [1.234, 0.678]}),
        ('"x, y";"a ""b"""\n1,5;2\n', {"x, y": [1.5], 'a "b': [2.0]}),
        ("t (s, ms);\n1,5;\n", {"t": [1.5]}),
        ("t;x;note\n1;2;\n3;4;\n", {"t": [1.0, 3.0], "x": [2.0, 4.0], "note": [np.nan, np.nan]}),
        ('by 5" of tube\nt,x\n1,2\n', {"t": [1.0], "x": [2.0]}),
    ],
)
def test_quotes_commas_and_empty_columns_that_are_clear_are_read(tmp_path, text, columns):
    found = sc.data.read_table(written(tmp_path, text))
    assert list(found) == list(columns)
    assert all(np.array_equal(found[name], columns[name], equal_nan=True) for name in columns)


def test_names_that_look_like_each_other_lose_no_column(tmp_path):
    names = ["x (cm)", "x (m)", "x (cm) (s)", "# t", "t", "t (s)"]
    found = sc.data.read_table(written(tmp_path, ";".join(names) + "\n1;2;3;4;5;6\n"))
    assert [found[name].tolist() for name in names] == [[1.0], [2.0], [3.0], [4.0], [5.0], [6.0]]
    with pytest.raises(ValueError, match="columns: two columns are called 't'"):
        sc.data.Columns([("t", np.ones(1)), ("t", np.zeros(1))])


def zipped(*tables, method=zipfile.ZIP_DEFLATED):
    raw = io.BytesIO()
    with zipfile.ZipFile(raw, "w", method) as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about two equal names
        for name, text in tables:
            file.writestr(name, text)
    return raw.getvalue()


def test_two_tables_of_one_name_in_a_zip_file_are_both_there(tmp_path):
    raw = zipped(("a/Raw.csv", "t,x\n0,1\n"), ("b/Raw.csv", "t,x\n5,6\n"), ("c/Level.csv", "t,x\n7,8\n"))
    found = sc.data.read_phyphox(written(tmp_path, raw))
    assert {name: columns["x"].tolist() for name, columns in found.items()} == {
        "a/Raw.csv": [1.0], "b/Raw.csv": [6.0], "Level": [8.0],
    }  # fmt: skip
    raw = zipped(("Raw.csv", "t,x\n0,1\n"), ("Raw.csv", "t,x\n5,6\n"))
    with pytest.raises(ValueError, match="file.csv: two tables in this zip file are called 'Raw.csv'"):
        sc.data.read_phyphox(written(tmp_path, raw))


def test_odd_names_in_a_zip_file_are_read_and_nothing_is_written(tmp_path):
    names = ["./A.csv", "a//B.csv", "../../C.csv", "/D.csv", "__MACOSX/._A.csv", "meta/device.csv"]
    found = sc.data.read_phyphox(written(tmp_path, zipped(*((name, "t,x\n0,1\n") for name in names))))
    assert list(found) == ["A", "B", "C", "D"] and [x.name for x in tmp_path.iterdir()] == ["file.csv"]


# sound


def wav(code=1, channels=1, hertz=8000, bits=16, data=bytes(range(64)), pace=None, frame=None, whole=True):
    frame = channels * bits // 8 if frame is None else frame
    form = struct.pack("<HHIIHH", code, channels, hertz, hertz * frame if pace is None else pace, frame, bits)
    size = len(data) if whole is True else 0
    body = b"fmt " + struct.pack("<I", 16) + form + b"data" + struct.pack("<I", size) + data
    return b"RIFF" + struct.pack("<I", 4 + len(body) if whole is not False else 0) + b"WAVE" + body


def test_a_head_of_a_sound_that_contradicts_itself_is_refused(tmp_path):
    assert sc.data.read_sound(written(tmp_path, wav(channels=2)))[1].size == 16
    for raw in (wav(pace=8000), wav(frame=4), wav(channels=2, frame=2), wav(bits=8, frame=2)):
        with pytest.raises(ValueError, match="file.csv: the header of this WAV file contradicts itself"):
            sc.data.read_sound(written(tmp_path, raw))


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e30])
@pytest.mark.parametrize("kind", ["<f4", "<f8"])
def test_a_sound_with_samples_that_are_no_numbers_is_refused(tmp_path, bad, kind):
    data = np.array([0.5, 0.25, 0.5, bad, 0.0, 0.0], kind).tobytes()
    with pytest.raises(ValueError, match="file.csv: sample 1 of this WAV file is .*: the file is damaged"):
        sc.data.read_sound(written(tmp_path, wav(3, 2, 8000, 8 * np.dtype(kind).itemsize, data)))


def test_a_sound_whose_size_is_zero_goes_to_the_end_only_if_it_was_cut_off(tmp_path):
    assert sc.data.read_sound(written(tmp_path, wav(whole=False)))[1].size == 32
    with pytest.raises(ValueError, match="no samples"):  # the bytes that follow are no samples
        sc.data.read_sound(written(tmp_path, wav(whole=None)))


# size


@pytest.mark.parametrize("read", READERS)
def test_more_bytes_than_the_limit_are_refused_while_they_are_read(tmp_path, monkeypatch, read):
    path = written(tmp_path, b"t,x\n" + b"0,1\n" * 1000)
    monkeypatch.setattr(_contents, "MOST_BYTES", 4003)
    with pytest.raises(ValueError, match="file.csv: more than 4,003 bytes; cut the file into parts"):
        read(path)
    monkeypatch.setattr(_contents, "MOST_BYTES", 4004)
    assert sc.data.read_table(path)["x"].size == 1000
    assert sc.data.MOST_BYTES == 100_000_000


@pytest.mark.parametrize("method", [zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_a_zip_bomb_is_refused_whatever_its_header_says(tmp_path, monkeypatch, method):
    raw = zipped(("A.csv", "t,x\n" + "0,1\n" * 50_000), ("B.csv", "t,x\n" + "0,1\n" * 50_000), method=method)
    assert len(raw) < 50_000
    lying = raw.replace(struct.pack("<I", 200_004), struct.pack("<I", 100))
    assert lying != raw
    monkeypatch.setattr(_contents, "MOST_BYTES", 300_000)
    with pytest.raises(ValueError, match="file.csv: more than"):
        sc.data.read_phyphox(written(tmp_path, raw))  # each table alone is below the limit
    with pytest.raises(ValueError, match="file.csv: "):
        sc.data.read_phyphox(written(tmp_path, lying))
    monkeypatch.setattr(_contents, "MOST_BYTES", 400_008)
    assert sc.data.read_phyphox(written(tmp_path, raw))["B"]["x"].size == 50_000


def test_a_table_of_lines_that_are_cut_off_is_refused_before_it_fills_the_memory(tmp_path, monkeypatch):
    monkeypatch.setattr(_tracker, "MOST_BYTES", 10_000)
    wide = ",".join(f"c{k}" for k in range(200)) + "\n" + ",".join(["1"] * 200) + "\n"
    with pytest.raises(ValueError, match="200 column names above 101 lines are too many cells"):
        sc.data.read_table(written(tmp_path, wide + "1\n" * 100))


def test_numbers_are_sought_in_the_first_ten_thousand_lines(tmp_path):
    notes = "nothing;here\n" * 9998
    assert sc.data.read_table(written(tmp_path, notes + "t;x\n1;2\n"))["x"].tolist() == [2.0]
    with pytest.raises(ValueError, match="file.csv: not a table: no line of column names"):
        sc.data.read_table(written(tmp_path, notes + "more\nt;x\n1;2\n"))


def seconds(read, path):
    best = np.inf
    for _ in range(3):
        begun = time.process_time()
        with contextlib.suppress(ValueError):
            read(path)
        best = min(best, time.process_time() - begun)
    return best


@pytest.mark.parametrize(
    "made",
    [
        lambda n: ",".join(f"c{k}" for k in range(n)) + "\n" + ",".join(["1"] * n) + "\n",
        lambda n: "t" + 4 * n * " " + "x\n1 2\n2 3\n",
        lambda n: "t" + 4 * n * " " + "x,y\n1,2\n2,3\n",
        lambda n: "t" + 4 * n * "(" + ",x\n1,2\n",
        lambda n: '"' + 4 * n * '"' + ",x\n1,2\n",
    ],
    ids=["columns", "spaces between names", "spaces in a name", "brackets", "quotes"],
)  # fmt: skip
def test_the_time_of_a_table_grows_as_its_length(tmp_path, made):
    short, long = (written(tmp_path, made(n), f"{n}.csv") for n in (4000, 32_000))
    # quadratic time would be 64 times as long
    assert seconds(sc.data.read_table, long) < 25 * seconds(sc.data.read_table, short) + 0.05


# random damage


def refused(read, path):
    """What is wrong with the response to a file: a table of finite numbers or a named error is right."""
    try:
        found = read(path)
    except ValueError as e:
        return None if type(e) is ValueError and ("file" in str(e) or "tracks" in str(e)) else repr(e)
    except OSError:
        return None
    except Exception as e:
        return repr(e)
    held = found.values() if isinstance(found, dict) else [found]
    arrays = [
        x for one in held for x in (one.values() if isinstance(one, dict) else one) if hasattr(x, "dtype")
    ]
    return "infinite" if any(np.isinf(x).any() for x in arrays) else None


def seeds():
    """Valid files of every supported kind."""
    flicks, film, down = (
        sc.data.example(name).read_bytes() for name in ("flicks", "tube_from_above", "spin_down")
    )
    quoted = b'\xef\xbb\xbf"t (s)";"x (cm)"\r\n"0,5";1,25\r\n1,0;NA\r\n2,0;-3,5e-1\r\n'
    two = b"#multi:\n\tO\t\tX\t\nt\tx\ty\tx\ty\n0\t1\t2\t3\t4\n1\t2\t3\t4\t5\n2\t3\t4\t6\t6\n"
    tables = [
        flicks,
        film[:600],
        down[:300],
        quoted,
        quoted.decode("utf-8-sig").encode("utf-16"),
        two,
        b"t x\n0 1\n1 2\n",
    ]
    methods = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA)
    zips = [zipped(("a/Raw.csv", "t,x\n" + "0,1\n1,2\n" * 10), method=method) for method in methods]
    floats = np.array([0, 0.5, -1], "<f4").tobytes()
    return [*tables, *zips, wav(channels=2), wav(bits=24), wav(3, 1, 8000, 32, floats)]


def torn(raw, rng):
    """A file with a few bytes changed, removed, moved or inserted."""
    raw = bytearray(raw)
    for _ in range(rng.randint(1, 5)):
        k, what = rng.randrange(len(raw) + 1), rng.randrange(4)
        if what == 0 and k < len(raw):
            raw[k] ^= 1 << rng.randrange(8)
        elif what == 1:
            del raw[k : k + rng.randint(1, 8)]
        elif what == 2:
            raw[k:k] = bytes(raw[rng.randrange(len(raw) + 1) :][: rng.randint(1, 30)])
        else:
            raw[k:k] = bytes(
                rng.choices(b"\"',;\t \r\n\0.+-eEainf#%:()[]0123456789\xff\xfe", k=rng.randint(1, 3))
            )
    return bytes(raw)


def odd():
    """Files that are neither tables nor sounds, by their oddity."""
    digits, many = 10**6 * b"9", b",".join(b"c%d" % k for k in range(3000))
    return {
        "nothing": b"", "a line": b"t,x", "a mark": b"\xef\xbb\xbf", "marks": b"\xff\xfe", "zeros": bytes(100),
        "a zero": b"t,x\n" + b"1,2\n" * 500 + b"1,\0\n", "digits": b"t,x\n0," + digits + b"\n1,2\n",
        "decimals": b"t,x\n0,0." + digits + b"\n", "tiny": b"t,x\n1,1e-999999999999\n", "names": many + b"\n1\n",
        "commas": 10**5 * b"," + b"\n1,2\n", "quotes": 10**5 * b'"', "brackets": b"t" + 10**5 * b" (" + b" x\n1 2\n",
        "UTF-16": "t,x\n1,2\n".encode("utf-16-be"), "UTF-32": "t,x\n1,2\n".encode("utf-32"), "lines": 10**5 * b"\n",
        "far": b"t,x,y\n0,1e308,1\n1,-1e308,1\n2,1e308,1\n", "huge chunk": wav()[:40] + b"\xff\xff\xff\xff" + bytes(9),
        "chunks": b"RIFF\0\0\0\0WAVE" + 10**4 * b"junk\0\0\0\0", "channels": wav(1, 65535, 1, 8, bytes(100)),
        "nested": zipped(("x.csv", zipped(("y.csv", "t,x\n0,1\n")))), "folder": zipped(("d.csv/", "")),
        "password": zipped(("x.csv", "t,x\n0,1\n")).replace(b"PK\1\2\x14\3\x14\0\0\0", b"PK\1\2\x14\3\x14\0\1\0"),
        "end alone": b"PK\5\6" + bytes(18), "start alone": b"PK\3\4" + bytes(60),
    }  # fmt: skip


@pytest.mark.parametrize("read", READERS, ids=lambda read: read.__name__)
def test_whatever_a_file_holds_it_is_read_or_refused_with_its_name(tmp_path, read):
    rng = random.Random(14)
    files = {f"odd: {name}": raw for name, raw in odd().items()}
    for k, seed in enumerate(seeds()):
        files |= {f"{k} cut at {n}": seed[:n] for n in range(0, len(seed), 5)}
        files |= {f"{k} torn, {n}": torn(seed, rng) for n in range(25)}
    files |= {
        f"text {n}": bytes(rng.choices(b'tx",; \n\n.-+e12#()inf', k=rng.randint(0, 40))) for n in range(150)
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # about tracks that are no film of a tube
        wrong = {name: refused(read, written(tmp_path, raw)) for name, raw in files.items()}
    wrong = {name: said for name, said in wrong.items() if said}
    assert not wrong, "\n".join(f"{name}: {said}" for name, said in wrong.items())


def test_a_table_cut_off_anywhere_has_the_numbers_of_its_whole_lines(tmp_path):
    raw = sc.data.example("spin_down").read_bytes()[:800]
    whole = np.array(list(sc.data.read_table(written(tmp_path, raw)).values()))
    for end in range(raw.index(b"\n", 60) + 1, len(raw)):
        found = np.array(list(sc.data.read_table(written(tmp_path, raw[:end])).values()))
        lines = raw[:end].count(b"\n") - 1
        assert np.array_equal(found[:, :lines], whole[:, :lines]), raw[:end][-60:]


@pytest.mark.parametrize("read", READERS, ids=lambda read: read.__name__)
def test_what_is_no_file_is_an_os_error_and_what_is_no_path_a_type_error(tmp_path, read):
    for path in (tmp_path, tmp_path / "nowhere", tmp_path / "file.csv" / "within", "x" * 5000):
        with pytest.raises(OSError):
            read(path)
    for name in ("a\0b", "\ud800\udfff"):
        with pytest.raises(ValueError, match="^path = .*: no file can have this name"):
            read(name)
    if read is not filmed:
        for path in (None, 3, b"file.csv", [], tmp_path.exists):
            with pytest.raises(TypeError, match="^path: expected the path of a file, not "):
                read(path)
