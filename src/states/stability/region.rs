//! The region of a point of the map, that is, of a body at an inclination: forbidden, or stable or unstable by two criteria.
//!
//! ```text
//! code = 4 + [rolling kappa > 0] + 2 [smooth kappa > 0];   1 where n/m < 0,   2 where a sign is not known,   0 elsewhere
//! ```

use crate::numbers::Real;
use crate::numbers::codes::coded;

coded! {
    /// The region of a point of the map of inclination theta and aspect ratio ell. The number is its code in arrays.
    pub enum Region {
        /// Theta is outside (0, pi/2], or the body is impossible.
        Invalid = 0,
        /// Theta lies between theta0 and thetaInf, where no steady state with the centre at rest exists.
        Forbidden = 1,
        /// Theta is too close to theta0 or thetaInf for double precision to decide.
        Undetermined = 2,
        /// The steady state is unstable on a smooth table and when rolling.
        Unstable = 4,
        /// The steady state is unstable on a smooth table and stable when rolling.
        StableRolling = 5,
        /// The steady state is stable on a smooth table and unstable when rolling.
        StableSmooth = 6,
        /// The steady state is stable on a smooth table and when rolling.
        Stable = 7,
    }
}

/// The code of the [`Region`] of a point of the map, in each SIMD lane.
#[inline(always)]
pub(super) fn region_of<T: Real>(theta: T, most: T, ell: T, [n, m]: [T; 2], smooth: T, rolling: T) -> T {
    let x = |v: f64| theta.splat(v);
    let zero = x(0.0);
    let steady = x(4.0) + zero.select_lt(rolling, x(1.0), zero) + zero.select_lt(smooth, x(2.0), zero);
    let product = m.select_lt(zero, -n, n);
    // n or m is NaN where its sign is not known.
    let sure = zero.select_lt(product, steady, product.select_lt(zero, x(1.0), x(2.0)));
    let sure = zero.select_lt(m.abs(), sure, x(2.0));
    let inside = most.select_lt(theta, zero, sure);
    let body = x(-1.0).select_lt(ell, inside, zero);
    zero.select_lt(theta, body, zero)
}
