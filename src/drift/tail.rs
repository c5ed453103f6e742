//! The rest of a drift after its last step, where all numbers are powers of the inclination.
//!
//! ```text
//! unit = theta |dt/dtheta|,   dt/dtheta ~ theta^(q - 1),   theta ~ (1 - q t/unit)^(1/q),   w1 ~ theta^p1,   w3 ~ theta^p3
//! ```
//! Near a face or a pole all numbers go as powers of theta, and under rolling resistance theta itself goes as a high
//! power of the time that is left.
//!
//! Error: 1e-12 of the time of a tail that takes some time. A test of `test_late_drifts` compares this time with the spin,
//! which falls evenly.

use super::circular::{Circular, Numbers, unit};
use crate::number::{Dual, Real, Sum};

/// Exponent of the tail up to which, in air alone, the face never lands.
const SLOW: f64 = 0.02;

/// Share of the time so far below which the time of the tail does not matter.
const NOTHING: f64 = 1e-13;

/// The rest of a drift after its last step, up to a face that lands or a ball that stands on its pole.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tail {
    /// theta |dt/dtheta|, and the exponent of the remaining time as a power of theta; with an exponent of 0 or less the
    /// face never lands.
    pub unit: f64,
    pub power: f64,
    /// Whether the face lands in a finite time.
    lands: bool,
    /// The exponents of w1 and w3 as powers of theta.
    pub turning: [f64; 2],
}

impl Tail {
    /// The tail from numbers of a drift; `airy` says that only air acts. A tail that takes some time needs a precise
    /// exponent.
    pub fn new(of: &Circular<Dual<f64>>, y: &Numbers<f64>, far: f64, airy: bool) -> Self {
        let tail = Self::of(powers(of, *y, far), airy);
        if tail.time() < NOTHING * y[3] {
            return tail;
        }
        let exact = of.map(|x| Dual { value: Sum::from(x.value), slope: Sum::from(0.0) });
        Self::of(powers(&exact, y.map(Sum::from), far.into()).map(|x| x.hi), airy)
    }

    fn of([unit, power, along, axial]: [f64; 4], airy: bool) -> Self {
        // An exponent that is only a rounding error counts as 0.
        let power = if power.abs() < 1e-9 { 0.0 } else { power };
        Self { unit, power, lands: power > if airy { SLOW } else { 0.0 }, turning: [along, axial] }
    }

    /// The time that the tail takes; infinite if the face never lands.
    pub fn time(&self) -> f64 {
        if self.lands { self.unit / self.power } else { f64::INFINITY }
    }

    /// The time after which the fraction `left` of the inclination remains.
    pub fn until(&self, left: f64) -> f64 {
        if self.power == 0.0 {
            -self.unit * left.ln()
        } else {
            self.unit * (1.0 - left.powf(self.power)) / self.power
        }
    }

    /// The fraction of the inclination that remains after a time.
    pub fn left(&self, t: f64) -> f64 {
        let part = t / self.unit;
        if self.power == 0.0 {
            (-part).exp()
        } else {
            (1.0 - self.power * part).max(0.0).powf(1.0 / self.power)
        }
    }
}

/// The time per e-fold of the inclination, and the exponents of the remaining time, w1 and w3 as powers of theta.
fn powers<T: Real>(of: &Circular<Dual<T>>, y: Numbers<T>, far: T) -> [T; 4] {
    let (zero, one) = (far.splat(0.0), far.splat(1.0));
    let dual = |value: T, slope: T| Dual { value, slope };
    let far = dual(far, zero);
    // A small exponent depends on how precisely the state is steady.
    let steady = (0..2).fold(y.map(|x| dual(x, zero)), |y, _| of.settled(&y, far)).map(|x| x.value);
    let rates = |slopes: Numbers<T>| {
        let y = core::array::from_fn(|i| dual(steady[i], slopes[i]));
        (y, of.at(&y, far).rates)
    };
    let slopes = rates([zero; 4]).1.map(|x| x.value);
    let (y, rate) = rates(slopes);
    let unit = unit(&y, &rate);
    let fold = slopes[0] / steady[0];
    let axial = slopes[2] / steady[2] / fold;
    // A body that does not spin about its axis has no exponent of w3.
    let axial = steady[2].abs().select_lt(one.splat(f64::MIN_POSITIVE), zero, axial);
    [unit.value, unit.slope / unit.value / fold, one + slopes[1] / steady[1] / fold, axial]
}
