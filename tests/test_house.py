"""Rules for the sources: each formula has one home, modules import in one order, and promised tests exist."""

import ast
import pathlib
import re

import pytest

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
        ("super::lossy::free", ("motions", "path", "lossy", "free")),
        ("super::super::Ask", ("motions",)),
        (
            "walk::Walk",
            ("motions", "path", "slide", "walk") if ("motions", "path", "slide", "walk") in HOMES else None,
        ),
        ("core::f64", None),
    ],
)
def test_a_path_is_followed_through_the_front_door_and_upward(words, found):
    assert resolved(words.split("::"), ("motions", "path", "slide"), front_door()) == found


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


def circle(asks):
    """Modules that import each other in a circle, from the imports of each module."""
    # settle modules that import only settled ones; the rest is in a circle or imports from one
    settled, left = set(), {*asks, *(found for all_found in asks.values() for found in all_found)}
    while free := {module for module in left if asks.get(module, set()) <= settled}:
        settled |= free
        left -= free
    while outer := {module for module in left if not any(module in asks.get(other, ()) for other in left)}:
        left -= outer
    return left


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


# The layers of the Python package.

PACKAGE = ROOT / "python" / "spincyl"
CORE = "spincyl._core"
TRIGONOMETRY = re.compile(r"a?(?:rc)?(?:sin|cos|tan)h?2?|hypot|sincos")


def layers():
    """The layers in `spincyl/__init__.py`, lowest first; "." is the wrapper, "__init__" the front door."""
    return re.findall(r"^# (\S+) {2,}\S", (PACKAGE / "__init__.py").read_text("utf-8"), re.M)


def modules_of_python():
    """All modules of the package, by name; "spincyl" is the front door."""
    names = ((path, path.relative_to(PACKAGE.parent).with_suffix("").parts) for path in PACKAGE.rglob("*.py"))
    return {".".join(words).removesuffix(".__init__"): path for path, words in names}


def layer(module):
    """The layer of a module, by name."""
    first = module.split(".")[1] if "." in module else "__init__"
    return "cli" if first == "__main__" else first if first in layers() else "."


def asked(text, known):
    """The modules that a module imports anywhere or names in a string; imports for types do not count."""
    tree = ast.parse(text)
    hints = [x for x in ast.walk(tree) if isinstance(x, ast.If) and ast.unparse(x.test) == "TYPE_CHECKING"]
    unseen = {id(x) for hint in hints for line in hint.body for x in ast.walk(line)}
    for x in ast.walk(tree):
        names = []
        if isinstance(x, ast.ImportFrom):
            assert not x.level, f"line {x.lineno}: write the whole name of a module"
            whole = [f"{x.module}.{name.name}" for name in x.names]
            names = [name if name in known else x.module for name in whole]
        elif isinstance(x, ast.Import):
            names = [name.name for name in x.names]
        elif isinstance(x, ast.Constant) and x.value != "spincyl":  # an argument of import_module or files
            names = [x.value]
        if id(x) not in unseen:
            yield from (name for name in names if name in known)


def python_asks():
    """The imports of each module; the front door imports all layers below it."""
    known = modules_of_python()
    names = {*known, CORE}
    asks = {name: {*asked(path.read_text("utf-8"), names)} - {name} for name, path in known.items()}
    place = layers().index("__init__")
    asks["spincyl"] |= {name for name in known if layers().index(layer(name)) < place}
    return asks


def against(asks):
    """Imports of a higher layer."""
    order = {name: place for place, name in enumerate(layers())}
    pairs = ((name, other) for name, others in asks.items() for other in others)
    return [f"{name} asks {other}" for name, other in pairs if order[layer(name)] < order[layer(other)]]


def code_lines(text):
    """Number of lines with code, without empty lines, comments and docstrings."""
    blocks = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    docs = set()
    for x in ast.walk(ast.parse(text)):
        if isinstance(x, blocks) and ast.get_docstring(x, clean=False) is not None:
            docs |= set(range(x.body[0].lineno, x.body[0].end_lineno + 1))
    lines = enumerate(text.splitlines(), 1)
    return sum(bool(re.match(r"\s*[^\s#]", line)) and number not in docs for number, line in lines)


def trigonometry(text):
    """The names of functions that call a trigonometric function."""
    tree = ast.parse(text)
    inner = [x for x in ast.walk(tree) if isinstance(x, ast.FunctionDef)]
    for x in ast.walk(tree):
        word = x.attr if isinstance(x, ast.Attribute) else x.id if isinstance(x, ast.Name) else ""
        if TRIGONOMETRY.fullmatch(word):
            yield next((f.name for f in reversed(inner) if x in [*ast.walk(f)]), "")


def test_every_folder_of_the_package_is_a_layer():
    folders = {path.parent.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*.py")}
    assert sorted(folders | {"__init__"}) == sorted(layers())


@pytest.mark.parametrize(
    "line",
    [
        "from spincyl._body import Body",
        "def f():\n    from spincyl import _body",
        "import spincyl._body",
        "import_module('spincyl._body')",
        "files('spincyl._body')",
        "if TYPE_CHECKING:\n    pass\nelse:\n    from spincyl._body import Body",
    ],
)
def test_an_import_is_known_wherever_it_stands(line):
    assert {*asked(line, {"spincyl", "spincyl._body"})} == {"spincyl._body"}
    assert not [*asked("if TYPE_CHECKING:\n    from spincyl._body import Body", {"spincyl._body"})]


@pytest.mark.parametrize(
    ("module", "line"),
    [
        ("_input.numbers", "from spincyl import _core"),
        ("_input.numbers", "def f():\n    from spincyl._scale import Scale"),
        ("_motion", "def f():\n    import spincyl"),
        ("_motion", "import spincyl as sc"),
        ("_drift", "from spincyl import view"),
        ("_drift", "def f():\n    from spincyl import plot"),
        ("_drift", "from spincyl.sweep._common import in_si"),
        ("sweep._roll", "from spincyl._studio.poses import span"),
        ("_studio.frames", "files('spincyl._pages')"),
        ("data._compare", "def f():\n    from spincyl.plot import comparison"),
        ("plot._motions", "from spincyl._pages.view import view"),
        ("_pages.play", "import spincyl"),
        ("report", "from spincyl.cli import main"),
    ],
)
def test_an_import_against_the_layers_is_seen(module, line):
    names = {*modules_of_python(), CORE}
    assert f"spincyl.{module}" in names
    assert against({f"spincyl.{module}": {*asked(line, names)}})


@pytest.mark.parametrize(
    ("module", "line"),
    [
        ("_body", "from spincyl import _core"),
        ("_body", "from spincyl._input import numbers"),
        ("_roll", "def f():\n    from spincyl._ellipsoid import Ellipsoid"),
        ("plot._losses", "def f():\n    from spincyl.data import LossFit"),
        ("cli._play", "from spincyl import play"),
        ("__main__", "from spincyl.cli import main"),
    ],
)
def test_an_import_along_the_layers_is_none_against_them(module, line):
    names = {*modules_of_python(), CORE}
    assert {*asked(line, names)}
    assert not against({f"spincyl.{module}": {*asked(line, names)}})


def hidden(text):
    """Whether a text loads modules by names that it does not contain."""
    calls = [x for x in ast.walk(ast.parse(text)) if isinstance(x, ast.Call)]
    loads = [x for x in calls if ast.unparse(x.func).split(".")[-1] in ("import_module", "__import__")]
    return any(not isinstance(arg, ast.Constant) for x in loads for arg in x.args)


def test_only_three_places_load_a_module_by_a_name_that_they_are_given():
    assert hidden("importlib.import_module(f'spincyl.{x}')") and not hidden("import_module('spincyl.plot')")
    found = {name for name, path in modules_of_python().items() if hidden(path.read_text("utf-8"))}
    assert found == {"spincyl", "spincyl._upward", "spincyl._input.numbers"}


def test_no_module_imports_from_a_layer_above_its_own():
    asks = python_asks()
    assert sum(map(len, asks.values())) > 400
    assert not against(asks)


def test_modules_in_a_circle_are_seen():
    assert circle({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": {"a"}}) == {"b", "c"}
    assert not circle({"a": {"b"}, "b": {"c"}})


def test_no_modules_of_the_package_import_each_other_in_a_circle():
    assert not circle(python_asks())


def test_each_method_of_a_layer_above_has_one_function_and_each_function_its_method():
    from spincyl._upward import HOMES, above

    methods = set()
    for path in modules_of_python().values():
        methods |= set(re.findall(r"\babove\(\"([\w.]+)\"\)", path.read_text("utf-8")))
    assert methods == set(HOMES)
    assert all(callable(above(method)) for method in methods)


def test_lines_of_code_are_neither_empty_nor_comments_nor_docstrings():
    text = '"""A module.\n\nOf two.\n"""\n\n# why\nx = 1  # that\n\n\ndef f():\n    """It."""\n    return """a\nb"""\n'
    assert code_lines(text) == 4


def test_the_wrapper_is_thin_and_no_file_is_long():
    texts = {name: path.read_text("utf-8") for name, path in modules_of_python().items()}
    assert not {name: n for name, text in texts.items() if (n := len(text.splitlines())) > 450}
    top = [path.read_text("utf-8") for path in PACKAGE.glob("*.py")]
    assert len(top) > 20
    assert sum(map(code_lines, top)) <= 3000


@pytest.mark.parametrize(
    ("line", "name"),
    [
        ("def f(x):\n    return np.sin(x)", "f"),
        ("def f(x):\n    return math.atan2(x, 1)", "f"),
        ("class A:\n    def f(self):\n        return np.hypot(1, 2)", "f"),
        ("from numpy import arccos\ny = arccos(0.5)", ""),
        ("law = np.tan", ""),
    ],
)
def test_trigonometry_is_known_by_its_names(line, name):
    assert [*trigonometry(line)] == [name]


def test_what_is_no_trigonometry_is_not_taken_for_it():
    assert not [*trigonometry("x = np.since(1) + math.inf + distance(2) + np.pi + cost")]


def test_the_wrapper_leaves_trigonometry_to_the_core():
    found = {
        f"{path.stem}.{name}"
        for path in PACKAGE.glob("*.py")
        for name in trigonometry(path.read_text("utf-8"))
    }
    assert not found


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
