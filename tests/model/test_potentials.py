"""`V_eps`, its slope, and its expansion `eps W + eps^2 Q`."""

from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from at_places import at_places, part_at
from samples import FEW_BRISTLES, central, pair

import frictionjax as fx
from frictionjax.model.admissibility import largest_eps
from frictionjax.numerics.roots import bracketed_root

SIZES = 10.0 ** -np.arange(1, 9)
PLACES = 512  # of all tests, which then share programs
GRID = jnp.linspace(0, 1, PLACES + 1)[:-1] + 0.003


def potentials(kind, profile_kind="fourier"):
    signs = ((1, 3),) if kind == "angular" else ((1, 3), (-1, 4))
    return [fx.potential(*pair(profile_kind, kind, sign, seed)) for sign, seed in signs]


@eqx.filter_jit
def by_tip(potential, z, eps):
    """Force and G in the tip coordinate, at states `z`."""
    return jax.vmap(lambda s: potential.tip_force(potential.tip(s, eps)[1], eps))(z)


@pytest.mark.parametrize("kind", FEW_BRISTLES)
def test_force_by_the_inverse_equals_the_tip_force(kind):
    for potential in potentials(kind):
        largest = 0.99 * largest_eps(potential, 0.1)
        for eps in [largest, *(size for size in SIZES if size < largest)]:
            z = eps * jnp.linspace(-10, 10, PLACES)
            along, stretch = by_tip(potential, z, jnp.asarray(eps, float))
            found = potential.force(z, eps)
            size = jnp.max(jnp.abs(along))
            assert jnp.all(stretch > 0)
            assert jnp.max(jnp.abs(found - along)) < 1e-10 * size


@eqx.filter_jit
def at_tips(potential, y, eps):
    """Force, G and offset at once, and each alone."""
    once = jax.vmap(lambda place: potential.at_tip(place, eps))(y)
    alone = jax.vmap(lambda place: potential.offset(place, eps))(y)
    force, stretch = jax.vmap(lambda place: potential.tip_force(place, eps))(y)
    return once, (force, stretch, alone)


@pytest.mark.parametrize("kind", FEW_BRISTLES)
def test_one_look_at_a_tip_is_all_of_them(kind):
    for potential in potentials(kind):
        eps = jnp.asarray(0.5 * largest_eps(potential, 0.1))
        once, alone = at_tips(potential, jnp.linspace(-0.5, 0.5, 41), eps)
        assert jnp.max(jnp.abs(alone[0])) > 0
        for found, expected in zip(once, alone, strict=True):
            assert jnp.max(jnp.abs(found - expected)) <= 1e-14 * jnp.max(jnp.abs(expected))


@pytest.mark.parametrize("kind", FEW_BRISTLES)
def test_force_is_the_slope_of_the_energy(kind):
    for potential in potentials(kind):
        for eps in (3e-2, 1e-3):
            z = eps * (GRID - 0.3)
            slope = central(partial(potential.energy, eps=eps), z, 1e-3 * eps)
            found = potential.force(z, eps)
            size = jnp.max(jnp.abs(found))
            assert jnp.max(jnp.abs(found - slope)) < 1e-10 * size


@pytest.mark.parametrize("kind", FEW_BRISTLES)
def test_expansion_is_an_identity(kind):
    for potential in potentials(kind):
        for eps in (0.99 * largest_eps(potential, 0.1), 1e-2, 1e-3):
            energy = potential.energy(eps * GRID, eps)
            parts = eps * potential.W(GRID) + eps**2 * potential.Q(eps, GRID)
            assert jnp.max(jnp.abs(energy - parts)) < 1e-14 * jnp.max(jnp.abs(energy))


@eqx.filter_jit
def rest_slope(potential, eps):
    """Forwards: backwards it is a program of twice the size."""
    at_places = partial(potential.Q, eps)
    return jax.jvp(at_places, (GRID,), (jnp.ones_like(GRID),))[1]


@pytest.mark.parametrize("kind", FEW_BRISTLES)
def test_rest_and_its_slope_stay_bounded(kind):
    for potential in potentials(kind):
        limit = potential.Q(0.0, GRID)
        limit_slope = rest_slope(potential, jnp.zeros(()))
        size = jnp.max(jnp.abs(limit)) + 1e-3 * (kind == "homothetic")
        slope_size = jnp.max(jnp.abs(limit_slope)) + 1e-3 * (kind == "homothetic")
        for eps in (0.99 * largest_eps(potential, 0.1), *SIZES[1:]):
            found = potential.Q(eps, GRID)
            found_slope = rest_slope(potential, jnp.asarray(eps, float))
            assert jnp.max(jnp.abs(found)) < 10 * size
            assert jnp.max(jnp.abs(found_slope)) < 100 * slope_size
        assert jnp.max(jnp.abs(found - limit)) < 1e-6 * size  # eps = 1e-8 here
        assert jnp.max(jnp.abs(found_slope - limit_slope)) < 1e-6 * slope_size


@pytest.mark.parametrize("kind", FEW_BRISTLES)
def test_rest_at_zero_by_extrapolation(kind):
    # (V - eps W)/eps^2 at 8 sizes, a polynomial in eps through them, its value at 0.
    for potential in potentials(kind):
        nodes = 0.01 * (1 + np.cos(np.pi * (np.arange(8) + 0.5) / 8))
        rows = [
            (potential.energy(eps * GRID, eps) - eps * potential.W(GRID)) / eps**2
            for eps in nodes
        ]
        weights = [
            np.prod(np.delete(nodes, i) / (np.delete(nodes, i) - x))
            for i, x in enumerate(nodes)
        ]
        expected = np.asarray(weights) @ np.stack(rows)
        found = potential.Q(0.0, GRID)
        np.testing.assert_allclose(
            found, expected, atol=1e-8 + 1e-6 * np.max(np.abs(found))
        )


def test_the_rest_has_a_first_derivative_by_eps_at_zero():
    bristle = fx.bristles.Custom(lambda u: 0.3 * u + u**2, lambda u: u + u**3)
    rest = fx.potential(fx.profiles.Sine(0.5), bristle).Q

    @jax.jit
    @jax.vmap
    def found(eps):
        at_places = partial(rest, Y=jnp.asarray([0.13, 0.6]))
        return jax.jvp(at_places, (eps,), (jnp.ones(()),))

    width = 1e-4
    values, (_, slopes, _) = found(width * jnp.arange(-1.0, 2.0))
    behind, here, ahead = values
    for difference in (here - behind, ahead - here):
        np.testing.assert_allclose(slopes, difference / width, rtol=1e-3)
    np.testing.assert_allclose(slopes, (ahead - behind) / (2 * width), rtol=1e-7)


def test_rest_of_a_vertical_spring_in_closed_form():
    surface = fx.profiles.Sine(0.2)
    potential = fx.potential(surface, fx.bristles.VerticalSpring(3.0, 1.2, 1.0))
    for eps in (0.0, 1e-8, 1e-1):
        np.testing.assert_allclose(
            potential.Q(eps, GRID), 1.5 * surface(GRID) ** 2, rtol=1e-13
        )


@eqx.filter_jit
def there(potential, z, eps):
    number, inside = jax.vmap(lambda s: potential.tip(s, eps))(z)
    return number, inside, jax.vmap(lambda y: potential.offset(y, eps))(inside)


@eqx.filter_jit
def flat_tips(potential, Y):
    return jax.vmap(potential.flat_tip)(Y)


@eqx.filter_jit
def off_the_flat(potential, tips, Y):
    return tips + potential.a() * potential.profile(tips) - Y


@pytest.mark.parametrize("sharp", [1e-1, 1e-2, 1e-3])
def test_the_inverse_near_its_singular_end(sharp):
    # 1 + a omega_minus = sharp: Kepler's equation with eccentricity 1 - sharp.
    lean = np.arctan(1 / 0.5) - 1e-12
    surface = fx.profiles.Sine((1 - sharp) / np.tan(lean))
    potential = fx.potential(surface, fx.bristles.SlantedSpring(1.0, 3.0, 1.0, lean))
    y = np.linspace(-0.5, 0.5, 1001)[1:-1]
    Y = y - np.tan(lean) * np.asarray(part_at(surface, y))
    back = np.asarray(flat_tips(potential, Y))
    assert np.max(np.abs(off_the_flat(potential, back, Y))) < 4e-16
    assert np.max(np.abs(back - y)) < 4e-16 / sharp
    number, inside, _ = there(potential, 1e-3 * (Y + 3), jnp.asarray(1e-3, float))
    assert np.all(np.asarray(number) == 3)
    assert np.max(np.abs(inside - y)) < 4e-15 / sharp


@pytest.mark.parametrize("kind", FEW_BRISTLES)
def test_state_to_tip_and_back(kind):
    for potential in potentials(kind, "spline"):
        for eps in (1e-2, 1e-5, 1e-8):
            z = eps * jnp.linspace(-10, 10, 201)
            number, inside, ahead = there(potential, z, jnp.asarray(eps, float))
            np.testing.assert_allclose(eps * (number + inside) + ahead, z, atol=1e-14 * eps)


@pytest.mark.slow
def test_a_rod_nearly_upright_keeps_its_digits():
    # L - h = 1e-9 L: the rod reaches over 1e-9 L of height only, so eps is tiny.
    rod = fx.bristles.AngularSpring(1.0, 1.0, 1.0 - 1e-9, -0.3)
    potential = fx.potential(fx.profiles.Sine(1e-5), rod)
    assert float(rod.limit_angle) == pytest.approx(np.sqrt(2e-9), rel=1e-6)
    for eps in (1e-6, 1e-8, 1e-12):
        along, _ = by_tip(potential, eps * (GRID - 0.5), jnp.asarray(eps, float))
        found = potential.force(eps * (GRID - 0.5), eps)
        np.testing.assert_allclose(found, along, atol=1e-10 * np.max(np.abs(along)))
        limit, far = potential.Q(0.0, GRID), 5e3 * eps  # (eps w/1e-9) of its size
        size = np.max(np.abs(limit))
        np.testing.assert_allclose(potential.Q(eps, GRID), limit, atol=far * size)
        climb = rest_slope(potential, jnp.asarray(eps, float))
        limit = rest_slope(potential, jnp.zeros(()))
        np.testing.assert_allclose(climb, limit, atol=2 * far * np.max(np.abs(limit)))


def test_beyond_reach_is_nan_and_never_a_number():
    assert np.isnan(bracketed_root(lambda x: jnp.sqrt(x - 2), 0.0, 1.0))
    rod = fx.bristles.AngularSpring(1.0, 1.0, 0.999, 0.0)
    potential = fx.potential(fx.profiles.Sine(0.02), rod)
    assert not np.all(np.isfinite(potential.energy(2 * GRID, 2.0)))


def test_a_given_potential_is_what_was_given():
    def W(Y):
        return jnp.sin(2 * jnp.pi * Y) + 0.2 * jnp.cos(4 * jnp.pi * Y)

    def Q(eps, Y):
        return jnp.cos(2 * jnp.pi * Y) / (1 + eps)

    potential = fx.GivenPotential(W, Q)
    for eps in (1e-1, 1e-6):
        expected = eps * W(GRID) + eps**2 * Q(eps, GRID)
        np.testing.assert_allclose(
            potential.energy(eps * (GRID + 7), eps), expected, atol=1e-12 * eps
        )
        slope = central(lambda Y, e=eps: W(Y) + e * Q(e, Y), GRID, 1e-2)
        np.testing.assert_allclose(potential.force(eps * GRID, eps), slope, atol=1e-9)
    np.testing.assert_allclose(potential.W(GRID - 3), W(GRID), atol=1e-13)
    np.testing.assert_allclose(potential.Q(0.1, GRID), Q(0.1, GRID), atol=1e-15)
    np.testing.assert_allclose(fx.GivenPotential(W).Q(0.1, GRID), 0 * GRID)
    fine = np.linspace(0, 1, 1_000_001)
    slopes = 2 * np.pi * np.cos(2 * np.pi * fine) - 0.8 * np.pi * np.sin(4 * np.pi * fine)
    scene = fx.Scene(
        potential=potential,
        support=fx.supports.Spring(1.0),
        load=fx.loads.Ramp(1.0),
        duration=1.0,
    )
    found = fx.friction(scene)
    assert found.rho_plus == pytest.approx(slopes.max(), rel=1e-10)
    assert found.rho_minus == pytest.approx(slopes.min(), rel=1e-10)
    assert found.alpha is None


def test_shapes_broadcast():
    potential = fx.potential(fx.profiles.Sine(0.1), fx.bristles.Homothetic(1.0))
    few, eps = GRID[::8], jnp.asarray([[1e-2], [1e-3]])
    assert potential.energy(few, eps).shape == (2, 64)
    assert potential.force(0.1, 1e-2).shape == ()
    lanes = [potential.force(few, e) for e in (1e-2, 1e-3)]
    np.testing.assert_allclose(potential.force(few, eps), np.stack(lanes), rtol=1e-14)


def test_tips_of_many_states_and_eps_at_once():
    potential = fx.potential(*pair("fourier", "angular", 1, 5))
    z, eps = np.linspace(-0.3, 0.3, 7), np.array([[1e-3], [2e-2]])
    number, inside = potential.tip(z, eps)
    one_by_one = [[potential.tip(x, e) for x in z] for e in eps[:, 0]]
    np.testing.assert_array_equal(number, [[n for n, _ in row] for row in one_by_one])
    np.testing.assert_allclose(inside, [[y for _, y in row] for row in one_by_one])
    offset = jax.jit(jax.vmap(jax.vmap(potential.offset, (0, None))))(inside, eps[:, 0])
    state = eps * (number + inside) + offset
    np.testing.assert_allclose(state, np.broadcast_to(z, (2, 7)), atol=1e-16)


def energy_of_height(u):
    return -0.5 * (1.3 + u) ** 2 + 0.2 * u**3


def lopsided(Y):
    return 0.02 * jnp.sin(2 * jnp.pi * Y) + 0.003 * jnp.cos(4 * jnp.pi * Y + 0.4)


def of_second_order(eps, Y):
    return 0.1 * jnp.cos(2 * jnp.pi * Y) * (1 + eps)


@pytest.mark.parametrize("sign", [1, -1])
def test_a_potential_from_an_energy_by_lemma_2(sign):
    """`V_eps = F(eps WW + eps^2 QQ) - F(0)`, alpha of either sign, mu and rho."""

    def F(u):
        return sign * energy_of_height(u)

    given = fx.GivenPotential.from_energy(F, lopsided, of_second_order)
    alpha, Y = -1.3 * sign, np.linspace(0, 1, 33)[:-1]
    np.testing.assert_allclose(given.W(Y), alpha * at_places(lopsided, Y), rtol=1e-14)

    @jax.jit
    def direct(eps):
        u = eps * lopsided(Y) + eps**2 * of_second_order(eps, Y)
        return F(u) - F(0.0)

    for eps in (0.1, 1e-2):
        np.testing.assert_allclose(given.energy(eps * Y, eps), direct(eps), atol=1e-15)
    scene = fx.Scene(
        potential=given,
        support=fx.supports.Spring(1.0),
        load=fx.loads.Ramp(1.0),
        duration=1.0,
    )
    found = fx.friction(scene)
    slopes = at_places(jax.grad(lopsided), np.arange(1 << 14) / (1 << 14))
    assert float(found.alpha) == pytest.approx(alpha, rel=1e-15)
    assert float(found.mu_plus) == pytest.approx(np.max(slopes), rel=1e-6)
    assert float(found.mu_minus) == pytest.approx(np.min(slopes), rel=1e-6)
    ends = sorted([alpha * np.max(slopes), alpha * np.min(slopes)])
    told = [float(found.rho_minus), float(found.rho_plus)]
    np.testing.assert_allclose(told, ends, rtol=1e-6)
    assert "from_energy(F=F, WW=lopsided, QQ=of_second_order)" in repr(given)


@pytest.mark.slow  # programs of their own, as of all given functions
def test_it_moves_at_any_eps():
    given = fx.GivenPotential.from_energy(energy_of_height, lopsided, of_second_order)
    parts = {"support": fx.supports.Spring(1.0), "load": fx.loads.Ramp(1.0)}
    scene = fx.Scene(potential=given, duration=1.0, **parts)
    for eps in (1e-2, 1e-6):
        assert fx.solve(scene, eps, ts=[0.0, 0.5, 1.0]).ok


def test_a_bristle_is_such_a_potential():
    """A vertical spring: its F over its own surface."""
    bristle, profile = fx.bristles.VerticalSpring(1.0, 1.8, 1.0), fx.profiles.Sine(0.1)
    one = fx.potential(profile, bristle)
    other = fx.GivenPotential.from_energy(bristle.energy, profile)
    Y = jnp.linspace(-1.2, 1.7, PLACES)
    for eps in (0.1, 1e-3, 1e-8):
        np.testing.assert_allclose(other.W(Y), one.W(Y), atol=1e-16)
        np.testing.assert_allclose(other.Q(eps, Y), one.Q(eps, Y), rtol=1e-9, atol=1e-16)


@pytest.mark.parametrize(
    ("args", "named"),
    [
        ((lambda u: u**2, lopsided), "alpha = F'"),
        ((1.0, lopsided), "F = 1"),
        ((lambda u: u + jnp.abs(u), lopsided), "F' at 0 jumps by"),
        ((lambda u: jnp.log(u), lopsided), "a finite alpha"),
        ((lambda u: 2, lopsided), "alpha = F'"),
        ((energy_of_height, 2.0), "WW = 2"),
        ((energy_of_height, lopsided, lopsided), "QQ = "),
        ((energy_of_height, lambda Y: 0.0 * Y), "potential.W"),
    ],
)
def test_from_energy_names_what_is_wrong(args, named):
    with pytest.raises(ValueError, match=named):
        fx.GivenPotential.from_energy(*args)
