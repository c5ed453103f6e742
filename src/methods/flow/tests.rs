//! Ends at every place of a step, with a flow in which only time changes.

use super::ends::only_zero;
use super::*;
use std::cell::Cell;

thread_local! {
    /// Number of evaluations of rates so far.
    static EVALUATED: Cell<u64> = const { Cell::new(0) };
}

/// A flow with steps of 1, in which time changes, and the first number as sigma; its first margin is a polynomial of time
/// with these zeros. An uneven clock goes this many times faster halfway through its first step.
#[derive(Clone, Copy)]
struct Clock {
    zeros: [f64; 3],
    count: usize,
    uneven: f64,
}

impl Clock {
    fn of(all: &[f64]) -> Self {
        let mut zeros = [0.0; 3];
        zeros[..all.len()].copy_from_slice(all);
        Self { zeros, count: all.len(), uneven: 0.0 }
    }

    fn face(&self, t: Dual<f64>) -> Dual<f64> {
        let one = Dual { value: 1.0, slope: 0.0 };
        self.zeros[..self.count].iter().fold(one, |all, zero| all * (Dual { value: *zero, slope: 0.0 } - t))
    }
}

/// The number of margins of a clock, and the index of its time.
const MARGINS: usize = 6;
const TIME: usize = 7;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Rings {
    Time,
    Pause,
    Face,
}

impl Flow<MARGINS> for Clock {
    type Halt = Rings;
    const TIME: usize = TIME;
    const OVER: Rings = Rings::Time;
    const PAUSE: Rings = Rings::Pause;
    fn theta<const N: usize>(&self, _: &[f64; N]) -> f64 {
        0.0
    }
    fn write_rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) {
        EVALUATED.set(EVALUATED.get() + 1);
        *all = [0.0; N];
        let past = self.uneven * (y[0] - 0.5);
        (all[0], all[TIME]) = (1.0, self.uneven.max(1.0) / (1.0 + past * past));
    }
    fn margins<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; MARGINS] {
        let mut all = [Dual { value: 1.0, slope: 0.0 }; MARGINS];
        all[0] = self.face(Dual { value: place.y[TIME], slope: 1.0 });
        all
    }
    fn margin<const N: usize>(&self, y: &[f64; N], _: usize) -> f64 {
        self.face(Dual { value: y[TIME], slope: 1.0 }).value
    }
    fn end(&self, _: usize) -> Rings {
        Rings::Face
    }
    fn error<const N: usize>(&self, _: &[f64; N], _: &rk8::Step<f64, N>) -> f64 {
        0.0
    }
    fn fastest<const N: usize>(&self, _: &[f64; N]) -> f64 {
        1.0
    }
    fn first<const N: usize>(&self, _: &[f64; N]) -> f64 {
        1.0
    }
    fn calm<const N: usize>(&self, _: &[f64; N]) -> f64 {
        1.0
    }
    fn longest<const N: usize>(&self, _: &FlowPlace<N>) -> f64 {
        1.0
    }
    fn stopped<const N: usize>(&self, _: &FlowPlace<N>) -> Option<(Rings, [f64; N])> {
        None
    }
}

/// The halt of a clock that runs up to `last`, the time of that halt, and how many of three outputs the clock writes.
fn ended(zeros: &[f64], last: f64) -> (Rings, f64, usize) {
    let (clock, mut written) = (Clock::of(zeros), 0);
    let steps = Steps { first: None, most: u64::MAX, patience: PATIENCE, toil: TOIL, tired: false };
    let times = [0.0, 0.5 * last, last];
    let mut write = |_: &[f64; 9]| written += 1;
    let flown = clock.run(clock.place([0.0; 9]), steps, &times, &mut write, &mut || true);
    assert_eq!(flown.spent.exhausted, None, "a clock ends");
    (flown.halt, flown.y[TIME], written)
}

#[test]
fn an_end_is_found_in_every_place_of_a_step() {
    // The zeros lie after the start of a step, within the step, before its end, and at its end.
    for x in [1e-300, 1e-15, 1e-9, 0.1, 0.25, 0.5, 0.9, 1.0 - 1e-9, 1.0] {
        for step in [0.0, 3.0] {
            let zero = step + x;
            let (halt, t, written) = ended(&[zero], 7.0);
            assert_eq!((halt, written), (Rings::Face, if zero < 3.5 { 1 } else { 2 }), "{zero}");
            assert!((t - zero).abs() <= 1e-15 * zero.max(1.0), "{zero}: {t}");
        }
    }
}

#[test]
fn an_end_at_the_last_time_is_met_and_one_after_it_is_not() {
    for zero in [0.3, 3.7, 4.0] {
        assert_eq!(ended(&[zero], zero * (1.0 + 1e-12)).0, Rings::Face, "{zero}, a little later");
        assert_eq!(ended(&[zero], zero).0, Rings::Face, "{zero}, then");
        let (halt, t, written) = ended(&[zero], zero * (1.0 - 1e-12));
        assert_eq!((halt, t, written), (Rings::Time, zero * (1.0 - 1e-12), 3), "{zero}, a little earlier");
    }
}

#[test]
fn of_two_or_three_zeros_within_a_step_the_first_is_found() {
    for (a, b) in [(0.1, 0.9), (0.4, 0.6), (0.05, 0.051), (0.95, 0.96), (0.5, 0.5 + 1e-6)] {
        for step in [0.0, 2.0] {
            let (halt, t, _) = ended(&[step + a, step + b], 9.0);
            assert_eq!(halt, Rings::Face, "{a} {b}");
            assert!((t - step - a).abs() < 1e-9, "{a} {b}: {t}");
        }
    }
    let (_, t, _) = ended(&[2.1, 2.4, 2.8], 9.0);
    assert!((t - 2.1).abs() < 1e-14, "{t}");
    // A margin without a zero does not end a flow.
    assert_eq!(ended(&[], 9.0).0, Rings::Time);
}

#[test]
fn a_flow_that_is_exhausted_ends_where_it_is_and_says_why() {
    let clock = Clock::of(&[]);
    let patient = Steps { first: Some(1e-9), most: u64::MAX, patience: 30, toil: TOIL, tired: false };
    let run = |steps: Steps, asked: bool| {
        let flown = clock.run(clock.place([0.0; 9]), steps, &[1000.0], &mut |_: &[f64; 9]| (), &mut || asked);
        (flown.spent.exhausted, flown.y[TIME])
    };
    assert_eq!(run(patient, true), (None, 1000.0));
    let (crawls, at) = run(Steps { patience: 3, ..patient }, true);
    assert!(crawls == Some(Exhausted::Crawling) && at < 1e-3, "{crawls:?} {at}");
    let (tires, at) = run(Steps { toil: 1000, ..patient }, true);
    assert!(tires == Some(Exhausted::Evaluations) && at > 10.0 && at < 1000.0, "{tires:?} {at}");
    let (stops, at) = run(patient, false);
    assert!(stops == Some(Exhausted::Interrupted) && at > 10.0 && at < 1000.0, "{stops:?} {at}");
    let whole = |steps: Steps, asked: bool| {
        clock.run_whole(clock.place([0.0; 9]), steps, &[1000.0], &mut |_: &[f64; 9]| (), &mut || asked)
    };
    assert!(matches!(whole(Steps { patience: 3, ..patient }, true), Err(Error::Endless { .. })));
    assert!(matches!(whole(patient, false), Ok(None)) && matches!(whole(patient, true), Ok(Some(_))));
}

#[test]
fn an_output_is_at_its_time_also_where_newtons_iteration_runs_to_and_fro() {
    let clock = Clock { uneven: 50.0, ..Clock::of(&[]) };
    let steps = Steps { first: Some(1.0), most: 1, patience: PATIENCE, toil: TOIL, tired: false };
    let from = clock.place([0.0; 9]);
    let whole = clock.run(from, steps, &[9.0], &mut |_: &[f64; 9]| (), &mut || true).y[TIME];
    for i in 1..100 {
        let t = 0.01 * f64::from(i) * whole;
        let mut found = 0.0;
        clock.run(from, steps, &[t, 9.0], &mut |y: &[f64; 9]| found = y[0], &mut || true);
        let there = clock.part(&from, found)[TIME];
        // The rate is not the slope of so coarse a step, along which the last 1e-9 of it are a straight line.
        assert!((there - t).abs() < 1e-7, "{t}: {there}");
    }
}

#[test]
fn a_long_step_far_from_an_end_costs_no_more_than_the_step() {
    // Each step is as long as the motion allows, and the margin of the second clock falls and rises far from zero.
    for zeros in [&[][..], &[30.0, 31.0]] {
        let before = EVALUATED.get();
        assert_eq!(ended(zeros, 9.0).0, Rings::Time);
        let each = (EVALUATED.get() - before) as f64 / 9.0;
        assert!(each < 25.0, "{each} evaluations a step");
    }
}

#[test]
fn the_zero_of_a_margin_that_falls_takes_three_looks() {
    for zero in [1e-12, 0.02, 0.3, 0.77, 1.0 - 1e-12] {
        let looks = Cell::new(0);
        let on = |x: f64| {
            looks.set(looks.get() + 1);
            let (value, slope) = ((0.5 * (zero - x)).sin(), -0.5 * (0.5 * (zero - x)).cos());
            Dual { value, slope }
        };
        let [begin, end] = [on(0.0), on(1.0)];
        looks.set(0);
        let found = only_zero(&mut { on }, [begin.value, begin.slope, end.value, end.slope]).expect("a zero");
        assert!((found - zero).abs() < 1e-16 + 1e-15 * zero && looks.get() <= 3, "{zero}: {found}");
    }
    // With a wrong slope the iteration leaves the step.
    let wrong = |x: f64| Dual { value: 0.4 - x, slope: 0.1 };
    assert_eq!(only_zero(&mut { wrong }, [0.5, -1.5, -0.5, -1.5]), None);
}

/// A clock in a SIMD lane, whose margin (a - t) (b - t) + up is a parabola of time.
#[cfg(feature = "many")]
#[derive(Clone, Copy)]
struct LaneClock<T>([T; 3]);

#[cfg(feature = "many")]
impl<T: crate::numbers::side_by_side::SideBySide> lanes::Flows<T, 2, 1> for LaneClock<T> {
    type Seen = ();
    fn of(numbers: &[T; lanes::NUMBERS], _: &Self) -> Self {
        Self([numbers[0], numbers[1], numbers[2]])
    }
    fn rates(&self, y: &[T; 2], rate: &mut [T; 2]) {
        *rate = y.map(|y| y.splat(1.0));
    }
    fn margins(&self, y: &[T; 2], (): &()) -> [T; 1] {
        let Self([a, b, up]) = *self;
        [(a - y[1]) * (b - y[1]) + up]
    }
    fn error(&self, tol: T, _: &[T; 2], _: &rk8::Step<T, 2>) -> T {
        tol.splat(0.0)
    }
    fn fastest(&self, y: &[T; 2]) -> T {
        y[0].splat(1.0)
    }
    fn calm(&self, y: &[T; 2]) -> T {
        y[0].splat(1.0)
    }
    fn longest(&self, y: &[T; 2], _: &[T; 2]) -> T {
        y[0].splat(1.0)
    }
}

/// The time at which a lane with steps of 1 leaves such a clock, and its status then.
#[cfg(feature = "many")]
fn left(zeros: [f64; 2], up: f64) -> (f64, lanes::LaneStatus) {
    let mut numbers = [0.0; lanes::NUMBERS];
    numbers[..3].copy_from_slice(&[zeros[0], zeros[1], up]);
    let entry =
        lanes::Entry { y: [0.0; 2], step: 1.0, numbers, tol: 1.0, until: 9.5, patience: 100, made: 0 };
    let mut set = lanes::Set::new(0.0, LaneClock([0.0; 3]), &entry);
    while set.status(0) == lanes::LaneStatus::Runs {
        set.take_steps(0.0, 64);
    }
    (set.place(0).0[1], set.status(0))
}

#[cfg(feature = "many")]
#[test]
fn a_lane_never_steps_over_an_end() {
    use lanes::LaneStatus::{NeedsSingle, TimeReached};
    for hundredth in 1..=400 {
        let first = f64::from(hundredth) * 0.01;
        for wide in [0.0, 1e-9, 1e-6, 1e-3, 0.02, 0.1, 0.3] {
            let (t, status) = left([first, first + wide], -1e-12);
            assert!(status == NeedsSingle && t <= first, "{first}, {wide}: {t}, {status:?}");
        }
        // A margin whose minimum is well above zero stops no lane.
        let (t, status) = left([first, first], 0.3);
        assert!(status == TimeReached && (t - 9.0).abs() < 1e-12, "{first}: {t}, {status:?}");
    }
}
