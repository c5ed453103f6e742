//! The equations of motion of rolling and smooth contact without the contact force; the first integrals use them.
//!
//! ```text
//! ct = cot theta,   s, c, A, L, h, g, g' as in `body::rim`,   J' = dJ/dtheta
//! dw1/dtheta = -ct w1 - p w1 + q w3,   dw3/dtheta = r w1 + t w3,   theta' = -w2
//! J w2'  = w1 (ct (k w3 - al w1) + b w3 - k w1) - g + (J'/2) w2^2
//! J w2^2 = 2 E - al w1^2 - b w3^2 + 2 k w3 w1 - 2 h
//! rolling:  al = I1 + L^2,  b = I3 + A^2,  k = A L,  J = I1 + A^2 + L^2,  J'/2 = -rho g
//!           D = I1 I3 + I1 A^2 + I3 L^2,   p = I3 a L/D,   q = I3 (I3 + A^2 + rho c L)/D
//!           r = A I1 a/D,   t = A (I3 L - I1 rho c)/D
//! smooth:   al = I1,  b = I3,  k = 0,  J = I1 + g^2,  J'/2 = g g',   p = r = t = 0,   q = I3/I1
//! ```
//! For a sharp rim, where A, L, J and D are constant, the equations are in Chaplygin 1897, Appell and
//! Korteweg 1900; for a torus the same elimination gives them. They are written once over [`Real`]: a
//! property of `laws` checks that they agree with [`newton`](crate::laws::newton) under the contact force at
//! every state.
//!
//! Error: a few roundings of the terms written above.

use super::Contact;
use crate::laws::body::Shape;
use crate::laws::state::State;
use crate::numbers::{Dual, Real};

/// The coefficients of the equations at the head of this module, at one inclination.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coefficients<T> {
    pub al: T,
    pub b: T,
    pub k: T,
    pub p: T,
    pub q: T,
    pub r: T,
    pub t: T,
    /// 1/D, with the D of the equations at the top of this file.
    pub per_d: T,
}

/// The equations of motion of a body with its contact, without the contact force.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reduced<T> {
    pub contact: Contact,
    pub shape: Shape<T>,
    /// Whether the coefficients depend on the inclination, as they do for a rounded rim that rolls.
    pub round: bool,
    /// The coefficients of a body for which `round` is false.
    fixed: Coefficients<T>,
    /// The inertia J of a body for which `round` is false; on a smooth table without the term g^2.
    inertia: T,
}

impl<T: Real> Reduced<T> {
    /// The equations of this shape and contact. `round` says whether the body has a fillet, the same in all SIMD lanes.
    #[inline(always)]
    pub fn of(contact: Contact, shape: &Shape<T>, round: bool) -> Self {
        let (shape, zero) = (*shape, shape.i1.splat(0.0));
        let Shape { rim, i1, i3 } = shape;
        let (fixed, inertia) = match contact {
            Contact::Rolling => {
                let (one, square) = (zero.splat(1.0), rim.ell * rim.ell);
                let per_d = one / (i1 * i3 + i1 + i3 * square);
                let p = i3 * rim.ell * per_d;
                let q = i3 * (i3 + one) * per_d;
                let (al, b, r) = (i1 + square, i3 + one, i1 * per_d);
                (Coefficients { al, b, k: rim.ell, p, q, r, t: p, per_d }, i1 + one + square)
            }
            Contact::Smooth => {
                let (q, per_d) = (i3 / i1, zero.splat(1.0) / (i1 * i3));
                (Coefficients { al: i1, b: i3, k: zero, p: zero, q, r: zero, t: zero, per_d }, i1)
            }
        };
        Self { contact, shape, round: round && contact == Contact::Rolling, fixed, inertia }
    }

    /// The coefficients of the equations at one inclination.
    #[inline(always)]
    pub fn at(&self, angle: (T, T)) -> Coefficients<T> {
        if !self.round {
            return self.fixed;
        }
        let Shape { rim, i1, i3 } = self.shape;
        let (radius, depth) = (rim.radius(angle), rim.depth(angle));
        let (square, deep) = (radius * radius, depth * depth);
        let hub = rim.rho * angle.1;
        let per_d = i1.splat(1.0) / (i1 * i3 + i1 * square + i3 * deep);
        Coefficients {
            al: i1 + deep,
            b: i3 + square,
            k: radius * depth,
            p: i3 * rim.a * depth * per_d,
            q: i3 * (i3 + square + hub * depth) * per_d,
            r: radius * i1 * rim.a * per_d,
            t: radius * (i3 * depth - i1 * hub) * per_d,
            per_d,
        }
    }

    /// The moment b - k^2/al of a body for which `round` is false, computed without a difference: I3 + A^2 I1/al for
    /// rolling.
    #[inline(always)]
    pub fn axial(&self, of: &Coefficients<T>) -> T {
        match self.contact {
            Contact::Rolling => self.shape.i3 + self.shape.i1 / of.al,
            Contact::Smooth => self.shape.i3,
        }
    }

    /// J theta'' without the term -(J'/2) theta'^2, which exists only where J depends on theta.
    #[inline(always)]
    pub fn tilting(&self, of: &Coefficients<T>, (s, c): (T, T), w1: T, w3: T) -> T {
        let radial = of.al * w1 - of.k * w3;
        let along = of.k * w1 - of.b * w3;
        (c / s * radial + along) * w1 + self.shape.rim.lever((s, c))
    }

    /// Twice the energy without J theta'^2: twice the energy of the rotation by w1 and w3, and of the height of the centre.
    #[inline(always)]
    pub fn energy_without_tilting(&self, angle: (T, T), w1: T, w3: T) -> T {
        let of = self.at(angle);
        let height = self.shape.rim.height(angle);
        let turning = of.al * w1 * w1 + of.b * w3 * w3 - (of.k * w1 * w3 + of.k * w1 * w3);
        turning + (height + height)
    }

    /// The derivatives of w1 and w3 with respect to the inclination; along a motion, w1 and w3 are functions of theta.
    #[inline(always)]
    pub fn lines(&self, of: &Coefficients<T>, (s, c): (T, T), w1: T, w3: T) -> [T; 2] {
        [of.q * w3 - of.p * w1 - c / s * w1, of.r * w1 + of.t * w3]
    }

    /// [`tilting`](Self::tilting) and its derivative with respect to the inclination along a motion, where w1 and w3
    /// are functions of theta; by dual numbers.
    #[inline(always)]
    pub fn tilting_along(&self, (s, c): (T, T), w1: T, w3: T) -> Dual<T> {
        let [w1_slope, w3_slope] = self.lines(&self.at((s, c)), (s, c), w1, w3);
        let dual = |value: T, slope: T| Dual { value, slope };
        let zero = s.splat(0.0);
        let along = Reduced::of(self.contact, &self.shape.map(|x| dual(x, zero)), self.round);
        let angle = (dual(s, c), dual(c, -s));
        along.tilting(&along.at(angle), angle, dual(w1, w1_slope), dual(w3, w3_slope))
    }

    /// The inertia J for changes of the inclination; `angle` gives sine and cosine of theta and is only called if J
    /// depends on them.
    #[inline(always)]
    pub fn inertia(&self, angle: impl FnOnce() -> (T, T)) -> T {
        if self.round {
            let (angle, rim) = (angle(), &self.shape.rim);
            let (radius, depth) = (rim.radius(angle), rim.depth(angle));
            return depth.mac(depth, radius.mac(radius, self.shape.i1));
        }
        match self.contact {
            Contact::Rolling => self.inertia,
            Contact::Smooth => {
                let lever = self.shape.rim.lever(angle());
                lever.mac(lever, self.inertia)
            }
        }
    }
}

/// The equations of motion in the form that an integrator evaluates: a constant J is already divided out.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rates<T> {
    of: Reduced<T>,
    scaled: Coefficients<T>,
    lever: [T; 2],
}

impl<T: Real> Rates<T> {
    #[inline(always)]
    pub fn of(contact: Contact, shape: &Shape<T>, round: bool) -> Self {
        let of = Reduced::of(contact, shape, round);
        let (mut scaled, mut weight) = (of.fixed, shape.i1.splat(1.0));
        if contact == Contact::Rolling && !round {
            weight = weight / of.inertia;
            (scaled.al, scaled.b, scaled.k) = (scaled.al * weight, scaled.b * weight, scaled.k * weight);
        }
        Self { of, scaled, lever: [shape.rim.a * weight, shape.rim.ell * weight] }
    }

    /// The equations of motion from which these time derivatives of the state are computed.
    #[inline(always)]
    pub fn reduced(&self) -> &Reduced<T> {
        &self.of
    }

    /// The rates w1', w2' and w3', from sine s and cosine c of theta and the angular velocity w.
    #[inline(always)]
    pub fn at(&self, s: T, c: T, w: [T; 3]) -> [T; 3] {
        if self.of.round { self.at_rim_kind::<true>(s, c, w) } else { self.at_rim_kind::<false>(s, c, w) }
    }

    /// The rates w1', w2' and w3'; ROUND tells the compiler whether the body has a rounded rim and rolls.
    #[inline(always)]
    pub fn at_rim_kind<const ROUND: bool>(&self, s: T, c: T, [w1, w2, w3]: [T; 3]) -> [T; 3] {
        let (ct, rim) = (c / s, &self.of.shape.rim);
        let of = if ROUND { self.of.at((s, c)) } else { self.scaled };
        let [out, up] = self.lever;
        let turning = ct.mac(of.k.mac(w3, -(of.al * w1)), of.b.mac(w3, -(of.k * w1)));
        let falling = out.mac(c, -(up * s));
        let push = w1.mac(turning, falling);
        let square = w2 * w2;
        let tilting = if ROUND {
            let bend = -(rim.rho * rim.lever((s, c)));
            bend.mac(square, push) / self.of.inertia(|| (s, c))
        } else if self.of.contact == Contact::Smooth {
            let (g, slope) = (rim.lever((s, c)), rim.slope((s, c)));
            (g * slope).mac(square, push) / g.mac(g, self.of.inertia)
        } else {
            push
        };
        [w2 * ct.mac(w1, of.p.mac(w1, -(of.q * w3))), tilting, -(w2 * of.r.mac(w1, of.t * w3))]
    }
}

impl Rates<f64> {
    /// The time derivative of (theta, w1, w2, w3), for given sine and cosine of theta.
    #[inline(always)]
    pub fn derivative(&self, y: &State, (s, c): (f64, f64)) -> State {
        let [w1, w2, w3] = self.at(s, c, [y.w1, y.w2, y.w3]);
        State { theta: -y.w2, w1, w2, w3 }
    }
}
