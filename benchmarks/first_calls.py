"""What a user waits for who changes a scene: first calls beside second ones.

`python benchmarks/first_calls.py --before PATH` runs the same in another checkout of this
library, turn by turn, and prints both. Each process is a new one; `no cache` has an empty
folder for compiled programs, `kept` the folder that the same run has filled before. Random
scenes have 1 to 16 harmonics, splines or polylines, four bristles, four loads and springs
over three decades, in a process that has solved one other scene; then steady slides of the
first five, in one that has slid in another. Seconds are the wall's,
CPU those of the process, compilers' threads included.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve()
SLIDES = 5  # scenes whose steady slides are timed, half a minute each where parts compile
COMMANDS = {
    "friction": ["friction"],
    "study": ["study"],
    "design": ["design", "--ratio", "1.5"],
}


def random_scene(fx, rng):
    """Parts by chance; None where the paper's hypotheses do not hold for them."""
    size = 10 ** rng.uniform(-1.5, 1.5)
    bristle = [
        lambda: fx.bristles.VerticalSpring(20 * size, 1.3, 1.0),
        lambda: fx.bristles.SlantedSpring(20 * size, 1.5, 1.0, rng.uniform(-0.5, 0.5)),
        lambda: fx.bristles.AngularSpring(8 * size, rng.uniform(1.2, 1.8), 1.0, 0.1),
        lambda: fx.bristles.Homothetic(6 * size),
    ][rng.integers(4)]()
    profile = random_profile(fx, rng)
    try:
        law = fx.friction(profile, bristle)
        pull = 3 * max(float(law.rho_plus), -float(law.rho_minus))
        load = [
            lambda: fx.loads.Sine(pull, 2.0),
            lambda: fx.loads.Triangle(pull, 2.0),
            lambda: fx.loads.Ramp(pull),
            lambda: fx.loads.PiecewiseLinear([0.0, 0.7, 1.6], [0.0, pull, -pull]),
        ][rng.integers(4)]()
        return fx.Scene(profile, bristle, fx.supports.Spring(2 * pull), load, 2.0)
    except ValueError:
        return None


def random_profile(fx, rng):
    kind = rng.integers(4)
    if kind == 0:
        return fx.profiles.Sine(rng.uniform(0.05, 0.3))
    if kind == 1:
        count = int(rng.integers(1, 17))
        waves = rng.normal(size=(2, count)) * 0.02 / np.arange(1, count + 1) ** 2
        return fx.profiles.Fourier(*waves)
    if kind == 2:
        count = int(rng.integers(6, 40))
        phase = 2 * np.pi * np.arange(count) / count
        heights = 0.02 * np.sin(phase + rng.uniform(0, 6)) + 0.005 * np.cos(2 * phase)
        return fx.profiles.Spline(heights)
    return fx.profiles.Polyline([0.0, rng.uniform(0.3, 0.7)], [0.0, 0.04], 0.1)


def library():
    started = time.perf_counter()
    import jax

    jax.config.update("jax_enable_x64", True)
    import frictionjax as fx

    fx.use_fast_cpu()
    fx.keep_compiled()
    return fx, started


def solved(fx, scene, eps=1e-2):
    before = time.perf_counter(), time.process_time()
    found = fx.solve(scene, eps, 1.0)
    float(found.z[-1])
    return time.perf_counter() - before[0], time.process_time() - before[1]


def slid(fx, scene):
    before = time.perf_counter()
    float(fx.steady_slide(scene.profile, scene.bristle, 1e-2).mean_plus)
    return time.perf_counter() - before


def first_ever():
    """One scene, from the import on."""
    fx, started = library()
    parts = fx.profiles.Sine(0.2), fx.bristles.SlantedSpring(20.0, 1.5, 1.0, 0.3)
    scene = fx.Scene(*parts, fx.supports.Spring(20.0), fx.loads.Sine(10.0, 2.0), 2.0)
    solved(fx, scene)
    return {"wall": time.perf_counter() - started, "cpu": time.process_time()}


def never_seen(count, seed):
    """First and second solves of random scenes, after one other."""
    fx, _ = library()
    rng = np.random.default_rng(seed)
    scenes: list = []
    while len(scenes) < count + 1:
        scene = random_scene(fx, rng)
        try:
            fx.friction(scene.profile, scene.bristle)
            scenes.append(scene)
        except (AttributeError, ValueError):
            continue
    rows = []
    for scene in scenes:
        try:
            rows.append((*solved(fx, scene), *solved(fx, scene)))
        except ValueError as refused:
            print(refused, file=sys.stderr)
    slides = [(slid(fx, scene), slid(fx, scene)) for scene in scenes[: SLIDES + 1]]
    return {"rows": rows[1:], "slides": slides[1:]}


def called(checkout, cache, *arguments):
    """A worker's answer, or a command's seconds of CPU."""
    # As installed, with the source compiled once, whatever the shell around says.
    home = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    home |= {"PYTHONPATH": str(checkout), "XDG_CACHE_HOME": str(cache)}
    before = os.times()
    done = subprocess.run(
        [sys.executable, *arguments],
        env=home,
        capture_output=True,
        text=True,
        cwd=tempfile.mkdtemp(),
    )
    after = os.times()
    if done.returncode:
        raise RuntimeError(done.stderr[-2000:])
    cpu = after.children_user + after.children_system
    return done.stdout, cpu - before.children_user - before.children_system


def measured(checkout, count, seed):
    """All figures of a checkout, by name."""
    figures = {}
    with tempfile.TemporaryDirectory() as cache:
        for turn in ("no cache", "kept"):
            out, _ = called(checkout, cache, str(HERE), "--worker", "first")
            for unit, value in json.loads(out.splitlines()[-1]).items():
                figures[f"first solve, import included, {turn}, {unit} s"] = value
        for _ in ("filling", "kept"):
            worker = ["--worker", "scenes", "--count", str(count), "--seed", str(seed)]
            out, _ = called(checkout, cache, str(HERE), *worker)
            told = json.loads(out.splitlines()[-1])
            rows = np.array(told["rows"])
            slides = figures.setdefault("slides", [])
            slides.append(np.array(told["slides"]))
        first, second = rows[:, 0], rows[:, 2]
        figures["scene never seen: first solve, median s"] = np.median(first)
        figures["scene never seen: first solve, largest s"] = first.max()
        figures["second solve, median s"] = np.median(second)
        figures["first over second, median"] = np.median(first / second)
        figures["scenes"] = len(rows)
        for turn, times in zip(("no cache", "kept"), figures.pop("slides"), strict=True):
            for name, column in zip(("first", "second"), times.T, strict=True):
                of = f"steady slide of a scene never seen, {turn}, {name}, median s"
                figures[of] = np.median(column)
    with tempfile.TemporaryDirectory() as cache:
        for turn in ("no cache", "kept"):
            for name, command in COMMANDS.items():
                _, cpu = called(checkout, cache, "-m", "frictionjax", *command)
                figures[f"frictionjax {name}, {turn}, CPU s"] = cpu
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--before", type=Path, help="another checkout, to compare with")
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--worker", choices=["first", "scenes"], help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.worker:
        workers = {
            "first": first_ever,
            "scenes": lambda: never_seen(options.count, options.seed),
        }
        print(json.dumps(workers[options.worker]()))
        return
    here = HERE.parents[1]
    checkouts = [options.before.resolve(), here] if options.before else [here]
    columns = [measured(home, options.count, options.seed) for home in checkouts]
    names = ["before", "now"][-len(columns) :]
    print(f"| | {' | '.join(names)} |\n|---|{'---|' * len(names)}")
    for name in columns[-1]:
        print(f"| {name} | {' | '.join(f'{c[name]:.3g}' for c in columns)} |")


if __name__ == "__main__":
    main()
