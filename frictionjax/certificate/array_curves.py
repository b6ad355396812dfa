"""Curves of the bristles of an array, each a plain system on a surface that is shifted."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from .._checks import exchanged
from ..effects import CompliantArray
from ..model import Scene
from ..turning import SidedSupport
from .plain_curve import CurveMeasures, plain_certificate, verdict
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
    return _together(found)


def _together(found: list[Certificate]) -> Certificate:
    worst = CurveMeasures(
        distance=max(one.distance for one in found),
        missing_force=max(one.missing_force for one in found),
        viscosity=_farthest_from_1([one.viscosity for one in found]),
        spacing=max(one.spacing for one in found),
    )
    return Certificate(
        residual=sum(one.residual for one in found),
        residual_error=sum(one.residual_error for one in found),
        scale=found[0].scale,
        slips=sum(one.slips for one in found),
        skipped=sum(one.skipped for one in found),
        status=verdict(worst),
        **worst._asdict(),
    )


def _farthest_from_1(ratios: list[float]) -> float:
    """NaN, of bristles that do not slip, where all are."""
    return max(ratios, key=lambda ratio: -1.0 if np.isnan(ratio) else abs(ratio - 1))
