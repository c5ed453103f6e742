"""How bodies, states and motions show themselves: in words that Python can evaluate, and as a card in a notebook."""

import copy
import dataclasses
import pickle

import dask
import dask.array as da
import numpy as np
import pandas as pd
import pytest
import xarray as xr

import spincyl as sc

PVC = {"outer_diameter": 15.875e-3, "inner_diameter": 12.7e-3, "length": 95.25e-3}
ELL = np.linspace(0.1, 3, 300)
NAMES = {"Body": sc.Body, "State": sc.State, "Scale": sc.Scale, "nan": np.nan}


@pytest.mark.parametrize(
    ("value", "typed"),
    [
        (sc.Body.solid(2.5), "Body.solid(2.5)"),
        (sc.Body.tube(2.5, bore=0.0), "Body.solid(2.5)"),
        (sc.Body.tube(6.0, bore=0.8), "Body.tube(6.0, bore=0.8)"),
        (sc.Body.solid(np.float64(0.1)), "Body.solid(0.1)"),
        (sc.Body(1.2, 0.7, 0.5), "Body(ell=1.2, i1=0.7, i3=0.5)"),
        (sc.Body.from_metres(**PVC), "Body.from_metres(outer_diameter=0.015875, inner_diameter=0.0127, length=0.09525)"),
        (sc.Body.solid([0.5, 2.5]), "Body.solid([0.5, 2.5])"),
        (sc.Body.solid([0.5, np.nan]), "Body.solid([0.5, nan])"),
        (sc.State(np.float64(1.3), np.float32(0.5), 0, 1.5), "State(theta=1.3, w1=0.5, w2=0.0, w3=1.5)"),
        (sc.Scale(np.float64(0.02)), "Scale(radius=0.02, mass=1.0, gravity=9.80665)"),
    ],
)  # fmt: skip
def test_what_was_typed_is_shown_and_gives_the_same_back(value, typed):
    assert repr(value) == typed and eval(typed, NAMES) == value
    for other in (copy.deepcopy(value), pickle.loads(pickle.dumps(value))):
        assert repr(other) == typed and other == value


def test_measures_in_metres_are_shown_and_make_no_other_body():
    body = sc.Body.from_metres(**PVC)
    plain = sc.Body.tube(body.ell, body.bore)
    assert body == plain and hash(body) == hash(plain) and repr(plain).startswith("Body.tube(6.0, bore=0.7")
    assert repr(dataclasses.replace(body)) == repr(plain)
    assert sc.Body.from_metres(outer_diameter=1.0, length=2.5) == sc.Body.solid(2.5)


@pytest.mark.parametrize(
    "family",
    [
        sc.Body.solid(ELL),
        sc.Body.tube(ELL[:, None], np.linspace(0, 1, 20)),
        sc.Body(ELL, ELL**2 + 1, 0.5),
        sc.Body.solid(ELL).steady(1.3),
        sc.Body.solid(pd.Series(ELL)),
        sc.Body.solid(xr.DataArray(ELL, dims="ell")),
        sc.State(1.3, np.broadcast_to(1.3, 2**40), 0.0, 0.0),
    ],
)
def test_a_family_is_shown_by_its_ends_and_its_shape(family):
    shown = repr(family)
    assert len(shown.splitlines()) <= 4 and len(shown) < 500 and ", ..., " in shown
    shape = np.shape(family.w1 if isinstance(family, sc.State) else family.ell)
    assert f"shape={shape}" in shown


def test_the_ends_of_a_family_are_those_numbers():
    assert (
        repr(sc.Body.solid(np.arange(10)))
        == "Body.solid(array([0.0, 1.0, 2.0, ..., 7.0, 8.0, 9.0], shape=(10,)))"
    )
    masked = np.ma.masked_array(ELL, ELL < 0.105)
    assert repr(sc.Body.solid(masked)).startswith("Body.solid(MaskedArray([--, 0.109699, 0.119398, ..., ")


def test_a_family_of_tubes_and_other_bodies_is_not_called_tubes():
    mixed = sc.Body([1.0, 1.0], [0.5, 0.25 + 1 / 3], [0.5, 0.5], [np.nan, 0.0])
    assert repr(mixed).startswith("Body(ell=[1.0, 1.0], i1=[0.5, ") and "bore=[nan, 0.0]" in repr(mixed)


def test_what_is_lazy_stays_so():
    def never(*_, **__):
        raise AssertionError("computed")

    with dask.config.set(scheduler=never):
        lazy = sc.Body.solid(da.from_array(ELL, chunks=100))
        assert repr(lazy) == "Body.solid(<lazy Array, shape=(300,)>)"
        assert "<lazy DataArray" in repr(
            sc.Body.solid(xr.DataArray(ELL, dims="ell").chunk(ell=50)).steady(1.3)
        )
