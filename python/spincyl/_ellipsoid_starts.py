"""Initial states of stones: spinning upright, with a velocity of the centre, or dropped."""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from spincyl import _core
from spincyl._ellipsoid_state import EllipsoidState, as_doubles
from spincyl._input.hints import Hinting
from spincyl._input.numbers import (
    Reals,
    Result,
    common_shape,
    instance_of,
    numbered,
    radians,
    reals,
    refuse_bad_value,
    si,
    turns_per_second,
)
from spincyl._sized import Sized
from spincyl._slip import rise_of_stone, slip_of_stone


class StoneStarts(Sized, Hinting):
    """Base of `Ellipsoid`: methods that make the states from which motions start."""

    def spinning(
        self, spin: Reals | None = None, *, hertz: Reals | None = None, pitch: Reals = 0.0, roll: Reals = 0.0
    ) -> EllipsoidState:
        """Initial state of a stone that spins about the vertical, upright or nearly upright.

        A bare number is in sqrt(g/a), also for a measured stone; ``hertz=`` takes turns per second.

        Parameters
        ----------
        spin : array_like
            Angular velocity about the vertical, sqrt(g/a), counterclockwise as seen from above.
        hertz : array_like
            Turns per second about the vertical, in place of `spin`; needs a measured stone.
        pitch, roll : array_like
            Angles in radians by which the stone is rotated from upright: first by `pitch` about axis 2, then
            by `roll` about axis 1. If both are 0, nothing disturbs the upright spin, even if it is unstable.
        """
        spin = self._spin(spin, hertz)
        pitch, roll = tilt_of_stone("pitch", pitch), tilt_of_stone("roll", roll)
        common_shape({"spin": spin, "pitch": pitch, "roll": roll})
        with np.errstate(invalid="ignore"):  # angles and spins that are not finite give NaN without a warning
            n = _core.stone_tilted(*numbered(3, pitch, roll))
            return EllipsoidState(n, n * spin[..., None])

    def with_centre_velocity(self: Any, state: EllipsoidState, x: Reals, y: Reals) -> EllipsoidState:
        """Return the state with the slip that a given velocity of the centre of mass implies.

        Parameters
        ----------
        state : EllipsoidState
            State whose slip, if it has one, is replaced.
        x, y : array_like
            Horizontal velocity of the centre of mass, in sqrt(g a), along the axes x and y that
            `EllipsoidState.slip` describes.

        Examples
        --------
        An egg spun on its side, with its centre at rest:

        >>> import numpy as np
        >>> import spincyl as sc
        >>> egg = sc.Ellipsoid.egg(0.022, 0.0285).in_metres(0.06)
        >>> state = egg.with_centre_velocity(egg.spinning(hertz=18, pitch=np.radians(85)), 0.0, 0.0)
        >>> state.slip.round(3).tolist()
        [0.0, -0.276]
        """
        instance_of("state", state, EllipsoidState)
        x, y = (as_doubles(reals(name, value)) for name, value in (("x", x), ("y", y)))
        n, w = state.vertical, state.w
        states = np.broadcast_to(0.0, np.broadcast_shapes(n.shape[:-1], w.shape[:-1]))
        common_shape({"body": np.broadcast_to(0.0, self.shape), "state": states, "x": x, "y": y})
        with np.errstate(all="ignore"):
            slip = slip_of_stone(self, n, w, x, y)
        return replace(state, slip=slip)

    def dropped(
        self: Any,
        state: EllipsoidState,
        height: Reals,
        *,
        velocity: tuple[Reals, Reals, Reals] = (0.0, 0.0, 0.0),
    ) -> EllipsoidState:
        """Initial state of a stone in the air, from which it falls; `roll` then needs a `restitution`.

        Parameters
        ----------
        state : EllipsoidState
            State with the vertical and the angular velocity of the stone. Its slip, height and lift, if it
            has them, are replaced.
        height : array_like
            Height of the lowest point of the stone above the table, 0 or more, in the unit a; for a
            measured stone in metres.
        velocity : three of array_like, optional
            Velocity of the centre of mass in sqrt(g a), for a measured stone in m/s. The three components are
            along the axes x and y that `EllipsoidState.slip` describes, and upward.

        Returns
        -------
        EllipsoidState
            State with `slip`, `height` and `lift`, in natural units. It has the broadcast shape of the
            arguments. Error: 4 * 2^-53 of the largest term.

        Raises
        ------
        ValueError, TypeError
            If an argument is invalid; the message names it.

        Examples
        --------
        An egg that is dropped on its side falls by 10 mm before it lands:

        >>> import numpy as np
        >>> import spincyl as sc
        >>> egg = sc.Ellipsoid.egg(0.022, 0.0285).in_metres(0.06)
        >>> start = egg.dropped(egg.spinning(0.0, pitch=np.pi / 2), 0.01)
        >>> m = sc.roll(egg, start, 0.1, contact=sc.Coulomb(0.3), restitution=0.4)
        >>> m.phases[0].kind, round(m.impacts[0].time, 6), round((2 * 0.01 / 9.80665) ** 0.5, 6)
        ('flying', 0.04516, 0.04516)
        """
        instance_of("state", state, EllipsoidState)
        if not isinstance(velocity, tuple | list) or len(velocity) != 3:
            raise TypeError(f"velocity: expected three components (x, y, upward), not {velocity!r}")
        measured = self.scale is not None
        metre, second = self.scale._units[:2] if measured else (1.0, 1.0)
        height = reals("height", si("height", height, "metre") if measured else height)
        why = "expected 0 <= height, finite"
        refuse_bad_value("height", height, lambda x: ~((x >= 0) & (x < np.inf)), why)
        moves = (reals("velocity", si("velocity", x, "metre/second") if measured else x) for x in velocity)
        x, y, upward = (as_doubles(move) * (second / metre) for move in moves)
        found: EllipsoidState = self.with_centre_velocity(state, x, y)
        with np.errstate(all="ignore"):
            rise = upward - rise_of_stone(self, found.vertical, found.w)
            high = as_doubles(height) / metre
            return replace(found, height=(high + 0.0 * rise)[()], lift=(rise + 0.0 * high)[()])

    def hertz(self, state: EllipsoidState) -> Result:
        """Turns per second about the vertical in a state or an array of states; needs a measured stone."""
        scale = self._sized("hertz")
        return scale.turns(instance_of("state", state, EllipsoidState).spin)

    def _spin(self, spin: Reals | None, hertz: Reals | None) -> Reals:
        """The spin in sqrt(g/a), given directly or in turns per second."""
        if (spin is None) == (hertz is None):
            raise TypeError("spin, hertz: give exactly one of them; hertz= needs a measured stone")
        if hertz is None:
            if isinstance(spin, str):
                raise TypeError(f"spin = {spin!r}: expected a number in sqrt(g/a); hertz= takes turns/s")
            return as_doubles(reals("spin", spin))
        if self.scale is None:
            raise ValueError("hertz: needs a measured stone, made with in_metres(); for any other give spin=")
        return as_doubles(reals("hertz", turns_per_second("hertz", hertz))) / self.scale._units[3]


def tilt_of_stone(name: str, value: Reals) -> Reals:
    """Return an angle in radians; warn above pi/2, where degrees were probably meant."""
    return as_doubles(radians(name, value, likely=math.pi / 2))
