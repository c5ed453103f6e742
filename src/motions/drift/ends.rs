//! The end of a drift with the centre at rest, and whether the time to this end is finite.
//!
//! ```text
//! distance x from the end,   P ~ x^p,   E' ~ x^e:    time is finite where 1 + e - p > 0
//! p                  of a law at each end: `POWERS` in its file in `laws::loss`
//! e = 1 where a ball stands at its pole, else 0
//! ```
//! The energy falls during a drift, so that the inclination changes in one direction until the branch of steady
//! states ends or the energy has a minimum. If several laws act, the smallest p decides. The powers p and e are those
//! of the leading terms in `branch`.
//!
//! Error: the inclination of an end has the error of the root from which it comes.

use super::branch::Exact;
use crate::laws::body::Body;
use crate::laws::loss::{Law, Losses};
use crate::numbers::Sum;
use crate::numbers::codes::coded;
use crate::states::steady;
use core::f64::consts::PI;

coded! {
    /// The way in which a drift ends. The number is its code in arrays.
    pub enum End {
        /// The face lands: theta = 0 or pi.
        Face = 0,
        /// The other rim or a cap lands: theta = theta_end.
        Side = 1,
        /// The energy along the branch has a minimum, where the drift stops.
        Lowest = 2,
        /// The body is balanced on a point of its rim: theta = theta0.
        Balanced = 3,
        /// Rolling becomes unstable, kappa = 0: the body begins to nod, and the slow drift is over.
        StabilityLost = 4,
        /// A ball stands upright on its pole.
        Upright = 5,
        /// Only in a drift of rolling: the contact point stops, psi' = 0, and dry friction or rolling resistance
        /// holds it.
        ContactStops = 6,
        /// Only in a drift of rolling: the drilling stops, w_z = 0, and drilling friction holds the body and takes no
        /// more energy.
        DrillingStops = 7,
    }
}

impl End {
    /// The name of the end in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Face => "face lands",
            Self::Side => "lies down",
            Self::Lowest => "lowest state",
            Self::Balanced => "balanced",
            Self::StabilityLost => "stability lost",
            Self::Upright => "stands upright",
            Self::ContactStops => "contact stops",
            Self::DrillingStops => "drilling stops",
        }
    }
}

/// The end that a drift approaches, with its inclination.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Goal {
    pub end: End,
    pub theta: Sum<f64>,
    /// Whether the time to the end is finite.
    pub finite: bool,
    /// The exponent 1 + e - p: the remaining time goes as this power of the distance from the end.
    pub power: f64,
}

/// The first end that the inclination reaches from `theta`, downwards or upwards.
pub(crate) fn goal(of: &Exact, losses: &Losses, theta: f64, down: bool) -> Goal {
    let body = &of.body;
    let range = body.range();
    let (end, last) = if down {
        (if body.is_ball() { End::Upright } else { End::Face }, 0.0)
    } else if range < PI {
        (End::Side, range)
    } else {
        (if body.is_ball() { End::Upright } else { End::Face }, PI)
    };
    let mut near = (end, Sum::from(last));
    let ahead = |x: f64| if down { theta - x } else { x - theta };
    let mut offer = |end: End, x: Sum<f64>| {
        if ahead(x.hi) >= 0.0 && ahead(x.hi) < ahead(near.1.hi) {
            near = (end, x);
        }
    };
    for x in steady::ridge(body) {
        offer(End::Lowest, x.into());
    }
    let balanced = of.balance();
    let standing = Goal::at(body, losses, (End::Balanced, balanced));
    // A critical body keeps turning where it is balanced and passes theta0, unless all its losses resist psi' alone.
    let passes = body.excess() == 0.0 && standing.finite;
    if body.ell() > 0.0 && !body.is_ball() && !passes {
        offer(End::Balanced, balanced);
    }
    Goal::at(body, losses, near)
}

impl Goal {
    fn at(body: &Body, losses: &Losses, (end, theta): (End, Sum<f64>)) -> Self {
        let critical = body.excess() == 0.0;
        let height = if theta.hi == 0.0 { body.ell() + body.fillet() } else { body.fillet() - body.ell() };
        let exponent = |law: Law| match (end, law.powers()) {
            (End::Face, of) => of.face[usize::from(height != 0.0)],
            (End::Balanced, of) if critical => of.critical,
            (End::Balanced, of) => of.balanced,
            (End::Upright, of) => of.upright,
            _ => 0.0,
        };
        let rise = if end == End::Upright || end == End::Lowest { 2.0 } else { 1.0 };
        let some = Law::ALL.iter().copied().filter(|law| losses.coefficients[*law as usize] > 0.0);
        let power = rise - some.fold(f64::INFINITY, |least, law| least.min(exponent(law)));
        Self { end, theta, finite: power > 0.0, power }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The exponent of the power of a law in steady states at the distance x from an end.
    fn exponent(law: Law, body: &Body, at: impl Fn(f64) -> f64) -> f64 {
        let [far, near] = [1e-4, 1e-5].map(|x| {
            let y = steady::state(body, at(x)).unwrap();
            Losses::of(law, 1.0).power(body, &y, 1.0)
        });
        (far / near).log10()
    }

    #[test]
    fn the_power_of_every_law_goes_near_every_end_as_its_file_says() {
        let body = |ell: f64, i1: f64, i3: f64| Body::new(ell, i1, i3).unwrap();
        let (coin, disk, can) = (body(0.0, 0.25, 0.5), body(0.5, 0.33, 0.5), body(2.5, 2.33, 0.5));
        let (critical, ball) = (body(1.0, 0.5, 0.5), Body::ball(-0.3, 0.4, 0.38).unwrap());
        for &law in Law::ALL {
            let of = law.powers();
            let near = |body: &Body| exponent(law, body, |x| x);
            let about = |body: &Body| exponent(law, body, |x| body.theta_balance() - x);
            let all = [
                ("face", of.face[0], near(&coin)),
                ("face", of.face[1], near(&disk)),
                ("balanced", of.balanced, about(&can)),
                ("critical", of.critical, about(&critical)),
                ("upright", of.upright, near(&ball)),
            ];
            for (end, stated, found) in all {
                assert!(
                    (stated - found).abs() < 0.02,
                    "{law:?}: POWERS, {end}: {stated}, and it goes as {found}"
                );
            }
        }
    }
}
