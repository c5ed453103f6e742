"""The command line as people type it: units, powers of ten, pipes, JSON."""

import csv
import io
import json
import os
import re
import shlex
import subprocess
import sys

import numpy as np
import nutating_cylinder
import pytest

import spincyl as sc
from spincyl import cli
from spincyl._input.units import join_units

ROLL = ["roll", "--ell", "2.5", "--theta", "1.3", "--kick", "0.05"]
PVC = ["--outer", "15.875mm", "--inner", "12.7mm", "--length", "95.25mm"]


def said(capsys, *words, status=0):
    assert cli.main([str(x) for x in words]) == status
    return capsys.readouterr()


def refused(capsys, *words):
    """The error message for words that cannot be parsed."""
    with pytest.raises(SystemExit) as ended:
        cli.main([str(x) for x in words])
    assert ended.value.code == 2
    return capsys.readouterr().err


def shell(line, **how):
    spincyl = shlex.join([sys.executable, "-m", "spincyl"])
    bash = ["bash", "-o", "pipefail", "-c", f'spincyl() {{ {spincyl} "$@"; }}; {line}']
    return subprocess.run(bash, capture_output=True, text=True, check=False, **how)


# input


@pytest.mark.parametrize(
    "words", ["85deg", "85 deg", "85°", "85 °", "'85 deg'", "85degrees", "1.4835298641951802rad"]
)
def test_degrees_are_understood_with_and_without_a_space(capsys, words):
    out = said(capsys, "steady", "--ell", "6", "--bore", "0.8", "--theta", *shlex.split(words)).out
    assert "theta = 85 deg" in out and "5.89 a turn" in out


def test_several_angles_with_units_are_several(capsys):
    out = said(capsys, "steady", "--ell", "2.5", "--theta", "85", "deg", "1.3", "80°", "70deg").out
    assert re.findall(r"^theta = (\S+) deg", out, re.M) == ["85", "74.4845", "80", "70"]


@pytest.mark.parametrize("number", ["85", "5", "3.2", "-85", "8.5e1"])
def test_a_bare_number_that_can_only_be_degrees_is_told_how_to_say_so(capsys, number):
    for command in (["steady"], ["roll", "--t", "5"]):
        err = refused(capsys, *command, "--ell", "2.5", "--theta", number)
        assert f"for degrees write {number}deg" in err
    assert "expected 0 < theta <= pi/2" in said(capsys, "steady", "--ell", "1", "--theta", "3", status=2).err


def test_millimetres_taken_for_metres_are_told(capsys):
    found = said(capsys, "steady", "--outer", "15.9", "--inner", "12.7", "--length", "95", "--hertz", "1")
    assert "are these metres" in found.err
    assert not said(capsys, "steady", *PVC, "--hertz", "8").err


def test_measures_have_units_and_give_the_numbers_that_metres_give(capsys):
    expected = said(
        capsys, "steady", "--outer", "0.015875", "--inner", "0.0127", "--length", "0.09525", "--hertz", "20"
    )
    assert "outer_diameter=0.015875, inner_diameter=0.0127, length=0.09525" in expected.out
    for words in (
        "15.875mm 12.7mm 95.25mm 20Hz",
        "1.5875cm 1.27cm 9.525cm 20",
        "0.625in 0.5in 3.75in 20",
        "15875um 12700µm 95250μm 20",
    ):
        outer, inner, length, hertz = words.split()
        assert (
            said(capsys, "steady", "--outer", outer, "--inner", inner, "--length", length, "--hertz", hertz)
            == expected
        )
    assert (
        said(capsys, *"steady --outer 15.875 mm --inner 12.7 mm --length 95.25 mm --hertz 20".split())
        == expected
    )
    heavy = said(capsys, *"steady --ell 1 --radius 16mm --mass 20g --gravity 1.62m/s2 --theta 80deg".split())
    assert heavy == said(
        capsys, *"steady --ell 1 --radius 0.016 --mass 0.02 --gravity 1.62 --theta 80deg".split()
    )


@pytest.mark.parametrize(
    "words",
    [
        "--radius 16kg",
        "--mass 2mm",
        "--radius 1e",
        "--radius mm",
        "--hertz 3s",
        "--theta 3mm",
        "--radius nan",
    ],
)
def test_a_unit_of_something_else_is_refused(capsys, words):
    assert words.split()[1] in refused(capsys, "steady", "--ell", "1", *words.split())


def test_a_time_in_seconds_needs_the_size_of_the_body(capsys):
    scale = sc.Scale(0.016)
    found = said(capsys, *ROLL, "--t", "2s", "--radius", "16mm", "--points", "5", "-o", "-").out
    seconds = [float(row["seconds"]) for row in csv.DictReader(io.StringIO(found))]
    assert seconds == pytest.approx([0, 0.5, 1, 1.5, 2], rel=1e-15)
    natural = said(
        capsys, *ROLL, "--t", repr(float(2 / scale.seconds(1.0))), *"--radius 16mm --points 5 -o -".split()
    ).out
    assert natural == found
    assert said(capsys, "roll", *PVC, "--theta", "85°", "--t", "2000", "ms").out.count("how ") == 1
    for time in (["--t", "2s"], ["--t", "20", "--step", "1 ms"]):
        assert "s needs --radius" in said(capsys, *ROLL, *time, status=2).err


def test_powers_of_ten_are_whole_numbers_and_may_be_negative(capsys):
    out = said(capsys, *ROLL, "--t", "20", "--points", "1e3", "-o", "-").out
    assert len(out.splitlines()) == 1001
    kicked = said(capsys, "roll", "--ell", "2.5", "--theta", "1.3", "--t", "20", "--kick", "-5e-2").out
    assert (
        kicked == said(capsys, "roll", "--ell", "2.5", "--theta", "1.3", "--t", "20", "--kick", "-0.05").out
    )
    for points in ("1.5", "1e", "many", "1e400", "20s"):
        assert points in refused(capsys, *ROLL, "--t", "20", "--points", points)
    assert (
        join_units(["--rate", "1", "2", "s", "-o", "-", "--kick", "-1e-3", "-1"])
        == "--rate 1 2s -o - --kick=-1e-3 -1".split()
    )


# output


def test_nothing_is_counted_where_nothing_turns(capsys):
    out = said(capsys, "steady", "--ell", "2.5", "--rate", "0", "--radius", "0.01").out
    assert "nan" not in out and "contact circle         none: the body does not turn" in out
    assert "symbols" not in out and "to the axis" not in out
    assert (
        json.loads(said(capsys, "steady", "--ell", "2.5", "--rate", "0", "--json").out)["states"][0][
            "contact_radius"
        ]
        is None
    )


def test_a_motion_that_never_swings_back_has_no_period(capsys):
    falls = ["roll", "--ell", "1", "--theta", "0.3", "--w1", "0", "--t", "5"]
    out = said(capsys, *falls).out
    assert "nan" not in out and "inf" not in out and "period                 none" in out
    told = json.loads(said(capsys, *falls, "--json").out)
    assert told["swing"]["period"] is None and told["event"]["ending"] == told["status"] == "FACE"
    assert told["event"]["time"] == pytest.approx(1.469954311914, rel=1e-12)


def test_json_has_the_numbers_of_the_library(capsys):
    body, scale = sc.Body.tube(6.0, 0.8), sc.Scale(7.9375e-3)
    told = json.loads(
        said(capsys, *"steady --ell 6 --bore 0.8 --radius 7.9375mm --theta 85deg --rate 2 --json".split()).out
    )
    state = body.steady(np.radians(85))
    first, *others = told["states"]
    assert first["w3"] == state.w3 and first["contact_radius"] == state.contact_radius
    assert first["kappa_smooth"] == body.stability(state, "smooth")
    assert first["precession_hertz"] == scale.turns(state.precession) and "energy_joules" not in first
    assert [x["theta"] for x in others] == [x for x in body.inclinations(2.0) if x == x]
    assert told["rates"] == [{"rate": 2.0, "inclinations": len(others)}]
    assert told["body"]["call"] == "Body.tube(6.0, bore=0.8)" and told["body"][
        "critical_hertz"
    ] == scale.hertz(body, 1.0)
    weighed = said(
        capsys, "steady", "--ell", "1", "--radius", "1", "--mass", "2", "--theta", "1.2", "--json"
    ).out
    assert json.loads(weighed)["states"][0]["energy_joules"] == pytest.approx(
        2 * 9.80665 * sc.Body.solid(1).energy(sc.Body.solid(1).steady(1.2))
    )


def test_a_motion_goes_to_standard_output_as_csv_or_json_and_words_go_elsewhere(capsys):
    m = sc.roll(
        nutating_cylinder.body, nutating_cylinder.start, np.linspace(0, 20, 11), want=("pose", "force")
    )
    found = said(capsys, *ROLL, "--t", "20", "--points", "11", "-o", "-")
    rows = list(csv.DictReader(io.StringIO(found.out)))
    assert [float(row["theta"]) for row in rows] == m.theta.tolist() and "turning points" in found.err
    found = said(capsys, *ROLL, "--t", "20", "--points", "11", "-o", "-", "--json")
    told = json.loads(found.out)
    assert told["columns"]["psi"] == m.psi.tolist() and told["message"] == m.message and found.err == ""
    assert "columns" not in json.loads(said(capsys, *ROLL, "--t", "20", "--json").out)


def test_the_map_goes_to_standard_output(capsys):
    rows = list(csv.DictReader(io.StringIO(said(capsys, "portrait", "--points", "5", "-o", "-").out)))
    assert len(rows) == 25 and float(rows[3]["ell"]) == 1.5
    for row in rows:
        body, theta = sc.Body.solid(float(row["ell"])), float(row["theta"])
        assert int(float(row["region"])) == body.region(theta)
        assert np.array_equal(float(row["rate"]), body.rate(theta), equal_nan=True)
    told = json.loads(said(capsys, "portrait", "--points", "5", "-o", "-", "--json").out)
    assert np.array(told["columns"]["region"]).ravel().tolist() == [int(float(row["region"])) for row in rows]


@pytest.mark.parametrize(
    "line",
    [
        "spincyl roll --ell 2.5 --theta 1.3 --t 20 --points 1e5 -o - | head -n 2",
        "spincyl roll --help | true",
    ],
)
def test_a_reader_that_stops_early_is_no_error(line):
    ended = shell(line)
    assert ended.returncode == 0
    assert not re.search("Error|Exception|Traceback|Broken", ended.stderr)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no device that is always full")
def test_a_full_disk_behind_standard_output_is_a_failure_with_one_line():
    ended = shell("spincyl steady --ell 2.5 --rate 1 > /dev/full")
    assert ended.returncode == 1 and ended.stderr.strip().endswith("No space left on device")
    assert len(ended.stderr.splitlines()) == 1


# rounded rims and balls


@pytest.mark.parametrize(
    ("words", "hertz"),
    [("--outer 16mm", "8.8106"), ("--radius 8mm", "8.8106"), ("--outer 16mm --gravity 1.62", "3.58")],
)
def test_one_of_two_balls_lifts_at_a_rate_that_their_size_and_gravity_set(capsys, words, hertz):
    out = said(capsys, "steady", "--balls", "--theta", "90deg", *words.split()).out
    found = re.search(r"precession phi' +1.58113883 +(\S+) turns/s", out)
    assert found and found[1].startswith(hertz)
    assert re.search(r"theta0 \(balanced\) +none", out) and "1 a turn" in out


def test_two_balls_on_a_rod_and_a_ball_with_its_centre_of_mass_aside_are_those_of_the_library(capsys):
    for words, body in (
        ("--balls", sc.Body.balls()),
        ("--balls 1.5", sc.Body.balls(1.5)),
        ("--ball -0.3 --i1 0.4 --i3 0.4", sc.Body.ball(-0.3, 0.4, 0.4)),
        (
            "--ball -.3 --i1 0.4 --i3 0.4 --theta-end 100deg",
            sc.Body(-0.3, 0.4, 0.4, fillet=1.0, theta_end=np.radians(100)),
        ),
        ("--ell 1 --theta-end 100deg", sc.Body(1.0, 7 / 12, 0.5, bore=0.0, theta_end=np.radians(100))),
        ("--ell 1 --bore 0.5 --fillet 0.1", sc.Body.tube(1.0, 0.5, 0.1)),
        ("--ell 1 --i1 0.7 --i3 0.5 --fillet 0.1", sc.Body(1.0, 0.7, 0.5, fillet=0.1)),
    ):
        told = json.loads(said(capsys, "steady", *words.split(), "--theta", "85deg", "--json").out)
        assert told["body"]["call"] == repr(body), words
        kappa = body.stability(body.steady(85 * (np.pi / 180)))
        assert told["states"][0]["kappa_rolling"] == kappa, words


def test_a_fillet_is_a_length_or_a_part_of_the_outer_radius(capsys):
    euler = ["steady", "--outer", "75.1mm", "--length", "13mm", "--theta", "5deg", "--json", "--fillet"]
    in_metres = json.loads(said(capsys, *euler, "2mm").out)
    assert "fillet=0.002)" in in_metres["body"]["call"]
    in_radii = json.loads(said(capsys, *euler, 2 / 37.55).out)
    assert in_radii["body"]["fillet"] == pytest.approx(in_metres["body"]["fillet"], rel=1e-15)
    assert in_metres["states"][0]["rate"] == pytest.approx(in_radii["states"][0]["rate"], rel=1e-14)


def test_the_contact_circle_of_a_rounded_rim_is_smaller_than_its_still_symbols_say(capsys):
    (state,) = json.loads(said(capsys, "steady", "--balls", "--theta", "80deg", "--json").out)["states"]
    assert state["still_symbols"] == pytest.approx(1, rel=1e-15)
    body = sc.Body.balls()
    times = np.linspace(0, 2 * np.pi / state["precession"], 2001)  # one turn about the vertical
    turn = sc.roll(body, body.steady(np.radians(80)), times, want="pose")
    assert state["contact_radius"] == pytest.approx(np.ptp(turn.contact_point[..., 0]) / 2, rel=1e-4)


def test_two_balls_roll_and_the_map_of_rounded_tubes_begins_where_they_are_as_long_as_round(capsys):
    rows = said(capsys, "roll", "--balls", "--theta", "80deg", "--t", "5", "--points", "3", "-o", "-").out
    assert len(rows.splitlines()) == 4
    told = json.loads(said(capsys, "portrait", "--fillet", "0.25", "--points", "3", "--json", "-o", "-").out)
    columns = told["columns"]
    assert told["fillet"] == 0.25 and columns["ell"][0] == 0.25
    assert columns["rate"][2][2] == sc.Body.solid(2.0, fillet=0.25).rate(np.pi / 2)


@pytest.mark.parametrize(
    ("words", "said_of_it"),
    [
        ("--ell 1 --fillet 2", "--fillet 2.0: expected 0 <= fillet"),
        ("--ell 1 --fillet 2mm", "--fillet 0.002m needs --outer and --length"),
        ("--outer 75.1mm --length 13mm --fillet 8mm", "--fillet 0.213"),
        ("--balls 0.5", "--balls 0.5: expected 1 <= separation"),
        ("--balls --ell 1", "--ell cannot be combined with --balls"),
        ("--balls --ball 1", "--ball cannot be combined with --balls"),
        ("--balls --outer 16mm --length 3mm", "--length cannot be combined with --balls"),
        ("--balls --fillet 0.5", "--fillet cannot be combined with --balls"),
        ("--balls --outer 16mm --radius 8mm", "not both"),
        ("--ball -2 --i1 0.4 --i3 0.4", "--ball -2.0: expected -1 < offset"),
        ("--ball -0.2 --i1 0.4", "--ball needs both --i1 and --i3"),
        ("--ball -0.2 --i1 0.4 --i3 0.4 --bore 0", "--bore cannot be combined with --ball"),
        ("--ell 1 --theta-end 3.2rad", "--theta-end 3.2: expected"),
    ],
)
def test_what_is_no_rounded_body_is_refused_and_the_option_named(capsys, words, said_of_it):
    err = said(capsys, "steady", *words.split(), status=2).err
    assert said_of_it in err and err.startswith("spincyl steady: ")
    assert err.count("\n") == 1
