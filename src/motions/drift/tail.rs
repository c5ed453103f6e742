//! The rest (tail) of a drift after its last step, where all quantities are powers of the inclination, or the spin
//! decays by itself.
//!
//! ```text
//! powers   unit = theta |dt/dtheta|,   dt/dtheta ~ theta^(q - 1),   theta ~ (1 - q t/unit)^(1/q),   w1 ~ theta^p1,   w3 ~ theta^p3
//! fade     w1, w3 ~ exp(-z),   t = int |dt/dz| dz,   ln theta = -int |dln theta/dz| dz
//! ```
//! Near a face or a pole all quantities vary as powers of theta, and under rolling resistance theta varies as a high
//! power of the remaining time. A body that spins fast and is almost on its face keeps w1/w3 = A L/(I1 + L^2) at any
//! theta: theta vanishes before the spin does, above all if the body is nearly a ball. Where no loss depends on
//! theta, the rates then are functions of w3 alone, from which the decay of the spin follows.
//!
//! Error: 1e-12 of the time of a tail that takes some time. A test of `test_late_drifts` compares this time with the spin,
//! which falls evenly, and with the three-dimensional model.

use super::circular::{Circular, Numbers, time_per_e_fold};
use crate::methods::antiderivative::{Antiderivative, Sampled};
use crate::methods::search;
use crate::numbers::{Dual, Real, Sum};

/// If only the air takes energy, a face whose exponent of the remaining time is at most this never lands.
const LARGEST_EXPONENT_IN_AIR: f64 = 0.02;

/// The tail of a drift needs no precise exponent if it lasts for less than this share of the time so far.
const NEGLIGIBLE_TAIL: f64 = 1e-13;

/// Greatest z of a spin that decays as exp(-z): exp(-40) of it remains, a rounding error.
const FADED_EXPONENT: f64 = 40.0;

/// The rest of a drift after its last step, up to a face that lands or a ball that stands on its pole.
#[derive(Debug, Clone)]
pub(crate) enum Tail {
    Powers(Powers),
    /// A spin that decays as exp(-z): the time and the logarithm of theta as integrals over z, and the time that the
    /// tail takes.
    Fade(Antiderivative<2>, f64),
}

/// A tail of a drift in which all quantities are powers of the inclination.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Powers {
    /// The time theta |dt/dtheta| per e-fold of theta; the next field is the exponent of the remaining time as a
    /// power of theta. With an exponent of 0 or less the face never lands.
    unit: f64,
    power: f64,
    /// Whether the face lands in a finite time.
    lands: bool,
    /// The exponents of w1 and w3 as powers of theta.
    turning: [f64; 2],
}

/// The fractions of theta, w1, w3 and Omega that are left at a time of the tail.
pub(crate) struct TailPlace {
    pub theta: f64,
    pub w1: f64,
    pub w3: f64,
    pub rate: f64,
}

impl Tail {
    /// The tail of a drift from the state `y` on. `airy` is true if only the air takes energy, `fades` if the spin
    /// decays independently of theta. A tail that lasts long needs a precise exponent.
    pub fn new(of: &Circular<Dual<f64>>, y: &Numbers<f64>, far: f64, airy: bool, fades: bool) -> Self {
        let tail = Powers::of(powers(of, *y, far), airy);
        if tail.time() < NEGLIGIBLE_TAIL * y[3] {
            return Self::Powers(tail);
        }
        if fades
            && !airy
            && let Some(fade) = Self::fading_spin(of, y, far)
        {
            return fade;
        }
        let exact = of.map(|x| Dual { value: Sum::from(x.value), slope: Sum::from(0.0) });
        Self::Powers(Powers::of(powers(&exact, y.map(Sum::from), far.into()).map(|x| x.hi), airy))
    }

    /// The tail with a spin that decays by itself; None if its time cannot be resolved.
    fn fading_spin(of: &Circular<Dual<f64>>, y: &Numbers<f64>, far: f64) -> Option<Self> {
        let dual = Dual::constant;
        let rates = |z: f64| {
            let [theta, rate, w3] = [y[0], y[1] * (-z).exp(), y[2] * (-z).exp()];
            let known = of.at(&[theta, rate, w3, y[3]].map(dual), dual(far)).rates.map(|x| x.value);
            [(w3 * known[3] / known[2]).abs(), (w3 * known[0] / (known[2] * theta)).abs()]
        };
        let integrals = Antiderivative::new(&[0.0, FADED_EXPONENT], 0.0, |z| {
            let value = rates(z);
            Sampled { value, scale: value, noise: 8.0 * f64::EPSILON }
        })?;
        // Beyond `FADED_EXPONENT` the spin falls at a constant rate, and the rest takes w3/w3'.
        let time = integrals.total[0] + rates(FADED_EXPONENT)[0];
        Some(Self::Fade(integrals, time))
    }

    /// The time that the tail of the drift takes; infinite if the face never lands.
    pub fn time(&self) -> f64 {
        match self {
            Self::Powers(of) => of.time(),
            Self::Fade(_, time) => *time,
        }
    }

    /// The time after which the fraction `left` of the inclination remains.
    pub fn time_until(&self, left: f64) -> f64 {
        match self {
            Self::Powers(of) => of.time_until(left),
            Self::Fade(integrals, time) => {
                let miss = |z: f64| integrals.at(z)[1] + left.ln();
                let (first, last) = (miss(0.0), miss(FADED_EXPONENT));
                if last < 0.0 {
                    return *time;
                }
                let z =
                    if first >= 0.0 { 0.0 } else { search::crossing(miss, 0.0, FADED_EXPONENT, first, last) };
                integrals.at(z)[0]
            }
        }
    }

    /// The fractions of the inclination and of the rates that are left after a time in the tail.
    pub fn at(&self, t: f64) -> TailPlace {
        match self {
            Self::Powers(of) => of.at(t),
            Self::Fade(integrals, time) if t > integrals.total[0] => {
                let left = (1.0 - t / time).max(0.0);
                TailPlace { theta: 0.0, w1: left, w3: left, rate: f64::INFINITY }
            }
            Self::Fade(integrals, _) => {
                let z = integrals.inverse(t.max(0.0));
                let (spin, theta) = ((-z).exp(), (-integrals.at(z)[1]).exp());
                TailPlace { theta, w1: spin, w3: spin, rate: spin / theta }
            }
        }
    }
}

impl Powers {
    fn of([unit, power, along, axial]: [f64; 4], airy: bool) -> Self {
        // An exponent that is only a rounding error counts as 0.
        let power = if power.abs() < 1e-9 { 0.0 } else { power };
        Self {
            unit,
            power,
            lands: power > if airy { LARGEST_EXPONENT_IN_AIR } else { 0.0 },
            turning: [along, axial],
        }
    }

    fn time(&self) -> f64 {
        if self.lands { self.unit / self.power } else { f64::INFINITY }
    }

    fn time_until(&self, left: f64) -> f64 {
        if self.power == 0.0 {
            -self.unit * left.ln()
        } else {
            self.unit * (1.0 - left.powf(self.power)) / self.power
        }
    }

    fn at(&self, t: f64) -> TailPlace {
        let part = t / self.unit;
        // The logarithm of the fraction of theta, which itself may underflow before its powers do.
        let folds =
            if self.power == 0.0 { -part } else { (1.0 - self.power * part).max(0.0).ln() / self.power };
        let to = |power: f64| if power.abs() < 1e-9 { 1.0 } else { (power * folds).exp() };
        let [along, axial] = self.turning;
        TailPlace { theta: to(1.0), w1: to(along), w3: to(axial), rate: to(along - 1.0) }
    }
}

/// The time per e-fold of the inclination, and the exponents of the remaining time, w1 and w3 as powers of theta.
fn powers<T: Real>(of: &Circular<Dual<T>>, y: Numbers<T>, far: T) -> [T; 4] {
    let (zero, one) = (far.splat(0.0), far.splat(1.0));
    let dual = |value: T, slope: T| Dual { value, slope };
    let far = dual(far, zero);
    // A small exponent is precise only if the state is steady to all digits.
    let steady = (0..2).fold(y.map(|x| dual(x, zero)), |y, _| of.settled(&y, far)).map(|x| x.value);
    let (mut slopes, mut lasts) = ([zero; 4], dual(zero, zero));
    // The slopes of the second evaluation are the rates that the first one gives. In numbers of twice the digits the code of
    // one evaluation is already long.
    for _ in 0..2 {
        let y = core::array::from_fn(|i| dual(steady[i], slopes[i]));
        let rate = of.at(&y, far).rates;
        (slopes, lasts) = (rate.map(|x| x.value), time_per_e_fold(&y, &rate));
    }
    let fold = slopes[0] / steady[0];
    let axial = slopes[2] / steady[2] / fold;
    // A body that does not spin about its axis has no exponent of w3.
    let axial = steady[2].abs().select_lt(one.splat(f64::MIN_POSITIVE), zero, axial);
    [lasts.value, lasts.slope / lasts.value / fold, one + slopes[1] / steady[1] / fold, axial]
}
