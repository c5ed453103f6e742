//! A body that loses energy while friction holds none of its rotations: the conditions that end a phase, step errors
//! and longest steps, for single motions and for SIMD lanes.
//!
//! ```text
//! y = (s, c, p, w2, w3, t), on a tilted table (s, c, p, w2, w3, cos phi, sin phi, x, t)
//! dt = v/(v + delta/J) dsigma with v^2 = w_h^2 + w2^2 under rolling resistance, else dt = dsigma
//! margins of a lane    distances from landing and settling, side, N, (mu N)^2 - F^2, |psi'|, |w_z|, v
//! ```
//! The couple of rolling resistance is opposite to the rotation by rolling and rocking, whose direction turns faster
//! the slower it is. In sigma the motion is smooth up to the point where both vanish, which is approached as
//! exp(-sigma). Single motions and lanes of eight share this code.

use super::{LOSSY_NUMBERS, LossyFlow, REST};
use crate::laws::body::{Shape, landing_angle};
use crate::laws::contact::lossy::{Acted, Held, Lossy};
use crate::laws::contact::{Contact, grip};
use crate::laws::loss::{COUNT, Couples, Law, Ways, going};
use crate::laws::state::drilling_of;
use crate::methods::rk8;
use crate::motions::body::face::lands_at;
use crate::motions::body::own::Own;
use crate::motions::dry::settled::{CLOSE, SLOWER};
use crate::motions::walk::numbers::{contact_velocity, heading_rates};
use crate::numbers::{Dual, Real, here};

/// The contact and the losses of a body that loses energy while friction holds none of its rotations.
#[derive(Clone, Copy)]
pub(crate) struct LossyUnheld<T> {
    pub law: Lossy<T>,
    /// Sine and cosine of theta_end, at which the other rim lands, and 1 if theta_end is below pi, else 0.
    pub side: [T; 3],
    /// Coefficient of friction; infinite where no slip can begin.
    pub mu: T,
    /// The tangent of the slope.
    pub tilt: T,
}

/// The sine of theta_end - theta, which vanishes where the other rim lands; 1 without a theta_end below pi.
#[inline(always)]
pub(crate) fn from_side<T: Real>([sine, cosine, there]: [T; 3], (s, c): (T, T)) -> T {
    let one = s.splat(1.0);
    one.splat(0.5).select_lt(there, sine * c - cosine * s, one)
}

/// Returns s, c, p, w2 and w3 of a state vector. Without an iterator, which would call a function in SIMD code.
#[inline(always)]
fn first_five<T: Copy, const K: usize>(y: &[T; K]) -> [T; 5] {
    [y[0], y[1], y[2], y[3], y[4]]
}

/// The joint speed of the rolling and the rocking, sqrt(w_h^2 + w2^2).
#[inline(always)]
pub(crate) fn pace_of<T: Real>((s, c): (T, T), precession: T, [_, w2, w3]: [T; 3]) -> T {
    let rolling = s * (w3 - c * precession);
    rolling.mac(rolling, w2 * w2).sqrt()
}

/// The precession phi' and w from the state vector, while friction holds no rotation.
#[inline(always)]
pub(crate) fn turning<T: Real>([s, _, p, w2, w3]: [T; 5]) -> (T, [T; 3]) {
    let per = s.splat(1.0) / s;
    let w1 = p * per;
    (w1 * per, [w1, w2, w3])
}

/// The largest component of w by size, at least 1.
#[inline(always)]
pub(crate) fn fastest_of<T: Real>(w: [T; 3]) -> T {
    w[0].splat(1.0).max(w[0].abs()).max(w[1].abs()).max(w[2].abs())
}

/// The error of a step in units of `tol`: relative to s for s, relative to the largest speed for speeds, and for p as
/// an error of w1. If rolling resistance stops the body, `paced` is its speed of rolling and rocking, and the error
/// of a speed is at most a thousandth of `paced`, so that the speed vanishes correctly at any tolerance.
#[inline(always)]
pub(crate) fn error<T: Real, const N: usize>(
    tol: T,
    (s, w): (T, [T; 3]),
    (free, paced): (bool, Option<T>),
    made: &rk8::Step<T, N>,
    (turns, time): (core::ops::Range<usize>, usize),
) -> T {
    let one = tol.splat(1.0);
    let fastest = fastest_of(w);
    let (per_tol, per_s) = (one / tol, one / (tol * s));
    let mut per_speed = one / (tol * fastest);
    if let Some(paced) = paced {
        per_speed = per_speed.max(one.splat(1e3) / (paced + one.splat(100.0 * REST)));
    }
    let per_turning = if free { per_speed / s } else { per_speed };
    let per = |i: usize| match i {
        0 => per_s,
        2 => per_turning,
        3 | 4 => per_speed,
        i if turns.contains(&i) => per_speed,
        _ => per_tol,
    };
    made.error(per, N as f64) * made.strictness(tol, 5, time)
}

/// The time in which the fastest of rotation, theta' and nutation turns by three radians; at most 3.
#[inline(always)]
pub(crate) fn three_radians<T: Real>(shape: &Shape<T>, precession: T, [w1, w2, w3]: [T; 3]) -> T {
    let one = precession.splat(1.0);
    let nutation = (w3 * shape.i3 / shape.i1).abs();
    one.splat(3.0) / one.max(w2.abs()).max(w1.abs()).max(precession.abs()).max(nutation)
}

impl<T: Real> LossyUnheld<T> {
    /// Writes the derivative of the state vector to `all`. Returns the contact force and the accelerations.
    #[inline(always)]
    pub fn rates<const K: usize>(&self, y: &[T; K], all: &mut [T; K]) -> Acted<T> {
        let [s, c, p, w2, w3] = first_five(y);
        let (precession, w) = turning([s, c, p, w2, w3]);
        let zero = s.splat(0.0);
        let heading = if K > 6 { [y[5], y[6]] } else { [zero; 2] };
        let pull = (K > 6).then_some([self.tilt * heading[0], -(self.tilt * heading[1])]);
        let acted = self.law.under(pull, (s, c), precession, w, Held::Nothing);
        let [d1, d2, d3] = acted.w;
        all[..5].copy_from_slice(&[-(c * w2), s * w2, s * d1 - c * w2 * w[0], d2, d3]);
        if K > 6 {
            let reduced = self.law.rates.reduced();
            let runs = match reduced.contact {
                Contact::Rolling => {
                    contact_velocity(&reduced.shape.rim, (s, c), w2, w3 - c * precession, [zero; 2])
                }
                Contact::Smooth => [zero; 2],
            };
            all[5..8].copy_from_slice(&heading_rates(heading, precession, runs));
        }
        all[K - 1] = s.splat(1.0);
        if self.law.losses.has(Law::RollingResistance) {
            let pace = self.law.pace((s, c), pace_of((s, c), precession, w));
            all.iter_mut().for_each(|x| *x = *x * pace);
        }
        acted
    }

    /// The margins: if all are positive, SIMD code may take a step without a search for events. They are the
    /// distances of the face from landing and settling, and of the other rim from landing; N and (mu N)^2 - F^2; the
    /// rates of the rotations that dry losses resist, and the speed that rolling resistance brings to rest.
    #[inline(always)]
    pub fn margins<const K: usize>(&self, y: &[T; K], acted: &Acted<T>) -> [T; 7] {
        let [s, c, p, w2, w3] = first_five(y);
        let one = s.splat(1.0);
        let (precession, w) = turning([s, c, p, w2, w3]);
        let losses = &self.law.losses;
        let exactly = one.splat(0.0);
        let Some(ways) = losses.ways else { return [one; 7] };
        let contour = losses.has(Law::DryContour);
        let contour = if contour { going(ways.contour, w3 - c * precession, exactly) } else { one };
        let drilling = losses.has(Law::Drilling);
        let drilling =
            if drilling { going(ways.drilling, drilling_of((s, c), w[0], w3), exactly) } else { one };
        let [normal, along, across] = acted.force;
        let held = grip(self.mu, normal, along * along + across * across);
        let held = self.mu.select_lt(one.splat(f64::MAX), held, one);
        let endless = losses.turn_endlessly();
        // This margin vanishes at ten times the sine of theta of a landing.
        let i1 = self.law.rates.reduced().shape.i1;
        let mut far = s * one.splat(0.1) - lands_at(i1, (s, c), [w[0], w2], acted.w[1], endless);
        if losses.is_soft() {
            let runs = s * (w3 - c * precession).abs() - one.splat(2.0 * SLOWER) * c * w2;
            far = far.min(s.select_lt(one.splat(2.0 * CLOSE), runs, one));
        }
        let mut moves = one;
        if losses.has(Law::RollingResistance) {
            moves = pace_of((s, c), precession, w) - one.splat(4.0 * REST);
        }
        [far, from_side(self.side, (s, c)), acted.force[0], held, contour, drilling, moves]
    }

    /// The error of a step, in units of the allowed error.
    #[inline(always)]
    pub fn error<const K: usize>(&self, tol: T, y: &[T; K], made: &rk8::Step<T, K>) -> T {
        let [s, c, ..] = first_five(y);
        let (precession, w) = turning(first_five(y));
        let paced = self.law.losses.has(Law::RollingResistance);
        let paced = paced.then(
            #[inline(always)]
            || pace_of((s, c), precession, w),
        );
        error(tol, (s.abs(), w), (true, paced), made, (5..K - 1, K - 1))
    }

    /// The speed to which the error of a step is relative.
    #[inline(always)]
    pub fn fastest<const K: usize>(&self, y: &[T; K]) -> T {
        fastest_of(turning(first_five(y)).1)
    }

    /// The longest time step that rotation and nutation allow.
    #[inline(always)]
    pub fn calm<const K: usize>(&self, y: &[T; K]) -> T {
        let (precession, w) = turning(first_five(y));
        three_radians(&self.law.rates.reduced().shape, precession, w)
    }

    /// The longest step of the integrator, in its variable sigma.
    #[inline(always)]
    pub fn longest<const K: usize>(&self, y: &[T; K], rate: &[T; K]) -> T {
        let mut most = self.calm(y);
        if self.law.losses.is_soft() {
            let (precession, w) = turning(first_five(y));
            most = most.min(self.law.damped((y[0], y[1]), w[2] - y[1] * precession));
        }
        most = most / rate[K - 1].min(y[0].splat(1.0));
        if !self.law.losses.has_roots() {
            return most;
        }
        let mut sloped = [Dual { value: y[0], slope: rate[0] }; 5];
        for i in 0..5 {
            sloped[i] = Dual { value: y[i], slope: rate[i] };
        }
        let (precession, w) = turning(sloped);
        let dual = here(
            #[inline(always)]
            |value: T| Dual { value, slope: value.splat(0.0) },
        );
        let losses = self.law.losses.map(dual);
        let rim = self.law.rates.reduced().shape.map(dual).rim;
        most.min(losses.longest(&losses.seen(&rim, (sloped[0], sloped[1]), precession, w), true))
    }
}

impl<G: Own> LossyFlow<G> {
    /// Whether SIMD code can compute this phase: friction holds no rotation, all events end the phase, and the body
    /// is not a ball.
    pub fn is_free(&self) -> bool {
        let free = self.moves && !self.holds_drilling();
        free && self.watch && !self.ball && !self.is_patch() && !G::IS
    }

    /// The parameters that SIMD code needs: theta_end, mu, the coefficients of the losses, and the signs of psi' and
    /// w_z.
    pub fn numbers(&self) -> [f64; LOSSY_NUMBERS] {
        let mut all = [0.0; LOSSY_NUMBERS];
        let (sine, cosine) = landing_angle(self.range[1]);
        let there = f64::from(u8::from(self.range[1] < core::f64::consts::PI));
        all[..4].copy_from_slice(&[sine, cosine, there, self.mu]);
        for &law in Law::ALL {
            all[4 + law as usize] = self.law.losses.coefficient(law);
        }
        all[4 + COUNT..].copy_from_slice(&[self.ways().contour, self.ways().drilling]);
        all
    }

    pub fn present(&self) -> [bool; COUNT] {
        self.law.losses.present()
    }
}

impl<T: Real> LossyUnheld<T> {
    /// A body from the equations `rates` of its contact and rim, and the parameters of [`LossyFlow::numbers`].
    #[inline(always)]
    pub fn of(
        rates: crate::laws::contact::reduced::Rates<T>,
        numbers: [T; LOSSY_NUMBERS],
        present: [bool; COUNT],
        tilt: T,
    ) -> Self {
        let [sine, cosine, there, mu, rest @ ..] = numbers;
        let mut coefficients = [mu; COUNT];
        coefficients.copy_from_slice(&rest[..COUNT]);
        let ways = Ways { contour: rest[COUNT], drilling: rest[COUNT + 1], ..Ways::moving(rest[COUNT]) };
        let losses = Couples::among(coefficients, present, Some(ways));
        Self { law: Lossy { rates, losses }, side: [sine, cosine, there], mu, tilt }
    }
}
