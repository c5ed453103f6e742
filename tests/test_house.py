"""Rules for the sources: each formula has one home, modules import in one order, and promised tests exist."""

import pathlib
import re

import pytest
import subjects
from circles import circle

ROOT = pathlib.Path(__file__).parents[1]
SRC = ROOT / "src"
SOURCES = sorted(SRC.glob("**/*.rs"))


def name(path):
    return path.relative_to(SRC).as_posix()


def code(path):
    """The lines of a file without comments, strings and the tests at its end: pairs (line number, line)."""
    lines = path.read_text("utf-8").split("#[cfg(test)]\nmod tests")[0].splitlines()
    for number, line in enumerate(lines, 1):
        line = re.sub(r'"(\\.|[^"\\])*"', '""', line)
        yield number, re.sub(r"//.*", "", line)


def comments(path):
    """The comments of a file, a text for each run of lines, as pairs (number of the first line, text)."""
    run, first = [], 0
    for number, line in enumerate([*path.read_text("utf-8").splitlines(), ""], 1):
        found = re.match(r"\s*//[/!]?(.*)", line)
        if found:
            first = first if run else number
            run.append(found[1].strip())
        elif run:
            yield first, " ".join(run)
            run = []


# The lever of the normal force.

ELL = r"&?(?:\w+\.)*ell(?:\(\))?(?:\.hi|\.lo)?"
ROUND = (
    r"&?(?:\w+\.)*(?:s|c|sin|cos|sine|cosine|sin\.hi|cos\.hi|s\.hi|c\.hi|s\.lo|c\.lo|"
    r"angle\.[01]|\w+\.(?:sin|cos)\(\))(?![\w(.])"
)
LEVER = re.compile(
    rf"\b{ELL}\s*\*\s*{ROUND}"  # ell * s
    rf"|(?<![\w.]){ROUND}\s*\*\s*{ELL}\b"  # s * ell
    rf"|\b{ELL}\.(?:mac|fma|mul_add|times)\(\s*{ROUND}"  # ell.mac(c, ...)
    rf"|(?<![\w.])(?:s|c|sin|cos)(?:\.hi)?\.(?:mac|fma|mul_add|times)\(\s*{ELL}\b"  # s.times(ell)
    rf"|product\(\s*{ELL}\s*,\s*{ROUND}|product\(\s*{ROUND}\s*,\s*{ELL}\b"  # product(ell, s)
)

# Other files with a product of ell and a sine or cosine: how many, and why they do not use `Rim`.
ELSEWHERE = {
    "laws/body/mod.rs": (1, "thetaInf in twice the digits"),
    "states/stability/at_rest.rs": (4, "the fast twin of a sharp rim, with products fused everywhere"),
    "states/stability/mod.rs": (1, "the size of a term, not a sum"),
    "states/steady/mod.rs": (3, "the numerator in twice the digits, and its size"),
    "states/steady/quick.rs": (4, "the same by few operations, with what is left out; and bounds of it"),
    "states/steady/rounded.rs": (3, "the same of a rounded rim, with what rounding takes, and its size"),
    "states/steady/single.rs": (2, "the same in doubles, for a rate in single precision"),
    "states/steady/trig.rs": (2, "polynomials in sine and cosine"),
}


def levers(path):
    return [(number, line.strip()) for number, line in code(path) if LEVER.search(line)]


@pytest.mark.parametrize(
    "line",
    [
        "ell * s - c",
        "let g = body.ell() * s - c;",
        "self.ell * s - self.a * c",
        "ell.mac(c, a * s)",
        "of.ell.fma(c, s)",
        "ell*c + s",
        "s * ell - c",
        "sin * of.ell() - cos",
        "body.ell() * theta.sin() - theta.cos()",
        "Sum::product(ell, s.hi)",
        "&(&ell * &s) - &(&a * &c)",
        "angle.0 * rim.ell",
        "ell * angle.sin.hi",
        "s.times(ell)",
    ],
)
def test_a_lever_is_known_in_any_spelling(line):
    assert LEVER.search(line), line


@pytest.mark.parametrize(
    "line", ["ell * ell", "ell * scale", "i3 * ell / d", "ell * (one - i3)", "ell * cubes", "mass * ell"]
)
def test_what_is_no_lever_is_not_taken_for_one(line):
    assert not LEVER.search(line), line


def test_only_the_rim_knows_where_a_body_touches():
    found = {name(path): levers(path) for path in SOURCES}
    assert found.pop("laws/body/rim.rs"), "the rim itself has the lines"
    expected = {file: count for file, (count, _) in ELSEWHERE.items()}
    assert {file: len(lines) for file, lines in found.items() if lines} == expected, found


# The angular velocities of the drilling, of the rolling and of the contact point.

SINE, COSINE = r"\b(?:\w+\.)*(?:s|sin|angle\.0)\b", r"\b(?:\w+\.)*(?:c|cos|angle\.1)\b"
FIRST, THIRD = r"(?:\w+\.)*(?:w1|w\[0\]|d1)(?!\w)", r"(?:\w+\.)*(?:w3|w\[2\]|d3)(?!\w)"
ANGULAR = re.compile(
    rf"{SINE} \* {FIRST} \+ {COSINE} \* {THIRD}|{COSINE} \* {FIRST} - {SINE} \* {THIRD}"
    rf"|{THIRD} - {COSINE} / {SINE} \* {FIRST}"
)


@pytest.mark.parametrize(
    "line", ["let q = s * w1 + c * w3;", "c * y.w1 - s * y.w3", "w[2] - angle.1 / angle.0 * w[0]"]
)
def test_an_angular_velocity_of_the_contact_is_known_in_any_spelling(line):
    assert ANGULAR.search(line)


def test_w_z_w_h_and_the_spin_have_one_home():
    found = {name(path): sum(bool(ANGULAR.search(line)) for _, line in code(path)) for path in SOURCES}
    assert found.pop("laws/state.rs") == 3
    assert not {file: count for file, count in found.items() if count}


# The numbers of a motion, which have names.

INDEX = re.compile(r"\b(?:y|at|all|rates|begin|shown|rests|place\.rate)\[\d+\]")
#: Rooms of motions, and how many bare indices they may have: those of short arrays, of quaternions, and of the numbers
#: of a flight and of a lane.
BARE = {"body": 43, "walk": 18, "custom": 0, "stone": 24}


@pytest.mark.parametrize("room", BARE)
def test_the_numbers_of_a_motion_have_names(room):
    files = sorted((SRC / "motions" / room).glob("**/*.rs"))
    assert files
    assert sum(len(INDEX.findall(line)) for path in files for _, line in code(path)) <= BARE[room]


# Names of types.

TYPE = re.compile(
    r"^(?:\s*(?:pub(?:\([^)]*\))?\s+)?(?:struct|enum|trait|union)|(?:pub(?:\([^)]*\))?\s+)?type)\s+(\w+)"
)


def types(path):
    """The names of structs, enums, traits and aliases of a file, without associated types."""
    return [(found[1], number) for number, line in code(path) if (found := TYPE.match(line))]


@pytest.mark.parametrize(
    ("line", "name"),
    [
        ("struct Walk<T> {", "Walk"),
        ("    pub trait Slotted: Copy {", "Slotted"),
        ("pub(super) enum Next {", "Next"),
        ("type Pair<T> = (T, T);", "Pair"),
        ("    type Output = Self;", None),
        ("let structure = 1;", None),
    ],
)
def test_a_type_is_known_by_its_line(line, name):
    found = TYPE.match(line)
    assert (found and found[1]) == name


def test_the_name_of_a_type_stands_once():
    homes = {}
    for path in SOURCES:
        if path.stem != "tests":
            for word, number in types(path):
                homes.setdefault(word, []).append(f"{name(path)}:{number}")
    assert len(homes) > 100
    twice = {word: places for word, places in homes.items() if len(places) > 1}
    assert not twice, twice


# Names of functions.

FUNCTION = re.compile(r'^(?:pub(?:\([^)]*\))? )?(?:const )?(?:unsafe )?(?:extern "" )?fn (\w+)')
#: Names of functions outside of types that occur twice in a layer, with the reason.
NAMESAKES = {
    "laws": {
        **dict.fromkeys(
            ("energy", "derivative", "force", "centre_velocity"), "the same quantity of each contact"
        ),
    },
    "motions": {
        **dict.fromkeys(
            ("roll", "rolled", "roll_with", "followed", "walk"), "the same of a body and of a stone"
        ),
        "first_event": "of a motion and of its swing, for users and inside",
        "follow": "a motion by first integrals and one by phases",
        "check": "of a state, and of a motion under laws of users",
        "state": "of a body and of a stone",
        "error": "the norm of a flow",
    },
    "many": {
        "roll": "all motions, and one of them",
        "stops": "all drifts, and those in lanes",
        "put": "of a row, and of a motion",
        "scatter": "of maps, and of their rates",
    },
    "methods": {"step": "of each method"},
    "numbers": {
        "sin_cos": "of a number and of a sum",
        **dict.fromkeys(("best", "avx2"), "one for each kind of processor"),
    },
}


def twice_in_a_layer():
    homes = {}
    for path in SOURCES:
        layer = path.relative_to(SRC).parts[0]
        for _, line in code(path):
            if path.stem != "tests" and (found := FUNCTION.match(line)):
                homes.setdefault(layer, {}).setdefault(found[1], []).append(name(path))
    assert sum(map(len, homes.values())) > 500
    twice = {layer: {x for x, files in names.items() if len(files) > 1} for layer, names in homes.items()}
    return {layer: names for layer, names in twice.items() if names}


def test_the_name_of_a_function_stands_once_in_a_layer_or_there_is_a_reason():
    assert twice_in_a_layer() == {layer: set(names) for layer, names in NAMESAKES.items()}


# Arguments of functions.


def parts_of(text):
    """The parts of a text between commas that are not in brackets."""
    found, part, depth, before = [], "", 0, ""
    for letter in text:
        depth += (letter in "([{<") - (letter in ")]}" or (letter == ">" and before != "-"))
        if letter == "," and not depth:
            found, part = [*found, part.strip()], ""
        else:
            part += letter
        before = letter
    return [x for x in [*found, part.strip()] if x]


def closing(text, at):
    """The place after the bracket that closes the one at this place."""
    depth = 0
    for place in range(at, len(text)):
        arrow = text[place - 1 : place + 1] == "->"
        depth += (text[place] in "(<") - (text[place] in ")>" and not arrow)
        if not depth:
            return place + 1
    raise AssertionError(text[at : at + 80])


def signatures(text):
    """Name, arguments without self, and type of the result of each function."""
    for found in re.finditer(r"\bfn (\w+)", text):
        at = found.end()
        at = closing(text, at) if text[at] == "<" else at
        if text[at] == "(":
            end = closing(text, at)
            told = parts_of(text[at + 1 : end - 1])
            given = [x for x in told if not re.fullmatch(r"&?(?:'\w+ )?(?:mut )?self(?:: .*)?", x, re.S)]
            yield found[1], given, re.split(r"\bwhere\b|[{;]", text[end:], maxsplit=1)[0]


def sizes_of_tuples(text):
    """The number of parts of each tuple in a type."""
    opened = []
    for place, letter in enumerate(text):
        if letter == "(":
            opened.append(place)
        elif letter == ")" and opened:
            at = opened.pop()
            if not re.search(r"\b(?:Fn|FnMut|FnOnce|fn)$", text[:at]):
                yield len(parts_of(text[at + 1 : place]))


def test_arguments_and_tuples_are_counted():
    text = "fn f<T: Fn(f64, u8) -> bool>(&self, a: [f64; 2], (b, c): (u8, u8), d: &dyn Fn(u8, u8, u8)) -> (u8, T, T) {"
    assert [(x, len(given)) for x, given, _ in signatures(text)] == [("f", 3)]
    assert [*sizes_of_tuples("(u8, (f64, f64, f64), fn(u8, u8, u8) -> u8)")] == [3, 3]


#: Functions with more than six arguments: the rate of a body for Python, whose numbers come one by one since that
#: is the fastest, and two of lanes.
LONG = {
    "python/mod.rs": {"rate_of_one"},
    "many/maps/survey.rs": {"all_extrema_of"},
    "many/motions/ends/march.rs": {"march"},
}


def test_no_function_takes_more_than_six_arguments_by_position():
    found = {}
    for path in SOURCES:
        for word, given, _ in signatures("\n".join(line for _, line in code(path))):
            # that Python is there is no argument that a caller writes
            if len([x for x in given if not x.startswith("py: Python<")]) > 6:
                found.setdefault(name(path), set()).add(word)
    assert found == LONG


#: How many tuples of three or more parts without names stand in the signatures of a layer.
UNNAMED = {"motions": 13, "laws": 6, "many": 5, "python": 3, "methods": 2}


def test_few_signatures_have_tuples_without_names():
    found = {}
    for path in SOURCES:
        for _, given, result in signatures("\n".join(line for _, line in code(path))):
            types = [x.partition(":")[2] for x in given] + [result]
            many = sum(size > 2 for text in types for size in sizes_of_tuples(text))
            layer = path.relative_to(SRC).parts[0]
            found[layer] = found.get(layer, 0) + many
    assert {layer: many for layer, many in found.items() if many > UNNAMED.get(layer, 0)} == {}


# Imports between modules.

HOMES = {path.relative_to(SRC).with_suffix("").parts: path for path in SOURCES if path.stem != "lib"}
HOMES = {words[:-1] if words[-1] == "mod" else words: path for words, path in HOMES.items()}
USE = re.compile(r"^\s*(?:pub(?:\([^)]*\))? )?use ((?:\w+|\{)[^;]*);", re.M)
INLINE = re.compile(r"(?<![\w:$])(?:crate|super|self)(?:::\w+)+")


def layers_of_src():
    """The layers in the order of the map in lib.rs; each may import from those before it."""
    text = (SRC / "lib.rs").read_text("utf-8")
    return ["error", *dict.fromkeys(re.findall(r"^//! \| `(\w+)` \|", text, re.M)), "python"]


def front_door():
    """The public names of lib.rs, each with the words of its path."""
    found = {}
    for tree in re.findall(r"^pub use ([^;]+);", (SRC / "lib.rs").read_text("utf-8"), re.M):
        for *head, last in paths(re.sub(r"\s", "", re.sub(r" as ", "=", tree))):
            last, _, alias = last.partition("=")
            path = (*head, last)
            # as in `pub use body::Body`, where `body` is itself a public name
            found[alias or last] = (*found.get(path[0], path[:1]), *path[1:])
    return found


def resolved(words, module, front):
    """The module that a path leads to when written in `module`; None if it leads out of the crate."""
    words, base = list(words), list(module)
    if words[0] == "crate":
        words, base = words[1:], []
        words = [*front.get(words[0], words[:1]), *words[1:]] if (words[0],) not in HOMES else words
    elif words[0] in ("super", "self"):
        while words and words[0] in ("super", "self"):
            base = base[:-1] if words[0] == "super" else base
            words = words[1:]
    elif (*base, words[0]) not in HOMES:
        return None
    found = (*base, *words)
    while found and found not in HOMES:
        found = found[:-1]
    return found


def uses():
    """(module, line number, imported module) for every `use` and every inline path."""
    front = front_door()
    for module, path in HOMES.items():
        text = "\n".join(line for _, line in code(path))
        trees = [
            (found.start(1), tree)
            for found in USE.finditer(text)
            for tree in paths(re.sub(r"\s+", "", found[1]))
        ]
        inline = [(found.start(), found[0].split("::")) for found in INLINE.finditer(USE.sub("", text))]
        for at, words in trees + inline:
            found = resolved(words, module, front)
            if found and found != module:
                yield module, text[:at].count("\n") + 1, found


def test_every_folder_is_a_layer_of_the_map():
    assert sorted(layers_of_src()) == sorted({module[0] for module in HOMES})
    assert all(path.parent != SRC for module, path in HOMES.items() if module != ("error",))


def test_every_public_module_is_on_the_map():
    text = (SRC / "lib.rs").read_text("utf-8")
    on_map = re.findall(r"^//! \|[^|]*\| \[`(\w+)`\] \|", text, re.M)
    inner = re.findall(r"^pub mod (\w+)", text, re.M)
    given = [word for word, path in front_door().items() if path in HOMES]
    assert sorted(on_map) == sorted({*inner, *given} - {"rolling", "smooth"})


def public_modules():
    """The public modules outside of lib.rs: those at the front door, `pub mod` in one of these, and `motion::path`."""
    found = [path for path in front_door().values() if path in HOMES]
    for module in found:
        inner = re.findall(r"^pub mod (\w+);", HOMES[module].read_text("utf-8"), re.M)
        found += [(*module, word) for word in inner]
    return sorted({*found, ("scene",), ("motions", "body")})


def test_every_public_module_begins_with_an_example():
    def has_example(head):
        # every second fence opens a block; one without a word is run
        return "" in re.findall(r"^ *//! ```(.*)$", head, re.M)[::2]

    heads = {
        "::".join(module): re.match(r"(?://!.*\n)*", HOMES[module].read_text("utf-8"))[0]
        for module in public_modules()
    }
    inline = re.findall(r"^pub mod (\w+) \{\n((?: +//!.*\n)+)", (SRC / "lib.rs").read_text("utf-8"), re.M)
    assert len(heads) > 25 and len(inline) == 3
    assert not [word for word, head in [*heads.items(), *inline] if not has_example(head)]


# Public types that can grow.

#: Public types to which nothing will be added, so that programs may write and match all of their fields, and why.
CLOSED = {
    "State": "the four numbers of a state of a body are all",
    "StateColumns": "a column for each of these four numbers",
    "StoneState": "the two vectors of a state of a stone are all",
    "Circle": "three numbers are a circle that touches the table",
    "Angle": "whole turns and the rest, whose sum it is",
    "Compensated": "numbers, and what was rounded off them",
}


def exported_types():
    """The names of the types that lib.rs exports; in the sources a name of a type stands once."""
    texts = [HOMES[module].read_text("utf-8") for module in public_modules()]
    found = set()
    for text in [*texts, (SRC / "lib.rs").read_text("utf-8")]:
        text = re.sub(r"//.*", "", text.split("#[cfg(test)]\nmod tests")[0])
        trees = re.findall(r"\bpub use ([^;]+);", text)
        found |= {words[-1] for tree in trees for words in paths(re.sub(r"\s", "", tree))}
        found |= set(re.findall(r"^ *pub (?:struct|enum|union) (\w+)", text, re.M))
    assert "*" not in found
    return found


def closed_types(text):
    """The public structs and enums of a source to which nothing can be added without an error in programs of users."""
    lines = text.split("#[cfg(test)]\nmod tests")[0].splitlines()
    for at, line in enumerate(lines):
        found = re.match(r"( *)pub (struct|enum|union) (\w+)(.*)", line)
        if not found:
            continue
        indent, kind, word, rest = found.groups()
        before = lines[:at]
        while before and before[-1].strip() and not before[-1].endswith("{"):
            if "non_exhaustive" in before.pop():
                break
        else:
            # an enumeration of these macros has the attribute by them
            in_macro = indent and before and re.fullmatch(r" *(?:coded|laws)! \{", before[-1])
            end = at if rest.endswith(";") else lines.index(f"{indent}}}", at)
            after = [line.strip() for line in lines[at + 1 : end]]
            fields = [re.sub(r".*?\(", "", rest, count=1)] if "(" in rest else after
            hidden = [x for x in fields if re.match(r"(?!pub )[\w(]+(?:: |.*\);|\(crate\))", x)]
            if not in_macro and not (kind == "struct" and hidden):
                yield word


@pytest.mark.parametrize(
    ("text", "closed"),
    [
        ("pub struct Start {\n    /// Time.\n    pub time: f64,\n}", True),
        ("#[derive(Debug)]\n#[non_exhaustive]\npub struct Start {\n    pub time: f64,\n}", False),
        ("#[non_exhaustive]\npub struct Other {\n}\n\npub struct Start {\n    pub time: f64,\n}", True),
        ("pub struct Start<'a> {\n    pub time: f64,\n    pub(crate) at: [&'a [f64]; 2],\n}", False),
        ("pub struct Start {\n    pub time: f64,\n    smooth: bool,\n}", False),
        ("pub struct Start(pub f64);", True),
        ("pub struct Start(pub(crate) [f64; 4]);", False),
        ("pub struct Start;", True),
        ("pub enum Start {\n    /// Here.\n    Here,\n}", True),
        ("coded! {\n    /// A start.\n    pub enum Start {\n        Here = 0,\n    }\n}", False),
    ],
)
def test_a_type_that_cannot_grow_is_seen(text, closed):
    assert ("Start" in closed_types(text)) == closed


def test_every_public_type_can_grow_or_there_is_a_reason():
    exported = exported_types()
    assert len(exported) > 120 and set(CLOSED) < exported
    closed = {word for path in SOURCES for word in closed_types(path.read_text("utf-8"))} & exported
    assert closed == set(CLOSED), (closed - set(CLOSED), set(CLOSED) - closed)


# Public numbers of unequal kinds, and switches, which have names.

#: Public arrays of numbers, and why their numbers need no names: `Type.field`, `Type::function(argument)`, and
#: `function ->` for a result.
ALIKE = {
    "a vector along e1, e2, e3 or the axes of a stone, or moments about these axes": {
        "Error.moments",
        "Error.w",
        "under_couple(couple)",
        "derivative(couple)",
        "CoupleLaw::couple ->",
        "Losses::couple ->",
        "Ellipsoid::new(axes)",
        "Ellipsoid::new(inertia)",
        "Ellipsoid::new(offset)",
        "Ellipsoid::uniform(axes)",
        "Ellipsoid::rattleback(axes)",
        "Ellipsoid::rattleback(moments)",
        "Ellipsoid::rattleback(offset)",
        "Ellipsoid::axes ->",
        "Ellipsoid::inertia ->",
        "Ellipsoid::offset ->",
        "Ellipsoid::moments ->",
        "Ellipsoid::lowest_point ->",
        "Ellipsoid::lowest_point(vertical)",
        "StoneState.vertical",
        "StoneState.w",
        "StoneState::inclinations ->",
        "SceneBody.principal_moments",
    },
    "a vector along e_h, e2 and upwards": {
        "centre_velocity ->",
        "pressure_centre ->",
        "Strike.velocities",
        "Strike.impulse",
    },
    "a place on the table or in space, or its rate": {
        "StonePose.centre",
        "Start.place",
        "Start::with_place(place)",
        "MeasuredMotion::readings_from(x, y)",
        "RollingStone.centre",
        "RollingStone.centre_velocity",
        "Ellipsoid::slip(centre)",
    },
    "a point in the half plane beside the axis": {"Body::lathe(points)", "CirclesShape.outline"},
    "a quaternion, or its rate": {"RollingStone.orientation", "RollingStone.orientation_rate"},
    "the same number of two rims, circles, ends, modes or roots": {
        "Apex.contacts",
        "Body::unequal_balls(radii)",
        "Form.radii",
        "Form.bores",
        "Form.ends",
        "normals ->",
        "Swing::turning_points ->",
        "Rocking.growth",
        "Rocking.frequency",
        "precessions_of_spin ->",
    },
    "all values of one number": {"areas ->", "boundaries ->", "folds ->", "ridge ->", "inclinations ->"},
    "the numbers of a system of equations of the user": {
        "Compensated.y",
        "Compensated.carry",
        "Compensated::new(y)",
        "Compensated::plus(change)",
        "increment ->",
        "increment(y)",
        "increment(k1)",
    },
    "a row of a table whose columns are `Ellipsoid::NAMES`": {
        "Ellipsoid::of_numbers(a, b, c, i, j, k, l, m, n, x, y, z, end)",
        "Ellipsoid::numbers ->",
    },
}


def public_pieces(text, types, free):
    """Name and type of each field of these public types, and of the arguments and results of their functions, and of the
    free functions for whose names `free` holds."""
    for found in re.finditer(r"^pub (struct|enum) (\w+)[^{;(]*\{\n(.*?)^\}", text, re.M | re.S):
        for word, kind in re.findall(r"^ *(?:pub )?(\w+): (.*?),?$", found[3], re.M):
            hidden = found[1] == "struct" and not re.search(rf"^    pub {word}: ", found[3], re.M)
            if found[2] in types and not hidden:
                yield f"{found[2]}.{word}", kind
    functions = [("", text[at.start() :]) for at in re.finditer(r"^pub (?:const )?fn ", text, re.M)]
    for found in re.finditer(r"^(impl|pub trait)\b([^{;]*)\{\n(.*?)^\}", text, re.M | re.S):
        word = re.match(r"(?:<[^>]*>)? (\w+)", found[2])
        if word and word[1] in types and " for " not in found[2]:
            seen = r"^    fn " if found[1] == "pub trait" else r"^    pub (?:const )?fn "
            starts = re.finditer(seen, found[3], re.M)
            functions += [(f"{word[1]}::", found[3][at.start() :]) for at in starts]
    for of, rest in functions:
        function, given, result = next(signatures(rest))
        if of or free(function):
            yield f"{of}{function} ->", result
            for argument in given:
                pattern, _, kind = (
                    argument.rpartition("]: ") if "]: " in argument else argument.partition(": ")
                )
                yield f"{of}{function}({pattern.strip('[&')})", kind


@pytest.mark.parametrize(
    ("text", "arrays", "switches"),
    [
        ("pub struct Start {\n    pub slip: [f64; 2],\n}", ["Start.slip"], []),
        ("pub struct Start {\n    slip: [f64; 2],\n    pub time: f64,\n}", [], []),
        ("pub struct Inner {\n    pub slip: [f64; 2],\n}", [], []),
        ("pub enum Start {\n    Here {\n        ends: Vec<[f64; 2]>,\n    },\n}", ["Start.ends"], []),
        (
            "impl<S> Start<S> {\n    pub fn at(self, x: Option<[f64; 3]>) -> Self {\n    }\n}",
            ["Start::at(x)"],
            [],
        ),
        ("impl Start {\n    pub(crate) fn at(self, x: [f64; 3], on: bool) -> Self {\n    }\n}", [], []),
        (
            "impl Start {\n    pub fn with_pose(self, pose: bool) -> Self {\n    }\n}",
            [],
            ["Start::with_pose(pose)"],
        ),
        ("impl From<[f64; 2]> for Start {\n    fn from(of: [f64; 2]) -> Self {\n    }\n}", [], []),
        ("pub fn told(a: f64, [x, y]: [f64; 2]) -> f64 {\n}", ["told(x, y)"], []),
        ("pub fn told(a: f64) -> Result<[f64; 5], Error> {\n}", ["told ->"], []),
        ("pub fn told(go_on: impl FnMut(f64) -> bool) -> bool {\n}", [], []),
        (
            "pub trait Start {\n    fn couple(&self, on: bool) -> [f64; 3];\n}",
            ["Start::couple ->"],
            ["Start::couple(on)"],
        ),
        ("pub fn hidden(x: [f64; 2], on: bool) {\n}", [], []),
    ],
)
def test_public_arrays_and_switches_are_seen(text, arrays, switches):
    pieces = list(public_pieces(text, {"Start"}, lambda function: function == "told"))
    assert [piece for piece, kind in pieces if is_array(kind)] == arrays
    assert [piece for piece, kind in pieces if is_switch(piece, kind)] == switches


def is_array(kind):
    return bool(re.search(r"\[f64(?!\])", kind))


def is_switch(piece, kind):
    """Whether an argument is a bool, and not a function that returns one."""
    return "(" in piece and bool(re.search(r"\bbool\b", kind)) and not re.search(r"\bFn(?:Mut|Once)?\(", kind)


def test_public_numbers_of_unequal_kinds_have_names_and_no_public_argument_is_a_switch():
    types, modules = exported_types(), public_modules()
    homes = {path: module for module, path in HOMES.items() if module[0] != "python"}
    pieces = {}
    for path, module in homes.items():
        text = "\n".join(line for _, line in code(path))
        pieces |= public_pieces(text, types, lambda f, at=module: at in modules or f in types)
    assert len(pieces) > 900
    assert not {piece for piece, kind in pieces.items() if is_switch(piece, kind)}
    arrays = {piece for piece, kind in pieces.items() if is_array(kind)}
    alike = {piece for reason in ALIKE.values() for piece in reason}
    assert arrays == alike, (arrays - alike, alike - arrays)


def test_no_layer_uses_a_later_one():
    order = {layer: rank for rank, layer in enumerate(layers_of_src())}
    found = list(uses())
    assert len(found) > 1000
    against = [
        f"{'::'.join(a)}:{line} uses {'::'.join(b)}" for a, line, b in found if order[b[0]] > order[a[0]]
    ]
    assert not against, "\n".join(against)


@pytest.mark.parametrize(
    ("words", "found"),
    [
        ("crate::Body", ("laws", "body")),
        ("crate::rolling::energy", ("laws", "contact", "rolling")),
        ("crate::ensemble::Job", ("many", "motions")),
        ("super::roll::lossy::free", ("motions", "body", "roll", "lossy", "free")),
        ("super::super::Ask", ("motions",)),
        (
            "walk::Walk",
            ("motions", "body", "slide", "walk") if ("motions", "body", "slide", "walk") in HOMES else None,
        ),
        ("core::f64", None),
    ],
)
def test_a_path_is_followed_through_the_front_door_and_upward(words, found):
    assert resolved(words.split("::"), ("motions", "body", "slide"), front_door()) == found


def paths(tree):
    """The words of each path in a `use`: a::{b, c::d} has two."""
    if "{" not in tree:
        return [tree.split("::")]
    head, depth, found, part = tree[: tree.index("{")], 0, [], ""
    for letter in tree[tree.index("{") + 1 : -1] + ",":
        depth += (letter == "{") - (letter == "}")
        if letter == "," and not depth:
            found += paths(head + part) if part else []
            part = ""
        else:
            part += letter
    return found


def test_modules_in_a_circle_are_seen():
    assert circle({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": {"a"}}) == {"b", "c"}
    assert not circle({"a": {"b"}, "b": {"c"}})


def test_no_modules_use_each_other_in_a_circle():
    # A module may use its own folder: what that imports makes no circle.
    asks = {}
    for module, _, found in uses():
        if module[: len(found)] != found:
            asks.setdefault(module, set()).add(found)
    assert sum(map(len, asks.values())) > 500
    assert not circle(asks), sorted("::".join(module) for module in circle(asks))


def test_only_numbers_and_methods_know_what_they_are_compiled_for():
    # A browser has no clock; other code that is shorter there depends on a flag of build.rs.
    def places(flag):
        return {name(path) for path in SOURCES for _, line in path_lines(path) if flag in line}

    assert places("wasm32") == {"methods/beat.rs"}
    assert {place.split("/")[0] for place in places("short_code")} == {"numbers", "methods"}


# An estimated error that becomes the larger of itself and another one.
RAISED = re.compile(r"\b\w*error(?:\[\w+\])? = [\w.]*error(?:\[\w+\])?\.max\(")


@pytest.mark.parametrize(
    ("line", "hides"),
    [
        ("motion.error = motion.error.max(swing.error(t));", True),
        ("out.error[i] = out.error[i].max(there.error);", True),
        ("motion.pose_error = motion.pose_error.max(f64::NAN);", True),
        ("motion.error = larger_or_nan(motion.error, off);", False),
        ("let root = error.max(one(1e-40)).sqrt();", False),
    ],
)
def test_an_error_that_is_raised_by_max_is_seen(line, hides):
    assert bool(RAISED.search(line)) == hides


def test_no_estimated_error_is_raised_by_a_maximum_that_drops_a_nan():
    # f64::max(NaN, x) is x: an error that cannot be computed would count as small. numbers::larger_or_nan keeps it.
    found = [
        f"{name(path)}:{i}"
        for path in SOURCES
        for i, line in path_lines(path)
        if not line.lstrip().startswith("//") and RAISED.search(line)
    ]
    assert not found


def path_lines(path):
    return enumerate(path.read_text("utf-8").splitlines(), 1)


# A constant of a module; associated constants are distinguished by the name of their type.
CONSTANT = re.compile(r"^(?:pub(?:\([^)]*\))? )?(?:const|static) ([A-Z][A-Z0-9_]*)\b")


def test_the_name_of_a_constant_stands_once_in_a_layer():
    homes = {}
    for path in SOURCES:
        layer = path.relative_to(SRC).parts[0]
        for number, line in code(path):
            if found := CONSTANT.match(line):
                homes.setdefault((layer, found[1]), []).append(f"{name(path)}:{number}")
    assert len(homes) > 200
    twice = {word: places for word, places in homes.items() if len(places) > 1}
    assert not twice, twice


# Builders.

BUILDER = re.compile(
    r"((?:^ *(?:#\[|///).*\n)*)^ *pub fn (with\w*|kicked)(?:<\w+>)?\((?:mut )?self\b[^{;]*?-> (\w+)", re.M
)


def test_what_a_builder_returns_must_be_used():
    found = [
        (name(path), *builder) for path in SOURCES for builder in BUILDER.findall(path.read_text("utf-8"))
    ]
    # a `Result` must be used by itself
    found = [(place, attributes, word) for place, attributes, word, made in found if made != "Result"]
    assert len(found) > 15
    assert not [(place, word) for place, attributes, word in found if "#[must_use]" not in attributes]


# Promises of tests in comments.

PROMISE = re.compile(r"[^.;]*\b(?:a test|a property|the tests|tests of)\b[^.;]*", re.I)
# for a file that ends with tests
OWN = "the tests at the end"


def known_tests():
    """The names that a promise can give: test files, modules with tests, and tests."""
    files = [*(ROOT / "tests").glob("**/*.rs"), *(ROOT / "tests").glob("test_*.py")]
    names = {path.parent.name if path.name == "main.rs" else path.stem for path in files}
    for path in [*files, *SOURCES]:
        text = path.read_text("utf-8")
        if path in SOURCES and "#[cfg(test)]" in text:
            names.add(path.stem if path.stem != "mod" else path.parent.name)
        names |= set(re.findall(r"^\s*(?:fn|def) (\w+)", text, re.M)) if path in files else set()
        names |= set(re.findall(r"#\[test\]\s*fn (\w+)", text))
    return names


def promises(path):
    for number, text in comments(path):
        for found in PROMISE.finditer(text):
            yield number, found[0].strip()


def test_every_test_that_a_head_promises_exists():
    known, promised, broken = known_tests(), 0, []
    for path in SOURCES:
        for number, text in promises(path):
            promised += 1
            if OWN in text and "#[cfg(test)]" in path.read_text("utf-8"):
                continue
            if not any(word in known for word in re.findall(r"`([\w:]+)`", text)):
                broken.append(f"{name(path)}:{number}: {text}")
    assert promised > 10
    assert not broken, "\n".join(broken)


def test_the_page_of_the_tests_is_up_to_date():
    told = dict(subjects.promised())
    assert told["src/laws/loss/mod.rs"] == ["tests/laws/losses.rs"] and len(told) > 40
    assert subjects.PAGE.read_text("utf-8") == subjects.page(), "run python tests/subjects.py --write"
    rows = subjects.page().split("## The core")[1]
    for path in [*(ROOT / "tests").glob("test_*.py"), *(ROOT / "tests" / "laws").glob("*.rs")]:
        assert f"| `{path.relative_to(ROOT / 'tests').as_posix()}` | " in rows, f"{path.name} has no head"
