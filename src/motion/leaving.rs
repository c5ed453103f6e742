//! Slip that begins from nothing, as a power series in the time since.
//!
//! ```text
//! u = r (cos alpha, sin alpha),   r = r1 t + r2 t^2 + ...,   alpha = a0 + a1 t + ...
//! r' = lambda(alpha),   r alpha' = f(alpha)      so that   (n r1 - f_alpha) a_n = [f - r alpha']_n of what is known before
//! ```
//! In time these equations are singular: alpha follows the zero of f at the rate f_alpha/r, and an integrator would crawl. The
//! law itself, sent through power series, gives one coefficient after the other. With r1 = 0 (static friction that was just
//! enough) the series is asymptotic only; how far it may be used is read off its last terms.
//!
//! Error: `tol` of what it was made for; where it ends the last two terms are below that.

use crate::body::Body;
use crate::contact::slip::{Friction, Slipping};
use crate::number::{Dual, Series};
use crate::state::State;

/// Coefficients.
const TERMS: usize = 14;
type Power = Series<TERMS>;

/// Sine and cosine of theta, w, u, time and heat, then phi, psi and the contact point, since the slip began.
pub(super) struct Leaving {
    numbers: [Power; 13],
    /// How long it may be used.
    pub until: f64,
}

impl Leaving {
    /// The motion of a body whose contact point slips off along `alpha`, its speed growing at the rate `growth`; None where
    /// it would not follow that direction.
    pub fn new(
        body: &Body,
        y: &State,
        friction: &Friction,
        (alpha, growth): (f64, f64),
        tol: f64,
    ) -> Option<Self> {
        let shape = body.shape();
        let mu = friction.strength();
        let (sine, cosine) = y.theta.sin_cos();
        let dual = |value: f64, slope: f64| Dual { value, slope };
        let (sin, cos) = alpha.sin_cos();
        // how f changes with alpha
        let law = Slipping::of(&shape.map(|x| dual(x, 0.0)), dual(mu, 0.0), true);
        let turned = [dual(cos, -sin), dual(sin, cos)];
        let w = [y.w1, y.w2, y.w3];
        let at = law.with(
            (dual(sine, 0.0), dual(cosine, 0.0)),
            w.map(|w| dual(w, 0.0)),
            [dual(0.0, 0.0); 2],
            turned.map(|x| x * dual(mu, 0.0)),
        );
        let f_alpha = (turned[0] * at.u[1] - turned[1] * at.u[0]).slope;
        if f_alpha.is_nan() || f_alpha >= 0.0 {
            return None;
        }
        let law = Slipping::of(&shape.map(Power::of), Power::of(mu), true);
        let start = [sine, cosine, y.w1, y.w2, y.w3];
        let mut known = start.map(Power::of);
        let (mut speed, mut angle) = (Power::of(0.0), Power::of(alpha));
        speed.0[1] = growth;
        let mut slip = [Power::of(0.0); 2];
        let mut friction_at = None;
        for n in 0..TERMS {
            // the coefficient of alpha, then what follows from it
            for decided in [n == 0, true] {
                let way = circle(&angle);
                slip = [speed * way[1], speed * way[0]];
                let [s, c, w1, w2, w3] = known;
                let push = [Power::of(mu) * way[1], Power::of(mu) * way[0]];
                let at = law.with((s, c), [w1, w2, w3], slip, push);
                let (f, lambda) = (way[1] * at.u[1] - way[0] * at.u[0], way[1] * at.u[0] + way[0] * at.u[1]);
                if decided {
                    let rates = [-(c * w2), s * w2, at.w[0], at.w[1], at.w[2]];
                    if n + 1 < TERMS {
                        for (x, rate) in known.iter_mut().zip(rates) {
                            x.0[n + 1] = rate.0[n] / (n + 1) as f64;
                        }
                        if n > 0 {
                            speed.0[n + 1] = lambda.0[n] / (n + 1) as f64;
                        }
                    }
                    friction_at = Some(at.force);
                    if n == 0 {
                        break;
                    }
                } else {
                    let left = f.0[n] - (speed * slope(&angle)).0[n];
                    angle.0[n] = left / (n as f64 * growth - f_alpha);
                }
            }
        }
        let [_, along, across] = friction_at?;
        let heat = (-(along * slip[1] + across * slip[0])).integral(0.0);
        let [s, c, w1, w2, w3] = known;
        let precession = w1 / s;
        let spin = w3 - c * precession;
        let (phi, psi) = (precession.integral(0.0), spin.integral(0.0));
        let [sin, cos] = circle(&phi);
        let rim = shape.map(Power::of).rim;
        let (out, on) = (slip[0] + rim.rho * w2, slip[1] + rim.radius((s, c)) * spin);
        let path = [(out * cos - on * sin).integral(0.0), (out * sin + on * cos).integral(0.0)];
        let time = Power::of(1.0).integral(0.0);
        let numbers =
            [s, c, w1, w2, w3, slip[0], slip[1], time, heat, phi, psi, path[0], path[1]];
        let mut until = f64::INFINITY;
        let mut within = |x: &Power, allowed: f64| {
            for k in [TERMS - 2, TERMS - 1] {
                until = until.min((allowed / x.0[k].abs()).powf(1.0 / k as f64));
            }
        };
        for x in &numbers[..9] {
            within(x, 0.1 * tol * x.0[0].abs().max(1.0));
        }
        within(&angle, 1e-7);
        until *= 0.8;
        (until > 0.0 && speed.at(until) > 0.0).then_some(Self { numbers, until })
    }

    /// The numbers at a time since the slip began.
    pub fn at<const N: usize>(&self, t: f64) -> [f64; N] {
        core::array::from_fn(|i| self.numbers[i].at(t))
    }
}

/// Sine and cosine of an angle.
fn circle(angle: &Power) -> [Power; 2] {
    let turn = slope(angle);
    let (sin, cos) = angle.0[0].sin_cos();
    let (mut sine, mut cosine) = (Power::of(sin), Power::of(cos));
    for n in 1..TERMS {
        let product = |x: &Power| (0..n).map(|j| x.0[j] * turn.0[n - 1 - j]).sum::<f64>() / n as f64;
        let (up, down) = (product(&cosine), product(&sine));
        (sine.0[n], cosine.0[n]) = (up, -down);
    }
    [sine, cosine]
}

/// How it changes with time.
fn slope(x: &Power) -> Power {
    Series(core::array::from_fn(|n| if n + 1 < TERMS { (n + 1) as f64 * x.0[n + 1] } else { 0.0 }))
}
