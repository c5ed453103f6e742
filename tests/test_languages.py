"""The words of the live page: every language has every word, and the page speaks that of the browser."""

import json
import re
from collections import Counter
from importlib.resources import files

import pytest
from page_scenes import live_page
from playing import PHONE, settled, state
from test_play import unpacked

import spincyl as sc
from spincyl.studio.pages.joined import script, text
from spincyl.studio.pages.languages import LANGUAGES, language, words_of
from spincyl.studio.pages.play import _SCRIPTS
from spincyl.studio.pages.words import scenes

#: Words that are the same in another language.
SAME = {"film", "pause", "table", "stable", "Stable"}
FOLDER = files("spincyl.studio.pages").joinpath("languages")


def english():
    return words_of(text("play.body.html"), script(_SCRIPTS), [name for name, _ in scenes()])


def holders(word):
    return Counter(re.findall(r"\{\d+\}", word))


def test_each_language_is_one_file():
    assert {x.name for x in FOLDER.iterdir()} == {f"{code}.json" for code in LANGUAGES}
    names = [language(code)[0] for code in LANGUAGES]
    assert len({*names}) == len(names) == 7 and "Deutsch" in names


@pytest.mark.parametrize("code", LANGUAGES)
def test_every_language_has_every_word_with_the_same_holders(code):
    words, told = english(), language(code)[1]
    assert len(words) > 240
    assert [*told] == words, set(words) ^ set(told)
    for word, other in told.items():
        assert holders(word) == holders(other), (word, other)
        assert word.count(" | ") == other.count(" | "), "the two lines on the map"
        assert other.strip() == other and other
        if re.search(r"[a-z]{4}", word) and other == word:
            assert word in SAME, word


@pytest.mark.parametrize("code", LANGUAGES)
def test_letters_of_quantities_and_numbers_stay(code):
    signs = re.compile(r"[θωμφℓΩψ∞]|M g R|√|1/\{0\}|Painlevé|Coulomb|WebGL 2|F/N")
    kept = {"Painlevé", "Coulomb"}  # names that some languages write in their own letters
    for word, other in language(code)[1].items():
        assert Counter(x for x in signs.findall(word) if x not in kept) == Counter(
            x for x in signs.findall(other) if x not in kept
        ), (word, other)


def test_no_text_of_the_scripts_is_written_beside_the_table():
    # sentences outside of W and N, in the scripts of the live page
    for name in _SCRIPTS:
        if not name.startswith("play."):
            continue
        code = re.sub(r"//.*", "", text(name))
        code = re.sub(r'\b[WN]\("(?:[^"\\]|\\.)*"', "", code)
        found = re.findall(r'["`]((?:[A-Z]?[a-z]+[ ,.]+){2,}[a-z]+)', code)
        assert not [x for x in found if not x.startswith(("system ui", "bold"))], (name, found)


def test_the_page_has_numbers_in_place_of_its_words_and_one_table():
    shown, code = unpacked(live_page())[1:3]
    table = json.loads(shown.split('id="words">')[1].split("</script>")[0])
    assert [*table] == ["en", *LANGUAGES]
    assert {len(words) for _, words in table.values()} == {len(english())}
    assert not re.search(r'\b[WN]\("', code) and re.search(r"\bW\(\d+", code)
    assert "the least push grows" not in code


@pytest.mark.parametrize(
    ("locale", "spoken"), [("de-CH", "de"), ("pt-BR", "pt"), ("zh-TW", "zh"), ("ja", "ja"), ("nl-NL", "en")]
)
def test_the_page_speaks_the_language_of_the_browser_or_else_english(opened, locale, spoken):
    page = opened("#ell=2.5&theta=1.3", locale=locale)
    assert page.evaluate("document.documentElement.lang") == spoken
    told = {"en": lambda word: word}.get(spoken) or (lambda word: language(spoken)[1][word])
    assert page.locator("#what").inner_text() == told("Stable")
    assert page.locator("#reset").inner_text() == told("reset")
    assert page.locator("#reset").get_attribute("title") == told("everything as it was when the page opened")
    assert page.locator("label:has(#knob-theta) span").inner_text() == told("inclination θ")
    assert page.locator("#knob-contact option").first.inner_text() == told("rubber: it rolls")
    assert page.complaints == []


def test_a_language_is_chosen_by_hand_or_by_the_address_which_keeps_it(opened):
    page = opened("#ell=2.5&theta=0.9")
    before = state(page)
    for code in ("fr", "es", "en", "it"):
        page.select_option("#language", code)
        settled(page)
        told = (lambda word: word) if code == "en" else (lambda word: language(code)[1][word])  # noqa: B023
        assert page.locator("#what").inner_text() == told("Forbidden: no rate holds it here")
        assert page.locator("#legend li").first.inner_text() == told("stable")
        assert page.locator("#preset option").nth(1).inner_text() == told(
            "the paper's tube: six still symbols"
        )
        assert page.evaluate("location.hash").startswith(f"#language={code}&")
    assert state(page) == before
    again = opened("#language=de&ell=2.5&theta=1.3", locale="fr-FR")
    assert again.evaluate("document.documentElement.lang") == "de"
    assert "nicht verstanden" not in again.locator("#details").inner_text()
    odd = opened("#language=xx&ell=2.5&theta=1.3", locale="fr-FR")
    assert odd.evaluate("document.documentElement.lang") == "fr"
    assert page.complaints == again.complaints == odd.complaints == []


def test_a_file_has_a_language_which_its_address_or_its_list_can_change(opened):
    german = sc.play(sc.Body.solid(2.5), 1.3, language="de")
    page = opened(page=german, locale="fr-FR")
    assert page.evaluate("document.documentElement.lang") == "de"
    assert page.locator("#what").inner_text() == language("de")[1]["Stable"]
    assert "language" not in state(page) and "language" not in page.evaluate("location.hash")
    page.select_option("#language", "it")
    settled(page)
    assert page.locator("#what").inner_text() == language("it")[1]["Stable"]
    for at, spoken in (("#language=es", "es"), ("#language=xx", "de"), ("#ell=2.5&theta=0.9", "de")):
        other = opened(at, page=german, locale="fr-FR")
        assert other.evaluate("document.documentElement.lang") == spoken, at
        assert other.complaints == []
    english = opened(page=sc.play(language="en"), locale="fr-FR")
    assert english.evaluate("document.documentElement.lang") == "en"
    assert page.complaints == english.complaints == []


@pytest.mark.parametrize("code", LANGUAGES)
def test_nothing_sticks_out_in_any_language_and_no_scene_complains(opened, code):
    page = opened(f"#language={code}&ell=2.5&theta=1.3")
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    cut = page.locator("#knobs > label, header button, #bar button").evaluate_all(
        "all => all.filter(e => e.scrollWidth > e.clientWidth + 1 && e.clientWidth).map(e => e.textContent)"
    )
    assert cut == []
    for scene in ("the tube, flicked too hard: it hops", "a rattleback turns back", "a can rocks"):
        page.select_option("#preset", scene)
        settled(page)
        told = page.locator("#tell").inner_text() + page.locator(".clock").inner_text()
        assert "{" not in told and "undefined" not in told and "NaN" not in told
    page.set_viewport_size(PHONE)
    settled(page)
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert page.complaints == []
