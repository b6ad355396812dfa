"""Forces and energies of a rod that turns over: straight, or bent over its tip."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from .._compile import Interpreted, in_chunks
from ..bristles import AngularSpring
from ..effects import NapFlip
from ..model import AbstractPotential, Scene
from ..profiles import AbstractProfile
from ..rods import TurningRod
from ..turning import flipping_rod, limit_course, sided_potential
from .forces import TipForces, limit_forces, tip_forces
from .settings import SETTINGS

JUMPS = {
    "jump_time": ("s", "when the limit jumps"),
    "jump_from": ("m", "state before it"),
    "jump_to": ("m", "state after it"),
    "jump_loss": ("J", "energy that it loses"),
}


@Interpreted
def _wiggly_rows(potential: AbstractPotential, eps: Any, z: Any) -> TipForces:
    return jax.vmap(lambda one: tip_forces(potential, one, eps))(z)


@Interpreted
def _limit_rows(potential: AbstractPotential, z: Any, force: Any) -> TipForces:
    return jax.vmap(lambda *one: limit_forces(potential, *one))(z, force)


@Interpreted
def _heights(profile: AbstractProfile, eps: Any, tip: Any) -> Any:
    return jax.vmap(lambda p: eps * profile(p / eps))(tip)


@Interpreted
def _bent_rows(rod: TurningRod, tip: Any, ahead: Any, low: Any) -> TipForces:
    def at(tip: Any, ahead: Any, low: Any) -> TipForces:
        one = rod._replace(height=rod.height - low)
        return TipForces(
            tip=tip,
            tangential=-one.force(ahead),
            energy=one.energy(ahead),
            normal=one.weight(ahead),
            angle=one.angle(ahead),
            length=one.chord(ahead),
            axial=-one.thrust(ahead),
        )

    return jax.vmap(at)(tip, ahead, low)


def turning_forces(
    scene: Scene, effect: NapFlip, solution: Any, force: Any, eps: Any
) -> TipForces:
    """Along a solution, of shape (n,). `force`: on the root in N, which the limit needs.

    In between what is along the rod is along its chord, and `length` that of the chord.
    `eps` in m, None of a limit.
    """
    law, mode = flipping_rod(scene, effect), np.asarray(solution.mode)
    z, tip = np.asarray(solution.z), np.asarray(solution.tip)
    rod: Any = scene.bristle
    assert isinstance(rod, AngularSpring)
    assert scene.profile is not None
    found = _bent(scene.profile, law.bent, eps, tip, np.asarray(solution.root) - tip, mode)
    for side in (1.0, -1.0):
        potential = sided_potential(scene.profile, rod, jnp.asarray(side))
        place = side * (z + (1 - side) * law.reach)
        if eps is None:
            columns = place, side * np.asarray(force)
            straight = in_chunks(_limit_rows, SETTINGS.rows, (potential,), columns)
        else:
            fixed = potential, jnp.asarray(eps)
            straight = in_chunks(_wiggly_rows, SETTINGS.rows, fixed, (place,))
        found = _where(mode == side, _turned(straight, side), found)
    return found._replace(tip=jnp.asarray(tip))


def turning_bounds(scene: Scene, effect: NapFlip, force: Any, mode: Any) -> tuple[Any, Any]:
    """Least and greatest tangential force in N of a limit solution: see `mechanics`.

    What a rod in its mode withstands; on a slide, and in between, what it has.
    """
    law, force = flipping_rod(scene, effect), np.asarray(force)
    low, high = force.copy(), force.copy()
    for side, (least, most) in ((1, law.standing_rest), (-1, law.turned_rest)):
        slides = most if side == 1 else least
        slack = SETTINGS.slack * (most - least)
        rests = (mode == side) & (np.abs(force - slides) > slack)
        low[rests], high[rests] = least, most
    return -high, -low


def jumps_of(scene: Scene, effect: NapFlip) -> dict[str, tuple[str, Any, dict[str, str]]]:
    """When the limit jumps, from where to where, and what it loses, as variables."""
    jumps = limit_course(scene, effect).jumps()
    values = jumps.time, jumps.z, jumps.last, jumps.spent - jumps.lost
    return {
        name: ("jump", value, {"units": unit, "long_name": meaning})
        for (name, (unit, meaning)), value in zip(JUMPS.items(), values, strict=True)
    }


def _bent(
    profile: AbstractProfile, rod: TurningRod, eps: Any, tip: Any, ahead: Any, mode: Any
) -> TipForces:
    """Where the rod is in between; elsewhere of a place that there is."""
    between = mode == 0
    low = np.zeros_like(tip)
    if eps is not None:
        fixed = profile, jnp.asarray(eps)
        low = in_chunks(_heights, SETTINGS.rows, fixed, (tip,))
    columns = tip, np.where(between, ahead, 0.0), np.where(between, low, 0.0)
    return in_chunks(_bent_rows, SETTINGS.rows, (rod,), columns)


def _turned(forces: TipForces, side: float) -> TipForces:
    """Of a side as they are: what has a direction along x changes its sign."""
    assert forces.angle is not None
    return forces._replace(
        tip=side * forces.tip,
        tangential=side * forces.tangential,
        angle=side * forces.angle,
    )


def _where(chosen: Any, new: TipForces, old: TipForces) -> TipForces:
    def pick(a: Any, b: Any) -> Any:
        return np.where(chosen, a, b)

    return TipForces(*map(pick, new, old))
