"""Inverse design: `fit_profile` against SciPy and other optax optimisers, and gradients.

    python benchmarks/design.py [--slow]

8 starts, 16 harmonics, one bristle. SciPy minimises the same bending energy from the same
random starts under the same rows (512 slopes a period within the range, the two ends held,
|w''| bounded where it is), with exact derivatives; its rows are linear and its places of
the extrema those that ours takes. `energy`: over the best known, that of a least-distance
solver (Lawson and Hanson) on 1501 rows; `violation`: of the range of slopes, between the
rows too. Warm, median of repeats; compilation apart.
`--slow`: trust-constr too, 90 s a start.
"""

import sys
import time

import jax
import jax.numpy as jnp
import numpy as np
import optax
from clock import timed
from scipy.optimize import Bounds, LinearConstraint, minimize, nnls

import frictionjax as fx
from frictionjax.design.surface.barrier.constraints import (
    FitShape,
    basis,
    waves_of_heights,
)
from frictionjax.design.surface.barrier.extreme_slopes import reach
from frictionjax.design.surface.barrier.iterates import (
    barrier_of,
    follow_barrier,
    stop_before_walls,
)
from frictionjax.design.surface.fit import surface_problem
from frictionjax.design.surface.starts import random_start

jax.config.update("jax_enable_x64", True)

HARMONICS, STARTS, REPEATS = 16, 8, 5
LEAST = 4.0  # seconds of rounds: five of 40 ms say little on a shared machine
HOMOTHETIC = fx.bristles.Homothetic(1.0)
CASES = {
    "ratio 1.5": (0.3, 0.2, None),
    "ratio 3": (0.3, 0.1, None),
    "ratio 8": (0.8, 0.1, None),
    "ratio 3, |w''| <= 2": (0.3, 0.1, 0.5),
}


def least_distance(plus, minus, bend):
    """Best known energy: even series, rows far denser than anyone's."""
    n, y = np.arange(1, HARMONICS + 1), np.linspace(0, 0.5, 1501)
    rows = np.sqrt(2) / (2 * np.pi * n) * np.cos(2 * np.pi * np.outer(y, n))
    blocks = [rows[:1], -rows[:1], rows, -rows, -rows[-1:]]
    ends = [[plus], [-plus], np.full(y.size, -minus), np.full(y.size, -plus), [minus]]
    if bend is not None:
        curved = np.sqrt(2) * np.sin(2 * np.pi * np.outer(y, n))
        blocks += [curved, -curved]
        ends += [np.full(y.size, -1 / bend)] * 2
    stacked = np.concatenate([np.concatenate(blocks).T, np.concatenate(ends)[None]])
    aim = np.zeros(HARMONICS + 1)
    aim[-1] = 1.0
    found, _ = nnls(stacked, aim, maxiter=100 * stacked.shape[1])
    left = stacked @ found - aim
    return float(np.sum((left[:-1] / left[-1]) ** 2))


class Rows:
    """The program of a case in SciPy's words: low <= A x <= high, energy |x|^2."""

    def __init__(self, plus, minus, bend):
        points = FitShape(HARMONICS, False, False, 0).points
        slopes = basis(HARMONICS, points)
        low, high = np.full(points, -minus), np.full(points, plus)
        low[0], high[points // 2] = plus, -minus
        self.rows, self.low, self.high = [slopes], [low], [high]
        if bend is not None:
            self.rows.append(basis(HARMONICS, points, 1))
            self.low.append(np.full(points, -1 / bend))
            self.high.append(np.full(points, 1 / bend))
        self.rows, self.low, self.high = map(
            np.concatenate, (self.rows, self.low, self.high)
        )
        self.scale = plus * minus * 16


def by_slsqp(problem, first):
    fixed = problem.low == problem.high
    held, inside = problem.rows[fixed], problem.rows[~fixed]
    both = np.concatenate([inside, -inside])
    ends = np.concatenate([problem.low[~fixed], -problem.high[~fixed]])
    constraints = [
        {"type": "ineq", "fun": lambda x: both @ x - ends, "jac": lambda x: both},
    ]
    # Ends with low = high at 0 and 1/2: v(0) = plus and v(1/2) = -minus.
    if held.size:
        constraints += [
            {
                "type": "eq",
                "fun": lambda x: held @ x - problem.low[fixed],
                "jac": lambda x: held,
            }
        ]
    options = {"maxiter": 300, "ftol": 1e-10}
    return minimize(
        lambda x: (x @ x / problem.scale, 2 * x / problem.scale),
        first,
        jac=True,
        method="SLSQP",
        constraints=constraints,
        options=options,
    )


def by_trust_constr(problem, first):
    hessian = 2 * np.eye(first.size) / problem.scale
    return minimize(
        lambda x: (x @ x / problem.scale, 2 * x / problem.scale),
        first,
        jac=True,
        hess=lambda x: hessian,
        method="trust-constr",
        bounds=Bounds(),
        constraints=[LinearConstraint(problem.rows, problem.low, problem.high)],
        options={"maxiter": 500, "gtol": 1e-8, "xtol": 1e-10, "barrier_tol": 1e-8},
    )


def quality(waves, plus, minus, best):
    """Energy over the best, and how far the extreme slopes are from those wanted."""
    found = reach(jnp.asarray(waves))
    gap = max(abs(float(found.plus) - plus), abs(float(found.minus) - minus))
    return float(waves @ waves) / best, gap / (plus + minus)


def row(name, seconds, ratio, energy, violation, note=""):
    numbers = f"{seconds:.3g} | {ratio:.3g} | {energy:.6f} | {violation:.1e}"
    print(f"| {name} | {numbers} | {note} |", flush=True)


def starts_of(problem):
    """The same random surfaces for everybody."""
    keys = jax.random.split(jax.random.PRNGKey(0), STARTS)
    none = jnp.zeros((STARTS, 0))
    make = jax.vmap(
        lambda key, none: random_start(problem.layout, problem.task, key, none, none)
    )
    return make(keys, none)


def quasi_newton(task_of, first, steps=2000):
    """L-BFGS on the barriers of the library, from the same starts."""
    layout, task = task_of.layout, task_of.task
    backtracking = optax.scale_by_backtracking_linesearch(
        40, decrease_factor=0.5, increase_factor=jnp.inf, max_learning_rate=1.0
    )
    chain = optax.chain(
        optax.scale_by_lbfgs(memory_size=20),
        optax.scale(-1.0),
        stop_before_walls(),
        backtracking,
    )
    half = jnp.asarray(0.5)

    @jax.jit
    def program(first):
        def one(first):
            last = barrier_of(layout, task, half, first)
            final, path = follow_barrier(last, first, steps, steps, chain)
            return task.slope * layout.split(final).waves, path.steps

        return jax.vmap(one)(first)

    return lambda: program(first)


def augmented_lagrangian(rows, first, rounds=30, steps=60):
    """optax.lbfgs on the augmented Lagrangian of the rows."""
    matrix, low, high = (jnp.asarray(v) for v in (rows.rows, rows.low, rows.high))
    optimise, stiff = optax.lbfgs(memory_size=20), 30.0 / rows.scale

    def lagrangian(x, above, below, price):
        value = matrix @ x
        over = jnp.maximum(0, above + price * (value - high))
        under = jnp.maximum(0, below + price * (low - value))
        return x @ x / rows.scale + 0.5 * jnp.sum(over**2 + under**2) / price

    def one(x):
        def one_round(state, _):
            x, above, below, price = state

            def fn(x):
                return lagrangian(x, above, below, price)

            graded = optax.value_and_grad_from_state(fn)

            def step(state, _):
                x, memory = state
                value, slope = graded(x, state=memory)
                change, memory = optimise.update(
                    slope, memory, x, value=value, grad=slope, value_fn=fn
                )
                return (x + change, memory), None

            (x, _), _ = jax.lax.scan(step, (x, optimise.init(x)), None, steps)
            value = matrix @ x
            above = jnp.maximum(0, above + price * (value - high))
            below = jnp.maximum(0, below + price * (low - value))
            return (x, above, below, jnp.minimum(2 * price, 1e4 * stiff)), None

        zero = jnp.zeros_like(low)
        final, _ = jax.lax.scan(one_round, (x, zero, zero, stiff), None, rounds)
        return final[0]

    program = jax.jit(jax.vmap(one))
    return lambda: program(first)


def compare(name, plus, minus, radius, slow):
    print(f"\n### {name}\n")
    print("| method | seconds, 8 starts | over ours | energy | violation | note |")
    print("|---|---|---|---|---|---|")
    best = least_distance(plus, minus, radius)
    target = fx.Target(HOMOTHETIC, plus, -minus)
    cold, ours, fit = timed(lambda: fx.fit_profile(target, smallest_radius=radius), REPEATS)
    waves = np.asarray(waves_of_heights(fit.profile.cos, fit.profile.sin))
    proof = f"{max(s.steps for s in fit.starts)} steps; first call {cold:.1f} s"
    proof += f"; proven within {fit.bending_energy / fit.bending_bound - 1:.1e}"
    row("fit_profile", ours, 1.0, *quality(waves, plus, minus, best), note=proof)
    problem = surface_problem([target], radius=radius)
    first, slope = starts_of(problem), float(problem.task.slope)
    cold, seconds, (found, steps) = timed(quasi_newton(problem, first), 1)
    note = f"{int(jnp.max(steps))} steps; compilation {cold - seconds:.1f} s"
    chosen = np.asarray(found[0])
    row(
        "L-BFGS, same barriers",
        seconds,
        seconds / ours,
        *quality(chosen, plus, minus, best),
        note=note,
    )
    rows, begin = Rows(plus, minus, radius), slope * np.asarray(first.waves)
    cold, seconds, found = timed(augmented_lagrangian(rows, jnp.asarray(begin)), 1)
    note = f"1800 steps; compilation {cold - seconds:.1f} s"
    row(
        "optax.lbfgs, augmented Lagrangian",
        seconds,
        seconds / ours,
        *quality(np.asarray(found[0]), plus, minus, best),
        note=note,
    )
    peers = [("SciPy SLSQP", by_slsqp, STARTS)]
    if slow:
        peers.append(("SciPy trust-constr", by_trust_constr, 1))
    for label, solve, count in peers:
        ends, seconds, ratio = beside(
            lambda: fx.fit_profile(target, smallest_radius=radius),
            lambda solve=solve, count=count: [solve(rows, begin[i]) for i in range(count)],
            REPEATS if count == STARTS else 1,
        )
        seconds, ratio = seconds * STARTS / count, ratio * STARTS / count
        note = f"{ends[0].nit} iterations"
        note += "" if count == STARTS else f"; {count} start measured, times {STARTS}"
        note += "" if ends[0].success or ends[0].status in (1, 2) else "; not converged"
        row(label, seconds, ratio, *quality(ends[0].x, plus, minus, best), note=note)


def beside(ours, peer, rounds):
    """What the peer found, its median seconds and the median of its ratios to ours.

    One after the other in each round: the speed of the machine changes within a run.
    More than `rounds` of them where all take less than `LEAST` seconds.
    """
    clocks, found = [], None
    while len(clocks) < rounds or np.sum(clocks) < LEAST:
        start = time.perf_counter()
        ours()
        middle = time.perf_counter()
        found = peer()
        clocks.append((middle - start, time.perf_counter() - middle))
    own, other = np.transpose(clocks)
    return found, float(np.median(other)), float(np.median(other / own))


def differences(fn, x, way, step):
    """Central differences of order 4 along a direction."""
    ends = [fn(x + s * step * way) for s in (1, -1, 2, -2)]
    return (8 * (ends[0] - ends[1]) - (ends[2] - ends[3])) / (12 * step)


def gradients():
    """Largest relative error of each gradient against central differences."""
    print("\n### Gradients\n\n| gradient | relative error |\n|---|---|")
    bristle = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
    rng = np.random.default_rng(0)
    target = fx.Target(bristle, 0.15, -0.1)
    free = {"free": ["angle", "stiffness"]}
    free["bounds"] = {"angle": (0.1, 0.9), "stiffness": (0.5, 2.0)}
    fit = fx.fit_profile(target, starts=2, **free)
    cos, sin = np.asarray(fit.profile.cos), np.asarray(fit.profile.sin)
    numbers = np.array([fit.free["angle"], fit.free["stiffness"]])
    wide = np.array([0.8, 1.5])

    def log_rho(x):
        part = fx.bristles.SlantedSpring(x[33], 2.4, 1.0, x[32])
        found = fx.friction(fx.profiles.Fourier(x[:16], x[16:32]), part)
        return np.log(np.abs([float(found.rho_plus), float(found.rho_minus)]))

    x = np.concatenate([cos, sin, numbers])
    known = fit.identifiability.sensitivities / np.concatenate([np.ones(32), wide])
    worst = 0.0
    for _ in range(10):
        way = rng.normal(size=34) * np.concatenate(
            [0.02 / np.arange(1, 17) ** 2] * 2 + [wide]
        )
        slope = differences(log_rho, x, way, 1e-6)
        worst = max(worst, float(np.max(np.abs(known @ way / slope - 1))))
    print(f"| sensitivities of log rho to surface and bristle | {worst:.1e} |")
    problem = surface_problem([target], radius=0.2, amplitude=0.1, **free)
    share = jnp.array([0.4, 0.6])
    key = jax.random.PRNGKey(3)
    first = random_start(problem.layout, problem.task, key, share, share)
    barrier = barrier_of(problem.layout, problem.task, jnp.asarray(0.5), first)
    barrier = barrier._replace(weight=jnp.asarray(0.1))
    x = np.concatenate([np.ravel(part) for part in first])
    value, slope = jax.jit(barrier.value), jax.jit(jax.grad(barrier.value))
    hessian = np.asarray(jax.jit(barrier.hessian)(x))
    errors = [[], []]
    for _ in range(10):
        way = rng.normal(size=x.size) * np.minimum(np.abs(x), 0.05)
        along = differences(value, x, way, 1e-5)
        errors[0].append(abs(float(slope(x) @ way) / float(along) - 1))
        along = np.asarray(differences(slope, x, way, 1e-5))
        errors[1].append(np.max(np.abs(hessian @ way - along)) / np.max(np.abs(along)))
    print(f"| objective of the barrier | {max(errors[0]):.1e} |")
    print(f"| its Hessian | {max(errors[1]):.1e} |")


if __name__ == "__main__":
    for case, numbers in CASES.items():
        compare(case, *numbers, slow="--slow" in sys.argv)
    gradients()
