"""Random bristles with free numbers in wide bounds: is every reachable target met?

`python benchmarks/design_free.py [COUNT] [SEED]`. Targets are the coefficients of another
bristle within the bounds, on a surface that it follows, so each can be reached.
"""

import sys
import time
from collections import Counter

import jax
import numpy as np

import frictionjax as fx
from frictionjax.design.common.free_numbers import free_parameter, with_arrays
from frictionjax.design.common.targets import Geometry, coefficients_of, geometry

NAMES = {
    fx.bristles.SlantedSpring: ("stiffness", "rest_length", "height", "angle"),
    fx.bristles.AngularSpring: ("stiffness", "length", "height", "rest_angle", "angle"),
}


def random_bristle(rng):
    """A slanted or an angular spring."""
    if rng.integers(2):
        height, limit = 10 ** rng.uniform(-0.5, 0.5), rng.uniform(0.1, 1.45)
        rest = rng.uniform(-1.5, limit - 0.02)
        stiffness = 10 ** rng.uniform(-1, 1)
        return fx.bristles.AngularSpring(stiffness, height / np.cos(limit), height, rest)
    height = rng.uniform(0.3, 3)
    length = height * rng.uniform(1.05, 3)
    return fx.bristles.SlantedSpring(
        10 ** rng.uniform(-1, 1), length, height, rng.uniform(-1.3, 1.3)
    )


def bounds_of(rng, part, name):
    """Wide, around the number that the part has."""
    number = free_parameter(part, name)
    own, (least, most) = float(number.now(part)), number.range_of(part)
    if not np.isfinite(most):
        return own * rng.uniform(0.3, 1), own * rng.uniform(1, 3)
    return own - (own - least) * rng.uniform(0, 0.95), own + (most - own) * rng.uniform(
        0, 0.95
    )


def rebuilt(part):
    """The part by its constructor, which checks its numbers."""
    return type(part)(*map(float, jax.tree_util.tree_leaves(part)))


def random_case(rng):
    """Target, names and bounds; None where the numbers drawn give no bristle."""
    try:
        wanted = random_bristle(rng)
        names = NAMES[type(wanted)]
        free = list(map(str, rng.choice(names, 1 + (rng.random() > 0.7), replace=False)))
        own, bounds = with_arrays(wanted), {}
        for name in free:
            low, high = bounds[name] = bounds_of(rng, own, name)
            share = rng.uniform(0.05, 0.95)
            own = free_parameter(own, name).put(own, low + (high - low) * share)
        own = rebuilt(own)
    except ValueError:
        return None
    known, start = (Geometry(*map(float, geometry(b))) for b in (wanted, own))
    presses = known.alpha * start.alpha > 0 and abs(known.alpha) > 1e-3
    size, share = 10 ** rng.uniform(-2, 1), 10 ** rng.uniform(-0.8, 0.8)
    plus, minus = min(size, 0.9 * known.upper), min(size * share, -0.9 * known.lower)
    if not (presses and 1 / 12 < plus / minus < 12):
        return None
    rho_plus, rho_minus = map(float, coefficients_of(known, plus, minus))
    return fx.Target(own, rho_plus, rho_minus), free, bounds


def main(count: int = 40, seed: int = 2) -> None:
    rng, tally, worst = np.random.default_rng(seed), Counter(), 0.0
    begin, done = time.perf_counter(), 0
    while done < count:
        case = random_case(rng)
        if case is None:
            continue
        target, free, bounds = case
        try:
            fit = fx.fit_profile(target, free=free, bounds=bounds, pulling=True)
        except ValueError:  # bounds with no bristle at one of their ends
            continue
        done += 1
        tally[type(target.bristle).__name__, ", ".join(free), fit.status.name] += 1
        worst = max(worst, fit.largest_error) if fit.success else worst
        if not fit.success:
            print(f"{target}\n  {bounds}\n  {fit.message}")
    print("| bristle | free | status | fits |\n|---|---|---|---|")
    for key, number in sorted(tally.items()):
        print(f"| {' | '.join(key)} | {number} |")
    met = sum(number for key, number in tally.items() if key[-1] == "MET")
    spent = time.perf_counter() - begin
    print(
        f"{met} of {count} met, largest error {worst:.1e}, {spent:.0f} s with compilation"
    )


if __name__ == "__main__":
    jax.config.update("jax_enable_x64", True)
    main(*map(int, sys.argv[1:]))
