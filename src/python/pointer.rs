//! Laws of loss and friction that are C functions, called by their addresses, without Python and its GIL.
//!
//! This file has `unsafe` because an address has no type: the wrapper in Python (`custom.py`) looks at the signature of
//! each function before it passes the address, and the law keeps the function alive as long as the motion is computed.
#![expect(unsafe_code, reason = "a C function is called by its address")]

use crate::laws::body::Body;
use crate::laws::custom::{CoupleLaw, Custom, FrictionLaw};
use crate::laws::state::State;
use core::mem::transmute;
use core::num::NonZeroUsize;
use pyo3::prelude::*;

/// A user-defined law as Python gives it: the address of a C function with the units of its numbers, or a Python function.
#[derive(FromPyObject)]
pub enum GivenLaw {
    Address((NonZeroUsize, [f64; 3])),
    Function(Py<PyAny>),
}

impl GivenLaw {
    pub fn function(&self) -> Option<&Py<PyAny>> {
        if let Self::Function(function) = self { Some(function) } else { None }
    }

    fn pointed(&self) -> Option<PointedLaw> {
        if let Self::Address((address, units)) = *self { Some(PointedLaw { address, units }) } else { None }
    }
}

/// The couple and the friction of a motion, as far as they are C functions.
pub struct PointedLaws {
    couple: Option<PointedLaw>,
    friction: Option<PointedLaw>,
}

impl PointedLaws {
    pub fn of(couple: Option<&GivenLaw>, friction: Option<&GivenLaw>) -> Self {
        let [couple, friction] = [couple, friction].map(|law| law.and_then(GivenLaw::pointed));
        Self { couple, friction }
    }

    pub fn custom(&self) -> Custom<'_> {
        Custom {
            couple: self.couple.as_ref().map(|law| law as &dyn CoupleLaw),
            friction: self.friction.as_ref().map(|law| law as &dyn FrictionLaw),
            drive: None,
        }
    }
}

/// A C function as a law. `units` convert its numbers: the units of angular velocities, forces and couples, or of the
/// speed of a slip.
#[derive(Clone, Copy)]
struct PointedLaw {
    address: NonZeroUsize,
    units: [f64; 3],
}

impl CoupleLaw for PointedLaw {
    fn couple(&self, _: &Body, y: &State, normal: f64) -> [f64; 3] {
        let [rate, force, couple] = self.units;
        let args = [y.theta, rate * y.w1, rate * y.w2, rate * y.w3, force * normal];
        let mut found = [f64::NAN; 3];
        // SAFETY: the wrapper passes only addresses of functions with this signature, which read five numbers and write
        // three; see the head of this file.
        unsafe {
            let law: extern "C" fn(*const f64, *mut f64) = transmute(self.address.get());
            law(args.as_ptr(), found.as_mut_ptr());
        }
        found.map(|m| m / couple)
    }
}

impl FrictionLaw for PointedLaw {
    fn coefficient(&self, speed: f64) -> f64 {
        // SAFETY: the wrapper passes only addresses of functions with this signature; see the head of this file.
        let law: extern "C" fn(f64) -> f64 = unsafe { transmute(self.address.get()) };
        law(self.units[0] * speed)
    }
}
