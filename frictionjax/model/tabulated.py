"""A scene as tables of numbers: what engines work with, whoever wrote its parts."""

from typing import Any, NamedTuple

import jax
import numpy as np
from jaxtyping import Array, Float

from .._checks import ByIdentity, exchanged, require
from .._compile import Interpreted
from ..coefficients import Coefficients
from ..loads import AbstractPull, PiecewiseLinear
from ..supports import AbstractSupport, Spring
from ..tables import (
    PiecewiseLoad,
    PiecewiseProfile,
    SeriesBristle,
    SeriesProfile,
    SeriesSupport,
    SumOfLoads,
    in_one_size,
    load_in_pieces,
    load_on_edges,
    support_table,
)
from .friction_coefficients import coefficients_jit
from .potentials import AbstractPotential, BristlePotential
from .scene import Scene, forces_met
from .scene_loads import known_turning_points, padded_edges
from .settings import SETTINGS
from .summed_potential import SummedPotential
from .tabulated_potential import tabulated_potentials


class TabulatedScene(NamedTuple):
    """A scene of known numbers, at every eps up to the one it was made for.

    `potential`: as planning evaluates it; `lane_potential`: as lanes do. `turning_points`
    (n,): in s, inside (0, duration); NaN where the scene has no room for all. `rho_plus`,
    `rho_minus` in N.
    """

    potential: AbstractPotential
    lane_potential: AbstractPotential
    support: AbstractSupport
    load: AbstractPull
    duration: float
    z0: float
    turning_points: Float[np.ndarray, " n"]
    rho_plus: float
    rho_minus: float

    @property
    def untabulated(self) -> str:
        """Parts that no table holds, as "load Custom": programs are compiled for them."""
        parts: dict[str, Any] = {"support": self.support, "load": self.load}
        if isinstance(self.lane_potential, BristlePotential):
            pair = self.lane_potential.profile, self.lane_potential.bristle
            parts |= dict(zip(("profile", "bristle"), pair, strict=True))
        else:
            parts["potential"] = self.lane_potential
        found = {n: type(p).__name__ for n, p in parts.items() if not isinstance(p, _KNOWN)}
        return ", ".join(f"{name} {kind}" for name, kind in found.items())


_KNOWN = (
    SeriesProfile,
    PiecewiseProfile,
    SeriesBristle,
    Spring,
    SeriesSupport,
    SumOfLoads,
    PiecewiseLinear,
    PiecewiseLoad,
)


_TABLES = ByIdentity()  # of scenes: the last eps, and the tables for it


def require_friction(scene: Scene) -> None:
    """Raise `ValueError` for a known scene whose tips cancel each other's forces."""
    rho = float(coefficients_jit(scene.potential).rho_plus)
    needs = "phases that leave friction: without, only friction and solve_limit are left"
    require(rho != 0, "effects.RigidArray: rho_plus", rho, needs)


def tabulated_scene(scene: Scene, eps: Any) -> TabulatedScene:
    """The tables of a known scene for cells of these eps (m)."""
    highest = float(np.max(np.asarray(eps)))
    known = _TABLES.get(scene)
    if known is not None and known[0] == highest:
        return known[1]
    require_friction(scene)
    law = coefficients_jit(scene.potential)
    planning, lanes = tabulated_potentials(scene.potential, highest)
    turns = known_turning_points(scene.load, scene.duration, scene.turns)
    duration = float(scene.duration)
    tables = TabulatedScene(
        potential=planning,
        lane_potential=lanes,
        support=_support_of(scene, planning, highest, law),
        load=load_in_pieces(scene.load, turns, duration),
        duration=duration,
        z0=float(scene.z0),
        turning_points=turns,
        rho_plus=float(law.rho_plus),
        rho_minus=float(law.rho_minus),
    )
    _TABLES.put(scene, (highest, tables))
    return tables


@Interpreted
def _wiggles(potential: AbstractPotential, eps: Array, places: Array) -> Array:
    return jax.vmap(lambda y: potential.tip_force(y, eps)[0])(places)


def _support_of(
    scene: Scene, potential: AbstractPotential, eps: float, law: Coefficients
) -> AbstractSupport:
    """The support's table, for all forces that it meets.

    Below a fold nothing pulls a tip further than the load and the wiggles do. Mass may, and
    so scenes with effects keep the function.
    """
    if isinstance(scene.support, Spring) or scene.effects:
        return scene.support
    places = np.arange(SETTINGS.places) / SETTINGS.places
    wiggles = _wiggles(potential, np.asarray(eps), places)
    low, high, start = forces_met(scene)
    least = min(low - max(float(law.rho_plus), wiggles.max()), start)
    most = max(high - min(float(law.rho_minus), wiggles.min()), start)
    return support_table(scene.support, least, most)


def scene_of_tables(scene: Scene, eps: Any) -> Scene:
    """A known scene whose parts are its tables, unchecked, for cells of these eps (m).

    What is compiled for it serves all scenes. Itself where several tips are one surface at
    each eps, and eps are several.
    """
    if isinstance(scene.potential, SummedPotential) and np.unique(eps).size > 1:
        return scene
    tables = tabulated_scene(scene, eps)
    potential = tables.lane_potential
    if isinstance(potential, BristlePotential):
        bristle = in_one_size(potential.bristle)
        potential = BristlePotential(potential.profile, bristle)
    known = exchanged(scene, {"support": tables.support})
    return _on_edges(known, potential, tables.load, tables.turning_points)


def scene_on_edges(scene: Scene, potential: AbstractPotential) -> Scene:
    """A known scene with this potential, its load as lines on its edges, unchecked."""
    turns = known_turning_points(scene.load, scene.duration, scene.turns)
    load = load_in_pieces(scene.load, turns, float(scene.duration))
    return _on_edges(scene, potential, load, turns)


def _on_edges(
    scene: Scene, potential: AbstractPotential, table: AbstractPull, turns: np.ndarray
) -> Scene:
    edges = padded_edges(turns, scene.duration)
    load = load_on_edges(table, edges)
    parts = {"potential": potential, "load": load, "turns": edges.size - 1, "effects": ()}
    return exchanged(scene, parts)
