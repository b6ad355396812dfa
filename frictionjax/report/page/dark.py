"""Vector pictures for dark pages: other lightness, the same hues."""

import colorsys
import re

_COLOUR = re.compile(r"#([0-9a-fA-F]{6})\b")
_TINT, _GREY = 0.85, 0.25  # lighter and less saturated than these: paper, not ink
_PAPER, _INK = 0.10, 0.95  # lightness of what was white, and of what was black
_INKS = 0.45, 0.88  # of coloured inks: 5:1 on that paper, told apart, in their order
# Of images inside: inverted, hues turned back, then onto the same paper.
_FILTER = (
    '<filter id="dark" color-interpolation-filters="sRGB">'
    '<feColorMatrix type="matrix" values="'
    "0.574 -1.430 -0.144 0 1  -0.426 -0.430 -0.144 0 1  "
    '-0.426 -1.430 0.856 0 1  0 0 0 1 0"/>'
    '<feColorMatrix type="matrix" values="'
    '0.85 0 0 0 0.1  0 0.85 0 0 0.1  0 0 0.85 0 0.1  0 0 0 1 0"/></filter>'
)


def darkened(svg: str) -> str:
    """An SVG of matplotlib's on dark paper."""
    recoloured = _COLOUR.sub(lambda m: on_dark_paper(m[1]), svg)
    # What has no colour of its own is black: letters are.
    opened = recoloured.replace("<svg ", f'<svg fill="{on_dark_paper("000000")}" ', 1)
    if "<image" not in opened:
        return opened
    opened = opened.replace("<defs>", f"<defs>{_FILTER}", 1)
    return opened.replace("<image", '<image filter="url(#dark)"')


def on_dark_paper(colour: str) -> str:
    """The colour (RRGGBB) that stands for another one on dark paper, as #rrggbb."""
    red, green, blue = (int(colour[i : i + 2], 16) / 255 for i in (0, 2, 4))
    hue, light, strong = colorsys.rgb_to_hls(red, green, blue)
    if light > _TINT or strong < _GREY:
        light = _PAPER + (_INK - _PAPER) * (1 - light)
    else:
        low, high = _INKS
        light = low + (high - low) * (1 - light)
    mixed = colorsys.hls_to_rgb(hue, light, strong)
    return "#" + "".join(f"{round(255 * part):02x}" for part in mixed)
