"""The tip of a bristle among the wiggles of its surface, which a bristle dwarfs."""

from typing import Any

import numpy as np

from ..style import GUIDE, STRIP, colour
from .places import Drawn, Places
from .shapes import rod_between

_PERIODS = 2.5  # of the surface to each side of the tip
_POINTS = 401


class CloseUp:
    """The surface around the tip of `places`, in units of eps; `move_to` a row of them.

    Heights are stretched.
    The tip stays in the middle, the surface goes by under it: little while the tip rests
    in a well, at once where it slips.
    """

    def __init__(self, axes: Any, places: Places):
        assert places.eps is not None
        self.axes, self.places, self.eps = axes, places, places.eps
        self._around = np.linspace(-_PERIODS, _PERIODS, _POINTS)
        period = places.height(self.eps * np.linspace(0, 1, _POINTS)) / self.eps
        low, high = float(np.min(period)), float(np.max(period))
        self._low, self._high = low - 0.35 * (high - low), high + 0.8 * (high - low)
        self.surface = axes.plot([], [], color=GUIDE, linewidth=1.0)[0]
        flat = np.full(_POINTS, self._low)
        self.ground = axes.fill_between(self._around, flat, flat, color=STRIP, linewidth=0)
        self.bristle = axes.plot([], [], color=colour(0), linewidth=2.2)[0]
        self.bristle.set_visible(places.kind is not Drawn.UNKNOWN)
        self.tip = axes.plot([], [], "o", color=colour(1), markersize=6, zorder=4)[0]
        axes.set(xlim=(-_PERIODS, _PERIODS), ylim=(self._low, self._high))
        axes.set(xlabel="x - p (in eps)", ylabel="height (in eps)")
        axes.set_title("Its tip, heights stretched")
        axes.grid(False)

    def move_to(self, row: int) -> None:
        """Draw the surface as it is around the tip at a time."""
        tip = self.places.tip[row]
        up = self.places.height(tip[0] + self.eps * self._around) / self.eps
        self.surface.set_data(self._around, up)
        self.ground.set_data(self._around, up, np.full(_POINTS, self._low))
        foot = tip[1] / self.eps
        self.tip.set_data([0], [foot])
        side = int(self.places.side[row])
        line = rod_between(self.places.root[row], tip, self.places.length, side)
        self.bristle.set_data(*((line.T - [tip[0], 0.0]) / self.eps).T)
