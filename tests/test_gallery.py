"""The gallery: scenes print and draw what the page shows; the README fits three screens."""

import io
import pathlib
import re
import runpy

import blocks
import gallery
import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image

ROOT = pathlib.Path(__file__).parents[1]
PAGE = (ROOT / "docs/gallery.md").read_text("utf-8")
SHOWN = {pathlib.Path(scene.path).stem: scene for scene in blocks.scenes(PAGE)}
README = (ROOT / "README.md").read_text("utf-8")
LINK = re.compile(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)")


def coarse(picture):
    """A picture as 48 x 24 cells of grey, 0 to 255."""
    with Image.open(picture) as opened:
        return np.asarray(opened.convert("L").resize((48, 24), Image.Resampling.BOX), dtype=float)


def test_the_gallery_shows_twenty_one_scenes_in_their_order():
    assert tuple(SHOWN) == gallery.SCENES
    assert tuple(re.findall(r"^- \[!\[.*\]\(figures/gallery/(\w+)\.png\)\]", PAGE, re.M)) == gallery.SCENES
    assert len(gallery.SCENES) == 21


@pytest.mark.parametrize("scene", gallery.SCENES)
def test_a_scene_of_the_gallery_prints_what_the_page_says(scene, capsys):
    runpy.run_path(str(ROOT / f"examples/{scene}.py"), run_name="__main__")
    assert capsys.readouterr().out == SHOWN[scene].said


@pytest.mark.parametrize("scene", gallery.SCENES)
def test_a_scene_of_the_gallery_draws_the_picture_that_the_page_shows(scene):
    drawn = io.BytesIO()
    gallery.draw(scene).savefig(drawn, dpi=120)
    plt.close("all")
    kept = ROOT / f"docs/figures/gallery/{scene}.png"
    # Another matplotlib may place letters a pixel off. For comparison: 1.1 times the friction changes the
    # hoop's picture by 4.6, 1.5 times the kick that of the balls by 2.9.
    off = np.abs(coarse(drawn) - coarse(kept)).mean()
    assert off < 2, f"python examples/gallery.py draws it anew: {off:.2f} of 255 off"


def test_the_pictures_of_two_scenes_are_told_apart():
    first, second = (coarse(ROOT / f"docs/figures/gallery/{name}.png") for name in gallery.SCENES[2:4])
    assert np.abs(first - second).mean() > 4


def test_the_readme_fits_three_screens_and_gives_the_commands_that_there_are():
    assert len(README.splitlines()) <= 130
    makefile = (ROOT / "Makefile").read_text("utf-8")
    for command in re.findall(r"^make (\w+)", README, re.M):
        assert re.search(rf"^{command}:", makefile, re.M), command
    assert re.search(r"^make test$", (ROOT / ".ci/run").read_text("utf-8"), re.M), (
        "CI runs what the README says"
    )


@pytest.mark.parametrize(
    "page", [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))], ids=lambda p: p.name
)
def test_what_a_page_links_to_is_there(page):
    prose = blocks.prose(page.read_text("utf-8"))
    assert not [link for link in LINK.findall(prose) if not (page.parent / link).exists()]


def test_the_first_page_leads_to_every_other_one():
    text = (ROOT / "docs/index.md").read_text("utf-8")
    trees = "\n".join(block.text for block in blocks.of_kind(text, "{toctree}"))
    listed = [line for line in trees.splitlines() if re.fullmatch(r"[a-z-]+", line)]
    pages = {page.stem for page in (ROOT / "docs").glob("*.md")} - {"index"}
    assert pages <= set(listed) and len(listed) == len(set(listed))
    prose = blocks.prose(text)
    assert not [page for page in pages if f"]({page}.md" not in prose], "it is found without the margin, too"
