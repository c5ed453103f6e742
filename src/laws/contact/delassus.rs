//! The inverse inertia of a contact point: the change of its velocity per impulse that acts on the point.
//!
//! ```text
//! u' - u = W P,   W = [[A, b], [b, a_n]]       A of the two horizontal axes, b the coupling to the normal impulse
//! slip along d:   du/dp = b - mu A d,   du_n/dp = a_n - mu b.d          p the normal impulse so far
//!                 d turns by f = d x (b - mu A d) per |u| dp,   df/dalpha = -d.(b - mu A d) - mu e.A e,   e across d
//! held:           |A^-1 b| <= mu_s;   else it leaves along the one d with b - mu A d = lam d, lam > 0
//! ```
//! W is symmetric and positive for every body and every contact point (Delassus 1917; Routh 1860), and the two
//! horizontal axes may be any. For every mu the slip at each p is unique, since (u - v).A^-1 (u - v) of two solutions
//! never grows; so a slip can begin from rest in only one way.
//!
//! Error: a few roundings; the direction of a slip has an error of one rounding.

use crate::methods::search::crossing;

/// The velocity that a unit impulse gives the point of contact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Delassus {
    /// A, the horizontal velocity per horizontal impulse, along the two horizontal axes.
    pub level: [[f64; 2]; 2],
    /// b, the horizontal velocity per normal impulse, along the two horizontal axes.
    pub couples: [f64; 2],
    /// a_n, the normal velocity per normal impulse.
    pub normal: f64,
}

/// The speed |u| of a slip with these two components.
pub(super) fn speed([u, v]: [f64; 2]) -> f64 {
    u.hypot(v)
}

fn inner([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    a * c + b * d
}

impl Delassus {
    /// The horizontal velocity that a horizontal impulse gives.
    #[inline(always)]
    pub fn level(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        self.level.map(|[a, b]| a * x + b * y)
    }

    /// The normal velocity that a horizontal impulse gives.
    #[inline(always)]
    pub fn lifts(&self, impulse: [f64; 2]) -> f64 {
        inner(self.couples, impulse)
    }

    /// The horizontal impulse that gives this horizontal velocity.
    pub fn pushes(&self, velocity: [f64; 2]) -> [f64; 2] {
        solved(self.level, velocity)
    }

    /// The principal values of A, the horizontal part of the inverse inertia, and its principal axes.
    pub fn principal(&self) -> ([f64; 2], [[f64; 2]; 2]) {
        let [[a, ab], [_, b]] = self.level;
        if ab == 0.0 {
            return ([a, b], [[1.0, 0.0], [0.0, 1.0]]);
        }
        let (sin, cos) = (0.5 * (2.0 * ab).atan2(a - b)).sin_cos();
        let mixed = 2.0 * sin * cos * ab;
        let values = [cos * cos * a + sin * sin * b + mixed, sin * sin * a + cos * cos * b - mixed];
        (values, [[cos, sin], [-sin, cos]])
    }

    /// Whether a contact point leaves the table during a slip that friction stops before the normal impulse begins;
    /// `lift` is the normal velocity. Along the principal axes of A the slip dies out as s^k and as s, with s from 1 to
    /// 0.
    pub fn lifts_on_the_way(&self, slip: [f64; 2], lift: f64) -> bool {
        let ([a, b], axes) = self.principal();
        let along = |axis: [f64; 2]| inner(axis, slip) * inner(axis, self.couples);
        let pulls = [along(axes[0]) / a, along(axes[1]) / b];
        let ([slow, fast], power) = if a < b { (pulls, b / a) } else { ([pulls[1], pulls[0]], a / b) };
        let s = (-slow / (fast * power)).powf(1.0 / (power - 1.0));
        s < 1.0 && lift - slow * (1.0 - s) - fast * (1.0 - s.powf(power)) >= 0.0
    }

    /// Whether a slip along the second axis does not change the normal velocity, as for a rim, whose first axis is e_h.
    pub fn is_lean(&self) -> bool {
        self.level[0][1] == 0.0 && self.couples[1] == 0.0
    }

    /// The change du/dp of a slip along the unit vector `way` per normal impulse, under the coefficient of friction `mu`.
    fn changes(&self, way: [f64; 2], mu: f64) -> [f64; 2] {
        let held = self.level(way);
        [self.couples[0] - mu * held[0], self.couples[1] - mu * held[1]]
    }

    /// The rate d|u|/dp at which a slip along `way` grows, per normal impulse p.
    pub fn growth(&self, way: [f64; 2], mu: f64) -> f64 {
        inner(way, self.changes(way, mu))
    }

    /// The angle per |u| dp by which the direction of a slip along `way` turns, the derivative of this rate with
    /// respect to the direction, and e.A e, with e across the slip.
    pub fn turning(&self, way @ [x, y]: [f64; 2], mu: f64) -> [f64; 3] {
        let ([along, aside], across) = (self.changes(way, mu), [-y, x]);
        let light = inner(across, self.level(across));
        [x * aside - y * along, -(x * along + y * aside) - mu * light, light]
    }

    /// The direction in which a slip begins from rest if friction cannot hold the contact point.
    pub fn way_out(&self, mu: f64) -> [f64; 2] {
        let [[a, ab], [_, b]] = self.level;
        let pushed = |lam: f64| solved([[mu * a + lam, mu * ab], [mu * ab, mu * b + lam]], self.couples);
        // The single root lies below |b|, as A is positive.
        let most = speed(self.couples);
        let left = |lam: f64| speed(pushed(lam)) - 1.0;
        let way = pushed(crossing(left, 0.0, most, left(0.0).min(f64::MAX), left(most)));
        way.map(|x| x / speed(way))
    }
}

/// The solution x of A x = v for a symmetric matrix A of two rows.
fn solved([[a, ab], [_, b]]: [[f64; 2]; 2], [u, v]: [f64; 2]) -> [f64; 2] {
    let y = (v - ab / a * u) / (b - ab / a * ab);
    [(u - ab * y) / a, y]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_that_friction_stops_first_lifts_the_point_where_its_way_by_small_steps_does() {
        let mut found = [0; 2];
        for k in 0..4000 {
            let part = |i: usize| {
                (f64::from(k) * [2.0f64, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0][i - 1].sqrt()).fract() - 0.5
            };
            // The principal values differ much, so that the way is bent.
            let (a, b, angle) = (1.0 + part(1), 6.0 + 8.0 * part(2), 6.0 * part(3));
            let (sin, cos) = angle.sin_cos();
            let mixed = sin * cos * (a - b);
            let level = [[a * cos * cos + b * sin * sin, mixed], [mixed, a * sin * sin + b * cos * cos]];
            let light = Delassus { level, couples: [2.0 * part(4), 2.0 * part(5)], normal: 2.0 };
            let (begin, lift) = ([8.0 * part(6), 8.0 * part(7)], -0.3 + 0.2 * part(8));
            // The impulse is against the slip at each moment, and as long as it takes to stop it.
            let (mut slip, mut push) = (begin, [0.0; 2]);
            let mut most = lift;
            for _ in 0..20_000 {
                let size = 2e-3 * speed(slip);
                let step = slip.map(|u| -size * u / speed(slip).max(f64::MIN_POSITIVE));
                let [p, q] = light.level(step);
                (slip, push) = ([slip[0] + p, slip[1] + q], [push[0] + step[0], push[1] + step[1]]);
                most = most.max(lift + light.lifts(push));
                if speed(slip) < 1e-6 {
                    break;
                }
            }
            let end = lift + light.lifts(light.pushes(begin.map(|u| -u)));
            if end < 0.0 && most.abs() > 5e-3 {
                assert_eq!(light.lifts_on_the_way(begin, lift), most > 0.0, "{k} {most}");
                found[usize::from(most > 0.0)] += 1;
            }
        }
        assert!(found.iter().all(|count| *count > 20), "{found:?}");
    }
}
