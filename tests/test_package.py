"""Rules for the Python package: its layers import downward, the wrapper is thin, and no file is long."""

import ast
import pathlib
import re

import pytest
from circles import circle

PACKAGE = pathlib.Path(__file__).parents[1] / "python" / "spincyl"
CORE = "spincyl._core"
TRIGONOMETRY = re.compile(r"a?(?:rc)?(?:sin|cos|tan)h?2?|hypot|sincos")


#: Modules with public names of the applications, beside the front door.
DOORS = {"data", "plot"}
APPLICATIONS = {"studio", "lab"}


def layers():
    """The layers in `spincyl/__init__.py`, lowest first; "." is the wrapper, "__init__" the front door."""
    return re.findall(r"^# (\S+) {2,}\S", (PACKAGE / "__init__.py").read_text("utf-8"), re.M)


def modules_of_python():
    """All modules of the package, by name; "spincyl" is the front door."""
    names = ((path, path.relative_to(PACKAGE.parent).with_suffix("").parts) for path in PACKAGE.rglob("*.py"))
    return {".".join(words).removesuffix(".__init__"): path for path, words in names}


def layer(module):
    """The layer of a module, by name: the innermost folder that is one."""
    words = module.split(".")[1:] or ["__init__"]
    if words[0] in ("__main__", *DOORS):
        return "cli" if words[0] == "__main__" else "__init__"
    folders = [".".join(words[:n]) for n in range(len(words), 0, -1)]
    return next((folder for folder in folders if folder in layers()), ".")


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


def functions_and_classes(text):
    """The names of functions and classes at the top of a module."""
    return {x.name for x in ast.parse(text).body if isinstance(x, ast.FunctionDef | ast.ClassDef)} - {
        "__getattr__",
        "__dir__",
        "_",  # what `register` of a `singledispatch` takes has no name
    }


def trigonometry(text):
    """The names of functions that call a trigonometric function."""
    tree = ast.parse(text)
    inner = [x for x in ast.walk(tree) if isinstance(x, ast.FunctionDef)]
    for x in ast.walk(tree):
        word = x.attr if isinstance(x, ast.Attribute) else x.id if isinstance(x, ast.Name) else ""
        if TRIGONOMETRY.fullmatch(word):
            yield next((f.name for f in reversed(inner) if x in [*ast.walk(f)]), "")


def test_every_folder_of_the_package_is_a_layer():
    folders = {
        path.parent.relative_to(PACKAGE).as_posix().replace("/", ".") for path in PACKAGE.rglob("*.py")
    }
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
        ("sweep._roll", "from spincyl.studio.poses import span"),
        ("studio.frames", "files('spincyl.studio.pages')"),
        ("_body", "def f():\n    from spincyl.lab._compare import compare"),
        ("lab._compare", "def f():\n    from spincyl.plot import comparison"),
        ("studio.plot._motions", "from spincyl.studio.pages.view import view"),
        ("studio.cards", "def f():\n    from spincyl.lab._report import section"),
        ("studio.pages.view", "from spincyl.data import Filmed"),
        ("studio.pages.play", "import spincyl"),
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
        ("lab._figures", "from spincyl.studio.plot._style import BLUE"),
        ("plot", "from spincyl.lab._figures import losses"),
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


def test_the_wrapper_does_not_know_the_applications_nor_the_studio_the_lab():
    folders = {name: layer(name).split(".")[0] for name in {*modules_of_python(), CORE}}
    pairs = {(folders[name], folders[other]) for name, others in python_asks().items() for other in others}
    assert ("lab", "studio") in pairs and ("studio", "lab") not in pairs
    assert not {one for one, other in pairs if other in APPLICATIONS} - {*APPLICATIONS, "__init__", "cli"}


def test_the_head_of_an_application_is_all_that_its_folder_loads_and_says_where_its_names_are():
    for folder in APPLICATIONS:
        text = (PACKAGE / folder / "__init__.py").read_text("utf-8")
        assert "application" in ast.get_docstring(ast.parse(text)) and not code_lines(text)
        assert re.search(rf"\b{folder}\b", (PACKAGE.parents[1] / "README.md").read_text("utf-8"))


def test_no_modules_of_the_package_import_each_other_in_a_circle():
    assert not circle(python_asks())


def test_each_method_of_a_layer_above_has_one_function_and_each_function_its_method():
    from spincyl._upward import HOMES, function_of_method

    methods = set()
    for path in modules_of_python().values():
        methods |= set(re.findall(r"\bfunction_of_method\(\"([\w.]+)\"\)", path.read_text("utf-8")))
    assert methods == set(HOMES)
    assert all(callable(function_of_method(method)) for method in methods)


def test_lines_of_code_are_neither_empty_nor_comments_nor_docstrings():
    text = '"""A module.\n\nOf two.\n"""\n\n# why\nx = 1  # that\n\n\ndef f():\n    """It."""\n    return """a\nb"""\n'
    assert code_lines(text) == 4


def test_the_wrapper_is_thin_and_no_file_is_long():
    texts = {name: path.read_text("utf-8") for name, path in modules_of_python().items()}
    assert not {name: n for name, text in texts.items() if (n := len(text.splitlines())) > 450}
    top = [path.read_text("utf-8") for path in PACKAGE.glob("*.py") if path.stem not in DOORS]
    assert len(top) > 20
    assert sum(map(code_lines, top)) <= 4900


def test_the_name_of_a_function_or_class_occurs_once_in_a_layer():
    assert functions_and_classes("def f():\n    def g(): ...\nclass A: ...\nx = 1") == {"f", "A"}
    homes = {}
    for module, path in modules_of_python().items():
        for name in functions_and_classes(path.read_text("utf-8")):
            homes.setdefault((layer(module), name), []).append(module)
    assert len(homes) > 700
    assert not {name: modules for name, modules in homes.items() if len(modules) > 1}


def by_position(x):
    """The arguments of a function that can be given by position, without self."""
    return [a.arg for a in [*x.args.posonlyargs, *x.args.args] if a.arg not in ("self", "cls")]


def tuples(x):
    """The tuples of three or more parts without names in the hints of a function."""
    arguments = [*x.args.posonlyargs, *x.args.args, *x.args.kwonlyargs]
    hints = [hint for hint in [*(a.annotation for a in arguments), x.returns] if hint is not None]
    for part in (part for hint in hints for part in ast.walk(hint)):
        if isinstance(part, ast.Subscript) and ast.unparse(part.value) == "tuple":
            parts = part.slice.elts if isinstance(part.slice, ast.Tuple) else []
            if len(parts) > 2 and ast.unparse(parts[-1]) != "...":
                yield ast.unparse(part)


def functions_of_package():
    for name, path in modules_of_python().items():
        for x in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(x, ast.FunctionDef):
                yield name, x


def test_no_function_of_python_takes_more_than_six_arguments_by_position():
    found = {
        f"{name}.{x.name}": len(given)
        for name, x in functions_of_package()
        if len(given := by_position(x)) > 6
    }
    assert not found


def test_few_hints_have_tuples_without_names():
    # mostly the numbers of a body, of a state and of a contact, and rows of tables
    found = [(name, x.name) for name, x in functions_of_package() for _ in tuples(x)]
    assert len(found) <= 54, found


def asks_for_stones(text):
    """The number of calls of isinstance with a class of stones: where code asks what a body is."""
    calls = [
        x
        for x in ast.walk(ast.parse(text))
        if isinstance(x, ast.Call) and ast.unparse(x.func) == "isinstance"
    ]
    return sum("Ellipsoid" in ast.unparse(x.args[1]) for x in calls)


def test_what_a_stone_does_in_another_way_is_known_to_its_class():
    # `roll` chooses between two ways, and a page with controls refuses a stone with advice
    assert asks_for_stones("isinstance(x, Ellipsoid)\nisinstance(m, A | EllipsoidMotion)\nf(Ellipsoid)") == 2
    found = {name: asks_for_stones(path.read_text("utf-8")) for name, path in modules_of_python().items()}
    assert {name: count for name, count in found.items() if count} == {
        "spincyl._roll": 1,
        "spincyl.studio.pages.words": 1,
    }


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
