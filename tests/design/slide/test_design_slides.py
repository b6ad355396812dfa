"""Slides of many designs at once: each as `steady_slide` finds it alone."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.design.slide.design_slides import (
    MEANINGS,
    slide_numbers,
    slides_of_designs,
)
from frictionjax.model import BristlePotential

NUMBERS = slide_numbers(1e-2, 1.0, 2.0, fx.supports.Spring(0.5))
ANGULAR = fx.bristles.AngularSpring(1.0, 1.5, 1.0, 0.2)
DESIGNS = [
    (fx.profiles.Sine(0.1), fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)),
    (fx.profiles.Fourier([0.01, 0.003], [0.012, 0.0]), ANGULAR),
    (fx.profiles.Sine(0.2), ANGULAR),
]


@pytest.fixture(scope="module")
def found():
    designs = [BristlePotential(*parts) for parts in DESIGNS]
    return slides_of_designs([designs[0], None, *designs[1:]], NUMBERS)


# Each alone takes a program of its own to compile.
ALONE = [(2, DESIGNS[1])]
ALONE += [pytest.param(n, DESIGNS[i], marks=pytest.mark.slow) for n, i in ((0, 0), (3, 2))]


@pytest.mark.parametrize(("place", "design"), ALONE)
def test_each_is_as_it_is_alone(found, place, design):
    alone = fx.steady_slide(*design, 1e-2, 1.0, 2.0, fx.supports.Spring(0.5))
    assert found.status[place] == fx.Status.OK
    for name in MEANINGS:
        value = float(getattr(alone, name))
        assert found.forces[name][place] == pytest.approx(value, rel=1e-7), name


def test_no_design_has_no_slide(found):
    assert found.status[1] == fx.Status.NOT_TRIED
    assert all(np.isnan(forces[1]) for forces in found.forces.values())


def test_bristles_without_contact_are_not_tried():
    # Longer than high by 5%: at eps = 1 hills reach higher than that.
    lying = fx.bristles.AngularSpring(1.0, 1.05, 1.0, 0.04)
    flat = BristlePotential(fx.profiles.Sine(0.3), lying)
    with pytest.raises(ValueError, match="eps"):
        fx.steady_slide(flat.profile, flat.bristle, 1.0)
    numbers = slide_numbers(1.0, 1.0, 1.0, None)
    assert slides_of_designs([flat], numbers).status[0] == fx.Status.NOT_TRIED


def test_numbers_are_checked():
    with pytest.raises(ValueError, match="rate = 0: needs rate > 0"):
        slide_numbers(1e-2, 1.0, 0.0, None)
    with pytest.raises(ValueError, match="eps = -1: needs eps > 0"):
        slide_numbers(-1.0, 1.0, 1.0, None)
