"""Run a command that must not stand still: `python3 tests/awake.py SECONDS COMMAND ...`.

Its output is passed on. If it says nothing for so many seconds, its last lines are repeated, it is ended with all
its processes, and the status is 124. The tests of Rust name themselves after a minute, so that the last lines say which
of them stands still; those of Python have still.py.
"""

import collections
import os
import queue
import signal
import subprocess
import sys
import threading


def main(seconds, *words):
    pipe = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    process = subprocess.Popen(words, start_new_session=True, **pipe)
    lines, last = queue.Queue(), collections.deque(maxlen=20)

    def read():
        for line in process.stdout:
            lines.put(line)
        lines.put(None)

    threading.Thread(target=read, daemon=True).start()
    try:
        while (line := lines.get(timeout=float(seconds))) is not None:
            last.append(line.decode(errors="replace"))
            sys.stdout.write(last[-1])
            sys.stdout.flush()
        return process.wait(float(seconds))
    except (queue.Empty, subprocess.TimeoutExpired):
        told = f"{' '.join(words)}: no word for {seconds} s. Its last words:\n"
        sys.stdout.write(told + "".join(f"    {line}" for line in last))
        return 124
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    try:
        sys.exit(main(*sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
