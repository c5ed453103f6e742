//! A body that lies on both rims: its forces and accelerations while the rims slip or stick.
//!
//! ```text
//! theta = pi/2, w2 = 0;   the rim to which the state refers touches at +ell e_h, the other one at -ell e_h
//! u = (u_h, u_2),   u' = (u_h, u_2 - 2 ell w1);     v_h = u_h,   v_2 = u_2 - ell w1 + w3
//! N + N' = 1,   ell (N - N') = K - F_h,   K = I3 w1 w3,   F_h the friction of both along e_h
//! I1 w1' = ell (F_2 - F_2') + m1,   I3 w3' = -(F_2 + F_2') + m3,   v_h' = F_h + w1 v_2,   v_2' = F_2 + F_2' - w1 v_h
//! both slip      F = -N d,  d = mu u/|u| or c u:   N = (ell + K + d_h')/(2 ell + d_h' - d_h)
//! one sticks     v_h = 0,  F_h = -w1 v_2 at that rim alone;  F_2 from u_2' = 0
//! both stick     w1 = 0: a straight line, (1 + I3) w3' = m3, and without losses no friction at all
//! ```
//! The fillet does not enter: both contact points lie 1 below the centre. The couple of the losses is that of one rim
//! at theta = pi/2, once, shared as the normal forces are. A line of contact has an undetermined pressure; the model is
//! that of a tube whose side is slightly hollow, or of a rounded rim. For mu < 2 ell one distribution of the normal
//! forces exists for any velocities (a linear complementarity problem with positive diagonal).
//!
//! Error: a few roundings of the terms written above; a test of `laws` compares with Newton's equations.

use super::slip::Friction;
use crate::laws::body::{Body, Shape};
use crate::laws::loss::{Couples, Holds, Kinematics, Losses};
use crate::numbers::Real;

/// A body that lies on both rims, on a table with friction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lying<T> {
    pub shape: Shape<T>,
    /// The coefficient mu, or c, at the rim from which the state is seen and at the other rim.
    pub strength: [T; 2],
    pub dry: bool,
    pub losses: Option<Couples<T>>,
    /// The couple of a user-defined law in the state for which this law is made.
    pub own: Option<[T; 3]>,
}

/// Forces and accelerations on both rims.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lain<T> {
    /// N, F_2 and F_h at the rim from which the state is seen, and at the other rim.
    pub force: [[T; 3]; 2],
    /// w1' and w3'.
    pub w: [T; 2],
    /// u_h' and u_2'.
    pub u: [T; 2],
    /// The couples m1 and m3 of the losses.
    pub couple: [T; 2],
}

/// The numbers of a body on both rims: w1, w3, u_h and u_2.
pub(crate) type Flat<T> = [T; 4];

/// Returns these numbers as seen from the other rim.
#[inline(always)]
pub(crate) fn from_other<T: Real>(ell: T, [w1, w3, u_h, u_2]: Flat<T>) -> Flat<T> {
    let zero = ell.splat(0.0);
    [w1, zero - w3, zero - u_h, (ell + ell) * w1 - u_2]
}

impl Lying<f64> {
    pub fn on(body: &Body, friction: &Friction, losses: &Losses) -> Self {
        let dry = matches!(*friction, Friction::Coulomb { mu, .. } if mu > 0.0 || friction.sticks());
        let losses = Couples::some(losses);
        let strength = [friction.strength(); 2];
        Self { shape: body.shape(), strength, dry, losses, own: None }
    }

    /// The largest couples with which dry losses hold w1 and w3.
    pub fn limits(&self) -> [f64; 2] {
        // All couples that are not dry vanish at this speed.
        const SLOW: f64 = 1e-100;
        let [m1, _, m3] = Self { own: None, ..*self }.couple([SLOW, SLOW]);
        [m1.abs(), m3.abs()]
    }
}

impl<T: Real> Lying<T> {
    /// These laws in another type of number.
    pub fn map<U: Real>(&self, number: impl Fn(T) -> U) -> Lying<U> {
        Lying {
            shape: self.shape.map(&number),
            strength: self.strength.map(&number),
            dry: self.dry,
            losses: self.losses.as_ref().map(|losses| losses.map(&number)),
            own: self.own.map(|m| m.map(&number)),
        }
    }

    /// The slip of the other rim.
    pub fn other_slip(&self, [w1, _, u_h, u_2]: Flat<T>) -> [T; 2] {
        [u_h, u_2 - (self.shape.rim.ell + self.shape.rim.ell) * w1]
    }

    /// The friction per normal force, with its sign reversed, at a rim of this strength that slips with `u`.
    pub fn drag(&self, strength: T, u: [T; 2]) -> [T; 2] {
        let size = if self.dry { u[0].mac(u[0], u[1] * u[1]).sqrt() } else { u[0].splat(1.0) };
        u.map(|u| strength * u / size)
    }

    /// Whether dry losses hold w1, which drills, and w3, by which the body rolls.
    pub fn held(&self) -> [bool; 2] {
        let Holds { contour, drilling, .. } = self.losses.as_ref().map_or(Holds::default(), Couples::holds);
        [drilling, contour]
    }

    /// The couples m1, m2 and m3 of the losses. Only a user-defined law may have m2, which then takes no power.
    fn couple(&self, w: [T; 2]) -> [T; 3] {
        let [m1, m3] = self.couple_of_losses(w);
        match self.own {
            Some([o1, o2, o3]) => [m1 + o1, o2, m3 + o3],
            None => [m1, m1.splat(0.0), m3],
        }
    }

    fn couple_of_losses(&self, [w1, w3]: [T; 2]) -> [T; 2] {
        let zero = w1.splat(0.0);
        let Some(losses) = &self.losses else { return [zero; 2] };
        let one = w1.splat(1.0);
        let mut seen = Kinematics::of(&self.shape.rim, (one, zero), w1, [w1, zero, w3]);
        if let Some(ways) = &losses.ways {
            // The body can only roll along both rims.
            (seen.signs, seen.only) = ([ways.contour, ways.drilling], Some([zero - ways.contour, zero]));
        }
        let [m1, _, m3] = losses.at(&seen).under(one);
        [m1, m3]
    }

    /// The motion under these normal forces and this friction.
    fn under(&self, [w1, w3, u_h, u_2]: Flat<T>, force: [[T; 3]; 2], [m1, _, m3]: [T; 3]) -> Lain<T> {
        let (ell, i1, i3) = (self.shape.rim.ell, self.shape.i1, self.shape.i3);
        let [[_, low, low_h], [_, up, up_h]] = force;
        let (apart, all) = (ell * (low - up), low + up);
        let zero = w1.splat(0.0);
        let [drilling, rolling] = self.held();
        let m1 = if drilling { zero - apart } else { m1 };
        let m3 = if rolling { all } else { m3 };
        let (d1, d3) = ((apart + m1) / i1, (m3 - all) / i3);
        let aside = u_2 - ell * w1 + w3;
        let u = [low_h + up_h + w1 * aside, all - w1 * u_h + ell * d1 - d3];
        Lain { force, w: [d1, d3], u, couple: [m1, m3] }
    }

    /// Motion with both rims slipping, for the given friction per normal force (sign reversed).
    pub fn slipping_along(&self, y: Flat<T>, [low, up]: [[T; 2]; 2]) -> Lain<T> {
        let [w1, w3, ..] = y;
        let (ell, zero) = (self.shape.rim.ell, w1.splat(0.0));
        let couple = self.couple([w1, w3]);
        let mut lift = self.shape.i3 * w1 * w3;
        if self.own.is_some() {
            lift = lift + couple[1];
        }
        let room = ell + ell + up[0] - low[0];
        let (n, m) = ((ell + lift + up[0]) / room, (ell - lift - low[0]) / room);
        let force = [(n, low), (m, up)].map(|(n, d)| [n, zero - n * d[1], zero - n * d[0]]);
        self.under(y, force, couple)
    }

    /// Motion with both rims slipping.
    pub fn slipping(&self, y: Flat<T>) -> Lain<T> {
        let [low, up] = self.strength;
        let drags = [self.drag(low, [y[2], y[3]]), self.drag(up, self.other_slip(y))];
        self.slipping_along(y, drags)
    }

    /// Motion where the rim from which the state is seen sticks, and the other slips across the axis with friction of the
    /// strength `mu`; `turn` is the sign of w1.
    fn pivots_here(&self, y: Flat<T>, mu: T, turn: f64) -> Lain<T> {
        let [w1, w3, ..] = y;
        let Shape { rim, i1, i3 } = self.shape;
        let (ell, one, zero) = (rim.ell, w1.splat(1.0), w1.splat(0.0));
        let along = zero - w1 * (w3 - ell * w1);
        let couple @ [m1, m2, m3] = self.couple([w1, w3]);
        let mut push = i3 * w1 * w3 - along;
        if self.own.is_some() {
            push = push + m2;
        }
        let lean = push / (ell + ell);
        let half = one.splat(0.5);
        let (n, m) = (half + lean, half - lean);
        let up = mu * m * one.splat(turn);
        let (square, axial) = (ell * ell / i1, if self.held()[1] { zero } else { one / i3 });
        let pull = ell * m1 / i1 - axial * m3;
        let low = zero - ((one + axial - square) * up + pull) / (one + axial + square);
        self.under([w1, w3, zero, zero], [[n, low, along], [m, up, zero]], couple)
    }

    /// Motion where one rim sticks: the other rim if `other`.
    pub fn pivots(&self, y: Flat<T>, other: bool, turn: f64) -> Lain<T> {
        if !other {
            return self.pivots_here(y, self.strength[1], turn);
        }
        let ell = self.shape.rim.ell;
        let back = |[m1, m2, m3]: [T; 3]| [m1, ell.splat(0.0) - m2, ell.splat(0.0) - m3];
        let losses = self.losses.as_ref().map(Couples::with_other_rim_below);
        let seen = Self { own: self.own.map(back), losses, ..*self };
        let Lain { force: [there, here], w: [d1, d3], couple: [m1, m3], .. } =
            seen.pivots_here(from_other(ell, y), self.strength[0], turn);
        let zero = d1.splat(0.0);
        let seen = |[n, across, along]: [T; 3]| [n, zero - across, zero - along];
        // Axes e_h and e2 of the other rim point the other way.
        let force = [seen(here), seen(there)];
        let u = [zero, (ell + ell) * d1];
        Lain { force, w: [d1, zero - d3], u, couple: [m1, zero - m3] }
    }

    /// Motion where both rims stick, and the body rolls straight on.
    pub fn rolls(&self, [_, w3, ..]: Flat<T>) -> Lain<T> {
        let (one, zero) = (w3.splat(1.0), w3.splat(0.0));
        let half = w3.splat(0.5);
        let [m1, m2, m3] = self.couple([zero, w3]);
        let m3 = if self.held()[1] { zero } else { m3 };
        let d3 = m3 / (one + self.shape.i3);
        let mut force = [[half, half * d3, zero]; 2];
        if self.own.is_some() {
            let ell = self.shape.rim.ell;
            let (turns, leans) = (half * m1 / ell, half * m2 / ell);
            force = [[half + leans, half * d3 - turns, zero], [half - leans, half * d3 + turns, zero]];
        }
        Lain { force, w: [zero, d3], u: [zero; 2], couple: [zero, m3] }
    }
}
