//! One phase of a body under user-defined laws: its equations, and the ends of the phase.
//!
//! ```text
//! N from m(N)     secants of the couple, until N no longer changes
//! ```
//! The equations are those of the library's laws. Slopes of margins are differences, since a user-defined law has no
//! derivative.

use crate::error::Error;
use crate::laws::body::{Body, landing_angle};
use crate::laws::contact::lossy::{Acted, Held, Lossy};
use crate::laws::contact::lying::{Flat, Lying};
use crate::laws::contact::slip::{Friction, SlipResponse, Slipping};
use crate::laws::contact::standstill::{Standstill, standstill_under};
use crate::laws::contact::{Contact, Force, Table, grip};
use crate::laws::custom::{CoupleLaw, Custom, FrictionLaw, SpeedLaw, fault_of_couple, fault_of_friction};
use crate::laws::loss::{Couple, Couples, Losses, UnderCouple};
use crate::laws::state::State;
use crate::methods::flow::{Flow, FlowPlace};
use crate::methods::{radau, rk8};
use crate::motions::body::face::FLAT;
use crate::motions::body::own::{Own, differences};
use crate::motions::body::slide::{Slide, contact_velocity, first, longest, vanished};
use crate::motions::body::write::state;
use crate::motions::dry::creep::{ASIDE, is_fast, slopes};
use crate::motions::walk::numbers::{
    BodyNumbers, COS, HEAT, Halt, PHI, SIN, TIME, U2, UH, W1, W2, W3, pose_rates,
};
use crate::motions::walk::slip_over;
use crate::motions::{Ask, Ending, Kind};
use crate::numbers::Dual;
use core::cell::Cell;
use core::f64::consts::{FRAC_PI_2, PI};

/// Number of margins: face, other rim, normal force, and room or grip.
const CUSTOM_MARGINS: usize = 4;
/// Largest number of secants for the normal force.
const SECANTS: usize = 40;
/// A step is near its limit of stability if its length times the slope of the rates is more than this.
const STABLE: f64 = 0.3;
/// A slip lasts if it loses less than this share of its speed in a unit of sigma, in which it approaches its direction.
const ENDS_SLOWLY: f64 = 0.02;
/// A law is stiff if it pulls w at this many times the rate at which w changes.
const FAR_FASTER: f64 = 100.0;

/// One phase: its body, its laws, and a flag that is true if the contact point slips.
#[derive(Clone, Copy)]
pub(crate) struct CustomFlow<'a> {
    pub body: &'a Body,
    pub ask: &'a Ask,
    pub custom: Custom<'a>,
    /// The last wrong value of a law since the last step that was taken.
    pub fault: &'a Cell<Option<Error>>,
    pub slips: bool,
    pub tol: f64,
    /// The direction in which the current slip began from rest, and the time for which it keeps that direction.
    pub way: [f64; 2],
    pub keeps: f64,
}

/// The response of the body: accelerations, force, the rates of the slip and of the time, and the margin of the slip.
#[derive(Clone, Copy)]
pub(super) struct CustomResponse {
    pub w: [f64; 3],
    pub u: [f64; 2],
    pub force: [f64; 3],
    pub free: f64,
    pub room: f64,
    pub power: f64,
    pub pace: f64,
}

/// The state at these numbers with theta > 0, and the sign of e1 and e2 in it: the axis of a ball may lean to the other
/// side.
fn upright(angle: (f64, f64), w: [f64; 3]) -> (f64, State) {
    let side = if angle.0 < 0.0 { -1.0 } else { 1.0 };
    let theta = (side * angle.0).atan2(angle.1);
    (side, State { theta, w1: side * w[0], w2: side * w[1], w3: w[2] })
}

impl<'a> CustomFlow<'a> {
    /// The state as seen from the lower rim of a body with two rims, and -1 if that is the other one, else 1.
    fn lower(&self, y: &State) -> (State, f64) {
        if y.theta <= FRAC_PI_2 || self.body.ell() <= 0.0 || self.body.theta_end() != FRAC_PI_2 {
            return (*y, 1.0);
        }
        (State { theta: PI - y.theta, w2: -y.w2, w3: -y.w3, ..*y }, -1.0)
    }

    /// The law of sliding friction at a speed.
    pub(super) fn friction(&self, speed: f64) -> Friction {
        match (self.ask.table.friction(), self.custom.friction) {
            (Friction::Coulomb { fixed, .. }, Some(law)) => {
                let mu = if self.custom.has_failed() { f64::NAN } else { law.coefficient(speed) };
                if mu.is_nan() && speed.is_finite() {
                    self.fault.set(fault_of_friction(mu, speed));
                }
                Friction::Coulomb { mu, fixed, patch: 0.0 }
            }
            (friction, _) => friction,
        }
    }

    pub(super) fn kind(&self) -> Kind {
        if self.slips || self.ask.table == Table::Smooth { Kind::Slipping } else { Kind::Rolling }
    }

    /// The response to the couple of all losses, from the response to given couples and its normal force.
    fn solved<R>(
        &self,
        angle: (f64, f64),
        w: [f64; 3],
        answer: impl Fn(Option<UnderCouple>) -> (R, f64),
    ) -> (R, Option<UnderCouple>) {
        let built_in = Couples::of(&self.ask.losses, |x| x);
        let Some(law) = self.custom.couple else {
            let couples = (!self.ask.losses.is_none()).then(|| built_in.with_given(None));
            return (answer(couples).0, couples);
        };
        let (side, y) = upright(angle, w);
        let at = |normal: f64| {
            // A law that has failed is not called again.
            let failed = self.custom.has_failed();
            let m = if failed { [f64::NAN; 3] } else { law.couple(self.body, &y, normal.max(0.0)) };
            if m.iter().any(|x| x.is_nan()) && [y.theta, y.w1, y.w2, y.w3].iter().all(|x| x.is_finite()) {
                self.fault.set(fault_of_couple(m, &y, normal.max(0.0)));
            }
            [side * m[0], side * m[1], m[2]]
        };
        let of = |given: Couple<f64>| Some(built_in.with_given(Some(given)));
        let (mut normal, mut m) = (1.0, at(1.0));
        let mut couples = of(Couple { free: m, pressed: [0.0; 3] });
        let (mut found, mut next) = answer(couples);
        if m.iter().any(|x| x.is_nan()) {
            return (found, couples);
        }
        for _ in 0..SECANTS {
            let more = at(next);
            if more == m
                || more.iter().any(|x| x.is_nan())
                || (next - normal).abs() <= 4.0 * f64::EPSILON * (1.0 + next.abs())
            {
                return (found, couples);
            }
            let pressed: [f64; 3] = core::array::from_fn(|i| (more[i] - m[i]) / (next - normal));
            let free = core::array::from_fn(|i| more[i] - pressed[i] * next);
            (normal, m, couples) = (next, more, of(Couple { free, pressed }));
            (found, next) = answer(couples);
        }
        let lost = Couple { free: [f64::NAN; 3], pressed: [f64::NAN; 3] };
        (answer(of(lost)).0, of(lost))
    }

    /// The error of a law that supplies energy in the state with these numbers, whose rates are `rate`.
    pub(super) fn supplies<const N: usize>(&self, y: &[f64; N], rate: &[f64; N]) -> Option<Error> {
        let (angle, w) = (y.angle(), y.w());
        let couple = self.custom.couple.filter(|_| rate[N - 1] < 0.0 || !self.ask.losses.is_none());
        let of_couple = couple.and_then(|law| {
            let ((_, y), normal) = (upright(angle, w), self.answer(y).force[0].max(0.0));
            fault_of_couple(law.couple(self.body, &y, normal), &y, normal)
        });
        let friction = self.custom.friction.filter(|_| self.slips && rate[HEAT] < 0.0);
        of_couple.or_else(|| {
            let speed = y[UH].hypot(y[U2]);
            friction.and_then(|law| fault_of_friction(law.coefficient(speed), speed))
        })
    }

    /// Whether steps of the length `h` from the numbers `y` are short only because a law is stiff: the couple pulls w
    /// towards a slow motion much faster than w changes, and than rotation and nutation allow.
    pub(super) fn is_kept_short<const N: usize>(&self, y: &[f64; N], h: f64) -> bool {
        let (fast, rate) = (<Slide>::fastest(y), self.rates(y));
        let mut slope = 0f64;
        for j in 2..5 {
            let mut more = *y;
            more[j] += ASIDE * fast;
            let above = self.rates(&more);
            slope += (2..5).map(|i| ((above[i] - rate[i]) / (more[j] - y[j])).powi(2)).sum::<f64>();
        }
        let (slope, change) = (slope.sqrt(), rate[W1].hypot(rate[W2]).hypot(rate[W3]));
        let fast = FAR_FASTER * change.max(fast / self.calm(y)) / fast;
        h * slope > STABLE && slope > fast
    }

    /// The response of a body that rolls, or slides freely on a smooth table, and the couples that act.
    fn held(&self, contact: Contact, angle: (f64, f64), w: [f64; 3]) -> (Acted<f64>, Option<UnderCouple>) {
        let rates = contact.rates(self.body);
        self.solved(angle, w, |losses| {
            let losses = losses.unwrap_or(Couples::of(&Losses::NONE, |x| x).with_given(None));
            let acted = Lossy { rates, losses }.at(angle, w[0] / angle.0, w, Held::Nothing);
            (acted, acted.force[0])
        })
    }

    /// The response of a body that rolls, or slides freely.
    pub(super) fn rolls(&self, angle: (f64, f64), w: [f64; 3]) -> CustomResponse {
        let (at, _) = self.held(self.ask.table.contact(), angle, w);
        let [normal, along, across] = at.force;
        let held = grip(self.ask.table.mu(), normal, along * along + across * across);
        let room = if self.ask.table.mu().is_finite() { held } else { 1.0 };
        CustomResponse {
            w: at.w,
            u: [0.0; 2],
            force: at.force,
            free: normal,
            room,
            power: at.power,
            pace: 1.0,
        }
    }

    /// The response of a body that slips with u, or that begins to slip along `way`.
    pub(super) fn slides(
        &self,
        angle: (f64, f64),
        w: [f64; 3],
        u: [f64; 2],
        way: Option<[f64; 2]>,
    ) -> CustomResponse {
        let law = Slipping::on(self.body, &self.friction(u[0].hypot(u[1])));
        let answer = |losses| {
            let law = law.with_losses(losses);
            let (at, pace) = match way {
                Some(way) => (law.towards(angle, w, u, way), 1.0),
                None => law.at(angle, w, u),
            };
            ((at, pace), at.force[0])
        };
        let ((at, pace), losses) = self.solved(angle, w, answer);
        let power = law.with_losses(losses).power(angle, w, at.force[0]);
        CustomResponse { w: at.w, u: at.u, force: at.force, free: at.free, room: at.room, power, pace }
    }

    pub(super) fn answer<const N: usize>(&self, y: &[f64; N]) -> CustomResponse {
        let (angle, w) = (y.angle(), y.w());
        if self.slips { self.slides(angle, w, y.slip(), None) } else { self.rolls(angle, w) }
    }

    /// The force in a state near the numbers `y`; `way` is the direction in which a slip begins.
    pub(super) fn force(&self, near: &State, u: [f64; 2], way: [f64; 2]) -> Force {
        let (angle, w) = (near.theta.sin_cos(), [near.w1, near.w2, near.w3]);
        let begins = (u == [0.0; 2]).then_some(way);
        let at = if self.slips { self.slides(angle, w, u, begins) } else { self.rolls(angle, w) };
        let [normal, along, across] = at.force;
        Force { normal, along, across }
    }

    /// Writes the rates of all numbers from the response.
    fn writes<const N: usize>(&self, y: &[f64; N], at: &CustomResponse, all: &mut [f64; N]) {
        let (precession, w2) = (y[W1] / y[SIN], y[W2]);
        let [_, along, across] = at.force;
        let heat = -(along * y[U2] + across * y[UH]);
        let turns = [precession, y[W3] - y[COS] * precession];
        let over = contact_velocity(&self.body.shape().rim, y.angle(), w2, turns[1], y.slip());
        let pose = pose_rates(y[PHI], turns, over);
        let rates = [-(y[COS] * w2), y[SIN] * w2, at.w[0], at.w[1], at.w[2], at.u[0], at.u[1], 1.0, heat];
        for (to, rate) in all.iter_mut().zip(rates.into_iter().chain(pose).chain([at.power])) {
            *to = at.pace * rate;
        }
    }

    /// The derivatives of all numbers with respect to time, for a slip that begins along `way`.
    pub(super) fn rates_along<const N: usize>(&self, y: &[f64; N], way: [f64; 2]) -> [f64; N] {
        let (at, mut all) = (self.slides(y.angle(), y.w(), [0.0; 2], Some(way)), *y);
        self.writes(y, &at, &mut all);
        all
    }

    fn all_margins<const N: usize>(&self, y: &[f64; N]) -> [f64; CUSTOM_MARGINS] {
        let at = self.answer(y);
        let (high, far) = landing_angle(self.body.theta_end());
        let side = if self.body.theta_end() < PI { high * y[COS] - far * y[SIN] } else { 1.0 };
        [if self.body.is_ball() { 1.0 } else { y[SIN] - FLAT }, side, at.free, at.room]
    }

    /// The behaviour of a contact point at rest.
    pub(super) fn standstill(&self, y: &State) -> Standstill {
        let (_, couples) = self.held(Contact::Rolling, y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
        standstill_under(self.body, y, &self.friction(0.0), couples)
    }

    /// The time in which the body turns by about a radian, at most a unit of time.
    pub(super) fn moment<const N: usize>(&self, y: &[f64; N]) -> f64 {
        (self.calm(y) / 3.0).min((y[SIN] / y[W2]).abs()).min(1.0)
    }

    /// The end of a phase, if the phase is over at once.
    pub(super) fn at_start<const N: usize>(&self, y: &[f64; N], at: &CustomResponse) -> Option<Ending> {
        let (end, theta) = (self.body.theta_end(), state(y).theta);
        let rises = y[W2] > 0.0 || y[W2] == 0.0 && at.w[1] > 0.0;
        match () {
            () if self.slips && at.room <= 0.0 => Some(Ending::Painleve),
            () if end < PI && (theta > end || theta == end && !rises) => Some(Ending::Side),
            () if at.free <= 0.0 => Some(Ending::LiftOff),
            () => None,
        }
    }
}

impl SpeedLaw for CustomFlow<'_> {
    fn varies(&self) -> bool {
        self.custom.friction.is_some()
    }

    /// NaN for a wrong value, which is noted.
    fn coefficient_at(&self, speed: f64) -> f64 {
        let mu = self.friction(speed).strength();
        match fault_of_friction(mu, speed) {
            Some(fault) => {
                self.fault.set(Some(fault));
                f64::NAN
            }
            None => mu,
        }
    }
}

impl Own for CustomFlow<'_> {
    const IS: bool = true;
    type Speeds = ();
    fn speeds(&self) {}

    fn has_couple(&self) -> bool {
        self.custom.couple.is_some()
    }

    fn couple(&self, y: &State, normal: f64) -> [f64; 3] {
        let (seen, side) = self.lower(y);
        match self.custom.couple {
            Some(_) if self.custom.has_failed() => [f64::NAN; 3],
            Some(law) => {
                let [m1, m2, m3] = law.couple(self.body, &seen, normal);
                if (m1 + m2 + m3).is_nan() && [y.theta, y.w1, y.w2, y.w3].iter().all(|x| x.is_finite()) {
                    self.fault.set(fault_of_couple([m1, m2, m3], &seen, normal));
                }
                [m1, side * m2, side * m3]
            }
            None => [0.0; 3],
        }
    }

    fn takes_fault(&self) -> Option<Error> {
        self.fault.take().filter(|_| !self.custom.has_failed())
    }

    fn is_faulty(&self) -> bool {
        self.custom.has_failed() || self.fault.get().is_some()
    }

    fn finds_fault(&self, speeds: &[f64], y: &State, normal: f64) -> bool {
        if !self.custom.has_failed() {
            let slow = |law: &dyn FrictionLaw| {
                speeds.iter().find_map(|&speed| fault_of_friction(law.coefficient(speed), speed))
            };
            let seen = self.lower(y).0;
            let turns =
                |law: &dyn CoupleLaw| fault_of_couple(law.couple(self.body, &seen, normal), &seen, normal);
            let fault = self.custom.couple.and_then(turns);
            self.fault.set(fault.or_else(|| self.custom.friction.and_then(slow)));
        }
        self.is_faulty()
    }

    fn in_air(&self, losses: &Losses) -> Option<Couples<f64>> {
        let air = ().in_air(losses);
        if self.has_couple() { air.or(Some(Couples::of(&Losses::NONE, |x| x))) } else { air }
    }

    fn slides(
        &self,
        _: &Slide,
        angle: (f64, f64),
        w: [f64; 3],
        u: [f64; 2],
        way: Option<[f64; 2]>,
    ) -> (SlipResponse<f64>, f64) {
        let CustomResponse { w, u, force, free, room, power, .. } =
            CustomFlow::slides(self, angle, w, u, way);
        (SlipResponse { w, u, free, room, force, held: [0.0; 2], kept: [0.0; 2] }, power)
    }

    fn rolls(&self, _: &Body, y: &State, _: &Losses) -> ([f64; 3], f64) {
        let at = CustomFlow::rolls(self, y.theta.sin_cos(), [y.w1, y.w2, y.w3]);
        (at.w, at.power)
    }

    fn standstill(&self, _: &Body, y: &State, _: &Friction, _: &Losses) -> Standstill {
        CustomFlow::standstill(self, y)
    }

    fn lying(&self, law: &Lying<f64>, y: Flat<f64>) -> Option<Lying<f64>> {
        let [w1, w3, u_h, u_2] = y;
        let [other_h, other_2] = law.other_slip(y);
        let strength = |speed: f64| {
            let speed = if law.dry { speed } else { speed.max(f64::MIN_POSITIVE) };
            self.friction(speed).strength() / if law.dry { 1.0 } else { speed }
        };
        let varied = self.varies().then(|| [u_h.hypot(u_2), other_h.hypot(other_2)].map(strength));
        let state = State { theta: FRAC_PI_2, w1, w2: 0.0, w3 };
        let own = self.has_couple().then(|| self.couple(&state, 1.0));
        Some(Lying { strength: varied.unwrap_or(law.strength), own, ..*law })
    }
}

impl Flow<CUSTOM_MARGINS> for CustomFlow<'_> {
    type Halt = Halt;
    const TIME: usize = TIME;
    const OVER: Halt = Halt::Time;
    const PAUSE: Halt = Halt::Pause;
    const ENDLESS: Halt = Halt::Endless;
    const LOOPS: bool = true;
    /// A step calls a law dozens of times, and each call may be slow.
    const BREATH: u64 = 1;
    const MAY_BE_STIFF: bool = true;

    fn write_rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) {
        self.writes(y, &self.answer(y), all);
    }

    /// The slower a slip, the faster it approaches its slow direction. Where it also ends at its own pace, as most slips do,
    /// that is no faster in sigma than its end.
    fn is_stiff<const N: usize>(&self, place: &FlowPlace<N>) -> bool {
        let ([u, v], [du, dv]) = (place.y.slip(), place.rate.slip());
        let lasts = u * du + v * dv > -ENDS_SLOWLY * (u * u + v * v);
        lasts && is_fast(self.stable(place) * place.rate[TIME], self.calm(&place.y))
    }

    fn implicit_step<const N: usize>(
        &self,
        from: &FlowPlace<N>,
        h: f64,
        guess: radau::Guess<N>,
    ) -> (rk8::Step<f64, N>, radau::Collocated<N>) {
        let (y, fast, slip) = (&from.y, <Slide>::fastest(&from.y), from.y[UH].hypot(from.y[U2]));
        let sizes = [y[SIN], 1.0, fast, fast, fast, slip, slip];
        let slopes = slopes(y, &sizes, |y| self.rates(y));
        radau::step(|y, all| self.write_rates(y, all), y, &slopes, &sizes, (h, 0.01 * self.tol), guess)
    }

    fn margins<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; CUSTOM_MARGINS] {
        differences(place, self.calm(&place.y), |y| self.all_margins(y))
    }

    fn margin<const N: usize>(&self, y: &[f64; N], i: usize) -> f64 {
        self.all_margins(y)[i]
    }

    fn end(&self, i: usize) -> Halt {
        let last = if self.slips { Halt::Jam } else { Halt::Slips };
        [Halt::Face, Halt::Side, Halt::LiftOff, last][i]
    }

    fn error<const N: usize>(&self, y: &[f64; N], made: &rk8::Step<f64, N>) -> f64 {
        // Only a slip that may come to rest keeps its direction; on a film there may be no slip at all.
        let dry = self.slips && self.ask.table.friction().sticks();
        <Slide>::error(self.tol, y, made, dry)
    }

    fn fastest<const N: usize>(&self, y: &[f64; N]) -> f64 {
        <Slide>::fastest(y)
    }

    fn first<const N: usize>(&self, y: &[f64; N]) -> f64 {
        first(y)
    }

    fn calm<const N: usize>(&self, y: &[f64; N]) -> f64 {
        longest(y, &self.body.shape())
    }

    fn longest<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        self.calm(&place.y) / place.rate[TIME].min(1.0)
    }

    fn stopped<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(Halt, [f64; N])> {
        self.fault.set(self.supplies(&place.y, &place.rate));
        if self.fault.get().is_some() {
            return Some((Halt::Endless, place.y));
        }
        let friction = self.friction(0.0);
        let over = slip_over(true, friction.strength());
        let sticks = self.slips && friction.sticks();
        sticks.then(|| vanished(place, over)).flatten().map(|y| (Halt::Standstill, y))
    }

    fn stuck<const N: usize>(&self, _: &FlowPlace<N>, _: &[Dual<f64>; CUSTOM_MARGINS]) -> Option<Halt> {
        None
    }

    fn is_extrapolated(halt: Halt) -> bool {
        halt == Halt::Standstill
    }

    fn shown<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        *y
    }

    fn theta<const N: usize>(&self, y: &[f64; N]) -> f64 {
        y[SIN].atan2(y[COS])
    }
}
