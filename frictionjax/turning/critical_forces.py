"""What a scene's rod turns over with: loads that begin it, and the way back."""

import math
from typing import NamedTuple

import jax.numpy as jnp

from .._checks import ByIdentity, is_concrete, require
from ..bristles import AngularSpring
from ..effects import NapFlip
from ..model import BristlePotential, Scene, coefficients_jit
from ..rods import TurningRod, hinged_load
from .turned_rod import (
    NapSlides,
    nap_slides,
    stiffnesses,
    turned_over,
    turning_window,
)


class FlippingRod(NamedTuple):
    """Numbers of a rod that turns over, on the flat surface of the limit.

    `bent`: its energies. `standing`, `turned`: slides of both modes. `critical`: load in N.
    `reach` c in m. The root turns back while standing where what pulls it, `l - Phi'`,
    falls to `least` (N), and forth while turned over where it rises to `most`.
    """

    bent: TurningRod
    standing: NapSlides
    turned: NapSlides
    critical: float
    reach: float
    least: float
    most: float

    @property
    def standing_rest(self) -> tuple[float, float]:
        """Forces in N on the root that a rod as it stands at first withstands."""
        return self.least, self.standing.rho_with

    @property
    def turned_rest(self) -> tuple[float, float]:
        """Forces in N on the root that a rod turned over withstands."""
        return -self.turned.rho_with, self.most


_KNOWN = ByIdentity()  # of scenes


def flipping_rod(scene: Scene, effect: NapFlip) -> FlippingRod:
    """Of a scene with known numbers.

    Raises `ValueError` for traced ones, and for a critical load outside of the window in
    which a rod slides with the nap in both modes and turns over against it, with the
    bending stiffnesses that are inside.
    """
    found = _KNOWN.get(scene)
    if found is None:
        found = _flipping_rod(scene, effect)
        _KNOWN.put(scene, found)
    return found


def _flipping_rod(scene: Scene, effect: NapFlip) -> FlippingRod:
    name = "effects.NapFlip.bending_stiffness"
    known = is_concrete(scene, effect)
    require(known, name, "traced numbers", "a scene of known numbers")
    wiggle = scene.potential
    assert isinstance(wiggle, BristlePotential)
    rod = wiggle.bristle
    assert isinstance(rod, AngularSpring)
    law = coefficients_jit(wiggle)
    limit = float(rod.limit_angle)
    standing = nap_slides(law, limit)
    turned, why = turned_over(wiggle.profile, rod, law)
    stiffness = float(effect.bending_stiffness)
    require(turned is not None, name, stiffness, f"another rod: {why}")
    assert turned is not None
    loads = turning_window(standing, turned)
    closed = f"above {loads.least:.6g} N and below {loads.greatest:.6g} N"
    needs = f"a rod that can turn over: its critical load would have to be {closed}"
    require(loads.open, name, stiffness, needs)
    soft, stiff = stiffnesses(loads, rod.length)
    critical = float(hinged_load(stiffness, rod.length))
    needs = f"{soft:.6g} < bending_stiffness < {stiff:.6g}, so that it turns over only "
    needs += f"against the nap: pi^2 B/L^2 {closed}"
    require(loads.least < critical < loads.greatest, name, stiffness, needs)
    sine, cosine = math.sin(limit), math.cos(limit)
    bent = TurningRod(
        stiffness=jnp.asarray(rod.stiffness),
        rest_angle=jnp.asarray(rod.rest_angle),
        length=jnp.asarray(rod.length),
        bending_stiffness=jnp.asarray(effect.bending_stiffness),
        height=jnp.asarray(rod.height),
    )
    return FlippingRod(
        bent=bent,
        standing=standing,
        turned=turned,
        critical=critical,
        reach=float(bent.reach),
        least=sine * (standing.alpha * cosine - critical),
        most=-sine * (turned.alpha * cosine - critical),
    )
