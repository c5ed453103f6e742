//! User-defined laws in metres, kilograms and seconds.
//!
//! ```text
//! F(m/s) -> mu        a coefficient of friction at a speed
//! m(theta, w, N)      a couple in N m along e1, e2, e3, from rad/s and newtons
//! F, m(t, ...)        a force in N and a couple in N m that drive a body
//! ```
//! Error: a few roundings of the conversions.

use super::body::Body;
use super::custom::{CoupleLaw, DriveLaw, FrictionLaw, Moment, Push};
use super::scale::Scale;
use super::state::{Slip, State};
use nalgebra::{Matrix3, Point2, Vector2, Vector3};

/// Inclination, angular velocity and normal force of a body, in SI: the argument of a couple in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct TurningInSi {
    /// The inclination in radians.
    pub theta: f64,
    /// The angular velocity along e1, e2, e3, in rad/s.
    pub w: Vector3<f64>,
    /// The normal force in newtons; 0 in the air.
    pub normal: f64,
}

/// A [`Moment`] in SI: the argument of a drive in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct MomentInSi {
    /// The time in seconds.
    pub time: f64,
    /// The inclination in radians.
    pub theta: f64,
    /// The angular velocity along e1, e2, e3, in rad/s.
    pub w: Vector3<f64>,
    /// The slip of the contact point in m/s.
    pub slip: Slip,
    /// The direction phi to which the axis leans, in radians from x to y.
    pub phi: f64,
    /// The angle psi by which the body has turned about its axis, in radians.
    pub psi: f64,
    /// The place of the contact point in metres.
    pub contact_point: Point2<f64>,
    /// The height of the lowest point in metres; 0 on the table.
    pub height: f64,
    /// The velocity of the centre of mass along x and y, in m/s.
    pub velocity: Vector2<f64>,
    /// The axes e1, e2, e3 as columns ([`Moment::axes`]).
    pub axes: Matrix3<f64>,
}

/// A law in SI, for a body of this scale. It is a [`FrictionLaw`] if `law` is a function of a speed in m/s, a
/// [`CoupleLaw`] if it is a function of a [`TurningInSi`], which returns a couple along e1, e2, e3 in N m, and a
/// [`DriveLaw`] if it is a function of a [`MomentInSi`], which returns a force in N and a couple in N m as a [`Push`].
///
/// ```
/// use spincyl::contact::Friction;
/// use spincyl::custom::{Custom, InSi, TurningInSi};
/// use spincyl::measured::{Measured, Tube};
/// use spincyl::motion::Ask;
/// use spincyl::steady;
///
/// let coin = Measured::tube(&Tube::solid(24e-3, 2e-3, 8e-3))?;
/// // Friction that falls from 0.4 at rest to 0.2 at some 0.1 m/s, and air that takes 2e-8 N m s of each rotation.
/// let stribeck = InSi::new(coin.scale(), |speed: f64| 0.2 + 0.2 * (-(speed / 0.1).powi(2)).exp());
/// let air = InSi::new(coin.scale(), |of: &TurningInSi| -2e-8 * of.w);
/// let laws = Custom::default().with_friction(&stribeck).with_couple(&air);
/// let (start, ask) = (steady::state(coin.body(), 1.2)?, Ask::on(Friction::coulomb(0.4)));
/// let motion = coin.roll_under(start, &[0.0, 0.5], &ask, laws, || true)?.unwrap();
/// let energies: Vec<f64> = motion.readings().map(|now| now.energy).collect();
/// assert!(energies[1] < energies[0]);
/// # Ok::<(), spincyl::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct InSi<L> {
    scale: Scale,
    law: L,
}

impl<L> InSi<L> {
    /// A law in SI for a body with this scale.
    pub fn new(scale: &Scale, law: L) -> Self {
        Self { scale: *scale, law }
    }
}

impl<L: Fn(f64) -> f64> FrictionLaw for InSi<L> {
    fn coefficient(&self, speed: f64) -> f64 {
        (self.law)(self.scale.metres_per_second(speed))
    }
}

impl<L: Fn(&TurningInSi) -> Vector3<f64>> CoupleLaw for InSi<L> {
    fn couple(&self, _: &Body, y: &State, normal: f64) -> [f64; 3] {
        let w = y.angular_velocity().map(|w| self.scale.radians_per_second(w));
        let turning = TurningInSi { theta: y.theta, w, normal: self.scale.newtons(normal) };
        (self.law)(&turning).map(|m| self.scale.couple(m)).into()
    }
}

impl<L: Fn(&MomentInSi) -> Push> DriveLaw for InSi<L> {
    fn push(&self, _: &Body, now: &Moment) -> Push {
        let (scale, speed) = (&self.scale, |u: f64| self.scale.metres_per_second(u));
        let push = (self.law)(&MomentInSi {
            time: scale.seconds(now.time),
            theta: now.state.theta,
            w: now.state.angular_velocity().map(|w| scale.radians_per_second(w)),
            slip: now.slip.map(speed),
            phi: now.phi,
            psi: now.psi,
            contact_point: now.contact_point.map(|x| scale.metres(x)),
            height: scale.metres(now.height),
            velocity: now.velocity.map(speed),
            axes: now.axes(),
        });
        Push { force: push.force.map(|f| scale.force(f)), couple: push.couple.map(|m| scale.couple(m)) }
    }
}
