//! The convex hull of a profile: on which circle a body stands, and the inclination at which another one touches.
//!
//! ```text
//! d(theta) = r s - z c + rho       depth of an edge (r, z), rounded by rho, below the point z = 0 of the axis
//! d of another edge - d of this one = m sin(theta - turn) - e
//!     m e^(i turn) = (change of r) + i (change of z),    e = rho of this edge - rho of the other
//! ```
//! The table touches the convex hull of a body, and the edge that carries the body is the deepest one. Another edge
//! becomes deeper where the sine above is e/m and rises. If m = |e|, one circle touches the other from within, as a ball
//! touches the edge at which it is cut: neither edge passes the other, and the contact moves on smoothly where the
//! inclinations at which they touch the table meet. The double zero of the difference says nothing there.
//!
//! Error: a few roundings of the angle, divided by sqrt(1 - (e/m)^2), which is 1 for two sharp edges.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

/// A circle of radius `r` at the height `z`, rounded by `rho`, that touches the table for theta within `from` and `to`;
/// a ball if `r` is zero.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    pub r: f64,
    pub z: f64,
    pub rho: f64,
    pub from: f64,
    pub to: f64,
}

/// Lengths that differ by less than this share of the largest radius, or by the rounding of heights, count as equal.
const ALIKE: f64 = 1e-12;

impl Edge {
    /// A single edge with this radius, height and fillet; it touches the table at every inclination.
    pub fn of(r: f64, z: f64, rho: f64) -> Self {
        Self { r, z, rho, from: 0.0, to: PI }
    }

    /// The outer radius of the edge, with its fillet.
    pub fn outer(&self) -> f64 {
        self.r + self.rho
    }

    /// The mirror image of the edge in the horizontal plane at a height.
    pub fn mirrored(&self, height: f64) -> Self {
        Self { z: 2.0 * height - self.z, ..*self }
    }

    fn depth(&self, theta: f64) -> f64 {
        self.r * theta.sin() - self.z * theta.cos() + self.rho
    }

    /// Derivative of the depth of the edge with respect to the inclination.
    fn lever(&self, theta: f64) -> f64 {
        self.r * theta.cos() + self.z * theta.sin()
    }
}

/// The edges of a body that can touch the table.
pub(super) struct Hull {
    edges: Vec<Edge>,
    /// Lengths below `small` count as zero.
    small: f64,
}

impl Hull {
    pub fn new(given: Vec<Edge>) -> Self {
        let most = |of: fn(&Edge) -> f64| given.iter().map(of).fold(0.0, f64::max);
        let small = ALIKE * most(Edge::outer) + 8.0 * f64::EPSILON * most(|edge| edge.z.abs());
        let mut hull = Self { edges: Vec::with_capacity(given.len()), small };
        for mut edge in given {
            // Arcs that continue each other are one circle, as the halves of a ball are.
            while let Some(k) = hull.edges.iter().position(|other| hull.continues(other, &edge)) {
                let other = hull.edges.swap_remove(k);
                (edge.from, edge.to) = (edge.from.min(other.from), edge.to.max(other.to));
            }
            hull.edges.push(edge);
        }
        hull
    }

    fn continues(&self, a: &Edge, b: &Edge) -> bool {
        self.same(a, b) && (a.from.max(b.from) - a.to.min(b.to)) * a.rho <= self.small
    }

    /// Whether two edges are parts of one circle.
    pub fn same(&self, a: &Edge, b: &Edge) -> bool {
        [a.r - b.r, a.z - b.z, a.rho - b.rho].iter().all(|x| x.abs() <= self.small)
    }

    /// The edge on which the body stands as soon as its axis is no longer upright, which may be a tip.
    ///
    /// Of several edges at one height this is the widest, since its depth grows fastest, and of balls the largest one.
    pub fn rim(&self) -> Option<Edge> {
        let down = || self.edges.iter().filter(|edge| edge.from == 0.0);
        let deepest = down().map(|edge| edge.depth(0.0)).fold(f64::NEG_INFINITY, f64::max);
        let lowest = || down().filter(|edge| edge.depth(0.0) >= deepest - self.small);
        let widest = lowest().map(|edge| edge.r).fold(0.0, f64::max);
        let rims = lowest().filter(|edge| edge.r >= widest - self.small);
        rims.max_by(|a, b| a.rho.total_cmp(&b.rho)).copied()
    }

    /// The edges on which the body stands one after the other as it tilts from the upright to the inverted position.
    pub fn sequence(&self) -> Vec<Edge> {
        let mut all: Vec<Edge> = self.rim().into_iter().collect();
        let mut from = 0.0;
        // Each edge can touch the table once, and a ball between its cuts twice.
        while let Some(last) = all.last().filter(|_| all.len() <= 2 * self.edges.len()) {
            let (end, next) = self.after(last, from);
            let Some(next) = next else { break };
            from = end;
            all.push(next);
        }
        all
    }

    /// The inclination up to which the body stands on `rim`, from the inclination `from` on, and the edge that touches
    /// the table at its end; pi and None if no other edge lands.
    pub fn after(&self, rim: &Edge, from: f64) -> (f64, Option<Edge>) {
        let others = || self.edges.iter().filter(|edge| !self.same(edge, rim));
        let passes = others().filter_map(|other| self.passes(rim, other));
        let end = passes.filter(|theta| *theta >= from - ALIKE).fold(rim.to, f64::min);
        // Of several edges that touch at once the body goes on to the one that becomes deepest.
        let touches = |edge: &&Edge| {
            (edge.depth(end) - rim.depth(end)).abs() <= self.small && end <= edge.to && end >= edge.from
        };
        let next = others().filter(touches).max_by(|a, b| {
            let [a, b] = [a, b].map(|edge| [edge.lever(end), edge.rho]);
            a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
        });
        match next {
            _ if end == PI => (PI, None),
            // A higher circle of the same outer radius touches at a right angle.
            Some(next) if (next.outer() - rim.outer()).abs() <= self.small && next.z > rim.z => {
                (FRAC_PI_2, Some(*next))
            }
            next => (end, next.copied()),
        }
    }

    /// The inclination at which another edge becomes deeper than the edge on which the body stands.
    fn passes(&self, rim: &Edge, other: &Edge) -> Option<f64> {
        let (a, b, e) = (other.r - rim.r, other.z - rim.z, rim.rho - other.rho);
        let far = a.hypot(b);
        if e >= far - self.small {
            return None;
        }
        if -e >= far - self.small {
            return Some(other.from);
        }
        let (turn, by) = (b.atan2(a), (e / far).asin());
        let theta = (turn + by).rem_euclid(TAU);
        (theta > 0.0 && theta >= other.from && theta <= other.to).then_some(theta)
    }
}
