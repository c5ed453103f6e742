"""The commands `drift` and `roll --loss`: typical input, the table, files, and refusals."""

import csv
import io
import json
import re

import numpy as np
import pytest
from test_cli import said

import spincyl as sc
from spincyl import cli, loss
from spincyl.cli._losses import _NAMES, law

DISK = sc.Body.solid(0.0852)
EULER = ["--outer", "75mm", "--length", "6.39mm", "--mass", "440g"]
SIZE = sc.Scale(radius=0.0375, mass=0.44)
DRIFT = ["drift", "--ell", "0.0852", "--theta", "0.3", "--law", "viscous-contour=5e-3"]


def table(text):
    """The rows of the drift, below the blank line, as numbers."""
    lines = text.split("\n\n", 1)[1].splitlines()
    heads, rows = lines[0], [line for line in lines[1:] if line.startswith("  ")]
    return heads, np.array([[float(x) for x in row.split()] for row in rows])


# Laws on the command line.


def test_every_law_can_be_typed():
    kinds = [getattr(loss, name) for name in loss.__all__ if name not in ("Law", "Loss", "Sum")]
    assert {*kinds} == {loss.KINDS[coefficient] for coefficient in _NAMES.values()}
    for name, coefficient in _NAMES.items():
        assert law(f"{name}=1e-3")[1:] == (coefficient, 1e-3, False)


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("dry-contour=5e-3", loss.DryContour(5e-3)),
        ("dry-contour=0.2mm", loss.DryContour.from_si(0.2e-3, scale=SIZE)),
        ("rolling-resistance=0.02cm", loss.RollingResistance.from_si(0.2e-3, scale=SIZE)),
        ("drilling=100um", loss.Drilling.from_si(1e-4, scale=SIZE)),
        ("viscous-contour=1e-6Nms", loss.ViscousContour.from_si(1e-6, scale=SIZE)),
        ("air-linear=1e-6Nms", loss.AirLinear.from_si(1e-6, scale=SIZE)),
        ("air-quadratic=1e-7Nms2", loss.AirQuadratic.from_si(1e-7, scale=SIZE)),
        ("air-film=18uPas", loss.AirFilm.from_si(scale=SIZE)),
        ("boundary-layer=0.1C", loss.BoundaryLayer.from_si(0.1, scale=SIZE)),
    ],
)
def test_a_motion_with_a_typed_law_is_that_of_the_library(typed, meant, capsys):
    told = said(
        capsys, "roll", *EULER, "--theta", "0.3", "--t", "5", "--points", "6", "--loss", typed, "--json"
    )
    told = json.loads(told.out)
    body = sc.Body.from_metres(outer_diameter=0.075, length=6.39e-3)
    m = sc.roll(body, body.steady(0.3), np.linspace(0, 5, 6), losses=meant, want=("pose", "force"))
    assert told["work_lost"] == pytest.approx(m.work_lost[-1], rel=1e-12)
    assert told["losses"] == repr(meant) and "swing" not in told


def test_laws_that_are_typed_together_add(capsys):
    both = ["--loss", "dry-contour=5e-3", "--loss", "air-film=1e-6"]
    told = json.loads(
        said(capsys, "roll", "--ell", "0.0852", "--theta", "0.3", "--t", "5", *both, "--json").out
    )
    assert told["losses"] == "DryContour(0.005) + AirFilm(1e-06)"


def test_roll_says_what_is_lost_and_writes_it(capsys, tmp_path):
    file = tmp_path / "whirr.csv"
    asked = ["roll", *EULER, *"--theta 0.3 --t 400 --loss dry-contour=5e-3 -o".split(), str(file)]
    out = said(capsys, *asked).out
    m = sc.roll(DISK, DISK.steady(0.3), np.linspace(0, 400, 2001), losses=loss.DryContour(5e-3))
    assert "losses                 DryContour(0.005)" in out and "turning points" not in out
    # up to the end, which lies between two times
    lost = m.energy[0] - DISK.energy(m.event.state)
    assert lost > m.work_lost[-1] + 1e-3
    assert f"energy lost            {lost:.9g} M g R" in out and " J, " in out
    assert f"the face landed on the table: the body lies flat at t = {m.event.time:.12g}" in out
    assert m.event.time == pytest.approx(17.2746, abs=1e-4)
    with file.open() as rows:
        found = list(csv.DictReader(rows))
    assert len(found) == m.t.size
    whole = [float(row["energy"]) + float(row["work_lost"]) for row in found]
    assert np.ptp(whole) < 1e-12


@pytest.mark.parametrize(
    ("typed", "contact"),
    [
        ((), "rolling"),
        (("--contact", "smooth"), "smooth"),
        (("--contact", "coulomb", "--mu", "0.5"), sc.Coulomb(0.5)),
    ],
)
def test_what_a_body_loses_that_is_let_go_is_told_up_to_where_its_face_lands(typed, contact, capsys):
    words = ["roll", "--ell", "1", "--theta", "0.3", "--w1", "0", "--t", "50", *typed]
    words += ["--loss", "air-linear=0.1", "--json"]
    lost = [json.loads(said(capsys, *words, "--points", points).out)["work_lost"] for points in ("2", "2001")]
    body = sc.Body.solid(1.0)
    start = sc.State(0.3, 0.0, 0.0, 0.0)
    m = sc.roll(body, start, [0.0, 50.0], losses=loss.AirLinear(0.1), contact=contact)
    after = body.energy(m.event.state, "smooth" if contact == "smooth" else "rolling")
    assert m.event.ending == sc.Ending.FACE and lost == pytest.approx([m.energy[0] - after] * 2, rel=1e-7)


def test_a_motion_that_loses_nothing_is_found_once(capsys, monkeypatch):
    monkeypatch.setattr(sc.Motion, "at", None)
    told = said(capsys, "roll", "--ell", "1", "--theta", "0.3", "--w1", "0", "--t", "5", "--step", "1e-3").out
    assert "face                   t = 1.4699543" in told


# The drift.


def test_a_drift_says_when_and_how_it_ends(capsys):
    out = said(capsys, "drift", *EULER, "--theta", "0.3", "--law", "viscous-contour=5e-3").out
    d = sc.drift(sc.Body.from_metres(outer_diameter=0.075, length=6.39e-3), 0.3, loss.ViscousContour(5e-3))
    assert "losses                 ViscousContour(0.005)" in out
    assert f"centre                 kept at rest\n  ends                   {d.ended}" in out
    assert f"t = {float(d.stops_at):.12g}" in out and f"{SIZE.seconds(float(d.stops_at)):.6g} s" in out
    heads, rows = table(out)
    assert heads.split() == ["theta", "(rad)", "Omega", "time", "turns/s", "s"]
    assert rows.shape == (11, 5) and rows[0, 0] == 0.3 and rows[0, 2] == 0
    assert np.allclose(rows[:-1, 1], d.precession(rows[:-1, 2]), rtol=1e-6)
    assert np.allclose(rows[:-1, 3], SIZE.turns(rows[:-1, 1]), rtol=1e-6)
    assert np.all(np.diff(rows[:, 2]) > 0) and rows[-1, 2] == pytest.approx(float(d.stops_at), rel=1e-8)


def test_a_drift_that_rolls_says_so_and_needs_friction(capsys):
    rest, rolls = (said(capsys, *DRIFT, "--centre", centre).out for centre in ("rest", "rolling"))
    assert "rolling without slip" in rolls and "friction coefficient" in rolls
    assert "friction coefficient" not in rest
    assert table(rolls)[1][5, 2] > 1.01 * table(rest)[1][5, 2], "it takes longer"


def test_a_drift_as_numbers(capsys):
    told = json.loads(said(capsys, *DRIFT, "--json", "--points", "7").out)
    d = sc.drift(DISK, 0.3, loss.ViscousContour(5e-3))
    assert (
        told["stops_at"] == float(d.stops_at) and told["ended"] == str(d.ended) and told["centre"] == "rest"
    )
    assert told["losses"] == "ViscousContour(0.005)" and len(told["columns"]["theta"]) == 7
    fastest = told["columns"]["precession"][-1]
    assert fastest is None or fastest > 1e3, "infinite where the face lands"


def test_a_drift_that_never_stops_says_so(capsys):
    out = said(capsys, "drift", "--ell", "0", "--theta", "0.3", "--law", "air-linear=1e-3").out
    assert "stops at               never" in out
    told = said(capsys, "drift", "--ell", "0", "--theta", "0.3", "--law", "air-linear=1e-3", "--json").out
    assert json.loads(told)["stops_at"] is None


def test_a_drift_is_written_as_a_table_and_as_a_picture(capsys, tmp_path):
    file = tmp_path / "drift.csv"
    assert f"401 rows in {file}" in said(capsys, *DRIFT, "-o", str(file)).out
    found = np.genfromtxt(file, delimiter=",", names=True)
    assert found.dtype.names == ("theta", "precession", "t") and found["theta"][0] == 0.3
    d = sc.drift(DISK, 0.3, loss.ViscousContour(5e-3))
    assert np.allclose(found["t"], d.time(found["theta"]), rtol=1e-12)
    for suffix in (".png", ".svg"):
        said(capsys, *DRIFT, "-o", str(tmp_path / f"drift{suffix}"))
        assert (tmp_path / f"drift{suffix}").stat().st_size > 5000


def test_a_pipe_gets_the_table_alone(capsys):
    found = said(capsys, *DRIFT, "-o", "-", "--points", "5")
    rows = list(csv.DictReader(io.StringIO(found.out)))
    assert len(rows) == 5 and float(rows[-1]["theta"]) == 0 and float(rows[-1]["t"]) > float(rows[-2]["t"])
    assert "ViscousContour" in found.err and "ViscousContour" not in found.out


def test_what_the_library_warns_of_is_said_in_one_line(capsys):
    found = said(capsys, "drift", "--ell", "0.0852", "--theta", "0.004", "--law", "dry-contour=5e-3")
    assert re.fullmatch(
        r"spincyl drift: the law of dry contour friction is not valid below .* starts there\n", found.err
    )
    assert "DryContour(0.005)" in found.out


@pytest.mark.parametrize(
    ("asked", "match"),
    [
        (["drift", "--ell", "0.1", "--theta", "0.3"], "the following arguments are required: --law"),
        (
            [*DRIFT, "--law", "sticky=1"],
            "'sticky=1': expected NAME=VALUE, such as dry-contour=5e-3, NAME one of dry-contour, ",
        ),
        ([*DRIFT, "--law", "drilling"], "'drilling': expected NAME=VALUE"),
        ([*DRIFT, "--law", "drilling=x"], "'x': expected a number"),
        ([*DRIFT, "--law", "drilling=1kg"], "expected a length, without unit or in m, cm"),
        ([*DRIFT, "--law", "drilling=0"], "drilling=0: length = 0.0: expected a positive number"),
        ([*DRIFT, "--law", "drilling=1mm"], "drilling=1mm needs --radius"),
        ([*DRIFT, "--radius", "1cm", "--law", "air-film=18uPas"], "air-film=18uPas needs --mass"),
        ([*DRIFT, "--points", "1"], "--points 1: expected at least 2"),
        ([*DRIFT, "--centre", "slipping"], "invalid choice: 'slipping'"),
        ([*DRIFT, "-o", "drift.html"], "-o drift.html: expected a name that ends in .csv"),
        ([*DRIFT, "--theta", "1.48"], "forbidden"),
        (
            "roll --ell 1 --theta 1 --t 1 --loss drilling=1e-3 --step 0.1".split(),
            "cannot be combined with losses",
        ),
    ],
)
def test_what_is_no_drift_is_refused(asked, match, capsys):
    try:
        status = cli.main(asked)
    except SystemExit as ended:
        status = ended.code
    found = capsys.readouterr()
    assert status == 2 and match in found.err and found.out == ""
