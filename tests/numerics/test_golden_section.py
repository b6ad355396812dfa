"""Places a golden section apart."""

import numpy as np
import pytest

from frictionjax.numerics import even_places


@pytest.mark.parametrize("count", [1, 2, 7, 100, 4096])
def test_gaps_are_alike_whatever_the_count(count):
    places = np.sort(even_places(count))
    assert np.all((places >= 0) & (places < 1))
    gaps = np.diff(np.append(places, places[0] + 1.0))
    assert gaps.max() < 2.62 / count  # three sizes of gaps, golden ratios of one another
    assert gaps.min() > 0.38 / count
