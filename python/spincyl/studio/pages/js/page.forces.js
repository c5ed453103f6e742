// Arrows of the contact forces, N and F, in addition to those of the rotation. This file comes before the drawing,
// whose `arrowOf` it replaces.

ARROWS.push("normal", "friction");
Object.assign(letters, { normal: "N", friction: "F" });
Object.assign(fastest, { normal: 0, friction: 0 });
const ofTurning = arrowOf;
// below a body that stands on its face, the centre of the pressure
const pressed = p => p.stands && p.normal[2] > 0 ? [0, 1].map(k => p.contact[k] - p.centre[2] * p.friction[k] / p.normal[2]).concat(0) : p.contact;
// the length shows the size of the force up to a limit, since a fall may end with a very large force
arrowOf = (p, v) => {
  if (v !== "normal" && v !== "friction") return ofTurning(p, v);
  const size = Math.hypot(...p[v]);
  if (!$("forces").checked || !(size > 1e-3 * p.usual)) return null;
  const length = Math.min(1.1 * half, 0.55 * half * size / p.usual);
  return { along: p[v].map(x => x / size), length, wide: 0.5 * Math.sqrt(half * length), root: pressed(p) };
};
