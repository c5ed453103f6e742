"""The note of this folder, as a page and as a PDF.

    python docs/note/note.py [FOLDER]

The text is Markdown. `@{name}` or `@{name:.2f}` in it stands for a number of `computed.py`, so that none is
typed; the figures are those of `drawn.py`. The PDF is the page as Chromium prints it; formulas are set by the
MathJax of the docs, without a network.
"""

import re
import sys
from html import escape
from importlib.util import find_spec
from pathlib import Path
from shutil import copyfile

import matplotlib as mpl
import numpy as np
from computed import numbers
from drawn import figures

HERE = Path(__file__).parent
TEXT = HERE / "two-stabilities.md"
MADE = HERE / "_made"
KEPT = MADE / TEXT.name  # the text with its numbers
PLACEHOLDER = re.compile(r"@\{(\w+)(?::([^}]*))?\}")


def filled(text):
    """The text with its numbers."""

    def number(place):
        name, how = place.groups()
        value = numbers()[name]
        if not isinstance(value, str) and not np.isfinite(value):
            raise ValueError(f"{name} is {value}")
        return format(value, how or "").replace("-", "\u2212") if how else str(value)

    return PLACEHOLDER.sub(number, text)


def is_made():
    """Whether the note was made since anything of this folder changed; it takes a quarter of a minute."""
    return KEPT.exists() and all(KEPT.stat().st_mtime >= path.stat().st_mtime for path in HERE.glob("*.*"))


STIX = {
    ("normal", "normal"): "",
    ("italic", "normal"): "Italic",
    ("normal", "bold"): "Bol",
    ("italic", "bold"): "BolIta",
}
MATHJAX = "tex-svg-full.js"


def page(text):
    """The text as a page of HTML, with its formulas as MathJax reads them."""
    from markdown_it import MarkdownIt
    from mdit_py_plugins.dollarmath import dollarmath_plugin

    def formula(tokens, i, *_):
        token = tokens[i]
        if token.info.strip() != "math":
            raise ValueError(f"a block of {token.info!r} has no place in the note")
        return f"<div class=formula>\\[{escape(token.content)}\\]</div>"

    reader = (
        MarkdownIt("commonmark", {"typographer": True})
        .enable(["table", "smartquotes", "replacements"])
        .use(dollarmath_plugin, renderer=lambda tex, how: rf"\({escape(tex)}\)", double_inline=False)
    )
    reader.renderer.rules["fence"] = formula
    faces = "".join(
        f"@font-face{{font-family:STIX;src:url(STIXGeneral{ending}.ttf);font-style:{style};font-weight:{weight}}}"
        for (style, weight), ending in STIX.items()
    )
    title = re.search(r"^# (.*)$", text, flags=re.M)[1]
    return (
        f"<!DOCTYPE html><html lang=en><meta charset=utf-8><title>{escape(title)}</title><style>{faces}"
        f"{(HERE / 'note.css').read_text()}</style>"
        "<script>MathJax={options:{enableMenu:false},svg:{fontCache:'global'}}</script>"
        f"<script src={MATHJAX}></script><body><article>{reader.render(text)}</article></body></html>"
    )


def make(folder=MADE):
    """The figures, and the note as HTML with what it needs beside it; the path of the page."""
    figures(folder)
    package = find_spec("sphinx-mathjax-offline")
    assert package and package.origin, "pip install --group docs"
    copyfile(Path(package.origin).parent / "static" / "mathjax" / MATHJAX, folder / MATHJAX)
    fonts = Path(mpl.get_data_path()) / "fonts" / "ttf"
    for ending in STIX.values():
        copyfile(fonts / f"STIXGeneral{ending}.ttf", folder / f"STIXGeneral{ending}.ttf")
    made, text = folder / f"{TEXT.stem}.html", filled(TEXT.read_text("utf-8"))
    made.write_text(page(text).replace('src="_made/', 'src="'), "utf-8")
    (folder / KEPT.name).write_text(text, "utf-8")
    return made


FOOT = '<div style="width:100%;text-align:center;font:8pt serif"><span class=pageNumber></span></div>'


def print_out(made):
    """The page as a PDF beside it; None where there is no browser."""
    sys.path.insert(0, str(HERE.parents[1] / "tests"))
    import browser
    from playwright.sync_api import sync_playwright

    if browser.find() is None:
        print(f"no PDF: {browser.MISSING}")
        return None
    with sync_playwright() as driver:
        chromium = driver.chromium.launch(executable_path=browser.executable(), args=browser.FLAGS)
        paper = chromium.new_page()
        paper.set_default_timeout(browser.PATIENCE)
        paper.goto(made.absolute().as_uri())
        paper.evaluate("async () => { await MathJax.startup.promise; await document.fonts.ready }")
        wrong = paper.locator("[data-mjx-error]").count()
        assert not wrong, f"{wrong} formulas have errors"
        margins = {"top": "20mm", "bottom": "20mm", "left": "25mm", "right": "25mm"}
        paper.pdf(
            path=made.with_suffix(".pdf"), format="A4", margin=margins, print_background=True,
            display_header_footer=True, header_template="<span></span>", footer_template=FOOT,
            outline=True, tagged=True,
        )  # fmt: skip
        chromium.close()
    return made.with_suffix(".pdf")


if __name__ == "__main__":
    made = make(Path(sys.argv[1]) if len(sys.argv) > 1 else MADE)
    print(made, print_out(made) or "", sep="\n")
