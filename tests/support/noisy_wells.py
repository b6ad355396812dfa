"""Wells of a sine and of a slanted bristle, and Boltzmann's density in them."""

import numpy as np

import frictionjax as fx
from frictionjax.supports import AbstractSupport

RHO, EPS = 0.1, 0.1
# `V_eps = -eps rho/(2 pi) cos(2 pi z/eps)`: lowest at 0.
COSINE = fx.potential(
    fx.profiles.Fourier(cos=[-RHO / (2 * np.pi)], sin=[0.0]), fx.bristles.Homothetic(1.0)
)
SLOPE, ANGLE = 0.4, 0.9
# `G = dz/dp` is between 0.5 and 1.5.
SLANTED = fx.potential(
    fx.profiles.Sine(SLOPE), fx.bristles.SlantedSpring(1.0, 2.2, 1.0, ANGLE)
)


class Free(AbstractSupport):
    """No support."""

    def energy(self, z):
        return 0.0 * z

    def state_of(self, force):
        return 0.0 * force


def cosine_energy(z, stiffness=1.0):
    """Energy in J with a spring at 0."""
    return 0.5 * stiffness * z**2 - EPS * RHO / (2 * np.pi) * np.cos(2 * np.pi * z / EPS)


def boltzmann_mean(values, energy, temperature, measure=1.0):
    """Mean of even samples with the weights `measure exp(-energy/temperature)`."""
    weights = measure * np.exp(-(energy - energy.min()) / temperature)
    return np.sum(weights * values) / np.sum(weights)


def boltzmann_samples(energy, z, temperature, count, seed=0):
    """States drawn from the density on the even grid `z`."""
    weights = np.cumsum(np.exp(-(energy - energy.min()) / temperature))
    shares = (np.arange(count) + np.random.default_rng(seed).uniform(size=count)) / count
    return np.interp(shares, weights / weights[-1], z)
