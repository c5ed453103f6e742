//! Laws of loss and friction that are Python functions.

use super::options::MotionAsked;
use super::pointer::GivenLaw;
use super::watch::CHECK_PERIOD;
use crate::laws::body::Body;
use crate::laws::custom::{CoupleLaw, Custom, DriveLaw, FrictionLaw, Moment, Push};
use crate::laws::state::State;
use nalgebra::{Vector2, Vector3};
use numpy::PyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::cell::{Cell, RefCell};
use std::time::Instant;

/// Calls `run` with the user-defined laws of a motion, or of many, and returns the first error of a law.
pub(super) fn with_laws<T>(
    py: Python<'_>,
    asked: &MotionAsked,
    run: impl FnOnce(Custom<'_>) -> T,
) -> PyResult<T> {
    let (raised, pointed) = (Raised::default(), asked.pointed());
    let [couple, friction] = [&asked.couple, &asked.friction]
        .map(|law| PythonLaw::of(py, law.as_ref().and_then(GivenLaw::function), &raised));
    let drive = PythonLaw::of(py, asked.drive.as_ref(), &raised);
    let found = run(Custom {
        couple: couple.as_ref().map(|law| law as &dyn CoupleLaw).or(pointed.custom().couple),
        friction: friction.as_ref().map(|law| law as &dyn FrictionLaw).or(pointed.custom().friction),
        drive: drive.as_ref().map(|law| law as &dyn DriveLaw),
    });
    raised.end()?;
    Ok(found)
}

/// The first error that a law has raised, or Ctrl-C between two calls of a law, which need not be Python code.
#[derive(Default)]
struct Raised {
    error: RefCell<Option<PyErr>>,
    asked: Cell<Option<Instant>>,
}

impl Raised {
    /// Returns the first error that a law has raised, if there is one.
    fn end(&self) -> PyResult<()> {
        self.error.take().map_or(Ok(()), Err)
    }

    fn check_signals(&self, py: Python<'_>) -> PyResult<()> {
        let now = Instant::now();
        if self.asked.get().is_none_or(|asked| now - asked >= CHECK_PERIOD) {
            self.asked.set(Some(now));
            py.check_signals()?;
        }
        Ok(())
    }
}

/// A Python function as a law. After the first error of any law, laws are no longer called and give NaN.
struct PythonLaw<'py, 'a> {
    function: Bound<'py, PyAny>,
    raised: &'a Raised,
}

impl<'py, 'a> PythonLaw<'py, 'a> {
    fn of(py: Python<'py>, function: Option<&Py<PyAny>>, raised: &'a Raised) -> Option<Self> {
        function.map(|f| Self { function: f.bind(py).clone(), raised })
    }

    fn is_over(&self) -> bool {
        self.raised.error.borrow().is_some()
    }

    fn value<T>(&self, found: impl FnOnce() -> PyResult<T>, lost: T) -> T {
        if self.is_over() {
            return lost;
        }
        let found = found().and_then(|x| self.raised.check_signals(self.function.py()).map(|()| x));
        found.unwrap_or_else(|error| {
            self.raised.error.replace(Some(error));
            lost
        })
    }
}

impl CoupleLaw for PythonLaw<'_, '_> {
    fn has_failed(&self) -> bool {
        self.is_over()
    }

    fn couple(&self, _: &Body, y: &State, normal: f64) -> [f64; 3] {
        let numbers = |m: &Bound<'_, PyAny>| {
            let all: Vec<f64> = m.try_iter()?.map(|x| x?.extract()).collect::<PyResult<_>>()?;
            <[f64; 3]>::try_from(all).map_err(|_| PyTypeError::new_err(()))
        };
        let found = || {
            let w = PyArray1::from_slice(self.function.py(), &[y.w1, y.w2, y.w3]);
            let m = self.function.call1((y.theta, w, normal))?;
            numbers(&m).map_err(|_| unlike("couple: expected three numbers, along e1, e2, e3", &m))
        };
        self.value(found, [f64::NAN; 3])
    }
}

impl FrictionLaw for PythonLaw<'_, '_> {
    fn has_failed(&self) -> bool {
        self.is_over()
    }

    fn coefficient(&self, speed: f64) -> f64 {
        let number = |mu: Bound<'_, PyAny>| mu.extract().map_err(|_| unlike("mu: expected a number", &mu));
        self.value(|| self.function.call1((speed,)).and_then(number), f64::NAN)
    }
}

impl DriveLaw for PythonLaw<'_, '_> {
    fn has_failed(&self) -> bool {
        self.is_over()
    }

    /// Calls the function with the numbers of the moment `now` in their order, and the rows of its axes. It returns the
    /// force along x and y and the couple.
    fn push(&self, _: &Body, now: &Moment) -> Push {
        let State { theta, w1, w2, w3 } = now.state;
        let ([along, across], at, v) = (now.slip.pair(), now.contact_point, now.velocity);
        let numbers = [now.time, theta, w1, w2, w3, along, across, now.phi, now.psi, at.x, at.y];
        let numbers = numbers.into_iter().chain([now.height, v.x, v.y]);
        let rows = now.axes().transpose();
        let numbers: Vec<f64> = numbers.chain(rows.iter().copied()).collect();
        let found = || {
            let push = self.function.call1((PyArray1::from_vec(self.function.py(), numbers),))?;
            let all: Vec<f64> = push.try_iter()?.map(|x| x?.extract()).collect::<PyResult<_>>()?;
            let expected = "drive: expected five numbers, the force along x and y and the couple";
            <[f64; 5]>::try_from(all).map_err(|_| unlike(expected, &push))
        };
        let [x, y, m1, m2, m3] = self.value(found, [f64::NAN; 5]);
        Push { force: Vector2::new(x, y), couple: Vector3::new(m1, m2, m3) }
    }
}

/// The error for a function that returns another type of value.
fn unlike(expected: &str, found: &Bound<'_, PyAny>) -> PyErr {
    let shown = found.repr().map_or_else(|_| String::new(), |text| text.to_string());
    PyTypeError::new_err(format!("{expected}, not {shown}"))
}
