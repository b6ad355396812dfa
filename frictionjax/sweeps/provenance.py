"""Units, meanings and origin of a data set, in its attributes."""

import platform
from collections.abc import Sequence
from functools import lru_cache
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

from .._checks import exact_text
from ..model import Scene
from ..wiggly import Status

if TYPE_CHECKING:
    import xarray as xr

_PACKAGES = ("jax", "diffrax", "equinox", "numpy", "xarray")

_MEANING = {
    "eps": ("m", "period of the surface, length scale eps"),
    "gamma": ("1", "exponent of the viscosity eps^gamma"),
    "time": ("s", "time"),
    "z": ("m", "state of the wiggly system, z_eps"),
    "z_spread": ("m", "standard deviation of the states of an array's bristles"),
    "root": ("m", "root u of the rod that turns over"),
    "mode": ("1", "1: the rod as it stands at first; -1: turned over; 0: in between"),
    "root_limit": ("m", "root u of the limit system"),
    "mode_limit": ("1", "mode of the limit system"),
    "jumps": ("1", "jumps of the limit"),
    "jump_loss": ("J", "energy that the limit loses in jumps"),
    "graph_error": ("m", "distance of the graphs of z_eps and z, jumps filled"),
    "dissipation_graph_error": ("J", "distance of the graphs of both dissipations"),
    "velocity": ("m s-1", "velocity of the wiggly system, z_eps'"),
    "beta": ("1", "m_eps max|W''| eps^(-1-2 gamma): overdamped far below 1"),
    "thermal_share": ("1", "T_eps/(eps (rho_plus - rho_minus)), of the energy of a slip"),
    "path_key": (None, "key of the path with noise, for solve"),
    "spread": ("m", "largest distance of runs at other tolerances"),
    "compression": ("N", "largest compression along the rod at the times asked for"),
    "buckling_share": ("1", "it over the critical load: below 1 not shown to buckle"),
    "sprung_share": ("1", "it over the critical load of the rod on its spring"),
    "sup_error": ("m", "sup over [0, T] of |z_eps - z|"),
    "strip_excess": ("m", "sup over [0, T] of the distance of z_eps from the strip"),
    "status": (None, "how the cell ended"),
    "steps": ("1", "steps tried"),
    "rejected": ("1", "steps rejected"),
    "tolerance": ("1", "tolerance of a step in periods of the surface"),
    "dissipation": ("J", "energy dissipated since t = 0, int eps^gamma z'^2"),
    "dissipation_error": ("J", "sup over [0, T] of |dissipation - dissipation_limit|"),
    "dissipation_gap": ("J", "estimate of the error of the dissipation at T"),
    "how": ("1", "0: every slip since z0; 1: a bracket has closed; 2: from a slip map"),
    "bracket": ("1", "how closely brackets have closed, in units of eps"),
    "sampled": ("1", "share of the way known from some of its slips"),
    "survey_error": ("m", "estimate of what sampling slips adds to the error of sup_error"),
    "residual": ("J", "residual of the energy-dissipation balance on [0, T]"),
    "viscosity": ("N s m-1", "viscosity eps^gamma"),
    "z_limit": ("m", "state of the limit system"),
    "dissipation_limit": ("J", "energy dissipated by the limit system, int R(z')"),
    "load": ("N", "load l(t)"),
    "z_minus": ("m", "lower edge of the strip"),
    "z_plus": ("m", "upper edge of the strip"),
    "scene": (None, "label of the scene"),
    "parts": (None, "parts and numbers of the scene"),
    "law_phase": ("1", "phase in a well"),
    "law_well_force": ("N", "force of a well, W'"),
    "law_well_force_change": ("N m-1", "its change with eps"),
    "law_length": ("s", "length of a stretch of time"),
    "law_pull": ("N", "change of the load in it"),
    "law_speed": ("m s-1", "speed of the limit in it"),
    "law_stiffness": ("N m-1", "stiffness of the support in it"),
}


@lru_cache
def _versions(*packages: str) -> list[str]:
    """Read from files, 1 ms each."""
    return [version(name) for name in packages]


def set_meanings(data: "xr.Dataset", meanings: dict[str, tuple[str | None, str]]) -> None:
    """Attach units and long names, and CF flags to `status`."""
    for name, variable in data.variables.items():
        units, meaning = meanings[str(name)]
        variable.attrs["long_name"] = meaning
        if units is not None:
            variable.attrs["units"] = units
    data.variables["status"].attrs.update(Status.flags())


def origin(title: str, scene: Scene | str, **facts: Any) -> dict[str, Any]:
    """Where a data set comes from: the scene (or its text), versions, and more facts."""
    known = _versions(*_PACKAGES)
    return {
        "title": title,
        "source": f"frictionjax {_versions('frictionjax')[0]}",
        "scene": scene if isinstance(scene, str) else exact_text(scene),
        "dtype": "float64",
        "versions": ", ".join(map(" ".join, zip(_PACKAGES, known, strict=True))),
        "python": platform.python_version(),
        **facts,
    }


_OF_ARRAYS = {
    "sup_error": "of an array the mean over its bristles: at least that of their mean z",
    "dissipation_error": "of an array the mean over its bristles: at least the mean's",
    "strip_excess": "of an array that of the bristle that leaves the strip furthest",
}


def describe(
    data: "xr.Dataset", scenes: Sequence[Scene], accuracy: float, solver: str
) -> "xr.Dataset":
    """Attach units, long names, CF flags and provenance to the data set of a sweep."""
    set_meanings(data, _MEANING)
    if "z_spread" in data:
        for name in set(_OF_ARRAYS) & set(data.variables):
            data[name].attrs["comment"] = _OF_ARRAYS[name]
    title = "Convergence of a wiggly viscous system to directional dry friction"
    several = f"{len(scenes)} scenes, see the variable parts"
    scene = several if "scene" in data.dims else scenes[0]
    data.attrs = origin(title, scene, method=solver, accuracy=accuracy)
    return data
