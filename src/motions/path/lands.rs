//! The landing of the other rim of a body without a bounce, after which the walk continues.

use super::phases::BodyWalk;
use crate::laws::contact::landing::{self, Outcome};
use crate::laws::contact::slip::Friction;
use crate::laws::state::State;
use crate::motions::Ending;
use crate::motions::halt::poses;
use crate::motions::walk::Next;
use core::f64::consts::{FRAC_PI_2, PI};

/// A body that rises with w2 below this after a landing stays on its side. Otherwise landings would follow
/// each other ever faster, without end.
const CLATTER: f64 = 1e-9;

impl<const N: usize> BodyWalk<'_, N> {
    /// The next phase after a landing of the other rim without a bounce.
    pub(super) fn lands(&mut self) -> Next {
        let Friction::Coulomb { mu, .. } = self.friction() else { return Next::Ends(Ending::Side) };
        let before = State { theta: FRAC_PI_2, ..self.of.state };
        let Ok(landed) = landing::land(&self.of.body, &before, [self.at[5], self.at[6]], mu) else {
            return Next::Ends(Ending::Side);
        };
        let (mut state, slip) = (landed.state, landed.slip);
        if landed.outcome == Outcome::Changes {
            self.made.path.upside_down = !self.made.path.upside_down;
        }
        if landed.outcome == Outcome::Changes && poses(N) {
            // The contact point moves by 2 ell to the other rim, and the body leans to the other side.
            let (direction, length) = (self.at[9], 2.0 * self.of.body.ell());
            self.at[11] -= length * direction.cos();
            self.at[12] -= length * direction.sin();
            (self.at[9], self.at[10]) = (direction + PI, -self.at[10]);
        }
        if state.w2 < CLATTER {
            state.w2 = 0.0;
        }
        let (s, c) = state.theta.sin_cos();
        self.at[..7].copy_from_slice(&[s, c, state.w1, state.w2, state.w3, slip[0], slip[1]]);
        self.at[8] += landed.lost;
        self.of.state = state;
        if landed.outcome == Outcome::Lies {
            return Next::Ends(Ending::Side);
        }
        self.first_phase().unwrap_or(Next::Ends(Ending::Painleve))
    }
}
