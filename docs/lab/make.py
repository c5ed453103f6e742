"""Makes the sample data of the lab page: computed, with errors from a random generator; no measurement."""

import wave
from pathlib import Path

import numpy as np

import spincyl as sc

ROOM = Path(__file__).parents[2] / "python/spincyl/data/examples"

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
(ROOM / "tube_from_above.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")

# ten flicks: inclination and turns per second, as read off the films
degrees = np.array([4.5, 5.5, 6.5, 7.5, 73.0, 75.0, 77.0, 79.0, 82.0, 85.0])
hertz = scale.hertz(tube, tube.rate(np.radians(degrees)))
table = np.column_stack([rng.normal(degrees, 0.5), rng.normal(hertz, 0.02 * hertz)])
np.savetxt(ROOM / "flicks.csv", table, "%.2f", delimiter=",", header="degrees,hertz")

# a spin-down of Euler's disk: filmed (seconds, degrees, turns per second), and heard
disk = sc.Body.from_metres(outer_diameter=75.1e-3, length=12.8e-3)
scale = sc.Scale(radius=75.1e-3 / 2)
rng = np.random.default_rng(14)
whirr = sc.drift(disk, np.radians(20), sc.loss.ViscousContour(2e-4))
stop = scale.seconds(float(whirr.stops_at))
seconds = np.linspace(0, 0.96 * stop, 60)
t = seconds / scale.seconds(1.0)
table = np.column_stack(
    [
        0.5 + seconds,
        rng.normal(1, 0.01, 60) * np.degrees(whirr.theta(t)),
        rng.normal(1, 0.01, 60) * scale.turns(whirr.precession(t)),
    ]
)
path = ROOM / "spin_down.csv"
np.savetxt(path, table, "%.3f", delimiter=",", header="seconds,degrees,turns per second")

hertz = 8000
seconds = np.arange(int(0.99 * stop * hertz)) / hertz
turns = np.cumsum(scale.turns(whirr.precession(seconds / scale.seconds(1.0)))) / hertz
ring = (1 + 0.6 * np.cos(2 * np.pi * turns)) ** 2 * np.sin(2 * np.pi * 3100 * seconds)
noisy = 0.2 * ring + rng.normal(0, 0.1, ring.size)
with wave.open(str(ROOM / "whirr.wav"), "wb") as file:
    file.setnchannels(1)
    file.setsampwidth(1)
    file.setframerate(hertz)
    file.writeframes((128 + 127 * noisy.clip(-1, 1)).astype(np.uint8).tobytes())
