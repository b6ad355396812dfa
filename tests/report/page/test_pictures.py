"""Pictures of a page: vector graphics, light and dark, in words."""

import base64
from xml.etree import ElementTree

import pytest
from html_pages import PageParts
from matplotlib.figure import Figure

from frictionjax.report.page.pictures import Captioned, shown, vector_graphic


def figure_of(width):
    figure = Figure(figsize=(width, 2.0))
    figure.subplots().plot([0, 1], [1, 3], label="<script>")
    return figure


def opened(url):
    head, _, data = url.partition(",")
    assert head == "data:image/svg+xml;base64"
    return base64.b64decode(data).decode()


def test_a_picture_has_two_looks_and_words():
    drawn = Captioned(figure_of(3.0), 'rises from 1 to 3 N <b> "', "Force `F`")
    page = PageParts(shown(drawn, "force"))
    ((image,), (dark,)) = page.of("img"), page.of("source")
    assert image["alt"] == drawn.told
    assert dark["media"] == "screen and (prefers-color-scheme: dark)"
    light, other = opened(image["src"]), opened(dark["srcset"])
    for svg in (light, other):
        assert ElementTree.fromstring(svg).tag.endswith("svg")
        assert "<script" not in svg
    assert "#ffffff" in light
    assert "#ffffff" not in other
    assert page.text == "Force F"


@pytest.mark.parametrize(("width", "regions"), [(5.0, 0), (9.0, 1)])
def test_wide_pictures_are_moved_instead_of_made_small(width, regions):
    page = PageParts(shown(Captioned(figure_of(width), "told", "caption"), "a name"))
    assert [div["aria-label"] for div in page.of("div")] == ["Picture: a name"] * regions
    assert ("min-width" in page.of("img")[0].get("style", "")) == bool(regions)


@pytest.mark.parametrize(("width", "far"), [(7.0, False), (9.0, True)])
def test_pictures_that_no_phone_shows_all_of_say_so(width, far):
    page = PageParts(shown(Captioned(figure_of(width), "told", "caption"), "a name"))
    (around,) = page.of("div")
    assert ("far" in around["class"].split()) == far


def test_the_same_figure_is_the_same_graphic_with_nothing_of_the_day_in_it():
    one, other = vector_graphic(figure_of(3.0)), vector_graphic(figure_of(3.0))
    assert one == other
    assert "<metadata" not in one
