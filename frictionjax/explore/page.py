"""The page in a notebook."""

from typing import Any

from .._checks import require, require_real
from .explored import explored_at
from .setting import PageSetting

_MISSING = 'the extra: pip install "frictionjax[notebooks]"'


def explore(
    angle: Any = 0.5,
    slope: Any = 0.1,
    asymmetry: Any = 0.3,
    eps: Any = 0.05,
    gamma: Any = 1.0,
) -> Any:
    """A page of sliders in a notebook, drawn anew while they move.

    A slanted spring (k = 1 N/m, rest length 2.4 m, root 1 m high) at `angle` (rad), on a
    surface of two harmonics: `slope` of the first one, `asymmetry` the second one's slope
    over that. It is pulled to and fro, by 1.2 N through a support of 2 N/m; `eps` in m, and
    viscosity is `eps^gamma`. Shown are `V_eps` with the tip, the friction loop at this eps
    and in the limit, and `rho_plus`, `rho_minus` with their ratio.

    Returns the page, whose `.angle` and the like are where its sliders stand, and move
    them; `.shown` has the arrays, `.status` says whether they can be trusted, or why a
    value is not allowed: what was last allowed stays, greyed. `.still()` is a picture of
    it, which a notebook keeps for readers without a kernel.

    Raises `ValueError` for numbers that the paper's hypotheses do not allow at first, and
    where the extra `notebooks` is not installed.

    >>> page = fx.explore(angle=0.5)
    >>> page.angle = 1.0
    >>> print(f"ratio {page.shown.coefficients['ratio']:.3f}: {page.status}")
    ratio 2.528: every number can be trusted
    """
    setting = PageSetting(angle, slope, asymmetry, eps, gamma)
    for name, value in zip(PageSetting._fields, setting, strict=True):
        require_real(name, value, "as a slider gives")
    try:
        from .widget import ExplorePage
    except ImportError as missing:
        require(False, "anywidget", f"not installed ({missing.name})", _MISSING)
    return ExplorePage(explored_at(PageSetting(*map(float, setting))))
