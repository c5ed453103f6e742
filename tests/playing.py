"""What the tests of the live page share: ways to ask it; `opened` of conftest.py opens one."""

LAPTOP, PHONE = {"width": 1280, "height": 800}, {"width": 390, "height": 844}
#: A browser whose pictures come when the test says so, with the times that it says.
DRIVEN = """
const waiting = [];
window.requestAnimationFrame = f => waiting.push(f);
window.picture = at => { for (const f of waiting.splice(0)) f(at); };
"""


def state(page):
    return page.evaluate("window.spincyl.state()")


def ask(page, what):
    return page.evaluate(f"window.spincyl.{what}")


def details(page):
    """The numbers beside the sentence, with plain spaces."""
    return page.locator("#details").inner_text().replace("\u00a0", " ")


def address(page, at):
    """Opens another address in the same page."""
    page.evaluate("at => { location.hash = at; }", at)
    settled(page)


def settled(page):
    """After the picture that follows a change."""
    page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
