"""Dissipation where the tip makes few slips or none: what is lost within wells counts."""

import numpy as np
import pytest
import reference as ref
from by_hand import piecewise
from scipy.integrate import solve_ivp

import frictionjax as fx
from frictionjax.wiggly.equation.step_plan import _of_few_wells

COS = [0.0011771, 0.00055223, 0.00142035, -0.00019281]
SIN = [-0.00371726, 0.00301786, -0.00376791, 0.00022254]
ANGLE, REST, STIFFNESS = 0.4848725549381183, 0.4, 2.0653495442912266  # alpha < 0
KNOTS = [  # as many of each: they share their programs
    ([0.0, 0.7557, 1.05795, 2.0, 3.0], [0.0, -0.053, 0.026, 0.026, 0.026]),
    ([0.0, 0.7557, 1.05795, 1.0997, 3.0], [0.0, -0.0531, 0.0259, -0.037, -0.037]),
    ([0.0, 0.5, 1.0, 2.0, 3.0], [0.0, 0.04, 0.08, 0.025, -0.03]),
]
METHODS = pytest.mark.parametrize(
    "method", ["auto", pytest.param("Kvaerno5", marks=pytest.mark.slow)]
)
EPS, GAMMA, TIMES = 0.36, 0.5, np.linspace(0.0, 3.0, 41)


def scene_under(times, values):
    bristle = fx.bristles.SlantedSpring(1.0, REST, 1.0, ANGLE)
    load = fx.loads.PiecewiseLinear(times, values)
    return fx.Scene(
        fx.profiles.Fourier(COS, SIN), bristle, fx.supports.Spring(STIFFNESS), load, 3.0
    )


def system_under(times, values) -> ref.System:
    """The same by hand."""
    tangent, cosine = np.tan(ANGLE), np.cos(ANGLE)

    def bristle(eta):
        return -eta * tangent, -tangent, (REST - (1.0 - eta) / cosine) / cosine

    return ref.System(
        w=ref.series(COS, SIN),
        bristle=bristle,
        force=lambda z: STIFFNESS * z,
        load=piecewise(np.array(times), np.array(values)),
        duration=3.0,
        kinks=tuple(times[1:-1]),
        stiffness=STIFFNESS,
    )


@pytest.mark.parametrize("knots", KNOTS)
@METHODS
def test_what_is_dissipated_behind_kinks_within_a_well(method, knots):
    """Steps on which the tip turned were taken for spikes: 0.4% lost at any accuracy."""
    expected = ref.solve(system_under(*knots), EPS, GAMMA, 0.0, TIMES)
    scene = scene_under(*knots)
    for accuracy in (1e-3, 1e-5) if method == "auto" else (1e-5,):
        found = fx.solve(scene, EPS, GAMMA, TIMES, accuracy, method)
        assert found.ok
        off = np.abs(np.asarray(found.dissipation) - expected.dissipation).max()
        assert off < 0.2 * accuracy * expected.dissipation[-1], accuracy
        assert np.abs(np.asarray(found.z) - expected.z).max() < accuracy * EPS


@pytest.mark.slow  # 2,032 times at three accuracies
def test_suprema_of_dissipation_between_the_ends_of_steps():
    """At the top slips end while the limit goes on: up to 74 times the accuracy off."""
    times = [0, 1.42761373, 2.41087293, 2.44947433, 2.46242806, 2.47389526, 2.48540751]
    values = [0, 0, 0.27300218, 0.27344973, 0.27466338, 0.08919904, 0.13637545]
    load = fx.loads.PiecewiseLinear(
        [*times, 2.96650332, 3], [*values, 0.11244175, 0.08063661]
    )
    cos = [2.85095159e-4, 1.91120849e-4, 4.66547792e-4, -3.15967127e-5]
    profile = fx.profiles.Fourier(cos, [4.1142e-4, -1.0125e-4, 1.3791e-4, 1.30516e-3])
    bristle = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.47458842)
    support = fx.supports.Spring(2.505164927267363)
    scene = fx.Scene(profile, bristle, support, load, 3.0, -0.02408632747804305)
    eps, gamma = 0.09755481952163556, 1.6
    ts = np.union1d(np.linspace(0, 3, 31), np.linspace(2.4494, 2.4854, 2001))
    limit = np.asarray(fx.solve_limit(scene, ts).dissipation)
    spent = np.asarray(fx.solve(scene, eps, gamma, ts, 1e-6).dissipation)
    highest = np.abs(spent - limit).max()
    for accuracy in (1e-3, 1e-4, 1e-5):
        found = fx.sweep(scene, eps, gamma, np.linspace(0, 3, 31), accuracy)
        assert int(found.status.item()) == fx.Status.OK
        off = abs(float(found.dissipation_error.item()) - highest)
        assert off < 0.5 * accuracy * spent[-1]


@METHODS
def test_what_is_dissipated_on_a_support_stiffer_than_wells(method):
    """From energies 2e-3 off at accuracy 1e-3, and 1e-3 at 1e-6.

    Without folds z follows the load, and what `z0` is away from rest is dissipated at once.
    """
    stiffness, slope, eps, gamma = 1e3, 0.1, 0.1, 2.4
    load = fx.loads.Sine(1.0488 * stiffness, 3.0)
    bristle = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    support = fx.supports.Spring(stiffness)
    scene = fx.Scene(fx.profiles.Sine(slope), bristle, support, load, 3.0)
    found = fx.solve(scene, eps, gamma, [0.0, 1.5, 3.0], method=method)
    t, turn = np.linspace(0.0, 3.0, 400_001), 2 * np.pi / 3
    pull, rate = 1.0488 * stiffness * np.array([np.sin(turn * t), np.cos(turn * t)])
    phase = 2 * np.pi * pull / stiffness / eps  # of the tip, to 1e-3 wells
    wells = -slope * 2 * np.pi / eps * np.sin(phase)
    way = eps**gamma * np.trapezoid((turn * rate / (stiffness + wells)) ** 2, t)
    at_once = 0.5 * slope**2 / stiffness
    assert found.ok
    assert float(found.dissipation[-1]) == pytest.approx(way + at_once, rel=2e-4)


@pytest.mark.parametrize("creep", [1e-6, 1e-3, 1e-2, 3e-2])
@pytest.mark.parametrize(
    "through",
    ["lanes", pytest.param("diffrax", marks=pytest.mark.slow)],  # its program: 9 s
)
def test_a_start_that_falls_into_its_well(creep, through):
    """Next to no load, no slip: direct sums were up to 90 times the accuracy off.

    `creep`: by how much of the strip the load moves.
    """
    eps, slope = 1e-2, 0.1
    brief = eps**2 / (2 * np.pi * slope)  # relaxation of the well, s
    z0, end = -0.23 * eps, 600 * brief
    rate = creep * 2 * slope / end

    def rates(s, state):
        z = z0 + eps * state[0]
        force = rate * brief * s - z - slope * np.cos(2 * np.pi * z / eps)
        return [force * brief / eps**2, force**2 * brief / (eps**2 * slope)]

    options = {"rtol": 1e-12, "atol": 1e-16, "max_step": 0.5}
    plain = solve_ivp(rates, (0, 600), [0.0, 0.0], "DOP853", **options)
    expected = plain.y[1, -1] * eps * slope
    parts = fx.profiles.Sine(slope), fx.bristles.Homothetic(1.0), fx.supports.Spring(1.0)
    scene = fx.Scene(*parts, fx.loads.Ramp(rate), end, z0)
    method = {"lanes": "auto", "diffrax": "Kvaerno3"}[through]
    for accuracy in (1e-3, 1e-6):
        found = fx.solve(scene, eps, 1.0, np.array([0.0, end]), accuracy, method)
        assert found.ok
        assert abs(float(found.dissipation[-1]) / expected - 1) < 0.1 * accuracy


@pytest.mark.parametrize(("stiffness", "eps"), [(1e3, 0.2), (1e4, 0.2), (1e3, 0.05)])
@METHODS
def test_a_start_that_falls_by_less_than_the_tolerance(method, stiffness, eps):
    """All of it in one step: 42 to 92% of the dissipation was lost, with no sign of it.

    And of its distance from a limit at rest, measured by cubics, up to 2% too much.
    """
    force, slope = 0.06, 0.1
    times, values = [0.0, 1.0, 2.0], np.array([0.0, 0.0, 1e-3]) + slope - force
    parts = fx.profiles.Sine(slope), fx.bristles.Homothetic(1.0)
    load = fx.loads.PiecewiseLinear(times, values)
    scene = fx.Scene(*parts, fx.supports.Spring(stiffness), load, 2.0)
    right = 0.5 * force**2 / stiffness  # V_eps'' is 0 there
    cell = fx.sweep(scene, eps, 1.0, [0.0, 2.0], 1e-3, method).isel(eps=0, gamma=0)
    spent = float(cell.dissipation[-1])
    assert int(cell.status) == fx.Status.OK
    assert spent == pytest.approx(right, rel=2e-4)
    assert float(cell.dissipation_error) == pytest.approx(spent, rel=1e-6)


@pytest.mark.parametrize(("stiffness", "gamma"), [(1e3, 1.0), (200.0, 2.0)])
def test_what_is_dissipated_on_the_way_through_a_part_of_a_well(stiffness, gamma):
    """5e-4 and 2e-3 slips: up to 100 times the accuracy off, with tolerances for slides."""
    parts = fx.bristles.VerticalSpring(10.0, 1.05, 1.0), fx.supports.Spring(stiffness)
    scene = fx.Scene(fx.profiles.Sine(0.1), *parts, fx.loads.Ramp(2.5), 2.0)
    *some, fine = (
        fx.sweep(scene, 0.03, gamma, [0.0, 2.0], accuracy).isel(eps=0, gamma=0)
        for accuracy in (1e-3, 1e-5, 1e-9)
    )
    right = float(fine.dissipation[-1])
    assert float(fine.dissipation_gap) < 1e-6 * right
    for accuracy, cell in zip((1e-3, 1e-5), some, strict=True):
        assert abs(float(cell.dissipation[-1]) - right) < 0.5 * accuracy * right


@pytest.mark.parametrize(
    ("way", "start", "accuracy", "share"),
    [
        (0.0, 0.0, 1e-3, 1e-4),
        (25.0, 0.0, 1e-3, 0.125),
        (1e3, 0.0, 1e-3, 1.0),
        # Near the rounding of z lanes would take no more than tiny steps.
        (8.0, 1e6, 1e-6, 0.08),
        (0.0, 1e6, 1e-6, 1e-2),
    ],
)
def test_tolerances_are_tighter_for_few_wells(way, start, accuracy, share):
    assert float(_of_few_wells(way, start, accuracy)) == pytest.approx(share)
