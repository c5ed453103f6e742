"""Errors of the core about a measured body speak of seconds, or name the unit of their numbers."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

import spincyl as sc
from spincyl._measured import errors_in_seconds
from spincyl.cli import main

TUBE = sc.measured(outer_diameter=15.875e-3, inner_diameter=12.7e-3, length=95.25e-3, mass=20e-3)
STONE = sc.Ellipsoid.rattleback((0.12, 0.06, 0.03), twist=0.35).in_metres(0.5)
SECOND = float(TUBE.scale.seconds(1.0))
ERRORS = (Path(__file__).parents[1] / "src" / "error.rs").read_text("utf-8")
#: Messages of the core about a time or a step, with the names of their numbers.
TEXTS = [
    re.sub(r"\\\n\s*", "", text)
    for text in re.findall(r'#\[error\(\s*"((?:[^"\\]|\\.)*)"', ERRORS, re.DOTALL)
    if re.search(r"\{(time|step)[:}]", text)
]


def spoken(said, scale=TUBE.scale):
    with pytest.raises(ValueError) as caught, errors_in_seconds(scale):
        raise ValueError(said)
    return str(caught.value)


def test_the_core_has_errors_with_a_time():
    assert len(TEXTS) >= 2


@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize("value", ["26.44237250324074", "3.2682417e-7", "-12.5", "1e-5"])
def test_every_time_in_an_error_of_the_core_is_told_in_seconds(text, value):
    said = re.sub(r"\{(time|step|advice)(:[^}]*)?\}", value, text)
    said = re.sub(r"\{\w+(:[^}]*)?\}", "0.25", said)
    steps = re.findall(r"\bstep of (\S+) s\b", spoken(said))
    assert all(
        0.98 * float(value) * SECOND <= float(x) <= float(value) * SECOND for x in steps if "-1" not in value
    )
    told = re.findall(r"(?:\bt = |\bstep = )(\S+) s\b", spoken(said))
    assert len(told) == len(re.findall(r"\{(?:time|step)[:}]", text))
    assert np.allclose([float(x) for x in told], float(value) * SECOND, rtol=1e-11, atol=0)
    assert re.sub(r"(t|step) = \S+ s|step of \S+ s", "", spoken(said)) == re.sub(
        rf"(t|step) = {re.escape(value)}|step of {re.escape(value)}", "", said
    ), "all else is as it was"
    assert spoken(said, None) == said


def test_a_time_that_is_out_of_range_is_told_in_seconds():
    for call, told in (
        (lambda: sc.roll(TUBE, TUBE.steady(1.4), [0.0, 2.0, 1.0]), "t = 1 s: expected"),
        (lambda: sc.roll(TUBE, TUBE.steady(1.4), 1.0, step=-1e-3), "step = -0.001 s: expected"),
    ):
        with pytest.raises(ValueError, match=told):
            call()


def test_a_range_is_that_of_natural_units_and_says_so():
    for call, said in (
        (lambda: sc.roll(TUBE, TUBE.steady(1.4), 1e20), "t = .*: expected"),
        (lambda: sc.roll(TUBE, TUBE.steady(1.4), 1.0, t0=1e20), "t0 = .*: expected"),
        (lambda: sc.roll(TUBE, TUBE.steady(1.4), 1.0, step=0.0), "step = .*: expected"),
        (lambda: sc.roll(TUBE, sc.State(1.0, 1e9, 0.0, 0.0), 1.0), "w1 = .*: expected"),
        (lambda: sc.roll(TUBE, TUBE.steady(1.4), 0.1).at(1e20), "t = .*: expected"),
        (lambda: sc.sweep.roll(TUBE, TUBE.steady(1.4), 1e20), "t = .*: expected"),
        (lambda: sc.sweep.roll(TUBE, TUBE.steady(1.4), 1.0, step=0.0), "step = .*: expected"),
        (lambda: sc.roll(STONE, STONE.spinning(1.0, pitch=0.1), 1e20), "t = .*: expected"),
    ):
        with pytest.raises(
            ValueError,
            match=rf"^{said} .* \((?:limits in )?natural units: sqrt\([Ra]/g\) is \S+ s for this body\)$",
        ):
            call()


def test_a_step_that_is_advised_in_seconds_would_do():
    start = TUBE.steady(1.4).kicked(0.05)
    with pytest.raises(ValueError, match=r"^step = 0\.05 s is too large at t = \S+ s") as caught:
        sc.roll(TUBE, start, 0.1, step=0.05)
    advice = float(re.search(r"use a step of (\S+) s, or tol=", str(caught.value))[1])
    assert sc.roll(TUBE, start, 0.1, step=advice).success


@pytest.mark.parametrize("of", ["roll", "at", "wanting", "a stone"])
def test_it_is_so_wherever_the_core_is_asked(of, monkeypatch):
    m = sc.roll(TUBE, TUBE.steady(1.4), 0.1)
    asked = {
        "roll": lambda: sc.roll(TUBE, TUBE.steady(1.4), 0.1),
        "at": lambda: m.at([0.0, 0.05]),
        "wanting": lambda: m.wanting("pose"),
        "a stone": lambda: sc.roll(STONE, STONE.spinning(1.0, pitch=0.1), 0.1),
    }[of]

    class Refuses:
        def roll(self, *_):
            raise ValueError(
                "too many phases: 7412 (slipping, rolling, ...) up to t = 2.5: give only times before that"
            )

    monkeypatch.setattr("spincyl._motion._core", Refuses())
    monkeypatch.setattr("spincyl._ellipsoid_motion._core", Refuses())
    second = float((STONE if of == "a stone" else TUBE).scale.seconds(1.0))
    with pytest.raises(ValueError, match=rf"up to t = {2.5 * second:.12g} s: give only times before that$"):
        asked()


def test_on_the_command_line_it_is_told_as_the_time_was_given(capsys):
    words = ["roll", "--outer", "16mm", "--length", "95mm", "--theta", "1.4", "--kick", "0.3"]
    assert main([*words, "--t", "0.1s", "--step", "20ms"]) == 2
    assert re.search(
        r"step = 0\.02 s is too large at t = \S+ s, .* use a step of \S+ s, or tol=", capsys.readouterr().err
    )
    assert main([*words, "--t", "4", "--step", "0.7"]) == 2
    assert re.search(
        r"step = 0\.7 is too large at t = \S+, .* use a step of \S+, or tol=", capsys.readouterr().err
    )


def test_a_message_has_the_digits_of_a_time_that_its_error_leaves():
    can, dropped = sc.Body.solid(1.0), sc.State(0.3, 0.0, 0.0, 0.0)
    for how in ({}, {"tol": 1e-6}, {"tol": 1e-3, "contact": sc.Coulomb(0.3)}):
        m = sc.roll(can, dropped, 5.0, **how)
        told = re.search(r"at t = ([0-9.]+)", m.message)[1]
        shown = len(told.replace(".", "").lstrip("0"))
        assert shown <= max(2, min(12, 2 + math.log10(m.event.time / m.error))), (how, m.message)
        assert abs(float(told) - m.event.time) <= max(m.error, 1e-11)
