"""Cards in a notebook: a drawing of the inclined body, and a table of the main numbers.

A card has the colour of the text around it and no script; its text is escaped.
"""
# ruff: noqa: RUF001 (Greek, for people to read)

import html
import math
from collections.abc import Callable, Iterable
from contextlib import suppress

import numpy as np

from spincyl._body import Body
from spincyl._contact import contact_in_words
from spincyl._ellipsoid_motion import EllipsoidMotion
from spincyl._input.numbers import Floats, Reals, is_scalar
from spincyl._input.reprs import is_lazy
from spincyl._loss import losses_in_words
from spincyl._motion import Motion
from spincyl._scale import Scale
from spincyl._state import State
from spincyl._swing import Swing
from spincyl._swing import swing as nutation
from spincyl.studio.shape import kind as shape
from spincyl.studio.shape import landing, profiles, skin

_SIZE = 120.0  # largest size of the drawn body, in pixels
_ROOM = 16.0
_LEANING = math.radians(60)  # inclination of a ball in its own card
_BALLS = {"capsule": "capsule", "balls": "two balls", "ball": "ball"}


def card(found: object) -> str:
    """The card of a body, state, motion, swing or scale, as HTML."""
    return next(made(found) for kind, made in _CARDS.items() if isinstance(found, kind))


def body(found: Body) -> str:
    """The card of a body, balanced on its rim."""
    excess = found.excess if found.rims is None else found.i1 / found.i3 - 1
    kind = "a family of bodies"
    if is_scalar(excess):
        kind = "as long as I₁ = I₃" if excess == 0 else "cylinder: I₁ > I₃" if excess > 0 else "disk: I₁ < I₃"
    if is_scalar(found.fillet, found.ell, found.theta_end) and found.fillet == 1 and found.rims is None:
        kind = f"{_BALLS[shape(found)]}; {kind}"
    sharp = not is_lazy(found.fillet) and not np.any(found.fillet)
    rows = [("shape", kind)]
    if found.rims is not None:
        return _of_circles(found, rows)
    if sharp:
        rows.append(("aspect ratio ℓ", _number(found.ell)))
    else:
        rows += [
            ("centre above the rim circle ℓ", _number(found.ell, "R")),
            ("fillet", _number(found.fillet, "R")),
        ]
    if not is_scalar(found.bore) or found.bore > 0:
        rows.append(("bore, inner over outer radius", _number(found.bore)))
    rows += [
        ("moment of inertia I₁", _number(found.i1, "M R²")),
        ("moment of inertia I₃", _number(found.i3, "M R²")),
    ]
    rows += [
        ("balanced at θ₀", _angle(found.theta_balance)),
        ("fast limit θ∞", _angle(found.theta_limit)),
    ]
    if found.scale is not None:
        rows += [
            ("radius R", _number(1e3 * found.scale.radius, "mm")),
            ("mass M", _number(1e3 * found.scale.mass, "g")),
            ("critical rate", _number(found.critical_hertz, "Hz")),
        ]
    picture = ""
    if is_scalar(found.ell, found.i1, found.fillet, found.theta_end):
        ball = found.fillet == 1  # a ball balances at no inclination
        picture = drawing(found, *((_LEANING, "θ") if ball else (found.theta_balance, "θ₀")))
    return framed(repr(found), rows, picture)


def _of_circles(found: Body, rows: list[tuple[str, str]]) -> str:
    """The card of a body of several circles, lying on the first two on which it can rest."""
    rows += [
        ("circles on which it can stand", str(found.rims.shape[-2])),
        ("moment of inertia I₁", _number(found.i1, "M R²")),
        ("moment of inertia I₃", _number(found.i3, "M R²")),
    ]
    if found.scale is not None:
        rows += [
            ("radius R", _number(1e3 * found.scale.radius, "mm")),
            ("mass M", _number(1e3 * found.scale.mass, "g")),
        ]
    if not found._single:
        return framed(repr(found), rows, "")
    for k, (radius, height, fillet) in enumerate(found.circles.tolist()):
        rounded = f", fillet {fillet:.6g} R" if fillet else ""
        rows.append((f"circle {k}", f"radius {radius:.6g} R, height {height:+.6g} R{rounded}"))
    rows += [(f"circle {k + 1} lands at", _angle(x)) for k, x in enumerate(found.borders) if found.spans[k]]
    for k in found.rests():
        apex = found.apex(k)
        if np.isfinite(apex.radius):
            rows.append((f"rolls on {k} and {k + 1} in a circle", _number(apex.radius, "R")))
    lies = [found.borders[k] for k in found.rests()]
    return framed(repr(found), rows, drawing(found, float(lies[0]) if lies else _LEANING, "θ"))


def state(found: State) -> str:
    """The card of a state: the rim that touches the table, and the axis."""
    w = [_number(x, "√(g/R)") for x in (found.w1, found.w2, found.w3)]
    rows = [
        ("inclination θ", _angle(found.theta)),
        *zip(("ω₁ = φ′ sin θ", "ω₂ = −θ′", "ω₃ = φ′ cos θ + ψ′"), w, strict=True),
        ("precession φ′", _number(found.precession, "√(g/R)")),
        ("spin ψ′", _number(found.spin, "√(g/R)")),
        ("contact circle", _number(found.contact_radius, "R")),
    ]
    if found.slip is not None:
        names = "slip along the lean", "slip across it"
        rows += [(name, _number(x, "√(g R)")) for name, x in zip(names, found.slip, strict=True)]
    single = is_scalar(found.theta)
    return framed(_name(repr(found), "State"), rows, drawing(None, found.theta, "θ") if single else "")


def motion(found: Motion) -> str:
    """The card of a motion: the body in its initial state, and the range of its inclination."""
    rows, reached = _motion(found)
    if found.scale is not None:
        turns = (
            (name, found.scale.turns(x))
            for name, x in (("φ′", found.start.precession), ("ψ′", found.start.spin))
        )
        rows.insert(2, ("starts with", ", ".join(f"{name} {_number(x, 'Hz')}" for name, x in turns)))
    return framed("Motion", rows, drawing(found.body, found.start.theta, "θ", reached))


def stone_motion(found: EllipsoidMotion) -> str:
    """The card of a stone's motion: its inclination, and its spin, which may change sign."""
    rows, _ = _motion(found)
    if found.t.size:
        spin, unit = found.spin, "√(g/a)" if found.scale is None else "rad/s"
        rows.insert(-2, ("spin", f"{spin.min():.4g} to {spin.max():.4g}, at last {spin[-1]:.4g} {unit}"))
    return framed("EllipsoidMotion", rows, "")


def _motion(found: Motion) -> tuple[list[tuple[str, str]], tuple[float, ...]]:
    """Rows of the table that all motions have, and the inclinations between which the body nods."""
    rows = [("body", repr(found.body)), ("contact", contact_in_words(found.contact))]
    if found.losses is not None:
        rows.append(("losses", losses_in_words(found.losses, found.scale)))
    reached: tuple[float, ...] = ()
    if found.t.size:
        time = _time(found.scale, found.body._length)
        rows += [
            ("times", f"{found.t.size}, from {found.t[0]:.6g} to {found.t[-1]:.6g} {time}"),
            ("θ at this time" if found.t.size == 1 else "θ at these times", span_in_words(found.theta)),
        ]
        reached = float(found.theta.min()), float(found.theta.max())
    plain = found.losses is None and found.event is None and found._nods
    if found.t.size and plain and isinstance(found.contact, str):
        with suppress(ValueError):  # `nutation` fails close to a body that lies flat
            turns = nutation(found.body, found.start, found.contact)
            reached = turns.theta_min, turns.theta_max
            if turns.theta_max - turns.theta_min > 1e-6:
                rows.append(("nods between", span_in_words(np.array(reached))))
    rows += zip(("ended", "how"), found.message.split("; ", 1), strict=False)
    return rows, reached


def swing(found: Swing) -> str:
    """The card of a nutation: the rim at both turning points."""
    rows = [
        ("period", _number(found.period, _time(found.scale))),
        ("inclination θ", f"{_angle(found.theta_min)} to {_angle(found.theta_max)}"),
        ("precession φ in a period", _angle(found.precession_per_period)),
        ("spin ψ in a period", _angle(found.spin_per_period)),
        ("drift of the contact in a period", _length(found.drift, found.scale)),
        ("on a circle of radius", _length(found.drift_radius, found.scale)),
    ]
    return framed("Swing", rows, drawing(None, found.theta_max, "θ", (found.theta_min,)))


def _time(scale: Scale | None, length: str = "R") -> str:
    return f"√({length}/g)" if scale is None else "s"


def _length(x: Reals, scale: Scale | None) -> str:
    return _number(x, "R") if scale is None else _number(1e3 * x, "mm")


def scale(found: Scale) -> str:
    """The card of a scale: the natural units in SI."""
    length, time, energy, hertz = found._units
    rows = [
        ("radius R", f"{1e3 * length:.6g} mm"),
        ("mass M", _number(1e3 * found.mass, "g")),
        ("gravity g", f"{found.gravity:.6g} m/s²"),
        ("time √(R/g)", f"{time:.6g} s"),
        ("speed √(g R)", f"{length / time:.6g} m/s"),
        ("angular velocity √(g/R)", f"{hertz:.6g} turns/s"),
        ("energy M g R", _number(energy, "J")),
    ]
    return framed("Scale", rows, "")


_CARDS: dict[type, Callable[..., str]] = {
    Body: body,
    EllipsoidMotion: stone_motion,  # before Motion, of which it is a subclass
    Motion: motion,
    Scale: scale,
    State: state,
    Swing: swing,
}


def drawing(of: Body | None, theta: float, label: str, others: Iterable[float] = ()) -> str:
    """SVG of a body on the table from the side; of its rim if `of` is None. `others`: further outlines.

    Empty without an inclination, or if the body would reach below the table.
    """
    ell = 0.0 if of is None else float(of.ell)
    lying = math.pi / 2 + 1e-9 if ell > 0 else math.pi
    if of is not None and of.fillet > 0:
        lying = landing(of) + 1e-9
    several = of is not None and of.rims is not None
    if several:
        lying = math.pi
    thetas = [float(x) for x in (theta, *others)]
    if not 0 <= thetas[0] <= lying:
        return ""
    rounded = of if of is not None and (of.fillet > 0 or several) else None
    drawn = [x for x in thetas if 0 <= x <= lying]
    if rounded is None:
        shapes = [_silhouette(ell, x) for x in drawn]
    else:
        shapes = [_round(rounded, x, 8 if k else 4) for k, x in enumerate(drawn)]
    # points are complex numbers, in R, with the contact point at 0; the axis is inclined to the right
    across, up = 1j * _axis(thetas[0]), _axis(thetas[0])
    end, half = across + 2 * ell * up, ell
    if rounded is not None:
        middle, half = _middle(rounded)
        across = _centre(rounded, thetas[0]) + (middle - half) * up
        end = across + 2 * half * up
    unit = _SIZE / (2 * max(half, 1.0))
    reach = 0.3 * _SIZE / unit  # radius of the arc that shows the angle, at the upper end
    far = [p for shape in shapes for p in shape] + [end + 1.2 * reach * up, end + 1.6j * reach]
    left, right = unit * min(p.real for p in far) - _ROOM, unit * max(p.real for p in far) + _ROOM
    top = unit * max(p.imag for p in far)

    def at(p: complex) -> str:
        return f"{unit * p.real - left:.1f},{top - unit * p.imag:.1f}"

    def path(*points: complex, style: str) -> str:
        return f'<path d="M{" L".join(map(at, points))}" {style}/>'

    thin = 'stroke-width="0.8" opacity="0.6"'
    pieces = [path(*shape, shape[0], style='opacity="0.35"') for shape in shapes[1:]]
    pieces.append(path(*shapes[0], shapes[0][0], style='fill="currentColor" fill-opacity="0.12"'))
    if of is not None and not several and 0 < of.bore < 1:
        for side in (1 - of.bore, 1 + of.bore):
            low = side * across if rounded is None else across + 1j * (side - 1) * up
            pieces.append(path(low, low + 2 * half * up, style=f'stroke-dasharray="4 3" {thin}'))
    pieces.append(path(end, end + 1.2j * reach, style=f'stroke-dasharray="2 2" {thin}'))
    pieces.append(path(across, end + 1.2 * reach * up, style=f'stroke-dasharray="7 2 1.5 2" {thin}'))
    r, place = unit * reach, (end + 1.4 * reach * _axis(0.5 * thetas[0]))
    x, y = at(place).split(",")
    width, height = right - left, top + 6
    pieces += [
        f'<path d="M{at(end + 1j * reach)} A{r:.1f},{r:.1f} 0 0 1 {at(end + reach * up)}" {thin}/>',
        f'<text x="{x}" y="{y}" font-size="12" text-anchor="middle" dominant-baseline="middle"'
        f' fill="currentColor" stroke="none">{html.escape(label)}</text>',
        f'<path d="M0,{top:.1f} H{width:.1f}" stroke-width="1.6"/>',
        f'<circle cx="{-left:.1f}" cy="{top:.1f}" r="2.2" fill="currentColor" stroke="none"/>',
    ]
    told = f"{'a body' if of is not None else 'a rim'} tilted by {math.degrees(thetas[0]):.1f} degrees"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" role="img" aria-label="{told}" width="{width:.0f}"'
        f' height="{height:.0f}" viewBox="0 0 {width:.1f} {height:.1f}" stroke="currentColor"'
        f' fill="none" stroke-width="1.2" stroke-linejoin="round">{"".join(pieces)}</svg>'
    )


def _axis(theta: float) -> complex:
    """Unit vector at the angle `theta` to the right of the vertical."""
    return complex(math.sin(theta), math.cos(theta))


def _silhouette(ell: float, theta: float) -> list[complex]:
    """The corners of a cylinder seen from the side, as complex numbers x + iz from the contact point on."""
    across, up = 2j * _axis(theta), 2 * ell * _axis(theta)
    return [0j, across, across + up, up]


def _centre(of: Body, theta: float) -> complex:
    """The centre of mass of a body with a fillet or of several circles, relative to its contact point."""
    if of.rims is not None:
        k = int((of.borders < theta).sum())
        radius, height, fillet = map(float, of.circles[k])
        return 1j * radius * _axis(theta) - height * _axis(theta) + 1j * fillet
    rim = 1 - float(of.fillet)
    return 1j * rim * _axis(theta) + float(of.ell) * _axis(theta) + 1j * float(of.fillet)


def _middle(of: Body) -> tuple[float, float]:
    """Height of the middle of a body above its centre of mass, and half its length."""
    if of.rims is None:
        return skin(of).middle, skin(of).half
    heights = [z for profile in profiles(of) for _, z in profile.corners]
    return (max(heights) + min(heights)) / 2, (max(heights) - min(heights)) / 2


def _round(of: Body, theta: float, every: int) -> list[complex]:
    """The outline of a body with a fillet seen from the side; `every` skips corners of round profiles."""
    right = []
    for profile in profiles(of):
        if profile.name not in ("faces", "lower face", "bore"):
            step = 1 if profile.normals is None else every
            right += [*profile.corners[:-1:step], profile.corners[-1]]
    outline = [complex(z, -r) for r, z in right] + [complex(z, r) for r, z in reversed(right)]
    centre, axis = _centre(of, theta), _axis(theta)
    return [centre + axis * place for place in outline]


def _number(x: Reals, unit: str = "") -> str:
    """A number with its unit, or the least and the greatest number of an array."""
    return _told(x, lambda value: f"{value:.6g} {unit}".rstrip())


def _angle(x: Reals) -> str:
    """An angle in degrees and radians, or the range of an array in degrees."""
    radians = "({:.6g} rad)" if is_scalar(x) else ""
    return _told(x, lambda value: f"{math.degrees(value):.4g}° {radians.format(value)}".rstrip())


def span_in_words(theta: Floats) -> str:
    """Text with the least and the greatest angle in degrees, or with the angle if there is only one."""
    if theta.size == 1:
        return f"{math.degrees(theta.item()):.4g}°"
    return f"{math.degrees(theta.min()):.4g}° to {math.degrees(theta.max()):.4g}°"


def _told(x: Reals, write: Callable[[float], str]) -> str:
    if is_lazy(x):
        return f"lazy, shape {tuple(x.shape)}"
    if is_scalar(x):
        return "none" if np.isnan(x) else write(float(x))
    known = np.ma.masked_invalid(np.ma.asarray(x), copy=True).compressed()
    missing = np.size(x) - known.size
    ends = dict.fromkeys(map(write, (known.min(), known.max()))) if known.size else ["nowhere"]
    return f"{' to '.join(ends)}, shape {np.shape(x)}" + (f", {missing} without" if missing else "")


def _name(text: str, name: str) -> str:
    """The repr of a single object, or only its name if the repr takes several lines."""
    return text if "\n" not in text else name


def framed(title: str, rows: Iterable[tuple[str, str]], picture: str) -> str:
    """A card: a title, a picture that may be empty, and a table."""
    cell = 'style="text-align:left;padding:0 0.8em 0 0;background:none"'
    lines = "".join(
        f"<tr><td {cell}>{html.escape(name)}</td><td {cell}>{html.escape(value)}</td></tr>"
        for name, value in rows
    )
    return (
        f'<div><code style="white-space:pre-wrap">{html.escape(title)}</code>'
        '<div style="display:flex;gap:1.5em;align-items:center;flex-wrap:wrap;color:inherit">'
        f"{picture}<table>{lines}</table></div></div>"
    )
