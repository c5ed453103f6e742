//! The equations of a phase of a stone: its state vector, the rates, and the margins, whose zeros end the phase.
//!
//! ```text
//! y = (q, w, t; u_x, u_y, heat, x, y; lost)   N = 8 for a stone that rolls without a pose, 14 with losses, else 13
//! dt = |u|/(|u| + soft) dsigma                if the contact point slips with dry friction, else dt = dsigma
//! margins   cos theta - cos theta_end,  N,  (mu_s N)^2 - F^2 in rolling, or the room of a slip,  and w.n or its hold
//! ```
//! The quaternion q = (w, x, y, z) turns the axes of the ellipsoid to those of the laboratory; u is the slip
//! and (x, y) the contact point on the table. Every step ends with a quaternion of length 1.

use super::known::Recorded;
use super::turns::Spot;
use crate::laws::contact::grip;
use crate::laws::contact::slip::FollowsSpeed;
use crate::laws::stone::law::{StoneLaw, StoneResponse, Touching, across, laboratory, turning};
use crate::laws::stone::{StonePose, StoneState};
use crate::methods::flow::{Flow, FlowPlace, TakenStep, looks};
use crate::methods::{SHORT_CODE, radau, rk8};
use crate::motions::body::roll::lossy::REST;
use crate::motions::dry::creep::{Creeps, IMPLICIT_TURNS, rests_below};
use crate::motions::dry::friction::OwnFriction;
use crate::motions::walk::numbers::{Halt, TIME, loses};
use crate::motions::walk::{MOMENT, slip_over};
use crate::numbers::vector::{dot, plus};
use crate::numbers::{Dual, Real};
use core::cell::RefCell;
use nalgebra::Vector3;

/// Number of margins of a stone.
pub(super) const STONE_MARGINS: usize = 4;
/// Number of components of the state vector of a stone that rolls without a pose; the next constants are for any
/// other stone, and with losses.
pub(super) const WITHOUT_POSE: usize = 8;
pub(super) const ALL: usize = 13;
pub(super) const LOSING: usize = 14;
/// Index of the slip along x in the state vector of a stone; the next constants are for the slip along y, the heat,
/// and the place of the contact point.
pub(super) const SLID_X: usize = 8;
pub(super) const SLID_Y: usize = 9;
pub(super) const STONE_HEAT: usize = 10;
pub(super) const STONE_X: usize = 11;
pub(super) const STONE_Y: usize = 12;

/// Parts of the state vector of a stone's motion.
pub(super) trait StoneNumbers<T> {
    /// The orientation of the stone as a quaternion (w, x, y, z).
    fn quaternion(&self) -> [T; 4];
    /// The angular velocity along the axes of the stone.
    fn omega(&self) -> [T; 3];
    /// The slip of the contact point along x and y of the laboratory.
    fn slid(&self) -> [T; 2];
}

impl<T: Copy, const N: usize> StoneNumbers<T> for [T; N] {
    #[inline(always)]
    fn quaternion(&self) -> [T; 4] {
        [self[0], self[1], self[2], self[3]]
    }
    #[inline(always)]
    fn omega(&self) -> [T; 3] {
        [self[4], self[5], self[6]]
    }
    #[inline(always)]
    fn slid(&self) -> [T; 2] {
        [self[SLID_X], self[SLID_Y]]
    }
}

/// A minimum of a margin (a function whose zero ends a phase) is recorded if it is below this many tolerances of a
/// step: the errors of a motion that counts as known may be that large.
const NEAR_END: f64 = 1e7;
/// Index of the margin of the normal force, whose zero is a lift-off.
const LIFTS: usize = 1;
/// Index of the margin of static friction; in a slip, of the margin of a unique contact force.
pub(super) const HOLD: usize = 2;

/// Index of the margin of the drilling that dry friction resists or holds.
const DRILLING: usize = 3;

/// A slip under dry friction ends with this speed instead of 0, so that it keeps its direction.
const ALMOST_NONE: f64 = 1e-150;

/// The motion of the contact point in a phase.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Touch {
    Rolls,
    /// The stone rolls, and friction of the patch of contact holds the drilling at zero.
    Held,
    Slips,
    /// The table is smooth, and the slip is not computed.
    Smooth,
}

/// The equations of a phase of a stone, and the margins, whose zeros end it.
#[derive(Clone, Copy)]
pub(super) struct StoneFlow<'a> {
    pub law: StoneLaw<f64>,
    pub sloped: StoneLaw<Dual<f64>>,
    pub touch: Touch,
    /// The coefficient of static friction that holds a rolling contact point; it may be infinite.
    pub mu: f64,
    /// The cosine of theta_end, at which the edge lands; -2 without an edge.
    pub edge: f64,
    pub tol: f64,
    /// The longest step of this run as a share of the longest allowed one. It is smaller in the run with the larger
    /// tolerance: equal steps in both runs would have equal errors, which their difference would not show.
    pub stride: f64,
    /// Whether events other than a landing of the edge end the phase.
    pub watch: bool,
    /// Whether the motion continues in the air where the stone leaves the table.
    pub hops: bool,
    /// The direction, in the laboratory, in which rolling and rocking begin from rest.
    pub push: [f64; 2],
    /// The largest angular acceleration by rolling resistance; 0 without it.
    pub resisted: f64,
    /// The records of spin reversals and of ends of phases; only in the run with the smaller tolerance.
    pub recorded: Option<&'a RefCell<Recorded>>,
    /// The user-defined law of friction, if there is one.
    pub own: Option<OwnFriction<'a>>,
}

/// The axes of the laboratory, the contact point, and the contact force and accelerations of a stone.
pub(super) struct Seen<T> {
    pub lab: [[T; 3]; 3],
    pub at: Touching<T>,
    pub to: StoneResponse<T>,
    /// dt/dsigma.
    pub pace: T,
}

impl<'a> StoneFlow<'a> {
    /// The contact point, contact force and accelerations of a stone, for plain or dual numbers; `slip` is None if
    /// the state vector has none.
    #[inline(always)]
    pub(super) fn seen<T: Real, const N: usize>(
        &self,
        law: &StoneLaw<T>,
        q: [T; 4],
        w: [T; 3],
        slip: Option<[T; 2]>,
    ) -> Seen<T>
    where
        OwnFriction<'a>: FollowsSpeed<T>,
    {
        let lab = self.axes(q);
        let mut at = law.meeting(&lab, w);
        let zero = w[0].splat(0.0);
        let mut even = zero.splat(1.0);
        if loses(N) {
            at = law.losing(at, &lab, w);
            even = self.pace(&at, w);
        }
        let (to, pace) = match (self.touch, slip) {
            (Touch::Rolls, _) => (law.rolling(&at, w), even),
            (Touch::Held, _) => (law.resting(&at, w, !SHORT_CODE), even),
            (Touch::Slips, Some([u, v])) => {
                let speed = || (u * u + v * v).sqrt();
                let follows =
                    |own: OwnFriction<'a>| law.with_strength(own.strength(law.strength, speed, law.dry));
                let own = self.own.filter(|_| !SHORT_CODE).map(follows);
                own.as_ref().unwrap_or(law).slipping(&at, w, across(&lab, [u, v]))
            }
            _ => (law.pulled(&at, w, [zero; 3]), even),
        };
        Seen { lab, at, to, pace }
    }

    /// The axes of the laboratory, as vectors along the axes of the stone.
    #[inline(always)]
    pub(super) fn axes<T: Real>(&self, q: [T; 4]) -> [[T; 3]; 3] {
        laboratory(if self.law.patch().is_some() { unit_quaternion(q) } else { q })
    }

    #[inline(always)]
    pub(super) fn seen_at<const N: usize>(&self, y: &[f64; N]) -> Seen<f64> {
        let [a, b, c, d, e, f, g] = core::array::from_fn(|i| y[i]);
        self.seen::<_, N>(&self.law, [a, b, c, d], [e, f, g], (N >= ALL).then(|| slip_of(y)))
    }

    #[inline(always)]
    fn margins_of<T: Real, const N: usize>(
        &self,
        law: &StoneLaw<T>,
        seen: &Seen<T>,
        w: [T; 3],
    ) -> [T; STONE_MARGINS] {
        let one = seen.pace.splat(1.0);
        let number = |x: f64| one.splat(x);
        let edge = if self.edge < -1.0 { one } else { seen.at.n[2] - number(self.edge) };
        let drilling = if loses(N) { Self::drilling_margin(law, seen, w) } else { one };
        if !self.watch {
            return [edge, one, one, drilling];
        }
        let hold = if !self.rests() {
            seen.to.room
        } else if self.mu.is_finite() {
            let along = plus(seen.to.force, -seen.to.free, seen.at.n);
            grip(number(self.mu), seen.to.free, dot(along, along))
        } else {
            one
        };
        [edge, seen.to.free, hold, drilling]
    }

    /// Whether the contact point is at rest.
    #[inline(always)]
    pub fn rests(&self) -> bool {
        matches!(self.touch, Touch::Rolls | Touch::Held)
    }

    /// The speed below which a slip counts as zero.
    pub fn over(&self) -> f64 {
        self.law.patch().map_or(slip_over(self.law.dry, self.law.strength), rests_below)
    }

    /// The quantities whose zeros end the phase, at the state vector `y`.
    pub fn margins_at<const N: usize>(&self, y: &[f64; N]) -> [f64; STONE_MARGINS] {
        let (seen, w) = (self.seen_at(y), y.omega());
        self.on_patch(self.margins_of::<_, N>(&self.law, &seen, w), (&seen, w), self.grips(y))
    }

    /// The sum of |d margin/dy_k| over the components of the state, for margin `i`.
    pub fn leans<const N: usize>(&self, y: &[f64; N], i: usize) -> f64 {
        let by = |k: usize| {
            let step = 1e-6 * (1.0 + y[k].abs());
            let moved = |step: f64| {
                let mut other = *y;
                other[k] += step;
                self.margin(&other, i)
            };
            (moved(step) - moved(-step)).abs() / (2.0 * step)
        };
        (0..TIME).map(by).sum::<f64>().max(f64::MIN_POSITIVE)
    }

    /// The state vector at the time `MOMENT` after the beginning of a slip along `way`, whose speed grows at the rate
    /// `growth`.
    pub fn nudged<const N: usize>(&self, y: &[f64; N], way: [f64; 2], growth: f64) -> [f64; N] {
        let (mut to, mut rates) = (*y, [0.0; N]);
        if slip_of(y) == [0.0; 2] && self.law.dry && self.rubs(y) <= self.over() {
            rates = self.rates_along(y, way);
            (rates[SLID_X], rates[SLID_Y]) = (growth * way[0], growth * way[1]);
        } else {
            self.write_rates(y, &mut rates);
            let pace = rates[TIME];
            rates.iter_mut().for_each(|rate| *rate /= pace);
        }
        (0..N).for_each(|i| to[i] += MOMENT * rates[i]);
        self.kept(to)
    }

    /// The time derivative of the state vector while a slip under dry friction begins along `way`.
    pub fn rates_along<const N: usize>(&self, y: &[f64; N], way: [f64; 2]) -> [f64; N] {
        let (lab, q, w, u) = (laboratory(y.quaternion()), y.quaternion(), y.omega(), slip_of(y));
        let at = self.law.losing(self.law.meeting(&lab, w), &lab, w);
        let pulled = self.law.pulled(&at, w, across(&lab, way));
        let (rate, mut rates) = (self.law.slip_rate(&at, w, &pulled), [0.0; N]);
        rates[..4].copy_from_slice(&turning(q, w));
        rates[4..8].copy_from_slice(&[pulled.w[0], pulled.w[1], pulled.w[2], 1.0]);
        for i in [0, 1] {
            rates[SLID_X + i] = dot(lab[i], rate);
            rates[STONE_HEAT] -= u[i] * dot(lab[i], pulled.force);
            rates[STONE_X + i] = u[i] + dot(lab[i], at.r_rate);
        }
        if let Some(lost) = at.lost.filter(|_| loses(N)) {
            rates[N - 1] = -dot(lost.under(dot(pulled.force, at.n).positive_part()), w);
        }
        rates
    }

    /// The contact force along the axes of the laboratory. If a slip just begins, with u = 0, dry friction acts
    /// against its direction `way`.
    pub fn force<const N: usize>(&self, y: &[f64; N], way: [f64; 2]) -> Vector3<f64> {
        let Seen { lab, to, .. } = self.seen_towards(y, way);
        lab.map(|axis| dot(axis, to.force)).into()
    }

    /// The orientation, the contact point and the centre of mass; `still` is the centre of mass at the start, which on a
    /// smooth table is at rest, or falls downhill.
    pub fn pose<const N: usize>(&self, y: &[f64; N], still: [f64; 2]) -> StonePose {
        let Seen { lab, at, .. } = self.seen_at(y);
        let [x, y_r, z] = lab.map(|axis| -dot(axis, at.r));
        let point = if self.touch == Touch::Smooth {
            let fallen = self.law.tilt.map_or(0.0, |tilt| 0.5 * tilt * y[TIME] * y[TIME]);
            [still[0] + fallen - x, still[1] - y_r]
        } else {
            [y[STONE_X], y[STONE_Y]]
        };
        StonePose::new(y.quaternion(), point, [point[0] + x, point[1] + y_r, z])
    }
}

/// Scales a quaternion to length 1, which it does not quite have at the stages of a step. The difference, times w^2,
/// would be an acceleration of the slip, against which a small patch would exert all its friction.
#[inline(always)]
fn unit_quaternion<T: Real>(q: [T; 4]) -> [T; 4] {
    let per = q[0].splat(1.0) / q.iter().fold(q[0].splat(0.0), |sum, x| x.mac(*x, sum)).sqrt();
    q.map(|x| x * per)
}

/// The state (vertical and angular velocity) from a state vector.
pub(super) fn state<const N: usize>(y: &[f64; N]) -> StoneState {
    let [a, b, c, d] = core::array::from_fn(|i| y[i]);
    StoneState { vertical: laboratory([a, b, c, d])[2], w: y.omega() }
}

/// The spin about the vertical and its time derivative, from a state vector and its rates.
pub(super) fn spot<const N: usize>(y: &[f64; N], rate: &[f64; N]) -> Spot {
    let [a, b, c, d, e, f, g] = core::array::from_fn(|i| Dual { value: y[i], slope: rate[i] / rate[TIME] });
    Spot { t: y[TIME], spin: dot(laboratory([a, b, c, d])[2], [e, f, g]) }
}

/// The slip in a state vector; zero if it has none.
#[inline(always)]
pub(super) fn slip_of<T: Real, const N: usize>(y: &[T; N]) -> [T; 2] {
    if N >= ALL { y.slid() } else { [y[TIME].splat(0.0); 2] }
}

/// The slip in the outputs: its components in the laboratory frame in which the stone has the orientation of an
/// initial state with this vertical. Therefore the state and the slip of an output can start another motion.
pub(super) fn output_slip<const N: usize>(y: &[f64; N]) -> [f64; 2] {
    let slip = slip_of(y);
    if slip == [0.0; 2] {
        return slip;
    }
    let u = across(&laboratory(y.quaternion()), slip);
    let [x, y, _] = laboratory(state(y).orientation());
    [dot(x, u), dot(y, u)]
}

impl Flow<STONE_MARGINS> for StoneFlow<'_> {
    type Halt = Halt;
    const CALLS: bool = true;
    const TIME: usize = TIME;
    const OVER: Halt = Halt::Time;
    const PAUSE: Halt = Halt::Pause;
    const ENDLESS: Halt = Halt::Endless;

    fn theta<const N: usize>(&self, y: &[f64; N]) -> f64 {
        state(y).theta()
    }

    #[inline(always)]
    fn write_rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) {
        let Seen { lab, at, to, pace } = self.seen_at(y);
        let w = y.omega();
        let [a, b, c, d] = turning(y.quaternion(), w);
        let [e, f, g] = to.w;
        all[..WITHOUT_POSE].copy_from_slice(&[a, b, c, d, e, f, g, 1.0]);
        if N >= ALL {
            all[8..].fill(0.0);
            if self.touch == Touch::Slips {
                let (u, rate) = (slip_of(y), self.law.slip_rate(&at, w, &to));
                (all[SLID_X], all[SLID_Y]) = (dot(lab[0], rate), dot(lab[1], rate));
                all[STONE_HEAT] = -(u[0] * dot(lab[0], to.force) + u[1] * dot(lab[1], to.force));
                if self.law.patch().is_some() {
                    all[STONE_HEAT] -= to.couple * dot(w, at.n);
                }
                (all[STONE_X], all[STONE_Y]) = (u[0] + dot(lab[0], at.r_rate), u[1] + dot(lab[1], at.r_rate));
            } else if self.rests() {
                (all[STONE_X], all[STONE_Y]) = (dot(lab[0], at.r_rate), dot(lab[1], at.r_rate));
            }
        }
        if let Some(lost) = at.lost.filter(|_| loses(N)) {
            all[N - 1] = -dot(lost.under(dot(to.force, at.n).positive_part()), w);
        }
        if loses(N) || self.touch == Touch::Slips {
            all.iter_mut().for_each(|x| *x *= pace);
        }
    }

    fn margins<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; STONE_MARGINS] {
        let dual = |i: usize| Dual { value: place.y[i], slope: place.rate[i] };
        let [a, b, c, d, e, f, g] = core::array::from_fn(dual);
        let slip = (N >= ALL).then(|| [dual(8), dual(9)]);
        let (seen, w) = (self.seen::<_, N>(&self.sloped, [a, b, c, d], [e, f, g], slip), [e, f, g]);
        self.on_patch(self.margins_of::<_, N>(&self.sloped, &seen, w), (&seen, w), self.grips(&place.y))
    }

    fn margin<const N: usize>(&self, y: &[f64; N], i: usize) -> f64 {
        self.margins_at(y)[i]
    }

    fn end(&self, i: usize) -> Halt {
        [Halt::Face, Halt::LiftOff, if self.rests() { Halt::Slips } else { Halt::Jam }, Halt::Drilling][i]
    }

    #[inline(always)]
    fn error<const N: usize>(&self, y: &[f64; N], made: &rk8::Step<f64, N>) -> f64 {
        let per_tol = 1.0 / self.tol;
        let mut per_speed = per_tol / self.fastest(y);
        if loses(N) && self.is_paced() {
            // Rolling and rocking vanish correctly at any tolerance.
            per_speed = per_speed.max(1e3 / (self.rolls_at(y) + 100.0 * REST));
        }
        // The error of a dry slip is relative to its speed, so that a vanishing slip keeps its direction.
        let [u, v] = slip_of(y);
        let dry = self.touch == Touch::Slips && self.law.dry;
        let slip = if self.law.patch().is_some() { self.rubs(y) } else { u.hypot(v) };
        let per_slip = if dry { per_speed.max(1e3 / slip) } else { per_speed };
        let per = |i: usize| match i {
            0..4 | 7 => per_tol,
            8 | 9 => per_slip,
            _ => per_speed,
        };
        made.error(per, N as f64) * made.strictness(self.tol, TIME, TIME)
    }

    #[inline(always)]
    fn fastest<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let slip = slip_of(y);
        [y[4], y[5], y[6], slip[0], slip[1]].iter().fold(1.0, |most: f64, x| most.max(x.abs()))
    }

    fn first<const N: usize>(&self, y: &[f64; N]) -> f64 {
        self.stride * 0.02 / (1.0 + self.fastest(y))
    }

    fn calm<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let turning = y.omega().iter().fold(1.0, |most: f64, x| most.max(x.abs()));
        3.0 / turning
    }

    fn longest<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        let mut most = self.stride * self.calm(&place.y) / place.rate[TIME].min(1.0);
        if loses(N) {
            most = most.min(self.longest_of_roots(place));
        }
        if self.touch != Touch::Slips || self.law.patch().is_none() && self.own.is_none() {
            return most;
        }
        (if self.is_stiff(place) { IMPLICIT_TURNS * most } else { most }).min(self.kinked(place))
    }

    const MAY_BE_STIFF: bool = !SHORT_CODE;

    #[inline(always)]
    fn is_stiff<const N: usize>(&self, place: &FlowPlace<N>) -> bool {
        if N < ALL || self.touch != Touch::Slips {
            return false;
        }
        let creeps = self.law.patch().is_some() || self.own.is_some() && Self::slip_grows(place);
        creeps && self.creeps_fast(place)
    }

    fn stable<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        self.follows_within(place) / place.rate[TIME]
    }

    #[inline(never)]
    fn implicit_step<const N: usize>(
        &self,
        from: &FlowPlace<N>,
        h: f64,
        guess: radau::Guess<N>,
    ) -> (rk8::Step<f64, N>, radau::Collocated<N>) {
        self.creeps_on(from, h, guess)
    }

    /// The halt of a slip that is almost zero, extrapolated linearly to u = 0; None for a faster slip.
    fn stopped<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(Halt, [f64; N])> {
        if let Some(own) = self.own.filter(|_| self.touch == Touch::Slips)
            && own.is_wrong_at(self.rubs(&place.y))
        {
            return Some((Halt::Endless, place.y));
        }
        if loses(N)
            && let Some(rests) = self.rolls_no_more(place)
        {
            return Some((Halt::Rests, rests));
        }
        if self.touch != Touch::Slips || !self.law.dry {
            return None;
        }
        if self.law.patch().is_some() {
            return self.hardly_rubs(place);
        }
        let (u, rate) = (slip_of(&place.y), slip_of(&place.rate));
        let speed = u[0].hypot(u[1]);
        let slowing = -(u[0] * rate[0] + u[1] * rate[1]) / speed;
        if speed > self.over() || slowing <= 0.0 && speed > 0.0 {
            return None;
        }
        let left = if speed > 0.0 { speed / slowing } else { 0.0 };
        let mut y: [f64; N] = core::array::from_fn(|i| place.y[i] + left * place.rate[i]);
        // A tiny slip remains, whose direction determines the friction at this time.
        (y[SLID_X], y[SLID_Y]) = (u[0] / speed * ALMOST_NONE, u[1] / speed * ALMOST_NONE);
        if speed == 0.0 {
            (y[SLID_X], y[SLID_Y]) = (0.0, 0.0);
        }
        Some((Halt::Standstill, y))
    }

    fn stuck<const N: usize>(&self, _: &FlowPlace<N>, margins: &[Dual<f64>; STONE_MARGINS]) -> Option<Halt> {
        (self.touch == Touch::Slips && margins[2].value < 0.1).then_some(Halt::Jam)
    }

    fn slows<const N: usize>(&self, halt: Halt, place: &FlowPlace<N>) -> f64 {
        if halt == Halt::Rests { self.rolling_growth(&place.y).abs() } else { f64::INFINITY }
    }

    fn is_extrapolated(halt: Halt) -> bool {
        halt == Halt::Standstill
    }

    fn shown<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        *y
    }

    const LOOKS_ON: bool = true;
    const CLOSELY: bool = true;

    fn passed<const N: usize>(&self, (from, h, stages): TakenStep<'_, N>, length: f64, to: &FlowPlace<N>) {
        let Some(recorded) = self.recorded else { return };
        let mut recorded = recorded.borrow_mut();
        let Some(turns) = &mut recorded.turns else { return };
        let mut spots = [spot(&from.y, &from.rate); rk8::LOOKS.len() + 2];
        let end = spot(&to.y, &to.rate);
        for (to, (_, look)) in spots[1..].iter_mut().zip(looks::<Self, STONE_MARGINS, N>((from, h), stages)) {
            let look = spot(&look.y, &look.rate);
            *to = if look.t < end.t { look } else { end };
        }
        spots[rk8::LOOKS.len() + 1] = end;
        if turns.near(&spots, 100.0 * self.tol * self.fastest(&from.y)) {
            let at = |t: f64| {
                let y = self.at_time(from, to, length, t);
                Spot { t, ..spot(&y, &self.rates(&y)) }
            };
            turns.follow(&at, spots[0], end);
        }
    }

    fn grazed<const N: usize>(&self, y: &[f64; N], i: usize, margin: f64) {
        // If static friction only just holds, a slip that is missed would be too short to matter.
        if let Some(recorded) = self.recorded
            && margin < NEAR_END * self.tol * self.fastest(y)
            && !(self.rests() && self.law.dry && i == HOLD || i == DRILLING || i == LIFTS && self.hops)
        {
            recorded.borrow_mut().grazes.push([y[TIME], margin / self.leans(y, i)]);
        }
    }

    #[inline(always)]
    fn kept<const N: usize>(&self, mut y: [f64; N]) -> [f64; N] {
        let square = y[0] * y[0] + y[1] * y[1] + y[2] * y[2] + y[3] * y[3];
        let per = 1.0 / square.sqrt();
        (0..4).for_each(|i| y[i] *= per);
        y
    }
}
