"""Makes the tables of the lab page: computed, with errors from a random generator; no measurement."""

from pathlib import Path

import numpy as np

import spincyl as sc

tube = sc.Body.from_metres(outer_diameter=15.875e-3, inner_diameter=12.7e-3, length=95.25e-3)
scale = sc.Scale(radius=15.875e-3 / 2)
rng = np.random.default_rng(12)
seconds = np.arange(34) / 240
state = tube.steady(np.radians(83.4))
m = sc.roll(tube, state, seconds / scale.seconds(1.0), want="pose")
axis = -np.column_stack([np.sin(m.theta) * np.cos(m.phi), np.sin(m.theta) * np.sin(m.phi)])
ends = [
    scale.metres(m.centre[:, :2] + sign * tube.ell * axis) + rng.normal(0, 2e-4, axis.shape)
    for sign in (1, -1)
]
lines = ["#multi:", "\tO\t\tX\t", "t\tx\ty\tx\ty"]
for i, row in enumerate(zip(seconds, *ends[0].T, *ends[1].T, strict=True)):
    cells = [f"{x:.6E}".replace(".", ",") for x in row]
    if i in (11, 12):  # the mark was not found
        cells[3:] = ["", ""]
    lines.append("\t".join(cells))
Path(__file__).with_name("tube_from_above.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")

# ten flicks: inclination and turns per second, as read off the films
degrees = np.array([4.5, 5.5, 6.5, 7.5, 73.0, 75.0, 77.0, 79.0, 82.0, 85.0])
hertz = scale.hertz(tube, tube.rate(np.radians(degrees)))
table = np.column_stack([rng.normal(degrees, 0.5), rng.normal(hertz, 0.02 * hertz)])
np.savetxt(Path(__file__).with_name("flicks.csv"), table, "%.2f", delimiter=",", header="degrees,hertz")
