//! NumPy ufuncs from elementwise functions: `out=`, `where=`, broadcasting, xarray and dask for
//! nothing.
//!
//! The one place with `unsafe`: NumPy hands its inner loops raw pointers, strides and counts, and
//! keeps a pointer to the loop's data for the life of the process.
#![expect(unsafe_code, reason = "NumPy's ufunc loops are a C interface")]

use super::body_of;
use crate::Body;
use crate::real::{LANES, sincos};
use crate::stability::{Moments, region_of, rolling_at_rest, smooth_at_rest};
use crate::steady::{rate_of, terms};
use core::ffi::{c_char, c_int, c_void};
use fearless_simd::{Simd, SimdBase, SimdFrom, f64x8};
use numpy::npyffi::{NPY_TYPES, PY_UFUNC_API, PyUFuncGenericFunction, npy_intp};
use pyo3::prelude::*;

/// The most inputs that a law has: a state and a body.
const MOST: usize = 8;

/// A quantity of the steady state with the centre at rest, computed in lanes.
#[derive(Clone, Copy)]
pub enum Quantity {
    Rate,
    KappaRolling,
    KappaSmooth,
    /// The code of a region, as uint8.
    Region,
}

/// What an elementwise function does with its inputs.
pub enum Value {
    /// theta and a body (four numbers), in lanes.
    AtRest(Quantity),
    /// Any inputs to one number.
    One(fn(&[f64]) -> f64),
    /// The last input (0, 1 or 2) picks from what the others give; equal neighbours share it.
    Pick(fn(&[f64]) -> [f64; 3]),
}

/// An elementwise function by name.
pub struct Law {
    pub name: &'static str,
    pub inputs: usize,
    pub value: Value,
}

/// The inputs and the output of one inner loop.
struct Loop {
    base: [*mut c_char; MOST + 1],
    step: [isize; MOST + 1],
    inputs: usize,
    count: isize,
}

impl Loop {
    /// Input `k` of element `i < count`.
    fn get(&self, k: usize, i: isize) -> f64 {
        debug_assert!(k < self.inputs && i < self.count);
        // SAFETY: NumPy promises `count` elements `step` apart, here doubles (the type table in
        // `make`); unaligned reads need no promise about alignment.
        unsafe { self.base[k].offset(i * self.step[k]).cast::<f64>().read_unaligned() }
    }

    fn put<T>(&self, i: isize, value: T) {
        // SAFETY: as in `get`; the output's type is that of the type table, as is `T`.
        unsafe {
            self.base[self.inputs].offset(i * self.step[self.inputs]).cast::<T>().write_unaligned(value)
        }
    }

    fn row(&self, i: isize) -> [f64; MOST] {
        core::array::from_fn(|k| if k < self.inputs { self.get(k, i) } else { 0.0 })
    }

    fn body(&self, i: isize) -> Option<Body> {
        let x = self.row(i);
        body_of(&x[self.inputs - 4..self.inputs]).ok()
    }
}

/// The inner loop of every ufunc here; `data` is its [`Law`].
unsafe extern "C" fn inner(
    args: *mut *mut c_char,
    dimensions: *mut npy_intp,
    steps: *mut npy_intp,
    data: *mut c_void,
) {
    // SAFETY: `make` registered this loop with a `&'static Law` as its data, and NumPy passes
    // `inputs + 1` pointers and strides and one count.
    let (law, run) = unsafe {
        let law = &*data.cast::<Law>();
        let mut run = Loop {
            base: [core::ptr::null_mut(); MOST + 1],
            step: [0; MOST + 1],
            inputs: law.inputs,
            count: *dimensions,
        };
        for k in 0..=law.inputs {
            run.base[k] = *args.add(k);
            run.step[k] = *steps.add(k);
        }
        (law, run)
    };
    match law.value {
        Value::AtRest(quantity) => {
            fearless_simd::dispatch!(crate::level(), simd => at_rest(simd, &run, quantity));
        }
        Value::One(f) => {
            for i in 0..run.count {
                run.put(i, f(&run.row(i)[..run.inputs]));
            }
        }
        Value::Pick(f) => {
            let pick = run.inputs - 1;
            let mut last = ([f64::NAN.to_bits(); MOST], f(&[f64::NAN; MOST][..pick]));
            for i in 0..run.count {
                let mut key = run.row(i);
                let asked = core::mem::replace(&mut key[pick], f64::NAN);
                let bits = key.map(f64::to_bits);
                if bits != last.0 {
                    last = (bits, f(&key[..pick]));
                }
                let picked = [0.0, 1.0, 2.0].iter().position(|k| *k == asked);
                run.put(i, picked.map_or(f64::NAN, |k| last.1[k]));
            }
        }
    }
    // NaN is an answer here, not an accident: leave no floating-point flag for NumPy to warn of.
    // SAFETY: the interface was resolved in `make`; clearing the flags touches no Python object.
    unsafe { PY_UFUNC_API.PyUFunc_clearfperr(Python::assume_attached()) };
}

/// Eight inclinations at a time; the body once if it does not vary along the loop.
#[inline(always)]
fn at_rest<S: Simd>(simd: S, run: &Loop, quantity: Quantity) {
    let fixed = run.step[1..run.inputs].iter().all(|s| *s == 0) && run.count > 0;
    let load = |m: Moments<[f64; LANES]>| m.map(|x| f64x8::simd_from(simd, x));
    let mut of = load(Moments::gather(&[if fixed { run.body(0) } else { None }; LANES]));
    for start in (0..run.count).step_by(LANES) {
        let lanes = (run.count - start).min(LANES as isize);
        if !fixed {
            let bodies: [_; LANES] =
                core::array::from_fn(
                    |i| if (i as isize) < lanes { run.body(start + i as isize) } else { None },
                );
            of = load(Moments::gather(&bodies));
        }
        let theta: [f64; LANES] = core::array::from_fn(|i| run.get(0, start + (i as isize).min(lanes - 1)));
        let theta = f64x8::from_slice(simd, &theta);
        let angle = sincos(theta);
        let terms = terms(&angle, of.ell, of.excess);
        let value = match quantity {
            Quantity::Rate => rate_of(theta, angle.sin, &terms),
            Quantity::KappaRolling => rolling_at_rest(theta, &angle, &terms, &of),
            Quantity::KappaSmooth => smooth_at_rest(theta, &angle, &terms, &of),
            Quantity::Region => {
                let smooth = smooth_at_rest(theta, &angle, &terms, &of);
                region_of(theta, of.ell, &terms, smooth, rolling_at_rest(theta, &angle, &terms, &of))
            }
        };
        for i in 0..lanes {
            match quantity {
                Quantity::Region => run.put(start + i, value[i as usize] as u8),
                _ => run.put(start + i, value[i as usize]),
            }
        }
    }
}

/// The NumPy ufunc of a law.
pub fn make<'py>(py: Python<'py>, law: &'static Law) -> PyResult<Bound<'py, PyAny>> {
    let output = if matches!(law.value, Value::AtRest(Quantity::Region)) {
        NPY_TYPES::NPY_UBYTE
    } else {
        NPY_TYPES::NPY_DOUBLE
    };
    let mut types = vec![NPY_TYPES::NPY_DOUBLE as c_char; law.inputs];
    types.push(output as c_char);
    // NumPy keeps these for as long as the ufunc lives, that is for the life of the process.
    let types = Vec::leak(types);
    let name = Box::leak(std::ffi::CString::new(law.name)?.into_boxed_c_str());
    let functions: &mut [PyUFuncGenericFunction] = Vec::leak(vec![Some(inner)]);
    let data: &mut [*mut c_void] = Vec::leak(vec![core::ptr::from_ref(law).cast_mut().cast()]);
    // SAFETY: one loop, `inputs + 1` types, all leaked; the result is a new reference or an error.
    unsafe {
        PY_UFUNC_API.PyUFunc_clearfperr(py);
        let ufunc = PY_UFUNC_API.PyUFunc_FromFuncAndData(
            py,
            functions.as_mut_ptr(),
            data.as_mut_ptr(),
            types.as_mut_ptr(),
            1,
            law.inputs as c_int,
            1,
            -1, // PyUFunc_None: no identity, no reduction
            name.as_ptr(),
            c"Elementwise; see the method of spincyl.Body or spincyl.State that calls it.".as_ptr(),
            0,
        );
        Bound::from_owned_ptr_or_err(py, ufunc)
    }
}
