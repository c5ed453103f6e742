//! What losses do to a slip: the ways of what dry ones resist, and where a falling face settles or a rolling stops.

use super::Slide;
use crate::loss::{Couples, Law, NEAR, SLACK, Seen, Ways, going, mirrored, rolling_growth};
use crate::motion::flow::{Flow, Halt, Place};
use crate::number::{Dual, Real};
use crate::state::State;

/// A face that falls lies so close before it can settle, and it has where its contact stops so many times faster than it falls.
const CLOSE: f64 = 0.01;
const FASTER: f64 = 1e3;
const SLOWER: f64 = 0.01;
/// A face so close to the table rolls as slowly as what rests.
const FLAT: f64 = 1e-12;

impl Slide {
    /// The ways of what dry losses resist, from a state on.
    pub fn face(&mut self, y: &State, slip: [f64; 2]) {
        let Some(losses) = self.law.losses else { return };
        let angle = y.theta.sin_cos();
        let w = [y.w1, y.w2, y.w3];
        let seen = losses.seen(&self.law.shape.rim, angle, w[0] / angle.0, w);
        let still = Ways::default();
        self.turn(still);
        // what is at rest begins to move where the rest of the world moves it
        let [spin, drilling, rocking] = self.changes(angle, w, slip);
        // what has been held is at rest up to rounding
        let at_rest = 10.0 * SLACK * (1.0 + (w[0] / angle.0).abs()) * f64::from(w != [0.0; 3]);
        let way = |value: f64, rate: f64| {
            if value.abs() > at_rest {
                value.signum()
            } else if rate != 0.0 {
                rate.signum()
            } else {
                0.0
            }
        };
        let (spinning, turning) = (w[2] - angle.1 * (w[0] / angle.0), seen.drilling());
        let planar = w[0] == 0.0 && w[2] == 0.0 && spin == 0.0;
        let rocking = if planar { way(w[1], rocking) } else { 0.0 };
        self.turn(Ways { contour: way(spinning, spin), drilling: way(turning, drilling), rocking });
    }

    fn turn(&mut self, ways: Ways) {
        if let (Some(losses), Some(sloped)) = (&mut self.law.losses, &mut self.sloped.losses) {
            losses.ways = Some(ways);
            *sloped = losses.map(|value| Dual { value, slope: 0.0 });
        }
    }

    /// psi'', w_z' and w2'.
    fn changes(&self, angle: (f64, f64), w: [f64; 3], slip: [f64; 2]) -> [f64; 3] {
        let ((s, c), [w1, w2, w3]) = (angle, w);
        let still = slip == [0.0; 2] && self.law.dry;
        let at =
            if still { self.law.towards(angle, w, slip, [0.0; 2]) } else { self.law.at(angle, w, slip).0 };
        let [d1, d2, d3] = at.w;
        [d3 - c / s * d1 - w1 * w2 / (s * s), s * d1 + c * d3 - w2 * (c * w1 - s * w3), d2]
    }

    /// Goes on where what a dry loss resists has stopped for a moment, the other way; false where it stays at rest.
    pub fn turns(&mut self, halt: Halt, y: &State, slip: [f64; 2]) -> bool {
        let Some(Ways { contour, drilling, rocking }) = self.law.losses.and_then(|losses| losses.ways) else {
            return false;
        };
        let (ways, i) = match halt {
            Halt::Contour => (Ways { contour: -contour, drilling, rocking }, 0),
            Halt::Drilling => (Ways { contour, drilling: -drilling, rocking }, 1),
            _ => (Ways { contour, drilling, rocking: -rocking }, 2),
        };
        self.turn(ways);
        let change = self.changes(y.theta.sin_cos(), [y.w1, y.w2, y.w3], slip)[i];
        change * [ways.contour, ways.drilling, ways.rocking][i] > 0.0
    }

    /// Whether what grows with psi' stops the contact along the rim ever faster, while the face falls.
    pub(super) fn settles<const N: usize>(&self, place: &Place<N>) -> bool {
        let ([s, c, w1, w2, w3], shape) = (core::array::from_fn(|i| place.y[i]), &self.law.shape);
        // how fast either face falls
        let fall = c * w2;
        if s > CLOSE || self.ball || fall <= 0.0 {
            return false;
        }
        let ct = c / s;
        if s * (w3 - ct * w1).abs() > SLOWER * fall {
            return false;
        }
        let slope =
            self.law.losses.map_or(0.0, |losses| losses.slope(s, shape.rim.radius((s, c)), w3 - ct * w1));
        slope * (1.0 / shape.i3 + ct * ct / shape.i1) * s > FASTER * fall
    }

    /// The landing of a face that is all but flat, where it settles; and by how much that may be off.
    pub fn lands<const N: usize>(&self, y: [f64; N]) -> ([f64; N], f64) {
        let place = self.place(y);
        let (fall, faster) = (y[1] * y[3], y[1] * place.rate[3] / place.rate[7]);
        // s = fall t + faster t^2/2
        let left = 2.0 * y[0] / (fall + (fall * fall + 2.0 * faster * y[0]).max(0.0).sqrt());
        let mut end = self.falling(&place, left);
        let [s, c, w1, w3] = [y[0], y[1], y[2], y[4]];
        end[0] = 0.0;
        // what neither runs along the rim nor stands keeps its drilling alone
        (end[2], end[4]) = (0.0, s * w1 + c * w3);
        (end, (left * left.max(s)).max(w1.abs()) * (1.0 + faster.abs()))
    }

    /// A little later, where the contact has settled: in a straight line.
    pub fn falling<const N: usize>(&self, place: &Place<N>, left: f64) -> [f64; N] {
        let y = &place.y;
        let mut end = *y;
        for (i, x) in end.iter_mut().enumerate().filter(|(i, _)| ![2, 4].contains(i)) {
            // along the rim it stays
            *x += left * place.rate[i] / place.rate[7];
        }
        end
    }

    /// Whether rolling and rocking are stopped by rolling resistance, from either side.
    pub(super) fn comes_to_rest<const N: usize>(&self, place: &Place<N>) -> bool {
        let there = |losses: &Couples<f64>| {
            let planar = losses.ways.is_some_and(|ways| ways.rocking != 0.0);
            losses.has(Law::RollingResistance) && !planar
        };
        if !self.law.losses.as_ref().is_some_and(there) || place.y[0].abs() < FLAT {
            return false;
        }
        let [s, c, w1, w2, w3, u_h, u_2] = core::array::from_fn(|i| place.y[i]);
        let (angle, w) = ((s, c), [w1, w2, w3]);
        let growth = |w: [f64; 3]| rolling_growth(angle, w, self.law.at(angle, w, [u_h, u_2]).0.w);
        growth(w)[0] <= 4.0 * NEAR && growth(w)[1] < 0.0 && growth(mirrored(angle, w))[1] < 0.0
    }
}

/// How far what dry losses resist is from stopping, along the rim; and drilling, or the rocking of a body that only rocks.
pub(super) fn ways<T: Real>(losses: &Couples<T>, seen: &Seen<T>) -> [T; 2] {
    let one = seen.spin.splat(1.0);
    let size = one + seen.w[0].abs() / seen.angle.0.abs();
    let slack = one.splat(SLACK) * size;
    let Some(of) = losses.ways else { return [one; 2] };
    let contour = if losses.has(Law::DryContour) { going(of.contour, seen.spin, slack) } else { one };
    if of.rocking != 0.0 {
        let way = one.splat(of.rocking);
        let there = losses.has(Law::RollingResistance);
        return [contour, if there { going(way, seen.w[1], slack) } else { one }];
    }
    let there = losses.has(Law::Drilling);
    [contour, if there { going(of.drilling, seen.drilling(), slack) } else { one }]
}
