//! The shape with which a body of revolution touches the table, and the outline with which an engine draws the body.
//!
//! An outline is made for a body whose shape most engines lack: one with a fillet, or with several circles. A quarter
//! of a fillet has eight flat pieces whose corners lie on the circle. The inside of a body is known only if its moments
//! are those of a uniform tube.

use super::contents::{CirclesShape, SceneCircle, ShapeKind};
use crate::laws::body::Body;
use crate::methods::search;
use core::f64::consts::{FRAC_PI_2, PI};

/// Pieces of a quarter of a circle, and the number of pieces that are joined into one for drawing.
const QUARTER: usize = 32;
const PIECES: usize = 4;
/// Relative difference below which moments of inertia count as equal.
const ALIKE: f64 = 1e-12;
const EXPLAINED: &str = "all within swollen_by of the convex hull of the circles, which are about axis 3, at these \
                         heights over the centre of mass; at the inclination lands_at something else touches the table";
const OF_SEVERAL: &str = "the convex hull of the circles, each with all within its swollen_by, about axis 3 at these \
                          heights over the centre of mass; at the inclination lands_at the second one touches the table";

/// The ratio of inner to outer radius of the uniform tube that has the moments of inertia of a body; `None` if there is
/// no such tube.
fn bore(body: &Body) -> Option<f64> {
    let moments = |bore: f64| {
        Body::tube_on(body.ell().max(0.0), bore, body.fillet()).ok().map(|tube| [tube.i1(), tube.i3()])
    };
    let alike = |[i1, i3]: [f64; 2]| {
        (i1 - body.i1()).abs() <= ALIKE * body.i1() && (i3 - body.i3()).abs() <= ALIKE * body.i3()
    };
    if moments(0.0).is_some_and(alike) {
        return Some(0.0);
    }
    let (most, missing) = (body.rim(), |bore: f64| moments(bore).map_or(f64::NAN, |of| of[1] - body.i3()));
    if moments(most).is_some_and(alike) {
        return Some(most);
    }
    let (low, high) = (missing(0.0), missing(most));
    let found = (low < 0.0 && high > 0.0).then(|| search::crossing(missing, 0.0, most, low, high))?;
    moments(found).is_some_and(alike).then_some(found)
}

/// The shape of a body of revolution; `metre` is its unit of length R in metres.
pub(super) fn shape_of(body: &Body, metre: f64) -> CirclesShape {
    let body = &body.standing_on(0);
    let scaled = |outline: Vec<[f64; 2]>| outline.into_iter().map(|at| at.map(|x| metre * x)).collect();
    if body.has_row() {
        let told = body.circles().into_iter().map(|circle| SceneCircle {
            height: (0.0 - circle.depth) * metre,
            radius: circle.radius * metre,
            swollen_by: Some(circle.fillet * metre),
        });
        return CirclesShape {
            kind: ShapeKind::Circles,
            radius: metre,
            inner_radius: None,
            circles: told.collect(),
            swollen_by: None,
            half_length: None,
            lands_at: body.theta_end(),
            explained: OF_SEVERAL.into(),
            outline: scaled(hull_of(body)),
        };
    }
    let (ell, fillet, rim, both) = (body.ell(), body.fillet(), body.rim(), body.has_two_rims());
    let bore = bore(body);
    let kind = match () {
        () if both && fillet < 1.0 => ShapeKind::Cylinder,
        () if both && bore.is_some() => ShapeKind::Capsule,
        () if both => ShapeKind::Balls,
        () if fillet == 1.0 => ShapeKind::Ball,
        () => ShapeKind::Rim,
    };
    let heights = if both { vec![-ell, ell] } else { vec![-ell] };
    let circle = |z: f64| SceneCircle { height: z * metre, radius: rim * metre, swollen_by: None };
    CirclesShape {
        kind,
        radius: metre,
        inner_radius: bore.map(|bore| bore.min(0.98) * metre),
        circles: heights.into_iter().map(circle).collect(),
        swollen_by: Some(fillet * metre),
        half_length: both.then_some((ell + fillet) * metre),
        lands_at: body.theta_end(),
        explained: EXPLAINED.into(),
        outline: if 0.0 < fillet && fillet < 1.0 { scaled(rounded(body, bore)) } else { Vec::new() },
    }
}

/// Points (radius, height) on an arc of a circle, from one latitude to another.
fn arc([r, z]: [f64; 2], radius: f64, [start, stop]: [f64; 2], pieces: usize) -> Vec<[f64; 2]> {
    let step = (stop - start) / pieces as f64;
    let corner = |k: usize| {
        let angle = if k == pieces { stop } else { start + step * k as f64 };
        // A pole is exactly on the axis of the arc.
        let across = if angle.abs() > FRAC_PI_2 - 1e-12 { 0.0 } else { angle.cos() };
        [r + radius * across, z + radius * angle.sin()]
    };
    (0..=pieces).map(corner).collect()
}

/// Every n-th of these points of an outline, and the last point.
fn thinned(points: &[[f64; 2]], n: usize) -> Vec<[f64; 2]> {
    points.iter().step_by(n).chain(points.last()).copied().collect()
}

/// The outline of a body with one or two equal fillets.
fn rounded(body: &Body, bore: Option<f64>) -> Vec<[f64; 2]> {
    let (ell, fillet, rim) = (body.ell(), body.fillet(), body.rim());
    // A body that can be inclined beyond pi/2 although its centre is above its rim has nothing in the way above.
    let lower = bore.is_none() && body.theta_end() > FRAC_PI_2 + 1e-9;
    let (middle, wall) = if lower { (-ell, 0.0) } else { (0.0, ell) };
    let mut round = arc([rim, middle - wall], fillet, [-FRAC_PI_2, 0.0], QUARTER);
    let above = arc([rim, middle + wall], fillet, [0.0, FRAC_PI_2], QUARTER);
    round.extend(&above[usize::from(wall == 0.0)..]);
    let (low, high) = (round[0][1], above[QUARTER][1]);
    let mut all = thinned(&round, PIECES);
    let bore = bore.unwrap_or(0.0).min(0.98);
    let mut flat = |from, to| all.extend(thinned(&[from, to], 1));
    if rim - bore > 1e-6 {
        flat([rim, high], [bore, high]);
        flat([bore, low], [rim, low]);
    }
    if bore > 0.0 {
        flat([bore, high], [bore, low]);
    }
    all
}

/// The outline of a body of several circles from its lower end up.
fn hull_of(body: &Body) -> Vec<[f64; 2]> {
    const NARROW: f64 = 1e-6;
    let circles = body.circles();
    let mut ends = vec![0.0];
    ends.extend(body.borders().iter().map(|border| border.theta));
    ends.push(PI);
    let mut last = [0.0, -circles[0].depth - circles[0].fillet];
    let mut all = Vec::new();
    for (circle, border) in circles.iter().zip(ends.windows(2)) {
        let pieces = ((QUARTER as f64 * (border[1] - border[0]) / FRAC_PI_2).ceil() as usize).max(1);
        let centre = [circle.radius, 0.0 - circle.depth];
        let corners = arc(centre, circle.fillet, [border[0] - FRAC_PI_2, border[1] - FRAC_PI_2], pieces);
        if (last[0] - corners[0][0]).hypot(last[1] - corners[0][1]) > NARROW {
            all.extend(thinned(&[last, corners[0]], 1));
        }
        if circle.fillet > 0.0 {
            all.extend(thinned(&corners, PIECES));
        }
        last = corners[pieces];
    }
    if last[0] > NARROW {
        all.extend(thinned(&[last, [0.0, last[1]]], 1));
    }
    all
}
