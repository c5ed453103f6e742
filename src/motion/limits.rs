//! What the model assumes, and where along an exact motion it ends.
//!
//! ```text
//! theta > 0,   theta < theta_end,   N > 0,   mu N - |F_horizontal| > 0
//! ```
//! All of these are functions of the inclination alone along one motion: between its turning points the same is
//! met on the way up and on the way down. So the nearest places below and above the start where one fails are
//! found, and the motion says which it meets first.

use super::{Ending, Event};
use crate::body::Body;
use crate::contact::reduced::Rates;
use crate::contact::{Contact, Table, force_at};
use crate::exact::Swing;
use crate::newton;
use crate::search;
use crate::state::State;
use core::f64::consts::PI;

/// Friction below this, relative to the terms it is a difference of, is rounding.
const GRIP: f64 = 16.0 * f64::EPSILON;

/// What must stay positive, in the order of [`Ending`] from `Face` on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    pub body: Body,
    pub contact: Contact,
    mu: f64,
    pub rates: Rates<f64>,
}

impl Limits {
    pub fn new(body: &Body, table: &Table) -> Self {
        let (contact, mu) = (table.contact(), table.mu());
        Self { body: *body, contact, mu, rates: contact.rates(body) }
    }

    /// Margins of lift-off and slip.
    #[inline(always)]
    pub fn grip(&self, y: &State, dy: &State, angle: (f64, f64)) -> [f64; 2] {
        let [lift, slip] = self.plain_grip(y, dy, angle);
        let depth = self.rates.reduced().shape.rim.depth(angle).abs();
        let terms = 1.0 + y.w1.abs() / angle.0 * (y.w3.abs() + depth * y.w1.abs());
        [lift, slip + GRIP * terms]
    }

    /// The same without what rounding is allowed to make of the friction: for the time of an event that is one.
    #[inline(always)]
    fn plain_grip(&self, y: &State, dy: &State, angle: (f64, f64)) -> [f64; 2] {
        // what no friction holds does not slip: it slides all the time
        if self.mu.is_infinite() || self.contact == Contact::Smooth {
            return [newton::normal(&self.rates.reduced().shape, angle, y.w2, dy.w2), 1.0];
        }
        let f = force_at(self.rates.reduced(), y, dy, angle);
        [f.normal, self.mu * f.normal - f.friction()]
    }

    /// The same of a state alone.
    fn grip_of(&self, y: &State) -> [f64; 2] {
        let angle = y.theta.sin_cos();
        self.grip(y, &self.rates.derivative(y, angle), angle)
    }

    fn plain_grip_of(&self, y: &State) -> [f64; 2] {
        let angle = y.theta.sin_cos();
        self.plain_grip(y, &self.rates.derivative(y, angle), angle)
    }

    /// Margin of lying on the side, or on whatever else ends the lean.
    pub fn side(&self, y: &State) -> f64 {
        if self.body.theta_end() < PI { self.body.theta_end() - y.theta } else { 1.0 }
    }

    /// What must stay positive for this not to happen.
    fn margin(&self, ending: Ending, y: &State) -> f64 {
        match ending {
            Ending::Side => self.side(y),
            Ending::LiftOff => self.plain_grip_of(y)[0],
            Ending::Slip => self.plain_grip_of(y)[1],
            Ending::Done | Ending::Face | Ending::Painleve | Ending::Stops => 1.0,
        }
    }

    /// What the rounding of a state makes of the time and the state of an event found there.
    ///
    /// A margin m, known to what an ulp of each of the four numbers moves it, vanishes at a time that is known to that
    /// over |m'|; where it only grazes zero, to the square root of twice that over |m''|. The start itself is known.
    pub fn doubt(&self, event: &Event) -> f64 {
        let y = event.state;
        if event.time == 0.0 {
            return 0.0;
        }
        // m, how it changes with time, and what it is uncertain by
        let look = |y: &State| {
            let (dy, here) = (self.rates.derivative(y, y.theta.sin_cos()), self.margin(event.ending, y));
            let (numbers, rates): ([f64; 4], [f64; 4]) = ((*y).into(), dy.into());
            // w1 and w3 feed each other
            let turning = y.w1.abs().max(y.w3.abs());
            let scales = [y.theta.abs(), turning, y.w2.abs(), turning];
            let (mut drift, mut noise) = (0.0, 1.0);
            for i in 0..4 {
                let step = scales[i].max(f64::MIN_POSITIVE) * 2f64.powi(-26);
                let mut moved = numbers;
                moved[i] += step;
                let slope = (self.margin(event.ending, &State::from(moved)) - here) / step;
                drift += slope * rates[i];
                noise += (slope * scales[i]).abs();
            }
            let fastest = rates.iter().fold(0f64, |most, x| most.max(x.abs()));
            (drift, 8.0 * f64::EPSILON * noise, fastest, rates)
        };
        let (drift, noise, fastest, rates) = look(&y);
        let ahead = 1e-4 / (1.0 + fastest);
        let numbers: [f64; 4] = y.into();
        let (later, ..) = look(&State::from(core::array::from_fn(|i| numbers[i] + ahead * rates[i])));
        let bend = ((later - drift) / ahead).abs();
        let time = (noise / drift.abs()).min((2.0 * noise / bend).sqrt());
        if time.is_finite() { time * (1.0 + fastest) } else { 0.0 }
    }

    /// The event of a start that is none.
    pub fn at_start(&self, y: &State, way: f64) -> Option<Ending> {
        let angle = y.theta.sin_cos();
        self.at_start_of(y, &self.rates.derivative(y, angle), angle, way)
    }

    /// The same where the state's derivative, and sine and cosine of theta, are known already.
    pub fn at_start_of(&self, y: &State, dy: &State, angle: (f64, f64), way: f64) -> Option<Ending> {
        let [lift, slip] = self.grip(y, dy, angle);
        let turns_away = way * y.w2 > 0.0 || (y.w2 == 0.0 && dy.w2 > 0.0);
        let side = self.side(y);
        if side < 0.0 || (side == 0.0 && !turns_away) {
            Some(Ending::Side)
        } else if lift <= 0.0 {
            Some(Ending::LiftOff)
        } else if slip < 0.0 {
            Some(Ending::Slip)
        } else {
            None
        }
    }
}

/// The first event of an exact motion, times measured from its start.
pub(super) fn first_event(swing: &Swing, limits: &Limits, way: f64) -> Option<Event> {
    let start = swing.start();
    if let Some(ending) = limits.at_start(start, way) {
        return Some(Event { ending, time: 0.0, state: *start });
    }
    let mut first: Option<Event> = None;
    let mut offer = |ending: Ending, found: Option<(f64, State)>| {
        if let Some((time, state)) = found
            && first.is_none_or(|e| time < e.time)
        {
            first = Some(Event { ending, time, state });
        }
    };
    offer(Ending::Face, swing.landing(way));
    let theta_end = limits.body.theta_end();
    if theta_end < PI {
        let side = swing.first(way, None, swing.side());
        offer(Ending::Side, side.map(|(t, y)| (t, State { theta: theta_end, ..y })));
    }
    if !swing.is_steady() {
        let margin = |i: usize| move |u: f64| limits.grip_of(&swing.rising(u))[i];
        let plain = |i: usize| move |u: f64| limits.plain_grip_of(&swing.rising(u))[i];
        let lift = violations(swing, margin(0), plain(0), 0);
        let slip =
            if limits.mu.is_infinite() { (None, None) } else { violations(swing, margin(1), plain(1), 5) };
        offer(Ending::LiftOff, swing.first(way, lift.0, lift.1));
        offer(Ending::Slip, swing.first(way, slip.0, slip.1));
    }
    first.map(|e| Event { time: way * e.time, ..e })
}

/// The nearest places below and above the start where a margin of the half swing turns negative.
///
/// Its time is that of the `plain` one, without allowance for rounding. `between` more places are looked at between two of the swing's own, which resolve its motion: the friction
/// demand, a quotient and a square root, bends faster than that.
fn violations(
    swing: &Swing,
    margin: impl Fn(f64) -> f64,
    plain: impl Fn(f64) -> f64,
    between: u32,
) -> (Option<f64>, Option<f64>) {
    let start = swing.start_place();
    let coarse: Vec<f64> = swing.nodes().into_iter().map(|(u, _)| u).collect();
    let parts = f64::from(between + 1);
    let finer = |w: &[f64]| {
        let (low, width) = (w[0], w[1] - w[0]);
        (0..=between).map(move |k| low + width * f64::from(k) / parts)
    };
    let mut nodes: Vec<f64> = coarse.windows(2).flat_map(finer).chain(coarse.last().copied()).collect();
    let here = nodes.partition_point(|u| *u < start);
    nodes.insert(here, start);
    let values: Vec<f64> = nodes.iter().map(|u| margin(*u)).collect();
    let search = |indices: &mut dyn Iterator<Item = usize>| {
        let mut before = here;
        let cross = |a: usize, u: f64, at_u: f64| {
            let (before, after) = (plain(nodes[a]), plain(u));
            Some(if before > 0.0 && after < 0.0 {
                search::crossing(&plain, nodes[a], u, before, after)
            } else {
                search::crossing(&margin, nodes[a], u, values[a], at_u)
            })
        };
        for i in indices {
            if values[i] < 0.0 {
                return cross(before, nodes[i], values[i]);
            }
            let next = if i > before { i + 1 } else { i.wrapping_sub(1) };
            let falls = |a: usize, b: usize| values[b] <= values[a];
            // a least margin lies around a node, or between the start and the first of them; where the margin
            // is large beside what it varies by, it does not matter how low that is
            let dip = if before == here && !falls(here, i) {
                let ahead = nodes[here] + 1e-4 * (nodes[i] - nodes[here]);
                (1e4 * (values[here] - margin(ahead)) > values[here]).then_some(i)
            } else {
                let least = next < nodes.len() && falls(before, i) && falls(next, i) && values[next] >= 0.0;
                (least && values[i] < 4.0 * (values[before].max(values[next]) - values[i])).then_some(next)
            };
            if let Some(end) = dip {
                let (u, least) = search::least(&margin, nodes[before], nodes[end]);
                if least < 0.0 {
                    return cross(before, u, least);
                }
            }
            before = i;
        }
        None
    };
    (search(&mut (0..here).rev()), search(&mut (here + 1..nodes.len())))
}
