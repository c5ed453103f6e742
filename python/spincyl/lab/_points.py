"""Checks of the measured inclinations and rates, and of their errors, that are given to `compare`."""

import numpy as np

from spincyl._body import Body
from spincyl._input.numbers import Floats, Reals, reals
from spincyl.lab._report import counted
from spincyl.lab._spindown import leaning

LEAST = 3  #: With fewer points no ratio is fitted.


def points(
    theta: Reals, rate: Reals, theta_err: Reals | None, rate_err: Reals | None, body: Body
) -> dict[str, Floats]:
    """The measured points with errors, without missing values; errors name the argument at fault."""
    x = {name: np.asarray(reals(name, v), np.float64) for name, v in (("theta", theta), ("rate", rate))}
    if x["theta"].ndim == x["rate"].ndim == 0:
        x = {name: values[np.newaxis] for name, values in x.items()}
    if x["theta"].ndim != 1 or x["rate"].shape != x["theta"].shape:
        shapes = f"{x['theta'].shape} and {x['rate'].shape}"
        raise ValueError(f"theta and rate: expected equal shapes (n,), not {shapes}")
    measured = np.isfinite(x["theta"]) & np.isfinite(x["rate"])
    if (theta_err is None) != (rate_err is None):
        raise ValueError("theta_err and rate_err: give both or none")
    default = {"theta_err": np.radians(1.0), "rate_err": 0.02 * x["rate"]}
    for name, given in (("theta_err", theta_err), ("rate_err", rate_err)):
        errors = np.asarray(default[name] if given is None else reals(name, given), np.float64)
        if errors.shape not in ((), x["theta"].shape):
            raise ValueError(f"{name}: expected a number or shape {x['theta'].shape}, not {errors.shape}")
        x[name] = np.broadcast_to(errors, x["theta"].shape)
    x = {name: values[measured] for name, values in x.items()}
    leaning("theta", x["theta"], body)
    if not ((x["rate"] >= 1e-6) & (x["rate"] <= 1e6)).all():
        raise ValueError("rate: expected positive numbers: reduced rates from 1e-6 to 1e6")
    for name, of in (("theta_err", 1.0), ("rate_err", x["rate"])):
        if not ((x[name] >= 1e-12 * of) & (x[name] <= 1e3 * of)).all():
            unit = "radian" if name == "theta_err" else "times the value"
            raise ValueError(f"{name}: expected positive numbers from 1e-12 to 1e3 {unit}")
    given = x["theta"].size
    different = len(np.unique(np.stack([x["theta"], x["rate"]]), axis=1).T) if given else 0
    if different < (LEAST if theta_err is None else min(given, LEAST)) or not given:
        told = counted(given)
        told += f" ({counted(different)} different)" if different < given else ""
        empty = int((~measured).sum())
        told += f", and {counted(empty)} with NaN" if empty else ""
        more = "; one or two need theta_err and rate_err" if theta_err is None and given else ""
        raise ValueError(f"theta and rate: expected at least three different points, not {told}{more}")
    return x
