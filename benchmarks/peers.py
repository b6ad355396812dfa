"""The peers of a sweep: each makes a function that solves one cell, states at 61 times.

A maker is called as `PEERS[name](scene, eps, gamma, tolerance)` and returns the run, how
many equal lanes it solves at once, and the seconds that compilation took (what was
compiled for an earlier cell is kept). Tolerances are absolute, in
periods: relative ones would loosen as 1/eps.
"""

import importlib.util
import time
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
from scenes import PERIOD, TIMES, heyoka_field, jax_field, numba_field, start, state

_RELATIVE = 1e-12  # where a solver wants one; LSODA and CVODE take no smaller one


class Run(NamedTuple):
    """A cell ready to be solved: `solve()` gives z at TIMES in m, NaN where it failed."""

    solve: Callable[[], np.ndarray]
    lanes: int
    compiled: float


class GaveUpError(RuntimeError):
    """A solver that says itself that it failed."""


def _timed(build):
    start = time.perf_counter()
    built = build()
    return built, time.perf_counter() - start


@cache
def _taylor(scene: str, tolerance: float):
    import heyoka as hy

    width = hy.recommended_simd_size()
    start = np.zeros((1, width))
    pars = np.ones((2, width))
    return hy.taylor_adaptive_batch(
        [heyoka_field(scene)], start, pars=pars, tol=tolerance
    ), width


def heyoka(scene: str, eps: float, gamma: float, tolerance: float) -> Run:
    """Taylor series in a batch of as many equal lanes as the processor has."""
    (lanes, width), compiled = _timed(lambda: _taylor(scene, tolerance))
    grid = np.repeat(TIMES[:, None], width, axis=1)

    def solve():
        lanes.set_time(0.0)
        lanes.state[:] = start(scene, eps)
        lanes.pars[0], lanes.pars[1] = eps, eps ** -(1 + gamma)
        _, values = lanes.propagate_grid(grid)
        return values[:, 0, 0]

    return Run(lambda: state(scene, solve(), eps), width, compiled)


@cache
def _lsoda(scene: str):
    from numba import cfunc, njit
    from numbalsoda import lsoda, lsoda_sig

    field = numba_field(scene)

    @cfunc(lsoda_sig)
    def rate(t, y, dy, p):
        dy[0] = field(t, y[0], p[0], p[1])

    address = rate.address

    @njit
    def solve(start, times, numbers, tolerance):
        return lsoda(address, start, times, numbers, 1e-13, tolerance, 10**9)

    solve(np.zeros(1), TIMES[:3], np.array([0.1, 1.0]), 1e-3)
    return solve, rate  # the callback must live as long


def numbalsoda(scene: str, eps: float, gamma: float, tolerance: float) -> Run:
    """LSODA with a compiled field."""
    _, compiled = _timed(lambda: _lsoda(scene))
    return Run(lambda: lsoda_states(scene, eps, gamma, tolerance, TIMES), 1, compiled)


def lsoda_states(scene: str, eps: float, gamma: float, tolerance: float, ts: np.ndarray):
    """z in m at any times by numbalsoda's LSODA, through every slip."""
    solve, _ = _lsoda(scene)
    numbers = np.array([eps, eps ** (1 + gamma)])
    y, success = solve(np.array([start(scene, eps)]), ts, numbers, tolerance)
    if not success:
        raise GaveUpError("success = False")
    return state(scene, y[:, 0], eps)


def _scipy(method: str):
    def make(scene: str, eps: float, gamma: float, tolerance: float) -> Run:
        from scipy.integrate import solve_ivp

        field, compiled = _compiled_field(scene)
        drag, begin = eps ** (1 + gamma), start(scene, eps)

        def states():
            found = solve_ivp(
                lambda t, y: (field(t, y[0], eps, drag),),
                (0.0, PERIOD),
                [begin],
                method,
                t_eval=TIMES,
                rtol=_RELATIVE,
                atol=tolerance,
            )
            if not found.success:
                raise GaveUpError(found.message)
            return state(scene, found.y[0], eps)

        return Run(states, 1, compiled)

    return make


def cvode(scene: str, eps: float, gamma: float, tolerance: float) -> Run:
    """CVODE's BDF through scikit-sundae, compiled field called from Python."""
    from sksundae.cvode import CVODE

    field, compiled = _compiled_field(scene)
    drag = eps ** (1 + gamma)

    def right_hand_side(t, y, yp):
        yp[0] = field(t, y[0], eps, drag)

    begin = np.array([start(scene, eps)])
    solver = CVODE(right_hand_side, rtol=_RELATIVE, atol=tolerance, max_num_steps=10**9)

    def states():
        found = solver.solve(TIMES, begin)
        if not found.success:
            raise GaveUpError(found.message)
        return state(scene, found.y[:, 0], eps)

    return Run(states, 1, compiled)


def _compiled_field(scene: str):
    field = numba_field(scene)
    _, compiled = _timed(lambda: field(0.0, 0.0, 0.1, 1.0))
    return field, compiled


_VMAP = 16  # lanes


@cache
def _diffrax(method: str, scene: str):
    import diffrax
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)
    term = diffrax.ODETerm(jax_field(scene))

    @jax.jit
    @jax.vmap
    def solve(y, eps, drag, tolerance):
        found = diffrax.diffeqsolve(
            term,
            getattr(diffrax, method)(),
            0.0,
            PERIOD,
            None,
            y,
            (eps, drag),
            saveat=diffrax.SaveAt(ts=TIMES),
            stepsize_controller=diffrax.PIDController(rtol=_RELATIVE, atol=tolerance),
            max_steps=2**30,
            throw=False,
        )
        failed = found.result != diffrax.RESULTS.successful
        return jnp.where(failed, jnp.nan, found.ys)

    ones = np.ones(_VMAP)
    return solve.lower(ones, ones, ones, ones).compile()


def _kvaerno(method: str):
    def make(scene: str, eps: float, gamma: float, tolerance: float) -> Run:
        solve, compiled = _timed(lambda: _diffrax(method, scene))
        ones = np.ones(_VMAP)

        def states():
            numbers = start(scene, eps), eps, eps ** (1 + gamma), tolerance
            y = solve(*(number * ones for number in numbers))
            return state(scene, np.asarray(y)[0], eps)

        return Run(states, _VMAP, compiled)

    return make


PEERS = {
    "heyoka": heyoka,
    "numbalsoda": numbalsoda,
    "CVODE": cvode,
    "LSODA": _scipy("LSODA"),
    "BDF": _scipy("BDF"),
    "Radau": _scipy("Radau"),
    "Kvaerno3": _kvaerno("Kvaerno3"),
    "Kvaerno5": _kvaerno("Kvaerno5"),
}
COMPILED = ("heyoka", "numbalsoda")
_NEEDS = {"CVODE": "sksundae", "heyoka": "heyoka", "numbalsoda": "numbalsoda"}


def installed() -> list[str]:
    """Peers that can be imported; numbalsoda needs a Fortran compiler to install."""
    return [n for n in PEERS if n not in _NEEDS or importlib.util.find_spec(_NEEDS[n])]
