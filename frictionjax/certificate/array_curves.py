"""Curves of the bristles of an array, each a plain system on a surface that is shifted."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from .._checks import exchanged
from ..effects import CompliantArray
from ..model import Scene
from ..turning import SidedSupport
from .plain_curve import plain_certificate, together
from .verdicts import Certificate


def array_certificate(
    scene: Scene,
    array: CompliantArray,
    eps: float,
    viscosity: float,
    scale: float,
    ts: Float[np.ndarray, " n"],
    z: Float[np.ndarray, "bristles n"],
) -> Certificate:
    """Of finite samples, a row a bristle: sums over bristles, and the worst of them.

    `z_i + eps offset_i` solves the plain system whose support is held as much farther: one
    program for all bristles.
    """
    ahead = eps * np.asarray(array.offsets)
    alone = exchanged(scene, {"effects": ()})
    found = []
    for shift, row in zip(ahead, z, strict=True):
        held = SidedSupport(scene.support, jnp.ones(()), jnp.asarray(shift))
        moved = exchanged(alone, {"support": held})
        found.append(plain_certificate(moved, eps, viscosity, scale, ts, row + shift))
    return together(found)
