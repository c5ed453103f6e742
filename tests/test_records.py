"""Ownership of folders: a sweep is saved to a new folder or to its own store, and changes nothing else."""

import os
import random
import shutil
import warnings
from pathlib import Path

import dask.array as da
import numpy as np
import pytest
import xarray as xr
import zarr

import spincyl as sc
from spincyl.sweep import _records

THETA, ELL = np.linspace(0.1, 1.5, 5), np.linspace(0.5, 3.0, 4)


def lazy(ell=ELL, want=("rate", "region")):
    return sc.sweep.portrait(THETA, da.from_array(ell, chunks=2), want=want)


def files(*folders):
    """Every file of these folders, with its bytes."""
    return {p: p.read_bytes() for f in folders for p in sorted(Path(f).rglob("*")) if p.is_file()}


def beside(store):
    return Path(f"{store}.sweep")


def right(saved, ell=ELL):
    expected = sc.sweep.portrait(THETA, ell, want=("rate", "region"))
    same = all(np.array_equal(saved[k], expected[k], equal_nan=True) for k in expected.variables)
    return same and set(saved.variables) == set(expected.variables)


def quietly(store, ell=ELL):
    """Save to the store again; returns it and the warnings."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        saved = sc.sweep.save(lazy(ell), store).load()
    return saved, [str(w.message) for w in caught]


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    store = tmp_path_factory.mktemp("good") / "good.zarr"
    sc.sweep.save(lazy(), store)
    return store


@pytest.fixture
def store(good, tmp_path):
    """A copy of a complete store with its records, under another name."""
    shutil.copytree(good, tmp_path / "copy.zarr")
    shutil.copytree(beside(good), tmp_path / "copy.zarr.sweep")
    return tmp_path / "copy.zarr"


# other folders are left unchanged


def foreign(folder, kind):
    """A folder that no sweep has begun."""
    folder.mkdir()
    if kind == "zarr":
        xr.Dataset({"rate": ("theta", THETA)}).to_zarr(folder, consolidated=False)
    elif kind == "derived":  # with the attributes of a sweep
        saved = sc.sweep.save(lazy(), folder.parent / "first.zarr").load()
        (saved + 1).assign_attrs(saved.attrs).to_zarr(folder, consolidated=False)
    elif kind == "a folder in it":
        (folder / "rate").mkdir()
        (folder / "rate" / "zarr.json").write_text("{}")
    else:
        (folder / "precious.txt").write_text("a year of work")


@pytest.mark.parametrize("kind", ["a file in it", "a folder in it", "zarr", "derived"])
@pytest.mark.parametrize("neighbour", ["none", "empty", "of this sweep"])
def test_a_folder_that_no_sweep_has_begun_is_refused_whatever_lies_beside_it(tmp_path, good, kind, neighbour):
    foreign(tmp_path / "data", kind)
    if neighbour == "empty":
        beside(tmp_path / "data").mkdir()
    elif neighbour != "none":
        shutil.copytree(beside(good), beside(tmp_path / "data"))
    before, there = files(tmp_path), sorted(os.listdir(tmp_path))
    for refused in (
        lambda path: sc.sweep.save(lazy(), path),
        lambda path: sc.sweep.block_size(lazy, path=path),
    ):
        with pytest.raises(FileExistsError, match=r"not a sweep that save began: '.*data'"):
            refused(tmp_path / "data")
    assert files(tmp_path) == before and sorted(os.listdir(tmp_path)) == there


@pytest.mark.parametrize("name", ["precious.txt", "job.json", "lock", "theta-0_ell-0", "ell-0"])
def test_a_folder_beside_it_that_is_no_sweeps_is_refused(tmp_path, name):
    beside(tmp_path / "data").mkdir()
    (beside(tmp_path / "data") / name).write_text("a year of work")
    before = files(tmp_path)
    with pytest.raises(FileExistsError, match=r"holds no records of a sweep.*data\.sweep'"):
        sc.sweep.save(lazy(), tmp_path / "data")
    assert files(tmp_path) == before and not (tmp_path / "data").exists()


def test_what_a_user_puts_into_a_store_stays_there_and_warns_of_nothing(store):
    mine = [store / "notes.txt", store / "rate" / "a.partial", store / "sub" / "b", beside(store) / "c"]
    for file in mine:
        file.parent.mkdir(exist_ok=True)
        file.write_text("mine")
    assert quietly(store)[1] == []
    for torn in ("rate/zarr.json", "zarr.json", "theta/c/0", "rate/c/0/1"):
        (store / torn).unlink()
    saved, said = quietly(store)
    assert right(saved) and len(said) == 1
    assert all(file.read_text() == "mine" for file in mine)


def test_an_empty_folder_becomes_a_store(tmp_path):
    (tmp_path / "a").mkdir(), (tmp_path / "a.sweep").mkdir()
    assert right(sc.sweep.save(lazy(), tmp_path / "a"))


@pytest.mark.parametrize("path", ["", ".", "..", "/", "a/.."])
def test_a_path_without_a_name_of_its_own_is_refused_by_name(path):
    for refused in (lambda x: sc.sweep.save(lazy(), x), lambda x: sc.sweep.block_size(lazy, path=x)):
        with pytest.raises(ValueError, match="^path = .*: expected a folder by its own name"):
            refused(path)


@pytest.mark.parametrize("path", [3, b"x", ["x"], object()])
def test_what_is_no_path_is_a_type_error_by_name(path):
    for refused in (lambda x: sc.sweep.save(lazy(), x), lambda x: sc.sweep.block_size(lazy, path=x)):
        with pytest.raises(TypeError, match="^path: expected the path of a file"):
            refused(path)
    with pytest.raises(ValueError, match="^path = .*: no file can have this name"):
        sc.sweep.save(lazy(), "a\0b")


def test_a_link_is_the_folder_that_it_leads_to(tmp_path):
    (tmp_path / "disk").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "disk" / "real")
    assert right(sc.sweep.save(lazy(), tmp_path / "link"))
    assert sorted(os.listdir(tmp_path / "disk")) == ["real", "real.sweep"]
    assert quietly(tmp_path / "disk" / "real")[1] == []
    (tmp_path / "ring").symlink_to(tmp_path / "ring")
    with pytest.raises(OSError, match="ring"):
        sc.sweep.save(lazy(), tmp_path / "ring")


def test_what_is_a_file_is_refused_with_its_path(tmp_path):
    (tmp_path / "a").write_text("mine")
    with pytest.raises(FileExistsError, match="not a sweep that save began: .*a'"):
        sc.sweep.save(lazy(), tmp_path / "a")
    (tmp_path / "b.sweep").write_text("mine")
    with pytest.raises(OSError, match=r"b\.sweep"):
        sc.sweep.save(lazy(), tmp_path / "b")
    assert (tmp_path / "a").read_text() == (tmp_path / "b.sweep").read_text() == "mine"


def test_what_is_no_lazy_sweep_is_refused_by_name(tmp_path, store):
    for bad in (lazy().compute(), xr.open_zarr(store), xr.Dataset(), lazy()["rate"], None):
        with pytest.raises(TypeError, match="^result: expected a lazy Dataset"):
            sc.sweep.save(bad, tmp_path / "a")
    assert not (tmp_path / "a").exists()


def refused(path, first):
    """Saving is refused by the name of the first foreign file, and changes nothing."""
    before = files(path)
    with pytest.raises(
        FileExistsError, match=rf"{first} is not of this sweep, and save overwrites only what"
    ):
        sc.sweep.save(lazy(), path)
    assert files(path) == before


def test_a_group_of_ones_own_with_an_array_copied_from_a_store_is_refused(good, tmp_path):
    group = zarr.open_group(tmp_path / "mine", mode="w")
    group.attrs["note"] = "a year of work"
    shutil.copytree(good / "rate", tmp_path / "mine" / "rate")
    refused(tmp_path / "mine", "zarr.json")
    group.create_array("theta", shape=(5,), dtype="f8")[:] = 7.0
    refused(tmp_path / "mine", "theta/zarr.json")
    (tmp_path / "old" / "rate").mkdir(parents=True)
    shutil.copytree(good / "rate", tmp_path / "old" / "rate", dirs_exist_ok=True)
    (tmp_path / "old" / ".zgroup").write_text('{"zarr_format": 2}')
    refused(tmp_path / "old", ".zgroup")


def test_an_array_of_a_store_that_was_replaced_is_refused_by_its_name(store):
    group = zarr.open_group(store, mode="r+")
    del group["theta"]
    group.create_array("theta", shape=(5,), dtype="f8")[:] = 7.0
    refused(store, "theta/zarr.json")
    shutil.rmtree(store / "theta")
    assert right(quietly(store)[0])


@pytest.mark.filterwarnings("ignore:Consolidated metadata")
def test_what_a_user_adds_to_a_store_with_xarray_and_zarr_survives_a_save(store):
    xr.Dataset({"mine": (("theta", "ell"), np.ones((5, 4)))}).to_zarr(store, mode="a")
    zarr.open_group(store, mode="r+").attrs["note"] = "do not trust row 3"
    zarr.open_group(store, mode="r+")["rate"].attrs["note"] = "of the second run"
    partial = store / "mine" / "c.0123456789abcdef0123456789abcdef.partial"
    partial.write_text("another process writes here")
    quietly(store)  # xarray has removed the attributes of the sweep
    again, said = quietly(store)
    assert said == [] and partial.exists() and right(again.drop_vars("mine"))
    assert again["mine"].values.tolist() == np.ones((5, 4)).tolist()
    assert again.attrs["note"] == "do not trust row 3" and "spincyl_sweep" in again.attrs
    rate = zarr.open_group(store, mode="r", use_consolidated=False)["rate"]
    assert rate.attrs["note"] == "of the second run"
    before = files(store)
    shutil.rmtree(beside(store))
    shutil.rmtree(store / "rate" / "c")
    (store / "zarr.json").write_bytes(before[store / "zarr.json"].replace(b"row 3", b"row 4"))
    assert right(quietly(store)[0].drop_vars("mine")) and before.keys() == files(store).keys()


def test_an_attribute_of_the_sweep_that_was_changed_is_named(store):
    group = zarr.open_group(store, mode="r+")
    name = next(iter(group["rate"].attrs))
    group["rate"].attrs[name] = "mine"
    assert any(f"changed attributes are restored: {name} of rate/zarr.json" in x for x in quietly(store)[1])
    assert quietly(store)[1] == []


# copied, renamed, moved


def test_a_copy_goes_on_where_it_was_and_without_its_marks_it_is_computed_again(store):
    before = files(store)
    assert quietly(store)[1] == []
    assert sc.sweep.block_size(lazy, path=store) == 5 * 2
    shutil.rmtree(beside(store))
    saved, said = quietly(store)
    assert said == [f"{store}: copy.zarr.sweep is gone, and all 2 blocks are computed again"]
    assert right(saved) and files(store) == before and quietly(store)[1] == []


def test_records_of_another_sweep_are_no_ones_but_its_own(store, tmp_path):
    sc.sweep.save(lazy(ELL + 1), tmp_path / "other.zarr")
    before = files(tmp_path)
    shutil.rmtree(beside(store))
    shutil.move(beside(tmp_path / "other.zarr"), beside(store))
    with pytest.raises(
        ValueError, match=r"copy\.zarr\.sweep: this folder has the marks of another sweep \(ell differs\)"
    ):
        sc.sweep.save(lazy(), store)
    with pytest.raises(ValueError, match=r"copy\.zarr: this store holds another sweep \(ell differs\)"):
        sc.sweep.save(lazy(ELL + 1), store)
    shutil.move(beside(store), beside(tmp_path / "other.zarr"))
    assert all(file.read_bytes() == raw for file, raw in before.items() if file.exists())


def test_marks_of_another_sweep_are_not_taken_for_those_of_this_one(store, tmp_path):
    """The regions are all fill values, so no file is on disk that a wrong mark could miss."""
    flat = sc.sweep.portrait(np.full(3, 2.0), da.from_array(ELL, chunks=2), want="region")
    sc.sweep.save(flat, tmp_path / "flat.zarr")
    (beside(tmp_path / "flat.zarr") / "job.json").unlink()
    shutil.move(beside(tmp_path / "flat.zarr"), beside(tmp_path / "new.zarr"))
    new = sc.sweep.portrait(THETA, da.from_array(ELL, chunks=2), want="region")
    with pytest.warns(UserWarning, match="2 of 2 blocks are missing or damaged"):
        saved = sc.sweep.save(new, tmp_path / "new.zarr")
    assert np.array_equal(saved["region"], sc.sweep.portrait(THETA, ELL, want="region")["region"])


def test_a_sweep_that_was_changed_by_hand_is_another_one(store):
    for changed, what in (
        (lazy().isel(theta=slice(1, None)), "chunks"),
        (lazy().drop_vars("region"), "variables"),
        (lazy().chunk(theta=2), "chunks"),
        (lazy().astype("float32"), "variables"),
    ):
        changed.attrs = lazy().attrs
        with pytest.raises(
            ValueError, match=rf"holds another sweep \({what} is .* there, .* here\); use another path"
        ):
            sc.sweep.save(changed, store)


def test_lazy_numbers_and_lazy_coordinates_are_written_and_checked(tmp_path):
    point = sc.sweep.portrait(da.from_array(np.array(1.3), chunks=()), 2.0, want="rate")
    saved = sc.sweep.save(point, tmp_path / "point")
    assert float(saved["rate"]) == float(sc.Body.solid(2.0).rate(1.3)) and float(saved["theta"]) == 1.3
    (tmp_path / "point" / "rate" / "c").write_bytes(b"torn")
    with pytest.warns(UserWarning, match="1 of 1 blocks"):
        assert float(sc.sweep.save(point, tmp_path / "point")["rate"]) == float(saved["rate"])
    ell = xr.DataArray(
        da.from_array(ELL, chunks=2), dims="ell", coords={"mass": ("ell", da.arange(4, chunks=2))}
    )
    body = sc.Body.solid(ell)
    saved = sc.sweep.save(sc.sweep.roll(body, sc.State(1.3, 0.5, 0.1, 1.0), 1.0), tmp_path / "named")
    assert saved["mass"].values.tolist() == [0, 1, 2, 3]


# damage


def damages(raw, rng):
    """Damaged versions of a file's bytes."""
    flipped = bytearray(raw)
    flipped[rng.randrange(len(raw))] ^= 1 << rng.randrange(8)
    return {
        "gone": None,
        "empty": b"",
        "cut off": raw[: rng.randrange(len(raw))],
        "flipped": bytes(flipped),
        "nested": b"[" * 100_000,
        "a list": b"[]",
        "no text": b"\xff\xfe",
    }


@pytest.mark.parametrize("every", [False, pytest.param(True, marks=pytest.mark.long)])
def test_whatever_is_damaged_is_made_again_as_it_was(good, tmp_path, every):
    """Every file of a store and beside it is damaged in one way, or in every way."""
    rng, store = random.Random(1), tmp_path / "a.zarr"
    whole = {
        p.relative_to(good.parent): raw for p, raw in files(good, beside(good)).items() if p.name != "lock"
    }
    for number, (name, raw) in enumerate(whole.items()):
        kinds = list(damages(raw, rng).items())
        for what, torn in kinds if every else [kinds[number % len(kinds)]]:
            for folder in (store, beside(store)):
                shutil.rmtree(folder, ignore_errors=True)
            shutil.copytree(good, store)
            shutil.copytree(beside(good), beside(store))
            file = tmp_path / str(name).replace("good", "a", 1)
            file.unlink() if torn is None else file.write_bytes(torn)
            saved, said = quietly(store)
            told = f"{name} {what}: {said}"
            assert right(saved), told
            assert len(said) <= 1 and all(len(x) < 300 and str(store) in x for x in said), told
            assert said or beside(store) in file.parents, told
            assert {k: (tmp_path / str(k).replace("good", "a", 1)).read_bytes() for k in whole} == whole, told


def test_a_record_is_whole_or_none(tmp_path):
    rng, file = random.Random(2), tmp_path / "record"
    raw = _records.sealed({"job": {"a": "x"}, "format": 2, "chunks": {"ell": [2, 4]}})
    file.write_bytes(raw)
    assert _records._whole(file)["chunks"] == {"ell": [2, 4]}
    torn = [raw[:n] for n in range(len(raw))] + [raw + b" ", raw + raw]
    torn += [raw[:n] + bytes([raw[n] ^ (1 << rng.randrange(8))]) + raw[n + 1 :] for n in range(len(raw))]
    for bad in torn:
        file.write_bytes(bad)
        assert _records._whole(file) is None, bad


def test_a_store_all_of_whose_records_are_damaged_is_refused_with_its_path(store):
    for file in store.glob("*/spincyl.json"):
        file.write_bytes(file.read_bytes()[:-1])
    before = files(store, beside(store))
    for refused in (lambda x: sc.sweep.save(lazy(), x), lambda x: sc.sweep.block_size(lazy, path=x)):
        with pytest.raises(ValueError, match=r"copy\.zarr: its records \(bore/spincyl\.json, .* are damaged"):
            refused(store)
    assert files(store, beside(store)) == before


def test_a_place_taken_by_a_folder_is_an_os_error_with_its_path(store):
    for name in ("rate/c/0/0", "theta/c/0", "rate/zarr.json", "rate/spincyl.json", "zarr.json"):
        kept = (store / name).read_bytes()
        (store / name).unlink()
        (store / name).mkdir()
        with pytest.raises(OSError, match=r"copy\.zarr"):
            quietly(store)
        (store / name).rmdir()
        (store / name).write_bytes(kept)
    assert right(sc.sweep.save(lazy(), store))


def test_another_version_of_zarr_writes_no_block_again_unless_its_layout_is_needed(store, monkeypatch):
    from spincyl.sweep import _save

    written = _save._layout

    def other(result, record):
        return {
            name: raw + b"\n" if name.endswith(".json") else raw
            for name, raw in written(result, record).items()
        }

    monkeypatch.setattr(_save, "_layout", other)
    (store / "theta" / "c" / "0").unlink()
    saved, said = quietly(store)
    what = "1 of 17 files of metadata, coordinates and records"
    assert right(saved) and said == [f"{store}: {what} are missing or damaged and are made again"]
    (store / "rate" / "zarr.json").unlink()
    saved, said = quietly(store)
    assert right(saved) and "2 of 2 blocks are missing or damaged and are computed again" in said[0]
    assert quietly(store)[1] == []


def test_what_killed_writers_left_behind_is_removed(store):
    left = [
        store / "rate" / ".spincyl-0123456789abcdef0123456789abcdef.part.json",
        store / "rate" / "c" / "0" / "1.0123456789abcdef0123456789abcdef.partial",
        beside(store) / ".spincyl-0123456789abcdef0123456789abcdef.part",
    ]
    for file in left:
        file.touch()
    assert quietly(store)[1] == [] and not any(file.exists() for file in left)


@pytest.mark.parametrize("step", range(12))
def test_a_save_that_dies_while_it_is_laid_out_begins_again(tmp_path, monkeypatch, step):
    """As after a kill, nothing is cleaned up, and half-written files stay."""
    from spincyl._input import files

    count = iter(range(100))

    class Killed(BaseException):
        pass

    def replace(self, target):
        if next(count) == step:
            raise Killed
        os.replace(self, target)

    with monkeypatch.context() as patch:
        patch.setattr(files.Path, "replace", replace)
        patch.setattr(files.Path, "unlink", lambda *_, **__: None)
        with pytest.raises(Killed):
            sc.sweep.save(lazy(), tmp_path / "a")
    saved, said = quietly(tmp_path / "a")
    assert right(saved) and said == []
    assert not list(tmp_path.rglob(".spincyl-*"))


def test_p3_a_disk_that_fills_while_a_store_is_laid_out_is_an_os_error_with_the_path(tmp_path):
    resource, signal = pytest.importorskip("resource"), pytest.importorskip("signal")
    big = sc.sweep.portrait(np.linspace(0.1, 1.5, 600), da.from_array(np.linspace(0.5, 3, 500), chunks=250))
    before, handler = resource.getrlimit(resource.RLIMIT_FSIZE), signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (3000, before[1]))
        with pytest.raises(OSError, match=r"File too large.*a\.zarr"):
            sc.sweep.save(big, tmp_path / "a.zarr")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)
    assert sc.sweep.save(big, tmp_path / "a.zarr")["rate"].shape == (600, 500)
