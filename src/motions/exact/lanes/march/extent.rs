//! The least normal force, and the greatest coefficient of friction that rolling needs, up to an inclination.

use super::{Knot, March, here};
use crate::laws::contact::force_of;
use crate::laws::contact::reduced::Rates;
use crate::motions::exact::lanes::series::{
    angle_at, change_of_theta, lane_lines, normalized, square_of_rate,
};
use crate::numbers::Lane;
use crate::numbers::power::horner;

/// Number of samples of a panel. `ROUNDS` times the samples are repeated about the least value, whose place is found
/// to 1e-6 of the panel or better, and the value to the square of that.
const SAMPLES: usize = 16;
const ROUNDS: usize = 8;

/// The extreme contact forces within a panel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Extent<T> {
    /// The least normal force in units of the weight.
    pub normal: T,
    /// The greatest coefficient of friction that rolling needs; infinite where the normal force is not positive.
    pub friction: T,
    /// 1 if the given inclination lies in this panel, else 0.
    pub over: T,
    pub knot: Knot<T>,
}

impl<T: Lane> March<T> {
    /// The extreme contact forces of the panel that begins at a knot, up to the inclination whose sine and cosine are
    /// `side`.
    #[inline(always)]
    pub fn extent<const N: usize>(&self, knot: &Knot<T>, way: T) -> Extent<T> {
        let number = here(
            #[inline(always)]
            |x: f64| way.splat(x),
        );
        let (zero, one) = (number(0.0), number(1.0));
        let (law, s, c) = (&self.law, knot.sin, knot.cos);
        let (mut w1, mut w3, mut force) = ([knot.w1; N], [knot.w3; N], [knot.force; N]);
        lane_lines::<_, N>(law, s, c, &mut w1, &mut w3);
        square_of_rate::<_, N>(law, s, c, &w1, &w3, &mut force);
        let rates = Rates::of(law.contact, &law.shape, law.round);
        let [sin_side, cos_side] = self.side;
        let level = (way * (sin_side * c - cos_side * s) / (sin_side + s)).max(zero);
        let edge = self.edge(knot, [&w1, &w3, &force]);
        let out = level.min(edge);
        let mut least = [number(f64::INFINITY); 2];
        let mut places = [zero; 2];
        let mut spans = [[zero, out]; 2];
        for _ in 0..ROUNDS {
            for kind in 0..2 {
                let [from, to] = spans[kind];
                let width = (to - from) * number(1.0 / SAMPLES as f64);
                for j in 0..=SAMPLES {
                    let eta = width.mac(number(j as f64), from);
                    let y = eta * way;
                    let q = (y - (c + c)).fma(y, one);
                    let angle = angle_at(s, c, y, q);
                    let square = (horner(&force, y) / law.inertia(|| angle)).max(zero);
                    let w = [horner(&w1, y), square.sqrt(), horner(&w3, y)];
                    let [normal, along, across] = force_of(law, angle, w, rates.at(angle.0, angle.1, w));
                    let needed = along.mac(along, across * across).sqrt() / normal;
                    let grip = zero.select_lt(normal, zero - needed, number(f64::NEG_INFINITY));
                    let value = if kind == 0 { normal } else { grip };
                    places[kind] = value.select_lt(least[kind], eta, places[kind]);
                    least[kind] = value.min(least[kind]);
                }
                spans[kind] = [(places[kind] - width).max(zero), (places[kind] + width).min(out)];
            }
        }
        let y = out * way;
        let q = (y - (c + c)).fma(y, one);
        let (sin, cos) = normalized(angle_at(s, c, y, q));
        let knot = Knot {
            theta: knot.theta + change_of_theta(s, c, y),
            sin,
            cos,
            w1: horner(&w1, y),
            w3: horner(&w3, y),
            force: horner(&force, y).max(zero),
            doubt: knot.doubt,
        };
        let over = level.select_lt(edge, one, zero);
        Extent { normal: least[0], friction: zero - least[1], over, knot }
    }
}
