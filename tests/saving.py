"""Every kind of file that the package writes, by file name; and the outcome if there is no room for it.

python tests/saving.py FAILS DIES: saves each kind in these two folders with a limit of 500 bytes per file,
and prints as JSON the error of each in the first, and the signal that ended the process in the second.
"""

import contextlib
import io
import json
import os
import resource
import signal
import sys
from pathlib import Path

import spincyl as sc
from spincyl.cli import main
from spincyl.cli._files import writer_of

BODY = sc.Body.solid(2.5)
LIMIT = 500


def motion():
    return sc.roll(BODY, BODY.steady(1.3).kicked(0.05), 1.0, want=("pose", "force"))


def shown(path, **how):
    return sc.view(motion(), slow=1).save(path, **how)


def filmed(path):
    return shown(path, fps=5, size=(64, 64))


def silent(path):
    return shown(path, fps=5, size=(64, 64), sound=False)


def heard(path):
    return motion().sound(path, scale=sc.Scale(0.01))


def told(path):
    t = [k / 100 for k in range(101)]
    m = sc.roll(BODY, BODY.steady(1.3).kicked(0.05), t, want=("pose", "force"))
    return writer_of(Path(path))(m, None, Path(path))


def scene(path):
    return sc.scene(sc.roll(BODY, BODY.steady(1.3), 1.0)).save(path)


def typed(*words):
    """Run a command; OSError with its message if it fails."""
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as error:
        if main([str(word) for word in words]):
            raise OSError(error.getvalue())


def mapped(path):
    typed("portrait", "--points", "9", f"--output={path}")


def drifted(path):
    words = ["--ell", "0.17", "--theta", "0.3", "--law", "dry-contour=5e-3", f"--output={path}"]
    typed("drift", *words)


JOBS = {
    "page.html": shown,
    "play.html": lambda path: sc.play().save(path),
    "spin.glb": shown,
    "film.mp4": filmed,
    "silent.mp4": silent,
    "film.gif": filmed,
    "whirr.wav": heard,
    "scene.json": scene,
    "scene.xml": scene,
    "motion.csv": told,
    "motion.npz": told,
    "motion.nc": told,
    "motion.svg": told,
    "motion.html": told,
    "map.nc": mapped,
    "map.png": mapped,
    "drift.csv": drifted,
    "drift.pdf": drifted,
}


def cramped(name):
    """The error of saving a file with too little room."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (LIMIT, before[1]))
    try:
        JOBS[name](name)
    except OSError as e:
        return str(e)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    return "saved"


def killed(name):
    """The error of saving with too little room in a process of its own, or the signal that ended it."""
    ours, theirs = os.pipe()
    child = os.fork()
    if not child:
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        os.write(theirs, cramped(name).encode())
        os._exit(0)
    os.close(theirs)
    with os.fdopen(ours, "rb") as said:
        text = said.read().decode()
    status = os.waitpid(child, 0)[1]
    return text or f"signal {os.WTERMSIG(status)}"


if __name__ == "__main__":
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    found = []
    for folder, how in zip(sys.argv[1:], (cramped, killed), strict=True):
        os.chdir(folder)
        found.append({name: how(name) for name in JOBS})
    print(json.dumps(found))
