"""Slides known from times of passage: where they end, and lanes that set off from them."""

import math

import numpy as np
import pytest
from fast_slides import BRISTLES, PROFILES, SCENES, SINE, TIMES
from paths import path_of

import frictionjax as fx
from frictionjax.wiggly import batch as engine
from frictionjax.wiggly.enclosure import chains, finder, marching
from frictionjax.wiggly.slip_map.fast_slides import FastSlide
from frictionjax.wiggly.slip_map.transit_times import TransitTimes


def test_a_slide_of_a_hundred_million_wells_is_followed_to_its_end(monkeypatch):
    """The averaged equation says where: it ended after two percent where steps of T failed.

    Nor is there any lag of the moment behind it, as it ends slow.
    """
    slides = []

    def only_slides(rounds, needs):
        slides.extend(finder.find_fast_slides(rounds, needs).slides[0])
        raise InterruptedError

    monkeypatch.setattr(engine, "find_fast_slides", only_slides)
    cell = np.array([1.3e-8]), np.array([0.5]), TIMES, 1e-3
    with pytest.raises(InterruptedError):
        engine.integrate_cells(SCENES["sine"], *cell, "windowed")
    path = path_of(SCENES["sine"])
    ways = np.abs(np.diff(path.states)) / 1.3e-8
    for slide in slides[:2]:
        assert slide.curve.edges[-1] > 0.98 * ways[slide.piece]
        assert slide.curve.edges.size < 50
        assert slide.curve.last < 0.5
    assert slides[2].end > 3.0 - 1e-6  # with the load's last instant, at full speed


def test_lanes_on_fast_slides_have_tolerances_of_their_own(monkeypatch):
    """Errors of two wells hardly add up; those of a long lane do."""
    marched = []
    march = marching.march

    def spy(lanes, cells, jobs, legs, *rest):
        way = np.abs(legs.guide1 - legs.guide0)
        wells = np.add.reduceat(way, jobs.first_leg) / cells.eps[jobs.cell.astype(int)]
        # The first slide, which the sine's turn at 0.75 slows down.
        slow = (jobs.origin > 0.1) & (legs.end[jobs.past_leg - 1] <= 0.75)
        slow &= np.abs(legs.slope0[jobs.first_leg]) < 0.1
        quick = np.abs(legs.slope0[jobs.first_leg]) > 1.0
        if cells.tolerance.size > 1:  # some jobs with a tolerance of their own
            own = cells.tolerance[jobs.cell.astype(int)]
            marched.append((own, wells, slow, quick))
        return march(lanes, cells, jobs, legs, *rest)

    monkeypatch.setattr(marching, "march", spy)
    cell = np.array([1.3e-6]), np.array([0.4]), TIMES, 1e-3
    found = engine.integrate_cells(SCENES["sine"], *cell, "windowed")
    assert found.status == fx.Status.OK
    rows = zip(*marched, strict=True)
    tolerance, wells, slow, quick = (np.concatenate(columns) for columns in rows)
    few, some, many = wells < 3, wells > 15, wells > 25
    assert np.median(tolerance[few]) > 30 * found.tolerance[0]
    # Nor do those of a lane where few wells are remembered.
    assert np.count_nonzero(some & slow) > 0
    assert np.all(tolerance[some & slow] > 30 * found.tolerance[0])
    assert np.count_nonzero(many & quick) > 0
    assert np.all(tolerance[many & quick] == found.tolerance[0])


def test_tiles_end_on_fast_slides():
    """Every sixteen wells of a slide: lanes set off there at no cost."""
    edges, none = np.array([0.0, 100.0]), np.zeros((1, 13))
    series = none + np.eye(13)[1] * 0.5  # a second for a hundred wells
    series[0, 0] = 0.5
    curve = TransitTimes(
        edges, np.array([1.0, 2.0]), series, none[:, 0], none[:, 0] + 0.9, 0.9
    )
    slide = FastSlide(curve, 1.0, 0.0, 0.0, 0, lambda: none[:, 0])
    times = np.array([0.0, 1.0, 1.15, 1.17, 1.33, 1.9, 2.0, 5.0])
    assert chains._on_slides((slide,), times).tolist() == [0, 0, 0, 1, 2, 5, 6, 6]
    assert chains._on_slides((), times).tolist() == [0] * 8


@pytest.mark.slow
def test_lag_follows_the_averaged_equation():
    """Where gamma is small, `v = eps^-gamma/int dY/(f - W')` gives the lag of a ramp."""
    load = fx.loads.Ramp(2.0, 0.0)
    scene = fx.Scene(
        PROFILES["sine"], BRISTLES["vertical"], fx.supports.Spring(1.0), load, 1.0
    )
    eps, gamma = 1e-7, 0.25
    found = fx.solve(scene, eps, gamma, np.array([0.0, 1.0]))
    assert found.status == fx.Status.OK
    # int_0^1 dY/(f - 0.1 cos(2 pi Y)) = 1/sqrt(f^2 - 0.01), and the slide moves at v = 2.
    force = math.sqrt(0.01 + (2.0 * eps**gamma) ** 2)
    assert abs(2.0 - force - float(found.z[-1])) < 2 * eps


@pytest.mark.slow
def test_a_fast_slide_alone_equals_the_batch():
    scene, times = SCENES["sine"], TIMES
    eps = np.array([1e-2, 2e-4, 3e-5])
    both = fx.sweep(scene, eps, [0.5, 1.0], times)
    alone = fx.sweep(scene, eps[1:2], [0.5], times)
    gap = np.abs(both.z.sel(gamma=0.5, eps=eps[1]) - alone.z.isel(gamma=0, eps=0))
    assert float(gap.max()) < 1e-6 * eps[1]


@pytest.mark.slow
def test_starts_behind_a_fast_slide_that_ends_fast():
    """A slide that ends while it lags: what follows must not trust lags of the moment.

    Sixteen wells before t = 1.2, a bracket made from them left the tip out: 6e-2 eps off.
    """
    profile = fx.profiles.Fourier(
        [0.0, 0.00384, 0, 0.00192], [0.01536, 0, -0.00384, 9.6e-4]
    )
    bristle = fx.bristles.AngularSpring(1.0, 1.5, 1.0, 0.2)
    scene = fx.Scene(profile, bristle, fx.supports.Spring(1.0), SINE, 3.0)
    eps, times = 10**-1.8, np.linspace(0.0, 3.0, 61)
    cell = np.array([eps]), np.array([0.5]), times, 1e-3
    few, every = (
        engine.integrate_cells(scene, *cell, method, balanced=False, suprema=False)
        for method in ("windowed", "resolved")
    )
    assert np.any(few.how == 2)
    assert not np.any(every.how == 2)
    still = (times > 1.1) & (times < 1.3)
    assert np.max(np.abs(few.z - every.z)[0, still]) < 5e-4 * eps


@pytest.mark.slow
def test_surveys_with_many_nodes_do_not_run_away(monkeypatch):
    """Chebyshev's points less than a well apart: 129 in 3800 wells made a sup of 6e3."""
    rougher = finder.MAP_SETTINGS._replace(tail=finder.MAP_SETTINGS.bare_tail)
    monkeypatch.setattr(finder, "MAP_SETTINGS", rougher)
    cell = np.array([1.3e-7]), np.array([0.4]), TIMES, 1e-3
    found = engine.integrate_cells(SCENES["sine"], *cell, "windowed", balanced=False)
    assert abs(found.sup_error[0] / 7.47784e-5 - 1) < 1e-2


@pytest.mark.slow
def test_brackets_that_stay_open_from_fast_slides_end_in_one_lane():
    """A tip that forgets in a second: brackets 0.05 eps wide had a good status."""
    scene = fx.Scene(
        fx.profiles.Fourier([-1.99e-3, -1.7e-4, -6.2e-4], [1.48e-3, 4.3e-4, -8.1e-4]),
        fx.bristles.AngularSpring(1.096, 1.526, 1.0, 0.127),
        fx.supports.Spring(0.00752),
        fx.loads.Sine(0.2874, 1.371),
        2.0,
        -0.6735,
    )
    ts = np.linspace(0.0, 2.0, 41)
    plain = fx.solve(scene, 0.137, 2.412, ts, method="Kvaerno5")
    assert plain.ok
    for method in ("auto", "resolved"):
        found = fx.solve(scene, 0.137, 2.412, ts, method=method)
        assert found.ok
        assert np.abs(found.z - plain.z).max() < 1e-4 * 0.137
        assert np.all(found.stats["bracket"] < 1e-3)
