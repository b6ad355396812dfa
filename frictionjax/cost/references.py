"""References to measure errors against, each checked by a second, different method."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple

import numpy as np

from ..model import Scene
from ..wiggly import RODAS4P2, RODAS5P, Rodas4P2, Status, Tableau, integrate_cells, solve
from .error_measures import MEASURES, errors_of
from .instants import Instants, slips_of
from .settings import SETTINGS

# Tighter accuracies are not judged: the reference's own would be no tenth of them.
LEAST_JUDGED = 10 * SETTINGS.tightest


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

    The first two of these that succeed: every slip by Rodas4P2, one after the other through
    diffrax where there are few, in lanes where there are more; every slip in lanes by
    Rodas5P; windows by Rodas4P2, by Rodas5P, and by that ten times tighter still. The first
    is the reference, the second says how far it can be trusted: another scheme, as one and
    the same at the same tolerance shares its errors (those of Rodas5P both ways were 1.3 to
    50 times what their distance said).
    """
    ts, back = when.around(float(scene.duration))
    tight = max(SETTINGS.tighter * accuracy, SETTINGS.tightest)
    found: list[_Found] = []
    for name, method, asked in _ways(slips_of(scene, eps), tight):
        z, spent, status = method(scene, eps, gamma, ts, asked)
        if status == Status.OK:
            found.append(_Found(f"{name} at {asked:.0e}", z[back], spent[back][1]))
        if len(found) == 2:
            break
    return _compared(when, eps, float(scene.duration), found)


def _ways(slips: float, tight: float) -> Iterator[tuple[str, Callable, float]]:
    four, five = partial(_in_lanes, RODAS4P2), partial(_in_lanes, RODAS5P)
    if slips <= SETTINGS.one_by_one:
        yield "one slip after the other, Rodas4P2", _one_by_one, tight
    elif slips <= SETTINGS.every_slip:
        yield "every slip in lanes, Rodas4P2", partial(four, "resolved"), tight
    if slips <= SETTINGS.every_slip:
        yield "every slip in lanes, Rodas5P", partial(five, "resolved"), tight
    else:
        yield "windows, Rodas4P2", partial(four, "windowed"), tight
    for asked in (tight, max(0.1 * tight, 0.1 * SETTINGS.tightest)):
        yield "windows, Rodas5P", partial(five, "windowed"), asked


def _one_by_one(scene: Scene, eps, gamma, ts, asked) -> tuple:
    """States (m), dissipation (J) and status."""
    found = solve(scene, eps, gamma, ts, asked, Rodas4P2())
    return np.asarray(found.z), np.asarray(found.dissipation), found.status


def _in_lanes(tableau: Tableau, method: str, scene: Scene, eps, gamma, ts, asked) -> tuple:
    """The same by lanes with the scheme of a tableau."""
    found = integrate_cells(
        scene=scene,
        eps=np.array([eps]),
        gamma=np.array([gamma]),
        ts=ts,
        accuracy=asked,
        method=method,
        suprema=False,
        tableau=tableau,
    )
    if found is None:
        return None, None, Status.TOO_MANY_TURNS
    return found.z[0], found.dissipation[0], int(found.status[0])


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
