"""What a motion under a force dissipates at least: M, with its K, and M_eps."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .._checks import as_jax, is_concrete, require_numbers, with_nan
from .._compile import Program, padded_size
from ..model import AbstractPotential, cancels, potential_at_rest
from .dissipation import (
    is_held,
    law_of,
    numbers_as_given,
    require_shapes,
    viscosity_as_given,
)
from .settings import SETTINGS
from .well_variation import well_variation


@Program
def _variations(
    potential: AbstractPotential, xi: Float[Array, "rows together"]
) -> Float[Array, "rows together"]:
    return jax.lax.map(jax.vmap(lambda force: well_variation(potential, force)), xi)


def mean_resistance(
    potential: AbstractPotential, xi: Float[Array, "*xi"]
) -> Float[Array, "*xi"]:
    """`K` of a potential, at forces in N of any shape: one program for all of them."""
    if is_concrete(potential) and cancels(potential):
        return jnp.abs(xi)
    by: Any = np if is_concrete(xi) else jnp
    count, shape = by.size(xi), by.shape(xi)
    room = padded_size(max(count, 1), SETTINGS.together)
    rows = by.pad(by.ravel(xi), (0, room - count)).reshape(-1, SETTINGS.together)
    found = _variations(potential_at_rest(potential), rows)
    if is_concrete(found):
        return as_jax(np.asarray(found).ravel()[:count].reshape(shape))
    return found.ravel()[:count].reshape(shape)


@with_nan
def K(scene: Any, xi: Any) -> Float[Array, "*xi"]:
    """`K(xi) = int_0^1 |xi - W'(Y)| dY` in N (eq. 5.4), exact but for rounding.

    `xi`: forces in N, any shape. Returns what friction of the `scene` takes at least, of
    each metre, under the force xi, of its shape: more than |xi| inside (rho_minus,
    rho_plus), |xi| outside. Differentiable in both, once: the slope by xi is the share of a
    period where W' is below xi, minus that where it is above.

    Raises `ValueError` as `R`.

    >>> print(fx.principle.K(scene, [0.0, 0.1, 0.2]).round(4))
    [0.0647 0.104  0.2   ]
    """
    (xi,) = numbers_as_given(xi=xi)
    scene, _ = law_of(scene)
    return mean_resistance(scene.potential, xi)


@with_nan
def M(
    scene: Any, v: Any, xi: Any, slack: Any = 0.0, load: Any = 0.0
) -> Float[Array, "..."]:
    """`M(v, xi) = |v| K(xi) + chi(xi)` (eq. 5.3) in W, infinite outside the rho interval.

    Velocities `v` in m/s and forces `xi` in N, shapes that broadcast. Returns W, what
    friction of the `scene` takes at least. `M >= v xi`, and both are the same where
    friction allows the motion v under the force xi, on the graph C_M (eq. 5.5), and nowhere
    else.

    On a slide xi = l - Phi'(z) is rho but for rounding, so the interval is wider by 1e-10
    of itself, and by `slack` in N. `load`: l in N, of which xi is what is left; above
    1e5 rho it leaves more of rounding in xi than that, which is allowed for then. K is
    that of the nearest xi inside.

    Raises `ValueError` as `R`.

    >>> rho = fx.friction(scene).rho_plus
    >>> print(fx.principle.M(scene, [1.0, 1.0, 0.0], [rho, 0.1, 0.2]).round(4))
    [0.1204 0.104     inf]
    """
    v, xi, slack, load = numbers_as_given(v=v, xi=xi, slack=slack, load=load)
    require_shapes(v=v, xi=xi, slack=slack, load=load)
    require_numbers("slack", slack, "slack >= 0", lambda s: s >= 0)
    scene, law = law_of(scene)
    held = jnp.clip(xi, law.rho_minus, law.rho_plus)
    least = jnp.abs(v) * mean_resistance(scene.potential, held)
    return jnp.where(is_held(law, xi, slack, load), least, jnp.inf)


@with_nan
def M_eps(v: Any, xi: Any, eps: Any, gamma: Any) -> Float[Array, "..."]:
    """`M_eps(v, xi) = R_eps(v) + R_eps*(xi)` (eq. 5.1) in W.

    Velocities `v` in m/s, forces `xi` in N, `eps` in m, `gamma` > 0: shapes that
    broadcast. Returns W. `M_eps >= v xi`, the same where `xi = eps^gamma v`, and nowhere
    else.

    Raises `ValueError` as `R_eps`.

    >>> print(fx.principle.M_eps(2.0, 0.02, eps=0.01, gamma=1.0))
    0.04
    """
    v, xi = numbers_as_given(v=v, xi=xi)
    viscosity = viscosity_as_given(eps, gamma)
    require_shapes(v=v, xi=xi, eps=eps, gamma=gamma)
    return viscosity * v**2 / 2 + xi**2 / (2 * viscosity)
