"""The pictures of docs/desk.md: each block of the page runs, and its motion `m` is drawn."""

import re
from pathlib import Path
from typing import Any

import spincyl as sc

DOCS = Path(__file__).parents[1] / "docs"
# options of a picture: a time in seconds, or arguments of `sc.view`
HOW: dict[str, dict[str, Any]] = {
    "tube": {"above": True, "exposure": 1},
    "top": {"t": 1.0},
    "spoon": {"t": 1.5},
    "egg": {"t": 1.1},
    "hoop": {"t": 0.5, "follow": True},
    "wheel": {"t": 1.0, "follow": True},
    "ball": {"t": 0.25, "follow": True, "drawn": ["path", "velocity"]},
}


def main() -> None:
    """Draw the pictures again."""
    page = (DOCS / "desk.md").read_text("utf-8")
    for path, code in re.findall(
        r"\((figures/desk/\w+\.png)\)\n\n```python\n(.*?)```", page, re.S
    ):
        room: dict[str, Any] = {}
        exec(code, room)
        how = dict(HOW.get(Path(path).stem, {}))
        m, t = room["m"], how.pop("t", None)
        sc.view(m, scale=m.scale, **how).save(DOCS / path, size=(640, 360), t=t)


if __name__ == "__main__":
    main()
