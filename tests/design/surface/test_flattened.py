"""Surfaces whose lowest slope is flattened: the least bent of all, and proven to be."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.design.surface.barrier import free_energy, kernel_ratio
from frictionjax.design.surface.exchange import place_of_lowest
from frictionjax.design.surface.fit import surface_problem
from frictionjax.design.surface.flattened import flattened

HOMOTHETIC = fx.bristles.Homothetic(1.0)
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.6)


def runs_of(targets, harmonics=16, **bounds):
    problem = surface_problem(targets, harmonics, **bounds)
    return flattened(problem.layout, problem.task, 2)


def ratios(harmonics):
    """From where something is flattened to next to the largest one."""
    least = kernel_ratio(harmonics)
    return least + (harmonics - least) * np.array([0.02, 0.5, 0.9, 0.97, 0.995])


CASES = [(2, 1), (3, -1), (4, 1), (16, -1)]
REST = [(n, side) for n in (2, 3, 4, 8, 16) for side in (1, -1) if (n, side) not in CASES]


@pytest.mark.parametrize(
    ("harmonics", "side"),
    CASES + [pytest.param(*case, marks=pytest.mark.slow) for case in REST],
)
def test_is_no_more_bent_than_two_tips_at_a_place_see(harmonics, side):
    """They see the surface twice, and take another way: places of the lowest slope too."""
    pair = (fx.effects.RigidArray([0.0, 1e-7]),)
    for ratio in ratios(harmonics):
        plus, minus = (0.1 * ratio, 0.1) if side > 0 else (0.1, 0.1 * ratio)
        fit = fx.fit_profile(fx.Target(HOMOTHETIC, plus, -minus), harmonics=harmonics)
        twice = fx.Target(HOMOTHETIC, 2 * plus, -2 * minus)
        other = fx.fit_profile(twice, harmonics=harmonics, effects=pair)
        assert fit.success
        assert other.success
        assert fit.bending_energy == pytest.approx(other.bending_energy, rel=1e-6)
        excess = fit.bending_energy / fit.bending_bound - 1
        assert -1e-12 < excess < 2e-4
        law = fx.friction(fit.profile, HOMOTHETIC)
        assert float(law.rho_plus) == pytest.approx(plus, rel=1e-13)
        assert float(law.rho_minus) == pytest.approx(-minus, rel=1e-13)


def test_where_it_is_another_problem_there_is_none():
    uneven = fx.Target(HOMOTHETIC, 0.3, -0.1)
    assert runs_of(uneven) is not None
    assert runs_of(fx.Target(HOMOTHETIC, 0.15, -0.1)) is None  # in closed form
    assert runs_of(fx.Target(HOMOTHETIC, 0.45, -0.1), 4) is None  # no surface has them
    assert runs_of([uneven, fx.Target(HOMOTHETIC, 0.31, -0.1)]) is None
    assert runs_of(uneven, radius=1e-3) is not None
    assert runs_of(uneven, radius=1.0) is None
    assert runs_of(uneven, amplitude=10.0) is None
    problem = {"free": ["angle"], "bounds": {"angle": (0.5, 0.7)}}
    assert runs_of(fx.Target(SLANTED, 0.3, -0.1), **problem) is None


def test_the_place_of_the_lowest_slope_is_its_own():
    """Of `cos(2 pi y) + 0.4 cos(4 pi y)`, its lowest at `cos(2 pi y) = -1/1.6`."""
    waves = np.array([2 * np.pi, 0.4 * 4 * np.pi, 0.0, 0.0]) / np.sqrt(2)
    lowest = np.arccos(-1 / 1.6) / (2 * np.pi)
    assert place_of_lowest(waves) == pytest.approx(lowest, abs=1e-12)


def test_a_barrier_that_ends_elsewhere_proves_no_more_than_of_all():
    """With bounds that are not felt: half as much again as it bends was called least."""
    targets, plain = fx.Target(HOMOTHETIC, 0.1, -0.39), {"harmonics": 4, "starts": 2}
    unfelt = {"largest_amplitude": 10.0, "smallest_radius": 1e-3}
    fit = fx.fit_profile(targets, **unfelt, **plain)
    assert fit.success
    of_all = free_energy(0.1, 0.39, 4)
    assert fit.bending_bound == pytest.approx(of_all, rel=1e-6)
    assert 0.7 * fit.bending_energy < fit.bending_bound <= fit.bending_energy
    assert fit.bending_energy >= 0.9999 * fx.fit_profile(targets, **plain).bending_energy
