//! The initial states of many drifts and the arrays for their results, as columns.

use crate::error::Error;
use crate::laws::body::Body;
use crate::laws::loss::Losses;
use crate::laws::state::State;
use crate::many::columns::{BodyColumns, LossColumns, Split, StateColumns, at, fit, rows};
use crate::motions::drift::rest::Rest;
use crate::motions::drift::{Drift, End, check_drift};

/// The motion of the centre of mass during a drift. Arrays hold the number of the variant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
#[non_exhaustive]
pub enum Centre {
    /// The centre of mass is held at rest.
    Rest = 0,
    /// The body rolls without slipping, and its centre of mass moves.
    Rolling = 1,
}

/// Bodies, initial states and losses as columns of numbers: each column has the length n, or is a single number for
/// all.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct DriftStarts<'a> {
    /// The motion of the centre of mass, the same for all drifts.
    pub centre: Centre,
    /// Columns of ell, i1, i3, bore (NaN unless the body is a tube), fillet and theta_end (NaN for the default of the
    /// body).
    pub(crate) bodies: [&'a [f64]; 6],
    /// Columns of theta, w1, w2 and w3; only theta matters for a centre at rest.
    pub(crate) states: [&'a [f64]; 4],
    /// Columns of the coefficients of the loss laws.
    pub losses: LossColumns<'a>,
}

impl<'a> DriftStarts<'a> {
    /// The drifts of the bodies, states and losses in these columns, with this motion of the centre of mass.
    pub fn new(
        centre: Centre,
        bodies: BodyColumns<'a>,
        states: impl Into<StateColumns<&'a [f64]>>,
        losses: LossColumns<'a>,
    ) -> Self {
        let BodyColumns { ell, i1, i3, bore, fillet, theta_end } = bodies;
        let bodies = [ell, i1, i3, bore, fillet, theta_end];
        Self { centre, bodies, states: states.into().into(), losses }
    }
}

/// The code of an initial state without a drift; the codes of [`End`] are smaller.
pub const NO_DRIFT: u8 = 255;

/// The arrays for the results of many drifts.
#[derive(Debug)]
#[non_exhaustive]
pub struct DriftOutput<'a> {
    /// The time of the end, in sqrt(R/g): infinite if the drift never ends, NaN for a start without a drift.
    pub stops_at: &'a mut [f64],
    /// The inclination at the end, in radians.
    pub ends_at_theta: &'a mut [f64],
    /// Code of the [`End`] of each drift, or [`NO_DRIFT`].
    pub ended: &'a mut [u8],
}

impl<'a> DriftOutput<'a> {
    /// Results in these arrays: the times of the ends, the inclinations at the ends, and the codes of the ends.
    pub fn new(stops_at: &'a mut [f64], ends_at_theta: &'a mut [f64], ended: &'a mut [u8]) -> Self {
        Self { stops_at, ends_at_theta, ended }
    }
}

impl Split for DriftOutput<'_> {
    fn split(self, count: usize) -> (Self, Self) {
        let (stops_at, later_stops) = self.stops_at.split(count);
        let (ends_at_theta, later_theta) = self.ends_at_theta.split(count);
        let (ended, later_ended) = self.ended.split(count);
        let later = Self { stops_at: later_stops, ends_at_theta: later_theta, ended: later_ended };
        (Self { stops_at, ends_at_theta, ended }, later)
    }
}

impl DriftOutput<'_> {
    pub(crate) fn put(&mut self, i: usize, (end, theta, time): (End, f64, f64)) {
        (self.stops_at[i], self.ends_at_theta[i], self.ended[i]) = (time, theta, end as u8);
    }

    /// Writes NaN and [`NO_DRIFT`] for row `i`, which has no drift.
    pub(crate) fn refuse(&mut self, i: usize) {
        (self.stops_at[i], self.ends_at_theta[i], self.ended[i]) = (f64::NAN, f64::NAN, NO_DRIFT);
    }
}

/// A body, its initial state and its losses, as numbers of one row.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DriftRow {
    pub body: [f64; 6],
    pub state: [f64; 4],
    pub losses: Losses,
}

impl DriftRow {
    pub(crate) fn body(&self) -> Result<Body, Error> {
        Body::of_numbers(self.body)
    }

    pub(crate) fn drift(&self, centre: Centre) -> Result<Drift, Error> {
        let (body, state) = (self.body()?, State::from(self.state));
        match centre {
            Centre::Rest => Drift::at_rest(&body, state.theta, &self.losses),
            Centre::Rolling => Drift::rolling(&body, &state, &self.losses),
        }
    }

    /// The end of the drift with the centre at rest, its inclination and its time.
    pub(crate) fn end_at_rest(&self) -> Result<(End, f64, f64), Error> {
        let body = self.body()?;
        check_drift(&body, &self.losses)?;
        Ok(Rest::unwatched(&body, self.state[0], &self.losses)?.end())
    }
}

impl DriftStarts<'_> {
    /// The number of initial states.
    pub fn len(&self) -> usize {
        rows(self.columns())
    }

    /// Whether there are no initial states.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn columns(&self) -> impl Iterator<Item = &[f64]> {
        self.bodies.iter().chain(&self.states).chain(&self.losses.0).copied()
    }

    pub(crate) fn fit(&self, count: usize) -> bool {
        fit(self.columns(), count)
    }

    pub(crate) fn row(&self, i: usize) -> DriftRow {
        let at = |x: &[f64]| at(x, i);
        DriftRow { body: self.bodies.map(at), state: self.states.map(at), losses: self.losses.row(i) }
    }

    pub(crate) fn is_rounded(&self, i: usize) -> bool {
        at(self.bodies[4], i) != 0.0
    }
}
