//! The power of each loss law on a sharp rim, for a coefficient of 1, written independently of the library.

use core::f64::consts::FRAC_PI_4;
use spincyl::loss::Law;

/// Weight, rates, sine of theta and radius in a state, all in natural units or all in SI.
pub struct LossRates {
    pub weight: f64,
    pub spin: f64,
    /// The rate of rolling and rocking together, sqrt(w_h^2 + w2^2).
    pub rolling: f64,
    pub drilling: f64,
    /// The size |w| of the angular velocity.
    pub whole: f64,
    pub sine: f64,
    pub radius: f64,
}

pub fn loss_power(law: Law, at: &LossRates) -> f64 {
    match law {
        Law::DryContour => at.weight * at.spin.abs(),
        Law::ViscousContour => at.spin * at.spin,
        Law::RollingResistance => at.weight * at.rolling,
        Law::Drilling => at.weight * at.drilling.abs(),
        Law::AirLinear => at.whole * at.whole,
        Law::AirQuadratic => at.whole.powi(3),
        Law::AirFilm => FRAC_PI_4 * at.radius.powi(3) * at.spin * at.spin / at.sine,
        Law::BoundaryLayer => at.spin.abs().powf(2.5),
        law => panic!("{law}: its power is not in the table of tests/laws/common/loss_power.rs"),
    }
}
