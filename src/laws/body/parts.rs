//! Bodies put together from coaxial parts.
//!
//! ```text
//! dm = sigma pi (r^2 - b^2) dz   of a solid between the radii b and r,   sigma ds 2 pi r   of a thin wall
//! I3 = sum of r^2 dm,   I1 = I3/2 + sum of (z - z0)^2 dm,   z0 = sum of z dm / M
//! ```
//! The squared radii of all parts are polynomials of z, of at most the second degree, so that Gauss's rule with four
//! nodes is exact. `hull` computes on which of their edges the body stands, and the inclination at which another one
//! touches the table.
//!
//! Error: a few roundings of the moments about a point within the body, and as many of theta_end.
//!
//! ```
//! use spincyl::body::parts::{Amount, BodyPart, Form, assembled};
//!
//! // A wheel: a disk, and a ring of the same mass near its edge.
//! let disk = Form::Solid { radii: [1.0; 2], bores: [0.0; 2], ends: [0.0, 0.2], fillet: 0.0 };
//! let ring = Form::Ring { radius: 0.9, height: 0.1 };
//! let wheel = assembled(&[disk, ring].map(|form| BodyPart::new(form, Amount::Mass(2.0))))?;
//! assert!((wheel.mass - 4.0).abs() < 1e-14 && (wheel.body.i3() - (0.5 + 0.81) / 2.0).abs() < 1e-14);
//! # Ok::<(), spincyl::Error>(())
//! ```

use super::hull::{Edge, Hull};
use super::{Body, Circle};
use crate::error::{Error, within};
use core::f64::consts::{PI, TAU};

/// The amount of matter in a part.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub enum Amount {
    /// The mass of the part.
    Mass(f64),
    /// Mass per volume of a solid part, per area of a thin one, per length of a ring.
    Density(f64),
}

/// The form of a part. All lengths are in one unit, and heights are measured upward from one point of the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub enum Form {
    /// A cylinder, a cone or a frustum: outer and inner radii at the lower and the upper end, the heights of both ends, and
    /// the radius by which both outer edges of a cylinder are rounded. The mass is that of the sharp body.
    Solid {
        /// Outer radii at the lower and the upper end.
        radii: [f64; 2],
        /// Inner radii at the lower and the upper end.
        bores: [f64; 2],
        /// Heights of the lower and the upper end.
        ends: [f64; 2],
        /// Radius of the fillets of both outer edges; 0 unless the solid is a cylinder.
        fillet: f64,
    },
    /// A ball, solid or hollow, or its part between two heights: outer and inner radius, height of the centre, both
    /// heights.
    Ball {
        /// Outer radius of the ball.
        radius: f64,
        /// Inner radius of the ball; 0 if it is solid.
        hollow: f64,
        /// Height of the centre of the ball.
        centre: f64,
        /// Heights between which the part lies.
        ends: [f64; 2],
    },
    /// A thin wall in the form of a cylinder, a cone, a frustum or a disk.
    Wall {
        /// Radii at the lower and the upper end.
        radii: [f64; 2],
        /// Heights of the lower and the upper end.
        ends: [f64; 2],
    },
    /// A thin spherical wall between two heights.
    Shell {
        /// Radius of the sphere.
        radius: f64,
        /// Height of the centre of the sphere.
        centre: f64,
        /// Heights between which the part lies.
        ends: [f64; 2],
    },
    /// A thin ring; a point on the axis if its radius is zero.
    Ring {
        /// Radius of the ring; 0 for a point on the axis.
        radius: f64,
        /// Height of the ring.
        height: f64,
    },
}

/// A part of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct BodyPart {
    /// Form of the part.
    pub form: Form,
    /// Mass or density of the part.
    pub amount: Amount,
}

impl BodyPart {
    /// A part of this form with this mass or density.
    pub fn new(form: Form, amount: Amount) -> Self {
        Self { form, amount }
    }
}

/// A body assembled from parts.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Assembled {
    /// The body, in natural units.
    pub body: Body,
    /// Mass of the body, in the unit of the parts.
    pub mass: f64,
    /// The unit of length R, the outer radius of the rim on which the body stands, in the unit of the parts; the largest
    /// outer radius if it stands on a tip.
    pub radius: f64,
    /// The height of the centre of mass, in the unit of the parts.
    pub centre: f64,
}

/// Mass of a part or of a body, its centre along the axis, and its second moments along and about the axis.
#[derive(Clone, Copy)]
pub(super) struct Mass {
    whole: f64,
    height: f64,
    /// Sum of (z - height)^2 dm, the second moment along the axis.
    along: f64,
    axial: f64,
}

/// Nodes and weights of Gauss's rule of quadrature on [0, 1].
const NODES: [[f64; 2]; 4] = [
    [0.069_431_844_202_973_71, 0.173_927_422_568_726_93],
    [0.330_009_478_207_571_87, 0.326_072_577_431_273_07],
    [0.669_990_521_792_428_1, 0.326_072_577_431_273_07],
    [0.930_568_155_797_026_3, 0.173_927_422_568_726_93],
];
/// The least theta_end of an assembled body, in radians.
const LEAST_END: f64 = 1e-6;
/// Largest distance of an edge from the origin of the heights, over the largest outer radius: for a body farther away
/// rounding would spoil the heights.
const FARTHEST: f64 = 1e5;
/// Least and largest length, mass and density that are accepted.
const SIZE: (f64, f64) = (0.0, 1e100);

impl Form {
    /// Returns an error that names the number that is out of range.
    pub(super) fn check(&self) -> Result<(), Error> {
        let size = |name, values: &[f64]| {
            values.iter().try_for_each(|x| within(name, *x, SIZE, "lengths of 0 to 1e100").map(drop))
        };
        let rises = |ends: [f64; 2], thin: bool| {
            let expected = "heights of at most 1e100, of the lower end and then of the upper end";
            within("ends", ends[0], (-SIZE.1, SIZE.1), expected)?;
            let least = if thin { ends[0] } else { ends[0].next_up() };
            within("ends", ends[1], (least, SIZE.1), expected).map(drop)
        };
        match *self {
            Self::Solid { radii, bores, ends, fillet } => {
                size("radii", &radii)?;
                rises(ends, false)?;
                for k in 0..2 {
                    within("bores", bores[k], (0.0, radii[k]), "inner radii from 0 to the outer ones")?;
                }
                let most = if radii[0] == radii[1] {
                    (0.5 * (ends[1] - ends[0])).min(radii[0] - bores[0].max(bores[1]))
                } else {
                    0.0
                };
                within(
                    "fillet",
                    fillet,
                    (0.0, most),
                    "0 or more, at most half the length and the thickness of the wall; 0 for a cone",
                )
                .map(drop)
            }
            Self::Ball { radius, hollow, centre, ends } => {
                size("radius", &[radius])?;
                within("hollow", hollow, (0.0, radius), "an inner radius from 0 to the outer one")?;
                rises(ends, false)?;
                Self::cuts(radius, centre, ends)
            }
            Self::Wall { radii, ends } => {
                size("radii", &radii)?;
                rises(ends, radii[0] != radii[1])
            }
            Self::Shell { radius, centre, ends } => {
                size("radius", &[radius])?;
                rises(ends, false)?;
                Self::cuts(radius, centre, ends)
            }
            Self::Ring { radius, height } => {
                size("radius", &[radius])?;
                within("height", height, (-SIZE.1, SIZE.1), "a height of at most 1e100").map(drop)
            }
        }
    }

    fn cuts(radius: f64, centre: f64, ends: [f64; 2]) -> Result<(), Error> {
        let far = radius + Self::slack(radius, centre);
        ends.iter().try_for_each(|z| {
            within("ends", z - centre, (-far, far), "heights that are within the ball").map(drop)
        })
    }

    /// The mass of the part at density 1, its centre and its second moments.
    pub(super) fn mass(&self) -> Mass {
        let of = |ends: [f64; 2], slice: &dyn Fn(f64) -> [f64; 2]| Mass::between(ends, slice);
        match *self {
            Self::Solid { radii, bores, ends, .. } => of(ends, &|x| {
                let [r, b] = [radii, bores].map(|[a, b]| a + x * (b - a));
                disk(r * r, b * b)
            }),
            Self::Ball { radius, hollow, centre, ends } => {
                let whole =
                    of(ends, &|x| disk(squared(radius, ends[0] + x * (ends[1] - ends[0]) - centre), 0.0));
                let [low, high] = [ends[0].max(centre - hollow), ends[1].min(centre + hollow)];
                if low >= high {
                    return whole;
                }
                whole.without(of([low, high], &|x| {
                    disk(squared(hollow, low + x * (high - low) - centre), 0.0)
                }))
            }
            Self::Wall { radii, ends } => {
                let long = (radii[1] - radii[0]).hypot(ends[1] - ends[0]);
                Mass::along(ends, &|x| {
                    let r = radii[0] + x * (radii[1] - radii[0]);
                    [long * TAU * r, r * r]
                })
            }
            Self::Shell { radius, centre, ends } => {
                of(ends, &|x| [TAU * radius, squared(radius, ends[0] + x * (ends[1] - ends[0]) - centre)])
            }
            Self::Ring { radius, height } => {
                let whole = if radius > 0.0 { TAU * radius } else { 1.0 };
                Mass { whole, height, along: 0.0, axial: whole * radius * radius }
            }
        }
    }

    /// The edges, and the ball, with which the part may touch the table.
    pub(super) fn edges(&self) -> Vec<Edge> {
        match *self {
            Self::Solid { radii, ends, fillet, .. } => vec![
                Edge::of(radii[0] - fillet, ends[0] + fillet, fillet),
                Edge::of(radii[1] - fillet, ends[1] - fillet, fillet),
            ],
            Self::Wall { radii, ends } => {
                vec![Edge::of(radii[0], ends[0], 0.0), Edge::of(radii[1], ends[1], 0.0)]
            }
            Self::Ball { radius, centre, ends, .. } | Self::Shell { radius, centre, ends } => {
                // A cut within a rounding error of the pole of the ball cuts nothing off.
                let pole = radius - Self::slack(radius, centre);
                let cut = ends.map(|z| (z - centre).abs() < pole);
                let at = |k: usize, whole: f64| {
                    if cut[k] { ((centre - ends[k]) / radius).acos() } else { whole }
                };
                let edge = |k: usize| Edge::of(squared(radius, ends[k] - centre).sqrt(), ends[k], 0.0);
                let ball = Edge { from: at(0, 0.0), to: at(1, PI), ..Edge::of(0.0, centre, radius) };
                (0..2).filter(|k| cut[*k]).map(edge).chain([ball]).collect()
            }
            Self::Ring { radius, height } => {
                if radius > 0.0 {
                    vec![Edge::of(radius, height, 0.0)]
                } else {
                    Vec::new()
                }
            }
        }
    }

    /// Error of the height of a ball's pole, due to the rounding of its radius and its centre.
    fn slack(radius: f64, centre: f64) -> f64 {
        4.0 * f64::EPSILON * (radius + centre.abs())
    }
}

/// The mass of a thin disk per unit of height at density 1, and the mean square of the distance from the axis.
fn disk(outer: f64, inner: f64) -> [f64; 2] {
    [PI * (outer - inner), 0.5 * (outer + inner)]
}

/// The square of the radius of a ball at a height above its centre.
fn squared(radius: f64, z: f64) -> f64 {
    (radius - z) * (radius + z)
}

impl Mass {
    /// The mass of slices between two heights, each with its mass per height and mean squared radius.
    fn between(ends: [f64; 2], slice: &dyn Fn(f64) -> [f64; 2]) -> Self {
        let length = ends[1] - ends[0];
        Self::along(ends, &|x| {
            let [mass, square] = slice(x);
            [length * mass, square]
        })
    }

    /// The mass of slices along a line between two heights. `slice` gives, at a share of the line from 0 to 1, the mass
    /// per share and the mean squared radius.
    fn along(ends: [f64; 2], slice: &dyn Fn(f64) -> [f64; 2]) -> Self {
        let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
            NODES
                .iter()
                .map(|[x, weight]| {
                    let [mass, square] = slice(*x);
                    weight * mass * of(*x, square)
                })
                .sum()
        };
        let whole = sum(&|_, _| 1.0);
        let (length, mean) = (ends[1] - ends[0], sum(&|x, _| x) / whole.max(f64::MIN_POSITIVE));
        Self {
            whole,
            height: ends[0] + mean * length,
            along: sum(&|x, _| (x - mean) * (x - mean)) * length * length,
            axial: sum(&|_, square| square),
        }
    }

    /// This mass without `inner`, which is a part of it.
    fn without(self, inner: Self) -> Self {
        let whole = self.whole - inner.whole;
        let height = (self.whole * self.height - inner.whole * inner.height) / whole;
        let moved = |of: Self| of.along + of.whole * (of.height - height) * (of.height - height);
        Self { whole, height, along: moved(self) - moved(inner), axial: self.axial - inner.axial }
    }

    pub(super) fn times(self, factor: f64) -> Self {
        let Self { whole, height, along, axial } = self;
        Self { whole: factor * whole, height, along: factor * along, axial: factor * axial }
    }
}

fn none(value: f64) -> Error {
    let expected = "parts with a positive mass, one of which has a rim or is a ball, to stand on";
    Error::OutOfRange { name: "parts", value, expected }
}

/// Assembles a body from parts on one axis.
///
/// The body stands on its lowest edge or ball, and on the widest of several edges at one height; it lands on every other
/// circle of its convex hull. Parts inside a concave outline do not touch the table. A body has two equal rims if it has
/// two circles, of which the other is as wide and as far from the centre of mass; then theta_end is pi/2.
///
/// # Errors
/// `OutOfRange` with the name of a number of a part that is out of range, or with "parts" for a body without mass or
/// extent; and those of [`Body::rounded`] and [`Body::profile`].
pub fn assembled(parts: &[BodyPart]) -> Result<Assembled, Error> {
    let (mut masses, mut edges) = (Vec::new(), Vec::new());
    for BodyPart { form, amount } in parts {
        form.check()?;
        let mass = form.mass();
        masses.push(match *amount {
            Amount::Mass(m) => {
                within("mass", m, SIZE, "a mass of 0 to 1e100")?;
                if mass.whole <= 0.0 && m > 0.0 {
                    return Err(none(mass.whole));
                }
                mass.times(if m > 0.0 { m / mass.whole } else { 0.0 })
            }
            Amount::Density(density) => {
                within("density", density, SIZE, "a density of 0 to 1e100")?;
                mass.times(density)
            }
        });
        edges.extend(form.edges());
    }
    of_masses(&masses, edges, |circles| circles[0].outer())
}

/// The body of these masses, which touches the table with these edges. `unit` chooses its unit of length R from the
/// edges on which it stands one after the other.
pub(super) fn of_masses(
    masses: &[Mass],
    edges: Vec<Edge>,
    unit: impl Fn(&[Edge]) -> f64,
) -> Result<Assembled, Error> {
    let whole: f64 = masses.iter().map(|x| x.whole).sum();
    if whole.is_nan() || whole <= 0.0 {
        return Err(none(whole));
    }
    let centre = masses.iter().map(|x| x.whole * x.height).sum::<f64>() / whole;
    let axial = masses.iter().map(|x| x.axial).sum::<f64>();
    let along = masses.iter().map(|x| x.along + x.whole * (x.height - centre).powi(2)).sum::<f64>();
    let far = edges.iter().map(|edge| edge.z.abs()).fold(0.0, f64::max);
    let wide = edges.iter().map(Edge::outer).fold(0.0, f64::max);
    within("height", far, (0.0, FARTHEST * wide), "heights measured from a point of the axis near the body")?;
    let hull = Hull::new(edges);
    let circles = hull.sequence();
    let rim = circles.first().ok_or(none(0.0))?;
    let widest = widest(&circles);
    if widest <= 0.0 {
        return Err(none(0.0));
    }
    let (theta_end, _) = hull.after(rim, 0.0);
    if theta_end < LEAST_END {
        let expected = "parts such that the body tilts by 1e-6 radians or more before another circle lands";
        return Err(Error::OutOfRange { name: "parts", value: theta_end, expected });
    }
    let radius = match unit(&circles) {
        0.0 => widest,
        given => given,
    };
    let per = 1.0 / (whole * radius * radius);
    let [i1, i3] = [(0.5 * axial + along) * per, axial * per];
    let (ell, fillet) = ((centre - rim.z) / radius, rim.rho / radius);
    let plain = match circles.as_slice() {
        [_] => ell >= 0.0 || fillet == 1.0 && ell > -1.0,
        [_, other] => hull.same(other, &rim.mirrored(centre)),
        _ => false,
    };
    let body = match plain && radius == rim.outer() {
        true => Body::rounded(ell, i1, i3, fillet)?.with_theta_end(theta_end)?,
        false => {
            let circle = |edge: &Edge| Circle {
                radius: edge.r / radius,
                depth: (centre - edge.z) / radius,
                fillet: edge.rho / radius,
            };
            Body::profile(&circles.iter().map(circle).collect::<Vec<_>>(), i1, i3)?
        }
    };
    Ok(Assembled { body, mass: whole, radius, centre })
}

/// The largest outer radius of these edges.
pub(super) fn widest(circles: &[Edge]) -> f64 {
    circles.iter().map(Edge::outer).fold(0.0, f64::max)
}
