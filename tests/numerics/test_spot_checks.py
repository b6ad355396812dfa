"""Places a golden section apart, and values that are near."""

import numpy as np
import pytest

from frictionjax.numerics import are_near, even_places


@pytest.mark.parametrize("count", [1, 2, 7, 100, 4096])
def test_gaps_are_alike_whatever_the_count(count):
    places = np.sort(even_places(count))
    assert np.all((places >= 0) & (places < 1))
    gaps = np.diff(np.append(places, places[0] + 1.0))
    assert gaps.max() < 2.62 / count  # three sizes of gaps, golden ratios of one another
    assert gaps.min() > 0.38 / count


@pytest.mark.parametrize(
    ("other", "share", "near"),
    [
        ([1.0, -4.0], 0.0, True),
        ([1.0 + 3.9e-3, -4.0], 1e-3, True),
        ([1.0, -4.0 + 4.1e-3], 1e-3, False),
        ([np.nan, -4.0], 1.0, False),
    ],
)
def test_values_are_near_by_the_largest_of_the_first(other, share, near):
    assert are_near([1.0, -4.0], other, share) is near
