//! The contact of a rim with the table: circle of contact, height of the centre of mass, lever of the normal force.
//!
//! ```text
//! A = a + rho s,   L = ell + rho c              radius of the circle of contact, its depth
//! h = a s + ell c + rho                         height of the centre above the table
//! g = ell s - a c = L s - A c = -dh/dtheta      lever of the normal force
//! g' = ell c + a s = h - rho
//! ```
//! The rim is a circle of radius a at the depth ell below the centre of mass, rounded with the fillet rho: the body
//! touches the table with a torus. s and c are sine and cosine of the inclination. The unit of length is the outer
//! radius a + rho = 1; rho = 0 is a sharp rim and a = 0 a ball, whose centre lies ell below the centre of mass. The
//! fillet does not enter g and g'. The formulas of the ball are in Routh, Advanced Rigid Dynamics (1884), Art. 244;
//! those of the torus are elementary.
//!
//! Only this file contains these formulas, with the exceptions that a test of `test_house` lists. Error: 3 ulp of the
//! largest term.

use crate::numbers::Real;

/// A rim, or eight rims in SIMD lanes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rim<T> {
    /// Depth of the rim below the centre of mass.
    pub ell: T,
    /// Radius a of the rim circle.
    pub a: T,
    /// Radius rho of the fillet.
    pub rho: T,
}

impl Rim<f64> {
    /// A distance from the centre of mass that no point of the rim exceeds.
    pub fn reach(&self) -> f64 {
        self.ell.abs() + self.a + self.rho
    }
}

impl<T: Real> Rim<T> {
    /// Radius A of the circle of contact, on which the body touches the table.
    #[inline(always)]
    pub fn radius(&self, (s, _): (T, T)) -> T {
        self.a + self.rho * s
    }

    /// Depth L of the circle of contact below the centre of mass.
    #[inline(always)]
    pub fn depth(&self, (_, c): (T, T)) -> T {
        self.ell + self.rho * c
    }

    /// Height h of the centre of mass above the table.
    #[inline(always)]
    pub fn height(&self, angle: (T, T)) -> T {
        self.slope(angle) + self.rho
    }

    /// Lever g of the normal force: the signed horizontal distance between the contact point and the centre of mass.
    #[inline(always)]
    pub fn lever(&self, (s, c): (T, T)) -> T {
        self.ell * s - self.a * c
    }

    /// Derivative g' of the lever with respect to the inclination.
    #[inline(always)]
    pub fn slope(&self, (s, c): (T, T)) -> T {
        self.ell * c + self.a * s
    }

    /// Differences ell, a and rho of this rim and another one. The circle of contact, depth, height and lever of the
    /// result are those of this rim less those of the other one, with all digits where both are equal.
    #[inline(always)]
    pub fn less(&self, other: &Self) -> Self {
        Self { ell: self.ell - other.ell, a: self.a - other.a, rho: self.rho - other.rho }
    }

    /// The derivative dg/dtheta of the lever g, with one rounding less than [`slope`](Self::slope), in SIMD lanes and in single numbers alike.
    #[inline(always)]
    pub fn fused_slope(&self, (s, c): (T, T)) -> T {
        self.ell.fma(c, self.a * s)
    }
}

/// A circle on which a body touches the table at one inclination.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CircleDown<T> {
    /// Radius A of the circle of contact.
    pub radius: T,
    /// Depth L of the circle of contact.
    pub depth: T,
    /// Lever g of the normal force.
    pub lever: T,
}

/// Two neighbouring circles of a body at the inclination at which both touch the table.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Border<T> {
    /// Sine and cosine of the inclination at which both circles touch the table.
    pub angle: (T, T),
    /// Height Z of the centre of mass above the table.
    pub height: T,
    /// The circle that touches the table at smaller inclinations, and the circle that touches it at larger inclinations.
    pub circles: [CircleDown<T>; 2],
    /// Whether both circles touch the table with the same radius A.
    pub even: bool,
}

impl Border<f64> {
    pub fn between(rims: [Rim<f64>; 2], angle: (f64, f64)) -> Self {
        let circles = rims.map(|rim| CircleDown {
            radius: rim.radius(angle),
            depth: rim.depth(angle),
            lever: rim.lever(angle),
        });
        let [here, there] = rims.map(|rim| rim.height(angle));
        let even = circles[0].radius == circles[1].radius;
        Self { angle, height: 0.5 * (here + there), circles, even }
    }
}

impl<T: Real> Border<T> {
    /// The distance D between the two contact points.
    pub fn span(&self) -> T {
        self.circles[0].lever - self.circles[1].lever
    }

    /// Converts each number with `f`.
    pub fn map<U: Real>(&self, f: impl Fn(T) -> U) -> Border<U> {
        let circle =
            |of: CircleDown<T>| CircleDown { radius: f(of.radius), depth: f(of.depth), lever: f(of.lever) };
        let Self { angle: (s, c), height, circles: [here, there], even } = *self;
        Border { angle: (f(s), f(c)), height: f(height), circles: [circle(here), circle(there)], even }
    }
}

/// The numbers of one body, or of eight in SIMD lanes, that enter the equations of motion: the rim and the moments of inertia.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shape<T> {
    pub rim: Rim<T>,
    pub i1: T,
    pub i3: T,
}

impl<T: Real> Shape<T> {
    /// The shape of a body with these ell, I1, I3 and fillet.
    #[inline(always)]
    pub fn of([ell, i1, i3, rho]: [T; 4]) -> Self {
        Self { rim: Rim { ell, a: ell.splat(1.0) - rho, rho }, i1, i3 }
    }

    /// Converts each number with `f`, for example into SIMD lanes or to twice the digits.
    #[inline(always)]
    pub fn map<U: Real>(&self, f: impl Fn(T) -> U) -> Shape<U> {
        let Rim { ell, a, rho } = self.rim;
        Shape { rim: Rim { ell: f(ell), a: f(a), rho: f(rho) }, i1: f(self.i1), i3: f(self.i3) }
    }
}
