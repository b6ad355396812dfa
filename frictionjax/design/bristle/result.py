"""What the inverse design of a bristle returns."""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from ..._checks import (
    CodedResult,
    Real,
    as_jax,
    as_text,
    is_concrete,
    is_known,
    require_whole,
)
from ..._compile import once_a_scene
from ..._text import Named, SelfDrawn, ShownNumbers
from ...bristles import AbstractBristle, pulling_text
from ...contact import Nap, nap
from ...effects import AbstractEffect, Engine
from ...io import AS_IS, CODES, LEAF, PART, TOLD, Document, record, unit_of
from ...profiles import AbstractProfile
from ..common import (
    EFFECT_FORM,
    QUANTITIES,
    DesignResult,
    FreeParameter,
    SceneEffects,
    Slopes,
    effects_of_scene,
    free_parameter,
    on_slopes,
    quantity_of,
)
from .inverse import PulledParts
from .sensitivities import Sensitivities, sensitivities_of
from .settings import SETTINGS
from .status import GOOD, FitStatus


def _unknown(entries: dict[str, Any]) -> Real:
    """A number a target that documents of earlier versions lack."""
    return jnp.full(np.shape(entries["target"]), jnp.nan)


def _in_scene(entries: list) -> SceneEffects:
    return effects_of_scene(EFFECT_FORM.read(entries), Engine.DESIGN, ())


_EFFECTS = EFFECT_FORM._replace(
    read=_in_scene, absent=lambda entries: SceneEffects(), argument="scene"
)
_PULLED = record(PulledParts, PulledParts._fields, LEAF)
_FOUND = "of the bristle found"


class AngleFit(ShownNumbers, SelfDrawn, DesignResult, CodedResult, eqx.Module):
    """A bristle that gives a wanted friction; every array has the shape of the target.

    `bristle`: the one given, with the number called `free` set to `value`: of all
    `solutions` the nearest to what it was. `achieved`: the quantity it gives, on the same
    surface; `alpha`: its normal force F'(0) in N, > 0 unless `pulling` allowed others.
    Without a solution, `bristle` comes as near to the target as admissible ones do.
    `roots`: all solutions, increasing, NaN after the last. `admissible` (pieces, 2):
    intervals of the number in which every bristle is admissible; alpha = 0 and the angles
    at which a tip jumps are their ends, which are not among them. `reachable` (pieces, 2):
    least and largest quantity over each. `code`: a `FitStatus` as an integer. `pulled`:
    where that is `PULLS`, the bristle that was not allowed. `slopes`: extreme ones of the
    surface, of the one that stands for it where tips of a rigid array are at different
    phases; `scene`: what the `effects` of the scene make of forces.
    """

    bristle: AbstractBristle
    value: Real
    achieved: Real
    alpha: Real
    target: Real
    roots: Real
    admissible: Real
    reachable: Real
    code: Real
    pulled: PulledParts
    slopes: Slopes
    profile: AbstractProfile
    free: str = eqx.field(static=True)
    quantity: str = eqx.field(static=True)
    pulling: bool = eqx.field(static=True, default=False)
    scene: SceneEffects = SceneEffects()

    _outcomes, _good = FitStatus, GOOD
    _picture = "draw_angle_fit"
    document = Document(
        "frictionjax.AngleFit",
        {"message": TOLD}
        | dict.fromkeys(("value", "achieved", "target"), LEAF)
        | dict.fromkeys(("roots", "admissible", "reachable"), LEAF)
        | {
            "free": AS_IS,
            "quantity": AS_IS,
            "code": CODES,
            "alpha": LEAF.or_else(_unknown),
            "pulling": AS_IS.or_else(lambda entries: True),
            "effects": _EFFECTS,
            "pulled": _PULLED.or_else(
                lambda entries: PulledParts(*[_unknown(entries)] * 2)
            ),
            "bristle": PART,
            "profile": PART,
            "slopes": record(Slopes, Slopes._fields, LEAF),
        },
    )

    @property
    def effects(self) -> tuple[AbstractEffect, ...]:
        """Effects of the scene that it is for."""
        return self.scene.effects

    @property
    def solutions(self) -> Real:
        """All solutions, increasing; one target's alone are without padding."""
        if is_concrete(self.roots) and self.roots.ndim == 1:
            roots = np.asarray(self.roots)
            return as_jax(roots[~np.isnan(roots)])
        return self.roots

    @property
    def _codes(self) -> Real:
        return self.code

    @property
    def message(self) -> Any:
        """Why, for people: one text, or a list of one a target; empty where traced."""
        if not is_known(self.code):
            return ""
        if self.code.ndim == 0:
            return _message(self)
        return [self[i].message for i in range(self.code.shape[0])]

    @property
    def nap(self) -> Nap:
        """What `nap` says of the bristle found, of one target; see `ProfileFit.naps`."""
        flip = self.scene.nap_flip
        stiff = None if flip is None else flip.bending_stiffness
        return nap(self.profile, self.bristle, stiff)

    def __getitem__(self, index: int) -> "AngleFit":
        """One target's fit out of a batch."""

        def one(leaf: Any) -> Real:
            return as_jax(np.asarray(leaf)[index]) if is_known(leaf) else leaf[index]

        return AngleFit(
            jax.tree_util.tree_map(one, self.bristle),
            one(self.value),
            one(self.achieved),
            one(self.alpha),
            one(self.target),
            one(self.roots),
            self.admissible,
            self.reachable,
            one(self.code),
            PulledParts._make(map(one, self.pulled)),
            self.slopes,
            self.profile,
            self.free,
            self.quantity,
            self.pulling,
            self.scene,
        )

    def curve(self, points: int = 400) -> tuple[Real, Real]:
        """The number and the quantity over the admissible intervals, shapes (pieces, n)."""
        part, values = self._family(points)
        which = np.asarray(QUANTITIES.index(self.quantity))
        free = free_parameter(part, self.free)
        found = _curve(free, part, self.slopes, which, values)
        return values, self.scene.of_all(found, self.quantity)

    def normal_forces(self, points: int = 400) -> Real:
        """alpha in N at the numbers of `curve`, shape (pieces, n); NaN where those are."""
        part, values = self._family(points)
        return _alphas(free_parameter(part, self.free), part, self.slopes, values)

    def _family(self, points: int) -> tuple[AbstractBristle, Real]:
        require_whole("points", points, 2)
        low, high = self.admissible[:, :1], self.admissible[:, 1:]
        values = low + (high - low) * jnp.linspace(1e-6, 1 - 1e-6, points)[None, :]
        return self.bristle if self.code.ndim == 0 else self[0].bristle, values

    @property
    def sensitivities(self) -> Sensitivities:
        """Derivatives of `value`, by the implicit function theorem."""
        return sensitivities_of(self)

    def _in_words(self) -> str:
        if self.code.ndim:
            return f"AngleFit({self.free}, batch {self.code.shape}: {self._ended})"
        return f"AngleFit({self.free}={as_text(self.value)}: {self.message})"

    def _numbers(self) -> list[Named]:
        count = jnp.sum(~jnp.isnan(self.roots), axis=-1)
        unit = "" if self.quantity == "ratio" else "N"
        return [
            Named(self.free, self.value, unit_of(self.bristle, self.free), _FOUND),
            Named(f"{self.quantity} wanted", self.target, unit),
            Named(f"{self.quantity} achieved", self.achieved, unit, "on the same surface"),
            Named("alpha", self.alpha, "N", "normal force without friction"),
            Named("solutions", count, "", "in the admissible range"),
        ]


def _message(fit: AngleFit) -> str:
    status = FitStatus.of(int(fit.code))
    if status in (FitStatus.UNREACHABLE, FitStatus.PULLS):
        target, achieved = _told_apart(float(fit.target), float(fit.achieved))
        return f"{fit.quantity} = {target} {_out_of_reach(fit, status, achieved)}"
    asked = f"{fit.quantity} = {as_text(fit.target)}"
    if status == FitStatus.INADMISSIBLE:
        return f"{asked}: {status.message}"
    count = int(np.sum(~np.isnan(fit.roots)))
    others = "" if count < 2 else f" ({count} solutions)"
    pulls = pulling_text(fit.alpha, fit.bristle)
    told = f"; {pulls}" if pulls else ""
    if fit.scene.nap_flip is not None:
        told += f"; {fit.nap.message}"
    ended = status.message
    if status == FitStatus.INDIFFERENT:
        ended = _where_indifferent(fit) or ended
    return f"{asked}: {ended}, {fit.free} = {as_text(fit.value)}{others}{told}"


def _told_apart(one: float, other: float) -> tuple[str, str]:
    """Both with as many digits, six or more, as tell them apart."""
    texts = ((f"{one:.{n}g}", f"{other:.{n}g}") for n in range(6, 17))
    return next((pair for pair in texts if pair[0] != pair[1]), (repr(one), repr(other)))


def _where_indifferent(fit: AngleFit) -> str:
    """The intervals in which every value gives the target; empty where all do."""
    ends, target = np.asarray(fit.reachable), float(fit.target)
    known = ~np.isnan(ends[:, 0])
    same = np.all(np.abs(ends - target) <= SETTINGS.met * abs(target), axis=1)
    if np.all(same[known]):
        return ""
    where = intervals_text(np.asarray(fit.admissible)[same])
    return f"every {fit.free} in {where} gives it: the quantity does not depend on it there"


def _out_of_reach(fit: AngleFit, status: FitStatus, achieved: str) -> str:
    why, which = f"cannot be reached by {fit.free}:", ""
    if status == FitStatus.PULLS:
        pulled, alpha = map(as_text, fit.pulled)
        why = (
            f"is {status.message}, {fit.free} = {pulled} with alpha = {alpha} N: "
            "pulling=True (--pulling in the shell) allows that;"
        )
        which = "with bristles that press "
    known = intervals_text(fit.reachable)
    if not known:
        return f"{why} none that presses is admissible"
    ends = np.asarray(fit.reachable)
    if np.nanmax(ends) - np.nanmin(ends) <= SETTINGS.met * np.nanmax(np.abs(ends)):
        return f"{why} {which}it is {achieved} at every {fit.free} allowed"
    return (
        f"{why} {which}{fit.quantity} is in {known}; nearest: {achieved} at "
        f"{fit.free} = {as_text(fit.value)}"
    )


def intervals_text(pairs: Any) -> str:
    """Intervals (n, 2) in words, each once; rows of NaN are none."""
    known = np.asarray(pairs)
    known = known[~np.isnan(known[:, 0])]
    texts = {f"({as_text(low)}, {as_text(high)})": None for low, high in known}
    return " or ".join(texts)


@once_a_scene
def _alphas(free: FreeParameter, bristle, slopes, values):
    def one(value: Real) -> Real:
        return on_slopes(free.put(bristle, value), slopes).alpha

    return jax.vmap(jax.vmap(one))(values)


@once_a_scene
def _curve(free: FreeParameter, bristle, slopes, which, values):
    def one(value: Real) -> Real:
        return quantity_of(on_slopes(free.put(bristle, value), slopes), which)

    return jax.vmap(jax.vmap(one))(values)
