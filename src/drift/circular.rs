//! Circular steady states as a surface, and how a rolling body that loses energy moves over it.
//!
//! ```text
//! w1 = Omega s,   w3 = (Omega s (I1 c + h L) + g/Omega)/(I3 s + A h)      no tilting: one w3 for every theta and Omega
//! S = J w2' at w2 = 0,   f = (dw1/dtheta, dw3/dtheta) of `contact::reduced`,   a = what the couple makes of (w1', w3')
//! a1 = ((I3 + A^2) m1 + A L m3)/D,   a3 = (A L m1 + (I1 + L^2) m3)/D,   D = I1 I3 + I1 A^2 + I3 L^2
//! F = S_w1 a1 + S_w3 a3,    theta' = -F/(J kappa),   w' = a + f theta'
//! J kappa = I1 Omega^2 - 2 I1 c Omega f1 + I3 (f1 w3 + w1 f3) + (h/s) (f1 - c Omega) V - g Omega V + h Omega V' - g'
//! V = A w3 - L w1,   V' = rho (c w3 + s w1) + A f3 - L f1
//! dx = dt R/(J kappa),   R^2 = (F/s)^2 + (J kappa Omega'/Omega)^2
//! ```
//! To first order in the losses: theta follows the two numbers that the losses change so that nothing tilts, and stays
//! on the surface exactly, because w3 is solved for. In x, the way in ln theta and ln Omega, the equations are regular
//! where theta turns, and where kappa vanishes, which is the end. s, c, rho, A, L, h, g as in `body::rim`.
//!
//! Error: a few roundings of the terms written above; a test of `drift` holds kappa to that of `stability`.

use crate::body::Shape;
use crate::contact::Contact;
use crate::contact::reduced::Reduced;
use crate::loss::{Couples, Seen};
use crate::number::{Real, sin_cos};

/// A body that rolls and loses energy, one or eight in lanes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Circular<T> {
    of: Reduced<T>,
    losses: Couples<T>,
    /// The ways in which the contact runs and drills, as at the start.
    pub signs: [T; 2],
}

/// What a drift knows of a state: theta and Omega decide the rest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Known<T> {
    /// d theta, d Omega and dt over dx.
    pub rates: [T; 3],
    /// J kappa.
    pub stiffness: T,
    /// psi' and w_z, times their signs at the start.
    pub going: [T; 2],
    pub turning: [T; 2],
    /// |V|, the speed of the centre.
    pub speed: T,
}

impl<T: Real> Circular<T> {
    #[inline(always)]
    pub fn new(shape: &Shape<T>, round: bool, losses: Couples<T>) -> Self {
        let one = shape.i1.splat(1.0);
        Self { of: Reduced::of(Contact::Rolling, shape, round), losses, signs: [one; 2] }
    }

    /// w3 of a state.
    #[inline(always)]
    fn axial(&self, angle: (T, T), rate: T) -> T {
        let (Shape { rim, i1, i3 }, (s, c)) = (self.of.shape, angle);
        let (height, radius, depth) = (rim.height(angle), rim.radius(angle), rim.depth(angle));
        let push = rate * s * (i1 * c + height * depth) * rate + rim.lever(angle);
        push / (rate * (i3 * s + radius * height))
    }

    /// The state, and how it changes along the way.
    #[inline(always)]
    pub fn at(&self, theta: T, rate: T) -> Known<T> {
        let angle = sin_cos(theta);
        let (Shape { rim, i1, i3 }, (s, c)) = (self.of.shape, angle);
        let of = self.of.at(angle);
        let (height, radius, depth, lever) =
            (rim.height(angle), rim.radius(angle), rim.depth(angle), rim.lever(angle));
        let (w1, w3) = (rate * s, self.axial(angle, rate));
        let one = s.splat(1.0);
        let (turn, per_s) = (c * rate, one / s);
        let ct = c * per_s;
        let f1 = of.q * w3 - of.p * w1 - turn;
        let f3 = of.r * w1 + of.t * w3;
        let v = radius * w3 - depth * w1;
        let v_slope = rim.rho * (c * w3 + s * w1) + radius * f3 - depth * f1;
        let stiffness = i1 * rate * (rate - (c * f1 + c * f1))
            + i3 * (f1 * w3 + w1 * f3)
            + height * (per_s * (f1 - turn) * v + rate * v_slope)
            - lever * rate * v
            - rim.slope(angle);
        let mut seen = Seen::of(&rim, angle, rate, [w1, s.splat(0.0), w3]);
        let going = [self.signs[0] * seen.spin, self.signs[1] * seen.drilling()];
        seen.signs = self.signs;
        let couple = self.losses.at(&seen);
        let (m1, m3) = (couple.free[0] + couple.pressed[0], couple.free[2] + couple.pressed[2]);
        let per_d = one / (i1 * (i3 + radius * radius) + i3 * depth * depth);
        let (a1, a3) = ((of.b * m1 + of.k * m3) * per_d, (of.k * m1 + of.al * m3) * per_d);
        // S = -tilting
        let by_w1 = of.b * w3 - of.k * (w1 + w1) - ct * (of.al * (w1 + w1) - of.k * w3);
        let by_w3 = (ct * of.k + of.b) * w1;
        let force = by_w1 * a1 + by_w3 * a3;
        let slower = (a1 * stiffness - (f1 - turn) * force) * per_s;
        let (lean, slow) = (force * per_s, slower / rate);
        let scale = one / (lean * lean + slow * slow).sqrt();
        Known {
            rates: [-(force * scale), slower * scale, stiffness * scale],
            stiffness,
            going,
            turning: [w1, w3],
            speed: v.abs(),
        }
    }
}

impl<T: Real> Known<T> {
    /// One lane of it.
    pub fn lane(&self, pick: impl Fn(T) -> f64) -> Known<f64> {
        Known {
            rates: self.rates.map(&pick),
            stiffness: pick(self.stiffness),
            going: self.going.map(&pick),
            turning: self.turning.map(&pick),
            speed: pick(self.speed),
        }
    }
}
