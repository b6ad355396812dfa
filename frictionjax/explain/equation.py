"""The equation of a scene with all its effects, as text."""

from functools import singledispatch
from typing import NamedTuple

import numpy as np

from ..effects import (
    AbstractEffect,
    CompliantArray,
    Inertia,
    LeadingOrder,
    NapFlip,
    Noise,
    RigidArray,
    Stage,
)
from ..model import AbstractPotential, BristlePotential, Scene


class Equation(NamedTuple):
    """`motion`: what moves, a line; `where`: what stands in it, a line each."""

    motion: str
    where: tuple[str, ...]

    def text(self) -> str:
        """The lines, those that explain indented."""
        return "\n".join([self.motion, *(f"  {line}" for line in self.where)])


def composed_equation(scene: Scene, eps: float, gamma: float) -> Equation:
    """The equation that a scene stands for at one eps (m) and gamma, effects worked in."""
    motion = "eps^gamma z' = l(t) - Phi'(z) - V_eps'(z)"
    equation = Equation(motion, (_potential_in_words(scene.potential),))
    # Of one stage: what one tip feels comes before sums over several.
    for effect in sorted(scene.effects, key=lambda e: (e.stage, type(e).__name__)):
        equation = with_effect(effect, equation)
    numbers = f"eps = {eps:.6g} m, gamma = {gamma:.6g}, eps^gamma = {eps**gamma:.6g} N s/m"
    return equation._replace(where=(*equation.where, numbers))


def _potential_in_words(potential: AbstractPotential) -> str:
    if isinstance(potential, BristlePotential):
        name = type(potential.bristle).__name__
        return f"V_eps(z) = F(eps w(y)) - F(0), z = eps y + A(eps w(y)): {name}"
    return "V_eps(z) = eps W(z/eps) + eps^2 Q(eps; z/eps)"


@singledispatch
def with_effect(effect: AbstractEffect, equation: Equation) -> Equation:
    """The equation with an effect; of a class that says nothing else, with its name."""
    stage = Stage(effect.stage).name.lower()
    return equation._replace(
        where=(*equation.where, f"with {type(effect).__name__} ({stage})")
    )


@with_effect.register
def _(effect: LeadingOrder, equation: Equation) -> Equation:
    leading = "V_eps(z) = eps W(z/eps): its leading part alone (Lemma 2 without Q)"
    return equation._replace(where=(leading, *equation.where[1:]))


@with_effect.register
def _(effect: RigidArray, equation: Equation) -> Equation:
    one = equation.where[0].replace("V_eps(z)", "V_one(z)")
    count = np.size(effect.offsets)
    weight = "" if effect.weights is None else "weight_i "
    total = f"V_eps(z) = sum_i {weight}V_one(z + eps c_i), i = 1 .. {count}"
    return equation._replace(where=(total, one, *equation.where[1:]))


@with_effect.register
def _(effect: CompliantArray, equation: Equation) -> Equation:
    count = np.size(effect.offsets)
    motion = "eps^gamma z_i' = l(t) - Phi'(z_i) - V_eps'(z_i + eps c_i)"
    mean = f"z = mean of z_i, i = 1 .. {count}"
    return Equation(motion, (*equation.where, mean))


@with_effect.register
def _(effect: Noise, equation: Equation) -> Equation:
    driven = equation.motion.replace("z' = ", "dz = (")
    motion = f"{driven}) dt + sqrt(2 eps^gamma T_eps) dB"
    bath = f"T_eps = {float(effect.temperature):.6g} eps^{float(effect.exponent):.6g} J"
    return Equation(motion, (*equation.where, f"{bath}, B a Wiener process"))


@with_effect.register
def _(effect: NapFlip, equation: Equation) -> Equation:
    stiffness = f"{float(effect.bending_stiffness):.6g}"
    turns = (
        f"until compression is pi^2 B/L^2, B = {stiffness} N m^2, and the root goes back: "
        "then U(z - z_tip), an elastica over the pinned tip, in place of V_eps",
        "past it the same in a mirror, rest angle of the other sign",
    )
    return equation._replace(where=(*equation.where, *turns))


@with_effect.register
def _(effect: Inertia, equation: Equation) -> Equation:
    mass = f"m_eps = {float(effect.mass):.6g} eps^{float(effect.exponent):.6g} kg"
    where = (*equation.where, f"{mass}, z' = 0 at t = 0")
    return Equation(f"m_eps z'' + {equation.motion}", where)
