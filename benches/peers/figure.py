"""The figure of docs/benchmarks.md about other programs, drawn from the tables of that page.

python benches/peers/figure.py
"""

import pathlib
import re

ROOT = pathlib.Path(__file__).parents[2]
PAGE, PICTURE = ROOT / "docs" / "benchmarks.md", ROOT / "docs" / "figures" / "peers.png"
JOB = "wide nutation, kick 0.4"  # the set of motions whose times are drawn against their errors
#: the programs that are drawn, with their colours, and where in points their names stand from their last points
PROGRAMS = {
    "spincyl": ("#0072b2", (0, -32)),
    "heyoka, 8 motions at a time": ("#d55e00", (0, -32)),
    "numba RK4": ("#009e73", (-12, 14)),
    "SciPy DOP853": ("#555555", (-10, 14)),
}
#: the jobs whose ratios are drawn, in the words of the figure
JOBS = {
    "small nutation, kick 0.05": "rolling, it hardly nods",
    "wide nutation, kick 0.4": "rolling, it nods",
    "very wide nutation, kick 0.8": "rolling, it nods widely",
    "random initial states": "rolling, any start",
    "rates at scattered points, 1 thread": "steady states, scattered",
    "coins that whirr": "a coin that whirrs, losses",
    "a single motion": "a single motion",
    "launches of a tube with friction": "slipping until it rolls",
    "rates on a grid, 1 thread": "steady states on a grid",
}


def rows_of(page, section):
    """The rows of the first table of a section of the page, as lists of text."""
    begin, end = (f"<!-- {x} {section} -->" for x in ("written by benches/peers/main.py:", "end of"))
    text = page.split(begin, 1)[1].split(end, 1)[0]
    lines = re.search(r"(?:^\|.*\|\n)+", text, re.M).group().splitlines()
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def curves(page):
    """Errors and times in µs of the programs at `JOB`, from coarse to fine."""
    found = {}
    for job, program, _, cost, off, *_ in rows_of(page, "motions"):
        if job == JOB and program in PROGRAMS:
            found.setdefault(program, []).append((float(off), float(cost)))
    return {program: sorted(found[program], reverse=True) for program in PROGRAMS if program in found}


def ratios(page):
    """How many times as fast spincyl is as the fastest other program, at the smallest error of each job."""
    last = {row[0]: float(row[6]) for row in rows_of(page, "ratios")}
    return {words: last[job] for job, words in JOBS.items() if job in last}


def draw(page, path=PICTURE):
    """Draw the times of one job against their errors, and the ratios of all jobs."""
    import matplotlib

    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    drawn, (left, right) = plt.subplots(1, 2, figsize=(12.8, 7.2), layout="constrained")
    for program, points in curves(page).items():
        colour, beside = PROGRAMS[program]
        left.loglog(*zip(*points, strict=True), "o-", color=colour, ms=8, lw=2.5)
        how = {"textcoords": "offset points", "ha": "right", "size": 18, "color": colour}
        left.annotate(program.split(",")[0], points[-1], beside, **how)
    left.invert_xaxis()
    left.margins(y=0.1)
    left.set_xlabel("largest error (right: more exact)", size=17)
    left.set_ylabel("microseconds for a motion", size=17)
    left.set_title("65,536 cylinders that roll and nod", size=19, pad=12)
    found = ratios(page)
    for k, ratio in enumerate(found.values()):
        colour = PROGRAMS["spincyl"][0] if ratio >= 1 else PROGRAMS["heyoka, 8 motions at a time"][0]
        right.plot((1, ratio), (k, k), color=colour, lw=2.5)
        right.plot(ratio, k, "o", color=colour, ms=11)
        shift, side = (12, "left") if ratio >= 1 else (-12, "right")
        number = f"{ratio:.0f}" if ratio >= 9.5 else f"{ratio:.1f}"
        how = {"textcoords": "offset points", "va": "center", "ha": side, "size": 18, "color": colour}
        right.annotate(number, (ratio, k), (shift, 0), **how)
    right.axvline(1, color="0.4", lw=1)
    right.set(xscale="log", xlim=(0.35, 90), ylim=(len(found) - 0.4, -0.6))
    right.set_yticks(range(len(found)), list(found))
    right.set_xticks((1, 10), ("equal", "10"))
    right.minorticks_off()
    right.tick_params(axis="y", length=0)
    right.set_title("how many times as fast", size=19, pad=12)
    for ax in (left, right):
        ax.tick_params(labelsize=16)
        ax.spines[["top", "right"]].set_visible(False)
    rolling = [found[words] for words in found if words.startswith("rolling")]
    slower = sum(ratio < 1 for ratio in found.values())
    drawn.suptitle(
        f"Many motions that roll: spincyl is {min(rolling):.0f} to {max(rolling):.0f} times as fast\n"
        f"as the fastest other program; in {slower} of these {len(found)} jobs it is slower",
        size=23,
    )
    drawn.savefig(path, dpi=150)
    plt.close(drawn)


if __name__ == "__main__":
    draw(PAGE.read_text("utf-8"))
    print(PICTURE)
