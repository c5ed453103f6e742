// The long exposure: the sum of many pictures in a dark room.

const exposing = { canFloat: gl.getExtension("EXT_color_buffer_float"), count: 0, most: 720, gain: 1, targets: null };
$("shutter").disabled = !exposing.canFloat;

function target(width, height, kind) {
  const texture = gl.createTexture(), buffer = gl.createFramebuffer();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, kind, width, height);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  gl.bindFramebuffer(gl.FRAMEBUFFER, buffer);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  let depth = null;
  if (kind === gl.RGBA8) {
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
  exposing.targets = null;
  exposing.count = 0;
}

// when the body has turned so often from t on, at most the end
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

function expose(views) {
  if (!exposing.targets) {
    exposing.targets = [target(canvas.width, canvas.height, gl.RGBA8), target(canvas.width, canvas.height, gl.RGBA32F), target(canvas.width, canvas.height, gl.RGBA32F)];
    const turns = Number($("shutter").value);
    for (const m of motions) m.shut = closing(m, now, turns);
  }
  const bind = (unit, texture) => { gl.activeTexture(gl.TEXTURE0 + unit); gl.bindTexture(gl.TEXTURE_2D, texture); };
  const until = performance.now() + 25;
  do {
    const [frame, sum, next] = exposing.targets, share = (0.5 + exposing.count * 0.6180339887498949) % 1;
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame.buffer);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.disable(gl.SCISSOR_TEST);
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.CULL_FACE);
    gl.clearColor(0, 0, 0, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(surface.made);
    for (const [m, x, y, w, h] of views) {
      gl.viewport(x, y, w, h);
      gl.uniformMatrix4fv(surface.camera, false, camera(m, w / h, true));
      const start = Math.min(now, m.last), p = pose(m, start + share * (m.shut - start));
      for (const piece of shapes[m.shape]) fill(piece, p.matrix, piece.mark ? piece.colour.map(c => Math.min(1, c * 1.15 + 0.12)) : [0.006, 0.006, 0.0065], piece.mark ? 0 : 1);
    }
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.CULL_FACE);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, next.buffer);
    gl.useProgram(adding.made);
    bind(0, sum.texture);
    bind(1, frame.texture);
    gl.uniform1i(adding.sum, 0);
    gl.uniform1i(adding.frame, 1);
    gl.bindVertexArray(quad.vao);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    exposing.targets = [frame, next, sum];
  } while (++exposing.count < exposing.most && performance.now() < until);
  if (exposing.count === exposing.most || exposing.count < 40) { // the brightest place sets the gain
    const light = new Float32Array(4 * canvas.width * canvas.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, exposing.targets[1].buffer);
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.FLOAT, light);
    let most = 0;
    for (let i = 0; i < light.length; i += 4) most = Math.max(most, light[i], light[i + 2]);
    exposing.gain = 2 * exposing.count / Math.max(most, 1e-3);
  }
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  gl.useProgram(developing.made);
  bind(0, exposing.targets[1].texture);
  gl.uniform1i(developing.sum, 0);
  gl.uniform1f(developing.gain, exposing.gain / exposing.count);
  gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  document.documentElement.dataset.exposed = exposing.count;
  return exposing.count < exposing.most;
}
