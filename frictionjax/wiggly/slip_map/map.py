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

from ...model import Scene
from ..limit_path import arrivals_at, state_under
from .averaged_equation import Lags, lags_of
from .elements import edges_of
from .settings import SETTINGS
from .transit import SupportPull, WellPull, pull_at, steady_transit_times, transit_times
from .transit_times import TransitTimes

_X = -np.cos(np.pi * np.arange(SETTINGS.degree + 1) / SETTINGS.degree)
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_X, SETTINGS.degree))


def _shifts() -> np.ndarray:
    """`D^k/k!`, k from 1: a step of h takes values at the nodes to `sum h^k D^k/k!`."""
    derivative = chebyshev.chebvander(_X, SETTINGS.degree - 1) @ chebyshev.chebder(
        _TO_SERIES
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


class _Panels(NamedTuple):
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


class _Solved(NamedTuple):
    """Times at the nodes (P, degree + 1), s, and whether the recursion holds there.

    `kept`: at the nodes from the second on. `tail`: last coefficients in wells.
    """

    times: np.ndarray
    kept: np.ndarray
    fine: np.ndarray
    tail: np.ndarray


def _pull(
    scene: Scene, slides: Slides, number: np.ndarray, times: np.ndarray
) -> SupportPull:
    states = slides.origin[:, None] + (slides.track.sign * slides.eps)[:, None] * number
    return pull_at(scene, times, states)


def _beyond(scene: Scene, slides: Slides, number: np.ndarray, times: np.ndarray):
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


def _chained(opens: np.ndarray, own: np.ndarray, coupled: np.ndarray) -> np.ndarray:
    """Corrections of the starts of panels, each where the panel before now ends."""
    start, last = np.zeros(opens.size), 0.0
    for p, first in enumerate(opens.tolist()):
        start[p] = 0.0 if first else last
        last = own[p] + coupled[p] * start[p]
    return start


def _newton(scene: Scene, slides: Slides, panels: _Panels, times: np.ndarray):
    """Times at the nodes of all panels together, so that the recursion holds there."""
    span = panels.span
    powers = (2 / span)[:, None] ** np.arange(1, SETTINGS.degree + 1)
    shift = np.einsum("ck,kij->cij", powers, _SHIFTS)[:, 1:]
    some, number = _chosen(slides, panels.slide), panels.number
    guess, before = None, np.full(span.size, np.nan)
    for _ in range(SETTINGS.newton):
        pull = _pull(scene, some, number[:, 1:], times[:, 1:])
        found = transit_times(some.track, pull, some.viscosity, guess)
        since = times - times[:, :1]
        left = np.einsum("cij,cj->ci", shift, since) - found.length
        matrix = shift[:, :, 1:] + np.eye(SETTINGS.degree) * (1 - found.kept)[:, :, None]
        own, coupled = _linear(matrix, -left, -shift[:, :, 0])
        start = _chained(panels.opens, own[:, -1], coupled[:, -1])
        change = np.concatenate([start[:, None], own + coupled * start[:, None]], axis=1)
        times = times + change
        length = np.abs(times[:, -1] - times[:, 0]) / span
        size = np.max(np.abs(change), axis=1) / length
        guess = found.times
        # The next correction shrinks by as much again at least; it is not made.
        shrinks = np.where(before > 0, np.minimum(size / before, 1.0), 1.0)
        to_come, before = size * shrinks, size
        if not np.any(to_come > SETTINGS.converged):
            break
    return times, found.kept, to_come


def _solved(scene: Scene, slides: Slides, panels: _Panels, times, least) -> _Solved:
    times, kept, size = _newton(scene, slides, panels, times)
    series = (times - times[:, :1]) @ _TO_SERIES.T
    length = (times[:, -1] - times[:, 0]) / panels.span
    tail = (np.abs(series[:, -1]) + np.abs(series[:, -2])) / length
    noise = SETTINGS.spacing * np.abs(times[:, -1]) / length
    fine = (size <= np.maximum(SETTINGS.converged, noise)) & np.all(
        np.diff(times) > 0, axis=1
    )
    fine &= tail <= np.maximum(least, noise)
    fine &= times[:, -1] <= slides.late[panels.slide]
    return _Solved(times, kept, fine, tail)


def _horizon(scene: Scene, slides: Slides, first, time, force) -> np.ndarray:
    """Wells before the end of the piece: where the fold holds the tip, or at this pace."""
    sign, fold = slides.track.sign, slides.track.fold
    end = state_under(scene, slides.late, sign * fold)
    held = sign * (end - slides.origin) / slides.eps - first
    beyond = np.maximum(force, 1e-300)[:, None]
    length = steady_transit_times(slides.track, slides.viscosity, beyond)[:, 0]
    return np.where(
        held >= SETTINGS.smallest, held, SETTINGS.slowing * (slides.late - time) / length
    )


def _cut(scene: Scene, slides: Slides, now, first, time, tail, share, past):
    """Panels of the slides `now` from where they are, and times guessed at their nodes."""
    some, first, time = _chosen(slides, now), first[now], time[now]
    force = _beyond(scene, some, first, time)
    wells = _horizon(scene, some, first, time, force)
    able = (force > 0) & (wells >= SETTINGS.smallest)
    wells, force = np.where(able, wells, 1.0), np.where(able, force, 1.0)
    parts = some.track, some.eps, some.viscosity, some.origin
    lags = lags_of(scene, *parts, first, time, force, wells)
    slide, numbers, forces = [], [], []
    for i in np.flatnonzero(able).tolist():
        mine = Lags(*(column[i] for column in lags))
        since = first[i] - some.first[i]
        left = past[now[i]] - first[i]
        edges = edges_of(mine, some.late[i], left, since, tail, share[now[i]])
        number = edges[:-1, None] + 0.5 * np.diff(edges)[:, None] * (_X + 1)
        slide.append(np.full(edges.size - 1, now[i]))
        numbers.append(first[i] + number)
        forces.append(np.interp(number, mine.number, mine.force))
    none = np.zeros((0, SETTINGS.degree + 1))
    whose = np.concatenate([np.zeros(0, dtype=int), *slide])
    panels = _Panels(whose, np.concatenate([none, *numbers]))
    return panels, np.concatenate([none, *forces])


def _guess(scene: Scene, slides: Slides, panels: _Panels, force, time) -> np.ndarray:
    """Times at the nodes where the force beyond the fold is as given."""
    some = _chosen(slides, panels.slide)
    sign, wide = some.track.sign[:, None], np.ones_like(force)
    states = some.origin[:, None] + sign * some.eps[:, None] * panels.number
    pull = sign * (some.track.fold[:, None] + force)
    early, late = time[panels.slide][:, None] * wide, some.late[:, None] * wide
    flat = [column.ravel() for column in (states, pull, early, late)]
    guess = arrivals_at(scene, *flat).reshape(force.shape).copy()
    guess[panels.opens, 0] = time[panels.slide[panels.opens]]
    # Panels meet in one time.
    joint = np.flatnonzero(~panels.opens)
    guess[joint, 0] = guess[joint - 1, -1]
    return guess


def _leaves(kept, share: float):
    """Whether a transit leaves more than a share of a shift, and grows it by no more."""
    return (kept > share) & (kept < 1 / share)


def follow(scene: Scene, slides: Slides, tail: float) -> list[TransitTimes | None]:
    """Times of passage of every slide, from where it sets off to its end or until slow.

    `tail`: last coefficients of panels, in wells.

    All panels of all slides together, where the averaged equation puts them; those behind
    one that does not hold are cut again. None where a slide is slow from the start, or too
    short.
    """
    size = slides.eps.size
    first, time = slides.first.copy(), slides.time.copy()
    share, smallest = np.ones(size), np.full(size, SETTINGS.smallest)
    past = np.full(size, np.inf)  # numbers that the end of the piece does not let pass
    now = np.arange(size)
    found: list[list[tuple]] = [[] for _ in range(size)]
    for _ in range(SETTINGS.rounds):
        if now.size == 0:
            break
        how = tail, share, past
        panels, force = _cut(scene, slides, now, first, time, *how)
        if panels.slide.size == 0:
            break
        guess = _guess(scene, slides, panels, force, time)
        solved = _solved(scene, slides, panels, guess, tail)
        calm = np.all(_leaves(solved.kept, SETTINGS.slow), axis=1)
        on = solved.fine & calm
        going = []
        for c in np.unique(panels.slide):
            mine = np.flatnonzero(panels.slide == c)
            held = mine[np.cumprod(on[mine], dtype=bool)]
            for p in held:
                kept = np.exp(np.mean(np.log(solved.kept[p])))
                times, span = solved.times[p], panels.span[p]
                last = solved.kept[p, -1]
                found[c].append(
                    (first[c], times[0], span, times, solved.tail[p], kept, last)
                )
                first[c], time[c] = first[c] + span, times[-1]
            if held.size == mine.size:
                # The averaged equation may end a fast slide wells too early.
                p = held[-1]
                pace = np.diff(solved.times[p, -2:]) / np.diff(panels.number[p, -2:])
                left = (slides.late[c] - time[c]) / pace[0]
                on_fast = _leaves(solved.kept[p, -1], SETTINGS.on_above)
                if left >= SETTINGS.smallest and on_fast:
                    going.append(c)
                continue
            failed = mine[held.size]
            if solved.times[failed, -1] > slides.late[c]:
                nodes = solved.times[failed], panels.number[failed]
                past[c] = np.interp(slides.late[c], *nodes)
                going.append(c)
                continue
            share[c] = SETTINGS.again * (1.0 if held.size > 2 else share[c])
            # Where it turns slow, only a large part of the way is worth having.
            if solved.fine[failed] and held.size:
                smallest[c] = max(SETTINGS.worth * panels.span[held[-1]], SETTINGS.smallest)
            if SETTINGS.again * panels.span[failed] >= smallest[c]:
                going.append(c)
        now = np.array(going, dtype=int)
    return [_curve(rows) for rows in found]


def _curve(panels: list[tuple]) -> TransitTimes | None:
    if not panels:
        return None
    columns = [np.array(c) for c in zip(*panels, strict=True)]
    first, time, span, times, tail, kept, last = columns
    series = (times - times[:, :1]) @ _TO_SERIES.T
    edges = np.append(first, first[-1] + span[-1])
    starts = np.append(time, times[-1, -1])
    return TransitTimes(edges, starts, series, tail, kept, float(last[-1]))


def _chosen(slides: Slides, which: np.ndarray) -> Slides:
    """Some slides."""
    track = WellPull(*(column[which] for column in slides.track))
    return Slides(track, *(column[which] for column in slides[1:]))
