"""The force that the wiggles hold a fast tip back with, resolved along one period."""

from typing import NamedTuple

import jax
import numpy as np

from ..._compile import Program, in_chunks
from ...model import SETTINGS as MODEL_SETTINGS
from ...model import AbstractPotential
from .gauss import GAUSS_NODES, GAUSS_POINTS, GAUSS_WEIGHTS, PRIMITIVE, TO_LEGENDRE
from .halved_panels import halved_panels
from .settings import SETTINGS


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
    return jax.vmap(potential.at_tip)(places, eps)


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


class _Grading(NamedTuple):
    """How dense nodes are: a sum of `share/sqrt(force)` under several pulls, (C, pulls).

    `excess`: forces in N by which these are larger than the fold's.
    """

    excess: np.ndarray
    share: np.ndarray

    def terms(self, cell: np.ndarray, gaps: np.ndarray) -> np.ndarray:
        """Each `1/sqrt(force)` at gaps (n, m) of cells (n,): (pulls, n, m)."""
        return 1 / np.sqrt(self.excess[cell].T[..., None] + np.maximum(gaps, 0.0))

    def density(self, cell: np.ndarray, gaps: np.ndarray) -> np.ndarray:
        """The sum, (n, m)."""
        used = np.any(self.share > 0, axis=0)
        some = _Grading(self.excess[:, used], self.share[:, used])
        return np.einsum("lnm,nl->nm", some.terms(cell, gaps), some.share[cell])


def _gaps(potential, some: WellArc, cell, places) -> np.ndarray:
    """Force in N below the fold's at tip coordinates (n, m) of cells (n,)."""
    force, _, _ = wiggles_at(potential, some.eps[cell][:, None], places)
    return (some.sign * some.fold)[cell][:, None] - some.sign[cell][:, None] * force


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
            grown = 0.5 * width * np.sum(values @ PRIMITIVE * series, axis=-1)
            x = np.clip(x - (grown - left) / rate, -1.0, 1.0)
        return self.left[panel] + width * 0.5 * (x + 1)


def _clock(potential, some: WellArc, grading: _Grading) -> _Clock:
    """Panels are halved until the last Legendre coefficients are small."""
    count = some.eps.size
    cell = np.repeat(np.arange(count), 4)
    left, width = np.tile(np.arange(4) / 4, count), np.full(4 * count, 0.25)
    done: list[tuple[np.ndarray, ...]] = []
    for level in range(SETTINGS.depth):
        gaps = _gaps(potential, some, cell, some.places(cell, left, width))
        values = grading.density(cell, gaps)
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


class _Nodes(NamedTuple):
    """Gauss nodes on panels of equal length in `s`: C cells, M nodes.

    `places`: tip coordinates. `density`: `ds/dy`, y a share of the way. `whole` (C,): its
    integral. `under` (C, pulls): those of `1/sqrt(force)` under each pull, `smooth`:
    whether passages under it are resolved.
    """

    places: np.ndarray
    density: np.ndarray
    whole: np.ndarray
    under: np.ndarray
    smooth: np.ndarray


def _nodes(
    potential, some: WellArc, grading: _Grading, rough: float, pulls: slice
) -> _Nodes:
    """As many for all as the cell that needs most under some of the pulls."""
    clock, count = _clock(potential, some, grading), some.eps.size
    cells, whole = np.arange(count), clock.whole
    larger = np.arange(SETTINGS.pulls)[:, None] > 0
    allowed = np.where(larger, SETTINGS.rougher, 1.0) * rough
    for panels in SETTINGS.panels:
        knots = (np.arange(panels)[:, None] + 0.5 * (GAUSS_NODES + 1)).ravel() / panels
        way = some.sign * some.length
        places = some.start[:, None] + way[:, None] * clock.shares(knots)
        gaps = _gaps(potential, some, cells, places)
        density, terms = grading.density(cells, gaps), grading.terms(cells, gaps)
        rates = (terms**2 / density).reshape(*terms.shape[:-1], panels, GAUSS_POINTS)
        series = np.abs(rates @ TO_LEGENDRE.T)
        last = np.sum(series[..., -1] + series[..., -2], axis=-1)
        smooth = last <= allowed * np.sum(series[..., 0], axis=-1)
        if np.all(smooth[pulls]):
            break
    weights = np.tile(GAUSS_WEIGHTS, panels) / (2 * panels)
    under = whole * np.sum(weights * terms / density, axis=-1)
    return _Nodes(places, density, whole, under.T, smooth.T)


def well_pull_of(
    potential: AbstractPotential, some: WellArc, rough: float = SETTINGS.rough
) -> WellPull:
    """The force along stretches of a period, resolved for the excess and larger ones.

    Gauss panels of equal length in `s`, `dy/ds = sqrt(force)`: around a fold the force is
    `X cosh(c s)^2`, and 1/force as smooth however narrow the fold. (Panels halved in y
    until as accurate: 80 to 160 nodes where these have 40.) As many for all as the cell
    that needs most. `rough`: last coefficients of panels, of the whole.

    Nodes for the smallest pull serve larger ones as well at folds with a curvature. Where
    the force is flatter they all lie where it is flat: there they are graded for several
    pulls. (Graded for the smallest one, passages of `W'` like `y^4` under a thousand times
    the excess were 1e-4 off.) Corners, between flanks where the force is flat, are nowhere
    that grading knows of: where it does not do, panels are halved.
    """
    powers = SETTINGS.pull_levels ** np.arange(SETTINGS.pulls)
    excess = some.excess[:, None] * powers
    one = _Grading(excess, np.where(powers == 1, 1.0, 0.0) * np.ones_like(excess))
    found = _nodes(potential, some, one, rough, slice(1))
    flat = ~np.all(found.smooth, axis=1)
    if flat.any():
        share = np.where(flat[:, None], 1 / found.under, one.share)
        found = _nodes(potential, some, _Grading(excess, share), rough, slice(None))
    panels = found.places.shape[1] // GAUSS_POINTS
    pace: np.ndarray = (0.5 * found.whole / panels * some.length)[:, None]
    places, density = found.places, found.density
    halved = None
    if not np.all(found.smooth):
        halved = _halved(potential, some, excess, rough)
    if halved is not None:
        places, widths = halved
        pace, density = 0.5 * widths * some.length[:, None], np.ones_like(widths)
    eps = some.eps[:, None]
    force, stretch, offset = wiggles_at(potential, eps, places)
    origin = wiggles_at(potential, some.eps, some.start)[2]
    return WellPull(
        way=eps * (places - some.start[:, None]) + offset - origin[:, None],
        against=some.sign[:, None] * force,
        weight=eps * stretch * pace / density,
        sign=some.sign,
    )


def _halved(potential, some: WellArc, excess: np.ndarray, rough: float):
    """Places of nodes and widths of their panels, shares of the way, (C, M) both."""
    larger = np.arange(SETTINGS.pulls) > 0
    rough = SETTINGS.halved * rough

    def gaps(cell: np.ndarray, shares: np.ndarray) -> np.ndarray:
        way = some.sign[cell] * some.length[cell]
        places = some.start[cell][:, None] + way[:, None] * shares
        return _gaps(potential, some, cell, places)

    found = halved_panels(gaps, excess, np.where(larger, SETTINGS.rougher, 1.0) * rough)
    if found is None:
        return None
    left, width = found
    cell = np.repeat(np.arange(len(left)), left.shape[1])
    places = some.places(cell, left.ravel(), width.ravel())
    return places.reshape(len(left), -1), np.repeat(width, GAUSS_POINTS, axis=1)
