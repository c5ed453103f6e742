//! Drifts of rolling bodies, eight at a time: each lane takes its own steps, until all lanes have come to their ends.
//!
//! The ends within the steps are found side by side, too, by regula falsi (Illinois), and so are the tails of the ways
//! to a face. The lanes give no answer for a drift that takes too many steps, or that ends in two ways within one step.

use super::circular::{CirclePoint, Circular, Numbers};
use super::columns::DriftRow;
use super::ends::End;
use super::rest_lanes::Packed;
use super::rolling::{DriftPlace, LITTLE, LOW, Margins, STEPS, TURN, Tail, begin, error};
use crate::body::Body;
use crate::error::Error;
use crate::number::{LANES, Real};
use crate::rk8;
use crate::state::State;
use core::f64::consts::PI;
use fearless_simd::{Level, Simd, SimdBase, f64x8};

/// Greatest number of steps of eight drifts.
const MOST: usize = 1000;

/// Greatest number of iterations of the search for an end within a step.
const ROOT: usize = 24;

/// The start of a lane, and the conditions under which its drift goes on.
#[derive(Debug, Clone, Copy)]
struct DriftLane {
    start: DriftPlace,
    signs: [f64; 2],
    margins: Margins,
    ball: bool,
}

/// The status of a lane.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Left {
    Running,
    /// The drift ends within the next step, at the margin with this index.
    Ends(usize),
    Flat,
    Open,
}

/// The ends of eight drifts, with their inclinations and times; None where the lanes have no answer.
pub(super) fn stops(
    level: Option<Level>,
    rows: &[DriftRow; LANES],
    round: bool,
    body: impl Fn(&DriftRow) -> Result<Body, Error>,
) -> [Option<(End, f64, f64)>; LANES] {
    let lanes = rows.each_ref().map(|row| lane(row, body(row)));
    if lanes.iter().all(Option::is_none) {
        return [None; LANES];
    }
    let mut rows = *rows;
    let some = lanes.iter().position(Option::is_some).unwrap_or(0);
    for (k, lane) in lanes.iter().enumerate() {
        // A lane without a drift repeats another lane.
        if lane.is_none() {
            rows[k] = rows[some];
        }
    }
    let packed = Packed::bodies(&rows);
    on(level, round, &packed, &lanes)
}

fn on(
    level: Option<Level>,
    round: bool,
    packed: &Packed,
    lanes: &[Option<DriftLane>; LANES],
) -> [Option<(End, f64, f64)>; LANES] {
    crate::number::in_lanes!(
        level,
        simd => run(
            #[inline(always)]
            |x| f64x8::from_slice(simd, &x),
            #[inline(always)]
            |x| *x,
            #[inline(always)]
            |of, y, far| apart(simd, of, y, far),
            #[inline(always)]
            |of, y, far| kept(simd, of, y, far),
            (packed, round),
            lanes,
        ),
        else [None; LANES]
    )
}

/// The rates in a state, in a separate function that is compiled for these lanes: in one piece with the steps the
/// compiler would take many minutes.
#[inline(never)]
fn apart<S: Simd>(
    simd: S,
    of: &Circular<f64x8<S>>,
    y: &Numbers<f64x8<S>>,
    far: f64x8<S>,
) -> CirclePoint<f64x8<S>> {
    simd.vectorize(
        #[inline(always)]
        || of.at(y, far),
    )
}

/// `Circular::kept` in a separate function that is compiled for these lanes.
#[inline(never)]
fn kept<S: Simd>(
    simd: S,
    of: &Circular<f64x8<S>>,
    y: &Numbers<f64x8<S>>,
    far: f64x8<S>,
) -> Numbers<f64x8<S>> {
    simd.vectorize(
        #[inline(always)]
        || of.kept(y, far),
    )
}

/// The start of a lane; None for a row without a drift, for theta below 1e-30, and for a start at the side.
fn lane(row: &DriftRow, body: Result<Body, Error>) -> Option<DriftLane> {
    let body = body.ok()?;
    super::check(&body, &row.losses).ok()?;
    let theta = row.state[0];
    let (of, start) = begin(&body, &State::from(row.state), &row.losses).ok()?;
    let margins = Margins::of(&body, &row.losses, start.y[0]);
    let fits = theta > 1e-30 && margins.side > theta;
    fits.then_some(DriftLane { start, signs: of.signs, margins, ball: body.is_ball() })
}

/// The numbers after a step of all lanes, and the error of the step, which must be below 1.
#[inline(always)]
fn step<T: Real>(
    at: &impl Fn(&Numbers<T>) -> CirclePoint<T>,
    start: &Numbers<T>,
    y: &Numbers<T>,
    rate: &Numbers<T>,
    h: T,
) -> (Numbers<T>, T) {
    let made = rk8::step::<{ rk8::LOOPS }, _, _>(
        #[inline(always)]
        |y: &Numbers<T>, rate: &mut Numbers<T>| *rate = at(y).rates,
        y,
        rate,
        h,
        &mut [*y; rk8::STAGES],
    );
    let off = error(start, y, &made);
    let mut next = *y;
    for i in 0..4 {
        next[i] = y[i] + made.change[i];
    }
    (next, off)
}

#[inline(always)]
fn run<T: Real>(
    load: impl Fn([f64; LANES]) -> T,
    numbers: impl Fn(T) -> [f64; LANES],
    known: impl Fn(&Circular<T>, &Numbers<T>, T) -> CirclePoint<T>,
    kept: impl Fn(&Circular<T>, &Numbers<T>, T) -> Numbers<T>,
    (packed, round): (&Packed, bool),
    lanes: &[Option<DriftLane>; LANES],
) -> [Option<(End, f64, f64)>; LANES] {
    let (shape, losses) = packed.load(|x| load(*x));
    let mut of = Circular::new(&shape, round, losses);
    let some = lanes.iter().flatten().next().copied().expect("at least one");
    let each = lanes.map(|lane| lane.unwrap_or(some));
    of.signs = [0, 1].map(|i| load(each.map(|lane| lane.signs[i])));
    let at = |y: &Numbers<T>, far: T| known(&of, y, far);
    let mut y = [0, 1, 2, 3].map(|i| load(each.map(|lane| lane.start.y[i])));
    let mut far = load(each.map(|lane| lane.start.far));
    let mut start = y;
    let mut rate = at(&y, far).rates;
    let (zero, one) = (load([0.0; LANES]), load([1.0; LANES]));
    let mut h = load([STEPS[0]; LANES]);
    let mut left = lanes.map(|lane| if lane.is_some() { Left::Running } else { Left::Open });
    let dry = [0, 1].map(|i| load(each.map(|l| f64::from(u8::from(!l.margins.dry[i])))));
    let side = load(each.map(|lane| lane.margins.side));
    let last = load(each.map(|lane| lane.margins.last));
    let mut goes = load(left.map(|x| f64::from(u8::from(x == Left::Running))));
    // The margins of running and of drilling count only in lanes with a dry law.
    let margins = |known: &CirclePoint<T>, theta: T, far: T| {
        let [runs, drills] = known.going;
        let half = one.splat(0.5);
        let theta = zero.select_lt(far, theta, one.splat(PI) - theta);
        [
            known.stiffness,
            side - theta,
            half.select_lt(dry[0], one, runs),
            half.select_lt(dry[1], one, drills),
        ]
    };
    for _ in 0..MOST {
        let (next, off) = step(&|y: &Numbers<T>| at(y, far), &start, &y, &rate, h);
        let next = kept(&of, &next, far);
        let known = at(&next, far);
        let margin = margins(&known, next[0], far);
        let worst = margin[0].min(margin[1]).min(margin[2].min(margin[3]));
        // A lane takes its step if the error is small enough and the drift does not end within the step.
        let good = off.select_lt(one, goes, zero);
        let through = worst.select_lt(zero, zero, good);
        let half = one.splat(0.5);
        for i in 0..4 {
            y[i] = half.select_lt(through, next[i], y[i]);
            rate[i] = half.select_lt(through, known.rates[i], rate[i]);
        }
        // Above `TURN` the inclination is counted from the other end of [0, pi].
        let other = one.splat(TURN).select_lt(y[0], one, zero);
        for x in [&mut y[0], &mut start[0]] {
            *x = half.select_lt(other, one.splat(PI) - *x, *x);
        }
        for x in [&mut rate[0], &mut far] {
            *x = half.select_lt(other, -*x, *x);
        }
        let grown = (h * rk8::growth(off)).min(one.splat(STEPS[1]));
        // A step within which the drift ends keeps its length.
        let ends = worst.select_lt(zero, good, zero);
        let kept = half.select_lt(ends, h, grown);
        h = half.select_lt(goes, kept, h);
        let unit = (y[0] * rate[3] / rate[0]).abs();
        let little = unit.select_lt(y[3] * one.splat(LITTLE), goes, zero);
        let little = y[0].select_lt(one.splat(LOW), little, zero);
        let low = y[0].select_lt(last, goes, little);
        let stuck = (h - one.splat(1e-2)).select_lt(zero, one, zero);
        let news = ends.max(low).max(half.select_lt(off, zero, zero)).max(stuck);
        let mut any = false;
        let [news, ends, low, here, thetas] = [news, ends, low, h, y[0]].map(&numbers);
        let margin = margin.map(&numbers);
        for k in 0..LANES {
            if news[k] > 0.5 && left[k] == Left::Running {
                let negative = |i: &usize| margin[*i][k] < 0.0;
                if ends[k] > 0.5 {
                    let mut which = (0..4).filter(negative);
                    left[k] = match (which.next(), which.next()) {
                        (Some(i), None) => Left::Ends(i),
                        _ => Left::Open,
                    };
                } else if low[k] > 0.5 {
                    left[k] = Left::Flat;
                } else if here[k] < 1e-4 || thetas[k] < 1e-5 {
                    left[k] = Left::Open;
                }
            }
            any |= left[k] == Left::Running;
        }
        goes = load(left.map(|x| f64::from(u8::from(x == Left::Running))));
        if !any {
            break;
        }
    }
    // Regula falsi finds the ends within the last step.
    if left.iter().any(|x| matches!(x, Left::Ends(_))) {
        let pick = |margin: [T; 4]| {
            let (margin, mut picked) = (margin.map(&numbers), [1.0; LANES]);
            for (k, number) in picked.iter_mut().enumerate() {
                if let Left::Ends(i) = left[k] {
                    *number = margin[i][k];
                }
            }
            load(picked)
        };
        let here = at(&y, far);
        let (mut a, mut fa) = (zero, pick(margins(&here, y[0], far)));
        let (next, _) = step(&|y: &Numbers<T>| at(y, far), &start, &y, &rate, h);
        let known = at(&next, far);
        let (mut b, mut fb) = (h, pick(margins(&known, next[0], far)));
        let (mut last, half) = (next, one.splat(0.5));
        // A lane that has found its end keeps it while the other lanes still search.
        let mut looks = load(left.map(|x| f64::from(u8::from(matches!(x, Left::Ends(_))))));
        for i in 0..ROOT {
            // Every fourth iteration takes the middle.
            let middle = (a + b) * half;
            let x = if i % 4 == 3 { middle } else { b - fb * ((b - a) / (fb - fa)) };
            let (low, high) = (a.min(b), a.max(b));
            let x = low.select_lt(x, x.select_lt(high, x, middle), middle);
            let (next, _) = step(&|y: &Numbers<T>| at(y, far), &start, &y, &rate, x);
            let known = at(&next, far);
            let f = pick(margins(&known, next[0], far));
            // If f has the sign of fb, the value at the other end is halved.
            let same = (f * fb).select_lt(zero, zero, one);
            let [to, weighed] = [half.select_lt(same, a, b), half.select_lt(same, fa * half, fb)];
            a = half.select_lt(looks, to, a);
            fa = half.select_lt(looks, weighed, fa);
            b = half.select_lt(looks, x, b);
            fb = half.select_lt(looks, f, fb);
            for i in 0..4 {
                last[i] = half.select_lt(looks, next[i], last[i]);
            }
            let near = (b - a).abs() - one.splat(4.0 * f64::EPSILON) * h;
            looks = zero.select_lt(fb.abs().min(near.max(zero)), looks, zero);
            if numbers(looks) == [0.0; LANES] {
                break;
            }
        }
        for i in 0..4 {
            let (mut found, last) = (numbers(y[i]), numbers(last[i]));
            for k in 0..LANES {
                if matches!(left[k], Left::Ends(_)) {
                    found[k] = last[k];
                }
            }
            y[i] = load(found);
        }
    }
    let mut tails = [0.0; LANES];
    if left.contains(&Left::Flat) {
        let (next, _) = step(&|y: &Numbers<T>| at(y, far), &start, &y, &rate, one.splat(0.5));
        let (here, then) = (at(&y, far), at(&next, far));
        let (from, to, ways) = (y.map(&numbers), next.map(&numbers), numbers(far));
        for k in 0..LANES {
            if left[k] == Left::Flat {
                let place = DriftPlace { y: from.map(|x| x[k]), far: ways[k] };
                let pick = |known: &CirclePoint<T>| known.lane(|x| numbers(x)[k]);
                tails[k] =
                    Tail::new(&place, &pick(&here), &each[k].margins, || (to.map(|x| x[k]), pick(&then)))
                        .time();
            }
        }
    }
    let (y, far) = (y.map(&numbers), numbers(far));
    core::array::from_fn(|k| {
        let place = DriftPlace { y: y.map(|x| x[k]), far: far[k] };
        match left[k] {
            Left::Running | Left::Open => None,
            Left::Ends(i) => {
                let end = Margins::ENDS[i];
                let theta = if end == End::Side { each[k].margins.side } else { place.theta() };
                Some((end, theta, place.y[3]))
            }
            Left::Flat => {
                let end = if each[k].ball { End::Upright } else { End::Face };
                Some((end, if far[k] > 0.0 { 0.0 } else { PI }, place.y[3] + tails[k]))
            }
        }
    })
}
