// Where a body is and how it turns, for any page.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const along = (...terms) => [0, 1, 2].map(k => terms.reduce((sum, [a, v]) => sum + a * v[k], 0));

// axes in the laboratory, the body's matrix, and how it turns, from angles, the place of the centre and angular velocity
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

// what is drawn of a pose as an arrow, its letter, and the largest there is
const ARROWS = ["omega", "momentum"], letters = { omega: "ω", momentum: "L" }, fastest = { omega: 1e-9, momentum: 1e-9 };
// more of what is said and looked at, where bodies slip
function doing() { return ""; }
function aim(m) { return m.middle; }

function knot(t, sorted) { // the interval that holds t
  let low = 0, high = sorted.length - 1;
  while (high - low > 1) { const mid = (low + high) >> 1; if (sorted[mid] <= t) low = mid; else high = mid; }
  return low;
}
