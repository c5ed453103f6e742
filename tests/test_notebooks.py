"""The notebooks made from pages and scenes: complete, readable without Sphinx, and running."""

import ast
import json
import math
import re
import warnings
from urllib.parse import parse_qsl

import blocks
import gallery
import nbformat
import notebooks
import numpy as np
import pytest
from addresses import called
from cells import apart, quiet

import spincyl as sc

BUILT = "../built"
MADE = {made.name: json.loads(made.json()) for made in notebooks.all_made(BUILT)}
EVERY = pytest.mark.parametrize("name", MADE)
#: every address in the pages: of a figure, and of a link that sets it
LIVE = [
    blocks.live(block).address
    for name in notebooks.pages()
    for block in blocks.of_kind(notebooks.page(name), "{live}")
]
LINKED = re.findall(r"\]\(live:([^)]+)\)", "".join(map(notebooks.page, notebooks.pages())))


def cells(name, kind):
    return [cell for cell in MADE[name]["cells"] if cell["cell_type"] == kind]


def source(cell):
    return "".join(cell["source"])


def prose(name):
    """The text of a notebook without the blocks in it, and the kinds of those blocks."""
    text = "\n\n".join(map(source, cells(name, "markdown")))
    return blocks.prose(text), [block.kind for block in blocks.blocks(text) if block.kind]


def test_every_story_and_every_scene_has_a_notebook():
    assert set(gallery.SCENES) < set(MADE) and len(gallery.SCENES) + len(notebooks.pages()) == len(MADE)
    stories = "mystery standing stability slip disks whirr stops hurricane integrators stones"
    assert {*stories.split(), "tour", "lab"} <= set(notebooks.pages())
    assert not {"index", "api", "physics", "figures"} & set(notebooks.pages())


@EVERY
def test_a_notebook_is_valid(name):
    made = nbformat.reads(json.dumps(MADE[name]), 4)
    nbformat.validate(made)
    assert (made.nbformat, made.nbformat_minor) == (4, 5)
    assert [cell["id"] for cell in made.cells] == [f"{name}-{n}" for n in range(1, len(made.cells) + 1)]


def test_notebooks_are_made_the_same_again_and_are_files_by_their_names(tmp_path):
    files = notebooks.written(tmp_path / "made", BUILT)
    assert {path.stem: json.loads(path.read_text("utf-8")) for path in files} == MADE


@EVERY
def test_the_code_of_a_notebook_compiles_and_is_that_of_its_page(name):
    codes = [source(cell) for cell in cells(name, "code")]
    for code in codes:
        compile(code, name, "exec")
    if name in notebooks.pages():
        runs = [part for part in blocks.blocks(notebooks.page(name)) if part.kind in blocks.RUNS]
        assert len(codes) == 1 + len(runs)
        for code, run in zip(codes[1:], runs, strict=True):
            assert run.kind != "python" or code == run.text.strip()
            lines = [line.strip().removesuffix(";") for line in code.splitlines()]
            assert run.kind != "{plot}" or {*map(str.strip, run.text.splitlines())} <= {*lines}


@EVERY
def test_the_text_of_a_notebook_has_nothing_that_only_sphinx_reads(name):
    text, kinds = prose(name)
    assert not [kind for kind in kinds if "{" in kind or kind == "math"]
    assert not re.findall(r"^:::|\{[\w:+-]+\}`|\]\(live:|\.md[)#]|^\(.*\)=$|<iframe", text, re.M)
    assert "pip install '.[all]'" in source(MADE[name]["cells"][0])


@EVERY
def test_every_link_of_a_notebook_leads_somewhere(name):
    for cell in cells(name, "markdown"):
        for _, _, target in notebooks.LINK.findall(blocks.prose(source(cell))):
            file, _, anchor = target.partition("#")
            if file.startswith("attachment:"):
                assert file.removeprefix("attachment:") in cell["attachments"]
            elif file.startswith(f"{BUILT}/_static/"):
                assert file.endswith(("friction.html", "play.html", "tube.html")), "conf.py makes these pages"
            elif file.startswith(BUILT):
                page = file.removeprefix(BUILT + "/").removesuffix(".html")
                assert (blocks.DOCS / f"{page}.md").exists()
            elif not file.startswith("http"):
                there = file.removesuffix(".ipynb") or name
                heads = re.findall(r"^#+ (.+)$", prose(there)[0], re.M)
                assert not anchor or anchor in [head.replace(" ", "-") for head in heads]


def shown(code):
    """The value of the last line of a cell."""
    names, tree = {"sc": sc, "np": np}, ast.parse(code)
    exec(compile(ast.Module(tree.body[:-1], []), "cell", "exec"), names)
    return eval(compile(ast.Expression(tree.body[-1].value), "cell", "eval"), names)


@pytest.mark.parametrize("address", dict.fromkeys(LIVE + LINKED))
def test_the_call_of_a_live_figure_shows_what_its_address_tells(address):
    words = {name: [*map(float, x.split(","))] if "," in x else x for name, x in parse_qsl(address)}
    if "stone" in words:
        view = shown(called(address))
        (motion,) = view.motions
        assert motion.spin[0] / view.scale.seconds(1.0) == pytest.approx(float(words["spin"]), rel=1e-3)
        metres = view.scale.metres(np.asarray(motion.body.semi_axes))
        np.testing.assert_allclose(metres, words["stone"], rtol=1e-6)
        return
    told = shown(called(address))._told
    for name, word in words.items():
        if name == "expose":  # concerns the view only, which the user sets
            continue
        wanted = word if isinstance(word, list) else [word]
        found = told[name] if isinstance(word, list) else [told[name]]
        for x, y in zip(found, wanted, strict=True):
            assert x == y or math.isclose(x, float(y), rel_tol=1e-5), (name, told[name], word)


def test_all_that_links_set_stands_below_a_figure():
    assert len(LIVE) >= 14 and len(set(LINKED)) >= 30
    code = "\n".join(source(cell) for name in notebooks.pages() for cell in cells(name, "code"))
    code = re.sub("^# ", "", code, flags=re.M)
    assert not [address for address in LINKED if called(address) not in code]


def test_an_address_with_a_word_that_no_call_tells_is_refused():
    with pytest.raises(ValueError, match="precession=1"):
        called("ell=1&theta=1.5&precession=1")


def test_a_figure_that_would_change_what_the_text_reads_later_is_a_function():
    before, after = ["a, b = 1, 2\ndef f():\n    return c\n", "c = 3"], ["print(a)", "b = 4\nprint(b)"]
    for code, inside in (("a = 5", True), ("b = 5", False), ("c = 5", True), ("import a as d; e = 1", False)):
        assert ("def figure():" in apart(code, before, after)) is inside, code
    assert quiet("x = 1\nprint(x)\n") == "x = 1\nprint(x);" and quiet("x = 1\n") == "x = 1"


def test_a_fence_without_an_end_is_refused():
    with pytest.raises(ValueError, match="without an end"):
        blocks.blocks("Text.\n\n```python\nx = 1\n")


@pytest.mark.long
@EVERY
def test_a_notebook_runs_from_top_to_bottom_and_prints_what_the_page_says(name, tmp_path):
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    made = nbformat.reads(json.dumps(MADE[name]), 4)
    ran = [cell for cell in made.cells if cell["cell_type"] == "code"]
    said = [printed(cell) for cell in ran]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # from Jupyter, about event loops
        nbclient.NotebookClient(made, timeout=600, resources={"metadata": {"path": tmp_path}}).execute()
    assert [printed(cell) for cell in ran] == said
    for cell, kind in zip(ran, kinds(name), strict=True):
        shows = [what for x in cell["outputs"] for what in x.get("data", ())]
        if kind == "{live}":
            # a stone has a page of its own and no widget
            page = "text/html" if "sc.view(" in cell["source"] else "application/vnd.jupyter.widget-view+json"
            assert page in shows, cell["source"]
        if kind == "{plot}":
            assert "image/png" in shows, cell["source"]


def printed(cell):
    """The output of a cell, joined from its pieces."""
    return "".join(x["text"] for x in cell["outputs"] if x["output_type"] == "stream")


def kinds(name):
    """The kind of each code cell."""
    if name in notebooks.pages():
        found = [part.kind for part in blocks.blocks(notebooks.page(name))]
        return ["", *(kind for kind in found if kind in blocks.RUNS)]
    return ["", "python", "{plot}", "python"]
