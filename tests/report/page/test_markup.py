"""Blocks of a page: whatever comes in is text."""

import base64

from html_pages import PageParts

from frictionjax._text import ResultTable
from frictionjax.report.page.markup import (
    anchor_of,
    definitions,
    inline,
    items,
    linked_files,
    paragraph,
    preformatted,
    table_region,
)

HOSTILE = "</p><script>alert(1)</script>\"'&`<b>`"


def test_texts_are_escaped_everywhere():
    table = ResultTable((HOSTILE, "x"), ((HOSTILE, "1"),), note=HOSTILE)
    blocks = [
        paragraph(HOSTILE),
        items([HOSTILE]),
        definitions([(HOSTILE, HOSTILE)]),
        preformatted(HOSTILE),
        linked_files([(HOSTILE, HOSTILE)]),
        table_region(table, HOSTILE),
    ]
    for block in blocks:
        page = PageParts(block)
        assert not page.of("script"), block
        assert not page.of("b"), block
        assert "alert(1)" in page.text


def test_no_line_ends_inside_of_an_arrow():
    assert inline("as eps -> 0: 1 -> 2") == "as eps\u00a0\u2192\u00a00: 1 -&gt; 2"


def test_no_line_ends_inside_of_a_number():
    assert inline("within 1.0e-06 eps") == 'within <span class="whole">1.0e-06</span> eps'
    assert inline("`1e+03` and e-1") == (
        '<code><span class="whole">1e+03</span></code> and e-1'
    )


def test_lines_of_commands_end_between_options_and_after_commas():
    assert preformatted("cost a--b --eps 1,2 --no-x") == (
        '<pre>cost a--b <span class="whole">--eps</span> 1,<wbr>2 '
        '<span class="whole">--no-x</span></pre>'
    )
    assert preformatted("f(a, b)") == "<pre>f(a, b)</pre>"


def test_code_and_powers_are_shown():
    assert inline("`a<b` is eps^1.000, eps^gamma.") == (
        "<code>a&lt;b</code> is eps<sup>1.000</sup>, eps<sup>gamma</sup>."
    )


def test_a_table_can_be_reached_and_moved_by_keys_and_taken_along():
    table = ResultTable(("x", "y/m"), (("1", "2.5"), ("3", "4,5")))
    page = PageParts(table_region(table, "Numbers"))
    (region,) = page.of("div")
    assert region["role"], region["tabindex"] == ("region", "0")
    assert region["aria-label"] == "Table: Numbers"
    assert len(page.of("th")) == 2
    assert all(head["scope"] == "col" for head in page.of("th"))
    (link,) = page.of("a")
    assert link["download"] == "numbers.csv"
    assert base64.b64decode(link["href"].partition(",")[2]).decode() == table.to_csv()
    assert not PageParts(table_region(table, "Words", as_csv=False)).of("a")


def test_files_with_odd_names_are_links_to_themselves():
    (link,) = PageParts(linked_files([("a b#c?.nc", "data")])).of("a")
    assert link["href"] == "a%20b%23c%3F.nc"


def test_anchors_are_plain():
    assert anchor_of("What it <b>cost</b>: 3 s!") == "what-it-b-cost-b-3-s"
    assert anchor_of("???") == "part"
