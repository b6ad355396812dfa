"""Compression along a rod, held against the load at which it buckles."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from .._checks import Real
from .._compile import Program
from ..effects import AxialLoad
from ..model import AbstractPotential, Scene
from ..rods import sprung_load
from .forces import tip_forces
from .support_spring import Rows

BELOW = "below the critical load everywhere: not shown to buckle"
BEYOND = "beyond the critical load somewhere: buckles"


class AxialReading(NamedTuple):
    """`compression` along a rod in N, and over the `critical` load (N) its `share`."""

    compression: Any
    share: Any
    critical: float

    @property
    def verdict(self) -> str:
        """Below is no proof of stability: rods that are sheared can buckle before."""
        return BEYOND if np.any(np.asarray(self.share) >= 1) else BELOW


def axial_reading(scene: Scene, compression: Any) -> AxialReading | None:
    """Of a scene with `AxialLoad`, whose bristle is an angular spring; else None."""
    for effect in scene.effects:
        if isinstance(effect, AxialLoad):
            rod: Any = scene.bristle
            load = sprung_load(effect.bending_stiffness, rod.length, rod.stiffness)
            return AxialReading(compression, compression / float(load), float(load))
    return None


@Program
def _compressions(potential: AbstractPotential, z: Rows, eps: Real) -> Rows:
    def at(one: Real) -> Real:
        axial = tip_forces(potential, one, eps).axial
        assert axial is not None
        return -axial

    return jax.vmap(at)(jnp.asarray(z))


def largest_compression(scene: Scene, eps: Rows, z: Any) -> AxialReading | None:
    """The largest compression of every cell at the times that z is known at.

    `eps` in m, shape (e,); z in m, shape (g, e, n). Of shape (g, e); None without
    `AxialLoad`.
    """
    if axial_reading(scene, 0.0) is None:
        return None
    z = np.asarray(z)
    found = np.empty(z.shape[:2])
    for i, size in enumerate(np.asarray(eps)):
        rows = _compressions(scene.potential, z[:, i].ravel(), jnp.asarray(size))
        found[:, i] = np.max(np.reshape(rows, (z.shape[0], -1)), axis=1)
    return axial_reading(scene, found)
