//! A slow slip as a power series in time, from the start of the slip and while the slip stays slow.
//!
//! ```text
//! u = r (cos alpha, sin alpha),   r = r0 + r1 t + r2 t^2 + ...,   alpha = a0 + a1 t + ...
//! r' = lambda(alpha),   r alpha' = f(alpha)      so that   (n r1 - f_alpha) a_n = [f - r alpha']_n from known terms
//! ```
//! In time these equations are singular: alpha follows the zero of f at the rate f_alpha/r, and an integrator would
//! need tiny steps. The law of friction, evaluated with power series, gives the coefficients one after the other. With
//! r0 > 0 the term r0 (n + 1) a_(n+1) is taken from the series of the previous sweep, in the first sweep from the series
//! that ended here. The sweeps converge to the slow manifold of singular perturbation theory (Fenichel 1979), on which
//! the direction has settled, as in every slip that began from rest. With r0 or r1 = 0 (static friction that was just
//! enough) the series is only asymptotic; its last terms show how far it may be used.
//!
//! Error: the tolerance `tol` of the series; the last two terms of each number are below `tol` where the series ends.

use super::halt::loses;
use crate::contact::slip::Slipping;
use crate::contact::standstill::towards;
use crate::number::{Dual, Real, Series};
use crate::search::crossing;
use crate::state::State;

/// Largest number of coefficients of a series.
const TERMS: usize = 12;
/// Slip faster than this is left to the integrator.
const SLOW: f64 = 0.02;
/// The last two terms of the angle of the direction stay below this angle where a series is used.
const TURN: f64 = 1e-7;
/// Longest time over which two sweeps for the series of a slow slip must agree, and largest number of sweeps.
const SOON: f64 = 0.05;
const SWEEPS: i32 = 16;

/// Number of coefficients that a tolerance needs.
fn terms(tol: f64) -> usize {
    ((1.0 - tol.log10()) * 0.8).ceil().clamp(5.0, TERMS as f64) as usize
}

/// The time until the last two of the terms of a series are as large as `allowed`.
fn soon(x: &Power, terms: usize, allowed: f64) -> f64 {
    let until = |k: usize| (allowed / x.at[k].abs()).powf(1.0 / k as f64);
    until(terms - 2).min(until(terms - 1))
}

/// Least time for which a series takes less work than an integrator, in times in which the direction of the slip settles
/// by a factor e. A step of an integrator spans six of them.
const WORTHWHILE: f64 = 30.0;

/// Number of times at which the speed of a series is checked.
const LOOKS: usize = 64;
pub(crate) type Power = Series<TERMS>;

/// Whether no margin fails between places that lie close together, of which the first is the start.
pub(crate) fn are_clear<const M: usize>(margins: &[[f64; M]]) -> bool {
    let fails = |i: usize| {
        let falls = margins[1..].iter().any(|m| m[i] <= 0.0 || m[i].is_nan());
        // A margin may also dip to a minimum that is small in comparison with its variation.
        let dips = margins.windows(3).any(|m| {
            let (a, b, c) = (m[0][i], m[1][i], m[2][i]);
            b < a && b < c && b < 4.0 * (a.max(c) - b)
        });
        falls || dips
    };
    !(0..M).any(fails)
}

/// A law of dry friction, over the K numbers of a body besides its slip.
pub(crate) trait SlowLaw<T, const K: usize> {
    /// The rates of the K numbers, and that of the slip, in a state with this slip, whose direction is `way`.
    fn rates(&self, y: &[T; K], slip: [T; 2], way: [T; 2]) -> ([T; K], [T; 2]);
}

/// The series of a slow slip: the K numbers of the body, the speed of the slip, and its direction.
pub(crate) struct SlowSlip<const K: usize> {
    pub known: [Power; K],
    speed: Power,
    pub angle: Power,
    /// Sine and cosine of the direction at the start.
    start: [f64; 2],
    /// Time over which the direction of the slip settles by a factor e at the start.
    settling: f64,
    terms: usize,
}

impl<const K: usize> SlowSlip<K> {
    /// The series from the numbers `start` on, in a direction near `angle`, with the speed `begin` that grows at the rate
    /// `growth`; a speed above 0 has its own growth. None where the slip would not keep that direction.
    pub fn new(
        law: &impl SlowLaw<Power, K>,
        sloped: &impl SlowLaw<Dual<f64>, K>,
        start: [f64; K],
        (mut angle, growth): (Power, f64),
        (begin, tol): (f64, f64),
    ) -> Option<Self> {
        let dual = |value: f64, slope: f64| Dual { value, slope };
        let (mut known, mut speed) = (start.map(Power::of), Power::of(begin));
        let terms = terms(tol);
        let (mut sin, mut cos, mut settling);
        let (mut sweep, mut moved) = (0, f64::INFINITY);
        loop {
            [cos, sin] = towards(angle.at[0]);
            // The slopes of these dual numbers are derivatives with respect to alpha.
            let turned = [dual(cos, -sin), dual(sin, cos)];
            let (by_alpha, u) =
                sloped.rates(&start.map(|x| dual(x, 0.0)), turned.map(|x| x * dual(begin, 0.0)), turned);
            let f = turned[0] * u[1] - turned[1] * u[0];
            let f_alpha = f.slope;
            if f_alpha.is_nan() || f_alpha >= 0.0 {
                return None;
            }
            settling = begin / -f_alpha;
            let lambda = turned[0] * u[0] + turned[1] * u[1];
            speed.at[1] = if begin > 0.0 { lambda.value } else { growth };
            let before = angle;
            for n in 0..terms - 1 {
                if n > 0 {
                    angle.at[n] = 0.0;
                }
                let y = known.map(|x| x.first(n + 1));
                let way = circle(&angle.first(n + 1), [sin, cos]);
                let slip = [speed.first(n + 1) * way[1], speed.first(n + 1) * way[0]];
                let (rates, u) = law.rates(&y, slip, [way[1], way[0]]);
                let mut turn = 0.0;
                if n > 0 {
                    let f = way[1] * u[1] - way[0] * u[0];
                    let left = (f - speed.first(n + 1) * angle.slope()).at[n];
                    turn = left / (n as f64 * speed.at[1] - f_alpha);
                    angle.at[n] = turn;
                    let rate = way[1] * u[0] + way[0] * u[1];
                    speed.at[n + 1] = (rate.at[n] + lambda.slope * turn) / (n + 1) as f64;
                }
                for (x, (rate, by)) in known.iter_mut().zip(rates.into_iter().zip(by_alpha)) {
                    x.at[n + 1] = (rate.at[n] + by.slope * turn) / (n + 1) as f64;
                }
            }
            if begin == 0.0 {
                break;
            }
            let soon = SOON.min(soon(&angle, terms, TURN));
            let off: f64 = (0..terms).map(|n| (angle.at[n] - before.at[n]).abs() * soon.powi(n as i32)).sum();
            // The next sweep is expected to change the angle less by the factor by which this one did.
            if sweep > 0 && off * (off / moved).min(1.0) <= 0.1 * tol.max(1e-13) {
                break;
            }
            moved = off;
            sweep += 1;
            if off.is_nan() || sweep > SWEEPS {
                return None;
            }
            // A Newton step moves the direction towards the solution of f = r alpha'.
            angle.at[0] -= (f.value - begin * angle.at[1]) / f_alpha;
        }
        known = known.map(|x| x.first(terms));
        (speed, angle) = (speed.first(terms), angle.first(terms));
        Some(Self { known, speed, angle, start: [sin, cos], settling, terms })
    }

    /// Cosine and sine of the direction of the slip.
    pub fn way(&self) -> [Power; 2] {
        let [sine, cosine] = circle(&self.angle, self.start);
        [cosine, sine]
    }

    /// The slip in the direction `way`.
    pub fn slip(&self, way: [Power; 2]) -> [Power; 2] {
        way.map(|x| self.speed * x)
    }

    /// Whether this series takes less work than the steps of an integrator would up to the time `until`.
    pub fn pays(&self, until: f64) -> bool {
        until > WORTHWHILE * self.settling
    }

    /// The time up to which the series of these numbers may be used within `tol`, and whether the slip ends then.
    pub fn until(&self, numbers: &[Power], tol: f64) -> (f64, bool) {
        let (speed, mut until) = (&self.speed, f64::INFINITY);
        let mut within = |x: &Power, allowed: f64| until = until.min(soon(x, self.terms, allowed));
        for x in numbers {
            within(x, 0.1 * tol * x.at[0].abs().max(1.0));
        }
        within(&self.angle, TURN);
        until *= 0.8;
        // A slip that hardly begins ends before its series does.
        let part = |k: f64| until * k / LOOKS as f64;
        let looks: [f64; LOOKS + 1] = core::array::from_fn(|k| speed.value(part(k as f64)));
        let over = (1..=LOOKS).find_map(|k| {
            let (before, here, after) = (looks[k - 1], looks[k], looks[LOOKS.min(k + 1)]);
            // A minimum of the speed may lie between two of these times.
            let dips = k < LOOKS && here < before && here < after;
            let lowest = if dips { 0.5 * (before - after) / (before + after - 2.0 * here) } else { 0.0 };
            Some(part(k as f64 + lowest)).filter(|t| speed.value(*t) <= 0.0)
        });
        if let Some(t) = over {
            let first = part(1.0).min(t) * 1e-3;
            until = if speed.value(first) > 0.0 {
                crossing(|t| speed.value(t), first, t, speed.value(first), speed.value(t))
            } else {
                0.0
            };
        }
        (until, over.is_some())
    }
}

/// The numbers of a rim are sine and cosine of theta, and w.
impl<T: Real> SlowLaw<T, 5> for Slipping<T> {
    fn rates(&self, &[s, c, w1, w2, w3]: &[T; 5], slip: [T; 2], way: [T; 2]) -> ([T; 5], [T; 2]) {
        let at = self.towards((s, c), [w1, w2, w3], slip, way);
        let [d1, d2, d3] = at.w;
        ([-(c * w2), s * w2, d1, d2, d3], at.u)
    }
}

/// Series since the slip began: sine and cosine of theta, w, u, time, heat, phi, psi, contact point and lost energy.
pub(super) struct Leaving {
    numbers: [Power; 14],
    /// Time up to which the series may be used.
    pub until: f64,
    /// Whether the slip ends at `until`.
    pub ends: bool,
    /// Whether this series takes less work than the steps of an integrator would.
    pub pays: bool,
    /// The angle of the direction.
    pub angle: Power,
}

impl Leaving {
    /// The series of a body whose contact point slips off in the direction alpha with a speed that grows at the given
    /// rate, where `way` is (alpha, growth); None where the slip would not keep that direction.
    pub fn new(law: (&Slipping<f64>, f64), y: &State, way: (f64, f64)) -> Option<Self> {
        Self::from_speed(law, y, (Power::of(way.0), way.1), 0.0)
    }

    /// The series of a body that slips at `speed` in a settled direction near `angle`; None if the slip is too fast or
    /// no settled direction is found.
    pub fn slowly(law: (&Slipping<f64>, f64), y: &State, angle: Power, speed: f64) -> Option<Self> {
        if speed > SLOW { None } else { Self::from_speed(law, y, (angle, 0.0), speed) }
    }

    fn from_speed(
        (of, tol): (&Slipping<f64>, f64),
        y: &State,
        way: (Power, f64),
        begin: f64,
    ) -> Option<Self> {
        let (shape, mu, losses) = (of.shape, of.strength, of.losses);
        let dual = |value: f64| Dual { value, slope: 0.0 };
        let sloped = Slipping::of(&shape.map(dual), dual(mu), true);
        let sloped = sloped.with_losses(losses.map(|losses| losses.map(dual)));
        let law = Slipping::of(&shape.map(Power::of), Power::of(mu), true);
        let law = law.with_losses(losses.map(|losses| losses.map(Power::of)));
        let (sine, cosine) = y.theta.sin_cos();
        let slow = SlowSlip::new(&law, &sloped, [sine, cosine, y.w1, y.w2, y.w3], way, (begin, tol))?;
        Some(Self::of_series(&law, &slow, tol))
    }

    /// The series of all numbers from that of a slow slip.
    fn of_series(law: &Slipping<Power>, slow: &SlowSlip<5>, tol: f64) -> Self {
        let [s, c, w1, w2, w3] = slow.known;
        let way = slow.way();
        let slip = slow.slip(way);
        let at = law.towards((s, c), [w1, w2, w3], slip, way);
        let [normal, along, across] = at.force;
        let heat = (-(along * slip[1] + across * slip[0])).integral(0.0);
        let precession = w1 / s;
        let spin = w3 - c * precession;
        let (phi, psi) = (precession.integral(0.0), spin.integral(0.0));
        let [sin, cos] = circle(&phi, [0.0, 1.0]);
        let rim = &law.shape.rim;
        let (out, on) = (slip[0] + rim.rho * w2, slip[1] + rim.radius((s, c)) * spin);
        let path = [(out * cos - on * sin).integral(0.0), (out * sin + on * cos).integral(0.0)];
        let time = Power::of(1.0).integral(0.0);
        let lost = law.losses.map_or(Power::of(0.0), |losses| {
            losses.power(&losses.seen(&law.shape.rim, (s, c), precession, [w1, w2, w3]), normal).integral(0.0)
        });
        let numbers = [s, c, w1, w2, w3, slip[0], slip[1], time, heat, phi, psi, path[0], path[1], lost];
        let (until, ends) = slow.until(&numbers[..9], tol);
        Self { numbers, until, ends, pays: slow.pays(until), angle: slow.angle }
    }

    /// Whether the series exists: it does not where a law takes a root of a quantity that vanishes at the start.
    pub fn is_sound(&self) -> bool {
        self.numbers.iter().all(|x| x.at.iter().all(|a| a.is_finite())) && self.until > 0.0
    }

    /// The numbers at the time `t` since the start of the slip.
    pub fn at<const N: usize>(&self, t: f64) -> [f64; N] {
        let last = self.numbers.len() - 1;
        core::array::from_fn(|i| self.numbers[if loses(N) && i + 1 == N { last } else { i }].value(t))
    }
}

/// Series of the sine and cosine of an angle, from their values at the start.
fn circle(angle: &Power, [sin, cos]: [f64; 2]) -> [Power; 2] {
    let turn = angle.slope();
    let (mut sine, mut cosine) = (angle.splat(sin), angle.splat(cos));
    for n in 1..angle.known {
        let product = |x: &Power| (0..n).map(|j| x.at[j] * turn.at[n - 1 - j]).sum::<f64>() / n as f64;
        let (up, down) = (product(&cosine), product(&sine));
        (sine.at[n], cosine.at[n]) = (up, -down);
    }
    [sine, cosine]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slip whose speed has a minimum of `lowest` at the time 0.503, and whose series may be used up to the time 1.
    fn dipping(lowest: f64) -> (f64, bool) {
        let mut speed = Power::of(0.503f64.powi(2) + lowest);
        (speed.at[1], speed.at[2]) = (-2.0 * 0.503, 1.0);
        let mut number = Power::of(1.0);
        number.at[TERMS - 1] = 1e-9 * 0.8f64.powi(TERMS as i32 - 1);
        let (angle, start) = (Power::of(0.0), [0.0, 1.0]);
        SlowSlip { known: [number], speed, angle, start, settling: 0.0, terms: TERMS }.until(&[number], 1e-8)
    }

    #[test]
    fn a_slip_ends_at_a_minimum_of_its_speed_below_zero_however_short() {
        for lowest in [-1e-6, -1e-9, -1e-12] {
            let (until, ends) = dipping(lowest);
            assert!(ends && (until - 0.503 + (-lowest).sqrt()).abs() < 1e-9, "{lowest:e}: {until}");
        }
        for lowest in [1e-12, 1e-6] {
            let (until, ends) = dipping(lowest);
            assert!(!ends && (until - 1.0).abs() < 1e-14, "{lowest:e}: {until}");
        }
    }
}
