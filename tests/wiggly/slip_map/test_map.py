"""Times of passage of the wells of fast slides, and values that follow from them."""

import math
from fractions import Fraction

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from fast_slides import COS, SCENES, SIN, TIMES
from paths import path_of
from reference import System, series, sine
from reference import solve as solve_plainly
from scipy.integrate import solve_ivp

import frictionjax as fx
from frictionjax.model import tabulated_scene
from frictionjax.wiggly import batch as engine
from frictionjax.wiggly.enclosure import CellBounds
from frictionjax.wiggly.equation.landscape import Landscape, landscape
from frictionjax.wiggly.plan import planned
from frictionjax.wiggly.slip_map import map as slip_map
from frictionjax.wiggly.slip_map import recursion
from frictionjax.wiggly.slip_map.transit import pull_at, transit_times
from frictionjax.wiggly.slip_map.transit_times import ManyTransitTimes, TransitTimes
from frictionjax.wiggly.slip_map.well_pull import WellArc, well_pull_of
from frictionjax.wiggly.ways import Way


def ground_of(scene, eps) -> Landscape:
    return landscape(scene.potential, jnp.asarray(eps))


def passage_of(scene, eps, gamma, sign, excess):
    """A passage from the fold with `excess` beyond it, at about t = 0.3."""
    folds = ground_of(scene, eps).folds
    up = sign > 0
    place = float(folds.place_plus if up else folds.place_minus)
    force = float(folds.force_plus if up else folds.force_minus)
    time = 0.3 if up else 1.2
    pull = force + sign * excess
    state = float(scene.support.state_of(scene.load(time) - pull))
    one = np.ones(1)
    stretch = WellArc(
        eps * one, place * one, one, sign * one, force * one, 0.5 * excess * one
    )
    track = well_pull_of(scene.potential, stretch)
    local = pull_at(scene, np.full((1, 12), time), np.full((1, 12), state))
    found = transit_times(track, local, one * eps**gamma)
    return float(found.length[0, 0]), float(found.kept[0, 0]), (place, time, state)


def plain_passage(scene, eps, gamma, sign, place, time, state):
    """The same by SciPy, time as a function of the tip."""
    offset = float(scene.potential.offset(place, eps))

    @jax.jit
    def slope(way, since):
        y = place + sign * way
        wiggle, stretch = scene.potential.tip_force(y, eps)
        z = state + sign * eps * way + scene.potential.offset(y, eps) - offset
        force = scene.load(time + eps * since[0]) - scene.support.force(z) - wiggle
        return sign * eps**gamma * stretch / force

    found = solve_ivp(
        lambda *at: [float(slope(*at))],
        (0, 1),
        [0.0],
        method="DOP853",
        rtol=1e-10,
        atol=1e-13,
    )
    return eps * found.y[0, -1]


@pytest.mark.slow
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("name", ["several folds", "convex"])
def test_passages_are_those_of_a_plain_integration(name, sign):
    scene, eps, gamma = SCENES[name], 1e-3, 0.4
    length, kept, where = passage_of(scene, eps, gamma, sign, 0.03)
    plain = plain_passage(scene, eps, gamma, sign, *where)
    assert abs(length / plain - 1) < 1e-8
    place, time, state = where
    shift = 1e-3 * length
    later = plain_passage(scene, eps, gamma, sign, place, time + shift, state)
    assert abs(kept - (1 + (later - plain) / shift)) < 1e-3 * (1 - kept)


@pytest.mark.slow  # 300 wells one by one
def test_curves_obey_the_recursion():
    """Well after well by the passage map against the panels."""
    scene, eps, gamma = SCENES["sine"], 1e-4, 0.5
    folds = ground_of(scene, eps).folds
    place, force, one = float(folds.place_plus), float(folds.force_plus), np.ones(1)
    time, excess = 0.3, 1e-3
    state = float(scene.support.state_of(scene.load(time) - force - excess))
    stretch = WellArc(eps * one, place * one, one, one, force * one, 0.3 * excess * one)
    track = well_pull_of(scene.potential, stretch)
    viscosity = one * eps**gamma
    slides = recursion.Slides(
        track, eps * one, viscosity, state * one, 0 * one, time * one, 0.75 * one
    )
    (curve,) = slip_map.follow(scene, slides, 1e-6)
    assert curve.edges[-1] > 3000
    now = curve.starts[0]
    for n in range(300):
        pull = pull_at(scene, np.full((1, 12), now), np.full((1, 12), state + eps * n))
        length = transit_times(track, pull, viscosity).length[0, 0]
        now += length
        assert abs(curve.time_of(np.array([n + 1.0]))[0] - now) < 1e-6 * length
    numbers = np.linspace(0.0, curve.edges[-1], 57)
    assert np.allclose(curve.number_at(curve.time_of(numbers)), numbers, atol=1e-8)


PLAIN = {
    "sine": System(
        sine(0.1),
        lambda eta: (0.0, 0.0, 1.0 + eta),
        lambda z: z,
        lambda t: 1.0488 * math.sin(2 * math.pi * t / 3),
        3.0,
    ),
    "overshoot": System(
        sine(0.1),
        lambda eta: (
            -eta * math.tan(1.0),
            -math.tan(1.0),
            (2.4 - (1.0 - eta) / math.cos(1.0)) / math.cos(1.0),
        ),
        lambda z: z,
        lambda t: 0.8 * 2 / math.pi * math.asin(math.sin(2 * math.pi * t / 2.2)),
        3.0,
        kinks=(0.55, 1.65, 2.75),
    ),
    "several folds": System(
        series(COS, SIN),
        lambda eta: (
            math.sqrt(1.414**2 - (1 - eta) ** 2) - math.sqrt(1.414**2 - 1),
            (1 - eta) / math.sqrt(1.414**2 - (1 - eta) ** 2),
            (math.acos((1 - eta) / 1.414) - 0.3) / math.sqrt(1.414**2 - (1 - eta) ** 2),
        ),
        lambda z: z,
        lambda t: 1.0488 * math.sin(2 * math.pi * t / 3),
        3.0,
    ),
}


@pytest.mark.parametrize(
    ("name", "gamma"),
    [
        ("sine", 0.5),
        pytest.param("overshoot", 0.25, marks=pytest.mark.slow),
        pytest.param("several folds", 0.4, marks=pytest.mark.slow),
    ],
)
def test_values_are_those_of_lsoda(name, gamma):
    eps = 2.3e-3
    plain = solve_plainly(PLAIN[name], eps, gamma, 0.0, TIMES)
    found = fx.solve(SCENES[name], eps, gamma, TIMES, method="windowed")
    assert found.status == fx.Status.OK
    assert np.mean(found.stats["how"] == 2) > 0.6
    assert "slip map" in found.stats["values"]
    error = np.abs(np.asarray(found.z) - plain.z) / eps
    assert np.max(error[~plain.in_slip]) < 1e-3
    lost = np.abs(np.asarray(found.dissipation) - plain.dissipation)
    assert np.max(lost) < 1e-3 * plain.dissipation[-1]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "gamma"), [("convex", 0.5)])
def test_sums_and_extremes_are_those_of_every_slip(name, gamma):
    eps = np.array([1.7e-3])
    few, every = (
        engine.integrate_cells(SCENES[name], eps, np.array([gamma]), TIMES, 1e-3, method)
        for method in ("windowed", "resolved")
    )
    assert np.any(few.how == 2)
    assert not np.any(every.how == 2)
    assert abs(few.sup_error - every.sup_error)[0] < 1e-3 * eps[0]
    assert abs(few.strip_excess - every.strip_excess)[0] < 1e-3 * eps[0]
    whole = every.dissipation[0, -1]
    assert np.max(np.abs(few.dissipation - every.dissipation)) < 1e-3 * whole
    assert abs(few.dissipation_error - every.dissipation_error)[0] < 1e-3 * whole


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "gamma"),
    [("sine", 0.25), ("overshoot", 0.5)],
)
def test_small_eps_is_no_harder(name, gamma):
    """At a thousand times smaller eps: brackets closed, few steps more."""
    scene = SCENES[name]
    found = [fx.solve(scene, eps, gamma, TIMES) for eps in (1.3e-5, 1.3e-8)]
    for one in found:
        assert one.status == fx.Status.OK
        assert np.max(one.stats["bracket"]) < 1e-2
        assert np.median(one.stats["bracket"]) < 5e-4
    # The panels of a slide grow with the logarithm of its wells; what measures its map at
    # gamma = 1/4 with their number, as loads are rounded.
    ratio = found[1].stats["steps"] / found[0].stats["steps"]
    assert ratio < (3.0 if gamma == 0.5 else 10.0)
    assert found[1].stats["steps"] < 6e6


def test_errors_of_a_wrong_map_are_seen(monkeypatch):
    """Passages a thousandth too long: lanes disagree, and no bracket closes."""
    right = recursion.transit_times

    def wrong(*args):
        found = right(*args)
        return found._replace(length=found.length * (1 + 1e-4))

    scene, eps, gamma = SCENES["sine"], 1e-6, 0.5
    none = np.zeros(1, dtype=bool)
    monkeypatch.setattr(CellBounds, "is_affordable", lambda ground, path: none)
    monkeypatch.setattr(recursion, "transit_times", wrong)
    found = fx.solve(scene, eps, gamma, TIMES)
    assert found.status != fx.Status.OK or np.max(found.stats["bracket"]) > 5e-4


def test_maps_are_made_where_they_are_cheaper():
    """A hundred slips are integrated, millions mapped; by name as asked for."""
    scene, eps = SCENES["sine"], np.array([3e-2, 1e-6])
    path, tables = path_of(scene), tabulated_scene(scene, 3e-2)

    def by_map(gamma, method):
        gammas = np.full(eps.size, gamma)
        plan = planned(tables, path, eps, gammas, TIMES.size, 1e-3, method)
        return (plan.way == Way.SLIP_MAP).tolist()

    assert by_map(0.5, "auto") == [False, True]
    assert by_map(0.5, "windowed") == [True, True]
    assert by_map(0.5, "resolved") == [False, False]
    assert by_map(1.0, "windowed") == [False, False]


def test_rounded_times_say_by_how_much():
    """Sub-spacing parts of times on a panel that starts late: exact ones as fractions."""
    start, wells, length = 2.9, 1000.0, 6.5e-9
    series = np.zeros((1, 13))
    series[0, :2] = 0.5 * wells * length
    edges, starts = np.array([0.0, wells]), np.array([start, start + wells * length])
    nothing = np.zeros(1)
    curves = ManyTransitTimes([TransitTimes(edges, starts, series, nothing, nothing, 1.0)])
    number = np.array([0.0, 1.0, 7.0, 399.0, 1000.0])
    times, late = curves.rounded_times(np.zeros(5, dtype=int), number)
    np.testing.assert_array_equal(times, curves.time_of(np.zeros(5, dtype=int), number))
    exact = [Fraction(start) + Fraction(length) * Fraction(n) for n in number]
    off = [float(Fraction(t) - e) for t, e in zip(times, exact, strict=True)]
    assert np.max(np.abs(off)) > 1e-8 * length  # rounding is there, and is told:
    np.testing.assert_allclose(late, off, rtol=0, atol=1e-9 * length)


@pytest.mark.slow
@pytest.mark.parametrize("accuracy", [1e-5, 1e-6])
def test_maps_are_measured_as_closely_as_accuracy_wants(accuracy):
    """Where errors of maps are measured too coarsely, brackets as wide stay open."""
    cell = np.array([1.3e-5]), np.array([0.5]), TIMES, accuracy
    found = engine.integrate_cells(SCENES["sine"], *cell, "auto", balanced=False)
    assert found.status == fx.Status.OK
    assert found.gap.max() < accuracy
