"""Crawlers, in the limit and at finite eps."""

from typing import Any

import jax.numpy as jnp
import numpy as np

from .._checks import (
    as_real,
    is_concrete,
    is_known,
    require,
    require_real,
    require_whole,
    with_nan,
)
from ..bristles import AbstractBristle
from ..loads import AbstractLoad
from ..model import (
    Scene,
    coefficients_jit,
    known_turning_points,
    require_reach,
    require_times,
    require_told_apart,
    strips_at,
)
from ..profiles import AbstractProfile
from ..wiggly import MAX_STEPS, require_accuracy
from .crawler_motion import CrawlerMotion
from .limit_gait import is_alike, limit_gait
from .settings import SETTINGS
from .spring_between import foot_on_spring
from .wiggly_gait import CrawlRequest, wiggly_gait

__all__ = ["CrawlerMotion", "crawler"]


@with_nan
def crawler(
    profile: AbstractProfile,
    bristle: AbstractBristle,
    stiffness: Any,
    breathing: AbstractLoad,
    duration: Any,
    ts: Any = None,
    *,
    length: Any = 0.0,
    eps: Any = None,
    gamma: Any = 1.0,
    cycle: Any = None,
    accuracy: Any = 1e-3,
    max_steps: int = MAX_STEPS,
) -> CrawlerMotion:
    """Two bristles on one surface, and between them a spring whose rest length breathes.

    `profile` and `bristle`: of both feet. `stiffness` k of the spring in N/m; its rest
    length is `length` in m and what `breathing` adds, a part of `loads` read as m: L(t).
    The rear foot starts at 0, the front one at L(0); only changes of L matter, but for the
    phase of the front foot. `duration` and `ts` in s, not decreasing; 201 evenly spaced
    times where None. `cycle` in s: that of the breathing where it has a period.

    Without `eps` the limit: dry friction at both feet, exact. As one foot is held more than
    the other, it moves forwards where `rho_plus < -rho_minus`, and in each cycle in which
    L goes once up and down by dl it gets `max(0, dl - 2 rho_f/k)` far, with the smaller
    friction rho_f: the front foot as the spring grows, the rear one as it shrinks. With
    `eps` in m and `gamma` the feet slip over the wiggles, each slip of both is integrated,
    `eps^gamma x1' = T - V_eps'(x1)`, `eps^gamma x2' = -T - V_eps'(x2)`, until runs at
    two tolerances agree to `accuracy`: the error of places in eps at times outside slips,
    and of the dissipation over its final value. Where friction is the same both ways which
    foot slips first may hang on nothing at all: then the status is SENSITIVE. `max_steps`
    of one run.

    Returns a `CrawlerMotion`: `.ts .rear .front .position .tension .dissipation`, `.step`
    of the last cycle in m, `.closed_form`, and `.ok .status .message`.

    Raises `ValueError` for arguments out of range, traced numbers, for the limit of a
    bristle with the same friction both ways, and at an eps at which the bristle loses its
    contact.

    >>> rod = fx.bristles.AngularSpring(1.0, length=1.414, height=1.0, rest_angle=0.3)
    >>> parts = scene.profile, rod, 1.0, fx.loads.Sine(amplitude=0.5, period=1.0)
    >>> fx.crawler(*parts, duration=3.0, length=2.0)
    CrawlerMotion(OK: 201 times, 0.911749 m a cycle, the limit)
    >>> wiggly = fx.crawler(*parts, duration=3.0, length=2.0, eps=0.01)
    >>> print(f"{wiggly.step:.2f} m: {wiggly.message}")
    0.84 m: every number can be trusted
    """
    scene = foot_on_spring(profile, bristle, stiffness, breathing, duration, length)
    known = is_concrete(scene) and is_known(ts)
    require(known, "crawler", "traced numbers", "known ones: no derivative goes through it")
    times = np.asarray(require_times(scene, ts), dtype=float)
    require_real("gamma", gamma, "gamma > 0", lambda g: g > 0)
    if cycle is None:
        cycle = getattr(breathing, "period", None)
    else:
        require_real("cycle", cycle, "cycle > 0 in s", lambda lasts: lasts > 0)
    lasts = np.nan if cycle is None else float(cycle)
    end = float(scene.duration)
    # The last cycle's ends, beside what is asked for; 3 * 0.1 > 0.3.
    last = [max(end - lasts, 0.0), end] if lasts <= end * (1 + SETTINGS.alike) else []
    stops = np.union1d(times, last)
    at = np.searchsorted(stops, times)
    if eps is None:
        gait = limit_gait(scene, stops)
    else:
        gait = wiggly_gait(scene, stops, _request(scene, eps, gamma, accuracy, max_steps))
    middle = (gait.rear + gait.front)[np.searchsorted(stops, last)] / 2
    return CrawlerMotion(
        times,
        rear=gait.rear[at],
        front=gait.front[at],
        tension=gait.tension[at],
        dissipation=gait.dissipation[at],
        step=float(middle[1] - middle[0]) if last else np.nan,
        closed_form=_closed_form(scene, *last) if last else np.nan,
        code=gait.code,
        residual=None if gait.residual is None else gait.residual[at],
        error=gait.error,
        steps=gait.steps,
    )


def _request(
    scene: Scene, eps: Any, gamma: Any, accuracy: Any, max_steps: Any
) -> CrawlRequest:
    require_real("eps", eps, "eps > 0", lambda e: e > 0)
    require_accuracy(accuracy)
    require_whole("max_steps", max_steps)
    require_reach(scene.potential, jnp.asarray(as_real(eps)))
    require_told_apart(scene, eps)
    return CrawlRequest(float(eps), float(gamma), float(accuracy), max_steps)


def _closed_form(scene: Scene, start: float, end: float) -> float:
    """Of a foot that friction holds like a rigid-plastic one, in a cycle of one breath.

    NaN where L does not come back, or more than once up and down, and where friction is
    the same both ways.
    """
    law = coefficients_jit(scene.potential)
    plus, minus = float(law.rho_plus), -float(law.rho_minus)
    turns = known_turning_points(scene.load, scene.duration, scene.turns)
    times = np.concatenate([[start], turns[(turns > start) & (turns < end)], [end]])
    loads, _, _ = strips_at(scene, plus, -minus, times)
    wide = float(np.ptp(loads))
    moves = np.diff(loads)
    moves = moves[np.abs(moves) > SETTINGS.alike * wide]
    changes = np.count_nonzero(np.sign(moves) != np.sign(np.roll(moves, 1)))
    returns = abs(loads[-1] - loads[0]) <= SETTINGS.alike * wide
    if is_alike(plus, minus) or not returns or changes > 2:
        return np.nan
    stiffness = float(scene.support.stiffness_at(0.0))
    way = max(0.0, wide - 2 * min(plus, minus)) / stiffness
    return way if plus < minus else -way
