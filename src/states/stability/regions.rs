//! The region of a body at one inclination, and the codes of its regions at many inclinations.

use super::at_rest::Wanted;
use super::column::Column;
use super::region::Region;
use crate::laws::body::Body;
use crate::methods::SHORT_CODE;
use crate::numbers::{LANES, in_lanes, in_registers, level};
use fearless_simd::{Simd, SimdFrom, f64x8};

/// The region of the steady state with the centre at rest at inclination `theta`: forbidden, or stable or unstable by
/// each of the two criteria. The function never fails: it returns `Invalid` for a theta out of range.
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
    if SHORT_CODE {
        // WebAssembly has no fused product: lanes would be much code, and not faster.
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
            simd => eight_regions(simd, &of, lanes),
            else lanes.map(|theta| of.found(theta, wanted).region)
        );
        codes.extend(found[..count].iter().map(|code| *code as u8));
    }
    codes
}

#[inline(always)]
fn eight_regions<S: Simd>(simd: S, of: &Column<f64>, theta: [f64; LANES]) -> [f64; LANES] {
    let of = of.map(
        #[inline(always)]
        |x| f64x8::simd_from(simd, [x; LANES]),
    );
    *of.found(f64x8::simd_from(simd, theta), Wanted { region: true, ..Wanted::default() }).region
}
