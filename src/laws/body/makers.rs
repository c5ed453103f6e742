//! Uniform bodies with several circles: solids of revolution, hollow frusta, cones, and two balls of different radii.
//!
//! ```text
//! m = int r^2,   I3 = int r^4/2 / m,   I1 = int (r^4/4 + r^2 z^2)/m - z0^2,   z0 = int r^2 z / m
//! ```
//! `body::parts` computes the integrals; its rule is exact on each straight piece of the outline. For a piece that goes
//! down, the volume between this piece and the axis is subtracted.
//!
//! Error: a few roundings of the largest integral that is added or subtracted.

use super::Body;
use super::hull::Edge;
use super::parts::{Form, of_masses, widest};
use crate::error::{Error, within};

const LENGTH: (f64, f64) = (0.0, 1e50);

impl Body {
    /// Uniform frustum of a cone with the radius `bottom` at its lower end and `top` at its upper end, all in one unit of
    /// length; the unit R of the body is the larger radius. With a `wall` the frustum is hollow and open at both ends, and
    /// `wall` is the thickness measured across the axis; 0 is a thin wall.
    ///
    /// ```
    /// let cup = spincyl::Body::frustum(0.7, 1.0, 2.0, None)?;
    /// assert!((cup.i1() - 0.512_453_524_7).abs() < 1e-10);
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    ///
    /// # Errors
    /// `OutOfRange` for radii outside [0, 1e50] or both 0, for a height outside [1e-50, 1e50], for a wall that is
    /// negative or thicker than the smaller radius, and for a body that is too flat or too long; and those of
    /// [`profile`](Self::profile).
    pub fn frustum(bottom: f64, top: f64, height: f64, wall: Option<f64>) -> Result<Self, Error> {
        within("bottom", bottom, LENGTH, "0 <= bottom <= 1e50")?;
        within("top", top, LENGTH, "0 <= top <= 1e50")?;
        within("top", bottom.max(top), (1e-50, LENGTH.1), "bottom or top of 1e-50 or more")?;
        within("height", height, (1e-50, LENGTH.1), "1e-50 <= height <= 1e50")?;
        let (radii, ends) = ([bottom, top], [0.0, height]);
        let form = match wall {
            None => Form::Solid { radii, bores: [0.0; 2], ends, fillet: 0.0 },
            Some(0.0) => Form::Wall { radii, ends },
            Some(wall) => {
                within("wall", wall, (0.0, bottom.min(top)), "0 <= wall <= the smaller of bottom and top")?;
                Form::Solid { radii, bores: radii.map(|r| r - wall), ends, fillet: 0.0 }
            }
        };
        of_forms(&[(form, 1.0)], form.edges())
    }

    /// Uniform cone that stands on its tip, of this height over the radius R of its base.
    ///
    /// # Errors
    /// Those of [`frustum`](Self::frustum), whose argument `height` is this height.
    pub fn cone(height: f64) -> Result<Self, Error> {
        Self::frustum(0.0, 1.0, height, None)
    }

    /// Uniform solid whose outline is a line of straight pieces between these points (radius, height), from its lower end
    /// to its upper end, all in one unit of length; the unit R of the body is its largest radius. The line may go down into
    /// the body, as inside a cup, but must not cross itself; where it begins or ends beside the axis, a flat face closes it.
    ///
    /// ```
    /// let cup = spincyl::Body::lathe(&[[0.7, 0.0], [1.0, 2.0], [0.9, 2.0], [0.6, 0.1], [0.0, 0.1]])?;
    /// assert_eq!(cup.circles().len(), 2);
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    ///
    /// # Errors
    /// `OutOfRange`, with the name "points", for radii outside [0, 1e50], for heights outside [-1e50, 1e50], for a
    /// line that encloses no volume or does not rise from its lower end, and for heights far from 0; and those of
    /// [`profile`](Self::profile).
    pub fn lathe(points: &[[f64; 2]]) -> Result<Self, Error> {
        for [radius, height] in points {
            within("points", *radius, LENGTH, "radii of 0 to 1e50")?;
            within("points", *height, (-LENGTH.1, LENGTH.1), "heights of -1e50 to 1e50")?;
        }
        let piece = |pair: &[[f64; 2]]| {
            let ([r, low], [s, high]) = (pair[0], pair[1]);
            let (radii, ends, sign) =
                if low < high { ([r, s], [low, high], 1.0) } else { ([s, r], [high, low], -1.0) };
            (Form::Solid { radii, bores: [0.0; 2], ends, fillet: 0.0 }, sign)
        };
        let rises = points.windows(2).filter(|pair| pair[0][1] != pair[1][1]);
        let edges = points.iter().map(|[r, z]| Edge::of(*r, *z, 0.0)).collect();
        of_forms(&rises.map(piece).collect::<Vec<_>>(), edges).map_err(|error| match error {
            Error::OutOfRange { name: "parts" | "height", value, .. } => {
                let expected =
                    "an outline that rises from its lower end, encloses a volume, and is near the height 0";
                Error::OutOfRange { name: "points", value, expected }
            }
            other => other,
        })
    }

    /// Two solid balls of one density and of these radii, the lower one first, which touch (`separation = 1`) or have their
    /// centres `separation` times the sum of the radii apart on a light rod. The unit R of the body is the larger radius.
    ///
    /// # Errors
    /// `OutOfRange` for a separation outside [1, 1000], and for radii that are not positive, that exceed 1e50, or of
    /// which one is less than a thousandth of the other.
    pub fn unequal_balls(radii: [f64; 2], separation: f64) -> Result<Self, Error> {
        within("separation", separation, (1.0, 1e3), "1 <= separation <= 1000")?;
        let [lower, upper] = radii;
        for radius in radii {
            let most = lower.max(upper).min(LENGTH.1);
            within(
                "radii",
                radius,
                (1e-3 * most, most),
                "two radii, the smaller one at least a thousandth of the larger",
            )?;
        }
        let ball = |radius: f64, centre: f64| Form::Ball {
            radius,
            hollow: 0.0,
            centre,
            ends: [centre - radius, centre + radius],
        };
        let forms = [ball(lower, 0.0), ball(upper, separation * (lower + upper))];
        of_forms(&forms.map(|form| (form, 1.0)), forms.iter().flat_map(Form::edges).collect())
    }
}

/// The body of a sum of forms, each with the sign 1, or -1 for a form that is taken away.
fn of_forms(forms: &[(Form, f64)], edges: Vec<Edge>) -> Result<Body, Error> {
    let masses: Vec<_> = forms.iter().map(|(form, sign)| form.mass().times(*sign)).collect();
    Ok(of_masses(&masses, edges, widest)?.body)
}
