//! The initial states of an ensemble and the arrays for its results, as columns.

use super::{Answer, Job};
use crate::error::Error;
use crate::laws::body::{Body, MOST_CIRCLES, beyond};
use crate::laws::contact::Table;
use crate::laws::loss::Losses;
use crate::laws::state::State;
use crate::many::columns::{BodyColumns, LossColumns, Split, StateColumns, at, fit, rows};
use crate::motions::{AboveTable, Ending, Start};
use crate::numbers::codes::coded;

/// Bodies, initial states, slips, contacts and losses as columns of numbers: each column has the length n, or is a
/// single number for all.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct MotionStarts<'a> {
    /// Columns of ell, i1, i3, fillet and theta_end (NaN for the default of the body).
    pub(crate) bodies: [&'a [f64]; 5],
    /// Columns of theta, w1, w2 and w3 at the start.
    pub(crate) states: [&'a [f64]; 4],
    /// The slope of the table and phi at the start; `None` on a level table.
    pub(crate) slopes: Option<[&'a [f64]; 2]>,
    /// The slip along e_h and along e2, in sqrt(g R); `None` means that there is no slip, and that the
    /// centre of a body on its face is at rest under friction.
    pub(crate) slips: Option<[&'a [f64]; 2]>,
    /// The coefficients of friction of each motion, and the radius of its patch; `None` means those of the job.
    pub(crate) coefficients: Option<[&'a [f64]; 3]>,
    /// The coefficients of the losses; `None` means no losses.
    pub(crate) losses: Option<LossColumns<'a>>,
    /// Height and vertical velocity of the lowest point, for motions that start in the air; `None` on the table.
    pub(crate) aloft: Option<[&'a [f64]; 2]>,
    /// The circles of bodies that have several, from the lower end up; of such a body `bodies` has only i1 and i3. There are
    /// n rows or a single one, or none if no body has several circles.
    pub(crate) circles: &'a [CirclesOfRow],
}

/// The circles of one body, each as its radius, its height above the centre of mass, and its fillet, in natural units.
/// A radius of NaN marks a place without a circle.
pub(crate) type CirclesOfRow = [[f64; 3]; MOST_CIRCLES];

/// The columns of bodies and initial states, collected from pairs of a body and its initial state.
///
/// ```
/// use spincyl::ensemble::MotionColumns;
/// use spincyl::{Body, steady};
///
/// let columns: MotionColumns = [0.5, 1.0, 1.5]
///     .into_iter()
///     .map(|ell| {
///         let body = Body::solid(ell)?;
///         Ok((body, steady::state(&body, 1.4)?.kicked(0.01)))
///     })
///     .collect::<Result<_, spincyl::Error>>()?;
/// assert_eq!(columns.starts().len(), 3);
/// # Ok::<(), spincyl::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct MotionColumns {
    bodies: [Vec<f64>; 5],
    states: [Vec<f64>; 4],
    circles: Vec<CirclesOfRow>,
}

impl FromIterator<(Body, State)> for MotionColumns {
    fn from_iter<I: IntoIterator<Item = (Body, State)>>(pairs: I) -> Self {
        let mut all = Self::default();
        for (body, state) in pairs {
            let numbers = [body.ell(), body.i1(), body.i3(), body.fillet(), body.theta_end()];
            all.bodies.iter_mut().zip(numbers).for_each(|(column, x)| column.push(x));
            all.states.iter_mut().zip(<[f64; 4]>::from(state)).for_each(|(column, x)| column.push(x));
            let mut circles = [[f64::NAN; 3]; MOST_CIRCLES];
            if body.has_row() {
                circles.iter_mut().zip(body.rows()).for_each(|(to, row)| *to = row);
            }
            all.circles.push(circles);
        }
        if all.circles.iter().all(|circles| circles[0][0].is_nan()) {
            all.circles.clear();
        }
        all
    }
}

impl MotionColumns {
    /// The initial conditions of these motions: without slip and without losses, with the contact of the job.
    pub fn starts(&self) -> MotionStarts<'_> {
        let (bodies, states) = (self.bodies.each_ref(), self.states.each_ref());
        let starts = MotionStarts::of(bodies.map(Vec::as_slice), states.map(Vec::as_slice));
        MotionStarts { circles: &self.circles, ..starts }
    }
}

impl<'a> MotionStarts<'a> {
    /// Bodies and states without slip and without losses, with the contact of the job. The column of bores is not used.
    ///
    /// ```
    /// use spincyl::ensemble::{BodyColumns, Job, MotionOutput, MotionStarts, StateColumns, Summary, roll};
    /// use spincyl::{contact::TableKind, motion::Ask};
    ///
    /// // Hoops that slide upright at unequal speeds roll after unequal times, u/(2 mu).
    /// let bodies = BodyColumns::new(&[0.0], &[0.5], &[1.0]);
    /// let states = StateColumns { theta: &[1.57][..], w1: &[0.0], w2: &[0.0], w3: &[0.0] };
    /// let starts = MotionStarts::new(bodies, states)
    ///     .with_slips(&[0.0], &[0.1, 0.2])
    ///     .with_friction(&[0.3], &[0.3], &[0.0]);
    /// let (mut error, mut method, mut status, mut slides) = ([0.0; 2], [0; 2], [0; 2], [0.0; 2]);
    /// let out = MotionOutput::new(&mut error, &mut method, &mut status).with_summary(Summary::SlipTime, &mut slides);
    /// let job = Job::new(&[0.6]).with_ask(Ask::on(TableKind::Coulomb));
    /// assert!(roll(&starts, &job, out, 1, |_| true)?);
    /// assert!((slides[1] / slides[0] - 2.0).abs() < 0.1, "{slides:?}");
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    pub fn new(bodies: BodyColumns<'a>, states: impl Into<StateColumns<&'a [f64]>>) -> Self {
        let BodyColumns { ell, i1, i3, fillet, theta_end, .. } = bodies;
        Self::of([ell, i1, i3, fillet, theta_end], states.into().into())
    }

    /// Returns these starts on tables with these slopes, and with these angles phi at the start, in radians.
    #[must_use]
    pub fn with_slopes(self, slope: &'a [f64], phi: &'a [f64]) -> Self {
        Self { slopes: Some([slope, phi]), ..self }
    }

    /// Returns these starts with slips along e_h and along e2, in sqrt(g R). Without them there is no slip, and
    /// the centre of a body on its face is at rest under friction.
    #[must_use]
    pub fn with_slips(self, along_lean: &'a [f64], across_lean: &'a [f64]) -> Self {
        Self { slips: Some([along_lean, across_lean]), ..self }
    }

    /// Returns these starts with a coefficient of friction for each motion, in place of that of the job: the
    /// coefficients of sliding and of static friction, and the radius of the patch, as those of
    /// [`Friction::Coulomb`](crate::contact::Friction). Of viscous friction `mu` is c, and of a table without a law of
    /// friction the largest mu of rolling; both leave the other columns unused.
    #[must_use]
    pub fn with_friction(self, mu: &'a [f64], fixed: &'a [f64], patch: &'a [f64]) -> Self {
        Self { coefficients: Some([mu, fixed, patch]), ..self }
    }

    /// Returns these starts with these losses.
    #[must_use]
    pub fn with_losses(self, losses: LossColumns<'a>) -> Self {
        Self { losses: Some(losses), ..self }
    }

    /// Returns these starts in the air, with the heights of the lowest points, in R, and their upward velocities, in sqrt(g R).
    #[must_use]
    pub fn with_aloft(self, height: &'a [f64], lift: &'a [f64]) -> Self {
        Self { aloft: Some([height, lift]), ..self }
    }

    pub(crate) fn of(bodies: [&'a [f64]; 5], states: [&'a [f64]; 4]) -> Self {
        Self {
            bodies,
            states,
            slopes: None,
            slips: None,
            coefficients: None,
            losses: None,
            aloft: None,
            circles: &[],
        }
    }

    fn columns(&self) -> impl Iterator<Item = &'a [f64]> {
        let pairs = self.slips.into_iter().chain(self.aloft).chain(self.slopes).flatten();
        let laws =
            self.coefficients.into_iter().flatten().chain(self.losses.into_iter().flat_map(|all| all.0));
        self.bodies.into_iter().chain(self.states).chain(pairs).chain(laws)
    }

    /// The number of initial states.
    pub fn len(&self) -> usize {
        if self.circles.len() > 1 { self.circles.len() } else { rows(self.columns()) }
    }

    /// Whether there are no initial states.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(super) fn fit(&self) -> bool {
        fit(self.columns(), self.len()) && [0, 1, self.len()].contains(&self.circles.len())
    }

    /// The circles of the body of motion `i`; empty if it has one circle or two equal rims.
    fn circles(&self, i: usize) -> &'a [[f64; 3]] {
        let found = self.circles.get(if self.circles.len() == 1 { 0 } else { i });
        found.filter(|rows| !rows[0][0].is_nan()).map_or(&[], |rows| &rows[..])
    }

    /// Whether the body of motion `i` has several circles, so that the motion is computed alone.
    pub(super) fn has_row(&self, i: usize) -> bool {
        !self.circles(i).is_empty()
    }

    pub(super) fn is_rounded(&self, i: usize) -> bool {
        at(self.bodies[3], i) != 0.0
    }

    /// The body of motion `i`, or the error of an invalid body.
    pub(super) fn body(&self, i: usize) -> Result<Body, Error> {
        let [ell, i1, i3, fillet, theta_end] = self.bodies.map(|x| at(x, i));
        Body::of_rows([ell, i1, i3, f64::NAN, fillet, theta_end], self.circles(i))
    }

    /// The slope of the table of motion `i`, and phi at its start, in radians.
    pub(super) fn slope(&self, i: usize) -> [f64; 2] {
        self.slopes.map_or([0.0; 2], |all| all.map(|x| at(x, i)))
    }

    /// Whether the table of motion `i` is level, and phi at its start is in the accepted range.
    pub(super) fn is_level(&self, i: usize) -> bool {
        let [slope, phi0] = self.slope(i);
        slope == 0.0 && Start::from(self.state(i)).with_heading(phi0).check_place().is_ok()
    }

    pub(super) fn state(&self, i: usize) -> State {
        State::from(self.states.map(|x| at(x, i)))
    }

    pub(super) fn start(&self, i: usize, body: &Body, table: &Table) -> Start {
        let aloft = self.aloft.map(|[height, lift]| AboveTable::new(at(height, i), at(lift, i)));
        let start = Start::from(self.state(i)).with_aloft(aloft).with_heading(self.slope(i)[1]);
        match self.slips {
            Some(slips) => start.with_slip(slips.map(|x| at(x, i)).into()),
            None if table.rubs() => start.at_rest_on_face(body),
            None => start,
        }
    }

    /// Whether a part of the body other than its rim touches the table at the start of motion `i`.
    pub(super) fn is_down(&self, i: usize) -> bool {
        let [ell, _, _, fillet, end] = self.bodies.map(|x| at(x, i));
        self.state(i).theta >= if end.is_nan() { beyond(ell, fillet) } else { end }
    }

    pub(super) fn losses(&self, i: usize) -> Losses {
        self.losses.map_or(Losses::NONE, |all| all.row(i))
    }

    pub(super) fn has_patch(&self) -> bool {
        self.coefficients.is_some_and(|[.., patch]| patch.iter().any(|radius| *radius > 0.0))
    }

    pub(super) fn coefficients(&self, i: usize) -> Option<[f64; 3]> {
        self.coefficients.map(|all| all.map(|x| at(x, i)))
    }
}

coded! {
    /// One number about a motion from time 0 to its end or to the last time.
    pub enum Summary {
        /// Least inclination during the motion, in radians.
        ThetaMin = 0,
        /// Greatest inclination during the motion, in radians.
        ThetaMax = 1,
        /// Least normal force during the motion, in units of the weight.
        NormalMin = 2,
        /// Greatest coefficient of friction that rolling needs; infinite where the normal force vanishes.
        FrictionCoefficientMax = 3,
        /// Period of the nutation, in sqrt(R/g); infinite for a motion without a period.
        Period = 4,
        /// Precession in a period of the nutation, in radians; NaN for a motion without a period.
        PrecessionPerPeriod = 5,
        /// Time of the event that ends the motion, in sqrt(R/g); without an event the last time.
        End = 6,
        /// Total time of slipping, in sqrt(R/g).
        SlipTime = 7,
        /// The heat made by friction, in M g R.
        Dissipated = 8,
        /// The energy taken by the loss laws, in M g R.
        WorkLost = 9,
        /// Number of phases of slipping, rolling, flying and lying.
        Phases = 10,
        /// Time at which the last phase of rolling begins, in sqrt(R/g); this and the next four numbers are NaN if the
        /// body never rolls.
        RollingTime = 11,
        /// The inclination at the time `RollingTime`, in radians.
        RollingTheta = 12,
        /// The angular velocity w1 at the time `RollingTime`, in sqrt(g/R).
        RollingW1 = 13,
        /// The angular velocity w2 at the time `RollingTime`, in sqrt(g/R).
        RollingW2 = 14,
        /// The angular velocity w3 at the time `RollingTime`, in sqrt(g/R).
        RollingW3 = 15,
        /// Number of impacts on the table.
        Impacts = 16,
        /// Number of times at which the body lands and stays on the table for a while.
        Landings = 17,
        /// Total time in the air, in sqrt(R/g).
        AirTime = 18,
        /// Energy lost in impacts, in M g R.
        LostInImpacts = 19,
        /// Code of the [`Kind`](crate::motion::path::Kind) of the last phase.
        LastPhase = 20,
        /// Cosine of the angle from the vertical to the axis of the first rim, at the end of the motion or at the last time.
        AxisUp = 21,
        /// Code of [`RestsOn`](crate::motion::RestsOn), the part on which the body rests at the end.
        RestsOn = 22,
    }
}

/// Number of kinds of [`Summary`].
pub const SUMMARIES: usize = 23;

impl Summary {
    /// The name of the summary in Python and in tables.
    pub fn name(self) -> &'static str {
        self.label()[0]
    }

    /// The unit of the summary, such as "sqrt(R/g)"; "1" for a number without a unit.
    pub fn unit(self) -> &'static str {
        self.label()[1]
    }

    /// The description of the summary in words.
    pub fn description(self) -> &'static str {
        self.label()[2]
    }

    /// Name, unit and description of the summary in words.
    pub(crate) fn label(self) -> [&'static str; 3] {
        match self {
            Self::ThetaMin => ["theta_min", "rad", "least inclination"],
            Self::ThetaMax => ["theta_max", "rad", "greatest inclination"],
            Self::NormalMin => ["normal_min", "M g", "least normal force"],
            Self::FrictionCoefficientMax => {
                ["friction_coefficient_max", "1", "greatest coefficient of friction needed"]
            }
            Self::Period => ["period", "sqrt(R/g)", "period of the nutation"],
            Self::PrecessionPerPeriod => {
                ["precession_per_period", "rad", "precession per period of the nutation"]
            }
            Self::End => ["end", "sqrt(R/g)", "time of the end"],
            Self::SlipTime => ["slip_time", "sqrt(R/g)", "time of slipping"],
            Self::Dissipated => ["dissipated", "M g R", "heat made by friction"],
            Self::WorkLost => ["work_lost", "M g R", "energy lost to the losses"],
            Self::Phases => ["phases", "1", "number of phases of slipping and rolling"],
            Self::RollingTime => ["rolling_time", "sqrt(R/g)", "time when the last rolling begins"],
            Self::RollingTheta => ["rolling_theta", "rad", "inclination at which the last rolling begins"],
            Self::RollingW1 => ["rolling_w1", "sqrt(g/R)", "w1 when the last rolling begins"],
            Self::RollingW2 => ["rolling_w2", "sqrt(g/R)", "w2 when the last rolling begins"],
            Self::RollingW3 => ["rolling_w3", "sqrt(g/R)", "w3 when the last rolling begins"],
            Self::Impacts => ["impacts", "1", "number of impacts"],
            Self::Landings => ["landings", "1", "number of landings after which the body stays"],
            Self::AirTime => ["air_time", "sqrt(R/g)", "time in the air"],
            Self::LostInImpacts => ["lost_in_impacts", "M g R", "energy lost in impacts"],
            Self::LastPhase => ["last_phase", "1", "code of the last phase"],
            Self::AxisUp => ["axis_up", "1", "cosine from the vertical to the axis of the first rim"],
            Self::RestsOn => ["rests_on", "1", "code of spincyl.RestsOn"],
        }
    }

    /// Whether the motions of this job from these starts have this number; otherwise it would be NaN.
    pub fn is_told_by(self, job: &Job<'_>, starts: &MotionStarts<'_>) -> bool {
        self.is_of(job.ask.table.rubs(), starts.losses.is_some(), job.ask.restitution.is_some())
    }

    /// Whether motions have this number. `rubs` means motions under a law of friction, `loses` motions with losses of
    /// energy, and `flies` motions that continue in the air and on both rims.
    pub(crate) fn is_of(self, rubs: bool, loses: bool, flies: bool) -> bool {
        match self {
            Self::End => true,
            Self::WorkLost => loses,
            Self::AxisUp | Self::RestsOn => rubs || loses || flies,
            Self::SlipTime
            | Self::Dissipated
            | Self::Phases
            | Self::RollingTime
            | Self::RollingTheta
            | Self::RollingW1
            | Self::RollingW2
            | Self::RollingW3 => rubs || flies,
            Self::Impacts | Self::Landings | Self::AirTime | Self::LostInImpacts | Self::LastPhase => flies,
            _ => !rubs && !loses && !flies,
        }
    }
}

/// The arrays for the results; a result whose array is `None` is not computed.
#[derive(Debug)]
#[non_exhaustive]
pub struct MotionOutput<'a> {
    /// theta, w1, w2, w3, row-major (motion, time); NaN after the end of a motion.
    pub(crate) states: Option<[&'a mut [f64]; 4]>,
    /// The slips along e_h and along e2, in the same layout as `states`.
    pub(crate) slips: Option<[&'a mut [f64]; 2]>,
    /// The rim to which each state refers, 0 or 1, in the layout of `states`; only for motions with a restitution.
    pub(crate) rims: Option<&'a mut [f64]>,
    /// theta, w1, w2, w3 at the last time, or at the end of a motion that ends before the last time.
    pub(crate) last: Option<[&'a mut [f64]; 4]>,
    /// The slips at the last time, or at the end of a motion that ends before the last time.
    pub(crate) last_slip: Option<[&'a mut [f64]; 2]>,
    /// The rims, 0 or 1, to which the last states refer.
    pub(crate) last_rim: Option<&'a mut [f64]>,
    /// The arrays of the summaries, indexed by [`Summary`]; None for one that is not requested.
    pub(crate) summary: [Option<&'a mut [f64]>; SUMMARIES],
    /// Estimated error of the states of a motion, the largest over all its numbers and times; also over the period and
    /// the precession in a period, if these are requested and exist; with friction or losses also over the slips, the
    /// phases and the end.
    pub(crate) error: &'a mut [f64],
    /// Code of the [`Answer`], the method that computed a motion.
    pub(crate) method: &'a mut [u8],
    /// Code of the [`Ending`] of a motion.
    pub(crate) status: &'a mut [u8],
}

/// The columns for a block of motions, with the number of times of each motion.
pub(super) struct TimedOutput<'a> {
    pub out: MotionOutput<'a>,
    pub times: usize,
}

impl Split for TimedOutput<'_> {
    fn split(self, count: usize) -> (Self, Self) {
        let (out, times) = (self.out, self.times);
        let (states, later_states) = out.states.split(count * times);
        let (slips, later_slips) = out.slips.split(count * times);
        let (rims, later_rims) = out.rims.split(count * times);
        let (last, later_last) = out.last.split(count);
        let (last_slip, later_last_slip) = out.last_slip.split(count);
        let (last_rim, later_last_rim) = out.last_rim.split(count);
        let (summary, later_summary) = out.summary.split(count);
        let (error, later_error) = out.error.split(count);
        let (method, later_method) = out.method.split(count);
        let (status, later_status) = out.status.split(count);
        let later = MotionOutput {
            states: later_states,
            slips: later_slips,
            rims: later_rims,
            last: later_last,
            last_slip: later_last_slip,
            last_rim: later_last_rim,
            summary: later_summary,
            error: later_error,
            method: later_method,
            status: later_status,
        };
        let out =
            MotionOutput { states, slips, rims, last, last_slip, last_rim, summary, error, method, status };
        (Self { out, times }, Self { out: later, times })
    }
}

impl<'a> MotionOutput<'a> {
    /// An output with arrays for the errors, the codes of the methods and the codes of the endings, and no other results.
    pub fn new(error: &'a mut [f64], method: &'a mut [u8], status: &'a mut [u8]) -> Self {
        let summary = [const { None }; SUMMARIES];
        Self {
            states: None,
            slips: None,
            rims: None,
            last: None,
            last_slip: None,
            last_rim: None,
            summary,
            error,
            method,
            status,
        }
    }

    /// Returns this output with arrays of the states, row-major (motion, time); NaN after the end of a motion.
    #[must_use]
    pub fn with_states(self, states: impl Into<StateColumns<&'a mut [f64]>>) -> Self {
        Self { states: Some(states.into().into()), ..self }
    }

    /// Returns this output with arrays of the slips along e_h and along e2, in the layout of the states.
    #[must_use]
    pub fn with_slips(self, along_lean: &'a mut [f64], across_lean: &'a mut [f64]) -> Self {
        Self { slips: Some([along_lean, across_lean]), ..self }
    }

    /// Returns this output with an array of the rims, 0 or 1, to which the states refer, in their layout; only for
    /// motions with a restitution.
    #[must_use]
    pub fn with_rims(self, rims: &'a mut [f64]) -> Self {
        Self { rims: Some(rims), ..self }
    }

    /// Returns this output with arrays of the states at the last time, or at the end.
    #[must_use]
    pub fn with_last(self, last: impl Into<StateColumns<&'a mut [f64]>>) -> Self {
        Self { last: Some(last.into().into()), ..self }
    }

    /// Returns this output with arrays of the slips at the last time, or at the end, along e_h and along e2.
    #[must_use]
    pub fn with_last_slip(self, along_lean: &'a mut [f64], across_lean: &'a mut [f64]) -> Self {
        Self { last_slip: Some([along_lean, across_lean]), ..self }
    }

    /// Returns this output with an array of the rims, 0 or 1, to which the last states refer.
    #[must_use]
    pub fn with_last_rim(self, last_rim: &'a mut [f64]) -> Self {
        Self { last_rim: Some(last_rim), ..self }
    }

    /// Returns this output with an array for the summary `of`.
    #[must_use]
    pub fn with_summary(mut self, of: Summary, column: &'a mut [f64]) -> Self {
        self.summary[of as usize] = Some(column);
        self
    }

    pub(super) fn fits(&self, count: usize, times: usize) -> bool {
        let wide = self.states.iter().flatten().chain(self.slips.iter().flatten()).chain(&self.rims);
        let single = self.last.iter().flatten().chain(self.last_slip.iter().flatten()).chain(&self.last_rim);
        wide.into_iter().all(|x| x.len() == count * times)
            && single.chain(self.summary.iter().flatten()).all(|x| x.len() == count)
            && [self.error.len(), self.method.len(), self.status.len()] == [count; 3]
    }

    pub(super) fn wants(&self, summary: Summary) -> bool {
        self.summary[summary as usize].is_some()
    }

    pub(super) fn put(&mut self, summary: Summary, i: usize, value: f64) {
        if let Some(x) = &mut self.summary[summary as usize] {
            x[i] = value;
        }
    }

    /// Writes a state and a slip as row `row` of the arrays of states, whose rows are (motion, time).
    pub(super) fn put_state(&mut self, row: usize, y: &State, slip: [f64; 2]) {
        put(&mut self.states, row, (*y).into());
        put(&mut self.slips, row, slip);
    }

    /// Writes the state and the slip of motion `i` at its end.
    pub(super) fn put_last(&mut self, i: usize, y: &State, slip: [f64; 2]) {
        put(&mut self.last, i, (*y).into());
        put(&mut self.last_slip, i, slip);
    }

    /// Writes the rims to which the states of motion `i` refer, up to its last state, and the rim at its end.
    pub(super) fn put_rims(&mut self, first: usize, rims: &[u8], (i, last): (usize, u8)) {
        for (to, rim) in self.rims.iter_mut().flat_map(|all| &mut all[first..]).zip(rims) {
            *to = f64::from(*rim);
        }
        if let Some(all) = &mut self.last_rim {
            all[i] = f64::from(last);
        }
    }

    /// Writes for motion `i`, whose states are known, that its contact point is at rest on the first rim.
    pub(super) fn put_rolling(&mut self, i: usize, times: usize) {
        if let Some([theta, ..]) = &self.states {
            for row in i * times..(i + 1) * times {
                let none = if theta[row].is_nan() { f64::NAN } else { 0.0 };
                self.slips.iter_mut().flatten().chain(&mut self.rims).for_each(|column| column[row] = none);
            }
        }
        self.last_slip.iter_mut().flatten().chain(&mut self.last_rim).for_each(|column| column[i] = 0.0);
    }

    /// The arrays of this output, borrowed for a shorter time.
    pub(super) fn reborrowed(&mut self) -> MotionOutput<'_> {
        fn all<'a, const N: usize>(columns: &'a mut Option<[&mut [f64]; N]>) -> Option<[&'a mut [f64]; N]> {
            columns.as_mut().map(|columns| columns.each_mut().map(|x| &mut **x))
        }
        MotionOutput {
            states: all(&mut self.states),
            slips: all(&mut self.slips),
            rims: self.rims.as_deref_mut(),
            last: all(&mut self.last),
            last_slip: all(&mut self.last_slip),
            last_rim: self.last_rim.as_deref_mut(),
            summary: self.summary.each_mut().map(Option::as_deref_mut),
            error: self.error,
            method: self.method,
            status: self.status,
        }
    }

    /// Writes the method, the status and the error of motion `i`.
    pub(super) fn tell(&mut self, i: usize, answer: Answer, status: u8, error: f64) {
        (self.method[i], self.status[i], self.error[i]) = (answer as u8, status, error);
    }

    /// Writes NaN for all numbers of motion `i`, and the code of `ending`, which gives the reason.
    pub(super) fn blank(&mut self, i: usize, times: usize, ending: Ending) {
        for row in i * times..(i + 1) * times {
            self.put_state(row, &State::from([f64::NAN; 4]), [f64::NAN; 2]);
        }
        self.put_last(i, &State::from([f64::NAN; 4]), [f64::NAN; 2]);
        if let Some(all) = &mut self.rims {
            all[i * times..(i + 1) * times].fill(f64::NAN);
        }
        if let Some(all) = &mut self.last_rim {
            all[i] = f64::NAN;
        }
        for column in self.summary.iter_mut().flatten() {
            column[i] = f64::NAN;
        }
        self.tell(i, Answer::None, ending as u8, f64::NAN);
    }

    /// Writes NaN and the ending `Invalid` for motion `i`, whose body or initial state is invalid.
    pub(super) fn refuse(&mut self, i: usize, times: usize) {
        self.blank(i, times, Ending::Invalid);
    }
}

fn put<const N: usize>(columns: &mut Option<[&mut [f64]; N]>, row: usize, numbers: [f64; N]) {
    for (column, x) in columns.iter_mut().flatten().zip(numbers) {
        column[row] = x;
    }
}
