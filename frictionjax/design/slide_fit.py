"""Inverse design at finite eps: the bristle whose steady slide has a wanted friction."""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from scipy.optimize import brentq

from ..admissibility import require_reach
from ..arguments import (
    Real,
    as_real,
    as_text,
    is_concrete,
    require,
    require_real,
)
from ..bristles import AbstractBristle
from ..potentials import BristlePotential
from ..profiles import AbstractProfile
from ..programs import Program
from ..supports import Spring
from .angle import fit_angle
from .angle_fit import AngleFit, intervals_text
from .fit_json import written
from .fit_status import FitStatus
from .free_parameter import free_parameter
from .quantities import QUANTITIES, quantity_of
from .slide_json import dump, fields
from .steady_slide import (
    SlideForces,
    SteadySlide,
    forces_at,
    forces_of,
    require_force,
    spring_of,
    steady_slide,
)

_SCAN = 33  # values of an admissible interval at which slides are integrated
_MARGIN = 1e-3  # of an interval: nearer to its ends forces have poles, or G > 0 fails
_WIDTH = 1e-13


class SlideFit(eqx.Module):
    """A bristle whose steady slide at `eps` gives a wanted quantity.

    As `AngleFit`, with the quantity made of the slide's forces, `force` "mean" or "peak":
    `value`, `achieved`, `target`, `solutions` (all that a scan of 33 values an interval
    tells apart), `reachable` (intervals, 2): least and largest quantity of that scan.
    `failed` (n,): values of it at which there is a bristle but its slide was not found;
    without a solution the status is then UNKNOWN, not UNREACHABLE. `slide`: of the bristle
    returned. `by_target`: d value/d target. `limit`: the fit for eps -> 0.
    """

    bristle: AbstractBristle
    value: Real
    achieved: Real
    target: Real
    solutions: Real
    reachable: Real
    failed: Real
    by_target: Real
    slide: SteadySlide
    limit: AngleFit
    status: FitStatus = eqx.field(static=True)
    force: str = eqx.field(static=True)

    @property
    def success(self) -> bool:
        """Whether the slide gives what was asked for."""
        return self.status == FitStatus.OK

    @property
    def message(self) -> str:
        """Why, for people."""
        limit = self.limit
        asked = f"{limit.quantity} = {as_text(self.target)} of {self.force} forces"
        asked += f" at eps = {as_text(self.slide.eps)}"
        value = f"{limit.free} = {as_text(self.value)}"
        if self.status == FitStatus.UNREACHABLE:
            return (
                f"{asked} cannot be reached by {limit.free}: steady slides show "
                f"{intervals_text(self.reachable)}; nearest: {as_text(self.achieved)} "
                f"at {value}"
            )
        if self.status == FitStatus.UNKNOWN:
            count, first = self.failed.shape[0], as_text(self.failed[0])
            known = intervals_text(self.reachable)
            shown = f"others show {known}" if known else "no other is known"
            return (
                f"{asked}: {self.status.message}: {count} slides were not computed, the "
                f"first at {limit.free} = {first}; {shown}"
            )
        return f"{asked}: {self.status.message}, {value}"

    def to_json(self, path: Any = None) -> str:
        """Everything as JSON; written to `path` where given."""
        return written(dump(self), path)

    @classmethod
    def from_json(cls, source: Any) -> "SlideFit":
        """The result again, from the text or the path of its JSON.

        A bristle or a surface given as functions is None. Raises `ValueError` for what is
        no such JSON.
        """
        return cls(**fields(source))

    def __repr__(self) -> str:
        return f"SlideFit({self.message})"


def _forces_at(free, bristle, profile, value, numbers) -> SlideForces:
    part = free.put(bristle, value)
    return forces_at(BristlePotential(profile, part), *numbers)


@Program
def _quantities(free, bristle, profile, which, values, numbers):
    """The quantity at values (n,) of the number, NaN where there is no slide.

    And whether the bristle follows the surface at this eps: G > 0.
    """

    def one(value):
        forces = _forces_at(free, bristle, profile, value, numbers)
        wiggle = BristlePotential(profile, free.put(bristle, value))
        grid = jnp.arange(wiggle.points) / wiggle.points
        stretch = jax.vmap(lambda y: wiggle.tip_force(y, numbers[1])[1])(grid)
        known = jnp.where(forces.good, quantity_of(forces, which), jnp.nan)
        return known, jnp.all(stretch > 0)

    return jax.vmap(one)(values)


@Program
def _slope(free, bristle, profile, which, value, numbers):
    def one(value):
        return quantity_of(_forces_at(free, bristle, profile, value, numbers), which)

    return jax.jvp(one, (value,), (jnp.ones_like(value),))[1]


def fit_slide(
    profile: AbstractProfile,
    bristle: AbstractBristle,
    eps: Any,
    gamma: Any = 1.0,
    rate: Any = 1.0,
    support: Spring | None = None,
    force: str = "mean",
    **wanted: Any,
) -> SlideFit:
    """The bristle whose steady slide at `eps` (m) has a wanted friction.

    `gamma`, `rate` (N/s), `support`: as in `steady_slide`. `force`: "mean", over time, or
    "peak", the largest. `wanted`: one target (`rho_plus`, `rho_minus`, `ratio` or
    `difference`, of these forces), `free` and `bounds`, as in `fit_angle`. The admissible
    intervals of the limit are scanned, and each change of sign is polished by
    `scipy.optimize.brentq`: a slide takes 10 ms, so this takes about a second, not a
    millisecond. `.status` tells what no bristle reaches from what could not be evaluated
    (`UNKNOWN`).

    Raises `ValueError` as `fit_angle` and `steady_slide` do, and for several targets.
    """
    support = spring_of(support)
    require_force(force)
    for name, value in (("eps", eps), ("gamma", gamma), ("rate", rate)):
        require_real(name, value, f"{name} > 0", lambda v: v > 0)
    limit = fit_angle(profile, bristle, **wanted)
    require(is_concrete(limit), "targets", "traced", "known numbers: this is a search")
    require(limit.code.ndim == 0, limit.quantity, limit.target, "one number")
    scene = (as_real(v) for v in (eps, gamma, rate, support.stiffness))
    numbers = (np.asarray(force == "peak"), *scene)
    free = free_parameter(limit.bristle, limit.free)
    which = np.asarray(QUANTITIES.index(limit.quantity))
    target = float(limit.target)

    def quantities(values):
        found = _quantities(free, limit.bristle, profile, which, values, numbers)
        return np.asarray(found[0]), np.asarray(found[1])

    ends = np.asarray(limit.admissible)
    ends = ends[~np.isnan(ends[:, 0])]
    shares = _MARGIN + (1 - 2 * _MARGIN) * np.linspace(0, 1, _SCAN)
    grid = ends[:, :1] + (ends[:, 1:] - ends[:, :1]) * shares
    scan = [quantities(row) for row in grid]
    values, follows = (np.stack(parts) for parts in zip(*scan, strict=True))
    require(follows.any(), "eps", eps, "an eps at which some bristle slides (G > 0)")
    roots = _roots(quantities, grid, values, target)
    known = ~np.isnan(values).all(axis=1)
    failed = grid[np.isnan(values) & follows]
    status = FitStatus.UNKNOWN if failed.size else FitStatus.UNREACHABLE
    now = float(free_parameter(bristle, limit.free).now(bristle))
    at = _nearest(grid, values, target) if known.any() else float(failed[0])
    if roots.size:
        status = FitStatus.OK
        at = float(roots[np.argmin(np.abs(roots - now))])
    part = free.put(limit.bristle, jnp.asarray(at))
    require_reach(BristlePotential(profile, part), numbers[1])
    slide = steady_slide(profile, part, eps, gamma, rate, support)
    achieved = quantity_of(forces_of(slide, force), which)
    by = 1 / _slope(free, limit.bristle, profile, which, jnp.asarray(at), numbers)
    reach = [(np.nanmin(row), np.nanmax(row)) for row in values[known]]
    return SlideFit(
        part,
        jnp.asarray(at),
        achieved,
        limit.target,
        jnp.asarray(roots),
        jnp.asarray(reach).reshape(-1, 2),
        jnp.asarray(failed),
        by,
        slide,
        limit,
        status,
        force,
    )


def _roots(
    quantities: Any, grid: np.ndarray, values: np.ndarray, target: float
) -> np.ndarray:
    """Every crossing of the target between neighbours of the scan, polished."""
    found = []
    for row, line in zip(grid, values - target, strict=True):
        found += row[line == 0].tolist()
        for i in np.flatnonzero(line[:-1] * line[1:] < 0):

            def gap(value):
                return float(quantities(np.full(1, value))[0][0]) - target

            size = _WIDTH * max(1.0, abs(row[i]))
            found.append(brentq(gap, row[i], row[i + 1], xtol=size, rtol=1e-14))
    return np.sort(np.array(found))


def _nearest(grid: np.ndarray, values: np.ndarray, target: float) -> float:
    away = np.abs(values - target)
    return float(grid.ravel()[np.nanargmin(away)])
