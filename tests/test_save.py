"""Sweeps on disk: killed, damaged, refused, resumed."""

import errno
import os
import random
import re
import runpy
import shutil
import signal
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

import dask.array as da
import numpy as np
import pytest
import xarray as xr

import spincyl as sc

THETA, ELL = np.linspace(0.01, 1.57, 90), np.linspace(0.1, 3, 80)


def lazy(top=3.0, want=("rate", "region")):
    ell = np.linspace(0.1, top, 80)
    return sc.sweep.portrait(da.from_array(THETA, chunks=30), da.from_array(ell, chunks=20), want=want)


def contents(store):
    """Every file of a store, with its bytes."""
    return {p.relative_to(store): p.read_bytes() for p in sorted(Path(store).rglob("*")) if p.is_file()}


def test_a_saved_map_is_the_map(tmp_path):
    told = []
    saved = sc.sweep.save(lazy(), tmp_path / "map.zarr", progress=told.append)
    expected = sc.sweep.portrait(THETA, ELL, want=("rate", "region"))
    assert all(np.array_equal(saved[k], expected[k], equal_nan=True) for k in expected)
    assert {k: saved[k].dtype for k in expected} == {k: expected[k].dtype for k in expected}
    assert np.array_equal(saved["theta"], THETA) and told[-1] == 1.0
    # a second save computes nothing
    before = contents(tmp_path / "map.zarr")
    stamp = (tmp_path / "map.zarr" / "rate" / "c" / "0" / "0").stat().st_mtime_ns
    sc.sweep.save(lazy(), tmp_path / "map.zarr")
    assert contents(tmp_path / "map.zarr") == before
    assert (tmp_path / "map.zarr" / "rate" / "c" / "0" / "0").stat().st_mtime_ns == stamp


@pytest.mark.parametrize("name", ["~", "~/in", "a::b", "file::c", "http:d", "-y"])
def test_a_store_has_the_name_that_it_was_given_and_nothing_else_is_touched(tmp_path, monkeypatch, name):
    (tmp_path / "home").mkdir()
    (tmp_path / "here" / "a").mkdir(parents=True)
    kept = [tmp_path / "home" / "kept", tmp_path / "here" / "a" / "kept"]
    for file in kept:
        file.touch()
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.chdir(tmp_path / "here")
    Path(name).parent.mkdir(exist_ok=True)
    sc.sweep.save(lazy(), name)
    saved = sc.sweep.save(lazy(), name)
    assert np.array_equal(
        saved["rate"], sc.sweep.portrait(THETA, ELL, want=("rate",))["rate"], equal_nan=True
    )
    assert Path(saved.encoding["source"]) == tmp_path / "here" / name
    assert all(file.exists() for file in kept) and os.listdir("../home") == ["kept"]
    there = {p.relative_to(".").as_posix() for p in Path(name).parent.iterdir()}
    assert there - {"a", "~"} | {name} == {name, f"{name}.sweep"}


def test_a_saved_ensemble_is_the_ensemble(tmp_path):
    body = sc.Body.solid(da.from_array(ELL, chunks=20))
    state = sc.State(1.3, da.from_array(0.5 + 0.1 * ELL, chunks=20), 0.05, 1.0)
    saved = sc.sweep.save(sc.sweep.roll(body, state, [1.0, 2.0]), tmp_path / "a.zarr")
    expected = sc.sweep.roll(sc.Body.solid(ELL), sc.State(1.3, 0.5 + 0.1 * ELL, 0.05, 1.0), [1.0, 2.0])
    assert all(np.array_equal(saved[k], expected[k], equal_nan=True) for k in expected)


def test_a_store_opens_without_a_warning_and_so_does_a_map_of_many_blocks(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # dask warns of a product with more than ten times the blocks of its inputs
        ell = da.from_array(ELL, chunks=7)
        many = sc.sweep.portrait(da.from_array(THETA, chunks=8), ell, want="rate")
        sc.sweep.roll(
            sc.Body.solid(xr.DataArray(ell, dims="ell")),
            sc.State(1.3, xr.DataArray(ell, dims="w"), 0, 1.0),
            1.0,
        )
        sc.sweep.save(many, tmp_path / "map.zarr")
        assert xr.open_zarr(tmp_path / "map.zarr")["rate"].shape == (90, 80)


SAVE = """
import sys, numpy as np, dask.array as da, spincyl as sc
job = sc.sweep.portrait(da.linspace(0.01, 1.57, 90, chunks=30), da.linspace(0.1, 3, 80, chunks=20), want="rate")
def told(share):
    print(share, flush=True)
    sys.stdin.readline()
sc.sweep.save(job, sys.argv[1], progress=told)
"""


def test_p5_the_second_of_two_processes_that_save_at_once_is_told_so(tmp_path):
    store = tmp_path / "map.zarr"
    theta, ell = da.linspace(0.01, 1.57, 90, chunks=30), da.linspace(0.1, 3, 80, chunks=20)
    job = sc.sweep.portrait(theta, ell, want="rate")
    with subprocess.Popen(
        [sys.executable, "-c", SAVE, store], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as first:
        first.stdout.readline()  # wait until it has begun
        with pytest.raises(BlockingIOError, match=r"another process or thread is saving to it: .*map\.zarr"):
            sc.sweep.save(job, store)
        first.communicate("\n" * 9)
        assert first.returncode == 0
    stamp = (store / "rate" / "c" / "0" / "0").stat().st_mtime_ns
    saved = sc.sweep.save(job, store)
    assert (store / "rate" / "c" / "0" / "0").stat().st_mtime_ns == stamp
    assert np.array_equal(
        saved["rate"], sc.sweep.portrait(theta.compute(), ell.compute())["rate"], equal_nan=True
    )


@pytest.mark.long
def test_p5_many_that_begin_at_once_leave_a_good_store(tmp_path):
    store = tmp_path / "map.zarr"
    pipes = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE)
    jobs = [subprocess.Popen([sys.executable, "-c", SAVE, store], text=True, **pipes) for _ in range(3)]
    said = [job.communicate("\n" * 9)[1] for job in jobs]
    assert 0 in (job.returncode for job in jobs)
    assert all(job.returncode == 0 or "BlockingIOError" in err for job, err in zip(jobs, said, strict=True))
    theta, ell = da.linspace(0.01, 1.57, 90, chunks=30), da.linspace(0.1, 3, 80, chunks=20)
    again = sc.sweep.save(sc.sweep.portrait(theta, ell, want="rate"), store)
    expected = sc.sweep.portrait(theta.compute(), ell.compute())
    assert np.array_equal(again["rate"], expected["rate"], equal_nan=True)


@pytest.mark.parametrize(
    ("lost", "said"),
    [
        (
            "zarr.json",
            "1 of 17 files of metadata, coordinates and records are missing or damaged and are made again",
        ),
        ("rate/zarr.json", "1 of 17 files of metadata, coordinates and records"),
        (".", "12 of 12 blocks are missing or damaged and are computed again"),
    ],
)
def test_p5_a_store_whose_layout_is_lost_is_laid_out_again(tmp_path, lost, said):
    store = tmp_path / "map.zarr"
    sc.sweep.save(lazy(), store)
    whole, chunk = contents(store), store / "rate" / "c" / "2" / "3"
    stamp = chunk.stat().st_mtime_ns
    if lost == ".":
        shutil.rmtree(store)
    else:
        (store / lost).write_text("")
    with pytest.warns(UserWarning, match=said):
        sc.sweep.save(lazy(), store)
    assert contents(store) == whole
    assert lost == "." or chunk.stat().st_mtime_ns == stamp, "the blocks are good, and are not computed again"


def test_p5_where_nothing_can_be_locked_it_says_so(tmp_path, monkeypatch):
    def cannot(file, on):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr("spincyl.sweep._save._lock", cannot)
    with pytest.warns(UserWarning, match="cannot be locked .No locks available."):
        sc.sweep.save(lazy(), tmp_path / "map.zarr")


@pytest.mark.parametrize("damage", ["truncated", "zeroed", "gone"])
def test_p2_a_damaged_block_is_found_and_redone_with_one_warning(tmp_path, damage):
    store = tmp_path / "map.zarr"
    sc.sweep.save(lazy(), store)
    whole = contents(store)
    for chunk in (store / "rate" / "c" / "2" / "3", store / "rate" / "c" / "0" / "1"):
        if damage == "gone":
            chunk.unlink()
        else:
            size = chunk.stat().st_size
            chunk.write_bytes(chunk.read_bytes()[: size // 2] if damage == "truncated" else bytes(size))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        sc.sweep.save(lazy(), store)
    assert len(caught) == 1 and "2 of 12 blocks are missing or damaged" in str(caught[0].message)
    assert contents(store) == whole


def test_p3_what_cannot_be_written_is_an_os_error_with_its_path(tmp_path):
    with pytest.raises(OSError, match="nowhere"):
        sc.sweep.save(lazy(), tmp_path / "nowhere" / "map.zarr")
    (tmp_path / "file.zarr").write_text("something else")
    with pytest.raises(FileExistsError, match="not a sweep that save began"):
        sc.sweep.save(lazy(), tmp_path / "file.zarr")


@pytest.mark.skipif(os.geteuid() != 0 if hasattr(os, "geteuid") else True, reason="mounting needs root")
def test_p3_a_full_disk_leaves_what_can_go_on(tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1M", "none", disk], capture_output=True)
    if mounted.returncode:
        pytest.skip("no tmpfs can be mounted here")
    try:
        (disk / "ballast").write_bytes(bytes(800_000))
        theta, ell = np.linspace(0.01, 1.57, 300), np.linspace(0.1, 3, 200)
        big = sc.sweep.portrait(
            da.from_array(theta, chunks=30), da.from_array(ell, chunks=100), want=("rate",)
        )
        with pytest.raises(OSError, match="disk"):
            sc.sweep.save(big, disk / "map.zarr")
        (disk / "ballast").unlink()
        saved = sc.sweep.save(big, disk / "map.zarr")
        assert np.array_equal(saved["rate"], sc.sweep.portrait(theta, ell)["rate"], equal_nan=True)
    finally:
        subprocess.run(["umount", disk], check=True)


def test_p4_another_sweep_is_refused_by_its_first_difference(tmp_path, monkeypatch):
    store = tmp_path / "map.zarr"
    sc.sweep.save(lazy(), store)
    said = r"map.zarr: this store holds another sweep \(ell differs\); use another path, or delete the store$"
    with pytest.raises(ValueError, match=said):
        sc.sweep.save(lazy(top=2.9), store)
    with pytest.raises(ValueError, match="want is .'rate', 'region'. there, .'rate',. here"):
        sc.sweep.save(lazy(want=("rate",)), store)
    monkeypatch.setattr("spincyl.sweep._common.version", lambda name: "99.0")
    with pytest.raises(ValueError, match=r"spincyl is .* there, 99.0 here"):
        sc.sweep.save(lazy(), store)
    with pytest.raises(TypeError, match="expected a lazy Dataset"):
        sc.sweep.save(xr.Dataset(), store)


def test_a_sweep_in_memory_is_written_by_xarray_and_its_inputs_come_back(tmp_path):
    body = sc.Body.solid(np.array([2.0, 2.5]))
    motions = sc.sweep.roll(body, body.steady(1.3).kicked(0.05), [0.0, 1.0])
    told = r"^result: expected a lazy .* in memory, so save it with result.to_zarr\(path\)"
    with pytest.raises(TypeError, match=f"{told}; sweep.inputs gives back its arguments$"):
        sc.sweep.save(motions, tmp_path / "motions.zarr")
    motions.to_zarr(tmp_path / "motions.zarr", consolidated=False)
    read = xr.open_zarr(tmp_path / "motions.zarr", consolidated=False).load()
    assert sc.sweep.roll(**sc.sweep.inputs(read)).equals(motions)
    for eager in (lazy().compute(), sc.sweep.portrait([1.2, 1.3], [2.0, 2.5])):
        with pytest.raises(TypeError, match=f"{told}$"):
            sc.sweep.save(eager, tmp_path / "map.zarr")
        eager.to_zarr(tmp_path / "map.zarr", mode="w", consolidated=False)
        assert xr.open_zarr(tmp_path / "map.zarr", consolidated=False).equals(eager)


JOB = """
import sys, dask, dask.array as da, numpy as np, spincyl as sc
def main(path, workers):
    theta, ell = da.linspace(0.01, 1.57, 1600, chunks=200), da.linspace(0.1, 3, 1200, chunks=200)
    job = sc.sweep.portrait(theta, ell, want=("rate", "kappa_rolling", "region"))
    if workers:
        from dask.distributed import Client, LocalCluster
        with LocalCluster(workers, threads_per_worker=1, dashboard_address=None, processes=True) as c, Client(c):
            print("ready", flush=True); sc.sweep.save(job, path)
    else:
        print("ready", flush=True); sc.sweep.save(job, path)
    print("saved", flush=True)
if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
"""


def interrupted(script, store, workers, wait):
    """Start the job and kill it with its workers after a delay; returns whether it was done before.

    A job that ends by itself has to be complete: a failure does not count as killed.
    """
    with (
        tempfile.TemporaryFile("w+") as said,
        subprocess.Popen(
            [sys.executable, "-W", "ignore", script, store, str(workers)],
            stdout=subprocess.PIPE,
            stderr=said,
            text=True,
            start_new_session=True,
        ) as process,
    ):
        process.stdout.readline()
        try:
            ended = process.wait(wait)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            ended = process.wait()
        if ended not in (0, -signal.SIGKILL):
            said.seek(0)
            raise RuntimeError(f"the job ended by itself with code {ended}: {said.read()[-2000:]}")
        return ended == 0


def record(store):
    return Path(f"{store}.sweep")


def complete(script, store, workers):
    """Run the job to its end; with `workers` 0 in this process."""
    if not workers:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about blocks that a kill has damaged
            runpy.run_path(str(script))["main"](store, 0)
        return
    done = subprocess.run([sys.executable, script, store, str(workers)], capture_output=True, text=True)
    assert done.returncode == 0 and "saved" in done.stdout, done.stderr[-2000:]


def written(store):
    """Indices of the blocks whose first variable is on disk."""
    places = (p.parts[-2:] for p in store.glob("rate/c/*/*") if p.name.isdigit())
    return {(int(row), int(column)) for row, column in places}


def recorded(store):
    """Indices of the blocks that are marked as done, each of 200 x 200 points."""
    marks = (re.fullmatch(r"theta-(\d+)_ell-(\d+)", p.name) for p in record(store).glob("theta-*"))
    return {(int(m[1]) // 200, int(m[2]) // 200) for m in marks if m}


def survive(tmp_path, kills, workers, longest):
    """Kill a save until it has survived so many kills, anew when it is done; (kills, most lost blocks).

    A block counts as lost once, by the first kill after which it is written but not marked: the next run may
    be killed before it reaches the block. Whenever the job is done, the store has the bytes of an undisturbed
    run in one process.
    """
    script = tmp_path / "job.py"
    script.write_text(JOB)
    plain, store = tmp_path / "plain.zarr", tmp_path / "killed.zarr"
    complete(script, plain, 0)
    expected, random_wait = contents(plain), random.Random(1)
    if workers:
        complete(script, store, workers)
        assert contents(store) == expected
    survived, most = 0, 0
    while survived < kills:
        shutil.rmtree(store, ignore_errors=True)
        shutil.rmtree(record(store), ignore_errors=True)
        before = set()
        while survived < kills:
            done = interrupted(script, store, workers, random_wait.uniform(0, longest))
            if done:
                break
            survived += 1
            lost = written(store) - recorded(store)
            most, before = max(most, len(lost - before)), lost
        complete(script, store, workers)
        assert contents(store) == expected
    return survived, most


def test_p1_a_job_that_fails_by_itself_is_no_kill_survived(tmp_path):
    (tmp_path / "job.py").write_text("print('ready', flush=True); raise SystemExit('no such thing')")
    with pytest.raises(RuntimeError, match="ended by itself with code 1: no such thing"):
        interrupted(tmp_path / "job.py", tmp_path / "a.zarr", 2, 60)


@pytest.mark.parametrize("workers", [0, pytest.param(2, marks=pytest.mark.long)])
def test_p1_a_sweep_survives_being_killed(tmp_path, workers):
    kills, lost = survive(tmp_path, 2, workers, 0.5 if workers == 0 else 1.5)
    assert kills == 2
    # a kill costs at most one block for each writing thread or worker: dask has as many threads as cores
    assert lost <= (os.cpu_count() if workers == 0 else 2)
