"""A scene as tables of numbers: what engines work with, whoever wrote its parts."""

from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from .._checks import ByIdentity, exchanged, require
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
        support=_support_of(scene, float(law.rho_plus), float(law.rho_minus)),
        load=load_in_pieces(scene.load, turns, duration),
        duration=duration,
        z0=float(scene.z0),
        turning_points=turns,
        rho_plus=float(law.rho_plus),
        rho_minus=float(law.rho_minus),
    )
    _TABLES.put(scene, (highest, tables))
    return tables


def _support_of(scene: Scene, rho_plus: float, rho_minus: float) -> AbstractSupport:
    """The support's table, for all forces that it meets."""
    if isinstance(scene.support, Spring):
        return scene.support
    low, high, start = forces_met(scene)
    ends = min(low - rho_plus, start), max(high - rho_minus, start)
    return support_table(scene.support, *ends)


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
    return scene_on_edges(exchanged(scene, {"support": tables.support}), potential)


def scene_on_edges(scene: Scene, potential: AbstractPotential) -> Scene:
    """A known scene with this potential, its load as lines on its edges, unchecked."""
    turns = known_turning_points(scene.load, scene.duration, scene.turns)
    edges = padded_edges(turns, scene.duration)
    table = load_in_pieces(scene.load, turns, float(scene.duration))
    load = load_on_edges(table, edges)
    parts = {"potential": potential, "load": load, "turns": edges.size - 1, "effects": ()}
    return exchanged(scene, parts)
