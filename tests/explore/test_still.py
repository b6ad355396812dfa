"""The picture for readers without a kernel."""

import numpy as np

from frictionjax.explore.explored import explored_at
from frictionjax.explore.setting import PageSetting
from frictionjax.explore.still import draw_still


def test_the_picture_shows_the_arrays_of_the_page():
    found = explored_at(PageSetting())
    wells, loop, bars = draw_still(found, "why not").axes
    np.testing.assert_array_equal(wells.lines[0].get_ydata(), 1e3 * found.energy)
    np.testing.assert_array_equal(loop.lines[0].get_xydata().T, [found.z, found.force])
    limit = [found.z_limit, found.force_limit]
    np.testing.assert_array_equal(loop.lines[1].get_xydata().T, limit)
    widths = [patch.get_width() for patch in bars.patches]
    numbers = found.coefficients
    assert widths == [numbers["rho_plus"], -numbers["rho_minus"], numbers["ratio"]]
    assert "why not" in wells.figure.get_suptitle()


def test_the_legend_is_beside_the_way_from_the_start():
    _, loop, _ = draw_still(explored_at(PageSetting())).axes
    loop.figure.draw_without_rendering()
    box = loop.get_legend().get_window_extent().transformed(loop.transData.inverted())
    for line in loop.lines:
        z, force = line.get_data()
        inside = (z > box.x0) & (z < box.x1) & (force > box.y0) & (force < box.y1)
        assert not inside.any()
