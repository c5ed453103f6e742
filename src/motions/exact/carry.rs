//! The initial state of a motion with twice the digits of a double, and the motion computed from it at other places.
//!
//! ```text
//! G = s^2 (2 E - al w1^2 - b n^2 + 2 k w1 n - 2 h),   G' = 2 s^2 (c G/s^2 + s tilting)
//! ```
//! Near an unstable steady state these are differences of numbers of order one, and the time for which the motion
//! lingers depends on their logarithm. Therefore the initial sine and cosine, the coefficients, the energy and the
//! power series from one place to another are computed with twice the digits of a double. No double is exactly a
//! steady state: e^(i theta) is transcendental (Lindemann), so that J theta'', a polynomial in it, is never 0.
//!
//! Error: 2^-100 of the terms, also after steps over half the reach of the series.

use super::panel::{PanelCentre, Poles, lines};
use crate::laws::body::Body;
use crate::laws::contact::Contact;
use crate::laws::contact::reduced::Reduced;
use crate::laws::state::State;
use crate::numbers::power::horner;
use crate::numbers::{Sum, long_sin_cos};

/// Number of terms of a power series, with which its error is 1e-36 within half its reach.
const CARRY_TERMS: usize = 44;

/// A place along a motion, with 32 digits.
#[derive(Debug, Clone)]
pub(super) struct PrecisePlace {
    /// Sine and cosine of theta, P = w1 sin(theta), and n = w3.
    pub at: [Sum<f64>; 4],
    /// Twice the energy of the rotation w2, J w2^2.
    tilting: Sum<f64>,
}

/// The initial state of a motion with 32 digits, and the coefficients for its continuation.
#[derive(Debug, Clone)]
pub(super) struct Origin {
    law: Reduced<Sum<f64>>,
    poles: Poles,
    twice_energy: Sum<f64>,
    start: PrecisePlace,
}

impl Origin {
    pub fn new(body: &Body, contact: Contact, y: &State) -> Self {
        let mut shape = body.shape().map(Sum::from);
        shape.rim.a = body.rim_sum();
        let [w1, w2, w3] = [y.w1, y.w2, y.w3].map(Sum::from);
        let law = Reduced::of(contact, &shape, !body.is_sharp());
        let [s, c] = long_sin_cos(y.theta);
        let tilting = law.inertia(|| (s, c)) * w2 * w2;
        let twice_energy = tilting + law.energy_without_tilting((s, c), w1, w3);
        let poles = Poles::of(&contact.reduced(body));
        Self { law, poles, twice_energy, start: PrecisePlace { at: [s, c, w1 * s, w3], tilting } }
    }

    pub fn start(&self) -> &PrecisePlace {
        &self.start
    }

    /// The values at a place, as the centre of a power series. K, twice the energy without that of the height and of
    /// the spin, is a sum of squares.
    pub fn centre(&self, place: &PrecisePlace) -> PanelCentre {
        let [s, c, p, n] = place.at;
        let (of, rim, w1) = (self.law.at((s, c)), &self.law.shape.rim, p / s);
        let k = if self.law.round {
            let slide = rim.radius((s, c)) * n - rim.depth((s, c)) * w1;
            self.law.shape.i1 * w1 * w1 + slide * slide
        } else {
            let slide = w1 - of.k / of.al * n;
            of.al * slide * slide
        };
        let k = (place.tilting + k).hi;
        PanelCentre { at: place.at.map(|x| x.hi), k, size: k.abs() }
    }

    /// The function G = J sin(theta)^2 theta'^2 and its slope in x at a place.
    #[inline(always)]
    pub fn g_and_slope(&self, place: &PrecisePlace) -> [f64; 2] {
        let [s, c, p, n] = place.at;
        let of = self.law.at((s, c));
        let push = self.law.tilting(&of, (s, c), p / s, n);
        let square = s * s;
        let slope = square * (c * place.tilting + s * push);
        [(square * place.tilting).hi, (slope + slope).hi]
    }

    /// The motion at the distance `by` in x from the start, where `x` is ln tan(theta/2) of the start.
    pub fn place_in_full(&self, x: f64, by: f64) -> PrecisePlace {
        crate::numbers::in_registers!(self.advance(x, by))
    }

    #[inline(always)]
    fn advance(&self, mut x: f64, by: f64) -> PrecisePlace {
        let (mut at, mut left) = (self.start.at, by);
        while left != 0.0 {
            let most = 0.5 * self.poles.reach(x);
            let h = left.max(-most).min(most);
            let [s, c, p, n, ..] = lines::<Sum<f64>, CARRY_TERMS>(&self.law, at);
            at = [s, c, p, n].map(|series| horner(&series, h.into()));
            left -= h;
            x += h;
        }
        let [s, c, p, n] = at;
        PrecisePlace { at, tilting: self.twice_energy - self.law.energy_without_tilting((s, c), p / s, n) }
    }
}
