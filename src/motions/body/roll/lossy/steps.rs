//! Integration of a body that loses energy: its rates, the conditions that end a phase, and the settling of its
//! contact.

use super::free::{error, fastest_of, from_side, pace_of, three_radians};
use super::{LossyFlow, REST};
use crate::laws::body::{landing_angle, rounding_at};
use crate::laws::contact::lossy::{Acted, Held, Lossy};
use crate::laws::contact::{Contact, grip};
use crate::laws::loss::{COUNT, Law, OwnCouple, rolling_growth};
use crate::laws::state::{drilling_of, rolling_of};
use crate::methods::flow::{FASTEST, Flow, FlowPlace};
use crate::methods::rk8;
use crate::motions::body::face::{FLAT, lands_at};
use crate::motions::body::own::{Own, differences};
use crate::motions::body::pole;
use crate::motions::dry::creep::hardly_drills;
use crate::motions::dry::held::{left_to_rest, margins_of_ways};
use crate::motions::dry::settled::{Balance, CLOSE, EFFORT, SLOWER, Turned, balance, settles_within};
use crate::motions::walk::numbers::{
    BodyNumbers, COS, Halt, MARGINS, P, PHI, SIN, TIME, W1, W2, W3, X, Y, carried, loses, pose_rates, poses,
    sum,
};
use crate::numbers::{Dual, Real};
use core::f64::consts::PI;

const ROLLING_ENDS: [Halt; MARGINS] =
    [Halt::Face, Halt::Side, Halt::LiftOff, Halt::Slips, Halt::Contour, Halt::Drilling];

/// The state vector where rolling and rocking have stopped, extrapolated linearly by `left` in the variable sigma;
/// `drills` computes the drilling rate from the extrapolated state vector.
pub(crate) fn at_rest<const N: usize>(
    place: &FlowPlace<N>,
    left: f64,
    drills: impl Fn([f64; 5]) -> f64,
) -> [f64; N] {
    let mut rest: [f64; N] = core::array::from_fn(|i| place.y[i] + left * place.rate[i]);
    let drilling = drills(core::array::from_fn(|i| rest[i]));
    [rest[W1], rest[W2], rest[W3]] = [rest[SIN] * drilling, 0.0, rest[COS] * drilling];
    rest
}

impl<G: Own> LossyFlow<G> {
    /// The precession phi', w, the contact force and accelerations, and psi' of a settled contact.
    fn settled(
        &self,
        angle: (f64, f64),
        drilling: f64,
        w2: f64,
        pull: Option<[f64; 2]>,
    ) -> (f64, [f64; 3], Acted<f64>, f64) {
        let radius = self.law.rates.reduced().shape.rim.radius(angle);
        let way = if self.settled { self.settled_way } else { self.ways().contour };
        let act = |precession: f64, w: [f64; 3], rate: f64| {
            let held = Held::Contour(rate);
            let acted = self.bare.under(pull, angle, precession, w, held);
            Turned { acted, push: acted.held[0], normal: acted.force[0] }
        };
        let Balance { precession, w, turned: Turned { acted, push, .. }, spin } =
            balance(&self.law.losses.beside(()), (angle, radius), (drilling, w2), way, act);
        (precession, w, Acted { power: acted.power + push * spin, ..acted }, spin)
    }

    /// The force of the slope, the turntable and the drive, with its derivative in the variable of integration.
    fn sloped_pull<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; 2] {
        let dual = |value: f64, slope: f64| Dual { value, slope };
        let ((sin, cos), turn) = (place.y[PHI].sin_cos(), place.rate[PHI]);
        let (sin, cos) = (dual(sin, cos * turn), dual(cos, -(sin * turn)));
        let tilted = [dual(self.tilt, 0.0) * cos, dual(-self.tilt, 0.0) * sin];
        if self.om == 0.0 {
            return tilted;
        }
        let [x, y] = [X, Y].map(|i| dual(place.y[i], place.rate[i]));
        let y5: [Dual<f64>; 5] = core::array::from_fn(|i| dual(place.y[i], place.rate[i]));
        let (precession, w) = self.turning(y5);
        let (om, rim) = (dual(self.om, 0.0), &self.sloped.rates.reduced().shape.rim);
        let out = rim.rho * w[1] + om * (x * sin - y * cos);
        let on = rim.radius((y5[0], y5[1])) * (w[2] - y5[1] * precession) + om * (x * cos + y * sin);
        [tilted[0] + om * on, tilted[1] - om * out]
    }

    /// The force of the slope, the turntable and the drive on a body whose contact has settled, so that psi' hardly
    /// moves it; None if there is none of them.
    fn settled_pull<const N: usize>(&self, y: &[f64; N]) -> Option<[f64; 2]> {
        self.is_pulled().then(|| self.pull_at(y, y.angle(), y[W2], 0.0))
    }

    /// The error of sin(theta) psi' due to steps where the contact point stops so fast that stability limits the
    /// steps.
    fn noise(&self, w: [f64; 3]) -> f64 {
        100.0 * self.tol * w.iter().fold(1.0, |most: f64, x| most.max(x.abs()))
    }

    /// The speed of rolling and rocking together, and its time derivative.
    fn rolling_growth<const N: usize>(&self, place: &FlowPlace<N>) -> [f64; 2] {
        let y = &place.y;
        let angle = y.angle();
        let (_, w) = self.turning([y[SIN], y[COS], y[P], y[W2], y[W3]]);
        let acted = self.response_under(self.tilted(y), angle, w[0] / angle.0, w, self.held(0.0));
        rolling_growth(angle, w, acted.w)
    }

    /// The end, by linear extrapolation, of rolling and rocking that rolling resistance has almost stopped.
    fn comes_to_rest<const N: usize>(&self, place: &FlowPlace<N>) -> Option<[f64; N]> {
        // A whirr rolls as slowly before its face lands, but is not at rest.
        if !self.paced || place.y[SIN].abs() < FLAT {
            return None;
        }
        let left = left_to_rest(self.rolling_growth(place), REST, place.rate[TIME])?;
        let mut rest = at_rest(place, left, |y| {
            let (_, w) = self.turning(y);
            drilling_of(y.angle(), w[0], w[2])
        });
        let p = if self.moves { rest[SIN] * rest[P] } else { drilling_of(rest.angle(), rest[P], rest[W3]) };
        rest[P] = p;
        Some(rest)
    }

    /// The state vector after the axis of a ball has passed the vertical more closely than steps resolve; None if it
    /// does not.
    fn passes_pole<const N: usize>(&self, place: &FlowPlace<N>) -> Option<[f64; N]> {
        let (angle, y) = (place.y.angle(), &place.y);
        let (precession, w) = self.turning([y[SIN], y[COS], y[P], y[W2], y[W3]]);
        pole::passage(angle.0, angle.1, [w[0], w[1]])?;
        let (mut seen, mut rates) = (*y, place.rate.map(|rate| rate / place.rate[TIME]));
        (seen[W1], seen[W3]) = (w[0], w[2]);
        rates[W1..=W3].copy_from_slice(&self.here(y).response(angle, precession, w, self.held(0.0)).w);
        let mut there = pole::passed(&seen, &rates)?;
        there[P] *= there[SIN];
        Some(there)
    }

    /// The margins (functions whose zeros end the phase); `grips` is the couple per normal force that holds the
    /// drilling on a patch, whose derivative is left out.
    fn margins_of<T: Real, H: OwnCouple<T>>(
        &self,
        law: &Lossy<T, H>,
        tilted: Option<[T; 2]>,
        y: [T; 5],
        grips: Option<f64>,
    ) -> [T; MARGINS] {
        let [s, c, _, w2, _] = y;
        let (precession, w) = self.turning(y);
        let one = s.splat(1.0);
        let acted = law.under(tilted, (s, c), precession, w, self.held(s));
        let endless = self.moves && self.law.losses.turn_endlessly();
        let number = |x: f64| s.splat(x);
        // A ball may have passed its pole, beyond which s is negative.
        let border = |theta: f64, there: bool| {
            let (sine, cosine) = landing_angle(theta);
            from_side([sine, cosine, f64::from(u8::from(there))].map(number), (s.abs(), c))
        };
        let [low, high] = self.range;
        let face = if low > 0.0 {
            rounding_at(low, -w2) - border(low, true)
        } else if self.ball {
            one
        } else {
            s - lands_at(law.rates.reduced().shape.i1, (s, c), [w[0], w2], acted.w[1], endless)
        };
        let side = border(high, high < PI) + rounding_at(high, w2);
        let [normal, along, across] = acted.force;
        let square = along * along + across * across;
        let mut grip = if self.mu.is_finite() { grip(number(self.mu), normal, square) } else { one };
        if self.is_patch() {
            grip = grip.min(hardly_drills(drilling_of((s, c), w[0], w[2]) - number(self.om)));
        }
        let [push, mut limit] = acted.held;
        if let Some(grips) = grips {
            limit = number(grips) * normal;
        }
        let [mut contour, mut drilling] = [one; 2];
        if !self.moves || self.is_patch() || self.has(Law::DryContour) || self.has(Law::Drilling) {
            let seen = law.losses.seen(&law.rates.reduced().shape.rim, (s, c), precession, w);
            [contour, drilling] = margins_of_ways(&law.losses, &seen, precession, [[push, limit]; 2]);
        }
        if self.settled && self.has(Law::DryContour) {
            contour = number(self.settled_way) * push - limit;
        }
        if self.watch {
            [face, side, normal, grip, contour, drilling]
        } else {
            [face, one, one, one, contour, drilling]
        }
    }

    /// The margins (functions whose zeros end the phase) at the state vector `y`.
    fn all_margins<const N: usize>(&self, y: &[f64; N]) -> [f64; MARGINS] {
        self.stands(y);
        self.margins_of(&self.law, self.tilted(y), core::array::from_fn(|k| y[k]), self.grips(y))
    }

    /// Calls the user-defined drive at the state vector `y` of this phase.
    #[inline(always)]
    fn stands<const N: usize>(&self, y: &[f64; N]) {
        if self.is_driven() {
            self.asks_drive(y, self.turning([y[SIN], y[COS], y[P], y[W2], y[W3]]).1);
        }
    }

    /// Writes the derivative of the state vector to `all`. Returns w and the contact force.
    #[inline(always)]
    pub(super) fn rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) -> ([f64; 3], [f64; 3]) {
        let [s, c, w2] = [y[SIN], y[COS], y[W2]];
        let heading = if poses(N) { y[PHI].sin_cos() } else { (0.0, 1.0) };
        self.stands(y);
        let tilted = (poses(N) && self.is_pulled()).then(|| self.pull_along(y, heading));
        let (precession, w, acted) = if self.settled {
            let (precession, w, acted, _) = self.settled((s, c), y[P], w2, tilted);
            (precession, w, acted)
        } else {
            let (precession, w) = self.turning([s, c, y[P], w2, y[W3]]);
            (precession, w, self.response_under(tilted, (s, c), precession, w, self.held(0.0)))
        };
        let [d1, d2, d3] = acted.w;
        let (turn, free) = if self.moves {
            (s * d1 - c * w2 * w[0], d3)
        } else {
            (drilling_of((s, c), d1, d3) - w2 * rolling_of((s, c), w[0], w[2]), 0.0)
        };
        all[..9].copy_from_slice(&[-(c * w2), s * w2, turn, d2, free, 0.0, 0.0, 1.0, 0.0]);
        if loses(N) {
            all[N - 1] = acted.power;
            if self.is_driven() {
                let ([push_h, push_2], [v_h, v_2]) =
                    (self.law.losses.given.pushes(y), self.centre((s, c), w));
                all[N - 1] -= push_h * v_h + push_2 * v_2;
            }
        }
        if poses(N) {
            let spin = if self.moves || self.settled { w[2] - c * precession } else { 0.0 };
            let reduced = self.law.rates.reduced();
            let mut over = match reduced.contact {
                Contact::Rolling => [reduced.shape.rim.rho * w2, reduced.shape.rim.radius((s, c)) * spin],
                Contact::Smooth => [0.0; 2],
            };
            if self.om != 0.0 {
                over = sum(over, carried(self.om, y, heading));
            }
            all[PHI..PHI + 4].copy_from_slice(&pose_rates(heading, [precession, spin], over));
        }
        if self.paced {
            let pace = self.law.pace((s, c), pace_of((s, c), precession, w));
            all.iter_mut().for_each(|x| *x *= pace);
        }
        (w, acted.force)
    }
}

impl<G: Own> Flow<MARGINS> for LossyFlow<G> {
    type Halt = Halt;
    const TIME: usize = TIME;
    const OVER: Halt = Halt::Time;
    const PAUSE: Halt = Halt::Pause;
    const ENDLESS: Halt = Halt::Endless;
    /// Number of steps between two calls of `go_on`; 1 with user-defined laws, each call of which may be slow.
    const BREATH: u64 = if G::IS { 1 } else { 256 };
    const CALLS: bool = G::IS;

    fn is_extrapolated(halt: Halt) -> bool {
        halt == Halt::Pole
    }

    fn theta<const N: usize>(&self, y: &[f64; N]) -> f64 {
        y[SIN].atan2(y[COS])
    }

    #[inline(always)]
    fn write_rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) {
        self.rates(y, all);
    }

    fn margins<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; MARGINS] {
        if self.is_driven() {
            return differences(place, self.calm(&place.y), |y| self.all_margins(y));
        }
        let y = core::array::from_fn(|i| Dual { value: place.y[i], slope: place.rate[i] });
        let tilted = (poses(N) && self.is_pulled()).then(|| self.sloped_pull(place));
        self.margins_of(&self.sloped, tilted, y, self.grips(&place.y))
    }

    fn margin<const N: usize>(&self, y: &[f64; N], i: usize) -> f64 {
        self.all_margins(y)[i]
    }

    fn end(&self, i: usize) -> Halt {
        if i == 5 && self.only_rocks() { Halt::Rocking } else { ROLLING_ENDS[i] }
    }

    #[inline(always)]
    fn error<const N: usize>(&self, y: &[f64; N], made: &rk8::Step<f64, N>) -> f64 {
        // A ball that only rocks passes through its pole, where an error relative to s has no meaning.
        let s = if self.ball && !self.moves { 1.0 } else { y[SIN].abs() };
        let (precession, w) = self.turning([y[SIN], y[COS], y[P], y[W2], y[W3]]);
        let paced = self.paced.then(|| pace_of(y.angle(), precession, w));
        error(self.tol, (s, w), (self.moves, paced), made, (if poses(N) { 9..13 } else { 0..0 }, TIME))
    }

    fn fastest<const N: usize>(&self, y: &[f64; N]) -> f64 {
        fastest_of(self.turning([y[SIN], y[COS], y[P], y[W2], y[W3]]).1)
    }

    fn effort(&self) -> u64 {
        if self.settled { EFFORT } else { 1 }
    }

    fn first<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let (precession, w) = self.turning([y[SIN], y[COS], y[P], y[W2], y[W3]]);
        let falls = (w[1] / y[SIN]).abs().min(FASTEST);
        0.02 / (1.0 + w.iter().fold(precession.abs().max(falls), |most, x| most.max(x.abs())))
    }

    fn calm<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let (precession, w) = self.turning([y[SIN], y[COS], y[P], y[W2], y[W3]]);
        three_radians(&self.law.rates.reduced().shape, precession, w)
    }

    fn longest<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        let y: [Dual<f64>; 5] = core::array::from_fn(|i| Dual { value: place.y[i], slope: place.rate[i] });
        let (precession, w) = self.turning(y);
        let losses = &self.sloped.losses;
        let seen = losses.seen(&self.sloped.rates.reduced().shape.rim, y.angle(), precession, w);
        // `calm` limits the time, and a step in sigma takes less time where the body hardly rolls.
        let mut most = self.calm(&place.y);
        if self.moves && losses.is_soft() {
            let spin = w[2] - y[COS] * precession;
            most = most.min(self.law.damped(place.y.angle(), spin.value));
        }
        (most / place.rate[TIME].min(1.0)).min(losses.longest(&seen, self.paced))
    }

    fn stopped<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(Halt, [f64; N])> {
        let y = &place.y;
        if G::IS {
            // Without losses of the library a couple that takes energy is no fault.
            let supplies = place.rate[N - 1] < 0.0 || self.law.losses.present() != [false; COUNT];
            let (precession, w) = self.turning([y[SIN], y[COS], y[P], y[W2], y[W3]]);
            self.stands(y);
            let normal =
                || self.here(&self.shown(y)).response(y.angle(), precession, w, self.held(0.0)).force[0];
            let at = supplies.then(|| ([y[SIN], y[COS], w[0], w[1], w[2]], normal()));
            if self.law.losses.given.finds_fault(&[], at) {
                return Some((Halt::Endless, *y));
            }
        }
        if let Some(rest) = self.comes_to_rest(place) {
            return Some((Halt::Rests, rest));
        }
        if self.ball && self.moves {
            return self.passes_pole(place).map(|there| (Halt::Pole, there));
        }
        let [s, c, w2] = [y[SIN], y[COS], y[W2]];
        // `fall` is the speed at which either face falls, and `faster` is the rate of that speed.
        let (fall, faster) = (c * w2, c * place.rate[W2] / place.rate[TIME]);
        if !self.moves || self.is_driven() || self.ball || fall <= 0.0 || faster <= 0.0 || s > CLOSE {
            return None;
        }
        let angle = (s, c);
        let (precession, w) = self.turning([s, c, y[P], w2, y[W3]]);
        let spin = w[2] - c * precession;
        let noise = self.noise(w);
        if s * spin.abs() > SLOWER * fall + noise {
            return None;
        }
        let slope = self.law.losses.slope(s, self.law.rates.reduced().shape.rim.radius(angle), spin);
        let rate = self.law.stiffness(angle, slope);
        let within =
            settles_within(&self.law.losses.beside(()), (s, fall), rate, s * spin / self.tol)? * 0.01 * noise;
        let settled = self.settled(angle, drilling_of((s, c), w[0], w[2]), w2, self.settled_pull(y)).3;
        let close = s * settled.abs() <= SLOWER * fall
            && s * (spin - settled).abs() <= within + 1e-8 * s * settled.abs();
        close.then_some((Halt::Settles, *y))
    }

    #[inline(always)]
    fn passes_unseen<const N: usize>(&self, from: &[f64; N], y: &[f64; N]) -> Option<f64> {
        let turns = self.law.losses.has(Law::DryContour);
        pole::passes_unseen(from, y, turns).filter(|_| self.ball && self.moves)
    }

    fn slows<const N: usize>(&self, halt: Halt, place: &FlowPlace<N>) -> f64 {
        if halt == Halt::Rests { self.rolling_growth(place)[1].abs() } else { f64::INFINITY }
    }

    fn stuck<const N: usize>(&self, place: &FlowPlace<N>, _: &[Dual<f64>; MARGINS]) -> Option<Halt> {
        let [s, c, p, w2, w3] = core::array::from_fn(|i| place.y[i]);
        if self.ball || self.range[0] > 0.0 || s > CLOSE {
            return None;
        }
        if s < 1e-8 || (s < 1e-5 && !self.moves && c * w2 > 0.0) {
            return Some(Halt::Face);
        }
        // Roots of an almost vanishing psi' make the steps short here.
        let (precession, w) = self.turning([s, c, p, w2, w3]);
        let slow = s * (w3 - c * precession).abs() <= SLOWER * c * w2 + self.noise(w);
        let soft = self.law.losses.slope(s, 1.0, 1.0) > 0.0;
        (self.moves && slow && soft && !self.is_driven()).then_some(Halt::Settles)
    }

    /// Sets a drilling rate that friction holds to zero after a step, whose errors would let it begin on a patch of
    /// contact.
    fn kept<const N: usize>(&self, mut y: [f64; N]) -> [f64; N] {
        if self.moves && self.holds_drilling() {
            let drilling = y[P] + y[COS] * y[W3] - self.om;
            (y[P], y[W3]) = (y[P] - y[SIN] * y[SIN] * drilling, y[W3] - y[COS] * drilling);
        }
        y
    }

    fn shown<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        let mut shown = *y;
        let [s, c, q] = [y[SIN], y[COS], y[P]];
        let (_, [w1, _, w3]) = self.turning([s, c, q, y[W2], y[W3]]);
        (shown[W1], shown[W3]) = (w1, w3);
        if self.settled {
            let (.., spin) = self.settled((s, c), q, y[W2], self.settled_pull(y));
            (shown[W1], shown[W3]) = (s * (q - c * spin), c * q + s * s * spin);
        }
        shown
    }
}
