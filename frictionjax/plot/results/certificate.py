"""What decides about a certified curve, and how much of it is accepted."""

from typing import Any

import numpy as np

from ..style import LIMIT, axes_of, colour, styled

_LEAST = 1e-3  # share at which bars begin, which are logarithmic
_NAMES = {
    "spacing": "samples apart",
    "missing_force": "force missing in slips",
    "viscosity": "viscosity of slips off by",
    "excess": "force beyond friction",
    "distance": "distance from solutions",
}


@styled
def draw_certificate(found: Any, ax: Any = None) -> Any:
    """Draw what decides of a certificate, over the most that is accepted.

    `found` by `certify` or `certify_limit`. A Figure, or `ax` where it is drawn into that.

    Bars that pass the line at 1 are why a curve is refused. One without a bar is unknown,
    as are those of slips of a curve that has none.

    >>> ts = np.linspace(0.0, 3.0, 501)
    >>> z = fx.solve(scene, eps=0.1, ts=ts).z
    >>> figure = fx.plot.draw_certificate(fx.certify(scene, 0.1, 1.0, ts, z))
    >>> figure.axes[0].get_title(loc="left")
    'OK: the curve solves the wiggly system'
    """
    drawn, axes = axes_of(ax, 7.2, 2.8)
    shares = found.shares
    most = max([10.0, *(3 * share for share in shares.values() if np.isfinite(share))])
    for index, share in enumerate(shares.values()):
        end = float(np.clip(share, _LEAST, most)) if not np.isnan(share) else _LEAST
        axes.barh(index, end, color=colour(int(share > 1)), height=0.6)
        told = "unknown" if np.isnan(share) else f"{max(share, 0.0):.2g}"
        axes.annotate(told, (end, index), (4, 0), textcoords="offset points", va="center")
    axes.axvline(1.0, color=LIMIT, linewidth=1.2)
    axes.set_xscale("log")
    axes.set_xlim(_LEAST, 3 * most)
    axes.set_yticks(range(len(shares)), [_NAMES[name] for name in shares])
    axes.invert_yaxis()
    axes.set(xlabel="over the most that is accepted (1)")
    axes.set_title(f"{found.status.name}: {found.message}", wrap=True)
    axes.grid(False, axis="y")
    return drawn
