//! Columns of numbers, one row for each body or motion. An input column has the length n, or is a single number for all
//! rows; output columns are divided into blocks of rows.

use crate::error::{Error, room};
use crate::laws::loss::{COUNT, Law, Losses};

pub(crate) fn rows<'a>(mut columns: impl Iterator<Item = &'a [f64]>) -> usize {
    columns.find(|x| x.len() != 1).map_or(1, <[f64]>::len)
}

/// Whether every column has the length `count` or is a single number.
pub(crate) fn fit<'a>(mut columns: impl Iterator<Item = &'a [f64]>, count: usize) -> bool {
    columns.all(|x| x.len() == 1 || x.len() == count)
}

/// The number of a column in the row with this index.
pub(crate) fn at(column: &[f64], row: usize) -> f64 {
    column[if column.len() == 1 { 0 } else { row }]
}

/// Columns of the coefficients of losses, one for each law: each has the length n, or is a single number for all rows.
///
/// ```
/// use spincyl::ensemble::LossColumns;
/// use spincyl::loss::Law;
///
/// let arms = [0.0, 1e-3, 2e-3];
/// let losses = LossColumns::NONE.with(Law::RollingResistance, &arms).with(Law::AirFilm, &[1e-7]);
/// # let _ = losses;
/// ```
#[derive(Debug, Clone, Copy)]
pub struct LossColumns<'a>(pub(crate) [&'a [f64]; COUNT]);

impl<'a> LossColumns<'a> {
    /// Columns of coefficients that are all 0: no losses.
    pub const NONE: Self = Self([&[0.0]; COUNT]);

    /// Returns these columns with a column of coefficients for this law.
    #[must_use]
    pub fn with(mut self, law: Law, column: &'a [f64]) -> Self {
        self.0[law as usize] = column;
        self
    }

    /// The losses of the body or motion with the index `row`.
    pub(crate) fn row(&self, row: usize) -> Losses {
        Losses { coefficients: self.0.map(|x| at(x, row)) }
    }
}

/// Columns of the numbers that describe bodies: each has the length n, or is a single number for all rows.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct BodyColumns<'a> {
    /// Height of the centre of mass above the rim, in R.
    pub ell: &'a [f64],
    /// Moment of inertia about a diameter through the centre of mass, in M R^2.
    pub i1: &'a [f64],
    /// Moment of inertia about the axis, in M R^2.
    pub i3: &'a [f64],
    /// Inner radius of a tube, in R; NaN for other bodies.
    pub bore: &'a [f64],
    /// Radius of the fillet of the rim, in R; 0 for a sharp rim.
    pub fillet: &'a [f64],
    /// Inclination, in radians, at which another part of the body touches the table; NaN for the default of the body.
    pub theta_end: &'a [f64],
}

impl<'a> BodyColumns<'a> {
    /// Bodies with sharp rims.
    ///
    /// ```
    /// use spincyl::ensemble::BodyColumns;
    ///
    /// // Three bodies of different moments about a diameter.
    /// let bodies = BodyColumns::new(&[1.0], &[0.5, 0.6, 0.7], &[0.5]).with_fillet(&[0.1]);
    /// assert_eq!((bodies.i1.len(), bodies.fillet), (3, &[0.1][..]));
    /// ```
    pub const fn new(ell: &'a [f64], i1: &'a [f64], i3: &'a [f64]) -> Self {
        Self { ell, i1, i3, bore: &[f64::NAN], fillet: &[0.0], theta_end: &[f64::NAN] }
    }

    /// Returns these bodies with this column of the inner radii of tubes, in R.
    #[must_use]
    pub const fn with_bore(self, bore: &'a [f64]) -> Self {
        Self { bore, ..self }
    }

    /// Returns these bodies with this column of the radii of the fillets, in R.
    #[must_use]
    pub const fn with_fillet(self, fillet: &'a [f64]) -> Self {
        Self { fillet, ..self }
    }

    /// Returns these bodies with this column of the inclinations, in radians, at which another part of the body touches
    /// the table.
    #[must_use]
    pub const fn with_theta_end(self, theta_end: &'a [f64]) -> Self {
        Self { theta_end, ..self }
    }
}

/// Columns of the four numbers of a [`State`](crate::State), as an input or an output.
#[derive(Debug, Clone, Copy)]
pub struct StateColumns<C> {
    /// Inclinations, in radians.
    pub theta: C,
    /// Angular velocities along e1, in sqrt(g/R).
    pub w1: C,
    /// Angular velocities along e2, in sqrt(g/R).
    pub w2: C,
    /// Angular velocities along the symmetry axis, in sqrt(g/R).
    pub w3: C,
}

impl<C> From<[C; 4]> for StateColumns<C> {
    /// The columns theta, w1, w2, w3, in this order, as those of a [`State`](crate::State).
    fn from([theta, w1, w2, w3]: [C; 4]) -> Self {
        Self { theta, w1, w2, w3 }
    }
}

impl<C> From<StateColumns<C>> for [C; 4] {
    fn from(of: StateColumns<C>) -> Self {
        [of.theta, of.w1, of.w2, of.w3]
    }
}

/// Output columns that can be split at a row.
pub(crate) trait Split: Sized {
    /// Splits the columns into the first `rows` rows and the remaining rows.
    fn split(self, rows: usize) -> (Self, Self);
}

impl<T> Split for &mut [T] {
    fn split(self, rows: usize) -> (Self, Self) {
        self.split_at_mut(rows)
    }
}

impl<C: Split> Split for Option<C> {
    fn split(self, rows: usize) -> (Self, Self) {
        self.map(|columns| columns.split(rows)).unzip()
    }
}

impl<C: Split, const N: usize> Split for [C; N] {
    fn split(self, rows: usize) -> (Self, Self) {
        let mut later: [Option<C>; N] = [const { None }; N];
        let mut places = later.iter_mut();
        let first = self.map(|column| {
            let (first, rest) = column.split(rows);
            if let Some(place) = places.next() {
                *place = Some(rest);
            }
            first
        });
        (first, later.map(|rest| rest.expect("as many as there are columns")))
    }
}

/// A block of rows: the first row, the number of rows, and their part of the columns.
pub(crate) struct RowBlock<C> {
    pub first: usize,
    pub count: usize,
    pub out: C,
}

/// Divides the columns into blocks of `size` rows.
pub(crate) fn blocks<C: Split>(out: C, count: usize, size: usize) -> Result<Vec<RowBlock<C>>, Error> {
    let (mut rest, mut blocks) = (Some(out), room(count.div_ceil(size))?);
    for first in (0..count).step_by(size) {
        let count = size.min(count - first);
        let (out, after) = rest.split(count);
        rest = after;
        blocks.extend(out.map(|out| RowBlock { first, count, out }));
    }
    Ok(blocks)
}
