"""Solvers by name, those of diffrax included."""

import inspect
from typing import Any

import diffrax
import equinox as eqx
import jax.numpy as jnp

from ..._checks import require
from .own_methods import OURS, is_ours
from .rosenbrock_solvers import Rodas5P
from .settings import SETTINGS


def _is_usable(candidate: object) -> bool:
    """Whether diffrax solves a plain ODE adaptively with it, without more arguments."""
    if not (isinstance(candidate, type) and issubclass(candidate, diffrax.AbstractSolver)):
        return False
    plain = getattr(candidate, "term_structure", None) in (
        diffrax.ODETerm,
        diffrax.AbstractTerm,
    )
    adaptive = issubclass(candidate, diffrax.AbstractAdaptiveSolver)
    wrapper = issubclass(candidate, diffrax.AbstractWrappedSolver)
    return plain and adaptive and not wrapper and not inspect.isabstract(candidate)


def known_solvers() -> list[str]:
    """Names of the diffrax solvers that `method` accepts."""
    names = [name for name in dir(diffrax) if _is_usable(getattr(diffrax, name))]
    return sorted(names)


def solver_of(
    method: object, argument: str = "method", others: tuple[str, ...] = ()
) -> diffrax.AbstractSolver:
    """The solver that `method` names: ours, a diffrax name, class or instance.

    Raises `ValueError` with the names allowed, as of the `argument`, and among them
    `others` that the caller knows.
    """
    if isinstance(method, diffrax.AbstractSolver):
        return method
    if is_ours(method):
        return Rodas5P()
    named = isinstance(method, str)
    candidate: Any = getattr(diffrax, str(method), None) if named else method
    allowed = f"one of {', '.join([*OURS, *others, *known_solvers()])}, or a diffrax solver"
    usable = _is_usable(candidate)
    require(usable, argument, method, allowed)
    return candidate()


def with_tolerance(
    solver: diffrax.AbstractSolver, tolerance: Any
) -> diffrax.AbstractSolver:
    """Give an implicit solver's Newton iteration a share of the step's tolerance."""
    finder = getattr(solver, "root_finder", None)
    if finder is None:
        return solver
    own = type(finder)(rtol=0.0, atol=SETTINGS.newton * jnp.asarray(tolerance))
    return eqx.tree_at(lambda s: s.root_finder, solver, own)
