//! Coulomb friction of a small round patch of contact, whose slip and spin share one friction (Contensou).
//!
//! ```text
//! S = |u|,  R = eps |w_z|,  k = S/R        eps the radius of the patch, w_z = s w1 + c w3 the drilling
//! F = -mu N f(k) u/|u|,   couple = -mu N eps g(k) sgn(w_z) z,   power = -mu N (S f + R g)
//! k <= 1   f = (3 pi/32) k (4 - k^2),   g = (3 pi/128) (8 - 8 k^2 + 3 k^4)
//! k >= 1   f = 2F1(-1/2, 1/2; 5/2; q^2),   g = (q/5) 2F1(1/2, 1/2; 7/2; q^2),   q = 1/k
//! ```
//! Each piece of the patch rubs against its own slip u + w_z z x xi, under the pressure of Hertz, (3/2 pi) sqrt(1 -
//! r^2) (Contensou 1963; Leine and Glocker, Eur. J. Mech. A 22, 193 (2003)). On a line through the instantaneous
//! centre, at the angle b to u, the integral over the patch is elementary: f = (3/4) k int cos^2 b (1 - k^2 sin^2 b) db
//! and g = (3/16) int (1 - k^2 sin^2 b)^2 db; at k = 1 both have two continuous derivatives. Friction is smooth at u =
//! 0 as long as the body drills, so that nothing sticks. Without a radius this is Coulomb's law of a point.
//!
//! k itself is never formed, since it may be 0/0: f/S takes its place. For k > 1, f and g/q are analytic in s = sqrt(1
//! - q^2), and their Chebyshev series on [0, 1] fall as 5.83^-n.
//!
//! Error: 2e-15 of f and g for any k; a test of `patch` compares them with 20 digits.
//!
//! ```
//! use spincyl::contact::patch;
//!
//! // A patch that only drills has a couple of 3 pi/16 mu N eps, and resists a small slip by a small force.
//! let patch::PatchShares { force, couple, .. } = patch::of(0.0);
//! assert!(force == 0.0 && (couple - 3.0 * std::f64::consts::PI / 16.0).abs() < 1e-14);
//! assert!((patch::of(patch::slip_for(0.5)).force - 0.5).abs() < 1e-12);
//! ```

use crate::methods::search::crossing;
use crate::numbers::{Dual, Real};
use core::f64::consts::PI;

/// A step of the integration takes at most this share of the distance to k = 1, where slip and spin are equally fast.
const NEARER_K: f64 = 0.5;

/// f and g/q for k >= 1 as polynomials in 2 s - 1, Chebyshev series of 22 terms; the terms left out sum up to 7e-17.
#[rustfmt::skip]
const FORCE_SERIES: [f64; 22] = [
    0.9170997880780726, 0.06250000000000006, 0.02423336865365803, -0.004396221731178827, 0.0005630649993088711,
    5.1977435348625734e-05, -8.421605991664845e-05, 4.737191552267095e-05, -2.149243474358282e-05, 8.878440359798234e-06,
    -3.4818024687496186e-06, 1.3214778184610843e-06, -4.907065649171647e-07, 1.7923606862631192e-07, -6.422445412549951e-08,
    2.291934970788687e-08, -8.661362691651225e-09, 3.081336652881969e-09, -6.849068802921738e-10, 2.267347445285762e-10,
    -2.455572174691065e-10, 8.757480422285951e-11,
];
#[rustfmt::skip]
const COUPLE_SERIES: [f64; 22] = [
    0.2136499470195182, -0.012116684326827498, -0.0027611758650455463, 0.0016350458661592653, -0.00048727054312168786,
    7.43466573642344e-05, 2.2369215163436505e-05, -2.8073034067640355e-05, 1.7635322965623147e-05, -9.052197968058282e-06,
    4.199779658321693e-06, -1.8321912749560303e-06, 7.674395167823674e-07, -3.1157912920483703e-07, 1.2201420751195448e-07,
    -4.7414769990222716e-08, 2.0075365611152565e-08, -7.698819820569808e-09, 1.490654020365827e-09, -5.150680195913226e-10,
    7.788838364640695e-10, -2.9336446980264517e-10,
];

/// f/S and g, where S = |u| and R = eps |w_z|. Both must not be zero.
#[inline(always)]
fn friction_and_couple<T: Real>(slip: T, turn: T) -> [T; 2] {
    let number = |x: f64| slip.splat(x);
    let one = number(1.0);
    // SIMD lanes compute both cases, each with arguments that are valid for it.
    let (small, wide) = (slip.min(turn), turn.max(number(f64::MIN_POSITIVE)));
    let square = (small / wide) * (small / wide);
    let within = [
        number(3.0 * PI / 32.0) * (number(4.0) - square) / wide,
        number(3.0 * PI / 128.0) * (number(8.0) - square * (number(8.0) - number(3.0) * square)),
    ];
    if slip.is_lt(turn) {
        return within;
    }
    let (fast, slow) = (slip.max(turn).max(number(f64::MIN_POSITIVE)), turn.min(slip));
    let share = slow / fast;
    let side = number(2.0) * ((one - share) * (one + share)).sqrt() - one;
    let sum = |terms: &[f64; 22]| terms.iter().rev().fold(number(0.0), |sum, x| sum.mac(side, number(*x)));
    let outside = [sum(&FORCE_SERIES) / fast, share * sum(&COUPLE_SERIES)];
    [0, 1].map(|i| turn.select_lt(slip, outside[i], within[i]))
}

/// The friction of a patch of this radius that slips and drills: f/S, the couple over mu N, and the rubbing speed S +
/// R. The couple acts against the drilling.
#[inline(always)]
pub(crate) fn rubs<T: Real>(slip: T, drilling: T, radius: T) -> [T; 3] {
    let turn = radius * drilling.abs();
    let [share, couple] = friction_and_couple(slip, turn);
    let (zero, against) = (slip.splat(0.0), radius * couple);
    [share, drilling.select_lt(zero, against, zero.select_lt(drilling, -against, zero)), slip + turn]
}

/// The rubbing speeds of a patch: its slip S, and the speed R of its edge due to the drilling.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rubbing<T> {
    pub slip: T,
    pub turn: T,
}

impl<T: Real> Rubbing<T> {
    #[inline(always)]
    pub fn of([u, v]: [T; 2], drilling: T, radius: T) -> Self {
        Self { slip: u.mac(u, v * v).sqrt(), turn: radius * drilling.abs() }
    }

    #[inline(always)]
    pub fn speed(&self) -> T {
        self.slip + self.turn
    }
}

impl Rubbing<Dual<f64>> {
    /// The longest step in the integration variable, by which the slopes of both speeds are derivatives. At k = S/R = 1
    /// the friction has a term (2 |k - 1|)^(5/2)/5 on one side only, so that steps become shorter towards k = 1, and a
    /// step across k = 1 is so short that this term is below the tolerance.
    pub fn longest(&self, tol: f64) -> f64 {
        let left = (self.slip.value - self.turn.value).abs();
        let past = (self.slip.slope - self.turn.slope).abs();
        ((NEARER_K * left).max(tol.powf(0.4) * self.speed().value) / past).min(f64::INFINITY)
    }
}

/// The friction of a patch, as shares of the largest friction.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct PatchShares {
    /// The force f of friction against the slip, in mu N.
    pub force: f64,
    /// The couple g of friction against the drilling, in mu N eps, with the radius eps of the patch.
    pub couple: f64,
}

/// The shares f and g of the largest friction of a patch whose slip is `k` times the speed eps |w_z| of its edge.
pub fn of(k: f64) -> PatchShares {
    if k.is_infinite() {
        return PatchShares { force: 1.0, couple: 0.0 };
    }
    let [force, couple] = friction_and_couple(k, 1.0);
    PatchShares { force: k * force, couple }
}

/// The ratio k of the slip to the speed of the patch's edge at which the force of friction is the share `share` of mu
/// N, from 0 to 1; k is infinite for 1. If the instantaneous centre is inside the patch, k is a root of a cubic; else a
/// search finds k.
pub fn slip_for(share: f64) -> f64 {
    if share <= 9.0 * PI / 32.0 {
        let third = (2.0 * 3f64.sqrt() * share / PI).min(1.0).asin() / 3.0;
        return 4.0 / 3f64.sqrt() * third.sin();
    }
    if share >= 1.0 {
        return f64::INFINITY;
    }
    // 1 - f is about q^2/10.
    let off = |q: f64| of(1.0 / q).force - share;
    1.0 / crossing(off, 0.0, 1.0, 1.0 - share, off(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// k, f and g by hypergeometric functions in 60 digits, which agree with chords through the instantaneous centre.
    #[rustfmt::skip]
    #[allow(clippy::excessive_precision)]
    const KNOWN: [[f64; 3]; 28] = [
        [1e-12, 1.1780972450961724407e-12, 0.58904862254808623221],
        [1e-06, 1.1780972450958778868e-6, 0.58904862254749718359],
        [0.001, 0.0011780969505718612149, 0.58904803349968457736],
        [0.01, 0.011780677926650450846, 0.58898971989476375814],
        [0.1, 0.11751520019834320982, 0.58318022564595092247],
        [0.3, 0.345477017124452563, 0.5378234817097482869],
        [0.5, 0.5522330836388308427, 0.45559229400203544523],
        [0.849, 0.81996744912769573204, 0.27922776740666752962],
        [0.9, 0.84557929766777779661, 0.25684728875431114124],
        [0.99, 0.88053962794031797549, 0.22391122628208979419],
        [0.999, 0.88327752623244579408, 0.22118849319423252498],
        [0.999999, 0.88357263929693449317, 0.22089352798057992949],
        [1.0, 0.88357293382212934832, 0.22089323345553233708],
        [1.000001, 0.88357322834555815627, 0.22089293893195626756],
        [1.001, 0.88386661003154601219, 0.2205994105476834231],
        [1.01, 0.88644080286532410767, 0.21801114892165422405],
        [1.1, 0.90736960478644128616, 0.1959875115172417058],
        [1.5, 0.95311838732259164512, 0.13813765898976407223],
        [2.0, 0.97427857925749347761, 0.10190933291933949341],
        [3.0, 0.98875234042328774402, 0.067211117466461001121],
        [5.0, 0.99598266357629819208, 0.040115446221006771926],
        [10.0, 0.9989989255833432921, 0.020014321564493659719],
        [30.0, 0.99988887565729129043, 0.00666719591423002585],
        [100.0, 0.99998999989285416655, 0.0020000142860714421002],
        [10000.0, 0.99999999899999999893, 0.000020000000014285714321],
        [1000000.0, 0.9999999999999, 2.0000000000001428571e-7],
        [1000000000.0, 0.9999999999999999999, 2.0000000000000000001e-10],
        [1000000000000.0, 1.0, 2.0e-13],
    ];

    #[test]
    fn force_and_couple_are_those_of_the_integral_over_the_patch() {
        for [k, force, couple] in KNOWN {
            let found = of(k);
            for (found, known) in [found.force, found.couple].into_iter().zip([force, couple]) {
                assert!((found - known).abs() < 2e-15 * known, "k = {k:e}: {found} for {known}");
            }
        }
    }

    #[test]
    fn without_a_radius_friction_is_that_of_a_point() {
        for slip in [1e-300, 0.3, 1e10] {
            let [force, couple] = friction_and_couple(slip, 0.0);
            assert!((force * slip - 1.0).abs() < 3e-16 && couple == 0.0);
        }
        assert_eq!(of(f64::INFINITY), PatchShares { force: 1.0, couple: 0.0 });
    }

    #[test]
    fn the_power_is_convex_so_that_the_couple_falls_as_the_force_rises() {
        // Phi = k f + g has the slope f, and g' = -k f'.
        for i in 1..400 {
            let (k, h) = (f64::from(i) * 0.01, 1e-4);
            let (f, [high, low]) = (of(k).force, [of(k + h), of(k - h)]);
            let power = |k: f64, of: PatchShares| k * of.force + of.couple;
            let slope = (power(k + h, high) - power(k - h, low)) / (2.0 * h);
            assert!((slope - f).abs() < 1e-8, "{k}");
            let (rises, falls) = (high.force - low.force, low.couple - high.couple);
            assert!(rises > 0.0 && (falls - k * rises).abs() < 1e-6 * rises, "{k}");
        }
    }

    #[test]
    fn the_slip_for_a_force_gives_that_force() {
        for k in [0.0, 1e-9, 0.1, 0.849, 0.9999, 1.0, 1.0001, 2.0, 30.0, 1e3] {
            let force = of(k).force;
            let found = slip_for(force);
            assert!((of(found).force - force).abs() <= 3e-16, "{k} {found}");
        }
        assert_eq!([slip_for(0.0), slip_for(1.0)], [0.0, f64::INFINITY]);
    }
}
