"""The note of docs/note: every number is filled in, and its claims hold."""

import pathlib
import re
import sys

import numpy as np
import pytest

NOTE = pathlib.Path(__file__).parents[1] / "docs/note"
sys.path.insert(0, str(NOTE))
import computed  # noqa: E402
import note  # noqa: E402

TEXT = note.TEXT.read_text("utf-8")
EXPECTED = {
    "DryContour": (2 / 3, 1 / 2),
    "ViscousContour": (1 / 2, 1 / 2),
    "RollingResistance": (2, 1),
    "AirFilm": (1 / 3, 1 / 3),
    "BoundaryLayer": (4 / 9, 1 / 2),
}


def test_every_number_of_the_note_is_filled():
    assert len(note.PLACEHOLDER.findall(TEXT)) > 60
    filled = note.filled(TEXT)
    assert "@{" not in filled and not re.search(r"\b(nan|inf)\b", filled)


def test_a_number_that_is_not_computed_is_an_error():
    with pytest.raises(KeyError):
        note.filled("@{no_such_number:.1f}")


def test_every_figure_of_the_note_has_its_drawing_and_its_words():
    from drawn import FIGURES

    assert re.findall(r"!\[\]\(_made/(\w+)\.svg\)\n\n\*\*\*Fig\. \d\.", TEXT) == list(FIGURES)


def test_the_thresholds_are_those_of_the_closed_forms():
    n = computed.numbers()
    assert n["edge_smooth"] == pytest.approx(np.sqrt(3 * (np.sqrt(13) - 3) / 8), abs=1e-12)
    assert n["critical_smooth"] == pytest.approx((7 / 4) ** 0.25, abs=1e-12)
    assert n["critical_rolling"] == pytest.approx((7 / 81) ** 0.25, abs=1e-12)
    assert n["edge_rolling"] == 1


def test_no_steady_state_stands_on_ice_and_falls_on_rubber():
    n = computed.numbers()
    assert n["share_other"] == n["share_hoop_other"] == 0 and 11.5 < n["share"] < 12


def test_a_push_grows_and_nods_at_the_rates_of_the_two_criteria():
    n = computed.numbers()
    assert n["growth_found"] == pytest.approx(n["growth_expected"], rel=1e-3)
    assert n["nod_found"] == pytest.approx(n["nod_expected"], rel=1e-6)


def test_the_slip_ends_with_the_centre_nearly_at_rest():
    n = computed.numbers()
    assert n["left"] < 3 and n["left_wet_median"] < 3 and n["left_dry_median"] < 3
    assert n["slip_averaged"] == pytest.approx(n["slip_seconds"], rel=0.1)
    assert n["n_least"] > 2


@pytest.mark.parametrize("law", computed.CONTOUR)
def test_the_two_drifts_have_the_exponents_of_the_table(law):
    n = computed.numbers()
    for centre, p in zip(("rest", "rolling"), EXPECTED[law], strict=True):
        assert abs(n[f"p_{centre}_{law}"] - p) < 2 * n[f"p_{centre}_{law}_error"] + 1e-6


def test_the_motions_have_the_exponents_of_their_drifts():
    n = computed.numbers()
    for table, p in (("rolling", 1 / 2), ("slips", 2 / 3)):
        error = n[f"full_{table}_cylinder_error"]
        assert error < 1e-3 and abs(n[f"full_{table}_cylinder"] - p) < 3 * error


def test_a_body_that_rolls_to_its_end_keeps_a_finite_rate_and_needs_the_friction_1_over_ell():
    n = computed.numbers()
    for body in ("cylinder", "euler"):
        assert n[f"rate_{body}"] == pytest.approx(n[f"rate_{body}_law"], rel=1e-3)
        assert n[f"demand_{body}"] == pytest.approx(n[f"demand_{body}_law"], rel=1e-3)
    assert n["fastest_rolling_cylinder"] < n["rate_cylinder"] < 0.03 * n["fastest_slips_cylinder"]
