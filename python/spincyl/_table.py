"""The table on which a body moves: its slope, and where on it the body starts."""

from dataclasses import dataclass, field

from spincyl._input.equality import compared_by_value
from spincyl._input.hints import HintingFamily
from spincyl._input.numbers import Reals, number, radians, read_only_copy, reals
from spincyl._input.reprs import repr_of_call


@compared_by_value
@dataclass(frozen=True, eq=False, repr=False)
class Table(HintingFamily):
    """A table that is level or tilted, and may turn, for `table=` of `roll` and `sweep.roll`.

    On a slope x points downhill in the table, y to the left as one looks downhill, and z along its
    normal. Inclinations and heights are measured from the table, and `Motion.phi` from downhill: on a body
    that leans downhill it is 0, and a body on its side rolls straight down with phi = -pi/2.

    Parameters
    ----------
    slope : float
        Angle of the table with the horizontal in radians, or a text such as "5 deg"; between -pi/2 and pi/2.
        In a sweep it may be an array.
    turning : float
        Rate at which the table turns about its normal through x = y = 0, counterclockwise as seen from
        above, in sqrt(g/R); for `roll` only. The slip and the drilling are relative to the table; all other
        numbers are relative to the laboratory. The motion ends when a face or two rims touch this table.
    phi0 : float
        Direction to which the axis leans in the initial state, as an angle from x in radians, or a text. In a
        sweep it may be an array. A stone and its slip are rotated about z by this angle, from the directions
        that `EllipsoidState` describes.
    place : pair of float
        Initial contact point (x, y), in R.

    Raises
    ------
    TypeError, ValueError
        If a number is not real, or an angle is beyond pi, as if it were in degrees.

    Notes
    -----
    The motion on a slope is that on a level table with a horizontal force M g tan(slope) on the centre, in
    the time sqrt(cos(slope)) t (docs/slopes.md). On a slope a body of revolution rolls, slips, flies, bounces
    and slides on its face, with every law of friction at a contact point and with all losses, except dry
    friction along the contour together with drilling friction. A stone rolls and slips on a slope, with the
    same losses, but not on a table that turns. On a table that turns, a loss along the contour excludes
    drilling friction and a patch of contact; if that table is also tilted, drilling friction excludes rolling
    resistance. If friction holds a ball at rest relative to a table that turns, the motion ends with
    `Ending.STOPS`.

    Examples
    --------
    >>> import spincyl as sc
    >>> ball, still = sc.Body.ball(0.0, 0.4, 0.4), sc.State(1.0, 0.0, 0.0, 0.0)
    >>> m = sc.roll(ball, still, 3.0, table=sc.Table(0.3), want="pose")
    >>> round(float(m.centre[-1, 0]), 6)  # 5/14 of sin(0.3) t^2
    0.949886
    """

    slope: Reals = 0.0
    turning: float = field(default=0.0, kw_only=True)
    phi0: Reals = field(default=0.0, kw_only=True)
    place: tuple[Reals, Reals] = field(default=(0.0, 0.0), kw_only=True)

    def __post_init__(self) -> None:
        slope = radians("slope", self.slope, "-pi/2 < slope < pi/2")
        object.__setattr__(self, "slope", read_only_copy(slope))
        object.__setattr__(self, "turning", number("turning", self.turning))
        object.__setattr__(self, "phi0", read_only_copy(radians("phi0", self.phi0)))
        if not isinstance(self.place, tuple | list) or len(self.place) != 2:
            raise TypeError(f"place: expected a pair (x, y), not {self.place!r}")
        place = tuple(read_only_copy(reals("place", x)) for x in self.place)
        object.__setattr__(self, "place", place)

    def __repr__(self) -> str:
        names = ("slope", "turning", "phi0", "place")
        given, level = {k: getattr(self, k) for k in names}, Table.__dataclass_fields__
        return repr_of_call("Table", **{k: x for k, x in given.items() if not _same(x, level[k].default)})


def _same(x: object, y: object) -> bool:
    return type(x) is type(y) and x == y
