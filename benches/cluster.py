"""A sweep on two worker processes, compared with two threads of one process: docs/cluster.md.

    python benches/cluster.py --docs           every figure of that page, in a few minutes; writes its tables
    python benches/cluster.py --seconds 0.3    the same with smaller jobs, as a trial
    python benches/cluster.py --motions 1e9    this number of motions of each job on the workers, only counted

Two jobs. `kicked`: bodies near a steady state, which nutate on. `any start`: shapes, inclinations and angular
velocities spread evenly, most of which end. Both compute an initial state from the index of its motion, so that a
worker receives a range of indices. Contestants: `sweep.roll(threads=2)` with starts that exist already; dask
on two threads; dask on a LocalCluster of two processes with one thread each. With dask a job begins with the
indices and returns the number of every kind of end. Rounds alternate. The efficiency of the workers compares
their time with the least that two threads could need: half the time in which one makes the starts, plus that
of `sweep.roll(threads=2)`.
"""

import argparse
import pathlib
import pickle
import statistics
import tempfile
import time

import dask
import numpy as np
from cluster_jobs import JOBS, LINES, T, counted, head, kicked, lazy, rolled, row, wall, workers
from cluster_store import memory, saved, scheduler

import spincyl as sc


def sizes(seconds):
    """Motions per block of each job, as time and dask's bound on memory allow."""
    found = {}
    for name, start in JOBS.items():
        sample = np.linspace(0, 1e6, 20_000 if start is kicked else 2_000).round()
        found[name] = sc.sweep.block_size(lambda x, of=start: rolled(of, x), sample, seconds=seconds)
    return found


def spent(client):
    """CPU seconds of the workers so far, and of this process, which is client and scheduler."""
    return sum(client.run(time.process_time).values()), time.process_time()


def efficiency(client, blocks, count, rounds):
    """Compare two workers with two threads; returns the CPU microseconds per motion of a worker for each job."""
    walls, cpus, each = [], [], {}
    for name, start in JOBS.items():
        size = blocks[name]
        total, best, used = size * count, {}, {}
        number = np.arange(float(total))
        body, state = start(number)
        graph = counted(lazy(start, total, size))
        jobs = {
            "starts": lambda of=start, n=number: of(n),
            "roll": lambda b=body, y=state: sc.sweep.roll(b, y, T, want=("final", "end"), threads=2),
            "threads": lambda g=graph: g.compute(scheduler="threads", num_workers=2),
            "workers": lambda g=graph: g.compute(),
        }
        for _ in range(rounds):
            for who, run in jobs.items():
                before = spent(client)
                seconds, found = wall(run)
                theirs, mine = (b - a for a, b in zip(before, spent(client), strict=True))
                best[who] = min(best.get(who, np.inf), seconds / total * 1e6)
                used[who] = min(used.get(who, np.inf), (mine + theirs) / total * 1e6)
                if who == "workers":
                    used["scheduler"] = min(used.get("scheduler", np.inf), mine / total * 1e6)
                if who == "roll":
                    ends = np.bincount(found["status"], minlength=7)
                assert who in ("starts", "roll") or np.array_equal(found, ends), "other ends"
        walls.append(
            (name, size, count, *best.values(), (best["starts"] / 2 + best["roll"]) / best["workers"])
        )
        cpus.append(
            (
                name,
                used["starts"],
                used["roll"],
                used["threads"],
                used["workers"],
                used["scheduler"],
                (used["starts"] + used["roll"]) / used["workers"],
            )
        )
        # without the scheduler, whose time the plan counts separately
        each[name] = used["workers"] - used["scheduler"]
    told = (
        "time to draw the initial states, one thread (µs)",
        "time of `sweep.roll`, two threads (µs)",
        "time of dask, two threads (µs)",
        "time of dask, two workers (µs)",
    )
    head(
        "Time per motion by the clock. Each row is a job, the motions from one kind of initial states; the efficiency is the shortest time without dask, half the time to draw the initial states plus that of `sweep.roll`, over the time of two workers:",
        "job",
        "motions per block",
        "number of blocks",
        *told,
        "efficiency (ratio of times)",
    )
    for line in walls:
        row(*line)
    title = "CPU time per motion, the sum over all threads and processes, on which other work on the computer has less influence. Each row is a job, the motions from one kind of initial states; the efficiency is the sum of the first two times over the time of two workers:"
    part = "part of this time in client and scheduler (µs)"
    head(title, "job", *told, part, "efficiency (ratio of times)")
    for line in cpus:
        row(*line)
    return each


def graph(blocks):
    """The number and the size of the tasks that the scheduler receives."""
    head(
        "Bytes that the scheduler sends to the workers to describe a block. Each row is a job, the motions from one kind of initial states, with blocks of one size:",
        "job",
        "motions per block",
        "tasks per block",
        "bytes sent per task",
        "bytes sent per block",
    )
    for name, start in JOBS.items():
        for size in (1_000, blocks[name], 10_000_000):
            told = []
            for count in (10, 20):
                (found,) = dask.optimize(counted(lazy(start, count * size, size)))
                tasks = dict(found.__dask_graph__())
                told.append((len(tasks), len(pickle.dumps(tasks))))
            tasks, sent = ((b - a) / 10 for a, b in zip(*told, strict=True))
            row(name, size, tasks, sent / tasks, sent)


def spread(client, blocks, count):
    """How much the times of blocks of one size differ, from dask's record of its tasks."""
    from distributed import get_task_stream

    head(
        "Times in which a worker computes a block of the sweep. Each row is a job, the motions from one kind of initial states:",
        "job",
        "number of blocks",
        "median time (s)",
        "shortest time (s)",
        "longest time (s)",
    )
    for name, start in JOBS.items():
        with get_task_stream(client) as stream:
            counted(lazy(start, count * blocks[name], blocks[name])).compute()
        took = [
            x["stop"] - x["start"]
            for task in stream.data
            for x in task["startstops"]
            if x["action"] == "compute" and "block" in str(task["key"])
        ]
        # tasks shorter than a hundredth of the longest only pass on a result
        took = [t for t in took if t > max(took) / 100]
        row(name, len(took), statistics.median(took), min(took), max(took))


def plan(blocks, each, used, kept):
    """The time of 1e9 motions, from the figures above: the computing, and the work of the one scheduler."""
    told = (
        "motions per block",
        "time of the workers (s)",
        "time of the scheduler if results are counted (s)",
        "time of the scheduler if results are saved (s)",
        "size of the results (GB)",
        "results per second (MB/s)",
    )
    head(
        "Times and sizes of a sweep of 1e9 motions, computed from the tables above. Each row is a job, the motions from one kind of initial states, with a number of workers and of blocks:",
        "job",
        "number of workers",
        "number of blocks",
        *told,
    )
    for name in JOBS:
        for workers_, times in ((2, 1), (100, 1), (1000, 1), (1000, 100)):
            size = blocks[name] * times
            count, computing = 1e9 / size, each[name] * 1e3 / workers_
            scheduling = [used[how] * count / 1e3 for how in ("counted", "saved")]
            row(name, workers_, f"{count:.0f}", size, computing, *scheduling, kept, kept * 1e3 / computing)


def many(motions, blocks):
    """A large sweep whose motions are counted and not written."""
    head("All of it", "job", "motions", "s", "us a motion", "how they ended")
    for name, start in JOBS.items():
        seconds, ends = wall(counted(lazy(start, motions, blocks[name])).compute)
        told = ", ".join(
            f"{s.name} {n / motions:.2%}" for s, n in zip(sc.sweep.Status, ends, strict=True) if n
        )
        row(name, f"{motions:.3g}", seconds, seconds / motions * 1e6, told)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=1.0, help="duration of a block")
    parser.add_argument(
        "--blocks", type=int, default=16, help="number of blocks in a round of the comparison"
    )
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument(
        "--motions", type=float, default=0, help="only compute and count this number of motions of each job"
    )
    parser.add_argument("--docs", action="store_true")
    args = parser.parse_args()
    blocks = sizes(args.seconds)
    with workers() as (cluster, client), tempfile.TemporaryDirectory() as folder:
        for start in JOBS.values():
            counted(lazy(start, 8, 2)).compute()
        if args.motions:
            return many(int(args.motions), blocks)
        each = efficiency(client, blocks, args.blocks, args.rounds)
        spread(client, blocks, args.blocks)
        graph(blocks)
        used = scheduler(folder, 60)
        kept = saved(cluster, folder, max(1, blocks["any initial states"] // 4), 24)
    memory(blocks)
    plan(blocks, each, used, kept)
    if args.docs:
        page = pathlib.Path(__file__).parents[1] / "docs" / "cluster.md"
        begin, end = "<!-- written by benches/cluster.py -->\n", "<!-- end -->\n"
        before, rest = page.read_text("utf-8").split(begin)
        page.write_text(before + begin + "\n".join(LINES) + "\n\n" + end + rest.split(end)[1], "utf-8")


if __name__ == "__main__":
    main()
