"""Orders of the Rosenbrock schemes."""

import diffrax
import jax.numpy as jnp
import numpy as np
import pytest

from frictionjax.wiggly.sequential.rosenbrock_solvers import Rodas4P2, Rodas5P


def field(t, y, args):
    return -3 * jnp.sin(y) + 0.3 * jnp.cos(2 * t) * y**2 + t


def solve(solver, steps, **options):
    return diffrax.diffeqsolve(
        diffrax.ODETerm(field),
        solver,
        0.0,
        2.0,
        2.0 / steps,
        jnp.asarray(0.7),
        **options,
    ).ys[-1]


@pytest.fixture(scope="module")
def exact():
    tight = diffrax.PIDController(rtol=1e-13, atol=1e-13)
    return solve(diffrax.Dopri8(), 200, stepsize_controller=tight)


@pytest.mark.parametrize("solver", [Rodas5P(), Rodas4P2()], ids=["Rodas5P", "Rodas4P2"])
def test_orders(solver, exact):
    order = solver.tableau.order
    counts = np.array([11, 22, 44, 88])
    errors = np.array([abs(float(solve(solver, n) - exact)) for n in counts])
    found = np.polyfit(np.log(counts), -np.log(errors), 1)[0]
    assert found == pytest.approx(order, abs=0.3)


@pytest.mark.parametrize("solver", [Rodas5P(), Rodas4P2()], ids=["Rodas5P", "Rodas4P2"])
def test_a_stiff_rest_is_followed(solver):
    # L-stable: a step of a million relaxation times lands on the equilibrium.
    found = diffrax.diffeqsolve(
        diffrax.ODETerm(lambda t, y, args: -1e8 * (y - jnp.cos(t))),
        solver,
        0.0,
        1.0,
        0.05,
        jnp.asarray(0.0),
    )
    assert float(found.ys[-1]) == pytest.approx(np.cos(1.0), abs=1e-6)


@pytest.mark.parametrize("state", [jnp.ones(2), (jnp.ones(()), jnp.ones(()))])
def test_states_of_several_numbers_are_refused(state):
    """Their Jacobian is a matrix; a diagonal in its place gave wrong states, quietly."""
    term = diffrax.ODETerm(lambda t, y, args: y)
    with pytest.raises(ValueError, match="y0 = 'a state of shape"):
        diffrax.diffeqsolve(term, Rodas5P(), 0.0, 1.0, 0.1, state)
