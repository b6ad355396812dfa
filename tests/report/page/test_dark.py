"""Pictures on dark paper can be read, and their colours told apart."""

import itertools

import numpy as np
import pytest
from matplotlib.colors import to_hex, to_rgb

from frictionjax.plot.style import COLOURS, GUIDE, LIMIT, shades
from frictionjax.report.page.dark import darkened, on_dark_paper

PAPER = on_dark_paper("ffffff")


def luminance(colour):
    """Relative luminance of WCAG 2."""
    parts = np.array(to_rgb(colour))
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def contrast(one, other):
    """Contrast of WCAG 2."""
    high, low = sorted((luminance(one), luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("colour", [*COLOURS, LIMIT, GUIDE])
def test_lines_stand_out_from_dark_paper(colour):
    assert contrast(on_dark_paper(colour[1:]), PAPER) > 3.0


@pytest.mark.parametrize("colour", ["#000000", "#222222", "#444444", "#555555", "#666666"])
def test_letters_are_read_on_dark_paper(colour):
    assert contrast(on_dark_paper(colour[1:]), PAPER) > 4.5


def test_colours_stay_apart_and_shades_in_order():
    found = [np.array(to_rgb(on_dark_paper(colour[1:]))) for colour in COLOURS]
    assert min(np.abs(a - b).max() for a, b in itertools.combinations(found, 2)) > 0.1
    fine = [luminance(on_dark_paper(to_hex(shade)[1:])) for shade in shades(3)]
    coarse = [luminance(to_hex(shade)) for shade in shades(3)]
    assert np.all(np.diff(coarse) < 0)  # from light to dark on white
    assert len({round(value, 2) for value in fine}) == 3


def test_letters_without_a_colour_of_their_own_turn_light():
    svg = '<svg width="1"><defs></defs><g style="fill: #ffffff"/><use/></svg>'
    dark = darkened(svg)
    assert dark.startswith(f'<svg fill="{on_dark_paper("000000")}" ')
    assert f"fill: {PAPER}" in dark
    assert "filter" not in dark


def test_images_inside_are_turned_too():
    dark = darkened(
        '<svg ><defs></defs><image xlink:href="data:image/png;base64,x"/></svg>'
    )
    assert dark.count('filter="url(#dark)"') == 1
    assert dark.count('<filter id="dark"') == 1
