"""Ends that are difficult to compute: near the last time, at the start, at a stop, or nearly without spin.

Times and states come from independent models of 80 to 220 bits, unless another source is named.
"""

import warnings

import numpy as np
import pytest

import spincyl as sc
from spincyl import loss
from spincyl.sweep import Status

COIN = sc.Body.solid(0.1)


def swept(body, y, slip, table, t, **how):
    """One motion by `sweep.roll`: status, time of the end, theta and claimed error."""
    state = sc.State(*(np.array([x]) for x in y), slip=tuple(np.array([u]) for u in slip))
    found = sc.sweep.roll(body, state, t, contact=table, want=("final", "end"), **how)
    return int(found["status"][0]), *(float(found[x][0]) for x in ("end", "theta", "error"))


@pytest.mark.parametrize(
    ("body", "y", "slip", "table", "t", "ending", "time"),
    [
        (sc.Body.solid(0.2), (1, 0, 0, 0), (2, 0), sc.Coulomb(0.3), 1.5, Status.FACE, 1.487881014157),
        (
            sc.Body.solid(0.6, fillet=0.6),
            (1, 0, 0, 0),
            (5, 0),
            sc.Coulomb(0.8),
            1.2,
            Status.FACE,
            1.134689960683,
        ),
        (
            sc.Body(0.0, 0.29954305216697566, 0.41785056897553063, fillet=0.6),
            (1.0598275864107107, 0.0, 1e-300, 0.0),
            (5.207962547524224, 0.0),
            sc.Coulomb(0.8, static=1.04),
            1.1914729666844346,
            Status.FACE,
            1.163297055291013,
        ),
        (
            sc.Body.tube(0.44134200959537395, bore=0.8),
            (1.5707963267902685, 1.1043152607460287, -1.3535438342233237e-05, 0.4873807164044917),
            (4.85927291504566, 0.0),
            sc.Coulomb(0.05),
            2.86,
            Status.SIDE,
            3.42261e-07,
        ),
    ],
    ids=["round numbers", "rounded", "hardly after the last time", "hardly after the start"],
)
def test_a_slip_that_lands_beside_the_first_or_the_last_time_lands(body, y, slip, table, t, ending, time):
    status, end, _, claim = swept(body, y, slip, table, t, tol=1e-12)
    assert status == ending and abs(end - time) < 1e-11
    alone = sc.roll(body, sc.State(*y, slip=slip), t, contact=table)
    assert int(alone.status) == ending and abs(alone.event.time - end) <= claim + alone.error


STOPS = [
    (
        sc.Body.solid(0.0035832839567884368),
        (1.3524759561413648, 1e-8, 0.0, 0.0),
        loss.DryContour(3.614611964363141e-05)
        + loss.ViscousContour(4.114347393023229e-06)
        + loss.RollingResistance(0.26225962831730393)
        + loss.Drilling(5.2057340032101825e-06)
        + loss.AirLinear(5.533794786161648e-06)
        + loss.AirQuadratic(0.01)
        + loss.AirFilm(3.0778866516498115e-06)
        + loss.BoundaryLayer(1.871030316133063e-05),
        # psi' stops first, at 2.65e-8, and is held; then w2 = 1.25818e-10 falls at the rate
        # (g - delta)/(I1 + 1 + ell^2 - g delta) = -0.0411744, g = cos theta - ell sin theta
        2.9569624458e-08,
        {"w1": 7.73314e-09},
    ),
    (
        sc.Body(-0.40233593120465216, 0.4578871519131137, 0.3479418749259518, fillet=1.0),
        (1.1959320604242246e-07, 1.5173562488834882e-07, 1.5719552158284337e-09, 0.7582950064889605),
        loss.DryContour(0.0004965689725305448)
        + loss.RollingResistance(0.001)
        + loss.Drilling(2.9499838127286926e-05),
        3.3271189980570454e-05,
        {"w3": 0.7582950036681068},
    ),
]


@pytest.mark.parametrize(("body", "y", "law", "time", "true"), STOPS)
def test_rolling_resistance_stops_a_rolling_when_and_where_it_does_whatever_times_are_asked_for(
    body, y, law, time, true
):
    for times in ([time], np.linspace(0, time, 7), [time, 3.5]):
        m = sc.roll(body, sc.State(*y), times, t0=0.0, losses=law)
        there = dict(zip(("w1", "w2", "w3"), m.w[list(m.t).index(time)], strict=True))
        for name, value in true.items():
            found = there[name]
            assert abs(found - value) <= m.error and abs(found - value) < 1e-11, name
        # rolling and rocking end there: a moment later they are gone
        after = sc.roll(body, sc.State(*y), [time * (1 + 1e-6)], t0=0.0, losses=law)
        w1, w2, w3 = after.w[0]
        rolling = np.cos(after.theta[0]) * w1 - np.sin(after.theta[0]) * w3
        assert np.hypot(rolling, w2) < 1e-12


@pytest.mark.parametrize("w1", [0.0, 1e-300, 1e-20, 1e-16, 1e-12])
def test_what_all_but_does_not_turn_falls_as_what_does_not(w1):
    body = sc.Body.solid(0.4487387004847323, fillet=0.4487387004847323)
    start = sc.State(0.18655459943920516, w1, 0.0, 0.0)
    m = sc.roll(body, start, 20.0, losses=loss.AirLinear(9.85580013311344e-06))
    # from the planar equation, by DOP853
    assert m.status is sc.Ending.FACE and abs(m.event.time - 0.7573446267939468) < 1e-12
    assert m.error < 1e-9


@pytest.mark.parametrize(
    "law", [loss.AirLinear(1e-3), loss.RollingResistance(1e-3), loss.AirFilm(1e-6), loss.Drilling(1e-3)]
)
def test_a_pencil_that_is_let_go_falls_and_slips_also_where_it_loses_energy(law):
    body, table = sc.Body.solid(2.0), sc.Coulomb(0.3)
    free = sc.roll(body, sc.State(0.3, 0.0, 0.0, 0.0), 10.0, contact=table)
    m = sc.roll(body, sc.State(0.3, 0.0, 0.0, 0.0), 10.0, contact=table, losses=law)
    assert m.status is sc.Ending.FACE and m.error < 1e-11
    assert [phase.kind for phase in m.phases] == [phase.kind for phase in free.phases]
    # a loss may not act here, but it never accelerates the fall
    assert -1e-12 < m.event.time - free.event.time < 1e-2


def test_two_laws_of_which_one_resists_rolling_bring_a_coin_down():
    alone = sc.roll(COIN, COIN.steady(0.3), 100.0, losses=loss.RollingResistance(0.01))
    for other in (loss.Drilling(1e-4), loss.Drilling(1e-3), loss.AirLinear(1e-3)):
        m = sc.roll(COIN, COIN.steady(0.3), 100.0, losses=loss.RollingResistance(0.01) + other)
        assert m.status is sc.Ending.FACE and m.event.time < alone.event.time
        # near the table the steps become short, but not too many
        assert m.error < 1e-3 and m.nfev < 300_000


def test_a_contact_that_settles_under_any_tolerance_lands_alone_and_in_lanes():
    film = sc.Body(1.7399531488618347, 1.2087091988139662, 0.7785354253435868, fillet=0.9698273206368655)
    laws = loss.AirFilm(6.531941258000921e-05) + loss.ViscousContour(1.3990688574116718e-05)
    y = (1.6090189188907491e-06, 7.317220822233442e-06, 0.0, -0.08037032676798037)
    alone = sc.roll(film, sc.State(*y), 13.09, losses=laws)
    for tol in (1e-12, 1e-10, 1e-8):
        status, end, _, claim = swept(film, y, (0.0, 0.0), "rolling", 13.09, losses=laws, tol=tol)
        assert status == alone.status == Status.FACE
        assert abs(end - alone.event.time) <= claim + alone.error < 1e-4


def test_a_motion_that_hardly_advances_is_given_up_by_name_and_the_sweep_goes_on():
    # on ice, air slows a spinning coin ever more slowly, over ever more turns
    coin = sc.Body(0.0, 0.2544821776506208, 0.5089643553012416)
    laws = loss.AirLinear(0.2640565710003036) + loss.AirQuadratic(0.18745507026194141)
    theta, w1 = np.array([0.3, 2.1772682973849927e-07, 0.5]), np.array([0.5, 0.0009249692353442887, 0.4])
    how = {"contact": "smooth", "losses": laws}
    with pytest.warns(RuntimeWarning, match="given up at t = "):
        alone = sc.roll(coin, sc.State(theta[1], w1[1], 0.0, 0.0), [0.0, 1e-3, 12.0], **how)
    assert alone.status == sc.Ending.BOUNDED and 1e-3 < alone.event.time < 12 and alone.t.size == 2
    with pytest.warns(RuntimeWarning, match="1 of 3 motions"):
        found = sc.sweep.roll(coin, sc.State(theta, w1, 0.0, 0.0), 12.0, want=("final", "end"), **how)
    status = found["status"].values
    assert status[1] == Status.BOUNDED and np.isnan(found["theta"][1])
    assert (status[[0, 2]] == Status.DONE).all()
    # the other motions cause no warning
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sc.sweep.roll(coin, sc.State(theta[[0, 2]], w1[[0, 2]], 0.0, 0.0), 12.0, **how)


def test_what_changes_its_way_ten_thousand_times_is_followed_up_to_there():
    law = loss.Drilling(1e-3) + loss.AirLinear(1e-3)
    with pytest.warns(RuntimeWarning, match="given up at t = "):
        m = sc.roll(COIN, COIN.steady(0.3).kicked(0.02), np.linspace(0, 1e4, 101), losses=law)
    assert m.status == sc.Ending.BOUNDED and 100 < m.event.time < 1e4
    # the states before the end are returned
    assert m.t.size == 1 + int(m.event.time // 100) and np.isfinite(m.y).all()


@pytest.mark.parametrize(
    "how", [{"losses": loss.AirLinear(0.01)}, {"contact": sc.Coulomb(0.5)}, {"contact": sc.Viscous(0.5)}, {}]
)
def test_minus_zero_is_a_time_like_zero(how):
    bodies = sc.Body.solid(np.array([1.0, 2.0, 3.0]))
    slip = (0.2, 0.1) if "contact" in how else None
    for state in (sc.State(1.3, 0.3, 0.05, 1.0, slip=slip), sc.Body.solid(2.5).steady(1.3)):
        zero, minus = (sc.sweep.roll(bodies, state, t, **how) for t in (0.0, -0.0))
        for name in zero.data_vars:
            assert np.array_equal(zero[name], minus[name], equal_nan=True), name
        assert (minus["theta"] == 1.3).all()


def test_an_end_at_the_start_is_one_sample_on_any_table():
    lifted = sc.State(1.2, 0.0, 5.0, 0.0)
    body = sc.Body.solid(1.0)
    rolls = sc.roll(body, lifted, [0.0, 1.0])
    for how in ({"contact": sc.Coulomb(0.5)}, {"contact": sc.Viscous(0.5)}, {"losses": loss.AirLinear(1e-3)}):
        m = sc.roll(body, lifted, [0.0, 1.0], want=("pose", "force"), **how)
        assert m.status is rolls.status is sc.Ending.LIFT_OFF and m.event.time == 0.0
        assert m.t.tolist() == rolls.t.tolist() == [0.0] and m.theta[0] == 1.2 and np.isfinite(m.normal[0])


def test_a_slip_that_is_taken_up_again_has_no_phase_without_length_before_it():
    body, table = sc.Body.solid(2.5), sc.Coulomb(0.05)
    m = sc.roll(body, body.steady(1.3).kicked(0.05), 30.0, contact=table)
    begun = [phase for phase in m.phases if phase.kind == "slipping" and phase.time > 0]
    assert len(begun) > 2
    for phase in begun:
        again = sc.roll(body, phase.state, 1.0, contact=table)
        assert (np.diff([p.time for p in again.phases]) > 0).all()


def test_the_claim_of_a_pose_grows_with_what_has_turned():
    law = loss.AirLinear(5.321460243699881e-06) + loss.AirQuadratic(0.003568681746753817)
    start = sc.State(1.336455416320353e-07, 0.0005709332147352174, 0.0, 0.0)
    m = sc.roll(sc.Body.tube(0.0, bore=0.8), start, 1.0716973357913866, losses=law, want="pose")
    off = np.abs(m.centre[-1, :2] - (0.9999999999999911, 1.06e-19)).max()
    assert off <= m.pose_error < 1e-9


@pytest.mark.parametrize(
    ("body", "y", "t", "how", "w2"),
    [
        (
            sc.Body(-0.04550176010465724, 0.3566599902750571, 0.3201295341967981, fillet=1.0),
            (0.07952897210452115, -0.15114218354734577, -0.15829522954901623, 461.9659701664055),
            6.0,
            {"contact": sc.Coulomb(0.3)},
            -0.08965011874825976,
        ),
        (
            sc.Body(
                0.029211873666547872, 0.34518181434651724, 0.5824756414259248, fillet=0.43864668592354283
            ),
            (1.4365682768225256, -0.023563370518600964, 0.06880543185072152, 1441.8221949778547),
            0.263,
            {"losses": loss.DryContour(8.838444250416866e-05)},
            None,
        ),
    ],
)
def test_spins_of_hundreds_are_as_exact_in_lanes_as_claimed(body, y, t, how, w2):
    state = sc.State(*(np.array([x]) for x in y))
    found = sc.sweep.roll(body, state, t, want=("final", "end"), tol=1e-10, **how)
    if w2 is None:
        w2 = float(sc.roll(body, sc.State(*y), t, **how).event.state.w2)
    assert abs(float(found["w2"][0]) - w2) <= float(found["error"][0]) < 1e-3


@pytest.mark.parametrize("want", [(), "pose"])
@pytest.mark.parametrize("tol", [1e-6, 1e-8, 1e-10, 1e-12, 1e-13, None])
def test_a_step_whose_error_overflows_is_not_taken_for_the_best_of_steps(tol, want):
    # a step of a coin under a boundary layer gave NaN, with an error of inf/inf
    laws = (
        loss.RollingResistance(0.0005627393790316231)
        + loss.AirLinear(0.0013615041303707903)
        + loss.BoundaryLayer(0.020306243631767088)
    )
    start = sc.State(0.17834983405438287, 0.8423914174586884, 0.04921618599425541, 0.0)
    m = sc.roll(sc.Body(0.0, 0.25, 0.5), start, 5.0, losses=laws, tol=tol, want=want)
    # six tolerances give the same time
    assert m.status == Status.FACE
    assert abs(m.event.time - 0.70862253514309) <= m.error + 1e-13


@pytest.mark.parametrize(
    ("body", "y", "t", "tol"),
    [
        (
            sc.Body(0.4, 0.30333333333333334, 0.5),
            (0.6, 1.5694353235270642, 1e-300, 0.6277741294108257),
            15.6,
            1e-12,
        ),
        (
            sc.Body(0.8319751239117633, 0.4807275356026647, 0.5),
            (0.002748685103038512, 0.07561930405806452, 1e-300, 0.06291337986382954),
            6.4,
            1e-12,
        ),
    ],
)
def test_on_ice_a_contact_without_slip_stays_so_alone_and_in_lanes(body, y, t, tol):
    # a slip of 1e-303 has no direction for friction
    alone = sc.roll(body, sc.State(*y, slip=(0.0, 0.0)), t, contact=sc.Coulomb(0.0), tol=tol)
    status, end, theta, claim = swept(body, y, (0.0, 0.0), sc.Coulomb(0.0), t, tol=tol)
    assert status == alone.status == Status.DONE and end == t
    assert abs(theta - alone.theta[-1]) <= claim + alone.error < 1e-10


@pytest.mark.parametrize(
    ("body", "y", "slip", "t", "how", "most"),
    [
        # needed 232,389,889 evaluations
        (
            sc.Body(0.0, 0.11735334731610608, 0.023067016723355996),
            (0.4, -0.4, -0.08909648968603268, 4.369932837733929),
            None,
            18.3,
            {"contact": "smooth", "losses": loss.RollingResistance(0.04810842865165527), "tol": 1e-10},
            100_000,
        ),
        # needed 1,551,452 evaluations
        (
            sc.Body(2.6151865659265146, 2.552233591534172, 0.545, fillet=0.10031688778549808),
            (0.00014078439500811825, 0.007425986543035423, 0.0, 0.019420340246097317),
            (-0.3, 0.7730193529901481),
            5.0,
            {
                "contact": sc.Coulomb(0.3),
                "losses": loss.Drilling(1.9751985437815757e-05) + loss.AirQuadratic(0.014980174701857885),
            },
            200_000,
        ),
    ],
    ids=["rolling resistance", "slip"],
)
def test_what_slips_or_rolls_slowly_makes_steps_as_long_as_its_turning_allows(body, y, slip, t, how, most):
    m = sc.roll(body, sc.State(*y, slip=slip), t, **how)
    assert m.nfev < most and m.error < 1e-4


@pytest.mark.parametrize(
    ("body", "y", "t", "how", "ending"),
    [
        # next to the table, the film of air acts on a time scale of 1e-20
        (
            sc.Body(0.685692958285332, 2.212008754136846, 3.6546096303762625, fillet=0.15078508000734803),
            (4.753132816155289e-08, -1.2102260381961927, 0.0, -0.7569381565983346),
            8.0,
            loss.RollingResistance(0.05347713631516657)
            + loss.AirQuadratic(0.005271325595472984)
            + loss.AirFilm(0.01),
            Status.LIFT_OFF,
        ),
        # dry friction holds a contact whose psi' already follows its balance
        (
            sc.Body(1.9363696472641292, 1.6598424702819359, 0.82),
            (0.2, 0.003953762486301797, -0.2, -1.5),
            2.4,
            loss.DryContour(0.0003738083564251192) + loss.AirFilm(0.1),
            Status.FACE,
        ),
        # psi' follows its balance also with a loose tolerance
        (
            sc.Body(0.24385004674320976, 0.2698209484322219, 0.5),
            (1.9348539882762427e-08, 0.0002677850128302061, 1e-09, 6.529938789577679e-05),
            0.3,
            loss.ViscousContour(1e-5),
            Status.FACE,
        ),
    ],
    ids=["beside the table", "held", "settles"],
)
@pytest.mark.parametrize("tol", [1e-8, 1e-10, 1e-12])
def test_ends_that_one_way_missed_are_the_same_alone_and_in_lanes(body, y, t, how, ending, tol):
    alone = sc.roll(body, sc.State(*y), t, losses=how, tol=tol)
    status, end, _, claim = swept(body, y, (0.0, 0.0), "rolling", t, losses=how, tol=tol)
    assert status == alone.status == ending
    assert abs(end - alone.event.time) <= claim + alone.error < 1e-3


@pytest.mark.parametrize(
    ("body", "y", "slip", "c", "how"),
    [
        (
            sc.Body(0.04909610894401672, 0.2508034759711476, 0.5),
            (9.8681320280115e-05, -0.07716175518141177, 0.5, 0.6166577136691572),
            (0.1, 0.0),
            0.15577988761285289,
            loss.DryContour(1e-06) + loss.RollingResistance(0.001) + loss.AirFilm(0.001214754214928006),
        ),
        (
            sc.Body(3.0, 3.25, 0.5),
            (0.0003176544296162918, 0.009882357939336865, 0.0, 0.029647073818010593),
            (-0.023468850126278334, 0.0),
            0.12789227062254616,
            loss.DryContour(2.318440018072221e-06)
            + loss.ViscousContour(0.0010171407253487812)
            + loss.RollingResistance(0.0001)
            + loss.Drilling(0.001)
            + loss.AirLinear(9.601649233491394e-05)
            + loss.AirQuadratic(6.345476235740972e-05)
            + loss.AirFilm(1.5777258901565813e-06)
            + loss.BoundaryLayer(0.0005599349419265893),
        ),
    ],
    ids=["in 6 ns", "in 35 ms"],
)
def test_dry_friction_stops_a_contact_that_slips_and_has_settled(body, y, slip, c, how):
    # with tol=1e-14 no contact is treated as settled: its stop is found like any other event
    followed, *others = (
        sc.roll(body, sc.State(*y, slip=slip), 1.0, contact=sc.Viscous(c), losses=how, tol=tol)
        for tol in (1e-14, 1e-12, 1e-10, 1e-8)
    )
    for m in (followed, *others):
        assert m.status == followed.status == Status.FACE
        assert abs(m.event.time - followed.event.time) <= m.error + followed.error < 1e-4


@pytest.mark.parametrize("tol", [1e-14, 1e-13, 1e-12, 1e-11, 1e-10])
def test_a_contact_that_was_held_in_a_slip_is_held_when_the_slip_has_stopped(tol):
    m = sc.roll(
        sc.Body.solid(0.119285152792179),
        sc.State(0.9059902507779121, 0.6219881278562983, 0.34683721237633536, -0.7426062971192557),
        20.0,
        contact=sc.Coulomb(0.746306488427682),
        losses=loss.DryContour(0.03960944558104031),
        restitution=0.5,
        tol=tol,
    )
    assert [phase.kind for phase in m.phases[-2:]] == ["rolling", "on its face"]
    assert abs(m.phases[-1].time - 8.19635127549) <= m.error + 1e-11


@pytest.mark.parametrize(
    ("thickness", "y", "slip", "height", "lift", "mu", "how"),
    [
        (
            0.05412793000722732,
            (1.2474352710291123, 1.8115949106916025, -0.4309219891747021, 1.1463922675368632),
            (-0.9872165616736284, 0.13679415715852514),
            0.6463173657213781,
            -0.385999917429227,
            0.40220385248428564,
            loss.AirFilm(0.0649224127944282),
        ),
        (
            0.0854,
            (0.8146563589225808, -1.6876720729753727, -1.2779505702009872, -2.0957046229640186),
            (1.004576977749208, 1.9515774279319218),
            3.6,
            -0.7974293923426726,
            0.35472708553273147,
            loss.DryContour(0.03542110906303193),
        ),
    ],
    ids=["200 flights", "150 flights"],
)
def test_bounces_without_a_loss_of_their_own_die_out_by_the_friction_of_each_and_the_motion_goes_on(
    thickness, y, slip, height, lift, mu, how
):
    # each impact reverses the slip that the flight before has caused: the next bounce is lower by that heat
    start = sc.State(*y, slip=slip, height=height, lift=lift)
    m = sc.roll(sc.Body.solid(thickness), start, 40.0, contact=sc.Coulomb(mu), restitution=1.0, losses=how)
    assert m.status != Status.BOUNDED
    assert any(impact.stays for impact in m.impacts)
    assert m.error < 1e-6


def test_a_phase_that_one_tolerance_tells_and_another_does_not_is_an_error_of_its_length():
    m = sc.roll(
        sc.Body(0.8131976158467542, 0.4, 0.38904084473713263),
        sc.State(0.6, 0.0, 0.0, 0.0, slip=(0.0, 0.3099577510547795)),
        50.0,
        contact=sc.Coulomb(0.28807405694773425),
        losses=loss.RollingResistance(0.0001)
        + loss.AirLinear(0.01048344427802547)
        + loss.AirQuadratic(0.0030188125177513063),
    )
    assert len(m.phases) > 100 and m.error < 1e-8


@pytest.mark.parametrize("w2", [0.0, 1e-300, 1e-9, -1e-6])
def test_what_is_all_but_a_ball_and_falls_claims_what_it_is_off_by(w2):
    body = sc.Body(0.0, 2.6, 4.9190078557879975, fillet=0.9999938761874614)
    m = sc.roll(body, sc.State(0.8, 0.0, w2, 0.0), 50.0)
    stepped = sc.roll(body, sc.State(0.8, 0.0, w2, 0.0), 50.0, tol=1e-13)
    assert abs(m.theta - stepped.theta).max() <= m.error + stepped.error < 1e-10


def test_the_time_of_a_side_that_lands_slowly_is_as_uncertain_as_claimed():
    body = sc.Body(2.7593269570930747, 2.7879617520468423, 0.5)
    y = (1.5706181100472716, 1.4144225930920205, 1e-300, 3.902854389840301)
    how = {"mu": 0.1, "losses": loss.AirQuadratic(0.00011775438853757546)}
    alone = sc.roll(body, sc.State(*y), 4.9, t0=0.0, tol=1e-12, **how)
    status, end, _, claim = swept(body, y, (0.0, 0.0), "rolling", 4.9, tol=1e-12, **how)
    best = sc.roll(body, sc.State(*y), 4.9, t0=0.0, **how)
    assert status == alone.status == best.status == Status.SIDE
    assert abs(end - best.event.time) <= claim + best.error < 1e-7
    assert abs(alone.event.time - best.event.time) <= alone.error + best.error < 1e-7
