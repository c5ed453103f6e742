//! Enumerations whose values are stored in arrays as numbers.

/// An enumeration with a list of its values, and the conversion of a number in an array to the value.
macro_rules! coded {
    ($(#[$about:meta])* pub enum $Name:ident { $($(#[$doc:meta])* $Value:ident = $code:literal,)+ }) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        #[repr(u8)]
        pub enum $Name {
            $($(#[$doc])* $Value = $code,)+
        }

        impl $Name {
            /// All values, in the order of their codes.
            pub const ALL: [Self; [$($code),+].len()] = [$(Self::$Value),+];

            /// The value with this code, the number in an array; None for any other number.
            pub fn from_code(code: u8) -> Option<Self> {
                Self::ALL.into_iter().find(|value| *value as u8 == code)
            }
        }
    };
}
pub(crate) use coded;
