"""Straight flanks with corners of a radius."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.io.scene_files import parse_scene, scene_document

BRISTLE = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
SAWTOOTH = ([0.0, 0.8], [0.0, 0.05], 0.02)
SURFACES = {  # four points each: one program for all
    "a sawtooth, points on its flanks": (
        [0.1, 0.3, 0.9, 0.95],
        [0.0, 0.0125, 0.05, 0.05 * 2 / 3],
        0.02,
    ),
    "a groove with flat land": ([0.3, 0.45, 0.5, 0.9], [0.0, -0.03, -0.03, 0.0], 0.05),
    "corners that touch": ([0.0, 0.25, 0.5, 0.75], [0.0, 0.025, 0.0, 0.025], 0.8333333),
    "a corner over the seam": ([0.01, 0.4, 0.7, 0.95], [0.0, 0.04, 0.01, 0.03], 0.03),
    "a corner into the next period": (
        [0.05, 0.3, 0.6, 0.99],
        [0.03, 0.01, 0.04, 0.0],
        0.03,
    ),
}


def flanks(x, heights):
    gaps = np.diff(np.append(x, x[0] + 1))
    return np.diff(np.append(heights, heights[0])) / gaps


@jax.jit
def _derivatives(x, heights, radius, y):
    surface = fx.profiles.Polyline(x, heights, radius)
    first = jax.grad(surface)
    return [jax.vmap(fn)(y) for fn in (surface, first, jax.grad(first))]


def derivatives(name, y):
    x, heights, radius = SURFACES[name]
    places = np.resize(y, 20001)  # one shape
    found = _derivatives(jnp.asarray(x), jnp.asarray(heights), radius, places)
    return [np.asarray(values)[: np.size(y)] for values in found]


@pytest.mark.parametrize("name", SURFACES)
def test_slopes_stay_between_those_of_the_flanks(name):
    x, heights, radius = SURFACES[name]
    fx.profiles.Polyline(x, heights, radius)  # corners fit
    slopes = flanks(x, heights)
    _, slope, bend = derivatives(name, np.linspace(0, 1, 20001))
    assert slope.max() == pytest.approx(slopes.max(), abs=1e-6)
    assert slope.min() == pytest.approx(slopes.min(), abs=1e-6)
    assert slope.max() <= slopes.max() + 1e-16
    assert slope.min() >= slopes.min() - 1e-16
    _, mean, sharpest = derivatives(name, np.asarray(x))
    turns = np.abs(sharpest) > 1e-3
    radii = (1 + mean[turns] ** 2) ** 1.5 / np.abs(sharpest[turns])
    np.testing.assert_allclose(radii, radius, rtol=1e-9)
    assert np.max(np.abs(bend)) <= np.max(np.abs(sharpest)) * (1 + 1e-12)


@pytest.mark.parametrize("name", SURFACES)
def test_it_is_smooth(name):
    value, slope, bend = derivatives(name, np.linspace(0, 1, 20001))
    width, most = 1 / 20000, np.max(np.abs(bend))
    means = [0.5 * (part[1:] + part[:-1]) for part in (slope, bend)]
    # What the trapezoid leaves is of second order only where nothing jumps.
    assert np.max(np.abs(np.diff(value) - width * means[0])) < 0.1 * width**2 * most
    assert np.max(np.abs(np.diff(slope) - width * means[1])) < 0.1 * width * most
    assert np.max(np.abs(np.diff(bend))) < 0.1 * most


def test_period_one_and_no_digits_lost_far_away():
    surface = jax.jit(fx.profiles.Polyline(*SAWTOOTH).__call__)
    y = np.round(np.linspace(-1, 1, 257) * 2**20) / 2**20  # so that y + 1e8 is exact
    for away in (1.0, -3.0, 1e8):
        np.testing.assert_allclose(surface(y + away), surface(y), atol=1e-15)
    assert surface(jnp.zeros((3, 2))).shape == (3, 2)
    assert surface(jnp.zeros(())).shape == ()


def test_flanks_lie_where_the_lines_are():
    name = "a groove with flat land"
    x, heights, _ = SURFACES[name]
    y = np.linspace(0, 1, 3001)
    lines = np.interp(y, [0.0, *x, 1.0], [0.0, *heights, 0.0])
    apart = np.abs(derivatives(name, y)[0] - lines)
    near = np.min(np.abs(y[:, None] - np.array(x)), axis=1) < 0.025
    assert np.all(apart[~near] < 1e-15)
    assert apart[near].max() > 1e-5


@pytest.mark.parametrize("turned", [False, True])
def test_friction_of_a_sawtooth_is_exact(turned):
    x, heights, radius = SAWTOOTH
    if turned:
        heights = [-h for h in heights]
    found = fx.friction(fx.profiles.Polyline(x, heights, radius), BRISTLE)
    low, high = (-0.0625, 0.25) if turned else (-0.25, 0.0625)
    assert found.omega_plus == pytest.approx(high, abs=1e-15)
    assert found.omega_minus == pytest.approx(low, abs=1e-15)
    assert found.omega_plus_error is None  # nothing is open


def _values(numbers):
    surface = fx.profiles.Polyline(numbers[:4], numbers[4:8], numbers[8])
    found = fx.friction(surface, BRISTLE)
    values = jnp.append(surface(Y), jnp.stack([found.rho_plus, found.rho_minus]))
    return values, values


Y = jnp.asarray([0.01, 0.051, 0.06, 0.2, 0.201, 0.35, 0.9, 0.99])


def test_gradients_of_heights_and_of_friction():
    numbers = jnp.asarray([0.05, 0.2, 0.5, 0.9, 0.0, 0.02, -0.01, 0.01, 0.02])
    both = jax.jit(jax.jacfwd(_values, has_aux=True))
    found = both(numbers)[0]
    moved = [[both(numbers.at[i].add(s))[1] for s in (1e-6, -1e-6)] for i in range(9)]
    expected = np.array([(ahead - behind) / 2e-6 for ahead, behind in moved]).T
    np.testing.assert_allclose(found, expected, atol=2e-8)


def test_a_scene_file_holds_it():
    scene = fx.Scene(
        fx.profiles.Polyline(*SAWTOOTH),
        BRISTLE,
        fx.supports.Spring(1.0),
        fx.loads.Ramp(1.0),
        duration=1.0,
    )
    again = parse_scene(scene_document(scene), "again").scene
    assert jax.tree_util.tree_structure(again) == jax.tree_util.tree_structure(scene)
    leaves = [jax.tree_util.tree_leaves(part) for part in (scene, again)]
    assert all(map(np.array_equal, *leaves))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"x": [0.0, 1.0]}, "profile.x = .*x = 1 is the first one again and is not"),
        ({"x": [0.2, 1.2]}, "profile.x = .*x = 1 is the first one again and is not"),
        ({"x": [-0.1, 0.5]}, "profile.x = .*needs 0 <= x < 1"),
        ({"x": [0.8, 0.1]}, "profile.x = .*increasing positions"),
        ({"x": [0.5, 0.5]}, "profile.x = .*increasing positions"),
        ({"x": [0.0, np.nan]}, "profile.x = .*finite"),
        ({"x": [0.0]}, "profile.x = .*2 or more positions"),
        ({"x": "flank"}, "profile.x = 'flank'"),
        ({"heights": [0.0, 0.1, 0.2]}, r"profile.heights = .*shape \(2,\) of x"),
        ({"heights": [0.0, np.inf]}, "profile.heights = .*finite"),
        ({"heights": [0.1, 0.1]}, "profile.heights = .*vary"),
        ({"radius": 0.0}, "profile.radius = 0: needs radius > 0"),
        ({"radius": [0.1, 0.1]}, "profile.radius = .*one number"),
        ({"radius": 1.0}, "profile.radius = 1: needs radius <= 0.43"),
    ],
)
def test_wrong_points_are_named(change, message):
    given = dict(zip(("x", "heights", "radius"), SAWTOOTH, strict=True)) | change
    with pytest.raises(ValueError, match=message):
        fx.profiles.Polyline(**given)


def test_the_largest_radius_fits():
    with pytest.raises(ValueError, match="radius <= ") as caught:
        fx.profiles.Polyline(*SAWTOOTH[:2], 10.0)
    largest = float(str(caught.value).split("<= ")[1].split(",")[0])
    fx.profiles.Polyline(*SAWTOOTH[:2], 0.99999 * largest)
    with pytest.raises(ValueError, match="radius <= "):
        fx.profiles.Polyline(*SAWTOOTH[:2], 1.00001 * largest)


@pytest.mark.slow
def test_a_sweep_over_flat_extremes_can_be_trusted():
    scene = fx.Scene(
        fx.profiles.Polyline([0.0, 0.8], [0.0, 0.05], 0.1),
        BRISTLE,
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0488, 3.0),
        duration=3.0,
    )
    data = fx.sweep(scene, [0.1, 0.05, 0.02], [0.75, 1.0])
    assert not data.status.values.any()
    assert fx.solve(scene, 0.05).ok
