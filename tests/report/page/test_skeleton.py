"""The skeleton of a page: head, contents, sections, all escaped."""

from html_pages import checked_page

from frictionjax.report.page import Page, Section, page_text, paragraph

HOSTILE = '<img src=http://a.example onerror="x()">'


def page_of(*titles):
    sections = [Section(title, [paragraph(f"of {title}")]) for title in titles]
    return page_text(Page("A title", "about", "verdict", [], sections, "made by"))


def test_every_section_is_in_the_contents_and_can_be_reached():
    page = checked_page(page_of("First things", "Second"))
    links = [link["href"] for link in page.of("a")]
    assert links == ["#main", "#first-things", "#second"]
    assert len(page.of("main")) == len(page.of("nav")) == len(page.of("footer")) == 1
    assert [one["aria-labelledby"] for one in page.of("section")] == [
        *("what-came-out", "first-things", "second")
    ]


def test_whatever_is_told_is_text():
    told = Page(HOSTILE, HOSTILE, HOSTILE, [], [Section(HOSTILE, [])], HOSTILE)
    page = checked_page(page_text(told))
    assert not page.of("img")
    assert page.text.count(HOSTILE) == 7  # title twice, about, verdict, contents, heading


def test_nothing_may_be_loaded_or_run():
    page = checked_page(page_of("One"))
    policy = next(m["content"] for m in page.of("meta") if "http-equiv" in m)
    assert "default-src 'none'" in policy
    assert "script" not in policy
    sizes = next(m["content"] for m in page.of("meta") if m.get("name") == "viewport")
    assert "width=device-width" in sizes
