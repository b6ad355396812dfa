"""Cells of a sweep by solvers of diffrax, in vmapped blocks on all cores."""

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from .._checks import cells_of, with_nan
from .._compile import crew
from ..model import Scene
from ..numerics import concatenated, rows_of
from .diffrax_cells import Cell, run_block

# Lanes of one compiled block. 8 cost 1.0 us a lane and step, 32 cost 0.8, but wide blocks
# mix cells of unequal length and each waits for its longest.
_LANES = 8


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


def run_blocks(
    scene: Scene,
    eps,
    gamma,
    ts,
    accuracy: float,
    solver,
    balanced: bool,
    report: Callable[[float], None],
) -> dict[str, np.ndarray]:
    """Values of all cells by name, as `sweep` keeps them, in the order of `cells_of`."""
    blocks = _blocks(eps, gamma)
    tight = jnp.asarray(accuracy)
    return _cell_values(_run(scene, blocks, ts, tight, solver, balanced, report))


def _run(scene, blocks, ts, accuracy, solver, balanced, report) -> Cell:
    """Run the blocks on all cores and put the cells back in order."""

    @with_nan
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

    total = sum(block.cost for block in blocks)
    done = [one(blocks[-1])]  # the shortest compiles the program for all
    report(blocks[-1].cost / total)
    for found, block in zip(crew("blocks").map(one, blocks[:-1]), blocks[:-1], strict=True):
        done.append(found)
        report(block.cost / total)
    order = np.argsort(np.concatenate([b.cells for b in [blocks[-1], *blocks[:-1]]]))
    return rows_of(concatenated(done), order)


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
