// The frame loop and the controls of the recorded page.

let now = first, playing = false, before = null, asked = false;
const show = () => { if (!asked) { asked = true; requestAnimationFrame(frame); } };
const speed = () => Number($("speed").value) / data.unit; // units of t per second
const say = which => { $("said").textContent = which.map(m => (m.label ? m.label + ": " : "") + m.clock.value.replace("\n", ", ")).join("; "); };

function frame(at) {
  asked = false;
  if (!seen) return;
  const drawing = lit();
  $("controls").hidden = !gl;
  if (playing) {
    // a frame may have an earlier time than the press of play, so count from the first frame
    if (before !== null) now = Math.min(last, now + speed() * Math.min(0.25, Math.max(0, at - before) / 1000));
  }
  before = at;
  const ratio = Math.min(2, devicePixelRatio || 1), width = Math.max(1, Math.round(stage.clientWidth * ratio)), height = Math.max(1, Math.round(stage.clientHeight * ratio));
  if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; forget(); }
  // columns that leave few panels empty and give the others a good shape
  const cost = c => { const r = Math.ceil(motions.length / c); return 0.7 * (r * c - motions.length) + Math.abs(Math.log(width * r / height / c / 1.3)); };
  const columns = motions.map((_, i) => i + 1).reduce((a, b) => cost(b) < cost(a) ? b : a), rows = Math.ceil(motions.length / columns);
  const views = motions.map((m, i) => {
    const [c, r] = [i % columns, Math.floor(i / columns)], x = Math.round(c * width / columns), y = Math.round(r * height / rows);
    return [m, x, height - Math.round((r + 1) * height / rows), Math.round((c + 1) * width / columns) - x, Math.round((r + 1) * height / rows) - y, y];
  });
  const exposed = !playing && $("shutter").value !== "0";
  if (drawing && exposed) expose(views); else if (drawing) {
    forget();
    delete document.documentElement.dataset.exposed;
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(...paints().paper, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.enable(gl.SCISSOR_TEST);
    for (const [m, x, y, w, h] of views) {
      gl.viewport(x, y, w, h);
      gl.scissor(x, y, w, h);
      draw(m, now, w / h);
    }
  }
  for (const [m, x, , w, h, top] of views) {
    Object.assign(m.panel.style, { left: x / ratio + "px", top: top / ratio + "px", width: w / ratio + "px", height: h / ratio + "px" });
    m.panel.classList.toggle("dark", exposed);
    const there = note(m, now), p = moving(m, now);
    const told = (there ? there.said + clock(there.t) : clock(now)) + "\nθ = " + (p.theta * 180 / Math.PI).toFixed(1) + "°" + doing(m, p);
    if (m.clock.value !== told) m.clock.value = told;
    if (playing && there?.event && !m.over) say([m]);
    m.over = there?.event;
    named(m, p, ARROWS.map(v => exposed ? null : arrowOf(p, v)), w / ratio, h / ratio);
  }
  sounded(now, speed(), playing);
  $("time").value = now;
  $("time").setAttribute("aria-valuetext", clock(now));
  document.documentElement.dataset.drawn ??= performance.now();
  if (playing && now >= last) play(false);
  else if (playing) show();
}

// ---- controls

function play(on) {
  playing = on;
  if (on && now >= last) now = first;
  if (on) { $("shutter").value = "0"; shuttered(); }
  else say(motions);
  before = null;
  $("play").textContent = on ? "❚❚" : "▶";
  $("play").setAttribute("aria-label", on ? "pause" : "play");
  forget();
  show();
}
// the slider rounds its ends: a time next to an end becomes that end
function go(t) {
  const hair = 1e-9 * (last - first);
  now = t > last - hair ? last : t < first + hair ? first : t;
  forget();
  show();
}

for (const over of [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000]) $("speed").add(new Option(over === 1 ? "1" : "1/" + over, 1 / over));
$("speed").add(new Option("2", 2), 0);
$("speed").value = 1 / data.slow;
Object.assign($("time"), { min: first, max: last, value: first });
$("play").onclick = () => play(!playing);
$("time").oninput = () => { playing && play(false); go($("time").valueAsNumber); };
$("drawn").onchange = show;
$("shutter").onchange = () => {
  playing && play(false);
  if (now >= last) now = first; // an exposure starts now and needs time
  shuttered();
  show();
};
// the row of the photograph shows its progress, and why other controls are disabled
function shuttered() {
  const open = $("shutter").value !== "0";
  if (!open && document.activeElement === $("stop")) $("shutter").focus();
  $("shot").hidden = !open;
  $("drawn").disabled = open || !!without;
  $("drawn").title = open ? W(REST) : "";
  forget();
}
function stopped() {
  if (exposing.shown < exposing.most) exposing.most = exposing.shown; else { $("shutter").value = "0"; shuttered(); }
  show();
}
$("stop").onclick = stopped;

const full = () => document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen().catch(() => { $("full").hidden = true; });
$("full").hidden = !document.fullscreenEnabled; // as in a frame without permission
$("full").onclick = full;
document.onfullscreenchange = () => { $("full").ariaPressed = !!document.fullscreenElement; };
$("controls").onsubmit = () => false;
addEventListener("keydown", e => {
  const help = document.querySelector("details");
  if (e.key === "Escape") help.open ? help.open = false : $("shutter").value !== "0" && stopped();
  // these use the space bar themselves
  const has = ["BUTTON", "SUMMARY"].includes(e.target.tagName) || e.target.type === "checkbox";
  if (e.ctrlKey || e.metaKey || e.altKey || e.target.tagName === "SELECT" || e.key === " " && has) return;
  const keys = { __proto__: null, " ": () => play(!playing), ",": () => go(now - speed() / 60), ".": () => go(now + speed() / 60), 0: () => go(first), s: () => $("hear").hidden || hear(), f: () => document.fullscreenEnabled && full() };
  if (e.target === canvas) Object.assign(keys, {
    ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0), ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1),
    "+": () => zoom(1.15), "=": () => zoom(1.15), "-": () => zoom(1 / 1.15),
  });
  const key = ["F", "S"].includes(e.key) ? e.key.toLowerCase() : e.key;
  if (keys[key]) { keys[key](); e.preventDefault(); }
});
dusk.onchange = show;
new ResizeObserver(show).observe(stage);

// initial settings
const { drawn, above, exposure } = data.look, switched = { omega: "omega", momentum: "momentum", velocity: "velocity", force: "forces", path: "path", axis: "axis" };
if (drawn) for (const name in switched) if ($(switched[name])) $(switched[name]).checked = drawn.includes(name);
$("above").checked = above;
if (exposure !== "0") {
  if (![...$("shutter").options].some(o => o.value === exposure)) $("shutter").add(new Option(exposure + " turns", exposure));
  $("shutter").value = exposure;
  shuttered();
}

const wish = new URLSearchParams(location.hash.slice(1));
const wished = Number(wish.get("t") ?? NaN) / data.unit;
if (Number.isFinite(wished)) go(wished);
else if (exposure === "0" && !matchMedia("(prefers-reduced-motion: reduce)").matches) play(true);
show();
// for tests: a pose, the time, and the position of a body's centre on the stage
window.spincyl = {
  pose: (i, t) => pose(motions[i], t),
  at: () => now * data.unit,
  audio: () => audio, hits, heardAt,
  on: (i, t) => {
    const m = motions[i], [x, y] = project(m, pose(m, t).centre, m.panel.clientWidth, m.panel.clientHeight);
    return [m.panel.offsetLeft + x, m.panel.offsetTop + y];
  },
};
