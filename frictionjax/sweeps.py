"""All cells eps x gamma of a scene, integrated in vmapped blocks, as a data set."""

from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import xarray as xr
from tqdm import tqdm

from .admissibility import require_reach
from .arguments import as_real, require_numbers, require_x64
from .cells import Cell, run_block
from .coefficients import coefficients_jit
from .limit_system import (
    LimitSolution,
    require_start_in_strip,
    solve_limit,
)
from .provenance import describe
from .scene import Scene, require_times
from .strip import strips_at
from .wiggly.engine import integrate_cells
from .wiggly.methods import is_ours, solver_of
from .wiggly.status import Status
from .wiggly.trajectory import require_accuracy

# Lanes of one compiled block. 8 cost 1.0 us a lane and step, 32 cost 0.8, but wide blocks
# mix cells of unequal length and each waits for its longest.
_LANES = 8
_WORKERS = 2  # blocks under way at once; XLA runs each on one core


class Block(NamedTuple):
    """Cells that run together: their numbers, and the values of all lanes."""

    cells: np.ndarray
    eps: np.ndarray
    gamma: np.ndarray

    @property
    def cost(self) -> float:
        """Relative: the longest lane has about 1/eps slips."""
        return float(1 / self.eps.min())


def _blocks(eps: np.ndarray, gamma: np.ndarray) -> list[Block]:
    """Cut the grid into blocks of equal width and similar eps, the longest first.

    Cells are numbered with gamma outside and eps inside; the last block is filled up with
    copies of its last cell.
    """
    lane_eps, lane_gamma = cells_of(eps, gamma)
    order = np.lexsort((lane_gamma, lane_eps))
    groups = [order[i : i + _LANES] for i in range(0, order.size, _LANES)]
    full = [np.pad(g, (0, _LANES - g.size), mode="edge") for g in groups]
    return [Block(g, lane_eps[f], lane_gamma[f]) for g, f in zip(groups, full, strict=True)]


def _run(scene, blocks, ts, accuracy, solver, balanced, progress: bool) -> Cell:
    """Run the blocks on all cores and put the cells back in order."""

    def one(block: Block) -> Cell:
        found = run_block(
            scene,
            jnp.asarray(block.eps),
            jnp.asarray(block.gamma),
            ts,
            accuracy,
            solver,
            balanced,
        )
        return jax.tree_util.tree_map(lambda a: np.asarray(a)[: block.cells.size], found)

    total = sum(block.cost for block in blocks) * (1 + 1e-9)  # never above 100% by rounding
    bar = tqdm(total=1.0, disable=not progress, bar_format=_BAR, desc="cells")
    with bar, ThreadPoolExecutor(_WORKERS) as pool:
        done = [one(blocks[-1])]  # the shortest compiles the program for all
        bar.update(blocks[-1].cost / total)
        for found, block in zip(pool.map(one, blocks[:-1]), blocks[:-1], strict=True):
            done.append(found)
            bar.update(block.cost / total)
        bar.update(bar.total - bar.n)
    order = np.argsort(np.concatenate([b.cells for b in [blocks[-1], *blocks[:-1]]]))
    return jax.tree_util.tree_map(lambda *parts: np.concatenate(parts)[order], *done)


_BAR = "{desc}: {percentage:3.0f}% |{bar}| {elapsed} so far, {remaining} to go"


def _run_lanes(
    scene, eps, gamma, ts, accuracy, method, balanced, progress, suprema
) -> dict | None:
    """Values of all cells through lanes, by name; None where they cannot say."""
    lane_eps, lane_gamma = cells_of(eps, gamma)
    with tqdm(total=1.0, disable=not progress, bar_format=_BAR, desc="cells") as bar:

        def report(share: float) -> None:
            bar.update(min(share, bar.total - bar.n))

        wanted = accuracy, method, balanced, report, suprema
        found = integrate_cells(scene, lane_eps, lane_gamma, np.asarray(ts), *wanted)
    if found is None:
        return None
    values = found._asdict()
    values["status"] = values["status"].astype(np.int8)
    values["how"] = values["how"].astype(np.int8)
    values["bracket"] = values.pop("gap")
    failed = ~np.isin(values["status"], (Status.OK, Status.UNBALANCED, Status.ROUGH_SURVEY))
    for name in ("residual", "dissipation_gap", "dissipation_error", *_SUPREMA):
        values[name] = np.where(failed, np.nan, values[name])
    unused = ["running_residual", "survey_work_error"]
    if not balanced:
        unused += ["dissipation", "dissipation_error", "residual", "dissipation_gap"]
    return {name: value for name, value in values.items() if name not in unused}


_DIMS = ("gamma", "eps", "time")
_SUPREMA = ("sup_error", "strip_excess", "survey_error")


def grid_of(name: str, values: Any) -> np.ndarray:
    """Values of eps, falling, or of gamma, rising, each once.

    Raises `ValueError` where one is not a number > 0.
    """
    require_numbers(name, values, f"{name} > 0, a number or a list", lambda v: v > 0)
    array = np.unique(np.atleast_1d(np.asarray(values, dtype=float)).ravel())
    return array[::-1] if name == "eps" else array


def cells_of(eps: np.ndarray, gamma: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """eps and gamma of every cell of a grid, gamma outside, shape (cells,) each."""
    return np.tile(eps, np.size(gamma)), np.repeat(gamma, np.size(eps))


def sweep(
    scene: Scene,
    eps: Any,
    gamma: Any,
    ts: Any = None,
    accuracy: Any = 1e-3,
    method: Any = "auto",
    progress: bool = False,
    *,
    dissipation: bool = True,
    suprema: bool = True,
) -> xr.Dataset:
    """Solve all cells `eps` x `gamma` and compare each with the limit.

    `eps` in m and `gamma`: numbers or lists, in any order; `ts`, `accuracy` and `method`
    as in `solve`. `progress`: a bar on standard error. `dissipation=False` integrates no
    energies and leaves their variables out; `suprema=False` leaves out `sup_error`,
    `strip_excess` and `survey_error`. Without both only `z` at `ts` is left, and no slips
    between are looked at: two thirds of the time that suprema take.

    Returns a data set with dims (gamma, eps, time): `z`, `dissipation`; over (gamma, eps)
    `sup_error` = sup |z_eps - z| and `dissipation_error` over all of [0, T], `residual`
    of the energy-dissipation balance, `strip_excess` = sup dist(z_eps, strip) (Lemma 7),
    `dissipation_gap` (an estimate of the error of the dissipation), `viscosity`, `steps`,
    `rejected` and `status`; of the library's own methods also `how` and `bracket` over
    time (see `solve`), `sampled`, and `survey_error`, an estimate of what sampling slips
    adds to the error of `sup_error`; over time the limit's `z_limit`,
    `dissipation_limit`, the strip `z_minus`, `z_plus` and the load, `data["load"]`. Units
    and provenance are in the attributes; it goes to NetCDF and back without loss.

    A cell that fails has its status and NaNs and does not disturb the others.

    Raises `ValueError` for arguments out of range, z0 outside the strip at t = 0 (Theorem
    1 does not apply), or an eps at which the bristle loses contact.
    """
    require_x64(scene)
    eps, gamma = grid_of("eps", eps), grid_of("gamma", gamma)
    require_accuracy(accuracy)
    ts = require_times(scene, ts)
    require_start_in_strip(scene)
    require_reach(scene.potential, eps)
    solver = solver_of(method)
    limit = solve_limit(scene, ts)
    balanced, wanted = bool(dissipation), float(as_real(accuracy))
    values, name = None, type(solver).__name__
    if is_ours(method):
        options = wanted, str(method), balanced, progress, bool(suprema)
        values, name = _run_lanes(scene, eps, gamma, ts, *options), str(method)
    if values is None:
        blocks, tight = _blocks(eps, gamma), jnp.asarray(wanted)
        values = _cell_values(_run(scene, blocks, ts, tight, solver, balanced, progress))
    if not suprema:
        values = {key: v for key, v in values.items() if key not in _SUPREMA}
    shape = (gamma.size, eps.size)
    columns = {
        key: (_DIMS[: value.ndim + 1], value.reshape(*shape, *value.shape[1:]))
        for key, value in values.items()
    }
    columns["viscosity"] = (_DIMS[:2], eps ** gamma[:, None])
    columns |= {key: (_DIMS[2:], v) for key, v in _limit_values(scene, limit).items()}
    # All variables at once: one by one they are aligned anew, 1 ms each.
    data = xr.Dataset(columns, coords={"gamma": gamma, "eps": eps, "time": np.asarray(ts)})
    return describe(data, scene, accuracy=wanted, solver=name)


def _cell_values(cells: Cell) -> dict[str, np.ndarray]:
    values = {
        "z": cells.z,
        "sup_error": cells.deviation.sup_error,
        "strip_excess": cells.deviation.strip_excess,
        "status": np.asarray(cells.status, dtype=np.int8),
        "steps": cells.steps,
        "rejected": cells.rejected,
        "tolerance": cells.tolerance,
    }
    if cells.dissipation is not None:
        values |= {
            "dissipation": cells.dissipation,
            "dissipation_error": cells.deviation.dissipation_error,
            "residual": cells.residual,
            "dissipation_gap": cells.dissipation_gap,
        }
    return {name: np.asarray(value) for name, value in values.items()}


def _limit_values(scene: Scene, limit: LimitSolution) -> dict[str, np.ndarray]:
    found = coefficients_jit(scene.potential)
    rho = float(found.rho_plus), float(found.rho_minus)
    load, lower, upper = strips_at(scene, *rho, np.asarray(limit.ts))
    values = {
        "z_limit": limit.z,
        "dissipation_limit": limit.dissipation,
        "load": load,
        "z_minus": lower,
        "z_plus": upper,
    }
    return {name: np.asarray(value) for name, value in values.items()}
