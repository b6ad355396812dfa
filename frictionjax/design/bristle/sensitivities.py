"""How a designed number moves with the target and with every other number."""

import dataclasses
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp

from ..._checks import Real, call_text, is_concrete
from ..._compile import once_a_scene, padded_size
from ...bristles import AbstractBristle
from ...profiles import AbstractProfile
from ..common import (
    QUANTITIES,
    FreeParameter,
    Slopes,
    free_parameter,
    on_slopes,
    quantity_of,
    slopes_of,
)
from .settings import SETTINGS


class Sensitivities(eqx.Module):
    """Derivatives of the designed number, of shape () or (n,) with the target's.

    `target`: by the quantity asked for. `omega_plus`, `omega_minus`: by the extreme
    slopes. `bristle`, `profile`: parts whose leaves are the derivatives by theirs (0 in
    place of the free number). Infinite where the quantity turns.
    """

    target: Real
    omega_plus: Real
    omega_minus: Real
    bristle: AbstractBristle
    profile: AbstractProfile

    def __repr__(self) -> str:
        names = [field.name for field in dataclasses.fields(self)]
        return call_text(type(self).__name__, {n: getattr(self, n) for n in names})


def _one(free: FreeParameter, bristle, profile, value, which, again: bool):
    """Implicit function theorem: dv = (dtarget - dq(v; p) . dp) / (dq/dv).

    `again`: what comes out may be differentiated too.
    """

    numbers, rest = eqx.partition(bristle, eqx.is_inexact_array)

    def quantity(v: Real, numbers: Any, slopes: Slopes) -> Real:
        part = free.put(eqx.combine(numbers, rest), v)
        return quantity_of(on_slopes(part, slopes), which)

    slopes, pull = jax.vjp(lambda one: slopes_of(one, again), profile)
    by = jax.grad(quantity, argnums=(0, 1, 2))(value, numbers, slopes)
    by_bristle, by_slopes = jax.tree_util.tree_map(lambda d: -d / by[0], by[1:])
    return 1 / by[0], *by_slopes, by_bristle, pull(by_slopes)[0]


@once_a_scene
def _derivatives(free: FreeParameter, bristle, profile, value, which, again: bool):
    return _one(free, bristle, profile, value, which, again)


@once_a_scene
def _batch(free: FreeParameter, bristles, profile, values, which, again: bool):
    def one(bristle: Any, value: Real) -> Any:
        return _one(free, bristle, profile, value, which, again)

    return eqx.filter_vmap(one, in_axes=(eqx.if_array(0), 0))(bristles, values)


def sensitivities_of(fit: Any) -> Sensitivities:
    """Sensitivities of a fit, one target's or a batch's."""
    which = jnp.asarray(QUANTITIES.index(fit.quantity))
    again = not is_concrete(fit.value, fit.bristle, fit.profile)
    surface = fit.scene.surface(fit.profile)
    if not is_concrete(fit.value) or fit.value.ndim == 0:
        free = free_parameter(fit.bristle, fit.free)
        found = _derivatives(free, fit.bristle, surface, fit.value, which, again)
        return _of_scene(fit, Sensitivities(*found))
    free = free_parameter(fit[0].bristle, fit.free)
    count = fit.value.shape[0]
    more = padded_size(count, *SETTINGS.room) - count

    def padded(leaf: Any) -> Any:
        if not eqx.is_array(leaf):
            return leaf
        return jnp.pad(leaf, [(0, more)] + [(0, 0)] * (leaf.ndim - 1), mode="edge")

    both = jax.tree_util.tree_map(padded, (fit.bristle, fit.value))
    found = _batch(free, both[0], surface, both[1], which, again)
    found = jax.tree_util.tree_map(lambda leaf: leaf[:count], found)
    return _of_scene(fit, Sensitivities(*found))


def _of_scene(fit: Any, found: Sensitivities) -> Sensitivities:
    """By the quantity of all bristles of the scene, and by the profile's own numbers."""
    target = fit.scene.of_one(found.target, fit.quantity)
    own = fit.scene.own_part(found.profile)
    return dataclasses.replace(found, target=target, profile=own)
