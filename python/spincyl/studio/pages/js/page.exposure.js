// The long exposure: the sum of many pictures in a dark room.

// Blending adds up to sixteen pictures in half precision, then adds them to the sum in single precision. The
// next few are drawn when the graphics card, or the software in its place, has finished the previous ones.
const PICTURES = 720, TOGETHER = 16;
const exposing = { targets: null };
const REST = N("ω, L, path and view stay as they are until the photograph is closed.");

function target(width, height, kind) {
  const texture = gl.createTexture(), buffer = gl.createFramebuffer();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, kind, width, height);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  gl.bindFramebuffer(gl.FRAMEBUFFER, buffer);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  let depth = null;
  if (kind === gl.RGBA16F) {
    depth = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
  }
  gl.clearColor(0, 0, 0, 1);
  gl.clear(gl.COLOR_BUFFER_BIT);
  return { texture, buffer, depth };
}

function forget() {
  for (const t of exposing.targets || []) {
    gl.deleteTexture(t.texture);
    gl.deleteFramebuffer(t.buffer);
    if (t.depth) gl.deleteRenderbuffer(t.depth);
  }
  // pictures begun (`count`), finished (`shown`), wanted (`most`); size (`some`) and fence of a batch
  Object.assign(exposing, { targets: null, count: 0, shown: 0, most: PICTURES, some: 4, fence: null, gain: 1, measured: 0 });
}
forget();

// the time at which the body has made this number of turns since t, at most the end of the motion
function closing(m, t, turns) {
  const end = m.last;
  if (turns === Infinity || t >= end) return end;
  const from = pose(m, t).phi, turned = x => Math.abs(pose(m, x).phi - from) - 2 * Math.PI * turns;
  let high = t, step = (end - t) / 4096;
  while (turned(high) < 0) { high += step; if (high >= end) return end; }
  let low = high - step;
  for (let i = 0; i < 50; i++) { const mid = (low + high) / 2; if (turned(mid) < 0) low = mid; else high = mid; }
  return high;
}

const bind = (unit, texture) => { gl.activeTexture(gl.TEXTURE0 + unit); gl.bindTexture(gl.TEXTURE_2D, texture); };

function open() {
  exposing.targets = [gl.RGBA16F, gl.RGBA32F, gl.RGBA32F].map(kind => target(canvas.width, canvas.height, kind));
  for (const m of motions) {
    m.open = Math.min(Math.max(now, m.first), m.last);
    m.shut = closing(m, m.open, Number($("shutter").value));
    m.at = aim(m);
  }
}

// adds `many` pictures to the sum
function add(views, many) {
  const [frame, sum, next] = exposing.targets;
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame.buffer);
  gl.disable(gl.SCISSOR_TEST);
  gl.enable(gl.DEPTH_TEST);
  gl.enable(gl.CULL_FACE);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.ONE, gl.ONE);
  gl.clearColor(0, 0, 0, 1);
  gl.clear(gl.COLOR_BUFFER_BIT);
  gl.useProgram(surface.made);
  for (let i = 0; i < many; i++, exposing.count++) {
    const share = (0.5 + exposing.count * 0.6180339887498949) % 1;
    gl.clear(gl.DEPTH_BUFFER_BIT);
    for (const [m, x, y, w, h] of views) {
      gl.viewport(x, y, w, h);
      gl.uniformMatrix4fv(surface.camera, false, camera(m, w / h, true));
      gl.uniform3fv(surface.eye, m.from);
      const p = pose(m, m.open + share * (m.shut - m.open));
      for (const piece of shapes[m.shape]) {
        if (piece.mark) fill(piece, p.matrix, piece.colour.map(c => Math.min(1, c * 1.15 + 0.12)), 0);
        // nearly black, so a coarse mesh without edges suffices
        else if (piece.cast) fill(piece.cast, p.matrix, [0.006, 0.006, 0.0065]);
      }
    }
  }
  gl.disable(gl.BLEND);
  gl.disable(gl.DEPTH_TEST);
  gl.disable(gl.CULL_FACE);
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.bindFramebuffer(gl.FRAMEBUFFER, next.buffer);
  gl.useProgram(adding.made);
  bind(0, sum.texture);
  bind(1, frame.texture);
  gl.uniform1i(adding.sum, 0);
  gl.uniform1i(adding.frame, 1);
  quad.bind();
  gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  exposing.targets = [frame, next, sum];
}

// the brightest pixel sets the gain; measured again whenever there are four times as many pictures
function measure() {
  const light = new Float32Array(4 * canvas.width * canvas.height);
  gl.bindFramebuffer(gl.FRAMEBUFFER, exposing.targets[1].buffer);
  gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.FLOAT, light);
  let most = 0;
  for (let i = 0; i < light.length; i += 4) most = Math.max(most, light[i], light[i + 2]);
  exposing.gain = 2 * exposing.count / Math.max(most, 1e-3);
  exposing.measured = exposing.count;
}

function develop() {
  if (exposing.count >= Math.min(4 * exposing.measured, exposing.most)) measure();
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  gl.useProgram(developing.made);
  bind(0, exposing.targets[1].texture);
  gl.uniform1i(developing.sum, 0);
  gl.uniform1f(developing.gain, exposing.gain / exposing.count);
  quad.bind();
  gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  exposing.shown = exposing.count;
}

// continues the photograph, shows its present state, and schedules the next batch
function expose(views) {
  if (!exposing.targets) open();
  if (exposing.fence) {
    if (gl.getSyncParameter(exposing.fence, gl.SYNC_STATUS) !== gl.SIGNALED) { setTimeout(show, 30); return; }
    gl.deleteSync(exposing.fence);
    exposing.fence = null;
    // adapts the batch so that the picture changes about once a second
    const spent = performance.now() - exposing.asked;
    exposing.some = Math.min(64, Math.max(8, spent > 1000 ? exposing.some >> 1 : spent < 500 ? 2 * exposing.some : exposing.some));
    develop();
  }
  const over = exposing.shown >= exposing.most, told = over && exposing.most < PICTURES ? N("Stopped") : over ? N("Done") : N("The shutter is open");
  $("developed").value = exposing.shown / PICTURES;
  $("stop").textContent = over ? W("close") : W("stop");
  $("why").textContent = W("{0}: {1} of {2} pictures, {3}. {4}", W(told), exposing.shown, PICTURES, $("shutter").selectedOptions[0].text, W(REST));
  document.documentElement.dataset.exposed = exposing.shown;
  if (over) { $("said").textContent = $("why").textContent; return; }
  for (const until = Math.min(exposing.count + exposing.some, exposing.most); exposing.count < until;) add(views, Math.min(TOGETHER, until - exposing.count));
  exposing.fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.flush();
  exposing.asked = performance.now();
  show();
}
