"""Sphinx configuration: reads Markdown, runs every figure, and makes the three-dimensional pages anew."""

import os
import sys
from html import escape
from importlib.util import find_spec
from itertools import count
from pathlib import Path
from shutil import copyfile
from textwrap import indent
from typing import Any

import matplotlib as mpl
import numpy as np
from docutils import nodes
from numpydoc.xref import DEFAULT_LINKS

import spincyl as sc

sys.path.insert(0, str(Path(__file__).parent / "note"))
sys.path.insert(0, str(Path(__file__).parent))
import blocks
import note
import notebooks
from blocks import Block, exchanged

mpl.use("agg")
HERE = Path(__file__).parent

project = "spincyl"
author = "the spincyl developers"
version = release = sc.__version__
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.intersphinx",
    "sphinx.ext.mathjax",
    "numpydoc",
    "matplotlib.sphinxext.plot_directive",
]
# Other sites are read only if this variable is set, since the docs have to build without a network.
LINKS = "SPINCYL_LINKS" in os.environ
OTHERS = {
    "dask": "https://docs.dask.org/en/stable",
    "matplotlib": "https://matplotlib.org/stable",
    "numpy": "https://numpy.org/doc/stable",
    "python": "https://docs.python.org/3",
    "scipy": "https://docs.scipy.org/doc/scipy",
    "xarray": "https://docs.xarray.dev/en/stable",
}
intersphinx_mapping = {name: (url, None) for name, url in OTHERS.items()} if LINKS else {}
intersphinx_timeout = 20
source_suffix = {".md": "markdown"}
exclude_patterns = ["_build", "_made", "note/_made", "style", "**/notebooks"]
html_theme = "furo"
html_title = "spincyl"
html_static_path = ["_made", "style"]
html_css_files = ["formulas.css", "gallery.css", "live.css"]
html_js_files = [("live.js", {"defer": "defer"})]
html_show_sourcelink = False
html_show_copyright = False
html_copy_source = False
templates_path: list[str] = []
pygments_style, pygments_dark_style = "friendly", "monokai"

myst_heading_anchors = 3
myst_enable_extensions = ["colon_fence", "dollarmath"]
# A link that sets the figure of its section, or opens the live page in that state.
myst_url_schemes = {name: None for name in ("http", "https", "mailto", "ftp")} | {
    "live": {"url": "_static/play.html#{{path}}", "classes": ["live"]}
}
myst_fence_as_directive = ["math"]  # so that other readers of Markdown show the formulas, too
# one script beside the pages; without the menu it loads nothing else
mathjax_path = "mathjax.js"
mathjax3_config = {
    "options": {"enableMenu": False},
    "tex": {"packages": {"[-]": ["noerrors", "noundefined"]}},  # a faulty formula must be visible
}
autosummary_generate = False  # numpydoc does this
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings say more
numpydoc_show_class_members = False
# Types of parameters link to their documentation; unknown ones stay plain text.
numpydoc_xref_param_type = True
numpydoc_xref_ignore = "all"
numpydoc_xref_aliases = {
    **{name: f"spincyl.{name}" for name in sc.__all__ if name[0].isupper()},
    **{name: f"spincyl.loss.{name}" for name in ("Law", "Loss")},
    **{name: f"spincyl.data.{name}" for name in sc.data.__all__ if name[0].isupper()},
    **(
        {"Axes": "matplotlib.axes.Axes", "xarray.Dataset": ":py:class:`xarray.Dataset`"}
        if LINKS
        else {word: word for word in DEFAULT_LINKS}
    ),
}
plot_include_source = True
plot_html_show_source_link = False
plot_html_show_formats = False
plot_formats = [("png", 130)]
plot_rcparams = blocks.STYLE
plot_apply_rcparams = True
plot_working_directory = str(HERE.parent)


def pages(folder: Path) -> None:
    """Save the motions that the pages show, each as a page."""
    folder.mkdir(exist_ok=True)
    pipe, disk = sc.Body.tube(6.0, bore=0.8), sc.Body.solid(0.375)
    state = pipe.steady(np.radians(89.5))
    sc.view(sc.roll(pipe, state, 60.0), title="The paper's tube", slow=2, exposure=1).save(
        folder / "tube.html"
    )
    standing = disk.steady(np.radians(80)).kicked(-0.01)
    held = [sc.roll(disk, standing, 20.0, contact=c) for c in ("rolling", "smooth")]
    sc.view(*held, labels=["on rubber", "on ice"], title="A disk on edge").save(folder / "friction.html")
    cylinder = sc.Body.solid(2.5)
    sc.play(cylinder, 1.3, kick=0.1).save(folder / "play.html")
    sc.play(cylinder, 1.3, kick=0.1, friction=False).save(folder / "figure.html")


def mathjax(folder: Path) -> None:
    """Copy MathJax from its package beside the pages."""
    package = find_spec("sphinx-mathjax-offline")
    assert package and package.origin, "pip install --group docs"
    copyfile(Path(package.origin).parent / "static" / "mathjax" / "tex-svg-full.js", folder / mathjax_path)
    # the full height of a formula, without a scroll bar
    (folder / html_css_files[0]).write_text("div.math { overflow-y: hidden; padding-block: 0.3em; }\n")


def formulas(_app: Any, doctree: nodes.document) -> None:
    """Pass formulas on as written, with their numbers."""
    for formula in doctree.findall(nodes.math_block):
        formula["no-wrap"] = True
        formula[:] = [nodes.Text(rf"\[{formula.astext()}\]")]


def plots(_app: Any, name: str, source: list[str]) -> None:
    """Turn figures into matplotlib's directive, which reads reStructuredText only."""
    number = count(1)

    def handed_on(block: Block) -> str:
        head = f".. plot::\n   :filename-prefix: {name}-{next(number)}\n   :alt: {block.words}\n\n"
        return f"```{{eval-rst}}\n{head}{indent(block.text, '   ')}```"

    source[0] = exchanged(source[0], "{plot}", handed_on)


def noted(_app: Any, name: str, source: list[str]) -> None:
    """Fill the numbers of the note, and link to its PDF if `make note` has made one."""
    if name == f"note/{note.TEXT.stem}":
        source[0] = note.KEPT.read_text("utf-8") if note.is_made() else note.filled(source[0])
        if (printed := note.MADE / f"{note.TEXT.stem}.pdf").exists():
            source[0] += f"\n\n{{download}}`As a PDF <_made/{printed.name}>`\n"


def live(_app: Any, name: str, source: list[str]) -> None:
    """Interactive figures: the code of the picture below its caption, and the state for the live page.

    All figures of the site share two live pages: one with friction and losses, for pages with a figure or
    link that needs them, and a smaller one.
    """
    number = count(1)
    friction = ("contact=coulomb", "contact=viscous", "law=")
    page = "play" if any(word in source[0] for word in friction) else "figure"

    def framed(block: Block) -> str:
        shows, state, caption, code = blocks.live(block)
        place = escape(f"_static/{page}.html#figure={shows}&{state}")
        head = f".. plot::\n   :filename-prefix: {name}-live-{next(number)}\n   :include-source: false\n"
        plot = f"```{{eval-rst}}\n{head}   :alt: {caption}\n\n{indent(code, '   ')}\n```"
        return f"""```{{raw}} html
<figure class="live" data-live="{place}"><div class="picture">
```
{plot}
```{{raw}} html
</div><figcaption>{caption} <a href="_static/play.html#{escape(state)}">All controls</a></figcaption></figure>
```"""

    source[0] = exchanged(source[0], "{live}", framed)


def sources(_app: Any, _name: str, source: list[str]) -> None:
    """Show source files in folded blocks, each with a link to its notebook."""

    def folded(block: Block) -> str:
        return f"""```{{raw}} html
<details class="source"><summary>{block.words}</summary>
```

```{{literalinclude}} ../{block.words}
:language: python
```

```{{raw}} html
</details>
{link(Path(block.words).stem)}
```"""

    source[0] = exchanged(source[0], "{source}", folded)


def link(name: str) -> str:
    """A link to a notebook, as HTML."""
    return f'<p class="notebook"><a href="notebooks/{name}.ipynb" download>As a notebook</a></p>'


def linked(_app: Any, name: str, source: list[str]) -> None:
    """Add a link to the notebook below the title of each page that has one."""
    if name in notebooks.pages():
        title, rest = source[0].split("\n", 1)
        source[0] = f"{title}\n\n```{{raw}} html\n{link(name)}\n```\n{rest}"


def made(app: Any, failed: Exception | None) -> None:
    """Write the notebooks to a folder beside the pages."""
    if failed is None and app.builder.format == "html":
        notebooks.written(Path(app.outdir) / "notebooks", "..")


def fields(app: Any, env: Any) -> list[str]:
    """Register attributes that a class documents itself, such as `Motion.theta`, as targets of links."""
    known = env.get_domain("py").objects
    for name, entry in list(known.items()):
        kind: Any = sc
        for word in name.split(".")[1:] if entry.objtype == "class" else ():
            kind = getattr(kind, word, None)
        told = [*getattr(kind, "__dataclass_fields__", ()), *getattr(kind, "_fields", ())]
        for field in told if entry.objtype == "class" else ():
            if not field.startswith("_"):
                known.setdefault(f"{name}.{field}", entry._replace(objtype="attribute"))
    return []


def setup(app: Any) -> None:
    """Connect the functions above to Sphinx."""
    app.connect("env-updated", fields)
    app.connect("source-read", plots)
    app.connect("source-read", live)
    app.connect("source-read", noted)
    app.connect("source-read", sources)
    app.connect("source-read", linked)
    app.connect("doctree-read", formulas)
    app.connect("build-finished", made)


pages(HERE / "_made")
mathjax(HERE / "_made")
if not note.is_made():
    note.figures(note.MADE)
