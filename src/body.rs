//! The body: an aspect ratio and two moments of inertia.
//!
//! ```text
//! ell = l/R,   I3 = (1 + q^2)/2,   I1 = I3/2 + ell^2/3          uniform tube of bore q = R_inner/R
//! d = I1/I3 - 1 = (4 ell^2 - 3 (1 + q^2)) / (6 (1 + q^2))       inertia excess; d = 0 is critical
//! theta0 = atan2(1, ell),   thetaInf = atan2(I1/I3, ell)
//! ```
//! Lengths in units of the rim radius R, moments in M R^2. `l` is the height of the centre of mass
//! above the lower rim plane, half the length of a uniform tube. Jackson et al., Am. J. Phys. 87,
//! 85 (2019), Sec. II; the moments are those of any textbook.
//!
//! The constructors refuse what cannot be a body; nothing after them checks again. The excess is
//! kept as an unevaluated sum of two doubles, because a body near the critical shape owes its
//! character to the last digits of it: relative error of `d` below 2^-100 (a test runs it).

use crate::error::{Error, within};
use crate::real::Real;
use crate::sum::Sum;

const ELL: (f64, f64) = (0.0, 1e150);
const I1: (f64, f64) = (1e-150, 1e300);
const I3: (f64, f64) = (1e-150, 1e150);

/// A rigid body of revolution that touches the table with its lower rim.
///
/// Natural units: mass M, rim radius R and gravity g are 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    ell: f64,
    i1: f64,
    i3: f64,
    excess: Sum<f64>,
}

impl Body {
    /// Solid cylinder of aspect ratio `ell` in [0, 1e150]; `ell = 0` is the thin disk.
    pub fn solid(ell: f64) -> Result<Self, Error> {
        Self::tube(ell, 0.0)
    }

    /// Uniform tube of aspect ratio `ell` in [0, 1e150] whose `bore` in [0, 1] is inner over outer
    /// radius: 0 solid, 1 a thin wall (a hoop for `ell = 0`).
    pub fn tube(ell: f64, bore: f64) -> Result<Self, Error> {
        within("ell", ell, ELL, "0 <= ell <= 1e150")?;
        within("bore", bore, (0.0, 1.0), "0 <= bore <= 1")?;
        let ([i1, i3], excess) = tube(ell, bore);
        Ok(Self { ell, i1, i3, excess })
    }

    /// Any axisymmetric body on a rim, a bottle or a can: the height `ell` of its centre of mass
    /// above the rim plane (in R) and its moments about the centre of mass (in M R^2).
    ///
    /// A real body has `0 < i3 <= 2 i1`, where equality is a flat body.
    pub fn new(ell: f64, i1: f64, i3: f64) -> Result<Self, Error> {
        within("ell", ell, ELL, "0 <= ell <= 1e150")?;
        within("i1", i1, I1, "1e-150 <= i1 <= 1e300")?;
        within("i3", i3, I3, "1e-150 <= i3 <= 1e150")?;
        if i3 > 2.0 * i1 {
            return Err(Error::Moments { i3, i1 });
        }
        within("i1 / i3", i1 / i3, (0.5, 1e300), "1/2 <= i1 / i3 <= 1e300")?;
        let body = Self { ell, i1, i3, excess: Sum::of(i1, -i3).over(i3.into()) };
        within("i1 i3 + i1 + i3 ell^2", body.big_d(), (0.0, 1e301), "at most 1e301")?;
        Ok(body)
    }

    /// A uniform tube from its measures, in metres (or all in any one unit).
    pub fn from_metres(outer_diameter: f64, inner_diameter: f64, length: f64) -> Result<Self, Error> {
        const LENGTH: (f64, f64) = (0.0, f64::MAX);
        within("outer_diameter", outer_diameter, (f64::MIN_POSITIVE, f64::MAX), "outer_diameter > 0")?;
        within(
            "inner_diameter",
            inner_diameter,
            (0.0, outer_diameter),
            "0 <= inner_diameter <= outer_diameter",
        )?;
        within("length", length, LENGTH, "length >= 0")?;
        Self::tube(length / outer_diameter, inner_diameter / outer_diameter)
    }

    /// The aspect ratio at which a tube of this `bore` has I1 = I3 and theta0 = thetaInf:
    /// (sqrt(3)/2) sqrt(1 + bore^2). Relative error below 4 ulp.
    pub fn critical_aspect(bore: f64) -> Result<f64, Error> {
        within("bore", bore, (0.0, 1.0), "0 <= bore <= 1")?;
        Ok((0.75 * (1.0 + bore * bore)).sqrt())
    }

    /// Aspect ratio: height of the centre of mass above the lower rim plane, in R.
    pub fn ell(&self) -> f64 {
        self.ell
    }

    /// Transverse moment of inertia I1 = I2, in M R^2.
    pub fn i1(&self) -> f64 {
        self.i1
    }

    /// Axial moment of inertia I3, in M R^2.
    pub fn i3(&self) -> f64 {
        self.i3
    }

    /// Inertia excess I1/I3 - 1: positive for a cylinder, negative for a disk.
    pub fn excess(&self) -> f64 {
        self.excess.hi
    }

    /// theta0: the inclination at which the body balances on a point of its rim, in radians.
    /// Error below 2 ulp.
    pub fn theta_balance(&self) -> f64 {
        1f64.atan2(self.ell)
    }

    /// thetaInf: the inclination at which the steady rate grows without bound, in radians.
    /// Error below 4 ulp.
    pub fn theta_limit(&self) -> f64 {
        (1.0 + self.excess.hi).atan2(self.ell)
    }

    pub(crate) fn excess_sum(&self) -> Sum<f64> {
        self.excess
    }

    /// I1/I3.
    pub(crate) fn ratio(&self) -> f64 {
        1.0 + self.excess.hi
    }

    /// J = I1 + 1 + ell^2, the inertia of a nutation that rolls.
    pub(crate) fn j(&self) -> f64 {
        self.i1 + 1.0 + self.ell * self.ell
    }

    /// D = I1 I3 + I1 + I3 ell^2.
    pub(crate) fn big_d(&self) -> f64 {
        self.i1 * self.i3 + self.i1 + self.i3 * self.ell * self.ell
    }
}

/// I1, I3 and the inertia excess of a uniform tube, one or several in lanes.
#[inline(always)]
pub(crate) fn tube<T: Real>(ell: T, bore: T) -> ([T; 2], Sum<T>) {
    let number = |x: f64| ell.splat(x);
    // wall = 1 + q^2 and 4 ell^2 - 3 wall, each exact to 106 bits
    let square = Sum::product(bore, bore);
    let wall = Sum::of(number(1.0), square.hi).plus(Sum { hi: square.lo, lo: number(0.0) });
    let double = ell + ell;
    let numerator = Sum::product(double, double).plus(wall.times(number(-3.0)));
    let i3 = wall.hi * number(0.5);
    let i1 = wall.hi * number(0.25) + ell * ell / number(3.0);
    ([i1, i3], numerator.over(wall.times(number(6.0))))
}

/// `ell` where there is such a tube, NaN elsewhere.
#[inline(always)]
pub(crate) fn tube_or_nan<T: Real>(ell: T, bore: T) -> T {
    let (zero, nan) = (ell.splat(0.0), ell.splat(f64::NAN));
    let between = |x: T, most: f64, yes: T| x.select_lt(zero, nan, x.splat(most).select_lt(x, nan, yes));
    // a bore that is NaN is in no range
    between(ell, ELL.1, between(bore, 1.0, ell + bore * zero))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// d times 6 (1 + q^2), against integers: ell = i / 2^20 and q = j / 2^20 are exact.
    #[test]
    fn the_excess_is_exact_to_a_hundred_bits_near_the_critical_shape() {
        let unit = f64::from(1 << 20);
        for j in [0_i128, 1, 77_777, 1 << 19, (1 << 20) - 1, 1 << 20] {
            let critical = (Body::critical_aspect(j as f64 / unit).unwrap() * unit) as i128;
            for i in critical - 3..critical + 3 {
                let body = Body::tube(i as f64 / unit, j as f64 / unit).unwrap();
                let wall = (1 << 40) + j * j;
                let exact = 4 * i * i - 3 * wall;
                let back = body.excess.times((6 * wall) as f64);
                let rest = ((back.hi - exact as f64) + back.lo) / exact as f64;
                assert!(rest.abs() < 2f64.powi(-100), "bore {j}, ell {i}: {rest}");
            }
        }
    }

    #[test]
    fn a_tube_and_the_general_body_of_its_moments_are_one() {
        for (ell, bore) in [(0.0, 0.0), (0.3, 0.5), (2.5, 0.0), (6.0, 0.8), (0.0, 1.0), (1e6, 0.1)] {
            let tube = Body::tube(ell, bore).unwrap();
            let same = Body::new(ell, tube.i1(), tube.i3()).unwrap();
            assert!((tube.excess() - same.excess()).abs() <= 4.0 * f64::EPSILON * tube.ratio());
            assert!((tube.theta_limit() - same.theta_limit()).abs() < 1e-15);
        }
    }

    #[test]
    fn moments_are_those_of_the_textbook() {
        let disk = Body::solid(0.0).unwrap();
        assert_eq!((disk.i1(), disk.i3(), disk.excess()), (0.25, 0.5, -0.5));
        let hoop = Body::tube(0.0, 1.0).unwrap();
        assert_eq!((hoop.i1(), hoop.i3(), hoop.excess()), (0.5, 1.0, -0.5));
        let can = Body::tube(3.0, 0.5).unwrap();
        assert_eq!((can.i3(), can.i1()), (0.625, 0.3125 + 3.0));
        assert_eq!((can.j(), can.big_d()), (13.3125, 3.3125 * 0.625 + 3.3125 + 0.625 * 9.0));
        let pvc = Body::from_metres(15.875e-3, 12.7e-3, 95.25e-3).unwrap();
        assert_eq!((pvc.ell(), pvc.i3()), (6.0, 0.82));
    }

    #[test]
    fn balance_and_limit_meet_at_the_critical_aspect_only() {
        for bore in [0.0, 0.3, 0.8, 1.0] {
            let critical = Body::critical_aspect(bore).unwrap();
            let gap = |ell: f64| {
                let body = Body::tube(ell, bore).unwrap();
                body.theta_limit() - body.theta_balance()
            };
            assert!(gap(critical).abs() < 1e-15);
            assert!(gap(critical * 1.001) > 1e-4 && gap(critical * 0.999) < -1e-4);
        }
    }

    #[test]
    fn what_cannot_be_a_body_is_refused_by_name() {
        let text = |r: Result<Body, Error>| r.unwrap_err().to_string();
        assert_eq!(text(Body::solid(-1.0)), "ell = -1.0: expected 0 <= ell <= 1e150");
        assert_eq!(text(Body::solid(f64::NAN)), "ell = NaN: expected 0 <= ell <= 1e150");
        assert_eq!(text(Body::solid(1e160)), "ell = 1e160: expected 0 <= ell <= 1e150");
        assert_eq!(text(Body::tube(1.0, 1.1)), "bore = 1.1: expected 0 <= bore <= 1");
        assert_eq!(text(Body::new(1.0, 0.2, 0.5)), "i3 = 0.5, i1 = 0.2: a real body satisfies i3 <= 2 i1");
        assert!(Body::new(1.0, 0.25, 0.5).is_ok(), "a flat body is the limit, and allowed");
        assert!(Body::new(1.0, 0.0, 0.0).is_err() && Body::new(1.0, 0.5, 0.0).is_err());
        assert!(Body::new(1.0, 1e300, 1e-150).is_err(), "the ratio of the moments is bounded too");
        assert!(text(Body::new(1e150, 1e10, 1e10)).starts_with("i1 i3 + i1 + i3 ell^2 = "));
        assert!(Body::new(1e100, 1e150, 1e100).is_ok() && Body::new(1e60, 1e152, 1e149).is_ok());
        assert!(Body::from_metres(1.0, 1.1, 1.0).is_err() && Body::from_metres(0.0, 0.0, 1.0).is_err());
        assert!(Body::from_metres(1.0, 1.0, -1.0).is_err() && Body::critical_aspect(2.0).is_err());
    }
}
