//! Laws of loss and friction that are Python functions.

use crate::laws::body::Body;
use crate::laws::custom::{CoupleLaw, FrictionLaw};
use crate::laws::state::State;
use numpy::PyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::cell::RefCell;

/// A Python function as a law. The first error that it raises is kept; the value of the law is then NaN.
pub(super) struct PythonLaw<'py> {
    function: Bound<'py, PyAny>,
    raised: RefCell<Option<PyErr>>,
}

impl<'py> PythonLaw<'py> {
    pub fn of(py: Python<'py>, function: Option<&Py<PyAny>>) -> Option<Self> {
        function.map(|f| Self { function: f.bind(py).clone(), raised: RefCell::new(None) })
    }

    /// The error that the function has raised.
    pub fn raised(self) -> Option<PyErr> {
        self.raised.into_inner()
    }

    fn value<T>(&self, found: PyResult<T>, lost: T) -> T {
        found.unwrap_or_else(|error| {
            self.raised.borrow_mut().get_or_insert(error);
            lost
        })
    }
}

impl CoupleLaw for PythonLaw<'_> {
    fn couple(&self, _: &Body, y: &State, normal: f64) -> [f64; 3] {
        let w = PyArray1::from_slice(self.function.py(), &[y.w1, y.w2, y.w3]);
        let numbers = |m: &Bound<'_, PyAny>| {
            let all: Vec<f64> = m.try_iter()?.map(|x| x?.extract()).collect::<PyResult<_>>()?;
            <[f64; 3]>::try_from(all).map_err(|_| PyTypeError::new_err(()))
        };
        let found = self.function.call1((y.theta, w, normal)).and_then(|m| {
            numbers(&m).map_err(|_| unlike("couple: expected three numbers, along e1, e2, e3", &m))
        });
        self.value(found, [f64::NAN; 3])
    }
}

impl FrictionLaw for PythonLaw<'_> {
    fn coefficient(&self, speed: f64) -> f64 {
        let number = |mu: Bound<'_, PyAny>| mu.extract().map_err(|_| unlike("mu: expected a number", &mu));
        self.value(self.function.call1((speed,)).and_then(number), f64::NAN)
    }
}

/// The error for a function that returns another type of value.
fn unlike(expected: &str, found: &Bound<'_, PyAny>) -> PyErr {
    let shown = found.repr().map_or_else(|_| String::new(), |text| text.to_string());
    PyTypeError::new_err(format!("{expected}, not {shown}"))
}
