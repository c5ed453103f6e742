// Pictures and films of the page: the map, the body, the tracks and the sentence in one frame.

const page = document.createElement("canvas");
let recorder = null;
const filming = () => recorder !== null;
function compose() {
  const ratio = Math.min(2, devicePixelRatio || 1), main = document.querySelector("main").getBoundingClientRect(), g = page.getContext("2d"), style = getComputedStyle(document.documentElement);
  const w = 2 * Math.round(main.width * ratio / 2), h = 2 * Math.round(main.height * ratio / 2), em = parseFloat(style.fontSize) * ratio;
  if (page.width !== w || page.height !== h) { page.width = w; page.height = h; }
  g.fillStyle = style.getPropertyValue("--paper");
  g.fillRect(0, 0, w, h);
  for (const c of [map, canvas, charted]) { const b = c.getBoundingClientRect(); g.drawImage(c, (b.left - main.left) * ratio, (b.top - main.top) * ratio, b.width * ratio, b.height * ratio); }
  const put = (element, size, bold) => {
    const b = element.getBoundingClientRect();
    Object.assign(g, { font: `${bold} ${size * em}px system-ui, sans-serif`, textBaseline: "top", fillStyle: style.getPropertyValue("--ink") });
    (element.value ?? element.textContent).split("\n").forEach((line, i) => g.fillText(line, (b.left - main.left) * ratio, (b.top - main.top) * ratio + 1.35 * i * size * em, w));
  };
  put($("what"), 1.3, 600);
  put($("details"), 0.95, "");
  put(live.clock, 1.15, "");
  for (const b of [$("because").getClientRects()[0]]) if (b) { g.font = `${1.1 * em}px system-ui, sans-serif`; g.fillText($("because").textContent, (b.left - main.left) * ratio, (b.top - main.top) * ratio, w - (b.left - main.left) * ratio); }
}
function keep(blob, name) {
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
function photograph() { compose(); page.toBlob(blob => keep(blob, "spincyl.png")); }
function film() {
  if (recorder) { recorder.stop(); return; }
  compose();
  const kind = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"].find(x => MediaRecorder.isTypeSupported(x)), pieces = [];
  if (!kind) { $("said").textContent = "This browser cannot record WebM."; return; }
  recorder = new MediaRecorder(page.captureStream(30), { mimeType: kind, videoBitsPerSecond: 8e6 });
  recorder.ondataavailable = e => pieces.push(e.data);
  recorder.onstop = () => { recorder = null; $("film").ariaPressed = false; $("film").textContent = "film"; keep(new Blob(pieces, { type: "video/webm" }), "spincyl.webm"); };
  recorder.start();
  $("film").ariaPressed = true;
  $("film").textContent = "stop";
  show();
}
const filmed = () => { if (recorder) compose(); };
$("png").onclick = photograph;
$("film").onclick = film;
