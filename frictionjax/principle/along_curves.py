"""What a curve dissipates at least, in the limit and at finite eps: D and D_eps."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float
from scipy.interpolate import PchipInterpolator

from .._checks import as_jax, as_real, require, require_real, with_nan
from .._compile import Program, in_chunks
from ..effects import Engine
from ..loads import AbstractPull
from ..model import (
    AbstractPotential,
    Scene,
    coefficients_jit,
    known_turning_points,
    potential_in_reach,
    require_curve,
    require_reach,
    scene_for,
)
from ..numerics import THREE_NODES, THREE_WEIGHTS
from ..supports import AbstractSupport
from ..tables import load_table
from ..wiggly import pulls_at
from .dissipation import is_held
from .joint import mean_resistance
from .settings import SETTINGS


def _finite_curve(scene: Scene, ts: Any, z: Any) -> tuple[np.ndarray, np.ndarray]:
    ts, z = require_curve(scene, ts, z)
    require(np.all(np.isfinite(z)), "z", z, "finite states")
    return ts, z


@with_nan
def D(scene: Scene, ts: Any, z: Any) -> float:
    """`D(z) = int M(z', -D_z E) dt` (eq. 4.13) in J of any curve, known by samples.

    `ts`: times in s that increase, in [0, duration]; `z`: states in m; shapes (n,), n >= 2.

    Returns J: infinite where a sample is outside the strip of the `scene`, but for
    rounding. It is `int K(l - Phi'(z)) |dz|`, by the trapezoidal rule between samples:
    exact on slides of the limit, where it is `int R(z')`, and of second order elsewhere. A
    curve solves the limit system if and only if `E(t2) - E(t1) + int l' z + D = 0`.

    Raises `ValueError` for a bad curve, and for effects whose limit is another.

    >>> ts = np.linspace(0.0, 3.0, 3001)
    >>> limit = fx.solve_limit(scene, ts)
    >>> D = fx.principle.D(scene, ts, limit.z)
    >>> print(f"{D:.4f} J, where friction takes {limit.dissipation[-1]:.4f} J")
    0.3796 J, where friction takes 0.3796 J
    """
    scene = scene_for(Engine.LIMIT_CERTIFICATE, scene)
    ts, z = _finite_curve(scene, ts, z)
    law = coefficients_jit(scene.potential)
    load, held, _ = pulls_at(scene, ts, z)
    xi = load - held
    # A load near its zero carries the rounding of its largest values.
    largest = max(float(np.max(np.abs(load))), float(np.max(np.abs(held))))
    if not np.all(is_held(law, as_jax(xi), load=as_jax(largest))):
        return float("inf")
    low, high = float(law.rho_minus), float(law.rho_plus)
    moves = np.abs(np.diff(z))
    felt = np.append(moves, 0.0) + np.append(0.0, moves) > 0
    # Where xi is rho, as on all slides of the limit, K is |xi|.
    inside = felt & (xi > low) & (xi < high)
    K = np.abs(np.clip(xi, low, high))
    K[inside] = mean_resistance(scene.potential, as_jax(xi[inside]))
    return float(np.sum(moves * (K[1:] + K[:-1]) / 2))


@with_nan
def D_eps(scene: Scene, eps: Any, gamma: Any, ts: Any, z: Any) -> float:
    """`D_eps(z) = int M_eps(z', -D_z E_eps) dt` (eq. 4.11) in J of any curve.

    `eps` in m, `gamma` > 0 of the `scene`; `ts` in s, increasing, in [0, duration], and
    `z` in m, shapes (n,), n >= 2.

    Returns J. A curve solves the wiggly system if and only if
    `E_eps(t2) - E_eps(t1) + int l' z + D_eps = 0` (eq. 4.12), and leaves a positive rest
    there otherwise; of a solution D_eps is what viscosity dissipates, `int eps^gamma z'^2`.

    Between samples it is that of the monotone cubic through them (PCHIP), slips or not: of
    a solution whose slips are not sampled it is much too large. From some ten samples a
    slip on it is of second order in their distance.

    Raises `ValueError` for arguments out of range, a bad curve, one of more than
    8 million pieces of wells, an eps at which the bristle loses its contact, and for
    effects that move tips by other laws.

    >>> ts = np.linspace(0.0, 3.0, 3001)
    >>> found = fx.solve(scene, eps=0.03, ts=ts)
    >>> D_eps = fx.principle.D_eps(scene, 0.03, 1.0, ts, found.z)
    >>> print(f"{D_eps:.3f} J, where viscosity takes {found.dissipation[-1]:.3f} J")
    0.429 J, where viscosity takes 0.429 J
    """
    scene = scene_for(Engine.PRINCIPLE, scene)
    require_real("eps", eps, "eps > 0", lambda e: e > 0)
    require_real("gamma", gamma, "gamma > 0", lambda g: g > 0)
    ts, z = _finite_curve(scene, ts, z)
    require_reach(scene.potential, jnp.asarray(as_real(eps)))
    eps = float(eps)
    curve = PchipInterpolator(ts, z)
    edges = _panels(scene, ts, curve, eps)
    times = edges[:-1, None] + THREE_NODES * np.diff(edges)[:, None]
    states, speeds = curve(times), curve(times, 1)
    parts = potential_in_reach(scene.potential, eps), scene.support, load_table(scene.load)
    numbers = np.asarray(eps), np.asarray(eps ** float(gamma))
    columns = times.ravel(), states.ravel(), speeds.ravel()
    costs = in_chunks(_costs, SETTINGS.places, (*parts, *numbers), columns)
    return float(np.diff(edges) @ (costs.reshape(times.shape) @ THREE_WEIGHTS))


@Program
def _costs(
    potential: AbstractPotential,
    support: AbstractSupport,
    load: AbstractPull,
    eps: Array,
    viscosity: Array,
    times: Array,
    states: Array,
    speeds: Array,
) -> Array:
    """`M_eps` in W along a curve, (n,)."""

    def force(t: Array, z: Array) -> Array:
        _, inside = potential.tip(z, eps)
        wiggle, _ = potential.tip_force(inside, eps)
        return load(t) - support.force(z) - wiggle

    xi = jax.vmap(force)(times, states)
    return (viscosity * speeds**2 + xi**2 / viscosity) / 2


def _panels(
    scene: Scene, ts: np.ndarray, curve: PchipInterpolator, eps: float
) -> Float[np.ndarray, " n"]:
    """Times between which load, curve and wells change little: samples, the load's edges
    with places between them, and more where the curve goes through wells, or through a
    surface whose harmonics are finer than these."""
    turns = known_turning_points(scene.load, scene.duration, scene.turns)
    inside = turns[(turns > ts[0]) & (turns < ts[-1])]
    stretches = np.concatenate([ts[:1], inside, ts[-1:]])
    shares = np.arange(SETTINGS.of_load) / SETTINGS.of_load
    between = (stretches[:-1, None] + np.diff(stretches)[:, None] * shares).ravel()
    known = np.union1d(ts, between)
    finest = max(SETTINGS.of_wells, scene.potential.points / SETTINGS.samples)
    wells = np.abs(np.diff(curve(known))) / eps
    pieces = np.maximum(np.ceil(wells * finest), 1.0)
    total = float(np.sum(pieces))
    needs = f"at most {SETTINGS.most:.3g}, {finest:g} of each well"
    require(total <= SETTINGS.most, "z, and pieces of its way", total, needs)
    count = pieces.astype(int)
    first = np.repeat(np.arange(count.size), count)
    number = np.arange(first.size) - np.repeat(np.cumsum(count) - count, count)
    edges = known[first] + number / pieces[first] * np.diff(known)[first]
    return np.append(edges, known[-1])
