//! Enumerations whose values are stored in arrays as numbers.

/// Defines an enumeration with a list of its values and conversions between the values and the numbers that stand for
/// them in arrays.
macro_rules! coded {
    ($(#[$about:meta])* pub enum $Name:ident { $($(#[$doc:meta])* $Value:ident = $code:literal,)+ }) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[repr(u8)]
        #[non_exhaustive]
        pub enum $Name {
            $($(#[$doc])* $Value = $code,)+
        }

        impl $Name {
            /// All values of the enumeration, in the order of their codes.
            pub const ALL: &'static [Self] = &[$(Self::$Value),+];

            /// The value with this code, the number in an array; None for any other number.
            pub fn from_code(code: u8) -> Option<Self> {
                Self::ALL.iter().copied().find(|value| *value as u8 == code)
            }
        }

        impl TryFrom<u8> for $Name {
            type Error = crate::error::Error;

            /// The value with this code, or the error `OutOfRange` if there is none.
            fn try_from(code: u8) -> Result<Self, Self::Error> {
                let expected = concat!("the code of a value of ", stringify!($Name));
                Self::from_code(code).ok_or(Self::Error::OutOfRange { name: "code", value: f64::from(code), expected })
            }
        }

        impl core::fmt::Display for $Name {
            /// Writes the name of the value in words, such as "lift off" for `LiftOff`.
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.pad(&$crate::numbers::codes::words(&format!("{self:?}")))
            }
        }
    };
}
pub(crate) use coded;

/// The name of a value as lower-case words: "lift off" for "LiftOff".
pub(crate) fn words(name: &str) -> String {
    let mut all = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !all.is_empty() {
            all.push(' ');
        }
        all.extend(letter.to_lowercase());
    }
    all
}
