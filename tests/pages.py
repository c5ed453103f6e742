"""What the tests of pages share: ways to look at a page; `shown` of conftest.py opens one, page_scenes.py has them."""

import base64
import io

import numpy as np
from PIL import Image
from playing import settled

#: Where numbers are asked for, and nobody looks.
SMALL = {"width": 160, "height": 120}


def picture(page, selector="canvas"):
    settled(page)
    shot = page.locator(selector).screenshot()
    return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB"), float) / 255


#: Records the positions, normals and colours sent to the graphics card.
SENT = """
window.sent = [];
const send = WebGL2RenderingContext.prototype.bufferData;
WebGL2RenderingContext.prototype.bufferData = function (kind, values, ...how) {
  if (kind === this.ARRAY_BUFFER) {
    const bytes = new Uint8Array(Float32Array.from(values).buffer);
    window.sent.push(btoa(Array.from(bytes, (x) => String.fromCharCode(x)).join("")));
  }
  return send.call(this, kind, values, ...how);
};
"""


def sent(page):
    """The arrays that a page opened with the script SENT has sent to the graphics card."""
    return [np.frombuffer(base64.b64decode(x), np.float32) for x in page.evaluate("window.sent")]


def near(image, colour, width=0.12):
    """Share of the pixels whose hue is close to a colour, at any brightness."""
    hue = np.array(colour) / np.linalg.norm(colour)
    size = np.linalg.norm(image, axis=-1)
    return float(((image @ hue > (1 - width**2) * size) & (size > 0.15)).mean())


def between(knots, t):
    """What a page draws at ascending times between knots: their numbers after the time, and then their slopes."""
    half = (knots.shape[1] + 1) // 2
    i = np.clip(np.searchsorted(knots[:, 0], t) - 1, 0, len(knots) - 2)
    h, s = np.diff(knots[:, 0])[i, None], ((t - knots[i, 0]) / np.diff(knots[:, 0])[i])[:, None]
    basis = [(1 + 2 * s) * (1 - s) ** 2, s * s * (3 - 2 * s), s * (1 - s) ** 2 * h, s * s * (s - 1) * h]
    pieces = [knots[i, 1:half], knots[i + 1, 1:half], knots[i, half:], knots[i + 1, half:]]
    return sum(b * p for b, p in zip(basis, pieces, strict=True))


def go(page, t):
    """Sets the time by the slider, and waits for the picture."""
    page.locator("#time").evaluate("(e, t) => { e.value = t; e.dispatchEvent(new Event('input')); }", t)
    settled(page)


def at(page):
    return page.evaluate("window.spincyl.at()")


def clock(page, i=0):
    return page.locator(".clock").nth(i).inner_text().replace("\xa0", " ")


def arrow(page, name):
    """Where the head of an arrow is in the picture, from the middle of the body, in pixels, right and up."""
    hidden = page.add_style_tag(content=".tip { visibility: hidden }")
    plain = picture(page)
    page.locator(f"#{name}").click()
    changed = np.abs(picture(page) - plain).max(axis=-1) > 0.15
    page.locator(f"#{name}").click()
    hidden.evaluate("e => e.remove()")
    rows, columns = np.nonzero(changed)
    centre = np.array(page.evaluate("window.spincyl.on(0, window.spincyl.at())"))
    away = np.column_stack([columns, rows]) - centre
    return away[np.argmax(np.hypot(*away.T))] * [1, -1]
