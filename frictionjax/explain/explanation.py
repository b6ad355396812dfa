"""What a scene simulates at one eps, gamma and accuracy, and what that calls for."""

import html
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from .._checks import as_real, require_flags, require_numbers, with_nan
from .._compile import waiting
from .._text import ResultTable, SelfDrawn
from ..called_for import (
    Estimate,
    Setting,
    estimate_of,
    finite_speed,
    setting_of,
)
from ..effects import LeadingOrder, Stage
from ..model import Scene, composed, known_scene
from ..wiggly import require_accuracy
from .costs import steps_ratio
from .equation import composed_equation
from .switched_off import higher_order_told

_COLUMNS = {
    "in_z": ("m", "largest change of the state, from above"),
    "in_force": ("N", "largest change of the friction force, from above"),
    "called_for": (None, "whether the change is larger than the accuracy asked for"),
    "cost": ("1", "steps with the effect over steps without, of all bristles"),
    "asked": (None, "whether the scene has it"),
    "source": (None, "where the estimate comes from"),
}


class _Parts(NamedTuple):
    equation: str
    effects: xr.Dataset


class Explanation(SelfDrawn, _Parts):
    """`equation`: text. `effects`: data set over `effect`, see `explain`."""

    __slots__ = ()
    _picture = "draw_explanation"

    def table(self) -> ResultTable:
        """A line for each effect: what it changes, whether it is called for, its cost.

        >>> fx.explain(scene, eps=0.01, gamma=1.0).table()
        effect        in z, m   in force, N  called for  in scene  cost
        higher order  2.57e-05  1.46e-08     yes         yes       1 ...
        finite speed  0.00622   0.00622      yes         yes       - ...
        """
        header = ("effect", "in z, m", "in force, N", "called for", "in scene", "cost", "")
        rows = []
        for name in [str(name) for name in self.effects.effect.values]:
            row = self.effects.sel(effect=name)
            numbers = [_number(row[key]) for key in ("in_z", "in_force")]
            asked = ("no", "yes")[bool(row.asked)]
            words = _called(row), asked, _number(row.cost), str(row.source.values)
            rows.append((name, *numbers, *words))
        return ResultTable(header, tuple(rows), left=len(header))

    def __repr__(self) -> str:
        return f"{self.equation}\n\n{self.table()}"

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.equation)}</pre>{self.table()._repr_html_()}"


def _number(value: Any) -> str:
    number = float(value)
    return "-" if np.isnan(number) else f"{number:.3g}"


def _called(row: xr.Dataset) -> str:
    """Of what nothing is known, and is no other scene, neither yes nor no."""
    if bool(row.called_for):
        return "yes"
    return "not known" if np.isnan(float(row.in_z)) else "no"


@with_nan
def explain(
    scene: Scene,
    eps: Any,
    gamma: Any,
    accuracy: Any = 1e-3,
    *,
    progress: bool = False,
) -> Explanation:
    """What a scene simulates, and which effects matter at an accuracy (in eps).

    `scene` at one `eps` (m) and one `gamma`; `accuracy` as in `solve`.

    Returns an `Explanation`. `.equation`: the composed equation as text. `.effects`: data
    set over `effect`, with `in_z` (m) and `in_force` (N), estimates from above of what it
    changes in the state at times outside of slips and in the friction force, `called_for`
    (`in_z` is more than `accuracy` eps, or another scene is meant; False too where `in_z`
    is NaN, not known), `asked` (the scene has it), `cost` (steps with it over steps
    without, by rules and laws of the schemes) and `source`. Rows: "higher order", what
    `LeadingOrder` leaves out of the scene if it had no mass and noise and did not turn
    over, of an array for the bristle that it changes most; "finite speed", what viscosity
    adds to dry friction; the scene's effects. Where the load turns while a tip is on a fold
    no closed form tells what the higher order changes: the scene is solved with it and
    without, and `source` says so; what a light mass, or noise, changes is not known then,
    and called for.

    `progress`: a line on standard error where it takes more than two seconds.

    Raises `ValueError` for arguments out of range, and as `solve` does.

    >>> print(fx.explain(scene, eps=0.01, gamma=1.0).equation)
    eps^gamma z' = l(t) - Phi'(z) - V_eps'(z)
      V_eps(z) = F(eps w(y)) - F(0), z = eps y + A(eps w(y)): SlantedSpring
      eps = 0.01 m, gamma = 1, eps^gamma = 0.01 N s/m
    """
    scene = known_scene(scene)
    one = "one number eps > 0"
    require_numbers("eps", eps, one, lambda e: (e > 0) & (e.ndim == 0))
    needs = "one number gamma > 0"
    require_numbers("gamma", gamma, needs, lambda g: (g > 0) & (g.ndim == 0))
    require_accuracy(accuracy)
    require_flags(progress=progress)
    size, power = float(as_real(eps)), float(as_real(gamma))
    with waiting("explain", progress) as tell:
        tell("folds, slides and speeds")
        at = setting_of(scene, size, power)
        if at is None:
            raise ValueError("scene.load turns too often: needs slides, to be told of them")
        tell("what effects change")
        rows, called, asked = _estimates(scene, at, float(as_real(accuracy)), tell)
    columns = {name: [getattr(row, name) for row in rows.values()] for name in _NUMBERS}
    columns |= {"called_for": list(called.values()), "asked": list(asked.values())}
    effects = xr.Dataset(
        {name: ("effect", values) for name, values in columns.items()},
        coords={"effect": list(rows)},
    )
    for name, (units, meaning) in _COLUMNS.items():
        effects[name].attrs = {"long_name": meaning} | ({"units": units} if units else {})
    text = composed_equation(scene, size, power).text()
    asked_for = {"eps": size, "gamma": power, "accuracy": float(as_real(accuracy))}
    return Explanation(text, effects.assign_attrs(asked_for))


_NUMBERS = Estimate._fields


def _estimates(
    scene: Scene, at: Setting, accuracy: float, tell: Callable[[str], None]
) -> tuple[dict[str, Estimate], dict[str, bool], dict[str, bool]]:
    """By name: the estimate, whether it is called for, whether the scene has it."""
    rows = {"higher order": _rest_of(scene, at, tell), "finite speed": finite_speed(at)}
    called = {name: _matters(row, at, accuracy) for name, row in rows.items()}
    asked = {"higher order": not _leading(scene), "finite speed": True}
    for effect in scene.effects:
        if not isinstance(effect, LeadingOrder):
            name = type(effect).__name__
            rows[name], asked[name] = estimate_of(effect, at), True
            if np.isnan(rows[name].cost):
                cost = steps_ratio(effect, scene, at, accuracy)
                rows[name] = rows[name]._replace(cost=cost)
            known = not np.isnan(rows[name].in_z)
            reads = effect.stage == Stage.READING
            called[name] = _matters(rows[name], at, accuracy) if known else not reads
    return rows, called, asked


def _leading(scene: Scene) -> bool:
    return any(isinstance(effect, LeadingOrder) for effect in scene.effects)


def _rest_of(scene: Scene, at: Setting, tell: Callable[[str], None]) -> Estimate:
    """Of the scene as it would be with Q."""
    if not _leading(scene):
        return higher_order_told(at, tell)
    rest = tuple(e for e in scene.effects if not isinstance(e, LeadingOrder))
    whole = composed(scene.replace(effects=rest))
    return higher_order_told(at._replace(scene=whole), tell)


def _matters(row: Estimate, at: Setting, accuracy: float) -> bool:
    return bool(row.in_z > accuracy * at.eps)
