"""Surfaces whose steady slides, and not only their limit, have the forces asked for."""

import equinox as eqx
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.design.slide import surface_fit as slide_profile
from frictionjax.design.slide.surface_fit import SlideProfileFit
from frictionjax.design.surface.status import ProfileStatus

SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
VERTICAL = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
TARGET = fx.Target(SLANTED, 0.03, -0.025)
EPS = 1e-2
FEW = 8  # as in other files, by one program; the default is that of the docstring


@pytest.mark.parametrize("force", ["mean", pytest.param("peak", marks=pytest.mark.slow)])
def test_the_slide_has_the_forces_that_the_limit_misses(force):
    found = fx.fit_slide_profile(TARGET, EPS, force=force, harmonics=FEW)
    assert found.success
    assert found.status == ProfileStatus.MET
    assert found.fit.success
    slide = fx.steady_slide(found.profile, SLANTED, EPS)
    shown = getattr(slide, f"{force}_plus"), getattr(slide, f"{force}_minus")
    assert np.allclose(shown, [0.03, -0.025], rtol=2e-6)
    assert np.max(np.abs(found.residuals)) < 1e-6
    assert f"{force} forces [ 0.03  -0.025] N at eps = 0.01: found in" in found.message
    missed = fx.steady_slide(found.limit.profile, SLANTED, EPS)
    off = float(getattr(missed, f"{force}_plus")) / 0.03 - 1
    assert abs(off) > 5e-3
    assert float(found.limit.coefficients[0].rho_plus) == pytest.approx(0.03, rel=1e-9)


@pytest.mark.parametrize(
    ("effect", "bristles"),
    [
        (fx.effects.RigidArray([0.0, 0.0]), 1),
        (fx.effects.CompliantArray([0.0, 0.3]), 2),
        pytest.param(fx.effects.LeadingOrder(), 1, marks=pytest.mark.slow),
    ],
)
def test_the_slide_has_the_effects_of_the_scene(effect, bristles):
    """Slides of one bristle were held against the forces of two: met, and half of them."""
    effects = (effect,)
    found = fx.fit_slide_profile(TARGET, EPS, effects=effects, harmonics=4)
    assert found.success
    slide = fx.steady_slide(found.profile, SLANTED, EPS, effects=effects)
    shown = bristles * slide.mean_plus, bristles * slide.mean_minus
    assert np.allclose(shown, [0.03, -0.025], rtol=2e-6)
    assert np.allclose(found.achieved, shown, rtol=1e-12)


def test_what_slides_and_designs_do_not_know_is_named():
    rod = fx.bristles.AngularSpring(1.0, 1.4, 1.0, 0.3)
    turns = (fx.effects.NapFlip(0.01),)
    with pytest.raises(ValueError, match="steady_slide does not do NapFlip"):
        fx.fit_slide_profile(fx.Target(rod, 0.03, -0.025), EPS, effects=turns)
    with pytest.raises(TypeError, match=r"fit_slide_profile\(\) got .* 'harmonic'"):
        fx.fit_slide_profile(TARGET, EPS, harmonic=3)


@pytest.mark.slow
def test_what_no_limit_design_leads_to_says_so():
    uneven = TARGET._replace(rho_plus=0.3, rho_minus=-0.001)
    found = fx.fit_slide_profile(uneven, EPS, rate=0.05)  # with less drag than that
    assert not found.success
    assert found.status == ProfileStatus.TOO_FEW_HARMONICS
    assert "not reached; slides show [" in found.message
    assert "not reachable with this number of harmonics" in found.message
    assert np.max(np.abs(found.residuals)) > 1e-3


def test_the_picture_has_both_surfaces_and_every_design(tmp_path):
    found = fx.fit_slide_profile(TARGET, EPS, harmonics=FEW)
    figure = found.plot()
    figure.savefig(tmp_path / "slide.png")
    heights, slopes, history, forces = figure.axes
    ours, limit = slopes.get_lines()
    assert np.max(ours.get_ydata()) == pytest.approx(
        float(found.fit.coefficients[0].omega_plus), rel=1e-4
    )
    assert np.max(limit.get_ydata()) == pytest.approx(
        float(found.limit.coefficients[0].omega_plus), rel=1e-4
    )
    assert np.array_equal(history.get_lines()[0].get_ydata(), found.history)
    right, left, _ = forces.get_lines()
    assert right.get_ydata()[0] == pytest.approx(0.03, rel=1e-6)
    assert left.get_ydata()[0] == pytest.approx(0.025, rel=1e-6)
    assert len(heights.get_lines()) == 2
    assert "eps = 0.01 m" in figure.get_suptitle()


def two_targets():
    """What two bristles on one surface show, and the same with one force too large."""
    known = fx.fit_profile(TARGET).profile
    slides = [fx.steady_slide(known, part, EPS) for part in (SLANTED, VERTICAL)]
    both = [
        fx.Target(part, float(slide.mean_plus), float(slide.mean_minus))
        for part, slide in zip((SLANTED, VERTICAL), slides, strict=True)
    ]
    return both, [both[0]._replace(rho_plus=1.1 * both[0].rho_plus), both[1]]


@pytest.mark.slow
def test_targets_that_agree_are_met_by_a_slide_each():
    one, two = fx.fit_slide_profile(TARGET, EPS), fx.fit_slide_profile([TARGET] * 2, EPS)
    assert two.success
    assert two.achieved.shape == two.residuals.shape == (2, 2)
    assert len(two.slides) == len(two.bristles) == 2
    assert np.allclose(two.achieved, one.achieved[0], rtol=1e-9)


@pytest.mark.slow
def test_several_targets_are_met_or_shared_out_by_their_slides():
    both, high = two_targets()
    found = fx.fit_slide_profile(both, EPS, starts=1)
    assert found.status == ProfileStatus.MET
    assert np.max(np.abs(found.residuals)) < 1e-6
    assert found.bristles == (SLANTED, VERTICAL)
    assert found.steps == found.history.size <= 6
    torn = fx.fit_slide_profile(high, EPS, starts=1)
    assert not torn.success
    assert torn.status == ProfileStatus.CONTRADICTORY
    # Both errors of the forces to the right count alike, in slides as in coefficients.
    assert torn.residuals[0, 0] == pytest.approx(-torn.residuals[1, 0], rel=0.1)
    assert 0.04 < torn.residuals[1, 0] < 0.06


@pytest.mark.slow
def test_weights_and_uncertainties_are_those_of_the_slides_forces():
    _, (high, other) = two_targets()
    trusted = fx.fit_slide_profile([high._replace(weight=100.0), other], EPS)
    assert abs(trusted.residuals[0, 0]) < 0.02 * trusted.residuals[1, 0]
    wide = [t._replace(uncertainty=0.1 * t.rho_plus) for t in (high, other)]
    loose = fx.fit_slide_profile(wide, EPS)
    assert loose.success
    assert loose.status == ProfileStatus.WITHIN_UNCERTAINTY
    assert "differ by no more than their uncertainties explain; slides" in loose.message


def test_designs_and_slides_that_do_not_come_together_say_so(monkeypatch):
    few = slide_profile.SETTINGS._replace(designs=2)
    monkeypatch.setattr(slide_profile, "SETTINGS", few)
    found = fx.fit_slide_profile(TARGET, EPS, harmonics=FEW)
    assert found.status == ProfileStatus.NOT_SETTLED
    assert not found.success
    assert "did not settle in 2 designs; slides show [" in found.message

    real = slide_profile.steady_slide

    def lost(*args):
        slide = real(*args)
        return eqx.tree_at(lambda s: s.code_plus, slide, np.asarray(3))

    monkeypatch.setattr(slide_profile, "steady_slide", lost)
    found = fx.fit_slide_profile(TARGET, EPS, harmonics=FEW)
    assert found.status == ProfileStatus.NO_SLIDE
    assert "steady slide was not found in 1 designs" in found.message


def test_a_design_is_the_same_out_of_its_json(tmp_path):
    found = fx.fit_slide_profile(TARGET, EPS, force="peak", harmonics=FEW)
    path = tmp_path / "slide.json"
    again = SlideProfileFit.from_json(found.to_json(path))
    assert repr(again) == repr(found) == repr(SlideProfileFit.from_json(path))
    assert np.array_equal(again.profile.cos, found.profile.cos)
    assert np.array_equal(again.history, found.history)
    assert np.array_equal(again.residuals, found.residuals)
    assert again.slides[0].peak_plus == found.slides[0].peak_plus
    assert again.slides[0].ok
    assert again.fit.identifiability.rank == found.fit.identifiability.rank
    with pytest.raises(ValueError, match="source = 'another document'"):
        SlideProfileFit.from_json('{"kind": "frictionjax.ProfileFit"}')


def test_wrong_arguments_are_named():
    with pytest.raises(ValueError, match=r"targets = '\[\]': needs at least one Target"):
        fx.fit_slide_profile([], EPS)
    with pytest.raises(ValueError, match="force = 'last': needs 'mean' or 'peak'"):
        fx.fit_slide_profile(TARGET, EPS, force="last")
    with pytest.raises(ValueError, match="eps = -1: needs eps > 0"):
        fx.fit_slide_profile(TARGET, -1.0)
    with pytest.raises(ValueError, match=r"target.rho_plus = -0\.03: needs rho_plus > 0"):
        fx.fit_slide_profile(TARGET._replace(rho_plus=-0.03), EPS)


def test_targets_below_the_drag_alone_are_named():
    """eps^gamma rate/k_h = 0.02 N, twice that for two bristles of a compliant array."""
    asked = {"eps": EPS, "rate": 4.0, "support": fx.supports.Spring(2.0)}
    low = fx.Target(SLANTED, 0.03, -0.02)
    with pytest.raises(ValueError, match=r"rho_minus = -0.02: needs more than 0.02 N"):
        fx.fit_slide_profile(low, **asked)
    with pytest.raises(
        ValueError, match=r"eps.gamma rate/k_h, in peak forces: ask for more"
    ):
        fx.fit_slide_profile(low, **asked, force="peak")
    with pytest.raises(ValueError, match=r"targets\[1\].rho_minus = -0.02: needs more"):
        fx.fit_slide_profile([TARGET, low], **asked)
    two = (fx.effects.CompliantArray([0.0, 0.3]),)
    with pytest.raises(ValueError, match=r"target.rho_plus = 0.03: needs more than 0.04 N"):
        fx.fit_slide_profile(TARGET, **asked, effects=two)


@pytest.mark.parametrize("kind", ["slanted", "rod", "rigid", "compliant"])
def test_no_slide_has_less_than_its_drag(kind):
    """Of slides whose wiggles are 100 times less, and the drag once for a rigid array."""
    parts = {"rod": fx.bristles.AngularSpring(1.0, 1.4, 1.0, 0.3)}
    effects = {
        "rigid": (fx.effects.RigidArray([0.0, 0.1]),),
        "compliant": (fx.effects.CompliantArray([0.0, 0.3]),),
    }
    surface = fx.profiles.Fourier([0.0003], [0.0002])
    part, of = parts.get(kind, SLANTED), effects.get(kind, ())
    slide = fx.steady_slide(surface, part, 0.1, rate=2.0, effects=of)
    forces = slide.mean_plus, -slide.mean_minus, slide.peak_plus, -slide.peak_minus
    assert np.all(np.array(forces) >= 0.2 * (1 - 1e-9))
    assert slide.mean_plus < 0.21
