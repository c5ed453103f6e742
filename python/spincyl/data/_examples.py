"""The sample data of the lab page, in the package: made by docs/lab/make.py, not measured."""

from importlib.resources import files
from pathlib import Path

#: File and content of each example.
_EXAMPLES = {
    "tube_from_above": ("tube_from_above.txt", "both ends of a tube, as Tracker exports them; 34 frames"),
    "tube_project": ("tube_from_above.trz", "the same film as a project of Tracker's, packed"),
    "flicks": ("flicks.csv", "inclination in degrees and turns per second of ten flicks of that tube"),
    "spin_down": ("spin_down.csv", "seconds, degrees and turns per second of a disk that comes to its end"),
    "whirr": ("whirr.wav", "the sound of that disk, eight seconds"),
}


def example(name: str) -> Path:
    """The path of a file of sample data, to be read as one reads one's own.

    Parameters
    ----------
    name : {"tube_from_above", "tube_project", "flicks", "spin_down", "whirr"}
        Both ends of a tube on film (`read_tracker`, `from_above`), exported or as a project; ten flicks of
        it, degrees and turns per second (`read_table`, `compare`); a disk that comes to its end, filmed
        (`read_table`, `fit_losses`) and heard (`read_sound`, `wobble`). The tube has the measures 0.625, 0.5
        and 3.75 inches, the disk is 75.1 mm wide and 12.8 mm thick.

    Returns
    -------
    Path

    Raises
    ------
    ValueError
        For any other name, with those that there are.
    TypeError
        For anything but a name.

    Notes
    -----
    The data are made up: computed states with errors added by a random generator. They are no measurement.

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
