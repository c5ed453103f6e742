//! The one error: a question that has no answer, said with its name, its value and what would do.

/// Why a body, a state or a scale cannot be made.
///
/// On a grid such a point is NaN with a [`Region`](crate::stability::Region); only a
/// question about a single body or state is answered by an error.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Error {
    /// A number lies outside the range in which it means something.
    #[error("{name} = {value:?}: expected {expected}")]
    OutOfRange {
        /// The argument's name.
        name: &'static str,
        /// The value that was given.
        value: f64,
        /// The range that would have done.
        expected: &'static str,
    },
    /// The moments of inertia of no real body.
    #[error("i3 = {i3:?}, i1 = {i1:?}: a real body satisfies i3 <= 2 i1")]
    Moments {
        /// Axial moment of inertia.
        i3: f64,
        /// Transverse moment of inertia.
        i1: f64,
    },
    /// No steady state with the centre at rest: the inclination lies between the two limits.
    #[error(
        "theta = {theta:?} is forbidden: no steady state between theta_balance = {theta_balance:?} and theta_limit = {theta_limit:?}"
    )]
    Forbidden {
        /// The inclination asked for, in radians.
        theta: f64,
        /// The inclination at which the body balances on a point.
        theta_balance: f64,
        /// The inclination at which the rate grows without bound.
        theta_limit: f64,
    },
    /// The inclination is a steady state or a forbidden one: double precision cannot tell.
    #[error(
        "theta = {theta:?} is too close to theta_balance = {theta_balance:?} or theta_limit = {theta_limit:?} to decide"
    )]
    Undetermined {
        /// The inclination asked for, in radians.
        theta: f64,
        /// The inclination at which the body balances on a point.
        theta_balance: f64,
        /// The inclination at which the rate grows without bound.
        theta_limit: f64,
    },
    /// The fixed step is too large for what happens at that moment: its answer would look right and be wrong.
    #[error(
        "step = {step:?} is too large at t = {time:?}, theta = {theta:?}: a step of {advice:.2e} would do, or tol="
    )]
    Step {
        /// The step asked for.
        step: f64,
        /// When it is too large.
        time: f64,
        /// The inclination then, in radians.
        theta: f64,
        /// A step that would do.
        advice: f64,
    },
    /// This motion cannot be followed from here: the equations lose all their digits.
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
        /// The coefficient of friction from which on this can happen at this inclination.
        limit: f64,
    },
    /// The laws of impact and friction do not say what happens when the other rim lands.
    #[error("mu = {mu:?}: the landing of the other rim has {outcomes} consistent outcomes, not one")]
    Landing {
        /// The coefficient of friction.
        mu: f64,
        /// How many outcomes are consistent.
        outcomes: usize,
    },
    /// Phases follow each other too often to be followed that far.
    #[error(
        "slipping, rolling and the ways that dry losses resist change {count} times up to t = {time:?}: ask for times before that"
    )]
    Restless {
        /// How many phases there were.
        count: usize,
        /// When the last of them began.
        time: f64,
    },
    /// The motion hardly advances: what acts on it changes faster and faster.
    #[error(
        "t = {time:?}, theta = {theta:?}: the motion hardly advances from here, something changes ever faster or too often: \
         ask for times before that, for fewer or smaller losses, or for a drift"
    )]
    Endless {
        /// When it was given up.
        time: f64,
        /// The inclination then, in radians.
        theta: f64,
    },
    /// There is too little memory for what was asked.
    #[error("too little memory: {bytes} bytes are needed at once")]
    Memory {
        /// The size of what could not be had.
        bytes: usize,
    },
}

/// What is small (an exact solution, a block of work, a thread) needs less than this at any time.
const SPARE: usize = 8 << 20;

/// An error if there is too little memory for what is small, where it would abort the process.
pub(crate) fn spare() -> Result<(), Error> {
    spare_for(0)
}

/// The same for what is small beside so many bytes.
pub(crate) fn spare_for(bytes: usize) -> Result<(), Error> {
    let bytes = bytes.saturating_add(SPARE);
    let mut all = Vec::<u8>::new();
    let found = all.try_reserve_exact(bytes).map_err(|_| Error::Memory { bytes });
    // what nobody looks at the compiler does not ask for
    core::hint::black_box(&all);
    found
}

/// Room for `count` things, or an error where the process would be aborted: now, or later by something small.
pub(crate) fn room<T>(count: usize) -> Result<Vec<T>, Error> {
    let bytes = count.saturating_mul(size_of::<T>());
    let mut things = Vec::new();
    things.try_reserve_exact(count).map_err(|_| Error::Memory { bytes })?;
    if bytes > SPARE / 64 {
        spare()?;
    }
    Ok(things)
}

/// A copy, or the error of [`room`].
pub(crate) fn copied<T: Copy>(things: &[T]) -> Result<Vec<T>, Error> {
    let mut copy = room(things.len())?;
    copy.extend_from_slice(things);
    Ok(copy)
}

/// `value` if it lies in `[low, high]`, the named error otherwise (also for NaN).
pub(crate) fn within(
    name: &'static str,
    value: f64,
    (low, high): (f64, f64),
    expected: &'static str,
) -> Result<f64, Error> {
    if low <= value && value <= high { Ok(value) } else { Err(Error::OutOfRange { name, value, expected }) }
}
