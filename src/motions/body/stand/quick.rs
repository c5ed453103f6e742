//! A whole slide on a face, to rest, by integrals over the ratio of its speeds.
//!
//! ```text
//! |v| = r cos k,  a |w| = r sin k,   k' = B = sin k G_x - cos k gg/i3,   ln(r)' = -D = -(cos k G_x + sin k gg/i3)
//! left to rest from k   t = (r/mu) T(k),   path along v and across = (r^2/mu) (X + i Y)(k),   angle = (r^2/(mu a)) P(k)
//! B T' = D T - 1,   B P' = 2 D P - sin k,   B Z' = (2 D + i G_y/cos k) Z - cos k,   Z = X + i Y
//! ```
//! The rates are per tau, dt = (r/mu) dtau. The slide ends at the zero of B, where T, P and Z are regular: there, in a
//! first panel, they are polynomials through the equations at 16 places. From there outwards to the k of the start they are
//! integrals, as r and the direction are known as integrals of D/B and of G_y/(B cos k): all of them in panels of 16 places,
//! which end where part of the face lifts off, and shrink towards k = pi/4 (v = a w), 0 and pi/2, where a law is not smooth.
//! The heat is the energy.
//!
//! Error: 2e-11 of each, as far as compared; more places in a panel reduce it.

use crate::laws::contact::face::FaceFriction;
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use std::sync::LazyLock;

/// Places in a panel.
const PLACES: usize = 16;

/// The places of a panel and its ends on [-1, 1], and the integrals from -1 to each place and to 1 by the values there;
/// the derivatives at the places.
struct Collocation {
    places: [f64; PLACES],
    integrals: [[f64; PLACES]; PLACES + 1],
    derivatives: [[f64; PLACES]; PLACES],
    /// The values at -1, 0 and at 1.
    ends: [[f64; PLACES]; 3],
}

static COLLOCATION: LazyLock<Collocation> = LazyLock::new(|| {
    let n = PLACES;
    let places: [f64; PLACES] = core::array::from_fn(|j| -(PI * (j as f64 + 0.5) / n as f64).cos());
    let chebyshev = |k: usize, x: f64| (k as f64 * x.clamp(-1.0, 1.0).acos()).cos();
    // The coefficients of a series by the values: c_k = (2 or 1)/n sum T_k(x_j) f_j.
    let weight = |k: usize, j: usize| if k == 0 { 1.0 } else { 2.0 } / n as f64 * chebyshev(k, places[j]);
    let row =
        |of: &dyn Fn(usize) -> f64| core::array::from_fn(|j| (0..n).map(|k| of(k) * weight(k, j)).sum());
    let integral = |k: usize, x: f64| match k {
        0 => x + 1.0,
        1 => 0.5 * (x * x - 1.0),
        _ => {
            let at = |x: f64| {
                chebyshev(k + 1, x) / (2.0 * (k as f64 + 1.0))
                    - chebyshev(k - 1, x) / (2.0 * (k as f64 - 1.0))
            };
            at(x) - at(-1.0)
        }
    };
    let slope = |k: usize, x: f64| {
        let t = x.acos();
        k as f64 * (k as f64 * t).sin() / t.sin()
    };
    Collocation {
        integrals: core::array::from_fn(|i| row(&|k| integral(k, if i < n { places[i] } else { 1.0 }))),
        derivatives: core::array::from_fn(|i| row(&|k| slope(k, places[i]))),
        ends: [-1.0, 0.0, 1.0].map(|x| row(&|k| chebyshev(k, x))),
        places,
    }
});

fn dot(a: &[f64; PLACES], b: &[f64; PLACES]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// What is left of a slide, over r/mu, r^2/mu and r^2/(mu a): time, path along v and across it, and angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LeftOfSlide {
    pub time: f64,
    pub path: [f64; 2],
    pub angle: f64,
}

/// B, D and -G_y/cos k at an angle k.
#[derive(Debug, Clone, Copy)]
struct Rubs {
    turns: f64,
    slows: f64,
    bends: f64,
}

/// A slide of a body with i3 = I3/a^2 on a face.
#[derive(Debug, Clone, Copy)]
pub(crate) struct QuickSlide {
    friction: FaceFriction,
    i3: f64,
    /// The angle of the end, and where part of the face lifts off, if it does.
    end: f64,
    lifts: [f64; 2],
}

impl QuickSlide {
    /// The slides that end at the ratio `end` of v to s.
    pub fn new(friction: FaceFriction, i3: f64, end: f64) -> Self {
        let lifts = friction.lifts().map(|k| 1f64.atan2(k));
        Self { friction, i3, end: 1f64.atan2(end), lifts }
    }

    fn rates(&self, angle: f64, last: &mut Option<[f64; 2]>) -> Option<Rubs> {
        let (sin, cos) = angle.sin_cos();
        let force = self.friction.at(cos, sin, *last)?;
        *last = Some(force.centre);
        let couple = force.couple / self.i3;
        Some(Rubs {
            turns: sin * force.along - cos * couple,
            slows: cos * force.along + sin * couple,
            bends: -force.across / cos,
        })
    }

    /// What is left from the speeds v and s, over r/mu and so on; None if the body topples.
    pub fn left(&self, v: f64, s: f64) -> Option<LeftOfSlide> {
        let start = s.atan2(v);
        let way = if start < self.end { -1.0 } else { 1.0 };
        let distance = (start - self.end).abs();
        // How far a panel may reach from here: to the next place where the law is not smooth.
        let rough = [FRAC_PI_4, self.lifts[0], self.lifts[1]];
        let nearest = rough.iter().map(|x| (x - self.end).abs()).fold(f64::INFINITY, f64::min);
        let edge = if way > 0.0 { FRAC_PI_2 - self.end } else { self.end };
        let on_edge = nearest < ROUGH_END;
        let first = if on_edge { ROUGH_END } else { (0.5 * nearest).min(0.3).min(0.6 * edge.max(1e-3)) };
        let mut last = None;
        let (mut here, mut left) = self.first_panel(way, first.min(distance).max(1e-10), &mut last)?;
        if distance <= first {
            return Some(left);
        }
        loop {
            let gone = (here - self.end).abs();
            let mut reach = (WIDER * gone).min(start_gap(start, here));
            for place in rough {
                let gap = way * (place - here);
                if gap > 1e-13 {
                    reach = reach.min(if gap < 4.0 * ROUGH { gap } else { (0.6 * gap).max(ROUGH) });
                } else {
                    reach = reach.min((2.0 * -gap).max(ROUGH));
                }
            }
            let edge = if way > 0.0 { FRAC_PI_2 - here } else { here };
            reach = reach.min((0.5 * edge).max(1e-300)).min(0.5);
            let done = reach >= start_gap(start, here);
            let next = if done { start } else { here + way * reach };
            left = self.panel(here, next, left, &mut last)?;
            here = next;
            if done {
                return Some(left);
            }
        }
    }

    /// The panel next to the end, of this length outwards: the angle of its outer end, and what is left there.
    fn first_panel(&self, way: f64, length: f64, last: &mut Option<[f64; 2]>) -> Option<(f64, LeftOfSlide)> {
        let of = &*COLLOCATION;
        let half = 0.5 * way * length;
        let middle = self.end + half;
        // (B/half) derivative - factor value = -source
        let mut systems = [[[0.0; PLACES + 1]; PLACES]; 2];
        let mut turned = [[0.0; 2 * PLACES + 1]; 2 * PLACES];
        for i in 0..PLACES {
            let angle = middle + half * of.places[i];
            let rubs = self.rates(angle, last)?;
            let (sin, cos) = angle.sin_cos();
            for j in 0..PLACES {
                let slope = rubs.turns / half * of.derivatives[i][j];
                systems[0][i][j] = slope;
                systems[1][i][j] = slope;
                turned[i][j] = slope;
                turned[i + PLACES][j + PLACES] = slope;
            }
            systems[0][i][i] -= rubs.slows;
            systems[1][i][i] -= 2.0 * rubs.slows;
            systems[0][i][PLACES] = -1.0;
            systems[1][i][PLACES] = -sin;
            turned[i][i] -= 2.0 * rubs.slows;
            turned[i + PLACES][i + PLACES] -= 2.0 * rubs.slows;
            // i bends Z is moved from the rate of the direction
            turned[i][i + PLACES] -= rubs.bends;
            turned[i + PLACES][i] += rubs.bends;
            turned[i][2 * PLACES] = -cos;
        }
        let [time, angle] = systems.map(solved);
        let path = solved(turned);
        let [x, y]: [[f64; PLACES]; 2] = [0, PLACES].map(|at| core::array::from_fn(|i| path[at + i]));
        let out = |values: &[f64; PLACES]| dot(values, &of.ends[2]);
        let left = LeftOfSlide { time: out(&time), path: [out(&x), out(&y)], angle: out(&angle) };
        Some((self.end + way * length, left))
    }

    /// What is left at `to`, from what is left at `from`.
    fn panel(
        &self,
        from: f64,
        to: f64,
        left: LeftOfSlide,
        last: &mut Option<[f64; 2]>,
    ) -> Option<LeftOfSlide> {
        let of = &*COLLOCATION;
        let half = 0.5 * (to - from);
        let middle = 0.5 * (to + from);
        let (mut grows, mut bends, mut inverse) = ([0.0; PLACES], [0.0; PLACES], [0.0; PLACES]);
        for i in 0..PLACES {
            let rubs = self.rates(middle + half * of.places[i], last)?;
            inverse[i] = half / rubs.turns;
            (grows[i], bends[i]) = (-rubs.slows * inverse[i], rubs.bends * inverse[i]);
        }
        // r over that at `from`, and the direction less that there.
        let mut sums = [0.0; 4];
        for i in 0..PLACES {
            let (size, turn) = (dot(&grows, &of.integrals[i]).exp(), dot(&bends, &of.integrals[i]));
            let (sin, cos) = (middle + half * of.places[i]).sin_cos();
            let (aside, ahead) = turn.sin_cos();
            let by = -inverse[i] * of.integrals[PLACES][i];
            let square = by * size * size;
            sums[0] += by * size;
            sums[1] += square * cos * ahead;
            sums[2] += square * cos * aside;
            sums[3] += square * sin;
        }
        let (size, turn) = (dot(&grows, &of.integrals[PLACES]).exp(), dot(&bends, &of.integrals[PLACES]));
        let (aside, ahead) = turn.sin_cos();
        let over = 1.0 / size;
        let [x, y] = [left.path[0] + sums[1], left.path[1] + sums[2]].map(|x| x * over * over);
        Some(LeftOfSlide {
            time: (left.time + sums[0]) * over,
            // In the direction at `to`, which is turned from that at `from`.
            path: [x * ahead + y * aside, y * ahead - x * aside],
            angle: (left.angle + sums[3]) * over * over,
        })
    }
}

/// The length below which a place where the law is not smooth is not resolved, and the length of a panel over that from
/// the end of the slide.
const ROUGH: f64 = 1e-4;
const WIDER: f64 = 1.0;
/// The first panel of a slide that ends at such a place.
const ROUGH_END: f64 = 1e-8;

fn start_gap(start: f64, here: f64) -> f64 {
    (start - here).abs()
}

/// The solution of linear equations, by elimination; the last column is the right side.
fn solved<const N: usize, const M: usize>(mut rows: [[f64; M]; N]) -> [f64; N] {
    for i in 0..N {
        let pivot = (i..N).max_by(|a, b| rows[*a][i].abs().total_cmp(&rows[*b][i].abs())).unwrap_or(i);
        rows.swap(i, pivot);
        let lead = rows[i];
        for row in rows.iter_mut().skip(i + 1) {
            let factor = row[i] / lead[i];
            for k in i..M {
                row[k] -= factor * lead[k];
            }
        }
    }
    let mut found = [0.0; N];
    for i in (0..N).rev() {
        let known: f64 = (i + 1..N).map(|k| rows[i][k] * found[k]).sum();
        found[i] = (rows[i][M - 1] - known) / rows[i][i];
    }
    found
}
