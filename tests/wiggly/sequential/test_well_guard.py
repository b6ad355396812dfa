"""No step over a well, whatever the error estimate says; steps end at kinks."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.wiggly.equation.landscape import landscape
from frictionjax.wiggly.equation.step_plan import StepPlan, plan_steps
from frictionjax.wiggly.sequential.integration import integrate
from frictionjax.wiggly.sequential.rosenbrock_solvers import Rodas5P

EPS = 0.02


@pytest.fixture(scope="module")
def scene():
    return fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Ramp(0.5),
        3.0,
    )


@eqx.filter_jit
def run(scene, plan, solver, ts):
    one = jnp.asarray(1.0)
    return integrate(scene, jnp.asarray(EPS), one, ts, plan, solver, until=ts[-1])


@eqx.filter_jit
def planned(scene):
    return plan_steps(scene, jnp.asarray(EPS), jnp.asarray(1.0), jnp.asarray(1e-3))


def plan_of(scene, tolerance, reach=None) -> StepPlan:
    plan = planned(scene)
    reach = plan.reach if reach is None else jnp.asarray(reach)
    return plan._replace(tolerance=jnp.asarray(tolerance), reach=reach)


@pytest.mark.slow  # a program without the guard
def test_guard_keeps_the_well_where_tolerance_does_not(scene):
    """With an error estimate that accepts anything, only the guard holds."""
    ts = jnp.linspace(0.1, 3.0, 30)
    truth = run(scene, plan_of(scene, 1e-8), Rodas5P(), ts)
    loose = 0.3
    guarded = run(scene, plan_of(scene, loose), Rodas5P(), ts)
    bare = run(scene, plan_of(scene, loose, reach=1e3), Rodas5P(), ts)

    def wells_off(found):
        return np.abs(np.round(np.asarray(found.z - truth.z) / EPS)).max()

    lost, kept = wells_off(bare), wells_off(guarded)
    assert lost >= 1  # the guard is what makes the difference
    assert kept == 0


@pytest.mark.slow  # a program of its own
def test_no_accepted_step_is_longer_than_the_reach(scene):
    """Seen from outside: a watch that measures the longest move between accepted steps."""
    from frictionjax.wiggly.sequential.augmented_solver import AbstractObserver

    class Longest(AbstractObserver):
        def start(self, z):
            return (z, jnp.zeros_like(z))

        def look(self, memory, t, z, dissipation):
            return (z, jnp.maximum(memory[1], jnp.abs(z - memory[0])))

    @eqx.filter_jit
    def longest(scene, plan, ts):
        one = jnp.asarray(1.0)
        eps = jnp.asarray(EPS)
        found = integrate(
            scene, eps, one, ts, plan, Rodas5P(), until=ts[-1], watch=Longest()
        )
        return found.watched[1]

    plan = plan_of(scene, 0.3)
    moved = longest(scene, plan, jnp.linspace(0.1, 3.0, 30))
    assert moved <= plan.reach * EPS * (1 + 1e-9)
    assert moved > 0.5 * plan.reach * EPS  # the guard was at work


def test_reach_is_a_quarter_of_the_narrowest_branch():
    wells = eqx.filter_jit(landscape)

    def branch(*sin):
        profile = fx.profiles.Fourier(np.zeros(16), np.array(sin))
        wiggles = fx.potential(profile, fx.bristles.Homothetic(1.0))
        return float(wells(wiggles, jnp.asarray(0.01)).branch)

    assert branch(0.016, *np.zeros(15)) == pytest.approx(0.5, abs=0.01)
    # A weak 16th harmonic makes branches of 1/32.
    assert 0.5 / 32 < branch(0.016, *np.zeros(14), 0.002) < 1.1 / 32


def test_corners_are_no_branches():
    """W' falls over a quarter of the radius, between flanks of 0.3 and 0.4."""

    def branch(radius, places=(0.1, 0.4, 0.7), heights=(0.0, 0.02, -0.01)):
        profile = fx.profiles.Polyline(list(places), list(heights), radius)
        wiggles = fx.potential(profile, fx.bristles.Homothetic(1.0))
        return float(eqx.filter_jit(landscape)(wiggles, jnp.asarray(0.01)).branch)

    assert branch(0.002) > 0.25
    assert branch(0.1) > 0.25
    assert branch(0.6) == pytest.approx(0.15, abs=4e-3)  # of 0.85 beside it: no corner


@pytest.mark.slow
def test_steps_end_at_kinks_of_the_load():
    """The same load with a kink that no time asked for shows: values on both sides."""
    load = fx.loads.PiecewiseLinear([0.0, 0.4137, 1.0], [0.0, 0.5, -0.3])
    parts = fx.profiles.Sine(0.1), fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    scene = fx.Scene(*parts, fx.supports.Spring(1.0), load, 1.0)
    ends = []

    from frictionjax.wiggly.sequential.augmented_solver import AbstractObserver

    class Nearest(AbstractObserver):
        def start(self, z):
            return jnp.full_like(z, jnp.inf)

        def look(self, memory, t, z, dissipation):
            return jnp.minimum(memory, jnp.abs(t - 0.4137))

    for ts in (jnp.asarray([1.0]), jnp.asarray([0.2, 0.7, 1.0])):
        found = eqx.filter_jit(
            lambda ts: (
                integrate(
                    scene,
                    jnp.asarray(EPS),
                    jnp.asarray(1.0),
                    ts,
                    plan_of(scene, 1e-5),
                    Rodas5P(),
                    until=ts[-1],
                    watch=Nearest(),
                ).watched
            )
        )(ts)
        ends.append(float(found))
    assert max(ends) < 1e-15
