"""Steps of Rosenbrock methods for a tip with mass."""

from typing import NamedTuple

from ..._checks import Real
from ..rosenbrock import Tableau, combine
from .massive_tip import FieldSlopes, MassiveTip, TipMotion


class MassiveStages(NamedTuple):
    """Of each part of a motion, one after the other; the last is the error."""

    tip: tuple[Real, ...] = ()
    speed: tuple[Real, ...] = ()
    lost: tuple[Real, ...] = ()
    work: tuple[Real, ...] = ()


class MassiveStep(NamedTuple):
    """Where a step ends, and its stages."""

    end: TipMotion
    stages: MassiveStages


def step_with_mass(
    tableau: Tableau, tip: MassiveTip, t: Real, size: Real, start: TipMotion
) -> MassiveStep:
    """One step of `size` s from `start` at time t.

    As `rosenbrock_step`, with a pair of unknowns a stage instead of one: `lost` and `work`
    act on nothing, and follow.
    """
    coupling = tip.coupling(t, start)
    stages = MassiveStages()
    rows = zip(tableau.a, tableau.c, tableau.times, tableau.time_derivative, strict=True)
    for a, c, time, by_time in rows:
        inside = _inside(start, a, stages)
        rates = tip.rates(t + time * size, inside)
        pushes = TipMotion(
            *(r + combine(c, k) / size for r, k in zip(rates, stages, strict=True))
        )
        if by_time:
            pushes = pushes._replace(
                speed=pushes.speed + size * by_time * coupling.speed_by_time,
                work=pushes.work + size * by_time * coupling.work_by_time,
            )
        found = _solved(coupling, 1 / (size * tableau.gamma), pushes)
        stages = MassiveStages(*((*k, new) for k, new in zip(stages, found, strict=True)))
    end = TipMotion(*(i + k[-1] for i, k in zip(inside, stages, strict=True)))
    return MassiveStep(end, stages)


def _inside(start: TipMotion, a: tuple[float, ...], stages: MassiveStages) -> TipMotion:
    return TipMotion(*(s + combine(a, k) for s, k in zip(start, stages, strict=True)))


def _solved(coupling: FieldSlopes, rate: Real, pushes: TipMotion) -> TipMotion:
    """`(rate - J) k = pushes` by Cramer's rule."""
    first, second = rate - coupling.tip_by_tip, rate - coupling.speed_by_speed
    across = coupling.tip_by_speed * coupling.speed_by_tip
    whole = first * second - across
    tip = (second * pushes.tip + coupling.tip_by_speed * pushes.speed) / whole
    speed = (first * pushes.speed + coupling.speed_by_tip * pushes.tip) / whole
    return TipMotion(
        tip=tip,
        speed=speed,
        lost=(pushes.lost + coupling.lost_by_speed * speed) / rate,
        work=(pushes.work + coupling.work_by_speed * speed) / rate,
    )
