"""Solvers by name."""

import inspect
from typing import Any

import diffrax
import equinox as eqx
import jax.numpy as jnp

from ..arguments import require
from .rodas5p import Rodas5P

OURS = ("auto", "resolved", "windowed")
_NEWTON_SHARE = 0.03  # of the step's tolerance


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


def solver_of(method: object) -> diffrax.AbstractSolver:
    """The solver that `method` names: ours, a diffrax name, class or instance.

    Raises `ValueError` with the names allowed.
    """
    if isinstance(method, diffrax.AbstractSolver):
        return method
    if isinstance(method, str) and method in OURS:
        return Rodas5P()
    named = isinstance(method, str)
    candidate: Any = getattr(diffrax, str(method), None) if named else method
    allowed = f"one of {', '.join([*OURS, *known_solvers()])}, or a diffrax solver"
    usable = _is_usable(candidate)
    require(usable, "method", method if named else repr(method), allowed)
    return candidate()


def is_ours(method: object) -> bool:
    """Whether `method` names one of the library's own ways."""
    return isinstance(method, str) and method in OURS


def with_tolerance(solver: diffrax.AbstractSolver, tolerance) -> diffrax.AbstractSolver:
    """Give an implicit solver's Newton iteration a share of the step's tolerance."""
    finder = getattr(solver, "root_finder", None)
    if finder is None:
        return solver
    own = type(finder)(rtol=0.0, atol=_NEWTON_SHARE * jnp.asarray(tolerance))
    return eqx.tree_at(lambda s: s.root_finder, solver, own)
