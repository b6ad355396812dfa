"""Reference states, and which times are not inside a slip."""

from collections.abc import Callable

import numpy as np
from scenes import FASTEST, PERIOD, TIMES, numba_field, start, state

ACCURACY = 1e-3  # of the benchmarks, in units of eps


def outside_slips(states: Callable[[np.ndarray], np.ndarray], eps: float):
    """States at TIMES, and where they move by less than 0.05 eps in 0.01 eps of load."""
    shift = 0.005 * eps / FASTEST
    around = np.clip(np.stack([TIMES - shift, TIMES, TIMES + shift]), 0, PERIOD)
    every, place = np.unique(around, return_inverse=True)
    before, now, after = states(every)[place.reshape(3, -1)]
    return now, np.abs(after - before) <= 0.05 * eps


def own(one, eps: float, gamma: float, accuracy: float = 1e-6):
    """From our own method on the scene `one`; a peer that agrees with it confirms it."""
    from frictionjax.wiggly.batch import integrate_cells

    cell = np.array([eps]), np.array([gamma])

    def states(ts):
        found = integrate_cells(one, *cell, ts, accuracy, "auto", balanced=False)
        return found.z[0]

    return outside_slips(states, eps)


def independent(name: str, eps: float, gamma: float):
    """From SciPy's LSODA at tolerance 1e-11 with steps no longer than a slip."""
    from scipy.integrate import solve_ivp

    field, drag = numba_field(name), eps ** (1 + gamma)
    options = {"rtol": 1e-11, "atol": 1e-11, "max_step": 40 * drag}

    def states(ts):
        found = solve_ivp(
            lambda t, y: (field(t, y[0], eps, drag),),
            (0.0, PERIOD),
            [start(name, eps)],
            "LSODA",
            t_eval=ts,
            **options,
        )
        return state(name, found.y[0], eps)

    return outside_slips(states, eps)


def error_of(z: np.ndarray, truth: tuple[np.ndarray, np.ndarray], eps: float) -> float:
    """Largest error in units of eps outside slips."""
    now, counted = truth
    return float(np.abs(z - now)[counted].max() / eps)
