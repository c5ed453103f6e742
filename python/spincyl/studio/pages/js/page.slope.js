// Tables that are tilted or turn. The recorded page omits this file if its tables are level and at rest.

// the room, in which z is up, in place of the table: a rotation about y; the camera stays, above the table
const steepest = () => Math.max(...motions.map(m => Math.abs(m.slope || 0))), onLevelTable = camera;
camera = (m, aspect, flat) => {
  const slope = m.slope || 0, [c, s] = [Math.cos(slope), Math.sin(slope)], was = [half, eye.elevation];
  if (flat) return onLevelTable(m, aspect, flat);
  half += 1.06 * reach * (Math.sin(Math.min(0.55 + steepest(), Math.PI / 2)) - Math.sin(0.55));
  eye.elevation = Math.max(eye.elevation, 0.03 + Math.atan2(-Math.cos(eye.azimuth) * s, c));
  const view = onLevelTable(m, aspect, flat), [x, , z] = m.at, [dx, dy, dz] = along([1, m.from], [-1, m.at]);
  [half, eye.elevation] = was;
  m.from = along([1, m.at], [1, [c * dx - s * dz, dy, s * dx + c * dz]]);
  return times4(view, [c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, x - c * x - s * z, 0, z + s * x - c * z, 1]);
};
if (motions[0].slope < 0) eye.azimuth = -Math.PI - eye.azimuth;

// the lines of a table that turns do so about its middle
laid = (m, t, view) => {
  const [c, s] = [Math.cos(m.turning * t), Math.sin(m.turning * t)], [x, y, z] = m.at;
  return m.turning ? [times4(view, [c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), [c * x + s * y, c * y - s * x, z]] : [view, m.at];
};

// further text of the clock
const sloping = m => m.slope ? ("\n" + W("slope {0}°", (m.slope * 180 / Math.PI).toFixed(1))).replaceAll(" ", "\u00a0").replace("-", "\u2212") : "", onTheSlope = doing;
doing = (m, p) => sloping(m) + onTheSlope(m, p);
