//! Motions on a slope or on a turntable. On a slope the units are those in which the component of gravity normal to
//! the table is 1.
//!
//! ```text
//! gravity (sin, 0, -cos) of the slope beta along x, y, z      x points downhill, z is the normal of the table
//! time sqrt(cos beta) t,   velocities over sqrt(cos beta),   forces and energies over cos beta
//! in these units: a level table with g = 1, and the pull tan(beta) on the centre along x
//! ```
//! In these units gravity has the component G = tan(beta) (cos phi, -sin phi) along the table, in the directions e_h
//! and e2. G adds to the acceleration of the slip, and acts on a body that rolls like the couple r x G about the
//! contact point. This module converts starts to these units, and motions back from them.
//!
//! ```text
//! a table that turns at the rate om about z carries the contact point P with U = om z x P
//! P' = p = u + (rho w2) e_h + (A psi') e2 + U,   pull += om (p_2, -p_h)
//! ```
//! The slip u is relative to the turning table. The components of U along e_h and e2 change with P and with these
//! axes.

use super::walk::two_runs::Followed;
use super::{AboveTable, Ask, Motion, Moving, Start};
use crate::error::{Error, room, within};
use crate::laws::body::Body;
use crate::laws::contact::Table;
use crate::laws::contact::slip::Friction;
use crate::laws::custom::{CoupleLaw, DRIVE_FINITE, DriveLaw, FrictionLaw, Moment, Push};
use crate::laws::loss::{Law, Losses};
use crate::laws::scale::Scale;
use crate::laws::state::{Slip, State};
use core::f64::consts::FRAC_PI_2;

/// The conversion between natural units and those of a slope, in which the component of gravity normal to the table
/// is 1.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slope {
    /// The units in which the component of gravity normal to the table is 1.
    scale: Scale,
}

/// Returns an error if the slope is out of range, or if a law in `ask` cannot be computed on a slope or a turntable.
pub(crate) fn check_slope(ask: &Ask) -> Result<(), Error> {
    let slope = ask.slope;
    let most = FRAC_PI_2.next_down();
    within("slope", slope, (-most, most), "between -pi/2 and pi/2, the ends excluded")?;
    let refuses = |what: &'static str| Err(Error::OutOfRange { name: "slope", value: slope, expected: what });
    let dry = [Law::DryContour, Law::Drilling].iter().all(|law| ask.losses.coefficient(*law) != 0.0);
    within("turning", ask.turning, (-1e6, 1e6), "-1e6 to 1e6 sqrt(g/R)")?;
    let drills = ask.losses.coefficient(Law::Drilling) != 0.0;
    let along = ask.losses.iter().any(|(law, _)| law.is_along_contour());
    let rolls = ask.losses.coefficient(Law::RollingResistance) != 0.0;
    let expected = match () {
        () if ask.table == Table::Smooth => "0 on a smooth table",
        () if along && (drills || ask.table.friction().patch() > 0.0) => {
            "0 with a law along the contour beside drilling friction or a patch of contact"
        }
        () if slope != 0.0 && drills && rolls => "0 with drilling friction and rolling resistance on a slope",
        () => "",
    };
    if ask.turning != 0.0 && !expected.is_empty() {
        return Err(Error::OutOfRange { name: "turning", value: ask.turning, expected });
    }
    match () {
        () if slope == 0.0 => Ok(()),
        () if dry => refuses("0 with dry friction along the contour and drilling friction together"),
        () => Ok(()),
    }
}

/// The difference of the energy from that on a level table at rest, in M g R: by the fall of the centre downhill and
/// by the velocity of a turntable. None if no pose is computed.
pub(crate) fn energy_beside(body: &Body, ask: &Ask, m: &Motion, i: usize) -> Option<f64> {
    let of = m.sample(i);
    let (centre, velocity, point) = (of.centre(body)?, of.velocity(body)?, of.pose?.contact_point);
    let [x, y] = [-(ask.turning * point.y), ask.turning * point.x];
    let carried = x * (velocity.x + 0.5 * x) + y * (velocity.y + 0.5 * y);
    Some(carried + energy_of_fall(ask, m, i, [centre.x, centre.z]))
}

/// The change of the energy by the slope, for a centre of mass at these x and z. On a smooth slope it includes the
/// speed that the centre has gained downhill.
pub(crate) fn energy_of_fall<S: Moving>(ask: &Ask, m: &Motion<S>, i: usize, [x, z]: [f64; 2]) -> f64 {
    let (sin, cos) = ask.slope.sin_cos();
    let begun = m.path.as_ref().and_then(|path| path.phases.first()).map_or(m.times[i], |phase| phase.time);
    let free = ask.table == Table::Smooth && ask.restitution.is_none();
    let falls = if free { sin * (m.times[i] - begun) } else { 0.0 };
    0.5 * falls * falls - (1.0 - cos) * z - sin * x
}

/// A user-defined law on a slope, whose arguments and results are converted to natural units, with the full gravity.
pub(crate) struct AtPace<'a, L: ?Sized> {
    pub law: &'a L,
    /// The square root of the component of gravity normal to the table, in g.
    pub pace: f64,
}

impl FrictionLaw for AtPace<'_, dyn FrictionLaw + '_> {
    fn coefficient(&self, speed: f64) -> f64 {
        self.law.coefficient(self.pace * speed)
    }
    fn has_failed(&self) -> bool {
        self.law.has_failed()
    }
}

impl CoupleLaw for AtPace<'_, dyn CoupleLaw + '_> {
    fn couple(&self, body: &Body, y: &State, normal: f64) -> [f64; 3] {
        let weight = self.pace * self.pace;
        self.law.couple(body, &y.at_pace(self.pace), weight * normal).map(|m| m / weight)
    }
    fn has_failed(&self) -> bool {
        self.law.has_failed()
    }
}

impl DriveLaw for AtPace<'_, dyn DriveLaw + '_> {
    fn push(&self, body: &Body, now: &Moment) -> Push {
        let (pace, weight) = (self.pace, self.pace * self.pace);
        let now = Moment {
            time: now.time / pace,
            state: now.state.at_pace(pace),
            slip: now.slip.map(|u| pace * u),
            velocity: pace * now.velocity,
            ..*now
        };
        let Push { force, couple } = self.law.push(body, &now);
        Push { force: force / weight, couple: couple / weight }
    }
    fn has_failed(&self) -> bool {
        self.law.has_failed()
    }
}

/// Converts the error for a wrong value of a user-defined law on a slope to natural units, with the full gravity.
pub(crate) fn fault_at_pace(fault: Error, pace: f64) -> Error {
    match fault {
        Error::Coefficient { mu, expected, speed } => {
            Error::Coefficient { mu, expected, speed: pace * speed }
        }
        Error::Couple { power, expected, theta, w, normal } => {
            let (w, weight) = (w.map(|w| pace * w), pace * pace);
            Error::Couple { power: pace * weight * power, expected, theta, w, normal: weight * normal }
        }
        Error::OutOfRange { name, value, expected: DRIVE_FINITE } => {
            Error::OutOfRange { name, value: value / pace, expected: DRIVE_FINITE }
        }
        fault => fault,
    }
}

/// Computes a motion on a slope in units in which the normal component of gravity is 1. `run` gets the start, the
/// times, the laws, and the unit of velocity.
pub(crate) fn on_slope<S: Moving>(
    ask: &Ask,
    start: &Start<S>,
    times: &[f64],
    run: impl FnOnce(&Start<S>, &[f64], &Ask, f64) -> Result<Followed<S>, Error>,
) -> Result<Followed<S>, Error> {
    let Some(slope) = Slope::of(ask)? else { return run(start, times, ask, 1.0) };
    let pace = slope.scale.metres_per_second(1.0);
    let since = slope.times(times, start.time)?;
    let found =
        run(&slope.start(start), &since, &slope.ask(ask), pace).map_err(|e| fault_at_pace(e, pace))?;
    Ok(slope.motion(found, start, times))
}

impl Slope {
    /// The conversion of units for the slope in `ask`; None on a level table.
    pub fn of(ask: &Ask) -> Result<Option<Self>, Error> {
        check_slope(ask)?;
        if ask.is_level() {
            return Ok(None);
        }
        Scale::new(1.0, 1.0, ask.slope.cos()).map(|scale| Some(Self { scale }))
    }

    /// The options `ask`, converted to the units in which gravity normal to the slope is 1.
    pub fn ask(&self, ask: &Ask) -> Ask {
        let mut losses = Losses::NONE;
        for (law, coefficient) in ask.losses.iter() {
            losses = losses.with(law, self.scale.coefficient(law, coefficient));
        }
        let table = match ask.table {
            Table::Rubs(Friction::Viscous { c }) => {
                Table::Rubs(Friction::Viscous { c: self.scale.metres_per_second(c) })
            }
            table => table,
        };
        Ask { table, losses, turning: self.scale.angular_velocity(ask.turning), ..*ask }
    }

    /// The times since `t0`, in the units in which gravity normal to the slope is 1.
    pub fn times(&self, times: &[f64], t0: f64) -> Result<Vec<f64>, Error> {
        let mut since = room(times.len())?;
        since.extend(times.iter().map(|t| self.scale.time(t - t0)));
        Ok(since)
    }

    /// The initial conditions at time 0, in the units in which gravity normal to the slope is 1.
    pub fn start<S: Moving>(&self, start: &Start<S>) -> Start<S> {
        let speed = |u: f64| self.scale.speed(u);
        Start {
            state: start.state.at_pace(speed(1.0)),
            slip: start.slip.map(speed),
            time: 0.0,
            aloft: start.aloft.map(|AboveTable { height, lift }| AboveTable::new(height, speed(lift))),
            ..*start
        }
    }

    /// Converts a motion from the units in which gravity normal to the slope is 1 to natural units, at these times.
    pub fn motion<S: Moving>(&self, found: Followed<S>, start: &Start<S>, times: &[f64]) -> Followed<S> {
        let Self { scale } = self;
        let Followed { mut motion, mut path } = found;
        let (pace, weight) = (scale.metres_per_second(1.0), scale.newtons(1.0));
        let later = |t: f64| start.time + scale.seconds(t);
        let faster = |u: Slip| u.map(|u| u * pace);
        motion.times = times[..motion.states.len()].to_vec();
        motion.states.iter_mut().for_each(|state| *state = state.at_pace(pace));
        motion.forces.iter_mut().flatten().for_each(|force| *force = S::force_at(force, weight));
        motion.event.iter_mut().for_each(|event| {
            (event.time, event.state) = (later(event.time), event.state.at_pace(pace));
        });
        motion.error *= (1.0 / pace).max(1.0);
        path.slip.iter_mut().for_each(|u| *u = faster(*u));
        path.dissipated.iter_mut().chain(&mut path.work_lost).for_each(|heat| *heat *= weight);
        for phase in &mut path.phases {
            phase.time = later(phase.time);
            phase.state = phase.state.at_pace(pace);
            (phase.slip, phase.aloft.lift) = (faster(phase.slip), phase.aloft.lift * pace);
        }
        (path.heat, path.lost) = (path.heat * weight, path.lost * weight);
        path.slipping = scale.seconds(path.slipping);
        path.aloft.iter_mut().for_each(|aloft| aloft.lift *= pace);
        for hit in &mut path.impacts {
            hit.time = later(hit.time);
            hit.states = hit.states.map(|state| state.at_pace(pace));
            hit.velocities = hit.velocities.map(|v| v.map(|v| v * pace));
            (hit.impulse, hit.lost) = (hit.impulse.map(|p| p * pace), hit.lost * weight);
            hit.couple *= pace;
        }
        for other in &mut path.other_rim {
            (other.slip, other.force) = (faster(other.slip), State::force_at(&other.force, weight));
        }
        path.last_slip = faster(path.last_slip);
        path.known_until = later(path.known_until);
        Followed { motion, path }
    }
}
