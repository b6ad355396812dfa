"""A bristle over its surface at one time."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..._checks import as_real, kind_of, require, require_real
from ...model import Scene
from ..style import Picture, styled
from .bristle_artist import BristleArtist
from .close_up import CloseUp
from .places import Places, places_along

_TIGHT: Any = {"columnspacing": 1.2, "handlelength": 1.5, "handletextpad": 0.5}


@styled
def draw_bristle(
    scene: Scene, solution: Any, time: Any, eps: Any = None, ax: Axes | None = None
) -> Figure:
    """Draw the bristle of a `scene` over its surface, as it stands at a `time` (s).

    `solution`: of `solve`, with its `eps` in m, or of `solve_limit`, whose surface is flat.
    Root, tip and far end of the support's spring are where `mechanics` has them at the
    solution's time nearest to `time`. A rod is a line, bent as an elastica while it turns
    over; the springs of the paper's first two models are coils; of a bristle that is no
    more than functions of the height the root is over z, at a height that means nothing,
    its link to the tip dashed. The angle is measured from the vertical, > 0 to the left;
    dashed: at which an angular spring is at rest. The support's spring has its far end q;
    where its rest length is unknown (no `loads.Pulled`) it is taken as 0. At finite eps
    the tip is shown close up too.

    `ax`: draw into these axes, without the close-up, and return their figure.

    Raises `ValueError` as `mechanics` does, for a time that is not within the solution's,
    a scene without a bristle (`GivenPotential`), and effects that put another potential in
    its place (arrays, `LeadingOrder`).

    >>> figure = fx.plot.draw_bristle(scene, fx.solve_limit(scene), time=0.75)
    >>> [text.get_text() for text in figure.legends[0].get_texts()][1:]
    ['spring', 'bristle', 'tip p', 'root u', 'end q']
    """
    places = places_along(scene, solution, eps)
    row = _row_at(places, time)
    if ax is not None:
        require(isinstance(ax, Axes), "ax", kind_of(ax), "axes of matplotlib")
        BristleArtist(ax, places).move_to(row)
        whole = ax.get_figure(root=True)
        assert whole is not None
        return whole
    close = places.eps is not None
    figure = Picture(figsize=(10.4 if close else 7.2, 3.6), layout="constrained")
    grid = figure.add_gridspec(1, 1 + close, width_ratios=[2.2, 1][: 1 + close])
    main = figure.add_subplot(grid[0])
    parts: list[Any] = [BristleArtist(main, places)]
    if close:
        parts.append(CloseUp(figure.add_subplot(grid[1]), places))
    for part in parts:
        part.move_to(row)
    handles = [h for h in main.get_legend_handles_labels()[0] if _seen(h)]
    figure.legend(handles=handles, loc="outside lower left", ncols=7, **_TIGHT)
    return figure


def _row_at(places: Places, time: Any) -> int:
    low, high = float(places.time[0]), float(places.time[-1])
    allowed = f"a time in s from {low:.6g} to {high:.6g}"
    require_real("time", time, allowed, lambda t: (t >= low) & (t <= high))
    return int(np.argmin(np.abs(places.time - float(as_real(time)))))


def _seen(handle: Any) -> bool:
    if not handle.get_visible():
        return False
    return not hasattr(handle, "get_xdata") or len(handle.get_xdata()) > 0
