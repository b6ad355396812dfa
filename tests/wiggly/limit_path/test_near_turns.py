"""Loads that turn while a tip is at a fold: a slip there hangs on very little."""

import jax
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.model import tabulated_scene
from frictionjax.wiggly.equation import plan_steps
from frictionjax.wiggly.equation.landscape import landscape
from frictionjax.wiggly.limit_path import known_path, nearness_at_turns

PERIOD = 3.0
SLOPE, HELD = 0.1, 1.0
BEND = 0.5 * SLOPE * (2 * np.pi) ** 2
VERTICAL = fx.Scene(
    fx.profiles.Sine(SLOPE),
    fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
    fx.supports.Spring(HELD),
    fx.loads.Sine(SLOPE, PERIOD),
    duration=PERIOD,
)
SLANTED = VERTICAL.replace(bristle=fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0))


def needed(eps: float, gamma: float) -> float:
    """By how much in N a sine has to pass the fold of a vertical spring for a slip.

    `eps^(gamma+1) y' = b y^2 + excess - c t^2` from the branch y = t sqrt(c/b), t < 0: it
    goes on along y = t sqrt(c/b) where the excess is eps^(gamma+1) sqrt(c/b).
    """
    return eps ** (1 + gamma) * np.sqrt(0.5 * SLOPE / BEND) * 2 * np.pi / PERIOD


def fold(eps: float) -> float:
    """In N, of `Phi' + V'` of a vertical spring: slopes at the top of W' lift it."""
    return SLOPE + (eps * (HELD + SLOPE**2)) ** 2 / (4 * BEND)


def after_a_peak(excess: float, eps: float, gamma: float, **options):
    """Of a vertical spring, 0.1 s after it."""
    scene = VERTICAL.replace(load=fx.loads.Sine(fold(eps) + excess, PERIOD))
    return fx.solve(scene, eps, gamma, [0.85], **options)


@pytest.mark.parametrize(
    ("eps", "gamma"),
    [(1e-3, 1.0), (1e-5, 1.0), (1e-6, 0.75), (1e-5, 1.5), (1e-4, 2.25), (1e-7, 1.0)],
)
@pytest.mark.parametrize(("share", "slips"), [(0.0, 0), (0.9, 0), (1.1, 1), (5.0, 1)])
def test_a_slip_takes_what_a_parabola_takes(eps, gamma, share, slips):
    found = after_a_peak(share * needed(eps, gamma), eps, gamma)
    assert found.ok
    assert np.round(found.z[0] / eps) == slips


@pytest.mark.parametrize(("beyond", "wells"), [(-1e-8, 19.837), (1e-8, 20.820)])
def test_a_load_with_a_kink_near_a_fold_makes_the_slip_that_it_should(beyond, wells):
    """From 0.300522446130530 N on: SciPy's Radau at rtol 1e-12, without the slip 1e-10 N
    below and with it 1e-10 N above. Steps at the default accuracy see it 1.6e-9 N early
    (both by hand).
    """
    eps, most = 1e-2, 0.300522446130530 + beyond
    load = fx.loads.PiecewiseLinear([0.0, 1.0, 2.0], [0.0, most, most - 0.1])
    bristle = fx.bristles.Homothetic(1.0)
    scene = VERTICAL.replace(bristle=bristle, load=load, duration=2.0)
    found = fx.solve(scene, eps, ts=[1.5])
    assert found.ok
    assert found.z[0] / eps == pytest.approx(wells, abs=1e-3)


@pytest.mark.parametrize("method", ["auto", "resolved"])
def test_a_load_that_only_touches_the_fold_makes_no_slip(method):
    """The first fold of a slanted spring is within 1e-12 N of its limit's."""
    touch = float(fx.friction(SLANTED).rho_plus)
    scene = SLANTED.replace(load=fx.loads.Sine(touch, PERIOD))
    rough, fine = (
        fx.solve(scene, 4e-5, ts=[0.8, 1.2], accuracy=accuracy, method=method)
        for accuracy in (1e-3, 1e-6)
    )
    assert rough.ok
    np.testing.assert_allclose(rough.z, fine.z, atol=1e-3 * 4e-5)
    assert np.all(np.abs(rough.z) < 0.2 * 4e-5)


def test_errors_of_a_load_that_touches_the_fold_converge():
    """Of a tip that slipped at small eps, losses there were 4.5 times as large."""
    touch = float(fx.friction(SLANTED).rho_plus)
    scene = SLANTED.replace(load=fx.loads.Sine(touch, PERIOD))
    data = fx.sweep(scene, np.geomspace(1e-5, 1e-3, 5), [1.0])
    share = (data.dissipation_error / data.eps).values.ravel()
    assert np.ptp(share) < 0.3 * share.min()


def test_a_plateau_at_the_fold_is_as_long_as_it_takes():
    """The tip leaves the fold behind in time E pi/sqrt(b excess), or is let go before."""
    eps, gamma, held = 1e-4, 1.0, 0.5
    most = (np.pi * eps ** (1 + gamma) / held) ** 2 / BEND
    for share, slips in ((0.5, 0), (2.0, 1)):
        peak = fold(eps) + share * most
        load = fx.loads.PiecewiseLinear([0, 1, 1 + held, 2], [0, peak, peak, 0])
        scene = VERTICAL.replace(load=load, duration=2.0)
        found = fx.solve(scene, eps, gamma, [1.9])
        assert np.round(found.z[0] / eps) == slips, share


def nearness(load: fx.loads.AbstractPull, eps: float, gamma: float) -> np.ndarray:
    scene = VERTICAL.replace(load=load)
    path = known_path(scene, tabulated_scene(scene, eps))
    found = jax.jit(landscape)(scene.potential, eps).folds
    folds = jax.tree_util.tree_map(lambda number: np.asarray(number)[None], found)
    one = np.ones(1)
    return nearness_at_turns(path, folds, eps * one, eps**gamma * one, 0.01 * one)[0]


@pytest.mark.parametrize(("eps", "gamma"), [(1e-2, 1.0), (1e-3, 0.75)])
def test_branches_are_as_far_apart_as_closed_forms_say(eps, gamma):
    """Where the load turns at the fold itself; within a factor of two, as times go by."""
    drag, held = eps ** (1 + gamma), 0.5
    peak = fold(eps)
    plateau = fx.loads.PiecewiseLinear([0, 1, 1 + held, PERIOD], [0, peak, peak, -1])
    fall = peak + 1
    kink = fx.loads.PiecewiseLinear([0, 1.5, PERIOD], [0, peak, -1])
    rise = peak / 1.5
    for load, width in (
        (fx.loads.Sine(peak, PERIOD), np.sqrt(needed(eps, gamma) / BEND)),
        (plateau, drag / (BEND * held)),
        (kink, np.cbrt(drag * min(rise, fall / 1.5) / BEND**2)),
    ):
        first = nearness(load, eps, gamma)[0]
        assert 0.5 * width < first < 2 * width
    assert np.all(nearness(fx.loads.Sine(1.03225 * peak, PERIOD), eps, gamma) == np.inf)


def test_a_load_that_misses_the_fold_is_as_near_as_it_misses():
    eps, gamma, missed = 1e-5, 2.0, 1e-9
    for side in (1, -1):
        first = nearness(fx.loads.Sine(fold(eps) + side * missed, PERIOD), eps, gamma)[0]
        assert first == pytest.approx(np.sqrt(missed / BEND), rel=0.01)


def of_a_spring(stiffness, peak: float) -> fx.Scene:
    load, support = fx.loads.Sine(peak, PERIOD), fx.supports.Spring(stiffness)
    return SLANTED.replace(load=load, support=support)


def test_plans_of_steps_that_follow_each_other_know_it_too():
    touch, eps = float(fx.friction(SLANTED).rho_plus), 3e-5

    @jax.jit
    def tolerance(peak):
        return plan_steps(of_a_spring(1.0, peak), eps, 1.0, 1e-3).tolerance

    usual = tolerance(touch + 0.4 * eps)
    assert tolerance(touch) < 0.1 * usual
    assert tolerance(touch + 1e-4 * eps) < usual
    assert tolerance(touch + 0.3 * eps) > 0.5 * usual


@pytest.mark.slow
def test_derivatives_are_those_of_a_tip_that_does_not_slip():
    touch, eps = float(fx.friction(SLANTED).rho_plus), 3e-5

    def at_rest(stiffness):
        return fx.solve(of_a_spring(stiffness, touch), eps, ts=[0.8]).z[0] / eps

    value, slope = jax.value_and_grad(at_rest)(1.0)
    assert value == pytest.approx(float(at_rest(1.0)), abs=1e-3)
    assert abs(slope) < 1e-3
