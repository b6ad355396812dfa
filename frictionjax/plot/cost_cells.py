"""Time and error of methods from cell to cell, at one accuracy."""

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr

from .cost_runs import (
    TOO_LITTLE,
    UNKNOWN,
    WRONG,
    apart,
    beside_each_other,
    floor_of,
    look,
    mark_failed,
    runs_of,
    set_places,
)
from .style import LIMIT

_FEW = 6  # values that are ticks themselves
_MARGIN = 0.1  # decades beyond the outer points
_NAMES = {"eps": "$\\epsilon$ (m)", "gamma": "$\\gamma$"}
_SCALES = {"eps": "log", "gamma": "linear"}


def columns_below(dataset: xr.Dataset) -> int:
    """Columns of panels: with several eps one for each gamma; 0 for a single cell."""
    if dataset.eps.size > 1:
        return int(dataset.gamma.size)
    return 1 if dataset.gamma.size > 1 else 0


def draw_cells(place: Any, dataset: xr.Dataset) -> None:
    """Seconds, and error over accuracy, at the accuracy in the middle.

    Against eps, one panel for each gamma; with one eps against gamma. `place`: of a grid;
    the two panels of a single column stand side by side.
    """
    middle = dataset.isel(accuracy=dataset.accuracy.size // 2)
    if dataset.eps.size > 1:
        along, groups = "eps", [middle.sel(gamma=g) for g in dataset.gamma.values]
    else:
        along, groups = "gamma", [middle.isel(eps=0)]
    shape = (1, 2) if len(groups) == 1 else (2, len(groups))
    panels = place.subgridspec(*shape).subplots().reshape(2, -1)
    asked = f"{float(middle.accuracy):.0e}"
    _row(panels[0], groups, along, _seconds, f"Time at accuracy {asked}")
    _row(panels[1], groups, along, _errors, f"Is the accuracy {asked} kept?")


def _cell(group: xr.Dataset, along: str) -> str:
    if along == "eps":
        return f"$\\gamma$ = {float(group.gamma):.3g}"
    return f"$\\epsilon$ = {float(group.eps):.3g} m"


def _row(panels: Any, groups: list, along: str, draw: Callable, title: str) -> None:
    """Panels with the same axes, whose first carries the labels."""
    for axes, group in zip(panels, groups, strict=True):
        axes.set(yscale="log")
        draw(axes, group, along)
        values = group[along].values
        set_places(axes, values, _SCALES[along])
        if values.size <= _FEW:
            axes.set_xticks(values, [f"{value:.3g}" for value in values])
            axes.minorticks_off()
        axes.set_xlabel(_NAMES[along] + beside_each_other(group))
        axes.set_title(f"{title}  ({_cell(group, along)})")
    limits = _limits(np.array([axes.dataLim.intervaly for axes in panels]))
    for axes, group in zip(panels, groups, strict=True):
        axes.set_ylim(limits)
        if draw is _errors:
            _shade(axes, group, along)
    for axes in panels[1:]:
        axes.set_ylabel("")
        axes.tick_params(labelleft=False)
    mark_failed(list(panels), [_failed(group, along) for group in groups])


def _limits(extents: np.ndarray) -> tuple[float, float]:
    """Half decades that hold all extents and markers, and two powers of ten for labels."""
    known = extents[np.isfinite(extents) & (extents > 0)]
    if not known.size:  # nothing is drawn
        return 0.1, 10.0
    low = np.floor(2 * (np.log10(known.min()) - _MARGIN))
    high = np.ceil(2 * (np.log10(known.max()) + _MARGIN))
    second = 2 * np.ceil(0.5 * high) - 4  # of the powers of ten below the upper end
    return float(10 ** (0.5 * min(low, second))), float(10 ** (0.5 * high))


def _ticks(low: float, high: float) -> np.ndarray:
    """At most seven powers of ten with 1 among them, which is what is asked for."""
    ends = np.log10([low, high]).round(6)
    step = int(np.ceil((ends[1] - ends[0]) / 7))
    return 10.0 ** (step * np.arange(np.ceil(ends[0] / step), ends[1] / step + 1e-9))


def _lines(group: xr.Dataset, along: str):
    """For each method its look, its places and its runs."""
    names = group.solver.values
    places = apart(group[along].values, names.size, _SCALES[along])
    for index, name in enumerate(names):
        yield look(str(name), index), places[index], runs_of(group.sel(solver=name))


def _failed(group: xr.Dataset, along: str) -> list[np.ndarray]:
    return [places[runs.failed] for _, places, runs in _lines(group, along)]


def _seconds(axes: Any, group: xr.Dataset, along: str) -> None:
    for style, places, runs in _lines(group, along):
        axes.plot(places[~runs.failed], runs.seconds[~runs.failed], **style)
    axes.set_ylabel("seconds of a warm run")


def _errors(axes: Any, group: xr.Dataset, along: str) -> None:
    asked = float(group.accuracy)
    for style, places, runs in _lines(group, along):
        shown, wrong = runs.drawn, runs.drawn & runs.wrong
        axes.plot(places[shown], runs.errors[shown] / asked, **style)
        axes.plot(places[wrong], runs.errors[wrong] / asked, **WRONG)
    axes.axhline(1.0, color=LIMIT, linewidth=1)
    axes.set_ylabel("error reached over asked for")


def _shade(axes: Any, group: xr.Dataset, along: str) -> None:
    """Above one too little is reached; below the reference nothing is known."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    axes.axhspan(1.0, high, color=TOO_LITTLE, zorder=0)
    values, floor = group[along].values, floor_of(group) / float(group.accuracy)
    order = np.argsort(values)
    edges = np.concatenate([[left], values[order], [right]])
    floor = np.pad(floor[order], 1, mode="edge")
    axes.fill_between(edges, low, np.clip(floor, low, high), color=UNKNOWN, zorder=0.5)
    axes.set(xlim=(left, right), yticks=_ticks(low, high), ylim=(low, high))
