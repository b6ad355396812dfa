"""What a curve dissipates at least, in the limit and at finite eps: D and D_eps."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .._checks import as_real, require, require_real, with_nan
from .._compile import Interpreted
from ..certificate import least_residual
from ..effects import Engine
from ..loads import AbstractPull
from ..model import Scene, coefficients_jit, require_curve, require_reach, scene_for
from ..supports import AbstractSupport
from .dissipation import is_held
from .joint import mean_resistance
from .settings import SETTINGS

_NODES = np.array([0.5 - 0.15**0.5, 0.5, 0.5 + 0.15**0.5])  # Gauss on [0, 1]
_WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18


@Interpreted
def _loads(load: AbstractPull, times: Array) -> Array:
    return jax.vmap(load)(times)


@Interpreted
def _held(support: AbstractSupport, states: Array) -> tuple[Array, Array]:
    return jax.vmap(support.force)(states), jax.vmap(support.energy)(states)


@with_nan
def D(scene: Scene, ts: Any, z: Any) -> float:
    """`D(z) = int M(z', -D_z E) dt` (eq. 4.13) in J of any curve, known by samples.

    `ts`: times in s that increase, in [0, duration]; `z`: states in m; shapes (n,), n >= 2.

    Returns J: infinite where a sample is outside the strip of the `scene`, but for
    rounding. It is
    `int K(l - Phi'(z)) |dz|`, by the trapezoidal rule between samples: exact on slides of
    the limit, where it is `int R(z')`, and of second order elsewhere. A curve solves the
    limit system if and only if `E(t2) - E(t1) + int l' z + D = 0`.

    Raises `ValueError` for a bad curve, and for effects that move tips by other laws.

    >>> ts = np.linspace(0.0, 3.0, 3001)
    >>> limit = fx.solve_limit(scene, ts)
    >>> D = fx.principle.D(scene, ts, limit.z)
    >>> print(f"{D:.4f} J, where friction takes {limit.dissipation[-1]:.4f} J")
    0.3796 J, where friction takes 0.3796 J
    """
    scene = scene_for(Engine.PRINCIPLE, scene)
    ts, z = require_curve(scene, ts, z)
    law = coefficients_jit(scene.potential)
    load = _loads(scene.load, ts)
    xi = load - _held(scene.support, z)[0]
    if not np.all(is_held(law, jnp.asarray(xi), load=jnp.asarray(load))):
        return float("inf")
    low, high = float(law.rho_minus), float(law.rho_plus)
    moves = np.abs(np.diff(z))
    felt = np.append(moves, 0.0) + np.append(0.0, moves) > 0
    # Where xi is rho, as on all slides of the limit, K is |xi|.
    inside = felt & (xi > low) & (xi < high)
    K = np.abs(np.clip(xi, low, high))
    K[inside] = mean_resistance(scene.potential, jnp.asarray(xi[inside]))
    return float(np.sum(moves * (K[1:] + K[:-1]) / 2))


@with_nan
def D_eps(scene: Scene, eps: Any, gamma: Any, ts: Any, z: Any) -> float:
    """`D_eps(z) = int M_eps(z', -D_z E_eps) dt` (eq. 4.11) in J of any curve.

    `eps` in m, `gamma` > 0 of the `scene`; `ts` in s, increasing, in [0, duration], and
    `z` in m, shapes (n,), n >= 2.

    Returns J. A curve solves the wiggly system if and only if
    `E_eps(t2) - E_eps(t1) + int l' z + D_eps = 0` (eq. 4.12), and leaves a positive rest
    there otherwise; of a solution D_eps is what viscosity dissipates, `int eps^gamma z'^2`.

    Samples that come within eps/4 of each other are joined the way that costs least, as in
    `certify`, of second order in their distance; where they are farther apart, by straight
    lines, slips or not: of a solution that is sampled thinly it is much too large.

    Raises `ValueError` for arguments out of range, a bad curve, one of more than half a
    million wells, an eps at which the bristle loses its contact, and for effects that move
    tips by other laws.

    >>> ts = np.linspace(0.0, 3.0, 3001)
    >>> found = fx.solve(scene, eps=0.03, ts=ts)
    >>> D_eps = fx.principle.D_eps(scene, 0.03, 1.0, ts, found.z)
    >>> print(f"{D_eps:.3f} J, where viscosity takes {found.dissipation[-1]:.3f} J")
    0.429 J, where viscosity takes 0.429 J
    """
    scene = scene_for(Engine.PRINCIPLE, scene)
    require_real("eps", eps, "eps > 0", lambda e: e > 0)
    require_real("gamma", gamma, "gamma > 0", lambda g: g > 0)
    ts, z = require_curve(scene, ts, z)
    require_reach(scene.potential, jnp.asarray(as_real(eps)))
    eps = float(eps)
    ts, z = _resolved(ts, z, eps)
    residual = least_residual(scene, eps, eps ** float(gamma), ts, z)
    return _released(scene, eps, ts, z) + residual


def _resolved(
    ts: np.ndarray, z: np.ndarray, eps: float
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    """The curve with samples that resolve wells, on straight lines where it had none."""
    gaps = np.abs(np.diff(z)) / eps
    far = gaps > SETTINGS.coarsest
    total = float(np.sum(gaps[far]))
    needs = f"a curve of at most {SETTINGS.most * SETTINGS.pieces:.3g} wells"
    few = total < SETTINGS.most * SETTINGS.pieces
    require(few, "z, and wells that it passes", total, needs)
    pieces = np.where(far, np.ceil(gaps / SETTINGS.pieces), 1).astype(int)
    first = np.repeat(np.arange(gaps.size), pieces)
    number = np.arange(first.size) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    share = number / pieces[first]
    times = ts[first] + share * np.diff(ts)[first]
    states = z[first] + share * np.diff(z)[first]
    return np.append(times, ts[-1]), np.append(states, z[-1])


def _released(scene: Scene, eps: float, ts: np.ndarray, z: np.ndarray) -> float:
    """`E_eps(t1) - E_eps(t2) - int l' z = int (l - Phi' - V_eps') dz`, in J."""
    nodes = ts[:-1, None] + _NODES * np.diff(ts)[:, None]
    loads = _loads(scene.load, nodes.ravel()).reshape(nodes.shape) @ _WEIGHTS
    ends = z[[0, -1]]
    kept = np.diff(_held(scene.support, ends)[1] + scene.potential.energy(ends, eps))
    return float(np.dot(loads, np.diff(z)) - kept[0])
