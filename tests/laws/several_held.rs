//! Rotations that begin, or come to rest, where dry friction resists several of them at once.
//!
//! The sum of energy, heat and work lost is constant; and a body is at rest where its motion ends with `STOPS`.

use crate::common::{drawn, larger, path_of, wander};
use nalgebra::{UnitQuaternion, Vector3};
use spincyl::contact::{Friction, slip};
use spincyl::loss::{Law, Losses};
use spincyl::motion::{Ask, Ending, Motion, Moving, roll_with};
use spincyl::stone::{self, Ellipsoid, StoneState};
use spincyl::{Body, Slip, State, nalgebra};

/// The rotations that are at rest at the start, in addition to the slip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rest {
    /// The whole body is at rest.
    All,
    Contour,
    Drilling,
    /// Rolling and rocking are at rest: the body only turns about the vertical.
    Rolling,
}

/// A random number between `low` and `high`, uniform in its logarithm.
fn between(r: &mut impl FnMut() -> f64, low: f64, high: f64) -> f64 {
    low * (high / low).powf(r())
}

/// Random dry loss laws: the law `first` always, each of the others in a third of the cases.
fn dry(r: &mut impl FnMut() -> f64, first: Law, contour: bool) -> Losses {
    let mut all = Losses::NONE;
    for law in [Law::RollingResistance, Law::DryContour, Law::Drilling] {
        let (there, coefficient) = (r() < 1.0 / 3.0, between(r, 1e-3, 0.1));
        if law == first || there && (contour || law != Law::DryContour) {
            all = all + Losses::of(law, coefficient);
        }
    }
    all
}

fn friction(r: &mut impl FnMut() -> f64) -> Friction {
    let mu = between(r, 0.02, 0.4);
    let more = if r() < 0.25 { 1.0 + 0.5 * r() } else { 1.0 };
    Friction::Coulomb { mu, fixed: mu * more, patch: 0.0 }
}

/// A random speed: about twice a normal variable.
fn speed(r: &mut impl FnMut() -> f64) -> f64 {
    1.2 * (r() + r() + r() - 1.5)
}

pub fn body_at_rest(k: u64, rest: Rest) -> (Body, State, Ask) {
    let mut r = wander(k);
    let i1 = between(&mut r, 0.2, 0.6);
    let (body, theta) = match (4.0 * r()) as u32 {
        0 => {
            let i3 = i1 * (0.6 + r());
            (Body::rounded(1.4 * r() - 0.7, i1, i3, 1.0).unwrap(), 0.2 + 2.7 * r())
        }
        1 => (Body::solid(between(&mut r, 0.1, 3.0)).unwrap(), 0.1 + 1.4 * r()),
        2 => (Body::tube(between(&mut r, 0.1, 3.0), r()).unwrap(), 0.1 + 1.4 * r()),
        _ => (Body::rounded(2.0 * r(), i1, i1 * (0.6 + r()), 0.9 * r()).unwrap(), 0.1 + 1.4 * r()),
    };
    let ((s, c), [w1, w2, w3]) = (f64::sin_cos(theta), [speed(&mut r), speed(&mut r), speed(&mut r)]);
    let [w1, w2, w3] = match rest {
        Rest::All => [0.0; 3],
        Rest::Contour => [w1, w2, c / s * w1],
        Rest::Drilling => [w1, w2, -(s / c * w1)],
        Rest::Rolling => [s * w3, 0.0, c * w3],
    };
    let first = match rest {
        Rest::All | Rest::Rolling => Law::RollingResistance,
        Rest::Contour => Law::DryContour,
        Rest::Drilling => Law::Drilling,
    };
    let ask = Ask::on(friction(&mut r)).with_losses(dry(&mut r, first, true));
    (body, State { theta, w1, w2, w3 }, ask)
}

pub fn stone_at_rest(k: u64, rest: Rest) -> (Ellipsoid, StoneState, Ask) {
    let mut r = wander(k);
    let axes = [1.0, between(&mut r, 0.2, 1.0), between(&mut r, 0.15, 1.0)];
    let stone = if r() < 0.5 {
        Ellipsoid::rattleback(axes, None, 0.4 * r() - 0.2, None).unwrap()
    } else {
        Ellipsoid::uniform(axes).unwrap()
    };
    let spin = if r() < 0.25 { 0.0 } else { 1.5 * speed(&mut r) };
    let mut start = stone.spinning(spin, 0.5 * r(), 0.5 * r());
    let (w, n) = (Vector3::new(speed(&mut r), speed(&mut r), speed(&mut r)), Vector3::from(start.vertical));
    match rest {
        Rest::All => start.w = [0.0; 3],
        Rest::Drilling => start.w = (w - n * w.dot(&n)).into(),
        _ => (),
    }
    let first = if rest == Rest::Drilling { Law::Drilling } else { Law::RollingResistance };
    (stone, start, Ask::on(friction(&mut r)).with_losses(dry(&mut r, first, false)).with_pose())
}

const TIMES: [f64; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];

/// The sum of energy, heat and work lost at each time of a body's motion.
fn sums(body: &Body, motion: &Motion) -> Vec<f64> {
    let path = path_of(motion);
    let energy = |i: usize| slip::energy(body, &motion.states[i], path.slip[i]);
    (0..motion.states.len()).map(|i| energy(i) + path.dissipated[i] + path.work_lost[i]).collect()
}

fn sums_of_stone(stone: &Ellipsoid, motion: &Motion<StoneState>) -> Vec<f64> {
    let path = motion.path.as_ref().unwrap();
    let energy = |i: usize| {
        let y = &motion.states[i];
        let up = UnitQuaternion::rotation_between(&Vector3::from(y.vertical), &Vector3::z())
            .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), core::f64::consts::PI));
        let (w, r) = (Vector3::from(y.w), Vector3::from(stone.lowest_point(y.vertical)));
        let Slip { u_h: u, u_2: v, .. } = path.slip[i];
        let v = up.inverse() * Vector3::new(u, v, 0.0) - w.cross(&r);
        let tensor = nalgebra::Matrix3::from(stone.inertia());
        0.5 * (w.dot(&(tensor * w)) + v.norm_squared()) - r.dot(&Vector3::from(y.vertical))
    };
    (0..motion.states.len()).map(|i| energy(i) + path.dissipated[i] + path.work_lost[i]).collect()
}

/// Whether the sums change by more than the estimated error of the motion allows.
fn out<S: Moving>(sums: &[f64], motion: &Motion<S>) -> bool {
    let off = sums.iter().map(|sum| (sum - sums[0]).abs()).fold(0.0, larger);
    off.is_nan() || off > 3.0 * motion.error + 1e-12
}

/// A description of what is wrong with the motion of case `k`: its energy changes, it ends with `STOPS` while it
/// moves, or its computation stops early; None if nothing is.
pub fn wrong_with_body(k: u64, rest: Rest) -> Option<String> {
    let (body, start, ask) = body_at_rest(k, rest);
    let motion = match roll_with(&body, start, &TIMES, &ask, || true) {
        Ok(motion) => motion.unwrap(),
        Err(error) => return Some(format!("{k}: {error}")),
    };
    let moves = |y: &State| y.w1.abs().max(y.w2.abs()).max(y.w3.abs()) > 1e-9;
    judged(k, &sums(&body, &motion), &motion, moves)
}

pub fn wrong_with_stone(k: u64, rest: Rest) -> Option<String> {
    let (stone, start, ask) = stone_at_rest(k, rest);
    let motion = match stone::roll(&stone, start, &TIMES, &ask, || true) {
        Ok(motion) => motion.unwrap(),
        Err(error) => return Some(format!("{k}: {error}")),
    };
    let moves = |y: &StoneState| y.w.iter().any(|w| w.abs() > 1e-9);
    judged(k, &sums_of_stone(&stone, &motion), &motion, moves)
}

fn judged<S: Moving>(k: u64, sums: &[f64], motion: &Motion<S>, moves: impl Fn(&S) -> bool) -> Option<String> {
    let ended = motion.event.as_ref().map(|end| (end.ending, end.time));
    let stops = motion.event.as_ref().is_some_and(|end| end.ending == Ending::Stops && moves(&end.state));
    let gives_up = ended.is_some_and(|(ending, _)| ending == Ending::Bounded);
    (out(sums, motion) || stops || gives_up).then(|| {
        let off = sums.iter().map(|sum| (sum - sums[0]).abs()).fold(0.0, larger);
        format!("{k}: out by {off:e} of {:e}, {ended:?}", motion.error)
    })
}

fn none_is_wrong(wrong: impl Fn(u64) -> Option<String>) {
    let found: Vec<String> = (0..drawn(120) as u64).filter_map(wrong).collect();
    assert!(found.is_empty(), "{} wrong: {}", found.len(), found.join("\n"));
}

#[test]
fn a_body_let_go_slips_and_rolls_as_all_its_resistances_let_it_together() {
    none_is_wrong(|k| wrong_with_body(k, Rest::All));
}

#[test]
fn a_body_whose_contact_rests_on_the_rim_slips_and_turns_as_both_resistances_let_it() {
    none_is_wrong(|k| wrong_with_body(k, Rest::Contour));
}

#[test]
fn a_body_that_does_not_drill_slips_and_drills_as_both_resistances_let_it() {
    none_is_wrong(|k| wrong_with_body(k, Rest::Drilling));
}

#[test]
fn a_body_that_spins_on_the_spot_stays_there_or_leaves_in_balance() {
    none_is_wrong(|k| wrong_with_body(k, Rest::Rolling));
}

#[test]
fn a_stone_let_go_slips_and_rolls_as_all_its_resistances_let_it_together() {
    none_is_wrong(|k| wrong_with_stone(k, Rest::All));
}

#[test]
fn a_stone_that_spins_on_the_spot_stays_there_or_leaves_in_balance() {
    none_is_wrong(|k| wrong_with_stone(k, Rest::Rolling));
}

#[test]
fn a_stone_that_does_not_drill_slips_and_drills_as_both_resistances_let_it() {
    none_is_wrong(|k| wrong_with_stone(k, Rest::Drilling));
}
