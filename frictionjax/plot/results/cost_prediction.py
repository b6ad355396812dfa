"""What a sweep is going to take."""

from typing import Any

import numpy as np

from ..._checks import require
from ...cost import CostPrediction
from ..style import GUIDE, LIMIT, axes_of, colour, styled


@styled
def draw_cost_prediction(cost: CostPrediction, ax: Any = None) -> Any:
    """Draw a predicted `cost`: seconds that a sweep takes, and that it compiles for.

    A Figure, or `ax` where it is drawn into that.

    The line over the first spans `low` to `high`. In the title, memory.

    Raises `ValueError` where nothing is known of the cost.

    >>> cost = fx.predict_cost(scene, eps=[1e-2, 1e-3], gamma=1.0, measure=False)
    >>> figure = fx.plot.draw_cost_prediction(cost)
    >>> [label.get_text() for label in figure.axes[0].get_yticklabels()]
    ['computation', 'compilation,\\nthe first time']
    """
    require(bool(np.isfinite(cost.seconds)), "cost", str(cost), "one that is known")
    drawn, axes = axes_of(ax, 7.2, 2.2)
    spread = [[cost.seconds - cost.low], [cost.high - cost.seconds]]
    line = {"ecolor": LIMIT, "capsize": 4}
    axes.barh(0, cost.seconds, xerr=spread, color=colour(0), height=0.6, error_kw=line)
    axes.barh(1, cost.compilation, color=GUIDE, height=0.6)
    axes.set_yticks([0, 1], ["computation", "compilation,\nthe first time"])
    axes.invert_yaxis()
    axes.set(xlabel="time (s)")
    where = "" if cost.measured else "; of another machine"
    axes.set_title(f"Predicted cost, up to {cost.memory / 1e9:.1f} GB{where}")
    axes.grid(False, axis="y")
    return drawn
