// Draws motions. What it knows of them are poses at knots, and how to interpolate between these.
"use strict";
(() => {
const $ = id => document.getElementById(id);
const data = JSON.parse($("data").textContent);
const canvas = $("canvas"), stage = $("stage");
const gl = canvas.getContext("webgl2", { antialias: true, stencil: true, alpha: false });
if (!gl) { $("missing").hidden = false; $("controls").hidden = true; return; }

// ---- poses

const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer;
const motions = data.motions.map(m => {
  const whole = new Uint32Array(bytes(m.knots)), off = new Int16Array(bytes(m.slopes)), n = whole.length / 6;
  const read = (i, k) => m.low[k] + (m.high[k] - m.low[k]) * (whole[6 * i + k] / 0xffffffff);
  const t = Array.from({ length: n }, (_, i) => read(i, 0)), y = [], slopes = [];
  for (let i = 0; i < n; i++) {
    const before = i ? t[i] - t[i - 1] : t[1] - t[0], after = i < n - 1 ? t[i + 1] - t[i] : before;
    for (let k = 1; k < 6; k++) { // a parabola's slope, and what it is off by
      const secant = j => (read(j + 1, k) - read(j, k)) / (t[j + 1] - t[j]);
      const rising = secant(Math.max(0, i - 1)), falling = secant(Math.min(n - 2, i));
      y.push(read(i, k));
      slopes.push((rising * after + falling * before) / (before + after) + off[5 * i + k - 1] / 32767 * m.most[k - 1] / Math.max(before, after));
    }
  }
  return { ...m, t, y, slopes };
});
const first = Math.min(...motions.map(m => m.first)), last = Math.max(...motions.map(m => m.last));

function knot(t, sorted) { // the interval that holds t
  let low = 0, high = sorted.length - 1;
  while (high - low > 1) { const mid = (low + high) >> 1; if (sorted[mid] <= t) low = mid; else high = mid; }
  return low;
}

// theta, phi, psi, x, y and their rates: the cubic between two knots
function interpolate(m, t) {
  t = Math.min(Math.max(t, m.first), m.last);
  const rounds = m.again ? Math.floor((t - m.first) / m.again.period) : 0;
  if (rounds) t -= rounds * m.again.period;
  const i = knot(t, m.t), h = m.t[i + 1] - m.t[i], s = (t - m.t[i]) / h, value = [], rate = [];
  for (let k = 0; k < 5; k++) {
    const j = 5 * i + k, y0 = m.y[j], y1 = m.y[j + 5], d0 = h * m.slopes[j], d1 = h * m.slopes[j + 5];
    const b = 3 * (y1 - y0) - 2 * d0 - d1, c = 2 * (y0 - y1) + d0 + d1;
    value.push(y0 + s * (d0 + s * (b + s * c)));
    rate.push((d0 + s * (2 * b + s * 3 * c)) / h);
  }
  if (rounds) { // each period is the last one, turned about the vertical and about the axis
    const { phi, psi, pivot, shift } = m.again, [c, s] = [Math.cos(rounds * phi), Math.sin(rounds * phi)];
    value[1] += rounds * phi;
    value[2] += rounds * psi;
    const [x, y] = pivot ? [value[3] - pivot[0], value[4] - pivot[1]] : value.slice(3);
    value[3] = pivot ? pivot[0] + c * x - s * y : x + rounds * shift[0];
    value[4] = pivot ? pivot[1] + s * x + c * y : y + rounds * shift[1];
  }
  return [value, rate];
}

const along = (...terms) => [0, 1, 2].map(k => terms.reduce((sum, [a, v]) => sum + a * v[k], 0));

// axes in the laboratory, the body's matrix, and how the drawn pose turns
function pose(m, t) {
  const [[theta, phi, psi, x, y], [tilting, turning, spinning]] = interpolate(m, t);
  const [s, c, sp, cp] = [Math.sin(theta), Math.cos(theta), Math.sin(phi), Math.cos(phi)];
  const e1 = [c * cp, c * sp, s], e2 = [-sp, cp, 0], e3 = [-s * cp, -s * sp, c];
  const b1 = along([Math.cos(psi), e1], [Math.sin(psi), e2]), b2 = along([-Math.sin(psi), e1], [Math.cos(psi), e2]);
  const rim = along([-1, e1], [-m.ell, e3]), centre = [x, y, -rim[2]]; // the rim touches the table
  const w = [turning * s, -tilting, turning * c + spinning];
  return {
    theta, phi, centre, contact: along([1, centre], [1, rim]),
    matrix: [...b1, 0, ...b2, 0, ...e3, 0, ...centre, 1],
    omega: along([w[0], e1], [w[1], e2], [w[2], e3]),
    momentum: along([m.i1 * w[0], e1], [m.i1 * w[1], e2], [m.i3 * w[2], e3]),
  };
}

// ---- what is drawn with

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
const part = p => ({
  ...mesh(Array.from(new Int16Array(bytes(p.v)), x => x * p.unit), Array.from(new Int8Array(bytes(p.n)), x => x / 127), new Uint16Array(bytes(p.i))),
  colour: p.colour, mark: p.name === "O" || p.name === "X",
});
const shapes = data.shapes.map(parts => parts.map(part)), arrow = part(data.arrow);
gl.vertexAttrib3f(1, 0, 0, 1); // what has no normals lies on the table
const quad = mesh([-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0]);

const fastest = { omega: 1e-9, momentum: 1e-9 };
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
    for (const v of ["omega", "momentum"]) fastest[v] = Math.max(fastest[v], Math.hypot(...p[v]));
  }
  m.middle = [0, 1].map(k => (box[0][k] + box[1][k]) / 2).concat(0.45 * top);
  m.reach = Math.hypot(box[1][0] - box[0][0], box[1][1] - box[0][1]) / 2 + Math.hypot(1, m.ell);
  // what the camera sees of the near side from its first elevation, nearer things being larger
  m.half = 1.06 * Math.max((0.41 + 0.28) * m.reach + 0.41 * top, 0.35 * m.reach + 0.6 * top);
  const ribbon = [];
  points.forEach((p, i) => {
    const a = points[Math.max(0, i - 1)], b = points[Math.min(points.length - 1, i + 1)];
    const d = [b[0] - a[0], b[1] - a[1]], n = 0.008 * m.reach / (Math.hypot(...d) || 1);
    ribbon.push(p[0] - n * d[1], p[1] + n * d[0], 0.004, p[0] + n * d[1], p[1] - n * d[0], 0.004);
  });
  m.path = { ...mesh(ribbon), times };
  m.panel = stage.appendChild(document.createElement("div"));
  m.panel.className = "panel";
  m.panel.append(document.createElement("b"), document.createElement("span"));
  m.panel.firstChild.textContent = m.label;
}

// one distance for all, so that sizes can be compared
const reach = Math.max(...motions.map(m => m.reach)), half = Math.max(...motions.map(m => m.half));

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
  const rows = [right, up, back].map((v, i) => [...v, -dot(v, m.middle) - (i === 2 ? d : 0)]);
  const p = flat // without perspective, as a camera far above
    ? [rows[0].map(x => x / high / aspect), rows[1].map(x => x / high), rows[2].map((x, i) => (-2 * x - (i === 3 ? far + near : 0)) / (far - near)), [0, 0, 0, 1]]
    : [rows[0].map(x => x * f / aspect), rows[1].map(x => x * f), rows[2].map((x, i) => -x * (far + near) / (far - near) - (i === 3 ? 2 * far * near / (far - near) : 0)), rows[2].map(x => -x)];
  return [0, 1, 2, 3].flatMap(k => p.map(row => row[k]));
}

// ---- one picture of one motion

const dusk = matchMedia("(prefers-color-scheme: dark)");
const rgb = text => [1, 3, 5].map(i => parseInt(text.slice(i, i + 2), 16) / 255);
const paints = () => dusk.matches
  ? { sky: rgb("#16181c"), ground: rgb("#23272e"), line: rgb("#3d444f"), path: rgb("#8b95a5"), omega: rgb("#f0894d"), momentum: rgb("#62b3f2"), shadow: 0.45 }
  : { sky: rgb("#f6f4ef"), ground: rgb("#e9e5db"), line: rgb("#cfc9ba"), path: rgb("#6d7480"), omega: rgb("#b3541e"), momentum: rgb("#0a6ebd"), shadow: 0.24 };

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
  const paint = paints(), p = pose(m, t), view = camera(m, aspect, $("above").checked);
  gl.clearColor(...paint.sky, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  gl.enable(gl.CULL_FACE);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  gl.useProgram(table.made);
  gl.uniformMatrix4fv(table.camera, false, view);
  gl.uniform3fv(table.at, m.middle);
  gl.uniform1f(table.far, 4 * reach);
  gl.uniform1f(table.cell, reach > 12 ? 5 : 1);
  gl.uniform3fv(table.ground, paint.ground);
  gl.uniform3fv(table.line, paint.line);
  gl.bindVertexArray(quad.vao);
  gl.depthMask(false);
  gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  gl.useProgram(surface.made);
  gl.uniformMatrix4fv(surface.camera, false, view);
  gl.disable(gl.CULL_FACE);
  if ($("path").checked) {
    gl.uniformMatrix4fv(surface.model, false, identity);
    gl.uniform4fv(surface.colour, [...paint.path, 1]);
    gl.uniform1f(surface.lit, 0);
    gl.bindVertexArray(m.path.vao);
    const upTo = t >= m.last ? m.path.times.length : knot(t, m.path.times) + 1;
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 2 * upTo);
  }
  gl.enable(gl.STENCIL_TEST); // the shadow darkens once
  gl.stencilFunc(gl.EQUAL, 0, 1);
  gl.stencilOp(gl.KEEP, gl.KEEP, gl.INCR);
  for (const piece of shapes[m.shape]) fill(piece, times4(flatten, p.matrix), [0, 0, 0, paint.shadow], 0);
  gl.disable(gl.STENCIL_TEST);
  gl.depthMask(true);
  gl.enable(gl.CULL_FACE);
  for (const piece of shapes[m.shape]) fill(piece, p.matrix, piece.colour);
  gl.clear(gl.DEPTH_BUFFER_BIT); // arrows are seen through the body
  for (const v of ["omega", "momentum"]) {
    const length = Math.hypot(...p[v]);
    if (!$(v).checked || length < 1e-9) continue;
    const e3 = p[v].map(x => x / length), any = Math.abs(e3[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
    // of different lengths and widths, so that both are seen where they are parallel
    const [long, wide] = v === "omega" ? [0.64, 1.3] : [0.8, 0.85];
    const e1 = cross(any, e3), k = long * half * length / fastest[v], n = Math.hypot(...e1) / wide, e2 = cross(e3, e1);
    fill(arrow, [...e1.map(x => x * k / n), 0, ...e2.map(x => x * k / n), 0, ...e3.map(x => x * k), 0, ...p.centre, 1], paint[v]);
  }
}

// ---- long exposure: the sum of many pictures in a dark room

const exposing = { canFloat: gl.getExtension("EXT_color_buffer_float"), count: 0, most: 720, gain: 1, targets: null };
$("shutter").disabled = !exposing.canFloat;

function target(width, height, kind) {
  const texture = gl.createTexture(), buffer = gl.createFramebuffer();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, kind, width, height);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  gl.bindFramebuffer(gl.FRAMEBUFFER, buffer);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  let depth = null;
  if (kind === gl.RGBA8) {
    depth = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
  }
  gl.clearColor(0, 0, 0, 1);
  gl.clear(gl.COLOR_BUFFER_BIT);
  return { texture, buffer, depth };
}

function forget() {
  for (const t of exposing.targets || []) {
    gl.deleteTexture(t.texture);
    gl.deleteFramebuffer(t.buffer);
    if (t.depth) gl.deleteRenderbuffer(t.depth);
  }
  exposing.targets = null;
  exposing.count = 0;
}

// when the body has turned so often from t on, at most the end
function closing(m, t, turns) {
  const end = m.last;
  if (turns === Infinity || t >= end) return end;
  const from = pose(m, t).phi, turned = x => Math.abs(pose(m, x).phi - from) - 2 * Math.PI * turns;
  let high = t, step = (end - t) / 4096;
  while (turned(high) < 0) { high += step; if (high >= end) return end; }
  let low = high - step;
  for (let i = 0; i < 50; i++) { const mid = (low + high) / 2; if (turned(mid) < 0) low = mid; else high = mid; }
  return high;
}

function expose(views) {
  if (!exposing.targets) {
    exposing.targets = [target(canvas.width, canvas.height, gl.RGBA8), target(canvas.width, canvas.height, gl.RGBA32F), target(canvas.width, canvas.height, gl.RGBA32F)];
    const turns = Number($("shutter").value);
    for (const m of motions) m.shut = closing(m, now, turns);
  }
  const bind = (unit, texture) => { gl.activeTexture(gl.TEXTURE0 + unit); gl.bindTexture(gl.TEXTURE_2D, texture); };
  const until = performance.now() + 25;
  do {
    const [frame, sum, next] = exposing.targets, share = (0.5 + exposing.count * 0.6180339887498949) % 1;
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame.buffer);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.disable(gl.SCISSOR_TEST);
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.CULL_FACE);
    gl.clearColor(0, 0, 0, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(surface.made);
    for (const [m, x, y, w, h] of views) {
      gl.viewport(x, y, w, h);
      gl.uniformMatrix4fv(surface.camera, false, camera(m, w / h, true));
      const start = Math.min(now, m.last), p = pose(m, start + share * (m.shut - start));
      for (const piece of shapes[m.shape]) fill(piece, p.matrix, piece.mark ? piece.colour.map(c => Math.min(1, c * 1.15 + 0.12)) : [0.006, 0.006, 0.0065], piece.mark ? 0 : 1);
    }
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.CULL_FACE);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, next.buffer);
    gl.useProgram(adding.made);
    bind(0, sum.texture);
    bind(1, frame.texture);
    gl.uniform1i(adding.sum, 0);
    gl.uniform1i(adding.frame, 1);
    gl.bindVertexArray(quad.vao);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    exposing.targets = [frame, next, sum];
  } while (++exposing.count < exposing.most && performance.now() < until);
  if (exposing.count === exposing.most || exposing.count < 40) { // the brightest place sets the gain
    const light = new Float32Array(4 * canvas.width * canvas.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, exposing.targets[1].buffer);
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.FLOAT, light);
    let most = 0;
    for (let i = 0; i < light.length; i += 4) most = Math.max(most, light[i], light[i + 2]);
    exposing.gain = 2 * exposing.count / Math.max(most, 1e-3);
  }
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  gl.useProgram(developing.made);
  bind(0, exposing.targets[1].texture);
  gl.uniform1i(developing.sum, 0);
  gl.uniform1f(developing.gain, exposing.gain / exposing.count);
  gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  document.documentElement.dataset.exposed = exposing.count;
  return exposing.count < exposing.most;
}

// ---- the whole canvas

let now = first, playing = false, before = null, asked = false;
const show = () => { if (!asked) { asked = true; requestAnimationFrame(frame); } };
const speed = () => Number($("speed").value) / data.unit; // units of t in a second
const digits = Math.max(2, 4 - Math.floor(Math.log10(Math.max(1e-9, (last - first) * data.unit))));

function frame(at) {
  asked = false;
  if (playing) {
    // a picture's time may be earlier than the press that began the play: the first picture tells where to count from
    if (before !== null) now = Math.min(last, now + speed() * Math.min(0.25, Math.max(0, at - before) / 1000));
    if (now >= last) play(false);
  }
  before = at;
  const ratio = Math.min(2, devicePixelRatio || 1), width = Math.max(1, Math.round(stage.clientWidth * ratio)), height = Math.max(1, Math.round(stage.clientHeight * ratio));
  if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; forget(); }
  // as many columns as leave few places empty and panels of a good shape
  const cost = c => { const r = Math.ceil(motions.length / c); return 0.7 * (r * c - motions.length) + Math.abs(Math.log(width * r / height / c / 1.3)); };
  const columns = motions.map((_, i) => i + 1).reduce((a, b) => cost(b) < cost(a) ? b : a), rows = Math.ceil(motions.length / columns);
  const views = motions.map((m, i) => {
    const [c, r] = [i % columns, Math.floor(i / columns)], x = Math.round(c * width / columns), y = Math.round(r * height / rows);
    return [m, x, height - Math.round((r + 1) * height / rows), Math.round((c + 1) * width / columns) - x, Math.round((r + 1) * height / rows) - y, y];
  });
  const exposed = !playing && $("shutter").value !== "0";
  if (exposed) { if (expose(views)) show(); } else {
    forget();
    delete document.documentElement.dataset.exposed;
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(...paints().sky, 1);
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
    const over = now >= m.last, angle = "θ = " + (pose(m, now).theta * 180 / Math.PI).toFixed(2) + "°";
    m.panel.lastChild.textContent = over && m.end ? angle + ": " + m.end : angle;
  }
  $("time").value = now;
  $("clock").value = "t = " + (now * data.unit).toFixed(digits) + " " + data.symbol;
  $("time").setAttribute("aria-valuetext", $("clock").value);
  document.documentElement.dataset.drawn ??= performance.now();
  if (playing) show();
}

// ---- hands

function play(on) {
  playing = on;
  if (on && now >= last) now = first;
  if (on) { $("shutter").value = "0"; shuttered(); }
  else $("said").textContent = $("clock").textContent + motions.map((m, i) => ", " + m.label + " " + m.panel.lastChild.textContent).join("");
  before = null;
  $("play").textContent = on ? "❚❚" : "▶";
  $("play").setAttribute("aria-label", on ? "pause" : "play");
  forget();
  show();
}
function go(t) { now = Math.min(last, Math.max(first, t)); forget(); show(); }

for (const over of [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000]) $("speed").add(new Option(over === 1 ? "1" : "1/" + over, 1 / over));
$("speed").add(new Option("2", 2), 0);
$("speed").value = 1 / data.slow;
Object.assign($("time"), { min: first, max: last, value: first });
$("play").onclick = () => play(!playing);
$("time").oninput = () => { playing && play(false); go($("time").valueAsNumber); };
for (const id of ["omega", "momentum", "path", "above"]) $(id).onchange = show;
function shuttered() { for (const id of ["omega", "momentum", "path", "above"]) $(id).disabled = $("shutter").value !== "0"; }
$("shutter").onchange = () => {
  playing && play(false);
  if (now >= last) now = first; // an exposure begins now, and takes time
  shuttered();
  forget();
  show();
};
$("controls").onsubmit = () => false;
addEventListener("keydown", e => {
  if (e.key === "Escape") document.querySelector("details").open = false;
  const has = ["BUTTON", "SUMMARY"].includes(e.target.tagName) || e.target.type === "checkbox"; // its own use of the space bar
  if (e.ctrlKey || e.metaKey || e.altKey || e.target.tagName === "SELECT" || e.key === " " && has) return;
  const keys = { " ": () => play(!playing), ",": () => go(now - speed() / 60), ".": () => go(now + speed() / 60), 0: () => go(first) };
  if (e.target === canvas) Object.assign(keys, {
    ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0), ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1),
    "+": () => zoom(1.15), "=": () => zoom(1.15), "-": () => zoom(1 / 1.15),
  });
  if (keys[e.key]) { keys[e.key](); e.preventDefault(); }
});
function turn(dx, dy) {
  if ($("shutter").value !== "0") return;
  $("above").checked = false;
  eye.azimuth -= dx;
  eye.elevation = Math.min(1.55, Math.max(0.03, eye.elevation + dy));
  show();
}
function zoom(by) { eye.zoom = Math.min(20, Math.max(0.2, eye.zoom * by)); forget(); show(); }
const fingers = new Map();
canvas.onpointerdown = e => { canvas.setPointerCapture(e.pointerId); fingers.set(e.pointerId, [e.clientX, e.clientY]); };
canvas.onpointerup = canvas.onpointercancel = e => fingers.delete(e.pointerId);
canvas.onpointermove = e => {
  const was = fingers.get(e.pointerId), is = [e.clientX, e.clientY];
  if (!was) return;
  const other = [...fingers].find(([id]) => id !== e.pointerId)?.[1];
  if (other) zoom(Math.hypot(is[0] - other[0], is[1] - other[1]) / Math.max(1, Math.hypot(was[0] - other[0], was[1] - other[1])));
  else turn((is[0] - was[0]) / 200, (is[1] - was[1]) / 200);
  fingers.set(e.pointerId, is);
};
// inside another page its wheel and its fingers come first, until this one is asked for
const inside = window.top !== window;
if (inside) canvas.style.touchAction = "pan-y";
canvas.addEventListener("wheel", e => { if (inside && !e.ctrlKey && document.activeElement !== canvas) return; e.preventDefault(); zoom(Math.exp(-e.deltaY / 800)); }, { passive: false });
canvas.addEventListener("webglcontextlost", e => { e.preventDefault(); canvas.hidden = true; });
canvas.addEventListener("webglcontextrestored", () => location.reload());
dusk.onchange = show;
new ResizeObserver(show).observe(stage);

const wish = new URLSearchParams(location.hash.slice(1));
const wished = Number(wish.get("t") ?? NaN) / data.unit;
if (Number.isFinite(wished)) go(wished);
else if (!matchMedia("(prefers-reduced-motion: reduce)").matches) play(true);
show();
// for those who look in: a pose, the time, and where on the stage a body's centre is
window.spincyl = {
  pose: (i, t) => pose(motions[i], t),
  at: () => now * data.unit,
  on: (i, t) => {
    const m = motions[i], w = m.panel.clientWidth, h = m.panel.clientHeight, p = [...pose(m, t).centre, 1];
    const c = camera(m, w / h, $("above").checked), at = k => p.reduce((sum, x, j) => sum + c[4 * j + k] * x, 0);
    return [m.panel.offsetLeft + w * (at(0) / at(3) + 1) / 2, m.panel.offsetTop + h * (1 - at(1) / at(3)) / 2];
  },
};
})();
