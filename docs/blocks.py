"""Pages as written: prose, and fenced blocks of several kinds.

Sphinx (conf.py), the notebooks (notebooks.py) and the tests all use this reader.
"""

import ast
import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import NamedTuple

DOCS = Path(__file__).parent
ROOT = DOCS.parent
FENCE = re.compile(r"^```(\S+)(?: ([^\n]*))?\n(.*?)^```$", re.M | re.S)
#: kinds of blocks with code that runs
RUNS = ("python", "{plot}", "{live}")
#: style of the figures in pages
STYLE = {
    "axes.titlesize": "medium",
    "figure.constrained_layout.use": True,
    "figure.figsize": (8, 4.6),
    "font.size": 12,
    "legend.fontsize": "small",
}


class Block(NamedTuple):
    """A fenced block, or the prose between two of them."""

    kind: str  # first word of the fence, such as python, text or {plot}; "" for prose
    words: str  # rest of the fence's line
    text: str  # content of the fence, or the prose
    source: str  # the whole block as written


class Live(NamedTuple):
    """An interactive figure, from a block of the kind {live}."""

    shows: str  # name of the part of the live page
    address: str  # state of the page, as in its address
    caption: str
    code: str  # draws the picture that replaces the figure where nothing can compute


class Scene(NamedTuple):
    """A section of the gallery: a file of examples/, and its description."""

    path: str
    title: str
    prose: str
    picture: str  # description of the picture
    said: str  # output of the file


def blocks(text: str) -> list[Block]:
    """All blocks of a page, in order."""
    found, end = [], 0
    for fence in FENCE.finditer(text):
        found.append(Block("", "", text[end : fence.start()], text[end : fence.start()]))
        found.append(Block(fence[1], fence[2] or "", fence[3], fence[0]))
        end = fence.end()
    found.append(Block("", "", text[end:], text[end:]))
    odd = next((block.text for block in found if not block.kind and "\n```" in f"\n{block.text}"), None)
    if odd is not None:
        raise ValueError(f"a fence without a kind or without an end: {odd.strip()[:80]!r}")
    return [block for block in found if block.source]


def of_kind(text: str, *kinds: str) -> list[Block]:
    """The blocks of a page that are of these kinds."""
    return [block for block in blocks(text) if block.kind in kinds]


def prose(text: str) -> str:
    """A page without its fenced blocks."""
    return "".join(block.text for block in of_kind(text, ""))


def exchanged(text: str, kind: str, new: Callable[[Block], str]) -> str:
    """A page in which every block of a kind is replaced."""
    return "".join(new(block) if block.kind == kind else block.source for block in blocks(text))


def printed(all_blocks: Iterable[Block]) -> list[tuple[Block, str | None]]:
    """Blocks, each with the output that the page shows in a block of text below the code, or None."""
    found: list[tuple[Block, str | None]] = []
    last = None
    for block in all_blocks:
        if block.kind == "text" and last is not None and "print" in found[last][0].text:
            found[last] = found[last][0], block.text
            last = None
            continue
        found.append((block, None))
        if block.kind in RUNS:
            last = len(found) - 1 if block.kind == "python" else None
    return found


def live(block: Block) -> Live:
    """The interactive figure of a block."""
    shows, address = block.words.split()
    caption = ast.get_docstring(ast.parse(block.text), clean=False)
    if caption is None:
        raise ValueError(f"a figure without a caption: {block.words}")
    return Live(shows, address, caption, block.text.split('"""', 2)[2].strip())


def scenes(text: str) -> list[Scene]:
    """The scenes of the gallery."""
    found = []
    for section in re.split(r"^## ", text, flags=re.M):
        files = [block.words for block in of_kind(section, "{source}")]
        if not files:
            continue
        (path,), (said,) = files, of_kind(section, "text")
        title, words = prose(section).split("\n", 1)
        told = words.split(f"`python {path}` prints")[0]
        picture = re.search(r"^!\[(.*)\]\(.*\)\n", told, re.M)
        if picture is None:
            raise ValueError(f"{title}: a scene without a picture")
        found.append(Scene(path, title, told.replace(picture[0], "").strip(), picture[1], said.text))
    return found
