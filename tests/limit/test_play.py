"""The limit system: closed forms, brute force, balances, derivatives, batches."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from at_places import part_at

import frictionjax as fx
from frictionjax.limit import play_operator

SURFACE = fx.profiles.Fourier(cos=[0.0, 0.01], sin=[0.03, 0.0])
BRISTLE = fx.bristles.VerticalSpring(2.0, 1.5, 1.0)
FOUND = fx.friction(SURFACE, BRISTLE)
PLUS, MINUS = float(FOUND.rho_plus), float(FOUND.rho_minus)
SPRING = fx.supports.Spring(1.6)
QUARTIC = fx.supports.Convex(lambda z: z**2 / 2 + z**4 / 4)
LOG_COSH = fx.supports.Convex(lambda z: jnp.log(jnp.cosh(z)) + z**2)
# Rises, holds, falls back a little inside the strip, and loops several times.
LOOPS = fx.loads.PiecewiseLinear(
    [0.0, 0.5, 0.7, 0.9, 1.1, 1.2, 1.5, 1.6, 2.4],
    [0.0, 1.2, 1.2, 0.9, 1.5, 1.4, -1, 0.2, 0.2],
)


def scene(load, support=SPRING, duration=3.0, z0=0.0):
    return fx.Scene(SURFACE, BRISTLE, support, load, duration, z0)


def test_a_ramp_in_closed_form():
    found = fx.solve_limit(scene(fx.loads.Ramp(0.7, 0.1), z0=0.05), jnp.linspace(0, 3, 301))
    z = np.maximum(0.05, (0.1 + 0.7 * found.ts - PLUS) / 1.6)
    np.testing.assert_allclose(found.z, z, atol=1e-15)
    np.testing.assert_allclose(found.dissipation, PLUS * (z - 0.05), atol=1e-15)


@pytest.mark.parametrize("kind", [fx.loads.Sine, fx.loads.Triangle])
def test_a_hysteresis_loop_in_closed_form(kind):
    load, ts = kind(1.1, 2.0), jnp.linspace(0, 2.5, 401)
    found = fx.solve_limit(scene(load, duration=2.5), ts)
    lower, upper = (np.asarray(part_at(load, ts)) - np.array([[PLUS], [MINUS]])) / 1.6
    top, bottom = (1.1 - PLUS) / 1.6, (-1.1 - MINUS) / 1.6
    z = np.where(ts < 0.5, np.maximum(0, lower), np.minimum(top, upper))
    z = np.where(ts < 1.5, z, np.maximum(bottom, lower))
    spent = np.where(ts < 0.5, PLUS * z, PLUS * top + MINUS * (z - top))
    back = PLUS * top + MINUS * (bottom - top) + PLUS * (z - bottom)
    np.testing.assert_allclose(found.z, z, atol=4e-15)
    np.testing.assert_allclose(
        found.dissipation, np.where(ts < 1.5, spent, back), atol=4e-15
    )


def incremental(force, inverse, load, z):
    """Minimise Phi - l z + R(z - last) step by step; state and dissipation at each."""
    states, spent = np.empty(load.size), np.zeros(load.size)
    for i, value in enumerate(load):
        last, drive = z, value - force(z)
        if drive > PLUS:
            z = inverse(value - PLUS, z)
        elif drive < MINUS:
            z = inverse(value - MINUS, z)
        states[i], spent[i] = z, PLUS * max(z - last, 0) + MINUS * min(z - last, 0)
    return states, np.cumsum(spent)


def newton(force, stiffness):
    def inverse(value, z):
        for _ in range(4):
            z -= (force(z) - value) / stiffness(z)
        return z

    return inverse


LAWS = {
    "spring": (SPRING, lambda z: 1.6 * z, lambda z: 1.6),
    "quartic": (QUARTIC, lambda z: z + z**3, lambda z: 1 + 3 * z * z),
    "log cosh": (
        LOG_COSH,
        lambda z: np.tanh(z) + 2 * z,
        lambda z: 3 - np.tanh(z) ** 2,
    ),
}


@pytest.mark.parametrize(
    "law", ["spring", "quartic", pytest.param("log cosh", marks=pytest.mark.slow)]
)
def test_against_incremental_minimisation(law):
    support, force, stiffness = LAWS[law]
    ts = np.linspace(0, 3, 90_001)
    load = np.interp(ts, LOOPS.times, LOOPS.values)
    z, spent = incremental(force, newton(force, stiffness), load, 0.0)
    found = fx.solve_limit(scene(LOOPS, support), ts[::90])
    # The kinks of this load are times of the brute force too: no error of its steps.
    np.testing.assert_allclose(found.z, z[::90], atol=1e-12)
    np.testing.assert_allclose(found.dissipation, spent[::90], atol=1e-11)
    assert np.all(np.diff(found.dissipation) > -1e-15)


@pytest.mark.parametrize(
    ("load", "support"),
    [
        (fx.loads.Sine(1.3, 0.9), SPRING),
        (LOOPS, QUARTIC),
        pytest.param(LOOPS, SPRING, marks=pytest.mark.slow),
        pytest.param(fx.loads.Sine(1.3, 0.9), QUARTIC, marks=pytest.mark.slow),
    ],
)
def test_values_do_not_depend_on_the_times_asked_for(load, support):
    problem = scene(load, support)
    ts = jnp.linspace(0, 3, 73)
    fine = fx.solve_limit(problem, ts)
    for i in (72, 40, 17):
        alone = fx.solve_limit(problem, ts[i : i + 1])
        assert abs(alone.z[0] - fine.z[i]) < 1e-15
        assert abs(alone.dissipation[0] - fine.dissipation[i]) < 1e-14


def test_a_load_that_touches_the_edge_and_turns():
    edge = PLUS  # z0 = 0 starts to move where l = rho_plus
    touch = fx.loads.PiecewiseLinear([0.0, 1.0, 2.0], [0.0, edge, 0.0])
    found = fx.solve_limit(scene(touch))
    assert np.max(np.abs(found.z)) < 1e-15
    beyond = fx.loads.PiecewiseLinear([0.0, 1.0, 2.0], [0.0, edge + 1e-6, 0.0])
    assert abs(fx.solve_limit(scene(beyond)).z[-1] - 1e-6 / 1.6) < 1e-15


@pytest.mark.parametrize("support", [SPRING, QUARTIC])
def test_energy_balance(support):
    problem = scene(fx.loads.Sine(1.3, 0.9), support)
    ts = jnp.linspace(0, 3, 50_001)
    found = fx.solve_limit(problem, ts)
    energy = jax.vmap(support.energy)(found.z) - jax.vmap(problem.load)(ts) * found.z
    power = np.asarray(jax.vmap(problem.load.slope)(ts) * found.z)
    work = np.concatenate([[0], np.cumsum(0.5 * (power[1:] + power[:-1]))]) * 3 / 50_000
    balance = energy - energy[0] + work + found.dissipation
    assert np.max(np.abs(balance)) < 1e-7  # of the trapezoid


def test_a_start_outside_the_strip_is_an_error():
    outside = scene(fx.loads.Ramp(1.0, 0.2), z0=0.8)
    with pytest.raises(ValueError, match=r"scene.z0 = 0.8: needs .* \[") as error:
        fx.solve_limit(outside)
    low, high = (0.2 - PLUS) / 1.6, (0.2 - MINUS) / 1.6
    assert f"[{low:.9g}, {high:.9g}]" in str(error.value)
    for edge in (low, high):
        fx.solve_limit(scene(fx.loads.Ramp(1.0, 0.2), z0=edge), [0.0])


@pytest.mark.parametrize(
    "ts", [[0.0, 4.0], [-1.0], [1.0, 0.5], [], [[1.0]], [np.nan]], ids=str
)
def test_wrong_times_are_named(ts):
    with pytest.raises(ValueError, match="ts = "):
        fx.solve_limit(scene(LOOPS), ts)


def test_traced_numbers_that_are_refused_when_known_are_nan():
    def run(z0, ts):
        return fx.solve_limit(scene(fx.loads.Ramp(1.0, 0.2), z0=z0), ts)

    low, high = (0.2 - PLUS) / 1.6, (0.2 - MINUS) / 1.6
    times, turned = [0.0, 3.0], [2.0, 1.0]
    good = [(low, times), (high, times)]
    wrong = [(low - 1e-6, times), (high + 1e-6, times)]
    wrong += [(0.0, turned), (0.0, [-1.0, 1.0]), (0.0, [1.0, 4.0])]
    z0, ts = map(jnp.asarray, zip(*good, *wrong, strict=True))
    found = jax.jit(jax.vmap(run))(z0, ts)
    assert found.ok.tolist() == 2 * [True] + 5 * [False]
    assert np.all(np.isnan(found.z[2:]) & np.isnan(found.dissipation[2:]))
    assert np.isnan(jax.grad(lambda z0: run(z0, ts[0]).z[1])(high + 1e-6))


def numbered(p):
    """A scene whose every number is one of `p`; built under a trace."""
    return fx.Scene(
        fx.profiles.Sine(p[0]),
        fx.bristles.VerticalSpring(p[1], p[2], p[3]),
        fx.supports.Spring(p[4]),
        fx.loads.Triangle(p[5], p[6]),
        duration=p[7],
        z0=p[8],
    )


NUMBERS = jnp.asarray([0.2, 2.0, 1.5, 1.0, 1.6, 1.1, 2.0, 2.95, 0.01])


def test_derivatives_in_every_number():
    ts = jnp.asarray([0.3, 1.3, 2.1, 2.9])

    def solve(p):
        found = fx.solve_limit(numbered(p), ts)
        return jnp.concatenate([found.z, found.dissipation])

    weights = np.arange(1.0, 9.0)

    def weighed(p):
        values = solve(p)
        return values @ weights, values

    outcome = jax.jit(jax.value_and_grad(weighed, has_aux=True))
    (_, values), slopes = outcome(NUMBERS)
    known = fx.solve_limit(numbered(NUMBERS), ts)
    np.testing.assert_allclose(values[:4], known.z, atol=1e-15)
    ends = [NUMBERS + 1e-5 * s * unit for unit in np.eye(NUMBERS.size) for s in (1, -1)]
    values = np.array([outcome(p)[0][0] for p in ends]).reshape(-1, 2)
    expected = (values[:, 0] - values[:, 1]) / 2e-5
    np.testing.assert_allclose(slopes, expected, rtol=1e-6, atol=1e-8)


def test_derivative_through_a_convex_support():
    def stiffened(k):
        support = fx.supports.Convex(lambda z: k * z**2 / 2 + z**4 / 4)
        return fx.solve_limit(scene(LOOPS, support), jnp.asarray([1.1])).z[0]

    # There Phi'(z) = k z + z^3 = 1.5 - rho_plus.
    z = float(stiffened(1.2))
    assert 1.2 * z + z**3 == pytest.approx(1.5 - PLUS, rel=1e-14)
    assert jax.jit(jax.grad(stiffened))(1.2) == pytest.approx(
        -z / (1.2 + 3 * z**2), rel=1e-12
    )


def test_a_batch_equals_its_lanes_and_lacks_room_honestly():
    problem = scene(fx.loads.Sine(1.1, 2.0))  # room for 4 turning points
    ts = jnp.linspace(0, 3, 21)

    def lane(period):
        other = eqx.tree_at(lambda s: s.load.period, problem, period)
        return fx.solve_limit(other, ts)

    periods = jnp.asarray([2.0, 1.7, 5.0, 0.2])
    batch = eqx.filter_jit(eqx.filter_vmap(lane))(periods)
    for i in range(3):
        alone = fx.solve_limit(scene(fx.loads.Sine(1.1, periods[i])), ts)
        np.testing.assert_allclose(batch.z[i], alone.z, atol=1e-15)
        np.testing.assert_allclose(batch.dissipation[i], alone.dissipation, atol=1e-14)
    assert np.all(np.isnan(batch.z[3]))  # 30 turning points do not fit
    assert np.all(np.isnan(batch.dissipation[3]))


def test_a_limit_as_a_data_set_has_units_and_says_how_it_ended():
    pulled = scene(LOOPS)
    ts = np.linspace(0.0, 3.0, 7)
    found = fx.solve_limit(pulled, ts)
    data = found.to_dataset()
    np.testing.assert_array_equal(data.z, found.z)
    np.testing.assert_array_equal(data.time, ts)
    assert {name: data[name].units for name in data} == {"z": "m", "dissipation": "J"}
    assert data.attrs == {"status": "OK", "message": found.message}
    several = jax.vmap(lambda z0: fx.solve_limit(scene(LOOPS, z0=z0), ts))
    with pytest.raises(ValueError, match="solution = 'a batch': needs one trajectory"):
        several(jnp.array([0.0, 0.05])).to_dataset()


def test_a_strip_that_is_not_known_leaves_nothing_known_after_it():
    """Python's `min` and `max` step over NaN."""
    lower, upper = np.array([0.0, 0.2, np.nan, 0.0]), np.array([1.0, 1.0, 1.0, 1.0])
    np.testing.assert_array_equal(
        play_operator(lower, upper, -1.0), [0.0, 0.2, np.nan, np.nan]
    )
    np.testing.assert_array_equal(play_operator(-upper, -lower, 2.0)[2:], [np.nan] * 2)


@pytest.mark.parametrize("name", ["z", "dissipation"])
def test_one_number_that_is_not_finite_is_enough(name):
    found = fx.solve_limit(scene(LOOPS), [0.0, 1.0, 2.0])
    assert found.ok
    lost = getattr(found, name).at[1].set(jnp.nan)
    wrong = eqx.tree_at(lambda solution: getattr(solution, name), found, lost)
    assert not wrong.ok
    assert wrong.status.name == "NOT_FINITE"
