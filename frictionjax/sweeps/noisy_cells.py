"""Cells of a scene with thermal noise: a path each."""

from collections.abc import Callable
from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Float, UInt32

from .._checks import cells_of
from .._compile import crew
from ..effects import Noise
from ..limit import solve_limit
from ..model import Scene, coefficients_jit, strips_at
from ..stochastic import TooManyStepsError, cell_keys, noisy_path
from ..wiggly import Status
from .noiseless import without_noise

_SAMPLES = 16  # of the way of one well, at which suprema are looked for
_MOST_SAMPLES = 2**17


class NoisyColumns(NamedTuple):
    """`values` by name, a row a cell; `keys` (cells, 2) of their paths; `share` (cells,),
    `T_eps/(eps (rho_plus - rho_minus))`."""

    values: dict[str, np.ndarray]
    keys: UInt32[np.ndarray, "cells 2"]
    share: Float[np.ndarray, " cells"]


class _Watched(NamedTuple):
    """Sorted times (s) at which a path is compared with the limit, and its values in m."""

    times: Float[np.ndarray, " n"]
    z_limit: Float[np.ndarray, " n"]
    lower: Float[np.ndarray, " n"]
    upper: Float[np.ndarray, " n"]


def noisy_columns(
    scene: Scene,
    noise: Noise,
    eps: Float[np.ndarray, " e"],
    gamma: Float[np.ndarray, " g"],
    *,
    ts: Float[np.ndarray, " n"],
    key: UInt32[np.ndarray, " 2"],
    suprema: bool,
    report: Callable[[float], None],
) -> NoisyColumns:
    """A path of each cell, with a key of its own that its eps and gamma name.

    Suprema are those at `ts` and at even times, 16 while the limit goes one well, 131,072
    at most: a path has no largest distance that steps would not change.
    """
    sizes, powers = cells_of(eps, gamma)
    keys = cell_keys(key, sizes, powers)
    found = coefficients_jit(scene.potential)
    bounds = float(found.rho_plus), float(found.rho_minus)
    known = {e: _watched(scene, bounds, ts, e if suprema else None) for e in eps}

    def cell(index: int) -> dict[str, np.ndarray]:
        size, watched = sizes[index], known[sizes[index]]
        numbers = {"eps": size, "gamma": powers[index], "ts": watched.times}
        try:
            path = noisy_path(scene, noise, key=keys[index], **numbers)
        except TooManyStepsError:
            nothing, status = np.full(watched.times.shape, np.nan), Status.MAX_STEPS
            return _row(nothing, status, 0, ts, watched, suprema)
        finally:
            report(1 / sizes.size)
        status = Status.OK if path.ok else Status.NOT_FINITE
        return _row(path.z, status, path.steps, ts, watched, suprema)

    rows = list(crew("noise").map(cell, range(sizes.size)))
    values = {name: np.stack([row[name] for row in rows]) for name in rows[0]}
    energy = np.asarray(noise.temperature_at(sizes))
    return NoisyColumns(values, keys, energy / (sizes * (bounds[0] - bounds[1])))


def _watched(
    scene: Scene,
    bounds: tuple[float, float],
    ts: Float[np.ndarray, " n"],
    eps: float | None,
) -> _Watched:
    """Times of the suprema at this eps, and `ts` among them; `ts` alone where None."""
    if eps is None:
        none = np.full(ts.shape, np.nan)
        return _Watched(ts, none, none, none)
    end, quiet = float(scene.duration), without_noise(scene)
    coarse = np.asarray(solve_limit(quiet, np.linspace(0.0, end, 2049)).z)
    wells = np.sum(np.abs(np.diff(coarse))) / eps
    # A power of two: few programs of the limit.
    count = 2 ** int(np.ceil(np.log2(max(_SAMPLES * wells, 1024))))
    even = np.linspace(0.0, end, min(count, _MOST_SAMPLES))
    times = np.sort(np.concatenate([ts, even]))
    z = np.asarray(solve_limit(quiet, times).z)
    _, lower, upper = strips_at(scene, *bounds, times)
    return _Watched(times, z, np.asarray(lower), np.asarray(upper))


def _row(
    z: Float[np.ndarray, " n"],
    status: Status,
    steps: int,
    ts: Float[np.ndarray, " t"],
    watched: _Watched,
    suprema: bool,
) -> dict[str, np.ndarray]:
    """Values of one cell by name."""
    row = {
        "z": z[np.searchsorted(watched.times, ts)],
        "status": np.asarray(int(status), dtype=np.int8),
        "how": np.asarray(0, dtype=np.int8),
        "steps": np.asarray(steps),
        "rejected": np.asarray(0),
    }
    if suprema:
        outside = np.maximum(watched.lower - z, z - watched.upper)
        row["sup_error"] = np.max(np.abs(z - watched.z_limit))
        row["strip_excess"] = np.maximum(np.max(outside), 0.0)
        if status != Status.OK:
            row |= {"sup_error": np.asarray(np.nan), "strip_excess": np.asarray(np.nan)}
    return jax.tree_util.tree_map(np.asarray, row)
