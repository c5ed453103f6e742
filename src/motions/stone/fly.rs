//! A stone in the air: its rotation as a power series in the time, and the landing of its lowest point, with bounds
//! by which no landing is missed.
//!
//! ```text
//! m = I w,   m' = m x w - (b + b2 |w|) w,   n' = n x w,   q' = q w/2,   lost' = (b + b2 |w|) w.w
//! h = z - S - n.d,   S = sqrt(n.D n)          the height of the lowest point;   z the parabola of the centre
//! h'' <= K = (1 + 1/sqrt 3) W^2 rho - 1,   W^2 = min(w.m/I_min, |m|^2/I_min^2),   rho = max a + |d|
//! ```
//! The equations are quadratic, so that each coefficient is a sum of products of those before it. A piece of a series ends
//! where its last terms are below rounding, those of S included, whose root may have a smaller circle of convergence. h is
//! the least height of all points of the stone, and each of them accelerates by at most W^2 rho (1 + 1/sqrt 3), since
//! |w'|^2 <= w^4/3 for any moments; the couple of the air, b and b2, adds its part. The least of functions that bend by at
//! most K does so, too. A point that touches at the start has a height that grows as t^k, by which its series is divided.
//!
//! Error: a few roundings of the state for each turn, unless the rotation about the middle axis flips over (the
//! tennis racket theorem).

use super::flow::{SLID_X, STONE_X, STONE_Y, StoneNumbers};
use super::turns::Spot;
use crate::laws::loss::{Law, Losses};
use crate::laws::stone::law::{StoneLaw, laboratory, turning};
use crate::methods::falling::first_zero_of_powers;
use crate::methods::flow::Exhausted;
use crate::motions::walk::hops::{HARDLY, Leaves, terms_until};
use crate::motions::walk::numbers::{TIME, loses, lost};
use crate::numbers::Dual;
use crate::numbers::vector::{cross, dot, plus};

/// Number of terms of the power series of a flight.
pub(super) const AIR_TERMS: usize = 30;
/// A piece of a flight's power series ends where its last terms reach this share of the components.
const CUT: f64 = 1e-17;
/// The longest time for which one piece of a flight's power series is used, in sqrt(a/g).
const LONGEST_PIECE: f64 = 10.0;
/// Share of the circle without a zero of S, for a start on the table, in which the power series is used.
const CIRCLE_SHARE: f64 = 1.0 / 3.0;

/// A negative height counts as that of a stone that touches the table if it is at most this far below 0.
const TOUCHES: f64 = 1e-12;

type MotionPowers<const K: usize> = [[f64; K]; AIR_TERMS];

/// A piece of a flight, as power series of the time since the beginning of the piece.
pub(super) struct AirPiece {
    terms: usize,
    quaternion: MotionPowers<4>,
    w: MotionPowers<3>,
    height: [f64; AIR_TERMS],
    lost: [f64; AIR_TERMS],
    /// The time at which the piece begins, since the start of the flight.
    pub from: f64,
    pub length: f64,
    /// A bound of the second derivative of the height.
    bend: f64,
}

/// A flight of a stone.
pub(super) struct StoneFlight {
    law: StoneLaw<f64>,
    /// The coefficients of the linear and the quadratic couple of the air.
    air: [f64; 2],
    /// The smallest moment of inertia; the next field is the largest distance of a point from the centre of mass.
    least: f64,
    reach: f64,
    /// The position of the centre of mass at the start; the next field is its velocity.
    centre: [f64; 3],
    velocity: [f64; 3],
    tilt: f64,
}

/// A stone in the air: its state vector, and the height and vertical velocity of its lowest point.
#[derive(Clone, Copy)]
pub(super) struct StoneAloft<const N: usize> {
    pub y: [f64; N],
    pub height: f64,
    pub lift: f64,
}

/// The coefficient of order `k` of the product of two power series.
fn product<A: Copy, B: Copy, U>(
    k: usize,
    a: &[A],
    b: &[B],
    of: impl Fn(A, B) -> U,
    sum: impl Fn(U, U) -> U,
) -> U {
    (1..=k).fold(of(a[0], b[k]), |all, i| sum(all, of(a[i], b[k - i])))
}

/// The coefficient of order `k` of the square root of a power series, from the lower coefficients of the root.
fn root_of(k: usize, square: f64, root: &[f64; AIR_TERMS]) -> f64 {
    if k == 0 {
        return square.sqrt();
    }
    let known = (1..k).map(|i| root[i] * root[k - i]).sum::<f64>();
    (square - known) / (2.0 * root[0])
}

fn added<const K: usize>(a: [f64; K], b: [f64; K]) -> [f64; K] {
    core::array::from_fn(|i| a[i] + b[i])
}

fn at_time<const K: usize>(of: &[[f64; K]], t: f64) -> [f64; K] {
    of.iter().rev().fold([0.0; K], |all, c| core::array::from_fn(|i| all[i] * t + c[i]))
}

impl StoneFlight {
    /// The flight of a stone from this state vector on.
    pub fn new<const N: usize>(
        law: &StoneLaw<f64>,
        from: &StoneAloft<N>,
        losses: &Losses,
        least: f64,
    ) -> Self {
        let (y, w) = (&from.y, from.y.omega());
        let lab = laboratory(y.quaternion());
        let r = law.touching(lab[2], w).r;
        let turned = cross(w, r);
        let [x, y_r, z] = lab.map(|axis| dot(axis, r));
        let [u, v, up] = lab.map(|axis| dot(axis, turned));
        let slip = y.slid();
        Self {
            law: *law,
            air: [Law::AirLinear, Law::AirQuadratic].map(|law| losses.coefficient(law)),
            least,
            reach: law.squares.into_iter().fold(0.0, f64::max).sqrt() + dot(law.offset, law.offset).sqrt(),
            centre: [y[STONE_X] - x, y[STONE_Y] - y_r, from.height - z],
            velocity: [slip[0] - u, slip[1] - v, from.lift - up],
            tilt: law.tilt.unwrap_or(0.0),
        }
    }

    /// The rounding error of the height at a time.
    pub fn doubt_of_height(&self, t: f64, fastest: f64) -> f64 {
        let [.., up] = self.velocity;
        4.0 * f64::EPSILON * (self.centre[2].abs() + t * (1.0 + up.abs() + fastest * self.reach))
    }

    /// A bound of the angular velocity in the rest of the flight.
    pub fn fastest(&self, w: [f64; 3]) -> f64 {
        let m = self.law.inertia.times(w);
        (dot(w, m) / self.least).sqrt().min(dot(m, m).sqrt() / self.least)
    }

    /// The piece that begins in the state `at`, at the time `from` since the start; `leaves` is the power of time
    /// with which the lowest point leaves the table.
    pub fn piece<const N: usize>(&self, from: f64, at: &StoneAloft<N>, leaves: Leaves) -> AirPiece {
        let w = at.y.omega();
        let fastest = self.fastest(w);
        let air = (self.air[0] + self.air[1] * fastest) * fastest / self.least;
        let bend = self.reach * ((1.0 + 1.0 / 3f64.sqrt()) * fastest * fastest + air) - 1.0;
        let piece = |terms: usize| self.powers(from, at, bend, terms);
        let Some(order) = leaves else { return piece(AIR_TERMS) };
        // A bounce that is over early needs few terms, up to twice the time that the first two give.
        let n = laboratory(at.y.quaternion())[2];
        let wide = core::array::from_fn(|i| self.law.squares[i] * n[i]);
        let most = self.law.squares.into_iter().fold(0.0, f64::max);
        let room = 1.0 + (2f64.sqrt() - 1.0) * (dot(n, wide) / most).sqrt();
        let near = CIRCLE_SHARE * 3f64.sqrt() * (1.0 - room.powf(-1.0 / 3f64.sqrt())) / fastest;
        let first = piece(order + 2);
        let early = -(2.0 * first.height[order] / first.height[order + 1]);
        if let Some(terms) = terms_until(early / near, order) {
            let short = AirPiece { length: early, ..piece(terms.min(AIR_TERMS)) };
            if short.lands(Some(order), early).is_ok_and(|found| found.is_some()) {
                return short;
            }
        }
        let whole = piece(AIR_TERMS);
        AirPiece { length: whole.length.min(near), ..whole }
    }

    fn powers<const N: usize>(&self, from: f64, at: &StoneAloft<N>, bend: f64, terms: usize) -> AirPiece {
        let (law, [b, b2]) = (&self.law, self.air);
        let mut all = AirPiece {
            terms,
            quaternion: [[0.0; 4]; AIR_TERMS],
            w: [[0.0; 3]; AIR_TERMS],
            height: [0.0; AIR_TERMS],
            lost: [0.0; AIR_TERMS],
            from,
            length: 0.0,
            bend,
        };
        let mut m = [[0.0; 3]; AIR_TERMS];
        let mut n = m;
        // S, |w|^2, and the factor of the couple of the air.
        let [mut size, mut square, mut speed, mut drag] = [[0.0; AIR_TERMS]; 4];
        all.quaternion[0] = at.y.quaternion();
        all.w[0] = at.y.omega();
        (m[0], n[0]) = (law.inertia.times(all.w[0]), laboratory(all.quaternion[0])[2]);
        all.lost[0] = lost(&at.y);
        let wide = |n: [f64; 3]| core::array::from_fn(|i| law.squares[i] * n[i]);
        let add = |a: f64, b: f64| a + b;
        let resists = (b != 0.0 || b2 != 0.0) && all.w[0] != [0.0; 3];
        for k in 0..terms {
            size[k] = root_of(k, product(k, &n, &n, |a, b| dot(a, wide(b)), add), &size);
            if k + 1 == terms {
                break;
            }
            let (per, w, q) = (1.0 / (k + 1) as f64, &all.w, &all.quaternion);
            let mut turn = product(k, &m, w, cross, added);
            if resists {
                square[k] = product(k, w, w, dot, add);
                speed[k] = root_of(k, square[k], &speed);
                drag[k] = b2 * speed[k] + if k == 0 { b } else { 0.0 };
                turn = plus(turn, -1.0, product(k, &drag, w, |a, w| w.map(|x| a * x), added));
                all.lost[k + 1] = per * product(k, &drag, &square, |a, b| a * b, add);
            }
            m[k + 1] = turn.map(|x| x * per);
            n[k + 1] = product(k, &n, w, cross, added).map(|x| x * per);
            all.quaternion[k + 1] = product(k, q, w, turning, added).map(|x| x * per);
            all.w[k + 1] = law.inverse.times(m[k + 1]);
        }
        for k in 0..terms {
            all.height[k] = -size[k] - dot(n[k], law.offset);
        }
        // The first two coefficients are known without a difference.
        (all.height[0], all.height[1]) = (at.height, at.lift);
        all.height[2] -= 0.5;
        let fast = 1.0 + all.w[0].iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let last = |k: usize| {
            let turned = all.w[k].iter().fold(0.0, |most: f64, x| most.max(x.abs())) / fast;
            let leans = n[k].iter().chain(&all.quaternion[k]);
            let most = leans.fold(turned.max(size[k].abs()), |most: f64, x| most.max(x.abs()));
            (CUT / most).powf(1.0 / k as f64)
        };
        all.length = (terms.max(4) - 3..terms).map(last).fold(LONGEST_PIECE, f64::min);
        all
    }
}

impl AirPiece {
    /// The time of the first landing up to the time `to`, both since the beginning of the piece; None without a
    /// landing.
    pub fn lands(&self, leaves: Leaves, to: f64) -> Result<Option<f64>, Exhausted> {
        // A normal force that has just become negative is hardly larger than the errors of the numbers.
        let vanishes = leaves == Some(2) && self.height[2] <= 0.0 && self.height[2] > -HARDLY;
        let order = if vanishes { 3 } else { leaves.unwrap_or(0) };
        let series = &self.height[order..self.terms];
        if series[0] <= 0.0 {
            let touches = leaves.is_some() || series[0] > -TOUCHES;
            return if touches { Ok(Some(0.0)) } else { Err(Exhausted::Evaluations) };
        }
        first_zero_of_powers(series, to, if order == 0 { self.bend } else { f64::INFINITY })
    }

    /// The stone at a time since the beginning of the piece; `start` is its state vector at the start of the flight.
    pub fn at<const N: usize>(&self, flight: &StoneFlight, start: &[f64; N], t: f64) -> StoneAloft<N> {
        let (mut y, since, terms) = (*start, self.from + t, self.terms);
        let q = at_time(&self.quaternion[..terms], t);
        let long = q.iter().fold(0.0, |sum, x| x.mul_add(*x, sum)).sqrt();
        let w = at_time(&self.w[..terms], t);
        y[..4].copy_from_slice(&q.map(|x| x / long));
        y[4..7].copy_from_slice(&w);
        y[TIME] += since;
        let lab = laboratory(y.quaternion());
        let r = flight.law.touching(lab[2], w).r;
        let (turned, faster) = (cross(w, r), flight.tilt * since);
        for (i, falls) in [faster, 0.0].into_iter().enumerate() {
            y[SLID_X + i] = flight.velocity[i] + falls + dot(lab[i], turned);
            y[STONE_X + i] = flight.centre[i] + since * (flight.velocity[i] + 0.5 * falls) + dot(lab[i], r);
        }
        let [mut height, mut lift, mut gone] = [0.0; 3];
        for k in (0..terms).rev() {
            lift = lift * t + height;
            height = height * t + self.height[k];
            gone = gone * t + self.lost[k];
        }
        if loses(N) {
            y[N - 1] = gone;
        }
        StoneAloft { y, height, lift }
    }

    /// Whether the centre of mass is so high up to a time since the beginning of the piece that no point can land.
    pub fn is_high(&self, flight: &StoneFlight, to: f64) -> bool {
        let [_, _, up] = flight.velocity;
        [self.from, self.from + to].iter().all(|t| flight.centre[2] + t * (up - 0.5 * t) > flight.reach)
    }

    /// The spin about the vertical at a time since the beginning of the piece, for a flight that began at the time
    /// `now`.
    pub fn spot(&self, now: f64, t: f64) -> Spot {
        let (q, w) = (at_time(&self.quaternion[..self.terms], t), at_time(&self.w[..self.terms], t));
        let n = laboratory(q)[2];
        let ahead: MotionPowers<3> = core::array::from_fn(|k| {
            let next = if k + 1 < self.terms { self.w[k + 1] } else { [0.0; 3] };
            next.map(|x| (k + 1) as f64 * x)
        });
        let spin = Dual { value: dot(n, w), slope: dot(n, at_time(&ahead, t)) };
        Spot { t: now + self.from + t, spin }
    }
}
