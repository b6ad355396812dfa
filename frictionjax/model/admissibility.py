"""The hypotheses of the paper, checked where values are known and named where they fail."""

import math
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Bool, Float

from .._checks import Real, is_concrete, no_more, require
from .._compile import Interpreted, in_chunks, once_a_scene
from ..bristles import AbstractBristle
from ..coefficients import Coefficients
from ..numerics import smallest
from ..supports import AbstractSupport
from .clearance import clearance
from .friction_coefficients import coefficients, coefficients_jit
from .given_rest import require_given
from .potentials import AbstractPotential, BristlePotential, smallest_stretch
from .settings import SETTINGS
from .summed_potential import SummedPotential
from .tabulated_potential import potential_in_reach

_EPS64 = float(np.finfo(np.float64).eps)


def _bristle_facts_of(bristle: AbstractBristle) -> tuple[Any, Any, Real]:
    bounds = bristle.slope_bounds()
    return bounds.lower, bounds.upper, rounding_of_alpha(bristle)


_bristle_facts = Interpreted(_bristle_facts_of)


def rounding_of_alpha(bristle: AbstractBristle) -> Real:
    """Lengths cancel in alpha, for instance k (L_rest - h): this much of it is rounding."""
    curvature = jax.grad(jax.grad(bristle.energy))(jnp.zeros(()))
    return 4 * _EPS64 * jnp.abs(curvature) * getattr(bristle, "height", 0.0)


def require_admissible(potential: AbstractPotential) -> None:
    """Check what Theorem 1 and Lemmas 2 and 3 ask of surface and bristle, for eps -> 0.

    Raises `ValueError`: no slope of either sign, `alpha = 0`, `1 + a omega <= 0` at an
    end, or a slope outside what the bristle's contact allows.
    """
    if isinstance(potential, BristlePotential) and is_concrete(potential):
        _require_coefficients(potential, coefficients_jit(potential))


def admissible_coefficients(potential: AbstractPotential) -> Coefficients:
    """The coefficients, of what `require_admissible` accepts."""
    found = coefficients_jit(potential)
    if isinstance(potential, BristlePotential) and is_concrete(potential):
        _require_coefficients(potential, found)
    return found


def _require_coefficients(potential: BristlePotential, found: Coefficients) -> None:
    read = found, _bristle_facts(potential.bristle)
    found, (lower, upper, noise) = jax.tree_util.tree_map(float, read)
    low, high = found.omega_minus, found.omega_plus
    slopes = f"omega_minus = {low:.6g}, omega_plus = {high:.6g}"
    require(low < 0 < high, "profile", slopes, "omega_plus > 0 > omega_minus")
    _require_alpha(found.alpha, noise)
    _require_slopes(potential, found, lower, upper)


def _require_alpha(alpha: float, noise: float) -> None:
    needs = "alpha = F'(0) != 0 (the bristle must press on the surface)"
    known = math.isfinite(alpha) and abs(alpha) > noise
    require(known, "bristle: alpha", alpha, needs)


def _require_slopes(
    potential: BristlePotential, found: Any, lower: float, upper: float
) -> None:
    low, high, a = found.omega_minus, found.omega_plus, found.a
    if lower < low < high < upper and min(1 + a * low, 1 + a * high) > 0:
        return
    # The names alone: computing the bounds op by op takes 0.1 s, the first time.
    named = eqx.filter_eval_shape(potential.bristle.slope_bounds)
    lower_name, upper_name = named.lower_name, named.upper_name
    name, value = _culprit(potential)
    needs = f"omega_plus < {upper_name}, but {high:.6g} >= {upper:.6g}"
    require(high < upper, name, value, needs)
    needs = f"omega_minus > {lower_name}, but {low:.6g} <= {lower:.6g}"
    require(low > lower, name, value, needs)
    for label, omega in (("omega_plus", high), ("omega_minus", low)):
        stretch = 1 + a * omega
        needs = f"1 + a {label} > 0, but a = {a:.6g}, {label} = {omega:.6g}"
        require(stretch > 0, name, value, needs)


def _culprit(potential: BristlePotential) -> tuple[str, object]:
    """The argument to name: the bristle's angle where it has one."""
    bristle = potential.bristle
    if hasattr(bristle, "limit_angle"):
        return "bristle.theta_lim", bristle.limit_angle
    if hasattr(bristle, "angle"):
        return "bristle.angle", bristle.angle
    return "bristle", type(bristle).__name__


def _margins_at(potential: AbstractPotential, eps: Real) -> tuple[Real, Real]:
    """Smallest G, and how far a rod is from cutting the surface, at one eps."""
    return smallest_stretch(potential, eps), clearance(potential, eps)


_one_margin = once_a_scene(_margins_at)


@once_a_scene
def _some_margins(potential: AbstractPotential, eps: Float[Array, " few"]):
    return jax.lax.map(lambda size: _margins_at(potential, size), eps)


def _margins(
    potential: AbstractPotential, eps: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    near = potential_in_reach(potential, np.max(eps))
    return in_chunks(_some_margins, SETTINGS.margins, (near,), (eps,))


def _one_of(potential: AbstractPotential) -> AbstractPotential:
    """A potential of one tip: of several all reach where one does."""
    while isinstance(potential, SummedPotential):
        potential = potential.single
    return potential


def reaches(potential: AbstractPotential, eps: np.ndarray) -> np.ndarray:
    """Whether a bristle follows the surface at each eps (m), as `require_reach` asks."""
    potential = _one_of(potential)
    if not isinstance(potential, BristlePotential):  # no tip beside z: G = 1
        return np.ones(np.shape(eps), dtype=bool)
    stretch, clear = _margins(potential, eps)
    return (stretch > 0) & (clear > 0)


def is_admitted(potential: BristlePotential, eps: Real) -> Bool[Array, ""]:
    """Whether `require_admissible` and `require_reach` accept a bristle, of traced numbers.

    What is not finite is not accepted.
    """
    found = coefficients(potential)
    lower, upper, noise = _bristle_facts_of(potential.bristle)
    stretch, clear = _margins_at(potential, eps)
    low, high, a = found.omega_minus, found.omega_plus, found.a
    good = [
        (low < 0) & (high > 0),
        jnp.isfinite(found.alpha) & (jnp.abs(found.alpha) > noise),
        (lower < low) & (high < upper),
        jnp.minimum(1 + a * low, 1 + a * high) > 0,
        (stretch > 0) & (clear > 0),
    ]
    return jnp.all(jnp.stack(good))


def require_reach(potential: AbstractPotential, eps: Float[ArrayLike, "*shape"]) -> None:
    """Check what has to hold at the eps in use, with the bristle's geometry there.

    `G = 1 + A'(eta) w' > 0` (eq. 3.22), and of a rod that only its tip touches the surface,
    `w' < cot(theta)` of Section 3.3 at the angle in use; of a `GivenPotential` that W and Q
    keep their digits, and that Q is 1-periodic and bounded. Raises `ValueError` with the
    eps below which it holds.
    """
    if not is_concrete(potential, eps):
        return
    potential = _one_of(potential)
    sizes = np.unique(np.asarray(eps, dtype=float))
    fits = reaches(potential, sizes)
    if np.all(fits):
        require_given(potential, sizes)
        return
    worst = float(sizes[~fits][0])
    limit = largest_eps(potential, worst)
    stretch = float(_margins(potential, np.array([worst]))[0][0])
    fails = "the rod cuts the surface" if stretch > 0 else "G = dz/dp > 0 fails"
    require(False, "eps", worst, f"eps < {no_more(limit)}, where {fails}")


def largest_eps(potential: AbstractPotential, upper: float) -> float:
    """Largest eps below `upper` up to which G > 0 and a rod clears; 0.0 if there is none.

    A scan over 12 decades for the first failure, then bisection in log eps.
    """
    grid = np.geomspace(1e-12 * upper, upper, 241)
    fails = ~reaches(potential, grid)
    if not fails.any():
        return upper
    first = int(np.argmax(fails))
    if first == 0:
        return 0.0
    low, high = float(grid[first - 1]), float(grid[first])
    while high / low > 1 + 1e-9:
        middle = math.sqrt(low * high)
        if min(map(float, _one_margin(potential, np.asarray(middle)))) > 0:
            low = middle
        else:
            high = middle
    return low


@Interpreted
def _range_and_convexity(support: AbstractSupport, low: Real, high: Real):
    ends = jax.vmap(support.state_of)(jnp.stack([low, high]))
    width = (ends[1] - ends[0]) / 1024
    grid = ends[0] + width * jnp.arange(1025)
    coarse = jax.vmap(support.stiffness_at)(grid)
    fine = grid[jnp.argmin(coarse)] + width * jnp.linspace(-1.0, 1.0, 1025)
    finer = jax.vmap(support.stiffness_at)(jnp.clip(fine, ends[0], ends[1]))
    least = smallest(jnp.concatenate([coarse, finer]))
    return ends, least, jnp.max(coarse), jax.vmap(support.force)(ends)


@Interpreted
def _bends(support: AbstractSupport, z: Array) -> tuple[Array, Array]:
    return jax.vmap(support.stiffness_at)(z), jax.vmap(support.force)(z)


def _out_of_reach(support: AbstractSupport, wanted: np.ndarray, found: np.ndarray) -> str:
    """What of a support does not reach forces: where `Phi'' <= 0` next to 0, or `Phi'`."""
    far = np.geomspace(*SETTINGS.bend_places)
    z = np.concatenate([[0.0], np.stack([far, -far], axis=1).ravel()])
    bend, force = (np.asarray(column) for column in _bends(support, z))
    if np.any(bend <= 0):
        k = int(np.argmax(bend <= 0))
        return f"Phi'' = {bend[k]:.6g} N/m at z = {z[k]:.6g} m"
    force = force[np.isfinite(force)]
    least, most = np.min(force, initial=np.inf), np.max(force, initial=-np.inf)
    if least <= wanted[0] and most >= wanted[1]:
        return f"Phi'(state_of) = [{found[0]:.6g}, {found[1]:.6g}]"
    return f"Phi' in [{least:.6g}, {most:.6g}] N for |z| <= {far[-1]:.6g} m"


def require_convex(support: AbstractSupport, low: Any, high: Any) -> None:
    """Check `Phi'' > 0` on the states that forces between `low` and `high` (N) reach.

    Raises `ValueError` where `Phi` is not uniformly convex there, or where `Phi'` does
    not reach those forces at all.
    """
    if not is_concrete(support, low, high):
        return
    wanted = np.array([float(low), float(high)])
    found = _range_and_convexity(support, *wanted)
    ends, least, largest, forces = (np.asarray(column) for column in found)
    size = max(1e-300, float(np.max(np.abs(wanted))))
    reached = np.all(np.abs(forces - wanted) <= 1e-6 * size)
    if not (np.all(np.isfinite(ends)) and reached):
        forces_wanted = f"[{wanted[0]:.6g}, {wanted[1]:.6g}]"
        needs = f"Phi uniformly convex and Phi' to reach the forces {forces_wanted}"
        require(False, "support", _out_of_reach(support, wanted, forces), needs)
    span = f"[{ends[0]:.6g}, {ends[1]:.6g}]"
    needs = f"Phi uniformly convex on the range reached, z in {span}"
    require(float(least) > 1e-9 * float(largest), "support: min Phi''", least, needs)
