"""The sample data of the lab page, in the package: made by docs/lab/make.py, not measured."""

from importlib.resources import files
from pathlib import Path

#: File and content of each example.
_EXAMPLES = {
    "tube_from_above": ("tube_from_above.txt", "both ends of a tube, as Tracker exports them; 34 frames"),
    "tube_project": ("tube_from_above.trz", "the same film as a packed project of Tracker"),
    "flicks": ("flicks.csv", "inclination in degrees and turns per second of ten flicks of that tube"),
    "spin_down": ("spin_down.csv", "seconds, degrees and turns per second of a disk that spins down"),
    "whirr": ("whirr.wav", "eight seconds of the sound of that disk"),
    "bounces": ("bounces.wav", "five seconds of the sound of a golf ball that bounces"),
    "class": ("class.csv", "seconds until a 2-euro coin stops, from three angles, by twelve students"),
}


def example(name: str) -> Path:
    """Return the path of a file of sample data.

    Parameters
    ----------
    name : {"tube_from_above", "tube_project", "flicks", "spin_down", "whirr", "class",
        "bounces"}
        "tube_from_above" has both ends of a tube, tracked in a film and exported by Tracker; "tube_project"
        is its Tracker project (for `read_tracker` and `from_above`). "flicks" has the inclination in
        degrees and the turns per second of ten flicks of this tube (for `read_table` and `compare`).
        "spin_down" is a disk that spins down on film (for `read_table` and `fit_losses`), and "whirr" is its
        sound (for `read_sound` and `wobble`). "class" has the times in which a 2-euro coin stops, measured by
        twelve students with stopwatches (for `read_table` and `fit_stop`). The tube has diameters of 0.625
        and 0.5 inches and a length of 3.75 inches; the disk has a diameter of 75.1 mm and a thickness of
        12.8 mm. "bounces" is the sound of a golf ball that is dropped from 0.6 m (for `read_sound` and
        `fit_bounces`).

    Returns
    -------
    Path
        Path of the file, which is installed with the package.

    Raises
    ------
    ValueError
        For any other name; the message lists the names.
    TypeError
        If `name` is not a str.

    Notes
    -----
    The data are simulated: computed states with random errors, not measurements.

    Examples
    --------
    >>> import spincyl as sc
    >>> sc.data.example("flicks").name
    'flicks.csv'
    """
    if not isinstance(name, str):
        raise TypeError(f"name: expected text, not {type(name).__name__}")
    if name not in _EXAMPLES:
        known = "; ".join(f"{key!r}, {told}" for key, (_, told) in _EXAMPLES.items())
        raise ValueError(f"name = {name!r}: expected one of {known}")
    return Path(str(files(__package__).joinpath("examples", _EXAMPLES[name][0])))
