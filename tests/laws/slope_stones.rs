//! Stones on a slope: the energy, a stone that is a ball, mirror images, and stones that stay at rest.

use crate::common::{cases, larger};
use crate::stone::{any_start, any_stone};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use proptest::prelude::*;
use spincyl::contact::Friction;
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::Kind;
use spincyl::motion::{Ask, Ending, Motion, Start, roll_with};
use spincyl::stone::{self, Ellipsoid, StoneState};
use spincyl::{Body, Contact, Slip, State};

fn rolled(
    stone: &Ellipsoid,
    start: impl Into<Start<StoneState>>,
    times: &[f64],
    ask: &Ask,
) -> Motion<StoneState> {
    stone::roll(stone, start, times, &ask.with_pose().with_force(), || true).unwrap().unwrap()
}

/// The velocity of the slip in the laboratory of the pose, from the components of the outputs.
fn slip_in_space(m: &Motion<StoneState>, i: usize) -> Vector3<f64> {
    let slip = m.path.as_ref().and_then(|path| path.slip.get(i)).copied().unwrap_or_default();
    let up = Vector3::from(m.states[i].vertical);
    let upright = UnitQuaternion::rotation_between(&up, &Vector3::z()).unwrap();
    m.poses.as_ref().unwrap()[i].orientation * (upright.inverse() * Vector3::new(slip.u_h, slip.u_2, 0.0))
}

/// The energy at output `i` with the gravity of the slope, from the pose, and all that was lost until then.
fn total(stone: &Ellipsoid, m: &Motion<StoneState>, slope: f64, i: usize) -> f64 {
    let (y, pose) = (m.states[i], m.poses.as_ref().unwrap()[i]);
    let w = Vector3::from(y.w);
    let centre = Vector3::from(pose.centre);
    let arm = Vector3::new(pose.contact_point.x, pose.contact_point.y, 0.0) - centre;
    let v = slip_in_space(m, i) - (pose.orientation * w).cross(&arm);
    let inertia = Matrix3::from_fn(|i, j| stone.inertia()[i][j]);
    let moving = 0.5 * (w.dot(&(inertia * w)) + v.norm_squared());
    let path = m.path.as_ref();
    let heat = path.and_then(|path| path.dissipated.get(i)).unwrap_or(&0.0);
    let lost = path.and_then(|path| path.work_lost.get(i)).unwrap_or(&0.0);
    moving + slope.cos() * centre.z - slope.sin() * centre.x + heat + lost
}

const TIMES: [f64; 4] = [0.0, 0.7, 1.9, 3.0];

fn any_loss() -> impl Strategy<Value = Losses> {
    let of = |law: Law, most: f64| (0.1 * most..most).prop_map(move |x| Losses::of(law, x));
    prop_oneof![
        2 => Just(Losses::NONE),
        1 => of(Law::RollingResistance, 0.05),
        1 => of(Law::AirLinear, 0.1),
        1 => of(Law::Drilling, 0.1),
        1 => (0.001..0.05f64, 0.001..0.1f64).prop_map(|(rolling, air)| {
            Losses::of(Law::RollingResistance, rolling).with(Law::AirQuadratic, air)
        }),
    ]
}

fn any_table() -> impl Strategy<Value = Ask> {
    prop_oneof![
        2 => (0.0..0.9f64).prop_map(|mu| Ask::on(Friction::coulomb(mu))),
        1 => (0.1..0.6f64).prop_map(|mu| Ask::on(Friction::Coulomb { mu, fixed: 1.5 * mu, patch: 0.0 })),
        1 => (0.1..0.6f64, 0.001..0.1f64)
            .prop_map(|(mu, patch)| Ask::on(Friction::Coulomb { mu, fixed: mu, patch })),
        1 => (0.05..2.0f64).prop_map(|c| Ask::on(Friction::Viscous { c })),
        1 => Just(Ask::on(Contact::Rolling)),
    ]
}

proptest! {
    #![proptest_config(cases(96))]

    #[test]
    fn energy_with_the_gravity_of_the_slope_and_what_is_lost_are_constant(
        stone in any_stone(),
        state in any_start(),
        slip in [-1.0..1.0f64, -1.0..1.0f64],
        (ask, losses) in (any_table(), any_loss()),
        slope in -1.2..1.2f64,
        heading in -3.0..3.0f64,
    ) {
        let ask = ask.with_losses(losses).with_slope(slope);
        let start = Start::from(state).with_heading(heading).with_place([0.3, -0.7]);
        let start = if ask.table == Contact::Rolling.into() { start } else { start.with_slip(slip.into()) };
        let Ok(Some(m)) = stone::roll(&stone, start, &TIMES, &ask.with_pose(), || true) else {
            return Ok(()); // no unique force at the start
        };
        let most = 1e-10_f64.max(10.0 * m.error);
        for i in 1..m.states.len() {
            let [now, then] = [i, 0].map(|i| total(&stone, &m, slope, i));
            let size = m.states[i].w.iter().fold(1.0, |most: f64, w| most.max(w.abs()));
            prop_assert!((now - then).abs() < most * size, "{}: {} {}, {:e}", i, now, then, m.error);
        }
    }

    #[test]
    fn the_mirror_image_of_a_motion_is_a_motion(
        stone in any_stone(),
        state in any_start(),
        slip in [-1.0..1.0f64, -1.0..1.0f64],
        slope in -0.9..0.9f64,
        (mu, rolling) in (0.05..0.8f64, 0.0..0.02f64),
        heading in -3.0..3.0f64,
    ) {
        // The mirror is the plane y = 0, and that of the axes 1 and 3.
        let ([a, b, c], [x, y, z]) = (stone.axes(), stone.offset());
        let mut inertia = stone.inertia();
        for (i, j) in [(0, 1), (1, 0), (1, 2), (2, 1)] {
            inertia[i][j] = -inertia[i][j];
        }
        let other = Ellipsoid::new([a, b, c], inertia, [x, -y, z]).unwrap();
        let ([n1, n2, n3], [w1, w2, w3]) = (state.vertical, state.w);
        let image = StoneState { vertical: [n1, -n2, n3], w: [-w1, w2, -w3] };
        let losses = Losses::NONE.with(Law::RollingResistance, rolling);
        let ask = Ask::on(Friction::coulomb(mu)).with_losses(losses).with_slope(slope).with_pose();
        let start = Start::from(state).with_slip(slip.into()).with_heading(heading).with_place([0.2, 0.5]);
        let back = Start::from(image).with_slip(Slip::new(slip[0], -slip[1])).with_heading(-heading);
        let here = stone::roll(&stone, start, &TIMES, &ask, || true);
        let there = stone::roll(&other, back.with_place([0.2, -0.5]), &TIMES, &ask, || true);
        let (Ok(Some(here)), Ok(Some(there))) = (here, there) else { return Ok(()) };
        prop_assert_eq!(here.ending(), there.ending());
        let most = 1e-11 + here.error + there.error;
        for (i, (a, b)) in here.states.iter().zip(&there.states).enumerate() {
            let image = StoneState {
                vertical: [b.vertical[0], -b.vertical[1], b.vertical[2]],
                w: [-b.w[0], b.w[1], -b.w[2]],
            };
            prop_assert!(crate::stone::apart(a, &image) < most, "{}", i);
            let [p, q] = [&here, &there].map(|m| m.poses.as_ref().unwrap()[i].centre);
            let off = (p[0] - q[0]).abs().max((p[1] + q[1]).abs()).max((p[2] - q[2]).abs());
            prop_assert!(off < 1e-11 + here.pose_error + there.pose_error, "{}: {:e}", i, off);
        }
    }
}

#[test]
fn a_stone_that_is_a_ball_moves_as_a_ball_on_the_same_slope() {
    let (ell, slope, times) = (-0.2, 0.25f64, [0.0, 0.4, 1.1, 2.0, 3.0]);
    let ball = Body::ball(ell, 0.35, 0.4).unwrap();
    let inertia = [[0.35, 0.0, 0.0], [0.0, 0.35, 0.0], [0.0, 0.0, 0.4]];
    let stone = Ellipsoid::new([1.0; 3], inertia, [0.0, 0.0, ell]).unwrap();
    let y = State { theta: 1.1, w1: 0.5, w2: -0.3, w3: 1.2 };
    let (s, c) = y.theta.sin_cos();
    let same = StoneState { vertical: [s, 0.0, c], w: [y.w1, y.w2, y.w3] };
    let tables = [
        (Ask::on(Friction::coulomb(0.12)), [0.5, -0.4], Kind::Slipping),
        (Ask::on(Friction::Viscous { c: 0.3 }), [0.5, -0.4], Kind::Slipping),
        (Ask::on(Friction::coulomb(0.3)), [0.5, -0.4], Kind::Rolling),
        (Ask::on(Contact::Rolling), [0.0; 2], Kind::Rolling),
        (Ask::on(Contact::Smooth), [0.0; 2], Kind::Slipping),
    ];
    for (ask, slip, ends) in tables {
        let ask = ask.with_slope(slope).with_pose();
        let begins = |heading| (heading, [0.4, 0.9]);
        let (heading, place) = begins(0.8);
        let start = Start::from(y).with_slip(slip.into()).with_heading(heading).with_place(place);
        let a = roll_with(&ball, start, &times, &ask, || true).unwrap().unwrap();
        let start = Start::from(same).with_slip(slip.into()).with_heading(heading).with_place(place);
        let b = rolled(&stone, start, &times, &ask);
        for i in 0..times.len() {
            let (y, other) = (a.states[i], b.states[i]);
            let ((s, c), [n, w]) = (y.theta.sin_cos(), [other.vertical, other.w].map(Vector3::from));
            let off = [
                c - n.z,
                y.w3 - w.z,
                s * y.w1 + c * y.w3 - n.dot(&w),
                y.w1 * y.w1 + y.w2 * y.w2 + y.w3 * y.w3 - w.norm_squared(),
            ];
            assert!(off.iter().all(|x| x.abs() < 1e-11), "{ends:?} {i}: {off:?}");
            let [p, q] =
                [a.poses.as_ref().unwrap()[i].contact_point, b.poses.as_ref().unwrap()[i].contact_point];
            assert!((p - q).amax() < 1e-11, "{ends:?} {i}: {p} {q}");
            if let (Some(path), true) = (&a.path, ask.table != Contact::Smooth.into()) {
                let (u, phi) = (path.slip[i], a.poses.as_ref().unwrap()[i].phi.radians());
                let along = Vector3::new(phi.cos(), phi.sin(), 0.0) * u.u_h;
                let over = along + Vector3::new(-phi.sin(), phi.cos(), 0.0) * u.u_2;
                assert!((over - slip_in_space(&b, i)).amax() < 1e-11, "{ends:?} {i}");
            }
        }
        if let (Some(a), Some(b)) = (&a.path, &b.path) {
            assert_eq!(b.phases.last().unwrap().kind, ends);
            assert_eq!(a.phases.len(), b.phases.len());
            for (a, b) in a.phases.iter().zip(&b.phases) {
                assert!((a.time - b.time).abs() < 1e-11);
            }
        }
    }
}

#[test]
fn a_ball_rolls_down_as_a_block_with_the_coefficient_of_its_rolling_resistance_or_rests() {
    let ball = Ellipsoid::uniform([1.0; 3]).unwrap();
    let still = StoneState { vertical: [0.0, 0.6, 0.8], w: [0.0; 3] };
    let (delta, t) = (0.1f64, 3.0);
    for (slope, rests) in [(delta.atan() - 1e-6, true), (delta.atan() + 1e-6, false), (0.3, false)] {
        for table in [Ask::on(Contact::Rolling), Ask::on(Friction::coulomb(0.5))] {
            let ask = table.with_losses(Losses::of(Law::RollingResistance, delta)).with_slope(slope);
            let m = rolled(&ball, still, &[0.0, t], &ask);
            assert_eq!(m.ending() == Ending::Stops, rests, "{slope}: {:?}", m.ending());
            if !rests {
                let gone = m.poses.as_ref().unwrap()[1].centre[0];
                let expected = 0.5 * t * t * (slope.sin() - delta * slope.cos()) / 1.4;
                assert!((gone - expected).abs() < 1e-11, "{gone} {expected}");
            }
        }
    }
    // It slips off where friction is too small to hold what rolling resistance holds.
    let (slope, mu) = (0.09f64, 0.05);
    let ask = Ask::on(Friction::coulomb(mu)).with_losses(Losses::of(Law::RollingResistance, delta));
    let m = rolled(&ball, still, &[0.0, t], &ask.with_slope(slope));
    let gone = m.poses.as_ref().unwrap()[1].centre[0];
    assert!((gone - 0.5 * t * t * (slope.sin() - mu * slope.cos())).abs() < 1e-11, "{gone}");
    assert!(m.states[1].w.iter().all(|w| w.abs() < 1e-11), "{:?}", m.states[1]);
}

#[test]
fn a_ball_thrown_uphill_that_friction_does_not_hold_slips_back_where_its_rolling_has_stopped() {
    // Rolling resistance brakes with delta > mu_s: rolling needs less friction than rest.
    let ball = Ellipsoid::uniform([1.0; 3]).unwrap();
    let uphill = StoneState { vertical: [0.0, 0.0, 1.0], w: [0.0, -0.5, 0.0] };
    let (delta, mu, slope) = (0.2, 0.15, 0.18f64);
    let ask = Ask::on(Friction::coulomb(mu)).with_losses(Losses::of(Law::RollingResistance, delta));
    let m = rolled(&ball, uphill, &[0.0, 1.0, 4.0], &ask.with_slope(slope));
    assert_eq!(m.states.len(), 3, "{:?}", m.ending());
    let kinds: Vec<Kind> = m.path.as_ref().unwrap().phases.iter().map(|phase| phase.kind).collect();
    assert_eq!(kinds.last(), Some(&Kind::Slipping), "{kinds:?}");
    for i in 0..3 {
        assert!((total(&ball, &m, slope, i) - total(&ball, &m, slope, 0)).abs() < 1e-11, "{i}");
    }
}

#[test]
fn a_stone_that_rolling_resistance_holds_upright_swings_about_the_vertical_like_a_pendulum() {
    // Its centre of mass lies beside the contact point, across the slope: the pull turns it downhill.
    let (slope, beside) = (0.1f64, 0.05);
    let stone =
        Ellipsoid::new([1.0; 3], [[0.4, 0.0, 0.0], [0.0, 0.4, 0.0], [0.0, 0.0, 0.4]], [0.0, beside, 0.0])
            .unwrap();
    let still = StoneState { vertical: [0.0, 0.0, 1.0], w: [0.0; 3] };
    let ask = Ask::on(Friction::coulomb(0.5)).with_losses(Losses::of(Law::RollingResistance, 0.3));
    let times: Vec<f64> = (0..=60).map(|k| 2.0 * f64::from(k)).collect();
    let m = rolled(&stone, still, &times, &ask.with_slope(slope));
    assert_eq!(m.states.len(), times.len(), "{:?}", m.ending());
    let about = 0.4 + beside * beside;
    let mut fastest = 0f64;
    for (i, y) in m.states.iter().enumerate() {
        let centre = m.poses.as_ref().unwrap()[i].centre;
        assert!((0.5 * about * y.w[2] * y.w[2] - slope.sin() * centre[0]).abs() < 1e-12, "{i}");
        assert!(y.vertical[2] > 1.0 - 1e-14 && (centre[0].hypot(centre[1]) - beside).abs() < 1e-12, "{i}");
        fastest = fastest.max(y.w[2].abs());
    }
    assert!(fastest > 0.9 * (2.0 * slope.sin() * beside / about).sqrt());
    // Let go with the centre below the contact point, it rests.
    let m = rolled(
        &stone,
        Start::from(still).with_heading(-0.5 * std::f64::consts::PI),
        &times,
        &ask.with_slope(slope),
    );
    assert!(m.states.iter().all(|y| y.w[2].abs() < 1e-9), "{:?}", m.ending());
}

#[test]
fn a_heading_turns_a_motion_on_a_level_table_and_nothing_else() {
    let stone = Ellipsoid::rattleback([1.0, 0.3, 0.25], None, 0.1, None).unwrap();
    let state = stone.spinning(-0.5, 0.3, 0.1);
    let ask = Ask::on(Friction::coulomb(0.2)).with_force();
    let turn = 0.9f64;
    let start = Start::from(state).with_slip(Slip::new(0.3, 0.5));
    let a = rolled(&stone, start, &TIMES, &ask);
    let b = rolled(&stone, start.with_heading(turn).with_place([3.0, -1.0]), &TIMES, &ask);
    let about = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), turn);
    for i in 0..a.states.len() {
        assert!(crate::stone::apart(&a.states[i], &b.states[i]) < 1e-11);
        let [p, q] = [&a, &b].map(|m| Vector3::from(m.poses.as_ref().unwrap()[i].centre));
        assert!((about * p + Vector3::new(3.0, -1.0, 0.0) - q).amax() < 1e-11);
        let [f, g] = [&a, &b].map(|m| m.forces.as_ref().unwrap()[i]);
        assert!((about * f - g).amax() < 1e-10);
        let [u, v] = [&a, &b].map(|m| slip_in_space(m, i));
        assert!((about * u - v).amax() < 1e-11);
    }
}

#[test]
fn a_pebble_rolls_and_slips_as_the_reference_of_25_digits_says() {
    // The rows of `tests/reference/slope.json` are of equations in the laboratory frame.
    let inertia = [[0.2, 0.02, -0.03], [0.02, 0.26, 0.015], [-0.03, 0.015, 0.3]];
    let stone = Ellipsoid::new([1.0, 0.8, 0.6], inertia, [0.1, -0.05, -0.12]).unwrap();
    let from = |n: [f64; 3], w| StoneState { vertical: Vector3::from(n).normalize().into(), w };
    let off = |m: &Motion<StoneState>, state: [f64; 6], force: [f64; 3]| {
        let (y, f) = (m.states[0], m.forces.as_ref().unwrap()[0]);
        let found = [&y.vertical[..], &y.w[..], f.as_slice()].concat();
        found.iter().zip(state.iter().chain(&force)).fold(0f64, |most, (a, b)| larger(most, (a - b).abs()))
    };
    let ask = Ask::on(Contact::Rolling).with_slope(0.2);
    let m = rolled(&stone, from([0.3, -0.2, 0.9], [0.2, 0.1, 0.5]), &[6.0], &ask);
    let state = [
        -0.332_146_014_764_747_7,
        -0.268_041_259_009_243_36,
        0.904_341_145_997_811_9,
        -0.894_228_375_103_558_4,
        0.721_557_562_629_909_8,
        0.580_841_461_520_976_4,
    ];
    let force = [-0.264_382_244_710_484_6, 0.232_541_980_655_767_96, 1.271_997_217_081_546];
    assert!(off(&m, state, force) < 1e-11, "{m:?}");
    let start = Start::from(from([0.1, -0.05, 1.0], [0.1, 0.2, -0.3])).with_slip(Slip::new(0.3, -0.1));
    let m = rolled(&stone, start, &[1.2], &Ask::on(Friction::coulomb(0.3)).with_slope(0.2));
    let state = [
        -0.508_843_970_454_260_2,
        0.222_269_636_949_412_02,
        0.831_669_418_833_421_3,
        0.350_857_397_445_626,
        0.350_290_348_922_100_2,
        -0.239_212_435_154_932_44,
    ];
    let force = [-0.236_205_655_012_951_1, 0.085_669_351_283_400_97, 0.837_538_385_252_454_7];
    assert!(off(&m, state, force) < 1e-11, "{m:?}");
    let phases = &m.path.as_ref().unwrap().phases;
    assert!((phases[1].time - 0.505_882_583_136_179_2).abs() < 1e-11, "{phases:?}");
    assert!((phases[2].time - 0.879_911_969_369_586_5).abs() < 1e-11, "{phases:?}");
}
