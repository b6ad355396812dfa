"""Which eps give the orders of a study, and what that costs: tables."""

import numpy as np

from .._text import in_columns
from ..cost import OrderCost, order_cost
from .job import Job, joined


def run_order_cost(job: Job, within: float) -> str:
    """Tables of the eps grids that give the order of each gamma to +- `within`."""
    eps, gammas = job.study["eps"], np.unique(job.study["gamma"]).tolist()
    sections = [("", line) for line in job.notes]
    for gamma in gammas:
        found = order_cost(job.scene, eps, gamma, within, job.study["accuracy"])
        sections.append((f"gamma = {gamma:.4g}: {found.message}", _grid_table(found)))
    sections.append(("", _GRIDS.format(within=within)))
    return joined(sections)


_GRIDS = (
    "Grids that no cheaper one beats, of those that all smaller eps confirm, or that end\n"
    "where the range does, with no smaller eps. interval: half of the 95% interval of the\n"
    "order of sup |z_eps - z| as eps -> 0, the widest of as many grids of this kind as\n"
    "`of` says; s: predicted for this machine. Above the table stands, of the grids\n"
    "within +-{within:g} that take at most a quarter longer than the cheapest of them,\n"
    "which predictions do not tell apart, the one of the narrowest interval."
)


def _grid_table(found: OrderCost) -> str:
    rows = [
        (
            f"{grid.eps_max:.3g}",
            f"{grid.eps_min:.3g}",
            str(grid.points),
            f"{grid.order:.3f}",
            f"{grid.half_width:.2g}",
            str(grid.laid),
            f"{grid.seconds:.2g}",
        )
        for grid in found.front
    ]
    if not rows:
        return "none"
    return in_columns(("eps from", "to", "eps", "order", "interval", "of", "s"), rows)
