"""Rosenbrock methods as solvers of diffrax."""

from typing import Any, ClassVar

import diffrax
import jax
import jax.numpy as jnp
from equinox import AbstractClassVar

from ..._checks import Real, require
from ..rosenbrock import RODAS4P2, RODAS5P, Linearised, Tableau, rosenbrock_step


class AbstractRosenbrock(diffrax.AbstractAdaptiveSolver):
    """A scheme for a scalar state, with exact Jacobian and time derivative by autodiff.

    Steps end where values are wanted: between, lines do. Raises `ValueError` for a state of
    another shape: its Jacobian would be a matrix.
    """

    tableau: AbstractClassVar[Tableau]
    term_structure: ClassVar = diffrax.ODETerm
    interpolation_cls: ClassVar = diffrax.LocalLinearInterpolation

    def order(self, terms: Any) -> int:
        return self.tableau.order

    def init(self, terms: Any, t0: Any, t1: Any, y0: Any, args: Any) -> None:
        shape = getattr(y0, "shape", type(y0).__name__)
        require(shape == (), "y0", f"a state of shape {shape}", "one number, of shape ()")
        return None

    def func(self, terms: Any, t0: Any, y0: Real, args: Any) -> Real:
        return terms.vf(t0, y0, args)

    def step(
        self,
        terms: Any,
        t0: Any,
        t1: Any,
        y0: Real,
        args: Any,
        solver_state: None,
        made_jump: Any,
    ) -> tuple:
        def field(t: Real, y: Real) -> Real:
            return terms.vf(t, y, args)

        velocity, by_state = jax.jvp(lambda y: field(t0, y), (y0,), (jnp.ones_like(y0),))
        _, by_time = jax.jvp(lambda t: field(t, y0), (t0,), (jnp.ones_like(t0),))
        start = Linearised(velocity, by_state, by_time)
        y1, stages = rosenbrock_step(self.tableau, field, start, t0, t1 - t0, y0)
        return y1, stages[-1], {"y0": y0, "y1": y1}, None, diffrax.RESULTS.successful


class Rodas5P(AbstractRosenbrock):
    """Rodas5P for a scalar state.

    On the paper's vertical spring at gamma = 1 and tolerance 1e-4 it takes 37 steps a slip
    at eps = 1e-2, where Kvaerno5 takes 1405 and Kvaerno3 962.
    """

    tableau: ClassVar[Tableau] = RODAS5P


class Rodas4P2(AbstractRosenbrock):
    """Rodas4P2 for a scalar state: six stages to Rodas5P's eight, for larger errors.

    At gamma = 1 and eps = 1e-3 it takes 40 steps a slip at tolerance 1e-3 for the error
    that Rodas5P makes with 56 at 1e-4; below tolerances of about 1e-5 Rodas5P is cheaper.
    """

    tableau: ClassVar[Tableau] = RODAS4P2
