"""The pictures of docs/gallery.md, each drawn by its scene.

python examples/gallery.py [FOLDER [SCENE ...]]       writes FOLDER/SCENE.png (default: docs/figures/gallery)
"""

import importlib
import sys
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
from matplotlib.figure import Figure

#: in the order of docs/gallery.md
SCENES = (
    "near_steady_tube",
    "flicked_tube",
    "eulers_disk_stops",
    "rocking_can",
    "hurricane_balls",
    "hula_hoop",
    "tippe_top_turns",
    "falling_pencil",
    "rattleback",
    "rising_egg",
)
STYLE: Any = {
    "axes.titlesize": "medium",
    "figure.constrained_layout.use": True,
    "figure.figsize": (9, 4.2),
    "font.size": 12,
    "legend.fontsize": "small",
}


def draw(scene: str) -> Figure:
    """The picture of a scene."""
    with plt.rc_context(STYLE):
        plt.close("all")
        importlib.import_module(scene).picture()
        return plt.gcf()


def main() -> None:
    """Write the pictures that were asked for."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/figures/gallery")
    folder.mkdir(parents=True, exist_ok=True)
    for scene in sys.argv[2:] or SCENES:
        draw(scene).savefig(folder / f"{scene}.png", dpi=120)
        print(folder / f"{scene}.png")


if __name__ == "__main__":
    main()
