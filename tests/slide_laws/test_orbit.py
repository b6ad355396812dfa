"""Periodic orbits of a slide against a general solver."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from slides import RHO, sine, wells

from frictionjax.slide_laws.orbit import periodic_orbit


@pytest.mark.parametrize(("drop", "drag"), [(1e-2, 1e-2), (2e-3, 3e-2), (5e-3, 5e-4)])
def test_orbits_agree_with_a_general_solver(drop, drag):
    found = periodic_orbit(wells(sine), np.array(drop), np.array(drag))

    def rate(y, f):
        return drop * (drag / (f + RHO - sine(y)) - 1)

    def period(start):
        options = {"method": "Radau", "rtol": 1e-9, "atol": 1e-12, "dense_output": True}
        return solve_ivp(rate, (-0.5, 0.5), [start], **options)

    near = float(found.mean) + np.array([-1, 1]) * (drop + 0.1 * float(found.mean))
    start = brentq(lambda f: period(f).y[0, -1] - f, *near, rtol=1e-6)
    states = period(start).sol(np.linspace(-0.5, 0.5, 20001))[0]
    for value, exact in zip(
        found, (states.max(), states.min(), states.mean()), strict=True
    ):
        assert value == pytest.approx(exact, abs=2e-3 * abs(states).max())
