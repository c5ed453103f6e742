//! The steady states whose centre is at rest, as a curve over theta (a branch): the derivative of the energy along
//! it, and the power that is lost.
//!
//! ```text
//! n = a c - ell s,   m = n + d A c,   d = I1/I3 - 1,   sigma = s/A,   s, c, a, rho, A, L, h, g as in `body::rim`
//! Omega^2 = n/(I3 sigma m),   w1 = Omega s,   w3 = Omega L sigma,   psi' = -Omega n/A
//! E  = (n/m) Q + h,   Q = sigma (I1 A^2 + I3 L^2)/(2 I3)
//! E' = (n/m) Q' - d (ell (a + rho s^3) + rho a c^3) Q/m^2 + n
//! Q' = ((a c/A^2) (I1 A^2 + I3 L^2) + 2 sigma rho (I1 A c - I3 L s))/(2 I3)
//! dt = -(E'/P) dtheta
//! ```
//! The equations are Eq. 15 of Jackson et al., Am. J. Phys. 87, 85 (2019), and its form for a torus, with w3 = (L/A)
//! w1. In this form the derivative of n/m has no difference of large terms, and psi' keeps its digits where the body
//! is balanced, n = 0. The caller computes n and m, since n and m are most accurate when computed from the distance
//! to their zeros.
//!
//! Error: a few roundings of the terms written above; a test of `drift` compares E' with the energy.

use crate::laws::body::{Body, Shape};
use crate::laws::loss::{Couples, Kinematics};
use crate::numbers::{Real, Sum, long_sin_cos, sin_cos};

/// A body in steady states whose centre is at rest, with its losses; T holds one body, or eight in SIMD lanes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Branch<T> {
    pub shape: Shape<T>,
    pub excess: T,
    pub losses: Couples<T>,
}

/// A place on the branch of steady states: sine and cosine of theta, n = a c - ell s, and m = n + d A c.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BranchAngle<T> {
    pub angle: (T, T),
    pub n: T,
    pub m: T,
}

/// The slope of the energy, the lost power and the rotation at a place on the branch.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BranchPoint<T> {
    /// E' = dE/dtheta; the next field is the sum of the absolute values of its terms, to which its rounding error is
    /// proportional.
    pub slope: T,
    pub size: T,
    /// The power that the losses take.
    pub power: T,
    /// The precession Omega; `turning` is w1 and w3.
    pub rate: T,
    pub turning: [T; 2],
}

impl<T: Real> Branch<T> {
    /// The place on the branch with n and m computed from sine and cosine of theta, which is accurate where neither n
    /// nor m is small.
    #[inline(always)]
    pub fn angle_in_doubles(&self, angle: (T, T)) -> BranchAngle<T> {
        let n = -self.shape.rim.lever(angle);
        let m = n + self.excess * (angle.1 * self.shape.rim.radius(angle));
        BranchAngle { angle, n, m }
    }

    /// E' = dE/dtheta, the lost power, and w1 and w3 of the steady state at an inclination on the branch; `ROUND` is true
    /// for rims with a fillet.
    #[inline(always)]
    pub fn at<const ROUND: bool>(&self, BranchAngle { angle, n, m }: BranchAngle<T>) -> BranchPoint<T> {
        let (Shape { rim, i1, i3 }, (s, c)) = (self.shape, angle);
        let (one, two) = (s.splat(1.0), s.splat(2.0));
        let per_m = one / m;
        let per_two = one / (i3 + i3);
        let ratio = n * per_m;
        let (radius, depth) = (rim.radius(angle), rim.depth(angle));
        let (sigma, per_radius, bend, q, q_slope);
        if ROUND {
            per_radius = one / radius;
            sigma = s * per_radius;
            bend = rim.ell * (rim.a + rim.rho * (s * s * s)) + rim.rho * rim.a * (c * c * c);
            let moment = i1 * radius * radius + i3 * depth * depth;
            let moment_slope = two * rim.rho * (i1 * radius * c - i3 * depth * s);
            q = sigma * moment * per_two;
            q_slope = (rim.a * c * (per_radius * per_radius) * moment + sigma * moment_slope) * per_two;
        } else {
            (per_radius, sigma, bend) = (one, s, rim.ell);
            let moment = (i1 + i3 * depth * depth) * per_two;
            (q, q_slope) = (s * moment, c * moment);
        }
        let (lift, fall) = (ratio * q_slope, self.excess * bend * q * (per_m * per_m));
        let rate = (two * ratio * per_two / sigma).sqrt();
        let w = [rate * s, s.splat(0.0), rate * depth * sigma];
        let spin = -(rate * n * per_radius);
        let sign = |x: T| x.select_lt(s.splat(0.0), -one, s.splat(0.0).select_lt(x, one, s.splat(0.0)));
        let mut seen =
            Kinematics { angle, w, spin, radius, signs: [sign(spin), one], only: None, om: s.splat(0.0) };
        seen.signs[1] = sign(seen.drilling());
        BranchPoint {
            slope: lift - fall + n,
            size: lift.abs() + fall.abs() + n.abs(),
            power: self.losses.power(&seen, one),
            rate,
            turning: [w[0], w[2]],
        }
    }
}

/// A branch of steady states that has the zeros theta0 of n and thetaInf of m with twice the digits of a double: n
/// follows from the distance to theta0, and near thetaInf m follows from the distance to thetaInf.
///
/// ```text
/// n = hypot(a, ell) sin(theta0 - theta)
/// m = 2 sin(x/2) (r a sin y + ell cos y - d rho cos(x/2) cos(2 y)),   x = thetaInf - theta,   y = thetaInf - x/2
/// ```
#[derive(Debug, Clone, Copy)]
pub(crate) struct Exact {
    pub body: Body,
    pub branch: Branch<f64>,
    balance: Sum<f64>,
    limit: Sum<f64>,
}

impl Exact {
    pub fn new(body: &Body, losses: Couples<f64>) -> Self {
        let branch = Branch { shape: body.shape(), excess: body.excess(), losses };
        let mut rim = body.shape().map(Sum::from).rim;
        rim.a = body.rim_sum();
        // One step of Newton's method on a sum of two doubles doubles the digits of a zero.
        let better = |theta: f64, limit: bool| {
            if theta.is_nan() {
                return theta.into();
            }
            let [s, c] = long_sin_cos(theta);
            let mut miss = rim.lever((s, c));
            let mut slope = rim.slope((s, c)).hi;
            if limit {
                miss = miss - body.excess_sum() * (c * rim.radius((s, c)));
                slope -= body.excess() * (rim.rho * c * c - s * rim.radius((s, c))).hi;
            }
            Sum::of(theta, -miss.hi / slope)
        };
        let (balance, limit) = (better(body.theta_balance(), false), better(body.theta_limit(), true));
        Self { body: *body, branch, balance, limit }
    }

    pub fn angle_at(&self, theta: Sum<f64>) -> BranchAngle<f64> {
        self.angle_below_balance(theta, (self.balance - theta).hi)
    }

    /// The place on the branch at an inclination whose distance `below` theta0 is known more precisely.
    pub fn angle_below_balance(&self, theta: Sum<f64>, below: f64) -> BranchAngle<f64> {
        let rim = self.branch.shape.rim;
        let (s, c) = sum_sin_cos(theta);
        // A ball has no theta0, so that its n comes from the lever.
        let n = if self.body.is_ball() { -rim.lever((s, c)) } else { rim.a.hypot(rim.ell) * below.sin() };
        let more = self.branch.excess * (c * rim.radius((s, c)));
        let mut m = n + more;
        let x = (self.limit - theta).hi;
        if m.abs() < 0.1 * n.abs() && x.abs() < 0.3 {
            let (up, half) = ((self.limit.hi - 0.5 * x).sin_cos(), (0.5 * x).sin_cos());
            let turn = rim.slope(up) + self.branch.excess * rim.a * up.0;
            let bend = self.branch.excess * rim.rho * half.1 * (2.0 * self.limit.hi - x).cos();
            m = 2.0 * half.0 * (turn - bend);
        }
        BranchAngle { angle: (s, c), n, m }
    }

    pub fn at(&self, place: BranchAngle<f64>) -> BranchPoint<f64> {
        if self.body.is_sharp() { self.branch.at::<false>(place) } else { self.branch.at::<true>(place) }
    }

    /// The inclination theta0 at which the body is balanced, as a sum of two doubles.
    pub fn balance(&self) -> Sum<f64> {
        self.balance
    }
}

/// Sine and cosine of an angle in (0, pi), which is a sum of two doubles.
#[inline(always)]
fn sum_sin_cos(theta: Sum<f64>) -> (f64, f64) {
    let (s, c) = sin_cos(theta.hi);
    (s + c * theta.lo, c - s * theta.lo)
}
