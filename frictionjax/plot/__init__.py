"""Pictures of studies: each `draw...` returns a matplotlib Figure and shows nothing."""

from .convergence import draw as draw_convergence
from .dissipation import draw as draw_dissipation
from .loop import draw as draw_loop
from .paper import draw_mu_angular, draw_mu_slanted, draw_nap
from .trajectories import draw as draw_trajectories
from .work_precision import draw as draw_work_precision

__all__ = [
    "draw_convergence",
    "draw_dissipation",
    "draw_loop",
    "draw_mu_angular",
    "draw_mu_slanted",
    "draw_nap",
    "draw_trajectories",
    "draw_work_precision",
]
