//! Drifts with the centre at rest, in eight SIMD lanes, if they go to the face or to the side without crossing a ridge
//! of the energy.
//!
//! ```text
//! t = D sum W_k p w_k^(p-1) E'/P,   theta_k = theta_e + D w_k^p          sixteen nodes of Gauss, and twelve; 32 and 24
//! ```
//! The exponent p is 1 for a drift to the side. For a drift to the face it is 2 if a single law gives half-integer
//! powers of theta, else 4. There is a result where n and m are not small at the start, E' is not small compared with
//! its terms at any node, and the two rules agree.

use super::columns::DriftRow;
use crate::laws::body::{Shape, beyond};
use crate::laws::loss::{COUNT, Couples, Law, Losses};
use crate::methods::gauss::Rule;
use crate::motions::drift::branch::Branch;
use crate::motions::drift::ends::End;
use crate::numbers::side_by_side::{SideBySide, zero};
use crate::numbers::{LANES, in_lanes, sin_cos};
use core::f64::consts::{FRAC_PI_2, PI};
use fearless_simd::Level;
use std::sync::LazyLock;

/// A node of a rule: w, w^2 and w^4; its weight times 1, 2 w and 4 w^3; and its rule, 0 for the fine one, 1 for the coarse one.
type GaussNode = ([f64; 3], [f64; 3], usize);

/// The nodes of the rules of 16 and 12 nodes, and those of 32 and 24 for drifts on which the first two disagree; each
/// set also has the start as a node without a weight. They are not arrays, because the compiler would unroll a loop
/// over an array of known length.
static NODES: LazyLock<[Vec<GaussNode>; 2]> = LazyLock::new(|| [gauss_rules(16, 12), gauss_rules(32, 24)]);

fn gauss_rules(fine: usize, coarse: usize) -> Vec<GaussNode> {
    let node = |w: f64, weight: f64, rule: usize| {
        let square = w * w;
        ([w, square, square * square], [weight, 2.0 * w * weight, 4.0 * square * w * weight], rule)
    };
    let mut all = vec![node(1.0, 0.0, 1)];
    for (rule, count) in [fine, coarse].into_iter().enumerate() {
        for of in Rule::new(count).nodes {
            all.extend([-of.x, of.x].map(|x| node(0.5 * (1.0 + x), 0.5 * of.weight, rule)));
        }
    }
    all
}

/// Fraction of their terms below which n, m and E' count as small, so that SIMD lanes give no result.
const SMALL_TERM_SHARE: f64 = 0.02;

/// Relative difference up to which the two rules agree; the fine rule then has 4/3 as many digits as the coarse one.
const RULE_DIFFERENCE: f64 = 2e-11;

/// The goal of a drift: its end and inclination, the exponent p, and whether the time to the end is finite.
#[derive(Debug, Clone, Copy)]
struct DriftGoal {
    end: End,
    goal: f64,
    power: f64,
    finite: bool,
}

/// The ends of eight drifts, with their inclinations and times; None for a drift without a result in SIMD lanes.
pub(crate) fn stops<const ROUND: bool>(
    level: Option<Level>,
    rows: &[DriftRow; LANES],
) -> [Option<(End, f64, f64)>; LANES] {
    let tasks = rows.each_ref().map(task);
    if tasks.iter().all(Option::is_none) {
        return [None; LANES];
    }
    let packed = Packed::of(rows, &tasks);
    let mut times = [f64::NAN; LANES];
    for nodes in &*NODES {
        let found = in_lanes!(
            level,
            simd => {
                let mut found = [f64::NAN; LANES];
                self::end_times::<_, ROUND>(zero(simd), &packed, nodes).spill(&mut found);
                found
            },
            else [f64::NAN; LANES]
        );
        for (time, found) in times.iter_mut().zip(found) {
            // Each lane keeps the first time that it finds.
            *time = if *time > 0.0 { *time } else { found };
        }
        if tasks.iter().zip(times).all(|(task, time)| task.is_none() || time > 0.0) {
            break;
        }
    }
    core::array::from_fn(|k| {
        let task = tasks[k]?;
        // The time is NaN where the lanes have no result.
        if times[k].is_nan() || times[k] <= 0.0 {
            return None;
        }
        let time = times[k];
        Some((task.end, task.goal, if task.finite { time } else { f64::INFINITY }))
    })
}

/// The goal of the drift of a row; None if it cannot be computed in SIMD lanes.
fn task(row: &DriftRow) -> Option<DriftGoal> {
    let [ell, i1, i3, _, rho, most] = row.body;
    let theta = row.state[0];
    let most = if most.is_nan() { beyond(ell, rho) } else { most };
    let laws = row.losses.coefficients;
    let fits = (0.0..=1e6).contains(&ell)
        && (1e-12..=1e12).contains(&i1)
        && (1e-12..=1e12).contains(&i3)
        && i3 <= 2.0 * i1
        && (0.0..1.0).contains(&rho)
        && (1e-6..=PI).contains(&most)
        && theta > 1e-30
        && theta <= most.min(FRAC_PI_2)
        && laws.iter().all(|x| (0.0..=1e6).contains(x));
    if !fits || row.losses.is_none() {
        return None;
    }
    let (s, c) = theta.sin_cos();
    let lever = crate::laws::body::Rim { ell, a: 1.0 - rho, rho }.lever((s, c));
    if lever < 0.0 {
        return Some(goal_at_face(&row.losses, ell + rho));
    }
    let side = DriftGoal { end: End::Side, goal: most, power: 1.0, finite: true };
    (most < PI && theta < most).then_some(side)
}

/// The goal of a drift to the face, for a body with ell + rho = `height`.
fn goal_at_face(Losses { coefficients }: &Losses, height: f64) -> DriftGoal {
    let powers = || {
        let some = Law::ALL.iter().copied().filter(|law| coefficients[*law as usize] > 0.0);
        some.map(|law| law.powers().face[usize::from(height > 0.0)])
    };
    let finite = powers().any(|p| p < 1.0);
    let alone = powers().count() == 1 && powers().all(|p| (2.0 * p).fract() == 0.0);
    let power = if alone { 2.0 } else { 4.0 };
    DriftGoal { end: End::Face, goal: 0.0, power, finite }
}

/// Eight rows of bodies and losses as columns.
#[derive(Debug, Clone, Copy)]
struct Packed {
    /// Columns of ell, i1, i3 and fillet.
    shape: [[f64; LANES]; 4],
    laws: [[f64; LANES]; COUNT],
    /// The laws that are present in any of the rows.
    present: [bool; COUNT],
    theta: [f64; LANES],
    goal: [f64; LANES],
    power: [f64; LANES],
    allowed_difference: [f64; LANES],
}

impl Packed {
    fn of(rows: &[DriftRow; LANES], tasks: &[Option<DriftGoal>; LANES]) -> Self {
        let task = |f: &dyn Fn(&DriftGoal) -> f64, other: f64| {
            core::array::from_fn(|k| tasks[k].as_ref().map_or(other, f))
        };
        let laws: [[f64; LANES]; COUNT] =
            core::array::from_fn(|law| rows.each_ref().map(|row| row.losses.coefficients[law]));
        Self {
            shape: [0, 1, 2, 4].map(|i| rows.each_ref().map(|row| row.body[i])),
            laws,
            present: laws.map(|law| law != [0.0; LANES]),
            theta: rows.each_ref().map(|row| row.state[0]),
            goal: task(&|t| t.goal, 0.0),
            power: task(&|t| t.power, 1.0),
            // The time of a drift that never stops is infinite, and the rules need not agree on it.
            allowed_difference: task(&|t| if t.finite { RULE_DIFFERENCE } else { f64::MAX }, 0.0),
        }
    }
}

/// The times to the ends; NaN where SIMD lanes have no result, and any number in lanes without a goal.
#[inline(always)]
fn end_times<T: SideBySide, const ROUND: bool>(like: T, packed: &Packed, nodes: &[GaussNode]) -> T {
    let shape = Shape::of(packed.shape.each_ref().map(|x| like.load(x)));
    let losses = Couples::among(packed.laws.each_ref().map(|x| like.load(x)), packed.present, None);
    let branch = Branch { shape, excess: (shape.i1 - shape.i3) / shape.i3, losses };
    let (theta, goal) = (like.load(&packed.theta), like.load(&packed.goal));
    let (power, allowed_difference) = (like.load(&packed.power), like.load(&packed.allowed_difference));
    let number = |x: f64| theta.splat(x);
    let (zero, one, nan) = (number(0.0), number(1.0), number(f64::NAN));
    let pick = |[linear, square, fourth]: &[f64; 3]| {
        let high = power.select_lt(number(3.0), number(*square), number(*fourth));
        power.select_lt(number(1.5), number(*linear), high)
    };
    let reach = theta - goal;
    // E' is positive where the inclination falls.
    let way = zero.select_lt(reach, one, -one);
    let mut least = one;
    let mut sum = [zero; 2];
    for (w, weight, rule) in nodes {
        let place = branch.angle_in_doubles(sin_cos(pick(w).mac(reach, goal)));
        let local = branch.at::<ROUND>(place);
        sum[*rule] = pick(weight).mac(local.slope / local.power, sum[*rule]);
        let clear = (way * local.slope - number(SMALL_TERM_SHARE) * local.size).select_lt(zero, -one, one);
        least = least.min(clear);
    }
    let angle = sin_cos(theta);
    let start = branch.angle_in_doubles(angle);
    let (lever, more) = (shape.rim.slope(angle), start.m - start.n);
    let small = number(SMALL_TERM_SHARE);
    let same = start.n * start.m;
    for rest in [same, start.n.abs() - small * lever, start.m.abs() - small * (start.n.abs() + more.abs())] {
        least = least.min(zero.select_lt(rest, one, -one));
    }
    let off = (sum[0] - sum[1]).abs() - allowed_difference * sum[0].abs();
    off.select_lt(zero, zero.select_lt(least, (reach * sum[0]).abs(), nan), nan)
}
