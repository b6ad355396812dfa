"""Solvers by name, and the Rosenbrock method itself."""

import diffrax
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.wiggly.sequential.rosenbrock_solvers import Rodas5P
from frictionjax.wiggly.sequential.solvers_by_name import known_solvers

EPS = 0.06
TIMES = np.linspace(0.0, 1.5, 16)


@pytest.fixture(scope="module")
def scene():
    return fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.SlantedSpring(1.0, 2.2, 1.0, 0.4),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0488, 3.0),
        3.0,
    )


@pytest.fixture(scope="module")
def truth(scene):
    return np.asarray(fx.solve(scene, EPS, 1.0, TIMES, accuracy=1e-8).z)


@pytest.mark.parametrize(
    "method",
    [
        "auto",
        "windowed",
        *(
            pytest.param(m, marks=pytest.mark.slow)
            for m in (diffrax.Dopri8(), "Kvaerno5", "Tsit5", diffrax.Kvaerno3)
        ),
    ],
    ids=str,
)
def test_any_solver_by_name_class_or_instance(scene, truth, method):
    found = fx.solve(scene, EPS, 1.0, TIMES, accuracy=1e-3, method=method)
    assert found.ok
    assert np.abs(np.asarray(found.z) - truth).max() < 1e-3 * EPS


@pytest.mark.slow  # a program of diffrax: 11 s
def test_values_say_how_they_were_obtained(scene):
    found = fx.solve(scene, EPS, 1.0, TIMES, method="Kvaerno5")
    assert "Kvaerno5" in found.stats["values"]
    assert int(found.stats["steps"]) > int(found.stats["rejected"]) >= 0


@pytest.mark.parametrize("method", ["Euler", "KenCarp4", "nonsense", 3, "HalfSolver"])
def test_unusable_solvers_are_refused(scene, method):
    with pytest.raises(ValueError, match=r"method = .*: needs one of .*Kvaerno5"):
        fx.solve(scene, EPS, method=method)


def test_known_solvers_are_named():
    assert {"Kvaerno3", "Kvaerno5", "ImplicitEuler", "Tsit5", "Dopri8"} <= set(
        known_solvers()
    )


@pytest.mark.slow
def test_budget_of_steps_ends_as_a_status(scene):
    found = fx.solve(scene, EPS, 1.0, TIMES, max_steps=16)
    assert not found.ok
    assert found.status is fx.Status.MAX_STEPS
    assert np.isnan(np.asarray(found.z)[-1])


@pytest.mark.slow
def test_slips_below_the_spacing_of_floats_end_as_a_status(scene):
    found = fx.solve(scene, 1e-4, 4.0, [0.5, 1.0], method="Kvaerno3")
    assert found.status is fx.Status.STEP_TOO_SMALL
    assert "spacing of floats" in found.status.message


def test_lanes_go_on_below_the_spacing_of_floats(scene):
    # A slip of 1e-20 s at t = 1 s: lanes count time from their own start.
    found = fx.solve(scene, 1e-4, 4.0, [0.5, 1.0])
    assert found.ok
    assert np.abs(found.z - fx.solve_limit(scene, [0.5, 1.0]).z).max() < 1e-4


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"eps": 0.0}, "eps = 0"),
        ({"eps": [0.1, 0.2]}, "eps = .*one number"),
        ({"eps": np.nan}, "eps = nan"),
        ({"gamma": -1.0}, "gamma = -1"),
        ({"accuracy": 0.0}, "accuracy = 0"),
        ({"dissipation": "no"}, "dissipation = 'no': needs True or False"),
        ({"ts": [0.2, 0.1]}, "ts = .*do not decrease"),
        ({"ts": [0.0, 4.0]}, r"ts = .*\[0, 3\]"),
    ],
)
def test_bad_arguments_are_named(scene, arguments, message):
    with pytest.raises(ValueError, match=message):
        fx.solve(scene, **({"eps": EPS} | arguments))


@pytest.mark.slow
def test_start_may_lie_outside_the_strip():
    parts = fx.profiles.Sine(0.1), fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    load = fx.loads.Ramp(0.0)
    scene = fx.Scene(*parts, fx.supports.Spring(1.0), load, 1.0, z0=0.7)
    found = fx.solve(scene, 0.02, 1.0, [0.0, 1.0])
    assert found.z[0] == pytest.approx(0.7, abs=1e-12)
    assert abs(found.z[1]) < 0.1 + 0.02  # slid back to the strip's edge, rho = 0.1
    with pytest.raises(ValueError, match=r"scene\.z0 = 0\.7: needs .*\[-0\.(1|09999\d+), "):
        fx.solve_limit(scene)


@pytest.mark.slow  # as `test_orders` of test_rosenbrock_solvers.py, and down to rounding
def test_rosenbrock_converges_with_order_five():
    """Fixed steps on a nonlinear, forced equation, above the rounding floor."""

    def field(t, y, args):
        return -3 * (y - jnp.cos(t)) * (1 + y**2) - jnp.sin(t)

    def end(steps):
        return diffrax.diffeqsolve(
            diffrax.ODETerm(field),
            Rodas5P(),
            0.0,
            2.0,
            2.0 / steps,
            jnp.asarray(0.3),
            max_steps=4096,
        ).ys[0]

    exact = float(end(2048))
    errors = np.array([abs(float(end(n)) - exact) for n in (32, 64, 128)])
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all(orders > 4.7)
    assert errors[-1] < 1e-12


def test_rosenbrock_damps_stiff_transients():
    """L-stable: a step 1e8 relaxation times long lands on the slow solution."""
    found = diffrax.diffeqsolve(
        diffrax.ODETerm(lambda t, y, args: -1e8 * (y - jnp.sin(t))),
        Rodas5P(),
        0.0,
        1.0,
        1.0,
        jnp.asarray(5.0),
    )
    assert abs(float(found.ys[0]) - np.sin(1.0)) < 1e-6


@pytest.mark.slow
def test_a_solution_goes_through_jit_and_vmap_whole(scene):
    ts = jnp.asarray([0.5, 1.0])
    many = jax.jit(jax.vmap(lambda eps: fx.solve(scene, eps, 1.0, ts)))
    found = many(jnp.asarray([0.06, 0.08]))
    assert found.z.shape == (2, 2)
    assert "Rodas5P" in found.stats["values"]
    alone = fx.solve(scene, 0.08, 1.0, ts)
    assert np.abs(np.asarray(found.z[1] - alone.z)).max() < 1e-4 * 0.08
    assert "OK" in repr(alone)
