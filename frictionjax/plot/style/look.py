"""How pictures look, without touching matplotlib's global settings."""

import io
from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase

from ..._checks import as_text, require

if TYPE_CHECKING:
    import xarray as xr

_Drawn = TypeVar("_Drawn")

# Told apart by colour-blind readers, in this order: Okabe and Ito's, then Tol's muted
# indigo, wine and olive, darker than all of those.
COLOURS = (
    *("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"),
    *("#332288", "#882255", "#999933"),
)
MARKERS = ("o", "s", "^", "D", "v", "P", "*")  # another period than the colours
LIMIT = "#222222"
GUIDE = "#999999"
STRIP = "#dfe6ee"
# Behind a label that curves or colours go under.
PLATE: Any = {"facecolor": "#ffffff", "edgecolor": "none", "alpha": 0.7, "pad": 0.8}
_TOLD_APART = 5.0  # of the largest eps: a curve that is still seen beside the limit's

_SETTINGS: Any = {
    "font.size": 10,
    "axes.titlesize": 10.5,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.grid": True,
    "grid.color": "#e8e8e8",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.5,
    "lines.markersize": 5,
    "legend.frameon": False,
    "legend.fontsize": 9,
    "figure.dpi": 130,
}


class Picture(Figure):
    """A Figure that Jupyter shows by itself; pyplot, with its global state, stays out."""

    def _repr_png_(self) -> bytes:
        buffer = io.BytesIO()
        self.savefig(buffer, format="png")
        return buffer.getvalue()


def styled(draw: Callable[..., _Drawn]) -> Callable[..., _Drawn]:
    """Run a drawing function under these settings, whatever the user's own are."""

    @wraps(draw)
    def inside(*args: Any, **kwargs: Any) -> _Drawn:
        with matplotlib.rc_context():
            matplotlib.rcdefaults()
            matplotlib.rcParams.update(_SETTINGS)
            return draw(*args, **kwargs)

    return inside


def new_figure(
    rows: int, columns: int, width: float, height: float, into: Any = None
) -> tuple[Any, Any]:
    """A figure (inches) and its axes, an array of shape (rows, columns).

    `into`: the user's own figure, or a part of it, whose size stays.

    Raises `ValueError` for an `into` that is none, under the name `figure`.
    """
    if into is not None:
        allowed = "a matplotlib Figure or SubFigure, or None"
        require(isinstance(into, FigureBase), "figure", into, allowed)
        return into, into.subplots(rows, columns, squeeze=False)
    figure = Picture(figsize=(width, height), layout="constrained")
    return figure, figure.subplots(rows, columns, squeeze=False)


def axes_of(ax: Any, width: float, height: float) -> tuple[Any, Any]:
    """What a picture of one axis returns, and the axis that it draws into.

    A new figure (inches) and its only axis where `ax` is None, else `ax` twice: a figure of
    the user's own is shown by whoever made it.

    Raises `ValueError` for an `ax` that is none.
    """
    if ax is None:
        figure, grid = new_figure(1, 1, width, height)
        return figure, grid[0, 0]
    require(isinstance(ax, Axes), "ax", ax, "matplotlib Axes, or None")
    return ax, ax


def colour(index: int) -> str:
    """Colour of the line with this index."""
    return COLOURS[index % len(COLOURS)]


def marker(index: int) -> str:
    """Marker of the line with this index."""
    return MARKERS[index % len(MARKERS)]


def shades(count: int) -> list[Any]:
    """Colours of an ordered family, from light (coarse) to dark (fine)."""
    return [matplotlib.colormaps["viridis_r"](v) for v in np.linspace(0.2, 0.9, count)]


def label_eps(eps: float) -> str:
    """`eps` for a legend."""
    return f"$\\epsilon$ = {float(eps):.3g} m"


def choose_gamma(dataset: "xr.Dataset", gamma: float | None) -> float:
    """The gamma to show: the nearest to the one asked for, 1 where none was.

    Raises `ValueError` for a gamma that the data set does not hold.
    """
    known = np.asarray(dataset.gamma.values, dtype=float)
    nearest = float(known[np.argmin(np.abs(known - (1.0 if gamma is None else gamma)))])
    close = gamma is None or np.isclose(nearest, gamma)
    require(close, "gamma", gamma, f"one of {', '.join(map(as_text, known))}")
    return nearest


def choose_eps(dataset: "xr.Dataset", gamma: float, eps: Any = None):
    """The eps to show, largest first: those asked for, else three of the good cells.

    The one between largest and smallest can still be told from the limit: a grid down to
    1e-6 m would otherwise be shown by one curve and two that lie on each other.

    Raises `ValueError` for an eps that the data set does not hold.
    """
    cells = dataset.sel(gamma=gamma)
    if eps is None:
        good = np.sort(cells.eps.values[np.asarray(cells.status) == 0])[::-1]
        if good.size <= 3:
            return good
        between = max(np.sqrt(good[0] * good[-1]), good[0] / _TOLD_APART)
        nearest = 1 + int(np.argmin(np.abs(np.log(good[1:-1] / between))))
        return good[[0, nearest, -1]]
    known = np.asarray(cells.eps.values, dtype=float)
    wanted = np.sort(np.atleast_1d(np.asarray(eps, dtype=float)))[::-1]
    for value in wanted:
        held = bool(np.isclose(known, value).any())
        require(held, "eps", value, f"one of {', '.join(map(as_text, known))}")
    return np.array([known[np.argmin(np.abs(known - value))] for value in wanted])
