"""Several tips on one root as one surface, at one eps."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Complex, Float

from .._checks import Real, as_real, require
from .._compile import Interpreted, in_chunks
from ..bristles import Homothetic
from ..profiles import AbstractProfile, Fourier
from ..tables import (
    PiecewiseProfile,
    TipStates,
    profile_kinks,
    room_of_waves,
    summed_in_pieces,
    waves_in_pieces,
)
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
    the potential of one tip, as planning evaluates it. Of a short series the harmonics are
    each multiplied by the sum over all phases, so that a hundred thousand tips cost what
    two do. What else there is goes in pieces, which end where those of a tip do.

    Raises `ValueError` where so little of the tips' forces is left that it is rounding,
    and where no table holds the sum.
    """
    waves, share = _waves_of_sum(total, single, eps)
    needs = f"phases of which more than {SETTINGS.sum_left:g} of the forces is left"
    require(share > SETTINGS.sum_left, "effects.RigidArray: share left", share, needs)
    found = _in_short_series(waves) or _in_table(total, single, eps)
    found = found or _in_series(waves, SETTINGS.sum_far)
    if found is None:
        tips = f"effects.RigidArray: tips = {total.offsets.size}"
        raise ValueError(f"{tips}: needs fewer tips, or corners less sharp")
    return BristlePotential(found, Homothetic(jnp.asarray(1.0)))


def _in_short_series(waves: Complex[np.ndarray, " n"]) -> Fourier | None:
    """The sum by its harmonics where these are few."""
    found = _in_series(waves, SETTINGS.sum_beyond)
    few = found is not None and found.cos.shape[0] <= SETTINGS.sum_harmonics
    return found if few else None


def _in_series(waves: Complex[np.ndarray, " n"], most: float) -> Fourier | None:
    """The sum by its harmonics; None where more than `most` may lie beyond the last one.

    Of corners it does: cut off, they overshot rho of a ratchet by 11 and 35%, of a surface
    of 256 heights by 0.1%, and of 60 harmonics under a leaning bristle 5% were missing.
    """
    if _share_beyond(waves) > most:
        return None
    kept = np.abs(waves) > SETTINGS.sum_negligible * np.max(np.abs(waves))
    size = int(np.max(np.flatnonzero(kept))) + 1
    cos, sin = as_real(waves.real[:size]), as_real(-waves.imag[:size])
    return Fourier(cos=cos, sin=sin)


def _share_beyond(waves: Complex[np.ndarray, " n"]) -> float:
    """Forces of the upper half of the harmonics, of the largest: what lies beyond is less.

    Of kinks in W'' the forces of all that follow a harmonic are 3/7 of those of the last
    octave before it.
    """
    forces = np.abs(waves) * np.arange(1, waves.size + 1)
    return float(np.sum(forces[waves.size // 2 :]) / np.max(forces))


def _in_table(
    total: SummedPotential, single: AbstractPotential, eps: float
) -> AbstractProfile | None:
    """The sum in pieces; None where tables have no room.

    Pieces end at kinks of each tip, or cut a long series evenly, of which sums over many
    tips cost nothing, and which does not end where there are kinks.
    """
    kinks = np.zeros(0)
    if isinstance(single, BristlePotential):
        profile = single.profile
        kinks = profile_kinks(profile) if isinstance(profile, PiecewiseProfile) else kinks
    if not kinks.size:
        return _in_long_series(total, single, eps)
    size = np.asarray(eps or SETTINGS.sum_at_rest)

    def at_tips(y: np.ndarray) -> TipStates:
        return in_chunks(_tips, SETTINGS.sum_places, (single, size), (y,))

    phases = np.asarray(total.offsets), np.asarray(total.weights)
    return summed_in_pieces(at_tips, kinks, *phases, total.points)


def _in_long_series(
    total: SummedPotential, single: AbstractPotential, eps: float
) -> AbstractProfile | None:
    for places in SETTINGS.sum_finer:
        waves, _ = _waves_of_sum(total, single, eps, places)
        if _share_beyond(waves) <= SETTINGS.sum_beyond:
            waves = waves[: places // 4]
            largest = np.max(np.abs(waves) * np.arange(1, waves.size + 1))
            room = room_of_waves(waves, SETTINGS.sum_beyond * float(largest))
            return None if room is None else waves_in_pieces(0.0, waves, places, room)
    return None


@Interpreted
def _tips(potential: AbstractPotential, eps: Real, y: Array) -> Any:
    """States of one tip in periods, and its `V_eps/eps` in N, at tip coordinates."""

    def force(y: Array) -> tuple[Array, Array, Array]:
        return jax.vmap(lambda s: potential.at_tip(s, eps))(y)

    (slope, stretch, offset), (rise, *_) = jax.jvp(force, (y,), (jnp.ones_like(y),))
    height: Any = jax.vmap(lambda s: potential.tip_energy(s, eps))(y) / eps
    return TipStates(y + offset / eps, stretch, height, slope, rise / stretch)


def leaves_nothing(total: SummedPotential, single: AbstractPotential) -> bool:
    """Whether the forces of the tips cancel for eps -> 0, up to rounding."""
    return _waves_of_sum(total, single, 0.0)[1] <= SETTINGS.sum_left


def _waves_of_sum(
    total: SummedPotential,
    single: AbstractPotential,
    eps: float,
    places: int = SETTINGS.sum_places,
) -> tuple[Any, float]:
    """Harmonics of the sum of `V_eps/eps` in N, and what share of the forces is left."""
    one = _waves_of_one(single, eps, places)
    numbers = np.arange(1, one.size + 1)
    phases = np.asarray(total.offsets)[:, None] * numbers
    # Whole turns go first: large phases would lose digits.
    turns = np.exp(2j * np.pi * (phases - np.round(phases)))
    weights = np.asarray(total.weights)
    waves = one * (weights @ turns)
    forces = [np.max(np.abs(numbers * each)) for each in (waves, one)]
    return waves, float(forces[0] / (np.sum(weights) * forces[1]))


def _waves_of_one(
    single: AbstractPotential, eps: float, count: int
) -> Float[np.ndarray, " n"]:
    """Complex harmonics of one tip's `V_eps/eps` in N, from the first on."""
    fixed, size = (single, np.asarray(eps)), SETTINGS.sum_places
    values = in_chunks(_energies, size, fixed, (np.arange(count) / count - 0.5,))
    return 2 * np.fft.rfft(np.roll(values, -count // 2))[1 : count // 2] / count
