"""What every entry point refuses, by the argument's name, value and what is allowed."""

import dataclasses
import functools
import re

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax._checks.arguments import no_less, no_more
from frictionjax.model.scene import require_times, require_told_apart
from frictionjax.wiggly import batch as engine

SURFACE, BRISTLE = fx.profiles.Sine(0.1), fx.bristles.Homothetic(1.0)


def scene_of(support=None, load=None, z0=0.0, potential=None):
    parts = support or fx.supports.Spring(1.0), load or fx.loads.Sine(1.0, 3.0), 3.0, z0
    if potential is not None:
        return fx.Scene(None, None, *parts, potential=potential)
    return fx.Scene(SURFACE, BRISTLE, *parts)


@dataclasses.dataclass
class Wave:
    height: float

    def __call__(self, x):
        return self.height * jnp.sin(2 * jnp.pi * x)


def in_a_loop(y):
    """Which has no derivative in reverse mode."""
    wave = 0.01 * jnp.sin(2 * jnp.pi * y)
    return jax.lax.while_loop(lambda w: w > 1.0, lambda w: 0.5 * w, wave)


def test_functions_that_are_frozen_partial_or_loads_of_whole_numbers_are_taken():
    frozen = dataclasses.make_dataclass("Frozen", ["height"], frozen=True)
    frozen.__call__ = Wave.__call__
    assert fx.profiles.Custom(frozen(0.01))(0.25) == pytest.approx(0.01)
    assert fx.loads.Custom(lambda t: 1)(0.5) == 1
    assert fx.loads.Custom(functools.partial(jnp.multiply, 2.0))(0.5) == 1


def test_no_trace_outlives_the_check_of_a_function():
    with jax.checking_leaks():
        fx.loads.Custom(lambda t: 2.0 * t)


JUST_OVER = np.nextafter(3.0, 4.0)


@functools.cache
def known():
    """Made once, and not while workers collect."""
    return scene_of()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: fx.solve(known(), 1e-2, ts="abc"), r"ts = 'abc': needs times"),
        (lambda: fx.solve(known(), 1e-2, ts=[0j, 1]), r"ts = .*: needs times"),
        (lambda: fx.solve(known(), 1e-2, ts=[[0.0], [1.0, 2.0]]), r"ts = .*: needs times"),
        (lambda: fx.solve(known(), 1e-2, max_steps=0), r"max_steps = 0: needs a whole"),
        (
            lambda: fx.solve(known(), 1e-2, max_steps=10.5),
            r"max_steps = 10\.5: needs a who",
        ),
        (lambda: fx.solve(known(), 1e-2, max_steps="a"), r"max_steps = 'a': needs a whole"),
        (lambda: fx.solve(known(), 1e-2, adjoint=3), r"adjoint = 'int': needs None or an"),
        (lambda: fx.solve(known(), None), r"eps = None: needs one number eps > 0"),
        (lambda: fx.sweep(known(), ["0.1"], 1.0), r"eps = \['0\.1'\]: needs eps > 0, a"),
        (lambda: fx.study(None), r"dataset = None: needs a data set"),
        (lambda: fx.study({}), r"dataset = 'dict': needs a data set"),
        (
            lambda: fx.solve(known(), 1e-2, ts=[0, 3.0000001]),
            r"ts = 3\.0000001: needs .* 3\]",
        ),
        (lambda: fx.solve(known(), 1e-2, ts=JUST_OVER), r"ts = 3\.0000000000000004: needs"),
        (
            lambda: fx.solve(known(), 1e-2, ts=[0, 0.50000001, 0.5]),
            r"ts = \[0\.50000001, 0\.5\]: needs times that do not decrease",
        ),
        (lambda: fx.solve(known(), 1e-2, ts=[None]), r"ts = \[None\]: needs times, shape"),
        (lambda: fx.solve([known()], 1e-2), r"scene = \[Scene\]: needs a Scene, as"),
        (lambda: fx.solve(None, 1e-2), r"scene = None: needs a Scene, as"),
        (
            lambda: fx.friction([None, 1, 2, 3]),
            r"\(\.\.\.\) = \[None, int, int, \.\.\.\]: n",
        ),
        (lambda: fx.solve(known(), 1e-2, method=None), r"method = None: needs one of auto"),
        (
            lambda: fx.solve(known(), 1e-2, method=["auto"]),
            r"method = \['auto'\]: needs one",
        ),
        (
            lambda: fx.study(fx.sweep(known(), [1e-2], 1.0, suprema=False)),
            r"dataset = 'one without strip_excess, sup_error': needs .* suprema=True",
        ),
        (
            lambda: fx.profiles.Custom(lambda y: 0.01 * np.sin(2 * np.pi * y)),
            r"profile\.fn = .*: needs .*, written with jax\.numpy",
        ),
        (
            lambda: fx.profiles.Custom(Wave(0.01)),
            r"profile\.fn = Wave\(height=0\.01\): needs .*, with a hash",
        ),
        (
            lambda: fx.loads.Custom(Wave(1.0)),
            r"load\.fn = Wave\(height=1\.0\): needs .*, with a hash",
        ),
        (
            lambda: fx.supports.Convex(lambda z: 1),
            r"support\.energy = 'values of dtype int64': needs .*, no whole one",
        ),
        (
            lambda: fx.profiles.Custom(in_a_loop),
            r"profile\.fn = .*: needs .*, which jax\.grad goes through",
        ),
        (
            lambda: fx.GivenPotential(lambda Y: jnp.sin(2 * jnp.pi * Y), lambda Y: Y),
            r"potential\.Q = .*: needs a function of \(eps, Y\)",
        ),
        (
            lambda: scene_of(fx.supports.Convex(lambda z: -(z**2))),
            r"support = .*: needs Phi uniformly convex and Phi' to reach",
        ),
        (
            lambda: fx.friction(fx.profiles.Sine(jnp.float32(0.1)), BRISTLE),
            r"dtype = float32: needs float64 leaves; build the parts from Python numbers",
        ),
        (
            lambda: fx.profiles.Fourier.from_heights(np.arange(100.0), np.full(100, 1.1)),
            r"heights = 'a straight line': needs heights that vary",
        ),
    ],
)
def test_wrong_arguments_are_named(call, message):
    with pytest.raises(ValueError, match=message):
        call()


@pytest.mark.parametrize("scene", [None, "scene.toml"])
@pytest.mark.parametrize(
    "call",
    [
        lambda scene: fx.solve(scene, 1e-2),
        lambda scene: fx.solve_limit(scene),
        lambda scene: fx.sweep(scene, 1e-2, 1.0),
        lambda scene: fx.work_precision(scene),
        lambda scene: fx.predict_cost(scene, 1e-2),
        lambda scene: fx.fit_budget(scene, 1e-2, 1.0, 10.0),
        lambda scene: fx.order_cost(scene, [1e-2, 1e-3]),
        lambda scene: fx.certify(scene, 1e-2, 1.0, [0.0, 1.0], [0.0, 0.0]),
        lambda scene: fx.fit_trace(None, scene, 1e-2),
    ],
)
def test_what_is_no_scene_is_named(call, scene):
    kind = None if scene is None else repr(type(scene).__name__)
    with pytest.raises(ValueError, match=rf"scene = {kind}: needs a Scene"):
        call(scene)


@pytest.mark.parametrize("value", [True, [True, 0.1], [[0.1]], "0.1", {0.1: 1}, {0.1}])
def test_eps_that_is_no_number_nor_list_is_named(value):
    for call in (
        lambda: fx.sweep(known(), value, 1.0),
        lambda: fx.solve(known(), value),
        lambda: fx.predict_cost(known(), value, measure=False),
    ):
        with pytest.raises(ValueError, match=r"eps = .*: needs "):
            call()


@pytest.mark.parametrize(
    "call",
    [
        lambda scene, eps: fx.solve(scene, eps, 1.0, [0.0, 3.0]),
        lambda scene, eps: fx.sweep(scene, [1e-2, eps], 1.0, [0.0, 3.0]),
        lambda scene, eps: fx.predict_cost(scene, eps, 1.0, measure=False),
    ],
)
def test_wells_that_floats_cannot_tell_apart_are_refused(call):
    """At eps = 1e-20 a run did not end; at 1e-15 all was NaN, after 20 s."""
    with pytest.raises(
        ValueError, match=r"eps = 1e-20: needs eps >= 9.095e-13: wells at 1 m"
    ):
        call(known(), 1e-20)
    with pytest.raises(ValueError, match=r"eps = 1e-07: needs eps >= 9.095e-06"):
        call(scene_of(fx.supports.Spring(1e-7)), 1e-7)
    leans = known().replace(bristle=fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0))
    with pytest.raises(ValueError, match=r"eps = 4.94066e-324: needs eps >= "):
        call(leans, 5e-324)  # heights of 0 m


def test_eps_of_1e_minus_12():
    found = fx.solve(known(), 1e-12, 1.0, [0.0, 1.0, 3.0])
    assert found.ok
    assert np.all(np.isfinite(found.z))


@pytest.mark.parametrize("gamma", [1.0, 2.0])
def test_wrong_solutions_do_not_balance_at_the_smallest_eps(monkeypatch, gamma):
    """Steps that err by a hundredth of a well, by a third in slips."""
    plans = engine.planned

    def carelessly(**parts):
        plan = plans(**parts)
        loose = {"tolerance": 1e-2, "loosest": 0.3, "reach": 0.25}
        size = plan.control.tolerance.shape
        control = {name: np.full(size, value) for name, value in loose.items()}
        return plan._replace(control=plan.control._replace(**control))

    monkeypatch.setattr(engine, "planned", carelessly)
    found = fx.solve(known(), 1e-12, gamma, [0.0, 1.0, 3.0])
    assert found.status is fx.Status.UNBALANCED


@pytest.mark.parametrize("value", [5.00049e-13, 9.0949470177e-13, 1 / 3, -0.1234567, 12, 0])
@pytest.mark.parametrize("digits", [2, 4, 6])
def test_a_limit_that_is_named_is_allowed(value, digits):
    low, high = float(no_less(value, digits)), float(no_more(value, digits))
    assert high <= value <= low
    assert low - high <= 10.0 ** (1 - digits) * abs(value)


def test_the_smallest_eps_named_in_an_error_is_accepted():
    for load in (1.0, 5.4987, 0.31):
        scene = scene_of(load=fx.loads.Ramp(0.1, load))
        with pytest.raises(ValueError, match="needs eps >= ") as caught:
            require_told_apart(scene, 1e-20)
        named = re.search(r"eps >= (\S+):", str(caught.value)).group(1)
        require_told_apart(scene, float(named))


def test_the_end_named_in_an_error_is_a_time_that_is_accepted():
    scene = fx.Scene(SURFACE, BRISTLE, known().support, known().load, 1.23456789)
    with pytest.raises(ValueError, match=r"\[0, 1\.23456\]"):
        require_times(scene, [0.0, 1.3])
    require_times(scene, [0.0, 1.23456])


@pytest.mark.parametrize("fn", [lambda y, z: y, lambda: 1.0, lambda y, *, slope: y])
@pytest.mark.parametrize(
    ("part", "message"),
    [
        (fx.profiles.Custom, r"profile\.fn = .*: needs a function of y alone"),
        (fx.supports.Convex, r"support\.energy = .*: needs a function Phi of z alone"),
        (fx.loads.Custom, r"load\.fn = .*: needs a function of t alone"),
        (
            lambda fn: fx.bristles.Custom(fn, jnp.cos),
            r"bristle\.offset = .*: needs a function A of eta alone",
        ),
        (
            lambda fn: fx.bristles.Custom(jnp.sin, fn),
            r"bristle\.energy = .*: needs a function F of eta alone",
        ),
        (fx.GivenPotential, r"potential\.W = .*: needs a function of Y alone"),
    ],
)
def test_functions_of_two_arguments_are_refused_by_name(part, message, fn):
    with pytest.raises(ValueError, match=message):
        part(fn)


@pytest.mark.parametrize(
    "call",
    [
        lambda one: fx.sweep(known(), one, 1.0),
        lambda one: fx.sweep(known(), 1e-2, one),
        lambda one: fx.sweep(known(), 1e-2, 1.0, ts=one),
        lambda one: fx.solve(known(), one),
    ],
)
def test_iterators_are_refused_without_a_warning(call):
    """Warnings are errors here."""
    with pytest.raises(ValueError, match=r"(eps|gamma|ts) = <list_iterator .*>: needs"):
        call(iter([0.1]))
