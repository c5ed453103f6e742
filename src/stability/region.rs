//! What is known about a point of the map: forbidden, or stable or not by either question.
//!
//! ```text
//! code = 4 + [rolling kappa > 0] + 2 [smooth kappa > 0];   1 where n/m < 0,   2 where a sign is not known,   0 elsewhere
//! ```

use super::at_rest::Wanted;
use super::column::Column;
use crate::body::Body;
use crate::number::{LANES, Real, in_lanes, in_registers, level};
use fearless_simd::{Simd, SimdFrom, f64x8};

/// What is known about a point of the theta-ell map. The number is the code on a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Region {
    /// No question: theta outside (0, pi/2], or no such body.
    Invalid = 0,
    /// No steady state with the centre at rest, between theta0 and thetaInf.
    Forbidden = 1,
    /// Too close to theta0 or thetaInf for double precision to decide.
    Undetermined = 2,
    /// A steady state, unstable on a smooth table and rolling.
    Unstable = 4,
    /// Unstable on a smooth table, stable when rolling.
    StableRolling = 5,
    /// Stable on a smooth table, unstable when rolling.
    StableSmooth = 6,
    /// Stable by both.
    Stable = 7,
}

/// The code of the point's [`Region`], as a number in a lane.
#[inline(always)]
pub(super) fn region_of<T: Real>(theta: T, most: T, ell: T, [n, m]: [T; 2], smooth: T, rolling: T) -> T {
    let x = |v: f64| theta.splat(v);
    let zero = x(0.0);
    let steady = x(4.0) + zero.select_lt(rolling, x(1.0), zero) + zero.select_lt(smooth, x(2.0), zero);
    let product = m.select_lt(zero, -n, n);
    // n or m is NaN where its sign is not known
    let sure = zero.select_lt(product, steady, product.select_lt(zero, x(1.0), x(2.0)));
    let sure = zero.select_lt(m.abs(), sure, x(2.0));
    let inside = most.select_lt(theta, zero, sure);
    let body = x(-1.0).select_lt(ell, inside, zero);
    zero.select_lt(theta, body, zero)
}

/// What is known about the steady state with the centre at rest at inclination `theta`: forbidden,
/// or stable or not by either question. Never fails: what is no question is `Invalid`.
pub fn region(body: &Body, theta: f64) -> Region {
    let (of, wanted) = (Column::of(body), Wanted { region: true, ..Wanted::default() });
    let code = in_registers!(of.found(theta, wanted)).region;
    [
        Region::Forbidden,
        Region::Undetermined,
        Region::Unstable,
        Region::StableRolling,
        Region::StableSmooth,
        Region::Stable,
    ]
    .into_iter()
    .find(|r| f64::from(*r as u8) == code)
    .unwrap_or(Region::Invalid)
}

/// The codes of the regions of a body at several inclinations.
pub(crate) fn regions(body: &Body, theta: impl ExactSizeIterator<Item = f64>) -> Vec<u8> {
    if cfg!(target_arch = "wasm32") {
        // lanes without a fused product are many lines, and not faster
        return theta.map(|x| region(body, x) as u8).collect();
    }
    let of = Column::of(body);
    let mut codes = Vec::with_capacity(theta.len());
    let mut theta = theta.peekable();
    while theta.peek().is_some() {
        let mut lanes = [f64::NAN; LANES];
        let count = lanes.iter_mut().zip(&mut theta).map(|(slot, x)| *slot = x).count();
        let wanted = Wanted { region: true, ..Wanted::default() };
        let found = in_lanes!(
            level(),
            simd => eight(simd, &of, lanes),
            else lanes.map(|theta| of.found(theta, wanted).region)
        );
        codes.extend(found[..count].iter().map(|code| *code as u8));
    }
    codes
}

#[inline(always)]
fn eight<S: Simd>(simd: S, of: &Column<f64>, theta: [f64; LANES]) -> [f64; LANES] {
    let of = of.map(
        #[inline(always)]
        |x| f64x8::simd_from(simd, [x; LANES]),
    );
    *of.found(f64x8::simd_from(simd, theta), Wanted { region: true, ..Wanted::default() }).region
}
