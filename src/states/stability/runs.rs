//! Runs of ascending inclinations in one region, without an evaluation of most of the inclinations.
//!
//! ```text
//! n = 1 - ell T,   m = a - ell T,   T = tan theta,   a = I1/I3,   both over cos theta
//! sign kappa = (sign of m) (sign of the cubic in T of `boundaries`)
//! ```
//! A linear function changes its sign once, and a cubic at most once between two of its extrema, so that bisection in
//! double precision locates the change among the inclinations. The sign of a value below 2^-44 of the sum of the sizes
//! of its terms (some sixty times its rounding error, here or in `kappa`) is uncertain; the caller then has to evaluate
//! every inclination of that body.

use super::boundaries::cubic;
use super::region::Region;
use crate::laws::body::Body;
use crate::laws::contact::Contact;
use crate::methods::roots::{Coefficient, Cubic};
use crate::numbers::Sum;
use crate::states::steady;

/// The sign of a value below this share of the sizes of its terms is uncertain. A smaller share could accept a sign
/// that rounding errors cause; a larger one leaves more bodies to the caller.
const VALUE_DOUBT: f64 = 1.0 / (1_u64 << 44) as f64;

/// A number, and the sum of the absolute values of the terms of which it is the sum.
#[derive(Clone, Copy)]
struct Terms {
    value: f64,
    size: f64,
}

impl From<Sum<f64>> for Terms {
    fn from(x: Sum<f64>) -> Self {
        Self { value: x.hi, size: x.hi.abs() }
    }
}

impl Coefficient for Terms {
    fn plus(self, other: Self) -> Self {
        Self { value: self.value + other.value, size: self.size + other.size }
    }
    fn plus_product(self, a: Self, b: Self) -> Self {
        Self { value: self.value + a.value * b.value, size: self.size + a.size * b.size }
    }
}

/// The coefficients of a cubic in T, and for each coefficient the sum of the absolute values of its terms.
struct Curve {
    p: [f64; 4],
    sizes: [f64; 4],
}

impl From<Cubic<Terms>> for Curve {
    fn from(Cubic(all): Cubic<Terms>) -> Self {
        Self { p: all.map(|x| x.value), sizes: all.map(|x| x.size) }
    }
}

impl Curve {
    /// Whether the cubic is negative at `t`; None if its sign is uncertain.
    #[inline(always)]
    fn is_negative(&self, t: f64) -> Option<bool> {
        let at = |p: &[f64; 4]| ((p[3] * t + p[2]) * t + p[1]) * t + p[0];
        let value = at(&self.p);
        (value.abs() > VALUE_DOUBT * at(&self.sizes)).then_some(value < 0.0)
    }

    /// The extrema of the cubic, the smaller one first; NaN where it has none.
    fn extrema(&self) -> [f64; 2] {
        let [_, p1, p2, p3] = self.p;
        let root = (p2 * p2 - 3.0 * p1 * p3).sqrt();
        let sum = -(p2 + root.copysign(p2));
        let (one, other) = (sum / (3.0 * p3), p1 / sum);
        if one < other { [one, other] } else { [other, one] }
    }

    /// Adds to `changes` the indices in `tangents` (ascending, not empty) at which the cubic changes its sign. Returns
    /// whether the cubic is negative at the first tangent; None if any sign is uncertain.
    fn signs(&self, tangents: &[f64], changes: &mut Changes, which: u8) -> Option<bool> {
        let start = self.is_negative(tangents[0])?;
        let [one, other] = if self.sizes[2] == 0.0 && self.sizes[3] == 0.0 {
            [0; 2]
        } else {
            self.extrema().map(|extremum| tangents.partition_point(|t| *t < extremum))
        };
        let mut before = start;
        for (from, to) in [(0, one), (one, other), (one.max(other), tangents.len())] {
            if from >= to {
                continue;
            }
            let (first, last) = (self.is_negative(tangents[from])?, self.is_negative(tangents[to - 1])?);
            if first != before {
                changes.insert(from, which);
            }
            if first != last {
                let (mut low, mut high) = (from, to - 1);
                while high - low > 1 {
                    let middle = low + (high - low) / 2;
                    let same = self.is_negative(tangents[middle])? == first;
                    (low, high) = if same { (middle, high) } else { (low, middle) };
                }
                changes.insert(high, which);
            }
            before = last;
        }
        Some(start)
    }
}

/// The indices of the changes of sign, in ascending order, each with the bit of its polynomial. Each of the four
/// polynomials changes its sign at most five times.
struct Changes {
    all: [(usize, u8); 20],
    count: usize,
}

impl Changes {
    /// Inserts a change of sign at its place in the order.
    fn insert(&mut self, place: usize, which: u8) {
        let mut k = self.count;
        while k > 0 && self.all[k - 1].0 > place {
            self.all[k] = self.all[k - 1];
            k -= 1;
        }
        self.all[k] = (place, which);
        self.count += 1;
    }
}

/// Calls `report` with the [`Region`], the first index and the end index of each run, and returns true. The body must
/// have a sharp rim and the range (0, pi/2]; `tangents` are those of ascending inclinations. If a sign is uncertain,
/// the function returns false without a call.
pub(crate) fn runs(body: &Body, tangents: &[f64], mut report: impl FnMut(Region, usize, usize)) -> bool {
    if tangents.is_empty() {
        return true;
    }
    let (ell, a) = (body.ell(), body.ratio());
    // For other bodies, squares of the coefficients may overflow or vanish.
    let within = |x: f64| (1e-30..=1e30).contains(&x);
    if !(within(body.i1()) && within(body.i3()) && within(a) && (ell == 0.0 || within(ell))) {
        return false;
    }
    let n = steady::shared_factor::<Terms>(body);
    let m = n + Cubic::of(body.excess_sum());
    let [rolling, smooth] = [Contact::Rolling, Contact::Smooth].map(|contact| cubic(body, contact, false));
    let curves = [n, m, rolling, smooth].map(Curve::from);
    let mut changes = Changes { all: [(0, 0); 20], count: 0 };
    let mut negative = 0u8;
    for (k, curve) in curves.iter().enumerate() {
        let Some(first) = curve.signs(tangents, &mut changes, 1 << k) else { return false };
        negative |= u8::from(first) << k;
    }
    let mut from = 0;
    for &(place, which) in &changes.all[..changes.count] {
        if place > from {
            report(region_of_signs(negative), from, place);
            from = place;
        }
        negative ^= which;
    }
    report(region_of_signs(negative), from, tangents.len());
    true
}

/// The region, from the bits that are set where n, m and the polynomials of rolling and smooth kappa are
/// negative.
fn region_of_signs(negative: u8) -> Region {
    let [n, m, rolling, smooth] = [1, 2, 4, 8].map(|bit| negative & bit != 0);
    match (n == m, rolling == m, smooth == m) {
        (false, ..) => Region::Forbidden,
        (true, false, false) => Region::Unstable,
        (true, true, false) => Region::StableRolling,
        (true, false, true) => Region::StableSmooth,
        (true, true, true) => Region::Stable,
    }
}

#[cfg(test)]
mod tests {
    use super::super::region;
    use super::*;

    #[test]
    fn of_ordinary_tubes_and_disks_no_sign_is_in_doubt_and_every_run_is_one_region() {
        let theta: Vec<f64> = (1..1000).map(|i| 0.00157 * f64::from(i)).collect();
        let tangents: Vec<f64> = theta.iter().map(|x| x.tan()).collect();
        let (mut known, mut found) = (0, [0; 8]);
        for i in 1..=400 {
            let part = |k: f64| (f64::from(i) * k).fract();
            let body =
                Body::tube(3.0 * part(0.618_033_988_749_894_9), part(0.754_877_666_246_692_7)).unwrap();
            let mut codes = vec![None; theta.len()];
            let sure = runs(&body, &tangents, |code, from, to| {
                assert!(from < to && codes[from..to].iter().all(Option::is_none));
                codes[from..to].fill(Some(code));
            });
            known += usize::from(sure);
            for (theta, code) in theta.iter().zip(codes).filter(|_| sure) {
                assert_eq!(code, Some(region(&body, *theta)), "{body:?} at {theta}");
                found[code.unwrap() as usize] += 1;
            }
        }
        assert!(known >= 399, "{known} of 400");
        assert!(found[1] > 0 && found[4] > 0 && found[5] > 0 && found[7] > 0, "{found:?}");
    }
}
