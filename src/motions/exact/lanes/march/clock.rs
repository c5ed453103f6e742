//! The time of a motion from one place to another within a panel (a range of one power series).
//!
//! ```text
//! F = (eta - low)(high - eta) W,   W = -R + r1/(eta - low) + r2/(high - eta)
//! R = F divided by both,   r1 = F(low)/(high - low),   r2 = F(high)/(high - low):   exactly 0 at a true zero
//! eta = mid - amp cos phi,   dt/dphi = (2 s0/Q) sqrt(J/W)
//! ```
//! Where F has no zero within reach, the edge of the panel takes its place. This does not reduce the accuracy:
//! dt/dphi is as smooth as dt/deta.

use super::{Rule, here};
use crate::laws::contact::reduced::Reduced;
use crate::motions::exact::lanes::series::angle_at;
use crate::numbers::power::{divide, horner};
use crate::numbers::{Lane, arctan2, sin_cos};

/// Nodes and weights of the Gauss rule of four nodes on [-1, 1].
const GAUSS_NODES: [f64; 4] =
    [-0.861_136_311_594_052_6, -0.339_981_043_584_856_26, 0.339_981_043_584_856_26, 0.861_136_311_594_052_6];
const GAUSS_WEIGHTS: [f64; 2] = [0.347_854_845_137_453_85, 0.652_145_154_862_546_2];

pub(super) struct PanelClock<'a, T, const N: usize> {
    law: &'a Reduced<T>,
    sin: T,
    cos: T,
    way: T,
    low: T,
    high: T,
    /// The quotient R of F by the distances from both turning points, as a series in eta; its last two terms are not
    /// used.
    rest: [T; N],
    /// The remainders r1 and r2 of the division of F by the distances from both turning points.
    left: [T; 2],
}

/// The place that the motion reaches at a given time.
pub(super) struct SoughtTime<T> {
    pub time: T,
    pub at: T,
    /// The distances of the place from both ends, which keep their digits next to a turning point.
    pub apart: [T; 2],
    pub tail: T,
    pub weakest: T,
}

impl<'a, T: Lane, const N: usize> PanelClock<'a, T, N> {
    /// The integrand of the time between two places `low` and `high`; 1 in `is_low` or `is_high` marks a place that
    /// is a turning point (zero of F).
    #[inline(always)]
    pub fn of(
        law: &'a Reduced<T>,
        (sin, cos): (T, T),
        way: T,
        force: &[T; N],
        [low, high]: [T; 2],
        [is_low, is_high]: [T; 2],
    ) -> Self {
        let (zero, half) = (way.splat(0.0), way.splat(0.5));
        let mut rest = *force;
        let r1 = divide(&mut rest, low);
        let r2 = divide(&mut rest[..N - 1], high);
        let per = way.splat(1.0) / (high - low);
        let r2 = is_high.select_lt(half, r1.fma(per, r2), zero);
        let r1 = is_low.select_lt(half, r1 * per, zero);
        Self { law, sin, cos, way, low, high, rest, left: [r1, r2] }
    }

    #[inline(always)]
    pub fn phase(&self, eta: T) -> T {
        let zero = eta.splat(0.0);
        let angle = arctan2((eta - self.low).max(zero).sqrt(), (self.high - eta).max(zero).sqrt());
        angle + angle
    }

    /// The distances eta - low and high - eta from both ends, at least 1e-30 so that they can be divisors.
    #[inline(always)]
    pub fn distances(&self, eta: T) -> [T; 2] {
        let least = eta.splat(1e-30);
        [(eta - self.low).max(least), (self.high - eta).max(least)]
    }

    /// The function W = F/((eta - low)(high - eta)), from the distances and the value `rest` of R.
    #[inline(always)]
    fn weight(&self, [above, below]: [T; 2], rest: T) -> T {
        let [r1, r2] = self.left;
        (r1 * below + r2 * above) / (above * below) - rest
    }

    /// F = J theta'^2 at eta, from the distances of eta from both ends.
    #[inline(always)]
    pub fn force(&self, eta: T, [above, below]: [T; 2]) -> T {
        above * below * self.weight([above, below], horner(&self.rest[..N - 2], eta))
    }

    /// The variable eta at the phase with this cosine.
    #[inline(always)]
    fn eta_at_phase(&self, cosine: T) -> T {
        let half = cosine.splat(0.5);
        half * (self.high + self.low) - half * (self.high - self.low) * cosine
    }

    /// The derivative dt/dphi of the time at four phases at once, which hides the latency of the arithmetic;
    /// `weakest` keeps the least W so far.
    #[inline(always)]
    fn rates(&self, cosines: [T; 4], weakest: &mut T) -> [T; 4] {
        let one = self.sin.splat(1.0);
        let mut eta = cosines;
        for eta in &mut eta {
            *eta = self.eta_at_phase(*eta);
        }
        let mut rest = [self.rest[N - 3]; 4];
        for c in self.rest[..N - 3].iter().rev() {
            for i in 0..4 {
                rest[i] = rest[i].fma(eta[i], *c);
            }
        }
        let twice = self.sin + self.sin;
        let mut rates = rest;
        for i in 0..4 {
            let w = self.weight(self.distances(eta[i]), rest[i]);
            let y = eta[i] * self.way;
            let q = (y - (self.cos + self.cos)).fma(y, one);
            *weakest = weakest.min(w);
            let inertia = self.law.inertia(|| angle_at(self.sin, self.cos, y, q));
            rates[i] = twice * (inertia / (w * q * q)).sqrt();
        }
        rates
    }

    /// The time from one phase to another, its quadrature error, and the least W = F/((eta - low)(high - eta))
    /// between them.
    #[inline(always)]
    pub fn between(&self, rule: &Rule, from: T, to: T) -> (T, T, T) {
        let number = here(
            #[inline(always)]
            |x: f64| from.splat(x),
        );
        let (zero, half) = (number(0.0), number(0.5));
        let (centre, width) = (half * (from + to), half * (to - from));
        let (sin_centre, cos_centre) = sin_cos(centre);
        let (mut sum, mut even, mut odd) = (zero, zero, zero);
        let mut weakest = number(f64::INFINITY);
        for two in rule.nodes.chunks_exact(2) {
            let (sin_a, cos_a) = sin_cos((width * number(two[0].x)).abs());
            let (sin_b, cos_b) = sin_cos((width * number(two[1].x)).abs());
            let (a, b) = (cos_centre * cos_a, sin_centre * sin_a);
            let (c, d) = (cos_centre * cos_b, sin_centre * sin_b);
            let [a_plus, a_minus, b_plus, b_minus] = self.rates([a - b, a + b, c - d, c + d], &mut weakest);
            for (node, plus, minus) in [(&two[0], a_plus, a_minus), (&two[1], b_plus, b_minus)] {
                sum = (plus + minus).fma(number(node.weight), sum);
                even = (plus + minus).fma(number(node.even), even);
                odd = (plus - minus).fma(number(node.odd), odd);
            }
        }
        let tail = even.abs() + odd.abs();
        (sum * width, number(100.0) * width.abs() * tail * tail / sum, weakest)
    }

    /// The precession from one phase to another, the integral of w1/s over the time; and its quadrature error.
    #[inline(always)]
    pub fn precession(&self, rule: &Rule, [from, to]: [T; 2], w1: &[T; N]) -> [T; 2] {
        let half = from.splat(0.5);
        let (centre, width) = (half * (from + to), half * (to - from));
        let (mut sum, mut weakest) = (from.splat(0.0), from.splat(f64::INFINITY));
        let (mut size, mut even, mut odd) = (sum, sum, sum);
        for two in rule.nodes.chunks_exact(2) {
            let [a, b] = [two[0].x, two[1].x].map(|x| width * from.splat(x));
            let cosines = [centre + a, centre - a, centre + b, centre - b].map(|x| sin_cos(x).1);
            let mut rates = self.rates(cosines, &mut weakest);
            for i in 0..4 {
                let y = self.eta_at_phase(cosines[i]) * self.way;
                let q = (y - (self.cos + self.cos)).fma(y, y.splat(1.0));
                let (sine, _) = angle_at(self.sin, self.cos, y, q);
                rates[i] = rates[i] * (horner(w1, y) / sine);
                size = rates[i].abs().fma(from.splat(two[i / 2].weight), size);
            }
            for (i, node) in two.iter().enumerate() {
                let (plus, minus) = (rates[2 * i], rates[2 * i + 1]);
                sum = (plus + minus).fma(from.splat(node.weight), sum);
                even = (plus + minus).fma(from.splat(node.even), even);
                odd = (plus - minus).fma(from.splat(node.odd), odd);
            }
        }
        let (tail, size) = (even.abs() + odd.abs(), size.max(from.splat(f64::MIN_POSITIVE)));
        [sum * width, from.splat(100.0) * width.abs() * tail * tail / size]
    }

    /// The place that the motion reaches at the time `target`, where it reaches `stop` at the time `whole`. Newton's
    /// method starts with an integral from `start` and adds a short integral at each step.
    #[inline(always)]
    pub fn sought(&self, rule: &Rule, [start, stop]: [T; 2], (target, whole): (T, T)) -> SoughtTime<T> {
        let number = here(
            #[inline(always)]
            |x: f64| start.splat(x),
        );
        let (zero, one, half) = (number(0.0), number(1.0), number(0.5));
        let (low, high) = (start.min(stop), start.max(stop));
        let mut phase = start + (stop - start) * (target / whole).min(one).max(zero);
        let (mut time, mut tail, mut weakest, mut cosine) = (zero, zero, zero, zero);
        for steps in [4, 2] {
            (time, tail, weakest) = self.between(rule, start, phase);
            cosine = sin_cos(phase).1;
            let mut slope = self.rates([cosine; 4], &mut weakest)[0];
            for _ in 0..steps {
                let next = (phase + (target - time) / slope).max(low).min(high);
                let (centre, width) = (half * (phase + next), half * (next - phase));
                let mut nodes = [cosine; 4];
                for (node, x) in nodes.iter_mut().zip(GAUSS_NODES) {
                    *node = sin_cos(centre + width * number(x)).1;
                }
                let rates = self.rates(nodes, &mut weakest);
                let [outer, inner] = GAUSS_WEIGHTS;
                let more = number(outer) * (rates[0] + rates[3]) + number(inner) * (rates[1] + rates[2]);
                time = time + width * more;
                phase = next;
                cosine = sin_cos(phase).1;
                slope = rates[3];
            }
        }
        let (sin, cos) = sin_cos(half * phase);
        let (width, least) = (self.high - self.low, number(1e-30));
        let apart = [sin, cos].map(|x| (width * (x * x)).max(least));
        SoughtTime { time, at: self.eta_at_phase(cosine), apart, tail, weakest }
    }
}
