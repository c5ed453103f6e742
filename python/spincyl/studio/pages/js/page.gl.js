// Shaders and meshes, shared by the recorded page and the live one.

// Links at first use in each context, so that the page opens fast. A program that is needed `first` starts at
// once, and the graphics card compiles it while the page continues.
function program(vertex, fragment, first) {
  const begun = () => {
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
    return made;
  };
  let of = era, early = first && gl && begun(), kept = {};
  const make = () => {
    const made = early || begun();
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw Error(gl.getProgramInfoLog(made));
    return made;
  };
  return new Proxy({}, { get: (_, name) => {
    if (of !== era) { of = era; early = null; kept = {}; }
    return kept[name] ??= name === "made" ? make() : gl.getUniformLocation(kept.made ??= make(), name);
  } });
}

const surface = program(
  `in vec3 place, normal; uniform mat4 camera, model; uniform vec3 eye; out vec3 n, v;
   void main() { vec4 p = model * vec4(place, 1.0); n = mat3(model) * normal; v = eye - p.xyz; gl_Position = camera * p; }`,
  // round surfaces have an outline, two pixels wide, where they turn away from the eye, if `lit` is 1
  `in vec3 n, v; uniform vec4 colour; uniform float lit; out vec4 o;
   void main() { vec3 m = normalize(n), e = normalize(v), sun = normalize(vec3(-0.45, -0.5, 0.75));
     float light = 0.52 + 0.16 * m.z + 0.36 * max(dot(m, sun), 0.0);
     float shine = 0.16 * pow(max(dot(m, normalize(sun + e)), 0.0), 24.0);
     float turned = dot(m, e) * dot(m, e), edge = mix(0.4, 1.0, smoothstep(0.6, 2.0, turned / max(fwidth(turned), 1e-6)));
     o = vec4(colour.rgb * (lit < 1.0 ? mix(1.0, light, lit) : (light + shine) * edge), colour.a); }`, true);
const shadow = program(
  `in vec3 place; uniform mat4 camera, model; void main() { gl_Position = camera * (model * vec4(place, 1.0)); }`,
  `uniform float dark; out vec4 o; void main() { o = vec4(0.0, 0.0, 0.0, dark); }`, true);
const table = program(
  `in vec3 place; uniform mat4 camera; uniform vec3 at; uniform float far; out vec2 p;
   void main() { p = at.xy + far * place.xy; gl_Position = camera * vec4(p, 0.0, 1.0); }`,
  `in vec2 p; uniform vec3 ground, line, at; uniform float far, cell; out vec4 o;
   void main() { vec2 q = p / cell, w = fwidth(q), g = abs(fract(q - 0.5) - 0.5) / w;
     float on = (1.0 - min(min(g.x, g.y), 1.0)) * clamp(0.6 - max(w.x, w.y), 0.0, 1.0);
     o = vec4(mix(ground, line, on), 1.0 - smoothstep(0.5, 1.0, length(p - at.xy) / far)); }`, true);
const screen = `in vec3 place; out vec2 p; void main() { p = 0.5 * place.xy + 0.5; gl_Position = vec4(place.xy, 0.0, 1.0); }`;
const adding = program(screen, `in vec2 p; uniform sampler2D sum, frame; out vec4 o; void main() { o = texture(sum, p) + texture(frame, p); }`);
const developing = program(screen,
  `in vec2 p; uniform sampler2D sum; uniform float gain; out vec4 o;
   void main() { o = vec4(1.0 - exp(-gain * texture(sum, p).rgb), 1.0); }`);

// a mesh that is sent to the graphics card when it is first bound; `old` is a mesh that it replaces
function mesh(places, normals, triangles, old) {
  old?.free();
  const corners = [places, normals].map(values => values && new Float32Array(values)), buffers = [];
  let of = 0, vao = null;
  const filled = (kind, values) => { buffers.push(gl.createBuffer()); gl.bindBuffer(kind, buffers.at(-1)); gl.bufferData(kind, values, gl.STATIC_DRAW); };
  function bind() {
    if (of === era) { gl.bindVertexArray(vao); return; }
    of = era;
    buffers.length = 0;
    gl.bindVertexArray(vao = gl.createVertexArray());
    corners.forEach((values, i) => {
      if (!values) return;
      filled(gl.ARRAY_BUFFER, values);
      gl.enableVertexAttribArray(i);
      gl.vertexAttribPointer(i, 3, gl.FLOAT, false, 0, 0);
    });
    if (triangles) filled(gl.ELEMENT_ARRAY_BUFFER, triangles);
  }
  const free = () => { if (of && of === era) { gl.deleteVertexArray(vao); buffers.forEach(b => gl.deleteBuffer(b)); of = 0; } };
  return { bind, free, count: triangles ? triangles.length : places.length / 3 };
}

// surface of revolution of a polygon (radius, height), whose outside is on the right of its direction; smooth
// at any size
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
// a body of revolution: its surfaces, coarser ones that cast the shadow, and dark lines along edges between
// flat surfaces
const INK = [0.24, 0.24, 0.25], THICK = 0.011;
function surfaces(turned) {
  const plain = turned.flatMap(p => (p.corners.corners || p.corners).filter(c => c.length === 2 && c[0] > 0)), same = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]) < 1e-9;
  const edges = plain.filter((c, i) => plain.findIndex(d => same(c, d)) < i && plain.findLastIndex(d => same(c, d)) === i);
  const ring = ([r, z]) => [[0, 1], [-1, 0], [0, -1], [1, 0], [0, 1]].map(([x, y]) => [r + THICK * x, z - THICK * y]);
  return [...turned.map(p => ({ ...lathe(p.corners), colour: p.colour, cast: lathe(p.corners, 64) })), ...edges.map(c => ({ ...lathe(ring(c)), colour: INK, edge: true }))];
}
// an arrow of length 1 along z, shaft and head; and its halo, slightly larger
const [arrow, halo] = [0, 0.011].map(d => lathe([[0, -d], [0.016 + d, -d], [0.016 + d, 0.86 - d], [0.045 + 1.7 * d, 0.86 - d], [0, 1 + 3 * d]], 48));
// a rod of length and radius 1 along z, and a bead
const [rod, bead] = [[[0, 0], [1, 0], [1, 1], [0, 1]], [[0, -1], [0.7, -0.7], [1, 0], [0.7, 0.7], [0, 1]]].map(corners => lathe(corners, 24));
const quad = mesh([-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0]);
