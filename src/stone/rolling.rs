//! A stone on a rough table that nothing stops: neither an edge nor a lift-off ends its rolling.
//!
//! ```text
//! y = (q, w, x, y)     q' = q w/2,   w' of the law of rolling,   (x, y)' = -w x r along the table
//! ```
//! This is the motion of [`roll`](super::roll) without its phases, of which a page has no use: their code is five times
//! as long. Error: the motion is computed twice, with other steps; `tests/laws/stone.rs` compares it with that of `roll`.

use super::Ellipsoid;
use super::law::{StoneLaw, laboratory, turning};
use super::state::StoneState;
use crate::error::{Error, within};
use crate::motion::path::{SAFETY, rougher};
use crate::number::vector::{cross, dot};
use crate::rk8::{self, growth};

pub(super) const N: usize = 9;
/// Number of steps between two calls of `go_on`.
const BREATH: u64 = 256;
/// A rougher run stops at one of this many times.
const FEWER: usize = 4;
/// A step that is shorter leads nowhere.
const SHORTEST: f64 = 1e-12;

/// A stone at one time of its rolling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RollingStone {
    /// The time, in sqrt(a/g).
    pub time: f64,
    /// The turn from the axes of the ellipsoid to those of the laboratory, as a quaternion (w, x, y, z) of length 1.
    pub orientation: [f64; 4],
    /// The place of the centre of mass above the table, counted from that of the first contact point.
    pub centre: [f64; 2],
    /// The rates of the orientation and of the centre.
    pub rates: ([f64; 4], [f64; 2]),
    /// The vertical and the angular velocity.
    pub state: StoneState,
    /// The normal force per weight; the stone would lift off where it is negative.
    pub normal: f64,
}

/// The rolling of a stone from a start at time 0, at the `times`, which ascend from 0 on; and its error.
///
/// `tol` is the error that a step may have; every one of the times ends a step. `go_on` is called often; if it returns
/// false, the result is `Ok(None)`. Errors: `OutOfRange` for an angular velocity beyond 1e6; `Endless` where the motion
/// hardly advances.
///
/// ```
/// use spincyl::{Ellipsoid, stone};
///
/// let stone = Ellipsoid::rattleback([1.0, 0.2, 0.17], None, 0.03, None)?;
/// let times: Vec<f64> = (0..=60).map(f64::from).collect();
/// let (rows, error) = stone::rolling(&stone, stone.spinning(-0.4, 0.002, 0.0), &times, 1e-10, || true)?.unwrap();
/// assert!(rows.iter().any(|row| row.state.spin() > 0.1) && error < 1e-4);
/// # Ok::<(), spincyl::Error>(())
/// ```
pub fn rolling(
    stone: &Ellipsoid,
    start: StoneState,
    times: &[f64],
    tol: f64,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<(Vec<RollingStone>, f64)>, Error> {
    for (name, w) in ["w1", "w2", "w3"].into_iter().zip(start.w) {
        within(name, w, (-1e6, 1e6), "|w| <= 1e6 sqrt(g/a) for a motion")?;
    }
    let (law, rough) = (stone.law(0.0, false), rougher(tol));
    let Some(rows) = run(&law, &start, (times, 1), tol, &mut go_on)? else { return Ok(None) };
    let Some(others) = run(&law, &start, (times, FEWER), rough, &mut go_on)? else { return Ok(None) };
    let mut apart = 0f64;
    for (a, b) in rows.iter().step_by(FEWER).zip(&others) {
        for i in 0..4 {
            apart = apart.max((a.orientation[i] - b.orientation[i]).abs());
        }
        for i in 0..3 {
            apart = apart.max((a.state.w[i] - b.state.w[i]).abs());
        }
    }
    Ok(Some((rows, tol.max(SAFETY * tol / rough * apart))))
}

/// The numbers of a start.
pub(super) fn numbers(stone: &StoneLaw<f64>, start: &StoneState) -> [f64; N] {
    let q = start.orientation();
    let at = stone.touching(start.vertical, start.w);
    let ([a, b, c, d], [e, f, g], lab) = (q, start.w, laboratory(q));
    [a, b, c, d, e, f, g, -dot(lab[0], at.r), -dot(lab[1], at.r)]
}

/// Writes the rates of the numbers, and returns the vertical and the normal force.
#[inline(never)]
pub(super) fn write_rates(law: &StoneLaw<f64>, y: &[f64; N], all: &mut [f64; N]) -> ([f64; 3], f64) {
    let &[a, b, c, d, e, f, g, ..] = y;
    let (q, w) = ([a, b, c, d], [e, f, g]);
    let lab = laboratory(q);
    let at = law.touching(lab[2], w);
    let (to, v) = (law.rolling(&at, w), cross(at.r, w));
    all[..4].copy_from_slice(&turning(q, w));
    all[4..7].copy_from_slice(&to.w);
    (all[7], all[8]) = (dot(lab[0], v), dot(lab[1], v));
    (lab[2], to.free)
}

/// One run to one of every so many of the times.
fn run(
    law: &StoneLaw<f64>,
    start: &StoneState,
    (times, every): (&[f64], usize),
    tol: f64,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Option<Vec<RollingStone>>, Error> {
    let (mut y, mut rate, mut t, mut h) = (numbers(law, start), [0.0; N], 0f64, 0.01f64);
    let (mut stages, mut rows) = ([rate; rk8::STAGES], Vec::with_capacity(times.len()));
    for steps in 1u64.. {
        let (vertical, normal) = write_rates(law, &y, &mut rate);
        let [a, b, c, d, e, f, g, left, ahead] = y;
        let Some(&next) = times.get(rows.len() * every) else { break };
        if t >= next {
            let state = StoneState { vertical, w: [e, f, g] };
            let rates = ([rate[0], rate[1], rate[2], rate[3]], [rate[7], rate[8]]);
            let orientation = [a, b, c, d];
            rows.push(RollingStone { time: next, orientation, centre: [left, ahead], rates, state, normal });
            continue;
        }
        if steps.is_multiple_of(BREATH) && !go_on() {
            return Ok(None);
        }
        let speed = e.abs().max(f.abs()).max(g.abs()).max(1.0);
        h = h.min(3.0 / speed).min(next - t);
        let made = rk8::step::<{ rk8::LOOPS }, _, _>(
            |y, all| {
                write_rates(law, y, all);
            },
            &y,
            &rate,
            h,
            &mut stages,
        );
        let error = made.error(|i| if i < 4 { 1.0 / tol } else { 1.0 / (tol * speed) }, N as f64);
        if error.is_nan() || error > 1.0 {
            h *= growth(error).min(0.7);
            if h < SHORTEST {
                return Err(Error::Endless { theta: start.theta(), time: t });
            }
            continue;
        }
        y.iter_mut().zip(made.change).for_each(|(x, by)| *x += by);
        let per = 1.0 / (y[0] * y[0] + y[1] * y[1] + y[2] * y[2] + y[3] * y[3]).sqrt();
        y[..4].iter_mut().for_each(|q| *q *= per);
        t = if h == next - t { next } else { t + h };
        h *= growth(error);
    }
    Ok(Some(rows))
}
