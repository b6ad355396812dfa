"""What the higher order changes where no closed form tells: measured, with it and without.

Where the load turns while a tip is on a fold, what is small decides when it slips, or
whether it does. So the scene is solved twice, and states are compared at times that tell
(`telling_times`), outside of slips of either.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from ..called_for import Estimate, Setting, bristle_places, higher_order
from ..effects import LeadingOrder
from ..model import Scene, composed
from ..wiggly import Status, integrate_cells
from .telling_times import TellingTimes, telling_times, thinned

_SLIP = 0.05  # of eps in half a percent of a well's time: a tip that moves further slips
# Times what is measured: other times saw up to 1.2 times as much of scenes that ship
# (`pytest -m slow tests/called_for/test_plain_system.py` holds it).
_UNSEEN = 2.0
# Error of the two solves, of the closed form, which may tell far more than is seen.
_FINER, _FINEST = 1e-3, 1e-9
_BRISTLES = 16  # of an array that are measured
_TURNS = 20  # on folds, about which it is measured


class _Outside(NamedTuple):
    """States in m, a row a bristle, and whether they are outside of slips."""

    z: Float[np.ndarray, "bristles n"]
    calm: Bool[np.ndarray, "bristles n"]


def higher_order_told(at: Setting, tell: Callable[[str], None]) -> Estimate:
    """What `eps^2 Q` changes: by a closed form, or measured where that is no bound.

    `tell`: of what is under way. Of an array the change of any of its bristles.
    """
    told, turns = higher_order(at)
    if not turns.size or told.in_z == 0:
        return told
    tell("solving with the higher order and without it")
    where = f"the load turns on a fold, t = {turns[0]:.3g} s"
    accuracy = float(np.clip(_FINER * told.in_z / at.eps, _FINEST, _FINER))
    phases = bristle_places(at.scene)
    some, few = thinned(phases, _BRISTLES), thinned(turns, _TURNS)
    seen = _largest_change(at, telling_times(at, few), accuracy, some)
    if seen is None:
        return told._replace(source=f"{told.source}; no bound where {where}")
    in_z = _UNSEEN * (seen + accuracy * at.eps)
    source = f"switched off and measured: {where}"
    if some.size < phases.size or few.size < turns.size:
        source += f"; no bound beyond {some.size} of {phases.size} bristles"
        source += f", {few.size} of {turns.size} turns"
        in_z = max(in_z, told.in_z)
    return told._replace(in_z=in_z, source=source)


def _largest_change(
    at: Setting,
    times: TellingTimes,
    accuracy: float,
    phases: Float[np.ndarray, " bristles"],
) -> float | None:
    """Of any bristle's state outside of slips, in m; None where a solve fails."""
    whole = at.scene.replace(effects=())
    leading = composed(whole.replace(effects=(LeadingOrder(),)))
    one, other = (_outside_slips(s, at, times, accuracy, phases) for s in (whole, leading))
    if one is None or other is None:
        return None
    outside = np.abs(one.z - other.z)[one.calm & other.calm]
    return float(np.max(outside)) if outside.size else None


def _outside_slips(
    scene: Scene,
    at: Setting,
    times: TellingTimes,
    accuracy: float,
    phases: Float[np.ndarray, " bristles"],
) -> _Outside | None:
    """At times, and half a percent of a well's time from them; None where it fails."""
    middle = np.clip(times.at, times.away, float(scene.duration) - times.away)
    ts = np.concatenate([middle - times.away, middle, middle + times.away])
    order = np.sort(ts)
    # For so many times lanes that set off from slip maps take longer than every slip does.
    wells = float(np.sum(np.abs(at.data.speed) * at.data.length)) / at.eps
    found = integrate_cells(
        scene=scene,
        eps=np.full(phases.size, at.eps),
        gamma=np.full(phases.size, at.gamma),
        ts=order,
        accuracy=accuracy,
        method="resolved" if wells <= times.at.size else "auto",
        balanced=False,
        suprema=False,
        phase=None if np.all(phases == 0) else phases,
    )
    if found is None or np.any(found.status != int(Status.OK)):
        return None
    before, z, after = np.split(found.z[:, np.searchsorted(order, ts)], 3, axis=1)
    moved = np.maximum(np.abs(z - before), np.abs(after - z))
    return _Outside(z, moved < _SLIP * at.eps)
