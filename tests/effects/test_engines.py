"""Which engine does which effect."""

import itertools
import random

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.effects import AbstractEffect, Engine, Stage, does
from frictionjax.limit import LimitSolution

EFFECTS = {
    "LeadingOrder": fx.effects.LeadingOrder(),
    "RigidArray": fx.effects.RigidArray([0.0, 0.1]),
    "CompliantArray": fx.effects.CompliantArray([0.0, 0.1]),
    "AxialLoad": fx.effects.AxialLoad(0.1),
    "Noise": fx.effects.Noise(1e-4),
    "NapFlip": fx.effects.NapFlip(0.1),
    "Inertia": fx.effects.Inertia(1e-4),
}
APART = {
    frozenset({rod, other})
    for rod in ("AxialLoad",)
    for other in ("LeadingOrder", "RigidArray", "CompliantArray")
} | {frozenset({"Noise", other}) for other in ("AxialLoad", "CompliantArray")}
OTHERS = EFFECTS.keys() - {"NapFlip", "AxialLoad"}  # of the rod that turns over
APART |= {frozenset({"NapFlip", other}) for other in OTHERS}
APART |= {frozenset({"Inertia", other}) for other in ("Noise", "CompliantArray")}
AT_REST = LimitSolution(
    *([np.zeros(2)] * 3), root=np.ones(2), mode=np.ones(2, int), tip=np.zeros(2)
)
HEIGHTS, STIFFNESSES = ("height", [0.9, 1.0]), ("stiffness", [1.0, 2.0])
TS = np.linspace(0, 1, 4001)


def scene_of(*effects):
    profile, bristle = fx.profiles.Sine(0.1), fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    if any(effect.of_bristle for effect in effects):
        bristle = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3)
    if any(isinstance(effect, fx.effects.NapFlip) for effect in effects):
        profile = fx.profiles.Sine(0.5)  # rough enough to turn over
    parts = fx.supports.Spring(1.0), fx.loads.Ramp(1.0, 0.0)
    return fx.Scene(profile, bristle, *parts, duration=1.0, effects=effects)


def key_for(scene):
    return 0 if any(isinstance(e, fx.effects.Noise) for e in scene.effects) else None


def noisy(scene):
    """With noise, where the scene has none and may have it."""
    kinds = {type(effect).__name__ for effect in scene.effects}
    if "Noise" in kinds or any({"Noise", kind} in APART for kind in kinds):
        return scene
    return scene.replace(effects=(*scene.effects, fx.effects.Noise(1e-4)))


def curve_for(scene):
    """States for `certify`, and what else a scene is asked for there."""
    z = np.clip(TS - 0.1, 0, 1)
    arrays = [e for e in scene.effects if isinstance(e, fx.effects.CompliantArray)]
    asked = {"z": np.tile(z, (arrays[0].offsets.size, 1)) if arrays else z}
    if any(isinstance(e, fx.effects.Inertia) for e in scene.effects):
        asked["velocity"] = np.gradient(z, TS)
    if any(isinstance(e, fx.effects.NapFlip) for e in scene.effects):
        asked |= {"root": z + 1.0, "mode": np.ones(TS.size, int)}
    return asked


CALLS = {
    Engine.LIMIT: lambda s: fx.solve_limit(s, [0.5, 1.0]),
    Engine.RESOLVED: lambda s: fx.solve(
        s, 0.05, ts=[0.5, 1.0], method="resolved", key=key_for(s)
    ),
    Engine.WINDOWED: lambda s: fx.solve(
        s, 0.05, ts=[0.5, 1.0], method="windowed", key=key_for(s)
    ),
    Engine.PATH: lambda s: fx.solve(s, 0.05, ts=[0.5, 1.0], method="Kvaerno3"),
    Engine.SWEEP: lambda s: fx.sweep(s, [0.05], [1.0], ts=[0.5, 1.0], key=key_for(s)),
    Engine.CERTIFICATE: lambda s: fx.certify(s, 0.05, 1.0, TS, **curve_for(s)),
    Engine.LIMIT_CERTIFICATE: lambda s: fx.certify_limit(s, TS, np.clip(TS - 0.1, 0, 1)),
    Engine.PRINCIPLE: lambda s: (
        fx.principle.D(s, TS, np.clip(TS - 0.1, 0, 1)),
        fx.principle.D_eps(s, 0.05, 1.0, TS, np.clip(TS - 0.1, 0, 1)),
    ),
    Engine.COST: lambda s: fx.predict_cost(s, [0.05], [1.0]),
    Engine.MECHANICS: lambda s: fx.mechanics(s, AT_REST),
    Engine.ENSEMBLE: lambda s: fx.ensemble(noisy(s), 0.05, 1.0, [0.5, 1.0], 2, 0),
    Engine.SLIDE: lambda s: fx.steady_slide(s.profile, s.bristle, 0.05, effects=s.effects),
    Engine.DESIGN: lambda s: fx.fit_profile(
        fx.Target(s.bristle, 0.05, -0.04), effects=s.effects
    ),
    Engine.DESIGN_MAP: lambda s: fx.design_map(
        s.bristle, HEIGHTS, STIFFNESSES, profile=s.profile, effects=s.effects
    ),
    Engine.FRICTION_CURVE: lambda s: fx.friction_curve(s, [0.1], 0.05),
    Engine.TRACE: lambda s: fx.fit_trace(
        fx.Trace(TS[::40], z=np.clip(TS[::40] - 0.1, 0, 1)), s, 0.05, 1.0, 1, progress=False
    ),
}


def test_every_effect_of_the_library_is_walked():
    kinds = {n for n, k in vars(fx.effects).items() if isinstance(k, type)}
    abstract = {"AbstractEffect", "Stage", "Engine"}
    assert kinds - abstract == EFFECTS.keys()


def test_every_engine_is_walked():
    assert CALLS.keys() == set(Engine)


# A program each for what is done here, whose values tests of the effects hold.
COMPILED = {Engine.PATH, Engine.RESOLVED, Engine.CERTIFICATE, Engine.FRICTION_CURVE}
COMPILED |= {Engine.SLIDE, Engine.SWEEP, Engine.TRACE}


def cell_of(engine, name):
    compiled = engine in COMPILED and does(engine, EFFECTS[name])
    compiled |= (engine, name) == (Engine.WINDOWED, "AxialLoad")  # a rod's lanes
    marks = pytest.mark.slow if compiled else ()
    return pytest.param(engine, name, marks=marks, id=f"{engine.name}-{name}")


CELLS = [cell_of(*pair) for pair in itertools.product(CALLS, EFFECTS)]


@pytest.mark.parametrize(("engine", "name"), CELLS)
def test_an_engine_does_an_effect_or_refuses_it_by_name(engine, name):
    scene = scene_of(EFFECTS[name])
    if does(engine, EFFECTS[name]):
        CALLS[engine](scene)
    else:
        with pytest.raises(ValueError, match=rf"does not do {name}: needs \S") as caught:
            CALLS[engine](scene)
        # A list of all other calls says nothing of what was asked.
        assert "needs one of" not in str(caught.value)


@pytest.mark.parametrize("seed", range(12))
def test_random_threes(seed):
    draw = random.Random(seed)
    names = [draw.choice(list(EFFECTS)) for _ in range(3)]
    engine = draw.choice(list(CALLS))
    effects = [EFFECTS[name] for name in names]
    if len(set(names)) < 3:
        with pytest.raises(ValueError, match=r"scene\.effects = .* needs one"):
            scene_of(*effects)
    elif any(pair <= set(names) for pair in APART):
        with pytest.raises(ValueError, match=r"scene\.effects = .* needs one "):
            scene_of(*effects)
    elif all(does(engine, effect) for effect in effects):
        CALLS[engine](scene_of(*effects))
    else:
        with pytest.raises(ValueError, match="does not do"):
            CALLS[engine](scene_of(*effects))


@pytest.mark.parametrize("pair", [*itertools.combinations(EFFECTS, 2)], ids="-".join)
def test_a_pair_is_held_together_or_refused_by_its_names(pair):
    effects = [EFFECTS[name] for name in pair]
    if frozenset(pair) in APART:
        with pytest.raises(
            ValueError, match=f"scene.effects = {' and '.join(pair)}: needs"
        ):
            scene_of(*effects)
        return
    scene = scene_of(*effects)
    for engine, call in CALLS.items():
        if not all(does(engine, effect) for effect in effects):
            with pytest.raises(ValueError, match="does not do"):
                call(scene)


def test_effects_of_one_rod_agree_on_it():
    rods = fx.effects.NapFlip(0.1), fx.effects.AxialLoad(0.2)
    named = r"effects\.AxialLoad\.bending_stiffness = 0\.2: needs .*\.NapFlip, 0\.1 N"
    for order in (rods, rods[::-1]):
        with pytest.raises(ValueError, match=named):
            scene_of(*order)


def test_order_does_not_matter():
    together = "LeadingOrder", "RigidArray", "CompliantArray"
    found = [
        fx.solve(scene_of(*(EFFECTS[n] for n in order)), 0.05, ts=[0.5, 1.0]).z
        for order in itertools.permutations(together)
    ]
    for z in found[1:]:
        np.testing.assert_allclose(z, found[0], rtol=1e-12)


class Doubled(AbstractEffect):
    """Of a user: two bristles in one."""

    def changed(self, potential):
        from frictionjax.model.summed_potential import SummedPotential

        return SummedPotential(potential, np.zeros(2), np.ones(2))


class Wind(AbstractEffect):
    """Of a user, that no engine knows."""

    stage = Stage.STATE


def test_effects_of_a_user_go_through_their_potential_or_are_refused():
    one, two = fx.friction(scene_of()), fx.friction(scene_of(Doubled()))
    assert float(two.rho_plus) == pytest.approx(2 * float(one.rho_plus), rel=1e-12)
    for engine, call in CALLS.items():
        with pytest.raises(ValueError, match="does not do Wind"):
            call(scene_of(Wind()))
        assert not does(engine, Wind())


@pytest.mark.parametrize("given", [("inertia",), None, "LeadingOrder", [object()]])
def test_what_is_no_effect_is_refused(given):
    with pytest.raises(ValueError, match=r"scene\.effects = .*needs effects of"):
        scene_of().replace(effects=given)
