"""Friction of a root that is drawn to and fro, by either effect of its nap."""

from typing import Any

from ...contact import Nap
from ..style import GUIDE, axes_of, colour, styled


@styled
def draw_strokes(found: Nap, ax: Any = None) -> Any:
    """Draw what `nap` has `found`: friction loops of strokes that are long against the rod.

    A Figure, or `ax` where it is drawn into that.

    Solid: the bristle keeps its nap, and friction is `rho_with` one way and `rho_against`
    the other, to the right and to the left where no nap is known. Dashed, of a rod that can
    turn over: it slides with its nap both ways, with `rho_with` and `rho_flipped`. Of a
    stroke so long what happens where it ends is not seen: `fx.plot.draw_nap_loops` draws
    it, of a scene.

    >>> figure = fx.plot.draw_strokes(fx.nap(scene.profile, scene.bristle))
    >>> figure.axes[0].get_title(loc="left")
    'With and against the nap: against/with = 0.7305'
    """
    drawn, axes = axes_of(ax, 7.2, 4.2)
    axes.axhline(0, color=GUIDE, linewidth=0.8)
    kept = "it keeps its nap" if found.knows_nap else "it stays as it stands"
    _loop(axes, found.rho_with, found.rho_against, 0, "-", kept)
    forth, back = ("with", "against") if found.knows_nap else ("right", "left")
    _level(axes, found.rho_with, f"\\rho_{{{forth}}}")
    _level(axes, -found.rho_against, f"-\\rho_{{{back}}}")
    if found.flipped is not None:
        label = "it turns over" if found.turns_over else "if it turned over"
        _loop(axes, found.rho_with, found.rho_flipped, 1, "--", label)
        _level(axes, -found.rho_flipped, "-\\rho_{flipped}")
    axes.set(xlabel="way of the root (strokes)", ylabel="friction force (N)")
    ways = "With and against the nap", "To the right and to the left"
    title = ways[not found.knows_nap]
    ratio = f"{back}/{forth} = {found.ratio:.4g}"
    if found.turns_over:
        ratio = f"turned over/with = {found.rho_flipped / found.rho_with:.4g}"
    axes.set_title(f"{title}: {ratio}")
    axes.margins(x=0.02, y=0.16)
    axes.legend(loc="best")
    return drawn


def _loop(axes: Any, forth: float, back: float, index: int, style: str, label: str) -> None:
    way, force = [0, 1, 1, 0, 0], [forth, forth, -back, -back, forth]
    axes.plot(way, force, style, color=colour(index), label=label)


def _level(axes: Any, value: float, name: str) -> None:
    up = value > 0
    axes.annotate(
        f"${name}$ = {value:.3g} N",
        (0.5, value),
        xytext=(0, 5 if up else -5),
        textcoords="offset points",
        ha="center",
        va="bottom" if up else "top",
        color="#555555",
    )
