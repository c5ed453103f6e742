//! Sweeps: arrays in, arrays filled, the GIL released, Ctrl-C heard.

use crate::ensemble::{Job, MotionOutput, MotionStarts, SUMMARIES, roll};
use crate::error::room;
use crate::sweep::{self, Cell};
use crate::{Body, Error};
use numpy::{Element, PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadwriteArray1};
use pyo3::prelude::*;

use super::motion::contact_of;
use super::watch::Watch;

type Array<'py, T> = Bound<'py, PyArray1<T>>;

fn open<'a, T: Element>(array: &'a Option<Array<'_, T>>) -> PyResult<Option<PyReadwriteArray1<'a, T>>> {
    Ok(array.as_ref().map(|a| a.try_readwrite()).transpose()?)
}

fn slice<'a, T: Element>(array: &'a mut Option<PyReadwriteArray1<'_, T>>) -> PyResult<Option<&'a mut [T]>> {
    Ok(array.as_mut().map(|a| a.as_slice_mut()).transpose()?)
}

/// The arrays of a map: rate, kappa_rolling, kappa_smooth, energy (of one kind of float), region.
type Arrays<'py> = [Option<Bound<'py, PyAny>>; 5];

/// Opens the arrays of a map for `fill`.
fn with_portrait<F: Element + Cell>(
    arrays: &Arrays<'_>,
    fill: impl FnOnce(sweep::Portrait<'_, F>) -> PyResult<()>,
) -> PyResult<()> {
    fn cast<'py, T: Element>(array: &Option<Bound<'py, PyAny>>) -> PyResult<Option<Array<'py, T>>> {
        Ok(array.as_ref().map(|a| a.cast::<PyArray1<T>>().cloned()).transpose()?)
    }
    let [a, b, c, d, e] = arrays;
    let (a, b, c, d) = (cast::<F>(a)?, cast::<F>(b)?, cast::<F>(c)?, cast::<F>(d)?);
    let e = cast::<u8>(e)?;
    let (mut a, mut b, mut c, mut d, mut e) = (open(&a)?, open(&b)?, open(&c)?, open(&d)?, open(&e)?);
    fill(sweep::Portrait {
        rate: slice(&mut a)?,
        kappa_rolling: slice(&mut b)?,
        kappa_smooth: slice(&mut c)?,
        energy: slice(&mut d)?,
        region: slice(&mut e)?,
    })
}

/// The tubes of a map; none at all if it is told to stop.
fn tubes(of: [&[f64]; 3], watch: &mut Watch) -> Result<Option<Vec<Option<Body>>>, Error> {
    let [half, bore, fillet] = of;
    let mut tubes = room(half.len())?;
    for (i, ((half, bore), fillet)) in half.iter().zip(bore).zip(fillet).enumerate() {
        if i % 4096 == 4095 && !watch.still() {
            return Ok(None);
        }
        tubes.push(Body::rounded_tube(*half, *bore, *fillet).ok());
    }
    Ok(Some(tubes))
}

/// Fill the arrays of a map: (theta, body), or scattered points.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "one argument an array; private to the Python package")]
pub fn portrait<'py>(
    py: Python<'py>,
    theta: PyReadonlyArray1<'py, f64>,
    ell: PyReadonlyArray1<'py, f64>,
    bore: PyReadonlyArray1<'py, f64>,
    fillet: PyReadonlyArray1<'py, f64>,
    arrays: Arrays<'py>,
    scattered: bool,
    single: bool,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<()> {
    let columns = [theta.as_slice()?, ell.as_slice()?, bore.as_slice()?, fillet.as_slice()?];
    fn run<F: Element + Cell>(
        py: Python<'_>,
        columns: [&[f64]; 4],
        arrays: &Arrays<'_>,
        scattered: bool,
        threads: usize,
        mut watch: Watch,
    ) -> PyResult<()> {
        with_portrait::<F>(arrays, |out| {
            py.detach(|| {
                let [theta, ell, bore, fillet] = columns;
                if scattered {
                    return sweep::points(columns, out, threads, |share| watch.go_on(share));
                }
                let Some(tubes) = tubes([ell, bore, fillet], &mut watch)? else { return Ok(false) };
                sweep::portrait(theta, &tubes, out, threads, |share| watch.go_on(share))
            })?;
            watch.done(py)
        })
    }
    let run = if single { run::<f32> } else { run::<f64> };
    run(py, columns, &arrays, scattered, threads, Watch::new(progress))
}

/// The number of each region's inclinations, and the sum of their weights: (body, these two, code).
#[pyfunction]
pub fn areas<'py>(
    py: Python<'py>,
    theta: PyReadonlyArray1<'py, f64>,
    weights: PyReadonlyArray1<'py, f64>,
    ell: PyReadonlyArray1<'py, f64>,
    bore: PyReadonlyArray1<'py, f64>,
    fillet: PyReadonlyArray1<'py, f64>,
    threads: usize,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (theta, weights) = (theta.as_slice()?, weights.as_slice()?);
    let (ell, bore, fillet) = (ell.as_slice()?, bore.as_slice()?, fillet.as_slice()?);
    let mut watch = Watch::new(None);
    let found = py.detach(|| match tubes([ell, bore, fillet], &mut watch)? {
        Some(bodies) => {
            let mut ones = room(theta.len())?;
            ones.resize(theta.len(), 1.0);
            sweep::areas(theta, [&ones, weights], &bodies, threads, |share| watch.go_on(share))
        }
        None => Ok(None),
    })?;
    watch.done(py)?;
    Ok(PyArray1::from_vec(py, found.unwrap_or_default().into_flattened().into_flattened()))
}

/// Least and greatest with their places (value, theta's index, body's index) of the wanted: rate squared, both kappas,
/// energy.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "one argument an array; private to the Python package")]
pub fn extrema<'py>(
    py: Python<'py>,
    theta: PyReadonlyArray1<'py, f64>,
    ell: PyReadonlyArray1<'py, f64>,
    bore: PyReadonlyArray1<'py, f64>,
    fillet: PyReadonlyArray1<'py, f64>,
    wanted: [bool; 4],
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<[sweep::Extrema; 4]> {
    let (theta, ell) = (theta.as_slice()?, ell.as_slice()?);
    let (bore, fillet) = (bore.as_slice()?, fillet.as_slice()?);
    let mut watch = Watch::new(progress);
    let found = py.detach(|| match tubes([ell, bore, fillet], &mut watch)? {
        Some(bodies) => sweep::extrema(theta, &bodies, wanted, threads, |share| watch.go_on(share)),
        None => Ok(None),
    })?;
    watch.done(py)?;
    Ok(found.unwrap_or_default())
}

/// Fill the arrays of many motions. Columns: ell, i1, i3, fillet, theta_end; theta, w1, w2, w3; one number or n each.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "one argument an array; private to the Python package")]
pub fn ensemble<'py>(
    py: Python<'py>,
    bodies: [PyReadonlyArray1<'py, f64>; 5],
    start: [PyReadonlyArray1<'py, f64>; 4],
    times: PyReadonlyArray1<'py, f64>,
    contact: u8,
    tol: f64,
    step: Option<f64>,
    mu: f64,
    beyond: bool,
    states: Option<[Array<'py, f64>; 4]>,
    last: Option<[Array<'py, f64>; 4]>,
    summary: [Option<Array<'py, f64>>; SUMMARIES],
    error: Array<'py, f64>,
    method: Array<'py, u8>,
    status: Array<'py, u8>,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<()> {
    let [a, b, c, r, most] = &bodies;
    let [d, e, f, g] = &start;
    let starts = MotionStarts {
        bodies: [a.as_slice()?, b.as_slice()?, c.as_slice()?, r.as_slice()?, most.as_slice()?],
        states: [d.as_slice()?, e.as_slice()?, f.as_slice()?, g.as_slice()?],
    };
    let times = times.as_slice()?;
    let job = Job { contact: contact_of(contact)?, times, tol, step, mu, beyond };
    let four = |x: &Option<[Array<'py, f64>; 4]>| x.clone().map_or([const { None }; 4], |x| x.map(Some));
    let (states, last) = (four(&states), four(&last));
    let mut open_states = [open(&states[0])?, open(&states[1])?, open(&states[2])?, open(&states[3])?];
    let mut open_last = [open(&last[0])?, open(&last[1])?, open(&last[2])?, open(&last[3])?];
    let mut sums = summary.iter().map(open).collect::<PyResult<Vec<_>>>()?;
    let mut columns = [const { None }; SUMMARIES];
    for (column, sum) in columns.iter_mut().zip(&mut sums) {
        *column = slice(sum)?;
    }
    fn all<'a>(x: &'a mut [Option<PyReadwriteArray1<'_, f64>>; 4]) -> PyResult<Option<[&'a mut [f64]; 4]>> {
        let [a, b, c, d] = x;
        let four = (slice(a)?, slice(b)?, slice(c)?, slice(d)?);
        Ok(if let (Some(a), Some(b), Some(c), Some(d)) = four { Some([a, b, c, d]) } else { None })
    }
    let (mut error, mut method, mut status) =
        (error.try_readwrite()?, method.try_readwrite()?, status.try_readwrite()?);
    let out = MotionOutput {
        states: all(&mut open_states)?,
        last: all(&mut open_last)?,
        summary: columns,
        error: error.as_slice_mut()?,
        method: method.as_slice_mut()?,
        status: status.as_slice_mut()?,
    };
    let mut watch = Watch::new(progress);
    py.detach(|| roll(&starts, &job, out, threads, |share| watch.go_on(share)))?;
    watch.done(py)
}
