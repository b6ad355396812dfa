"""Pages in a browser of the system: what it shows, asks for and complains of."""

import shutil
from contextlib import contextmanager
from importlib.resources import files
from typing import NamedTuple

import pytest

_ARGUMENTS = [
    *("--no-sandbox", "--disable-gpu", "--disable-background-networking"),
    *("--disable-component-update", "--disable-sync", "--no-first-run"),
]
RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"]
_SHOWN = """Promise.all([...document.images].map(async image => {
    try { await image.decode(); } catch (error) { return false; }
    const place = image.getBoundingClientRect();
    return image.naturalWidth > 0 && place.width > 100 && place.height > 50;
}))"""
_WIDER = "document.documentElement.scrollWidth - document.documentElement.clientWidth"


class Seen(NamedTuple):
    """Of a page: `images`: whether each is shown; `sources`: starts of what they show;
    `wider`: pixels by which it is wider than its window; what it asked for and said;
    `violations`: of WCAG 2 A and AA, as axe-core finds them; `checks`: rules it kept."""

    images: list
    sources: list
    wider: int
    requests: list
    messages: list
    violations: list
    checks: int


def skip_without_browser():
    """Skip where Chromium, its driver or axe-core is not there: the extra `browser`."""
    pytest.importorskip("playwright.sync_api")
    pytest.importorskip("axe_playwright_python")
    if shutil.which("chromium") is None:
        pytest.skip("no chromium")


@contextmanager
def opened_browser():
    """The system's Chromium, with a fresh profile."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        path = shutil.which("chromium")
        browser = driver.chromium.launch(executable_path=path, args=_ARGUMENTS)
        yield browser
        browser.close()


def look_at(browser, path, colours="light", width=1100, medium="screen"):
    """What a browser sees of a page in a file."""
    size = {"width": width, "height": 800}
    context = browser.new_context(color_scheme=colours, viewport=size)
    page = context.new_page()
    requests, messages = [], []
    page.on("request", lambda request: requests.append(request.url))
    page.on("console", lambda message: messages.append(message.text))
    page.on("pageerror", lambda error: messages.append(str(error)))
    page.emulate_media(media=medium, color_scheme=colours)
    page.goto(path.absolute().as_uri())
    images = page.evaluate(_SHOWN)
    sources = page.evaluate("[...document.images].map(image => image.currentSrc)")
    wider = page.evaluate(_WIDER)
    page.evaluate(files("axe_playwright_python").joinpath("axe.min.js").read_text())
    found = page.evaluate("rules => axe.run({runOnly: rules})", RULES)
    context.close()
    told = [
        (one["id"], [node["html"][:90] for node in one["nodes"]])
        for one in found["violations"]
    ]
    return Seen(images, sources, wider, requests, messages, told, len(found["passes"]))
