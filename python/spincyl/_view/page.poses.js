// Poses. What the page knows of a motion are poses at knots, and how to interpolate between these.
// The page's files are joined in this order, in one strict function: poses, draw, exposure, hands.

const $ = id => document.getElementById(id);
const data = JSON.parse($("data").textContent);
const canvas = $("canvas"), stage = $("stage");
const gl = canvas.getContext("webgl2", { antialias: true, stencil: true, alpha: false });
if (!gl) { $("missing").hidden = false; $("controls").hidden = true; return; }

const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer;
const motions = data.motions.map(m => {
  const whole = new Uint32Array(bytes(m.knots)), off = new Int16Array(bytes(m.slopes)), n = whole.length / 6;
  const read = (i, k) => m.low[k] + (m.high[k] - m.low[k]) * (whole[6 * i + k] / 0xffffffff);
  const t = Array.from({ length: n }, (_, i) => read(i, 0)), y = [], slopes = [];
  for (let i = 0; i < n; i++) {
    const before = i ? t[i] - t[i - 1] : t[1] - t[0], after = i < n - 1 ? t[i + 1] - t[i] : before;
    for (let k = 1; k < 6; k++) { // a parabola's slope, and what it is off by
      const secant = j => (read(j + 1, k) - read(j, k)) / (t[j + 1] - t[j]);
      const rising = secant(Math.max(0, i - 1)), falling = secant(Math.min(n - 2, i));
      y.push(read(i, k));
      slopes.push((rising * after + falling * before) / (before + after) + off[5 * i + k - 1] / 32767 * m.most[k - 1] / Math.max(before, after));
    }
  }
  return { ...m, t, y, slopes };
});
const first = Math.min(...motions.map(m => m.first)), last = Math.max(...motions.map(m => m.last));

const digits = Math.max(2, 4 - Math.floor(Math.log10(Math.max(1e-9, (last - first) * data.unit))));
const clock = t => `t = ${(t * data.unit).toFixed(digits)} ${data.symbol}`.replaceAll(" ", "\u00a0"); // never broken over two lines

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

// theta, phi, psi, x, y and their rates: the cubic between two knots
function interpolate(m, t) {
  t = Math.min(Math.max(t, m.first), m.last);
  const rounds = m.again ? Math.floor((t - m.first) / m.again.period) : 0;
  if (rounds) t -= rounds * m.again.period;
  const i = knot(t, m.t), h = m.t[i + 1] - m.t[i], s = (t - m.t[i]) / h, value = [], rate = [];
  for (let k = 0; k < 5; k++) {
    const j = 5 * i + k, y0 = m.y[j], y1 = m.y[j + 5], d0 = h * m.slopes[j], d1 = h * m.slopes[j + 5];
    const b = 3 * (y1 - y0) - 2 * d0 - d1, c = 2 * (y0 - y1) + d0 + d1;
    value.push(y0 + s * (d0 + s * (b + s * c)));
    rate.push((d0 + s * (2 * b + s * 3 * c)) / h);
  }
  if (rounds) { // each period is the last one, turned about the vertical and about the axis
    const { phi, psi, pivot, shift } = m.again, [c, s] = [Math.cos(rounds * phi), Math.sin(rounds * phi)];
    value[1] += rounds * phi;
    value[2] += rounds * psi;
    const [x, y] = pivot ? [value[3] - pivot[0], value[4] - pivot[1]] : value.slice(3);
    value[3] = pivot ? pivot[0] + c * x - s * y : x + rounds * shift[0];
    value[4] = pivot ? pivot[1] + s * x + c * y : y + rounds * shift[1];
  }
  return [value, rate];
}

const along = (...terms) => [0, 1, 2].map(k => terms.reduce((sum, [a, v]) => sum + a * v[k], 0));

// axes in the laboratory, the body's matrix, and how the drawn pose turns
function pose(m, t) {
  const [[theta, phi, psi, x, y], [tilting, turning, spinning]] = interpolate(m, t);
  const [s, c, sp, cp] = [Math.sin(theta), Math.cos(theta), Math.sin(phi), Math.cos(phi)];
  const e1 = [c * cp, c * sp, s], e2 = [-sp, cp, 0], e3 = [-s * cp, -s * sp, c];
  const b1 = along([Math.cos(psi), e1], [Math.sin(psi), e2]), b2 = along([-Math.sin(psi), e1], [Math.cos(psi), e2]);
  const rim = along([-1, e1], [-m.ell, e3]), centre = [x, y, -rim[2]]; // the rim touches the table
  const w = [turning * s, -tilting, turning * c + spinning];
  return {
    theta, phi, centre, contact: along([1, centre], [1, rim]),
    matrix: [...b1, 0, ...b2, 0, ...e3, 0, ...centre, 1],
    omega: along([w[0], e1], [w[1], e2], [w[2], e3]),
    momentum: along([m.i1 * w[0], e1], [m.i1 * w[1], e2], [m.i3 * w[2], e3]),
  };
}
