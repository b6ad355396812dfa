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

from ...model import TabulatedScene
from ...numerics import rows_of, stacked
from ..limit_path import arrivals_at, state_under
from .averaged_equation import lags_of
from .elements import edges_of
from .recursion import PANEL_NODES, TO_PANEL_SERIES, Panels, Slides, force_beyond, solved_on
from .settings import SETTINGS
from .transit import steady_transit_times
from .transit_times import TransitTimes


def _horizon(scene: TabulatedScene, slides: Slides, first, time, force) -> np.ndarray:
    """Wells before the end of the piece: where the fold holds the tip, or at this pace."""
    sign, fold = slides.track.sign, slides.track.fold
    end = state_under(scene, slides.late, sign * fold)
    held = sign * (end - slides.origin) / slides.eps - first
    beyond = np.maximum(force, 1e-300)[:, None]
    length = steady_transit_times(slides.track, slides.viscosity, beyond)[:, 0]
    return np.where(
        held >= SETTINGS.smallest, held, SETTINGS.slowing * (slides.late - time) / length
    )


def _cut(scene: TabulatedScene, slides: Slides, now, first, time, tail, share, past):
    """Panels of the slides `now` from where they are, and times guessed at their nodes."""
    chosen, first, time = rows_of(slides, now), first[now], time[now]
    force = force_beyond(scene, chosen, first, time)
    wells = _horizon(scene, chosen, first, time, force)
    able = (force > 0) & (wells >= SETTINGS.smallest)
    wells, force = np.where(able, wells, 1.0), np.where(able, force, 1.0)
    lags = lags_of(
        scene=scene,
        track=chosen.track,
        eps=chosen.eps,
        viscosity=chosen.viscosity,
        origin=chosen.origin,
        first=first,
        time=time,
        force=force,
        wells=wells,
    )
    slide, numbers, forces = [], [], []
    for i in np.flatnonzero(able).tolist():
        mine = rows_of(lags, i)
        since = first[i] - chosen.first[i]
        left = past[now[i]] - first[i]
        edges = edges_of(mine, chosen.late[i], left, since, tail, share[now[i]])
        number = edges[:-1, None] + 0.5 * np.diff(edges)[:, None] * (PANEL_NODES + 1)
        slide.append(np.full(edges.size - 1, now[i]))
        numbers.append(first[i] + number)
        forces.append(np.interp(number, mine.number, mine.force))
    none = np.zeros((0, SETTINGS.degree + 1))
    whose = np.concatenate([np.zeros(0, dtype=int), *slide])
    panels = Panels(whose, np.concatenate([none, *numbers]))
    return panels, np.concatenate([none, *forces])


def _guess(
    scene: TabulatedScene, slides: Slides, panels: Panels, force, time
) -> np.ndarray:
    """Times at the nodes where the force beyond the fold is as given."""
    chosen = rows_of(slides, panels.slide)
    sign, wide = chosen.track.sign[:, None], np.ones_like(force)
    states = chosen.origin[:, None] + sign * chosen.eps[:, None] * panels.number
    pull = sign * (chosen.track.fold[:, None] + force)
    early, late = time[panels.slide][:, None] * wide, chosen.late[:, None] * wide
    guess = arrivals_at(scene, states.ravel(), pull.ravel(), early.ravel(), late.ravel())
    guess = guess.reshape(force.shape).copy()
    guess[panels.opens, 0] = time[panels.slide[panels.opens]]
    # Panels meet in one time.
    joint = np.flatnonzero(~panels.opens)
    guess[joint, 0] = guess[joint - 1, -1]
    return guess


def _leaves(kept, share: float):
    """Whether a transit leaves more than a share of a shift, and grows it by no more."""
    return (kept > share) & (kept < 1 / share)


def follow(scene: TabulatedScene, slides: Slides, tail: float) -> list[TransitTimes | None]:
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
    found: list[list[_Panel]] = [[] for _ in range(size)]
    for _ in range(SETTINGS.rounds):
        if now.size == 0:
            break
        panels, force = _cut(scene, slides, now, first, time, tail, share, past)
        if panels.slide.size == 0:
            break
        guess = _guess(scene, slides, panels, force, time)
        solved = solved_on(scene, slides, panels, guess, tail)
        fast = np.all(_leaves(solved.kept, SETTINGS.slow), axis=1)
        on = solved.fine & fast
        going = []
        for c in np.unique(panels.slide):
            mine = np.flatnonzero(panels.slide == c)
            held = mine[np.cumprod(on[mine], dtype=bool)]
            for p in held:
                panel = _Panel(
                    first=first[c],
                    span=panels.span[p],
                    times=solved.times[p],
                    tail=solved.tail[p],
                    kept=np.exp(np.mean(np.log(solved.kept[p]))),
                    last=solved.kept[p, -1],
                )
                found[c].append(panel)
                first[c], time[c] = first[c] + panel.span, panel.times[-1]
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
                past[c] = np.interp(
                    slides.late[c], solved.times[failed], panels.number[failed]
                )
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


class _Panel(NamedTuple):
    """A panel that holds; `kept`: of a well of it on the average, `last`: of its last."""

    first: np.ndarray
    span: np.ndarray
    times: np.ndarray
    tail: np.ndarray
    kept: np.ndarray
    last: np.ndarray


def _curve(panels: list[_Panel]) -> TransitTimes | None:
    if not panels:
        return None
    every = stacked(panels)
    return TransitTimes(
        edges=np.append(every.first, every.first[-1] + every.span[-1]),
        starts=np.append(every.times[:, 0], every.times[-1, -1]),
        series=(every.times - every.times[:, :1]) @ TO_PANEL_SERIES.T,
        tail=every.tail,
        kept=every.kept,
        last=float(every.last[-1]),
    )
