"""When a tip that slides without rest passes each well, for millions of wells at once.

Passing one well takes `P(n, T)` seconds from its lattice point on, so the times of passage
obey `T(n+1) = T(n) + P(n, T(n))`. Their solution is a smooth function of n: on a panel of
wells it is a polynomial that obeys the recursion at Chebyshev points, and the panels grow
until they hold most of a slide. The cost does not depend on the number of wells.

Nearest relatives: multirevolution methods and envelope following (L. R. Petzold, SIAM J.
Numer. Anal. 18, 1981; M. Calvo, L. O. Jay, J. I. Montijano, L. Randez, Numer. Math. 97,
2004), which step over whole periods but replace the recursion by a differential equation.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ..programs import room
from ..scene import Scene
from .passage import TOGETHER, Pull, Track, one_passage, passages, pull_at
from .path import arrivals_at, state_under

DEGREE = TOGETHER
_X = -np.cos(np.pi * np.arange(DEGREE + 1) / DEGREE)
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_X, DEGREE))
_NEWTON = 6
_CONVERGED = 1e-4  # wells: the last correction of Newton's method, which is quadratic
_INVERSE = 6  # sweeps of Newton's method for the number at a time
# A slide is slow where a passage forgets more than this of a shift: tips nearly rest at
# folds, and windows started a few slips earlier do as well.
_SLOW = 0.3
_SMALLEST = 8.0  # wells of a panel
_GROWTH, _LITTLE, _SHRINK = 3.0, 1.5, 0.4
_TAIL = 1e-3  # of the accuracy: last coefficients of a panel
_SPACING = 1e-14  # of T: rounding of times, in the last coefficients
_ROOMY = 0.03  # of the tail allowed: below it panels grow fast
_WORTH = 0.2  # of the panel before: the smallest one worth trying where slides turn slow
_END = 3.0  # wells left before the end of a slide
_SLOWING = 0.7  # of the wells that the pace at a panel's start would pass before the end
_PANELS = 200


def _shifts() -> np.ndarray:
    """`D^k/k!`, k from 1: a step of h takes values at the nodes to `sum h^k D^k/k!`."""
    derivative = chebyshev.chebvander(_X, DEGREE - 1) @ chebyshev.chebder(_TO_SERIES)
    powers, term = [], np.eye(DEGREE + 1)
    for k in range(1, DEGREE + 1):
        term = derivative @ term / k
        powers.append(term)
    return np.stack(powers)


_SHIFTS = _shifts()


class Slides(NamedTuple):
    """Fast slides, shape (C,): what the recursion of each needs.

    `origin`: state in m at the lattice point 0; `eps`, `viscosity`; `first`: number of the
    lattice point at which it sets off, at `time` (s); `late`: end of the piece of the load.
    """

    track: Track
    eps: np.ndarray
    viscosity: np.ndarray
    origin: np.ndarray
    first: np.ndarray
    time: np.ndarray
    late: np.ndarray


class Curve(NamedTuple):
    """Times of passage of one slide, as Chebyshev series on panels of wells.

    `edges` (K+1,): numbers of lattice points. `starts` (K+1,): times there, s. `series`
    (K, DEGREE+1): of T less the panel's start. `tail` (K,): its last coefficients,
    in wells. `kept` (K,): share of a shift that a well leaves of it.
    """

    edges: np.ndarray
    starts: np.ndarray
    series: np.ndarray
    tail: np.ndarray
    kept: np.ndarray

    def time_of(self, number: np.ndarray) -> np.ndarray:
        """Time in s at which each lattice point is passed, numbers need not be whole."""
        panel = np.clip(
            np.searchsorted(self.edges, number, side="right") - 1, 0, self.tail.size - 1
        )
        low, high = self.edges[panel], self.edges[panel + 1]
        x = np.clip(2 * (number - low) / (high - low) - 1, -1.0, 1.0)
        angles = np.arccos(x)[:, None] * np.arange(DEGREE + 1)
        return self.starts[panel] + np.sum(self.series[panel] * np.cos(angles), axis=1)

    def number_at(self, time: np.ndarray) -> np.ndarray:
        """Lattice point that is passed at each time between the ends."""
        panel = np.searchsorted(self.starts, time, side="right") - 1
        panel = np.clip(panel, 0, self.tail.size - 1)
        since, whole = time - self.starts[panel], np.diff(self.starts)[panel]
        x = np.clip(2 * since / whole - 1, -1.0, 1.0)
        series, order = self.series[panel], np.arange(DEGREE + 1)
        slopes = _derivatives(series)
        for _ in range(_INVERSE):
            angle = np.arccos(x)[:, None]
            value = np.sum(series * np.cos(angle * order), axis=1)
            slope = np.sum(slopes * np.cos(angle * order), axis=1)
            x = np.clip(x - (value - since) / slope, -1.0, 1.0)
        low, high = self.edges[panel], self.edges[panel + 1]
        return low + 0.5 * (x + 1) * (high - low)


def _derivatives(series: np.ndarray) -> np.ndarray:
    """Chebyshev series of the derivatives of the rows of `series`."""
    slopes = np.zeros_like(series)
    slopes[:, :-1] = chebyshev.chebder(series.T).T
    return slopes


class _Panel(NamedTuple):
    """A panel's times at the nodes (C, DEGREE+1), and whether it holds.

    `kept`: at the nodes from the second on. `length`: of the last passage, s. `tail`: last
    coefficients in wells.
    """

    times: np.ndarray
    kept: np.ndarray
    length: np.ndarray
    fine: np.ndarray
    tail: np.ndarray


def _pull(scene: Scene, slides: Slides, number: np.ndarray, times: np.ndarray) -> Pull:
    states = slides.origin[:, None] + (slides.track.sign * slides.eps)[:, None] * number
    return pull_at(scene, times, states)


def _excess(scene: Scene, slides: Slides, number: np.ndarray, times: np.ndarray):
    """`l - Phi'` in N in the direction of motion, at lattice points (C,)."""
    pull = _pull(scene, slides, number[:, None], times[:, None])
    return slides.track.sign * (pull.load[:, 0, 0] - pull.support[:, 0, 0])


def _newton(scene: Scene, slides: Slides, number, times, span):
    """Times at the nodes 1 to DEGREE so that the recursion holds there."""
    powers = (2 / span)[:, None] ** np.arange(1, DEGREE + 1)
    shift = np.einsum("ck,kij->cij", powers, _SHIFTS)[:, 1:]
    guess = None
    for _ in range(_NEWTON):
        pull = _pull(scene, slides, number[:, 1:], times[:, 1:])
        found = passages(slides.track, pull, slides.viscosity, guess)
        since = times - times[:, :1]
        left = np.einsum("cij,cj->ci", shift, since) - found.length
        matrix = shift[:, :, 1:] + np.eye(DEGREE) * (1 - found.kept)[:, :, None]
        good = np.all(np.isfinite(matrix), axis=(1, 2)) & np.all(np.isfinite(left), axis=1)
        matrix = np.where(good[:, None, None], matrix, np.eye(DEGREE))
        change = np.linalg.solve(matrix, np.where(good[:, None], left, 0.0)[..., None])
        change = np.where(good[:, None], change[..., 0], np.nan)
        times = np.concatenate([times[:, :1], times[:, 1:] - change], axis=1)
        length = np.abs(times[:, -1] - times[:, 0]) / span
        size = np.max(np.abs(change), axis=1) / length
        guess = found.times
        if not np.any(size > _CONVERGED):
            break
    return times, found, size


def _panel(scene: Scene, slides: Slides, now, first, time, span, accuracy) -> _Panel:
    """The next panel of the slides `now`."""
    whose = _repeated(now)
    some = _chosen(slides, whose)
    first, time, span = first[whose], time[whose], span[whose]
    number = first[:, None] + 0.5 * span[:, None] * (_X + 1)
    pull = _excess(scene, some, first, time)
    states = some.origin[:, None] + (some.track.sign * some.eps)[:, None] * number
    wide = np.ones_like(number)
    force = (some.track.sign * pull)[:, None] * wide
    early, late = time[:, None] * wide, some.late[:, None] * wide
    flat = states.ravel(), force.ravel(), early.ravel(), late.ravel()
    guess = arrivals_at(scene, *flat).reshape(number.shape).copy()
    guess[:, 0] = time
    times, found, size = _newton(scene, some, number, guess, span)
    series = (times - times[:, :1]) @ _TO_SERIES.T
    length = (times[:, -1] - times[:, 0]) / span
    tail = (np.abs(series[:, -1]) + np.abs(series[:, -2])) / length
    noise = _SPACING * np.abs(times[:, -1]) / length
    fine = (size <= np.maximum(_CONVERGED, noise)) & np.all(np.diff(times) > 0, axis=1)
    fine &= tail <= np.maximum(_TAIL * accuracy, noise)
    fine &= times[:, -1] <= some.late
    every = times, found.kept, found.length[:, -1], fine, tail
    return _Panel(*(column[: now.size] for column in every))


def _left(scene: Scene, slides: Slides, first, time, pull, length) -> np.ndarray:
    """Wells that surely remain before the end of the piece: a panel may span them."""
    end = state_under(scene, slides.late, slides.track.sign * pull)
    at_this_lag = slides.track.sign * (end - slides.origin) / slides.eps - first
    at_this_pace = _SLOWING * (slides.late - time) / length
    return np.floor(np.maximum(at_this_lag, at_this_pace) - _END)


def _passage(scene: Scene, slides: Slides, first, time) -> np.ndarray:
    """Length in s of one passage from each start."""
    which = _repeated(np.arange(slides.eps.size))
    some = _chosen(slides, which)
    pull = _pull(scene, some, first[which, None], time[which, None])
    every = one_passage(some.track, Pull(*(v[:, 0] for v in pull)), some.viscosity)
    return every[: first.size].copy()


def follow(scene: Scene, slides: Slides, accuracy: float) -> list[Curve | None]:
    """Times of passage of every slide, from where it sets off to its end or until slow.

    None where it is slow from the start, or too short.
    """
    size = slides.eps.size
    first, time = slides.first.copy(), slides.time.copy()
    pull = _excess(scene, slides, first, time)
    length = _passage(scene, slides, first, time)
    span = np.full(size, 2 * _SMALLEST)
    reached, smallest = np.zeros(size), np.full(size, _SMALLEST)
    going = np.isfinite(length)
    panels: list[list[tuple]] = [[] for _ in range(size)]
    for _ in range(_PANELS):
        left = _left(scene, slides, first, time, pull, length)
        going &= (left >= _SMALLEST) & (span >= smallest)
        now = np.flatnonzero(going)
        if now.size == 0:
            break
        span = np.floor(np.where(left < 1.3 * span, left, span))
        found = _panel(scene, slides, now, first, time, span, accuracy)
        calm = np.all((found.kept > _SLOW) & (found.kept < 1 / _SLOW), axis=1)
        on = found.fine & calm
        for i, c in enumerate(now):
            if on[i]:
                kept = np.exp(np.mean(np.log(found.kept[i])))
                row = first[c], time[c], span[c], found.times[i], found.tail[i], kept
                panels[c].append(row)
        # Where it turns slow on a panel, only a large part of the way is worth having.
        reached[now] = np.where(on, span[now], reached[now])
        slow = now[found.fine & ~calm]
        smallest[slow] = np.maximum(_WORTH * reached[slow], _SMALLEST)
        ahead = now[on]
        first[ahead] += span[ahead]
        time[ahead], length[ahead] = found.times[on, -1], found.length[on]
        pull[ahead] = _excess(scene, slides, first, time)[ahead]
        growth = np.where(found.tail < _ROOMY * _TAIL * accuracy, _GROWTH, _LITTLE)
        span[now] *= np.where(on, growth, _SHRINK)
    return [_curve(panels[c]) for c in range(size)]


def _curve(panels: list[tuple]) -> Curve | None:
    if not panels:
        return None
    columns = [np.array(c) for c in zip(*panels, strict=True)]
    first, time, span, times, tail, kept = columns
    series = (times - times[:, :1]) @ _TO_SERIES.T
    edges = np.append(first, first[-1] + span[-1])
    return Curve(edges, np.append(time, times[-1, -1]), series, tail, kept)


def _repeated(which: np.ndarray) -> np.ndarray:
    """Indices, the last one repeated up to one of few sizes."""
    more = room(which.size, 4, 2) - which.size
    return np.concatenate([which, np.repeat(which[-1:], more)])


def _chosen(slides: Slides, which: np.ndarray) -> Slides:
    """Some slides."""
    track = Track(*(column[which] for column in slides.track))
    return Slides(track, *(column[which] for column in slides[1:]))
