//! The friction of a face on which a body stands, slides and spins.
//!
//! ```text
//! lam = mu Z/a,   s = a |w|,   F = -mu N G,   couple = -mu a N gg,   X = -Z F/(a N) = lam G,   |X| <= 1
//! G = <u/|u|>,   gg = <n x u/|u|>   over the pressure p, whose centre is at X a ahead of the axis
//! viscous   F = -c v/(1 - i c Z w),   couple = -c w (a^2 - Z^2 |F|^2)      v along the real axis
//! end ratio   v/s = k at which a slide ends:   G_x = k gg/i3,   G_x > k gg/i3 above
//! ```
//! The moment of friction about the centre of mass tilts the pressure, and the tilt changes friction: two equations for
//! X. The pressure is that of a stiff, damped elastic bed: linear in the place, and zero where that is negative. While
//! the whole face presses, X is in closed form; otherwise Newton's method finds the width and the direction of the
//! pressed part. For lam > 1 the body topples above a limit of v/s, a fold of the solutions, which is computed once for
//! each face.
//!
//! Error: see [`ring`] and [`disc`]; compared with quadrature of 30 digits (`face_means.csv`).

mod disc;
mod part;
mod ring;

use crate::methods::search::crossing;
use crate::numbers::codes::coded;
use part::{PressedFace, PressedPart};
use ring::WholeMeans;

coded! {
    /// The model of the pressure of the table on a face, since the pressure on a rigid face is not determined.
    #[derive(Default)]
    pub enum Face {
        /// The face presses on its rim alone, as below a tube, a can or a coin: the default.
        #[default]
        Ring = 0,
        /// The whole face presses, as below a puck or a lapped end.
        Disc = 1,
    }
}

/// Friction over mu N, and its couple over mu a N, on a face that spins counterclockwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FaceForce {
    /// The force `along` the velocity, and the force `across`, to the left of it.
    pub along: f64,
    pub across: f64,
    pub couple: f64,
    /// The centre of the pressure relative to the axis, over a: along the velocity, and to the left of it.
    pub centre: [f64; 2],
}

/// The friction of a face under Coulomb's law, with lam = mu Z/a.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FaceFriction {
    form: Face,
    lam: f64,
    fold: f64,
    /// The part of a disc that presses where slide and spin are nearly as fast as each other, for lam > 1.
    near: Option<PressedPart>,
}

impl FaceForce {
    fn of(part: &PressedPart, found: &PressedFace) -> Self {
        let turned = [part.off.sin(), part.angle.sin()];
        let [along, across] = turned.map(|x| found.force * x);
        let centre = turned.map(|x| found.centre * x);
        Self { along, across, couple: found.couple, centre }
    }

    /// The friction of a pressure at a single point of the rim, where the slip is outward; q = s/v.
    fn at_a_point(q: f64, lam: f64) -> Self {
        let [along, across] = [((1.0 - q) * (1.0 + q)).sqrt(), q];
        let centre = [lam * along, lam * across];
        Self { along, across, couple: 0.0, centre }
    }
}

/// A pressed part whose friction is along X, and the lam for which this part is a solution.
#[derive(Debug, Clone, Copy)]
struct OnCurve {
    part: PressedPart,
    lam: f64,
    determinant: f64,
}

/// Most steps of Newton's method, which double the digits; and the relative size below which a step is the last one.
const STEPS_TO_PART: usize = 60;
const LAST_STEP: f64 = 1e-8;
/// The ratios v/s between which the ratio at the end of a slide is sought.
const SLOW_END: f64 = 1e-5;
const FAST_END: f64 = 1e6;
/// Below this lam there is only one centre of the pressure for each ratio v/s.
const UNIQUE_BELOW: f64 = 0.97;
/// Largest distance, over a, that the centre of the pressure moves in a step along one branch of solutions.
const SAME_BRANCH: f64 = 0.02;
/// The largest sqrt(v/s - 1) at a fold, and the relative accuracy of its place; lam there is accurate to the square of that.
const WIDEST_FOLD: f64 = 0.37;
const FOLD_STEP: f64 = 1e-7;
/// In the search for a pressed part: the least turn of its direction, the ratio of successive widths, and the least width.
const TURN: f64 = 1e-12;
const NARROWER: f64 = 0.5;
const NARROWEST: f64 = 1e-9;
/// 1 - v/s of the part from which the search goes to the point to which a pressed part shrinks, and the ratio of
/// successive values.
const NEAR_POINT: f64 = 1e-3;
const NEARER: f64 = 0.1;
/// A slide with lam = 1 and v/s beyond this presses at a point.
const A_POINT_BEYOND: f64 = 1.2;
/// A pressed part of less than this width is a point.
const POINT: f64 = 1e-24;

impl FaceFriction {
    /// The friction of a face of radius a whose centre of mass is lam a/mu above it.
    pub fn new(form: Face, lam: f64) -> Self {
        let mut friction = Self { form, lam, fold: f64::INFINITY, near: None };
        if lam > 1.0 {
            friction.fold = friction.highest_ratio();
            if friction.fold == 1.0 && form == Face::Disc {
                let whole = PressedPart::towards(1.0, [1.0, 0.7]);
                friction.near = friction.first_part(whole, 1.0 - NEAR_POINT, 1.0).map(|(part, _)| part);
            }
        }
        friction
    }

    /// The ratio of the speed `v` of the centre to the speed `s` of the rim above which the body topples.
    pub fn fold(&self) -> f64 {
        self.fold
    }

    /// The force at the speed `v` of the centre and the speed `s` of the rim; None where the body topples. Where there
    /// are several centres of the pressure, the force of the one next to `last`, or without `last` of the one nearest
    /// to the axis.
    pub fn at(&self, v: f64, s: f64, last: Option<[f64; 2]>) -> Option<FaceForce> {
        let lam = self.lam;
        if s == 0.0 {
            let force = FaceForce { along: 1.0, across: 0.0, couple: 0.0, centre: [lam, 0.0] };
            return (lam <= 1.0).then_some(force);
        }
        let (whole, slope) = match self.form {
            Face::Ring => (WholeMeans::of_ring(v, s), 2.0),
            Face::Disc => (disc::whole(v, s), 4.0),
        };
        let [along, across, couple] = whole.pressed(lam, slope);
        let centre = [lam * along, lam * across];
        if slope * centre[0].hypot(centre[1]) <= 1.0 {
            return Some(FaceForce { along, across, couple, centre });
        }
        if v >= self.fold * s {
            return None;
        }
        if lam == 1.0 && v > A_POINT_BEYOND * s {
            return Some(FaceForce::at_a_point(s / v, lam));
        }
        if let Some(found) = self.near_point(v, s) {
            return Some(found);
        }
        let whole = PressedPart::towards(1.0, centre);
        let first = || self.first_part(whole, v, s).map(|(part, found)| FaceForce::of(&part, &found));
        let found = match last.filter(|x| slope * x[0].hypot(x[1]) > 1.0) {
            None => first(),
            Some(x) => {
                let apart = |of: &FaceForce| (of.centre[0] - x[0]).hypot(of.centre[1] - x[1]);
                let near = PressedPart::towards(self.width_of(x[0].hypot(x[1])), x);
                let near = self.solved(near, v, s).map(|(part, found)| FaceForce::of(&part, &found));
                match near {
                    Some(near) if lam < UNIQUE_BELOW || apart(&near) < SAME_BRANCH => Some(near),
                    _ => near.into_iter().chain(first()).min_by(|a, b| apart(a).total_cmp(&apart(b))),
                }
            }
        };
        // A slide with lam = 1 presses a point, where the slip is outward.
        found.or_else(|| (lam <= 1.0 && s <= v).then(|| FaceForce::at_a_point(s / v, lam)))
    }

    /// Whether the part of a disc that presses shrinks to a point as v/s approaches 1.
    pub fn shrinks(&self) -> bool {
        self.near.is_some()
    }

    /// The part that presses, by a search from the whole face, or else from ever narrower parts.
    fn first_part(&self, whole: PressedPart, v: f64, s: f64) -> Option<(PressedPart, PressedFace)> {
        self.solved(whole, v, s).or_else(|| self.narrowed(v, s))
    }

    /// The force near v/s = 1, where the part that presses shrinks to a point: its width is in proportion to 1 - v/s,
    /// and the angle from its direction to the side goes as the root of 1 - v/s.
    fn near_point(&self, v: f64, s: f64) -> Option<FaceForce> {
        let (mut part, short) = (self.near?, (s - v) / s);
        let mut at = NEAR_POINT;
        while at > short && short > 0.0 {
            let share = (short / at).max(NEARER);
            at = if share > NEARER { short } else { at * share };
            let off = part.off * share.sqrt();
            let from = PressedPart { width: part.width * share, angle: part.angle + part.off - off, off };
            let (next, found) = self.solved(from, s * (1.0 - at), s)?;
            if at == short {
                return Some(FaceForce::of(&next, &found));
            }
            part = next;
        }
        None
    }

    /// The width, approximately, of the part whose centre of pressure is at this distance from the axis, over a.
    fn width_of(&self, centre: f64) -> f64 {
        let short = 1.0 - centre;
        let (first, last) = match self.form {
            Face::Ring => (2.5, 1.0),
            Face::Disc => (1.75, 5.0 / 9.0),
        };
        (short * (first - last * short)).clamp(1e-18, 1.0)
    }

    /// The part that presses, by Newton's method from a nearby part; None if the method fails.
    fn solved(&self, mut arc: PressedPart, v: f64, s: f64) -> Option<(PressedPart, PressedFace)> {
        let mut close = false;
        for _ in 0..STEPS_TO_PART {
            let here = self.pressed(&arc, v, s);
            let det = here.determinant();
            if close {
                return (det < 0.0).then_some((arc, here));
            }
            if arc.width < POINT {
                return Some((arc, here));
            }
            let [r, q] = here.residual;
            let width = (here.by_angle[0] * q - here.by_angle[1] * r) / det;
            let angle = (here.by_width[1] * r - here.by_width[0] * q) / det;
            if !(width.is_finite() && angle.is_finite()) {
                return None;
            }
            // The next step would be below rounding, since each relative step is the square of the one before.
            close = width.abs() <= LAST_STEP * arc.width
                && angle.abs() <= LAST_STEP * arc.angle.min(arc.off).abs();
            let bounded = (arc.width + width).max(0.2 * arc.width).min(1.0) - arc.width;
            arc = arc.moved(bounded, angle.clamp(-0.3, 0.3));
        }
        None
    }

    /// The part that presses, by Newton's method from the first of ever narrower parts that belongs to a larger lam
    /// than this face's. A negative lam lies beyond infinity.
    fn narrowed(&self, v: f64, s: f64) -> Option<(PressedPart, PressedFace)> {
        let mut wide = self.on_curve(PressedPart::towards(1.0, [1.0, 0.7]), v, s);
        let mut step = 0.2;
        while wide.part.width > NARROWEST && step > TURN * wide.part.width {
            let next = self.on_curve(wide.part.moved(-step, 0.0), v, s);
            if next.lam > 0.0 && next.lam < self.lam {
                wide = next;
                step = step.min(0.2 * wide.part.width);
                continue;
            }
            if next.lam > 0.0
                && next.determinant < 0.0
                && let Some(found) = self.solved(next.part, v, s)
            {
                return Some(found);
            }
            step *= 0.5;
        }
        None
    }

    /// The direction of a part of this width whose friction is along X, and the lam for which this part is a solution.
    fn on_curve(&self, part: PressedPart, v: f64, s: f64) -> OnCurve {
        let mut found = OnCurve { part, lam: 1.0, determinant: 0.0 };
        for _ in 0..STEPS_TO_PART {
            let here = Self { lam: found.lam, ..*self }.pressed(&found.part, v, s);
            found.lam = here.centre / here.force;
            found.determinant = here.determinant();
            let turn = here.residual[1] / here.by_angle[1];
            found.part = found.part.moved(0.0, -turn.clamp(-0.2, 0.2));
            if turn.abs() < TURN.max(1e-14 / part.width) {
                break;
            }
        }
        found
    }

    fn pressed(&self, arc: &PressedPart, v: f64, s: f64) -> PressedFace {
        match self.form {
            Face::Ring => ring::on_ring(arc, self.lam, v, s),
            Face::Disc => disc::on_disc(arc, self.lam, v, s),
        }
    }

    /// The fold, above which the body topples: the ratio v/s at which lam of this face is the largest lam of all
    /// pressed parts. That largest lam is a smooth function of sqrt(v/s - 1).
    fn highest_ratio(&self) -> f64 {
        let miss = |y: f64| self.largest_lam(1.0 + y * y) - self.lam;
        let near = miss(0.0);
        if near <= 0.0 {
            return 1.0;
        }
        // At larger ratios lam = 1 belongs to pressure at a point.
        let y = crossing(miss, 0.0, WIDEST_FOLD, near, 1.0 - self.lam);
        1.0 + y * y
    }

    /// The largest lam for which the ratio v/s = `k` has a centre of the pressure. At a given width the direction of X
    /// follows from the force across X, and lam from the force along X.
    fn largest_lam(&self, k: f64) -> f64 {
        let mut part = PressedPart::towards(1.0, [1.0, 0.7]);
        let mut on_curve = |width: f64| {
            part.width = width;
            let found = self.on_curve(part, k, 1.0);
            part = found.part;
            (found.lam, found.determinant)
        };
        // Narrower parts, until lam falls.
        let (mut width, mut wide) = (1.0, on_curve(1.0));
        let mut narrow = on_curve(NARROWER);
        while narrow.1 < 0.0 {
            (width, wide) = (NARROWER * width, narrow);
            narrow = on_curve(NARROWER * width);
            if width < NARROWEST {
                return 1.0;
            }
        }
        // Regula falsi, as in `crossing`, but only to the accuracy whose square lam needs.
        let (mut a, mut b, mut at_a, mut at_b) = (width, NARROWER * width, wide.1, narrow.1);
        let mut best = narrow;
        while (a - b).abs() > FOLD_STEP * b {
            let next = b - at_b * ((b - a) / (at_b - at_a));
            best = on_curve(next);
            if (best.1 < 0.0) == (at_b < 0.0) {
                at_a *= 0.5;
            } else {
                (a, at_a) = (b, at_b);
            }
            let moved = (next - b).abs();
            (b, at_b) = (next, best.1);
            if moved <= FOLD_STEP * b {
                break;
            }
        }
        best.0
    }
}

/// The friction of a viscous film below a ring, F = -c u over its length, for the speed `v` of the centre and the rate
/// `w` of a body of radius `a` whose centre of mass is `height` above the face: minus the force and minus its couple.
/// The body topples where the centre of the pressure is outside of the ring.
pub(crate) fn viscous(c: f64, [a, height]: [f64; 2], v: f64, w: f64) -> FaceForce {
    let tilt = c * height * w;
    let along = c * v / (1.0 + tilt * tilt);
    let across = along * tilt;
    let lever = height * along.hypot(across);
    FaceForce {
        along,
        across,
        couple: c * w * (a - lever) * (a + lever),
        centre: [height * along / a, height * across / a],
    }
}

/// The ratio of the speed of the centre to the speed a |w| of the rim with which a body comes to rest that slides and
/// spins on its face; 0 or infinity if one speed vanishes faster than the other. None if the body topples before it
/// comes to rest. `lam` is the coefficient of friction times the height of the centre of mass over the radius of the
/// face, `i3` the axial moment of inertia over M times the square of this radius. Error: 1e-12.
///
/// ```
/// use spincyl::contact::{Face, end_ratio};
///
/// let puck = end_ratio(Face::Disc, 0.0, 0.5).unwrap();
/// assert!((puck - 0.653002).abs() < 1e-6); // the number of Farkas and others, Phys. Rev. Lett. 90, 248302 (2003)
/// assert_eq!(end_ratio(Face::Ring, 2.0, 0.5), None);
/// ```
pub fn end_ratio(form: Face, lam: f64, i3: f64) -> Option<f64> {
    let friction = FaceFriction::new(form, lam);
    // The growth of the ratio, divided by the speed of the centre where that is small.
    let mut last = None;
    let mut growth = |k: f64| {
        let force = friction.at(k.min(1.0), if k > 1.0 { 1.0 / k } else { 1.0 }, last)?;
        last = Some(force.centre);
        Some(k * force.couple / i3 - force.along)
    };
    let mut k = SLOW_END;
    let mut before = growth(k)?;
    if before <= 0.0 {
        return Some(0.0);
    }
    while k < FAST_END {
        let next = 1.1 * k;
        let Some(after) = growth(next) else {
            // Up to the fold.
            let fold = friction.fold() * (1.0 - 1e-12);
            let after = growth(fold).filter(|x| *x < 0.0)?;
            return Some(crossing(|k| growth(k).unwrap_or(f64::NAN), k, fold, before, after));
        };
        if after <= 0.0 {
            return Some(crossing(|k| growth(k).unwrap_or(f64::NAN), k, next, before, after));
        }
        (k, before) = (next, after);
    }
    Some(f64::INFINITY)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::FRAC_PI_2;
    use part::PressedFace;

    const FORMS: [Face; 2] = [Face::Ring, Face::Disc];

    /// Numbers in [0, 1) that look random.
    fn drawn(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    fn friction_of(form: Face, lam: f64) -> FaceFriction {
        FaceFriction { form, lam, fold: f64::INFINITY, near: None }
    }

    /// Means of G and gg in the frame of X, and |X|, for a part with this width and direction.
    fn means(form: Face, k: f64, width: f64, angle: f64) -> [f64; 4] {
        let (v, s) = (k, 1.0);
        if width < 1.5 {
            let part = PressedPart { width, angle, off: FRAC_PI_2 - angle };
            let of: PressedFace = friction_of(form, 1.0).pressed(&part, v, s);
            // The couple is told for a part that is its own X: without the mean of sin d.
            let aside = -of.residual[1];
            return [of.centre, of.force, aside, of.couple + aside];
        }
        let (centre, slope, of) = match form {
            Face::Ring => (0.5 / width, 2.0, WholeMeans::of_ring(v, s)),
            Face::Disc => (0.25 / (width - 0.5), 4.0, disc::whole(v, s)),
        };
        let [x, y] = [angle.cos(), angle.sin()].map(|n| slope * centre * n);
        let [along, across] = [of.along + y * of.y_along, x * of.x_across];
        let turned = [along * angle.cos() + across * angle.sin(), across * angle.cos() - along * angle.sin()];
        [centre, turned[0], turned[1], of.couple + y * of.y_couple]
    }

    #[test]
    fn means_over_every_part_are_those_of_thirty_digits() {
        let table = include_str!("../../../../tests/reference/face_means.csv");
        let mut worst = [[0f64; 2]; 2];
        for line in table.lines().skip(1) {
            let cells: Vec<&str> = line.split(',').collect();
            let form = if cells[0] == "ring" { Face::Ring } else { Face::Disc };
            let [k, width, angle] = [1, 2, 3].map(|i| hexadecimal(cells[i]));
            let found = means(form, k, width, angle);
            for (i, found) in found.into_iter().enumerate() {
                let known: f64 = cells[4 + i].parse().unwrap();
                let error = (found - known).abs();
                let most = &mut worst[form as usize][usize::from(width < 1.5)];
                *most = most.max(error);
            }
        }
        let [[whole_ring, arc], [whole_disc, segment]] = worst;
        assert!(whole_ring < 2e-15 && whole_disc < 2e-14, "{whole_ring:e} {whole_disc:e}");
        assert!(arc < 1e-13 && segment < 1e-12, "{arc:e} {segment:e}");
    }

    /// A double of the form -0x1.8p+3.
    fn hexadecimal(text: &str) -> f64 {
        let (digits, power) = text.trim_start_matches("0x").split_once('p').unwrap();
        let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
        let value = u64::from_str_radix(&format!("{whole}{part}"), 16).unwrap() as f64;
        value * 2f64.powi(power.parse::<i32>().unwrap() - 4 * part.len() as i32)
    }

    #[test]
    fn the_centre_of_the_pressure_is_where_the_moment_of_friction_puts_it() {
        let mut r = drawn(3);
        for form in FORMS {
            let mut worst = 0f64;
            for i in 0..1000 {
                let lam = if i % 4 == 0 { 1.0 + 3.0 * r() * r() } else { 1.2 * r() };
                let friction = friction_of(form, lam);
                let k = if lam > 1.0 { r() } else { 10f64.powf(6.0 * r() - 3.0) };
                let Some(force) = friction.at(k, 1.0, None) else { panic!("{form:?} {lam} {k}") };
                let x = force.centre;
                let off = (x[0] - lam * force.along).hypot(x[1] - lam * force.across);
                worst = worst.max(off);
                assert!(x[0].hypot(x[1]) <= 1.0 && force.couple > 0.0, "{form:?} {lam} {k}: {force:?}");
                // The same from the last place, and from one near.
                let near = x.map(|x| x * (1.0 + 1e-3 * r()));
                let again = friction.at(k, 1.0, Some(near)).unwrap();
                assert!((again.along - force.along).abs() < 1e-12, "{form:?} {lam} {k} {again:?} {force:?}");
            }
            assert!(worst < 1e-13, "{worst:e}");
        }
    }

    /// The variance of the place along X over an arc whose centre of pressure is at lam, by a search and sums over t.
    fn spread_of_arc(lam: f64) -> f64 {
        let moments = |b: f64| {
            let mut sums = [0.0; 3];
            for i in 0..20_000 {
                let t = b * (f64::from(i) + 0.5) / 20_000.0;
                let p = ((0.5 * b).sin() - (0.5 * t).sin()) * ((0.5 * b).sin() + (0.5 * t).sin());
                let short = 2.0 * (0.5 * t).sin().powi(2);
                for (i, sum) in sums.iter_mut().enumerate() {
                    *sum += p * short.powi(i as i32);
                }
            }
            [sums[1] / sums[0], sums[2] / sums[0]]
        };
        let miss = |b: f64| moments(b)[0] - (1.0 - lam);
        let b = crossing(miss, 1e-3, 3.1, miss(1e-3), miss(3.1));
        let [mean, square] = moments(b);
        square - mean * mean
    }

    #[test]
    fn slow_slides_and_slow_spins_keep_their_digits() {
        for power in [1, 3, 10, 100, 300] {
            let small = 10f64.powi(-power);
            let near = |x: f64, y: f64| (x / y - 1.0).abs() < 1e-14 + small;
            for lam in [0.1, 0.3, 0.7, 0.95, 1.0, 3.0] {
                let ring = friction_of(Face::Ring, lam).at(small, 1.0, None).unwrap();
                let [x, y] = [ring.along, ring.across].map(|g| 2.0 * g / small * (1.0 + lam * lam));
                assert!(near(x, 1.0) && near(y, lam) && near(ring.couple, 1.0), "{lam} {small:e}");
                let disc = friction_of(Face::Disc, lam).at(small, 1.0, None).unwrap();
                let pull = 4.0 / 3.0 * lam;
                let [x, y] = [disc.along, disc.across].map(|g| g / small * (1.0 + pull * pull));
                assert!(near(x, 1.0) && near(y, pull) && near(disc.couple, 2.0 / 3.0), "{lam} {small:e}");
            }
            for lam in [0.1, 0.3, 0.7, 0.95, 0.9999] {
                // The couple is the variance of the place along v, and the force across lam, of the slow spin.
                let ring = friction_of(Face::Ring, lam).at(1.0, small, None).unwrap();
                let spread = if lam <= 0.5 { 0.5 - lam * lam } else { spread_of_arc(lam) };
                let close = |x: f64, y: f64| (x / y - 1.0).abs() < 1e-7 + 5.0 * small;
                assert!(close(ring.across, lam * small) || small > 0.01, "{lam} {small:e}");
                assert!(
                    close(ring.couple, spread * small) || small > 1e-9 && lam > 0.9,
                    "{lam} {small:e} {ring:?}"
                );
            }
        }
    }

    #[test]
    fn a_slide_ends_with_the_ratio_of_its_ring_or_disc() {
        let lams = [0.0, 0.05, 0.2, 0.5, 0.8];
        let known = [
            (Face::Ring, 0.5, [f64::INFINITY, 8.71777, 2.38341, 1.31498, 1.12125]),
            (Face::Ring, 0.82, [1.075237, 1.074678, 1.067158, 1.042431, 1.024398]),
            (Face::Disc, 0.5, [0.653002, 0.654285, 0.670105, 0.712533, 0.785338]),
            (Face::Disc, 0.82, [0.0, 0.0, 0.0, 0.375598, 0.588664]),
            (Face::Disc, 1.0, [0.0, 0.0, 0.0, 0.0, 0.473210]),
        ];
        for (form, i3, ratios) in known {
            for (lam, ratio) in lams.into_iter().zip(ratios) {
                let found = end_ratio(form, lam, i3).unwrap();
                assert!(found == ratio || (found - ratio).abs() < 6e-6, "{form:?} {i3} {lam}: {found}");
            }
        }
        // A hoop exchanges its speeds v and s.
        for lam in [0.0, 0.1, 0.5, 0.7, 0.9] {
            assert!((end_ratio(Face::Ring, lam, 1.0).unwrap() - 1.0).abs() < 1e-14);
        }
        let [lam, force] = [0.5, friction_of(Face::Ring, 0.5).at(1.0, 1.0, None).unwrap().across];
        let along = friction_of(Face::Ring, lam).at(1.0, 1.0, None).unwrap().along;
        assert!((force / along - 8.0 * lam / (3.0 * core::f64::consts::PI)).abs() < 1e-15);
    }

    #[test]
    fn a_tall_body_topples_above_a_fold_and_never_where_it_spins_faster_than_it_slides() {
        let known = [
            (1.0001, 1.10087),
            (1.05, 1.067406),
            (1.1, 1.046906),
            (1.2, 1.023272),
            (1.5, 1.001457),
            (2.0, 1.0),
        ];
        for (lam, ratio) in known {
            let friction = FaceFriction::new(Face::Ring, lam);
            let fold = friction.fold();
            assert!((fold - ratio).abs() < 4e-6, "{lam}: {fold}");
            assert!(friction.at(fold * (1.0 + 1e-12), 1.0, None).is_none());
            assert!(friction.at(fold * (1.0 - 1e-9), 1.0, None).is_some(), "{lam}");
            assert!(friction.at(1.0, 0.0, None).is_none());
        }
        for form in FORMS {
            for lam in [1.01, 1.3, 3.0, 20.0] {
                let friction = FaceFriction::new(form, lam);
                assert!(
                    (0..50).all(|i| friction.at(0.02 * f64::from(i), 1.0, None).is_some()),
                    "{form:?} {lam}"
                );
            }
            assert_eq!(FaceFriction::new(form, 1.0).fold(), f64::INFINITY);
        }
    }

    #[test]
    fn a_slide_without_spin_and_a_spin_without_slide_are_plain() {
        for form in FORMS {
            let friction = friction_of(form, 0.8);
            let slide = friction.at(2.0, 0.0, None).unwrap();
            assert_eq!((slide.along, slide.across, slide.couple, slide.centre), (1.0, 0.0, 0.0, [0.8, 0.0]));
            let spin = friction.at(0.0, 3.0, None).unwrap();
            let couple = if form == Face::Ring { 1.0 } else { 2.0 / 3.0 };
            assert!((spin.along, spin.across) == (0.0, 0.0) && (spin.couple - couple).abs() < 3e-16);
        }
    }

    #[test]
    fn a_viscous_ring_has_the_force_of_its_pressure_wherever_that_is() {
        let [c, a, height, v, w] = [0.2, 1.0, 2.0, 1.0, 2.0];
        let of = viscous(c, [a, height], v, w);
        // F = -c (v + w z x a X), X = -Z F/a: the mean slip is that of the centre of the pressure.
        let [x, y] = of.centre;
        assert!((of.along - c * (v - w * a * y)).abs() < 1e-15 && (of.across - c * w * a * x).abs() < 1e-15);
        assert!((x - height * of.along / a).abs() < 1e-15 && (y - height * of.across / a).abs() < 1e-15);
        // The couple about the axis: <n x u> a = a^2 w - a v y.
        assert!((of.couple - c * (a * a * w - a * v * y)).abs() < 1e-15);
    }
}
