"""Scenes at the smallest eps that floats allow: what rounds there may decide nothing."""

import numpy as np

import frictionjax as fx
from frictionjax.model.scene import _edges, _farthest
from frictionjax.model.settings import SETTINGS as MODEL_SETTINGS
from frictionjax.wiggly.sums.settings import SETTINGS

_KINKS = [0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 1.0, -1.0]
SMALLEST = {
    "turns on a fold": fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.Homothetic(1.0),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0, 3.0),
        3.0,
    ),
    "turns between folds": fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0488, 3.0),
        3.0,
    ),
    "two harmonics, slanted": fx.Scene(
        fx.profiles.Fourier([0.01, 0.003], [0.012, 0.0]),
        fx.bristles.SlantedSpring(1.0, 2.2, 1.0, 0.4),
        fx.supports.Spring(10.0),
        fx.loads.Triangle(1.0, 2.0),
        3.0,
    ),
    "plateau, angular": fx.Scene(
        fx.profiles.Sine(0.2),
        fx.bristles.AngularSpring(1.0, 1.5, 1.0, 0.3),
        fx.supports.Spring(1.0),
        fx.loads.PiecewiseLinear(*_KINKS),
        3.0,
    ),
    "far start": fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.Homothetic(1.0),
        fx.supports.Spring(1.0),
        fx.loads.Ramp(1.0, 5.0),
        1.0,
        5.0,
    ),
    "starts where it is unstable": fx.Scene(
        fx.profiles.Fourier([0.1 / (2 * np.pi)], [0.0]),
        fx.bristles.Homothetic(1.0),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0, 3.0),
        3.0,
    ),
}
GAMMAS = 0.75, 1.0, 1.5, 2.0
TENS = 1e-12, 1e-11, 1e-10, 1e-9


def eps_of(scene: fx.Scene, times=(1.0, 1.3, 2.0, 6.0)) -> np.ndarray:
    """From the smallest allowed, and powers of ten: folds lie at turning points there."""
    far = float(_farthest(scene.load, scene.support, _edges(scene)))
    least = 1.0001 * MODEL_SETTINGS.told_apart * far
    return np.unique([*(least * np.asarray(times)), *(e for e in TENS if e > least)])


def statuses_of(name: str, gammas=GAMMAS) -> tuple[np.ndarray, np.ndarray]:
    """Statuses, and residuals over the largest that are OK, (gamma, eps)."""
    scene = SMALLEST[name]
    ts = np.linspace(0.0, float(scene.duration), 7)
    data = fx.sweep(scene, eps_of(scene), gammas, ts)
    allowed = SETTINGS.residual * np.maximum(data.dissipation.values[..., -1], 1e-300)
    return data.status.values, data.residual.values / allowed
