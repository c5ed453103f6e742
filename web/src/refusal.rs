//! Why a question has no answer, as a code and numbers that a page tells in words.

use spincyl::Error;

/// Why there is no answer. Each has a code of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Refusal {
    /// 1: a number is out of range; its name, its value, what would do.
    Range {
        /// The number's name.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What would have done.
        expected: &'static str,
    },
    /// 2 to 8, 11: the core's own refusal.
    Core(Error),
    /// 9: no body has been set, or no motion started.
    Nothing,
    /// 10: too much work for a page.
    Work,
    /// 12: this core has been built without friction and losses.
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
    /// The code; the numbers and words go where they are told.
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
            Self::Core(Error::Restless { count, time }) => (7, &[count as f64, time]),
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
