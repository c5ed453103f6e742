//! Stability of a steady state: two questions, two names.
//!
//! ```text
//! smooth table:  U'' = (g'^2 + I1 w1 (I1 w1/sin^2 - ct g'))/I1 - ell cos - sin,   g' = I3 w3 - ct I1 w1
//!                kappa = U''/(I1 + (ell sin - cos)^2)
//! rolling:       kappa = -d/dtheta [theta''(theta, w1(theta), w3(theta))]  along
//!                dw1/dtheta = -ct w1 - (I3 ell/D) w1 + (I3 (I3 + 1)/D) w3,   dw3/dtheta = (I1 w1 + I3 ell w3)/D
//! centre at rest (w3 = ell w1), with n and m = n + d cos of `steady`:
//!   smooth   U''     = (n/s)(m/a + cos + a/m) - (ell cos + sin)
//!   rolling  J kappa = n X/(I3 m s) - (ell cos + sin)
//!            X = I1 + ((2 I1 + ell^2) c + ell (1 - I3) s)(c - (I3^2 ell/D) s) + ((I3 + 1) s + ell c) s (I1 + I3 ell^2)/D
//! ```
//! `kappa` is the squared angular frequency of the nutation (in g/R), negative where a disturbance
//! grows at the rate sqrt(-kappa).
//!
//! *Smooth* asks whether the energy U(theta) at fixed angular momenta Lz and L3 has a minimum
//! (Jackson et al., Am. J. Phys. 87, 85 (2019), Appendix). That is exact on a frictionless table,
//! where both are conserved. The nutation then has the inertia I1 + (ell sin - cos)^2, because
//! the centre moves up and down; the paper's (A3) leaves the second term out, which changes
//! frequencies and no sign.
//! *Rolling* linearises the motion without slipping, where other integrals are conserved. Two of
//! its four eigenvalues are zero, since steady states are a two-parameter family; the others are
//! +-sqrt(-kappa). Where the two disagree for a tube or a disk, friction keeps up what a smooth table
//! lets fall; a body much wider than its rim (I3 above about 1.4) can have it the other way round.
//!
//! Error of `kappa`: 16 (1 + cond) ulp of the larger of its terms, where cond = cos/|n| + (a cos +
//! ell sin)/|m| measures how close theta is to theta0 or thetaInf. A test runs it.

use crate::body::{Body, tube, tube_or_nan};
use crate::contact::Contact;
use crate::real::{LANES, Real, SinCos, sincos};
use crate::roots::Cubic;
use crate::state::State;
use crate::steady::{self, Terms, terms};
use crate::sum::Sum;

/// What is known about a point of the theta-ell map. The number is the code on a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Region {
    /// No question: theta outside (0, pi/2], or no such body.
    Invalid = 0,
    /// No steady state with the centre at rest, between theta0 and thetaInf.
    Forbidden = 1,
    /// Too close to theta0 or thetaInf for double precision to decide.
    Undetermined = 2,
    /// A steady state, unstable on a smooth table and rolling.
    Unstable = 4,
    /// Unstable on a smooth table, stable when rolling.
    StableRolling = 5,
    /// Stable on a smooth table, unstable when rolling.
    StableSmooth = 6,
    /// Stable by both.
    Stable = 7,
}

/// What `kappa` needs to know of a body, once for a whole row of inclinations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moments<T> {
    pub ell: T,
    pub excess: Sum<T>,
    i1: T,
    ratio: T,
    // X/(I3 J) = tilt + (along c + across s)(c - drag s) + lift (spin s + ell c) s
    tilt: T,
    along: T,
    across: T,
    drag: T,
    lift: T,
    spin: T,
    inverse_j: T,
}

impl Moments<f64> {
    pub fn of(body: &Body) -> Self {
        Self::made_of(body.ell(), [body.i1(), body.i3()], body.excess_sum())
    }
}

impl<T: Real> Moments<T> {
    /// Of a uniform tube; NaN where there is none.
    #[inline(always)]
    pub fn tube(ell: T, bore: T) -> Self {
        let (moments, excess) = tube(ell, bore);
        Self::made_of(tube_or_nan(ell, bore), moments, excess)
    }

    #[inline(always)]
    fn made_of(ell: T, [i1, i3]: [T; 2], excess: Sum<T>) -> Self {
        let one = ell.splat(1.0);
        let square = ell * ell;
        let (j, d) = (i1 + one + square, i1 * i3 + i1 + i3 * ell * ell);
        let ratio = one + excess.hi;
        Self {
            ell,
            excess,
            i1,
            ratio,
            tilt: ratio / j,
            along: (i1 + i1 + square) / j / i3,
            across: ell * (one - i3) / j / i3,
            drag: i3 * i3 * ell / d,
            lift: (i1 + i3 * ell * ell) / d / j / i3,
            spin: i3 + one,
            inverse_j: one / j,
        }
    }
}

impl<T: Copy> Moments<T> {
    #[inline(always)]
    fn numbers(&self) -> [T; 12] {
        let Self { ell, excess, i1, ratio, tilt, along, across, drag, lift, spin, inverse_j } = *self;
        [ell, excess.hi, excess.lo, i1, ratio, tilt, along, across, drag, lift, spin, inverse_j]
    }

    #[inline(always)]
    fn from_numbers(x: [T; 12]) -> Self {
        let [ell, hi, lo, i1, ratio, tilt, along, across, drag, lift, spin, inverse_j] = x;
        Self { ell, excess: Sum { hi, lo }, i1, ratio, tilt, along, across, drag, lift, spin, inverse_j }
    }

    /// The same function of each number: into lanes.
    #[inline(always)]
    pub fn map<U: Copy>(&self, f: impl Fn(T) -> U) -> Moments<U> {
        Moments::from_numbers(self.numbers().map(f))
    }
}

impl Moments<[f64; LANES]> {
    /// Bodies side by side; NaN where there is none.
    pub fn gather(bodies: &[Option<Body>]) -> Self {
        let all: [[f64; 12]; LANES] = core::array::from_fn(|i| {
            bodies.get(i).copied().flatten().map_or([f64::NAN; 12], |b| Moments::of(&b).numbers())
        });
        Self::from_numbers(core::array::from_fn(|k| all.map(|numbers| numbers[k])))
    }
}

/// Smooth-table kappa of the state with the centre at rest; NaN where there is none.
#[inline(always)]
pub(crate) fn smooth_at_rest<T: Real>(theta: T, angle: &SinCos<T>, terms: &Terms<T>, of: &Moments<T>) -> T {
    let (s, c) = (angle.sin.hi, angle.cos.hi);
    let (n, m) = (terms.n.hi, terms.m.hi);
    let inertia = n.fma(n, of.i1);
    let turning = n * (m / of.ratio + c + of.ratio / m) / inertia;
    existing(theta, terms, turning / s - of.ell.fma(c, s) / inertia)
}

/// Rolling kappa of the state with the centre at rest; NaN where there is none.
#[inline(always)]
pub(crate) fn rolling_at_rest<T: Real>(theta: T, angle: &SinCos<T>, terms: &Terms<T>, of: &Moments<T>) -> T {
    let (s, c) = (angle.sin.hi, angle.cos.hi);
    let (n, m) = (terms.n.hi, terms.m.hi);
    let turn = of.along.fma(c, of.across * s) * (-of.drag).fma(s, c);
    let x = of.tilt + turn + of.lift * of.spin.fma(s, of.ell * c) * s;
    existing(theta, terms, (n / m) * x / s - of.ell.fma(c, s) * of.inverse_j)
}

/// Energy of the state with the centre at rest, in M g R: (I1/I3 + ell^2) rate^2 sin^2/2 + ell cos + sin; NaN
/// where there is none.
#[inline(always)]
pub(crate) fn energy_at_rest<T: Real>(theta: T, angle: &SinCos<T>, terms: &Terms<T>, of: &Moments<T>) -> T {
    let (s, c) = (angle.sin.hi, angle.cos.hi);
    let moment = of.ell.splat(0.5) * (of.ratio + of.ell * of.ell);
    existing(theta, terms, (terms.n.hi / terms.m.hi) * s * moment + of.ell.fma(c, s))
}

/// `x` where theta is in (0, pi/2] and the squared rate positive, NaN elsewhere.
#[inline(always)]
fn existing<T: Real>(theta: T, terms: &Terms<T>, x: T) -> T {
    let (zero, nan) = (x.splat(0.0), x.splat(f64::NAN));
    let sign = terms.m.hi.select_lt(zero, -terms.n.hi, terms.n.hi);
    let steady = zero.select_lt(sign, x, nan);
    x.splat(core::f64::consts::FRAC_PI_2).select_lt(theta, nan, zero.select_lt(theta, steady, nan))
}

/// The code of the point's [`Region`], as a number in a lane.
#[inline(always)]
pub(crate) fn region_of<T: Real>(theta: T, ell: T, terms: &Terms<T>, smooth: T, rolling: T) -> T {
    let x = |v: f64| theta.splat(v);
    let zero = x(0.0);
    let steady = x(4.0) + zero.select_lt(rolling, x(1.0), zero) + zero.select_lt(smooth, x(2.0), zero);
    let product = terms.m.hi.select_lt(zero, -terms.n.hi, terms.n.hi);
    // n or m is NaN where its sign is not known
    let sure = zero.select_lt(product, steady, product.select_lt(zero, x(1.0), x(2.0)));
    let sure = zero.select_lt(terms.m.hi.abs(), sure, x(2.0));
    let inside = x(core::f64::consts::FRAC_PI_2).select_lt(theta, zero, sure);
    let body = x(-1.0).select_lt(ell, inside, zero);
    zero.select_lt(theta, body, zero)
}

/// What is known about the steady state with the centre at rest at inclination `theta`: forbidden,
/// or stable or not by either question. Never fails: what is no question is `Invalid`.
pub fn region(body: &Body, theta: f64) -> Region {
    let code = fearless_simd::dispatch!(crate::level(), _simd => {
        let (angle, of) = (sincos(theta), Moments::of(body));
        let terms = terms(&angle, of.ell, of.excess);
        region_of(theta, of.ell, &terms, smooth_at_rest(theta, &angle, &terms, &of), rolling_at_rest(theta, &angle, &terms, &of))
    });
    [
        Region::Forbidden,
        Region::Undetermined,
        Region::Unstable,
        Region::StableRolling,
        Region::StableSmooth,
        Region::Stable,
    ]
    .into_iter()
    .find(|r| f64::from(*r as u8) == code)
    .unwrap_or(Region::Invalid)
}

/// Squared nutation frequency of the steady state with the centre at rest at inclination `theta`
/// in (0, pi/2], in g/R; negative where unstable, NaN where there is no such state.
pub fn at_rest(body: &Body, theta: f64, contact: Contact) -> f64 {
    fearless_simd::dispatch!(crate::level(), _simd => {
        let (angle, of) = (sincos(theta), Moments::of(body));
        let terms = terms(&angle, of.ell, of.excess);
        match contact {
            Contact::Smooth => smooth_at_rest(theta, &angle, &terms, &of),
            Contact::Rolling => rolling_at_rest(theta, &angle, &terms, &of),
        }
    })
}

/// A state given to six digits counts as steady, and so does one that tilts more slowly than this.
const STEADY: f64 = 1e-6;

/// `kappa` if the state is one that can last: theta in (0, pi/2], no tilting, and terms of its
/// tilting acceleration that cancel; NaN otherwise.
fn if_steady(y: &State, terms: &[f64], kappa: f64) -> f64 {
    let largest = terms.iter().fold(0f64, |a, t| a.max(t.abs()));
    // of a coin upright, all that is left is what pi/2 is rounded by
    let balanced = terms.iter().sum::<f64>().abs() <= (STEADY * largest).max(f64::EPSILON);
    let inside = y.theta > 0.0 && y.theta <= core::f64::consts::FRAC_PI_2;
    if inside && balanced && y.w2.abs() < STEADY { kappa } else { f64::NAN }
}

/// Squared nutation frequency on a frictionless table, in g/R, of any steady state there: its energy
/// at fixed Lz and L3 is stationary, as with the centre at rest.
///
/// NaN for a state that is not steady on a smooth table to six digits: a centre that circles needs
/// friction. Error: 64 ulp of the largest term, for theta above 1e-100.
pub fn smooth(body: &Body, y: &State) -> f64 {
    let (i1, i3, ell) = (body.i1(), body.i3(), body.ell());
    let (s, c) = y.theta.sin_cos();
    // U' = w1 g + cos - ell sin
    let terms = [y.w1 * (i3 * y.w3), -y.w1 * c * (i1 * y.w1 / s), c, -ell * s];
    if_steady(y, &terms, smooth_stiffness(body, y))
}

/// Squared nutation frequency of a rolling steady state, its centre at rest or running along a circle,
/// in g/R.
///
/// NaN for a state that is not steady to six digits. Error: 64 ulp of the largest term, for theta
/// above 1e-100.
pub fn rolling(body: &Body, y: &State) -> f64 {
    let (i1, i3, ell) = (body.i1(), body.i3(), body.ell());
    let (s, c) = y.theta.sin_cos();
    let &State { w1, w3, .. } = y;
    let (ct, turn) = (c / s, w1 / s);
    let terms = [
        (i1 + ell * ell) * c * turn * w1,
        ell * w1 * w1,
        -(i3 + 1.0) * w1 * w3,
        -ell * ct * w1 * w3,
        -c,
        ell * s,
    ];
    if_steady(y, &terms, rolling_stiffness(body, y))
}

/// -d theta''/d theta along the motion, at any state: what a nutation of that moment swings with.
pub(crate) fn stiffness(contact: Contact, body: &Body, y: &State) -> f64 {
    match contact {
        Contact::Smooth => smooth_stiffness(body, y),
        Contact::Rolling => rolling_stiffness(body, y),
    }
}

fn smooth_stiffness(body: &Body, y: &State) -> f64 {
    let (i1, i3, ell) = (body.i1(), body.i3(), body.ell());
    let (s, c) = y.theta.sin_cos();
    let (spin, turn) = (i3 * y.w3, i1 * y.w1 / s);
    let g = spin - c * turn;
    let bend = (g * g + turn * (turn - c * g)) / i1 - ell * c - s;
    bend / (i1 + (ell * s - c).powi(2))
}

fn rolling_stiffness(body: &Body, y: &State) -> f64 {
    let (i1, i3, ell) = (body.i1(), body.i3(), body.ell());
    let (j, d) = (body.j(), body.big_d());
    let (s, c) = y.theta.sin_cos();
    let &State { w1, w3, .. } = y;
    let (ct, turn) = (c / s, w1 / s);
    // theta'' = F/J and its partial derivatives
    let f_theta = turn * (ell * (w3 / s) - (i1 + ell * ell) * turn) + s + ell * c;
    let f_1 = 2.0 * ((i1 + ell * ell) * c * turn + ell * w1) - (i3 + 1.0 + ell * ct) * w3;
    let f_3 = -(i3 + 1.0 + ell * ct) * w1;
    let w1_theta = -c * turn - (i3 * ell / d) * w1 + (i3 * (i3 + 1.0) / d) * w3;
    let w3_theta = (i1 * w1 + i3 * ell * w3) / d;
    -(f_theta + f_1 * w1_theta + f_3 * w3_theta) / j
}

/// Angular frequency of the nutation, in sqrt(g/R): sqrt(kappa), 0 where unstable.
pub fn nutation(kappa: f64) -> f64 {
    if kappa.is_nan() { kappa } else { kappa.max(0.0).sqrt() }
}

/// Rate at which a small disturbance grows, in sqrt(g/R): sqrt(-kappa), 0 where stable.
pub fn growth_rate(kappa: f64) -> f64 {
    nutation(-kappa)
}

/// Inclinations in (0, pi/2) where the stability of the state with the centre at rest changes,
/// ascending, NaN after the last: the boundary curves of the map.
///
/// Not computed, and all NaN, for `ell` above 1e30 or I1/I3 above 1e60. Error: 16 ulp times the
/// conditioning.
pub fn boundaries(body: &Body, contact: Contact) -> [f64; 3] {
    // kappa times its denominators over cos^3, with T = tan theta, so that 1 = 1/cos^2 = 1 + T^2
    let (one, t, ell, i3) = (Cubic::of(1.0), Cubic::T, Cubic::of(body.ell()), Cubic::of(body.i3()));
    let (n, d) = (steady::shared(body), Cubic::of(body.excess_sum()));
    let (m, a, weight) = (n + d, one + d, t * (ell + t));
    let critical = body.excess() == 0.0;
    let cubic = match contact {
        // a critical body: both have the factor n, which is no change of stability where it is double
        Contact::Smooth if critical => n * (n + Cubic::of(2.0)),
        Contact::Smooth => n * (m * m + a * m + a * a * (one + t * t)) - a * m * weight,
        Contact::Rolling => {
            let (i1, drag) =
                (Cubic::of(body.i1()), Cubic::of(body.i3() * body.i3() * body.ell() / body.big_d()));
            let lift = (body.i1() + body.i3() * body.ell() * body.ell()) / body.big_d();
            let turn = (i1 * Cubic::of(2.0) + ell * ell + ell * (one - i3) * t) * (one - drag * t);
            let x = i1 * (one + t * t) + turn + Cubic::of(lift) * t * (ell + (i3 + one) * t);
            if critical { x - i3 * weight } else { n * x - i3 * m * weight }
        }
    };
    steady::inclinations_of(body, cubic)
}
