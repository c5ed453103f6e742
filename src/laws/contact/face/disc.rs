//! The friction of a disc that slides and spins, under a pressure that is linear in the place and cut at zero.
//!
//! ```text
//! u = v + w z x (a x),   |x| <= 1,   v along x;   the slip vanishes at (0, k), k = v/s
//! |X| <= 1/4   p = 1 + 4 X.x        |X| > 1/4   p = x.X/|X| - cos b where that is positive
//! chords through (0, k)   x = e n + r m,   n = (cos h, sin h) = u/|u|,   m = (sin h, -cos h),   e = k sin h
//! area   (r + k cos h) dr dh = (1 + (r/k)/cos h) dr de      the first for k <= 1, the second for k > 1
//! ```
//! Along a chord through the instantaneous centre the slip has one direction h, and what is left of it is a polynomial
//! in r. Where the whole disc presses the integral over h is a complete elliptic one. For k > 1 the means are series in
//! 1/k where the elliptic integrals would lose digits.
//!
//! Quadrature over h, or over e = sin h', by rules of 24 nodes in panels: they end where the chord passes the ends of
//! the cut, and are graded towards these as far as the centre is from the cut, and towards the tangents of the disc.
//!
//! Error: 1e-15 of the whole disc, 1e-12 of a part.

use super::part::{FaceIntegrals, PressedFace, PressedPart, ZEROS, one_less};
use super::ring::{WholeMeans, nodes, quarter_integrals};
use crate::numbers::side_by_side::SideBySide;
use crate::numbers::{here, in_lanes, level};
use core::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI};
use fearless_simd::{SimdBase, f64x8};

/// The ratio s/v below which the means are series, and the number of terms of the series.
const SERIES_BELOW: f64 = 0.1;
const MEAN_TERMS: usize = 9;

/// The means over the whole disc, for the speed v of the centre and the speed s of the rim.
pub(super) fn whole(v: f64, s: f64) -> WholeMeans {
    let spins = v <= s;
    let q = if spins { v / s } else { s / v };
    let m = q * q;
    if !spins && q < SERIES_BELOW {
        // The means of rings, as power series in m over uniform pressure, times their widths and levers.
        let (mut b, mut d, mut last, mut power) = (0.5, 0.5, 0.0, 1.0);
        let mut sums = [0.0; 5];
        for j in 0..MEAN_TERMS {
            let n = j as f64;
            let d1 = d - last;
            let terms = [
                (b + d1) / (1.0 + n),
                b / (2.0 + n),
                (2.0 * b + d1) / (3.0 * (2.0 + n)),
                (b - d1) / (3.0 * (2.0 + n)),
                (b + 2.0 * d1) / (3.0 * (2.0 + n)),
            ];
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum += power * term;
            }
            (last, power) = (d, power * m);
            b *= (n + 0.5) * (n + 0.5) / ((n + 1.0) * (n + 2.0));
            d *= (n + 0.5) * (n + 1.5) / ((n + 1.0) * (n + 2.0));
        }
        let [along, couple, x_across, y_along, y_couple] = sums;
        return WholeMeans {
            along,
            couple: q * couple,
            x_across: q * x_across,
            y_along: -q * y_along,
            y_couple: -y_couple,
        };
    }
    let [b, d] = quarter_integrals(q).map(|x| FRAC_2_PI * x);
    if spins {
        WholeMeans {
            along: q * (2.0 * b + d) / 1.5,
            couple: ((3.0 - m) * b + (3.0 - 2.0 * m) * d) / 4.5,
            x_across: ((9.0 - m) * b + (6.0 - 2.0 * m) * d) / 22.5,
            y_along: -((6.0 - 4.0 * m) * b + (9.0 - 8.0 * m) * d) / 22.5,
            y_couple: q * ((1.0 - 2.0 * m) * d - (1.0 + m) * b) / 7.5,
        }
    } else {
        WholeMeans {
            along: (2.0 * b + d) / 1.5,
            couple: ((3.0 * m - 1.0) * b + d) / (4.5 * q),
            x_across: ((9.0 * m - 1.0) * b + (1.0 + 3.0 * m) * d) / (22.5 * q),
            y_along: ((4.0 - 6.0 * m) * b + (3.0 * m - 4.0) * d) / (22.5 * q),
            y_couple: ((1.0 - 2.0 * m) * d - (1.0 + m) * b) / (7.5 * m),
        }
    }
}

/// The result for a pressed part of the disc, at the speeds `v` of the centre and `s` of the rim, for lam = mu Z/a.
pub(super) fn on_disc(part: &PressedPart, lam: f64, v: f64, s: f64) -> PressedFace {
    in_lanes!(
        level(),
        simd => disc_integrals(<f64x8<_> as SimdBase<_>>::splat(simd, 0.0), part, v, s).pressed(lam),
        else disc_integrals(ZEROS, part, v, s).pressed(lam)
    )
}

/// A place on the real axis near which the integrand has a singularity, at this distance from the axis. At a sharp
/// place a panel ends.
#[derive(Clone, Copy)]
struct Singular {
    at: f64,
    aside: f64,
    sharp: bool,
}

/// The largest ratio of a panel's length to its distance from a singularity, the least such distance, and the longest panel.
const GRADE: f64 = 4.0;
const NEAREST_SINGULARITY: f64 = 1e-8;
const WIDE_PANEL: f64 = 1.6;

/// The end of the panel of the quadrature that begins at `left`.
fn panel_end(left: f64, last: f64, singular: &[Singular]) -> f64 {
    let mut right = last.min(left + WIDE_PANEL);
    for of in singular {
        let reach = if of.at <= left {
            left + GRADE * (left - of.at).max(of.aside)
        } else {
            let short = (left + GRADE * of.at) / (1.0 + GRADE);
            let short = short.max(left + GRADE * of.aside);
            if of.sharp && (short > of.at || of.at - short < of.aside) { of.at } else { short }
        };
        right = right.min(reach);
    }
    right
}

/// The integrals over the pressed part of the disc, at the speeds v of the centre and s of the rim.
#[inline(always)]
fn disc_integrals<T: SideBySide>(like: T, part: &PressedPart, v: f64, s: f64) -> FaceIntegrals<T> {
    let number = here(
        #[inline(always)]
        |x: f64| like.splat(x),
    );
    let (k, q) = (v / s, s / v);
    let inside = v <= s;
    let (sine, cosine) = (part.angle.sin(), part.off.sin());
    let cut = 1.0 - 2.0 * part.width;
    let b = 2.0 * part.width.sqrt().min(1.0).asin();
    // How far the instantaneous centre is from the cut, and from the disc.
    let from_cut = (0.5 * (k * sine - cut).abs()).max(NEAREST_SINGULARITY);
    let from_disc = k.max(q).acosh().max(NEAREST_SINGULARITY);
    let (from, to) = (-FRAC_PI_2, if inside { 1.5 * PI } else { FRAC_PI_2 });
    let tangent = |at: f64| Singular { at, aside: from_disc, sharp: true };
    let ends = [-b, b].map(|side| {
        let (y, x) = (part.angle + side).sin_cos();
        let at = if inside {
            let at = x.atan2(k - y);
            if at < from { at + 2.0 * PI } else { at }
        } else {
            let (x, y) = (x * q, 1.0 - y * q);
            (x / x.hypot(y) / q).clamp(-1.0, 1.0).asin()
        };
        Singular { at, aside: from_cut, sharp: true }
    });
    // The end of the range inside is its start.
    let turned = |of: Singular, by: f64| Singular { at: of.at + by * 2.0 * PI, ..of };
    let [one_end, other] = ends;
    let singular = [
        tangent(from),
        tangent(FRAC_PI_2),
        tangent(1.5 * PI),
        one_end,
        other,
        turned(one_end, 1.0),
        turned(other, 1.0),
        turned(one_end, -1.0),
        turned(other, -1.0),
    ];
    let singular = &singular[..if inside { 9 } else { 5 }];
    let plain = [sine, cosine, cut];
    let mut sums = FaceIntegrals::new(like);
    let [zero, one, tiny, ratio, over, sine, cosine, cut] =
        [0.0, 1.0, 1e-300, k, q, sine, cosine, cut].map(number);
    let mut panel = here(
        #[inline(always)]
        |left: f64, right: f64| {
            let (ms, mc) = (0.5 * (left + right)).sin_cos();
            let [ms, mc] = [ms, mc].map(number);
            let end = (0.25 * (right - left)).tan();
            nodes(
                like,
                -end,
                end,
                #[inline(always)]
                |x, weight| {
                    let square = one / (one + x * x);
                    let [turn, ahead] = [(x + x) * square, (one - x * x) * square];
                    let [place_sine, place_cosine] = [ms * ahead + mc * turn, mc * ahead - ms * turn];
                    let step = (weight + weight) * square;
                    // Direction of the slip, distance of the chord, its half, the area of a piece of it, and its start.
                    let (across, along, away, reach, area, start) = if inside {
                        let away = ratio * place_sine;
                        let reach = ((one - away) * (one + away)).max(zero).sqrt();
                        let area = [ratio * place_cosine * step, step];
                        (place_sine, place_cosine, away, reach, area, -ratio * place_cosine)
                    } else {
                        let across = over * place_sine;
                        let along = ((one - across) * (one + across)).sqrt();
                        let reach = place_cosine.abs();
                        let area = [reach * step, over * reach * step / along.max(tiny)];
                        (across, along, place_sine, reach, area, -reach)
                    };
                    let [aside, forward] = [across * cosine - along * sine, along * cosine + across * sine];
                    // p = base + aside r.
                    let base = away * forward - cut;
                    let bend = aside.abs().max(tiny);
                    let zero_at = -base / zero.select_lt(aside, bend, -bend);
                    let low = zero.select_lt(aside, start.max(zero_at), start);
                    let high = zero.select_lt(aside, reach, reach.min(zero_at)).max(low);
                    let low = low.min(high);
                    let (first, second) = (high - low, high + low);
                    let power = [
                        first,
                        first * second * number(0.5),
                        first * (high * high + high * low + low * low) * number(1.0 / 3.0),
                        first * second * (high * high + low * low) * number(0.25),
                    ];
                    // Of 1, r and r^2 over the area, and of the same over the pressure.
                    let plain = [0, 1, 2].map(
                        #[inline(always)]
                        |i| area[0] * power[i] + area[1] * power[i + 1],
                    );
                    let under = [0, 1].map(
                        #[inline(always)]
                        |i| base * plain[i] + aside * plain[i + 1],
                    );
                    let back = one_less(aside, forward);
                    // 1 - along X = short + - aside r, across X = away aside - forward r.
                    let short = one - away * forward;
                    let level = away * aside;
                    let short_of = here(
                        #[inline(always)]
                        |of: [T; 2]| short * of[0] - aside * of[1],
                    );
                    let across_of = here(
                        #[inline(always)]
                        |of: [T; 2]| level * of[0] - forward * of[1],
                    );
                    let by_place = [plain[0], plain[1]];
                    let [shorts, turns] = [short_of(under), across_of(under)];
                    let plain_turns = across_of(by_place);
                    sums.add([
                        under[0],
                        shorts,
                        aside * under[0],
                        back * under[0],
                        back * turns - aside * shorts,
                        plain[0],
                        short_of(by_place),
                        aside * plain[0],
                        back * plain[0],
                        aside * plain_turns,
                        back * plain_turns,
                    ]);
                },
            );
        },
    );
    let presses = |place: f64| {
        let (ps, pc) = place.sin_cos();
        let [across, along, away, reach, start] = if inside {
            let away = k * ps;
            [ps, pc, away, ((1.0 - away) * (1.0 + away)).max(0.0).sqrt(), -k * pc]
        } else {
            let across = q * ps;
            [across, ((1.0 - across) * (1.0 + across)).sqrt(), ps, pc.abs(), -pc.abs()]
        };
        let [aside, forward] = [across * plain[1] - along * plain[0], along * plain[1] + across * plain[0]];
        let base = away * forward - plain[2];
        base + aside * start > 0.0 || base + aside * reach > 0.0
    };
    let mut left = from;
    while left < to {
        let right = panel_end(left, to, singular);
        if right - left <= 1e-15 {
            left = right + 1e-15;
            continue;
        }
        if presses(0.5 * (left + right)) {
            panel(left, right);
        }
        left = right;
    }
    sums
}
