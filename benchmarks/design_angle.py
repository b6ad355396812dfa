"""Inverse design of a bristle: accuracy and speed against SciPy, gradients, the dynamics.

    python benchmarks/design_angle.py

Speed: a slanted spring on a sine, 1000 targets of the ratio. Ours finds the admissible
intervals, the reach and every solution of each target. SciPy is given a bracket that
holds the solution (brentq) or a start and bounds (SLSQP), on the same function: compiled
by the library, and written by hand in Python's floats. Warm, median of repeats.
"""

import math
import statistics
import time

import jax
import jax.numpy as jnp
import numpy as np
from clock import timed
from scipy.optimize import brentq, minimize

import frictionjax as fx
from frictionjax.design.common.quantities import Slopes, on_slopes, quantity_of

jax.config.update("jax_enable_x64", True)

SINE = fx.profiles.Sine(0.1)
SLANTED = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
REPEATS = 9
ENDS = (-1.14, 1.14)  # alpha > 0 between them


def surface(rng):
    orders = np.arange(1, 6)
    cos, sin = 0.1 * rng.normal(size=(2, 5)) / (2 * np.pi * orders**2)
    return fx.profiles.Fourier(cos, sin)


def draws(kind, rng):
    """A random bristle and one with another number, the number's name, its quantities."""
    k, every = rng.uniform(0.5, 2.0), ("rho_plus", "rho_minus", "ratio", "difference")
    side = rng.choice([-1, 1])
    if kind == "homothetic":
        rods = [fx.bristles.Homothetic(scale * side * k) for scale in (1.0, 3.0)]
        return *rods, "alpha", (*every[:2], every[3])
    if kind == "vertical":
        rest = 1 + side * rng.uniform(0.1, 0.6)
        rods = [fx.bristles.VerticalSpring(k, rest, height) for height in (1.0, 0.8)]
        return *rods, "height", (*every[:2], every[3])
    if kind == "slanted":
        angle = rng.uniform(-0.8, 0.8)
        rest = (1 + side * rng.uniform(0.1, 0.5)) / np.cos(angle)
        rods = [fx.bristles.SlantedSpring(k, rest, 1.0, a) for a in (angle, 0.5 * angle)]
        return *rods, "angle", every
    limit = rng.uniform(0.8, 1.0)
    rest, other = limit - rng.uniform(0.2, 1.2), 1.2 * limit
    length = 1 / np.cos(limit)
    heights = 1.0, length * np.cos(other)
    rods = [fx.bristles.AngularSpring(k, length, height, rest) for height in heights]
    return *rods, "angle", every


def value_of(name, law):
    plus, minus = float(law.rho_plus), float(law.rho_minus)
    values = {"rho_plus": plus, "rho_minus": minus, "ratio": -plus / minus}
    return values.get(name, plus + minus)


def accuracy():
    print("| bristle | free | targets | met | worst relative error | inadmissible |")
    print("|---|---|---|---|---|---|")
    for kind in ("homothetic", "vertical", "slanted", "angular"):
        rng, met, worst, bad = np.random.default_rng(1), 0, 0.0, 0
        for trial in range(200):
            ground = surface(rng)
            true, start, free, names = draws(kind, rng)
            name = names[trial % len(names)]
            target = value_of(name, fx.friction(ground, true))
            found = fx.fit_angle(ground, start, free=free, pulling=True, **{name: target})
            met += found.success
            try:
                got = value_of(name, fx.friction(ground, found.bristle))
            except ValueError:
                bad += 1
                continue
            worst = max(worst, abs(got / target - 1))
        print(f"| {kind} | {free} | 200 | {met} | {worst:.1e} | {bad} |", flush=True)


def by_hand(angle):
    """The ratio of `SLANTED` on `SINE`, alpha > 0, in Python's floats."""
    tangent = math.tan(angle)
    return (1 + 0.1 * tangent) / (1 - 0.1 * tangent)


def scipy_row(name, solve, targets):
    times = []
    for _ in range(3):
        before = time.perf_counter()
        found = np.array([solve(target) for target in targets])
        times.append((time.perf_counter() - before) / len(targets))
    error = max(abs(by_hand(v) / t - 1) for v, t in zip(found, targets, strict=True))
    return name, statistics.median(times), error


def speed():
    targets = np.linspace(0.65, 1.55, 1000)
    cold, warm, found = timed(
        lambda: fx.fit_angle(SINE, SLANTED, ratio=targets).value, REPEATS
    )
    _, alone, _ = timed(lambda: fx.fit_angle(SINE, SLANTED, ratio=1.3).value, REPEATS)
    error = max(abs(by_hand(float(v)) / t - 1) for v, t in zip(found, targets, strict=True))
    slopes = Slopes(jnp.asarray(0.1), jnp.asarray(-0.1))

    @jax.jit
    def compiled(angle):
        part = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, angle)
        return quantity_of(on_slopes(part, slopes), 2)

    both = jax.jit(jax.value_and_grad(lambda v, target: (compiled(v) / target - 1) ** 2))

    def objective(v, target):
        value, slope = both(v[0], target)
        return float(value), np.array([float(slope)])

    def slsqp(target):
        options = {"ftol": 1e-24, "maxiter": 200}
        return minimize(
            objective, [0.5], (target,), "SLSQP", jac=True, bounds=[ENDS], options=options
        ).x[0]

    few = targets[::10]
    rows = [
        scipy_row(
            "brentq, compiled function",
            lambda t: brentq(lambda v: float(compiled(v)) - t, *ENDS, xtol=1e-15),
            few,
        ),
        scipy_row(
            "brentq, Python floats",
            lambda t: brentq(lambda v: by_hand(v) - t, *ENDS, xtol=1e-15),
            few,
        ),
        scipy_row("SLSQP, compiled function", slsqp, few),
    ]
    each = warm / targets.size
    print("\n| method | us a solution | over ours | worst relative error |")
    print("|---|---|---|---|")
    print(f"| fit_angle, 1000 targets | {1e6 * each:.0f} | 1 | {error:.1e} |")
    print(f"| fit_angle, one target | {1e6 * alone:.0f} | {alone / each:.0f} | |")
    for name, seconds, wrong in rows:
        print(f"| {name} | {1e6 * seconds:.0f} | {seconds / each:.1f} | {wrong:.1e} |")
    print(f"first call: {cold:.1f} s; {1 / each:.0f} solutions a second", flush=True)


def central(fn, x, step):
    return (8 * (fn(x + step) - fn(x - step)) - fn(x + 2 * step) + fn(x - 2 * step)) / (
        12 * step
    )


def gradients():
    def angle(ratio):
        return fx.fit_angle(SINE, SLANTED, ratio=ratio).value

    def by_slope(slope):
        return fx.fit_angle(fx.profiles.Sine(slope), SLANTED, rho_plus=0.12).value

    def mean(slope):
        return fx.steady_slide(fx.profiles.Sine(slope), SLANTED, 1e-3).mean_plus

    def peak(angle):
        part = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, angle)
        return fx.steady_slide(SINE, part, 1e-3).peak_minus

    print("\n| derivative | implicit | central differences | relative gap |")
    print("|---|---|---|---|")
    cases = (
        ("angle by ratio", angle, 1.3, 1e-4),
        ("angle by the surface's slope", by_slope, 0.1, 1e-5),
        ("mean force by the slope", mean, 0.1, 5e-4),
        ("peak force by the angle", peak, 1.0, 5e-3),
    )
    for name, fn, x, step in cases:
        exact, near = float(jax.grad(fn)(x)), float(central(fn, x, step))
        print(f"| {name} | {exact:.9g} | {near:.9g} | {abs(exact / near - 1):.1e} |")
    exact = float(jax.grad(mean)(0.1))
    near = float(central(after_1000_slips, 0.1, 1e-3))
    gap = abs(exact / near - 1)
    print(f"| mean force, `solve` over 1000 slips | {exact:.9g} | {near:.9g} | {gap:.1e} |")


def after_1000_slips(slope):
    """Mean force of the slips 990 to 1000 of a ramp, from what `solve` dissipates."""
    eps = 1e-3
    ramp, spring = fx.loads.Ramp(1.0), fx.supports.Spring(1.0)
    scene = fx.Scene(fx.profiles.Sine(slope), SLANTED, spring, ramp, duration=1.12)
    times = 1.11 + eps * np.array([0.0, 10.0])
    found = fx.solve(scene, eps, 1.0, ts=times, accuracy=1e-6)
    assert found.ok
    return float(np.diff(found.dissipation)[0]) / (10 * eps)


def dynamics():
    print("\nDesigned for a ratio of 1.5, on the dynamics:\n")
    part = fx.fit_angle(SINE, SLANTED, ratio=1.5).bristle
    cold, warm, check = timed(lambda: fx.check_design(SINE, part), REPEATS)
    print(check)
    print(f"\n{warm:.3f} s for six slides, {cold:.1f} s the first time", flush=True)


if __name__ == "__main__":
    speed()
    dynamics()
    gradients()
    accuracy()
