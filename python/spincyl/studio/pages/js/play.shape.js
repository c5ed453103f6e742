// The drawn shape of a body: profiles for the lathe, and the two letters. A test compares it with
// `studio/shape.py`.

const IVORY = [0.87, 0.85, 0.8], SHADE = [0.72, 0.7, 0.66], BLUE = [0, 0.36, 0.65], ORANGE = [0.8, 0.3, 0];
const DISK = 0.4, QUARTER = 32, ROD = 0.06, STEM = 0.15, LONGEST = 2.5, LIFT = 0.006;

// b: ell, bore (NaN for a general body), fillet, most (the inclination at which it lands)
const kindOf = b => b.fillet < 1 ? "cylinder" : !Number.isNaN(b.bore) ? b.ell > 0 ? "capsule" : "ball" : b.ell > 0 && Math.abs(b.most - Math.PI / 2) < 1e-9 ? "balls" : "ball";
const landing = b => Number.isFinite(b.most) ? b.most : b.ell > 0 && kindOf(b) !== "ball" ? Math.PI / 2 : Math.PI;
function skin(b) {
  const lower = kindOf(b) === "ball" || b.fillet > 0 && Number.isNaN(b.bore) && landing(b) > Math.PI / 2 + 1e-9, bore = Math.min(b.bore, 0.98);
  return { middle: lower ? -b.ell : 0, wall: lower ? 0 : b.ell, fillet: b.fillet, rim: 1 - b.fillet, bore: bore > 0 ? bore : 0 };
}
// corners on a circle with their normals, from one latitude to another
function arc(r, z, radius, from, to, pieces) {
  return Array.from({ length: pieces + 1 }, (_, i) => {
    const a = from + (to - from) * i / pieces, x = Math.abs(a) > Math.PI / 2 - 1e-12 ? 0 : Math.cos(a), y = a ? Math.sin(a) : 0;
    return [r + radius * x, z + radius * y, x, y];
  });
}
function profiles(b) {
  const { middle, wall, fillet, rim, bore } = skin(b), of = (colour, ...corners) => ({ colour, corners });
  if (!fillet) return [
    ...b.ell ? [of(IVORY, [1, -b.ell], [1, b.ell])] : [],
    of(SHADE, [1, b.ell], [bore, b.ell]), of(SHADE, [bore, -b.ell], [1, -b.ell]),
    ...b.ell && bore ? [of(SHADE, [bore, b.ell], [bore, -b.ell])] : [],
  ];
  if (kindOf(b) === "ball") return ball(b, middle);
  const low = -Math.PI / 2;
  if (kindOf(b) === "balls") { // each ball ends in a point where the rod begins, or where the balls intersect
    const lower = arc(0, -wall, 1, low, wall > 1 ? Math.acos(ROD) : Math.asin(Math.min(1, wall)), 2 * QUARTER);
    const upper = lower.map(([r, z, n, k]) => [r, -z, n, -k]).reverse();
    return [of(IVORY, ...lower), ...wall > 1 ? [of(SHADE, lower.at(-1).slice(0, 2), upper[0].slice(0, 2))] : [], of(IVORY, ...upper)];
  }
  const below = arc(rim, middle - wall, fillet, low, 0, QUARTER), above = arc(rim, middle + wall, fillet, 0, -low, QUARTER);
  const round = [...below, ...above.slice(wall ? 0 : 1)], bottom = round[0][1], top = round.at(-1)[1];
  return [
    of(IVORY, ...round),
    ...rim - bore > 1e-6 ? [of(SHADE, [rim, top], [bore, top]), of(SHADE, [bore, bottom], [rim, bottom])] : [],
    ...bore ? [of(SHADE, [bore, top], [bore, bottom])] : [],
  ];
}
// a ball, and the stem or plate on which it lands
function ball(b, middle) {
  const land = landing(b), c = Math.cos(land), s = Math.sin(land), far = (1 - STEM) / Math.max(-c, 1e-9), low = -Math.PI / 2;
  const root = [STEM, middle + Math.sin(Math.acos(STEM))], of = (colour, ...corners) => ({ colour, corners });
  if (middle + far <= root[1]) return [of(IVORY, ...arc(0, middle, 1, low, -low, 2 * QUARTER))];
  const most = Math.acos(STEM), whole = arc(0, middle, 1, low, most, 2 * QUARTER);
  whole.push([...root, ...whole.pop().slice(2)]);
  if (far <= LONGEST) return [of(IVORY, ...whole), of(SHADE, [...root, 1, 0], ...arc(0, middle + far, STEM, 0, -low, QUARTER))];
  const near = 1.4, distant = 1.5, wide = (1 + (c >= 0 ? near : distant) * c) / s;
  return [of(IVORY, ...whole), of(SHADE, root, ...[[STEM, near], [wide, near], [wide, distant], [0, distant]].map(([r, z]) => [r, middle + z]))];
}

// rows of points that cover a letter of height 1: coordinates across and along
function glyph(letter, strips) {
  const rowed = (n, at) => Array.from({ length: strips + 1 }, (_, j) => Array.from({ length: n }, (_, i) => at(i, j / strips)));
  if (letter === "O") return [rowed(49, (i, j) => { const a = TURN * i / 48, r = 0.3 + 0.2 * j; return [r * Math.cos(a), r * Math.sin(a)]; })];
  // a bar, and two halves of the other bar that leave out the crossing
  const half = 0.5 * Math.SQRT2 - 0.1, n = 9 + 4 * strips;
  return [[1, -half, half], [-1, 0.1, half], [-1, -half, -0.1]].map(([way, from, to]) => rowed(n, (i, j) => {
    const x = from + (to - from) * i / (n - 1), side = 0.2 * (0.5 - j);
    return [(x - way * side) / Math.SQRT2, (way * x + side) / Math.SQRT2];
  }));
}
// a letter near the rim of the upper (end = 1) or lower end, on the wall or on the face of a disk
function mark(b, letter, end) {
  const { middle, wall, fillet, rim, bore } = skin(b), bend = fillet * Math.PI / 4;
  const high = Math.min(1, 0.8 * (wall + bend)), wide = Math.min(0.6, 0.85 * (rim - bore)), onWall = wall + bend >= DISK || high > wide, size = onWall ? high : wide;
  const places = [], normals = [], triangles = [];
  for (const strip of glyph(letter, fillet ? 4 : 1)) {
    // seen from outside, the letters on the two ends run in opposite senses
    if ((end > 0) === onWall) strip.reverse();
    const base = places.length / 3, n = strip[0].length;
    for (const row of strip) for (const [x, y] of row) {
      const u = size * x, v = size * y;
      if (onWall) {
        const way = Math.max(wall - 0.56 * size + Math.min(0.56 * size, bend), 0.56 * size) + v, straight = kindOf(b) === "balls" ? wall : Math.min(way, wall);
        const angle = fillet ? (way - straight) / fillet : 0, out = Math.cos(angle), up = end * Math.sin(angle), r = rim + fillet * out, c = Math.cos(u / r), s = Math.sin(u / r);
        places.push((r + LIFT * out) * c, (r + LIFT * out) * s, middle + end * straight + (fillet + LIFT) * up);
        normals.push(out * c, out * s, up);
      } else {
        places.push(rim - 0.56 * size + v, u, middle + end * (wall + fillet + LIFT));
        normals.push(0, 0, end);
      }
    }
    for (let k = 0; k + 1 < strip.length; k++) for (let i = 0; i + 1 < n; i++) {
      const j = base + k * n + i;
      triangles.push(j, j + 1, j + n, j + 1, j + n + 1, j + n);
    }
  }
  return { colour: letter === "O" ? BLUE : ORANGE, places, normals, triangles };
}
// surfaces of a frustum: its wall and both its ends
const turnedOf = ([[r, low], [wide, high]]) => [[0, 1, [[r, -low], [wide, -high]]], [1, 0, [[wide, -high], [0, -high]]], [1, 0, [[0, -low], [r, -low]]]];
// surfaces of parts as given by Python, with two stripes along the widest
function parted(parts) {
  const most = Math.max(...parts.flatMap(([, , corners]) => corners.map(c => c[0])));
  const stripe = (colour, side) => {
    const places = [], normals = [], triangles = [];
    for (const [, wide, corners] of parts) if (wide) corners.slice(1).forEach(([c, d], k) => {
      const [a, b] = corners[k], long = Math.hypot(c - a, d - b), out = (d - b) / long, up = (a - c) / long, base = places.length / 3;
      if (long) for (let i = 0; i < 18; i++) {
        const [r, z] = i < 9 ? [a, b] : [c, d], at = r && Math.min(0.08 * most, r / 2) / r * (i % 9 - 4) / 4, x = side * Math.cos(at), y = side * Math.sin(at), far = r + 0.004 * most * out;
        places.push(far * x, far * y, z + 0.004 * most * up);
        normals.push(out * x, out * y, up);
        if (i % 9 && i > 9) triangles.push(base + i - 10, base + i - 9, base + i, base + i - 10, base + i, base + i - 1);
      }
    });
    return { colour, places, normals, triangles };
  };
  return { turned: parts.map(([shade, , corners]) => ({ colour: shade ? SHADE : IVORY, corners })), marks: [stripe(BLUE, 1), stripe(ORANGE, -1)] };
}
const lookOf = b => b.parts ? parted(b.parts) : ({ turned: profiles(b), marks: [mark(b, "O", 1), mark(b, "X", -1)] });
// largest distance of the surface from the centre of mass
const farOf = turned => Math.max(...turned.flatMap(p => p.corners.map(([r, z]) => Math.hypot(r, z))));
