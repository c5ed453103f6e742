//! The friction of a ring that slides and spins, under a pressure that is linear in the place and cut at zero.
//!
//! ```text
//! u = v + w z x (a n),   s = a w,   n = (cos chi, sin chi),   v along x;   X the centre of the pressure over a
//! G = <u/|u|>,   gg = <n x u/|u|>,   means over the pressure p
//! |X| <= 1/2   p = 1 + 2 X.n        |X| > 1/2   p = cos t - cos b for |t| < b,   t = chi - arg X
//! ```
//! Where the whole ring presses the means are complete elliptic integrals B and D, computed by Bulirsch's means (Numer.
//! Math. 7, 78 (1965)), which lose nothing at either end. Where a part presses they are taken in the frame of X, whose
//! angle is c, with d the angle of u from X: gg = <(1 - cos d) sin t> - <(1 - cos t) sin d>, as <sin t> = <sin d> = 0.
//! All terms are then as small as the sum for a slow spin and for a short arc.
//!
//! Quadrature along the arc: a rule of Gauss with 24 nodes in tan(t/4), where u has no zero near; else with T =
//! tan(t/2 + c/2 - pi/4) = (e/2) (E - 1/E), e = |v - s|/(v + s), which makes |u| = (v + s) (e/2) (E + 1/E)/sqrt(1 + T^2)
//! rational but for a root, in panels of E by ratios of 8; the opposite side of the ring in 1/T.
//!
//! Error: 1e-15 of the whole ring, 1e-14 of a part.

use core::f64::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, PI};

/// The positive nodes of Gauss's rule of 24 nodes, and their weights.
#[rustfmt::skip]
pub(super) const GAUSS_24: [[f64; 2]; 12] = [
    [0.99518721999702136, 0.0123412297999872],
    [0.9747285559713095, 0.028531388628933663],
    [0.93827455200273276, 0.044277438817419806],
    [0.88641552700440103, 0.059298584915436781],
    [0.82000198597390292, 0.073346481411080306],
    [0.74012419157855436, 0.086190161531953276],
    [0.64809365193697557, 0.097618652104113888],
    [0.54542147138883954, 0.10744427011596563],
    [0.43379350762604514, 0.1155056680537256],
    [0.31504267969616337, 0.12167047292780339],
    [0.19111886747361631, 0.1258374563468283],
    [0.064056892862605626, 0.12793819534675216],
];

/// The integrals of cos^2/D and of (1 - q^2) sin^2/D over a quarter turn, D^2 = 1 - q^2 sin^2, for q in [0, 1].
pub(super) fn quarter_integrals(q: f64) -> [f64; 2] {
    let complement = (1.0 - q) * (1.0 + q);
    if complement == 0.0 {
        return [1.0, 0.0];
    }
    let mut e = complement.sqrt();
    let (mut m, mut p, mut k) = (1.0, 1.0, e);
    // The pairs of coefficients of cos^2 and of sin^2.
    let (mut a, mut b) = ([1.0, 0.0], [0.0, 1.0]);
    loop {
        let over = 1.0 / p;
        let g = e * over;
        for i in 0..2 {
            let before = a[i];
            a[i] += b[i] * over;
            b[i] = 2.0 * (b[i] + before * g);
        }
        p += g;
        let last = m;
        m += k;
        if (last - k).abs() <= 1e-8 * last {
            let scale = FRAC_PI_2 / (m * (m + p));
            return [scale * (b[0] + a[0] * m), complement * scale * (b[1] + a[1] * m)];
        }
        k = 2.0 * e.sqrt();
        e = k * m;
    }
}

/// The means that a pressure needs which is linear in the place and presses everywhere: those of u_x/|u| and n x u/|u|
/// over the uniform pressure, and those of x u_y/|u|, y u_x/|u| and y (n x u)/|u|.
#[derive(Debug, Clone, Copy)]
pub(super) struct WholeMeans {
    pub along: f64,
    pub couple: f64,
    pub x_across: f64,
    pub y_along: f64,
    pub y_couple: f64,
}

impl WholeMeans {
    /// The means over the ring.
    pub fn of_ring(v: f64, s: f64) -> Self {
        let spins = v <= s;
        let q = if spins { v / s } else { s / v };
        let [b, d] = quarter_integrals(q).map(|x| FRAC_2_PI * x);
        let (small, large) = (q * b, b + d);
        let (x, y, z) = ((2.0 * b + d) / 3.0, (b + 2.0 * d) / 3.0, q * (b - d) / 3.0);
        if spins {
            Self { along: small, couple: large, x_across: x, y_along: -y, y_couple: -z }
        } else {
            Self { along: large, couple: small, x_across: q * x, y_along: -z, y_couple: -y }
        }
    }

    /// Force along v and across and the couple, for a pressure 1 + `slope` X.n with X = lam G.
    pub fn pressed(&self, lam: f64, slope: f64) -> [f64; 3] {
        let tilt = slope * lam;
        let along = self.along / (1.0 - tilt * tilt * self.x_across * self.y_along);
        let across = tilt * self.x_across * along;
        [along, across, self.couple + tilt * across * self.y_couple]
    }
}

/// A part of the ring that presses: `width` = sin^2(b/2), and the angle c of its middle from v, with pi/2 - c.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    pub width: f64,
    pub angle: f64,
    pub off: f64,
}

/// Integrals over an arc of the length, of the pressure p, and of their products with the turned directions of the
/// slip: d is the angle of u from X, t that of the place.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    /// Of 1 and 1 - cos t over p.
    pressure: f64,
    short: f64,
    /// Of sin d and 1 - cos d over p.
    aside: f64,
    back: f64,
    /// Of (1 - cos d) sin t - (1 - cos t) sin d over p.
    couple: f64,
    /// The same of the length, and of products with sin t.
    length: f64,
    plain_short: f64,
    plain_aside: f64,
    plain_back: f64,
    turn_aside: f64,
    turn_back: f64,
}

/// What an arc gives: the residual X - lam G in the frame of X, its derivatives by width and angle, and the means.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pressed {
    pub residual: [f64; 2],
    pub by_width: [f64; 2],
    pub by_angle: [f64; 2],
    /// |X|.
    pub centre: f64,
    /// G along X, and gg.
    pub force: f64,
    pub couple: f64,
}

impl Pressed {
    pub fn determinant(&self) -> f64 {
        self.by_width[0] * self.by_angle[1] - self.by_width[1] * self.by_angle[0]
    }
}

/// The speeds, over the larger of them, with what the nodes of an arc share.
struct Kernel {
    /// v cos c, 2 s, and s - v sin c.
    forward: f64,
    twice: f64,
    base: f64,
    /// sin(b/2).
    reach: f64,
}

impl Kernel {
    /// Adds a node of weight dt with sin(t/2), cos(t/2) and 1/|u|.
    #[inline(always)]
    fn add(&self, sums: &mut Sums, weight: f64, half: [f64; 2], over: f64) {
        let [sh, ch] = half;
        let turn = 2.0 * sh * ch;
        let short = 2.0 * sh * sh;
        let pressure = weight * 2.0 * (self.reach - sh) * (self.reach + sh);
        let aside = (self.base - 0.5 * self.twice * short) * over;
        let ahead = (self.forward - 0.5 * self.twice * turn) * over;
        let size = 1.0 + ahead.abs();
        let back = if ahead > 0.0 { aside * aside / size } else { size };
        sums.pressure += pressure;
        sums.short += pressure * short;
        sums.aside += pressure * aside;
        sums.back += pressure * back;
        sums.couple += pressure * (back * turn - aside * short);
        sums.length += weight;
        sums.plain_short += weight * short;
        sums.plain_aside += weight * aside;
        sums.plain_back += weight * back;
        sums.turn_aside += weight * turn * aside;
        sums.turn_back += weight * turn * back;
    }
}

/// Both nodes of each pair of a rule on the interval from `left` to `right`: place and weight.
#[inline(always)]
fn nodes(left: f64, right: f64, mut each: impl FnMut(f64, f64)) {
    let (middle, half) = (0.5 * (left + right), 0.5 * (right - left));
    for [x, weight] in GAUSS_24 {
        each(middle - half * x, half * weight);
        each(middle + half * x, half * weight);
    }
}

impl Arc {
    /// The arc of a pressure with its centre at this X, nearly: the width follows from |X| by an approximate inverse.
    pub fn about(centre: [f64; 2]) -> Self {
        let short = (1.0 - centre[0].hypot(centre[1])).clamp(1e-18, 0.5);
        let angle = centre[1].atan2(centre[0]);
        Self { width: short * (2.5 - short), angle, off: centre[0].atan2(centre[1]) }
    }

    /// The integrals over the arc, for a slip of `v` and `s`.
    fn sums(&self, v: f64, s: f64) -> Sums {
        let (c, off) = (self.angle, self.off);
        let reach = self.width.sqrt();
        let b = 2.0 * reach.min(1.0).asin();
        let (so, co) = (0.5 * off).sin_cos();
        let gap = if c < FRAC_PI_4 { s - v * c.sin() } else { (s - v) + 2.0 * v * so * so };
        let kernel = Kernel { forward: v * off.sin(), twice: 2.0 * s, base: gap, reach };
        let mut sums = Sums::default();
        let (least, most) = ((v - s).abs(), v + s);
        // The zero of u^2 nearest to the arc, over its half: how fast the rule converges.
        let zero = [off / b, if least == 0.0 { 0.0 } else { (v / s).ln() / b }];
        let ellipse = 0.5 * ((zero[0] - 1.0).hypot(zero[1]) + (zero[0] + 1.0).hypot(zero[1]));
        if ellipse > 1.29 {
            let end = (0.25 * b).tan();
            nodes(-end, end, |x, weight| {
                let over = 1.0 / (1.0 + x * x);
                let (sh, ch) = (2.0 * x * over, (1.0 - x * x) * over);
                let sine = sh * co - ch * so;
                let size = (least * least + 4.0 * v * s * sine * sine).sqrt();
                kernel.add(&mut sums, 4.0 * over * weight, [sh, ch], 1.0 / size);
            });
            return sums;
        }
        let far = |left: f64, right: f64, sign: f64, sums: &mut Sums| {
            nodes(left, right, |x, weight| {
                let square = 1.0 / (1.0 + x * x);
                let cosine = square.sqrt();
                let half = [sign * cosine * (x * so - co), sign * cosine * (x * co + so)];
                // The side: left of the ring the place runs from behind, right of it it ends there.
                let half = [half[0], half[1]];
                let size = ((least * x).powi(2) + most * most).sqrt() * cosine;
                kernel.add(sums, 2.0 * square * weight, half, 1.0 / size);
            });
        };
        let (mut first, mut last) = (0.5 * (-b - off), 0.5 * (b - off));
        // In tan(first) from here on, the near side of the ring.
        if first < -1.4 {
            far((first + FRAC_PI_2).tan(), 1.0, 1.0, &mut sums);
            first = -FRAC_PI_4;
        }
        if last > 1.4 {
            far(-1.0, (last - FRAC_PI_2).tan(), -1.0, &mut sums);
            last = FRAC_PI_4;
        }
        let share = (least / most).max(1e-17);
        let stretched = |t: f64| {
            let y = t / share;
            let root = (1.0 + y * y).sqrt();
            if y > 0.0 { y + root } else { 1.0 / (root - y) }
        };
        let (from, to) = (stretched(first.tan()), stretched(last.tan()));
        let panels = ((to / from).ln() / 8f64.ln()).ceil().max(1.0);
        let ratio = (to / from).powf(1.0 / panels);
        let tilt = so / co;
        let mut left = from;
        for i in 0..panels as usize {
            let right = if i as f64 + 1.0 == panels { to } else { left * ratio };
            nodes(left, right, |x, weight| {
                let both = 1.0 / (x * (x * x + 1.0));
                let inverse = both * (x * x + 1.0);
                let t = 0.5 * share * (x - inverse);
                let root = (1.0 + t * t).sqrt();
                let cosine = 1.0 / root;
                let half = [cosine * co * (t + tilt), cosine * co * (1.0 - t * tilt)];
                let dt = share * (1.0 + inverse * inverse) * cosine * cosine * weight;
                kernel.add(&mut sums, dt, half, 2.0 * root * x * x * both / (share * most));
            });
            left = right;
        }
        sums
    }

    /// What the arc gives at the speeds `v` and `s` for a height lam.
    pub fn pressed(&self, lam: f64, v: f64, s: f64) -> Pressed {
        let large = v.max(s);
        let of = self.sums(v / large, s / large);
        let over = 1.0 / of.pressure;
        let [short, aside, back] = [of.short, of.aside, of.back].map(|x| x * over);
        let by_width = |plain: f64, mean: f64| 2.0 * over * (plain - mean * of.length);
        let centre = 1.0 - short;
        Pressed {
            residual: [(1.0 - lam) - short + lam * back, -lam * aside],
            by_width: [
                lam * by_width(of.plain_back, back) - by_width(of.plain_short, short),
                -lam * by_width(of.plain_aside, aside),
            ],
            by_angle: [lam * over * of.turn_back, centre - lam * over * of.turn_aside],
            centre,
            force: 1.0 - back,
            couple: of.couple * over,
        }
    }

    /// The arc turned and widened by these amounts.
    pub fn moved(&self, width: f64, angle: f64) -> Self {
        Self { width: self.width + width, angle: self.angle + angle, off: self.off - angle }
    }
}

const _: f64 = PI;
