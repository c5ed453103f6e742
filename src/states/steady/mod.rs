//! Steady states: with the centre at rest, or with the centre moving along a circle.
//!
//! ```text
//! centre at rest:   rate^2 = n / ((n + d cos theta) sin theta),   n = cos theta - ell sin theta,   d = I1/I3 - 1
//!                   w1 = Omega sin theta,   w2 = 0,   w3 = ell w1,   Omega = rate/sqrt(I3)
//! on a circle:      Omega w3 (I3 s + h A) = Omega^2 s (I1 cos + h L) - n,   w2 = 0
//! ```
//! `rate` is the reduced rotation rate Omega~ = Omega sqrt(I3) of Jackson et al., Am. J. Phys. 87, 85 (2019), Eq. 15,
//! with theta in (0, pi/2]. The tangents in that equation have a pole at pi/2 and lose nine digits where theta0 and
//! thetaInf meet. Here numerator and denominator share `n`, whose error cancels in the quotient. Steady states are
//! computed without integration.
//!
//! The module `quick` computes the rate of a sharp rim in few operations; the functions here compute it with more
//! digits where a sign is uncertain. `single` computes it in single precision. Error of `rate`: at most 2 (1 + kappa_c)
//! ulp of 2^-53, kappa_c = |dlog rate/dlog theta|, for every body and every double theta in (0, pi/2], subnormal ones
//! too. The bound also holds next to folds, where n of a sharp rim is at most 1/(1 - sqrt(-d)) = 3.4 times n + d cos
//! theta. The module `rounded` gives the error for a rounded rim. Tests of `hard_cases` and `laws` check it.
//!
//! ```
//! use spincyl::{Body, steady};
//!
//! let body = Body::solid(2.5)?;
//! let state = steady::state(&body, 1.3)?;
//! assert!(state.centre_radius(&body) < 1e-12);
//! let all = steady::inclinations(&body, steady::rate(&body, 1.3));
//! assert!(all.iter().any(|theta| (theta - 1.3).abs() < 1e-10));
//! # Ok::<(), spincyl::Error>(())
//! ```

mod branch;
#[cfg(test)]
mod drawn;
mod inverse;
mod quick;
mod rounded;
mod single;
mod trig;

pub use branch::{folds, ridge};
pub use inverse::{count, inclinations, states};

pub(crate) use branch::{edges, in_range, inclinations_of, shared_factor};
pub(crate) use quick::{TINY, bounds_beyond_error, may_exceed, may_exceed_between, quick_angle, quick_terms};
pub(crate) use rounded::{RateTerms, RoundedParts};
pub(crate) use single::single_rate;
pub(crate) use trig::BodyPolynomials;

use crate::error::{Error, within};
use crate::laws::body::Body;
use crate::laws::state::State;
use crate::numbers::{Lane, Real, Short, SinCos, Sum, in_lanes, level, sincos};

/// The largest number of inclinations in any result: 3 for a sharp rim, 5 for a rounded rim.
pub const MOST: usize = 5;

const HALF_PI: f64 = core::f64::consts::FRAC_PI_2;

/// The sign of `n` or of `m` is unknown below this bound, relative to the terms whose difference they are: it is the
/// error of sine and cosine together.
const UNSURE: f64 = 1.0 / (1_u64 << 55) as f64;

/// The terms of the squared rate of a sharp rim, n and m, with more digits than [`quick_terms`] has.
#[inline(always)]
pub(crate) fn terms<T: Real>(angle: &SinCos<T>, ell: T, excess: Sum<T>) -> RateTerms<T> {
    let (n, c, number) = (numerator(angle, ell), angle.cos, |x: f64| ell.splat(x));
    let extra = Sum::product(excess.hi, c.hi);
    let m = Sum::of(n.hi, extra.hi);
    let m = Sum::ordered(m.hi, m.lo + (extra.lo + n.lo + excess.hi * c.lo + excess.lo * c.hi));
    let radius = Sum { hi: number(1.0), lo: number(0.0) };
    let limits = [number(UNSURE) * c.hi, number(UNSURE) * (c.hi + ell * angle.sin.hi)];
    RateTerms { n, m, radius, sine: angle.sin }.nan_where_small(limits)
}

/// The numerator n = cos theta - ell sin theta of the squared rate, with an error below a quarter ulp of the cosine.
#[inline(always)]
fn numerator<T: Real>(angle: &SinCos<T>, ell: T) -> Sum<T> {
    let (s, c) = (angle.sin, angle.cos);
    let lever = Sum::product(ell, s.hi);
    let n = Sum::of(c.hi, -lever.hi);
    Sum::ordered(n.hi, n.lo + (c.lo - lever.lo - ell * s.lo))
}

/// Reduced rotation rate at an inclination, NaN where no steady state exists. The quick terms give the rate; the terms
/// with more digits are computed only where a sign is uncertain.
///
/// The closure for uncertain SIMD lanes owns its inputs: borrowed inputs would be kept in memory at every point.
#[inline(always)]
pub(crate) fn rate_lanes<T: Lane>(theta: T, angle: &Short<T>, ell: T, excess: Sum<T>) -> T {
    let of = quick_terms(angle, ell, excess);
    let rate = of.square(angle.sin).sqrt();
    if !of.in_doubt() {
        return rate;
    }
    let careful = theta.aside(
        #[inline(always)]
        move || terms(&sincos(theta), ell, excess).rate(theta, theta.splat(HALF_PI)),
    );
    of.where_certain(careful, rate)
}

/// The rate of [`rate_lanes`] for callers that rarely need it, compiled apart from their frequent work.
#[inline(always)]
pub(crate) fn rare_rate<T: Lane>(theta: T, ell: T, excess: Sum<T>) -> T {
    theta.aside(
        #[inline(always)]
        move || rate_lanes(theta, &quick_angle(theta), ell, excess),
    )
}

/// The square of the rate of [`rate_lanes`].
#[inline(always)]
pub(crate) fn square_lanes<T: Lane>(theta: T, angle: &Short<T>, ell: T, excess: Sum<T>) -> T {
    let of = quick_terms(angle, ell, excess);
    let (square, zero) = (of.square(angle.sin), theta.splat(0.0));
    let square = square.select_lt(zero, theta.splat(f64::NAN), square);
    if !of.in_doubt() {
        return square;
    }
    let careful = theta.aside(
        #[inline(always)]
        move || terms(&sincos(theta), ell, excess).square(theta, theta.splat(HALF_PI)),
    );
    of.where_certain(careful, square)
}

/// Reduced rotation rate Omega~ of the steady state with the centre at rest at inclination `theta`
/// in (0, pi/2].
///
/// The result is NaN outside that interval, in the forbidden band between theta0 and thetaInf, and within a few last
/// bits of the limits of the band; [`region`](super::stability::region) distinguishes these cases. The error is at most
/// 2 (1 + kappa_c) ulp (2^-53), where kappa_c = |dlog rate/dlog theta|. A rounded rim adds 2^-100 n/m, which is smaller
/// than that unless m = n + d A cos is below 2^-47 n.
///
/// Two kinds of bodies have more steady states than a function of theta can give: a critical body (I1 = I3) is steady
/// at any rate at theta0, and a thin disk (`ell = 0`) at any rate at exactly pi/2, which is not a double.
pub fn rate(body: &Body, theta: f64) -> f64 {
    if !body.is_plain() {
        return terms_of(body, theta).rate(theta, body.rests_up_to());
    }
    let (ell, excess) = (body.ell(), body.excess_sum());
    in_lanes!(
        level(),
        _ => rate_lanes(theta, &quick_angle(theta), ell, excess),
        else rate_lanes(theta, &quick_angle(theta), ell, excess)
    )
}

/// The terms of the squared rate of a rounded rim, compiled for the best SIMD level of this machine, which has a fused product.
fn terms_of(body: &Body, theta: f64) -> RateTerms<f64> {
    let (a, excess) = (body.rim_sum(), body.excess_sum());
    let of = RoundedParts { ell: body.ell(), rho: body.fillet(), a, excess };
    in_lanes!(
        level(),
        _ => of.terms(theta, &sincos(theta)),
        else of.terms(theta, &sincos(theta))
    )
}

/// The steady state with the centre at rest at inclination `theta` in (0, pi/2], for a rounded rim up to
/// [`theta_end`](Body::theta_end).
///
/// The relative error of w1 and w3 is that of [`rate`] plus 4 ulp.
///
/// # Errors
/// `OutOfRange` outside that interval, and for a ball whose centre of mass is at its centre; `Forbidden` between
/// theta0 and thetaInf; `Undetermined` within a few last bits of these limits.
pub fn state(body: &Body, theta: f64) -> Result<State, Error> {
    let theta = check(body, theta)?;
    if body.is_ball() && body.ell() == 0.0 {
        let expected = "a ball whose centre of mass is not at its centre: else every rate is steady";
        return Err(Error::OutOfRange { name: "ell", value: 0.0, expected });
    }
    let rate = rate(body, theta);
    if rate.is_nan() {
        let (theta_balance, theta_limit) = (body.theta_balance(), body.theta_limit());
        let RateTerms { n, m, .. } = terms_of(body, theta);
        return Err(if n.hi.is_nan() || m.hi.is_nan() {
            Error::Undetermined { theta, theta_balance, theta_limit }
        } else {
            Error::Forbidden { theta, theta_balance, theta_limit }
        });
    }
    Ok(turning(body, theta, rate))
}

/// Whether a state is the steady state with the centre at rest at its inclination, in either direction of rotation, to
/// six digits of |w1| + |w3|. False at an inclination without such a state.
pub fn rests(body: &Body, y: &State) -> bool {
    state(body, y.theta).is_ok_and(|own| {
        let way = if y.w1 * own.w1 < 0.0 { -1.0 } else { 1.0 };
        let off = (y.w1 - way * own.w1).abs() + y.w2.abs() + (y.w3 - way * own.w3).abs();
        off <= 1e-6 * (own.w1.abs() + own.w3.abs())
    })
}

/// The steady state with the centre at rest that has this reduced rate at this inclination: w3 = (L/A) w1.
pub(crate) fn turning(body: &Body, theta: f64, rate: f64) -> State {
    let speed = rate / body.i3().sqrt();
    let (rim, angle) = (body.shape().rim, theta.sin_cos());
    let w1 = speed * angle.0;
    let w3 = if body.is_ball() {
        speed * rim.depth(angle) / rim.rho
    } else {
        rim.depth(angle) / rim.radius(angle) * w1
    };
    State { theta, w1, w2: 0.0 * theta, w3 }
}

/// Returns `theta` if it lies within the range of the body, else an error.
fn check(body: &Body, theta: f64) -> Result<f64, Error> {
    let expected = if body.range() == HALF_PI {
        "0 < theta <= pi/2 (radians)"
    } else {
        "0 < theta <= theta_end of the body (radians)"
    };
    within("theta", theta, (f64::from_bits(1), body.range()), expected)
}

/// The steady state at inclination `theta` in (0, pi/2] with the precession phi' = `precession`, in sqrt(g/R) and not
/// 0, whose centre moves along a circle of radius [`centre_radius`](State::centre_radius).
///
/// With `precession = rate / sqrt(I3)` that radius is 0 up to rounding, and the state is that of [`state`]. The error
/// of w3 is 8 ulp of its largest term, `cos(theta)/precession` included.
///
/// # Errors
/// `OutOfRange` for an inclination outside (0, pi/2], for a rounded rim beyond theta_end, for a |precession| outside
/// [1e-100, 1e100], and where w3 would overflow.
pub fn circular(body: &Body, theta: f64, precession: f64) -> Result<State, Error> {
    let theta = check(body, theta)?;
    if !(1e-100..=1e100).contains(&precession.abs()) {
        let expected = "1e-100 <= |precession| <= 1e100";
        return Err(Error::OutOfRange { name: "precession", value: precession, expected });
    }
    let CircularBalance { lever, n, k, s } = CircularBalance::of(body, theta);
    let w3 = (lever * precession - n / precession) / k;
    within("w3", w3, (-f64::MAX, f64::MAX), "a finite number: use a slower precession, or ell < 1e100")?;
    Ok(State { theta, w1: precession * s, w2: 0.0, w3 })
}

/// The positive precession phi' for which the centre of mass moves along a circle of this radius, in R; NaN without
/// such a steady state. The radius is positive where the centre moves against e2, as for a coin that rolls round a wide
/// circle and leans inward, and negative where the centre moves along e2.
///
/// The state is then that of [`circular`]. Error: 8 ulp, times the share of the largest of the terms lever, k
/// depth/radius and k radius in their sum.
///
/// # Errors
/// `OutOfRange` for an inclination as in [`circular`], and for a |radius| above 1e100.
pub fn precession_of_radius(body: &Body, theta: f64, radius: f64) -> Result<f64, Error> {
    let theta = check(body, theta)?;
    within("radius", radius, (-1e100, 1e100), "|radius| <= 1e100")?;
    let CircularBalance { lever, n, k, s } = CircularBalance::of(body, theta);
    let (rim, angle) = (body.shape().rim, theta.sin_cos());
    // v_2 = a w3 - d w1 for the contact point at the distance a from the axis, d below the centre; w1 = Omega s.
    let share = (rim.depth(angle) * s - radius) / rim.radius(angle);
    Ok((n / (lever - k * share)).sqrt())
}

/// Both precessions phi' of circular steady states with this spin w3 about the axis, the slower one first; NaN without
/// such a state. For w3 = 0 the two are opposite.
///
/// The states are then those of [`circular`]. Error: 8 ulp for the faster precession; for the slower one this is
/// multiplied by the cancellation between k^2 w3^2 and 4 lever n.
///
/// # Errors
/// `OutOfRange` for an inclination as in [`circular`], and for a |w3| above 1e100.
pub fn precessions_of_spin(body: &Body, theta: f64, w3: f64) -> Result<[f64; 2], Error> {
    let theta = check(body, theta)?;
    within("w3", w3, (-1e100, 1e100), "|w3| <= 1e100")?;
    let CircularBalance { lever, n, k, .. } = CircularBalance::of(body, theta);
    // lever Omega^2 - k w3 Omega - n = 0, without a difference of nearly equal numbers.
    let half = 0.5 * k * w3;
    let root = (half * half + lever * n).sqrt();
    let far = if half < 0.0 { half - root } else { half + root };
    let [a, b] = [far / lever, -n / far].map(|x| if x.is_finite() { x } else { f64::NAN });
    Ok(if b.abs() <= a.abs() { [b, a] } else { [a, b] })
}

/// The balance of a circular steady state, divided by phi' = Omega: k w3 = lever Omega - n/Omega. For a ball n, A and w1 have
/// the factor sin theta, which is divided out.
struct CircularBalance {
    lever: f64,
    n: f64,
    k: f64,
    s: f64,
}

impl CircularBalance {
    fn of(body: &Body, theta: f64) -> Self {
        let (shape, of) = (body.shape(), terms_of(body, theta));
        let angle = sincos(theta);
        let (s, c) = (angle.sin.hi, angle.cos.hi);
        let n = of.n.hi;
        let n = if n.is_nan() { -shape.rim.lever((s, c)) } else { n };
        let [radius, depth, height] =
            [shape.rim.radius((s, c)), shape.rim.depth((s, c)), shape.rim.height((s, c))];
        let lever = shape.i1 * c + height * depth;
        if body.is_ball() {
            Self { lever, n, k: shape.i3 + height * shape.rim.rho, s }
        } else {
            Self { lever: lever * s, n, k: shape.i3 * s + height * radius, s }
        }
    }
}
