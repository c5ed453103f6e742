// Content of the recorded page: stored surfaces, and paths through the poses of its motions.

const shapes = data.shapes.map(({ turned, marks }) => [
  ...surfaces(turned),
  ...marks.map(p => ({
    ...mesh(Array.from(new Int16Array(bytes(p.v)), x => x * p.unit), Array.from(new Int8Array(bytes(p.n)), x => x / 127), new Uint16Array(bytes(p.i))),
    colour: p.colour, mark: true,
  })),
]);

// sampling times between which a body turns little
for (const m of motions) {
  const times = [];
  const turns = i => Math.abs(m.y[i + 1][1] - m.y[i][1]) + Math.abs(m.y[i + 1][2] - m.y[i][2]);
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
  trace(m, times, times.map(t => pose(m, t)));
  panelled(m);
}

measured();
