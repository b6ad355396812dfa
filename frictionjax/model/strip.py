"""The strip of states that rest under a load (Section 5.1)."""

import jax
import numpy as np
from jaxtyping import Array, Float

from .._checks import Real
from .._compile import Interpreted, in_chunks, padded_size
from ..loads import AbstractPull
from ..supports import AbstractSupport
from ..tables import load_table
from .scene import Scene
from .settings import SETTINGS
from .tabulated import TabulatedScene


def strip_of(
    support: AbstractSupport, rho_plus: Real, rho_minus: Real, load: Real
) -> tuple[Real, Real]:
    """States in m that rest under `load` (N): `[z_minus, z_plus]`."""
    return support.state_of(load - rho_plus), support.state_of(load - rho_minus)


@Interpreted
def _strips(
    load: AbstractPull,
    support: AbstractSupport,
    rho_plus: Real,
    rho_minus: Real,
    times: Float[Array, " n"],
):
    loads = jax.vmap(load)(times)
    ends = jax.vmap(lambda load: strip_of(support, rho_plus, rho_minus, load))
    return loads, *ends(loads)


def strips_at(
    scene: Scene | TabulatedScene,
    rho_plus: float,
    rho_minus: float,
    times: Float[np.ndarray, " n"],
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    """Load in N, `z_minus` and `z_plus` in m at each time, for known values."""
    if times.size == 0:
        return times, times, times
    rho = np.asarray(rho_plus, dtype=float), np.asarray(rho_minus, dtype=float)
    load = load_table(scene.load) if isinstance(scene, Scene) else scene.load
    fixed = load, scene.support, *rho
    room = min(padded_size(times.size, SETTINGS.times), SETTINGS.most_times)
    loads, lower, upper = in_chunks(_strips, room, fixed, (times,))
    return loads, lower, upper
