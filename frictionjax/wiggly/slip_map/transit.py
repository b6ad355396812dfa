"""How long a tip that slides without rest takes from one well to the next.

In a fast slide the force never falls to zero, so time is a function of the tip: from
eq. 2.7, `dt/dy = eps^(gamma+1) G/(l - Phi' - V_eps')`, over exactly one period. That
integrand is smooth and hardly stiff, where `y'` as a function of time is both.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..._checks import Real
from ..._compile import Program, in_chunks
from ...model import SETTINGS as MODEL_SETTINGS
from ...model import AbstractPotential, Scene
from .settings import SETTINGS

_POINTS = 10  # Gauss nodes of a panel
_X, _W = np.polynomial.legendre.leggauss(_POINTS)
_LEGENDRE = np.polynomial.legendre.legvander(_X, _POINTS - 1)
_TO_SERIES = np.linalg.inv(_LEGENDRE)


def _integrals() -> np.ndarray:
    """Matrix from values at Gauss nodes to integrals from the left end to each node."""
    columns = []
    for k in range(_POINTS):
        primitive = np.polynomial.legendre.legint(np.eye(_POINTS)[k], lbnd=-1)
        columns.append(np.polynomial.legendre.legval(_X, primitive))
    return np.stack(columns, axis=1) @ _TO_SERIES


_TO_NODES = _integrals()


def _primitive() -> np.ndarray:
    """Matrix from Legendre polynomials to their integrals from -1, one degree higher."""
    one = np.eye(_POINTS)
    columns = [np.polynomial.legendre.legint(row, lbnd=-1) for row in one]
    return np.stack([np.pad(c, (0, _POINTS + 1 - c.size)) for c in columns], axis=1)


_PRIMITIVE = _primitive()


class WellPull(NamedTuple):
    """The wiggly force along one period, as a fast tip meets it; C cells, M nodes.

    Counted in the direction of motion, from a lattice point: at the extreme fold, where
    the tip is slowest. `way` (C, M): z in m since that point. `against` (C, M): V_eps'
    in N, its sign turned for slides to the left. `weight` (C, M): `eps G` times half the
    width of the node's panel, in m. `sign` (C,): 1 or -1.
    """

    way: np.ndarray
    against: np.ndarray
    weight: np.ndarray
    sign: np.ndarray

    @property
    def fold(self) -> np.ndarray:
        """The largest force against the motion, N, shape (C,)."""
        return self.against.max(axis=1)


class SupportPull(NamedTuple):
    """Force on the flat surface near the lattice point, as Taylor series; shape (...,).

    `load`: of l in time, `support`: of Phi' in z, four derivatives each on the last axis.
    """

    load: np.ndarray
    support: np.ndarray


class Transit(NamedTuple):
    """Passages over one well: `length` in s, `kept`, and `times` at the nodes (..., M).

    `kept`: the share of a shift in time at the start that is left at the end. All NaN
    where the force vanishes on the way.
    """

    length: np.ndarray
    kept: np.ndarray
    times: np.ndarray


@Program
def _wiggles(potential: AbstractPotential, eps, places):
    def one(eps: Real, y: Real):
        return *potential.tip_force(y, eps), potential.offset(y, eps)

    return jax.vmap(one)(eps, places)


def wiggles_at(potential: AbstractPotential, eps: np.ndarray, places: np.ndarray):
    """`V_eps'` in N, G, and A in m at tip coordinates, all of one shape."""
    columns = np.broadcast_to(eps, places.shape).ravel(), places.ravel()
    found = in_chunks(_wiggles, MODEL_SETTINGS.times, (potential,), columns)
    return [v.reshape(places.shape) for v in found]


class WellArc(NamedTuple):
    """Parts of a period to be resolved, shape (C,).

    From the tip coordinate `start` on, `length` periods in the direction `sign`. `fold`:
    V_eps' in N at the extreme fold on that side. `excess`: force in N by which the pull is
    larger, at least: it says how narrow the passage of a fold is.
    """

    eps: np.ndarray
    start: np.ndarray
    length: np.ndarray
    sign: np.ndarray
    fold: np.ndarray
    excess: np.ndarray

    def places(self, cell: np.ndarray, left: np.ndarray, width: np.ndarray) -> np.ndarray:
        """Tip coordinates of the Gauss nodes of panels given as shares of the way."""
        inside = left[:, None] + width[:, None] * 0.5 * (_X + 1)
        way = self.sign[cell] * self.length[cell]
        return self.start[cell][:, None] + way[:, None] * inside


def _density(potential, some: WellArc, cell, places) -> np.ndarray:
    """`1/sqrt(force)` at tip coordinates (n, _POINTS), under the smallest pull."""
    force, _, _ = wiggles_at(potential, some.eps[cell][:, None], places)
    gaps = (some.sign * some.fold)[cell][:, None] - some.sign[cell][:, None] * force
    return 1 / np.sqrt(some.excess[cell][:, None] + np.maximum(gaps, 0.0))


class _Clock(NamedTuple):
    """`int 1/sqrt(force)` along stretches, on panels graded towards folds; P of them.

    `cell`, `left`, `width` (shares of the way) sorted. `series` (P, _POINTS): Legendre
    series of the integrand. `before` (P,): integral up to the panel, of its own cell.
    `whole` (C,): to the end.
    """

    cell: np.ndarray
    left: np.ndarray
    width: np.ndarray
    series: np.ndarray
    before: np.ndarray
    whole: np.ndarray

    def shares(self, part: np.ndarray) -> np.ndarray:
        """Shares of the way at which the integral is `part` (n,) of the whole, (C, n)."""
        whole, cell = self.whole[:, None], np.arange(self.whole.size)[:, None]
        ends = self.cell + self.before / self.whole[self.cell]
        panel = np.searchsorted(ends, cell + part) - 1
        panel = np.maximum(panel, np.searchsorted(self.cell, cell))
        series, width = self.series[panel], self.width[panel]
        left = whole * part - self.before[panel]
        x = 2 * left / (width * series[..., 0]) - 1
        for _ in range(SETTINGS.place_sweeps):
            values = np.polynomial.legendre.legvander(x, _POINTS)
            rate = 0.5 * width * np.sum(values[..., :-1] * series, axis=-1)
            grown = 0.5 * width * np.sum(values @ _PRIMITIVE * series, axis=-1)
            x = np.clip(x - (grown - left) / rate, -1.0, 1.0)
        return self.left[panel] + width * 0.5 * (x + 1)


def _clock(potential, some: WellArc) -> _Clock:
    """Panels are halved until the last Legendre coefficients are small."""
    count = some.eps.size
    cell = np.repeat(np.arange(count), 4)
    left, width = np.tile(np.arange(4) / 4, count), np.full(4 * count, 0.25)
    done: list[tuple[np.ndarray, ...]] = []
    for level in range(SETTINGS.depth):
        values = _density(potential, some, cell, some.places(cell, left, width))
        series = values @ _TO_SERIES.T
        part = width * series[:, 0]
        if level == 0:
            whole = np.bincount(cell, part, count)
        rough = width * (np.abs(series[:, -1]) + np.abs(series[:, -2]))
        split = (rough > SETTINGS.fine * whole[cell]) & (level < SETTINGS.depth - 1)
        done.append(tuple(c[~split] for c in (cell, left, width, series)))
        if not split.any():
            break
        half = 0.5 * width[split]
        cell = np.repeat(cell[split], 2)
        left = np.stack([left[split], left[split] + half], axis=1).ravel()
        width = np.repeat(half, 2)
    cell, left, width, series = (np.concatenate(c) for c in zip(*done, strict=True))
    order = np.lexsort((left, cell))
    cell, left, width, series = cell[order], left[order], width[order], series[order]
    part = width * series[:, 0]
    past = np.cumsum(part)
    before = past - part
    whole = np.bincount(cell, part, count)
    before -= (np.cumsum(whole) - whole)[cell]
    return _Clock(cell, left, width, series, before, whole)


def well_pull_of(
    potential: AbstractPotential, some: WellArc, rough: float = SETTINGS.rough
) -> WellPull:
    """The force along stretches of a period, resolved for the excess.

    Gauss panels of equal length in `s`, `dy/ds = sqrt(force)`: around a fold the force is
    `X cosh(c s)^2`, and 1/force as smooth however narrow the fold. (Panels halved in y
    until as accurate: 80 to 160 nodes where these have 40.) As many for all as the cell
    that needs most. `rough`: last coefficients of panels, of the whole.
    """
    clock, count = _clock(potential, some), some.eps.size
    cells = np.arange(count)
    for panels in SETTINGS.panels:
        knots = (np.arange(panels)[:, None] + 0.5 * (_X + 1)).ravel() / panels
        inside = clock.shares(knots)
        way = some.sign * some.length
        places = some.start[:, None] + way[:, None] * inside
        density = _density(potential, some, cells, places)
        series = np.abs(density.reshape(count, panels, _POINTS) @ _TO_SERIES.T)
        last = np.sum(series[..., -1] + series[..., -2], axis=1)
        if np.all(last <= rough * np.sum(series[..., 0], axis=1)):
            break
    eps = some.eps[:, None]
    force, stretch, offset = wiggles_at(potential, eps, places)
    origin = wiggles_at(potential, some.eps, some.start)[2]
    pace = 0.5 * clock.whole / panels * some.length
    return WellPull(
        way=eps * (places - some.start[:, None]) + offset - origin[:, None],
        against=some.sign[:, None] * force,
        weight=eps * stretch * pace[:, None] / density,
        sign=some.sign,
    )


@jax.jit
def _passages(
    sweeps: int,
    way: Array,
    against: Array,
    weight: Array,
    sign: Array,
    load: Array,
    support: Array,
    viscosity: Array,
    times: Array,
) -> Any:
    """Newton's method for `t(y)`, linearised exactly: quadratic, and fit for stiff ends."""
    shape = (*times.shape[:-1], -1, _POINTS)
    to_nodes, weights = jnp.asarray(_TO_NODES.T), jnp.asarray(_W)

    def running(values: Array) -> tuple[Array, Array]:
        """Integrals from the start to each node, and to the end."""
        panels = values.reshape(shape)
        each = panels @ weights
        before = jnp.cumsum(each, axis=-1) - each
        found = panels @ to_nodes + before[..., None]
        return found.reshape(times.shape), jnp.sum(each, axis=-1)

    side = sign[:, None, None]
    s = [support[..., k, None] for k in range(4)]
    f = [side * load[..., k, None] for k in range(4)]
    z = way[:, None, :]
    held = side * (s[0] + z * (s[1] + z * (s[2] / 2 + z * s[3] / 6))) + against[:, None, :]
    pace = viscosity[:, None, None] * weight[:, None, :]

    def slopes(t: Array) -> tuple[Array, Array, Array]:
        force = f[0] + t * (f[1] + t * (f[2] / 2 + t * f[3] / 6)) - held
        gain = f[1] + t * (f[2] + t * f[3] / 2)
        rate = pace / force
        return force, rate, -rate * gain / force

    def sweep(_: Any, t: Array) -> Array:
        _, rate, bend = slopes(t)
        grown, _ = running(bend)
        # (t + d)' = rate + bend d; e = exp(grown) solves the homogeneous equation.
        found, _ = running((rate - bend * t) * jnp.exp(-grown))
        return found * jnp.exp(grown)

    times = jax.lax.fori_loop(0, sweeps, sweep, times)
    force, rate, bend = slopes(times)
    _, length = running(rate)
    _, grown = running(bend)
    smallest = jnp.min(jnp.where(pace > 0, force, jnp.inf), axis=-1)
    blank = jnp.where(smallest > 0, 0.0, jnp.nan)
    return length + blank, jnp.exp(grown) + blank, times


def transit_times(
    track: WellPull,
    pull: SupportPull,
    viscosity: np.ndarray,
    times=None,
    sweeps: int = SETTINGS.first_sweeps,
) -> Transit:
    """Passages of one well from n lattice points of each cell; `pull` has shape (C, n).

    `times` (C, n, M): a guess, from which one sweep is made; None where the pull stays the
    same, and it takes `sweeps`. `viscosity` (C,): eps^gamma.
    """
    if times is None:
        rate = pull.load[..., 1]  # where it is 0, nothing passes
        steady = pull.support[..., 1] / np.where(rate == 0, np.nan, rate)
        times = track.way[:, None, :] * steady[..., None]
    else:
        sweeps = SETTINGS.near_sweeps
    columns = *track, pull.load, pull.support, viscosity, times
    return Transit(*in_chunks(_passages, SETTINGS.tracks, (sweeps,), columns))


def steady_transit_times(
    track: WellPull, viscosity: np.ndarray, beyond: np.ndarray
) -> np.ndarray:
    """Seconds of a passage under steady forces `beyond` (C, n) the fold's, in N."""
    gaps = track.fold[:, None] - track.against
    pace = viscosity[:, None] * track.weight * np.tile(_W, track.way.shape[1] // _POINTS)
    return np.einsum("cm,cnm->cn", pace, 1 / (beyond[..., None] + gaps[:, None]))


def one_transit_time(
    track: WellPull, pull: SupportPull, viscosity: np.ndarray
) -> np.ndarray:
    """Seconds of one passage of each track, shape (C,); `pull` has that shape too."""
    # As many as `transit_times` is asked for elsewhere: no further program is compiled.
    many = SupportPull(
        *(np.repeat(series[:, None], SETTINGS.degree, axis=1) for series in pull)
    )
    return transit_times(track, many, viscosity, sweeps=SETTINGS.lone_sweeps).length[:, 0]


@Program
def _series(scene: Scene, times: Float[Array, " n"], states: Float[Array, " n"]):
    def derivatives(fn: Callable) -> Callable:
        first = jax.grad(fn)
        second = jax.grad(first)
        third = jax.grad(second)
        return lambda x: jnp.stack([fn(x), first(x), second(x), third(x)])

    load = jax.vmap(derivatives(scene.load))(times)
    support = jax.vmap(derivatives(scene.support.force))(states)
    return load, support


def pull_at(scene: Scene, times: np.ndarray, states: np.ndarray) -> SupportPull:
    """Taylor series of l and Phi' at times in s and states in m of one shape."""
    columns = times.ravel(), states.ravel()
    found = in_chunks(_series, SETTINGS.near, (scene,), columns)
    return SupportPull(*(v.reshape(*times.shape, 4) for v in found))
