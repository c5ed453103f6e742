//! How steep a table may be before a body on it slips, tips over or begins to roll.
//!
//! ```text
//! t = tan(slope),   G = t (cos phi, -sin phi) along e_h and e2,   k = I3;   A, Z, L and g as in `body::rim`
//! stands on its face     slips at t = mu,   tips at t = a/Z, with rolling resistance at (a + delta)/Z
//! rolls straight down    slips at t = mu (k + A^2)/k
//! lies on two circles    N, F_2 of each as in `contact::lying`, c = sqrt((mu N)^2 - F_2^2):   slips at c + c' = |G_h|
//!                        tips at Z |G_h| = |g| of the lower circle;   begins to roll at Z |G_2| = its dry couple
//! rests on one circle    begins to roll at hypot(Z G_2, g - Z G_h) = delta
//! ```
//! Two circles that are alike, with the centre of mass between them, need F_2 = q t, q = |sin phi| held or k |sin phi|/(1 + k) rolling; then
//!
//! ```text
//! t^2 = mu^2 (l^2 - mu^2)/(l^2 (cos^2 phi + q^2) - mu^2 cos^2 phi),  or  t = mu l/(q l + mu |cos phi|)  for  mu q l > (l^2 - mu^2) |cos phi|
//! ```
//! In the second case the upper circle, which carries less of the weight, has no friction left along the axis. The
//! first one is a special case of a general equation of fourth degree in t, so that both are found as the change of
//! sign of the margin.
//!
//! Error: 8 ulp for one circle or a face, and 1e-14 for two circles; a test of `steep` compares with these formulas.
//!
//! ```
//! use spincyl::Body;
//! use spincyl::steep::{Posture, slip_slope, tip_slope};
//!
//! // A can whose centre is 2 above its face slips at mu, and tips at 1/2.
//! let can = Body::solid(2.0)?;
//! let slips = slip_slope(&can, 0.0, 0.3, Posture::Standing, 0.0)?;
//! let tips = tip_slope(&can, 0.0, Posture::Standing, 0.0)?;
//! assert!((slips.tan() - 0.3).abs() < 1e-15 && (tips.tan() - 0.5).abs() < 1e-15);
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::body::Body;
use super::contact::lying::{Lain, Lying};
use super::contact::slip::Friction;
use super::loss::{Couples, Holds, Law, Losses, Ways};
use crate::error::{Error, within};
use crate::methods::search::crossing;
use crate::numbers::codes::coded;
use core::f64::consts::{FRAC_PI_2, PI};

/// Couples and forces up to this, in natural units, count as rounding errors.
const NO_COUPLE: f64 = 1e-14;

coded! {
    /// The posture of a body at rest on a tilted table.
    pub enum Posture {
        /// The body stands on its face.
        Standing = 0,
        /// The body lies on two circles, or stands on one with its axis across the slope, and is free to roll.
        Rolling = 1,
        /// The body lies on two circles, and dry losses keep it from rolling.
        Lying = 2,
        /// The body leans on one circle, and dry losses keep it from rolling and falling.
        Edge = 3,
    }
}

/// The forces on a body at rest on two circles, on a slope with this tangent, and the couple that holds it if it is held.
fn on_two(body: &Body, held: bool, [t, phi]: [f64; 2]) -> Lain<f64> {
    let mut losses = Couples::of(&Losses::NONE, |x| x);
    losses.ways = Some(Ways { holds: Holds { contour: held, ..Holds::default() }, ..Ways::default() });
    let (law, (sin, cos)) = (Lying::on(body, &Friction::coulomb(0.0), &Losses::NONE), phi.sin_cos());
    Lying { losses: Some(losses), pull: Some([t * cos, -(t * sin)]), ..law }.rolls([0.0; 4])
}

/// The body on the circle on which it stands at this inclination, and phi as seen from the end of this circle.
fn seen(body: &Body, theta: f64, phi: f64) -> (Body, f64) {
    let body = body.at(theta);
    (body, if body.view().over { phi + PI } else { phi })
}

/// The slope, in radians, beyond which a contact with this coefficient of friction slips. `phi` is the angle from downhill
/// to the direction to which the axis leans; `theta` says on which face or circles a body of several circles rests.
///
/// ```
/// use spincyl::{Body, steep::{Posture, slip_slope}};
///
/// let side = std::f64::consts::FRAC_PI_2;
/// let slope = slip_slope(&Body::solid(2.0)?, side, 0.2, Posture::Rolling, -side)?;
/// assert!((slope.tan() - 0.6).abs() < 1e-15); // three times mu
/// # Ok::<(), spincyl::Error>(())
/// ```
///
/// # Errors
/// `OutOfRange` for a `mu` that is negative or not finite, a `phi` that is not finite, and a body that stands on its
/// face but has none, such as a ball. A body that lies or rolls on one circle must have its centre of mass in the plane
/// of this circle (else the name is "ell"); if it rolls and is no uniform ball, its axis must be across the slope (else
/// the name is "phi").
pub fn slip_slope(body: &Body, theta: f64, mu: f64, posture: Posture, phi: f64) -> Result<f64, Error> {
    within("mu", mu, (0.0, f64::MAX), "0 <= mu, finite")?;
    within("phi", phi, (-f64::MAX, f64::MAX), "a finite angle")?;
    if matches!(posture, Posture::Standing | Posture::Edge) {
        face_or(body, theta, posture)?;
        return Ok(mu.atan());
    }
    let (body, phi) = seen(body, theta, phi);
    if !body.has_two_rims() {
        let ell = within(
            "ell",
            body.ell(),
            (-NO_COUPLE, NO_COUPLE),
            "0 for a body on a single circle, as for a disk or a uniform ball",
        )?;
        let alone = body.is_uniform_ball() || phi.cos().abs() < NO_COUPLE;
        if posture == Posture::Rolling && !alone {
            let expected =
                "pi/2 or -pi/2, an axis across the slope: otherwise a body on a single circle falls over";
            return Err(Error::OutOfRange { name: "phi", value: phi, expected });
        }
        let (k, radius) = (body.i3(), body.shape().rim.radius((1.0, ell)));
        let rolls = if posture == Posture::Rolling { (k + radius * radius) / k } else { 1.0 };
        return Ok((mu * rolls).atan());
    }
    let held = posture == Posture::Lying;
    // Forces are in units of the weight, so that none is infinite.
    let margin = |slope: f64| {
        let (Lain { force, .. }, cos) = (on_two(&body, held, [slope.tan(), phi]), slope.cos());
        let [a, b] = force.map(|[n, across, _]| [mu * n * cos, (across * cos).abs()]);
        let along = [a, b].map(|[most, across]| (most * most - across * across).max(0.0).sqrt());
        (a[0] - a[1]).min(b[0] - b[1]).min(along[0] + along[1] - (slope.sin() * phi.cos()).abs())
    };
    let [level, steep] = [0.0, FRAC_PI_2].map(margin);
    Ok(if level > 0.0 { crossing(margin, 0.0, FRAC_PI_2, level, steep) } else { 0.0 })
}

/// The slope, in radians, beyond which a body tips over the edge of its face, or over the lower circle of the two on which
/// it lies; pi/2 if it never does. Arguments as for [`slip_slope`].
///
/// # Errors
/// `OutOfRange` for a `phi` that is not finite, and for a body that stands on its face but has none, such as a ball.
pub fn tip_slope(body: &Body, theta: f64, posture: Posture, phi: f64) -> Result<f64, Error> {
    within("phi", phi, (-f64::MAX, f64::MAX), "a finite angle")?;
    if posture == Posture::Standing {
        let [a, z] = face_or(body, theta, posture)?;
        return Ok(if z > 0.0 { (a / z).atan() } else { FRAC_PI_2 });
    }
    let (body, phi) = seen(body, theta, phi);
    if !body.has_two_rims() {
        return Ok(FRAC_PI_2);
    }
    let (border, cos) = (body.border(), phi.cos());
    let lower = border.circles[usize::from(cos < 0.0)].lever * cos.signum();
    Ok(lower.max(0.0).atan2(border.height * cos.abs()))
}

/// The radius of the face at an inclination of 0 or pi, and the height of the centre of mass above it.
fn face_or(body: &Body, theta: f64, posture: Posture) -> Result<[f64; 2], Error> {
    let (rim, flat) = (body.told_at(theta).shape().rim, (0.0, theta.cos().signum()));
    let a = rim.radius(flat);
    if posture == Posture::Standing {
        within(
            "a",
            a,
            (f64::MIN_POSITIVE, f64::MAX),
            "a > 0, the radius of the face of the body: a ball has no face",
        )?;
    }
    Ok([a, rim.height(flat)])
}

/// A slope, and the direction of a body on it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Incline {
    /// The slope of the table, in radians.
    pub slope: f64,
    /// The direction phi to which the body leans, in radians from downhill.
    pub phi: f64,
}

impl Incline {
    /// An incline with this slope and this direction phi, both in radians.
    pub const fn new(slope: f64, phi: f64) -> Self {
        Self { slope, phi }
    }
}

/// The shares of friction, losses and weight that hold a body at rest on a slope; if all are below 1, the body stays.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SlopeShares {
    /// The share of the largest static friction that is needed to keep the body from slipping.
    pub slipping: f64,
    /// The share of the largest couple of the dry losses that is needed to keep the body from rolling.
    pub rolling: f64,
    /// The ratio of tan(slope) to that at which the body tips over.
    pub tipping: f64,
}

/// The shares of static friction, dry losses and width that are needed to keep a body at rest on a slope from slipping,
/// rolling and tipping; each is 1 where the body lets go.
///
/// # Errors
/// Those of [`slip_slope`], unless `mu` is infinite, and of [`tip_slope`].
pub fn shares(
    body: &Body,
    theta: f64,
    mu: f64,
    losses: &Losses,
    posture: Posture,
    Incline { slope, phi }: Incline,
) -> Result<SlopeShares, Error> {
    let t = slope.tan();
    let of = |need: f64, most: f64| if need.abs() < NO_COUPLE { 0.0 } else { (need / most).abs() };
    let slips = if mu < f64::INFINITY { slip_slope(body, theta, mu, posture, phi)? } else { FRAC_PI_2 };
    let rolls = match posture {
        Posture::Lying => {
            let (body, phi) = seen(body, theta, phi);
            let (at, law) =
                (on_two(&body, true, [t, phi]), Lying::on(&body, &Friction::coulomb(0.0), losses));
            of(at.couple[1], law.limits(at.force.map(|force| force[0]))[1])
        }
        Posture::Edge => {
            let (rim, angle, (sin, cos)) = (body.told_at(theta).shape().rim, theta.sin_cos(), phi.sin_cos());
            let (high, lever) = (rim.height(angle), rim.lever(angle));
            of((high * t * sin).hypot(lever - high * t * cos), losses.coefficient(Law::RollingResistance))
        }
        _ => 0.0,
    };
    let tips = tip_slope(body, theta, posture, phi)?.tan();
    // Rolling resistance acts on the one point of the ring over which a body on its face tips.
    let wider = match posture {
        Posture::Standing => {
            1.0 + losses.coefficient(Law::RollingResistance) / face_or(body, theta, posture)?[0]
        }
        _ => 1.0,
    };
    Ok(SlopeShares { slipping: of(t, slips.tan()), rolling: rolls, tipping: of(t, tips * wider) })
}
