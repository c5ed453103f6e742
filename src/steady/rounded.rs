//! The squared rate of a rounded rim, its numerator and its denominator.
//!
//! ```text
//! rate^2 = n A/(s m),   n = a cos - ell sin,   m = n + d A cos,   A = a + rho sin
//! ball:  rate^2 = ell/(ell - d rho cos)      n, m and A over the sine that they share
//! ```
//! From the balance w2' = 0 with the centre at rest, w3 = (L/A) w1, in `contact::reduced`; Jackson, Mertens, Pearson,
//! Am. J. Phys. 83, 959 (2015), for two balls. With rho = 0 it is Eq. 15 of Jackson et al., Am. J. Phys. 87, 85 (2019).
//!
//! Error of the rate: at most 2 (1 + kappa_c) ulp of 2^-53, kappa_c = |dlog rate/dlog theta|, and 2^-100 |n/m| besides, for
//! every double theta within the range of the body. Tests of `laws` and of `test_rounded_reference` run it.
//!
//! An error of sine and cosine is a turn, which moves the rate as kappa_c does, and a common factor 1 + e. Of a sharp rim that
//! factor cancels, n and m being of one degree in sine and cosine; of a rounded one it moves log rate by
//! e (d rho s c/m + a/A)/2, with |e| below 1/8 ulp: next to folds, where kappa_c vanishes, m may be a thousand times smaller
//! than d rho s c, and is then formed in twice the digits.

use super::SMALL;
use crate::body::Rim;
use crate::number::{Lane, Real, SinCos, Sum, long_sin_cos_falls};

/// Nearer than this to zero, relative to what was subtracted, a sign is not known: the errors of sine and cosine; the same
/// where they have twice the digits; those of sums of two.
const UNSURE: f64 = 1.0 / (1_u64 << 54) as f64;
const UNSURE_LONG: f64 = 1.0 / (1_u128 << 98) as f64;
const UNSURE_SUM: f64 = UNSURE * UNSURE;

/// So much smaller than d rho s c, over 1 + kappa_c, m has too few digits: half a ulp of the rate.
const BENT: f64 = 8.0;

/// n and m, and what they are divided and multiplied by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoundedTerms<T> {
    /// n and m, of a ball over the sine; either is a NaN where its sign cannot be known.
    pub n: Sum<T>,
    pub m: Sum<T>,
    /// A, of a ball over the sine.
    pub radius: Sum<T>,
    /// The sine, of a ball 1.
    pub sine: Sum<T>,
}

/// What the terms are made of: ell, rho, a and d.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoundedParts<T> {
    pub ell: T,
    pub rho: T,
    pub a: Sum<T>,
    pub excess: Sum<T>,
}

impl RoundedParts<f64> {
    /// The terms of a single inclination.
    #[inline(always)]
    pub fn terms(&self, theta: f64, angle: &SinCos<f64>) -> RoundedTerms<f64> {
        let (terms, spare) = self.quick(angle);
        if spare >= 0.0 || spare.is_nan() {
            return terms;
        }
        let (careful, bent) = self.carefully(theta, angle);
        if bent > 0.5 { careful } else { terms }
    }
}

impl<T: Lane> RoundedParts<T> {
    /// The terms in twice the digits, and 1 in the lanes that need them, elsewhere 0.
    #[inline(always)]
    pub fn carefully(&self, theta: T, angle: &SinCos<T>) -> (RoundedTerms<T>, T) {
        let (terms, bend) = self.unsure(angle);
        let bent = self.bent(theta, (angle.sin.hi, angle.cos.hi), &terms, bend);
        // most of what is bent turns steep as well, next to thetaInf
        (if bent.any() { self.careful(theta) } else { terms }, bent)
    }
}

/// Where `x < limit` the first, elsewhere the second.
#[inline(always)]
fn select<T: Real>(x: T, limit: T, yes: Sum<T>, no: Sum<T>) -> Sum<T> {
    Sum { hi: x.select_lt(limit, yes.hi, no.hi), lo: x.select_lt(limit, yes.lo, no.lo) }
}

impl<T: Real> RoundedParts<T> {
    /// The first of a ball, the second of other bodies.
    #[inline(always)]
    fn ball(&self, yes: T, no: T) -> T {
        yes.splat(0.0).select_lt(self.a.hi, no, yes)
    }

    /// The terms by few operations, and what is below zero where m may have too few digits for them.
    #[inline(always)]
    pub fn quick(&self, angle: &SinCos<T>) -> (RoundedTerms<T>, T) {
        let (terms, bend) = self.unsure(angle);
        (self.sure(terms, angle, bend), terms.m.hi.abs() * bend.splat(BENT) - bend)
    }

    /// The terms, also where their signs are in doubt, and |d rho s c|, of a ball over the sine.
    #[inline(always)]
    fn unsure(&self, angle: &SinCos<T>) -> (RoundedTerms<T>, T) {
        let Self { ell, rho, a, excess } = *self;
        let c = angle.cos;
        let s =
            Sum { hi: self.ball(ell.splat(1.0), angle.sin.hi), lo: self.ball(ell.splat(0.0), angle.sin.lo) };
        let (out, lever) = (a.hi * c.hi, ell * s.hi);
        // what rounding takes from the two products, and from a, sine and cosine
        let off = a.hi.fma(c.hi, -out) - ell.fma(s.hi, -lever);
        let off = a.lo.fma(c.hi, a.hi.fma(c.lo, off)) - ell * s.lo;
        let gap = Sum::of(out, -lever);
        let n = Sum::ordered(gap.hi, gap.lo + off);
        let edge = rho * s.hi;
        let edge_lo = rho.fma(s.lo, a.lo + rho.fma(s.hi, -edge));
        let radius = Sum::of(a.hi, edge);
        let radius = Sum { hi: radius.hi, lo: radius.lo + edge_lo };
        let reach = radius.hi * c.hi;
        let reach_lo = radius.hi.fma(c.hi, -reach) + radius.hi.fma(c.lo, radius.lo * c.hi);
        let extra = excess.hi * reach;
        let extra_lo = excess.hi.fma(reach, -extra) + excess.hi.fma(reach_lo, excess.lo * reach);
        let sum = Sum::of(n.hi, extra);
        let m = Sum::ordered(sum.hi, sum.lo + (n.lo + extra_lo));
        (RoundedTerms { n, m, radius, sine: s }, (excess.hi * (edge * c.hi)).abs())
    }

    /// NaN in the place of n and m whose signs the errors of sine and cosine leave open. Without a difference there is
    /// nothing to be unsure of: a ball has none in n, and a disk, whose ell is 0.
    #[inline(always)]
    fn sure(&self, of: RoundedTerms<T>, angle: &SinCos<T>, bend: T) -> RoundedTerms<T> {
        let (out, lever) = (self.a.hi * angle.cos.hi, (self.ell * of.sine.hi).abs());
        let unsure = out.splat(UNSURE);
        let sum = out.splat(UNSURE_SUM) * of.n.hi.abs().min((of.m.hi - of.n.hi).abs());
        of.known([unsure * lever.min(out.abs()), unsure.fma(lever + bend, sum)])
    }

    /// 1 in the lanes where m has too few digits for what kappa_c leaves, elsewhere 0.
    #[inline(always)]
    fn bent(&self, theta: T, (s, c): (T, T), of: &RoundedTerms<T>, bend: T) -> T {
        let (zero, one) = (s.splat(0.0), s.splat(1.0));
        let (n, m, radius) = (of.n.hi, of.m.hi, of.radius.hi);
        // over the sine n and A of a ball do not change
        let rim = Rim { ell: self.ell, a: self.a.hi, rho: self.rho };
        let n_slope = self.ball(zero, -rim.slope((s, c)));
        let reach_slope = self.ball(-(self.rho * s), self.rho * c * c - s * radius);
        let beside = self.ball(zero, n_slope / n + self.rho * c / radius - c / s);
        let steep = beside * m - (n_slope + self.excess.hi * reach_slope);
        let steep = s.splat(0.5) * theta * steep.abs();
        (s.splat(BENT) * (m.abs() + steep)).select_lt(bend, one, zero)
    }

    /// The terms in twice the digits, m in a form in which 1 - |cos| or 1 - sin, whichever is small, keeps its own:
    ///
    /// ```text
    /// next to pi/2   m = c (a + d - d rho (1 - s)) - ell s;   elsewhere, with w the sign of the cosine,
    /// m = c a (1 + d) + s (w d rho - ell - w d rho (1 - |c|))
    /// ```
    #[inline(always)]
    fn careful(&self, theta: T) -> RoundedTerms<T> {
        let Self { a, excess, .. } = *self;
        let (zero, one) = (theta.splat(0.0), theta.splat(1.0));
        let (ell, rho) = (Sum { hi: self.ell, lo: zero }, Sum { hi: self.rho, lo: zero });
        let rim = Rim { ell, a, rho };
        let [sin, c, sin_fall, cos_fall] = long_sin_cos_falls(theta);
        let s = select(zero, a.hi, sin, Sum { hi: one, lo: zero });
        let edge = excess * rho;
        let turned = select(c.hi, zero, -edge, edge);
        let n = -rim.lever((s, c));
        // what the cosine and what the sine is multiplied by; over the sine A of a ball, which has no a, is rho
        let wide = select(zero, a.hi, a + excess - edge * sin_fall, edge);
        let flat = c * select(c.hi.abs(), sin.hi, wide, a + a * excess);
        let high = s * select(c.hi.abs(), sin.hi, -ell, turned - ell - turned * cos_fall);
        let m = flat + high;
        let least = theta.splat(UNSURE_LONG) * flat.hi.abs().min(high.hi.abs());
        let sum = theta.splat(UNSURE_SUM) * n.hi.abs().min((m.hi - n.hi).abs());
        RoundedTerms { n, m, radius: rim.radius((s, c)), sine: s }.known([zero, least + sum])
    }
}

impl<T: Real> RoundedTerms<T> {
    /// NaN in the place of n and m below these limits.
    #[inline(always)]
    fn known(self, limits: [T; 2]) -> Self {
        let nan = self.n.hi.splat(f64::NAN);
        let n = Sum { hi: limits[0].select_lt(self.n.hi.abs(), self.n.hi, nan), lo: self.n.lo };
        let m = Sum { hi: limits[1].select_lt(self.m.hi.abs(), self.m.hi, nan), lo: self.m.lo };
        Self { n, m, ..self }
    }
}

/// The steady rate from its terms; theta in (0, `most`].
#[inline(always)]
pub(crate) fn rounded_rate<T: Real>(theta: T, most: T, of: &RoundedTerms<T>) -> T {
    let root_up = of.sine.hi.select_lt(
        theta.splat(SMALL),
        theta.splat(f64::from_bits(0x4F90_0000_0000_0000)),
        theta.splat(1.0),
    ); // 2^250
    scaled(theta, most, of).sqrt() * root_up
}

/// Its square, for a comparison: infinite where theta is subnormal.
#[inline(always)]
pub(crate) fn rounded_square<T: Real>(theta: T, most: T, of: &RoundedTerms<T>) -> T {
    let up = of.sine.hi.select_lt(
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
    let RoundedTerms { n, m, radius, sine } = *of;
    let up = sine.hi.select_lt(x(SMALL), x(f64::from_bits(0x5F30_0000_0000_0000)), x(1.0)); // 2^500
    let (sh, sl) = (sine.hi * up, sine.lo * up);
    let over = n.hi * radius.hi;
    let over_lo = n.hi.fma(radius.hi, -over) + n.hi.fma(radius.lo, n.lo * radius.hi);
    let under = m.hi * sh;
    let under_lo = m.hi.fma(sh, -under) + m.hi.fma(sl, m.lo * sh);
    // One division and its remainder: only the square root rounds the result a second time.
    let inverse = x(1.0) / under;
    let q = over * inverse;
    let rest = (-q).fma(under, over) + (-q).fma(under_lo, over_lo);
    let square = rest.fma(inverse, q);
    let (zero, nan) = (x(0.0), x(f64::NAN));
    // below zero there is no steady state
    let square = square.select_lt(zero, nan, square);
    most.select_lt(theta, nan, zero.select_lt(theta, square, nan))
}
