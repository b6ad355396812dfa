"""The force that the wiggles hold a fast tip back with, resolved along one period."""

from typing import NamedTuple

import jax
import numpy as np

from ..._checks import Real
from ..._compile import Program, in_chunks
from ...model import SETTINGS as MODEL_SETTINGS
from ...model import AbstractPotential
from .settings import SETTINGS

GAUSS_POINTS = 10  # Gauss nodes of a panel
GAUSS_NODES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(GAUSS_POINTS)
TO_LEGENDRE = np.linalg.inv(np.polynomial.legendre.legvander(GAUSS_NODES, GAUSS_POINTS - 1))


def _primitive() -> np.ndarray:
    """Matrix from Legendre polynomials to their integrals from -1, one degree higher."""
    one = np.eye(GAUSS_POINTS)
    columns = [np.polynomial.legendre.legint(row, lbnd=-1) for row in one]
    return np.stack([np.pad(c, (0, GAUSS_POINTS + 1 - c.size)) for c in columns], axis=1)


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
        inside = left[:, None] + width[:, None] * 0.5 * (GAUSS_NODES + 1)
        way = self.sign[cell] * self.length[cell]
        return self.start[cell][:, None] + way[:, None] * inside


def _density(potential, some: WellArc, cell, places) -> np.ndarray:
    """`1/sqrt(force)` at tip coordinates (n, GAUSS_POINTS), under the smallest pull."""
    force, _, _ = wiggles_at(potential, some.eps[cell][:, None], places)
    gaps = (some.sign * some.fold)[cell][:, None] - some.sign[cell][:, None] * force
    return 1 / np.sqrt(some.excess[cell][:, None] + np.maximum(gaps, 0.0))


class _Clock(NamedTuple):
    """`int 1/sqrt(force)` along stretches, on panels graded towards folds; P of them.

    `cell`, `left`, `width` (shares of the way) sorted. `series` (P, GAUSS_POINTS): Legendre
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
            values = np.polynomial.legendre.legvander(x, GAUSS_POINTS)
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
        series = values @ TO_LEGENDRE.T
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
        knots = (np.arange(panels)[:, None] + 0.5 * (GAUSS_NODES + 1)).ravel() / panels
        inside = clock.shares(knots)
        way = some.sign * some.length
        places = some.start[:, None] + way[:, None] * inside
        density = _density(potential, some, cells, places)
        series = np.abs(density.reshape(count, panels, GAUSS_POINTS) @ TO_LEGENDRE.T)
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
