//! Vectors and symmetric matrices in three dimensions, over any number.

use super::real::Real;

#[inline(always)]
pub(crate) fn dot<T: Real>(a: [T; 3], b: [T; 3]) -> T {
    a[0].mac(b[0], a[1].mac(b[1], a[2] * b[2]))
}

#[inline(always)]
pub(crate) fn cross<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The sum `a + k b`.
#[inline(always)]
pub(crate) fn plus<T: Real>(a: [T; 3], k: T, b: [T; 3]) -> [T; 3] {
    [b[0].mac(k, a[0]), b[1].mac(k, a[1]), b[2].mac(k, a[2])]
}

/// A symmetric matrix, by its elements 11, 22, 33, 23, 13 and 12.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Symmetric<T>(pub [T; 6]);

impl<T: Real> Symmetric<T> {
    /// The product of the matrix with a vector.
    #[inline(always)]
    pub fn times(&self, v: [T; 3]) -> [T; 3] {
        let [a, b, c, d, e, f] = self.0;
        [dot([a, f, e], v), dot([f, b, d], v), dot([e, d, c], v)]
    }

    /// The solution x of `self x = v` for a positive definite matrix, by Cramer's rule.
    #[inline(always)]
    pub fn solve(&self, v: [T; 3]) -> [T; 3] {
        let (adjugate, det) = self.adjugate();
        let per = det.splat(1.0) / det;
        adjugate.times(v).map(|x| x * per)
    }

    /// The inverse of a positive definite matrix.
    pub fn inverse(&self) -> Self {
        let (adjugate, det) = self.adjugate();
        let per = det.splat(1.0) / det;
        Self(adjugate.0.map(|x| x * per))
    }

    /// The matrix of cofactors, and the determinant.
    #[inline(always)]
    fn adjugate(&self) -> (Self, T) {
        let [a, b, c, d, e, f] = self.0;
        let of = [b * c - d * d, a * c - e * e, a * b - f * f, e * f - a * d, d * f - b * e, d * e - c * f];
        (Self(of), dot([a, f, e], [of[0], of[5], of[4]]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_times_its_solution_is_the_vector() {
        let matrix = Symmetric([2.0, 3.0, 1.5, 0.4, -0.3, 0.7]);
        let v = [0.2, -1.0, 0.5];
        for x in [matrix.solve(v), matrix.inverse().times(v)] {
            let off = plus(matrix.times(x), -1.0, v);
            assert!(dot(off, off) < 1e-30, "{off:?}");
        }
        assert_eq!(cross([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
    }
}
