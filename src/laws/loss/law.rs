//! The properties of a loss law: its coefficient, its couple, its power, and all else that depends on the law.
//!
//! ```text
//! m = C u,   P = C p = -m.w          the couple u and the power p of a unit coefficient C, and of N = 1
//! ```
//! A law is one type that implements [`LossLaw`], in a file of its own, and one line of the table in `loss`. The
//! defaults are those of a smooth law that does not depend on the normal force. The stated properties are compared with
//! the couple and the power in the tests at the end.

use super::Kinematics;
use crate::numbers::Real;

/// The motion that a law resists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Resists {
    /// The speed A |psi'| of the contact along the rim. The couple is a multiple of h/s.
    Contour,
    /// The rolling w_h and the rocking w2 together.
    Rolling,
    /// The drilling w_z; the couple of the law is vertical.
    Drilling,
    /// All rotation, by the air.
    All,
}

/// The unit of the coefficient of a law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unit {
    /// A length, such as a lever arm.
    Length,
    /// A damping constant: a couple over an angular velocity.
    Damping,
    /// A drag constant: a couple over the square of an angular velocity.
    Drag,
    /// A dynamic viscosity.
    Viscosity,
    /// A couple over an angular velocity to the power 3/2, for boundary layers.
    Layer,
}

impl Unit {
    /// Four texts: the quantity that the unit measures, the unit in natural units and in SI, and the unit in which a
    /// coefficient is printed and read. C is the number of order 0.1 that gives the strength of a boundary layer.
    #[cfg(any(feature = "python", feature = "scene"))]
    pub const fn texts(self) -> [&'static str; 4] {
        match self {
            Self::Length => ["length", "R", "m", "mm"],
            Self::Damping => ["damping", "M R sqrt(g R)", "N m s", "N m s"],
            Self::Drag => ["drag", "M R^2", "N m s^2", "N m s²"],
            Self::Viscosity => ["viscosity", "M g^(1/2)/R^(3/2)", "Pa s", "Pa s"],
            Self::Layer => ["layer", "M g^(1/4) R^(7/4)", "N m s^1.5", "C"],
        }
    }

    /// The exponents of metre, second and joule in the unit.
    pub const fn exponents(self) -> [f64; 3] {
        match self {
            Self::Length => [1.0, 0.0, 0.0],
            Self::Damping => [0.0, 1.0, 1.0],
            Self::Drag => [0.0, 2.0, 1.0],
            Self::Viscosity => [-3.0, 1.0, 1.0],
            Self::Layer => [0.0, 1.5, 1.0],
        }
    }
}

/// A speed at whose zero the couple of a law is not smooth, because the law contains a root of the square of this speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Speed {
    /// The spin psi'.
    Spin,
    /// The speed of rolling and rocking together.
    Rolling,
    /// The magnitude |w| of the angular velocity.
    Whole,
}

/// The exponents p of the power P ~ x^p that a law takes in a steady state at the distance x in theta from the end of a drift.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EndPowers {
    /// Where the face lands: of a thin disk, and of a body with ell + rho > 0. Omega and psi' go as x^(-1/2), s as x.
    pub face: [f64; 2],
    /// Where the body is balanced on its rim: Omega ~ x^(1/2), psi' ~ x^(3/2).
    pub balanced: f64,
    /// Where a body with I1 = I3 is balanced on its rim: Omega tends to a constant, psi' ~ x.
    pub critical: f64,
    /// Where a ball stands on its pole: Omega and psi' tend to constants; A and s go as x.
    pub upright: f64,
}

/// A loss law. Every law is linear in its one coefficient.
pub(crate) trait LossLaw {
    /// The name of the coefficient of the law.
    const PARAMETER: &'static str;
    /// The formula of the couple in the symbols of a scene file, with the coefficient in SI.
    const COUPLE: &'static str;
    /// The unit of the coefficient of the law.
    const UNIT: Unit;
    /// The motion that the law resists.
    const RESISTS: Resists;
    /// The exponents of the power that the law takes near the ends of a drift.
    const POWERS: EndPowers;
    /// Whether the law is dry: proportional to the normal force and to the sign of a motion. Where that motion comes to
    /// rest, dry friction may hold it: `dry::held` decides this from the couple that acts at rest.
    const PRESSES: bool = false;
    /// Whether the law needs a flat face of the body above the table.
    const NEEDS_FACE: bool = false;
    /// The speed at whose zero the law is not smooth, if there is one; near it steps are short.
    const ROOT: Option<Speed> = None;

    /// The couple along e1, e2, e3 for a coefficient of 1, and for N = 1 if the law is dry.
    fn couple<T: Real>(seen: &Kinematics<T>) -> [T; 3];

    /// The power that the couple takes for a coefficient of 1, and for N = 1 if the law is dry.
    fn power<T: Real>(seen: &Kinematics<T>) -> T;

    /// For a smooth law along the contour, whose couple is X h/s, the derivative of X with respect to psi'; the
    /// arguments are the coefficient, sine of theta, the radius A and psi'. The file of such a law defines its `slope`.
    #[inline(always)]
    fn slope<T: Real>(_coefficient: T, s: T, _radius: T, _spin: T) -> T {
        s.splat(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::Resists;
    use crate::laws::body::Body;
    use crate::laws::loss::{Kinematics, Law};
    use crate::laws::state::State;

    const PLACES: [[f64; 4]; 4] =
        [[0.3, 1.1, -0.4, 0.6], [1.1, -0.7, 0.2, 1.9], [2.0, 0.5, 0.8, -0.3], [0.05, 0.4, -0.9, -2.5]];

    /// The kinematics in a state, with the angular velocity multiplied by `faster`.
    fn seen([theta, w1, w2, w3]: [f64; 4], faster: f64) -> Kinematics<f64> {
        let y = State { theta, w1: faster * w1, w2: faster * w2, w3: faster * w3 };
        Kinematics::of_state(&Body::rounded(1.5, 0.6, 0.5, 0.3).unwrap(), &y)
    }

    fn largest([a, b, c]: [f64; 3]) -> f64 {
        a.abs().max(b.abs()).max(c.abs())
    }

    #[test]
    fn a_law_resists_the_motion_that_it_names_and_takes_its_power() {
        for (law, place) in Law::ALL.iter().copied().flat_map(|law| PLACES.map(|place| (law, place))) {
            let seen = seen(place, 1.0);
            let (m, (s, c)) = (law.couple(&seen), seen.angle);
            let taken: f64 = -(0..3).map(|i| m[i] * seen.w[i]).sum::<f64>();
            assert!(
                (law.power(&seen) - taken).abs() < 1e-13 * taken && taken > 0.0,
                "{law:?}: P is not -m.w"
            );
            let few = 1e-14 * largest(m);
            let [tilts, vertical, across] =
                [m[1], s * m[0] + c * m[2], c * m[0] - s * m[2]].map(|x| x.abs() > few);
            let found = match law.resists() {
                Resists::Contour => !tilts && !vertical,
                Resists::Rolling => tilts && !vertical,
                Resists::Drilling => !tilts && !across,
                Resists::All => tilts && vertical && across,
            };
            assert!(found, "{law:?}: its couple does not agree with RESISTS: {m:?}");
        }
    }

    #[test]
    fn a_law_is_dry_or_has_a_root_or_is_smooth_as_it_says() {
        for (law, place) in Law::ALL.iter().copied().flat_map(|law| PLACES.map(|place| (law, place))) {
            let [one, two] = [1e-6, 2e-6].map(|faster| largest(law.couple(&seen(place, faster))));
            // The couple reverses with the motion, so that it is smooth at rest if it goes as an odd power.
            let power = (two / one).log2();
            assert_eq!(
                law.presses(),
                power.abs() < 1e-9,
                "{law:?}: PRESSES, of a couple as the speed to {power}"
            );
            let odd = ((power - 1.0) / 2.0 - ((power - 1.0) / 2.0).round()).abs() < 1e-6;
            assert!(
                law.presses() || law.root().is_none() == odd,
                "{law:?}: ROOT, of a couple as the speed to {power}"
            );
        }
    }

    #[test]
    fn the_slope_of_a_law_is_that_of_its_couple() {
        for (law, place) in Law::ALL.iter().copied().flat_map(|law| PLACES.map(|place| (law, place))) {
            let (at, h) = (seen(place, 1.0), 1e-5);
            let push = |by: f64| {
                let mut w = at.w;
                w[2] += by;
                let moved = Kinematics { w, spin: at.spin + by, ..at };
                -law.couple(&moved)[2]
            };
            let by_couple = if law.is_soft() { 0.7 * (push(h) - push(-h)) / (2.0 * h) } else { 0.0 };
            let by_law = law.slope(0.7, at.angle.0, at.radius, at.spin);
            assert!(
                (by_law - by_couple).abs() <= 1e-6 * by_couple.abs(),
                "{law:?}: slope {by_law} {by_couple}"
            );
        }
    }

    #[test]
    fn no_two_laws_have_a_coefficient_of_the_same_name() {
        for &law in Law::ALL {
            let same = Law::ALL.iter().copied().filter(|other| other.parameter() == law.parameter());
            assert_eq!(same.count(), 1, "{law:?}: PARAMETER");
        }
    }
}
