//! The squared rate of a rounded rim, its numerator and its denominator.
//!
//! ```text
//! rate^2 = n A/(s m),   n = a cos - ell sin,   m = n + d A cos,   A = a + rho sin
//! ball:  rate^2 = ell/(ell - d rho cos)      n, m and A over the sine that they share
//! ```
//! From the balance w2' = 0 with the centre at rest, w3 = (L/A) w1, in `contact::reduced`; Jackson, Mertens, Pearson,
//! Am. J. Phys. 83, 959 (2015), for two balls. With rho = 0 it is Eq. 15 of Jackson et al., Am. J. Phys. 87, 85 (2019).
//!
//! Error of the rate: at most 4 (1 + kappa_c) ulp of 2^-53, kappa_c = |dlog rate/dlog theta|, for every double theta
//! within the range of the body. A test of `test_rounded_reference` runs it.

use super::SMALL;
use crate::number::{Real, SinCos, Sum};

/// Nearer than this to zero, relative to what was subtracted, a sign is not known: the errors of sine and cosine; of the
/// share of 1 - sin in A; of sums of two.
const UNSURE: f64 = 1.0 / (1_u64 << 54) as f64;
const UNSURE_FALL: f64 = 1.0 / (1_u64 << 51) as f64;
const UNSURE_SUM: f64 = UNSURE * UNSURE;

/// n and m, and what they are divided and multiplied by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoundedTerms<T> {
    /// n and m, of a ball over the sine; either is a NaN where its sign cannot be known.
    pub n: T,
    pub m: T,
    /// A, of a ball over the sine.
    pub radius: T,
    /// The sine, of a ball 1.
    pub sine: T,
}

#[inline(always)]
pub(crate) fn rounded_terms<T: Real>(
    angle: &SinCos<T>,
    [ell, rho]: [T; 2],
    a: Sum<T>,
    excess: Sum<T>,
) -> RoundedTerms<T> {
    let (zero, c) = (ell.splat(0.0), angle.cos);
    let ball = |yes: T, no: T| zero.select_lt(a.hi, no, yes);
    let (s, s_lo) = (ball(ell.splat(1.0), angle.sin.hi), ball(zero, angle.sin.lo));
    let (out, lever) = (a.hi * c.hi, ell * s);
    // what rounding takes from the two products, and from a, sine and cosine
    let off = a.hi.fma(c.hi, -out) - ell.fma(s, -lever);
    let off = a.lo.fma(c.hi, a.hi.fma(c.lo, off)) - ell * s_lo;
    let gap = Sum::of(out, -lever);
    let n_lo = gap.lo + off;
    let n = gap.hi + n_lo;
    // Near the side of a flat body a + d A may be a small rest of large terms where theta hardly changes it: 1 - sin has
    // all its digits there, the sine has not.
    let fall = c.hi * c.hi / (s + s.splat(1.0));
    let high = |yes: T, no: T| ell.splat(0.5).select_lt(s, ball(no, yes), no);
    let (part, from) = (high(-(rho * fall), rho * s), high(ell.splat(1.0), a.hi));
    let rounding = high((-rho).fma(fall, -part), rho.fma(s_lo, a.lo + rho.fma(s, -part)));
    let radius = Sum::of(from, part);
    let radius_lo = radius.lo + rounding;
    let reach = radius.hi * c.hi;
    let reach_lo = radius.hi.fma(c.hi, -reach) + radius.hi.fma(c.lo, radius_lo * c.hi);
    let extra = excess.hi * reach;
    let extra_lo = excess.hi.fma(reach, -extra) + excess.hi.fma(reach_lo, excess.lo * reach);
    let sum = Sum::of(gap.hi, extra);
    let m = sum.hi + (sum.lo + (n_lo + extra_lo));
    let nan = ell.splat(f64::NAN);
    let sure = |x: T, limit: T| limit.select_lt(x.abs(), x, nan);
    // without a difference there is nothing to be unsure of: a ball has none in n, and a disk, whose ell is 0
    let own = ell.splat(UNSURE) * lever.abs().min(out.abs());
    let doubt = ball(ell.splat(1.0), fall).fma(ell.splat(UNSURE_FALL), ell.splat(UNSURE_SUM));
    RoundedTerms {
        n: sure(n, own),
        m: sure(m, own + doubt * n.abs().min(extra.abs())),
        radius: radius.hi,
        sine: s,
    }
}

/// The steady rate from its terms; theta in (0, `most`].
#[inline(always)]
pub(crate) fn rounded_rate<T: Real>(theta: T, most: T, of: &RoundedTerms<T>) -> T {
    let root_up = of.sine.select_lt(
        theta.splat(SMALL),
        theta.splat(f64::from_bits(0x4F90_0000_0000_0000)),
        theta.splat(1.0),
    ); // 2^250
    scaled(theta, most, of).sqrt() * root_up
}

/// Its square, for a comparison: infinite where theta is subnormal.
#[inline(always)]
pub(crate) fn rounded_square<T: Real>(theta: T, most: T, of: &RoundedTerms<T>) -> T {
    let up = of.sine.select_lt(
        theta.splat(SMALL),
        theta.splat(f64::from_bits(0x5F30_0000_0000_0000)),
        theta.splat(1.0),
    ); // 2^500
    scaled(theta, most, of) * up
}

/// Below `SMALL` divided by 2^500.
#[inline(always)]
fn scaled<T: Real>(theta: T, most: T, of: &RoundedTerms<T>) -> T {
    let x = |v: f64| theta.splat(v);
    let up = of.sine.select_lt(x(SMALL), x(f64::from_bits(0x5F30_0000_0000_0000)), x(1.0)); // 2^500
    let square = (of.n * of.radius) / (of.m * (of.sine * up));
    let (zero, nan) = (x(0.0), x(f64::NAN));
    // below zero there is no steady state
    let square = square.select_lt(zero, nan, square);
    most.select_lt(theta, nan, zero.select_lt(theta, square, nan))
}
