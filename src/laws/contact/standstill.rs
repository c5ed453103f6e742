//! A contact point with zero slip: whether it sticks, slips or lifts off, or whether its behaviour is not unique.
//!
//! ```text
//! sticks     N_roll > 0 and |F_roll| <= mu_s N_roll
//! slips off  along alpha with f(alpha) = cos alpha u_2' - sin alpha u_h' = 0 and lambda = cos alpha u_h' + sin alpha u_2' > 0
//! f (1 - eps cos alpha) = (1 - eps cos alpha)(B_2 cos alpha - B_h sin alpha)
//!                       - N0 sin alpha (mu (D_2 - D_h) cos alpha + g h/I1)
//!                       + N0 (cos alpha (L mN_1/I1 - A mN_3/I3) + sin alpha h mN_2/I1)         losses
//! D_h = 1 + h^2/I1,   D_2 = 1 + L^2/I1 + A^2/I3,   B = u' without friction and without the tilting by N
//! ```
//! The direction of a small slip obeys |u| alpha' = f(alpha), so that a slip begins, and ends, in a direction
//! where f vanishes: a root of a quartic in tan(alpha/2), all of which are computed. Below 0.9 mu_P(theta)
//! each of 87,500 random states has one consistent behaviour. Above, and for bodies with little transverse
//! inertia, all of them are counted, and more than one is an error (Painleve 1895).
//!
//! Error: alpha is known to 1e-15 divided by the slope of f.

use super::lossy::Lossy;
use super::slip::{Friction, Slipping, painleve};
pub(crate) use super::together::Standstill;
use super::together::{Rubs, Together};
use super::{Contact, Force, force};
#[cfg(feature = "many")]
use super::{force_at, reduced::Rates};
use crate::laws::body::Body;
#[cfg(feature = "many")]
use crate::laws::body::Shape;
use crate::laws::loss::{Couple, Couples, OwnCouple, UnderCouple};
use crate::laws::state::State;
use crate::methods::roots::Trig;
use crate::numbers::Sum;
use core::f64::consts::{FRAC_PI_2, PI};

/// From this fraction of mu_P(theta) on, more than one behaviour may be consistent, and all behaviours are counted.
const DOUBTFUL_SHARE_OF_PAINLEVE: f64 = 0.9;
/// Largest growth rate of the speed of a slip that counts as zero, since it may be a rounding error.
const GROWTH_ROUNDING: f64 = 1e-11;
/// Largest growth rate of a slip that counts as zero just after static friction has ceased to hold, at a time that is rounded.
const GROWTH_ROUNDING_AT_RELEASE: f64 = 1e-8;

/// The forces at a contact point at rest, and the rates of a slip from rest, which decide whether the point sticks.
pub(crate) struct HeldContact<F: Fn(f64) -> Option<f64>> {
    /// The coefficient of sliding friction and that of static friction.
    pub mu: [f64; 2],
    /// The normal force if there were no friction.
    pub free: f64,
    /// The normal force and the friction that keep the contact point at rest.
    pub held: [f64; 2],
    /// The direction opposite to the friction that keeps the contact point at rest, as an angle from e_h to e2.
    pub against: f64,
    /// Whether more than one force may obey the law of friction.
    pub doubtful: bool,
    /// The rates at which a slip begins from rest.
    pub onset: Onset,
    /// The growth rate of the speed of a slip along alpha; None where the normal force is not positive.
    pub growth: F,
}

impl<F: Fn(f64) -> Option<f64>> HeldContact<F> {
    /// Directions in which the contact point may slip off, each with the growth rate of its speed.
    fn slip_directions(&self) -> Vec<(f64, f64)> {
        let all = self.onset.directions().into_iter();
        all.filter_map(|alpha| (self.growth)(alpha).map(|growth| (alpha, growth))).collect()
    }

    /// The behaviour of the contact point: sticking, slipping in a direction, lift-off, or not unique.
    pub fn decides(&self) -> Standstill {
        let &Self { mu: [mu, fixed], free, held: [normal, friction], doubtful, .. } = self;
        let holds = |mu: f64| normal > 0.0 && friction <= mu * normal;
        // Sticking is tested before lift-off: with static friction N can be positive where it is not with
        // sliding friction.
        if !doubtful && holds(fixed) {
            return Standstill::Sticks;
        }
        if !doubtful && free <= 0.0 {
            return Standstill::LiftsOff;
        }
        let mut ways = self.slip_directions();
        if !doubtful {
            // Rounding may split one direction into several; the direction of the fastest growth is used.
            let best = ways.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
            return best.filter(|way| way.1 > -GROWTH_ROUNDING).map_or(
                Standstill::Undefined,
                |(alpha, growth)| Standstill::Slips { alpha, growth: growth.max(0.0) },
            );
        }
        ways.retain(|way| way.1 > GROWTH_ROUNDING);
        let lifts = usize::from(free <= 0.0);
        if holds(fixed) {
            // A contact point that only static friction can hold may also slip off in one direction: it
            // sticks.
            let allowed = usize::from(!holds(mu));
            return if lifts + ways.len() > allowed { Standstill::Undefined } else { Standstill::Sticks };
        }
        match (lifts + ways.len(), ways.first()) {
            (1, Some(&(alpha, growth))) => Standstill::Slips { alpha, growth },
            (1, None) => Standstill::LiftsOff,
            _ => Standstill::Undefined,
        }
    }

    /// The direction in which the contact point slips off when static friction has just ceased to hold it.
    pub fn lets_go(mut self) -> Standstill {
        let [mu, fixed] = self.mu;
        if fixed == mu {
            // The two coefficients agree: the slip begins against the friction, and the growth of its speed
            // starts from zero.
            let another = self.doubtful
                && (self.free <= 0.0
                    || self.slip_directions().iter().any(|way| way.1 > GROWTH_ROUNDING_AT_RELEASE));
            let slips = Standstill::Slips { alpha: self.against, growth: 0.0 };
            return if another { Standstill::Undefined } else { slips };
        }
        self.mu = [mu; 2];
        match self.decides() {
            Standstill::Sticks => Standstill::Undefined,
            found => found,
        }
    }
}

/// Whether a contact point at rest certainly sticks if static friction can hold it, under sliding friction `mu`.
///
/// The contact point could slip off in a direction e as well, only where (lambda + mu N A) e = -A F, with lambda, N >
/// 0, the friction F that holds the point, and a positive A = diag(D_h - k g h/I1, D_2), k = g h/(I1 + g^2). In this
/// case mu N < |F|, while N = N0/(1 - mu k cos alpha) is at least N0/(1 + mu |k|).
#[cfg(feature = "many")]
pub(crate) fn is_certain(shape: &Shape<f64>, y: &State, mu: f64) -> bool {
    let (slipping, angle) = (Slipping::of(shape, mu, true), y.theta.sin_cos());
    let limit = slipping.painleve(angle);
    if mu < DOUBTFUL_SHARE_OF_PAINLEVE * limit {
        return true;
    }
    let free = slipping.towards(angle, [y.w1, y.w2, y.w3], [0.0; 2], [0.0; 2]).force[0];
    let rates = Rates::of(Contact::Rolling, shape, shape.rim.rho != 0.0);
    let held = force_at(rates.reduced(), y, &rates.derivative(y, angle), angle).friction();
    held * (1.0 + mu / limit) < (1.0 - GROWTH_ROUNDING_AT_RELEASE) * mu * free
}

/// The motions at rest of a body whose slip is zero, if dry losses resist motions other than the slip; and whether more
/// than one behaviour may be consistent.
fn together(body: &Body, y: &State, mu: f64, of: Option<&UnderCouple>) -> Option<(Together, bool)> {
    let (angle, w) = (y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
    let found = Together::of_body(&body.shape(), of?, (angle, w), [0.0; 2], Rubs::Rests)?;
    Some((found, mu >= DOUBTFUL_SHARE_OF_PAINLEVE * painleve(body, y.theta)))
}

/// These losses with a user-defined couple as a linear function of the normal force, for a body that rolls.
fn linear<G: OwnCouple<f64>>(body: &Body, y: &State, of: Option<Couples<f64, G>>) -> Option<UnderCouple> {
    of.map(|losses| Lossy { rates: Contact::Rolling.rates(body), losses }.linear(y))
}

/// The behaviour of a contact point whose slip is zero, for a body with these losses.
pub(crate) fn standstill<G: OwnCouple<f64>>(
    body: &Body,
    y: &State,
    friction: &Friction,
    of: Option<Couples<f64, G>>,
) -> Standstill {
    let Friction::Coulomb { mu, fixed, .. } = *friction else { return Standstill::Sticks };
    let of = linear(body, y, of);
    match together(body, y, mu, of.as_ref()) {
        Some((together, doubtful)) => together.standstill([mu, fixed], doubtful),
        None => forces_at_rest(body, y, (friction, [mu, fixed]), of).decides(),
    }
}

/// The direction in which a contact point slips off when static friction has just ceased to hold it.
pub(crate) fn let_go<G: OwnCouple<f64>>(
    body: &Body,
    y: &State,
    friction: &Friction,
    of: Option<Couples<f64, G>>,
) -> Standstill {
    let Friction::Coulomb { mu, fixed, .. } = *friction else { return Standstill::Sticks };
    let of = linear(body, y, of);
    match together(body, y, mu, of.as_ref()) {
        Some((together, doubtful)) => together.lets_go([mu, fixed], doubtful),
        None => forces_at_rest(body, y, (friction, [mu, fixed]), of).lets_go(),
    }
}

/// The forces at the contact point of a rim at rest.
fn forces_at_rest(
    body: &Body,
    y: &State,
    (friction, mu): (&Friction, [f64; 2]),
    losses: Option<UnderCouple>,
) -> HeldContact<impl Fn(f64) -> Option<f64>> {
    let slipping = Slipping::on(body, friction).with_losses(losses);
    let (angle, w) = (y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
    let rolling = sticking_force(body, y, losses);
    let free = slipping.towards(angle, w, [0.0; 2], [0.0; 2]).force[0];
    HeldContact {
        mu,
        free,
        held: [rolling.normal, rolling.friction()],
        against: f64::atan2(-rolling.along, -rolling.across),
        doubtful: mu[0] >= DOUBTFUL_SHARE_OF_PAINLEVE * slipping.painleve(angle),
        onset: onset(&slipping, angle, w, free),
        growth: move |alpha| {
            let [cos, sin] = towards(alpha);
            let at = slipping.towards(angle, w, [0.0; 2], [cos, sin]);
            (at.force[0] > 0.0).then_some(cos * at.u[0] + sin * at.u[1])
        },
    }
}

/// The contact force [`Force`] that keeps the contact point at rest.
fn sticking_force(body: &Body, y: &State, losses: Option<UnderCouple>) -> Force {
    let Some(losses) = losses else { return force(Contact::Rolling, body, y) };
    Lossy { rates: Contact::Rolling.rates(body), losses }.moves(y).1
}

/// Cosine and sine of a direction; the direction pi or -pi gives exactly (-1, 0).
pub(crate) fn towards(alpha: f64) -> [f64; 2] {
    if alpha.abs() == PI { [-1.0, 0.0] } else { [alpha.cos(), alpha.sin()] }
}

/// The rate of the slip of a contact point at rest, along two horizontal axes: u' = bare + N (pressed - mu pulled e), N
/// = free/(1 - eps.e). The slip begins in the direction e = (cos alpha, sin alpha).
pub(crate) struct Onset {
    pub mu: f64,
    pub free: f64,
    pub eps: [f64; 2],
    /// The rate of the slip if the table exerted no force.
    pub bare: [f64; 2],
    /// The rate of the slip per normal force, which is added to `bare`.
    pub pressed: [Sum<f64>; 2],
    /// The rate of the slip per horizontal force: the elements 11, 22 and 12 of a symmetric matrix.
    pub pulled: [f64; 3],
}

impl Onset {
    /// All directions in (-pi, pi] in which f, the rate |u| alpha' at which the slip turns, vanishes: a vanishing slip
    /// keeps these.
    fn directions(&self) -> Vec<f64> {
        let &Self { mu, free, eps: [eps_1, eps_2], bare: [b_1, b_2], pressed: [p_1, p_2], pulled } = self;
        let [apart, skew] = [mu * (pulled[1] - pulled[0]), mu * pulled[2]];
        // The zeros in (0, pi) are those of f; for the zeros in (-pi, 0) the sine changes its sign.
        let value = |(s, c): (f64, f64)| {
            let pushed = free * (c * p_2.hi - skew * (c * c - s * s));
            (1.0 - eps_1 * c - eps_2 * s) * (b_2 * c - b_1 * s) - free * s * (apart * c + p_1.hi) + pushed
        };
        let mut found = Vec::new();
        for side in [1.0, -1.0] {
            let (sin, cos) = (&Trig::sin() * &Trig::of(side), Trig::cos());
            let times = |x: &Trig, a: f64| x * &Trig::of(a);
            let mut pressed = &Trig::of(1.0) - &times(&cos, eps_1);
            if eps_2 != 0.0 {
                pressed = &pressed - &times(&sin, eps_2);
            }
            let turned = &times(&cos, b_2) - &times(&sin, b_1);
            let tilted = &times(&cos, apart) + &Trig::of(p_1);
            let mut all = &(&pressed * &turned) - &times(&(&sin * &tilted), free);
            if p_2.hi != 0.0 {
                all = &all + &times(&(&cos * &Trig::of(p_2)), free);
            }
            if skew != 0.0 {
                let double = &(&cos * &cos) - &(&sin * &sin);
                all = &all - &times(&double, free * skew);
            }
            found.extend(all.angles().into_iter().map(|alpha| side * alpha));
            if value((side, 0.0)) == 0.0 {
                found.push(side * FRAC_PI_2);
            }
        }
        if b_2 == 0.0 && p_2.hi == 0.0 && skew == 0.0 {
            found.extend([0.0, PI]);
        }
        found
    }
}

/// The rates at which the slip of a rim begins, along e_h and e2.
fn onset(slipping: &Slipping<f64, Option<Couple<f64>>>, angle: (f64, f64), w: [f64; 3], free: f64) -> Onset {
    let crate::laws::body::Shape { rim, i1, i3 } = slipping.shape;
    let (lever, height) = (rim.lever(angle), rim.height(angle));
    let (depth, radius) = (rim.depth(angle), rim.radius(angle));
    let mu = slipping.strength;
    let pressed = slipping
        .losses
        .map_or([0.0; 3], |losses| losses.at(&losses.seen(&rim, angle, w[0] / angle.0, w)).pressed);
    let eps = mu * lever * height / (i1 + lever * (lever - pressed[1]));
    // `bare` is u' without friction, the normal force, and the losses that are proportional to this force.
    let at = slipping.towards(angle, w, [0.0; 2], [0.0; 2]);
    let (more, aside) = (-(height * pressed[1] / i1), depth * pressed[0] / i1 - radius * pressed[2] / i3);
    let pulled = depth * depth / i1 + radius * radius / i3;
    Onset {
        mu,
        free,
        eps: [eps, 0.0],
        bare: [at.u[0] - free * (lever * height / i1 + more), at.u[1] - free * aside],
        pressed: [Sum::product(lever, height) / Sum::from(i1) + Sum::from(more), aside.into()],
        pulled: [height * height / i1, pulled, 0.0],
    }
}

#[cfg(all(test, feature = "many"))]
mod tests {
    use super::*;
    use crate::laws::loss::Losses;

    #[test]
    fn a_contact_point_that_certainly_sticks_has_no_other_way() {
        let (mut random, mut certain, mut above) = (0.5f64, 0, 0);
        let mut next = || {
            random = (random * 997.0 + 0.123_456_789).fract();
            random
        };
        for _ in 0..20_000 {
            let fillet = if next() < 0.5 { 0.0 } else { 0.5 * next() };
            let body = Body::rounded_tube(fillet + 3.0 * next(), 0.0, fillet).unwrap();
            let [w1, w2, w3] = [(); 3].map(|()| 2.0 * next() - 1.0);
            let y = State { theta: 0.05 + 1.5 * next(), w1, w2, w3 };
            let (mu, held) = (10.0 * next() * next(), force(Contact::Rolling, &body, &y));
            let fixed = mu * (1.0 + next());
            if !is_certain(&body.shape(), &y, mu)
                || held.normal <= 0.0
                || held.friction() > fixed * held.normal
            {
                continue;
            }
            (certain, above) = (certain + 1, above + usize::from(mu > painleve(&body, y.theta)));
            let friction = Friction::Coulomb { mu, fixed, patch: 0.0 };
            assert_eq!(
                standstill(&body, &y, &friction, Couples::with_own(&Losses::NONE, ())),
                Standstill::Sticks,
                "{body:?} {y:?} {mu}"
            );
        }
        assert!(certain > 5000 && above > 500, "{certain} {above}");
    }
}
