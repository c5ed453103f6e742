//! Integration of a slip: its rates, the conditions that end it, and the lengths and errors of its steps.

use super::standstill::vanished;
use super::{Own, Slide};
use crate::laws::body::{Shape, landing_angle, rounding_at};
use crate::laws::contact::slip::{FollowsSpeed, SlipResponse, Slipping};
use crate::laws::loss::{Holds, Law, OwnCouple};
use crate::methods::flow::{FASTEST, Flow, FlowPlace};
use crate::methods::{radau, rk8};
use crate::motions::body::face::FLAT;
use crate::motions::body::own::differences;
use crate::motions::body::pole;
use crate::motions::dry::creep::{Creeps, IMPLICIT_TURNS};
use crate::motions::dry::held::margins_of_ways;
use crate::motions::dry::settled::EFFORT;
use crate::motions::walk::numbers::{
    BodyNumbers, COS, Halt, MARGINS, PHI, SIN, TIME, U2, UH, W1, W2, W3, driven, loses, pose_rates, poses,
    pull_along,
};
use crate::numbers::{Dual, Real};
use core::f64::consts::PI;
/// The reason for which a slip halts at the zero of each margin, in the order of the margins.
const SLIP_ENDS: [Halt; MARGINS] =
    [Halt::Face, Halt::Side, Halt::LiftOff, Halt::Jam, Halt::Contour, Halt::Drilling];

impl<L: Own> Slide<L> {
    /// The error of an integration step in units of `tol`, so that 1 is allowed; the errors of speeds are relative to
    /// the largest speed.
    #[inline(always)]
    pub fn error<T: Real, const N: usize>(
        tol: T,
        y: &[T; N],
        made: &rk8::Step<T, N>,
        dry: bool,
        time: usize,
    ) -> T {
        Self::error_beside(tol, y, made, (dry, time), y[UH].mac(y[UH], y[U2] * y[U2]).sqrt())
    }

    /// The error of an integration step in units of `tol`. That of a slip under dry friction is relative to the speed
    /// `slip`; `time` is the index of the time in the state vector.
    #[inline(always)]
    fn error_beside<T: Real, const N: usize>(
        tol: T,
        y: &[T; N],
        made: &rk8::Step<T, N>,
        (dry, time): (bool, usize),
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
            5 | 6 => per_slip,
            i if i == 1 || i == time => per_tol,
            _ => per_speed,
        };
        made.error(per, N as f64) * made.strictness(tol, TIME, time)
    }

    /// The largest of the speeds (w and the slip) in the state vector, at least 1.
    #[inline(always)]
    pub fn fastest<T: Real, const N: usize>(y: &[T; N]) -> T {
        let one = y[SIN].splat(1.0);
        let slip = y[UH].mac(y[UH], y[U2] * y[U2]).sqrt();
        one.max(y[W1].abs()).max(y[W2].abs()).max(y[W3].abs()).max(slip)
    }

    /// Whether the margin `i` can end a slip of this body.
    pub(in crate::motions::body) fn watches(&self, i: usize) -> bool {
        match SLIP_ENDS[i] {
            Halt::Face => !self.ball || self.range[0] > 0.0,
            Halt::Side => self.range[1] < PI,
            _ => true,
        }
    }

    /// The margins (functions of the state whose zeros end a slip) under this law, or `only` one of them, which may
    /// not need the forces that `act` computes.
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
        // A ball may have passed its pole, beyond which s is negative.
        let border = |theta: f64| {
            let (sine, cosine) = landing_angle(theta);
            s.splat(sine) * c - s.splat(cosine) * s.abs()
        };
        let [low, high] = self.range;
        let face = match low {
            low if low > 0.0 => rounding_at(low, -w2) - border(low),
            _ if self.ball => one,
            _ => s - s.splat(self.flat),
        };
        let side = if high < PI { border(high) + rounding_at(high, w2) } else { one };
        let of_losses = only.is_none_or(|i| i > 3);
        let losses = law.losses.as_ref().filter(|_| loses(N) && of_losses);
        let holds = losses.is_some_and(|losses| losses.holds() != Holds::default());
        let ([mut free, mut room], [mut held, mut kept]) = ([one; 2], [[one; 2]; 2]);
        if only.is_none_or(|i| matches!(i, 2 | 3)) || holds {
            SlipResponse { free, room, held, kept, .. } = act(angle, w, u);
        }
        let [mut contour, mut drilling] = [one; 2];
        if let Some(losses) = losses {
            let precession = w1 / s;
            let seen = losses.seen(&law.shape.rim, angle, precession, w);
            [contour, drilling] = margins_of_ways(losses, &seen, precession, [held, self.surely(kept)]);
        }
        if self.settled && of_losses {
            let bare = law.with_losses(self.bare.losses.map(|losses| losses.map(|x| s.splat(x))));
            let [push, hold] = self.pushed_on(&bare, angle, w, u);
            contour = push;
            if self.holds().drilling {
                drilling = hold;
            }
        }
        [face, side, free, room, contour, drilling]
    }

    /// The time in which the body turns by about a radian, at most 1, in sqrt(R/g).
    pub(crate) fn moment<const N: usize>(&self, y: &[f64; N]) -> f64 {
        (longest(y, &self.law.shape) / 3.0).min((y[SIN] / y[W2]).abs()).min(1.0)
    }

    /// The longest step, in the variable sigma, that the loss laws allow, since their square roots are not smooth
    /// where they vanish.
    pub(super) fn rooted<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
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
    /// Number of steps between two calls of `go_on`; 1 with user-defined laws, each call of which may be slow.
    const BREATH: u64 = if L::IS { 1 } else { 256 };
    const CALLS: bool = L::IS;

    #[inline(always)]
    fn is_stiff<const N: usize>(&self, place: &FlowPlace<N>) -> bool {
        let creeps =
            self.law.patch().is_some() && !self.died || L::IS && !self.settled && Self::slip_grows(place);
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
        self.asks_drive(y);
        let [s, c, w1, w2, w3] = core::array::from_fn(|i| y[i]);
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
            let (pace, heading) = (all[TIME], y[PHI].sin_cos());
            let runs = self.runs(y, spin, heading);
            if self.tilt != 0.0 || self.turning != 0.0 {
                let [pull_h, pull_2] = driven(self.turning, pull_along(self.tilt, heading), runs);
                (all[UH], all[U2]) = (all[UH] + pace * pull_h, all[U2] + pace * pull_2);
            }
            if L::IS && self.law.varies().drives() {
                let [push_h, push_2] = self.law.varies().pushes(y);
                (all[UH], all[U2]) = (all[UH] + pace * push_h, all[U2] + pace * push_2);
                all[N - 1] -= pace * self.power_of_drive(y);
            }
            let pose = pose_rates(heading, [precession, spin], runs);
            all[PHI..PHI + 4].copy_from_slice(&pose.map(|x| pace * x));
        }
    }

    fn margins<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; MARGINS] {
        if L::IS && self.law.varies().drives() {
            return differences(place, self.calm(&place.y), |y| {
                self.asks_drive(y);
                let y = core::array::from_fn(|i| y[i]);
                self.margins_of::<_, N>(&self.law, y, None, |angle, w, u| self.acts(angle, w, u))
            });
        }
        let y = core::array::from_fn(|i| Dual { value: place.y[i], slope: place.rate[i] });
        self.margins_of::<_, N>(&self.sloped, y, None, |angle, w, u| match self.sloped.patch() {
            Some(patch) => self.sloped_on(angle, w, u, patch).0,
            None => self.sloped.at(angle, w, u).0,
        })
    }

    fn margin<const N: usize>(&self, y: &[f64; N], i: usize) -> f64 {
        self.asks_drive(y);
        let y = core::array::from_fn(|i| y[i]);
        self.margins_of::<_, N>(&self.law, y, Some(i), |angle, w, u| self.acts(angle, w, u))[i]
    }

    /// The halt of a slip that has almost vanished, extrapolated to zero, or of a body that comes to rest or whose
    /// contact settles; else None.
    fn stopped<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(Halt, [f64; N])> {
        if L::IS {
            self.asks_drive(&place.y);
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
        if loses(N) && self.law.patch().is_none() && !self.law.varies().drives() && self.settles(place) {
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
        match i {
            0 if self.range[0] > 0.0 => Halt::Side,
            5 if rocks => Halt::Rocking,
            i => SLIP_ENDS[i],
        }
    }

    #[inline(always)]
    fn error<const N: usize>(&self, y: &[f64; N], made: &rk8::Step<f64, N>) -> f64 {
        let slip =
            if self.law.patch().is_some() { self.rubs(y) } else { y[UH].mac(y[UH], y[U2] * y[U2]).sqrt() };
        Self::error_beside(self.tol, y, made, (self.law.dry, TIME), slip)
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
        if !self.ball && self.range[0] == 0.0 && s.abs() < 100.0 * FLAT * w2.abs().min(1.0) && c * w2 > 0.0 {
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

/// The length of the first step of a slip, short enough also for a body that is almost on its face and turns or falls
/// fast; the next steps grow fast.
pub(crate) fn first<const N: usize>(y: &[f64; N]) -> f64 {
    let fastest = y[W1].abs().max(y[W2].abs());
    0.02 / (1.0 + fastest.max(y[W3].abs()).max((fastest / y[SIN].abs()).min(FASTEST)))
}

/// The longest time step that does not amplify rounding: three radians of the rotation or of the free nutation I3
/// w3/I1.
#[inline(always)]
pub(crate) fn longest<T: Real, const N: usize>(y: &[T; N], shape: &Shape<T>) -> T {
    let one = y[SIN].splat(1.0);
    let (nutation, precession) = ((y[W3] * shape.i3 / shape.i1).abs(), (y[W1] / y[SIN]).abs());
    one.splat(3.0) / precession.max(y[W1].abs()).max(y[W2].abs()).max(nutation).max(one)
}
