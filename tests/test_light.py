"""What a call does besides its equations: counted in calls of functions, objects and modules, not in time."""

import pickle
import subprocess
import sys

import numpy as np
import pytest

import spincyl as sc

BALL = sc.Body.ball(0.0, i1=0.4, i3=0.4)
HOPS = sc.dropped(BALL, 2.5, 1.2, w1=2.0, w2=-3.0, w3=1.0, velocity=(1.0, -2.0, 0.5))


def calls(job):
    """Number of functions of Python that a job calls."""
    count = [0]

    def profile(_, event, __):
        count[0] += event == "call"

    sys.setprofile(profile)
    try:
        job()
    finally:
        sys.setprofile(None)
    return count[0]


def test_a_state_from_numbers_is_made_without_looking_at_arrays():
    body = sc.Body.solid(2.5)
    state = body.steady(1.3)
    assert calls(lambda: body.steady(1.3).kicked(0.05)) < 30
    assert state.kicked(0.05) == sc.State(1.3, state.w1, -0.05, state.w3)
    assert state.kicked(np.array([0.05])).w2.shape == (1,)
    slips = sc.State(1.3, 0.1, 0.2, 0.3, slip=(0.1, 0.2)).kicked(0.5)
    assert slips == sc.State(1.3, 0.1, -0.3, 0.3, slip=(0.1, 0.2))
    with pytest.raises(ValueError, match="theta"):
        body.steady(80.0)


def test_a_small_sweep_builds_its_result_once():
    body = sc.Body.solid(2.5)
    states = body.steady(np.full(4, 1.3)).kicked(0.05)
    sc.sweep.roll(body, states, 20.0)  # imports
    assert calls(lambda: sc.sweep.roll(body, states, 20.0, threads=1)) < 1000


def test_the_first_sweep_of_plain_arrays_imports_xarray_and_nothing_of_dask_or_scipy():
    code = """
import sys, numpy as np, spincyl as sc
assert "xarray" not in sys.modules
body = sc.Body.solid(np.linspace(1, 3, 5))
for t in (20.0, [0.0, 20.0]):
    sc.sweep.roll(body, body.steady(1.3), t)
print(*{name.partition(".")[0] for name in sys.modules})
"""
    run = [sys.executable, "-c", code]
    found = set(subprocess.run(run, capture_output=True, text=True, check=True).stdout.split())
    assert "xarray" in found
    assert not found & {"dask", "scipy", "matplotlib", "zarr"}


ELL, THETA = np.linspace(1.0, 3.0, 4), np.linspace(1.0, 1.4, 3)
SHAPES = {
    "one": (2.0, 1.2),
    "one in an array": (2.0, np.array([1.2])),
    "a row": (ELL, 1.2),
    "a table": (ELL[:, None], THETA),
    "none": (ELL[:0], 1.2),
}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("t", [10.0, np.linspace(0.0, 10.0, 3)], ids=["end", "times"])
@pytest.mark.parametrize("radius", [None, 0.02])
def test_a_sweep_is_the_dataset_that_the_public_constructor_of_xarray_makes(shape, t, radius, monkeypatch):
    import xarray

    from spincyl.sweep import _swept

    ell, theta = SHAPES[shape]
    body, states = sc.Body.solid(ell), sc.Body.solid(ell).steady(theta).kicked(0.05)
    body = body if radius is None else body.in_metres(0.03, radius=radius)
    made, dataset = [], _swept.dataset
    monkeypatch.setattr(_swept, "dataset", lambda *of: made.append(of) or dataset(*of))
    want = "states" if np.ndim(t) else ("final", "slip_time")
    found = sc.sweep.roll(body, states, t, contact=sc.Coulomb(0.4), want=want)
    (given,) = made
    public = xarray.Dataset(given[0], given[1]).assign_attrs(found.attrs)
    assert public.identical(found)
    assert list(public.variables) == list(found.variables)
    assert public.indexes.keys() == found.indexes.keys()
    if np.ndim(t):
        assert found.sel(t=5.0).identical(public.sel(t=5.0))


def test_an_impact_and_a_phase_become_objects_when_they_are_asked_for(monkeypatch):
    made = []
    monkeypatch.setattr("spincyl._phases.state_without_checks", lambda *of: made.append(of))
    how = {"contact": sc.Coulomb(0.25), "restitution": 0.9, "tol": 1e-8}
    m = sc.roll(BALL, HOPS, 100.0, **how)
    assert not made
    assert m.lost_in_impacts[-1] > 0
    assert not made
    assert len(m.impacts) > 100
    assert len(made) == 2 * len(m.impacts)
    assert len(m.phases) + 2 * len(m.impacts) == len(made)


@pytest.mark.parametrize("metres", [False, True])
def test_impacts_and_phases_are_tuples_that_are_made_once_and_survive_a_file(metres):
    ball = BALL.in_metres(0.2, radius=0.03) if metres else BALL
    m = sc.roll(ball, HOPS, 2.0 if metres else 20.0, contact=sc.Coulomb(0.25), restitution=0.5)
    unlooked = pickle.loads(pickle.dumps(m))
    assert type(m.impacts) is type(m.phases) is tuple
    assert m.impacts is m.impacts
    assert m.phases is m.phases
    again = pickle.loads(pickle.dumps(m))
    assert m == again == unlooked
    assert m.impacts == again.impacts == unlooked.impacts
    assert repr(m.phases) == repr(unlooked.phases)
    second = ball.scale.seconds(1.0) if metres else 1.0
    natural = m.natural.impacts
    assert [x.time for x in m.impacts] == [x.time * second for x in natural]
    assert [x.before for x in m.impacts] == [x.before for x in natural]
    # with poses this ball is integrated
    for x, y in zip(m.wanting("pose").impacts, m.impacts, strict=True):
        assert x.time == pytest.approx(y.time, rel=1e-9)
    total = sum(x.lost for x in m.impacts)
    assert m.lost_in_impacts[-1] == pytest.approx(total, rel=1e-14)
    (hit,) = m.impacts[:1]
    assert (hit.rim, hit.stays, hit.before.lift < 0, hit.after.lift > 0) == ("first", False, True, True)
