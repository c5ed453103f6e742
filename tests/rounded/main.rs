//! Bodies on rounded rims: what holds at every body and every state, one room of physics to a file.

#[path = "../common/mod.rs"]
mod common;

mod beside_folds;
mod big;
mod equations;
mod many;
mod moving;
mod references;
mod steady_states;
mod turning_points;

use spincyl::Body;

/// Half of the distance from 1 to the next double.
const ULP: f64 = f64::EPSILON / 2.0;

/// Sine, cosine, and where the body touches: A, L, h, g, g', each as a value and as the sum of the sizes of its terms.
struct Place {
    s: f64,
    c: f64,
    radius: f64,
    depth: [f64; 2],
    height: [f64; 2],
    lever: [f64; 2],
    slope: [f64; 2],
}

fn place(body: &Body, theta: f64) -> Place {
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

/// |dlog rate/dlog theta|, from rate^2 = n A/(s m) with m = n + d c A.
fn condition(body: &Body, theta: f64) -> f64 {
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
