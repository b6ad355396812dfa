"""Tolerance: samples by hand, the delta method, nothing dropped in silence."""

import numpy as np
import pytest

import frictionjax as fx

SINE = fx.profiles.Sine(0.1)
WAVES = fx.profiles.Fourier(cos=[0.01, 0.004], sin=[0.02, 0.0])
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
ANGULAR = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3)


@pytest.mark.slow
def test_small_spreads_agree_with_first_order():
    spreads = {"angle": 2e-5, "height": 1e-5, "profile.sin": [1e-6, 2e-6]}
    found = fx.tolerance(WAVES, SLANTED, spreads, samples=20_000, seed=3)
    data = found.data
    law = fx.friction(WAVES, SLANTED)
    nominal = data["nominal"].sel(quantity="rho_plus")
    assert float(nominal) == pytest.approx(float(law.rho_plus), rel=1e-13)
    # The std of 20,000 samples is known to 0.5%.
    np.testing.assert_allclose(data["std"], data["first_order"], rtol=0.02)
    shifts = (data["mean"] - data["nominal"]) / data["first_order"]
    assert np.all(np.abs(shifts) < 0.03)
    scores = (data["quantiles"] - data["nominal"]) / data["first_order"]
    for row, score in zip(scores, (-1.96, -0.6745, 0.0, 0.6745, 1.96), strict=True):
        np.testing.assert_allclose(row, score, atol=0.06)
    alone = data["by_number"].values
    np.testing.assert_allclose(np.hypot.reduce(alone, axis=1), data["first_order"])
    assert data["number"].values.tolist()[2:] == ["profile.sin[0]", "profile.sin[1]"]
    assert found.inadmissible == found.flipped == 0
    assert "0.000% inadmissible" in repr(found)


def test_samples_are_the_friction_of_the_parts_drawn():
    spreads = {"rest_angle": 0.1, "profile.slope": 0.01}
    found = fx.tolerance(SINE, ANGULAR, spreads, samples=40, seed=7)
    draws = np.random.default_rng(7).standard_normal((40, 2))
    for row in (0, 17, 39):
        rest, slope = (0.3, 0.1) + np.array([0.1, 0.01]) * draws[row]
        part = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, rest)
        law = fx.friction(fx.profiles.Sine(slope), part)
        line = found.data["samples"].isel(sample=row)
        expected = (law.rho_plus, law.rho_minus, -law.rho_plus / law.rho_minus)
        np.testing.assert_allclose(line[:3], expected, rtol=1e-12)
    again = fx.tolerance(SINE, ANGULAR, spreads, samples=40, seed=7)
    np.testing.assert_array_equal(again.data["samples"], found.data["samples"])
    other = fx.tolerance(SINE, ANGULAR, spreads, samples=40, seed=8)
    assert not np.array_equal(other.data["samples"], found.data["samples"])


def test_inadmissible_and_flipped_samples_are_counted():
    # Both numbers each time, one of them without spread: one program.
    found = fx.tolerance(SINE, SLANTED, {"angle": 0.4, "height": 0.0}, samples=4000)
    draws = np.random.default_rng(0).standard_normal((4000, 2))
    angles = 1.0 + 0.4 * draws[:, 0]
    jumps = np.abs(angles) >= np.arctan(10.0)
    turned = (np.abs(angles) > np.arccos(1 / 2.4)) & ~jumps
    assert found.inadmissible == pytest.approx(jumps.mean(), abs=1e-12)
    assert found.flipped == pytest.approx(turned.mean(), abs=1e-12)
    assert 0.1 < found.inadmissible < 0.4
    lost = np.isnan(found.data["samples"].sel(quantity="ratio"))
    np.testing.assert_array_equal(lost, jumps)
    assert f"{jumps.mean():.3%} inadmissible" in repr(found)
    assert "pull on the surface, alpha < 0" in repr(found)
    # A length below 0 has formulas, but no bristle.
    short = fx.tolerance(SINE, SLANTED, {"angle": 0.0, "height": 0.5}, samples=4000)
    heights = 1.0 + 0.5 * draws[:, 1]
    assert short.inadmissible == pytest.approx(np.mean(heights <= 0), abs=1e-12)


def test_numbers_have_meanings_and_units():
    data = fx.tolerance(WAVES, SLANTED, {"angle": 0.01}, samples=10).data
    assert all("long_name" in data[name].attrs for name in data.data_vars)
    units = dict(zip(data["quantity"].values, data.unit.values, strict=True))
    assert units == {"rho_plus": "N", "rho_minus": "N", "ratio": "1", "difference": "N"}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"spreads": {}}, "spreads = 'no name': needs standard deviations by name"),
        ({"spreads": {"colour": 0.1}}, "spreads = 'colour': needs one of stiffness"),
        ({"spreads": {"profile.hue": 0.1}}, "spreads of the profile = 'hue': needs one of"),
        ({"spreads": {"angle": -0.1}}, r"spreads\['angle'\] = -0.1: needs finite"),
        ({"spreads": {"angle": float("nan")}}, r"spreads\['angle'\] = nan: needs finite"),
        ({"spreads": {"angle": [0.1, 0.2]}}, r"spreads\['angle'\] = .*needs one number"),
        ({"spreads": {"profile.sin": [1e-4] * 3}}, r"spreads\['profile.sin'\].* or 2"),
        ({"spreads": {"angle": 0.0}}, "spreads = 'all 0'"),
        ({"samples": 1}, "samples = 1: needs a whole number"),
        ({"quantiles": [1.5]}, r"quantiles = \[1.5\]: needs numbers in"),
        ({"bristle": fx.bristles.SlantedSpring(1.0, 9.0, 1.0, 1.48)}, "bristle.angle"),
        ({"gamma": 0.5}, "gamma = 0.5: needs eps beside it"),
    ],
)
def test_wrong_arguments_are_named(change, words):
    given = {"profile": WAVES, "bristle": SLANTED, "spreads": {"angle": 0.1}} | change
    with pytest.raises(ValueError, match=words):
        fx.tolerance(**given)


@pytest.mark.slow  # derivatives of slides
def test_slides_at_an_eps_spread_with_the_numbers():
    profile, bristle = fx.profiles.Sine(0.1), fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    spreads = {"profile.slope": 0.01}
    found = fx.tolerance(profile, bristle, spreads, samples=16, seed=3, eps=1e-2)
    data = found.data
    alone = fx.steady_slide(profile, bristle, 1e-2)
    for name in data.force.values:
        nominal = float(data.slide_nominal.sel(force=name))
        assert nominal == pytest.approx(float(getattr(alone, name)), rel=1e-7)
    samples = data.slide_samples.values
    np.testing.assert_allclose(data.slide_mean, samples.mean(axis=0))
    np.testing.assert_allclose(data.slide_std, samples.std(axis=0, ddof=1))
    # At this eps slides feel the slope nearly as the limit does: the same draws.
    limit = data.samples.sel(quantity="rho_plus").values
    assert np.corrcoef(samples[:, 0], limit)[0, 1] > 0.999
    assert np.all(data.status == int(fx.Status.OK))
    assert "Steady slides at eps = 0.01 m, 0 without one" in repr(found)
    assert all("long_name" in data[name].attrs for name in data.data_vars)
    assert data.slide_std.units == data.slide_samples.units == "N"
    assert "slide_mean" not in fx.tolerance(profile, bristle, spreads, samples=10).data
