"""Slides are drawn where they were found, from their means to their peaks."""

import numpy as np
import pytest

from frictionjax.design.slide.slide_friction import SteadySlide

EPS = np.array([0.1, 0.001, 0.01])
FOUND = {"mean_plus": [0.1, 0.12, 0.11], "mean_minus": [-0.07, -0.09, -0.08]}
FOUND |= {"peak_plus": [0.2, 0.14, 0.16], "peak_minus": [-0.2, -0.1, -0.15]}
SLIDE = SteadySlide(
    eps=EPS,
    **{name: np.array(values) for name, values in FOUND.items()},
    code_plus=np.array([0, 0, 3]),
    code_minus=np.array([0, 0, 0]),
)


def test_points_are_means_and_lines_reach_to_the_peaks():
    (axes,) = SLIDE.plot().axes
    right, left = axes.lines[:2]
    assert right.get_xdata() == pytest.approx([0.001, 0.1])
    assert right.get_ydata() == pytest.approx([0.12, 0.1])
    assert left.get_ydata() == pytest.approx([-0.09, -0.07])
    ends = [sorted(part[:, 1]) for part in axes.collections[0].get_segments()]
    assert ends == [[0.12, 0.14], [0.1, 0.2]]
    assert axes.get_title(loc="left").endswith("1 of 3 not found")


def test_where_no_slide_was_found_nothing_is_drawn():
    none = SteadySlide(0.1, np.nan, np.nan, np.nan, np.nan, code_plus=3, code_minus=3)
    with pytest.raises(ValueError, match=r"slide = .*needs one that was found"):
        none.plot()
