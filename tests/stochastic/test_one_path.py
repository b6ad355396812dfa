"""One path in tiles: the bits of the path at once."""

import numpy as np
import pytest
from noisy_wells import SLANTED

import frictionjax as fx
from frictionjax.effects import Noise
from frictionjax.stochastic import (
    key_words,
    noisy_path,
    noisy_paths,
    one_path,
    path_keys,
)
from frictionjax.stochastic.settings import SETTINGS

SCENE = fx.Scene(
    SLANTED.profile,
    SLANTED.bristle,
    fx.supports.Spring(1.0),
    fx.loads.Sine(1.5, 4.0),
    4.0,
)
KEY = key_words(3)
TS = np.linspace(0.0, 4.0, 41)


def at_once(scene, noise, ts, **cell):
    return noisy_paths(scene, noise, keys=KEY[None], ts=ts, **cell)


def offset_guesses(monkeypatch, wells):
    """Guesses that are `wells` periods of 0.05 m off, but for the scene's own start."""
    guesses = one_path._guesses

    def wrong(*given):
        off = np.full(SETTINGS.lanes, 0.05 * wells)
        off[0] = 0.0
        return guesses(*given) + off

    monkeypatch.setattr(one_path, "_guesses", wrong)


@pytest.mark.parametrize(
    ("eps", "gamma", "heat", "most"),
    [(0.02, 1.0, 0.02, 4), (0.05, 1.0, 1e-4, 6), (0.05, 0.5, 0.02, 14)],
)
def test_it_has_the_bits_of_the_path_at_once_after_few_rounds(eps, gamma, heat, most):
    """The more wells a tile goes through, and the longer tips rest in them, the fewer."""
    cell = {"eps": eps, "gamma": gamma}
    whole = at_once(SCENE, Noise(heat), TS, **cell)
    tiled = noisy_path(SCENE, Noise(heat), key=KEY, ts=TS, **cell)
    assert np.array_equal(tiled.z, whole.z[0])
    assert (tiled.step, tiled.steps, tiled.ok) == (whole.step, whole.steps, True)
    assert 2 <= tiled.rounds <= most < SETTINGS.lanes


@pytest.mark.parametrize("method", ["auto", "resolved", "windowed"])
def test_a_solve_by_each_of_our_methods_is_that_path_in_windows(method):
    scene = SCENE.replace(effects=(Noise(0.02),))
    whole = at_once(SCENE, Noise(0.02), TS, eps=0.02, gamma=1.0)
    found = fx.solve(scene, 0.02, 1.0, TS, method=method, key=3)
    assert np.array_equal(found.z, whole.z[0])
    assert 2 <= found.stats["rounds"] < SETTINGS.lanes
    assert found.how.endswith("in windows")


@pytest.mark.parametrize(
    "ts", [[0.0], [0.0, 0.0, 1e-9], [4.0], [1.7, 1.7, 1.70001, 1.8], np.linspace(2, 4, 300)]
)
def test_any_times_are_told(ts):
    cell = {"eps": 0.05, "gamma": 1.0}
    whole = at_once(SCENE, Noise(0.02), ts, **cell)
    tiled = noisy_path(SCENE, Noise(0.02), key=KEY, ts=ts, **cell)
    assert np.array_equal(tiled.z, whole.z[0])


def test_a_bracket_of_paths_closes_once_the_load_has_gone_a_strip():
    """What a window that skips steps would cost: noise knows no nearer bounds.

    At two lanes a window and 16 lanes a call, eight windows are 0.04 of a path of 3 s or
    more; a path in tiles is 2/16 to 3/16, for any number of times.
    """
    rate, twice = 4 * 1.0488 / 3, 2 * 0.1
    parts = fx.profiles.Sine(0.1), fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    scene = fx.Scene(*parts, fx.supports.Spring(1.0), fx.loads.Ramp(rate), 0.4)
    ts, cell = np.linspace(0.0, 0.4, 401), {"eps": 0.02, "gamma": 1.0}
    tail = 8.5 * np.sqrt(0.003 * 0.02)  # deviations of a tip on its spring alone
    lower, upper = (
        noisy_paths(scene, Noise(0.003), keys=path_keys(1, 16), ts=ts, z0=z0, **cell).z
        for z0 in (-0.1 - tail, 0.1 + tail)
    )
    apart = upper - lower > 1e-3 * 0.02
    assert np.all(upper - lower >= 0)
    closed = ts[[np.flatnonzero(row)[-1] + 1 for row in apart]]
    assert 0.8 * twice / rate < np.median(closed) < (twice + 2 * tail) / rate


@pytest.mark.parametrize("wells", [-40, 3])
def test_guesses_decide_nothing(wells, monkeypatch):
    cell = {"eps": 0.05, "gamma": 1.0}
    whole = at_once(SCENE, Noise(0.02), TS, **cell)
    offset_guesses(monkeypatch, wells)
    tiled = noisy_path(SCENE, Noise(0.02), key=KEY, ts=TS, **cell)
    assert np.array_equal(tiled.z, whole.z[0])


def test_a_tip_that_forgets_nothing_takes_a_round_a_tile(monkeypatch):
    """Cold and at rest: each tile stays in the well where it was guessed."""
    cell, cold = {"eps": 0.05, "gamma": 1.0}, Noise(1e-6)
    rests = SCENE.replace(load=fx.loads.Ramp(0.0), z0=0.0)
    whole = at_once(rests, cold, TS, **cell)
    offset_guesses(monkeypatch, 1)
    tiled = noisy_path(rests, cold, key=KEY, ts=TS, **cell)
    assert tiled.rounds == SETTINGS.lanes
    assert np.array_equal(tiled.z, whole.z[0])


def test_what_is_not_finite_ends_and_says_so():
    wall = fx.supports.Convex(lambda z: 0.5 * z**2 + 1e3 * z**12)
    beyond = SCENE.replace(support=wall, z0=2.0)
    tiled = noisy_path(beyond, Noise(0.02), key=KEY, ts=TS, eps=0.05, gamma=1.0)
    assert not tiled.ok
    assert tiled.z[0] == 2.0
