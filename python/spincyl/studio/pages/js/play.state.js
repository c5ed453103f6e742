// The state of the page, as the user has set it. The address stores it, and everything else follows from it.

// least and greatest value of each number, in the order of the address
const RANGE = {
  __proto__: null, // no inherited keys: an address may contain "toString"
  ell: [-1, 8], bore: [0, 1], fillet: [0, 1], i1: [0, 1e3], i3: [0, 1e3], end: [0, Math.PI], theta: [1e-3, Math.PI], kick: [-3, 3],
  precession: [-20, 20], mu: [0, 5], patch: [0, 0.5], c: [0, 20], restitution: [0, 1], loss: [0, 1], until: [1, 2000], slow: [1, 1000], t: [0, 1e9], expose: [0, 3], radius: [1e-6, 1e3], mass: [1e-9, 1e9], gravity: [1e-6, 1e6], twist: [-0.3, 0.3], spin: [-50, 50], bottom: [0, 1], top: [0, 1], height: [0.05, 20], slope: [0, Math.PI / 4], phi0: [-Math.PI, Math.PI],
};
const CONTACTS = ["rolling", "smooth", "coulomb", "viscous"]; // in the order of the codes of the core
// the loss laws in the order of the core, which Python tells: name and label
const LAWS = Object.fromEntries([["none", N("none")], ...JSON.parse(document.getElementById("laws").textContent).map(name => [name, name.replaceAll("-", " ")])]);
// i1 and i3 belong to a body that is not a tube, end is the inclination at which it lands, w is a state that is
// not steady: w1, w2, w3 and the slip. radius, mass and gravity belong to a measured body, in metres,
// kilograms and m/s^2. patch is the radius of the contact, in R. Without a restitution a motion ends where the body leaves the table. stone has the semi-axes of a rattleback in metres, twist is in radians and spin in
// radians per second. bottom, top and height belong to a frustum, such as a cup or a cone, with a larger radius of 1. slope is that of the table, and phi0 the direction to which the axis leans at first, from downhill. parts are the surfaces of a body that was put together, from Python; an address that has the same body keeps them.
const BLANK = { ell: 2.5, bore: 0, fillet: 0, i1: NaN, i3: NaN, end: NaN, theta: 1.3, kick: 0, precession: NaN, contact: "rolling", mu: 0.3, patch: 0, c: 0.3, restitution: NaN, law: "none", loss: 1e-3, w: null, until: 60, slow: 20, radius: NaN, mass: NaN, gravity: 9.80665, parts: null, stone: null, twist: 2 * Math.PI / 180, spin: -5, bottom: NaN, top: NaN, height: NaN, slope: 0, phi0: 0 };
const s = { ...BLANK, ...given };

// a figure in a page of text shows the body, and the map or the tracks beside it
const figure = /[#&]figure=(body|map|chart)\b/.exec(location.hash)?.[1];
if (figure) document.documentElement.dataset.figure = figure;

const rubbing = () => CONTACTS.indexOf(s.contact) > 1;
const short = x => String(+x.toPrecision(7));
function address() {
  const words = [];
  for (const [name, value] of Object.entries(s)) {
    const ofStone = ["stone", "twist", "spin"].includes(name);
    if (name === "parts") continue;
    if (s.stone ? !ofStone && (Object.is(value, BLANK[name]) || !["slow", "gravity"].includes(name)) : ofStone) continue;
    if (!ofStone && (name === "w" ? !value : name === "contact" || name === "law" ? value === BLANK[name] : Object.is(value, BLANK[name]) && !["ell", "theta"].includes(name) || name === "ell" && isFrustum())) continue;
    if (["mu", "patch"].includes(name) && s.contact !== "coulomb" || name === "c" && s.contact !== "viscous" || name === "restitution" && !rubbing() || name === "loss" && s.law === "none" || name === "phi0" && !s.slope) continue;
    words.push(`${name}=${typeof value === "string" ? value : Array.isArray(value) ? value.map(short).join(",") : short(value)}`);
  }
  return "#" + [...figure ? [`figure=${figure}`] : [], ...chosen ? [`language=${chosen}`] : [], ...words].join("&");
}
// the size of the body, if known: then times are shown in seconds, and rates also in hertz
const size = () => s.stone ? Math.max(...s.stone) : s.radius, sized = () => Number.isFinite(size()), second = () => Math.sqrt(size() / s.gravity);
// seconds and milliseconds, with the same last digit
const timed = (t, d = 2) => !sized() ? `${decimal(t, d)} √(R/g)` : Math.abs(t * second()) < 1 ? `${decimal(1e3 * t * second(), Math.max(0, d - 1))} ms` : `${decimal(t * second(), d + 1)} s`;
const hertz = turning => turning / (TURN * second()), hertzOf = rate => hertz(rate / Math.sqrt(body.i3));
// units of time per second at real speed; without a size, for a body with R = 1 cm
const real = () => sized() ? 1 / second() : Math.sqrt(9.80665 / 0.01);

// the state in an address, without invalid parts, which are reported until the user changes anything
let odd = [];
function parsed(hash) {
  const found = {};
  odd = [];
  for (const [name, text] of new URLSearchParams(hash.replace(/^#/, ""))) {
    if (name === "figure" || name === "language") continue;
    const numbers = text.split(",").map(Number), [low, high] = RANGE[name] || [];
    if (name === "contact" ? CONTACTS.includes(text) : name === "law" && Object.hasOwn(LAWS, text)) found[name] = text;
    else if (name === "w" && numbers.length === 5 && numbers.every(Number.isFinite)) found.w = numbers;
    else if (name === "stone" && rubs && numbers.length === 3 && numbers.every(x => x > 1e-6 && x < 1e3)) found.stone = numbers;
    else if (low !== undefined && text !== "" && Number.isFinite(numbers[0])) {
      found[name] = Math.min(high, Math.max(low, numbers[0]));
      if (found[name] !== numbers[0]) odd.push(`${name}=${text} (${short(low)} – ${short(high)}${["theta", "end"].includes(name) ? " rad" : ""})`);
    } else odd.push(`${name}=${text}`);
  }
  // addresses have few digits: an inclination next to a right angle becomes one
  for (const name of ["theta", "end"]) if (Math.abs(found[name] - Math.PI / 2) < 1e-6) found[name] = Math.PI / 2;
  if (found.stone) found.slow ??= 1; // a stone is shown in real time
  if (given.parts && ["ell", "i1", "i3", "fillet", "end"].every(name => short(found[name] ?? NaN) === short(given[name] || NaN))) found.parts = given.parts;
  return found;
}
const isFrustum = () => Number.isFinite(s.height);
const isTube = () => !Number.isFinite(s.i1) && !isFrustum();
// largest inclination
const steep = () => isTube() ? Math.PI / 2 : body.circles ? Math.PI - 0.01 : Math.min(body.most || Math.PI / 2, Math.PI);

// ---- derived quantities

let body = {}, start = null, here = {}, head = null, said = "", ghosts = [], rows = [];

function embody() {
  const wide = Math.max(s.bottom, s.top), { code, out } = isFrustum() ? ask("frustum", s.bottom / wide, s.top / wide, s.height) : isTube() ? ask("tube", s.ell, s.bore, s.fillet) : ask("body", s.ell, s.i1, s.i3, s.fillet, s.end);
  body = code ? { code } : { code, ...labelled(OF_BODY, out), circles: isFrustum() && [0, 3].map(i => out.slice(OF_BODY.length).slice(i, i + 3)) };
  // a body of two circles is followed with friction and impacts; it has the whole range of inclinations
  if (body.circles) Object.assign(s, { ell: body.ell, contact: rubbing() ? s.contact : "coulomb", restitution: s.restitution >= 0 ? s.restitution : 0, patch: 0 });
  if (code) body.why = refusal(code);
  return !code;
}
const lossy = () => s.law !== "none";
function damped() { const law = Object.keys(LAWS).indexOf(s.law) - 1; core.losses(Math.max(law, 0), law < 0 ? 0 : s.loss); }

// number of stored rows of an integrated motion, which can be read again at no cost; duration of an exact
// motion
const ROWS = 601, LONG = 1e4;
// from the state to a motion that can be evaluated at any time; an impossible state gets a reason
function begin() {
  head = null;
  ghosts = [];
  if (isTube()) { s.ell = Math.max(0, s.ell); s.fillet = Math.max(0, Math.min(s.fillet, 1 - s.bore, s.ell)); }
  if (!embody()) return;
  s.theta = Math.min(s.theta, steep());
  if (body.circles && Math.abs(s.theta - body.most) < 1e-6) s.theta = body.most; // addresses have few digits
  damped();
  core.slope(s.slope, s.phi0);
  const turning = Number.isFinite(s.precession) && !s.w;
  const { code, out } = turning ? ask("circular", s.theta, s.precession) : ask("at_rest", s.theta);
  here = code ? { code, region: code === 3 ? 1 : code === 4 ? 2 : 0 } : { code, ...labelled(OF_STEADY, out) };
  if (!code && !turning && !s.w && here.rate > 0) {
    const { code: none, out: others } = ask("by_rate", here.rate);
    if (!none) ghosts = others.filter(x => Math.abs(x - s.theta) > 1e-4);
  }
  const [w1, w2, w3, u, v] = s.w || (code ? [0, 0, 0, 0, 0] : [here.w1, here.w2, here.w3, 0, 0]);
  start = { w1, w2: w2 - s.kick, w3 };
  const kind = CONTACTS.indexOf(s.contact), exact = kind < 2 && !lossy() && !s.slope;
  const begun = ask("start", s.theta, w1, w2 - s.kick, w3, u, v, kind, kind < 2 ? Infinity : kind < 3 ? s.mu : s.c, s.patch, exact ? LONG : s.until, ROWS, rubbing() ? s.restitution : NaN);
  if (begun.code) head = { code: begun.code, why: refusal(begun.code) };
  else head = { code: 0, ...labelled(OF_START, begun.out) };
}
const known = () => head && !head.code;
// whether the motion has a duration: without one, or without results, the body stands still
const lasting = () => known() && head.lasts > 0;
// the row of the motion at a time, or at its end
function rowAt(t) {
  if (!lasting()) return latest;
  const { code, out } = ask("follow", 1, t, t);
  return code || out.length < WIDE ? rows.at(-1) || null : out;
}
