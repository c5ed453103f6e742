// Bodies that leave the table, lie on both rims or stand on a face: their height, the lower rim and its path, the forces on the other
// rim, names of phases. Pages without them omit this file. It comes after page.slip.js and replaces some of its functions.

const KINDS = ["rolling", "slipping", "flying", "lying", "pivoting", "rolling on its side", "rolling round its apex", "on its face"], FLIES = 2, ON_FACE = 7;
const rubbed = kind => [1, 3, 4, ON_FACE].includes(kind);
for (const m of motions) if (m.aloft) {
  m.now = t => m.phases.findLast(([begin], i) => begin <= t || i === 0);
  // only times on the table have a path, and the paths of the two rims are not connected
  m.runs = times => {
    const runs = m.phases.map(([begin, kind, rim], i, all) => [
      begin > m.first ? knot(begin, times) + (i && (all[i - 1][1] === FLIES || all[i - 1][2] !== rim || (all[i - 1][1] === ON_FACE) !== (kind === ON_FACE))) : 0,
      rubbed(kind) ? "friction" : "trace", all[i + 1] ? knot(all[i + 1][0], times) : times.length, kind,
    ]).filter(run => run[3] !== FLIES);
    return { forEach: f => runs.forEach(([from, colour, to]) => f([from, colour], 0, [0, [to]])) };
  };
  const presses = Array.from({ length: 999 }, (_, i) => m.rubs(m.first + (m.last - m.first) * i / 998)[4]).filter(n => n > 1e-3).sort((a, b) => a - b);
  m.press = presses[presses.length >> 1] || 1; // the median of N where there is one
  if (m.others) {
    const whole = new Uint16Array(bytes(m.others)), n = whole.length / 3;
    m.beside = t => { const i = Math.round(Math.min(Math.max((t - m.first) / (m.last - m.first), 0), 1) * (n - 1)); return m.least.map((low, k) => low + (m.largest[k] - low) * (whole[3 * i + k] / 0xffff)); };
  }
}

// the numbers of a stone end with the height of its centre
function ofStoneAloft(m, t, p) {
  const [[, , , , , , z]] = interpolate(m, t), [, kind] = m.now(t), height = kind === FLIES ? Math.max(0, z - p.centre[2]) : 0;
  p.centre[2] = p.matrix[14] = p.centre[2] + height;
  Object.assign(p, { kind, height, top: p.centre[2] + Math.hypot(1, m.ell) });
  if (kind === FLIES) p.normal = p.friction = [0, 0, 0];
  return p;
}

const ofTheLowerRim = pose;
pose = (m, t) => {
  const p = ofTheLowerRim(m, t), none = [0, 0, 0];
  Object.assign(p, { normal2: none, friction2: none });
  if (!m.aloft) return p;
  if (m.axes) return ofStoneAloft(m, t, p);
  // theta continues beyond the poles, and refers to the first rim
  const [[theta, , , x, y, z]] = interpolate(m, t), [, kind, other] = m.now(t), ell = m.depth ?? m.ell, round = m.fillet || 0;
  const c = Math.cos(theta), s = Math.abs(Math.sin(theta)), [cp, sp] = [Math.cos(p.phi), Math.sin(p.phi)], side = Math.sin(theta) < 0 ? -1 : 1;
  const below = rim => { const off = side * (rim * ell * s - (1 - round) * c); return [x + off * cp, y + off * sp, 0]; };
  // a body on the table stands on it, and one in the air is not below it
  const low = round + ell * (m.two ? Math.abs(c) : other ? -c : c) + (1 - round) * s, height = kind === FLIES ? Math.max(0, z - low) : 0;
  p.centre[2] = p.matrix[14] = low + height;
  Object.assign(p, { kind, height, theta: Math.acos(other ? -c : c), contact: below(other ? -1 : 1), top: low + height + m.ell * Math.abs(c) + s });
  if (kind === FLIES) p.normal = p.friction = none;
  // the path is that of the centre, and the force stands where the pressure has its centre
  if (kind === ON_FACE) Object.assign(p, { stands: true, contact: [x, y, 0] });
  if (kind > FLIES && kind !== ON_FACE && m.beside) {
    const [f, g, n] = m.beside(t);
    Object.assign(p, { normal2: [0, 0, n], friction2: [cp * f - sp * g, sp * f + cp * g, 0], contact2: below(other ? 1 : -1) });
  }
  return p;
};

// arrows on the lower rim as well
ARROWS.push("normal2", "friction2");
Object.assign(letters, { normal2: "N", friction2: "F" });
Object.assign(fastest, { normal2: 0, friction2: 0 });
const ofOneRim = arrowOf;
arrowOf = (p, v) => !v.endsWith("2") ? ofOneRim(p, v) : p.contact2 ? ofOneRim({ ...p, normal: p.normal2, friction: p.friction2, contact: p.contact2 }, v.slice(0, -1)) : null;

// the view has room for the highest position; high above the table the shadows from few points of the lamp would separate
const onTheTable = trace, MORE = 24;
trace = (m, times, poses) => {
  onTheTable(m, times, poses);
  for (let k = 0; k < MORE; k++) {
    const far = 0.15 * Math.sqrt((k + 0.5) / MORE), way = 2.4 * k;
    LAMPS[k] = Object.assign([...LAMPS[0]], { 8: 0.36 + far * Math.cos(way), 9: 0.4 + far * Math.sin(way) });
  }
  if (!m.aloft) return;
  const top = Math.max(...poses.map(p => p.top));
  m.middle[2] = 0.45 * top;
  m.half = held(m.reach, top);
};

const ofContact = doing;
doing = (m, p) => {
  if (!m.aloft) return ofContact(m, p);
  const number = (x, unit, sign) => ` ${rounded(x * unit)} ${sign}`;
  const told = p.kind === FLIES ? number(p.height, data.metre, data.lengths) + " high" : p.kind === 1 ? number(p.speed, data.speed, data.speeds) : "";
  return "\n" + (KINDS[p.kind] + told).replaceAll(" ", "\u00a0");
};

motions.filter(m => m.phases).forEach((m, i) => {
  if (!m.aloft) return;
  const strip = document.querySelectorAll(".phases")[i], share = t => 100 * Math.min(Math.max((t - first) / (last - first), 0), 1);
  const stops = m.phases.flatMap(([t, kind], i) => {
    const colour = kind === FLIES ? "transparent" : rubbed(kind) ? "var(--friction)" : "var(--trace)";
    return [t, m.phases[i + 1]?.[0] ?? m.last].map(at => `${colour} ${share(at)}%`);
  });
  strip.style.background = `linear-gradient(to right, ${stops.join(", ")}, transparent ${share(m.last)}%)`;
  strip.title = m.told.map(([t, kind, many]) => KINDS[kind] + (many ? many > 1 ? `, ${many} impacts,` : ", an impact," : "") + " from " + clock(t)).join(", ");
  strip.ariaLabel = (m.label ? m.label + ": " : "") + strip.title;
});
document.querySelector("details p").append(" In the air there is no path and no force, and the line under the slider has a gap.");
