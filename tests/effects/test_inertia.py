import numpy as np
import pytest

from frictionjax.effects import Inertia, LeadingOrder, inertia_among


def test_mass_falls_with_its_power_of_eps():
    inertia = Inertia(0.02, exponent=3.0)
    eps = np.array([1.0, 0.1, 0.01])
    np.testing.assert_allclose(inertia.mass_at(eps), [0.02, 2e-5, 2e-8])
    assert float(Inertia(0.02).mass_at(0.1)) == pytest.approx(0.02)


@pytest.mark.parametrize("wrong", [0.0, -1.0, np.nan, np.inf, "heavy", [1.0, 2.0], True])
def test_a_mass_is_one_positive_number(wrong):
    with pytest.raises(ValueError, match=r"effects\.Inertia\.mass = .*mass > 0 in kg"):
        Inertia(wrong)


@pytest.mark.parametrize("wrong", [np.nan, np.inf, "one", [1.0]])
def test_an_exponent_is_one_finite_number(wrong):
    with pytest.raises(ValueError, match=r"effects\.Inertia\.exponent = .*any exponent"):
        Inertia(1.0, wrong)


def test_inertia_is_found_among_other_effects():
    inertia = Inertia(1.0)
    assert inertia_among((LeadingOrder(), inertia)) is inertia
    assert inertia_among((LeadingOrder(),)) is None
