//! Power series in y of quantities that stay positive while the body presses on the table and friction prevents slip.
//!
//! ```text
//! C = c0 (1 + y^2) - 2 y,   S = s0 (1 - y^2),   c = C/Q,   s = S/Q,   G = Q g,   G2 = Q g',   F' = dF/dy
//! N = 1 - g theta'' - g' theta'^2,   theta'^2 = F/J,   theta'' = (Q F'/(2 s0) - F J_theta/J)/(2 J)
//! sharp:    X = Q N           = Q - (Q G F'/(4 s0) + G2 F)/J
//! rounded:  X = J^2 Q^2 N     = K^2 - K G Q F'/(4 s0) - (rho G^2 + K G2) F        K = Q J
//! smooth:   X = J^2 Q^4 N     = K^2 - K G Q^2 F'/(4 s0) - I1 Q^3 G2 F             K = Q^2 J = I1 Q^2 + G^2
//! sharp:    Z = (mu^2 N^2 - F2^2 - Fh^2) (Q (1 - y^2))^2
//!           F2^2 = I3^2 (r w1 + t w3)^2 F/J,   Fh = g theta'^2 - h theta'' - (w1/s) (w3 - ell w1)
//! ```
//! The normal force N follows from the second derivative of the centre's height, along a motion whose theta'^2 is a
//! known function of the inclination; the two components of friction follow in the same way. Each is a sum of
//! polynomials times F or F', so that a term takes a few products. The module [`contact`](crate::laws::contact) has
//! the forces of a state; the tests at the end compare them.

use crate::laws::contact::Contact;
use crate::laws::contact::reduced::Reduced;
use crate::numbers::Real;
use crate::numbers::power::{multiply_on, square_on, term, times};

/// Adds the term `k` of the product of a polynomial with the derivative of a series to `sum`.
#[inline(always)]
fn slope_term<T: Real, const A: usize>(of: &[T; A], series: &[T], k: usize, sum: T) -> T {
    let mut sum = sum;
    for i in 0..A.min(k + 1) {
        if k - i + 1 < series.len() {
            let slope = series[k - i + 1] * sum.splat((k - i + 1) as f64);
            sum = of[i].fma(slope, sum);
        }
    }
    sum
}

#[inline(always)]
fn scaled<T: Real, const A: usize>(mut of: [T; A], by: T) -> [T; A] {
    for term in &mut of {
        *term = *term * by;
    }
    of
}

#[inline(always)]
fn plus<T: Real, const A: usize>(mut of: [T; A], other: &[T; A]) -> [T; A] {
    for (term, other) in of.iter_mut().zip(other) {
        *term = *term + *other;
    }
    of
}

/// The polynomials Q, G = Q g and G2 = Q g' in y about a place.
struct Levers<T> {
    q: [T; 3],
    lever: [T; 3],
    slope: [T; 3],
}

impl<T: Real> Levers<T> {
    #[inline(always)]
    fn of(law: &Reduced<T>, (s, c): (T, T)) -> Self {
        let rim = &law.shape.rim;
        let (one, back) = (s.splat(1.0), (-s, c));
        Self {
            q: [one, -(c + c), one],
            lever: [rim.lever((s, c)), rim.a + rim.a, rim.lever(back)],
            slope: [rim.slope((s, c)), -(rim.ell + rim.ell), rim.slope(back)],
        }
    }
}

/// The power series X in y, which is positive while the body presses on the table.
#[inline(always)]
pub(super) fn normal<T: Real, const N: usize>(
    law: &Reduced<T>,
    (s, c): (T, T),
    force: &[T; N],
    press: &mut [T; N],
) {
    let Levers { q, lever, slope } = Levers::of(law, (s, c));
    let quarter = -(s.splat(0.25) / s);
    match law.contact {
        Contact::Rolling if !law.round => {
            let weight = -(s.splat(1.0) / law.inertia(|| (s, c)));
            let with_slope: [T; 5] = scaled(times(&q, &lever), quarter * -weight);
            press_series(press, force, &q, &with_slope, &scaled(slope, weight));
        }
        Contact::Rolling => {
            let rim = &law.shape.rim;
            let two_rho = rim.rho + rim.rho;
            let fixed = law.shape.i1 + rim.a * rim.a + rim.ell * rim.ell + rim.rho * rim.rho;
            let inertia = plus(scaled(q, fixed), &scaled(slope, two_rho));
            let (plain, levered): ([T; 5], [T; 5]) = (times(&inertia, &inertia), times(&inertia, &lever));
            let with_slope: [T; 7] = scaled(times(&levered, &q), quarter);
            let (bent, falls): ([T; 5], [T; 5]) = (times(&lever, &lever), times(&inertia, &slope));
            let with_force = plus(scaled(bent, -rim.rho), &scaled(falls, s.splat(-1.0)));
            press_series(press, force, &plain, &with_slope, &with_force);
        }
        Contact::Smooth => {
            let (square, wide): ([T; 5], [T; 5]) = (times(&q, &q), times(&lever, &lever));
            let inertia = plus(scaled(square, law.shape.i1), &wide);
            let (plain, levered): ([T; 9], [T; 7]) = (times(&inertia, &inertia), times(&inertia, &lever));
            let with_slope: [T; 11] = scaled(times(&levered, &square), quarter);
            let cube: [T; 7] = times(&square, &q);
            let with_force: [T; 9] = scaled(times(&cube, &slope), -law.shape.i1);
            press_series(press, force, &plain, &with_slope, &with_force);
        }
    }
}

/// Computes the series X, positive while the body presses, from its three polynomials: the term without F, the factor
/// of F' and the factor of F.
#[inline(always)]
fn press_series<T: Real, const A: usize, const B: usize, const C: usize>(
    press: &mut [T],
    force: &[T],
    plain: &[T; A],
    with_slope: &[T; B],
    with_force: &[T; C],
) {
    for (k, press) in press.iter_mut().enumerate() {
        let sum = if k < A { plain[k] } else { force[0].splat(0.0) };
        *press = term(with_force, force, k, slope_term(with_slope, force, k, sum));
    }
}

/// Error of the series X at a place where F and its slope have the error `noise`.
#[inline(always)]
pub(super) fn error_of_press<T: Real>(law: &Reduced<T>, (s, c): (T, T), noise: T) -> T {
    let rim = &law.shape.rim;
    let inertia = law.inertia(|| (s, c));
    let scale = if law.contact == Contact::Rolling && !law.round { s.splat(1.0) } else { inertia * inertia };
    let quarter = s.splat(0.25) / s;
    scale * noise / inertia * (rim.lever((s, c)).abs() * quarter + rim.slope((s, c)).abs())
}

/// The series Z of a sharp rim that rolls (see the head of this module), which is positive while friction prevents slip.
#[inline(always)]
pub(super) fn grip<T: Real, const N: usize>(
    law: &Reduced<T>,
    (s, c): (T, T),
    [w1, w3, force, press]: [&[T; N]; 4],
    mu_square: T,
    grip: &mut [T; N],
) {
    let Levers { q, lever, slope } = Levers::of(law, (s, c));
    let (zero, one) = (s.splat(0.0), s.splat(1.0));
    let of = law.at((s, c));
    let inertia = law.inertia(|| (s, c));
    // `bow` is 1 - y^2; the others are the factors of F, F' and of the product of velocities in Fh.
    let bow = [one, zero, -one];
    let with_force: [T; 5] = scaled(times(&bow, &lever), one / inertia);
    let wide: [T; 5] = times(&bow, &q);
    let with_slope: [T; 7] = scaled(times(&wide, &slope), -(s.splat(0.25) / (s * inertia)));
    let (mut across, mut spin, mut slip) = ([zero; N], [zero; N], [zero; N]);
    let square: [T; 5] = times(&q, &q);
    let turned = scaled(square, -(one / s));
    let depth = law.shape.rim.ell;
    for k in 0..N {
        slip[k] = (zero - depth).fma(w1[k], w3[k]);
        spin[k] = of.r.fma(w1[k], of.t * w3[k]);
    }
    let mut turn = [zero; N];
    for (k, across) in across.iter_mut().enumerate() {
        multiply_on(&mut turn, w1, &slip, k);
        let with_turn = term(&turned, &turn, k, zero);
        *across = term(&with_force, force, k, slope_term(&with_slope, force, k, with_turn));
    }
    let (mut spin_square, mut drift) = ([zero; N], [zero; N]);
    for k in 0..N {
        square_on(&mut spin_square, &spin, k);
        multiply_on(&mut drift, &spin_square, force, k);
    }
    let weigh = scaled(square, -(law.shape.i3 * law.shape.i3 / inertia));
    let (mut press_square, mut across_square, mut held) = ([zero; N], [zero; N], [zero; N]);
    let twice: [T; 5] = times(&bow, &bow);
    for k in 0..N {
        square_on(&mut press_square, press, k);
        square_on(&mut across_square, &across, k);
        held[k] = mu_square.fma(press_square[k], term(&weigh, &drift, k, zero));
        grip[k] = term(&twice, &held, k, -across_square[k]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::body::Shape;
    use crate::laws::contact::force_of;
    use crate::laws::contact::reduced::Rates;
    use crate::motions::exact::lanes::series::{angle_at, lane_lines, square_of_rate};
    use crate::numbers::power::horner;

    #[test]
    fn the_series_are_the_forces_of_the_states_on_the_way() {
        const N: usize = 40;
        for i in 0..300 {
            let u = |k: f64| (f64::from(i) * k).fract();
            let (contact, fillet) = match i % 3 {
                0 => (Contact::Rolling, 0.0),
                1 => (Contact::Rolling, 0.05 + 0.9 * u(0.618)),
                _ => (Contact::Smooth, 0.4 * u(0.618)),
            };
            let (i1, i3) = (0.3 + u(0.577), 0.1 + 0.5 * u(0.754));
            let shape = Shape::of([2.0 * u(0.707), i1, i3, fillet]);
            let rates = Rates::of(contact, &shape, fillet != 0.0);
            let law = rates.reduced();
            let (s, c) = (0.2 + 1.2 * u(0.414)).sin_cos();
            let [w1, w2, w3] = [2.0 * u(0.236) - 1.0, u(0.303), 3.0 * u(0.162) - 1.5];
            let (mut v, mut n) = ([w1; N], [w3; N]);
            let mut force = [law.inertia(|| (s, c)) * w2 * w2; N];
            lane_lines::<_, N>(law, s, c, &mut v, &mut n);
            square_of_rate::<_, N>(law, s, c, &v, &n, &mut force);
            let (mut press, mut held) = ([0.0; N], [0.0; N]);
            normal(law, (s, c), &force, &mut press);
            let mu = 0.1 + u(0.859);
            if i % 3 == 0 {
                grip(law, (s, c), [&v, &n, &force, &press], mu * mu, &mut held);
            }
            for y in [-0.2, -0.05, 0.0, 0.1, 0.25] {
                let q = 1.0 - 2.0 * c * y + y * y;
                let place = angle_at(s, c, y, q);
                let inertia = law.inertia(|| place);
                let square = horner(&force, y) / inertia;
                if square < 0.0 {
                    continue;
                }
                let w = [horner(&v, y), square.sqrt(), horner(&n, y)];
                let [up, along, across] = force_of(law, place, w, rates.at(place.0, place.1, w));
                let scale = match (contact, law.round) {
                    (Contact::Rolling, false) => q,
                    (Contact::Rolling, true) => (q * inertia).powi(2),
                    (Contact::Smooth, _) => (q * q * inertia).powi(2),
                };
                let size = (1.0 + w.iter().map(|w| w * w).sum::<f64>()) / place.0 * scale;
                let off = (horner(&press, y) - scale * up).abs();
                assert!(off < 1e-12 * size, "{contact:?} {fillet} at {y}: {off}");
                if i % 3 == 0 {
                    let bow = (q * (1.0 - y * y)).powi(2);
                    let left = bow * ((mu * up).powi(2) - along * along - across * across);
                    let off = (horner(&held, y) - left).abs();
                    assert!(off < 1e-12 * size * size, "grip at {y}: {off}");
                }
            }
        }
    }
}
