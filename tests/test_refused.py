"""Invalid arguments are refused by name, before anything is written (rows A2, A5 of docs/hard-cases.md)."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import spincyl as sc

BODY = sc.Body.solid(2.5)
THETA = np.array([0.05, 0.1, 1.3, 1.5])
SOME = np.array([True, False, True, False])
READ_OFF = ["energy", "acceleration", "angular_momentum", "beta", "speed_o", "speed_x", "centre_radius"]


@pytest.mark.parametrize("name", READ_OFF)
@pytest.mark.parametrize("bad", [1.3, None, "1.3", (1.3, 0.0, 0.0, 0.0), BODY])
def test_what_is_read_off_a_state_needs_a_state(name, bad):
    with pytest.raises(TypeError, match=f"^state: expected a State, not {type(bad).__name__}$"):
        getattr(BODY, name)(bad)


@pytest.mark.parametrize("bad", [2.5, None, BODY.steady(1.3)])
def test_a_frequency_needs_a_body(bad):
    with pytest.raises(TypeError, match="^body: expected a Body, not "):
        sc.Scale(0.01).hertz(bad, 1.0)


LAWS = {
    "rate": lambda **how: BODY.rate(THETA, **how),
    "region": lambda **how: BODY.region(THETA, **how),
    "stability": lambda **how: BODY.stability(THETA, **how),
    "smooth": lambda **how: BODY.stability(THETA, "smooth", **how),
    "of a state": lambda **how: BODY.stability(BODY.steady(THETA), **how),
    "series": lambda **how: BODY.rate(pd.Series(THETA), **how),
}


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize(
    "bad",
    [pd.Series(SOME), pd.DataFrame({"a": SOME}), pd.Index(SOME), pd.array([True, None, True, False]), pd.NA,
     xr.DataArray(SOME), np.ma.masked_array(SOME, SOME), SOME.astype(int), "yes", None, 1],
    ids=lambda bad: type(bad).__name__,
)  # fmt: skip
def test_where_is_true_false_or_a_plain_array_of_them(law, bad):
    out = np.full(4, -1.0)
    with pytest.raises(TypeError, match=f"^where: .*, not {type(bad).__name__}"):
        law(where=bad, out=out)
    with pytest.raises(TypeError, match="^where: "):
        law(where=bad)
    assert (out == -1).all()


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize(
    "bad", [pd.NA, pd.NaT, "x", [0.0] * 4, 0.0, (pd.NA,)], ids=lambda bad: type(bad).__name__
)
def test_out_is_an_array_to_fill(law, bad):
    with pytest.raises(TypeError, match="^out: expected an array to fill, not "):
        law(out=bad)


def test_whole_numbers_cannot_hold_a_rate_whatever_the_input_is():
    # pandas would cast NaN to the smallest integer
    for theta in (THETA, pd.Series(THETA), xr.DataArray(THETA)):
        out = np.full(4, -1)
        with pytest.raises(TypeError, match="^out: rate gives float64, which int64 cannot hold"):
            BODY.rate(theta, out=out)
        assert (out == -1).all()
    assert BODY.region(THETA, out=np.zeros(4, int))[3] == sc.Region.STABLE
    assert BODY.rate(THETA[:1], out=np.zeros(1, int), casting="unsafe")[0] == 1


def test_texts_and_dates_cannot_hold_a_rate():
    # NumPy would write 1.3 as "1" into a text of one letter
    for out in (np.array(["a"]), np.array([b"a"]), np.array(["2020"], "datetime64[Y]")):
        with pytest.raises(TypeError, match="^out: rate gives float64, which .* cannot hold"):
            BODY.rate(THETA[2:3], out=out)


def test_plain_masks_and_targets_of_any_kind_are_filled():
    expected = np.where(SOME, BODY.rate(THETA), -1.0)
    for where in (SOME, list(SOME)):
        assert np.array_equal(BODY.rate(THETA, out=np.full(4, -1.0), where=where), expected)
    assert np.isnan(BODY.rate(THETA, where=True, out=None)).sum() == np.isnan(BODY.rate(THETA)).sum()
    series = BODY.rate(pd.Series(THETA), out=(pd.Series(np.zeros(4)),))
    assert np.array_equal(series, BODY.rate(THETA), equal_nan=True)


def test_a_missing_value_is_no_number():
    for call in (BODY.rate, BODY.steady(1.3).kicked, sc.Body.solid, lambda x: sc.State(x, 0.0, 0.0, 0.0)):
        with pytest.raises(TypeError, match=r"^(theta|thetadot|ell): expected real numbers, not NAType"):
            call(pd.NA)


class Series:
    """A Series of polars as NumPy sees it: it accepts ufuncs, and its dtype is unknown to NumPy."""

    __module__ = "polars.series.series"
    dtype = "Float64"
    __array_ufunc__ = None

    def __init__(self, values):
        self.values = values

    def __len__(self):
        return len(self.values)

    def to_numpy(self):
        return np.array(self.values)


def test_a_series_of_polars_is_an_array_of_numpy():
    assert np.array_equal(BODY.rate(Series(THETA)), BODY.rate(THETA), equal_nan=True)
    assert BODY.steady(Series([1.3, np.nan])).w1.tolist()[0] == BODY.steady(1.3).w1
    assert sc.roll(BODY, BODY.steady(1.3), Series([0, 1])).t.tolist() == [0.0, 1.0]
    with pytest.raises(TypeError, match="^theta: expected real numbers"):
        BODY.rate(Series(["a"]))
