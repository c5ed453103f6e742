"""For cluster.py: the time of the scheduler, the memory of a worker, and sweeps that are saved, killed and
resumed."""

import os
import pathlib
import shutil
import signal
import threading
import time

import numpy as np
from cluster_jobs import JOBS, any_start, counted, head, kicked, lazy, row, wall, workers

import spincyl as sc

SIZE_OF = 50  # bytes of a motion's results: six numbers and two codes


def peak():
    """Peak and present resident memory of this process, in bytes."""
    told = pathlib.Path("/proc/self/status").read_text().splitlines()
    return [int(line.split()[1]) * 1024 for line in told if line.startswith(("VmHWM", "VmRSS"))]


def scheduler(folder, count):
    """CPU milliseconds of this process, which is client and scheduler, for one more block, and milliseconds
    by the clock, for blocks that are counted and blocks that are saved."""
    ways = {
        "counted": lambda n: counted(lazy(kicked, 2 * n, 2)).compute(),
        "saved": lambda n: sc.sweep.save(lazy(kicked, 2 * n, 2), pathlib.Path(folder) / f"small{n}.zarr"),
    }
    head(
        "Time that the scheduler takes for one more block, measured with blocks of two motions. In each row the results of a block are used in one way, counted by their status or saved to files:",
        "use of the results",
        "CPU time of client and scheduler per block (ms)",
        "time by the clock per block with two workers (ms)",
    )
    used = {}
    for name, run in ways.items():
        told = []
        for n in (count, 3 * count):
            began = time.process_time()
            seconds, _ = wall(lambda n=n, run=run: run(n))
            told.append((time.process_time() - began, seconds))
        cpu, clock = ((b - a) / (2 * count) * 1e3 for a, b in zip(*told, strict=True))
        used[name] = cpu
        row(name, cpu, clock)
    return used


def memory(blocks):
    """Peak memory of a worker less what it holds idle; each job has new workers."""
    told = (
        "results of a block (MB)",
        "memory of an idle worker (MB)",
        "further memory of a busy worker at its peak (MB)",
        "further memory over the results of a block",
    )
    head(
        "Memory that a worker needs for a block. Each row is a job, the motions from one kind of initial states:",
        "job",
        "motions per block",
        *told,
    )
    for name, start in JOBS.items():
        size = blocks[name]
        with workers() as (_, client):
            counted(lazy(start, 4, 2)).compute()
            idle = client.run(peak)
            counted(lazy(start, 8 * size, size)).compute()
            after = client.run(peak)
        over = max(after[w][0] - idle[w][1] for w in idle) / 1e6
        results = size * SIZE_OF / 1e6
        row(name, size, results, max(x[1] for x in idle.values()) / 1e6, over, over / results)


def remove(store):
    for path in (store, pathlib.Path(f"{store}.sweep")):
        shutil.rmtree(path, ignore_errors=True)


def done(store):
    return [p for p in pathlib.Path(f"{store}.sweep").glob("motion-*") if p.suffix != ".part"]


def written(store):
    files = [p for p in store.rglob("*") if p.is_file()]
    return len(files), sum(p.stat().st_size for p in files)


def saved(cluster, folder, size, count):
    """A sweep that two workers write: undisturbed, with a worker killed, and run again when complete."""
    store, start = pathlib.Path(folder) / "sweep.zarr", any_start
    total = size * count
    head(
        "Time and files of a sweep from any initial states, which two workers save in 24 blocks. Each row is an event during the saving:",
        "what happens during the saving",
        "time by the clock (s)",
        "bytes per motion",
        "files per block",
    )
    plain, found = [], None
    for _ in range(2):
        remove(store)
        seconds, found = wall(lambda: sc.sweep.save(lazy(start, total, size), store))
        plain.append(seconds)
    files, used = written(store)
    expected = {p.relative_to(store): p.read_bytes() for p in sorted(store.rglob("*")) if p.is_file()}
    row("nothing", min(plain), used / total, files / count)
    remove(store)
    seen = []

    def kill():
        while len(done(store)) < count // 3:
            time.sleep(0.002)
        os.kill(next(iter(cluster.workers.values())).pid, signal.SIGKILL)
        seen.append(len(done(store)))

    killer = threading.Thread(target=kill)
    killer.start()
    seconds, found = wall(lambda: sc.sweep.save(lazy(start, total, size), store))
    killer.join()
    there = {p.relative_to(store): p.read_bytes() for p in sorted(store.rglob("*")) if p.is_file()}
    same = "the same bytes" if there == expected else "OTHER BYTES"
    row(
        f"a worker is killed after {seen[0]} of {count} blocks; the store has {same}",
        seconds,
        used / total,
        files / count,
    )
    seconds, found = wall(lambda: sc.sweep.save(lazy(start, total, size), store))
    row(
        f"the script runs again after all {count} blocks: they are only checked",
        seconds,
        used / total,
        files / count,
    )
    assert np.array_equal(
        np.bincount(found["status"].to_numpy(), minlength=7), counted(lazy(start, total, size)).compute()
    )
    return used / total
