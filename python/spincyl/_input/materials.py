"""Densities of common materials, by name."""

import difflib

from spincyl._input.numbers import number, si

#: Density at room temperature in kg/m^3, and which sort of the material has it. Sources: W. D. Callister
#: and D. G. Rethwisch, Fundamentals of Materials Science and Engineering, 3rd ed. (Wiley, 2008), Table B.1;
#: where the table has a range, the middle of it. For three plastics, the maker's data sheet of the grade.
#: For woods, Forest Products Laboratory, Wood Handbook, FPL-GTR-190 (2010), Table 5-3a: the specific
#: gravity G of dry wood by its volume at 12 % moisture, and with its water the density 1120 G (chapter 4).
#: Callister lists G as the density of two woods, which makes them 12 % too light.
MATERIALS = {
    "steel": (7850.0, "plain carbon steel, such as A36 or 1020"),
    "stainless steel": (8000.0, "304 or 316"),
    "cast iron": (7300.0, "gray iron"),
    "aluminium": (2700.0, "alloy 6061"),
    "brass": (8500.0, "free-cutting brass, C36000"),
    "copper": (8890.0, "C11000"),
    "glass": (2500.0, "soda-lime glass"),
    "acrylic": (1190.0, "poly(methyl methacrylate), PMMA"),
    "polypropylene": (905.0, "PP"),
    "polystyrene": (1050.0, "PS, no foam"),
    "PET": (1350.0, "poly(ethylene terephthalate)"),
    "PVC": (1440.0, "poly(vinyl chloride): 1300 to 1580"),
    "PTFE": (2170.0, "polytetrafluoroethylene"),
    "polycarbonate": (1200.0, "PC: Makrolon 2405, Covestro"),
    "ABS": (1040.0, "acrylonitrile butadiene styrene: Terluran GP-22, BASF"),
    "PLA": (1240.0, "polylactide, printed without voids: Ingeo 4043D, NatureWorks"),
    "beech": (717.0, "American beech, 12 % moisture: G = 0.64"),
    "birch": (694.0, "yellow birch, 12 % moisture: G = 0.62"),
    "maple": (706.0, "sugar (hard) maple, 12 % moisture: G = 0.63"),
    "oak": (706.0, "northern red oak, 12 % moisture: G = 0.63"),
    "ash": (672.0, "white ash, 12 % moisture: G = 0.60"),
    "fir": (538.0, "Douglas fir of the coast, 12 % moisture: G = 0.48"),
    "pine": (448.0, "ponderosa pine, 12 % moisture: G = 0.40; southern pines are denser"),
}
_SAME = {
    "aluminum": "aluminium",
    "pmma": "acrylic",
    "plexiglass": "acrylic",
    "perspex": "acrylic",
    "pp": "polypropylene",
    "ps": "polystyrene",
    "pc": "polycarbonate",
    "teflon": "PTFE",
}
_KNOWN = {name.lower(): name for name in MATERIALS} | _SAME
_WOODS = "beech", "birch", "maple", "oak", "ash", "fir", "pine"
_OTHERS = "wood", "walnut", "cherry", "spruce", "larch", "teak"
_SORTS: dict[str, tuple[str, ...]] = dict.fromkeys(_OTHERS, _WOODS)
_SORTS |= {
    "plastic": ("acrylic", "polypropylene", "polystyrene", "PET", "PVC", "polycarbonate", "ABS", "PLA")
}


def density_in_si(value: object) -> float:
    """A density in kg/m^3: from a number, a text with a unit, a quantity, or the name of a material."""
    if not isinstance(value, str) or not value.strip()[:1].isalpha():
        return number("density", si("density", value, "kilogram/metre**3"))
    word = value.strip().lower()
    if word in _KNOWN:
        return MATERIALS[_KNOWN[word]][0]
    near = _SORTS.get(word) or [_KNOWN[x] for x in difflib.get_close_matches(word, _KNOWN, 3, 0.6)]
    known = " or ".join(map(repr, near)) if near else f"one of {', '.join(map(repr, MATERIALS))}"
    raise ValueError(f"density = {value!r}: expected {known}, or a number in kg/m^3")
