// Poses, interpolated between the knots that the page stores for each motion. The files are joined in the
// order of view.py, in one strict function.

const $ = id => document.getElementById(id);
const data = JSON.parse($("data").textContent);
const stage = $("stage");
// the words of this page are English; the live page replaces these by others
const N = word => word, W = (word, ...given) => word.replace(/\{(\d)\}/g, (_, i) => given[i]);

const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer;
const motions = data.motions.map(m => {
  const { low, high, most } = m, wide = low.length, whole = new Uint32Array(bytes(m.knots)), off = new Int16Array(bytes(m.slopes)), n = whole.length / wide;
  const read = (i, k) => low[k] + (high[k] - low[k]) * (whole[wide * i + k] / 0xffffffff);
  const t = Array.from({ length: n }, (_, i) => read(i, 0));
  const y = t.map((_, i) => most.map((_, k) => read(i, k + 1)));
  const slopes = t.map((_, i) => {
    const before = i ? t[i] - t[i - 1] : t[1] - t[0], after = i < n - 1 ? t[i + 1] - t[i] : before;
    return most.map((most, k) => { // slope of a parabola, plus the stored difference
      const secant = j => (y[j + 1][k] - y[j][k]) / (t[j + 1] - t[j]);
      return (secant(Math.max(0, i - 1)) * after + secant(Math.min(n - 2, i)) * before) / (before + after) + off[(wide - 1) * i + k] / 32767 * most / Math.max(before, after);
    });
  });
  return { ...m, t, y, slopes };
});
const first = Math.min(...motions.map(m => m.first)), last = Math.max(...motions.map(m => m.last));

const digits = Math.max(2, 4 - Math.floor(Math.log10(Math.max(1e-9, (last - first) * data.unit))));
// milliseconds, if the page shows less than a second; with spaces that do not break
const brief = data.symbol === "s" && (last - first) * data.unit < 1;
const clock = t => `t = ${brief ? (1e3 * t * data.unit).toFixed(digits - 3) + " ms" : (t * data.unit).toFixed(digits) + " " + data.symbol}`.replaceAll(" ", "\u00a0");
// three digits, without an exponent
const rounded = x => Math.abs(x) < 999.5 ? x.toPrecision(3) : x.toFixed(0);

// theta, phi, psi, x, y, or the numbers of a stone, and their rates: the cubic between two knots
function interpolate(m, t) {
  t = Math.min(Math.max(t, m.first), m.last);
  const rounds = m.again ? Math.floor((t - m.first) / m.again.period) : 0;
  if (rounds) t -= rounds * m.again.period;
  const i = knot(t, m.t), h = m.t[i + 1] - m.t[i], s = (t - m.t[i]) / h, value = [], rate = [];
  m.y[i].forEach((y0, k) => {
    const y1 = m.y[i + 1][k], d0 = h * m.slopes[i][k], d1 = h * m.slopes[i + 1][k];
    const b = 3 * (y1 - y0) - 2 * d0 - d1, c = 2 * (y0 - y1) + d0 + d1;
    value.push(y0 + s * (d0 + s * (b + s * c)));
    rate.push((d0 + s * (2 * b + s * 3 * c)) / h);
  });
  if (rounds) { // each period is the previous one, rotated about the vertical and about the axis
    const { phi, psi, pivot, shift } = m.again, [c, s] = [Math.cos(rounds * phi), Math.sin(rounds * phi)];
    value[1] += rounds * phi;
    value[2] += rounds * psi;
    const [x, y] = pivot ? [value[3] - pivot[0], value[4] - pivot[1]] : value.slice(3);
    value[3] = pivot ? pivot[0] + c * x - s * y : x + rounds * shift[0];
    value[4] = pivot ? pivot[1] + s * x + c * y : y + rounds * shift[1];
  }
  return [value, rate];
}

// the drawn pose, with its angular velocity
function pose(m, t) {
  const [[theta, phi, psi, x, y], [tilting, turning, spinning]] = interpolate(m, t);
  return posed(m, theta, phi, psi, x, y, [turning * Math.sin(theta), -tilting, turning * Math.cos(theta) + spinning]);
}
