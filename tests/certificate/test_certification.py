"""The certificate accepts curves within eps/100 of a solution, and no skips or shifts."""

import re
from functools import cache
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest
from reference import System, sine
from reference import solve as plain_solve

import frictionjax as fx

COUNT = 16001  # of all curves but the long one: a scene's solver compiles once
RATE = 2.0


def vertical(load, duration, z0=0.0) -> fx.Scene:
    return fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        load,
        duration,
        z0,
    )


def back_and_forth(z0=0.0) -> fx.Scene:
    return vertical(fx.loads.Sine(1.0488, 3.0), 3.0, z0)


def ramp(sign, duration, start=0.0, z0=0.0) -> fx.Scene:
    return vertical(fx.loads.Ramp(sign * RATE, start), duration, z0)


def slanted_alpha_negative() -> fx.Scene:
    times = [0.0, 0.6, 1.0, 1.6, 1.9, 2.1, 3.0]
    values = [0.0, 0.7, 0.7, 0.3, 0.45, 0.2, -0.6]
    return fx.Scene(
        fx.profiles.Sine(0.15),
        fx.bristles.SlantedSpring(1.0, 0.6, 1.0, -0.5),
        fx.supports.Spring(1.0),
        fx.loads.PiecewiseLinear(times, values),
        3.0,
    )


def angular() -> fx.Scene:
    return fx.Scene(
        fx.profiles.Sine(0.15),
        fx.bristles.AngularSpring(1.0, 1.5, 1.0, 0.2),
        fx.supports.Spring(1.0),
        fx.loads.Triangle(0.9, 2.0),
        3.0,
    )


def given() -> fx.Scene:
    def two_bumps(Y):
        return 0.02 * jnp.sin(2 * jnp.pi * Y) + 0.004 * jnp.cos(4 * jnp.pi * Y)

    return fx.Scene(
        potential=fx.GivenPotential(
            two_bumps, lambda eps, Y: 0.01 * jnp.cos(2 * jnp.pi * Y)
        ),
        support=fx.supports.Convex(lambda z: 0.5 * z**2 + 0.1 * z**4),
        load=fx.loads.Sine(1.0, 2.0),
        duration=3.0,
    )


def solved(scene, eps, gamma, count=COUNT):
    ts = np.linspace(0.0, float(scene.duration), count)
    found = fx.solve(scene, eps, gamma, ts, accuracy=1e-6, dissipation=False)
    return ts, np.asarray(found.z)


CASES = {
    "slide": (back_and_forth, 0.02, 0.5),
    "stick and slip": (back_and_forth, 0.02, 1.0),
    "fast slips": (back_and_forth, 0.06, 2.0),
    "few wells": (back_and_forth, 0.3, 1.0),
    "alpha < 0": (slanted_alpha_negative, 0.03, 1.0),
    "angular": (angular, 0.03, 1.0),
    "given": (given, 0.05, 1.0),
}

_LESS = (
    "angular",
    "slide",
    "stick and slip",
    "down",
    "10",
    "fast slips",
    "10000",
    "alpha < 0",
    "given",
)  # their trajectories take longest


def named(cases):
    """Names for parametrize, those that take long marked."""
    slow = pytest.mark.slow
    return [pytest.param(name, marks=slow) if name in _LESS else name for name in cases]


@cache
def case(name):
    build, eps, gamma = CASES[name]
    scene = build()
    return scene, eps, gamma, *solved(scene, eps, gamma)


MONOTONE = {  # sign, duration, gamma, samples
    "10": (1, 0.1, 1.0, COUNT),
    "10000": (1, 50.2, 1.0, 640001),
    "down": (-1, 0.1, 1.0, COUNT),
    "slide": (1, 0.3, 0.5, COUNT),
}


@cache
def monotone(name):
    sign, duration, gamma, count = MONOTONE[name]
    scene = ramp(sign, duration)
    return scene, 0.01, gamma, *solved(scene, 0.01, gamma, count)


def deviations(ts):
    """Unit deviations: steady, slow, white, and as rough as can be."""
    random = np.random.default_rng(0)
    return {
        "none": np.zeros(ts.size),
        "steady": np.ones(ts.size),
        "slow": np.sin(7 * ts),
        "white": random.uniform(-1, 1, ts.size),
        "signs": random.choice([-1.0, 1.0], ts.size),
    }


def skipping(scene, eps, gamma, ts, z, sign, barrier_only=False):
    """The curve with one well skipped halfway, merged again with the rest of it.

    Once ahead it solves the system. `barrier_only`: from the rest before the fold to the
    slip behind it and no farther, which is all that a skip has to make up.
    """
    wells = np.floor(sign * z / eps - 0.5)
    slips = np.flatnonzero(np.diff(wells) > 0)
    middle = slips.size // 2
    start, end = ts[slips[middle]], ts[slips[middle + 1]]
    k = int(np.searchsorted(ts, start + 0.2 * (end - start)))
    resumed = ts[k] + 0.01 * (end - start)
    fold = sign * eps * np.ceil(sign * z[k] / eps)
    target = z[k] + sign * eps
    if barrier_only:
        target = fold + (fold - z[k])
    rest = min(ts[-1] - resumed, 5 * (end - start) / min(1.0, gamma**10))
    tail = ramp(sign, rest, sign * RATE * resumed, target)
    tail_ts, tail_z = solved(tail, eps, gamma)
    share = np.linspace(0, 1, 60)[1:-1]
    times = [ts[: k + 1], ts[k] + share * (resumed - ts[k]), resumed + tail_ts]
    states = [z[: k + 1], z[k] + share * (target - z[k]), tail_z]
    later = ts > times[-1][-1]
    times, states = np.concatenate([*times, ts[later]]), np.concatenate([*states, z[later]])
    inside = times <= ts[-1]
    return times[inside], states[inside]


@pytest.mark.parametrize("name", named(CASES))
def test_curves_within_a_hundredth_of_eps_are_accepted(name):
    scene, eps, gamma, ts, z = case(name)
    for kind, deviation in deviations(ts).items():
        found = fx.certify(scene, eps, gamma, ts, z + 0.01 * eps * deviation)
        assert found.ok is True, (kind, found)
        assert found.distance <= 0.012, kind  # 0.0100 to 0.0105: what was put in
        assert found.missing_force <= 0.0, kind


@pytest.mark.parametrize("name", named(CASES))
@pytest.mark.parametrize("shift", [0.1, -0.1])
def test_shifted_curves_are_rejected(name, shift):
    scene, eps, gamma, ts, z = case(name)
    found = fx.certify(scene, eps, gamma, ts, z + shift * eps)
    assert found.ok is False
    assert found.distance >= 0.05  # 0.07 where a few wells slide, else 0.108 or more
    noise = 0.01 * deviations(ts)["white"]
    assert not fx.certify(scene, eps, gamma, ts, z + eps * (shift + noise)).ok


@pytest.mark.parametrize("name", named(CASES))
@pytest.mark.parametrize("other", [-0.1, 0.1])
def test_another_gamma_is_rejected(name, other):
    scene, eps, gamma, ts, z = case(name)
    found = fx.certify(scene, eps, gamma + other, ts, z)
    assert found.status.name == "VISCOSITY"
    assert found.viscosity == pytest.approx(eps**-other, rel=0.02)


@pytest.mark.parametrize("name", named(MONOTONE))
def test_any_number_of_slips(name):
    scene, eps, gamma, ts, z = monotone(name)
    sign = -1 if name == "down" else 1
    true = fx.certify(scene, eps, gamma, ts, z)
    assert true.ok, true
    expected = {"10": 10, "10000": 10000, "down": 10, "slide": 40}[name]
    assert abs(true.slips - expected) <= 0.1 * expected
    noise = 0.01 * eps * deviations(ts)["white"]
    assert fx.certify(scene, eps, gamma, ts, z + noise).ok
    assert not fx.certify(scene, eps, gamma, ts, z + 0.1 * eps).ok
    assert not fx.certify(scene, eps, gamma + 0.1, ts, z).ok
    for barrier_only in (False, True):
        times, states = skipping(scene, eps, gamma, ts, z, sign, barrier_only)
        ahead = sign * (states - np.interp(times, ts, z)) / eps
        assert np.max(ahead) > 0.5  # it did skip, 0.54 in the slide
        assert np.max(np.abs(np.diff(states))) <= 0.25 * eps
        assert not fx.certify(scene, eps, gamma, times, states).ok


@pytest.mark.slow
def test_a_skip_is_seen_by_the_force_it_lacked():
    """eps small: a jump within the noise makes the skip. The force tells, and the solution
    from the rest before it."""
    scene = ramp(1, 0.09)
    ts, z = solved(scene, 0.002, 1.0, 64001)
    times, states = skipping(scene, 0.002, 1.0, ts, z, 1, barrier_only=True)
    found = fx.certify(scene, 0.002, 1.0, times, states)
    assert found.status.name == "SKIPPED"
    assert found.skipped == 1
    assert found.missing_force > 0.1
    assert found.distance > 0.5


def test_residual_and_scale():
    scene, eps, gamma, ts, z = case("stick and slip")
    found = fx.certify(scene, eps, gamma, ts, z)
    law = fx.friction(scene)
    assert found.scale == pytest.approx(eps * float(law.rho_plus - law.rho_minus))
    assert 0 <= found.residual <= 1e-3 * found.scale
    assert found.residual <= 2 * found.residual_error
    # A steady shift s in a potential of curvature V'' costs int (V'' s)^2/(2 eps^gamma).
    s = 1e-2 * eps
    shifted = fx.certify(scene, eps, gamma, ts, z + s)
    curvature = 1 - 0.2 * np.pi / eps * np.sin(2 * np.pi * z / eps)
    cost = np.trapezoid((curvature * s) ** 2, ts) / (2 * eps**gamma)
    # In slips the interpolant that is bent by the wrong velocities costs a fifth more.
    assert 0.98 * cost <= shifted.residual <= 1.2 * cost


@pytest.mark.slow
def test_another_start_is_a_solution_too():
    ts, z = solved(back_and_forth(z0=0.35), 0.02, 1.0)
    assert fx.certify(back_and_forth(), 0.02, 1.0, ts, z).ok


def test_a_jump_of_the_curve_is_found():
    scene, eps, gamma, ts, z = case("stick and slip")
    jump = z + 0.2 * eps * (ts > 0.9)
    found = fx.certify(scene, eps, gamma, ts, jump)
    assert not found.ok
    assert found.distance > 0.09


def test_coarse_samples_are_not_accepted():
    scene, eps, gamma, ts, z = case("stick and slip")
    found = fx.certify(scene, eps, gamma, ts[::16], z[::16])
    assert found.status.name == "UNRESOLVED"
    apart = np.abs(np.diff(z[::16])).max() / eps
    told = f"samples are {apart:.6g} eps apart, more than eps/4: undecided"
    assert found.message == told


def test_values_that_are_not_finite_are_not_accepted():
    scene, eps, gamma, ts, z = case("few wells")
    z = np.where(ts > 2.0, np.nan, z)
    found = fx.certify(scene, eps, gamma, ts, z)
    assert found.status.name == "NOT_FINITE"
    assert found.ok is False


def test_a_curve_at_rest_has_no_viscosity_to_measure():
    scene = vertical(fx.loads.Sine(0.05, 3.0), 3.0)
    system = System(
        w=sine(0.1),
        bristle=lambda eta: (0.0, 0.0, 1.0 + eta),
        force=lambda z: z,
        load=lambda t: 0.05 * np.sin(2 * np.pi * t / 3),
        duration=3.0,
        rate=0.11,
    )
    ts = np.linspace(0.0, 3.0, COUNT)
    z = plain_solve(system, 0.1, 1.0, 0.0, ts).z
    found = fx.certify(scene, 0.1, 1.0, ts, z)
    assert found.ok
    assert found.slips == 0
    assert np.isnan(found.viscosity)
    assert not fx.certify(scene, 0.1, 1.0, ts, z + 0.01).ok


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("eps", {"eps": -1.0}),
        ("eps", {"eps": [0.1, 0.2]}),
        ("gamma", {"gamma": 0.0}),
        ("gamma", {"gamma": np.nan}),
        ("ts", {"ts": [0.0, 0.0, 0.1]}),
        ("ts", {"ts": [0.0, 1.0, 3.5]}),
        ("ts", {"ts": [0.0], "z": [0.0]}),
        ("ts", {"ts": None}),
        ("z", {"z": [0.0, 0.0]}),
        ("z", {"z": "states"}),
    ],
)
def test_bad_arguments_are_named(name, change):
    good = {"eps": 0.1, "gamma": 1.0, "ts": [0.0, 0.1, 0.2], "z": [0.0, 0.0, 0.0]}
    with pytest.raises(ValueError, match=rf"^{name} = .*: needs"):
        fx.certify(back_and_forth(), **(good | change))


def test_the_certificate_knows_no_solver():
    package = Path(fx.__file__).parent / "certificate"
    imports = {
        path.name: set(re.findall(r"^\s*from \.\.(\w+)", path.read_text(), re.M))
        for path in package.glob("*.py")
    }
    assert {"model", "effects"} <= imports["certification.py"]
    assert not {"wiggly", "limit", "sweeps"} & set().union(*imports.values())


@pytest.mark.slow
@pytest.mark.parametrize("late", [0.25, -0.25, 0.5])
def test_slips_under_another_load_are_late(late):
    """Of a curve that solves the system under a load that lags behind."""
    end, eps = 0.6, 0.01
    scene = vertical(fx.loads.Sine(0.6, 3.0), end).replace(
        bristle=fx.bristles.Homothetic(1.0)
    )
    period = eps / (0.4 * np.pi * np.cos(0.2 * np.pi))  # of slips at half time
    times = np.linspace(0.0, end, 3001)
    behind = late * period * np.exp(-(((times - 0.5 * end) / (0.25 * end)) ** 2))
    load = 0.6 * np.sin(2 * np.pi / 3 * (times - behind))
    other = scene.replace(load=fx.loads.PiecewiseLinear(times, load))
    ts = np.linspace(0.0, end, 30001)
    right, wrong = (fx.solve(s, eps, ts=ts, accuracy=1e-5).z for s in (scene, other))
    assert np.max(np.abs(np.asarray(right - wrong))) > 0.9 * eps
    assert fx.certify(scene, eps, 1.0, ts, right).ok
    found = fx.certify(scene, eps, 1.0, ts, wrong)
    assert found.status.name == "OFF"
    assert found.distance > 0.3


@pytest.mark.slow
@pytest.mark.parametrize("name", ["stick and slip", "fast slips", "alpha < 0", "angular"])
def test_how_far_a_curve_is_at_most(name):
    """No closer than it is, and not much farther, where tips forget where they were."""
    scene, eps, gamma, ts, z = case(name)
    wave = np.sin(9 * ts) * np.minimum(1.0, 20 * ts)
    found = fx.certify(scene, eps, gamma, ts, z + 0.01 * eps * wave)
    assert 0.005 < found.distance < 0.011
    assert 0.01 < found.within < 0.06
    shifted = fx.certify(scene, eps, gamma, ts, z + 0.1 * eps * np.minimum(1.0, 20 * ts))
    assert shifted.within > 0.1
