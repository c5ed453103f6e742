"""The pages: Sphinx reads Markdown, runs every figure, and makes the three-dimensional pages anew."""

import re
from importlib.util import find_spec
from itertools import count, takewhile
from pathlib import Path
from shutil import copyfile
from textwrap import indent
from typing import Any

import matplotlib as mpl
import numpy as np
from docutils import nodes

import spincyl as sc

mpl.use("agg")

project = "spincyl"
author = "the spincyl developers"
version = release = sc.__version__
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "numpydoc",
    "matplotlib.sphinxext.plot_directive",
]
source_suffix = {".md": "markdown"}
exclude_patterns = ["_build", "_made"]
html_theme = "furo"
html_title = "spincyl"
html_static_path = ["_made"]
html_css_files = ["formulas.css"]
html_show_sourcelink = False
html_show_copyright = False
html_copy_source = False
templates_path: list[str] = []
pygments_style, pygments_dark_style = "friendly", "monokai"

myst_heading_anchors = 3
myst_enable_extensions = ["colon_fence", "dollarmath"]
myst_fence_as_directive = ["math"]  # which is how other readers of Markdown have it, too
# one script, beside the pages, that fetches nothing: its menu would
mathjax_path = "mathjax.js"
mathjax3_config = {
    "options": {"enableMenu": False},
    "tex": {"packages": {"[-]": ["noerrors", "noundefined"]}},  # what is no formula is to be seen
}
autosummary_generate = False  # numpydoc brings it
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings say more
numpydoc_show_class_members = False
plot_include_source = True
plot_html_show_source_link = False
plot_html_show_formats = False
plot_formats = [("png", 130)]
plot_rcparams = {
    "axes.titlesize": "medium",
    "figure.constrained_layout.use": True,
    "figure.figsize": (8, 4.6),
    "font.size": 12,
    "legend.fontsize": "small",
}
plot_apply_rcparams = True
plot_working_directory = str(Path(__file__).parents[1])


def pages(folder: Path) -> None:
    """The motions that the pages show, each as a page of its own."""
    folder.mkdir(exist_ok=True)
    pipe, disk, coin = sc.Body.tube(6.0, bore=0.8), sc.Body.solid(0.375), sc.Body.solid(0.05)
    state = pipe.steady(np.radians(89.5))
    sc.view(sc.roll(pipe, state, 60.0), title="The paper's tube", slow=2).save(folder / "tube.html")
    standing = disk.steady(np.radians(80)).kicked(-0.01)
    held = [sc.roll(disk, standing, 20.0, contact=c) for c in ("rolling", "smooth")]
    sc.view(*held, labels=["on rubber", "on ice"], title="A disk on edge").save(folder / "friction.html")
    whirring = sc.roll(coin, coin.steady(0.25).kicked(0.15), 12.0)
    sc.view(whirring, title="A coin whirrs", slow=5).save(folder / "coin.html")
    cylinder = sc.Body.solid(2.5)
    nutating = sc.roll(cylinder, cylinder.steady(1.3).kicked(0.15), 20.0)
    sc.view(nutating, title="A cylinder nutates", slow=2).save(folder / "nutation.html")


def mathjax(folder: Path) -> None:
    """MathJax as its package has it, to be served with the pages."""
    package = find_spec("sphinx-mathjax-offline")
    assert package and package.origin, "pip install --group docs"
    copyfile(Path(package.origin).parent / "static" / "mathjax" / "tex-svg-full.js", folder / mathjax_path)
    # a formula as high as it is, without a bar to scroll it by
    (folder / html_css_files[0]).write_text("div.math { overflow-y: hidden; padding-block: 0.3em; }\n")


def formulas(_app: Any, doctree: nodes.document) -> None:
    """Hand formulas on as they are written, with their numbers."""
    for formula in doctree.findall(nodes.math_block):
        formula["no-wrap"] = True
        formula[:] = [nodes.Text(rf"\[{formula.astext()}\]")]


def equations(_app: Any, _name: str, source: list[str]) -> None:
    """Equations as they stand at the head of their module, so that none is typed twice."""

    def head(block: re.Match[str]) -> str:
        lines = (Path(__file__).parents[1] / block[1]).read_text("utf-8").splitlines()
        text = "\n".join(line[4:] for line in takewhile(lambda line: line.startswith("//!"), lines))
        found = re.search(r"^```text\n.*?^```", text, flags=re.M | re.S)
        if found is None:
            raise ValueError(f"{block[1]} opens with no equations")
        return found[0]

    source[0] = re.sub(r"^```{equations} (\S+)\n```", head, source[0], flags=re.M)


def plots(_app: Any, name: str, source: list[str]) -> None:
    """Hand figures on to matplotlib's directive, which reads reStructuredText only."""
    number = count(1)

    def handed_on(block: re.Match[str]) -> str:
        head = f".. plot::\n   :filename-prefix: {name}-{next(number)}\n   :alt:{block[1]}\n\n"
        return f"```{{eval-rst}}\n{head}{indent(block[2], '   ')}```"

    source[0] = re.sub(r"^```{plot}(.*?)\n(.*?)^```", handed_on, source[0], flags=re.M | re.S)


def setup(app: Any) -> None:
    """Sphinx calls this."""
    app.connect("source-read", equations)
    app.connect("source-read", plots)
    app.connect("doctree-read", formulas)


pages(Path(__file__).parent / "_made")
mathjax(Path(__file__).parent / "_made")
