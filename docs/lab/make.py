"""Makes the sample data of the lab page: computed, with errors from a random generator; no measurement."""

import re
import wave
import zipfile
from pathlib import Path

import numpy as np

import spincyl as sc

ROOM = Path(__file__).parents[2] / "python/spincyl/lab/examples"

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

# the same as a project of a film with 1280 x 720 pixels, downward from the corner, and axes 5 degrees askew
HOME = "org.opensourcephysics."


def held(kind: str, **values: object) -> str:
    """An object of a project with its properties; those that are no numbers stand as they are."""
    types = {float: "double", int: "int", bool: "boolean"}
    lines = [
        f'<property name="{name}" type="{types[type(x)]}">{str(x).lower()}</property>'
        if type(x) in types
        else f'<property name="{name}" {x}</property>'
        for name, x in values.items()
    ]
    return f'<object class="{HOME}{kind}">\n' + "\n".join(lines) + "\n</object>\n"


def among(kind: str, items: dict[str, str]) -> str:
    """A property that is an array or a collection of objects."""
    inside = "".join(f'<property name="{n}" type="object">\n{x}</property>\n' for n, x in items.items())
    return f'type="{"collection" if kind[0] == "j" else "array"}" class="{kind}">\n{inside}'


def text(words: str) -> str:
    """The rest of a property that is text."""
    return f'type="string">{words}'


def one(thing: str) -> str:
    """The rest of a property that is an object."""
    return f'type="object">\n{thing}'


places = [(x + 1j * y) * np.exp(1j * np.radians(5.0)) * 6000.0 for x, y in (end.T for end in ends)]
tracks = [held("cabrillo.tracker.CoordAxes", name=text("axes"))]
for name, end in zip("OX", places, strict=True):
    marks = {
        f"[{i}]": held(
            "cabrillo.tracker.PointMass$FrameData", x=round(918 + z.real, 3), y=round(336 - z.imag, 3)
        )
        for i, z in enumerate(end.tolist())
        if name == "O" or i not in (11, 12)
    }
    data = among(f"[L{HOME}cabrillo.tracker.PointMass$FrameData;", marks)
    tracks.append(held("cabrillo.tracker.PointMass", mass=1.0, name=text(name), framedata=data))
axes = held(
    "media.core.ImageCoordSystem$FrameData",
    xorigin=918.0,
    yorigin=336.0,
    angle=5.0,
    xscale=6000.0,
    yscale=6000.0,
)
project = held(
    "cabrillo.tracker.TrackerPanel",
    semantic_version=text("6.1.0"),
    videoclip=one(
        held(
            "media.core.VideoClip", video_framecount=34, startframe=0, stepsize=1, stepcount=34, starttime=0.0
        )
    ),
    clipcontrol=one(held("media.core.StepperClipControl", rate=1.0, delta_t=1000 / 240)),
    coords=one(
        held(
            "media.core.ImageCoordSystem",
            fixedorigin=True,
            fixedangle=True,
            fixedscale=True,
            framedata=among(f"[L{HOME}media.core.ImageCoordSystem$FrameData;", {"[0]": axes}),
        )
    ),
    length_unit=text("m"),
    tracks=among("java.util.ArrayList", {f"item{i}": x for i, x in enumerate(tracks)}),
)
project = '<?xml version="1.0" encoding="UTF-8"?>\n' + re.sub('name="item[0-9]*"', 'name="item"', project)
with zipfile.ZipFile(ROOM / "tube_from_above.trz", "w", zipfile.ZIP_DEFLATED) as packed:
    packed.writestr(zipfile.ZipInfo("tube.trk"), project, zipfile.ZIP_DEFLATED)

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

# a class with stopwatches: twelve students, three angles, gaps, and a watch that was stopped much too late
coin = sc.measured(outer_diameter="25.75mm", length="2.2mm", mass="8.5g")
rng = np.random.default_rng(71)
angles = (25, 40, 60)
law = sc.loss.DryContour.from_si("0.04mm", scale=coin)
lasts = [float(sc.drift(coin, np.radians(angle), law).stops_at) for angle in angles]
lines = ["Name;" + ";".join(f"{angle}°" for angle in angles)]
students = ("Anna", "Ben", "Cem", "Dora", "Elif", "Finn", "Gül", "Hana", "Ida", "Jan", "Kim", "Lea")
for name in students:
    cells = [f"{t:.1f}".replace(".", ",") for t in rng.normal(lasts, 0.06 * np.array(lasts))]
    if name in ("Ben", "Kim"):
        cells[1] = ""
    if name == "Dora":
        cells[2] = "70,2"
    lines.append(";".join([name, *cells]))
(ROOM / "class.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")

# a golf ball dropped from 0.6 m: silence, noise, hum, a knock, and a click that is too soft
rng = np.random.default_rng(17)
seconds = np.arange(int(5.4 * hertz)) / hertz
at, lasts = 0.9 + np.sqrt(2 * 0.6 / scale.gravity), 2 * np.sqrt(2 * 0.6 / scale.gravity)
sound = rng.normal(0, 0.004, seconds.size) + 0.01 * np.sin(2 * np.pi * 50 * seconds)
blows, loud = [(0.31, 0.15)], 0.8
for k in range(12):
    blows.append((at, 0.0 if k == 4 else loud))
    lasts *= rng.normal(0.88, 0.006)
    at, loud = at + lasts, loud * 0.88
for begin, size in blows:
    after = np.clip(seconds - begin, 0, None)
    sound += (seconds >= begin) * size * np.exp(-after / 0.012) * np.sin(2 * np.pi * 1700 * after)
with wave.open(str(ROOM / "bounces.wav"), "wb") as file:
    file.setnchannels(1)
    file.setsampwidth(1)
    file.setframerate(hertz)
    file.writeframes((128 + 127 * sound.clip(-1, 1)).astype(np.uint8).tobytes())
