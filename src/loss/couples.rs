//! The couple of some laws together, over any number: what a law sees, the ways of what it resists, the sums.
//!
//! ```text
//! m = m0 + N mN,   P = P0 + N PN          of the eight laws that are present
//! ```
//! The ways (of the contact along the rim, of the drilling, of a body that only rocks) are signs that a caller can hold
//! fixed within a step, so that every step is smooth. Error: that of the laws.

use super::{COUNT, Law, Losses};
use crate::body::{Body, Rim};
use crate::number::{Dual, Real};
use crate::state::State;
use core::f64::consts::FRAC_PI_4;

/// What a law sees of a body on its way.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kinematics<T> {
    /// Sine and cosine of theta.
    pub angle: (T, T),
    pub w: [T; 3],
    /// psi'.
    pub spin: T,
    /// A, the radius of the circle of contact.
    pub radius: T,
    /// -1, 0 or 1: the way of the contact along the rim, and of the drilling.
    pub signs: [T; 2],
    /// The way of the rocking of a body that only rocks, where the caller follows it.
    pub rocks: Option<T>,
}

impl<T: Real> Kinematics<T> {
    /// Of sine and cosine, w1/s and w.
    #[inline(always)]
    pub fn of(rim: &Rim<T>, angle: (T, T), precession: T, w: [T; 3]) -> Self {
        let (s, c) = angle;
        let spin = w[2] - c * precession;
        let (zero, one) = (s.splat(0.0), s.splat(1.0));
        let mut seen = Self { angle, w, spin, radius: rim.radius(angle), signs: [zero; 2], rocks: None };
        let sign = |x: T| x.select_lt(zero, -one, zero.select_lt(x, one, zero));
        seen.signs = [sign(spin), sign(seen.drilling())];
        seen
    }

    /// w_h, the rolling.
    #[inline(always)]
    pub fn rolling(&self) -> T {
        -(self.angle.0 * self.spin)
    }

    /// w_z, the drilling.
    #[inline(always)]
    pub fn drilling(&self) -> T {
        self.angle.0.mac(self.w[0], self.angle.1 * self.w[2])
    }

    /// w.w.
    #[inline(always)]
    pub fn square(&self) -> T {
        let [w1, w2, w3] = self.w;
        w1.mac(w1, w2.mac(w2, w3 * w3))
    }

    /// The couple `push` h/s: it takes the power push psi', since h.w = -s psi'.
    #[inline(always)]
    pub fn along(&self, push: T) -> [T; 3] {
        let (s, c) = self.angle;
        [c / s * push, push.splat(0.0), -push]
    }
}

impl Kinematics<f64> {
    pub fn of_state(body: &Body, y: &State) -> Self {
        let angle = y.theta.sin_cos();
        Self::of(&body.shape().rim, angle, y.w1 / angle.0, [y.w1, y.w2, y.w3])
    }
}

/// The couple of some losses: a part that does not depend on the normal force, and one that is proportional to it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Couple<T> {
    pub free: [T; 3],
    pub pressed: [T; 3],
}

impl<T: Real> Couple<T> {
    /// All of it under a normal force.
    #[inline(always)]
    pub fn under(&self, normal: T) -> [T; 3] {
        let ([a, b, c], [x, y, z]) = (self.free, self.pressed);
        [normal.mac(x, a), normal.mac(y, b), normal.mac(z, c)]
    }
}

/// The ways of what dry friction resists, where a caller follows them: along the rim, drilling, and of a body that only rocks.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Ways<T = f64> {
    pub contour: T,
    pub drilling: T,
    /// In lanes nothing only rocks.
    pub rocking: f64,
}

/// Losses as the equations of motion take them, one or eight in lanes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Couples<T> {
    coefficients: [T; COUNT],
    present: [bool; COUNT],
    /// The ways, where they are known and do not change within a step.
    pub ways: Option<Ways<T>>,
}

/// A step may bring what a law takes a root of so much nearer to its zero, or over it from so near.
const NEARER: f64 = 0.5;
pub(crate) const NEAR: f64 = 1e-9;
/// What has turned round by less than this has not: rounding leaves what begins to move on either side.
pub(crate) const SLACK: f64 = 4e-15;

impl<T: Real> Couples<Dual<T>> {
    /// The longest step that these laws allow: their roots are not smooth where they vanish. `paced` says that the variable
    /// of the flow is one in which rolling resistance is smooth all the same.
    #[inline(always)]
    pub fn longest(&self, seen: &Kinematics<Dual<T>>, paced: bool) -> T {
        let number = |x: f64| seen.spin.value.splat(x);
        let mut most = number(f64::INFINITY);
        for square in self.roots(seen, paced).into_iter().flatten() {
            // x^2 and 2 x x'
            let x = square.value.sqrt();
            let twice = square.slope.abs() / x;
            // what neither is nor changes is no number, and limits nothing
            most = ((number(2.0 * NEARER) * x).max(number(2.0 * NEAR)) / twice).min(most);
        }
        most
    }
}

/// How far what goes one way, 1 or -1, is from turning round; of what has no way 1.
#[inline(always)]
pub(crate) fn going<T: Real>(way: T, x: T, slack: T) -> T {
    let one = x.splat(1.0);
    one.splat(0.5).select_lt(way * way, way * x + slack, one)
}

/// phi' + c psi' = w_z, psi' and w2 the other way: w with the rolling and the rocking turned round.
pub(crate) fn mirrored((s, c): (f64, f64), [w1, w2, w3]: [f64; 3]) -> [f64; 3] {
    let spin = w3 - c / s * w1;
    [w1 + 2.0 * s * c * spin, -w2, w3 - 2.0 * s * s * spin]
}

/// How fast the rolling and the rocking together, the root of the sum of their squares, grow where w changes at this rate.
pub(crate) fn rolling_growth((s, c): (f64, f64), [w1, w2, w3]: [f64; 3], [d1, d2, d3]: [f64; 3]) -> [f64; 2] {
    // w_h = c w1 - s w3
    let (rolling, rate) = (c * w1 - s * w3, c * d1 - s * d3 + w2 * (s * w1 + c * w3));
    let speed = rolling.hypot(w2);
    [speed, (rolling * rate + w2 * d2) / speed]
}

impl Couples<f64> {
    /// How the couple along the contour grows with psi'.
    pub fn slope(&self, s: f64, radius: f64, spin: f64) -> f64 {
        self.coefficient(Law::ViscousContour) * radius * radius
            + self.coefficient(Law::AirFilm) * FRAC_PI_4 / s
            + 1.5 * self.coefficient(Law::BoundaryLayer) * spin.abs().sqrt()
    }

    /// The same without what acts along the contour.
    pub fn off_the_contour(mut self) -> Self {
        for law in [Law::DryContour, Law::ViscousContour, Law::AirFilm, Law::BoundaryLayer] {
            (self.coefficients[law as usize], self.present[law as usize]) = (0.0, false);
        }
        self
    }

    /// Of some losses, None of nothing.
    pub fn some(losses: &Losses) -> Option<Self> {
        (!losses.is_none()).then(|| Self::of(losses, |x| x))
    }
}

impl<T: Real> Couples<T> {
    #[inline(always)]
    pub fn of(losses: &Losses, number: impl Fn(f64) -> T) -> Self {
        let coefficients = losses.coefficients.map(number);
        Self { coefficients, present: losses.coefficients.map(|x| x != 0.0), ways: None }
    }

    /// The same in another kind of numbers.
    pub fn map<U: Real>(&self, number: impl Fn(T) -> U) -> Couples<U> {
        let ways = self.ways.map(|ways| Ways {
            contour: number(ways.contour),
            drilling: number(ways.drilling),
            rocking: ways.rocking,
        });
        Couples { coefficients: self.coefficients.map(number), present: self.present, ways }
    }

    /// What these laws see of sine and cosine, w1/s and w.
    #[inline(always)]
    pub fn seen(&self, rim: &Rim<T>, angle: (T, T), precession: T, w: [T; 3]) -> Kinematics<T> {
        let seen = Kinematics::of(rim, angle, precession, w);
        let Some(ways) = self.ways else { return seen };
        let rocks = (ways.rocking != 0.0).then(|| angle.0.splat(ways.rocking));
        Kinematics { signs: [ways.contour, ways.drilling], rocks, ..seen }
    }

    /// These laws alone, in lanes.
    #[inline(always)]
    pub fn in_lanes(coefficients: [T; COUNT], present: [bool; COUNT], ways: Ways<T>) -> Self {
        Self { coefficients, present, ways: Some(ways) }
    }

    /// Which laws there are.
    pub fn present(&self) -> [bool; COUNT] {
        self.present
    }

    /// Whether some of it acts about the axis of the rocking.
    #[inline(always)]
    pub fn tilts(&self) -> bool {
        self.has(Law::RollingResistance) || self.has(Law::AirLinear) || self.has(Law::AirQuadratic)
    }

    /// Whether some of it grows with the speed of the contact along the rim.
    #[inline(always)]
    pub fn is_soft(&self) -> bool {
        self.has(Law::ViscousContour) || self.has(Law::AirFilm) || self.has(Law::BoundaryLayer)
    }

    /// Whether some of it takes a root, but for rolling resistance.
    #[inline(always)]
    pub fn has_roots(&self) -> bool {
        self.has(Law::AirQuadratic) || self.has(Law::BoundaryLayer)
    }

    /// Whether this law is among them.
    #[inline(always)]
    pub fn has(&self, law: Law) -> bool {
        self.present[law as usize]
    }

    /// Its coefficient.
    #[inline(always)]
    pub fn coefficient(&self, law: Law) -> T {
        self.coefficients[law as usize]
    }

    /// The squares of what a law takes a root of: near its zero a step has to be short.
    #[inline(always)]
    fn roots(&self, seen: &Kinematics<T>, paced: bool) -> [Option<T>; 3] {
        let rolling = seen.rolling();
        [
            self.has(Law::BoundaryLayer).then(|| seen.spin * seen.spin),
            (self.has(Law::RollingResistance) && seen.rocks.is_none() && !paced)
                .then(|| rolling.mac(rolling, seen.w[1] * seen.w[1])),
            self.has(Law::AirQuadratic).then(|| seen.square()),
        ]
    }

    /// The couple.
    #[inline(always)]
    pub fn at(&self, seen: &Kinematics<T>) -> Couple<T> {
        let zero = seen.spin.splat(0.0);
        let mut couple = Couple { free: [zero; 3], pressed: [zero; 3] };
        for law in Law::ALL {
            if self.present[law as usize] {
                let to = if law.presses() { &mut couple.pressed } else { &mut couple.free };
                let unit = law.couple(seen);
                for i in 0..3 {
                    to[i] = self.coefficients[law as usize].mac(unit[i], to[i]);
                }
            }
        }
        couple
    }

    /// The power that is lost.
    #[inline(always)]
    pub fn power(&self, seen: &Kinematics<T>, normal: T) -> T {
        let mut power = normal.splat(0.0);
        for law in Law::ALL {
            if self.present[law as usize] {
                let unit = law.power(seen);
                let unit = if law.presses() { unit * normal } else { unit };
                power = self.coefficients[law as usize].mac(unit, power);
            }
        }
        power
    }
}
