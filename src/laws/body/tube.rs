//! The moments of inertia of uniform tubes, for one tube or for several in SIMD lanes.
//!
//! ```text
//! bore q, half length H, fillet rho of the outer edges, a = 1 - rho, ell = H - rho:
//!   m  = 2 (ell (1 - q^2) + p2),   I3 = (ell (1 - q^4) + p4)/m,   I1 = I3/2 + 2 z/m
//!   z  = ell^3 (1 - q^2)/3 + ell^2 p2 + 2 ell q1 + q2,   f = a^2 - q^2
//!   p2 = rho f + pi a rho^2/2 + 2 rho^3/3,   p4 = rho (a^4 - q^4) + pi a^3 rho^2 + 4 a^2 rho^3 + 3 pi a rho^4/4 + 8 rho^5/15
//!   q1 = rho^2 f/2 + 2 a rho^3/3 + rho^4/4,  q2 = rho^3 f/3 + pi a rho^4/8 + 2 rho^5/15
//! sharp, rho = 0:  I3 = (1 + q^2)/2,   I1 = I3/2 + ell^2/3
//! ```
//! The formulas of m, I3 and I1 are volume integrals; see Jackson et al., Am. J. Phys. 87, 85 (2019), Sec. II, for the
//! sharp rim. The inertia excess is exact to 2^-100 of the larger moment: the tests at the end check it.
//! `test_rounded_reference` checks the moments of rounded edges to four ulp.

use super::ELL;
use crate::numbers::{Real, Sum};
use core::f64::consts::PI;

/// I1, I3 and the inertia excess of a uniform tube, or of several tubes in SIMD lanes.
#[inline(always)]
pub(crate) fn tube<T: Real>(ell: T, bore: T) -> ([T; 2], Sum<T>) {
    let wall = Wall::of(bore);
    let i3 = wall.size * ell.splat(0.5);
    let i1 = wall.size * ell.splat(0.25) + ell * ell / ell.splat(3.0);
    ([i1, i3], wall.excess(ell))
}

/// Functions of the bore q alone, shared by all uniform tubes of one bore.
#[derive(Clone, Copy)]
pub(crate) struct Wall<T> {
    /// Powers of the bore q: 1 + q^2 (`size`) and 3 (1 + q^2) (`three`).
    size: T,
    three: Sum<T>,
    /// The factor 1/(6 (1 + q^2)), with the bore q.
    per_six: Sum<T>,
}

impl<T: Real> Wall<T> {
    #[inline(always)]
    pub fn of(bore: T) -> Self {
        let number = |x: f64| bore.splat(x);
        let square = Sum::product(bore, bore);
        let wall = Sum::ordered(number(1.0), square.hi);
        let wall = Sum::ordered(wall.hi, wall.lo + square.lo);
        let three = wall.times(number(3.0));
        let six = Sum { hi: three.hi + three.hi, lo: three.lo + three.lo };
        let over = number(1.0) / six.hi;
        let rest = (-over).fma(six.hi, number(1.0)) - over * six.lo;
        Self { size: wall.hi, three, per_six: Sum { hi: over, lo: rest * over } }
    }

    /// The inertia excess (4 ell^2 - 3 wall)/(6 wall) with wall = 1 + q^2, to 100 bits.
    #[inline(always)]
    pub fn excess(&self, ell: T) -> Sum<T> {
        let double = Sum::product(ell + ell, ell + ell);
        let difference = Sum::of(double.hi, -self.three.hi);
        let difference = Sum::ordered(difference.hi, difference.lo + (double.lo - self.three.lo));
        difference * self.per_six
    }
}

/// I1, I3 and the inertia excess of a uniform tube with rounded edges, or of several tubes in SIMD lanes.
#[inline(always)]
pub(crate) fn rounded_tube<T: Real>(ell: T, bore: T, fillet: T) -> ([T; 2], Sum<T>) {
    let number = |x: f64| Sum { hi: ell.splat(x), lo: ell.splat(0.0) };
    let exact = |x: T| Sum { hi: x, lo: ell.splat(0.0) };
    let part = |n: f64, d: f64| number(n) / number(d);
    let pi = Sum { hi: ell.splat(PI), lo: ell.splat(1.224_646_799_147_353_2e-16) };
    let (rho, q2, one) = (exact(fillet), Sum::product(bore, bore), number(1.0));
    let (a, ell) = (Sum::of(ell.splat(1.0), -fillet), exact(ell));
    let (a2, square) = (a * a, rho * rho);
    let (cube, flat) = (square * rho, a2 - q2);
    let fourth = square * square;
    let p2 = rho * flat + pi * a * square * number(0.5) + part(2.0, 3.0) * cube;
    let p4 = rho * (a2 + q2) * flat
        + pi * a2 * a * square
        + number(4.0) * a2 * cube
        + number(0.75) * pi * a * fourth
        + part(8.0, 15.0) * fourth * rho;
    let q1 = number(0.5) * square * flat + part(2.0, 3.0) * a * cube + number(0.25) * fourth;
    let q3 = cube * flat / number(3.0) + pi * a * fourth * number(0.125) + part(2.0, 15.0) * fourth * rho;
    let wall = one - q2;
    let mass = number(2.0) * (ell * wall + p2);
    let axial = ell * wall * (one + q2) + p4;
    let ell2 = ell * ell;
    let lever = ell2 * ell * wall / number(3.0) + ell2 * p2 + number(2.0) * ell * q1 + q3;
    let transverse = number(2.0) * lever;
    let i3 = axial / mass;
    let i1 = (axial * number(0.5) + transverse) / mass;
    ([i1.hi, i3.hi], (transverse - axial * number(0.5)) / axial)
}

/// Returns `ell` if a tube with this aspect ratio and bore exists, else NaN.
#[inline(always)]
pub(crate) fn tube_or_nan<T: Real>(ell: T, bore: T) -> T {
    let (zero, nan) = (ell.splat(0.0), ell.splat(f64::NAN));
    let between = |x: T, most: f64, yes: T| x.select_lt(zero, nan, x.splat(most).select_lt(x, nan, yes));
    // Both comparisons let a bore of NaN pass; the product with 0 then makes the result NaN.
    between(ell, ELL.1, between(bore, 1.0, ell + bore * zero))
}

#[cfg(test)]
mod tests {
    use super::super::Body;
    use crate::numbers::Sum;

    /// Compares d times 6 (1 + q^2) with integers: ell = i / 2^30 and q = j / 2^30 are exact, and 1 + q^2 is
    /// not a double.
    #[test]
    fn the_excess_is_exact_to_a_hundred_bits_near_the_critical_shape() {
        let unit = f64::from(1 << 30);
        for j in [0_i128, 1, 77_777, (1 << 29) + 1, 987_654_321, (1 << 30) - 1, 1 << 30] {
            let critical = (Body::critical_aspect(j as f64 / unit, 0.0).unwrap() * unit) as i128;
            for i in critical - 3..critical + 3 {
                let body = Body::tube(i as f64 / unit, j as f64 / unit).unwrap();
                let wall = (1 << 60) + j * j;
                let (six, exact) = (6 * wall, 4 * i * i - 3 * wall);
                let high = six as f64;
                let back = body.excess_sum() * Sum::of(high, (six - high as i128) as f64);
                let rest = ((back.hi - exact as f64) + back.lo) / exact as f64;
                assert!(rest.abs() < 2f64.powi(-100), "bore {j}, ell {i}: {rest}");
            }
        }
    }
}
