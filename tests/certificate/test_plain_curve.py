"""What a curve's own rests tell that forces over windows do not: of some fast slips."""

from functools import cache

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.certificate.plain_curve import CurveMeasures, verdict
from frictionjax.certificate.verdicts import CertificateStatus

EPS, GAMMA, RATE, END = 0.02, 2.0, 2.0, 0.1
SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
    fx.supports.Spring(1.0),
    fx.loads.Ramp(RATE),
    END,
)
PERIOD = EPS / RATE  # of slips
TS = np.linspace(0.0, END, 16001)


@cache
def solved():
    found = fx.solve(SCENE, EPS, GAMMA, TS, accuracy=1e-6, dissipation=False)
    return np.asarray(found.z)


def certified(z, ts=TS):
    return fx.certify(SCENE, EPS, GAMMA, ts, z)


def late_by(share):
    """Slips late by a share of their period, little by little."""
    behind = share * PERIOD * np.exp(-(((TS - 0.5 * END) / (0.2 * END)) ** 2))
    return np.interp(TS - behind, TS, solved())


def test_the_solution_is_known_to_be_near():
    found = certified(solved())
    assert found.ok, found
    assert found.distance < 1e-3
    assert 0.01 < found.within < 0.05  # two solutions set off 0.03 aside
    assert set(found.shares) == {"spacing", "distance"}  # nothing else is asked


@pytest.mark.parametrize(("share", "status"), [(0.1, "OFF"), (-0.1, "SKIPPED")])
def test_slips_that_come_late_or_early_are_seen(share, status):
    found = certified(late_by(share))
    assert found.status.name == status, found
    assert 0.1 < found.distance < 1.0


@pytest.mark.parametrize("share", [0.005, -0.005])
def test_in_time_a_hundredth_of_a_period_is_allowed(share):
    """In which a slip goes on by much of a well."""
    z = late_by(share)
    assert np.max(np.abs(z - solved())) > 0.1 * EPS
    found = certified(z)
    assert found.ok, found
    assert found.distance < 0.01


def test_noise_is_as_far_as_it_is():
    noise = np.random.default_rng(5).uniform(-0.01, 0.01, TS.size) * EPS
    found = certified(solved() + noise)
    assert found.ok, found
    assert 0.009 < found.distance < 0.0135
    assert found.within < 0.06


@pytest.mark.parametrize("shift", [0.05, 0.1, -0.1])
def test_a_shifted_curve_is_as_far_as_it_was_shifted(shift):
    """Not 1.02 eps at 0.1, as windows said without the second order of all of a shift."""
    found = certified(solved() + shift * EPS)
    assert not found.ok
    assert 0.99 * abs(shift) < found.distance < 1.01 * abs(shift)


def test_after_a_jump_no_solution_is_near():
    """A well on, and a solution again: of another start."""
    found = certified(solved() + EPS * (TS > 0.5 * END))
    assert not found.ok
    assert found.within == np.inf


def test_few_samples_of_a_slip_are_enough():
    """Where a solution is known to be near, the viscosity they show does not matter."""
    z, keep = solved(), [0]
    for number in range(2, TS.size):
        if abs(z[number] - z[keep[-1]]) > 0.24 * EPS or number % 200 == 0:
            keep.append(number - 1)
    found = certified(z[keep], TS[keep])
    assert found.ok, found
    assert abs(found.viscosity - 1) > 0.1
    assert found.distance < 0.01


def sampled(scene, eps, gamma):
    """Until slips are in steps of 0.03 eps."""
    ts = np.linspace(0.0, float(scene.duration), 301)
    while True:
        z = np.asarray(fx.solve(scene, eps, gamma, ts, 1e-6, dissipation=False).z)
        fast = np.flatnonzero(np.abs(np.diff(z)) > 0.03 * eps)
        if not fast.size:
            return ts, z
        ts = np.sort(np.append(ts, 0.5 * (ts[fast] + ts[fast + 1])))


def test_a_slip_shorter_than_a_moment_shows_its_viscosity():
    """The curve is near a solution at about any time: slips take 1e-4 of their period."""
    scene, eps, gamma = SCENE.replace(duration=0.06), 0.01, 3.0
    ts, z = sampled(scene, eps, gamma)
    assert fx.certify(scene, eps, gamma, ts, z).ok
    other = fx.certify(scene, eps, gamma + 0.1, ts, z)
    assert other.status.name == "VISCOSITY", other
    assert other.within < 0.06
    assert other.shares["viscosity"] > 1


@pytest.mark.parametrize("side", [1, -1])
def test_where_a_tip_lingers_no_viscosity_is_told(side):
    """Forces that cancel tell noise: 22.8 and -18.2 times what it is."""
    spring, load = fx.supports.Spring(10.0), fx.loads.Sine(0.15, 3.0)
    scene = SCENE.replace(support=spring, load=load, duration=3.0)
    ts = np.linspace(0.0, 3.0, 1501)
    z = np.asarray(fx.solve(scene, 0.05, 1.4, ts, 1e-6, dissipation=False).z)
    found = fx.certify(scene, 0.05, 1.4, ts, z + side * 0.01 * 0.05)
    assert found.ok, found
    assert found.slips == 1
    assert np.isnan(found.viscosity)


@pytest.mark.parametrize(
    ("within", "viscosity", "coarser", "status"),
    [
        (np.inf, 1.3, 0.0, "VISCOSITY"),
        (np.inf, 1.3, 0.15, "VISCOSITY"),  # too little for what it is off
        (np.inf, 1.3, 0.25, "UNRESOLVED"),
        (np.inf, 0.7, 0.25, "UNRESOLVED"),
        (np.inf, 1.3, np.nan, "UNRESOLVED"),  # half the samples tell nothing
        (np.inf, 1.05, 0.0, "OK"),
        (np.inf, np.nan, np.nan, "OK"),  # no slips
        (0.05, 1.3, 0.0, "VISCOSITY"),
        (0.05, 1.3, 0.02, "VISCOSITY"),
        (0.05, 1.3, 0.04, "OK"),
        (0.05, 1.3, np.nan, "OK"),
    ],
)
def test_few_samples_of_slips_leave_their_viscosity_open(
    within, viscosity, coarser, status
):
    measured = CurveMeasures(
        distance=0.01,
        within=within,
        missing_force=-0.1,
        viscosity=viscosity,
        spacing=0.2,
    )
    assert verdict(measured, coarser).name == status


def test_open_verdicts_say_what_is_the_matter():
    found = certified(solved())._replace(status=CertificateStatus.UNRESOLVED)
    few = found._replace(viscosity=1.3, within=np.inf).message
    assert few == "samples are too few to tell the viscosity of slips: undecided"
    assert found._replace(spacing=0.3).message.startswith("samples are 0.3 eps apart")
    assert found.message == CertificateStatus.UNRESOLVED.message
