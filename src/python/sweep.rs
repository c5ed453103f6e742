//! Sweeps: arrays in, arrays filled, the GIL released, Ctrl-C heard.

use crate::error::room;
use crate::sweep::{self, Cell};
use crate::{Body, Error};
use numpy::{Element, PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadwriteArray1};
use pyo3::prelude::*;

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
