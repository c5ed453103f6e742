// Bodies of several circles: the circle that carries at an inclination, and its contact with the table. Pages without
// such bodies omit this file. It comes after page.aloft.js and replaces some of its functions.

const onTheFirstCircle = pose;
pose = (m, t) => {
  const p = onTheFirstCircle(m, t);
  if (!m.circles) return p;
  const [s, c] = [Math.sin(p.theta), Math.cos(p.theta)], [[tilt, , , x, y, z]] = interpolate(m, t);
  // on two circles, kinds above that of a flight, the lower one is told
  const k = m.borders.filter(border => border < p.theta - (p.kind > 2 ? 1e-3 : 0)).length;
  const side = Math.sin(tilt) < 0 ? -1 : 1; // theta of a body that tumbles continues beyond the poles
  const below = ([radius, above]) => {
    const off = side * (-above * s - radius * c);
    return [x + off * Math.cos(p.phi), y + off * Math.sin(p.phi), 0];
  };
  const [radius, above, fillet] = m.circles[k], low = radius * s - above * c + fillet;
  const height = p.kind === 2 ? Math.max(0, z - low) : 0;
  p.centre[2] = p.matrix[14] = low + height;
  Object.assign(p, { height, contact: p.stands ? p.contact : below(m.circles[k]), top: low + height + Math.hypot(1, m.ell) });
  if (p.contact2) p.contact2 = below(m.circles[k + 1]);
  return p;
};
