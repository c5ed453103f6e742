//! A motion that slips or loses energy, which is integrated up to a last time.
//!
//! The motion is integrated once, and its rows are kept; any other time is reached from the last row before it. The
//! pose of a motion that starts with a row is turned and moved to the pose of this row. With a restitution the motion
//! continues in the air and on both rims, and each row refers to the same rim as in the library. On a slope a motion
//! that starts with a row has the heading and the place of this row.

use crate::motion::{Kept, Row, Wish, times, told};
use crate::{Answer, Desk, Refusal};
use spincyl::contact::{Force, Table, slip};
use spincyl::motion::path::{self, Kind};
use spincyl::motion::{AboveTable, Ask, Method, Motion, Start};
use spincyl::pose::{Angle, Pose};
use spincyl::{Body, Contact};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The tolerance of a step of the integrator, which is enough for a page.
const TOL: f64 = 1e-11;
/// The computation of a motion stops after this many times 256 steps, which take too long for a page.
const LOOKS: u32 = 40;
/// No motion is started from a row in which the angle between face and table is smaller than this, in radians.
const FLAT: f64 = 1e-6;

/// The request for a motion that is integrated, and its rows and phases.
#[derive(Debug, Clone)]
pub(crate) struct Walked {
    body: Body,
    ask: Ask,
    start: Start,
    rows: Vec<Row>,
    phases: Vec<(f64, Kind)>,
    /// The last time, or the time at which the motion ends.
    until: f64,
}

impl Desk {
    /// Begins a motion that is integrated.
    pub(crate) fn walk(&mut self, wish: &Wish) -> Answer {
        let mut ask = Ask::on(wish.table);
        (ask.losses, ask.method, ask.pose, ask.force) = (self.losses, Method::Tolerance(TOL), true, true);
        let &Wish { body, start: (y, slip), t, n, .. } = wish;
        let [slope, heading] = self.slope;
        (ask.restitution, ask.slope) = (wish.restitution, slope);
        let start = Start::from(y).with_slip(slip).with_heading(if slope == 0.0 { 0.0 } else { heading });
        let motion = follow(&body, &start, &times(0.0, t, n.max(2)).collect::<Vec<_>>(), &ask)?;
        let Some(path) = &motion.path else { return Err(Refusal::Work) };
        let (code, time) = told(motion.event);
        let until = t.min(time);
        let none = f64::NAN;
        let (count, hits) = (path.phases.len() as f64, path.impacts.len() as f64);
        let knocked = path.impacts.iter().map(|hit| hit.lost).sum();
        self.out.extend([1.0, code, time, none, none, none, none, none, motion.error, motion.pose_error]);
        self.out.extend([motion.evaluations as f64, count, path.slipping, path.heat, path.lost, until]);
        self.out.extend([hits, knocked]);
        let phases = path.phases.iter().map(|phase| (phase.time, phase.kind)).collect();
        let mut walked = Walked { body, ask, start, rows: Vec::new(), phases, until };
        walked.rows = walked.read(&motion, None);
        self.motion = Some(Kept::Walked(Box::new(walked)));
        Ok(())
    }

    /// Writes the time and the kind of each phase of a motion that is integrated.
    pub fn phases(&mut self, []: [f64; 0]) -> Answer {
        if let Some(Kept::Walked(walked)) = &self.motion {
            self.out.extend(walked.phases.iter().flat_map(|(t, kind)| [*t, f64::from(*kind as u8)]));
        }
        Ok(())
    }
}

impl Walked {
    /// Whether the body has circles that are not equal.
    fn is_uneven(&self) -> bool {
        self.body.borders().iter().any(|border| border.theta != FRAC_PI_2)
    }

    /// Returns rows at equally spaced times, up to the end of the motion.
    pub fn at(&self, from: f64, to: f64, n: usize) -> Result<Vec<Row>, Refusal> {
        let wanted: Vec<f64> = times(from, to, n).take_while(|t| *t <= self.until).collect();
        let known = |t: &f64| {
            let i = self.rows.partition_point(|row| row.t < *t);
            self.rows.get(i).filter(|row| row.t == *t).copied()
        };
        if let Some(rows) = wanted.iter().map(known).collect() {
            return Ok(rows);
        }
        // Nor is one started where the body has just left the table, which two numbers do not tell.
        let sound = |row: &&Row| {
            let leaves = row.kind == Kind::Flying && row.pose.height == 0.0;
            // On two unequal circles a state does not tell to which of them the slip belongs.
            let leaves = leaves || self.is_uneven() && row.kind as u8 > Kind::Flying as u8;
            row.t <= from && row.y.theta.min(PI - row.y.theta) > FLAT && !leaves
        };
        if let Some(near) = self.rows.iter().rev().find(sound) {
            let since: Vec<f64> = wanted.iter().map(|t| t - near.t).collect();
            let aloft = (near.kind == Kind::Flying).then_some(AboveTable::new(near.pose.height, near.lift));
            let mut start = Start::from(near.y).with_slip(near.slip).with_aloft(aloft);
            if self.ask.slope != 0.0 {
                let at = near.pose.contact_point;
                start = start.with_heading(near.pose.phi.rest).with_place([at.x, at.y]);
            }
            // A motion can pass through a row from which no motion can be started.
            if let Ok(motion) = follow(&self.body, &start, &since, &self.ask) {
                return Ok(self.read(&motion, Some(near)));
            }
        }
        let motion = follow(&self.body, &self.start, &wanted, &self.ask)?;
        Ok(self.read(&motion, None))
    }

    /// The difference of the energy on a slope from that on a level table, in M g R.
    fn energy_of_fall(&self, body: &Body, row: &Row) -> f64 {
        let (sin, cos) = self.ask.slope.sin_cos();
        let centre = row.pose.centre(body, &row.y);
        // On ice the centre has also gained speed.
        let falls = if self.ask.table == Table::Smooth { sin * row.t } else { 0.0 };
        0.5 * falls * falls - (1.0 - cos) * centre.z - sin * centre.x
    }

    /// The pose after the pose of the row `from` has changed by `by` in the time `t`. If the body has `turned` over
    /// since then, psi of the row counts backwards.
    fn moved(&self, from: &Row, (t, by): (f64, &Pose), turned: bool) -> Pose {
        let Pose { phi, psi: Angle { turns, rest }, contact_point, .. } = from.pose;
        let psi = if turned { Angle { turns: -turns, rest: -rest } } else { from.pose.psi };
        let psi = added(psi, by.psi);
        if self.ask.slope != 0.0 {
            // It has begun with this phi, at this place. On ice the centre was already falling.
            let phi = Angle { turns: phi.turns + by.phi.turns, rest: by.phi.rest };
            let mut at = by.contact_point;
            if self.ask.table == Table::Smooth {
                at.x += self.ask.slope.sin() * from.t * t;
            }
            return Pose::new(phi, psi, at, by.height);
        }
        let (sin, cos) = phi.rest.sin_cos();
        let (mut at, to) = (contact_point, by.contact_point);
        at.x += to.x * cos - to.y * sin;
        at.y += to.x * sin + to.y * cos;
        Pose::new(added(phi, by.phi), psi, at, by.height)
    }

    /// The rows of an integrated path, which starts at the start of the motion or at the row `from`.
    fn read(&self, motion: &Motion, from: Option<&Row>) -> Vec<Row> {
        let poses = motion.poses.iter().flatten();
        let forces = motion.forces.iter().flatten();
        let Some(path) = &motion.path else { return Vec::new() };
        let row = |(i, (pose, force)): (usize, (&Pose, &Force))| {
            let (t, y, slip) = (motion.times[i], motion.states[i], path.slip[i]);
            let knocks = path.impacts.iter().take_while(|hit| hit.time < t).map(|hit| hit.lost);
            let lost = path.dissipated[i] + path.work_lost.get(i).unwrap_or(&0.0) + knocks.sum::<f64>();
            let AboveTable { height, lift, .. } = path.aloft.get(i).copied().unwrap_or_default();
            let rim = path.rims.get(i).copied().unwrap_or_default();
            let body = self.body.standing_on(rim);
            let energy = match self.ask.table {
                _ if self.ask.restitution.is_some() => {
                    let rise = slip::centre_rise(&body, &y);
                    slip::energy(&body, &y, slip) + height + lift * (0.5 * lift + rise)
                }
                Table::Rubs(_) => slip::energy(&body, &y, slip),
                Table::Smooth => Contact::Smooth.energy(&body, &y),
                _ => Contact::Rolling.energy(&body, &y),
            };
            let row =
                Row { t, y, pose: *pose, force: *force, slip, kind: path.kinds[i], energy, lost, lift, rim };
            let row = from.map_or(row, |from| {
                // Two equal rims are told from the rim at the start, more from the lower end of the body.
                let turned = !self.is_uneven() && rim == 1;
                let rim = if self.is_uneven() { rim } else { from.rim ^ rim };
                let pose = self.moved(from, (t, pose), turned);
                Row { t: from.t + t, pose, lost: from.lost + lost, rim, ..row }
            });
            Row { energy: row.energy + self.energy_of_fall(&body, &row), ..row }
        };
        poses.zip(forces).enumerate().map(row).collect()
    }
}

fn follow(body: &Body, start: &Start, times: &[f64], ask: &Ask) -> Result<Motion, Refusal> {
    let mut looks = 0;
    let mut go_on = || {
        looks += 1;
        looks <= LOOKS
    };
    let motion = path::follow(body, start, times, ask, &mut go_on)?;
    if motion.is_interrupted() { Err(Refusal::Work) } else { Ok(motion) }
}

/// The sum of two angles.
fn added(a: Angle, b: Angle) -> Angle {
    let (sum, whole) = (a.rest + b.rest, a.turns + b.turns);
    let turns = (sum / TAU).round();
    Angle { turns: whole + turns, rest: sum - turns * TAU }
}
