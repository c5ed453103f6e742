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
from cycler import cycler
from matplotlib.figure import Figure

#: in the order of docs/gallery.md
SCENES = (
    "near_steady_tube",
    "flicked_tube",
    "hopping_tube",
    "dropped_coin",
    "dropped_egg",
    "eulers_disk_stops",
    "rocking_can",
    "hurricane_balls",
    "hula_hoop",
    "tippe_top_turns",
    "hopping_top",
    "billiard",
    "falling_pencil",
    "rolled_cup",
    "tipped_bottle",
    "sliding_puck",
    "pushed_can",
    "race_downhill",
    "turntable",
    "rattleback",
    "rising_egg",
)
#: as large as a slide, in colours that everybody tells apart
STYLE: Any = {
    "axes.labelsize": "medium",
    "axes.prop_cycle": cycler(color=["#0072B2", "#D55E00", "#009E73", "#CC79A7"]),
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": "medium",
    "axes.titlepad": 10,
    "figure.constrained_layout.use": True,
    "figure.figsize": (9.6, 5.4),
    "font.size": 15,
    "legend.fontsize": "small",
    "legend.frameon": False,
    "lines.linewidth": 2,
}


def draw(scene: str) -> Figure:
    """The picture of a scene."""
    with plt.rc_context(STYLE):
        plt.close("all")
        importlib.import_module(scene).picture()
        return plt.gcf()


def main() -> None:
    """Write the chosen pictures."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/figures/gallery")
    folder.mkdir(parents=True, exist_ok=True)
    for scene in sys.argv[2:] or SCENES:
        draw(scene).savefig(folder / f"{scene}.png", dpi=150)
        print(folder / f"{scene}.png")


if __name__ == "__main__":
    main()
