"""What a fit is asked for: bristles and the friction coefficients they should have."""

from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

from ..._checks import (
    checked,
    is_concrete,
    kind_of,
    known_numbers,
    require,
    require_real,
    require_x64,
)
from ..._compile import Program
from ...bristles import AbstractBristle, pulling_text
from ...model import BristlePotential, require_admissible, rounding_of_alpha
from ...profiles import Sine
from ...turning import nap_is_left
from .settings import SETTINGS


def _on_nearly_flat(bristle: AbstractBristle) -> BristlePotential:
    """Made when asked for: at import JAX may still be in 32 bits."""
    gentle: Any = SETTINGS.hardly_wavy
    return BristlePotential(Sine(gentle), bristle)


class Target(NamedTuple):
    """A `bristle` and the friction coefficients that it should have on the surface.

    `rho_plus` > 0 > `rho_minus` in N. `weight`: > 0, of its squared residuals.
    `uncertainty`: standard deviation of the two in N, one number or a pair; without it
    residuals are relative. Checked where it is used. `nap`: whether it was asked for by
    the bristle's nap, which a fit must not turn round then.

    >>> wanted = fx.Target(scene.bristle, rho_plus=0.12, rho_minus=-0.05)
    >>> print(f"{-wanted.rho_plus / wanted.rho_minus:.2f} times harder to the right")
    2.40 times harder to the right
    """

    bristle: AbstractBristle
    rho_plus: Any
    rho_minus: Any
    weight: Any = 1.0
    uncertainty: Any = None
    nap: bool = False

    @classmethod
    def of_nap(
        cls,
        bristle: AbstractBristle,
        with_nap: Any,
        against_nap: Any,
        weight: Any = 1.0,
        uncertainty: Any = None,
    ) -> "Target":
        """A bristle moved with and against its nap, whichever way that is (Section 3.4).

        `with_nap`, `against_nap`: friction in N, > 0, as `nap` tells it of the bristle as
        it stands. `uncertainty`: one number, or that of each.

        Raises `ValueError` for friction that is not positive, and for bristles of which
        nothing says how they stand, or that stand upright and have no nap.

        >>> wanted = fx.Target.of_nap(scene.bristle, with_nap=0.12, against_nap=0.08)
        >>> wanted.rho_plus, wanted.rho_minus
        (0.12, -0.08)
        """
        for name, value in (("with_nap", with_nap), ("against_nap", against_nap)):
            require_real(name, value, f"{name} > 0 in N", _positive)
        if not _nap_is_left(bristle):
            return cls(bristle, with_nap, -against_nap, weight, uncertainty, True)
        turned = uncertainty is not None and np.shape(uncertainty) == (2,)
        uncertainty = uncertainty[::-1] if turned else uncertainty
        return cls(bristle, against_nap, -with_nap, weight, uncertainty, True)


def lean_of(bristle: AbstractBristle) -> float:
    """Its angle in rad, of which the nap is a matter; NaN where nothing says it."""
    stance = bristle.geometry(jnp.zeros(()))
    return float("nan") if stance is None else float(stance.angle)


def _nap_is_left(bristle: Any) -> bool:
    """Raises `ValueError` where it has no nap."""
    known = isinstance(bristle, AbstractBristle)
    allowed = "a part of frictionjax.bristles"
    require(known, "bristle", kind_of(bristle), allowed)
    require(is_concrete(bristle), "bristle", "traced", "numbers: a fit is not traced")
    lean = lean_of(bristle)
    needs = "one that leans, SlantedSpring or AngularSpring: others have no nap"
    require(lean != 0 and np.isfinite(lean), "bristle", kind_of(bristle), needs)
    return bool(nap_is_left(lean))


class Geometry(NamedTuple):
    """What coefficients depend on: `a = A'(0)`, `alpha = F'(0)` in N, slopes allowed."""

    a: Any
    alpha: Any
    lower: Any
    upper: Any

    def of_several(self, times: Any) -> "Geometry":
        """Of as many bristles that pull together; itself where `times` is None."""
        return self if times is None else self._replace(alpha=times * self.alpha)


def geometry(bristle: AbstractBristle) -> Geometry:
    """Of one bristle, traceable. `1 + a omega > 0` is part of the slopes allowed."""
    bare = _on_nearly_flat(bristle)
    a, bounds = bare.a(), bristle.slope_bounds()
    end = -1 / jnp.where(a == 0, 1.0, a)
    lower = jnp.maximum(bounds.lower, jnp.where(a > 0, end, -jnp.inf))
    upper = jnp.minimum(bounds.upper, jnp.where(a < 0, end, jnp.inf))
    return Geometry(a, bare.alpha(), lower, upper)


@Program
def _alone(bristle: AbstractBristle) -> Any:
    """Its geometry, and what alpha is rounded by, as one array: a fetch takes 20 us.

    In place of the coefficients on a surface: 0.1 ms for 1.
    """
    return jnp.stack([*geometry(bristle), rounding_of_alpha(bristle)])


def extreme_slopes(rho_plus: Any, rho_minus: Any, a: Any, alpha: Any) -> tuple[Any, Any]:
    """`omega_plus`, `omega_minus` that give these coefficients (Lemmas 2 and 3, inverted).

    `mu = rho/alpha`, swapped for alpha < 0, and `omega = mu/(1 - a mu)`. Infinite or of the
    wrong sign where no admissible slope does: `a mu >= 1`.
    """
    plus, minus = rho_plus / alpha, rho_minus / alpha
    plus, minus = np.where(alpha > 0, plus, minus), np.where(alpha > 0, minus, plus)
    with np.errstate(divide="ignore"):
        return plus / (1 - a * plus), minus / (1 - a * minus)


def coefficients_of(known: Geometry, plus: Any, minus: Any, xp: Any = jnp) -> Any:
    """`rho_plus`, `rho_minus` in N at slopes `plus` > 0 and -`minus` < 0: (targets, 2)."""
    high = known.alpha * plus / (1 + known.a * plus)
    low = -known.alpha * minus / (1 - known.a * minus)
    swapped = known.alpha < 0
    both = xp.where(swapped, low, high), xp.where(swapped, high, low)
    return xp.stack(both, axis=-1)


def require_targets(
    targets: Any, pulling: bool = False
) -> tuple[list[Target], list[Geometry]]:
    """The targets as a list, checked one by one, and the geometry of their bristles.

    Raises `ValueError` naming the target and the argument: no targets, none of a target,
    a bristle that presses on nothing, or pulls where `pulling` is False, coefficients of
    the wrong sign, shape or not finite, a weight or an uncertainty that is not positive,
    uncertainties for some targets only.
    """
    single = isinstance(targets, Target)
    listed = single or isinstance(targets, list | tuple)
    require(listed, "targets", kind_of(targets), "a Target or a list of them")
    many = [targets] if single else list(targets)
    require(many, "targets", "[]", "at least one Target")
    known = []
    for index, target in enumerate(many):
        name = "target" if single else f"targets[{index}]"
        many[index] = _require_target(name, target)
        known.append(_require_pressing(name, many[index].bristle, pulling))
    given = [target.uncertainty is not None for target in many]
    allowed = "one for every target or for none"
    require(all(given) or not any(given), "uncertainty", None, allowed)
    return many, known


def _require_target(name: str, target: Any) -> Target:
    known = isinstance(target, Target)
    require(known, name, kind_of(target), "a frictionjax.Target")
    bristle = target.bristle
    known = isinstance(bristle, AbstractBristle)
    allowed = "a part of frictionjax.bristles"
    require(known, f"{name}.bristle", kind_of(bristle), allowed)
    require_x64(bristle)
    bristle = checked(bristle)
    known = is_concrete(bristle)
    require(known, f"{name}.bristle", "traced", "numbers: a fit is not traced")
    for label, test in (("rho_plus", _positive), ("rho_minus", _negative)):
        sign = ">" if test is _positive else "<"
        value = getattr(target, label)
        require_real(f"{name}.{label}", value, f"{label} {sign} 0", test)
    require_real(f"{name}.weight", target.weight, "weight > 0", _positive)
    if target.uncertainty is not None:
        _require_uncertainty(f"{name}.uncertainty", target.uncertainty)
    return target._replace(bristle=bristle)


def _require_pressing(name: str, bristle: AbstractBristle, pulling: bool) -> Geometry:
    """The bristle is admissible on a surface that is hardly wavy."""
    *found, noise = np.asarray(_alone(bristle))
    known = Geometry(*found)
    presses = np.isfinite(known.alpha) and abs(known.alpha) > noise
    gentle = SETTINGS.hardly_wavy
    if not (presses and known.lower < -gentle and known.upper > gentle):
        try:
            require_admissible(_on_nearly_flat(bristle))
        except ValueError as problem:
            raise ValueError(f"{name}.{problem}") from None
    if not pulling and known.alpha < 0:
        why = pulling_text(known.alpha, bristle)
        mend = "pulling=True (--pulling in the shell) allows that"
        raise ValueError(f"{name}.bristle: needs alpha > 0, but {why}; {mend}")
    return known


def _positive(value: float) -> bool:
    return value > 0


def _negative(value: float) -> bool:
    return value < 0


def _require_uncertainty(name: str, value: Any) -> None:
    numbers = known_numbers(value)
    allowed = "one number or a pair, > 0 in N"
    require(numbers.dtype != object and numbers.shape in ((), (2,)), name, value, allowed)
    good = np.all(np.isfinite(numbers)) and np.all(numbers > 0)
    require(good, name, value, allowed)
