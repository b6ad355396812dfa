"""Several tips on one root as one surface, at one eps."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .._checks import Real, require
from .._compile import Interpreted
from ..bristles import Homothetic
from ..profiles import Fourier
from .potentials import AbstractPotential, BristlePotential
from .settings import SETTINGS
from .summed_potential import SummedPotential


@Interpreted
def _energies(potential: AbstractPotential, eps: Real, places: Array) -> Array:
    """`V_eps/eps` of one tip at phases in a period, in N."""

    def at(Y: Real) -> Real:
        rest = jnp.where(eps == 0, 0.0, eps * potential._rest(eps, Y))
        return potential._leading(Y) + rest

    return jax.vmap(at)(places)


def surface_of_sum(
    total: SummedPotential, single: AbstractPotential, eps: float
) -> BristlePotential:
    """A known sum at one eps (m; 0: for eps -> 0), as one tip on a surface of its own.

    At one eps `V_eps` is `eps` times a 1-periodic function of z/eps, so a homothetic
    bristle on the surface of that shape moves alike: nothing is compiled for it. `single`:
    the potential of one tip, as planning evaluates it. Its harmonics are each multiplied
    by the sum over all phases, so that a hundred thousand tips cost what two do.

    Raises `ValueError` where so little of the tips' forces is left that it is rounding.
    """
    waves, share = _waves_of_sum(total, single, eps)
    needs = f"phases of which more than {SETTINGS.sum_left:g} of the forces is left"
    require(share > SETTINGS.sum_left, "effects.RigidArray: share left", share, needs)
    kept = np.abs(waves) > SETTINGS.sum_negligible * np.max(np.abs(waves))
    size = int(np.max(np.flatnonzero(kept))) + 1
    profile = Fourier(cos=waves.real[:size], sin=-waves.imag[:size])
    return BristlePotential(profile, Homothetic(jnp.asarray(1.0)))


def leaves_nothing(total: SummedPotential, single: AbstractPotential) -> bool:
    """Whether the forces of the tips cancel for eps -> 0, up to rounding."""
    return _waves_of_sum(total, single, 0.0)[1] <= SETTINGS.sum_left


def _waves_of_sum(
    total: SummedPotential, single: AbstractPotential, eps: float
) -> tuple[Any, float]:
    """Harmonics of the sum of `V_eps/eps` in N, and what share of the forces is left."""
    one = _waves_of_one(single, eps)
    numbers = np.arange(1, one.size + 1)
    phases = np.asarray(total.offsets)[:, None] * numbers
    # Whole turns go first: large phases would lose digits.
    turns = np.exp(2j * np.pi * (phases - np.round(phases)))
    weights = np.asarray(total.weights)
    waves = one * (weights @ turns)
    forces = [np.max(np.abs(numbers * each)) for each in (waves, one)]
    return waves, float(forces[0] / (np.sum(weights) * forces[1]))


def _waves_of_one(single: AbstractPotential, eps: float) -> Float[np.ndarray, " n"]:
    """Complex harmonics of one tip's `V_eps/eps` in N, from the first on."""
    count = SETTINGS.sum_places
    values = np.asarray(_energies(single, np.asarray(eps), np.arange(count) / count - 0.5))
    return 2 * np.fft.rfft(np.roll(values, -count // 2))[1 : count // 2] / count
