// One picture of one motion, from the shaders to the arrows.

function program(vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, "#version 300 es\nprecision highp float;\n" + text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.bindAttribLocation(made, 0, "place");
  gl.bindAttribLocation(made, 1, "normal");
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw Error(gl.getProgramInfoLog(made));
  return new Proxy({ made }, { get: (o, name) => name in o ? o[name] : (o[name] = gl.getUniformLocation(made, name)) });
}

const surface = program(
  `in vec3 place, normal; uniform mat4 camera, model; out vec3 n;
   void main() { n = mat3(model) * normal; gl_Position = camera * (model * vec4(place, 1.0)); }`,
  `in vec3 n; uniform vec4 colour; uniform float lit; out vec4 o;
   void main() { vec3 m = normalize(n);
     float light = mix(1.0, 0.52 + 0.16 * m.z + 0.36 * max(dot(m, normalize(vec3(-0.45, -0.5, 0.75))), 0.0), lit);
     o = vec4(colour.rgb * light, colour.a); }`);
const table = program(
  `in vec3 place; uniform mat4 camera; uniform vec3 at; uniform float far; out vec2 p;
   void main() { p = at.xy + far * place.xy; gl_Position = camera * vec4(p, 0.0, 1.0); }`,
  `in vec2 p; uniform vec3 ground, line, at; uniform float far, cell; out vec4 o;
   void main() { vec2 q = p / cell, w = fwidth(q), g = abs(fract(q - 0.5) - 0.5) / w;
     float on = (1.0 - min(min(g.x, g.y), 1.0)) * clamp(0.6 - max(w.x, w.y), 0.0, 1.0);
     o = vec4(mix(ground, line, on), 1.0 - smoothstep(0.5, 1.0, length(p - at.xy) / far)); }`);
const screen = `in vec3 place; out vec2 p; void main() { p = 0.5 * place.xy + 0.5; gl_Position = vec4(place.xy, 0.0, 1.0); }`;
const adding = program(screen, `in vec2 p; uniform sampler2D sum, frame; out vec4 o; void main() { o = texture(sum, p) + texture(frame, p); }`);
const developing = program(screen,
  `in vec2 p; uniform sampler2D sum; uniform float gain; out vec4 o;
   void main() { o = vec4(1.0 - exp(-gain * texture(sum, p).rgb), 1.0); }`);

function mesh(places, normals, triangles) {
  const vao = gl.createVertexArray();
  gl.bindVertexArray(vao);
  [places, normals].forEach((values, i) => {
    if (!values) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.STATIC_DRAW);
    gl.enableVertexAttribArray(i);
    gl.vertexAttribPointer(i, 3, gl.FLOAT, false, 0, 0);
  });
  if (triangles) {
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
  }
  return { vao, count: triangles ? triangles.length : places.length / 3 };
}

// the surface that a polygon of radius and height sweeps, outside on the right of its direction; round at any size
function lathe(corners, around = 256) {
  const places = [], normals = [], triangles = [];
  corners.slice(1).forEach(([r1, z1], k) => {
    const [r0, z0] = corners[k], length = Math.hypot(r1 - r0, z1 - z0), base = places.length / 3;
    for (let i = 0; i <= around; i++) {
      const c = Math.cos(2 * Math.PI * i / around), s = Math.sin(2 * Math.PI * i / around), n = [(z1 - z0) / length * c, (z1 - z0) / length * s, (r0 - r1) / length];
      places.push(r0 * c, r0 * s, z0, r1 * c, r1 * s, z1);
      normals.push(...n, ...n);
      const j = base + 2 * i;
      if (i < around) triangles.push(j, j + 2, j + 1, j + 2, j + 3, j + 1);
    }
  });
  return mesh(places, normals, new Uint16Array(triangles));
}
const shapes = data.shapes.map(({ turned, marks }) => [
  ...turned.map(p => ({ ...lathe(p.corners), colour: p.colour })),
  ...marks.map(p => ({
    ...mesh(Array.from(new Int16Array(bytes(p.v)), x => x * p.unit), Array.from(new Int8Array(bytes(p.n)), x => x / 127), new Uint16Array(bytes(p.i))),
    colour: p.colour, mark: true,
  })),
]);
// of an arrow along z, in its length: shaft and head; and its halo, a little larger
const [arrow, halo] = [0, 0.011].map(d => lathe([[0, -d], [0.016 + d, -d], [0.016 + d, 0.86 - d], [0.045 + 1.7 * d, 0.86 - d], [0, 1 + 3 * d]], 48));
gl.vertexAttrib3f(1, 0, 0, 1); // what has no normals lies on the table
const quad = mesh([-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0]);

// what the camera sees of the near side from its first elevation, nearer things being larger
const held = (reach, top) => 1.06 * Math.max((0.41 + 0.28) * reach + 0.41 * top, 0.35 * reach + 0.6 * top);
// the contact path as a ribbon, and what the camera must hold
for (const m of motions) {
  const times = [], points = [];
  const turns = i => Math.abs(m.y[5 * i + 6] - m.y[5 * i + 1]) + Math.abs(m.y[5 * i + 7] - m.y[5 * i + 2]);
  const rounds = m.again ? Math.ceil((m.last - m.first) / m.again.period) : 1;
  let whole = 0;
  for (let i = 0; i + 1 < m.t.length; i++) whole += turns(i) + 0.3;
  const fine = Math.max(0.1, rounds * whole / 40000);
  for (let r = 0; r < rounds; r++) for (let i = 0; i + 1 < m.t.length; i++) {
    const n = Math.ceil((turns(i) + 0.3) / fine);
    for (let k = 0; k < n; k++) {
      const t = m.t[i] + (m.t[i + 1] - m.t[i]) * k / n + (r && r * m.again.period);
      if (t < m.last) times.push(t);
    }
  }
  times.push(m.last);
  const box = [[Infinity, Infinity], [-Infinity, -Infinity]];
  let top = 0;
  for (const t of times) {
    const p = pose(m, t);
    points.push(p.contact);
    top = Math.max(top, 2 * p.centre[2]);
    for (const k of [0, 1]) {
      box[0][k] = Math.min(box[0][k], p.centre[k]);
      box[1][k] = Math.max(box[1][k], p.centre[k]);
    }
    for (const v of ARROWS) fastest[v] = Math.max(fastest[v], Math.hypot(...p[v]));
  }
  m.at = m.middle = [0, 1].map(k => (box[0][k] + box[1][k]) / 2).concat(0.45 * top);
  m.reach = Math.hypot(box[1][0] - box[0][0], box[1][1] - box[0][1]) / 2 + Math.hypot(1, m.ell);
  m.half = held(m.reach, top);
  const ribbon = [];
  points.forEach((p, i) => {
    const a = points[Math.max(0, i - 1)], b = points[Math.min(points.length - 1, i + 1)];
    const d = [b[0] - a[0], b[1] - a[1]], n = (m.wide || 0.008 * m.reach) / (Math.hypot(...d) || 1);
    ribbon.push(p[0] - n * d[1], p[1] + n * d[0], 0.004, p[0] + n * d[1], p[1] - n * d[0], 0.004);
  });
  m.path = { ...mesh(ribbon), times, runs: m.runs?.(times) || [[0, "trace"]] }; // places from which it has a colour
  const make = (kind, name, text = "") => Object.assign(m.panel.appendChild(document.createElement(kind)), { className: name, textContent: text });
  m.panel = stage.appendChild(document.createElement("div"));
  m.panel.className = "panel";
  make("b", "", m.label);
  m.clock = make("output", "clock");
  m.clock.setAttribute("aria-live", "off");
  m.tips = Object.fromEntries(ARROWS.map(v => [v, make("i", "tip " + v, letters[v])]));
  for (const v of ARROWS) m.tips[v].ariaHidden = true; // the switches say what is drawn
}

// one distance for all, so that sizes can be compared
let reach = Math.max(...motions.map(m => m.reach)), half = Math.max(...motions.map(m => m.half));

// ---- camera: turned by azimuth and elevation about the middle of the path

const eye = { azimuth: -1.1, elevation: 0.42, zoom: 1 };
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

function camera(m, aspect, flat) {
  const elevation = flat ? Math.PI / 2 : eye.elevation, azimuth = flat ? -Math.PI / 2 : eye.azimuth;
  const [ce, se, ca, sa] = [Math.cos(elevation), Math.sin(elevation), Math.cos(azimuth), Math.sin(azimuth)];
  const back = [ce * ca, ce * sa, se], right = [-sa, ca, 0], up = cross(back, right);
  const whole = Math.max(flat ? 1.08 * reach : half, 1.12 * reach / aspect), high = whole / eye.zoom;
  // to zoom is to narrow the view, so that the camera never enters the body
  const d = whole / Math.tan(0.3), f = d / high, near = 0.02 * d, far = d + 30 * reach;
  const rows = [right, up, back].map((v, i) => [...v, -dot(v, m.at) - (i === 2 ? d : 0)]);
  const p = flat // without perspective, as a camera far above
    ? [rows[0].map(x => x / high / aspect), rows[1].map(x => x / high), rows[2].map((x, i) => (-2 * x - (i === 3 ? far + near : 0)) / (far - near)), [0, 0, 0, 1]]
    : [rows[0].map(x => x * f / aspect), rows[1].map(x => x * f), rows[2].map((x, i) => -x * (far + near) / (far - near) - (i === 3 ? 2 * far * near / (far - near) : 0)), rows[2].map(x => -x)];
  return [0, 1, 2, 3].flatMap(k => p.map(row => row[k]));
}

// where a place of the laboratory is on a panel of this width and height, from its left upper corner
function project(m, place, width, height) {
  const c = camera(m, width / height, $("above").checked), at = k => [...place, 1].reduce((sum, x, j) => sum + c[4 * j + k] * x, 0);
  return [width * (at(0) / at(3) + 1) / 2, height * (1 - at(1) / at(3)) / 2];
}

// ---- one picture of one motion

const dusk = matchMedia("(prefers-color-scheme: dark)");
// the colours have their home in the style sheet
function paints() {
  const style = getComputedStyle(document.documentElement), paint = { shadow: dusk.matches ? 0.45 : 0.24 };
  for (const name of ["paper", "ground", "grid", "trace", ...ARROWS]) {
    const text = style.getPropertyValue("--" + name).trim();
    paint[name] = [1, 3, 5].map(i => parseInt(text.slice(i, i + 2), 16) / 255);
  }
  return paint;
}
// of a motion that has ended: what remains of a colour without its hue
const faded = colour => { const grey = 0.42 + 0.3 * dot(colour, [0.3, 0.59, 0.11]); return colour.map(x => 0.06 * x + 0.94 * grey); };

// what there is to say of a motion at a time outside of what is shown of it, or at its end
const note = (m, t) => t > m.after.at || m.after.event && t >= m.after.at ? m.after : t < m.before.at || m.before.event && t <= m.before.at ? m.before : null;

// direction, length and width of an arrow that is shown; both are seen where they are parallel
function arrowOf(p, v) {
  const size = Math.hypot(...p[v]), [long, wide] = v === "omega" ? [0.64, 1.3] : [0.8, 0.85], length = long * half * size / fastest[v];
  return $(v).checked && size > 1e-9 ? { along: p[v].map(x => x / size), length, wide: wide * length, root: p.centre } : null;
}

function fill(piece, model, colour, lit = 1) {
  gl.uniformMatrix4fv(surface.model, false, model);
  gl.uniform4fv(surface.colour, colour.length === 4 ? colour : [...colour, 1]);
  gl.uniform1f(surface.lit, lit);
  gl.bindVertexArray(piece.vao);
  gl.drawElements(gl.TRIANGLES, piece.count, gl.UNSIGNED_SHORT, 0);
}

const flatten = [1, 0, 0, 0, 0, 1, 0, 0, 0.45 / 0.75 * 0.6, 0.5 / 0.75 * 0.6, 0, 0, 0, 0, 0.002, 1]; // along the light, onto the table
const times4 = (a, b) => b.map((_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * k + i % 4] * b[4 * (i >> 2) + k], 0));
const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

function draw(m, t, aspect) {
  const paint = paints(), p = pose(m, t);
  m.at = aim(m, p);
  const view = camera(m, aspect, $("above").checked), shade = note(m, t) ? faded : colour => colour;
  gl.clearColor(...paint.paper, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  gl.enable(gl.CULL_FACE);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  gl.useProgram(table.made);
  gl.uniformMatrix4fv(table.camera, false, view);
  gl.uniform3fv(table.at, m.at);
  gl.uniform1f(table.far, 4 * reach);
  gl.uniform1f(table.cell, reach > 12 ? 5 : 1);
  gl.uniform3fv(table.ground, paint.ground);
  gl.uniform3fv(table.line, paint.grid);
  gl.bindVertexArray(quad.vao);
  gl.depthMask(false);
  gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  gl.useProgram(surface.made);
  gl.uniformMatrix4fv(surface.camera, false, view);
  gl.disable(gl.CULL_FACE);
  if ($("path").checked) {
    gl.uniformMatrix4fv(surface.model, false, identity);
    gl.uniform1f(surface.lit, 0);
    gl.bindVertexArray(m.path.vao);
    const upTo = t >= m.last ? m.path.times.length : knot(t, m.path.times) + 1;
    m.path.runs.forEach(([from, colour], i, runs) => {
      gl.uniform4fv(surface.colour, [...paint[colour], 1]);
      gl.drawArrays(gl.TRIANGLE_STRIP, 2 * from, 2 * Math.max(0, Math.min(upTo, runs[i + 1] ? runs[i + 1][0] + 1 : upTo) - from));
    });
  }
  gl.enable(gl.STENCIL_TEST); // the shadow darkens once
  gl.stencilFunc(gl.EQUAL, 0, 1);
  gl.stencilOp(gl.KEEP, gl.KEEP, gl.INCR);
  for (const piece of shapes[m.shape]) fill(piece, times4(flatten, p.matrix), [0, 0, 0, paint.shadow], 0);
  gl.disable(gl.STENCIL_TEST);
  gl.depthMask(true);
  gl.enable(gl.CULL_FACE);
  for (const piece of shapes[m.shape]) fill(piece, p.matrix, shade(piece.colour));
  gl.clear(gl.DEPTH_BUFFER_BIT); // arrows are seen through the body
  for (const v of ARROWS) {
    const a = arrowOf(p, v);
    if (!a) continue;
    const e3 = a.along, any = Math.abs(e3[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0], e1 = cross(any, e3), n = a.wide / Math.hypot(...e1), e2 = cross(e3, e1);
    const model = [...e1.map(x => x * n), 0, ...e2.map(x => x * n), 0, ...e3.map(x => x * a.length), 0, ...a.root, 1];
    gl.cullFace(gl.FRONT); // of the halo only what is behind: a rim in the colour of the paper, on whatever ground
    fill(halo, model, paint.paper, 0);
    gl.cullFace(gl.BACK);
    fill(arrow, model, paint[v]);
  }
}
