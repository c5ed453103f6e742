// Bodies that slip: the forces on the contact, the path in two colours, phases on the time line. Pages of motions
// without friction have no need of this file; where it is there, it comes before the drawing.

for (const m of motions) if (m.phases) {
  const whole = new Uint16Array(bytes(m.forces)), n = whole.length / 5;
  const read = (i, k) => m.lows[k] + (m.highs[k] - m.lows[k]) * (whole[5 * i + k] / 0xffff);
  // slip and friction along the lean and across it, normal force: straight lines between even times
  m.rubs = t => {
    const x = Math.min(Math.max((t - m.first) / (m.last - m.first), 0), 1) * (n - 1), i = Math.min(Math.floor(x), n - 2);
    return [0, 1, 2, 3, 4].map(k => read(i, k) + (x - i) * (read(i + 1, k) - read(i, k)));
  };
  const presses = Array.from({ length: n }, (_, i) => read(i, 4)).sort((a, b) => a - b);
  m.press = Math.max(1e-9, presses[n >> 1]); // a usual N
  m.phase = t => m.phases.findLastIndex(([begin]) => begin <= t);
  m.slips = t => (m.phases[m.phase(t)] || m.phases[0])[1] === 1;
}

const withoutForces = pose;
pose = (m, t) => {
  const p = withoutForces(m, t);
  if (!m.phases) return Object.assign(p, { normal: [0, 0, 0], friction: [0, 0, 0] });
  const [u, v, f, g, n] = m.rubs(t), [c, s] = [Math.cos(p.phi), Math.sin(p.phi)];
  const slips = m.slips(t);
  return Object.assign(p, {
    normal: [0, 0, n], friction: [c * f - s * g, s * f + c * g, 0], speed: slips ? Math.hypot(u, v) : 0, slips,
    roots: { normal: p.contact, friction: p.contact },
  });
};

// what the clock says besides
doing = (m, p) => m.phases ? "\n" + (p.slips ? "slipping " + (p.speed * data.speed).toPrecision(3) + " " + data.speeds : "rolling").replaceAll(" ", "\u00a0") : "";

// one switch for both forces; and one for the camera, since what slips goes far
{
  const box = document.createElement("label");
  box.innerHTML = '<input type="checkbox" id="forces" checked aria-label="normal force and friction"> <i class="normal">N</i> <i class="friction">F</i>';
  $("drawn").insertBefore(box, $("path").parentNode);
  const follow = document.createElement("label");
  follow.innerHTML = '<input type="checkbox" id="follow"> follow';
  $("drawn").append(follow);
  follow.onchange = () => framed();
}

// under the slider a line for each motion that slips, on which slipping is red
{
  const slider = $("time"), line = document.createElement("div"), share = t => 100 * Math.min(Math.max((t - first) / (last - first), 0), 1);
  line.id = "line";
  slider.replaceWith(line);
  line.append(slider);
  for (const m of motions) if (m.phases) {
    const stops = m.phases.flatMap(([t, kind], i) => {
      const colour = kind ? "var(--friction)" : "var(--trace)", until = i + 1 < m.phases.length ? m.phases[i + 1][0] : m.last;
      return [`${colour} ${share(t)}%`, `${colour} ${share(until)}%`];
    });
    const strip = line.appendChild(document.createElement("div"));
    strip.className = "phases";
    strip.style.background = `linear-gradient(to right, ${stops.join(", ")}, transparent ${share(m.last)}%)`;
    strip.title = m.phases.map(([t, kind]) => (kind ? "slipping" : "rolling") + " from " + clock(t)).join(", ");
    strip.role = "img";
    strip.ariaLabel = (m.label ? m.label + ": " : "") + strip.title;
  }
}
