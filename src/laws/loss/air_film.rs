//! A viscous film of air between a flat face and the table.
//!
//! ```text
//! P = (pi/4) viscosity psi'^2/s,   m = (pi/4) viscosity psi' h/s^2          viscosity in M g^(1/2)/R^(3/2)
//! ```
//! The law is in Moffatt, Nature 404, 833 (2000). The pi/4 is his estimate: lubrication theory with no pressure at the
//! rim gives 1.28. The film has to fill the gap, theta^(3/4) < nu^(1/2) (R/(4 g))^(1/4)/R, which is 0.005 rad for
//! Euler's disk. A thin disk has theta = (pi viscosity tau/(2 I1))^(1/3) at the time tau before its end.

use super::{EndPowers, Kinematics, LossLaw, Resists, Unit};
use crate::numbers::Real;
use core::f64::consts::FRAC_PI_4;

#[derive(Debug)]
pub(super) struct AirFilm;

impl LossLaw for AirFilm {
    const PARAMETER: &str = "viscosity";
    const COUPLE: &str = "pi/4*viscosity*R**3*q*h/s**2";
    const UNIT: Unit = Unit::Viscosity;
    const RESISTS: Resists = Resists::Contour;
    const NEEDS_FACE: bool = true;
    const POWERS: EndPowers = EndPowers { face: [-2.0; 2], balanced: 3.0, critical: 2.0, upright: -1.0 };

    /// The couple along e1, e2, e3 for viscosity = 1.
    #[inline(always)]
    fn couple<T: Real>(seen: &Kinematics<T>) -> [T; 3] {
        let s = seen.angle.0;
        seen.along(s.splat(FRAC_PI_4) * seen.spin / s)
    }

    /// The power that the couple takes for viscosity = 1.
    #[inline(always)]
    fn power<T: Real>(seen: &Kinematics<T>) -> T {
        let s = seen.angle.0;
        s.splat(FRAC_PI_4) * seen.spin * seen.spin / s
    }

    #[inline(always)]
    fn slope<T: Real>(coefficient: T, s: T, _: T, _: T) -> T {
        coefficient * s.splat(FRAC_PI_4) / s
    }
}
