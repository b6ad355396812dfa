import numpy as np
import pytest
from noisy_wells import COSINE, EPS, SLANTED, cosine_energy

import frictionjax as fx
from frictionjax.stochastic.boltzmann import AtRest, boltzmann_shares, energies_at_rest
from frictionjax.stochastic.potential_samples import sampled_potential

SPRING = fx.supports.Spring(1.0)


def rest(potential=COSINE, support=SPRING, load=0.0, temperature=2e-4, eps=EPS):
    return AtRest(potential, support, load, eps, temperature)


def moment(shares, edges, power):
    return np.sum(shares * (0.5 * (edges[1:] + edges[:-1])) ** power)


def test_moments_are_the_known_ones():
    """Computed apart from the library; the middles of bins are off by width^2/12."""
    edges = np.linspace(-0.1, 0.1, 20001)
    shares = boltzmann_shares(rest(), edges).shares
    assert moment(shares, edges, 2) == pytest.approx(2.889234275e-5, rel=1e-6)
    cosine = np.cos(2 * np.pi * 0.5 * (edges[1:] + edges[:-1]) / EPS)
    assert np.sum(shares * cosine) == pytest.approx(0.944623722903, rel=1e-6)


@pytest.mark.parametrize("temperature", [1e-5, 2e-4, 1e-2])
@pytest.mark.parametrize("load", [0.0, 0.13])
def test_shares_are_those_of_a_fine_sum(temperature, load):
    z = load + np.linspace(-1.0, 1.0, 2_000_001)
    energy = cosine_energy(z) - load * z
    weights = np.exp((energy.min() - energy) / temperature)
    edges = load + np.array([-0.31, -0.06, 0.0, 0.02, 0.07, 0.4])
    sums = np.interp(edges, z, np.cumsum(weights) - 0.5 * weights)
    found = boltzmann_shares(rest(load=load, temperature=temperature), edges)
    assert found.shares == pytest.approx(np.diff(sums) / np.sum(weights), abs=2e-6)
    places = np.linspace(edges[0], edges[-1], 200001)
    held = energies_at_rest(rest(load=load, temperature=temperature), places)
    density = np.exp((found.level - held) / temperature)
    assert np.trapezoid(density, places) == pytest.approx(np.sum(found.shares), abs=1e-6)


def test_bins_beyond_all_density_are_empty_and_the_rest_is_whole():
    found = boltzmann_shares(rest(), np.array([-9.0, -3.0, 3.0, 9.0]))
    assert found.shares == pytest.approx([0, 1, 0], abs=1e-12)


def test_supports_that_are_no_spring_and_bristles_that_lean():
    wall = fx.supports.Convex(lambda z: 0.5 * z**2 + 5 * z**4)
    bath = rest(SLANTED, wall, load=0.3, temperature=5e-3, eps=0.05)
    z = np.linspace(-1.5, 1.5, 300_001)
    wells, _ = sampled_potential(SLANTED, 0.05, z / 0.05)
    energy = 0.5 * z**2 + 5 * z**4 - 0.3 * z + wells
    weights = np.exp((energy.min() - energy) / 5e-3)
    edges = np.linspace(-0.2, 0.5, 8)
    sums = np.interp(edges, z, np.cumsum(weights) - 0.5 * weights) / np.sum(weights)
    assert boltzmann_shares(bath, edges).shares == pytest.approx(np.diff(sums), abs=1e-6)


def test_wells_that_are_too_many_are_refused():
    with pytest.raises(ValueError, match=r"eps = .*needs wells of a density"):
        boltzmann_shares(rest(temperature=1.0, eps=1e-6), np.array([0.0, 1.0]))
