"""`CompliantArray`: bristles with supports of their own, in means."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.wiggly import arrays

TWO_WAVES = np.array([0.1, 0.04j]) / (2 * np.pi)  # sin - i cos of two harmonics
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
TS = np.linspace(0, 3, 13)


def profile_ahead(offset):
    """`w(y + offset)`."""
    waves = (-1j * TWO_WAVES) * np.exp(2j * np.pi * offset * np.arange(1, 3))
    return fx.profiles.Fourier(cos=waves.real, sin=-waves.imag)


def scene_of(*effects, profile=None, z0=0.0):
    profile = profile_ahead(0.0) if profile is None else profile
    parts = fx.supports.Spring(1.0), fx.loads.Sine(1.0488, 3.0), 3.0
    return fx.Scene(profile, SLANTED, *parts, z0=z0, effects=effects)


def array_of(*offsets, **more):
    return scene_of(fx.effects.CompliantArray(np.array(offsets)), **more)


def test_one_bristle_is_the_scene_without():
    array, plain = (fx.solve(s, 1e-3, ts=TS) for s in (array_of(0.0), scene_of()))
    np.testing.assert_array_equal(array.z, plain.z)
    np.testing.assert_array_equal(array.dissipation, plain.dissipation)
    np.testing.assert_array_equal(array.stats["spread"], np.zeros(TS.size))


@pytest.mark.parametrize(("gamma", "eps"), [(1.0, 1e-2), (0.75, 1e-2), (0.4, 1e-3)])
@pytest.mark.parametrize("offset", [0.3, -2.71])
@pytest.mark.parametrize("method", ["auto", "resolved"])
def test_a_bristle_ahead_is_one_on_a_surface_that_is(gamma, eps, offset, method):
    z0, ts = 0.013, np.sort([0.02, 0.05, *TS])  # at rest where it sets off, first
    ahead = fx.solve(array_of(offset, z0=z0), eps, gamma, ts=ts, method=method)
    moved = scene_of(profile=profile_ahead(offset), z0=z0)
    other = fx.solve(moved, eps, gamma, ts=ts, method=method)
    assert ahead.ok
    assert other.ok
    np.testing.assert_allclose(ahead.z, other.z, atol=1e-3 * eps)
    np.testing.assert_allclose(ahead.dissipation, other.dissipation, rtol=1e-5, atol=1e-9)


def test_an_array_is_the_mean_of_its_bristles():
    offsets = 0.0, 0.21, 0.67
    array = fx.solve(array_of(*offsets), 1e-2, ts=TS)
    alone = [fx.solve(array_of(offset), 1e-2, ts=TS) for offset in offsets]
    np.testing.assert_allclose(array.z, np.mean([s.z for s in alone], axis=0), rtol=1e-14)
    spread = np.std([s.z for s in alone], axis=0)
    np.testing.assert_allclose(array.stats["spread"], spread, rtol=1e-12, atol=1e-17)


@pytest.mark.slow  # a batch of its own
def test_more_bristles_than_are_integrated_at_once(monkeypatch):
    offsets = np.linspace(0, 0.9, 10)
    whole = fx.solve(array_of(*offsets), 1e-2, ts=TS)
    monkeypatch.setattr(arrays, "SETTINGS", arrays.SETTINGS._replace(bristles=3))
    parts = fx.solve(array_of(*offsets), 1e-2, ts=TS)
    np.testing.assert_allclose(parts.z, whole.z, rtol=1e-14)
    assert parts.stats["steps"] == whole.stats["steps"]


@pytest.mark.parametrize("many", [64, pytest.param(256, marks=pytest.mark.slow)])
def test_ripple_falls_with_the_root_of_their_number(monkeypatch, many):
    """On a slide at constant speed bristles do the same, one after the other."""
    # So few bristles and times fit into the loop of lanes that the other tests run.
    monkeypatch.setattr(arrays, "SETTINGS", arrays.SETTINGS._replace(bristles=32))
    load = fx.loads.Ramp(1.0, 0.0)
    ts = 0.5 + np.linspace(0, 0.0317, 16)  # three slips, after thirty

    def ripple(count, seed):
        offsets = np.random.default_rng(seed).uniform(size=count)
        scene = array_of(*offsets).replace(load=load, z0=0.0)
        z = np.asarray(fx.solve(scene, 1e-2, ts=ts).z)
        return np.std(z - np.polyval(np.polyfit(ts, z, 1), ts))

    one = ripple(1, 0)
    for count in (16, many):
        shares = [ripple(count, seed) ** 2 * count / one**2 for seed in range(4)]
        # Of independent phases each is spread exponentially with the mean 1.
        assert 0.4 < np.mean(shares) < 2.0, shares
    # Evenly spread they do not ripple at all but at every 64th harmonic.
    even = array_of(*(np.arange(64) / 64)).replace(load=load)
    z = np.asarray(fx.solve(even, 1e-2, ts=ts).z)
    assert np.std(z - np.polyval(np.polyfit(ts, z, 1), ts)) < 0.03 * one


def test_a_sweep_has_means_and_spreads():
    array = array_of(0.0, 0.21, 0.67)
    data = fx.sweep(array, [1e-2, 5e-3], [1.0], TS)
    alone = fx.solve(array, 5e-3, ts=TS)
    np.testing.assert_allclose(data.z.sel(eps=5e-3, gamma=1.0), alone.z, rtol=1e-13)
    spread = data.z_spread.sel(eps=5e-3, gamma=1.0)
    np.testing.assert_allclose(spread, alone.stats["spread"], rtol=1e-9, atol=1e-15)
    assert data.z_spread.attrs["units"] == "m"
    assert fx.study(data) is not None
    # Suprema are of each bristle: no less than those of what is told beside them.
    for name in ("z", "dissipation"):
        least = np.abs(data[name] - data[f"{name}_limit"]).max("time")
        most = data["sup_error" if name == "z" else "dissipation_error"]
        assert np.all(most > least)
        assert "mean over its bristles" in most.attrs["comment"]
    assert "furthest" in data.strip_excess.attrs["comment"]


def test_a_bristle_that_fails_is_told(monkeypatch):
    found = arrays.integrate_cells

    def one_fails(**asked):
        cells = found(**asked)
        status = cells.status.copy()
        status[1] = int(fx.Status.MAX_STEPS)
        return cells._replace(status=status)

    monkeypatch.setattr(arrays, "integrate_cells", one_fails)
    assert fx.solve(array_of(0.0, 0.2), 1e-2, ts=TS).status == fx.Status.MAX_STEPS


def test_engines_that_do_not_are_named():
    with pytest.raises(ValueError, match=r"solver of diffrax.* does not do CompliantArray"):
        fx.solve(array_of(0.1), 1e-2, method="Kvaerno5")
    with pytest.raises(ValueError, match="ensemble does not do CompliantArray"):
        fx.ensemble(array_of(0.1), 1e-2, 1.0, [0.5], 2, 0)
