"""Mechanics of solutions: geometry, contact, and energy that is nowhere lost."""

import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx

EPS = 0.02
T = np.linspace(0, 3, 3001)
SURFACE = fx.profiles.Fourier([0.004, 0.0], [0.015, 0.003])
ROD = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3)
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
PULL = fx.loads.Pulled(fx.loads.Sine(1.0488, 3.0), 0.4)


def scene(bristle=ROD, load=PULL, support=None, z0=None):
    support = fx.supports.Spring(1.3) if support is None else support
    made = fx.Scene(SURFACE, bristle, support, load, 3.0)
    start = float(support.state_of(made.load(jnp.zeros(())))) if z0 is None else z0
    return made.replace(z0=start)


def unbalanced(data):
    """Largest |energy gained + lost - put in| in J; power by the trapezoid rule."""
    energy = (data.energy_support + data.energy_bristle + data.dissipation).values
    power = data.power.values
    steps = 0.5 * (power[1:] + power[:-1]) * np.diff(data.time)
    return np.max(np.abs(energy[1:] - energy[0] - np.cumsum(steps)))


# Rods have a loop of lanes of their own: 14 s to compile. What balances of theirs is held
# in their limit too, and at eps in `test_readings_with_turning.py`.
@pytest.fixture(
    scope="module", params=["slanted", pytest.param("rod", marks=pytest.mark.slow)]
)
def wiggly(request):
    one = scene({"rod": ROD, "slanted": SLANTED}[request.param])
    solution = fx.solve(one, EPS, ts=T, accuracy=1e-4)
    assert solution.ok
    return one, solution, fx.mechanics(one, solution, eps=EPS)


def test_energy_is_balanced_to_the_accuracy(wiggly):
    _, _, data = wiggly
    assert unbalanced(data) < 1e-4 * float(data.dissipation[-1])


def test_root_tip_and_bristle_are_one_triangle(wiggly):
    one, _, data = wiggly
    height = EPS * np.array([float(SURFACE(y)) for y in data.p.values[::100] / EPS])
    some = data.isel(time=slice(None, None, 100))
    sine, cosine = np.sin(some.theta), np.cos(some.theta)
    np.testing.assert_allclose(some.u - some.p, some.length * sine, rtol=1e-13)
    np.testing.assert_allclose(1.0 - height, some.length * cosine, rtol=1e-13)
    place = [float(one.load.position(t)) for t in some.time.values]
    np.testing.assert_allclose(some.q, place, atol=1e-14)
    spring = 1.3 * (some.q - 0.4 - some.u)
    np.testing.assert_allclose(some.support_force, spring, atol=1e-14)
    np.testing.assert_allclose(some.energy_support, spring**2 / 2.6, atol=1e-14)


def test_the_contact_is_frictionless_and_the_bristle_is_in_balance(wiggly):
    one, solution, data = wiggly
    tips = data.p.values[::50] / EPS
    slopes = [float(SURFACE(y + 1e-6)) - float(SURFACE(y - 1e-6)) for y in tips]
    some = data.isel(time=slice(None, None, 50))
    np.testing.assert_allclose(
        some.tangential_force, -some.normal_force * np.array(slopes) / 2e-6, atol=1e-9
    )
    force = one.potential.force(np.asarray(solution.z)[::50], EPS)
    np.testing.assert_allclose(some.tangential_force, -force, atol=1e-13)
    if one.bristle is ROD:
        check_torques(some)
    else:  # only the spring can push along itself
        np.testing.assert_allclose(some.axial_force, -(2.4 - some.length), rtol=1e-12)
    check_axial_forces(some)


def check_torques(some):
    """Of a rod about its root."""
    arms = some.tangential_force * np.cos(some.theta)
    arms = arms - some.normal_force * np.sin(some.theta)
    torque = -1.0 * (some.theta - 0.3)
    np.testing.assert_allclose(some.length * arms, torque, rtol=1e-12)


def check_axial_forces(some):
    np.testing.assert_allclose(
        some.axial_force,
        -some.normal_force * np.cos(some.theta)
        - some.tangential_force * np.sin(some.theta),
    )
    assert np.all(some.axial_force < 0)


def test_a_limit_solution_has_the_forces_of_its_slides():
    one = scene()
    data = fx.mechanics(one, fx.solve_limit(one, T))
    assert unbalanced(data) < 1e-5 * float(data.dissipation[-1])
    check_torques(data)
    check_axial_forces(data)
    law = fx.friction(one)
    steps = np.diff(data.z.values)
    before, after = np.append(0, steps), np.append(steps, 0)
    for rho, normal, way in (
        (law.rho_plus, law.normal_plus, np.minimum(before, after) > 0),
        (law.rho_minus, law.normal_minus, np.maximum(before, after) < 0),
    ):
        slide = data.isel(time=np.flatnonzero(way))
        assert slide.time.size > 100
        np.testing.assert_allclose(slide.tangential_force, -float(rho), rtol=1e-12)
        np.testing.assert_allclose(slide.tangential_low, -float(rho), rtol=1e-15)
        np.testing.assert_allclose(slide.tangential_high, -float(rho), rtol=1e-15)
        np.testing.assert_allclose(slide.normal_force, float(normal), rtol=1e-12)
        traction = -(ROD.limit_angle - 0.3) / np.tan(np.pi / 4) / 2**0.5
        traction += rho / np.sin(np.pi / 4)  # of Section 3.4
        np.testing.assert_allclose(slide.axial_force, float(traction), rtol=1e-12)
    rest = data.isel(time=np.flatnonzero((before == 0) & (after == 0)))
    assert rest.time.size > 50
    assert np.ptp(rest.tangential_force.values) > 1e-2
    np.testing.assert_allclose(rest.tangential_low, -float(law.rho_plus))
    np.testing.assert_allclose(rest.tangential_high, -float(law.rho_minus))


@pytest.mark.parametrize(
    "bristle", [SLANTED, pytest.param(ROD, marks=pytest.mark.slow)], ids=["slanted", "rod"]
)
def test_slides_of_small_eps_have_the_limit_forces(bristle):
    """The tip stays below the steepest place for nearly all of a slide."""
    one = scene(bristle, load=fx.loads.Ramp(1.0), z0=0.0)
    ts = np.linspace(1.0, 1.01, 41)
    small = fx.mechanics(one, fx.solve(one, 1e-4, 2.0, ts=ts), eps=1e-4)
    limit = fx.mechanics(one, fx.solve_limit(one, ts))
    for name in ("tangential_force", "normal_force", "axial_force"):
        middle = float(small[name].median())
        assert middle == pytest.approx(float(limit[name][0]), rel=3e-3)


def test_what_a_model_does_not_have_is_nan_and_says_why():
    convex = fx.supports.Convex(lambda z: 0.6 * z**2 + z**4)
    one = scene(fx.bristles.Homothetic(1.0), fx.loads.Sine(1.0, 3.0), convex, 0.0)
    data = fx.mechanics(one, fx.solve_limit(one, T))
    for name in ("theta", "length", "axial_force", "q"):
        assert np.all(np.isnan(data[name]))
        assert data[name].missing
    assert "u is z" in data.u.note
    np.testing.assert_array_equal(data.u, data.z)
    np.testing.assert_allclose(data.normal_force, 1.0)
    assert unbalanced(data) < 1e-5 * float(data.dissipation[-1])
    assert "Phi(z) - l z" in data.energy_support.note
    given = fx.GivenPotential(lambda Y: jnp.sin(2 * jnp.pi * Y) / 60)
    abstract = fx.Scene(
        potential=given,
        support=fx.supports.Spring(1.2),
        load=fx.loads.Sine(1.0, 3.0),
        duration=3.0,
    )
    found = fx.solve(abstract, 0.1, ts=T, accuracy=1e-4)
    data = fx.mechanics(abstract, found, eps=0.1)
    assert np.all(np.isnan(data.normal_force))
    assert "no bristle" in data.normal_force.missing
    assert unbalanced(data) < 1e-3 * float(data.dissipation[-1])


def test_what_does_not_fit_is_refused():
    one = scene(SLANTED)
    limit = fx.solve_limit(one, T)
    with pytest.raises(ValueError, match=r"eps = 0.1: needs None: a limit solution"):
        fx.mechanics(one, limit, eps=0.1)
    with pytest.raises(ValueError, match=r"solution = 'ArrayImpl': needs what solve"):
        fx.mechanics(one, limit.z)
    wiggly = fx.solve(one, EPS, ts=[0.0, 0.1])
    with pytest.raises(ValueError, match=r"eps = None: needs the eps in m"):
        fx.mechanics(one, wiggly)
    with pytest.raises(ValueError, match=r"eps = -1: needs"):
        fx.mechanics(one, wiggly, eps=-1.0)
    with pytest.raises(ValueError, match=f"eps = 0.5: needs {EPS}, as the solution is"):
        fx.mechanics(one, wiggly, eps=0.5)


@pytest.mark.parametrize(
    ("part", "other"),
    [
        ("profile", fx.profiles.Sine(0.05)),
        ("bristle", SLANTED.replace(angle=0.3)),
        ("bristle", fx.bristles.VerticalSpring(1.0, 2.0, 1.0)),
        ("support", fx.supports.Spring(3.0)),
        ("load", fx.loads.Ramp(1.0)),
    ],
)
def test_a_scene_with_another_part_is_refused(part, other):
    """A solution was read with any bristle, support and eps: forces of the other sign."""
    one = scene(SLANTED)
    limit, wiggly = fx.solve_limit(one, T), fx.solve(one, EPS, ts=[0.0, 0.1])
    needs = rf"scene\.{part} = .*: needs the one that the solution is of"
    with pytest.raises(ValueError, match=needs):
        fx.mechanics(one.replace(**{part: other}), wiggly, eps=EPS)
    with pytest.raises(ValueError, match=needs):
        fx.mechanics(one.replace(**{part: other}), limit)
    fx.mechanics(scene(SLANTED), wiggly, eps=EPS * (1 + 1e-15))  # the same, built anew


def test_the_same_parts_built_another_way_are_accepted():
    """A spline read back rounds otherwise; a load as a function is prepared for a time."""
    heights = 0.02 * np.sin(2 * np.pi * np.arange(11) / 11)
    bent = fx.loads.Custom(lambda t: 0.5 * jnp.sin(2 * t))
    surface = fx.profiles.Spline(heights)
    one = fx.Scene(surface, SLANTED, fx.supports.Spring(1.0), bent, 1.0)
    limit = fx.solve_limit(one, [0.0, 0.1])
    again = surface.replace(heights=(heights + 0.3) - 0.3, slope_error=[0.01, 0.02])
    assert not np.array_equal(again.coefficients, surface.coefficients)
    other = one.replace(profile=again, duration=2.0)
    assert fx.mechanics(other, limit).sizes == {"time": 2}
    near = surface.replace(heights=heights * (1 + 1e-9))
    with pytest.raises(ValueError, match=r"scene\.profile = "):
        fx.mechanics(one.replace(profile=near), limit)
