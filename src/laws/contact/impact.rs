//! Impact of a body on the table: the impulses at one point, and the share of the normal velocity that is restored.
//!
//! ```text
//! M = [[A, b], [b, a_n]]                             change of the contact point's velocity per impulse ([`Delassus`])
//! rim: A = diag(a_h, a_2),   b = (b, 0)              along e_h, e2 and z
//! a_h = 1 + h^2/I1,  a_2 = 1 + L^2/I1 + A^2/I3,  a_n = 1 + g^2/I1,  b = h g/I1
//! w1' - w1 = L P_2/I1,   w2' - w2 = -(h P_h + g P_n)/I1,   w3' - w3 = -A P_2/I3
//! along the impact, p the normal impulse so far:   du/dp = M (-mu cos, -mu sin, 1),   u = sigma (cos, sin)
//! compression ends at u_n = 0 with the work W_c < 0 of the normal force, the impact ends where W = (1 - e^2) W_c
//! ```
//! Restitution is energetic (Stronge, Proc. R. Soc. A 431, 169 (1990)), so that no impact gains energy. It equals the
//! ratio of the normal velocities where the direction of the slip stays. Friction along the impact is Coulomb's (Routh
//! 1860; Keller, J. Appl. Mech. 53, 1 (1986)): where a slip stops, it sticks if |A^-1 b| <= mu_s, otherwise it slips on
//! along the one way out. For every mu and every body the impact has one outcome. A slip jams if its friction presses the rim into
//! the table faster than the impulse slows it, so that no contact force exists (Painleve): an impact that begins with
//! u_n = 0 stops the slip (Genot and Brogliato, Eur. J. Mech. A 18, 653 (1999)). The motion is straight, and the
//! formulas are closed, except for a first slip whose direction turns; a viscous [`film`](super::film) is linear. Under a coefficient that
//! depends on the speed the same equations hold with the coefficient at the current speed, and steps follow them. Where
//! friction presses the point down once more before restitution ends, W_c is the lowest work so far, so that a second
//! compression is not given back whole. A patch of contact also drills ([`sliding`](super::sliding)).
//! Other laws of [restitution](super::restitution) end the same impact elsewhere.
//!
//! Error: 1e-13 of the largest velocity; a test of `laws` compares with integration in the laboratory's axes.

use super::delassus::{Delassus, speed};
use super::restitution::ImpactLaw;
use super::sliding::{
    DRILLING, FIRST, ImpactSlip, LIFT, PUSHED, PatchedPoint, Restored, Roughness, SLIDING, STOPPED, SlipEnd,
    WORK,
};
use super::slip::Friction;
use super::table::Table;
use crate::laws::body::Shape;
use crate::laws::custom::SpeedLaw;
use crate::methods::flow::{Flow, Steps};
use crate::numbers::codes::coded;

coded! {
    /// The motion of the contact point in an impact.
    pub enum Hit {
        /// The contact point slips until the impact ends.
        Slips = 0,
        /// The slip stops, and the contact point then sticks.
        Sticks = 1,
        /// The slip stops and then begins in another direction, since friction cannot hold the contact point.
        SlipsOn = 2,
        /// The contact point slips without friction.
        Smooth = 3,
        /// Both rims land at once, or the other rim lands without a bounce; the impulse is the sum over both rims.
        BothRims = 4,
        /// The contact point slips slowly, since the patch of contact drills (turns about the vertical).
        Creeps = 5,
        /// The slip of a ball turns back, by tangential restitution.
        TurnsBack = 6,
    }
}

/// The velocity of the point of contact before an impact, and the inverse of its inertia.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointImpact {
    /// The slip along the two horizontal axes, and the normal velocity, which is negative, or zero where a slip jams.
    pub slip: [f64; 2],
    pub lift: f64,
    pub light: Delassus,
    /// The patch of contact at this point; None for a point.
    pub patch: Option<PatchedPoint>,
    /// The law of restitution, which says where the impact ends.
    pub law: ImpactLaw,
    /// Tolerance of a step along an impact whose slip turns, at least 3e-14; and the factor by which the first step is
    /// longer than usual.
    pub tol: f64,
    pub longer: f64,
}

/// The result of an impact: the impulses P_h, P_2 and P_n, and the velocity of the contact point after it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Struck {
    pub impulse: [f64; 3],
    /// The impulse of the couple about the normal, which a patch of contact exerts.
    pub couple: f64,
    pub slip: [f64; 2],
    pub lift: f64,
    pub hit: Hit,
    /// Energy lost in the impact, in M g R.
    pub lost: f64,
}

/// The inverse inertia of the lowest point of a rim, along e_h and e2.
pub(crate) fn lightness(shape: &Shape<f64>, angle: (f64, f64)) -> Delassus {
    let Shape { rim, i1, i3 } = shape;
    let (height, lever) = (rim.height(angle), rim.lever(angle));
    let (depth, radius) = (rim.depth(angle), rim.radius(angle));
    let across = 1.0 + depth * depth / i1 + radius * radius / i3;
    Delassus {
        level: [[1.0 + height * height / i1, 0.0], [0.0, across]],
        couples: [height * lever / i1, 0.0],
        normal: 1.0 + lever * lever / i1,
    }
}

/// The patch of contact of the given radius on a rim that drills at the rate `drilling`.
pub(crate) fn patched(shape: &Shape<f64>, angle: (f64, f64), radius: f64, drilling: f64) -> PatchedPoint {
    let (Shape { rim, i1, i3 }, (s, c)) = (shape, angle);
    let across = s * rim.depth(angle) / i1 - c * rim.radius(angle) / i3;
    PatchedPoint { radius, drilling, row: [0.0, across, 0.0], about: s * s / i1 + c * c / i3 }
}

/// The angular velocity after an impact.
pub(crate) fn turned(shape: &Shape<f64>, angle: (f64, f64), w: [f64; 3], struck: &Struck) -> [f64; 3] {
    let (Shape { rim, i1, i3 }, ([p_h, p_2, p_n], couple)) = (shape, (struck.impulse, struck.couple));
    [
        w[0] + (rim.depth(angle) * p_2 + angle.0 * couple) / i1,
        w[1] - (rim.height(angle) * p_h + rim.lever(angle) * p_n) / i1,
        w[2] - (rim.radius(angle) * p_2 - angle.1 * couple) / i3,
    ]
}

/// Largest number of steps of the integration along an impact.
const IMPACT_STEPS: u64 = 5_000;

/// The state along an impact, with all velocities in units of the first normal velocity, or of the slip where that is zero.
pub(super) struct ImpactCourse {
    pub impulse: [f64; 3],
    couple: f64,
    pub lift: f64,
    /// The work of the normal force since the beginning of compression, or since its end.
    pub work: f64,
    /// The end of restitution; None while compression lasts.
    restores: Option<Restored>,
    /// The normal velocity before the impact.
    first: f64,
    pub e: f64,
    pub law: ImpactLaw,
}

impl ImpactCourse {
    /// Ends compression and begins restitution.
    fn turns_round(&mut self) {
        self.restores = Some(match self.law {
            ImpactLaw::Newton => Restored::at(LIFT, self.e * -self.first),
            ImpactLaw::Poisson => Restored::at(PUSHED, (1.0 + self.e) * self.impulse[2]),
            _ => Restored::at(WORK, self.e * self.e * -self.work),
        });
        (self.lift, self.work) = (0.0, 0.0);
    }

    /// Ends a second compression, where `work` has been done since the end of the first one. The lowest work so far
    /// then counts; for Poisson's law the whole impulse so far.
    fn lowers(&mut self, work: f64) {
        let left = (1.0 - self.e) * (1.0 + self.e);
        self.restores = self.restores.map(|Restored { number, value }| {
            let value = match number {
                WORK => value + left * work.min(0.0),
                PUSHED => (1.0 + self.e) * self.impulse[2],
                _ => value,
            };
            Restored { number, value }
        });
    }

    /// Continues the impact with a constant direction of slip, in which the normal velocity grows at the rate `k`, for
    /// at most the normal impulse `most`. Returns whether the impact ends.
    fn straight(&mut self, k: f64, push: [f64; 3], mut most: f64) -> bool {
        if self.restores.is_none() {
            let end = if k > 0.0 { -self.lift / k } else { f64::INFINITY };
            if end > most || end == f64::INFINITY {
                self.moves(k, push, most);
                return false;
            }
            self.moves(k, push, end);
            self.turns_round();
            most -= end;
        }
        if self.lift < 0.0 && k > 0.0 && -self.lift <= k * most {
            let again = -self.lift / k;
            self.moves(k, push, again);
            most -= again;
            self.lowers(self.work);
            self.lift = 0.0;
        }
        let Some(Restored { number, value }) = self.restores else { return false };
        let left = value - self.work;
        let square = self.lift * self.lift + 2.0 * k * left;
        let end = match number {
            PUSHED => value - self.impulse[2],
            LIFT => (value - self.lift) / k,
            _ if self.lift > 0.0 => 2.0 * left / (self.lift + square.max(0.0).sqrt()),
            _ => (square.max(0.0).sqrt() - self.lift) / k,
        };
        // Friction may press the body down once more before restitution ends.
        let pressed = match number {
            PUSHED => self.lift + k * end < 0.0,
            LIFT => k <= 0.0,
            _ => square < 0.0,
        };
        let end = match pressed {
            true if most < f64::INFINITY => f64::INFINITY,
            true if number != WORK => -self.lift / k,
            _ => end,
        };
        self.moves(k, push, end.min(most));
        end <= most
    }

    /// The whole impact of a ball whose slip turns back where friction grips it, by a horizontal impulse of at most mu
    /// times the normal impulse.
    fn ball(&mut self, slip: [f64; 2], light: &Delassus, mu: f64) -> Along {
        let (p, [a, _]) = (-(1.0 + self.e) * self.lift / light.normal, light.level[0]);
        let wanted = (1.0 + self.law.tangential()) / a;
        let most = mu * p / speed(slip);
        let push = slip.map(|u| -wanted.min(most) * u);
        (self.impulse, self.lift) = ([push[0], push[1], p], -self.e * self.lift);
        if wanted <= most { Along::Back } else { Along::Slip }
    }

    /// Adds the normal impulse `p` with a constant direction of slip, in which the normal velocity grows at the rate `k`.
    fn moves(&mut self, k: f64, [p_1, p_2, couple]: [f64; 3], p: f64) {
        self.couple += couple * p;
        self.work += p * (self.lift + 0.5 * k * p);
        self.lift += k * p;
        self.impulse = [self.impulse[0] + p_1 * p, self.impulse[1] + p_2 * p, self.impulse[2] + p];
    }
}

impl PointImpact {
    /// The impact under this law of contact with the restitution `e`. The result is None for a rolling contact without
    /// a solution, whose friction would lift the body before the slip has stopped or would exceed mu times the normal
    /// impulse, and after too many steps. If `own` makes the coefficient depend on the speed, it is that of the current
    /// speed along the impact.
    pub fn on(&self, table: &Table, e: f64, own: &impl SpeedLaw) -> Option<Struck> {
        let big = if self.lift < 0.0 { -self.lift } else { speed(self.slip) };
        let (lift, slip) = (self.lift / big, self.slip.map(|u| u / big));
        let law = self.law;
        let mut course = ImpactCourse {
            impulse: [0.0; 3],
            couple: 0.0,
            lift,
            work: 0.0,
            restores: None,
            first: lift,
            e,
            law,
        };
        let along = match *table {
            Table::Rubs(Friction::Coulomb { mu, .. }) if law.turns_back() && speed(slip) > 0.0 => {
                course.ball(slip, &self.light, mu)
            }
            Table::Rolling { .. } => {
                // Friction stops the slip before the normal impulse begins.
                let stops = self.light.pushes(slip.map(|u| -u));
                course.impulse = [stops[0], stops[1], 0.0];
                course.lift += self.light.lifts(stops);
                if course.lift >= 0.0 || self.light.lifts_on_the_way(slip, lift) {
                    return None;
                }
                Along::Rest
            }
            Table::Rubs(Friction::Viscous { c }) if c > 0.0 => {
                course.film(c * big, slip, &self.light);
                Along::Slip
            }
            Table::Rubs(friction @ Friction::Coulomb { mu, fixed, .. })
                if mu > 0.0 || friction.sticks() || own.varies() =>
            {
                let law = |speed: f64| own.coefficient_at(speed * big);
                let rubs = Roughness { mu, law: if own.varies() { Some(&law) } else { None } };
                let patch = self.patch.filter(|patch| patch.turns(self.slip, &self.light));
                let patch = patch.map(|patch| PatchedPoint { drilling: patch.drilling / big, ..patch });
                let flow = ImpactSlip { light: self.light, rubs, patch, restores: None, tol: self.tol };
                self.rubs(&mut course, slip, flow, fixed)?
            }
            _ => {
                course.straight(self.light.normal, [0.0; 3], f64::INFINITY);
                Along::Ice
            }
        };
        if let Along::Rest = along {
            let holds = self.light.pushes(self.light.couples.map(|b| -b));
            course.straight(
                self.light.normal + self.light.lifts(holds),
                [holds[0], holds[1], 0.0],
                f64::INFINITY,
            );
        }
        let [p_1, p_2, p_n] = course.impulse.map(|p| p * big);
        let lift = if e > 0.0 { course.lift * big } else { 0.0 };
        if let Table::Rolling { mu } = *table
            && p_1.hypot(p_2) > mu * p_n
        {
            return None;
        }
        let ([gained, aside], [b_1, b_2]) = (self.light.level([p_1, p_2]), self.light.couples);
        let mut changes = [gained + b_1 * p_n, aside + b_2 * p_n];
        let (mut drilled, couple) = (0.0, course.couple * big);
        if let Some(PatchedPoint { drilling, row: [m_1, m_2, m_n], about, .. }) = self.patch {
            changes = [changes[0] + m_1 * couple, changes[1] + m_2 * couple];
            let after = drilling + (m_1 * p_1 + m_2 * p_2 + m_n * p_n) + about * couple;
            drilled = drilling + if let Along::Held = along { 0.0 } else { after };
        }
        let [u, v] = [self.slip[0] + changes[0], self.slip[1] + changes[1]];
        let (slip, hit) = match along {
            Along::Ice => ([u, v], Hit::Smooth),
            Along::Slip => ([u, v], Hit::Slips),
            Along::Creep => ([u, v], Hit::Creeps),
            Along::Rest | Along::Held => ([0.0; 2], Hit::Sticks),
            Along::Back => (self.slip.map(|u| 0.0 - law.tangential() * u), Hit::TurnsBack),
            // A slip that has stopped can only begin in this direction.
            Along::On([x, y]) => ([x, y].map(|to| to * (x * u + y * v)), Hit::SlipsOn),
            Along::Off => ([u, v], Hit::SlipsOn),
        };
        let lost = -0.5
            * ((self.slip[0] + slip[0]) * p_1
                + (self.slip[1] + slip[1]) * p_2
                + (self.lift + lift) * p_n
                + drilled * couple);
        Some(Struck { impulse: [p_1, p_2, p_n], couple, slip, lift, hit, lost })
    }

    /// The impact under dry friction, up to the stop of the slip. None after too many steps.
    fn rubs(
        &self,
        course: &mut ImpactCourse,
        slip: [f64; 2],
        flow: ImpactSlip<'_>,
        fixed: f64,
    ) -> Option<Along> {
        let (light, rubs) = (&self.light, flow.rubs);
        let mut begin = [0.0; SLIDING];
        [begin[0], begin[1], begin[DRILLING]] = [slip[0], slip[1], flow.patch().map_or(0.0, |p| p.drilling)];
        let rubbing = flow.rubbing(&begin);
        let moves = rubbing > STOPPED * (1.0 + rubbing) && (rubs.law.is_some() || rubs.mu > 0.0);
        if moves {
            let (y, ended) = self.slides(course, begin, flow)?;
            if ended {
                return Some(if flow.creeps(&y) { Along::Creep } else { Along::Slip });
            }
        }
        if let Some(patch) = &flow.patch() {
            let (forces @ [x, y, couple], holds) = flow.after_rest(patch, fixed)?;
            let rises = light.normal + light.lifts([x, y]) + patch.row[2] * couple;
            course.straight(rises, forces, f64::INFINITY);
            return Some(if holds { Along::Held } else { Along::Off });
        }
        if speed(light.pushes(light.couples)) <= fixed {
            return Some(Along::Rest);
        }
        let mu = rubs.at(0.0);
        let way = light.way_out(mu);
        if rubs.law.is_some() {
            let mut begins = [0.0; SLIDING];
            begins[..2].copy_from_slice(&way.map(|x| 2.0 * STOPPED * x));
            let [u, v, ..] = self.slides(course, begins, flow)?.0;
            return Some(Along::On([u, v].map(|x| x / speed([u, v]))));
        }
        let push = way.map(|x| -mu * x);
        course.straight(light.normal + light.lifts(push), [push[0], push[1], 0.0], f64::INFINITY);
        Some(Along::On(way))
    }

    /// The slip under dry friction from the variables `begin`. Returns the variables where the integration ends, and
    /// whether the impact ends before the slip stops; None after too many steps.
    fn slides(
        &self,
        course: &mut ImpactCourse,
        begin: [f64; SLIDING],
        mut flow: ImpactSlip<'_>,
    ) -> Option<([f64; SLIDING], bool)> {
        flow.restores = course.restores;
        let ([p_1, p_2, p], mut first) = (course.impulse, FIRST * self.longer);
        let [u, v, drilling, ..] = begin;
        let mut y = [u, v, drilling, course.lift, p_1, p_2, course.couple, p, course.work];
        let (mut done, mut again) = (false, None);
        while !done && !flow.is_over(&y) {
            let steps = Steps {
                first: Some(first),
                most: IMPACT_STEPS,
                patience: u64::MAX,
                toil: u64::MAX,
                tired: false,
            };
            let flown = flow.run(flow.place(y), steps, &[f64::INFINITY], &mut |_| (), &mut || true);
            (y, first) = (flown.y, flown.step);
            [course.lift, course.work, course.impulse[2]] = [y[LIFT], y[WORK], y[PUSHED]];
            match flown.halt {
                SlipEnd::Over if flow.restores.is_some() => done = true,
                SlipEnd::Over if again.take().is_some() => {
                    course.lowers(course.work);
                    (course.lift, y[LIFT], flow.restores) = (0.0, 0.0, course.restores);
                }
                SlipEnd::Over => {
                    course.turns_round();
                    (flow.restores, y[LIFT], y[WORK]) = (course.restores, 0.0, 0.0);
                    done = flow.restores.is_some_and(|restored| restored.left(&y) <= 0.0);
                }
                SlipEnd::Falls => again = flow.restores.take(),
                SlipEnd::Straight => {}
                SlipEnd::GivenUp => return None,
            }
        }
        let [u, v, _, _, p_1, p_2, couple, p, _] = y;
        (course.impulse, course.couple) = ([p_1, p_2, p], couple);
        if let Some((forces @ [x, z, couple], most)) = flow.stays(&y).filter(|_| !done) {
            let driven = flow.patch().map_or(0.0, |patch| patch.row[2] * couple);
            let ended = course.straight(self.light.normal + self.light.lifts([x, z]) + driven, forces, most);
            return Some((y, ended));
        }
        let Some(kept) = flow.keeps([u, v]).filter(|_| !done) else { return Some((y, done)) };
        let ([x, z], sigma, mu) = (kept.way, speed([u, v]), flow.rubs.mu);
        let slow = -self.light.growth(kept.way, mu);
        let push = kept.way.map(|x| -mu * x);
        let most = if slow > 0.0 { sigma / slow } else { f64::INFINITY };
        let ended =
            course.straight(self.light.normal + self.light.lifts(push), [push[0], push[1], 0.0], most);
        // The remaining slip across that direction falls as a power of the slip.
        let long = (course.impulse[2] - p) / sigma;
        let log = if slow * long == 0.0 { -long } else { (-slow * long).max(-1.0).ln_1p() / slow };
        let across = kept.across * (mu * kept.light * log).exp_m1() / kept.light;
        course.impulse[0] -= z * across;
        course.impulse[1] += x * across;
        Some((y, ended))
    }
}

/// How the contact point moves when an impact ends.
enum Along {
    Ice,
    Slip,
    /// The slip is the creep that follows from the drilling of the patch.
    Creep,
    Rest,
    /// Slip and drilling of the patch have stopped, and friction holds both.
    Held,
    /// Slip and drilling of the patch have stopped, and friction cannot hold both.
    Off,
    /// The slip of a ball turns back, since friction grips it.
    Back,
    /// The contact point slips on along this direction after its slip had stopped.
    On([f64; 2]),
}

#[cfg(test)]
mod tests {
    use super::super::patch;
    use super::*;

    /// The skew ellipsoid of an independent model with 30 digits, along axes that lean to no side of it.
    const SKEW: Delassus = Delassus {
        level: [[2.5894286673, -0.4274491318], [-0.4274491318, 2.9079343858]],
        couples: [-0.2276773350, -0.8941686560],
        normal: 1.5417027085,
    };

    fn struck(light: Delassus, slip: [f64; 2], mu: f64, e: f64) -> Struck {
        let impact = PointImpact {
            slip,
            lift: -1.0,
            light,
            patch: None,
            law: ImpactLaw::Stronge,
            tol: 3e-14,
            longer: 1.0,
        };
        impact.on(&Friction::coulomb(mu).into(), e, &()).unwrap()
    }

    fn turned([u, v]: [f64; 2], (sin, cos): (f64, f64)) -> [f64; 2] {
        [cos * u - sin * v, sin * u + cos * v]
    }

    #[test]
    fn a_stone_without_a_plane_of_symmetry_slips_and_sticks_as_in_an_independent_model() {
        for (mu, impulse, lift, hit) in [
            (0.2, [-0.0766894409, 0.2006982782, 1.1325901481], 0.5841196368, Hit::Slips),
            (0.6, [0.0103712775, 0.5174944953, 1.3424836979], 0.6046220909, Hit::Sticks),
        ] {
            let found = struck(SKEW, [0.5, -0.3], mu, 0.6);
            let off = (0..3).map(|i| (found.impulse[i] - impulse[i]).abs()).fold(0.0, f64::max);
            assert!(found.hit == hit && off < 3e-10 && (found.lift - lift).abs() < 3e-10, "{mu}: {found:?}");
        }
    }

    #[test]
    fn an_impact_does_not_depend_on_the_axes_in_which_it_is_written() {
        let rim = Delassus { level: [[1.7, 0.0], [0.0, 4.2]], couples: [-1.1, 0.0], normal: 2.1 };
        let mut hits = [0; 5];
        for k in 0..400 {
            let part = |i: u32| (0.61803398875 * f64::from(k * 7 + i)).fract();
            let (mu, e) = (1.2 * part(1), part(2));
            let slip = [2.0 * part(3) - 1.0, if k % 5 == 0 { 0.0 } else { part(4) - 0.5 }];
            let slip = if k % 7 == 0 { [0.0; 2] } else { slip };
            let light = if k % 2 == 0 { SKEW } else { rim };
            let angle = (6.0 * part(5)).sin_cos();
            let whole = light.level.map(|row| turned(row, angle));
            let [left, right] = [0, 1].map(|i| turned([whole[0][i], whole[1][i]], angle));
            let level = [[left[0], right[0]], [left[1], right[1]]];
            let aside = Delassus { level, couples: turned(light.couples, angle), ..light };
            let [here, there] = [struck(light, slip, mu, e), struck(aside, turned(slip, angle), mu, e)];
            let [[p, q], [u, v]] = [[here.impulse[0], here.impulse[1]], here.slip].map(|x| turned(x, angle));
            let off = [p - there.impulse[0], q - there.impulse[1], here.impulse[2] - there.impulse[2]]
                .into_iter()
                .chain([
                    u - there.slip[0],
                    v - there.slip[1],
                    here.lift - there.lift,
                    here.lost - there.lost,
                ]);
            let off = off.fold(0.0, |most: f64, x| most.max(x.abs()));
            assert!(here.hit == there.hit && off < 1e-12, "{k}: {off:e} {here:?} {there:?}");
            hits[here.hit as usize] += 1;
        }
        assert!(hits[..3].iter().all(|&n| n > 10), "{hits:?}");
    }

    /// The patch of contact of the skew ellipsoid `SKEW`.
    const SKEW_PATCH: PatchedPoint = PatchedPoint {
        radius: 0.05,
        drilling: 3.0,
        row: [0.8001985746, -0.4498319147, 0.0104008837],
        about: 3.1524766760,
    };

    fn on_patch(light: Delassus, patch: PatchedPoint, slip: [f64; 2], mu: f64, e: f64) -> Struck {
        let impact = PointImpact {
            slip,
            lift: -1.0,
            light,
            patch: Some(patch),
            law: ImpactLaw::Stronge,
            tol: 3e-14,
            longer: 1.0,
        };
        impact.on(&Friction::Coulomb { mu, fixed: mu, patch: patch.radius }.into(), e, &()).unwrap()
    }

    #[test]
    fn a_patch_slips_and_drills_along_an_impact_as_in_an_independent_model() {
        let found = on_patch(SKEW, SKEW_PATCH, [0.5, -0.3], 0.2, 0.6);
        let known = [-0.0763430747, 0.1992179466, 1.1318113199, -0.0005783491, 0.5841577062];
        let [p, q, n] = found.impulse;
        let off = [p, q, n, found.couple, found.lift].into_iter().zip(known).map(|(a, b)| (a - b).abs());
        assert!(found.hit == Hit::Slips && off.fold(0.0, f64::max) < 3e-10, "{found:?}");
    }

    #[test]
    fn a_patch_tends_to_the_point_in_the_first_order_of_its_radius_also_where_it_creeps() {
        for (slip, mu) in [([0.5, -0.3], 0.2), ([0.5, -0.3], 0.6), ([0.02, 0.01], 0.9), ([0.0, 0.0], 0.1)] {
            let point = struck(SKEW, slip, mu, 0.6);
            let mut before = f64::INFINITY;
            for radius in [1e-2, 1e-3, 1e-4, 1e-6, 1e-9, 1e-13] {
                let found = on_patch(SKEW, PatchedPoint { radius, ..SKEW_PATCH }, slip, mu, 0.6);
                let off = (0..3).map(|i| (found.impulse[i] - point.impulse[i]).abs());
                let off = off.fold((found.lift - point.lift).abs(), f64::max);
                assert!(off < 2.0 * radius + 1e-12 && off < before, "{slip:?} {mu} {radius}: {off:e}");
                assert!(found.lost > 0.0 && found.couple <= 0.0, "{found:?}");
                assert!(found.hit != Hit::Sticks, "{found:?}");
                before = off.max(1e-12);
            }
        }
    }

    #[test]
    fn a_ball_on_a_patch_is_struck_as_it_slides_for_the_time_of_the_impulse() {
        // Pure drilling loses (3 pi/16) mu eps (1 + e)/I, and stops.
        let ball = Delassus { level: [[3.5, 0.0], [0.0, 3.5]], couples: [0.0; 2], normal: 1.0 };
        for (drilling, e) in [(2.0, 0.7), (-2.0, 0.0), (0.01, 0.9)] {
            let patch = PatchedPoint { radius: 0.05, drilling, row: [0.0; 3], about: 2.5 };
            let found = on_patch(ball, patch, [0.0; 2], 0.3, e);
            let slows =
                (3.0 * core::f64::consts::PI / 16.0 * 0.3 * 0.05 * (1.0 + e) * 2.5).min(drilling.abs());
            let off = found.couple + slows * drilling.signum() / 2.5;
            assert!(off.abs() < 1e-14 && found.impulse[..2] == [0.0; 2], "{drilling}: {off:e} {found:?}");
        }
    }

    #[test]
    fn slip_and_drilling_that_have_stopped_are_held_or_leave_along_the_one_way_out() {
        let mut hits = [0; 6];
        for k in 0..300 {
            let part = |i: usize| (f64::from(k) * [2.0f64, 3.0, 5.0, 7.0, 11.0, 13.0][i - 1].sqrt()).fract();
            let (mu, radius) = (0.02 + 0.5 * part(1), [0.3, 0.03, 1e-4][k as usize % 3]);
            // A drilling that the normal impulse drives itself, as of a stone that lands on a twisted side.
            let row = [2.0 * part(2) - 1.0, 2.0 * part(3) - 1.0, 0.6 * part(4) - 0.3];
            let patch = PatchedPoint { radius, drilling: 0.0, row, about: 3.2 };
            let couples = [0.4 * part(5) - 0.2, 0.4 * part(6) - 0.2];
            let light = Delassus { couples, ..SKEW };
            let found = on_patch(light, patch, [0.0; 2], mu, 0.5);
            let [x, y, n] = found.impulse;
            let [u, v] = found.slip;
            let drilling = row[0] * x + row[1] * y + row[2] * n + 3.2 * found.couple;
            assert!(found.lost > -1e-15 && x.hypot(y) <= mu * n * (1.0 + 1e-12), "{k} {found:?}");
            if found.hit == Hit::Sticks {
                assert!(drilling.abs() < 1e-14 && [u, v] == [0.0; 2], "{k} {drilling:e} {found:?}");
            } else {
                // The motion has the friction of its own slip and drilling.
                let [share, couple, _] = patch::rubs(u.hypot(v), drilling, radius);
                let off = [x + mu * n * share * u, y + mu * n * share * v, found.couple - mu * n * couple];
                assert!(off.into_iter().all(|x| x.abs() < 1e-9), "{k} {off:?} {found:?}");
            }
            hits[found.hit as usize] += 1;
        }
        assert!(hits[Hit::Sticks as usize] > 20 && hits[Hit::SlipsOn as usize] > 20, "{hits:?}");
    }

    /// The rows of a table of references, by the names of their columns.
    fn rows(text: &str) -> Vec<std::collections::HashMap<&str, &str>> {
        let mut lines = text.lines().map(|line| line.split(','));
        let names: Vec<&str> = lines.next().unwrap().collect();
        lines.map(|row| names.iter().copied().zip(row).collect()).collect()
    }

    /// A number in decimals, or an exact double in hexadecimals.
    fn number(text: &str) -> f64 {
        let (sign, digits) = text.strip_prefix('-').map_or((1.0, text), |digits| (-1.0, digits));
        let Some(digits) = digits.strip_prefix("0x") else { return text.parse().unwrap() };
        let (digits, power) = digits.split_once('p').unwrap();
        let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
        let mantissa = u64::from_str_radix(&format!("{whole}{part}"), 16).unwrap() as f64;
        sign * mantissa * 2f64.powi(power.parse::<i32>().unwrap() - 4 * part.len() as i32)
    }

    #[test]
    fn impacts_of_stones_at_a_point_and_on_a_patch_are_those_of_an_independent_model() {
        let tables = [
            include_str!("../../../tests/reference/stone_impacts.csv"),
            include_str!("../../../tests/reference/patch_impacts.csv"),
        ];
        let (mut worst, mut count) = (0f64, 0);
        for row in tables.into_iter().flat_map(rows) {
            let is = |name: &str| number(row[name]);
            let level = [[is("m11"), is("m12")], [is("m12"), is("m22")]];
            let light = Delassus { level, couples: [is("m13"), is("m23")], normal: is("m33") };
            let radius = row.get("patch").map(|x| number(x)).filter(|radius| *radius > 0.0);
            let patch = radius.map(|radius| PatchedPoint {
                radius,
                drilling: is("w"),
                row: [is("m14"), is("m24"), is("m34")],
                about: is("m44"),
            });
            let table = match *row.get("law").unwrap_or(&"coulomb") {
                "coulomb" => Friction::Coulomb {
                    mu: is("mu"),
                    fixed: row.get("static").map_or(is("mu"), |x| number(x)),
                    patch: radius.unwrap_or(0.0),
                }
                .into(),
                "viscous" => Friction::Viscous { c: is("mu") }.into(),
                "rolling" => Table::Rolling { mu: f64::INFINITY },
                _ => Table::Smooth,
            };
            let slip = [is("u1"), is("u2")];
            let impact = PointImpact {
                slip,
                lift: is("u3"),
                light,
                patch,
                law: ImpactLaw::Stronge,
                tol: 3e-14,
                longer: 1.0,
            };
            let found = impact.on(&table, is("e"), &()).unwrap();
            let [p, q, n] = found.impulse;
            let pairs = [
                (p, "p1"),
                (q, "p2"),
                (n, "p3"),
                (found.slip[0], "v1"),
                (found.slip[1], "v2"),
                (found.lift, "v3"),
                (found.lost, "lost"),
                (found.couple, "c"),
            ];
            let size = is("u3").abs().max(speed(slip)).max(1.0);
            for (value, name) in pairs {
                let off = (value - row.get(name).map_or(value, |x| number(x))).abs() / size;
                assert!(off < 1e-11, "{}, {name}: {off:e}", row["name"]);
                worst = worst.max(off);
            }
            count += 1;
        }
        assert!(count > 50 && worst < 1e-11, "{count} {worst:e}");
    }
}
