// Calls of the core: arguments are numbers, the return value is a code, and results lie in the core's memory.

const $ = id => document.getElementById(id);
// from the loader: the exports of the core, the initial state, and day or night
const { core, given, dusk } = window.spincyl;

const rubs = "phases" in core; // whether this core has friction and losses
const TURN = 2 * Math.PI, deg = Math.PI / 180;
// a copy of the results, since memory may move at the next call
const answer = () => Array.from(new Float64Array(core.memory.buffer, core.out(), core.len()));
const ask = (name, ...numbers) => { const code = core[name](...numbers); return { code, out: answer() }; };
// results in rows of `wide` numbers
const rowsOf = (name, wide, ...numbers) => {
  const { code, out } = ask(name, ...numbers);
  return code ? [] : Array.from({ length: out.length / wide }, (_, i) => out.slice(wide * i, wide * (i + 1)));
};

const OF_BODY = ["ell", "i1", "i3", "fillet", "theta0", "limit", "most", "standing", "folds", "excess"];
const OF_STEADY = ["region", "rate", "rolling", "smooth", "energy", "w1", "w2", "w3", "precession", "spin", "symbols", "demand", "normal", "circle"];
const OF_START = ["integrated", "ending", "ends", "period", "low", "high", "phi", "psi", "error", "poseError", "evaluations", "phases", "slipTime", "heat", "lost", "lasts", "impacts", "knocked"];
const OF_ROW = { t: 0, theta: 1, phi: 5, psi: 6, x: 7, y: 8, normal: 9, demand: 10, along: 11, across: 12, energy: 13, kind: 14, lost: 15, height: 16, turned: 17 }, WIDE = 18;
// kinds of a phase in the order of the core, in words; with a law of friction a contact rubs in some of them
const KINDS = ["", N("slipping"), N("flying"), N("lies on its side, slipping"), N("lies on its side, pivoting"), N("rolls on its side"), N("rolls round its apex"), N("on its face")], SLIPS = 1, FLIES = 2, ON_FACE = 7;
const onBoth = kind => kind > FLIES && kind !== ON_FACE;
const rubbed = kind => [1, 3, 4, ON_FACE].includes(kind);
const labelled = (names, numbers) => Object.fromEntries(names.map((name, i) => [name, numbers[i]]));

// reasons for a code without results
const REFUSED = {
  2: N("There is no such body: its axial moment of inertia is more than twice the transverse one."),
  5: N("This motion cannot be followed: its equations lose all accuracy here."),
  6: N("No contact force, or more than one, obeys the law of dry friction here (Painlevé's paradox)."),
  13: N("This motion hardly advances, for it changes ever faster."),
  8: N("There is not enough memory for this."),
  12: N("This page was made without friction and losses: it has only rubber and ice."),
  10: N("This motion takes too much computing for a page; use Python."),
};
function refusal(code) {
  if (code !== 1) return W(REFUSED[code] || N("The core has no answer here."));
  const [name, expected] = new TextDecoder().decode(new Uint8Array(core.memory.buffer, core.words(), core.words_len())).split("\n");
  return name === "slope" && expected.startsWith("0 ") ? W("A slope is not computed {0}.", expected.slice(2)) : W("{0} is out of range: {1}.", name, expected);
}
