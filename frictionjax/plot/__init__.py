"""Pictures of studies: each `draw...` returns a matplotlib Figure and shows nothing."""

from .angle_fit import draw_angle_fit as draw_angle_fit
from .convergence import draw_convergence as draw_convergence
from .design import draw_profile_fit
from .design_maps import draw_design_map as draw_design_map
from .dissipation import draw_dissipation as draw_dissipation
from .loop import draw_loop as draw_loop
from .paper import draw_mu_angular, draw_mu_slanted, draw_nap
from .scenes import draw_scenes as draw_scenes
from .slide_profile import draw_slide_profile_fit
from .trace_fit import draw_trace_fit
from .trajectories import draw_trajectories as draw_trajectories
from .work_precision import draw_work_precision as draw_work_precision

__all__ = [
    "draw_angle_fit",
    "draw_convergence",
    "draw_design_map",
    "draw_dissipation",
    "draw_loop",
    "draw_mu_angular",
    "draw_mu_slanted",
    "draw_nap",
    "draw_profile_fit",
    "draw_scenes",
    "draw_slide_profile_fit",
    "draw_trace_fit",
    "draw_trajectories",
    "draw_work_precision",
]
