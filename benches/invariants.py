"""What must hold for every motion, whatever the scene: the checks of random_scenes.py.

A check compares a motion with a law of nature, with `sweep.roll`, or with the same motion at another tolerance, and
never with a stored number. Bounds are multiples of the estimated errors, plus rounding errors.
"""

import math

import numpy as np

import spincyl as sc
from spincyl.sweep import Status

#: Name of each check, as the table prints it, and what is wrong if it fails.
CHECKS = {
    "raises": "an exception that no docstring announces",
    "not finite": "a number that is NaN or infinite where the motion exists",
    "energy": "energy + dissipated + work_lost + lost_in_impacts is not constant",
    "gains": "heat, lost work or impact losses that decrease",
    "below": "the lowest point of the body is below the table",
    "pulls": "the table pulls: a negative normal force",
    "sweep": "`sweep.roll` ends in another way, or differs by more than both estimated errors",
    "stops": "STOPS, but something moves",
    "ends": "under a restitution, an ending for which there is no reason",
    "tol": "another tolerance: another ending, or a difference beyond both estimated errors",
    "mirror": "the mirror image of the start moves otherwise than the mirror image of the motion",
    "split": "another tolerance: heat, lost work or impact losses differ beyond both estimated errors",
    "answer": "an answer (shape of a body, film, fit) that is wrong without a warning",
}
#: The tolerance of the second computation.
OTHER_TOL = 1e-10
#: A difference of two computations is wrong beyond this multiple of the sum of their estimated errors.
APART = 2.0
#: Energies and forces are wrong beyond this multiple of the error that follows from that of the state.
FEW = 4.0
#: Relative rounding error of a balance of energy after many steps.
ROUNDED = 1e-11
#: Errors that grow because neighbouring motions part leave energy and height right: the most that these may be off.
GROWN = 1e-9
#: An estimated error above this says that the state is unknown; two computations are then not compared.
VAGUE = 1e-2
#: The largest angular velocity and slip of a body at rest.
REST = 1e-6
#: Endings that the laws do not exclude under a restitution.
REASONS = {"DONE", "FACE", "STOPS", "PAINLEVE", "LANDING"}


class Found:
    """The faults of one scene by the name of the check, each with a line that describes the first; and its cost."""

    def __init__(self):
        self.faults, self.notes, self.ending, self.evaluations = {}, {}, "", 0

    def wrong(self, check, text):
        assert check in CHECKS
        self.faults.setdefault(check, text)

    def note(self, word):
        self.notes[word] = self.notes.get(word, 0) + 1


def has_two_rims(body):
    """Whether the far end of the body is a second rim like the first."""
    if isinstance(body, sc.Ellipsoid):
        return False
    side = math.isnan(body.theta_end) or body.theta_end == np.pi / 2
    return bool(body.ell > 0 and body.fillet < 1 and side)


def reach(body):
    """The inclination at which another part of a body of revolution touches the table, pi if none does."""
    return np.pi / 2 if has_two_rims(body) else float(np.fmin(body.theta_end, np.pi))


def lowest(body, theta, centre):
    """Height of the lowest point of a body of revolution with its centre of mass at this height."""
    s, c, fillet = np.sin(theta), np.cos(theta), float(body.fillet)
    axis = float(body.ell) * (np.abs(c) if has_two_rims(body) else c)
    return centre - axis - (1 - fillet) * s - fillet


def steepness(body, m):
    """Change of the energy, and of a force, for each unit of the estimated error of the state: a bound."""
    if not len(m.t):
        return 1.0, 1.0
    w = float(np.abs(m.w).max(initial=0.0))
    if isinstance(body, sc.Ellipsoid):
        inertia, reach = float(np.abs(np.asarray(body.inertia)).max()), 2.0
    else:
        inertia, reach = float(max(body.i1, body.i3)), 1.0 + abs(float(body.ell))
    slip = float(np.abs(m.slip).max(initial=0.0)) if rubs(m) else 0.0
    speed = slip + 3.0 * w * reach
    energy = 3.0 * inertia * w + speed * (1.0 + 3.0 * reach * (1.0 + w)) + reach
    return energy, 10.0 * (1.0 + w) * reach * reach * (1.0 + w)


def rubs(m):
    """Whether a motion has slips and heat."""
    return not isinstance(m.contact, str) or m._asked.restitution is not None


def shares(m):
    """Where the energy went, as columns that never decrease."""
    found = {}
    if rubs(m):
        found["heat"] = m.dissipated
    if m.losses is not None:
        found["work"] = m.work_lost
    if m._asked.restitution is not None:
        found["impacts"] = m.lost_in_impacts
    return found


def told(body, theta, w, more=()):
    """A state in numbers that do not depend on the rim to which it refers."""
    theta, (w1, w2, w3) = float(theta), w
    if has_two_rims(body) and theta > np.pi / 2:
        theta, w2, w3 = np.pi - theta, -w2, -w3
    if has_two_rims(body) and abs(theta - np.pi / 2) < 1e-8 and w2 < 0:  # both rims are as good
        w2, w3 = -w2, -w3
    return np.array([theta, w1, w2, w3, *more], float)


def state_of(body, state):
    if isinstance(state, sc.EllipsoidState):
        return np.concatenate([np.ravel(state.vertical), np.ravel(state.w)])
    return told(body, state.theta, (state.w1, state.w2, state.w3))


def row(body, m, k):
    if isinstance(body, sc.Ellipsoid):
        return np.asarray(m.y[:, k], float)
    return told(body, m.theta[k], m.w[k])


def balance(body, m, found):
    """Energy is neither made nor lost, the body is above the table, and the table does not pull."""
    if not len(m.t):
        return
    numbers = {"theta": m.theta, "w": m.w, "energy": m.energy} | shares(m)
    for name, x in numbers.items():
        if not np.isfinite(x).all():
            found.wrong("not finite", name)
            return
    steep, force = steepness(body, m)
    error = min(m.error, GROWN) if np.isfinite(m.error) else GROWN
    of, size = m.energy + sum(shares(m).values()), max(1.0, float(np.abs(m.energy).max()))
    bound = FEW * steep * error + ROUNDED * size
    off = np.abs(of - of[0])
    if off.max() > bound:
        found.wrong("energy", f"changes by {off.max():.2e} of {size:.2g}, bound {bound:.1e}")
    for name, x in shares(m).items():
        falls = float(-np.diff(x, prepend=0.0).min(initial=0.0))
        if falls > bound:
            found.wrong("gains", f"{name} falls by {falls:.2e}, bound {bound:.1e}")
    if not isinstance(body, sc.Ellipsoid) and m._asked.restitution is not None and np.isfinite(m.pose_error):
        low = lowest(body, m.theta, m.centre[:, 2])
        deep = -low.min()
        bound = FEW * (error + min(m.pose_error, GROWN)) * (1 + abs(float(body.ell))) + 1e-13 * size
        if deep > bound:
            found.wrong("below", f"by {deep:.2e} at t = {m.t[low.argmin()]:.6g}, bound {bound:.1e}")
        if float(np.min(m.height)) < -bound:
            found.wrong("below", f"height = {np.min(m.height):.2e}")
    if end_of(m) == m.t[0]:
        return  # the table would pull: the motion ends where it begins
    normal = [m.normal] + ([m.normal_other] if "normal_other" in m._extra else [])
    for x in normal:
        x = x[np.isfinite(x)]
        error = min(m.force_error, 1e-6) if np.isfinite(m.force_error) else 1e-6
        bound = FEW * (error + force * min(m.error, GROWN)) + 1e-12 * (1 + np.abs(x).max(initial=0.0))
        if x.size and x.min() < -bound:
            found.wrong("pulls", f"normal force {x.min():.2e}, bound {bound:.1e}")


def endings(body, m, found):
    """A motion stops only at rest, and goes on while anything moves."""
    error = m.error if np.isfinite(m.error) else 0.0
    if m.status.name == "STOPS":
        w = np.abs(state_of(body, m.event.state)[-3:]).max()
        slip = m.event.state.slip
        w = max(w, 0.0 if slip is None else float(np.abs(np.ravel(slip)).max()))
        if w > REST + FEW * error:
            found.wrong("stops", f"STOPS at t = {m.event.time:.6g} with w or slip {w:.2e}")
    # Without a limit of friction nothing says how the motion goes on.
    told = m.status.name in ("SIDE", "SLIP") and m.contact == "rolling"
    # a contact that comes down slowly never ends its bounces if none of them loses anything
    told = told or (m.status.name == "BOUNDED" and m._asked.restitution == 1.0 and "impacts" in m.message)
    if m._asked.restitution is not None and m.status.name not in REASONS and not told:
        found.wrong("ends", f"{m.status.name}" + ("" if m.event is None else f" at t = {m.event.time:.6g}"))


def apart(body, one, other):
    """The largest difference of two states of told(), also where an error of theta decides which rim is lower."""
    direct = float(np.abs(one - other).max())
    if not has_two_rims(body):
        return direct
    over = other * np.array([-1.0, 1.0, -1.0, -1.0]) + np.array([np.pi, 0.0, 0.0, 0.0])
    return min(direct, float(np.abs(one - over).max()))


def mirrored(state):
    """The mirror image of a state in the vertical plane through its axis."""
    slip = None if state.slip is None else (state.slip[0], -state.slip[1])
    return sc.State(
        state.theta, -state.w1, state.w2, -state.w3, slip=slip, height=state.height, lift=state.lift
    )


def end_of(m):
    return math.inf if m.event is None else float(m.event.time)


def ends_alike(one, other, claim, until):
    """Whether two endings, as (name, time), are the same within their estimated errors."""
    if one[0] == other[0]:
        return one[0] == "DONE" or abs(one[1] - other[1]) <= APART * claim + 1e-12 * until
    first = min(one[1], other[1])
    return "DONE" in (one[0], other[0]) and first >= until - APART * claim - 1e-9


def beside(body, m, again, until, found, check="tol", sign=1.0):
    """The same motion with another tolerance, or its mirror image; the signs are those of told()."""
    claim = m.error + again.error
    if not claim <= VAGUE:
        found.note("no claim")
        return
    one, other = ((x.status.name, end_of(x)) for x in (m, again))
    if "BOUNDED" in (one[0], other[0]):
        return
    claims = f"claims {m.error:.1e}, {again.error:.1e}"
    if not ends_alike(one, other, claim, until):
        found.wrong(check, f"{one[0]} at {one[1]:.9g}, {other[0]} at {other[1]:.9g}, {claims}")
        return
    both = min(len(m.t), len(again.t))
    off = [apart(body, row(body, m, k), sign * row(body, again, k)) for k in range(both)]
    worst = max(off, default=0.0)
    fast = max(1.0, float(np.abs(m.w).max(initial=0.0)))
    if worst > APART * claim + 1e-14 * fast:
        k = int(np.argmax(np.array(off) > APART * claim + 1e-14 * fast))
        found.wrong(check, f"{worst:.2e} apart, first at t = {m.t[k]:.5g}, {claims}")
    mine, theirs = shares(m), shares(again)
    steep, size = steepness(body, m)[0], max(1.0, float(np.abs(m.energy).max(initial=0.0)))
    for name in mine:
        off = float(np.abs(mine[name][:both] - theirs[name][:both]).max(initial=0.0))
        if off > FEW * steep * claim + ROUNDED * size:
            found.wrong(
                "split" if check == "tol" else check,
                f"{name} {off:.2e} apart, bound {FEW * steep * claim + ROUNDED * size:.1e}",
            )


def swept(body, state, until, how, m, found):
    """The same motion in a sweep."""
    stone = isinstance(body, sc.Ellipsoid)
    many = sc.sweep.roll(body, state, until, want=("final", "end"), tol=OTHER_TOL, threads=1, **how)
    status, error = Status(int(many["status"])).name, float(many["error"])
    if status == "BOUNDED" or m.status.name == "BOUNDED":
        if status != m.status.name:
            found.note("given up by one only")
        return
    claim = m.error + error
    if not claim <= VAGUE:
        found.note("no claim")
        return
    end = float(many["end"]) if status != "DONE" else math.inf
    if not ends_alike((m.status.name, end_of(m)), (status, end), claim, until):
        found.wrong(
            "sweep",
            f"{m.status.name} at {end_of(m):.9g}, sweep {status} at {end:.9g}, claims {m.error:.1e}, {error:.1e}",
        )
        return
    if status != m.status.name or status == "INVALID":
        return
    names = ("n1", "n2", "n3", "w1", "w2", "w3") if stone else ("theta", "w1", "w2", "w3")
    last = np.array([float(many[name]) for name in names])
    last = last if stone else told(body, last[0], last[1:])
    mine = state_of(body, m.event.state) if m.event is not None else row(body, m, -1)
    off, fast = apart(body, last, mine), max(1.0, float(np.abs(mine).max()))
    if not off <= APART * claim + 1e-14 * fast:
        found.wrong("sweep", f"{off:.2e} apart at the end ({status}), claims {m.error:.1e}, {error:.1e}")


def judged(body, state, times, how, found, sweeps=True):
    """Compute a motion, again with another tolerance, and in a sweep, and check all; a ValueError if it is refused."""
    until = float(times[-1])
    m = sc.roll(body, state, times, t0=0.0, want=("pose", "force"), **how)
    found.ending, found.evaluations = m.status.name, m.nfev
    if m.status.name == "BOUNDED":
        found.note("given up")
    balance(body, m, found)
    endings(body, m, found)
    try:
        again = sc.roll(body, state, times, t0=0.0, tol=OTHER_TOL, **how)
    except ValueError as error:
        found.wrong("tol", f"refused within {OTHER_TOL:g} only: {error}")
    else:
        found.evaluations += again.nfev
        endings(body, again, found)
        beside(body, m, again, until, found)
        if isinstance(state, sc.State):
            image = sc.roll(body, mirrored(state), times, t0=0.0, tol=OTHER_TOL, **how)
            beside(body, again, image, until, found, "mirror", np.array([1.0, -1.0, 1.0, -1.0]))
    if sweeps:
        swept(body, state, until, how, m, found)
    return m
