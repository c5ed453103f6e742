// What is heard of recorded motions: the contact point runs along the body, and impacts.

const strokes = motions.flatMap(m => {
  const all = m.hits ? new Float32Array(bytes(m.hits)) : [];
  return Array.from({ length: all.length / 2 }, (_, i) => [all[2 * i], all[2 * i + 1]]);
}).sort((a, b) => a[0] - b[0]);
const hits = () => strokes;
const heardAt = t => motions.map(m => {
  if (m.axes || t < m.first || t > m.last) return [0, 0];
  const [[theta, phi], [tilting, , spinning]] = interpolate(m, t), [, kind, other] = m.now ? m.now(t) : [], s = Math.abs(Math.sin(theta));
  if (kind === 2 || kind === 7) return [0, 0]; // in the air, and on its face
  const [radius, , round] = m.circles ? m.circles[m.borders.filter(border => border < theta).length] : m.edge || [1, 0, 0];
  return [phi + (other ? 0 : Math.PI), Math.hypot(spinning * (radius + round * s), round * tilting)];
});
const loudest = () => whole;
const whole = [0, Math.max(0, ...strokes.map(([, size]) => size))];
for (let i = 0; i <= 2000; i++) for (const [, speed] of heardAt(first + (last - first) * i / 2000)) whole[0] = Math.max(whole[0], Math.min(speed, 2 * Math.PI * RESONANCES[0][0] * data.unit));
$("hear").hidden = whole.every(x => x < 1e-9);
