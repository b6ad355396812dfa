"""A question compiles what it needs and nothing else."""

import subprocess
import sys
from pathlib import Path

import equinox as eqx
import jax
import jax.numpy as jnp
import pytest

import frictionjax as fx
from frictionjax.wiggly.equation import step_plan as tolerance
from frictionjax.wiggly.equation.field import TipField
from frictionjax.wiggly.sequential import augmented_solver as observed
from frictionjax.wiggly.sequential import integration
from frictionjax.wiggly.sequential.rosenbrock_solvers import Rodas5P

SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.SlantedSpring(1.0, 2.2, 1.0, 0.4),
    fx.supports.Spring(1.0),
    fx.loads.Sine(1.0488, 3.0),
    3.0,
)


def equations(jaxpr) -> list[str]:
    """Names of all primitives in a jaxpr, loops and calls included."""
    names = []
    for equation in jaxpr.eqns:
        names.append(equation.primitive.name)
        for value in jax.tree_util.tree_leaves(
            equation.params, is_leaf=lambda v: hasattr(v, "eqns") or hasattr(v, "jaxpr")
        ):
            inner = getattr(value, "jaxpr", value)
            if hasattr(inner, "eqns"):
                names += equations(inner)
    return names


def traced(fn, scene) -> list[str]:
    numbers, static = eqx.partition(scene, eqx.is_array)
    return equations(jax.make_jaxpr(lambda n: fn(eqx.combine(n, static)))(numbers).jaxpr)


def trajectory_of(scene, balanced):
    one = jnp.asarray(1.0)
    ts = jnp.linspace(0, 3, 5)
    plan = tolerance.plan_steps(scene, 0.05 * one, one, 1e-3 * one)
    return integration.integrate(
        scene, 0.05 * one, one, ts, plan, Rodas5P(), until=ts[-1], balanced=balanced
    ).z


def test_coefficients_and_limit_hold_no_wiggly_system(monkeypatch):
    """The field's code is never run while they are traced, and their loops are few."""

    def forbidden(*args):
        raise AssertionError("the wiggly vector field was traced")

    monkeypatch.setattr(TipField, "driving_force", forbidden)
    monkeypatch.setattr(TipField, "velocity", forbidden)
    law = traced(lambda scene: fx.friction(scene).rho_plus, SCENE)
    limit = traced(lambda scene: fx.solve_limit(scene, jnp.linspace(0, 3, 7)).z, SCENE)
    assert law.count("scan") == 0
    assert limit.count("scan") == 1  # clip after clip; a trajectory is a scan of loops
    assert limit.count("while") == law.count("while")
    with pytest.raises(AssertionError, match="vector field"):
        traced(lambda scene: trajectory_of(scene, balanced=False), SCENE)


@pytest.mark.slow
def test_no_dissipation_no_balance(monkeypatch):
    bare = traced(lambda scene: trajectory_of(scene, balanced=False), SCENE)
    full = traced(lambda scene: trajectory_of(scene, balanced=True), SCENE)
    assert len(bare) < 0.8 * len(full)

    def forbidden(*args, **named):
        raise AssertionError("the balance was traced")

    monkeypatch.setattr(observed, "advance", forbidden)
    traced(lambda scene: trajectory_of(scene, balanced=False), SCENE)
    with pytest.raises(AssertionError, match="balance"):
        traced(lambda scene: trajectory_of(scene, balanced=True), SCENE)


def test_a_scene_without_effects_is_the_same_program():
    named = fx.Scene(
        SCENE.profile, SCENE.bristle, SCENE.support, SCENE.load, 3.0, effects=()
    )

    def program(scene):
        return trajectory_of(scene, balanced=True)

    assert traced(program, named) == traced(program, SCENE)


@pytest.mark.slow
def test_scenes_with_effects_leave_no_trace_in_the_programs_of_one_without():
    """All jaxprs of a solve and a limit, where nothing of theirs can be imported, too."""
    blocked, after = (programs_of_a_plain_scene(how) for how in ("blocked", "after"))
    assert sum("run_queue" in line for line in blocked) == 1
    assert len(blocked) > 10
    assert blocked == after


def programs_of_a_plain_scene(how):
    script = Path(__file__).parents[1] / "support" / "plain_programs.py"
    run = subprocess.run(
        [sys.executable, script, how], check=True, capture_output=True, text=True
    )
    return run.stdout.splitlines()


def test_unknown_effects_are_refused():
    with pytest.raises(ValueError, match=r"scene\.effects = .*needs effects"):
        fx.Scene(
            SCENE.profile, SCENE.bristle, SCENE.support, SCENE.load, 3.0, effects=("wind",)
        )


def test_parts_of_known_numbers_compile_nothing():
    """A spline took 15 programs, half a second, a rod 5."""
    code = (
        "import jax; jax.config.update('jax_enable_x64', True)\n"
        "import frictionjax as fx, numpy as np\n"
        "fx.profiles.Sine(0.1), fx.profiles.Fourier(np.ones(5), np.ones(5))\n"
        "names = []\n"
        "note = lambda name, seconds, **told: names.append(told.get('fun_name'))\n"
        "jax.monitoring.register_event_duration_secs_listener(note)\n"
        "fx.profiles.Spline(np.arange(5.0) % 3).slope_errors()\n"
        "fx.bristles.AngularSpring(1.0, 1.4, 1.0, 0.3)\n"
        "compiled = [name for name in names if name and name.startswith('jit')]\n"
        "assert not compiled, compiled\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_coefficients_import_no_solver():
    code = (
        "import jax; jax.config.update('jax_enable_x64', True)\n"
        "import frictionjax as fx, sys\n"
        "fx.friction(fx.profiles.Sine(0.1), fx.bristles.Homothetic(1.0))\n"
        "loaded = [m for m in sys.modules if m.startswith('frictionjax.wiggly')]\n"
        "assert not loaded, loaded\n"
        "assert 'diffrax' not in sys.modules\n"
        "assert 'matplotlib' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_planning_a_sweep_imports_no_general_solvers():
    code = (
        "import frictionjax.cost.prediction, frictionjax.sweeps.sweep_cells, sys\n"
        "import frictionjax.wiggly.trajectory\n"
        "heavy = {'diffrax', 'matplotlib', 'scipy', 'xarray'} & set(sys.modules)\n"
        "assert not heavy, heavy\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_without_effects_nothing_of_theirs_is_imported():
    code = (
        "import frictionjax.sweeps.sweep_cells, frictionjax.wiggly.trajectory, sys\n"
        "import frictionjax.limit.play, frictionjax.studies.convergence_study\n"
        "theirs = 'stochastic', 'turning', 'rods', 'contact', 'wiggly.inertial'\n"
        "theirs = tuple(f'frictionjax.{name}.' for name in theirs)\n"
        "loaded = [m for m in sys.modules if m.startswith(theirs)]\n"
        "assert not loaded, loaded\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_study_foretells_its_cost_without_general_solvers():
    code = "import frictionjax.report.study, sys\nassert 'diffrax' not in sys.modules\n"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_tables_of_friction_import_nothing_that_draws():
    code = (
        "import frictionjax.report.friction, sys\n"
        "heavy = {'diffrax', 'matplotlib', 'xarray'} & set(sys.modules)\n"
        "assert not heavy, heavy\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
