"""The limit system of a rod that turns over."""

import equinox as eqx
import jax
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.rods import TurningRod

ROD = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3)
SURFACE = fx.profiles.Sine(0.5)
REACH = 1.0


def scene(stiffness=1.0, bending=0.1, amplitude=4.5, support=None, z0=0.0, periods=2):
    return fx.Scene(
        SURFACE,
        ROD,
        fx.supports.Spring(stiffness) if support is None else support,
        fx.loads.Triangle(amplitude, 4.0),
        4.0 * periods,
        z0=z0,
        effects=(fx.effects.NapFlip(bending),),
    )


def stored(mode, x, bending):
    """Energy of the rod in J, with its root x ahead of its tip."""
    rod = TurningRod(1.0, 0.3, 2**0.5, bending, 1.0)
    places = np.where(mode == 0, x, mode * REACH)
    return np.asarray(energies(rod, places))


@eqx.filter_jit
def energies(rod, places):
    return jax.vmap(rod.energy)(places)


@pytest.mark.parametrize("bending", [0.1, 0.19])
@pytest.mark.parametrize("stiffness", [0.05, 0.2, 1.0])
def test_nothing_is_lost_but_what_it_says(stiffness, bending):
    one = scene(stiffness, bending, 4 * stiffness + 0.5)
    ts = np.linspace(0, 8, 1001)
    found = fx.solve_limit(one, ts)
    assert found.ok
    load = np.asarray(jax.jit(jax.vmap(one.load))(ts))
    z, mode = np.asarray(found.z), np.asarray(found.mode)
    # The tip of a turning is where the rod before it has left it.
    tip = np.where(mode == 1, z, np.where(mode == -1, z + 2 * REACH, np.nan))
    first = np.maximum.accumulate(np.where(mode != 0, np.arange(ts.size), 0))
    x = z + REACH - tip[first]
    energy = 0.5 * stiffness * z**2 - load * z + stored(mode, x, bending)
    work = np.cumsum(np.diff(load) * 0.5 * (z[1:] + z[:-1]))
    balance = energy[1:] - energy[0] + np.asarray(found.dissipation)[1:] + work
    # A step in which it jumps is all that the trapezoid rule has wrong.
    jump = np.max(np.abs(np.diff(z))) * np.max(np.abs(np.diff(load)))
    assert np.max(np.abs(balance)) < 4 * jump + 1e-6
    assert np.all(np.diff(found.dissipation) >= -1e-12)


def test_slides_go_on_after_twice_the_reach():
    """The tip stays where it is while the root goes 2 c past it."""
    ts = np.linspace(0, 8, 2001)
    found = fx.solve_limit(scene(), ts)
    z, mode = np.asarray(found.z), np.asarray(found.mode)
    law = fx.nap(SURFACE, ROD)
    load = np.asarray(jax.jit(jax.vmap(scene().load))(ts))
    slides = np.abs(load - z + law.rho_flipped) < 1e-9
    turned = np.flatnonzero(slides & (mode == -1))[0]
    before = np.max(z[:turned])
    assert before - z[turned] == pytest.approx(2 * REACH, abs=2 * 4.5 / 250)
    np.testing.assert_allclose(found.root, z + REACH, rtol=0, atol=0)


def test_it_slides_with_its_nap_both_ways():
    ts = np.linspace(0, 8, 2001)
    one = scene()
    found, law = fx.solve_limit(one, ts), fx.nap(SURFACE, ROD)
    z, mode = np.asarray(found.z), np.asarray(found.mode)
    force = np.asarray(jax.jit(jax.vmap(one.load))(ts)) - z
    moves = np.diff(z, append=np.nan)
    for way, friction in ((1, law.rho_with), (-1, -law.rho_flipped)):
        slides = (mode == way) & (way * moves > 1e-5)
        slides[1:] &= slides[:-1]  # the first step begins at rest
        assert slides.sum() > 300
        np.testing.assert_allclose(force[slides], friction, rtol=1e-12)


def test_it_turns_where_its_compression_is_the_critical_load():
    one = scene(bending=0.19)
    coarse = np.linspace(0, 8, 401)
    mode = np.asarray(fx.solve_limit(one, coarse).mode)
    cells = np.flatnonzero((mode[1:] == 0) & (mode[:-1] != 0))
    assert len(cells) == 4
    critical = np.pi**2 * 0.19 / 2
    for cell in cells:
        ts = np.linspace(*coarse[cell : cell + 2], 101)
        found = fx.solve_limit(one, ts)
        mode = np.asarray(found.mode)
        force = np.asarray(jax.jit(jax.vmap(one.load))(ts)) - np.asarray(found.z)
        at = np.flatnonzero(mode)[-1]
        alpha = (np.pi / 4 - mode[at] * 0.3) / 1.0
        # At rest with the force f on its root: `N = alpha - f cot`, here cot = 1.
        normal = alpha - mode[at] * force[at]
        pressed = (normal - mode[at] * force[at]) * 0.5**0.5
        assert pressed == pytest.approx(critical, rel=2e-3)


def test_times_between_do_not_matter():
    one, few = scene(0.2, 0.19, 1.3), np.array([0.7, 1.6, 1.9, 3.5, 5.2, 8.0])
    many = np.sort(np.concatenate([few, np.linspace(0, 8, 333)]))
    places = np.searchsorted(many, few)
    one_way, other = fx.solve_limit(one, few), fx.solve_limit(one, many)
    np.testing.assert_allclose(one_way.z, other.z[places], atol=1e-12)
    np.testing.assert_allclose(one_way.dissipation, other.dissipation[places], atol=1e-12)
    np.testing.assert_array_equal(one_way.mode, other.mode[places])


def test_a_curved_support_holds_it_too():
    """Its force is interpolated: a spring written as a function gives the same."""
    curved = fx.supports.Convex(lambda z: 0.1 * z**2)
    ts = np.linspace(0, 8, 101)
    one, other = scene(0.2, 0.1, 1.3), scene(support=curved, bending=0.1, amplitude=1.3)
    found, same = fx.solve_limit(one, ts), fx.solve_limit(other, ts)
    np.testing.assert_allclose(found.z, same.z, atol=1e-8)
    np.testing.assert_array_equal(found.mode, same.mode)


def test_critical_loads_outside_of_the_window_are_refused():
    window = fx.nap(SURFACE, ROD).window
    for load in (0.999 * window.least, 1.001 * window.greatest):
        with pytest.raises(ValueError, match=r"NapFlip\.bending_stiffness = .* < bend"):
            fx.solve_limit(scene(bending=load * 2 / np.pi**2))
    inside = scene(bending=1.4 * window.least * 2 / np.pi**2)
    assert fx.solve_limit(inside, [1.0]).ok
    with pytest.raises(ValueError, match="a rod that can turn over"):
        fx.solve_limit(inside.replace(profile=fx.profiles.Sine(0.1)))
    with pytest.raises(ValueError, match=r"scene\.z0 = 0\.3: needs .* \[-0\.16"):
        fx.solve_limit(scene(z0=0.3))


def test_traced_scenes_are_refused():
    with pytest.raises(ValueError, match="traced"):
        jax.grad(lambda t: fx.solve_limit(scene(), t).z[0])(np.array([1.0]))
