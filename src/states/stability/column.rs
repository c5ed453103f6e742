//! Columns of eight bodies, with sharp or rounded rims, for which `at_rest` computes eight points of a map at a time.

use super::at_rest::{AtRest, Moments, Rounded, SteadyPoint, Wanted};
use crate::laws::body::Body;
use crate::numbers::{LANES, Narrow, Real};

/// Eight bodies, whose numbers are stored in arrays of eight.
pub(crate) trait Stored: Sync {
    /// The form in which as many of these bodies as a number has SIMD lanes are computed.
    type Of<T: Narrow>: AtRest<T>;

    /// The bodies from index `k` on, one in each SIMD lane.
    fn load<T: Narrow>(&self, like: T, k: usize) -> Self::Of<T>;
}

/// A number whose SIMD lanes are the values of `eight` from `k` on; a number with eight lanes or more has all of them.
#[inline(always)]
fn lanes_from<T: Narrow>(like: T, eight: &[f64; LANES], k: usize) -> T {
    like.load(if T::COUNT < LANES { &eight[k..] } else { eight })
}

impl Stored for Moments<[f64; LANES]> {
    type Of<T: Narrow> = Moments<T>;

    #[inline(always)]
    fn load<T: Narrow>(&self, like: T, k: usize) -> Moments<T> {
        self.map(
            #[inline(always)]
            |x| lanes_from(like, &x, k),
        )
    }
}

impl Stored for Rounded<[f64; LANES]> {
    type Of<T: Narrow> = Rounded<T>;

    #[inline(always)]
    fn load<T: Narrow>(&self, like: T, k: usize) -> Rounded<T> {
        Rounded::from_numbers(self.numbers().map(
            #[inline(always)]
            |x| lanes_from(like, &x, k),
        ))
    }
}

/// One body, or eight bodies in SIMD lanes, on sharp rims, on rounded rims, or on both kinds; a lane of one kind is NaN
/// in the numbers of the other kind.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Column<T> {
    sharp: Option<Moments<T>>,
    round: Option<Rounded<T>>,
}

impl<T: Real> Column<T> {
    /// The column of uniform tubes with sharp edges; NaN where no such tube exists.
    #[inline(always)]
    pub fn tube(half: T, bore: T) -> Self {
        Self { sharp: Some(Moments::tube(half, bore)), round: None }
    }

    /// The column of uniform tubes with rounded edges; if `mixed`, the edges of some tubes may be sharp.
    #[inline(always)]
    pub fn rounded_tube(half: T, bore: T, fillet: T, mixed: bool) -> Self {
        let round = Some(Rounded::tube(half, bore, fillet));
        // A lane with a fillet other than 0 is NaN among the sharp rims.
        let (zero, nan) = (half.splat(0.0), half.splat(f64::NAN));
        let sharp = fillet.abs().select_lt(half.splat(f64::from_bits(1)), half, nan) + fillet * zero;
        Self { sharp: if mixed { Some(Moments::tube(sharp, bore)) } else { None }, round }
    }
}

impl<T: Narrow> Column<T> {
    /// The requested quantities at an inclination, for each body.
    #[inline(always)]
    pub fn found(&self, theta: T, wanted: Wanted) -> SteadyPoint<T> {
        let (mut a, mut ell) = (SteadyPoint::nothing(theta), theta.splat(f64::NAN));
        // `if let` stands here instead of `Option::map`, whose closure, if not inlined, is not compiled for the lanes.
        if let Some(of) = &self.sharp {
            (a, ell) = (of.found(theta, &Moments::angle(theta), wanted), of.ell);
        }
        let Some(of) = &self.round else { return a };
        let b = of.found(theta, &Rounded::angle(theta), wanted);
        // Each lane has the values of its own kind of rim; `ell` is NaN where the rim is not sharp.
        let none = theta.splat(f64::NEG_INFINITY);
        a.with(
            b,
            #[inline(always)]
            |a, b| none.select_lt(ell, a, b),
        )
    }
}

impl Column<f64> {
    pub fn of(body: &Body) -> Self {
        if body.is_plain() {
            return Self { sharp: Some(Moments::of(body)), round: None };
        }
        Self { sharp: None, round: Some(Rounded::of(body)) }
    }
}

impl<T: Copy> Column<T> {
    /// Applies `f` to each number, for example to load it into SIMD lanes.
    #[inline(always)]
    pub fn map<U: Copy>(&self, f: impl Fn(T) -> U) -> Column<U> {
        let mut column = Column { sharp: None, round: None };
        if let Some(of) = &self.sharp {
            column.sharp = Some(of.map(&f));
        }
        if let Some(of) = &self.round {
            column.round = Some(Rounded::from_numbers(of.numbers().map(&f)));
        }
        column
    }
}

impl Column<[f64; LANES]> {
    /// The column of at most eight bodies; a SIMD lane without a body is NaN.
    pub fn gather(bodies: &[Option<Body>]) -> Self {
        let (mut sharp, mut round) = ([[f64::NAN; 12]; LANES], [[f64::NAN; 10]; LANES]);
        let mut kinds = [false; 2];
        for (i, body) in bodies.iter().take(LANES).enumerate() {
            let Some(of) = body.as_ref().map(Column::of) else { continue };
            if let Some(of) = of.sharp {
                (sharp[i], kinds[0]) = (of.numbers(), true);
            }
            if let Some(of) = of.round {
                (round[i], kinds[1]) = (of.numbers(), true);
            }
        }
        let sharp = || Moments::from_numbers(core::array::from_fn(|k| sharp.map(|x| x[k])));
        let round = || Rounded::from_numbers(core::array::from_fn(|k| round.map(|x| x[k])));
        // A column without any body is stored as sharp rims, all NaN.
        Self { sharp: (kinds[0] || !kinds[1]).then(sharp), round: kinds[1].then(round) }
    }

    /// The bodies on sharp rims; the SIMD lanes of other bodies are NaN.
    pub fn sharp(bodies: &[Option<Body>]) -> Moments<[f64; LANES]> {
        let found = Self::gather(bodies).sharp;
        found.unwrap_or_else(|| Moments::from_numbers([[f64::NAN; LANES]; 12]))
    }

    /// The bodies on rounded rims; the SIMD lanes of other bodies are NaN.
    pub fn rounded(bodies: &[Option<Body>]) -> Rounded<[f64; LANES]> {
        Self::gather(bodies).round.unwrap_or_else(|| Rounded::from_numbers([[f64::NAN; LANES]; 10]))
    }
}
