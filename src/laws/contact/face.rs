//! The friction of a face on which a body stands, slides and spins.

use crate::numbers::codes::coded;

coded! {
    /// How the table presses on a face. Where the pressure of a rigid face is undetermined, this is the choice of a model.
    #[derive(Default)]
    pub enum Face {
        /// On its rim alone, as below a tube, a can or a coin: the default.
        #[default]
        Ring = 0,
        /// On the whole face, as below a puck or a lapped end.
        Disc = 1,
    }
}
