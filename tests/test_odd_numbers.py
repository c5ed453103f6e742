"""Arrays with odd numbers or shapes that do not fit: no warnings and no messages of NumPy."""

import os
import re
import warnings
from decimal import Decimal

import numpy as np
import odd
import pytest
import xarray as xr

import spincyl as sc
from spincyl._input import units
from spincyl._input.threads import thread_count
from spincyl.cli import main

FAMILY, BALL = sc.Body.solid(np.array([0.9, 1.5])), sc.Body.ball(0.0, 0.4, 0.4)
STONES = sc.Ellipsoid.uniform([[1.0, 0.6, 0.5], [1.0, 0.5, 0.4]])


def more():
    """Further functions, which broadcast with a family or have loops of their own."""
    found = {
        "stones.growth_rates": (STONES.growth_rates, {"spin": 1.0}),
        "stones.spinning": (STONES.spinning, {"spin": 1.0, "pitch": 0.01, "roll": 0.0}),
        "stones.with_centre_velocity": (
            STONES.with_centre_velocity, {"state": STONES.spinning(1.0, pitch=0.1), "x": 0.0, "y": 0.1},
        ),
        "ball.steady": (BALL.steady, {"theta": 1.0}),
        "ball.circular": (BALL.circular, {"theta": 1.0, "precession": 2.0}),
        "family.circular": (FAMILY.circular, {"theta": 1.3, "precession": 1.0}),
        "family.inclinations": (FAMILY.inclinations, {"rate": 1.5}),
        "family.angular_rate": (FAMILY.angular_rate, {"rate": 1.5}),
        "family.energy": (FAMILY.energy, {"state": sc.State([1.0, 1.1], 0.1, 0.0, 1.0, slip=([0.0, 0.1], 0.0))}),
        "drifts.theta": (sc.drift(odd.DISK, [0.2, 0.3], sc.loss.DryContour(1e-3)).theta, {"t": 1.0}),
    }  # fmt: skip
    for name in ("rate", "region", "steady", "painleve"):
        found[f"family.{name}"] = getattr(FAMILY, name), {"theta": 1.3}
    for name in ("stability", "stable", "nutation", "growth_rate"):
        found[f"family.{name}"] = getattr(FAMILY, name), {"at": 1.3}
    return found


def numeric(value):
    """Whether a value is a number, or numbers, that can be replaced."""
    plain = not isinstance(value, str | bool | sc.State | xr.Dataset)
    if value is None or not plain:
        return False
    try:
        return np.size(value) > 0 and np.asarray(value, np.float64).ndim < 3
    except (TypeError, ValueError):
        return False


def variants(good):
    """Arrays like a valid argument, in which something is odd."""
    good = np.asarray(good, np.float64)
    for x in (np.inf, -np.inf, np.nan, 1e308, -1e200, 1e-320, 0.0, -1.0):
        if good.ndim == 0:
            yield f"[., {x}]", np.array([float(good), x])
        else:
            changed = good.copy()
            changed[..., 0] = x
            yield f"[{x}, ...]", changed
            yield f"two, one with {x}", np.stack([good, changed])
    yield (
        "masked",
        np.ma.array(np.stack([good, good]), mask=np.stack([np.zeros(good.shape), np.ones(good.shape)])),
    )
    yield "empty", np.empty((0, *good.shape))
    yield "turned round", np.array([good, good], ">f4")


def cases(good):
    numbers = [name for name in good if numeric(good[name])]
    for name in numbers:
        for what, value in variants(good[name]):
            yield name, what, {name: value}
        yield name, "three", {name: np.stack(3 * [np.asarray(good[name], np.float64)])}
    for i, name in enumerate(numbers):
        for other in numbers[i + 1 :]:
            two, three = (np.stack(n * [np.asarray(good[x], np.float64)]) for n, x in ((2, name), (3, other)))
            yield f"{name}, {other}", "two and three", {name: two, other: three}


def unclear(call, good, names, given):
    """What is unclear in the response, or None; like `odd.offence`."""
    given = good | given
    plain = [given.pop(name) for name in list(given) if name.startswith("(")]
    known = [x.strip("(") for x in good] + ["theta", "w1", "w2", "w3", "slip", "ell", "shapes do not fit"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", UserWarning)
        warnings.filterwarnings("ignore", r".*\(Status.INVALID\) and are NaN; motion \d+")
        try:
            call(*plain, **given)
        except (TypeError, ValueError) as e:
            named = re.match("|".join(known), str(e)) or any(
                x.strip("(") in str(e) for x in names.split(", ")
            )
            bare = type(e) in (TypeError, ValueError) and not odd._WITHIN.search(str(e))
            return None if bare and named else f"{type(e).__name__}: {str(e)[:100]}"
        except Exception as e:
            return f"{type(e).__name__}: {str(e)[:100]}"


@pytest.mark.parametrize("room", ["nouns", "stones", "laws", "sweeps", "more"])
def test_odd_numbers_in_arrays_and_shapes_that_do_not_fit_are_told_by_name(room):
    subjects = more() if room == "more" else getattr(odd, room)()
    count, offenders = 0, []
    for name, (call, good) in subjects.items():
        for names, what, given in cases(good):
            said = unclear(call, good, names, given)
            count += 1
            if said:
                offenders.append(f"{name}({names} {what}): {said}")
    assert count > 100
    assert not offenders, f"{len(offenders)} of {count}:\n" + "\n".join(offenders)


def test_shapes_that_do_not_fit_are_told_with_their_names():
    for call, said in (
        (lambda: FAMILY.rate(np.ones(3)), r"theta \(3,\), Body \(2,\)"),
        (lambda: FAMILY.inclinations(np.ones(3)), r"of \(3,\), Body \(2,\)"),
        (lambda: sc.Body.solid(np.ones(2), np.zeros(3)), r"ell \(2,\), fillet \(3,\)"),
        (lambda: STONES.growth_rates([1, 2, 3]), r"body \(2,\), spin \(3,\)"),
        (lambda: sc.State(1.0, 0.0, 0.0, [1.0, 2.0], slip=(np.ones(3), 0.0)), r"w3 \(2,\), slip\[0\] \(3,\)"),
        (lambda: sc.Ellipsoid(np.ones((2, 3)), np.ones((3, 3, 3))), r"semi_axes \(2,\), inertia \(3,\)"),
        (lambda: sc.drift(FAMILY, np.ones(3), sc.loss.AirLinear(1e-3)), r"body \(2,\), theta \(3,\)"),
        (lambda: sc.thrown(FAMILY, np.ones(3), 0.0), r"body \(2,\), velocity \(3,\)"),
        (
            lambda: sc.loss.AirLinear(np.ones(3)).power(FAMILY, FAMILY.steady(1.3)),
            r"body \(2,\), state \(2,\), AirLinear \(3,\)",
        ),
    ):
        with pytest.raises(ValueError, match=f"^shapes do not fit: {said}"):
            call()


# texts with units


@pytest.mark.parametrize(
    "exponent", ["e9999999", "e999999999999999999999", "e-9999999", "e-999999999999999999999"]
)
@pytest.mark.parametrize("unit", [*units._KINDS.values(), "angle"])
def test_a_text_with_an_exponent_beyond_all_numbers_is_zero_or_refused(exponent, unit):
    read = units.angle if unit == "angle" else units.quantity(unit)
    for sign in ("", "-"):
        for name in ("deg", "rad") if unit == "angle" else units._UNITS[unit]:
            text = f"{sign}1{exponent}{name}"
            if "e-" in exponent:
                assert read(text) == 0.0
            elif unit == "angle":
                assert np.isinf(read(text))  # functions that take an angle refuse this by name
            else:
                with pytest.raises(
                    units.ArgumentTypeError, match=f"^'{re.escape(text)}': expected an? {unit} of less"
                ):
                    read(text)
    with pytest.raises(
        ValueError, match=r"^outer_diameter: '1e9999999mm': expected a length of less than 1e308 in m"
    ):
        sc.measured(outer_diameter="1e9999999mm", length="95mm")


@pytest.mark.parametrize(
    "text",
    [
        "1e9999999",
        "1e-9999999",
        "1e999999999999999999999",
        "1e16",
        "1.5",
        "-1e16",
        "9" * 5000,
        "1e3mm",
        "nan",
    ],
)
def test_what_is_no_whole_number_is_refused(text):
    with pytest.raises(units.ArgumentTypeError, match=f"^'{re.escape(text)}'"):
        units.whole_text(text)


def test_whole_numbers_are_read_as_decimals_have_them():
    for text in ("1e6", "2.5e1", "1000000000000000.0", "-3e0", "0e99", "10.00"):
        assert units.whole_text(text) == Decimal(text)


@pytest.mark.parametrize(
    "words",
    [
        ("steady", "--length", "1e9999999mm", "--outer", "16mm", "--theta", "85deg"),
        ("roll", "--ell", "2.5", "--theta", "1.5", "--t", "1", "--points", "1e9999999"),
        ("roll", "--ell", "2.5", "--theta", "1e9999999deg", "--t", "1"),
        (
            "roll",
            "--ell",
            "2.5",
            "--radius",
            "1e9999999mm",
            "--theta",
            "1.5",
            "--t",
            "1e999999999999999999999s",
        ),
    ],
)
def test_on_the_command_line_too(words, capsys):
    try:
        status = main(words)
    except SystemExit as e:
        status = e.code
    assert status == 2 and "expected" in capsys.readouterr().err


# others


def test_results_are_not_written_over_each_other_or_over_what_they_are_made_of():
    theta, ell, into = np.linspace(0.1, 1.5, 9), np.linspace(0.5, 3, 7), np.empty((9, 7))
    for call, said in (
        (
            lambda: sc.sweep.portrait(
                theta, ell, want=("rate", "energy"), out={"rate": into, "energy": into}
            ),
            "rate",
        ),
        (lambda: sc.sweep.portrait(theta, 2.0, want="rate", out={"rate": theta}), "theta"),
        (lambda: sc.sweep.points(theta, 2.0, want="rate", out={"rate": theta}), "theta"),
        (lambda: sc.sweep.points(theta[:4], 2.0, want="rate", out={"rate": theta[2:6]}), "theta"),
        (lambda: sc.sweep.points(0.5, theta, want="energy", out={"energy": theta}), "ell"),
    ):
        with pytest.raises(ValueError, match=rf"^out\['\w+'\]: shares its memory with .*{said}"):
            call()
    both = np.empty(2 * theta.size)
    parts = {"rate": both[: theta.size], "energy": both[theta.size :]}
    found = sc.sweep.points(theta, 2.0, want=("rate", "energy"), out=parts)
    assert np.array_equal(found["rate"], sc.Body.solid(2.0).rate(theta), equal_nan=True)


@pytest.mark.parametrize("contact", ["no", None, 3, ["rolling"], sc.Coulomb])
def test_a_contact_that_is_none_is_refused_by_name(contact):
    stone = sc.Ellipsoid.rattleback((1, 0.3, 0.2), twist=0.05)
    start, body = stone.spinning(-0.5, pitch=0.1), sc.Body.solid(2.5)
    for call in (
        lambda: sc.sweep.roll(stone, start, 1.0, contact=contact),
        lambda: sc.roll(stone, start, 1.0, contact=contact),
        lambda: stone.energy(start, contact=contact),
        lambda: sc.sweep.roll(body, body.steady(1.3), 1.0, contact=contact),
        lambda: sc.roll(body, body.steady(1.3), 1.0, contact=contact),
    ):
        with pytest.raises((TypeError, ValueError), match="^contact"):
            call()


@pytest.mark.parametrize(("asked", "count"), [("", None), ("0", None), ("2", 2), ("4096", 4096)])
def test_an_empty_number_of_threads_is_none(monkeypatch, asked, count):
    monkeypatch.setenv("RAYON_NUM_THREADS", asked)
    every = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    assert thread_count(None) == (count or every)


@pytest.mark.parametrize("asked", ["many", "-1", "4097", "9" * 5000, "1.5", " "])
def test_a_number_of_threads_that_is_none_is_refused_by_the_name_of_the_variable(monkeypatch, asked):
    monkeypatch.setenv("RAYON_NUM_THREADS", asked)
    with pytest.raises(ValueError, match="^RAYON_NUM_THREADS = "):
        thread_count(None)


def test_what_is_no_path_is_refused_by_name_wherever_something_is_saved():
    m = sc.roll(odd.BODY, odd.STATE, 0.5)
    for save in (
        sc.view(m).save, sc.play(odd.BODY).save, sc.scene(odd.measured_motion()).save,
        lambda path: m.sound(path, scale=sc.Scale(0.01)),
    ):  # fmt: skip
        for bad in (3, None, b"x.html", ["x.html"]):
            with pytest.raises(TypeError, match="^path: expected the path of a file"):
                save(bad)
        with pytest.raises(ValueError, match="^path = .*: no file can have this name"):
            save("a\0b.html")
    with pytest.raises(ValueError, match="^size: height = 36: expected a whole number from 64"):
        sc.view(m).save("x.png", size=(64, 36))
