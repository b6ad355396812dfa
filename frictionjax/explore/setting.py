"""What the sliders of the page set, and how far each goes."""

from typing import Any, NamedTuple


class PageSetting(NamedTuple):
    """Where the sliders stand.

    `angle` of the bristle in rad. `slope`: of the first harmonic of the surface;
    `asymmetry`: slope of its second one over that. `eps` in m; viscosity is `eps^gamma`.
    """

    angle: float = 0.5
    slope: float = 0.1
    asymmetry: float = 0.3
    eps: float = 0.05
    gamma: float = 1.0


class Slider(NamedTuple):
    """A slider from `low` to `high`; `step` is one of log10 where it is `logarithmic`."""

    name: str
    label: str
    unit: str
    low: float
    high: float
    step: float
    logarithmic: bool = False

    def sent(self) -> dict[str, Any]:
        """As the page reads it."""
        return self._asdict()


# Far enough for each hypothesis of the paper to fail somewhere: the page says which.
SLIDERS = (
    Slider("angle", "angle of the bristle", "rad", -1.3, 1.3, 0.01),
    Slider("slope", "slope of the surface", "", 0.02, 0.3, 0.005),
    Slider("asymmetry", "asymmetry of the surface", "", -0.6, 0.6, 0.02),
    Slider("eps", "eps, period of the wiggles", "m", 0.01, 0.2, 0.01, True),
    Slider("gamma", "gamma, viscosity is eps^gamma", "", 0.5, 2.0, 0.05),
)
