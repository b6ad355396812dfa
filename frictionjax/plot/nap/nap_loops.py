"""Friction loops of one bristle by either effect of its nap."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from ...contact import nap_loops
from ...model import Scene
from ..style import GUIDE, PLATE, colour, new_figure, styled

_TITLES = {
    "geometric": "Geometric effect: a stiff rod",
    "energetic": "Energetic effect: a rod that turns over",
}
_BESIDE = 1e-3  # of the height of a loop: rounding is not beyond a level
_LEVELS = {
    "geometric": (("rho_with", 1, "with"), ("rho_against", -1, "against")),
    "energetic": (("rho_with", 1, "with"), ("rho_flipped", -1, "flipped")),
}


@styled
def draw_nap_loops(scene: Scene, ts: Any = None) -> Figure:
    r"""Draw the limit's force on the root against z, of a stiff rod and of one that bends.

    The `scene` has `effects.NapFlip`; `ts` (s) as in `solve_limit`. On the left it is left
    out. Lines: friction of slides one way and the other. Right: where the rod is bent over
    its tip the loop is dashed.

    Raises `ValueError` as `contact.nap_loops` does.

    >>> rough, load = fx.profiles.Sine(slope=0.5), fx.loads.Triangle(2.5, period=3.0)
    >>> rod = fx.bristles.AngularSpring(1.0, length=1.4, height=1.0, rest_angle=0.3)
    >>> flips = (fx.effects.NapFlip(bending_stiffness=0.1),)
    >>> turning = scene.replace(profile=rough, bristle=rod, load=load, effects=flips)
    >>> [text.get_text() for text in fx.plot.draw_nap_loops(turning).axes[1].texts]
    ['$\\rho_{with}$ = 0.161 N', '$-\\rho_{flipped}$ = -0.363 N']
    """
    data = nap_loops(scene, ts)
    figure, grid = new_figure(1, 2, 10.4, 4.4)
    for index, (axes, (name, title)) in enumerate(
        zip(grid[0], _TITLES.items(), strict=True)
    ):
        one = data.sel(effect=name)
        bent = one["mode"].values == 0
        straight = one.force.where(~bent)
        axes.plot(one.z, straight, color=colour(index), label="straight")
        if bent.any():
            # One more at both ends, or the line would have gaps there.
            wide = bent.copy()
            wide[1:] |= bent[:-1]
            wide[:-1] |= bent[1:]
            between = one.force.where(wide)
            axes.plot(one.z, between, "--", color=colour(index), label="bent over its tip")
            axes.legend(loc="best")
        for level, side, word in _LEVELS[name]:
            value = side * data.attrs[level]
            place = _free_place(one.z.values, side * (one.force.values - value))
            _level(axes, value, side, word, place)
        lost = float(one.dissipation[-1])
        axes.set(title=f"{title}, {lost:.4g} J lost", xlabel="z (m)")
        axes.set_ylabel("friction force $\\ell - \\Phi'(z)$ (N)")
        axes.margins(y=0.12)
    low, high = zip(*(axes.get_ylim() for axes in grid[0]), strict=True)
    for axes in grid[0]:
        axes.set_ylim(min(low), max(high))
    return figure


def _free_place(z: np.ndarray, beyond: np.ndarray) -> float:
    """Share of the width, from the left, farthest from where a loop goes `beyond` a level
    (N, outwards), the middle where it does not."""
    past = z[beyond > _BESIDE * np.ptp(beyond)]
    if past.size == 0:
        return 0.5
    places = np.linspace(0.25, 0.75, 51)
    apart = np.abs(places[:, None] - (past - z.min()) / np.ptp(z)).min(axis=1)
    return float(places[np.argmax(apart)])


def _level(axes: Any, value: float, side: int, word: str, place: float) -> None:
    axes.axhline(value, color=GUIDE, linewidth=0.9, zorder=1)
    sign = "" if side > 0 else "-"
    axes.annotate(
        f"${sign}\\rho_{{{word}}}$ = {value:.3g} N",
        (place, value),
        xycoords=axes.get_yaxis_transform(),
        xytext=(0, 6 * side),
        textcoords="offset points",
        bbox=PLATE | {"alpha": 0.85},
        ha="center",
        va="bottom" if side > 0 else "top",
        color="#555555",
    )
