// A rattleback: drawing, controls and text. Pages without friction omit this file. It comes before the
// controls and replaces some functions.

// number of stored rows and the seconds that they cover, and the initial rotation about both axes
const KEPT = 2401, SHOWN = 20, PUSH = 0.02 * deg;
const usual = TRACKS.slice();
let stone = null;

// a row: t, the six numbers of a pose and their rates, the spin, the upward components of axes 1 and 2, and N
const spun = row => row[13] / second(), leaning = (row, k) => Math.asin(row[14 + k]) / deg;
const lengthwise = () => stone.axes[0] < stone.axes[1] ? 1 : 0;
const ROCKS = [N("side to side"), N("end to end")]; // the slower mode first
const SPUN = [
  { name: "spin", word: N("spin"), unit: "", of: spun, colour: "omega", dash: [], both: true, least: 0.5, line: 0 },
  { name: "end", word: N("end"), unit: "°", of: row => leaning(row, lengthwise()), colour: "theta", dash: [], both: true, least: 0.05, line: 0 },
  { name: "side", word: N("side"), unit: "°", of: row => leaning(row, 1 - lengthwise()), colour: "normal", dash: [], both: true, least: 0.05, line: 0 },
];
Object.assign(MEANING, { spin: N("angular velocity about the vertical, rad/s"), end: N("rocking end to end"), side: N("rocking side to side") });

// half of the needle on its plane and of the stripe round the hull, as in `studio/stone_shape.py`
function stoneMark(colour, end) {
  const lift = 0.004, n = QUARTER + 9, normals = [[0, 0, 1], [0, 0, 1], [0, 0, 1]], places = [[0.88, 0, lift], [0, 0.34, lift], [0, -0.34, lift]], triangles = [0, 1, 2];
  for (const share of [0.84, 0.895, 0.95]) for (let i = 0; i < n; i++) {
    const up = (share - 1) * Math.PI / 2, a = Math.PI * (i / (n - 1) - 0.5), normal = [Math.cos(up) * Math.cos(a), Math.cos(up) * Math.sin(a), Math.sin(up)];
    normals.push(normal);
    places.push(normal.map(x => (1 + lift) * x));
  }
  for (let k = 0; k < 2; k++) for (let i = 0; i + 1 < n; i++) { const j = 3 + k * n + i; triangles.push(j, j + 1, j + n, j + 1, j + n + 1, j + n); }
  const turn = ([x, y, z]) => lengthwise() ? [-end * y, end * x, z] : [end * x, end * y, z], { axes, centre } = stone;
  return { colour, places: places.flatMap(p => turn(p).map((x, i) => x * axes[i] + centre[i])), normals: normals.flatMap(p => turn(p).map((x, i) => x / axes[i])), triangles };
}
const stoneLook = () => ({
  turned: [[SHADE, arc(0, 0, 1, -Math.PI / 2, 0, 2 * QUARTER)], [IVORY, [[1, 0], [0, 0]]]].map(([colour, corners]) => ({ colour, corners: { corners, ...stone, about: 2 } })),
  marks: [stoneMark(BLUE, 1), stoneMark(ORANGE, -1)],
});

const plainly = { begin, dress, windowed, look, rowAt, say, knobs, onBody, clocked, flick, pose };
begin = () => {
  document.documentElement.toggleAttribute("data-stone", !!s.stone);
  TRACKS.splice(0, 3, ...s.stone ? SPUN : usual);
  if (!s.stone) { if (live.axes) live.axes = drawnBody = null; plainly.begin(); return; }
  ghosts = [];
  head = null;
  const { code, out } = ask("rattleback", ...s.stone, s.twist, s.spin * second(), PUSH, SHOWN / second(), KEPT);
  body = code ? { code, why: refusal(code) } : { code, ell: 0, fillet: 0 };
  here = { code, precession: s.spin * second() };
  if (code) return;
  const [a, b, c, i, j, k, l, m, n, x, y, z] = out, axes = [a, b, c], offset = [x, y, z], found = [], back = [];
  stone = { axes, centre: offset.map(x => -x) };
  for (let at = 18; at < out.length; at += 17) found.push(out.slice(at, at + 17));
  // the rows end where the stone lifts off; a reversal counts at a tenth of the first spin
  const ends = found.findIndex(row => row[16] < 0), kept = ends < 0 ? found : found.slice(0, Math.max(2, ends));
  let zero = 0, side = found[0][13], was = side;
  for (const [i, row] of kept.entries()) {
    const is = row[13];
    if (was < 0 !== is < 0) zero = row[0] - (row[0] - kept[i - 1][0]) * is / (is - was);
    if (is * side < -0.1 * side * side) { back.push(zero); side = -side; }
    was = is;
  }
  Object.assign(live, { axes, offset, inertia: [[i, n, m], [n, j, l], [m, l, k]], ell: 0.1, fillet: 0 });
  live.times = kept.map(row => row[0]);
  head = { code, integrated: 1, ending: ends < 0 ? 0 : 3, ends: ends < 0 ? Infinity : kept.at(-1)[0], lasts: kept.at(-1)[0], error: out[17], growth: out.slice(13, 15), frequency: out.slice(15, 17), back, kept };
};
const interpolate = (m, t) => {
  const k = knot(t, m.times), [a, b] = head.kept.slice(k, k + 2), h = b[0] - a[0], x = Math.min(1, Math.max(0, (t - a[0]) / h)), y = 1 - x, six = [1, 2, 3, 4, 5, 6];
  return [
    six.map(i => y * y * (1 + 2 * x) * a[i] + x * x * (1 + 2 * y) * b[i] + x * y * h * (y * a[i + 6] - x * b[i + 6])),
    six.map(i => 6 * x * y * (b[i] - a[i]) / h + y * (1 - 3 * x) * a[i + 6] + x * (3 * x - 2) * b[i + 6]),
  ];
};
pose = (m, t) => m.axes ? { ...plainly.pose(m, t), normal: [0, 0, 0], friction: [0, 0, 0], usual: 1 } : plainly.pose(m, t);
dress = () => {
  if (!s.stone) { plainly.dress(); return; }
  const key = stone.axes.join();
  if (drawnBody === key) return;
  drawnBody = key;
  clothe(stoneLook());
};
windowed = () => rattles() ? head.lasts : plainly.windowed();
rowAt = t => rattles() ? null : plainly.rowAt(t);
look = (first, many) => {
  if (!rattles()) { plainly.look(first, many); return; }
  if (rows === head.kept) return;
  rows = head.kept;
  tracked = { rows, first: 0, last: head.lasts };
  Object.assign(live, { first: 0, last: head.lasts, wide: 0.006, far: false, runs: null });
  for (const v in fastest) fastest[v] = 1e-9;
  trace(live, live.times, live.times.map(t => pose(live, t)));
  ({ reach, half } = live);
};
onBody = e => !rattles() && plainly.onBody(e);
flick = hard => { if (!s.stone) plainly.flick(hard); };
const turning = x => (Number(Math.abs(x).toFixed(1)) === 0 ? "" : x < 0 ? "−" : "+") + Math.abs(x).toFixed(1);
clocked = row => {
  if (row) return plainly.clocked(row);
  const past = head.back.filter(t => t <= now).at(-1);
  return `t = ${timed(now, 1)}\n${W("spin {0} rad/s", turning(pose(live, now).omega[2] / second()))}${past === undefined ? "" : "\n" + W("turned back at {0}", timed(past, 1))}${live.over ? "\n" + W("it lifts off") : ""}`;
};

// ---- text
const senses = spin => spin < 0 ? W("clockwise") : W("counterclockwise");
function turnsBack() {
  const [slow, fast] = head.growth.map(x => x / second()), when = head.back[0], way = s.spin ? W("Spun {0}", senses(s.spin)) : W("Not spun");
  if (!(Math.max(slow, fast) > 1e-6)) return [W("Nothing turns back"), Math.abs(s.twist) < 1e-6 ? W("At a twist of 0 its axes of inertia are those of its shape. No rocking grows, whichever way it is spun.") : W("{0}, no rocking grows.", way)];
  const what = when === undefined ? W("It does not turn back in {0} s", SHOWN) : W("It turns back after {0} s", decimal(when * second(), 1));
  const name = fast > 0 ? 1 : 0, rate = decimal([slow, fast][name], Math.max(slow, fast) < 1 ? 2 : 1);
  return [what, name
    ? W("{0}, its rocking end to end grows at a rate of {1} per second. It takes up the energy of the spin, and then drives the stone the other way round.", way, rate)
    : W("{0}, only its rocking from side to side grows, at a rate of {1} per second. That from end to end dies away; spun the other way, it grows {2} times as fast.", way, rate, decimal(-fast / slow, 1))];
}
say = on => {
  if (!s.stone) { plainly.say(on); return; }
  const [what, why] = known() ? turnsBack() : [W("No answer"), body.why];
  $("what").textContent = what;
  $("because").textContent = why + (head?.ending ? " " + W("At {0} {1}.", timed(head.ends, 1), W("it lifts off")) : "");
  $("others").replaceChildren();
  const told = odd.length ? [W("not understood in the address: {0}", odd.join(", "))] : [];
  if (known()) {
    for (const i of [1, 0]) told.push(W("{0} {1} Hz, growth {2} per second", W(ROCKS[i]), decimal(head.frequency[i] / (TURN * second())), decimal(head.growth[i] / second())));
    told.push(W("half an ellipsoid, {0} mm long", decimal(2000 * Math.max(...s.stone), 0)), W("pushed by {0}° about both axes", decimal(PUSH / deg)));
    told.push(head.error < 0.1 ? W("error below {0}", head.error.toExponential(0)) : W("the last part is one of many possible motions"));
  }
  $("details").textContent = told.map(x => x.replaceAll(" ", "\u00a0").replaceAll("-", "−")).join(" · ");
  clearTimeout(say.later);
  say.later = setTimeout(() => { $("said").textContent = `${what}. ${why} ${W("twist {0}", degrees(s.twist))}. ${$("details").textContent}`; }, 700);
};

window.spincyl.stone = stoneLook; // for tests


// ---- the slider and the buttons
$("knobs").insertAdjacentHTML("afterend", `<form id="twirl" autocomplete="off"><label><span></span><input type="range" id="twist" min="-6" max="6" step="0.1"><output aria-live="off"></output></label>
<button type="button" id="clockwise"></button><button type="button" id="counterclockwise"></button></form>`);
worded($("twirl").querySelector("span"), N("twist of its mass against its shape"));
worded($("clockwise"), N("spin it ↻ clockwise"));
worded($("counterclockwise"), N("spin it ↺ counterclockwise"));
$("twirl").onsubmit = () => false;
$("twist").oninput = () => { held_ = true; change({ twist: $("twist").valueAsNumber * deg }); };
for (const [way, sign] of [["clockwise", -1], ["counterclockwise", 1]]) $(way).onclick = () => { change({ spin: sign * (Math.abs(s.spin) || 5) }, { restart: true }); play(true); };
knobs = () => {
  if (!s.stone) { plainly.knobs(); return; }
  const told = degrees(s.twist);
  $("twist").value = s.twist / deg;
  $("twist").setAttribute("aria-valuetext", told);
  document.querySelector("#twirl output").value = told;
  $("clockwise").ariaPressed = s.spin < 0;
  $("counterclockwise").ariaPressed = s.spin > 0;
};
