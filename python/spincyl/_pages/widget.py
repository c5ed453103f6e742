"""The live page in a notebook, both ways: what is set in Python moves the body, a drag is seen in Python.

The output of a cell is the page itself, in a frame with a name. The widget has no view: where its model is
made the script below listens to the frames of this name and passes on one state, so that all of them show it.
"""

from collections.abc import Callable
from typing import Any
from uuid import uuid4

import anywidget
import traitlets

#: A frame that opens asks, with null; a model that is made later than a frame tells it unasked.
_SCRIPT = """
export default {
  initialize({ model }) {
    const frames = document.getElementsByName(model.get("name"));
    const pages = () => Array.from(frames, frame => frame.contentWindow);
    let teller = null;
    const tell = page => page?.postMessage({ spincyl: model.get("state") }, "*");
    const tells = () => pages().filter(page => page !== teller).forEach(tell);
    const hears = ({ data, source }) => {
      if (data?.spincyl === undefined || !pages().includes(source)) return;
      if (data.spincyl === null) { tell(source); return; }
      teller = source;
      model.set("state", data.spincyl);
      teller = null;
      model.save_changes();
    };
    addEventListener("message", hears);
    model.on("change:state", tells);
    tells();
    return () => { removeEventListener("message", hears); model.off("change:state", tells); };
  },
};
"""


class Widget(anywidget.AnyWidget):  # type: ignore[misc, unused-ignore]
    """The one state of all frames of a name."""

    _esm = _SCRIPT
    name = traitlets.Unicode().tag(sync=True)
    state = traitlets.Dict().tag(sync=True)


def widget(state: dict[str, Any], heard: Callable[[Any], None]) -> Any:
    """A widget with this state, that calls when another one is set."""
    made = Widget(name=f"spincyl-{uuid4().hex}", state=state)
    made.observe(heard, "state")
    return made


def watched() -> bool:
    """Whether somebody may sit at the notebook.

    A program that runs a notebook, such as nbconvert, takes no input. It would keep the widget, and the page
    that it writes would ask a network for the script that shows widgets.
    """
    try:
        from IPython import get_ipython

        asked = get_ipython().kernel.get_parent("shell")["content"]
        return bool(asked.get("allow_stdin", True))
    except (AttributeError, ImportError, KeyError, TypeError):
        return True
