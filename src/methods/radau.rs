//! Radau's method IIA of ninth order, for stiff systems, in which some variables relax thousands of times faster than
//! the solution changes.
//!
//! ```text
//! Z_i = h sum a_ij f(y + Z_j),   y(t + h) = y + Z_5                          five stages, at the nodes c_i
//! (1 - (h/g_k) J) dW_k = (T^-1 (h A f - Z))_k,   dZ = T dW                   Newton's iteration, A^-1 = T diag(g) T^-1
//! error = 1.5e-4 x^4 |(d5, x d4)|,   x^2 = 0.8 |d5|/|d3|                        d_n: divided differences of y of order n
//! ```
//! The method is stable for any h (Hairer and Wanner, Solving Ordinary Differential Equations II (1996), IV.5 and
//! The method is stable for any h (Hairer and Wanner, Solving Ordinary Differential Equations II (1996), IV.5 and
//! IV.8). Only the first M of the N variables affect each other; the others are integrals. J, the matrix of the
//! derivatives of the rates, is that of a point within the step. For an oscillation d5 and d3 vanish together but d4
//! does not, so that the error does not depend on its phase.
//!
//! Error: that of a pendulum goes as h^9; the tests at the end measure this exponent, run a stiff equation, and check
//! the estimate of the error.

use super::rk8::Step;
use crate::numbers::larger_or_nan;
use nalgebra::{Complex, Const, DimMin, SMatrix, SVector, ToTypenum};

/// The cost of a step that converges fast, in evaluations of the rates; and the cost of J and its factors.
pub(crate) const COST: u64 = 36;
const JACOBIAN_COST: u64 = 20;
/// The number of stages of a step of Radau's method.
pub(crate) const RADAU_STAGES: usize = 5;
#[rustfmt::skip]
pub(crate) const PLACES: [f64; RADAU_STAGES] = [0.05710419611451768, 0.2768430136381238, 0.5835904323689168, 0.8602401356562195, 1.0];
#[rustfmt::skip]
const A: [[f64; RADAU_STAGES]; RADAU_STAGES] = [
    [0.07299886431790333, -0.026735331107945574, 0.018676929763984353, -0.01287910609330644, 0.005042839233882015],
    [0.15377523147918248, 0.14621486784749352, -0.03644456890512809, 0.02123306311930472, -0.007935579902728777],
    [0.14006304568480987, 0.29896712949128346, 0.16758507013524895, -0.03396910168661775, 0.010944288744192251],
    [0.14489430810953477, 0.27650006876015926, 0.32579792291042103, 0.12875675325490976, -0.015708917378805327],
    [0.14371356079122594, 0.28135601514946207, 0.31182652297574126, 0.22310390108357073, 0.04],
];
/// The eigenvalues of 1/A, one real and two complex pairs, and their right and left eigenvectors, real and imaginary
/// parts. They determine how fast Newton's iteration converges, but not its limit.
#[rustfmt::skip]
const REAL_EIGENVALUE: (f64, [f64; RADAU_STAGES], [f64; RADAU_STAGES]) = (
    6.2867047517292765,
    [0.013576867344947943, 0.0016179004017190875, 0.07915785334744721, 0.41225608268046143, 1.0],
    [27.697693775684087, 12.783337911304406, 3.20848938671343, -0.9514904122489162, 0.7415504960259895],
);
type ComplexEigenvalue = ([f64; 2], [[f64; 2]; RADAU_STAGES], [[f64; 2]; RADAU_STAGES]);
#[rustfmt::skip]
const COMPLEX_EIGENVALUES: [ComplexEigenvalue; 2] = [
    (
        [5.70095329867179, 3.2102656003085497],
        [
            [-0.011478515255229515, 0.01401985889287541], [-0.007668830749180163, -0.024708578426518527],
            [0.01939846399882895, -0.08180035370375117], [0.40760117128019907, -0.19968242788680254], [1.0, 0.0],
        ],
        [
            [-16.5209401067595, -4.305721989937646], [-8.688476739531783, 4.849995704764404],
            [-0.08606453162700278, 0.9573643198484372], [-0.04958488899127132, 1.20934600304247],
            [0.2656140579191533, -0.5237317439676688],
        ],
    ),
    (
        [3.655694325463572, 6.543736899360077],
        [
            [-0.010242047817908826, -0.04767387729029572], [0.05017286451737106, 0.09433181918161143],
            [-0.23053953404341795, -0.1027030453801259], [0.37789390224886127, -0.46674413033249434], [1.0, 0.0],
        ],
        [
            [2.672093218917456, 1.8740299037199024], [2.2968077838795806, -1.9924828681719422],
            [-1.5181801617297122, -0.5222078208040094], [0.5253300951157295, 0.5920492840689743],
            [-0.13638930593214815, -0.22495888507839018],
        ],
    ),
];
/// Weights of the divided differences of y: of fifth order from the start and the nodes, of fourth from the nodes, of
/// third from the last four nodes.
#[rustfmt::skip]
const DIVIDED_DIFFERENCE_5: [f64; RADAU_STAGES] = [199.88739542347736, -127.022853068795, 92.10283313613321, -64.16737549081559, 25.2];
#[rustfmt::skip]
const DIVIDED_DIFFERENCE_4: [f64; RADAU_STAGES] = [11.414409029082394, -35.16538944447781, 53.750332212318185, -55.19935179692277, 25.2];
#[rustfmt::skip]
const DIVIDED_DIFFERENCE_3: [f64; RADAU_STAGES] = [0.0, -7.727201094286656, 28.298810103886993, -44.332583267514494, 23.760974257914153];
/// Largest number of Newton's iterations in a step.
const ITERATIONS: usize = 14;
/// The number of iterations after which their convergence is tested.
const TRIAL_ITERATIONS: usize = 4;
/// The factor in the estimate of the error of a step. For an oscillation the estimate is within a factor of ten of the
/// error if the step is 0.2 rad or more, however long.
const ERROR_FACTOR: f64 = 1.5e-4;
/// Largest x^2 in the estimate of the error; it is 0.04 for a step of one radian of an oscillation, and below this
/// limit even for 24 rad.
const LARGEST_SQUARE: f64 = 10.0;
/// Largest relative change of the variables by an iteration that still counts as converged, if rounding keeps it from
/// converging further.
const STALLED_CHANGE: f64 = 1e-6;

/// The changes Z of y at the stages with which Newton's iteration begins; None for zero changes.
pub(crate) type Guess<const N: usize> = Option<[[f64; N]; RADAU_STAGES]>;
/// Largest ratio of the length of a step to that of the last step for which the iteration begins with the polynomial of
/// the last step.
const EXTRAPOLATED_STEP_RATIO: f64 = 2.0;

/// The changes Z in a step of length `h` by the polynomial of the last step, which is given by its changes and its length.
#[inline(never)]
pub(crate) fn goes_on<const N: usize>(last: &Option<([[f64; N]; RADAU_STAGES], f64)>, h: f64) -> Guess<N> {
    let (moved, before) = last.as_ref().filter(|(_, before)| h <= EXTRAPOLATED_STEP_RATIO * before)?;
    let end = moved[RADAU_STAGES - 1];
    Some(extrapolation(h / before).map(|weights| {
        core::array::from_fn(|n| (0..RADAU_STAGES).map(|j| weights[j] * moved[j][n]).sum::<f64>() - end[n])
    }))
}

/// Weights that extrapolate the polynomial through the nodes of the last step to the stages of the next step, which is
/// `longer` times as long. The start has no weight, since its change is zero.
fn extrapolation(longer: f64) -> [[f64; RADAU_STAGES]; RADAU_STAGES] {
    PLACES.map(|place| {
        let x = 1.0 + place * longer;
        core::array::from_fn(|j| {
            let others = (0..RADAU_STAGES).filter(|i| *i != j);
            others.fold(x / PLACES[j], |product, i| product * (x - PLACES[i]) / (PLACES[j] - PLACES[i]))
        })
    })
}

/// The variables in the middle of a step, as far as the guess knows them; the derivatives J at this place serve for the
/// whole step.
pub(crate) fn middle<const N: usize>(y: &[f64; N], guess: &Guess<N>) -> [f64; N] {
    guess.map_or(*y, |moved| core::array::from_fn(|n| y[n] + moved[2][n]))
}

/// The stages of a step: the changes Z of y, and the rates at the stages.
pub(crate) struct Collocated<const N: usize> {
    pub moved: [[f64; N]; RADAU_STAGES],
    pub rates: [[f64; N]; RADAU_STAGES],
    /// The cost of the step in evaluations of the rates.
    pub evaluations: u64,
}

/// One step of length `h` from `y`. `slopes[i][j]` is the derivative of the rate of variable i with respect to variable
/// j, and `sizes` are the sizes of the first M variables, to which errors are relative. Newton's iteration begins with
/// `guess`, and ends when no variable changes by more than the share `converged` of its size; the error is NaN if this
/// does not happen.
pub(crate) fn step<const M: usize, const N: usize>(
    mut f: impl FnMut(&[f64; N], &mut [f64; N]),
    y: &[f64; N],
    slopes: &SMatrix<f64, M, M>,
    sizes: &[f64; M],
    (h, converged): (f64, f64),
    guess: Guess<N>,
) -> (Step<f64, N>, Collocated<N>)
where
    Const<M>: ToTypenum + DimMin<Const<M>, Output = Const<M>>,
{
    // A law may have no derivative at rest, as a power of a speed has none at zero.
    let slopes = slopes.map(|x| if x.is_finite() { x } else { 0.0 });
    let one = SMatrix::<f64, M, M>::identity();
    let complex = |[re, im]: [f64; 2]| Complex::new(re, im);
    let single = (one - slopes.map(|x| x * (h / REAL_EIGENVALUE.0))).lu();
    let pairs = COMPLEX_EIGENVALUES.map(|(g, ..)| {
        let per = Complex::new(h, 0.0) / complex(g);
        (one.map(Complex::from) - slopes.map(|x| per * x)).lu()
    });
    let moved = guess.unwrap_or([[0.0; N]; RADAU_STAGES]);
    let mut all = Collocated { moved, rates: [*y; RADAU_STAGES], evaluations: JACOBIAN_COST };
    let (mut last, mut unknown, mut moves, mut more) =
        (None::<f64>, f64::INFINITY, [[0.0; N]; RADAU_STAGES], 0.0);
    for done in 1..=ITERATIONS {
        for i in 0..RADAU_STAGES {
            f(&core::array::from_fn(|n| y[n] + all.moved[i][n]), &mut all.rates[i]);
        }
        all.evaluations += RADAU_STAGES as u64;
        // The residual of the equation of each stage.
        let left: [[f64; N]; RADAU_STAGES] = core::array::from_fn(|i| {
            core::array::from_fn(|n| {
                h * (0..RADAU_STAGES).map(|j| A[i][j] * all.rates[j][n]).sum::<f64>() - all.moved[i][n]
            })
        });
        moves = left;
        let solved = single.solve(&SVector::<f64, M>::from_fn(|n, _| {
            (0..RADAU_STAGES).map(|i| REAL_EIGENVALUE.2[i] * left[i][n]).sum()
        }));
        let twice = [0, 1].map(|k| {
            let of = |n: usize| {
                (0..RADAU_STAGES)
                    .map(|i| complex(COMPLEX_EIGENVALUES[k].2[i]) * left[i][n])
                    .sum::<Complex<f64>>()
            };
            pairs[k].solve(&SVector::<Complex<f64>, M>::from_fn(|n, _| of(n)))
        });
        let (Some(single), [Some(first), Some(second)]) = (solved, twice) else { break };
        let mut most = 0.0f64;
        for (i, moves) in moves.iter_mut().enumerate() {
            for n in 0..M {
                let pairs = complex(COMPLEX_EIGENVALUES[0].1[i]) * first[n]
                    + complex(COMPLEX_EIGENVALUES[1].1[i]) * second[n];
                moves[n] = REAL_EIGENVALUE.1[i] * single[n] + 2.0 * pairs.re;
            }
            for (n, (moved, by)) in all.moved[i].iter_mut().zip(moves).enumerate() {
                *moved += *by;
                // A rate may depend on an integral that is not among the first M variables.
                let size = sizes.get(n).copied().unwrap_or(1.0 + moved.abs());
                most = larger_or_nan(most, by.abs() / size);
            }
        }
        // The first iteration does not show the rate of convergence.
        let Some(before) = last.replace(most) else { continue };
        let share = most / before;
        // The sum of all further changes, if each is this share of the previous one.
        more = if share < 0.9 { share / (1.0 - share) } else { 10.0 };
        unknown = most * more;
        let stalls = share > 0.9 && unknown < STALLED_CHANGE;
        let fails = share > 2.0
            || done > TRIAL_ITERATIONS && unknown * share.powi((ITERATIONS - done) as i32) > STALLED_CHANGE;
        if unknown < converged || stalls || fails || !most.is_finite() {
            break;
        }
    }
    let difference = |weights: &[f64; RADAU_STAGES], n: usize| {
        (0..RADAU_STAGES).map(|i| weights[i] * all.moved[i][n]).sum::<f64>()
    };
    let size = |weights: &[f64; RADAU_STAGES]| {
        (0..M).map(|n| difference(weights, n) / sizes[n]).fold(f64::MIN_POSITIVE, f64::hypot)
    };
    let square = (0.8 * size(&DIVIDED_DIFFERENCE_5) / size(&DIVIDED_DIFFERENCE_3)).min(LARGEST_SQUARE);
    let share = if unknown < STALLED_CHANGE { ERROR_FACTOR * square * square } else { f64::NAN };
    let fifth = core::array::from_fn(|n| {
        let unknown = moves.iter().fold(0.0, |most: f64, moves| most.max(moves[n].abs())) * more;
        let spread = difference(&DIVIDED_DIFFERENCE_5, n)
            .hypot(square.min(1.0).sqrt() * difference(&DIVIDED_DIFFERENCE_4, n));
        share * spread + unknown
    });
    // The variables of an iteration that has not converged are not those of the step.
    let change = if share.is_nan() { [f64::NAN; N] } else { all.moved[RADAU_STAGES - 1] };
    (Step { change, fifth, third: [0.0; N] }, all)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The angle of a pendulum and of its speed at time 4, after `n` steps.
    fn swung(n: u32) -> [f64; 2] {
        let (mut y, h) = ([1.0, 0.0], 4.0 / f64::from(n));
        for _ in 0..n {
            let slopes = SMatrix::<f64, 2, 2>::new(0.0, 1.0, -f64::cos(y[0]), 0.0);
            let pendulum = |y: &[f64; 2], rate: &mut [f64; 2]| *rate = [y[1], -y[0].sin()];
            let change = step(pendulum, &y, &slopes, &[1.0; 2], (h, 1e-16), None).0.change;
            y = [y[0] + change[0], y[1] + change[1]];
        }
        y
    }

    #[test]
    fn a_pendulum_has_an_error_of_ninth_order() {
        let exact = swung(64);
        let error = |n: u32| (swung(n)[0] - exact[0]).hypot(swung(n)[1] - exact[1]);
        for n in [3, 4, 5] {
            let order = (error(n) / error(2 * n)).log2();
            assert!((order - 9.0).abs() < 1.3, "{n}: {order}");
        }
    }

    #[test]
    fn a_number_that_follows_another_a_million_times_faster_does_not_shorten_the_steps() {
        // x turns at the rate 1, and y is drawn to x at the rate 1e6.
        let rate = 1e6;
        let f = |y: &[f64; 3], all: &mut [f64; 3]| *all = [-y[1], y[0], -rate * (y[2] - y[0])];
        #[rustfmt::skip]
        let slopes = SMatrix::<f64, 3, 3>::new(0.0, -1.0, 0.0,  1.0, 0.0, 0.0,  rate, 0.0, -rate);
        // y = (cos t + sin t/rate)/(1 + 1/rate^2) stays on its slow solution.
        let slow = |t: f64| (t.cos() + t.sin() / rate) / (1.0 + 1.0 / (rate * rate));
        let (mut y, h) = ([1.0, 0.0, slow(0.0)], 0.25);
        for n in 1..=40 {
            let change = step(f, &y, &slopes, &[1.0; 3], (h, 1e-16), None).0.change;
            y = core::array::from_fn(|i| y[i] + change[i]);
            let t = h * f64::from(n);
            assert!((y[0] - t.cos()).abs() < 2e-13 && (y[2] - slow(t)).abs() < 1e-12, "{t}: {y:?}");
        }
    }

    #[test]
    fn the_polynomial_of_a_step_goes_on_to_the_next_one() {
        // Polynomials of fifth degree without a constant are continued exactly.
        for power in 1..=5 {
            for longer in [0.3, 1.0, 1.9] {
                let at = |x: f64| x.powi(power);
                let found = goes_on(&Some((PLACES.map(|place| [at(place)]), 0.5)), 0.5 * longer).unwrap();
                for (place, [found]) in PLACES.into_iter().zip(found) {
                    let exact = at(1.0 + longer * place) - 1.0;
                    assert!((found - exact).abs() < 1e-12 * exact, "{power} {longer}: {found} {exact}");
                }
            }
        }
        assert!(goes_on(&Some(([[0.0]; RADAU_STAGES], 0.5)), 2.0).is_none());
    }

    #[test]
    fn the_error_of_a_step_is_known_within_a_factor() {
        let f = |y: &[f64; 2], all: &mut [f64; 2]| *all = [-y[1], y[0]];
        let slopes = SMatrix::<f64, 2, 2>::new(0.0, -1.0, 1.0, 0.0);
        for h in [0.3, 0.5, 0.8, 1.2, 2.0, 4.0, 8.0, 24.0] {
            for turn in 0..8 {
                let (s, c) = (0.7 * f64::from(turn)).sin_cos();
                let (made, _) = step(f, &[c, s], &slopes, &[1.0; 2], (h, 1e-16), None);
                let (far, near) = (h + 0.7 * f64::from(turn)).sin_cos();
                let off = (made.change[0] - (near - c)).hypot(made.change[1] - (far - s));
                let said = made.fifth[0].hypot(made.fifth[1]);
                assert!(
                    off < 8.0 * said + 1e-15 && said < 8.0 * off + 1e-13,
                    "{h}, {turn}: {off:e} {said:e}"
                );
            }
        }
    }
}
