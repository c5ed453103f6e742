// Controls: sliders, the point on the map, the body, time, keys, presets and the address.

// name of a number, label, least, greatest, conversions from the slider to the number and back, text of the
// number
const same = { to: x => x, from: x => x }, square = { to: x => x ** 2, from: Math.sqrt }, power = { to: x => 10 ** x, from: Math.log10 };
const KNOBS = [
  { name: "ell", text: N("aspect ratio ℓ"), low: 0, high: () => Math.sqrt(8), ...square, told: x => decimal(x, 3) },
  { name: "theta", text: N("inclination θ"), low: 0.005, high: () => steep(), ...same, told: x => degrees(x, 2) },
  { name: "rate", text: N("rate Ω√I₃"), low: 0, high: () => 4, ...same, told: x => rated(x) },
  { name: "bore", text: N("bore"), low: 0, high: () => 1, ...same, told: x => decimal(x) },
  { name: "fillet", text: N("fillet"), low: 0, high: () => isTube() ? Math.min(1 - s.bore, s.ell) : 1, ...same, told: x => decimal(x) },
  ...Object.entries({ bottom: N("bottom"), top: N("top"), height: N("height") }).map(([name, text]) => ({ name, text, low: name === "height" ? 0.05 : 0, high: () => name === "height" ? 6 : 1, ...same, told: x => decimal(x) })),
  { name: "kick", text: N("kick θ′"), low: -0.6, high: () => 0.6, ...same, told: x => decimal(x, 3) },
  { name: "precession", text: N("centre’s circle"), low: -1, high: () => 1, ...same, told: () => Number.isFinite(s.precession) ? decimal(here.circle) + " R" : W("at rest") },
  { name: "contact", text: N("table"), choices: { rolling: N("rubber: it rolls"), smooth: N("ice: no friction"), coulomb: N("dry friction μ"), viscous: N("wet: friction c u") } },
  { name: "slope", text: N("slope"), low: 0, high: () => Math.PI / 4, ...same, told: x => x ? degrees(x) : W("level") },
  { name: "phi0", text: N("leans to φ"), low: -Math.PI, high: () => Math.PI, ...same, told: x => degrees(x, 0) },
  { name: "mu", text: N("friction μ"), low: 0, high: () => 1, ...same, told: x => decimal(x) },
  { name: "patch", text: N("patch"), low: -4.2, high: () => Math.log10(0.5), to: x => x < -4 ? 0 : 10 ** x, from: x => x > 0 ? Math.log10(x) : -4.2, told: x => x > 0 ? sized() ? decimal(1e3 * s.radius * x, 3) + " mm" : decimal(x, 4) + " R" : W("a point") },
  { name: "c", text: N("friction c"), low: 0, high: () => 1, ...same, told: x => decimal(x) },
  { name: "restitution", text: N("bounce e"), low: -0.05, high: () => 1, to: x => x < 0 ? NaN : x, from: x => x >= 0 ? x : -0.05, told: x => x >= 0 ? decimal(x) : W("it ends there") },
  { name: "law", text: N("losses"), choices: LAWS },
  { name: "loss", text: N("their coefficient"), low: -7, high: () => -0.5, ...power, told: x => x.toExponential(1) },
];
if (!rubs) {
  for (const law of ["coulomb", "viscous"]) delete KNOBS.find(knob => knob.name === "contact").choices[law];
  KNOBS.splice(KNOBS.findIndex(knob => knob.name === "slope"), 8); // also removes friction, the bounce and the losses, which follow
  $("flick").hidden = true;
}
const form = $("knobs");
for (const knob of KNOBS) {
  const label = form.appendChild(document.createElement("label"));
  label.append(worded(document.createElement("span"), knob.text));
  knob.label = label;
  if (knob.choices) {
    knob.input = label.appendChild(document.createElement("select"));
    for (const [value, text] of Object.entries(knob.choices)) knob.input.add(worded(new Option("", value), text));
    knob.input.onchange = () => change({ [knob.name]: knob.input.value }, { restart: true });
  } else {
    knob.input = label.appendChild(Object.assign(document.createElement("input"), { type: "range", step: "any", min: knob.low }));
    knob.output = label.appendChild(document.createElement("output"));
    knob.output.ariaLive = "off"; // the slider announces its value itself
    knob.input.oninput = () => turned(knob, knob.to(knob.input.valueAsNumber));
  }
  knob.input.id = "knob-" + knob.name;
}
// applies the value of a knob; for the centre's circle it is the relative change of the precession from its
// value with the centre at rest
function turned(knob, value) {
  held_ = true;
  if (knob.name === "rate") {
    const { code, out } = ask("by_rate", value);
    if (!code && out.length) change({ theta: out.reduce((a, b) => Math.abs(b - s.theta) < Math.abs(a - s.theta) ? b : a), precession: NaN });
    else knobs();
  } else if (knob.name === "precession") {
    const { code, out } = ask("at_rest", s.theta), still = code ? 1 : out[8];
    change({ precession: Math.abs(value) < 0.02 ? NaN : still * (1 + value) });
  } else change({ [knob.name]: value });
}
// sets the sliders to the present state
function knobs() {
  const rest = Number.isFinite(s.precession) && ask("at_rest", s.theta), still = rest && !rest.code ? rest.out[8] : 1;
  for (const knob of KNOBS) {
    const value = knob.name === "rate" ? here.rate : knob.name === "precession" ? (Number.isFinite(s.precession) ? s.precession / still - 1 : 0) : s[knob.name];
    const off = knob.name === "mu" ? s.contact !== "coulomb" : knob.name === "c" ? s.contact !== "viscous" : knob.name === "loss" ? s.law === "none" : ["ell", "bore", "fillet"].includes(knob.name) && !isTube() || knob.name === "rate" && (s.w || !(here.rate > 0));
    // shows only the coefficient of the present law of friction
    if (["mu", "c"].includes(knob.name)) knob.label.hidden = (s.contact === "viscous") !== (knob.name === "c");
    // a frustum has numbers of its own
    if (["ell", "bore", "fillet", "rate"].includes(knob.name)) knob.label.hidden = isFrustum();
    if (["bottom", "top", "height"].includes(knob.name)) knob.label.hidden = !isFrustum();
    // a patch belongs to dry friction, and excludes a restitution
    if (knob.name === "patch") knob.label.hidden = s.contact !== "coulomb" || Number.isFinite(s.restitution);
    // on a level table every direction is the same
    if (knob.name === "phi0") knob.label.hidden = !s.slope;
    // bounces need a rim and friction
    if (knob.name === "restitution") knob.label.hidden = !rubbing() || s.contact === "coulomb" && s.patch > 0 || !body.circles && body.most !== (body.ell > 0 && body.fillet < 1 ? Math.PI / 2 : Math.PI);
    knob.label.classList.toggle("off", off);
    knob.input.disabled = off && knob.name !== "rate";
    if (knob.choices) { knob.input.value = value; continue; }
    knob.input.max = knob.high();
    knob.input.value = knob.from(value ?? 0);
    const text = off && knob.name !== "ell" ? "–" : knob.told(value);
    if (knob.output.value !== text) knob.output.value = text;
    knob.input.setAttribute("aria-valuetext", text);
  }
  map.ariaValueText = W("aspect ratio {0}, inclination {1}", decimal(s.ell), degrees(s.theta));
}

// ---- the map
function pointed(e) {
  const b = map.getBoundingClientRect(), x = (e.clientX - b.left) / b.width, y = (e.clientY - b.top) / b.height;
  return { ell: isTube() ? Math.max(0.01, widest() * x) : s.ell, theta: Math.max(0.005, steep() * (1 - y)), pixel: steep() / b.height, wide: b.width };
}
function drag(e) {
  const { ell, theta, pixel } = pointed(e), snap = e.altKey ? { theta, on: "" } : snapped(ell, theta, 7 * pixel);
  held_ = true;
  change(isTube() ? { ell, theta: snap.theta, precession: NaN } : { theta, precession: NaN }, { on: snap.on });
}
map.onpointerdown = e => {
  const { theta, pixel, ell, wide } = pointed(e), off = x => Math.abs(x - theta), ghost = Math.abs(across(ell) - across(s.ell)) * wide < 22 && ghosts.filter(x => off(x) < 22 * pixel).sort((a, b) => off(a) - off(b))[0];
  if (ghost && Math.abs(theta - ghost) < Math.abs(theta - s.theta)) { change({ theta: ghost }); return; }
  map.setPointerCapture(e.pointerId);
  drag(e);
};
map.onpointermove = e => { if (map.hasPointerCapture(e.pointerId)) drag(e); };

// ---- the body: dragging the body tilts it, dragging the table turns the view
const turnsView = { down: canvas.onpointerdown, move: canvas.onpointermove, up: canvas.onpointerup };
let tilting = null;
function onBody(e) {
  if (!rows.length || without || $("shutter").value !== "0") return false;
  const b = canvas.getBoundingClientRect(), p = pose(live, now), axis = p.matrix.slice(8, 11), long = kindOf({ ...body, bore: isTube() ? s.bore : NaN }) === "cylinder" ? Math.max(0.3, live.ell) : 1;
  const at = [-0.8, -0.4, 0, 0.4, 0.8].map(k => project(live, along([1, p.centre], [k * long, axis]), b.width, b.height));
  const [low, high] = [-1, 1].map(k => project(live, along([1, p.centre], [k, [0, 0, 1]]), b.width, b.height)), size = Math.abs(high[1] - low[1]) / 2;
  return at.some(([x, y]) => Math.hypot(e.clientX - b.left - x, e.clientY - b.top - y) < Math.max(22, 0.7 * size));
}
canvas.onpointerdown = e => {
  turnsView.down(e);
  if (fingers.size === 1 && onBody(e)) tilting = { y: e.clientY, theta: s.theta, playing };
  else tilting = null;
  if (tilting) playing = false;
};
canvas.onpointermove = e => {
  if (!fingers.size) canvas.classList.toggle("body", onBody(e));
  if (!tilting || fingers.size > 1) { turnsView.move(e); return; }
  held_ = true;
  change({ theta: Math.min(steep(), tilting.theta + (e.clientY - tilting.y) * steep() / canvas.clientHeight), precession: NaN });
};
canvas.onpointerup = canvas.onpointercancel = e => { turnsView.up(e); if (tilting) { const { playing: was } = tilting; tilting = null; if (was) play(true); } };

// ---- time
charted.onpointerdown = e => { charted.setPointerCapture(e.pointerId); play(false); scrub(e); };
charted.onpointermove = e => { if (charted.hasPointerCapture(e.pointerId)) scrub(e); };
function scrub(e) {
  const b = charted.getBoundingClientRect(), x = (e.clientX - b.left) / b.width * charted.width;
  go(Math.min(tracked.last, Math.max(tracked.first, tracked.first + (tracked.last - tracked.first) * (x - span[0]) / (span[1] - span[0]))));
}
const SLOW = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
for (const over of SLOW) $("slow").add(over === 1 ? worded(new Option("", over), N("real time")) : worded(new Option("", over), N("slow 1/{0}"), over));
$("slow").onchange = () => change({ slow: Number($("slow").value) });
$("play").onclick = () => play(!playing);
$("again").onclick = () => { go(0); play(true); };
$("drawn").onchange = show;

// ---- the photograph
function shuttered() {
  const open = $("shutter").value !== "0", speed = Math.abs(here.precession || head?.phi / head?.period || 0.2);
  $("shot").hidden = !open;
  $("drawn").disabled = open || !!without;
  if (lasting()) live.last = open ? Math.min(head.lasts, now + 3.5 * TURN / Math.max(speed, 0.05)) : Math.min(head.lasts, live.first + live.span);
  if (open) for (const v in live.tips) live.tips[v].hidden = true;
  forget();
}
$("shutter").onchange = () => { if ($("shutter").value !== "0") { play_(false); } shuttered(); show(); };
const play_ = yes => { playing = yes; $("play").textContent = yes ? "❚❚" : "▶"; $("play").ariaLabel = yes ? W("pause") : W("play"); };
$("stop").onclick = stopped;
function stopped() { if (exposing.shown < exposing.most) exposing.most = exposing.shown; else { $("shutter").value = "0"; shuttered(); } show(); }

// ---- presets and the flick
const presets = JSON.parse($("presets").textContent);
$("preset").add(worded(new Option("", ""), N("choose …")));
for (const { name, word } of presets) $("preset").add(worded(new Option("", name), word));
function scene(state, name = "") { change({ ...BLANK, ...state }, { restart: true, name }); play_(!still.matches); show(); }
$("preset").onchange = () => { const found = presets.find(p => p.name === $("preset").value); if (found) scene(found.state, found.name); };
// after too hard a flick the body hops, after too weak a one it lies on its side
function flick(hard = 1) {
  const { code, out } = isTube() && s.ell > 0 ? ask("flick", 1.2 * hard * Math.max(1, s.ell), 80 * deg, 0.3, 0) : { code: 9 };
  if (code) { $("because").textContent = W("A flick needs a body with two ends: {0}", refusal(code)); return; }
  const [theta, ...w] = out, patch = s.contact === "coulomb" ? s.patch : 0;
  scene({ ell: s.ell, bore: s.bore, fillet: s.fillet, radius: s.radius, mass: s.mass, gravity: s.gravity, slow: s.slow, theta, w: w.slice(0, 5), contact: s.contact === "viscous" ? s.contact : "coulomb", mu: s.mu, patch, c: s.c, restitution: patch > 0 ? NaN : s.restitution >= 0 ? s.restitution : 0.5, law: s.law, loss: s.loss, slope: s.slope, phi0: s.phi0 });
}
const HARD = 2;
$("flick").onclick = e => flick(e.shiftKey ? HARD : 1);

// ---- the screen and the keys
const full = () => document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen().catch(() => { $("full").hidden = true; });
$("full").hidden = !document.fullscreenEnabled;
$("full").onclick = full;
document.onfullscreenchange = () => { $("full").ariaPressed = !!document.fullscreenElement; };
form.onsubmit = () => false;
const tilt = by => s.stone || change({ theta: Math.min(steep(), s.theta + by * deg), precession: NaN });
addEventListener("keydown", e => {
  const on = e.target, fine = e.shiftKey ? 0.1 : 1, help = document.querySelector("details");
  if (e.key === "Escape") help.open ? help.open = false : $("shutter").value !== "0" && stopped();
  if (e.ctrlKey || e.metaKey || e.altKey || on.tagName === "SELECT" || e.key === " " && ["BUTTON", "SUMMARY", "INPUT"].includes(on.tagName) && on.type !== "range") return;
  const keys = {
    __proto__: null,
    " ": () => play(!playing), 0: () => go(0), ",": () => { play(false); go(now - 0.25 / s.slow); }, ".": () => { play(false); go(now + 0.25 / s.slow); },
    r: () => change({ contact: "rolling" }), i: () => change({ contact: "smooth" }), c: () => rubs && change({ contact: "coulomb" }), v: () => rubs && change({ contact: "viscous" }),
    k: () => rubs && flick(e.shiftKey ? HARD : 1), s: hear, p: photograph, f: () => document.fullscreenEnabled && full(),
  };
  if (on === map || on === canvas) Object.assign(keys, { ArrowUp: () => tilt(on === map ? fine : -fine), ArrowDown: () => tilt(on === map ? -fine : fine), g: () => ghosts.length && change({ theta: ghosts.find(x => x > s.theta) ?? ghosts[0] }) });
  if (on === map) Object.assign(keys, { ArrowLeft: () => change({ ell: s.ell - 0.02 * fine }), ArrowRight: () => change({ ell: s.ell + 0.02 * fine }) });
  if (on === canvas) Object.assign(keys, { ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0), "+": () => zoom(1.15), "=": () => zoom(1.15), "-": () => zoom(1 / 1.15) });
  if (on === charted) Object.assign(keys, { ArrowLeft: () => go(now - live.span / 100), ArrowRight: () => go(now + live.span / 100) });
  if (s.stone) for (const none of ["r", "i", "c", "v"]) delete keys[none];
  const key = e.key.length === 1 ? e.key.toLowerCase() : e.key;
  if (keys[key]) { keys[key](); e.preventDefault(); }
});

// ---- the legend, and the initial state
for (const code of [7, 5, 6, 4, 1]) {
  const item = $("legend").appendChild(document.createElement("li"));
  item.append(Object.assign(document.createElement("canvas"), { width: 34, height: 22 }), worded(document.createElement("span"), REGIONS[code].name));
}
function legend() {
  const night = dusk.matches ? 1 : 0;
  [7, 5, 6, 4, 1].forEach((code, i) => {
    const g = $("legend").children[i].firstChild.getContext("2d"), { colour, ink, hatch } = REGIONS[code];
    for (let y = 0; y < 22; y++) for (let x = 0; x < 34; x++) { g.fillStyle = hatch(x / 1.3, y / 1.3) ? ink[night] : colour[night]; g.fillRect(x, y, 1, 1); }
  });
}
// another language: everything is written anew
$("language").onchange = () => { speak($("language").value); chosen = language; play_(playing); knobs(); say(""); chart.key = ""; redrawn(); settled(); };
const still = matchMedia("(prefers-reduced-motion: reduce)");
panelled(live);
dusk.onchange = () => requestAnimationFrame(() => { legend(); redrawn(); }); // a notebook may hide its frames while it changes its theme
// parts of an address besides the state: the time at which the page opens paused, and the exposure
function arrive({ t = 0, expose = 0 }) {
  delete s.t;
  delete s.expose;
  if (t) { play_(false); go(t); }
  $("shutter").value = expose > 1 ? "3" : expose > 0 ? "1" : "0";
  if (expose) play_(false);
  shuttered();
  show();
}
addEventListener("hashchange", e => {
  const { hash } = new URL(e.newURL); // meanwhile the page may have set an address of its own
  if (hash === address()) return;
  const found = parsed(hash), heard = odd;
  scene(found);
  odd = heard;
  changed = null;
  solve({ restart: true });
  arrive(found);
});
const first = parsed(location.hash);
// an address that names a body is complete: the other numbers are defaults
Object.assign(s, "ell" in first || first.height || first.stone ? BLANK : {}, first);
const opening = { ...s };
// everything as it was when the page opened: the body and its motion, the view, what is drawn, the time, and silence
function reset() {
  if (recorder) film();
  if (audio) hear();
  Object.assign(eye, { azimuth: -1.1, elevation: 0.55, zoom: 1 });
  for (const box of document.querySelectorAll("#drawn input")) box.checked = box.defaultChecked;
  $("shutter").value = "0";
  scene(opening);
  changed = null;
  solve({ restart: true });
  arrive(first);
}
$("reset").onclick = reset;
held_ = true; // the first map is coarse
if (!still.matches) play_(true);
solve({ restart: true });
arrive(s);
// the body is drawn first; the observer draws the other parts when it starts
requestAnimationFrame(() => requestAnimationFrame(() => { legend(); new ResizeObserver(redrawn).observe(document.querySelector("main")); }));
// for tests and notebooks
Object.assign(window.spincyl, {
  state: () => ({ ...s }), set: (part, more = { restart: true }) => change(part, more), timing, at: () => now, head: () => head, here: () => here, body: () => body, ghosts: () => ghosts,
  audio: () => audio, hits, heardAt,
  look: lookOf, pose: t => pose(live, t), rows: () => rows, map: () => ({ names: chart.names, widest: widest(), steep: steep() }), solve,
  tracked: () => tracked.rows, tracks: () => TRACKS.filter(track => track.zero).map(({ name, most, cut }) => ({ name, most, cut })),
  on: () => project(live, pose(live, now).centre, stage.clientWidth, stage.clientHeight),
});
// In the frame of a notebook: requests the notebook's state, and sends changes by the user, at most twenty a
// second
if (window.parent !== window) {
  const post = words => window.parent.postMessage({ spincyl: words }, "*");
  const plain = () => Object.fromEntries(Object.entries(s).map(([name, value]) => [name, Number.isNaN(value) ? null : value]));
  let heard = null, telling = 0;
  const shown = words => Object.entries(words).every(([name, value]) => String(s[name]) === String(value));
  addEventListener("message", e => {
    if (e.source !== window.parent || !e.data?.spincyl) return;
    const words = { ...BLANK };
    for (const [name, value] of Object.entries(e.data.spincyl)) words[name] = value ?? BLANK[name];
    clearTimeout(telling);
    telling = 0;
    if (shown(words)) return;
    heard = words;
    change(words, { restart: true });
  });
  // does not send back a state just received, unless the page cannot show it as it is
  window.spincyl.told = () => {
    const echo = heard && shown(heard);
    heard = null;
    if (!echo) telling ||= setTimeout(() => { telling = 0; post(plain()); }, 50);
  };
  post(null);
}
