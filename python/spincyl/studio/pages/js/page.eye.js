// Letters at the tips of arrows, and control of the view by mouse, touch and keys.

// places the letters beside the tips, each on the side away from the other arrow
function named(m, p, arrows, width, height) {
  const flat = arrows.map(arrow => {
    if (!arrow) return null;
    const [root, tip] = [arrow.root, along([1, arrow.root], [arrow.length, arrow.along])].map(place => project(m, place, width, height));
    const [dx, dy] = [tip[0] - root[0], tip[1] - root[1]], size = Math.hypot(dx, dy);
    // an arrow towards the eye has a letter as well
    return { tip, to: size < 1 ? [0, -1] : [dx / size, dy / size] };
  });
  ARROWS.forEach((v, k) => {
    const [a, b] = [flat[k & ~1], flat[k | 1]].map(f => f?.to), swapped = a && b && a[0] * b[1] - a[1] * b[0] < -1e-3;
    const letter = m.tips[v], f = flat[k];
    letter.hidden = !f;
    if (!f) return;
    const em = parseFloat(getComputedStyle(letter).fontSize), right = (!(k & 1) === !swapped ? -0.8 : 0.8) * em;
    const inside = (x, most) => Math.min(Math.max(x, 0.6 * em), most - 0.6 * em);
    letter.style.transform = `translate(${inside(f.tip[0] - f.to[1] * right, width)}px, ${inside(f.tip[1] + f.to[0] * right, height)}px) translate(-50%, -50%)`;
  });
  opposite(p).forEach((place, k) => {
    const letter = m.tips[POINTS[k]], [x, y] = project(m, place, width, height);
    letter.hidden = !$("axis").checked || $("shutter").value !== "0";
    letter.style.transform = `translate(calc(${x}px + .7em), calc(${y}px + .3em)) translate(-50%, -50%)`;
  });
}

function turn(dx, dy) {
  if ($("shutter").value !== "0") return;
  $("above").checked = false;
  eye.azimuth -= dx;
  eye.elevation = Math.min(1.55, Math.max(0.03, eye.elevation + dy));
  show();
}
function zoom(by) { eye.zoom = Math.min(20, Math.max(0.2, eye.zoom * by)); forget(); show(); }
const fingers = new Map();
canvas.onpointerdown = e => { canvas.setPointerCapture(e.pointerId); fingers.set(e.pointerId, [e.clientX, e.clientY]); };
canvas.onpointerup = canvas.onpointercancel = e => fingers.delete(e.pointerId);
canvas.onpointermove = e => {
  const was = fingers.get(e.pointerId), is = [e.clientX, e.clientY];
  if (!was) return;
  const other = [...fingers].find(([id]) => id !== e.pointerId)?.[1];
  if (other) zoom(Math.hypot(is[0] - other[0], is[1] - other[1]) / Math.max(1, Math.hypot(was[0] - other[0], was[1] - other[1])));
  else turn((is[0] - was[0]) / 200, (is[1] - was[1]) / 200);
  fingers.set(e.pointerId, is);
};
// in a frame, scrolling the outer page has priority until the canvas has the focus
if (inside) canvas.style.touchAction = "pan-y";
canvas.onwheel = e => { if (inside && !e.ctrlKey && document.activeElement !== canvas) return; e.preventDefault(); zoom(Math.exp(-e.deltaY / 800)); };
