//! Bodies and states in SIMD lanes, taken from their columns.

use super::MotionBlock;
use crate::laws::body::{Rim, Shape, beyond};
use crate::numbers::Real;
use crate::numbers::side_by_side::{MOST, SideBySide, apart};
use core::f64::consts::PI;

/// The index of the first of these motions, if their indices are consecutive; else None.
pub(super) fn first_of_consecutive(some: &[usize]) -> Option<usize> {
    let first = *some.first()?;
    some.iter().enumerate().all(|(k, i)| *i == first + k).then_some(first)
}

/// The numbers of a column from the motion `first` on, one in each SIMD lane; a single number fills all lanes.
#[inline(always)]
fn column<T: SideBySide>(like: T, of: &[f64], first: usize) -> T {
    if of.len() == 1 { like.splat(of[0]) } else { like.load(&of[first..]) }
}

/// A body and a state in every SIMD lane.
#[derive(Clone, Copy)]
pub(super) struct StartLanes<T> {
    pub shape: Shape<T>,
    /// The inclination at which a part other than the rim lands; pi if no other part lands.
    pub theta_end: T,
    /// Whether the rims are rounded, which is the same for all of the bodies.
    pub round: bool,
    pub state: [T; 4],
}

impl<T: Real> StartLanes<T> {
    /// Bodies and states from ell, I1, I3 and fillet, from theta_end (`given`, NaN for the default of the body), and
    /// from theta, w1, w2 and w3.
    #[inline(always)]
    fn of(numbers: [T; 4], given: T, state: [T; 4], round: bool) -> Self {
        let [ell, _, _, fillet] = numbers;
        let theta_end = given.select_lt(given.splat(f64::INFINITY), given, beyond(ell, fillet));
        Self { shape: Shape::of(numbers), theta_end, round, state }
    }

    /// 1 where body and state are certainly in the range in which motions are computed, else 0.
    #[inline(always)]
    pub fn in_range_mask(&self) -> T {
        let Shape { rim: Rim { ell, rho, .. }, i1, i3 } = self.shape;
        let [theta, w1, w2, w3] = self.state;
        let number = |x: f64| ell.splat(x);
        let (zero, one) = (number(0.0), number(1.0));
        let between = |x: T, low: f64, high: f64, yes: T| {
            number(low).select_lt(x, x.select_lt(number(high), yes, zero), zero)
        };
        let mut fits = (i3 - number(1e-12)).select_lt(i1 + i1, one, zero);
        // Only a ball may have its centre of mass below the circle of its rim.
        let least = number(1.0 - f64::EPSILON).select_lt(rho, number(-1.0), number(-f64::MIN_POSITIVE));
        fits = least.select_lt(ell, ell.select_lt(number(1e6), fits, zero), zero);
        fits = between(rho, -f64::MIN_POSITIVE, 1.0 + f64::EPSILON, fits);
        // A NaN does not fit.
        fits = between(self.theta_end, 1e-6, PI + f64::EPSILON * 4.0, fits);
        fits = between(i1, 1e-6, 1e12, fits);
        fits = between(i3, 1e-6, 1e12, fits);
        fits = between(theta, 1e-8, PI - 1e-8, fits);
        for w in [w1, w2, w3] {
            fits = between(w, -1e6, 1e6, fits);
        }
        fits
    }
}

impl MotionBlock<'_> {
    /// The bodies and states of these motions in SIMD lanes; unused lanes repeat the last motion.
    pub fn gather<T: SideBySide>(&self, like: T, some: &[usize], round: bool) -> StartLanes<T> {
        let last = some.len() - 1;
        if let Some(first) = first_of_consecutive(some).filter(|_| some.len() == T::COUNT) {
            let first = self.first + first;
            return apart(
                like,
                #[inline(always)]
                || {
                    let [a, b, c, r, most] = &self.starts.bodies;
                    let [d, e, f, g] = &self.starts.states;
                    let shape = [
                        column(like, a, first),
                        column(like, b, first),
                        column(like, c, first),
                        column(like, r, first),
                    ];
                    let state = [
                        column(like, d, first),
                        column(like, e, first),
                        column(like, f, first),
                        column(like, g, first),
                    ];
                    StartLanes::of(shape, column(like, most, first), state, round)
                },
            );
        }
        let mut places = [0; MOST];
        for (k, place) in places.iter_mut().enumerate() {
            *place = self.first + some[k.min(last)];
        }
        let fill = |x: &[f64]| {
            let mut lanes = [x[0]; MOST];
            if x.len() > 1 {
                for (lane, place) in lanes.iter_mut().zip(places) {
                    *lane = x[place];
                }
            }
            lanes
        };
        let (bodies, states) = (self.starts.bodies.map(fill), self.starts.states.map(fill));
        apart(
            like,
            #[inline(always)]
            || {
                let [a, b, c, r, most] = &bodies;
                let [d, e, f, g] = &states;
                let shape = [like.load(a), like.load(b), like.load(c), like.load(r)];
                let state = [like.load(d), like.load(e), like.load(f), like.load(g)];
                StartLanes::of(shape, like.load(most), state, round)
            },
        )
    }
}
