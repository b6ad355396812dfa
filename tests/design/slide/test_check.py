"""Surfaces designed for a ratio of friction show it on the dynamics."""

import numpy as np
import pytest

import frictionjax as fx

WAVES = fx.profiles.Fourier([0.0, 0.002], [0.015, 0.0])
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
    "effect",
    [
        fx.effects.CompliantArray([0.0, 0.0, 0.0]),
        pytest.param(fx.effects.CompliantArray([0.0, 0.4, 0.7]), marks=pytest.mark.slow),
        pytest.param(fx.effects.RigidArray([0.0, 0.0, 0.0]), marks=pytest.mark.slow),
    ],
    ids=["compliant", "apart", "rigid"],
)
def test_a_design_for_a_scene_is_checked_with_its_effects(effect):
    """Forces are those of all bristles, as designs ask for them."""
    effects, springs = (effect,), 3 if isinstance(effect, fx.effects.CompliantArray) else 1
    found = fx.check_design(WAVES, SLANTED, 1e-3, effects=effects)
    assert found.ok
    alone = fx.friction(WAVES, SLANTED)
    assert float(found.law.rho_plus) == pytest.approx(3 * float(alone.rho_plus), rel=1e-9)
    # Slides lag by half the drop of a slip, k_h eps/2 of each spring.
    assert abs(found.gap_plus[0]) < 0.05
    assert abs(found.gap_minus[0]) < 0.05
    slide = fx.steady_slide(WAVES, SLANTED, 1e-3, effects=effects)
    for name in ("mean_plus", "peak_plus", "mean_minus", "peak_minus"):
        one, all_of_them = getattr(slide, name), getattr(found.slide, name)[0]
        assert float(all_of_them) == pytest.approx(springs * float(one), rel=1e-12)
    assert ("all 3 bristles" in repr(found)) == (springs == 3)
