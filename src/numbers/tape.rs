//! Power series of all intermediate results of a law, computed order by order from a record of its operations.
//!
//! ```text
//! (a b)_n = sum a_j b_(n-j),   (a/b)_n = (a_n - sum_(j<n) (a/b)_j b_(n-j))/b_0,   (r r)_n = a_n for r = sqrt(a)
//! n > 0   if x_n grows by h, every coefficient n grows by h times the derivative, at t = 0, with respect to x
//! ```
//! Evaluating a law once with the numbers of a [`Tape`] records its operations. A [`Player`] repeats them on
//! power series: the coefficients of one order follow from those of lower orders and of the given numbers, so
//! that a law of differential equations gives the series of its own solution in one run. The formulas are
//! recurrences of automatic differentiation (Griewank and Walther 2008, ch. 13). Error: a few roundings of
//! the largest product in each coefficient.

use super::real::{Real, operators};
use super::series::{Series, TERMS};
use core::cell::RefCell;
use core::ops::Range;

/// An operation on numbers in a recorded law; its operands are the results of earlier operations.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Op {
    Given,
    Constant(f64),
    /// The sum of two operands, each multiplied by a constant.
    Sum([u16; 2], [f64; 2]),
    /// The operand times the first constant, plus the second constant.
    Affine(u16, [f64; 2]),
    Product([u16; 2]),
    Quotient([u16; 2]),
    Root(u16),
    Rounded(u16),
    /// The third operand where the first is less than the second at t = 0, else the fourth.
    Selected([u16; 4]),
}

impl Op {
    /// This operation with `to` applied to the index of each operand.
    fn with(self, mut to: impl FnMut(u16) -> u16) -> Self {
        match self {
            Self::Given | Self::Constant(_) => self,
            Self::Sum(of, k) => Self::Sum(of.map(to), k),
            Self::Affine(a, k) => Self::Affine(to(a), k),
            Self::Product(of) => Self::Product(of.map(to)),
            Self::Quotient(of) => Self::Quotient(of.map(to)),
            Self::Root(a) => Self::Root(to(a)),
            Self::Rounded(a) => Self::Rounded(to(a)),
            Self::Selected(of) => Self::Selected(of.map(to)),
        }
    }
}

/// The recorded operations of a law.
#[derive(Debug, Default)]
pub(crate) struct Tape {
    ops: RefCell<Vec<Op>>,
}

/// A number in a recorded law: `scale` times the result of an operation, plus `shift`; or, with `scale` 0, the constant
/// `shift`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Taped<'a> {
    tape: &'a Tape,
    of: Option<u16>,
    /// The factor of the result of the operation; 0 for a constant.
    scale: f64,
    shift: f64,
}

impl Tape {
    /// A number that the law is given; the player receives its series.
    pub fn given(&self) -> Taped<'_> {
        let mut ops = self.ops.borrow_mut();
        ops.push(Op::Given);
        self.plain((ops.len() - 1) as u16)
    }

    /// A constant number in the recorded law.
    pub fn number(&self, x: f64) -> Taped<'_> {
        Taped { tape: self, of: None, scale: 0.0, shift: x }
    }

    fn plain(&self, result: u16) -> Taped<'_> {
        Taped { tape: self, of: Some(result), scale: 1.0, shift: 0.0 }
    }

    /// The index of an operation in the record. An operation that is already recorded is not recorded once more, since
    /// laws repeat many.
    fn result(&self, op: Op) -> u16 {
        let mut ops = self.ops.borrow_mut();
        let known = ops.iter().rposition(|known| *known == op);
        known.unwrap_or_else(|| {
            ops.push(op);
            ops.len() - 1
        }) as u16
    }

    /// A player of the operations that the results `first` need, and of those that only the results `then` need. The
    /// player numbers given numbers and results as in these arguments.
    pub fn player(&self, given: &[Taped], first: &[Taped], then: &[Taped]) -> Player {
        let ids = |of: &[Taped]| of.iter().map(|x| x.index()).collect::<Vec<u16>>();
        let (given, first, then) = (ids(given), ids(first), ids(then));
        let ops = self.ops.borrow();
        let mut wanted = [vec![false; ops.len()], vec![false; ops.len()]];
        for (wanted, of) in wanted.iter_mut().zip([&first, &then]) {
            of.iter().for_each(|i| wanted[*i as usize] = true);
            for (i, op) in ops.iter().enumerate().rev() {
                if wanted[i] {
                    op.with(|a| {
                        wanted[a as usize] = true;
                        a
                    });
                }
            }
        }
        let [wanted, later] = wanted;
        let is_done = |i: usize| !matches!(ops[i], Op::Given | Op::Constant(_));
        let constant = |i: &usize| matches!(ops[*i], Op::Constant(_)) && (wanted[*i] || later[*i]);
        let mut order: Vec<usize> = given.iter().map(|i| *i as usize).collect();
        order.extend((0..ops.len()).filter(constant));
        let begin = order.len();
        order.extend((0..ops.len()).filter(|i| is_done(*i) && wanted[*i]));
        let middle = order.len();
        order.extend((0..ops.len()).filter(|i| is_done(*i) && !wanted[*i] && later[*i]));
        let mut place = vec![0u16; ops.len()];
        order.iter().enumerate().for_each(|(to, from)| place[*from] = to as u16);
        let rows = order.iter().map(|i| match ops[*i] {
            Op::Constant(k) => Row { at: Series::of(k).at, slope: 0.0 },
            _ => Row { at: [0.0; TERMS], slope: 0.0 },
        });
        let placed = |of: &[u16]| of.iter().map(|i| place[*i as usize]).collect();
        Player {
            rows: rows.collect(),
            ops: order.iter().map(|i| ops[*i].with(|a| place[a as usize])).collect(),
            first: begin..middle,
            then: middle..order.len(),
            results: [placed(&first), placed(&then)],
        }
    }
}

impl Taped<'_> {
    /// The index of an operation whose result is this number; one is recorded if necessary.
    fn index(self) -> u16 {
        match self.of {
            None => self.tape.result(Op::Constant(self.shift)),
            Some(i) if self.scale == 1.0 && self.shift == 0.0 => i,
            Some(i) => self.tape.result(Op::Affine(i, [self.scale, self.shift])),
        }
    }

    /// The index of an operation and a constant, whose product is this number.
    fn factor(self) -> (u16, f64) {
        match self.of {
            Some(i) if self.shift == 0.0 => (i, self.scale),
            _ => (self.index(), 1.0),
        }
    }

    #[inline(never)]
    fn scaled(self, k: f64) -> Self {
        if k == 0.0 { self.splat(0.0) } else { Self { scale: k * self.scale, shift: k * self.shift, ..self } }
    }

    #[inline(never)]
    fn sum(self, b: Self) -> Self {
        let shift = self.shift + b.shift;
        match (self.of, b.of) {
            (_, None) => Self { shift, ..self },
            (None, _) => Self { shift, ..b },
            (Some(x), Some(y)) if x == y => {
                let scale = self.scale + b.scale;
                if scale == 0.0 { self.splat(shift) } else { Self { scale, shift, ..self } }
            }
            (Some(x), Some(y)) => {
                Self { shift, ..self.tape.plain(self.tape.result(Op::Sum([x, y], [self.scale, b.scale]))) }
            }
        }
    }

    #[inline(never)]
    fn less(self, b: Self) -> Self {
        self.sum(b.scaled(-1.0))
    }

    #[inline(never)]
    fn times(self, b: Self) -> Self {
        match (self.of, b.of) {
            (_, None) => self.scaled(b.shift),
            (None, _) => b.scaled(self.shift),
            _ => {
                let ((x, j), (y, k)) = (self.factor(), b.factor());
                self.tape.plain(self.tape.result(Op::Product([x.min(y), x.max(y)]))).scaled(j * k)
            }
        }
    }

    #[inline(never)]
    fn over(self, b: Self) -> Self {
        let Some(_) = b.of else {
            return Self { scale: self.scale / b.shift, shift: self.shift / b.shift, ..self };
        };
        let ((x, j), (y, k)) = (self.factor(), b.factor());
        self.tape.plain(self.tape.result(Op::Quotient([x, y]))).scaled(j / k)
    }
}

operators!(['a] Taped<'a>, (a, b), a.sum(b), a.less(b), a.times(b), a.over(b), a.scaled(-1.0));

impl Real for Taped<'_> {
    #[inline(never)]
    fn splat(self, x: f64) -> Self {
        self.tape.number(x)
    }
    fn sqrt(self) -> Self {
        match self.of {
            None => self.splat(self.shift.sqrt()),
            Some(_) => self.tape.plain(self.tape.result(Op::Root(self.index()))),
        }
    }
    fn round(self) -> Self {
        match self.of {
            None => self.splat(self.shift.round_ties_even()),
            Some(_) => self.tape.plain(self.tape.result(Op::Rounded(self.index()))),
        }
    }
    /// Selects `yes` or `no` by comparing the values at t = 0.
    fn select_lt(self, other: Self, yes: Self, no: Self) -> Self {
        if self.of.is_none() && other.of.is_none() {
            return if self.shift < other.shift { yes } else { no };
        }
        self.tape.plain(self.tape.result(Op::Selected([self, other, yes, no].map(Self::index))))
    }
}

/// The power series of a number, and its derivative at t = 0 with respect to the quantity that [`Player::lean`]
/// chooses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub at: [f64; TERMS],
    pub slope: f64,
}

/// Repeats the recorded operations of a law on power series.
#[derive(Debug)]
pub(crate) struct Player {
    rows: Vec<Row>,
    ops: Vec<Op>,
    first: Range<usize>,
    then: Range<usize>,
    results: [Vec<u16>; 2],
}

/// The sum of a_j b_(n-j) over 0 < j < n, of even and of odd j, so that one product does not wait for the other.
#[inline(always)]
fn inner_products(a: &Row, b: &Row, n: usize) -> f64 {
    let mut sums = [0.0; 2];
    (1..n).for_each(|j| sums[j % 2] += a.at[j] * b.at[n - j]);
    sums[0] + sums[1]
}

impl Player {
    /// Sets the coefficient `n` of the given number `i`.
    pub fn set(&mut self, i: usize, n: usize, x: f64) {
        self.rows[i].at[n] = x;
    }

    /// Sets the derivative of the given number `i` with respect to the chosen quantity; the default is 0.
    pub fn lean(&mut self, i: usize, slope: f64) {
        self.rows[i].slope = slope;
    }

    /// The coefficients of the series of the given number `i`.
    pub fn given(&self, i: usize) -> &[f64; TERMS] {
        &self.rows[i].at
    }

    /// The result `i` among those that [`Tape::player`] was given as `first`.
    #[inline(always)]
    pub fn result(&self, i: usize) -> &Row {
        &self.rows[self.results[0][i] as usize]
    }

    /// The first `known` coefficients of the result `i` among those that [`Tape::player`] was given as `then`.
    pub fn later(&self, i: usize, known: usize) -> Series {
        Series::first(&self.rows[self.results[1][i] as usize].at, known)
    }

    /// Computes the values of the `first` results of [`Tape::player`] at t = 0, and their derivatives.
    pub fn begin(&mut self) {
        self.at_first(self.first.clone());
    }

    /// Computes coefficient `n` > 0 of the series of the first results of [`Tape::player`], from the coefficients before it.
    pub fn go_on(&mut self, n: usize) {
        self.order(self.first.clone(), n);
    }

    /// Computes the first `known` coefficients of the `then` results of [`Tape::player`].
    pub fn finish(&mut self, known: usize) {
        self.at_first(self.then.clone());
        (1..known).for_each(|n| self.order(self.then.clone(), n));
    }

    /// Adds `h` to coefficient `n` > 0 of the quantity that [`Player::lean`] chose, and updates this coefficient of all
    /// `first` results.
    pub fn turn(&mut self, n: usize, h: f64) {
        let (given, results) = self.rows[..self.first.end].split_at_mut(self.first.start);
        // A constant stays what it is, even if `h` is NaN, so that the next series does not begin with NaN.
        for row in given.iter_mut().filter(|row| row.slope != 0.0).chain(results) {
            row.at[n] += row.slope * h;
        }
    }

    fn at_first(&mut self, range: Range<usize>) {
        for (i, op) in range.clone().zip(&self.ops[range]) {
            let (rows, to) = self.rows.split_at_mut(i);
            let at = |i: u16| (rows[i as usize].at[0], rows[i as usize].slope);
            let (value, slope) = match *op {
                Op::Given | Op::Constant(_) => continue,
                Op::Sum(of, [j, k]) => {
                    let [a, b] = of.map(at);
                    (j * a.0 + k * b.0, j * a.1 + k * b.1)
                }
                Op::Affine(a, [k, more]) => (k * at(a).0 + more, k * at(a).1),
                Op::Product(of) => {
                    let [a, b] = of.map(at);
                    (a.0 * b.0, a.1 * b.0 + a.0 * b.1)
                }
                Op::Quotient(of) => {
                    let [a, b] = of.map(at);
                    let value = a.0 / b.0;
                    (value, (a.1 - value * b.1) / b.0)
                }
                Op::Root(a) => {
                    let root = at(a).0.sqrt();
                    // A constant zero has the derivative 0, and so has its root; 0/0 would be NaN.
                    (root, at(a).1 / (root + root).max(f64::MIN_POSITIVE))
                }
                Op::Rounded(a) => (at(a).0.round_ties_even(), 0.0),
                Op::Selected([a, b, yes, no]) => at(if at(a).0 < at(b).0 { yes } else { no }),
            };
            (to[0].at[0], to[0].slope) = (value, slope);
        }
    }

    /// Computes coefficient `n` of the result of each operation in `range`. Each order has its own code, whose sums
    /// have no loops, except where the code has to be short.
    fn order(&mut self, range: Range<usize>, n: usize) {
        #[cfg(not(short_code))]
        macro_rules! orders {
            ($($n:literal)+) => { match n { $($n => self.order_here(range, $n),)+ _ => self.order_here(range, n) } };
        }
        #[cfg(not(short_code))]
        orders!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17);
        #[cfg(short_code)]
        self.order_here(range, n);
    }

    #[cfg_attr(short_code, inline(never))]
    #[cfg_attr(not(short_code), inline(always))]
    fn order_here(&mut self, range: Range<usize>, n: usize) {
        // With this bound the compiler omits the checks of the indices of rows.
        let n = n.min(TERMS - 1);
        for (i, op) in range.clone().zip(&self.ops[range]) {
            let (rows, to) = self.rows.split_at_mut(i);
            let row = |i: u16| &rows[i as usize];
            let to = &mut to[0];
            to.at[n] = match *op {
                Op::Given | Op::Constant(_) => continue,
                Op::Sum([a, b], [j, k]) => j * row(a).at[n] + k * row(b).at[n],
                Op::Affine(a, [k, _]) => k * row(a).at[n],
                Op::Product(of) => {
                    let [a, b] = of.map(row);
                    inner_products(a, b, n) + (a.at[0] * b.at[n] + a.at[n] * b.at[0])
                }
                Op::Quotient(of) => {
                    let [a, b] = of.map(row);
                    (a.at[n] - inner_products(to, b, n) - to.at[0] * b.at[n]) / b.at[0]
                }
                Op::Root(a) => {
                    let rest = row(a).at[n] - inner_products(to, to, n);
                    if to.at[0] == 0.0 && rest == 0.0 { 0.0 } else { rest / (2.0 * to.at[0]) }
                }
                Op::Rounded(_) => 0.0,
                Op::Selected([a, b, yes, no]) => {
                    row(if row(a).at[0] < row(b).at[0] { yes } else { no }).at[n]
                }
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::dual::Dual;
    use super::*;

    /// A law with every operation, on given numbers, on constants, and on sums of the two.
    fn law<T: Real>([a, b]: [T; 2]) -> Vec<T> {
        let (half, two) = (a.splat(0.5), a.splat(2.0));
        let most = a.max(b.splat(0.1)).min(two * b);
        vec![
            (two * a - b) / (a * b + two),
            (a * a + two).sqrt() - (a - half) / two,
            (a - b).abs() * -(b - half) + most,
            two / (b + half) + a.round() + two.sqrt(),
            (a + two) * (half - b) - (a + two) * b,
            a / (two * b) + (two * a + a) * b,
        ]
    }

    const GIVEN: [[f64; 6]; 2] = [[0.7, -1.3, 0.4, 2.0, -0.1, 0.9], [1.9, 0.3, -2.2, 0.6, 1.1, -0.5]];

    /// A player of the law on these two series, with derivatives with respect to the first number.
    fn played([a, b]: [[f64; 6]; 2]) -> Player {
        let tape = Tape::default();
        let given = [tape.given(), tape.given()];
        let results = law(given);
        let mut player = tape.player(&given, &results, &results);
        for (n, (a, b)) in a.into_iter().zip(b).enumerate() {
            player.set(0, n, a);
            player.set(1, n, b);
        }
        player.lean(0, 1.0);
        player.begin();
        (1..TERMS).for_each(|n| player.go_on(n));
        player
    }

    #[test]
    fn the_series_of_a_law_have_its_values_and_its_derivatives() {
        let player = played(GIVEN);
        let t = 0.01;
        let [a, b] = GIVEN.map(|x| x.iter().rev().fold(0.0, |sum, x| sum * t + x));
        let dual = |value: f64, slope: f64| Dual { value, slope };
        let derived = law([dual(GIVEN[0][0], 1.0), dual(GIVEN[1][0], 0.0)]);
        for (i, (right, derived)) in law([a, b]).into_iter().zip(derived).enumerate() {
            let found = player.later(i, TERMS).value(t);
            assert!((found - right).abs() < 1e-14, "{i}: {found} {right}");
            let slope = player.result(i).slope;
            assert!((slope - derived.slope).abs() < 1e-14, "{i}: {slope} {}", derived.slope);
        }
    }

    #[test]
    fn a_coefficient_that_grows_takes_all_of_its_order_along() {
        let (mut player, mut other) = (played(GIVEN), GIVEN);
        player.turn(3, 0.25);
        other[0][3] += 0.25;
        let right = played(other);
        for i in 0..law([1.0; 2]).len() {
            let [found, right] = [&player, &right].map(|player| player.result(i).at[3]);
            assert!((found - right).abs() < 1e-14, "{i}: {found} {right}");
        }
    }
}
