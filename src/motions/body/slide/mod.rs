//! A body that slips, from an initial slip or from rest, to the end of its slip.
//!
//! ```text
//! y = (s, c, w1, w2, w3, u_h, u_2, t, heat; phi, psi, x, y)        in sigma, dt = |u|/(|u| + soft) dsigma
//! u = 0   reached as exp(-sigma); the last part is one step, where its error is below a hundredth of a tolerance
//! N0 = 0,   eps = 1,   theta = 0,   theta = theta_end                margins that turn negative
//! ```
//! [`rk8`] takes the steps. A margin that becomes negative within a step, even if it is positive again at the
//! end, is located on parts of the step; states at requested times are computed on such parts, too.
//! [`contact::slip`](crate::laws::contact::slip) has the equations.
//!
//! Error: 1e-11 in states and 1e-12 in times; a test of `test_slip_reference` has 25 motions to 25 digits.

mod creeps;
mod lossy;
mod slips;
pub(crate) mod slow;

use super::face::FLAT;
use super::own::Own;
use super::pole;
use super::roll::lossy::REST;
use crate::laws::body::{Body, Rim, Shape, landing_angle};
use crate::laws::contact::Force;
use crate::laws::contact::slip::{FollowsSpeed, Friction, SlipResponse, Slipping};
use crate::laws::loss::{Couples, Holds, Law, Losses, OwnCouple};
use crate::laws::state::State;
use crate::methods::flow::{FASTEST, Flow, FlowPlace};
use crate::methods::{radau, rk8};
use crate::motions::dry::creep::{Creeping, Creeps, IMPLICIT_TURNS, rests_below};
use crate::motions::dry::friction::LEAST_GROWTH;
use crate::motions::dry::settled::EFFORT;
use crate::motions::walk::numbers::{
    BodyNumbers, COS, HEAT, Halt, MARGINS, PHI, SIN, TIME, U2, UH, W1, W2, W3, loses, pose_rates, poses,
};
use crate::motions::walk::{MOMENT, slip_over};
use crate::numbers::{Dual, Real};
use core::f64::consts::PI;
pub(super) use creeps::is_still;
pub(crate) use lossy::ways;

/// The halts of the margins, in the order of the margins.
const SLIP_ENDS: [Halt; MARGINS] =
    [Halt::Face, Halt::Side, Halt::LiftOff, Halt::Jam, Halt::Contour, Halt::Drilling];

/// Error of the end of a slip that is extrapolated, in tolerances. It is far below this bound: with a bound of 1 it was at most
/// 0.1, and no claim of 432 random motions was too small; with a bound of 100 it was up to 7, and two claims were.
const AT_ONCE: f64 = 0.01;
/// Lanes leave a slip to a single flow at this share of the speed that friction takes from it in the time of such a rest, unless
/// it is less than `MUCH_FASTER` times as fast when it gets a lane.
#[cfg(feature = "many")]
const SHARE_OF_LAST: f64 = 0.5;
#[cfg(feature = "many")]
const MUCH_FASTER: f64 = 10.0;
/// Largest angle between the direction of such a slip and its mean.
const STRAIGHT: f64 = 1e-2;
/// Angle by which a direction beside that of a slip differs from it.
const BESIDE: f64 = 1e-3;

/// Sine of theta at which a slipping face has landed if it comes down by infinitely many turns. It is smaller
/// than `FLAT`, since the time of the landing is extrapolated from the last turns.
const FLATTER: f64 = 1e-14;

/// The equations of a body that slips, and the ends of its slip.
#[derive(Clone, Copy)]
pub(crate) struct Slide<L = ()> {
    pub law: Slipping<f64, L, L>,
    /// The law for numbers with a slope.
    sloped: Slipping<Dual<f64>, L, L>,
    /// The law without the couples along the contour.
    bare: Slipping<f64, L, L>,
    theta_end: f64,
    ball: bool,
    sticks: bool,
    /// Sine of theta at which a face has landed.
    flat: f64,
    /// Whether a couple that grows with psi' has almost stopped the contact along the rim.
    pub settled: bool,
    /// The creep of a uniform ball on a patch of contact, without other losses than rolling resistance, in which every slip
    /// ends; and whether the slip has become this creep.
    pub(super) creeping: Option<Creeping>,
    pub died: bool,
    /// Whether rolling and rocking begin from rest, in the direction that the signs of the losses have.
    rolls_off: bool,
    /// Whether there are laws of loss of the library.
    has_laws: bool,
    /// The share by which the couple that holds the contact along the rim may exceed its limit, after it has settled.
    sure: f64,
    pub tol: f64,
}

impl<L: Own> Slide<L> {
    pub fn new(body: &Body, friction: &Friction, losses: &Losses, tol: f64, own: L) -> Self {
        let law = Slipping::on(body, friction).varying(own).with_losses(Couples::with_own(losses, own));
        let dual = |value: f64| Dual { value, slope: 0.0 };
        let sloped = Slipping::of(&law.shape.map(dual), dual(law.strength), law.dry).varying(own);
        let sloped =
            sloped.with_losses(law.losses.map(|losses| losses.map(dual))).with_patch(law.patch().map(dual));
        let (theta_end, ball) = (body.theta_end(), body.is_ball());
        let bare = law.with_losses(law.losses.map(Couples::off_the_contour));
        let flat = if losses.turn_endlessly() { FLATTER } else { FLAT };
        Self {
            law,
            sloped,
            bare,
            theta_end,
            ball,
            sticks: law.dry,
            flat,
            settled: false,
            creeping: law.patch().filter(|_| body.is_uniform_ball() && !own.has_couple()).and_then(
                |radius| {
                    let arm = losses.is_only(Law::RollingResistance)?;
                    Creeping::under(body.i3(), [law.strength, radius, arm])
                },
            ),
            died: false,
            rolls_off: false,
            has_laws: !losses.is_none(),
            sure: 0.0,
            tol,
        }
    }

    /// The speed below which a slip counts as zero.
    pub fn over(&self) -> f64 {
        self.law.patch().map_or(slip_over(self.law.dry, self.law.strength), rests_below)
    }

    /// The speed below which the rest of a slip is about that of [`Slide::ends_at_once`], so that a single flow continues a
    /// slip that lanes have followed up to there; a slip that begins hardly faster is in lanes to its end.
    #[cfg(feature = "many")]
    pub fn over_in_lanes<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let time = (AT_ONCE * self.tol).cbrt() * self.calm(y) / 3.0;
        // Friction slows a slip along the lean by mu N or more.
        let near = SHARE_OF_LAST * self.law.strength * time;
        let [u_h, u_2] = y.slip();
        if self.law.dry && u_h.hypot(u_2) > MUCH_FASTER * near { near.max(self.over()) } else { self.over() }
    }

    /// The numbers at the end of a slip whose rest is so short that a single step has an error below `AT_ONCE` tolerances:
    /// the cube of the angle by which the body turns meanwhile, and its product with the square of that by which the slip
    /// turns. None for a longer rest.
    ///
    /// ```text
    /// r alpha' = -k (alpha - a),   r = r0 (1 - t/T),   p = k T/r0:   the mean of alpha is alpha0 + (a - alpha0) p/(1 + p)
    /// ```
    /// The direction alpha returns to a, which moves with the body, so that it is taken in the middle of the time T. The
    /// rates in the middle, in the mean direction, are those of the step.
    #[inline(never)]
    fn ends_at_once<const N: usize>(&self, place: &FlowPlace<N>) -> Option<[f64; N]> {
        let ([u, v], [du, dv]) = (place.y.slip(), place.rate.slip());
        let (square, pace) = (u * u + v * v, place.rate[TIME]);
        let left = square / -(u * du + v * dv);
        let (time, allowed) = (left * pace, AT_ONCE * self.tol);
        let third = |turns: f64| turns * turns * turns < allowed;
        // The angle `turns` is at least the time that is left.
        if self.settled || !(left > 0.0 && third(time)) {
            return None;
        }
        let falls = (place.y[W2] / place.y[SIN]).abs();
        let turns = (time * (3.0 / self.calm(&place.y)).max(falls)).max(left / self.rooted(place));
        if !third(turns) {
            return None;
        }
        // The torque of the direction by an angle `by` beside that of the slip, which has the size `share` at the
        // numbers `y`.
        let beside = |by: f64, share: f64| [share * (u - by * v), share * (v + by * u)];
        let bends = |y: &[f64; N], by: f64, share: f64| {
            let [u, v] = beside(by, share);
            let at = self.acts(y.angle(), y.w(), [u, v]).u;
            (u * at[1] - v * at[0]) / (share * square)
        };
        // A slip that leaves its direction the faster, the slower it is, may pass by zero, however near.
        let returns = (bends(&place.y, -BESIDE, 1.0) - bends(&place.y, BESIDE, 1.0)) / (2.0 * BESIDE);
        let share = time / (1.0 + time * returns);
        let first = share * bends(&place.y, 0.0, 1.0);
        let middle = |rates: &[f64; N], by: f64| {
            let mut y: [f64; N] = core::array::from_fn(|i| place.y[i] + 0.5 * time * rates[i]);
            [y[UH], y[U2]] = beside(by, 0.5);
            y
        };
        let in_time = |y: &[f64; N]| {
            let all = self.rates(y);
            all.map(|rate| rate / all[TIME])
        };
        let mut begin = place.y;
        [begin[UH], begin[U2]] = beside(first, 1.0);
        let half = middle(&in_time(&begin), first);
        let mean = share * (returns * first + bends(&half, first, 0.5));
        if !(returns > 0.0 && mean.abs().max(first.abs()) < STRAIGHT && turns * mean * mean < allowed) {
            return None;
        }
        let half = middle(&in_time(&half), mean);
        let rates = in_time(&half);
        let ([u, v], [du, dv]) = (half.slip(), rates.slip());
        let lasts = 2.0 * (u * u + v * v) / -(u * du + v * dv);
        if !(lasts > 0.5 * time && lasts < 2.0 * time) {
            return None;
        }
        let mut end: [f64; N] = core::array::from_fn(|i| place.y[i] + lasts * rates[i]);
        (end[UH], end[U2]) = (0.0, 0.0);
        Some(end)
    }

    /// The law without those of the user.
    pub fn of_the_library(&self) -> Slipping<f64> {
        self.law.varying(()).with_losses(self.law.losses.map(|losses| losses.beside(())))
    }

    /// The response of a body that slips with u, or that begins to slip along `way`, and the power of its losses.
    pub fn slips(
        &self,
        angle: (f64, f64),
        w: [f64; 3],
        u: [f64; 2],
        way: Option<[f64; 2]>,
    ) -> (SlipResponse<f64>, f64) {
        let at = match way {
            Some(way) => self.law.towards(angle, w, u, way),
            None => self.law.at(angle, w, u).0,
        };
        (at, self.law.power(angle, w, at.force[0]))
    }

    /// The energy of the body with these numbers.
    pub fn energy<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let state = State { theta: y[SIN].atan2(y[COS]), w1: y[W1], w2: y[W2], w3: y[W3] };
        self.law.energy(&state, y.slip())
    }

    /// The response of the body, as one compiled copy of the law for callers that need it only
    /// once in a step.
    #[inline(never)]
    pub(super) fn acts(&self, angle: (f64, f64), w: [f64; 3], u: [f64; 2]) -> SlipResponse<f64> {
        self.law.answers(angle, w, u).0
    }

    /// The contact force in a state; a slip that begins has the direction `way`.
    pub fn force(&self, y: &State, slip: [f64; 2], way: [f64; 2]) -> Force {
        if L::IS && slip == [0.0; 2] {
            let [normal, along, across] =
                self.law.towards(y.theta.sin_cos(), [y.w1, y.w2, y.w3], slip, way).force;
            return Force { normal, along, across };
        }
        self.law.force(y, if slip == [0.0; 2] { way } else { slip })
    }

    /// The halt by the first margin that fails at the start of a slip; None if all margins are positive.
    pub fn at_start(&self, y: &State, u: [f64; 2]) -> Option<Halt> {
        let (s, c) = y.theta.sin_cos();
        let at = self.acts((s, c), [y.w1, y.w2, y.w3], u);
        let rises = y.w2 > 0.0 || (y.w2 == 0.0 && at.w[1] > 0.0);
        let side = self.theta_end - y.theta;
        if at.room <= 0.0 {
            Some(Halt::Jam)
        } else if self.theta_end < PI && (side < 0.0 || (side == 0.0 && !rises)) {
            Some(Halt::Side)
        } else if at.free <= 0.0 {
            Some(Halt::LiftOff)
        } else {
            None
        }
    }

    /// The error of a step in units of `tol`, where 1 is allowed; speeds count relative to the largest speed.
    #[inline(always)]
    pub fn error<T: Real, const N: usize>(tol: T, y: &[T; N], made: &rk8::Step<T, N>, dry: bool) -> T {
        Self::error_beside(tol, y, made, dry, y[UH].mac(y[UH], y[U2] * y[U2]).sqrt())
    }

    /// The error of a step, where that of a dry slip is relative to the speed `slip`.
    #[inline(always)]
    fn error_beside<T: Real, const N: usize>(
        tol: T,
        y: &[T; N],
        made: &rk8::Step<T, N>,
        dry: bool,
        slip: T,
    ) -> T {
        let one = tol.splat(1.0);
        let fastest = Self::fastest(y);
        let (per_tol, per_speed) = (one / tol, one / (tol * fastest));
        // The error of a dry slip is relative to its speed, so that a vanishing slip keeps its direction.
        let per_slip = if dry { per_speed.max(one.splat(1e3) / slip) } else { per_speed };
        // The error of the sine is relative where the face is almost flat.
        let per_sine = per_tol / y[SIN].abs().max(one.splat(1e-6)).min(one);
        let per = |i: usize| match i {
            0 => per_sine,
            1 | 7 => per_tol,
            5 | 6 => per_slip,
            _ => per_speed,
        };
        made.error(per, N as f64) * made.strictness(tol, TIME, TIME)
    }

    /// The largest speed, at least 1.
    #[inline(always)]
    pub fn fastest<T: Real, const N: usize>(y: &[T; N]) -> T {
        let one = y[SIN].splat(1.0);
        let slip = y[UH].mac(y[UH], y[U2] * y[U2]).sqrt();
        one.max(y[W1].abs()).max(y[W2].abs()).max(y[W3].abs()).max(slip)
    }

    /// Whether the margin `i` can end a slip of this body.
    pub(super) fn watches(&self, i: usize) -> bool {
        match SLIP_ENDS[i] {
            Halt::Face => !self.ball,
            Halt::Side => self.theta_end < PI,
            _ => true,
        }
    }

    /// The margins of these numbers under this law, or only one of them, which may not need the response that `act` computes.
    #[inline(always)]
    fn margins_of<T: Real, const N: usize>(
        &self,
        law: &Slipping<T, L, L>,
        [s, c, mut w1, w2, mut w3, u_h, u_2]: [T; 7],
        only: Option<usize>,
        act: impl FnOnce((T, T), [T; 3], [T; 2]) -> SlipResponse<T>,
    ) -> [T; MARGINS]
    where
        L: OwnCouple<T> + FollowsSpeed<T>,
    {
        if self.settled {
            (w1, w3) = (s * w1, c * w1);
        }
        let (angle, w, u, one) = ((s, c), [w1, w2, w3], [u_h, u_2], s.splat(1.0));
        let mut all = [one; MARGINS];
        if !self.ball {
            all[0] = s - s.splat(self.flat);
        }
        if self.theta_end < PI {
            let (high, far) = landing_angle(self.theta_end);
            all[1] = s.splat(high) * c - s.splat(far) * s;
        }
        let of_losses = only.is_none_or(|i| i > 3);
        let losses = law.losses.as_ref().filter(|_| loses(N) && of_losses);
        let holds = losses.is_some_and(|losses| losses.holds() != Holds::default());
        let [mut held, mut kept] = [[one; 2]; 2];
        if only.is_none_or(|i| matches!(i, 2 | 3)) || holds {
            let at = act(angle, w, u);
            (all[2], all[3], held, kept) = (at.free, at.room, at.held, at.kept);
        }
        if let Some(losses) = losses {
            let seen = losses.seen(&law.shape.rim, angle, w1 / s, w);
            [all[4], all[5]] = ways(losses, &seen, held, self.surely(kept));
        }
        if self.settled && of_losses {
            let bare = law.with_losses(self.bare.losses.map(|losses| losses.map(|x| s.splat(x))));
            let [push, drilling] = self.pushed_on(&bare, angle, w, u);
            all[4] = push;
            if self.holds().drilling {
                all[5] = drilling;
            }
        }
        all
    }

    /// The time in which the body turns by about a radian, at most a unit of time.
    pub(crate) fn moment<const N: usize>(&self, y: &[f64; N]) -> f64 {
        (longest(y, &self.law.shape) / 3.0).min((y[SIN] / y[W2]).abs()).min(1.0)
    }

    /// The rates of all numbers in time, for a slip that begins along `way` under a law of the user.
    pub(crate) fn rates_along<const N: usize>(&self, y: &[f64; N], way: [f64; 2]) -> [f64; N] {
        let ((s, c), w, mut all) = (y.angle(), y.w(), [0.0; N]);
        let at = self.law.towards((s, c), w, [0.0; 2], way);
        self.law.writes(y, &mut all, (&at, 1.0));
        let turning = [w[0] / s, w[2] - c * w[0] / s];
        if poses(N) {
            let over = contact_velocity(&self.law.shape.rim, (s, c), w[1], turning[1], y.slip());
            all[PHI..PHI + 4].copy_from_slice(&pose_rates(y[PHI], turning, over));
        }
        if loses(N) {
            all[N - 1] = self.law.power((s, c), w, at.force[0]);
        }
        all
    }

    /// The numbers at the time `MOMENT` after the beginning of a slip along `way`, whose speed grows at the
    /// rate `growth`. Used where no series exists.
    pub(crate) fn nudged<const N: usize>(&self, start: &[f64; N], way: [f64; 2], growth: f64) -> [f64; N] {
        let (angle, w) = (start.angle(), start.w());
        let u = start.slip();
        let rests = u == [0.0; 2] && self.law.dry && !self.creeps(start);
        let (at, _, heat) = if rests {
            (self.law.towards(angle, w, [0.0; 2], way), 1.0, 0.0)
        } else {
            self.law.answers(angle, w, u)
        };
        let ([s, c], mut y) = ([start[SIN], start[COS]], *start);
        let mut rates = [0.0; N];
        rates[..8].copy_from_slice(&[
            -(c * w[1]),
            s * w[1],
            at.w[0],
            at.w[1],
            at.w[2],
            at.u[0],
            at.u[1],
            1.0,
        ]);
        if rests {
            let growth = if L::IS { growth.max(LEAST_GROWTH) } else { growth };
            (rates[UH], rates[U2]) = (growth * way[0], growth * way[1]);
        }
        rates[HEAT] = heat - (at.force[1] * u[1] + at.force[2] * u[0]);
        let precession = w[0] / s;
        if poses(N) {
            let turning = [precession, w[2] - c * precession];
            let over = contact_velocity(&self.law.shape.rim, (s, c), w[1], turning[1], u);
            rates[PHI..PHI + 4].copy_from_slice(&pose_rates(start[PHI], turning, over));
        }
        if loses(N) {
            rates[N - 1] = self.law.power(angle, w, at.force[0]);
        }
        (0..N).for_each(|i| y[i] += MOMENT * rates[i]);
        if let Some([across, rocks]) = self.begins_to_roll() {
            // A least speed, so that a rolling whose speed grows from zero has its direction.
            for (i, way) in [(2, c * across), (3, rocks), (4, -(s * across))] {
                y[i] += 2.0 * REST * way;
            }
        }
        y
    }
}

impl<L: Own> Slide<L> {
    /// The longest step in sigma towards the roots of the losses.
    fn rooted<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        let Some(losses) = self.sloped.losses.filter(|_| loses(N) && !self.settled) else {
            return f64::INFINITY;
        };
        let [s, c, w1, w2, w3] = core::array::from_fn(|i| Dual { value: place.y[i], slope: place.rate[i] });
        losses.longest(&losses.seen(&self.sloped.shape.rim, (s, c), w1 / s, [w1, w2, w3]), false)
    }
}

impl<L: Own> Flow<MARGINS> for Slide<L> {
    type Halt = Halt;
    const TIME: usize = TIME;
    const OVER: Halt = Halt::Time;
    const PAUSE: Halt = Halt::Pause;
    const ENDLESS: Halt = Halt::Endless;
    const MAY_BE_STIFF: bool = true;
    /// Each call of a law of the user may be slow.
    const BREATH: u64 = if L::IS { 1 } else { 256 };

    #[inline(always)]
    fn is_stiff<const N: usize>(&self, place: &FlowPlace<N>) -> bool {
        // A slip under a law of the user has no series. The smaller it begins, the faster it approaches its direction.
        let begins = || place.y[UH] * place.rate[UH] + place.y[U2] * place.rate[U2] > 0.0;
        let creeps = self.law.patch().is_some() && !self.died || L::IS && !self.settled && begins();
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

    fn is_extrapolated(halt: Halt) -> bool {
        matches!(halt, Halt::Standstill | Halt::Pole)
    }

    fn is_curved(halt: Halt) -> bool {
        halt == Halt::Standstill
    }

    fn theta<const N: usize>(&self, y: &[f64; N]) -> f64 {
        y[SIN].atan2(y[COS])
    }

    #[inline(always)]
    fn write_rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) {
        let [s, c, w1, w2, w3, u_h, u_2] = core::array::from_fn(|i| y[i]);
        let ([precession, spin], power) = if self.settled {
            self.settled_rates(y, all)
        } else {
            let precession = w1 / s;
            let at = if self.law.patch().is_some() { self.patched(y, all) } else { self.law.rates(y, all) };
            let power = if loses(N) { self.law.power((s, c), [w1, w2, w3], at.force[0]) } else { 0.0 };
            ([precession, w3 - c * precession], power)
        };
        if loses(N) {
            all[N - 1] = all[TIME] * power;
        }
        if poses(N) {
            let pace = all[TIME];
            let over = contact_velocity(&self.law.shape.rim, (s, c), w2, spin, [u_h, u_2]);
            let pose = pose_rates(y[PHI], [precession, spin], over);
            all[PHI..PHI + 4].copy_from_slice(&pose.map(|x| pace * x));
        }
    }

    fn margins<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; MARGINS] {
        let y = core::array::from_fn(|i| Dual { value: place.y[i], slope: place.rate[i] });
        self.margins_of::<_, N>(&self.sloped, y, None, |angle, w, u| match self.sloped.patch() {
            Some(patch) => self.sloped_on(angle, w, u, patch).0,
            None => self.sloped.at(angle, w, u).0,
        })
    }

    fn margin<const N: usize>(&self, y: &[f64; N], i: usize) -> f64 {
        let y = core::array::from_fn(|i| y[i]);
        self.margins_of::<_, N>(&self.law, y, Some(i), |angle, w, u| self.acts(angle, w, u))[i]
    }

    /// The halt of an almost vanished slip, extrapolated to u = 0, or of a body that
    /// rests or settles.
    fn stopped<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(Halt, [f64; N])> {
        if L::IS {
            // Without losses of the library a couple that takes energy is no fault.
            let (y, own) = (&place.y, self.law.varies());
            let supplies = place.rate[N - 1] < 0.0 || own.has_couple() && self.has_laws;
            let normal = || self.acts(y.angle(), y.w(), y.slip()).force[0];
            let at = supplies.then(|| (core::array::from_fn(|i| self.common_numbers(y)[i]), normal()));
            if own.finds_fault(&[y[UH].hypot(y[U2])], at) {
                return Some((Halt::Endless, *y));
            }
        }
        if loses(N)
            && !self.settled
            && let Some(rest) = self.comes_to_rest(place)
        {
            return Some((Halt::Rests, rest));
        }
        if self.ball && !self.settled {
            let rates = place.rate.map(|rate| rate / place.rate[TIME]);
            if let Some(there) = pole::passed(&place.y, &rates) {
                return Some((Halt::Pole, there));
            }
        }
        if loses(N) && self.law.patch().is_none() && self.settles(place) {
            return Some((Halt::Settles, place.y));
        }
        if self.law.patch().is_some() {
            return self.rubs_no_more(place);
        }
        if !self.sticks {
            return None;
        }
        let end = self.ends_at_once(place).or_else(|| vanished(place, self.over()));
        end.map(|y| (Halt::Standstill, y))
    }

    #[inline(always)]
    fn passes_unseen<const N: usize>(&self, from: &[f64; N], y: &[f64; N]) -> Option<f64> {
        let turns = loses(N) && self.law.losses.is_some_and(|losses| losses.has(Law::DryContour));
        pole::passes_unseen(from, y, turns).filter(|_| self.ball && !self.settled)
    }

    fn slows<const N: usize>(&self, halt: Halt, place: &FlowPlace<N>) -> f64 {
        let w = place.y.w();
        if halt == Halt::Rests { self.rolling_growth(place, w)[1].abs() } else { f64::INFINITY }
    }

    fn end(&self, i: usize) -> Halt {
        let rocks = self.law.losses.and_then(|losses| losses.ways).is_some_and(|ways| ways.rocking != 0.0);
        if i == 5 && rocks { Halt::Rocking } else { SLIP_ENDS[i] }
    }

    #[inline(always)]
    fn error<const N: usize>(&self, y: &[f64; N], made: &rk8::Step<f64, N>) -> f64 {
        let slip =
            if self.law.patch().is_some() { self.rubs(y) } else { y[UH].mac(y[UH], y[U2] * y[U2]).sqrt() };
        Self::error_beside(self.tol, y, made, self.law.dry, slip)
    }

    fn fastest<const N: usize>(&self, y: &[f64; N]) -> f64 {
        Self::fastest(y)
    }

    fn effort(&self) -> u64 {
        if self.settled { EFFORT } else { 1 }
    }

    fn first<const N: usize>(&self, y: &[f64; N]) -> f64 {
        first(y)
    }

    fn calm<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let y = if self.settled {
            core::array::from_fn(|i| if i == 2 { y[SIN] * y[W1] } else { y[i] })
        } else {
            *y
        };
        longest(&y, &self.law.shape)
    }

    fn longest<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        // `calm` limits the time, and a step in sigma takes less time where the slip is slow.
        let mut most = self.calm(&place.y);
        if self.is_stiff(place) {
            most *= IMPLICIT_TURNS / place.rate[TIME];
        } else {
            if loses(N) && !self.settled {
                most = most.min(self.damped(&place.y));
            }
            most /= place.rate[TIME].min(1.0);
        }
        if self.law.patch().is_some() {
            most = most.min(self.kinked(place));
        }
        most.min(self.rooted(place))
    }

    /// The halt where the steps become short because the force grows without bound.
    fn stuck<const N: usize>(&self, place: &FlowPlace<N>, margins: &[Dual<f64>; MARGINS]) -> Option<Halt> {
        let [s, c, _, w2] = core::array::from_fn(|i| place.y[i]);
        // A face that lands within this time lands before any step that is short enough.
        if !self.ball && s.abs() < 100.0 * FLAT * w2.abs().min(1.0) && c * w2 > 0.0 {
            return Some(Halt::Face);
        }
        // With dry friction this margin is proportional to the speed of the slip.
        let size = if self.law.dry { self.rubs(&place.y) } else { 1.0 };
        (margins[3].value < 0.1 * self.law.shape.i1 * size).then_some(Halt::Jam)
    }

    fn shown<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        self.common_numbers(y)
    }
}

/// The numbers at the end of a slip that is slower than `over`, extrapolated linearly.
pub(crate) fn vanished<const N: usize>(place: &FlowPlace<N>, over: f64) -> Option<[f64; N]> {
    let [u_h, u_2] = place.y.slip();
    let speed = u_h.hypot(u_2);
    // `slowing` is the rate in sigma at which the speed of the slip falls.
    let slowing = -(u_h * place.rate[UH] + u_2 * place.rate[U2]) / speed;
    if speed > over || slowing <= 0.0 && speed > 0.0 {
        return None;
    }
    let left = if speed > 0.0 { speed / slowing } else { 0.0 };
    let mut y: [f64; N] = core::array::from_fn(|i| place.y[i] + left * place.rate[i]);
    (y[UH], y[U2]) = (0.0, 0.0);
    Some(y)
}

/// The velocity of the contact point over the table, along e_h and e2.
#[inline(always)]
pub(crate) fn contact_velocity(
    rim: &Rim<f64>,
    angle: (f64, f64),
    w2: f64,
    spin: f64,
    [u_h, u_2]: [f64; 2],
) -> [f64; 2] {
    [u_h + rim.rho * w2, u_2 + rim.radius(angle) * spin]
}

/// A first step that is short enough, also for an almost flat face that turns or falls fast; the next
/// steps grow fast.
pub(crate) fn first<const N: usize>(y: &[f64; N]) -> f64 {
    let fastest = y[W1].abs().max(y[W2].abs());
    0.02 / (1.0 + fastest.max(y[W3].abs()).max((fastest / y[SIN].abs()).min(FASTEST)))
}

/// The longest step that does not amplify rounding: three radians of the rotation or of the free nutation I3 w3/I1.
#[inline(always)]
pub(crate) fn longest<T: Real, const N: usize>(y: &[T; N], shape: &Shape<T>) -> T {
    let one = y[SIN].splat(1.0);
    let (nutation, precession) = ((y[W3] * shape.i3 / shape.i1).abs(), (y[W1] / y[SIN]).abs());
    one.splat(3.0) / precession.max(y[W1].abs()).max(y[W2].abs()).max(nutation).max(one)
}
