//! Names and codes of the enumerations whose codes appear in arrays.

use crate::laws::contact::{Face, TableKind};
use crate::laws::loss::Law;
use crate::many::motions::Answer;
use crate::motions::drift::End;
use crate::motions::{Ending, Kind, RestsOn};
use crate::states::stability::Region;
use core::fmt::Debug;
use pyo3::prelude::*;

/// The names of the values of an enumeration, each with its code.
type Codes = Vec<(String, u8)>;

/// The name of a value as Python writes constants: LIFT_OFF for LiftOff.
fn constant(value: &impl Debug) -> String {
    let mut name = String::new();
    for letter in format!("{value:?}").chars() {
        if letter.is_uppercase() && !name.is_empty() {
            name.push('_');
        }
        name.push(letter.to_ascii_uppercase());
    }
    name
}

/// Names and codes of every enumeration, in the order of the codes. A loss law has the name of its Python class; kinds
/// of contact and ends of drifts have the names of the Python interface.
#[pyfunction]
pub fn codes() -> [(&'static str, Codes); 10] {
    let status: Codes = Ending::ALL.iter().map(|x| (constant(x), *x as u8)).collect();
    let endings = status.iter().filter(|(_, code)| *code != Ending::Invalid as u8).cloned();
    [
        ("Ending", endings.collect()),
        ("Status", status),
        ("Region", Region::ALL.iter().map(|x| (constant(x), *x as u8)).collect()),
        ("Answer", Answer::ALL.iter().map(|x| (constant(x), *x as u8)).collect()),
        ("RestsOn", RestsOn::ALL.iter().map(|x| (constant(x), *x as u8)).collect()),
        ("Phase", Kind::ALL.iter().map(|x| (format!("{x:?}").to_lowercase(), *x as u8)).collect()),
        ("Table", TableKind::ALL.iter().map(|x| (x.name().to_owned(), *x as u8)).collect()),
        ("Face", Face::ALL.iter().map(|x| (x.to_string(), *x as u8)).collect()),
        ("Law", Law::ALL.iter().map(|x| (format!("{x:?}"), *x as u8)).collect()),
        ("Drift", End::ALL.iter().map(|x| (x.name().to_owned(), *x as u8)).collect()),
    ]
}
