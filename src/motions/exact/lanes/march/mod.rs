//! Follows motions in SIMD lanes panel by panel (a panel is a range of one power series): the first event in a panel,
//! with its place and time.
//!
//! ```text
//! eta = d y,  d = +-1 points the way the motion goes        F(eta) = J theta'^2,   X(eta) > 0 while the body presses
//! turn   F = 0          lift-off   X = 0          slip   Z = 0          side   eta = d y_side          edge   eta = 0.32 or less
//! F = (eta - low)(high - eta) W,   eta = mid - amp cos phi,   dt = (2 s0/Q) sqrt(J/W) dphi
//! ```
//! The head of [`lanes`](super) defines y and its series. The module [`press`] has X and Z, which are power series like
//! F, so that their zeros need no square root and no angular velocity. The module [`signs`] finds the first zero of a
//! series and tells whether one may have been missed; [`clock`] computes the time. A motion that ends is marched panel
//! by panel to its end; a motion that does not end is marched to both its turning points, which determine it for all
//! times.
//!
//! Error: the sum of the quadrature error of the clock, the truncation of the series, and the rounding errors of F
//! and of the series that vanishes. An event that is not certain gets the code `Unknown`.

mod clock;
mod extent;
mod judge;
mod press;
mod signs;

use super::series::{lane_lines, square_of_rate, truncation_bound};
use crate::laws::contact::FLAT;
use crate::laws::contact::reduced::Reduced;
pub(crate) use crate::methods::gauss::Rule;
use crate::numbers::{Lane, Real, here};
use clock::PanelClock;
pub(crate) use extent::Extent;
use signs::{EtaSeries, FirstZero};

/// Number of parts into which a panel is divided in the search for events. `MORE` is that for turning points, which
/// are also sought a little beyond the reach of the panel.
const PARTS: usize = 8;
const MORE: usize = 10;
/// Width of a part of a panel in eta; the error of the cubics in `signs` grows as its fourth power.
const WIDTH: f64 = 0.04;
const REACH: f64 = WIDTH * PARTS as f64;
/// Greatest error of Newton's method with which a turning point counts as an event and is divided out of F = J
/// theta'^2.
const TURNING_POINT_ERROR: f64 = 1e-13;

/// The start of a panel: the inclination, its sine and cosine, w1, w3 and F = J theta'^2, and the accumulated error
/// of F.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Knot<T> {
    pub theta: T,
    pub sin: T,
    pub cos: T,
    pub w1: T,
    pub w3: T,
    pub force: T,
    pub doubt: T,
}

/// The outputs that each panel computes, the same in all SIMD lanes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sought {
    /// Whether the end of the motion is sought; otherwise the state at a given time is sought.
    pub ends: bool,
    /// Whether slip counts as an end.
    pub slips: bool,
    /// Whether the precession along the panel is computed.
    pub turns: bool,
}

/// The first event in a panel; [`Met::code`] is its number in each SIMD lane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PanelEvent {
    /// The edge of the panel, before any other event.
    Edge,
    Turn,
    Side,
    LiftOff,
    Slip,
    /// The motion reaches the requested time.
    Time,
    /// The landing of the face: a body that does not spin falls flat.
    Face,
    /// The first event could not be determined.
    Unknown,
}

impl PanelEvent {
    const ALL: [Self; 7] =
        [Self::Edge, Self::Turn, Self::Side, Self::LiftOff, Self::Slip, Self::Time, Self::Face];

    /// The number of the event, which is its index in `ALL`.
    #[inline(always)]
    const fn code(self) -> f64 {
        self as u8 as f64
    }

    pub fn of(code: f64) -> Self {
        Self::ALL.get(code as usize).copied().unwrap_or(Self::Unknown)
    }
}

/// The first event in a panel, and the state at the event.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Met<T> {
    /// The number of the event, [`PanelEvent::code`]; 9 where it is unknown.
    pub code: T,
    /// The time from the start of the panel to the event.
    pub time: T,
    /// The error of `time`; the next field is the error of the state at the event.
    pub late: T,
    pub off: T,
    /// Bound of the time derivative of the state at the event.
    pub rate: T,
    /// The size |theta'| at the event.
    pub tilt: T,
    /// The angle by which phi has turned since the start of the panel, if requested, and its error.
    pub turn: [T; 2],
    pub knot: Knot<T>,
}

/// The data of a motion that are the same for all panels.
pub(crate) struct March<T> {
    pub law: Reduced<T>,
    /// Sine and cosine of the inclination at which something other than the rim lands.
    pub side: [T; 2],
    /// The square of the coefficient of friction.
    pub mu_square: T,
}

/// The power series of a panel: those of w1 and w3 in y, all others in eta.
struct PanelSeries<T, const N: usize> {
    w1: [T; N],
    w3: [T; N],
    force: [T; N],
    press: [T; N],
    grip: [T; N],
    /// The greatest eta at which the series are exact to rounding.
    edge: T,
}

/// The turning points of a panel, or its edges in their place: the places, 1 where a place is a turning point, and
/// the search results.
struct TurningPlaces<T> {
    low: T,
    high: T,
    is_low: T,
    is_high: T,
    seen: [FirstZero<T>; 2],
}

/// The first event of a panel while it is computed: its code, its place `out` in eta, and its time.
struct EventInProgress<T> {
    code: T,
    out: T,
    /// The distances of the place from the turning points, or from the edges in their place.
    apart: [T; 2],
    /// The error of the zero from Newton's method; the next field is the slope of the series at the zero.
    miss: T,
    steep: T,
    time: T,
    late: T,
    weakest: T,
}

impl<T: Lane> March<T> {
    /// Computes the panel that begins at a knot, with N terms; `way` is the direction d = +-1 of the motion, `target`
    /// the requested time.
    #[inline(always)]
    pub fn panel<const N: usize>(
        &self,
        rule: &Rule,
        knot: &Knot<T>,
        way: T,
        target: T,
        sought: Sought,
    ) -> Met<T> {
        let zero = way.splat(0.0);
        let angle = (knot.sin, knot.cos);
        let of = self.terms::<N>(knot, way, sought);
        let ends = turns_of_force(&of.force);
        let FirstEvent { code, at, miss, steep } = self.first(knot, way, sought, &of, &ends);
        let clock = PanelClock::of(
            &self.law,
            angle,
            way,
            &of.force,
            [ends.low, ends.high],
            [ends.is_low, ends.is_high],
        );
        let start = clock.phase(zero);
        let stop = where_event_is(code, PanelEvent::Turn, way.splat(core::f64::consts::PI), clock.phase(at));
        let (time, late, weakest) = clock.between(rule, start, stop);
        let mut reached =
            EventInProgress { code, out: at, apart: clock.distances(at), miss, steep, time, late, weakest };
        if !sought.ends {
            reached.at_time(rule, &clock, [start, stop], target);
        }
        let turn = if sought.turns {
            let (clock, w1) = (&clock, &of.w1);
            zero.aside(
                #[inline(always)]
                move || clock.precession(rule, [start, stop], w1),
            )
        } else {
            [zero; 2]
        };
        let there = self.state_reached(knot, way, &of, &clock, &reached);
        self.judged(knot, &of, &ends, &reached, &there, turn)
    }

    /// The power series about a knot; those of the forces only if the end of the motion is sought.
    #[inline(always)]
    fn terms<const N: usize>(&self, knot: &Knot<T>, way: T, sought: Sought) -> PanelSeries<T, N> {
        let zero = way.splat(0.0);
        let (law, s, c) = (&self.law, knot.sin, knot.cos);
        let (mut w1, mut w3, mut force) = ([knot.w1; N], [knot.w3; N], [knot.force; N]);
        lane_lines::<_, N>(law, s, c, &mut w1, &mut w3);
        square_of_rate::<_, N>(law, s, c, &w1, &w3, &mut force);
        let (mut press, mut grip) = ([zero; N], [zero; N]);
        if sought.ends {
            press::normal(law, (s, c), &force, &mut press);
            if sought.slips {
                let (parts, limit, grip) = ([&w1, &w3, &force, &press], self.mu_square, &mut grip);
                zero.aside(
                    #[inline(always)]
                    move || press::grip(law, (s, c), parts, limit, grip),
                );
            }
        }
        let edge = self.edge(knot, [&w1, &w3, &force]);
        for k in (1..N).step_by(2) {
            force[k] = force[k] * way;
            press[k] = press[k] * way;
            grip[k] = grip[k] * way;
        }
        PanelSeries { w1, w3, force, press, grip, edge }
    }

    /// The reach of a panel, within which the series are exact to rounding.
    ///
    /// On a rounded rim a zero of D may lie within the unit circle, where the terms of the series fall more slowly.
    #[inline(always)]
    fn edge<const N: usize>(&self, knot: &Knot<T>, [w1, w3, force]: [&[T; N]; 3]) -> T {
        let number = here(
            #[inline(always)]
            |x: f64| knot.sin.splat(x),
        );
        let mut edge = number(REACH);
        if !self.law.round {
            return edge;
        }
        let turning = number(8.0) * (number(1.0) + knot.w1.abs() + knot.w3.abs());
        let balanced = number(12.0) * self.size_of_terms(knot, [knot.w1.abs(), knot.w3.abs()]);
        for part in [0.75, 0.5, 0.25] {
            let left = |series: &[T; N]| truncation_bound(series, edge);
            let fits = left(w1).max(left(w3)) / turning;
            let fits = fits.max(left(force) / balanced);
            edge = number(f64::EPSILON).select_lt(fits, number(part * REACH), edge);
        }
        edge
    }

    /// The size of the terms of which F is the sum, for the given |w1| and |w3|.
    #[inline(always)]
    fn size_of_terms(&self, knot: &Knot<T>, [w1, w3]: [T; 2]) -> T {
        let of = self.law.at((knot.sin, knot.cos));
        let two = w1.splat(2.0);
        of.al * w1 * w1
            + of.b * w3 * w3
            + two * of.k.abs() * w1 * w3
            + two * (self.law.shape.rim.ell.abs() + w1.splat(1.0))
            + knot.force
    }

    /// The first event in a panel and its place.
    #[inline(always)]
    fn first<const N: usize>(
        &self,
        knot: &Knot<T>,
        way: T,
        sought: Sought,
        of: &PanelSeries<T, N>,
        ends: &TurningPlaces<T>,
    ) -> FirstEvent<T> {
        let number = here(
            #[inline(always)]
            |x: f64| way.splat(x),
        );
        let (zero, one, half, never) = (number(0.0), number(1.0), number(0.5), number(9.0));
        let (s, c) = (knot.sin, knot.cos);
        let [sin_side, cos_side] = self.side;
        let side = way * (sin_side * c - cos_side * s) / (sin_side + s);
        let mut next =
            FirstEvent { code: number(PanelEvent::Edge.code()), at: of.edge, miss: zero, steep: one };
        next.record(zero.select_lt(way, side, never), number(PanelEvent::Side.code()));
        // The body counts as flat, on either face, where tan(theta/2) or its inverse is this small.
        let flat = number(0.5 * FLAT);
        let (slope, steep) = (s / (one + c), s / (one - c));
        let (below, above) = ((slope - flat) / (slope + flat), (steep - flat) / (steep + flat));
        next.record(zero.select_lt(way, above, below), number(PanelEvent::Face.code()));
        let turns_back = number(PanelEvent::Turn.code());
        let ahead = &ends.seen[0];
        let code = ahead.miss.select_lt(number(TURNING_POINT_ERROR), turns_back, never);
        next.record(half.select_lt(ends.is_high, ends.high, never), code);
        // Beyond a possible pair of zeros of F the event is unknown.
        next.record(ahead.doubt, never);
        if sought.ends {
            let all = [(&of.press, PanelEvent::LiftOff), (&of.grip, PanelEvent::Slip)];
            for (series, what) in all.into_iter().take(1 + usize::from(sought.slips)) {
                let found = EtaSeries::of(series).first(next.at);
                let lifted = series[0].select_lt(zero, one, zero);
                let at = zero.select_lt(lifted, zero, half.select_lt(found.is_found, found.at, never));
                let hit = at.select_lt(next.at, one, zero);
                next.miss = zero.select_lt(hit, found.miss, next.miss);
                next.steep = zero.select_lt(hit, found.steep, next.steep);
                // Slip comes before lift-off, so that a lift-off without an earlier slip means that the slip was
                // missed.
                let code =
                    if sought.slips && what == PanelEvent::LiftOff { never } else { number(what.code()) };
                next.record(at, code);
                next.record(zero.select_lt(lifted, never, found.doubt), never);
            }
        }
        next
    }
}

/// The turning points ahead and behind; the edge of the panel replaces a turning point beyond it.
#[inline(always)]
fn turns_of_force<T: Lane, const N: usize>(force: &[T; N]) -> TurningPlaces<T> {
    let number = here(
        #[inline(always)]
        |x: f64| force[0].splat(x),
    );
    let (zero, one, half) = (number(0.0), number(1.0), number(0.5));
    let seen = EtaSeries::of(force).turns();
    let edge = number(MORE as f64 * WIDTH);
    let rests = force[0].abs().select_lt(number(f64::MIN_POSITIVE), one, zero);
    let high = seen[0].is_found.select_lt(half, edge, seen[0].at);
    let behind = seen[1].is_found.select_lt(half, number(-1.0) * edge, seen[1].at.min(zero));
    let low = zero.select_lt(rests, zero, behind);
    // A zero is not divided out if Newton's method has not converged to it, as happens near another zero.
    let is_low = zero.select_lt(
        rests,
        one,
        seen[1].miss.select_lt(number(TURNING_POINT_ERROR), seen[1].is_found, zero),
    );
    TurningPlaces { low, high, is_low, is_high: seen[0].is_found, seen }
}

impl<T: Lane> EventInProgress<T> {
    /// In each SIMD lane where the requested time comes before the event, replaces the event by the arrival at that
    /// time.
    #[inline(always)]
    fn at_time<const N: usize>(
        &mut self,
        rule: &Rule,
        clock: &PanelClock<'_, T, N>,
        ways: [T; 2],
        target: T,
    ) {
        let (zero, one, time) = (target.splat(0.0), target.splat(1.0), self.time);
        let hit = target.select_lt(time, one, zero);
        if !hit.any() {
            return;
        }
        let found = zero.aside(
            #[inline(always)]
            move || clock.sought(rule, ways, (target, time)),
        );
        let missed = (target - found.time).abs();
        self.time = zero.select_lt(hit, found.time, self.time);
        self.late = zero.select_lt(hit, missed + found.tail, self.late);
        self.weakest = zero.select_lt(hit, found.weakest, self.weakest);
        self.out = zero.select_lt(hit, found.at, self.out);
        for (apart, found) in self.apart.iter_mut().zip(found.apart) {
            *apart = zero.select_lt(hit, found, *apart);
        }
        self.code = zero.select_lt(hit, target.splat(PanelEvent::Time.code()), self.code);
    }
}

/// Returns `yes` where a code is that of the event `what`, else `no`.
#[inline(always)]
fn where_event_is<T: Real>(code: T, what: PanelEvent, yes: T, no: T) -> T {
    where_equal(code, what.code(), yes, no)
}

/// Returns `yes` where the whole number `number` is `other`, else `no`.
#[inline(always)]
fn where_equal<T: Real>(number: T, other: f64, yes: T, no: T) -> T {
    (number - number.splat(other)).abs().select_lt(number.splat(0.5), yes, no)
}

/// The first event found so far; for a zero of a series also its error from Newton's method and the slope.
struct FirstEvent<T> {
    code: T,
    at: T,
    miss: T,
    steep: T,
}

impl<T: Real> FirstEvent<T> {
    /// Records an event at a place, unless another event comes before.
    #[inline(always)]
    fn record(&mut self, at: T, code: T) {
        self.code = at.select_lt(self.at, code, self.code);
        self.at = at.select_lt(self.at, at, self.at);
    }
}
