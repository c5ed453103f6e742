"""The Python call for the state in an address of the live page, such as "ell=2.5&theta=1.3".

docs/play.md lists the words of an address.
"""

from urllib.parse import parse_qsl

import spincyl as sc

#: words about the view of the page, which have no argument in Python
LOOKS = {"expose", "t"}


def called(address: str) -> str:
    """The call, as lines of code."""
    words = dict(parse_qsl(address, keep_blank_values=True, strict_parsing=True))
    for word in LOOKS & words.keys():
        del words[word]
    code = stone(words) if "stone" in words else body_of_revolution(words)
    if words:
        raise ValueError(f"no call in Python tells {'&'.join(words)} of {address}")
    return code


def number(x: float) -> str:
    """A number with six digits."""
    return f"{x:.6g}"


def call(name: str, *given: str, **named: str | None) -> str:
    """A call, without the arguments that are None."""
    return f"{name}({', '.join([*given, *(f'{k}={x}' for k, x in named.items() if x is not None)])})"


def body_of_revolution(words: dict[str, str]) -> str:
    """The call of `sc.play`; removes the words that it uses from `words`."""
    sizes = {name: float(words[name]) for name in ("radius", "mass", "gravity") if name in words}
    size = sc.Scale(**sizes) if sizes else None
    body, theta, kick = _body(words), words.pop("theta"), words.pop("kick", None)
    law, table, first = _loss(words, size), _table(words, size), ""
    # A coefficient in SI belongs to a body of known size.
    if any(told and "scale=sized" in told for told in (law, table)):
        first, body = f"sized = {body}\n", "sized"
    state = None
    if "w" in words:
        *w, along, across = words.pop("w").split(",")
        slips = any(map(float, (along, across)))
        state = call("sc.State", theta, *w, slip=f"({along}, {across})" if slips else None)
        state, kick = state if kick is None else f"{state}.kicked({kick})", None
    until = words.pop("until", None)
    arguments = {
        "state": state,
        "kick": kick,
        "contact": table,
        "losses": law,
        "table": call("sc.Table", words.pop("slope"), phi0=words.pop("phi0", None))
        if "slope" in words
        else None,
        "t": until and number(float(until) * (size.seconds(1.0) if size else 1.0)),
        "slow": words.pop("slow", None),
    }
    given = [body] if state else [body, theta]
    given += [f"{name}={x}" for name, x in arguments.items() if x is not None]
    line = f"sc.play({', '.join(given)})"
    return first + (line if len(line) <= 100 else "sc.play(\n" + "".join(f"    {x},\n" for x in given) + ")")


def _body(words: dict[str, str]) -> str:
    ell, fillet = words.pop("ell"), words.pop("fillet", None)
    size = {name: words.pop(name, None) for name in ("radius", "mass", "gravity")}
    if "i1" in words:
        numbers = ell, words.pop("i1"), words.pop("i3")
        scale = call("sc.Scale", **size) if size["radius"] else None
        return call("sc.Body", *numbers, fillet=fillet, theta_end=words.pop("end", None), scale=scale)
    bore = words.pop("bore", None)
    radius = size.pop("radius")
    if radius is None:
        return call("sc.Body.tube" if bore else "sc.Body.solid", ell, bore=bore, fillet=fillet)
    of_radius = {
        "outer_diameter": 2.0,
        "inner_diameter": 2 * float(bore) if bore else None,
        "length": 2 * float(ell),
        "fillet": float(fillet) if fillet else None,
    }
    told = {name: None if x is None else number(float(radius) * x) for name, x in of_radius.items()}
    return call("sc.measured", **told, **size)


def _table(words: dict[str, str], size: sc.Scale | None) -> str | None:
    kind = words.pop("contact", None)
    if kind == "coulomb":
        return f"sc.Coulomb({words.pop('mu')})"
    if kind == "viscous":
        c = words.pop("c")
        measured = size and number(float(c) / size.metres_per_second(1.0))
        return f"sc.Viscous.from_si({measured}, scale=sized)" if size else f"sc.Viscous({c})"
    return None if kind is None else f'"{kind}"'


def _loss(words: dict[str, str], size: sc.Scale | None) -> str | None:
    if "law" not in words:
        return None
    name = "".join(map(str.capitalize, words.pop("law").split("-")))
    told = words.pop("loss")
    if size is None:
        return f"sc.loss.{name}({told})"
    measured = getattr(sc.loss, name)(float(told)).in_si(size)
    return f"sc.loss.{name}.from_si({number(float(measured))}, scale=sized)"


def stone(words: dict[str, str]) -> str:
    """The code for the motion of a rattleback as the page follows it; `sc.play` cannot start with a stone."""
    axes, twist, spin = words.pop("stone"), words.pop("twist"), words.pop("spin")
    slow = words.pop("slow", None)
    start = f"hertz={spin} / (2 * np.pi), pitch=np.radians(0.02), roll=np.radians(0.02)"
    return (
        f"rattleback = sc.Ellipsoid.rattleback(({axes.replace(',', ', ')}), twist={twist}).in_metres()\n"
        f"spun = rattleback.spinning({start})\n"
        f"{call('sc.view', 'sc.roll(rattleback, spun, np.linspace(0, 20, 2401))', slow=slow)}"
    )
