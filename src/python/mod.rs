//! The Python module `spincyl._core`: converts, releases the GIL, maps the error; computes nothing.

mod motion;
mod sweep;
mod ufunc;
mod watch;

use crate::{Body, Contact, Error, Scale, State, stability, steady};
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;
use ufunc::{Law, Value};

impl From<Error> for PyErr {
    fn from(e: Error) -> Self {
        match e {
            Error::Memory { .. } => PyMemoryError::new_err(e.to_string()),
            _ => PyValueError::new_err(e.to_string()),
        }
    }
}

/// The body of the four numbers (ell, i1, i3, bore); a bore that is NaN means a general body.
fn body_of(x: &[f64]) -> Result<Body, Error> {
    let &[ell, i1, i3, bore] = x else { unreachable!("a body is four numbers") };
    if bore.is_nan() { Body::new(ell, i1, i3) } else { Body::tube(ell, bore) }
}

fn or_nan(result: Result<f64, Error>) -> f64 {
    result.unwrap_or(f64::NAN)
}

/// A function of a body, the last four inputs.
fn of_body(x: &[f64], f: impl Fn(&Body) -> f64) -> f64 {
    or_nan(body_of(x).map(|body| f(&body)))
}

/// A function of a state and a body: theta, w1, w2, w3, then the body.
fn of_state(x: &[f64], f: impl Fn(&State, &Body) -> f64) -> f64 {
    of_body(&x[4..], |body| f(&state_of(x), body))
}

fn state_of(x: &[f64]) -> State {
    State { theta: x[0], w1: x[1], w2: x[2], w3: x[3] }
}

fn three(x: &[f64], f: impl Fn(&Body) -> [f64; 3]) -> [f64; 3] {
    body_of(x).map_or([f64::NAN; 3], |body| f(&body))
}

/// Every elementwise function of Python: name, number of inputs, what it does.
static LAWS: &[Law] = &[
    Law { name: "rate", inputs: 5, value: Value::AtRest(ufunc::Quantity::Rate) },
    Law { name: "kappa_rolling", inputs: 5, value: Value::AtRest(ufunc::Quantity::KappaRolling) },
    Law { name: "kappa_smooth", inputs: 5, value: Value::AtRest(ufunc::Quantity::KappaSmooth) },
    Law { name: "region", inputs: 5, value: Value::AtRest(ufunc::Quantity::Region) },
    Law {
        name: "steady_w1",
        inputs: 5,
        value: Value::One(|x| of_body(&x[1..], |b| or_nan(steady::state(b, x[0]).map(|y| y.w1)))),
    },
    Law {
        name: "steady_w3",
        inputs: 5,
        value: Value::One(|x| of_body(&x[1..], |b| or_nan(steady::state(b, x[0]).map(|y| y.w3)))),
    },
    Law {
        name: "circular_w1",
        inputs: 6,
        value: Value::One(|x| of_body(&x[2..], |b| or_nan(steady::circular(b, x[0], x[1]).map(|y| y.w1)))),
    },
    Law {
        name: "circular_w3",
        inputs: 6,
        value: Value::One(|x| of_body(&x[2..], |b| or_nan(steady::circular(b, x[0], x[1]).map(|y| y.w3)))),
    },
    Law {
        name: "inclination",
        inputs: 6,
        value: Value::Pick(|x| three(&x[1..], |b| steady::inclinations(b, x[0]))),
    },
    Law {
        name: "states_w1",
        inputs: 6,
        value: Value::Pick(|x| three(&x[1..], |b| steady::states(b, x[0]).map(|y| y.w1))),
    },
    Law {
        name: "states_w3",
        inputs: 6,
        value: Value::Pick(|x| three(&x[1..], |b| steady::states(b, x[0]).map(|y| y.w3))),
    },
    Law {
        name: "count",
        inputs: 5,
        value: Value::One(|x| of_body(&x[1..], |b| steady::count(b, x[0]).map_or(f64::NAN, |n| n as f64))),
    },
    Law { name: "fold", inputs: 5, value: Value::Pick(|x| three(x, steady::folds)) },
    Law { name: "ridge", inputs: 5, value: Value::Pick(|x| three(x, steady::ridge)) },
    Law {
        name: "boundary_rolling",
        inputs: 5,
        value: Value::Pick(|x| three(x, |b| stability::boundaries(b, Contact::Rolling))),
    },
    Law {
        name: "boundary_smooth",
        inputs: 5,
        value: Value::Pick(|x| three(x, |b| stability::boundaries(b, Contact::Smooth))),
    },
    Law { name: "theta_balance", inputs: 4, value: Value::One(|x| of_body(x, Body::theta_balance)) },
    Law { name: "theta_limit", inputs: 4, value: Value::One(|x| of_body(x, Body::theta_limit)) },
    Law { name: "excess", inputs: 4, value: Value::One(|x| of_body(x, Body::excess)) },
    Law { name: "critical_aspect", inputs: 1, value: Value::One(|x| or_nan(Body::critical_aspect(x[0]))) },
    Law { name: "body_i1", inputs: 4, value: Value::One(|x| of_body(x, Body::i1)) },
    Law { name: "body_j", inputs: 4, value: Value::One(|x| of_body(x, Body::j)) },
    Law { name: "body_i3", inputs: 4, value: Value::One(|x| of_body(x, Body::i3)) },
    Law {
        name: "energy",
        inputs: 8,
        value: Value::One(|x| of_state(x, |y, b| crate::rolling::energy(b, y))),
    },
    Law {
        name: "energy_smooth",
        inputs: 8,
        value: Value::One(|x| of_state(x, |y, b| crate::smooth::energy(b, y))),
    },
    Law {
        name: "acceleration",
        inputs: 8,
        value: Value::One(|x| of_state(x, |y, b| -crate::rolling::derivative(b, y).w2)),
    },
    Law {
        name: "acceleration_smooth",
        inputs: 8,
        value: Value::One(|x| of_state(x, |y, b| -crate::smooth::derivative(b, y).w2)),
    },
    Law {
        name: "state_kappa_rolling",
        inputs: 8,
        value: Value::One(|x| of_state(x, |y, b| stability::rolling(b, y))),
    },
    Law {
        name: "state_kappa_smooth",
        inputs: 8,
        value: Value::One(|x| of_state(x, |y, b| stability::smooth(b, y))),
    },
    Law {
        name: "angular_momentum",
        inputs: 8,
        value: Value::One(|x| of_state(x, |y, b| y.angular_momentum(b).norm())),
    },
    Law { name: "beta", inputs: 8, value: Value::One(|x| of_state(x, |y, b| y.beta(b))) },
    Law { name: "speed_o", inputs: 8, value: Value::One(|x| of_state(x, |y, b| y.speed_o(b))) },
    Law { name: "speed_x", inputs: 8, value: Value::One(|x| of_state(x, |y, b| y.speed_x(b))) },
    Law { name: "centre_radius", inputs: 8, value: Value::One(|x| of_state(x, |y, b| y.centre_radius(b))) },
    Law { name: "precession", inputs: 4, value: Value::One(|x| state_of(x).precession()) },
    Law { name: "spin", inputs: 4, value: Value::One(|x| state_of(x).spin()) },
    Law { name: "angular_velocity", inputs: 4, value: Value::One(|x| state_of(x).angular_velocity().norm()) },
    Law { name: "gamma", inputs: 4, value: Value::One(|x| state_of(x).gamma()) },
    Law { name: "contact_radius", inputs: 4, value: Value::One(|x| state_of(x).contact_radius()) },
    Law { name: "nutation", inputs: 1, value: Value::One(|x| stability::nutation(x[0])) },
    Law { name: "growth_rate", inputs: 1, value: Value::One(|x| stability::growth_rate(x[0])) },
];

/// Physics of spinning and rolling bodies, compiled. Private: use the functions of `spincyl`.
#[pymodule]
mod _core {
    use super::*;

    #[pymodule_export]
    use super::motion::{roll, swing};
    #[pymodule_export]
    use super::sweep::{areas, ensemble, extrema, portrait};

    #[pymodule_init]
    fn init(m: &Bound<'_, PyModule>) -> PyResult<()> {
        for law in LAWS {
            m.add(law.name, ufunc::make(m.py(), law)?)?;
        }
        Ok(())
    }

    /// The rate of one body at one inclination: without the way through NumPy.
    #[pyfunction]
    fn rate_of_one(theta: f64, ell: f64, i1: f64, i3: f64, bore: f64) -> f64 {
        or_nan(body_of(&[ell, i1, i3, bore]).map(|body| steady::rate(&body, theta)))
    }

    /// i1 and i3 of a body, or ValueError naming the value and the inequality.
    #[pyfunction]
    fn check_body(ell: f64, i1: f64, i3: f64, bore: f64) -> PyResult<(f64, f64)> {
        let body = body_of(&[ell, i1, i3, bore])?;
        Ok((body.i1(), body.i3()))
    }

    /// i1 and i3 of a tube, or ValueError naming the value and the range.
    #[pyfunction]
    fn check_tube(ell: f64, bore: f64) -> PyResult<(f64, f64)> {
        let body = Body::tube(ell, bore)?;
        Ok((body.i1(), body.i3()))
    }

    /// theta, w1, w2, w3 of the steady state with the centre at rest, or ValueError.
    #[pyfunction]
    fn steady_state(theta: f64, ell: f64, i1: f64, i3: f64, bore: f64) -> PyResult<(f64, f64, f64, f64)> {
        let y = steady::state(&body_of(&[ell, i1, i3, bore])?, theta)?;
        Ok((y.theta, y.w1, y.w2, y.w3))
    }

    /// theta, w1, w2, w3 of the steady state whose centre runs on a circle, or ValueError.
    #[pyfunction]
    fn circular_state(
        theta: f64,
        precession: f64,
        ell: f64,
        i1: f64,
        i3: f64,
        bore: f64,
    ) -> PyResult<(f64, f64, f64, f64)> {
        let y = steady::circular(&body_of(&[ell, i1, i3, bore])?, theta, precession)?;
        Ok((y.theta, y.w1, y.w2, y.w3))
    }

    /// Aspect ratio and bore of a tube from its measures, or ValueError.
    #[pyfunction]
    fn from_metres(outer_diameter: f64, inner_diameter: f64, length: f64) -> PyResult<(f64, f64)> {
        let body = Body::from_metres(outer_diameter, inner_diameter, length)?;
        Ok((body.ell(), inner_diameter / outer_diameter))
    }

    /// Metres, seconds, joules and turns per second of a natural unit, or ValueError.
    #[pyfunction]
    fn units(radius: f64, mass: f64, gravity: f64) -> PyResult<(f64, f64, f64, f64)> {
        let scale = Scale::new(radius, mass, gravity)?;
        Ok((scale.metres(1.0), scale.seconds(1.0), scale.joules(1.0), scale.turns(1.0)))
    }
}
