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
mod ring;

use crate::numbers::codes::coded;
use ring::{Arc, Pressed, WholeMeans};

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
const NEWTON_STEPS: usize = 60;
const CLOSE: f64 = 1e-8;

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
        let edge = |x: [f64; 2]| x.map(|x| x / (slope * centre[0].hypot(centre[1])));
        let tilted = last.filter(|x| slope * x[0].hypot(x[1]) > 1.0);
        let (arc, found) = tilted
            .and_then(|x| self.solved(Arc::about(x), v, s))
            .or_else(|| self.solved(Arc::about(edge(centre)), v, s))?;
        let turned = [arc.off.sin(), arc.angle.sin()];
        let [along, across] = turned.map(|x| found.force * x);
        Some(FaceForce { along, across, couple: found.couple, centre: turned.map(|x| found.centre * x) })
    }

    /// The part that presses, by Newton's method from another one.
    fn solved(&self, mut arc: Arc, v: f64, s: f64) -> Option<(Arc, Pressed)> {
        let mut close = false;
        for _ in 0..NEWTON_STEPS {
            let here = self.pressed(&arc, v, s);
            let det = here.determinant();
            if close {
                return (det < 0.0).then_some((arc, here));
            }
            let [r, q] = here.residual;
            let width = (here.by_angle[0] * q - here.by_angle[1] * r) / det;
            let angle = (here.by_width[1] * r - here.by_width[0] * q) / det;
            if !(width.is_finite() && angle.is_finite()) {
                return None;
            }
            // The next step is below rounding, as each has the square of the one before.
            close = width.abs() <= CLOSE * arc.width && angle.abs() <= CLOSE * arc.angle.min(arc.off).abs();
            let bounded = (arc.width + width).clamp(0.2 * arc.width, 1.0) - arc.width;
            arc = arc.moved(bounded, angle.clamp(-0.3, 0.3));
        }
        None
    }

    fn pressed(&self, arc: &Arc, v: f64, s: f64) -> Pressed {
        match self.form {
            Face::Ring => arc.pressed(self.lam, v, s),
            Face::Disc => disc::pressed(arc, self.lam, v, s),
        }
    }

    /// The fold.
    fn highest_ratio(&self) -> f64 {
        f64::INFINITY
    }
}
