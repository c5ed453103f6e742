//! Tables: what a body stands on, as a law of one motion and as a code of many.

use super::Contact;
use super::slip::Friction;
use crate::error::{Error, within};

/// What a table does to what stands on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Table {
    /// The contact point rests; where that needs more friction than mu N, the motion ends. Infinite: never.
    Rolling {
        /// Coefficient of friction.
        mu: f64,
    },
    /// Nothing holds the contact point.
    Smooth,
    /// A law of friction says whether it slips.
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
    /// Rolling that is never given up, or a smooth table.
    fn from(contact: Contact) -> Self {
        Self::of(contact, f64::INFINITY)
    }
}

impl Table {
    /// Rolling with this coefficient of friction, or a smooth table, which has none.
    pub fn of(contact: Contact, mu: f64) -> Self {
        match contact {
            Contact::Rolling => Self::Rolling { mu },
            Contact::Smooth => Self::Smooth,
        }
    }

    /// Whether a law of friction says what the contact point does.
    pub fn rubs(&self) -> bool {
        matches!(self, Self::Rubs(_))
    }

    /// What a body does that does not slip.
    pub fn contact(&self) -> Contact {
        if *self == Self::Smooth { Contact::Smooth } else { Contact::Rolling }
    }

    /// The greatest friction per normal force under which the contact point rests; infinite where none is asked for.
    pub(crate) fn mu(&self) -> f64 {
        match *self {
            Self::Rolling { mu } | Self::Rubs(Friction::Coulomb { fixed: mu, .. }) => mu,
            Self::Smooth | Self::Rubs(Friction::Viscous { .. }) => f64::INFINITY,
        }
    }

    /// The law of friction under which the contact point slips, if it does.
    pub(crate) fn friction(&self) -> Friction {
        match *self {
            Self::Rubs(friction) => friction,
            Self::Rolling { mu } => Friction::Coulomb { mu: 0.0, fixed: mu },
            Self::Smooth => Friction::coulomb(0.0),
        }
    }

    /// Refuses coefficients that make no sense, by name.
    pub(crate) fn check(&self) -> Result<(), Error> {
        match self {
            Self::Rolling { mu } => within("mu", *mu, (0.0, f64::INFINITY), "0 <= mu").map(|_| ()),
            Self::Smooth => Ok(()),
            Self::Rubs(friction) => friction.check(),
        }
    }
}

/// The kind of a table: the number is its code in arrays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(u8)]
pub enum TableKind {
    /// The contact point rests: mu, infinite where it always does.
    #[default]
    Rolling = 0,
    /// Nothing holds it.
    Smooth = 1,
    /// Coulomb's law: mu and the static coefficient.
    Coulomb = 2,
    /// A film: c.
    Viscous = 3,
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
    /// All of them, in the order of their codes.
    pub const ALL: [Self; 4] = [Self::Rolling, Self::Smooth, Self::Coulomb, Self::Viscous];

    /// That of a code.
    pub fn of(code: u8) -> Option<Self> {
        Self::ALL.get(usize::from(code)).copied()
    }

    /// Its name, as words for it are spelled.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rolling => "rolling",
            Self::Smooth => "smooth",
            Self::Coulomb => "coulomb",
            Self::Viscous => "viscous",
        }
    }

    /// The table with these coefficients; those that it does not have are not looked at.
    pub fn with(self, [a, b]: [f64; 2]) -> Table {
        match self {
            Self::Rolling => Table::Rolling { mu: a },
            Self::Smooth => Table::Smooth,
            Self::Coulomb => Friction::Coulomb { mu: a, fixed: b }.into(),
            Self::Viscous => Friction::Viscous { c: a }.into(),
        }
    }

    /// Whether a law of friction says what the contact point does.
    pub fn rubs(self) -> bool {
        matches!(self, Self::Coulomb | Self::Viscous)
    }

    /// What a body does that does not slip.
    pub fn contact(self) -> Contact {
        if self == Self::Smooth { Contact::Smooth } else { Contact::Rolling }
    }
}
