import numpy as np
import pytest
from noisy_wells import COSINE, EPS
from scipy import stats

import frictionjax as fx
from frictionjax.stochastic.histograms import _edges, spread_of_counts

PATHS = 150_000
BINS = np.linspace(-0.02, 0.02, 13)


def pinned(temperature=2e-4, load=0.0, *effects):
    """A tip in its spring, k = 1, eps = rho = 0.1: 6 times of relaxation."""
    noise = fx.effects.Noise(temperature / EPS)
    parts = COSINE.profile, COSINE.bristle, fx.supports.Spring(1.0)
    still = fx.loads.PiecewiseLinear([0.0, 1.0], [load, load])
    return fx.Scene(*parts, still, 0.08, effects=(*effects, noise))


@pytest.fixture(scope="module")
def found():
    scene = pinned()
    paths = fx.ensemble(scene, EPS, 1.0, [0.04, 0.08], PATHS, 5)
    return scene, paths, fx.histogram(scene, paths, bins=BINS)


def test_pinned_tips_have_boltzmanns_density_and_not_that_of_2_percent_more(found):
    _, paths, data = found
    assert 1e-3 < data.attrs["p_value"] < 0.999
    held = (data.density_low <= data.boltzmann) & (data.boltzmann <= data.density_high)
    assert int(np.sum(held)) >= data.sizes["bin"] - 3
    for temperature in (1.96e-4, 2.04e-4):
        other = fx.histogram(pinned(temperature), paths, bins=BINS)
        assert other.attrs["p_value"] < 1e-4
        assert np.array_equal(other["count"], data["count"])
    assert data.attrs["thermal_energy"] == pytest.approx(2e-4)
    assert data.attrs["paths"] == PATHS
    assert data.attrs["time"] == 0.08


def test_counts_and_densities_agree(found):
    _, paths, data = found
    z = paths.z.values[:, -1]
    edges = [*data.z_left.values, float(data.z_right[-1])]
    assert np.array_equal(data["count"], np.histogram(z, edges)[0])
    width = data.z_right - data.z_left
    assert np.allclose(data.density * width * PATHS, data["count"])
    fine = data.boltzmann_density
    inside = np.trapezoid(fine.values, fine.z_fine.values)
    assert inside == pytest.approx(float(np.sum(data.boltzmann * width)), rel=1e-4)
    assert all(data[name].attrs["long_name"] for name in data.variables)
    figure = fx.plot.draw_histogram(data)
    (axes,) = figure.axes
    assert axes.get_xlabel() == "z (m)"
    (line,) = [one for one in axes.lines if one.get_label() == "Boltzmann's density"]
    assert np.array_equal(line.get_ydata(), fine)


@pytest.mark.parametrize("bins", [1, 7, 20, 40])
def test_no_path_is_beyond_the_outermost_bins(bins):
    """An outermost path was left out by a rounding, every other time."""
    rng = np.random.default_rng(bins)
    for size in 10.0 ** rng.uniform(-9, 0, 200):
        z = 0.1 + size * rng.normal(size=50)
        assert np.sum(np.histogram(z, _edges(bins, z))[0]) == 50


def test_intervals_are_clopper_and_pearsons():
    scene = pinned()
    paths = fx.ensemble(scene, EPS, 1.0, [0.08], 60, 1)
    data = fx.histogram(scene, paths, bins=[-0.05, -0.005, 0.0, 0.001, 0.05, 0.06])
    width = (data.z_right - data.z_left).values
    assert int(data["count"][-1]) == 0
    for place, count in enumerate(data["count"].values):
        low, high = stats.binomtest(int(count), 60).proportion_ci(0.95)
        assert float(data.density_low[place]) * width[place] == pytest.approx(low)
        assert float(data.density_high[place]) * width[place] == pytest.approx(high)


def test_paths_that_are_not_at_rest_are_told_apart():
    """At the start all stand in one place; at another load the spring pulls elsewhere."""
    scene = pinned()
    paths = fx.ensemble(scene, EPS, 1.0, [0.0, 0.08], 500, 0)
    start = fx.histogram(scene, paths, time=0.0, bins=BINS)
    assert float(start["count"].max()) == 500
    assert start.attrs["p_value"] < 1e-12
    pulled = fx.histogram(pinned(load=0.02), paths, bins=10)
    assert pulled.attrs["p_value"] < 1e-12
    assert pulled.attrs["load"] == pytest.approx(0.02)


def test_rare_bins_are_counted_together():
    shares = np.array([0.001, 0.5, 0.497, 0.001])
    counts = np.array([0, 520, 478, 2])
    found = spread_of_counts(counts, shares, 1000)
    # Three rare ones, 3 paths expected, too few: with the smaller of the others.
    assert found.degrees == 1
    exact = stats.chisquare([520, 480], [500, 500])
    assert found.chi_square == pytest.approx(exact.statistic)
    assert found.p_value == pytest.approx(exact.pvalue)
    assert spread_of_counts(np.array([3]), np.array([1.0]), 3).degrees == 0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"time": 0.05}, "time = 0.05: needs one of the 2 times of paths"),
        ({"bins": 0}, "bins = 0: needs how many"),
        ({"bins": [0.1, 0.0]}, "bins = .*needs how many.*rising"),
        ({"paths": None}, "paths = None: needs a data set that ensemble has made"),
        (
            {"scene": pinned().replace(effects=())},
            r"scene\.effects = .*needs effects\.Noise among them",
        ),
    ],
)
def test_what_cannot_be_done_is_refused_by_name(change, message):
    paths = fx.ensemble(pinned(), EPS, 1.0, [0.04, 0.08], 2, 0)
    with pytest.raises(ValueError, match=message):
        fx.histogram(**({"scene": pinned(), "paths": paths} | change))
