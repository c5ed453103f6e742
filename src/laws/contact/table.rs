//! Laws of contact with the table, as an enumeration for one motion, and as a code in arrays for many motions.

use super::Contact;
use super::slip::Friction;
use crate::error::{Error, within};
use crate::numbers::codes::coded;

/// A law of the contact between body and table.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub enum Table {
    /// The contact point is at rest. The motion ends where rolling needs more friction than mu N; mu may be infinite.
    Rolling {
        /// Coefficient of friction that rolling may need at most.
        #[cfg_attr(feature = "serde", serde(with = "crate::numbers::file"))]
        mu: f64,
    },
    /// The table is frictionless, so that the contact force is vertical.
    Smooth,
    /// A law of friction, which decides whether the contact point slips.
    Rubs(Friction),
}

impl Default for Table {
    fn default() -> Self {
        Self::Rolling { mu: f64::INFINITY }
    }
}

impl From<Friction> for Table {
    fn from(friction: Friction) -> Self {
        Self::Rubs(friction)
    }
}

impl From<Contact> for Table {
    /// Rolling with an infinite coefficient of friction, or a smooth table.
    fn from(contact: Contact) -> Self {
        Self::of(contact, f64::INFINITY)
    }
}

impl From<TableKind> for Table {
    /// The law of this kind with infinite coefficients and without a patch, for many motions each with its own coefficients.
    fn from(kind: TableKind) -> Self {
        kind.with([f64::INFINITY, f64::INFINITY, 0.0])
    }
}

impl Table {
    /// Rolling with the coefficient of friction `mu`, or a smooth table, for which `mu` is ignored.
    pub fn of(contact: Contact, mu: f64) -> Self {
        match contact {
            Contact::Rolling => Self::Rolling { mu },
            Contact::Smooth => Self::Smooth,
        }
    }

    /// Whether the law contains friction that decides if the contact point slips or is at rest.
    pub fn rubs(&self) -> bool {
        matches!(self, Self::Rubs(_))
    }

    /// The kind of contact while the contact point does not slip: smooth for a smooth table, else rolling.
    pub fn contact(&self) -> Contact {
        if *self == Self::Smooth { Contact::Smooth } else { Contact::Rolling }
    }

    /// The largest ratio of friction to normal force at which the contact point is at rest; infinite without a limit.
    pub(crate) fn mu(&self) -> f64 {
        match *self {
            Self::Rolling { mu } | Self::Rubs(Friction::Coulomb { fixed: mu, .. }) => mu,
            Self::Smooth | Self::Rubs(Friction::Viscous { .. }) => f64::INFINITY,
        }
    }

    /// The law of friction on a contact point that slips.
    pub(crate) fn friction(&self) -> Friction {
        match *self {
            Self::Rubs(friction) => friction,
            Self::Rolling { mu } => Friction::Coulomb { mu: 0.0, fixed: mu, patch: 0.0 },
            Self::Smooth => Friction::coulomb(0.0),
        }
    }

    /// Returns this law with other coefficients, as [`TableKind::with`] takes them.
    pub(crate) fn with_coefficients(&self, coefficients: [f64; 3]) -> Self {
        let kind = match self {
            Self::Rolling { .. } => TableKind::Rolling,
            Self::Smooth => TableKind::Smooth,
            Self::Rubs(Friction::Coulomb { .. }) => TableKind::Coulomb,
            Self::Rubs(Friction::Viscous { .. }) => TableKind::Viscous,
        };
        kind.with(coefficients)
    }

    /// Returns an error for coefficients outside their range; the error names the coefficient.
    pub(crate) fn check(&self) -> Result<(), Error> {
        match self {
            Self::Rolling { mu } => within("mu", *mu, (0.0, f64::INFINITY), "0 <= mu").map(|_| ()),
            Self::Smooth => Ok(()),
            Self::Rubs(friction) => friction.check(),
        }
    }
}

coded! {
    /// The kind of a law of contact. The number is the code of the kind in arrays.
    #[derive(Default)]
    pub enum TableKind {
        /// The contact point is at rest. The coefficient is mu, infinite where friction has no limit.
        #[default]
        Rolling = 0,
        /// The table is frictionless; there is no coefficient.
        Smooth = 1,
        /// Coulomb's law of friction with the coefficient mu and the static coefficient.
        Coulomb = 2,
        /// A viscous film with the coefficient c.
        Viscous = 3,
    }
}

impl From<Contact> for TableKind {
    fn from(contact: Contact) -> Self {
        match contact {
            Contact::Rolling => Self::Rolling,
            Contact::Smooth => Self::Smooth,
        }
    }
}

impl TableKind {
    /// The name of the kind, as it is spelled in the Python interface.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rolling => "rolling",
            Self::Smooth => "smooth",
            Self::Coulomb => "coulomb",
            Self::Viscous => "viscous",
        }
    }

    /// The law of this kind with the coefficients [mu or c, static, patch]; coefficients that the kind does not have are ignored.
    pub(crate) fn with(self, [a, b, patch]: [f64; 3]) -> Table {
        match self {
            Self::Rolling => Table::Rolling { mu: a },
            Self::Smooth => Table::Smooth,
            Self::Coulomb => Friction::Coulomb { mu: a, fixed: b, patch }.into(),
            Self::Viscous => Friction::Viscous { c: a }.into(),
        }
    }

    /// Whether the law contains friction that decides if the contact point slips or is at rest.
    pub fn rubs(self) -> bool {
        matches!(self, Self::Coulomb | Self::Viscous)
    }

    /// The kind of contact while the contact point does not slip: smooth for a smooth table, else rolling.
    pub fn contact(self) -> Contact {
        if self == Self::Smooth { Contact::Smooth } else { Contact::Rolling }
    }
}
