"""Loads that turn while a tip is on a fold."""

import numpy as np
import pytest
from outside_slips import states_outside_slips, times_about

import frictionjax as fx
from frictionjax.called_for import higher_order, setting_of, turns_on_folds
from frictionjax.io.example_scenes import example_text
from frictionjax.io.scene_files import parse_scene

EPS = 0.02
SPRING = parse_scene(example_text("vertical-spring"), "vertical-spring").scene


def over_the_first_fold(gap):
    """A load that turns `gap` (N) beyond what lifts the tip over its fifth fold.

    Of the homothetic bristle `W' = 0.1 cos(2 pi Y)`: folds are at whole wells.
    """
    parts = fx.profiles.Sine(0.1), fx.bristles.Homothetic(1.0), fx.supports.Spring(1.0)
    load = fx.loads.Sine(0.1 + 5 * EPS + gap, 4.0)
    return setting_of(fx.Scene(*parts, load, 2.0), EPS, 1.0)


@pytest.mark.parametrize(
    ("share", "found"), [(1e-3, [1.0]), (0.01, [1.0]), (0.5, []), (0.999, [1.0])]
)
def test_a_turn_is_on_a_fold_where_the_tip_has_no_time_to_pass(share, found):
    """`gap` in shares of the force from fold to fold. The load is so near to its turn for
    `2 sqrt(2 gap/|l''|)`; the tip takes `pi sqrt(2/(0.1 (2 pi)^2 gap)) eps^2`."""
    gap = share * EPS
    times = turns_on_folds(over_the_first_fold(gap))
    np.testing.assert_allclose(times, found, rtol=1e-6)
    nearest = min(gap, EPS - gap)
    bend = (0.2 + gap) * (np.pi / 2) ** 2
    held = 2 * np.sqrt(2 * nearest / bend)
    passing = np.pi * np.sqrt(2 / (0.1 * 4 * np.pi**2 * nearest)) * EPS**2
    assert bool(found) == (passing > 0.5 * held)


def test_a_turn_inside_the_strip_is_on_no_fold():
    parts = fx.profiles.Sine(0.1), fx.bristles.Homothetic(1.0), fx.supports.Spring(1.0)
    load = fx.loads.PiecewiseLinear([0.0, 1.0, 1.5, 2.0], [0.0, 0.51, 0.45, 0.5])
    times = turns_on_folds(setting_of(fx.Scene(*parts, load, 2.0), EPS, 1.0))
    assert 1.5 not in times.tolist()


@pytest.mark.parametrize(("share", "found"), [(1e-3, [1.0]), (0.5, [])])
def test_straight_flanks_are_passed_by_the_force_that_is_left(share, found):
    """Without a curvature the tip takes `eps^2/gap` for a well at most."""
    profile = fx.profiles.Polyline([0.25, 0.75], [0.03, -0.03], radius=0.02)
    parts = profile, fx.bristles.Homothetic(1.0), fx.supports.Spring(1.0)
    rho = float(fx.friction(*parts[:2]).rho_plus)
    still = fx.Scene(*parts, fx.loads.Sine(2 * rho, 4.0), 2.0)
    data = setting_of(still, EPS, 1.0).data
    top = float(data.phase[np.argmax(data.force)])
    load = fx.loads.Sine(rho + EPS * (top + 5 + share), 4.0)
    times = turns_on_folds(setting_of(still.replace(load=load), EPS, 1.0))
    np.testing.assert_allclose(times, found, rtol=1e-6)


def test_the_closed_form_says_where_it_is_no_bound():
    for gamma, found in ((0.5, [0.75, 2.25]), (2.0, [])):
        turns = higher_order(setting_of(SPRING, EPS, gamma)).turns
        np.testing.assert_allclose(turns, found, rtol=1e-6)


def test_a_bristle_of_an_array_has_folds_of_its_own():
    """A quarter of a well on; and of many bristles one is on a fold wherever they are."""
    at = over_the_first_fold(0.5 * EPS)
    assert turns_on_folds(at).size == 0
    for offsets, found in (
        ([0.0, 0.25], []),
        ([0.0, 0.5], [1.0]),
        (np.linspace(0.01, 0.49, 40), [1.0]),
    ):
        array = (fx.effects.CompliantArray(offsets),)
        times = turns_on_folds(at._replace(scene=at.scene.replace(effects=array)))
        np.testing.assert_allclose(times, found, rtol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(("gamma", "bound"), [(0.5, False), (1.0, True)])
def test_there_it_is_none_and_elsewhere_it_is_one(gamma, bound):
    leading = SPRING.replace(effects=(fx.effects.LeadingOrder(),))
    times = times_about(SPRING, EPS)
    pair = [states_outside_slips(s, gamma, EPS, times) for s in (SPRING, leading)]
    (z, calm), (other, still) = pair
    off = np.where(calm & still, np.abs(z - other), 0.0)
    told = higher_order(setting_of(SPRING, EPS, gamma)).estimate.in_z
    assert (np.max(off) <= told) == bound
    worst = times[1][np.argmax(off)]
    assert bound or 0.75 < worst < 1.0


def force_unit(load, bend, eps, gamma):
    """Of `x' = g - t^2 + x^2` or `x' = g - |t| + x^2`, in N: what a gap is measured in."""
    if isinstance(load, fx.loads.Sine):
        turned = load.amplitude * (2 * np.pi / load.period) ** 2
        return float(eps ** (1 + gamma) * np.sqrt(turned / bend))
    pull = 4 * load.amplitude / load.period
    return float((pull * eps ** (1 + gamma) * np.sqrt(2 / bend)) ** (2 / 3))


@pytest.mark.parametrize("kind", [fx.loads.Sine, fx.loads.Triangle])
@pytest.mark.parametrize(
    ("gap", "found"), [(0.4, []), (1.0, [1.0]), (1.8, [1.0]), (3.4, [])]
)
def test_a_tip_with_much_less_force_stays_and_one_with_much_more_has_slipped(
    kind, gap, found
):
    """On either side of 1 (`t^2`) and 1.0188 (`|t|`), where the tip stays on the brink."""
    parts = fx.profiles.Sine(0.1), fx.bristles.Homothetic(1.0), fx.supports.Spring(1.0)
    eps, gamma = 2e-3, 0.5
    unit = force_unit(kind(0.1 + 50 * eps, 4.0), 0.1 * (2 * np.pi) ** 2, eps, gamma)
    load = kind(0.1 + 50 * eps + gap * unit, 4.0)
    times = turns_on_folds(setting_of(fx.Scene(*parts, load, 2.0), eps, gamma))
    np.testing.assert_allclose(times, found, rtol=1e-6)


def test_a_tip_that_drag_carries_over_its_last_folds_is_told_nothing():
    """Drag `eps^gamma l'/k` as long before the turn as `eps^gamma/k`, beside rho = 0.1."""
    parts = fx.profiles.Sine(0.1), fx.bristles.Homothetic(1.0), fx.supports.Spring(1.0)
    eps, gamma = 0.05, 0.5
    for period, found in ((3.0, [0.75]), (300.0, [])):
        load = fx.loads.Sine(0.1 + eps * 18.07, period)
        scene = fx.Scene(*parts, load, 0.5 * period)
        times = turns_on_folds(setting_of(scene, eps, gamma))
        assert times.tolist() == pytest.approx(found)


def test_what_moves_a_fold_tells_how_near_to_it_is_too_near():
    scene = over_the_first_fold(0.2 * EPS)
    assert turns_on_folds(scene).size == 0
    assert turns_on_folds(scene, 0.11 * EPS).tolist() == pytest.approx([1.0])


TWO_WAVES = fx.profiles.Fourier(cos=[0.0, 0.04 / (2 * np.pi)], sin=[0.1 / (2 * np.pi), 0.0])
BRISTLES = {
    "vertical": fx.bristles.VerticalSpring(1.0, 1.5, 1.0),
    "slanted": fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5),
    "angular": fx.bristles.AngularSpring(1.0, 1.3, 1.0, 0.2),
}


def scene_turning(kind, bristle, eps, share):
    """A scene whose load turns `share` of a well's force beyond a fold."""
    parts = TWO_WAVES, BRISTLES[bristle], fx.supports.Spring(1.0)
    still = fx.Scene(*parts, kind(1.0488, 3.0), 1.3)
    data = setting_of(still, eps, 1.0).data
    top = float(data.phase[np.argmax(data.force)])
    rho = float(fx.friction(still).rho_plus)
    wells = np.floor((1.0488 - rho) / eps - top) + top + share
    return still.replace(load=kind(rho + eps * wells, 3.0))


def seen_told_said(scene, eps, gamma):
    """Largest change outside of slips, the closed form, and whether that is no bound."""
    times = times_about(scene, eps)
    leading = scene.replace(effects=(fx.effects.LeadingOrder(),))
    pair = [states_outside_slips(s, gamma, eps, times) for s in (scene, leading)]
    (z, calm), (other, still) = pair
    told = higher_order(setting_of(scene, eps, gamma))
    seen = np.max(np.abs(z - other)[calm & still])
    return seen, told.estimate.in_z, bool(told.turns.size)


KINDS = {"sine": fx.loads.Sine, "triangle": fx.loads.Triangle}
ON_FOLDS = [
    ("sine", "vertical", 0.01, 0.5, 0.125),
    ("triangle", "vertical", 0.01, 1.0, 0.225),
    ("triangle", "vertical", 0.01, 0.5, 0.975),
    # Of two tips one slips, as what is left out moves the fold by more.
    ("sine", "vertical", 0.01, 2.0, 0.0005),
    ("triangle", "vertical", 0.01, 2.0, 0.00875),
]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "bristle", "eps", "gamma", "share"), ON_FOLDS)
def test_estimates_that_are_exceeded_are_said_to_be_no_bounds(
    kind, bristle, eps, gamma, share
):
    scene = scene_turning(KINDS[kind], bristle, eps, share)
    seen, told, said = seen_told_said(scene, eps, gamma)
    assert seen > told
    assert said
    row = fx.explain(scene, eps, gamma).effects.sel(effect="higher order")
    assert seen <= float(row.in_z) <= 10 * seen


@pytest.mark.slow
@pytest.mark.parametrize("gamma", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("eps", [0.05, 0.01, 0.002])
@pytest.mark.parametrize("bristle", BRISTLES)
@pytest.mark.parametrize("kind", KINDS)
def test_all_others_are_bounds(kind, bristle, eps, gamma):
    for share in np.linspace(0.025, 0.975, 10):
        scene = scene_turning(KINDS[kind], bristle, eps, share)
        seen, told, said = seen_told_said(scene, eps, gamma)
        assert said or seen <= told
