//! The contact geometry of a rim, written independently of the library, and the conditioning of a rate.

use spincyl::Body;
use std::f64::consts::FRAC_PI_2;

/// Half of the distance from 1 to the next double.
pub const ULP: f64 = f64::EPSILON / 2.0;

/// Sine and cosine of theta and radius A of a rim; and L, h, g and g', each as a value and as the sum of the sizes of
/// its terms.
pub struct Place {
    pub s: f64,
    pub c: f64,
    pub radius: f64,
    pub depth: [f64; 2],
    pub height: [f64; 2],
    pub lever: [f64; 2],
    pub slope: [f64; 2],
}

pub fn place(body: &Body, theta: f64) -> Place {
    let (s, c) = theta.sin_cos();
    let (a, ell, rho) = (body.rim(), body.ell(), body.fillet());
    let both = |x: f64, y: f64| [x + y, x.abs() + y.abs()];
    let slope = both(ell * c, a * s);
    Place {
        s,
        c,
        radius: a + rho * s,
        depth: both(ell, rho * c),
        height: [slope[0] + rho, slope[1] + rho],
        lever: both(ell * s, -a * c),
        slope,
    }
}

/// The condition number |dlog rate/dlog theta| of a steady rate, from rate^2 = n A/(s m) with m = n + d c A.
pub fn condition(body: &Body, theta: f64) -> f64 {
    let Place { s, c, radius, lever, slope, .. } = place(body, theta);
    let (rho, d) = (body.fillet(), body.excess());
    if rho == 1.0 {
        // rate^2 = ell/(ell - d c)
        return 0.5 * theta * (d * s / (body.ell() - d * c)).abs();
    }
    let n = -lever[0];
    let m = n + d * c * radius;
    let edge = d * (-slope[0] * c * radius - n * (rho * c * c - radius * s));
    0.5 * theta * (edge / (n * m) + rho * c / radius - c / s).abs()
}

pub fn sharp(body: &Body) -> bool {
    body.fillet() == 0.0
}

/// The largest inclination of steady states of a body.
pub fn steady_end(body: &Body) -> f64 {
    if sharp(body) { FRAC_PI_2 } else { body.theta_end() }
}
