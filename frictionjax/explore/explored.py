"""What the page draws, all of it from one compiled program."""

from functools import lru_cache
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from .._checks import require_real
from .._compile import Program
from ..bristles import SlantedSpring
from ..limit import solve_limit
from ..loads import Sine
from ..model import Scene, friction, is_admitted, require_reach, require_told_apart
from ..profiles import Fourier
from ..supports import Spring
from ..wiggly import Status, solve
from .setting import PageSetting

_BRISTLE: Any = {"stiffness": 1.0, "rest_length": 2.4, "height": 1.0}
_SUPPORT: Any = {"stiffness": 2.0}
_LOAD: Any = {"amplitude": 1.2, "period": 3.0}
_DURATION = 3.75  # s: a quarter of a period until it slides, then a whole loop
_TIMES = np.linspace(0.0, _DURATION, 1201)  # s: several in each slip of the smallest eps
_WELLS = np.linspace(-2.0, 2.0, 241)  # periods of the wiggles
_ACCURACY = 1e-2  # eps: less than a pixel


class Explored(NamedTuple):
    """What there is to see of a `setting`, lengths in m, forces in N, times in s.

    `energy`: `V_eps` in J over `wells` in periods. `z`, `force`: of the wiggly system at
    `ts`, `z_limit`, `force_limit` of its limit; `force` is `l - Phi'(z)`. `coefficients`:
    `rho_plus`, `rho_minus` and their `ratio`.
    """

    setting: PageSetting
    coefficients: dict[str, float]
    status: Status
    wells: np.ndarray
    energy: np.ndarray
    ts: np.ndarray
    z: np.ndarray
    force: np.ndarray
    z_limit: np.ndarray
    force_limit: np.ndarray

    def packed(self) -> bytes:
        """All arrays in this order, one after the other, in 32 bits."""
        arrays: Any = self[self._fields.index("wells") :]
        return np.concatenate(arrays).astype("<f4").tobytes()


def scene_at(angle: Any, slope: Any, asymmetry: Any) -> Scene:
    """The scene at some values of the sliders: all else about it is fixed.

    Raises `ValueError` where Theorem 1 does not hold, of known values.
    """
    first = slope / (2 * np.pi)
    waves: Any = ([0.0, 0.0], jnp.stack([first, 0.5 * asymmetry * first]))
    return Scene(
        Fourier(*waves),
        SlantedSpring(**_BRISTLE, angle=angle),
        Spring(**_SUPPORT),
        Sine(**_LOAD),
        _DURATION,
    )


@Program
def _drawn(setting: Any) -> dict[str, Any]:
    # Of traced numbers everything is one program, checks too: calls one by one, and a
    # scene made for each frame, spend most of their time in Python.
    scene, eps, gamma = scene_at(*setting[:3]), setting.eps, setting.gamma
    potential: Any = scene.potential
    upright = jnp.abs(setting.angle) < np.pi / 2  # a constructor's only bound that can fail
    law = friction(scene)
    motion = solve(scene, eps, gamma, _TIMES, accuracy=_ACCURACY, dissipation=False)
    limit = solve_limit(scene, _TIMES)
    load = jax.vmap(scene.load)(jnp.asarray(_TIMES))
    held = jax.vmap(scene.support.force)
    return {
        "allowed": is_admitted(potential, eps) & upright,
        "coefficients": (law.rho_plus, law.rho_minus),
        "status": motion.status_code,
        "energy": potential.energy(eps * _WELLS, eps),
        "z": motion.z,
        "force": load - held(motion.z),
        "z_limit": limit.z,
        "force_limit": load - held(limit.z),
    }


def _require_allowed(setting: PageSetting) -> None:
    scene, size = scene_at(*setting[:3]), jnp.asarray(setting.eps)
    require_reach(scene.potential, size)


@lru_cache(maxsize=1)
def _resting() -> Scene:
    """Whose wells lie where those of every setting do: load and support are fixed."""
    return scene_at(*PageSetting()[:3])


def explored_at(setting: PageSetting) -> Explored:
    """What there is to see where the sliders stand.

    Raises `ValueError` where Theorem 1 does not hold, and for an eps at which the bristle
    loses its contact.
    """
    for name, value in zip(PageSetting._fields, setting, strict=True):
        require_real(name, value, "as a slider gives")
    require_real("slope", setting.slope, "slope > 0", lambda v: v > 0)
    require_real("eps", setting.eps, "eps > 0", lambda v: v > 0)
    require_real("gamma", setting.gamma, "gamma > 0", lambda v: v > 0)
    numbers = PageSetting(*map(float, setting))
    require_told_apart(_resting(), numbers.eps)
    traced: Any = map(np.asarray, numbers)
    found = jax.device_get(_drawn(PageSetting(*traced)))
    if not found.pop("allowed"):
        _require_allowed(numbers)  # says which hypothesis fails
    plus, minus = map(float, found.pop("coefficients"))
    return Explored(
        setting=setting,
        coefficients={"rho_plus": plus, "rho_minus": minus, "ratio": -plus / minus},
        status=Status.of(found.pop("status")),
        wells=_WELLS,
        ts=_TIMES,
        **found,
    )
