//! Integrates the slow drift of a body that rolls without slipping and without nutation.
//!
//! ```text
//! (theta, Omega, w3, t) along the path x of `circular`
//! kappa = 0,   theta = theta_end,   psi' = 0,   w_z = 0              margins that turn negative
//! ```
//! [`flow`](crate::methods::flow) takes the steps and finds the ends. The steps go on until the time per
//! e-fold of the inclination is below rounding, or theta below 1e-140; `tail` describes the rest.
//!
//! Error: 1e-10 of the time; up to 0.99 of the time also of theta, w1 and Omega, and of w3 over |w|. `test_late_drifts`
//! compares the drift with 20 digits, and `benches/drifts.py` with DOP853 on (theta, w1, w3).

use super::circular::{CirclePoint, Circular, Numbers, time_per_e_fold};
use super::ends::End;
use super::tail::Tail;
use crate::error::Error;
use crate::laws::body::Body;
use crate::laws::loss::{COUNT, Couples, Law, Losses, Resists};
use crate::laws::state::State;
use crate::methods::flow::{Flow, FlowPlace, Flown, PATIENCE, Steps, TOIL, TakenStep};
use crate::methods::rk8;
use crate::numbers::{Dual, Real, here};
use crate::states::stability;
use core::f64::consts::PI;
use std::cell::RefCell;

/// Allowed error of a step of the drift, relative to inclination, Omega, w3 and time.
const TOLERANCE: f64 = 1e-13;

/// The integration of a drift ends, and its tail begins, where the time per e-fold of the inclination falls below
/// this fraction of the time so far (tested only below the inclination `LOW`), and at the latest at the inclination
/// `LAST_INCLINATION`. If only the air takes energy, the face never lands, and the tail begins at the fraction
/// `FACE_LANDED` of the first inclination.
const TAIL_TIME_SHARE: f64 = 1e-16;
const LAST_INCLINATION: f64 = 1e-140;
const FACE_LANDED: f64 = 1e-11;
const LOW: f64 = 1e-3;

/// Inclination, in radians, below which the tail of a drift replaces a step that is too short: the tail is precise
/// enough there.
const NEARLY_FLAT: f64 = 1e-6;

/// An inclination above this, in radians, is counted from the other end of [0, pi]. The limit is above pi/2, so that
/// the counting does not change back and forth.
pub(crate) const COUNTED_FROM_PI_ABOVE: f64 = 1.8;

/// Greatest number of steps of one drift; a drift that needs more fails.
pub(crate) const MOST_DRIFT_STEPS: u64 = 5000;

/// Lengths of the first and of the longest step of a drift, in the path length x.
pub(crate) const STEPS: [f64; 2] = [0.02, 1.5];

/// The number of parameters that [`Rolling::numbers`] returns for the SIMD code.
pub(crate) const DRIFT_NUMBERS: usize = 7;
/// Number of margins: quantities whose zeros end a drift.
pub(crate) const DRIFT_MARGINS: usize = 4;

/// The end of a drift at the zero of each margin, in the order of the margins.
const DRIFT_ENDS: [End; DRIFT_MARGINS] =
    [End::StabilityLost, End::Side, End::ContactStops, End::DrillingStops];

/// The error of a step over its allowed error. The allowed error of theta, Omega and w3 is relative to the value or
/// to its change since the start, whichever is smaller, so that the time of a short drift is just as precise. That of
/// the time is relative to the time.
#[inline(always)]
pub(crate) fn error<T: Real, const N: usize>(start: &Numbers<T>, y: &[T; N], made: &rk8::Step<T, N>) -> T {
    let number = here(
        #[inline(always)]
        |x: f64| y[0].splat(x),
    );
    let tolerance = number(TOLERANCE);
    // Since w3 may vanish, its error is taken relative to a hundredth of w1 at least.
    let least = [number(0.0), number(0.0), y[0] * y[1] * number(1e-2), number(0.0)];
    made.error(
        #[inline(always)]
        |i| {
            let next = y[i] + made.change[i];
            let own = next.abs().max(y[i].abs()).max(least[i]);
            let moved = (next - start[i]).abs().max((y[i] - start[i]).abs());
            number(1.0) / (own.min(moved.max(own * number(1e-6))) * tolerance)
        },
        1.0,
    )
}

/// A quantity that is positive until the tail of a drift begins, where its integration ends.
#[inline(always)]
pub(crate) fn until_tail<T: Real, const N: usize>(y: &[T; N], rate: &[T; N], last: T) -> T {
    let number = here(
        #[inline(always)]
        |x: f64| last.splat(x),
    );
    let early = (y[0] - number(LOW)).max(time_per_e_fold(y, rate) - number(TAIL_TIME_SHARE) * y[3]);
    early.min(y[0] - last)
}

/// The shortest step of a drift at an inclination: a shorter one could only be due to rounding. Below `NEARLY_FLAT`
/// the limit is larger, since the tail is precise enough there.
#[inline(always)]
pub(crate) fn shortest<T: Real>(theta: T) -> T {
    theta.select_lt(theta.splat(NEARLY_FLAT), theta.splat(1e-4), theta.splat(1e-14))
}

/// The reasons for which the integration of a drift halts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum DriftHalt {
    /// A margin (a quantity whose zero ends the drift) has reached zero.
    Fails(End),
    /// The tail of the drift begins.
    Flat,
    /// The inclination must be counted from the other end of [0, pi].
    Turned,
    /// The allowed number of steps is taken.
    Pause,
    /// The time has become infinite.
    Over,
}

/// A step of a drift: the state at its beginning, its length in the path length x, the state at its end, and whether
/// theta is counted from 0 or pi.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DriftStep {
    pub from: FlowPlace<4>,
    pub h: f64,
    pub to: Numbers<f64>,
    pub far: f64,
}

/// The equations of a rolling body that drifts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rolling<'a> {
    pub of: Circular<f64>,
    margins: Margins<f64>,
    /// The equations and margins for dual numbers (a value and its slope).
    sloped: (Circular<Dual<f64>>, Margins<Dual<f64>>),
    start: Numbers<f64>,
    /// -1 where the inclination is counted from pi, else 1.
    pub far: f64,
    ball: bool,
    /// The list in which the steps of the drift are stored, if any.
    steps: Option<&'a RefCell<Vec<DriftStep>>>,
}

impl Rolling<'_> {
    /// The equations of the drift of a body, and the first inclination, Omega, w3 and time.
    pub fn begin(body: &Body, y: &State, losses: &Losses) -> Result<(Self, Numbers<f64>), Error> {
        let kappa = stability::rolling(body, y);
        let refused = |name, value, expected| Err(Error::OutOfRange { name, value, expected });
        let rate = y.precession();
        if kappa.is_nan() && y.w2 != 0.0 {
            return refused("w2", y.w2, "0, since theta is constant in a steady state");
        }
        if kappa.is_nan() || rate == 0.0 {
            let tilting = crate::rolling::derivative(body, y).w2;
            return refused("theta''", -tilting, "a steady state of rolling: theta'' = 0, phi' not 0");
        }
        if kappa <= 0.0 {
            return refused("kappa", kappa, "kappa > 0, for a state that is stable in rolling");
        }
        let mut of = Circular::new(&body.shape(), !body.is_sharp(), Couples::of(losses, |x| x));
        // A body that precesses backwards drifts as its mirror image does.
        let (first, far) = from_other_end([y.theta, rate.abs(), y.w3 * rate.signum(), 0.0], 1.0);
        // The given state is steady to at least six digits; steps of Newton's method make it steady to all
        // digits.
        let start = (0..4).fold(first, |y, _| of.settled(&y, far));
        of.signs = of.at(&start, far).going.map(|x| if x < 0.0 { -1.0 } else { 1.0 });
        let dual = Dual::constant;
        let margins = Margins::of(&losses.coefficients, body.theta_end(), start[0]);
        let dual_margins =
            Margins::of(&losses.coefficients.map(dual), dual(body.theta_end()), dual(start[0]));
        let sloped = (of.map(dual), dual_margins);
        let (ball, steps) = (body.is_ball(), None);
        Ok((Self { of, sloped, margins, start, far, ball, steps }, start))
    }

    /// Returns this drift with its steps stored.
    pub fn recording_steps<'a>(self, steps: &'a RefCell<Vec<DriftStep>>) -> Rolling<'a>
    where
        Self: 'a,
    {
        Rolling { steps: Some(steps), ..self }
    }

    /// Returns this drift with the inclination counted from pi if `far` is -1.
    #[must_use]
    pub fn with_inclination_from(self, far: f64) -> Self {
        Self { far, ..self }
    }

    /// Integrates the drift from the state `y` on for at most `most` steps.
    pub fn follow(
        &mut self,
        mut y: Numbers<f64>,
        mut first: Option<f64>,
        most: u64,
    ) -> Result<Flown<DriftHalt, 4>, Error> {
        loop {
            let steps = Steps { first, most, patience: PATIENCE, toil: TOIL, tired: false };
            let flown = self.run_whole(self.place(y), steps, &[f64::INFINITY], &mut |_| (), &mut || true)?;
            let Some(flown) = flown else { return Err(Error::Lost { theta: self.counted(y[0]) }) };
            if flown.halt != DriftHalt::Turned {
                return Ok(flown);
            }
            (y, self.far) = from_other_end(flown.y, self.far);
            self.start[0] = PI - self.start[0];
            first = Some(flown.step);
        }
    }

    /// The end of a drift that halts: its kind, its inclination and its time, and the tail of a drift to a face; None
    /// if the drift continues.
    pub fn ended(&self, flown: &Flown<DriftHalt, 4>) -> Option<((End, f64, f64), Option<Tail>)> {
        let y = flown.y;
        match flown.halt {
            DriftHalt::Fails(End::Side) => Some(((End::Side, self.margins.side, y[3]), None)),
            DriftHalt::Fails(end) => Some(((end, self.counted(y[0]), y[3]), None)),
            DriftHalt::Flat => {
                let fades = self.margins.no_loss_by_lean > 0.0 && self.of.is_flat_and_fast(&y, self.far);
                let tail = Tail::new(&self.sloped.0, &y, self.far, self.margins.only_air > 0.0, fades);
                let end = if self.ball { End::Upright } else { End::Face };
                Some(((end, self.counted(0.0), y[3] + tail.time()), Some(tail)))
            }
            DriftHalt::Pause | DriftHalt::Turned | DriftHalt::Over => None,
        }
    }

    /// Converts an inclination to the counting of this drift, or back.
    pub fn counted(&self, theta: f64) -> f64 {
        counted(theta, self.far)
    }

    /// The parameters that the SIMD code needs in addition to the body and its losses.
    pub fn numbers(&self) -> [f64; DRIFT_NUMBERS] {
        let ([runs, drills], [theta, rate, w3, _]) = (self.of.signs, self.start);
        [runs, drills, theta, rate, w3, self.far, self.margins.side]
    }
}

/// Converts an inclination to the counting from pi if `far` is -1, or back.
#[inline(always)]
pub(crate) fn counted<T: Real>(theta: T, far: T) -> T {
    theta.splat(0.0).select_lt(far, theta, theta.splat(PI) - theta)
}

/// Returns this state with the inclination counted from the other end of [0, pi] if it is above
/// `COUNTED_FROM_PI_ABOVE`.
fn from_other_end([theta, rate, w3, t]: Numbers<f64>, far: f64) -> (Numbers<f64>, f64) {
    if theta < COUNTED_FROM_PI_ABOVE {
        ([theta, rate, w3, t], far)
    } else {
        ([PI - theta, rate, w3, t], -far)
    }
}

/// Returns the first four components of a state vector.
#[inline(always)]
fn first_four<T: Copy, const N: usize>(y: &[T; N]) -> Numbers<T> {
    [y[0], y[1], y[2], y[3]]
}

impl Flow<DRIFT_MARGINS> for Rolling<'_> {
    type Halt = DriftHalt;
    const TIME: usize = 3;
    const OVER: DriftHalt = DriftHalt::Over;
    const PAUSE: DriftHalt = DriftHalt::Pause;
    const LOOKS_ON: bool = true;
    const LOOPS: bool = true;

    #[inline(always)]
    fn write_rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) {
        all.copy_from_slice(&self.of.at(&first_four(y), self.far).rates);
    }

    fn margins<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; DRIFT_MARGINS] {
        let ((of, margins), far) = (&self.sloped, Dual::constant(self.far));
        let y = core::array::from_fn(|i| Dual { value: place.y[i], slope: place.rate[i] });
        margins.all(&of.at(&y, far), counted(y[0], far))
    }

    fn margin<const N: usize>(&self, y: &[f64; N], i: usize) -> f64 {
        let known = self.of.at(&first_four(y), self.far);
        self.margins.all(&known, self.counted(y[0]))[i]
    }

    fn end(&self, i: usize) -> DriftHalt {
        DriftHalt::Fails(DRIFT_ENDS[i])
    }

    fn error<const N: usize>(&self, y: &[f64; N], made: &rk8::Step<f64, N>) -> f64 {
        error(&self.start, y, made)
    }

    fn fastest<const N: usize>(&self, _: &[f64; N]) -> f64 {
        1.0
    }

    fn first<const N: usize>(&self, _: &[f64; N]) -> f64 {
        STEPS[0]
    }

    /// The time step that rotation and nutation allow: infinite, since a drift does not resolve them.
    fn calm<const N: usize>(&self, _: &[f64; N]) -> f64 {
        f64::INFINITY
    }

    fn shortest<const N: usize>(&self, y: &[f64; N]) -> f64 {
        shortest(y[0])
    }

    fn longest<const N: usize>(&self, _: &FlowPlace<N>) -> f64 {
        STEPS[1]
    }

    fn stopped<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(DriftHalt, [f64; N])> {
        let y = place.y;
        if until_tail(&y, &place.rate, self.margins.last) < 0.0 {
            return Some((DriftHalt::Flat, y));
        }
        if self.margins.until_turning_stops(&y, &place.rate) < 0.0 {
            return Some((DriftHalt::Fails(End::DrillingStops), y));
        }
        (y[0] >= COUNTED_FROM_PI_ABOVE).then_some((DriftHalt::Turned, y))
    }

    fn stuck<const N: usize>(
        &self,
        place: &FlowPlace<N>,
        _: &[Dual<f64>; DRIFT_MARGINS],
    ) -> Option<DriftHalt> {
        if self.margins.until_turning_stops(&place.y, &place.rate) < 0.0 {
            return Some(DriftHalt::Fails(End::DrillingStops));
        }
        (place.y[0] < NEARLY_FLAT).then_some(DriftHalt::Flat)
    }

    fn shown<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        *y
    }

    fn kept<const N: usize>(&self, y: [f64; N]) -> [f64; N] {
        let kept = self.of.kept(&first_four(&y), self.far);
        core::array::from_fn(|i| kept[i])
    }

    fn passed<const N: usize>(&self, (from, ..): TakenStep<'_, N>, h: f64, to: &FlowPlace<N>) {
        if let Some(steps) = self.steps {
            let from = FlowPlace {
                y: first_four(&from.y),
                carry: first_four(&from.carry),
                rate: first_four(&from.rate),
            };
            steps.borrow_mut().push(DriftStep { from, h, to: first_four(&to.y), far: self.far });
        }
    }

    fn theta<const N: usize>(&self, y: &[f64; N]) -> f64 {
        self.counted(y[0])
    }
}

/// The conditions under which a drift continues; each has a margin that must stay positive.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Margins<T> {
    side: T,
    /// 1 if a dry law ends the drift where the contact point stops moving along the rim, and where the drilling
    /// stops, else 0.
    dry: [T; 2],
    /// 1 if only the drag of the air acts, so that the face never lands, else 0.
    only_air: T,
    /// 1 if no loss depends on the inclination of a body that is almost on its face, else 0.
    no_loss_by_lean: T,
    /// The inclination below which the tail of the drift begins.
    pub last: T,
}

impl<T: Real> Margins<T> {
    /// The margins under losses with these coefficients, up to the inclination `theta_end`, from the inclination
    /// `start`.
    #[inline(always)]
    pub fn of(coefficients: &[T; COUNT], theta_end: T, start: T) -> Self {
        let [zero, one] = [0.0, 1.0].map(|x| start.splat(x));
        let [mut dry, mut drilling, mut firm, mut along] = [zero; 4];
        for &law in Law::ALL {
            let x = coefficients[law as usize];
            if law.presses() {
                let to = if law.resists() == Resists::Drilling { &mut drilling } else { &mut dry };
                *to = *to + x;
            }
            // The face lands in a finite time under a law whose power falls less fast than theta.
            if law.powers().face[1] < 1.0 {
                firm = firm + x;
            }
            if law.is_along_contour() {
                along = along + x;
            }
        }
        Self {
            // A body without a second rim gets a limit above pi, which it never reaches.
            side: theta_end.select_lt(one.splat(PI), theta_end, one.splat(4.0)),
            dry: [dry, drilling].map(|x| zero.select_lt(x, one, zero)),
            only_air: zero.select_lt(firm, zero, one),
            no_loss_by_lean: zero.select_lt(along, zero, one),
            last: zero.select_lt(firm, one.splat(LAST_INCLINATION), start * one.splat(FACE_LANDED)),
        }
    }

    /// A quantity that is positive until drilling friction would stop the precession within a time below rounding.
    /// Its zero ends the drift of a coin that has come upright and rolls straight.
    #[inline(always)]
    pub fn until_turning_stops<const N: usize>(&self, y: &[T; N], rate: &[T; N]) -> T {
        let [zero, one] = [0.0, 1.0].map(|x| y[0].splat(x));
        let left = -(y[1] * rate[3] / rate[1]) - one.splat(8.0 * TAIL_TIME_SHARE) * y[3];
        let falls = rate[1].select_lt(zero, self.dry[1], zero);
        zero.select_lt(falls, left, one)
    }

    #[inline(always)]
    pub fn all(&self, known: &CirclePoint<T>, theta: T) -> [T; DRIFT_MARGINS] {
        let [runs, drills] = known.going;
        let if_dry = here(
            #[inline(always)]
            |dry: T, going: T| dry.splat(0.5).select_lt(dry, going, dry.splat(1.0)),
        );
        [known.stiffness, self.side - theta, if_dry(self.dry[0], runs), if_dry(self.dry[1], drills)]
    }
}
