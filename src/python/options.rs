//! The options of a motion, as Python gives them.

use super::pointer::{GivenLaw, PointedLaws};
use crate::laws::contact::{Contact, Face, ImpactLaw, TableKind};
use crate::laws::loss::{COUNT, Losses, Resistance};
use crate::motions::{Ask, Method};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

pub(super) fn contact_of(code: u8) -> PyResult<Contact> {
    match table_of(code)? {
        TableKind::Rolling => Ok(Contact::Rolling),
        TableKind::Smooth => Ok(Contact::Smooth),
        _ => Err(PyValueError::new_err("contact: expected the code of a contact")),
    }
}

pub(super) fn table_of(code: u8) -> PyResult<TableKind> {
    TableKind::from_code(code)
        .ok_or_else(|| PyValueError::new_err("table: expected the code of a kind of table"))
}

/// A struct of options, read from a dictionary; missing options have their defaults.
macro_rules! options {
    ($(#[$about:meta])* pub struct $Name:ident { $($(#[$doc:meta])* $name:ident: $Type:ty = $default:expr,)+ }) => {
        $(#[$about])*
        pub struct $Name {
            $($(#[$doc])* pub $name: $Type,)+
        }

        impl $Name {
            /// The names of all options.
            const NAMES: [&'static str; [$(stringify!($name)),+].len()] = [$(stringify!($name)),+];
        }

        impl FromPyObject<'_, '_> for $Name {
            type Error = PyErr;

            fn extract(given: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
                let mut asked = Self { $($name: $default,)+ };
                for (name, value) in given.cast::<PyDict>()?.iter() {
                    match name.cast::<PyString>()?.to_str()? {
                        $(stringify!($name) => asked.$name = value.extract()?,)+
                        other => return Err(PyValueError::new_err(format!("no option of a motion: {other}"))),
                    }
                }
                Ok(asked)
            }
        }
    };
}

options! {
    /// The options of a motion, or of many motions, as Python gives them.
    pub struct MotionAsked {
        t0: f64 = 0.0,
        /// The slip; without one, the centre of a body on its face is at rest under friction.
        slip: Option<[f64; 2]> = None,
        /// Rows of radius, height and fillet for each circle of a body with several circles.
        circles: Vec<[f64; 3]> = Vec::new(),
        table: u8 = TableKind::Rolling as u8,
        /// The coefficient mu or c, the static coefficient, and the radius of the patch.
        coefficients: [f64; 3] = [f64::INFINITY, 0.0, 0.0],
        face: u8 = Face::Ring as u8,
        losses: Option<[f64; COUNT]> = None,
        /// Whether rolling resistance also acts while the contact point slips.
        while_slipping: bool = true,
        step: Option<f64> = None,
        tol: Option<f64> = None,
        beyond: bool = false,
        restitution: Option<f64> = None,
        /// The name of another law of restitution than Stronge's, and the coefficient of tangential restitution.
        impact_law: Option<(String, f64)> = None,
        /// The height and the vertical velocity of the lowest point at the start, in the air; None on the table.
        aloft: Option<[f64; 2]> = None,
        /// The slope of the table; `turning` is its rate of turning, `heading` is phi, and `place` the contact point,
        /// at the start.
        slope: f64 = 0.0,
        turning: f64 = 0.0,
        heading: f64 = 0.0,
        place: [f64; 2] = [0.0; 2],
        stop_at_rolling: bool = false,
        max_nfev: Option<u64> = None,
        pose: bool = false,
        force: bool = false,
        /// The user-defined couple and the user-defined coefficient of friction; None without such a law.
        couple: Option<GivenLaw> = None,
        friction: Option<GivenLaw> = None,
        /// A Python function that gives the force and the couple that drive the body.
        drive: Option<Py<PyAny>> = None,
        /// Whether the states of many motions are returned at all times, not only at the end.
        spread: bool = false,
        /// Whether many motions with friction or losses are computed twice, to estimate their errors.
        errors: bool = true,
    }
}

/// The names of the options of a motion.
#[pyfunction]
pub fn motion_options() -> [&'static str; MotionAsked::NAMES.len()] {
    MotionAsked::NAMES
}

/// The law of restitution with this name, and its coefficient of tangential restitution.
fn impact_law_of((name, tangential): &(String, f64)) -> PyResult<ImpactLaw> {
    Ok(match name.as_str() {
        "Newton" => ImpactLaw::Newton,
        "Poisson" => ImpactLaw::Poisson,
        "Walton" => ImpactLaw::Walton { tangential: *tangential },
        other => {
            return Err(PyValueError::new_err(format!(
                "impact_law = {other:?}: expected the name of a law of restitution"
            )));
        }
    })
}

impl MotionAsked {
    /// Whether any law is user-defined.
    pub fn is_custom(&self) -> bool {
        self.couple.is_some() || self.friction.is_some() || self.drive.is_some()
    }

    /// Whether a user-defined law is a Python function, for which the GIL is needed.
    pub fn calls_python(&self) -> bool {
        let given = [&self.couple, &self.friction].into_iter().flatten();
        self.drive.is_some() || given.into_iter().any(|law| law.function().is_some())
    }

    /// The user-defined laws that are C functions, as laws of the core.
    pub fn pointed(&self) -> PointedLaws {
        PointedLaws::of(self.couple.as_ref(), self.friction.as_ref())
    }

    /// The options of the core, from those that are not user-defined laws.
    pub fn ask(&self) -> PyResult<Ask> {
        Ok(Ask {
            table: table_of(self.table)?.with(self.coefficients),
            losses: self.losses.map_or(Losses::NONE, |coefficients| Losses { coefficients }),
            resistance: if self.while_slipping { Resistance::Always } else { Resistance::WhileRolling },
            method: match (self.step, self.tol) {
                (Some(step), _) => Method::Step(step),
                (_, Some(tol)) => Method::Tolerance(tol),
                _ => Method::Exact,
            },
            beyond: self.beyond,
            restitution: self.restitution,
            impact_law: self.impact_law.as_ref().map_or(Ok(ImpactLaw::Stronge), impact_law_of)?,
            face: Face::from_code(self.face)
                .ok_or_else(|| PyValueError::new_err("face: expected the code of a kind of face"))?,
            slope: self.slope,
            turning: self.turning,
            stop_at_rolling: self.stop_at_rolling,
            max_evaluations: self.max_nfev,
            pose: self.pose,
            force: self.force,
            ..Ask::default()
        })
    }
}
