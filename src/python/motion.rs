//! Functions for Python that compute motions; they take plain arrays and return a dictionary of plain arrays.

use super::BODY;
use super::custom::with_laws;
use super::options::{MotionAsked, contact_of, table_of};
use super::stone::{STONE, stone_of};
use super::watch::Watch;
use crate::error::{copied, room};
use crate::laws::contact::patch;
use crate::laws::custom::Custom;
use crate::laws::newton::Force;
use crate::laws::state::drilling_of;
use crate::laws::stone::{Ellipsoid, StoneState};
use crate::laws::topple;
use crate::motions::body::stand::flow::couple_on_face;
use crate::motions::custom;
use crate::motions::exact::Swing;
use crate::motions::motion;
use crate::motions::slope::{energy_beside, energy_of_fall};
use crate::motions::stone;
use crate::motions::turning;
use crate::motions::{AboveTable, Ask, Bounds, Kind, Method, Motion, Moving, Path, RestsOn, Sample, Start};
use crate::{Body, Error, State};
use nalgebra::Vector3;
use numpy::ndarray::ArrayView2;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::BTreeMap;

/// An array for Python with its name and its numbers, row by row.
struct NamedArray {
    pub name: &'static str,
    pub numbers: Vec<f64>,
    /// Number of columns; 0 for a one-dimensional array.
    pub width: usize,
}

/// Number of rows that are written between two calls of `go_on`.
const ROWS: usize = 1 << 12;

/// The arrays of a motion for Python, written row by row for as long as `go_on` returns true.
struct ArrayRows<'a> {
    count: usize,
    columns: Vec<NamedArray>,
    goes_on: bool,
    go_on: &'a mut dyn FnMut() -> bool,
}

impl ArrayRows<'_> {
    fn add(
        &mut self,
        name: &'static str,
        width: usize,
        row: &dyn Fn(usize, &mut Vec<f64>),
    ) -> Result<(), Error> {
        let mut numbers = room(self.count * width.max(1))?;
        for i in 0..self.count {
            self.goes_on = self.goes_on && (i % ROWS != 0 || (self.go_on)());
            if !self.goes_on {
                break;
            }
            row(i, &mut numbers);
        }
        self.columns.push(NamedArray { name, numbers, width });
        Ok(())
    }
}

/// A couple as a function of a state and its slip.
type CoupleOfSlip<S> = Box<dyn Fn(&S, [f64; 2]) -> f64>;

/// A state whose motions can be converted to arrays for Python.
trait StateArrays: Moving + Sized {
    type Body;
    /// Whether bodies of this kind have rims, of which two may touch the table.
    const RIMS: bool;
    /// Adds the arrays of the states, poses and forces.
    fn add_arrays(m: &Motion<Self>, body: &Self::Body, rows: &mut ArrayRows<'_>) -> Result<(), Error>;
    /// The component of the angular velocity about the vertical.
    fn drilling(&self) -> f64;
    /// The normal component of a force.
    fn normal(force: &Self::Force) -> f64;
    /// The couple of friction on a body that stands on its face, as a function of a state and its slip.
    fn couple_on_face(_: &Self::Body, _: &Ask) -> CoupleOfSlip<Self> {
        Box::new(|_, _| f64::NAN)
    }
    /// The energy at an index minus that on a level table at rest; None on a level table at rest.
    fn beside(_: &Motion<Self>, _: &Self::Body, _: &Ask, _: usize) -> Option<f64> {
        None
    }
    /// The part on which a body of revolution rests at the end.
    fn rests_on(_: &Motion<Self>, _: &Self::Body) -> RestsOn {
        RestsOn::None
    }
}

impl StateArrays for State {
    type Body = Body;
    const RIMS: bool = true;

    fn add_arrays(m: &Motion, body: &Body, rows: &mut ArrayRows<'_>) -> Result<(), Error> {
        rows.add("theta", 0, &|i, to| to.push(m.states[i].theta))?;
        rows.add("w", 3, &|i, to| to.extend([m.states[i].w1, m.states[i].w2, m.states[i].w3]))?;
        if let Some(poses) = &m.poses {
            rows.add("phi", 2, &|i, to| to.extend([poses[i].phi.turns, poses[i].phi.rest]))?;
            rows.add("psi", 2, &|i, to| to.extend([poses[i].psi.turns, poses[i].psi.rest]))?;
            let point = |i: usize| poses[i].contact_point;
            rows.add("contact_point", 2, &|i, to| to.extend([point(i).x, point(i).y]))?;
            let centre = |i: usize| m.sample(i).centre(body).map(|at| <[f64; 3]>::from(at.coords));
            rows.add("centre", 3, &|i, to| to.extend(centre(i).unwrap_or([f64::NAN; 3])))?;
            let turned = |i: usize| m.sample(i).orientation().map(|q| <[f64; 4]>::from(q.coords));
            rows.add("orientation", 4, &|i, to| to.extend(turned(i).unwrap_or([f64::NAN; 4])))?;
        }
        if let Some(forces) = &m.forces {
            rows.add("normal", 0, &|i, to| to.push(forces[i].normal))?;
            rows.add("friction", 0, &|i, to| to.push(forces[i].friction()))?;
            rows.add("friction_coefficient", 0, &|i, to| to.push(forces[i].friction_coefficient()))?;
            if let Some(path) = &m.path
                && path.phases.iter().any(|phase| phase.kind == Kind::OnItsFace)
            {
                rows.add("pressure", 2, &|i, to| {
                    to.extend(pressure_at(body, path, (m.states[i], forces[i]), i))
                })?;
            }
            if m.poses.is_some() {
                let told = |force: Option<Vector3<f64>>| force.map_or([f64::NAN; 3], <[f64; 3]>::from);
                let (whole, other) = (Sample::force_in_laboratory, Sample::force_on_other_rim);
                rows.add("contact_force", 3, &|i, to| to.extend(told(whole(&m.sample(i)))))?;
                if m.path.as_ref().is_some_and(|path| path.goes_on) {
                    rows.add("contact_force_other", 3, &|i, to| to.extend(told(other(&m.sample(i)))))?;
                }
            }
        }
        Ok(())
    }

    fn couple_on_face(body: &Body, ask: &Ask) -> CoupleOfSlip<Self> {
        Box::new(couple_on_face(body, ask))
    }

    fn beside(m: &Motion, body: &Body, ask: &Ask, i: usize) -> Option<f64> {
        energy_beside(body, ask, m, i)
    }

    fn rests_on(m: &Motion, body: &Body) -> RestsOn {
        m.rests_on(body)
    }

    fn drilling(&self) -> f64 {
        let (s, c) = self.theta.sin_cos();
        drilling_of((s, c), self.w1, self.w3)
    }

    fn normal(force: &Self::Force) -> f64 {
        force.normal
    }
}

impl StateArrays for StoneState {
    type Body = Ellipsoid;
    const RIMS: bool = false;

    fn add_arrays(m: &Motion<Self>, _: &Ellipsoid, rows: &mut ArrayRows<'_>) -> Result<(), Error> {
        rows.add("theta", 0, &|i, to| to.push(m.states[i].theta()))?;
        rows.add("w", 3, &|i, to| to.extend(m.states[i].w))?;
        rows.add("vertical", 3, &|i, to| to.extend(m.states[i].vertical))?;
        if let Some(poses) = &m.poses {
            let point = |i: usize| poses[i].contact_point;
            rows.add("contact_point", 2, &|i, to| to.extend([point(i).x, point(i).y]))?;
            rows.add("centre", 3, &|i, to| to.extend(poses[i].centre))?;
            rows.add("orientation", 4, &|i, to| to.extend(poses[i].orientation.coords.iter()))?;
        }
        if let Some(forces) = &m.forces {
            let friction = |i: usize| forces[i].x.hypot(forces[i].y);
            rows.add("normal", 0, &|i, to| to.push(forces[i].z))?;
            rows.add("friction", 0, &|i, to| to.push(friction(i)))?;
            let flies = |i: usize| m.path.as_ref().is_some_and(|path| path.kinds[i] == Kind::Flying);
            let need = |i: usize| match forces[i].z {
                normal if normal > 0.0 => friction(i) / normal,
                _ if flies(i) => f64::NAN,
                _ => f64::INFINITY,
            };
            rows.add("friction_coefficient", 0, &|i, to| to.push(need(i)))?;
            if m.poses.is_some() {
                rows.add("contact_force", 3, &|i, to| to.extend(forces[i].iter()))?;
            }
        }
        Ok(())
    }

    fn beside(m: &Motion<Self>, _: &Ellipsoid, ask: &Ask, i: usize) -> Option<f64> {
        let [x, _, z] = m.poses.as_ref()?[i].centre;
        Some(energy_of_fall(ask, m, i, [x, z]))
    }

    fn drilling(&self) -> f64 {
        self.spin()
    }

    fn normal(force: &Self::Force) -> f64 {
        force.z
    }
}

/// The output arrays of a motion for Python; None if `go_on` returns false.
#[inline(never)] // its frame is not on the stack of the motion
fn motion_columns<S: StateArrays>(
    m: &Motion<S>,
    body: &S::Body,
    (ask, loses): (&Ask, bool),
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Vec<NamedArray>>, Error> {
    let mut rows = ArrayRows { count: m.times.len(), columns: Vec::new(), goes_on: true, go_on };
    rows.add("t", 0, &|i, to| to.push(m.times[i]))?;
    S::add_arrays(m, body, &mut rows)?;
    if let Some(path) = &m.path
        && !path.aloft.is_empty()
    {
        rows.add("height", 0, &|i, to| to.push(path.aloft[i].height))?;
        rows.add("lift", 0, &|i, to| to.push(path.aloft[i].lift))?;
    }
    if let Some(path) = &m.path
        && S::RIMS
        && !path.aloft.is_empty()
    {
        rows.add("slip_other", 2, &|i, to| to.extend(path.other_rim[i].slip.pair()))?;
        if m.forces.is_some() {
            rows.add("normal_other", 0, &|i, to| to.push(path.other_rim[i].force.normal))?;
            rows.add("friction_other", 0, &|i, to| to.push(path.other_rim[i].force.friction()))?;
        }
    }
    if let Some(path) = &m.path
        && rubs(ask)
    {
        rows.add("slip", 2, &|i, to| to.extend(path.slip[i].pair()))?;
        rows.add("dissipated", 0, &|i, to| to.push(path.dissipated[i]))?;
    }
    if !ask.is_level() && m.poses.is_some() {
        rows.add("beside", 0, &|i, to| to.push(S::beside(m, body, ask, i).unwrap_or(f64::NAN)))?;
    }
    let friction = ask.table.friction();
    if let Some(path) = &m.path
        && friction.patch() > 0.0
        && path.phases.iter().all(|phase| phase.kind != Kind::OnItsFace)
    {
        let drilling = |i: usize| m.states[i].drilling() - ask.turning;
        let creep = |i: usize| {
            let speed = path.slip[i].speed();
            if speed > 0.0 { speed / (friction.patch() * drilling(i).abs()) } else { 0.0 }
        };
        rows.add("drilling", 0, &|i, to| to.push(drilling(i)))?;
        rows.add("creep", 0, &|i, to| to.push(creep(i)))?;
        if let Some(forces) = &m.forces {
            let most = |i: usize| friction.strength() * friction.patch() * S::normal(&forces[i]);
            let couple = |i: usize| match path.kinds[i] {
                Kind::Slipping => -(drilling(i).signum() * most(i) * patch::of(creep(i)).couple),
                _ => f64::NAN,
            };
            rows.add("couple", 0, &|i, to| to.push(couple(i)))?;
        }
    }
    if let Some(path) = &m.path
        && m.forces.is_some()
        && path.phases.iter().any(|phase| phase.kind == Kind::OnItsFace)
    {
        let couple = S::couple_on_face(body, ask);
        let of = |i: usize| match path.kinds[i] {
            Kind::OnItsFace => couple(&m.states[i], path.slip[i].pair()),
            _ => f64::NAN,
        };
        rows.add("couple", 0, &|i, to| to.push(of(i)))?;
    }
    if let Some(path) = &m.path
        && loses
    {
        rows.add("work_lost", 0, &|i, to| to.push(path.work_lost[i]))?;
    }
    Ok(rows.goes_on.then_some(rows.columns))
}

/// The centre of the pressure on the face at the output time with the index `i`; NaN while the body is not on its face.
fn pressure_at(body: &Body, path: &Path, (y, force): (State, Force), i: usize) -> [f64; 2] {
    if path.kinds[i] != Kind::OnItsFace {
        return [f64::NAN; 2];
    }
    topple::pressure_centre(&body.told_at(y.theta), y.theta, &force)
}

/// The numbers that describe a body of revolution, or a stone.
#[derive(FromPyObject)]
pub enum AnyBody {
    Rim((f64, f64, f64, f64, f64, f64)),
    Stone([f64; STONE]),
}

/// The numbers of a state of a body of revolution, or of a stone.
#[derive(FromPyObject)]
pub enum AnyState {
    Rim((f64, f64, f64, f64)),
    Stone([f64; 6]),
}

/// Computes the motion of a body or of a stone. `asked` has the options by name (see `motion_options`), such as t0,
/// slip, table and losses; without step and tol the motion is computed to the accuracy of double precision.
#[pyfunction]
pub fn roll<'py>(
    py: Python<'py>,
    body: AnyBody,
    state: AnyState,
    times: PyReadonlyArray1<'py, f64>,
    asked: MotionAsked,
) -> PyResult<Bound<'py, PyDict>> {
    let (times, start) = (times.as_slice()?, (asked.slip.unwrap_or_default().into(), asked.t0));
    let ask = asked.ask()?;
    let loses = asked.couple.is_some() || asked.drive.is_some() || !ask.losses.is_none();
    match (body, state) {
        (AnyBody::Rim(body), AnyState::Rim(state)) => {
            let body = Body::of_rows(body.into(), &asked.circles)?;
            let state = State::from(<[f64; 4]>::from(state));
            let start = Start::from(state)
                .with_slip(start.0)
                .with_time(start.1)
                .with_aloft(asked.aloft.map(AboveTable::from));
            let start = start.with_heading(asked.heading).with_place(asked.place);
            let rests = asked.slip.is_none() && ask.table.rubs();
            let start = if rests { start.at_rest_on_face(&body) } else { start };
            if asked.is_custom() {
                return under_own_laws(py, (&body, &asked), (&ask, loses), |laws, go_on| {
                    custom::roll_with(&body, start, times, &ask, laws, go_on)
                });
            }
            motion_as_dictionary(py, &body, (&ask, loses), |watch| {
                motion::roll_with(&body, start, times, &ask, || watch.still())
            })
        }
        (AnyBody::Stone(stone), AnyState::Stone([a, b, c, d, e, f])) => {
            let stone = stone_of(&stone)?;
            let state = StoneState { vertical: [a, b, c], w: [d, e, f] };
            let start = Start::from(state)
                .with_slip(start.0)
                .with_time(start.1)
                .with_aloft(asked.aloft.map(AboveTable::from));
            let start = start.with_heading(asked.heading).with_place(asked.place);
            if asked.is_custom() {
                return under_own_laws(py, (&stone, &asked), (&ask, loses), |laws, go_on| {
                    custom::roll_stone(&stone, start, times, &ask, laws, go_on)
                });
            }
            motion_as_dictionary(py, &stone, (&ask, loses), |watch| {
                stone::roll(&stone, start, times, &ask, || watch.still())
            })
        }
        _ => Err(PyValueError::new_err(
            "state: expected a State for a body of revolution, an EllipsoidState for a stone",
        )),
    }
}

/// Computes the motion of a body or a stone under user-defined laws; only laws that are Python functions need the GIL.
fn under_own_laws<'py, S: StateArrays + Send + Sync>(
    py: Python<'py>,
    (body, asked): (&S::Body, &MotionAsked),
    (ask, loses): (&Ask, bool),
    roll: impl Fn(Custom<'_>, &mut dyn FnMut() -> bool) -> Result<Option<Motion<S>>, Error> + Sync,
) -> PyResult<Bound<'py, PyDict>>
where
    S::Body: Sync,
    Motion<S>: Send,
{
    if !asked.calls_python() {
        let pointed = asked.pointed();
        return motion_as_dictionary(py, body, (ask, loses), |watch| {
            roll(pointed.custom(), &mut || watch.still())
        });
    }
    let mut watch = Watch::new(None);
    let rolled = with_laws(py, asked, |laws| roll(laws, &mut || watch.still()))?;
    watch.done(py)?;
    let m = rolled?.ok_or_else(|| PyRuntimeError::new_err("the motion was interrupted"))?;
    let columns = motion_columns(&m, body, (ask, loses), &mut || true)?.unwrap_or_default();
    dictionary(py, (&m, body), columns, rubs(ask))
}

/// The least spin with which a top turns over within a time, with friction on the table, or ValueError.
#[pyfunction]
pub fn turning_spin(
    py: Python<'_>,
    table: u8,
    coefficients: [f64; 3],
    lean: f64,
    time: Option<f64>,
    body: [f64; BODY],
) -> PyResult<f64> {
    let (top, friction) = (Body::of_numbers(body)?, table_of(table)?.with(coefficients).friction());
    let mut watch = Watch::new(None);
    let found = py.detach(|| turning::turning_spin(&top, friction, lean, time, || watch.still()))?;
    watch.done(py)?;
    found.ok_or_else(|| PyRuntimeError::new_err("the search was interrupted"))
}

/// The least spin with which a lying egg rises within a time, with friction on the table, or by Jellett's number, or
/// ValueError.
#[pyfunction]
pub fn rising_spin(
    py: Python<'_>,
    table: Option<u8>,
    coefficients: [f64; 3],
    lean: f64,
    time: Option<f64>,
    stone: [f64; STONE],
) -> PyResult<f64> {
    let egg = stone_of(&stone)?;
    let Some(table) = table else { return Ok(turning::jellett_rising_spin(&egg)?) };
    let friction = table_of(table)?.with(coefficients).friction();
    let mut watch = Watch::new(None);
    let found = py.detach(|| turning::rising_spin(&egg, friction, lean, time, || watch.still()))?;
    watch.done(py)?;
    found.ok_or_else(|| PyRuntimeError::new_err("the search was interrupted"))
}

/// Whether a motion is computed under a law of friction, and so has a slip and phases.
fn rubs(ask: &Ask) -> bool {
    ask.table.rubs() || ask.restitution.is_some()
}

/// Computes a motion with the GIL released, and converts it to a dictionary.
fn motion_as_dictionary<'py, S: StateArrays + Send + Sync>(
    py: Python<'py>,
    body: &S::Body,
    (ask, loses): (&Ask, bool),
    roll: impl FnOnce(&mut Watch) -> Result<Option<Motion<S>>, Error> + Send,
) -> PyResult<Bound<'py, PyDict>>
where
    S::Body: Sync,
    Motion<S>: Send,
{
    let mut watch = Watch::new(None);
    let found = py.detach(|| {
        let Some(motion) = roll(&mut watch)? else { return Ok(None) };
        let columns = motion_columns(&motion, body, (ask, loses), &mut || watch.still())?;
        Ok::<_, Error>(columns.map(|columns| (motion, columns)))
    })?;
    watch.done(py)?;
    let Some((m, columns)) = found else { return Err(PyRuntimeError::new_err("the motion was interrupted")) };
    dictionary(py, (&m, body), columns, rubs(ask))
}

/// The dictionary for Python: the arrays, the end of the motion, the method and the error estimates.
#[inline(never)]
fn dictionary<'py, S: StateArrays>(
    py: Python<'py>,
    (m, body): (&Motion<S>, &S::Body),
    columns: Vec<NamedArray>,
    rubs: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let (out, extra) = (PyDict::new(py), PyDict::new(py));
    for NamedArray { name, numbers, width } in columns {
        let rows = m.times.len();
        let to = if FIELDS.contains(&name) { &out } else { &extra };
        match width {
            // Copying a few numbers is faster than passing the vector to NumPy.
            0 if rows <= FEW => to.set_item(name, PyArray1::from_slice(py, &numbers))?,
            0 => to.set_item(name, PyArray1::from_vec(py, numbers))?,
            _ if rows <= FEW => {
                let rows = ArrayView2::from_shape((rows, width), &numbers).expect("rows of this width");
                to.set_item(name, PyArray2::from_array(py, &rows))?;
            }
            _ => to.set_item(name, PyArray1::from_vec(py, numbers).reshape([rows, width])?)?,
        }
    }
    out.set_item(intern!(py, "status"), m.ending() as u8)?;
    if let Some(event) = m.event {
        let numbers = event.state.numbers().as_ref().to_vec();
        let slip = m.path.as_ref().filter(|_| rubs).map(|path| path.last_slip.pair());
        out.set_item(intern!(py, "event"), (event.time, numbers, slip, event.rim))?;
    }
    let (method, setting) = match m.method {
        Method::Step(h) => (intern!(py, "rk4"), h),
        Method::Tolerance(tol) => (intern!(py, "dop853"), tol),
        Method::Exact => (intern!(py, "exact"), f64::NAN),
    };
    out.set_item(intern!(py, "_rests"), S::rests_on(m, body) as u8)?;
    out.set_item(intern!(py, "method"), method)?;
    out.set_item(intern!(py, "_setting"), setting)?;
    out.set_item(intern!(py, "error"), m.error)?;
    out.set_item(intern!(py, "pose_error"), m.pose_error)?;
    out.set_item(intern!(py, "force_error"), m.force_error)?;
    out.set_item(intern!(py, "step_loss"), m.step_loss)?;
    out.set_item(intern!(py, "advice"), m.advice)?;
    out.set_item(intern!(py, "coarse"), m.coarse)?;
    out.set_item(intern!(py, "nfev"), m.evaluations)?;
    if let Some(limit) = m.limit {
        out.set_item(intern!(py, "_limit"), (limit.to_string(), limit.reason()))?;
    }
    if let Some(path) = &m.path
        && path.known_until < f64::INFINITY
    {
        out.set_item(intern!(py, "_known_until"), path.known_until)?;
    }
    let rims = match m.circle {
        Some(circle) => vec![circle; m.times.len()],
        None => m.path.as_ref().map_or(Ok(Vec::new()), |path| copied(&path.rims))?,
    };
    if S::RIMS && !rims.is_empty() {
        extra.set_item("rim", PyArray1::<u8>::from_vec(py, rims))?;
    }
    if let Some(path) = &m.path
        && rubs
    {
        let mut codes = room(path.kinds.len())?;
        codes.extend(path.kinds.iter().map(|kind| *kind as u8));
        extra.set_item(intern!(py, "phase"), PyArray1::<u8>::from_vec(py, codes))?;
        let row = 7 + path.phases.first().map_or(0, |phase| phase.state.numbers().as_ref().len());
        let mut phases = room(path.phases.len() * row)?;
        for phase in &path.phases {
            phases.extend([phase.time, f64::from(phase.kind as u8), f64::from(phase.rim)]);
            phases.extend(
                phase
                    .slip
                    .pair()
                    .iter()
                    .chain(&<[f64; 2]>::from(phase.aloft))
                    .chain(phase.state.numbers().as_ref()),
            );
        }
        out.set_item(
            intern!(py, "_phases"),
            PyArray1::from_vec(py, phases).reshape([path.phases.len(), row])?,
        )?;
        let row = 9 + path.impacts.first().map_or(0, |at| 2 * (3 + at.states[0].numbers().as_ref().len()));
        let mut impacts = room(path.impacts.len() * row)?;
        for at in &path.impacts {
            let codes = [at.rim, at.hit as u8, bool::from(at.after).into()].map(f64::from);
            impacts.push(at.time);
            impacts.extend(codes.iter().chain(&[at.lost]).chain(&at.impulse).chain(&[at.couple]));
            for (state, velocity) in at.states.iter().zip(&at.velocities) {
                impacts.extend(state.numbers().as_ref().iter().chain(velocity));
            }
        }
        let impacts = PyArray1::from_vec(py, impacts).reshape([path.impacts.len(), row])?;
        out.set_item(intern!(py, "_impacts"), impacts)?;
    }
    out.set_item(intern!(py, "_extra"), extra)?;
    Ok(out)
}

/// The bounds of the errors of a motion by name; `Bounds::of` explains the arguments.
#[pyfunction]
pub fn bounds(errors: [f64; 3], size: [f64; 2], most: [f64; 3]) -> BTreeMap<&'static str, f64> {
    let of = Bounds::of(errors, size, most);
    BTreeMap::from([
        ("state", of.state),
        ("position", of.position),
        ("orientation", of.orientation),
        ("velocity", of.velocity),
        ("angular_velocity", of.angular_velocity),
        ("force", of.force),
        ("energy", of.energy),
    ])
}

/// The arrays that are entries of the dictionary itself; all other arrays are in its entry `_extra`.
const FIELDS: [&str; 3] = ["t", "theta", "w"];

/// The largest number of rows that are copied; longer vectors are passed to NumPy.
const FEW: usize = 64;

/// The eight numbers of a nutation: period, least and greatest theta, phi and psi per period, drift per period, radius
/// of the circle of the drift, and error of the period. The last five are NaN for a motion without a period.
#[pyfunction]
pub fn swing(body: [f64; BODY], state: [f64; 4], contact: u8) -> PyResult<[f64; 8]> {
    let swing = Swing::with_pose(&Body::of_numbers(body)?, &State::from(state), contact_of(contact)?)?;
    let [low, high] = swing.turning_points();
    let [phi, psi] =
        swing.angles_per_period().map_or([f64::NAN; 2], |angles| [angles.precession, angles.spin]);
    let [drift, radius] = swing.drift().map_or([f64::NAN; 2], |drift| [drift.step, drift.radius]);
    Ok([swing.period(), low, high, phi, psi, drift, radius, swing.period_error()])
}
