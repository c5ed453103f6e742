//! A scene as a model of MuJoCo (MJCF), with its initial state as the keyframe "start".
//!
//! Contacts are as stiff and friction as steady as the solver of MuJoCo allows. A comment at the top of the model names the
//! laws that MuJoCo does not have, and the couple to apply instead.
//!
//! A cylinder with a fillet is a smaller cylinder with a margin: contact begins when plane and cylinder are two fillets
//! apart, and MuJoCo puts the contact point half way between them. So the plane is one fillet below the table, and the
//! shape is exact, without facets. A single circle is a cylinder whose half thickness is a millionth of the radius. Of
//! several circles each is such a cylinder, or a ball, and a tip is a tiny ball. Where a ball passes into an edge at a
//! smooth joint, the rest of the ball would touch before the edge does; such a body touches the plane with its mesh for
//! display.

use super::contents::{
    CirclesShape, Contents, SceneCircle, SceneFriction, SceneShape, SceneTable, ShapeKind,
};
use super::words::{general, shortest, words};
use core::f64::consts::{PI, TAU};
use core::fmt::Write;

const SEEN: &str = r#"contype="0" conaffinity="0""#;
const UNSEEN: &str = r#"contype="0" conaffinity="0" group="3""#;
/// Half the thickness of the thin cylinder that stands for a circle, over its radius.
pub(super) const THIN: f64 = 1e-6;
/// Torsional friction of a patch that only turns, under the pressure of Hertz, over mu times its radius.
const TURNS: f64 = 3.0 * PI / 16.0;
/// Number of points round the axis of a mesh for display.
const AROUND: u32 = 48;

/// The coefficients of sliding and torsional friction.
#[derive(Clone, Copy)]
struct EngineGrip {
    mu: f64,
    torsion: f64,
}

/// The attributes that the geoms of a scene share: the dimension and the stiffness of contacts, both also with the
/// friction, and the size of a plane.
struct Attributes {
    dim: String,
    stiff: String,
    touch: String,
    size: String,
}

/// The parts of a model that describe the geoms of a scene.
#[derive(Default)]
struct Geometry {
    table: String,
    geoms: Vec<String>,
    mesh: String,
    pair: String,
    notes: Vec<String>,
}

/// The MJCF model of a scene, as text.
pub(super) fn mjcf(of: &Contents) -> String {
    let (body, start, metre) = (&of.body, &of.start, of.scale.radius);
    let (grip, mut said) = laws(&of.table);
    let geometry = geometry(of, grip);
    let [x, y, z, real] = <[f64; 4]>::from(start.orientation.coords);
    let places = [start.position.x, start.position.y, start.position.z, real, x, y, z];
    let speeds = start.velocity.iter().chain(start.angular_velocity_in_body_axes.iter()).copied();
    let inertia = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|at| body.inertia[at]);
    let until = of.expected.time.last().copied().unwrap_or_default();
    let mut all = vec![
        format!("{}; qpos x, y, z is the centre of mass, then a quaternion w, x, y, z.", body.name),
        format!("The answer is known for {} s: see the JSON file.", shortest(until)),
    ];
    all.append(&mut said);
    all.extend(geometry.notes);
    all.push(
        "With a step n times shorter, let solref have n^2 the stiffness and n the damping: MuJoCo lets a contact that \
         rolls creep, at its acceleration over the damping."
            .into(),
    );
    let said = all.join("\n  ").replace("--", "- -");
    let shape: Vec<String> = geometry.geoms.iter().map(|geom| format!("      <geom {geom}/>")).collect();
    let (gravity, step) = (words(of.gravity.iter().copied()), general(5e-4 * of.scale.second, 6));
    format!(
        r#"<!--
  {said}
-->
<mujoco model="spincyl">
  <option gravity="{gravity}" timestep="{step}" integrator="implicitfast"
          cone="elliptic" impratio="1000" solver="Newton" iterations="100" tolerance="0"
          noslip_iterations="30" noslip_tolerance="0">
    <flag energy="enable"/>
  </option>
  <visual><global offwidth="1280" offheight="720"/></visual>
{mesh}  <worldbody>
    <light pos="0 0 {light}" dir="0 0 -1" directional="true"/>
{table}
    <body name="body">
      <freejoint/>
      <inertial pos="0 0 0" mass="{mass}" fullinertia="{inertia}"/>
{shape}
    </body>
  </worldbody>
{pair}  <keyframe>
    <key name="start" qpos="{places}" qvel="{speeds}"/>
  </keyframe>
</mujoco>
"#,
        mesh = geometry.mesh,
        light = shortest(10.0 * metre),
        table = geometry.table,
        mass = shortest(body.mass),
        inertia = words(inertia),
        shape = shape.join("\n"),
        pair = geometry.pair,
        places = words(places),
        speeds = words(speeds),
    )
}

/// The friction for MuJoCo, and notes for the comment on the laws of the table.
fn laws(table: &SceneTable) -> (EngineGrip, Vec<String>) {
    let mut notes = Vec::new();
    let (mut mu, mut torsion) = (0.0, 0.0);
    match &table.friction {
        SceneFriction::Viscous { c, force, .. } => {
            notes.push(format!("NOT IN THIS FILE: friction {force}, c = {} s/m.", shortest(*c)));
        }
        SceneFriction::Rolling { mu: grips, needed, .. } => {
            mu = *grips;
            let needed = needed.map_or("None".into(), shortest);
            notes.push(format!("The answer rolls without slip. That needs a friction of {needed}."));
        }
        SceneFriction::Coulomb { mu: slides, fixed, patch, .. } => {
            mu = *slides;
            if *fixed != Some(mu) {
                let fixed = fixed.map_or("None".into(), shortest);
                notes.push(format!("NOT IN THIS FILE: static friction {fixed}. Here it is held up to mu N."));
            }
            if *patch > 0.0 {
                torsion = TURNS * mu * patch;
                let said = format!(
                    "a patch of {} m. Here slip and drilling share an ellipse instead.",
                    shortest(*patch)
                );
                notes.push(format!("NEARLY: {said}"));
            }
        }
        SceneFriction::Smooth { .. } => {}
    }
    if let Some(bounce) = table.restitution {
        notes.push(format!("NEARLY: restitution {}. Here it is the damping of a spring.", shortest(bounce)));
    }
    for law in &table.losses {
        let value = format!("{} = {} {}", law.coefficient, shortest(law.value), law.unit);
        notes.push(format!("NOT IN THIS FILE: {}, the couple {}, {value}.", law.law, law.couple));
    }
    if !table.losses.is_empty() {
        notes.push("Apply a couple at each step, as xfrc_applied[1, 3:].".into());
        notes.push(table.symbols.clone());
    }
    (EngineGrip { mu, torsion }, notes)
}

/// The geoms of table and body, the mesh for display, the contacts between them, and notes for the comment.
fn geometry(of: &Contents, grip: EngineGrip) -> Geometry {
    let EngineGrip { mu, torsion } = grip;
    let (metre, second) = (of.scale.radius, of.scale.second);
    let damping = 1e3 / second * of.table.restitution.map_or(1.0, |bounce| 2.0 * damped(bounce));
    let stiff = format!(
        r#"solref="{} {}" solimp="0.9999 0.9999 0.001 0.5 2""#,
        general(-1e6 / (second * second), 6),
        general(-damping, 6)
    );
    let dim = format!(r#"condim="{}""#, if torsion > 0.0 { 4 } else { 3 });
    let touch = format!(r#"friction="{}" {dim} {stiff}"#, words([mu, torsion, 0.0]));
    let size = format!(r#"size="{}""#, words([20.0 * metre, 20.0 * metre, metre]));
    let mut all = Geometry {
        table: format!(r#"    <geom name="table" type="plane" {size} {touch}/>"#),
        ..Geometry::default()
    };
    let common = Attributes { dim, stiff, touch, size };
    match &of.body.shape {
        SceneShape::Ellipsoid(stone) => {
            let [axes, centre] = [&stone.semi_axes, &stone.centre].map(|v| words(v.iter().copied()));
            all.geoms =
                vec![format!(r#"name="rim" type="ellipsoid" size="{axes}" pos="{centre}" {}"#, common.touch)];
        }
        SceneShape::Circles(shape) if shape.kind == ShapeKind::Circles => {
            several(shape, metre, grip, &common, &mut all);
        }
        SceneShape::Circles(shape) => {
            one_or_two(shape, metre, grip, &common, &mut all);
        }
    }
    if let SceneShape::Circles(shape) = &of.body.shape
        && !shape.outline.is_empty()
    {
        all.geoms.push(format!(r#"name="looks" type="mesh" mesh="looks" mass="0" {SEEN}"#));
        let mut places = String::new();
        for k in 0..AROUND {
            let (sin, cos) = (f64::from(k) * (TAU / f64::from(AROUND))).sin_cos();
            for [r, z] in &shape.outline {
                let blank = if places.is_empty() { "" } else { " " };
                let at = [r * cos, r * sin, *z].map(|x| general(x, 6));
                let _ = write!(places, "{blank}{}", at.join(" "));
            }
        }
        all.mesh = format!("  <asset><mesh name=\"looks\" inertia=\"shell\" vertex=\"{places}\"/></asset>\n");
    }
    all
}

/// The geoms of a body with one circle or two equal rims.
fn one_or_two(
    shape: &CirclesShape,
    metre: f64,
    EngineGrip { mu, torsion }: EngineGrip,
    Attributes { dim, stiff, touch, size }: &Attributes,
    all: &mut Geometry,
) {
    let heights: Vec<f64> = shape.circles.iter().map(|circle| circle.height).collect();
    let rim = shape.circles.first().map_or(0.0, |circle| circle.radius);
    let fillet = shape.swollen_by.unwrap_or(0.0);
    let (first, last) = (heights.first().copied().unwrap_or(0.0), heights.last().copied().unwrap_or(0.0));
    if shape.kind == ShapeKind::Capsule {
        all.geoms = vec![format!(r#"name="rim" type="capsule" size="{}" {touch}"#, words([fillet, last]))];
    } else if rim == 0.0 {
        let ball = |(name, z): (&str, &f64)| {
            format!(
                r#"name="{name}" type="sphere" size="{}" pos="0 0 {}" {touch}"#,
                shortest(fillet),
                shortest(*z)
            )
        };
        all.geoms = ["rim", "other"].into_iter().zip(&heights).map(ball).collect();
    } else {
        let (half, middle) = ((last - first) / 2.0, (first + last) / 2.0);
        let half = if half == 0.0 { THIN * metre } else { half };
        let of = format!(
            r#"name="rim" type="cylinder" pos="0 0 {}" size="{}""#,
            shortest(middle),
            words([rim, half])
        );
        if heights.len() == 1 {
            all.notes
                .push(format!("The rim is a cylinder of {} m instead of a circle.", general(2.0 * half, 3)));
        }
        all.geoms = vec![format!("{of} {touch}")];
        if fillet > 0.0 {
            all.geoms = vec![format!("{of} {UNSEEN}")];
            let deep = format!(
                r#"    <geom name="table" type="plane" pos="0 0 {}" {size} {UNSEEN}/>"#,
                shortest(-fillet)
            );
            all.table = format!("    <geom name=\"top of the table\" type=\"plane\" {size} {SEEN}/>\n{deep}");
            let held = format!(
                r#"friction="{}" {dim} margin="{}""#,
                words([mu, mu, torsion, 0.0, 0.0]),
                shortest(2.0 * fillet)
            );
            all.pair = format!(
                "  <contact><pair geom1=\"table\" geom2=\"rim\" {held} gap=\"0\" {stiff}/></contact>\n"
            );
        }
    }
}

/// Whether any two neighbouring circles touch at a smooth joint.
fn is_smooth(circles: &[SceneCircle]) -> bool {
    circles.windows(2).any(|both| {
        let [below, above] = [both[0], both[1]];
        let apart = (above.height - below.height).hypot(above.radius - below.radius);
        let [a, b] = [below, above].map(|circle| circle.swollen_by.unwrap_or(0.0));
        apart <= (b - a).abs() * (1.0 + 1e-9)
    })
}

/// The geoms of several circles, planes below the table for those with a fillet, and their contacts.
fn several(
    shape: &CirclesShape,
    metre: f64,
    EngineGrip { mu, torsion }: EngineGrip,
    Attributes { dim, stiff, touch, size }: &Attributes,
    all: &mut Geometry,
) {
    if is_smooth(&shape.circles) {
        all.geoms = vec![format!(r#"name="rim" type="mesh" mesh="looks" {touch}"#)];
        all.notes.push("NEARLY: a smooth joint. Here the body is a mesh with facets.".into());
        return;
    }
    let mut pairs = String::new();
    for (k, circle) in shape.circles.iter().enumerate() {
        let (radius, fillet, name) = (circle.radius, circle.swollen_by.unwrap_or(0.0), format!("circle {k}"));
        let place = format!(r#"name="{name}" pos="0 0 {}""#, shortest(circle.height));
        if radius == 0.0 {
            let round = if fillet > 0.0 { fillet } else { THIN * metre };
            all.geoms.push(format!(r#"{place} type="sphere" size="{}" {touch}"#, shortest(round)));
            continue;
        }
        let geom = format!(r#"{place} type="cylinder" size="{}""#, words([radius, THIN * metre]));
        if fillet == 0.0 {
            all.geoms.push(format!("{geom} {touch}"));
            continue;
        }
        all.geoms.push(format!("{geom} {UNSEEN}"));
        let plane = format!("table below circle {k}");
        let _ = write!(
            all.table,
            "\n    <geom name=\"{plane}\" type=\"plane\" pos=\"0 0 {}\" {size} {UNSEEN}/>",
            shortest(-fillet)
        );
        let held = format!(r#"friction="{}""#, words([mu, mu, torsion, 0.0, 0.0]));
        let near = format!(r#"{dim} margin="{}" gap="0" {stiff}"#, shortest(2.0 * fillet));
        let _ = writeln!(pairs, "    <pair geom1=\"{plane}\" geom2=\"{name}\" {held} {near}/>");
    }
    if !pairs.is_empty() {
        all.pair = format!("  <contact>\n{pairs}  </contact>\n");
    }
    all.notes.push("Each circle that can touch the table is a geom of its own.".into());
}

/// Damping ratio of a linear spring on which a body bounces with this coefficient of restitution.
fn damped(restitution: f64) -> f64 {
    // MuJoCo does not accept a damping of zero here.
    let decrement = -restitution.clamp(1e-3, 1.0 - 1e-9).ln();
    if restitution > 0.0 { decrement / PI.hypot(decrement) } else { 1.0 }
}
