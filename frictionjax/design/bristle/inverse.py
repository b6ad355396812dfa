"""All numbers of a bristle that give a wanted friction; traceable and differentiable."""

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from ..._checks import Real
from ...bristles import AbstractBristle
from ...numerics import find_root
from ..common import QUANTITIES, FreeParameter, OnSlopes, Slopes, on_slopes, quantity_of
from .admissible import Admissible, first_places
from .settings import SETTINGS
from .status import FitStatus


class Solutions(NamedTuple):
    """What one target gave; a batch has a leading axis.

    `x`: coordinate of the solution nearest to the bristle as it was, of the number that
    comes nearest to the target where there is none. `roots` (roots,): all, increasing,
    NaN where there are fewer. `achieved`: the quantity at `x`; `alpha`: F'(0) there, N.
    `code`: a `FitStatus`.
    """

    x: Real
    roots: Float[Array, " roots"]
    achieved: Real
    alpha: Real
    code: Int[Array, ""]


class PulledParts(NamedTuple):
    """The nearest bristle that pulls and reaches the target; NaN where none was looked for.

    `value` of the free number, and `alpha` < 0 in N.
    """

    value: Real
    alpha: Real


class RootBrackets(NamedTuple):
    """Where the solutions of one target are, (roots,), in the order of their coordinates.

    `there`: whether there is one. `simple`: the quantity crosses the target, from below
    where it `rises`; else it touches it, at `lower`. `side`: sign of alpha in the interval
    that holds it. `number`: of all. `best`: the node
    that comes nearest to the target. `level`: a place in an interval on which the target
    is met throughout, where `constant`.
    """

    lower: Float[Array, " roots"]
    upper: Float[Array, " roots"]
    rises: Bool[Array, " roots"]
    there: Bool[Array, " roots"]
    simple: Bool[Array, " roots"]
    side: Float[Array, " roots"]
    number: Int[Array, ""]
    best: Real
    level: Real
    constant: Bool[Array, ""]


def solve_targets(
    free: FreeParameter,
    bristle: AbstractBristle,
    slopes: Slopes,
    which: Real,
    targets: Float[Array, " n"],
    found: Admissible,
) -> Solutions:
    """Solutions of every target, from the survey of the quantity.

    Differentiable in bristle, slopes and targets by the implicit function theorem.
    """
    still = jax.lax.stop_gradient(bristle)
    now = free.coordinate(still, free.now(still))
    found = jax.lax.stop_gradient(found)
    aims = jax.lax.stop_gradient(targets)
    known = jax.vmap(lambda aim: _brackets(found, aim, now))(aims)

    def law(x: Real) -> OnSlopes:
        return on_slopes(free.at(bristle, x), slopes)

    def quantity(x: Real) -> Real:
        return quantity_of(law(x), which)

    roots = _polished(jax.vmap(jax.vmap(quantity)), targets, known)
    known = _pressing_alike(known, jax.vmap(jax.vmap(lambda x: law(x).alpha))(roots))
    x, roots = jax.vmap(lambda r, k: _chosen(r, k, now))(roots, known)
    ended = jax.vmap(law)(x)
    achieved = jax.vmap(lambda found: quantity_of(found, which))(ended)
    met = _met(jax.lax.stop_gradient(achieved), aims, jax.lax.stop_gradient(ended), which)
    code = jax.vmap(lambda *lane: _code(found, *lane))(known, x, roots, met)
    return Solutions(x, roots, achieved, ended.alpha, code)


def _pressing_alike(known: RootBrackets, alpha: Float[Array, "n roots"]) -> RootBrackets:
    """Without roots at which alpha has another sign than in the interval around them.

    Between two nodes of an interval alpha may dip below 0 unseen.
    """
    lost = known.there & (jnp.sign(alpha) != known.side)
    number = known.number - jnp.sum(lost, axis=-1)
    return known._replace(there=known.there & ~lost, number=number)


def _brackets(found: Admissible, aim: Real, now: Real) -> RootBrackets:
    rest = found.values - aim
    touches = found.turns & (jnp.abs(rest) <= SETTINGS.touch * jnp.abs(aim))
    rest = jnp.where(touches, 0.0, rest)
    cells, count = _cells(rest)
    nodes, sides = found.nodes.ravel(), jnp.sign(rest).ravel()
    lower, there = nodes[cells], cells >= 0
    level, constant = _constant(found, aim, now)
    return RootBrackets(
        lower=lower,
        upper=jnp.where(sides[cells] == 0, lower, jnp.roll(nodes, -1)[cells]),
        rises=sides[cells] < 0,
        there=there,
        simple=there & ~touches.ravel()[cells],
        side=found.side[cells // rest.shape[1]],
        number=count,
        best=nodes[jnp.argmin(jnp.where(jnp.isnan(rest), jnp.inf, jnp.abs(rest)))],
        level=level,
        constant=constant,
    )


def _chosen(roots: Array, known: RootBrackets, now: Real) -> tuple[Real, Array]:
    """The solution nearest to `now`, or what stands for it, and all of them."""
    away = jnp.where(known.there, jnp.abs(roots - now), jnp.inf)
    x = jnp.where(known.number > 0, roots[jnp.argmin(away)], known.best)
    only = jnp.where(jnp.arange(SETTINGS.roots) == 0, known.level, jnp.nan)
    roots = jnp.where(known.constant, only, jnp.where(known.there, roots, jnp.nan))
    return jnp.where(known.constant, known.level, x), roots


def _met(
    achieved: Array, aims: Float[Array, " n"], law: OnSlopes, which: Real
) -> Bool[Array, " n"]:
    """Whether targets are met; a difference is known to rounding of the forces."""
    forces = jnp.maximum(jnp.abs(law.rho_plus), jnp.abs(law.rho_minus))
    forces = jnp.where(which == QUANTITIES.index("difference"), forces, 0.0)
    return jnp.abs(achieved - aims) <= SETTINGS.met * jnp.maximum(jnp.abs(aims), forces)


def _code(found: Admissible, known: RootBrackets, x, roots, met) -> Int[Array, ""]:
    """The `FitStatus` of one target; the first that holds."""
    touched = jnp.any((roots == x) & known.there & ~known.simple)
    ways = (
        (jnp.all(jnp.isnan(found.values)), FitStatus.INADMISSIBLE),
        (known.constant, FitStatus.INDIFFERENT),
        (known.number == 0, FitStatus.UNREACHABLE),
        (~met, FitStatus.ROUNDED),
        (touched, FitStatus.TANGENT),
        ((known.number > SETTINGS.roots) | found.missed, FitStatus.MORE),
    )
    code = jnp.asarray(int(FitStatus.OK))
    for holds, status in reversed(ways):
        code = jnp.where(holds, int(status), code)
    return code


def _cells(rest: Float[Array, "pieces n"]) -> tuple[Int[Array, " roots"], Real]:
    """Flat indices of nodes after which the sign changes, or on which it is 0."""
    sign = jnp.sign(rest)
    crosses = jnp.zeros(sign.shape, bool).at[:, :-1].set(sign[:, :-1] * sign[:, 1:] < 0)
    # A node that stands several times in a row, as the last of an interval, counts once.
    follows = jnp.zeros(sign.shape, bool).at[:, 1:].set(sign[:, :-1] == 0)
    hits = (sign == 0) & ~follows
    found = (crosses | hits).ravel()
    return first_places(found, SETTINGS.roots), jnp.sum(found)


def _polished(quantity: Callable, targets: Array, known: RootBrackets) -> Array:
    """Roots in brackets (n, roots), to rounding; the places of touches as they are.

    All in one loop, differentiated implicitly: their equations do not see each other.
    """
    idle = known.best[:, None]
    side = jnp.where(known.rises, 1.0, -1.0)
    lower = jnp.where(known.simple, known.lower, idle)
    upper = jnp.where(known.simple, known.upper, idle)

    def fn(x: Array) -> Array:
        gap = side * (quantity(jnp.where(known.simple, x, idle)) - targets[:, None])
        return jnp.where(known.simple, gap, x - idle)

    roots = jax.lax.custom_root(
        fn,
        0.5 * (lower + upper),
        lambda fn, _: find_root(fn, lower, upper),
        lambda linear, b: b / linear(jnp.ones_like(b)),
    )
    return jnp.where(known.simple, roots, known.lower)


def _constant(found: Admissible, aim: Real, now: Real) -> tuple[Real, Bool[Array, ""]]:
    """The nearest coordinate in the intervals where the quantity is the target throughout.

    Not at their ends, where alpha may be 0.
    """
    same = found.flat & (jnp.abs(found.values[:, 0] - aim) <= SETTINGS.met * jnp.abs(aim))
    low, high = found.ends.T
    inset = SETTINGS.inset * (high - low)
    inside = (low <= now) & (now <= high)
    place = jnp.where(inside, now, jnp.clip(now, low + inset, high - inset))
    away = jnp.where(same, jnp.abs(place - now), jnp.inf)
    return place[jnp.argmin(away)], jnp.any(same)
