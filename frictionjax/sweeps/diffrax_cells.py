"""Cells of a sweep: a wiggly trajectory watched beside its limit, in vmapped blocks."""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from .._checks import Real
from ..coefficients import Coefficients
from ..limit import play_step, strip
from ..model import Scene, coefficients, dissipation_potential
from ..wiggly import AbstractObserver, Status, integrate, plan_steps


class Deviation(NamedTuple):
    """Running comparison with the limit: its state (m), dissipation (J), and suprema."""

    z: Real
    spent: Real
    sup_error: Real
    dissipation_error: Real
    strip_excess: Real


class LimitWatch(AbstractObserver):
    """Follows the limit system step by step beside a wiggly one and keeps the suprema.

    Steps end at the turning points of the load, so the play operator is exact at each.
    The suprema are over all steps: the largest lag is just before a slip, where steps are
    short.
    """

    scene: Scene
    found: Coefficients

    def start(self, z: Real) -> Deviation:
        zero = jnp.zeros_like(z)
        return Deviation(z, zero, zero, zero, zero)

    def look(self, memory: Deviation, t: Real, z: Real, dissipation: Real) -> Deviation:
        load = self.scene.load(t)
        lower, upper = strip(self.scene.support, self.found, load)
        limit = play_step(self.scene.support, self.found, memory.z, load)
        spent = memory.spent + dissipation_potential(
            self.found.rho_plus, self.found.rho_minus, limit - memory.z
        )
        outside = jnp.maximum(lower - z, z - upper)
        return Deviation(
            z=limit,
            spent=spent,
            sup_error=jnp.maximum(memory.sup_error, jnp.abs(z - limit)),
            dissipation_error=jnp.maximum(
                memory.dissipation_error, jnp.abs(dissipation - spent)
            ),
            strip_excess=jnp.maximum(memory.strip_excess, outside),
        )


class Cell(NamedTuple):
    """Result of one cell; arrays over the requested times, or scalars."""

    z: Float[Array, " time"]
    dissipation: Float[Array, " time"] | None
    residual: Real | None
    dissipation_gap: Real | None
    deviation: Deviation
    status: Array
    steps: Array
    rejected: Array
    tolerance: Real


def _cell(scene: Scene, eps: Real, gamma: Real, ts, accuracy, solver, balanced) -> Cell:
    limit = coefficients(scene.potential)
    plan = plan_steps(scene, eps, gamma, accuracy)
    found = integrate(
        scene,
        eps,
        gamma,
        ts,
        plan,
        solver,
        until=jnp.asarray(scene.duration),
        balanced=balanced,
        watch=LimitWatch(scene, limit),
    )
    unfinished = (found.status != Status.OK) & (found.status != Status.UNBALANCED)
    blank = jnp.where(unfinished, jnp.nan, 0.0)
    residual, gap = None, None
    if found.final is not None and found.dissipation_gap is not None:
        residual = found.final.residual + blank
        gap = found.dissipation_gap + blank
    return Cell(
        z=found.z,
        dissipation=found.dissipation,
        residual=residual,
        dissipation_gap=gap,
        deviation=jax.tree_util.tree_map(lambda leaf: leaf + blank, found.watched),
        status=found.status,
        steps=found.steps,
        rejected=found.rejected,
        tolerance=plan.tolerance,
    )


@eqx.filter_jit
def run_block(scene, eps, gamma, ts, accuracy, solver, balanced) -> Cell:
    """One block of lanes; the only program that a sweep compiles for its trajectories."""

    def lane(eps: Real, gamma: Real) -> Any:
        return _cell(scene, eps, gamma, ts, accuracy, solver, balanced)

    return jax.vmap(lane)(eps, gamma)
