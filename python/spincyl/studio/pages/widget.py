"""The live page in a notebook: changes in Python move the body, and changes on the page reach Python.

The output of a cell is the page itself, in a frame with a name. The widget has no view: its script, which
runs where its model is created, keeps all frames of that name in the same state.
"""

from collections.abc import Callable
from typing import Any
from uuid import uuid4

import anywidget
import traitlets

#: A new frame requests the state by sending null; a model that is created later sends it unrequested.
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
    """State that is shared by all frames in a notebook that have one name."""

    _esm = _SCRIPT
    name = traitlets.Unicode().tag(sync=True)
    state = traitlets.Dict().tag(sync=True)


def widget(state: dict[str, Any], heard: Callable[[Any], None]) -> Any:
    """A widget with this state, which calls `heard` when the state changes."""
    made = Widget(name=f"spincyl-{uuid4().hex}", state=state)
    made.observe(heard, "state")
    return made


def watched() -> bool:
    """Whether a user may be present in the notebook.

    A program that runs a notebook, such as nbconvert, accepts no input. It would store the widget, and its
    page would load the script for widgets from a network.
    """
    try:
        from IPython import get_ipython

        asked = get_ipython().kernel.get_parent("shell")["content"]
        return bool(asked.get("allow_stdin", True))
    except (AttributeError, ImportError, KeyError, TypeError):
        return True
