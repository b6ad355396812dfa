"""Surfaces in closed form, and where `fit_profile` must not take them."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.design.surface.barrier import extreme_slopes
from frictionjax.design.surface.barrier.bending import free_energy, kernel_ratio
from frictionjax.design.surface.barrier.constraints import (
    FitShape,
    heights_of_waves,
)
from frictionjax.design.surface.fit import surface_problem
from frictionjax.design.surface.least_bent import (
    _waves,
    has_closed_form,
    least_bent,
)

HOMOTHETIC = fx.bristles.Homothetic(1.0)
reach = jax.jit(extreme_slopes.reach)
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.6)


def found(targets, harmonics=16, **bounds):
    """The row of one start of two, or None."""
    problem = surface_problem(targets, harmonics, **bounds)
    runs = least_bent(problem.layout, problem.task, 2)
    return None if runs is None else jax.tree_util.tree_map(lambda row: row[1], runs)


def waves_of(targets, *args, **bounds):
    """Waves of v = w' themselves."""
    problem = surface_problem(targets, *args, **bounds)
    return problem.task.slope * found(targets, *args, **bounds).settled.waves


@pytest.mark.parametrize(  # each number of harmonics is a program of `reach`
    "harmonics", [2, 16, *(pytest.param(n, marks=pytest.mark.slow) for n in (3, 40))]
)
@pytest.mark.parametrize("turned", [False, True])
def test_is_the_least_energy_there_is(harmonics, turned):
    """Both slopes are reached half a period apart, at the energy of the theorem."""
    ratio = 0.99 * kernel_ratio(harmonics)
    plus, minus = (0.2, 0.2 * ratio) if turned else (0.2 * ratio, 0.2)
    target = fx.Target(HOMOTHETIC, plus, -minus)
    waves = waves_of(target, harmonics)
    ends = reach(waves)
    assert float(ends.plus) == pytest.approx(plus, rel=1e-13)
    assert float(ends.minus) == pytest.approx(minus, rel=1e-13)
    energy = float(jnp.sum(waves**2))
    assert energy == pytest.approx(free_energy(plus, minus, harmonics), rel=1e-12)
    row = found(target, harmonics)
    assert float(row.bound) == pytest.approx(np.sum(row.settled.waves**2), rel=1e-12)


def test_beyond_the_ratio_of_kernels_it_would_undershoot():
    """There the lowest slope is flattened: a programme with active rows."""
    ratio = 1.01 * kernel_ratio(16)
    assert found(fx.Target(HOMOTHETIC, 0.2 * ratio, -0.2)) is None
    assert found(fx.Target(HOMOTHETIC, 0.2, -0.2 * ratio)) is None
    waves = _waves(16, 0.2 * ratio, 0.2)
    assert float(reach(jnp.asarray(waves)).minus) > 0.2 * (1 + 1e-6)


def test_targets_have_to_agree():
    """Of two bristles on one surface; a ten-thousandth apart they do not."""
    one = fx.Target(HOMOTHETIC, 0.3, -0.2)
    law = fx.friction(fx.profiles.Fourier(*heights_of_waves(waves_of(one))), SLANTED)
    plus, minus = float(law.rho_plus), float(law.rho_minus)
    assert found([one, fx.Target(SLANTED, plus, minus)]) is not None
    assert found([one, fx.Target(SLANTED, plus * (1 + 1e-4), minus)]) is None


def test_bounds_have_to_hold_with_their_margin():
    target = fx.Target(HOMOTHETIC, 0.3, -0.2)
    sharpest = float(reach(jnp.asarray(waves_of(target))).curvature)
    row = found(target, radius=0.99 / sharpest)
    assert row.room["curvature"] == pytest.approx(0.01, abs=5e-4)  # on rows
    assert found(target, radius=0.9999 / sharpest) is None
    # Slopes that the rod cannot follow, though a surface has them.
    steep = fx.bristles.AngularSpring(1.0, 1.5, 1.0, 0.2)
    high = float(steep.slope_bounds().upper)
    law = fx.friction(fx.profiles.Sine(0.5 * high), steep)
    target = fx.Target(steep, law.rho_plus, law.rho_minus)
    slope = surface_problem(target).task.slope
    row = found(target)
    assert slope * row.settled.wanted[0] == pytest.approx(0.5 * high)
    low = -float(steep.slope_bounds().lower)
    assert row.room["slopes"] == pytest.approx(1 - 0.5 * max(1, high / low))


@pytest.mark.parametrize(
    ("layout", "may"),
    [
        (FitShape(16, False, False, 0), True),
        (FitShape(16, True, False, 0), True),
        (FitShape(16, False, True, 0), False),  # starts differ in where the slope is lowest
        (FitShape(16, False, False, 1), False),
        (FitShape(1, False, False, 0), False),  # a sine: both slopes are one number
    ],
)
def test_where_there_may_be_one(layout, may):
    assert has_closed_form(layout) is may
