"""Stability: the same default contact everywhere, and a reason where False has another cause."""

import inspect
import warnings

import numpy as np
import pytest

import spincyl as sc
from spincyl.cli._options import parser

SIDE = np.pi / 2


def functions():
    """Every public function and method with an argument `contact`."""
    for place in (sc, sc.plot, sc.sweep, sc.data, sc.Body, sc.Ellipsoid, sc.Motion):
        for name in dir(place) if inspect.isclass(place) else place.__all__:
            found = getattr(place, name)
            if not name.startswith("_") and callable(found) and not inspect.isclass(found):
                asked = inspect.signature(found).parameters.get("contact")
                if asked is not None:
                    yield f"{place.__name__}.{name}", asked.default


def test_a_contact_that_is_not_given_rolls_everywhere():
    found = dict(functions())
    assert len(found) > 12 and {"spincyl.plot.branches", "spincyl.plot.landmarks"} < set(found)
    # a map shows both contacts; a flick has no default; a top or an egg without a table has an estimate
    other = {name: contact for name, contact in found.items() if contact != "rolling"}
    assert other == {
        "spincyl.plot.portrait": None,
        "spincyl.sweep.flicks": inspect.Parameter.empty,
        "spincyl.rising_spin": None,
        "spincyl.turning_spin": None,
    }


def test_the_command_line_rolls_too():
    commands = parser()._subparsers._group_actions[0].choices
    for name, command in commands.items():
        for option in command._actions:
            if option.dest == "contact":
                assert option.default in ("rolling", None if name == "portrait" else "rolling"), name


def test_branches_are_drawn_by_what_stable_says():
    plt = pytest.importorskip("matplotlib.pyplot")
    plt.switch_backend("Agg")
    body = sc.Body.solid(0.375)  # stable in rolling, unstable on a smooth table
    ax = sc.plot.branches([0.375], marks=False)
    assert "rolling" in ax.get_title()
    seen = 0
    for line in ax.lines:
        rate, theta = line.get_xdata(), np.radians(line.get_ydata())
        middle = theta[len(theta) // 2]
        if len(theta) > 10 and 0.01 < middle < 1.56:
            assert body.stable(middle) == (line.get_linestyle() == "-"), np.degrees(middle)
            assert np.isclose(body.rate(middle), rate[len(rate) // 2])
            seen += 1
    assert seen > 1
    assert [x.theta for x in sc.plot.landmarks(body)] == [x.theta for x in sc.plot.landmarks(body, "rolling")]
    plt.close("all")


COIN, HURRICANE = sc.Body.solid(0.1), sc.Body.balls()


@pytest.mark.parametrize(
    ("body", "state", "on"),
    [
        (COIN, sc.State(SIDE, 0.0, 0.0, 0.0), "both its rims"),
        (COIN, sc.State(SIDE, 2.0, 0.0, 0.0), "both its rims"),
        (COIN, sc.State([1.0, SIDE], [0.1, 2.0], 0.0, 0.0), "both its rims"),
        (sc.Body.solid(np.array([0.0, 0.1])), sc.State(SIDE, 2.0, 0.0, 0.0), "both its rims"),
        (sc.Body.tube(2.5, 0.5, fillet=0.1), sc.State(SIDE, 3.0, 0.0, 0.0), "both its rims"),
        (HURRICANE, sc.State(SIDE, 3.0, 0.0, 0.0), "both its rims"),
        (COIN, sc.State(0.0, 0.0, 0.0, 2.0), "its whole face"),
    ],
)
def test_a_body_on_two_rims_or_on_its_face_is_not_stable_and_is_told_why(body, state, on):
    for contact in ("rolling", "smooth"):
        with pytest.warns(
            UserWarning, match=rf"^at: theta = \S+, where the body stands on {on}; stable"
        ) as told:
            found = body.stable(state, contact)
        assert not np.all(found) and told[0].filename == __file__
        if on == "both its rims":
            assert "launch_number" in str(told[0].message)
    if on == "both its rims" and np.ndim(body.ell) == np.ndim(state.theta) == 0:
        assert abs(sc.launch_number(body, state)) <= 1, "and there it stays"


@pytest.mark.parametrize(
    ("body", "state"),
    [
        (COIN, COIN.steady(SIDE)),  # steady on one rim
        (COIN, sc.State(1.0, 0.3, 0.2, 0.0)),  # not steady, on a point
        (sc.Body.solid(0.0), sc.State(SIDE, 2.0, 0.1, 0.0)),  # its two rims coincide
        (sc.Body.ball(-0.2, 0.4, 0.4), sc.State(SIDE, 2.0, 0.1, 0.0)),  # one rim only
        (sc.Body.ball(-0.2, 0.4, 0.4), sc.State(0.0, 0.0, 0.0, 3.0)),  # one rim, no face
    ],
)
def test_other_states_are_answered_without_a_word(body, state):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        body.stable(state)
