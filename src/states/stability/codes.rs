//! The regions of a map, computed without an evaluation of most of its points.
//!
//! For a sharp rim bisection finds the changes of sign along the inclinations, as in `runs`. Every inclination is
//! evaluated where a sign is uncertain, and for a rounded rim. The codes equal those of [`region`](super::region()):
//! two tests of `sweep` check this.

use super::{Region, regions, runs};
use crate::laws::body::Body;
use core::f64::consts::FRAC_PI_2;

/// Writes the codes of the [`Region`] for all inclinations (ascending) and all bodies: row-major (inclination, body),
/// on one thread. A body that is None has the code of `Invalid`.
///
/// # Panics
/// Panics if `codes` does not hold `theta.len() * bodies.len()` codes, or theta does not ascend.
pub fn codes(theta: &[f64], bodies: &[Option<Body>], codes: &mut [u8]) {
    assert!(
        theta.is_sorted() && codes.len() == theta.len() * bodies.len(),
        "expected theta to ascend, and theta.len() * bodies.len() codes"
    );
    codes.fill(Region::Invalid as u8);
    let [first, last] = [0.0, FRAC_PI_2].map(|end| theta.partition_point(|x| *x <= end));
    let tangents: Vec<f64> = theta[first..last].iter().map(|x| x.tan()).collect();
    for (i, body) in bodies.iter().enumerate() {
        let Some(body) = body else { continue };
        let mut put = |row: usize, code: u8| codes[row * bodies.len() + i] = code;
        let fill = |code, from, to| (first + from..first + to).for_each(|row| put(row, code as u8));
        if !body.is_plain() || !runs(body, &tangents, fill) {
            let found = regions(body, theta.iter().copied());
            found.into_iter().enumerate().for_each(|(row, code)| put(row, code));
        }
    }
}
