// From a change by the user to the picture: solves at most once per frame, draws in each.

const timing = { opened: performance.now() };
let asked = false, changed = null, before = null, on = "", held_ = false, resting = 0;
const show = () => { if (!asked) { asked = true; requestAnimationFrame(frame); } };

// every change of the state goes through here; `more` has options of `solve`, and the text `on`
function change(part, more = {}) {
  const tilts = ["theta", "ell", "bottom", "top", "height", "bore", "fillet", "i1", "i3", "precession"].some(name => name in part && !Object.is(part[name], s[name]));
  if (tilts && !("w" in part)) s.w = null; // a given state belonged to the previous body
  if (["ell", "fillet"].some(name => name in part)) s.parts = null; // and so did these
  for (const [name, value] of Object.entries(part)) {
    const [low, high] = RANGE[name] || [];
    s[name] = typeof value === "number" && Number.isFinite(value) && low !== undefined ? Math.min(high, Math.max(low, value)) : value;
  }
  odd = [];
  if (Object.keys(part).every(name => name === "slow")) { clearTimeout(solve.later); solve.later = setTimeout(settled, 250); window.spincyl.told?.(); return; }
  changed = { ...changed, ...more };
  on = more.on || "";
  show();
}

function solve({ restart, name = "" } = {}) {
  $("preset").value = name; // a state changed by hand is no preset
  const began = performance.now();
  live.slope = s.stone ? 0 : s.slope;
  begin();
  if (!body.code) dress();
  // a motion without an end continues from the present time; any other starts anew
  if (restart || !lasting() || now > head.lasts || head.integrated || head.ending) now = 0;
  live.span = lasting() ? windowed() : 1;
  look(Math.floor(now / live.span) * live.span);
  timing.solve = performance.now() - began;
  say(on);
  if (timing.first) { drawChart(); drawMap(held_); } // at the beginning, these follow the first picture
  knobs();
  $("slow").value = SLOW.find(x => x >= s.slow) ?? 1000;
  forget();
  timing.change = performance.now() - began;
  clearTimeout(solve.later);
  solve.later = setTimeout(settled, 250);
  window.spincyl.told?.();
}
// redraws everything for another screen or theme
function redrawn() { drawMap(held_); drawChart(); forget(); show(); }
// shortly after the last change: the fine map, a finer path, the address
function settled() {
  held_ = false;
  drawMap(false);
  if (known() && head.lasts > live.first && $("shutter").value === "0") { look(live.first, 1500); drawChart(); show(); }
  try { history.replaceState(null, "", address()); } catch { /* as in a frame without an address */ }
}

function frame(at) {
  asked = false;
  if (changed) { const more = changed; changed = null; solve(more); }
  if (!seen) return;
  if (playing && before !== null && lasting()) {
    const passed = Math.min(0.1, Math.max(0, at - before) / 1000);
    if (now >= head.lasts) { resting += passed; if (resting > 2) { resting = now = 0; look(0); drawChart(); } }
    else now = Math.min(head.lasts, now + real() * passed / s.slow);
    if (now > live.last && now < head.lasts) { look(live.last); drawChart(); }
  }
  before = at;
  const began = performance.now();
  const ratio = Math.min(2, devicePixelRatio || 1), width = Math.max(1, Math.round(stage.clientWidth * ratio)), height = Math.max(1, Math.round(stage.clientHeight * ratio));
  if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; forget(); }
  const drawing = lit(), open = drawing && $("shutter").value !== "0" && rows.length > 0;
  if (drawing) { gl.disable(gl.SCISSOR_TEST); gl.viewport(0, 0, width, height); }
  live.panel.classList.toggle("dark", open);
  if (open) {
    expose([[live, 0, 0, width, height, 0]]);
  } else if (rows.length) {
    const row = rowAt(Math.min(now, head.lasts)), p = moving(live, now);
    delete document.documentElement.dataset.exposed;
    live.over = head.ending && now >= head.lasts;
    live.after = { at: head.lasts, event: head.ending > 0 };
    if (drawing) draw(live, now, width / height);
    labels(p, width / ratio, height / ratio);
    drawCursor();
    heard();
    const told = clocked(row);
    if (live.clock.value !== told) live.clock.value = told;
  } else {
    if (drawing) { gl.clearColor(...paints().paper, 1); gl.clear(gl.COLOR_BUFFER_BIT); }
    live.clock.value = "";
    for (const v in live.tips) live.tips[v].hidden = true;
  }
  timing.frame = performance.now() - began;
  filmed();
  document.documentElement.dataset.drawn ??= timing.first = performance.now();
  if (playing && seen || filming()) show();
}
// the phase, and in the air the height of the lower rim
const phased = row => { const kind = row[OF_ROW.kind], high = Math.max(0, row[OF_ROW.height] + (body.circles ? 0 : Math.min(0, 2 * body.ell * Math.cos(row[1])))); return kind ? `\n${kind === FLIES ? W("flying {0} high", sized() ? `${decimal(1e3 * high * size(), 1)} mm` : `${decimal(high)} R`) : W(KINDS[kind])}` : ""; };
function clocked(row) { return `t = ${timed(now, now < 100 ? 2 : 1)}\nθ = ${degrees(row[1])}${sloping(live)}${phased(row)}${live.over ? "\n" + ending() : ""}`; }
function labels(p, width, height) {
  Object.assign(live.panel.style, { width: width + "px", height: height + "px" });
  named(live, p, ARROWS.map(v => without ? null : arrowOf(p, v)), width, height);
}
function play(yes) {
  playing = yes;
  if (yes) { before = null; $("shutter").value = "0"; shuttered(); if (lasting() && now >= head.lasts) { now = 0; look(0); drawChart(); } }
  $("play").textContent = yes ? "❚❚" : "▶";
  $("play").ariaLabel = yes ? W("pause") : W("play");
  show();
}
function go(t) {
  if (!lasting()) return;
  now = Math.min(head.lasts, Math.max(0, t));
  const first = Math.floor(now / live.span) * live.span;
  if (first < head.lasts && first !== live.first) { look(first); drawChart(); }
  forget();
  show();
}
