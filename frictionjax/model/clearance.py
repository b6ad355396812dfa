"""Whether a straight rod clears the surface ahead of its tip (Section 3.3)."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from .._checks import Real
from ..bristles import Rod
from ..numerics import smallest
from .potentials import AbstractPotential, BristlePotential
from .settings import SETTINGS


def clearance(potential: AbstractPotential, eps: Real) -> Real:
    """Smallest slope, over a period of tips, by which the rod rises above all secants.

    `cot(theta(y)) - max_s (w(y + s) - w(y))/s` for s up to the root; w' itself at s = 0.
    Infinite where the bristle is no rod, NaN where it does not reach. The paper asks
    `w' < cot(theta_lim)`, which is enough for eps -> 0; at the eps in use the angle differs
    from place to place.
    """
    if not isinstance(potential, BristlePotential):
        return jnp.asarray(jnp.inf)
    if potential.bristle.rod(jnp.zeros(())) is None:
        return jnp.asarray(jnp.inf)
    fine = jnp.arange(potential.points) / potential.points
    heights, slopes = jax.jvp(potential.profile, (fine,), (jnp.ones(fine.shape),))
    rods = _rods(potential, eps * heights).slope
    # Secants are no steeper than the steepest slope: mostly enough, at 1/100 of the time.
    enough = smallest(rods) - jnp.max(slopes)

    def exact() -> Real:
        return jnp.minimum(smallest(rods - slopes), _ahead(potential, eps))

    return jax.lax.cond(enough > 0, lambda: enough, exact)


def _rods(potential: BristlePotential, heights: Float[Array, " n"]) -> Rod:
    rods = jax.vmap(potential.bristle.rod)(heights)
    assert rods is not None
    return rods


def _ahead(potential: BristlePotential, eps: Real) -> Real:
    """The same for secants over 1/512 of a period and more."""
    places = SETTINGS.clearance_places
    heights = potential.profile(jnp.arange(places) / places)
    rods = _rods(potential, eps * heights)
    steps = jnp.arange(1, places + 1)[None]
    ahead = heights[(jnp.arange(places)[:, None] + steps) % places]
    secants = (ahead - heights[:, None]) * places / steps
    under = eps * steps / places <= rods.reach[:, None]
    steepest = jnp.max(jnp.where(under, secants, -jnp.inf), axis=1)
    return smallest(rods.slope - steepest)
