"""Helpers of the page tests: bodies, and ways to examine a page; `shown` of conftest.py opens one."""

import base64
import io

import numpy as np
from nutating_cylinder import start as START
from PIL import Image

import spincyl as sc

CYLINDER, PIPE, DISK = sc.Body.solid(2.5), sc.Body.tube(6.0, bore=0.8), sc.Body.solid(0.375)
CAN, COIN = sc.Body.solid(1.0), sc.Body.solid(0.0852)
ROUNDED, CAPSULE, BALLS = sc.Body.solid(1.5, fillet=0.3), sc.Body.solid(2.5, fillet=1.0), sc.Body.balls()
TIPPE = sc.Body.ball(-0.3, 0.45, 0.42)


def nutating():
    return sc.roll(CYLINDER, START, 20.0)


def picture(page, selector="canvas"):
    page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
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


def at(page):
    return page.evaluate("window.spincyl.at()")


def clock(page, i=0):
    return page.locator(".clock").nth(i).inner_text().replace("\xa0", " ")


def arrow(page, name):
    """Position of an arrow's head in the picture, from the middle of the body, in pixels right and up."""
    page.add_style_tag(content=".tip { visibility: hidden }")
    plain = picture(page)
    page.locator(f"#{name}").click()
    changed = np.abs(picture(page) - plain).max(axis=-1) > 0.15
    page.locator(f"#{name}").click()
    rows, columns = np.nonzero(changed)
    centre = np.array(page.evaluate("window.spincyl.on(0, window.spincyl.at())"))
    away = np.column_stack([columns, rows]) - centre
    return away[np.argmax(np.hypot(*away.T))] * [1, -1]
