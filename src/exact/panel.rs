//! The two linear integrals and the energy as power series in x = ln tan(theta/2) about one place.
//!
//! ```text
//! s = sech x = sin theta,   c = -tanh x = cos theta,   P = w1 s,   n = w3
//! s' = s c,   c' = -s^2,   P' = s (B q - A P),   n' = C P + A q,   q = s n       A, B, C, a, b, k, J: `law`
//! G(x) = J s^2 theta'^2 = 2 E s^2 - a P^2 - b q^2 + 2 k q P - 2 s^2 (ell c + s)
//! ```
//! Everything is analytic for |Im x| < pi/2. A step to the next possible zero of G uses a bound on G'', so that no zero is
//! stepped over.
//!
//! Error: what rounding does to G is at most [`Panel::rounding`]; the tests of `exact` hold the motions to it.

use crate::law::Law;
use crate::real::Real;

/// Terms of a power series, good to 1e-16 within 0.3 of its radius of convergence, though G has a triple pole there.
pub(super) const ORDER: usize = 36;

pub(super) type Series = [f64; ORDER];

/// What is known of G and G' at the centre of a panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Known {
    /// What rounding leaves.
    Rounded,
    /// G to all digits and G' to 2^-100 of its terms: the start.
    Start,
    /// Both to 2^-100 of their terms: carried there in twice the digits.
    Carried,
}

/// The motion as functions of x in a neighbourhood of `centre`.
#[derive(Debug, Clone)]
pub(super) struct Panel {
    /// Measured from the start, as every x here.
    pub centre: f64,
    pub reach: f64,
    pub p: Series,
    pub n: Series,
    pub g: Series,
    pub known: Known,
}

/// A least G between two turning points: where, from the centre of its panel, and how wide it is, sqrt(2 G/G'').
#[derive(Debug, Clone, Copy)]
pub(super) struct Dip {
    pub local: f64,
    pub width: f64,
}

/// Radius of convergence about x is hypot(x, pi/2); and far out exp(2x) must not vary too much.
pub(super) fn reach(x: f64) -> f64 {
    (0.3 * x.hypot(core::f64::consts::FRAC_PI_2)).min(0.75)
}

pub(super) fn horner<T: Real>(series: &[T], x: T) -> T {
    series.iter().rev().fold(x.splat(0.0), |sum, c| sum.mac(x, *c))
}

/// The quotient by (x - root); the remainder, which is rounding, is dropped.
pub(super) fn deflated(series: &Series, root: f64) -> Series {
    let mut quotient = [0.0; ORDER];
    for i in (1..ORDER).rev() {
        quotient[i - 1] = series[i] + if i + 1 < ORDER { root * quotient[i] } else { 0.0 };
    }
    quotient
}

/// Value, slope, half the second derivative and a sixth of the third of a series.
pub(super) fn taylor(series: &Series, x: f64) -> [f64; 4] {
    let mut r = [0.0; 4];
    for c in series.iter().rev() {
        r = [r[0] * x + c, r[1] * x + r[0], r[2] * x + r[1], r[3] * x + r[2]];
    }
    r
}

/// s, c, P, n as series, and with them s^2 and q = s n.
#[inline(always)]
pub(super) fn lines<T: Real, const N: usize>(law: &Law<T>, start: [T; 4]) -> [[T; N]; 6] {
    let zero = start[0].splat(0.0);
    let [mut s, mut c, mut p, mut n] = start.map(|x| {
        let mut series = [zero; N];
        series[0] = x;
        series
    });
    let (mut square, mut q, mut push) = ([zero; N], [zero; N], [zero; N]);
    for k in 0..N {
        let product = |a: &[T; N], b: &[T; N]| (0..=k).fold(zero, |sum, i| a[i].mac(b[k - i], sum));
        square[k] = product(&s, &s);
        q[k] = product(&s, &n);
        push[k] = law.feed * q[k] - law.drag * p[k];
        if k + 1 < N {
            let next = zero.splat((k + 1) as f64);
            s[k + 1] = product(&s, &c) / next;
            c[k + 1] = -square[k] / next;
            p[k + 1] = product(&s, &push) / next;
            n[k + 1] = (law.grow * p[k] + law.drag * q[k]) / next;
        }
    }
    [s, c, p, n, square, q]
}

impl Panel {
    /// About the `centre`, where x itself is `x`, from s, c, P and n there.
    pub fn new(law: &Law<f64>, twice_energy: f64, centre: f64, x: f64, start: [f64; 4]) -> Self {
        let [s, c, p, n, square, q] = lines::<f64, ORDER>(law, start);
        let (mut g, mut pull, mut depth) = ([0.0; ORDER], [0.0; ORDER], [0.0; ORDER]);
        for k in 0..ORDER {
            let product = |a: &Series, b: &Series| (0..=k).fold(0.0, |sum, i| sum + a[i] * b[k - i]);
            pull[k] = 2.0 * law.k * q[k] - law.a * p[k];
            depth[k] = -2.0 * (law.ell * c[k] + s[k]);
            if k == 0 {
                depth[0] += twice_energy;
            }
            g[k] = product(&square, &depth) + product(&p, &pull) - law.b * product(&q, &q);
        }
        Self { centre, reach: reach(x), p, n, g, known: Known::Rounded }
    }

    /// The same where G and its slope at the centre are better known.
    pub fn knowing(mut self, [g, slope]: [f64; 2], known: Known) -> Self {
        (self.g[0], self.g[1], self.known) = (g, slope, known);
        self
    }

    pub fn is_finite(&self) -> bool {
        self.g.iter().all(|g| g.is_finite())
    }

    /// How far G at `y` from the centre can be off, where its terms are as large as `terms`.
    pub fn rounding(&self, y: f64, terms: f64) -> f64 {
        const KEPT: f64 = 1.0 / (1u128 << 100) as f64;
        let far = (y / self.reach).abs().min(1.0);
        let known = f64::EPSILON * (self.g[0].abs() + (self.g[1] * y).abs() + terms * far * far);
        match self.known {
            Known::Rounded => f64::EPSILON * terms,
            Known::Start => known + KEPT * terms * y.abs().min(1.0),
            Known::Carried => known + KEPT * terms,
        }
    }

    /// How much of a rounding of its terms a quotient of G by its zeros takes at `y`, divided by a zero at `root`.
    pub fn share(&self, y: f64, root: f64) -> f64 {
        match self.known {
            Known::Rounded => 1.0,
            _ => (y.abs().max(root.abs()) / self.reach).min(1.0),
        }
    }

    /// The first zero of G from `y` on in the direction `way`, within reach; the least G's that are passed before it are
    /// noted. All measured from the centre.
    pub fn walk(&self, mut y: f64, way: f64, dips: &mut Vec<Dip>) -> Option<f64> {
        let derivative = |of: &Series| -> Series {
            core::array::from_fn(|i| if i + 1 < ORDER { (i + 1) as f64 * of[i + 1] } else { 0.0 })
        };
        let slope = derivative(&self.g);
        let mut bound = 0.0;
        for i in (2..ORDER).rev() {
            bound = bound * self.reach + (i * (i - 1)) as f64 * self.g[i].abs();
        }
        let mut before: Option<f64> = None;
        for _ in 0..4000 {
            let (g, rise) = (horner(&self.g, y), way * horner(&slope, y));
            if g < 0.0 {
                return Some(y);
            }
            if let Some(falling) = before.filter(|_| rise >= 0.0) {
                dips.extend(self.dip(&slope, falling, y));
            }
            before = (rise < 0.0).then_some(y);
            // G >= g + rise h - bound h^2/2
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

    /// The least G between two places at which its slope has different signs: roughly, as it only says where motion is
    /// slow.
    fn dip(&self, slope: &Series, falling: f64, rising: f64) -> Option<Dip> {
        let (mut a, mut b) = (falling, rising);
        let sign = (rising - falling).signum();
        let mut y = 0.5 * (a + b);
        for _ in 0..60 {
            let [g, rise, half, _] = taylor(&self.g, y);
            if (b - a).abs() <= 1e-3 * (g.max(0.0) / half.abs()).sqrt() {
                break;
            }
            if sign * horner(slope, y) < 0.0 {
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
