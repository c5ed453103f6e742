//! A stone that rolls without slipping and without events: neither an edge nor a lift-off ends its motion.
//!
//! ```text
//! y = (q, w, x, y, t)     q' = q w/2,   w' of the law of rolling,   (x, y)' = -w x r along the table
//! ```
//! This is the motion of [`roll`](super::roll) without phases and margins: a web page does not need them, and
//! their code is ten times as long. Error: from a second run with a larger tolerance and other steps;
//! `tests/laws/stone.rs` compares it with `roll`.

use super::flow::StoneNumbers;
use super::phases::ROUGH_STRIDE;
use crate::error::{Error, within};
use crate::laws::stone::Ellipsoid;
use crate::laws::stone::StoneState;
use crate::laws::stone::law::{StoneLaw, laboratory, turning};
use crate::methods::flow::{Flow, FlowPlace, PATIENCE, Steps, toil_of};
use crate::methods::rk8;
use crate::motions::Moving;
use crate::motions::walk::two_runs::rougher;
use crate::numbers::vector::{cross, dot};
use crate::numbers::{Dual, larger_or_nan};

/// Number of components of the state vector of a rolling stone; the last one is the time.
pub(super) const N: usize = 10;
const FREE_TIME: usize = 9;

/// A rolling stone at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct RollingStone {
    /// The time since the initial state, in sqrt(a/g), where a is the largest semi-axis.
    pub time: f64,
    /// The rotation from the axes of the ellipsoid to those of the laboratory, as a quaternion (w, x, y,
    /// z) of length 1.
    pub orientation: [f64; 4],
    /// The position of the centre of mass relative to the first contact point, in a.
    pub centre: [f64; 2],
    /// The time derivative of the quaternion `orientation`, in sqrt(g/a).
    pub orientation_rate: [f64; 4],
    /// The velocity of the centre of mass, in sqrt(g a).
    pub centre_velocity: [f64; 2],
    /// The vertical along the axes of the stone, and the angular velocity along them, in sqrt(g/a).
    pub state: StoneState,
    /// The normal force in weights; a real stone would lift off when it becomes negative.
    pub normal: f64,
}

/// Computes the motion of a rolling stone from its state at time 0, at `times` in ascending order from 0 on. Returns
/// the stone at each time, and the estimated error.
///
/// `tol` is the tolerance of a step. `go_on` is called often; if it returns false, the result is `Ok(None)`.
///
/// ```
/// use spincyl::{Ellipsoid, stone};
///
/// let stone = Ellipsoid::rattleback([1.0, 0.2, 0.17], None, 0.03, None)?;
/// let times: Vec<f64> = (0..=60).map(f64::from).collect();
/// let start = stone.spinning(-0.4, 0.002, 0.0);
/// let (rows, error) = stone::rolling(&stone, start, &times, 1e-10, || true)?.unwrap();
/// assert!(rows.iter().any(|row| row.state.spin() > 0.1) && error < 1e-4);
/// # Ok::<(), spincyl::Error>(())
/// ```
///
/// # Errors
/// `OutOfRange` for an angular velocity beyond 1e6; `Endless` if the motion hardly advances, and `Lost` if rounding
/// errors outweigh it.
pub fn rolling(
    stone: &Ellipsoid,
    start: StoneState,
    times: &[f64],
    tol: f64,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<(Vec<RollingStone>, f64)>, Error> {
    for (name, w) in ["w1", "w2", "w3"].into_iter().zip(start.w) {
        within(name, w, (-1e6, 1e6), "|w| <= 1e6 sqrt(g/a) for a motion")?;
    }
    let (law, rough) = (stone.law(0.0, false), rougher(tol));
    let Some(rows) = FreeRolling { law, tol, stride: 1.0 }.follow(&start, times, &mut go_on)? else {
        return Ok(None);
    };
    let Some(others) =
        (FreeRolling { law, tol: rough, stride: ROUGH_STRIDE }).follow(&start, times, &mut go_on)?
    else {
        return Ok(None);
    };
    let mut apart = 0f64;
    for (a, b) in rows.iter().zip(&others) {
        let turned = (0..4).map(|i| (a.orientation[i] - b.orientation[i]).abs());
        apart = turned.fold(larger_or_nan(apart, a.state.distance(&b.state)), larger_or_nan);
    }
    Ok(Some((rows, larger_or_nan(tol, StoneState::SAFETY * tol / rough * apart))))
}

/// The equations of a stone that rolls without events.
#[derive(Clone, Copy)]
pub(super) struct FreeRolling {
    pub law: StoneLaw<f64>,
    pub tol: f64,
    /// The longest step of this run as a share of the longest allowed step.
    pub stride: f64,
}

/// The reasons for which the integration of a stone that rolls without events halts.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum FreeRollingHalt {
    Over,
    Pause,
}

impl FreeRolling {
    /// Computes the stone at each of the times; None if the computation is interrupted.
    fn follow(
        &self,
        start: &StoneState,
        times: &[f64],
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<RollingStone>>, Error> {
        let y = self.numbers(start);
        let mut rows = Vec::with_capacity(times.len());
        let toil = toil_of(times.last().copied().unwrap_or(0.0));
        let steps = Steps { first: None, most: u64::MAX, patience: PATIENCE, toil, tired: false };
        let mut write = |y: &[f64; N]| {
            let (mut rate, y) = (*y, &self.kept(*y));
            let (vertical, normal) = self.rates_of(y, &mut rate);
            let state = StoneState { vertical, w: y.omega() };
            let (orientation_rate, centre_velocity) =
                ([rate[0], rate[1], rate[2], rate[3]], [rate[7], rate[8]]);
            let (orientation, centre) = (y.quaternion(), [y[7], y[8]]);
            rows.push(RollingStone {
                time: y[FREE_TIME],
                orientation,
                centre,
                orientation_rate,
                centre_velocity,
                state,
                normal,
            });
        };
        let flown = self.run_whole(self.place(y), steps, times, &mut write, go_on)?;
        Ok(flown.map(|_| rows))
    }

    /// The state vector of an initial state.
    pub(super) fn numbers(&self, start: &StoneState) -> [f64; N] {
        let at = self.law.touching(start.vertical, start.w);
        let ([a, b, c, d], [e, f, g]) = (start.orientation(), start.w);
        let lab = laboratory([a, b, c, d]);
        [a, b, c, d, e, f, g, -dot(lab[0], at.r), -dot(lab[1], at.r), 0.0]
    }

    /// Writes the derivative of the state vector to `all`. Returns the vertical and the normal force.
    #[inline(never)]
    pub(super) fn rates_of<const M: usize>(&self, y: &[f64; M], all: &mut [f64; M]) -> ([f64; 3], f64) {
        let [a, b, c, d, e, f, g] = core::array::from_fn(|i| y[i]);
        let (q, w) = ([a, b, c, d], [e, f, g]);
        let lab = laboratory(q);
        let at = self.law.touching(lab[2], w);
        let (to, v) = (self.law.rolling(&at, w), cross(at.r, w));
        all[..4].copy_from_slice(&turning(q, w));
        all[4..7].copy_from_slice(&to.w);
        all[7..].copy_from_slice(&[dot(lab[0], v), dot(lab[1], v), 1.0]);
        (lab[2], to.free)
    }
}

impl Flow<0> for FreeRolling {
    type Halt = FreeRollingHalt;
    const TIME: usize = FREE_TIME;
    const OVER: FreeRollingHalt = FreeRollingHalt::Over;
    const PAUSE: FreeRollingHalt = FreeRollingHalt::Pause;

    fn write_rates<const M: usize>(&self, y: &[f64; M], all: &mut [f64; M]) {
        self.rates_of(y, all);
    }
    fn margins<const M: usize>(&self, _: &FlowPlace<M>) -> [Dual<f64>; 0] {
        []
    }
    fn margin<const M: usize>(&self, _: &[f64; M], _: usize) -> f64 {
        1.0
    }
    fn end(&self, _: usize) -> FreeRollingHalt {
        FreeRollingHalt::Over
    }
    fn error<const M: usize>(&self, y: &[f64; M], made: &rk8::Step<f64, M>) -> f64 {
        let (per, per_speed) = (1.0 / self.tol, 1.0 / (self.tol * self.fastest(y)));
        made.error(|i| if i < 4 || i == FREE_TIME { per } else { per_speed }, M as f64)
    }
    fn fastest<const M: usize>(&self, y: &[f64; M]) -> f64 {
        y[4].abs().max(y[5].abs()).max(y[6].abs()).max(1.0)
    }
    fn first<const M: usize>(&self, y: &[f64; M]) -> f64 {
        self.stride * 0.02 / (1.0 + self.fastest(y))
    }
    fn calm<const M: usize>(&self, y: &[f64; M]) -> f64 {
        3.0 / self.fastest(y)
    }
    fn longest<const M: usize>(&self, place: &FlowPlace<M>) -> f64 {
        self.stride * self.calm(&place.y)
    }
    fn stopped<const M: usize>(&self, _: &FlowPlace<M>) -> Option<(FreeRollingHalt, [f64; M])> {
        None
    }
    fn stuck<const M: usize>(&self, _: &FlowPlace<M>, _: &[Dual<f64>; 0]) -> Option<FreeRollingHalt> {
        None
    }
    fn shown<const M: usize>(&self, y: &[f64; M]) -> [f64; M] {
        *y
    }
    fn kept<const M: usize>(&self, mut y: [f64; M]) -> [f64; M] {
        let per = 1.0 / (y[0] * y[0] + y[1] * y[1] + y[2] * y[2] + y[3] * y[3]).sqrt();
        (0..4).for_each(|i| y[i] *= per);
        y
    }
    fn theta<const M: usize>(&self, y: &[f64; M]) -> f64 {
        laboratory(y.quaternion())[2][2].acos()
    }
}
