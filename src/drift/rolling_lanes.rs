//! Drifts of rolling bodies, eight at a time: each lane takes its own steps, until all lanes have come to their ends.
//!
//! The ends within the steps are found side by side, too, and so are the tails of the ways to a face. The lanes give no
//! answer for a drift that takes too many steps, or that ends in two ways within one step.

use super::circular::{CirclePoint, Circular, Numbers};
use super::columns::DriftRow;
use super::ends::End;
use super::rest_lanes::Packed;
use super::rolling::{DriftPlace, LITTLE, LOW, Margins, STEPS, TURN, Tail, begin, error};
use crate::number::side_by_side::{SideBySide, apart, zero};
use crate::number::{LANES, here, in_lanes};
use crate::rk8;
use crate::search::crossings;
use crate::state::State;
use core::f64::consts::PI;
use fearless_simd::Level;

/// Greatest number of steps of eight drifts.
const MOST: usize = 1000;

/// Greatest number of iterations of the search for an end within a step.
const ROOT: usize = 24;

/// The start of a lane, and the conditions under which its drift goes on.
#[derive(Debug, Clone, Copy)]
struct DriftLane {
    start: DriftPlace<f64>,
    signs: [f64; 2],
    margins: Margins<f64>,
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
) -> [Option<(End, f64, f64)>; LANES] {
    let lanes = rows.each_ref().map(lane);
    let Some(first) = lanes.iter().position(Option::is_some) else { return [None; LANES] };
    // A lane without a drift repeats another lane.
    let from = |k: usize| if lanes[k].is_some() { k } else { first };
    let each: [_; LANES] = core::array::from_fn(|k| lanes[from(k)].expect("a lane with a drift"));
    let packed = Packed::bodies(&core::array::from_fn(|k| rows[from(k)]));
    let left = lanes.map(|lane| if lane.is_some() { Left::Running } else { Left::Open });
    in_lanes!(level, simd => RollLanes::of(zero(simd), &packed, round, &each, left).run(), else [None; LANES])
}

/// The start of a lane; None for a row without a drift, for theta below 1e-30, and for a start at the side.
fn lane(row: &DriftRow) -> Option<DriftLane> {
    let body = row.body().ok()?;
    super::check(&body, &row.losses).ok()?;
    let theta = row.state[0];
    let (of, start) = begin(&body, &State::from(row.state), &row.losses).ok()?;
    let margins = Margins::of(&body, &row.losses, start.y[0]);
    let fits = theta > 1e-30 && margins.side > theta;
    fits.then_some(DriftLane { start, signs: of.signs, margins, ball: body.is_ball() })
}

/// Eight drifts on their way.
struct RollLanes<'a, T> {
    like: T,
    of: Circular<T>,
    each: &'a [DriftLane; LANES],
    margins: Margins<T>,
    start: Numbers<T>,
    here: DriftPlace<T>,
    rate: Numbers<T>,
    h: T,
    left: [Left; LANES],
}

#[inline(always)]
fn spilled<T: SideBySide>(x: T) -> [f64; LANES] {
    let mut lanes = [0.0; LANES];
    x.spill(&mut lanes);
    lanes
}

impl<'a, T: SideBySide> RollLanes<'a, T> {
    #[inline(always)]
    fn of(like: T, packed: &Packed, round: bool, each: &'a [DriftLane; LANES], left: [Left; LANES]) -> Self {
        let (shape, losses) = packed.load(like);
        let load = |f: &dyn Fn(&DriftLane) -> f64| like.load(&each.each_ref().map(f));
        let mut of = Circular::new(&shape, round, losses);
        of.signs = [0, 1].map(|i| load(&|lane| lane.signs[i]));
        let margins = Margins {
            side: load(&|lane| lane.margins.side),
            dry: [0, 1].map(|i| load(&|lane| lane.margins.dry[i])),
            slow: load(&|lane| lane.margins.slow),
            last: load(&|lane| lane.margins.last),
        };
        let start = [0, 1, 2, 3].map(|i| load(&|lane| lane.start.y[i]));
        let here = DriftPlace { y: start, far: load(&|lane| lane.start.far) };
        let mut all =
            Self { like, of, each, margins, start, here, rate: start, h: like.splat(STEPS[0]), left };
        all.rate = all.at(&all.here.y).rates;
        all
    }

    /// The rates in a state, in a separate function that is compiled for these lanes: in one piece with the steps the
    /// compiler would take many minutes.
    #[inline(always)]
    fn at(&self, y: &Numbers<T>) -> CirclePoint<T> {
        let (of, far) = (&self.of, self.here.far);
        apart(
            self.like,
            #[inline(always)]
            || of.at(y, far),
        )
    }

    /// The margins in a state with these rates.
    #[inline(always)]
    fn margins(&self, known: &CirclePoint<T>, y: &Numbers<T>) -> [T; 4] {
        self.margins.all(known, DriftPlace { y: *y, far: self.here.far }.theta())
    }

    /// The numbers after a step of all lanes, and the error of the step, which must be below 1.
    #[inline(always)]
    fn step(&self, h: T) -> (Numbers<T>, T) {
        let y = &self.here.y;
        let made = rk8::step::<{ rk8::LOOPS }, _, _>(
            #[inline(always)]
            |y: &Numbers<T>, rate: &mut Numbers<T>| *rate = self.at(y).rates,
            y,
            &self.rate,
            h,
            &mut [*y; rk8::STAGES],
        );
        let off = error(&self.start, y, &made);
        let mut next = *y;
        for i in 0..4 {
            next[i] = y[i] + made.change[i];
        }
        (next, off)
    }

    /// 1 in the lanes with such a status, else 0.
    #[inline(always)]
    fn mask(&self, which: impl Fn(Left) -> bool) -> T {
        self.like.load(&self.left.map(|left| f64::from(u8::from(which(left)))))
    }

    #[inline(always)]
    fn run(mut self) -> [Option<(End, f64, f64)>; LANES] {
        for _ in 0..MOST {
            self.advance();
            if !self.left.contains(&Left::Running) {
                break;
            }
        }
        if self.left.iter().any(|x| matches!(x, Left::Ends(_))) {
            self.finish();
        }
        self.ends()
    }

    /// Takes a step in each lane whose step is good enough, and notes the lanes that come to an end.
    #[inline(always)]
    fn advance(&mut self) {
        let goes = self.mask(|left| left == Left::Running);
        let (zero, one, half) = (goes.splat(0.0), goes.splat(1.0), goes.splat(0.5));
        let (next, off) = self.step(self.h);
        let (of, far) = (&self.of, self.here.far);
        let next = apart(
            self.like,
            #[inline(always)]
            || of.kept(&next, far),
        );
        let known = self.at(&next);
        let margin = self.margins(&known, &next);
        let worst = margin[0].min(margin[1]).min(margin[2].min(margin[3]));
        // A lane takes its step if the error is small enough and the drift does not end within the step.
        let good = off.select_lt(one, goes, zero);
        let through = worst.select_lt(zero, zero, good);
        let Self { here: DriftPlace { y, far }, rate, start, .. } = self;
        for i in 0..4 {
            y[i] = half.select_lt(through, next[i], y[i]);
            rate[i] = half.select_lt(through, known.rates[i], rate[i]);
        }
        // Above `TURN` the inclination is counted from the other end of [0, pi].
        let other = one.splat(TURN).select_lt(y[0], one, zero);
        for x in [&mut y[0], &mut start[0]] {
            *x = half.select_lt(other, one.splat(PI) - *x, *x);
        }
        for x in [&mut rate[0], far] {
            *x = half.select_lt(other, -*x, *x);
        }
        let grown = (self.h * rk8::growth(off)).min(one.splat(STEPS[1]));
        // A step within which the drift ends keeps its length.
        let ends = worst.select_lt(zero, good, zero);
        let kept = half.select_lt(ends, self.h, grown);
        self.h = half.select_lt(goes, kept, self.h);
        let unit = (y[0] * rate[3] / rate[0]).abs();
        let little = unit.select_lt(y[3] * one.splat(LITTLE), goes, zero);
        let little = y[0].select_lt(one.splat(LOW), little, zero);
        let low = y[0].select_lt(self.margins.last, goes, little);
        let stuck = (self.h - one.splat(1e-2)).select_lt(zero, one, zero);
        let news = ends.max(low).max(half.select_lt(off, zero, zero)).max(stuck);
        let [news, ends, low] = [spilled(news), spilled(ends), spilled(low)];
        let (here, thetas) = (spilled(self.h), spilled(y[0]));
        let margin = [0, 1, 2, 3].map(|i| spilled(margin[i]));
        for k in 0..LANES {
            if news[k] <= 0.5 || self.left[k] != Left::Running {
                continue;
            }
            if ends[k] > 0.5 {
                let mut which = (0..4).filter(|i| margin[*i][k] < 0.0);
                self.left[k] = match (which.next(), which.next()) {
                    (Some(i), None) => Left::Ends(i),
                    _ => Left::Open,
                };
            } else if low[k] > 0.5 {
                self.left[k] = Left::Flat;
            } else if here[k] < 1e-4 || thetas[k] < 1e-5 {
                self.left[k] = Left::Open;
            }
        }
    }

    /// Ends the drifts of lanes within their next steps, where their margins vanish.
    #[inline(always)]
    fn finish(&mut self) {
        let ending = self.mask(|left| matches!(left, Left::Ends(_)));
        let zero = ending.splat(0.0);
        let margin = here(
            #[inline(always)]
            |y: &Numbers<T>| {
                let margins = self.margins(&self.at(y), y);
                let mut picked = [1.0; LANES];
                for (k, number) in picked.iter_mut().enumerate() {
                    if let Left::Ends(i) = self.left[k] {
                        *number = margins[i].lane(k);
                    }
                }
                self.like.load(&picked)
            },
        );
        let on = here(
            #[inline(always)]
            |h: T| margin(&self.step(h).0),
        );
        let values = [margin(&self.here.y), on(self.h)];
        let near = zero.splat(4.0 * f64::EPSILON) * self.h;
        let (last, _) = self.step(crossings(on, [zero, self.h], values, ending, near, ROOT));
        for (y, last) in self.here.y.iter_mut().zip(last) {
            *y = zero.select_lt(ending, last, *y);
        }
    }

    /// The ends of all lanes, with the tails of those that come near a face.
    #[inline(always)]
    fn ends(&self) -> [Option<(End, f64, f64)>; LANES] {
        let lane = |y: &Numbers<T>, k: usize| y.map(|x| x.lane(k));
        let later = self.left.contains(&Left::Flat).then(
            #[inline(always)]
            || {
                let (next, _) = self.step(self.like.splat(0.5));
                (self.at(&self.here.y), next, self.at(&next))
            },
        );
        core::array::from_fn(|k| {
            let place = DriftPlace { y: lane(&self.here.y, k), far: self.here.far.lane(k) };
            let DriftLane { margins, ball, .. } = &self.each[k];
            match self.left[k] {
                Left::Running | Left::Open => None,
                Left::Ends(i) => {
                    let end = Margins::ENDS[i];
                    let theta = if end == End::Side { margins.side } else { place.theta() };
                    Some((end, theta, place.y[3]))
                }
                Left::Flat => {
                    let (known, next, then) = later.as_ref()?;
                    let pick = |known: &CirclePoint<T>| known.lane(|x| x.lane(k));
                    let tail = Tail::new(&place, &pick(known), margins, || (lane(next, k), pick(then)));
                    let end = if *ball { End::Upright } else { End::Face };
                    Some((end, if place.far > 0.0 { 0.0 } else { PI }, place.y[3] + tail.time()))
                }
            }
        })
    }
}
