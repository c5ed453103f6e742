"""The numbers of the note: every one is computed here, by name."""

import hashlib
import json
from functools import cache
from pathlib import Path

import numpy as np

import spincyl as sc

DISK, DISK_SCALE, EDGE = sc.Body.solid(0.375), sc.Scale(radius=0.04), np.radians(80)
CRITICAL, CRITICAL_SCALE = sc.Body.solid(np.sqrt(3) / 2), sc.Scale(radius=0.025)
PIPE, PIPE_SCALE, MU = sc.Body.tube(6.0, bore=0.8), sc.Scale(radius=15.875e-3 / 2), 0.3
CYLINDER, CYLINDER_SCALE = sc.Body.solid(2.5), sc.Scale(radius=0.01)
EULER, EULER_SCALE = sc.Body.from_metres(outer_diameter=0.0751, length=0.0128), sc.Scale(radius=0.0751 / 2)
START, DRY = 0.2, sc.loss.DryContour(1e-6)
NEAR = {"rolling": (3e-4, 6e-3), "slips": (2e-3, 2e-2)}
CONTOUR = ("DryContour", "ViscousContour", "RollingResistance", "AirFilm", "BoundaryLayer")


def middles(first, last, count):
    """Middles of equal intervals, so that counting them is a midpoint rule."""
    return first + (last - first) * (np.arange(count) + 0.5) / count


def threshold(stable, low, high):
    """Where `stable` turns true between two numbers, by bisection."""
    assert not stable(low) and stable(high), "the threshold is not between them"
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (low, middle) if stable(middle) else (middle, high)
    return (low + high) / 2


def balanced(rate):
    """The critical cylinder balanced on a point of its rim, turning at a reduced rate."""
    theta = float(CRITICAL.theta_balance)
    w1 = rate / np.sqrt(CRITICAL.i3) * np.sin(theta)
    return sc.State(theta, w1, 0.0, CRITICAL.ell * w1)


def exponent(left, theta):
    """The exponent of theta as a power of the time left, for theta to 0, and how far to trust it.

    It is the slope in the diagram of logarithms, drawn as a line over theta and read off at 0; its error is
    how much a parabola says otherwise.
    """
    slopes = np.diff(np.log(theta)) / np.diff(np.log(left))
    middle = np.sqrt(theta[1:] * theta[:-1])
    line, parabola = (np.polyfit(middle, slopes, degree)[-1] for degree in (1, 2))
    return line, abs(line - parabola)


def stabilities():
    """Section 2: where the two criteria disagree, and by how much."""
    found = {}
    for name, bore in (("share", 0.0), ("share_hoop", 1.0)):
        region = sc.sweep.portrait(
            middles(0, np.pi / 2, 1200), middles(0, 3, 1200), bore, want="region"
        ).region.values
        counts = {x: int((region == x).sum()) for x in sc.Region}
        steady = sum(counts[x] for x in counts if x >= sc.Region.UNSTABLE)
        found[name] = 100 * counts[sc.Region.STABLE_ROLLING] / steady
        found[f"{name}_states"] = steady / 1e6
        found[f"{name}_other"] = counts[sc.Region.STABLE_SMOOTH]
    on_edge = {
        c: (lambda ell, c=c: sc.Body.solid(ell).stability(np.pi / 2, c) > 0) for c in ("smooth", "rolling")
    }
    found["edge_smooth"] = threshold(on_edge["smooth"], 0.1, 1.0)
    found["edge_rolling"] = all(on_edge["rolling"](ell) for ell in np.linspace(0.0, 1.0, 101))
    for contact in ("smooth", "rolling"):
        rate = threshold(lambda x, c=contact: CRITICAL.stability(balanced(x), c) > 0, 0.1, 3.0)
        turns = CRITICAL_SCALE.turns(rate / np.sqrt(CRITICAL.i3))
        found |= {f"critical_{contact}": rate, f"critical_{contact}_hertz": turns}
    found["critical_ratio"] = found["critical_smooth"] / found["critical_rolling"]
    found["critical_theta"] = np.degrees(float(CRITICAL.theta_balance))
    found["ridge"] = float(CYLINDER.ridge()[0])
    return found


def on_edge():
    """Section 2: the disk of the figure, its growth, its nodding, and the friction that rolling asks for."""
    state = DISK.steady(EDGE)
    kappa = {c: float(DISK.stability(EDGE, c)) for c in ("smooth", "rolling")}
    falls = sc.roll(DISK, state.kicked(-1e-7), np.linspace(0, 12, 1201), contact="smooth")
    away = abs(falls.theta - state.theta)
    grows = (away > 1e-6) & (away < 1e-3)
    growth = np.polyfit(falls.t[grows], np.log(away[grows]), 1)[0]
    period = float(sc.swing(DISK, state.kicked(-1e-4)).period)
    t = np.linspace(0, 3 * period, 3001)
    nods = sc.roll(DISK, state.kicked(-0.01), t)
    down = sc.roll(DISK, state.kicked(-0.01), np.linspace(0, 8, 2001), contact="smooth")

    def needs(kick):
        return sc.roll(DISK, state.kicked(-kick), t, want="force").friction_coefficient.max()

    slips = threshold(lambda kick: needs(kick) > 0.02, 0.0, 0.1)
    lands = threshold(lambda kick: sc.roll(DISK, state.kicked(-kick), 20.0).event is not None, 0.0, 1.0)
    return {
        "kappa_smooth": kappa["smooth"],
        "kappa_rolling": kappa["rolling"],
        "growth_expected": np.sqrt(-kappa["smooth"]),
        "growth_found": growth,
        "nod_expected": 2 * np.pi / np.sqrt(kappa["rolling"]),
        "nod_found": period,
        "edge_hertz": DISK_SCALE.turns(state.precession),
        "edge_falls_ms": 1000 * DISK_SCALE.seconds(down.t[down.theta.argmin()]),
        "edge_lowest": np.degrees(down.theta.min()),
        "edge_efold_ms": 1000 * DISK_SCALE.seconds(1 / growth),
        "edge_nod_ms": 1000 * DISK_SCALE.seconds(period),
        "edge_demand": needs(0.01) / 0.01,
        "edge_swing": np.ptp(np.degrees(nods.theta)),
        "kick_slips": slips,
        "kick_slips_swing": np.ptp(np.degrees(sc.roll(DISK, state.kicked(-slips), t).theta)),
        "kick_lands": lands,
        "kick_lands_demand": needs(0.999 * lands),
    }


def averaged(v, w, n, mu, until):
    """Times, v and w of the averaged equations (5), by the midpoint rule."""
    turned = np.cos(middles(0, np.pi, 200))
    t, dt = np.linspace(0, until, 4001, retstep=True)
    path = [np.array([v, w])]
    while len(path) < t.size and path[-1].min() > 0 and path[-1][0] > mu * dt:
        middle = path[-1]
        for step in (dt / 2, dt):
            slip = np.sqrt((middle**2).sum() + 2 * middle.prod() * turned)
            share = ((middle[:, None] + middle[::-1, None] * turned) / slip).mean(axis=1)
            middle = path[-1] - step * mu * share * [1, n]
        path.append(middle)
    path = np.transpose(path[:-1])
    return t[: path.shape[1]], *path


@cache
def flick():
    """The flick of section 3: its start, its motion and what the average says of it."""
    start = sc.pressed(PIPE, 8.67, np.radians(60), finger=0.3)
    motion = sc.roll(PIPE, start, np.linspace(0, 45, 4501), contact=sc.Coulomb(MU), want="pose")
    v = np.hypot(*PIPE.centre_velocity(motion.states))
    w = motion.slip[:, 1] - PIPE.centre_velocity(motion.states)[1]
    n = PIPE.ell**2 / PIPE.i1 + 1 / PIPE.i3
    return start, motion, v, w, n, averaged(v[0], w[0], n, MU, 45.0)


@cache
def flicks(mu, many=(33, 30)):
    """Rates, launch numbers and, for each flick of the tube, its end, slip time and speeds of its centre."""
    rate, number = np.meshgrid(middles(0.5, 6.0, many[0]), middles(1.0, 3.0, many[1]))
    lying = sc.State(rate * 0 + np.pi / 2, rate, rate * 0, number * PIPE.ell / (PIPE.i3 * rate))
    first = PIPE.i1 / PIPE.ell * rate
    started = PIPE.with_centre_velocity(lying, 0.0, -first)
    wanted = ("end", "rolling_theta", "rolling_w1", "rolling_w2", "rolling_w3")
    found = sc.sweep.roll(PIPE, started, 200.0, contact=sc.Coulomb(mu), want=wanted)
    grips = sc.sweep.roll(
        PIPE, started, 200.0, contact=sc.Coulomb(mu), want="rolling_time", stop_at="rolling"
    )
    last = np.hypot(*PIPE.centre_velocity(sc.State(*(found[name].values for name in wanted[1:]))))
    return rate, number, found.status.values, grips.rolling_time.values, first, last


def launches():
    """Section 3: one flick from the finger to rolling, and all of them."""
    start, motion, v, w, n, (t, _, _) = flick()
    grips = motion.phases[-1].time
    found = {
        "n_pipe": n,
        "recoil": PIPE.i1 / PIPE.ell,
        "launch": float(PIPE.i3 * start.w1 * start.w3 / PIPE.ell),
        "flick_hertz": PIPE_SCALE.turns(start.w1),
        "v_first": v[0],
        "w_first": w[0],
        "v_last": float(np.hypot(*PIPE.centre_velocity(motion.phases[-1].state))),
        "slip_seconds": PIPE_SCALE.seconds(grips),
        "slip_averaged": PIPE_SCALE.seconds(t[-1]),
        "mu": MU,
        "speed_unit": PIPE_SCALE.metres(1.0) / PIPE_SCALE.seconds(1.0),
        "v_first_si": v[0] * PIPE_SCALE.metres(1.0) / PIPE_SCALE.seconds(1.0),
        "still_symbols": float(motion.phases[-1].state.contact_radius),
    }
    found["left"] = 100 * found["v_last"] / v[0]
    bodies = [sc.Body.tube(ell, bore=q) for ell in (1.0, 6.0) for q in (0.0, 1.0)]
    ratios = [body.ell**2 / body.i1 + 1 / body.i3 for body in bodies]
    found |= {"n_least": min(ratios), "n_most": max(ratios)}
    kinds = {"settle": sc.sweep.Status.DONE, "lie": sc.sweep.Status.SIDE, "hop": sc.sweep.Status.LIFT_OFF}
    for mu, name in ((0.15, "wet"), (0.3, "dry")):
        _, _, ends, when, first, last = flicks(mu)
        found |= {f"{kind}_{name}": 100 * float((ends == status).mean()) for kind, status in kinds.items()}
        settled = (ends == sc.sweep.Status.DONE) & np.isfinite(when)
        left, factor = 100 * (last / first)[settled], (when * mu / first)[settled]
        found |= {f"left_{name}_median": np.median(left), f"left_{name}_95": np.quantile(left, 0.95)}
        found |= {f"factor_{name}_{x}": np.quantile(factor, x / 100) for x in (5, 95)}
    return found


def stops(body, start, lies, how):
    """The time at which the contact point stops; from then on the face falls about that point."""
    low, high = 0.99 * lies, lies
    for _ in range(6):
        t = np.linspace(low, high, 200)[:-1]
        held = np.abs(sc.roll(body, start, [*t, 1e7], t0=0.0, **how).states.spin) < 1e-9
        k = int(np.argmax(held)) if held.any() else len(t)
        low, high = t[k - 1], t[k] if k < len(t) else high
    return high


@cache
def full(body, table):
    """The stop of a motion with losses, and before it: time left, inclination, rate, friction it needs."""
    contact = {"rolling": "rolling", "slips": sc.Viscous(1.0)}.get(table, table)
    start, how = body.steady(START), {"losses": DRY, "contact": contact}
    lies = sc.roll(body, start, 1e7, tol=1e-9, **how).event.time
    end = stops(body, start, lies, how)
    times = end * (1 - np.geomspace(0.3, 3e-6, 241))
    m = sc.roll(body, start, [*times, 1e7], t0=0.0, want="force", **how)
    return end, end - times, m.theta, m.w[:, 0] / np.sin(m.theta), m.friction_coefficient


def drifts():
    """Section 4: the exponents of both drifts for five laws, their limits, and full motions beside them."""
    found = {"start": START, "p_from": 2e-3, "p_to": 6e-3, "euler_ell": EULER.ell}
    theta = np.geomspace(found["p_to"], found["p_from"], 9)
    for name in CONTOUR:
        for centre in ("rest", "rolling"):
            drift = sc.drift(CYLINDER, START, getattr(sc.loss, name)(1e-3), centre=centre)
            key = f"p_{centre}_{name}"
            found[key], found[f"{key}_error"] = exponent(drift.stops_at - drift.time(theta), theta)
    found["p_worst_error"] = max(error for key, error in found.items() if key.endswith("_error"))
    for body, name, scale in ((CYLINDER, "cylinder", CYLINDER_SCALE), (EULER, "euler", EULER_SCALE)):
        # all losses along the rim lead along one path, and so small a one has a meaning down to there
        path = sc.drift(body, START, sc.loss.DryContour(1e-9), centre="rolling")
        t = path.time(1e-6)
        found[f"rate_{name}"] = float(path.precession(t))
        found[f"rate_{name}_law"] = float(1 / (body.ell * abs(path.state(t).w3)))
        found[f"rate_{name}_hertz"] = scale.turns(found[f"rate_{name}"])
        found[f"first_{name}_hertz"] = scale.turns(float(path.precession(0.0)))
        found[f"demand_{name}"] = float(path.friction_coefficient(t))
        found[f"demand_{name}_law"] = 1 / body.ell
        drift = sc.drift(body, START, DRY, centre="rolling")
        needs = drift.friction_coefficient(t := drift.stops_at * np.linspace(0, 0.99, 2001))
        found[f"slips_at_{name}"] = np.degrees(drift.theta(np.interp(MU, needs, t)))
        found[f"slower_{name}"] = drift.stops_at / sc.drift(body, START, DRY).stops_at
        for table in ("rolling", "slips"):
            end, left, lean, rate, demand = full(body, table)
            low, high = NEAR[table]
            near = (lean > low) & (lean < high)
            key = f"full_{table}_{name}"
            found[key], found[f"{key}_error"] = exponent(left[near][::8], lean[near][::8])
            found[f"fastest_{table}_{name}"] = rate.max()
            found[f"demand_{table}_{name}"] = demand.max()
            found[f"ends_{table}_{name}"] = (
                end / {"rolling": drift, "slips": sc.drift(body, START, DRY)}[table].stops_at
            )
    return found


def made_of():
    """A digest of this file and of the library, which the numbers are made of."""
    library = Path(sc.__file__).parent
    paths = [Path(__file__), *sorted(p for p in library.rglob("*") if p.suffix in (".py", ".so", ".pyd"))]
    return hashlib.sha256(b"".join(hashlib.sha256(p.read_bytes()).digest() for p in paths)).hexdigest()


@cache
def numbers():
    """Every number of the note, by name; kept beside the note, since they take half a minute."""
    kept, digest = Path(__file__).parent / "_made" / "numbers.json", made_of()
    if kept.exists():
        found = json.loads(kept.read_text("utf-8"))
        if found.pop("made of") == digest:
            return found
    found = computed()
    kept.parent.mkdir(exist_ok=True)
    kept.write_text(json.dumps(found | {"made of": digest}, indent=1), "utf-8")
    return found


def computed():
    """Every number of the note, by name."""
    found = {"version": sc.__version__} | stabilities() | on_edge() | launches() | drifts()
    return {name: x if isinstance(x, str) else float(x) for name, x in found.items()}
