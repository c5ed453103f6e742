//! Divides the swing from one turning point to the other into stretches, each with a variable v in which the time
//! grows evenly.
//!
//! ```text
//! whole   x = mid - amp cos u,                G = (x - xa)(xb - x) H       dx/du/sqrt(G) = 1/sqrt(H)
//! end     d = w sinh^2 v,                     G = d R                      dx/dv/sqrt(G) = 2 sqrt(w) cosh v/sqrt(R)
//! dip     d = w sinh v                                                     dx/dv/sqrt(G) = w cosh v/sqrt(G)
//! face    d = v                                                            dx/dv/sqrt(G) = 1/sqrt(G)
//! ```
//! The distance d = |x - place| is measured from the end or from the slow place. A swing without a slow place is one
//! stretch. Near an unstable steady state a body lingers. If it turns there, w is the distance from the end to the next
//! zero of G; if it passes a minimum of G, w is the width of this minimum. Then a stretch covers half the distance to
//! the next slow place: dt/dv is constant while the body lingers and changes only in the last three units of v, which
//! goes up to 19 for w = 1e-16. The width w only chooses the variable, so its order of magnitude is enough.
//!
//! Error: [`StretchPoint::noise`], the relative rounding error of H, R or G, which is propagated through the integrals.

use super::lines::{Lines, SlowPlace, Turning};
use super::panel::{PanelTerms, taylor, value};
use core::f64::consts::PI;

/// A turning point has its own stretches if its width is below this fraction of half the swing, and a minimum of G if
/// its width is below this fraction of the distance to the nearer turning point.
const SLOW_END: f64 = 0.03;
const SLOW_DIP: f64 = 0.2;

#[derive(Debug, Clone, Copy, PartialEq)]
enum StretchMap {
    Whole,
    End,
    Dip,
    Face,
}

/// A part of the swing between the turning points.
#[derive(Debug, Clone)]
pub(super) struct Stretch {
    map: StretchMap,
    /// 1 if x = ln tan(theta/2) rises with v, -1 if it falls.
    pub way: f64,
    /// The place from which distances are measured: its distance `x` from the start; the next fields are its panel
    /// and its distance from the centre of the panel.
    x: f64,
    panel: usize,
    local: f64,
    width: f64,
    length: f64,
    /// The greatest value of the variable v on the stretch.
    pub greatest_v: f64,
    /// The series of G divided by the distance from the end. If `both`, H times the distance from the other end is
    /// used instead.
    rest: Option<PanelTerms>,
    both: bool,
    /// Uncertainty of the end of the swing in x.
    shift: f64,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct StretchPoint {
    /// The variable x = ln tan(theta/2), relative to the start.
    pub x: f64,
    pub s: f64,
    pub c: f64,
    pub p: f64,
    pub n: f64,
    /// The root sqrt(G); the next field is dx/dv/sqrt(G), the integrand.
    pub root: f64,
    pub x_per_root: f64,
    /// Relative rounding error of the radicand: G, or G divided by the distance from one end (R) or both (H).
    pub noise: f64,
}

impl Lines {
    /// The stretches from the lower end to the upper one.
    pub fn stretches(&self) -> Vec<Stretch> {
        let [low, high] = self.range();
        let far_enough =
            |s: &&SlowPlace| low < s.x && s.x < high && s.width < SLOW_DIP * (s.x - low).min(high - s.x);
        let slow: Vec<&SlowPlace> = self.slow.iter().filter(far_enough).collect();
        let lingers = |side: usize| {
            let of = self.ends[side].turning.as_ref();
            of.is_some_and(|t| next_zero(t) < SLOW_END * 0.5 * (high - low))
        };
        if slow.is_empty() && !lingers(0) && !lingers(1) {
            return vec![Stretch {
                map: StretchMap::Whole,
                way: 1.0,
                x: low,
                panel: 0,
                local: 0.0,
                width: high - low,
                length: high - low,
                greatest_v: PI,
                rest: None,
                both: self.both.is_some(),
                shift: 0.0,
            }];
        }
        let places: Vec<f64> = [low].into_iter().chain(slow.iter().map(|s| s.x)).chain([high]).collect();
        let mut all = Vec::with_capacity(2 * places.len());
        for (i, pair) in places.windows(2).enumerate() {
            let length = 0.5 * (pair[1] - pair[0]);
            all.push(if i == 0 { self.at_end(0, length) } else { Stretch::dip(slow[i - 1], 1.0, length) });
            let last = i + 2 == places.len();
            all.push(if last { self.at_end(1, length) } else { Stretch::dip(slow[i], -1.0, length) });
        }
        all
    }

    fn at_end(&self, side: usize, length: f64) -> Stretch {
        let (way, end) = (if side == 0 { 1.0 } else { -1.0 }, &self.ends[side]);
        let mut stretch = Stretch {
            map: StretchMap::Face,
            way,
            x: end.x,
            panel: self.panel(end.x),
            local: 0.0,
            width: length,
            length,
            greatest_v: length,
            rest: None,
            both: false,
            shift: 0.0,
        };
        let Some(turning) = &end.turning else { return stretch };
        let width = next_zero(turning).min(length).max(1e-60);
        stretch = Stretch {
            map: StretchMap::End,
            panel: turning.panel,
            local: turning.local,
            width,
            greatest_v: (length / width).sqrt().asinh(),
            rest: Some(turning.rest),
            ..stretch
        };
        let here = self.at(&stretch, 0.0);
        stretch.shift =
            self.rounding(turning.panel, turning.local) * here.x_per_root * here.x_per_root / (4.0 * width);
        if self.both.is_some() {
            // The form with the smaller rounding error is used.
            let worst = |both: bool| {
                let of = Stretch { both, ..stretch.clone() };
                (0..=4).fold(0f64, |worst, j| {
                    let noise = self.at(&of, of.greatest_v * f64::from(j) / 4.0).noise;
                    if noise.is_nan() { f64::INFINITY } else { worst.max(noise) }
                })
            };
            stretch.both = worst(true) < worst(false);
        }
        stretch
    }

    /// The motion at `v` on a stretch.
    pub fn at(&self, on: &Stretch, v: f64) -> StretchPoint {
        match on.map {
            StretchMap::Whole => self.at_whole(on.width, v),
            StretchMap::End => self.at_turning(on, v),
            StretchMap::Dip | StretchMap::Face => self.at_undivided(on, v),
        }
    }

    /// The variable v of the start, if the start lies on this stretch.
    ///
    /// Where G is small, its value, which is known to all digits at the start, gives the distance from the end.
    pub fn start_on(&self, on: &Stretch) -> Option<f64> {
        let [low, high] = self.range();
        match on.map {
            StretchMap::Whole => Some(on.at_distance(-low, high)),
            StretchMap::End => {
                let mut v = on.v(0.0)?;
                for _ in 0..3 {
                    let d = on.width * v.sinh().powi(2);
                    if d > 0.1 * on.length {
                        break;
                    }
                    let x_per_root = self.at(on, v).x_per_root;
                    // This is G/d, from dx/dv/sqrt(G).
                    let r = 4.0 * on.width * v.cosh().powi(2) / (x_per_root * x_per_root);
                    let d = self.panels[0].g[0] / r;
                    v = on.at_distance(d, on.length - d);
                }
                Some(v)
            }
            StretchMap::Dip | StretchMap::Face => on.v(0.0),
        }
    }

    /// The motion at `v` on a stretch whose end is divided out of G.
    fn at_turning(&self, on: &Stretch, v: f64) -> StretchPoint {
        let (sinh, cosh) = (v.sinh(), v.cosh());
        let d = on.width * sinh * sinh;
        let x = on.x + on.way * d;
        let (here, near) = (on.local + on.way * d, &self.panels[on.panel]);
        let inside = here.abs() <= near.reach;
        let (panel, y) = if inside { (on.panel, here) } else { self.place(x) };
        let [s, c, p, n] = self.numbers(panel, x, y);
        let terms = self.terms(panel, y, [s, c, p, n]);
        let of = &self.panels[panel];
        let (r, off) = match (&self.both, &on.rest) {
            (Some(both), _) if inside && on.both => {
                let [low, high] = self.range();
                let left = (high - low) - d;
                let h = value(&both.h, y);
                let share = both.share(y, h) * terms / (of.reach * of.reach);
                (h * left, f64::EPSILON * (h * left).abs() * (4.0 + share))
            }
            (_, Some(rest)) if inside => {
                let r = value(rest, y);
                let share = of.share(y, on.local) / of.reach;
                (r, f64::EPSILON * (r.abs() + share * terms) + KEPT * terms)
            }
            _ => {
                let r = value(&of.g, y) / d;
                (r, f64::EPSILON * r.abs() + of.rounding(y, terms) / d)
            }
        };
        let noise = 2.0 * off / r.abs() + 2.0 * on.shift / (d + on.width);
        let x_per_root = 2.0 * on.width.sqrt() * cosh / r.sqrt();
        StretchPoint { x, s, c, p, n, root: (d * r).max(0.0).sqrt(), x_per_root, noise }
    }

    /// The motion at `v` on a stretch on which G is not divided.
    fn at_undivided(&self, on: &Stretch, v: f64) -> StretchPoint {
        let (d, speed) =
            if on.map == StretchMap::Dip { (on.width * v.sinh(), on.width * v.cosh()) } else { (v, 1.0) };
        let x = on.x + on.way * d;
        let here = on.local + on.way * d;
        let inside = on.map == StretchMap::Dip && here.abs() <= self.panels[on.panel].reach;
        let (panel, y) = if inside { (on.panel, here) } else { self.place(x) };
        self.point_undivided(panel, x, y, speed)
    }

    /// The motion at a place in a panel where G is not divided; `speed` is dx/dv.
    fn point_undivided(&self, panel: usize, x: f64, y: f64, speed: f64) -> StretchPoint {
        let [s, c, p, n] = self.numbers(panel, x, y);
        let g = value(&self.panels[panel].g, y);
        let off = f64::EPSILON * g + self.panels[panel].rounding(y, self.terms(panel, y, [s, c, p, n]));
        let root = g.max(0.0).sqrt();
        StretchPoint { x, s, c, p, n, root, x_per_root: speed / root, noise: 2.0 * off / g.abs() }
    }

    /// The motion at the outermost x before the face lands.
    pub fn at_face(&self, upper: bool) -> StretchPoint {
        let x = self.ends[usize::from(upper)].x;
        let (panel, y) = self.place(x);
        self.point_undivided(panel, x, y, 1.0)
    }

    /// The motion at `u` on a swing that is one stretch, where both ends are divided out of G.
    fn at_whole(&self, width: f64, u: f64) -> StretchPoint {
        let (sin, cos) = (0.5 * u).sin_cos();
        let (above, below) = (width * sin * sin, width * cos * cos);
        let [low, high] = &self.ends;
        let x = if above < below { low.x + above } else { high.x - below };
        let near = |turning: Option<&'_ Turning>, distance: f64| -> Option<(usize, f64)> {
            let turning = turning?;
            let y = turning.local + distance;
            (y.abs() <= self.panels[turning.panel].reach).then_some((turning.panel, y))
        };
        let (of_low, of_high) = (low.turning.as_ref(), high.turning.as_ref());
        let (from_low, from_high) = (near(of_low, above), near(of_high, -below));
        let nearer_low = from_low.is_some() && (above <= below || from_high.is_none());
        let rest = |of: Option<&Turning>, y: f64| of.map_or(f64::NAN, |t| value(&t.rest, y));
        let (panel, y, h) = match (&self.both, from_low, from_high) {
            (Some(both), Some((panel, y)), _) if above <= below => (panel, y, value(&both.h, y)),
            (Some(both), _, Some((panel, y))) => (panel, y, value(&both.h, y)),
            (_, Some((panel, y)), _) if nearer_low => (panel, y, rest(of_low, y) / below),
            (_, _, Some((panel, y))) => (panel, y, rest(of_high, y) / above),
            _ => {
                let (panel, y) = self.place(x);
                (panel, y, value(&self.panels[panel].g, y) / (above * below))
            }
        };
        let [s, c, p, n] = self.numbers(panel, x, y);
        let of = &self.panels[panel];
        // Dividing the series of G by (x - zero) divides its rounding error by the reach of the panel, not by
        // the distance from the zero, which may be much smaller.
        let divided = from_low.is_some() || from_high.is_some();
        let reach = if divided { of.reach } else { 0.0 };
        let root = |end: Option<&Turning>| end.filter(|t| t.panel == panel).map_or(0.0, |t| t.local.abs());
        let terms = self.terms(panel, y, [s, c, p, n]);
        let off = match &self.both {
            Some(both) if divided => 4.0 + both.share(y, h) * terms / (reach * reach),
            _ => {
                let far = if divided { root(of_low).max(root(of_high)) } else { 0.0 };
                1.0 + of.share(y, far) * terms / (above.max(reach) * below.max(reach) * h.abs())
            }
        };
        let noise = 2.0 * f64::EPSILON * off;
        let root = width * sin * cos * h.max(0.0).sqrt();
        StretchPoint { x, s, c, p, n, root, x_per_root: 1.0 / h.sqrt(), noise }
    }

    /// The panel nearest to x, and the distance from its centre.
    fn place(&self, x: f64) -> (usize, f64) {
        let panel = self.panel(x);
        (panel, x - self.panels[panel].centre)
    }

    /// Sine and cosine of theta, P = w1 sin(theta), and n = w3 at a place.
    fn numbers(&self, panel: usize, x: f64, y: f64) -> [f64; 4] {
        let (s, c) = self.angle(x);
        let of = &self.panels[panel];
        [s, c, value(&of.p, y), value(&of.n, y)]
    }

    /// The derivatives of P = w1 sin(theta) and n = w3 with respect to x.
    pub fn slope(&self, at: &StretchPoint) -> [f64; 2] {
        let (of, m) = (self.law.at((at.s, at.c)), at.n * at.s);
        [at.s * (of.q * m - of.p * at.p), of.r * at.p + of.t * m]
    }
}

/// Error of the slope of G at the start, which is computed with twice the digits, relative to its terms.
const KEPT: f64 = 1.0 / (1u128 << 100) as f64;

/// Approximate distance from a turning point to the next zero of G on either side: the distance over which the quotient
/// of G by this zero changes.
fn next_zero(turning: &Turning) -> f64 {
    let [r0, r1, r2, r3] = taylor(&turning.rest, turning.local);
    let after = |r: f64, k: f64| if r == 0.0 { f64::INFINITY } else { (r0 / r).abs().powf(1.0 / k) };
    after(r1, 1.0).min(after(r2, 2.0)).min(after(r3, 3.0))
}

impl Stretch {
    fn dip(at: &SlowPlace, way: f64, length: f64) -> Self {
        Self {
            map: StretchMap::Dip,
            way,
            x: at.x,
            panel: at.panel,
            local: at.local,
            width: at.width,
            length,
            greatest_v: (length / at.width).asinh(),
            rest: None,
            both: false,
            shift: 0.0,
        }
    }

    /// The variable v of a place `x`, measured from the start; None if the place is not on this stretch.
    pub fn v(&self, x: f64) -> Option<f64> {
        let d = self.way * (x - self.x);
        // The other side of a dip belongs to another stretch; a place beyond an end can only be a rounding error.
        let least = if self.map == StretchMap::Dip { 0.0 } else { -1e-12 };
        let inside = least <= d && d <= self.length * (1.0 + 1e-12);
        inside.then(|| self.at_distance(d, self.length - d))
    }

    /// The variable v at the distance `d` from the end at which the stretch begins, and at the distance `left` from
    /// its other end.
    fn at_distance(&self, d: f64, left: f64) -> f64 {
        let d = d.max(0.0).min(self.length);
        match self.map {
            StretchMap::Whole => 2.0 * d.sqrt().atan2(left.max(0.0).sqrt()),
            StretchMap::End => (d / self.width).sqrt().asinh().min(self.greatest_v),
            StretchMap::Dip => (d / self.width).asinh().min(self.greatest_v),
            StretchMap::Face => d,
        }
    }

    /// The first subdivision of the quadrature in v: it separates the part where the integrand changes on the scale
    /// of x from that where the motion lingers.
    pub fn cuts(&self) -> Vec<f64> {
        let (greatest_v, slow) = (self.greatest_v, matches!(self.map, StretchMap::End | StretchMap::Dip));
        if slow && greatest_v > 6.0 {
            vec![0.0, greatest_v - 5.0, greatest_v - 2.0, greatest_v]
        } else {
            vec![0.0, greatest_v]
        }
    }

    pub fn is_whole(&self) -> bool {
        self.map == StretchMap::Whole
    }

    pub fn shift(&self) -> f64 {
        self.shift
    }

    /// The derivative of v with respect to ln d, d being the distance from the end: a relative error of G/d is a
    /// relative error of d. It is 0 on the way to a face.
    pub fn stiffness(&self, v: f64) -> f64 {
        match self.map {
            StretchMap::Whole => 0.5 * v.sin(),
            StretchMap::End => 0.5 * v.tanh(),
            StretchMap::Dip => v.tanh(),
            StretchMap::Face => 0.0,
        }
    }
}
