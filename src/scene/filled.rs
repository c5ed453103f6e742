//! Computes the contents of a scene from the body, the start and the options of its motion.

use super::contents::*;
use super::natural::{KnownMotion, Natural};
use super::outline::shape_of;
use super::words::shortest;
use super::{SceneError, VERSION};
use crate::laws::contact::{Friction, ImpactLaw, Table};
use crate::laws::loss::Law;
use crate::laws::scale::Scale;
use crate::motions::Ending;
use crate::numbers::larger_or_nan;
use core::f64::consts::PI;
use nalgebra::{Matrix3, Point3, Vector3};

const SYMBOLS: &str = "n: up. a: axis 3 of the body. w: angular velocity; w_n = w.n; t = w - w_n n. s = |n x a|. \
                       h = ((a.n) n - a)/s. q = (w.a - (a.n) w_n)/s^2. N: normal force, of both rims together. \
                       A = (radius of the circle + swollen_by s)/R. R: body.shape.radius. A couple acts on the body \
                       and takes the power -couple.w; in the air there are only b and b2. sign(0), and t/norm(t) of \
                       t = 0, is what keeps it 0, of at most the size 1.";
const SLIPS: &str = "-mu N u/|u| at the contact point, where u is its velocity over the table";
const ROLLS: &str = "what keeps the contact point at rest; any coefficient from `needed` on does";
const FILM: &str = "-c N u at the contact point, where u is its velocity over the table";
const PATCH: &str = "-mu p(r) (u + (w.n) n x r)/|u + (w.n) n x r| per area of a disk of radius `patch`, and its \
                     moment about n: p = 3 N/(2 pi patch^2) sqrt(1 - r^2/patch^2)";
/// Least error that is stated for times of phases and impacts and for lost energies, in natural units.
const LEAST: f64 = 1e-11;
/// The coefficient of friction of a rolling scene without a given one: its least value, its ratio to the coefficient
/// that rolling needs, and its largest value.
const MU: [f64; 3] = [1.0, 1.5, 1e3];
/// Number of intervals of time at whose ends the friction that rolling needs is computed.
const LOOKS: u32 = 4000;

fn reason(ending: Ending) -> &'static str {
    match ending {
        Ending::Done => "the last time was reached",
        Ending::Face => "the face landed on the table",
        Ending::Side => "the other rim landed",
        Ending::LiftOff => "the normal force vanished",
        Ending::Slip => "rolling needs more friction than mu N",
        Ending::Painleve => "no unique contact force (Painleve)",
        Ending::Stops => "dry friction holds the whole body",
        Ending::Landing => "no unique landing on both rims",
        Ending::Bounded | Ending::Invalid => "the motion was given up",
    }
}

/// The contents of the scene of a motion at these times in seconds, of which the first is 0.
pub(super) fn contents(natural: Natural, scale: &Scale, seconds: &[f64]) -> Result<Contents, SceneError> {
    let times: Vec<f64> = seconds.iter().map(|t| scale.time(*t)).collect();
    let answer = natural.answer(&times)?;
    if answer.rows.len() < 2 {
        return Err(SceneError::Motion("motion: expected a time after the initial state"));
    }
    let [radius, mass, gravity] = scale.numbers();
    let (sin, cos) = natural.ask().slope.sin_cos();
    let first = &answer.rows[0];
    let start = SceneStart {
        position: first.position.map(|x| scale.metres(x)),
        orientation: first.orientation,
        velocity: first.velocity.map(|v| scale.metres_per_second(v)),
        angular_velocity: first.w.map(|w| scale.radians_per_second(w)),
        angular_velocity_in_body_axes: (first.orientation.inverse() * first.w)
            .map(|w| scale.radians_per_second(w)),
    };
    let last = answer.rows.last().map_or(0.0, |now| now.time);
    Ok(Contents {
        version: VERSION,
        units: "SI: metres, kilograms, seconds, radians, newtons, joules".into(),
        axes: "of the table, z its normal; quaternions are x, y, z, w and turn the body's axes into these"
            .into(),
        scale: NaturalUnits { radius, mass, gravity, second: scale.seconds(1.0) },
        gravity: Vector3::new(gravity * sin, 0.0, -gravity * cos),
        body: body_of(&natural, scale),
        table: table_of(&natural, scale, last)?,
        start,
        expected: expected(&natural, &answer, scale, &seconds[..answer.rows.len()]),
        error: errors(&answer, scale),
        natural: Some(natural),
    })
}

fn body_of(natural: &Natural, scale: &Scale) -> SceneBody {
    let [radius, mass, _] = scale.numbers();
    let inertia = natural.inertia().map(|i| scale.kilogram_square_metres(i));
    let (moments, axes) = principal(&inertia);
    let (name, shape) = match natural {
        Natural::Body { body, .. } => (body.to_string(), SceneShape::Circles(shape_of(body, radius))),
        Natural::Stone { stone, .. } => {
            let vector = |x: [f64; 3], sign: f64| Vector3::from(x).map(|x| sign * x * radius);
            let end = stone.theta_end();
            let shape = EllipsoidShape {
                kind: "ellipsoid".into(),
                radius,
                semi_axes: vector(stone.axes(), 1.0),
                centre: vector(stone.offset(), -1.0),
                lands_at: (end < PI).then_some(end),
            };
            let [a, b, c] = stone.axes();
            (format!("an ellipsoid with the semi-axes {a}, {b}, {c}"), SceneShape::Ellipsoid(shape))
        }
    };
    SceneBody {
        name,
        mass,
        inertia,
        inertia_is: "about the centre of mass, along the body's axes; the origin is the centre of mass"
            .into(),
        principal_moments: moments,
        principal_axes: axes,
        shape,
    }
}

/// The principal moments of inertia in ascending order, and their axes, which are right-handed.
fn principal(inertia: &Matrix3<f64>) -> ([f64; 3], [Vector3<f64>; 3]) {
    let found = inertia.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|i, j| found.eigenvalues[*i].total_cmp(&found.eigenvalues[*j]));
    let mut axes = order.map(|i| found.eigenvectors.column(i).into_owned());
    if axes[0].cross(&axes[1]).dot(&axes[2]) < 0.0 {
        axes[2] = -axes[2];
    }
    (order.map(|i| found.eigenvalues[i]), axes)
}

fn table_of(natural: &Natural, scale: &Scale, last: f64) -> Result<SceneTable, SceneError> {
    let ask = natural.ask();
    let friction = match ask.table {
        Table::Rubs(Friction::Coulomb { mu, fixed, patch }) => SceneFriction::Coulomb {
            mu,
            fixed: fixed.is_finite().then_some(fixed),
            patch: scale.metres(patch),
            force: if patch > 0.0 {
                PATCH.into()
            } else {
                format!("{SLIPS}; while it is at rest, at most static N")
            },
        },
        Table::Rubs(Friction::Viscous { c }) => {
            // The coefficient c is a force per normal force and velocity.
            SceneFriction::Viscous { c: scale.speed(c), unit: "s/m".into(), force: FILM.into() }
        }
        Table::Smooth => SceneFriction::Smooth { mu: 0.0, force: "none".into() },
        Table::Rolling { mu } => {
            let needed = if ask.restitution.is_none() { needed(natural, last)? } else { f64::INFINITY };
            let [least, over, most] = MU;
            // Where the needed friction is unknown, it counts as infinite.
            let enough = if needed.is_nan() { most } else { (over * needed).max(least).min(most) };
            SceneFriction::Rolling {
                mu: if mu.is_finite() { mu } else { enough },
                needed: needed.is_finite().then_some(needed),
                force: ROLLS.into(),
            }
        }
    };
    let losses = ask.losses.iter().map(|(law, value)| SceneLoss {
        law: format!("{law:?}"),
        coefficient: law.parameter().into(),
        value: scale.coefficient_in_si(law, value),
        unit: law.unit().texts()[2].into(),
        couple: {
            let only = law == Law::RollingResistance && ask.resists_only_rolling();
            format!("{}{}", law.couple_in_si(), if only { ", 0 while the body slips" } else { "" })
        },
    });
    Ok(SceneTable {
        point: Point3::origin(),
        normal: Vector3::z(),
        friction,
        restitution: ask.restitution,
        restitution_is: restitution_is(ask.impact_law),
        losses: losses.collect(),
        symbols: SYMBOLS.into(),
    })
}

/// The coefficient of friction that rolling needs up to the time `last`.
fn needed(natural: &Natural, last: f64) -> Result<f64, SceneError> {
    let times: Vec<f64> = (0..=LOOKS).map(|i| last * f64::from(i) / f64::from(LOOKS)).collect();
    Ok(natural.answer(&times)?.rows.iter().map(|now| now.needed).fold(0.0, larger_or_nan))
}

/// The meaning of the coefficient of restitution under this law of restitution, in words.
fn restitution_is(law: ImpactLaw) -> String {
    match law {
        ImpactLaw::Stronge => {
            "its square is the share of the work of compression that the normal force gives back \
                               (Stronge); null: nothing strikes the table"
                .into()
        }
        ImpactLaw::Newton => {
            "the normal velocity after an impact is minus this times that before (Newton)".into()
        }
        ImpactLaw::Poisson => {
            "the normal impulse after compression is this times that of compression (Poisson)".into()
        }
        ImpactLaw::Walton { tangential } => format!(
            "the normal velocity of the ball after an impact is minus this times that before, its slip minus {} times \
             that before if that takes at most mu times the normal impulse (Walton)",
            shortest(tangential)
        ),
    }
}

fn expected(natural: &Natural, answer: &KnownMotion, scale: &Scale, seconds: &[f64]) -> Expected {
    let (rows, ask) = (&answer.rows, natural.ask());
    let joules = |all: &Vec<f64>| all.iter().map(|x| scale.joules(*x)).collect();
    let strikes = ask.restitution.is_some();
    let lost_before =
        |t: f64| answer.impacts.iter().filter(|hit| hit.time < t).map(|hit| hit.lost).sum::<f64>();
    let impacts = answer.impacts.iter().map(|hit| SceneImpact {
        time: scale.seconds(hit.time),
        kind: hit.kind.clone(),
        normal_impulse: scale.newton_seconds(hit.impulse),
        energy_lost: scale.joules(hit.lost),
    });
    let phases = answer
        .phases
        .iter()
        .map(|(time, kind)| ScenePhase { time: scale.seconds(*time), kind: kind.to_string() });
    let last = seconds.last().copied().unwrap_or_default();
    Expected {
        time: seconds.to_vec(),
        position: rows.iter().map(|now| now.position.map(|x| scale.metres(x))).collect(),
        orientation: rows.iter().map(|now| now.orientation).collect(),
        velocity: rows.iter().map(|now| now.velocity.map(|v| scale.metres_per_second(v))).collect(),
        angular_velocity: rows.iter().map(|now| now.w.map(|w| scale.radians_per_second(w))).collect(),
        theta: rows.iter().map(|now| super::inclination(&now.orientation)).collect(),
        energy: rows.iter().map(|now| scale.joules(now.energy)).collect(),
        normal_force: rows.iter().map(|now| scale.newtons(now.normal)).collect(),
        contact_force: rows.iter().map(|now| now.force.map(|f| scale.newtons(f))).collect(),
        contact_point: rows.iter().map(|now| now.point.map(|x| scale.metres(x))).collect(),
        heat_of_slip: answer.heat.as_ref().map(joules),
        lost_by_losses: answer.lost.as_ref().map(joules),
        theta_is: "angle from the vertical to axis 3 of the body".into(),
        contact_is: "force of the table on the body, and where; null on both rims, and no place in the air or on a face"
            .into(),
        height: strikes.then(|| rows.iter().map(|now| scale.metres(now.height)).collect()),
        height_is: strikes.then(|| "of the lowest point of the body".into()),
        lost_in_impacts: strikes.then(|| rows.iter().map(|now| scale.joules(lost_before(now.time))).collect()),
        impacts: strikes.then(|| impacts.collect()),
        phases: phases.collect(),
        ending: SceneEnding {
            kind: answer.ending.to_string().to_uppercase().replace(' ', "_"),
            time: answer.end.map_or(last, |end| scale.seconds(end)),
            why: reason(answer.ending).into(),
        },
    }
}

fn errors(answer: &KnownMotion, scale: &Scale) -> SceneErrors {
    let (bounds, spent) = (&answer.bounds, answer.error.max(LEAST));
    SceneErrors {
        position: scale.metres(bounds.position),
        angle: bounds.orientation,
        theta: bounds.state,
        angular_velocity: scale.radians_per_second(bounds.angular_velocity),
        velocity: scale.metres_per_second(bounds.velocity),
        energy: scale.joules(bounds.energy),
        normal_force: scale.newtons(2.0 * answer.force_error),
        contact_force: scale.newtons(bounds.force),
        contact_point: scale.metres(answer.pose_error),
        times_of_phases_and_impacts: scale.seconds(spent),
        heat_and_losses: scale.joules(spent),
        explained: "the largest at any time; angle is that between orientations".into(),
    }
}
