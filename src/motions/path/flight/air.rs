//! Flight against the air: the couple of the air on a body in the air, by steps.
//!
//! ```text
//! y = (quaternion of the body's axes, w along them, height of the rim, cos theta, lost, time)
//! q' = q (0, w)/2,   I1 wx' = (I1 - I3) wy wz + mx,   I1 wy' = (I3 - I1) wx wz + my,   I3 wz' = mz
//! z' = z x w         the vertical in the body's axes, for the power series at the start
//! ```
//! The centre moves along its parabola: drag on the centre is not modelled. Only the laws that resist all rotation act
//! in the air; the others need a contact or a gap under the face. In these axes the poles are ordinary points. The
//! height of a rim and cos theta are numbers of their own, since near zero their changes have more digits than they
//! themselves. The landing is computed as in [`lands`](super::lands), step by step, with the initial K = (|l| + a)
//! (|L|^2/I1^2 + |m|/I1) - 1, since w3 and the size of w across the axis only fall. Where a rim touches at the start,
//! the couple of the air belongs to the leading terms of its height, so that the power series there includes it. Error:
//! the tolerance of the steps.

use super::lands::{AngleSeries, Falling, Leaves, NoLanding, RIM_TERMS, TOUCH};
use super::{Aloft, Flies, Flight};
use crate::laws::body::Shape;
use crate::laws::loss::{Couples, Kinematics, Law, Losses};
use crate::methods::flow::Spent;
use crate::methods::rk8;
use crate::numbers::tape::{Tape, Taped};
use crate::numbers::{Real, TERMS};
use core::f64::consts::{FRAC_PI_2, TAU};

const NUMBERS: usize = 11;
const AIR_TIME: usize = 10;
type AirNumbers = [f64; NUMBERS];
/// Length of the first step, in units of the time in which the body turns by one radian.
const FIRST_STEP: f64 = 0.05;
/// Number of evaluations of the rates in a step.
const RATES_PER_STEP: u64 = 12;
/// Largest number of steps.
const AIR_STEPS: usize = 100_000;
/// The series at the start holds for this share of the time that it would without the air, or for less, until its last
/// two terms are below `LAST_SHARE` of its largest one.
const AIR_SHARE: f64 = 0.25;
const LAST_SHARE: f64 = 1e-17;
/// Error of the height within a step, in tolerances.
const STEP_NOISE: f64 = 100.0;
/// Below this size the cosine of theta is the integrated one.
const COSINE_KNOWN: f64 = 0.5;

/// The time of the first landing, and whether it is that of the other rim.
type FirstLanding = Option<(f64, bool)>;

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
    first: f64,
    spent: Spent,
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
    /// The first step is `longer` by this factor.
    pub fn new(shape: &Shape<f64>, from: &Aloft, losses: Couples<f64>, (tol, longer): (f64, f64)) -> Self {
        let free = Flight::new(shape, from);
        let from = &free.from;
        // The axes of the body are e1, e2 and e3 at the start, which lean toward x.
        let half = 0.5 * from.angle.0.atan2(from.angle.1);
        let (sin, cos) = if half < FRAC_PI_2 { half.sin_cos() } else { (1.0, 0.0) };
        let [w1, w2, w3] = from.w;
        let y = [cos, 0.0, -sin, 0.0, w1, w2, w3, from.height, from.angle.1, 0.0, 0.0];
        let steps = vec![AirStep { y, angles: [0.0; 2] }];
        let fastest = w1.abs().max(w2.abs()).max(w3.abs());
        let (first, spent) = (
            longer * FIRST_STEP / (1.0 + fastest),
            Spent { evaluations: 0, erred: 0.0, patience: 0, exhausted: None },
        );
        Self { shape: *shape, from: *from, free, losses, steps, tol, first, spent }
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
        [
            -0.5 * (b * x + c * z + d * w),
            0.5 * (a * x + c * w - d * z),
            0.5 * (a * z + d * x - b * w),
            0.5 * (a * w + b * z - c * x),
            ((i1 - i3) * z * w + m1) / i1,
            ((i3 - i1) * x * w + m2) / i1,
            m3 / i3,
            up - y[AIR_TIME] - rim.slope((sine, cosine)),
            cosine,
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

impl AirFlight {
    /// The coefficients of sine and cosine of theta in powers of the time since the start.
    fn series(&self) -> [[f64; TERMS]; 2] {
        let tape = Tape::default();
        let number = |x: f64| tape.number(x);
        let given: [Taped<'_>; 6] = core::array::from_fn(|_| tape.given());
        let ([x, y, z, w1, w2, w3], zero) = (given, number(0.0));
        let Shape { rim, i1, i3 } = self.shape.map(number);
        let seen = Kinematics::of(&rim, (number(1.0), zero), w1, [w1, w2, w3]);
        let [m1, m2, m3] = self.losses.map(number).at(&seen).free;
        // The height of a ball does not depend on s, which may be zero.
        let sine = if self.shape.rim.a > 0.0 { (x * x + y * y).sqrt() } else { zero };
        let results = [
            y * w3 - z * w2,
            z * w1 - x * w3,
            x * w2 - y * w1,
            ((i1 - i3) * w2 * w3 + m1) / i1,
            ((i3 - i1) * w1 * w3 + m2) / i1,
            m3 / i3,
            sine,
        ];
        let mut player = tape.player(&given, &results, &[]);
        let ((s, c), [w1, w2, w3]) = (self.from.angle, self.from.w);
        [s, 0.0, c, w1, w2, w3].into_iter().enumerate().for_each(|(i, x)| player.set(i, 0, x));
        player.begin();
        for n in 1..TERMS {
            for i in 0..given.len() {
                let rate = player.result(i).at[n - 1];
                player.set(i, n, rate / n as f64);
            }
            player.go_on(n);
        }
        [player.result(given.len()).at, *player.given(2)]
    }

    /// The earliest landing of a rim that touches at the start, up to the time until which a series shows it; and the
    /// times up to which no other landing is possible.
    fn leaves(&self, leaves: [Leaves; 2], two: bool) -> Result<(FirstLanding, [f64; 2]), NoLanding> {
        let (mut first, mut clear) = (None, [0.0; 2]);
        if leaves == [None; 2] {
            return Ok((first, clear));
        }
        let series = self.series();
        let mut near = AIR_SHARE * self.free.near();
        let size = |near: f64, all: core::ops::Range<usize>| {
            let term = |at: &[f64; TERMS], k: usize| at[k].abs() * near.powi(k as i32);
            all.flat_map(|k| series.iter().map(move |at| term(at, k))).fold(0.0, f64::max)
        };
        while size(near, TERMS - 2..TERMS) > LAST_SHARE * size(near, 1..TERMS) {
            near *= 0.5;
        }
        let swung = |near: f64, terms: usize| -> AngleSeries {
            series.map(|at| {
                let known = |k: usize| if k < terms.min(TERMS) { at[k] * near.powi(k as i32) } else { 0.0 };
                core::array::from_fn::<f64, RIM_TERMS, _>(known)
            })
        };
        for (i, side) in [1.0, -1.0].into_iter().enumerate().take(if two { 2 } else { 1 }) {
            let Some(order) = leaves[i] else { continue };
            match self.free.leaves(side, order, near, &swung)? {
                Some(t) => {
                    clear[i] = t;
                    if first.is_none_or(|(before, _)| t < before) {
                        first = Some((t, i == 1));
                    }
                }
                None => clear[i] = near,
            }
        }
        Ok((first, clear))
    }
}

impl Flies for AirFlight {
    fn lands(
        &mut self,
        leaves: [Leaves; 2],
        two: bool,
        until: f64,
    ) -> Result<Option<(f64, bool)>, NoLanding> {
        let (rim, i1, [w1, w2, w3]) = (self.shape.rim, self.shape.i1, self.from.w);
        let reach = rim.ell.abs() + rim.a;
        let [m1, m2, m3] = self.couple(self.from.w);
        let turn = self.free.rate * self.free.rate + m1.hypot(m2).hypot(m3) / i1;
        let bend = (reach * turn - 1.0).max(1e-9);
        let (soon, clear) = self.leaves(leaves, two)?;
        let soon = soon.filter(|(t, _)| *t <= until);
        let until = soon.map_or(until, |(t, _)| t);
        let (mut h, fastest) = (self.first, w1.abs().max(w2.abs()).max(w3.abs()).max(1.0));
        for _ in 0..AIR_STEPS {
            let step = *self.steps.last().ok_or(NoLanding)?;
            let now = step.y[AIR_TIME];
            if now >= until {
                return Ok(soon);
            }
            h = h.min(until - now);
            let (y, error) = self.part(&step, h);
            self.spent.evaluations += RATES_PER_STEP;
            if error.is_nan() || error > 1.0 {
                h *= rk8::growth(error).min(0.7);
                continue;
            }
            let mut first: Option<(f64, bool)> = None;
            for (i, clear) in clear.into_iter().enumerate().take(if two { 2 } else { 1 }) {
                let (low, high) = ((clear - now).max(0.0), first.map_or(h, |(t, _)| t));
                if low >= high {
                    continue;
                }
                let of = |x: f64| {
                    let y = self.part(&step, x).0;
                    let (rate, apart) = (self.rates(&y), if i == 1 { 2.0 * rim.ell } else { 0.0 });
                    [y[7] + apart * y[8], rate[7] + apart * rate[8]]
                };
                let noise = STEP_NOISE * self.tol;
                let mut falling = Falling { of, bend, touch: TOUCH, noise };
                if let Some(x) = falling.first_zero(low, high)?
                    && first.is_none_or(|(before, _)| x < before)
                {
                    first = Some((x, i == 1));
                }
            }
            self.spent.erred += error * fastest;
            if let Some((x, other)) = first {
                return Ok(Some((now + x, other)));
            }
            let angles = self.angles(&y, step.angles);
            self.steps.push(AirStep { y, angles });
            h *= rk8::growth(error);
        }
        Err(NoLanding)
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
        let cosine = y[8];
        let angle = if cosine.abs() < COSINE_KNOWN {
            (((1.0 - cosine) * (1.0 + cosine)).sqrt(), cosine)
        } else {
            (axis[0].hypot(axis[1]), axis[2])
        };
        (Aloft { height: y[7], ..self.free.placed(t, angle, w, [phi, psi]) }, y[9])
    }

    fn free(&self) -> &Flight {
        &self.free
    }

    fn spent(&self) -> Option<Spent> {
        Some(self.spent)
    }
}
