"""The command `flick`: typical input, the table of phases, files, and refusals."""

import csv
import json
import re

import numpy as np
import pytest
from test_cli import said, shell

import spincyl as sc

PVC = ["--outer", "15.875mm", "--bore", "12.7mm", "--length", "95.25mm"]
FLICK = ["flick", *PVC, "--mu", "0.3", "--precession", "17Hz", "--launch-number", "1.3"]
PIPE = ["flick", "--ell", "6", "--bore", "0.8", "--mu", "0.3"]


def rows(text):
    """The table: names of rows, and their cells."""
    found = (re.split(r" {2,}", line.strip()) for line in text.splitlines()[1:])
    return [(cells[0], cells[1:]) for cells in found]


def test_a_flick_says_its_launch_and_its_phases_in_natural_units_and_si(capsys):
    told = rows(said(capsys, *FLICK, "--mass", "20g").out)
    names = [name for name, _ in told]
    assert names[:2] == ["launch w1, w3", "launch number"] and names.index("slipping") < names.index(
        "rolling"
    )
    first = dict(reversed(told))
    tube = sc.Body.from_metres(outer_diameter=15.875e-3, inner_diameter=12.7e-3, length=95.25e-3)
    scale = sc.Scale(radius=7.9375e-3, mass=0.02)
    assert first["launch w1, w3"][1].startswith("17, 17.5")
    assert first["launch number"] == ["1.3"]
    start = sc.State(np.pi / 2, 17 / scale.turns(1.0), 0.0, 1.3 * 6 / (0.82 * 17 / scale.turns(1.0)))
    start = tube.with_centre_velocity(start, 0.0, -tube.i1 * start.w1 / 6)
    m = sc.roll(tube, start, 100.0, contact=sc.Coulomb(0.3))
    sticks = m.phases[1].time
    assert first["rolling"] == [f"from t = {sticks:.9g}", f"{scale.seconds(sticks):.6g} s"]
    assert first["slipping lasted"] == [f"{sticks:.9g}", f"{scale.seconds(sticks):.6g} s"]
    heat = (
        f"{float(m.dissipated[0]):.9g} M g R",
        f"{scale.joules(float(m.dissipated[0])):.6g} J, 57.4% of the energy",
    )
    assert tuple(first["heat of slipping"]) == heat
    assert first["still symbols"] == ["5.885 a turn"]
    speeds = [float(cells[1].split()[0]) for name, cells in told if name == "speed of the centre"]
    assert speeds[0] == pytest.approx(1.754, abs=1e-3) and speeds[1] < 0.05, "the centre comes to rest"


def test_launches_are_told_by_speeds_or_by_a_push(capsys):
    def launch(*words):
        return json.loads(said(capsys, *words, "--json").out)

    known = launch(*FLICK)
    w1, w3 = known["start"]["w1"], known["start"]["w3"]
    assert known["launch"] == {
        "number": pytest.approx(1.3),
        "rises": True,
        "centre": pytest.approx(-6.2854, abs=1e-4),
    }
    spun = launch(*FLICK[:-2], "--spin", repr(known["phases"][0]["spin_hertz"]))
    assert spun["start"]["w3"] == pytest.approx(w3, rel=1e-12)
    natural = launch(*PIPE, "--w1", repr(w1), "--launch-number", "1.3", "--t", "50")
    assert (
        natural["start"]["slip"] == pytest.approx(known["start"]["slip"])
        and "seconds" not in natural["phases"][0]
    )
    still = launch(*FLICK, "--centre", "0")
    assert still["phases"][0]["centre_speed"] < 2e-15 and still["slipping"] < known["slipping"]
    moving = launch(*FLICK, "--centre", "-0.5m/s")
    assert moving["phases"][0]["centre_speed_metres_per_second"] == pytest.approx(0.5, rel=1e-12)
    pushed = launch(*FLICK[:9], "--mass", "20g", "--impulse", "50mNs", "--angle", "60deg", "--table", "0")
    assert pushed["launch"]["number"] > 1
    tube = sc.Body.tube(6.0, bore=0.8)
    unit = 0.02 * np.sqrt(9.80665 * 7.9375e-3)
    pressed = sc.pressed(tube, 0.05 / unit, np.pi / 3, table=0.0)
    assert pushed["start"]["w1"] == pytest.approx(pressed.w1, rel=1e-9)
    more = launch(
        *FLICK[:9], "--mass", "20g", "--impulse", "50mNs", "--angle", "60deg", "--table", "0", "--finger", "1"
    )
    assert more["start"]["w3"] > pushed["start"]["w3"]


def test_phases_of_a_flick_are_numbers_for_json(capsys):
    found = json.loads(said(capsys, *FLICK, "--json").out)
    assert [phase["kind"] for phase in found["phases"]] == ["slipping", "rolling"]
    assert found["phases"][1]["slip_speed"] == 0 and found["phases"][1]["seconds"] > 0.5
    assert found["slipping"] == found["phases"][1]["time"] and found["contact"] == "Coulomb(0.3)"
    assert found["dissipated"] > 10 and "swing" not in found


@pytest.mark.parametrize(
    "lasting", [["--seconds", "1"], ["--seconds", "1s"], ["--t", "1s"], ["--t", "35.1494"]]
)
def test_a_flick_lasts_as_long_as_it_is_told(capsys, tmp_path, lasting):
    path = tmp_path / "flick.csv"
    said(capsys, *FLICK, *lasting, "--points", "11", "-o", path)
    with path.open() as file:
        table = list(csv.DictReader(file))
    assert len(table) == 11 and float(table[-1]["seconds"]) == pytest.approx(1.0, abs=1e-4)
    assert {"slip_along", "slip_across", "dissipated", "phase", "normal"} <= set(table[0])
    assert [float(row["phase"]) for row in table] == [1.0] * 9 + [0.0] * 2
    total = [float(row["energy"]) + float(row["dissipated"]) for row in table]
    assert np.ptp(total) < 1e-10 * total[0]


def test_a_flick_is_written_in_every_way_that_a_motion_is(capsys, tmp_path):
    for suffix in (".npz", ".nc", ".png", ".html", ".glb"):
        path = tmp_path / f"flick{suffix}"
        said(capsys, *FLICK, "--seconds", "1", "-o", path)
        assert path.stat().st_size > 1000, suffix
    with np.load(tmp_path / "flick.npz") as found:
        assert str(found["contact"]) == "Coulomb(0.3)" and found["slip_across"].shape == found["t"].shape
    page = (tmp_path / "flick.html").read_text("utf-8")
    assert '"phases":[[0.0,1],[' in page and '"speeds":"mm/s"' in page


def test_a_flicked_tube_that_loses_energy_sinks_back_to_its_side_and_its_account_is_kept(capsys, tmp_path):
    lossy = [*FLICK, "--loss", "rolling-resistance=0.1mm", "--loss", "drilling=0.05mm"]
    found = json.loads(said(capsys, *lossy, "--json").out)
    assert found["event"]["ending"] == "SIDE"
    assert [phase["kind"] for phase in found["phases"]] == ["slipping", "rolling"]
    tube = sc.measured(outer_diameter=15.875e-3, inner_diameter=12.7e-3, length=95.25e-3)
    start = sc.State(**{name: found["start"][name] for name in ("theta", "w1", "w2", "w3")})
    start = tube.natural.with_centre_velocity(start, 0.0, found["launch"]["centre"])
    losses = sc.loss.RollingResistance(1e-4 / 7.9375e-3) + sc.loss.Drilling(5e-5 / 7.9375e-3)
    m = sc.roll(tube.natural, start, 100.0, contact=sc.Coulomb(0.3), losses=losses)
    assert found["event"]["time"] == pytest.approx(m.event.time, abs=1e-9)
    before, after = tube.natural.energy(start), tube.natural.energy(m.event.state)
    assert before - after == pytest.approx(found["dissipated"] + found["work_lost"], rel=1e-11)
    assert found["work_lost"] > 1
    # as text
    told = dict(rows(said(capsys, *lossy).out))
    assert told["losses"] == [f"{losses!r}"] and told["energy lost"][0].endswith("M g R") and "side" in told
    page = tmp_path / "flick.html"
    said(capsys, *lossy, "-o", str(page))
    assert "RollingResistance(0.0126) + Drilling(0.006299)" in page.read_text(encoding="utf-8")
    # without losses the motion does not end
    assert json.loads(said(capsys, *FLICK, "--json").out)["event"] is None


def test_a_tube_that_is_flicked_too_gently_stays_on_its_side_and_it_is_said(capsys, tmp_path):
    out = said(capsys, *FLICK[:-1], "0.9").out
    assert "at most 1: the end does not rise" in out and "the body lies on its side at t = 0" in out
    err = said(capsys, *FLICK[:-1], "0.9", "-o", tmp_path / "flick.html", status=2).err
    assert err.startswith(
        "spincyl flick: launch number 0.9: the motion ends at once and is not written; the other rim does not rise"
    )
    assert not (tmp_path / "flick.html").exists()


@pytest.mark.parametrize(
    ("words", "match"),
    [
        ([*PIPE, "--w1", "3"], "give exactly one of --launch-number and --spin"),
        ([*PIPE, "--launch-number", "1.3"], "give exactly one of --precession and --w1; or give --impulse"),
        ([*FLICK, "--w1", "3"], "give exactly one of --precession and --w1"),
        ([*FLICK, "--spin", "3Hz"], "give exactly one of --launch-number and --spin"),
        ([*PIPE, "--precession", "17Hz", "--launch-number", "1.3"], "--precession needs --radius"),
        ([*PIPE, "--w1", "3", "--spin", "17Hz"], "--spin needs --radius"),
        ([*PIPE, "--w1", "0", "--launch-number", "1.3"], "--launch-number needs a precession other than zero"),
        ([*PIPE, "--w1", "3", "--launch-number", "1.3", "--centre", "1m/s"], "--centre in m/s needs --radius"),
        ([*PIPE, "--w1", "3", "--launch-number", "1.3", "--seconds", "3"], "--seconds 3s needs --radius"),
        ([*FLICK, "--impulse", "3", "--angle", "45deg"], "--precession cannot be combined with --impulse"),
        ([*FLICK, "--angle", "45deg"], "--angle needs --impulse"),
        ([*PIPE, "--impulse", "8"], "--impulse needs --angle"),
        ([*PIPE, "--impulse", "40mNs", "--angle", "1"], "--impulse in newton seconds needs --mass and --radius"),
        ([*PIPE[:-1], "-0.3", "--w1", "3", "--launch-number", "1.3"], "mu = -0.3: expected 0 <= mu"),
        ([*FLICK, "--static", "0.2"], "static = 0.2: expected at least mu = 0.3"),
        ([*FLICK, "--restitution", "1.5"], "restitution = 1.5: expected None"),
        ([*FLICK, "--tol", "0"], "tol = 0.0: expected 1e-14 <= tol <= 0.1"),
        ([*FLICK, "--points", "1"], "--points 1: expected at least 2"),
        ([*FLICK, "--inner", "1mm"], "give only one of --inner, --bore and --wall"),
        ([*PIPE, "--bore", "12.7mm", "--w1", "3", "--launch-number", "1"], "--bore 0.0127m needs --outer and --length"),
        (["flick", "--ell", "0", "--mu", "0.3", "--w1", "3", "--launch-number", "1"], "needs a body with two rims"),
    ],
)  # fmt: skip
def test_a_flick_that_makes_no_sense_is_refused_by_name(capsys, words, match):
    err = said(capsys, *words, status=2).err
    assert err.startswith("spincyl flick: ") and match in err


def test_an_inner_diameter_is_typed_as_a_bore_too(capsys):
    (one, other) = (
        said(capsys, "steady", "--outer", "16mm", word, "12mm", "--length", "95mm", "--theta", "80deg").out
        for word in ("--inner", "--bore")
    )
    assert one == other and "inner_diameter=0.012" in one


def test_a_flick_goes_through_a_pipe():
    line = f"spincyl {' '.join(FLICK)} --points 5 -o -"
    done = shell(line)
    assert done.returncode == 0 and done.stdout.splitlines()[0].endswith(
        "slip_along,slip_across,dissipated,phase"
    )
    assert len(done.stdout.splitlines()) == 6 and "slipping lasted" in done.stderr


HOOP = "roll --ell 0 --bore 1 --theta 90deg --w3 -3 --slip 0 5 --t 20".split()


def test_a_hoop_is_thrown_with_backspin_by_roll(capsys):
    told = dict(rows(said(capsys, *HOOP, "--contact", "coulomb", "--mu", "0.25").out))
    assert told["rolling"] == ["from t = 10"] and told["slipping lasted"] == ["10"]
    assert told["heat of slipping"] == ["6.25 M g R", "83.3% of the energy"]
    wet = dict(rows(said(capsys, *HOOP, "--contact", "viscous", "--viscosity", "0.25").out))
    assert "rolling" not in wet and wet["slipping lasted"] == ["20"]
    held = json.loads(
        said(capsys, *HOOP[:-5], *HOOP[-2:], "--contact", "coulomb", "--mu", "0.25", "--json").out
    )
    assert [phase["kind"] for phase in held["phases"]] == ["rolling"] and held["slipping"] == 0


@pytest.mark.parametrize(
    ("words", "match"),
    [
        ([], "state: the body slips, slip = (0.0, 5.0): contact='rolling' has no law of friction"),
        (
            ["--contact", "smooth"],
            "state: the body slips, slip = (0.0, 5.0): contact='smooth' has no law of friction",
        ),
        (["--contact", "coulomb"], "--contact coulomb needs --mu"),
        (["--contact", "viscous"], "--contact viscous needs --viscosity"),
        (["--contact", "viscous", "--viscosity", "-1"], "--viscosity -1.0: expected 0 <= c"),
        (
            ["--contact", "viscous", "--viscosity", "1", "--mu", "0.3"],
            "mu = 0.3 cannot be combined with contact=Viscous",
        ),
        (["--contact", "coulomb", "--mu", "nan"], "mu = nan: expected 0 <= mu"),
        (
            ["--contact", "coulomb", "--mu", "0.3", "--step", "0.1"],
            "step = 0.1 cannot be combined with contact=Coulomb",
        ),
        (
            ["--contact", "coulomb", "--mu", "0.3", "--beyond"],
            "beyond = True cannot be combined with contact=Coulomb",
        ),
        (["--contact", "rolling", "--static", "0.3"], "--static needs --contact coulomb"),
        (
            ["--contact", "coulomb", "--mu", "0.3", "--viscosity", "1"],
            "--viscosity needs --contact viscous",
        ),
    ],
)
def test_a_contact_of_roll_that_lacks_its_law_is_refused_by_name(capsys, words, match):
    err = said(capsys, *HOOP, *words, status=2).err
    assert err.startswith("spincyl roll: ") and match in err
