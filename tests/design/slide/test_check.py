"""Surfaces designed for a ratio of friction show it on the dynamics."""

import numpy as np
import pytest

import frictionjax as fx

HOMOTHETIC = fx.bristles.Homothetic(1.0)
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
EPS, WAIT, SLIPS = 1e-4, 30, 10


def mean_force(profile, bristle, side):
    """Of ten slips after thirty, under a ramp of 1 N/s, from what `solve` dissipates."""
    law = fx.friction(profile, bristle)
    begin = max(float(law.rho_plus), -float(law.rho_minus)) + WAIT * EPS
    ts = begin + EPS * np.array([0.0, SLIPS])
    ramp = fx.loads.Ramp(float(side))
    scene = fx.Scene(profile, bristle, fx.supports.Spring(1.0), ramp, duration=ts[-1])
    found = fx.solve(scene, EPS, 1.0, ts=ts, accuracy=1e-4)
    assert found.ok
    return side * float(np.diff(found.dissipation)[0] / abs(np.diff(found.z)[0]))


@pytest.mark.slow
@pytest.mark.parametrize("bristle", [HOMOTHETIC, SLANTED], ids=["homothetic", "slanted"])
@pytest.mark.parametrize("ratio", [1.5, 3.0, 8.0])
def test_a_designed_ratio_is_simulated_within_a_percent(bristle, ratio):
    fit = fx.fit_profile(fx.Target(bristle, 0.1 * ratio, -0.1))
    assert fit.success
    forces = [mean_force(fit.profile, bristle, side) for side in (1, -1)]
    assert -forces[0] / forces[1] == pytest.approx(ratio, rel=1e-2)
    # Ratio 8: a plateau of nearly equal folds, 1196 steps where 1024 had room.
    slide = fx.steady_slide(fit.profile, bristle, EPS)
    assert slide.ok
    np.testing.assert_allclose((slide.mean_plus, slide.mean_minus), forces, rtol=1e-3)


@pytest.mark.parametrize(
    ("effect", "bristles"),
    [
        (fx.effects.CompliantArray([0.0, 0.4, 0.7]), 3),
        (fx.effects.RigidArray([0.0, 0.0]), 2),
    ],
    ids=["compliant", "rigid"],
)
def test_a_design_for_a_scene_is_checked_with_its_effects(effect, bristles):
    effects = (effect,)
    target = fx.Target(SLANTED, 0.12, -0.1)
    fit = fx.fit_profile(target, harmonics=4, effects=effects)
    found = fx.check_design(fit.profile, SLANTED, 1e-3, effects=effects)
    assert found.ok
    law = float(found.law.rho_plus), float(found.law.rho_minus)
    np.testing.assert_allclose(law, [0.12, -0.1], rtol=1e-6)
    # Slides lag by half the drop of a slip, k_h eps/2 of each spring.
    assert abs(found.gap_plus[0]) < 0.05
    assert abs(found.gap_minus[0]) < 0.05
    slide = fx.steady_slide(fit.profile, SLANTED, 1e-3, effects=effects)
    springs = bristles if isinstance(effect, fx.effects.CompliantArray) else 1
    assert float(found.slide.mean_plus[0]) == pytest.approx(
        springs * float(slide.mean_plus), rel=1e-12
    )
    assert ("all 3 bristles" in repr(found)) == (springs == 3)
