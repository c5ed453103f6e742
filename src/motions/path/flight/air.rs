//! Flight against the air: the couple of the air on a body in the air, by steps.
//!
//! ```text
//! y = (quaternion of the body's axes, w along them, heights of both rims, lost, time)
//! q' = q (0, w)/2,   I1 wx' = (I1 - I3) wy wz + mx,   I1 wy' = (I3 - I1) wx wz + my,   I3 wz' = mz
//! ```
//! The centre moves along its parabola: drag on the centre is not modelled. Only the laws that resist all rotation act
//! in the air; the others need a contact or a gap under the face. In these axes the poles are ordinary points. The
//! landing is computed as in [`lands`](super::lands), step by step, with the initial K = (|l| + a) (|L|^2/I1^2 +
//! |m|/I1) - 1, since the air slows the body down. Error: the tolerance of the steps.

use super::lands::{Falling, Leaves, TOUCH, TooMany};
use super::{Aloft, Flies, Flight};
use crate::laws::body::Shape;
use crate::laws::loss::{Couples, Kinematics, Law, Losses};
use crate::methods::rk8;
use core::f64::consts::{FRAC_PI_2, TAU};

const NUMBERS: usize = 11;
const AIR_TIME: usize = 10;
type AirNumbers = [f64; NUMBERS];
/// Largest number of steps.
const AIR_STEPS: usize = 100_000;

/// A step of a flight against the air: the numbers at its start, and phi and psi there.
#[derive(Debug, Clone, Copy)]
struct AirStep {
    y: AirNumbers,
    angles: [f64; 2],
}

/// A flight against the air.
pub(crate) struct AirFlight {
    shape: Shape<f64>,
    from: Aloft,
    /// The flight without the air, which has the parabola of the centre.
    free: Flight,
    losses: Couples<f64>,
    steps: Vec<AirStep>,
    tol: f64,
}

/// The laws that act on a body in the air; None if no law does.
pub(crate) fn in_air(losses: &Losses) -> Option<Couples<f64>> {
    let mut left = *losses;
    for law in Law::ALL.iter().copied().filter(|law| !law.acts_in_air()) {
        left.coefficients[law as usize] = 0.0;
    }
    Couples::some(&left)
}

/// The axes of the body in the laboratory, as the columns of the rotation.
fn axes([w, x, y, z]: [f64; 4]) -> [[f64; 3]; 3] {
    [
        [w * w + x * x - y * y - z * z, 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
        [2.0 * (x * y - w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z + w * x)],
        [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), w * w - x * x - y * y + z * z],
    ]
}

impl AirFlight {
    pub fn new(shape: &Shape<f64>, from: &Aloft, losses: Couples<f64>, tol: f64) -> Self {
        let free = Flight::new(shape, from);
        let from = &free.from;
        // The axes of the body are e1, e2 and e3 at the start, which lean toward x.
        let half = 0.5 * from.angle.0.atan2(from.angle.1);
        let (sin, cos) = if half < FRAC_PI_2 { half.sin_cos() } else { (1.0, 0.0) };
        let other = from.on_other_rim(shape).height;
        let [w1, w2, w3] = from.w;
        let y = [cos, 0.0, -sin, 0.0, w1, w2, w3, from.height, other, 0.0, 0.0];
        let steps = vec![AirStep { y, angles: [0.0; 2] }];
        Self { shape: *shape, from: *from, free, losses, steps, tol }
    }

    /// The couple of the air along the axes of the body.
    fn couple(&self, w: [f64; 3]) -> [f64; 3] {
        self.losses.at(&Kinematics::of(&self.shape.rim, (1.0, 0.0), w[0], w)).free
    }

    fn rates(&self, y: &AirNumbers) -> AirNumbers {
        let (Shape { rim, i1, i3 }, [a, b, c, d]) = (self.shape, [y[0], y[1], y[2], y[3]]);
        let [x, z, w] = [y[4], y[5], y[6]];
        let [m1, m2, m3] = self.couple([x, z, w]);
        let [first, second, axis] = axes([a, b, c, d]);
        // The third component of w x e3.
        let cosine = z * first[2] - x * second[2];
        let (sin, cos) = (axis[0].hypot(axis[1]), axis[2]);
        let sine = if sin > 0.0 { -(cos * cosine / sin) } else { 0.0 };
        let [.., up] = self.free.velocity;
        let rise = |side: f64| up - y[AIR_TIME] - rim.slope((sine, side * cosine));
        [
            -0.5 * (b * x + c * z + d * w),
            0.5 * (a * x + c * w - d * z),
            0.5 * (a * z + d * x - b * w),
            0.5 * (a * w + b * z - c * x),
            ((i1 - i3) * z * w + m1) / i1,
            ((i3 - i1) * x * w + m2) / i1,
            m3 / i3,
            rise(1.0),
            rise(-1.0),
            -(m1 * x + m2 * z + m3 * w),
            1.0,
        ]
    }

    /// The numbers after a part of a step, and the error of this part.
    fn part(&self, step: &AirStep, h: f64) -> (AirNumbers, f64) {
        let rate = self.rates(&step.y);
        let mut stages = [rate; rk8::STAGES];
        let rates = |y: &AirNumbers, to: &mut AirNumbers| *to = self.rates(y);
        let made = rk8::step::<true, _, _>(rates, &step.y, &rate, h, &mut stages);
        let per = |i: usize| 1.0 / (self.tol * if i < 4 { 1.0 } else { step.y[i].abs().max(1.0) });
        (core::array::from_fn(|i| step.y[i] + made.change[i]), made.error(per, NUMBERS as f64))
    }

    /// phi and psi since the start, from the numbers, within half a turn of those before.
    fn angles(&self, y: &AirNumbers, [phi, psi]: [f64; 2]) -> [f64; 2] {
        let [first, _, axis] = axes([y[0], y[1], y[2], y[3]]);
        let turned = (-axis[1]).atan2(-axis[0]);
        let phi = turned + TAU * ((phi - turned) / TAU).round();
        let (sin, cos) = phi.sin_cos();
        // e2 is horizontal, and e1 = e2 x e3.
        let across = first[1] * cos - first[0] * sin;
        let along = first[0] * axis[2] * cos + first[1] * axis[2] * sin + first[2] * axis[0].hypot(axis[1]);
        let spun = across.atan2(along);
        [phi, spun + TAU * ((psi - spun) / TAU).round()]
    }
}

impl Flies for AirFlight {
    fn lands(&mut self, leaves: [Leaves; 2], two: bool, until: f64) -> Result<Option<(f64, bool)>, TooMany> {
        let (rim, i1, [w1, w2, w3]) = (self.shape.rim, self.shape.i1, self.from.w);
        let reach = rim.ell.abs() + rim.a;
        let [m1, m2, m3] = self.couple(self.from.w);
        let turn = self.free.rate * self.free.rate + m1.hypot(m2).hypot(m3) / i1;
        let bend = (reach * turn - 1.0).max(1e-9);
        // The series without the air carries a rim away from the table.
        let mut starts = [0.0; 2];
        for (i, side) in [1.0, -1.0].into_iter().enumerate().take(if two { 2 } else { 1 }) {
            if let Some(order) = leaves[i] {
                let (near, found) = self.free.leaves(side, order, until)?;
                match found {
                    Some(0.0) => return Ok(Some((0.0, i == 1))),
                    Some(t) => starts[i] = 0.5 * t,
                    None => starts[i] = near,
                }
            }
        }
        let mut h = 0.05 / (1.0 + w1.abs().max(w2.abs()).max(w3.abs()));
        for _ in 0..AIR_STEPS {
            let step = *self.steps.last().ok_or(TooMany)?;
            let now = step.y[AIR_TIME];
            h = h.min(until - now);
            let (y, error) = self.part(&step, h);
            if error.is_nan() || error > 1.0 {
                h *= rk8::growth(error).min(0.7);
                continue;
            }
            let mut first: Option<(f64, bool)> = None;
            for (i, start) in starts.into_iter().enumerate().take(if two { 2 } else { 1 }) {
                let (low, high) = (start - now, first.map_or(h, |(t, _)| t));
                if low >= high {
                    continue;
                }
                let of = |x: f64| {
                    let y = self.part(&step, x).0;
                    [y[7 + i], self.rates(&y)[7 + i]]
                };
                let mut falling = Falling { of, bend, touch: TOUCH };
                if let Some(x) = falling.first_zero(low.max(0.0), high)? {
                    first = Some((x, i == 1));
                }
            }
            if let Some((x, other)) = first {
                return Ok(Some((now + x, other)));
            }
            let angles = self.angles(&y, step.angles);
            self.steps.push(AirStep { y, angles });
            if y[AIR_TIME] >= until {
                return Ok(None);
            }
            h *= rk8::growth(error);
        }
        Err(TooMany)
    }

    fn at(&self, t: f64) -> (Aloft, f64) {
        if t == 0.0 {
            return (self.free.given, 0.0);
        }
        let k = self.steps.partition_point(|step| step.y[AIR_TIME] <= t).max(1) - 1;
        let step = &self.steps[k];
        let y = if t > step.y[AIR_TIME] { self.part(step, t - step.y[AIR_TIME]).0 } else { step.y };
        let [phi, psi] = self.angles(&y, step.angles);
        let [.., axis] = axes([y[0], y[1], y[2], y[3]]);
        let (sin, cos) = psi.sin_cos();
        let w = [y[4] * cos - y[5] * sin, y[4] * sin + y[5] * cos, y[6]];
        let at = self.free.placed(t, (axis[0].hypot(axis[1]), axis[2]), w, [phi, psi]);
        (at, y[9])
    }

    fn free(&self) -> &Flight {
        &self.free
    }
}
