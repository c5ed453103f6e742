//! Impact on a viscous film, whose force is c u times the normal force.
//!
//! ```text
//! u_i = b_i/(c a_i) + (u_i0 - b_i/(c a_i)) exp(-c a_i p)      along the principal axes of A
//! u_n and the work of the normal force are its integrals over the normal impulse p
//! ```
//! u_n may rise through 0 and later fall once. The end of compression and that of the impact are zeros, found between
//! the places where u_n' changes sign. Error: a few roundings.

use super::delassus::Delassus;
use super::impact::ImpactCourse;
use super::restitution::ImpactLaw;
use crate::methods::search::crossing;

impl ImpactCourse {
    /// Computes the whole impact on a viscous film, whose force is c u times the normal force. Along each principal
    /// axis of A the slip tends exponentially to the value that the normal impulse drives.
    pub fn film(&mut self, c: f64, slip: [f64; 2], light: &Delassus) {
        let (level, axes) = light.principal();
        let along = |v: [f64; 2]| axes.map(|[x, y]| x * v[0] + y * v[1]);
        let ([u, v], [b_1, b_2]) = (along(slip), along(light.couples));
        let parts = [(level[0], b_1, u), (level[1], b_2, v)];
        let first = self.lift;
        let lift = |p: f64| {
            parts.iter().fold(first + light.normal * p, |all, &(a, b, u)| {
                all - c * b * u * once(c * a, p) - b * b / a * (p - once(c * a, p))
            })
        };
        let work = |p: f64| {
            parts.iter().fold(first * p + 0.5 * light.normal * p * p, |all, &(a, b, u)| {
                let twice = twice(c * a, p);
                all - c * b * u * twice - b * b / a * (0.5 * p * p - twice)
            })
        };
        // u_n' is a constant minus two exponential functions: it has at most two zeros, and one extremum between them.
        let held = parts.iter().fold(light.normal, |all, (a, b, _)| all - b * b / a);
        let falls = parts.map(|(a, b, u)| b / a * (c * a * u - b));
        let rate = |p: f64| held - (0..2).map(|i| falls[i] * (-c * level[i] * p).exp()).sum::<f64>();
        let bend = (-(falls[0] * level[0]) / (falls[1] * level[1])).ln() / (c * (level[0] - level[1]));
        let mut turns = zeros(
            &rate,
            &[0.0]
                .into_iter()
                .chain((bend > 0.0 && bend < f64::INFINITY).then_some(bend))
                .collect::<Vec<_>>(),
        );
        turns.insert(0, 0.0);
        let stops = zeros(&lift, &turns);
        let e = self.e;
        let mut p = stops[0];
        if self.law == ImpactLaw::Poisson {
            p *= 1.0 + e;
            if stops.len() == 3 && p > stops[1] {
                p = (1.0 + e) * stops[2];
            }
        } else if self.law == ImpactLaw::Newton {
            turns.retain(|&turn| turn > p);
            turns.insert(0, p);
            p = zeros(&|p: f64| lift(p) + e * first, &turns).first().copied().unwrap_or(p);
        } else if e > 0.0 {
            let left = (1.0 - e) * (1.0 + e);
            let off = |p: f64, lowest: f64| work(p) - left * lowest;
            let first = work(stops[0]);
            // Where the film presses the body down again before the work is done, the lowest work so far counts.
            let from = if stops.len() == 3 && off(stops[1], first) < 0.0 { stops[2] } else { stops[0] };
            let lowest = first.min(work(from));
            // Work below rounding is restored at once.
            p = zeros(&|p: f64| off(p, lowest), &[from]).first().copied().unwrap_or(from);
        }
        let pushed = parts.map(|(a, b, u)| -c * (u * once(c * a, p) + b / (c * a) * (p - once(c * a, p))));
        let push = [0, 1].map(|i| axes[0][i] * pushed[0] + axes[1][i] * pushed[1]);
        self.impulse = [push[0], push[1], p];
        (self.lift, self.work) = (lift(p), work(p));
    }
}

/// The zeros of a function that is monotone between successive places and after the last one, and is positive far beyond it.
fn zeros(f: &dyn Fn(f64) -> f64, places: &[f64]) -> Vec<f64> {
    let mut found = Vec::new();
    for (i, &from) in places.iter().enumerate() {
        let begin = f(from);
        let begin = if begin == 0.0 { -f64::MIN_POSITIVE } else { begin };
        let to = places.get(i + 1).copied().unwrap_or_else(|| {
            let mut far = from.max(1.0);
            while f(far) < 0.0 {
                far *= 2.0;
            }
            far
        });
        let end = f(to);
        if (begin < 0.0) != (end < 0.0) {
            found.push(crossing(f, from, to, begin, end));
        }
    }
    found
}

/// The integrals of exp(-k p) over p, once and twice.
fn once(k: f64, p: f64) -> f64 {
    -(-k * p).exp_m1() / k
}

fn twice(k: f64, p: f64) -> f64 {
    let x = k * p;
    if x > 0.1 {
        return (p - once(k, p)) / k;
    }
    p * p
        * (0.5
            - x * (1.0 / 6.0
                - x * (1.0 / 24.0
                    - x * (1.0 / 120.0 - x * (1.0 / 720.0 - x * (1.0 / 5040.0 - x / 40320.0))))))
}
