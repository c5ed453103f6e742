//! The places that a swing passes between its turning points, and the times of the passages.
//!
//! A place is a number that grows with the inclination: the index of the leg, counted from the lower end, plus the part
//! of its variable that lies below. Time is a smooth function of the place. An event that depends on the state alone
//! happens at the same places on the way up and on the way down.

use super::{Leg, LegPoint, Swing};
use crate::laws::body::Body;
use crate::laws::contact::Contact;
use crate::laws::state::State;

impl Swing {
    /// Places along half a swing, ascending in inclination and dense enough to resolve the motion: each as a number
    /// for [`rising`](Self::rising), with the time spent around it.
    pub(crate) fn nodes(&self) -> Vec<(f64, f64)> {
        if self.is_steady() {
            return vec![(0.0, 1.0)];
        }
        let mut nodes = Vec::new();
        let lands = self.lines.lands();
        if !lands[0] {
            nodes.push((0.0, 0.0));
        }
        for (i, leg) in self.legs.iter().enumerate() {
            let first = nodes.len();
            nodes
                .extend(leg.clock.nodes().map(|(v, weight)| (self.place_of(LegPoint { leg: i, v }), weight)));
            if leg.stretch.way < 0.0 {
                nodes[first..].reverse();
            }
        }
        if !lands[1] {
            nodes.push((self.legs.len() as f64, 0.0));
        }
        nodes
    }

    /// Time until the motion first passes a place; None if it never does. The time is positive also for `way` = -1,
    /// backward in time.
    pub(crate) fn time_to_place(&self, way: f64, place: f64) -> Option<f64> {
        if self.is_steady() {
            return Some(0.0);
        }
        let (below, above) =
            if place < self.start_place() { (Some(place), None) } else { (None, Some(place)) };
        self.first(way, below, above).map(|(t, _)| t)
    }

    /// The lowest and the highest place of the motion between time 0 and `t`.
    pub(crate) fn range_of_places(&self, t: f64) -> [f64; 2] {
        let start = self.start_place();
        if self.is_steady() {
            return [start; 2];
        }
        let end = self.landing(t).map_or(t.abs(), |(limit, _)| t.abs().min(limit));
        let now = self.place_of(self.phase_at(t.signum() * end).spot);
        let meets = |place: f64| self.time_to_place(t.signum(), place).is_some_and(|time| time <= end);
        let greatest_v = self.legs.len() as f64;
        [
            if meets(0.0) { 0.0 } else { start.min(now) },
            if meets(greatest_v) { greatest_v } else { start.max(now) },
        ]
    }

    pub(crate) fn body(&self) -> &Body {
        &self.body
    }

    pub(crate) fn contact(&self) -> Contact {
        self.contact
    }

    pub(crate) fn start(&self) -> &State {
        &self.start
    }

    pub(crate) fn start_place(&self) -> f64 {
        if self.is_steady() { 0.0 } else { self.place_of(self.at_start) }
    }

    /// The state at a place while the inclination rises.
    pub(crate) fn rising_state(&self, place: f64) -> State {
        if self.is_steady() { self.start } else { self.state_at(self.leg_point_at(place), true) }
    }

    /// The places at which the body reaches the limits of its circle of contact, where another circle or another part
    /// lands; None for a limit that the swing does not reach.
    pub(crate) fn borders(&self) -> [Option<f64>; 2] {
        let ([low, high], [below, above]) = (self.lines.range(), self.lines.borders);
        let place = |x: f64| {
            let on = |(leg, of): (usize, &Leg)| of.stretch.v(x).map(|v| self.place_of(LegPoint { leg, v }));
            self.legs.iter().enumerate().find_map(on)
        };
        [if below > low { place(below) } else { None }, if above < high { place(above) } else { None }]
    }

    /// The first time at which the swing reaches the place `below` or the place `above` its start, and the state
    /// then. The time is positive also for `way` = -1, backward in time.
    pub(crate) fn first(&self, way: f64, below: Option<f64>, above: Option<f64>) -> Option<(f64, State)> {
        if self.is_steady() {
            return None;
        }
        let half = self.half_nutation.time;
        let lands = self.lines.lands();
        let phase = if way < 0.0 { -self.phase } else { self.phase };
        let rising = phase > 0.0 || (phase == 0.0 && self.start_place() < 0.5 * self.legs.len() as f64);
        let time = |place: f64| self.time_at(self.leg_point_at(place));
        let here = phase.abs();
        let (direct, later) = if rising { (above, below) } else { (below, above) };
        let (place, t, still) = if let Some(place) = direct {
            (place, (time(place) - here).abs(), true)
        } else if rising && !lands[1] {
            let place = later?;
            (place, (half - here) + (half - time(place)), false)
        } else if !rising && !lands[0] {
            let place = later?;
            (place, here + time(place), false)
        } else {
            return None;
        };
        Some((t, self.state_at(self.leg_point_at(place), (rising == still) == (way >= 0.0))))
    }
}
