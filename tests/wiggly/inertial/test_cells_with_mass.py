"""Tips with mass: against SciPy, and against what is known of them."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tips_with_mass import RHO, by_scipy, mass_for, massive_scene

import frictionjax as fx
from frictionjax.wiggly import FailedCells

TS = np.linspace(0, 3, 61)


def overdamped(eps, gamma=1.0, ts=TS):
    plain = massive_scene(1.0).replace(effects=())
    return fx.solve(plain, eps, gamma, ts=ts, accuracy=1e-6, method="resolved")


@pytest.mark.parametrize(("beta", "gamma"), [(0.3, 1.0), (3.0, 0.75), (30.0, 1.0)])
def test_an_explicit_method_of_order_eight_agrees(beta, gamma):
    eps, ts = 0.04, np.linspace(0, 1.5, 31)
    mass = mass_for(beta, eps, gamma)
    z, velocity, dissipation = by_scipy(mass, eps, gamma, ts)
    found = fx.solve(massive_scene(mass), eps, gamma, ts=ts)
    assert found.ok
    assert found.stats["beta"] == pytest.approx(beta, rel=1e-5)
    np.testing.assert_allclose(found.z, z, atol=1e-3 * eps)
    pace = np.max(np.abs(velocity))
    np.testing.assert_allclose(found.velocity, velocity, atol=1e-3 * pace)
    last = dissipation[-1]
    np.testing.assert_allclose(found.dissipation, dissipation, atol=1e-3 * last)
    assert np.max(found.residual) < 1e-6 * last
    tight = fx.solve(massive_scene(mass), eps, gamma, ts=ts, accuracy=1e-7)
    np.testing.assert_allclose(tight.z, z, atol=1e-6 * eps)


def test_a_stiff_method_agrees_where_mass_is_small():
    eps, ts = 0.1, np.linspace(0, 0.6, 13)
    mass = mass_for(1e-4, eps, 1.0)
    z, _, dissipation = by_scipy(mass, eps, 1.0, ts, "Radau", 1e-9)
    found = fx.solve(massive_scene(mass), eps, 1.0, ts=ts)
    np.testing.assert_allclose(found.z, z, atol=1e-4 * eps)
    np.testing.assert_allclose(found.dissipation[-1], dissipation[-1], rtol=1e-4)


@pytest.mark.slow
def test_without_mass_the_limit_is_the_overdamped_tip_with_order_one():
    eps = 0.02
    plain = overdamped(eps)
    off = []
    for beta in (1e-2, 1e-3, 1e-4):
        scene = massive_scene(mass_for(beta, eps, 1.0))
        found = fx.solve(scene, eps, 1.0, ts=TS, accuracy=1e-6)
        off.append(np.median(np.abs(np.asarray(found.z - plain.z))[5:]))
    orders = np.diff(np.log10(off)) / -1
    assert np.all(np.abs(orders - 1) < 0.1), (off, orders)
    light = massive_scene(mass_for(1e-10, eps, 1.0))
    assert fx.solve(light, eps, 1.0, ts=TS).stats["steps"] < 1e5
    np.testing.assert_allclose(fx.solve(light, eps, 1.0, ts=TS).z, plain.z, atol=1e-4 * eps)


def leading_scene(mass, stiffness, load, duration, z0=0.0):
    """`V_eps = eps W`, `W' = RHO sin(2 pi Y)`, at rest in the origin."""

    def W(Y):
        return -RHO / (2 * jnp.pi) * jnp.cos(2 * jnp.pi * Y)

    return fx.Scene(
        potential=fx.GivenPotential(W=W),
        support=fx.supports.Spring(stiffness),
        load=load,
        duration=duration,
        z0=z0,
        effects=(fx.effects.Inertia(mass),),
    )


def test_frequency_of_small_oscillations_at_rest():
    eps, gamma, mass, stiffness = 0.1, 4.0, 2.0, 1.5
    omega = np.sqrt((stiffness + 2 * np.pi * RHO / eps) / mass)
    start, ts = 1e-4 * eps, np.linspace(0, 40 * 2 * np.pi / omega, 401)
    load = fx.loads.Ramp(0.0, 0.0)
    scene = leading_scene(mass, stiffness, load, float(ts[-1]), z0=start)
    found = fx.solve(scene, eps, gamma, ts=ts, accuracy=1e-8)
    rate = 0.5 * eps**gamma / mass
    damped = np.sqrt(omega**2 - rate**2)
    circle = (
        np.asarray(found.z) - 1j * (np.asarray(found.velocity) + rate * found.z) / damped
    )
    turned = np.unwrap(np.angle(circle))
    seen = np.polyfit(ts, turned, 1)[0]
    assert np.sqrt(seen**2 + rate**2) == pytest.approx(omega, rel=1e-6)
    np.testing.assert_allclose(np.abs(circle), start * np.exp(-rate * ts), rtol=1e-4)


@pytest.mark.parametrize(
    ("eta", "wells"), [(4.603338848752, 1), (7.789705767493, 2), (10.949879869826, 3)]
)
def test_where_one_more_well_can_hold_a_slipped_tip(eta, wells):
    """Its lower fold is there as high as the fold that the tip has left."""
    eps, turn = 2 * np.pi * RHO / eta, np.arccos(1 / eta) / (2 * np.pi)
    scene = leading_scene(1.0, 1.0, fx.loads.Ramp(1.0, 0.0), 1.0)

    def pull(z):
        return z + scene.potential.force(z, eps)

    left, into = eps * (0.5 - turn), eps * (wells + 0.5 + turn)
    for fold in (left, into):
        assert float(jax.grad(pull)(fold)) == pytest.approx(0, abs=1e-9)
    assert float(pull(into)) == pytest.approx(float(pull(left)), rel=1e-11)


def wells_of_slips(eta, beta, gamma=1.0):
    """How many wells each slip of a slow pull goes through, eta = 2 pi rho/(k eps)."""
    stiffness = 1.0
    eps = 2 * np.pi * RHO / (stiffness * eta)
    mass = mass_for(beta, eps, gamma)
    rate = stiffness * eps / (60 * max(mass / eps**gamma, eps ** (1 + gamma) / RHO))
    duration = 8 * stiffness * eps / rate
    ts = np.linspace(0, duration, 801)
    scene = leading_scene(mass, stiffness, fx.loads.Ramp(rate, 0.0), duration)
    z = np.asarray(fx.solve(scene, eps, gamma, ts=ts).z)
    rests = np.round(z / eps)[np.abs(np.gradient(z, ts)) < 3 * rate / stiffness]
    jumps = np.diff(rests)
    return jumps[jumps != 0]


@pytest.mark.parametrize(
    ("eta", "most"),
    [
        pytest.param(4.5, 1, marks=pytest.mark.slow),
        pytest.param(7.7, 2, marks=pytest.mark.slow),
    ],
)
def test_a_slip_reaches_as_many_wells_as_can_hold_the_tip(eta, most):
    """Beyond eta = 4.6033 a second well ahead can, beyond 7.7897 a third."""
    slips = [wells_of_slips(eta, beta) for beta in (0.1, 3.0, 10.0, 30.0)]
    assert all(np.all(found <= most) for found in slips), slips
    assert max(found.max() for found in slips) == most
    assert np.all(slips[0] == 1)


def force_of_retrapping(beta):
    """A slip on a soft spring: the pull falls as the tip runs, until it is caught."""
    eps, gamma = 0.01, 1.0
    stiffness = 2 * np.pi * RHO / (100 * beta * eps)
    mass = mass_for(beta, eps, gamma)
    pull = 1.05 * RHO
    far = pull / stiffness
    duration = 12 * eps**gamma / stiffness + 40 * mass / eps**gamma
    scene = leading_scene(mass, stiffness, fx.loads.Ramp(0.0, pull), duration)
    found = fx.solve(scene, eps, gamma, ts=[duration], accuracy=1e-4)
    assert abs(float(found.velocity[0])) < 1e-3 * far / duration
    return pull - stiffness * float(found.z[0])


@pytest.mark.slow
def test_force_of_retrapping_at_weak_damping():
    """`(4/pi) rho/sqrt(beta)` for large beta; 1.2534, 1.2636, 1.2645 at 25, 100, 400.

    What is left is the pull that falls while a tip is caught, by 1% of its own.
    """
    off = [
        4 / np.pi - force_of_retrapping(beta) * np.sqrt(beta) / RHO for beta in (25, 100)
    ]
    assert 0 < off[1] < 0.01 * 4 / np.pi
    assert off[1] < off[0] < 0.02 * 4 / np.pi


def test_a_cell_has_the_same_bits_in_any_company():
    """Of the same largest eps, up to which tables of the scene are made."""
    eps, gamma = np.geomspace(5e-2, 2e-2, 5), np.array([0.75, 1.0])
    scene = massive_scene(1.0, 3.0)
    whole = fx.sweep(scene, eps, gamma, TS)
    few = fx.sweep(scene, eps[[0, 3]], [1.0], TS)
    for name in ("z", "velocity", "dissipation", "sup_error", "spread"):
        one, other = (d[name].sel(gamma=1.0, eps=eps[3]) for d in (whole, few))
        np.testing.assert_array_equal(one, other, name)
    solved = fx.solve(scene, eps[3], 1.0, ts=TS)
    np.testing.assert_allclose(whole.z.sel(gamma=1.0, eps=eps[3]), solved.z, atol=1e-8)


def test_what_no_step_size_decides_is_told():
    """Which well a slip ends in, where it comes to rest on a ridge between two."""
    scene = massive_scene(mass_for(5.0, 1.0, 0.0), 3.0)
    eps = np.geomspace(0.03, 0.01, 12)[:7]
    with pytest.warns(FailedCells, match="SENSITIVE"):
        data = fx.sweep(scene, eps, [1.0], TS)
    told = data.status.values[0] == int(fx.Status.SENSITIVE)
    assert 2 <= np.sum(told) <= 5
    assert np.all(data.spread.max("time").values[0][told] > 0.5 * eps[told])
    assert np.all(np.isfinite(data.z.values))
    with pytest.warns(FailedCells):
        tight = fx.sweep(scene, eps, [1.0], TS, accuracy=1e-5)
    good = ~told & (tight.status.values[0] == 0)
    off = np.abs(data.z - tight.z).max("time").values[0] / eps
    assert np.all(off[good] < 0.05)
    assert np.sum(good) >= 2


def test_steps_that_run_out_are_told():
    found = fx.solve(massive_scene(1e-4), 0.02, ts=TS, max_steps=50)
    assert found.status == fx.Status.MAX_STEPS
    assert np.all(np.isnan(found.z[1:]))
    assert float(found.z[0]) == 0.0


def test_traced_numbers_are_refused():
    import jax

    with pytest.raises(ValueError, match=r"effects\.Inertia has no derivatives"):
        jax.grad(lambda e: fx.solve(massive_scene(1e-4), e).z[-1])(0.05)


def test_another_number_of_times_compiles_nothing():
    """Stops go in groups of one size: five times, and seven groups of them."""
    eps, compiled = 0.05, []

    def note(event, seconds, **_):
        compiled.extend([event] if event.endswith("backend_compile_duration") else [])

    scene = massive_scene(mass_for(1.0, eps, 1.0), 1.5)
    few = fx.solve(scene, eps, 1.0, ts=np.linspace(0, 1.5, 5))
    jax.monitoring.register_event_duration_secs_listener(note)
    many = fx.solve(scene, eps, 1.0, ts=np.linspace(0, 1.5, 401))
    assert compiled == []
    np.testing.assert_allclose(many.z[::100], few.z, atol=2e-3 * eps)
    np.testing.assert_allclose(many.dissipation[::100], few.dissipation, rtol=2e-3)
