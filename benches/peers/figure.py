"""Speed against error of every job, in small panels: farther right is more exact, lower is faster."""

COLOURS = {
    "spincyl": "#0072b2",
    "heyoka": "#d55e00",
    "numba": "#009e73",
    "SciPy": "#777777",
    "NumPy": "#cc79a7",
}
MARKS = "os^vDP"
LINEAR = "map"  # its errors are of similar size


def look(name, seen):
    """Colour by library, marker by contestant of that library."""
    library = next((x for x in COLOURS if name.startswith(x)), "")
    mark = seen.setdefault(library, {})
    return COLOURS.get(library, "#000000"), MARKS[mark.setdefault(name, len(mark)) % len(MARKS)]


def draw(panels, path):
    import matplotlib

    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    panels = {title: found for title, found in panels.items() if found}
    columns = 3 if len(panels) > 4 else 2
    rows = -(-len(panels) // columns)
    drawn, axes = plt.subplots(
        rows, columns, figsize=(5.2 * columns, 4.7 * rows), layout="constrained", squeeze=False
    )
    for ax in axes.flat[len(panels) :]:
        ax.set_axis_off()
    for ax, (title, found) in zip(axes.flat, panels.items(), strict=False):
        seen = {}
        for name, points in found.items():
            colour, mark = look(name, seen)
            x, y = zip(*((max(off, 1e-16), cost) for _, cost, off in points if off < 1e3), strict=True)
            ax.plot(
                x, y, mark + ("-" if len(x) > 1 else ""), color=colour, label=name, markersize=7, alpha=0.9
            )
        wide = max(map(len, found)) > 16
        lines = len(found) if wide else -(-len(found) // 2)
        if title.startswith(LINEAR):
            ax.set_xlabel("largest error, ulp over 1 + kappa_c", fontsize=13)
            ax.set_xlim(left=0)
            ax.set_ylim(0, (1 + 0.15 * lines) * ax.get_ylim()[1])
        else:
            ax.loglog()
            ax.set_xlabel("error", fontsize=13)
            low, high = ax.get_ylim()
            ax.set_ylim(low, high * (high / low) ** (0.09 * lines))
        ax.invert_xaxis()
        ax.set_title(title, fontsize=15)
        ax.tick_params(labelsize=12)
        ax.grid(alpha=0.3)
        ax.legend(
            fontsize=9 if lines > 4 else 11,
            loc="upper left",
            ncols=1 if wide else 2,
            framealpha=0.8,
            columnspacing=0.8,
            handletextpad=0.3,
            labelspacing=0.25,
        )
    drawn.savefig(path, dpi=100)
    plt.close(drawn)
