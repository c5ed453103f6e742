"""The browser of the tests: it is installed where there is none, or skipped tests are reported."""

import os
import pathlib
import subprocess
import sys

import browser
import pytest

OWN = browser.OWN


@pytest.fixture
def bare(monkeypatch, tmp_path):
    """An empty search path, without the browser of playwright (looking for that takes seconds)."""
    for name in ("CI", "SPINCYL_BROWSER"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("PLAYWRIGHT_BROWSERS_PATH", str(tmp_path / "own"))
    monkeypatch.setattr(browser, "OWN", "")
    browser.find.cache_clear()
    yield tmp_path
    browser.find.cache_clear()


def program(path, code=0):
    path.parent.mkdir(exist_ok=True, parents=True)
    path.write_text(f"#!/bin/sh\nexit {code}\n")
    path.chmod(0o755)
    return str(path)


def test_a_browser_is_one_that_starts(bare, monkeypatch):
    assert browser.find() is None
    program(bare / "chromium", code=1)  # like a placeholder of a package that is not installed
    browser.find.cache_clear()
    assert browser.find() is None
    there = program(bare / "google-chrome")
    browser.find.cache_clear()
    assert browser.find() == there
    monkeypatch.setenv("SPINCYL_BROWSER", str(bare / "chromium"))
    browser.find.cache_clear()
    with pytest.raises(AssertionError, match="SPINCYL_BROWSER = .*does not start"):
        browser.find()


def test_playwrights_own_browser_is_found_where_there_is_no_other(bare, monkeypatch):
    monkeypatch.setattr(browser, "OWN", OWN)
    own = subprocess.run([sys.executable, "-c", OWN], capture_output=True, text=True).stdout.strip()
    assert own.startswith(str(bare / "own"))
    program(pathlib.Path(own))
    assert browser.find() == own


@pytest.mark.parametrize("apt", [True, False])
@pytest.mark.parametrize("root", [True, False])
def test_a_browser_comes_by_apt_where_it_may_install_else_from_playwright(bare, monkeypatch, apt, root):
    asked = []

    def run(*words, **_):
        asked.append(words)
        if words[:2] == ("apt-get", "install"):
            program(bare / "chromium")
            browser.find.cache_clear()

    monkeypatch.setattr(browser, "run", run)
    monkeypatch.setattr(os, "geteuid", lambda: 0 if root else 1000)
    if apt:
        program(bare / "apt-get")
    browser.fetch()
    if apt and root:
        assert [words[:2] for words in asked] == [("apt-get", "update"), ("apt-get", "install")]
    else:
        assert [words[1:] for words in asked] == [("-m", "playwright", "install", "chromium")]


@pytest.mark.parametrize(
    ("ci", "checks"), [("", False), ("0", False), ("false", False), ("true", True), ("1", True)]
)
def test_what_ci_says(monkeypatch, ci, checks):
    monkeypatch.setenv("CI", ci)
    assert browser.checking() is checks
    monkeypatch.delenv("CI")
    assert not browser.checking()


PAGE = "def test_a_page(chromium): pass"


@pytest.mark.parametrize("fails", [False, True])
def test_without_a_browser_the_tests_of_pages_are_left_out_and_where_ci_is_set_they_fail(bare, fails):
    here, test = os.path.dirname(__file__), bare / "test_some_page.py"
    test.write_text(PAGE)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([here, *filter(None, sys.path)])}
    environment |= {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"} | ({"CI": "true"} if fails else {})
    words = [
        sys.executable,
        "-m",
        "pytest",
        "-p",
        "no:cacheprovider",
        "-p",
        "conftest",
        f"--rootdir={bare}",
        test,
    ]
    ran = subprocess.run(words, env=environment, cwd=bare, capture_output=True, text=True)
    assert ran.returncode == fails, ran.stdout + ran.stderr
    left_out = f"not run: 1 tests of test_some_page.py: {browser.MISSING}"
    assert (browser.MISSING if fails else left_out) in ran.stdout
