"""The drift of a spinning body across a slope."""

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._input.numbers import Result, elementwise, instance_of, is_scalar
from spincyl._state import State, numbers_without_slip


@elementwise
def slope_drift(body: Body, state: State) -> tuple[Result, Result]:
    """Compute the drift of a steadily rolling body across a slope, to first order in the slope.

    A body that spins steadily on its rim does not run down a tilted table: the circle on which its centre
    moves, or the resting centre, is carried across the slope.

    Parameters
    ----------
    body : Body
        Single body or family.
    state : State
        Steady state on the level table, as from `Body.steady` or `Body.circular`.

    Returns
    -------
    drift : float or array
        Velocity of the centre along y over the sine of the slope, in sqrt(g R): positive to the left as one
        looks downhill, as for a body that precesses counterclockwise and stably. Along x there is no drift.
    resonance : float or array
        Stability kappa over the squared precession. The drift is valid for small slopes while this is
        positive and away from 1: at 1, as for a uniform ball, the body runs downhill, and the drift is NaN or
        meaningless; below 0 the body leaves the steady state.

    Raises
    ------
    ValueError
        If a single state is not steady in rolling to six digits, or does not precess; NaN in an array.

    Notes
    -----
    The relative error is a few roundings of the largest term. That of the theory itself, which is of first
    order in the slope, is of the order of the slope. See "Down the slope, and across it" in the
    documentation, and docs/physics.md.

    Examples
    --------
    >>> import spincyl as sc
    >>> tube = sc.Body.tube(6.0, bore=0.8)
    >>> drift, resonance = sc.slope_drift(tube, tube.steady(1.45))
    >>> round(float(drift), 6), round(float(resonance), 6)
    (0.397597, 0.279467)
    """
    instance_of("body", body, Body)
    instance_of("state", state, State)
    given = body._at(*numbers_without_slip(state, "expected a state without slip"))
    drift, resonance = _core.slope_drift(*given), _core.slope_resonance(*given)
    if is_scalar(resonance) and np.isnan(resonance):
        raise ValueError(f"state = {state!r}: expected a steady state of this body with a precession")
    return drift, resonance
