"""Every public function is called with invalid arguments: errors name them; and equality goes by value."""

import warnings

import numpy as np
import odd
import pytest

import spincyl as sc

plt = pytest.importorskip("matplotlib.pyplot")

# the odd values that have revealed faults
FEW = (
    "None", "text", "bytes", "object", "dict", "empty list", "list of None", "ragged", "pair", "complex", "nan", "inf", "-1",
    "2**70", "10**400", "empty array", "matrix", "vector", "texts", "None array", "date", "Decimal", "masked", "masked number",
    "class of laws", "function", "family", "State", "Motion", "Coulombs", "losses",
)  # fmt: skip
# results, which only functions construct, and enumerations
MADE = {
    "": {
        "Deviation", "Drift", "DriftWarning", "EllipsoidMotion", "Ending", "ErrorWarning", "Event", "GainWarning", "Held", "Impact", "Motion", "Phase", "Play", "Region", "RestsOn", "Rocking",
        "Apex", "Scene", "StepWarning", "Swing", "View",
        "custom", "data", "loss", "parts", "plot", "sweep",
    },
    "custom.": {"Moment"},
    "data.": {"Bounces", "MotionFit", "Comparison", "FilmComparison", "Filmed", "FittedLoss", "FittedStop", "Line", "LossFit", "StopFit", "Wobble"},
    "loss.": {"Loss"},
    "parts.": {"Part"},
    "plot.": {"Landmark"},
    "sweep.": {"Answer", "Outcome", "Status", "save"},
}  # fmt: skip


@pytest.fixture(scope="module")
def subjects(tmp_path_factory):
    plt.switch_backend("Agg")
    return odd.subjects(tmp_path_factory.mktemp("figures"))


def room(name):
    first = name.split(".")[0]
    return first if first in ("data", "loss", "plot", "sweep") else "nouns"


@pytest.mark.parametrize("where", ["nouns", "loss", "sweep", "data", "plot"])
def test_what_an_argument_cannot_be_is_refused_by_its_name(subjects, where):
    offenders, count = [], 0
    for name, (call, good) in subjects.items():
        if room(name) != where:
            continue
        for argument in good:
            for what in FEW:
                if argument in odd.CALLED and what in ("class of laws", "function"):
                    continue
                said = odd.offence(call, good, argument, odd.values()[what])
                plt.close("all")
                count += 1
                if said:
                    offenders.append(f"{name}({argument.strip('(')} = {what}): {said}")
    assert count > 100
    assert not offenders, f"{len(offenders)} of {count}:\n" + "\n".join(offenders)


def test_every_public_name_is_called_oddly_or_is_a_result(subjects):
    called = {name.split(" ")[0] for name in subjects}
    for prefix, made in MADE.items():
        module = getattr(sc, prefix.strip("."), sc)
        missing = {name for name in module.__all__ if f"{prefix}{name}" not in called} ^ made
        assert not missing, f"{prefix}: {missing}"


def test_what_the_subjects_are_called_with_is_right(subjects):
    for name, (call, good) in subjects.items():
        if name in ("plot.figures", "loss.Law", "sweep.block_size of a job"):  # no call of these is valid
            continue
        odd.asked(call, good, *next(iter(good.items())))
        plt.close("all")


def test_axes_are_those_of_matplotlib_and_three_where_three_are_drawn(subjects):
    _, three = plt.subplots(1, 3)
    assert sc.plot.motion(odd.motion(), three)[2] is three[2]
    for bad in (three[:2], [*three, three[0]], [three[0], three[1], None], three[0]):
        with pytest.raises(TypeError, match="^axes: expected three Axes of matplotlib, not "):
            sc.plot.motion(odd.motion(), bad)
    with pytest.raises(TypeError, match="^ax: expected an Axes of matplotlib, not ndarray"):
        sc.plot.frame(ax=three)
    plt.close("all")


def test_a_map_that_is_no_portrait_is_refused_before_it_is_drawn():
    axes = {"theta": np.linspace(0.1, 1.5, 5), "ell": np.linspace(0.5, 2.0, 4)}
    for data, said in (
        (sc.sweep.portrait(**axes, want="rate"), "there is none"),
        (sc.sweep.portrait(**axes, bore=[0.0, 0.5]), "its axes are {'theta': 5, 'ell': 4, 'bore': 2}"),
        (sc.sweep.portrait(axes["theta"], 1.0), "its axes are {'theta': 5}"),
        (sc.sweep.portrait(axes["theta"][:0], axes["ell"]), "its axes are {'theta': 0, 'ell': 4}"),
    ):
        with pytest.raises(ValueError, match="^data: expected ") as caught:
            sc.plot.portrait(data)
        assert said in str(caught.value)
    assert sc.plot.portrait(sc.sweep.portrait(**axes)).get_ylabel().startswith("inclination")
    plt.close("all")


def test_fields_whose_shapes_do_not_fit_are_named():
    with pytest.raises(ValueError, match=r"^shapes do not fit: theta \(3,\), w1 \(2,\)$"):
        sc.State(np.ones(3), np.ones(2), 0.0, 0.0)
    with pytest.raises(ValueError, match=r"^shapes do not fit: ell \(3,\), i1 \(2,\), i3 \(2,\)$"):
        sc.Body(np.ones(3), np.ones(2), np.ones(2))


# equality


def results():
    """Results by type, each computed anew."""
    t, sound = odd.heard()
    tube, tracks = odd.filmed()
    theta = np.radians([5.0, 10.0, 15.0, 70.0, 80.0])
    time = np.linspace(0.0, 0.9 * odd.drift().stops_at, 12)
    ball = sc.Body.ball(-0.2, 0.39, 0.4)
    fit = sc.data.fit_losses(time, odd.drift().theta(time), body=odd.DISK, laws=[sc.loss.ViscousContour])
    return {
        "Wobble": sc.data.wobble(t, sound),
        "Filmed": sc.data.from_above(tracks, tube),
        "FilmComparison": sc.data.compare(odd.tube_motion(), sc.data.from_above(tracks, tube)),
        "Comparison": sc.data.compare(odd.BODY, theta, odd.BODY.rate(theta)),
        "LossFit": fit,
        "FittedLoss": fit.best,
        "Columns": sc.data.read_table(sc.data.example("flicks")),
        "Motion": sc.roll(odd.BODY, odd.STATE, np.linspace(0.0, 2.0, 5), want="pose"),
        "a motion with phases": sc.roll(odd.BODY, odd.STATE, 0.5, contact=sc.Coulomb(0.3)),
        "a motion in seconds": sc.roll(odd.TUBE, odd.TUBE.steady(1.4), 0.05),
        "Drift": sc.drift(odd.DISK, [0.2, 0.3], sc.loss.ViscousContour(1e-3)),
        "Apex": sc.Body.cone(2.0).apex(),
        "Swing": sc.swing(ball, sc.State(1.0, 0.0, 0.0, 0.0)),
        "State": odd.FAMILY.steady(1.3),
        "a state with NaN": odd.BODY.steady(np.array([1.3, 0.5])),
        "a state that slips": sc.State([1.0, 1.1], 1.0, 0.0, 1.0, slip=([0.1, 0.2], 0.0)),
        "Body": sc.Body.solid([0.5, 1.0]),
        "Coulomb": sc.Coulomb([0.1, 0.2]),
        "losses": sc.loss.DryContour([1e-3, 2e-3]) + sc.loss.AirLinear(1e-3),
    }


@pytest.fixture(scope="module")
def twice():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return results(), results()


def test_results_of_the_same_numbers_are_equal_and_have_one_hash(twice):
    for name, one in twice[0].items():
        two = twice[1][name]
        assert one is not two and (one == two) is True and (one != two) is False, name
        if name == "Columns":
            with pytest.raises(TypeError, match="unhashable type: 'Columns'"):
                hash(one)
        else:
            assert hash(one) == hash(two) and {one: 1}[two] == 1, name


def test_a_result_is_equal_to_no_other_thing(twice):
    others = (
        None,
        1,
        1.0,
        "x",
        (),
        [],
        {},
        np.zeros(3),
        np.zeros((3, 3)),
        object(),
        np.float64(1.0),
        odd.Hostile(),
    )
    kinds = list(twice[0].values())
    for name, one in twice[0].items():
        plain = (tuple(one),) if isinstance(one, tuple) else ()
        for other in (*others, *plain, *(x for x in kinds if x is not one)):
            same, reflected = one == other, other == one
            if isinstance(other, np.ndarray) and name == "Columns":
                continue  # to NumPy a dict is no number, so it compares element by element
            assert same is False and reflected is False and (one != other) is True, (name, type(other))


def test_one_number_that_differs_makes_a_result_another(twice):
    wobble, motion, state = (twice[0][name] for name in ("Wobble", "Motion", "State"))
    assert wobble != wobble._replace(turns=wobble.turns + 1e-12) and wobble != wobble._replace(
        t=wobble.t[:-1]
    )
    assert motion != motion.at(motion.t[:-1]) and motion == motion.at(motion.t)
    assert state != state.kicked(1e-9) and state == state.kicked(0.0)
    fit = twice[0]["LossFit"]
    assert fit != fit._replace(
        fits=(fit.best._replace(residual={"theta": fit.best.residual["theta"] + 1e-9}),)
    )
    table, other = (
        twice[0]["Columns"],
        sc.data.Columns([("degrees", np.ones(2)), ("hertz (Hz)", np.ones(2))]),
    )
    same = sc.data.Columns([("hertz (Hz)", np.ones(2)), ("degrees", np.ones(2))])
    assert table != other and other == same and other == {"degrees": np.ones(2), "hertz": np.ones(2)}
    assert other != sc.data.Columns([("degrees", np.ones(2)), ("hertz", np.ones(2))])  # without the unit


def test_a_zero_has_no_sign_and_a_number_no_type_to_equality():
    assert sc.State(1.0, 0.0, 0.0, 1.0) == sc.State(1, -0.0, 0, True)
    assert hash(sc.State(1.0, 0.0, 0.0, 1.0)) == hash(sc.State(1, -0.0, 0, True))
    zeros = sc.Coulomb([0.0, 0.1]), sc.Coulomb([-0.0, 0.1])
    assert zeros[0] == zeros[1] and hash(zeros[0]) == hash(zeros[1])
    assert sc.State([1, 2], 0, 0, 0) == sc.State(np.array([1.0, 2.0]), 0, 0, 0) != sc.State([[1, 2]], 0, 0, 0)
    nan = sc.State(np.nan, 0.0, 0.0, 0.0), sc.State(float("nan"), 0.0, 0.0, 0.0)
    assert nan[0] == nan[1] and hash(nan[0]) == hash(nan[1])
