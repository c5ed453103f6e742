//! The friction of a face on which a body stands, slides and spins.
//!
//! ```text
//! lam = mu Z/a,   s = a |w|,   F = -mu N G,   couple = -mu a N gg,   X = -Z F/(a N) = lam G,   |X| <= 1
//! G = <u/|u|>,   gg = <n x u/|u|>   over the pressure p, whose centre is at X a ahead of the axis
//! viscous   F = -c v/(1 - i c Z w),   couple = -c w (a^2 - Z^2 |F|^2)      v along the real axis
//! end ratio   v/s = k at which a slide ends:   G_x = k gg/i3,   G_x > k gg/i3 above
//! ```
//! The moment of friction about the centre of mass tilts the pressure, and the tilt changes friction: two equations for
//! X. The pressure is that of a stiff, damped elastic bed: linear in the place, and zero where that is negative. While the
//! whole face presses, X is in closed form; otherwise Newton's method finds the width and the direction of the pressed
//! part. For lam > 1 the body topples above a fold of the solutions, whose ratio v/s is found once.
//!
//! Error: see [`ring`] and [`disc`]; a test compares with quadrature of 30 digits.

mod disc;
mod part;
mod ring;

use crate::methods::search::crossing;
use crate::numbers::codes::coded;
use core::f64::consts::FRAC_PI_2;
use part::{Part, Pressed};
use ring::WholeMeans;

coded! {
    /// How the table presses on a face. Where the pressure of a rigid face is undetermined, this is the choice of a model.
    #[derive(Default)]
    pub enum Face {
        /// On its rim alone, as below a tube, a can or a coin: the default.
        #[default]
        Ring = 0,
        /// On the whole face, as below a puck or a lapped end.
        Disc = 1,
    }
}

/// Friction over mu N, and its couple over mu a N, of a face that spins counterclockwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FaceForce {
    /// Along the velocity, and to the left of it.
    pub along: f64,
    pub across: f64,
    pub couple: f64,
    /// The centre of the pressure, over a: along the velocity, and to the left of it.
    pub centre: [f64; 2],
}

/// The friction of a face under Coulomb's law.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FaceFriction {
    form: Face,
    lam: f64,
    fold: f64,
}

/// Most steps of Newton's method, which double the digits, and the relative step that is the last one.
const STEPS_TO_PART: usize = 60;
const LAST_STEP: f64 = 1e-8;
/// The ratios between which an end ratio is sought.
const SLOW_END: f64 = 1e-5;
const FAST_END: f64 = 1e6;
/// The largest root of the ratio of a fold less 1, and the relative accuracy of its place, whose square is that of lam.
const WIDEST_FOLD: f64 = 0.37;
const FOLD_STEP: f64 = 1e-7;
/// The last turn of a direction, and the ratio of widths in a search for the widest part.
const TURN: f64 = 1e-12;
const NARROWER: f64 = 0.5;
const NARROWEST: f64 = 1e-9;
/// A part of this width is a point.
const POINT: f64 = 1e-24;

impl FaceFriction {
    /// The friction of a face whose centre of mass is lam a/mu above it.
    pub fn new(form: Face, lam: f64) -> Self {
        let mut friction = Self { form, lam, fold: f64::INFINITY };
        if lam > 1.0 {
            friction.fold = friction.highest_ratio();
        }
        friction
    }

    /// The ratio of `v` to `s` above which the body topples.
    pub fn fold(&self) -> f64 {
        self.fold
    }

    /// The force at the speed `v` of the centre and the speed `s` of the rim; none where the body topples. Where there
    /// are several centres of the pressure, that next to the `last` one, else the one nearest to the axis.
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
        let tilted = last.filter(|x| slope * x[0].hypot(x[1]) > 1.0);
        let (arc, found) = tilted
            .and_then(|x| self.solved(Part::towards(self.width_of(x[0].hypot(x[1])), x), v, s))
            .or_else(|| self.solved(Part::towards(1.0, centre), v, s))?;
        let turned = [arc.off.sin(), arc.angle.sin()];
        let [along, across] = turned.map(|x| found.force * x);
        Some(FaceForce { along, across, couple: found.couple, centre: turned.map(|x| found.centre * x) })
    }

    /// The width of the part whose centre of pressure is this far from the axis, nearly.
    fn width_of(&self, centre: f64) -> f64 {
        let short = 1.0 - centre;
        let (first, last) = match self.form {
            Face::Ring => (2.5, 1.0),
            Face::Disc => (1.75, 5.0 / 9.0),
        };
        (short * (first - last * short)).clamp(1e-18, 1.0)
    }

    /// The part that presses, by Newton's method from another one.
    fn solved(&self, mut arc: Part, v: f64, s: f64) -> Option<(Part, Pressed)> {
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
            // The next step is below rounding, as each has the square of the one before.
            close = width.abs() <= LAST_STEP * arc.width && angle.abs() <= LAST_STEP * arc.angle.min(arc.off).abs();
            let bounded = (arc.width + width).clamp(0.2 * arc.width, 1.0) - arc.width;
            arc = arc.moved(bounded, angle.clamp(-0.3, 0.3));
        }
        None
    }

    fn pressed(&self, arc: &Part, v: f64, s: f64) -> Pressed {
        match self.form {
            Face::Ring => ring::pressed(arc, self.lam, v, s),
            Face::Disc => disc::pressed(arc, self.lam, v, s),
        }
    }

    /// The fold: the ratio whose largest lam, over all parts that press, is this one. The largest lam is smooth in the
    /// root of the ratio less 1.
    fn highest_ratio(&self) -> f64 {
        let miss = |y: f64| self.largest_lam(1.0 + y * y) - self.lam;
        let near = miss(0.0);
        if near <= 0.0 {
            return 1.0;
        }
        // Beyond, lam = 1 belongs to a point.
        let y = crossing(miss, 0.0, WIDEST_FOLD, near, 1.0 - self.lam);
        1.0 + y * y
    }

    /// The largest lam that has a centre of the pressure at the ratio `k`. At a given width the direction of X follows from
    /// the force across, and lam from that along.
    fn largest_lam(&self, k: f64) -> f64 {
        let mut angle = 0.6;
        let mut on_curve = |width: f64| {
            let mut found = [1.0, 0.0];
            for _ in 0..STEPS_TO_PART {
                let part = Part { width, angle, off: FRAC_PI_2 - angle };
                let here = Self { lam: found[0], ..*self }.pressed(&part, k, 1.0);
                found = [here.centre / here.force, here.determinant()];
                let turn = here.residual[1] / here.by_angle[1];
                angle -= turn.clamp(-0.2, 0.2);
                if turn.abs() < TURN {
                    break;
                }
            }
            (found[0], found[1])
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
        // Regula falsi, as in `crossing`, but only as far as the square needs.
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

/// The friction of viscous film below a ring, F = -c u over its length: F over -1 and its couple over -1, for the speed
/// `v` of the centre and the rate `w` of a body of radius `a` whose centre of mass is `height` above the face. It topples
/// where the centre of the pressure is outside of the ring.
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
/// spins on its face: 0 or infinity if one of them ends before the other in proportion. None if the body topples on the
/// way there. `lam` is the coefficient of friction times the height of the centre of mass over the radius of the face,
/// `i3` the axial moment over the square of this radius.
pub fn end_ratio(form: Face, lam: f64, i3: f64) -> Option<f64> {
    let friction = FaceFriction::new(form, lam);
    // The growth of the ratio, over the speed of the centre where that is small.
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
