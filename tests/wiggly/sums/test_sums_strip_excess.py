"""How far tips leave the strip (Lemma 7), where the limit slides and where it rests."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.loads import PiecewiseLinear

EDGE = 0.1  # rho_plus of `scene_under`, N
SPRING = fx.supports.Spring(1.0)
QUARTIC = fx.supports.Convex(lambda z: 0.5 * z**2 + z**4)
SOFT_PLUS = fx.supports.Convex(lambda z: 0.5 * z**2 + 0.2 * jnp.logaddexp(0.0, 5 * z))


def scene_under(times, values, support=SPRING, duration=2.5):
    parts = fx.profiles.Sine(EDGE), fx.bristles.Homothetic(1.0), support
    return fx.Scene(*parts, PiecewiseLinear(times, values), duration)


RELOADED = [0.0, 1.0, 2.0, 2.0001, 2.5]
# Of `scene_under`, which each worker would call while it collects.
CASES = {
    # Faster inside the strip than tips follow: the limit rests, z is left outside.
    "reloaded": (RELOADED, [0.0, 0.503, 0.32, 0.4999, 0.4999]),
    "to the left": (RELOADED, [0.0, -0.503, -0.31, -0.49, -0.49]),
    "at rest throughout": (
        [0.0, 1e-4, 1.0, 1.0001, 2.0],
        [0.0, 0.0999, 0.0, -0.0999, -0.0999],
    ),
    "quartic": (RELOADED, [0.0, 1.503, 1.32, 1.4999, 1.4999], QUARTIC),
    # Turned while z is still behind, several strips outside.
    "turned at once": ([0.0, 1e-3, 2e-3, 3e-3, 1.0], [0.0, 2.0, -1.0, 0.5, 0.5], QUARTIC),
}


def cell_of(scene, eps, ts, accuracy=1e-3):
    return fx.sweep(scene, eps, 1.0, ts, accuracy).isel(eps=0, gamma=0)


def outside(scene, eps, ts):
    """How far z is outside at each time."""
    found = cell_of(scene, eps, ts, 1e-5)
    return np.maximum(found.z_minus - found.z, found.z - found.z_plus).values


def largest_outside(scene, eps):
    """Of z at many times, and at more where that is largest."""
    ends = 0.0, float(scene.duration)
    behind = np.geomspace(1e-2, 30, 100) * eps**2
    dense = [t + behind for t in np.asarray(scene.load.times)[:-1]]
    dense = np.unique(np.concatenate([np.linspace(*ends, 2001), *dense]))
    at = int(outside(scene, eps, dense).argmax())
    near = np.linspace(dense[max(at - 1, 0)], dense[min(at + 1, dense.size - 1)], 1001)
    return float(outside(scene, eps, near).max())


# A support of one's own is a program of its own.
OWN = [pytest.param(name, marks=pytest.mark.slow) for name in ("quartic", "turned at once")]


@pytest.mark.parametrize("eps", [0.1, pytest.param(0.01, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", ["reloaded", "to the left", "at rest throughout", *OWN])
def test_lanes_know_how_far_tips_leave_the_strip(name, eps):
    """Taken for the lag behind the limit, an eps of it was missed, or 0.2 too much."""
    scene = scene_under(*CASES[name])
    cell = cell_of(scene, eps, [0.0, float(scene.duration)])
    assert int(cell.status) == fx.Status.OK
    expected = max(largest_outside(scene, eps), 0.0)
    assert abs(float(cell.strip_excess) - expected) < 1e-3 * eps


@pytest.mark.slow  # a support of one's own
def test_where_the_support_is_soft_only_what_is_outside_counts():
    """Tips in the strip were said to be outside it, by 0.68 eps for 0.31."""
    soft = fx.supports.Convex(lambda z: 0.025 * z**2 + z**4 / 4)
    parts = fx.profiles.Sine(0.05), fx.bristles.Homothetic(1.0), soft
    scene, eps = fx.Scene(*parts, fx.loads.Sine(0.1, 26.6), 26.6), 1e-3
    cell = cell_of(scene, eps, np.linspace(0.0, 26.6, 100_001))
    seen = np.maximum(cell.z_minus - cell.z, cell.z - cell.z_plus).values.max()
    assert int(cell.status) == fx.Status.OK
    assert abs(float(cell.strip_excess) - seen) < 2e-3 * eps


def test_what_a_reload_leaves_outside_is_the_most():
    """What is outside before the last reload is less: that is what is measured."""
    scene = scene_under(*CASES["reloaded"])
    cells = [cell_of(scene, 0.1, [0.0, 2.5])]
    times, values = RELOADED[:3], [0.0, 0.503, 0.32]
    cells.append(cell_of(scene_under(times, values, duration=1.9), 0.1, [0.0, 1.9]))
    whole, before = (float(cell.strip_excess) for cell in cells)
    assert whole > before + 0.05 * 0.1


def test_tips_leave_by_the_edge_that_the_load_does_not_move():
    """V_eps' exceeds rho_plus by a share of eps; on a stiff support z meets all of it."""
    profile = fx.profiles.Fourier([-0.0509, -0.0034], [0.0152, -0.0036])
    parts = profile, fx.bristles.VerticalSpring(10.0, 1.05, 1.0), fx.supports.Spring(5.0)
    eps, load = 0.3, PiecewiseLinear([0.0, 200.0], [0.0, -4.5])
    scene = fx.Scene(*parts, load, 200.0)
    ts = np.linspace(0.0, 200.0, 2001)
    cell = fx.sweep(scene, eps, 2.0, ts).isel(eps=0, gamma=0)
    below, above = cell.z_minus - cell.z, cell.z - cell.z_plus
    assert float(below.max()) > float(above.max()) + 5e-4 * eps  # while z goes left
    assert abs(float(cell.strip_excess - below.max())) < 1e-4 * eps


@pytest.mark.parametrize("support", [SPRING, QUARTIC, SOFT_PLUS])
def test_states_near_a_guess_are_those_found_without(support):
    # One loop each: op by op every call compiles its own.
    state_of = jax.jit(lambda force: support.state_of(force))
    state_near = jax.jit(lambda force, guess: support.state_near(force, guess))
    for force in (-2.0, 0.1, 0.7, 3.0):
        state = state_of(force)
        for off in (0.0, 0.02, -0.02):
            near = state_near(force, state + off)
            assert abs(float(near - state)) < 1e-11
