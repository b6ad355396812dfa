"""What the fit of a profile says beside the profile: free parameters, what is left open."""

import io

import jax
import numpy as np
import pytest
from samples import Formula

import frictionjax as fx
from frictionjax.design.surface.barrier.constraints import flat
from frictionjax.design.surface.barrier.iterates import barrier_of
from frictionjax.design.surface.fit import surface_problem
from frictionjax.design.surface.open_directions import identifiability
from frictionjax.design.surface.starts import random_start
from frictionjax.design.surface.status import ProfileStatus

SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
MEMBERS = 12  # of a family, as the picture has them: another number is another program
TARGET = fx.Target(SLANTED, 0.15, -0.1)
FREE = {
    "free": ["angle", "stiffness"],
    "bounds": {"angle": (0.1, 0.9), "stiffness": (0.5, 2.0)},
}


@pytest.fixture(scope="module")
def fit():
    return fx.fit_profile(TARGET, starts=2)


@pytest.fixture(scope="module")
def freed():
    return fx.fit_profile(TARGET, starts=3, **FREE)


def rho(cos, sin, bristle):
    found = fx.friction(fx.profiles.Fourier(cos, sin), bristle)
    return np.array([float(found.rho_plus), float(found.rho_minus)])


@pytest.mark.slow
def test_free_parameters_make_the_surface_gentler(fit, freed):
    assert freed.success
    found = rho(freed.profile.cos, freed.profile.sin, freed.bristles[0])
    np.testing.assert_allclose(found, [0.15, -0.1], rtol=1e-9)
    assert freed.bending_energy < 0.5 * fit.bending_energy
    assert freed.free["stiffness"] == pytest.approx(2.0, rel=1e-4)  # the stiffest
    assert 0.1 < freed.free["angle"] < 0.9
    assert float(freed.bristles[0].angle) == freed.free["angle"]
    inside = freed.history.free
    assert np.nanmin(inside[..., 0]) > 0.1
    assert np.nanmax(inside[..., 0]) < 0.9
    assert np.nanmin(inside[..., 1]) > 0.5
    assert np.nanmax(inside[..., 1]) < 2.0
    energies = [one.bending_energy for one in freed.starts]
    assert max(energies) / min(energies) < 1 + 1e-4


@pytest.mark.slow  # fits with the angle held are a program of their own
def test_no_angle_nearby_bends_less(freed):
    """The angle found, against fits with the angle held: an independent scan."""
    energies = []
    for angle in freed.free["angle"] + np.array([-0.05, 0.0, 0.05]):
        bristle = fx.bristles.SlantedSpring(2.0, 2.4, 1.0, angle)
        held = fx.fit_profile(fx.Target(bristle, 0.15, -0.1), starts=2)
        energies.append(held.bending_energy)
    assert energies[1] < energies[0]
    assert energies[1] < energies[2]
    assert abs(freed.bending_energy / energies[1] - 1) < 1e-3


@pytest.mark.slow  # fits with two numbers free, a program of their own
def test_sensitivities_are_the_derivatives_of_the_coefficients(freed):
    """Against central differences of `friction` itself, parameters included."""
    # Not at the optimum, which is symmetric: there half the derivatives are 0.
    other = freed.family(MEMBERS, size=1.0)[0]
    turn = 2 * np.pi * 0.1 * np.arange(1, 17)
    cos = np.cos(turn) * other.cos - np.sin(turn) * other.sin
    sin = np.cos(turn) * other.sin + np.sin(turn) * other.cos
    unknowns = np.concatenate([cos, sin])
    law = surface_problem([TARGET], free=FREE["free"], bounds=FREE["bounds"]).law
    bounds = zip(freed.free, ((0.1, 0.9), (0.5, 2.0)), strict=True)
    share = [(freed.free[name] - low) / (high - low) for name, (low, high) in bounds]
    known = identifiability(law, cos, sin, np.array(share)).sensitivities
    here = rho(cos, sin, freed.bristles[0])
    for index in (0, 3, 9, 16, 17, 20, 31):
        step = np.zeros(32)
        step[index] = 1e-8
        ends = [rho(*np.split(unknowns + s * step, 2), freed.bristles[0]) for s in (1, -1)]
        slope = (ends[0] - ends[1]) / 2e-8 / here
        size = np.abs(known).max()
        np.testing.assert_allclose(known[:, index], slope, rtol=1e-5, atol=1e-7 * size)
    for index, (name, low, high) in enumerate(
        [("angle", 0.1, 0.9), ("stiffness", 0.5, 2.0)], start=32
    ):
        values = freed.free | {}
        ends = []
        for sign in (1, -1):
            moved = values | {name: values[name] + sign * 1e-6 * (high - low)}
            bristle = fx.bristles.SlantedSpring(
                moved["stiffness"], 2.4, 1.0, moved["angle"]
            )
            ends.append(rho(cos, sin, bristle))
        slope = (ends[0] - ends[1]) / 2e-6 / here
        np.testing.assert_allclose(known[:, index], slope, rtol=1e-6)


@pytest.mark.slow
def test_the_barrier_has_the_derivatives_it_says():
    problem = surface_problem(
        [TARGET], bounds=FREE["bounds"], free=FREE["free"], radius=0.2, amplitude=0.1
    )
    share = np.array([0.4, 0.6])
    first = random_start(problem.layout, problem.task, jax.random.PRNGKey(3), share, share)
    barrier = barrier_of(problem.layout, problem.task, np.array(0.5), first)
    barrier = barrier._replace(weight=np.array(0.1))
    x = np.asarray(flat(first))
    value, slope = jax.jit(barrier.value), jax.jit(jax.grad(barrier.value))
    rng = np.random.default_rng(0)
    hessian = np.asarray(jax.jit(barrier.hessian)(x))
    for _ in range(4):
        way = rng.normal(size=x.size) * np.minimum(np.abs(x), 0.05)
        step = 1e-5
        ends = [value(x + s * step * way) for s in (1, -1, 2, -2)]
        central = (8 * (ends[0] - ends[1]) - (ends[2] - ends[3])) / (12 * step)
        assert np.isclose(float(slope(x) @ way), float(central), rtol=1e-6)
        ends = [slope(x + s * step * way) for s in (1, -1, 2, -2)]
        central = (8 * (ends[0] - ends[1]) - (ends[2] - ends[3])) / (12 * step)
        size = np.max(np.abs(central))
        np.testing.assert_allclose(hessian @ way, central, rtol=1e-5, atol=1e-6 * size)


def test_open_directions_change_no_coefficient(fit):
    assert fit.rank == 2
    assert fit.open_directions.shape == (30, 32)
    square = fit.open_directions @ fit.open_directions.T
    np.testing.assert_allclose(square, np.eye(30), atol=1e-12)
    unknowns = np.concatenate([fit.profile.cos, fit.profile.sin])
    here = rho(*np.split(unknowns, 2), SLANTED)
    for direction in fit.open_directions[::6]:
        large, small = (
            np.max(np.abs(rho(*np.split(unknowns + h * direction, 2), SLANTED) / here - 1))
            for h in (1e-5, 1e-6)
        )
        assert small < 0.02 * large + 1e-11  # second order
    seen = fit.identifiability.sensitivities[0]
    moved = rho(*np.split(unknowns + 1e-5 * seen / np.linalg.norm(seen), 2), SLANTED)
    assert abs(moved[0] / here[0] - 1) > 1e-3
    # Smoothest first.
    stiffness = np.tile((2 * np.pi * np.arange(1, 17)) ** 4, 2)
    energies = np.sum(fit.open_directions**2 * stiffness, axis=1)
    assert np.all(np.diff(energies) > 0)


@pytest.mark.slow  # a program of its own
def test_the_family_has_the_same_coefficients_and_bends_more(fit):
    family = fit.family(MEMBERS, size=1.0)
    assert len(family) == MEMBERS
    for other in family:
        found = rho(other.cos, other.sin, SLANTED)
        np.testing.assert_allclose(found, [0.15, -0.1], rtol=1e-9)
        turns = 2 * np.pi * np.arange(1, 17)
        energy = 0.5 * np.sum(turns**4 * (other.cos**2 + other.sin**2))
        assert energy > fit.bending_energy
        assert np.max(np.abs(other.sin - fit.profile.sin)) > 1e-4
    again = fit.family(MEMBERS, size=1.0)
    np.testing.assert_array_equal(again[3].cos, family[3].cos)
    with pytest.raises(ValueError, match="count = 0: needs a whole number >= 1"):
        fit.family(0)
    with pytest.raises(ValueError, match="size = 0: needs a number > 0"):
        fit.family(2, size=0.0)


def test_json_and_back(fit, tmp_path):
    path = tmp_path / "fit.json"
    text = fit.to_json(path)
    for again in (type(fit).from_json(text), type(fit).from_json(path)):
        assert again.to_json() == text
        np.testing.assert_array_equal(again.profile.sin, fit.profile.sin)
        assert again.status is fit.status
        assert again.starts == fit.starts
        np.testing.assert_array_equal(again.history.loss, fit.history.loss)
        assert again.bristles[0].angle == SLANTED.angle
        found = fx.friction(again.profile, again.bristles[0])
        assert float(found.rho_plus) == float(fit.coefficients[0].rho_plus)
        assert repr(again) == repr(fit)
        assert len(again.family(MEMBERS)) == MEMBERS


@pytest.mark.slow
def test_json_of_functions_and_of_something_else(fit):
    custom = fx.bristles.Custom(
        Formula(_lean, np.array([0.1])), Formula(_press, np.ones(1))
    )
    other = fx.fit_profile(fx.Target(custom, 0.2, -0.1), starts=2)
    assert type(fit).from_json(other.to_json()).bristles == (None,)
    for source, message in (
        ("{}", "source = 'another document'"),
        ("{", "source: not JSON"),
        ("nowhere.json", "source = 'nowhere.json'"),
        ('{"kind": "frictionjax.ProfileFit"}', "source = 'without bending_bound"),
    ):
        with pytest.raises(ValueError, match=message):
            type(fit).from_json(source)


def _lean(eta, a):
    return a * eta


def _press(eta, alpha):
    return alpha * eta


def test_the_picture_shows_the_data(fit):
    figure = fit.plot()
    figure.savefig(io.BytesIO(), format="png", dpi=40)
    surface, slopes, starts, targets = figure.axes
    for axes in figure.axes:
        assert axes.get_xlabel()
        assert axes.get_ylabel()
    last = surface.lines[-1].get_ydata()
    heights = np.array([float(fit.profile(y)) for y in (-0.5, 0.0, 0.25)])
    np.testing.assert_allclose(last[[0, 512, 768]], heights, atol=1e-12)
    levels = [line.get_ydata()[0] for line in slopes.lines[-2:]]
    found = fit.coefficients[0]
    np.testing.assert_allclose(levels, [found.omega_plus, found.omega_minus])
    assert len(surface.lines) == MEMBERS + 1
    shown = [line for line in starts.lines if line.get_linestyle() == "None"]
    assert [one.ran for one in fit.starts] == [True, False]  # a closed form
    drawn = np.concatenate([line.get_ydata() for line in shown])
    np.testing.assert_allclose(drawn, [one.bending_energy for one in fit.starts])
    assert shown[1].get_fillstyle() == "none"
    assert shown[1].get_label() == "not run: best is proven"
    np.testing.assert_allclose(targets.lines[0].get_ydata(), [0.15])
    np.testing.assert_allclose(targets.lines[1].get_xdata(), [0.1])


def test_the_result_in_words(fit):
    assert repr(fit).startswith("ProfileFit(MET: every target is met)")
    assert "rho_plus = 0.15 N (target 0.15)" in repr(fit)
    assert fit.status is ProfileStatus.MET
    with pytest.raises(AttributeError):
        fit.success = False
