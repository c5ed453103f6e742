//! The call for a rattleback: its dimensions, its modes of rocking, and its rolling motion.

use crate::motion::{MOST, times};
use crate::{Answer, Desk, Refusal, count};
use spincyl::{Ellipsoid, stone};

/// The tolerance of a step of the integrator, which is enough for a page.
const TOL: f64 = 1e-12;
/// The computation of a motion stops after this many times 256 steps, which take too long for a page.
const LOOKS: u32 = 100;

impl Desk {
    /// Rolls the lower half of a uniform ellipsoid with these semi-axes, whose principal axes are turned by `twist`,
    /// until the time `t`. It starts with `spin`, and leans by the angle `push` about axes 1 and 2. Writes the
    /// dimensions of the stone in its natural units, the growth and the frequency of both modes of rocking, the
    /// slower one first, and the error of the motion; and then rows at equally spaced times: t; x, y, z of the
    /// quaternion, the place of the centre of mass, and w of the quaternion; their rates; the spin; the upward
    /// components of axes 1 and 2; and the normal force.
    pub fn rattleback(&mut self, [a, b, c, twist, spin, push, t, n]: [f64; 8]) -> Answer {
        let n = count("n", n, MOST)?;
        for (name, value, most) in [("push", push, 1.5), ("t", t, 1e12)] {
            let known = value >= 0.0 && value <= most;
            if !known {
                return Err(Refusal::Range {
                    name,
                    value,
                    expected: "0 <= push <= 1.5 (radians), 0 <= t <= 1e12",
                });
            }
        }
        let stone = Ellipsoid::rattleback([a, b, c], None, twist, None)?;
        let rocking = stone.rocking(spin)?;
        let (wanted, mut looks) = (times(0.0, t, n).collect::<Vec<_>>(), 0);
        let go_on = || {
            looks += 1;
            looks <= LOOKS
        };
        let start = stone.spinning(spin, push, push);
        let (rows, error) = stone::rolling(&stone, start, &wanted, TOL, go_on)?.ok_or(Refusal::Work)?;
        self.out.extend_from_slice(&stone.numbers());
        self.out.extend_from_slice(&rocking.growth);
        self.out.extend_from_slice(&rocking.frequency);
        self.out.push(error);
        for row in rows {
            self.out.push(row.time);
            let ([w, x, y, z], [left, ahead]) = (row.orientation, row.centre);
            self.out.extend_from_slice(&[x, y, z, left, ahead, w]);
            let ([w, x, y, z], [left, ahead]) = (row.orientation_rate, row.centre_velocity);
            self.out.extend_from_slice(&[x, y, z, left, ahead, w]);
            let [n1, n2, _] = row.state.vertical;
            self.out.extend_from_slice(&[row.state.spin(), n1, n2, row.normal]);
        }
        Ok(())
    }
}
