//! Dormand and Prince's method of eighth order, with two errors of lower order.
//!
//! ```text
//! y(t + h) = y + h sum b_i k_i,   k_1 = f(y),   k_i = f(y + h sum a_ij k_j)              twelve stages
//! error    = h e5^2/sqrt(e5^2 + e3^2/100),   e5 and e3 of fifth and third order
//! h next   = 0.9 h error^(-1/8)
//! ```
//! The method is in Prince and Dormand 1981; the coefficients and the error are those of Hairer, Noersett and Wanner,
//! Solving Ordinary Differential Equations I (1993), II.5 and II.10 (DOP853). `f` writes the derivatives of N
//! variables, single or in SIMD lanes, and does not depend on time. The stages are called in their order, each with a
//! state within the step. A part of a step is computed as a separate step from the same k_1, so that an event within a
//! step is located with the accuracy of the step, not with that of an interpolation.
//!
//! Error: the error of a pendulum goes as h^8; the tests at the end run it.

use crate::numbers::Real;

/// The result of a step: the change of y, and the errors h e5 and h e3.
pub(crate) struct Step<T, const N: usize> {
    pub change: [T; N],
    pub fifth: [T; N],
    pub third: [T; N],
}

impl<T: Real, const N: usize> Step<T, N> {
    /// The error of the step by the formula at the top of this file; `per(i)` is the inverse of the tolerance of
    /// variable `i`, and `count` is N for a mean square over the variables, or 1 for a sum. Overflow gives NaN, since
    /// an error of 0 would accept the step.
    #[inline(always)]
    pub fn error(&self, per: impl Fn(usize) -> T, count: f64) -> T {
        let number = |x: f64| self.change[0].splat(x);
        let (mut fifth, mut third) = (number(0.0), number(1e-60));
        for i in 0..N {
            let per = per(i);
            let (a, b) = (self.fifth[i] * per, self.third[i] * per);
            (fifth, third) = (a.mac(a, fifth), b.mac(b, third));
        }
        let square = (fifth + number(0.01) * third) * number(count);
        fifth / square.sqrt() + number(0.0) * square
    }

    /// A factor of at least 1 for the error of a step in which the first `count` variables change by less than
    /// 1/`SLOW_CHANGE_FACTOR` per unit of time. Near an unstable equilibrium errors grow as fast as the motion itself,
    /// so that the error is then bounded relative to the motion. This never makes a tolerance smaller than `ROUNDING`.
    #[inline(always)]
    pub fn strictness(&self, tol: T, count: usize, time: usize) -> T {
        let number = |x: f64| tol.splat(x);
        let mut moved = self.change[0].abs();
        // In lanes, a closure of an iterator would be a function that is called.
        for x in &self.change[1..count] {
            moved = moved.max(x.abs());
        }
        let spared = (tol * number(1.0 / ROUNDING)).max(number(1.0));
        let span = self.change[time].abs();
        (span / (number(SLOW_CHANGE_FACTOR) * moved + number(1e-60))).max(number(1.0)).min(spared)
    }
}

/// [`Step::strictness`] divides the tolerance where all variables change by less than 1/`SLOW_CHANGE_FACTOR` per unit of time.
const SLOW_CHANGE_FACTOR: f64 = 100.0;
/// The smallest tolerance that [`Step::strictness`] may produce; a smaller error is rounding.
const ROUNDING: f64 = 3e-15;

/// Whether the stages of a step form a loop, unless a flow chooses otherwise: only in the short code for web pages. A
/// program that is compiled for debugging takes the same steps as one that is compiled for speed.
pub(crate) const LOOPS: bool = cfg!(short_code);

/// The number of stages of a step; the weights `a_ij` count the stages from 0 on.
pub(crate) const STAGES: usize = 12;
type Weights<const M: usize> = [(usize, f64); M];

#[rustfmt::skip]
const STAGE_2: Weights<1> = [(0, 0.05260015195876773)];
#[rustfmt::skip]
const STAGE_3: Weights<2> = [(0, 0.0197250569845379), (1, 0.0591751709536137)];
#[rustfmt::skip]
const STAGE_4: Weights<2> = [(0, 0.02958758547680685), (2, 0.08876275643042054)];
#[rustfmt::skip]
const STAGE_5: Weights<3> = [(0, 0.2413651341592667), (2, -0.8845494793282861), (3, 0.924834003261792)];
#[rustfmt::skip]
const STAGE_6: Weights<3> = [(0, 0.037037037037037035), (3, 0.17082860872947386), (4, 0.12546768756682242)];
#[rustfmt::skip]
const STAGE_7: Weights<4> = [(0, 0.037109375), (3, 0.17025221101954405), (4, 0.06021653898045596), (5, -0.017578125)];
#[rustfmt::skip]
const STAGE_8: Weights<5> = [(0, 0.03709200011850479), (3, 0.17038392571223998), (4, 0.10726203044637328), (5, -0.015319437748624402), (6, 0.008273789163814023)];
#[rustfmt::skip]
const STAGE_9: Weights<6> = [(0, 0.6241109587160757), (3, -3.3608926294469414), (4, -0.868219346841726), (5, 27.59209969944671), (6, 20.154067550477894), (7, -43.48988418106996)];
#[rustfmt::skip]
const STAGE_10: Weights<7> = [(0, 0.47766253643826434), (3, -2.4881146199716677), (4, -0.590290826836843), (5, 21.230051448181193), (6, 15.279233632882423), (7, -33.28821096898486), (8, -0.020331201708508627)];
#[rustfmt::skip]
const STAGE_11: Weights<8> = [(0, -0.9371424300859873), (3, 5.186372428844064), (4, 1.0914373489967295), (5, -8.149787010746927), (6, -18.52006565999696), (7, 22.739487099350505), (8, 2.4936055526796523), (9, -3.0467644718982196)];
#[rustfmt::skip]
const STAGE_12: Weights<9> = [(0, 2.273310147516538), (3, -10.53449546673725), (4, -2.0008720582248625), (5, -17.9589318631188), (6, 27.94888452941996), (7, -2.8589982771350235), (8, -8.87285693353063), (9, 12.360567175794303), (10, 0.6433927460157636)];
#[rustfmt::skip]
const SOLUTION_WEIGHTS: Weights<8> = [(0, 0.054293734116568765), (5, 4.450312892752409), (6, 1.8915178993145003), (7, -5.801203960010585), (8, 0.3111643669578199), (9, -0.1521609496625161), (10, 0.20136540080403034), (11, 0.04471061572777259)];
#[rustfmt::skip]
const FIFTH_ORDER_ERROR: Weights<8> = [(0, 0.01312004499419488), (5, -1.2251564463762044), (6, -0.4957589496572502), (7, 1.6643771824549864), (8, -0.35032884874997366), (9, 0.3341791187130175), (10, 0.08192320648511571), (11, -0.022355307863886294)];
#[rustfmt::skip]
const THIRD_ORDER_ERROR: Weights<8> = [(0, -0.18980075407240762), (5, 4.450312892752409), (6, 1.8915178993145003), (7, -5.801203960010585), (8, -0.4226823213237919), (9, -0.1521609496625161), (10, 0.20136540080403034), (11, 0.02265179219836082)];

/// Space for the rates at the stages of a step, which an integration keeps from one step to the next.
pub(crate) type Stages<T, const N: usize> = [[T; N]; STAGES];

/// The sum `a_1 k_1 + ...` over the stages, for variable `i`.
#[inline(always)]
fn weighted<T: Real, const N: usize, const M: usize>(
    k: &Stages<T, N>,
    weights: &[(usize, f64); M],
    i: usize,
) -> T {
    let (first, weight) = weights[0];
    let mut sum = k[first][i].splat(weight) * k[first][i];
    for (stage, weight) in &weights[1..] {
        sum = k[*stage][i].mac(sum.splat(*weight), sum);
    }
    sum
}

/// The stages whose variables approximate the solution, each as [index, time as a share of the step].
pub(crate) const LOOKS: [(usize, f64); 3] = [(5, 1.0 / 3.0), (9, 0.6), (10, 6.0 / 7.0)];

/// The variables y of a stage, from the rates of the stages before it.
#[inline(always)]
pub(crate) fn place<T: Real, const N: usize>(stage: usize, y: &[T; N], h: T, k: &Stages<T, N>) -> [T; N] {
    let mut at = *y;
    write_place(stage, y, h, k, &mut at);
    at
}

/// Writes the variables y of a stage into `at`, since in SIMD lanes a copy of all variables would take as long as
/// computing some of them.
#[inline(always)]
fn write_place<T: Real, const N: usize>(stage: usize, y: &[T; N], h: T, k: &Stages<T, N>, at: &mut [T; N]) {
    macro_rules! by {
        ($weights:expr) => {
            for i in 0..N {
                at[i] = weighted(k, &$weights, i).mac(h, y[i]);
            }
        };
    }
    match stage {
        1 => by!(STAGE_2),
        2 => by!(STAGE_3),
        3 => by!(STAGE_4),
        4 => by!(STAGE_5),
        5 => by!(STAGE_6),
        6 => by!(STAGE_7),
        7 => by!(STAGE_8),
        8 => by!(STAGE_9),
        9 => by!(STAGE_10),
        10 => by!(STAGE_11),
        _ => by!(STAGE_12),
    }
}

/// One step of length `h` from `y`, where `k1 = f(y)` is known; LOOP says whether the stages form a loop or are written out.
#[inline(always)]
pub(crate) fn step<const LOOP: bool, T: Real, const N: usize>(
    mut f: impl FnMut(&[T; N], &mut [T; N]),
    y: &[T; N],
    k1: &[T; N],
    h: T,
    k: &mut Stages<T, N>,
) -> Step<T, N> {
    k[0] = *k1;
    if LOOP {
        // Eleven inlined copies of the rates in lanes would take most of the time of the compiler.
        let mut at = *y;
        for stage in 1..STAGES {
            write_place(stage, y, h, k, &mut at);
            f(&at, &mut k[stage]);
        }
    } else {
        // In a loop, a vector load would wait for numbers that were just stored one by one.
        macro_rules! each {
            ($($stage:literal)*) => { $(f(&place($stage, y, h, k), &mut k[$stage]);)* };
        }
        each!(1 2 3 4 5 6 7 8 9 10 11);
    }
    let mut made = Step { change: [h; N], fifth: [h; N], third: [h; N] };
    for i in 0..N {
        made.change[i] = h * weighted(k, &SOLUTION_WEIGHTS, i);
        made.fifth[i] = h * weighted(k, &FIFTH_ORDER_ERROR, i);
        made.third[i] = h * weighted(k, &THIRD_ORDER_ERROR, i);
    }
    made
}

/// The variables after a change, and their accumulated rounding errors `carry` (Kahan 1965).
#[inline(always)]
pub(crate) fn plus<T: Real, const N: usize>(y: &[T; N], carry: &[T; N], change: &[T; N]) -> ([T; N], [T; N]) {
    let (mut sum, mut left) = ([y[0]; N], [y[0]; N]);
    for i in 0..N {
        let change = change[i] + carry[i];
        sum[i] = y[i] + change;
        let part = sum[i] - y[i];
        left[i] = (y[i] - (sum[i] - part)) + (change - part);
    }
    (sum, left)
}

/// The factor by which the next step may be longer or shorter, from the error in units of the allowed error: 0.9
/// error^(-1/8), within [0.3, 5].
#[inline(always)]
pub(crate) fn growth<T: Real>(error: T) -> T {
    let one = |x: f64| error.splat(x);
    let root = error.max(one(1e-40)).sqrt().sqrt().sqrt();
    // An error that is NaN means that the step is too long.
    let grown = (one(0.9) / root).min(one(5.0)).max(one(0.3));
    error.select_lt(one(f64::MAX), grown, one(0.3))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pendulum(y: &[f64; 2], rate: &mut [f64; 2]) {
        *rate = [y[1], -y[0].sin()];
    }

    fn rate(y: &[f64; 2]) -> [f64; 2] {
        let mut rate = [0.0; 2];
        pendulum(y, &mut rate);
        rate
    }

    /// The state of a pendulum at time 4, after `n` steps.
    fn swung(n: u32) -> [f64; 2] {
        let (mut y, h) = ([1.0, 0.0], 4.0 / f64::from(n));
        for _ in 0..n {
            let change = step::<false, _, _>(pendulum, &y, &rate(&y), h, &mut [y; STAGES]).change;
            y = [y[0] + change[0], y[1] + change[1]];
        }
        y
    }

    #[test]
    fn a_pendulum_has_an_error_of_eighth_order() {
        let exact = swung(400);
        let error = |n: u32| (swung(n)[0] - exact[0]).hypot(swung(n)[1] - exact[1]);
        for n in [8, 10, 12] {
            let order = (error(n) / error(2 * n)).log2();
            assert!((order - 8.0).abs() < 0.6, "{n}: {order}");
        }
    }

    #[test]
    fn the_errors_are_of_fifth_and_third_order() {
        let size = |h: f64| {
            let y = [1.0, 0.3];
            let made = step::<false, _, _>(pendulum, &y, &rate(&y), h, &mut [y; STAGES]);
            [made.fifth, made.third].map(|e| e[0].hypot(e[1]))
        };
        let ([a5, a3], [b5, b3]) = (size(0.4), size(0.2));
        let orders = [(a5 / b5).log2(), (a3 / b3).log2()];
        assert!((orders[0] - 6.0).abs() < 0.7 && (orders[1] - 4.0).abs() < 0.7, "{orders:?}");
    }

    #[test]
    fn what_overflows_in_an_error_is_not_an_error_of_nothing() {
        // The rate grows with the third power of y, so that a step that is much too long overflows.
        let explodes = |y: &[f64; 1], rate: &mut [f64; 1]| *rate = [y[0] * y[0] * y[0]];
        for tenths in -30..600 {
            let (y, h) = ([1.0], 10f64.powf(f64::from(tenths) / 100.0));
            let made = step::<false, _, _>(explodes, &y, &[1.0], h, &mut [y; STAGES]);
            let error = made.error(|_| 1e10, 1.0);
            assert!(error.is_nan() || error > 1.0, "{h}: {error} of {:?}", made.change);
        }
    }

    #[test]
    fn an_error_that_is_no_number_makes_the_step_shorter() {
        assert_eq!([growth(f64::NAN), growth(f64::INFINITY), growth(1e9)], [0.3; 3]);
        assert_eq!(growth(0.0), 5.0);
        assert!((growth(1.0f64) - 0.9).abs() < 1e-15);
    }
}
