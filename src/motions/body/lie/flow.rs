//! The equations of a body that lies on both rims: its rates, the conditions that end a phase, and the ends of its
//! slips.
//!
//! ```text
//! y = (1, 0, w1, 0, w3, u_h, u_2, t, heat; phi, psi, x, y; lost)
//! both slip   dt = k/(k + soft) dsigma,   k = |u||u'|/(|u| + |u'|)        smooth up to u = 0 or u' = 0
//! margins     N', N,  (mu_s N)^2 - F^2,  |w1| of a pivot,  |w1| or its hold,  |w3| or its hold
//! rolls on a slope   the least of c^2, c'^2 and (c + c')^2 - F_h^2 in place of the third
//! ```
//! [`contact::lying`](crate::laws::contact) has the equations. Error: the tolerance of the steps.

use crate::laws::contact::grip;
use crate::laws::contact::lying::{Flat, Lain, Lying};
use crate::laws::contact::together::Resting;
use crate::laws::loss::{GRACE, SLACK, Ways};
use crate::laws::state::{drilling_of, rolling_of, spin_of};
use crate::methods::flow::{Flow, FlowPlace};
use crate::methods::rk8;
use crate::motions::Kind;
use crate::motions::body::own::{Own, differences};
use crate::motions::body::slide::longest;
use crate::motions::dry::held::margin_of_way;
use crate::motions::walk::MOMENT;
use crate::motions::walk::numbers::{
    BodyNumbers, Halt, MARGINS, PHI, TIME, U2, UH, W1, W3, loses, pose_rates, poses, pull,
};
use crate::numbers::{Dual, Real};

/// The motion of the rims of a lying body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Stance {
    /// Both rims slip.
    Slips,
    /// One rim sticks: that from which the state is counted, or the `other` one.
    Pivots { other: bool },
    /// Both rims stick.
    Rolls,
}

impl Stance {
    /// The kind of phase with this motion of the rims; `even` if both circles have the same radius.
    fn kind(self, even: bool) -> Kind {
        match self {
            Self::Slips => Kind::Lying,
            Self::Pivots { .. } => Kind::Pivoting,
            Self::Rolls if even => Kind::RollingOnItsSide,
            Self::Rolls => Kind::RollingRoundItsApex,
        }
    }
}

const LYING_ENDS: [Halt; MARGINS] =
    [Halt::Rises, Halt::Changes, Halt::Slips, Halt::Turned, Halt::Drilling, Halt::Contour];

/// The longest step in units of the time in which the slips of both rims turn to their common direction. The
/// estimated error of an explicit step over 5.65 such times is 0, but the true error is not.
const TURNS_WITHIN: f64 = 5.0;

/// A phase of a body that lies on both rims.
#[derive(Clone, Copy)]
pub(crate) struct LyingPhase<G = ()> {
    pub flow: LyingFlow<G>,
}

/// The equations of a body that lies on both rims, and which rotations dry friction holds at rest.
#[derive(Clone, Copy)]
pub(crate) struct LyingFlow<G = ()> {
    pub law: Lying<f64>,
    own: G,
    sloped: Lying<Dual<f64>>,
    pub stance: Stance,
    /// The sign of w1 while the body pivots about one rim.
    pub turn: f64,
    /// The largest couples with which dry losses hold w_z and w_h at rest, with the whole weight on this rim, and on
    /// the other rim.
    limits: [[f64; 2]; 2],
    /// The coefficient of static friction.
    pub fixed: f64,
    /// The speed below which a slip counts as zero.
    over: f64,
    soft: f64,
    pub tol: f64,
    /// The tangent of the slope.
    tilt: f64,
}

/// Returns w1, w3, u_h and u_2 of a state vector.
pub(super) fn flat<T: Copy>(y: &[T]) -> Flat<T> {
    [y[W1], y[W3], y[UH], y[U2]]
}

impl<G: Own> LyingFlow<G> {
    pub fn kind(&self) -> Kind {
        self.stance.kind(self.law.border.even)
    }

    pub fn new(law: Lying<f64>, own: G, fixed: f64, (over, tol): (f64, f64)) -> Self {
        let soft = if law.dry { 0.25 * law.strength[0] * law.yields(0, 0) } else { 0.0 };
        Self {
            law,
            own,
            sloped: law.map(Dual::constant),
            stance: Stance::Slips,
            turn: 0.0,
            limits: [law.limits([1.0, 0.0]), law.limits([0.0, 1.0])],
            fixed,
            over,
            soft,
            tol,
            tilt: 0.0,
        }
    }

    /// These equations on a slope with the tangent `tilt`, at the state vector `y`.
    pub fn on_slope<const N: usize>(mut self, tilt: f64, y: &[f64; N]) -> Self {
        self.tilt = tilt;
        self.stands_at(y);
        self
    }

    /// Sets the component of gravity along a slope to that at the state vector `y`, for computations that do not have
    /// phi.
    pub fn stands_at<const N: usize>(&mut self, y: &[f64; N]) {
        if self.tilt != 0.0 {
            self.law.pull = Some(pull(self.tilt, y));
        }
    }

    /// The signs of w1 and w3, which dry losses resist, and which of them they hold.
    pub fn ways(&self) -> Ways {
        self.law.losses.as_ref().and_then(|losses| losses.ways).unwrap_or_default()
    }

    /// Sets the signs of w1 and w3 that dry losses resist, and which of them they hold.
    #[inline(never)]
    pub fn turn_to(&mut self, ways: Ways) {
        if let Some(losses) = &mut self.law.losses {
            losses.ways = Some(ways);
            self.sloped.losses = Some(losses.map(Dual::constant));
        }
    }

    /// Whether dry losses resist w_z, and whether they resist w_h.
    fn resists(&self) -> [bool; 2] {
        [0, 1].map(|i| self.limits[0][i].max(self.limits[1][i]) > 0.0)
    }

    /// The largest couples with which dry losses hold w_z and w_h at rest under these contact forces.
    fn limits_under<T: Real>(&self, force: &[[T; 3]; 2]) -> [T; 2] {
        let ([[n, ..], [m, ..]], [here, there]) = (force, self.limits);
        let one = n.splat(1.0);
        [0, 1].map(|i| {
            if here[i] == there[i] {
                one.splat(here[i])
            } else {
                *n * one.splat(here[i]) + *m * one.splat(there[i])
            }
        })
    }

    /// Sets the signs of the rotations at the state vector `y`, and holds those that are at rest and that dry losses
    /// resist.
    pub fn holds_all<const N: usize>(&mut self, y: &[f64; N]) {
        let [resists, resists_rolling] = self.resists();
        let [drilling, rolling] = self.law.turning(y[W1], y[W3]);
        let mut ways = Ways::of(rolling, drilling);
        if drilling == 0.0 && resists && self.stance != Stance::Rolls {
            ways = ways.holding(Resting::Drilling);
        }
        if rolling == 0.0 && resists_rolling {
            ways = ways.holding(Resting::Contour);
        }
        self.turn_to(ways);
    }

    /// Lets those rotations begin that dry losses cannot hold at rest if a rim slips off along `way`. Returns whether
    /// there are any.
    pub fn lets_begin<const N: usize>(&mut self, y: &[f64; N], way: [f64; 2]) -> bool {
        let (held, mut ways) = (self.ways().holds, self.ways());
        for part in [Resting::Contour, Resting::Drilling].into_iter().filter(|part| held.has(*part)) {
            ways = ways.stopping(part, self.needs(part, y, way));
        }
        self.turn_to(ways);
        ways.holds != held
    }

    /// Lets a body at rest roll if its dry losses cannot hold it. Returns whether they held it before, but cannot
    /// under these forces.
    pub fn lets_roll(&mut self, lain: &Lain<f64>) -> bool {
        let ways = self.ways();
        if !ways.holds.has(Resting::Contour) {
            return false;
        }
        let limit = self.limits_under(&lain.force)[1];
        self.turn_to(ways.stopping(Resting::Contour, [-lain.couple[1], limit]));
        self.ways().holds != ways.holds
    }

    /// These equations with another motion of the rims.
    pub fn in_stance<const N: usize>(mut self, stance: Stance, y: &[f64; N]) -> Self {
        (self.stance, self.turn) = (stance, self.law.turning(y[W1], y[W3])[0].signum());
        self.sets_ways(y);
        self
    }

    /// Sets the signs of the rotations at the state vector `y`, and which of them dry losses hold at rest.
    pub fn sets_ways<const N: usize>(&mut self, y: &[f64; N]) {
        self.holds_all(y);
        self.lets_begin(y, [0.0; 2]);
    }

    /// Lets a rotation begin that a dry loss has held at rest.
    pub fn lets_go_of<const N: usize>(&mut self, part: Resting, y: &[f64; N]) {
        self.turn_to(self.ways().beginning(part, self.needs(part, y, [0.0; 2])[0]));
    }

    /// The couple that holds drilling or rolling at rest, and its limit.
    fn needs<const N: usize>(&self, part: Resting, y: &[f64; N], way: [f64; 2]) -> [f64; 2] {
        let Lain { couple: [m1, m3], force, .. } = self.lain_along(y, way);
        let [drilling, rolling] = self.limits_under(&force);
        if part == Resting::Contour { [-m3, rolling] } else { [m1, drilling] }
    }

    fn lain_of<T: Real>(&self, law: &Lying<T>, y: Flat<T>) -> Lain<T> {
        match self.stance {
            Stance::Slips => law.slipping(y),
            Stance::Pivots { other } => law.pivots(y, other, self.turn),
            Stance::Rolls => law.rolls(y),
        }
    }

    /// The law at these velocities, with the component of gravity along the slope that `stands_at` has set.
    pub fn law_at(&self, y: Flat<f64>) -> Lying<f64> {
        self.own.lying(&self.law, y)
    }

    /// The law at the state vector `y`.
    pub fn law_here<const N: usize>(&self, y: &[f64; N]) -> Lying<f64> {
        let law = self.law_at(flat(y));
        if self.tilt == 0.0 { law } else { Lying { pull: Some(pull(self.tilt, y)), ..law } }
    }

    /// Contact forces and accelerations at the state vector `y`.
    pub fn lain<const N: usize>(&self, y: &[f64; N]) -> Lain<f64> {
        if G::IS || self.tilt != 0.0 {
            self.lain_of(&self.law_here(y), flat(y))
        } else {
            self.lain_of(&self.law, flat(y))
        }
    }

    /// Contact forces and accelerations at the state vector `y`; if the rim from which the state is counted slips
    /// from rest, it slips along `way`.
    pub fn lain_along<const N: usize>(&self, y: &[f64; N], way: [f64; 2]) -> Lain<f64> {
        if self.stance != Stance::Slips || !self.law.dry || y.slip() != [0.0; 2] {
            return self.lain(y);
        }
        let (law, y) = (&self.law_here(y), flat(y));
        let [low, up] = law.strength;
        law.slipping_along(y, [way.map(|x| low * x), law.drag(up, law.other_slip(y))])
    }

    /// The largest force along e_h that static friction can hold at each rim, given the normal forces and those
    /// across.
    pub fn holds_along(&self, force: &[[f64; 3]; 2]) -> [f64; 2] {
        force.map(|[n, across, _]| ((self.fixed * n).powi(2) - across * across).max(0.0).sqrt())
    }

    /// The largest force along e_h that static friction can hold at both rims together, given the normal forces and
    /// those across.
    pub fn holds_together(&self, force: &[[f64; 3]; 2]) -> f64 {
        self.holds_along(force).iter().sum::<f64>() * (1.0 + GRACE)
    }

    /// Whether static friction holds both rims of a body that rolls straight on a slope.
    pub fn holds_both<const N: usize>(&self, y: &[f64; N]) -> bool {
        let (law, force) = (self.law_here(y), self.lain(y).force);
        let grips = |[n, across, _]: [f64; 3]| n >= 0.0 && across.abs() <= self.fixed * n * (1.0 + GRACE);
        force.into_iter().all(grips) && law.pulls_to_apex(flat(y)).abs() <= self.holds_together(&force)
    }

    /// The speeds of the slips of both rims.
    fn speeds<const N: usize>(&self, y: &[f64; N]) -> [f64; 2] {
        let [u, v] = self.law.other_slip(flat(y));
        [y[UH].hypot(y[U2]), u.hypot(v)]
    }

    fn margins_of<T: Real>(&self, law: &Lying<T>, y: Flat<T>) -> [T; MARGINS] {
        let at = self.lain_of(law, y);
        let one = y[0].splat(1.0);
        let [here, there] = at.force;
        let (held, Ways { contour, drilling, .. }) = (law.held(), self.ways());
        let angle = law.border.angle;
        let [w1, w3, ..] = y;
        let turning = [drilling_of(angle, w1, w3), -rolling_of(angle, w1, w3)];
        let (limits, resist) = (self.limits_under(&at.force), self.resists());
        let hold = |i: usize| {
            let (needs, way) = ([at.couple[i], limits[i]], one.splat([drilling, contour][i]));
            let resists = resist[i];
            margin_of_way((held[i], needs), (resists, way), turning[i], one.splat(SLACK))
        };
        let fixed = one.splat(self.fixed);
        let grips = |[n, across, along]: [T; 3]| {
            if self.fixed.is_finite() { grip(fixed, n, across * across + along * along) } else { one }
        };
        match self.stance {
            Stance::Slips => [there[0], here[0], one, one, hold(0), hold(1)],
            Stance::Pivots { other } => {
                let turning = one.splat(self.turn) * turning[0];
                [there[0], here[0], grips(if other { there } else { here }), turning, one, hold(1)]
            }
            Stance::Rolls => {
                if law.pull.is_some() {
                    return [there[0], here[0], self.grips_both(law, y, &at), one, one, hold(1)];
                }
                // Only a couple of the user presses the rims differently.
                let grips = if G::IS { grips(here).min(grips(there)) } else { grips(here) };
                [one, one, grips, one, one, hold(1)]
            }
        }
    }

    /// How far friction is from its limit where it holds both rims on a slope: the least for each rim across and for
    /// both along e_h.
    fn grips_both<T: Real>(&self, law: &Lying<T>, y: Flat<T>, at: &Lain<T>) -> T {
        let along = law.pulls_to_apex(y);
        let (fixed, zero) = (along.splat(self.fixed), along.splat(0.0));
        let [a, b] = at.force.map(|[n, across, _]| grip(fixed, n, across * across));
        let (product, least) = (a * b, a.min(b));
        if !(zero.is_lt(product) && zero.is_lt(a)) {
            return least;
        }
        least.min(a + b + product.sqrt() + product.sqrt() - along * along)
    }

    fn all_margins<const N: usize>(&self, y: &[f64; N]) -> [f64; MARGINS] {
        self.margins_of(&self.law_here(y), flat(y))
    }

    /// The largest speed in the state vector, at least 1.
    fn swiftest<const N: usize>(&self, y: &[f64; N]) -> f64 {
        let [here, there] = self.speeds(y);
        here.max(there).max(y[W1].abs()).max(y[W3].abs()).max(1.0)
    }

    /// The rate at which dry friction turns the slips of both rims to their common direction: the larger rate of the two
    /// decays of w1 and of the slip across the axis.
    fn aligns<const N: usize>(&self, y: &[f64; N]) -> f64 {
        if self.stance != Stance::Slips || !self.law.dry {
            return 0.0;
        }
        let [own, far, mixed] = [(0, 0), (1, 1), (0, 1)].map(|(at, by)| self.law.yields(at, by));
        let ([here, there], [a, b]) = (self.lain(y).force, self.speeds(y));
        let (mut low, mut up, mut strength) = (here[0] / a, there[0] / b, self.law.strength[0]);
        if G::IS {
            let [here, there] = self.law_here(y).strength;
            (low, up, strength) = (here * low, there * up, 1.0);
        }
        let (sum, product) = (low * own + up * far, low * up * (own * far - mixed * mixed));
        0.5 * strength * (sum + (sum * sum - 4.0 * product).max(0.0).sqrt())
    }

    /// The state vector at the time `MOMENT` after the rim from which the state is counted begins to slip along
    /// `way`.
    pub fn nudged<const N: usize>(&self, start: &[f64; N], way: [f64; 2], growth: f64) -> [f64; N] {
        let mut y = *start;
        (y[UH], y[U2]) = (MOMENT * growth * way[0], MOMENT * growth * way[1]);
        let at = self.law_here(&y).slipping(flat(&y));
        (y[W1], y[W3]) = (y[W1] + MOMENT * at.w[0], y[W3] + MOMENT * at.w[1]);
        y[TIME] += MOMENT;
        y
    }
}

impl<G: Own> Flow<MARGINS> for LyingFlow<G> {
    type Halt = Halt;
    const TIME: usize = TIME;
    const OVER: Halt = Halt::Time;
    const PAUSE: Halt = Halt::Pause;
    const ENDLESS: Halt = Halt::Endless;
    /// Number of steps between two calls of `go_on`; 1 with user-defined laws, each call of which may be slow.
    const BREATH: u64 = if G::IS { 1 } else { 256 };
    const CALLS: bool = true;

    fn is_extrapolated(halt: Halt) -> bool {
        matches!(halt, Halt::Standstill | Halt::OtherStandstill)
    }

    fn theta<const N: usize>(&self, _: &[f64; N]) -> f64 {
        let (s, c) = self.law.border.angle;
        s.atan2(c)
    }

    fn write_rates<const N: usize>(&self, y: &[f64; N], all: &mut [f64; N]) {
        let at = self.lain(y);
        let [w1, w3, u_h, u_2] = flat(y);
        let mut pace = 1.0;
        if self.stance == Stance::Slips && self.law.dry {
            let [a, b] = self.speeds(y);
            let k = a * b / (a + b);
            pace = k / (k + self.soft);
        }
        let [[_, low_2, low_h], [_, up_2, up_h]] = at.force;
        let [other_h, other_2] = self.law.other_slip(flat(y));
        let heat = -(low_2 * u_2 + low_h * u_h + up_2 * other_2 + up_h * other_h);
        all[..9].copy_from_slice(&[0.0, 0.0, at.w[0], 0.0, at.w[1], at.u[0], at.u[1], 1.0, heat]);
        if poses(N) {
            let ((s, c), [here, _]) = (self.law.border.angle, self.law.border.circles);
            let (turns, spin) = (w1 / s, spin_of((s, c), w1, w3));
            let over = [u_h, u_2 + here.radius * spin];
            all[PHI..PHI + 4].copy_from_slice(&pose_rates(y[PHI].sin_cos(), [turns, spin], over));
        }
        if loses(N) {
            let angle = self.law.border.angle;
            all[N - 1] = at.couple[1] * rolling_of(angle, w1, w3) - at.couple[0] * drilling_of(angle, w1, w3);
        }
        all.iter_mut().for_each(|x| *x *= pace);
    }

    fn margins<const N: usize>(&self, place: &FlowPlace<N>) -> [Dual<f64>; MARGINS] {
        if G::IS {
            return differences(place, self.calm(&place.y), |y| self.all_margins(y));
        }
        let y: [Dual<f64>; 7] = core::array::from_fn(|i| Dual { value: place.y[i], slope: place.rate[i] });
        if self.tilt == 0.0 {
            return self.margins_of(&self.sloped, flat(&y));
        }
        let ([pull_h, pull_2], turns) = (pull(self.tilt, &place.y), place.rate[PHI]);
        let pull = [(pull_h, pull_2 * turns), (pull_2, -(pull_h * turns))];
        let pull = pull.map(|(value, slope)| Dual { value, slope });
        self.margins_of(&Lying { pull: Some(pull), ..self.sloped }, flat(&y))
    }

    fn margin<const N: usize>(&self, y: &[f64; N], i: usize) -> f64 {
        if G::IS || self.tilt != 0.0 {
            self.all_margins(y)[i]
        } else {
            self.margins_of(&self.law, flat(y))[i]
        }
    }

    fn end(&self, i: usize) -> Halt {
        LYING_ENDS[i]
    }

    /// The error of a step over the allowed error. That of a slip under dry friction is relative to its speed, so
    /// that a vanishing slip keeps its direction.
    fn error<const N: usize>(&self, y: &[f64; N], made: &rk8::Step<f64, N>) -> f64 {
        let (per_tol, per_speed) = (1.0 / self.tol, 1.0 / (self.tol * self.swiftest(y)));
        let [here, there] = self.speeds(y);
        let slips = self.stance == Stance::Slips && self.law.dry;
        let per_slip = if slips { per_speed.max(1e3 / here.min(there)) } else { per_speed };
        // The other rim slips by as much as w_z times the distance of both.
        let ((s, c), turns) = (self.law.border.angle, 1e3 * self.law.border.span() / there);
        let per_turn = |share: f64| if slips { per_speed.max(turns * share.abs()) } else { per_speed };
        let per = |i: usize| match i {
            0 | 1 | 7 => per_tol,
            2 => per_turn(s),
            4 => per_turn(c),
            5 | 6 => per_slip,
            _ => per_speed,
        };
        made.error(per, N as f64) * made.strictness(self.tol, TIME, TIME)
    }

    fn fastest<const N: usize>(&self, y: &[f64; N]) -> f64 {
        self.swiftest(y)
    }

    fn first<const N: usize>(&self, y: &[f64; N]) -> f64 {
        0.02 / self.swiftest(y)
    }

    fn calm<const N: usize>(&self, y: &[f64; N]) -> f64 {
        longest(y, &self.law.shape)
    }

    fn longest<const N: usize>(&self, place: &FlowPlace<N>) -> f64 {
        let most = self.calm(&place.y) / place.rate[TIME].min(1.0);
        let most = most.min(TURNS_WITHIN / (self.aligns(&place.y) * place.rate[TIME]));
        let Some(losses) = &self.sloped.losses else { return most };
        let dual = |i: usize| Dual { value: place.y[i], slope: place.rate[i] };
        let (one, zero) = (dual(2).splat(1.0), dual(2).splat(0.0));
        let w = [dual(2), zero, dual(4)];
        most.min(losses.longest(&losses.seen(&self.sloped.shape.rim, (one, zero), w[0], w), true))
    }

    /// The halt of a slip that has almost vanished, extrapolated linearly to zero; None for a faster slip.
    fn stopped<const N: usize>(&self, place: &FlowPlace<N>) -> Option<(Halt, [f64; N])> {
        if G::IS {
            let [w1, w3, ..] = flat(&place.y);
            if self.own.finds_fault(&self.speeds(&place.y), Some(([1.0, 0.0, w1, 0.0, w3], 1.0))) {
                return Some((Halt::Endless, place.y));
            }
        }
        if self.stance != Stance::Slips || !self.law.dry {
            return None;
        }
        let slips = [place.y.slip(), self.law.other_slip(flat(&place.y))];
        let rates = [place.rate.slip(), self.law.other_slip(flat(&place.rate))];
        let (mut halt, mut y) = (None, place.y);
        for (i, ([u, v], [du, dv])) in slips.into_iter().zip(rates).enumerate() {
            let speed = u.hypot(v);
            let slowing = -(u * du + v * dv) / speed;
            if speed > self.over || speed > 0.0 && slowing <= 0.0 || halt.is_some() {
                continue;
            }
            let left = if speed > 0.0 { speed / slowing } else { 0.0 };
            y = core::array::from_fn(|i| place.y[i] + left * place.rate[i]);
            [y[UH], y[U2]] = self.law.stuck(flat(&y), i == 1);
            halt = Some(if i == 0 { Halt::Standstill } else { Halt::OtherStandstill });
        }
        halt.map(|halt| (halt, y))
    }

    fn stuck<const N: usize>(&self, _: &FlowPlace<N>, _: &[Dual<f64>; MARGINS]) -> Option<Halt> {
        None
    }

    fn shown<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        *y
    }
}
