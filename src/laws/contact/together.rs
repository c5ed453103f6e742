//! Motions at rest that dry friction resists at the same time: which of them it holds, and how the others begin.
//!
//! ```text
//! x = (u_h, u_2, w_h, w_2, w_h, w_z) = 0     the slip, rolling and rocking, the contact along the rim, the drilling
//! x' = a + N A r,   N = N0/(1 - m.r)         r: the reactions of friction, divided by N
//! |r_slip| <= mu,  |r_roll| <= delta,  |r_contour| <= eps A/s,  |r_drill| <= length
//! r = P(r - rho x')                          P: the nearest reaction within these limits
//! ```
//! A part whose reaction is within its limit is held; otherwise it begins against its reaction, since r is the reaction
//! that takes the most power (Moreau 1974). All reactions act on all motions, so that this is one problem. Divided by N it
//! is linear, r = P(r - rho (q + B r)), and is solved by projection, part by part, and then by Newton's method.
//!
//! Error: a few roundings of x'; the direction of a slip is known as in `standstill`.

use super::slip::Slipping;
use crate::laws::body::Shape;
use crate::laws::loss::{Couples, Law, OwnCouple, Ways, rounded};
use crate::laws::state::{drilling_of, rolling_of, spin_of};
use crate::numbers::larger_or_nan;
use nalgebra::{SMatrix, SVector};

/// Number of components of the reactions: two each of slip and rolling, one each along the rim and of the drilling.
const REACTIONS: usize = 6;
type Reactions = SVector<f64, REACTIONS>;

/// The behaviour of a contact point whose slip is zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Standstill {
    /// The contact point stays at rest, and the body rolls.
    Sticks,
    /// The contact point slips off along `alpha`, from e_h towards e2, and its speed grows at the rate `growth`.
    Slips { alpha: f64, growth: f64 },
    /// No normal force presses the body on the table.
    LiftsOff,
    /// No force, or more than one, obeys the law of friction.
    Undefined,
}

/// A kind of motion that is at rest and that dry friction may hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Resting {
    Slip = 0,
    Rolling = 1,
    Contour = 2,
    Drilling = 3,
}

const ALL_RESTING: [Resting; 4] = [Resting::Slip, Resting::Rolling, Resting::Contour, Resting::Drilling];

impl Resting {
    /// The index of the first component of this motion in the reactions, and the number of its components.
    fn place(self) -> (usize, usize) {
        [(0, 2), (2, 2), (4, 1), (5, 1)][self as usize]
    }
}

/// The result for one motion at rest: its reaction, and the direction and rate at which it begins if friction does not hold it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Fate {
    /// The reaction of friction per normal force, as components of this motion.
    pub reaction: [f64; 2],
    /// The direction in which the motion begins, a unit vector; zero if the motion is held, or is not at rest.
    pub way: [f64; 2],
    /// The rate at which the speed of the motion grows.
    pub growth: f64,
}

impl Fate {
    pub fn begins(&self) -> bool {
        self.way != [0.0; 2]
    }
}

/// The motions at rest of a body or a stone, and their response to reactions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Together {
    /// The largest reaction of each kind of motion, per normal force; None if this motion is not at rest.
    limits: [Option<f64>; 4],
    /// The change x'/N = q + B r of all motions at rest.
    q: Reactions,
    b: SMatrix<f64, REACTIONS, REACTIONS>,
    /// The normal force without reactions, and the vector m in N = N0/(1 - m.r).
    normal: f64,
    lean: Reactions,
    /// A motion of which it is known whether friction holds it; None if there is none.
    known: Option<(Resting, bool)>,
}

/// A reaction by which the response is measured; the response is linear, so that the size matters little.
const PROBE_REACTION: f64 = 0.125;
/// Numbers of sweeps of the projection: before Newton's method, and if Newton's method has not converged.
const PROJECTION_SWEEPS: [usize; 2] = [100, 5000];
const NEWTON_STEPS: usize = 25;
/// The square of a singular value of the slope, beside the sum of all, below which it counts as zero.
const SINGULAR: f64 = 1e-15;
/// Size of an error of the reactions that counts as rounding.
const CONVERGED: f64 = 1e-13;
/// A motion whose reaction is within this of its limit counts as held, since friction holds up to its limit.
const LIMIT_ROUNDING: f64 = 1e-11;
/// Components of a direction below this are roundings of zero.
const DIRECTION_ROUNDING: f64 = 1e-15;
/// Number of directions of the slip from which the search for other solutions starts.
const START_DIRECTIONS: usize = 24;
/// Largest growth rate of the speed of a slip that counts as zero.
const SLIP_GROWTH_ROUNDING: f64 = 1e-11;
/// Directions of slip that differ by less than this, in radians, count as the same.
const SAME_DIRECTION: f64 = 1e-6;

impl Together {
    /// The motions at rest with these limits, and with a function that gives the normal force and x' for reactions per
    /// normal force. None where no normal force presses the body on the table.
    pub fn of(
        limits: [Option<f64>; 4],
        respond: impl Fn(&[f64; REACTIONS]) -> (f64, [f64; REACTIONS]),
    ) -> Option<Self> {
        let (normal, at) = respond(&[0.0; REACTIONS]);
        if normal.is_nan() || normal <= 0.0 {
            return None;
        }
        let q = Reactions::from(at) / normal;
        let mut b = SMatrix::<f64, REACTIONS, REACTIONS>::identity();
        let mut lean = Reactions::zeros();
        for (first, count) in
            ALL_RESTING.into_iter().filter(|p| limits[*p as usize].is_some()).map(Resting::place)
        {
            for i in first..first + count {
                let mut size = PROBE_REACTION;
                let (pressed, at) = loop {
                    let mut reactions = [0.0; REACTIONS];
                    reactions[i] = size;
                    let (pressed, at) = respond(&reactions);
                    if pressed > 0.5 * normal && pressed < 2.0 * normal || size < 1e-6 {
                        break (pressed, at);
                    }
                    size *= 0.25;
                };
                b.set_column(i, &((Reactions::from(at) / pressed - q) / size));
                lean[i] = (1.0 - normal / pressed) / size;
            }
        }
        Some(Self { limits, q, b, normal, lean, known: None })
    }

    /// Returns these motions together with the slip, which friction holds up to the coefficient `limit`.
    #[must_use]
    pub fn with_slip(mut self, limit: f64) -> Self {
        self.limits[Resting::Slip as usize] = Some(limit);
        self
    }

    /// Returns these motions with a motion in `known` that begins (true), since friction has just ceased to hold it, or
    /// that is held in any case (false).
    pub fn knowing(self, known: Option<(Resting, bool)>) -> Self {
        Self { known, ..self }
    }

    pub fn has(&self, part: Resting) -> bool {
        self.limits[part as usize].is_some()
    }

    /// The reaction within the limit of a motion that is nearest to `z`, and whether `z` itself is within the limit.
    fn nearest(&self, part: Resting, z: [f64; 2]) -> ([f64; 2], bool) {
        let limit = self.limits[part as usize].unwrap_or(0.0);
        let size = z[0].hypot(z[1]);
        if size <= limit { (z, true) } else { (z.map(|x| x * (limit / size)), false) }
    }

    fn reaction_of(part: Resting, all: &Reactions) -> [f64; 2] {
        let (first, count) = part.place();
        [all[first], if count == 2 { all[first + 1] } else { 0.0 }]
    }

    fn parts_at_rest(&self) -> impl Iterator<Item = Resting> + '_ {
        ALL_RESTING.into_iter().filter(|part| self.has(*part))
    }

    /// The step length rho of the projection for one motion.
    fn rho(&self, part: Resting) -> f64 {
        let (first, count) = part.place();
        let mut size = 0f64;
        for i in first..first + count {
            let row: f64 = (first..first + count).map(|j| self.b[(i, j)].abs()).sum();
            size = size.max(row);
        }
        1.0 / size
    }

    /// The vector r - rho (q + B r) of one motion, before it is projected on the limits.
    fn before_projection(&self, part: Resting, r: &Reactions) -> [f64; 2] {
        let (first, count) = part.place();
        let rho = self.rho(part);
        let mut z = [0.0; 2];
        for k in 0..count {
            let rate = self.q[first + k] + self.response_to_reactions(first + k, r);
            z[k] = r[first + k] - rho * rate;
        }
        z
    }

    /// The component i of B r, from the reactions of the motions at rest.
    fn response_to_reactions(&self, i: usize, r: &Reactions) -> f64 {
        let mut sum = 0.0;
        for (first, count) in self.parts_at_rest().map(Resting::place) {
            (first..first + count).for_each(|j| sum += self.b[(i, j)] * r[j]);
        }
        sum
    }

    fn project_repeatedly(&self, r: &mut Reactions, sweeps: usize) {
        for _ in 0..sweeps {
            let mut moved = 0f64;
            for part in self.parts_at_rest() {
                let (nearest, _) = self.nearest(part, self.before_projection(part, r));
                let (first, count) = part.place();
                for k in 0..count {
                    moved = larger_or_nan(moved, (nearest[k] - r[first + k]).abs());
                    r[first + k] = nearest[k];
                }
            }
            if moved < 0.01 * CONVERGED {
                return;
            }
        }
    }

    /// The error r - P(r - rho x') of the reactions r, and its derivative with respect to r.
    fn projection_error(&self, r: &Reactions) -> (Reactions, SMatrix<f64, REACTIONS, REACTIONS>) {
        let mut slope = SMatrix::<f64, REACTIONS, REACTIONS>::identity();
        let mut off = Reactions::zeros();
        for part in self.parts_at_rest() {
            let (first, count) = part.place();
            let (z, rho) = (self.before_projection(part, r), self.rho(part));
            let (nearest, within) = self.nearest(part, z);
            let size = z[0].hypot(z[1]);
            let limit = self.limits[part as usize].unwrap_or(0.0);
            for i in 0..count {
                off[first + i] = r[first + i] - nearest[i];
                for (from, n) in self.parts_at_rest().map(Resting::place) {
                    for j in from..from + n {
                        // The derivative of z, multiplied by that of the projection.
                        let mut seen = 0.0;
                        for k in 0..count {
                            let own = f64::from(u8::from(first + k == j)) - rho * self.b[(first + k, j)];
                            let turns = f64::from(u8::from(i == k)) - z[i] * z[k] / (size * size);
                            let turns = if within {
                                f64::from(u8::from(i == k))
                            } else if count == 1 {
                                0.0
                            } else {
                                limit / size * turns
                            };
                            seen += turns * own;
                        }
                        slope[(first + i, j)] = f64::from(u8::from(first + i == j)) - seen;
                    }
                }
            }
        }
        (off, slope)
    }

    /// The reactions that solve the problem, from a first guess `r`.
    fn reactions(&self, mut r: Reactions) -> Reactions {
        for sweeps in PROJECTION_SWEEPS {
            self.project_repeatedly(&mut r, sweeps);
            for _ in 0..NEWTON_STEPS {
                let (off, slope) = self.projection_error(&r);
                let Some(step) = least_step(&slope, &off) else { break };
                let next = r - step;
                if self.projection_error(&next).0.amax() >= off.amax() {
                    break;
                }
                r = next;
            }
            if self.projection_error(&r).0.amax() <= CONVERGED {
                break;
            }
        }
        r
    }

    /// The result for each kind of motion, in the order of [`Resting`].
    pub fn fates(&self) -> [Fate; 4] {
        self.fates_from(Reactions::zeros())
    }

    fn fates_from(&self, guess: Reactions) -> [Fate; 4] {
        let r = self.reactions(guess);
        let pressed = self.normal / (1.0 - self.lean.dot(&r));
        let mut all = [Fate::default(); 4];
        for part in self.parts_at_rest() {
            let z = self.before_projection(part, &r);
            let limit = self.limits[part as usize].unwrap_or(0.0);
            let size = z[0].hypot(z[1]);
            let fate = &mut all[part as usize];
            fate.reaction = Self::reaction_of(part, &r);
            let begins = match self.known {
                Some((known, begins)) if known == part => begins && size > 0.0,
                _ => size > limit * (1.0 + LIMIT_ROUNDING),
            };
            if begins {
                let way = z.map(|x| if x.abs() < DIRECTION_ROUNDING * size { 0.0 } else { 0.0 - x / size });
                fate.way = way;
                fate.growth = (size - limit).max(0.0) / self.rho(part) * pressed;
            }
        }
        all
    }

    /// The behaviour of a contact point at rest, with the coefficients of sliding and of static friction. If
    /// `doubtful`, more than one behaviour may be consistent, and all that a search from many directions finds are
    /// counted.
    pub fn standstill(&self, [mu, fixed]: [f64; 2], doubtful: bool) -> Standstill {
        let slip = |fates: &[Fate; 4]| fates[Resting::Slip as usize];
        let slips = |fate: Fate| Standstill::Slips {
            alpha: f64::atan2(fate.way[1], fate.way[0]),
            growth: fate.growth,
        };
        let (fixed, sliding) = (self.with_slip(fixed), self.with_slip(mu));
        if !doubtful {
            if !slip(&fixed.fates()).begins() {
                return Standstill::Sticks;
            }
            let fate = slip(&sliding.fates());
            return if fate.begins() { slips(fate) } else { Standstill::Sticks };
        }
        let holds = |of: &Self| of.consistent_slips().iter().any(|fate| !fate.begins());
        let mut found: Vec<Fate> = sliding.consistent_slips();
        found.retain(|fate| fate.begins() && fate.growth > SLIP_GROWTH_ROUNDING);
        if holds(&fixed) {
            let allowed = usize::from(!holds(&sliding));
            return if found.len() > allowed { Standstill::Undefined } else { Standstill::Sticks };
        }
        if let [only] = found[..] { slips(only) } else { Standstill::Undefined }
    }

    /// The direction in which the contact point slips off when static friction has just ceased to hold it.
    pub fn lets_go(&self, [mu, fixed]: [f64; 2], doubtful: bool) -> Standstill {
        if fixed != mu {
            return match self.standstill([mu; 2], doubtful) {
                Standstill::Sticks => Standstill::Undefined,
                found => found,
            };
        }
        let [across, along] = self.with_slip(f64::INFINITY).fates()[Resting::Slip as usize].reaction;
        let slips = Standstill::Slips { alpha: f64::atan2(0.0 - along, 0.0 - across), growth: 0.0 };
        let another =
            doubtful && self.with_slip(mu).consistent_slips().iter().any(|fate| fate.growth > SAME_DIRECTION);
        if another { Standstill::Undefined } else { slips }
    }

    /// The results for the slip in all consistent solutions that the search finds.
    fn consistent_slips(&self) -> Vec<Fate> {
        let mut found: Vec<Fate> = Vec::new();
        let limit = self.limits[Resting::Slip as usize].unwrap_or(0.0).min(1e6);
        for k in 0..=START_DIRECTIONS {
            let mut guess = Reactions::zeros();
            if k > 0 {
                let (sin, cos) = (core::f64::consts::TAU * k as f64 / START_DIRECTIONS as f64).sin_cos();
                (guess[0], guess[1]) = (limit * cos, limit * sin);
            }
            let r = self.reactions(guess);
            let fate = self.fates_from(guess)[Resting::Slip as usize];
            let sound = self.projection_error(&r).0.amax() <= 1e-9 && 1.0 - self.lean.dot(&r) > 0.0;
            let same = |other: &Fate| {
                (other.way[0] - fate.way[0]).hypot(other.way[1] - fate.way[1]) < SAME_DIRECTION
            };
            if sound && !found.iter().any(same) {
                found.push(fate);
            }
        }
        found
    }
}

/// The friction at a contact point that is at rest, or that slips.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Rubs {
    Rests,
    /// The friction force -N `pull`, and the couple `twist` N of a patch.
    Slips {
        pull: [f64; 2],
        twist: f64,
    },
}

impl Together {
    /// The motions at rest of a body of revolution, other than the slip. None if there are none, or if nothing presses
    /// the body on the table. Speeds below `still` count as zero.
    pub fn of_body(
        shape: &Shape<f64>,
        losses: &Couples<f64, impl OwnCouple<f64>>,
        (angle, w): ((f64, f64), [f64; 3]),
        u: [f64; 2],
        rubs: Rubs,
    ) -> Option<Self> {
        let ((s, c), [w1, w2, w3]) = (angle, w);
        let (spin, turns) = (spin_of((s, c), w1, w3), drilling_of((s, c), w1, w3));
        let (drilling, still) = (turns - losses.om.unwrap_or(0.0), rounded(s, w));
        let limit =
            |law: Law, rests: bool, by: f64| (losses.has(law) && rests).then(|| losses.coefficient(law) * by);
        let (along, rocks) = (spin.abs() <= still, w2.abs() <= still);
        let limits = [
            None,
            limit(Law::RollingResistance, along && rocks, 1.0),
            limit(Law::DryContour, along, shape.rim.radius(angle) / s),
            limit(Law::Drilling, drilling.abs() <= still, 1.0),
        ];
        if limits == [None; 4] {
            return None;
        }
        let way = |rests: bool, speed: f64| if rests { 0.0 } else { speed.signum() };
        let mut base = losses.with_pressed_couple([0.0; 3]);
        base.ways = Some(Ways {
            contour: way(limits[2].is_some(), spin),
            drilling: way(limits[3].is_some(), drilling),
            ..Ways::default()
        });
        if limits[1].is_some() {
            base.sets(Law::RollingResistance, 0.0);
        }
        let slipping = Slipping::of(shape, 1.0, false);
        let (pulled, twist, slips) = match rubs {
            Rubs::Rests => ([0.0; 2], 0.0, Some(f64::INFINITY)),
            Rubs::Slips { pull, twist } => (pull, twist, None),
        };
        let respond = |r: &[f64; REACTIONS]| {
            let ([a, b, across, tilt, contour], turn) = ([r[0], r[1], r[2], r[3], r[4]], r[5] + twist);
            let couple = [c * (across + contour) + s * turn, tilt, c * turn - s * (across + contour)];
            let law = slipping.with_losses(Some(base.with_pressed_couple(couple)));
            let at = law.towards(angle, w, u, [pulled[0] - a, pulled[1] - b]);
            let [d1, d2, d3] = at.w;
            let rolls = rolling_of((s, c), d1, d3) + w2 * turns;
            let drills = drilling_of((s, c), d1, d3) - w2 * rolling_of((s, c), w1, w3);
            (at.force[0], [at.u[0], at.u[1], rolls, d2, rolls, drills])
        };
        Self::of([slips, limits[1], limits[2], limits[3]], respond)
    }
}

/// The shortest x with slope x = off. Two reactions that resist the same motion make the slope singular; where it nearly is,
/// x is too short, and the next step of Newton's method adds the rest.
fn least_step(slope: &SMatrix<f64, REACTIONS, REACTIONS>, off: &Reactions) -> Option<Reactions> {
    let squared = slope * slope.transpose();
    let shift = SMatrix::from_diagonal_element(SINGULAR * squared.trace());
    Some(slope.tr_mul(&(squared + shift).cholesky()?.solve(off)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_of_what_reactions_miss_is_that_of_its_differences_within_limits_and_beyond() {
        // A response like that of a body: x' = a + A r, symmetric and positive, under a normal force that leans.
        let respond = |r: &[f64; REACTIONS]| {
            let a = [0.4, -0.7, 0.5, 0.3, 0.0, -0.6];
            let x = core::array::from_fn(|i| {
                a[i] + (0..REACTIONS).map(|j| r[j] * if i == j { 2.0 } else { 0.2 }).sum::<f64>()
            });
            (1.0 / (1.0 - 0.1 * r[0]), x)
        };
        for limits in [0.05, 0.2, 10.0] {
            let rests =
                Together::of([Some(limits), Some(0.5 * limits), None, Some(limits)], respond).unwrap();
            let r = Reactions::from([0.1, -0.2, 0.15, 0.05, 0.0, 0.3]);
            let slope = rests.projection_error(&r).1;
            for j in [0, 1, 2, 3, 5] {
                let mut by = Reactions::zeros();
                by[j] = 1e-6;
                let differs =
                    (rests.projection_error(&(r + by)).0 - rests.projection_error(&(r - by)).0) / 2e-6;
                let off = (slope.column(j) - differs).amax();
                assert!(off < 1e-8, "{limits}, {j}: {off:e}");
            }
        }
    }
}
