// Bodies that slip: contact forces (page.forces.js has their arrows), a path in two colours, phases on the
// time line, and a camera that can follow. Pages without friction omit this file. It comes before the drawing
// and replaces some of its functions.

for (const m of motions) if (m.forces) {
  const whole = new Uint16Array(bytes(m.forces)), n = whole.length / 5;
  const read = (i, k) => m.lows[k] + (m.highs[k] - m.lows[k]) * (whole[5 * i + k] / 0xffff);
  // slip and friction along e_h and e2, and normal force, interpolated between equally spaced times
  m.rubs = t => {
    const x = Math.min(Math.max((t - m.first) / (m.last - m.first), 0), 1) * (n - 1), i = Math.min(Math.floor(x), n - 2);
    return [0, 1, 2, 3, 4].map(k => read(i, k) + (x - i) * (read(i + 1, k) - read(i, k)));
  };
  const presses = Array.from({ length: n }, (_, i) => read(i, 4)).sort((a, b) => a - b);
  m.press = Math.max(1e-9, presses[n >> 1]); // the median of N
  m.slips = t => m.phases?.findLast(([begin], i) => begin <= t || i === 0)[1] === 1;
  if (m.phases) m.runs = times => m.phases.map(([t, kind]) => [t > m.first ? knot(t, times) : 0, kind ? "friction" : "trace"]);
}

const withoutForces = pose;
pose = (m, t) => {
  const p = withoutForces(m, t);
  if (!m.forces) return Object.assign(p, { normal: [0, 0, 0], friction: [0, 0, 0] });
  const [u, v, f, g, n] = m.rubs(t), [c, s] = [Math.cos(p.phi), Math.sin(p.phi)], slips = m.slips(t);
  return Object.assign(p, { normal: [0, 0, n], friction: [c * f - s * g, s * f + c * g, 0], usual: m.press, slips, speed: Math.hypot(u, v) });
};

// further text of the clock
doing = (m, p) => m.phases ? "\n" + (p.slips ? `slipping ${rounded(p.speed * data.speed)} ${data.speeds}`.replaceAll(" ", "\u00a0") : "rolling") : "";

// switches for the forces, and for a camera that follows a body that moves far
for (const [id, text, before] of [["forces", '<i class="normal">N</i> <i class="friction">F</i>', $("path").parentNode], ["follow", "follow", null]]) {
  const label = document.createElement("label");
  label.innerHTML = `<input type="checkbox" id="${id}"> ${text}`;
  $("drawn").insertBefore(label, before);
}
document.querySelector("details p").append(" While a body slips, its path and the line under the slider are red; N is the normal force and F the friction, on the same scale. Follow keeps the bodies in the middle.");
$("forces").ariaLabel = "normal force and friction";
$("forces").checked = true;
let asPlanned = data.follow !== null;
$("follow").checked = !!data.follow;
// centre of the view: the body, or for a photograph the middle of its path while the shutter is open
aim = (m, p) => {
  const alone = Math.max(...motions.map(m => Math.hypot(1, m.ell))), all = Math.max(...motions.map(m => m.reach));
  if (!asPlanned) { $("follow").checked = all > 2.5 * alone; asPlanned = true; }
  const follows = $("follow").checked;
  reach = follows ? alone : all;
  half = Math.max(...motions.map(m => follows ? held(alone, m.middle[2] / 0.45) : m.half));
  if (!follows) return m.middle;
  const places = p ? [p.centre] : Array.from({ length: 65 }, (_, i) => pose(m, m.open + (m.shut - m.open) * i / 64).centre);
  return [0, 1].map(k => (Math.min(...places.map(x => x[k])) + Math.max(...places.map(x => x[k]))) / 2).concat(m.middle[2]);
};

// under the slider a line for each motion with phases, red while the body slips
{
  const slider = $("time"), line = document.createElement("div"), share = t => 100 * Math.min(Math.max((t - first) / (last - first), 0), 1);
  line.id = "line";
  slider.replaceWith(line);
  line.append(slider);
  for (const m of motions) if (m.phases) {
    const stops = m.phases.flatMap(([t, kind], i) => {
      const colour = kind ? "var(--friction)" : "var(--trace)", until = m.phases[i + 1]?.[0] ?? m.last;
      return [`${colour} ${share(t)}%`, `${colour} ${share(until)}%`];
    });
    const strip = line.appendChild(document.createElement("div"));
    strip.className = "phases";
    strip.style.background = `linear-gradient(to right, ${stops.join(", ")}, transparent ${share(m.last)}%)`;
    strip.title = m.phases.map(([t, kind]) => (kind ? "slipping" : "rolling") + " from " + clock(t)).join(", ");
    strip.role = "img";
    strip.ariaLabel = (m.label ? m.label + ": " : "") + strip.title;
    m.wide = 0.006 * Math.sqrt(Math.hypot(1, m.ell) * (Math.hypot(1, m.ell) + 0.5 * Math.hypot(m.high[4] - m.low[4], m.high[5] - m.low[5])));
  }
}
