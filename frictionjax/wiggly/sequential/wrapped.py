"""Bases of step size controllers and solvers that wrap another one."""

from typing import Any, ClassVar

import diffrax
from equinox import AbstractVar


class AbstractWrappedController(diffrax.AbstractAdaptiveStepSizeController):
    """Forwards what a solver asks of a controller to the one inside."""

    controller: AbstractVar[diffrax.AbstractAdaptiveStepSizeController]

    @property
    def rtol(self) -> Any:  # type: ignore[override]
        return self.controller.rtol

    @property
    def atol(self) -> Any:  # type: ignore[override]
        return self.controller.atol

    @property
    def norm(self) -> Any:  # type: ignore[override]
        return self.controller.norm


class AbstractWrappedSolver(diffrax.AbstractAdaptiveSolver):
    """A solver of y' inside one whose state carries more, which does not steer it."""

    solver: AbstractVar[diffrax.AbstractSolver]
    term_structure: ClassVar = diffrax.ODETerm
    interpolation_cls: ClassVar = diffrax.LocalLinearInterpolation

    def order(self, terms: Any) -> Any:
        return self.solver.order(terms)

    def error_order(self, terms: Any) -> Any:
        return self.solver.error_order(terms)

    def func(self, terms: Any, t0: Any, y0: Any, args: Any) -> Any:
        return terms.vf(t0, y0, args)
