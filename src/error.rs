//! The error type of the library. An error names the argument, its value and the accepted range.

/// The reason why a quantity of a body, a state, a scale or a motion cannot be computed.
///
/// Only functions of a single body or state return an error. On a grid the value is NaN, and a
/// [`Region`](crate::states::stability::Region) gives the reason.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number lies outside the range in which it is meaningful.
    #[error("{name} = {value:?}: expected {expected}")]
    OutOfRange {
        /// Name of the argument.
        name: &'static str,
        /// Value of the argument.
        value: f64,
        /// The accepted range.
        expected: &'static str,
    },
    /// The moments of inertia are impossible for a real body.
    #[error("i3 = {i3:?}, i1 = {i1:?}: expected i3 <= 2 i1, as for every real body")]
    Moments {
        /// Axial moment of inertia.
        i3: f64,
        /// Transverse moment of inertia.
        i1: f64,
    },
    /// The principal moments of inertia are impossible for a body.
    #[error(
        "principal moments of inertia {moments:?}: expected each to be positive and at most the sum of the other two"
    )]
    Inertia {
        /// The principal moments, in ascending order.
        moments: [f64; 3],
    },
    /// No steady state with the centre at rest exists: the inclination lies between theta_balance and theta_limit.
    #[error(
        "theta = {theta:?} is forbidden: no steady state between theta_balance = {theta_balance:?} and theta_limit = {theta_limit:?}"
    )]
    Forbidden {
        /// The given inclination, in radians.
        theta: f64,
        /// The inclination at which the body balances on a point of its rim, in radians.
        theta_balance: f64,
        /// The inclination at which the rate of a steady state grows without bound, in radians.
        theta_limit: f64,
    },
    /// Double precision cannot tell whether the inclination is that of a steady state or forbidden.
    #[error(
        "theta = {theta:?} is too close to theta_balance = {theta_balance:?} or theta_limit = {theta_limit:?} to decide whether it has a steady state"
    )]
    Undetermined {
        /// The given inclination, in radians.
        theta: f64,
        /// The inclination at which the body balances on a point of its rim, in radians.
        theta_balance: f64,
        /// The inclination at which the rate of a steady state grows without bound, in radians.
        theta_limit: f64,
    },
    /// The fixed step of an RK4 motion is too long at the time `time`: the result would be plausible but wrong.
    #[error(
        "step = {step:?} is too large at t = {time:?}, theta = {theta:?}: use a step of {advice:.2e}, or tol="
    )]
    Step {
        /// The given length of a fixed step.
        step: f64,
        /// The time at which the step is too long.
        time: f64,
        /// The inclination at that time, in radians.
        theta: f64,
        /// The length of a step that is short enough.
        advice: f64,
    },
    /// The motion cannot be computed from this state on: rounding errors outweigh the terms of the equations.
    #[error(
        "theta = {theta:?}: rounding errors outweigh the motion here, so it cannot be continued: give earlier times or another state"
    )]
    Lost {
        /// The inclination from which the motion cannot be continued, in radians.
        theta: f64,
    },
    /// No contact force, or more than one, obeys Coulomb's law in this state.
    #[error(
        "mu = {mu:?}: no unique contact force (Painleve) at theta = {theta:?}; the force is unique below mu_P(theta) = {limit:?}"
    )]
    Painleve {
        /// The coefficient of friction.
        mu: f64,
        /// The inclination, in radians.
        theta: f64,
        /// mu_P(theta), the smallest coefficient of friction with which a slip at this inclination may have no unique
        /// contact force.
        limit: f64,
    },
    /// The laws of impact and friction do not determine a unique motion after the other rim lands.
    #[error(
        "mu = {mu:?}: the laws of impact and friction allow {outcomes} outcomes of the landing of the other rim, not one"
    )]
    Landing {
        /// The coefficient of friction.
        mu: f64,
        /// The number of outcomes that obey the laws.
        outcomes: usize,
    },
    /// A user-defined couple is not finite, or supplies energy, in a state during a motion.
    #[error("couple: power = {power:?} at theta = {theta:?}, w = {w:?}, N = {normal:?}: expected {expected}")]
    Couple {
        /// The power that the couple takes, -m.w, in M g sqrt(g R); NaN if the couple is not finite.
        power: f64,
        /// The condition that a couple has to meet.
        expected: &'static str,
        /// The inclination, in radians.
        theta: f64,
        /// The angular velocity along e1, e2, e3, in sqrt(g/R).
        w: [f64; 3],
        /// The normal force, in M g.
        normal: f64,
    },
    /// A user-defined coefficient of friction is negative or not finite at a speed of slip during a motion.
    #[error("mu = {mu:?} at the speed {speed:?}: expected {expected}")]
    Coefficient {
        /// The coefficient of friction.
        mu: f64,
        /// The condition that a coefficient of friction has to meet.
        expected: &'static str,
        /// The speed of the slip, in sqrt(g R).
        speed: f64,
    },
    /// Time hardly advances, because the forces on the body change faster and faster.
    #[error(
        "t = {time:?}, theta = {theta:?}: the motion hardly advances from here, because forces change ever faster: \
         give only times before that, use fewer or smaller losses, or compute a drift"
    )]
    Endless {
        /// The time at which the computation stopped.
        time: f64,
        /// The inclination at that time, in radians.
        theta: f64,
    },
    /// The error of the motion is too large to decide whether a body with this spin turns over or rises.
    #[error(
        "spin = {spin:?}: the estimated error of the motion, {error:.1e}, is too large to tell whether the body turns over or rises: give a shorter time t"
    )]
    Undecided {
        /// The spin for which the search could not decide, in the unit of the result of the search.
        spin: f64,
        /// The estimated error of the motion.
        error: f64,
    },
    /// The memory does not suffice for the request.
    #[error("too little memory: {bytes} bytes are needed at once; compute fewer times or motions")]
    Memory {
        /// The number of bytes that could not be allocated.
        bytes: usize,
    },
}

/// Upper bound of the bytes that small work (an exact solution, a block of work, a thread) needs at any time.
const SPARE_BYTES: usize = 8 << 20;

/// Returns an error if the memory does not suffice for small work, whose failed allocation would abort the process.
pub(crate) fn spare() -> Result<(), Error> {
    spare_for(0)
}

/// Returns an error if the memory does not suffice for this many bytes together with small work.
pub(crate) fn spare_for(bytes: usize) -> Result<(), Error> {
    let bytes = bytes.saturating_add(SPARE_BYTES);
    let mut all = Vec::<u8>::new();
    let found = all.try_reserve_exact(bytes).map_err(|_| Error::Memory { bytes });
    // Without a use of the vector the compiler would omit the allocation.
    core::hint::black_box(&all);
    found
}

/// Space for `count` elements, or an error if this allocation or a small later one would abort the process.
pub(crate) fn room<T>(count: usize) -> Result<Vec<T>, Error> {
    let bytes = count.saturating_mul(size_of::<T>());
    let mut things = Vec::new();
    things.try_reserve_exact(count).map_err(|_| Error::Memory { bytes })?;
    if bytes > SPARE_BYTES / 64 {
        spare()?;
    }
    Ok(things)
}

/// Adds an element to a list, or returns an error if the memory does not suffice.
pub(crate) fn grow<T>(list: &mut Vec<T>, thing: T) -> Result<(), Error> {
    let bytes = (2 * list.len() + 1).saturating_mul(size_of::<T>());
    list.try_reserve(1).map_err(|_| Error::Memory { bytes })?;
    list.push(thing);
    Ok(())
}

/// A copy of the elements, or the error of [`room`].
pub(crate) fn copied<T: Copy>(things: &[T]) -> Result<Vec<T>, Error> {
    let mut copy = room(things.len())?;
    copy.extend_from_slice(things);
    Ok(copy)
}

/// Returns `value` if it lies in `[low, high]`, otherwise (also for NaN) the error with this name.
pub(crate) fn within(
    name: &'static str,
    value: f64,
    (low, high): (f64, f64),
    expected: &'static str,
) -> Result<f64, Error> {
    if low <= value && value <= high { Ok(value) } else { Err(Error::OutOfRange { name, value, expected }) }
}
