//! Impact of a rim on the table: the impulses at one point, and the share of the normal velocity that is restored.
//!
//! ```text
//! M = [[a_h, 0, b], [0, a_2, 0], [b, 0, a_n]]        change of the contact point's velocity (e_h, e2, z) per impulse
//! a_h = 1 + h^2/I1,  a_2 = 1 + L^2/I1 + A^2/I3,  a_n = 1 + g^2/I1,  b = h g/I1
//! w1' - w1 = L P_2/I1,   w2' - w2 = -(h P_h + g P_n)/I1,   w3' - w3 = -A P_2/I3
//! along the impact, p the normal impulse so far:   du/dp = M (-mu cos, -mu sin, 1),   u = sigma (cos, sin)
//! compression ends at u_n = 0 with the work W_c < 0 of the normal force, the impact ends where W = (1 - e^2) W_c
//! ```
//! Restitution is energetic (Stronge, Proc. R. Soc. A 431, 169 (1990)), so that no impact gains energy. It equals the
//! ratio of the normal velocities where the direction of the slip stays. Friction along the impact is Coulomb's (Routh
//! 1860; Keller, J. Appl. Mech. 53, 1 (1986)): where a slip stops, it sticks if |b| <= mu_s a_h, otherwise it slips on
//! along e_h. For every mu and every body the impact has one outcome. A slip jams if its friction presses the rim into
//! the table faster than the impulse slows it, so that no contact force exists (Painleve): an impact that begins with
//! u_n = 0 stops the slip (Genot and Brogliato, Eur. J. Mech. A 18, 653 (1999)). The motion is straight, and the
//! formulas are closed, except for a first slip whose direction turns; a viscous film is linear. Under a coefficient that
//! depends on the speed the same equations hold with the coefficient at the current speed, and steps follow them.
//!
//! Error: 1e-13 of the largest velocity; a test of `laws` compares with integration in the laboratory's axes.

use super::slip::Friction;
use super::table::Table;
use crate::laws::body::Shape;
use crate::laws::custom::SpeedLaw;
use crate::methods::flow::only_zero;
use crate::methods::rk8;
use crate::methods::search::crossing;
use crate::numbers::Dual;
use crate::numbers::codes::coded;

coded! {
    /// The motion of the contact point in an impact.
    pub enum Hit {
        /// It slips until the impact ends.
        Slips = 0,
        /// Its slip stops, and it sticks.
        Sticks = 1,
        /// Its slip stops, and friction cannot hold it.
        SlipsOn = 2,
        /// Without friction.
        Smooth = 3,
        /// Both rims land at once, or the other rim lands without a bounce; the impulse is the sum over both rims.
        BothRims = 4,
    }
}

/// The velocity of the lowest point of a rim before an impact, and the inverse of its inertia.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RimImpact {
    /// The slip along e_h and along e2, and the normal velocity, which is negative, or zero where a slip jams.
    pub slip: [f64; 2],
    pub lift: f64,
    /// a_h, a_2, a_n and b.
    pub light: [f64; 4],
    /// Tolerance of a step along an impact whose slip turns, at least 3e-14, and the factor by which the first step is
    /// longer.
    pub tol: f64,
    pub longer: f64,
}

/// The impulses P_h, P_2 and P_n, and the velocity of the lowest point after the impact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Struck {
    pub impulse: [f64; 3],
    pub slip: [f64; 2],
    pub lift: f64,
    pub hit: Hit,
    /// Energy lost, in M g R.
    pub lost: f64,
}

/// The inverse inertia a_h, a_2, a_n and b of the lowest point of a rim.
pub(crate) fn lightness(shape: &Shape<f64>, angle: (f64, f64)) -> [f64; 4] {
    let Shape { rim, i1, i3 } = shape;
    let (height, lever) = (rim.height(angle), rim.lever(angle));
    let (depth, radius) = (rim.depth(angle), rim.radius(angle));
    [
        1.0 + height * height / i1,
        1.0 + depth * depth / i1 + radius * radius / i3,
        1.0 + lever * lever / i1,
        height * lever / i1,
    ]
}

/// The angular velocity after these impulses.
pub(crate) fn turned(
    shape: &Shape<f64>,
    angle: (f64, f64),
    w: [f64; 3],
    [p_h, p_2, p_n]: [f64; 3],
) -> [f64; 3] {
    let Shape { rim, i1, i3 } = shape;
    [
        w[0] + rim.depth(angle) * p_2 / i1,
        w[1] - (rim.height(angle) * p_h + rim.lever(angle) * p_n) / i1,
        w[2] - rim.radius(angle) * p_2 / i3,
    ]
}

/// A slip slower than this share of the speed, or of the normal velocity, counts as zero.
const STOPPED: f64 = 1e-15;
/// Below this sine, a slip runs along the lean up to the square of the sine; and the lower limit where the sine grows
/// as the slip dies out.
const STRAIGHT: f64 = 1e-8;
const STRAIGHT_ON: f64 = 1e-14;
/// The error of a slip across the lean is at most this share of the slip, so that a slip that lasts long can die out; and
/// the share where that is less than the tolerance, below which no error counts.
const DIES: f64 = 1e-6;
const DYING: f64 = 1e-3;
/// The first step along an impact.
const FIRST: f64 = 0.3;
/// Largest number of steps along an impact.
const IMPACT_STEPS: usize = 5_000;

/// The impact so far, with all velocities in units of the first normal velocity, or of the slip where that is zero.
struct ImpactCourse {
    impulse: [f64; 3],
    lift: f64,
    work: f64,
    /// The work at the end of compression.
    compressed: Option<f64>,
    /// The restitution e, and 1 - e^2.
    e: f64,
    keeps: f64,
}

impl ImpactCourse {
    /// Continues in a constant direction, in which the normal velocity grows at the rate `k`, for at most the normal
    /// impulse `most`. Returns whether the impact ends.
    fn straight(&mut self, k: f64, [p_h, p_2]: [f64; 2], most: f64) -> bool {
        let (mut p, mut done) = (most, false);
        if self.compressed.is_none() {
            if k > 0.0 && -self.lift / k <= most {
                let compressed = self.work - self.lift * self.lift / (2.0 * k);
                self.compressed = Some(compressed);
                let end = (self.e * (-2.0 * k * compressed).sqrt() - self.lift) / k;
                (p, done) = (end.min(most), end <= most);
            }
        } else if let Some(compressed) = self.compressed {
            let left = self.keeps * compressed - self.work;
            let square = self.lift * self.lift + 2.0 * k * left;
            // Friction may press the body down again before the work is done.
            if square >= 0.0 || most == f64::INFINITY {
                let root = square.max(0.0).sqrt();
                let end =
                    if self.lift > 0.0 { 2.0 * left / (self.lift + root) } else { (root - self.lift) / k };
                (p, done) = (end.min(most), end <= most);
            }
        }
        self.work += p * (self.lift + 0.5 * k * p);
        self.lift += k * p;
        self.impulse = [self.impulse[0] + p_h * p, self.impulse[1] + p_2 * p, self.impulse[2] + p];
        done
    }
}

impl RimImpact {
    /// The impact under this law of contact with the restitution `e`. None for a rolling contact without a solution,
    /// whose friction would lift the body before the slip has stopped or would exceed mu times the normal impulse, and
    /// after too many steps.
    /// Along the impact the coefficient of `own` is that at the current speed.
    pub fn on(&self, table: &Table, e: f64, own: &impl SpeedLaw) -> Option<Struck> {
        let [a_h, a_2, a_n, b] = self.light;
        let big = if self.lift < 0.0 { -self.lift } else { self.slip[0].hypot(self.slip[1]) };
        let keeps = (1.0 - e) * (1.0 + e);
        let lift = self.lift / big;
        let mut course = ImpactCourse { impulse: [0.0; 3], lift, work: 0.0, compressed: None, e, keeps };
        let (slip, mut stopped) = (self.slip.map(|u| u / big), false);
        let hit = match *table {
            Table::Rolling { .. } => {
                // The slip is stopped before the normal impulse begins.
                (course.impulse[0], course.impulse[1]) = (-slip[0] / a_h, -slip[1] / a_2);
                course.lift += b * course.impulse[0];
                if course.lift >= 0.0 {
                    return None;
                }
                stopped = true;
                Hit::Sticks
            }
            Table::Rubs(Friction::Viscous { c }) if c > 0.0 => {
                course.film(c * big, slip, self.light);
                Hit::Slips
            }
            Table::Rubs(friction @ Friction::Coulomb { mu, fixed, .. })
                if mu > 0.0 || friction.sticks() || own.varies() =>
            {
                let law = |speed: f64| own.coefficient_at(speed * big);
                stopped = if own.varies() {
                    !self.slides_under(&mut course, slip, &law)?
                } else {
                    !self.slides(&mut course, mu, slip)?
                };
                if !stopped {
                    Hit::Slips
                } else if b.abs() <= fixed * a_h {
                    Hit::Sticks
                } else if own.varies() {
                    self.slips_on_under(&mut course, &law)?;
                    Hit::SlipsOn
                } else {
                    course.straight(a_n - mu * b.abs(), [-mu * b.signum(), 0.0], f64::INFINITY);
                    Hit::SlipsOn
                }
            }
            _ => {
                course.straight(a_n, [0.0; 2], f64::INFINITY);
                Hit::Smooth
            }
        };
        if hit == Hit::Sticks {
            course.straight(a_n - b * b / a_h, [-b / a_h, 0.0], f64::INFINITY);
        }
        let [p_h, p_2, p_n] = course.impulse.map(|p| p * big);
        let lift = if e > 0.0 { course.lift * big } else { 0.0 };
        let [along, across] = [self.slip[0] + a_h * p_h + b * p_n, self.slip[1] + a_2 * p_2];
        // A slip that has stopped has no direction left but that of the lean.
        let slip = match hit {
            Hit::Sticks => [0.0; 2],
            _ if stopped => [along, 0.0],
            _ => [along, across],
        };
        if let Table::Rolling { mu } = *table
            && p_h.hypot(p_2) > mu * p_n
        {
            return None;
        }
        let lost = -0.5
            * ((self.slip[0] + slip[0]) * p_h + (self.slip[1] + slip[1]) * p_2 + (self.lift + lift) * p_n);
        Some(Struck { impulse: [p_h, p_2, p_n], slip, lift, hit, lost })
    }

    /// The first slip under Coulomb's friction. Returns whether the impact ends before the slip stops, or
    /// None after too many steps.
    fn slides(&self, course: &mut ImpactCourse, mu: f64, slip: [f64; 2]) -> Option<bool> {
        let [a_h, a_2, a_n, b] = self.light;
        let (speed, turns) = (slip[0].hypot(slip[1]), mu * (a_2 - a_h));
        if speed <= STOPPED * (1.0 + speed) || mu == 0.0 {
            return Some(false);
        }
        let slows = |[cos, sin]: [f64; 2]| b * cos - mu * (a_h * cos * cos + a_2 * sin * sin);
        let straight = |course: &mut ImpactCourse, way: [f64; 2], speed: f64| {
            let slow = slows(way);
            let most = if slow < 0.0 { -speed / slow } else { f64::INFINITY };
            course.straight(a_n - mu * b * way[0], way.map(|x| -mu * x), most)
        };
        // Along the lean, or where the contact is isotropic, the direction of the slip stays.
        if slip[1] == 0.0 || b.abs() + turns.abs() < STOPPED {
            return Some(straight(course, slip.map(|u| u / speed), speed));
        }
        // u_h, u_2, P_h, P_2, p, u_n and W, with dp = sigma/(1 + sigma) dx, in which nothing is singular.
        let rates = |&[u_h, u_2, _, _, _, lift, _]: &[f64; 7], to: &mut [f64; 7]| {
            let sigma = (u_h * u_h + u_2 * u_2).sqrt();
            let (per, pull) = (1.0 / (1.0 + sigma), mu * u_h);
            let change = [
                b * sigma - a_h * pull,
                -(mu * a_2 * u_2),
                -pull,
                -(mu * u_2),
                sigma,
                a_n * sigma - b * pull,
                lift * sigma,
            ];
            *to = change.map(|x| per * x);
        };
        let place = [slip[0], slip[1], 0.0, 0.0, 0.0, course.lift, 0.0];
        let over = |place: &[f64; 7]| {
            let sigma = place[0].hypot(place[1]);
            let grows = turns < -b * place[0].signum();
            // A slip along the lean may last long.
            sigma < STOPPED || place[1].abs() < (if grows { STRAIGHT_ON } else { STRAIGHT }) * sigma
        };
        let (place, done) = self.follows(course, place, rates, over, 0.0)?;
        let [u_h, u_2, _, _, p, ..] = place;
        let sigma = u_h.hypot(u_2);
        if done || sigma < STOPPED {
            return Some(done);
        }
        let way = [u_h.signum(), 0.0];
        let ended = straight(course, way, sigma);
        // The remaining slip across the lean falls as a power of the slip.
        let (slow, long) = (-slows(way), (course.impulse[2] - p) / sigma);
        let log = if slow * long == 0.0 { -long } else { (-slow * long).max(-1.0).ln_1p() / slow };
        course.impulse[1] += u_2 * (mu * a_2 * log).exp_m1() / a_2;
        Some(ended)
    }

    /// Follows an impact by steps from `place`, the numbers u_h, u_2, P_h, P_2, p, u_n and W, until it ends or is `over`.
    /// Returns the numbers there, and whether the impact ends; None after too many steps. The error of a slip is relative
    /// to its speed, or to `slow` if that is more.
    #[inline(always)]
    fn follows(
        &self,
        course: &mut ImpactCourse,
        mut place: [f64; 7],
        rates: impl Fn(&[f64; 7], &mut [f64; 7]) + Copy,
        over: impl Fn(&[f64; 7]) -> bool,
        slow: f64,
    ) -> Option<([f64; 7], bool)> {
        let (mut stages, mut h) = ([place; rk8::STAGES], FIRST * self.longer);
        let (mut steps, keeps) = (0, course.keeps);
        let done = loop {
            if over(&place) {
                break false;
            }
            let sigma = place[0].hypot(place[1]).max(slow);
            steps += 1;
            if steps > IMPACT_STEPS {
                return None;
            }
            let mut rate = place;
            rates(&place, &mut rate);
            let mut part = |h: f64| {
                let made = rk8::step::<{ rk8::LOOPS }, _, _>(rates, &place, &rate, h, &mut stages);
                (core::array::from_fn::<f64, 7, _>(|i| place[i] + made.change[i]), made)
            };
            let (there, made) = part(h);
            // The error is relative to a fast slip, and so small for a slow slip that its direction stays.
            let per_slip =
                if sigma > 1.0 { 1.0 / (self.tol * sigma) } else { (1.0 / self.tol).max(1e3 / sigma) };
            // A jam makes impulses that are large compared with the fall.
            let per = |i: usize| match i {
                0 => per_slip,
                1 if place[1].abs() > STRAIGHT_ON * sigma => {
                    per_slip.max(1.0 / (DIES * place[1].abs()).max(self.tol.min(DYING * place[1].abs())))
                }
                1 => per_slip,
                _ => 1.0 / (self.tol * place[i].abs().max(1.0)),
            };
            let error = made.error(per, 7.0);
            if error.is_nan() || error > 1.0 {
                h *= rk8::growth(error).min(0.7);
                continue;
            }
            // The margin falls through zero where compression or the impact ends.
            let margin = |v: &[f64; 7], compressed: Option<f64>| match compressed {
                None => -v[5],
                Some(work) => keeps * work - v[6],
            };
            let slope = |rate: &[f64; 7], compressed: Option<f64>| {
                if compressed.is_none() { -rate[5] } else { -rate[6] }
            };
            let (mut end, mut compressed) = (None, course.compressed);
            let (mut from, mut first, mut last) = (0.0, (place, rate), rate);
            if margin(&there, compressed) <= 0.0 {
                rates(&there, &mut last);
            }
            while end.is_none() && margin(&there, compressed) <= 0.0 {
                let (now, wide) = (compressed, h - from);
                // The last point of the search, with the state and its rates.
                let (mut looked, mut at, mut fast) = (1.0, there, last);
                let mut on = |x: f64| {
                    (looked, at) = (x, part(from + x * wide).0);
                    rates(&at, &mut fast);
                    Dual { value: margin(&at, now), slope: wide * slope(&fast, now) }
                };
                let (begin, stop) = (margin(&first.0, now).max(f64::MIN_POSITIVE), margin(&there, now));
                let known = [begin, wide * slope(&first.1, now), stop, wide * slope(&last, now)];
                let x = only_zero(&mut on, known)
                    .unwrap_or_else(|| crossing(|x| on(x).value, 0.0, 1.0, begin, stop));
                // The last move of the search is short enough for a linear step.
                let at = core::array::from_fn(|i| at[i] + wide * (x - looked) * fast[i]);
                rates(&at, &mut fast);
                (from, first) = (from + x * wide, (at, fast));
                match now {
                    None => compressed = Some(at[6]),
                    Some(_) => end = Some(at),
                }
                if keeps == 1.0 {
                    end = Some(at);
                }
            }
            course.compressed = compressed;
            place = end.unwrap_or(there);
            if end.is_some() {
                break true;
            }
            h *= rk8::growth(error);
        };
        let [_, _, p_h, p_2, p, lift, work] = place;
        course.impulse = [p_h, p_2, p];
        (course.lift, course.work) = (lift, work);
        Some((place, done))
    }

    /// The first slip under a coefficient that depends on its speed. Returns whether the impact ends before the slip stops,
    /// or None after too many steps.
    fn slides_under(
        &self,
        course: &mut ImpactCourse,
        slip: [f64; 2],
        law: &dyn Fn(f64) -> f64,
    ) -> Option<bool> {
        let [a_h, a_2, a_n, b] = self.light;
        let speed = slip[0].hypot(slip[1]);
        if speed <= STOPPED * (1.0 + speed) {
            return Some(false);
        }
        // With dp = sigma/(sigma + mu) dx, in which nothing is singular, also where mu vanishes with the speed.
        let rates = |&[u_h, u_2, _, _, _, lift, _]: &[f64; 7], to: &mut [f64; 7]| {
            let sigma = u_h.hypot(u_2).max(f64::MIN_POSITIVE);
            let mu = law(sigma);
            let (per, along, across) = (1.0 / (sigma + mu), mu * u_h, mu * u_2);
            let change = [
                b * sigma - a_h * along,
                -(a_2 * across),
                -along,
                -across,
                sigma,
                a_n * sigma - b * along,
                lift * sigma,
            ];
            *to = change.map(|x| per * x);
        };
        let place = [slip[0], slip[1], 0.0, 0.0, 0.0, course.lift, 0.0];
        let over = |place: &[f64; 7]| place[0].hypot(place[1]) < STOPPED;
        self.follows(course, place, rates, over, 0.0).map(|(_, done)| done)
    }

    /// The slip along the lean that begins where friction cannot hold the contact point, to the end of the impact. None
    /// after too many steps.
    fn slips_on_under(&self, course: &mut ImpactCourse, law: &dyn Fn(f64) -> f64) -> Option<()> {
        let [a_h, _, a_n, b] = self.light;
        let way = b.signum();
        let rates = |&[u_h, _, _, _, _, lift, _]: &[f64; 7], to: &mut [f64; 7]| {
            let drag = way * law((way * u_h).max(0.0));
            *to = [b - a_h * drag, 0.0, -drag, 0.0, 1.0, a_n - b * drag, lift];
        };
        let [p_h, p_2, p] = course.impulse;
        let place = [0.0, 0.0, p_h, p_2, p, course.lift, course.work];
        self.follows(course, place, rates, |_| false, 1.0).map(|_| ())
    }
}

impl ImpactCourse {
    /// The whole impact on a viscous film, whose force is c u times the normal force.
    fn film(&mut self, c: f64, [u_h, u_2]: [f64; 2], [a_h, a_2, a_n, b]: [f64; 4]) {
        let decay = |x: f64| -(-x).exp_m1();
        // The integrals of exp(-c a_h p) over p, once and twice.
        let once = |p: f64| decay(c * a_h * p) / (c * a_h);
        let twice = |p: f64| {
            let x = c * a_h * p;
            if x > 0.1 {
                return (p - once(p)) / (c * a_h);
            }
            p * p
                * (0.5
                    - x * (1.0 / 6.0
                        - x * (1.0 / 24.0
                            - x * (1.0 / 120.0 - x * (1.0 / 720.0 - x * (1.0 / 5040.0 - x / 40320.0))))))
        };
        let (first, pulls, sticking) = (self.lift, c * b * u_h, b * b / a_h);
        let lift = |p: f64| first + a_n * p - pulls * once(p) - sticking * (p - once(p));
        let work =
            |p: f64| first * p + 0.5 * a_n * p * p - pulls * twice(p) - sticking * (0.5 * p * p - twice(p));
        let rises = |f: &dyn Fn(f64) -> f64, from: f64| {
            let mut far = from.max(1.0);
            while f(far) < 0.0 {
                far *= 2.0;
            }
            crossing(f, from, far, f(from).min(-f64::MIN_POSITIVE), f(far))
        };
        // A slip that jams presses the rim down first, until its film has slowed it.
        let lowest = ((pulls - sticking) / (a_n - sticking)).max(1.0).ln() / (c * a_h);
        let middle = rises(&lift, lowest);
        let target = self.keeps * work(middle);
        let p = if self.keeps == 1.0 { middle } else { rises(&|p| work(p) - target, middle) };
        let along = u_h * once(p) + b / (c * a_h) * (p - once(p));
        self.impulse = [-c * along, -(u_2 * decay(c * a_2 * p) / a_2), p];
        (self.lift, self.work) = (lift(p), work(p));
    }
}
