//! The reason why a call has no result, as a code and numbers that the page turns into a message.

use spincyl::Error;

/// The reason why a call has no result. Each reason has its own code.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Refusal {
    /// Code 1: a number is out of range.
    Range {
        /// The name of the number that is out of range.
        name: &'static str,
        /// The value that was given.
        value: f64,
        /// The accepted range.
        expected: &'static str,
    },
    /// Codes 2 to 6, 8, 11 and 13: errors of the library.
    Core(Error),
    /// Code 9: no body has been set, or no motion has been started.
    Nothing,
    /// Code 10: the computation is too long for a page.
    Work,
    /// Code 12: this core has been built without friction and losses.
    Lean,
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        match error {
            Error::OutOfRange { name, value, expected } => Self::Range { name, value, expected },
            error => Self::Core(error),
        }
    }
}

impl Refusal {
    /// Returns the code, and appends the numbers of the message to `out` and its words to `words`.
    pub fn tell(self, out: &mut Vec<f64>, words: &mut String) -> u32 {
        let (code, numbers): (u32, &[f64]) = match self {
            Self::Range { name, value, expected } => {
                for part in [name, "\n", expected] {
                    words.push_str(part);
                }
                (1, &[value])
            }
            Self::Core(Error::Moments { i3, i1 }) => (2, &[i1, i3]),
            Self::Core(Error::Forbidden { theta, theta_balance, theta_limit }) => {
                (3, &[theta, theta_balance, theta_limit])
            }
            Self::Core(Error::Undetermined { theta, theta_balance, theta_limit }) => {
                (4, &[theta, theta_balance, theta_limit])
            }
            Self::Core(Error::Lost { theta }) => (5, &[theta]),
            Self::Core(Error::Painleve { mu, theta, limit }) => (6, &[mu, theta, limit]),
            Self::Core(Error::Endless { time, theta }) => (13, &[time, theta]),
            Self::Core(Error::Memory { .. }) => (8, &[]),
            Self::Nothing => (9, &[]),
            Self::Work => (10, &[]),
            Self::Core(_) => (11, &[]),
            Self::Lean => (12, &[]),
        };
        out.extend_from_slice(numbers);
        code
    }
}
