//! Random tubes and inclinations with which the modules of steady states are checked.

use crate::Body;
use core::f64::consts::FRAC_PI_2;

/// A random tube and an inclination: anywhere on the map up to ell = 3, or of any size and near an inclination where
/// digits are lost.
pub fn drawn(i: u32) -> (Body, f64) {
    let part = |k: f64| (f64::from(i) * k).fract();
    let (u, v, w) =
        (part(0.618_033_988_749_894_9), part(0.754_877_666_246_692_7), part(0.569_840_290_998_053_2));
    let bore = if i.is_multiple_of(3) { 0.0 } else { w };
    if i.is_multiple_of(2) {
        return (Body::tube(3.0 * v, bore).unwrap(), u * FRAC_PI_2);
    }
    let sign = if i.is_multiple_of(4) { 1.0 } else { -1.0 };
    let near = 1.0 + sign * 10f64.powf(-16.0 * u);
    let ell =
        if i % 8 < 4 { 10f64.powf(16.0 * v - 8.0) } else { Body::critical_aspect(bore, 0.0).unwrap() * near };
    let body = Body::tube(ell, bore).unwrap();
    let theta = match i % 5 {
        0 => body.theta_balance() * (1.0 + sign * 10f64.powf(-14.0 * v)),
        1 => body.theta_limit() * (1.0 + sign * 10f64.powf(-14.0 * v)),
        2 => FRAC_PI_2 - 10f64.powf(-16.0 * v),
        3 => 10f64.powf(-300.0 * v),
        _ => u * FRAC_PI_2,
    };
    (body, theta.min(FRAC_PI_2))
}
