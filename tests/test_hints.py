"""Names that are not there: the error names the function and says what there is instead."""

import copy
import dataclasses
import importlib
import inspect
import pickle
import pkgutil
import re
import sys
import warnings

import numpy as np
import pytest

import spincyl as sc

BODY = sc.Body.solid(2.5)
STATE = BODY.steady(1.3)


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda: sc.roll(BODY, STATE, 1.0, slope=0.1), "'slope': roll takes table=sc.Table"),
        (lambda: sc.roll(BODY, STATE, 1.0, incline=0.1), "'incline': roll takes table=sc.Table"),
        (lambda: sc.roll(BODY, STATE, 1.0, height=0.1), "'height': .*sc.dropped\\(body, height, theta\\)"),
        (lambda: BODY.roll(STATE, 1.0, tols=0.1), "^roll\\(\\) .*'tols': did you mean tol\\?"),
        (lambda: sc.roll(BODY, STATE, 1.0, mass=0.1), "'mass': expected body, state, t, t0, step"),
        (lambda: sc.measured(outer_diameter=0.1, height=0.1), "^measured\\(\\) .*'height': .*length="),
        (
            lambda: sc.measured(outer_diameter=0.1, material="steel"),
            "'material': give density= the name of a",
        ),
        (lambda: sc.Ellipsoid.rattleback(axes=(3, 2, 1), twist=0.1), "'axes': semi_axes= are half of length"),
        (
            lambda: sc.Ellipsoid.rattleback(length=0.1, twist=0.1),
            "'length': .* whole ellipsoid; a stone that is its lower half has .* its whole depth$",
        ),
        (lambda: sc.measured(outer_diameter=0.1, lenght=0.1), "'lenght': did you mean length\\?"),
        (
            lambda: sc.thrown(BODY, 1.0, 2.0, slope=0.1),
            "^thrown\\(\\) .*'slope': roll takes table=sc.Table",
        ),
        (lambda: sc.plot.branches([2.5], slope=0.1), "^branches\\(\\) .*'slope'"),
    ],
)
def test_an_unknown_argument_names_its_function_and_what_there_is(call, told):
    with pytest.raises(TypeError, match=told) as caught:
        call()
    assert re.match(r"[\w.]+\(\) got an unexpected keyword argument '\w+'", str(caught.value))


def test_every_public_function_is_named_by_the_error_about_an_unknown_argument():
    for module in (sc, sc.loss, sc.parts, sc.data, sc.plot, sc.sweep):
        for name in module.__all__:
            call = getattr(module, name)
            of = inspect.signature(call).parameters.values() if inspect.isfunction(call) else []
            if not of or any(p.kind == p.VAR_KEYWORD for p in of):  # which passes them on
                continue
            plain = [None for p in of if p.default is p.empty and p.kind != p.KEYWORD_ONLY]
            with pytest.raises(
                TypeError, match=f"\\b{name}\\(\\) got an unexpected keyword argument 'nowhere'"
            ):
                call(*plain, nowhere=1)


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("cone", "sc.parts.cone"),
        ("cube", "sc.parts"),
        ("cylinder", "sc.Body.solid"),
        ("rol", "did you mean roll\\?"),
    ],
)
def test_a_name_that_is_not_there_says_what_is(name, told):
    with pytest.raises(AttributeError, match=f"module 'spincyl' has no attribute '{name}': .*{told}"):
        getattr(sc, name)
    assert not hasattr(sc, "_nothing") and not hasattr(BODY, "cube") and not hasattr(sc.Body, "cube")


def test_a_module_shows_its_public_names_and_none_that_it_imports():
    doors = {"spincyl", *(f"spincyl.{x}" for x in "cli custom data loss parts plot sweep".split())}
    for module in map(importlib.import_module, doors):
        shown = {name for name in dir(module) if not name.startswith("_")}
        assert shown - {"typical", "MOST_BYTES"} == {*module.__all__}, module.__name__
        assert "__doc__" in dir(module)
    # no other module of the package has a name without an underscore, but those of the two applications
    for found in pkgutil.iter_modules(sc.__path__, "spincyl."):
        assert found.name in doors | {"spincyl.studio", "spincyl.lab"} or "._" in found.name, found.name
    for name in ("spincyl.lab", "spincyl.studio", "spincyl.studio.plot", "spincyl.studio.pages"):
        module = importlib.import_module(name)
        shown = {x for x in dir(module) if not x.startswith("_")}
        assert all(inspect.ismodule(getattr(module, x)) for x in shown), name


@pytest.mark.parametrize("name", ["still", "still_symbols", "symbols"])
def test_still_symbols_are_found_under_their_name(name):
    for of in (BODY, STATE):
        with pytest.raises(AttributeError, match=f"has no attribute '{name}': contact_radius of a state is"):
            getattr(of, name)
    assert not hasattr(STATE, "stil") and not hasattr(STATE, "__len__")
    with pytest.raises(AttributeError, match="^critical_hertz: needs a measured body"):
        BODY.critical_hertz


COIN, STONE = sc.measured(outer_diameter="24mm", length="2mm"), sc.Ellipsoid.egg(0.7, 1.0)
KNOWN = {
    "body": BODY,
    "state": STATE,
    "motion": sc.roll(BODY, STATE, [0.0, 1.0]),
    "stone": STONE,
    "state of a stone": STONE.spinning(1.0),
    "motion of a stone": sc.roll(STONE, STONE.spinning(1.0), [0.0, 1.0]),
    "drift": sc.drift(COIN, 0.3, sc.loss.DryContour.from_si("0.05mm", scale=COIN)),
    "scale": COIN.scale,
    "friction": sc.Coulomb(0.3),
    "loss": sc.loss.DryContour(0.01),
    "table": sc.Table(0.1),
}


@pytest.mark.parametrize("kind", KNOWN)
def test_an_attribute_that_is_not_there_says_which_are_a_near_one_first(kind):
    thing = KNOWN[kind]
    public = [x for x in dir(thing) if not x.startswith("_")]
    name = type(thing).__name__
    for x in public:  # a letter doubled is a slip of the finger
        with pytest.raises(
            AttributeError, match=f"^'{name}' object has no attribute '{x[0]}{x}': "
        ) as caught:
            getattr(thing, x[0] + x)
        assert len(x) < 3 or re.search(f"did you mean .*\\b{x}\\b", str(caught.value)), str(caught.value)
    with pytest.raises(AttributeError, match=f"'zzzz': it has {', '.join(sorted(public))}$"):
        thing.zzzz
    assert copy.copy(thing) == thing == pickle.loads(pickle.dumps(thing)) and not hasattr(thing, "__len__")


@pytest.mark.parametrize(
    ("kind", "name", "there"),
    [
        ("body", "mass", "scale"),
        ("motion", "velocity", "body.centre_velocity"),
        ("motion", "position", "centre"),
        ("motion", "omega", "w"),
        ("motion of a stone", "omega", "w"),
        ("motion of a stone", "velocity", "slip"),
        ("stone", "axes", "semi_axes"),
        ("state of a stone", "w1", "w"),
    ],
)
def test_another_word_for_an_attribute_leads_to_it(kind, name, there):
    with pytest.raises(AttributeError, match=rf"has no attribute '{name}': {re.escape(there)}\b"):
        getattr(KNOWN[kind], name)
    at, *more = there.split(".")
    assert at in dir(KNOWN[kind]) and all(x in dir(getattr(KNOWN[kind], at)) for x in more)


def test_every_word_that_is_proposed_for_an_attribute_begins_with_one_that_there_is():
    from spincyl._input.hints import _ATTRIBUTES

    of = {type(thing).__name__: thing for thing in KNOWN.values()}
    for kind, words in _ATTRIBUTES.items():
        for name, said in words.items():
            assert not hasattr(of[kind], name), f"{kind}.{name}"
            first = re.match(r"\w+", said)[0]
            there = first in dir(of[kind]) or re.match(
                "only for|sc\\.|a state|.* of a state|body.centre", said
            )
            assert there, f"{kind}.{name}: {said}"


@pytest.mark.parametrize(
    "family",
    [
        sc.roll(BODY, STATE.kicked(0.05), [0.0, 1.0]).states,
        sc.State([1.2, 1.3], [0.1, 0.2], 0.0, 0.3, slip=([0.1, 0.2], [0.0, 0.3])),
        sc.Body.tube([2.0, 2.5], bore=[0.2, 0.3]),
    ],
    ids=["states", "slip", "bodies"],
)
def test_the_error_about_an_index_says_how_to_take_one_of_many(family):
    with pytest.raises(TypeError, match="is not subscriptable: .*index (its|the) fields, as in ") as caught:
        family[1]
    call = str(caught.value).split(" as in ")[1]
    name = type(family).__name__.lower()
    assert ("subscriptable: m.at(t) has theta, w" in str(caught.value)) == (name == "state")
    one = eval(call, {"dataclasses": dataclasses, name: family})
    assert all(np.ndim(x) == 0 for x in one._numbers)
    assert one.theta == family.theta[1] if name == "state" else one.ell == 2.5 and one.bore == 0.3
    with pytest.raises(TypeError, match=r"theta\[i\]|ell\[i\]"):
        family[:1]
    with pytest.raises(TypeError, match="^'(State|Body)' object is not subscriptable$"):
        one[0]


def test_a_can_that_is_thrown_says_how_it_goes_on_with_two_rims():
    can = sc.Body.solid(1.8)
    thrown = sc.thrown(can, 1.0, 2.0)
    m = sc.roll(can, thrown, 5.0, contact=sc.Coulomb(0.3))
    assert m.status == sc.Ending.SIDE and "with restitution=0.0 the motion continues" in m.message
    m = sc.roll(can, thrown, 5.0, contact=sc.Coulomb(0.3), restitution=0.0)
    assert m.status == sc.Ending.DONE and "restitution" not in m.message
    falls = sc.roll(can, can.steady(1.45).kicked(-0.5), 50.0)
    assert falls.status == sc.Ending.SIDE and "restitution" not in falls.message


def test_a_cup_cannot_be_thrown_and_says_why():
    parts = sc.parts
    floor = parts.disk(outer_diameter="50mm", density=0.3)
    wall = parts.wall(lower_diameter="50mm", upper_diameter="80mm", length="90mm", at=0, density=0.3)
    with pytest.raises(ValueError, match="theta_end = 1.4.*a cup, which rolls in a circle"):
        sc.thrown(sc.assembled([floor, wall]), 1.0, 2.0)


def test_a_missing_extra_is_installed_for_the_python_that_runs(monkeypatch):
    monkeypatch.setitem(sys.modules, "odrpack", None)
    for prefix, python, how in (
        ("/env", "/env/bin/python3", "/env/bin/python3"),
        ("/my env", "/my env/bin/python", "'/my env/bin/python'"),
        ("/usr", "/usr/bin/python3", "python"),
    ):
        monkeypatch.setattr(sys, "prefix", prefix)
        monkeypatch.setattr(sys, "base_prefix", "/usr")
        monkeypatch.setattr(sys, "executable", python)
        with pytest.raises(ImportError) as caught:
            sc.data.compare(BODY, [0.1, 0.2, 0.3], [1.0, 1.0, 1.0])
        assert str(caught.value) == f"this needs odrpack: {how} -m pip install 'spincyl[lab]'"


T = np.linspace(0.0, 60.0, 601)


def ended():
    """A motion that ends before the last time: a coin comes to rest."""
    coin = sc.measured(outer_diameter=25e-3, length=2e-3, mass=8e-3)
    loss = sc.loss.DryContour.from_si("0.02mm", scale=coin)
    return sc.roll(coin, coin.steady(0.3), T, losses=loss, want=("pose", "force"))


def test_a_motion_that_ends_early_says_how_many_of_the_times_it_reached():
    m = ended()
    assert m.message.endswith(f"; {m.t.size} of 601 times reached: plot against m.t") and m.t.size < T.size
    assert "reached: plot" not in sc.roll(BODY, STATE, [0.0, 1.0]).message
    assert "reached: plot" not in sc.roll(m.body, m.body.steady(0.3), 60.0, losses=m._asked.losses).message


def test_the_arrays_of_a_motion_that_ends_early_are_arrays_like_any_other():
    m = ended()
    for name in ("t", "theta", "w", "normal", "phi", "energy", "centre"):
        values = getattr(m, name)
        assert type(values) is np.ndarray and type(values[:3]) is np.ndarray and type(values.shape) is tuple
        assert str(values[:3].shape) == str((3, *values.shape[1:])) and len(values) == m.t.size
    column = m.theta.copy()
    column.shape = (column.size, 1)
    assert column.shape == (m.t.size, 1)
    again = pickle.loads(pickle.dumps(m))
    assert again == m and type(again.theta) is np.ndarray
    assert m.to_xarray()["theta"].shape == m.theta.shape and len(m.to_dataframe()) == m.t.size


@pytest.mark.parametrize(
    ("contact", "told"),
    [
        (0.3, r"contact = 0.3: .*did you mean sc.Coulomb\(0.3\)\?"),
        (lambda u: 0.3, r"did you mean sc.custom.Friction\(function\)\?"),
        (sc.Coulomb, r"contact = .*: expected 'rolling', 'smooth', sc.Coulomb\(mu\)"),
        ("ice", "contact = 'ice': .*; did you mean 'smooth'\\?$"),
        ("no slip", "did you mean 'rolling'\\?$"),
        ("dry", r"did you mean sc.Coulomb\(mu\)\?$"),
    ],
)
def test_a_contact_that_is_none_says_which_there_are_also_for_a_measured_body(contact, told):
    coin = sc.measured(outer_diameter="25.75mm", length="2.2mm")
    for call in (sc.roll, sc.sweep.roll):
        with pytest.raises(ValueError, match=told):
            call(coin, coin.steady(0.3), 1.0, contact=contact)


@pytest.mark.parametrize(
    ("want", "needs"),
    [("work_lost", "losses="), ("dissipated", "contact=sc.Coulomb"), ("impacts", "restitution=")],
)
def test_an_output_of_other_motions_says_what_these_need(want, needs):
    with pytest.raises(ValueError, match=f"want = '{want}': .*; this output needs {needs}"):
        sc.sweep.roll(BODY, STATE, 1.0, want=want)
    with pytest.raises(ValueError, match=r"'energy': expected some of \[[^]]*\]$"):
        sc.sweep.roll(BODY, STATE, 1.0, want="energy")


def test_a_motion_of_which_nothing_is_known_warns():
    tube = sc.Body.tube(6.0, bore=0.8)
    with pytest.warns(sc.ErrorWarning, match=r"estimated error of the motion is 1\.3"):
        m = sc.roll(tube, tube.steady(1.4).kicked(0.05), 1e15)
    assert m.error > 1


def test_a_body_that_hops_until_its_motion_is_unknown_warns_once():
    coin = sc.measured(outer_diameter="24mm", length="2mm", mass="8g")
    start, how = sc.flicked(coin, hertz=8, launch=1.3), {"contact": sc.Coulomb(0.3), "restitution": 0.3}
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        m = sc.roll(coin, start, np.linspace(0, 10, 101), **how)
    (one,) = said
    assert one.category is sc.ErrorWarning and m.status.name == "DONE"
    assert f"is {m.natural.error:.2g}, in natural units: impacts multiply errors" in str(one.message)
    # as the message says, it is known up to an earlier time, here without a warning
    assert (
        "Motion.known_until is the time up to which states are known" in str(one.message)
        and 0.05 < m.known_until < 0.2
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        early = sc.roll(coin, start, m.known_until, **how)
    assert early.natural.error < 0.1 and len(early.impacts) > 20
    assert early.known_until == early.t[-1], "it is known up to its end"
    assert m.at(np.linspace(0, m.known_until + 0.1, 101)).natural.error > 0.1
    assert m.known_until == pytest.approx(coin.scale.seconds(m.natural.known_until), rel=1e-15)


@pytest.mark.parametrize("end", [1e15, -1e15])
@pytest.mark.filterwarnings("ignore::spincyl.ErrorWarning")
def test_a_motion_by_first_integrals_is_known_up_to_a_time_in_either_direction(end):
    tube = sc.Body.tube(6.0, bore=0.8)
    m = sc.roll(tube, tube.steady(1.4).kicked(0.05), end)
    until = m.known_until
    assert m.error > 1 and 0 < until / end < 0.1
    assert m.at(until).error < 0.1 < m.at(30 * until).error
    known = sc.roll(tube, tube.steady(1.4).kicked(0.05), [0.0, np.sign(end)])
    assert known.known_until == np.sign(end)


def test_a_motion_that_ends_early_is_known_up_to_its_event():
    body = sc.Body.solid(1.0)
    m = sc.roll(body, sc.State(0.3, 0.0, 0.0, 0.0), 2.0)
    assert m.event is not None and m.known_until == m.event.time < 2.0


def test_names_of_laws_of_restitution_lead_to_what_exists():
    coin = sc.measured(outer_diameter="24mm", length="2mm")
    for call in (sc.roll, sc.sweep.roll):
        with pytest.raises(TypeError, match=r"^restitution: expected a number \(Stronge's law\), sc.Newton"):
            call(coin, coin.steady(0.5), 1.0, contact=sc.Coulomb(0.3), restitution="stronge")
    with pytest.raises(AttributeError, match="'Stronge': restitution= takes the number"):
        sc.Stronge
    with pytest.raises(AttributeError, match=r"'Garwin': sc.Walton\(e, tangential\)"):
        sc.Garwin


def test_a_film_at_another_speed_is_made_by_view(tmp_path):
    m = sc.roll(BODY, STATE, 1.0)
    with pytest.raises(TypeError, match=r"film\(\) got an unexpected .* 'slow': sc.view\(m, slow=1\).save"):
        m.film(tmp_path / "x.mp4", slow=1)


def test_a_spin_in_turns_per_second_is_told_of_hertz():
    stone = sc.Ellipsoid.rattleback(("8cm", "16mm", "14mm"), twist=0.1)
    with pytest.raises(TypeError, match=r"^spin = '-1Hz': expected a number in sqrt\(g/a\); hertz= takes"):
        stone.spinning("-1Hz")
    assert stone.spinning(hertz="-1Hz").spin < 0


def test_a_coin_is_told_that_a_film_from_above_is_for_tubes():
    coin = sc.measured(outer_diameter="24mm", length="2mm")
    with pytest.raises(ValueError, match="^tube: from_above is for tubes, .* 0.083 times as long as wide"):
        sc.data.from_above(sc.data.example("tube_from_above"), coin)


def test_branches_of_a_body_that_is_no_tube_name_no_bore_and_say_what_is_shown():
    pytest.importorskip("matplotlib")
    balls = sc.assembled([sc.parts.ball(diameter=x, density=7800) for x in ("18mm", "14mm")])
    said = sc.plot.branches([balls]).get_title()
    assert "nan" not in said and "up to 90 degrees" in said
    assert "90" not in sc.plot.branches([2.5]).get_title()
