// Inclination, normal force and friction coefficient against time, in tracks above a common time axis.

const charted = $("chart");
let kept = null, span = [0, 1];
const TRACKS = [
  { name: "θ", unit: "°", of: row => row[OF_ROW.theta] / deg, colour: "theta", dash: [], least: 0.5 },
  { name: "N", unit: "", of: row => row[OF_ROW.kind] > FLIES ? 1 : row[OF_ROW.normal], colour: "normal", dash: [7, 4], zero: true, least: 0.5, line: 1 },
  { name: "μ", unit: "", of: row => row[OF_ROW.demand], colour: "friction", dash: [2, 3], zero: true, least: 0.05 },
];
const MEANING = { "θ": N("inclination"), N: N("normal force per weight"), "μ": N("friction coefficient, F/N") };

// the letter of a track, or its word
const named_ = track => track.word === undefined ? track.name : W(track.word);

// The upper end of an axis that begins at 0 is one of a few steps. While the user drags, it changes only to a
// larger step, or to one below a third. It covers all values, except in a fall or a hop, whose peak would
// flatten the rest: there the curve is cut, and the largest value is written at the peak.
const STEPS = [1, 1.5, 2, 3, 5, 7, 10];
const stepAbove = x => { const ten = 10 ** Math.floor(Math.log10(x)); return ten * STEPS.find(k => k * ten >= 0.98 * x); };
function limit(track, sorted) {
  const usual = Math.max(track.least, sorted[Math.floor(0.9 * sorted.length)]), greatest = sorted.at(-1);
  track.cut = greatest > 10 * usual;
  const wanted = stepAbove(track.cut ? 3 * usual : Math.max(track.least, greatest));
  if (!(held_ && wanted <= track.most && wanted > track.most / 3)) track.most = wanted;
  track.cut &&= greatest > track.most;
  return track.most;
}

function drawChart() {
  if (!charted.clientWidth) return;
  const [g, w, h, ratio] = context2d(charted), style = getComputedStyle(document.documentElement), colour = name => style.getPropertyValue("--" + name).trim();
  const em = parseFloat(getComputedStyle(charted).fontSize) * ratio, low = h - 1.5 * em;
  g.font = `bold italic ${em}px system-ui, sans-serif`;
  const left = Math.max(3.6 * em, 0.6 * em + Math.max(...TRACKS.map(track => g.measureText(named_(track)).width)));
  g.clearRect(0, 0, w, h);
  span = [left, w - 0.6 * em];
  const write = (text, x, y, align, fill, bold = "") => { Object.assign(g, { font: `${bold} ${em}px system-ui, sans-serif`, textAlign: align, textBaseline: "middle", fillStyle: fill }); g.fillText(text, x, y); };
  const at = t => span[0] + (span[1] - span[0]) * (t - tracked.first) / Math.max(1e-9, tracked.last - tracked.first);
  const { rows: all } = tracked, moves = tracked.last > tracked.first;
  if (!moves) write(W("no motion, so nothing is plotted"), w / 2, h / 2, "center", colour("ink"));
  if (moves) TRACKS.forEach((track, i) => {
    const top = low * i / 3 + 1.25 * em, bottom = low * (i + 1) / 3 - 0.2 * em, values = tracked.rows.map(track.of).filter(Number.isFinite).sort((a, b) => a - b);
    if (!values.length) return;
    let least = track.zero ? Math.min(0, values[0]) : values[0], most = track.zero ? limit(track, values) : values.at(-1);
    if (track.both) { most = stepAbove(Math.max(track.least, most, -least)); least = -most; }
    if (most - least < track.least) { const middle = (most + least) / 2; least = middle - track.least / 2; most = middle + track.least / 2; }
    const margin = 0.06 * (most - least), y = v => bottom - (bottom - top) * (v - least + margin) / (most - least + 2 * margin);
    g.fillStyle = colour("well");
    g.fillRect(span[0], top, span[1] - span[0], bottom - top);
    g.save();
    g.globalAlpha = 0.16; // while the body slips, and otherwise while it flies
    for (let k = 0, from = 0, was = ""; k < all.length; k++) {
      const kind = s.stone ? 0 : all[k][OF_ROW.kind], shade = kind === FLIES ? "normal" : rubbed(kind) ? "friction" : "";
      if (shade === was && k + 1 < all.length) continue;
      if (was) { g.fillStyle = colour(was); g.fillRect(at(all[from][0]), top, at(all[k][0]) - at(all[from][0]), bottom - top); }
      from = k;
      was = shade;
    }
    g.globalAlpha = 1;
    g.beginPath();
    g.rect(span[0], top, span[1] - span[0], bottom - top);
    g.clip();
    if ("line" in track) { g.fillStyle = colour("line"); g.fillRect(span[0], y(track.line), span[1] - span[0], ratio); }
    g.beginPath();
    tracked.rows.forEach((row, k) => { const v = track.of(row); Number.isFinite(v) && (k ? g.lineTo(at(row[0]), y(v)) : g.moveTo(at(row[0]), y(v))); });
    Object.assign(g, { strokeStyle: colour(track.colour), lineWidth: 2 * ratio, lineJoin: "round" });
    g.setLineDash(track.dash.map(x => x * ratio));
    g.stroke();
    g.setLineDash([]);
    g.restore();
    const figure = v => track.unit ? v.toFixed(most - least < 2 ? 2 : 1) + track.unit : v.toFixed(2);
    if (bottom - top > 1.9 * em) { write(figure(most), left - 0.3 * em, top + 0.55 * em, "right", colour("ink")); write(figure(least), left - 0.3 * em, bottom - 0.5 * em, "right", colour("ink")); }
    const high = bottom - top > 3.4 * em; // else the letter stands before its meaning
    if (high) write(named_(track), 0.2 * em, (top + bottom) / 2, "left", colour(track.colour), "bold italic");
    write((high ? "" : named_(track) + ", ") + W(MEANING[track.name]), span[0], top - 0.6 * em, "left", colour(track.colour));
    if (track.cut) {
      const row = tracked.rows.find(row => track.of(row) === values.at(-1));
      write("≥ " + values.at(-1).toPrecision(3), Math.min(span[1] - 2.5 * em, Math.max(span[0] + 2.5 * em, at(row[0]))), top + 0.7 * em, "center", colour("ink"), "600");
    }
  });
  if (moves) for (const [x, align] of [[tracked.first, "left"], [tracked.last, "right"]]) write(align === "right" ? "t = " + timed(x, 1) : x && sized() ? timed(x, 1) : timed(x, 1).split(" ")[0], at(x), h - 0.7 * em, align, colour("ink"));
  kept ??= new OffscreenCanvas(1, 1);
  if (kept.width !== w || kept.height !== h) { kept.width = w; kept.height = h; } else kept.getContext("2d").clearRect(0, 0, w, h);
  kept.getContext("2d").drawImage(charted, 0, 0);
}
// the present time: the stored drawing, and a line
function drawCursor() {
  if (!kept || !(tracked.last > tracked.first)) return;
  const g = charted.getContext("2d"), x = span[0] + (span[1] - span[0]) * Math.min(1, Math.max(0, (now - tracked.first) / Math.max(1e-9, tracked.last - tracked.first)));
  g.clearRect(0, 0, charted.width, charted.height);
  g.drawImage(kept, 0, 0);
  g.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--point");
  g.fillRect(x - 1, 0, 2 * Math.min(2, devicePixelRatio || 1), charted.height);
}
