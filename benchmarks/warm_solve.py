"""Where the time of a warm solve of few wells goes, and what many scenes take together.

    python benchmarks/warm_solve.py [--scenes 50] [--together 48] [--times 201]

CPU milliseconds of a `solve` at eps = 0.02, gamma = 1, with 101 times, of scenes whose
numbers differ: never seen before, and again, the least of ten each, the median of all.
Then seconds of the steps of the latter. Then values alone of 8 eps from 0.1 to 1e-3 of many
scenes, a scene: in one sweep, and in one each, the least of four, of CPU time and by the
clock.
"""

import argparse
import contextlib
import time
from collections import defaultdict
from collections.abc import Callable, Iterator

import jax
import numpy as np

import frictionjax as fx
from frictionjax.wiggly import attempts, batch, engine_solutions
from frictionjax.wiggly.enclosure import marching

RNG = np.random.default_rng(5)
STEPS = {
    "tables": (batch, "tabulated_scene"),
    "path": (batch, "known_path"),
    "plan": (batch, "planned"),
    "layout": (attempts, "lay_out"),
    "starts": (marching, "starts_of"),
    "brackets": (marching, "plan_brackets"),
    "lanes": (marching, "march"),
    "sums": (attempts, "evaluate"),
    "all cells": (engine_solutions, "integrate_scene"),
}


def scene():
    """Of a sine, a slanted spring and a sine load."""
    least, most = [0.05, 0.7, 0.3, 1.5, 1.0], [0.12, 1.5, 0.7, 2.5, 1.4]
    slope, stiffness, angle, held, pull = RNG.uniform(least, most)
    rest_length, height, duration = np.array([2.4, 1.0, 3.0])
    return fx.Scene(
        fx.profiles.Sine(slope),
        fx.bristles.SlantedSpring(stiffness, rest_length, height, angle),
        fx.supports.Spring(held),
        fx.loads.Sine(pull, duration),
        duration,
    )


def solve(one: fx.Scene) -> object:
    return fx.solve(one, 0.02, 1.0, np.linspace(0, 3, 101))


def cpu(call: Callable[[], object]) -> float:
    """CPU seconds of a call, those of all threads."""
    return float(seconds(call)[0])


def seconds(call: Callable[[], object]) -> np.ndarray:
    """Of CPU time, and by the clock."""
    begin = np.array([time.process_time(), time.perf_counter()])
    call()
    return np.array([time.process_time(), time.perf_counter()]) - begin


@contextlib.contextmanager
def watched(spent: dict[str, float]) -> Iterator[None]:
    """Adds the seconds of each of `STEPS` to its name."""
    inside = {name: getattr(*place) for name, place in STEPS.items()}

    def timed(name: str) -> Callable:
        def call(*args, **named):
            begin = time.perf_counter()
            found = inside[name](*args, **named)
            spent[name] += time.perf_counter() - begin
            return found

        return call

    for name, place in STEPS.items():
        setattr(*place, timed(name))
    try:
        yield
    finally:
        for name, place in STEPS.items():
            setattr(*place, inside[name])


def print_solves(count: int) -> None:
    scenes = [scene() for _ in range(count)]
    solve(scenes[0])
    new = [cpu(lambda one=one: solve(one)) for one in scenes]
    again = [min(cpu(lambda one=one: solve(one)) for _ in range(10)) for one in scenes]
    first, later = (1e3 * np.median(column) for column in (new, again))
    print(f"never seen: {first:.1f} ms, again: {later:.1f} ms\n")
    print("| step | ms |\n|---|---|")
    spent: dict[str, float] = defaultdict(float)
    with watched(spent):
        for one in scenes:
            solve(one)
    for name in STEPS:
        print(f"| {name} | {1e3 * spent[name] / count:.2f} |")


def print_together(count: int, times: int) -> None:
    eps, ts = np.geomspace(0.1, 1e-3, 8), np.linspace(0, 3, times)

    def sweep(scenes) -> object:
        return fx.sweep(scenes, eps, 1.0, ts, dissipation=False, suprema=False)

    took = []
    for _ in range(4):  # what is compiled, in the background too, is there at last
        scenes, others = ([scene() for _ in range(count)] for _ in range(2))
        together = seconds(lambda scenes=scenes: sweep(scenes))
        alone = seconds(lambda others=others: [sweep(one) for one in others])
        took.append([together, alone])
    print("\n| ms a scene | CPU | clock |\n|---|---|---|")
    for name, (by_cpu, by_clock) in zip(
        ("in one sweep", "one each"), 1e3 * np.min(took, axis=0) / count, strict=True
    ):
        print(f"| {name} | {by_cpu:.1f} | {by_clock:.1f} |")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--scenes", type=int, default=50)
    parser.add_argument("--together", type=int, default=48)
    parser.add_argument("--times", type=int, default=201)
    asked = parser.parse_args()
    fx.use_fast_cpu()
    jax.config.update("jax_enable_x64", True)
    print_solves(asked.scenes)
    print_together(asked.together, asked.times)
