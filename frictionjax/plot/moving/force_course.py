"""The force on the root of a bristle as it goes, beside the picture of it."""

from typing import Any

import numpy as np

from ...effects import nap_flip_among
from ...model import Scene, friction
from ...turning import flipping_rod
from ..style import LIMIT, colour, draw_level
from .places import Places

AGAINST = ("time", "tip")
_FAR = 0.2  # of a level: what forces beyond it are told from


class ForceCourse:
    """`l - Phi'` in N of `places`, what was and what is to come; `move_to` a row."""

    def __init__(self, axes: Any, scene: Scene, places: Places, against: str):
        across = places.time if against == "time" else places.tip[:, 0]
        self._across, self._force = across, places.force
        axes.plot(across, places.force, color=LIMIT, linewidth=0.9, alpha=0.35)
        self.gone = axes.plot([], [], color=colour(0), linewidth=1.4)[0]
        self.now = axes.plot([], [], "o", color=colour(1), markersize=5.5, zorder=4)[0]
        levels = friction_levels(scene)
        for value, name in levels:
            draw_level(axes, value, name)
        axes.margins(x=0.02, y=0.12)
        axes.set(xlabel="t (s)" if against == "time" else "tip p (m)")
        axes.set_ylabel("force $\\ell - \\Phi'$ (N)")
        far = places.eps is not None and _beyond(places.force, levels) > _FAR
        lines = "; lines: as $\\varepsilon \\to 0$, without drag" if far else ""
        axes.set_title(f"Force on the root{lines}")

    def move_to(self, row: int) -> None:
        """Mark a time, and what the force was until then."""
        self.gone.set_data(self._across[: row + 1], self._force[: row + 1])
        self.now.set_data([self._across[row]], [self._force[row]])


def _beyond(force: np.ndarray, levels: list[tuple[float, str]]) -> float:
    """How far forces go beyond the levels at most, as a share of these."""
    return max(float(np.max(force / value)) for value, _ in levels) - 1.0


def friction_levels(scene: Scene) -> list[tuple[float, str]]:
    """Forces in N that slides take in the limit, one way and the other, and their names."""
    effect = nap_flip_among(scene.effects)
    if effect is None:
        law = friction(scene)
        return [(float(law.rho_plus), "\\rho_+"), (float(law.rho_minus), "\\rho_-")]
    rod = flipping_rod(scene, effect)
    with_nap, turned = float(rod.standing.rho_with), float(rod.turned.rho_with)
    return [(with_nap, "\\rho_{with}"), (-turned, "-\\rho_{flipped}")]
