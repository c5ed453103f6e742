//! The benches of this package stand beside this file; the package has no library.
