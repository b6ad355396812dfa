"""Levels that a curve comes up against, named beside the axes."""

from typing import Any

from .look import GUIDE


def draw_level(axes: Any, value: float, name: str) -> None:
    """A line across at a force in N, its name (TeX) and its value at its right end."""
    axes.axhline(value, color=GUIDE, linewidth=0.9, zorder=1)
    axes.annotate(
        f"${name}$ = {value:.3g} N",
        (1.0, value),
        xycoords=axes.get_yaxis_transform(),
        xytext=(4, 0),
        textcoords="offset points",
        va="center",
        color="#555555",
    )
