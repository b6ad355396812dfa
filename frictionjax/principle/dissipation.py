"""What friction dissipates, and what viscosity: both potentials, and their duals."""

from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .._checks import (
    Real,
    is_concrete,
    require,
    require_numbers,
    require_x64,
    with_nan,
)
from ..coefficients import Coefficients
from ..model import (
    SETTINGS,
    Scene,
    coefficients_jit,
    composed,
    dissipation_potential,
    known_scene,
)

_SPACING = float(np.finfo(np.float64).eps)


def numbers_as_given(**given: Any) -> list[Array]:
    """Each of some arguments as an array of floats; `ValueError` where it holds others."""
    for name, value in given.items():
        require_numbers(name, value, "finite numbers, of any shape", np.isfinite)
    require_x64()
    return [jnp.asarray(value, dtype=float) for value in given.values()]


def require_shapes(**given: Any) -> None:
    """Raise `ValueError` for arguments whose shapes do not broadcast."""
    shapes = {name: np.shape(value) for name, value in given.items()}
    try:
        np.broadcast_shapes(*shapes.values())
    except ValueError:
        told = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        require(False, "shapes", told, "shapes that broadcast")


def viscosity_as_given(eps: Any, gamma: Any) -> Array:
    """`eps^gamma` in N s/m of one eps and gamma, or of arrays that broadcast."""
    for name, value in (("eps", eps), ("gamma", gamma)):
        allowed = f"{name} > 0, a number or an array"
        require_numbers(name, value, allowed, lambda v: v > 0)
    require_shapes(eps=eps, gamma=gamma)
    eps, gamma = numbers_as_given(eps=eps, gamma=gamma)
    return eps**gamma


def law_of(scene: Any) -> tuple[Scene, Coefficients]:
    """A scene as its limit sees it, and its coefficients of friction."""
    scene = composed(known_scene(scene))
    return scene, coefficients_jit(scene.potential)


def is_held(
    found: Coefficients, xi: Real, slack: Real | float = 0.0, load: Real | float = 0.0
) -> Array:
    """Whether forces xi (N) are inside the rho interval, but for rounding.

    On a slide xi = l - Phi'(z) is rho but for rounding, so the interval is wider by
    1e-10 (rho_plus - rho_minus), and by `slack` N. `load`: l in N, of which xi is what is
    left: eight spacings of floats at l and at Phi' = l - xi are added, which are more than
    that where l is 1e5 rho or larger. From xi alone nobody can tell: without `load`, and
    for a Phi' that is itself a difference of large forces, `slack` has to.
    """
    given = found.rho_plus, found.rho_minus, xi, slack, load
    by: Any = np if is_concrete(given) else jnp  # JAX compiles steps at each new shape
    plus, minus, force, more, pull = map(by.asarray, given)
    size = by.maximum(by.abs(pull), by.abs(pull - force))
    lost = by.where(pull == 0, 0.0, SETTINGS.spacings * _SPACING * size)
    more = more + lost + SETTINGS.slack * (plus - minus)
    return by.asarray((force >= minus - more) & (force <= plus + more))


@with_nan
def R(scene: Scene, v: Any) -> Float[Array, "*v"]:
    """`R(v)` (eq. 2.2): `rho_plus v` for v >= 0, `rho_minus v` for v <= 0.

    Returns what friction of a `scene` dissipates in W at velocities `v` in m/s, of their
    shape, any; differentiable in both.

    Raises `ValueError` for velocities that are no finite numbers, and what `friction`
    raises.

    >>> print(fx.principle.R(scene, [-1.0, 0.0, 2.0]).round(4))
    [0.0879 0.     0.2408]
    """
    (v,) = numbers_as_given(v=v)
    _, law = law_of(scene)
    return dissipation_potential(law.rho_plus, law.rho_minus, v)


@with_nan
def R_star(scene: Scene, xi: Any) -> Float[Array, "*xi"]:
    """`R*(xi)`, the dual of R of a `scene`: 0 in [rho_minus, rho_plus], infinite outside.

    `xi`: forces in N. Returns W, of their shape, any. Inside means but for rounding, 1e-10
    of the interval.

    Raises `ValueError` as `R`.

    >>> print(fx.principle.R_star(scene, [0.1, 0.13]))
    [ 0. inf]
    """
    (xi,) = numbers_as_given(xi=xi)
    _, law = law_of(scene)
    return jnp.where(is_held(law, xi), 0.0, jnp.inf)


@with_nan
def R_eps(v: Any, eps: Any, gamma: Any) -> Float[Array, "..."]:
    """`R_eps(v) = eps^gamma v^2/2` in W (eq. 2.7) of velocities `v` in m/s.

    `eps` in m, `gamma` > 0: shapes that broadcast. Returns W; a motion dissipates twice
    that.

    Raises `ValueError` for what are no finite numbers, or not > 0.

    >>> print(fx.principle.R_eps(2.0, eps=0.01, gamma=1.0))
    0.02
    """
    viscosity, (v,) = viscosity_as_given(eps, gamma), numbers_as_given(v=v)
    require_shapes(v=v, eps=eps, gamma=gamma)
    return viscosity * v**2 / 2


@with_nan
def R_eps_star(xi: Any, eps: Any, gamma: Any) -> Float[Array, "..."]:
    """`R_eps*(xi) = xi^2/(2 eps^gamma)` in W, the dual of R_eps (eq. 5.1).

    `xi`: forces in N, `eps` in m, `gamma` > 0: shapes that broadcast. Returns W.

    Raises `ValueError` as `R_eps`.

    >>> print(fx.principle.R_eps_star(0.02, eps=0.01, gamma=1.0))
    0.02
    """
    viscosity, (xi,) = viscosity_as_given(eps, gamma), numbers_as_given(xi=xi)
    require_shapes(xi=xi, eps=eps, gamma=gamma)
    return xi**2 / (2 * viscosity)
