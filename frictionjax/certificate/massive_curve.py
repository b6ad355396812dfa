"""A curve with mass: how close a solution stays to it, and its balance of energies."""

import math
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from .._checks import Real
from .._compile import Program, in_chunks
from ..model import Scene
from ..numerics import THREE_NODES, THREE_WEIGHTS, cubic, cubic_slope
from .curve import every_second
from .forces import Force, force_in_tables, force_of
from .massive_steps import MassiveEquation
from .sample_gaps import SampleGaps
from .settings import SETTINGS
from .shadow import Shadow, shadow
from .transits import CurveFolds, along, folds_of, transits
from .verdicts import Certificate, CertificateStatus


class MassiveSamples(NamedTuple):
    """`ts` in s, the tip at well + inside in periods, and speeds, (n,): `speed` z'/eps and
    `rate` y', in 1/s."""

    ts: np.ndarray
    well: np.ndarray
    inside: np.ndarray
    speed: np.ndarray
    rate: np.ndarray


class _Energies(NamedTuple):
    """In J: what is stored more at the end, work of the load, and `int z'^2` in m^2/s."""

    stored: float
    work: float
    squares: float

    def left(self, viscosity: float) -> float:
        """Of the balance."""
        return abs(self.stored - self.work + viscosity * self.squares)

    @property
    def viscosity(self) -> float:
        """With which it balances, in N s/m."""
        return (self.work - self.stored) / self.squares if self.squares else math.nan


def massive_certificate(
    scene: Scene,
    *,
    mass: float,
    eps: float,
    viscosity: float,
    scale: float,
    ts: np.ndarray,
    z: np.ndarray,
    velocity: np.ndarray,
) -> Certificate:
    """Of finite samples; `mass` in kg, `viscosity` is `eps^gamma`, `scale` in J."""
    force = force_in_tables(force_of(scene, jnp.asarray(eps)), ts)
    equation = MassiveEquation(force, jnp.asarray(mass), jnp.asarray(viscosity))
    well, inside, stretch = in_chunks(_tips, SETTINGS.steps, (force,), (z,))
    speed = velocity / eps
    samples = MassiveSamples(ts, well, inside, speed, speed / stretch)
    unit = _unit(force, mass, viscosity)
    near = shadow(equation, SampleGaps.between(*samples, unit=unit))
    energies = _energies(equation, samples)
    slips = _slips(folds_of(force), samples)
    spacing = float(np.max(np.abs(np.diff(z)))) / eps
    distance = float(np.max(np.abs(stretch * near.moved[:, 0])))
    ratio = energies.viscosity / viscosity if slips else math.nan
    residual = energies.left(viscosity)
    thinned = every_second(ts.size)
    fewer = _energies(equation, MassiveSamples(*(c[thinned] for c in samples)))
    residual_error = abs(fewer.left(viscosity) - residual) / 3
    known = residual > 3 * residual_error
    return Certificate(
        residual=residual,
        residual_error=residual_error,
        scale=scale,
        slips=slips,
        skipped=0,
        distance=distance,
        within=distance,
        missing_force=math.nan,
        viscosity=ratio,
        spacing=spacing,
        status=_verdict(near, distance, spacing, ratio, known),
    )


def _verdict(
    near: Shadow, distance: float, spacing: float, viscosity: float, known: bool
) -> CertificateStatus:
    """The first test that fails; another viscosity is a reason, not a test, where energies
    are `known`."""
    if spacing > SETTINGS.coarsest:
        return CertificateStatus.UNRESOLVED
    off = distance > SETTINGS.farthest
    if off and known and abs(viscosity - 1) > SETTINGS.viscosity:
        return CertificateStatus.VISCOSITY
    if not near.resolved:
        return CertificateStatus.UNRESOLVED
    if off:
        return CertificateStatus.OFF
    late = np.max(np.abs(near.moved[:, 1])) > SETTINGS.farthest
    return CertificateStatus.VELOCITY if late else CertificateStatus.OK


@Program
def _tips(force: Force, z: Array) -> tuple[Array, Array, Array]:
    """Well and tip in it, and G, at states in m."""

    def at(one: Real) -> tuple[Real, Real, Real]:
        well, inside = force.potential.tip(one, force.eps)
        return well, inside, force.stretch(inside) / force.eps

    return jax.vmap(at)(z)


@Program
def _steepest(force: Force) -> Real:
    """The largest `|V_eps''|` in N/m."""

    def bent(y: Real) -> Real:
        pull = jax.jvp(
            lambda s: force.potential.tip_force(s, force.eps)[0], (y,), (jnp.ones_like(y),)
        )[1]
        return jnp.abs(pull / force.stretch(y))

    count = force.potential.points
    return jnp.max(jax.vmap(bent)(jnp.arange(count) / count))


def _unit(force: Force, mass: float, viscosity: float) -> float:
    """The speed of a slip in wells, in 1/s: damped, or that of an oscillation."""
    steepest = float(_steepest(force))
    fastest = min(math.sqrt(steepest / mass), steepest / viscosity)
    return fastest / (2 * math.pi)


def _slips(folds: CurveFolds, samples: MassiveSamples) -> int:
    """Wells crossed."""
    found = 0
    for sign, place in folds.places.items():
        crossed = transits(samples.well, samples.inside, place, SETTINGS.around_fold)
        found += along(crossed, sign).well.size
    return found


@Program
def _integrals(force: Force, *columns: Array) -> tuple[Array, Array]:
    """`int l z' dt` and `int z'^2 dt` between samples, on cubics in the tip coordinate."""

    def one(t: Real, length: Real, y0: Real, y1: Real, v0: Real, v1: Real) -> tuple:
        ends = y1 - y0, length * v0, length * v1

        def node(s: Real) -> tuple[Real, Real]:
            here = y0 + cubic(s, *ends)
            speed = force.stretch(here) * cubic_slope(s, *ends) / length
            return force.load(t + s * length) * speed, speed**2

        work, squares = jax.vmap(node)(jnp.asarray(THREE_NODES))
        return length * jnp.dot(THREE_WEIGHTS, work), length * jnp.dot(
            THREE_WEIGHTS, squares
        )

    return jax.vmap(one)(*columns)


@Program
def _stored(equation: MassiveEquation, well: Any, y: Any, u: Any) -> Real:
    force = equation.force
    still = force.support.energy(force.state(well, y))
    still = still + force.potential.tip_energy(y, force.eps)
    return still + 0.5 * equation.mass * (force.eps * u) ** 2


def _energies(equation: MassiveEquation, samples: MassiveSamples) -> _Energies:
    ts, well, inside, _, rate = samples
    ends = inside[:-1], inside[1:] + np.diff(well)
    columns = ts[:-1], np.diff(ts), *ends, rate[:-1], rate[1:]
    work, squares = in_chunks(_integrals, SETTINGS.steps, (equation.force,), columns)
    last, first = (float(_stored(equation, *(c[k] for c in samples[1:4]))) for k in (-1, 0))
    return _Energies(last - first, float(np.sum(work)), float(np.sum(squares)))
