"""The pictures of docs/desk.md: each block of the page runs, and its motion `m` is drawn."""

import re
from pathlib import Path
from typing import Any

from PIL import Image

import spincyl as sc

DOCS = Path(__file__).parents[1] / "docs"
# options of a picture: a time in seconds, or times from left to right, and arguments of `sc.view`
HOW: dict[str, dict[str, Any]] = {
    "tube": {"above": True, "exposure": 1},
    "top": {"t": 1.0},
    "spoon": {"t": 1.5},
    "egg": {"t": 1.1},
    "hoop": {"t": 0.5, "follow": True},
    "wheel": {"t": 2.2, "follow": True},
    "ball": {"t": 0.25, "follow": True, "drawn": ["path", "velocity"]},
    "unbalanced": {"t": [0.0, 0.23, 0.46], "follow": True},
}


def side_by_side(view: sc.View, path: Path, times: list[float]) -> None:
    """Write the view at these times into one picture."""
    each = (-(-640 // len(times)), 360)
    stills = []
    for t in times:
        view.save(path, size=each, t=t)
        with Image.open(path) as opened:
            stills.append(opened.convert("RGB"))
    whole = Image.new("RGB", (each[0] * len(times), each[1]))
    for k, still in enumerate(stills):
        whole.paste(still, (k * each[0], 0))
    whole.save(path)


def main() -> None:
    """Draw all pictures of docs/desk.md, and replace their files."""
    page = (DOCS / "desk.md").read_text("utf-8")
    for path, code in re.findall(
        r"\((figures/desk/\w+\.png)\)\n\n```python\n(.*?)```", page, re.S
    ):
        room: dict[str, Any] = {}
        exec(code, room)
        how = dict(HOW.get(Path(path).stem, {}))
        m, t = room["m"], how.pop("t", None)
        view = sc.view(m, scale=m.scale, **how)
        if isinstance(t, list):
            side_by_side(view, DOCS / path, t)
        else:
            view.save(DOCS / path, size=(640, 360), t=t)


if __name__ == "__main__":
    main()
