"""A bristle that slides, its force beside it."""

from typing import Any

import numpy as np
from matplotlib.animation import FuncAnimation

from ..._checks import require, require_numbers, require_whole
from ...model import Scene
from ..style import Picture, styled
from .bristle_artist import BristleArtist
from .close_up import CloseUp
from .force_course import AGAINST, ForceCourse
from .frames import frame_rows
from .places import Places, places_along

_WIDE = 3.6  # of the panel of the bristle, over its height


@styled
def animate(
    scene: Scene,
    solution: Any,
    eps: Any = None,
    frames: int = 80,
    against: str = "time",
    interval: float = 60.0,
    dpi: float = 80.0,
) -> FuncAnimation:
    """A moving picture of a bristle that slides, and of the force on its root.

    The bristle as `draw_bristle` has it, of `scene`, `solution` and `eps` (m); at finite
    eps its tip close up; and the friction force `l - Phi'(z)` in N against `against`,
    "time" or "tip", a dot moving along, between the friction of the limit's slides.
    `frames`: how many times of the solution are shown, half of them chosen by time and half
    by the way that tip and root go: slips are seen, slower than the rest, where the
    solution's times resolve them. `interval`: from frame to frame, in ms; `dpi`: of frames
    9.6 by 4.8 inches.

    Returns a `FuncAnimation` of matplotlib. In a notebook `HTML(animate(...).to_jshtml())`;
    in a file `animate(...).save("x.gif", writer="pillow")`.

    Raises `ValueError` as `draw_bristle` does, and for other arguments out of range.

    >>> movie = fx.plot.animate(scene, fx.solve_limit(scene), frames=4)
    >>> movie.save("bristle.gif", writer="pillow")
    >>> len(list(movie.new_frame_seq()))
    4
    """
    require_whole("frames", frames, 2)
    require(against in AGAINST, "against", against, f"one of {', '.join(AGAINST)}")
    for name, value in (("interval", interval), ("dpi", dpi)):
        require_numbers(name, value, "one number > 0", lambda v: (v > 0) & (v.ndim == 0))
    places = places_along(scene, solution, eps)
    rows = _rows(places, frames)
    figure, parts = _parts(scene, places, against, float(dpi))

    def show(frame: int) -> list[Any]:
        for part in parts:
            part.move_to(int(rows[frame]))
        return []

    show(0)
    # Once: frames that are laid out anew each would tremble, and take longer.
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    return FuncAnimation(
        figure, show, frames=rows.size, interval=float(interval), blit=False
    )


def _rows(places: Places, frames: int) -> np.ndarray:
    enough = places.time.size >= 2
    require(enough, "solution", f"{places.time.size} times", "at least two to move between")
    gone = np.stack([places.tip[:, 0], places.root[:, 0]], axis=1)
    return frame_rows(places.time, gone, frames)


def _parts(scene: Scene, places: Places, against: str, dpi: float) -> tuple[Any, list[Any]]:
    figure = Picture(figsize=(9.6, 4.8), layout="constrained", dpi=dpi)
    close = places.eps is not None
    if close:
        grid = figure.add_gridspec(2, 2, height_ratios=[1.5, 1], width_ratios=[1.2, 1])
        parts: list[Any] = [
            BristleArtist(figure.add_subplot(grid[0, :]), places, wide=_WIDE),
            CloseUp(figure.add_subplot(grid[1, 0]), places),
        ]
        force = figure.add_subplot(grid[1, 1])
    else:
        grid = figure.add_gridspec(2, 1, height_ratios=[1.4, 1])
        parts = [BristleArtist(figure.add_subplot(grid[0]), places, wide=_WIDE)]
        force = figure.add_subplot(grid[1])
    return figure, [*parts, ForceCourse(force, scene, places, against)]
