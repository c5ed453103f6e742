"""Which file tests what: the tables of tests/README.md, made from the heads of the files.

`python tests/subjects.py --write` writes the page; tests/test_house.py fails if it is not up to date.
"""

import argparse
import ast
import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
SRC, TESTS = ROOT / "src", ROOT / "tests"
PAGE = TESTS / "README.md"
PROMISE = re.compile(r"[^.;]*\b(?:a test|a property|the tests|tests of)\b[^.;]*", re.I)

HEAD = """\
# Which file tests what

This page is made from the heads of the files: `python tests/subjects.py --write`.

`tests/laws` has the tests of the core in Rust, `tests/test_*.py` those of the Python package, of its pages and of the repository.
`tests/reference` has independent models and the motions that they have computed (CONTRIBUTING.md says which program makes which).

## From a law to its tests

Comments in `src` that name the test or the property which checks them.
"""


def comments(path):
    """The comments of a file of Rust, a text for each run of lines."""
    run = []
    for line in [*path.read_text("utf-8").splitlines(), ""]:
        if found := re.match(r"\s*//[/!]?(.*)", line):
            run.append(found[1].strip())
        elif run:
            yield " ".join(run)
            run = []


def homes():
    """The file of each test, of each module with tests and of each test file, by name."""
    found = {}
    for path in [
        *sorted(SRC.rglob("*.rs")),
        *sorted((TESTS / "laws").rglob("*.rs")),
        *sorted(TESTS.glob("test_*.py")),
    ]:
        text, shown = path.read_text("utf-8"), path.relative_to(ROOT).as_posix().removesuffix("/main.rs")
        if path.is_relative_to(TESTS) or "#[cfg(test)]" in text:
            found.setdefault(path.stem if path.stem not in ("mod", "main") else path.parent.name, shown)
        for word in re.findall(r"#\[test\]\s*fn (\w+)|^def (test_\w+)", text, re.M):
            found[next(filter(None, word))] = shown
        if path.is_relative_to(TESTS):  # properties are in a macro
            for word in re.findall(r"^    fn (\w+)", text, re.M):
                found.setdefault(word, shown)
    return found


def promised():
    """The files that the comments of each file of the core name as its tests."""
    known = homes()
    for path in sorted(SRC.rglob("*.rs")):
        said = [x[0] for text in comments(path) for x in PROMISE.finditer(text)]
        words = (word for text in said for word in re.findall(r"`(\w+)`", text))
        files = {known[word] for word in words if word in known}
        if "the tests at the end" in " ".join(said):
            files.add(path.relative_to(ROOT).as_posix())
        if files:
            yield path.relative_to(ROOT).as_posix(), sorted(files)


def subject(path):
    """The first sentence of the head of a test file."""
    text = path.read_text("utf-8")
    if path.suffix == ".py":
        head = ast.get_docstring(ast.parse(text)) or ""
    else:
        head = " ".join(re.findall(r"^//! ?(.*)", text, re.M))
    return re.split(r"(?<=[.])\s", " ".join(head.split()).strip())[0]


def page():
    lines = [HEAD, "| file | tests |", "| --- | --- |"]
    for name, files in promised():
        lines.append(f"| `{name}` | {', '.join(f'`{x}`' for x in files)} |")
    for title, files in (
        ("The core", sorted((TESTS / "laws").rglob("*.rs"))),
        ("Python, its pages, and the repository", sorted(TESTS.glob("test_*.py"))),
    ):
        lines += ["", f"## {title}", "", "| file | subject |", "| --- | --- |"]
        for path in files:
            if said := subject(path):
                lines.append(
                    f"| `{path.relative_to(TESTS).as_posix()}` | {said.replace('|', chr(92) + '|')} |"
                )
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="write tests/README.md instead of printing it")
    if parser.parse_args().write:
        PAGE.write_text(page(), "utf-8")
    else:
        print(page(), end="")
