"""What effects make of a scene, before anything is traced."""

from collections.abc import Sequence
from functools import singledispatch

import jax.numpy as jnp

from .._checks import ByIdentity, exchanged, is_concrete
from ..bristles import Linear
from ..effects import AbstractEffect, Engine, LeadingOrder, RigidArray, Stage, require_done
from .potentials import AbstractPotential, BristlePotential, GivenPotential
from .scene import Scene, known_scene
from .summed_potential import SummedPotential

_COMPOSED = ByIdentity()  # of scenes that are known


def scene_for(engine: Engine, scene: Scene) -> Scene:
    """The scene that an engine works with: effects of the potential are in its potential.

    Itself where it has none. What is left in `effects` is for the engine to do. Raises
    `ValueError` as `known_scene` does, and for effects that the engine does not do.
    """
    scene = known_scene(scene)
    if not scene.effects:
        return scene
    require_done(scene.effects, engine)
    return composed(scene)


def composed(scene: Scene) -> Scene:
    """A known scene with the effects of its potential worked in."""
    if not any(effect.stage == Stage.POTENTIAL for effect in scene.effects):
        return scene
    found = _COMPOSED.get(scene)
    if found is None:
        found = _with_changed_potential(scene)
        if is_concrete(scene):  # what is traced must not outlive its trace
            _COMPOSED.put(scene, found)
    return found


def _with_changed_potential(scene: Scene) -> Scene:
    potential = with_effects(scene.potential, scene.effects)
    rest = tuple(e for e in scene.effects if e.stage != Stage.POTENTIAL)
    return exchanged(scene, {"potential": potential, "effects": rest})


def with_effects(
    potential: AbstractPotential, effects: Sequence[AbstractEffect]
) -> AbstractPotential:
    """A potential with effects worked in, in their order."""
    for effect in sorted(effects, key=lambda effect: effect.stage):
        potential = changed_potential(effect, potential)
    return potential


@singledispatch
def changed_potential(
    effect: AbstractEffect, potential: AbstractPotential
) -> AbstractPotential:
    """The wiggly potential with an effect."""
    return effect.changed(potential)


@changed_potential.register
def _(effect: LeadingOrder, potential: AbstractPotential) -> AbstractPotential:
    if isinstance(potential, BristlePotential):
        rest = Linear(potential.a(), potential.alpha())
        return BristlePotential(potential.profile, rest)
    if isinstance(potential, SummedPotential):
        single = changed_potential(effect, potential.single)
        return SummedPotential(single, potential.offsets, potential.weights)
    if isinstance(potential, GivenPotential):
        return GivenPotential(potential.W_fn, points=potential.points)
    return potential


@changed_potential.register
def _(effect: RigidArray, potential: AbstractPotential) -> AbstractPotential:
    weights = effect.weights
    weights = jnp.ones_like(effect.offsets) if weights is None else weights
    return SummedPotential(potential, effect.offsets, weights)
