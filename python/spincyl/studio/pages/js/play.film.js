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
// an MP4, which slides and phones play, where the browser can write one, with the sound if it is on
const KINDS_OF_FILM = ["video/mp4;codecs=avc1.640028,mp4a.40.2", "video/mp4;codecs=avc1.42E01F,mp4a.40.2", "video/mp4;codecs=avc1.42E01F,opus", "video/mp4;codecs=vp9,opus", "video/mp4", "video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"];
const lastsFor = () => ((performance.now() - recorder.began) / 1000).toFixed(1);
function film() {
  if (recorder) { recorder.stop(); return; }
  compose();
  const kind = KINDS_OF_FILM.find(x => window.MediaRecorder?.isTypeSupported(x)), pieces = [];
  if (!kind) { $("because").textContent = W("This browser cannot record a film."); return; }
  const stream = page.captureStream(30), ear = audio && new MediaStreamAudioDestinationNode(audio);
  if (ear) { audio.out.connect(ear); for (const track of ear.stream.getAudioTracks()) stream.addTrack(track); }
  const end = kind.startsWith("video/mp4") ? "mp4" : "webm";
  recorder = Object.assign(new MediaRecorder(stream, { mimeType: kind, videoBitsPerSecond: 8e6 }), { began: performance.now() });
  recorder.ondataavailable = e => pieces.push(e.data);
  recorder.onstop = () => {
    const told = `${lastsFor()} s`;
    recorder = null;
    Object.assign($("film"), { ariaPressed: false, textContent: W("film") });
    $("said").textContent = $("because").textContent = W("A film of {0} is saved: {1}", told, "spincyl." + end);
    keep(new Blob(pieces, { type: "video/" + end }), "spincyl." + end);
  };
  recorder.start();
  $("film").ariaPressed = true;
  show();
}
const filmed = () => { if (recorder) { compose(); $("film").textContent = W("stop {0} s", lastsFor()); } };
$("png").onclick = photograph;
$("film").onclick = film;
