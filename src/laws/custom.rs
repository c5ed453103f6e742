//! User-defined laws of loss and friction, forces and couples that drive a body, and the check of each law before a motion
//! begins.

use super::body::Body;
use super::state::{Slip, State};
use crate::error::{Error, within};
use core::f64::consts::PI;
use nalgebra::{Matrix3, Point2, Vector2, Vector3};

/// A loss law: a couple on the body that takes energy.
///
/// A closure `|body: &Body, y: &State, normal: f64| -> [f64; 3]` is such a law.
pub trait CoupleLaw {
    /// The couple along e1, e2, e3, in M g R, in a state and with a normal force in M g (never negative). The couple
    /// has to be continuous, and zero when the motion that it resists is at rest.
    fn couple(&self, body: &Body, y: &State, normal: f64) -> [f64; 3];

    /// Whether the law has failed and has no more values. A motion then ends at the present time, like one that is interrupted.
    fn has_failed(&self) -> bool {
        false
    }
}

impl<F: Fn(&Body, &State, f64) -> [f64; 3]> CoupleLaw for F {
    fn couple(&self, body: &Body, y: &State, normal: f64) -> [f64; 3] {
        self(body, y, normal)
    }
}

/// A law of friction: a coefficient that depends on the speed of the slip.
///
/// A closure `|speed: f64| -> f64` is such a law.
pub trait FrictionLaw {
    /// The coefficient of friction mu >= 0 at the speed >= 0 of the slip, in sqrt(g R).
    fn coefficient(&self, speed: f64) -> f64;

    /// Whether the law has failed and has no more values. A motion then ends at the present time, like one that is interrupted.
    fn has_failed(&self) -> bool {
        false
    }
}

impl<F: Fn(f64) -> f64> FrictionLaw for F {
    fn coefficient(&self, speed: f64) -> f64 {
        self(speed)
    }
}

/// Position and velocity of a driven body at a time: the argument of a [`DriveLaw`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Moment {
    /// The time, in sqrt(R/g).
    pub time: f64,
    /// The inclination and the angular velocity along e1, e2, e3; for a body with two rims they refer to the lower one.
    pub state: State,
    /// The slip, in sqrt(g R); 0 where the body rolls. In the air it is the velocity of the lowest point over the table.
    pub slip: Slip,
    /// The direction phi to which the axis leans, in radians from x to y.
    pub phi: f64,
    /// The angle psi by which the body has turned about its axis, in radians.
    pub psi: f64,
    /// The contact point on the table in R; for a body in the air, the point below its lowest point.
    pub contact_point: Point2<f64>,
    /// The height of the lowest point, in R; 0 on the table.
    pub height: f64,
    /// The velocity of the centre of mass along x and y, in sqrt(g R).
    pub velocity: Vector2<f64>,
}

impl Moment {
    /// The axes e1, e2, e3 along x, y and the upward z, as the columns of a rotation: it turns a vector along e1, e2, e3
    /// into one along x, y, z, and its transpose turns it back. e1 and e2 follow the lean, not the turn psi.
    ///
    /// ```text
    /// e1 = cos(theta) h + sin(theta) z,   e2 = z x h,   e3 = -sin(theta) h + cos(theta) z,   h = (cos(phi), sin(phi), 0)
    /// ```
    pub fn axes(&self) -> Matrix3<f64> {
        let ((s, c), (sin, cos)) = (self.state.theta.sin_cos(), self.phi.sin_cos());
        Matrix3::new(c * cos, -sin, -s * cos, c * sin, cos, -s * sin, s, 0.0, c)
    }
}

/// A horizontal force on the centre of mass of a body, and a couple, with which a [`DriveLaw`] drives the body.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Push {
    /// The force along x and y of the table, in M g.
    pub force: Vector2<f64>,
    /// The couple along e1, e2, e3, in M g R.
    pub couple: Vector3<f64>,
}

impl Push {
    /// A push with this force along x and y, in M g, and this couple along e1, e2, e3, in M g R.
    pub fn new(force: Vector2<f64>, couple: Vector3<f64>) -> Self {
        Self { force, couple }
    }
}

/// A force and a couple that act on a body in addition to gravity and the table: a motor, a wind, a hand. They may give
/// or take energy.
///
/// A closure `|body: &Body, now: &Moment| -> Push` is such a law.
pub trait DriveLaw {
    /// The force and the couple in the state `now`. They have to be finite, and without jumps.
    fn push(&self, body: &Body, now: &Moment) -> Push;

    /// Whether the law has failed and has no more values. A motion then ends at the present time, like one that is interrupted.
    fn has_failed(&self) -> bool {
        false
    }
}

impl<F: Fn(&Body, &Moment) -> Push> DriveLaw for F {
    fn push(&self, body: &Body, now: &Moment) -> Push {
        self(body, now)
    }
}

/// The law of sliding friction in an impact. The type `()` means a constant coefficient of friction, and costs no code.
pub(crate) trait SpeedLaw: Copy {
    /// Whether the coefficient of friction depends on the speed of the slip.
    #[inline(always)]
    fn varies(&self) -> bool {
        false
    }

    /// The coefficient of friction at this speed of the slip; not used if it does not vary.
    #[inline(always)]
    fn coefficient_at(&self, _speed: f64) -> f64 {
        f64::NAN
    }
}

impl SpeedLaw for () {}

/// The user-defined laws of a motion; by default there are none.
#[derive(Clone, Copy, Default)]
#[non_exhaustive]
pub struct Custom<'a> {
    /// A couple on the body in addition to the losses of [`Ask`](crate::motion::Ask).
    pub couple: Option<&'a dyn CoupleLaw>,
    /// The coefficient of sliding friction as a function of speed, in place of the constant one of the contact.
    pub friction: Option<&'a dyn FrictionLaw>,
    /// A force and a couple that drive the body; they may give energy.
    pub drive: Option<&'a dyn DriveLaw>,
}

impl<'a> Custom<'a> {
    /// Returns these laws with this couple, which takes energy.
    #[must_use]
    pub fn with_couple(self, couple: &'a dyn CoupleLaw) -> Self {
        Self { couple: Some(couple), ..self }
    }

    /// Returns these laws with this law for the coefficient of sliding friction.
    #[must_use]
    pub fn with_friction(self, friction: &'a dyn FrictionLaw) -> Self {
        Self { friction: Some(friction), ..self }
    }

    /// Returns these laws with this force and couple that drive the body.
    #[must_use]
    pub fn with_drive(self, drive: &'a dyn DriveLaw) -> Self {
        Self { drive: Some(drive), ..self }
    }

    /// Whether any of the laws has failed.
    pub fn has_failed(&self) -> bool {
        self.couple.is_some_and(CoupleLaw::has_failed)
            || self.friction.is_some_and(FrictionLaw::has_failed)
            || self.drive.is_some_and(DriveLaw::has_failed)
    }

    /// Checks the laws at about a thousand states and speeds; `fixed` is the coefficient of static friction.
    ///
    /// # Errors
    /// `OutOfRange` with the name "couple" if the couple supplies energy, is not finite, or jumps when the motion is
    /// at rest; with the name "mu" if the coefficient of friction is negative, is not finite or jumps; with the name
    /// "static" if the coefficient at rest exceeds that of static friction (`fixed`).
    pub fn check(&self, body: &Body, fixed: f64) -> Result<(), Error> {
        self.couple.map_or(Ok(()), |law| check_couple(law, body))?;
        self.check_friction(fixed)
    }

    /// Checks the law of friction alone, as [`check`](Self::check) does; `fixed` is the coefficient of static friction.
    pub(crate) fn check_friction(&self, fixed: f64) -> Result<(), Error> {
        self.friction.map_or(Ok(()), |law| check_friction(law, fixed))
    }
}

/// The check evaluates a law near rest at this share of a speed.
const NEAR_REST_SHARE: f64 = 1e-9;
/// A change of a law between neighbouring states by more than this share of its size is a jump.
const JUMP_SHARE: f64 = 1e-3;
/// By rounding, a couple may supply this share of its power, and static friction may be smaller than mu(0) by this share.
const POWER_ROUNDING: f64 = 1e-12;

/// The conditions on a couple and on a coefficient of friction, as errors name them.
const FINITE: &str = "a couple that is finite in every state";
const EXPECTED_TO_LOSE: &str = "a couple that takes energy, m.w <= 0";
/// The condition on a drive; such an error gives the time, which a slope rescales.
pub(crate) const DRIVE_FINITE: &str = "a drive whose force and couple are finite at this time";
const AT_LEAST_0: &str = "a coefficient of friction of 0 or more at every speed";

/// The error of a couple that is not finite, or supplies energy, in the state `y`; None for a valid couple.
pub(crate) fn fault_of_couple(m: [f64; 3], y: &State, normal: f64) -> Option<Error> {
    let w = [y.w1, y.w2, y.w3];
    let fault = |power: f64, expected| Some(Error::Couple { power, expected, theta: y.theta, w, normal });
    let power = -(m[0] * w[0] + m[1] * w[1] + m[2] * w[2]);
    match () {
        () if !magnitude(m).is_finite() => fault(f64::NAN, FINITE),
        () if power < -POWER_ROUNDING * magnitude(m) * magnitude(w) => fault(power, EXPECTED_TO_LOSE),
        () => None,
    }
}

/// The error of a driving force or couple that is not finite; the value in the error is the time.
pub(crate) fn fault_of_drive(push: &Push, now: &Moment) -> Option<Error> {
    let finite = push.force.iter().chain(&push.couple).all(|x| x.is_finite());
    (!finite).then_some(Error::OutOfRange { name: "t", value: now.time, expected: DRIVE_FINITE })
}

/// The error of a coefficient of friction that is negative or not finite at a speed; None for a valid one.
pub(crate) fn fault_of_friction(mu: f64, speed: f64) -> Option<Error> {
    (!(0.0..=f64::MAX).contains(&mu)).then_some(Error::Coefficient { mu, expected: AT_LEAST_0, speed })
}

/// A law is evaluated near rest for test states whose index is a multiple of this; all speeds and forces are among them.
const REST_STATE_STRIDE: usize = 3;
/// Test states whose index is a multiple of this are joined by lines, along which jumps are searched for.
const LINE_STATE_STRIDE: usize = 12;
/// Number of halvings of a line between two test states in the search for a jump.
const LINE_HALVINGS: u32 = 44;

fn magnitude(m: [f64; 3]) -> f64 {
    m.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The jump of the function f between 0 and 1. The interval is halved, always towards the half with the larger change,
/// down to rounding; the change that remains is the jump. Halving ends, without a jump, where both halves together
/// change by no more than `little`.
fn jump_between(f: impl Fn(f64) -> [f64; 3], little: f64) -> f64 {
    let apart = |a: [f64; 3], b: [f64; 3]| magnitude(core::array::from_fn(|k| a[k] - b[k]));
    let (mut from, mut to) = ((0.0, f(0.0)), (1.0, f(1.0)));
    for _ in 0..LINE_HALVINGS {
        let middle = 0.5 * (from.0 + to.0);
        let half = (middle, f(middle));
        let [first, second] = [apart(from.1, half.1), apart(half.1, to.1)];
        if first + second <= little {
            break;
        }
        if first > second { to = half } else { from = half }
    }
    apart(from.1, to.1)
}

fn check_couple(law: &dyn CoupleLaw, body: &Body) -> Result<(), Error> {
    let refuse =
        |value: f64, expected: &'static str| Err(Error::OutOfRange { name: "couple", value, expected });
    let end = if body.has_row() { PI } else { body.theta_end() };
    let mut before = None;
    for i in 0..1200 {
        // Inclinations, directions and speeds that cover their ranges without a pattern.
        let part = |k: f64| (0.5 + f64::from(i) * k).fract();
        let theta = end * (0.02 + 0.96 * part(0.618_033_988_749_894_9));
        let (cos, phi) =
            (2.0 * part(0.754_877_666_246_692_7) - 1.0, 2.0 * PI * part(0.569_840_290_998_053_3));
        let sin = (1.0 - cos * cos).sqrt();
        let speed = [1e-2, 0.3, 1.0, 10.0][i as usize % 4];
        let normal = [0.0, 0.5, 1.0, 3.0][i as usize / 4 % 4];
        let at = |speed: f64| {
            let y =
                State { theta, w1: speed * sin * phi.cos(), w2: speed * sin * phi.sin(), w3: speed * cos };
            (law.couple(body, &y, normal), y)
        };
        let (m, y) = at(speed);
        let power = -(m[0] * y.w1 + m[1] * y.w2 + m[2] * y.w3);
        if !magnitude(m).is_finite() {
            return refuse(magnitude(m), FINITE);
        }
        if power < -POWER_ROUNDING * magnitude(m) * speed {
            return refuse(power, EXPECTED_TO_LOSE);
        }
        let mut jump = 0.0;
        if (i as usize).is_multiple_of(REST_STATE_STRIDE) {
            jump = magnitude(at(speed * NEAR_REST_SHARE).0) / magnitude(m).max(f64::MIN_POSITIVE);
        }
        if (i as usize).is_multiple_of(LINE_STATE_STRIDE)
            && let Some(State { theta, w1, w2, w3 }) = before.replace(y)
        {
            let between = |a: f64, b: f64, x: f64| a + x * (b - a);
            let along = |x: f64| State {
                theta: between(theta, y.theta, x),
                w1: between(w1, y.w1, x),
                w2: between(w2, y.w2, x),
                w3: between(w3, y.w3, x),
            };
            let found = jump_between(|x| law.couple(body, &along(x), normal), JUMP_SHARE * magnitude(m));
            if found.is_nan() {
                return refuse(found, FINITE);
            }
            jump = f64::max(jump, found / magnitude(m).max(f64::MIN_POSITIVE));
        }
        if jump > JUMP_SHARE {
            return refuse(
                jump,
                "a couple that is continuous, and zero at rest: for sgn(x) use tanh(x/e) with a small e",
            );
        }
    }
    Ok(())
}

fn check_friction(law: &dyn FrictionLaw, fixed: f64) -> Result<(), Error> {
    let most = law.coefficient(0.0);
    // In doubles 0.1 + 0.2 exceeds 0.3.
    within(
        "static",
        fixed,
        (most * (1.0 - POWER_ROUNDING), f64::INFINITY),
        "at least mu(0), the coefficient of sliding friction at speed 0",
    )?;
    let mut from = (0.0, most);
    for i in 0..=1000 {
        let speed = 10f64.powf(-6.0 + 9.0 * f64::from(i) / 1000.0);
        let to = (speed, within("mu", law.coefficient(speed), (0.0, f64::MAX), AT_LEAST_0)?);
        let between = |x: f64| [law.coefficient((1.0 - x) * from.0 + x * to.0), 0.0, 0.0];
        if (to.1 - from.1).abs() > JUMP_SHARE * (1.0 + most) && jump_between(between, JUMP_SHARE) > JUMP_SHARE
        {
            return Err(Error::OutOfRange {
                name: "mu",
                value: to.1,
                expected: "a coefficient without a step; round a step, for example with tanh",
            });
        }
        from = to;
    }
    Ok(())
}
