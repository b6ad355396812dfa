"""Directional dry friction as the limit of viscous motion over a wiggly surface.

Batched convergence studies of the systems of P. Gidoni and A. DeSimone, "On the genesis
of directional friction through bristle-like mediating elements" (2017), in JAX.

Names are imported when first used, so `import frictionjax` costs nothing.
"""

import importlib
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_HOME = {
    "profiles": "profiles",
    "bristles": "bristles",
    "supports": "supports",
    "loads": "loads",
    "measured": "measured",
    "plot": "plot",
    "Scene": "scene",
    "GivenPotential": "potentials",
    "potential": "potentials",
    "friction": "friction_law",
    "solve_limit": "limit_system",
    "solve": "wiggly.trajectory",
    "Status": "wiggly.status",
    "certify": "certificate",
    "sweep": "sweeps",
    "study": "studies",
    "work_precision": "cost_of_accuracy",
    "predict_cost": "cost_prediction",
    "order_cost": "eps_grids",
    "fit_budget": "cost_prediction",
    "fit_angle": "design.angle",
    "fit_slide": "design.slide_fit",
    "fit_slide_profile": "design.slide_profile",
    "steady_slide": "design.steady_slide",
    "check_design": "design.design_check",
    "tolerance": "design.tolerance",
    "design_map": "design.maps",
    "Target": "design.targets",
    "fit_profile": "design.profile_fit",
    "Trace": "design.trace",
    "simulate_trace": "design.trace",
    "fit_trace": "design.trace_fit",
    "load_scene": "scene_files",
    "save_scene": "scene_files",
    "use_fast_cpu": "compilation",
    "keep_compiled": "compilation",
}

__all__ = [*_HOME, "__version__"]

if TYPE_CHECKING:
    from . import bristles as bristles
    from . import loads as loads
    from . import measured as measured
    from . import plot as plot
    from . import profiles as profiles
    from . import supports as supports
    from .certificate import certify as certify
    from .compilation import keep_compiled as keep_compiled
    from .compilation import use_fast_cpu as use_fast_cpu
    from .cost_of_accuracy import work_precision as work_precision
    from .cost_prediction import fit_budget as fit_budget
    from .cost_prediction import predict_cost as predict_cost
    from .design.angle import fit_angle as fit_angle
    from .design.design_check import check_design as check_design
    from .design.maps import design_map as design_map
    from .design.profile_fit import fit_profile as fit_profile
    from .design.slide_fit import fit_slide as fit_slide
    from .design.slide_profile import fit_slide_profile as fit_slide_profile
    from .design.steady_slide import steady_slide as steady_slide
    from .design.targets import Target as Target
    from .design.tolerance import tolerance as tolerance
    from .design.trace import Trace as Trace
    from .design.trace import simulate_trace as simulate_trace
    from .design.trace_fit import fit_trace as fit_trace
    from .eps_grids import order_cost as order_cost
    from .friction_law import friction as friction
    from .limit_system import solve_limit as solve_limit
    from .potentials import GivenPotential as GivenPotential
    from .potentials import potential as potential
    from .scene import Scene as Scene
    from .scene_files import load_scene as load_scene
    from .scene_files import save_scene as save_scene
    from .studies import study as study
    from .sweeps import sweep as sweep
    from .wiggly.status import Status as Status
    from .wiggly.trajectory import solve as solve


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'frictionjax' has no attribute {name!r}")
    module = importlib.import_module(f".{_HOME[name]}", __name__)
    value = module if _HOME[name] == name else getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
