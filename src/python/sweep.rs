//! Functions for Python that compute maps: they fill arrays with the GIL released, and Ctrl-C stops them.

use crate::error::room;
use crate::many::maps::{self as sweep, Cell};
use crate::{Body, Error};
use numpy::{Element, PyArray1, PyArrayMethods, PyReadwriteArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::columns::GivenColumns;
use super::watch::Watch;

/// The names of the input columns of a map.
const AXES: [&str; 4] = ["theta", "ell", "bore", "fillet"];

/// The output array with this name in `out`; None if `out` has no such array.
fn filled<'py, T: Element>(
    out: &Bound<'py, PyDict>,
    name: &str,
) -> PyResult<Option<PyReadwriteArray1<'py, T>>> {
    let Some(array) = out.get_item(name)? else { return Ok(None) };
    Ok(Some(array.cast_into::<PyArray1<T>>()?.try_readwrite()?))
}

fn slice<'a, T: Element>(array: &'a mut Option<PyReadwriteArray1<'_, T>>) -> PyResult<Option<&'a mut [T]>> {
    Ok(array.as_mut().map(|a| a.as_slice_mut()).transpose()?)
}

/// Calls `fill` with the output arrays of a map; all its floating-point arrays have one precision.
fn with_portrait<F: Element + Cell>(
    out: &Bound<'_, PyDict>,
    fill: impl FnOnce(sweep::Portrait<'_, F>) -> PyResult<()>,
) -> PyResult<()> {
    let (mut rate, mut energy) = (filled::<F>(out, "rate")?, filled::<F>(out, "energy")?);
    let (mut rolling, mut smooth) = (filled::<F>(out, "kappa_rolling")?, filled::<F>(out, "kappa_smooth")?);
    let mut region = filled::<u8>(out, "region")?;
    fill(sweep::Portrait {
        rate: slice(&mut rate)?,
        kappa_rolling: slice(&mut rolling)?,
        kappa_smooth: slice(&mut smooth)?,
        energy: slice(&mut energy)?,
        region: slice(&mut region)?,
    })
}

/// The tubes of a map, each None if its numbers are invalid. The whole result is None after Ctrl-C.
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

/// Fills the arrays `out` of a map over (theta, body), or of scattered points, from the columns `given`.
#[pyfunction]
pub fn portrait<'py>(
    py: Python<'py>,
    given: Bound<'py, PyDict>,
    out: Bound<'py, PyDict>,
    scattered: bool,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<()> {
    fn run<F: Element + Cell>(
        py: Python<'_>,
        columns: [&[f64]; 4],
        out: &Bound<'_, PyDict>,
        scattered: bool,
        threads: usize,
        mut watch: Watch,
    ) -> PyResult<()> {
        with_portrait::<F>(out, |out| {
            py.detach(|| {
                let [theta, ell, bore, fillet] = columns;
                if scattered {
                    let columns = sweep::TubePoints { theta, half_length: ell, bore, fillet };
                    return sweep::points(columns, out, threads, |share| watch.go_on(share));
                }
                let Some(tubes) = tubes([ell, bore, fillet], &mut watch)? else { return Ok(false) };
                sweep::portrait(theta, &tubes, out, threads, |share| watch.go_on(share))
            })?;
            watch.done(py)
        })
    }
    let given = GivenColumns::of(&given)?;
    let single = out.values().iter().any(|array| array.is_instance_of::<PyArray1<f32>>());
    let run = if single { run::<f32> } else { run::<f64> };
    run(py, given.all(AXES)?, &out, scattered, threads, Watch::new(progress))
}

/// The number of inclinations in each region, and the sum of their weights, as an array with the axes body, number or
/// sum, code of the region.
#[pyfunction]
pub fn areas<'py>(
    py: Python<'py>,
    given: Bound<'py, PyDict>,
    threads: usize,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let given = GivenColumns::of(&given)?;
    let ([theta, ell, bore, fillet], [weights]) = (given.all(AXES)?, given.all(["weights"])?);
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

/// Minimum and maximum of the requested quantities among squared rate, kappa in rolling, kappa on a smooth table and
/// energy, each as (value, index of theta, index of the body).
#[pyfunction]
pub fn extrema<'py>(
    py: Python<'py>,
    given: Bound<'py, PyDict>,
    wanted: [bool; 4],
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<[sweep::Ends; 4]> {
    let given = GivenColumns::of(&given)?;
    let [theta, ell, bore, fillet] = given.all(AXES)?;
    let mut watch = Watch::new(progress);
    let found = py.detach(|| match tubes([ell, bore, fillet], &mut watch)? {
        Some(bodies) => {
            sweep::extrema_compiled_once(theta, &bodies, wanted, threads, &mut |share| watch.go_on(share))
        }
        None => Ok(None),
    })?;
    watch.done(py)?;
    Ok(found.unwrap_or_default())
}
