"""The wiggly potential `V_eps` (eq. 2.5), of a bristle or given directly."""

import abc
import inspect
from collections.abc import Callable
from functools import partial
from typing import ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from .._checks import (
    Part,
    Real,
    as_plain,
    call_text,
    checked,
    is_concrete,
    kind_of,
    part_text,
    require,
    require_function,
    require_whole,
    require_x64,
)
from ..bristles import AbstractBristle
from ..numerics import (
    LeadingTerm,
    RestTerm,
    bracketed_root,
    increment,
    mean_slope,
    second_remainder,
    smallest,
)
from ..profiles import AbstractProfile, require_smooth
from .settings import SETTINGS


def _slope(fn: Callable[[Real], Real], x: Real) -> tuple[Real, Real]:
    return jax.jvp(fn, (x,), (jnp.ones_like(x),))


class AbstractPotential(Part):
    """`V_eps(z) = eps W(Y) + eps^2 Q(eps; Y)` with `Y = z/eps`, lengths in m, V in J.

    An implementer gives the potential in the tip coordinate `y = p/eps`, in which nothing
    has to be inverted, as scalar functions that are 1-periodic in `y`; and the two parts
    of the expansion, computed without cancellation.
    """

    @abc.abstractmethod
    def offset(self, y: Real, eps: Real) -> Real:
        """`z - p = A(eps w(y))` in m, at tip coordinate `y` in periods."""

    @abc.abstractmethod
    def tip_energy(self, y: Real, eps: Real) -> Real:
        """`V_eps` in J at the tip coordinate `y`."""

    @abc.abstractmethod
    def tip_energy_change(self, y: Real, eps: Real) -> Real:
        """`V_eps` in J as a difference of energies: cheap, digits lost at small eps."""

    @abc.abstractmethod
    def well_coordinate(self, Y: Real, eps: Real) -> Real:
        """The tip coordinate `y` that belongs to the state `Y`, both near 0."""

    @abc.abstractmethod
    def _leading(self, Y: Real) -> Real:
        """`W` for |Y| <= 1/2."""

    @abc.abstractmethod
    def _rest(self, eps: Real, Y: Real) -> Real:
        """`Q` for |Y| <= 1/2."""

    @property
    @abc.abstractmethod
    def points(self) -> int:
        """How many samples a period resolve `W'`."""

    def tip(
        self, z: Float[ArrayLike, "*z"], eps: Float[ArrayLike, "*eps"]
    ) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
        """Well number and tip coordinate inside that well: `p = eps (number + inside)`.

        z in m and eps in m, any shapes that broadcast.
        """
        # Known numbers too: op by op each call compiles its own loop.
        if jnp.ndim(z) or jnp.ndim(eps) or is_concrete(self, z, eps):
            return _elementwise(type(self).tip, self, *_floats(self, z, eps))
        Y = jnp.asarray(z / eps)
        number = jnp.round(Y)
        return number, self.well_coordinate(Y - number, jnp.asarray(eps))

    def tip_force(self, y: Real, eps: Real) -> tuple[Real, Real]:
        """`V_eps'(z)` in N and `G = dz/dp` at the tip coordinate `y`."""
        force, stretch, _ = self.at_tip(y, eps)
        return force, stretch

    def at_tip(self, y: Real, eps: Real) -> tuple[Real, Real, Real]:
        """`V_eps'(z)` in N, `G = dz/dp` and the `offset` in m at the tip coordinate `y`."""
        offset, ahead = _slope(lambda s: self.offset(s, eps), y)
        _, climb = _slope(lambda s: self.tip_energy(s, eps), y)
        stretch = 1 + ahead / eps
        return climb / (eps * stretch), stretch, offset

    def energy(
        self, z: Float[ArrayLike, "*z"], eps: Float[ArrayLike, "*eps"]
    ) -> Float[Array, "..."]:
        """`V_eps(z)` in J; z in m and eps in m, any shapes that broadcast."""
        return _elementwise(type(self)._energy, self, *_floats(self, z, eps))

    def force(
        self, z: Float[ArrayLike, "*z"], eps: Float[ArrayLike, "*eps"]
    ) -> Float[Array, "..."]:
        """`V_eps'(z)` in N by autodiff of the exact inverse; shapes as `energy`."""
        return _elementwise(_energy_slope, self, *_floats(self, z, eps))

    def W(self, Y: Float[ArrayLike, "*Y"]) -> Float[Array, "*Y"]:
        """Leading part `W(Y)` in N (Lemma 2), any shape."""
        return _elementwise(_leading_anywhere, self, *_floats(self, Y))

    def Q(
        self, eps: Float[ArrayLike, "*eps"], Y: Float[ArrayLike, "*Y"]
    ) -> Float[Array, "..."]:
        """Rest `Q(eps; Y)` in N/m, bounded as eps -> 0; defined at eps = 0 too.

        There it has first derivatives by eps.
        """
        return _elementwise(_rest_anywhere, self, *_floats(self, eps, Y))

    def _energy(self, z: Real, eps: Real) -> Real:
        return self.tip_energy(self.tip(z, eps)[1], eps)


def _floats(potential: AbstractPotential, *values):
    require_x64(potential, values)
    return tuple(jnp.asarray(value, dtype=float) for value in values)


@eqx.filter_jit
def _elementwise(fn: Callable, potential: AbstractPotential, *values):
    rank = max(value.ndim for value in values)
    values = tuple(jax.lax.broadcast_to_rank(value, rank) for value in values)
    return jnp.vectorize(lambda *scalars: fn(potential, *scalars))(*values)


def _energy_slope(potential: AbstractPotential, z: Real, eps: Real) -> Real:
    return jax.grad(potential._energy)(z, eps)


def _leading_anywhere(potential: AbstractPotential, Y: Real) -> Real:
    return potential._leading(Y - jnp.round(Y))


def _rest_anywhere(potential: AbstractPotential, eps: Real, Y: Real) -> Real:
    return potential._rest(eps, Y - jnp.round(Y))


class BristlePotential(AbstractPotential):
    """`V_eps(z) = F(w_eps(p(z))) - F(0)` with `z = p + A(w_eps(p))` (eqs. 2.16, 3.21)."""

    profile: AbstractProfile
    bristle: AbstractBristle

    def offset(self, y: Real, eps: Real) -> Real:
        return self.bristle.offset(eps * self.profile(y))

    def tip_energy(self, y: Real, eps: Real) -> Real:
        return increment(self.bristle.energy, eps * self.profile(y))

    def tip_energy_change(self, y: Real, eps: Real) -> Real:
        end = self.bristle.energy(eps * self.profile(y))
        return end - self.bristle.energy(jnp.zeros_like(y))

    def at_tip(self, y: Real, eps: Real) -> tuple[Real, Real, Real]:
        # The chain rule by hand: F' and A' once each, not through `increment`.
        height, slope = _slope(self.profile, y)
        offset, ahead, climb = self.bristle.with_slopes(eps * height)
        stretch = 1 + ahead * slope
        return climb * slope / stretch, stretch, offset

    def well_coordinate(self, Y: Real, eps: Real) -> Real:
        def state(y: Real) -> Real:
            return y + increment(self.bristle.offset, eps * self.profile(y)) / eps

        return _invert(state, Y)

    @property
    def points(self) -> int:
        return self.profile.points

    def a(self) -> Real:
        """`A'(0)`."""
        return _slope(self.bristle.offset, jnp.zeros(()))[1]

    def alpha(self) -> Real:
        """`F'(0)` in N (eq. 2.13)."""
        return _slope(self.bristle.energy, jnp.zeros(()))[1]

    def flat_tip(self, Y: Real) -> Real:
        """`g^-1(Y)` with `g(y) = y + a w(y)` (Lemma 3): the tip coordinate at eps = 0."""
        a = self.a()
        return _invert(lambda y: y + a * self.profile(y), Y)

    def _leading(self, Y: Real) -> Real:
        return self.alpha() * self.profile(self.flat_tip(Y))

    def _tip_near(self, eps: Real, flat: Real) -> Real:
        """The tip coordinate that is `flat` at eps = 0, with its first derivative there."""
        height, slope = _slope(self.profile, flat)
        bend = second_remainder(self.bristle.offset, jnp.zeros_like(flat))
        return flat - eps * height**2 * bend / (1 + self.a() * slope)

    def _rest(self, eps: Real, Y: Real) -> Real:
        # With eta = eps w(y), A = a eta + eta^2 C and F = F(0) + alpha eta + eta^2 B,
        # y - y_flat = -eps w^2 C/(1 + a m) and w(y) - w(y_flat) = m (y - y_flat), m the
        # mean slope of w between the two: Q = w^2 (B - alpha m C/(1 + a m)), no 1/eps.
        safe = jnp.where(eps == 0, 1e-30, eps)  # any bristle reaches that far
        flat = self.flat_tip(Y)
        # Where eps is 0 the inverse is that of another eps, with no derivative by this one.
        at_zero = self._tip_near(eps, flat)
        y = jnp.where(eps == 0, at_zero, self.well_coordinate(Y, safe))
        height = self.profile(y)
        curved_offset = second_remainder(self.bristle.offset, eps * height)
        curved_energy = second_remainder(self.bristle.energy, eps * height)
        slope = mean_slope(self.profile, flat, y)
        bend = self.alpha() * slope * curved_offset / (1 + self.a() * slope)
        return height**2 * (curved_energy - bend)


def _invert(state: Callable[[Real], Real], Y: Real) -> Real:
    """Solve state(y) = Y, where state(y) - y is 1-periodic and state increases.

    state(y) - y varies by less than 1 then, so the root lies within 1 of Y - state(0).
    """
    centre = Y - state(jnp.zeros_like(Y))
    return bracketed_root(lambda y: state(y) - Y, centre - 1, centre + 1)


def no_rest(eps: Real, Y: Real) -> Real:
    """`Q` of a potential that is `eps W` alone."""
    return jnp.zeros_like(Y)


def _takes_two(fn: Callable) -> bool:
    try:
        inspect.signature(fn).bind(None, None)
    except TypeError:
        return False
    except ValueError:
        pass  # no signature to be had
    return True


def _require_of_two(name: str, fn: Callable) -> None:
    needs = "a function of (eps, Y)"
    require(callable(fn) and _takes_two(fn), name, fn, needs)
    require_function(name, partial(fn, jnp.asarray(1e-3)), needs)


class GivenPotential(AbstractPotential):
    """The abstract setting: `W` and `Q` as functions (eq. 2.5), z its own tip coordinate.

    `W_fn(Y)` in N: 1-periodic, C^2; `Q_fn(eps, Y)` in N/m: 1-periodic and C^2 in Y, and
    bounded with its derivative as eps -> 0; scalar functions written with `jax.numpy`. Q is
    looked at where an eps is in use, and refused there. `points` samples a period must
    resolve W'.

    Raises `ValueError` where `W` does not repeat as a C^2 function or is constant.

    >>> import jax.numpy as jnp
    >>> given = fx.GivenPotential(W=lambda Y: 0.02 * jnp.sin(2 * jnp.pi * Y))
    >>> spring, load = scene.support, scene.load
    >>> bare = fx.Scene(potential=given, support=spring, load=load, duration=3.0)
    >>> fx.friction(bare)
    Coefficients(rho_plus=0.125664, rho_minus=-0.125664)
    """

    _stored: ClassVar = {"W": "W_fn", "Q": "Q_fn"}

    W_fn: Callable[[Real], Real]
    Q_fn: Callable[[Real, Real], Real]
    points: int = eqx.field(static=True, default=4096, converter=as_plain)

    def __init__(self, W: Callable, Q: Callable | None = None, points: int = 4096):
        self.W_fn = W
        self.Q_fn = no_rest if Q is None else Q
        self.points = points

    @classmethod
    def from_energy(
        cls,
        F: Callable[[Real], Real],
        WW: Callable[[Real], Real],
        QQ: Callable[[Real, Real], Real] | None = None,
        points: int = 4096,
    ) -> "GivenPotential":
        """`V_eps(z) = F(eps WW(Y) + eps^2 QQ(eps; Y)) - F(0)` (eq. 2.16), by Lemma 2.

        `F(u)` in J, of a length u in m: C^3 around 0, `alpha = F'(0)` not 0, of either
        sign. `WW(Y)` and `QQ(eps, Y)`, numbers and 1/m: 1-periodic and C^2 in Y. Scalar
        functions written with `jax.numpy`. `points` samples a period must resolve WW'.

        Returns the potential with `W = alpha WW` and a Q that keeps all digits at any eps:
        written by hand, as a difference divided by eps^2, it has 4 digits left at eps =
        1e-6 and hardly one at 1e-8. `friction` of it tells alpha and mu too.

        Raises `ValueError` where a function is none, alpha is 0, or W is no C^2 function
        that repeats.

        >>> import jax.numpy as jnp
        >>> spring = lambda u: 0.5 * (1.0 + u) ** 2
        >>> wave = lambda Y: 0.02 * jnp.sin(2 * jnp.pi * Y)
        >>> given = fx.GivenPotential.from_energy(spring, wave)
        >>> print(given.W(0.25), f"{given.Q(1e-8, 0.25):.6f}")
        0.02 0.000200
        """
        require_function("F", F, "a function of a length u", smooth=False)
        require_function("WW", WW, "a function of Y")
        if QQ is not None:
            _require_of_two("QQ", QQ)
        leading = LeadingTerm(F, WW)
        alpha, beside = leading.alpha(), leading.slopes_beside()
        if is_concrete(alpha):
            known = bool(jnp.isfinite(alpha)) and float(alpha) != 0.0
            require(known, "F: alpha = F'(0)", float(alpha), "a finite alpha != 0")
            kink = float(beside[1] - beside[0])
            same = abs(kink) <= 1e-9 * abs(float(alpha))
            require(same, "F: F' at 0 jumps by", kink, "a C^3 function")
        return cls(leading, RestTerm(leading, QQ), points)

    def alpha(self) -> Real | None:
        """`F'(0)` in N of a potential made `from_energy`, None of others."""
        leading = self.W_fn
        return leading.alpha() if isinstance(leading, LeadingTerm) else None

    def __check_init__(self):
        require_function("potential.W", self.W_fn, "a function of Y")
        if self.Q_fn is not no_rest:
            _require_of_two("potential.Q", self.Q_fn)
        require_whole("potential.points", self.points, 16)
        require_smooth("potential.W", self._leading_inside, self.points)

    def __repr__(self) -> str:
        if isinstance(self.W_fn, LeadingTerm):
            leading, rest = self.W_fn, getattr(self.Q_fn, "rest", None)
            given = {"F": leading.energy, "WW": leading.wiggle, "QQ": rest}
            given |= {} if self.points == 4096 else {"points": self.points}
            return call_text("GivenPotential.from_energy", given)
        without = ("Q",) if self.Q_fn is no_rest else ()
        return part_text(self, [n for n in ("W", "Q", "points") if n not in without])

    def _leading_inside(self, Y: Real) -> Real:
        return jnp.asarray(self.W_fn(Y))

    def offset(self, y: Real, eps: Real) -> Real:
        return jnp.zeros_like(y)

    def tip_energy(self, y: Real, eps: Real) -> Real:
        Y = y - jnp.floor(y)
        return eps * self.W_fn(Y) + eps**2 * self.Q_fn(eps, Y)

    def tip_energy_change(self, y: Real, eps: Real) -> Real:
        return self.tip_energy(y, eps)

    def well_coordinate(self, Y: Real, eps: Real) -> Real:
        return Y

    def _leading(self, Y: Real) -> Real:
        return jnp.asarray(self.W_fn(Y - jnp.floor(Y)))

    def _rest(self, eps: Real, Y: Real) -> Real:
        return jnp.asarray(self.Q_fn(eps, Y - jnp.floor(Y)))


def potential(profile: AbstractProfile, bristle: AbstractBristle) -> BristlePotential:
    """The wiggly potential of a `bristle` on a surface, `profile` (eqs. 2.16, 3.21).

    Returns an object with `.energy(z, eps)`, V_eps in J, `.force(z, eps)`, V_eps' in N,
    `.W(Y)` in N and `.Q(eps, Y)` in N/m (Lemma 2); z and eps in m, Y = z/eps, any shape.

    Raises `ValueError` for arguments of another kind.

    >>> wiggly = fx.potential(scene.profile, scene.bristle)
    >>> print(f"V_eps' = {wiggly.force(0.0, eps=0.01):.4f} N, W = {wiggly.W(0.25):.4f} N")
    V_eps' = 0.1204 N, W = 0.0160 N
    """
    known = isinstance(profile, AbstractProfile)
    require(known, "profile", kind_of(profile), "a part of frictionjax.profiles")
    known = isinstance(bristle, AbstractBristle)
    require(known, "bristle", kind_of(bristle), "a part of frictionjax.bristles")
    return BristlePotential(checked(profile), checked(bristle))


def smallest_stretch(
    potential: AbstractPotential, eps: Real, points: int | None = None
) -> Real:
    """Smallest `G = dz/dp` over a period, NaN where the bristle does not reach.

    A scan, then a finer one around its minimum and around the ends of the offset, where
    the bristle reaches last.
    """
    count = points or potential.points
    grid = jnp.arange(count) / count
    look = jax.vmap(lambda y: potential.at_tip(y, eps)[1:])
    coarse, offset = look(grid)
    places = [jnp.argmin(coarse), jnp.argmin(offset), jnp.argmax(offset)]
    around = np.linspace(-1, 1, SETTINGS.zoom + 1)[None] / count
    fine = grid[jnp.stack(places)][:, None] + around
    return smallest(jnp.concatenate([coarse, look(fine.ravel())[0]]))
