"""Writes patches.json: motions on a round patch of contact (Contensou), the reference of their tests.

    python tests/reference/patches.py [name ...]     those whose names begin so; or all

It needs gmpy2, and two minutes for all of them on one core.

Every motion is made from two formulations, `vectors` of patch_vectors.py and `reduced` of patch_forms.py. They share the
series of series.py and the order of the phases, below. Each computes the law of friction in its own way.

A row is a checkpoint: what is there, the time, the state (theta, w1, w2, w3), the slip along the lean and across, the
heat of the force and of the couple together, (phi, psi, x, y), which start at 0, the contact force along, across and
upwards, and the couple about the vertical. What is there:

    sample    nothing                         slides    k = |u|/(eps |w.z|) rises through 1
    turns     w.z goes through 0              creeps    k falls through 1
    end       the last time

Nothing of this is an event: the body always slips or drills, so that the motion is smooth but for its third derivative
at k = 1.

Inputs are exact doubles; results are decimal, to 25 digits. `agreement` is the largest difference of both formulations
in all numbers of a motion, over 1 or the number if that is more.
"""

import math
import pathlib

import gmpy2
from gmpy2 import mpfr
from patch_forms import Reduced
from patch_vectors import Vectors
from phases import Record, first_event, sampled, step_size
from series import precise
from slip import moved
from tables import compared, decimal, followed, renew_json
from torus import rounded, tube

HERE = pathlib.Path(__file__).parent
DIGITS = 50
NAMES = (
    "t",
    "theta",
    "w1",
    "w2",
    "w3",
    "u_h",
    "u_2",
    "heat",
    "phi",
    "psi",
    "x",
    "y",
    "along",
    "across",
    "normal",
    "couple",
)

# What happens next.


def follow(model):
    """The checkpoints of a scene."""
    scene, out = model.scene, Record(model)
    samples = [mpfr(t) for t in scene.samples]
    kind, sign, y = model.enter(model.start())
    while True:
        phase = model.phase(kind, sign)
        tape = phase.tape
        tape.expand(y, model.order)
        out.steps += 1
        h = step_size(phase, model.order, model.tolerance)
        assert phase.normal.c[0] > 0 and out.steps < 20000, scene.name
        place, name = first_event(phase.events, h)
        h = h if name is None else place
        sampled(out, samples, tape.states[0], h, kind == "outside")
        if not samples:
            return out
        y = [node.at(h) for node in tape.states]
        if name in ("creeps", "far"):
            out.strayed = max(out.strayed, model.bent(y))
        if name in ("slides", "creeps", "turns"):
            out.add(name, y[0], y)
        if name == "slides":
            kind, y = "outside", [*y[:-1], sign * gmpy2.const_pi() / 2]
        elif name == "creeps":
            kind = "inside"
        elif name == "turns":
            sign = -sign
        elif name:
            kind, sign, y = model.enter(y)
            kind = {"near": "outside"}.get(name, name)


# The scenes.


class Scene:
    """A body (ell, i1, i3, fillet), a table (mu, patch), a start (theta, w1, w2, w3, u_h, u_2) and times.

    The table turns at `turning` about its normal through 0, and the contact begins at `place`.
    """

    def __init__(self, name, body, mu, patch, start, end, samples=4, turning=0.0, place=(0.0, 0.0)):
        self.name, self.mu, self.patch = name, float(mu), float(patch)
        self.body = [float(x) for x in body]
        self.start = [float(x) for x in start]
        self.end, self.turning, self.place = float(end), float(turning), [float(x) for x in place]
        self.samples = sorted({float(end * k / samples) for k in range(1, samples + 1)})


def scenes():
    top, ball, heavy = (-0.2, 0.4, 0.42, 1.0), (0.0, 0.4, 0.4, 1.0), (0.3, 0.5, 0.4, 1.0)
    coin, thin, can, paper = tube(0.0854, 0.0), tube(0.0, 0.0), tube(0.5, 0.0), tube(6.0, 0.8)
    low = rounded(0.17, 0.05)

    def spun(w3):
        """The top, spun with its centre at rest."""
        return moved(top, (0.1, 0, 0, w3), 0, 0)

    yield Scene("tippe top on a small patch", top, 0.3, 0.1 / 15, spun(7), 30)
    yield Scene("tippe top turns over", top, 0.3, 0.3 / 15, spun(7), 38)
    yield Scene("tippe top on a wide patch", top, 0.3, 1 / 15, spun(5), 40)
    side = moved(ball, (1.2, 3.0, 0.3, 1.2), 1.0, 3.6)
    yield Scene("billiard ball with side spin", ball, 0.2, 0.5 / 28.6, side, 8)
    yield Scene("ball off its centre", heavy, 0.2, 0.05, (1.2, 1, 0.1, 2, 0.3, 1), 6)
    drills = (1, 2 * math.sin(1), 0, 2 * math.cos(1), 0, 0)
    yield Scene("ball drills", ball, 0.2, 0.05, drills, 100)
    yield Scene("coin comes to creep", coin, 0.3, 0.0155, (0.5, 1.25, 0.1, 0.1, 0.05, -0.1), 6)
    again = (1.03, 1.0, 0.64, 0.16, -0.02, -0.16)
    yield Scene("coin slides and creeps again and again", coin, 0.27, 0.047, again, 8)
    yield Scene("tube slides and creeps", paper, 0.25, 0.07, (1.31, 0.26, 0.29, 0.91, -0.08, -0.08), 5)
    yield Scene("rounded disk", low, 0.3, 0.05, (0.6, 1.2, 0.2, 0.1, -0.3, 0.5), 6)
    turns = (1.1, 0.17, -0.64, 1.09, 0.54, -0.05)
    yield Scene("can whose drilling turns round", can, 0.18, 0.14, turns, 7)
    where = {"turning": 0.6, "place": (1.0, -0.5)}
    yield Scene("ball on a turntable", heavy, 0.2, 0.05, (1.2, 1, 0.1, 2, 0.3, 1), 6, **where)
    yield Scene("can on a turntable", can, 0.18, 0.14, turns, 3, **where)
    yield Scene("rounded disk on a turntable", low, 0.3, 0.05, (0.6, 1.2, 0.2, 0.1, -0.3, 0.5), 4, **where)
    yield Scene("thin disk", thin, 0.17, 0.123, (0.79, -0.26, 0.25, 0.68, 0.76, -0.59), 8)


# The table.


def written(scene):
    """A motion as it stands in the file."""
    one, other = followed(scene, (Vectors, Reduced), follow)
    agreement = max(compared(one, other, angles=(8, 9)))
    return {
        "name": scene.name,
        "body": scene.body,
        "mu": scene.mu,
        "patch": scene.patch,
        "start": scene.start,
        **({"turning": scene.turning, "place": scene.place} if scene.turning else {}),
        "agreement": float(f"{float(agreement):.1e}"),
        "rows": [[kind, *(decimal(x, 1e-30) for x in row)] for kind, row in other.rows],
    }


def main():
    precise(DIGITS)
    renew_json(HERE / "patches.json", scenes(), written, "motions", columns=["kind", *NAMES])


if __name__ == "__main__":
    main()
