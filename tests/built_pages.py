"""The built pages in a browser: they ask for nothing from the network, and every formula is set; run by `make docs`.

python tests/built_pages.py FOLDER
"""

import sys
from pathlib import Path

import browser

LOCAL = ("file:", "data:", "blob:", "about:")
SET = "async () => { await window.MathJax?.startup?.promise }"
WIDE = "all => all.filter(e => e.scrollWidth > e.clientWidth + 1).map(e => e.textContent.slice(0, 60))"


def look(page, path):
    """What is wrong with a page, and how many formulas it has."""
    wrong = []
    page.set_default_timeout(120_000)  # bodies spin on some of them
    page.on("console", lambda m: m.type == "error" and wrong.append(m.text))
    page.on("pageerror", lambda e: wrong.append(str(e)))
    page.on("request", lambda r: r.url.startswith(LOCAL) or wrong.append(f"asks for {r.url}"))
    page.on("requestfailed", lambda r: wrong.append(f"{r.url} is missing"))
    page.goto(path.resolve().as_uri())
    asked = page.locator(".math").count()
    page.evaluate(SET)
    wrong.extend(page.locator("[data-mjx-error]").evaluate_all("all => all.map(e => e.dataset.mjxError)"))
    wrong.extend(f"wider than the page: {text}" for text in page.locator("div.math").evaluate_all(WIDE))
    done = page.locator("mjx-container").count()
    if done != asked:
        wrong.append(f"{done} of {asked} formulas are set")
    return wrong, done


def main():
    from playwright.sync_api import sync_playwright

    if browser.find() is None and not browser.checking():
        print(f"not opened: the built pages: {browser.MISSING}")
        return 0
    found, formulas = [], 0
    with sync_playwright() as driver:
        chromium = driver.chromium.launch(executable_path=browser.executable(), args=browser.FLAGS)
        for path in sorted(Path(sys.argv[1]).glob("*.html")):
            page = chromium.new_page()
            wrong, done = look(page, path)
            page.close()
            found.extend(f"{path.name}: {what}" for what in wrong)
            formulas += done
        chromium.close()
    if not formulas:
        found.append("no page has a formula")
    if found:
        print(*found, sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    raise SystemExit(main())
