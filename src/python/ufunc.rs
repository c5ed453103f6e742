//! NumPy ufuncs made of elementwise functions: NumPy then supplies `out=`, `where=`, broadcasting, xarray and dask.
//!
//! The loops are those of NumPy 2 (`PyArrayMethod_Spec` in its `dtype_api.h`): NumPy calls them with or without the
//! GIL, and they may return an error, here that of Ctrl-C. Numbers of any type other than double are promoted to
//! double.
//!
//! This file and `pointer.rs` are the only ones with `unsafe`. Here NumPy gives its inner loops raw pointers, strides and counts, and keeps the
//! data that `make` registers for the life of the process.
#![expect(unsafe_code, reason = "NumPy's ufunc loops are a C interface")]

use super::watch::still;
use super::{BODY, body_of};
use crate::Body;
use crate::numbers::{LANES, in_lanes, level};
use crate::states::stability::{Column, SteadyPoint, Wanted};
use crate::states::steady;
use core::ffi::{c_char, c_int, c_void};
use fearless_simd::{Simd, SimdBase, SimdFrom, f64x8};
use numpy::npyffi::{NPY_CASTING, PY_UFUNC_API, PyUFuncObject, npy_intp};
use pyo3::exceptions::PyRuntimeError;
use pyo3::ffi::{PyObject, PyType_Slot};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyTuple};
use std::sync::OnceLock;

/// The largest number of inputs of a function: those of a loss, and the axis of its couple.
const MOST: usize = super::loss::INPUTS + 1;

/// A quantity of the steady state with the centre at rest, computed in SIMD lanes.
#[derive(Clone, Copy)]
pub enum Quantity {
    Rate,
    KappaRolling,
    KappaSmooth,
    /// The code of a region, as uint8.
    Region,
}

impl Quantity {
    fn wanted(self) -> Wanted {
        Wanted {
            rate: matches!(self, Self::Rate),
            rolling: matches!(self, Self::KappaRolling),
            smooth: matches!(self, Self::KappaSmooth),
            region: matches!(self, Self::Region),
            ..Wanted::default()
        }
    }

    fn of<T>(self, found: SteadyPoint<T>) -> T {
        match self {
            Self::Rate => found.rate,
            Self::KappaRolling => found.rolling,
            Self::KappaSmooth => found.smooth,
            Self::Region => found.region,
        }
    }
}

pub enum Value {
    /// A quantity of the steady state at an inclination theta of a body, computed in SIMD lanes.
    AtRest(Quantity),
    /// A function of any inputs that returns one number.
    One(fn(&[f64]) -> f64),
    /// A function with several results, of which the last input (0, 1, ...) picks one; neighbouring elements with equal
    /// other inputs share the results.
    Pick(fn(&[f64]) -> [f64; steady::MOST]),
}

pub struct ArrayFunction {
    pub name: &'static str,
    pub inputs: usize,
    pub value: Value,
}

/// The inputs and the output of one call of an inner loop.
#[derive(Clone, Copy)]
struct Loop {
    base: [*mut c_char; MOST + 1],
    step: [isize; MOST + 1],
    inputs: usize,
    count: isize,
}

impl Loop {
    /// Input `k` of element `i`, where `i < count`.
    fn get(&self, k: usize, i: isize) -> f64 {
        debug_assert!(k < self.inputs && i < self.count);
        // SAFETY: NumPy promises `count` elements `step` apart, here doubles (the type table in
        // `make`); unaligned reads need no promise about alignment.
        unsafe { self.base[k].offset(i * self.step[k]).cast::<f64>().read_unaligned() }
    }

    fn put<T>(&self, i: isize, value: T) {
        // SAFETY: as in `get`, NumPy promises the pointers; the type table gives the type of the output, which is `T`.
        unsafe {
            self.base[self.inputs].offset(i * self.step[self.inputs]).cast::<T>().write_unaligned(value)
        }
    }

    /// The part of the loop with the elements from `first` on, at most `most` of them.
    fn part(&self, first: isize, most: isize) -> Self {
        let mut part = *self;
        part.count = most.min(self.count - first);
        for k in 0..=self.inputs {
            part.base[k] = self.base[k].wrapping_offset(first * self.step[k]);
        }
        part
    }

    fn row(&self, i: isize) -> [f64; MOST] {
        core::array::from_fn(|k| if k < self.inputs { self.get(k, i) } else { 0.0 })
    }

    fn body(&self, i: isize) -> Option<Body> {
        let x = self.row(i);
        body_of(&x[self.inputs - BODY..self.inputs]).ok()
    }
}

/// NumPy's description of the caller of a loop (`PyArrayMethod_Context`); only its first field is declared here.
#[repr(C)]
struct Context {
    caller: *const PyUFuncObject,
}

/// The inner loop of every ufunc of this file. Returns 0, or -1 with Python's error set.
unsafe extern "C" fn inner(
    context: *const Context,
    args: *const *mut c_char,
    dimensions: *const npy_intp,
    steps: *const npy_intp,
    _: *mut c_void,
) -> c_int {
    // SAFETY: the caller is one of the ufuncs of `make`, which gave it a `&'static ArrayFunction` as its data, and
    // NumPy passes `inputs + 1` pointers and strides and one count.
    let (law, run) = unsafe {
        let law = &*(*(*(*context).caller).fields.data).cast::<ArrayFunction>();
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
    let done = match law.value {
        Value::AtRest(quantity) => in_parts(&run, AT_REST, |part| {
            in_lanes!(level(), simd => at_rest(simd, part, quantity), else run_one_by_one(part, quantity));
        }),
        Value::One(f) => in_parts(&run, ONE, |part| {
            for i in 0..part.count {
                part.put(i, f(&part.row(i)[..part.inputs]));
            }
        }),
        Value::Pick(f) => run_of_pick(&run, f),
    };
    // NaN is a regular result here: the floating-point flags are cleared, so that NumPy's casts do not warn
    // of it.
    if let Some(api) = API.get() {
        // SAFETY: the function changes the processor's flags and nothing else.
        unsafe { (api.clear_flags)() };
    }
    if done { 0 } else { -1 }
}

/// Approximate times of one element of each kind, in nanoseconds, by which the checks for Ctrl-C are spaced.
const AT_REST: u64 = 20;
const ONE: u64 = 200;
const PICKED: u64 = 10_000;

/// Runs a long loop in parts and checks for Ctrl-C before each part; returns whether all parts are done.
fn in_parts(run: &Loop, each: u64, work: impl Fn(&Loop)) -> bool {
    const ELEMENTS_PER_PART: isize = 1 << 10;
    for first in (0..run.count).step_by(ELEMENTS_PER_PART as usize) {
        let part = run.part(first, ELEMENTS_PER_PART);
        if !still(each * part.count as u64) {
            return false;
        }
        work(&part);
    }
    true
}

fn run_of_pick(run: &Loop, f: fn(&[f64]) -> [f64; steady::MOST]) -> bool {
    let pick = run.inputs - 1;
    let mut last = ([f64::NAN.to_bits(); MOST], f(&[f64::NAN; MOST][..pick]));
    for i in 0..run.count {
        let mut key = run.row(i);
        let asked = core::mem::replace(&mut key[pick], f64::NAN);
        let bits = key.map(f64::to_bits);
        let same = bits == last.0;
        if !still(if same { AT_REST } else { PICKED }) {
            return false;
        }
        if !same {
            last = (bits, f(&key[..pick]));
        }
        let picked = (0..steady::MOST).find(|k| *k as f64 == asked);
        run.put(i, picked.map_or(f64::NAN, |k| last.1[k]));
    }
    true
}

/// Computes one inclination after the other, without SIMD lanes.
fn run_one_by_one(run: &Loop, quantity: Quantity) {
    for i in 0..run.count {
        let theta = run.get(0, i);
        let of = run.body(i).map(|body| Column::of(&body).found(theta, quantity.wanted()));
        let value = quantity.of(of.unwrap_or_else(|| SteadyPoint::nothing(theta)));
        match quantity {
            Quantity::Region => run.put(i, value as u8),
            _ => run.put(i, value),
        }
    }
}

/// Computes eight inclinations at a time; the body is read once if it does not vary along the loop.
#[inline(always)]
fn at_rest<S: Simd>(simd: S, run: &Loop, quantity: Quantity) {
    let fixed = run.step[1..run.inputs].iter().all(|s| *s == 0) && run.count > 0;
    let load = |m: Column<[f64; LANES]>| m.map(|x| f64x8::simd_from(simd, x));
    let wanted = quantity.wanted();
    let mut of = load(Column::gather(&[if fixed { run.body(0) } else { None }; LANES]));
    for start in (0..run.count).step_by(LANES) {
        let lanes = (run.count - start).min(LANES as isize);
        if !fixed {
            let bodies: [_; LANES] =
                core::array::from_fn(
                    |i| if (i as isize) < lanes { run.body(start + i as isize) } else { None },
                );
            of = load(Column::gather(&bodies));
        }
        let theta: [f64; LANES] = core::array::from_fn(|i| run.get(0, start + (i as isize).min(lanes - 1)));
        let theta = f64x8::from_slice(simd, &theta);
        let found = of.found(theta, wanted);
        let value = quantity.of(found);
        for i in 0..lanes {
            match quantity {
                Quantity::Region => run.put(start + i, value[i as usize] as u8),
                _ => run.put(start + i, value[i as usize]),
            }
        }
    }
}

/// NumPy's description of a loop, `PyArrayMethod_Spec`.
#[repr(C)]
struct Spec {
    name: *const c_char,
    inputs: c_int,
    outputs: c_int,
    casting: NPY_CASTING,
    flags: c_int,
    dtypes: *const *mut PyObject,
    slots: *mut PyType_Slot,
}

/// NumPy's flag `NPY_METH_NO_FLOATINGPOINT_ERRORS`.
const NO_FLAGS: c_int = 1 << 1;
/// NumPy's slot `NPY_METH_strided_loop`.
const STRIDED_LOOP: c_int = 5;

/// The functions of NumPy's ufunc table that the numpy crate lacks, read from their places in the table; and
/// NumPy's types of double and uint8.
struct Api {
    clear_flags: unsafe extern "C" fn(),
    add_loop: unsafe extern "C" fn(*mut PyObject, *mut Spec) -> c_int,
    add_promoter: unsafe extern "C" fn(*mut PyObject, *mut PyObject, *mut PyObject) -> c_int,
    double: Py<PyAny>,
    byte: Py<PyAny>,
}

static API: OnceLock<Api> = OnceLock::new();

fn api(py: Python<'_>) -> PyResult<&'static Api> {
    if let Some(api) = API.get() {
        return Ok(api);
    }
    let table = py.import("numpy._core._multiarray_umath")?.getattr("_UFUNC_API")?;
    let table = table.cast::<PyCapsule>()?.pointer_checked(None)?.cast::<*const c_void>();
    let dtypes = py.import("numpy.dtypes")?;
    // SAFETY: NumPy 2, which this package requires, keeps these functions at these places (`__ufunc_api.h`).
    let found = unsafe {
        Api {
            clear_flags: table.add(27).cast().read(),
            add_loop: table.add(43).cast().read(),
            add_promoter: table.add(44).cast().read(),
            double: dtypes.getattr("Float64DType")?.unbind(),
            byte: dtypes.getattr("UInt8DType")?.unbind(),
        }
    };
    Ok(API.get_or_init(|| found))
}

/// Promotes any kinds of numbers to those of the loop; NumPy then checks whether the inputs can be cast.
unsafe extern "C" fn promote(
    ufunc: *const PyUFuncObject,
    _: *const *mut PyObject,
    _: *const *mut PyObject,
    wanted: *mut *mut PyObject,
) -> c_int {
    // SAFETY: the data are as in `inner`; NumPy calls with the GIL held and expects `inputs + 1` new references.
    unsafe {
        let (law, api) = (&*(*(*ufunc).fields.data).cast::<ArrayFunction>(), API.get());
        let Some(api) = api else { return -1 };
        let py = Python::assume_attached();
        for k in 0..=law.inputs {
            *wanted.add(k) = dtype(api, law, k).clone_ref(py).into_ptr();
        }
    }
    0
}

/// The NumPy type of input `k` of a function; the last `k` is the output.
fn dtype<'a>(api: &'a Api, law: &ArrayFunction, k: usize) -> &'a Py<PyAny> {
    let code = k == law.inputs && matches!(law.value, Value::AtRest(Quantity::Region));
    if code { &api.byte } else { &api.double }
}

pub fn make<'py>(py: Python<'py>, law: &'static ArrayFunction) -> PyResult<Bound<'py, PyAny>> {
    let api = api(py)?;
    // NumPy keeps the name and the data for as long as the ufunc lives, that is for the life of the process.
    let name = Box::leak(std::ffi::CString::new(law.name)?.into_boxed_c_str()).as_ptr();
    let data: &mut [*mut c_void] = Vec::leak(vec![core::ptr::from_ref(law).cast_mut().cast()]);
    let dtypes: Vec<_> = (0..=law.inputs).map(|k| dtype(api, law, k).as_ptr()).collect();
    let mut slots = [
        PyType_Slot { slot: STRIDED_LOOP, pfunc: inner as *mut c_void },
        PyType_Slot { slot: 0, pfunc: core::ptr::null_mut() },
    ];
    let mut spec = Spec {
        name,
        inputs: law.inputs as c_int,
        outputs: 1,
        casting: NPY_CASTING::NPY_NO_CASTING,
        flags: NO_FLAGS,
        dtypes: dtypes.as_ptr(),
        slots: slots.as_mut_ptr(),
    };
    let any = py.import("numpy")?.getattr("dtype")?;
    let kinds = PyTuple::new(py, vec![any; law.inputs + 1])?;
    let promote = core::ptr::NonNull::new(promote as *mut c_void);
    let Some(promote) = promote else { return Err(PyRuntimeError::new_err("no promoter")) };
    // SAFETY: the ufunc has no loops at first; then it gets one, described as in NumPy's header, and its promoter under
    // the name that NumPy looks for. Every result is a new reference or an error.
    unsafe {
        let ufunc = PY_UFUNC_API.PyUFunc_FromFuncAndData(
            py,
            core::ptr::null_mut(),
            data.as_mut_ptr(),
            core::ptr::null_mut(),
            0,
            law.inputs as c_int,
            1,
            -1, // `PyUFunc_None`: the ufunc has no identity and no reduction.
            name,
            c"Elementwise; see the method of spincyl.Body or spincyl.State that calls it.".as_ptr(),
            0,
        );
        let ufunc = Bound::from_owned_ptr_or_err(py, ufunc)?;
        let promoter = PyCapsule::new_with_pointer(py, promote, c"numpy._ufunc_promoter")?;
        if (api.add_loop)(ufunc.as_ptr(), &mut spec) < 0
            || (api.add_promoter)(ufunc.as_ptr(), kinds.as_ptr(), promoter.as_ptr()) < 0
        {
            return Err(PyErr::fetch(py));
        }
        Ok(ufunc)
    }
}
