"""A predicted cost is drawn with its range, compilation apart."""

import numpy as np
import pytest

from frictionjax.cost import CostPrediction

COST = CostPrediction(4.0, np.array([[1.0, 3.0]]), 9.0, 1.2e9, True)


def test_bars_are_seconds():
    (axes,) = COST.plot().axes
    assert [bar.get_width() for bar in axes.patches] == [4.0, 9.0]
    (spread,) = axes.collections
    ends = spread.get_segments()[0][:, 0]
    assert ends == pytest.approx([COST.low, COST.high])
    assert "1.2 GB" in axes.get_title(loc="left")
    other = COST._replace(measured=False).plot().axes[0]
    assert other.get_title(loc="left").endswith("of another machine")


def test_what_is_unknown_is_refused():
    with pytest.raises(ValueError, match="cost = 'unknown: the load turns too often"):
        COST._replace(seconds=np.nan).plot()
