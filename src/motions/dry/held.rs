//! Decides which rotations dry losses resist, hold at rest and let go, for bodies that roll, slip or lie, and for
//! stones.
//!
//! ```text
//! moves      the loss acts against its sign                   margin: the speed in the direction of the sign
//! stops      held if |couple| <= limit, else it begins again against the couple that would have held it
//! is held    margin: limit^2 - couple^2                       beyond it begins against the couple
//! together   several at rest at a time are held, or begin, as `together` finds
//! ```
//! [`Ways`] has the signs of the rotations in a phase, and which of them are held. The equations of a phase give the
//! couple that holds a rotation, and its limit; this module decides what follows from these.
//!
//! Error: a rotation that begins has the speed 0, and a hold ends at most the share `GRACE` beyond its limit.

use crate::laws::contact::grip;
use crate::laws::contact::together::{Resting, Together};
use crate::laws::loss::{Couples, GRACE, Holds, Kinematics, Law, NEAR, OwnCouple, SLACK, Ways, going};
use crate::motions::walk::numbers::Halt;
use crate::numbers::{Real, sign_or_zero};

/// During a slip, rolling slower than this, which a step may change by `NEAR`, ends if rolling resistance would also
/// stop it in the opposite direction.
pub(crate) const HARDLY_ROLLS: f64 = 4.0 * NEAR;

impl Ways {
    /// The signs of psi' and of w_z, with nothing held at rest.
    pub fn of(spin: f64, drilling: f64) -> Self {
        Self { contour: sign_or_zero(spin), drilling: sign_or_zero(drilling), ..Self::default() }
    }

    /// These signs with one rotation, along the rim or drilling, held at rest; or not held, with this sign.
    fn with(mut self, part: Resting, held: bool, sign: f64) -> Self {
        let (of, holds) = match part {
            Resting::Contour => (&mut self.contour, &mut self.holds.contour),
            _ => (&mut self.drilling, &mut self.holds.drilling),
        };
        (*of, *holds) = (sign, held);
        self
    }

    /// These signs with this rotation held at rest.
    pub fn holding(self, part: Resting) -> Self {
        self.with(part, true, 0.0)
    }

    /// These signs with rolling and rocking held at rest, so that the body only turns about the vertical.
    pub fn holding_rolling(self) -> Self {
        let holds = Holds { rolling: true, ..Holds::default() };
        Self { contour: 0.0, holds, ..self.rolling_freely() }
    }

    /// These signs with a rotation that begins against the couple that would hold it at rest: lambda h/s along the
    /// contour, which takes the power lambda psi', or nu about the vertical, which gives the power nu w_z.
    pub fn beginning(self, part: Resting, couple: f64) -> Self {
        let sign = if part == Resting::Contour { couple.signum() } else { -couple.signum() };
        self.with(part, false, sign)
    }

    /// These signs for a rotation at rest: held, or begun again, from the couple that it needs and the limit of
    /// friction.
    pub fn stopping(self, part: Resting, needs: [f64; 2]) -> Self {
        if holds(needs) { self.holding(part) } else { self.beginning(part, needs[0]) }
    }

    /// These signs with those of the rotations at rest, which are held or begin; `known` is a rotation for which this
    /// is already decided. Also returns the direction in which rolling and rocking begin.
    pub fn deciding(mut self, rests: Together, known: Option<(Resting, bool)>) -> (Self, [f64; 2]) {
        let [_, rolling, contour, drilling] = rests.knowing(known).fates();
        if rests.has(Resting::Contour) {
            self = self.with(Resting::Contour, !contour.begins(), -sign_or_zero(contour.way[0]));
        }
        if rests.has(Resting::Drilling) {
            self = self.with(Resting::Drilling, !drilling.begins(), sign_or_zero(drilling.way[0]));
        }
        self.holds.rolling = rests.has(Resting::Rolling) && !rolling.begins();
        (self, rolling.way)
    }

    /// These signs with the direction of (w_h, w2) free.
    pub fn rolling_freely(self) -> Self {
        Self { rolling: 0.0, rocking: 0.0, ..self }
    }
}

impl Holds {
    /// Whether this rotation is held at rest; false for a slip.
    pub fn has(self, part: Resting) -> bool {
        [false, self.rolling, self.contour, self.drilling][part as usize]
    }

    /// The rotation that friction ceases to hold at this halt; None if the halt stops a rotation.
    pub fn ceasing(self, halt: Halt) -> Option<Resting> {
        let part = match halt {
            Halt::Contour if self.rolling => Resting::Rolling,
            Halt::Contour => Resting::Contour,
            Halt::Drilling => Resting::Drilling,
            _ => return None,
        };
        Some(part).filter(|part| self.has(*part))
    }
}

/// The distance to rest, in the variable sigma with the pace dt/dsigma, of rolling and rocking together; None if
/// their speed is above `slow`, or does not fall. `growth` is the time derivative of the speed.
pub(crate) fn left_to_rest([speed, growth]: [f64; 2], slow: f64, pace: f64) -> Option<f64> {
    (speed <= slow && speed > 0.0 && growth < 0.0).then(|| -speed / (growth * pace))
}

/// Whether dry friction can exert the couple that holds a rotation at rest, from this couple and the limit of
/// friction.
pub(crate) fn holds([push, limit]: [f64; 2]) -> bool {
    push.abs() <= limit * (1.0 + GRACE)
}

/// A quantity that is positive while dry friction can hold a rotation at rest, from the couple that this needs and
/// its limit.
pub(crate) fn hold<T: Real>([push, limit]: [T; 2]) -> T {
    grip(push.splat(1.0 + GRACE), limit, push * push)
}

/// The margins (quantities whose zeros end a phase) of the rotations that dry losses resist: along the rim or, if
/// that is held, of rolling; and of drilling (or of rocking if the body only rocks). `held` has the couple that holds
/// the drilling at rest, and the limit of friction, and `kept` those for the rotation along the rim or for rolling.
/// Rounding of the speeds grows with phi', the `precession`.
#[inline(never)]
pub(crate) fn margins_of_ways<T: Real, G: OwnCouple<T>>(
    losses: &Couples<T, G>,
    seen: &Kinematics<T>,
    precession: T,
    [held, kept]: [[T; 2]; 2],
) -> [T; 2] {
    let one = seen.spin.splat(1.0);
    let slack = one.splat(SLACK) * (one + precession.abs());
    let Some(of) = losses.ways else { return [one; 2] };
    let along = (of.holds.contour || of.holds.rolling, kept);
    let contour = margin_of_way(along, (losses.has(Law::DryContour), of.contour), seen.spin, slack);
    let other = if of.rocking != 0.0 {
        let rocks = (losses.has(Law::RollingResistance), one.splat(of.rocking));
        margin_of_way((false, held), rocks, seen.w[1], slack)
    } else {
        let drills = (losses.has(Law::Drilling), of.drilling);
        margin_of_way((of.holds.drilling, held), drills, seen.drilling(), slack)
    };
    [contour, other]
}

/// The margin (whose zero ends a phase) of one rotation: from whether it is held at rest, the couple that this needs
/// and its limit; whether a dry loss resists it, and its sign; and its speed.
#[inline(always)]
pub(crate) fn margin_of_way<T: Real>(
    (held, needs): (bool, [T; 2]),
    (resists, way): (bool, T),
    speed: T,
    slack: T,
) -> T {
    if held {
        hold(needs)
    } else if resists {
        going(way, speed, slack)
    } else {
        speed.splat(1.0)
    }
}
