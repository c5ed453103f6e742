"""How the nouns write themselves: single numbers as they were typed, many by their ends, as NumPy does."""

from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl._array import Reals, is_scalar

if TYPE_CHECKING:
    from spincyl._body import Body

_FEW = 6
#: The numbers of a body, in the order of the core.
FIELDS = ("ell", "i1", "i3", "bore", "fillet", "theta_end")


def call(name: str, *plain: Reals, **named: Reals) -> str:
    """A call that makes the thing, which Python can evaluate unless an array was shortened."""
    words = [text(x) for x in plain] + [f"{key}={text(x)}" for key, x in named.items()]
    line = f"{name}({', '.join(words)})"
    return line if len(line) <= 110 else f"{name}({(',' + chr(10) + ' ' * (len(name) + 1)).join(words)})"


def text(value: Reals) -> str:
    """A number with all its digits, a few of them as a list, more of them by their ends and shape; pairs."""
    if isinstance(value, tuple):
        return f"({', '.join(map(text, value))})"
    if is_scalar(value):
        return repr(float(value))
    kind = "array" if type(value) is np.ndarray else type(value).__name__
    if is_lazy(value):
        return f"<lazy {kind}, shape={tuple(value.shape)}>"
    values = value if isinstance(value, np.ndarray) else np.asarray(value)
    if values.size <= _FEW:
        listed = repr(values.astype(np.float64).tolist())
        return listed if kind == "array" else f"{kind}({listed})"
    first, last = (", ".join(map(_short, ends)) for ends in (values.flat[:3], values.flat[-3:]))
    return f"{kind}([{first}, ..., {last}], shape={values.shape})"


def is_lazy(value: Any) -> bool:
    """Whether to look at the numbers would mean to compute them."""
    return getattr(value, "chunks", None) is not None


def _short(x: Any) -> str:
    return "--" if x is np.ma.masked else repr(float(f"{x:.6g}"))


def body(found: "Body") -> str:
    """A body as the constructor that makes it; in full where none of them does."""
    if found._measured:
        return call("Body.from_metres" if found.scale is None else "measured", **found._measured)
    fields = dict(zip(FIELDS, found._numbers, strict=True))
    if found.scale is not None:
        return f"{call('Body', **fields)[:-1]}, scale={found.scale!r})"
    sharp = is_scalar(found.fillet) and found.fillet == 0
    ends = {name: fields[name] for name in ("bore", "theta_end")}
    unsaid = {name for name, x in ends.items() if is_scalar(x) and np.isnan(x)}
    if "bore" in unsaid or (not is_lazy(found.bore) and np.isnan(np.asarray(found.bore)).any()):
        unsaid |= {"fillet"} if sharp else set()
        return call("Body", **{name: x for name, x in fields.items() if name not in unsaid})
    half = found.ell if sharp else found.ell + found.fillet
    # of a length that is rounded, or with an end of its own, it is no tube that can be said
    rounded = not sharp and not is_lazy(half) and not np.array_equal(half - found.fillet, found.ell)
    if rounded or "theta_end" not in unsaid:
        return call("Body", **fields)
    more = {} if sharp else {"fillet": found.fillet}
    if is_scalar(found.bore) and found.bore == 0:
        return call("Body.solid", half, **more)
    return call("Body.tube", half, bore=found.bore, **more)
