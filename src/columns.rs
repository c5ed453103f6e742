//! Columns of numbers: each of one length n, or a single number for all.

/// How many rows there are.
pub(crate) fn rows<'a>(mut columns: impl Iterator<Item = &'a [f64]>) -> usize {
    columns.find(|x| x.len() != 1).map_or(1, <[f64]>::len)
}

/// Whether every column is of this length, or a single number.
pub(crate) fn fit<'a>(mut columns: impl Iterator<Item = &'a [f64]>, count: usize) -> bool {
    columns.all(|x| x.len() == 1 || x.len() == count)
}

/// The number of a row.
pub(crate) fn at(column: &[f64], row: usize) -> f64 {
    column[if column.len() == 1 { 0 } else { row }]
}
