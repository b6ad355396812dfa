"""The picture of what accuracy costs: every cell, every failure, nothing hidden."""

from itertools import pairwise

import numpy as np
import pytest
import xarray as xr

import frictionjax as fx
from frictionjax.plot.style import colour
from frictionjax.plot.work_precision import _front

METHODS = "auto", "windowed", "resolved", "Kvaerno5", "Kvaerno3", "LSODA", "BDF", "Radau"


def cells_like(eps, gamma):
    """A data set as of `work_precision` with known numbers, 8 methods, 3 accuracies.

    Radau is never done, and BDF in another well at the loosest accuracy.
    """
    asked = np.array([1e-1, 1e-2, 1e-3])
    shape = len(gamma), len(eps), len(METHODS), asked.size
    seconds = 0.01 / np.array(eps)[:, None, None] * np.arange(1, 9)[:, None]
    error = np.broadcast_to(0.1 * asked, shape).copy()
    status, wrong = np.zeros(shape, dtype=int), np.zeros(shape)
    status[..., 7, :] = int(fx.Status.TOO_SLOW)
    error[..., 7, :] = np.nan
    error[..., 6, 0], wrong[..., 6, 0] = 30.0, 1.0
    dims = "gamma", "eps", "solver", "accuracy"
    values = {
        "seconds": np.broadcast_to(seconds - np.log(asked), shape).copy(),
        "error": error,
        "status": status,
        "wrong": wrong,
    }
    data = xr.Dataset({name: (dims, value) for name, value in values.items()})
    data["seconds_low"], data["seconds_high"] = 0.9 * data.seconds, 1.5 * data.seconds
    data["reference_error"] = dims[:2], np.full(shape[:2], 1e-6)
    coords = {"gamma": gamma, "eps": eps, "solver": list(METHODS), "accuracy": asked}
    return data.assign_coords(coords)


@pytest.fixture(scope="module")
def plain():
    """The picture of one cell."""
    figure = fx.plot.draw_work_precision(cells_like([0.1], [1.0]))
    figure.draw_without_rendering()
    return figure


def legend_of(figure):
    return [t.get_text() for legend in figure.legends for t in legend.get_texts()]


def lines_in(axes, shade):
    """Numbers of the lines of a colour that have points."""
    return [
        np.array(line.get_data(), dtype=float)
        for line in axes.lines
        if line.get_color() == shade and np.size(line.get_xdata())
    ]


@pytest.mark.parametrize("unsure", [1e-2, 1e2, np.inf])
def test_a_picture_shades_what_the_reference_cannot_judge(unsure):
    data = cells_like([0.1], [1.0])
    unsure_data = data.assign(reference_error=data.reference_error * 0 + unsure)
    for axes in fx.plot.draw_work_precision(unsure_data).axes:
        shades = [p for p in axes.patches if p.get_facecolor()[:3] == (238 / 255,) * 3]
        low, high = axes.get_ylim()
        top = max(patch.get_window_extent().y1 for patch in shades)
        shown = axes.transData.inverted().transform((0.0, top))[1]
        edge = min(max(min(unsure, 1e3), low), high)
        assert shown == pytest.approx(edge, rel=1e-6)
        said = any("no reference" in text.get_text() for text in axes.texts)
        assert said == np.isinf(unsure)


def test_axes_say_where_methods_are_moved_aside():
    data = cells_like([0.1, 0.05], [1.0])
    of_all = [one.get_xlabel() for one in fx.plot.draw_work_precision(data).axes]
    assert [one.endswith(", methods side by side") for one in of_all] == [False] + 3 * [
        True
    ]
    one = data.isel(solver=[0])
    assert not any("side" in a.get_xlabel() for a in fx.plot.draw_work_precision(one).axes)


@pytest.mark.parametrize(
    ("eps", "gamma", "panels", "along"),
    [
        ([0.1], [1.0], 0, None),
        ([0.1, 0.05, 0.01], [1.0], 2, "eps"),
        ([0.1], [0.5, 1.0, 1.5], 2, "gamma"),
        ([0.1, 0.01], [0.5, 1.0, 1.5], 6, "eps"),
    ],
)
def test_a_picture_shows_every_cell(eps, gamma, panels, along):
    """With one eps and several gamma only one gamma was drawn."""
    figure = fx.plot.draw_work_precision(cells_like(eps, gamma))
    figure.draw_without_rendering()
    below = figure.axes[2:]
    assert len(below) == panels
    values = {"eps": eps, "gamma": gamma, None: []}[along]
    for axes in below:
        assert axes.get_xlabel().startswith({"eps": "$\\eps", "gamma": "$\\gam"}[along])
        ((x, _),) = lines_in(axes, colour(0))
        assert x.size == len(values)
        for index in range(len(METHODS)):
            inside = lines_in(axes, colour(index))[0][0]
            low, high = axes.get_xlim()
            assert np.all((low < inside) & (inside < high))
    if panels == 6:
        for name, axes in zip(2 * gamma, below, strict=True):
            assert f"$\\gamma$ = {name:.3g})" in axes.get_title(loc="left")
        ((_, seconds),) = lines_in(below[0], colour(0))
        assert seconds == pytest.approx(0.01 / np.array(eps) - np.log(1e-2))


def test_seconds_within_two_decades_are_written_plainly(plain):
    axes = plain.axes[0]
    low, high = axes.get_xlim()
    assert high < 100 * low
    boxes = [
        text.get_window_extent()
        for minor in (False, True)
        for text in axes.get_xticklabels(minor=minor)
        if text.get_text() and low <= text.get_position()[0] <= high
    ]
    assert len(boxes) >= 2
    ends = sorted((box.x0, box.x1) for box in boxes)
    assert all(left[1] < right[0] for left, right in pairwise(ends))


def test_each_method_has_a_colour_of_its_own():
    assert len({colour(index) for index in range(len(METHODS))}) == len(METHODS)


def test_methods_that_do_the_same_do_not_hide_each_other(plain):
    axes = plain.axes[1]
    places = [lines_in(axes, colour(index))[0][0] for index in range(len(METHODS))]
    assert np.all(np.diff(places, axis=0) != 0)
    spread = np.ptp(np.log10(places), axis=0)
    assert np.all(spread < 0.5)  # of the decade between accuracies


def test_an_accuracy_that_is_kept_is_below_the_line_wherever_its_method_stands():
    cells = cells_like([0.1], [1.0])
    cells["error"] = cells.accuracy * xr.where(cells.solver == "auto", 0.9, 1.1)
    cells["status"] = cells.status * 0
    axes = fx.plot.draw_work_precision(cells).axes[1]
    steps = axes.lines[2 * len(METHODS)]  # after each method's line and crosses
    edges, heights = np.array(steps.get_data())
    asked = cells.accuracy.values
    for index in range(len(METHODS)):
        ((places, errors),) = lines_in(axes, colour(index))
        line = np.array([heights[np.searchsorted(edges, x)] for x in places])
        assert line.tolist() == asked.tolist()
        assert np.all((errors < line) == (index == 0))


def test_times_are_drawn_from_the_fastest_run_to_the_slowest(plain):
    axes = plain.axes[0]
    ((seconds, errors),) = lines_in(axes, colour(0))
    ends = np.array(axes.collections[0].get_segments())
    assert ends[:, 0, 0] == pytest.approx(0.9 * seconds)
    assert ends[:, 1, 0] == pytest.approx(1.5 * seconds)
    assert ends[:, 0, 1].tolist() == errors.tolist()


def test_what_is_wrong_is_crossed_out_in_both_panels(plain):
    for axes in plain.axes:
        crosses = [x for x in axes.lines if x.get_marker() == "x" and x.get_xdata().size]
        assert [cross.get_ydata().tolist() for cross in crosses] == [[30.0]]


def test_what_is_not_done_stands_above_the_upper_edge():
    figure = fx.plot.draw_work_precision(cells_like([0.1, 0.01], [0.5, 1.0]))
    figure.draw_without_rendering()
    for axes in figure.axes:
        radau = [x for x in axes.lines if x.get_color() == colour(7)]
        (line,) = (x for x in radau if np.size(x.get_xdata()))
        assert np.all(np.asarray(line.get_ydata()) > 0.9)
        assert line.get_transform() == axes.get_xaxis_transform()
        shown = [x for x in axes.lines if x.get_transform() == axes.transData]
        highest = max(np.max(x.get_ydata()) for x in shown if np.size(x.get_ydata()))
        to_axes = axes.transData + axes.transAxes.inverted()
        assert to_axes.transform((1.0, highest))[1] <= 0.9 + 1e-9
    assert "Radau (12 of 12 not done)" in legend_of(figure)


def test_runs_that_nobody_has_begun_are_counted_apart():
    cells = cells_like([0.1], [1.0])
    cells.status[..., 6, :] = int(fx.Status.NOT_TRIED)
    cells.status[..., 7, 1:] = int(fx.Status.NOT_TRIED)
    legend = legend_of(fx.plot.draw_work_precision(cells))
    assert "BDF (3 of 3 not tried)" in legend
    assert "Radau (1 of 3 not done, 2 of 3 not tried)" in legend
    assert "not done: too slow, failed, or not tried" in legend


def test_runs_are_counted_as_not_done_by_their_status():
    """An error of 0, or of NaN where no time is outside slips, is no failure."""
    cells = cells_like([0.1], [1.0])
    cells.error[0, 0, 0] = [0.0, np.nan, 1e-9]
    figure = fx.plot.draw_work_precision(cells)
    assert legend_of(figure)[0] == "auto"
    ((_, errors),) = lines_in(figure.axes[0], colour(0))
    assert errors.tolist() == [1e-6, 1e-6]  # what the reference can judge


def test_a_front_of_one_point_is_seen():
    cells = cells_like([0.1], [1.0])
    cells.seconds[0, 0, 1:] = 100.0
    cells.seconds[0, 0, 0] = [3.0, 2.0, 1.0]  # the most accurate is the fastest
    axes = fx.plot.draw_work_precision(cells).axes[0]
    (front,) = (line for line in axes.lines if line.get_zorder() == 1)
    assert front.get_xdata().tolist() == [1.0]
    assert front.get_marker() == "o"
    assert front.get_markersize() > 10


@pytest.mark.parametrize("cells", ["one", ([0.1, 0.01], [0.5, 1.0, 1.5])])
def test_legends_cover_nothing(cells, plain):
    figure = plain if cells == "one" else fx.plot.draw_work_precision(cells_like(*cells))
    figure.draw_without_rendering()
    legends = [legend.get_window_extent() for legend in figure.legends]
    assert len(legends) == 2
    for axes in figure.axes:
        assert axes.get_legend() is None
        assert not any(axes.get_tightbbox().overlaps(legend) for legend in legends)
    for legend in legends:
        assert figure.bbox.x0 <= legend.x0
        assert legend.x1 <= figure.bbox.x1


def test_a_picture_of_nothing_but_failures():
    data = cells_like([0.1], [1.0])
    nothing = data.assign(error=data.error * np.nan)
    fx.plot.draw_work_precision(nothing).draw_without_rendering()


def test_the_front_is_what_no_run_beats():
    points = np.random.default_rng(0).uniform(size=(2, 40))
    expected = {
        (t, e)
        for t, e in points.T
        if not any(a <= t and b <= e and (a, b) != (t, e) for a, b in points.T)
    }
    assert {(t, e) for t, e in _front(points).T} == expected


def test_the_upper_panels_are_of_the_eps_asked_for():
    data = cells_like([0.1, 0.045], [1.0])
    for eps in (0.1, 0.045):
        axes = fx.plot.draw_work_precision(data, eps=eps).axes[0]
        ((seconds, _),) = lines_in(axes, colour(0))
        expected = 0.01 / eps - np.log(data.accuracy.values)
        assert np.sort(seconds) == pytest.approx(np.sort(expected))
    with pytest.raises(ValueError, match=r"eps = 0\.3: .*one of 0\.1, 0\.045"):
        fx.plot.draw_work_precision(data, eps=0.3)


def test_a_picture_of_one_cell_has_two_panels(plain):
    assert len(plain.axes) == 2
    assert "LSODA" in " ".join(legend_of(plain))
