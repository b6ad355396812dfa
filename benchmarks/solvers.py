"""Time and error reached of several solvers on the benchmark scene, side by side.

    python benchmarks/solvers.py [--eps 1e-2] [--gamma 1.0]

Error: max over 61 times, those inside a slip left out, in units of eps, against SciPy's
LSODA at tolerance 1e-11 with steps no longer than a slip. Compilation is timed apart.
"""

import argparse
import math
import time

import jax
import numpy as np
from scipy.integrate import solve_ivp

jax.config.update("jax_enable_x64", True)

import frictionjax as fx  # noqa: E402

AMPLITUDE, PERIOD, SLOPE = 1.0488, 3.0, 0.1
TIMES = np.linspace(0.0, PERIOD, 61)
TWO_PI = 2 * math.pi
ACCURACIES = (1e-2, 1e-3, 1e-4)


def scene() -> fx.Scene:
    return fx.Scene(
        fx.profiles.Sine(SLOPE),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Sine(AMPLITUDE, PERIOD),
        PERIOD,
    )


def rates(eps: float, gamma: float):
    """The same equation in plain Python."""
    drag = eps ** (1 + gamma)

    def fn(t, y):
        phase = TWO_PI * y[0]
        normal = 1 + eps * SLOPE / TWO_PI * math.sin(phase)
        load = AMPLITUDE * math.sin(TWO_PI * t / PERIOD)
        return [(load - eps * y[0] - SLOPE * math.cos(phase) * normal) / drag]

    return fn


def reference(eps: float, gamma: float, times: np.ndarray) -> np.ndarray:
    longest = 4 * eps ** (1 + gamma) / SLOPE
    options = {"rtol": 1e-11, "atol": 1e-11, "max_step": longest}
    found = solve_ivp(
        rates(eps, gamma), (0, PERIOD), [0.0], "LSODA", t_eval=times, **options
    )
    return eps * found.y[0]


def outside_slips(eps: float, gamma: float) -> tuple[np.ndarray, np.ndarray]:
    """Reference states at TIMES, and which of those are not inside a slip."""
    shift = 0.005 * eps / (AMPLITUDE * TWO_PI / PERIOD)
    around = [np.clip(TIMES + s, 0, PERIOD) for s in (-shift, 0.0, shift)]
    every = np.unique(np.concatenate(around))
    z = dict(zip(every, reference(eps, gamma, every), strict=True))
    before, now, after = (np.array([z[t] for t in times]) for times in around)
    return now, np.abs(after - before) <= 0.05 * eps


def timed(run) -> tuple[float, float, np.ndarray]:
    """Seconds of the first call beyond the later ones, median of three later, result."""
    seconds = []
    for _ in range(4):
        start = time.perf_counter()
        z = np.asarray(jax.block_until_ready(run()))
        seconds.append(time.perf_counter() - start)
    warm = float(np.median(seconds[1:]))
    return seconds[0] - warm, warm, z


def jax_solvers(eps: float, gamma: float):
    one = scene()
    for method in ("resolved", "Kvaerno3", "Kvaerno5"):
        for accuracy in ACCURACIES:
            yield (
                f"frictionjax {method}, accuracy {accuracy:g}",
                lambda m=method, a=accuracy: (
                    fx.solve(one, eps, gamma, TIMES, a, m, dissipation=False).z
                ),
            )


def scipy_solvers(eps: float, gamma: float):
    for method in ("LSODA", "BDF", "Radau"):
        for tolerance in (1e-4, 1e-6):
            yield (
                f"SciPy {method}, tolerance {tolerance:g}",
                lambda m=method, a=tolerance: (
                    eps
                    * solve_ivp(
                        rates(eps, gamma),
                        (0, PERIOD),
                        [0.0],
                        m,
                        t_eval=TIMES,
                        rtol=1e-13 if m == "LSODA" else 1e-12,
                        atol=a,
                    ).y[0]
                ),
            )


def cvode(eps: float, gamma: float):
    """CVODE's BDF through scikit-sundae, where it is installed."""
    try:
        from sksundae.cvode import CVODE
    except ImportError:
        return
    fn = rates(eps, gamma)

    def right_hand_side(t, y, yp):
        yp[:] = fn(t, y)

    for tolerance in (1e-4, 1e-6):
        solver = CVODE(right_hand_side, rtol=1e-13, atol=tolerance, max_num_steps=10**9)
        yield (
            f"CVODE BDF, tolerance {tolerance:g}",
            lambda s=solver: eps * s.solve(TIMES, np.zeros(1)).y[:, 0],
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--eps", type=float, default=1e-2)
    parser.add_argument("--gamma", type=float, default=1.0)
    arguments = parser.parse_args()
    eps, gamma = arguments.eps, arguments.gamma
    truth, counted = outside_slips(eps, gamma)
    print(f"eps = {eps:g}, gamma = {gamma:g}, {counted.sum()} of 61 times counted")
    print(f"{'method':44s} {'error/eps':>10s} {'run s':>9s} {'compile s':>10s}")
    peers = [*scipy_solvers(eps, gamma), *cvode(eps, gamma)]
    for name, run in [*jax_solvers(eps, gamma), *peers]:
        compile_time, warm, z = timed(run)
        error = np.abs(z - truth)[counted].max() / eps
        shown = compile_time if name.startswith("frictionjax") else 0.0
        print(f"{name:44s} {error:10.1e} {warm:9.4f} {shown:10.2f}", flush=True)


if __name__ == "__main__":
    main()
