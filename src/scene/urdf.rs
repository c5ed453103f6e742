//! A body in the format URDF.
//!
//! URDF has cylinders and spheres, and neither fillets nor ellipsoids. A single circle, and each of several, is a cylinder
//! whose half thickness is a millionth of the radius, as in the model for MuJoCo.

use super::SceneError;
use super::contents::{CirclesShape, Contents, SceneCircle, SceneShape, ShapeKind};
use super::mjcf::THIN;
use super::words::{shortest, words};

const NO_SHAPE: &str =
    "urdf: expected a body with sharp rims, a ball, balls or a capsule; URDF has no other shape";

fn cylinder(radius: f64, long: f64) -> String {
    format!(r#"<cylinder radius="{}" length="{}"/>"#, shortest(radius), shortest(long))
}

fn sphere(radius: f64) -> String {
    format!(r#"<sphere radius="{}"/>"#, shortest(radius))
}

/// The parts of a body that touch the table: the height and the shape of each.
fn parts(shape: &CirclesShape) -> Result<Vec<(f64, String)>, SceneError> {
    let metre = shape.radius;
    let of = |circle: &SceneCircle| circle.swollen_by.or(shape.swollen_by).unwrap_or(0.0);
    let (circles, mut all) = (&shape.circles, Vec::new());
    if let (ShapeKind::Cylinder, [low, high]) = (shape.kind, &circles[..])
        && of(low) == 0.0
    {
        return Ok(vec![(0.5 * (low.height + high.height), cylinder(low.radius, high.height - low.height))]);
    }
    for circle in circles {
        match (circle.radius, of(circle)) {
            (0.0, 0.0) => all.push((circle.height, sphere(THIN * metre))),
            (0.0, fillet) => all.push((circle.height, sphere(fillet))),
            (radius, 0.0) => all.push((circle.height, cylinder(radius, 2.0 * THIN * metre))),
            _ => return Err(SceneError::Motion(NO_SHAPE)),
        }
    }
    if let (ShapeKind::Capsule, [low, high]) = (shape.kind, &circles[..]) {
        all.push((0.5 * (low.height + high.height), cylinder(of(low), high.height - low.height)));
    }
    Ok(all)
}

/// The URDF model of the body of a scene, as text.
pub(super) fn urdf(of: &Contents) -> Result<String, SceneError> {
    let SceneShape::Circles(shape) = &of.body.shape else { return Err(SceneError::Motion(NO_SHAPE)) };
    let i = |row: usize, column: usize| shortest(of.body.inertia[(row, column)]);
    let touch: Vec<String> = parts(shape)?
        .into_iter()
        .map(|(height, geometry)| {
            let place = format!(r#"<origin xyz="{}" rpy="0 0 0"/>"#, words([0.0, 0.0, height]));
            ["visual", "collision"]
                .map(|kind| format!("    <{kind}>{place}<geometry>{geometry}</geometry></{kind}>"))
                .join("\n")
        })
        .collect();
    let name = of.body.name.replace("--", "- -");
    Ok(format!(
        r#"<?xml version="1.0"?>
<!-- {name}; the origin is the centre of mass. Start, table and answer: see the JSON file. -->
<robot name="spincyl">
  <link name="body">
    <inertial>
      <origin xyz="0 0 0" rpy="0 0 0"/>
      <mass value="{mass}"/>
      <inertia ixx="{xx}" ixy="{xy}" ixz="{xz}" iyy="{yy}" iyz="{yz}" izz="{zz}"/>
    </inertial>
{touch}
  </link>
</robot>
"#,
        mass = shortest(of.body.mass),
        xx = i(0, 0),
        xy = i(0, 1),
        xz = i(0, 2),
        yy = i(1, 1),
        yz = i(1, 2),
        zz = i(2, 2),
        touch = touch.join("\n"),
    ))
}
