//! On which part (face, side or edge) a body rests at the end of its motion: heads or tails.
//!
//! ```text
//! a face    the motion ended where a face landed, or at rest on it; e3 points up on the first face, and down on the other
//! its side  no velocity is left, and both rims or any two circles touch the table, or theta has reached theta_end
//! an edge   no velocity is left, and dry losses hold the body, or it is balanced: theta'' = 0
//! ```
//! A motion that ends where a face lands does not compute the slide and the spin on this face, which do not change
//! which face lies on the table. A motion that ends where the other rim lands is not computed until the body is at
//! rest, so that the result is `None`. The state of a body of several circles is counted from its lower end, so that
//! theta itself says which face is down, and every inclination at which two circles touch is a side.
//!
//! Error: none, unless the estimated error of the motion is so large that another motion is as likely.

use crate::laws::body::Body;
use crate::laws::contact::Contact;
use crate::laws::state::{Slip, State};
use crate::motions::body::face::FLAT;
use crate::motions::body::roll::lossy::REST;
#[cfg(feature = "many")]
use crate::motions::walk::two_runs::Followed;
use crate::motions::{Ending, Kind, Motion, Path};
use crate::numbers::codes::coded;

/// A body counts as balanced if its angular acceleration, in g/R, is below this, which may be rounding.
const BALANCED: f64 = 1e-14;

coded! {
    /// The part of a body at rest that touches the table.
    pub enum RestsOn {
        /// The body is not at rest, or its motion was not computed to its rest.
        None = 0,
        /// The face at the rim to which the initial state refers, or at the lower end of a body of several circles: the axis
        /// of the body points up.
        Face = 1,
        /// The face at the other end: the axis of the body points down.
        OtherFace = 2,
        /// The side: both rims, two circles, or a rim and another part.
        Side = 3,
        /// A rim: the body stands upright or leans, balanced or held by dry losses. A ball rests anywhere.
        Edge = 4,
    }
}

/// The state at the end of a motion, and how the motion ended.
struct LastState {
    ending: Ending,
    state: State,
    slip: Slip,
    rim: u8,
    /// The kind of the last phase, if the motion has phases.
    kind: Option<Kind>,
}

impl LastState {
    fn of(motion: &Motion, path: Option<&Path>) -> Option<Self> {
        let (ending, kind) =
            (motion.ending(), path.and_then(|path| path.phases.last()).map(|phase| phase.kind));
        let (state, slip, rim) = match motion.event {
            Some(event) => (event.state, path.map_or(Slip::default(), |path| path.last_slip), event.rim),
            None => {
                let slip = path.and_then(|path| path.slip.last().copied()).unwrap_or_default();
                let rim = path.and_then(|path| path.rims.last().copied()).unwrap_or_default();
                (*motion.states.last()?, slip, rim)
            }
        };
        Some(Self { ending, state, slip, rim, kind })
    }

    fn rests_on(&self, body: &Body) -> RestsOn {
        let State { theta, w1, w2, w3 } = self.state;
        if self.ending == Ending::Face {
            let up = axis_up(body, &self.state, self.rim) > 0.0;
            return if up { RestsOn::Face } else { RestsOn::OtherFace };
        }
        let moves = [w1, w2, w3].into_iter().chain(self.slip.pair()).any(|x| x.abs() > REST);
        if moves || self.kind == Some(Kind::Flying) && self.ending == Ending::Done {
            return RestsOn::None;
        }
        match self.ending {
            Ending::Stops if theta.sin() < FLAT && body.standing_on(self.rim).rim() > 0.0 => {
                if axis_up(body, &self.state, self.rim) > 0.0 { RestsOn::Face } else { RestsOn::OtherFace }
            }
            Ending::Done | Ending::Stops | Ending::Side if self.is_on_side(body, theta) => RestsOn::Side,
            Ending::Stops => RestsOn::Edge,
            Ending::Done if self.tilts(body).abs() < BALANCED => RestsOn::Edge,
            _ => RestsOn::None,
        }
    }

    /// Whether the other rim, another part or two circles touch the table.
    fn is_on_side(&self, body: &Body, theta: f64) -> bool {
        let lies = self.kind.is_some_and(|kind| kind >= Kind::Lying && kind != Kind::OnItsFace);
        if body.has_row() { lies || body.lands_at(theta) } else { theta >= body.theta_end() }
    }

    /// The angular acceleration w2' of the body on its circle of contact.
    fn tilts(&self, body: &Body) -> f64 {
        Contact::Rolling.derivative(&body.standing_on(self.rim), &self.state).w2
    }
}

/// The cosine of the angle from the vertical to the axis of a body, in a state of its motion.
pub(crate) fn axis_up(body: &Body, state: &State, rim: u8) -> f64 {
    state.axis_up(if body.has_row() { 0 } else { rim })
}

impl Motion {
    /// The part on which the body rests at the end of the motion; `RestsOn::None` if it is not at rest.
    ///
    /// ```
    /// use spincyl::contact::Friction;
    /// use spincyl::motion::{AboveTable, Ask, RestsOn, Start, roll_with};
    /// use spincyl::{Body, State};
    ///
    /// let coin = Body::solid(0.25)?;
    /// let state = State { theta: 0.4, w1: 0.0, w2: 0.0, w3: 0.0 };
    /// let start = Start::from(state).with_aloft(AboveTable::new(2.0, 0.0));
    /// let ask = Ask::on(Friction::coulomb(0.3)).with_restitution(0.0);
    /// let motion = roll_with(&coin, start, &[0.0, 50.0], &ask, || true)?.expect("not interrupted");
    /// assert_eq!(motion.rests_on(&coin), RestsOn::Face);
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    pub fn rests_on(&self, body: &Body) -> RestsOn {
        LastState::of(self, self.path.as_deref()).map_or(RestsOn::None, |last| last.rests_on(body))
    }
}

/// The part on which a body rests after it has rolled on its first rim without a change of phase.
#[cfg(feature = "many")]
pub(crate) fn rolled_rests_on(body: &Body, state: State, ending: Ending) -> RestsOn {
    LastState { ending, state, slip: Slip::default(), rim: 0, kind: Some(Kind::Rolling) }.rests_on(body)
}

#[cfg(feature = "many")]
impl Followed {
    /// The part on which the body rests at the end of this motion, whose path is stored separately.
    pub(crate) fn rests_on(&self, body: &Body) -> RestsOn {
        LastState::of(&self.motion, Some(&self.path)).map_or(RestsOn::None, |last| last.rests_on(body))
    }
}
