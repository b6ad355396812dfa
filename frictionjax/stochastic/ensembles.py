"""Many paths of a scene with noise as a data set."""

from typing import TYPE_CHECKING, Any

import numpy as np

from .._checks import require_flags, with_nan
from .._compile import waiting
from ..effects import Engine, noise_among
from ..model import Scene, scene_for
from .path_steps import PathSteps
from .paths import PathStatus, mean_interval, noisy_paths
from .random_keys import path_keys
from .settings import SETTINGS

if TYPE_CHECKING:
    import xarray as xr

_SHARE = f"{SETTINGS.confidence:.0%}"
_MEANING = {
    "z": ("m", "state of a path"),
    "z_mean": ("m", "mean state over all paths"),
    "z_low": ("m", f"lower end of the {_SHARE} interval of the mean, by Student's t"),
    "z_high": ("m", f"upper end of the {_SHARE} interval of the mean, by Student's t"),
    "work": ("J", "energy Phi - l z + V added by the load until then, -int l' z"),
    "path": (None, "number of the path"),
    "time": ("s", "time"),
    "step_time": ("s", "time of the nearest step, whose values are told"),
    "status": (None, "how a path ended"),
}


@with_nan
def ensemble(
    scene: Scene,
    eps: Any,
    gamma: Any,
    ts: Any,
    paths: int,
    key: Any,
    *,
    progress: bool = False,
) -> "xr.Dataset":
    """Independent paths of a scene with `effects.Noise`, at one eps (m) and gamma.

    `ts`: times in s, not decreasing, in [0, duration]; 201 even ones where None. `paths`:
    how many; `key`: a seed or a key of `jax.random`. Path i is that of
    `jax.random.fold_in(key, i)`, so more paths change none, and
    `fx.solve(scene, eps, gamma, ts, key=jax.random.fold_in(key, i))` has its bits.

    Returns a data set over `path` and `time`: `z`, `work` (`-int l' z`, what the load has
    added to `Phi - l z + V_eps`); over `time` `z_mean` and the 95% interval `z_low`,
    `z_high` of the mean, infinite for one path, and `step_time` (s); over `path` `status`.

    The interval holds what numbers of paths leave open, and not the error of fixed explicit
    steps (attribute `step`, s). Values are those of the nearest step, at `step_time`, up to
    half a step from `time`; and a mean that a load moves is off there too, by up to the
    share `step curvature/viscosity` (at most 0.05; curvature: the largest of Phi + V_eps,
    N/m) of what it moves in the time `viscosity/curvature`. In a well of 1.3 N/m, under a
    load of 1 N and 3 s, at eps = 0.1, gamma = 1, T = 1e-3: 0.012 eps at `step_time`, 0.032
    beside `time`, where the interval of 20,000 paths is +- 0.0012; the mean of `work` is
    off by 3e-4 to 9e-4 J (by hand).

    `progress`: a line on standard error where it takes more than two seconds.

    Raises `ValueError` for arguments out of range, and a scene without noise.

    >>> noisy = scene.replace(effects=(fx.effects.Noise(temperature=1e-3),))
    >>> ts = [0.0, 0.75, 3.0]
    >>> paths = fx.ensemble(noisy, eps=0.1, gamma=1.0, ts=ts, paths=100, key=0)
    >>> print(paths.z_mean.values.round(2), paths.z_mean.units)
    [ 0.    0.96 -0.23] m
    """
    scene = scene_for(Engine.ENSEMBLE, scene)
    noise = noise_among(scene.effects)
    if noise is None:
        names = [type(effect).__name__ for effect in scene.effects]
        raise ValueError(f"scene.effects = {names}: needs effects.Noise among them")
    require_flags(progress=progress)
    keys = path_keys(key, paths)
    with waiting("ensemble", progress) as tell:
        tell(f"{paths} paths")
        found = noisy_paths(scene, noise, eps=eps, gamma=gamma, keys=keys, ts=ts)
    return _data_set(found, {"eps": float(eps), "gamma": float(gamma)})


def _data_set(found: Any, numbers: dict[str, float]) -> "xr.Dataset":
    import xarray as xr

    known, plan = mean_interval(found.z), PathSteps(found.step, found.steps)
    data = xr.Dataset(
        {
            "z": (("path", "time"), found.z),
            "work": (("path", "time"), found.work),
            "z_mean": ("time", known.mean),
            "z_low": ("time", known.low),
            "z_high": ("time", known.high),
            "step_time": ("time", found.step * plan.nearest(found.ts)),
            "status": ("path", np.asarray(found._codes, dtype=np.int8)),
        },
        coords={"path": np.arange(found.z.shape[0]), "time": found.ts},
    )
    for name, (units, meaning) in _MEANING.items():
        data[name].attrs = {"long_name": meaning} | ({"units": units} if units else {})
    flags = PathStatus.flags()
    data["status"].attrs |= flags
    steps = {"step": found.step, "steps": found.steps}
    return data.assign_attrs(title="Paths with thermal noise", **numbers, **steps)
