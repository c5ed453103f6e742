"""The built pages in a browser: no requests to the network, every formula set, links that set figures.

Run by `make docs`.

python tests/built_pages.py FOLDER
"""

import sys
from pathlib import Path

import browser

LOCAL = ("file:", "data:", "blob:", "about:")
SMOOTH = "getComputedStyle(document.documentElement).scrollBehavior !== 'auto'"
SET = "async () => { await window.MathJax?.startup?.promise }"
WIDE = "all => all.filter(e => e.scrollWidth > e.clientWidth + 1).map(e => e.textContent.slice(0, 60))"


def listened(page):
    """The page, which collects its errors from now on in `wrong`."""
    page.wrong = []
    page.on("console", lambda m: m.type == "error" and page.wrong.append(m.text))
    page.on("pageerror", lambda e: page.wrong.append(str(e)))
    page.on("request", lambda r: r.url.startswith(LOCAL) or page.wrong.append(f"asks for {r.url}"))
    page.on("requestfailed", lambda r: page.wrong.append(f"{r.url} is missing"))
    return page


def look(page, path):
    """Errors of a page that is opened with reduced motion, and its number of formulas."""
    wrong = page.wrong = []
    page.goto(path.absolute().as_uri())
    # smooth scrolling would continue while a link is clicked, past its target
    if page.evaluate(SMOOTH):
        wrong.append("scrolls smoothly where motion is unwanted")
    for name in page.locator("a[download]").evaluate_all("all => all.map(e => e.getAttribute('href'))"):
        if not (path.parent / name).exists():
            wrong.append(f"{name} is missing")
    asked = page.locator(".math").count()
    page.evaluate(SET)
    wrong.extend(page.locator("[data-mjx-error]").evaluate_all("all => all.map(e => e.dataset.mjxError)"))
    wrong.extend(f"wider than the page: {text}" for text in page.locator("div.math").evaluate_all(WIDE))
    done = page.locator("mjx-container").count()
    if done != asked:
        wrong.append(f"{done} of {asked} formulas are set")
    return wrong, done


# words of a link that the page in a figure does not show; t is only the time at which it opens
SHOWN = """words => [...new URLSearchParams(words)].filter(([name, text]) => {
  if (name === "expose") return document.getElementById("shutter").value !== text;
  const value = window.spincyl.state()[name];
  const one = (x, y) => typeof x === "number" ? Math.abs(x - y) < 1e-6 : x === y;
  return name !== "t" && !(Array.isArray(value) ? value.every((x, i) => one(x, text.split(",")[i])) : one(value, text));
}).map(pair => pair.join("="))"""
ALIVE = "i => document.querySelectorAll('figure.live')[i].classList.contains('alive')"
NO_CORE = "delete window.WebAssembly;"


def set_by(page, words):
    """The words of a link that no figure in view shows in time; [] if a figure shows all."""
    for _ in range(int(page.patience / 500)):
        page.wait_for_timeout(200)
        left = []
        for frame in page.locator("figure.live iframe").all():
            box, high = frame.bounding_box(), page.viewport_size["height"]
            if box["y"] + box["height"] < 0 or box["y"] > high:
                continue
            inner = frame.element_handle().content_frame()
            left.append([f"does not set {x}" for x in inner.evaluate(SHOWN, words)])
            odd = inner.evaluate("document.getElementById('details').textContent")
            if not left[-1] and "not\u00a0understood" in odd:
                left[-1].append(f"says what makes no sense: {odd}")
        if [] in left:
            return []
    places = page.locator("figure.live").evaluate_all("all => all.map(e => e.getBoundingClientRect().y | 0)")
    return left[0] if left else [f"leads to no figure: seen from here they are at {places}"]


def figures(page):
    """Errors of the interactive figures: each must replace its picture, and show what its links set."""
    wrong, links = [], page.locator("a.live")
    figures = page.locator("figure.live")
    for i in range(figures.count()):
        figures.nth(i).scroll_into_view_if_needed()
        high = figures.nth(i).bounding_box()["height"]
        page.wait_for_function(ALIVE, arg=i)
        grown = figures.nth(i).bounding_box()["height"] - high
        if grown:
            wrong.append(f"figure {i} grows by {grown} pixels when it comes to life")
    if links.count() and page.locator("section:has(a.live):not(:has(figure.live))").count():
        wrong.append("a link sets a figure that its section does not have")
    return wrong + linked(page)


def linked(page):
    """Errors of the links that set figures, clicked in turn as soon as the page is loaded."""
    wrong, here = [], page.url
    for link in page.locator("a.live").all():
        words, said = link.get_attribute("href").split("#")[1], f"the link {link.inner_text()!r}"
        link.click()
        wrong.extend(f"{said} {why}" for why in set_by(page, words))
        if page.url != here:
            return [*wrong, f"{said} leaves the page"]
    return wrong


def at_once(page, path):
    """Errors of the links on a phone, before any figure is loaded."""
    page.goto(path.absolute().as_uri())
    return [f"on a phone {what}" for what in linked(page)]


def pictures(page, path):
    """Errors where WebAssembly is not allowed: there every figure must stay a picture."""
    page.goto(path.absolute().as_uri())
    for figure in page.locator("figure.live").all():
        figure.scroll_into_view_if_needed()
        page.wait_for_timeout(200)
    seen = page.locator("figure.live img:visible").count(), page.locator("figure.live").count()
    framed = page.locator("figure.live iframe").count()
    return (
        [f"{seen[0]} pictures and {framed} frames for {seen[1]} figures"]
        if seen[0] != seen[1] or framed
        else []
    )


def main():
    from playwright.sync_api import sync_playwright

    if browser.find() is None and not browser.checking():
        print(f"not opened: the built pages: {browser.MISSING}")
        return 0
    found, formulas, live = [], 0, 0
    with sync_playwright() as driver:
        chromium, patience = browser.started(driver.chromium)
        # three windows for all pages, since opening a window takes longer than loading most pages
        page = listened(chromium.new_page(reduced_motion="reduce"))
        phone = chromium.new_page(reduced_motion="reduce", viewport={"width": 390, "height": 844})
        without = chromium.new_page()
        without.add_init_script(NO_CORE)
        for one in (page, phone, without):
            one.set_default_timeout(patience)
            one.patience = patience
        for path in sorted([*Path(sys.argv[1]).glob("*.html"), *Path(sys.argv[1]).glob("note/*.html")]):
            wrong, done = look(page, path)
            live += (here := page.locator("figure.live").count())
            wrong += figures(page)
            page.goto("about:blank")
            wrong += pictures(without, path) + at_once(phone, path) if here else []
            found.extend(f"{path.name}: {what}" for what in wrong)
            formulas += done
        chromium.close()
    if not formulas:
        found.append("no page has a formula")
    if live < 2:
        found.append("no page has figures that compute")
    if found:
        print(*found, sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    raise SystemExit(main())
