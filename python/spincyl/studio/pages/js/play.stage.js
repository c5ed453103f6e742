// The stage: the renderer of the recorded page draws a single motion, with poses from the core.

const stage = $("stage");

const live = { shape: 0, slope: 0, ell: 1, first: 0, last: 1, label: "", usual: 1 }, motions = [live], shapes = [[]];
live.before = live.after = { at: NaN, event: false };
let now = 0, playing = false;

// whether a rattleback is shown; the previous kind of body is, until a change has been solved
const rattles = () => !!head?.kept;

function placed(row) {
  const [, theta, w1, w2, w3, phi, psi, x, y] = row, [s, c] = [Math.sin(theta), Math.cos(theta)], [rim, ell, fillet] = body.circles?.[row[OF_ROW.turned]] || [1 - body.fillet, body.ell, body.fillet], out = rim * c - ell * s;
  const p = posed(live, theta, phi, psi, x + out * Math.cos(phi), y + out * Math.sin(phi), [w1, w2, w3]), lies = row[OF_ROW.kind] > FLIES, high = row[OF_ROW.height];
  p.centre[2] = p.matrix[14] = fillet + ell * c + rim * s + high;
  // refers to the rim that was the upper one: the body is turned about its first axis
  if (row[OF_ROW.turned] && !body.circles) for (const i of [4, 5, 6, 8, 9, 10]) p.matrix[i] *= -1;
  // for a body on both rims the sum of the forces is shown, in the middle
  const contact = lies ? [p.centre[0], p.centre[1], 0] : [x, y, 0];
  return Object.assign(p, { high, lies, stands: row[OF_ROW.kind] === ON_FACE, contact, normal: [0, 0, lies ? Math.cos(live.slope) : row[OF_ROW.normal] || 0], friction: [0, 0, 0], usual: 1 });
}
let latest = null;
const placeAt = t => rowAt(Math.min(Math.max(t, 0), head?.lasts ?? t)) || latest;
// adds the contact forces: N, and friction from second differences of the centre's position, on a slope without its pull
function pose(m, t) {
  const row = placeAt(t), p = placed(row), h = 2e-3;
  if (s.contact !== "smooth" && head.lasts > 2 * h) {
    const middle = Math.min(Math.max(h, t), head.lasts - h), near = [-h, 0, h].map(d => placeAt(middle + d)), [a, b, c] = near.map(row => placed(row).centre);
    // no force is shown in the air or for an impact
    if (near.every(row => row[OF_ROW.kind] !== FLIES)) p.friction = [0, 1].map(k => (a[k] - 2 * b[k] + c[k]) / h ** 2 - (k ? 0 : Math.sin(live.slope))).concat(0);
  }
  return p;
}

// makes the surface anew if the body has changed
let drawnBody = "";
function dress() {
  const b = { ...body, bore: isTube() ? s.bore : NaN, parts: body.circles ? turnedOf(body.circles) : s.parts }, key = [b.ell, b.bore, b.fillet, b.most, b.parts].join();
  if (key === drawnBody) return;
  drawnBody = key;
  const turned = clothe(lookOf(b));
  Object.assign(live, { i1: b.i1, i3: b.i3, fillet: b.fillet, depth: b.ell, ell: b.fillet || b.parts ? Math.sqrt(Math.max(0, farOf(turned) ** 2 - 1)) : b.ell });
}
function clothe({ turned, marks }) {
  const made = [
    ...surfaces(turned),
    ...marks.map(p => ({ ...mesh(p.places, p.normals, new Uint16Array(p.triangles)), colour: p.colour, mark: true })),
  ];
  for (const piece of shapes[0]) { piece.free(); piece.cast?.free(); }
  shapes[0] = made;
  return turned;
}

// centre of the view: the body, if it moves far
aim = (m, p) => live.far ? [...(p || pose(live, now)).centre.slice(0, 2), m.middle[2]] : m.middle;

// duration of the part of a motion that is shown at once: some nutations, some turns
function windowed() {
  const turns = 3 * TURN / Math.max(Math.abs(here.precession || head.phi / head.period || 0), 0.2);
  const nods = Number.isFinite(head.period) ? 4 * head.period : 0;
  return Math.min(head.lasts, Math.max(2, Math.min(60, Math.max(turns, nods))));
}
// above the table the view has room for the highest position of the body, and the lamp has more points, since the
// shadows from few points would separate
function raised(poses) {
  if (!poses.some(p => p.high)) return;
  const top = Math.max(...poses.map(p => p.centre[2] + body.ell * Math.abs(Math.cos(p.theta)) + Math.sin(p.theta))), many = 24;
  live.middle[2] = 0.45 * top;
  live.half = held(live.reach, top);
  for (let k = 0; k < many; k++) {
    const far = 0.15 * Math.sqrt((k + 0.5) / many);
    LAMPS[k] = Object.assign([...LAMPS[0]], { 8: 0.36 + far * Math.cos(2.4 * k), 9: 0.4 + far * Math.sin(2.4 * k) });
  }
}
const STATES = 300;
// rows for the tracks: an integrated motion is shown completely, since its rows are stored
let tracked = { rows: [], first: 0, last: 1 };
// the only row of a body at rest at the start; its centre is placed as in a motion
function standing() {
  const { w1, w2, w3 } = start, k = +(body.circles && s.theta > body.most), [rim, ell] = body.circles?.[k] || [1 - body.fillet, body.ell], out = ell * Math.sin(s.theta) - rim * Math.cos(s.theta);
  return [0, s.theta, w1, w2, w3, 0, 0, out, 0, NaN, NaN, 0, 0, 0, 0, 0, 0, k];
}
// loads rows from a time on, the path through them, and the extent that the camera must show
function look(first, many = STATES) {
  live.first = lasting() ? first : 0;
  live.last = lasting() ? Math.min(head.lasts, first + live.span) : 0;
  rows = lasting() ? rowsOf("follow", WIDE, many, first, live.last) : body.code ? [] : [standing()];
  tracked = lasting() && head.integrated ? { rows: rowsOf("follow", WIDE, ROWS, 0, head.lasts < s.until ? s.until : head.lasts), first: 0, last: head.lasts } : { rows, first: live.first, last: live.last };
  if (!rows.length) return;
  latest = rows[0];
  for (const v in fastest) fastest[v] = 1e-9;
  const poses = rows.map(row => placed(row));
  live.wide = 0.012 * Math.hypot(1, live.ell);
  // the paths of the two rims are not connected, and in the air there is none
  live.runs = () => {
    const runs = [];
    rows.forEach((row, i) => {
      const [kind, rim] = [row[OF_ROW.kind], 2 * row[OF_ROW.turned] + (row[OF_ROW.kind] > FLIES)], colour = rubbed(kind) ? "friction" : "trace", last = runs.at(-1);
      if (last && last[1] === colour && last[3] === rim && last[4] === (kind === FLIES)) return;
      if (last) last[2] = i - (last[3] !== rim || last[4] || kind === FLIES);
      runs.push([i, colour, rows.length, rim, kind === FLIES]);
    });
    return { forEach: f => runs.forEach(([from, colour, to, , flies]) => flies || f([from, colour], 0, [0, [to]])) };
  };
  trace(live, rows.map(row => row[0]), poses);
  raised(poses);
  const alone = Math.hypot(1, live.ell);
  live.far = live.reach > 2.2 * alone; // the camera follows a body that moves far
  reach = live.far ? 1.6 * alone : live.reach;
  half = live.far ? held(1.6 * alone, live.middle[2] / 0.45) : live.half;
}
