"""States of tips where they do not slip, to see what an effect changes."""

import jax
import numpy as np

import frictionjax as fx


def times_about(scene, eps, count=4000):
    """Times, evenly over a scene, and half a percent of a well's time before and after.

    The time of a well is `eps Phi''/|l'|`, Phi'' that of the support at rest.
    """
    duration = float(scene.duration)
    middle = np.linspace(0.003, 0.995, count) * duration
    pull = np.abs(jax.vmap(jax.grad(scene.load))(middle))
    stiffness = float(jax.grad(scene.support.force)(0.0))
    speed = np.maximum(pull, 1e-3 * pull.max()) / stiffness
    away = np.minimum(0.005 * eps / speed, duration / 600)
    return np.maximum(middle - away, 0.0), middle, middle + away


def states_outside_slips(scene, gamma, eps, times, accuracy=1e-6, **options):
    """States at the times in between, and where they are outside of slips."""
    ts = np.sort(np.concatenate(times))
    found = fx.solve(scene, eps, gamma, ts, accuracy, dissipation=False, **options)
    before, z, after = (np.asarray(found.z)[np.searchsorted(ts, t)] for t in times)
    return z, np.maximum(np.abs(z - before), np.abs(after - z)) < 0.05 * eps
