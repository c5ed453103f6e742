// The stage: the renderer of the recorded page draws a single motion, with poses from the core.

const stage = $("stage");

const live = { shape: 0, ell: 1, first: 0, last: 1, label: "", usual: 1 }, motions = [live], shapes = [[]];
live.before = live.after = { at: NaN, event: false };
let now = 0, playing = false;

function placed(row) {
  const [, theta, w1, w2, w3, phi, psi, x, y] = row, out = (1 - body.fillet) * Math.cos(theta) - body.ell * Math.sin(theta);
  const p = posed(live, theta, phi, psi, x + out * Math.cos(phi), y + out * Math.sin(phi), [w1, w2, w3]);
  return Object.assign(p, { normal: [0, 0, row[OF_ROW.normal] || 0], friction: [0, 0, 0], usual: 1 });
}
let latest = null;
const placeAt = t => rowAt(Math.min(Math.max(t, 0), head?.lasts ?? t)) || latest;
// adds the contact forces: N, and friction from second differences of the centre's position
function pose(m, t) {
  const row = placeAt(t), p = placed(row), h = 2e-3;
  if (s.contact !== "smooth" && head.lasts > 2 * h) {
    const middle = Math.min(Math.max(h, t), head.lasts - h), [a, b, c] = [-h, 0, h].map(d => placed(placeAt(middle + d)).centre);
    p.friction = [0, 1].map(k => (a[k] - 2 * b[k] + c[k]) / h ** 2).concat(0);
  }
  return p;
}

// makes the surface anew if the body has changed
let drawnBody = "";
function dress() {
  const b = { ...body, bore: isTube() ? s.bore : NaN }, key = [b.ell, b.bore, b.fillet, b.most].join();
  if (key === drawnBody) return;
  drawnBody = key;
  const turned = clothe(lookOf(b));
  Object.assign(live, { i1: b.i1, i3: b.i3, fillet: b.fillet, depth: b.ell, ell: b.fillet ? Math.sqrt(Math.max(0, farOf(turned) ** 2 - 1)) : b.ell });
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
const STATES = 300;
// rows for the tracks: an integrated motion is shown completely, since its rows are stored
let tracked = { rows: [], first: 0, last: 1 };
// the only row of a body at rest at the start; its centre is placed as in a motion
function standing() {
  const { w1, w2, w3 } = start, out = body.ell * Math.sin(s.theta) - (1 - body.fillet) * Math.cos(s.theta);
  return [0, s.theta, w1, w2, w3, 0, 0, out, 0, NaN, NaN, 0, 0, 0, 0, 0];
}
// loads rows from a time on, the path through them, and the extent that the camera must show
function look(first, many = STATES) {
  live.first = lasting() ? first : 0;
  live.last = lasting() ? Math.min(head.lasts, first + live.span) : 0;
  rows = lasting() ? rowsOf("follow", 16, many, first, live.last) : body.code ? [] : [standing()];
  tracked = lasting() && head.integrated ? { rows: rowsOf("follow", 16, ROWS, 0, head.lasts < s.until ? s.until : head.lasts), first: 0, last: head.lasts } : { rows, first: live.first, last: live.last };
  if (!rows.length) return;
  latest = rows[0];
  for (const v of ["omega", "momentum"]) fastest[v] = 1e-9;
  const poses = rows.map(row => placed(row));
  if (live.fillet) poses.forEach((p, i) => { p.contact = [rows[i][7], rows[i][8], 0]; p.centre[2] = live.fillet + live.depth * Math.cos(p.theta) + (1 - live.fillet) * Math.sin(p.theta); });
  live.wide = 0.012 * Math.hypot(1, live.ell);
  live.runs = () => rows.reduce((runs, row, i) => { const colour = row[14] ? "friction" : "trace"; if (runs.at(-1)?.[1] !== colour) runs.push([i, colour]); return runs; }, []);
  trace(live, rows.map(row => row[0]), poses);
  const alone = Math.hypot(1, live.ell);
  live.far = live.reach > 2.2 * alone; // the camera follows a body that moves far
  reach = live.far ? 1.6 * alone : live.reach;
  half = live.far ? held(1.6 * alone, live.middle[2] / 0.45) : live.half;
}
