"""A page of HTML taken apart, and what it must keep to need nothing beside it."""

from html.parser import HTMLParser
from itertools import pairwise

_LOADED = ("src", "srcset", "poster", "data", "background")
_INSIDE = {"span", "wbr"}  # what is on both sides is one word
_VOID = {"meta", "link", "img", "source", "br", "hr", "wbr"}


class PageParts(HTMLParser):
    """`tags`: names and attributes in their order; `words`: the text between them."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.words, self._open = [], [], []
        self._goes_on = False
        self.feed(text)
        self.close()
        assert not self._open, f"never closed: {self._open}"

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        self._goes_on = bool(self.words) and tag in _INSIDE
        if tag not in _VOID:
            self._open.append(tag)

    def handle_endtag(self, tag):
        assert self._open.pop() == tag
        self._goes_on = bool(self.words) and tag in _INSIDE

    def handle_data(self, data):
        if not self._open or self._open[-1] == "style":
            return
        if self._goes_on:
            self.words[-1] += data
        else:
            self.words.append(data)
        self._goes_on = False

    def of(self, tag):
        """Attributes of all tags of this name."""
        return [attrs for name, attrs in self.tags if name == tag]

    @property
    def text(self):
        """All words, blanks as one."""
        return " ".join(" ".join(self.words).split())


def checked_page(text):
    """The parts of a page that loads nothing, runs nothing, and has pictures in words."""
    page = PageParts(text)
    names = {name for name, _ in page.tags}
    assert not names & {"script", "iframe", "object", "embed", "base", "form"}
    for name, attrs in page.tags:
        assert not any(key.startswith("on") for key in attrs), (name, attrs)
        for key in _LOADED:
            assert attrs.get(key, "data:").startswith("data:"), (name, key)
        if name == "link":
            assert attrs["href"] == "data:,"
    style = text.partition("<style>")[2].partition("</style>")[0]
    assert "url(" not in style
    assert "@import" not in style
    assert page.of("html") == [{"lang": "en"}]
    images = page.of("img")
    assert all(len(image["alt"]) > 60 for image in images)
    assert len(page.of("source")) == len(images)  # each for dark pages too
    _require_headings(page)
    labels = [attrs["aria-label"] for _, attrs in page.tags if "aria-label" in attrs]
    assert len(set(labels)) == len(labels)
    anchors = {attrs["id"] for _, attrs in page.tags if "id" in attrs}
    links = [attrs["href"] for attrs in page.of("a")]
    assert {link[1:] for link in links if link.startswith("#")} <= anchors
    return page


def _require_headings(page):
    """One first heading, and none deeper than one below the last."""
    levels = [int(name[1]) for name, _ in page.tags if name in {"h1", "h2", "h3", "h4"}]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(b - a <= 1 for a, b in pairwise(levels))


def cells_of_table(table):
    """All texts of a result's table."""
    return [cell for row in (table.header, *table.rows) for cell in row if cell]
