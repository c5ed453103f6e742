"""Results without lanes (`SPINCYL_LANES=off`) agree with those in lanes within the claimed errors."""

import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest
import scenes

import spincyl as sc

ULP = 2.0**-53


def numbers(x):
    """All numbers inside an object."""
    if isinstance(x, dict):
        x = list(x.values())
    return [y for part in x for y in numbers(part)] if isinstance(x, tuple | list) else [float(x)]


def everything():
    """Results of every kind that is computed in lanes, by name."""
    odd = [0.0, 1e-300, 1e-12, np.pi / 2, np.nextafter(np.pi / 2, 2), 2.0, np.nan]
    theta = np.concatenate([np.linspace(0.02, 1.56, 60), odd])
    ell = np.concatenate([np.linspace(0.0, 3.0, 33), [1e-300, np.sqrt(3) / 2, 1e3, 1e12]])
    found = {}
    for name, body in {
        "sharp": sc.Body.tube(ell, bore=0.4),
        "rounded": sc.Body.tube(ell, bore=0.4, fillet=0.3),
        "mixed": sc.Body.tube(ell, bore=0.4, fillet=np.where(ell < 1.5, 0.0, 0.3)),
    }.items():
        grid = theta[:, None]
        found[f"rate of {name}"] = body.rate(grid)
        for contact in ("rolling", "smooth"):
            found[f"kappa {contact} of {name}"] = body.stability(grid, contact)
        found[f"region of {name}"] = body.region(grid)
    quantities = ("rate", "kappa_rolling", "kappa_smooth", "energy", "region")
    for name, edge in {"sharp": 0.0, "rounded": 0.3, "mixed": np.where(ell < 1.5, 0.0, 0.3)}.items():
        where = (theta, ell, 0.4, edge) if name != "mixed" else (0.9, ell, 0.4, edge)
        how = sc.sweep.portrait if name != "mixed" else sc.sweep.points
        for kind in quantities:
            found[f"map of {kind} of {name}"] = np.asarray(how(*where, want=kind)[kind])
            found[f"map of {kind} among all of {name}"] = np.asarray(how(*where, want=quantities)[kind])
        found[f"single rate of {name}"] = np.asarray(how(*where, want="rate", dtype="float32")["rate"])
        if name != "mixed":
            survey = sc.sweep.survey(
                theta[:60], ell[:33], 0.4, edge, want=("rate", "kappa_rolling", "energy")
            )
            for kind in ("rate", "kappa_rolling", "energy"):
                found_ends = numbers(survey[kind])
                found[f"ends of {kind} of {name}"] = np.array(found_ends)
    # bodies that cannot be thrown: only for maps
    bodies = sc.Body.solid(ell[:35] + 0.2)
    start = sc.State(0.9, 0.7, 0.1, 0.8)
    slips = sc.State(0.9, 0.7, 0.1, 0.8, slip=(0.5, -0.2))
    losses = sc.loss.AirLinear(0.01) + sc.loss.DryContour(1e-3)
    for name, state, how in [
        ("rolling", start, {}),
        ("smooth", start, {"contact": "smooth"}),
        ("slip", slips, {"contact": sc.Coulomb(0.3)}),
        ("losses", start, {"losses": losses}),
    ]:
        swept = sc.sweep.roll(bodies, state, 3.0, want=("final", "end"), **how)
        for kind in ("theta", "w1", "w2", "w3", "end", "error", "status"):
            found[f"{name}: {kind}"] = swept[kind].to_numpy()
    for centre in ("rest", "rolling"):
        drift = sc.drift(bodies, 0.3, losses, centre=centre)
        found[f"drift {centre}"] = np.asarray(drift.stops_at)
    return found


def at_random():
    """For random scenes: whether ends at once and alone differ, and differences in units of the estimated errors."""
    drawn = (scenes.draw(np.random.default_rng([25, family]), 10) for family in range(30))
    return np.array([(apart.kind, apart.ratio) for scene in drawn for apart in scenes.compare(scene)])


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """The same results from a process without lanes."""
    path = tmp_path_factory.mktemp("alone") / "found.npz"
    told = "import sys, numpy as np, test_alone; np.savez(sys.argv[1], scenes=test_alone.at_random(), **test_alone.everything())"
    where = {"SPINCYL_LANES": "off", "PYTHONPATH": str(pathlib.Path(__file__).parent)}
    paths = os.pathsep.join(filter(None, [where["PYTHONPATH"], os.environ.get("PYTHONPATH", "")]))
    subprocess.run(
        [sys.executable, "-c", told, str(path)], check=True, env=os.environ | where | {"PYTHONPATH": paths}
    )
    return dict(np.load(path))


def test_maps_and_elementwise_functions_are_the_same_to_a_few_ulp(alone):
    together = everything()
    assert together.keys() | {"scenes"} == alone.keys()
    for name in (name for name in together if "of " in name):
        a, b = together[name], alone[name]
        assert a.shape == b.shape and a.dtype == b.dtype
        if "region" in name:
            assert (a == b).all(), name
            continue
        assert np.array_equal(np.isnan(a), np.isnan(b)), name
        ulp = 2.0**-24 if a.dtype == np.float32 else ULP
        # NaN or inf in both; finite numbers are compared relative to the largest of their row
        rest = np.isfinite(a)
        assert (a[np.isinf(a)] == b[np.isinf(a)]).all(), name
        a, b = (np.where(rest, x, 0.0) for x in (a, b))
        assert (np.abs(a - b) <= 64 * ulp * np.abs(a).max(axis=-1, keepdims=True)).all(), name


def test_motions_agree_within_both_claims_and_end_alike(alone):
    together = everything()
    for name in ("rolling", "smooth", "slip", "losses"):
        assert (together[f"{name}: status"] == alone[f"{name}: status"]).all()
        claim = together[f"{name}: error"] + alone[f"{name}: error"]
        for kind in ("theta", "w1", "w2", "w3", "end"):
            a, b = together[f"{name}: {kind}"], alone[f"{name}: {kind}"]
            assert (np.abs(a - b) <= claim).all(), (name, kind)
    for name in (name for name in together if name.startswith("drift")):
        a, b = together[name], alone[name]
        assert (
            np.allclose(a, b, rtol=1e-9, atol=0, equal_nan=True) if a.dtype.kind == "f" else (a == b).all()
        ), name


def test_random_scenes_without_lanes_are_what_each_motion_is_alone(alone):
    other, ratio = alone["scenes"].T
    assert ratio.size == 300 and not other.any() and ratio.max() <= 1
