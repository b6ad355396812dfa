"""Bars of effects pass the line where they are called for, and only there."""

import numpy as np
import xarray as xr

from frictionjax.explain import Explanation

NAMES = ["higher order", "finite speed", "NapFlip", "RigidArray"]
IN_Z = [3e-5, 2e-6, 0.0, np.nan]
COLUMNS = {"in_z": IN_Z, "called_for": [True, False, False, False]}
EFFECTS = xr.Dataset(
    {name: ("effect", values) for name, values in COLUMNS.items()},
    coords={"effect": NAMES},
    attrs={"eps": 0.01, "gamma": 1.0, "accuracy": 1e-3},
)


def test_bars_are_changes_beside_the_accuracy():
    (axes,) = Explanation("", EFFECTS).plot().axes
    widths = [bar.get_width() for bar in axes.patches]
    assert widths[:2] == IN_Z[:2]
    (line,) = axes.lines
    assert set(line.get_xdata()) == {1e-5}
    assert [width > 1e-5 for width in widths] == COLUMNS["called_for"]
    told = [text.get_text() for text in axes.texts]
    assert told == ["3e-05 m, called for", "2e-06 m", "0 m", "unknown"]
    assert [label.get_text() for label in axes.get_yticklabels()] == NAMES
