"""Random surfaces whose steepest slope is known, sampled finely or coarsely, with noise."""

from typing import NamedTuple

import numpy as np

KINDS = ("smooth", "sawtooth", "trapezoid", "corners", "rounded")
COUNTS = (16, 24, 32, 48, 64, 100, 128, 256)
NOISE = (0.0, 0.0, 1e-3, 6e-3, 2e-2)  # of half the range


class Sampled(NamedTuple):
    """Heights at `x` in periods, and the steepest slope upwards of the surface itself."""

    kind: str
    x: np.ndarray
    heights: np.ndarray
    steepest: float


def sampled(rng, index, periods=1.0, counts=COUNTS):
    """A random surface over some periods; over one, its end is not repeated."""
    kind = KINDS[index % len(KINDS)]
    fn, steepest = _surface(rng, kind)
    count = int(rng.choice(counts))
    x = np.arange(int(periods * count)) / count
    heights = fn(x)
    noise = rng.choice(NOISE) * np.ptp(heights) / 2
    return Sampled(kind, x, heights + noise * rng.normal(size=x.size), steepest)


def _surface(rng, kind):
    if kind == "smooth":
        orders = np.arange(1, rng.integers(1, 7) + 1)
        waves = rng.normal(size=orders.size) + 1j * rng.normal(size=orders.size)
        return _of_waves(waves / orders ** rng.uniform(1, 2) / 30, orders)
    x, heights = _corners(rng, kind)
    xs = np.concatenate([x - 1, x, x + 1])
    ys, shift = np.tile(heights, 3), rng.uniform()
    if kind == "rounded":
        fine = np.fft.rfft(np.interp(np.arange(1024) / 1024, xs, ys)) / 512
        orders = np.arange(1, 200)
        gain = np.exp(-0.5 * (2 * np.pi * rng.uniform(0.005, 0.05) * orders) ** 2)
        return _of_waves(gain * fine[orders], orders)
    slopes = np.diff(ys) / np.diff(xs)
    return lambda y: np.interp((y + shift) % 1, xs, ys), float(slopes.max())


def _corners(rng, kind):
    if kind in ("sawtooth", "rounded"):
        side = rng.uniform(0.05, 0.4)
        return np.array([0.0, rng.choice([side, 1 - side])]), np.array([0.0, 0.05])
    if kind == "trapezoid":
        x = np.append(0.0, np.sort(rng.uniform(0.05, 0.95, size=3)))
        return x, 0.05 * np.roll([0.0, 1.0, 1.0, 0.0], rng.integers(2))
    count = rng.integers(3, 8)
    x = (np.arange(count) + rng.uniform(0.1, 0.9, count)) / count
    return x, 0.03 * rng.normal(size=count)


def _of_waves(waves, orders):
    def fn(y, order=0):
        turns = 2j * np.pi * orders
        return (np.exp(np.multiply.outer(y, turns)) @ (waves * turns**order)).real

    return fn, float(fn(np.arange(4096) / 4096, 1).max())
