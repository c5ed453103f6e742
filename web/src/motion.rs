//! The calls for a motion: the first integrals solve it if no energy is lost and nothing slips; otherwise `walk`
//! integrates it.

#[cfg(feature = "friction")]
use crate::walk::Walked;
use crate::{Answer, Desk, Refusal, count};
use spincyl::contact::{Force, Friction, Table, TableKind, force};
use spincyl::exact::Swing;
use spincyl::loss::{Law, Losses};
use spincyl::motion::path::Kind;
use spincyl::motion::{self, Event};
use spincyl::pose::Pose;
use spincyl::{Body, Contact, Slip, State};

/// The largest number of output rows, more than a page shows.
pub(crate) const MOST: usize = 20_000;
/// The number of times at which the error of an exact motion is evaluated.
const ERRORS: u32 = 16;

/// The outputs of a motion at one time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    pub t: f64,
    pub y: State,
    pub pose: Pose,
    pub force: Force,
    pub slip: Slip,
    pub kind: Kind,
    pub energy: f64,
    pub lost: f64,
    /// The vertical velocity of the lowest point of the rim.
    #[cfg_attr(not(feature = "friction"), allow(dead_code))]
    pub lift: f64,
    /// The circle that carries the body: for two equal rims 1 if it was the upper one at the start, for several
    /// circles its number.
    pub rim: u8,
}

/// The current motion, with what is needed to compute its rows.
#[derive(Debug, Clone)]
pub(crate) enum Kept {
    Exact {
        swing: Box<Swing>,
        body: Box<Body>,
        contact: Contact,
        until: f64,
    },
    #[cfg(feature = "friction")]
    Walked(Box<Walked>),
}

/// The request for a motion: the body, its start with its slip, the table, the last time, and the number of rows.
#[cfg_attr(not(feature = "friction"), allow(dead_code))]
pub(crate) struct Wish {
    pub body: Body,
    pub start: (State, Slip),
    pub table: Table,
    pub t: f64,
    pub n: usize,
    pub restitution: Option<f64>,
}

/// Equally spaced times, with both ends among them.
pub(crate) fn times(from: f64, to: f64, n: usize) -> impl Iterator<Item = f64> {
    let last = (n - 1).max(1) as f64;
    (0..n).map(move |i| if i + 1 == n && n > 1 { to } else { from + (to - from) * (i as f64 / last) })
}

/// The code and the time of the event that ends a motion; code 0 and infinite time without an event.
pub(crate) fn told(event: Option<Event>) -> (f64, f64) {
    event.map_or((0.0, f64::INFINITY), |e| (f64::from(e.ending as u8), e.time))
}

impl Desk {
    /// Sets the loss law by its number, with its coefficient; a coefficient of 0 stands for no loss.
    pub fn losses(&mut self, [law, coefficient]: [f64; 2]) -> Answer {
        let expected = "the number of a loss law";
        let known = Law::ALL.iter().copied().find(|known| f64::from(*known as u8) == law);
        let known = known.ok_or(Refusal::Range { name: "law", value: law, expected })?;
        let losses = Losses::of(known, coefficient);
        losses.check()?;
        (self.losses, self.motion) = (losses, None);
        Ok(())
    }

    /// Sets the slope of the table, and the initial direction phi of the lean, from downhill, in radians.
    pub fn slope(&mut self, [slope, heading]: [f64; 2]) -> Answer {
        (self.slope, self.motion) = ([slope, heading], None);
        Ok(())
    }

    /// Begins a motion from theta, w, slip, the table (0 rolling, 1 smooth, 2 Coulomb, 3 viscous) with its mu
    /// or c, the radius of the patch of dry friction, the last time, the number of rows of a motion that is integrated,
    /// and the coefficient of restitution, with NaN for a motion that ends where the body leaves the table.
    pub fn start(&mut self, [theta, w1, w2, w3, u_h, u_2, table, mu, patch, t, n, e]: [f64; 12]) -> Answer {
        self.motion = None;
        let (body, n) = (self.set_body()?, count("n", n, MOST)?);
        if !(t > 0.0 && t <= 1e12) {
            return Err(Refusal::Range { name: "t", value: t, expected: "0 < t <= 1e12" });
        }
        let wet = table == 3.0;
        if mu.is_nan() || mu < 0.0 {
            return Err(Refusal::Range {
                name: if wet { "c" } else { "mu" },
                value: mu,
                expected: "0 or more",
            });
        }
        // Dry friction with an infinite coefficient means rolling.
        let kind = TableKind::from_code(table as u8).unwrap_or_default();
        let kind = if mu.is_finite() || kind != TableKind::Coulomb { kind } else { TableKind::Rolling };
        let restitution = (!e.is_nan()).then_some(e);
        let table = match kind {
            TableKind::Rolling => Table::Rolling { mu },
            TableKind::Coulomb => Friction::Coulomb { mu, fixed: mu, patch }.into(),
            TableKind::Viscous => Friction::Viscous { c: mu }.into(),
            _ => Table::Smooth,
        };
        let wish = Wish {
            body,
            start: (State { theta, w1, w2, w3 }, Slip::new(u_h, u_2)),
            table,
            t,
            n,
            restitution,
        };
        if kind.rubs() || !self.losses.is_none() || restitution.is_some() || self.slope[0] != 0.0 {
            #[cfg(feature = "friction")]
            return self.walk(&wish);
            #[cfg(not(feature = "friction"))]
            return Err(Refusal::Lean);
        }
        self.swing(&wish, (kind.contact(), mu))
    }

    fn swing(
        &mut self,
        &Wish { body, start: (y, _), t, .. }: &Wish,
        (contact, mu): (Contact, f64),
    ) -> Answer {
        let swing = Swing::with_pose(&body, &y, contact)?;
        let event = motion::first_event(&swing, mu).filter(|e| e.time <= t);
        let until = event.map_or(t, |e| e.time);
        let looks = || (1..=ERRORS).map(|i| until * f64::from(i) / f64::from(ERRORS));
        let error = looks().map(|t| swing.error(t)).fold(0.0, f64::max);
        let pose_error = looks().map(|t| swing.pose_error(t)).fold(0.0, f64::max);
        let (code, time) = told(event);
        let [low, high] = swing.turning_points();
        let angles = swing.angles_per_period();
        let [phi, psi] = angles.map_or([f64::NAN; 2], |angles| [angles.precession, angles.spin]);
        self.out.extend([0.0, code, time, swing.period(), low, high, phi, psi, error, pose_error]);
        self.out.extend([0.0, 1.0, 0.0, 0.0, 0.0, until, 0.0, 0.0]);
        self.motion = Some(Kept::Exact { swing: Box::new(swing), body: Box::new(body), contact, until });
        Ok(())
    }

    /// Writes rows at equally spaced times: t, theta, w, phi and psi with whole turns, the contact point, N, |F|/N,
    /// slip, energy, the kind of the phase, the lost energy, the height of the rim's lowest point, and the number of
    /// this rim.
    pub fn follow(&mut self, [n, from, to]: [f64; 3]) -> Answer {
        for Row { t, y, pose, force, slip, kind, energy, lost, rim, .. } in self.rows(n, from, to)? {
            self.out.extend([t, y.theta, y.w1, y.w2, y.w3, pose.phi.radians(), pose.psi.radians()]);
            self.out.extend([pose.contact_point.x, pose.contact_point.y]);
            self.out.extend([force.normal, force.friction_coefficient(), slip.u_h, slip.u_2, energy]);
            self.out.extend([f64::from(kind as u8), lost, pose.height, f64::from(rim)]);
        }
        Ok(())
    }

    /// Writes equally spaced rows: t, theta, phi and psi without whole turns, and the contact point.
    pub fn poses(&mut self, [from, to, n]: [f64; 3]) -> Answer {
        for Row { t, y, pose: Pose { phi, psi, contact_point, .. }, .. } in self.rows(n, from, to)? {
            self.out.extend([t, y.theta, phi.rest, psi.rest, contact_point.x, contact_point.y]);
        }
        Ok(())
    }

    fn rows(&self, n: f64, from: f64, to: f64) -> Result<Vec<Row>, Refusal> {
        let n = count("n", n, MOST)?;
        let expected = "-1e12 <= t0 <= t1 <= 1e12, and t0 >= 0 if the motion is integrated";
        let kept = self.motion.as_ref().ok_or(Refusal::Nothing)?;
        let least = if matches!(kept, Kept::Exact { .. }) { -1e12 } else { 0.0 };
        for (name, value, low) in [("t0", from, least), ("t1", to, from)] {
            if !(value >= low && value <= 1e12) {
                return Err(Refusal::Range { name, value, expected });
            }
        }
        match kept {
            Kept::Exact { swing, body, contact, until } => {
                let row = |t: f64| {
                    let (y, pose) = (swing.state(t), swing.pose(t)?);
                    let (force, energy) = (force(*contact, body, &y), contact.energy(body, &y));
                    let (slip, kind) = (Slip::default(), Kind::Rolling);
                    Some(Row { t, y, pose, force, slip, kind, energy, lost: 0.0, lift: 0.0, rim: 0 })
                };
                Ok(times(from, to, n).take_while(|t| t <= until).map_while(row).collect())
            }
            #[cfg(feature = "friction")]
            Kept::Walked(walked) => walked.at(from, to, n),
        }
    }
}
