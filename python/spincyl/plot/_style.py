"""What the pictures share: axes, and the colours of Okabe and Ito, told apart by the colour-blind."""

from typing import TYPE_CHECKING, Any

from spincyl._array import extra
from spincyl._body import Contact

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BLUE, ORANGE, GREEN, PURPLE, SKY, BLACK = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#222222"
FORBIDDEN, UNSTABLE, ROLLING, STABLE = "#BDBDBD", "#F6C9A8", "#F0E442", "#BFDDF2"
FONT = 13.0


def new_axes(ax: "Axes | None") -> "Axes":
    plt: Any = extra("matplotlib.pyplot", "plot")
    if ax is None:
        _, ax = plt.subplots(figsize=(8, 5.6), layout="constrained")
    ax.tick_params(labelsize=FONT - 1)
    return ax


def title(contact: Contact | None, bore: float) -> str:
    table = {
        "smooth": "smooth table (the paper's criterion)",
        "rolling": "rolling without slipping",
        None: "steady states, by both criteria",
    }
    return table[contact] + (f", bore {bore:g}" if bore else "")
