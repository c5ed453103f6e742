// What is heard of the live motion: the contact point runs along the body, and the body lands.

let struck = { of: null, hits: [], loudest: [0, 0] };
const heardAt = t => {
  const row = rattles() || t > head.lasts ? null : rowAt(t), kind = row?.[OF_ROW.kind];
  if (!row || kind === FLIES || kind === ON_FACE) return [[0, 0]];
  const p = placed(row), slides = Math.abs(row[4] - row[2] / Math.tan(row[1])) * (1 - body.fillet + body.fillet * Math.sin(row[1]));
  return [[Math.atan2(p.contact[1] - p.centre[1], p.contact[0] - p.centre[0]), slides]];
};
// the velocity of the centre between two moments
const flown = (a, b) => [placeAt(a), placeAt(b)].map(row => placed(row).centre).reduce((x, y) => along([1 / (b - a), y], [-1 / (b - a), x]));
// landings: an impulse is the change of the velocity of the centre
function landings() {
  if (!rubs || !head.impacts) return [];
  const { out } = ask("phases"), found = [];
  for (let i = 2; i < out.length && found.length < 400; i += 2) {
    const t = out[i], h = Math.min(1e-3, (t - out[i - 2]) / 3, ((out[i + 2] ?? head.lasts) - t) / 3);
    if (out[i - 1] === FLIES && h > 1e-9) found.push([t, Math.hypot(...along([1, flown(t + h, t + 2 * h)], [-1, flown(t - 2 * h, t - h)]))]);
  }
  return found;
}
function listened() {
  if (struck.of === head) return struck;
  const hits = lasting() && !rattles() ? landings() : [], speeds = rattles() ? [0] : tracked.rows.map(row => heardAt(row[0])[0][1]);
  return struck = { of: head, hits, loudest: [Math.max(0, ...speeds), Math.max(0, ...hits.map(([, size]) => size))] };
}
const hits = () => listened().hits, loudest = () => listened().loudest;
// in each frame, while a motion is shown
const heard = () => sounded(now, real() / s.slow, playing && lasting() && now < head.lasts);
