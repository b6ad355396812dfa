"""What effects of its scene make of the coefficients that a design asks for."""

import dataclasses
from collections.abc import Sequence
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from ..._checks import Real, as_real, checked, is_concrete, is_known, require
from ...bristles import AbstractBristle, Homothetic, VerticalSpring
from ...coefficients import Coefficients
from ...effects import (
    AbstractEffect,
    CompliantArray,
    Engine,
    NapFlip,
    RigidArray,
    nap_flip_among,
    require_bristle,
    require_done,
    require_together,
)
from ...io import PART, several
from ...model import coefficients_jit, potential, with_effects
from ...profiles import AbstractProfile
from .settings import SETTINGS
from .summed_surface import SummedSurface

EFFECT_FORM = several(PART).or_else(lambda entries: ())
"""Effects in a document."""

_FORCES = ("alpha", "normal_plus", "normal_minus")


class SceneEffects(NamedTuple):
    """Effects of the scene that a design is for, checked.

    `times`: how many bristles pull as one does, whose forces add; None where there is one.
    `apart`: tips on one root at different phases, None where there are none.
    """

    effects: tuple[AbstractEffect, ...] = ()
    times: Real | None = None
    apart: RigidArray | None = None

    @property
    def nap_flip(self) -> NapFlip | None:
        """The rod's turning over, where the scene has it."""
        return nap_flip_among(self.effects)

    def of_all(self, value: Any, quantity: str = "force") -> Any:
        """The quantity of all bristles, of that of one; a ratio is that of one."""
        alike = self.times is None or quantity == "ratio"
        return value if alike else self.times * value

    def of_one(self, value: Any, quantity: str = "force") -> Any:
        """The quantity of one bristle, of that of all."""
        alike = self.times is None or quantity == "ratio"
        return value if alike else value / self.times

    def surface(self, profile: AbstractProfile) -> AbstractProfile:
        """`surface_for` these tips; raises `ValueError` where their forces cancel."""
        if self.apart is not None and is_concrete(profile, self.apart):
            unit = potential(profile, Homothetic(as_real(1.0)))
            left = float(coefficients_jit(with_effects(unit, (self.apart,))).rho_plus)
            needs = "tips whose forces do not cancel"
            require(left > 0, "effects.RigidArray: rho_plus", left, needs)
        return surface_for(self.apart, profile)

    def own_part(self, profile: Any) -> Any:
        """What belongs to the profile itself, of a tree made like `surface`."""
        return profile if self.apart is None else profile.single


def surface_for(apart: RigidArray | None, profile: AbstractProfile) -> AbstractProfile:
    """The surface on which one upright bristle does what tips at these phases do."""
    if apart is None:
        return profile
    return SummedSurface(profile, apart.offsets, _weights(apart))


def effects_of_scene(
    effects: Any, engine: Engine, bristles: Sequence[AbstractBristle]
) -> SceneEffects:
    """The effects that a design is asked for, checked.

    Raises `ValueError` for what is no effect, two that exclude each other, those that the
    engine does not do, or that are about another class of bristles, and for tips on one
    root at different phases of bristles that lean: each sees the surface bent by its lean.
    """
    listed = isinstance(effects, list | tuple)
    good = listed and all(isinstance(effect, AbstractEffect) for effect in effects)
    require(good, "effects", effects, "effects of frictionjax.effects in a tuple")
    known = tuple(checked(effect) for effect in effects)
    require_together(known)
    require_done(known, engine)
    for bristle in bristles:
        require_bristle(known, bristle)
    times: Any = None
    apart = None
    for effect in known:
        count: Any = None
        if isinstance(effect, CompliantArray):
            count = float(effect.offsets.size)
        elif isinstance(effect, RigidArray):
            apart = None if _alike(effect) else effect
            count = jnp.sum(_weights(effect)) if apart is None else None
        if count is not None:
            times = count if times is None else times * count
    if apart is not None:
        _require_upright(bristles)
    return SceneEffects(known, times, apart)


def coefficients_in_scene(
    asked: SceneEffects, profile: AbstractProfile, bristle: AbstractBristle
) -> Coefficients:
    """As `friction` of a scene with these effects, forces of a compliant array's added.

    Of tips of a rigid array at one phase with what one of them says of its contact.
    """
    single = potential(profile, bristle)
    found = coefficients_jit(with_effects(single, asked.effects))
    count = compliant_count(asked.effects)
    if asked.apart is None and asked.times is not None:
        own = coefficients_jit(single)
        forces = {name: asked.times * getattr(own, name) for name in _FORCES}
        own = dataclasses.replace(own, **forces)
    else:
        own = found
    rho = {"rho_plus": found.rho_plus, "rho_minus": found.rho_minus}
    if count > 1:
        rho = {name: count * value for name, value in rho.items()}
    return dataclasses.replace(own, **rho)


def compliant_count(effects: Sequence[AbstractEffect]) -> int:
    """Bristles of a compliant array, whose forces add up; 1 where there is none."""
    arrays = [effect for effect in effects if isinstance(effect, CompliantArray)]
    return int(np.prod([array.offsets.size for array in arrays]))


def _weights(array: RigidArray) -> Array:
    return jnp.ones_like(array.offsets) if array.weights is None else array.weights


def _alike(array: RigidArray) -> bool:
    """Whether all tips stand at one phase of the surface."""
    name = "effects.RigidArray.offsets"
    require(is_known(array.offsets), name, "traced", "known places of the tips")
    places = np.asarray(array.offsets)
    away = places - places[0]
    return bool(np.all(np.abs(away - np.round(away)) <= SETTINGS.one_phase))


def _require_upright(bristles: Sequence[AbstractBristle]) -> None:
    for bristle in bristles:
        upright = isinstance(bristle, Homothetic | VerticalSpring)
        kind = type(bristle).__name__
        needs = (
            "tips of effects.RigidArray at one phase of the surface, or bristles that "
            "stand upright, Homothetic or VerticalSpring; of others design one, and look "
            "at friction of a scene with the array"
        )
        require(upright, "bristle", kind, needs)
