//! The error type of the library. An error names the argument, its value and the accepted range.

/// The reason why a question about a body, a state, a scale or a motion has no answer.
///
/// On a grid a point without an answer is NaN with a [`Region`](crate::states::stability::Region); only a question about a
/// single body or state is answered by an error.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number lies outside the range in which it is meaningful.
    #[error("{name} = {value:?}: expected {expected}")]
    OutOfRange {
        /// The argument's name.
        name: &'static str,
        /// The value that was given.
        value: f64,
        /// The accepted range.
        expected: &'static str,
    },
    /// The moments of inertia are those of no real body.
    #[error("i3 = {i3:?}, i1 = {i1:?}: a real body satisfies i3 <= 2 i1")]
    Moments {
        /// Axial moment of inertia.
        i3: f64,
        /// Transverse moment of inertia.
        i1: f64,
    },
    /// The principal moments of inertia are those of no body.
    #[error(
        "principal moments of inertia {moments:?}: each is positive, and at most the sum of the two others"
    )]
    Inertia {
        /// The principal moments, in ascending order.
        moments: [f64; 3],
    },
    /// No steady state with the centre at rest exists: the inclination lies between the two limits.
    #[error(
        "theta = {theta:?} is forbidden: no steady state between theta_balance = {theta_balance:?} and theta_limit = {theta_limit:?}"
    )]
    Forbidden {
        /// The given inclination, in radians.
        theta: f64,
        /// The inclination at which the body balances on a point.
        theta_balance: f64,
        /// The inclination at which the rate grows without bound.
        theta_limit: f64,
    },
    /// Double precision cannot tell whether the inclination is that of a steady state or forbidden.
    #[error(
        "theta = {theta:?} is too close to theta_balance = {theta_balance:?} or theta_limit = {theta_limit:?} to decide"
    )]
    Undetermined {
        /// The given inclination, in radians.
        theta: f64,
        /// The inclination at which the body balances on a point.
        theta_balance: f64,
        /// The inclination at which the rate grows without bound.
        theta_limit: f64,
    },
    /// The fixed step is too large for the motion at that time: the answer would look right and be wrong.
    #[error(
        "step = {step:?} is too large at t = {time:?}, theta = {theta:?}: a step of {advice:.2e} would do, or tol="
    )]
    Step {
        /// The given step.
        step: f64,
        /// The time at which the step is too large.
        time: f64,
        /// The inclination at that time, in radians.
        theta: f64,
        /// A step that is small enough.
        advice: f64,
    },
    /// The motion cannot be followed from this state on: the equations lose all their digits.
    #[error("theta = {theta:?}: the motion cannot be followed from here, its equations lose their digits")]
    Lost {
        /// The inclination, in radians.
        theta: f64,
    },
    /// No contact force, or more than one, obeys Coulomb's law in this state.
    #[error("no unique contact force (Painleve): mu = {mu:?}, theta = {theta:?}; mu_P(theta) = {limit:?}")]
    Painleve {
        /// The coefficient of friction.
        mu: f64,
        /// The inclination, in radians.
        theta: f64,
        /// The smallest coefficient of friction for which this can happen at this inclination.
        limit: f64,
    },
    /// The laws of impact and friction do not determine the motion after the other rim lands.
    #[error("mu = {mu:?}: the landing of the other rim has {outcomes} consistent outcomes, not one")]
    Landing {
        /// The coefficient of friction.
        mu: f64,
        /// The number of consistent outcomes.
        outcomes: usize,
    },
    /// The phases of the motion follow each other too often for the motion to be followed so far.
    #[error(
        "slipping, rolling and the ways that dry losses resist change {count} times up to t = {time:?}: ask for times before that"
    )]
    Restless {
        /// The number of phases.
        count: usize,
        /// The time at which the last phase began.
        time: f64,
    },
    /// The motion hardly advances: the forces on the body change faster and faster.
    #[error(
        "t = {time:?}, theta = {theta:?}: the motion hardly advances from here, something changes ever faster or too often: \
         ask for times before that, for fewer or smaller losses, or for a drift"
    )]
    Endless {
        /// The time at which the motion was given up.
        time: f64,
        /// The inclination at that time, in radians.
        theta: f64,
    },
    /// The memory is too small for the request.
    #[error("too little memory: {bytes} bytes are needed at once")]
    Memory {
        /// The number of bytes that could not be allocated.
        bytes: usize,
    },
}

/// Upper bound of the bytes that small work (an exact solution, a block of work, a thread) needs at any time.
const SPARE: usize = 8 << 20;

/// Returns an error if the memory is too small for small work, whose failed allocation would abort the
/// process.
pub(crate) fn spare() -> Result<(), Error> {
    spare_for(0)
}

/// Returns an error if the memory is too small for this many bytes and for small work beside them.
pub(crate) fn spare_for(bytes: usize) -> Result<(), Error> {
    let bytes = bytes.saturating_add(SPARE);
    let mut all = Vec::<u8>::new();
    let found = all.try_reserve_exact(bytes).map_err(|_| Error::Memory { bytes });
    // Without a use of the vector the compiler would omit the allocation.
    core::hint::black_box(&all);
    found
}

/// Room for `count` elements, or an error if this allocation or a small later one would abort the process.
pub(crate) fn room<T>(count: usize) -> Result<Vec<T>, Error> {
    let bytes = count.saturating_mul(size_of::<T>());
    let mut things = Vec::new();
    things.try_reserve_exact(count).map_err(|_| Error::Memory { bytes })?;
    if bytes > SPARE / 64 {
        spare()?;
    }
    Ok(things)
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
