//! The state vector of a motion that slips or loses energy, and the reasons for which its integration halts.
//!
//! ```text
//! y = (s, c, w1, w2, w3, u_h, u_2, t, heat; phi, psi, x, y; lost)
//! pose and lost energy only if they are computed
//! ```

use crate::laws::body::Rim;
use crate::numbers::Real;
use core::f64::consts::PI;

/// The reason for which the integration of a phase halts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Halt {
    /// The integration has reached the last time.
    Time,
    /// The integration has taken the largest number of steps that its caller allows.
    Pause,
    /// The contact point comes to rest on the table.
    Standstill,
    Face,
    Side,
    LiftOff,
    /// No unique contact force exists.
    Jam,
    /// Rolling needs more friction than mu N.
    Slips,
    /// The contact point stops along the rim, or a held contact point begins to move.
    Contour,
    /// The drilling stops, or begins.
    Drilling,
    /// The rocking of a body that only rocks changes its direction.
    Rocking,
    /// A couple that grows with psi' has almost stopped the contact point (see `dry::settled`).
    Settles,
    /// The body no longer rolls or rocks; it may drill.
    Rests,
    /// A ball has passed its pole, nearer than steps resolve.
    Pole,
    /// One rim of a lying body rises: the other rim, or the rim from which the state is seen.
    Rises,
    Changes,
    /// The slip of the other rim of a lying body comes to rest.
    OtherStandstill,
    /// A lying body that pivots about one rim has stopped turning.
    Turned,
    /// A body on its face topples.
    Topples,
    /// Time hardly advances, or the steps are too many.
    Endless,
}

/// Number of margins of a motion: functions of the state whose zeros end a phase.
pub(crate) const MARGINS: usize = 6;
/// Index of sin(theta) in the state vector of a body's motion; the other components follow. `TIME` is also that of a
/// stone.
pub(crate) const SIN: usize = 0;
pub(crate) const COS: usize = 1;
pub(crate) const W1: usize = 2;
pub(crate) const W2: usize = 3;
pub(crate) const W3: usize = 4;
pub(crate) const UH: usize = 5;
pub(crate) const U2: usize = 6;
pub(crate) const TIME: usize = 7;
pub(crate) const HEAT: usize = 8;
pub(crate) const PHI: usize = 9;
pub(crate) const PSI: usize = 10;
pub(crate) const X: usize = 11;
pub(crate) const Y: usize = 12;
/// Index of the variable that replaces w1 in some phases: p = w1 sin(theta), or w_z where the contact point is held.
pub(crate) const P: usize = 2;

/// The rates of phi, psi and the place (x, y) of a contact point that moves over the table along e_h and e2, from the sine and
/// cosine of phi.
#[inline(always)]
pub(crate) fn pose_rates(
    (sin, cos): (f64, f64),
    [precession, spin]: [f64; 2],
    [out, on]: [f64; 2],
) -> [f64; 4] {
    [precession, spin, out * cos - on * sin, out * sin + on * cos]
}

/// The time derivatives of cos phi, sin phi and x of a contact point that moves with the velocity `out` along e_h and
/// `on` along e2, for the SIMD code.
#[inline(always)]
pub(crate) fn heading_rates<T: Real>([cos, sin]: [T; 2], precession: T, [out, on]: [T; 2]) -> [T; 3] {
    [-(precession * sin), precession * cos, out * cos - on * sin]
}

/// A body whose sin(phi) is at most this leans straight up or down the slope: no double is exactly pi, and a lean
/// uphill is unstable in phi.
const UP_OR_DOWN: f64 = 2.0 * f64::EPSILON;

/// The component of gravity along a table whose slope has the tangent `tilt`, along e_h and e2; 0 if the state vector
/// has no pose.
#[inline(always)]
pub(crate) fn pull<const N: usize>(tilt: f64, y: &[f64; N]) -> [f64; 2] {
    if !poses(N) || tilt == 0.0 {
        return [0.0; 2];
    }
    pull_along(tilt, y[PHI].sin_cos())
}

/// The component of gravity along a table whose slope has the tangent `tilt`, along e_h and e2, from the sine and
/// cosine of phi.
#[inline(always)]
pub(crate) fn pull_along(tilt: f64, (sin, cos): (f64, f64)) -> [f64; 2] {
    [tilt * cos, if sin.abs() <= UP_OR_DOWN { 0.0 } else { -(tilt * sin) }]
}

/// The velocity, along e_h and e2, of a turntable with the rate `turning` at the contact point; `heading` is the sine
/// and cosine of phi.
#[inline(always)]
pub(crate) fn carried<const N: usize>(turning: f64, y: &[f64; N], heading: (f64, f64)) -> [f64; 2] {
    carried_at(turning, heading, [y[X], y[Y]])
}

/// The velocity, along e_h and e2, of a turntable with the rate `turning` at the point (x, y), from the sine and
/// cosine of phi.
#[inline(always)]
pub(crate) fn carried_at(turning: f64, (sin, cos): (f64, f64), [x, y]: [f64; 2]) -> [f64; 2] {
    [turning * (x * sin - y * cos), turning * (x * cos + y * sin)]
}

/// The velocity at which the point of contact moves over the table, along e_h and e2.
#[inline(always)]
pub(crate) fn contact_velocity<T: Real>(
    rim: &Rim<T>,
    angle: (T, T),
    w2: T,
    spin: T,
    [u_h, u_2]: [T; 2],
) -> [T; 2] {
    [u_h + rim.rho * w2, u_2 + rim.radius(angle) * spin]
}

/// The sum of two vectors.
#[inline(always)]
pub(crate) fn sum([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a + c, b + d]
}

/// Adds the acceleration by a turntable to the acceleration `pull_h`, `pull_2` along e_h and e2, for a contact point
/// that moves with the velocity `out` along e_h and `on` along e2.
#[inline(always)]
pub(crate) fn driven(turning: f64, [pull_h, pull_2]: [f64; 2], [out, on]: [f64; 2]) -> [f64; 2] {
    [pull_h + turning * on, pull_2 - turning * out]
}

/// If s = sin(theta) is negative, the axis of a ball has passed the vertical: changes the signs of s, w1, w2 and the
/// slip, since the ball leans to the other side. Returns whether it has.
pub(crate) fn leans_over<const N: usize>(y: &mut [f64; N]) -> bool {
    let over = y[SIN] < 0.0;
    if over {
        [SIN, W1, W2, UH, U2].into_iter().for_each(|i| y[i] = -y[i]);
        if poses(N) {
            (y[PHI], y[PSI]) = (y[PHI] + PI, y[PSI] - PI);
        }
    }
    over
}

/// Parts of the state vector of a body's motion.
pub(crate) trait BodyNumbers<T> {
    /// Sine and cosine of theta.
    fn angle(&self) -> (T, T);
    /// The angular velocity along e1, e2, e3.
    fn w(&self) -> [T; 3];
    /// The velocity of the slip along e_h and e2.
    fn slip(&self) -> [T; 2];
}

impl<T: Copy, const N: usize> BodyNumbers<T> for [T; N] {
    #[inline(always)]
    fn angle(&self) -> (T, T) {
        (self[SIN], self[COS])
    }
    #[inline(always)]
    fn w(&self) -> [T; 3] {
        [self[W1], self[W2], self[W3]]
    }
    #[inline(always)]
    fn slip(&self) -> [T; 2] {
        [self[UH], self[U2]]
    }
}

/// Whether a state vector with `count` components ends with the lost energy.
pub(crate) const fn loses(count: usize) -> bool {
    count == 10 || count == 14
}

/// The lost energy in the state vector; 0 if it is not computed.
pub(crate) fn lost<const N: usize>(y: &[f64; N]) -> f64 {
    if loses(N) { y[N - 1] } else { 0.0 }
}

/// Whether a state vector with `count` components contains the pose, from index 9 on.
pub(crate) const fn poses(count: usize) -> bool {
    count >= 13
}
