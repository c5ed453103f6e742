//! Columns of numbers: each column has the length n, or is a single number for all rows.

pub(crate) fn rows<'a>(mut columns: impl Iterator<Item = &'a [f64]>) -> usize {
    columns.find(|x| x.len() != 1).map_or(1, <[f64]>::len)
}

/// Whether every column has this length or is a single number.
pub(crate) fn fit<'a>(mut columns: impl Iterator<Item = &'a [f64]>, count: usize) -> bool {
    columns.all(|x| x.len() == 1 || x.len() == count)
}

/// The number in a row of a column.
pub(crate) fn at(column: &[f64], row: usize) -> f64 {
    column[if column.len() == 1 { 0 } else { row }]
}
