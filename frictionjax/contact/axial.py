"""Compression along a rod, held against the load at which it buckles."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from .._checks import Real
from .._compile import Interpreted
from ..bristles import AngularSpring
from ..effects import AxialLoad, nap_flip_among
from ..model import AbstractPotential, Scene
from ..rods import sprung_load
from ..turning import flipping_rod, sided_potential
from .forces import tip_forces
from .support_spring import Rows

BELOW = "below the critical load everywhere: not shown to buckle"
BEYOND = "beyond the critical load somewhere: buckles"
NOT_STRAIGHT = "nothing straight to be told of at these times"


class AxialReading(NamedTuple):
    """`compression` along a rod in N, and over the `critical` load (N) its `share`.

    NaN where there is no straight rod.
    """

    compression: Any
    share: Any
    critical: float

    @property
    def verdict(self) -> str:
        """Below is no proof of stability: rods that are sheared can buckle before."""
        share = np.asarray(self.share)
        if np.all(np.isnan(share)):
            return NOT_STRAIGHT
        return BEYOND if np.any(share >= 1) else BELOW


def axial_reading(scene: Scene, compression: Any) -> AxialReading | None:
    """Of a scene with `AxialLoad`, whose bristle is an angular spring; else None."""
    for effect in scene.effects:
        if isinstance(effect, AxialLoad):
            rod: Any = scene.bristle
            load = sprung_load(effect.bending_stiffness, rod.length, rod.stiffness)
            return AxialReading(compression, compression / float(load), float(load))
    return None


@Interpreted
def _compressions(potential: AbstractPotential, z: Rows, eps: Real) -> Rows:
    def at(one: Real) -> Real:
        axial = tip_forces(potential, one, eps).axial
        assert axial is not None
        return -axial

    return jax.vmap(at)(jnp.asarray(z))


def largest_compression(
    scene: Scene, eps: Rows, z: Any, mode: Any = None
) -> AxialReading | None:
    """The largest compression of every cell at the times that z is known at.

    `eps` in m, shape (e,); z in m, shape (g, e, n), and `mode` likewise of a rod that turns
    over: 1, -1, and 0 where it is bent, which counts for nothing. Of shape (g, e); None
    without `AxialLoad`.
    """
    if axial_reading(scene, 0.0) is None:
        return None
    z = np.asarray(z)
    found = np.full(z.shape, -np.inf)
    for potential, place, straight in _stances(scene, z, mode):
        for i, size in enumerate(np.asarray(eps)):
            rows = _compressions(potential, place[:, i].ravel(), jnp.asarray(size))
            own = np.reshape(rows, place[:, i].shape)
            found[:, i] = np.where(straight[:, i], own, found[:, i])
    largest = np.max(found, axis=2)
    return axial_reading(scene, np.where(np.isneginf(largest), np.nan, largest))


def _stances(scene: Scene, z: Any, mode: Any) -> Iterator[tuple[Any, Any, Any]]:
    """Potentials of straight rods, states (m) in them, and where the rod stands so."""
    turning = nap_flip_among(scene.effects)
    if turning is None or mode is None:
        yield scene.potential, z, np.ones(z.shape, bool)
        return
    rod, reach = scene.bristle, flipping_rod(scene, turning).reach
    assert isinstance(rod, AngularSpring)
    assert scene.profile is not None
    for side in (1.0, -1.0):
        place = side * (z + (1 - side) * reach)
        yield sided_potential(scene.profile, rod, jnp.asarray(side)), place, mode == side
