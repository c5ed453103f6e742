//! The assumptions of the model, and the first event of an exact motion, at which one of them fails.
//!
//! ```text
//! theta > 0,   low < theta < theta_end,   N > 0,   mu N - |F_horizontal| > 0
//! ```
//! Along one motion all of these quantities are functions of the inclination alone, with the same values while theta
//! rises and while it falls. The inclinations nearest to the initial one, below and above, at which an assumption
//! fails are computed; the event is at the one that the motion reaches first.

use super::Swing;
use crate::laws::body::{Body, border_at, leaves};
use crate::laws::contact::reduced::Rates;
use crate::laws::contact::{Contact, Table, force_at};
use crate::laws::newton;
use crate::laws::state::State;
use crate::methods::search;
use crate::motions::{Ending, Event};
use core::f64::consts::PI;

/// Allowance for rounding in the condition against slip, mu N >= |F|, relative to the terms whose difference is the
/// required friction. With a smaller allowance, rolling that needs exactly mu N could end by rounding alone.
const SLIP_MARGIN_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A body with its contact, and the conditions under which its motion continues.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
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

    /// Margins that are negative after a lift-off (N) and after a slip (mu N minus the required friction, with an
    /// allowance for rounding).
    #[inline(always)]
    pub fn grip(&self, y: &State, dy: &State, angle: (f64, f64)) -> [f64; 2] {
        let [lift, slip] = self.margins_without_allowance(y, dy, angle);
        let depth = self.rates.reduced().shape.rim.depth(angle).abs();
        let terms = 1.0 + y.w1.abs() / angle.0 * (y.w3.abs() + depth * y.w1.abs());
        [lift, slip + SLIP_MARGIN_ROUNDING * terms]
    }

    /// The margins against lift-off and slip without the allowance for rounding; their zeros are the times of events.
    #[inline(always)]
    fn margins_without_allowance(&self, y: &State, dy: &State, angle: (f64, f64)) -> [f64; 2] {
        // Unlimited friction never lets the contact point slip, and on a smooth table slip is no event.
        if self.mu.is_infinite() || self.contact == Contact::Smooth {
            return [newton::normal(&self.rates.reduced().shape, angle, y.w2, dy.w2), 1.0];
        }
        let f = force_at(self.rates.reduced(), y, dy, angle);
        [f.normal, self.mu * f.normal - f.friction()]
    }

    /// The margins against lift-off and slip in a state, with the allowance for rounding.
    fn margins_of_state(&self, y: &State) -> [f64; 2] {
        let angle = y.theta.sin_cos();
        self.grip(y, &self.rates.derivative(y, angle), angle)
    }

    fn margins_of_state_without_allowance(&self, y: &State) -> [f64; 2] {
        let angle = y.theta.sin_cos();
        self.margins_without_allowance(y, &self.rates.derivative(y, angle), angle)
    }

    /// The distance of theta from the inclinations at which another circle or another part of the body lands; at
    /// least 1 without such an inclination.
    pub fn side(&self, y: &State) -> f64 {
        let [low, high] = self.body.carries();
        let below = if low > 0.0 { y.theta - low } else { 1.0 };
        if high < PI { below.min(high - y.theta) } else { below }
    }

    /// The quantity that must stay positive so that this ending does not occur; 1 for an ending without such a
    /// quantity.
    fn margin(&self, ending: Ending, y: &State) -> f64 {
        match ending {
            Ending::Side => self.side(y),
            Ending::LiftOff => self.margins_of_state_without_allowance(y)[0],
            Ending::Slip => self.margins_of_state_without_allowance(y)[1],
            Ending::Done
            | Ending::Face
            | Ending::Invalid
            | Ending::Painleve
            | Ending::Stops
            | Ending::Bounded
            | Ending::Landing => 1.0,
        }
    }

    /// Error of the time and the state of an event, from the rounding of the state.
    ///
    /// Let m be the margin whose zero is the event, and d its change for a rounding (ulp) of each of the four
    /// components of the state. The time at which m vanishes has the error d/|m'|, or the square root of 2 d/|m''|
    /// where m only touches zero. An event at time 0 is exact.
    pub fn doubt(&self, event: &Event) -> f64 {
        let y = event.state;
        if event.time == 0.0 {
            return 0.0;
        }
        // The closure returns m', the uncertainty of m, the largest rate, and all rates.
        let look = |y: &State| {
            let (dy, here) = (self.rates.derivative(y, y.theta.sin_cos()), self.margin(event.ending, y));
            let (numbers, rates): ([f64; 4], [f64; 4]) = ((*y).into(), dy.into());
            // An error of w1 becomes one of w3 and vice versa, so that both have the same scale.
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

    /// The ending of a motion that ends at its start; None if it does not. `way` is the direction of time.
    pub fn at_start(&self, y: &State, way: f64) -> Option<Ending> {
        let angle = y.theta.sin_cos();
        self.at_start_of(y, &self.rates.derivative(y, angle), angle, way)
    }

    /// The ending of a motion that ends at its start, from the derivative of the state and the sine and cosine of
    /// theta; None if it does not.
    pub fn at_start_of(&self, y: &State, dy: &State, angle: (f64, f64), way: f64) -> Option<Ending> {
        let [lift, slip] = self.grip(y, dy, angle);
        if leaves(self.body.carries(), y.theta, [way * y.w2, dy.w2]) {
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

/// The first event of an exact motion, with its time since the initial state; None without an event.
pub(crate) fn first_event(swing: &Swing, limits: &Limits, way: f64) -> Option<Event> {
    let start = swing.start();
    if let Some(ending) = limits.at_start(start, way) {
        return Some(Event { ending, time: 0.0, state: *start, rim: 0 });
    }
    let mut first: Option<Event> = None;
    let mut offer = |ending: Ending, found: Option<(f64, State)>| {
        if let Some((time, state)) = found
            && first.is_none_or(|e| time < e.time)
        {
            first = Some(Event { ending, time, state, rim: 0 });
        }
    };
    offer(Ending::Face, swing.landing(way));
    let range = limits.body.carries();
    if range[1] < PI || range[0] > 0.0 {
        let [below, above] = swing.borders();
        let side = swing.first(way, below, above);
        offer(Ending::Side, side.map(|(t, y)| (t, State { theta: border_at(range, y.theta), ..y })));
    }
    if !swing.is_steady() {
        let margin = |i: usize| move |u: f64| limits.margins_of_state(&swing.rising_state(u))[i];
        let plain =
            |i: usize| move |u: f64| limits.margins_of_state_without_allowance(&swing.rising_state(u))[i];
        let lift = violations(swing, margin(0), plain(0), 0);
        let slip =
            if limits.mu.is_infinite() { (None, None) } else { violations(swing, margin(1), plain(1), 5) };
        offer(Ending::LiftOff, swing.first(way, lift.0, lift.1));
        offer(Ending::Slip, swing.first(way, slip.0, slip.1));
    }
    first.map(|e| Event { time: way * e.time, ..e })
}

/// The places nearest to the start, below and above, at which a margin turns negative along the swing.
///
/// If the margin `plain`, without an allowance for rounding, changes its sign, its zero is that place. The margin is
/// evaluated at the nodes of the swing, which resolve the motion, and at `between` places between neighbouring nodes,
/// since the required friction, with its quotient and square root, varies faster than the motion.
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
            // A minimum of the margin lies around a node, or between the start and the first node. The
            // minimum is irrelevant where the margin is large in comparison with its variation.
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
