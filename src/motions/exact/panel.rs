//! The angular velocities w1 and w3 and the energy of theta' as power series in x = ln tan(theta/2) about one place.
//!
//! ```text
//! s = sech x = sin theta,   c = -tanh x = cos theta,   P = w1 s,   n = w3
//! s' = s c,   c' = -s^2,   P' = s (q m - p P),   n' = r P + t m,   m = s n
//! p, q, r, t, al, k, J, h: `contact::reduced`
//! G(x) = J s^2 theta'^2 = K s^2 - al (P - (k/al) m)^2,   K = 2 (E - h) - i n^2,   i = b - k^2/al = I3 + A^2 I1/al
//! rounded: D P' = s (I3 (I3 + A^2 + rho c L) m - I3 a L P)
//!          D n' = A (I1 a P + (I3 L - I1 rho c) m)
//!          G = K s^2 - I1 P^2 - (A m - L P)^2,   K = 2 (E - h) - I3 n^2
//! ```
//! K is twice the energy without that of the height and of the spin about the axis. Where the axis is nearly
//! vertical, K is a small difference of these large numbers, which hardly change. Therefore the caller gives the
//! value of K at the centre, and the further terms of its series come from those of n^2 and h alone, which are as
//! small as the change. These functions are analytic for |Im x| < pi/2, except at the zeros of D that a rounded rim
//! may bring inside. The step to the next possible zero of G uses a bound on G'', so that no zero is stepped over.
//!
//! Error: the rounding error of G is at most [`Panel::rounding`]; the tests of `exact` check this on motions.

use crate::laws::body::Rim;
use crate::laws::contact::reduced::Reduced;
use crate::numbers::Real;
use crate::numbers::power::{divide, multiply_on, square_on};
use nalgebra::Complex;

/// Number of terms of a power series: it is accurate to 1e-16 within 0.3 of its radius of convergence, although G has
/// a triple pole at that radius.
pub(super) const ORDER: usize = 36;

pub(super) type PanelTerms = [f64; ORDER];

/// Bounds of the errors of G and G' at the centre of a panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Certainty {
    /// The errors of G and G' are epsilon times their terms.
    Rounded,
    /// At the start of the motion: G has full relative precision, and the error of G' is 2^-100 of its terms.
    Start,
    /// The errors of G and G' are 2^-100 of their terms, since they were computed from the start with twice the
    /// digits.
    Carried,
}

/// The motion as power series in x about `centre`.
#[derive(Debug, Clone)]
pub(super) struct Panel {
    /// Centre of the panel in x = ln tan(theta/2), measured from the start like every x in this struct.
    pub centre: f64,
    pub reach: f64,
    pub p: PanelTerms,
    pub n: PanelTerms,
    pub g: PanelTerms,
    /// The series of K, twice the energy without that of the height and of the spin about the axis.
    pub k: PanelTerms,
    /// The size of the terms whose sum is K at the centre; the next field is its growth up to the reach of the
    /// series.
    size: f64,
    growth: f64,
    pub known: Certainty,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct PanelCentre {
    /// Sine and cosine of theta, P = w1 sin(theta), and n = w3.
    pub at: [f64; 4],
    pub k: f64,
    /// The size of the terms whose sum is K, twice the energy without that of the height and of the spin.
    pub size: f64,
}

/// A minimum of G between two turning points: its place relative to the centre of the panel, and its width sqrt(2
/// G/G'').
#[derive(Debug, Clone, Copy)]
pub(super) struct Dip {
    pub local: f64,
    pub width: f64,
}

/// Singularities of the motion in the complex x plane, which limit the reach of a series.
#[derive(Debug, Clone, Copy)]
pub(super) struct Poles {
    /// Zeros in the upper half plane of D, by which the equations of a rounded rim divide; none for a sharp rim.
    zeros: [Option<Complex<f64>>; 4],
}

impl Poles {
    pub fn of(law: &Reduced<f64>) -> Self {
        if !law.round {
            return Self { zeros: [None; 4] };
        }
        // This is D (1 + T^2)^2 as a polynomial in T = tan(theta/2) = e^x.
        let (rim, i1, i3) = (&law.shape.rim, law.shape.i1, law.shape.i3);
        let (a, ell, rho) = (rim.a, rim.ell, rim.rho);
        let (low, high) = (ell + rho, ell - rho);
        let [c0, c4] = [low, high].map(|l| i1 * i3 + i1 * a * a + i3 * l * l);
        let c2 = 2.0 * i1 * i3 + i1 * (2.0 * a * a + 4.0 * rho * rho) + 2.0 * i3 * low * high;
        let odd = 4.0 * i1 * a * rho;
        let roots = quartic([c0, odd, c2, odd, c4]);
        Self { zeros: roots.map(|root| Some(root.ln()).filter(|x| x.im >= 0.0 && x.is_finite())) }
    }

    /// Reach of a power series about x: 0.3 of its radius of convergence, but at most 0.75, since exp(2x) must not
    /// vary too much.
    pub fn reach(&self, x: f64) -> f64 {
        let strip = x.hypot(core::f64::consts::FRAC_PI_2);
        let zeros = self.zeros.iter().flatten();
        let radius = zeros.fold(strip, |least, zero| least.min((x - zero.re).hypot(zero.im)));
        (0.3 * radius).min(0.75)
    }
}

/// Approximate zeros of a polynomial of the fourth degree, lowest coefficient first (Durand and Kerner).
fn quartic(c: [f64; 5]) -> [Complex<f64>; 4] {
    let seed = Complex::new(0.4, 0.9);
    let size = (c[0] / c[4]).abs().powf(0.25);
    let mut roots: [Complex<f64>; 4] = core::array::from_fn(|k| seed.powu(k as u32 + 1) * size);
    for _ in 0..60 {
        for k in 0..4 {
            let value = c.iter().rev().fold(Complex::from(0.0), |sum, c| sum * roots[k] + c) / c[4];
            let others =
                (0..4).filter(|i| *i != k).fold(Complex::from(1.0), |all, i| all * (roots[k] - roots[i]));
            let step = value / others;
            roots[k] -= if step.is_finite() { step } else { Complex::from(0.0) };
        }
    }
    roots
}

/// The value of a power series at `y`. Four independent sums in powers of y^4 hide the latency of the arithmetic.
#[inline]
pub(super) fn value(series: &PanelTerms, y: f64) -> f64 {
    let (square, mut sums) = (y * y, [0.0; 4]);
    let fourth = square * square;
    for terms in series.as_chunks::<4>().0.iter().rev() {
        for (sum, term) in sums.iter_mut().zip(terms) {
            *sum = *sum * fourth + term;
        }
    }
    (sums[0] + sums[1] * y) + (sums[2] + sums[3] * y) * square
}

/// The quotient of a power series by (x - root); the remainder, which is a rounding error, is dropped.
pub(super) fn divided_by_root(series: &PanelTerms, root: f64) -> PanelTerms {
    let mut quotient = *series;
    divide(&mut quotient, root);
    quotient
}

/// The first four Taylor coefficients of a power series at x: value, slope, half the second derivative and a sixth of
/// the third.
pub(super) fn taylor(series: &PanelTerms, x: f64) -> [f64; 4] {
    let mut r = [0.0; 4];
    for c in series.iter().rev() {
        r = [r[0] * x + c, r[1] * x + r[0], r[2] * x + r[1], r[3] * x + r[2]];
    }
    r
}

/// Power series in x of s = sin(theta), c = cos(theta), P = w1 s, n = w3, s^2 and m = s n, in this order.
#[inline(always)]
pub(super) fn lines<T: Real, const N: usize>(law: &Reduced<T>, start: [T; 4]) -> [[T; N]; 6] {
    if law.round {
        return rounded_lines(law, start);
    }
    let zero = start[0].splat(0.0);
    let of = law.at((start[0], start[1]));
    let [mut s, mut c, mut p, mut n] = first_terms(start);
    let (mut square, mut m, mut push) = ([zero; N], [zero; N], [zero; N]);
    let (mut s_c, mut s_push) = ([zero; N], [zero; N]);
    for k in 0..N {
        square_on(&mut square, &s, k);
        multiply_on(&mut m, &s, &n, k);
        multiply_on(&mut s_c, &s, &c, k);
        push[k] = of.q * m[k] - of.p * p[k];
        multiply_on(&mut s_push, &s, &push, k);
        if k + 1 < N {
            let next = zero.splat((k + 1) as f64);
            s[k + 1] = s_c[k] / next;
            c[k + 1] = -square[k] / next;
            p[k + 1] = s_push[k] / next;
            n[k + 1] = (of.r * p[k] + of.t * m[k]) / next;
        }
    }
    [s, c, p, n, square, m]
}

/// Power series with the first terms `start`; all other terms are 0.
#[inline(always)]
fn first_terms<T: Real, const N: usize>(start: [T; 4]) -> [[T; N]; 4] {
    start.map(|x| {
        let mut series = [x.splat(0.0); N];
        series[0] = x;
        series
    })
}

/// Power series in x of s = sin(theta), c = cos(theta), P = w1 s, n = w3, s^2 and m = s n for a rounded rim, in this
/// order.
#[inline(always)]
fn rounded_lines<T: Real, const N: usize>(law: &Reduced<T>, start: [T; 4]) -> [[T; N]; 6] {
    let zero = start[0].splat(0.0);
    let (rim, i1, i3) = (&law.shape.rim, law.shape.i1, law.shape.i3);
    let (a, ell, rho) = (rim.a, rim.ell, rim.rho);
    let [mut s, mut c, mut p, mut n] = first_terms(start);
    let (mut square, mut m) = ([zero; N], [zero; N]);
    // D; I3 (I3 + A^2 + rho c L) as `feed`; I3 L - I1 rho c as `turn`; A; then P'/s as `push` and n'/A as `spin`.
    let (mut d, mut feed, mut turn, mut radius) = ([zero; N], [zero; N], [zero; N], [zero; N]);
    let (mut push, mut spin) = ([zero; N], [zero; N]);
    let two_rho = rho + rho;
    let d_square = rho * rho * (i1 - i3);
    let (d_s, d_c, turn_c) = (i1 * a * two_rho, i3 * ell * two_rho, (i3 - i1) * rho);
    let (feed_s, feed_c) = (i3 * a * two_rho, i3 * rho * ell);
    let pull = i3 * a;
    let [mut s_c, mut c_p, mut feed_m, mut turn_m, mut s_push, mut radius_spin] = [[zero; N]; 6];
    for k in 0..N {
        square_on(&mut square, &s, k);
        multiply_on(&mut m, &s, &n, k);
        multiply_on(&mut s_c, &s, &c, k);
        multiply_on(&mut c_p, &c, &p, k);
        // The squares in A^2 and rho c L, rho^2 s^2 and rho^2 c^2, add up to rho^2.
        (d[k], feed[k]) = (d_s * s[k] + d_c * c[k] + d_square * square[k], feed_s * s[k] + feed_c * c[k]);
        (turn[k], radius[k]) = (turn_c * c[k], rho * s[k]);
        if k == 0 {
            d[0] = d[0] + (i1 * i3 + i1 * a * a + i3 * (ell * ell + rho * rho));
            feed[0] = feed[0] + i3 * (i3 + a * a + rho * rho);
            turn[0] = turn[0] + i3 * ell;
            radius[0] = radius[0] + a;
        }
        multiply_on(&mut feed_m, &feed, &m, k);
        multiply_on(&mut turn_m, &turn, &m, k);
        let over_d = |of: T, so_far: &[T; N]| (1..=k).fold(of, |sum, i| sum - d[i] * so_far[k - i]) / d[0];
        let lever = ell * p[k] + rho * c_p[k];
        push[k] = over_d(feed_m[k] - pull * lever, &push);
        spin[k] = over_d(i1 * a * p[k] + turn_m[k], &spin);
        multiply_on(&mut s_push, &s, &push, k);
        multiply_on(&mut radius_spin, &radius, &spin, k);
        if k + 1 < N {
            let next = zero.splat((k + 1) as f64);
            s[k + 1] = s_c[k] / next;
            c[k + 1] = -square[k] / next;
            p[k + 1] = s_push[k] / next;
            n[k + 1] = radius_spin[k] / next;
        }
    }
    [s, c, p, n, square, m]
}

impl Panel {
    /// Computes the power series about `centre`, accurate up to the distance `reach`, from the values at the centre.
    #[inline(always)]
    pub fn new(law: &Reduced<f64>, centre: f64, reach: f64, start: PanelCentre) -> Self {
        let [s, c, p, n, square, m] = lines::<f64, ORDER>(law, start.at);
        let (mut g, mut left) = ([0.0; ORDER], [0.0; ORDER]);
        let (rim, of) = (&law.shape.rim, law.at((start.at[0], start.at[1])));
        let (axial, share) = if law.round { (law.shape.i3, 0.0) } else { (law.axial(&of), of.k / of.al) };
        let (slide, mut growth, mut far) = (&mut [0.0; ORDER], 0.0, 1.0);
        let deep = Rim { ell: rim.ell.abs(), ..*rim };
        left[0] = start.k;
        let [mut n_n, mut weight, mut slide_slide, mut p_p, mut s_m, mut c_p] = [[0.0; ORDER]; 6];
        for k in 0..ORDER {
            square_on(&mut n_n, &n, k);
            if k > 0 {
                let (height, spin) = (2.0 * rim.slope((s[k], c[k])), axial * n_n[k]);
                left[k] = -(height + spin);
                far *= reach;
                growth += (2.0 * deep.slope((s[k].abs(), c[k].abs())) + spin.abs()) * far;
            }
            multiply_on(&mut weight, &square, &left, k);
            let turning = if law.round {
                multiply_on(&mut s_m, &s, &m, k);
                multiply_on(&mut c_p, &c, &p, k);
                square_on(&mut p_p, &p, k);
                slide[k] = rim.a * m[k] - rim.ell * p[k] + rim.rho * (s_m[k] - c_p[k]);
                law.shape.i1 * p_p[k]
            } else {
                slide[k] = p[k] - share * m[k];
                0.0
            };
            square_on(&mut slide_slide, slide, k);
            let sliding = if law.round { 1.0 } else { of.al };
            g[k] = weight[k] - turning - sliding * slide_slide[k];
        }
        Self { centre, reach, p, n, g, k: left, size: start.size, growth, known: Certainty::Rounded }
    }

    /// The size of the terms whose sum is K, at the distance `y` from the centre.
    pub fn size(&self, y: f64) -> f64 {
        self.size + self.growth * (y / self.reach).abs().min(1.0)
    }

    /// Returns this panel with more accurate values of G and its slope at the centre, of the certainty `known`.
    pub fn with_exact_centre(mut self, [g, slope]: [f64; 2], known: Certainty) -> Self {
        (self.g[0], self.g[1], self.known) = (g, slope, known);
        self
    }

    pub fn is_finite(&self) -> bool {
        self.g.iter().all(|g| g.is_finite())
    }

    /// Rounding error of G at the distance `y` from the centre, where the terms of G have the size `terms`.
    pub fn rounding(&self, y: f64, terms: f64) -> f64 {
        const KEPT: f64 = 1.0 / (1u128 << 100) as f64;
        let far = (y / self.reach).abs().min(1.0);
        let known = f64::EPSILON * (self.g[0].abs() + (self.g[1] * y).abs() + terms * far * far);
        match self.known {
            Certainty::Rounded => f64::EPSILON * terms,
            Certainty::Start => known + KEPT * terms * y.abs().min(1.0),
            Certainty::Carried => known + KEPT * terms,
        }
    }

    /// Factor from 0 to 1 on the rounding error of G at `y` that remains after G has been divided by its zero at
    /// `root`.
    pub fn share(&self, y: f64, root: f64) -> f64 {
        match self.known {
            Certainty::Rounded => 1.0,
            _ => (y.abs().max(root.abs()) / self.reach).min(1.0),
        }
    }

    /// The first zero of G from `y` on in the direction `way`, within the reach of the series; the minima of G that
    /// are passed before it are added to `dips`. All places are measured from the centre.
    pub fn first_zero_or_dips(&self, mut y: f64, way: f64, dips: &mut Vec<Dip>) -> Option<f64> {
        let derivative = |of: &PanelTerms| -> PanelTerms {
            core::array::from_fn(|i| if i + 1 < ORDER { (i + 1) as f64 * of[i + 1] } else { 0.0 })
        };
        let slope = derivative(&self.g);
        let mut bound = 0.0;
        for i in (2..ORDER).rev() {
            bound = bound * self.reach + (i * (i - 1)) as f64 * self.g[i].abs();
        }
        let mut before: Option<f64> = None;
        for _ in 0..4000 {
            let (g, rise) = (value(&self.g, y), way * value(&slope, y));
            if g < 0.0 {
                return Some(y);
            }
            if let Some(falling) = before.filter(|_| rise >= 0.0) {
                dips.extend(self.dip(&slope, falling, y));
            }
            before = (rise < 0.0).then_some(y);
            // Taylor's theorem bounds G >= g + rise h - bound h^2/2.
            let root = (rise * rise + 2.0 * bound * g).sqrt();
            let h = if rise < 0.0 { 2.0 * g / (root - rise) } else { (root + rise) / bound };
            let next = y + way * h;
            if next == y || h.is_nan() {
                return Some(y);
            }
            if next.abs() > self.reach {
                return None;
            }
            y = next;
        }
        Some(y)
    }

    /// The minimum of G between two places where its slope has different signs. An approximate place is enough, since
    /// it only shows where the motion is slow.
    fn dip(&self, slope: &PanelTerms, falling: f64, rising: f64) -> Option<Dip> {
        let (mut a, mut b) = (falling, rising);
        let sign = (rising - falling).signum();
        let mut y = 0.5 * (a + b);
        for _ in 0..60 {
            let [g, rise, half, _] = taylor(&self.g, y);
            if (b - a).abs() <= 1e-3 * (g.max(0.0) / half.abs()).sqrt() {
                break;
            }
            if sign * value(slope, y) < 0.0 {
                a = y;
            } else {
                b = y;
            }
            let newton = y - rise / (2.0 * half);
            let next = if a.min(b) < newton && newton < a.max(b) { newton } else { 0.5 * (a + b) };
            if next == y || next == a || next == b {
                break;
            }
            y = next;
        }
        let [g, _, half, _] = taylor(&self.g, y);
        (half > 0.0).then(|| Dip { local: y, width: (g.max(f64::MIN_POSITIVE) / half).sqrt() })
    }
}
