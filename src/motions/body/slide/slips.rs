//! The slipping phases of a body, and the phase that follows each of them.

use super::Slide;
use super::creeps::is_still;
use crate::error::Error;
use crate::laws::body::border_at;
use crate::laws::loss::Holds;
use crate::laws::loss::Law;
use crate::methods::flow::{Flow, FlowPlace, Steps};
use crate::motions::Ending;
use crate::motions::body::body_walk::BodyWalk;
use crate::motions::body::face::turning_share;
use crate::motions::body::own::Own;
use crate::motions::body::tail::{SlipStart, is_known};
use crate::motions::body::write::state;
use crate::motions::walk::numbers::{
    BodyNumbers, COS, HEAT, Halt, SIN, TIME, U2, UH, W1, W2, W3, loses, lost,
};
use crate::motions::walk::two_runs::CHANCE;
use crate::motions::walk::{Next, Pause, Phases, after_rest, ending};

/// A face only just lands if more than this share of its energy is in the rotation w1. It falls, rather than whirrs,
/// if the square of w2 exceeds sin(theta) by the factor `FALLS_FAST`.
const LANDS_BARELY: f64 = 1e-4;
const FALLS_FAST: f64 = 100.0;
/// Time in which a face rocks a few times before it lands, in units of w2 (1 + I1).
const ROCKINGS: f64 = 8.0;

/// Number of integration steps between two estimates of the end of a whirr with slip.
const STEPS_PER_LOOK: u64 = 64;

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    /// Integrates a slip from `place` on, within the limits `steps`, and chooses the next phase at its end.
    pub(crate) fn slides(
        &mut self,
        place: FlowPlace<N>,
        steps: Steps,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Pause<N>, Error> {
        let (slide, first) = (self.of.slide, self.made.motion.states.len());
        self.begins_lawfully(&slide, &place)?;
        // The flow of a whirr pauses regularly, so that its end can be extrapolated before its last
        // turns are computed.
        let most = if self.of.tail.is_some() { steps.most.min(STEPS_PER_LOOK) } else { steps.most };
        let steps = Steps { most, ..steps };
        let (ask, made) = (self.ask, &mut self.made);
        let mut write = |y: &[f64; N]| made.slid(&ask, &slide, y);
        let slid = slide.run(place, steps, &self.since[first..], &mut write, go_on);
        self.has_spent(slid.spent);
        self.of.lately[0] = slid.step;
        self.heeds_laws(&slide, &slid, || slide.enter(&slid.y))?;
        if slid.halt == Halt::Pause {
            if let Some(end) = self.whirr_ends(&slid.y) {
                self.arrives(slid.y);
                self.made.path.slipping += end[0] - self.began;
                self.made.path.leaves_turns = true;
                self.lies_flat(end);
                return Ok(Pause::No);
            }
            return Ok(Pause::Here(slide.enter(&slid.y), Some(slid.step)));
        }
        self.claims_time_error(slid.halt, slid.steep, &slid.y);
        self.slip_ends(slid.y, slid.halt);
        Ok(Pause::No)
    }

    /// Ends a slip at the state vector `y`, and chooses the next phase.
    pub(crate) fn slip_ends(&mut self, y: [f64; N], halt: Halt) {
        if self.of.slide.settled && loses(N) && !self.is_driven() {
            // A change of the sum of energy, heat and lost energy while the contact is settled is an error of the
            // numbers.
            let sum = |y: &[f64; N]| self.of.slide.energy(y) + y[HEAT] + y[N - 1];
            self.claims((sum(&y) - sum(&self.at)).abs());
        }
        self.arrives(y);
        if halt == Halt::Face {
            let [s, c, w1, w2] = core::array::from_fn(|i| self.at[i]);
            let turns = turning_share(self.of.body.i1(), s, w1, w2) >= 0.25;
            let end =
                self.of.tail.and_then(|tail| tail.end()).filter(|[end, _]| turns && *end >= self.at[TIME]);
            let fall = (c * w2).max(0.0);
            let [end, doubt] = end.unwrap_or([self.at[TIME] + if fall > 0.0 { s / fall } else { 0.0 }, 0.0]);
            self.claims(doubt + self.rocks_on());
            self.falls_the_rest(end - self.at[TIME], false);
            self.at[SIN] = 0.0;
        }
        self.made.path.slipping += self.at[TIME] - self.began;
        if !matches!(halt, Halt::Time | Halt::Pause | Halt::Pole) {
            let Holds { contour, drilling, rolling } = self.of.slide.holds();
            self.stops_exactly(Holds {
                contour: contour || halt == Halt::Contour,
                drilling: drilling || halt == Halt::Drilling,
                rolling: rolling || halt == Halt::Rests,
            });
        }
        let mut y = state(&self.at);
        if halt == Halt::Side {
            y.theta = border_at(self.of.body.carries(), y.theta);
        }
        self.of.state = y;
        let slip = self.at.slip();
        match halt {
            Halt::Time | Halt::Pause => {}
            Halt::Pole => {
                self.claims_passage();
                self.next = Some(Next::SlipsOn);
            }
            Halt::Standstill if !self.of.slide.died && self.of.slide.has_died(&self.at).is_some() => {
                self.resumes_phase();
                self.next = Some(Next::Slips);
            }
            Halt::Standstill => {
                self.of.slide.died = false;
                self.continues_with(after_rest(Phases::rests(self)));
            }
            Halt::Settles => {
                self.of.slide.settled = true;
                self.claims(<Slide>::settled_doubt(&y));
                self.next = Some(Next::SlipsOn);
            }
            Halt::Contour | Halt::Drilling | Halt::Rocking | Halt::Rests => {
                let known = self.of.slide.known(halt);
                if halt == Halt::Contour && self.of.slide.settled {
                    self.claims(self.of.slide.settled_lag(&y, slip));
                }
                if halt == Halt::Rocking {
                    (self.at[W2], self.of.state.w2) = (0.0, 0.0);
                }
                self.of.slide.sets_ways(&{ self.of.state }, slip, [0.0; 2], known);
                self.next = Some(Next::SlipsOn);
            }
            halt => self.next = Some(Next::Ends(ending(halt))),
        }
    }

    /// Includes the error of a passage of the vertical by a ball's axis in the estimated error. An output during the
    /// passage is interpolated linearly. The couple of dry friction along the rim turns with e_h, but is taken as
    /// constant: the error of w is twice its effect in this time, and more where the body slips faster than it turns.
    pub(crate) fn claims_passage(&mut self) {
        let speed = self.at[W1].hypot(self.at[W2]);
        let lasts = 2.0 * self.at[SIN] / speed;
        let contour = self.ask.losses.coefficient(Law::DryContour);
        if contour > 0.0 {
            let ([u_h, u_2], body) = (self.at.slip(), &self.of.body);
            let normal = 1.0 + body.ell().abs() * speed * speed;
            self.claims(2.0 * contour * normal * lasts / body.i1() * (1.0 + u_h.hypot(u_2) / speed));
        }
        let last = self.made.motion.states.len().checked_sub(1).map(|i| self.since[i]);
        if last.is_some_and(|t| t > self.at[TIME] - lasts) {
            self.claims(lasts);
        }
    }

    /// Ends the part of a uniform ball's slip that differs from steady creep: friction turns it into rolling, unless
    /// rolling resistance holds the ball.
    pub(crate) fn drops_slip(&mut self, [u_h, u_2]: [f64; 2]) {
        let [s, c] = [self.at[SIN], self.at[COS]];
        let held = !self.ask.losses.is_none() && is_still(&self.at);
        let share = if held { 0.0 } else { 1.0 / (1.0 + self.of.body.i3()) };
        for (i, turned) in [(W1, -(c * u_2)), (W2, u_h), (W3, s * u_2)] {
            self.at[i] += share * turned;
        }
        (self.at[UH], self.at[U2]) = (self.at[UH] - u_h, self.at[U2] - u_2);
        self.claims(u_h.hypot(u_2));
        self.inherits_errors();
        self.of.state = state(&self.at);
    }

    /// Adds the step errors since the last phase in closed form to the rounding errors of w, which in such phases
    /// turn the axis.
    pub(crate) fn inherits_errors(&mut self) {
        let of = &mut self.of.roundings;
        let erred = self.spent.erred - core::mem::replace(&mut of.inherited, self.spent.erred);
        of.count += CHANCE * erred * self.of.slide.tol / (f64::EPSILON * <Slide>::fastest(&self.at));
    }

    /// The error of the landing time of a falling face that only just lands. Where rolling resistance has left a
    /// rotation of the size of rounding errors, these decide whether the face lands or rocks on, a few times at most.
    pub(crate) fn rocks_on(&self) -> f64 {
        let ([s, _, w1, w2], i1) = (core::array::from_fn(|i| self.at[i]), self.of.body.i1());
        let barely = turning_share(i1, s, w1, w2) > LANDS_BARELY && w2 * w2 > FALLS_FAST * s;
        if barely && self.ask.losses.coefficient(Law::RollingResistance) > 0.0 {
            ROCKINGS * w2.abs() * (1.0 + i1)
        } else {
            0.0
        }
    }

    /// The time at which a whirr with slip ends, and its error; None if they are not yet known, or if an output is
    /// requested before.
    pub(crate) fn whirr_ends(&mut self, at: &[f64; N]) -> Option<[f64; 2]> {
        let until = self.until().unwrap_or(f64::INFINITY);
        let tail = self.of.tail.as_mut()?;
        tail.adds_point(at[TIME], at[SIN], at[W1]);
        tail.known(at[SIN], until)
    }

    /// Records the beginning of a slip from rest in a whirr, for the estimate of its end.
    pub(crate) fn nods(&mut self) {
        let (at, lost) = (&self.at, lost(&self.at));
        let root = (at[W1] * at[SIN]).abs().cbrt();
        if let Some(nods) = &mut self.of.nods {
            nods.adds(at[SIN], SlipStart { time: at[TIME], root, w3: at[W3], heat: at[HEAT], lost });
        }
    }

    /// Ends a whirr that slips in each nod, if the landing of its face is known and no output is requested before.
    /// The remaining energy becomes heat, or is lost, in the same shares as in the last nod. Returns whether the
    /// whirr has ended.
    #[inline(never)]
    pub(crate) fn nods_end(&mut self, given_up: bool) -> bool {
        let Some(end) = self.of.nods.as_ref().and_then(|nods| nods.end()) else { return false };
        let (until, now) = (self.until().unwrap_or(f64::INFINITY), self.at[TIME]);
        let erred = self.spent.erred * self.of.slide.tol;
        let accepted = is_known([end.time, end.doubt], until, erred)
            || given_up && end.is_better_than_none(now) && end.time + end.doubt < until;
        if accepted {
            let left = self.of.slide.energy(&self.at);
            self.at[..5].copy_from_slice(&[0.0, 1.0, 0.0, 0.0, 0.0]);
            self.stop_slip();
            let left = left - self.of.slide.energy(&self.at);
            self.at[HEAT] += end.heats * left;
            if loses(N) {
                self.at[N - 1] += (1.0 - end.heats) * left;
            }
            self.made.path.leaves_turns = true;
            self.lies_flat([end.time, end.doubt]);
        }
        accepted
    }

    /// Ends the motion at the time at which the face lands; `doubt` is the error of this time.
    pub(crate) fn lies_flat(&mut self, [time, doubt]: [f64; 2]) {
        self.claims(self.rocks_on());
        (self.at[SIN], self.at[TIME]) = (0.0, time);
        self.of.state = state(&self.at);
        self.claims(doubt);
        // What alternated at this time is over.
        self.still = 0;
        self.next = Some(Next::Ends(Ending::Face));
    }
}
