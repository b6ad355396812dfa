import numpy as np
import pytest
from noisy_wells import EPS, cosine_energy

from frictionjax.stochastic import fixed_point as module
from frictionjax.stochastic.driven_period import Drive
from frictionjax.stochastic.fixed_point import (
    Window,
    on_finer_cells,
    periodic_density,
    with_room,
)
from frictionjax.stochastic.settings import SETTINGS

COUNT = 32
WELLS = cosine_energy(EPS * np.arange(COUNT) / COUNT, stiffness=0.0)
RISES = np.roll(WELLS, -1) - WELLS
WINDOW = Window(-4, 8)
START = np.exp(-0.5 * ((-4 + np.arange(8 * COUNT) / COUNT + 1.5) / 0.3) ** 2)


def found(speed=0.1, start=START):
    return periodic_density(RISES, 32, Drive(EPS, 1.0, 1.0, 3e-4, speed), WINDOW, start)


def test_the_density_repeats_and_does_not_know_its_guess():
    one, other = found(), found(start=np.roll(START, COUNT))
    assert one.change < 1e-9
    assert one.lost < 1e-9
    assert one.density == pytest.approx(other.density, abs=1e-8)
    assert one.mean_force == pytest.approx(other.mean_force, abs=1e-9)


def test_combinations_find_what_marching_finds_in_fewer_periods(monkeypatch):
    periods = []
    march = module.march_period
    monkeypatch.setattr(
        module, "march_period", lambda *args: periods.append(1) or march(*args)
    )
    combined = found(0.15)
    few = len(periods)
    monkeypatch.setattr(module, "_combined", lambda history: history[-1][0])
    marched = found(0.15)
    assert combined.mean_force == pytest.approx(marched.mean_force, abs=1e-8)
    assert few < 0.5 * (len(periods) - few)


def test_a_density_that_does_not_become_periodic_says_so(monkeypatch):
    monkeypatch.setattr(module, "SETTINGS", SETTINGS._replace(most_periods=3))
    assert found(0.15).change > SETTINGS.periodic


def test_finer_cells_leave_out_empty_periods():
    coarse = found()
    window, guess = on_finer_cells(coarse, 2)
    assert -6 < window.first <= -3
    assert window.periods <= WINDOW.periods
    assert guess.size == 2 * COUNT * window.periods
    places = window.first + np.arange(guess.size) / (2 * COUNT)
    before = WINDOW.first + np.arange(coarse.density.size) / COUNT
    means = [
        np.sum(g * p) / np.sum(g)
        for g, p in zip((guess, coarse.density), (places, before), strict=True)
    ]
    assert means[0] == pytest.approx(means[1], abs=1e-3)


def test_windows_come_in_few_sizes():
    sizes = [with_room(-3, -3 + periods).periods for periods in (1, 4, 5, 7, 9, 13, 17)]
    assert sizes == [4, 4, 6, 8, 12, 16, 24]
