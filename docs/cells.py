"""The code of figures as cells of a notebook, so that each leaves the names that the text uses."""

import ast
from textwrap import indent


def quiet(code: str) -> str:
    """Code that draws, with a semicolon so that the notebook does not print the value of its last line."""
    return f"{code.strip()};" if isinstance(ast.parse(code).body[-1], ast.Expr) else code.strip()


def apart(code: str, before: list[str], after: list[str]) -> str:
    """The code of a figure, wrapped in a function if it would change a name that is used later.

    On a page a figure is drawn by itself; in a notebook it shares names with all other blocks.
    """
    known = {name for text in before for name in bound(ast.parse(text))}
    needed = {name for text in before for name in in_functions(text)}
    again: set[str] = set()
    for text in after:
        needed |= asked(text) - again
        again |= bound(ast.parse(text))
    if not bound(ast.parse(code)) & known & needed:
        return code
    return f"def figure():\n{indent(code.removesuffix(';'), '    ')}\n\n\nfigure()"


def bound(tree: ast.AST) -> set[str]:
    """The names that code sets, without those of imports."""
    stored = {x.id for x in ast.walk(tree) if isinstance(x, ast.Name) and isinstance(x.ctx, ast.Store)}
    return stored | {x.name for x in ast.walk(tree) if isinstance(x, ast.FunctionDef | ast.ClassDef)}


def read(tree: ast.AST) -> set[str]:
    """The names that code reads."""
    return {x.id for x in ast.walk(tree) if isinstance(x, ast.Name) and isinstance(x.ctx, ast.Load)}


def asked(code: str) -> set[str]:
    """The names that code reads before it sets them."""
    free: set[str] = set()
    has: set[str] = set()
    for line in ast.parse(code).body:
        # an assignment reads its value first; a loop sets its names before it reads them
        own = set() if isinstance(line, ast.Assign | ast.AugAssign) else bound(line)
        free |= read(line) - has - own
        has |= bound(line)
    return free


def in_functions(code: str) -> set[str]:
    """The names that functions read when they are called."""
    return {name for x in ast.parse(code).body if isinstance(x, ast.FunctionDef) for name in read(x)}
