"""Behaviour of sweeps: Ctrl-C, other threads, forks, kills, memory. Figures of docs/hard-cases.md, C and P.

python benches/behaviour.py               everything except kills
python benches/behaviour.py --kills 100   kills that many saves, half of them on two worker processes
"""

import argparse
import multiprocessing
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time

import numpy as np

import spincyl as sc

COUNT = 1_000_000


def start():
    body = sc.Body.solid(np.linspace(0.9, 3, COUNT))
    return body, body.steady(1.3).kicked(0.05)


def jobs():
    body, state = start()
    theta, ell = np.linspace(0.01, 1.57, 8000), np.linspace(0, 3, 4000)
    made = sc.sweep.portrait(theta, ell)
    one, many, out = sc.Body.solid(2.5), np.linspace(0.1, 1.5, 10**8), np.empty(10**8)
    start_one, times = one.steady(1.3).kicked(0.05), np.linspace(0, 20, 10**7)
    return {
        "rates of 1e8 inclinations": lambda: one.rate(many, out=out),
        "boundaries": lambda: sc.sweep.boundaries(np.linspace(0.1, 3, 10**5)),
        "survey of 1e5 bodies": lambda: sc.sweep.survey([0.5, 1.0], np.linspace(0.1, 3, 10**5)),
        "1e7 times of a motion": lambda: sc.roll(one, start_one, times, want=("pose", "force")),
        "map": lambda: sc.sweep.portrait(theta, ell, out=made),
        "ensemble": lambda: sc.sweep.roll(body, state, 20.0),
        "least normal force": lambda: sc.sweep.roll(body, state, 20.0, want="normal_min"),
        "RK4 ensemble": lambda: sc.sweep.roll(body, state, 20.0, step=1e-3),
    }


def delays(run, rounds=12):
    """Seconds from Ctrl-C to the exception, for interrupts at random times."""
    random, found = np.random.default_rng(1), []
    for _ in range(rounds):
        sent = []

        def interrupt(sent=sent):
            time.sleep(random.uniform(0.02, 0.25))
            sent.append(time.perf_counter())
            os.kill(os.getpid(), signal.SIGINT)

        breaker = threading.Thread(target=interrupt)
        breaker.start()
        try:
            while True:
                run()
        except KeyboardInterrupt:
            found.append(time.perf_counter() - sent[0])
        breaker.join()
    return found


def ticks(run, seconds=1.0):
    """Wake-ups per second of a thread that sleeps for a millisecond at a time, while `run` works or (None)
    idle."""
    count, done = [0], threading.Event()

    def tick():
        while not done.is_set():
            count[0] += 1
            time.sleep(0.001)

    ticker = threading.Thread(target=tick)
    began = time.perf_counter()
    ticker.start()
    while time.perf_counter() - began < seconds:
        run() if run else time.sleep(0.05)
    done.set()
    ticker.join()
    return count[0] / (time.perf_counter() - began)


def child(queue):
    body, state = start()
    queue.put(float(sc.sweep.roll(body, state, 20.0)["theta"].sum()))


def fork_and_spawn():
    body, state = start()
    expected = float(sc.sweep.roll(body, state, 20.0)["theta"].sum())
    for kind in ("fork", "spawn"):
        context = multiprocessing.get_context(kind)
        queue, began = context.Queue(), time.perf_counter()
        process = context.Process(target=child, args=(queue,))
        process.start()
        same = queue.get(timeout=60) == expected
        process.join()
        print(f"{kind}: a million motions in {time.perf_counter() - began:.2f} s, same sum: {same}")


def peak(code, size):
    """Peak memory of a fresh process that runs `code`, less that of a process without it, over `size`."""
    head = "import numpy as np, xarray, spincyl as sc\n"
    # getrusage is not used: a child inherits its peak from the process that forked
    tail = "print(next(int(x.split()[1]) * 1024 for x in open('/proc/self/status') if 'VmHWM' in x))\n"
    peaks = [
        int(
            subprocess.run(
                [sys.executable, "-c", head + c + tail], capture_output=True, text=True, check=True
            ).stdout
        )
        for c in ("", code)
    ]
    return (peaks[1] - peaks[0]) / size


def kill(count):
    sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tests"))
    from test_save import survive

    for workers in (0, 2):
        with tempfile.TemporaryDirectory() as folder:
            kills, lost = survive(pathlib.Path(folder), count // 2, workers, 0.5 if workers == 0 else 1.5)
        print(
            f"{kills} kills survived with {workers or 'no'} worker processes, at most {lost} blocks lost"
            " by one; every finished store has the bytes of one process undisturbed",
            flush=True,
        )


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--kills", type=int, default=0)
    args = parser.parse_args()
    if args.kills:
        return kill(args.kills)
    for name, run in jobs().items():
        found = delays(run)
        print(
            f"Ctrl-C, {name}: {1e3 * np.median(found):.0f} ms in the median, {1e3 * max(found):.0f} ms at most"
        )
    idle = ticks(None)
    print(f"ticks a second: idle {idle:.0f}, " + ", ".join(f"{n} {ticks(r):.0f}" for n, r in jobs().items()))
    fork_and_spawn()
    theta = "theta, ell = np.linspace(0.01, 1.57, 10_000), np.linspace(0.05, 3, 10_000)\n"
    ratio = peak(theta + "sc.sweep.portrait(theta, ell, want='rate')\n", 8e8)
    print(f"peak memory of a map of 1e8 points over its output: {ratio:.3f}")
    ratio = peak(theta + "sc.sweep.survey(theta, ell, want=('region', 'rate'))\n", 8e8)
    print(f"of its survey over the map it does not make: {ratio:.4f}")
    many = "b = sc.Body.solid(np.linspace(0.9, 3, 10**7)); y = b.steady(1.3).kicked(0.05)\n"
    before = peak(many, 1.0)
    ratio = (peak(many + "sc.sweep.roll(b, y, 20.0)\n", 1.0) - before) / (10**7 * (5 * 8 + 2))
    print(f"of an ensemble of 1e7 over its output: {ratio:.3f}")


if __name__ == "__main__":
    main()
