//! The profile of a body: a row of circles on which the body stands one after the other as it tilts over.
//!
//! ```text
//! Z_k(theta) = l_k c + a_k s + rho_k       height of the centre above the table where circle k carries
//! Z_k = Z_(k+1) at theta_k = atan2(da, dl) + acos(-drho/m),   m = hypot(da, dl),   d of l, a and rho: k minus k + 1
//! m > |drho|   both touch there, at the distance D = sqrt(m^2 - drho^2): the next circle lands
//! m = |drho|   one circle touches the other from within, as a ball touches the edge at which it is cut: D = 0, a smooth
//!              joint, at which nothing lands and the same point of the body goes on touching
//! m < |drho|   one lies inside the other
//! ```
//! The table touches the convex hull, so that a circle that never touches is not in the row. A body is seen from the end
//! of the circle that carries it: from the other end theta, l, w2, w3 and psi change to pi - theta, -l, -w2, -w3 and -psi,
//! phi to phi + pi, and the row is reversed.
//!
//! Error of theta_k: a few roundings, divided by sqrt(1 - (drho/m)^2), which is 1 for two sharp circles.

use super::{landing_angle, rim::Rim};
use crate::error::{Error, within};
use core::f64::consts::PI;

/// The largest number of circles of a body.
pub(crate) const MOST_CIRCLES: usize = 8;
/// m and |drho| (see the top of this file) count as equal if they differ by less than this share of m.
const JOINED: f64 = 1e-12;

/// A circle with which a body of revolution touches the table, rounded by a fillet. All lengths are in one unit.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Circle {
    /// Radius a of the circle about the axis; 0 for a ball, or for a tip.
    pub radius: f64,
    /// Distance l of the circle below the centre of mass, along the axis; negative above it.
    pub depth: f64,
    /// Radius rho of the fillet; the radius of the ball if `radius` is 0.
    pub fillet: f64,
}

impl Circle {
    pub(crate) fn rim(self) -> Rim<f64> {
        Rim { ell: self.depth, a: self.radius, rho: self.fillet }
    }

    /// The height of the centre of mass above the table where this circle touches the table at the inclination `theta`.
    pub fn height(self, theta: f64) -> f64 {
        self.rim().height(theta.sin_cos())
    }

    /// The inclination at which this circle and `next` both touch the table, and the distance D of their contact
    /// points; None where one circle lies inside the other.
    fn border(&self, next: &Self) -> Option<[f64; 2]> {
        let [a, l, rho] = [self.radius - next.radius, self.depth - next.depth, self.fillet - next.fillet];
        let (far, turn) = (a.hypot(l), a.atan2(l));
        if far < rho.abs() * (1.0 - JOINED) {
            return None;
        }
        if far <= rho.abs() * (1.0 + JOINED) {
            return Some([if rho > 0.0 { turn + PI } else { turn }, 0.0]);
        }
        Some([turn + (-rho / far).acos(), ((far - rho) * (far + rho)).sqrt()])
    }
}

/// The circles of a body that may land, as seen from the end to which the state refers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Landings {
    pub rims: [Rim<f64>; MOST_CIRCLES],
    /// The indices of the first and the last circle of each group that smooth joints connect; the first group holds the
    /// circle on which the body stands.
    groups: [[u8; 2]; MOST_CIRCLES],
    /// The number of groups, and the number of circles, of the body.
    pub count: usize,
    pub circles: usize,
    /// Cosines of the inclinations up to which each circle touches the table.
    tops: [f64; MOST_CIRCLES],
}

impl Landings {
    /// The landings of a body with one circle, `here`, or with two.
    pub fn of(here: Rim<f64>, there: Option<Rim<f64>>) -> Self {
        let mut groups = [[0; 2]; MOST_CIRCLES];
        groups[1] = [1; 2];
        let (mut rims, count) = ([here; MOST_CIRCLES], 1 + usize::from(there.is_some()));
        rims[1] = there.unwrap_or(here);
        Self { rims, groups, count, circles: count, tops: [-1.0; MOST_CIRCLES] }
    }

    /// The index of the circle of a group that is lowest at the inclination with this cosine.
    pub fn lowest(&self, group: usize, cosine: f64) -> usize {
        let [first, last] = self.groups[group].map(usize::from);
        (first..last).find(|k| cosine >= self.tops[*k]).unwrap_or(last)
    }

    /// The circles of the group with this index.
    pub fn group(&self, group: usize) -> &[Rim<f64>] {
        let [first, last] = self.groups[group].map(usize::from);
        &self.rims[first..=last]
    }

    /// The least angle, in radians, from an inclination to a smooth joint in the group of the circle on which the body stands.
    pub fn away_from_joint(&self, angle: (f64, f64)) -> f64 {
        let [first, last] = self.groups[0].map(usize::from);
        let joint = |k: usize| (self.tops[k].acos() - angle.0.atan2(angle.1)).abs();
        (first..last).map(joint).fold(f64::INFINITY, f64::min)
    }
}

/// The circles of a body in the order in which they touch the table as the inclination grows, as seen from one end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CircleRow {
    circles: [Circle; MOST_CIRCLES],
    count: usize,
    /// The index of the circle on which the body stands.
    at: usize,
    /// Whether the states refer to the upper end of the body.
    over: bool,
}

impl CircleRow {
    /// The row of circles of a body, from the lower end up, without those that never touch.
    pub fn of(given: &[Circle]) -> Result<Self, Error> {
        let none = Circle { radius: 0.0, depth: 0.0, fillet: 0.0 };
        let mut row = Self { circles: [none; MOST_CIRCLES], count: 0, at: 0, over: false };
        let refuse = |value, expected| Err(Error::OutOfRange { name: "circles", value, expected });
        'circles: for (k, circle) in given.iter().enumerate() {
            within("circles", circle.radius, (0.0, 1e100), "0 <= radius <= 1e100, of a circle")?;
            within("circles", circle.depth, (-1e100, 1e100), "-1e100 <= depth <= 1e100, of a circle")?;
            within("circles", circle.fillet, (0.0, 1e100), "0 <= fillet <= 1e100, of a circle")?;
            while row.count > 0 {
                let last = row.circles[row.count - 1];
                let Some([border, _]) = last.border(circle) else {
                    return refuse(
                        k as f64,
                        "circles of which none, with its fillet, lies inside another one; this value is the index of one",
                    );
                };
                // One that touches only at an end, as the inner edge of a tube does, never carries.
                if (border - PI).abs() < JOINED {
                    continue 'circles;
                }
                // A circle that would begin to carry before the one before it does lies inside the hull.
                let before = if row.count > 1 { row.border(row.count - 2) } else { 0.0 };
                if border > before + JOINED || row.count == 1 && border < -JOINED {
                    break;
                }
                row.count -= 1;
                row.circles[row.count] = none;
            }
            if row.count == MOST_CIRCLES {
                return refuse(given.len() as f64, "at most 8 circles that touch the table");
            }
            row.circles[row.count] = *circle;
            row.count += 1;
        }
        if row.count == 0 {
            return refuse(0.0, "at least one circle");
        }
        for k in 1..row.count {
            within(
                "circles",
                row.border(k - 1),
                (f64::MIN_POSITIVE, PI.next_down()),
                "circles in order, from the lower end up; two of them meet at this inclination",
            )?;
        }
        Ok(row)
    }

    /// Whether one of the given circles, which is left out of the row, touches the table together with two that are in it.
    pub fn passes_over(&self, given: &[Circle]) -> bool {
        let touches = |circle: &Circle, k: usize| {
            let (angle, here) = (landing_angle(self.border(k)), self.circles[k].rim());
            let lower = here.less(&circle.rim()).height(angle);
            lower.abs() <= JOINED * (here.reach() + circle.rim().reach()) && self.both(k)[1] > 0.0
        };
        let others = given.iter().filter(|circle| !self.circles().contains(circle));
        others.into_iter().any(|circle| (1..self.count).any(|k| touches(circle, k - 1)))
    }

    /// The circle on which the body stands.
    pub fn here(&self) -> Circle {
        self.circles[self.at]
    }

    /// The circle on which the body stands at larger inclinations; None for the last one.
    pub fn next(&self) -> Option<Circle> {
        (self.at + 1 < self.count).then(|| self.circles[self.at + 1])
    }

    fn both(&self, k: usize) -> [f64; 2] {
        self.circles[k].border(&self.circles[k + 1]).unwrap_or([f64::NAN; 2])
    }

    /// The inclination at which the contact passes from circle k to circle k + 1.
    fn border(&self, k: usize) -> f64 {
        self.both(k)[0]
    }

    /// The least and the largest inclination, of the lower end, at which the body stands on its present circle; 0 and
    /// pi at the ends.
    pub fn told(&self) -> [f64; 2] {
        let row = if self.over { self.turned() } else { *self };
        let low = if row.at == 0 { 0.0 } else { row.border(row.at - 1) };
        [low, if row.at + 1 < row.count { row.border(row.at) } else { PI }]
    }

    /// The least and the largest inclination at which the body stands on its present circle, as seen from the present end.
    pub fn range(&self) -> [f64; 2] {
        let [low, high] = self.told();
        let back = |theta: f64| if theta == PI { 0.0 } else { PI - theta };
        if self.over { [back(high), if low == 0.0 { PI } else { back(low) }] } else { [low, high] }
    }

    /// All circles of the row, from the end at which it begins.
    pub fn circles(&self) -> &[Circle] {
        &self.circles[..self.count]
    }

    /// The inclinations at which the contact passes from one circle to the next, each with the distance of the two
    /// contact points, 0 at a smooth joint.
    pub fn borders(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        (1..self.count).map(|k| self.both(k - 1))
    }

    /// The circles in the opposite order: the body turned upside down, so that its upper end touches the table.
    pub fn turned(&self) -> Self {
        let mut row = Self { at: self.count - 1 - self.at, over: !self.over, ..*self };
        row.circles[..self.count].reverse();
        row.circles.iter_mut().for_each(|circle| circle.depth = 0.0 - circle.depth);
        row
    }

    /// The row with the body standing on the circle of this index; None if there is no such circle.
    pub fn at(&self, at: usize) -> Option<Self> {
        (at < self.count).then_some(Self { at, ..*self })
    }

    /// The index of the circle on which the body stands, from the end at which the row begins.
    pub fn here_is(&self) -> usize {
        self.at
    }

    /// The index of the circle on which the body stands, from the lower end of the body.
    pub fn number(&self) -> usize {
        if self.over { self.count - 1 - self.at } else { self.at }
    }

    /// Whether the states refer to the upper end of the body.
    pub fn is_over(&self) -> bool {
        self.over
    }

    /// The circles that may land, in groups that smooth joints connect.
    pub fn landings(&self) -> Landings {
        let row = if self.over { self.turned() } else { *self };
        let mut all = Landings { circles: self.count, ..Landings::of(self.here().rim(), None) };
        let smooth = |k: usize| self.both(k)[1] == 0.0;
        let mut first = 0;
        for k in 0..self.count {
            all.rims[k] = self.circles[k].rim();
            let border =
                |k: usize| if self.over { PI - row.border(self.count - 2 - k) } else { row.border(k) };
            if k + 1 < self.count {
                all.tops[k] = border(k).cos();
            }
            if k + 1 == self.count || !smooth(k) {
                let group = all.count;
                if (first..=k).contains(&self.at) {
                    all.groups[0] = [first as u8, k as u8];
                } else {
                    all.groups[group] = [first as u8, k as u8];
                    all.count += 1;
                }
                first = k + 1;
            }
        }
        all
    }

    /// Whether the circle on which the body stands touches the next one at a smooth joint.
    pub fn joins_next(&self) -> bool {
        self.at + 1 < self.count && self.both(self.at)[1] == 0.0
    }
}
