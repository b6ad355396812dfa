"""What effects change, beside the accuracy that calls for them."""

from typing import Any

import numpy as np

from ..style import GUIDE, LIMIT, axes_of, colour, styled

_DECADES = 2.0  # beside what is drawn: bars are logarithmic, and begin somewhere


@styled
def draw_explanation(explained: Any, ax: Any = None) -> Any:
    """Draw what `explain` has `explained`: what each effect changes in the state at most.

    A Figure, or `ax` where it is drawn into that.

    Bars that pass the line, the accuracy asked for, are called for. Numbers are in m; what
    changes nothing, or is unknown, has no bar and says so.

    >>> figure = fx.plot.draw_explanation(fx.explain(scene, eps=0.01, gamma=1.0))
    >>> [label.get_text() for label in figure.axes[0].get_yticklabels()]
    ['higher order', 'finite speed']
    """
    effects = explained.effects
    names = [str(name) for name in effects.effect.values]
    changes = np.asarray(effects.in_z.values, dtype=float)
    line = float(effects.accuracy) * float(effects.eps)
    seen = changes[np.isfinite(changes) & (changes > 0)]
    ends = np.log10([line, *seen])
    least, most = 10 ** (ends.min() - _DECADES), 10 ** (ends.max() + _DECADES)
    drawn, axes = axes_of(ax, 7.2, 1.4 + 0.5 * len(names))
    for index, (change, called) in enumerate(
        zip(changes, effects.called_for.values, strict=True)
    ):
        bar = change if np.isfinite(change) and change > 0 else least
        axes.barh(index, bar, color=colour(1) if called else GUIDE, height=0.6)
        told = "unknown" if np.isnan(change) else f"{change:.2g} m"
        note = f"{told}, called for" if called else told
        axes.annotate(note, (bar, index), (4, 0), textcoords="offset points", va="center")
    axes.axvline(line, color=LIMIT, linewidth=1.2)
    axes.set(xscale="log", xlim=(least, most), xlabel="largest change of the state (m)")
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    axes.set_title(f"Effects; the line: {float(effects.accuracy):.0e} eps, {line:.2g} m")
    axes.grid(False, axis="y")
    return drawn
