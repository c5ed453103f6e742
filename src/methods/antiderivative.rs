//! Integrals from 0 on of smooth functions of one variable, as Chebyshev series on as many pieces of the interval as are needed.
//!
//! ```text
//! F(u) = integral of f from 0 to u,   f = sum c_k T_k(v) on a piece,   v in [-1, 1]
//! ```
//! A piece is halved until the last terms of its series are rounding errors (Clenshaw and Curtis 1960, in
//! pieces). The uncertainty of the integral over a piece is the sum of the omitted terms and of the noise
//! that the function reports.

use std::sync::OnceLock;

const NODES: usize = 24;
/// A series is complete if its last terms are below this, relative to the scale of the function. The terms of its
/// integral are 48 times smaller, so that the integral is accurate to 1e-16. With a limit below the rounding errors the
/// halving of pieces would never end.
const COMPLETE_SERIES_TERM: f64 = 4e-15;
/// Largest number of pieces of an integral; the slowest passage of an unstable steady state needs fewer.
const PIECES: usize = 1000;
/// Largest relative noise that relaxes the test for a complete series: with more noise, the unresolved series of a
/// noisy function would count as complete.
const NOISE: f64 = 1e-2;

#[derive(Debug, Clone)]
struct Piece<const M: usize> {
    left: f64,
    right: f64,
    before: [f64; M],
    doubt_before: f64,
    /// Chebyshev series of the first function itself, for Newton's method in the inversion of its integral.
    rate: [f64; NODES],
    series: [[f64; NODES + 1]; M],
}

/// Integrals of M functions from 0 on; the first function is positive, so that its integral can be inverted.
#[derive(Debug, Clone)]
pub(crate) struct Antiderivative<const M: usize> {
    pieces: Vec<Piece<M>>,
    pub total: [f64; M],
    /// Absolute uncertainty of each integral from 0 to the end of the last piece.
    pub doubt: [f64; M],
}

/// cos(k u_j) at the midpoints u_j of Chebyshev's nodes; j is the first index, so that the terms of one sample lie side by side.
fn cosines() -> &'static [[f64; NODES]; NODES] {
    static TABLE: OnceLock<[[f64; NODES]; NODES]> = OnceLock::new();
    TABLE.get_or_init(|| {
        core::array::from_fn(|j| {
            core::array::from_fn(|k| {
                (core::f64::consts::PI * k as f64 * (j as f64 + 0.5) / NODES as f64).cos()
            })
        })
    })
}

/// The value at v of a Chebyshev series whose first coefficient is not halved, by Clenshaw's sum.
fn sum(series: &[f64], v: f64) -> f64 {
    let (mut b1, mut b2) = (0.0, 0.0);
    for c in series[1..].iter().rev() {
        (b1, b2) = (2.0 * v * b1 - b2 + c, b1);
    }
    v * b1 - b2 + series[0]
}

impl<const M: usize> Piece<M> {
    fn scaled(&self, u: f64) -> f64 {
        ((u - self.left) - (self.right - u)) / (self.right - self.left)
    }

    fn at(&self, i: usize, u: f64) -> f64 {
        self.before[i] + sum(&self.series[i], self.scaled(u))
    }
}

/// The values of M functions at one place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sampled<const M: usize> {
    pub value: [f64; M],
    /// The largest of the terms whose sum each function is, as the scale of its rounding error.
    pub scale: [f64; M],
    /// The relative uncertainty of the values.
    pub noise: f64,
}

impl<const M: usize> Antiderivative<M> {
    /// Integrals of `f` from the first of the `cuts` to the last one; None if `f` is not finite, or cannot be resolved
    /// by pieces of at least the width `narrowest`.
    pub fn new(cuts: &[f64], narrowest: f64, mut f: impl FnMut(f64) -> Sampled<M>) -> Option<Self> {
        let mut waiting: Vec<(f64, f64)> = cuts.windows(2).rev().map(|w| (w[0], w[1])).collect();
        let mut whole = Self { pieces: Vec::new(), total: [0.0; M], doubt: [0.0; M] };
        while let Some((left, right)) = waiting.pop() {
            let half = 0.5 * (right - left);
            let Some((piece, doubt)) = Self::complete_piece(&mut f, left, right, &whole) else {
                if whole.pieces.len() + waiting.len() > PIECES || half < narrowest {
                    return None;
                }
                waiting.extend([(left + half, right), (left, left + half)]);
                continue;
            };
            whole.total = core::array::from_fn(|i| piece.at(i, right));
            if whole.total.iter().any(|x| !x.is_finite()) {
                return None;
            }
            for (sum, doubt) in whole.doubt.iter_mut().zip(doubt) {
                *sum += 2.0 * half * doubt;
            }
            whole.pieces.push(piece);
        }
        Some(whole)
    }

    /// The piece from `left` to `right`, and the uncertainty of its integrals; None if the series is not
    /// complete.
    fn complete_piece(
        f: &mut impl FnMut(f64) -> Sampled<M>,
        left: f64,
        right: f64,
        before: &Self,
    ) -> Option<(Piece<M>, [f64; M])> {
        let table = cosines();
        let half = 0.5 * (right - left);
        let mut values = [[0.0; NODES]; M];
        let (mut noise, mut doubt, mut scale) = ([0f64; M], [0.0; M], [0f64; M]);
        for j in 0..NODES {
            let sample = f(left + half * (1.0 + table[j][1]));
            for i in 0..M {
                values[i][j] = sample.value[i];
                scale[i] = scale[i].max(sample.scale[i].abs());
                noise[i] = noise[i].max(sample.scale[i].abs() * sample.noise.min(NOISE));
                doubt[i] += (sample.value[i] * sample.noise).abs() / NODES as f64;
            }
        }
        let mut piece = Piece {
            left,
            right,
            before: before.total,
            doubt_before: before.doubt[0],
            rate: [0.0; NODES],
            series: [[0.0; NODES + 1]; M],
        };
        for i in 0..M {
            let mut rate = [0.0; NODES];
            for (value, cosines) in values[i].iter().zip(table) {
                for (rate, cosine) in rate.iter_mut().zip(cosines) {
                    *rate += value * cosine;
                }
            }
            for (k, rate) in rate.iter_mut().enumerate() {
                *rate *= if k == 0 { 1.0 } else { 2.0 } / NODES as f64;
            }
            let last = rate[NODES - 4..].iter().fold(0f64, |a, c| a.max(c.abs()));
            // A value that is not finite passes this comparison and is an error in `new`.
            if last > scale[i] * COMPLETE_SERIES_TERM + 2.0 * noise[i] {
                return None;
            }
            doubt[i] += last / NODES as f64;
            if i == 0 {
                piece.rate = rate;
            }
            let series = &mut piece.series[i];
            for k in 1..=NODES {
                let up = if k + 1 < NODES { rate[k + 1] } else { 0.0 };
                let down = if k == 1 { 2.0 * rate[0] } else { rate[k - 1] };
                series[k] = half * (down - up) / (2 * k) as f64;
            }
            series[0] = -sum(series, -1.0);
        }
        Some((piece, doubt))
    }

    fn piece(&self, u: f64) -> &Piece<M> {
        &self.pieces[self.pieces.partition_point(|p| p.right < u).min(self.pieces.len() - 1)]
    }

    /// The start of the piece that contains `u`, and the integrals from 0 to that start.
    pub fn start_of_piece(&self, u: f64) -> (f64, [f64; M]) {
        let piece = self.piece(u);
        (piece.left, piece.before)
    }

    /// The M integrals from 0 to `u`.
    pub fn at(&self, u: f64) -> [f64; M] {
        let piece = self.piece(u);
        core::array::from_fn(|i| piece.at(i, u))
    }

    /// Absolute uncertainty of the first integral from 0 to `u`.
    pub fn uncertainty_at(&self, u: f64) -> f64 {
        let next = self.pieces.partition_point(|p| p.right < u) + 1;
        let after = self.pieces.get(next).map_or(self.doubt[0], |p| p.doubt_before);
        let piece = self.piece(u);
        piece.doubt_before + (after - piece.doubt_before) * (0.5 * (1.0 + piece.scaled(u))).clamp(0.0, 1.0)
    }

    /// The u at which the first integral, which increases, has the given value.
    pub fn inverse(&self, value: f64) -> f64 {
        let next = self.pieces.partition_point(|p| p.before[0] <= value);
        let piece = &self.pieces[next.saturating_sub(1)];
        let after = self.pieces.get(next).map_or(self.total[0], |p| p.before[0]);
        let (mut low, mut high) = (piece.left, piece.right);
        let mut u =
            low + (high - low) * ((value - piece.before[0]) / (after - piece.before[0])).clamp(0.0, 1.0);
        for _ in 0..60 {
            let miss = piece.at(0, u) - value;
            if miss > 0.0 {
                high = u
            } else {
                low = u
            }
            let newton = u - miss / sum(&piece.rate, piece.scaled(u));
            let next = if low <= newton && newton <= high { newton } else { 0.5 * (low + high) };
            if (next - u).abs() <= 2.0 * f64::EPSILON * u.abs() {
                return next;
            }
            u = next;
        }
        u
    }

    /// All nodes in ascending order, each with its weight in the first integral. The nodes are dense enough to show
    /// every feature of the functions.
    pub fn nodes(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let table = cosines();
        self.pieces.iter().flat_map(move |p| {
            (0..NODES).rev().map(move |j| {
                let half = 0.5 * (p.right - p.left);
                let cosine = table[j][1];
                let sine = (1.0 - cosine * cosine).sqrt();
                let weight = core::f64::consts::PI / NODES as f64 * half * sine * sum(&p.rate, cosine);
                (p.left + half * (1.0 + cosine), weight)
            })
        })
    }
}
