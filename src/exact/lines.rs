//! The two linear integrals and the energy, as functions of x = ln tan(theta/2).
//!
//! ```text
//! s = sech x = sin theta,   c = -tanh x = cos theta,   P = w1 s,   n = w3
//! dP/dx = -A s P + B s^2 n,   dn/dx = C P + A s n                                A ... k, J: `law`
//! G(x)  = J s^2 theta'^2 = 2 E s^2 - a P^2 - b n^2 s^2 + 2 k n P s - 2 s^2 (ell c + s)
//! ```
//! In this variable everything is analytic for
//! |Im x| < pi/2. Power series about a few centres carry P and n along x and find where G vanishes: there the body turns. A
//! step to the next possible zero uses a bound on G'', so that no zero is stepped over. The zero is
//! then divided out of the series, which keeps the digits of a small swing.

use crate::body::Body;
use crate::contact::{Contact, FLAT};
use crate::law::Law;
use crate::real::{Sum, sincos};
use crate::state::State;

/// Terms of a power series, good to 1e-16 within 0.3 of its radius of convergence, though G has a triple pole there.
const ORDER: usize = 36;

type Series = [f64; ORDER];

/// The motion as functions of x in a neighbourhood of `centre`.
#[derive(Debug, Clone)]
struct Panel {
    /// Measured from the start, as every x here.
    centre: f64,
    reach: f64,
    p: Series,
    n: Series,
    g: Series,
}

/// What a motion is at one x.
#[derive(Debug, Clone, Copy)]
pub(super) struct Local {
    pub x: f64,
    pub s: f64,
    pub c: f64,
    pub p: f64,
    pub n: f64,
    /// G divided by the distances from both ends.
    pub h: f64,
    /// Relative uncertainty of `h` from rounding.
    pub noise: f64,
}

/// Where a swing ends.
#[derive(Debug, Clone)]
struct End {
    x: f64,
    /// G with this end divided out, and the end in its panel; none where the face lands.
    turning: Option<Turning>,
}

#[derive(Debug, Clone)]
struct Turning {
    panel: usize,
    local: f64,
    rest: Series,
}

/// The motion between two turning points, or between one and the face.
#[derive(Debug, Clone)]
pub(super) struct Lines {
    law: Law<f64>,
    /// x at the start.
    pub origin: f64,
    twice_energy: f64,
    panels: Vec<Panel>,
    ends: [End; 2],
    both: Option<Series>,
}

/// Radius of convergence about x is hypot(x, pi/2); and far out exp(2x) must not vary too much.
fn reach(x: f64) -> f64 {
    (0.3 * x.hypot(core::f64::consts::FRAC_PI_2)).min(0.75)
}

fn horner(series: &Series, x: f64) -> f64 {
    series.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// The quotient by (x - root); the remainder, which is rounding, is dropped.
fn deflated(series: &Series, root: f64) -> Series {
    let mut quotient = [0.0; ORDER];
    for i in (1..ORDER).rev() {
        quotient[i - 1] = series[i] + if i + 1 < ORDER { root * quotient[i] } else { 0.0 };
    }
    quotient
}

impl Panel {
    fn new(law: &Law<f64>, twice_energy: f64, centre: f64, x: f64, [s0, c0, p0, n0]: [f64; 4]) -> Self {
        let zero = [0.0; ORDER];
        let (mut s, mut c, mut p, mut n, mut g) = (zero, zero, zero, zero, zero);
        // s^2, n s, and the three right factors
        let (mut square, mut q, mut push, mut pull, mut depth) = (zero, zero, zero, zero, zero);
        (s[0], c[0], p[0], n[0]) = (s0, c0, p0, n0);
        for k in 0..ORDER {
            let product = |a: &Series, b: &Series| (0..=k).map(|i| a[i] * b[k - i]).sum::<f64>();
            square[k] = product(&s, &s);
            q[k] = product(&s, &n);
            push[k] = law.feed * q[k] - law.drag * p[k];
            pull[k] = 2.0 * law.k * q[k] - law.a * p[k];
            depth[k] = -2.0 * (law.ell * c[k] + s[k]);
            if k == 0 {
                depth[0] += twice_energy;
            }
            g[k] = product(&square, &depth) + product(&p, &pull) - law.b * product(&q, &q);
            if k + 1 < ORDER {
                let next = (k + 1) as f64;
                s[k + 1] = product(&s, &c) / next;
                c[k + 1] = -square[k] / next;
                p[k + 1] = product(&s, &push) / next;
                n[k + 1] = (law.grow * p[k] + law.drag * q[k]) / next;
            }
        }
        Self { centre, reach: reach(x), p, n, g }
    }

    /// The first zero of G from `y` on in the direction `way`, within reach; all measured from the centre.
    fn turning(&self, mut y: f64, way: f64) -> Option<f64> {
        let slope: Series =
            core::array::from_fn(|i| if i + 1 < ORDER { (i + 1) as f64 * self.g[i + 1] } else { 0.0 });
        let mut bound = 0.0;
        for i in (2..ORDER).rev() {
            bound = bound * self.reach + (i * (i - 1)) as f64 * self.g[i].abs();
        }
        for _ in 0..2000 {
            let (g, rise) = (horner(&self.g, y), way * horner(&slope, y));
            if g < 0.0 {
                return Some(y);
            }
            // G >= g + rise h - bound h^2/2
            let root = (rise * rise + 2.0 * bound * g).sqrt();
            let h = if rise < 0.0 { 2.0 * g / (root - rise) } else { (root + rise) / bound };
            let next = y + way * h;
            if next == y || h.is_nan() {
                return Some(y);
            }
            if next.abs() > self.reach {
                return None;
            }
            y = next;
        }
        Some(y)
    }
}

impl Lines {
    /// None if the numbers leave the range in which they can be followed.
    pub fn new(body: &Body, contact: Contact, y: &State) -> Option<Self> {
        let law = Law::of(contact, body.ell(), body.i1(), body.i3());
        let (s, c) = y.theta.sin_cos();
        let origin = (0.5 * y.theta).tan().ln();
        let (p, n) = (y.w1 * s, y.w3);
        let tilting = law.inertia(|| (s, c)) * y.w2 * y.w2;
        let turning = law.a * y.w1 * y.w1 + law.b * n * n - 2.0 * law.k * y.w1 * n;
        let twice_energy = tilting + turning + 2.0 * (law.ell * c + s);
        let mut first = Panel::new(&law, twice_energy, 0.0, origin, [s, c, p, n]);
        first.g[0] = tilting * s * s;
        first.g[1] = 2.0 * s * s * (c * tilting + s * push(&law, body, contact, y));
        if !(twice_energy.is_finite() && first.g.iter().all(|g| g.is_finite())) {
            return None;
        }
        let mut lines = Self {
            law,
            origin,
            twice_energy,
            panels: vec![first],
            ends: [End { x: 0.0, turning: None }, End { x: 0.0, turning: None }],
            both: None,
        };
        for (side, way) in [(0, -1.0), (1, 1.0)] {
            lines.ends[side] = lines.end(way)?;
        }
        if let [End { turning: Some(low), .. }, End { turning: Some(high), .. }] = &lines.ends
            && low.panel == high.panel
        {
            lines.both = Some(deflated(&low.rest, high.local).map(|g| -g));
        }
        Some(lines)
    }

    fn end(&mut self, way: f64) -> Option<End> {
        let face = way * -(0.5 * FLAT).ln() - self.origin;
        let mut panel = 0;
        loop {
            let Panel { centre, reach, .. } = self.panels[panel];
            if let Some(local) = self.panels[panel].turning(0.0, way) {
                let x = centre + local;
                if way * (face - x) <= 0.0 {
                    return Some(End { x: face, turning: None });
                }
                let mut rest = deflated(&self.panels[panel].g, local);
                if way > 0.0 {
                    rest = rest.map(|g| -g);
                }
                return Some(End { x, turning: Some(Turning { panel, local, rest }) });
            }
            if way * (face - (centre + way * reach)) <= 0.0 {
                return Some(End { x: face, turning: None });
            }
            let next = centre + way * reach;
            let (p, n) =
                (horner(&self.panels[panel].p, way * reach), horner(&self.panels[panel].n, way * reach));
            let (s, c) = sech_tanh(self.origin + next);
            let fresh = Panel::new(&self.law, self.twice_energy, next, self.origin + next, [s, c, p, n]);
            if !fresh.g.iter().all(|g| g.is_finite()) {
                return None;
            }
            self.panels.push(fresh);
            panel = self.panels.len() - 1;
        }
    }

    /// Both ends, measured from the start.
    pub fn range(&self) -> [f64; 2] {
        [self.ends[0].x, self.ends[1].x]
    }

    /// Whether the face lands at the lower end, at the upper end.
    pub fn lands(&self) -> [bool; 2] {
        [self.ends[0].turning.is_none(), self.ends[1].turning.is_none()]
    }

    /// The motion at the point this far above the lower end and below the upper one.
    pub fn at(&self, above: f64, below: f64) -> Local {
        let [low, high] = &self.ends;
        let x = if above < below { low.x + above } else { high.x - below };
        let near = |end: &End, distance: f64| {
            let turning = end.turning.as_ref()?;
            let y = turning.local + distance;
            (y.abs() <= self.panels[turning.panel].reach).then_some((turning.panel, y))
        };
        let (from_low, from_high) = (near(low, above), near(high, -below));
        let nearer_low = from_low.is_some() && (above <= below || from_high.is_none());
        let (panel, y, h) = match (&self.both, from_low, from_high) {
            (Some(both), Some((panel, y)), _) if above <= below => (panel, y, horner(both, y)),
            (Some(both), _, Some((panel, y))) => (panel, y, horner(both, y)),
            (_, Some((panel, y)), _) if nearer_low => {
                (panel, y, low.turning.as_ref().map_or(f64::NAN, |t| horner(&t.rest, y)) / below)
            }
            (_, _, Some((panel, y))) => {
                (panel, y, high.turning.as_ref().map_or(f64::NAN, |t| horner(&t.rest, y)) / above)
            }
            _ => {
                let panel = self.panel(x);
                let y = x - self.panels[panel].centre;
                (panel, y, horner(&self.panels[panel].g, y) / (above * below))
            }
        };
        let (s, c) = sech_tanh(self.origin + x);
        let Panel { reach, p, n, .. } = &self.panels[panel];
        let (p, n) = (horner(p, y), horner(n, y));
        let q = n * s;
        let terms = s * s * (self.twice_energy.abs() + 2.0 * (self.law.ell * c.abs() + s))
            + self.law.a * p * p
            + self.law.b * q * q
            + 2.0 * self.law.k * (p * q).abs();
        // an end divided out takes the error of G there with it
        let divided = from_low.is_some() || from_high.is_some();
        let (above, below) = if divided { (above.max(*reach), below.max(*reach)) } else { (above, below) };
        // at the start G and its slope are known to all digits: what is left grows with the distance
        let known = match (panel, &self.both) {
            (0, None) if divided => {
                let end = |end: &End| {
                    end.turning.as_ref().map_or(0.0, |t| if t.panel == 0 { t.local.abs() } else { 0.0 })
                };
                (y.abs().max(end(low)).max(end(high)) / reach).min(1.0)
            }
            (0, None) => (y / reach).abs().min(1.0),
            _ => 1.0,
        };
        let noise = 2.0 * f64::EPSILON * (1.0 + known * terms / (above * below * h.abs()));
        Local { x: self.origin + x, s, c, p, n, h, noise }
    }

    /// The panel whose centre is nearest.
    fn panel(&self, x: f64) -> usize {
        let distance = |i: &usize| (x - self.panels[*i].centre).abs();
        (0..self.panels.len()).min_by(|i, j| distance(i).total_cmp(&distance(j))).unwrap_or(0)
    }

    /// dP/dx and dn/dx.
    pub fn slope(&self, at: &Local) -> [f64; 2] {
        let (law, q) = (&self.law, at.n * at.s);
        [at.s * (law.feed * q - law.drag * at.p), law.grow * at.p + law.drag * q]
    }

    /// |theta'| of a face that lands with this w3; its w1 is gone.
    pub fn landing_speed(&self, n: f64, upper: bool) -> f64 {
        let (law, c) = (&self.law, if upper { -1.0 } else { 1.0 });
        ((self.twice_energy - law.b * n * n - 2.0 * law.ell * c) / law.inertia(|| (0.0, c))).sqrt()
    }

    pub fn law(&self) -> &Law<f64> {
        &self.law
    }
}

/// sin theta and cos theta of x.
fn sech_tanh(x: f64) -> (f64, f64) {
    (1.0 / x.cosh(), -x.tanh())
}

/// What tilts a body in this state, J theta'' but for what theta'^2 does on a smooth table:
/// ct w1 (a w1 - k w3) + w1 (k w1 - b w3) - (cos theta - ell sin theta).
///
/// Near a steady state these cancel, and the motion hangs on the difference: it is taken in twice the
/// precision, from the moments themselves.
fn push(law: &Law<f64>, body: &Body, contact: Contact, y: &State) -> f64 {
    let times = |a: Sum<f64>, b: Sum<f64>| a.times(b.hi).plus(a.times(b.lo));
    // beyond pi/2 the sines are those of pi - theta, whose low part pi hides
    let beyond = y.theta > core::f64::consts::FRAC_PI_2;
    let angle = if beyond {
        let back = Sum::of(core::f64::consts::PI, -y.theta);
        let low = back.lo + 1.224_646_799_147_353_2e-16;
        let at = sincos(back.hi);
        let sin = Sum::ordered(at.sin.hi, at.sin.lo + low * at.cos.hi);
        let cos = Sum::ordered(at.cos.hi, at.cos.lo - low * at.sin.hi);
        (sin, cos.times(-1.0))
    } else {
        let at = sincos(y.theta);
        (at.sin, at.cos)
    };
    let (s, c) = angle;
    let cotangent = {
        let hi = c.hi / s.hi;
        let rest = c.plus(s.times(-hi));
        Sum::ordered(hi, rest.hi / s.hi)
    };
    let (ell, i1, i3) = (body.ell(), Sum::from(body.i1()), Sum::from(body.i3()));
    let [a, b] = match contact {
        Contact::Rolling => [Sum::product(ell, ell).plus(i1), Sum::of(1.0, body.i3())],
        Contact::Smooth => [i1, i3],
    };
    let radial = a.times(y.w1).plus(Sum::product(-law.k, y.w3));
    let along = Sum::product(law.k, y.w1).plus(b.times(-y.w3));
    let turning = times(cotangent, radial).plus(along).times(y.w1);
    turning.plus(s.times(law.ell)).plus(c.times(-1.0)).hi
}
