"""The live page in a notebook, both ways: what is set in Python moves the body, a drag is seen in Python."""

from typing import TYPE_CHECKING, Any

import anywidget
import traitlets

if TYPE_CHECKING:
    from spincyl._play import Play

_SCRIPT = """
export default {
  render({ model, el }) {
    const frame = document.createElement("iframe");
    Object.assign(frame, { srcdoc: model.get("page"), style: model.get("look") });
    frame.setAttribute("sandbox", model.get("sandbox"));
    const wants = () => frame.contentWindow.postMessage({ spincyl: model.get("wanted") }, "*");
    const hears = e => {
      if (e.source !== frame.contentWindow || !e.data?.spincyl) return;
      model.set("told", e.data.spincyl);
      model.save_changes();
    };
    addEventListener("message", hears);
    model.on("change:wanted", wants);
    el.append(frame);
    return () => { removeEventListener("message", hears); model.off("change:wanted", wants); };
  },
};
"""


class Widget(anywidget.AnyWidget):  # type: ignore[misc, unused-ignore]
    """The page in a frame, with what is wanted of it and what it tells."""

    _esm = _SCRIPT
    page = traitlets.Unicode().tag(sync=True)
    look = traitlets.Unicode().tag(sync=True)
    sandbox = traitlets.Unicode().tag(sync=True)
    wanted = traitlets.Dict().tag(sync=True)
    told = traitlets.Dict().tag(sync=True)


def widget(of: "Play", look: str, sandbox: str) -> Any:
    """A widget that shows a page and hears what hands do there."""
    made = Widget(page=of.html, look=look, sandbox=sandbox)
    made.observe(of._heard, "told")
    return made
