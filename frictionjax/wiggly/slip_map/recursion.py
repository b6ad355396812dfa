"""Newton's method for the times of passage on given panels of wells, all together.

On a panel times are a polynomial in the number of the well, which obeys
`T(n+1) = T(n) + P(n, T(n))` at Chebyshev points.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ...model import TabulatedScene
from ...numerics import rows_of
from .settings import SETTINGS
from .transit import SupportPull, pull_at, transit_times
from .well_pull import WellPull

PANEL_NODES = -np.cos(np.pi * np.arange(SETTINGS.degree + 1) / SETTINGS.degree)
TO_PANEL_SERIES = np.linalg.inv(chebyshev.chebvander(PANEL_NODES, SETTINGS.degree))


def _shifts() -> np.ndarray:
    """`D^k/k!`, k from 1: a step of h takes values at the nodes to `sum h^k D^k/k!`."""
    derivative = chebyshev.chebvander(PANEL_NODES, SETTINGS.degree - 1) @ chebyshev.chebder(
        TO_PANEL_SERIES
    )
    powers, term = [], np.eye(SETTINGS.degree + 1)
    for k in range(1, SETTINGS.degree + 1):
        term = derivative @ term / k
        powers.append(term)
    return np.stack(powers)


_SHIFTS = _shifts()


class Slides(NamedTuple):
    """Fast slides, shape (C,): what the recursion of each needs.

    `origin`: state in m at the lattice point 0; `eps`, `viscosity`; `first`: number of the
    lattice point at which it sets off, at `time` (s); `late`: end of the piece of the load.
    """

    track: WellPull
    eps: np.ndarray
    viscosity: np.ndarray
    origin: np.ndarray
    first: np.ndarray
    time: np.ndarray
    late: np.ndarray


class Panels(NamedTuple):
    """Panels of slides, P of them in order: those of a slide follow each other.

    `slide`: index. `number` (P, degree + 1): of lattice points at the nodes.
    """

    slide: np.ndarray
    number: np.ndarray

    @property
    def span(self) -> np.ndarray:
        """Wells of each."""
        return self.number[:, -1] - self.number[:, 0]

    @property
    def opens(self) -> np.ndarray:
        """Which are the first of their slides."""
        return np.append(True, self.slide[1:] != self.slide[:-1])


class Solved(NamedTuple):
    """Times at the nodes (P, degree + 1), s, and whether the recursion holds there.

    `kept`: at the nodes from the second on. `tail`: last coefficients in wells.
    """

    times: np.ndarray
    kept: np.ndarray
    fine: np.ndarray
    tail: np.ndarray


def _pull(
    scene: TabulatedScene, slides: Slides, number: np.ndarray, times: np.ndarray
) -> SupportPull:
    states = slides.origin[:, None] + (slides.track.sign * slides.eps)[:, None] * number
    return pull_at(scene, times, states)


def force_beyond(
    scene: TabulatedScene, slides: Slides, number: np.ndarray, times: np.ndarray
):
    """Force in N beyond the fold at lattice points (C,)."""
    pull = _pull(scene, slides, number[:, None], times[:, None])
    force = slides.track.sign * (pull.load[:, 0, 0] - pull.support[:, 0, 0])
    return force - slides.track.fold


def _linear(matrix: np.ndarray, left: np.ndarray, coupling: np.ndarray):
    """`matrix^-1` of what is left and of the coupling to the panel before; else NaN."""
    sides = np.stack([left, coupling], axis=-1)
    good = np.all(np.isfinite(matrix), axis=(1, 2)) & np.all(np.isfinite(left), axis=1)
    matrix = np.where(good[:, None, None], matrix, np.eye(SETTINGS.degree))
    found = np.linalg.solve(matrix, np.where(good[:, None, None], sides, np.nan))
    return found[..., 0], found[..., 1]


def _chained(opens: np.ndarray, uncoupled: np.ndarray, coupled: np.ndarray) -> np.ndarray:
    """Corrections of the starts of panels, each where the panel before now ends."""
    start, last = np.zeros(opens.size), 0.0
    for p, first in enumerate(opens.tolist()):
        start[p] = 0.0 if first else last
        last = uncoupled[p] + coupled[p] * start[p]
    return start


def _newton(
    scene: TabulatedScene, slides: Slides, panels: Panels, times: np.ndarray, enough: float
):
    """Times at the nodes of all panels together, so that the recursion holds there.

    `enough`: corrections to come that are not made, in wells.
    """
    span = panels.span
    powers = (2 / span)[:, None] ** np.arange(1, SETTINGS.degree + 1)
    shift = np.einsum("ck,kij->cij", powers, _SHIFTS)[:, 1:]
    chosen, number = rows_of(slides, panels.slide), panels.number
    guess, before = None, np.full(span.size, np.nan)
    for _ in range(SETTINGS.newton):
        pull = _pull(scene, chosen, number[:, 1:], times[:, 1:])
        found = transit_times(chosen.track, pull, chosen.viscosity, guess)
        since = times - times[:, :1]
        left = np.einsum("cij,cj->ci", shift, since) - found.length
        matrix = shift[:, :, 1:] + np.eye(SETTINGS.degree) * (1 - found.kept)[:, :, None]
        uncoupled, coupled = _linear(matrix, -left, -shift[:, :, 0])
        start = _chained(panels.opens, uncoupled[:, -1], coupled[:, -1])
        change = np.concatenate(
            [start[:, None], uncoupled + coupled * start[:, None]], axis=1
        )
        times = times + change
        length = np.abs(times[:, -1] - times[:, 0]) / span
        size = np.max(np.abs(change), axis=1) / length
        guess = found.times
        # The next correction shrinks by as much again at least; it is not made.
        shrinks = np.where(before > 0, np.minimum(size / before, 1.0), 1.0)
        to_come, before = size * shrinks, size
        if not np.any(to_come > np.maximum(enough, _noise(panels, times))):
            break
    return times, found.kept, to_come


def _noise(panels: Panels, times: np.ndarray) -> np.ndarray:
    """Rounding of times in wells of each panel."""
    length = (times[:, -1] - times[:, 0]) / panels.span
    return SETTINGS.spacing * np.abs(times[:, -1]) / np.abs(length)


def solved_on(
    scene: TabulatedScene, slides: Slides, panels: Panels, times, least
) -> Solved:
    # What is left of nodes behind the first, which is known, is a last coefficient too.
    # (With 1e-4 panels of transits that keep half failed however short: sawtooth, gamma =
    # 3/4, eps = 1e-8, one of 2e7 wells was cut 23 times, down to 8.)
    enough = min(SETTINGS.converged, SETTINGS.left_over * least)
    times, kept, size = _newton(scene, slides, panels, times, enough)
    series = (times - times[:, :1]) @ TO_PANEL_SERIES.T
    length = (times[:, -1] - times[:, 0]) / panels.span
    tail = (np.abs(series[:, -1]) + np.abs(series[:, -2])) / length
    noise = _noise(panels, times)
    fine = (size <= np.maximum(enough, noise)) & np.all(np.diff(times) > 0, axis=1)
    fine &= tail <= np.maximum(least, noise)
    fine &= times[:, -1] <= slides.late[panels.slide]
    return Solved(times, kept, fine, tail)
