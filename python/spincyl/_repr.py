"""The repr of a body: a call of the constructor that makes it."""

from typing import TYPE_CHECKING

import numpy as np

from spincyl._circles import FIELDS
from spincyl._input.numbers import is_scalar
from spincyl._input.reprs import is_lazy, repr_of_call

if TYPE_CHECKING:
    from spincyl._body import Body


def repr_of_body(found: "Body") -> str:
    """A call of the shortest constructor that makes the body: `Body` with all fields if no other does."""
    if found._measured:
        return repr_of_call("Body.from_metres" if found.scale is None else "measured", **found._measured)
    fields = {name: getattr(found, name) for name in FIELDS}
    if found.rims is not None:
        fields["rims"] = tuple(map(tuple, found._rows)) if found._single else found.rims
        del fields["bore"]
        if found._single and found.scale is None:
            return repr_of_call("Body.profile", fields["rims"], i1=found.i1, i3=found.i3)
        if found.scale is None:
            return repr_of_call("Body", **fields)
    if found.scale is not None:
        return f"{repr_of_call('Body', **fields)[:-1]}, scale={found.scale!r})"
    sharp = is_scalar(found.fillet) and found.fillet == 0
    ends = {name: fields[name] for name in ("bore", "theta_end")}
    unsaid = {name for name, x in ends.items() if is_scalar(x) and np.isnan(x)}
    if "bore" in unsaid or (not is_lazy(found.bore) and np.isnan(np.asarray(found.bore)).any()):
        unsaid |= {"fillet"} if sharp else set()
        return repr_of_call("Body", **{name: x for name, x in fields.items() if name not in unsaid})
    half = found.ell if sharp else found.ell + found.fillet
    # `Body.tube` cannot reproduce a length with rounding errors or a `theta_end`
    rounded = not sharp and not is_lazy(half) and not np.array_equal(half - found.fillet, found.ell)
    if rounded or "theta_end" not in unsaid:
        return repr_of_call("Body", **fields)
    more = {} if sharp else {"fillet": found.fillet}
    if is_scalar(found.bore) and found.bore == 0:
        return repr_of_call("Body.solid", half, **more)
    return repr_of_call("Body.tube", half, bore=found.bore, **more)
