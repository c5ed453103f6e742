//! Flight against the air: integrates the rotation of a body in the air under the couple of the air.
//!
//! ```text
//! y = (change of the quaternion q of the body's axes, w along them, lost, time)
//! q' = q (0, w)/2,   I1 wx' = (I1 - I3) wy wz + mx,   I1 wy' = (I3 - I1) wx wz + my,   I3 wz' = mz
//! z' = z x w         the vertical in the body's axes, for the power series at the start
//! (x, y)'' = F       of a drive alone: the centre beside its parabola, four numbers more
//! ```
//! The centre moves along its parabola: drag on the centre is not modelled. Only the laws that resist all rotation
//! act in the air; the others need a contact or a gap under the face. In the body's axes the poles (a vertical axis)
//! are ordinary points, and no component changes fast near them: the step errors would not show that of an integral
//! of sin theta, which has a sharp bend at a pole. The height of a rim and cos theta follow from the changes of q
//! since the start, of which small ones have all their digits. The integration ends at a zero of the height of a rim,
//! also if the height is negative only for a moment. The height of a rim that touches at the start begins as a power
//! series, which includes the couple of the air; up to the time until which this series is used, the height is not
//! watched for a zero. Error: the tolerance of the steps.

use super::lands::{AngleSeries, RIM_TERMS};
use super::{Aloft, FirstLanding, Flies, Flight};
use crate::laws::body::{Body, MOST_CIRCLES, Rim, Shape};
use crate::laws::loss::{Couples, Kinematics};
use crate::laws::state::State;
use crate::methods::flow::{Exhausted, Flow, FlowPlace, Spent, Steps, TakenStep};
use crate::methods::rk8;
use crate::motions::body::own::Own;
use crate::motions::walk::hops::Leaves;
use crate::motions::walk::numbers::{COS, PHI, SIN, TIME};
use crate::numbers::tape::{Tape, Taped};
use crate::numbers::{Dual, Real, TERMS};
use core::cell::RefCell;
use core::f64::consts::{FRAC_PI_2, TAU};

/// Number of components of the state vector of a flight. `DRIVEN_NUMBERS` is that of a body whose centre a force
/// drives off its parabola.
const NUMBERS: usize = 9;
pub(crate) const DRIVEN_NUMBERS: usize = NUMBERS + 4;
const AIR_LOST: usize = 7;
const AIR_TIME: usize = 8;
/// Index of the velocity of the centre relative to its parabola in the state vector, after its relative place.
const AIR_VELOCITY: usize = NUMBERS + 2;
/// Length of the first integration step, in units of the time in which the body turns by one radian.
const FIRST_STEP: f64 = 0.05;
/// Angle, in radians, by which the faster of rotation and nutation turns in the longest step.
const LONGEST_STEP: f64 = 3.0;
/// The power series at the start of a flight is used for at most this share of the time that it would be without the
/// air, and only while its last two terms are below `LAST_SHARE` of its largest term.
const AIR_SHARE: f64 = 0.25;
const LAST_SHARE: f64 = 1e-17;
/// A part of a step in which phi turns by less than this angle, in radians, is not divided to count the turns of phi;
/// nor is one shorter than `SHORT_PART` first steps.
const FAR_TURN: f64 = 1.0;
const SHORT_PART: f64 = 1e-9;
/// Number of terms of the polynomial through the values of a user-defined couple.
const FITTED: usize = 7;
/// Number of components of a body's state vector with its pose.
const BODY_NUMBERS: usize = PHI + 4;
/// Number of components of the vertical and of w together.
const MOVING: usize = 6;
/// The sine of theta is computed from the cosine if abs(cos(theta)) is below this.
const LEVEL_COSINE: f64 = 0.5;

/// The start of an integration step of a flight against the air: the state vector, and phi and psi.
#[derive(Debug, Clone, Copy)]
struct AirStep<const N: usize> {
    y: [f64; N],
    angles: [f64; 2],
}

/// The start of a flight at the time `now` of a motion, on a slope with the tangent `tilt`. Integration steps have
/// the tolerance `tol`; the first one is longer than usual by the factor `longer`.
#[derive(Clone, Copy)]
pub(crate) struct Launch<'a> {
    pub body: &'a Body,
    pub from: &'a Aloft,
    pub now: f64,
    pub tol: f64,
    pub longer: f64,
    pub tilt: f64,
}

/// A flight against the air, computed by integration.
pub(crate) struct AirFlight<G = (), const N: usize = NUMBERS> {
    shape: Shape<f64>,
    from: Aloft,
    /// The quaternion of the body's axes at the start of the flight.
    facing: [f64; 4],
    /// The flight of the same body without the air, which gives the parabola of the centre.
    free: Flight,
    losses: Couples<f64>,
    own: G,
    /// Both rims, if the arguments of user-defined laws are counted from the lower one.
    rims: Option<[Rim<f64>; 2]>,
    now: f64,
    steps: RefCell<Vec<AirStep<N>>>,
    tol: f64,
    first: f64,
    spent: Spent,
}

/// The equations of a flight against the air; `rims` says for each rim whether it may land.
#[derive(Clone, Copy)]
struct AirFlow<'a, G, const N: usize> {
    of: &'a AirFlight<G, N>,
    rims: [bool; MOST_CIRCLES],
}

/// The reason for which a flight against the air halts.
#[derive(Debug, Clone, Copy, PartialEq)]
enum AirHalt {
    Time,
    /// The rim with this index lands.
    Lands(usize),
    /// A user-defined law has a wrong value.
    Fault,
    GivenUp,
}

/// The times up to which each rim cannot land.
type Clear = [f64; MOST_CIRCLES];

/// The angular velocity in the state vector, along the axes of the body.
fn body_rates<const N: usize>(y: &[f64; N]) -> [f64; 3] {
    [y[4], y[5], y[6]]
}

/// The axis of the body in the laboratory, and its change since the start.
struct Leaning {
    axis: [f64; 3],
    change: [f64; 3],
}

/// The axes of the body in the laboratory, as the columns of the rotation.
fn axes([w, x, y, z]: [f64; 4]) -> [[f64; 3]; 3] {
    [
        [w * w + x * x - y * y - z * z, 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
        [2.0 * (x * y - w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z + w * x)],
        [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), w * w - x * x - y * y + z * z],
    ]
}

impl<G: Own, const N: usize> AirFlight<G, N> {
    /// A flight against the air under these losses and the user-defined laws `own`.
    pub fn new(from: Launch<'_>, losses: Couples<f64>, own: G) -> Self {
        let Launch { body, from, now, tol, longer, tilt } = from;
        let (free, shape) = (Flight::new(body, from, tilt), &body.shape());
        let from = &free.from;
        // The axes of the body are e1, e2 and e3 at the start, which lean toward x.
        let half = 0.5 * from.angle.0.atan2(from.angle.1);
        let (sin, cos) = if half < FRAC_PI_2 { half.sin_cos() } else { (1.0, 0.0) };
        let [w1, w2, w3] = from.w;
        let mut y = [0.0; N];
        y[4..7].copy_from_slice(&[w1, w2, w3]);
        let rims = (body.has_two_rims() && !body.has_row()).then(|| body.rims());
        let steps = RefCell::new(vec![AirStep { y, angles: [0.0; 2] }]);
        let fastest = w1.abs().max(w2.abs()).max(w3.abs());
        let (first, spent) = (
            longer * FIRST_STEP / (1.0 + fastest),
            Spent { evaluations: 0, erred: 0.0, patience: 0, exhausted: None },
        );
        let facing = [cos, 0.0, -sin, 0.0];
        Self { shape: *shape, from: *from, facing, free, losses, own, rims, now, steps, tol, first, spent }
    }

    /// The couple of the air at the state vector `y`, along the axes of the body.
    fn couple(&self, y: &[f64; N]) -> [f64; 3] {
        let w = body_rates(y);
        let m = self.losses.at(&Kinematics::of(&self.shape.rim, (1.0, 0.0), w[0], w)).free;
        if !self.own.has_couple() {
            return m;
        }
        let own = self.own_couple(y);
        core::array::from_fn(|i| m[i] + own[i])
    }

    /// The state at the state vector `y`, and the sine and cosine of psi.
    fn state(&self, y: &[f64; N]) -> (State, [f64; 2]) {
        // The vertical is s e1 + c e3.
        let [first, second, axis] = axes(self.quaternion(y));
        let (up, s) = ([first[2], second[2]], first[2].hypot(second[2]));
        let [cos, sin] = if s > 0.0 { up.map(|x| x / s) } else { [1.0, 0.0] };
        let [x, z, w3] = body_rates(y);
        let (w1, w2) = (cos * x + sin * z, cos * z - sin * x);
        (State { theta: s.atan2(axis[2]), w1, w2, w3 }, [sin, cos])
    }

    /// The user-defined couple at the state vector `y`, along the axes of the body, for a normal force of 0.
    fn own_couple(&self, y: &[f64; N]) -> [f64; 3] {
        let (state, [sin, cos]) = self.state(y);
        let (own, driven) = (self.own.couple_at(&state, 0.0), self.driven(y));
        let [m1, m2, m3]: [f64; 3] = core::array::from_fn(|i| own[i] + driven[i]);
        [cos * m1 - sin * m2, sin * m1 + cos * m2, m3]
    }

    /// Calls the user-defined drive at the state vector `y`. Returns its couple along e1, e2, e3.
    fn driven(&self, y: &[f64; N]) -> [f64; 3] {
        if N == NUMBERS {
            return [0.0; 3];
        }
        let last = self.steps.borrow().last().map_or([0.0; 2], |step| step.angles);
        let here = self.aloft(y, self.angles(y, last));
        let lower = self.rims.filter(|_| here.angle.1 < 0.0).map(|rims| here.on_other_rim(&rims));
        let at = lower.unwrap_or(here);
        let (mut all, ([x, z], (sin, cos))) = ([0.0; BODY_NUMBERS], (self.velocity(y), at.pose[0].sin_cos()));
        (all[SIN], all[COS], all[TIME]) = (at.angle.0, at.angle.1, self.now + y[AIR_TIME]);
        all[PHI..PHI + 4].copy_from_slice(&at.pose);
        self.own.asks_drive(&all, at.w, at.slip, [x * cos + z * sin, z * cos - x * sin], at.height);
        let [m1, m2, m3] = self.own.driven().1;
        if lower.is_some() { [m1, -m2, -m3] } else { [m1, m2, m3] }
    }

    /// The velocity of the centre of mass along x and y.
    fn velocity(&self, y: &[f64; N]) -> [f64; 2] {
        let ([forth, aside, _], (sin, cos)) = (self.free.velocity, self.from.pose[0].sin_cos());
        let falls = self.free.tilt * y[AIR_TIME];
        [forth * cos - aside * sin + falls + y[AIR_VELOCITY], forth * sin + aside * cos + y[AIR_VELOCITY + 1]]
    }

    /// The body in the air at the state vector `y`, where phi and psi have changed by these angles since the start.
    fn aloft(&self, y: &[f64; N], [phi, psi]: [f64; 2]) -> Aloft {
        let (sin, cos) = psi.sin_cos();
        let [along, aside, w3] = body_rates(y);
        let w = [along * cos - aside * sin, along * sin + aside * cos, w3];
        let [x, across, cosine] = self.leans(y).axis;
        let sine = if cosine.abs() < LEVEL_COSINE {
            ((1.0 - cosine) * (1.0 + cosine)).sqrt()
        } else {
            x.hypot(across)
        };
        let beside = if N == NUMBERS { [0.0; 4] } else { core::array::from_fn(|i| y[NUMBERS + i]) };
        let [height, _] = self.rim(y, 0);
        let at = self.free.placed_beside(y[AIR_TIME], (sine, cosine), w, [phi, psi], beside);
        Aloft { height, ..at }
    }

    /// The quaternion of the body's axes.
    fn quaternion(&self, y: &[f64; N]) -> [f64; 4] {
        core::array::from_fn(|i| self.facing[i] + y[i])
    }

    fn leans(&self, y: &[f64; N]) -> Leaning {
        let ((s, c), [a0, b0, c0, d0], [da, db, dc, dd]) =
            (self.from.angle, self.facing, [y[0], y[1], y[2], y[3]]);
        let [a, b, c1, d] = self.quaternion(y);
        let change = [
            2.0 * (db * d + b0 * dd + da * c1 + a0 * dc),
            2.0 * (dc * d + c0 * dd - da * b - a0 * db),
            (a + a0) * da - (b + b0) * db - (c1 + c0) * dc + (d + d0) * dd,
        ];
        Leaning { axis: [change[0] - s, change[1], c + change[2]], change }
    }

    /// The height of the lowest point of rim `k`, and its time derivative.
    fn rim(&self, y: &[f64; N], k: usize) -> [f64; 2] {
        let (Leaning { axis, change }, (s0, c0), t) = (self.leans(y), self.from.angle, y[AIR_TIME]);
        let (rim, began) = (self.free.rim_at(k, axis[2]), self.free.rim_at(k, c0));
        let [first, second, _] = axes(self.quaternion(y));
        let s = axis[0].hypot(axis[1]);
        // The third component of w x e3.
        let cosine_rate = y[5] * first[2] - y[4] * second[2];
        let sine_rate = if s > 0.0 { -(axis[2] * cosine_rate / s) } else { 0.0 };
        let sine =
            if s + s0 > 0.0 { ((axis[0] - s0) * change[0] + axis[1] * change[1]) / (s + s0) } else { 0.0 };
        let begin = self.free.height_at_start(k) + began.less(&rim).height(self.from.angle);
        let [.., up] = self.free.velocity;
        [
            begin + t * (up - 0.5 * t) - rim.slope((sine, change[2])),
            up - t - rim.slope((sine_rate, cosine_rate)),
        ]
    }

    /// The equations of the flight, with the rims that may land.
    fn flow(&self, rims: [bool; MOST_CIRCLES]) -> AirFlow<'_, G, N> {
        AirFlow { of: self, rims }
    }

    /// The state vector after the part `h` of a step.
    fn part(&self, step: &AirStep<N>, h: f64) -> [f64; N] {
        let flow = self.flow([false; MOST_CIRCLES]);
        flow.part(&flow.place(step.y), h)
    }

    /// The changes of phi and psi since the start, from the state vector `y`, within half a turn of the values
    /// before.
    fn angles(&self, y: &[f64; N], [phi, psi]: [f64; 2]) -> [f64; 2] {
        let [first, _, axis] = axes(self.quaternion(y));
        let turned = (-axis[1]).atan2(-axis[0]);
        let phi = turned + TAU * ((phi - turned) / TAU).round();
        let (sin, cos) = phi.sin_cos();
        // e2 is horizontal, and e1 = e2 x e3.
        let across = first[1] * cos - first[0] * sin;
        let along = first[0] * axis[2] * cos + first[1] * axis[2] * sin + first[2] * axis[0].hypot(axis[1]);
        let spun = across.atan2(along);
        [phi, spun + TAU * ((psi - spun) / TAU).round()]
    }

    /// The changes of phi and psi at the end `y` of the part [from, to] of a step. Close to a pole phi turns by up to
    /// half a turn in a moment, so that parts in which phi turns by more than `FAR_TURN` are divided.
    fn turned(&self, step: &AirStep<N>, [from, to]: [f64; 2], before: [f64; 2], y: &[f64; N]) -> [f64; 2] {
        let angles = self.angles(y, before);
        let middle = 0.5 * (from + to);
        if (angles[0] - before[0]).abs() < FAR_TURN || middle - from <= SHORT_PART * self.first {
            return angles;
        }
        let half = self.part(step, middle);
        self.turned(step, [middle, to], self.turned(step, [from, middle], before, &half), y)
    }
}

impl<G: Own, const N: usize> AirFlight<G, N> {
    /// The coefficients of a user-defined couple in powers of the time, up to the time `near`: those of a polynomial
    /// through its values.
    fn fitted(&self, near: f64) -> [[f64; FITTED]; 3] {
        let mut all = [[0.0; FITTED]; 3];
        if !self.own.has_couple() {
            return all;
        }
        let (wide, first) = (near / (FITTED - 1) as f64, self.steps.borrow()[0]);
        let values: [[f64; 3]; FITTED] =
            core::array::from_fn(|k| self.own_couple(&self.part(&first, wide * k as f64)));
        for (i, all) in all.iter_mut().enumerate() {
            let mut divided = values.map(|m| m[i]);
            for order in 1..FITTED {
                for k in (order..FITTED).rev() {
                    divided[k] = (divided[k] - divided[k - 1]) / order as f64;
                }
            }
            // Newton's form, in units of `wide`, to powers of the time.
            for k in (0..FITTED).rev() {
                for power in (1..FITTED).rev() {
                    all[power] = all[power - 1] - k as f64 * all[power];
                }
                all[0] = divided[k] - k as f64 * all[0];
            }
            all.iter_mut().enumerate().for_each(|(k, x)| *x /= wide.powi(k as i32));
        }
        all
    }

    /// The coefficients of sine and cosine of theta in powers of the time since the start; `own` has those of the
    /// user-defined couple.
    fn series(&self, own: &[[f64; FITTED]; 3]) -> [[f64; TERMS]; 2] {
        let tape = Tape::default();
        let number = |x: f64| tape.number(x);
        let given: [Taped<'_>; 9] = core::array::from_fn(|_| tape.given());
        let ([x, y, z, w1, w2, w3, o1, o2, o3], zero) = (given, number(0.0));
        let Shape { rim, i1, i3 } = self.shape.map(number);
        let seen = Kinematics::of(&rim, (number(1.0), zero), w1, [w1, w2, w3]);
        let [mut m1, mut m2, mut m3] = self.losses.map(number).at(&seen).free;
        if self.own.has_couple() {
            (m1, m2, m3) = (m1 + o1, m2 + o2, m3 + o3);
        }
        // The height of a ball does not depend on s, which may be zero.
        let flat = self.free.landings.rims.iter().all(|rim| rim.a == 0.0);
        let sine = if flat { zero } else { (x * x + y * y).sqrt() };
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
        let [o1, o2, o3] = own.map(|m| m[0]);
        [s, 0.0, c, w1, w2, w3, o1, o2, o3].into_iter().enumerate().for_each(|(i, x)| player.set(i, 0, x));
        player.begin();
        for n in 1..TERMS {
            for i in 0..MOVING {
                let rate = player.result(i).at[n - 1];
                player.set(i, n, rate / n as f64);
            }
            for (i, m) in own.iter().enumerate() {
                player.set(MOVING + i, n, m.get(n).copied().unwrap_or(0.0));
            }
            player.go_on(n);
        }
        [player.result(MOVING).at, *player.given(2)]
    }

    /// The earliest landing, by power series, of a rim that touches at the start; and for each rim the time up to
    /// which no other landing is possible.
    fn leaves(&self, leaves: [Leaves; MOST_CIRCLES]) -> Result<(FirstLanding, Clear), Exhausted> {
        let (mut first, mut clear) = (None, [0.0; MOST_CIRCLES]);
        if leaves == [None; MOST_CIRCLES] {
            return Ok((first, clear));
        }
        let count = self.free.landings.count;
        let near = (0..count).map(|k| self.free.near(k)).fold(f64::INFINITY, f64::min);
        let mut near = AIR_SHARE * near;
        if self.own.has_couple() {
            near = near.min(2.0 * self.first);
        }
        let series = self.series(&self.fitted(near));
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
        for i in 0..count {
            let Some(order) = leaves[i] else { continue };
            match self.free.leaves(i, order, near, &swung)? {
                Some(t) => {
                    clear[i] = t;
                    if first.is_none_or(|(before, _)| t < before) {
                        first = Some((t, i));
                    }
                }
                None => clear[i] = near,
            }
        }
        Ok((first, clear))
    }
}

impl<G: Own, const A: usize> Flow<MOST_CIRCLES> for AirFlow<'_, G, A> {
    type Halt = AirHalt;
    const TIME: usize = AIR_TIME;
    const OVER: AirHalt = AirHalt::Time;
    const PAUSE: AirHalt = AirHalt::GivenUp;
    /// Number of steps between two calls of `go_on`; 1 with user-defined laws, each call of which may be slow.
    const BREATH: u64 = if G::IS { 1 } else { 256 };
    const LOOKS_ON: bool = true;
    const CLOSELY: bool = true;

    fn theta<const N: usize>(&self, y: &[f64; N]) -> f64 {
        self.of.state(&core::array::from_fn::<f64, A, _>(|i| y[i])).0.theta
    }

    #[inline(always)]
    fn write_rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) {
        let y: [f64; A] = core::array::from_fn(|i| y[i]);
        let (Shape { i1, i3, .. }, [a, b, c, d]) = (self.of.shape, self.of.quaternion(&y));
        let [x, z, w] = body_rates(&y);
        let [m1, m2, m3] = self.of.couple(&y);
        all[..NUMBERS].copy_from_slice(&[
            -0.5 * (b * x + c * z + d * w),
            0.5 * (a * x + c * w - d * z),
            0.5 * (a * z + d * x - b * w),
            0.5 * (a * w + b * z - c * x),
            ((i1 - i3) * z * w + m1) / i1,
            ((i3 - i1) * x * w + m2) / i1,
            m3 / i3,
            -(m1 * x + m2 * z + m3 * w),
            1.0,
        ]);
        if A > NUMBERS {
            let ([f_x, f_y], [v_x, v_y]) = (self.of.own.driven().0, self.of.velocity(&y));
            all[NUMBERS..A].copy_from_slice(&[y[AIR_VELOCITY], y[AIR_VELOCITY + 1], f_x, f_y]);
            all[AIR_LOST] -= f_x * v_x + f_y * v_y;
        }
    }

    fn margins<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; MOST_CIRCLES] {
        let y: [f64; A] = core::array::from_fn(|i| place.y[i]);
        core::array::from_fn(|i| {
            let [value, slope] = if self.rims[i] { self.of.rim(&y, i) } else { [1.0, 0.0] };
            Dual { value, slope }
        })
    }

    fn margin<const N: usize>(&self, y: &[f64; N], i: usize) -> f64 {
        self.of.rim(&core::array::from_fn::<f64, A, _>(|i| y[i]), i)[0]
    }

    fn end(&self, i: usize) -> AirHalt {
        AirHalt::Lands(i)
    }

    fn error<const N: usize>(&self, y: &[f64; N], made: &rk8::Step<f64, N>) -> f64 {
        // The height of a rim changes by at most this much with a number of q.
        let reach = 2.0 * self.of.free.reach;
        let per = |i: usize| if i < 4 { reach } else { 1.0 / y[i].abs().max(1.0) } / self.of.tol;
        made.error(per, N as f64)
    }

    fn fastest<const N: usize>(&self, y: &[f64; N]) -> f64 {
        (4..7).fold(1.0, |most: f64, i| most.max(y[i].abs()))
    }

    fn first<const N: usize>(&self, _: &[f64; N]) -> f64 {
        self.of.first
    }

    fn calm<const N: usize>(&self, y: &[f64; N]) -> f64 {
        LONGEST_STEP / self.fastest(y).max(self.of.free.rate)
    }

    fn longest<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        self.calm(&place.y)
    }

    fn stopped<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(AirHalt, [f64; N])> {
        if !self.of.own.has_couple() {
            return None;
        }
        let State { theta, w1, w2, w3 } = self.of.state(&core::array::from_fn::<f64, A, _>(|i| place.y[i])).0;
        let at = [theta.sin(), theta.cos(), w1, w2, w3];
        self.of.own.finds_fault(&[], Some((at, 0.0))).then_some((AirHalt::Fault, place.y))
    }

    fn passed<const N: usize>(&self, (from, ..): TakenStep<'_, N>, _: f64, to: &FlowPlace<N>) {
        let y: [f64; A] = core::array::from_fn(|i| to.y[i]);
        let Some(step) = self.of.steps.borrow().last().copied() else { return };
        let angles = self.of.turned(&step, [0.0, y[AIR_TIME] - from.y[AIR_TIME]], step.angles, &y);
        self.of.steps.borrow_mut().push(AirStep { y, angles });
    }
}

impl<G: Own, const N: usize> Flies for AirFlight<G, N> {
    fn lands(
        &mut self,
        leaves: [Leaves; MOST_CIRCLES],
        until: f64,
        limits: Steps,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<FirstLanding, Exhausted> {
        self.spent.patience = limits.patience;
        let (soon, clear) = self.leaves(leaves)?;
        let soon = soon.filter(|(t, _)| *t <= until);
        let until = soon.map_or(until, |(t, _)| t);
        let count = self.free.landings.count;
        let mut times = [until; MOST_CIRCLES + 1];
        times[..count].copy_from_slice(&clear[..count]);
        times.iter_mut().for_each(|t| *t = t.min(until));
        times.sort_by(f64::total_cmp);
        let (mut y, mut limits) = (self.steps.borrow()[0].y, Steps { first: Some(self.first), ..limits });
        for t in times {
            let now = y[AIR_TIME];
            if t <= now {
                continue;
            }
            let flow = self.flow(core::array::from_fn(|i| i < count && clear[i] <= now));
            let flown = flow.run(flow.place(y), limits, &[t], &mut |_| (), go_on);
            let Spent { evaluations, erred, patience, exhausted } = flown.spent;
            y = flown.y;
            self.spent.evaluations += evaluations;
            self.spent.erred += erred;
            self.spent.patience = patience;
            let toil = limits.toil.saturating_sub(evaluations);
            limits = Steps { first: Some(flown.step), patience, toil, ..limits };
            match flown.halt {
                AirHalt::Time => {}
                AirHalt::Lands(rim) => return Ok(Some((y[AIR_TIME], rim))),
                AirHalt::Fault | AirHalt::GivenUp => {
                    return Err(exhausted.unwrap_or(Exhausted::Evaluations));
                }
            }
        }
        Ok(soon)
    }

    fn at(&self, t: f64) -> (Aloft, f64) {
        if t == 0.0 {
            return (self.free.given, 0.0);
        }
        let steps = self.steps.borrow();
        let step = &steps[steps.partition_point(|step| step.y[AIR_TIME] <= t).max(1) - 1];
        let part = (t - step.y[AIR_TIME]).max(0.0);
        let y = if part > 0.0 { self.part(step, part) } else { step.y };
        let angles = self.turned(step, [0.0, part], step.angles, &y);
        (self.aloft(&y, angles), y[AIR_LOST])
    }

    fn free(&self) -> &Flight {
        &self.free
    }

    fn spent(&self) -> Option<Spent> {
        Some(self.spent)
    }
}
