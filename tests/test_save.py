"""Sweeps on disk: killed, damaged, refused, resumed."""

import os
import random
import shutil
import signal
import subprocess
import sys
import time
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
    """Every file of a store."""
    return {p.relative_to(store): p.read_bytes() for p in sorted(Path(store).rglob("*")) if p.is_file()}


def test_a_saved_map_is_the_map(tmp_path):
    told = []
    saved = sc.sweep.save(lazy(), tmp_path / "map.zarr", progress=told.append)
    expected = sc.sweep.portrait(THETA, ELL, want=("rate", "region"))
    assert all(np.array_equal(saved[k], expected[k], equal_nan=True) for k in expected)
    assert np.array_equal(saved["theta"], THETA) and told[-1] == 1.0
    # nothing is computed again
    before = contents(tmp_path / "map.zarr")
    stamp = (tmp_path / "map.zarr" / "rate" / "c" / "0" / "0").stat().st_mtime_ns
    sc.sweep.save(lazy(), tmp_path / "map.zarr")
    assert contents(tmp_path / "map.zarr") == before
    assert (tmp_path / "map.zarr" / "rate" / "c" / "0" / "0").stat().st_mtime_ns == stamp


def test_a_saved_ensemble_is_the_ensemble(tmp_path):
    body = sc.Body.solid(da.from_array(ELL, chunks=20))
    state = sc.State(1.3, da.from_array(0.5 + 0.1 * ELL, chunks=20), 0.05, 1.0)
    saved = sc.sweep.save(sc.sweep.roll(body, state, times=[1.0, 2.0]), tmp_path / "a.zarr")
    expected = sc.sweep.roll(sc.Body.solid(ELL), sc.State(1.3, 0.5 + 0.1 * ELL, 0.05, 1.0), times=[1.0, 2.0])
    assert all(np.array_equal(saved[k], expected[k], equal_nan=True) for k in expected)


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
    with pytest.raises(FileExistsError, match="no sweep that could go on"):
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
    with pytest.raises(ValueError, match="ell is content .* there"):
        sc.sweep.save(lazy(top=2.9), store)
    with pytest.raises(ValueError, match="want is .'rate', 'region'. there, .'rate',. here"):
        sc.sweep.save(lazy(want=("rate",)), store)
    monkeypatch.setattr("spincyl.sweep._common.version", lambda name: "99.0")
    with pytest.raises(ValueError, match=r"spincyl is .* there, 99.0 here"):
        sc.sweep.save(lazy(), store)
    with pytest.raises(TypeError, match="expected a lazy Dataset"):
        sc.sweep.save(xr.Dataset(), store)


JOB = """
import sys, dask, dask.array as da, numpy as np, spincyl as sc
path, workers = sys.argv[1], int(sys.argv[2])
def main():
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
    main()
"""


def interrupted(script, store, workers, wait):
    """Starts the job and kills it, workers and all, this long after it is ready; whether it was done before."""
    with subprocess.Popen(
        [sys.executable, "-W", "ignore", script, store, str(workers)],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
    ) as process:
        process.stdout.readline()
        time.sleep(wait)
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        return "saved" in process.stdout.read()


def record(store):
    return Path(f"{store}.sweep")


def survive(tmp_path, kills, workers, longest):
    """Kills a save until so many kills are survived, again and again from the start; (kills, blocks repeated)."""
    script = tmp_path / "job.py"
    script.write_text(JOB)
    plain = tmp_path / "plain.zarr"
    assert subprocess.run([sys.executable, script, plain, "0"], capture_output=True, check=True)
    expected, random_wait = contents(plain), random.Random(1)
    survived, repeated, store = 0, 0, tmp_path / "killed.zarr"
    while survived < kills:
        shutil.rmtree(store, ignore_errors=True)
        shutil.rmtree(record(store), ignore_errors=True)
        while survived < kills:
            done = interrupted(script, store, workers, random_wait.uniform(0, longest))
            if done:
                break
            survived += 1
            marked = {p.name for p in record(store).glob("*") if p.suffix != ".part"} - {"job.json"}
            chunks = {f"theta-{p.parent.name}_{p.name}" for p in store.glob("rate/c/*/*") if p.name.isdigit()}
            repeated = max(repeated, len(chunks) - len(marked))
        subprocess.run([sys.executable, script, store, "0"], capture_output=True, check=True)
        assert contents(store) == expected
    return survived, repeated


@pytest.mark.parametrize("workers", [0, 2])
def test_p1_a_sweep_survives_being_killed(tmp_path, workers):
    kills, repeated = survive(tmp_path, 4, workers, 0.5 if workers == 0 else 1.5)
    assert kills == 4
    # at most one block for each worker that was writing: dask has as many threads as cores, or two workers
    assert repeated <= (os.cpu_count() if workers == 0 else 2)
