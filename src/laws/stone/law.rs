//! The equations of an ellipsoid that rolls or slips on a table.
//!
//! ```text
//! S    = sqrt(n.D n),   r = -D n/S - d,   n' = n x w,   S' = n.D n'/S,   r' = -D n'/S + D n S'/S^2
//! roll   (I + r^2 - r r^T) w' = -w x I w - r x (w x r' + w x (w x r)) + r x n
//!        F = -w' x r - w x r' - w x (w x r) + n
//! slip   f = n - mu e (Coulomb, e = u/|u|) or n - c u (viscous),   F = N f,   w' = N I^-1 (r x f) - I^-1 (w x I w)
//!        B = r x (I^-1 (w x I w)) + w x (r' + w x r),   N (1 + (I^-1 (r x f)) x r . n) = 1 - B.n
//!        u' = F - n + w' x r + w x (r' + w x r)   in the laboratory;   heat' = mu N |u|, c N u^2
//! patch  f = n - mu f(k) e,  and the couple -mu N eps g(k) sgn(w.n) n;   r x f in N and w' includes this couple over N
//! held   w' has the couple M n with (w.n)' = w'.n = 0                       if static friction stops the drilling
//! losses   the couple m = m0 + N mN on the right side of w', and N from it:   P = -m.w,   (E + heat)' = -P
//! E      = (w.I w + v^2)/2 - r.n,   v = u - w x r
//! slope  n - tan(beta) x in place of n where it is the weight: in r x n, and where F and u' contain n;   x points downhill
//! ```
//! Vectors have components along the axes of the ellipsoid: n is the vertical, r leads from the centre of mass to the
//! contact point, w is the angular velocity, u the slip of the contact point, and v the velocity of the centre of mass. D
//! is the diagonal matrix of the squared semi-axes, I the tensor of inertia about the centre of mass, and d leads from the
//! centre of the ellipsoid to the centre of mass. These are Newton's and Euler's equations with the contact force eliminated
//! (Kane and Levinson 1982 for rolling); the slip is that of [`contact::slip`](crate::laws::contact::slip). On a slope the
//! part of gravity across the table is 1 (`motions::slope`).
//!
//! Error: a few roundings of the terms above; `tests/laws/stone.rs` checks it against references of 25 digits,
//! from equations in the laboratory frame.

use crate::laws::body::Rim;
use crate::laws::contact::JAMMED;
use crate::laws::contact::patch::rubs;
use crate::laws::loss::{Couple, Couples, Holds, Kinematics};
use crate::methods::SHORT_CODE;
use crate::numbers::Real;
use crate::numbers::vector::{Symmetric, cross, dot, plus};

/// The equations of motion of an ellipsoid on a table with friction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StoneLaw<T> {
    /// The squares of the semi-axes.
    pub squares: [T; 3],
    pub inertia: Symmetric<T>,
    pub inverse: Symmetric<T>,
    pub offset: [T; 3],
    /// The coefficient of friction: mu of Coulomb's law, or c of a viscous film.
    pub strength: T,
    /// The speed of slip below which sigma, the variable of the integration, differs much from time.
    pub soft: T,
    /// Whether the friction is Coulomb's (true) or viscous (false).
    pub dry: bool,
    /// The radius of the patch of contact; None for a point.
    radius: Option<T>,
    /// The tangent of the slope, which falls along x of the laboratory; None on a level table.
    pub tilt: Option<T>,
    /// The losses in addition to friction; None if the stone has none.
    pub losses: Option<Couples<T>>,
}

/// The contact point of a stone and its derivative, along the axes of the stone, with the forces that act on it.
#[derive(Clone, Copy)]
pub(crate) struct Touching<T> {
    pub n: [T; 3],
    /// The upward force that would balance the weight: n on a level table, n - tan(beta) x on a slope.
    pub up: [T; 3],
    pub r: [T; 3],
    pub r_rate: [T; 3],
    /// The couple of the losses; None if there are none.
    pub lost: Option<Couple<T>>,
    /// The motions that dry friction keeps at rest: the drilling w.n, or the rolling and the rocking.
    pub holds: Holds,
}

/// The response of a stone in one state: the derivative of w, and the force and couple of the table.
#[derive(Clone, Copy)]
pub(crate) struct StoneResponse<T> {
    pub w: [T; 3],
    /// The contact force along the axes of the body, in units of the weight.
    pub force: [T; 3],
    /// The normal force N without friction, times a positive factor; the stone lifts off when this number
    /// becomes zero.
    pub free: T,
    /// The factor 1 + (I^-1 (r x f)) x r . n of N, minus [`JAMMED`]; no unique force exists when this number is zero or less.
    pub room: T,
    /// The couple about the vertical: that of a patch of contact, or the couple that holds the drilling at rest.
    pub couple: T,
    /// The horizontal couple that holds the rolling and the rocking at rest, if they are held.
    pub kept: T,
}

impl<T: Real> StoneLaw<T> {
    pub fn new(squares: [T; 3], inertia: Symmetric<T>, offset: [T; 3], strength: T, dry: bool) -> Self {
        let inverse = inertia.inverse();
        let one = strength.splat(1.0);
        let reach = squares[0].max(squares[1]).max(squares[2]) + dot(offset, offset);
        let [x, y, z, ..] = inverse.0;
        // Friction changes the slip by about `soft` in a quarter of the unit of time.
        let soft = strength * (one + reach * (x + y + z)) * one.splat(0.25);
        Self {
            squares,
            inertia,
            inverse,
            offset,
            strength,
            soft,
            dry,
            radius: None,
            tilt: None,
            losses: None,
        }
    }

    /// Returns this law for a patch of this radius.
    #[must_use]
    pub fn with_patch(self, radius: Option<T>) -> Self {
        Self { radius, ..self }
    }

    /// The radius of the patch of contact; None for a point. The code for web pages has no patches.
    #[inline(always)]
    pub fn patch(&self) -> Option<T> {
        if SHORT_CODE { None } else { self.radius }
    }

    /// Returns this law with another coefficient of friction, that of the present speed of the slip.
    #[must_use]
    pub fn with_strength(self, strength: T) -> Self {
        Self { strength, ..self }
    }

    /// Returns this law on a table whose slope has this tangent.
    #[must_use]
    pub fn with_tilt(self, tilt: Option<T>) -> Self {
        Self { tilt, ..self }
    }

    /// Returns this law with losses in addition to friction.
    #[must_use]
    pub fn with_losses(self, losses: Option<Couples<T>>) -> Self {
        Self { losses, ..self }
    }

    /// Returns this law with numbers of another type.
    pub fn map<U: Real>(&self, f: impl Fn(T) -> U) -> StoneLaw<U> {
        let &Self { squares, inertia, offset, strength, dry, .. } = self;
        StoneLaw::new(squares.map(&f), Symmetric(inertia.0.map(&f)), offset.map(&f), f(strength), dry)
            .with_patch(self.radius.map(&f))
            .with_tilt(self.tilt.map(&f))
            .with_losses(self.losses.as_ref().map(|losses| losses.map(&f)))
    }

    /// The contact point of a stone with the vertical `n` and the angular velocity `w`, on a level table.
    #[inline(always)]
    pub fn touching(&self, n: [T; 3], w: [T; 3]) -> Touching<T> {
        let by = |v: [T; 3]| [self.squares[0] * v[0], self.squares[1] * v[1], self.squares[2] * v[2]];
        let (wide, n_rate) = (by(n), cross(n, w));
        let per = n[0].splat(1.0) / dot(n, wide).sqrt();
        let turn = dot(wide, n_rate) * per * per;
        let r = core::array::from_fn(|i| -(wide[i] * per) - self.offset[i]);
        let moved = by(n_rate);
        let r_rate = core::array::from_fn(|i| (wide[i] * turn - moved[i]) * per);
        Touching { n, up: n, r, r_rate, lost: None, holds: Holds::default() }
    }

    /// The contact point of a stone on a level or tilted table; `lab` has the axes x, y, z of the laboratory along
    /// those of the stone.
    #[inline(always)]
    pub fn meeting(&self, lab: &[[T; 3]; 3], w: [T; 3]) -> Touching<T> {
        let at = self.touching(lab[2], w);
        match self.tilt {
            Some(tilt) => Touching { up: plus(at.n, -tilt, lab[0]), ..at },
            None => at,
        }
    }

    /// The arguments of the loss laws for a stone with the angular velocity `w`: those of an upright disk, whose e1 is
    /// the vertical, and whose e2 and e3 are the axes x and y of the laboratory.
    #[inline(always)]
    pub fn kinematics(losses: &Couples<T>, lab: &[[T; 3]; 3], w: [T; 3]) -> Kinematics<T> {
        let (zero, one) = (w[0].splat(0.0), w[0].splat(1.0));
        let [x, y, z] = [dot(lab[0], w), dot(lab[1], w), dot(lab[2], w)];
        losses.seen(&Rim { ell: zero, a: one, rho: zero }, (one, zero), z, [z, x, y])
    }

    /// Returns the contact point `at` with the couple of the losses added.
    #[inline(always)]
    pub fn losing(&self, at: Touching<T>, lab: &[[T; 3]; 3], w: [T; 3]) -> Touching<T> {
        let Some(losses) = &self.losses else { return at };
        let Couple { free, pressed } = losses.at(&Self::kinematics(losses, lab, w));
        let own = |[z, x, y]: [T; 3]| plus(plus(lab[2].map(|a| z * a), x, lab[0]), y, lab[1]);
        let lost = Couple { free: own(free), pressed: own(pressed) };
        Touching { lost: Some(lost), holds: losses.holds(), ..at }
    }

    /// The response of a stone that rolls without slip. The compiler drops the force if it is not used.
    #[inline(always)]
    pub fn rolling(&self, at: &Touching<T>, w: [T; 3]) -> StoneResponse<T> {
        self.resting(at, w, at.holds.drilling)
    }

    /// The response of a stone that rolls without slip. If `held`, a couple about the vertical keeps its drilling w.n constant.
    #[inline(always)]
    pub fn resting(&self, at: &Touching<T>, w: [T; 3], held: bool) -> StoneResponse<T> {
        if at.holds.rolling {
            return self.stays(at, w, None, None, !held);
        }
        let &Touching { n, up, r, r_rate, lost, .. } = at;
        let one = n[0].splat(1.0);
        let carried = cross(w, plus(r_rate, one, cross(w, r)));
        let mut couple = plus(cross(self.inertia.times(w), w), one, cross(r, plus(up, -one, carried)));
        if let Some(lost) = &lost {
            couple = plus(couple, one, lost.free);
        }
        let [a, b, c, d, e, f] = self.inertia.0;
        let [x, y, z] = r;
        let whole = Symmetric([
            a + y.mac(y, z * z),
            b + x.mac(x, z * z),
            c + x.mac(x, y * y),
            d - y * z,
            e - x * z,
            f - x * y,
        ]);
        let mut dw = whole.solve(couple);
        let (mut kept, mut room) = (one.splat(0.0), one);
        let gives = if held { whole.solve(n) } else { n };
        if held {
            kept = -(dot(dw, n) / dot(gives, n));
            dw = plus(dw, kept, gives);
        }
        if let Some(lost) = &lost {
            let mut turned = whole.solve(lost.pressed);
            let mut twist = one.splat(0.0);
            if held {
                twist = -(dot(turned, n) / dot(gives, n));
                turned = plus(turned, twist, gives);
            }
            let factor = one + dot(cross(turned, r), n);
            // After a lift-off the normal force is zero.
            let normal = ((one - dot(plus(carried, one, cross(dw, r)), n)) / factor).positive_part();
            (dw, kept) = (plus(dw, normal, turned), normal.mac(twist, kept));
            room = factor - one.splat(JAMMED);
        }
        let force = plus(plus(up, -one, carried), -one, cross(dw, r));
        StoneResponse { w: dw, force, free: dot(force, n), room, couple: kept, kept: one.splat(0.0) }
    }

    /// The response to the friction force -strength N `pull`, where `pull` is horizontal.
    #[inline(always)]
    pub fn pulled(&self, at: &Touching<T>, w: [T; 3], pull: [T; 3]) -> StoneResponse<T> {
        self.response_to_pull_and_twist(at, w, pull, None)
    }

    /// The response to the friction force -strength N `pull` and to a couple `twist` N about the vertical.
    #[inline(always)]
    fn response_to_pull_and_twist(
        &self,
        at: &Touching<T>,
        w: [T; 3],
        pull: [T; 3],
        twist: Option<T>,
    ) -> StoneResponse<T> {
        if at.holds.rolling {
            return self.stays(at, w, Some(pull), twist, !at.holds.drilling);
        }
        let &Touching { n, r, r_rate, .. } = at;
        let one = n[0].splat(1.0);
        let mut still = self.inverse.times(cross(self.inertia.times(w), w));
        let (mut keeps, mut twists) = (one.splat(0.0), one.splat(0.0));
        if let Some(lost) = &at.lost {
            still = plus(still, one, self.inverse.times(lost.free));
        }
        if at.holds.drilling {
            (still, keeps) = self.without_drilling(n, still);
        }
        let carried = plus(cross(w, plus(r_rate, one, cross(w, r))), one, cross(still, r));
        let f = plus(n, -self.strength, pull);
        let mut lever = cross(r, f);
        if let Some(lost) = &at.lost {
            lever = plus(lever, one, lost.pressed);
        }
        let mut turned = self.inverse.times(twist.map_or(lever, |twist| plus(lever, twist, n)));
        if at.holds.drilling {
            (turned, twists) = self.without_drilling(n, turned);
        }
        let factor = one + dot(cross(turned, r), n);
        let free = one - dot(carried, n);
        let normal = free / factor;
        StoneResponse {
            w: plus(still, normal, turned),
            force: f.map(|x| x * normal),
            free,
            room: factor - one.splat(JAMMED),
            couple: twist.map_or(normal.mac(twists, keeps), |twist| twist * normal),
            kept: one.splat(0.0),
        }
    }

    /// The response of a stone that only turns about the vertical, since its rolling and its rocking are held, so that
    /// N = 1. Either the contact point is at rest and the centre of mass moves on a circle, or the force is n - `pull`,
    /// with the couple `twist` about the vertical.
    #[inline(always)]
    fn stays(
        &self,
        at: &Touching<T>,
        w: [T; 3],
        pull: Option<[T; 3]>,
        twist: Option<T>,
        drills: bool,
    ) -> StoneResponse<T> {
        let &Touching { n, up, r, .. } = at;
        let (zero, one) = (n[0].splat(0.0), n[0].splat(1.0));
        let pivots = pull.is_none();
        // Without the derivative of w.
        let carried = if pivots { cross(w, cross(w, r)) } else { [zero; 3] };
        let fixed =
            plus(plus(if pivots { up } else { n }, -one, carried), -self.strength, pull.unwrap_or([zero; 3]));
        let mut couple = plus(cross(self.inertia.times(w), w), one, cross(r, fixed));
        if let Some(lost) = &at.lost {
            couple = plus(couple, one, lost.under(one));
        }
        if let Some(twist) = twist {
            couple = plus(couple, twist, n);
        }
        // The couple per w', of which a part acts by the force that moves the centre.
        let circle = cross(n, r);
        let moves = if pivots { circle } else { [zero; 3] };
        let needs = plus(self.inertia.times(n), one, cross(r, moves));
        let turn = if drills { dot(couple, n) / dot(needs, n) } else { zero };
        let left = plus(needs.map(|x| x * turn), -one, couple);
        let about = dot(left, n);
        let across = plus(left, -about, n);
        let force = plus(fixed, -turn, moves);
        StoneResponse {
            w: n.map(|x| x * turn),
            force,
            free: one,
            room: one,
            couple: twist.unwrap_or(about),
            kept: (dot(across, across) + one.splat(1e-300)).sqrt(),
        }
    }

    /// Adds to w' the effect of a couple about the vertical that keeps the drilling w.n constant; also returns this couple.
    fn without_drilling(&self, n: [T; 3], turn: [T; 3]) -> ([T; 3], T) {
        let gives = self.inverse.times(n);
        let kept = -(dot(turn, n) / dot(gives, n));
        (plus(turn, kept, gives), kept)
    }

    /// The response of a stone whose contact point slips with the velocity u; also dt/dsigma, for the variable sigma of
    /// the integration.
    #[inline(always)]
    pub fn slipping(&self, at: &Touching<T>, w: [T; 3], u: [T; 3]) -> (StoneResponse<T>, T) {
        let one = u[0].splat(1.0);
        if !self.dry {
            return (self.pulled(at, w, u), one);
        }
        if let Some(patch) = self.patch() {
            return self.on_patch(at, w, u, patch);
        }
        let speed = dot(u, u).sqrt();
        let per = one / speed;
        (self.pulled(at, w, u.map(|x| x * per)), speed / (speed + self.soft))
    }

    /// The response of a stone that slips on a patch of contact; also dt/dsigma, for the variable sigma of the integration.
    #[inline(never)]
    fn on_patch(&self, at: &Touching<T>, w: [T; 3], u: [T; 3], patch: T) -> (StoneResponse<T>, T) {
        let [share, twist, size] = rubs(dot(u, u).sqrt(), dot(w, at.n), patch);
        let to = self.response_to_pull_and_twist(at, w, u.map(|x| x * share), Some(self.strength * twist));
        (to, size / (size + self.soft))
    }

    /// The derivative of the slip in the laboratory frame, with components along the axes of the body.
    #[inline(always)]
    pub fn slip_rate(&self, at: &Touching<T>, w: [T; 3], to: &StoneResponse<T>) -> [T; 3] {
        let &Touching { up, r, r_rate, .. } = at;
        let one = up[0].splat(1.0);
        let carried = cross(w, plus(r_rate, one, cross(w, r)));
        plus(plus(plus(to.force, -one, up), one, carried), one, cross(to.w, r))
    }

    /// The acceleration of the contact point under the contact force `f`, along the axes of the body.
    pub fn yields(&self, at: &Touching<T>, f: [T; 3]) -> [T; 3] {
        plus(f, f[0].splat(1.0), self.swings(at, cross(at.r, f)))
    }

    /// The acceleration of the contact point under this couple, along the axes of the body.
    pub fn swings(&self, at: &Touching<T>, couple: [T; 3]) -> [T; 3] {
        let turned = self.inverse.times(couple);
        cross(if at.holds.drilling { self.without_drilling(at.n, turned).0 } else { turned }, at.r)
    }

    /// The inverse inertia of the contact point: its acceleration per horizontal force, along x and y of the laboratory.
    pub fn light(&self, at: &Touching<T>, lab: &[[T; 3]; 3]) -> [[T; 3]; 3] {
        let per = lab.map(|axis| self.yields(at, axis));
        lab.map(|axis| per.map(|per| dot(axis, per)))
    }

    /// Kinetic and potential energy of a stone whose contact point has the velocity `u`; heights are above the table.
    pub fn energy(&self, at: &Touching<T>, w: [T; 3], u: [T; 3]) -> T {
        let v = plus(u, -u[0].splat(1.0), cross(w, at.r));
        w[0].splat(0.5) * (dot(w, self.inertia.times(w)) + dot(v, v)) - dot(at.r, at.n)
    }
}

/// The axes of the laboratory, of which the third is the vertical, in components along the axes of a body with the
/// unit quaternion (w, x, y, z).
#[inline(always)]
pub(crate) fn laboratory<T: Real>([w, x, y, z]: [T; 4]) -> [[T; 3]; 3] {
    let (ww, xx, yy, zz) = (w * w, x * x, y * y, z * z);
    let two = |a: T| a + a;
    [
        [ww + xx - yy - zz, two(x * y - w * z), two(x * z + w * y)],
        [two(x * y + w * z), ww - xx + yy - zz, two(y * z - w * x)],
        [two(x * z - w * y), two(y * z + w * x), ww - xx - yy + zz],
    ]
}

/// The derivative of the unit quaternion of a body with the angular velocity (a, b, c) along the axes of the body.
#[inline(always)]
pub(crate) fn turning<T: Real>([w, x, y, z]: [T; 4], [a, b, c]: [T; 3]) -> [T; 4] {
    let half = w.splat(0.5);
    [
        -(half * dot([x, y, z], [a, b, c])),
        half * (w * a + (y * c - z * b)),
        half * (w * b + (z * a - x * c)),
        half * (w * c + (x * b - y * a)),
    ]
}

/// The horizontal vector with the components a and b along x and y of the laboratory, in components along the axes of the body.
#[inline(always)]
pub(crate) fn across<T: Real>(lab: &[[T; 3]; 3], [a, b]: [T; 2]) -> [T; 3] {
    plus(lab[0].map(|x| x * a), b, lab[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_forces_at_a_stone_differ_by_what_the_contact_point_yields_also_where_the_drilling_is_held() {
        let inertia = Symmetric([0.2, 0.3, 0.35, -0.015, 0.02, 0.01]);
        let law = StoneLaw::new([1.0, 0.64, 0.36], inertia, [0.03, -0.02, -0.1], 0.3, true);
        let lab = laboratory([0.8, 0.36, -0.48, 0.0]);
        let w = across(&lab, [1.3, -0.7]);
        for drilling in [false, true] {
            let held = Holds { drilling, ..Holds::default() };
            let at = Touching { holds: held, ..law.touching(lab[2], w) };
            let [(one, here), (other, there)] = [[0.6, 0.8], [-1.0, 0.0]].map(|way| {
                let to = law.pulled(&at, w, across(&lab, way));
                (to.force, (law.slip_rate(&at, w, &to), dot(to.w, at.n)))
            });
            let yields = law.yields(&at, plus(one, -1.0, other));
            for (i, yields) in yields.into_iter().enumerate() {
                assert!((here.0[i] - there.0[i] - yields).abs() < 1e-14, "{drilling}: {yields}");
            }
            // No force makes a stone drill whose drilling is held.
            assert_eq!(here.1.abs().max(there.1.abs()) < 1e-14, drilling);
        }
    }
}
