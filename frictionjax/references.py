"""References to measure errors against, each checked by a second, different method."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from .error_measures import MEASURES, errors_of
from .instants import Instants, slips_of
from .scene import Scene
from .wiggly.rosenbrock_solvers import Rodas5P
from .wiggly.status import Status
from .wiggly.trajectory import solve

# Slips that lanes one after the other (0.4 ms each) and side by side (10 us) may take.
_ONE_BY_ONE, _EVERY = 2e4, 2e6
_TIGHTER, _TIGHTEST = 1e-2, 1e-9
# Tighter accuracies are not judged: the reference's own would be no tenth of them.
LEAST_JUDGED = 10 * _TIGHTEST


class Reference(NamedTuple):
    """States (m) and dissipation (J) at the instants, and how far they can be trusted.

    `errors`: what `errors_of` says of a second method, by name; as bad as can be, inf and
    for mescd -inf, where there is none.
    `ways`: the two methods.
    """

    z: np.ndarray
    dissipation: np.ndarray
    in_slip: np.ndarray
    errors: dict[str, float]
    ways: str


class _Found(NamedTuple):
    """One method's states just before, at and after the instants, shape (3, n)."""

    way: str
    z: np.ndarray
    dissipation: np.ndarray


def reference(
    scene: Scene, eps: float, gamma: float, when: Instants, accuracy: float
) -> Reference:
    """The reference of one cell, a hundred times tighter than `accuracy` down to 1e-9.

    The first of these that succeed: every slip one after the other through diffrax with
    Rodas5P; every slip in lanes; windows; windows ten times tighter still. The first is
    the reference, the second says how far it can be trusted. (Beyond 2 million slips there
    are windows only: `ways` says so.)
    """
    ts, back = when.around(float(scene.duration))
    tight = max(_TIGHTER * accuracy, _TIGHTEST)
    found: list[_Found] = []
    for name, method, asked in _ways(slips_of(scene, eps), tight):
        one = solve(scene, eps, gamma, ts, asked, method)
        if one.status == Status.OK:
            z, spent = np.asarray(one.z)[back], np.asarray(one.dissipation)[back]
            found.append(_Found(f"{name} at {asked:.0e}", z, spent[1]))
        if len(found) == 2:
            break
    return _compared(when, eps, float(scene.duration), found)


def _ways(slips: float, tight: float) -> Iterator[tuple]:
    if slips <= _ONE_BY_ONE:
        yield "one slip after the other", Rodas5P(), tight
    if slips <= _EVERY:
        yield "every slip in lanes", "resolved", tight
    yield "windows", "windowed", tight
    yield "windows", "windowed", max(0.1 * tight, 0.1 * _TIGHTEST)


def _compared(when: Instants, eps: float, end: float, found: list[_Found]) -> Reference:
    unknown = dict.fromkeys(MEASURES, float("inf")) | {"mescd": -float("inf")}
    if not found:
        blank = np.full(when.ts.size, np.nan)
        return Reference(blank, blank, np.zeros(when.ts.size, dtype=bool), unknown, "none")
    ways = " against ".join(one.way for one in found)
    z, spent = found[0].z[1], found[0].dissipation
    in_slip = when.in_slip(found[0].z, eps, end)
    errors = unknown
    if len(found) == 2:
        other = found[1]
        errors = errors_of(other.z[1], other.dissipation, z, spent, in_slip, when, eps)
    return Reference(z, spent, in_slip, errors, ways)
