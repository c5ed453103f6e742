// The WebGL context. A browser keeps about sixteen at a time: a page takes one when its picture becomes
// visible, and releases it when the picture is out of view.

let canvas = $("canvas"), gl = null, era = 0, without = "", yielded = false;
const inside = window.top !== window;
let seen = !inside; // a frame may be scrolled out of view: the observer below decides
// handlers that move to a new canvas
const HANDS = ["onpointerdown", "onpointermove", "onpointerup", "onpointercancel", "onwheel"];

// returns whether there is a context to draw with; objects made before `era` grew are lost
function lit() {
  if (gl && !gl.isContextLost()) return true;
  if (!seen || without) return false;
  if (gl && !yielded) { unlit(W("The browser has taken this picture back: it keeps only so many at a time.")); return false; }
  if (gl) { // a canvas never gets a second context: replace it
    const old = canvas, at = document.activeElement === old;
    canvas = old.cloneNode();
    for (const hand of HANDS) canvas[hand] = old[hand];
    old.replaceWith(canvas);
    if (at) canvas.focus({ preventScroll: true });
  }
  yielded = false;
  // the live page copies the canvas into films
  gl = canvas.getContext("webgl2", { antialias: true, stencil: true, alpha: false, preserveDrawingBuffer: !!window.spincyl });
  if (!gl) { unlit(W("The body is drawn with WebGL 2, which this browser lacks or has switched off.")); return false; }
  era++;
  gl.vertexAttrib3f(1, 0, 0, 1); // meshes without normals lie on the table
  canvas.addEventListener("webglcontextlost", () => show());
  const adds = gl.getExtension("EXT_color_buffer_float");
  $("shutter").disabled = !adds;
  $("shutter").title = adds ? "" : W("This browser cannot add up pictures.");
  return true;
}
function unlit(why) {
  without = why;
  $("unlit").firstChild.textContent = why + " ";
  $("unlit").hidden = !why;
  $("relight").hidden = !gl;
  $("drawn").disabled = $("shutter").disabled = !!why;
  queueMicrotask(() => { forget(); show(); }); // after the rest of the page is defined
}
function relit() { if (gl && without) { yielded = true; unlit(""); } }
$("relight").onclick = relit;
new IntersectionObserver(all => {
  const was = seen;
  seen = all.at(-1).isIntersecting;
  if (was === seen) return;
  before = null;
  if (seen) { relit(); show(); return; }
  forget();
  yielded = true;
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
}).observe(stage);
lit();
