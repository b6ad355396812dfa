"""Friction over a plane of designs."""

from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize, TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from .._checks import require
from .style import GUIDE, PLATE, new_figure, styled

if TYPE_CHECKING:
    import xarray as xr

_UNITS = {"asymmetry": "1", "steepness": "1", "angle": "rad", "rest_angle": "rad"}
_UNITS |= {"height": "m", "length": "m", "rest_length": "m"}
_AXES = {
    "asymmetry": "surface asymmetry $\\omega_+/|\\omega_-|$",
    "steepness": "steepness of the surface $(\\omega_+ - \\omega_-)/2$",
    "angle": "angle of the bristle $\\theta$",
}
_TITLES = {
    "ratio": "Friction ratio $-\\rho_+/\\rho_-$",
    "contrast": "Contrast $(\\rho_+ + \\rho_-)/(\\rho_+ - \\rho_-)$",
    "rho_plus": "Friction to the right $\\rho_+$ (N)",
    "rho_minus": "Friction to the left $\\rho_-$ (N)",
    "difference": "Difference $\\rho_+ + \\rho_-$ (N)",
    "alpha": "Normal force without friction $\\alpha$ (N)",
}
_SLIDES = {
    f"{force}_{side}": f"{words} force of a slide to the {way} (N)"
    for force, words in (("mean", "Mean"), ("peak", "Largest"))
    for side, way in (("plus", "right"), ("minus", "left"))
}
_LIMIT = ", limit $\\epsilon \\to 0$"
_SIGNED = ("ratio", "contrast", "difference", "alpha")
_RATIOS = (1 / 10, 1 / 5, 1 / 3, 1 / 2, 2 / 3, 1, 1.5, 2, 3, 5, 10)
# What is left out of a map, and how it is hatched.
_LEFT = (
    ("////", "not admissible"),
    ("....", "$\\alpha$ < 0: the bristle pulls"),
    ("xxxx", "no slide that can be trusted at this $\\epsilon$"),
)


@styled
def draw_design_map(data: "xr.Dataset", quantities: Any = ("ratio", "contrast")) -> Figure:
    r"""Draw maps of a `design_map`, one panel a quantity, contours labelled.

    `data`: the data set; `quantities`: names of its variables, one or several.
    Ratios are coloured by their logarithm, so that left and right look alike; colours end
    at the 2nd and 98th of a hundred values, and arrows on the bar say so. Each cell lies
    about its design, up to half the way to the next. Hatched: no bristle there can follow
    the surface; dotted: it would pull, and may not. Of a map with `eps` titles say what is
    of the limit; `mean_plus`, `mean_minus`, `peak_plus` and `peak_minus` are its slides,
    crossed where their `status` is not OK.

    Raises `ValueError` for a quantity that the data set does not hold.

    >>> angles, asymmetries = ("angle", [0.5, 1.0]), ("asymmetry", [1.0, 2.0])
    >>> data = fx.design_map(scene.bristle, x=angles, y=asymmetries)
    >>> print(fx.plot.draw_design_map(data).axes[0].get_xlabel())
    angle of the bristle $\theta$ (rad)
    """
    names = [quantities] if isinstance(quantities, str) else list(quantities)
    titles = _titles(data)
    for name in names:
        there = ", ".join(one for one in titles if one in data)
        good = name in titles and name in data
        require(good, "quantities", name, f"one of {there}")
    figure, grid = new_figure(1, len(names), 5.6 * len(names), 4.6)
    for axes, name in zip(grid[0], names, strict=True):
        _panel(figure, axes, data, name)
        axes.set_title(titles[name])
    return figure


def _titles(data: "xr.Dataset") -> dict[str, str]:
    """Of each quantity; of a map with an eps, with what it is told for."""
    if "eps" not in data.attrs:
        return _TITLES
    limit = {name: title + _LIMIT for name, title in _TITLES.items()}
    at = f", $\\epsilon$ = {data.attrs['eps']:.3g} m"
    return limit | {name: title + at for name, title in _SLIDES.items()}


def _panel(figure: Any, axes: Any, data: "xr.Dataset", name: str) -> None:
    up, across = data["admissible"].dims
    data = data.sortby([across, up])
    x, y = data[across].values, data[up].values
    edges = _edges(x, False), _edges(y, str(up) == "asymmetry")
    admissible = data["admissible"].values
    trusted = data["status"].values == 0 if name in _SLIDES else admissible
    # Of alpha, which is told where the bristle pulls too.
    values = np.where(admissible & trusted, data[name].values, np.nan)
    axes.set_facecolor("#f4f4f4")
    alpha = data["alpha"].values
    if np.isfinite(values).any():
        shown, levels, texts = _shown(name, values)
        _coloured(figure, axes, edges, name, (shown, levels, texts))
        for side in (alpha > 0, alpha < 0):  # friction jumps from one to the other
            _contours(axes, x, y, np.where(side, shown, np.nan), levels, texts)
    pulls = ~admissible & (alpha < 0)  # known, but not asked for
    outside = ~admissible & ~pulls, pulls, admissible & ~trusted
    handles = _left_out(axes, edges, outside)
    _key(axes, handles + _sides(axes, x, y, alpha))
    axes.grid(False)
    axes.set(xlabel=number_label(str(across)), ylabel=number_label(str(up)))
    if str(up) == "asymmetry":
        axes.set_yscale("log")
        ticks = [v for v in _RATIOS if y.min() <= v <= y.max()]
        axes.set_yticks(ticks, labels=[_ratio_text(v) for v in ticks])
        axes.minorticks_off()


def _coloured(figure: Any, axes: Any, edges: Any, name: str, what: tuple) -> None:
    """Cells and the bar of their colours; `what`: as of `_shown`."""
    shown, levels, texts = what
    norm = _norm(name, shown)
    colours = "RdBu_r" if name in _SIGNED else "viridis"
    mesh = axes.pcolormesh(*edges, shown, cmap=colours, norm=norm, rasterized=True)
    bar = figure.colorbar(mesh, ax=axes, extend=_beyond(shown, norm), pad=0.02)
    inside = [v for v in levels if norm.vmin <= v <= norm.vmax]
    bar.set_ticks(inside, labels=[texts[v] for v in inside])
    bar.outline.set_visible(False)


def _shown(name: str, values: np.ndarray) -> tuple[np.ndarray, list[float], dict]:
    """What is coloured, the levels of its contours, and their texts."""
    if name == "ratio":
        levels = [float(np.log(v)) for v in _RATIOS]
        texts = {lv: _ratio_text(v) for lv, v in zip(levels, _RATIOS, strict=True)}
        return np.log(values), levels, texts
    low, high = np.nanpercentile(values, (2, 98))
    ticks = matplotlib.ticker.MaxNLocator(7).tick_values(low, high)
    levels = [float(v) for v in ticks if low <= v <= high]
    return values, levels, {v: f"{v:.6g}" for v in levels}


def _ratio_text(value: float) -> str:
    if value == 2 / 3:
        return "2/3"
    return f"{value:.3g}" if value >= 1 else f"1/{1 / value:.3g}"


def _norm(name: str, shown: np.ndarray) -> Any:
    low, high = np.nanpercentile(shown, (2, 98))
    if name not in _SIGNED:
        return Normalize(low, high)
    size = max(abs(low), abs(high), 1e-300)
    return TwoSlopeNorm(0.0, -size, size)


def _beyond(shown: np.ndarray, norm: Any) -> str:
    below = bool(np.nanmin(shown) < norm.vmin)
    above = bool(np.nanmax(shown) > norm.vmax)
    return {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[below, above]


def _contours(axes: Any, x, y, shown, levels, texts) -> None:
    """Labelled lines at the levels, that of symmetric friction wider."""
    if min(shown.shape) < 2 or np.isnan(shown).all():
        return
    low, high = np.nanmin(shown), np.nanmax(shown)
    inside = [v for v in levels if low < v < high]
    if not inside:
        return
    widths = [1.5 if v == 0 else 0.7 for v in inside]
    look: Any = {"colors": "#333333", "linestyles": "solid"}
    lines = axes.contour(x, y, shown, levels=inside, linewidths=widths, **look)

    def text(value: float) -> str:
        return texts[min(texts, key=lambda known: abs(known - value))]

    for label in axes.clabel(lines, fmt=text, fontsize=8):
        label.set_bbox(PLATE)  # or it is lost on the dark ends of the colours


def _edges(values: np.ndarray, ratios: bool) -> np.ndarray:
    """Ends of cells about increasing `values` (n,), shape (n + 1,): half the way, of ratios
    by their logarithm."""
    if ratios:
        return np.exp(_edges(np.log(values), False))
    if values.size == 1:
        return values + np.array([-0.5, 0.5]) * (abs(values[0]) or 1.0)
    middle = 0.5 * (values[1:] + values[:-1])
    ends = 2 * values[[0, -1]] - middle[[0, -1]]
    return np.concatenate([ends[:1], middle, ends[1:]])


def _left_out(
    axes: Any, edges: tuple[np.ndarray, np.ndarray], left: tuple[np.ndarray, ...]
) -> list[Any]:
    """Hatch the cells that are left out; what each kind is called, for a legend."""
    handles = []
    look: Any = {"edgecolor": GUIDE, "linewidth": 0.0}
    for outside, (hatch, label) in zip(left, _LEFT, strict=True):
        if not outside.any():
            continue
        with matplotlib.rc_context({"hatch.linewidth": 0.5}):
            cells = PolyCollection(
                list(_corners(*edges)[outside]), facecolor="none", **look
            )
            axes.add_collection(cells)
            cells.set_hatch(hatch)
        key: Any = {"facecolor": "#f4f4f4", "edgecolor": GUIDE, "hatch": hatch}
        handles.append(Patch(**key, label=label))
    return handles


def _corners(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Of all cells, from their edges (columns + 1,), (rows + 1,): (rows, columns, 4, 2)."""
    left, low = np.meshgrid(x[:-1], y[:-1])
    right, high = np.meshgrid(x[1:], y[1:])
    corners = (left, low), (right, low), (right, high), (left, high)
    return np.stack([np.stack(corner, axis=-1) for corner in corners], axis=-2)


def _sides(axes: Any, x: np.ndarray, y: np.ndarray, alpha: np.ndarray) -> list[Any]:
    """A dotted line where alpha changes sign; what it is called, for a legend."""
    if min(alpha.shape) < 2 or not ((alpha < 0).any() and (alpha > 0).any()):
        return []
    axes.contour(x, y, alpha, levels=[0.0], colors="#222222", linestyles="dotted")
    label = "$\\alpha$ = 0: the bristle presses on one side, pulls on the other"
    return [Line2D([], [], color="#222222", linestyle=":", label=label)]


def _key(axes: Any, handles: list[Any]) -> None:
    if handles:
        place: Any = {"loc": "upper left", "bbox_to_anchor": (0.0, -0.12)}
        axes.legend(handles=handles, borderpad=0.0, ncols=1, **place)


def number_label(name: str) -> str:
    """Label of an axis: what the number is, and its unit."""
    return f"{_AXES.get(name, name.replace('_', ' '))} ({_UNITS.get(name, 'own unit')})"
