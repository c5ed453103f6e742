//! Names and codes of the enumerations whose numbers stand in arrays.

use crate::laws::contact::TableKind;
use crate::laws::loss::Law;
use crate::many::motions::{Answer, BOUNDED, INVALID};
use crate::motions::drift::End;
use crate::motions::{Ending, Kind};
use crate::states::stability::Region;
use core::fmt::Debug;
use pyo3::prelude::*;

/// The names of an enumeration with their codes.
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

/// Names and codes of every enumeration, in the order of the codes. Tables and the ends of drifts have their own names, and
/// a law of loss that of its class.
#[pyfunction]
pub fn codes() -> [(&'static str, Codes); 8] {
    let endings = Ending::ALL.map(|x| (constant(&x), x as u8));
    let mut status: Codes = endings.iter().filter(|(_, code)| *code != BOUNDED).cloned().collect();
    status.extend([("INVALID".to_owned(), INVALID), ("BOUNDED".to_owned(), BOUNDED)]);
    status.sort_by_key(|(_, code)| *code);
    [
        ("Ending", endings.to_vec()),
        ("Status", status),
        ("Region", Region::ALL.map(|x| (constant(&x), x as u8)).to_vec()),
        ("Answer", Answer::ALL.map(|x| (constant(&x), x as u8)).to_vec()),
        ("Phase", Kind::ALL.map(|x| (format!("{x:?}").to_lowercase(), x as u8)).to_vec()),
        ("Table", TableKind::ALL.map(|x| (x.name().to_owned(), x as u8)).to_vec()),
        ("Law", Law::ALL.map(|x| (format!("{x:?}"), x as u8)).to_vec()),
        ("Drift", End::ALL.map(|x| (x.name().to_owned(), x as u8)).to_vec()),
    ]
}
