//! Slipping: friction acts against the slip of the contact point.
//!
//! ```text
//! v    = (u_h + h w2) e_h + (u_2 - L w1 + A w3) e2 + g w2 z      the centre; u is the slip of the body's point that touches
//! F    = -N d,   d = mu u/|u| (Coulomb 1785) or c u (viscous)    along e_h and e2
//! N    = N0/(1 - eps),   N0 = (I1 (1 - g' w2^2) + g K)/(I1 + g^2),   eps = d_h g h/(I1 + g^2),   K = I3 w1 w3 - I1 ct w1^2
//! u_h' = Fh + (w1/s) v_2 - g w2^2 - h w2'
//! u_2' = F2 - (w1/s) v_h + L w1' - A w3' + rho w2 (s w1 + c w3)
//! phi' = w1/s,   psi' = w3 - ct w1,   P' = (u_h + rho w2) e_h + (u_2 + A psi') e2,   heat' = N d.u
//! ```
//! Here w' comes from [`newton`]. A couple m = m0 + N mN of losses adds m0_2 to K, takes g mN_2 from I1 + g^2, and
//! enters w'. Where dry friction holds the drilling, w_z = s w1 + c w3 is kept by one more couple nu z, with
//! nu = -w_z'/(s^2/I1 + c^2/I3) and |nu| <= length N, on which N does not depend. Only slip along the lean is coupled to
//! N. Where eps reaches 1, no force or more than one keeps the body on the table (Painleve 1895): this can happen for
//! mu >= mu_P(theta) = (I1 + g^2)/|g h|, and such a state is an error. Uniform tubes on sharp rims are safe below mu =
//! sqrt(5)/2. Without losses the sum of heat and energy is constant.
//!
//! Near u = 0 the direction of Coulomb's force turns faster and faster, as 1/|u|. In the variable sigma with
//! dt = |u|/(|u| + soft) dsigma the motion is smooth up to u = 0, and |u| falls as exp(-sigma).
//!
//! Error: a few roundings of the terms written above; a test of `slip` compares them with Newton's equations in three
//! dimensions.
//!
//! ```
//! use spincyl::contact::slip::{Friction, derivative};
//! use spincyl::{Body, Slip, State, loss::Losses};
//!
//! // A hoop on edge whose contact point slips: friction mu N slows down the slip at twice the rate mu.
//! let hoop = Body::tube(0.0, 1.0)?;
//! let state = State { theta: std::f64::consts::FRAC_PI_2, w1: 0.0, w2: 0.0, w3: -3.0 };
//! let (_, slows, force) = derivative(&hoop, &state, Slip::new(0.0, 5.0), &Friction::coulomb(0.25), &Losses::NONE);
//! assert!((force.along + 0.25).abs() < 1e-14 && (slows.u_2 + 0.5).abs() < 1e-14);
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::JAMMED;
use super::patch::rubs;
use crate::error::{Error, within};
use crate::laws::body::{Body, Shape};
use crate::laws::loss::{Couple, Couples, Holds, Law, Losses, OwnCouple, rolling_couple_needed};
use crate::laws::newton::{self, Force};
use crate::laws::state::{Slip, State, drilling_of, rolling_of};
use crate::numbers::{Real, here};

/// A patch of at most this radius, in R, is a point: a motion on a patch differs from that on a point by about its radius.
const LARGEST_POINT_RADIUS: f64 = 1e-16;

/// The law of friction at a contact point that slips or sticks.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub enum Friction {
    /// Dry friction: the force is mu N against the slip, and at most `fixed` times N while the contact point rests.
    Coulomb {
        /// Coefficient of sliding friction, 0 or more and finite.
        mu: f64,
        /// Coefficient of static friction, at least `mu`; it may be infinite.
        #[cfg_attr(feature = "serde", serde(with = "crate::numbers::file"))]
        fixed: f64,
        /// Radius of the patch of contact, below 1: it shares the friction between slip and drilling
        /// ([`patch`](super::patch)). 0 for a point.
        patch: f64,
    },
    /// A viscous film: the force is c N u against the slip, and the contact point never sticks.
    Viscous {
        /// Force per normal force and slip velocity, in 1/sqrt(g R), 0 or more and finite; of a number in s/m it is
        /// [`Scale::metres_per_second`](crate::Scale::metres_per_second).
        c: f64,
    },
}

impl Friction {
    /// Coulomb's law with the same coefficient of sliding and of static friction.
    pub fn coulomb(mu: f64) -> Self {
        Self::Coulomb { mu, fixed: mu, patch: 0.0 }
    }

    /// Checks that each coefficient is in its range.
    ///
    /// # Errors
    /// `OutOfRange`, with the name of the coefficient, for a `mu` or a `c` that is negative or not finite, a static
    /// coefficient below `mu`, and a patch outside [0, 1).
    pub fn check(&self) -> Result<(), Error> {
        let finite = (0.0, f64::MAX);
        match *self {
            Self::Coulomb { mu, fixed, patch } => {
                within("mu", mu, finite, "a finite mu >= 0")?;
                within("static", fixed, (mu, f64::INFINITY), "static >= mu")?;
                within("patch", patch, (0.0, 1.0 - f64::EPSILON), "0 <= patch < 1, in R")?;
            }
            Self::Viscous { c } => {
                within("c", c, finite, "a finite c >= 0")?;
            }
        }
        Ok(())
    }

    /// The coefficient of sliding friction of Coulomb's law, or c of a viscous film.
    pub(crate) fn strength(&self) -> f64 {
        match *self {
            Self::Coulomb { mu, .. } => mu,
            Self::Viscous { c } => c,
        }
    }

    /// The radius of the patch of contact; 0 for a point, and for a patch that differs from a point only by rounding.
    pub(crate) fn patch(&self) -> f64 {
        match *self {
            Self::Coulomb { mu, patch, .. } if mu > 0.0 && patch > LARGEST_POINT_RADIUS => patch,
            _ => 0.0,
        }
    }

    /// Whether static friction can hold the contact point at rest.
    pub(crate) fn sticks(&self) -> bool {
        matches!(*self, Self::Coulomb { fixed, .. } if fixed > 0.0)
    }
}

/// A law for the coefficient of friction as a function of the speed of the slip. The type `()` means a constant, and
/// costs no code.
pub(crate) trait FollowsSpeed<T>: Copy {
    /// The coefficient of dry friction at a speed, or that of a film with the same force; `constant` if it does not vary.
    fn strength(&self, constant: T, speed: impl FnOnce() -> T, dry: bool) -> T;
}

impl<T> FollowsSpeed<T> for () {
    #[inline(always)]
    fn strength(&self, constant: T, _: impl FnOnce() -> T, _: bool) -> T {
        constant
    }
}

/// A body on a table with friction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slipping<T, G = (), L = ()> {
    pub shape: Shape<T>,
    per_i1: T,
    per_i3: T,
    /// The coefficient of friction mu of Coulomb's law, or c of a viscous film.
    pub strength: T,
    /// The speed of slip below which the variable sigma differs much from time.
    pub soft: T,
    /// Whether the friction is Coulomb's, whose force has a direction even where u vanishes.
    pub dry: bool,
    /// The losses in addition to friction; None if the body has none.
    pub losses: Option<Couples<T, G>>,
    /// The radius of the patch of contact; None for a point.
    radius: Option<T>,
    /// The rate at which the table turns; 0 if it does not.
    om: T,
    /// The law of a coefficient that varies with the speed; `strength` is then the coefficient at rest.
    varies: L,
}

/// The accelerations, the contact force and the couples that hold motions at rest, in one state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SlipResponse<T> {
    /// The derivative w' of the angular velocity.
    pub w: [T; 3],
    /// The derivative u' of the slip.
    pub u: [T; 2],
    /// N0 (I1 + g^2), with the N0 of the equations above; where this number vanishes the body lifts off.
    pub free: T,
    /// (1 - eps - [`JAMMED`]) (I1 + g^2), with the eps of the equations above; where it vanishes no unique force exists.
    pub room: T,
    /// The contact force [N, F2, Fh].
    pub force: [T; 3],
    /// The couple about the vertical that holds the drilling at rest, and the largest one that friction can exert.
    pub held: [T; 2],
    /// The couple that holds the contact along the rim, or rolling and rocking, at rest, and the largest one that
    /// friction can exert.
    pub kept: [T; 2],
}

impl<T: Real> Slipping<T> {
    #[inline(always)]
    pub fn of(shape: &Shape<T>, strength: T, dry: bool) -> Self {
        let one = strength.splat(1.0);
        let (per_i1, per_i3) = (one / shape.i1, one / shape.i3);
        let reach = shape.rim.ell.abs() + shape.rim.rho;
        // Friction changes the slip by about `soft` in a quarter of the unit of time.
        let soft = strength * (one + reach * reach * per_i1 + per_i3) * strength.splat(0.25);
        let om = strength.splat(0.0);
        Self {
            shape: *shape,
            per_i1,
            per_i3,
            strength,
            soft,
            dry,
            losses: None,
            radius: None,
            om,
            varies: (),
        }
    }
}

impl<T: Real, G: OwnCouple<T>, L: FollowsSpeed<T>> Slipping<T, G, L> {
    /// Returns this body with a coefficient of friction that is a function of the speed.
    #[must_use]
    pub fn varying<M>(self, varies: M) -> Slipping<T, G, M> {
        let Self { shape, per_i1, per_i3, strength, soft, dry, losses, radius, om, .. } = self;
        Slipping { shape, per_i1, per_i3, strength, soft, dry, losses, radius, om, varies }
    }

    /// Returns this body on a patch of this radius.
    #[must_use]
    pub fn with_patch(self, radius: Option<T>) -> Self {
        Self { radius, ..self }
    }

    /// Returns this body on a table that turns at the rate `om`, if `turns`.
    #[must_use]
    pub fn over(self, om: T, turns: bool) -> Self {
        Self { om, losses: self.losses.map(|losses| losses.over(om, turns)), ..self }
    }

    /// The radius of the patch of contact; None for a point.
    #[inline(always)]
    pub fn patch(&self) -> Option<T> {
        self.radius
    }

    /// The law by which the coefficient of friction varies with the speed.
    pub fn varies(&self) -> &L {
        &self.varies
    }

    /// Returns this body with these losses in addition to friction.
    #[must_use]
    pub fn with_losses<H>(self, losses: Option<Couples<T, H>>) -> Slipping<T, H, L> {
        let Self { shape, per_i1, per_i3, strength, soft, dry, radius, om, varies, .. } = self;
        Slipping { shape, per_i1, per_i3, strength, soft, dry, losses, radius, om, varies }
    }

    /// The response with a couple `push` h/s along the contour that makes psi' change at the rate `rate`; also
    /// dt/dsigma, with the integration variable sigma, and `push`. Neither the normal force nor friction depends on
    /// this couple.
    pub fn settled(&self, (s, c): (T, T), w: [T; 3], u: [T; 2], rate: T) -> (SlipResponse<T>, T, T) {
        let &Shape { rim, i1, i3 } = &self.shape;
        let (mut at, pace) = self.at((s, c), w, u);
        let [d1, _, d3] = at.w;
        let off = s * (s * d3 - c * d1 - w[0] / s * w[1] - s * rate);
        let (push, more1, more3) = if self.losses.as_ref().is_some_and(|losses| losses.holds().drilling) {
            // One more couple, about the vertical, keeps the drilling at rest.
            let (more1, more3) = (c / s * off, -off);
            let twist = s * i1 * more1 + c * i3 * more3;
            at.held[0] = at.held[0] + twist;
            (c * twist - i3 * more3, more1, more3)
        } else {
            let push = off / (s * s / i3 + c * c / i1);
            (push, c / s * push / i1, -push / i3)
        };
        (at.w[0], at.w[2]) = (d1 + more1, d3 + more3);
        at.u[1] = at.u[1] + rim.depth((s, c)) * more1 - rim.radius((s, c)) * more3;
        (at, pace, push)
    }

    /// The response to the friction force F = -strength N pull/size, and dt/dsigma = size/sum, with the variable sigma
    /// of this module. N is the normal force, `strength` the coefficient of friction, and `size` the magnitude of the
    /// vector `pull`, against which friction acts. On a patch of contact the table also exerts the couple `twist` N. A
    /// single division serves all quotients.
    #[inline(always)]
    pub fn with(
        &self,
        (s, c): (T, T),
        w: [T; 3],
        u: [T; 2],
        (pull, size, sum): ([T; 2], T, T),
        strength: T,
        twist: Option<T>,
    ) -> (SlipResponse<T>, T) {
        let Shape { rim, i1, i3 } = &self.shape;
        let ([w1, w2, w3], angle) = (w, (s, c));
        let (lever, slope, height) = (rim.lever(angle), rim.slope(angle), rim.height(angle));
        let (radius, depth) = (rim.radius(angle), rim.depth(angle));
        let (inertia, square, one) = (lever.mac(lever, *i1), w2 * w2, w1.splat(1.0));
        let holds = self.losses.as_ref().map_or(Holds::default(), Couples::holds);
        // The normal force under a couple is size free/left, where `turn` is c w1/s. Where rolling is held, the centre
        // stays at its height, so that N = 1.
        let left_of = here(
            #[inline(always)]
            |couple: Option<&Couple<T>>| {
                let inertia = couple.map_or(inertia, |couple| inertia - lever * couple.pressed[1]);
                let left = size * inertia - strength * pull[0] * lever * height;
                let room = left - s.splat(JAMMED) * size * inertia;
                if holds.rolling { [size; 2] } else { [left, room] }
            },
        );
        let free_of = here(
            #[inline(always)]
            |couple: Option<&Couple<T>>, turn: T| {
                let mut spinning = w1 * (*i3 * w3 - *i1 * turn);
                if let Some(couple) = couple {
                    spinning = spinning + couple.free[1];
                }
                if holds.rolling { one } else { *i1 * (one - slope * square) + lever * spinning }
            },
        );
        let couple = self.losses.as_ref().map(
            #[inline(always)]
            |losses| {
                losses.total_couple(
                    &losses.seen(rim, angle, w1 / s, w),
                    // Only a user-defined law uses this couple.
                    |couple| free_of(Some(couple), c * (w1 / s)) * size / left_of(Some(couple))[0],
                )
            },
        );
        let [left, room] = left_of(couple.as_ref());
        // One division gives 1/s, 1/left and 1/sum.
        let per = one / (s * left * sum);
        let precession = w1 * (per * left * sum);
        let turn = c * precession;
        let free = free_of(couple.as_ref(), turn);
        let share = free * (per * s * sum);
        let grip = strength * share;
        let (across, along) = (-(grip * pull[0]), -(grip * pull[1]));
        let force = [share * size, along, across];
        let [mut t1, mut t2, mut t3] = newton::torque(&self.shape, angle, turn, w, force);
        if let Some(couple) = &couple {
            let [m1, m2, m3] = couple.under(force[0]);
            (t1, t2, t3) = (t1 + m1, t2 + m2, t3 + m3);
        }
        if let Some(twist) = twist {
            // Neither the normal force nor friction depends on a couple about the vertical.
            let couple = twist * force[0];
            (t1, t3) = (t1 + couple * s, t3 + couple * c);
        }
        let mut dw = [t1 * self.per_i1, t2 * self.per_i1, t3 * self.per_i3];
        let mut held = [w1.splat(0.0), w1.splat(1.0)];
        let mut kept = held;
        if let Some(losses) = self.losses.as_ref().filter(|losses| losses.holds() != Holds::default()) {
            let most = |law: Law| losses.coefficient(law) * force[0];
            let turned = [t1, t2, t3];
            if holds.rolling {
                (dw, held[0], kept) = self.stays(
                    angle,
                    turned,
                    holds.drilling,
                    [most(Law::DryContour), most(Law::RollingResistance)],
                );
            } else {
                (dw, held[0], kept[0]) = self.with_motions_held(angle, (w, precession), (dw, turned), holds);
                kept[1] = if holds.contour { most(Law::DryContour) * radius } else { kept[1] };
            }
            held[1] = if holds.drilling { most(Law::Drilling) } else { held[1] };
        }
        let [v_h, v_2] = self.centre(angle, w, u);
        let mut du = [
            across + precession * v_2 - lever * square - height * dw[1],
            along - precession * v_h + depth * dw[0] - radius * dw[2]
                + rim.rho * w2 * drilling_of((s, c), w1, w3),
        ];
        if let Some(pull) = self.losses.as_ref().and_then(|losses| losses.pull) {
            du = [du[0] + pull[0], du[1] + pull[1]];
        }
        (SlipResponse { w: dw, u: du, free, room, force, held, kept }, size * (per * s * left))
    }

    /// w', with the couples that hold the contact along the rim, or the drilling, or both, at rest, computed from w'
    /// without them and from the torque; also the couple about the vertical, and the couple along h/s. Neither the
    /// normal force nor friction depends on these couples.
    #[inline(always)]
    fn with_motions_held(
        &self,
        (s, c): (T, T),
        ([w1, w2, w3], precession): ([T; 3], T),
        ([d1, d2, d3], [t1, _, t3]): ([T; 3], [T; 3]),
        holds: Holds,
    ) -> ([T; 3], T, T) {
        let (give1, give3) = (s * self.per_i1, c * self.per_i3);
        let turn = drilling_of((s, c), d1, d3) - w2 * rolling_of((s, c), w1, w3);
        let off = s * d3 - c * d1 - precession * w2;
        let (mut d1, mut d3) = (d1, d3);
        if holds.contour {
            let [more1, more3] = if holds.drilling {
                [c * off - s * turn, -(s * off) - c * turn]
            } else {
                let push = off / (s * self.per_i3 * s + c * self.per_i1 * c);
                [c * push * self.per_i1, -(s * push * self.per_i3)]
            };
            (d1, d3) = (d1 + more1, d3 + more3);
        } else {
            let push = -(turn / (s * give1 + c * give3));
            return ([d1 + give1 * push, d2, d3 + give3 * push], push, s.splat(0.0));
        }
        // The torque that these couples add to `t1` and `t3`.
        let [m1, m3] = [d1 * self.shape.i1 - t1, d3 * self.shape.i3 - t3];
        ([d1, d2, d3], s * m1 + c * m3, s * (c * m1 - s * m3))
    }

    /// w' of a body whose rolling and rocking are held, from the torque; the couple about the vertical that holds the
    /// drilling, if it is held too; and the horizontal couple of rolling resistance, beyond that of dry friction along
    /// the contour, with its limit. The last argument has the limits of both couples.
    #[inline(always)]
    fn stays(
        &self,
        (s, c): (T, T),
        [t1, t2, t3]: [T; 3],
        drilling: bool,
        [contour, most]: [T; 2],
    ) -> ([T; 3], T, [T; 2]) {
        let Shape { rim, i1, i3 } = &self.shape;
        let twist = s * t1 + c * t3;
        let turn = if drilling { s.splat(0.0) } else { twist / (*i1 * s * s + *i3 * c * c) };
        let (m1, m3) = (*i1 * (s * turn) - t1, *i3 * (c * turn) - t3);
        let needs = rolling_couple_needed([c * m1 - s * m3, -t2], contour * rim.radius((s, c)) / s);
        ([s * turn, s.splat(0.0), c * turn], if drilling { -twist } else { s.splat(0.0) }, [needs, most])
    }

    /// The response where a slip begins in the direction `way`; without friction where `way` is zero.
    #[inline(always)]
    pub fn towards(&self, angle: (T, T), w: [T; 3], u: [T; 2], way: [T; 2]) -> SlipResponse<T> {
        let one = self.strength.splat(1.0);
        self.with(angle, w, u, (way, one, one), self.strength, None).0
    }

    /// Velocity of the centre along e_h and e2.
    #[inline(always)]
    pub fn centre(&self, angle: (T, T), [w1, w2, w3]: [T; 3], [u_h, u_2]: [T; 2]) -> [T; 2] {
        let rim = &self.shape.rim;
        [rim.height(angle).mac(w2, u_h), u_2 - rim.depth(angle) * w1 + rim.radius(angle) * w3]
    }

    /// The coefficient of friction at the slip `u`.
    #[inline(always)]
    pub fn strength_at(&self, u: [T; 2]) -> T {
        self.varies.strength(
            self.strength,
            #[inline(always)]
            || u[0].mac(u[0], u[1] * u[1]).sqrt(),
            self.dry,
        )
    }

    /// The response in a state, and dt/dsigma with the integration variable sigma; under dry friction `u` must not be zero.
    #[inline(always)]
    pub fn at(&self, angle: (T, T), w: [T; 3], u: [T; 2]) -> (SlipResponse<T>, T) {
        // `with` is inlined, so that it is called in one place.
        let (mut size, mut sum) = (self.strength.splat(1.0), self.strength.splat(1.0));
        if self.dry {
            size = u[0].mac(u[0], u[1] * u[1]).sqrt();
            sum = size + self.soft;
        }
        self.with(angle, w, u, (u, size, sum), self.strength_at(u), None)
    }

    /// The response on a patch of contact, dt/dsigma with the integration variable sigma, and the heat from the couple
    /// of the patch per unit of time.
    #[inline(always)]
    pub fn on_patch(&self, (s, c): (T, T), w: [T; 3], u: [T; 2], patch: T) -> (SlipResponse<T>, T, T) {
        // At the stages of a step s^2 + c^2 is not quite 1. The difference, times w^2, would be an acceleration of the
        // slip, which a small patch would answer with all its friction.
        let per = s.splat(1.0) / s.mac(s, c * c).sqrt();
        let (s, c) = (s * per, c * per);
        let drilling = drilling_of((s, c), w[0], w[2]) - self.om;
        let [share, twist, size] = rubs(u[0].mac(u[0], u[1] * u[1]).sqrt(), drilling, patch);
        let pull = u.map(|u| u * share * size);
        let twist = self.strength * twist;
        let (at, pace) = self.with((s, c), w, u, (pull, size, size + self.soft), self.strength, Some(twist));
        (at, pace, -(twist * at.force[0] * drilling))
    }

    /// Writes the derivatives of sine, cosine, w, u, time and, as the ninth number, heat with respect to sigma.
    #[inline(always)]
    pub fn rates<const N: usize>(&self, y: &[T; N], all: &mut [T; N]) -> SlipResponse<T> {
        let (s, c, w, u) = (y[0], y[1], [y[2], y[3], y[4]], [y[5], y[6]]);
        let (at, pace) = self.at((s, c), w, u);
        self.writes(y, all, (&at, pace));
        at
    }

    /// Writes the derivatives with respect to sigma of the variables in `y`, from the response `at` and `pace` = dt/dsigma.
    #[inline(always)]
    pub fn writes<const N: usize>(&self, y: &[T; N], all: &mut [T; N], (at, pace): (&SlipResponse<T>, T)) {
        let (s, c, w, u) = (y[0], y[1], [y[2], y[3], y[4]], [y[5], y[6]]);
        let ([_, along, across], [d1, d2, d3], [a, b]) = (at.force, at.w, at.u);
        let rates = [-(c * w[1]), s * w[1], d1, d2, d3, a, b];
        for (to, rate) in all.iter_mut().zip(rates) {
            *to = pace * rate;
        }
        all[7] = pace;
        if N > 8 {
            all[8] = -(pace * (along * u[1] + across * u[0]));
        }
    }
}

impl Slipping<f64> {
    /// The equations of slipping of a body on a table with this friction.
    pub fn on(body: &Body, friction: &Friction) -> Self {
        let dry = matches!(*friction, Friction::Coulomb { mu, .. } if mu > 0.0 || friction.sticks());
        let patch = friction.patch();
        Self::of(&body.shape(), friction.strength(), dry).with_patch((patch > 0.0).then_some(patch))
    }

    /// The equations of slipping of a body on a table with this friction and these losses.
    pub fn with_losses_on(body: &Body, friction: &Friction, losses: &Losses) -> Self {
        Self::on(body, friction).with_losses(Couples::some(losses))
    }
}

impl<G: OwnCouple<f64>, L: FollowsSpeed<f64>> Slipping<f64, G, L> {
    /// [`Slipping::on_patch`], compiled once.
    #[inline(never)]
    fn on_a_patch(
        &self,
        angle: (f64, f64),
        w: [f64; 3],
        u: [f64; 2],
        patch: f64,
    ) -> (SlipResponse<f64>, f64, f64) {
        self.on_patch(angle, w, u, patch)
    }

    /// The response in a state, dt/dsigma with the integration variable sigma, and the heat from the couple of a patch
    /// per unit of time; 0 for a point.
    #[inline(always)]
    pub fn answers(&self, angle: (f64, f64), w: [f64; 3], u: [f64; 2]) -> (SlipResponse<f64>, f64, f64) {
        match self.patch() {
            Some(patch) => self.on_a_patch(angle, w, u, patch),
            None => {
                let (at, pace) = self.at(angle, w, u);
                (at, pace, 0.0)
            }
        }
    }

    /// The contact force N, F2 and Fh of a body with the state `y` and the slip `u`.
    pub fn force(&self, y: &State, u: [f64; 2]) -> Force {
        let [normal, along, across] = self.answers(y.theta.sin_cos(), [y.w1, y.w2, y.w3], u).0.force;
        Force { normal, along, across }
    }
}

impl<G: OwnCouple<f64>, L: FollowsSpeed<f64>> Slipping<f64, G, L> {
    /// The power of the losses, without that of friction.
    pub fn power(&self, angle: (f64, f64), w: [f64; 3], normal: f64) -> f64 {
        self.losses.map_or(0.0, |losses| {
            losses.power(&losses.seen(&self.shape.rim, angle, w[0] / angle.0, w), normal)
        })
    }

    /// mu_P(theta), the smallest coefficient of friction for which some direction of slip has no unique contact force.
    pub fn painleve(&self, angle: (f64, f64)) -> f64 {
        let (lever, rim) = (self.shape.rim.lever(angle), &self.shape.rim);
        (self.shape.i1 + lever * lever) / (lever * rim.height(angle)).abs()
    }

    /// Kinetic and potential energy in M g R, with heights measured from the table.
    pub fn energy(&self, y: &State, u: [f64; 2]) -> f64 {
        let (angle, w) = (y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
        let [v_h, v_2] = self.centre(angle, w, u);
        newton::energy(&self.shape, angle, w, [v_h, v_2, self.shape.rim.lever(angle) * y.w2])
    }
}

/// mu_P(theta) of a body: from this coefficient of friction on, some direction of slip leaves no unique contact force.
pub fn painleve(body: &Body, theta: f64) -> f64 {
    Slipping::of(&body.shape(), 1.0, true).painleve(theta.sin_cos())
}

/// The horizontal velocity of the centre of mass of a body that slips, in sqrt(g R): along e_h, the direction of the
/// lean, and along e2, across it. With a slip of 0 the contact point is at rest.
pub fn centre_velocity(body: &Body, y: &State, slip: Slip) -> [f64; 2] {
    Slipping::of(&body.shape(), 1.0, true).centre(y.theta.sin_cos(), [y.w1, y.w2, y.w3], slip.pair())
}

/// Vertical velocity, in sqrt(g R), of the centre of mass of a body whose lowest point stays on the table.
pub fn centre_rise(body: &Body, y: &State) -> f64 {
    body.shape().rim.lever(y.theta.sin_cos()) * y.w2
}

/// Kinetic and potential energy of a body that slips, in M g R, with heights measured from the table.
pub fn energy(body: &Body, y: &State, slip: Slip) -> f64 {
    Slipping::of(&body.shape(), 1.0, true).energy(y, slip.pair())
}

/// Time derivative of (theta, w1, w2, w3) and of the slip, and the contact force, of a body that slips.
///
/// The slip must not be zero under Coulomb friction. The formulas give a value even where there is no unique force.
pub fn derivative(
    body: &Body,
    y: &State,
    slip: Slip,
    friction: &Friction,
    losses: &Losses,
) -> (State, Slip, Force) {
    let slipping = Slipping::with_losses_on(body, friction, losses);
    let (at, ..) = slipping.answers(y.theta.sin_cos(), [y.w1, y.w2, y.w3], slip.pair());
    let ([w1, w2, w3], [normal, along, across]) = (at.w, at.force);
    (State { theta: -y.w2, w1, w2, w3 }, at.u.into(), Force { normal, along, across })
}
