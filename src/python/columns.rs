//! Columns of numbers in Python dictionaries, by name.

use crate::laws::body::MOST_CIRCLES;
use crate::many::columns::at;
use crate::many::motions::CirclesOfRow;
use numpy::{PyReadonlyArray1, PyReadwriteArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The names of the columns of a state.
pub const STATE: [&str; 4] = ["theta", "w1", "w2", "w3"];

/// Input columns by name.
pub struct GivenColumns<'py>(Vec<(String, PyReadonlyArray1<'py, f64>)>);

impl<'py> GivenColumns<'py> {
    /// The input columns of a Python dictionary.
    pub fn of(columns: &Bound<'py, PyDict>) -> PyResult<Self> {
        let all = columns.iter().map(|(name, x)| Ok((name.extract()?, x.extract()?)));
        Ok(Self(all.collect::<PyResult<_>>()?))
    }

    fn column(&self, name: &str) -> PyResult<Option<&[f64]>> {
        let found = self.0.iter().find(|(other, _)| other == name);
        Ok(found.map(|(_, array)| array.as_slice()).transpose()?)
    }

    /// The input columns with these names; None if the first of them is missing.
    pub fn some<const N: usize>(&self, names: [&str; N]) -> PyResult<Option<[&[f64]; N]>> {
        let mut all = [&[] as &[f64]; N];
        for (i, name) in names.into_iter().enumerate() {
            match self.column(name)? {
                Some(column) => all[i] = column,
                None if i == 0 => return Ok(None),
                None => {
                    return Err(PyValueError::new_err(format!("columns: expected a column named {name}")));
                }
            }
        }
        Ok(Some(all))
    }

    pub fn all<const N: usize>(&self, names: [&str; N]) -> PyResult<[&[f64]; N]> {
        self.some(names)?
            .ok_or_else(|| PyValueError::new_err(format!("columns: expected a column named {}", names[0])))
    }
}

/// Output columns by name; each is handed out only once.
pub struct FilledColumns<'a>(pub Vec<(&'a str, Option<&'a mut [f64]>)>);

impl<'a> FilledColumns<'a> {
    pub fn take(&mut self, name: &str) -> Option<&'a mut [f64]> {
        self.0.iter_mut().find(|(other, _)| *other == name)?.1.take()
    }

    pub fn some<const N: usize>(&mut self, names: [&str; N]) -> Option<[&'a mut [f64]; N]> {
        let first = self.take(names[0])?;
        let mut first = Some(first);
        Some(names.map(|name| first.take().or_else(|| self.take(name)).unwrap_or_default()))
    }
}

/// The circles of bodies that have several, from the columns radius0, height0, fillet0, radius1 and so on: a row for each
/// body, or one for all; none without these columns.
pub fn circles_of(given: &GivenColumns<'_>) -> PyResult<Vec<CirclesOfRow>> {
    let (mut circles, mut columns) = (Vec::new(), Vec::new());
    for k in 0..MOST_CIRCLES {
        let names = ["radius", "height", "fillet"].map(|name| format!("{name}{k}"));
        columns.extend(given.some(names.each_ref().map(String::as_str))?);
    }
    let rows = columns.iter().flatten().map(|column| column.len()).max().unwrap_or(0);
    for i in 0..rows {
        let mut row = [[f64::NAN; 3]; MOST_CIRCLES];
        row.iter_mut().zip(&columns).for_each(|(to, columns)| *to = columns.map(|column| at(column, i)));
        circles.push(row);
    }
    Ok(circles)
}

/// The output column of codes with this name.
pub fn code_column<'py>(columns: &Bound<'py, PyDict>, name: &str) -> PyResult<PyReadwriteArray1<'py, u8>> {
    let found = columns.get_item(name)?;
    found.ok_or_else(|| PyValueError::new_err(format!("columns: expected a column named {name}")))?.extract()
}

/// The output column of numbers with this name.
pub fn numbers<'py>(columns: &Bound<'py, PyDict>, name: &str) -> PyResult<PyReadwriteArray1<'py, f64>> {
    let found = columns.get_item(name)?;
    found.ok_or_else(|| PyValueError::new_err(format!("columns: expected a column named {name}")))?.extract()
}
