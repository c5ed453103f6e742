//! The slow slips of a stone, as power series of all components of its state vector.

use crate::laws::stone::law::{StoneLaw, across, laboratory, turning};
use crate::motions::walk::numbers::{TIME, loses};
use crate::motions::walk::slow::{SlowRates, SlowSlips};
use crate::motions::walk::{SlowLaw, SlowSeries};
use crate::numbers::Series;
use crate::numbers::vector::dot;

/// The power series of a stone's slow slips: of its state, the heat, the contact point (x, y), and the energy lost.
pub(super) struct StoneSlips {
    slips: SlowSlips<7>,
}

impl StoneSlips {
    pub fn of(law: &StoneLaw<f64>, tol: f64) -> Self {
        let slips = SlowSlips::of(tol, |tape, [a, b, c, d, e, f, g], slip, way| {
            let law = law.map(|x| tape.number(x));
            let (q, w) = ([a, b, c, d], [e, f, g]);
            let lab = laboratory(q);
            let at = law.losing(law.meeting(&lab, w), &lab, w);
            let to = law.pulled(&at, w, across(&lab, way));
            let rate = law.slip_rate(&at, w, &to);
            let heat = -(slip[0] * dot(lab[0], to.force) + slip[1] * dot(lab[1], to.force));
            let [x, y] = [0, 1].map(|i| slip[i] + dot(lab[i], at.r_rate));
            let ([a, b, c, d], [e, f, g]) = (turning(q, w), to.w);
            let slip = [dot(lab[0], rate), dot(lab[1], rate)];
            let mut more = vec![heat, x, y];
            more.extend(at.lost.map(|lost| -dot(lost.under(dot(to.force, at.n)), w)));
            SlowRates { numbers: [a, b, c, d, e, f, g], slip, more }
        });
        Self { slips }
    }
}

impl<const N: usize> SlowLaw<N> for StoneSlips {
    #[inline(never)]
    fn follow(&mut self, y: &[f64; N], angle: Series, growth: f64, speed: f64) -> Option<Box<SlowSeries<N>>> {
        let start = core::array::from_fn(|i| y[i]);
        let slow = self.slips.follow(start, (angle, growth), speed)?;
        let mut numbers = [Series::of(1.0).integral(y[TIME]); N];
        numbers[..7].copy_from_slice(&slow.known);
        numbers[8..10].copy_from_slice(&slow.slip);
        (0..3).for_each(|i| numbers[10 + i] = self.slips.more(i).integral(y[10 + i]));
        if loses(N) {
            numbers[N - 1] = self.slips.more(3).integral(y[N - 1]);
        }
        let (until, ends) = slow.until(&numbers[..11]);
        Some(Box::new(SlowSeries {
            numbers,
            from: y[TIME],
            until,
            ends,
            pays: slow.pays(until, ends),
            settling: slow.settling,
            angle: slow.angle,
        }))
    }
}
