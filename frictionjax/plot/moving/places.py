"""Where a bristle, its surface and its spring are, along a solution."""

import enum
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..._checks import require
from ...bristles import AngularSpring, SlantedSpring, VerticalSpring
from ...contact import mechanics
from ...effects import Stage
from ...model import Scene

_RAISED = 0.25  # of the way: where a root is drawn whose height nobody knows


class Drawn(enum.Enum):
    """As what a bristle is drawn."""

    ROD = "rod"
    SPRING = "spring"
    UNKNOWN = "link"


class Places(NamedTuple):
    """Over times (n,): in m, s, rad and N.

    `root`, `tip`: (n, 2), across and up; `far`: the far end of the support's spring, (n,)
    across, None where there is none; `angle`: > 0 where the tip is to the left of the root,
    NaN where the bristle has no geometry; `side`: 0 where it is straight, else to which
    side of the way from tip to root it is bent (1: left); `length` of the straight rod.
    `height` tells the surface's at places across, `size` how long a bristle is, about.
    """

    time: np.ndarray
    root: np.ndarray
    tip: np.ndarray
    far: np.ndarray | None
    angle: np.ndarray
    side: np.ndarray
    length: float
    force: np.ndarray
    kind: Drawn
    rest_angle: float | None
    eps: float | None
    height: Callable[[np.ndarray], np.ndarray]
    size: float

    @property
    def ends(self) -> tuple[float, float]:
        """From the leftmost thing drawn to the rightmost, in m."""
        rows = [self.root[:, 0], self.tip[:, 0]]
        if self.far is not None:
            rows.append(self.far)
        return float(np.min(rows)), float(np.max(rows))


def places_along(scene: Scene, solution: Any, eps: Any = None) -> Places:
    """Of a scene with one bristle, as `mechanics` tells them.

    Where nothing says how a bristle stands its root is raised over z by a quarter of the
    way it goes. Raises `ValueError` as `mechanics` does, for a scene without a bristle, and
    for an effect that puts another potential in the place of the bristle's.
    """
    known = scene.bristle is not None
    require(known, "scene.bristle", None, "one: the abstract setting has no places to draw")
    for effect in scene.effects:
        name, needs = type(effect).__name__, "a scene without it: it has no bristle to draw"
        require(effect.stage != Stage.POTENTIAL, "scene.effects", name, needs)
    data = mechanics(scene, solution, eps)
    surface = _surface(scene.profile, eps)
    tip = np.stack([data.p.values, surface(data.p.values)], axis=1)
    angle, chord = data.theta.values, data.length.values
    stands = bool(np.all(np.isfinite(angle)))
    low, high = _extent(data.u.values, data.p.values)
    if stands:
        up = tip[:, 1] + chord * np.cos(angle)
        size = float(np.max(chord))
    else:
        size = max(_RAISED * (high - low), 2 * float(np.max(np.abs(tip[:, 1]))))
        up = np.full(tip.shape[0], size)
    far = data.q.values
    return Places(
        time=data.time.values,
        root=np.stack([data.u.values, up], axis=1),
        tip=tip,
        far=far if np.all(np.isfinite(far)) else None,
        angle=angle,
        side=_sides(data["mode"].values) if "mode" in data else np.zeros(len(far), int),
        length=size,
        force=data.support_force.values,
        kind=_kind(scene.bristle) if stands else Drawn.UNKNOWN,
        rest_angle=_rest_angle(scene.bristle),
        eps=None if eps is None else float(eps),
        height=surface,
        size=size,
    )


def _surface(profile: Any, eps: Any) -> Callable[[np.ndarray], np.ndarray]:
    if eps is None:
        return np.zeros_like
    scale = float(eps)
    return lambda x: scale * np.asarray(profile(x / scale))


def _extent(*rows: np.ndarray) -> tuple[float, float]:
    return float(np.min(rows)), float(np.max(rows))


def _kind(bristle: Any) -> Drawn:
    spring = isinstance(bristle, VerticalSpring | SlantedSpring)
    return Drawn.SPRING if spring else Drawn.ROD


def _rest_angle(bristle: Any) -> float | None:
    rod = isinstance(bristle, AngularSpring)
    return float(bristle.rest_angle) if rod else None


def _sides(mode: np.ndarray) -> np.ndarray:
    """Bent to where the root goes: of one that stood as at first, to the left."""
    last = np.maximum.accumulate(np.where(mode != 0, np.arange(mode.size), 0))
    return np.where(mode == 0, mode[last], 0)
