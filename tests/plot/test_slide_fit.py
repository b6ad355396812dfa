"""A design on slides is drawn at its eps, over the limit's curve."""

import numpy as np
import pytest

import frictionjax as fx

SURFACE = fx.profiles.Sine(0.1)
BRISTLE = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)


@pytest.mark.slow
def test_solutions_lie_at_what_was_wanted_and_the_limit_beside_them():
    fit = fx.fit_slide(SURFACE, BRISTLE, 0.02, ratio=1.3)
    (axes,) = fit.plot().axes
    dots = [line for line in axes.lines if line.get_marker() == "o"]
    places = np.concatenate([line.get_xdata() for line in dots])
    assert np.sort(places) == pytest.approx(np.asarray(fit.solutions))
    for line in dots:
        assert line.get_ydata() == pytest.approx(1.3, rel=1e-6)
    curve = axes.lines[0]
    assert curve.get_label().startswith("limit")
    (chosen,) = (one for one in dots if one.get_markerfacecolor() != "white")
    assert chosen.get_label().startswith("slide, $\\epsilon$ = 0.02 m: angle = ")
    across = np.interp(1.3, curve.get_ydata(), curve.get_xdata())
    assert across == pytest.approx(float(fit.limit.value), rel=1e-3)
    assert abs(across - float(fit.value)) > 0.01
