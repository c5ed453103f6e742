// Text about a stone: its spin about the vertical, and when the spin reverses.

const spun = motions.reduce((most, m) => m.axes ? m.t.reduce((most, t) => Math.max(most, Math.abs(pose(m, t).omega[2] * data.rate)), most) : most, 1e-9);
const places = Math.max(0, 2 - Math.floor(Math.log10(spun)));
const unspun = doing;
doing = (m, p) => {
  if (!m.axes) return unspun(m, p);
  const size = Math.abs(p.omega[2] * data.rate).toFixed(places), spin = (Number(size) === 0 ? "" : p.omega[2] < 0 ? "\u2212" : "+") + size;
  const past = m.back.filter(t => t <= now), back = past.at(-1) ?? m.back[0];
  return `\nspin ${spin} ${data.rates}`.replaceAll(" ", "\u00a0") + unspun(m, p) + (back === undefined ? "" : `\nturn${past.length ? "ed" : "s"} back at ${clock(back)}`);
};
document.querySelector("details p").append(" For a stone, θ is the inclination of its axis 3; its spin, the angular velocity about the vertical, is positive if counterclockwise as seen from above.");
