import numpy as np
import pytest
from noisy_wells import EPS, cosine_energy

from frictionjax.stochastic.driven_period import Drive, march_period, moved_on

COUNT = 32  # cells of a period


def rises(count=COUNT):
    wells = cosine_energy(EPS * np.arange(count) / count, stiffness=0.0)
    return np.roll(wells, -1) - wells


def drive(speed, temperature=1e-4):
    return Drive(EPS, 1.0, 1.0, temperature, speed)


def places(count=COUNT):
    return EPS * (-2 + np.arange(4 * count) / count)


def after(density, speed, steps, count=COUNT, temperature=1e-4):
    return march_period(density, rises(count), -2, steps, drive(speed, temperature))


def test_a_density_under_a_slow_support_is_boltzmanns_on_any_grid():
    """Though a cell is a third of a deviation in a well."""
    end = after(np.full(4 * COUNT, 1 / 128), 1e-9, 32, temperature=4e-4)
    energy = cosine_energy(places()) - places() * EPS  # the spring's end is at eps
    weights = np.exp(-(energy - energy.min()) / 4e-4)
    assert np.asarray(end.density) == pytest.approx(weights / weights.sum(), rel=1e-5)


def test_mass_is_kept_and_densities_stay_positive():
    density = np.zeros(4 * COUNT)
    density[70] = 1.0
    end = after(density, 1e-2, 32)
    assert np.sum(end.density) == pytest.approx(1.0, abs=1e-14)
    assert np.min(end.density) > -1e-4  # the steps are implicit and of order 3
    assert float(end.leak) < 1e-13


def test_the_error_in_time_is_of_order_3():
    start = np.exp(-0.5 * ((places() + 0.05) / 0.02) ** 2)
    start /= start.sum()
    ends = [np.asarray(after(start, 0.1, steps).density) for steps in (32, 64, 512)]
    errors = [np.abs(end - ends[-1]).sum() for end in ends[:2]]
    assert 2.7 < np.log2(errors[0] / errors[1]) < 3.4


def test_a_free_spring_lags_by_its_drag():
    """Without wells the mean of z is Ornstein and Uhlenbeck's, at any temperature."""
    density = np.exp(-0.5 * (places() / 0.02) ** 2)
    start = density / density.sum()
    end = march_period(start, 0 * rises(), -2, 64, drive(0.05, 1e-3))
    time = EPS / 0.05
    mean = 0.05 * time - 0.05 * (1 - np.exp(-time))
    assert np.sum(end.density * places()) == pytest.approx(mean, abs=1e-4)


def test_a_density_moves_on_by_a_period():
    moved, gone = moved_on(np.arange(8.0), 2)
    assert gone == 1.0
    assert moved.tolist() == [2, 3, 4, 5, 6, 7, 0, 0]
