"""Instants as near to slips as count: there an error in time weighs most."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.cost.instants import Instants

EPS = 9.7e-4
SPEED = 2.0  # m/s, about, at the instants
STARTS, SHARES = np.array([0.2, 1.4, 2.9]), np.linspace(0.0, 1.2, 241)
SLIDES = (STARTS[:, None] + SHARES * EPS / SPEED).ravel()  # one slip each, and more
SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
    fx.supports.Spring(1.0),
    fx.loads.Sine(1.0488, 3.0),
    3.0,
)


def states(ts, gamma, accuracy, method):
    return fx.sweep(SCENE, EPS, gamma, ts, accuracy, method).z.values[:, 0]


@pytest.mark.slow
def test_errors_stay_below_the_accuracy_up_to_the_slip():
    gamma, accuracy = np.array([0.75, 0.85]), 1e-6
    shift = np.full(SLIDES.size, 0.005 * EPS / SPEED)
    when = Instants(SLIDES, np.arange(SLIDES.size), np.zeros(0), shift)
    ts, back = when.around(3.0)
    truth = states(ts, gamma, 1e-8, "resolved")[:, back]
    counted = ~when.in_slip(truth, EPS, 3.0)
    moved = np.abs(truth[:, 2] - truth[:, 0]) / EPS
    assert np.all(np.max(np.where(counted, moved, 0), axis=1) > 0.03)  # some are that near
    found = states(ts, gamma, accuracy, "auto")[:, back[1]]
    off = np.where(counted, np.abs(found - truth[:, 1]), 0).max(axis=1)
    assert np.all(off < 0.8 * accuracy * EPS)


def test_a_step_whose_error_seems_to_vanish_does_not_bring_a_slip_forward():
    """At 2.7 s the next slip is 0.7% of a period away: it came 0.4% of one early."""
    profile = fx.profiles.Fourier([0.004, -0.002, 0.0, 0.0005], [0.008, 0.003, -0.001, 0.0])
    scene = fx.Scene(
        profile,
        fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.6),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0488, 3.0),
        3.0,
    )
    eps, gamma, accuracy, ts = 9.7e-7, 0.75, 1e-3, [2.7, 3.0]
    truth, found = (fx.solve(scene, eps, gamma, ts, a).z[0] for a in (1e-8, accuracy))
    assert abs(found - truth) < 0.1 * accuracy * eps
