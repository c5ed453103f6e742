//! The slow slips of a body of revolution, as power series of all components of its state vector.

use crate::laws::body::Rim;
use crate::laws::contact::lying::Lying;
use crate::laws::contact::slip::Slipping;
use crate::laws::loss::Ways;
use crate::laws::state::{drilling_of, rolling_of, spin_of};
use crate::motions::walk::numbers::{HEAT, PHI, PSI, TIME, X, Y, loses, poses};
use crate::motions::walk::slow::{SlowRates, SlowSlip, SlowSlips, turned};
use crate::motions::walk::{SlowLaw, SlowSeries};
use crate::numbers::tape::{Tape, Taped};
use crate::numbers::{Real, Series};

/// The power series of a body's slow slips under one law.
pub(crate) struct BodySlips {
    slips: RecordedSlips,
    /// The circle of contact if the body slips on one only; `ways` has the signs of the rotations that its dry losses
    /// resist, for which the law was recorded.
    one: Option<Rim<f64>>,
    ways: Option<Ways>,
    /// Index of the time derivative of the lost energy in [`SlowRates::more`].
    lost: Option<usize>,
}

/// The recorded law of a slip on a level table, or on one that is tilted or turns, where sine and cosine of phi and
/// the place belong to the state as well.
enum RecordedSlips {
    Level(SlowSlips<5>),
    Tilted(SlowSlips<9>),
}

impl RecordedSlips {
    fn more(&self, i: usize) -> Series {
        match self {
            Self::Level(slips) => slips.more(i),
            Self::Tilted(slips) => slips.more(i),
        }
    }
}

/// The law of a slip on one rim, or on two rims where the other rim already slips.
pub(crate) enum Slippery {
    /// A slip on one rim, with the tangent of the slope and the rate at which the table turns.
    One(Slipping<f64>, [f64; 2]),
    Two(Lying<f64>, f64),
}

impl BodySlips {
    /// The power series under a law, for a state vector with `count` components.
    pub fn of(law: &Slippery, tol: f64, count: usize) -> Self {
        match law {
            Slippery::One(law, table) => Self::on_one(law, *table, tol, count),
            Slippery::Two(law, tilt) => Self::on_two(law, *tilt, tol, count),
        }
    }

    /// Whether these power series are those of a body on one rim under this law.
    pub fn are_under(&self, law: &Slipping<f64>) -> bool {
        self.one == Some(law.shape.rim) && self.ways == law.losses.and_then(|losses| losses.ways)
    }

    fn on_two(law: &Lying<f64>, tilt: f64, tol: f64, count: usize) -> Self {
        let mut lost = None;
        let level = Lying { pull: None, ..*law };
        let slips = if tilt == 0.0 {
            RecordedSlips::Level(SlowSlips::of(tol, |tape, [_, _, w1, _, w3], slip, way| {
                Self::rates_on_two(
                    &level.map(|x| tape.number(x)),
                    tape,
                    [w1, w3],
                    [slip, way],
                    (count, &mut lost),
                )
            }))
        } else {
            RecordedSlips::Tilted(SlowSlips::of(tol, |tape, [_, _, w1, _, w3, sin, cos, _, _], slip, way| {
                let mut taped = level.map(|x| tape.number(x));
                let tilt = tape.number(tilt);
                taped.pull = Some([tilt * cos, -(tilt * sin)]);
                let SlowRates { numbers: [a, b, d1, d2, d3], slip, more } =
                    Self::rates_on_two(&taped, tape, [w1, w3], [slip, way], (count, &mut lost));
                let (turn, moves) = (w1 / taped.border.angle.0, Self::moves(&more, [sin, cos]));
                let numbers = [a, b, d1, d2, d3, cos * turn, -(sin * turn), moves[0], moves[1]];
                SlowRates { numbers, slip, more }
            }))
        };
        Self { slips, one: None, ways: None, lost }
    }

    /// The rates of a slip on two rims, and the index of the rate of the lost energy.
    fn rates_on_two<'a>(
        taped: &Lying<Taped<'a>>,
        tape: &'a Tape,
        [w1, w3]: [Taped<'a>; 2],
        [slip, way]: [[Taped<'a>; 2]; 2],
        (count, lost): (usize, &mut Option<usize>),
    ) -> SlowRates<Taped<'a>, 5> {
        let y = [w1, w3, slip[0], slip[1]];
        let [mu, _] = taped.strength;
        let [u, v] = taped.other_slip(y);
        let size = (u * u + v * v).sqrt();
        let at = taped.slipping_along(y, [way.map(|x| mu * x), [mu * u / size, mu * v / size]]);
        let [[_, low_2, low_h], [_, up_2, up_h]] = at.force;
        let mut more = vec![-(low_2 * slip[1] + low_h * slip[0] + up_2 * v + up_h * u)];
        let angle = taped.border.angle;
        if poses(count) {
            let spin = spin_of(angle, w1, w3);
            let radius = taped.border.circles[0].radius;
            more.extend([w1 / angle.0, spin, slip[0], slip[1] + radius * spin]);
        }
        if loses(count) {
            *lost = Some(more.len());
            let [drilling, rolling] = [drilling_of(angle, w1, w3), rolling_of(angle, w1, w3)];
            more.push(at.couple[1] * rolling - at.couple[0] * drilling);
        }
        let still = tape.number(0.0);
        SlowRates { numbers: [still, still, at.w[0], still, at.w[1]], slip: at.u, more }
    }

    fn on_one(law: &Slipping<f64>, [tilt, turning]: [f64; 2], tol: f64, count: usize) -> Self {
        let mut lost = None;
        let slips = if tilt == 0.0 && turning == 0.0 {
            RecordedSlips::Level(SlowSlips::of(tol, |tape, numbers, slip, way| {
                Self::rates_on_one(law, tape, numbers, [slip, way], (count, &mut lost))
            }))
        } else {
            RecordedSlips::Tilted(SlowSlips::of(
                tol,
                |tape, [s, c, w1, w2, w3, sin, cos, x, y], slip, way| {
                    let SlowRates { numbers: [ds, dc, d1, d2, d3], slip: [du_h, du_2], mut more } =
                        Self::rates_on_one(law, tape, [s, c, w1, w2, w3], [slip, way], (count, &mut lost));
                    let (tilt, om, turn) = (tape.number(tilt), tape.number(turning), w1 / s);
                    // The velocity of the contact point, over the table and with it.
                    let [_, _, _, out, on, ..] = &mut more[..] else {
                        unreachable!("a slope needs the pose")
                    };
                    (*out, *on) = (*out + om * (x * sin - y * cos), *on + om * (x * cos + y * sin));
                    let (out, on) = (*out, *on);
                    let moves = [out * cos - on * sin, out * sin + on * cos];
                    let numbers = [ds, dc, d1, d2, d3, cos * turn, -(sin * turn), moves[0], moves[1]];
                    let slip = [du_h + tilt * cos + om * on, du_2 - tilt * sin - om * out];
                    SlowRates { numbers, slip, more }
                },
            ))
        };
        Self { slips, one: Some(law.shape.rim), ways: law.losses.and_then(|losses| losses.ways), lost }
    }

    /// The time derivative of the place (x, y) of the contact point, from the rates of [`SlowRates::more`].
    fn moves<'a>(more: &[Taped<'a>], [sin, cos]: [Taped<'a>; 2]) -> [Taped<'a>; 2] {
        let [_, _, _, out, on, ..] = *more else { unreachable!("a slope needs the pose") };
        [out * cos - on * sin, out * sin + on * cos]
    }

    /// The rates of a slip on one rim on a level table, and the index of the rate of the lost energy.
    fn rates_on_one<'a>(
        law: &Slipping<f64>,
        tape: &'a Tape,
        [s, c, w1, w2, w3]: [Taped<'a>; 5],
        [slip, way]: [[Taped<'a>; 2]; 2],
        (count, lost): (usize, &mut Option<usize>),
    ) -> SlowRates<Taped<'a>, 5> {
        let number = |x: f64| tape.number(x);
        let taped = Slipping::of(&law.shape.map(number), number(law.strength), true)
            .with_losses(law.losses.map(|losses| losses.map(number)));
        let (w, rim) = ([w1, w2, w3], &taped.shape.rim);
        let at = taped.towards((s, c), w, slip, way);
        let [normal, along, across] = at.force;
        let mut more = vec![-(along * slip[1] + across * slip[0])];
        let precession = w1 / s;
        if poses(count) {
            let spin = w3 - c * precession;
            let (out, on) = (slip[0] + rim.rho * w2, slip[1] + rim.radius((s, c)) * spin);
            more.extend([precession, spin, out, on]);
        }
        if let Some(losses) = taped.losses.as_ref().filter(|_| loses(count)) {
            *lost = Some(more.len());
            more.push(losses.power(&losses.seen(rim, (s, c), precession, w), normal));
        }
        let [d1, d2, d3] = at.w;
        SlowRates { numbers: [-(c * w2), s * w2, d1, d2, d3], slip: at.u, more }
    }

    /// The power series of all components of a state vector, from those of a slow slip.
    fn series<const N: usize, const K: usize>(&self, y: &[f64; N], slow: &SlowSlip<K>) -> Box<SlowSeries<N>> {
        let rate = |i: usize| self.slips.more(i);
        let mut numbers: [Series; N] = core::array::from_fn(|i| Series::of(y[i]));
        numbers[..5].copy_from_slice(&slow.known[..5]);
        numbers[5..7].copy_from_slice(&slow.slip);
        (numbers[TIME].at[1], numbers[HEAT]) = (1.0, rate(0).integral(y[HEAT]));
        if poses(N) {
            let [precession, spin, out, on] = [1, 2, 3, 4].map(rate);
            (numbers[PHI], numbers[PSI]) = (precession.integral(y[PHI]), spin.integral(y[PSI]));
            let [sin, cos] = circle(y[PHI], &precession, slow.terms);
            let product = |a: &Series, b: &Series, from: f64| a.times(b, slow.terms - 1).integral(from);
            numbers[X] = product(&out, &cos, y[X]).plus(-1.0, &product(&on, &sin, 0.0));
            numbers[Y] = product(&out, &sin, y[Y]).plus(1.0, &product(&on, &cos, 0.0));
        }
        if let Some(lost) = self.lost {
            numbers[N - 1] = rate(lost).integral(y[N - 1]);
        }
        let (until, ends) = slow.until(&numbers[..9]);
        Box::new(SlowSeries {
            numbers,
            from: y[TIME],
            until,
            ends,
            pays: slow.pays(until, ends),
            settling: slow.settling,
            angle: slow.angle,
        })
    }
}

impl<const N: usize> SlowLaw<N> for BodySlips {
    #[inline(never)]
    fn follow(&mut self, y: &[f64; N], angle: Series, growth: f64, speed: f64) -> Option<Box<SlowSeries<N>>> {
        match &mut self.slips {
            RecordedSlips::Level(slips) => {
                let slow = slips.follow(core::array::from_fn(|i| y[i]), (angle, growth), speed)?;
                Some(self.series(y, &slow))
            }
            RecordedSlips::Tilted(slips) => {
                let (sin, cos) = y[PHI].sin_cos();
                let [s, c, w1, w2, w3]: [f64; 5] = core::array::from_fn(|i| y[i]);
                let start = [s, c, w1, w2, w3, sin, cos, y[X], y[Y]];
                let slow = slips.follow(start, (angle, growth), speed)?;
                Some(self.series(y, &slow))
            }
        }
    }
}

/// The first `terms` coefficients of the power series of the sine and the cosine of an angle that grows from `start`
/// at this rate.
fn circle(start: f64, rate: &Series, terms: usize) -> [Series; 2] {
    let (sin, cos) = start.sin_cos();
    let (mut sine, mut cosine) = (Series::of(sin), Series::of(cos));
    for n in 1..terms {
        (sine.at[n], cosine.at[n]) = (turned(&cosine.at, &rate.at, n), -turned(&sine.at, &rate.at, n));
    }
    [sine, cosine]
}
