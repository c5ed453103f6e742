//! Many motions at once: their starts as columns, and the results.

use super::numbers;
use spincyl::ensemble::{
    BodyColumns, Job, LossColumns, MotionOutput, MotionStarts, SUMMARIES, Summary, roll,
};
use spincyl::loss::Law;
use spincyl::{Body, State};

/// The number of loss laws.
pub const LAWS: usize = Law::ALL.len();

/// The columns of losses, law by law.
pub fn loss_columns(columns: &[Vec<f64>; LAWS]) -> LossColumns<'_> {
    Law::ALL.iter().zip(columns).fold(LossColumns::NONE, |all, (law, column)| all.with(*law, column))
}

/// Columns of bodies and states, and the results of their motions.
#[derive(Default)]
pub struct Many {
    pub body: [Vec<f64>; 5],
    pub state: [Vec<f64>; 4],
    pub states: [Vec<f64>; 4],
    pub last: [Vec<f64>; 4],
    pub sums: [Vec<f64>; SUMMARIES],
    pub error: Vec<f64>,
    pub method: Vec<u8>,
    pub status: Vec<u8>,
}

/// The columns ell, i1, i3, fillet and theta_end of bodies.
pub fn body_columns([ell, i1, i3, fillet, theta_end]: [&[f64]; 5]) -> BodyColumns<'_> {
    BodyColumns::new(ell, i1, i3).with_fillet(fillet).with_theta_end(theta_end)
}

/// Adds an array for each summary to the output arrays.
pub fn with_summaries<'a>(out: MotionOutput<'a>, sums: &'a mut [Vec<f64>]) -> MotionOutput<'a> {
    assert_eq!(sums.len(), SUMMARIES);
    Summary::ALL.iter().zip(sums).fold(out, |out, (kind, column)| out.with_summary(*kind, column))
}

impl Many {
    pub fn of(all: &[(Body, State)]) -> Self {
        let mut many = Self::default();
        for (body, y) in all {
            for (column, x) in
                many.body.iter_mut().zip([body.ell(), body.i1(), body.i3(), body.fillet(), body.theta_end()])
            {
                column.push(x);
            }
            for (column, x) in many.state.iter_mut().zip(numbers(y)) {
                column.push(x);
            }
        }
        many
    }

    pub fn run(mut self, job: &Job<'_>, threads: usize) -> Self {
        let count = self.state.iter().map(Vec::len).max().unwrap();
        self.states = core::array::from_fn(|_| vec![7.0; count * job.times.len()]);
        self.last = core::array::from_fn(|_| vec![7.0; count]);
        self.sums = core::array::from_fn(|_| vec![7.0; count]);
        (self.error, self.method, self.status) = (vec![7.0; count], vec![77; count], vec![77; count]);
        let bodies = body_columns(self.body.each_ref().map(Vec::as_slice));
        let starts = MotionStarts::new(bodies, self.state.each_ref().map(Vec::as_slice));
        let out = MotionOutput::new(&mut self.error, &mut self.method, &mut self.status)
            .with_states(self.states.each_mut().map(Vec::as_mut_slice))
            .with_last(self.last.each_mut().map(Vec::as_mut_slice));
        assert!(roll(&starts, job, with_summaries(out, &mut self.sums), threads, |_| true).unwrap());
        self
    }

    pub fn last(&self, i: usize) -> State {
        State::from(self.last.each_ref().map(|x| x[i]))
    }

    /// The state of the motion `i` at the time with the index `j`.
    pub fn at(&self, i: usize, j: usize) -> State {
        let times = self.states[0].len() / self.error.len();
        State::from(self.states.each_ref().map(|x| x[i * times + j]))
    }

    pub fn sum(&self, kind: Summary, i: usize) -> f64 {
        self.sums[kind as usize][i]
    }

    /// The bits of all results of the motion `i`.
    pub fn bits(&self, i: usize) -> Vec<u64> {
        let times = self.states[0].len() / self.error.len();
        let mut all: Vec<f64> =
            self.states.iter().flat_map(|x| x[i * times..(i + 1) * times].to_vec()).collect();
        all.extend(self.last.iter().chain(&self.sums).map(|x| x[i]));
        all.extend([self.error[i], self.method[i].into(), self.status[i].into()]);
        all.into_iter().map(f64::to_bits).collect()
    }
}
