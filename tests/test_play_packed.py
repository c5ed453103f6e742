"""The packed content of the live page: a browser unpacks it byte by byte; damaged content is refused."""

import base64
import hashlib
import json
import lzma
from importlib.resources import files

import numpy as np
import pytest
from page_scenes import live_page

from spincyl.studio.pages.compressed import compressed
from spincyl.studio.pages.joined import text
from spincyl.studio.pages.packed import packed
from spincyl.studio.pages.play import CORES

CHANCE = np.random.default_rng(7)
COMMITTED = files("spincyl.studio.pages").joinpath("cores")
#: Bytes for all kinds of matches and literals of LZMA.
KINDS = {
    "nothing": b"",
    "one byte": b"\xff",
    "noughts": bytes(100_000),
    "chance": CHANCE.bytes(20_000),
    "a script": text("play.map.js").encode(),
    "a long period": CHANCE.bytes(70_000) * 3,
    "short periods": b"".join(CHANCE.bytes(n) * 40 for n in range(1, 60)),
    "records of which one byte changes": np.arange(9000, dtype="<u4").tobytes(),
    "numbers": np.sin(np.arange(4000.0)).tobytes(),
    "the lean core": lzma.decompress(COMMITTED.joinpath(CORES[0]).read_bytes()),
    "the whole core": lzma.decompress(COMMITTED.joinpath(CORES[1]).read_bytes()),
}
#: Unpacks two byte strings from a text as the loader does, or returns the error of a damaged text.
OPEN = """text => {
  const tell = bytes => { let all = ""; for (const b of bytes) all += String.fromCharCode(b); return btoa(all); };
  try { const [first, second] = unpacked(text); return [first, second].map(tell); } catch (e) { return e.message; }
}"""

#: The core of a text, as the loader joins it.
JOIN = """text => {
  let all = "";
  for (const b of joined(unpacked(text).next().value)) all += String.fromCharCode(b);
  return btoa(all);
}"""


@pytest.fixture(scope="module")
def opened(chromium):
    """A function that unpacks a text in a browser."""
    page = chromium.new_page()
    page.set_default_timeout(chromium.patience)
    loader = (
        text("play.lzma.js") + text("play.join.js") + text("play.loader.js").split("async function opened")[0]
    )
    page.add_script_tag(content=loader)
    yield lambda packed, how=OPEN: page.evaluate(how, packed)
    page.close()


@pytest.mark.parametrize("kind", KINDS)
def test_what_was_packed_is_unpacked(opened, kind):
    first, second = KINDS[kind], b"and the rest"
    for pieces in ((first, second), (second, first)):
        assert tuple(map(base64.b64decode, opened(packed(*map(compressed, pieces))))) == pieces


@pytest.mark.parametrize("name", CORES)
def test_the_core_is_joined_as_it_was_built(opened, name):
    core = opened(packed(COMMITTED.joinpath(name).read_bytes()), JOIN)
    known = json.loads(COMMITTED.joinpath("core.json").read_text())[name]
    assert hashlib.sha256(base64.b64decode(core)).hexdigest() == known


def test_what_is_torn_anywhere_is_refused_or_not_needed(opened):
    pieces = KINDS["a script"], b"and the rest"
    whole = packed(*map(compressed, pieces))
    for cut in (0, 0.002, 0.02, 0.3, 0.7, 0.99):
        assert "incomplete or damaged" in opened(whole[: int(cut * len(whole))]), cut
    harmless = 0
    for place in [*range(14), *CHANCE.integers(14, len(whole), 60).tolist()]:
        other = chr(ord(whole[place]) % 126 + 1)
        if other not in "\r<":
            found = opened(whole[:place] + other + whole[place + 1 :])
            if "incomplete or damaged" not in found:
                harmless += 1
                assert tuple(map(base64.b64decode, found)) == pieces, place
    assert harmless < 3, "only the marks of an end are not needed"


def test_a_page_with_a_torn_part_says_so_beside_its_picture(shown):
    class Torn:
        def save(self, path):
            before, after = live_page().html.split('id="packed">')
            path.write_bytes(f'{before}id="packed">{after[:5000]}{after[6000:]}'.encode())
            return path

    page = shown(Torn(), script="window.torn = true")
    page.wait_for_selector("html[data-failed]")
    assert page.locator("#reason").inner_text().startswith("This page is incomplete or damaged. ")
    assert page.locator("#missing svg").is_visible() and page.locator("main").count() == 0
