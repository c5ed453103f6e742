//! Turning points and slow places of a motion, in the variable x = ln tan(theta/2).
//!
//! ```text
//! low < start < high   G = 0 at a turning point; else the face lands
//! dips                 least values of G between them: the body passes an unstable steady state slowly
//! G = (x - xa)(xb - x) H(x)
//! ```
//! The module `panel` carries P, n and G along x by power series, from one panel to the next. A zero of G is divided
//! out of the series, which keeps the digits of a small swing. Where two zeros of G nearly meet, or a minimum nearly
//! touches zero, rounding of G hides whether the motion turns or passes. There the module `carry` decides, with twice
//! the digits of a double.

use super::carry::Origin;
use super::panel::{
    Certainty, Dip, ORDER, Panel, PanelCentre, PanelTerms, Poles, divided_by_root, taylor, value,
};
use crate::laws::body::Body;
use crate::laws::contact::reduced::Reduced;
use crate::laws::contact::{Contact, FLAT};
use crate::laws::state::State;
use core::f64::consts::{FRAC_PI_2, PI};

/// Width in x below which a slow place is checked for a loss of digits; wider places do not lose any.
const NARROW_DIP: f64 = 0.03;
/// Relative rounding error of the width of a slow place above which the place is computed again with twice the
/// digits.
const REFINED: f64 = 1e-12;
/// Relative rounding error of the width of a slow place at which its computation with twice the digits ends.
const ENDS_REFINING: f64 = 1e-6;

/// Largest number of slow places on one side of the start that are computed with twice the digits, so that the search
/// ends even where rounding repeatedly shows a place that has been passed.
const MOST_RECOMPUTED: u32 = 3;

/// A ball whose least inclination is below this is assumed to pass exactly through its pole; the change is a rounding
/// error.
const POLE: f64 = 1e-13;

#[derive(Debug, Clone)]
pub(super) struct SwingEnd {
    pub x: f64,
    /// The turning point at this end of the swing; None where the face lands or a ball goes through its pole.
    pub turning: Option<Turning>,
}

#[derive(Debug, Clone)]
pub(super) struct Turning {
    pub panel: usize,
    pub local: f64,
    pub rest: PanelTerms,
}

/// A minimum of G = J sin(theta)^2 theta'^2 between the turning points, where the motion is slow; its place in its
/// panel, and its width.
#[derive(Debug, Clone, Copy)]
pub(super) struct SlowPlace {
    pub x: f64,
    pub panel: usize,
    pub local: f64,
    pub width: f64,
}

/// The motion between two turning points, or between a turning point and the face.
#[derive(Debug, Clone)]
pub(super) struct Lines {
    pub law: Reduced<f64>,
    poles: Poles,
    /// The variable x = ln tan(theta/2) at the start; the next fields are tan(theta/2) there, and the x of both
    /// limits of the circle of contact relative to the start.
    pub origin: f64,
    tangent: f64,
    pub borders: [f64; 2],
    /// Whether the body is a ball, which goes through its poles.
    ball: bool,
    pub panels: Vec<Panel>,
    pub ends: [SwingEnd; 2],
    /// The minima of G, ascending in x.
    pub slow: Vec<SlowPlace>,
    /// The quotient H of G by both ends, if these lie in the panel of the start.
    pub both: Option<DividedByEnds>,
}

/// The quotient H = G/((x - xa)(xb - x)) as a power series, and the values on which its rounding error depends.
#[derive(Debug, Clone)]
pub(super) struct DividedByEnds {
    pub h: PanelTerms,
    /// The end that is farther from the start; the next field is H there.
    far: f64,
    at_far: f64,
}

impl DividedByEnds {
    /// Rounding error of H = G/((x - xa)(xb - x)) at `y`, relative to H, in units of epsilon times the terms of G.
    ///
    /// G and G' are known at the start, and the curvature is not. An error of the curvature moves the farther end,
    /// which scales all of H by the relative error there; it also changes H at `y` in proportion to the distance of `y`
    /// from the start.
    pub fn share(&self, y: f64, h: f64) -> f64 {
        (y / self.far).abs().min(1.0) / h.abs() + 1.0 / self.at_far.abs()
    }
}

/// Whether the motion turns at a place or passes it, with the panel and the position in the panel.
enum TurnsOrPasses {
    Turns(usize, f64),
    Passes(SlowPlace),
}

impl Lines {
    /// Computes the motion between its turning points; None if it leaves the range in which it can be computed.
    pub fn new(body: &Body, contact: Contact, y: &State) -> Option<Self> {
        let from = Origin::new(body, contact, y);
        let tangent = (0.5 * y.theta).tan();
        let [s, c, ..] = from.start().at;
        let law = contact.reduced(body);
        let border = |theta: f64| match theta {
            0.0 => f64::NEG_INFINITY,
            theta => (c / s).hi.asinh() - cotangent(theta).asinh(),
        };
        let mut lines = Self {
            law,
            poles: Poles::of(&law),
            ball: body.is_ball(),
            origin: tangent.ln(),
            tangent,
            borders: body.carries().map(border),
            panels: Vec::new(),
            ends: [SwingEnd { x: 0.0, turning: None }, SwingEnd { x: 0.0, turning: None }],
            slow: Vec::new(),
            both: None,
        };
        let start = from.start();
        let first = lines
            .panel_about(0.0, from.centre(start))
            .with_exact_centre(from.g_and_slope(start), Certainty::Start);
        if !first.is_finite() {
            return None;
        }
        // The start is itself a slow place if G has its least value there.
        if first.g[0] > 0.0 && first.g[1] == 0.0 && first.g[2] > 0.0 {
            let width = (first.g[0] / first.g[2]).sqrt();
            lines.slow.push(SlowPlace { x: 0.0, panel: 0, local: 0.0, width });
        }
        lines.panels.push(first);
        for (side, way) in [(0, -1.0), (1, 1.0)] {
            lines.ends[side] = lines.end(&from, way)?;
        }
        lines.slow.sort_by(|a, b| a.x.total_cmp(&b.x));
        // The same slow place may have been met on both sides of the start, or again by a computation in
        // twice the digits. The latest panel has the most accurate one.
        lines.slow.dedup_by(|b, a| {
            let same = b.x - a.x < 4.0 * a.width.max(b.width);
            if same && b.panel > a.panel {
                *a = *b;
            }
            same
        });
        lines.both = lines.divided_by_ends();
        Some(lines)
    }

    fn panel_about(&self, centre: f64, start: PanelCentre) -> Panel {
        let reach = self.poles.reach(self.origin + centre);
        crate::numbers::in_registers!(Panel::new(&self.law, centre, reach, start))
    }

    /// Computes the motion to its end at smaller theta (`way` = -1) or at larger theta (`way` = 1).
    fn end(&mut self, from: &Origin, way: f64) -> Option<SwingEnd> {
        let face = way * -(0.5 * self.flat_inclination()).ln() - self.origin;
        let (mut panel, mut y) = (0, 0.0);
        let mut looks = MOST_RECOMPUTED;
        'panels: loop {
            let mut dips = Vec::new();
            let turn = self.panels[panel].first_zero_or_dips(y, way, &mut dips);
            for dip in dips {
                let slow = self.slow_place_at(panel, dip);
                if way * (face - slow.x) <= 0.0 {
                    break;
                }
                let doubtful = looks > 0 && self.doubtful_dip(&slow);
                let settled = if doubtful { self.turns_or_passes(from, slow.x, way) } else { None };
                looks -= u32::from(doubtful);
                match settled {
                    None => self.slow.push(slow),
                    Some(TurnsOrPasses::Turns(panel, local)) => {
                        return Some(self.turning_end(panel, local, way));
                    }
                    Some(TurnsOrPasses::Passes(slow)) => {
                        (panel, y) = (slow.panel, slow.local);
                        self.slow.push(slow);
                        continue 'panels;
                    }
                }
            }
            let Panel { centre, reach, .. } = self.panels[panel];
            if let Some(local) = turn {
                if way * (face - (centre + local)) <= 0.0 {
                    return Some(SwingEnd { x: face, turning: None });
                }
                let doubtful = looks > 0 && self.doubtful_turn(panel, local);
                let settled = if doubtful { self.turns_or_passes(from, centre + local, way) } else { None };
                looks -= u32::from(doubtful);
                match settled {
                    None => return Some(self.turning_end(panel, local, way)),
                    Some(TurnsOrPasses::Turns(panel, local)) => {
                        return Some(self.turning_end(panel, local, way));
                    }
                    Some(TurnsOrPasses::Passes(slow)) => {
                        (panel, y) = (slow.panel, slow.local);
                        self.slow.push(slow);
                        continue;
                    }
                }
            }
            if way * (face - (centre + way * reach)) <= 0.0 {
                return Some(SwingEnd { x: face, turning: None });
            }
            let next = centre + way * reach;
            let edge = &self.panels[panel];
            let [p, n, k] = [&edge.p, &edge.n, &edge.k].map(|series| value(series, way * reach));
            let (s, c) = self.angle(next);
            let fresh = self.panel_about(next, PanelCentre { at: [s, c, p, n], k, size: edge.size(reach) });
            if !fresh.is_finite() {
                return None;
            }
            self.panels.push(fresh);
            (panel, y) = (self.panels.len() - 1, 0.0);
        }
    }

    fn turning_end(&self, panel: usize, local: f64, way: f64) -> SwingEnd {
        let rest = divided_by_root(&self.panels[panel].g, local).map(|g| -way * g);
        SwingEnd { x: self.panels[panel].centre + local, turning: Some(Turning { panel, local, rest }) }
    }

    fn slow_place_at(&self, panel: usize, dip: Dip) -> SlowPlace {
        SlowPlace { x: self.panels[panel].centre + dip.local, panel, local: dip.local, width: dip.width }
    }

    /// The size of the terms whose sum is G, at `y` in a panel.
    pub fn terms_at(&self, panel: usize, y: f64) -> f64 {
        let Panel { centre, p, n, .. } = &self.panels[panel];
        let (s, c) = self.angle(centre + y);
        self.terms(panel, y, [s, c, value(p, y), value(n, y)])
    }

    /// The size of the terms whose sum is G, from sine and cosine of theta, P = w1 sin(theta) and n = w3.
    pub fn terms(&self, panel: usize, y: f64, [s, c, p, n]: [f64; 4]) -> f64 {
        let (of, rim, m) = (self.law.at((s, c)), &self.law.shape.rim, n * s);
        let weight = s * s * self.panels[panel].size(y);
        if self.law.round {
            let slide = (rim.radius((s, c)) * m).abs() + (rim.depth((s, c)) * p).abs();
            // The coefficients of a rounded rim are sums themselves, which adds to their rounding error.
            3.0 * (weight + self.law.shape.i1 * p * p + slide * slide)
        } else {
            let slide = p.abs() + (of.k / of.al * m).abs();
            weight + of.al * slide * slide
        }
    }

    /// The rounding error of G at `y` in a panel.
    pub fn rounding(&self, panel: usize, y: f64) -> f64 {
        self.panels[panel].rounding(y, self.terms_at(panel, y))
    }

    fn doubtful_dip(&self, slow: &SlowPlace) -> bool {
        let g = value(&self.panels[slow.panel].g, slow.local).max(f64::MIN_POSITIVE);
        slow.width < NARROW_DIP && self.rounding(slow.panel, slow.local) > REFINED * g
    }

    /// Whether rounding hides the distance of a turning point from the next zero of G.
    fn doubtful_turn(&self, panel: usize, local: f64) -> bool {
        let [_, slope, half, _] = taylor(&self.panels[panel].g, local);
        if half <= 0.0 {
            return false;
        }
        let width = slope.abs() / half;
        let near = self.panels[panel].known != Certainty::Rounded && local.abs() < 1e-3 * width;
        let size = (half * width * width).max(f64::MIN_POSITIVE);
        width < NARROW_DIP && !near && self.rounding(panel, local) > REFINED * size
    }

    /// Whether the motion in the direction `way` turns near the place `x` or passes it, computed from the start with
    /// twice the digits.
    fn turns_or_passes(&mut self, from: &Origin, mut x: f64, way: f64) -> Option<TurnsOrPasses> {
        const ROUNDS: u32 = 4;
        for round in 1..=ROUNDS {
            let place = from.place_in_full(self.origin, x);
            let carried = self
                .panel_about(x, from.centre(&place))
                .with_exact_centre(from.g_and_slope(&place), Certainty::Carried);
            if !carried.is_finite() {
                return None;
            }
            let (y, passes, size) = nature_of_minimum(&carried.g, way)?;
            let panel = self.panels.len();
            self.panels.push(carried);
            if self.rounding(panel, y) <= ENDS_REFINING * size || round == ROUNDS || x + y == x {
                return Some(if passes {
                    let half = taylor(&self.panels[panel].g, y)[2];
                    let width = (size.max(f64::MIN_POSITIVE) / half).sqrt();
                    TurnsOrPasses::Passes(SlowPlace { x: x + y, panel, local: y, width })
                } else {
                    TurnsOrPasses::Turns(panel, y)
                });
            }
            self.panels.pop();
            x += y;
        }
        None
    }

    /// Computes the quotient H of G by both ends. The division by the nearer end comes first, from the highest term
    /// down; the lowest term of the second quotient depends on G' at the centre and is computed from the lowest term
    /// of the first.
    fn divided_by_ends(&self) -> Option<DividedByEnds> {
        let [SwingEnd { turning: Some(low), .. }, SwingEnd { turning: Some(high), .. }] = &self.ends else {
            return None;
        };
        if low.panel != high.panel {
            return None;
        }
        // The low quotient is G/(x - xa) = (xb - x) H, the high one G/(xb - x) = (x - xa) H.
        let (near, far, sign) = if low.local.abs() <= high.local.abs() {
            (low, high.local, -1.0)
        } else {
            (high, low.local, 1.0)
        };
        let mut h = divided_by_root(&near.rest, far).map(|g| sign * g);
        if far != 0.0 {
            h[0] = -sign * near.rest[0] / far;
        }
        Some(DividedByEnds { far, at_far: value(&h, far), h })
    }

    /// Both ends of the swing in x = ln tan(theta/2), measured from the start.
    pub fn range(&self) -> [f64; 2] {
        [self.ends[0].x, self.ends[1].x]
    }

    /// Whether the face lands at the lower end and at the upper end; a ball has no face.
    pub fn lands(&self) -> [bool; 2] {
        self.reaches_pole().map(|reaches| reaches && !self.ball)
    }

    /// Whether the axis becomes vertical at the lower end and at the upper end.
    pub fn reaches_pole(&self) -> [bool; 2] {
        [self.ends[0].turning.is_none(), self.ends[1].turning.is_none()]
    }

    /// The inclination below which a body counts as on its face, or a ball as at its pole, in radians.
    pub fn flat_inclination(&self) -> f64 {
        if self.ball { POLE } else { FLAT }
    }

    /// The panel whose centre is nearest to x.
    pub fn panel(&self, x: f64) -> usize {
        let distance = |i: &usize| (x - self.panels[*i].centre).abs();
        (0..self.panels.len()).min_by(|i, j| distance(i).total_cmp(&distance(j))).unwrap_or(0)
    }

    /// tan(theta/2) at the distance `x` from the start, which keeps the digits of the start and of the distance.
    fn tangent(&self, x: f64) -> f64 {
        self.tangent * x.exp()
    }

    pub fn theta(&self, x: f64) -> f64 {
        2.0 * self.tangent(x).atan()
    }

    /// sin theta and cos theta at the distance `x` from the start.
    pub fn angle(&self, x: f64) -> (f64, f64) {
        let t = self.tangent(x);
        // The inverse of t > 1 does not overflow when it is squared.
        let (r, sign) = if t > 1.0 { (1.0 / t, -1.0) } else { (t, 1.0) };
        let square = r * r;
        (2.0 * r / (1.0 + square), sign * (1.0 - r) * (1.0 + r) / (1.0 + square))
    }
}

/// cot theta, exactly 0 at pi/2 and minus infinity at pi.
fn cotangent(theta: f64) -> f64 {
    if theta == FRAC_PI_2 {
        0.0
    } else if theta >= PI {
        f64::NEG_INFINITY
    } else {
        1.0 / theta.tan()
    }
}

/// For a minimum of G close to 0: its place if it is positive, else that of the first zero in the direction `way`;
/// whether the minimum is positive, so that the motion passes; and the size of G with which its rounding error is
/// compared. None without a minimum within a distance of 0.2 in x.
fn nature_of_minimum(g: &PanelTerms, way: f64) -> Option<(f64, bool, f64)> {
    let slope: PanelTerms =
        core::array::from_fn(|i| if i + 1 < ORDER { (i + 1) as f64 * g[i + 1] } else { 0.0 });
    let mut least = -g[1] / (2.0 * g[2]);
    for _ in 0..6 {
        let [value, rise, _, _] = taylor(&slope, least);
        let step = value / rise;
        if step.abs() > 0.2 || step.is_nan() {
            return None;
        }
        least -= step;
    }
    let [bottom, _, half, _] = taylor(g, least);
    if half <= 0.0 || least.abs() > 0.2 {
        return None;
    }
    if bottom > 0.0 {
        return Some((least, true, bottom));
    }
    // The zeros of the parabola, computed without cancellation, are the first estimates; the one that is met first is
    // taken.
    let root = (g[1] * g[1] - 4.0 * g[0] * g[2]).max(0.0).sqrt();
    let q = -0.5 * (g[1] + if g[1] < 0.0 { -root } else { root });
    let zeros = [q / g[2], g[0] / q];
    let first = zeros.into_iter().filter(|y| y.is_finite()).min_by(|a, b| (way * a).total_cmp(&(way * b)));
    let mut y = first.unwrap_or(least);
    for _ in 0..4 {
        let [value, rise, _, _] = taylor(g, y);
        let step = value / rise;
        if value == 0.0 || step.abs() > 0.1 || step.is_nan() {
            break;
        }
        y -= step;
    }
    let rise = taylor(g, y)[1];
    Some((y, false, rise * rise / half))
}
