"""What is odd about a trace before any surface is looked for: its unit, sign, noise."""

from typing import NamedTuple

import numpy as np

from ..._checks import as_text
from ...wiggly import pulls_at
from ..measured_trace import Trace
from .energy import TraceStates, seen_as, share_gained
from .outliers import outliers_of
from .problem import TraceProblem
from .settings import SETTINGS
from .status import TraceStatus

_SMALLER, _LARGER = (1e-3, 1e-6, 1e-9), (1e3, 1e6, 1e9)  # the nearest first
_GAINS = (
    "its tip would gain energy over whole wells, {:.0%} of its work, as with another load, "
    "start in time or offset"
)
_PREFIX = {1e-3: "m", 1e-6: "u", 1e-9: "n", 1e3: "k", 1e6: "M", 1e9: "G"}


class Oddity(NamedTuple):
    """Why no fit is tried, and the same in words with its numbers."""

    status: TraceStatus
    text: str


def oddity_of(trace: Trace, problem: TraceProblem) -> Oddity | None:
    """What makes a fit pointless; None where nothing is odd.

    Units first: a trace in mN looks as if it were noise.
    """
    eps, own = float(problem.eps), seen_as(problem, trace)
    size = float(np.percentile(np.abs(own.force), 98))
    large = size > SETTINGS.too_large * own.most > 0
    noise = _noise(own, eps)
    if large:
        built = f"{as_text(size)} N, where the load can build up {as_text(own.most)} N"
        why = Oddity(TraceStatus.IMPOSSIBLE, f"its force reaches {built}")
        return _mended(problem, trace, _SMALLER) or noise or why
    gained = share_gained(own, eps, SETTINGS.explained)
    if noise:
        return noise
    gains = _gains(gained)
    mended = _mended(problem, trace, (*_LARGER, 1.0)) if gains else None
    if mended or (outliers := _outliers(trace, problem)):
        return mended or outliers
    if gains:
        return Oddity(TraceStatus.IMPOSSIBLE, _GAINS.format(gained))
    return _still(own, eps) or _elsewhere(own, problem)


def _gains(share: float) -> bool:
    return share > SETTINGS.gained


def _outliers(trace: Trace, problem: TraceProblem) -> Oddity | None:
    """Samples far off all others: what they are, and how they are left out."""
    found = outliers_of(trace.values, _start_of(trace, problem))
    if not found.size:
        return None
    first, unit = found[0], "N" if trace.quantity == "force" else "m"
    place = f"{as_text(trace.values[first])} {unit} at t = {as_text(trace.ts[first])} s"
    more = "" if found.size == 1 else f", the first of {found.size}"
    told = f"{trace.quantity} = {place}{more}; masked (numpy.ma) they are left out"
    return Oddity(TraceStatus.OUTLIERS, told)


def _start_of(trace: Trace, problem: TraceProblem) -> float:
    """What is measured at the start of the scene."""
    z0 = float(problem.scene.z0)
    if trace.quantity == "z":
        return z0
    load, held, _ = pulls_at(problem.scene, np.zeros(1), np.array([z0]))
    return float(load[0] - held[0])


def _still(seen: TraceStates, eps: float) -> Oddity | None:
    """A tip that stays in its well, and does not follow the force there.

    In a well the force rises with z. Of the load in place of the force z is noise.
    """
    low, high = np.percentile(seen.z, [2, 98])
    if high - low >= eps:
        return None
    z, force = seen.z - np.mean(seen.z), seen.force - np.mean(seen.force)
    if z @ force > SETTINGS.follows * np.linalg.norm(z) * np.linalg.norm(force):
        return None
    changed = f"while the force changes by {as_text(np.ptp(seen.force))} N"
    noise = seen.sd or seen.scatter / seen.stiffness
    if high - low <= max(SETTINGS.still * eps, SETTINGS.sure * noise):
        told = f"z is constant {changed}, as if it were the load"
    else:
        told = f"z moves by {(high - low) / eps:.2g} eps {changed}"
    return Oddity(TraceStatus.NO_SLIDE, told)


def _elsewhere(seen: TraceStates, problem: TraceProblem) -> Oddity | None:
    """A first sample too far from z0 for what happens until then, as with an offset."""
    eps, after, z0 = float(problem.eps), float(problem.ts[0]), float(problem.scene.z0)
    drag = eps ** float(problem.gamma)
    size = float(np.percentile(np.abs(seen.force), 98))
    # Before the first sample, the fastest that this force could have moved the tip.
    way = min(after * 2 * size / drag, seen.most / seen.stiffness + eps)
    sd = seen.sd or seen.scatter / seen.stiffness  # slips scatter too
    away = float(seen.z[0]) - z0
    if abs(away) <= way + max(SETTINGS.sure * sd, SETTINGS.blind * eps):
        return None
    told = (
        f"at t = {as_text(after)} s z is {as_text(seen.z[0])} m, where the scene starts at "
        f"{as_text(z0)} m, as with an offset of {as_text(away * seen.stiffness)} N or "
        "another z0"
    )
    return Oddity(TraceStatus.IMPOSSIBLE, told)


def _mended(problem: TraceProblem, trace: Trace, factors: tuple) -> Oddity | None:
    """Whether the trace obeys in another unit, with its sign or with the other."""
    eps = float(problem.eps)
    for factor in (sign * factor for sign in (1.0, -1.0) for factor in factors):
        if factor == 1.0:
            continue
        other = seen_as(problem, trace, factor)
        if not np.all(np.isfinite(other.z)) or _noise(other, eps):
            continue
        if share_gained(other, eps) <= SETTINGS.mended:
            return _told(trace.quantity, factor)
    return None


def _told(quantity: str, factor: float) -> Oddity:
    """What the trace is if this factor mends it."""
    times, unit = abs(factor), "N" if quantity == "force" else "m"
    size = f"{max(times, 1 / times):.0f} times too {'large' if times < 1 else 'small'}"
    scaled = f"{quantity} is {size}, as if in {_PREFIX.get(times)}{unit}"
    turned = f"{quantity} obeys with its sign turned round"
    if factor > 0:
        return Oddity(TraceStatus.WRONG_SCALE, scaled)
    text = turned if times == 1 else f"{turned}; {scaled}"
    return Oddity(TraceStatus.WRONG_SIGN, text)


def _noise(seen: TraceStates, eps: float) -> Oddity | None:
    """Noise that hides the wells, or the friction itself."""
    scatter = seen.scatter / seen.stiffness
    size = float(np.sqrt(np.mean(seen.force**2)))
    sd = max(seen.sd, scatter)
    told = f"noise of {as_text(sd * seen.stiffness)} N, {as_text(sd / eps)} eps of z"
    if seen.sd > SETTINGS.blind * eps:
        return Oddity(TraceStatus.NOISE, f"it has, by its uncertainty, {told}")
    if size <= SETTINGS.drowned * seen.stiffness * seen.sd:
        return Oddity(TraceStatus.NOISE, f"a friction of {as_text(size)} N with {told}")
    # Slips between samples scatter too, but gain no energy.
    rough = scatter > SETTINGS.rough * eps or size < SETTINGS.drowned * seen.scatter
    if scatter > SETTINGS.roughest * eps or (rough and _gains(share_gained(seen, eps))):
        return Oddity(TraceStatus.NOISE, f"neighbouring samples scatter, {told}")
    return None
