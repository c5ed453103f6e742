//! The circles of a body, as seen from either end.
//!
//! ```text
//! from the other end   theta -> pi - theta,  l -> -l,  w2, w3, psi -> -,  phi + pi,  the row of circles reversed
//! ```
//! The walk sees one circle as a body of its own, with the circle that lands next at theta_end. It turns the body where the
//! other border of that circle is near, so that each landing is one at theta_end. Results are told from the lower end.
//!
//! Error: none; the borders are those of `profile`.

use super::profile::{CircleRow, Landings};
use super::{Body, Circle, Rim};
use crate::numbers::Sum;
use core::f64::consts::{FRAC_PI_2, PI};

/// Where one circle of a body follows another, while the body leans on.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct CircleBorder {
    /// The inclination at which both circles touch the table, in radians.
    pub theta: f64,
    /// The distance of both points of contact there, in R; 0 at a smooth joint.
    pub span: f64,
}

impl Body {
    /// The inclinations at which the contact passes from one circle of the body to the next, in ascending order, and the
    /// distances of the two points of contact there.
    ///
    /// ```
    /// let can = spincyl::Body::solid(2.0)?; // it lies on both rims at pi/2
    /// let border = can.borders()[0];
    /// assert_eq!((border.theta, border.span), (std::f64::consts::FRAC_PI_2, 4.0));
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    pub fn borders(&self) -> Vec<CircleBorder> {
        match &self.row {
            Some(row) => row.borders().map(|[theta, span]| CircleBorder { theta, span }).collect(),
            None if self.has_two_rims() => vec![CircleBorder { theta: FRAC_PI_2, span: 2.0 * self.ell }],
            None => Vec::new(),
        }
    }

    /// This body on the circle of a row that carries.
    pub(super) fn on(self, row: CircleRow) -> Self {
        let Circle { radius, depth, fillet } = row.here();
        let [low, theta_end] = row.range();
        let unit = radius + fillet == 1.0;
        let row = match (row.circles(), row.next()) {
            // A single circle is known to be the only one, unlike that of a body which may have another rim.
            ([_], _) if unit && (radius == 0.0 || depth <= 0.0) => None,
            ([_, _], Some(next)) if unit && next == (Circle { depth: 0.0 - depth, ..row.here() }) => None,
            _ => Some(row),
        };
        let rim = if unit { Sum::of(1.0, -fillet) } else { radius.into() };
        Self { ell: depth, fillet, rim, low, theta_end, row, ..self }
    }

    /// The circles of the body, from its lower end up.
    pub fn circles(&self) -> Vec<Circle> {
        let here = Circle { radius: self.rim.hi, depth: self.ell, fillet: self.fillet };
        match &self.row {
            Some(row) => row.circles().to_vec(),
            None if self.has_two_rims() => vec![here, Circle { depth: 0.0 - self.ell, ..here }],
            None => vec![here],
        }
    }

    /// Whether one of these circles, of which the body is made, lies in line with two others, with which it touches the table.
    pub(crate) fn passes_over(&self, given: &[Circle]) -> bool {
        self.row.is_some_and(|row| row.passes_over(given))
    }

    /// The circles of the body as rows of radius, height above the centre of mass, and fillet.
    pub(crate) fn rows(&self) -> impl Iterator<Item = [f64; 3]> {
        self.circles().into_iter().map(|circle| [circle.radius, 0.0 - circle.depth, circle.fillet])
    }

    /// Whether another circle of the body lands at theta_end.
    pub(crate) fn has_two_rims(&self) -> bool {
        match &self.row {
            Some(row) => row.next().is_some() && !row.joins_next(),
            None => self.ell > 0.0 && self.theta_end == FRAC_PI_2,
        }
    }

    /// The circle that lands at theta_end; without one, the mirror image of the circle that carries.
    pub(crate) fn next_rim(&self) -> Rim<f64> {
        let here = self.shape().rim;
        let next = self.row.as_ref().and_then(CircleRow::next);
        next.map_or(Rim { ell: -here.ell, ..here }, Circle::rim)
    }

    /// The circle that carries, and the one that lands at theta_end or its mirror image.
    pub(crate) fn rims(&self) -> [Rim<f64>; 2] {
        [self.shape().rim, self.next_rim()]
    }

    /// The circles that may land.
    pub(crate) fn landings(&self) -> Landings {
        match &self.row {
            Some(row) => row.landings(),
            None => Landings::of(self.shape().rim, self.has_two_rims().then(|| self.next_rim())),
        }
    }

    /// The number of the circle that carries, as seen from the same end.
    pub(crate) fn here_is(&self) -> usize {
        self.row.map_or(0, |row| row.here_is())
    }

    /// The body with this circle carrying, by its number as seen from the same end, as seen from the other end.
    pub(crate) fn turned_on(&self, at: usize) -> Self {
        self.row.and_then(|row| row.at(at)).map_or(*self, |row| self.on(row.turned()))
    }

    /// Whether the body is seen from the end that is farther from a circle at an end, whose face then is at theta = pi.
    pub(crate) fn is_seen_from_afar(&self) -> bool {
        self.low > 0.0 && self.theta_end == PI
    }

    /// The body with the circle carrying that lands at theta_end, as seen from the other end.
    pub(crate) fn beyond(&self) -> Self {
        self.turned_on(self.here_is() + 1)
    }

    /// The body as seen from its other end, with the same circle carrying.
    pub(crate) fn turned(&self) -> Self {
        self.row.map_or(*self, |row| self.on(row.turned()))
    }

    /// The body with this circle carrying, by its number as seen from the same end. It is seen from the other end if
    /// that is nearer to a circle at an end, whose face then is at theta = 0.
    pub(crate) fn on_circle(&self, at: usize) -> Self {
        let Some(row) = self.row.and_then(|row| row.at(at)) else { return *self };
        let body = self.on(row);
        if body.is_seen_from_afar() { body.turned() } else { body }
    }

    /// The body with the circle carrying that does so at this inclination, told from the lower end of the body.
    pub(crate) fn at(&self, theta: f64) -> Self {
        let Some(mut row) = self.row else { return *self };
        if row.is_over() {
            row = row.turned();
        }
        let carries = |at: &usize| row.at(*at).is_some_and(|row| theta <= row.range()[1]);
        let at = (0..row.circles().len()).find(carries).unwrap_or(row.circles().len() - 1);
        Self { row: Some(row), ..*self }.on_circle(at)
    }

    /// The same body standing on the circle with this index in [`circles`](Self::circles). States and poses of a motion refer
    /// to the lower end of the returned body. A body of one circle or of two equal rims is returned unchanged.
    ///
    /// ```
    /// use spincyl::{Body, State, body::Circle, pose::Pose};
    ///
    /// let cone = Body::cone(2.0)?;
    /// let over = State { theta: 2.0, w1: 0.0, w2: 0.0, w3: 0.0 };
    /// let height = Pose::start().centre(&cone.standing_on(1), &over).z;
    /// assert_eq!(height, cone.circles()[1].height(2.0));
    /// # Ok::<(), spincyl::Error>(())
    /// ```
    #[must_use]
    pub fn standing_on(&self, circle: u8) -> Self {
        let row = self.row.map(|row| if row.is_over() { row.turned() } else { row });
        row.and_then(|row| row.at(usize::from(circle))).map_or(*self, |row| self.on(row))
    }

    /// This body, standing on the circle that touches the table at this inclination.
    pub(crate) fn told_at(&self, theta: f64) -> Self {
        self.standing_on(self.at(theta).view().circles.map_or(0, |[here, _]| here))
    }

    /// The largest distance of the surface from the centre of mass.
    pub(crate) fn reach(&self) -> f64 {
        let of = |circle: &Circle| circle.depth.hypot(circle.radius) + circle.fillet;
        self.row.map_or_else(
            || self.ell.hypot(self.rim.hi) + self.fillet,
            |row| row.circles().iter().map(of).fold(0.0, f64::max),
        )
    }

    /// Where the circle that carries stands in the body.
    pub(crate) fn view(&self) -> View {
        let Some(row) = &self.row else { return View::default() };
        let number = |row: &CircleRow| row.number() as u8;
        let next = row.at(row.here_is() + 1);
        let (range, told) = (row.range(), row.told());
        let borders = [0, 1].map(|i| [range[i], told[if row.is_over() { 1 - i } else { i }]]);
        let circles = [number(row), next.as_ref().map_or(number(row), number)];
        View { over: row.is_over(), circles: Some(circles), borders }
    }

    /// Whether the body has circles that are neither one circle of radius 1 nor two equal rims.
    pub(crate) fn has_row(&self) -> bool {
        self.row.is_some()
    }

    /// Whether the circle that carries touches the next one at a smooth joint.
    pub(crate) fn joins_next(&self) -> bool {
        self.row.is_some_and(|row| row.joins_next())
    }

    /// Whether one of several circles lands at this inclination, told from the lower end of the body.
    pub(crate) fn lands_at(&self, theta: f64) -> bool {
        self.row.is_some_and(|row| row.borders().any(|[border, span]| span > 0.0 && theta == border))
    }

    /// Whether any two circles of the body touch at a smooth joint.
    pub(crate) fn has_joints(&self) -> bool {
        self.row.is_some_and(|row| row.borders().any(|[_, span]| span == 0.0))
    }

    /// The inclinations within which the circle that carries does so.
    pub(crate) fn carries(&self) -> [f64; 2] {
        [self.low, self.theta_end]
    }
}

/// How the circle that carries is seen, and its place in the body.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub(crate) struct View {
    /// Whether the state refers to the upper end of the body.
    pub over: bool,
    /// The numbers of the circle that carries and of the one that lands at theta_end; None for a body with one circle or
    /// two equal rims.
    pub circles: Option<[u8; 2]>,
    /// Both borders of the circle, for inclinations as in the state and for inclinations of the lower end.
    pub borders: [[f64; 2]; 2],
}

impl View {
    /// The inclination of the lower end of the body.
    pub fn tells(&self, theta: f64) -> f64 {
        let border = self.borders.iter().find(|[seen, _]| *seen == theta);
        border.map_or(PI - theta, |[_, told]| *told)
    }
}
