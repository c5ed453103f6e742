//! The circles of a body, as seen from either end.
//!
//! ```text
//! from the other end   theta -> pi - theta,  l -> -l,  w2, w3, psi -> -,  phi + pi,  the row of circles reversed
//! ```
//! A motion treats one circle as a body with a single rim: the circle on which the body stands, with the circle that
//! lands next at theta_end. It turns the body end for end where the inclination nears the other end of this circle's
//! range, so that each landing is at theta_end. Results refer to the lower end of the body.
//!
//! Error: none beyond that of the inclinations from `profile`.

use super::profile::{CircleRow, Landings};
use super::{Body, Circle, Rim};
use crate::numbers::Sum;
use core::f64::consts::{FRAC_PI_2, PI};

/// The place where the contact passes from one circle of a body to the next as the inclination grows.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct CircleBorder {
    /// The inclination at which both circles touch the table, in radians.
    pub theta: f64,
    /// The distance between the two contact points at this inclination, in R; 0 at a smooth joint.
    pub span: f64,
}

impl Body {
    /// The inclinations at which the contact passes from one circle of the body to the next, in ascending order, each
    /// with the distance between the two contact points at this inclination.
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

    /// This body on the current circle of a row of circles.
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

    /// Whether one of the given circles, from which the body was made, touches the table together with two others.
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

    /// The circle that lands at theta_end; if there is none, the mirror image of the circle on which the body stands.
    pub(crate) fn next_rim(&self) -> Rim<f64> {
        let here = self.shape().rim;
        let next = self.row.as_ref().and_then(CircleRow::next);
        next.map_or(Rim { ell: -here.ell, ..here }, Circle::rim)
    }

    /// The circle on which the body stands, and the circle that lands at theta_end or, without one, the mirror image of
    /// the first.
    pub(crate) fn rims(&self) -> [Rim<f64>; 2] {
        [self.shape().rim, self.next_rim()]
    }

    /// The circles of the body that may land.
    pub(crate) fn landings(&self) -> Landings {
        match &self.row {
            Some(row) => row.landings(),
            None => Landings::of(self.shape().rim, self.has_two_rims().then(|| self.next_rim())),
        }
    }

    /// The index of the circle on which the body stands, counted from the end to which the state refers.
    pub(crate) fn here_is(&self) -> usize {
        self.row.map_or(0, |row| row.here_is())
    }

    /// The body as seen from its other end, standing on circle `at`, an index that is counted from the present end.
    pub(crate) fn turned_on(&self, at: usize) -> Self {
        self.row.and_then(|row| row.at(at)).map_or(*self, |row| self.on(row.turned()))
    }

    /// Whether the body stands on an end circle and is seen from the opposite end, so that its face is at theta = pi.
    pub(crate) fn is_seen_from_afar(&self) -> bool {
        self.low > 0.0 && self.theta_end == PI
    }

    /// The body as seen from its other end, standing on the circle that lands at theta_end.
    pub(crate) fn beyond(&self) -> Self {
        self.turned_on(self.here_is() + 1)
    }

    /// The body as seen from its other end, standing on the same circle.
    pub(crate) fn turned(&self) -> Self {
        self.row.map_or(*self, |row| self.on(row.turned()))
    }

    /// The body on circle `at`, an index that is counted from the present end. If `at` is an end circle, the result is
    /// seen from that end, so that the face is at theta = 0.
    pub(crate) fn on_circle(&self, at: usize) -> Self {
        let Some(row) = self.row.and_then(|row| row.at(at)) else { return *self };
        let body = self.on(row);
        if body.is_seen_from_afar() { body.turned() } else { body }
    }

    /// The body on the circle that touches the table at `theta`, an inclination of the lower end of the body.
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

    /// This body, seen from its lower end, on the circle that touches the table at this inclination.
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

    /// The circle on which the body stands: its place in the body, and the inclinations at which it touches the table.
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

    /// Whether the circle on which the body stands touches the next one at a smooth joint.
    pub(crate) fn joins_next(&self) -> bool {
        self.row.is_some_and(|row| row.joins_next())
    }

    /// Whether a circle lands at `theta`, an inclination of the lower end of the body; false for a body without a row of circles.
    pub(crate) fn lands_at(&self, theta: f64) -> bool {
        self.row.is_some_and(|row| row.borders().any(|[border, span]| span > 0.0 && theta == border))
    }

    /// Whether any two circles of the body touch at a smooth joint.
    pub(crate) fn has_joints(&self) -> bool {
        self.row.is_some_and(|row| row.borders().any(|[_, span]| span == 0.0))
    }

    /// The inclinations between which the body stands on its present circle, in radians.
    pub(crate) fn carries(&self) -> [f64; 2] {
        [self.low, self.theta_end]
    }
}

/// The end from which a body is seen, the circle on which it stands, and the inclinations between which it does so.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub(crate) struct View {
    /// Whether the state refers to the upper end of the body.
    pub over: bool,
    /// The indices, from the lower end of the body, of the circle on which it stands and of the circle that lands at
    /// theta_end; None for a body with one circle or two equal rims.
    pub circles: Option<[u8; 2]>,
    /// The least and the largest inclination of the circle, each as [inclination of the state, inclination of the lower end].
    pub borders: [[f64; 2]; 2],
}

impl View {
    /// The inclination of the lower end of the body, from the inclination `theta` of the upper end.
    pub fn tells(&self, theta: f64) -> f64 {
        let border = self.borders.iter().find(|[seen, _]| *seen == theta);
        border.map_or(PI - theta, |[_, told]| *told)
    }
}
