"""Loads of classes of one's own: every turning point is stated, and JAX traces them."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx

PARTS = fx.profiles.Sine(0.1), fx.bristles.Homothetic(1.0), fx.supports.Spring(1.0)
TURNS = np.pi * (np.arange(3) + 0.5)


class Wave(fx.loads.AbstractLoad):
    """A sine that states its first `stated` turning points."""

    rate: jax.Array = eqx.field(converter=jnp.asarray)
    stated: tuple = tuple(TURNS)

    def __call__(self, t):
        return jnp.sin(self.rate * t)

    def turning_count(self, duration):
        return int(np.sum(np.asarray(self.stated) < duration))

    def turning_points(self, duration, count):
        times = jnp.append(jnp.asarray(self.stated), jnp.full(count, duration))
        return jnp.minimum(times[:count], duration)


def scene_under(load):
    return fx.Scene(*PARTS, load, duration=6.0)


@pytest.mark.parametrize("around", [lambda load: load, fx.loads.Pulled])
@pytest.mark.parametrize(
    ("stated", "missing"),
    [
        ((), r"1\.57079633, 4\.71238898"),
        (TURNS[:1], r"4\.71238898"),
        (TURNS[1:], r"1\.57079633"),
        (TURNS + 0.1, r"1\.57079633, 4\.71238898"),
    ],
)
def test_turning_points_that_are_missing_are_named(around, stated, missing):
    """The limit was wrong without a word, and trajectories did not end."""
    load = around(Wave(1.0, tuple(stated)))
    with pytest.raises(ValueError, match=f"Wave.turning_points = 'without {missing}'"):
        scene_under(load)


def test_those_that_are_all_there_are_looked_at_once(monkeypatch):
    scene = scene_under(Wave(1.0))
    np.testing.assert_allclose(scene.turning_points(), [*TURNS[:2], 6.0, 6.0])
    monkeypatch.delattr("frictionjax.loads.completeness.course_of")
    scene.replace(z0=0.1)
    with pytest.raises(NameError):
        scene.replace(duration=5.0)


def test_loads_that_jump_are_refused_by_their_class():
    class Step(Wave):
        def __call__(self, t):
            return jnp.where(t < 1, 0.0, 1.0)

    with pytest.raises(ValueError, match=r"load: Step\.__call__ = 'jumps by 1 at t = 1"):
        scene_under(Step(1.0))


@jax.jit
@jax.vmap
def limits(rate):
    scene = eqx.tree_at(lambda s: s.load.rate, scene_under(Wave(1.0)), rate)
    return scene.turning_points(), fx.solve_limit(scene, [0.0, 6.0]).ok


def test_traced_ones_that_turn_elsewhere_have_a_status():
    times, ok = limits(jnp.array([1.0, 1.2]))
    np.testing.assert_allclose(times[0, :2], TURNS[:2])
    assert np.all(np.isnan(times[1]))
    assert ok.tolist() == [True, False]


class Swing(eqx.Module):
    """A function of time with a number to trace."""

    rate: jax.Array

    def __call__(self, t):
        return jnp.sin(self.rate * t)


BUILT = scene_under(fx.loads.Custom(Swing(jnp.ones(()))))
TOLD = {
    "numbers are": lambda x: scene_under(fx.loads.Custom(Swing(x))),
    "the duration is": lambda x: fx.Scene(*PARTS, fx.loads.Custom(jnp.sin), x),
}
UNTOLD = {
    "listed": lambda x: scene_under(fx.loads.Custom(Swing(x), TURNS)),
    "built": lambda x: eqx.tree_at(lambda s: s.load.fn.rate, BUILT, x).replace(z0=0.1),
    "known": lambda x: scene_under(fx.loads.Custom(jnp.sin)),
    "longer": lambda x: BUILT.replace(duration=x),
}


@pytest.mark.parametrize("what", TOLD)
def test_functions_of_which_nothing_can_be_found_are_told(what):
    """Derivatives were NaN without a word."""
    mend = r"list turning_points, or trace numbers of a scene that is built \(.*tree_at"
    with pytest.warns(fx.loads.UnprovedLoad, match=f"load.fn: {what} traced, .*; {mend}"):
        eqx.filter_eval_shape(TOLD[what], jnp.ones(()))


@pytest.mark.parametrize("what", UNTOLD)
def test_what_has_been_found_or_listed_is_traced_without_a_warning(what):
    eqx.filter_eval_shape(UNTOLD[what], jnp.ones(()))


METHODS = {
    "numpy": ({"__call__": lambda self, t: np.sin(t)}, "__call__ = .*jax.numpy"),
    "no times": (
        {"turning_points": lambda self, duration, count: (duration,) * count},
        r"turning_points = .*: needs times, shape \(count,\)",
    ),
    "known times": (
        {"turning_points": lambda self, end, count: np.full(count, float(end))},
        r"turning_points = Other\(rate=1.*jax.numpy",
    ),
    "no count": (
        {"turning_count": lambda self, duration: jnp.asarray(2.0)},
        "turning_count = 2: needs a whole number >= 0",
    ),
}


@pytest.mark.parametrize("case", METHODS)
def test_methods_that_are_none_are_named(case):
    methods, message = METHODS[case]
    with pytest.raises(ValueError, match=rf"load: Other\.{message}"):
        scene_under(type("Other", (Wave,), methods)(1.0))
