"""What is simulated, as data."""

import dataclasses
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from .._checks import (
    ByIdentity,
    Real,
    as_real,
    as_text,
    asked_names,
    checked,
    eagerly,
    exchanged,
    floor_above,
    in_64_bits,
    is_checked,
    is_concrete,
    is_known,
    kind_of,
    known_numbers,
    mark_checked,
    no_less,
    no_more,
    notebook_text,
    part_text,
    require,
    require_real,
    require_x64,
)
from .._compile import Interpreted
from .._text import ResultTable, SelfDrawn
from ..bristles import AbstractBristle, pulling_text
from ..effects import AbstractEffect, require_bristle, require_together
from ..loads import AbstractLoad, AbstractPull, Pulled, turning_points_of
from ..profiles import AbstractProfile
from ..supports import AbstractSupport
from ..tables import load_table
from .admissibility import admissible_coefficients, require_convex
from .potentials import AbstractPotential, BristlePotential, potential
from .scene_loads import held_load, known_turning_points, padded_edges
from .settings import SETTINGS

_ANEW = ByIdentity()  # the scene built of one with other leaves
_FAR = ByIdentity()  # the largest |z| in m that the load reaches
_ALPHA = ByIdentity()  # the normal force in N that was computed when it was checked


class Scene(SelfDrawn, eqx.Module):
    """A bristle on a wiggly surface, pulled through a support by a load.

    `Scene(profile, bristle, support, load, duration, z0=0.0, effects=())`, or
    `Scene(potential=GivenPotential(W, Q), support=..., load=..., duration=...)`.

    `duration` T in s, `z0` the state at t = 0 in m. `effects`: what else the scene calls
    for; a scene without effects is the plain system of the paper.

    All numbers are traced leaves. Only the room for turning points of the load is static
    (`turns`, a power of two), so a scene of the same shape and other values compiles
    nothing new.

    `scene.replace(duration=6.0)` is the scene with other arguments, built anew. Scenes
    changed leaf by leaf (`equinox.tree_at`) are checked, and given their room, where they
    are used; where their numbers are traced the room is what it was, and where it is too
    small results have a status that says so.

    Raises `ValueError` for parts of another kind, a duration that is not positive, and
    every hypothesis of the paper that can be told without eps: see `friction`, and
    `Phi` uniformly convex on the range that the load reaches.

    >>> longer = scene.replace(duration=6.0, z0=0.05)
    >>> print(fx.solve_limit(longer, ts=[0.0, 3.0, 6.0]).z.round(4))
    [ 0.05   -0.1204 -0.1204]
    """

    potential: AbstractPotential
    support: AbstractSupport
    load: AbstractLoad
    duration: Real
    z0: Real
    effects: tuple
    turns: int = eqx.field(static=True, init=False)
    _picture = "draw_parts"

    def __init__(
        self,
        profile: AbstractProfile | None = None,
        bristle: AbstractBristle | None = None,
        support: AbstractSupport | None = None,
        load: AbstractLoad | None = None,
        duration: Any = None,
        z0: Any = 0.0,
        effects: tuple = (),
        *,
        potential: AbstractPotential | None = None,
    ):
        self.potential = _potential_of(profile, bristle, potential)
        self.support = _part("support", support, AbstractSupport)
        load = _part("load", load, AbstractLoad)
        require(duration is not None, "scene.duration", None, "a time > 0 in s")
        self.duration, self.z0 = _as_known(duration), as_real(z0)
        self.effects = _effects_of(effects, self.bristle)
        require_real("scene.duration", self.duration, "duration > 0", lambda t: t > 0)
        require_real("scene.z0", self.z0, "a position in m")
        load, self.turns = _with_turns(load, self.duration)
        self.load = held_load(load, self.support, self.potential)
        _require_hypotheses(self)

    def __check_init__(self):
        mark_checked(self)

    def replace(self, **changes: Any) -> "Scene":
        """The scene with other constructor arguments, by name, built and checked anew.

        `scene.replace(load=scene.load.replace(period=1.0))` changes a number of a part.
        Raises `ValueError` for names that there are not, and as the constructor does.

        >>> faster = scene.replace(load=scene.load.replace(period=1.0), duration=1.0)
        >>> faster.load
        Sine(amplitude=1.05, period=1)
        """
        known = asked_names(Scene, changes)
        given = {name: getattr(self, name) for name in known}
        # The wiggly potential is given, or follows from profile and bristle.
        if "potential" in changes or not changes.keys() & {"profile", "bristle"}:
            del given["profile"], given["bristle"]
        else:
            del given["potential"]
        return Scene(**(given | changes))

    def __replace__(self, **changes: Any) -> "Scene":
        return self.replace(**changes)

    def __repr__(self) -> str:
        alpha = _ALPHA.get(self)
        pulls = "" if alpha is None else pulling_text(alpha)
        names = asked_names(Scene, {})
        if self.profile is None:
            names = ["potential", *(n for n in names if n not in ("profile", "bristle"))]
        else:
            names.remove("potential")
        return f"{part_text(self, names)}{f': {pulls}' if pulls else ''}"

    def table(self) -> ResultTable:
        """A line for each number of a part, with its unit and what it is.

        Raises `ValueError` under a trace, where nothing is known yet.

        >>> scene.table()
        part     kind           number       value  unit  meaning
        scene                   duration         3  s     how long the load acts
        scene                   z0               0  m     state at the start
        profile  Sine           slope          0.1  1     steepest slope of the surface
        ...
        """
        require(is_known(self), "Scene", "a trace", "known numbers")
        return floor_above("io").part_rows(self)

    def _repr_html_(self) -> str:
        return notebook_text(self, self.table)

    @property
    def profile(self) -> AbstractProfile | None:
        """The surface profile; None in the abstract setting."""
        if isinstance(self.potential, BristlePotential):
            return self.potential.profile
        return None

    @property
    def bristle(self) -> AbstractBristle | None:
        """The bristle; None in the abstract setting."""
        if isinstance(self.potential, BristlePotential):
            return self.potential.bristle
        return None

    def turning_points(self) -> Float[Array, " turns"]:
        """Turning points of the load in (0, T), shape (turns,), padded with T."""
        return turning_points_of(self.load, jnp.asarray(self.duration), self.turns)


def _as_known(duration: Any) -> Any:
    """As a leaf that stays known inside a caller's `jit`, where turns can be found then."""
    if not is_known(duration):
        return as_real(duration)
    with eagerly(duration):
        return as_real(duration)


def _potential_of(profile, bristle, given) -> AbstractPotential:
    if given is None:
        return potential(profile, bristle)
    for name, part in (("profile", profile), ("bristle", bristle)):
        needs = f"none beside potential; `scene.replace({name}=...)` exchanges it"
        require(part is None, f"scene.{name}", kind_of(part), needs)
    known = isinstance(given, AbstractPotential)
    require(known, "scene.potential", kind_of(given), "a GivenPotential")
    return checked(given)


def _part(name: str, part: Any, kind: type) -> Any:
    needs = f"a part of frictionjax.{name}s"
    require(isinstance(part, kind), f"scene.{name}", kind_of(part), needs)
    return checked(part)


def _effects_of(given: Any, bristle: Any) -> tuple[AbstractEffect, ...]:
    row = isinstance(given, tuple | list)
    good = row and all(isinstance(effect, AbstractEffect) for effect in given)
    needs = "effects of frictionjax.effects, as (effects.LeadingOrder(),)"
    require(good, "scene.effects", given, needs)
    effects = tuple(checked(effect) for effect in given)
    require_together(effects)
    require_bristle(effects, bristle)
    return effects


def _with_turns(load: AbstractLoad, duration: Any) -> tuple[AbstractLoad, int]:
    """All that follows from load and duration: what the load does, room for its turns."""
    load = load.prepared(duration)
    return load, _room_for_turns(load, duration)


def _room_for_turns(load: AbstractLoad, duration: Any) -> int:
    if not is_concrete(load, duration):
        return SETTINGS.traced_turns
    count = load.turning_count(float(duration))
    allowed = f"at most {SETTINGS.most_turns} in [0, duration]"
    require(count <= SETTINGS.most_turns, "load: turning points", count, allowed)
    return 1 << max(2, (count - 1).bit_length()) if count else 0


def _edges(scene: Scene) -> np.ndarray:
    turns = known_turning_points(scene.load, scene.duration, scene.turns)
    return padded_edges(turns, scene.duration)


@Interpreted
def _forces_met(
    load: AbstractPull, support: AbstractSupport, edges: Array, z0: Real
) -> tuple[Real, Real, Real]:
    """Smallest and largest load, monotone between edges, and Phi' at z0, in N."""
    values = jax.vmap(load)(edges)
    return jnp.min(values), jnp.max(values), support.force(z0)


def forces_met(scene: Scene) -> tuple[float, float, float]:
    """Smallest and largest load of a known scene, and Phi' at z0, in N."""
    parts = load_table(scene.load), scene.support
    met = _forces_met(*parts, _edges(scene), np.asarray(scene.z0))
    low, high, start = (float(v) for v in met)
    return low, high, start


def _require_hypotheses(scene: Scene) -> None:
    if not is_concrete(scene) or not in_64_bits():
        return  # traced values cannot be looked at; 32 bits raise at the entry points
    found = admissible_coefficients(scene.potential)
    if found.alpha is not None:
        _ALPHA.put(scene, float(found.alpha))
    low, high, start = forces_met(scene)
    finite = np.isfinite(low) and np.isfinite(high)
    require(finite, "load", f"[{low:.6g}, {high:.6g}]", "finite values on [0, duration]")
    low = min(low - float(found.rho_plus), start)
    high = max(high - float(found.rho_minus), start)
    require_convex(scene.support, low, high)


@Interpreted
def _farthest(load: AbstractPull, support: AbstractSupport, edges: Array) -> Real:
    """Largest |z| in m that the load reaches on the flat surface."""
    values = jax.vmap(load)(edges)
    ends = jnp.stack([jnp.min(values), jnp.max(values)])
    return jnp.max(jnp.abs(jax.vmap(support.state_of)(ends)))


def known_scene(scene: Any) -> Scene:
    """The scene that its numbers make, in 64 bits: what entry points work with.

    Itself unless leaves were exchanged (`eqx.tree_at`): then what the constructor makes
    of them. Raises `ValueError` for what is no scene, and as the constructor does.
    """
    needs = "a Scene, as frictionjax.Scene or load_scene make it"
    require(isinstance(scene, Scene), "scene", kind_of(scene), needs)
    require_x64(scene)
    if is_checked(scene):
        return scene
    anew = _ANEW.get(scene)
    if anew is None:
        anew = _built_anew(scene)
        if is_checked(anew):  # else it was made in a trace, which it must not outlive
            _ANEW.put(scene, anew)
    return anew


def _built_anew(scene: Scene) -> Scene:
    if is_known(scene):
        with eagerly(scene):
            return dataclasses.replace(scene)
    load, turns = scene.load, scene.turns
    if is_known(load, scene.duration):
        # Derivatives by other numbers of a scene that was made longer.
        with eagerly(load, scene.duration):
            load, turns = _with_turns(checked(load), scene.duration)
    elif not isinstance(load, Pulled):
        return scene
    load = held_load(load, scene.support, scene.potential)
    return exchanged(scene, {"load": load, "turns": turns})


def require_told_apart(scene: Scene, eps: Any) -> None:
    """Check that floats tell the wells apart that a scene goes through.

    Raises `ValueError` naming the smallest eps.
    """
    if not is_concrete(scene, eps):
        return
    far = _FAR.get(scene)
    if far is None:
        reached = _farthest(load_table(scene.load), scene.support, _edges(scene))
        far = max(float(reached), abs(float(scene.z0)))
        _FAR.put(scene, far)
    least = float(np.min(np.asarray(eps, dtype=float)))
    smallest = SETTINGS.told_apart * far
    allowed = (
        f"eps >= {no_less(smallest, 4)}: wells at {far:.3g} m that floats can tell apart"
    )
    require(least >= smallest, "eps", least, allowed)


def require_times(scene: Scene, ts: Any, fallback: int = 201) -> Float[Array, " n"]:
    """Check requested times: sorted, inside [0, duration]; evenly spaced where None.

    Times that exceed it by rounding are moved to its end.
    """
    duration = jnp.asarray(scene.duration)
    if ts is None:
        return duration * jnp.linspace(0.0, 1.0, fallback)
    if is_known(ts):
        numbers = known_numbers(ts)
        require(numbers.dtype != object, "ts", ts, "times, shape (n,), n > 0")
        ts = numbers
    ts = jnp.asarray(ts, dtype=float)
    if not is_known(ts, scene.duration):
        return ts
    known = np.asarray(ts)
    if known.ndim != 1 or known.size == 0:
        _refuse_times(known, "times, shape (n,), n > 0")
    require(np.all(np.isfinite(known)), "ts", known, "finite times")
    falls = np.flatnonzero(np.diff(known) < 0)
    if falls.size:
        _refuse_times(known[falls[0] : falls[0] + 2], "times that do not decrease")
    end = float(duration)
    # 3 * 0.1 > 0.3, and what is added up n times is n spacings off.
    slack = (SETTINGS.rounded + known.size) * np.spacing(end)
    outside = known[(known < -slack) | (known > end + slack)]
    if outside.size:
        _refuse_times(outside[0], f"times in [0, duration] = [0, {no_more(end)}]")
    if known[0] >= 0 and known[-1] <= end:
        return ts
    return jnp.asarray(np.clip(known, 0.0, end))


def are_times_of(scene: Scene, ts: Float[Array, " n"]) -> Bool[Array, ""]:
    """Whether times, traced ones too, are such as `require_times` asks for."""
    end = jnp.asarray(scene.duration)
    slack = (SETTINGS.rounded + ts.size) * float(jnp.finfo(float).eps) * end
    inside = (ts >= -slack) & (ts <= end + slack)
    return jnp.all(inside) & jnp.all(jnp.diff(ts) >= 0)


def _refuse_times(times: Any, needs: str) -> None:
    """Times differ in digits that messages round off: these are told to the last one."""
    few = np.size(times) <= SETTINGS.times_told
    told = np.asarray(times).tolist() if few else as_text(times)
    raise ValueError(f"ts = {told}: needs {needs}")


def require_instants(scene: Scene, ts: Any) -> Float[np.ndarray, " n"]:
    """Check times of samples that are known: two or more that increase, in the scene."""
    require(is_known(ts), "ts", "traced times", "known ones")
    times = known_numbers(ts)
    require(times.ndim == 1 and times.size >= 2, "ts", ts, "times, shape (n,), n >= 2")
    times = np.asarray(require_times(scene, times), dtype=float)
    require(np.all(np.diff(times) > 0), "ts", times, "times that increase")
    return times


def require_curve(
    scene: Scene, ts: Any, z: Any
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    """Check a curve that is known by samples: times as above, and states in m, not all of
    which have to be finite."""
    times = require_instants(scene, ts)
    require(is_known(z), "z", "traced states", "known ones")
    states, needs = known_numbers(z), f"real states of the shape {times.shape} of ts"
    require(states.shape == times.shape, "z", z, needs)
    return times, states.astype(float)
