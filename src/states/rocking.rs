//! A stone that spins upright, and its rocking: the small oscillations about this steady spin.
//!
//! ```text
//! (w1, w2, n1, n2)' = A (w1, w2, n1, n2)
//! det(lambda - A) = lambda^4 + a3 lambda^3 + a2 lambda^2 + a1 lambda + a0
//! a3 = c31 W,  a2 = c20 + c22 W^2,  a1 = c11 W + c13 W^3,  a0 = c00 + c02 W^2 + c04 W^4        W is the spin
//! untwisted   a3 = a1 = 0: stable where both roots lambda^2 are real and not positive
//! twisted     stable where a3, a1, a0 > 0 and a3 a2 a1 > a1^2 + a3^2 a0 (Routh 1877, Hurwitz 1895)
//! (I1 + h^2) w1' + I12 w2' = W (I12 w1 + (I2 - I3 - h r1 + h^2) w2) + (h - r2 + h W^2 (r1 - r2)) n2
//! I12 w1' + (I2 + h^2) w2' = W ((I3 - I1 + h r2 - h^2) w1 - I12 w2) + (r1 - h + h W^2 (r1 - r2)) n1
//! n1' = W n2 - w2,   n2' = w1 - W n1
//! height of the centre of mass h = a3 + d3, radii of curvature at the bottom r1 = a1^2/a3 and r2 = a2^2/a3,
//! all from the semi-axes a1, a2 and a3
//! ```
//! The two equations for w are Newton's and Euler's law for a stone that rolls, to first order in w1, w2, n1 and n2; A
//! is computed with twice the digits. The terms of a twisted stone that are odd in W change their sign with the spin:
//! one of its two modes of rocking grows and the other decays, and with the opposite spin they change places. The mode
//! with the higher frequency grows faster, so that one direction of spin reverses much sooner (Bondi, Proc. R. Soc. A
//! 405, 265 (1986)).
//!
//! Error: 1e-13 of the largest eigenvalue. `tests/test_stone_reference.py` compares the eigenvalues with 60
//! digits from another model.

use crate::error::{Error, within};
use crate::laws::stone::Ellipsoid;
use crate::numbers::{Real, Sum};
use core::ops::{Add, Mul, Sub};

type Long = Sum<f64>;

/// Relative sizes below which numbers count as zero: a leading coefficient, the last change of a root, and the
/// imaginary part of a root.
const ZEROS: [f64; 3] = [1e-28, 1e-26, 1e-24];

/// The two modes of rocking of a stone that spins upright, the slower one first.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Rocking {
    /// The rate at which each mode grows (the larger one of two real rates), in sqrt(g/a).
    pub growth: [f64; 2],
    /// The angular frequency of each mode, in sqrt(g/a); 0 for a mode that grows or decays without oscillation.
    pub frequency: [f64; 2],
    /// The four eigenvalues of the matrix A of the rocking, in sqrt(g/a).
    pub eigenvalues: [nalgebra::Complex<f64>; 4],
}

impl Rocking {
    /// Whether neither mode of rocking grows.
    pub fn is_stable(&self) -> bool {
        self.growth.iter().all(|x| *x <= 0.0)
    }
}

/// A complex number with twice the digits.
#[derive(Clone, Copy)]
struct Complex {
    re: Long,
    im: Long,
}

impl Add for Complex {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self { re: self.re + b.re, im: self.im + b.im }
    }
}
impl Sub for Complex {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self { re: self.re - b.re, im: self.im - b.im }
    }
}
impl Mul for Complex {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Self { re: self.re * b.re - self.im * b.im, im: self.re * b.im + self.im * b.re }
    }
}

impl Complex {
    fn over(self, b: Self) -> Self {
        let square = b.re * b.re + b.im * b.im;
        let Self { re, im } = self * Self { re: b.re, im: -b.im };
        Self { re: re / square, im: im / square }
    }

    fn size(&self) -> f64 {
        self.re.hi.hypot(self.im.hi)
    }

    /// The square root that has a positive real part, or lies on the positive imaginary axis.
    fn root(self) -> Self {
        let zero = Long::from(0.0);
        let size = (self.re * self.re + self.im * self.im).sqrt();
        let half = Long::from(0.5);
        if self.im.hi == 0.0 {
            let root = self.re.abs().sqrt();
            return if self.re.hi < 0.0 { Self { re: zero, im: root } } else { Self { re: root, im: zero } };
        }
        let (sum, less) = ((size + self.re.abs()) * half, self.im.abs() * half);
        let large = sum.sqrt();
        let small = less / large;
        let (re, im) = if self.re.hi < 0.0 { (small, large) } else { (large, small) };
        Self { re, im: if self.im.hi < 0.0 { -im } else { im } }
    }
}

/// The coefficients a0, a1, a2 and a3 of a characteristic polynomial, whose leading coefficient is 1.
type Quartic = [Long; 4];

impl Ellipsoid {
    /// Computes the rocking of a stone that spins upright at the rate `spin`, with axis 3 up and the contact
    /// point at rest.
    ///
    /// # Errors
    /// `OutOfRange` for a spin beyond 1e6, and for a stone that cannot spin upright, because axis 3 is not a principal
    /// axis or does not pass through the centre of mass.
    pub fn rocking(&self, spin: f64) -> Result<Rocking, Error> {
        self.is_upright()?;
        within("spin", spin, (-1e6, 1e6), "|spin| <= 1e6 sqrt(g/a)")?;
        Ok(self.modes(&self.quartic(spin), spin))
    }

    /// The rates of spin, in sqrt(g/a) and in ascending order, at which a stone that spins upright becomes stable or unstable.
    ///
    /// # Errors
    /// Those of [`rocking`](Self::rocking) for the stone.
    pub fn spin_limits(&self) -> Result<Vec<f64>, Error> {
        self.is_upright()?;
        // Polynomials in W^2 from their values at W = 0, 1 and 2.
        let [still, one, two] = [0.0, 1.0, 2.0].map(|spin| self.quartic(spin));
        let fit = |c0: Long, at_1: Long, at_2: Long| {
            let (d1, d2) = (at_1 - c0, at_2 - c0);
            let c4 = (d2 - d1 * Long::from(4.0)) / Long::from(12.0);
            [c0, d1 - c4, c4]
        };
        let half = Long::from(0.5);
        let a0 = fit(still[0], one[0], two[0]);
        let a2 = [still[2], one[2] - still[2], Long::from(0.0)];
        let mut squares = Vec::new();
        squares.extend(roots(a0));
        squares.extend(roots(a2));
        if self.is_even() {
            let four = Long::from(4.0);
            squares.extend(roots([
                a2[0] * a2[0] - four * a0[0],
                Long::from(2.0) * a2[0] * a2[1] - four * a0[1],
                a2[1] * a2[1] - four * a0[2],
            ]));
        } else {
            // a1 = W (p + q W^2) and a3 = r W.
            let (r, third) = (one[3], Long::from(1.0) / Long::from(3.0));
            let q = (two[1] * half - one[1]) * third;
            let p = one[1] - q;
            squares.extend(roots([p, q, Long::from(0.0)]));
            squares.extend(roots([
                r * a2[0] * p - p * p - r * r * a0[0],
                r * (a2[0] * q + a2[1] * p) - Long::from(2.0) * p * q - r * r * a0[1],
                r * a2[1] * q - q * q - r * r * a0[2],
            ]));
        }
        let mut spins: Vec<f64> = squares.into_iter().filter(|x| *x > 0.0).map(f64::sqrt).collect();
        spins.extend(spins.clone().into_iter().map(|spin| -spin));
        if !self.is_even() {
            spins.push(0.0);
        }
        spins.sort_by(f64::total_cmp);
        spins.dedup();
        let Some((first, last)) = spins.first().copied().zip(spins.last().copied()) else {
            return Ok(spins);
        };
        let stable = |spin: f64| self.modes(&self.quartic(spin), spin).is_stable();
        let mut before = stable(first - 1.0);
        let ends: Vec<f64> = spins.iter().skip(1).copied().chain([last + 2.0]).collect();
        let mut limits = Vec::new();
        for (spin, end) in spins.into_iter().zip(ends) {
            let after = stable(0.5 * (spin + end));
            if after != before {
                limits.push(spin);
            }
            before = after;
        }
        Ok(limits)
    }

    /// Returns an error for a stone that cannot spin steadily upright about axis 3.
    fn is_upright(&self) -> Result<(), Error> {
        let [.., d, e, _] = self.inertia.0;
        within(
            "inertia",
            d.abs().max(e.abs()),
            (0.0, 0.0),
            "axis 3 to be a principal axis, for a steady spin",
        )?;
        let [x, y, _] = self.offset;
        within("offset", x.abs().max(y.abs()), (0.0, 0.0), "a centre of mass on axis 3, for a steady spin")?;
        Ok(())
    }

    /// Whether the rocking is the same for both directions of spin, as for an untwisted stone.
    fn is_even(&self) -> bool {
        self.inertia.0[5] == 0.0 || self.axes[0] == self.axes[1]
    }

    /// The characteristic polynomial of the rocking of a stone that spins at the rate `spin`.
    fn quartic(&self, spin: f64) -> Quartic {
        characteristic(&self.linear(spin))
    }

    /// The matrix A of the rocking of a stone that spins at the rate `spin`.
    fn linear(&self, spin: f64) -> [[Long; 4]; 4] {
        let long = Long::from;
        let ([a, b, c, _, _, f], [.., below]) = (self.inertia.0.map(long), self.offset.map(long));
        let [x, y, z] = self.axes.map(long);
        let (w, zero) = (long(spin), long(0.0));
        // The height h of the centre of mass, and the radii of curvature of the bottom.
        let (h, along, across) = (z + below, x * x / z, y * y / z);
        let (turned, lifted) = (h * w * (across - h), h * w * (h - along));
        let bent = h * w * w * (along - across);
        let pushed = [
            [f * w, w * (b - c) + lifted, zero, h - across + bent],
            [w * (c - a) + turned, -(f * w), along - h + bent, zero],
        ];
        let (p, q) = (a + h * h, b + h * h);
        let per = long(1.0) / (p * q - f * f);
        let solved = |one: Long, other: Long| [(q * one - f * other) * per, (p * other - f * one) * per];
        let mut all = [[zero; 4]; 4];
        for column in 0..4 {
            [all[0][column], all[1][column]] = solved(pushed[0][column], pushed[1][column]);
        }
        (all[2][1], all[2][3], all[3][0], all[3][2]) = (long(-1.0), w, long(1.0), -w);
        all
    }

    /// The two modes of rocking, from the roots of their characteristic polynomial.
    fn modes(&self, quartic: &Quartic, spin: f64) -> Rocking {
        let mut all = if self.is_even() || spin == 0.0 {
            roots_of_even_quartic(quartic)
        } else {
            roots_of_quartic(quartic)
        };
        let before = |a: &Complex, b: &Complex| {
            let [a_im, b_im] = [a, b].map(|x| x.im.hi.abs());
            a_im < b_im || a_im == b_im && a.re.hi.abs() < b.re.hi.abs()
        };
        // Five exchanges sort four eigenvalues; the library's sort would make the program of a
        // web page longer.
        for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
            if before(&all[j], &all[i]) {
                all.swap(i, j);
            }
        }
        let growth = [all[0].re.hi.max(all[1].re.hi), all[2].re.hi.max(all[3].re.hi)];
        let frequency = [all[1].im.hi.abs(), all[3].im.hi.abs()];
        Rocking { growth, frequency, eigenvalues: all.map(|x| nalgebra::Complex::new(x.re.hi, x.im.hi)) }
    }
}

/// The characteristic polynomial of a matrix (by the method of Faddeev and LeVerrier).
fn characteristic(a: &[[Long; 4]; 4]) -> Quartic {
    let zero = Long::from(0.0);
    let mut c = [zero; 4];
    let mut power = [[zero; 4]; 4];
    for k in 1..=4 {
        let mut next = *a;
        if k > 1 {
            (0..4).for_each(|i| power[i][i] = power[i][i] + c[5 - k]);
            for (row, of) in next.iter_mut().zip(a) {
                for (j, x) in row.iter_mut().enumerate() {
                    *x = (0..4).fold(zero, |sum, l| sum + of[l] * power[l][j]);
                }
            }
        }
        let trace = (0..4).fold(zero, |sum, i| sum + next[i][i]);
        c[4 - k] = -(trace / Long::from(k as f64));
        power = next;
    }
    c
}

/// The real roots of the polynomial c0 + c1 x + c2 x^2.
fn roots([c, b, a]: [Long; 3]) -> Vec<f64> {
    let size = c.hi.abs().max(b.hi.abs()).max(a.hi.abs());
    if a.hi.abs() <= ZEROS[0] * size {
        return if b.hi.abs() <= ZEROS[0] * size { Vec::new() } else { vec![(-c / b).hi] };
    }
    let square = b * b - Long::from(4.0) * a * c;
    if square.hi < 0.0 {
        return Vec::new();
    }
    let root = square.sqrt();
    let far = Long::from(-0.5) * if b.hi < 0.0 { b - root } else { b + root };
    if far.hi == 0.0 { vec![0.0] } else { vec![(far / a).hi, (c / far).hi] }
}

/// The four roots of a quartic without odd powers.
fn roots_of_even_quartic(&[a0, _, a2, _]: &Quartic) -> [Complex; 4] {
    let (zero, half) = (Long::from(0.0), Long::from(0.5));
    let square = a2 * a2 * half * half - a0;
    let middle = -(a2 * half);
    let of = if square.hi < 0.0 {
        let im = (-square).sqrt();
        [Complex { re: middle, im }, Complex { re: middle, im: -im }]
    } else {
        let root = square.sqrt();
        let far = if middle.hi < 0.0 { middle - root } else { middle + root };
        let near = if far.hi == 0.0 { zero } else { a0 / far };
        [Complex { re: far, im: zero }, Complex { re: near, im: zero }]
    };
    let [x, y] = of.map(Complex::root);
    let less = |x: Complex| Complex { re: -x.re, im: -x.im };
    [x, less(x), y, less(y)]
}

/// The four roots of a quartic, by simultaneous iteration (Durand and Kerner).
fn roots_of_quartic(quartic: &Quartic) -> [Complex; 4] {
    let number = |re: f64, im: f64| Complex { re: Long::from(re), im: Long::from(im) };
    let bound = (0..4).map(|i| quartic[i].hi.abs().powf(1.0 / (4 - i) as f64)).fold(0.0, f64::max);
    let mut all = [0.4, 1.9, 3.6, 5.0].map(|turn: f64| number(bound * turn.cos(), bound * turn.sin()));
    for _ in 0..500 {
        let mut moved = 0f64;
        for i in 0..4 {
            let x = all[i];
            let value = quartic.iter().rev().fold(number(1.0, 0.0), |sum, a| {
                let Complex { re, im } = sum * x;
                Complex { re: re + *a, im }
            });
            let apart = (0..4).filter(|j| *j != i).fold(number(1.0, 0.0), |all_of, j| all_of * (x - all[j]));
            if value.size() == 0.0 || apart.size() == 0.0 {
                continue;
            }
            let step = value.over(apart);
            all[i] = x - step;
            moved = moved.max(step.size());
        }
        if moved <= ZEROS[1] * bound {
            break;
        }
    }
    // A root as close to the real axis as rounding is real.
    all.map(|x| if x.im.hi.abs() <= ZEROS[2] * bound { Complex { im: Long::from(0.0), ..x } } else { x })
}
