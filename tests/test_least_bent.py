"""Surfaces in closed form, and where `fit_profile` must not take them."""

import jax.numpy as jnp
import pytest

import frictionjax as fx
from frictionjax.design.bending import free_energy, kernel_ratio
from frictionjax.design.constraints import Layout, heights_of
from frictionjax.design.extreme_slopes import reach
from frictionjax.design.least_bent import has_closed_form, least_bent
from frictionjax.design.profile_fit import problem_of
from frictionjax.design.targets import require_targets

HOMOTHETIC = fx.bristles.Homothetic(1.0)
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.6)


def found(targets, harmonics=16, **bounds):
    """Waves, slopes asked for, and whether they are the optimum."""
    problem = problem_of(require_targets(targets), harmonics, **bounds)
    layout, task = problem.layout, problem.task
    x, known = least_bent(layout, task)
    point = layout.split(x)
    return point.waves * task.slope, point.plus * task.slope, bool(known)


@pytest.mark.parametrize("harmonics", [2, 3, 16, 40])
@pytest.mark.parametrize("turned", [False, True])
def test_is_the_least_energy_there_is(harmonics, turned):
    """Both slopes are reached half a period apart, at the energy of the theorem."""
    ratio = 0.99 * kernel_ratio(harmonics)
    plus, minus = (0.2, 0.2 * ratio) if turned else (0.2 * ratio, 0.2)
    waves, _, known = found(fx.Target(HOMOTHETIC, plus, -minus), harmonics)
    ends = reach(waves)
    assert known
    assert float(ends.plus) == pytest.approx(plus, rel=1e-13)
    assert float(ends.minus) == pytest.approx(minus, rel=1e-13)
    energy = float(jnp.sum(waves**2))
    assert energy == pytest.approx(free_energy(plus, minus, harmonics), rel=1e-12)


def test_beyond_the_ratio_of_kernels_it_would_undershoot():
    """There the lowest slope is flattened: a programme with active rows."""
    ratio = 1.01 * kernel_ratio(16)
    waves, _, known = found(fx.Target(HOMOTHETIC, 0.2 * ratio, -0.2))
    assert not known
    assert float(reach(waves).minus) > 0.2 * (1 + 1e-6)


def test_targets_have_to_agree():
    """Of two bristles on one surface; a ten-thousandth apart they do not."""
    one = fx.Target(HOMOTHETIC, 0.3, -0.2)
    law = fx.friction(fx.profiles.Fourier(*heights_of(found(one)[0])), SLANTED)
    plus, minus = float(law.rho_plus), float(law.rho_minus)
    assert found([one, fx.Target(SLANTED, plus, minus)])[2]
    assert not found([one, fx.Target(SLANTED, plus * (1 + 1e-4), minus)])[2]


def test_bounds_have_to_hold_with_their_margin():
    target = fx.Target(HOMOTHETIC, 0.3, -0.2)
    waves, _, _ = found(target)
    radius = 1 / float(reach(waves).curvature)
    assert found(target, radius=0.99 * radius)[2]
    assert not found(target, radius=0.9999 * radius)[2]
    # Slopes that the rod cannot follow, though a surface has them.
    steep = fx.bristles.AngularSpring(1.0, 1.5, 1.0, 0.2)
    high = float(steep.slope_bounds().upper)
    law = fx.friction(fx.profiles.Sine(0.5 * high), steep)
    waves, plus, known = found(fx.Target(steep, law.rho_plus, law.rho_minus))
    assert known
    assert float(plus[0]) == pytest.approx(0.5 * high)


@pytest.mark.parametrize(
    ("layout", "may"),
    [
        (Layout(16, False, False, 0), True),
        (Layout(16, True, False, 0), True),
        (Layout(16, False, True, 0), False),  # starts differ in where the slope is lowest
        (Layout(16, False, False, 1), False),
        (Layout(1, False, False, 0), False),  # a sine: both slopes are one number
    ],
)
def test_where_there_may_be_one(layout, may):
    assert has_closed_form(layout) is may
