//! The friction of a ring that slides and spins, under a pressure that is linear in the place and cut at zero.
//!
//! ```text
//! u = v + w z x (a n),   s = a w,   n = (cos chi, sin chi),   v along x;   X the centre of the pressure over a
//! G = <u/|u|>,   gg = <n x u/|u|>,   means over the pressure p
//! |X| <= 1/2   p = 1 + 2 X.n        |X| > 1/2   p = cos t - cos b for |t| < b,   t = chi - arg X
//! ```
//! Where the whole ring presses the means are complete elliptic integrals B and D, computed by Bulirsch's means (Numer.
//! Math. 7, 78 (1965)), which lose nothing at either end. Where a part presses they are taken in the frame of X, whose
//! angle is c, with d the angle of u from X: gg is the mean of (1 - cos d) sin t - (1 - cos t) sin d, as those of sin t and sin d vanish.
//! All terms are then as small as the sum for a slow spin and for a short arc.
//!
//! Quadrature along the arc: a rule of Gauss with 24 nodes in tan(t/4), where u has no zero near; else with T =
//! tan(t/2 + c/2 - pi/4) = (e/2) (E - 1/E), e = |v - s|/(v + s), which makes |u| = (v + s) (e/2) (E + 1/E)/sqrt(1 + T^2)
//! rational but for a root, in panels of E by ratios of 8; the opposite side of the ring in 1/T.
//!
//! Error: 1e-15 of the whole ring, 1e-14 of a part.

use super::part::{
    ElementForce, FaceIntegrals, GAUSS_PLACES, GAUSS_WEIGHTS, PressedFace, PressedPart, ZEROS, one_less,
};
use crate::numbers::side_by_side::SideBySide;
use crate::numbers::{here, in_lanes, level};
use core::f64::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4};
use fearless_simd::{SimdBase, f64x8};

/// The semi-major axis (2.1 + 1/2.1)/2 of an ellipse with foci -1 and 1: if a function is analytic inside of the
/// ellipse, 24 nodes give its integral to 1e-15, about 2.1^-48.
const SMOOTH: f64 = 1.29;
/// The half angle beyond which the opposite side of the ring has its own panel, and the largest ratio of a panel's ends.
const FAR: f64 = 1.4;
const RATIO: f64 = 7.0;

/// The integrals of cos^2/D and of (1 - q^2) sin^2/D over a quarter turn, D^2 = 1 - q^2 sin^2, for q in [0, 1].
pub(super) fn quarter_integrals(q: f64) -> [f64; 2] {
    let complement = (1.0 - q) * (1.0 + q);
    if complement == 0.0 {
        return [1.0, 0.0];
    }
    let mut e = complement.sqrt();
    let (mut m, mut p, mut k) = (1.0, 1.0, e);
    // The pairs of coefficients of cos^2 and of sin^2.
    let (mut a, mut b) = ([1.0, 0.0], [0.0, 1.0]);
    loop {
        let over = 1.0 / p;
        let g = e * over;
        for i in 0..2 {
            let before = a[i];
            a[i] += b[i] * over;
            b[i] = 2.0 * (b[i] + before * g);
        }
        p += g;
        let last = m;
        m += k;
        if (last - k).abs() <= 1e-8 * last {
            let scale = FRAC_PI_2 / (m * (m + p));
            return [scale * (b[0] + a[0] * m), complement * scale * (b[1] + a[1] * m)];
        }
        k = 2.0 * e.sqrt();
        e = k * m;
    }
}

/// The means that give the friction under a pressure that is linear in the place and positive everywhere: those of
/// u_x/|u| and n x u/|u| over the uniform pressure, and those of x u_y/|u|, y u_x/|u| and y (n x u)/|u|.
#[derive(Debug, Clone, Copy)]
pub(super) struct WholeMeans {
    pub along: f64,
    pub couple: f64,
    pub x_across: f64,
    pub y_along: f64,
    pub y_couple: f64,
}

impl WholeMeans {
    /// The means over the whole ring, for the speed v of the centre and the speed s of the rim.
    pub fn of_ring(v: f64, s: f64) -> Self {
        let spins = v <= s;
        let q = if spins { v / s } else { s / v };
        let [b, d] = quarter_integrals(q).map(|x| FRAC_2_PI * x);
        let (small, large) = (q * b, b + d);
        let (x, y, z) = ((2.0 * b + d) / 3.0, (b + 2.0 * d) / 3.0, q * (b - d) / 3.0);
        if spins {
            Self { along: small, couple: large, x_across: x, y_along: -y, y_couple: -z }
        } else {
            Self { along: large, couple: small, x_across: q * x, y_along: -z, y_couple: -y }
        }
    }

    /// The force along v, the force across v, and the couple, for a pressure 1 + `slope` X.n with X = lam G.
    pub fn pressed(&self, lam: f64, slope: f64) -> [f64; 3] {
        let tilt = slope * lam;
        let along = self.along / (1.0 - tilt * tilt * self.x_across * self.y_along);
        let across = tilt * self.x_across * along;
        [along, across, self.couple + tilt * across * self.y_couple]
    }
}

/// Terms of the speeds and of the pressed part that all nodes of the quadrature share.
struct RubsAlong<T> {
    /// v cos c (`forward`), s (`spin`), and s - v sin c (`base`), with the angle c of X from v.
    forward: T,
    spin: T,
    base: T,
    /// sin(b/2), where b is half the angle of the pressed arc.
    reach: T,
}

impl<T: SideBySide> RubsAlong<T> {
    /// The terms of a node of weight dt at the angle t from X, from sin(t/2), cos(t/2) and 1/|u|.
    #[inline(always)]
    fn at(&self, weight: T, [sh, ch]: [T; 2], over: T) -> ElementForce<T> {
        let twice = sh + sh;
        let (across, short) = (twice * ch, twice * sh);
        let aside = (self.base - self.spin * short) * over;
        let ahead = (self.forward - self.spin * across) * over;
        let reach = (self.reach - sh) * (self.reach + sh);
        let back = one_less(aside, ahead);
        ElementForce { weight, pressed: weight * (reach + reach), short, across, aside, back }
    }
}

/// Calls `each` with the place and the weight of the nodes between `left` and `right`, several at a time in SIMD lanes.
#[inline(always)]
pub(super) fn nodes<T: SideBySide>(like: T, left: f64, right: f64, mut each: impl FnMut(T, T)) {
    let (middle, half) = (like.splat(0.5 * (left + right)), like.splat(0.5 * (right - left)));
    for group in 0..GAUSS_PLACES.len() / T::COUNT {
        let at = group * T::COUNT;
        each(middle + half * like.load(&GAUSS_PLACES[at..]), half * like.load(&GAUSS_WEIGHTS[at..]));
    }
}

/// The result for a pressed part of the ring, at the speeds `v` of the centre and `s` of the rim, for lam = mu Z/a.
pub(super) fn on_ring(part: &PressedPart, lam: f64, v: f64, s: f64) -> PressedFace {
    let large = v.max(s);
    let (v, s) = (v / large, s / large);
    in_lanes!(
        level(),
        simd => ring_integrals(<f64x8<_> as SimdBase<_>>::splat(simd, 0.0), part, v, s).pressed(lam),
        else ring_integrals(ZEROS, part, v, s).pressed(lam)
    )
}

/// The integrals over the pressed part of the ring, at the speeds v of the centre and s of the rim.
#[inline(always)]
fn ring_integrals<T: SideBySide>(like: T, part: &PressedPart, v: f64, s: f64) -> FaceIntegrals<T> {
    let number = |x: f64| like.splat(x);
    let (c, off) = (part.angle, part.off);
    let reach = part.width.sqrt();
    let b = 2.0 * reach.min(1.0).asin();
    let (so, co) = (0.5 * off).sin_cos();
    let base = if c < FRAC_PI_4 { s - v * c.sin() } else { (s - v) + 2.0 * v * so * so };
    let one = number(1.0);
    let [forward, spin, base, reach] = [v * off.sin(), s, base, reach].map(number);
    let rubs = RubsAlong { forward, spin, base, reach };
    let mut sums = FaceIntegrals::new(like);
    let (least, most) = ((v - s).abs(), v + s);
    let [sine, cosine] = [so, co].map(number);
    // The zero of u^2 nearest to the arc, over its half: the ellipse through it tells how fast the rule converges.
    let zero = [off / b, if least == 0.0 { 0.0 } else { (v / s).ln() / b }];
    let ellipse = 0.5 * ((zero[0] - 1.0).hypot(zero[1]) + (zero[0] + 1.0).hypot(zero[1]));
    if ellipse > SMOOTH {
        let end = (0.25 * b).tan();
        let [four, near, twice] = [4.0, least * least, 4.0 * v * s].map(number);
        nodes(
            like,
            -end,
            end,
            #[inline(always)]
            |x, weight| {
                let over = one / (one + x * x);
                let half = [(x + x) * over, (one - x * x) * over];
                let side = half[0] * cosine - half[1] * sine;
                let size = (near + twice * side * side).sqrt();
                sums.rub(rubs.at(four * over * weight, half, one / size));
            },
        );
        return sums;
    }
    let mut far = here(
        #[inline(always)]
        |left: f64, right: f64, sign: f64| {
            let [sine, cosine] = [sign * so, sign * co].map(number);
            let [near, twice] = [least * least, most * most].map(number);
            nodes(
                like,
                left,
                right,
                #[inline(always)]
                |x, weight| {
                    let root = (one + x * x).sqrt();
                    let over = one / root;
                    let half = [over * (x * sine - cosine), over * (x * cosine + sine)];
                    let size = (near * x * x + twice).sqrt();
                    sums.rub(rubs.at((weight + weight) * over * over, half, root / size));
                },
            );
        },
    );
    // The near side of the ring, in tan t/2 between these angles.
    let (mut first, mut last) = (0.5 * (-b - off), 0.5 * (b - off));
    if first < -FAR {
        far((first + FRAC_PI_2).tan(), 1.0, 1.0);
        first = -FRAC_PI_4;
    }
    if last > FAR {
        far(-1.0, (last - FRAC_PI_2).tan(), -1.0);
        last = FRAC_PI_4;
    }
    let share = (least / most).max(1e-17);
    let stretched = |t: f64| {
        let y = t / share;
        let root = (1.0 + y * y).sqrt();
        if y > 0.0 { y + root } else { 1.0 / (root - y) }
    };
    let (from, to) = (stretched(first.tan()), stretched(last.tan()));
    let panels = ((to / from).ln() / RATIO.ln()).ceil().max(1.0);
    let ratio = (to / from).powf(1.0 / panels);
    let [tilt, half_share, share, size] = [so / co, 0.5 * share, share, 2.0 / (share * most)].map(number);
    let mut left = from;
    for i in 1..=panels as usize {
        let right = if i as f64 == panels { to } else { left * ratio };
        nodes(
            like,
            left,
            right,
            #[inline(always)]
            |x, weight| {
                let square = x * x + one;
                let both = one / (x * square);
                let inverse = both * square;
                let t = half_share * (x - inverse);
                let root = (one + t * t).sqrt();
                let over = one / root;
                let half = [over * cosine * (t + tilt), over * cosine * (one - t * tilt)];
                let dt = share * (one + inverse * inverse) * over * over * weight;
                sums.rub(rubs.at(dt, half, size * root * x * x * both));
            },
        );
        left = right;
    }
    sums
}
