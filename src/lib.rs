#![doc = include_str!("../docs/rust.md")]
//!
//! # The map
//!
//! The folders of `src` are layers. Each uses only those above it in this table, and inside a layer no modules use each
//! other in a circle. The last column has the equations.
//!
//! | layer | module | contents | an equation |
//! | --- | --- | --- | --- |
//! | `numbers` | | types of numbers: single, eight in SIMD lanes, double-double, dual; sine and cosine | |
//! | `methods` | [`rk4`] | one step of the method of Runge and Kutta | y + h (k1 + 2 k2 + 2 k3 + k4)/6 |
//! | | | steps of eighth order, or stiff ones of ninth, up to an end (`flow`), roots, quadrature | |
//! | `laws` | [`body`] | moments of inertia, theta0, thetaInf, circle of contact | g = ell s - a c, h = a s + ell c + rho |
//! | | [`state`] | inclination and angular velocity, and numbers derived from them | phi' = w1/s, psi' = w3 - ct w1 |
//! | | [`scale`] | metres, kilograms and seconds | time in sqrt(R/g) |
//! | | [`newton`] | the motion under a given force | I1 w2' = I3 w1 w3 - I1 ct w1^2 - g N - h Fh |
//! | | [`loss`] | losses of energy to the contact and to the air | P = -m.w |
//! | | [`custom`] | user-defined laws, and motions under them | P = -m.w >= 0, F = mu(u) N |
//! | | [`contact`] | the contact force: [`rolling`], [`smooth`], slip; the landing of a rim | F = v' + Wf x v + z |
//! | | [`throw`] | the state in which a body leaves the hand | v_2 = J (f cos beta - sin beta) + Q |
//! | | [`topple`] | a body on its face that topples, or that a kerb stops | mu Z > a, w2 = -v Z/J |
//! | | [`steep`] | the slope on which a body slips, tips or rolls | tan(slope) = mu (k + A^2)/k, a/Z |
//! | | [`pose`] | the orientation, the contact path and the centre of the body | P' = A psi' e2 - rho theta' e_h |
//! | `states` | [`steady`] | steady states, the inclinations that have a given rate, folds and ridge of the energy | rate^2 = n A/(s (n + d A c)), n = -g |
//! | | [`stability`] | stability of steady states on a smooth table and in rolling | kappa = -dtheta''/dtheta along the lines |
//! | | [`sideways`] | the drift of a spinning body across a slope | v_y = sin(beta)/2 ((I1 A^2 + I3 L^2)/(D Om) - ...) |
//! | `motions` | [`exact`] | the solution by first integrals, at any time | dt = s^2 sqrt(J/G) dx |
//! | | [`motion`] | a motion: times, states, and the event that ends it | N > 0, F <= mu N, theta < theta_end |
//! | | [`measured`] | bodies with a size and a mass, and their motions in SI | I1 = i1/(M R^2) |
//! | | [`world`] | initial states and positions in a fixed frame, the world | q = axes(phi, theta) Rz(psi) |
//! | | [`turning`] | least spin with which a tippe top turns over or an egg rises | J = I1 w1 s + I3 w3 (ell + c) |
//! | | [`stone`] | ellipsoids with any inertia: rattlebacks, eggs | (I + r^2 - r r^T) w' = ... + r x n |
//! | | [`drift`] | slow drift along steady states, to rest | theta' = -P/E'(theta) |
//! | `many` | [`sweep`] | steady states over dense grids, on SIMD lanes and threads | |
//! | | [`ensemble`] | many motions at once, on SIMD lanes and threads | |
//! | `scene` | [`scene`] | scenes with a known answer for contact engines | |
//!
//! All layers may use `error`, and `python` uses all of them. The equations of rolling and of a smooth table share
//! `contact::reduced`:
//! J w2' = w1 (ct (k w3 - al w1) + b w3 - k w1) - g + (J'/2) w2^2.

// Without the modules for many bodies or for Python, without lanes, or with only one width of lanes, some items are not used.
#![cfg_attr(
    any(
        not(feature = "many"),
        not(feature = "python"),
        not(lanes_of_eight),
        all(target_arch = "x86_64", not(lanes_of_sixteen))
    ),
    allow(dead_code, unused_imports, unused_variables)
)]

mod error;
mod laws;
#[cfg(feature = "many")]
mod many;
mod methods;
mod motions;
mod numbers;
#[cfg(feature = "python")]
mod python;
#[cfg(feature = "scene")]
pub mod scene;
mod states;

pub use laws::{body, contact, loss, newton, pose, scale, state, steep, throw, topple};
#[cfg(feature = "many")]
pub use many::{maps as sweep, motions as ensemble};
pub use methods::rk4;
pub use motions::{exact, measured, motion, turning, world};
pub use states::{sideways, stability, steady};

#[cfg(feature = "many")]
pub mod drift {
    //! The slow drift of a body along its steady states until it comes to rest, under two different assumptions.
    //!
    //! ```text
    //! rest      theta' = -P/E'(theta),   t = -int E'/P dtheta            the centre held at rest: one line of states
    //! rolling   theta' = -F/(J kappa),   F = S_w1 a1 + S_w3 a3           no slip, no nutation: a surface of states
    //! ```
    //! *Rest* is the drift of Jackson et al., Am. J. Phys. 87, 85 (2019): the centre is held at rest, as slip does
    //! below a ridge of the energy. The body moves to lower energies: below a ridge theta decreases, above it theta
    //! grows. *Rolling* is the drift of a body that never slips. Its losses push the body off the line of states whose
    //! centre is at rest, and nothing brings it back; a ridge has no effect. The drift ends where rolling becomes
    //! unstable, at kappa = 0 ([`stability`](crate::stability)). Both drifts are of first order in the losses.
    //!
    //! Relative error of a time: 1e-12 for `at_rest`, 1e-10 for `rolling`. Up to 0.99 of the time to the end the same
    //! bounds hold for the relative errors of theta, w1 and Omega, and for the error of w3 relative to |w|. Where these
    //! numbers vary as a high power of the remaining time, the rounding of the time adds to their errors. Tests of
    //! `drift` and `test_late_drifts` check these bounds.
    //!
    //! ```
    //! use spincyl::Body;
    //! use spincyl::drift::{Drift, End};
    //! use spincyl::loss::{Law, Losses};
    //!
    //! // A coin comes down on its face.
    //! let drift = Drift::at_rest(&Body::solid(0.08)?, 0.1, &Losses::of(Law::RollingResistance, 1e-3))?;
    //! assert!(drift.ended() == End::Face && drift.theta(0.5 * drift.stops_at()) < 0.1);
    //! # Ok::<(), spincyl::Error>(())
    //! ```

    pub use crate::many::columns::{BodyColumns, LossColumns, StateColumns};
    pub use crate::many::drifts::{
        Centre, DriftAnswer, DriftOutput, DriftStarts, INVALID, Question, ask, single, stops,
    };
    pub use crate::motions::drift::{Drift, End};
}

pub mod custom {
    //! User-defined laws of loss and friction, forces and couples that drive a body, and the motions of bodies under them.
    //!
    //! ```text
    //! m(theta, w, N)     a couple along e1, e2, e3, in M g R, that takes the power -m.w >= 0
    //! F = mu(|u|) N      friction against a slip u; a contact point at rest holds up to mu_s N
    //! F, m (moment)      a horizontal force on the centre, and a couple, that may give energy
    //! ```
    //! Each law is checked at a thousand states before a motion begins. A couple has to be finite, must not supply
    //! energy, and must not jump when the motion that it resists is at rest. A law with a jump, such as dry friction,
    //! has to be rounded: tanh(x/e) in place of sgn(x). Such motions are computed more slowly than those under the laws
    //! in [`loss`](crate::loss), since nothing is known of the laws in advance.
    //!
    //! Source of the example: Armstrong-Helouvry, Dupont and Canudas de Wit, Automatica 30, 1083 (1994), for Stribeck's law.
    //!
    //! ```
    //! use spincyl::{Body, custom::Custom};
    //!
    //! // Stribeck's friction falls from 0.4 at rest to 0.2 at high speed; static friction has to be at least that at rest.
    //! let stribeck = |speed: f64| 0.2 + 0.2 * (-(speed / 0.1).powi(2)).exp();
    //! let (hoop, laws) = (Body::tube(0.0, 1.0)?, Custom::default().with_friction(&stribeck));
    //! assert!(laws.check(&hoop, 0.4).is_ok() && laws.check(&hoop, 0.3).is_err());
    //! # Ok::<(), spincyl::Error>(())
    //! ```

    pub use crate::laws::custom::{CoupleLaw, Custom, DriveLaw, FrictionLaw, Moment, Push};
    pub use crate::laws::custom_si::{InSi, MomentInSi, TurningInSi};
    pub use crate::motions::custom::{roll_stone, roll_with};
}

pub mod stone {
    //! Stones: ellipsoids with any inertia, such as a rattleback or an egg, which roll and slip.
    //!
    //! ```text
    //! D = diag(a1^2, a2^2, a3^2),   I = (i11, i22, i33, i23, i13, i12),   d = centre of mass - centre of the ellipsoid
    //! uniform    I = diag(a2^2 + a3^2, a3^2 + a1^2, a1^2 + a2^2)/5
    //! half       the lower half of an ellipsoid: d = (0, 0, -3 a3/8), the moments about d, and an edge that lands at pi/2
    //! theta      the inclination of axis 3, cos theta = n3
    //! ```
    //! Natural units: the mass, the largest semi-axis and gravity are 1. An ellipsoid is not a [`Body`](crate::Body),
    //! which is a body of revolution with three first integrals. A stone has only one, the energy, so that its motion
    //! is always integrated. [`roll`] computes rolling and slipping, [`rolling`] the motion of a stone that always
    //! rolls, and [`Rocking`] the small oscillations of a stone that spins upright.
    //!
    //! Sources: Walker, Sci. Am. 241(4), 172 (1979); Kane and Levinson, Int. J. Non-Linear Mech. 17, 175 (1982); Moffatt and
    //! Shimomura, Nature 416, 385 (2002), for the rising egg.
    //!
    //! ```
    //! use spincyl::Ellipsoid;
    //!
    //! let stone = Ellipsoid::uniform([1.0, 0.5, 0.5])?;
    //! assert!((stone.moments()[0] - 0.1).abs() < 1e-15); // (a2^2 + a3^2)/5
    //! assert!((stone.lowest_point([0.0, 0.0, 1.0])[2] + 0.5).abs() < 1e-15);
    //! # Ok::<(), spincyl::Error>(())
    //! ```

    pub use crate::laws::stone::{Ellipsoid, StonePose, StoneState};
    #[cfg(feature = "many")]
    pub use crate::many::stones::{StoneJob, StoneRow, StoneSummary, Turns, many};
    pub use crate::motions::stone::{RollingStone, roll, rolling};
    pub use crate::states::rocking::Rocking;
}

/// The example of the README runs as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}

/// nalgebra, in the version that this crate uses: its matrices, vectors and quaternions appear in poses and forces.
pub use nalgebra;

pub use body::Body;
pub use contact::{Contact, rolling, smooth};
pub use error::Error;
pub use laws::stone::Ellipsoid;
pub use measured::Measured;
pub use motion::{Motion, roll};
pub use scale::Scale;
pub use state::{Slip, State};
