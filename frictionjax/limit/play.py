"""The rate-independent limit system (eq. 2.3) as one clip after the other."""

from typing import TYPE_CHECKING, Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from .._checks import (
    CodedResult,
    Outcome,
    Real,
    as_jax,
    is_concrete,
    is_known,
    no_less,
    no_more,
    noting_the_scene,
    require,
    with_nan,
)
from .._compile import Program
from .._text import Named, SelfDrawn, ShownNumbers, dataset_over_time
from ..coefficients import Coefficients
from ..effects import Engine, NapFlip, nap_flip_among
from ..loads import AbstractPull, turning_points_of
from ..model import (
    Scene,
    are_times_of,
    coefficients_jit,
    dissipation_potential,
    known_turning_points,
    require_times,
    scene_for,
    strip_of,
    strips_at,
)
from ..supports import AbstractSupport
from .corners import at_times_that_stay, times_that_move, with_slopes_of

if TYPE_CHECKING:
    import xarray as xr

_COLUMNS = {
    "z": ("m", "state of the limit system"),
    "dissipation": ("J", "energy dissipated since t = 0, int R(z')"),
    "root": ("m", "root u of the rod"),
    "tip": ("m", "tip p of the rod"),
    "mode": ("1", "1: the rod as it stands at first; -1: turned over; 0: in between"),
}
_ROUNDED = 4 * float(np.finfo(float).eps)  # of a strip's edges


class LimitStatus(Outcome):
    """Why a limit solution can or cannot be trusted; `message` says it for people."""

    OK = 0, "every number can be trusted"
    NOT_FINITE = 1, "not finite: traced numbers are out of range, or turns have no room"


class LimitSolution(ShownNumbers, SelfDrawn, CodedResult, eqx.Module):
    """Limit trajectory: times `ts` (s), states `z` (m), `dissipation` (J), shapes (n,).

    `dissipation` is cumulative, `int_0^ts R(z')`. `ok`, `status`: not finite only where
    the scene was traced, so that nothing could be checked. Of a scene with
    `effects.NapFlip` also `root` u and `tip` p in m and `mode`: 1 as the rod stands at
    first, -1 turned over, 0 in between; None of others.
    """

    ts: Float[Array, " n"]
    z: Float[Array, " n"]
    dissipation: Float[Array, " n"]
    root: Float[Array, " n"] | None = None
    mode: Int[Array, " n"] | None = None
    tip: Float[Array, " n"] | None = None
    _outcomes = LimitStatus
    _picture = "draw_solution"

    @property
    def _codes(self) -> Any:
        by = np if is_known(self.z, self.dissipation) else jnp
        good = by.all(by.isfinite(self.z) & by.isfinite(self.dissipation), axis=-1)
        return by.where(good, int(LimitStatus.OK), int(LimitStatus.NOT_FINITE))

    def to_dataset(self) -> "xr.Dataset":
        """What there is over the dimension `time` (s), with units and how it ended.

        Raises `ValueError` of a batch.

        >>> data = fx.solve_limit(scene, ts=[0.0, 0.75, 3.0]).to_dataset()
        >>> print(f"{data.z.sel(time=0.75):.3f} {data.z.units}: {data.message}")
        0.930 m: every number can be trusted
        """
        require(np.ndim(self.z) == 1, "solution", "a batch", "one trajectory")
        ended = {"status": self.status.name, "message": self.message}
        return dataset_over_time(self, _COLUMNS, ended)

    def _in_words(self) -> str:
        codes, count = self._codes, np.shape(self.z)[-1]
        batch = f"batch {codes.shape}: " if codes.ndim else ""
        return f"LimitSolution({batch}{self._ended}, {count} times)"

    def _numbers(self) -> list[Named]:
        modes = None if self.mode is None else self.mode[..., -1]
        return [
            Named("time", self.ts[..., -1], "s", "the last one"),
            Named("z", self.z[..., -1], "m", "the state then"),
            Named("mode", modes, "", "1 as the rod stood at first, -1 turned over"),
            Named("dissipation", self.dissipation[..., -1], "J", "into friction"),
        ]


def strip(support: AbstractSupport, found: Coefficients, load: Real) -> tuple[Real, Real]:
    """States that rest under `load` (N): `[z_minus, z_plus]` in m (Section 5.1)."""
    return strip_of(support, found.rho_plus, found.rho_minus, load)


def play_step(support: AbstractSupport, found: Coefficients, z: Real, load: Real) -> Real:
    """The limit state after a monotone change of the load to `load`, from state `z`."""
    lower, upper = strip(support, found, load)
    return jnp.clip(z, lower, upper)


def _clipped(
    strips: tuple[Float[Array, " m"], Float[Array, " m"]], z0: Real, found: Coefficients
) -> tuple[Float[Array, " m"], Float[Array, " m"]]:
    """State and cumulative dissipation on a grid, of the strips (m) at its points.

    The grid is sorted and holds the turning points: between grid points the load is
    monotone, so the solution is too, and a clip to the strip at the grid point is exact:
    there is no time-stepping error. (An associative scan of the clips has the same values,
    but took 7.5 s to compile for 65536 points where this takes 0.04, and ran 15 times as
    long.)
    """

    def clipped(z: Array, strip: tuple[Array, Array]) -> tuple[Array, Array]:
        z = jnp.clip(z, *strip)
        return z, z

    _, z = jax.lax.scan(clipped, jnp.asarray(z0, strips[0].dtype), strips)
    moves = jnp.diff(z, prepend=z0)
    spent = dissipation_potential(found.rho_plus, found.rho_minus, moves)
    return z, jnp.cumsum(spent)


@Program
def _limit_at(
    load: AbstractPull,
    support: AbstractSupport,
    z0: Real,
    turns: Float[Array, " turns"],
    found: Coefficients,
    ts: Float[Array, " n"],
) -> tuple[Float[Array, " n"], Float[Array, " n"]]:
    loads_at = jax.vmap(load)
    strips_of = jax.vmap(lambda load: strip(support, found, load))
    grid = jnp.concatenate([ts, turns])
    times, beside = times_that_move(ts, turns)
    order = jnp.argsort(grid)
    moving = jnp.concatenate([times, turns])[order]
    strips = strips_of(with_slopes_of(loads_at(grid[order]), loads_at(moving)))
    z, dissipation = _clipped(strips, z0, found)
    back = jnp.argsort(order)[: ts.shape[0]]
    z, dissipation = z[back], dissipation[back]
    slopes = jnp.where(beside, jax.vmap(load.slope)(times), 0.0)
    edges = strips_of(loads_at(ts)), (strips[0][back], strips[1][back])
    stays = at_times_that_stay(z, dissipation, slopes, *edges, found)
    z, dissipation = map(with_slopes_of, (z, dissipation), stays)
    # Too little room for the turning points of a traced load is NaN, never a wrong number,
    # and so are derivatives: added, NaN would leave them as they are.
    poison = jnp.where(jnp.any(jnp.isnan(turns)), jnp.nan, 1.0)
    return z * poison, dissipation * poison


def play_operator(
    lower: Float[np.ndarray, " n"], upper: Float[np.ndarray, " n"], z0: float
) -> Float[np.ndarray, " n"]:
    """The play operator on known strips: one clip after the other, from `z0`.

    NaN from the first strip on that is NaN.
    """
    z, found = z0, np.empty_like(lower)
    for index, (low, high) in enumerate(zip(lower.tolist(), upper.tolist(), strict=True)):
        z = found[index] = min(max(z, low), high)
    found[np.maximum.accumulate(np.isnan(lower) | np.isnan(upper))] = np.nan
    return found


def _solve(scene: Scene, found: Coefficients, ts: Float[Array, " n"]) -> LimitSolution:
    if not is_concrete(scene, ts):
        # Turning points do not move with the duration, and what fills their room is none.
        until = jax.lax.stop_gradient(jnp.asarray(scene.duration))
        corners = turning_points_of(scene.load, until, scene.turns)
        parts = scene.load, scene.support, scene.z0, corners
        # What known numbers would be refused for is NaN; as a factor: derivatives too.
        good = are_times_of(scene, ts) & _starts_in_strip(scene, found)
        columns = _limit_at(*parts, found, ts)
        return LimitSolution(ts, *(c * jnp.where(good, 1.0, jnp.nan) for c in columns))
    # Known numbers compile nothing, whatever the parts.
    turns = known_turning_points(scene.load, scene.duration, scene.turns)
    grid = np.concatenate([ts, turns])
    order, z0 = np.argsort(grid, kind="stable"), float(scene.z0)
    rho_plus, rho_minus = float(found.rho_plus), float(found.rho_minus)
    _, lower, upper = strips_at(scene, rho_plus, rho_minus, grid[order])
    z, back = play_operator(lower, upper, z0), np.argsort(order)[: ts.size]
    moves = np.diff(z, prepend=z0)
    spent = np.cumsum(np.where(moves >= 0, rho_plus * moves, rho_minus * moves))
    if np.any(np.isnan(turns)):  # more than there is room for
        z, spent = np.full_like(z, np.nan), np.full_like(z, np.nan)
    return LimitSolution(ts, as_jax(z[back]), as_jax(spent[back]))


def _starts_in_strip(scene: Scene, found: Coefficients) -> Bool[Array, ""]:
    """As `require_start_in_strip` asks, of traced numbers."""
    lower, upper = strip(scene.support, found, scene.load(jnp.zeros(())))
    slack = _ROUNDED * jnp.maximum(jnp.abs(lower), jnp.abs(upper))
    return (scene.z0 >= lower - slack) & (scene.z0 <= upper + slack)


def require_start_in_strip(scene: Scene) -> None:
    """Check that z0 lies in the strip at t = 0, as Theorem 1 asks (eq. 2.10).

    Of a rod that turns over, in what it withstands as it stands at first: that is less.
    """
    if not is_concrete(scene):
        return
    turning = nap_flip_among(scene.effects)
    if turning is not None:
        from ..turning import limit_course  # nothing else needs it

        limit_course(scene, turning)
        return
    found = coefficients_jit(scene.potential)
    strips = strips_at(scene, float(found.rho_plus), float(found.rho_minus), np.zeros(1))
    _, lower, upper = (float(v[0]) for v in strips)
    slack = _ROUNDED * max(abs(lower), abs(upper))
    z0 = float(scene.z0)
    low, high = no_less(lower, 9), no_more(upper, 9)
    needs = f"z_minus(0) <= z0 <= z_plus(0), the interval [{low}, {high}]"
    require(lower - slack <= z0 <= upper + slack, "scene.z0", z0, needs)


def _with_turning(scene: Scene, effect: NapFlip, ts: Float[Array, " n"]) -> LimitSolution:
    from ..turning import hybrid_play  # nothing else needs it

    known = is_concrete(scene, ts)
    require(known, "scene", "traced numbers", "known ones, as it has effects.NapFlip")
    found = hybrid_play(scene, effect, np.asarray(ts))
    columns = found.z, found.dissipation, found.root, found.mode, found.tip
    return LimitSolution(ts, *map(as_jax, columns))


@noting_the_scene
@with_nan
def solve_limit(scene: Scene, ts: Any = None) -> LimitSolution:
    """Solve `0 in dR(z') + Phi'(z) - l(t)` (eq. 2.3) of a `scene`, exactly up to rounding.

    `ts`: times in s, not decreasing, in [0, duration], shape (n,); 201 evenly spaced ones
    where None. The grid inside always holds the turning points of the load, so values do
    not depend on which other times are asked for. Of a scene with `effects.Inertia` it is
    the limit of the scene without mass, to compare with.

    Returns a `LimitSolution`: `.ts` (s), `.z` (m), `.dissipation` (J), shapes (n,), `.ok`,
    `.status`.

    Raises `ValueError` for bad times, 32 bits, or z0 outside the strip at t = 0 (with the
    allowed interval); of traced numbers times and z0 of that kind are NaN, and a status.
    Source: the play operator, see A. Mielke and T. Roubicek,
    Rate-Independent Systems (2015).

    With `effects.NapFlip` it is a play operator with modes: between its slides the root
    follows the load over the pinned tip, or jumps, which loses energy too.

    >>> limit = fx.solve_limit(scene, ts=[0.0, 0.75, 2.25, 3.0])
    >>> print(limit.z.round(4))
    [ 0.      0.9296 -0.9621 -0.1204]
    """
    scene = scene_for(Engine.LIMIT, scene)
    ts = require_times(scene, ts)
    turning = nap_flip_among(scene.effects)
    if turning is not None:
        return _with_turning(scene, turning, ts)
    require_start_in_strip(scene)
    return _solve(scene, coefficients_jit(scene.potential), ts)
