// Bodies with a fillet: their contact with the table, and surfaces that look round. Pages of sharp bodies
// omit this file. It comes before the drawing and replaces `pose` and `lathe`.

for (const m of motions) if (m.fillet) {
  m.edge = [1 - m.fillet, 0, m.fillet]; // radius and rounding of the rim, for the sound
  m.depth = m.ell;
  // half length of a sharp cylinder of the same reach, for the camera
  m.ell = Math.sqrt(Math.max(0, m.far ** 2 - 1));
}

const onSharpRim = pose;
pose = (m, t) => {
  const p = onSharpRim(m, t);
  if (!m.fillet) return p;
  const a = 1 - m.fillet, [s, c] = [Math.sin(p.theta), Math.cos(p.theta)], off = m.depth * s - a * c;
  p.centre[2] = p.matrix[14] = m.fillet + m.depth * c + a * s + (p.high || 0);
  if (!p.lies) p.contact = [p.centre[0] + off * Math.cos(p.phi), p.centre[1] + off * Math.sin(p.phi), 0];
  return p;
};

// like the function it replaces, but a corner may have a normal as its third and fourth number
lathe = (corners, around = 256) => {
  const places = [], normals = [], triangles = [];
  corners.slice(1).forEach(([r1, z1, ...n1], k) => {
    const [r0, z0, ...n0] = corners[k], length = Math.hypot(r1 - r0, z1 - z0), base = places.length / 3;
    const flat = [(z1 - z0) / length, (r0 - r1) / length];
    const [[out0, up0], [out1, up1]] = n0.length ? [n0, n1] : [flat, flat];
    for (let i = 0; i <= around; i++) {
      const c = Math.cos(2 * Math.PI * i / around), s = Math.sin(2 * Math.PI * i / around), j = base + 2 * i;
      places.push(r0 * c, r0 * s, z0, r1 * c, r1 * s, z1);
      normals.push(out0 * c, out0 * s, up0, out1 * c, out1 * s, up1);
      if (i < around) triangles.push(j, j + 2, j + 1, j + 2, j + 3, j + 1);
    }
  });
  return mesh(places, normals, new Uint16Array(triangles));
};
