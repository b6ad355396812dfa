"""Coefficients as tables: every number in its column, nothing dropped."""

import jax
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.coefficients import (
    coefficient_table,
    coefficients_by_name,
    errors_by_name,
    with_errors,
)

SURFACE = fx.profiles.Sine(0.1)
BRISTLE = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
LAW = fx.friction(SURFACE, BRISTLE)


def test_coefficients():
    text = str(coefficient_table(LAW))
    lines = {line.split()[0]: line.split()[1:] for line in text.splitlines()}
    assert float(lines["rho_plus"][0]) == pytest.approx(float(LAW.rho_plus), rel=1e-5)
    assert lines["rho_plus"][1] == "N"
    assert float(lines["ratio"][0]) == pytest.approx(
        float(-LAW.rho_plus / LAW.rho_minus), rel=1e-5
    )
    assert float(lines["normal_minus"][0]) == pytest.approx(float(LAW.normal_minus), 1e-5)
    assert " ".join(lines["alpha"][2:]) == "normal force without friction"
    assert len(lines) == 12


def test_the_ratio_of_the_table_is_an_attribute_too():
    assert float(LAW.ratio) == coefficients_by_name(LAW)["ratio"]
    many = jax.vmap(lambda s: fx.friction(fx.profiles.Sine(s), BRISTLE))(
        np.array([0.1, 0.2])
    )
    np.testing.assert_allclose(many.ratio, -many.rho_plus / many.rho_minus)
    none = type(LAW)(rho_plus=np.zeros(()), rho_minus=np.zeros(()))
    assert np.isnan(none.ratio)
    assert "ratio" not in coefficients_by_name(none)


def test_coefficients_with_errors():
    text = str(coefficient_table(LAW, dict.fromkeys(coefficients_by_name(LAW), 0.0123)))
    lines = {line.split()[0]: line.split()[1:] for line in text.splitlines()}
    assert lines["rho_plus"][1:3] == ["0.012", "N"]
    assert lines["alpha"][1] == "N"  # the bristle's own


def test_the_abstract_setting_has_two_coefficients():
    bare = coefficients_by_name(type(LAW)(rho_plus=LAW.rho_plus, rho_minus=LAW.rho_minus))
    assert list(bare) == ["rho_plus", "rho_minus", "ratio"]


def test_of_two_errors_the_larger_is_shown():
    found = with_errors(LAW, np.float64(0.01), np.float64(0.02))
    standard = dict.fromkeys(coefficients_by_name(LAW), 0.015)
    errors = errors_by_name(found, standard)
    assert errors["omega_plus"] == 0.015
    assert errors["omega_minus"] == 0.02
    assert errors_by_name(LAW, standard) == standard


def test_where_a_bristle_pulls_the_sides_of_normal_forces_are_named():
    surface = fx.profiles.Fourier([0.0, 0.004], [0.02, 0.0])
    for alpha, right, left in ((2.0, "plus", "minus"), (-2.0, "minus", "plus")):
        law = fx.friction(surface, fx.bristles.Homothetic(alpha))
        assert law.rho_plus / law.normal_plus == pytest.approx(
            float(getattr(law, f"omega_{right}"))
        )
        lines = {line.split()[0]: line for line in str(coefficient_table(law)).splitlines()}
        named = alpha < 0
        assert lines[f"omega_{right}"].endswith("of a slide to the right") == named
        assert lines[f"omega_{left}"].endswith("of a slide to the left") == named


def test_they_show_themselves():
    assert str(LAW.table()) == str(coefficient_table(LAW))
    assert "<td" in LAW._repr_html_()
    assert "friction against motion to the right" in LAW._repr_html_()
    assert LAW.table().to_csv().splitlines()[1].startswith("rho_plus,0.120")


def test_a_batch_is_no_table_and_says_so():
    angles = np.array([0.5, 1.0])
    batch = jax.vmap(lambda a: fx.friction(SURFACE, BRISTLE.replace(angle=a)))(angles)
    with pytest.raises(ValueError, match="those of one scene, not of a batch"):
        batch.table()
    assert batch._repr_html_().startswith("<pre>Coefficients(batch (2,)")
