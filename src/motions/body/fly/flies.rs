//! A body in the air: the point at which it leaves the table, its flight and its landing.
//!
//! ```text
//! leaves the table    a slip as t^3 where N0 = 0 falls;  a contact at rest with N0 < 0 as t^2;  a bounce as t
//! ```
//! N0 is the normal force without friction, whose sign decides, since friction scales the normal force by a positive
//! factor. [`strike`](crate::motions::body::strike) has the impacts.

use super::air::{AirFlight, DRIVEN_NUMBERS, Launch};
use super::lands::TOUCH;
use crate::laws::body::{Body, Rim, View, border_at, tilt};
use crate::laws::contact::{Force, Table};
use crate::laws::newton;
use crate::laws::state::State;
use crate::methods::flow::Steps;
use crate::motions::ask::row::OutputRow;
use crate::motions::body::body_walk::{BodyPhases, BodyWalk};
use crate::motions::body::fly::{Aloft, Flies, Flight};
use crate::motions::body::own::Own;
use crate::motions::body::strike::RATTLED;
use crate::motions::walk::hops::{LONGER, ROUNDED, SHORT_BOUNCE, Takeoff};
use crate::motions::walk::numbers::{BodyNumbers, COS, HEAT, PHI, SIN, TIME, W2, loses, lost, poses};
use crate::motions::walk::{Next, Phases};
use crate::motions::{AboveTable, Ending, Kind};
use core::f64::consts::{FRAC_PI_2, PI, TAU};

/// A pose whose phi, psi and place are counted from the other rim; `over` if the given pose is that of the other rim.
/// Applied twice it returns the same pose.
pub(crate) fn pose_from(at: &Aloft, rims: &[Rim<f64>; 2], over: bool, pose: [f64; 4]) -> [f64; 4] {
    let mut other = Aloft { pose, ..*at }.on_other_rim(rims).pose;
    if over {
        other[0] -= TAU;
    }
    other
}

impl<G: Own, const N: usize> BodyWalk<'_, N, G> {
    pub(crate) fn has_two_rims(&self) -> bool {
        self.of.body.has_two_rims()
    }

    /// The sine of the angle between the body and the inclination at which both rims touch.
    pub(crate) fn tilt(&self, angle: (f64, f64)) -> f64 {
        tilt(self.of.body.border_angle(), angle)
    }

    /// Whether the body is at the largest inclination at which its circle of contact carries it.
    fn at_border(&self, angle: (f64, f64)) -> bool {
        self.of.body.theta_end() < PI && angle == self.of.body.border_angle()
    }

    /// Whether both rims touch the table, in a motion with restitution; both or one of them may carry the body.
    pub(crate) fn is_level(&self) -> bool {
        let State { theta, w2, .. } = self.of.state;
        self.ask.restitution.is_some()
            && self.has_two_rims()
            && theta == self.of.body.theta_end()
            && w2 == 0.0
    }

    /// The body at the current state, with its height and vertical velocity.
    pub(crate) fn aloft(&self) -> Aloft {
        let [s, c, w1, w2, w3, u, v] = core::array::from_fn(|i| self.at[i]);
        let pose = if poses(N) { core::array::from_fn(|i| self.at[9 + i]) } else { [0.0; 4] };
        let Takeoff { height, lift, .. } = self.hops.takeoff;
        Aloft { angle: (s, c), w: [w1, w2, w3], slip: [u, v], lift, height, pose, om: self.of.turning }
    }

    /// The state of the body `at`. In an impact of a uniform ball theta is not computed again, since its bounces cost
    /// little else.
    pub(crate) fn state_of(&self, at: &Aloft) -> State {
        let ([w1, w2, w3], here) = (at.w, self.at.angle());
        if self.of.uniform && at.angle == here { State { w1, w2, w3, ..self.of.state } } else { at.state() }
    }

    /// Sets the current state of the motion to this body.
    pub(crate) fn sets(&mut self, to: &Aloft) {
        let ((s, c), [mut w1, w2, mut w3], [u, mut v]) = (to.angle, to.w, to.slip);
        if self.of.planar {
            (w1, w3, v) = (0.0, 0.0, 0.0);
        }
        let theta = self.state_of(to).theta;
        self.at[..7].copy_from_slice(&[s, c, w1, w2, w3, u, v]);
        if poses(N) {
            self.at[PHI..PHI + 4].copy_from_slice(&to.pose);
        }
        let theta = match () {
            () if self.at_border(to.angle) => self.of.body.theta_end(),
            () if c == 0.0 => FRAC_PI_2,
            () => theta,
        };
        self.of.state = State { theta, w1, w2, w3 };
        (self.hops.takeoff.height, self.hops.takeoff.lift) = (to.height, to.lift);
    }

    /// Counts the state from the other rim, which lands at theta_end, from this moment on.
    pub(crate) fn turns_over(&mut self) {
        self.turns(self.of.body.rims(), self.of.body.beyond());
    }

    /// Counts the state from that end of the body from which theta is near the upper limit of the inclinations at
    /// which the circle of contact carries.
    pub(crate) fn looks_at_border(&mut self, theta: f64) {
        let [low, high] = self.of.body.carries();
        if border_at([low, high], theta) != high {
            if theta == low {
                (self.at[SIN], self.at[COS]) = low.sin_cos();
            }
            self.turns([self.of.body.shape().rim; 2], self.of.body.turned());
            if theta == low {
                (self.at[SIN], self.at[COS]) = self.of.body.border_angle();
                self.of.state.theta = self.of.body.theta_end();
            }
        }
    }

    /// Counts the state from the other end of the body, where another circle carries it.
    fn turns(&mut self, rims: [Rim<f64>; 2], body: Body) {
        let from = self.aloft();
        let pose = pose_from(&from, &rims, self.made.path.view.over, from.pose);
        let over = from.on_other_rim(&rims);
        let angle = if self.at_border(from.angle) { body.border_angle() } else { over.angle };
        let view = View { over: !self.made.path.view.over, ..body.view() };
        self.of.stands_on(body, &self.ask);
        self.made.path.view = view;
        self.of.own.sees(view.over);
        self.sets(&Aloft { pose, angle, ..over });
    }

    /// The first phase of a body that starts in the air: its flight, or its landing if it starts on the table and
    /// moves down.
    pub(crate) fn starts_in_air(&mut self, [height, lift]: [f64; 2]) -> Next {
        if self.has_two_rims() && self.of.state.theta == self.of.body.theta_end() {
            (self.at[SIN], self.at[COS]) = self.of.body.border_angle();
        } else if self.of.state.theta == FRAC_PI_2 {
            (self.at[SIN], self.at[COS]) = (1.0, 0.0);
        } else if self.of.state.theta == PI {
            (self.at[SIN], self.at[COS]) = (0.0, -1.0);
        }
        self.hops.takeoff = Takeoff { height, lift, leaves: (height == 0.0).then_some(1) };
        Next::Own(Kind::Flying)
    }

    /// The normal force without friction, N0, and the size of its terms.
    pub(crate) fn pressed(&self, from: &Aloft) -> [f64; 2] {
        if self.of.uniform {
            return [1.0; 2];
        }
        let law = &self.of.slide.law;
        let (shape, angle) = (&law.shape, from.angle);
        self.of.slide.asks_drive(&self.at);
        let at = self.of.slide.slips(angle, from.w, [0.0; 2], Some([0.0; 2])).0;
        let (lever, [w1, w2, w3]) = (shape.rim.lever(angle), from.w);
        let square = (shape.rim.slope(angle) * w2 * w2).abs();
        let turning = shape.i3 * w1 * w3 - shape.i1 * angle.1 / angle.0 * w1 * w1;
        let size = (shape.i1 * (1.0 + square) + (lever * turning).abs()) / (shape.i1 + lever * lever);
        [at.force[0], size]
    }

    /// The phase after an ending past which a motion with restitution continues.
    #[inline(never)]
    pub(crate) fn continues_after(&mut self, ending: Ending) -> Next {
        if ending == Ending::Side {
            self.looks_at_border(self.of.state.theta);
            if self.of.body.joins_next() {
                // The same point of the body goes on touching.
                (self.at[SIN], self.at[COS]) = self.of.body.border_angle();
                self.turns_over();
                return self.touches_down();
            }
        }
        let Some(e) = self.ask.restitution else { return Next::Ends(ending) };
        match ending {
            // On a table that turns, or on a patch, a face or two rims end the motion.
            Ending::Face | Ending::Side if self.has_one_contact() => Next::Ends(ending),
            Ending::Face if self.of.body.rim() > 0.0 => self.settles_on_face(),
            // Another part of a body, which may land first, has no known shape.
            Ending::LiftOff if self.of.body.lands_on_rims() => {
                let pressed = self.pressed(&self.aloft());
                self.lifts_off(pressed)
            }
            Ending::Side if self.has_two_rims() && self.of.state.theta == self.of.body.theta_end() => {
                (self.at[SIN], self.at[COS]) = self.of.body.border_angle();
                self.hops.takeoff = Takeoff::default();
                let down = -self.at[W2];
                if down == 0.0 {
                    return self.settles_on_side();
                }
                // An output at the initial time shows the body before it lands, as outputs at other landings do. Where a
                // table would have to pull at the rim that rises, there is no force.
                let from = self.aloft();
                let pulls = <BodyPhases<G> as Phases<N>>::normal_here(self) < 0.0;
                while self.until().is_some_and(|t| t <= self.at[TIME]) {
                    if pulls {
                        self.writes_with(&from, self.kind(), f64::NAN);
                    } else {
                        Phases::write_here(self);
                    }
                }
                if e == 0.0 || down * self.of.body.border().circles[0].lever <= RATTLED {
                    self.lands_on_both()
                } else {
                    self.rattles(e)
                }
            }
            Ending::Painleve if self.of.lying.is_none() && self.of.body.lands_on_rims() => {
                self.jams(e).unwrap_or(Next::Ends(ending))
            }
            ending => Next::Ends(ending),
        }
    }

    /// Computes a flight to its end, and sets the next phase.
    #[inline(never)]
    pub(crate) fn flies(&mut self, go_on: &mut dyn FnMut() -> bool) {
        if !poses(N) && self.of.uniform {
            return self.flies_uniformly();
        }
        let body = &self.of.body;
        let (from, now) = (self.aloft(), self.at[TIME]);
        let Takeoff { leaves, .. } = self.hops.takeoff;
        let mut course: Box<dyn Flies + '_> = match self.of.own.in_air(&self.ask.losses) {
            Some(losses) => {
                // The first step of a rougher run is longer, so that the two runs take different steps.
                let longer = if self.perturbation > 0.0 { LONGER } else { 1.0 };
                let (own, tol, tilt) = (self.of.own, self.of.slide.tol, self.of.tilt);
                let launch = Launch { body, from: &from, now, tol, longer, tilt };
                if G::IS && own.drives() {
                    Box::new(AirFlight::<G, DRIVEN_NUMBERS>::new(launch, losses, own))
                } else {
                    Box::new(AirFlight::<G>::new(launch, losses, own))
                }
            }
            None => Box::new(Flight::new(body, &from, self.of.tilt)),
        };
        let landings = course.free().landings;
        let leaves = core::array::from_fn(|k| {
            if k == 0 || k >= landings.count {
                return leaves.filter(|_| k == 0);
            }
            let rims = [body.shape().rim, landings.rims[landings.lowest(k, from.angle.1)]];
            let other = from.on_other_rim(&rims);
            (other.height.abs() <= 2.0 * TOUCH).then_some(if other.lift == 0.0 { 2 } else { 1 })
        });
        let left = self.since.last().map_or(0.0, |t| t - now);
        let limits = Steps {
            first: None,
            most: u64::MAX,
            patience: self.spent.patience,
            toil: self.toil(),
            tired: false,
        };
        let landing = course.lands(leaves, left, limits, go_on);
        if let Some(spent) = course.spent() {
            self.has_spent(spent);
        }
        let landing = match landing {
            Ok(landing) => landing,
            Err(why) => {
                self.next = Some(self.gives_up(why.into()));
                return;
            }
        };
        let before = lost(&self.at);
        let end = landing.map_or(f64::INFINITY, |(t, _)| t);
        while let Some(t) = self.until().filter(|t| *t <= now + end) {
            let at = self.flown(&*course, t - now, before);
            self.writes_with(&at, Kind::Flying, 0.0);
        }
        let Some((t, group)) = landing else { return };
        // The time of a landing is as uncertain as the height, over the normal velocity; that of a short bounce has the
        // roundings of a power series.
        let (at, free) = (self.flown(&*course, t, before), *course.free());
        let high = free.doubt_of_height(t);
        let landed = landings.lowest(group, at.angle.1);
        let (rims, upper) =
            ([self.of.body.shape().rim, landings.rims[landed]], landed != self.of.body.here_is());
        let lift = if upper { at.on_other_rim(&rims).lift } else { at.lift };
        let mut late = (high / lift.abs()).min(high.sqrt());
        if leaves[0] == Some(1) && !upper && free.turns(t) < SHORT_BOUNCE {
            late = late.min(free.roundings(t) * f64::EPSILON * t);
        }
        let (found, t) = (t, self.claims_landing(t, late));
        let at = if t == found { at } else { self.flown(&*course, t, before) };
        self.at[TIME] = now + t;
        self.sets(&Aloft { height: if upper { at.height } else { 0.0 }, ..at });
        if upper {
            self.turns(rims, self.of.body.turned_on(landed));
            if self.of.body.is_seen_from_afar() {
                self.turns([self.of.body.shape().rim; 2], self.of.body.turned());
            }
        }
        self.doubts(free.roundings(t) * f64::EPSILON);
        self.hops.takeoff.height = 0.0;
        let next = self.strikes();
        self.continues_with(next);
    }

    /// The body at a time of its flight. The energy lost to the air until then is added to the energy lost `before`.
    /// If a rim is below the table, the estimated error of the motion becomes at least its depth.
    fn flown(&mut self, course: &dyn Flies, t: f64, before: f64) -> Aloft {
        let (mut at, lost) = course.at(t);
        if loses(N) {
            self.at[N - 1] = before + lost;
        }
        self.claims(course.free().doubt(t, &at));
        let free = course.free();
        let lowest =
            (0..free.landings.count).map(|k| free.higher_by(k, at.angle)).fold(f64::INFINITY, f64::min);
        self.claims(-(at.height + lowest));
        if at.height < 0.0 && -at.height <= course.free().doubt_of_height(t) {
            at.height = 0.0;
        }
        at
    }

    /// Includes the error of the energy balance in the estimated error: the energy plus heat and all losses, minus
    /// their sum at the start, over the largest speed.
    pub(crate) fn compares_energy(&mut self) {
        if self.ask.restitution.is_none() || self.perturbation > 0.0 || self.is_driven() {
            return;
        }
        let (from, law) = (self.aloft(), &self.of.slide.law);
        let [v_h, v_2] = law.centre(from.angle, from.w, from.slip);
        let v_z = from.lift + law.shape.rim.lever(from.angle) * from.w[1];
        let mut has = newton::energy(&law.shape, from.angle, from.w, [v_h, v_2, v_z]) + from.height;
        has += self.of.slide.energy_on_table(&self.at);
        let fastest = [v_h, v_2, v_z].into_iter().chain(from.w).fold(1.0, |most: f64, x| most.max(x.abs()));
        self.compares_energy_with_start(has, fastest);
    }

    /// Writes a point to the outputs, with all force components set to `force`.
    pub(crate) fn writes_with(&mut self, at: &Aloft, kind: Kind, force: f64) {
        let force = self.ask.force.then_some((Force { normal: force, along: force, across: force }, 0.0));
        let pose = poses(N).then(|| at.pose());
        let row = OutputRow::on_table(at.state(), at.slip, [self.at[HEAT], lost(&self.at)], kind);
        self.made.push(OutputRow { pose, force, aloft: AboveTable::new(at.height, at.lift), ..row });
    }
}
