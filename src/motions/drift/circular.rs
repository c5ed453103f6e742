//! The steady states of rolling whose centre moves on a circle, as a surface, and the drift over it of a body that
//! loses energy.
//!
//! ```text
//! w1 = Omega s,   S = (I3 s + A h) w3 Omega - (I1 c + h L) s Omega^2 - g = J w2' at w2 = 0,   S = 0: no tilting
//! f = (dw1/dtheta, dw3/dtheta) of `contact::reduced`,   a = part of (w1', w3') that comes from the couple
//! a1 = ((I3 + A^2) m1 + A L m3)/D,   a3 = (A L m1 + (I1 + L^2) m3)/D,   D = I1 I3 + I1 A^2 + I3 L^2
//! F = S_w1 a1 + S_w3 a3,    theta' = -F/(J kappa),   w' = a + f theta'
//! J kappa = I1 Omega^2 - 2 I1 c Omega f1 + I3 (f1 w3 + w1 f3) + (h/s) (f1 - c Omega) V - g Omega V + h Omega V' - g'
//! V = A w3 - L w1,   V' = rho (c w3 + s w1) + A f3 - L f1
//! dx = dt R/(J kappa),   R^2 = (F/s)^2 + (J kappa Omega'/Omega)^2 + (J kappa w3')^2/(w1^2 + w3^2)
//! ```
//! The motion is of first order in the losses: these change w1 and w3, and theta changes so that theta'' stays zero.
//! The equations themselves keep the state on the surface, S' = 0. Solving S = 0 for w3 instead would divide by I3 s +
//! A h, which vanishes for a thin disk as theta -> 0, and for a displaced ball where h = -I3. In x, the length of the
//! path in ln theta, ln Omega and w3, the equations are regular where theta turns, and where kappa vanishes, which is
//! the end of the drift. Above pi/2 the inclination is counted from pi, so that it keeps all its digits. The letters s,
//! c, rho, A, L, h and g are those of `body::rim`.
//!
//! Error: a few roundings of the terms written above; tests of `drift` compare kappa with that of `stability`, and the
//! whole drift with 40 digits.

use crate::laws::body::Shape;
use crate::laws::contact::Contact;
use crate::laws::contact::reduced::Reduced;
use crate::laws::loss::{Couples, Kinematics};
use crate::numbers::{Real, sin_cos};

/// A body that rolls and loses energy while it drifts; T holds one body, or eight in SIMD lanes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Circular<T> {
    of: Reduced<T>,
    losses: Couples<T>,
    /// The initial signs of psi' and w_z, 1 or -1: the directions in which the contact point moves along the rim and
    /// drills.
    pub signs: [T; 2],
}

/// The inclination (counted from 0 or from pi), Omega, w3 and the time.
pub(crate) type Numbers<T> = [T; 4];

/// The rates of a drift in a state, and the quantities whose zeros end the drift.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CirclePoint<T> {
    /// The derivatives of inclination, Omega, w3 and time with respect to the path length x.
    pub rates: Numbers<T>,
    /// J kappa: the stiffness of the nutation, whose zero ends the drift.
    pub stiffness: T,
    /// The rates psi' and w_z, times their initial signs.
    pub going: [T; 2],
    pub w1: T,
    /// The speed |V| of the centre of mass.
    pub speed: T,
}

impl<T: Real> Circular<T> {
    #[inline(always)]
    pub fn new(shape: &Shape<T>, round: bool, losses: Couples<T>) -> Self {
        let one = shape.i1.splat(1.0);
        Self { of: Reduced::of(Contact::Rolling, shape, round), losses, signs: [one; 2] }
    }

    /// Returns these equations for another type of number.
    pub fn map<U: Real>(&self, number: impl Fn(T) -> U) -> Circular<U> {
        let of = &self.of;
        let signs = self.signs.map(&number);
        let losses = self.losses.map(&number);
        Circular { signs, ..Circular::new(&of.shape.map(number), of.round, losses) }
    }

    /// The state after a step. For a ball one step of Newton's method back to the surface S = 0 of steady states
    /// removes the rounding error, since near the pole all terms of S are small. Near a face S is a small difference
    /// of large terms, and the equations of motion keep S = 0 more precisely than this step would.
    #[inline(always)]
    pub fn kept(&self, y: &Numbers<T>, far: T) -> Numbers<T> {
        let (near, a) = (self.settled(y, far), self.of.shape.rim.a);
        let zero = a.splat(0.0);
        let pick = |i: usize| zero.select_lt(a, y[i], near[i]);
        [y[0], pick(1), pick(2), y[3]]
    }

    /// The state after a step of Newton's method towards the surface S = 0 of steady states: Omega and w3 change,
    /// each in proportion to its effect on S.
    #[inline(always)]
    pub fn settled(&self, [theta, rate, w3, t]: &Numbers<T>, far: T) -> Numbers<T> {
        let (s, c) = sin_cos(*theta);
        let angle = (s, far * c);
        let (Shape { rim, i1, i3 }, c, rate, w3) = (self.of.shape, angle.1, *rate, *w3);
        let (height, radius, depth) = (rim.height(angle), rim.radius(angle), rim.depth(angle));
        let (by_both, by_square) = (i3 * s + radius * height, (i1 * c + height * depth) * s);
        let miss = (by_both * w3 - by_square * rate) * rate - rim.lever(angle);
        let turning = (rate * s).abs() + w3.abs();
        let by_rate = (by_both * w3 - (by_square + by_square) * rate) * rate;
        let by_w3 = by_both * rate * turning;
        // Scaling by the larger number avoids squares of numbers that may be very large or small.
        let size = by_rate.abs().max(by_w3.abs());
        let (along, across) = (by_rate / size, by_w3 / size);
        let part = miss / size / (along * along + across * across);
        [*theta, rate - part * along * rate, w3 - part * across * turning, *t]
    }

    /// The velocity V of the centre of mass along e2.
    #[inline(always)]
    pub fn speed(&self, angle: (T, T), w1: T, w3: T) -> T {
        let rim = self.of.shape.rim;
        rim.radius(angle) * w3 - rim.depth(angle) * w1
    }

    /// The rates with respect to the path length x, and the quantities whose zeros end the drift; `far` is -1 where
    /// the inclination is counted from pi, else 1.
    #[inline(always)]
    pub fn at(&self, [theta, rate, w3, _]: &Numbers<T>, far: T) -> CirclePoint<T> {
        let (s, c) = sin_cos(*theta);
        let (angle, rate, w3) = ((s, far * c), *rate, *w3);
        let (Shape { rim, i1, i3 }, c) = (self.of.shape, angle.1);
        let of = self.of.at(angle);
        let (height, radius, depth, lever) =
            (rim.height(angle), rim.radius(angle), rim.depth(angle), rim.lever(angle));
        let w1 = rate * s;
        let one = s.splat(1.0);
        let (turn, per_s) = (c * rate, one / s);
        let ct = c * per_s;
        let f1 = of.q * w3 - of.p * w1 - turn;
        let f3 = of.r * w1 + of.t * w3;
        let v = self.speed(angle, w1, w3);
        let v_slope = rim.rho * (c * w3 + s * w1) + radius * f3 - depth * f1;
        let stiffness = i1 * rate * (rate - (c * f1 + c * f1))
            + i3 * (f1 * w3 + w1 * f3)
            + height * (per_s * (f1 - turn) * v + rate * v_slope)
            - lever * rate * v
            - rim.slope(angle);
        let mut seen = Kinematics::of(&rim, angle, rate, [w1, s.splat(0.0), w3]);
        let going = [self.signs[0] * seen.spin, self.signs[1] * seen.drilling()];
        seen.signs = self.signs;
        let couple = self.losses.at(&seen);
        let (m1, m3) = (couple.free[0] + couple.pressed[0], couple.free[2] + couple.pressed[2]);
        let per_d = one / (i1 * (i3 + radius * radius) + i3 * depth * depth);
        let (a1, a3) = ((of.b * m1 + of.k * m3) * per_d, (of.k * m1 + of.al * m3) * per_d);
        // The derivatives of S with respect to w1 and w3 follow from S = -`Reduced::tilting`.
        let by_w1 = of.b * w3 - of.k * (w1 + w1) - ct * (of.al * (w1 + w1) - of.k * w3);
        let by_w3 = (ct * of.k + of.b) * w1;
        let force = by_w1 * a1 + by_w3 * a3;
        // Scaling by the largest part avoids squares of numbers that may be as large as 1e280.
        let lean = force * per_s;
        let slow = (a1 * (stiffness / rate) - (f1 - turn) / rate * force) * per_s;
        let axial = a3 * stiffness - f3 * force;
        let per_turning = one / (w1 * w1 + w3 * w3).sqrt();
        let largest = lean.abs().max(slow.abs()).max(axial.abs() * per_turning);
        let parts = [lean / largest, slow / largest, axial / largest];
        let third = parts[2] * per_turning;
        let scale = one / (parts[0] * parts[0] + parts[1] * parts[1] + third * third).sqrt();
        CirclePoint {
            rates: [
                -(far * s * parts[0] * scale),
                rate * parts[1] * scale,
                parts[2] * scale,
                stiffness / largest * scale,
            ],
            stiffness,
            going,
            w1,
            speed: v.abs(),
        }
    }
}

impl Circular<f64> {
    /// Whether a body lies nearly flat on a face and spins so fast that only the terms of S in Omega count:
    /// w1/w3 = A L/(I1 + L^2).
    pub fn is_flat_and_fast(&self, [theta, rate, w3, _]: &Numbers<f64>, far: f64) -> bool {
        const FLAT_SPIN_RATIO: f64 = 1e12;
        let (rim, (s, c)) = (&self.of.shape.rim, theta.sin_cos());
        let height = rim.height((s, far * c));
        (height * w3 * rate).abs() > FLAT_SPIN_RATIO && rim.a * height.abs() > FLAT_SPIN_RATIO * theta
    }
}

/// The time per e-fold of the inclination: theta |dt/dtheta|.
#[inline(always)]
pub(crate) fn time_per_e_fold<T: Real, const N: usize>(y: &[T; N], rate: &[T; N]) -> T {
    (y[0] * rate[3] / rate[0]).abs()
}
