//! The squared rate of a rounded rim, its numerator and its denominator.
//!
//! ```text
//! rate^2 = n A/(s m),   n = a cos - ell sin,   m = n + d A cos,   A = a + rho sin
//! ball:  rate^2 = ell/(ell - d rho cos)      n, m and A over the sine that they share
//! ```
//! The balance w2' = 0 of `contact::reduced` with the centre at rest, w3 = (L/A) w1, gives the rate; see Jackson,
//! Mertens, Pearson, Am. J. Phys. 83, 959 (2015), for two balls. For rho = 0 it is Eq. 15 of Jackson et al., Am. J.
//! Phys. 87, 85 (2019).
//!
//! Error of the rate: at most 2 (1 + kappa_c) ulp of 2^-53, kappa_c = |dlog rate/dlog theta|, plus 2^-100 |n/m|, for
//! every double theta within the range of the body. Tests of `laws` and of `test_rounded_reference` check it.
//!
//! An error of sine and cosine consists of a rotation, which changes the rate as an error of theta does, and
//! of a common factor 1 + e. For a sharp rim that factor cancels, because n and m have the same degree in
//! sine and cosine. For a rounded rim it changes log rate by e (d rho s c/m + a/A)/2, with |e| below 1/8 ulp.
//! Next to folds, where kappa_c vanishes, m may be a thousand times smaller than d rho s c; m is then formed
//! with twice the digits.

use crate::laws::body::Rim;
use crate::numbers::{Lane, Real, SinCos, Sum, long_sin_cos_falls};

/// Three bounds, relative to the terms that were subtracted, below which a sign is not known: the errors of sine and
/// cosine, their errors with twice the digits, and the errors of sums of two doubles.
const ROUNDED_UNSURE: f64 = 1.0 / (1_u64 << 54) as f64;
const UNSURE_LONG: f64 = 1.0 / (1_u128 << 98) as f64;
const UNSURE_SUM: f64 = ROUNDED_UNSURE * ROUNDED_UNSURE;

/// Where |d rho s c| exceeds |m| (1 + kappa_c) by this factor, m has too few digits: the rate is off by half an ulp.
const BENT: f64 = 8.0;

/// A sine below `SMALL_SINE` is scaled by `SMALL_SINE_SCALE`, an even power of two, since a subnormal sine times a number would lose digits.
const SMALL_SINE: f64 = f64::from_bits(0x20B0_0000_0000_0000); // 2^-500
const SMALL_SINE_SCALE: f64 = f64::from_bits(0x5F30_0000_0000_0000); // 2^500

/// The terms n and m of the squared rate, with its factors A and sin theta; A is 1 on a sharp rim.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RateTerms<T> {
    /// n and m, for a ball divided by the sine; each is NaN where its sign is not known.
    pub n: Sum<T>,
    pub m: Sum<T>,
    /// The radius A of the circle of contact, for a ball divided by the sine.
    pub radius: Sum<T>,
    /// The sine of theta; for a ball 1.
    pub sine: Sum<T>,
}

/// The numbers of a body that enter the terms of the squared rate: ell, rho, a and d.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoundedParts<T> {
    pub ell: T,
    pub rho: T,
    pub a: Sum<T>,
    pub excess: Sum<T>,
}

impl RoundedParts<f64> {
    /// The terms of the squared rate at one inclination.
    #[inline(always)]
    pub fn terms(&self, theta: f64, angle: &SinCos<f64>) -> RateTerms<f64> {
        let (terms, spare) = self.quick(angle);
        if spare >= 0.0 || spare.is_nan() {
            return terms;
        }
        let (careful, bent) = self.carefully(theta, angle);
        if bent > 0.5 { careful } else { terms }
    }
}

impl<T: Lane> RoundedParts<T> {
    /// The terms of the squared rate, with twice the digits if any SIMD lane needs them; and 1 in the lanes that need
    /// them, 0 elsewhere.
    #[inline(always)]
    pub fn carefully(&self, theta: T, angle: &SinCos<T>) -> (RateTerms<T>, T) {
        let (terms, bend) = self.terms_and_size(angle);
        let bent = self.where_digits_lack(theta, (angle.sin.hi, angle.cos.hi), &terms, bend);
        // Most points with a small m lie next to thetaInf, where kappa_c is large too and the digits suffice.
        (if bent.any() { self.terms_with_twice_the_digits(theta) } else { terms }, bent)
    }
}

/// Returns `yes` where `x < limit`, `no` elsewhere.
#[inline(always)]
fn select<T: Real>(x: T, limit: T, yes: Sum<T>, no: Sum<T>) -> Sum<T> {
    Sum { hi: x.select_lt(limit, yes.hi, no.hi), lo: x.select_lt(limit, yes.lo, no.lo) }
}

impl<T: Real> RoundedParts<T> {
    /// Returns `yes` in SIMD lanes with a ball, `no` in lanes with other bodies.
    #[inline(always)]
    fn ball(&self, yes: T, no: T) -> T {
        yes.splat(0.0).select_lt(self.a.hi, no, yes)
    }

    /// The terms of the squared rate by few operations, and a number that is negative where m may have too few digits.
    #[inline(always)]
    pub fn quick(&self, angle: &SinCos<T>) -> (RateTerms<T>, T) {
        let (terms, bend) = self.terms_and_size(angle);
        (self.without_uncertain_signs(terms, angle, bend), terms.m.hi.abs() * bend.splat(BENT) - bend)
    }

    /// The terms of the squared rate, also where their signs are uncertain, and |d rho s c|, for a ball divided by the sine.
    #[inline(always)]
    fn terms_and_size(&self, angle: &SinCos<T>) -> (RateTerms<T>, T) {
        let Self { ell, rho, a, excess } = *self;
        let c = angle.cos;
        let s =
            Sum { hi: self.ball(ell.splat(1.0), angle.sin.hi), lo: self.ball(ell.splat(0.0), angle.sin.lo) };
        let (out, lever) = (a.hi * c.hi, ell * s.hi);
        // `off` is the rounding error of the two products plus the parts of n from the low parts of a, sine and cosine.
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
        (RateTerms { n, m, radius, sine: s }, (excess.hi * (edge * c.hi)).abs())
    }

    /// Replaces n and m by NaN where the errors of sine and cosine leave their signs open. The sign of n is known where
    /// n is not a difference: for a ball, and for a disk (ell = 0).
    #[inline(always)]
    fn without_uncertain_signs(&self, of: RateTerms<T>, angle: &SinCos<T>, bend: T) -> RateTerms<T> {
        let (out, lever) = (self.a.hi * angle.cos.hi, (self.ell * of.sine.hi).abs());
        let unsure = out.splat(ROUNDED_UNSURE);
        let sum = out.splat(UNSURE_SUM) * of.n.hi.abs().min((of.m.hi - of.n.hi).abs());
        of.nan_where_small([unsure * lever.min(out.abs()), unsure.fma(lever + bend, sum)])
    }

    /// 1 in the SIMD lanes where m has too few digits for an error below 2 (1 + kappa_c) ulp, 0 elsewhere.
    #[inline(always)]
    fn where_digits_lack(&self, theta: T, (s, c): (T, T), of: &RateTerms<T>, bend: T) -> T {
        let (zero, one) = (s.splat(0.0), s.splat(1.0));
        let (n, m, radius) = (of.n.hi, of.m.hi, of.radius.hi);
        // For a ball, n and A divided by the sine are constants.
        let rim = Rim { ell: self.ell, a: self.a.hi, rho: self.rho };
        let n_slope = self.ball(zero, -rim.slope((s, c)));
        let reach_slope = self.ball(-(self.rho * s), self.rho * c * c - s * radius);
        let beside = self.ball(zero, n_slope / n + self.rho * c / radius - c / s);
        let steep = beside * m - (n_slope + self.excess.hi * reach_slope);
        let steep = s.splat(0.5) * theta * steep.abs();
        (s.splat(BENT) * (m.abs() + steep)).select_lt(bend, one, zero)
    }

    /// The terms of the squared rate with twice the digits. The form of m keeps the digits of 1 - |cos| or 1 - sin,
    /// whichever is small:
    ///
    /// ```text
    /// next to pi/2   m = c (a + d - d rho (1 - s)) - ell s;   elsewhere, with w the sign of the cosine,
    /// m = c a (1 + d) + s (w d rho - ell - w d rho (1 - |c|))
    /// ```
    #[inline(always)]
    fn terms_with_twice_the_digits(&self, theta: T) -> RateTerms<T> {
        let Self { a, excess, .. } = *self;
        let (zero, one) = (theta.splat(0.0), theta.splat(1.0));
        let (ell, rho) = (Sum { hi: self.ell, lo: zero }, Sum { hi: self.rho, lo: zero });
        let rim = Rim { ell, a, rho };
        let [sin, c, sin_fall, cos_fall] = long_sin_cos_falls(theta);
        let s = select(zero, a.hi, sin, Sum { hi: one, lo: zero });
        let edge = excess * rho;
        let turned = select(c.hi, zero, -edge, edge);
        let n = -rim.lever((s, c));
        // `flat` is the part of m with the cosine, `high` that with the sine; for a ball a = 0 and A/sine is rho.
        let wide = select(zero, a.hi, a + excess - edge * sin_fall, edge);
        let flat = c * select(c.hi.abs(), sin.hi, wide, a + a * excess);
        let high = s * select(c.hi.abs(), sin.hi, -ell, turned - ell - turned * cos_fall);
        let m = flat + high;
        let least = theta.splat(UNSURE_LONG) * flat.hi.abs().min(high.hi.abs());
        let sum = theta.splat(UNSURE_SUM) * n.hi.abs().min((m.hi - n.hi).abs());
        RateTerms { n, m, radius: rim.radius((s, c)), sine: s }.nan_where_small([zero, least + sum])
    }
}

impl<T: Real> RateTerms<T> {
    /// Replaces n and m by NaN where their sizes are below these limits.
    #[inline(always)]
    pub fn nan_where_small(self, limits: [T; 2]) -> Self {
        let nan = self.n.hi.splat(f64::NAN);
        let n = Sum { hi: limits[0].select_lt(self.n.hi.abs(), self.n.hi, nan), lo: self.n.lo };
        let m = Sum { hi: limits[1].select_lt(self.m.hi.abs(), self.m.hi, nan), lo: self.m.lo };
        Self { n, m, ..self }
    }

    /// Returns `yes` where the sine is so small that it is scaled, else 1.
    #[inline(always)]
    fn if_small(&self, yes: f64) -> T {
        let sine = self.sine.hi;
        sine.select_lt(sine.splat(SMALL_SINE), sine.splat(yes), sine.splat(1.0))
    }

    /// The reduced rate of the steady state for theta in (0, `most`]; NaN elsewhere.
    #[inline(always)]
    pub fn rate(&self, theta: T, most: T) -> T {
        self.scaled(theta, most).sqrt() * self.if_small(f64::from_bits(0x4F90_0000_0000_0000)) // 2^250
    }

    /// The square of the reduced rate, for comparisons only: it is infinite where theta is subnormal.
    #[inline(always)]
    pub fn square(&self, theta: T, most: T) -> T {
        self.scaled(theta, most) * self.if_small(SMALL_SINE_SCALE)
    }

    /// The square of the reduced rate, divided by 2^500 where the sine is below `SMALL_SINE`.
    #[inline(always)]
    fn scaled(&self, theta: T, most: T) -> T {
        let x = |v: f64| theta.splat(v);
        let (Self { n, m, radius, sine }, up) = (*self, self.if_small(SMALL_SINE_SCALE));
        let (sh, sl) = (sine.hi * up, sine.lo * up);
        let over = n.hi * radius.hi;
        let over_lo = n.hi.fma(radius.hi, -over) + n.hi.fma(radius.lo, n.lo * radius.hi);
        let under = m.hi * sh;
        let under_lo = m.hi.fma(sh, -under) + m.hi.fma(sl, m.lo * sh);
        // The remainder corrects the one division, so that only the square root rounds the result a second time.
        let inverse = x(1.0) / under;
        let q = over * inverse;
        let rest = (-q).fma(under, over) + (-q).fma(under_lo, over_lo);
        let square = rest.fma(inverse, q);
        let (zero, nan) = (x(0.0), x(f64::NAN));
        // A negative square means that no steady state exists.
        let square = square.select_lt(zero, nan, square);
        most.select_lt(theta, nan, zero.select_lt(theta, square, nan))
    }
}
