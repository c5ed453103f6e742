// The map of inclination against aspect ratio: regions with hatching, name and colour; lines; the present
// state; and other inclinations with the same rate, the ghosts.

// for each code of the core: name, colour and colour of the hatching by day and by night, and whether a pixel
// is hatched, in a pattern with a period of 72 pixels
const REGIONS = {
  7: { name: N("stable"), colour: ["#bfe0c8", "#1d4a35"], ink: ["#bfe0c8", "#1d4a35"], hatch: () => false },
  5: { name: N("stable because it rolls"), colour: ["#ffe9a8", "#57460f"], ink: ["#c99a00", "#a5852a"], hatch: (x, y) => (x + y) % 9 < 1.2 },
  6: { name: N("stable on ice only"), colour: ["#dfd2f5", "#3c2c63"], ink: ["#8d6cc9", "#8466c0"], hatch: (x, y) => (x - y + 72) % 9 < 1.2 },
  4: { name: N("unstable"), colour: ["#f4bfae", "#6b2a1c"], ink: ["#cf6a4d", "#b3543c"], hatch: (x, y) => (x + y) % 9 < 1.1 || (x - y + 72) % 9 < 1.1 },
  1: { name: N("forbidden"), colour: ["#dcd9d2", "#2b2e34"], ink: ["#a5a199", "#565c66"], hatch: (x, y) => x % 8 < 1.7 && y % 8 < 1.7 },
  2: { name: N("too close to decide"), colour: ["#8f8b84", "#777d87"], ink: ["#8f8b84", "#777d87"], hatch: () => false },
  0: { name: N("no such body"), colour: ["#f6f4ef", "#16181c"], ink: ["#d5d2ca", "#30343b"], hatch: (x, y) => y % 12 < 1 },
};
// columns of `curves`: the aspect ratio, theta0, thetaInf, then `SOME` folds, ridges, and boundaries of two
// kinds
const SOME = 5, COLUMNS = 3 + 4 * SOME, LINES = [["θ₀", 1, 1], ["θ∞", 2, 1], ["fold", 3, SOME], ["ridge", 3 + SOME, SOME]], LINE = { fold: N("fold"), ridge: N("ridge") }, lineName = name => name in LINE ? W(LINE[name]) : name;
const map = $("map"), chart = { picture: null, key: "", names: [], curves: [], codes: null };
const rgba = text => (255 << 24 | parseInt(text.slice(5, 7), 16) << 16 | parseInt(text.slice(3, 5), 16) << 8 | parseInt(text.slice(1, 3), 16)) >>> 0;
const widest = () => s.ell > 2.95 && isTube() ? 8 : 3;

function context2d(c) {
  const ratio = Math.min(2, devicePixelRatio || 1), w = Math.max(1, Math.round(c.clientWidth * ratio)), h = Math.max(1, Math.round(c.clientHeight * ratio));
  if (c.width !== w || c.height !== h) { c.width = w; c.height = h; }
  return [c.getContext("2d"), w, h, ratio];
}

// codes of the regions, in w columns of aspect ratio; for a body that is not a tube all columns are equal
function codesOf(w, h) {
  if (isTube()) {
    core.map(w, h, 0, widest(), 0, Math.PI / 2, s.bore, s.fillet);
    return new Uint8Array(core.memory.buffer, core.codes(), w * h).slice();
  }
  const codes = new Uint8Array(w * h);
  for (let j = 0; j < h; j++) {
    const code = ask("at_rest", steep() * (j + 0.5) / h);
    codes.fill(code.code === 3 ? 1 : code.code === 4 ? 2 : code.code ? 0 : code.out[0], j * w, (j + 1) * w);
  }
  return codes;
}

// a position for the name of each region: the middle of its largest rectangle, on a grid of every fourth cell
function namesOf(codes, wide, high) {
  const found = [], w = wide >> 2, h = high >> 2;
  for (const code of [7, 5, 6, 4, 1]) {
    const side = new Uint8Array(w * h);
    let best = [0, 0, 0];
    for (let j = 0, k = 0; j < h; j++) for (let i = 0; i < w; i++, k++) {
      side[k] = codes[4 * (j * wide + i)] !== code ? 0 : i && j ? 1 + Math.min(side[k - 1], side[k - w], side[k - w - 1]) : 1;
      if (side[k] > best[0]) best = [side[k], i + 1 - side[k] / 2, j + 1 - side[k] / 2];
    }
    found.push({ code, size: best[0] / h, x: best[1] / w, y: best[2] / h });
  }
  return found;
}

// The regions at the resolution of the screen; coarser while the user drags a quantity that changes the whole
// map, coarsest for rounded rims, whose boundaries are roots of high polynomials.
function paintMap(coarse) {
  const night = dusk.matches ? 1 : 0, [, w, h, ratio] = context2d(map);
  const key = [isTube() ? [widest(), s.bore, s.fillet] : [body.ell, body.i1, body.i3, body.fillet, body.most], night, w, h].join(), rough = key + coarse;
  if (chart.key === key || coarse && chart.key === rough) return;
  const began = performance.now();
  chart.key = coarse ? rough : key;
  const slow = s.fillet > 0, [cw, ch] = coarse && slow ? [100, 75] : [400, 300], codes = codesOf(cw, ch);
  timing.map = performance.now() - began;
  if (chart.picture?.width !== w || chart.picture.height !== h) chart.picture = new OffscreenCanvas(w, h);
  const image = new ImageData(w, h), paint = new Uint32Array(image.data.buffer);
  const side = Math.round(72 * ratio), tiles = new Uint32Array(8 * side * side);
  for (const [code, { colour, ink, hatch }] of Object.entries(REGIONS)) {
    const plain = rgba(colour[night]), hatched = rgba(ink[night]);
    for (let y = 0, i = code * side * side; y < side; y++) for (let x = 0; x < side; x++) tiles[i++] = hatch(x * 72 / side, y * 72 / side) ? hatched : plain;
  }
  const column = Uint16Array.from({ length: w }, (_, x) => Math.min(cw - 1, Math.floor(x * cw / w))), phase = Uint16Array.from({ length: w }, (_, x) => x % side);
  for (let y = 0, i = 0; y < h; y++) {
    const row = cw * Math.min(ch - 1, Math.floor((h - 1 - y) * ch / h)), line = side * (y % side), whole = side * side;
    for (let x = 0; x < w; x++) paint[i++] = tiles[codes[row + column[x]] * whole + line + phase[x]];
  }
  chart.picture.getContext("2d").putImageData(image, 0, 0);
  if (!isTube()) chart.curves = [-0.5, 0.5].map(x => [s.ell + x, body.theta0, body.limit]);
  else chart.curves = coarse && slow ? [] : rowsOf("curves", COLUMNS, slow ? 81 : coarse ? 61 : 241, 1e-3, widest(), s.bore, s.fillet);
  chart.names = namesOf(codes, cw, ch);
  drawLines();
  timing.paint = performance.now() - began;
}

// from numbers to shares of the screen's width and height
const across = ell => isTube() ? ell / widest() : 0.5 + ell - s.ell, upward = theta => 1 - theta / steep();

function pen(g, ratio) {
  const style = getComputedStyle(document.documentElement), colour = name => style.getPropertyValue("--" + name).trim();
  const em = parseFloat(getComputedStyle(map).fontSize) * ratio;
  const write = (text, x, y, align = "left", bold = "") => {
    Object.assign(g, { font: `${bold} ${em}px system-ui, sans-serif`, textAlign: align, textBaseline: "middle", lineJoin: "round", lineWidth: 0.3 * em, strokeStyle: colour("paper"), fillStyle: colour("ink") });
    g.strokeText(text, x, y);
    g.fillText(text, x, y);
  };
  return { colour, em, write };
}
// draws theta0, thetaInf, folds, ridges and all names onto the picture of the regions
function drawLines() {
  const { width: w, height: h } = chart.picture, g = chart.picture.getContext("2d"), ratio = Math.min(2, devicePixelRatio || 1), { colour, em, write } = pen(g, ratio);
  const ends = [], used = [];
  for (const [name, first, many] of LINES) for (let k = first; k < first + many; k++) {
    g.beginPath();
    let down = false, end = null, before = NaN;
    for (const row of chart.curves) {
      const x = w * across(row[0]), y = h * upward(row[k]);
      if (!(row[k] > 0)) { down = false; continue; }
      down && Math.abs(y - before) < 0.1 * h ? g.lineTo(x, y) : g.moveTo(x, y);
      [down, end, before] = [true, [x, y], y];
    }
    Object.assign(g, { strokeStyle: colour("ink"), lineWidth: (many > 1 ? 1.6 : 2) * ratio });
    g.setLineDash(name === "fold" ? [7 * ratio, 4 * ratio] : name === "ridge" ? [1.5 * ratio, 4 * ratio] : []);
    g.stroke();
    if (end) ends.push([name, ...end]);
  }
  g.setLineDash([]);
  for (const { code, size, x, y } of chart.names) if (size * h > 2 * em) {
    const lines = size * h > 7 * em || code !== 5 ? [W(REGIONS[code].name)] : W("stable | because it rolls").split(" | "), wide = 0.31 * em * Math.max(...lines.map(line => line.length));
    if (size * h < wide) continue; // the legend below the map names a region that is too narrow
    const middle = Math.min(Math.max(w * x, wide), w - wide), top = Math.max(em, h * (1 - y) - 0.6 * em * (lines.length - 1));
    lines.forEach((line, i) => write(line, middle, top + 1.2 * em * i, "center", "600"));
    used.push([middle, top + 0.6 * em * (lines.length - 1), wide + 1.5 * em]);
  }
  const most = steep() / deg;
  for (let a = most / 3; a < most - 1; a += most / 3) write(Math.round(a) + "°", 0.4 * em, h * (1 - a / most));
  if (isTube()) for (let x = 1; x < widest(); x += widest() > 4 ? 2 : 1) write(String(x), w * across(x), h - 0.8 * em, "center");
  write(isTube() ? "ℓ →" : W("this body"), w - 0.5 * em, h - 0.8 * em, "right", "italic");
  write("↑ θ", 0.4 * em, 0.9 * em, "left", "italic");
  for (const [name, x, y] of ends.sort((a, b) => b[1] - a[1])) {
    const right = Math.max(3 * em, Math.min(x, w - 0.4 * em)), at = Math.max(2 * em, Math.min(h - 2.4 * em, y - 0.9 * em));
    if (used.some(([u, v, wide, other]) => Math.abs(u - right + em) < wide + 1.5 * em && Math.abs(v - at) < (other === name ? 5 : 1.7) * em)) continue;
    used.push([right - em, at, em, name]);
    write(lineName(name), right, at, "right", "italic");
  }
}

function drawMap(coarse) {
  if (!map.clientWidth) return; // a figure without a map
  paintMap(coarse);
  const [g, w, h, ratio] = context2d(map), { colour } = pen(g, ratio);
  g.drawImage(chart.picture, 0, 0);
  const x = w * across(s.ell), y = h * upward(s.theta), dot = (at, size, full) => {
    g.beginPath();
    g.arc(x, at, size * ratio, 0, TURN);
    Object.assign(g, { fillStyle: colour(full ? "point" : "paper"), strokeStyle: colour(full ? "paper" : "point"), lineWidth: 2.5 * ratio });
    g.fill();
    g.stroke();
  };
  Object.assign(g, { strokeStyle: colour("ink"), lineWidth: ratio, globalAlpha: 0.5 });
  g.setLineDash([3 * ratio, 4 * ratio]);
  g.beginPath();
  g.moveTo(x, 0); g.lineTo(x, h); g.moveTo(0, y); g.lineTo(w, y);
  g.stroke();
  g.setLineDash([]);
  g.globalAlpha = 1;
  for (const theta of ghosts) dot(h * upward(theta), 7, false);
  dot(y, 10, true);
}

// the inclination on a line close to the pointed one, on the line's allowed side, and the name of the line
const SIDE = { "θ₀": 1e-4, "θ∞": 4e-3 };
function snapped(ell, theta, near) {
  const [row] = isTube() ? rowsOf("curves", COLUMNS, 2, ell, ell, s.bore, s.fillet) : [];
  let best = null;
  if (row) for (const [name, first, many] of LINES) for (let k = first; k < first + many; k++) {
    const off = Math.abs(row[k] - theta);
    if (row[k] > 0 && off < near && (!best || off < best.off)) best = { off, name, line: row[k], out: name === "θ₀" ? Math.sign(row[1] - row[2]) : Math.sign(row[2] - row[1]) };
  }
  if (!best) return { theta, on: "" };
  return { theta: Math.min(Math.PI / 2, best.line + best.out * (SIDE[best.name] || 0)), on: best.name };
}
