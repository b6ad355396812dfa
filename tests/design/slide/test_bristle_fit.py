"""Designs at finite eps: the slide itself has the friction asked for."""

import dataclasses

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.design.bristle.status import FitStatus
from frictionjax.design.slide import bristle_fit as slide_fit
from frictionjax.design.slide.bristle_fit import SlideFit
from frictionjax.design.slide.slide_friction import SteadySlide

WAVES = fx.profiles.Fourier(cos=[0.004, 0.002], sin=[0.015, -0.003])
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
EPS = 1e-2


def ratio_of(slide, force):
    return float(-getattr(slide, f"{force}_plus") / getattr(slide, f"{force}_minus"))


def leaning(angle):
    return fx.bristles.SlantedSpring(1.0, 2.4, 1.0, float(angle))


@pytest.mark.slow
@pytest.mark.parametrize("force", ["mean", "peak"])
def test_the_slide_has_the_ratio_that_the_limit_misses(force):
    found = fx.fit_slide(WAVES, SLANTED, EPS, ratio=1.25, force=force)
    assert found.success
    assert found.status == FitStatus.OK
    slide = fx.steady_slide(WAVES, found.bristle, EPS)
    assert ratio_of(slide, force) == pytest.approx(1.25, rel=1e-9)
    assert float(found.achieved) == pytest.approx(1.25, rel=1e-9)
    assert np.min(np.abs(found.solutions - found.value)) == 0
    limit = fx.fit_angle(WAVES, SLANTED, ratio=1.25)
    assert found.limit.value == limit.value
    missed = fx.steady_slide(WAVES, limit.bristle, EPS)
    assert abs(ratio_of(missed, force) / 1.25 - 1) > 1e-3
    shown = [
        ratio_of(fx.steady_slide(WAVES, leaning(found.value + s * 1e-3), EPS), force)
        for s in (1, -1, 2, -2)
    ]
    slope = (8 * (shown[0] - shown[1]) - (shown[2] - shown[3])) / (12 * 1e-3)
    assert float(found.by_target) == pytest.approx(1 / slope, rel=1e-5)
    asked = f"ratio = 1.25 of {force} forces at eps = 0.01: found, angle = "
    assert asked in found.message
    again = SlideFit.from_json(found.to_json())
    assert repr(again) == repr(found)
    assert again.by_target == found.by_target
    assert np.array_equal(again.solutions, found.solutions)
    far = fx.fit_slide(WAVES, SLANTED, EPS, ratio=1.6, bounds=(0.2, 1.1), force=force)
    assert far.status == FitStatus.UNREACHABLE
    assert not far.success
    assert "cannot be reached by angle: steady slides show (" in far.message


def test_wrong_arguments_are_named():
    with pytest.raises(ValueError, match="eps = 0: needs eps > 0"):
        fx.fit_slide(WAVES, SLANTED, 0.0, ratio=1.2)
    with pytest.raises(ValueError, match="force = 'last': needs 'mean' or 'peak'"):
        fx.fit_slide(WAVES, SLANTED, EPS, force="last", ratio=1.2)
    with pytest.raises(ValueError, match="support = 'float': needs"):
        fx.fit_slide(WAVES, SLANTED, EPS, support=1.0, ratio=1.2)
    with pytest.raises(ValueError, match="targets = 'none'"):
        fx.fit_slide(WAVES, SLANTED, EPS)
    with pytest.raises(ValueError, match=r"ratio = \[1.  1.2\]: needs one number"):
        fx.fit_slide(WAVES, SLANTED, EPS, ratio=[1.0, 1.2])
    two = (fx.effects.RigidArray([0.0, 0.0]),)
    with pytest.raises(ValueError, match=r"effects = .*RigidArray.*: needs none: of an"):
        fx.fit_slide(WAVES, SLANTED, EPS, rho_plus=0.1, effects=two)
    with pytest.raises(TypeError, match=r"fit_slide\(\) got an unexpected .* 'ration'"):
        fx.fit_slide(WAVES, SLANTED, EPS, ration=1.2)


ROUND = fx.profiles.Sine(0.1)


@pytest.mark.slow
def test_a_largest_force_between_the_nodes_is_reached():
    """33 even nodes show 0.154361 at most, where 0.1543857 is there."""
    ends = {"bounds": (0.0, 1.1)}
    found = fx.fit_slide(ROUND, SLANTED, EPS, rho_plus=0.154373, **ends)
    assert found.status == FitStatus.OK
    assert found.solutions.size == 2
    for angle in found.solutions:
        slide = fx.steady_slide(ROUND, leaning(angle), EPS)
        assert float(slide.mean_plus) == pytest.approx(0.154373, rel=1e-12)
    most = float(found.reachable[0, 1])
    assert most == pytest.approx(0.15438566, rel=1e-7)
    touched = fx.fit_slide(ROUND, SLANTED, EPS, rho_plus=most, **ends)
    assert touched.status == FitStatus.TANGENT
    assert touched.success
    assert np.isinf(touched.by_target)
    beyond = fx.fit_slide(ROUND, SLANTED, EPS, rho_plus=most * (1 + 1e-6), **ends)
    assert beyond.status == FitStatus.UNREACHABLE
    # Forces grow to a pole of the angle, which no slide was found next to.
    pull = {"bounds": (-1.5, -1.2), "pulling": True}
    pole = fx.fit_slide(ROUND, SLANTED, EPS, rho_plus=1e9, **pull)
    assert pole.status == FitStatus.UNKNOWN


def test_slides_that_were_not_computed_are_not_unreachable(monkeypatch):
    """The scan made by hand: what it could not evaluate leaves the answer open."""
    ends = (0.2, 1.1)
    one = np.ones(())
    known = SteadySlide(np.asarray(EPS), one, -one, one, -one, 0 * one, 0 * one)

    def shown(x):
        return 1.0 + 0.3 * x

    def fit(lost, ratio, follows=True, slide=known):
        def quantities(free, bristle, profile, asked, places):
            return np.where(np.abs(places - 0.7) < 0.2 * lost, np.nan, shown(places))

        def alone(free, bristle, profile, asked, x):
            return slide_fit._Slide(shown(x), 0.3 * one, one, x, slide)

        def sliding(free, bristle, profile, places, eps):
            return np.full(places.size, follows)

        monkeypatch.setattr(slide_fit, "_quantities", quantities)
        monkeypatch.setattr(slide_fit, "_alone", alone)
        monkeypatch.setattr(slide_fit, "_follows", sliding)
        return fx.fit_slide(WAVES, SLANTED, EPS, ratio=ratio, bounds=ends)

    found = fit(1, 1.6)
    assert found.status == FitStatus.UNKNOWN
    assert not found.success
    assert np.all(np.abs(found.failed - 0.7) < 0.2)
    assert (
        f"{found.failed.size} slides were not computed, the first at angle" in found.message
    )
    assert "others show (1.06" in found.message
    assert fit(0, 1.6).status == FitStatus.UNREACHABLE
    assert fit(0, 1.6).failed.size == 0
    assert fit(1, 1.1).status == FitStatus.OK  # found on what is known
    failing = dataclasses.replace(known, code_plus=one)
    unsure = fit(0, 1.1, slide=failing)  # a crossing whose own slide is not found
    assert unsure.status == FitStatus.UNKNOWN
    assert unsure.solutions.size == 0
    np.testing.assert_allclose(unsure.failed, 1 / 3, rtol=1e-12)
    again = SlideFit.from_json(fit(1, 1.6).to_json())
    assert again.status == FitStatus.UNKNOWN
    assert again.message == found.message
    assert again.limit.message == found.limit.message
    exact = 1.0 + 0.3 * float(found.failed[0])
    assert fit(0, exact).status == FitStatus.OK  # a value of the scan itself
    nothing = fit(9, 1.6)
    assert nothing.status == FitStatus.UNKNOWN
    assert nothing.reachable.shape == (0, 2)
    assert "no other is known" in nothing.message
    with pytest.raises(ValueError, match=r"eps = 0.01: needs an eps at which some bristle"):
        fit(9, 1.6, follows=False)


def test_of_several_solutions_one_that_rubs_is_taken(monkeypatch):
    """The bristle stops pressing at arccos(1/2.4) = 1.14102: 1.1405 is nearer to it."""
    one = np.ones(())
    known = SteadySlide(np.asarray(EPS), one, -one, one, -one, 0 * one, 0 * one)

    def fit(other):
        def shown(x):
            return 1.0 + (x - 0.9) * (x - other)

        def quantities(free, bristle, profile, asked, places):
            return shown(places)

        def alone(free, bristle, profile, asked, x):
            return slide_fit._Slide(shown(x), 2 * x - 0.9 - other, one, x, known)

        monkeypatch.setattr(slide_fit, "_quantities", quantities)
        monkeypatch.setattr(slide_fit, "_alone", alone)
        return fx.fit_slide(WAVES, leaning(1.1), EPS, ratio=1.0, bounds=(0.2, 1.2))

    found = fit(1.1405)
    np.testing.assert_allclose(found.solutions, [0.9, 1.1405], rtol=1e-9)
    assert found.value == pytest.approx(0.9)
    assert "angle = 0.9 (2 solutions)" in found.message
    assert fit(1.08).value == pytest.approx(1.08)  # presses: the nearest


def test_a_bristle_that_pulls_part_of_a_period_is_no_solution(monkeypatch):
    """At 1.141 alpha is 2.6e-4 N, and F' + F'' eps w is below 0 in the valleys."""
    waves = fx.profiles.Fourier([0.004, -0.0013], [-0.011, 0.0021])
    one = np.ones(())
    known = SteadySlide(np.asarray(EPS), one, -one, one, -one, 0 * one, 0 * one)

    def fit(root):
        def quantities(free, bristle, profile, asked, places):
            return places - root

        def alone(free, bristle, profile, asked, x):
            return slide_fit._Slide(x - root, one, one, x, known)

        monkeypatch.setattr(slide_fit, "_quantities", quantities)
        monkeypatch.setattr(slide_fit, "_alone", alone)
        return fx.fit_slide(waves, SLANTED, EPS, difference=0.0)

    almost = fx.friction(waves, leaning(1.141))
    assert 0 < almost.alpha < 3e-4
    found = fit(1.141)
    assert found.status == FitStatus.UNREACHABLE
    assert found.solutions.size == 0
    assert "cannot be reached by angle" in found.message
    assert "in the limit: difference = 0 is reached only by a bristle that" in found.message
    presses = fit(1.139)
    assert presses.status == FitStatus.OK
    assert presses.value == pytest.approx(1.139, rel=1e-12)
    assert "reached only by a bristle that pulls" in presses.message


def test_a_slide_of_drag_alone_has_no_ratio_of_its_own(monkeypatch):
    """Next to alpha = 0 signs of rounding change, and a slide's forces are eps rate/k_h."""
    one = np.ones(())

    def fit(root, force):
        known = SteadySlide(np.asarray(1e-3), force, -force, one, -one, 0 * one, 0 * one)

        def quantities(free, bristle, profile, asked, places):
            return 1 + places - root

        def alone(free, bristle, profile, asked, x):
            return slide_fit._Slide(1 + x - root, one, one, x, known)

        monkeypatch.setattr(slide_fit, "_quantities", quantities)
        monkeypatch.setattr(slide_fit, "_alone", alone)
        return fx.fit_slide(WAVES, SLANTED, 1e-3, ratio=1.0, bounds=(0.2, 1.4))

    drag = 1e-3 * one
    assert fit(1.141, 1.03 * drag).status == FitStatus.UNREACHABLE
    assert fit(1.141, 3 * drag).status == FitStatus.OK  # more than drag
    assert fit(0.9, 1.03 * drag).status == FitStatus.OK  # presses: drag is large there
