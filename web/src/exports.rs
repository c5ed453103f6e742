//! The calls that WebAssembly exports: each takes numbers and returns a code.

use crate::Desk;
use std::cell::RefCell;

thread_local! { static DESK: RefCell<Desk> = RefCell::default(); }

/// Defines WebAssembly exports, each of which passes its numbers to the method of [`Desk`] with the same name.
macro_rules! exports {
    ($($name:ident($($x:ident),*);)*) => {$(
        #[allow(unsafe_code)]
        #[unsafe(no_mangle)]
        extern "C" fn $name($($x: f64),*) -> u32 {
            DESK.with_borrow_mut(|desk| desk.ask(|desk| desk.$name([$($x),*])))
        }
    )*};
}

/// Defines the exports that return the address and the length of each buffer of the last answer.
macro_rules! tells {
    ($($name:ident -> $what:ty, $desk:ident => $told:expr;)*) => {$(
        #[allow(unsafe_code)]
        #[unsafe(no_mangle)]
        extern "C" fn $name() -> $what {
            DESK.with_borrow(|$desk| $told)
        }
    )*};
}

tells! {
    out -> *const f64, desk => desk.out.as_ptr();
    len -> usize, desk => desk.out.len();
    codes -> *const u8, desk => desk.codes.as_ptr();
    words -> *const u8, desk => desk.words.as_ptr();
    words_len -> usize, desk => desk.words.len();
}

exports! {
    tube(ell, bore, fillet);
    body(ell, i1, i3, fillet, theta_end);
    frustum(bottom, top, height);
    critical(bore, fillet);
    map(w, h, ell_lo, ell_hi, theta_lo, theta_hi, bore, fillet);
    curves(n, ell_lo, ell_hi, bore, fillet);
    at_rest(theta);
    by_rate(rate);
    circular(theta, precession);
    losses(law, coefficient);
    slope(slope, heading);
    start(theta, w1, w2, w3, u_h, u_2, table, mu, patch, t, n, restitution);
    follow(n, t0, t1);
    poses(t0, t1, n);
    flick(impulse, angle, finger, table);
    thrown(velocity, backspin);
}

#[cfg(feature = "friction")]
exports! {
    phases();
    rattleback(a1, a2, a3, twist, spin, push, t, n);
}
