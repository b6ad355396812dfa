"""Which engine does which effect: one table, and what to do instead where it says no."""

import enum
from collections.abc import Sequence
from itertools import combinations
from typing import Any

from .._checks import is_known, require
from .abstract import AbstractEffect, Stage
from .axial_load import AxialLoad
from .nap_flip import NapFlip


class Engine(enum.Enum):
    """What a scene is given to, by the name of the call.

    >>> fx.effects.Engine.COST.value
    'a measure of cost (work_precision, predict_cost, fit_budget)'
    """

    LIMIT = "solve_limit"
    RESOLVED = 'solve(method="resolved")'
    WINDOWED = 'solve(method="windowed")'
    PATH = "solve by a solver of diffrax, and for derivatives"
    SWEEP = "sweep"
    CERTIFICATE = "certify"
    LIMIT_CERTIFICATE = "certify_limit, and principle.D"
    PRINCIPLE = "principle.D_eps"
    MECHANICS = "mechanics"
    COST = "a measure of cost (work_precision, predict_cost, fit_budget)"
    TRACE = "fit_trace"
    ENSEMBLE = "ensemble"
    FRICTION_CURVE = "friction_curve"
    SLIDE = "steady_slide"
    DESIGN = "a design (fit_profile, fit_angle)"
    DESIGN_MAP = "a map of designs (design_map, tolerance)"


def engine_of(method: Any) -> Engine:
    """The engine that a `method` of `solve` and `sweep` asks for."""
    if not isinstance(method, str):
        return Engine.PATH
    ours = {"auto": Engine.RESOLVED, "resolved": Engine.RESOLVED}  # auto: what can be done
    return (ours | {"windowed": Engine.WINDOWED}).get(method, Engine.PATH)


_E = Engine
_DOES: dict[str, frozenset[Engine]] = {
    "CompliantArray": frozenset(
        {
            *(_E.LIMIT, _E.RESOLVED, _E.WINDOWED, _E.SWEEP, _E.CERTIFICATE),
            *(_E.SLIDE, _E.FRICTION_CURVE, _E.LIMIT_CERTIFICATE),
        }
    ),
    "Noise": frozenset(
        {_E.RESOLVED, _E.WINDOWED, _E.SWEEP, _E.ENSEMBLE, _E.FRICTION_CURVE}
    ),
    "NapFlip": frozenset({_E.LIMIT, _E.RESOLVED, _E.SWEEP, _E.MECHANICS, _E.CERTIFICATE}),
    "Inertia": frozenset(
        {
            *(_E.LIMIT, _E.RESOLVED, _E.SWEEP, _E.MECHANICS, _E.CERTIFICATE),
            _E.LIMIT_CERTIFICATE,
        }
    ),
}
"""Of effects that change what moves: the engines that do them."""
_DOES_NOT: dict[str, frozenset[Engine]] = {
    "AxialLoad": frozenset({_E.ENSEMBLE, _E.SLIDE}),
    "RigidArray": frozenset({_E.TRACE}),
}
"""Of effects that change the potential or only read: the engines that do not hold them."""
_ALIKE = frozenset({"LeadingOrder", "RigidArray", "CompliantArray"})
_FORMULAS: dict[Engine, frozenset[str]] = {
    _E.DESIGN: _ALIKE | {"NapFlip"},
    _E.DESIGN_MAP: _ALIKE,
}
"""Of engines that go by formulas of the coefficients: the effects that these are for."""

_MASSLESS = "a scene without it"
_ALONE = "a bristle at a time: a scene without it"
_INSTEAD: dict[tuple[str, Engine], str] = {
    ("CompliantArray", _E.PATH): "methods of its own, for scenes of known numbers",
    ("CompliantArray", _E.MECHANICS): _ALONE,
    ("CompliantArray", _E.ENSEMBLE): _ALONE,
    ("CompliantArray", _E.COST): _ALONE,
    ("CompliantArray", _E.TRACE): _ALONE,
    ("RigidArray", _E.TRACE): _ALONE,
    ("Noise", _E.LIMIT): "a scene without it; with it friction_curve, at the speeds asked",
    ("Noise", _E.CERTIFICATE): "a scene without it; of noisy paths histogram, of many",
    ("CompliantArray", _E.PRINCIPLE): _ALONE,
    ("Noise", _E.LIMIT_CERTIFICATE): "a scene without it",
    ("Noise", _E.PRINCIPLE): "a scene without it",
    ("Inertia", _E.PRINCIPLE): _MASSLESS,
    ("Noise", _E.COST): "explain, which tells what it costs",
    ("Noise", _E.TRACE): "a scene without it",
    ("NapFlip", _E.SLIDE): "nap, of its bristle",
    ("AxialLoad", _E.SLIDE): "mechanics or sweep, of a scene",
    ("Noise", _E.SLIDE): "friction_curve, of a scene",
    ("Inertia", _E.SLIDE): "sweep of a long ramp: its dissipation over its way",
    ("AxialLoad", _E.ENSEMBLE): "mechanics or sweep, of a scene without noise",
    ("Noise", _E.PATH): 'method="auto", and key',
    (
        "Inertia",
        _E.WINDOWED,
    ): 'method="auto": tips with mass are not ordered, no window holds',
    ("Inertia", _E.PATH): 'method="auto", and scenes of known numbers',
    ("Inertia", _E.COST): "stats of solve, which tell steps",
    ("Inertia", _E.TRACE): _MASSLESS,
    ("Inertia", _E.ENSEMBLE): _MASSLESS,
    ("Inertia", _E.FRICTION_CURVE): "sweep of a long ramp: its dissipation over its way",
    ("Noise", _E.MECHANICS): "a scene without it: power along its paths is infinite",
    ("NapFlip", _E.DESIGN_MAP): "nap, of one design at a time",
}
"""What to do where an engine does not do an effect, after "needs"."""

_INSTEAD |= {
    (name, engine): f"a design without it, and {call} of a scene with that"
    for engine in _FORMULAS
    for name, call in (
        ("Noise", "friction_curve"),
        ("Inertia", "sweep"),
        ("AxialLoad", "mechanics"),
    )
}

_STANDS = "a scene without it, of a rod that keeps its nap"
_INSTEAD |= {
    ("NapFlip", _E.WINDOWED): 'method="auto": where a rod turns over no window holds',
    ("NapFlip", _E.PATH): 'method="auto", and scenes of known numbers',
    ("NapFlip", _E.COST): "stats of solve, which tell steps",
    ("NapFlip", _E.TRACE): _STANDS,
    ("NapFlip", _E.ENSEMBLE): _STANDS,
    ("NapFlip", _E.LIMIT_CERTIFICATE): _STANDS,
    ("NapFlip", _E.PRINCIPLE): _STANDS,
    ("NapFlip", _E.FRICTION_CURVE): "nap, of its bristle, and sweep of a slow load",
}

_ONE_ROD = "one rod, whose geometry the other leaves out: scenes apart"
_APART: dict[frozenset[str], str] = {
    frozenset({reading, other}): _ONE_ROD
    for reading in ("AxialLoad",)
    for other in ("LeadingOrder", "RigidArray", "CompliantArray")
}
_APART |= {
    frozenset({"NapFlip", other}): "one of them: its rod is bent and turns over"
    for other in (
        *("LeadingOrder", "RigidArray", "CompliantArray"),
        *("Noise", "Inertia"),
    )
}
_APART |= {
    frozenset({"CompliantArray", "Noise"}): "one of them: each bristle has its own noise",
    frozenset({"CompliantArray", "Inertia"}): "one of them: each bristle has its own mass",
    frozenset({"Inertia", "Noise"}): "one of them: noise is that of overdamped tips",
    frozenset({"AxialLoad", "Noise"}): "one of them: no call reads loads of noisy paths",
}
"""Pairs that no scene holds together, and why."""


def does(engine: Engine, effect: AbstractEffect) -> bool:
    """Whether an engine does an effect."""
    if engine in _FORMULAS:
        return _name(effect) in _FORMULAS[engine]
    if effect.stage in (Stage.POTENTIAL, Stage.READING):
        return engine not in _DOES_NOT.get(_name(effect), ())
    return engine in _DOES.get(_name(effect), ())


def require_done(effects: Sequence[AbstractEffect], engine: Engine) -> None:
    """Raise `ValueError` naming the first effect that an engine does not do."""
    for effect in effects:
        if does(engine, effect):
            continue
        name = _name(effect)
        others = [each.value for each in Engine if does(each, effect)]
        instead = _INSTEAD.get((name, engine), f"one of {', '.join(others) or 'none'}")
        raise ValueError(
            f"scene.effects: {engine.value} does not do {name}: needs {instead}"
        )


def require_together(effects: Sequence[AbstractEffect]) -> None:
    """Raise `ValueError` for two of a kind, two that exclude each other, or two rods."""
    for first, second in combinations(effects, 2):
        pair = frozenset({_name(first), _name(second)})
        why = "one of each kind" if len(pair) == 1 else _APART.get(pair)
        if why is not None:
            names = f"{_name(first)} and {_name(second)}"
            raise ValueError(f"scene.effects = {names}: needs {why}")
    _require_one_rod(effects)


def _require_one_rod(effects: Sequence[AbstractEffect]) -> None:
    """Raise `ValueError` where effects are given rods of different bending stiffness."""
    given = {_name(e): e.bending_stiffness for e in effects if isinstance(e, AxialLoad)}
    given |= {_name(e): e.bending_stiffness for e in effects if isinstance(e, NapFlip)}
    if len(given) < 2 or not all(map(is_known, given.values())):
        return
    (name, first), (other, second) = given.items()
    allowed = f"one rod, so that of effects.{other}, {float(second):.6g} N m^2"
    same = float(first) == float(second)
    require(same, f"effects.{name}.bending_stiffness", float(first), allowed)


def require_bristle(effects: Sequence[AbstractEffect], bristle: Any) -> None:
    """Raise `ValueError` for an effect that is about another class of bristles."""
    for effect in effects:
        needed, given = effect.of_bristle, _name(bristle)
        if needed not in ("", given):
            needs = f"an {needed}, as scene.effects has {_name(effect)}"
            raise ValueError(f"scene.bristle = {given}: needs {needs}")


def _name(effect: Any) -> str:
    return type(effect).__name__
