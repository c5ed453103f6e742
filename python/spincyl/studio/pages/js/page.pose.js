// Pose and angular velocity of a body, for both pages.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const along = (...terms) => [0, 1, 2].map(k => terms.reduce((sum, [a, v]) => sum + a * v[k], 0));

// pose, matrix, angular velocity and momentum in the laboratory from angles, x and y of the centre, and w
// along e1, e2, e3
function posed(m, theta, phi, psi, x, y, w) {
  const [s, c, sp, cp] = [Math.sin(theta), Math.cos(theta), Math.sin(phi), Math.cos(phi)];
  const e1 = [c * cp, c * sp, s], e2 = [-sp, cp, 0], e3 = [-s * cp, -s * sp, c];
  const b1 = along([Math.cos(psi), e1], [Math.sin(psi), e2]), b2 = along([-Math.sin(psi), e1], [Math.cos(psi), e2]);
  const rim = along([-1, e1], [-m.ell, e3]), centre = [x, y, -rim[2]]; // the rim touches the table
  return {
    theta, phi, centre, contact: along([1, centre], [1, rim]),
    matrix: [...b1, 0, ...b2, 0, ...e3, 0, ...centre, 1],
    omega: along([w[0], e1], [w[1], e2], [w[2], e3]),
    momentum: along([m.i1 * w[0], e1], [m.i1 * w[1], e2], [m.i3 * w[2], e3]),
  };
}

// vectors that have arrows, their letters, and the largest size of each
const ARROWS = ["omega", "momentum"], letters = { omega: "ω", momentum: "L" }, fastest = { omega: 1e-9, momentum: 1e-9 };
// replaced where bodies slip: further text of the clock, and the centre of the view
function doing() { return ""; }
function aim(m) { return m.middle; }

function knot(t, sorted) { // index of the interval that contains t
  let low = 0, high = sorted.length - 1;
  while (high - low > 1) { const mid = (low + high) >> 1; if (sorted[mid] <= t) low = mid; else high = mid; }
  return low;
}
