"""Designs of bristles as JSON, and back: every part, one target and many."""

import equinox as eqx
import numpy as np
import pytest

import frictionjax as fx

WAVES = fx.profiles.Fourier(cos=[0.01, 0.004, 0.0], sin=[0.02, 0.0, -0.003])
SPLINE = fx.profiles.Spline(0.02 * np.sin(2 * np.pi * np.arange(8) / 8))
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
ANGULAR = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3)
VERTICAL = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)


def same(one, other):
    """Every number, NaN included, and the rest."""
    if isinstance(one, float | np.ndarray) or hasattr(one, "shape"):
        return np.array_equal(np.asarray(one), np.asarray(other), equal_nan=True)
    return one == other


@pytest.mark.parametrize(
    ("profile", "bristle", "wanted"),
    [
        (fx.profiles.Sine(0.1), SLANTED, {"ratio": 1.05}),
        (WAVES, SLANTED, {"ratio": np.array([1.2, 1.25, 9.0])}),
        (SPLINE, ANGULAR, {"ratio": 0.4, "bounds": (0.35, 1.2)}),
        (WAVES, VERTICAL, {"rho_plus": 0.02, "free": "stiffness"}),
    ],
)
def test_json_and_back(profile, bristle, wanted, tmp_path):
    fit = fx.fit_angle(profile, bristle, **wanted)
    path = tmp_path / "fit.json"
    text = fit.to_json(path)
    for again in (type(fit).from_json(text), type(fit).from_json(path)):
        assert again.message == fit.message
        assert np.all(again.status == fit.status)
        names = ("value", "achieved", "target", "roots", "admissible", "reachable", "free")
        assert all(same(getattr(again, name), getattr(fit, name)) for name in names)
        for name, value in vars(fit.bristle).items():
            assert same(getattr(again.bristle, name), value)
        y = np.float64(0.3)
        assert float(again.profile(y)) == pytest.approx(float(fit.profile(y)), abs=1e-16)
        for one, other in zip(again.curve(5), fit.curve(5), strict=True):
            assert same(one, other)


def test_functions_are_left_out_and_other_documents_refused():
    lean = fx.bristles.Custom(lambda eta: 0.1 * eta, lambda eta: eta)
    free = eqx.tree_at(lambda f: f.bristle, fx.fit_angle(WAVES, SLANTED, ratio=1.2), lean)
    again = type(free).from_json(free.to_json())
    assert again.bristle is None
    assert again.value == free.value
    for source, message in (
        ("{}", "source = 'another document'"),
        ('{"kind": "frictionjax.AngleFit"}', "source = 'without achieved"),
    ):
        with pytest.raises(ValueError, match=message):
            type(free).from_json(source)
