//! Laws of restitution, which determine where an impact ends.
//!
//! ```text
//! Stronge   W = (1 - e^2) W_c, W the work of the normal force
//! Newton    u_n' = -e u_n                                Poisson   p = (1 + e) p_c, p_c the normal impulse of compression
//! Walton    a ball: P_t = -(1 + e_t) u/a_h up to mu P_n, so that a slip that is gripped turns back to -e_t u
//! ```
//! All laws follow the same [impact](super::impact), and agree where e = 0, and for every ball with e_t = 0; the first
//! three also agree where the slip keeps its direction. Where friction stops or turns the slip, Newton's law may gain
//! energy (Kane and Levinson, Dynamics (1985); Stronge 1990). Where friction presses the contact point down once more,
//! Poisson's compression ends at the last zero of u_n.
//!
//! Error: that of the impact.

use super::slip::Friction;
use super::table::Table;
use crate::error::{Error, within};

/// The law by which an impact restores the normal velocity. Its coefficient e is that of
/// [`restitution`](crate::motion::Ask::restitution). Only Stronge's law takes energy from every impact; a motion under
/// another law ends where a second circle or a face lands.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum ImpactLaw {
    /// The normal force restores the share e^2 of the work of compression (Stronge 1990).
    #[default]
    Stronge,
    /// The normal velocity is -e times that before (kinematic; Newton 1687).
    Newton,
    /// The normal impulse of restitution is e times that of compression (kinetic; Poisson 1817).
    Poisson,
    /// For a ball: a slip that friction grips turns back to -`tangential` times the slip before the impact, with
    /// `tangential` from 0 to 1 (Garwin, Am. J. Phys. 37, 88 (1969); Walton and Braun, J. Rheol. 30, 949 (1986); Cross,
    /// Am. J. Phys. 70, 1093 (2002)). Needs Coulomb friction at a point.
    Walton {
        /// The coefficient of tangential restitution.
        tangential: f64,
    },
}

impl ImpactLaw {
    /// The coefficient of tangential restitution; 0 for every law but Walton's.
    pub fn tangential(&self) -> f64 {
        if let Self::Walton { tangential } = *self { tangential } else { 0.0 }
    }

    /// Whether a slip that friction grips turns back: for Walton's law with a positive coefficient.
    pub(crate) fn turns_back(&self) -> bool {
        self.tangential() > 0.0
    }

    /// Returns an error if the law turns slips back, unless the body is a uniform ball and the contact is Coulomb
    /// friction at a point.
    pub(crate) fn check(&self, ball: bool, table: &Table) -> Result<(), Error> {
        let value = within("tangential", self.tangential(), (0.0, 1.0), "0 to 1")?;
        let dry = matches!(table, Table::Rubs(Friction::Coulomb { patch: 0.0, .. }));
        if matches!(self, Self::Walton { .. }) && !(ball && dry) {
            let expected =
                "tangential restitution only for a ball with i1 = i3, with Coulomb friction and patch = 0";
            return Err(Error::OutOfRange { name: "tangential", value, expected });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::delassus::Delassus;
    use super::super::impact::{Hit, PointImpact, Struck};
    use super::*;
    use ImpactLaw::{Newton, Poisson, Stronge};

    const RIM: Delassus = Delassus { level: [[1.7, 0.0], [0.0, 4.2]], couples: [-1.1, 0.0], normal: 2.1 };
    const SKEW: Delassus = Delassus {
        level: [[2.5894286673, -0.4274491318], [-0.4274491318, 2.9079343858]],
        couples: [-0.2276773350, -0.8941686560],
        normal: 1.5417027085,
    };

    fn struck(
        law: ImpactLaw,
        (light, slip, lift): (Delassus, [f64; 2], f64),
        table: Table,
        e: f64,
    ) -> Struck {
        let impact = PointImpact { slip, lift, light, patch: None, law, tol: 3e-14, longer: 1.0 };
        impact.on(&table, e, &()).unwrap()
    }

    /// The irrational parts of the multiples of square roots of primes.
    fn part(k: i32, i: usize) -> f64 {
        (f64::from(k) * [2.0f64, 3.0, 5.0, 7.0, 11.0, 13.0][i].sqrt()).fract()
    }

    /// The impulses along the lean and the normal, and the normal velocity after a planar impact, which consists of at
    /// most two straight pieces (Routh 1860), for a slip u > 0 before.
    fn planar(law: ImpactLaw, [a, b, c]: [f64; 3], [u, lift]: [f64; 2], mu: f64, e: f64) -> [f64; 3] {
        let stops = if mu * a > b { u / (mu * a - b) } else { f64::INFINITY };
        let push = if (b / a).abs() <= mu { -b / a } else { -(mu * b.signum()) };
        let first = c - mu * b;
        let second = c + push * b;
        let u_n = |p: f64| lift + first * p.min(stops) + second * (p - stops).max(0.0);
        let work = |p: f64| {
            let (q, r) = (p.min(stops), (p - stops).max(0.0));
            lift * q + 0.5 * first * q * q + u_n(stops.min(p)) * r + 0.5 * second * r * r
        };
        // The last zero of a function that ends above it, by bisection from below all of it.
        let zero = |f: &dyn Fn(f64) -> f64, from: f64| {
            let (mut low, mut high) = (from, from + 1.0);
            while f(high) < 0.0 {
                high *= 2.0;
            }
            for _ in 0..200 {
                let half = 0.5 * (low + high);
                if f(half) < 0.0 { low = half } else { high = half }
            }
            high
        };
        let p_c = zero(&u_n, 0.0);
        let p = match law {
            Newton => zero(&|p| u_n(p) + e * lift, p_c),
            Poisson => (1.0 + e) * p_c,
            _ => zero(&|p| work(p) - (1.0 - e * e) * work(p_c), p_c),
        };
        [-mu * p.min(stops) + push * (p - stops).max(0.0), p, u_n(p)]
    }

    #[test]
    fn planar_impacts_under_three_laws_consist_of_straight_pieces() {
        let mut gains = [0; 3];
        for k in 1..600 {
            let (mu, e) = (1.3 * part(k, 0), part(k, 1));
            let rim = [1.2 + 3.0 * part(k, 2), 4.0 * part(k, 3) - 2.0, 1.2 + 2.5 * part(k, 4)];
            let [a, b, c] = rim;
            let u = 1.5 * part(k, 5) + 1e-3;
            if b * b > 0.9 * a * c {
                continue;
            }
            let light = Delassus { level: [[a, 0.0], [0.0, 4.2]], couples: [b, 0.0], normal: c };
            for (i, law) in [Stronge, Newton, Poisson].into_iter().enumerate() {
                let found = struck(law, (light, [u, 0.0], -1.0), Friction::coulomb(mu).into(), e);
                let known = planar(law, rim, [u, -1.0], mu, e);
                let off = [found.impulse[0] - known[0], found.impulse[2] - known[1], found.lift - known[2]];
                let off = off.into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
                assert!(off < 1e-12 && found.impulse[1] == 0.0, "{law:?} {k} {off:e} {found:?} {known:?}");
                gains[i] += usize::from(found.lost < -1e-13);
            }
        }
        assert!(gains[0] == 0 && gains[1] > 5 && gains[2] == 0, "{gains:?}");
    }

    #[test]
    fn under_every_law_a_point_leaves_upwards_also_where_friction_presses_it_down_again() {
        let mut pressed = 0;
        for k in 1..4000 {
            let (mu, e) = (4.0 * part(k, 0), [part(k, 1), 1.0, 0.0][k as usize % 3]);
            let [a, b, c] = [1.2 + 3.0 * part(k, 2), 1.2 + 3.0 * part(k, 3), 1.2 + 2.5 * part(k, 4)];
            // Couples of which friction along the one or the other horizontal axis may press.
            let strong = 0.98 * part(k, 5).sqrt();
            let (sin, cos) = (f64::from(k) * 0.7).sin_cos();
            let couples = [strong * (a * c).sqrt() * cos, strong * (b * c).sqrt() * sin];
            let light = Delassus { level: [[a, 0.0], [0.0, b]], couples, normal: c };
            let slip = [3.0 * part(k, 1) - 1.5, 3.0 * part(k, 2) - 1.5];
            let compressed = struck(Stronge, (light, slip, -1.0), Friction::coulomb(mu).into(), 0.0);
            for law in [Stronge, Newton, Poisson] {
                let found = struck(law, (light, slip, -1.0), Friction::coulomb(mu).into(), e);
                let [x, y, p] = found.impulse;
                assert!(found.lift >= -1e-13, "{law:?} {k} {found:?}");
                assert!(
                    x.hypot(y) <= mu * p * (1.0 + 1e-12) && p >= compressed.impulse[2] - 1e-12,
                    "{k} {found:?}"
                );
                assert!(law == Newton || found.lost > -1e-13, "{law:?} {k} {found:?}");
                match law {
                    Newton => assert!((found.lift - e).abs() < 1e-11, "{k} {found:?}"),
                    Poisson => pressed += usize::from(p > (1.0 + e) * compressed.impulse[2] + 1e-9),
                    _ => {}
                }
            }
        }
        assert!(pressed > 0, "no second compression");
    }

    #[test]
    fn laws_of_restitution_differ_only_in_where_an_impact_ends() {
        let tables: [Table; 4] = [
            Friction::coulomb(0.2).into(),
            Friction::coulomb(0.7).into(),
            Friction::Viscous { c: 0.8 }.into(),
            Table::Rolling { mu: f64::INFINITY },
        ];
        for k in 1..300 {
            let e = part(k, 0);
            let before =
                (if k % 3 == 0 { RIM } else { SKEW }, [2.0 * part(k, 1) - 1.0, part(k, 2) - 0.5], -1.0);
            let table = tables[k as usize % 4];
            let compressed = struck(Stronge, before, table, 0.0);
            let under = |law, e| struck(law, before, table, e);
            let same = |one: &Struck, other: &Struck| {
                let off = (0..3).map(|i| (one.impulse[i] - other.impulse[i]).abs());
                let off = off.fold((one.lift - other.lift).abs(), f64::max);
                assert!(off < 1e-11 && one.hit == other.hit, "{k}: {off:e} {one:?} {other:?}");
            };
            same(&under(Newton, 0.0), &compressed);
            same(&under(Poisson, 0.0), &compressed);
            let known = under(Stronge, e);
            if known.lift <= 1.0 {
                same(&under(Newton, known.lift), &known);
            }
            let ratio = known.impulse[2] / compressed.impulse[2] - 1.0;
            if ratio <= 1.0 {
                same(&under(Poisson, ratio), &known);
            }
        }
    }

    #[test]
    fn a_ball_keeps_its_spin_energy_in_a_slip_that_turns_back_and_slips_where_friction_is_too_weak() {
        let ball = Delassus { level: [[3.5, 0.0], [0.0, 3.5]], couples: [0.0; 2], normal: 1.0 };
        for (e, tangential, mu) in [(1.0, 1.0, 2.0), (0.8, 0.6, 1.0), (0.8, 0.6, 0.1), (0.5, 1.0, 0.05)] {
            let slip = [0.8, -0.6];
            let law = ImpactLaw::Walton { tangential };
            let found = struck(law, (ball, slip, -1.0), Friction::coulomb(mu).into(), e);
            let [x, y, p] = found.impulse;
            let (friction, wanted) = (x.hypot(y), (1.0 + tangential) / 3.5);
            assert!((p - (1.0 + e)).abs() < 1e-15 && found.lift == e);
            assert!((friction - wanted.min(mu * p)).abs() < 1e-15, "{found:?}");
            if wanted < mu * p {
                assert!(found.hit == Hit::TurnsBack && found.slip == slip.map(|u| -tangential * u));
                let lost = 0.5 * (1.0 - e * e) + 0.5 * (1.0 - tangential * tangential) / 3.5;
                assert!((found.lost - lost).abs() < 1e-15, "{found:?}");
            } else {
                let plain = struck(Stronge, (ball, slip, -1.0), Friction::coulomb(mu).into(), e);
                assert!(
                    found.hit == Hit::Slips && (plain.lost - found.lost).abs() < 1e-14,
                    "{found:?} {plain:?}"
                );
            }
        }
    }
}
