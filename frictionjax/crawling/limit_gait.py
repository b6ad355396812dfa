"""The crawler over dry friction, exactly: one foot holds while the other is moved."""

import numpy as np
from jaxtyping import Float

from .._checks import require
from ..limit import play_operator
from ..model import Scene, coefficients_jit, known_turning_points, strips_at
from .gait import Gait
from .settings import SETTINGS


def is_alike(plus: float, minus: float) -> bool:
    """Whether friction (N) is the same both ways, but for rounding."""
    return abs(plus - minus) <= SETTINGS.alike * (plus + minus)


def limit_gait(scene: Scene, ts: Float[np.ndarray, " n"]) -> Gait:
    """Feet from 0 and L(0), where the spring is slack, at sorted times in s.

    The foot that moves is the one that friction holds less: forwards both feet are moved
    where `rho_plus < -rho_minus`, the front one as the spring grows and the rear one as it
    shrinks; else backwards. So the spring's length is a play operator, with the smaller
    friction on both sides. Raises `ValueError` where both are the same.
    """
    law = coefficients_jit(scene.potential)
    plus, minus = float(law.rho_plus), -float(law.rho_minus)
    needs = "rho_plus != -rho_minus: with both the same no foot is held more than the other"
    require(not is_alike(plus, minus), "friction", f"{plus:.6g} N both ways", needs)
    least = min(plus, minus)
    turns = known_turning_points(scene.load, scene.duration, scene.turns)
    times = np.union1d(ts, turns)
    loads, lower, upper = strips_at(scene, least, -least, times)
    stiffness = float(scene.support.stiffness_at(0.0))
    slack = loads[0] / stiffness
    lengths = play_operator(lower, upper, slack)
    grown = np.diff(lengths, prepend=slack)
    longer, shorter = np.maximum(grown, 0.0), np.minimum(grown, 0.0)
    # Forwards: the front foot goes where it grows, the rear one where it shrinks.
    moves = (-shorter, longer) if plus < minus else (-longer, shorter)
    rear, front = (np.cumsum(way) for way in moves)
    lost = least * np.cumsum(np.abs(grown))
    at = np.searchsorted(times, ts)
    tension = stiffness * lengths - loads
    return Gait(rear[at], slack + front[at], tension[at], lost[at])
