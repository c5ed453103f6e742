//! The Python module `spincyl._core`: converts arguments and errors and releases the GIL, but computes nothing itself.

mod codes;
mod columns;
mod custom;
mod drift;
mod ensemble;
mod loss;
mod motion;
mod options;
mod parts;
mod pointer;
mod steep;
mod stone;
mod sweep;
mod ufunc;
mod watch;

use crate::laws::body::Circle;
use crate::laws::contact::landing::two_rims;
use crate::laws::contact::slip::{self, centre_velocity};
use crate::laws::steep::{Posture, slip_slope, tip_slope};
use crate::laws::{throw, topple};
use crate::motions::turning::jellett_spin;
use crate::states::sideways::slope_drift;
use crate::states::steady::MOST;
use crate::states::{stability, steady};
use crate::{Body, Contact, Error, Scale, Slip, State};
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;
use ufunc::{ArrayFunction, Value};

impl From<Error> for PyErr {
    fn from(e: Error) -> Self {
        match e {
            Error::Memory { .. } => PyMemoryError::new_err(e.to_string()),
            _ => PyValueError::new_err(e.to_string()),
        }
    }
}

/// Number of inputs that describe a body: ell, i1, i3, bore, fillet, theta_end.
pub const BODY: usize = 6;

fn body_of(x: &[f64]) -> Result<Body, Error> {
    let &numbers = x.first_chunk::<BODY>().expect("a body is six numbers");
    Body::of_numbers(numbers)
}

fn or_nan(result: Result<f64, Error>) -> f64 {
    result.unwrap_or(f64::NAN)
}

thread_local! {
    /// The body of the last call of `rate_of_one`, with the bits of its numbers.
    static LAST_BODY: std::cell::Cell<Option<([u64; BODY], Body)>> = const { std::cell::Cell::new(None) };
}

/// Evaluates a function of a body; `x` begins with the numbers of the body, and the result is NaN if these are invalid.
fn of_body(x: &[f64], f: impl Fn(&Body) -> f64) -> f64 {
    or_nan(body_of(x).map(|body| f(&body)))
}

/// Evaluates a function of a state and a body: `x` has theta, w1, w2, w3, then the numbers of the body.
fn of_state(x: &[f64], f: impl Fn(&State, &Body) -> f64) -> f64 {
    of_body(&x[4..], |body| f(&state_of(x), body))
}

/// Evaluates two functions of a state with a slip: `x` has theta, w1, w2, w3, the slip, then the numbers of the body.
fn of_slip(x: &[f64], f: impl Fn(&Body, &State, Slip) -> [f64; 2]) -> [f64; 2] {
    body_of(&x[6..]).map_or([f64::NAN; 2], |body| f(&body, &state_of(x), Slip::new(x[4], x[5])))
}

/// The inclination at which a capsule lands on its other end; NaN for any other tube.
fn capsule_end(tube: &Body) -> f64 {
    if tube.is_ball() && tube.ell() > 0.0 { tube.theta_end() } else { f64::NAN }
}

fn state_of(x: &[f64]) -> State {
    State { theta: x[0], w1: x[1], w2: x[2], w3: x[3] }
}

fn posture(code: f64) -> Result<Posture, Error> {
    Posture::try_from(code as u8)
}

/// One number, chosen by `pick`, of the state and the slip of a thrown or pressed body; NaN for an error.
fn number_of_throw(thrown: Result<(State, Slip), Error>, pick: impl Fn(&State, [f64; 2]) -> f64) -> f64 {
    or_nan(thrown.map(|(y, slip)| pick(&y, slip.pair())))
}

/// A number of a pressed body: `x` has impulse, angle, friction of finger and table, then the numbers of the body.
fn of_press(x: &[f64], pick: impl Fn(&State, [f64; 2]) -> f64) -> f64 {
    of_body(&x[4..], |b| number_of_throw(throw::pressed(b, x[0], x[1], x[2], x[3]), &pick))
}

/// A number of a thrown body: `x` has velocity, backspin, then the numbers of the body.
fn of_throw(x: &[f64], pick: impl Fn(&State, [f64; 2]) -> f64) -> f64 {
    of_body(&x[2..], |b| number_of_throw(throw::thrown(b, x[0], x[1]), &pick))
}

fn numbers_of_body(x: &[f64], f: impl Fn(&Body) -> [f64; MOST]) -> [f64; MOST] {
    body_of(x).map_or([f64::NAN; MOST], |body| f(&body))
}

/// Every elementwise function of the Python module: its name, its number of inputs and its computation.
static LAWS: &[ArrayFunction] = &[
    ArrayFunction { name: "rate", inputs: 7, value: Value::AtRest(ufunc::Quantity::Rate) },
    ArrayFunction { name: "kappa_rolling", inputs: 7, value: Value::AtRest(ufunc::Quantity::KappaRolling) },
    ArrayFunction { name: "kappa_smooth", inputs: 7, value: Value::AtRest(ufunc::Quantity::KappaSmooth) },
    ArrayFunction { name: "region", inputs: 7, value: Value::AtRest(ufunc::Quantity::Region) },
    ArrayFunction {
        name: "steady_w1",
        inputs: 7,
        value: Value::One(|x| of_body(&x[1..], |b| or_nan(steady::state(b, x[0]).map(|y| y.w1)))),
    },
    ArrayFunction {
        name: "steady_w3",
        inputs: 7,
        value: Value::One(|x| of_body(&x[1..], |b| or_nan(steady::state(b, x[0]).map(|y| y.w3)))),
    },
    ArrayFunction {
        name: "circular_w1",
        inputs: 8,
        value: Value::One(|x| of_body(&x[2..], |b| or_nan(steady::circular(b, x[0], x[1]).map(|y| y.w1)))),
    },
    ArrayFunction {
        name: "circular_w3",
        inputs: 8,
        value: Value::One(|x| of_body(&x[2..], |b| or_nan(steady::circular(b, x[0], x[1]).map(|y| y.w3)))),
    },
    ArrayFunction {
        name: "precession_of_radius",
        inputs: 8,
        value: Value::One(|x| of_body(&x[2..], |b| or_nan(steady::precession_of_radius(b, x[0], x[1])))),
    },
    ArrayFunction {
        name: "precession_of_spin",
        inputs: 9,
        value: Value::Pick(|x| {
            numbers_of_body(&x[2..], |b| {
                let [slow, fast] = steady::precessions_of_spin(b, x[0], x[1]).unwrap_or([f64::NAN; 2]);
                core::array::from_fn(|i| [slow, fast].get(i).copied().unwrap_or(f64::NAN))
            })
        }),
    },
    ArrayFunction {
        name: "inclination",
        inputs: 8,
        value: Value::Pick(|x| numbers_of_body(&x[1..], |b| steady::inclinations(b, x[0]))),
    },
    ArrayFunction {
        name: "states_w1",
        inputs: 8,
        value: Value::Pick(|x| numbers_of_body(&x[1..], |b| steady::states(b, x[0]).map(|y| y.w1))),
    },
    ArrayFunction {
        name: "states_w3",
        inputs: 8,
        value: Value::Pick(|x| numbers_of_body(&x[1..], |b| steady::states(b, x[0]).map(|y| y.w3))),
    },
    ArrayFunction {
        name: "count",
        inputs: 7,
        value: Value::One(|x| of_body(&x[1..], |b| steady::count(b, x[0]).map_or(f64::NAN, |n| n as f64))),
    },
    ArrayFunction { name: "fold", inputs: 7, value: Value::Pick(|x| numbers_of_body(x, steady::folds)) },
    ArrayFunction { name: "ridge", inputs: 7, value: Value::Pick(|x| numbers_of_body(x, steady::ridge)) },
    ArrayFunction {
        name: "boundary_rolling",
        inputs: 7,
        value: Value::Pick(|x| numbers_of_body(x, |b| stability::boundaries(b, Contact::Rolling))),
    },
    ArrayFunction {
        name: "boundary_smooth",
        inputs: 7,
        value: Value::Pick(|x| numbers_of_body(x, |b| stability::boundaries(b, Contact::Smooth))),
    },
    ArrayFunction {
        name: "theta_balance",
        inputs: 6,
        value: Value::One(|x| of_body(x, Body::theta_balance)),
    },
    ArrayFunction { name: "theta_limit", inputs: 6, value: Value::One(|x| of_body(x, Body::theta_limit)) },
    ArrayFunction {
        name: "standing_rolling",
        inputs: 6,
        value: Value::One(|x| of_body(x, |b| stability::standing_spin(b, Contact::Rolling))),
    },
    ArrayFunction {
        name: "standing_smooth",
        inputs: 6,
        value: Value::One(|x| of_body(x, |b| stability::standing_spin(b, Contact::Smooth))),
    },
    ArrayFunction { name: "excess", inputs: 6, value: Value::One(|x| of_body(x, Body::excess)) },
    ArrayFunction {
        name: "critical_aspect",
        inputs: 2,
        value: Value::One(|x| or_nan(Body::critical_aspect(x[0], x[1]))),
    },
    ArrayFunction {
        name: "jellett_spin",
        inputs: 6,
        value: Value::One(|x| of_body(x, |b| or_nan(jellett_spin(b)))),
    },
    ArrayFunction { name: "body_i1", inputs: 6, value: Value::One(|x| of_body(x, Body::i1)) },
    ArrayFunction { name: "body_i3", inputs: 6, value: Value::One(|x| of_body(x, Body::i3)) },
    ArrayFunction {
        name: "energy",
        inputs: 10,
        value: Value::One(|x| of_state(x, |y, b| crate::laws::contact::rolling::energy(b, y))),
    },
    ArrayFunction {
        name: "energy_smooth",
        inputs: 10,
        value: Value::One(|x| of_state(x, |y, b| crate::laws::contact::smooth::energy(b, y))),
    },
    ArrayFunction {
        name: "axis_up",
        inputs: 2,
        value: Value::One(|x| State { theta: x[0], w1: 0.0, w2: 0.0, w3: 0.0 }.axis_up(x[1] as u8)),
    },
    ArrayFunction {
        name: "inertia",
        inputs: 10,
        value: Value::One(|x| of_state(x, |y, b| Contact::Rolling.reduced(b).inertia(|| y.theta.sin_cos()))),
    },
    ArrayFunction {
        name: "acceleration",
        inputs: 10,
        value: Value::One(|x| of_state(x, |y, b| -crate::laws::contact::rolling::derivative(b, y).w2)),
    },
    ArrayFunction {
        name: "acceleration_smooth",
        inputs: 10,
        value: Value::One(|x| of_state(x, |y, b| -crate::laws::contact::smooth::derivative(b, y).w2)),
    },
    ArrayFunction {
        name: "state_kappa_rolling",
        inputs: 10,
        value: Value::One(|x| of_state(x, |y, b| stability::rolling(b, y))),
    },
    ArrayFunction {
        name: "state_kappa_smooth",
        inputs: 10,
        value: Value::One(|x| of_state(x, |y, b| stability::smooth(b, y))),
    },
    ArrayFunction {
        name: "angular_momentum",
        inputs: 10,
        value: Value::One(|x| of_state(x, |y, b| y.angular_momentum(b).norm())),
    },
    ArrayFunction { name: "beta", inputs: 10, value: Value::One(|x| of_state(x, |y, b| y.beta(b))) },
    ArrayFunction { name: "speed_o", inputs: 10, value: Value::One(|x| of_state(x, |y, b| y.speed_o(b))) },
    ArrayFunction { name: "speed_x", inputs: 10, value: Value::One(|x| of_state(x, |y, b| y.speed_x(b))) },
    ArrayFunction {
        name: "centre_radius",
        inputs: 10,
        value: Value::One(|x| of_state(x, |y, b| y.centre_radius(b))),
    },
    ArrayFunction {
        name: "energy_slip",
        inputs: 12,
        value: Value::One(|x| of_body(&x[6..], |b| slip::energy(b, &state_of(x), Slip::new(x[4], x[5])))),
    },
    ArrayFunction { name: "centre_along", inputs: 12, value: Value::One(|x| of_slip(x, centre_velocity)[0]) },
    ArrayFunction {
        name: "centre_across",
        inputs: 12,
        value: Value::One(|x| of_slip(x, centre_velocity)[1]),
    },
    ArrayFunction {
        name: "centre_up",
        inputs: 12,
        value: Value::One(|x| of_body(&x[6..], |b| slip::centre_rise(b, &state_of(x)))),
    },
    ArrayFunction {
        name: "rests",
        inputs: 10,
        value: Value::One(|x| of_state(x, |y, b| f64::from(u8::from(steady::rests(b, y))))),
    },
    ArrayFunction {
        name: "two_rims",
        inputs: 6,
        value: Value::One(|x| of_body(x, |b| f64::from(u8::from(two_rims(b).is_ok())))),
    },
    ArrayFunction {
        name: "lower_rim",
        inputs: 7,
        value: Value::One(|x| {
            of_body(&x[1..], |b| match two_rims(b) {
                Ok(_) => {
                    let [here, there] = b.rims();
                    here.less(&there).height(x[0].sin_cos()).min(0.0)
                }
                Err(_) => 0.0,
            })
        }),
    },
    ArrayFunction {
        name: "circle_height",
        inputs: 4,
        value: Value::One(|x| Circle { radius: x[1], depth: 0.0 - x[2], fillet: x[3] }.height(x[0])),
    },
    ArrayFunction {
        name: "capsule_end",
        inputs: 2,
        value: Value::One(|x| or_nan(Body::rounded_tube(x[0], 0.0, x[1]).map(|b| capsule_end(&b)))),
    },
    ArrayFunction { name: "stone_tilted", inputs: 3, value: Value::Pick(stone::vertical_of_tilt) },
    ArrayFunction { name: "stone_inclinations", inputs: 4, value: Value::Pick(stone::inclinations) },
    ArrayFunction { name: "stone_spin", inputs: 6, value: Value::One(stone::spin) },
    ArrayFunction { name: "stone_lever", inputs: stone::STONE + 4, value: Value::Pick(stone::lever) },
    ArrayFunction { name: "stone_slip", inputs: stone::STONE + 7, value: Value::Pick(stone::slip) },
    ArrayFunction {
        name: "painleve",
        inputs: 7,
        value: Value::One(|x| of_body(&x[1..], |b| slip::painleve(b, x[0]))),
    },
    ArrayFunction { name: "precession", inputs: 4, value: Value::One(|x| state_of(x).precession()) },
    ArrayFunction { name: "spin", inputs: 4, value: Value::One(|x| state_of(x).spin()) },
    ArrayFunction {
        name: "angular_velocity",
        inputs: 4,
        value: Value::One(|x| state_of(x).angular_velocity().norm()),
    },
    ArrayFunction { name: "gamma", inputs: 4, value: Value::One(|x| state_of(x).gamma()) },
    ArrayFunction { name: "contact_radius", inputs: 4, value: Value::One(|x| state_of(x).contact_radius()) },
    ArrayFunction { name: "thrown_w3", inputs: 8, value: Value::One(|x| of_throw(x, |y, _| y.w3)) },
    ArrayFunction { name: "thrown_slip", inputs: 8, value: Value::One(|x| of_throw(x, |_, slip| slip[1])) },
    ArrayFunction { name: "pressed_w1", inputs: 10, value: Value::One(|x| of_press(x, |y, _| y.w1)) },
    ArrayFunction { name: "pressed_w3", inputs: 10, value: Value::One(|x| of_press(x, |y, _| y.w3)) },
    ArrayFunction { name: "pressed_slip", inputs: 10, value: Value::One(|x| of_press(x, |_, slip| slip[1])) },
    ArrayFunction {
        name: "topples",
        inputs: 7,
        value: Value::One(|x| {
            of_body(&x[1..], |b| or_nan(topple::topples(b, x[0]).map(|yes| f64::from(u8::from(yes)))))
        }),
    },
    ArrayFunction {
        name: "slip_slope",
        inputs: 9,
        value: Value::One(|x| {
            of_body(&x[3..], |b| or_nan(posture(x[1]).and_then(|on| slip_slope(b, 0.0, x[0], on, x[2]))))
        }),
    },
    ArrayFunction {
        name: "tip_slope",
        inputs: 8,
        value: Value::One(|x| {
            of_body(&x[2..], |b| or_nan(posture(x[0]).and_then(|on| tip_slope(b, 0.0, on, x[1]))))
        }),
    },
    ArrayFunction {
        name: "slope_drift",
        inputs: 10,
        value: Value::One(|x| of_state(x, |y, b| slope_drift(b, y).across)),
    },
    ArrayFunction {
        name: "slope_resonance",
        inputs: 10,
        value: Value::One(|x| of_state(x, |y, b| slope_drift(b, y).resonance)),
    },
    ArrayFunction {
        name: "tripped_w2",
        inputs: 7,
        value: Value::One(|x| of_body(&x[1..], |b| or_nan(topple::tripped(b, x[0]).map(|y| y.w2)))),
    },
    ArrayFunction {
        name: "launch_spin",
        inputs: 8,
        value: Value::One(|x| of_body(&x[2..], |b| throw::launch_spin(b, x[0], x[1]))),
    },
    ArrayFunction {
        name: "recoil",
        inputs: 7,
        value: Value::One(|x| of_body(&x[1..], |b| throw::recoil(b, x[0]))),
    },
    ArrayFunction {
        name: "launch_number",
        inputs: 10,
        value: Value::One(|x| of_state(x, |y, b| throw::launch_number(b, y))),
    },
    ArrayFunction { name: "loss_power", inputs: loss::INPUTS, value: Value::One(loss::power) },
    ArrayFunction { name: "loss_couple", inputs: loss::INPUTS + 1, value: Value::One(loss::couple) },
    ArrayFunction { name: "nutation", inputs: 1, value: Value::One(|x| stability::nutation(x[0])) },
    ArrayFunction { name: "growth_rate", inputs: 1, value: Value::One(|x| stability::growth_rate(x[0])) },
];

/// Physics of spinning and rolling bodies, compiled. Private: use the functions of `spincyl`.
#[pymodule]
mod _core {
    use super::*;

    #[pymodule_export]
    use super::codes::codes;
    #[pymodule_export]
    use super::drift::{drift_ask, drift_check, drift_stops};
    #[pymodule_export]
    use super::ensemble::{columns, ensemble, summaries};
    #[pymodule_export]
    use super::loss::loss_laws;
    #[pymodule_export]
    use super::motion::{bounds, rising_spin, roll, swing, turning_spin};
    #[pymodule_export]
    use super::options::motion_options;
    #[pymodule_export]
    use super::parts::{body_circles, check_profile, frustum, lathe, of_parts, unequal_balls};
    #[pymodule_export]
    use super::steep::{shares_on_slope, slopes_of_circles};
    #[pymodule_export]
    use super::stone::{
        check_stone, check_stones, egg, rattleback, rocking, spin_limits, stone_columns, stone_energies,
        stone_losses, stone_moments, stone_names, stones, uniform_stone,
    };
    #[pymodule_export]
    use super::sweep::{areas, extrema, portrait};

    #[pymodule_init]
    fn init(m: &Bound<'_, PyModule>) -> PyResult<()> {
        for law in LAWS {
            m.add(law.name, ufunc::make(m.py(), law)?)?;
        }
        Ok(())
    }

    /// The reduced rate of the steady state with the centre at rest of one body at one inclination, without NumPy.
    #[pyfunction]
    fn rate_of_one(theta: f64, ell: f64, i1: f64, i3: f64, bore: f64, fillet: f64, theta_end: f64) -> f64 {
        let numbers = [ell, i1, i3, bore, fillet, theta_end];
        let bits = numbers.map(f64::to_bits);
        // The body of the last call is reused, since most callers ask for many rates of one body.
        let known = LAST_BODY.get().filter(|(of, _)| *of == bits);
        let Some((_, body)) = known.or_else(|| body_of(&numbers).ok().map(|body| (bits, body))) else {
            return f64::NAN;
        };
        if known.is_none() {
            LAST_BODY.set(Some((bits, body)));
        }
        steady::rate(&body, theta)
    }

    /// i1 and i3 of a body, or ValueError with the invalid value and the inequality.
    #[pyfunction]
    fn check_body(body: [f64; BODY]) -> PyResult<(f64, f64)> {
        let body = body_of(&body)?;
        Ok((body.i1(), body.i3()))
    }

    /// ell, i1, i3 and theta_end of a tube from half its length, its bore and its fillet, or ValueError with the
    /// invalid value and the range. theta_end is NaN if it follows from the other numbers.
    #[pyfunction]
    fn check_tube(half_length: f64, bore: f64, fillet: f64) -> PyResult<(f64, f64, f64, f64)> {
        let body = Body::rounded_tube(half_length, bore, fillet)?;
        Ok((body.ell(), body.i1(), body.i3(), capsule_end(&body)))
    }

    /// i1 and theta_end of two equal balls with this separation, or ValueError.
    #[pyfunction]
    fn check_balls(separation: f64) -> PyResult<(f64, f64)> {
        let body = Body::balls(separation)?;
        Ok((body.i1(), body.theta_end()))
    }

    /// Checks a ball: raises ValueError with the invalid value and the range.
    #[pyfunction]
    fn check_ball(offset: f64, i1: f64, i3: f64) -> PyResult<()> {
        Body::ball(offset, i1, i3)?;
        Ok(())
    }

    /// theta, w1, w2, w3 of the steady state with the centre at rest, or ValueError.
    #[pyfunction]
    fn steady_state(theta: f64, body: [f64; BODY]) -> PyResult<[f64; 4]> {
        Ok(steady::state(&body_of(&body)?, theta)?.into())
    }

    /// theta, w1, w2, w3 of the steady state whose centre moves along a circle, or ValueError.
    #[pyfunction]
    fn circular_state(theta: f64, precession: f64, body: [f64; BODY]) -> PyResult<[f64; 4]> {
        Ok(steady::circular(&body_of(&body)?, theta, precession)?.into())
    }

    /// theta, w1, w2, w3 and the slip of a body thrown on edge, or ValueError.
    #[pyfunction]
    fn thrown(velocity: f64, backspin: f64, body: [f64; BODY]) -> PyResult<([f64; 4], [f64; 2])> {
        let (state, slip) = throw::thrown(&body_of(&body)?, velocity, backspin)?;
        Ok((state.into(), slip.into()))
    }

    /// theta, w1, w2, w3 and the slip of a body on its side that a finger has pressed, or ValueError.
    #[pyfunction]
    fn pressed(
        impulse: f64,
        angle: f64,
        finger: f64,
        table: f64,
        body: [f64; BODY],
    ) -> PyResult<([f64; 4], [f64; 2])> {
        let (state, slip) = throw::pressed(&body_of(&body)?, impulse, angle, finger, table)?;
        Ok((state.into(), slip.into()))
    }

    /// Half length, bore and fillet of a tube from its dimensions, or ValueError.
    #[pyfunction]
    fn from_metres(
        outer_diameter: f64,
        inner_diameter: f64,
        length: f64,
        fillet: f64,
    ) -> PyResult<(f64, f64, f64)> {
        let body = Body::from_metres(outer_diameter, inner_diameter, length, fillet)?;
        Ok((length / outer_diameter, inner_diameter / outer_diameter, body.fillet()))
    }

    /// Metres, seconds, joules and turns per second of a natural unit, or ValueError.
    #[pyfunction]
    fn units(radius: f64, mass: f64, gravity: f64) -> PyResult<(f64, f64, f64, f64)> {
        let scale = Scale::new(radius, mass, gravity)?;
        Ok((scale.metres(1.0), scale.seconds(1.0), scale.joules(1.0), scale.turns(1.0)))
    }
}
