// Stones: poses from quaternions, and stretched surfaces. Pages without stones omit this file. It comes
// before the drawing and replaces some of its functions.

for (const m of motions) if (m.axes) m.wide = 0.005 * Math.sqrt(Math.hypot(1, m.ell) * (Math.hypot(1, m.ell) + 0.5 * Math.hypot(m.high[4] - m.low[4], m.high[5] - m.low[5])));

// numbers of a pose: x, y, z of a quaternion of any length, the place, and w of the quaternion
const ofRevolution = pose;
pose = (m, t) => {
  if (!m.axes) return ofRevolution(m, t);
  const [[a, b, c, left, ahead, d], [ra, rb, rc, , , rd]] = interpolate(m, t), size = Math.hypot(a, b, c, d);
  const [x, y, z, w] = [a, b, c, d].map(q => q / size);
  const axes = [ // axes of the stone in the laboratory
    [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)],
    [2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)],
    [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)],
  ];
  const of = v => along(...v.map((part, i) => [part, axes[i]]));
  const up = axes.map(e => e[2]), depth = Math.hypot(...up.map((n, i) => n * m.axes[i]));
  // from the centre of mass to the lowest point
  const arm = of(up.map((n, i) => -(m.axes[i] ** 2) * n / depth - m.offset[i])), centre = [left, ahead, -arm[2]];
  const omega = along([2 * w / size, [ra, rb, rc]], [-2 * rd / size, [x, y, z]], [2 / size, cross([x, y, z], [ra, rb, rc])]);
  const turning = axes.map(e => dot(e, omega));
  return {
    theta: Math.atan2(Math.hypot(up[0], up[1]), up[2]), phi: 0, centre, contact: [left + arm[0], ahead + arm[1], 0],
    matrix: [...axes.flatMap(e => [...e, 0]), ...centre, 1],
    omega, momentum: of(m.inertia.map(row => dot(row, turning))),
  };
};

// a profile with `axes` belongs to a stone, whose surface is stretched
const unstretched = lathe;
lathe = (p, around) => {
  if (!p.axes) return unstretched(p, around);
  const plain = mesh, of = (x, k) => x[k - k % 3 + (k + 2 - p.about) % 3];
  mesh = (places, normals, triangles) => plain(
    places.map((_, k) => of(places, k) * p.axes[k % 3] + p.centre[k % 3]), normals.map((_, k) => of(normals, k) / p.axes[k % 3]), triangles);
  const made = unstretched(p.corners, around);
  mesh = plain;
  return { ...made, mark: p.mark };
};

// the turns of a stone about the vertical are the integral of its spin
const closed = closing;
closing = (m, t, turns) => {
  if (!m.axes || turns === Infinity) return closed(m, t, turns);
  const fine = (m.last - t) / 2e4;
  for (let turned = 0; t < m.last; t += fine) {
    turned += pose(m, t).omega[2] * fine;
    if (Math.abs(turned) > 2 * Math.PI * turns) return t;
  }
  return m.last;
};
