// Shaders and meshes: what any page of ours draws bodies with. The recorded page and the live one share it.

// linked when it is first used: what is not shown yet costs nothing in opening the page; what is shown `first` is begun
// at once, and the graphics card makes it while the page goes on
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
  const early = first && begun();
  const make = () => {
    const made = early || begun();
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw Error(gl.getProgramInfoLog(made));
    return made;
  };
  return new Proxy({}, { get: (o, name) => o[name] ??= name === "made" ? make() : gl.getUniformLocation(o.made ??= make(), name) });
}

const surface = program(
  `in vec3 place, normal; uniform mat4 camera, model; out vec3 n;
   void main() { n = mat3(model) * normal; gl_Position = camera * (model * vec4(place, 1.0)); }`,
  `in vec3 n; uniform vec4 colour; uniform float lit; out vec4 o;
   void main() { vec3 m = normalize(n);
     float light = mix(1.0, 0.52 + 0.16 * m.z + 0.36 * max(dot(m, normalize(vec3(-0.45, -0.5, 0.75))), 0.0), lit);
     o = vec4(colour.rgb * light, colour.a); }`, true);
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

// on the graphics card; `old` is a mesh whose place it takes
function mesh(places, normals, triangles, old) {
  if (old) { gl.deleteVertexArray(old.vao); old.buffers.forEach(b => gl.deleteBuffer(b)); }
  const vao = gl.createVertexArray(), buffers = [];
  const filled = (kind, values) => { buffers.push(gl.createBuffer()); gl.bindBuffer(kind, buffers.at(-1)); gl.bufferData(kind, values, gl.STATIC_DRAW); };
  gl.bindVertexArray(vao);
  [places, normals].forEach((values, i) => {
    if (!values) return;
    filled(gl.ARRAY_BUFFER, new Float32Array(values));
    gl.enableVertexAttribArray(i);
    gl.vertexAttribPointer(i, 3, gl.FLOAT, false, 0, 0);
  });
  if (triangles) filled(gl.ELEMENT_ARRAY_BUFFER, triangles);
  return { vao, buffers, count: triangles ? triangles.length : places.length / 3 };
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
// of an arrow along z, in its length: shaft and head; and its halo, a little larger
const [arrow, halo] = [0, 0.011].map(d => lathe([[0, -d], [0.016 + d, -d], [0.016 + d, 0.86 - d], [0.045 + 1.7 * d, 0.86 - d], [0, 1 + 3 * d]], 48));
gl.vertexAttrib3f(1, 0, 0, 1); // what has no normals lies on the table
const quad = mesh([-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0]);
