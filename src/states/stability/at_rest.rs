//! Kappa, rate and energy of the steady state with the centre at rest in closed form, for maps. For any other state
//! `stability` computes kappa with dual numbers, which takes longer.
//!
//! ```text
//! sharp, with n and m = n + d cos of `steady`, r = I1/I3:
//!   smooth   U''     = (n/s)(m/r + cos + r/m) - (ell cos + sin)
//!   rolling  J kappa = n X/(I3 m s) - (ell cos + sin)
//!            X = I1 + ((2 I1 + ell^2) c + ell (1 - I3) s)(c - (I3^2 ell/D) s) + ((I3 + 1) s + ell c) s (I1 + I3 ell^2)/D
//! rounded, w1 = Omega s, w3 = Omega L sigma, sigma = s/A (1/rho of a ball), W = Omega^2 = n/(I3 sigma m), m = n + d c A:
//!   smooth   kappa   = (W (I1 + (2 c I1 - I3 L sigma)(c I1 - I3 L sigma)/I1) - g')/(I1 + g^2)
//!   rolling  J kappa = W (I1 - 2 I1 c u + I3 (u L sigma + s v) + h z) - g'
//!            u = (I3 L sigma/D)(I3 + rho (s A + c L)) - c,   v = (s/D)(I1 a A + L (I3 L - I1 rho c))
//!            z = rho (c L sigma + s^2) + A v - L u
//!   energy   W (I1 s^2 + I3 (L sigma)^2)/2 + h
//! ```
//! u, v and z are dw1/dtheta, dw3/dtheta and dV/dtheta along the lines of `contact::reduced`, over Omega. A property of
//! `laws` compares the closed forms with the dual numbers.
//!
//! Error of `kappa`: 16 (1 + cond) ulp of the larger of its terms, where cond = cos/|n| + (r cos + ell sin)/|m|
//! measures how close theta is to theta0 or thetaInf. A test of `hard_cases` checks it.

use crate::laws::body::{Body, Rim, rounded_tube, tube, tube_or_nan};
use crate::numbers::{Narrow, Real, Short, SinCos, Sum, sincos};
use crate::states::steady::{
    RateTerms, RoundedParts, quick_angle, quick_terms, rare_rate, single_rate, terms,
};
use core::f64::consts::FRAC_PI_2;

use super::region::region_of;

/// The numbers of a body that enter kappa, computed once for all inclinations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moments<T> {
    pub(super) ell: T,
    excess: Sum<T>,
    i1: T,
    ratio: T,
    // The numbers tilt, along, across, drag, lift and spin give X/(I3 J) = tilt + (along c + across s)(c - drag s) + lift (spin s + ell c) s.
    tilt: T,
    along: T,
    across: T,
    drag: T,
    lift: T,
    spin: T,
    inverse_j: T,
}

impl Moments<f64> {
    pub fn of(body: &Body) -> Self {
        Self::from_moments(body.ell(), [body.i1(), body.i3()], body.excess_sum())
    }
}

impl<T: Real> Moments<T> {
    /// The numbers of a uniform tube; NaN where no such tube exists.
    #[inline(always)]
    pub fn tube(ell: T, bore: T) -> Self {
        let (moments, excess) = tube(ell, bore);
        Self::from_moments(tube_or_nan(ell, bore), moments, excess)
    }

    #[inline(always)]
    pub(super) fn from_moments(ell: T, [i1, i3]: [T; 2], excess: Sum<T>) -> Self {
        let one = ell.splat(1.0);
        let square = ell * ell;
        let (j, d) = (i1 + one + square, i1 * i3 + i1 + i3 * ell * ell);
        let ratio = one + excess.hi;
        Self {
            ell,
            excess,
            i1,
            ratio,
            tilt: ratio / j,
            along: (i1 + i1 + square) / j / i3,
            across: ell * (one - i3) / j / i3,
            drag: i3 * i3 * ell / d,
            lift: (i1 + i3 * ell * ell) / d / j / i3,
            spin: i3 + one,
            inverse_j: one / j,
        }
    }
}

impl<T: Copy> Moments<T> {
    #[inline(always)]
    pub(super) fn numbers(&self) -> [T; 12] {
        let Self { ell, excess, i1, ratio, tilt, along, across, drag, lift, spin, inverse_j } = *self;
        [ell, excess.hi, excess.lo, i1, ratio, tilt, along, across, drag, lift, spin, inverse_j]
    }

    #[inline(always)]
    pub(super) fn from_numbers(x: [T; 12]) -> Self {
        let [ell, hi, lo, i1, ratio, tilt, along, across, drag, lift, spin, inverse_j] = x;
        Self { ell, excess: Sum { hi, lo }, i1, ratio, tilt, along, across, drag, lift, spin, inverse_j }
    }

    /// Applies `f` to each number, for example to load it into SIMD lanes.
    #[inline(always)]
    pub fn map<U: Copy>(&self, f: impl Fn(T) -> U) -> Moments<U> {
        Moments::from_numbers(self.numbers().map(f))
    }
}

/// Kappa on a smooth table of the state with the centre at rest, from n and m; NaN where no such state exists.
#[inline(always)]
fn smooth_at_rest<T: Real>((s, c): (T, T), [n, m]: [T; 2], of: &Moments<T>) -> T {
    let inertia = n.fma(n, of.i1);
    let turning = n * (m / of.ratio + c + of.ratio / m) / inertia;
    where_rate_is_real([n, m], turning / s - of.ell.fma(c, s) / inertia)
}

/// Kappa in rolling of the state with the centre at rest, from n and m; NaN where no such state exists.
#[inline(always)]
fn rolling_at_rest<T: Real>((s, c): (T, T), [n, m]: [T; 2], of: &Moments<T>) -> T {
    let turn = of.along.fma(c, of.across * s) * (-of.drag).fma(s, c);
    let x = of.tilt + turn + of.lift * of.spin.fma(s, of.ell * c) * s;
    where_rate_is_real([n, m], (n / m) * x / s - of.ell.fma(c, s) * of.inverse_j)
}

/// Energy of the state with the centre at rest, in M g R: (I1/I3 + ell^2) rate^2 sin^2/2 + ell cos + sin; NaN where no
/// such state exists.
#[inline(always)]
fn energy_at_rest<T: Real>((s, c): (T, T), [n, m]: [T; 2], of: &Moments<T>) -> T {
    let moment = of.ell.splat(0.5) * (of.ratio + of.ell * of.ell);
    where_rate_is_real([n, m], (n / m) * s * moment + of.ell.fma(c, s))
}

/// Returns `x` where the squared rate n/(m s) is positive, NaN elsewhere.
#[inline(always)]
fn where_rate_is_real<T: Real>([n, m]: [T; 2], x: T) -> T {
    let (zero, nan) = (x.splat(0.0), x.splat(f64::NAN));
    let sign = m.select_lt(zero, -n, n);
    zero.select_lt(sign, x, nan)
}

/// Returns `x` where theta is in (0, `most`] and the squared rate n/(m s) is positive, NaN elsewhere.
#[inline(always)]
fn where_steady<T: Real>(theta: T, most: T, [n, m]: [T; 2], x: T) -> T {
    let (zero, nan) = (x.splat(0.0), x.splat(f64::NAN));
    let steady = where_rate_is_real([n, m], x);
    most.select_lt(theta, nan, zero.select_lt(theta, steady, nan))
}

/// The numbers of a body on a rounded rim that enter kappa, rate and energy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rounded<T> {
    ell: T,
    rho: T,
    a: Sum<T>,
    excess: Sum<T>,
    i1: T,
    i3: T,
    per_i1: T,
    /// The largest inclination for which steady states are computed.
    most: T,
}

impl<T: Real> Rounded<T> {
    /// The numbers of a uniform tube with rounded edges; NaN where no such tube exists or its edges are sharp.
    #[inline(always)]
    pub fn tube(half: T, bore: T, fillet: T) -> Self {
        let (zero, nan, one) = (half.splat(0.0), half.splat(f64::NAN), half.splat(1.0));
        let ell = half - fillet;
        let ([i1, i3], excess) = rounded_tube(ell, bore, fillet);
        // The fillet is at most half the length, and at most the wall.
        let known = tube_or_nan(half, bore);
        let within = one.select_lt(fillet + bore, nan, known.select_lt(fillet, nan, ell));
        let ell = zero.select_lt(fillet, within, nan) + (bore + known + fillet) * zero;
        let most = zero.select_lt(ell, half.splat(FRAC_PI_2), half.splat(core::f64::consts::PI));
        Self { ell, rho: fillet, a: Sum::of(one, -fillet), excess, i1, i3, per_i1: one / i1, most }
    }

    #[inline(always)]
    fn rim(&self) -> Rim<T> {
        Rim { ell: self.ell, a: self.a.hi, rho: self.rho }
    }

    /// The squared precession rate Omega^2, and L sigma with sigma = s/A; one division serves both.
    #[inline(always)]
    fn turning(&self, angle: (T, T), of: &RateTerms<T>) -> [T; 2] {
        let (radius, sine) = (of.radius.hi, of.sine.hi);
        let under = self.i3 * sine * of.m.hi;
        let inverse = radius.splat(1.0) / (radius * under);
        let (per_radius, per_under) = (inverse * under, inverse * radius);
        [of.n.hi * radius * per_under, self.rim().depth(angle) * (sine * per_radius)]
    }

    #[inline(always)]
    fn parts(&self) -> RoundedParts<T> {
        RoundedParts { ell: self.ell, rho: self.rho, a: self.a, excess: self.excess }
    }

    /// The requested quantities at the inclination `theta`, from the terms of the squared rate.
    #[inline(always)]
    fn point(&self, theta: T, angle: &SinCos<T>, of: &RateTerms<T>, wanted: Wanted) -> SteadyPoint<T> {
        let plain = (angle.sin.hi, angle.cos.hi);
        let mut found = SteadyPoint::nothing(theta);
        if wanted.rate {
            found.rate = of.rate(theta, self.most);
        }
        if wanted.squared {
            found.rate = of.square(theta, self.most);
        }
        if wanted.energy {
            found.energy = self.energy(theta, plain, of);
        }
        if wanted.rolling || wanted.region {
            found.rolling = self.rolling(theta, plain, of);
        }
        if wanted.smooth || wanted.region {
            found.smooth = self.smooth(theta, plain, of);
        }
        if wanted.region {
            let of = [of.n.hi, of.m.hi];
            found.region = region_of(theta, self.most, self.ell, of, found.smooth, found.rolling);
        }
        found
    }

    #[inline(always)]
    fn smooth(&self, theta: T, (s, c): (T, T), of: &RateTerms<T>) -> T {
        let (rim, [square, axial]) = (self.rim(), self.turning((s, c), of));
        let (lean, spin) = (c * self.i1, self.i3 * axial);
        let lever = rim.lever((s, c));
        let turning = self.i1 + (lean + lean - spin) * (c - spin * self.per_i1);
        let kappa = (square * turning - rim.slope((s, c))) / lever.fma(lever, self.i1);
        where_steady(theta, self.most, [of.n.hi, of.m.hi], kappa)
    }

    #[inline(always)]
    fn rolling(&self, theta: T, (s, c): (T, T), of: &RateTerms<T>) -> T {
        let (rim, [square, axial]) = (self.rim(), self.turning((s, c), of));
        let (i1, i3, angle) = (self.i1, self.i3, (s, c));
        let (radius, depth, hub) = (rim.radius(angle), rim.depth(angle), rim.rho * c);
        let (wide, deep) = (radius * radius, depth * depth);
        let (d, inertia) = (i1 * (i3 + wide) + i3 * deep, i1 + wide + deep);
        let inverse = s.splat(1.0) / (d * inertia);
        let (per_d, per_inertia) = (inverse * inertia, inverse * d);
        let u = i3 * axial * (i3 + rim.rho * (s * radius + c * depth)) * per_d - c;
        let v = s * (i1 * rim.a * radius + depth * (i3 * depth - i1 * hub)) * per_d;
        let z = rim.rho * (c * axial + s * s) + radius * v - depth * u;
        let lean = i1 * c * u;
        let x = i1 - (lean + lean) + i3 * (u * axial + s * v) + rim.height(angle) * z;
        where_steady(theta, self.most, [of.n.hi, of.m.hi], (square * x - rim.slope(angle)) * per_inertia)
    }

    #[inline(always)]
    fn energy(&self, theta: T, (s, c): (T, T), of: &RateTerms<T>) -> T {
        let [square, axial] = self.turning((s, c), of);
        let turning = self.i1 * s * s + self.i3 * axial * axial;
        let energy = s.splat(0.5) * square * turning + self.rim().height((s, c));
        where_steady(theta, self.most, [of.n.hi, of.m.hi], energy)
    }
}

/// The quantities that are requested at a point of a map: rate (or its square), kappa in rolling and on a smooth table,
/// energy, region.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Wanted {
    pub rate: bool,
    pub squared: bool,
    /// Whether the rate of a sharp rim is requested in single precision.
    pub single: bool,
    pub rolling: bool,
    pub smooth: bool,
    pub energy: bool,
    pub region: bool,
}

/// The quantities at a point of a map; those that are not requested are NaN.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SteadyPoint<T> {
    pub rate: T,
    pub rolling: T,
    pub smooth: T,
    pub energy: T,
    pub region: T,
}

impl<T: Real> SteadyPoint<T> {
    /// A point with all quantities NaN.
    #[inline(always)]
    pub fn nothing(like: T) -> Self {
        let nan = like.splat(f64::NAN);
        Self { rate: nan, rolling: nan, smooth: nan, energy: nan, region: nan }
    }

    /// Combines this point and another one: `pick` chooses each quantity from both.
    #[inline(always)]
    #[must_use]
    pub fn with(self, other: Self, pick: impl Fn(T, T) -> T) -> Self {
        Self {
            rate: pick(self.rate, other.rate),
            rolling: pick(self.rolling, other.rolling),
            smooth: pick(self.smooth, other.smooth),
            energy: pick(self.energy, other.energy),
            region: pick(self.region, other.region),
        }
    }
}

impl<T: Real> Moments<T> {
    /// The requested quantities except the rate, from theta, its sine and cosine, and n and m; n or m is NaN where its
    /// sign is not known.
    #[inline(always)]
    fn other_quantities(&self, theta: T, angle: (T, T), of: [T; 2], wanted: Wanted) -> SteadyPoint<T> {
        let mut found = SteadyPoint::nothing(theta);
        if wanted.energy {
            found.energy = energy_at_rest(angle, of, self);
        }
        if wanted.rolling || wanted.region {
            found.rolling = rolling_at_rest(angle, of, self);
        }
        if wanted.smooth || wanted.region {
            found.smooth = smooth_at_rest(angle, of, self);
        }
        if wanted.region {
            found.region =
                region_of(theta, theta.splat(FRAC_PI_2), self.ell, of, found.smooth, found.rolling);
        }
        found
    }

    /// The requested quantities, computed with more digits, for any inclination, also tiny or outside (0, pi/2].
    #[inline(always)]
    fn carefully(&self, theta: T, wanted: Wanted) -> SteadyPoint<T> {
        let angle = sincos(theta);
        let of = terms(&angle, self.ell, self.excess);
        let (sin, cos, [n, m]) = (angle.sin.hi, angle.cos.hi, [of.n.hi, of.m.hi]);
        let mut found = self.other_quantities(theta, (sin, cos), [n, m], wanted);
        let most = theta.splat(FRAC_PI_2);
        found.rolling = where_steady(theta, most, [n, m], found.rolling);
        found.smooth = where_steady(theta, most, [n, m], found.smooth);
        found.energy = where_steady(theta, most, [n, m], found.energy);
        if wanted.rate {
            found.rate = of.rate(theta, most);
        }
        if wanted.squared {
            found.rate = of.square(theta, most);
        }
        found
    }
}

impl<T: Narrow> AtRest<T> for Moments<T> {
    type Angle = Short<T>;

    #[inline(always)]
    fn angle(theta: T) -> Short<T> {
        quick_angle(theta)
    }

    #[inline(always)]
    fn found(&self, theta: T, angle: &Short<T>, wanted: Wanted) -> SteadyPoint<T> {
        let of = quick_terms(angle, self.ell, self.excess);
        let mut found = self.other_quantities(theta, (angle.sin.hi, angle.cos.hi), of.rounded(), wanted);
        if wanted.rate {
            found.rate = if wanted.single {
                let of = *self;
                T::wide(single_rate(angle, of.ell, of.excess.hi, || rare_rate(theta, of.ell, of.excess)))
            } else {
                of.square(angle.sin).sqrt()
            };
        }
        if wanted.squared {
            let (square, zero) = (of.square(angle.sin), theta.splat(0.0));
            found.rate = square.select_lt(zero, theta.splat(f64::NAN), square);
        }
        if !of.in_doubt() {
            return found;
        }
        // The closure owns a copy, because a borrowed `self` would be kept in memory for all points.
        let of_it = *self;
        let careful = theta.aside(
            #[inline(always)]
            move || of_it.carefully(theta, wanted),
        );
        careful.with(
            found,
            #[inline(always)]
            |careful, quick| of.where_certain(careful, quick),
        )
    }
}

impl<T: Narrow> AtRest<T> for Rounded<T> {
    type Angle = SinCos<T>;

    #[inline(always)]
    fn angle(theta: T) -> SinCos<T> {
        sincos(theta)
    }

    #[inline(always)]
    fn found(&self, theta: T, angle: &SinCos<T>, wanted: Wanted) -> SteadyPoint<T> {
        let (of, spare) = self.parts().quick(angle);
        let found = self.point(theta, angle, &of, wanted);
        if !spare.any_lt(theta.splat(0.0)) {
            return found;
        }
        // The closure owns copies, because borrowed values would be kept in memory for all points.
        let (of_it, angle) = (*self, *angle);
        let (careful, bent) = theta.aside(
            #[inline(always)]
            move || {
                let (of, bent) = of_it.parts().carefully(theta, &angle);
                (of_it.point(theta, &angle, &of, wanted), bent)
            },
        );
        let half = theta.splat(0.5);
        careful.with(
            found,
            #[inline(always)]
            |careful, quick| half.select_lt(bent, careful, quick),
        )
    }
}

/// The computation of quantities at one inclination, for bodies with sharp or with rounded rims.
pub(crate) trait AtRest<T: Real> {
    /// Sine and cosine, to as many digits as these bodies need.
    type Angle;

    fn angle(theta: T) -> Self::Angle;

    /// The requested quantities at the inclination `theta`, whose sine and cosine are `angle`.
    fn found(&self, theta: T, angle: &Self::Angle, wanted: Wanted) -> SteadyPoint<T>;
}

impl Rounded<f64> {
    pub fn of(body: &Body) -> Self {
        let (ell, rho, a, excess) = (body.ell(), body.fillet(), body.rim_sum(), body.excess_sum());
        let (i1, i3, most) = (body.i1(), body.i3(), body.rests_up_to());
        Self { ell, rho, a, excess, i1, i3, per_i1: 1.0 / i1, most }
    }
}

impl<T: Copy> Rounded<T> {
    #[inline(always)]
    pub(super) fn numbers(&self) -> [T; 10] {
        let Self { ell, rho, a, excess, i1, i3, per_i1, most } = *self;
        [ell, rho, a.hi, a.lo, excess.hi, excess.lo, i1, i3, per_i1, most]
    }

    #[inline(always)]
    pub(super) fn from_numbers(x: [T; 10]) -> Self {
        let [ell, rho, hi, lo, excess, excess_lo, i1, i3, per_i1, most] = x;
        Self { ell, rho, a: Sum { hi, lo }, excess: Sum { hi: excess, lo: excess_lo }, i1, i3, per_i1, most }
    }
}
