// Arrows of the forces on the contact, N and F, beside those of the turning; before the drawing, one of whose functions it
// replaces.

ARROWS.push("normal", "friction");
Object.assign(letters, { normal: "N", friction: "F" });
Object.assign(fastest, { normal: 0, friction: 0 });
const ofTurning = arrowOf;
// forces are told apart by their lengths, and a small one is to be seen all the same; a fall may end with a great one
arrowOf = (p, v) => {
  if (v !== "normal" && v !== "friction") return ofTurning(p, v);
  const size = Math.hypot(...p[v]);
  if (!$("forces").checked || !(size > 1e-3 * p.usual)) return null;
  const length = Math.min(1.1 * half, 0.55 * half * size / p.usual);
  return { along: p[v].map(x => x / size), length, wide: 0.5 * Math.sqrt(half * length), root: p.contact };
};
