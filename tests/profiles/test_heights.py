"""Periodic profiles out of measured traces."""

from pathlib import Path

import numpy as np
import pytest

import frictionjax as fx

PERIOD = 9.1e-6
COS = np.array([40e-9, 10e-9, -4e-9])
SIN = np.array([60e-9, -15e-9, 2e-9])
DATA = Path(__file__).parents[3] / "shared" / "data"
from_heights = fx.profiles.Fourier.from_heights


def trace(periods=7.3, samples=400, noise=0.0, drift=0.0, uneven=False, cos=COS, seed=0):
    rng = np.random.default_rng(seed)
    x = np.linspace(0, periods * PERIOD, samples)
    if uneven:
        x = np.sort(rng.uniform(0, periods * PERIOD, samples))
    phases = 2 * np.pi * np.outer(x / PERIOD, np.arange(1, 4))
    waves = np.cos(phases) @ cos + np.sin(phases) @ SIN
    line = drift * (3e-8 + x / np.ptp(x))
    return x + 0.01, waves + line + noise * rng.normal(size=samples)


def amplitudes(fit):
    """They do not depend on where x starts."""
    return fit.period * np.hypot(fit.profile.cos, fit.profile.sin)


@pytest.mark.parametrize("uneven", [False, True])
@pytest.mark.parametrize("period", [PERIOD, None])
def test_a_clean_trace_gives_its_coefficients(period, uneven):
    fit = from_heights(*trace(uneven=uneven, drift=1e-6), period, harmonics=3)
    assert abs(fit.period / PERIOD - 1) < 1e-6
    np.testing.assert_allclose(amplitudes(fit), np.hypot(COS, SIN), rtol=1e-5)
    assert fit.explained > 1 - 1e-9


@pytest.mark.parametrize("periods", [2.5, 7.3, 30.0])
def test_noise_and_drift(periods):
    # The error of a coefficient is noise sqrt(2/n): 5 of those.
    noise, samples = 5e-9, 900
    x, heights = trace(periods, samples, noise, drift=3e-7)
    fit = from_heights(x, heights, harmonics=3)
    assert abs(fit.period / PERIOD - 1) < 2e-3 / periods
    allowed = 5 * noise * np.sqrt(2 / samples)
    assert np.max(np.abs(amplitudes(fit) - np.hypot(COS, SIN))) < allowed
    share = noise**2 / (noise**2 + 0.5 * np.sum(COS**2 + SIN**2))
    assert abs(1 - fit.explained - share) < 0.2 * share


def test_slopes_are_those_measured():
    x, heights = trace(samples=4000)
    fit = from_heights(x[::8], heights[::8], harmonics=3)
    found = fx.friction(fit.profile, fx.bristles.Homothetic(1.0))
    slopes = np.gradient(heights, x)
    assert found.omega_plus == pytest.approx(slopes.max(), rel=1e-3)
    assert found.omega_minus == pytest.approx(slopes.min(), rel=1e-3)


def test_a_weak_fundamental_is_found():
    # The second wave is 9 times the first: half the period fits best with one wave.
    rng = np.random.default_rng(5)
    x = np.linspace(0, 8.2 * PERIOD, 600)
    phase = 2 * np.pi * x / PERIOD
    heights = 10e-9 * np.sin(phase) + 90e-9 * np.sin(2 * phase + 0.4)
    fit = from_heights(x, heights + 1e-9 * rng.normal(size=600), harmonics=4)
    assert abs(fit.period / PERIOD - 1) < 1e-3
    assert fit.explained > 0.999


def test_pure_noise_is_not_explained():
    x = np.linspace(0, 1e-3, 400)
    with pytest.warns(fx.profiles.SlopesUndetermined):
        fit = from_heights(x, np.random.default_rng(1).normal(size=400), harmonics=2)
    assert fit.explained < 0.2


@pytest.mark.parametrize("rows", [1, 3])
def test_where_noise_has_no_period_of_use_that_is_what_is_said(rows):
    x = np.linspace(0, 1e-3, 400)
    heights = np.random.default_rng(1).normal(size=(rows, 400))
    said = r"period = 'none was found': needs heights that repeat, or its value: the best, "
    with pytest.raises(ValueError, match=said + r"\S+ m, explains \d% of their variance"):
        from_heights(x, heights if rows > 1 else heights[0], harmonics=40)
    # A wave of few samples is there all the same.
    with pytest.raises(ValueError, match="harmonics = 40: needs harmonics <= "):
        from_heights(x, np.sin(2 * np.pi * 60 * x / 1e-3), harmonics=40)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"heights": np.zeros(5)}, "heights"),
        ({"heights": "rough"}, "heights"),
        ({"x": np.zeros((3, 3))}, "x"),
        ({"x": np.full(400, np.nan)}, "x"),
        ({"x": np.linspace(1, 0, 400)}, "increasing positions"),
        ({"heights": np.full(400, np.inf)}, "finite heights"),
        ({"heights": np.zeros(400)}, "heights that vary"),
        ({"period": 1.0}, "period = 1: needs 0 < period <= "),
        ({"period": -1.0}, "period = -1"),
        ({"harmonics": 0}, "harmonics = 0"),
        ({"harmonics": 200}, "harmonics = 200: needs harmonics <= 198, of 400"),
        ({"harmonics": 30}, "harmonics = 30: needs harmonics <= 26 at"),
    ],
)
def test_wrong_traces_are_named(change, message):
    x, heights = trace()
    with pytest.raises(ValueError, match=message):
        from_heights(**{"x": x, "heights": heights, **change})


def phase_map():
    path = DATA / "grooved_surface_phase_map.txt"
    if not path.exists():
        pytest.skip("no measured surfaces here")
    heights = 2.91818e-8 * np.loadtxt(path, skiprows=4)
    return 3.69862e-7 * np.arange(heights.shape[1]), heights


@pytest.mark.filterwarnings("ignore::frictionjax.profiles.SlopesUndetermined")
def test_a_measured_groove():
    x, heights = phase_map()
    assert heights.shape == (305, 75)
    whole = from_heights(x, heights.mean(axis=0), harmonics=8)
    assert 8.5e-6 < whole.period < 10e-6
    assert whole.explained > 0.9
    found = fx.friction(whole.profile, fx.bristles.Homothetic(1.0))
    assert -found.omega_minus > 1.2 * found.omega_plus  # not symmetric, as one sees
    rows = [from_heights(x, row, harmonics=4).period for row in heights[::20]]
    assert np.max(np.abs(np.array(rows) / whole.period - 1)) < 0.1


@pytest.mark.filterwarnings("ignore::frictionjax.profiles.SlopesUndetermined")
def test_a_measured_flat_surface_has_no_groove():
    path = DATA / "stylus_line_scan.txt"
    if not path.exists():
        pytest.skip("no measured surfaces here")
    x, heights = np.loadtxt(path).T
    fit = from_heights(x[::4], heights[::4], harmonics=4)
    assert fit.period > np.ptp(x) / 2  # waviness as long as the trace
