//! The map of steady states over inclination and aspect ratio: the codes of the regions, and the lines between them.

use crate::body::tube;
use crate::{Answer, Desk, Refusal, count};
use spincyl::{Contact, stability, steady};

/// The largest number of cells along an axis, which is more than a page shows.
const MOST: usize = 4096;

impl Desk {
    /// Writes the region codes of steady states at the middles of w x h cells. The aspect ratio varies along a row;
    /// the first row has the least inclination.
    pub fn map(&mut self, [w, h, low, high, from, to, bore, fillet]: [f64; 8]) -> Answer {
        let (w, h) = (count("w", w, MOST)?, count("h", h, MOST)?);
        // A NaN in the range fails this comparison, too.
        let ascend = from < to && from.is_finite() && to.is_finite();
        if !ascend {
            return Err(Refusal::Range { name: "theta", value: to, expected: "theta_lo < theta_hi" });
        }
        let cells = |low: f64, high: f64, n: usize| {
            (0..n).map(move |i| low + (high - low) * (i as f64 + 0.5) / n as f64)
        };
        let theta: Vec<f64> = cells(from, to, h).collect();
        let bodies: Vec<_> = cells(low, high, w).map(|half| tube(half, bore, fillet).ok()).collect();
        self.codes.resize(w * h, 0);
        stability::codes(&theta, &bodies, &mut self.codes);
        Ok(())
    }

    /// Writes a row for each of `n` aspect ratios: its value, theta0, thetaInf, the folds, the ridge, and the
    /// stability limits for rolling and on a smooth table.
    pub fn curves(&mut self, [n, low, high, bore, fillet]: [f64; 5]) -> Answer {
        let n = count("n", n, MOST)?;
        for i in 0..n {
            let half = low + (high - low) * i as f64 / (n - 1).max(1) as f64;
            self.out.push(half);
            let Ok(body) = tube(half, bore, fillet) else {
                self.out.extend([f64::NAN; 2 + 4 * steady::MOST]);
                continue;
            };
            self.out.extend([body.theta_balance(), body.theta_limit()]);
            self.out.extend(steady::folds(&body));
            self.out.extend(steady::ridge(&body));
            self.out.extend(stability::boundaries(&body, Contact::Rolling));
            self.out.extend(stability::boundaries(&body, Contact::Smooth));
        }
        Ok(())
    }
}
