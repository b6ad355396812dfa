"""With and against the nap: coefficients, forces along the rod, loads that turn it over."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.report.nap_page import verdict_of_nap
from frictionjax.turning import axial_force

ROD = fx.bristles.AngularSpring(2.0, 0.07, 0.05, 0.3)
SURFACE = fx.profiles.Fourier([0.004, 0.0], [0.015, 0.003])


def mirror(profile, bristle):
    """The same scene seen from behind: the rod turned over stands in it as this one."""
    seen = fx.profiles.Fourier(profile.cos, -profile.sin)
    numbers = bristle.stiffness, bristle.length, bristle.height, -bristle.rest_angle
    return seen, fx.bristles.AngularSpring(*numbers)


def test_coefficients_are_those_of_the_corrected_formulas():
    found, law = fx.nap(SURFACE, ROD), fx.friction(SURFACE, ROD)
    limit, reach = np.arccos(0.05 / 0.07), np.sqrt(0.07**2 - 0.05**2)

    def slide(rest, omega):  # the paper's, with k/h: k in N m/rad
        return 2.0 * (limit - rest) / reach * omega / (1 + omega * 0.05 / reach)

    plus, minus = float(law.omega_plus), float(law.omega_minus)
    assert found.rho_with == pytest.approx(slide(0.3, plus), rel=1e-12)
    assert found.rho_against == pytest.approx(-slide(0.3, minus), rel=1e-12)
    assert found.rho_flipped == pytest.approx(slide(-0.3, -minus), rel=1e-12)
    assert found.ratio == found.rho_against / found.rho_with


def test_the_rod_turned_over_is_the_one_in_a_mirror():
    found, other = fx.nap(SURFACE, ROD), fx.nap(*mirror(SURFACE, ROD))
    assert found.rho_flipped == pytest.approx(other.rho_with, rel=1e-12)
    assert found.axial_flipped == pytest.approx(other.axial_with, rel=1e-12)
    assert found.flipped.axial_against == pytest.approx(other.axial_against, rel=1e-12)
    assert other.rho_flipped == pytest.approx(found.rho_with, rel=1e-12)


def test_the_axial_force_is_the_paper_s():
    found, law = fx.nap(SURFACE, ROD), fx.friction(SURFACE, ROD)
    limit = float(ROD.limit_angle)
    for axial, rho in (
        (found.axial_with, law.rho_plus),
        (found.axial_against, law.rho_minus),
    ):
        pressed = -2.0 / 0.07 * (limit - 0.3) / np.tan(limit)
        assert axial == pytest.approx(float(pressed + rho / np.sin(limit)), rel=1e-12)


def test_rods_are_never_pulled():
    """The paper has rods under traction turn over; none that clears its surface is."""
    rng = np.random.default_rng(3)
    limit = rng.uniform(0.05, 1.5, 20_000)
    rest = rng.uniform(-np.pi / 2, limit)
    top = 1 / np.tan(limit)
    omega = rng.uniform(-np.minimum(np.tan(limit), 10), np.minimum(top, 10))
    normal = (limit - rest) / (1 + omega * top)
    axial = axial_force(normal, omega * normal, limit)
    assert np.max(axial / normal) < 0


@pytest.mark.parametrize("rest", [0.05, -0.05, 0.3, -0.3])
@pytest.mark.parametrize("omega", [0.02, 0.1, 0.3, 0.6])
def test_the_window_of_an_even_surface_is_the_closed_form(rest, omega):
    rod = fx.bristles.AngularSpring(1.0, 1 / np.cos(0.7), 1.0, rest)
    found = fx.nap(fx.profiles.Sine(omega), rod)
    springs = (0.7 + abs(rest)) / (0.7 - abs(rest))
    cot, tan = 1 / np.tan(0.7), np.tan(0.7)
    slopes = (1 + omega * cot) * (1 + omega * tan) / (1 - omega * cot) / (1 - omega * tan)
    assert (found.window is not None) == (springs < slopes)


def test_loads_of_the_window_turn_it_over_and_others_do_not():
    surface = fx.profiles.Sine(0.5)
    rod = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3)
    window = fx.nap(surface, rod).window
    assert -fx.nap(surface, rod).axial_flipped == window.least
    assert -fx.nap(surface, rod).axial_against == window.greatest

    def told(load):
        return fx.nap(surface, rod, load * 2 / np.pi**2)

    inside = told(0.5 * sum(window))
    assert inside.critical_load == pytest.approx(0.5 * sum(window), rel=1e-12)
    assert "it turns over, and friction is rho_with and rho_flipped" in inside.message
    assert "it stays as it stands" in told(1.001 * window.greatest).message
    assert "again once turned over" in told(0.999 * window.least).message
    assert "buckles with the nap too" in told(-inside.axial_with).message


def test_the_ratio_of_a_rod_that_turns_over_is_that_it_has():
    """Against its nap it never slides; rows of the table are named where friction is."""
    surface = fx.profiles.Sine(0.5)
    rod = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3)
    turns = repr(fx.nap(surface, rod, 0.1))
    assert "against/with = 3 if it kept its nap, turned over/with = 2.2361\n" in turns
    assert turns.endswith("rho_with and rho_flipped (with the nap, and turned over)")
    assert "against/with = 3\n" in repr(fx.nap(surface, rod, 0.5))


def test_a_rod_that_leans_back_at_rest_turns_over_and_never_back():
    """Its spring is slack once turned over: pressed less than before."""
    rod = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, -0.3)
    found = fx.nap(fx.profiles.Sine(0.1), rod)
    assert found.window is None
    assert found.rho_flipped < found.rho_against
    between = 0.5 * (-found.axial_against - found.flipped.axial_against)
    told = fx.nap(fx.profiles.Sine(0.1), rod, between * 2 / np.pi**2)
    assert "never back" in told.message


def test_what_cannot_turn_over_says_why():
    slanted = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
    found = fx.nap(SURFACE, slanted)
    assert found.window is None
    assert np.isnan(found.axial_flipped)
    assert "AngularSpring" in found.message
    back = fx.nap(SURFACE, fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, -0.9))
    assert "would not press" in back.message
    # arctan of the slopes: 0.79 and -0.49; of the mirrored surface 0.49 and -0.79
    steep = fx.profiles.Fourier([0.0, 0.0], [-0.12, 0.02])
    law = fx.friction(steep, fx.bristles.VerticalSpring(1.0, 2.0, 1.0))
    high = np.arctan(float(law.omega_plus)), np.arctan(-float(law.omega_minus))
    assert high[0] > high[1]
    rod = fx.bristles.AngularSpring(1.0, 1 / np.cos(sum(high) / 2), 1.0, 0.1)
    assert "would not clear" in fx.nap(steep, rod).message


def test_a_bristle_that_leans_the_other_way_has_its_nap_the_other_way():
    right = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
    left = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, -1.0)
    seen, _ = mirror(SURFACE, ROD)
    one, other = fx.nap(SURFACE, right), fx.nap(seen, left)
    assert one.rho_with == pytest.approx(float(fx.friction(SURFACE, right).rho_plus))
    for name in ("rho_with", "rho_against", "axial_with", "axial_against"):
        assert getattr(other, name) == pytest.approx(getattr(one, name), rel=1e-9)


def test_without_a_nap():
    upright = fx.nap(SURFACE, fx.bristles.VerticalSpring(1.0, 2.0, 1.0))
    assert "stands upright" in upright.message
    assert upright.axial_with == upright.axial_against == -1.0
    found = fx.nap(SURFACE, fx.bristles.Homothetic(1.0))
    assert "no geometry" in found.message
    assert np.isnan(found.axial_with)
    assert not found.knows_nap
    assert upright.knows_nap
    printed, law = repr(found), fx.friction(SURFACE, fx.bristles.Homothetic(1.0))
    assert found.rho_with == pytest.approx(float(law.rho_plus))
    for words in ("to the right", "to the left", f"left/right = {found.ratio:.6g}"):
        assert words in printed
    assert "with the nap" not in printed
    assert "against/with" in repr(upright)
    (axes,) = found.plot().axes
    assert axes.get_title(loc="left").startswith("To the right and to the left: left/right")
    assert "\\rho_{right}" in axes.texts[0].get_text()
    assert verdict_of_nap(found).startswith("Moved to the right the bristle holds against")


def test_arguments_are_named():
    with pytest.raises(ValueError, match=r"bending_stiffness = -1: needs .* > 0"):
        fx.nap(SURFACE, ROD, -1.0)
    with pytest.raises(ValueError, match="bending_stiffness = 1: needs None"):
        fx.nap(SURFACE, fx.bristles.VerticalSpring(1.0, 2.0, 1.0), 1.0)
    with pytest.raises(ValueError, match="profile"):
        fx.nap(0.1, ROD)
