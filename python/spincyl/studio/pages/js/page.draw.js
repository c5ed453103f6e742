// Draws one motion: camera, table, path, shadow, body and arrows.

// an additional arrow: the velocity of the centre
ARROWS.push("velocity");
letters.velocity = "v";
fastest.velocity = 1e-9;
// a pose with this velocity, from poses a moment apart
function moving(m, t) {
  const p = pose(m, t), h = 1e-4 / (1 + Math.hypot(...p.omega)), within = x => Math.min(Math.max(x, m.first), m.last), [a, b] = [-h, h].map(d => within(within(t) + d));
  p.velocity = b > a ? [pose(m, b).centre, pose(m, a).centre].reduce((x, y) => along([1 / (b - a), x], [-1 / (b - a), y])) : [0, 0, 0];
  return p;
}

// half the height that the camera must show at its first elevation, where nearer parts look larger
const held = (reach, top) => 1.06 * Math.max((0.52 + 0.26) * reach + 0.38 * top, 0.44 * reach + 0.57 * top);
// the contact path as a ribbon through poses at ascending times, and the extent that the camera must show
function trace(m, times, poses) {
  const box = [[Infinity, Infinity], [-Infinity, -Infinity]];
  let top = 0;
  poses.forEach((p, i) => {
    top = Math.max(top, 2 * p.centre[2]);
    for (const k of [0, 1]) {
      box[0][k] = Math.min(box[0][k], p.centre[k]);
      box[1][k] = Math.max(box[1][k], p.centre[k]);
    }
    if (i && times[i] > times[i - 1]) p.velocity = along([1, p.centre], [-1, poses[i - 1].centre]).map(x => x / (times[i] - times[i - 1]));
    for (const v of ARROWS) fastest[v] = Math.max(fastest[v], Math.hypot(...p[v] || [0]));
  });
  m.at = m.middle = [0, 1].map(k => (box[0][k] + box[1][k]) / 2).concat(0.45 * top);
  m.reach = Math.hypot(box[1][0] - box[0][0], box[1][1] - box[0][1]) / 2 + Math.hypot(1, m.ell);
  m.half = held(m.reach, top);
  const ribbon = [];
  poses.forEach(({ contact: p }, i) => {
    const a = poses[Math.max(0, i - 1)].contact, b = poses[Math.min(poses.length - 1, i + 1)].contact;
    const d = [b[0] - a[0], b[1] - a[1]], n = (m.wide || 0.008 * m.reach) / (Math.hypot(...d) || 1);
    ribbon.push(p[0] - n * d[1], p[1] + n * d[0], 0.004, p[0] + n * d[1], p[1] - n * d[0], 0.004);
  });
  // `runs`: index from which each colour applies
  m.path = { ...mesh(ribbon, null, null, m.path), times, runs: m.runs?.(times) || [[0, "trace"]] };
}

// labels of a motion on the stage: its name, its clock, the letters at its arrows
function panelled(m) {
  const make = (kind, name, text = "") => Object.assign(m.panel.appendChild(document.createElement(kind)), { className: name, textContent: text });
  m.panel = stage.appendChild(document.createElement("div"));
  m.panel.className = "panel";
  make("b", "", m.label);
  m.clock = make("output", "clock");
  m.clock.setAttribute("aria-live", "off");
  m.tips = Object.fromEntries(ARROWS.map(v => [v, make("i", "tip " + v, letters[v])]));
  for (const name of POINTS) m.tips[name] = make("i", "tip", name);
  for (const v in m.tips) m.tips[v].ariaHidden = true; // screen readers get this from the switches
}

// the same distance for all motions, so that sizes can be compared
let reach, half;
const measured = () => { reach = Math.max(...motions.map(m => m.reach)); half = Math.max(...motions.map(m => m.half)); };

// ---- camera: turned by azimuth and elevation about the middle of the path

const eye = { azimuth: -1.1, elevation: 0.55, zoom: 1 };

function camera(m, aspect, flat) {
  const elevation = flat ? Math.PI / 2 : eye.elevation, azimuth = flat ? -Math.PI / 2 : eye.azimuth;
  const [ce, se, ca, sa] = [Math.cos(elevation), Math.sin(elevation), Math.cos(azimuth), Math.sin(azimuth)];
  const back = [ce * ca, ce * sa, se], right = [-sa, ca, 0], up = cross(back, right);
  const whole = Math.max(flat ? 1.08 * reach : half, 1.12 * reach / aspect), high = whole / eye.zoom;
  // zooming narrows the angle of view, so that the camera never enters the body
  const d = whole / Math.tan(0.3), f = d / high, near = 0.02 * d, far = d + 30 * reach;
  m.from = along([1, m.at], [flat ? 1e3 * d : d, back]);
  const rows = [right, up, back].map((v, i) => [...v, -dot(v, m.at) - (i === 2 ? d : 0)]);
  const p = flat // orthographic
    ? [rows[0].map(x => x / high / aspect), rows[1].map(x => x / high), rows[2].map((x, i) => (-2 * x - (i === 3 ? far + near : 0)) / (far - near)), [0, 0, 0, 1]]
    : [rows[0].map(x => x * f / aspect), rows[1].map(x => x * f), rows[2].map((x, i) => -x * (far + near) / (far - near) - (i === 3 ? 2 * far * near / (far - near) : 0)), rows[2].map(x => -x)];
  return [0, 1, 2, 3].flatMap(k => p.map(row => row[k]));
}

// position of a laboratory point on a panel of this width and height, from its top left corner
function project(m, place, width, height) {
  const c = camera(m, width / height, $("above").checked), at = k => [...place, 1].reduce((sum, x, j) => sum + c[4 * j + k] * x, 0);
  return [width * (at(0) / at(3) + 1) / 2, height * (1 - at(1) / at(3)) / 2];
}

// ---- a frame of one motion

// the style sheet defines the colours
function paints() {
  const style = getComputedStyle(document.documentElement), paint = { shadow: dusk.matches ? 0.45 : 0.24 };
  for (const name of ["paper", "ink", "ground", "grid", "trace", ...ARROWS]) {
    const text = style.getPropertyValue("--" + name).trim();
    paint[name] = [1, 3, 5].map(i => parseInt(text.slice(i, i + 2), 16) / 255);
  }
  return paint;
}
// after the end of a motion, colours lose most of their hue
const faded = colour => { const grey = 0.42 + 0.3 * dot(colour, [0.3, 0.59, 0.11]); return colour.map(x => 0.06 * x + 0.94 * grey); };

// the note about a motion after its last time, before its first, or at its end; else null
const note = (m, t) => t > m.after.at || m.after.event && t >= m.after.at ? m.after : t < m.before.at || m.before.event && t <= m.before.at ? m.before : null;

// direction, length and width of an arrow, or null; omega is shorter and wider than L, so that both show
// where parallel
function arrowOf(p, v) {
  const size = Math.hypot(...p[v]), [long, wide] = v === "momentum" ? [0.8, 0.85] : [0.64, 1.3], length = long * half * size / fastest[v];
  return $(v).checked && size > 1e-9 ? { along: p[v].map(x => x / size), length, wide: wide * length, root: p.centre } : null;
}

// the contact point, the centre, and the point opposite to the contact point
const POINTS = ["P", "C", "O"], opposite = p => [p.contact, p.centre, along([2, p.centre], [-1, p.contact])];
// rods with colour, root, direction, width, length and shape: the line through these points, with a bead at each, and
// the instantaneous axis, a little longer; the velocity of its points is along the axis, or zero
function rods(p) {
  if (!$("axis").checked) return [];
  const places = opposite(p), way = along([1, p.centre], [-1, p.contact]), long = Math.hypot(...way), square = dot(p.omega, p.omega), line = way.map(x => x / long), thick = 0.006 * half;
  const found = [["ink", p.contact, line, thick, 2 * long, rod], ...places.map(place => ["ink", place, line, 2.4 * thick, 2.4 * thick, bead])];
  if (square > 1e-18) {
    const on = along([1, p.centre], [1 / square, cross(p.omega, p.velocity)]), turns = p.omega.map(x => x / (dot(p.omega, way) < 0 ? -1 : 1) / Math.sqrt(square));
    found.push(["omega", along([1, on], [dot(along([1, p.contact], [-1, on]), turns) - 0.35 * long, turns]), turns, 0.6 * thick, 2.7 * long, rod]);
  }
  return found;
}

const MATT = 0.99;
function fill(piece, model, colour, lit = 1) {
  gl.uniformMatrix4fv(surface.model, false, model);
  gl.uniform4fv(surface.colour, colour.length === 4 ? colour : [...colour, 1]);
  gl.uniform1f(surface.lit, lit);
  piece.bind();
  gl.drawElements(gl.TRIANGLES, piece.count, gl.UNSIGNED_SHORT, 0);
}

// projections onto the table along the light from several points of a round lamp, whose overlapping shadows
// are soft
const LAMPS = Array.from({ length: 6 }, (_, k) => {
  const far = 0.15 * Math.sqrt((k + 0.5) / 6), way = 2.4 * k;
  return [1, 0, 0, 0, 0, 1, 0, 0, 0.36 + far * Math.cos(way), 0.4 + far * Math.sin(way), 0, 0, 0, 0, 0.002, 1];
});
const times4 = (a, b) => b.map((_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * k + i % 4] * b[4 * (i >> 2) + k], 0));
const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

// replaced where a table turns: the camera and the middle of its lines
function laid(m, t, view) { return [view, m.at]; }

function draw(m, t, aspect) {
  const paint = paints(), p = moving(m, t);
  m.at = aim(m, p);
  const view = camera(m, aspect, $("above").checked), shade = note(m, t) ? faded : colour => colour;
  gl.clearColor(...paint.paper, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  gl.enable(gl.CULL_FACE);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  const [lines, middle] = laid(m, t, view);
  gl.useProgram(table.made);
  gl.uniformMatrix4fv(table.camera, false, lines);
  gl.uniform3fv(table.at, middle);
  gl.uniform1f(table.far, 4 * reach);
  gl.uniform1f(table.cell, reach > 12 ? 5 : 1);
  gl.uniform3fv(table.ground, paint.ground);
  gl.uniform3fv(table.line, paint.grid);
  quad.bind();
  gl.depthMask(false);
  gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  gl.useProgram(surface.made);
  gl.uniformMatrix4fv(surface.camera, false, view);
  gl.uniform3fv(surface.eye, m.from);
  gl.disable(gl.CULL_FACE);
  if ($("path").checked) {
    gl.uniformMatrix4fv(surface.model, false, identity);
    gl.uniform1f(surface.lit, 0);
    m.path.bind();
    const upTo = t >= m.last ? m.path.times.length : knot(t, m.path.times) + 1;
    m.path.runs.forEach(([from, colour], i, runs) => {
      gl.uniform4fv(surface.colour, [...paint[colour], 1]);
      gl.drawArrays(gl.TRIANGLE_STRIP, 2 * from, 2 * Math.max(0, Math.min(upTo, runs[i + 1] ? runs[i + 1][0] + 1 : upTo) - from));
    });
  }
  gl.useProgram(shadow.made);
  gl.uniformMatrix4fv(shadow.camera, false, view);
  gl.uniform1f(shadow.dark, 1 - (1 - paint.shadow) ** (1 / LAMPS.length));
  gl.enable(gl.CULL_FACE); // half of a closed surface casts its whole shadow
  gl.enable(gl.STENCIL_TEST); // the shadow of each lamp point darkens a pixel only once
  gl.stencilOp(gl.KEEP, gl.KEEP, gl.REPLACE);
  LAMPS.forEach((flatten, k) => {
    gl.stencilFunc(gl.NOTEQUAL, k + 1, 255);
    gl.uniformMatrix4fv(shadow.model, false, times4(flatten, p.matrix));
    for (const piece of shapes[m.shape]) if (piece.cast) { piece.cast.bind(); gl.drawElements(gl.TRIANGLES, piece.cast.count, gl.UNSIGNED_SHORT, 0); }
  });
  gl.disable(gl.STENCIL_TEST);
  gl.depthMask(true);
  gl.useProgram(surface.made);
  for (const piece of shapes[m.shape]) fill(piece, p.matrix, shade(piece.colour), piece.edge ? 0 : piece.mark ? MATT : 1);
  gl.clear(gl.DEPTH_BUFFER_BIT); // arrows and rods show through the body
  const placed = (root, e3, wide, length) => {
    const any = Math.abs(e3[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0], e1 = cross(any, e3), n = wide / Math.hypot(...e1), e2 = cross(e3, e1);
    return [...e1.map(x => x * n), 0, ...e2.map(x => x * n), 0, ...e3.map(x => x * length), 0, ...root, 1];
  };
  for (const [colour, root, way, wide, long, shape] of rods(p)) fill(shape, placed(root, way, wide, long), paint[colour], MATT);
  for (const v of ARROWS) {
    const a = arrowOf(p, v);
    if (!a) continue;
    const model = placed(a.root, a.along, a.wide, a.length);
    // only back faces of the halo: a rim in the colour of the paper, visible on any ground
    gl.cullFace(gl.FRONT);
    fill(halo, model, paint.paper, 0);
    gl.cullFace(gl.BACK);
    fill(arrow, model, paint[v], MATT);
  }
}
