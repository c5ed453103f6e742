"""Pages and scenes of the gallery as Jupyter notebooks that run from top to bottom.

    python docs/notebooks.py [FOLDER]       writes FOLDER/PAGE.ipynb (default: docs/_made/notebooks)

A page has a notebook if it has code that runs and nothing that only Sphinx can make, such as a table of
names. Only blocks of the kinds python, {plot} and {live} are code there; every other one is shown as text.
"""

import json
import re
import sys
from base64 import b64encode
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from textwrap import dedent, indent
from typing import Any

from addresses import called
from blocks import (
    DOCS,
    ROOT,
    RUNS,
    STYLE,
    Block,
    Live,
    Scene,
    blocks,
    live,
    printed,
    prose,
    scenes,
)
from cells import apart, quiet

#: blocks that only Sphinx can show
ONLY_SPHINX = ("{eval-rst}", "{toctree}")
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\[\]]*\])*)\]\(([^)\s]+)\)")
MAIN = 'if __name__ == "__main__":\n'
KERNEL = {"display_name": "Python 3", "language": "python", "name": "python3"}


def page(name: str) -> str:
    """The text of a page."""
    return (DOCS / f"{name}.md").read_text("utf-8")


@cache
def pages() -> tuple[str, ...]:
    """The names of the pages that have a notebook."""
    kinds = {path.stem: {block.kind for block in blocks(page(path.stem))} for path in DOCS.glob("*.md")}
    return tuple(sorted(name for name, has in kinds.items() if has & {*RUNS} and not has & {*ONLY_SPHINX}))


class Notebook:
    """The cells of a notebook in order.

    `built` is the path of the built docs relative to the folder of the notebooks.
    """

    def __init__(self, name: str, built: str) -> None:
        self.name, self.built = name, built
        self.cells: list[dict[str, Any]] = []

    def text(self, markdown: str) -> None:
        """Add prose, with a cell for each section."""
        for part in re.split(r"^(?=##+ )", markdown, flags=re.M):
            if part.strip():
                self._section(re.sub(r"\n{3,}", "\n\n", part.strip()))

    def _section(self, markdown: str) -> None:
        pictures: dict[str, Any] = {}
        words = LINK.sub(lambda link: self._link(link, pictures), markdown)
        words = re.sub(r"\{[\w:+-]+\}(?=`)", "", words)  # roles of Sphinx
        self._add("markdown", words, **({"attachments": pictures} if pictures else {}))

    def code(self, code: str, said: str | None = None) -> None:
        """Add code and its output."""
        name = {"output_type": "stream", "name": "stdout"}
        outputs = [] if said is None else [name | {"text": said.splitlines(keepends=True)}]
        self._add("code", code.strip(), execution_count=None, outputs=outputs)

    def _add(self, kind: str, source: str, **more: Any) -> None:
        named = {"id": f"{self.name}-{len(self.cells) + 1}", "cell_type": kind, "metadata": {}}
        self.cells.append(named | {"source": source.splitlines(keepends=True)} | more)

    def _link(self, link: re.Match[str], pictures: dict[str, Any]) -> str:
        """A link for the notebook: to another notebook, or to a page of the built docs."""
        picture, words, target = link.groups()
        file, _, anchor = target.partition("#")
        if picture:
            path = Path(file)
            pictures[path.name] = {"image/png": b64encode((DOCS / path).read_bytes()).decode()}
            return f"![{words}](attachment:{path.name})"
        if target.startswith("live:"):
            return words
        if target.startswith(("https:", "http:", "mailto:", self.built)):
            return link[0]
        if file and not file.endswith(".md"):
            raise ValueError(f"{self.name}: a notebook cannot lead to {target}")
        name = file.removesuffix(".md") or self.name
        if name == "gallery" and anchor in scene_names():
            return f"[{words}]({scene_names()[anchor]}.ipynb)"
        if name not in pages():
            return f"[{words}]({self.built}/{name}.html{target[len(file) :]})"
        there = f"{name}.ipynb" if file else ""
        return f"[{words}]({there}{'#' + headings(name)[anchor] if anchor else ''})"

    def json(self) -> str:
        """The text of the notebook's file."""
        about = {"kernelspec": KERNEL, "language_info": {"name": "python"}}
        made = {"cells": self.cells, "metadata": about, "nbformat": 4, "nbformat_minor": 5}
        return json.dumps(made, indent=1, ensure_ascii=False) + "\n"


@cache
def headings(name: str) -> dict[str, str]:
    """The anchors of a page in Sphinx, with Jupyter's anchor for each."""
    found = re.findall(r"^#+ (.+)$", prose(page(name)), flags=re.M)
    return {anchor_of(head): head.replace(" ", "-") for head in found}


def anchor_of(head: str) -> str:
    """Sphinx's anchor of a heading."""
    return re.sub(r"[^\w -]", "", head.lower()).replace(" ", "-")


@cache
def scene_names() -> dict[str, str]:
    """The notebooks of the scenes, by their anchors in the gallery."""
    return {anchor_of(scene.title): Path(scene.path).stem for scene in scenes(page("gallery"))}


def headed(name: str, title: str, of: str, built: str) -> Notebook:
    """A notebook with its head: the page or scene that it was made from, and how to install what it needs."""
    made = Notebook(name, built)
    made.text(
        f"# {title}\n\nThis notebook has been made from [a page of the docs]({built}/{of}.html). It needs "
        "Jupyter and spincyl with all extras, which two commands in the folder of the repository install "
        "([how](install.md)): `python -m venv env && . env/bin/activate`, and then "
        "`pip install '.[all]' jupyterlab`."
    )
    style = "".join(f"    {key!r}: {value!r},\n" for key, value in STYLE.items()).replace("'", '"')
    made.code(
        "import matplotlib.pyplot as plt\nimport numpy as np\n\nimport spincyl as sc\n\n"
        "plt.ion()  # every figure is shown below its cell, also after one in a style of its own\n"
        f"plt.rcParams.update({{  # the style of the page\n{style}}})"
    )
    return made


def of_page(name: str, built: str) -> Notebook:
    """The notebook of a page."""
    title, rest = page(name).removeprefix("# ").split("\n", 1)
    made = headed(name, title, name, built)
    parts = printed(blocks(rest))
    shown, said = "", dict(enumerate(links(parts)))
    for i, (block, printout) in enumerate(parts):
        if block.kind not in RUNS:
            shown += as_text(block, built)
            continue
        if block.kind == "{live}":
            shown += f"\n{live(block).caption}\n"
        made.text(shown)
        shown = ""
        if block.kind == "python":
            made.code(block.text, printout)
        elif block.kind == "{plot}":
            before, after = (
                [x.text for x, _ in some if x.kind == "python"] for some in (parts[:i], parts[i:])
            )
            made.code(apart(quiet(block.text), before, after))
        else:
            made.code(touched(live(block), said[i]))
    made.text(shown)
    return made


def links(parts: list[tuple[Block, str | None]]) -> list[list[tuple[str, str]]]:
    """For each block the links that set it, if it is an interactive figure: words and address.

    A link sets the next figure of its section, or else the last one before it.
    """
    found: list[list[tuple[str, str]]] = [[] for _ in parts]
    waiting: list[tuple[str, str]] = []
    figure: int | None = None  # index of the section's figure
    for i, (block, _) in enumerate(parts):
        if block.kind == "{live}":
            figure = i
            found[i] += waiting
            waiting = []
        for part in re.split(r"^(?=## )", block.text, flags=re.M) if not block.kind else ():
            if part.startswith("## "):
                if figure is not None:
                    found[figure] += waiting
                waiting, figure = [], None
            asked = [x.groups()[1:] for x in LINK.finditer(part) if x[3].startswith("live:")]
            waiting += [(" ".join(words.split()), target.removeprefix("live:")) for words, target in asked]
    if figure is not None:
        found[figure] += waiting
    return found


def touched(figure: Live, links: list[tuple[str, str]]) -> str:
    """The call that shows a figure, and as comments the calls for the links that change it."""
    code = called(figure.address)
    others: dict[str, str] = {}
    for words, address in links:
        others.setdefault(called(address), words)
    others.pop(code, None)
    return "\n".join([code, *(indent(f"{words}:\n{call}", "# ") for call, words in others.items())])


def as_text(block: Block, built: str) -> str:
    """A block without running code, as Markdown for a notebook."""
    if not block.kind:
        return block.text
    if block.kind == "math":
        return f"$$\n{block.text}$$"
    if block.kind == "{raw}":
        frame = re.search(r'<iframe [^>]*src="([^"]+)" title="([^"]+)"', block.text)
        if frame is None:
            raise ValueError(f"a notebook cannot show {block.text[:80]!r}")
        return f"A page to look at: [{frame[2]}]({built}/{frame[1]})."
    if block.kind.startswith("{"):
        raise ValueError(f"a notebook has no place for {block.kind}")
    return f"```{block.kind}\n{block.text}```"


def of_scene(scene: Scene, built: str) -> Notebook:
    """The notebook of a scene of the gallery: its file, its picture and its output."""
    made = headed(Path(scene.path).stem, scene.title, "gallery", built)
    whole = (ROOT / scene.path).read_text("utf-8")
    code, main = whole[whole.index('"""', 3) + 3 :].split(MAIN)
    made.text(scene.prose)
    made.code(code)
    made.text(scene.picture)
    made.code("picture()")
    made.code(dedent(main), scene.said)
    return made


def all_made(built: str) -> Iterator[Notebook]:
    """Every notebook."""
    for name in pages():
        yield of_page(name, built)
    for scene in scenes(page("gallery")):
        yield of_scene(scene, built)


def written(folder: Path, built: str) -> list[Path]:
    """Write all notebooks into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    found = []
    for made in all_made(built):
        found.append(folder / f"{made.name}.ipynb")
        found[-1].write_text(made.json(), "utf-8")
    return found


if __name__ == "__main__":
    print(*written(Path(sys.argv[1]) if sys.argv[1:] else DOCS / "_made/notebooks", "../../_build"), sep="\n")
