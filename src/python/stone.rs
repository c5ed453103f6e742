//! Functions for Python: the numbers and constructors of stones, the rocking of an upright spin, and many motions.

use super::columns::{GivenColumns, code_column, numbers};
use super::custom::with_laws;
use super::options::MotionAsked;
use super::watch::Watch;
use crate::Error;
use crate::laws::loss::{COUNT, Law, Losses};
use crate::laws::stone::{Ellipsoid, StoneState};
use crate::many::motions::CustomLaws;
use crate::many::stones::{StoneRow, StoneSummary, many_custom};
use crate::states::steady::MOST;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Number of inputs that describe a stone: three semi-axes, the moments 11, 22, 33, 23, 13 and 12, the three numbers of
/// the offset, and theta_end.
pub const STONE: usize = 13;

pub fn stone_of(x: &[f64; STONE]) -> Result<Ellipsoid, Error> {
    Ellipsoid::of_numbers(*x)
}

/// The 13 numbers of a stone in natural units, and its largest semi-axis in the unit of the given lengths.
fn numbers_and_unit(stone: &Ellipsoid) -> ([f64; STONE], f64) {
    (stone.numbers(), stone.unit())
}

/// The results of an elementwise function as an array of fixed length, whose other elements are NaN.
fn first_results<const N: usize>(found: [f64; N]) -> [f64; MOST] {
    core::array::from_fn(|k| found.get(k).copied().unwrap_or(f64::NAN))
}

/// A function of a stone, for `x` that begins with the numbers of the stone; NaN if there is no such stone.
fn of_stone<const N: usize>(x: &[f64], f: impl Fn(&Ellipsoid, &[f64]) -> [f64; N]) -> [f64; MOST] {
    let stone = x.first_chunk().map(stone_of);
    stone.and_then(Result::ok).map_or([f64::NAN; MOST], |stone| first_results(f(&stone, &x[STONE..])))
}

fn state(x: &[f64]) -> StoneState {
    StoneState { vertical: [x[0], x[1], x[2]], w: [x[3], x[4], x[5]] }
}

/// The vertical along the axes of a tilted stone: `x` has the angles pitch and roll, in radians.
pub fn vertical_of_tilt(x: &[f64]) -> [f64; MOST] {
    first_results(StoneState::spinning(0.0, x[0], x[1]).vertical)
}

/// The angles, in radians, from the vertical to the axes of a stone: `x` has the vertical along these axes.
pub fn inclinations(x: &[f64]) -> [f64; MOST] {
    first_results(StoneState { vertical: [x[0], x[1], x[2]], w: [0.0; 3] }.inclinations())
}

/// The angular velocity about the vertical: `x` has the vertical and w.
pub fn spin(x: &[f64]) -> f64 {
    state(x).spin()
}

/// The vector from the centre of mass to the lowest point: `x` has the numbers of a stone and a vertical.
pub fn lever(x: &[f64]) -> [f64; MOST] {
    of_stone(x, |stone, y| stone.lowest_point([y[0], y[1], y[2]]))
}

/// The slip of a stone whose centre of mass is at rest: `x` has the numbers of the stone, a vertical and w.
pub fn slip(x: &[f64]) -> [f64; MOST] {
    of_stone(x, |stone, y| stone.slip(&state(y), [0.0; 2]).pair())
}

/// The names of the numbers of a stone.
#[pyfunction]
pub fn stone_names() -> [&'static str; STONE] {
    Ellipsoid::NAMES
}

/// Number of inputs from which a stone is made: three semi-axes, the tensor of inertia row by row, the three numbers of
/// the offset, and theta_end.
const GIVEN: usize = 16;

/// The stone with these 16 numbers, with lengths in any unit.
fn given_stone(numbers: &[f64; GIVEN]) -> Result<Ellipsoid, Error> {
    let [a, b, c, tensor @ .., x, y, z, end] = *numbers;
    let [i, j, k, l, m, n, o, p, q] = tensor;
    Ellipsoid::new([a, b, c], [[i, j, k], [l, m, n], [o, p, q]], [x, y, z])?.with_edge(end)
}

/// The numbers of a stone from lengths in any unit, its largest semi-axis in that unit, and its `Ellipsoid::reach`.
#[pyfunction]
pub fn check_stone(numbers: [f64; GIVEN]) -> PyResult<([f64; STONE], f64, f64)> {
    let stone = given_stone(&numbers)?;
    Ok((stone.numbers(), stone.unit(), stone.reach()))
}

/// Like `check_stone`, for many stones, one in each row: numbers, largest semi-axis and reach; NaN where the stone is
/// invalid.
#[pyfunction]
pub fn check_stones<'py>(
    py: Python<'py>,
    given: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let mut found = Vec::with_capacity(given.shape()[0] * (STONE + 2));
    for row in given.as_array().rows() {
        match given_stone(&core::array::from_fn(|i| row[i])) {
            Ok(stone) => {
                found.extend(stone.numbers());
                found.extend([stone.unit(), stone.reach()]);
            }
            Err(_) => found.extend([f64::NAN; STONE + 2]),
        }
    }
    PyArray1::from_vec(py, found).reshape([given.shape()[0], STONE + 2])
}

/// The 13 numbers of a uniform ellipsoid, and its largest semi-axis in the unit of the given lengths.
#[pyfunction]
pub fn uniform_stone(axes: [f64; 3]) -> PyResult<([f64; STONE], f64)> {
    Ok(numbers_and_unit(&Ellipsoid::uniform(axes)?))
}

/// The 13 numbers of a rattleback, and its largest semi-axis in the unit of the given lengths.
#[pyfunction]
pub fn rattleback(
    axes: [f64; 3],
    moments: Option<[f64; 3]>,
    twist: f64,
    offset: Option<[f64; 3]>,
) -> PyResult<([f64; STONE], f64)> {
    Ok(numbers_and_unit(&Ellipsoid::rattleback(axes, moments, twist, offset)?))
}

/// The 13 numbers of an egg, and its largest semi-axis in the unit of the given lengths.
#[pyfunction]
pub fn egg(radius: f64, half_length: f64, offset: f64) -> PyResult<([f64; STONE], f64)> {
    Ok(numbers_and_unit(&Ellipsoid::egg(radius, half_length, offset)?))
}

/// The principal moments of a stone, in ascending order.
#[pyfunction]
pub fn stone_moments(stone: [f64; STONE]) -> PyResult<[f64; 3]> {
    Ok(stone_of(&stone)?.moments())
}

/// Growth and frequency of both modes, slow and fast, then real and imaginary parts of the four eigenvalues, for a
/// stone that spins upright.
#[pyfunction]
pub fn rocking(stone: [f64; STONE], spin: f64) -> PyResult<[f64; 12]> {
    let found = stone_of(&stone)?.rocking(spin)?;
    let mut all = [0.0; 12];
    all[..2].copy_from_slice(&found.growth);
    all[2..4].copy_from_slice(&found.frequency);
    all[4..].copy_from_slice(found.eigenvalues.map(|x| [x.re, x.im]).as_flattened());
    Ok(all)
}

/// The rates of spin, in sqrt(g/a), at which a stone that spins upright becomes stable or unstable.
#[pyfunction]
pub fn spin_limits(stone: [f64; STONE]) -> PyResult<Vec<f64>> {
    Ok(stone_of(&stone)?.spin_limits()?)
}

/// Kinetic and potential energies of a stone in many states: vertical (3), w (3) and slip (2) of each.
#[pyfunction]
pub fn stone_energies(stone: [f64; STONE], states: Vec<[f64; 8]>, smooth: bool) -> PyResult<Vec<f64>> {
    let stone = stone_of(&stone)?;
    let energy = |&[a, b, c, d, e, f, u, v]: &[f64; 8]| {
        let state = StoneState { vertical: [a, b, c], w: [d, e, f] };
        stone.energy_slipping(&state, [u, v], smooth)
    };
    Ok(states.iter().map(energy).collect())
}

/// The names of the coefficients of the loss laws that act on stones.
#[pyfunction]
pub fn stone_losses() -> Vec<&'static str> {
    let acts = |law: &Law| Losses::of(*law, 1.0).check_for_stone().is_ok();
    Law::ALL.iter().copied().filter(acts).map(Law::parameter).collect()
}

/// Unit and description of each output of many motions of stones, in the order of `StoneSummary::NAMES`.
const STONE_LABELS: [[&str; 2]; StoneSummary::NAMES.len()] = [
    ["1", "vertical along axis 1 at the end"],
    ["1", "vertical along axis 2 at the end"],
    ["1", "vertical along axis 3 at the end"],
    ["sqrt(g/a)", "angular velocity along axis 1 at the end"],
    ["sqrt(g/a)", "angular velocity along axis 2 at the end"],
    ["sqrt(g/a)", "angular velocity along axis 3 at the end"],
    ["sqrt(a/g)", "time of the end"],
    ["sqrt(g/a)", "angular velocity about the vertical at the end"],
    ["1", "number of reversals of the spin"],
    ["sqrt(a/g)", "time of the first reversal of the spin"],
    ["M g a", "heat of friction"],
    ["M g a", "energy lost to the losses"],
    ["1", "number of impacts"],
    ["1", "number of landings after which the body stays"],
    ["sqrt(a/g)", "time in the air"],
    ["M g a", "energy lost in impacts"],
    ["1", "code of the last phase"],
    ["1", "largest estimated error among the numbers of the state"],
    ["sqrt(a/g)", "time up to which the motion is known"],
];

/// Name, unit and description of each output of many motions of stones.
#[pyfunction]
pub fn stone_columns() -> Vec<[&'static str; 3]> {
    StoneSummary::NAMES
        .into_iter()
        .zip(STONE_LABELS)
        .map(|(name, [unit, about])| [name, unit, about])
        .collect()
}

/// Computes the motions of many stones from many initial states to the last of the times, and writes the output columns
/// that `out` contains.
#[pyfunction]
pub fn stones<'py>(
    py: Python<'py>,
    given: &Bound<'py, PyDict>,
    times: PyReadonlyArray1<'py, f64>,
    asked: MotionAsked,
    out: &Bound<'py, PyDict>,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<()> {
    let columns = GivenColumns::of(given)?;
    let body: [&[f64]; STONE] = columns.all(Ellipsoid::NAMES)?;
    let state: [&[f64]; 6] = columns.all(["n1", "n2", "n3", "w1", "w2", "w3"])?;
    let slip: [&[f64]; 2] = columns.all(["slip_x", "slip_y"])?;
    let friction = columns.some(["coefficient", "static", "patch"])?;
    let lost = columns.some(core::array::from_fn::<_, COUNT, _>(|i| Law::ALL[i].parameter()))?;
    let slopes = columns.some(["slope", "phi0"])?;
    let aloft = columns.some(["height", "lift"])?;
    let mut status = code_column(out, "status")?;
    let status = status.as_slice_mut()?;
    let count = status.len();
    let at = |column: &[f64], i: usize| column[if column.len() == 1 { 0 } else { i }];
    let row = |i: usize| StoneRow {
        stone: body.map(|column| at(column, i)),
        state: state.map(|column| at(column, i)),
        slip: slip.map(|column| at(column, i)),
        coefficients: friction.map(|pair| pair.map(|column| at(column, i))),
        losses: lost.map(|all| Losses { coefficients: all.map(|column| at(column, i)) }),
        slope: slopes.map(|all| all.map(|column| at(column, i))),
        aloft: aloft.map(|all| all.map(|column| at(column, i))),
    };
    let (times, ask) = (times.as_slice()?, asked.ask()?);
    let mut watch = Watch::new(progress);
    let turns = out.contains("reversals")? || out.contains("first_reversal")?;
    let mut go_on = |share| watch.go_on(share);
    let found: Option<Vec<StoneSummary>> = if asked.calls_python() {
        with_laws(py, &asked, |laws| {
            many_custom(
                count,
                &row,
                times,
                (&ask, turns),
                (&CustomLaws::ThisThread(laws), threads),
                &mut go_on,
            )
        })??
    } else {
        let pointed = asked.pointed();
        let of = || pointed.custom();
        py.detach(|| {
            let laws = CustomLaws::AnyThread(&of);
            many_custom(count, &row, times, (&ask, turns), (&laws, threads), &mut go_on)
        })?
    };
    watch.done(py)?;
    let found = found.unwrap_or_default();
    for (to, row) in status.iter_mut().zip(&found) {
        *to = row.status;
    }
    for (k, name) in StoneSummary::NAMES.into_iter().enumerate() {
        if out.contains(name)? {
            let mut column = numbers(out, name)?;
            for (to, row) in column.as_slice_mut()?.iter_mut().zip(&found) {
                *to = row.numbers[k];
            }
        }
    }
    Ok(())
}
