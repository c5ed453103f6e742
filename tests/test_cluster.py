"""Sweeps on worker processes: the bits of one process, even if workers die; block sizes; traffic."""

import os
import pickle
import signal
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace

import dask
import dask.array as da
import numpy as np
import pytest
import xarray as xr

import spincyl as sc
from spincyl.sweep import _blocks
from spincyl.sweep._save import _pass

COUNT = 2_000
#: Seconds until workers must have started; a busy machine takes longer than dask's 30.
PATIENCE = 300


def job(number):
    """Motions with and without ends, which depend on their numbers only."""
    ell, theta = 0.3 + 2.5 * ((number * 0.618) % 1), 0.2 + 1.2 * ((number * 0.755) % 1)
    state = sc.State(theta, 1.0, 0.3, 0.5 + ell)
    return sc.sweep.roll(sc.Body.solid(ell), state, 3.0, want=("final", "end"))


@contextmanager
def two_workers():
    """Two workers in processes of their own; fails if they have not come after a time."""
    from dask.distributed import Client, LocalCluster

    kw = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": ":0", "processes": True}
    wait = {f"distributed.comm.timeouts.{name}": f"{PATIENCE}s" for name in ("connect", "tcp")}
    with dask.config.set(wait), LocalCluster(**kw) as started, Client(started) as client:
        client.wait_for_workers(2, timeout=PATIENCE)
        yield started


@pytest.fixture(scope="module")
def cluster():
    with two_workers() as started:
        yield started


@pytest.fixture(scope="module")
def alone():
    return job(np.arange(float(COUNT)))


def lazy(size):
    return job(da.arange(float(COUNT), chunks=size))


def contents(store):
    return {p.relative_to(store): p.read_bytes() for p in Path(store).rglob("*") if p.is_file()}


def test_two_workers_give_the_bits_of_one_process(cluster, alone):
    there = lazy(700).compute()
    assert set(np.unique(alone["status"])) > {0}, "some go on, and some end"
    assert all(np.array_equal(there[name], alone[name], equal_nan=True) for name in alone)


def test_a_map_that_workers_save_is_that_of_one_process(cluster, tmp_path):
    theta, ell, want = np.linspace(0.01, 1.57, 90), np.linspace(0.1, 3, 80), ("rate", "region")
    parts = da.from_array(theta, chunks=30), da.from_array(ell, chunks=20)
    saved = sc.sweep.save(sc.sweep.portrait(*parts, want=want), tmp_path / "map.zarr").load()
    here = sc.sweep.portrait(theta, ell, want=want)
    assert all(np.array_equal(saved[name], here[name], equal_nan=True) for name in here)


def mortal(part, store):
    """The numbers of a block; the first worker that has those of a block in the middle dies."""
    died = Path(f"{store}.died")
    if part[0] == COUNT // 2 and not died.exists():
        died.write_text(str(len(list(Path(f"{store}.sweep").glob("motion-*")))))
        os.kill(os.getpid(), signal.SIGKILL)
    return part


def test_a_killed_worker_does_not_change_the_store(alone, tmp_path):
    plain, store = tmp_path / "plain.zarr", tmp_path / "killed.zarr"
    number = da.arange(float(COUNT), chunks=50)  # 16 blocks are asked for at a time, and 40 in all
    result = job(number.map_blocks(mortal, str(store), dtype=float, meta=np.empty(0)))
    with two_workers():  # of its own, since a worker that has died may take long to come again
        saved = sc.sweep.save(result, store)
    done = int(Path(f"{store}.died").read_text())
    assert 16 <= done < 40, "it died when some blocks were done, and some were not"
    with dask.config.set(scheduler="synchronous"):
        sc.sweep.save(result, plain)
    assert contents(store) == contents(plain)
    assert all(np.array_equal(saved[name], alone[name], equal_nan=True) for name in alone)


def test_as_many_blocks_are_asked_for_as_the_workers_can_take(cluster):
    assert _pass(dask.base.get_scheduler()) == 8 * 2, "two threads, in two processes"
    with dask.config.set(scheduler="synchronous"):
        assert _pass(dask.base.get_scheduler()) == 8 * os.cpu_count()


def test_what_is_sent_does_not_grow_with_the_blocks():
    def sent(count):
        (found,) = dask.optimize(job(da.arange(8.0 * count, chunks=count)))
        return len(pickle.dumps(dict(found.__dask_graph__())))

    # the indices of the last block have more digits
    assert sent(1_000_000) < sent(10) + 1000


@pytest.fixture
def busy(monkeypatch):
    """Jobs that take so many seconds per motion, per block, and for the motion at zero, on a clock of their own."""
    spent = [0.0]
    monkeypatch.setattr(_blocks, "time", SimpleNamespace(process_time=lambda: spent[0]))

    def made(each, block=0.0, zero=0.0):
        def slow(x):
            def work(part):
                spent[0] += block + each * part.size + zero * (part == 0).sum()
                return part

            return xr.Dataset({"x": ("motion", da.map_blocks(work, x, dtype=float, meta=np.empty(0)))})

        return slow

    return made


@pytest.mark.parametrize(("seconds", "size"), [(0.11, 5_000), (1.1, 50_000), (11.0, 500_000)])
def test_a_block_takes_no_longer_than_asked(busy, seconds, size):
    assert sc.sweep.block_size(busy(2e-5), np.arange(1000.0), seconds=seconds) == size


def test_the_cost_of_a_block_is_not_counted_for_each_of_its_motions(busy):
    # 70 ms for a sample of a thousand, and 1.05 s for 50,000 motions
    assert sc.sweep.block_size(busy(2e-5, block=0.05), np.arange(1000.0), seconds=1.01) == 50_000


def test_a_first_motion_that_takes_long_counts_as_one_of_the_sample(busy):
    # 70 ms for a sample of a thousand, of which one motion takes 50: 14,000 in a second
    assert sc.sweep.block_size(busy(2e-5, zero=0.05), np.arange(1000.0)) == 10_000


def test_a_block_is_no_larger_than_dask_wants_its_chunks():
    with dask.config.set({"array.chunk-size": "40 kB"}):
        size = sc.sweep.block_size(job, np.arange(100.0), seconds=1e6)
    assert size == 500, (
        "of 74 bytes each: four numbers of a state, an end, an error, two codes, and three numbers of a start"
    )


def test_a_sweep_that_has_begun_keeps_its_blocks(tmp_path):
    store = tmp_path / "a.zarr"
    assert sc.sweep.block_size(job, np.arange(9.0), seconds=1e-9, path=store) == 1
    sc.sweep.save(lazy(1500), store)
    assert sc.sweep.block_size(job, np.arange(9.0), seconds=1e-9, path=store) == 1500


def test_a_block_of_a_map_has_its_points():
    def rates(theta, ell):
        return sc.sweep.portrait(theta, ell, want="rate")

    with dask.config.set({"array.chunk-size": "80 kB"}):
        axes = np.linspace(0.1, 1.5, 30), np.linspace(0.1, 3, 40)
        assert sc.sweep.block_size(rates, *axes, seconds=1e6) in (5_000, 10_000)


def test_what_is_no_sample_is_refused():
    with pytest.raises(ValueError, match="seconds = 0"):
        sc.sweep.block_size(job, np.arange(9.0), seconds=0)
    with pytest.raises(ValueError, match="at least one motion"):
        sc.sweep.block_size(job, np.arange(0.0))
    with pytest.raises(TypeError, match="^job: expected a function that returns a lazy Dataset"):
        sc.sweep.block_size(lambda x: job(np.arange(9.0)), np.arange(9.0))
