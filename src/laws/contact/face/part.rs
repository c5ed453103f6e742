//! The part of a face that presses, and the integrals over it from which X and the friction follow.
//!
//! ```text
//! p = x.n_X - cos b where that is positive,   width = sin^2(b/2),   angle c of n_X = X/|X|,   d the angle of u from n_X
//! residual   X - lam G in the frame of X = (|X| - lam <cos d>, -lam <sin d>),   <sin t> = 0 across X
//! d<f>/d width = 2 (int f - <f> int 1)/int p,   dG/dc = int (across) u/|u|/int p,   dX/dc = |X| across
//! couple   gg = <(1 - cos d) across> - <(1 - along) sin d>,   as <sin d> = 0 of a solution
//! ```
//! All quantities above are integrals over the same nodes, so that Newton's method has exact derivatives. In the frame
//! of X the terms are as small as their sums for a slow spin and for a small part.

use crate::numbers::side_by_side::SideBySide;
use crate::numbers::{LANES, Pair, here};

/// The nodes of Gauss's rule of 24 nodes, and their weights.
#[rustfmt::skip]
pub(super) const GAUSS_PLACES: [f64; 24] = [
    -0.9951872199970213, -0.9747285559713095, -0.9382745520027328, -0.8864155270044011, -0.820001985973903, -0.7401241915785544,
    -0.6480936519369755, -0.5454214713888396, -0.4337935076260451, -0.3150426796961634, -0.1911188674736163, -0.06405689286260563,
    0.06405689286260563, 0.1911188674736163, 0.3150426796961634, 0.4337935076260451, 0.5454214713888396, 0.6480936519369755,
    0.7401241915785544, 0.820001985973903, 0.8864155270044011, 0.9382745520027328, 0.9747285559713095, 0.9951872199970213,
];
#[rustfmt::skip]
pub(super) const GAUSS_WEIGHTS: [f64; 24] = [
    0.0123412297999872, 0.028531388628933663, 0.04427743881741981, 0.05929858491543678, 0.0733464814110803, 0.08619016153195327,
    0.09761865210411388, 0.10744427011596563, 0.1155056680537256, 0.12167047292780339, 0.1258374563468283, 0.12793819534675216,
    0.12793819534675216, 0.1258374563468283, 0.12167047292780339, 0.1155056680537256, 0.10744427011596563, 0.09761865210411388,
    0.08619016153195327, 0.0733464814110803, 0.05929858491543678, 0.04427743881741981, 0.028531388628933663, 0.0123412297999872,
];

/// A part of the face that presses: its width sin^2(b/2), the angle c of its middle from the velocity v, and pi/2 - c.
#[derive(Debug, Clone, Copy)]
pub(super) struct PressedPart {
    pub width: f64,
    pub angle: f64,
    pub off: f64,
}

impl PressedPart {
    /// The part with this increase of its width and this increase of its angle.
    pub fn moved(&self, width: f64, angle: f64) -> Self {
        Self { width: self.width + width, angle: self.angle + angle, off: self.off - angle }
    }

    /// The part of this width whose middle is in the direction of this vector from the axis.
    pub fn towards(width: f64, centre: [f64; 2]) -> Self {
        Self { width, angle: centre[1].atan2(centre[0]), off: centre[0].atan2(centre[1]) }
    }
}

const INTEGRALS: usize = 11;
/// Numbers that are summed side by side: always eight, so that sums are added in the same order on every machine.
pub(super) type ArcSides = Pair<Pair<Pair<f64>>>;
/// Eight zeros, at which sums side by side begin.
pub(super) const ZEROS: ArcSides =
    Pair(Pair(Pair(0.0, 0.0), Pair(0.0, 0.0)), Pair(Pair(0.0, 0.0), Pair(0.0, 0.0)));

/// Sums of integrals over a pressed part, in SIMD lanes.
pub(super) struct FaceIntegrals<T> {
    sums: [T; INTEGRALS],
}

/// The terms at one node of the quadrature: its weight, the pressure, 1 - along and across of its place, and sin d and
/// 1 - cos d of its slip. Here along and across are components along X and across it, and d is the angle of the slip
/// from X.
#[derive(Clone, Copy)]
pub(super) struct ElementForce<T> {
    pub weight: T,
    pub pressed: T,
    pub short: T,
    pub across: T,
    pub aside: T,
    pub back: T,
}

/// 1 - cos d from sin d and cos d, without loss of digits for small d.
#[inline(always)]
pub(super) fn one_less<T: SideBySide>(sine: T, cosine: T) -> T {
    let size = sine.splat(1.0) + cosine.abs();
    sine.splat(0.0).select_lt(cosine, sine * sine / size, size)
}

impl<T: SideBySide> FaceIntegrals<T> {
    #[inline(always)]
    pub fn new(like: T) -> Self {
        Self { sums: [like.splat(0.0); INTEGRALS] }
    }

    /// Adds the integrals over a chord, or the terms of a node.
    #[inline(always)]
    pub fn add(&mut self, terms: [T; INTEGRALS]) {
        for (sum, term) in self.sums.iter_mut().zip(terms) {
            *sum = *sum + term;
        }
    }

    /// Adds the terms of a node.
    #[inline(always)]
    pub fn rub(&mut self, of: ElementForce<T>) {
        let ElementForce { weight, pressed, short, across, aside, back } = of;
        let terms = [
            pressed,
            pressed * short,
            pressed * aside,
            pressed * back,
            pressed * (back * across - aside * short),
            weight,
            weight * short,
            weight * aside,
            weight * back,
            weight * across * aside,
            weight * across * back,
        ];
        self.add(terms);
    }

    /// The residual, force and centre of the pressure that follow from the integrals, for lam = mu Z/a.
    #[inline(always)]
    pub fn pressed(&self, lam: f64) -> PressedFace {
        let total = here(
            #[inline(always)]
            |i: usize| {
                let mut sides = [0.0; LANES];
                self.sums[i].spill(&mut sides);
                let [a, b, c, d, e, f, g, h] = sides;
                ((a + b) + (c + d)) + ((e + f) + (g + h))
            },
        );
        let of: [f64; INTEGRALS] = core::array::from_fn(total);
        let over = 1.0 / of[0];
        let [short, aside, back, couple] = [1, 2, 3, 4].map(|i| of[i] * over);
        let by_width = |plain: f64, mean: f64| 2.0 * over * (plain - mean * of[5]);
        let centre = 1.0 - short;
        PressedFace {
            residual: [(1.0 - lam) - short + lam * back, -lam * aside],
            by_width: [lam * by_width(of[8], back) - by_width(of[6], short), -lam * by_width(of[7], aside)],
            by_angle: [lam * over * of[10], centre - lam * over * of[9]],
            centre,
            force: 1.0 - back,
            couple,
        }
    }
}

/// The result for one pressed part: the residual X - lam G in the frame of X, its derivatives by width and angle, and the means.
#[derive(Debug, Clone, Copy)]
pub(super) struct PressedFace {
    pub residual: [f64; 2],
    pub by_width: [f64; 2],
    pub by_angle: [f64; 2],
    /// The distance |X| of the centre of the pressure from the axis, over a.
    pub centre: f64,
    /// The mean G along X (`force`), and the mean couple gg.
    pub force: f64,
    pub couple: f64,
}

impl PressedFace {
    /// The determinant of the derivatives of the residual; it is negative for the centre of the pressure that is
    /// nearest to the axis.
    pub fn determinant(&self) -> f64 {
        self.by_width[0] * self.by_angle[1] - self.by_width[1] * self.by_angle[0]
    }
}
