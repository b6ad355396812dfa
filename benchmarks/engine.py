"""What the engine takes for scenes of every kind, beside another checkout of this library.

`python benchmarks/engine.py --before PATH` runs the same in both, turn by turn, and prints
a table; first calls are in first_calls.py, flat folds in straight_flanks.py. CPU seconds,
the least of a few runs, of

    solve     a warm `solve` of few wells, eps = 0.02, gamma = 1, the median of scenes
    slide     a warm `steady_slide`, both ways, eps = 0.01, gamma = 1, the median of scenes
    step      a step of one lane of a sweep, whole: planning and results included, on a
              sine and on series of 4 and 16 harmonics, with energies and suprema
    rows      rows of a measured map (`--map`, or series by chance) x 16 eps from 0.05 to
              1e-5, energies and suprema, a row: in one sweep, or one each
    scenes    sines by chance x 8 eps from 0.1 to 1e-3, values alone, a scene: the same
    small     sines by chance x 8 eps from 1e-4 to 1e-7, a scene: the same, and steps
    gradient  of a steady slide and of a value of a trajectory, for the first time in a
              process: without a cache, then with every program kept
    certificates  of curves of scenes of 18 kinds, each for the first time
    others    a solver of diffrax, and a fit to a trace, of three scenes of other kinds
              (and a `solve` with a load, a support, a C^2 profile, a W as one of three
              functions)
    times     a `solve` with another number of times than before
"""

import argparse
import itertools
import json
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from first_calls import called

HERE = Path(__file__).resolve()
REPEATS = 5


def library():
    import jax

    jax.config.update("jax_enable_x64", True)
    import frictionjax as fx

    fx.use_fast_cpu()
    fx.keep_compiled()
    return fx


def least(call, repeats=REPEATS):
    call()
    seconds = []
    for _ in range(repeats):
        begin = time.process_time()
        call()
        seconds.append(time.process_time() - begin)
    return min(seconds)


def scene_of(fx, profile, stiffness=1.0, held=1.0, pull=1.2, angle=0.5):
    bristle = fx.bristles.SlantedSpring(stiffness, 2.4, 1.0, angle)
    support, load = fx.supports.Spring(held), fx.loads.Sine(pull, 3.0)
    return fx.Scene(profile, bristle, support, load, 3.0)


def sines(fx, count, rng):
    least, most = [0.02, 0.7, 0.7, 1.0, 0.3], [0.12, 1.5, 1.5, 1.4, 0.7]
    numbers = rng.uniform(least, most, (count, 5)).tolist()
    return [scene_of(fx, fx.profiles.Sine(slope), *rest) for slope, *rest in numbers]


def series(fx, count, rng):
    waves = rng.normal(size=(2, count)) / np.arange(1, count + 1) ** 2.5
    slopes = np.abs(2 * np.pi * np.arange(1, count + 1) * waves).sum()
    return fx.profiles.Fourier(*(0.15 / slopes * waves))


def solve(fx, options):
    ts = np.linspace(0, 3, 101)
    scenes = sines(fx, 12, np.random.default_rng(1))
    taken = [least(lambda one=one: fx.solve(one, 0.02, 1.0, ts)) for one in scenes]
    return {"warm solve of few wells, ms": 1e3 * np.median(taken)}


def slide(fx, options):
    scenes = sines(fx, 12, np.random.default_rng(1))
    parts = [(one.profile, one.bristle, 0.01) for one in scenes]
    taken = [least(lambda of=of: fx.steady_slide(*of)) for of in parts]
    return {"a warm steady slide, ms": 1e3 * np.median(taken)}


def step(fx, options):
    rng, figures = np.random.default_rng(2), {}
    eps, gamma = np.geomspace(1e-2, 1e-4, 24), [0.5, 1.0]
    for name, profile in {
        "a sine": fx.profiles.Sine(0.1),
        "4 harmonics": series(fx, 4, rng),
        "16 harmonics": series(fx, 16, rng),
    }.items():
        scene = scene_of(fx, profile)
        steps = float(fx.sweep(scene, eps, gamma).steps.sum())
        taken = least(lambda s=scene: fx.sweep(s, eps, gamma))
        figures[f"a step, {name}, us"] = 1e6 * taken / steps
    return figures


def swept(fx, scenes, eps, **options):
    """The least time a scene, ms: one each, and in one sweep where lists can be swept."""

    def together():
        return fx.sweep(scenes, eps, [1.0], **options)

    def alone():
        return [fx.sweep(scene, eps, [1.0], **options) for scene in scenes]

    figures = {"one each": 1e3 * least(alone, 2) / len(scenes)}
    if hasattr(fx, "ensemble"):  # as old as lists in sweeps
        figures["in one sweep"] = 1e3 * least(together, 2) / len(scenes)
    return figures


def rows(fx, options):
    rng = np.random.default_rng(3)
    profiles = [series(fx, 8, rng) for _ in range(options.count)]
    if options.map:
        heights = fx.measured.read_heights(options.map).heights
        places = np.linspace(0, heights.shape[0] - 1, options.count).astype(int)
        profiles = [row_profile(fx, heights[i]) for i in places]
    scenes = [scene_of(fx, p) for p in profiles]
    found = swept(fx, scenes, np.geomspace(0.05, 1e-5, 16))
    return {f"a row of 8 harmonics x 16 eps, {how}, ms": s for how, s in found.items()}


def row_profile(fx, heights):
    waves = np.fft.rfft(heights - heights.mean())[1:9] / heights.size
    slopes = np.abs(4 * np.pi * np.arange(1, 9) * waves).sum()
    return fx.profiles.Fourier(*(0.15 / slopes * 2 * np.array([waves.real, -waves.imag])))


def scenes(fx, options):
    many = sines(fx, options.count, np.random.default_rng(4))
    found = swept(fx, many, np.geomspace(0.1, 1e-3, 8), dissipation=False, suprema=False)
    return {f"a scene of a sine x 8 eps, {how}, ms": s for how, s in found.items()}


def small(fx, options):
    many = sines(fx, options.count, np.random.default_rng(4))
    eps = np.geomspace(1e-4, 1e-7, 8)
    found = swept(fx, many, eps)
    figures = {f"a scene of a sine x 8 small eps, {how}, ms": s for how, s in found.items()}
    values = {"dissipation": False, "suprema": False}
    for name, asked in {"all": {}, "values": values}.items():
        steps = [fx.sweep(one, eps, [1.0], **asked).steps.sum() for one in many]
        figures[f"steps a cell, {name}"] = float(np.mean(steps)) / eps.size
    return figures


def gradient(fx, options):
    import jax

    def slide(slope):
        bristle = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
        return fx.steady_slide(fx.profiles.Sine(slope), bristle, 1e-2).mean_plus

    def value(slope, count=1):
        ts = np.linspace(0, 3, count + 1)[1:]
        return fx.solve(scene_of(fx, fx.profiles.Sine(slope)), 1e-2, 1.0, ts).z[-1]

    asked = {
        "a steady slide": slide,
        "a trajectory's value": value,
        "the same, at 50 times then": lambda slope: value(slope, 50),
    }
    figures = {}
    for name, fn in asked.items():
        begin = time.process_time()
        float(jax.grad(fn)(0.1))
        figures[f"gradient of {name}, first call, s"] = time.process_time() - begin
    return figures


def certificates(fx, options):
    rng, ts = np.random.default_rng(5), np.linspace(0, 3, 2001)
    profiles = [series(fx, count, rng) for count in (1, 3, 8)]
    bristles = [
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5),
        fx.bristles.AngularSpring(1.0, 1.4, 1.0, 0.5),
    ]
    loads = [fx.loads.Sine(1.2, 3.0), fx.loads.Triangle(1.1, 3.0)]
    first, again = [], []
    for parts in itertools.product(profiles, bristles, [fx.supports.Spring(1.0)], loads):
        scene = fx.Scene(*parts, duration=3.0)
        z = np.asarray(fx.solve(scene, 0.1, 1.0, ts).z)
        for taken in (first, again):
            begin = time.process_time()
            fx.certify(scene, 0.1, 1.0, ts, z)
            taken.append(time.process_time() - begin)
    return {
        "the first certificate, s": first[0],
        "a certificate of a kind never seen, median, s": np.median(first[1:]),
        "the longest of these, s": max(first[1:]),
        "a certificate again, ms": 1e3 * np.median(again),
    }


def others(fx, options):
    two = series(fx, 2, np.random.default_rng(6))
    kinds = [
        (
            fx.profiles.Sine(0.1),
            fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5),
            fx.loads.Sine(1.2, 3.0),
        ),
        (two, fx.bristles.AngularSpring(1.0, 1.5, 1.0, 0.5), fx.loads.Triangle(1.1, 3.0)),
        (two, fx.bristles.VerticalSpring(1.0, 2.0, 1.0), fx.loads.Ramp(0.4, 0.0)),
    ]
    ts, figures = np.linspace(0.0, 3.0, 201), {}
    scenes = [
        fx.Scene(profile, bristle, fx.supports.Spring(1.0), load, 3.0)
        for profile, bristle, load in kinds
    ]
    traces = [fx.simulate_trace(scene, 0.1, 1.0, ts, noise=0.001) for scene in scenes]

    def fitted(index):
        fx.fit_trace(traces[index], scenes[index], 0.1, harmonics=2, progress=False)

    def solved(index):
        fx.solve(scenes[index], 0.05, 1.0, ts, method="Kvaerno5")

    for name, call in (("solve by Kvaerno5", solved), ("fit to a trace", fitted)):
        taken = []
        for index in range(len(scenes)):
            begin = time.process_time()
            call(index)
            taken.append(time.process_time() - begin)
        figures[f"{name}, the first, s"] = taken[0]
        figures[f"{name}, of other kinds, the longest, s"] = max(taken[1:])
    for name, (scene_with, given) in functions(fx).items():
        taken = []
        for fn in given:
            begin = time.process_time()
            fx.solve(scene_with(fn), 0.02, 1.0, ts)
            taken.append(time.process_time() - begin)
        figures[f"solve with a {name} as a function, the first, s"] = taken[0]
        figures[f"solve with another {name} as a function, the longest, s"] = max(taken[1:])
    return figures


def functions(fx):
    """Parts as functions, three of each: how scenes are made of them, and which."""
    import jax.numpy as jnp

    scene = scene_of(fx, fx.profiles.Sine(0.1))
    spring, load = scene.support, scene.load

    def wave(y):
        return jnp.sin(2 * jnp.pi * y)

    return {
        "load": (
            lambda fn: scene.replace(load=fx.loads.Custom(fn)),
            [
                lambda t: 1.2 * jnp.sin(2 * t),
                lambda t: jnp.sin(2 * t) + 0.2 * t,
                lambda t: 1.5 * t * jnp.exp(-t),
            ],
        ),
        "support": (
            lambda fn: scene.replace(support=fx.supports.Convex(fn)),
            [
                lambda z: 0.5 * z**2 + 0.01 * z**4,
                lambda z: 0.4 * z**2 + 0.01 * jnp.cosh(z),
                lambda z: 0.6 * z**2 + 0.01 * z**3,
            ],
        ),
        "C^2 profile": (
            lambda fn: scene.replace(profile=fx.profiles.Custom(fn)),
            [
                lambda y: 0.02 * jnp.abs(wave(0.5 * y)) ** 3,
                lambda y: 0.02 * jnp.tanh(wave(y - 0.12) / 0.1),
                lambda y: 0.02 * wave(y) + 0.003 * jnp.abs(wave(y - 0.37)) ** 3,
            ],
        ),
        "potential W": (
            lambda fn: fx.Scene(
                potential=fx.GivenPotential(fn), support=spring, load=load, duration=3.0
            ),
            [
                lambda Y: 0.1 * wave(Y),
                lambda Y: 0.08 * wave(Y) + 0.02 * wave(2 * Y + 0.1),
                lambda Y: 0.1 * jnp.abs(wave(Y)) ** 3,
            ],
        ),
    }


def times(fx, options):
    scene = scene_of(fx, fx.profiles.Sine(0.1))
    fx.solve(scene, 0.02, 1.0, np.linspace(0, 3, 101))
    taken = []
    for count in (57, 83, 129):
        begin = time.process_time()
        fx.solve(scene, 0.02, 1.0, np.linspace(0, 3, count))
        taken.append(time.process_time() - begin)
    return {"a solve with another number of times, s": max(taken)}


_ALL = solve, slide, step, rows, scenes, small, gradient, certificates, others, times
PARTS = {part.__name__: part for part in _ALL}


def measured(checkout, parts, arguments):
    figures = {}
    with tempfile.TemporaryDirectory() as cache:
        for part in parts:
            for turn in ("no cache", "kept") if part == "gradient" else ("",):
                worker = [str(HERE), "--worker", part, *arguments]
                found = json.loads(called(checkout, cache, *worker)[0].splitlines()[-1])
                for name, value in found.items():
                    figures[f"{name} {turn}".strip()] = value
                print(f"  {checkout.name}: {part}", file=sys.stderr, flush=True)
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--before", type=Path, help="another checkout, to compare with")
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS))
    parser.add_argument("--count", type=int, default=24, help="rows, and scenes")
    parser.add_argument("--map", type=Path, help="heights of a measured map, rows of text")
    parser.add_argument("--worker", choices=PARTS, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.worker:
        print(json.dumps(PARTS[options.worker](library(), options)))
        return
    passed = ["--count", str(options.count)]
    if options.map:
        passed += ["--map", str(options.map.resolve())]
    checkouts = [HERE.parents[1]]
    if options.before:
        checkouts.insert(0, options.before.resolve())
    columns = [measured(home, options.parts, passed) for home in checkouts]
    names = ["before", "now"][-len(columns) :]
    print(f"| | {' | '.join(names)} |\n|---|{'---|' * len(names)}")
    for name in columns[-1]:
        values = " | ".join(f"{c[name]:.3g}" if name in c else "-" for c in columns)
        print(f"| {name} | {values} |")


if __name__ == "__main__":
    main()
