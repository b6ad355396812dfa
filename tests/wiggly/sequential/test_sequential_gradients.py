"""Derivatives of trajectories against central differences."""

import diffrax
import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.wiggly.sequential import way_adjoint as fronts

EPS = 0.05
TIMES = np.linspace(0.1, 1.4, 9)
# Where the load turns, but for a rounding, states have a derivative on either side.
SMOOTH = np.abs(TIMES - 0.75) > 1e-9


def scene_of(p):
    return fx.Scene(
        fx.profiles.Sine(p[0]),
        fx.bristles.SlantedSpring(p[1], 2.2, 1.0, p[2]),
        fx.supports.Spring(p[3]),
        fx.loads.Triangle(p[4], p[8]),
        1.5,
        p[5],
    )


NAMES = ["slope", "stiffness", "angle", "support", "amplitude", "z0", "eps", "gamma"]
NAMES += ["period"]
POINT = jnp.array([0.1, 1.0, 0.4, 1.0, 1.0488, 0.01, EPS, 0.8, 3.0])


@eqx.filter_jit
def states(p, **options):
    found = fx.solve(scene_of(p), p[6], p[7], TIMES, accuracy=1e-9, **options)
    return jnp.concatenate([found.z[SMOOTH], found.dissipation[-1:]]), found.dissipation


@pytest.fixture(scope="module")
def jacobians():
    return jax.jit(jax.jacrev(states))(POINT)


@pytest.fixture(scope="module")
def jacobian(jacobians):
    return jacobians[0]


@pytest.mark.slow  # two programs: 24 s; the same of `solve`: ../test_differentiable.py
@pytest.mark.parametrize("i", range(len(NAMES)), ids=NAMES)
def test_reverse_mode_agrees_with_central_differences(jacobian, i):
    """About 15 slips, through Rosenbrock steps and the energy balance.

    The load turns at one of the times asked for, or a rounding from it: the dissipation
    from there on must know when.
    """
    width = 3e-5 * max(0.1, abs(float(POINT[i])))
    shift = jnp.zeros_like(POINT).at[i].set(width)
    ends = [states(POINT + share * shift)[0] for share in (1, -1, 2, -2)]
    # Of order 4: of order 2 their own error is 1e-4.
    differences = (8 * (ends[0] - ends[1]) - (ends[2] - ends[3])) / (12 * width)
    error = jnp.max(jnp.abs(jacobian[:, i] - differences))
    assert error < 1e-5 * jnp.max(jnp.abs(differences))


@pytest.mark.slow
def test_dissipation_has_one_derivative_where_the_load_turns(jacobians):
    """Of the power that is dissipated the load's turning point is only a kink."""
    shift = 1e-6 * np.eye(POINT.size)[NAMES.index("period")]
    behind, here, ahead = (states(POINT + by * shift)[1] for by in (-1, 0, 1))
    slopes = jacobians[1][:, NAMES.index("period")]
    for side in (here - behind, ahead - here):
        assert jnp.max(jnp.abs(slopes - side / 1e-6)) < 1e-3 * jnp.max(jnp.abs(slopes))


@pytest.mark.slow
def test_stretches_of_many_pieces(jacobian, monkeypatch):
    """Steps that are not kept would be made again, and would be others."""
    monkeypatch.setattr(fronts, "SETTINGS", fronts.SETTINGS._replace(piece=100))
    traced_again = {"max_steps": 2**29}
    found = jax.jit(jax.grad(lambda p: states(p, **traced_again)[0][-1]))(POINT)
    assert jnp.max(jnp.abs(found - jacobian[-1])) < 1e-6 * jnp.max(jnp.abs(found))


@pytest.mark.slow
def test_forward_mode_with_the_adjoint_for_it(jacobian):
    direction = jnp.zeros_like(POINT).at[3].set(1.0)

    def run(p):
        adjoint = diffrax.ForwardMode()
        found = fx.solve(scene_of(p), p[6], p[7], TIMES, accuracy=1e-9, adjoint=adjoint)
        return found.z[SMOOTH]

    _, tangent = jax.jit(lambda p: jax.jvp(run, (p,), (direction,)))(POINT)
    expected = jacobian[:-1, 3]
    assert jnp.max(jnp.abs(tangent - expected)) < 1e-6 * jnp.max(jnp.abs(expected))


@pytest.mark.slow
def test_gradient_with_respect_to_a_whole_scene():
    scene = scene_of([0.1, 1.0, 0.4, 1.0, 1.0488, 0.01, EPS, 0.8, 3.0])

    @eqx.filter_jit
    @eqx.filter_grad
    def last(scene):
        return fx.solve(scene, EPS, 0.8, [1.4], accuracy=1e-6).z[-1]

    gradient = last(scene)
    leaves = jax.tree_util.tree_leaves(gradient)
    assert all(bool(jnp.all(jnp.isfinite(leaf))) for leaf in leaves)
    assert abs(float(gradient.load.amplitude)) > 0.1


@pytest.mark.slow
@pytest.mark.parametrize("column", ["z", "dissipation"])
def test_what_failed_has_no_derivative(column):
    """It had one, 37.6 for -1.06, and plain `jax.grad` shows no status."""

    def last(slope):
        scene = scene_of(POINT.at[0].set(slope))
        return getattr(fx.solve(scene, EPS, 0.8, [1.4], max_steps=50), column)[-1]

    value, gradient = jax.value_and_grad(last)(0.1)
    assert jnp.isnan(value)
    assert jnp.isnan(gradient)
